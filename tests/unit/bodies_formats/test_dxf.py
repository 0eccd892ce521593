"""DXF drawings: curves, holes, layers, units, and what is refused."""

import math

import pytest

from rocking import read_body
from rocking.bodies.formats import section_from_dxf
from rocking.bodies.formats.dxf import closed_ellipse, closed_polyline
from rocking.errors import BodyFileError, RockingError

ezdxf = pytest.importorskip("ezdxf")
BOX = [(0, 0), (1000, 0), (1000, 3000), (0, 3000)]


@pytest.fixture
def drawn(tmp_path):
    """Draw with a function and save, with a unit code and a version."""

    def draw(function, unit=4, version="R2010"):
        drawing = ezdxf.new(version)
        drawing.header["$INSUNITS"] = unit
        function(drawing.modelspace())
        path = tmp_path / "drawing.dxf"
        drawing.saveas(path)
        return path

    return draw


def box(space, scale=1.0, layer="0", shift=0.0):
    points = [(x * scale + shift, y * scale + shift) for x, y in BOX]
    space.add_lwpolyline(points, close=True, dxfattribs={"layer": layer})


@pytest.mark.parametrize("version", ["R12", "R2000", "R2010", "R2018"])
def test_polyline(drawn, version):
    """A closed polyline in mm is a section in m, in every version of the format."""
    path = drawn(lambda space: space.add_polyline2d(BOX, close=True), version=version)
    body = read_body(path, units="mm" if version == "R12" else None, density=1000.0)
    assert (body.mass, body.centre) == (pytest.approx(3000.0), pytest.approx((0.5, 1.5)))


def test_units(drawn):
    """Stated units are used, contradictions and silence refused, units without a name here too."""
    assert read_body(drawn(box)).feet == (0.0, 1.0)
    for unit, asked, words in (
        (4, "cm", r'The unit of the drawing is mm \(\$INSUNITS is 4\), but units = "cm"'),
        (0, None, "states no unit"),
        (3, None, r"\$INSUNITS is 3\) must be one of m, cm"),
        (4, "km", "length unit must be one of"),
    ):
        with pytest.raises(RockingError, match=f"drawing.dxf: .*{words}"):
            read_body(drawn(box, unit), units=asked)
    assert read_body(drawn(box, 0), units="cm").feet == (0.0, 10.0)


def test_even_odd_nesting(drawn):
    """A ring in a ring is a hole, and a ring in the hole is solid again."""

    def rings(space):
        box(space, 0.2, shift=400.0)
        box(space)
        space.add_lwpolyline([(300, 300), (700, 300), (700, 1500), (300, 1500)], close=True)

    section = read_body(drawn(rings), density=1.0)
    assert [len(region.holes) for region in section.regions] == [0, 1]
    assert section.mass == pytest.approx(3.0 - 0.4 * 1.2 + 0.2 * 0.6)


def test_layers(drawn):
    """Layers have densities, and what lies on other layers is not read."""

    def inlay(space):
        box(space, layer="stone")
        box(space, 0.5, layer="stone", shift=200.0)
        box(space, 0.5, layer="lead", shift=200.0)
        space.add_line((0, 0), (1, 1), dxfattribs={"layer": "notes"})

    path = drawn(inlay)
    section = section_from_dxf(path, layers={"stone": 2000.0, "lead": 11000.0})
    assert section.mass == pytest.approx(2000.0 * 2.25 + 11000.0 * 0.75)
    with pytest.raises(BodyFileError, match="Unknown layer 'stne'; did you mean stone"):
        section_from_dxf(path, layers={"stne": 2000.0})
    with pytest.raises(BodyFileError, match=r"layer 'notes'.* is not a closed outline"):
        section_from_dxf(path, layers={"stone": 2000.0, "notes": 1.0})
    with pytest.raises(RockingError, match=r"density of layer 'stone' must be > 0"):
        section_from_dxf(path, layers={"stone": -1.0})
    with pytest.raises(BodyFileError, match=r"LINE .* is not a closed outline"):
        read_body(path)
    toml = path.with_name("body.toml")
    toml.write_text('units = "mm"\n[section]\n[[section.region]]\ndxf = "drawing.dxf"\nlayers = {stone = 1000}')
    assert read_body(toml).mass == pytest.approx(2250.0)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_chord_tolerance(drawn, tolerance):
    """Bulge, circle and ellipse stay within the tolerance of the true area: at most perimeter times tolerance."""

    def arch(space):
        points = [(0, 0, 0.0), (1000, 0, 0.0), (1000, 2000, 1.0), (0, 2000, 0.0)]
        space.add_lwpolyline(points, format="xyb", close=True)
        space.add_circle((500, 1000), 200)
        space.add_ellipse((500, 1700), (0, 300), 0.5)

    section = section_from_dxf(drawn(arch), 1.0, chord_tolerance=tolerance)
    arc, circle, ellipse = 0.125 * math.pi, 0.04 * math.pi, 0.045 * math.pi
    assert abs(section.mass - (2.0 + arc - circle - ellipse)) < 5.0 * tolerance
    assert section.local_box[3] == pytest.approx(2.5, abs=tolerance)


