"""Scans made badly on purpose: they come in by one call with the right centre to the stated bound, or are refused."""

import math
import re
from pathlib import Path

import bad_scans
import numpy as np
import pytest

import rocking as rk
from rocking.bodies.equilibria.poses import set_down
from rocking.bodies.solid import box, extrusion, rotation_about
from rocking.bodies.solid.repair import simplify
from rocking.bodies.solid.repair.log import MOST_SHIFT, MOST_VOLUME
from rocking.bodies.solid.repair.steps import repair_surface
from rocking.bodies.solid.standing import settled
from rocking.errors import BodyFileError, GeometryError, InvalidValueError, RockingError

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="bodies")]

trimesh = pytest.importorskip("trimesh")

V, SIDES, BOTTOM = bad_scans.statue()
F = np.concatenate([SIDES, BOTTOM])
VOLUME, CENTRE = bad_scans.volume_and_centre(V, F)
SIZE = float(np.ptp(V, axis=0).max())
RANDOM = np.random.default_rng(17)
NONE = np.zeros((0, 3), dtype=np.int64)
AROUND = 48


def joined(*surfaces):
    """Several surfaces as one."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in surfaces)])
    faces = [faces + start for (_, faces), start in zip(surfaces, starts[:-1], strict=True)]
    return np.concatenate([vertices for vertices, _ in surfaces]), np.concatenate(faces)


def without(place, radius):
    """Faces but those around a place."""
    return F[np.linalg.norm(V[F].mean(axis=1) - place, axis=1) > radius]


def noisy(sigma, seed=0):
    return V + sigma * np.random.default_rng(seed).normal(size=V.shape)


def ragged(amount):
    """The rim of an open bottom, cut unevenly."""
    vertices = V[:-1].copy()
    vertices[:AROUND, 2] += amount * np.random.default_rng(1).random(AROUND)
    return vertices, SIDES


def folded():
    """Two neighbours of one ring that changed places and stand out: their faces cross."""
    vertices = V.copy()
    i = 20 * AROUND + 7
    vertices[[i, i + 1]] = vertices[[i + 1, i]] * [1.02, 1.02, 1.0]
    return vertices, F


def split():
    """An edge of one face holds a vertex that its neighbour lacks: a slit without width."""
    a, b, c = F[1000]
    return np.vstack([V, 0.5 * (V[a] + V[b])]), np.vstack([np.delete(F, 1000, axis=0), [a, len(V), c], [len(V), b, c]])


def finned():
    a, b, _ = F[1000]
    return np.vstack([V, V[a] * [1.4, 1.4, 1.0]]), np.vstack([F, [a, b, len(V)]])


def flipped():
    turned = np.random.default_rng(2).random(len(F)) < 0.3
    return V, np.where(turned[:, None], F[:, ::-1], F)


def speckled():
    generator = np.random.default_rng(3)
    loose = (
        generator.uniform(-0.3, 0.3, (60, 1, 3)) + np.array([0.0, 0.0, 0.4]) + generator.normal(0.0, 2e-3, (60, 3, 3))
    )
    return joined((V, F), bad_scans.cubes(250, 1e-3, generator), (loose.reshape(-1, 3), np.arange(180).reshape(-1, 3)))


TABLE = np.array([[-0.5, -0.5, -1e-3], [0.5, -0.5, -1e-3], [0.5, 0.5, -1e-3], [-0.5, 0.5, -1e-3]])


def table():
    """The sheet that it was scanned on: rough, and half a degree from level."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(-0.2, 0.2, 21), np.linspace(-0.2, 0.2, 21)))
    z = 5e-4 * np.random.default_rng(7).normal(size=x.size) + math.tan(math.radians(0.5)) * (x - 0.2) - 3e-3
    a = (np.arange(20)[:, None] * 21 + np.arange(20)).ravel()
    return np.stack([x, y, z], axis=1), np.concatenate(
        [np.stack([a, a + 1, a + 22], 1), np.stack([a, a + 22, a + 21], 1)]
    )


