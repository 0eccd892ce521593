"""Bodies in space from files: every shape against its closed form, meshes with their repairs, and what is refused."""

import math
import random
import re

import numpy as np
import pytest

from rocking.bodies.formats import body_from_toml, describes_solid, read_body, read_plane_body, solid_from_toml
from rocking.bodies.solid import Polyhedron, RoundBase, box
from rocking.errors import BodyFileError, GeometryError, InvalidValueError, RockingError

pytestmark = pytest.mark.verifies(room="bodies")

PLINTH = "[[solid.part]]\nbox = { width = 4.0, depth = 4.0, height = 1.0 }\ndensity = 1.0\n"
SHAPES = {
    "box": ("box = { width = 1.0, depth = 2.0, height = 3.0 }", 6.0, 1.5),
    "cylinder": ("cylinder = { diameter = 2.0, height = 3.0 }", 3.0 * math.pi, 1.5),
    "cone": ("cone = { diameter = 2.0, height = 3.0 }", math.pi, 0.75),
    # V = pi h / 12 (D2 + D d + d2), centre h / 4 (D2 + 2 D d + 3 d2) / (D2 + D d + d2)
    "frustum": ("frustum = { lower_diameter = 2.0, upper_diameter = 1.0, height = 3.0 }", 1.75 * math.pi, 33 / 28),
    "sphere": ("sphere = { diameter = 2.0 }", 4.0 * math.pi / 3.0, 1.0),
    "half a sphere": ("sphere = { diameter = 2.0, cut_below = 1.0 }", 2.0 * math.pi / 3.0, 0.375),
    "ellipsoid": ("ellipsoid = { width = 1.0, depth = 2.0, height = 3.0 }", math.pi, 1.5),
    "extrusion": (
        "extrusion = { outline = [[0, 0], [2, 0], [2, 2], [0, 2]], height = 3.0, "
        "holes = [[[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]]] }",
        9.0,
        1.5,
    ),
    "revolution": ("revolution = { profile = [[1.0, 0.0], [1.0, 3.0]] }", 3.0 * math.pi, 1.5),
}


@pytest.mark.verifies("closed form", "volumes and centres of all shapes, in three units", within="1e-12")
@pytest.mark.parametrize("unit", [("m", 1.0), ("cm", 0.01), ("ft", 0.3048)])
@pytest.mark.parametrize(("shape", "volume", "height"), SHAPES.values(), ids=list(SHAPES))
def test_every_shape_has_its_volume_and_centre(shape, volume, height, unit):
    """On a plinth of 16 m3 each shape adds its volume times density, at its height: closed forms, in every unit."""
    name, scale = unit
    text = f'units = "{name}"\n{PLINTH}[[solid.part]]\n{shape}\ndensity = 2000.0\nat = [0.0, 0.0, 1.0]\n'
    solid = solid_from_toml(text)
    masses = 16.0 * scale**3, 2000.0 * volume * scale**3
    assert solid.mass == pytest.approx(sum(masses), rel=1e-12, abs=0.0)
    centre = (masses[0] * 0.5 + masses[1] * (1.0 + height)) / sum(masses) * scale
    assert solid.centre[2] == pytest.approx(centre, rel=1e-12, abs=0.0)


