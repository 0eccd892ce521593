"""Animations of hulls, in space or sliding in a plane: the page and the film hold the poses of the response."""

import base64
import json
import re
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from rocking.bodies.solid import Part, Solid, box
from rocking.dynamics import SpatialBody
from rocking.dynamics.space.attitude import matrix
from rocking.errors import InvalidValueError
from rocking.plots.animation import page
from rocking.plots.animation_hull import HullScene

# a pedestal and an eccentric block on it: no symmetry
STATUE = Solid([Part(box(0.5, 0.7, 0.9), 2400.0), Part(box(0.3, 0.2, 0.5), 1500.0).moved(0.06, 0.1, 0.9)])
PULSE = rk.pulses.sine(amplitude=9.0, period=0.5)
RESPONSE = rk.simulate(STATUE, {"x": PULSE, "y": PULSE}, "housner", friction=0.5)
SCENE = HullScene.of(RESPONSE)


def test_facets_are_closed_and_face_outward():
    """Fans over the facets have the volume of the hull, which facets in another order or turned inward have not."""

    def volume(facets):
        fans = [(f[0], a, b) for f in facets for a, b in pairwise(f[1:])]
        return float(np.linalg.det(SCENE.points[np.array(fans)]).sum()) / 6.0

    from scipy.spatial import ConvexHull

    assert volume(SCENE.facets) == pytest.approx(ConvexHull(SCENE.points).volume, rel=1e-9)
    assert volume([SCENE.facets[0][::-1], *SCENE.facets[1:]]) != pytest.approx(volume(SCENE.facets), rel=1e-3)


def test_the_page_holds_the_poses_of_the_response():
    """No vertex of the page goes below the ground, its largest tilt is that of the response."""
    text = page(RESPONSE)
    data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.S)[1])
    quaternion, centre = (
        np.frombuffer(base64.b64decode(data[name]), "<f4").reshape(-1, width).astype(float)
        for name, width in (("quaternion", 4), ("centre", 3))
    )
    points = np.einsum("nij,kj->nki", matrix(quaternion), np.array(data["points"])) + centre[:, None]
    assert abs(points[:, :, 2].min(axis=1)).max() < 1e-3
    assert max(np.frombuffer(base64.b64decode(data["tilt"]), "<f4")) == pytest.approx(RESPONSE.peak_tilt, rel=1e-3)
    assert data["end"] == RESPONSE.end
    assert "script-src 'sha256-" in text
    assert "src=" not in text.replace("script-src", "").replace("style-src", "").replace("default-src", "")


def test_the_film(tmp_path):
    """A film has a frame for each step, and the body moves in it."""
    path = RESPONSE.animate(tmp_path / "film.gif", fps=5.0)
    with Image.open(path) as film:
        assert film.n_frames == int(np.ceil(RESPONSE.end / 0.2)) + 1
        first = np.asarray(film.convert("L"), float)[60:380]
        film.seek(3)
        assert np.abs(np.asarray(film.convert("L"), float)[60:380] - first).max() > 50.0


LEANING = rk.Section([rk.Region([(0.0, 0.0), (0.4, 0.0), (0.6, 1.5), (0.1, 1.5)], 2000.0)], depth=0.8)


@pytest.mark.parametrize(
    ("response", "turns"),
    [
        (lambda: rk.simulate(STATUE, {"x": PULSE, "y": PULSE.scaled(0.6)}, "housner"), 1e-2),
        (lambda: rk.simulate(SpatialBody.cylinder(0.4, 1.6), {"x": PULSE, "y": PULSE.scaled(0.6)}, "housner"), 1e-2),
        (lambda: rk.simulate(LEANING, PULSE, friction=0.9), 0.5),
        (lambda: rk.simulate(LEANING, PULSE, friction=0.1), 0.0),
    ],
    ids=["flat base", "rim", "plane that rocks", "plane that slides"],
)
def test_what_is_drawn_stands_on_the_ground(response, turns):
    """Bodies on flat bases and plane ones with friction: the lowest vertex drawn is on the ground, turned or not."""
    scene = HullScene.of(response())
    turned = np.array([matrix(q) for q in scene.quaternion])
    low = (scene.points @ turned.transpose(0, 2, 1)).min(axis=1)[:, 2] + scene.centre[:, 2]
    assert np.abs(low).max() < 2e-4 * scene.reach  # corners of a rim are 360
    assert scene.tilt.max() >= turns
    assert np.ptp(scene.centre[:, 0]) > 1e-3
    wrong = low + scene.centre[::-1, 2] - scene.centre[:, 2]
    assert turns == 0.0 or np.abs(wrong).max() > 1e-3 * scene.reach


def test_every_response_has_an_animation(tmp_path):
    """Rocking on a flat base, and sliding in the plane: a page that says what moves it, and a film; mass points not."""
    space = rk.simulate(STATUE, PULSE, "housner")
    plane = rk.simulate(LEANING, PULSE, friction=0.3)
    for response, words in ((space, "restitution housner-3d"), (plane, "friction 0.3")):
        assert words in response.animate(tmp_path / "a.html").read_text(encoding="utf-8")
        film = response.animate(tmp_path / "a.gif", speed=10.0)
        assert film.read_bytes().startswith(b"GIF8")
    points = rk.MassPoints([[-0.1, 1.0], [0.2, 0.8]], [10.0, 20.0], feet=(-0.2, 0.3))
    with pytest.raises(InvalidValueError, match="mass points have no outline"):
        rk.simulate(points, PULSE, None, friction=0.2).animate(tmp_path / "b.html")