# what was done to the scan, words of the sentence that says how it was mended
MENDED = {
    "open": ((V[:-1], SIDES), "closed the open bottom"),
    "open and ragged": (ragged(3e-3), "closed the open bottom"),
    "holes": ((V, without(V[1000], 0.02)), "closed 1 hole"),
    "slit": (split(), "closed 1 slit"),
    "noise": ((noisy(4e-4), F), ""),
    "folded": (folded(), "smoothed"),
    "soup": ((V[F].reshape(-1, 3), np.arange(3 * len(F)).reshape(-1, 3)), "merged"),
    "doubled": (joined((V, F), (V, F)), "duplicate faces"),
    "scanned twice": (joined((noisy(3e-4, 1), F), (noisy(3e-4, 2), F)), "united 2 intersecting shells"),
    "skin within skin": (joined((V, F), (CENTRE + 0.999 * (V - CENTRE), F)), "double scan"),
    "inside out": ((V, F[:, ::-1]), "reversed 1 shell"),
    "turned anyhow": (flipped(), "opposite to their neighbours"),
    "dust": (speckled(), "loose piece(s)"),
    "fin": (finned(), "fins"),
    "on its table": (joined((V, F), (TABLE, np.array([[0, 1, 2], [0, 2, 3]]))), "loose piece"),
    "on a rough table": (joined((V, F), table()), "separate open sheet(s)"),
    "cloud": ((bad_scans.scattered(V, F, 6000), NONE), "skin around"),
    "cloud without a bottom": ((bad_scans.scattered(V, SIDES, 6000), NONE), "closed the open bottom"),
    "cloud with noise": ((bad_scans.scattered(V, F, 6000) + 2e-4 * RANDOM.normal(size=(6000, 3)), NONE), "skin around"),
}


@pytest.mark.parametrize(("scan", "words"), MENDED.values(), ids=list(MENDED))
@pytest.mark.verifies("invariant", "the body before it was spoilt", within="1 % of volume, 0.5 % of size")
def test_mended(scan, words, tmp_path):
    """In by one call; volume and centre are those of the body within the bounds that the sentences state."""
    found = read(tmp_path / "scan.ply", *scan)
    assert not words or any(words in sentence for sentence in found.repairs), found.repairs
    volume, shift = stated(found.repairs)
    assert volume <= MOST_VOLUME
    assert shift <= MOST_SHIFT * SIZE
    # noise, sampling and single precision: what the sentences cannot know, a thousandth
    assert found.volume == pytest.approx(VOLUME, rel=volume + 1e-3)
    # a leaning scan is turned upright: its centre above the ground is what is told
    height = found.centre[2] - found.ground
    assert abs(height - CENTRE[2]) <= shift + 1e-3 * SIZE
    assert np.linalg.norm(found.centre - CENTRE) <= shift + 5e-3 * SIZE


@pytest.mark.verifies("invariant", "the body before it leant", within="1 % of the nearest edge's distance")
@pytest.mark.parametrize("degrees", [1.0, 3.0])
def test_an_open_scan_that_leans_is_set_upright(degrees, tmp_path):
    """Its bottom is closed along its rim, and the body set down on that: base and height are the upright one's."""
    turn = rotation_about([1.0, 0.4, 0.0], math.radians(degrees))
    upright = read(tmp_path / "upright.ply", V, F)
    found = read(tmp_path / "leaning.ply", V[:-1] @ turn.T, SIDES)
    assert any("degrees like its rim" in words for words in found.repairs)
    assert found.centre[2] - found.ground == pytest.approx(upright.centre[2] - upright.ground, abs=2e-4 * SIZE)
    margins = [each.base.margin(each.centre[:2]) for each in (found, upright)]
    assert margins[0] == pytest.approx(margins[1], rel=1e-2)
    # the negative control: closed level, as it leans, the centre comes that much nearer to the edge
    assert math.sin(math.radians(degrees)) * CENTRE[2] > 0.02 * margins[1]


