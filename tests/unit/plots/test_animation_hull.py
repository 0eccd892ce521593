"""Animations of bodies in space with friction: the page and the film hold the poses of the response."""

import base64
import json
import re
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from rocking.bodies.solid import Part, Solid, box
from rocking.cli import main
from rocking.dynamics.space.attitude import matrix
from rocking.errors import InvalidValueError
from rocking.plots.animation import page
from rocking.plots.animation_scene import HullScene

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


def test_the_command(tmp_path):
    """--out of a page is taken for a body in space with friction, and refused in a sentence without."""
    body = "[[solid.part]]\nbox = { width = 0.5, depth = 0.6, height = 1.2 }\ndensity = 2000\n"
    (tmp_path / "body.toml").write_text(f'units = "m"\n{body}')
    words = ["simulate", str(tmp_path / "body.toml"), "sine:amplitude=3,period=0.5"]
    out = ["--out", str(tmp_path / "a.html")]
    with pytest.raises(SystemExit) as stop:
        main([*words, "--friction", "0.2", *out])
    assert not stop.value.code
    assert "friction 0.2" in (tmp_path / "a.html").read_text()
    with pytest.raises(SystemExit) as stop:
        main([*words, *out])
    assert stop.value.code


def test_other_mechanics_are_refused(tmp_path):
    """What slides in the plane, or turns on a flat base, has no animation yet, and says so."""
    for response in (
        rk.simulate(rk.Block(width=0.5, height=2.0), PULSE, friction=0.5),
        rk.simulate(STATUE, PULSE.scaled(0.1), "housner"),
    ):
        for name in ("a.html", "a.gif"):
            with pytest.raises(InvalidValueError, match="an animation is of pure rocking in the plane, or of a body"):
                response.animate(tmp_path / name)