def test_turns_come_before_the_place():
    """A bar along z turned about y lies along x; two turns are taken in their order; then the part is moved."""
    bar = "[[solid.part]]\nbox = { width = 0.2, depth = 0.4, height = 2.0 }\ndensity = 1000.0\n"
    lying = solid_from_toml(f'units = "m"\n{bar}turned = [{{ axis = [0, 1, 0], degrees = 90 }}]\nat = [5, 6, 7]')
    np.testing.assert_allclose(lying.box, [[5.0, 5.8, 6.9], [7.0, 6.2, 7.1]], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(lying.centre, [6.0, 6.0, 7.0], rtol=0.0, atol=1e-12)
    assert lying.ground == pytest.approx(6.9)
    two = "turned = [{ axis = [0, 1, 0], degrees = 90 }, { axis = [0, 0, 1], degrees = 90 }]"
    other = "turned = [{ axis = [0, 0, 1], degrees = 90 }, { axis = [0, 1, 0], degrees = 90 }]"
    sizes = [np.ptp(solid_from_toml(f'units = "m"\n{bar}{turns}').box, axis=0) for turns in (two, other)]
    np.testing.assert_allclose(sizes[0], [0.4, 2.0, 0.2], rtol=0.0, atol=1e-12)
    # negative control: the other order is another body
    np.testing.assert_allclose(sizes[1], [2.0, 0.2, 0.4], rtol=0.0, atol=1e-12)


def test_base_ground_and_name():
    """The base is found or given; the body stands on its lowest point, or on the ground that is stated."""
    drum = 'units = "cm"\nname = "drum"\n[[solid.part]]\ncylinder = { diameter = 100, height = 50 }\nat = [0, 0, 20]\n'
    found = solid_from_toml(drum)
    assert isinstance(found.base, RoundBase)
    assert (found.name, found.repairs) == ("drum", ())
    assert found.base.radius == pytest.approx(0.5)
    assert found.ground == pytest.approx(0.2)
    points = drum + "[solid]\nbase = [[-30, -30], [30, -30], [0, 40]]\nground = 20\n"
    np.testing.assert_allclose(solid_from_toml(points).base.vertices, [[-0.3, -0.3], [0.3, -0.3], [0.0, 0.4]])
    with pytest.raises(GeometryError, match=r"solid: The lowest point of the body, z = .* is above the ground"):
        solid_from_toml(drum + "[solid]\nground = 0\n")


def test_a_mesh_beside_the_file(tmp_path, mesh):
    """A part may be a mesh below the file's folder, in a unit of its own; its repairs are told by its name."""
    mesh("prism.stl", scale=1000.0, turn=3)
    text = (
        f'units = "m"\n{PLINTH}[[solid.part]]\ndensity = 500.0\nat = [0, 0, 1]\n'
        'mesh = { file = "prism.stl", units = "mm" }\n'
    )
    path = tmp_path / "both.toml"
    path.write_text(text, encoding="utf-8")
    found = read_body(path)
    assert found.mass == pytest.approx(16.0 + 2000.0, rel=1e-6)  # STL rounds coordinates to single precision
    assert any("prism.stl: reversed 1 of 12 faces" in sentence for sentence in found.repairs)
    for name in ("../prism.stl", "/prism.stl", "none.stl"):
        with pytest.raises(BodyFileError, match=r"solid\.part\[1\]"):
            solid_from_toml(text.replace("prism.stl", name), folder=tmp_path)
    with pytest.raises(BodyFileError, match="is not allowed in a text without a folder"):
        solid_from_toml(text)


@pytest.mark.slow
def test_inner_parts_are_stated_at_every_door(tmp_path, run, answered):
    """A box of .75 m3 in one of 6 m3, wound like it: refused by name, 6 or 5.25 t as stated, in every answer."""
    trimesh = pytest.importorskip("trimesh")
    outer, inner = box(1.0, 2.0, 3.0), box(0.5, 1.0, 1.5)
    points = np.concatenate([outer.vertices, inner.vertices + np.array([0.1, -0.2, 0.4])])
    path = tmp_path / "two.obj"
    trimesh.Trimesh(points, np.concatenate([outer.faces, inner.faces + 8]), process=False).export(path)
    part = "[[solid.part]]\ndensity = 1000.0\nmesh = { file = 'two.obj', units = 'm' }\n"
    with pytest.raises(GeometryError, match=r"two\.obj: 1 closed part inside .* about \(0\.1, -0\.2, 1\.15\) m"):
        read_body(path, units="m", density=1000.0)
    with pytest.raises(GeometryError, match=r"two\.obj: 1 closed part inside"):
        solid_from_toml('units = "m"\n' + part, folder=tmp_path)
    said = ["equilibria", path, "--units", "m", "--density", "1000"]
    assert "--set body.inner_parts=solid or --set body.inner_parts=cavity" in run(*said)[2]
    for how, mass in (("solid", 6000.0), ("cavity", 5250.0)):
        text = 'units = "m"\n' + part.replace(" }", f", inner_parts = '{how}' }}")
        printed = answered(*said, "--set", f"body.inner_parts={how}")
        solids = read_body(path, units="m", density=1000.0, inner_parts=how), solid_from_toml(text, folder=tmp_path)
        found = [(printed["body"]["mass"], printed["body"]["repairs"]), *((each.mass, each.repairs) for each in solids)]
        for weight, repairs in found:
            assert weight == pytest.approx(mass, rel=1e-12)
            assert any(f'inner_parts="{how}" applied' in each for each in repairs)


@pytest.mark.parametrize("name", ["a.stl", "a.obj", "a.ply"])
def test_meshes_ask_for_their_unit(mesh, name):
    """Formats without a unit ask for one; with it mass and base of the prism are exact."""
    path = mesh(name, scale=1000.0)
    with pytest.raises(BodyFileError, match=f"{name}: {name[2:].upper()} files state no unit"):
        read_body(path)
    solid = read_body(path, units="mm", density=1000.0)
    assert solid.mass == pytest.approx(4000.0, rel=1e-6)
    assert len(solid.base.vertices) == 4


def test_glb_is_read_as_its_specification_says(mesh):
    """GLB is in metres with y up, and that is told; asked for z, the same file lies down."""
    path = mesh("a.glb", shape=box(1.0, 4.0, 1.0))
    found = read_body(path)
    assert found.centre[2] - found.ground == pytest.approx(2.0)
    assert found.repairs == ("read in m and with y up, by the specification of GLB",)
    lying = read_body(path, up="z", units="m")
    assert lying.centre[2] - lying.ground == pytest.approx(0.5)
    assert lying.repairs == ()


def test_holes_are_refused_or_closed(mesh):
    """A missing face of an eighth of the surface is refused with its place; a small hole is closed, and told."""
    with pytest.raises(GeometryError, match=r"a\.obj: The surface is not closed: 1 hole"):
        read_body(mesh("a.obj", keep=slice(1, None)), units="m", repair="none")
    with pytest.raises(GeometryError, match=r'a\.obj: The repairs may change .* repair="all" to allow'):
        read_body(mesh("a.obj", keep=slice(-1)), units="m")
    # a prism whose top has a corner cut off: one triangle of 0.02 m2 of 18 m2 is missing
    x = 0.5
    square = [(-x, -x), (x, -x), (x, x), (-x, x)]
    cut = [(-x, -x + 0.2, 4.0), (-x + 0.2, -x, 4.0)]
    points = np.array([*((*p, 0.0) for p in square), *((*p, 4.0) for p in square), *cut])
    rings = [(0, 3, 2, 1), (0, 1, 5, 9, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 8, 7), (9, 5, 6, 7, 8), (4, 9, 8)]
    faces = np.array([(ring[0], ring[i], ring[i + 1]) for ring in rings for i in range(1, len(ring) - 1)])
    prism = Polyhedron(points, faces)
    path = mesh("small.ply", keep=slice(0, -1), shape=prism)
    found = read_body(path, units="m", density=1000.0)
    assert found.mass == pytest.approx(4000.0, rel=1e-9)
    assert any(sentence.startswith("closed 1 hole") for sentence in found.repairs)


def test_which_reader_is_to_be_asked(tmp_path):
    """Meshes and TOML with [solid] are bodies in space, of which a door for plane bodies reads none."""
    solid, plane, broken = (tmp_path / f"{name}.toml" for name in ("solid", "plane", "broken"))
    solid.write_text(f'units = "m"\n{PLINTH}', encoding="utf-8")
    plane.write_text('units = "m"\n[block]\nwidth = 1\nheight = 2\n', encoding="utf-8")
    broken.write_text("units = [", encoding="utf-8")
    assert [describes_solid(path) for path in (solid, plane, broken, tmp_path / "a.STL", "a.dxf", "none.toml")] == [
        True, False, False, True, False, False,
    ]  # fmt: skip
    assert [type(read_body(path)).__name__ for path in (solid, plane)] == ["Solid", "Block"]
    assert read_plane_body(plane).mass == read_body(plane).mass
    with pytest.raises(BodyFileError, match=r"solid\.toml: This is a 3D body"):
        read_plane_body(solid)
    with pytest.raises(BodyFileError, match=r"a\.stl: Unsupported file. Use \.toml, .*, \.dxf\.$"):
        read_plane_body("a.stl")
    with pytest.raises(BodyFileError, match="solid is missing"):
        solid_from_toml('units = "m"')


BOX = "box = { width = 1.0, depth = 1.0, height = 1.0 }"
HEAD = 'units = "m"\n[[solid.part]]\n'
REFUSED = {
    "no unit": (f"[[solid.part]]\n{BOX}", "units is missing"),
    "no part": ('units = "m"\n[solid]\n', "solid.part is missing"),
    "no shape": (HEAD + "density = 1.0", "solid.part[0]: a part needs exactly one of box, cylinder"),
    "two shapes": (HEAD + BOX + "\ncone = { diameter = 1.0, height = 1.0 }", "got box and cone"),
    "unknown shape": (HEAD + "cube = 1.0", "unknown key 'cube'"),
    "unknown size": (
        HEAD + "box = { width = 1.0, deph = 1.0, height = 1.0 }",
        "unknown key 'deph'; did you mean depth?",
    ),
    "negative": (HEAD + BOX.replace("width = 1.0", "width = -1.0"), "solid.part[0].box.width must be a number > 0 m"),
    "nan": (HEAD + BOX.replace("width = 1.0", "width = nan"), "must be a finite number [m], got nan"),
    "infinite": (HEAD + BOX.replace("width = 1.0", "width = inf"), "must be a finite number [m], got inf"),
    "text": (HEAD + BOX.replace("width = 1.0", 'width = "1"'), "must be a number [m], got '1'"),
    "boolean": (HEAD + BOX.replace("width = 1.0", "width = true"), "must be a number [m], got True"),
    "huge": (HEAD + BOX.replace("width = 1.0", "width = 1e300"), "solid.part[0]: width"),
    "density": (HEAD + BOX + "\ndensity = 0", "density must be a number > 0 kg/m3, got 0"),
    "degrees": (HEAD + BOX + "\nturned = [{ axis = [0, 0, 1], degrees = nan }]", "must be a finite number [degree]"),
    "no axis": (HEAD + BOX + "\nturned = [{ axis = [0, 0, 0], degrees = 9 }]", "axis must be a nonzero vector"),
    "two coordinates": (HEAD + BOX + "\nat = [0, 0]", "at must have at least 3 entries, got 2"),
    "beyond": (HEAD + BOX + "\nat = [0, 0, 1e300]", "at must be within 1e+08 x the size"),
    "too deep a cut": (HEAD + "sphere = { diameter = 1.0, cut_below = 2.0 }", "cut_below must be in"),
    "profile": (HEAD + "revolution = { profile = [[1, 1], [1, 0]] }", "the profile must end above its start"),
    "crossing": (HEAD + "extrusion = { outline = [[0, 0], [1, 1], [1, 0], [0, 1]], height = 1.0 }", "solid.part[0]"),
    "overlap": (HEAD + BOX + "\n[[solid.part]]\n" + BOX, "overlap"),
    "a point": (HEAD + "sphere = { diameter = 1.0 }", "solid: "),
    "tilted": (HEAD + BOX + "\nturned = [{ axis = [1, 2, 0], degrees = 10 }]", "a base with an area is needed"),
    "two bodies": (HEAD + BOX + "\n[block]\nwidth = 1\nheight = 1", "unknown key 'block'"),
    "no toml": ("units = [", "Invalid TOML"),
    "mesh of no kind": (HEAD + 'mesh = { file = "a.exe" }', "a.exe"),
}


@pytest.mark.parametrize(("text", "words"), REFUSED.values(), ids=list(REFUSED))
def test_bad_files_are_refused_in_one_sentence(text, words, tmp_path):
    """Every refusal is one sentence of this package that names the file and the place; none is a body."""
    (tmp_path / "a.exe").write_bytes(b"MZ")
    path = tmp_path / "body.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RockingError) as refused:
        read_body(path)
    assert str(refused.value).startswith("body.toml: ")
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_toml_file_says_everything_itself(tmp_path):
    """Options for meshes are refused beside a TOML file, a unit that contradicts it too."""
    path = tmp_path / "a.toml"
    path.write_text(f'units = "m"\n{PLINTH}', encoding="utf-8")
    with pytest.raises(BodyFileError, match="density, up, repair is not allowed with a TOML body file"):
        read_body(path, density=1.0, up="z", repair="all")
    with pytest.raises(BodyFileError, match='The file has units = "m", but units = "cm" is requested'):
        read_body(path, units="cm")
    assert read_body(path, units="m").mass == pytest.approx(16.0)


def test_what_is_no_file(tmp_path):
    """No path, another ending, options of another kind of file, a density that is none, a solid that is not wanted."""
    with pytest.raises(BodyFileError, match="path must be the path of a body file"):
        read_body(3)
    with pytest.raises(BodyFileError, match=r"Use \.toml, \.wkt, .*\.dxf, \.stl, \.obj, \.ply, \.glb, \.xyz"):
        read_body("a.exe")
    for name, option, words in (
        ("a.wkt", {"up": "z"}, "does not accept up"),
        ("a.stl", {"depth": 1.0}, "does not accept depth"),
    ):
        (tmp_path / name).write_text("POLYGON ((0 0, 1 0, 1 1, 0 0))")
        with pytest.raises(BodyFileError, match=words):
            read_body(tmp_path / name, units="m", **option)
    with pytest.raises(BodyFileError, match="no such file"):
        read_body("none.stl", units="m")
    with pytest.raises(InvalidValueError, match="density must be"):
        read_body("none.stl", units="m", density=math.nan)
    with pytest.raises(BodyFileError, match="This is a 3D body"):
        body_from_toml(f'units = "m"\n{PLINTH}')


JUNK = ["nan", "inf", "-1.0", "0", "1e300", "1e-300", "true", '"x"', "[]", "[1]", "{}", "[[0, 0], [1, 0], [0, 1]]"]


@pytest.mark.slow
def test_mutated_files_never_leak():
    """2,000 files with a value replaced: a body with finite mass and centre, or a refusal of this package."""
    texts = [f'units = "m"\n{PLINTH}[[solid.part]]\n{shape}\nat = [0.0, 0.0, 1.0]\n' for shape, _, _ in SHAPES.values()]
    rng, bodies, refused = random.Random(3), 0, []
    for _ in range(2000):
        text = rng.choice(texts)
        places = list(re.finditer(r"\d+\.?\d*", text))
        place = rng.choice(places)
        try:
            solid = solid_from_toml(text[: place.start()] + rng.choice(JUNK) + text[place.end() :])
            assert math.isfinite(solid.mass)
            assert solid.mass > 0.0
            assert np.isfinite([*solid.centre, *solid.inertia.ravel()]).all()
            bodies += 1
        except RockingError as error:
            refused.append(str(error))
    assert all(sentence.startswith("<text>: ") for sentence in refused)
    assert len(refused) > 1000
    assert bodies > 50