@pytest.mark.verifies("closed form", "the prism without its hole", within="1e-6")
def test_a_hole_in_the_top_of_a_plinth_is_no_bottom(tmp_path):
    """Low and level, but it looks up: it is closed by a flat face, not dug down to the ground."""
    outline = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.06), (0.1, 0.06), (0.1, 0.9), (0.0, 0.9)]
    shape = extrusion(outline, 0.3)
    vertices = shape.vertices[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
    level = np.ptp(vertices[shape.faces][..., 2], axis=1) < 1e-12
    top = level & (np.abs(vertices[shape.faces][:, 0, 2] - 0.06) < 1e-9)
    faces = np.delete(shape.faces, np.flatnonzero(top)[0], axis=0)
    assert len(faces) == len(shape.faces) - 1
    found = read(tmp_path / "plinth.ply", vertices, faces, repair="all")
    assert not any("bottom" in words for words in found.repairs), found.repairs
    assert found.volume == pytest.approx(0.3 * (0.4 * 0.06 + 0.1 * 0.84), rel=1e-6)


def stated(repairs):
    """The bounds that sentences state: of the volume [-], of the centre [m]."""
    pattern = r"at most ([\d.e-]+) % of the volume and moves the centre of mass by at most ([\d.e-]+) mm"
    pairs = [tuple(map(float, match)) for words in repairs for match in re.findall(pattern, words)]
    return sum(pair[0] for pair in pairs) / 100.0, sum(pair[1] for pair in pairs) / 1000.0


def read(path, vertices, faces, units="m", **options):
    """The body in a mesh file, read by one call."""
    mesh = trimesh.Trimesh(vertices, faces, process=False) if len(faces) else trimesh.PointCloud(vertices)
    mesh.export(path)
    return rk.read_body(path, units=units, up="z", **options)


# what was done to it, options, words of the refusal, options that help
REFUSED = {
    "wide hole": ((V, without(V[1000], 0.09)), {}, "closed 1 hole", {"repair": "all"}),
    "hole of any size": ((V, without(V[1000], 0.02)), {"repair": "none"}, "1 hole", {"repair": "safe"}),
    "crumpled": ((noisy(6e-3), F), {}, "intersects itself", {"surface": "hull"}),
    "millimetres": ((1000.0 * V, F), {}, 'units="mm"', {"units": "mm"}),
    "sparse cloud": ((bad_scans.scattered(V, F, 400), NONE), {}, "skin around 400 points", {"repair": "all"}),
    "in pieces": ((V[F].reshape(-1, 3) + 2e-3 * RANDOM.normal(size=(3 * len(F), 3)),
                   np.arange(3 * len(F)).reshape(-1, 3)), {}, "too few faces are connected", {"surface": "hull"}),
}  # fmt: skip


@pytest.mark.parametrize(("scan", "options", "words", "helps"), REFUSED.values(), ids=list(REFUSED))
def test_refused_with_the_option_that_helps(scan, options, words, helps, tmp_path):
    """Refused in one sentence that names an option, and with it the body comes in."""
    with pytest.raises(RockingError) as stop:
        read(tmp_path / "scan.obj", *scan, **options)
    assert words in str(stop.value)
    name, value = next(iter(helps.items()))
    assert f'{name}="{value}"' in str(stop.value)
    found = read(tmp_path / "scan.obj", *scan, **{**options, **helps})
    assert 0.9 * VOLUME < found.volume < 1.25 * VOLUME
    assert np.linalg.norm(found.centre - CENTRE) < 0.02 * SIZE


def test_bounds_are_bounds():
    """Without the limit the sentences still bound what changed, a hole of a hand's width too."""
    for radius in (0.03, 0.06, 0.09, 0.12):
        done = repair_surface(V, without(V[1000], radius), repair="all")
        volume, shift = stated(done.repairs)
        found = done.shape.moments()
        assert 0.0 < abs(found.mass - VOLUME) / VOLUME <= volume
        assert np.linalg.norm(found.centre + done.middle - CENTRE) <= shift


@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "glb"])
def test_every_format(kind, tmp_path):
    """An open statue in millimetres, in each format: the same body."""
    found = read(tmp_path / f"statue.{kind}", 1000.0 * V[:-1], SIDES, "mm")
    assert found.volume == pytest.approx(VOLUME, rel=1e-6)
    assert found.centre == pytest.approx(CENTRE, abs=1e-6)


def test_clouds_in_text(tmp_path):
    """Lines of x y z are a cloud; three points are none; points of one plane hold no body."""
    path = tmp_path / "cloud.xyz"
    np.savetxt(path, bad_scans.scattered(V, F, 4000), fmt="%.6f")
    assert rk.read_body(path, units="m").volume == pytest.approx(VOLUME, rel=MOST_VOLUME)
    assert rk.read_body(path, units="m", surface="Faces").volume == rk.read_body(path, units="m").volume
    np.savetxt(path, V[:3], fmt="%.6f")
    with pytest.raises(BodyFileError, match="points are too few"):
        rk.read_body(path, units="m")
    np.savetxt(path, V[:100] * [1.0, 1.0, 0.0], fmt="%.6f")
    with pytest.raises(GeometryError, match="coplanar"):
        rk.read_body(path, units="m")


