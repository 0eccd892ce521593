"""Bodies in space as glTF: other programs read the same body, and its poses and motion are those of the answer."""

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
from rocking.dynamics.rolling.attitude import matrix
from rocking.errors import InvalidValueError
from rocking.plots.animation import page
from rocking.plots.animation_hull import HullScene
from rocking.plots.space_glb import GltfFile

trimesh = pytest.importorskip("trimesh")
_KINDS = {5126: np.float32, 5125: np.uint32, 5121: np.uint8}
_WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
MILLIMETRES = 1000.0


@pytest.fixture(scope="module")
def scan(tmp_path_factory):
    """Write a leaning block without symmetry, lying on its side in a file in mm."""
    mesh = trimesh.creation.box((0.4, 0.25, 1.2))
    height = mesh.vertices[:, 2] + 0.6
    points = mesh.vertices * np.stack([1.0 - 0.3 * height, 1.0 - 0.1 * height, np.ones(8)], axis=1)
    points[:, 0] += 0.05 * height
    points[:, 1] += 0.03 * points[:, 0] + 0.06 * height
    path = tmp_path_factory.mktemp("scan") / "block.stl"
    trimesh.Trimesh(MILLIMETRES * points[:, [2, 0, 1]], mesh.faces, process=False).export(path)
    return path


@pytest.fixture(scope="module")
def solid(scan):
    return rk.read_body(scan, units="mm", up=(1.0, 0.0, 0.0))


def opened(path):
    """Return what a file says, what it says beside glTF, and how to read an array of it."""
    raw = path.read_bytes()
    assert raw[:4] == b"glTF"
    assert int.from_bytes(raw[8:12], "little") == len(raw)
    length = int.from_bytes(raw[12:16], "little")
    told = json.loads(raw[20 : 20 + length])

    def array(number):
        accessor = told["accessors"][number]
        start = 28 + length + told["bufferViews"][accessor["bufferView"]]["byteOffset"]
        width = _WIDTHS[accessor["type"]]
        flat = np.frombuffer(raw, _KINDS[accessor["componentType"]], accessor["count"] * width, start)
        return flat.reshape(-1, width).astype(np.float64)

    return told, told["extras"]["rocking"], array


@pytest.mark.slow
def test_another_program_reads_the_same_body(solid, tmp_path):
    """Volume and centre by trimesh, which knows nothing of ours; y is up, and with z up it would lie."""
    GltfFile(solid).write(tmp_path / "body.glb")
    mesh = trimesh.load_scene(tmp_path / "body.glb").to_geometry()
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(solid.volume, rel=1e-5)  # single precision
    height = solid.centre[2] - solid.ground
    assert mesh.center_mass == pytest.approx([0.0, height, 0.0], abs=1e-6)
    assert rk.read_body(tmp_path / "body.glb").mass == pytest.approx(solid.mass, rel=1e-5)
    wrong = rk.read_body(tmp_path / "body.glb", up="z")
    assert abs(wrong.centre[2] - wrong.ground - height) > 0.1


@pytest.mark.slow
@pytest.mark.parametrize("up", ["z", (-1.0, 0.0, 0.0)])
def test_faces_that_close_holes_are_told(tmp_path, up):
    """Of a block without half of its top, and of one without its bottom: area and plane of what was closed; of a whole
    one nothing."""
    box = trimesh.creation.box((0.4, 0.3, 1.2))
    for gone, count, height in (
        (box.face_normals[:, 2] > 0.9, 1, 0.6),
        (box.face_normals[:, 2] < -0.9, 2, -0.6),
        ([], 0, 0),
    ):
        faces = np.delete(box.faces, np.flatnonzero(gone)[:count], axis=0)
        path = tmp_path / f"scan-{count}.stl"
        trimesh.Trimesh(box.vertices, faces, process=False).export(path)
        solid = rk.read_body(path, units="m", up=up, repair="all")
        GltfFile(solid).write(tmp_path / "scan.glb")
        _, extras, array = opened(tmp_path / "scan.glb")
        assert ("mended" in extras) == (count > 0)
        if count == 0:
            continue
        mended = array(extras["mended"]).reshape(-1, 3, 3)
        arms = np.cross(mended[:, 1] - mended[:, 0], mended[:, 2] - mended[:, 0])
        assert 0.5 * np.linalg.norm(arms, axis=1).sum() == pytest.approx(0.06 * count, rel=1e-6)
        where = mended @ solid.turn[:, 2]  # the axis of the file, in that of the body
        assert where == pytest.approx(np.full_like(where, height), abs=1e-6)