def test_seen_from_below(drawn):
    """An outline with its normal downwards is mirrored, as the format means it."""
    path = drawn(
        lambda s: s.add_lwpolyline(
            [(0, 0), (1, 0), (1, 4), (0.5, 4)], close=True, dxfattribs={"extrusion": (0, 0, -1)}
        ),
        6,
    )
    assert read_body(path).feet == (-1.0, 0.0)


REFUSED = {
    "nothing": (lambda space: None, "contains no closed polyline"),
    "open": (lambda space: space.add_lwpolyline(BOX), "The polyline is open. Close it"),
    "line": (lambda space: space.add_line((0, 0), (1, 1)), "is not a closed outline"),
    "spline": (lambda space: space.add_spline([(0, 0), (1, 1), (2, 0)]), "is not a closed outline"),
    "arc": (lambda space: space.add_ellipse((0, 0), (1, 0), 0.5, 0, 1), "an open arc"),
    "one point": (lambda space: space.add_lwpolyline([(0, 0)], close=True), "fewer than two vertices"),
    "tilted": (lambda s: s.add_circle((0, 0), 1, dxfattribs={"extrusion": (0, 1, 1)}), "must lie in the x-y plane"),
    "ball": (lambda space: space.add_circle((0, 0), 1), "at one point"),
    "radius": (lambda space: space.add_circle((0, 0), -1), "radius must be > 0"),
    "bow-tie": (lambda space: space.add_lwpolyline([(0, 0), (1, 1), (1, 0), (0, 1)], close=True), "crosses or touches"),
    "twice": (lambda space: (box(space), box(space)), "are the same curve"),
    "mesh": (lambda space: space.add_polyface(), "is a mesh"),
    "bulge": (
        lambda space: space.add_lwpolyline([(0, 0, 1e9), (1, 0, 0), (1, 1, 0)], format="xyb", close=True),
        "bulge at vertex 0 must be from -1000 to 1000",
    ),
}


@pytest.mark.parametrize(("function", "words"), REFUSED.values(), ids=list(REFUSED))
def test_refused(drawn, function, words):
    """Each refusal names the file and, where there is one, the entity."""
    with pytest.raises(RockingError, match=f"^drawing.dxf: .*{words}"):
        read_body(drawn(function))


def test_not_dxf(tmp_path):
    """Other files under that suffix are refused by name."""
    for content in (b"", b"hello", b"\x00" * 99, b"0\nSECTION\n2\nENTITIES\n0\n"):
        (tmp_path / "x.dxf").write_bytes(content)
        with pytest.raises(BodyFileError, match=r"x\.dxf: "):
            read_body(tmp_path / "x.dxf", units="m")


def test_curves():
    """Too fine a tolerance is refused; a quarter turn to the right is a bulge below zero."""
    with pytest.raises(BodyFileError, match="too small"):
        closed_ellipse(0j, 1 + 0j, 1j, 1e-12)
    hollow = closed_polyline([0j, 1 + 0j, 1 + 1j], [-0.4, 0.0, 0.0], 1e-3)
    assert hollow[:, 1].max() == 1.0
    assert hollow[1:5, 1].min() > 0.0