def test_a_unit_is_doubted(tmp_path):
    """A body of 45 m comes in and is doubted aloud, with the unit that is likelier."""
    found = read(tmp_path / "scan.obj", 50.0 * V, F)
    assert any('check the unit. Possible: units="cm" or ' in words for words in found.repairs)


def test_fewer_faces(monkeypatch):
    """A smooth scan of many faces gets fewer; hull and centre move by no more than is said."""
    vertices, sides, bottom = bad_scans.statue(120, 120)
    faces = np.concatenate([sides, bottom])
    assert len(repair_surface(vertices, faces).shape.faces) == len(faces)
    monkeypatch.setattr(simplify, "MOST_FACES", 20_000)
    done = repair_surface(vertices, faces)
    words = next(sentence for sentence in done.repairs if sentence.startswith("simplified"))
    hull, shift = (float(x) / 1000.0 for x in re.findall(r"(?:at most|of the centre of mass) ([\d.e-]+) mm", words)[:2])
    assert len(done.shape.faces) < 0.7 * len(faces)
    volume, centre = bad_scans.volume_and_centre(vertices, faces)
    found = done.shape.moments()
    assert found.mass == pytest.approx(volume, rel=1.05 * stated(done.repairs)[0])  # said in two digits
    assert np.linalg.norm(found.centre + done.middle - centre) <= 1.05 * shift
    outer = done.shape.hull
    beyond = (vertices - 0.5 * (vertices.min(axis=0) + vertices.max(axis=0)))[::7] @ outer.equations[:, :3].T
    assert (beyond + outer.equations[:, 3]).max() <= 1.05 * hull


ROCK = Path(__file__).parents[5] / "../shared/data/scans/granite_rock.obj"


@pytest.mark.skipif(not ROCK.exists(), reason="the scan of the rock is not beside the repository")
def test_the_rock():
    """In as it lies and in the pose it stood in: volume .12250868 m3, centre .2937263 m, nearest edge 15.7 mm."""
    lying = rk.read_body(ROCK, units="m")
    assert lying.volume == pytest.approx(0.12250868, rel=1e-7)
    stood = rk.read_body(ROCK, units="m", up=(0.8059, 0.2466, -0.5383))
    assert stood.centre[2] - stood.ground == pytest.approx(0.2937263, abs=1e-7)
    edges = np.roll(stood.base.vertices, -1, axis=0) - stood.base.vertices
    arms = stood.centre[:2] - stood.base.vertices
    distances = (edges[:, 0] * arms[:, 1] - edges[:, 1] * arms[:, 0]) / np.linalg.norm(edges, axis=1)
    assert sorted(1000.0 * distances) == pytest.approx([15.7, 23.6, 24.9], abs=0.06)


def test_let_down(tmp_path):
    """Held askew a box comes down onto the face below its centre; upright it is left alone; its place is told."""
    column = box(0.5, 0.4, 1.0)
    askew = column.vertices @ set_down(np.array([0.0, -0.6, -0.8]))
    found = read(tmp_path / "askew.obj", askew, column.faces)
    # the ray at 36.9 degrees leaves the base's plane, half a metre below, .375 m aside, beyond half the depth: it falls
    assert found.centre[2] - found.ground == pytest.approx(0.2, rel=1e-7)
    assert any(words.startswith("not stable in the pose of the file") for words in found.repairs)
    little = column.vertices @ set_down(-np.array([0.0, 0.05, 1.0]) / np.hypot(0.05, 1.0))
    found = read(tmp_path / "little.obj", little, column.faces)
    assert found.centre[2] - found.ground == pytest.approx(0.5, rel=1e-7)
    assert "rotated by 2.9 degrees" in found.repairs[-1]
    assert read(tmp_path / "upright.obj", column.vertices, column.faces).repairs == ()


@pytest.mark.parametrize("seed", range(20))
def test_where_a_hull_comes_to_rest(seed):
    """From anywhere a random hull comes to rest on a facet whose plane is nearest to its centre around: no edge is."""
    generator = np.random.default_rng(seed)
    points = generator.normal(size=(30, 3)) * [1.0, 0.7, 0.5]
    centre = generator.normal(size=3) * 0.05
    turned = (points - centre) @ settled(points, centre).T
    low = turned[:, 2].min()
    touching = turned[turned[:, 2] < low + 1e-9]
    assert len(touching) == 3
    # the foot of the centre lies within their triangle: it is a mean of its corners with weights above zero
    weights = np.linalg.solve(np.vstack([touching[:, :2].T, np.ones(3)]), [0.0, 0.0, 1.0])
    assert (weights > 0.0).all()