def test_the_file_stands_again_in_each_pose(solid, scan, tmp_path):
    """Read with the direction that a pose names as up, it stands as high as that pose; turns set down."""
    found = solid.equilibria()
    file = GltfFile(solid)
    file.add_equilibria(found, found.stable[0])
    file.write(tmp_path / "body.glb")
    _, extras, _ = opened(tmp_path / "body.glb")
    heights = [pose.height for pose in found.stable]
    for pose, told in zip(found.stable, extras["poses"], strict=True):
        x, y, z, s = told["turn"]
        assert matrix(np.array([s, x, y, z])) @ pose.down == pytest.approx([0.0, 0.0, -1.0], abs=1e-12)
        again = rk.read_body(scan, units="mm", up=told["up_in_file"])
        assert again.centre[2] - again.ground == pytest.approx(pose.height, rel=1e-6)
    assert min(np.diff(sorted(heights))) > 1e-4


@pytest.mark.slow
def test_colours_are_those_of_the_height(solid, tmp_path):
    """Brightness follows the height of the centre over the point that is below, from all pairs of points."""
    found = solid.equilibria()
    file = GltfFile(solid)
    file.add_equilibria(found, found.stable[0])
    file.write(tmp_path / "body.glb")
    told, extras, array = opened(tmp_path / "body.glb")
    attributes = told["meshes"][0]["primitives"][0]["attributes"]
    points, colours = array(attributes["POSITION"]), array(attributes["COLOR_0"])
    heights = (points / np.linalg.norm(points, axis=1)[:, None] @ points.T).max(axis=1)
    order = np.argsort(heights)
    green = colours[order, 1]
    assert (np.diff(green) >= -1.0).all()  # one step of 255 is rounding
    assert np.ptp(green) > 100.0
    assert heights.max() == pytest.approx(extras["landscape"][1], rel=1e-6)
    assert heights.min() > extras["landscape"][0]  # which lies between points


def test_what_is_told_to_touch_is_on_the_ground(solid, tmp_path):
    """In the poses of the file, vertices that the answer lists are on the ground, and none is below."""
    pulse = rk.pulses.sine(amplitude=6.0, period=0.6)
    response = rk.simulate(solid, {"x": pulse, "y": pulse}, 0.6, friction=0.5)
    file = GltfFile(solid)
    file.add_motion(response)
    file.write(tmp_path / "body.glb")
    told, extras, array = opened(tmp_path / "body.glb")
    turns, places = (array(each["output"]) for each in told["animations"][0]["samplers"])
    time, hull = array(told["animations"][0]["samplers"][0]["input"])[:, 0], array(extras["hull"])
    assert (turns[1:] * turns[:-1]).sum(axis=1).min() > 0.0  # the short way between any two
    above = hull @ matrix(np.roll(turns, 1, axis=1))[:, 2].T + places[:, 2]
    slack = 1e-4  # single precision, and cubics between the steps [m]
    assert above.min() > -slack
    checked = 0
    for start, end, touching, _ in response.intervals:
        for k in np.flatnonzero((time > start + 1e-6) & (time < end - 1e-6)):
            assert np.abs(above[list(touching), k]).max(initial=0.0) < slack
            checked += len(touching)
    assert checked > 50
    assert array(extras["tilt"]).max() == pytest.approx(response.peak_tilt, rel=0.02)  # 60 poses a second
    assert np.abs(above[:, np.argmax(array(extras["tilt"]))]).max() > slack


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


@pytest.mark.slow
def test_the_film(tmp_path):
    """A film has a frame for each step, and the body moves in it."""
    path = RESPONSE.animate(tmp_path / "film.gif", fps=5.0)
    with Image.open(path) as film:
        assert film.n_frames == int(np.ceil(RESPONSE.end / 0.2)) + 1
        first = np.asarray(film.convert("L"), float)[60:380]
        film.seek(3)
        assert np.abs(np.asarray(film.convert("L"), float)[60:380] - first).max() > 50.0


LEANING = rk.Section([rk.Region([(0.0, 0.0), (0.4, 0.0), (0.6, 1.5), (0.1, 1.5)], 2000.0)], depth=0.8)


@pytest.mark.slow
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


@pytest.mark.slow
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
