"""Body files: what they say is what is built, and what they should not say is refused in one sentence."""

import json
import random
from pathlib import Path

import pytest

from rocking import Block, Section, read_body
from rocking.bodies.formats import body_from_toml
from rocking.bodies.formats.geojson import regions_from_geojson
from rocking.bodies.formats.wkt import regions_from_wkt
from rocking.errors import BodyFileError, RockingError

EXAMPLES = Path(__file__).parents[3] / "examples" / "bodies"
STATUE = (EXAMPLES / "statue_on_pedestal.toml").read_text(encoding="utf-8")
SQUARE = "POLYGON ((0 0, 1 0, 1 2, 0 2, 0 0))"


def lines(*words):
    return "\n".join(words)


def test_units_are_applied():
    """A block of 50 x 200 cm is one of 0.5 x 2 m."""
    body = body_from_toml(lines('units = "cm"', "[block]", "width = 50", "height = 200", "density = 1000.0"))
    assert body == Block(width=0.5, height=2.0, density=1000.0)


@pytest.mark.parametrize(
    ("text", "same"),
    [
        (lines('units = "m"', "[trapezoid]", "base = 1.0", "top = 0.4", "height = 2.5"), (1.0, 0.4, 2.5)),
        (lines('units = "mm"', "[trapezoid]", "base = 1000", "top = 400", "height = 2500"), (1.0, 0.4, 2.5)),
    ],
)
def test_shapes(text, same):
    """A trapezoid by name is the one by constructor."""
    body = body_from_toml(text)
    assert body.side("left").slenderness_ratio == pytest.approx(Section.from_trapezoid(*same).slenderness_ratio)


def test_other_shapes_and_mass_points():
    """Ellipse, regular polygon and mass points are read with their own keys."""
    ellipse = body_from_toml(lines('units = "m"', "[ellipse]", "width = 1.0", "height = 3.0", "sides = 12"))
    hexagon = body_from_toml(lines('units = "m"', "[regular_polygon]", "sides = 6", "radius = 1.0", "depth = 2.0"))
    points = body_from_toml(
        lines('units = "cm"', "[mass_points]", "points = [[0, 200]]", "masses = [2.0]", "feet = [-100, 100]")
    )
    assert (ellipse.centre[1], hexagon.mass) == (
        pytest.approx(1.5, rel=0.05),  # an inscribed polygon of 12 sides sits a little lower
        pytest.approx(1.5 * 3.0**0.5 * 2.0 * 2400.0),
    )
    assert points.slenderness_ratio == pytest.approx(2.0)


@pytest.mark.parametrize("path", sorted(EXAMPLES.iterdir()), ids=lambda path: path.name)
def test_example_files_are_read(path):
    """Every example body is read; drawings need a unit, body files state their own."""
    body = read_body(path, units=None if path.suffix == ".toml" else "m")
    assert body.mass > 0.0


REFUSED = {
    "no unit": (lines("[block]", "width = 1", "height = 2"), "units is missing.*never guessed"),
    "unknown unit": (lines('units = "gal"', "[block]", "width = 1", "height = 2"), "units must be .*'gal'"),
    "negative": (
        lines('units = "m"', "[block]", "width = -1", "height = 2"),
        "block.width must be a number > 0 .m., got -1",
    ),
    "nan": (lines('units = "m"', "[block]", "width = nan", "height = 2"), "block.width"),
    "inf": (lines('units = "m"', "[block]", "width = inf", "height = 2"), "block.width must be a finite"),
    "text": (lines('units = "m"', "[block]", 'width = "1"', "height = 2"), "block.width must be a number .m., got '1'"),
    "boolean": (lines('units = "m"', "[block]", "width = true", "height = 2"), "block.width"),
    "typo": (lines('units = "m"', "[block]", "widht = 1", "height = 2"), "did you mean width"),
    "two shapes": (
        lines('units = "m"', "[block]", "width = 1", "height = 2", "[ellipse]", "width = 1", "height = 1"),
        r"exactly one of.*got \[block\] and \[ellipse\]",
    ),
    "no shape": ('units = "m"', "got none"),
    "broken": ('units = "m', "not TOML"),
    "outline and wkt": (
        lines('units = "m"', "[section]", "[[section.region]]", f'wkt = "{SQUARE}"', "outline = [[0,0],[1,0],[1,1]]"),
        "one of outline, wkt",
    ),
    "bow-tie": (
        lines('units = "m"', "[section]", "[[section.region]]", "outline = [[0,0],[1,1],[1,0],[0,1]]"),
        "crosses or touches itself",
    ),
}


@pytest.mark.parametrize(("text", "words"), REFUSED.values(), ids=list(REFUSED))
def test_refused_in_one_sentence(text, words):
    """What is not a body is refused with place and cause, in one line."""
    with pytest.raises(RockingError, match=words) as caught:
        body_from_toml(text)
    assert "\n" not in str(caught.value)