def test_which_way_is_up(tmp_path):
    """A direction of the file is up as the letters are; nothing else is."""
    lying = V[:, [0, 2, 1]] * [1.0, 1.0, -1.0]
    trimesh.Trimesh(lying, F, process=False).export(tmp_path / "lying.obj")
    for up in ("y", (0, 1, 0), [0.0, 2.0, 0.0]):
        found = rk.read_body(tmp_path / "lying.obj", units="m", up=up)
        assert found.centre == pytest.approx(CENTRE, abs=1e-6)
    for up in ("x", (0, 0, 0), (1, 2), np.nan, (0.0, np.inf, 1.0)):
        with pytest.raises(InvalidValueError, match="up must be"):
            rk.read_body(tmp_path / "lying.obj", units="m", up=up)


@pytest.mark.parametrize("option", ["repair", "surface"])
def test_options_have_names(option, tmp_path):
    """Another word is refused with those there are."""
    with pytest.raises(InvalidValueError, match=f"{option} must be one of .*, got"):
        read(tmp_path / "scan.obj", V, F, **{option: "most"})


def test_hollow(tmp_path):
    """Walls of 20 mm hold what outer less inner box hold, to the 3 % that are said; in mm and in TOML the same."""
    column = box(0.5, 0.4, 1.0)
    walls = 0.5 * 0.4 * 1.0 - 0.46 * 0.36 * 0.96
    found = read(tmp_path / "column.obj", column.vertices, column.faces, density=8700.0, wall=0.02)
    assert found.volume == pytest.approx(walls, rel=0.03)
    assert found.mass == pytest.approx(8700.0 * found.volume, rel=1e-12)
    assert found.centre == pytest.approx([0.0, 0.0, 0.5], abs=1e-4)
    # a hollow box resists turning more than a solid one of its mass: radii of gyration of two boxes, subtracted
    whole, void = 0.2, 0.46 * 0.36 * 0.96
    square = (whole * (0.5**2 + 0.4**2) - void * (0.46**2 + 0.36**2)) / 12.0 / walls
    assert found.inertia[2, 2] / found.mass == pytest.approx(square, rel=0.01)
    assert "accuracy 3 %" in found.repairs[-1]
    (tmp_path / "column.toml").write_text(
        'units = "cm"\n[[solid.part]]\nmesh = { file = "column.obj", units = "m", wall = 0.02 }\ndensity = 8700\n'
    )
    assert rk.read_body(tmp_path / "column.toml").mass == pytest.approx(found.mass, rel=1e-12)
    with pytest.raises(GeometryError, match="leaves no cavity"):
        read(tmp_path / "column.obj", column.vertices, column.faces, wall=0.21)
    with pytest.raises(InvalidValueError, match="wall must be"):
        read(tmp_path / "column.obj", column.vertices, column.faces, wall=-0.01)


def test_thin_parts_stay_solid(tmp_path):
    """A blade thinner than two walls on a block is not hollow: the block's walls and all of the blade."""
    block, blade = box(0.5, 0.4, 0.3), box(0.3, 0.02, 0.5)
    vertices, faces = joined((block.vertices, block.faces), (blade.vertices + np.array([0.0, 0.0, 0.2]), blade.faces))
    found = read(tmp_path / "blade.obj", vertices, faces, wall=0.02)
    walls = 0.5 * 0.4 * 0.3 - 0.46 * 0.36 * 0.26
    assert found.volume == pytest.approx(walls + 0.3 * 0.02 * 0.4, rel=0.03)


def test_on_the_command_line(tmp_path, run, printed):
    """An open statue in mm, by one command: what was mended is printed; refusals name the options as they are typed."""
    trimesh.Trimesh(1000.0 * V[:-1], SIDES, process=False).export(tmp_path / "statue.stl")
    command = ["restitution", tmp_path / "statue.stl", "--units", "mm"]
    assert "! closed the open bottom" in printed(*command)
    assert "--set body.repair=safe closes an open bottom" in run(*command, "--set", "body.repair=none")[2]
    assert "leaves no cavity" in run(*command, "--set", "body.wall=200")[2]