def test_files_are_named(tmp_path):
    """Errors name the file: missing, empty, too strange, of another kind, without unit."""
    for name, content, words in (
        ("a.toml", b"\xff\xfe", "UTF-8"),
        ("b.toml", b"units = 1", "b.toml: units"),
        ("c.txt", b"", "must end in"),
        ("d.wkt", SQUARE.encode(), "unit"),
        ("e.geojson", b"{", "is not JSON"),
    ):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(BodyFileError, match=words) as caught:
            read_body(path, units="m" if name == "e.geojson" else None)
        assert name in str(caught.value)
    with pytest.raises(BodyFileError, match="no such file"):
        read_body(tmp_path / "missing.toml")
    with pytest.raises(BodyFileError, match="unit"):
        read_body(EXAMPLES / "stele.toml", units="km")


def test_wkt():
    """Polygons with holes and collections are read; lines, empties and nonsense are refused."""
    holed = "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 2, 1 1))"
    (region,) = regions_from_wkt(holed, 1000.0, units="cm")
    assert len(region.holes) == 1
    assert region.outline.max() == pytest.approx(0.04)
    assert len(regions_from_wkt(f"GEOMETRYCOLLECTION ({SQUARE}, {SQUARE})")) == 2
    for bad, words in (("LINESTRING (0 0, 1 1)", "LINESTRING"), ("POLYGON EMPTY", "empty"), ("PLYGON", "not WKT")):
        with pytest.raises(BodyFileError, match=words):
            regions_from_wkt(bad)


def test_geojson():
    """Features carry their density; other geometries and broken objects are refused."""
    ring = [[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]
    feature = {
        "type": "Feature",
        "properties": {"density": 2700.0},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    both = {"type": "FeatureCollection", "features": [feature, {**feature, "properties": None}]}
    assert [region.density for region in regions_from_geojson(json.dumps(both), 2000.0)] == [2700.0, 2000.0]
    for bad in (
        {},
        [],
        {"type": "Point", "coordinates": [0, 0]},
        {"type": "Feature"},
        {"type": "FeatureCollection"},
        {"type": "Polygon"},
        {"type": "Polygon", "coordinates": 3},
        {"type": "Polygon", "coordinates": [[[0]]]},
    ):
        with pytest.raises(RockingError):
            regions_from_geojson(json.dumps(bad))
    with pytest.raises(RockingError, match="density"):
        regions_from_geojson({**feature, "properties": {"density": "heavy"}})


@pytest.mark.parametrize("kind", ["toml", "wkt", "geojson"])
def test_mutated_files_give_a_body_or_our_own_error(kind):
    """700 mutations of a valid text a format: nothing but a body or a RockingError ever comes out."""
    rng = random.Random(7)
    square = json.dumps({"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 2], [0, 2], [0, 0]]]})
    text, read = {
        "toml": (STATUE, body_from_toml),
        "wkt": (SQUARE, lambda words: Section(regions_from_wkt(words))),
        "geojson": (square, lambda words: Section(regions_from_geojson(words))),
    }[kind]
    refused = 0
    for _ in range(700):
        damaged = list(text)
        for _ in range(rng.randint(1, 4)):
            place = rng.randrange(len(damaged))
            damaged[place : place + rng.randint(0, 3)] = rng.choice(["", "-", "9e99", "nan", "[", '"', "0", "é", ","])
        try:
            read("".join(damaged))
        except RockingError:
            refused += 1
    assert refused > 100


def test_a_reader_without_guard_leaks():
    """Negative control: the bare TOML parser raises errors that are not ours on the same kind of damage."""
    import tomllib

    with pytest.raises(tomllib.TOMLDecodeError):
        tomllib.loads(STATUE.replace("[section]", "[section"))


def test_dxf(tmp_path):
    """A drawing in mm with a hole becomes one region; its stated unit may not be contradicted, nor be missing."""
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new()
    space = drawing.modelspace()
    space.add_lwpolyline([(0, 0), (1000, 0), (1000, 3000), (0, 3000)], close=True)
    space.add_circle((500, 1500), 200)
    for unit, name in ((4, "stated.dxf"), (0, "silent.dxf")):
        drawing.header["$INSUNITS"] = unit
        drawing.saveas(tmp_path / name)
    body = read_body(tmp_path / "stated.dxf")
    circle = 0.2**2 * 3.141592653589793
    assert body.mass == pytest.approx(2400.0 * (3.0 - circle), rel=2e-4)  # chords of the circle, 1e-4 of its radius
    with pytest.raises(BodyFileError, match="drawn in mm"):
        read_body(tmp_path / "stated.dxf", units="cm")
    with pytest.raises(BodyFileError, match="unit"):
        read_body(tmp_path / "silent.dxf")
    assert read_body(tmp_path / "silent.dxf", units="mm").mass == pytest.approx(body.mass)
    (tmp_path / "no.dxf").write_text("nothing", encoding="utf-8")
    with pytest.raises(BodyFileError, match=r"no\.dxf"):
        read_body(tmp_path / "no.dxf", units="mm")
