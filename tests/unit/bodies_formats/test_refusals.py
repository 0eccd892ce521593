"""What is not a body is refused in one sentence that names file, place and value."""

import builtins
import json
import os

import pytest

from rocking import Block
from rocking.bodies.formats import (
    FORMATS,
    body_from_toml,
    read_body,
    schema,
    section_from_geojson,
    section_from_wkt,
    words,
)
from rocking.conventions import LENGTH_UNITS
from rocking.errors import BodyFileError, GeometryError, InvalidValueError, MissingExtraError, RockingError

REGION = 'units = "m"\n[section]\n[[section.region]]\n'
SQUARE = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}
LOAD = "POLYGON ((0 0, 1 0, 1 1, 0 1, 0 0))"

TOML = {
    "units missing": ("[block]\nwidth = 1\nheight = 2", 'units is missing; add units = "m", or one of m, cm, mm'),
    "unit unknown": ('units = "furlong"\n[block]\nwidth = 1\nheight = 2', "units must be one of 'm', 'cm', 'mm'"),
    "no shape": ('units = "m"', "exactly one of [block], [trapezoid]"),
    "two shapes": (
        'units = "m"\n[block]\nwidth = 1\nheight = 1\n[ellipse]\nwidth = 1\nheight = 1',
        "got [block] and [ellipse]",
    ),
    "key at the top": ('units = "m"\nnme = "x"', "unknown key 'nme'; did you mean name?"),
    "key in a table": ('units = "m"\n[block]\nwidht = 1', "block: unknown key 'widht'; did you mean width?"),
    "negative": ('units = "cm"\n[block]\nwidth = -50\nheight = 2', "block.width must be a number > 0 cm, got -50"),
    "density": (REGION + 'density = 0\nwkt = "x"', "section.region[0].density must be a number > 0 kg/m3, got 0"),
    "boolean": ('units = "m"\n[block]\nwidth = true\nheight = 1', "block.width must be a number [m], got True"),
    "text": ('units = "m"\n[block]\nwidth = "1"\nheight = 1', "block.width must be a number [m], got '1'"),
    "date": ('units = "m"\n[block]\nwidth = 1979-05-27\nheight = 1', "block.width must be a number [m]"),
    "nan": ('units = "m"\n[block]\nwidth = nan\nheight = 1', "block.width must be a finite number [m], got nan"),
    "inf": ('units = "m"\n[block]\nwidth = 1\nheight = -inf', "block.height must be a finite number [m], got -inf"),
    "two problems": ('units = "m"\n[block]\nwidth = 0\nheight = 0', "(and 1 more)"),
    "too large": ('units = "m"\n[block]\nwidth = 1e12\nheight = 1', "width must be in [1e-09, 1e+09] m, got 1e+12"),
    "point": (REGION + "outline = [[0, 0], [1, 0, 3], [1, 1]]", "section.region[0].outline[1] must have at most 2"),
    "two points": (REGION + "outline = [[0, 0], [1, 0]]", "section.region[0].outline must have at least 3 entries"),
    "no source": (REGION + "density = 1", "A region needs one of outline, wkt, geojson or dxf, got none"),
    "two sources": (REGION + 'wkt = ""\ngeojson = ""', "got wkt and geojson"),
    "holes with wkt": (REGION + 'wkt = ""\nholes = []', "holes is not allowed with wkt"),
    "file from text": (REGION + 'dxf = "a.dxf"', "is not allowed in a text without a folder"),
    "no regions": ('units = "m"\n[section]\nregion = []', "section.region must have at least 1 entries, got 0"),
    "sides": (
        'units = "m"\n[ellipse]\nwidth = 1\nheight = 1\nsides = 2.5',
        "ellipse.sides must be a whole number, got",
    ),
    "not a table": ('units = "m"\nblock = 3', "block must be a table, got 3"),
    "masses": (
        'units = "m"\n[mass_points]\npoints = [[0, 1]]\nmasses = [-1]\nfeet = [-1, 1]',
        "mass_points.masses[0] must be a number > 0 kg, got -1",
    ),
    "contact": (
        'units = "m"\n[mass_points]\npoints = [[0, 1]]\nmasses = [1]\nfeet = [-1, 1]\ncontact = [[1, -1]]',
        "contact[0] must run from left to right",
    ),
    "broken": (
        'units = "m"\n[block\n',
        "Invalid TOML: Expected ']' at the end of a table declaration (at line 2, column",
    ),
    "digits": ("a = " + "9" * 5000, "Unreadable TOML"),
    "brackets": ("a = " + "[" * 9999, "Unreadable TOML"),
    "no text": (3, "A body file must be text, got int"),
}


@pytest.mark.parametrize(("text", "words"), TOML.values(), ids=list(TOML))
def test_toml(text, words):
    """Each refusal of a body file names the file and says what is wrong where."""
    with pytest.raises(RockingError) as caught:
        body_from_toml(text, "pier.toml")
    assert str(caught.value).startswith("pier.toml: ")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300


def test_geometry_keeps_its_own_error():
    """A bow-tie in a file is a GeometryError still, with file and region in front."""
    with pytest.raises(GeometryError, match=r"x\.toml: section\.region\[0\]: .*crosses or touches itself"):
        body_from_toml(REGION + "outline = [[0, 0], [1, 1], [1, 0], [0, 1]]", "x.toml")


WKT = {
    "": "The text is empty",
    "POINT (0 0)": "A POINT encloses no area",
    "LINESTRING (0 0, 1 1)": "A LINESTRING encloses no area",
    "POLYGON EMPTY": "The POLYGON is empty",
    "GEOMETRYCOLLECTION EMPTY": "The GEOMETRYCOLLECTION is empty",
    "POLYGON ((0 0, 1 0, 1 1))": "closed linestring",
    "POLYGON Z ((0 0 1, 1 0 1, 1 1 1, 0 0 1))": "z and m coordinates are not allowed",
    "POLYGON ((0 0, nan 0, 1 1, 0 0))": "must be finite",
    "POLYGON ((0 0, 1e400 0, 1 1, 0 0))": "must be finite",
    "POLYGON ((0 0, 1 0, 1 1, 0 0)) x": "Invalid WKT: Unexpected text",
    "POLYGON ((0 0, 1 0, 1 1, 0 0))\0": "NUL",
    "CURVEPOLYGON ((0 0, 1 0, 1 1, 0 0))": "Invalid WKT",
    "GEOMETRYCOLLECTION (" * 100_000: "nested more than 16",
    "POLYGON ((0 0, 1 1, 1 0, 0 1, 0 0))": "polygon 0: region: outline crosses",
}


@pytest.mark.parametrize(("text", "words"), WKT.items(), ids=range(len(WKT)))
def test_wkt(text, words):
    """Each refusal of WKT says what it is; a hundred thousand brackets do not reach GEOS."""
    with pytest.raises(RockingError, match=words) as caught:
        section_from_wkt(text, name="a.wkt")
    assert str(caught.value).startswith("a.wkt: ")


def test_densities_of_wkt():
    """One density a polygon, in order; a wrong number of them, or none at all, is refused."""
    two = "MULTIPOLYGON (((0 0, 1 0, 1 1, 0 1, 0 0)), ((0 1, 1 1, 1 2, 0 2, 0 1)))"
    assert [region.density for region in section_from_wkt(two, [1.0, 2.0]).regions] == [1.0, 2.0]
    assert section_from_wkt(two, 3.0, units="cm", depth=2.0).mass == pytest.approx(3.0 * 2e-4 * 2.0)
    with pytest.raises(BodyFileError, match=r"number of polygons, 2, got 3"):
        section_from_wkt(two, [1.0, 2.0, 3.0])
    with pytest.raises(InvalidValueError, match="density must be a number"):
        section_from_wkt(two, "heavy")
    with pytest.raises(InvalidValueError, match="length unit"):
        section_from_wkt(two, units="km")
    with pytest.raises(GeometryError, match="overlap"):
        section_from_wkt(f"GEOMETRYCOLLECTION ({LOAD}, {LOAD})")


def feature(geometry=SQUARE, **properties):
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def polygon(*positions):
    return {"type": "Polygon", "coordinates": [list(positions)]}


GEOJSON = {
    "not JSON": ("{", "Invalid JSON: Expecting property name.*line 1 column 2"),
    "NaN": ('{"type": NaN}', "value NaN is not allowed"),
    "digits": ("9" * 5000, "Unreadable JSON"),
    "brackets": ("[" * 100_000, "Unreadable JSON"),
    "no object": ("[]", "the document must be a GeoJSON object"),
    "no type": ({}, "has no member 'type'"),
    "line": ({"type": "LineString", "coordinates": []}, "got 'LineString'"),
    "no geometry": (feature(None), "geometry must be a GeoJSON object, got None"),
    "density": (feature(density=-1), "properties.density must be > 0 kg/m3, got -1"),
    "density text": (feature(density="2400"), "properties.density must be a number"),
    "properties": ({**feature(), "properties": 3}, "properties must be an object"),
    "empty": ({"type": "FeatureCollection", "features": []}, "features must be a nonempty list"),
    "open": (polygon([0, 0], [1, 0], [1, 1], [0, 1]), "must end at its first position"),
    "short": (polygon([0, 0], [1, 0], [0, 0]), "at least 4 positions"),
    "three": (polygon([0, 0, 1], [1, 0], [1, 1], [0, 0]), r"coordinates\[0\]\[0\] must be a position \[x, y\]"),
    "bool": (polygon([0, 0], [True, 0], [1, 1], [0, 0]), "must be a number"),
    "huge": (polygon([0, 0], [10**400, 0], [1, 1], [0, 0]), "must be one number"),
    "number as ring": ({"type": "MultiPolygon", "coordinates": [3]}, "must be a list of rings"),
    "place": (
        {"type": "FeatureCollection", "features": [feature(), feature(polygon([0, 0]))]},
        r"a.geojson: features\[1\].geometry: coordinates\[0\]",
    ),
}


@pytest.mark.parametrize(("given", "words"), GEOJSON.values(), ids=list(GEOJSON))
def test_geojson(given, words):
    """Each refusal of GeoJSON names the member that is wrong."""
    with pytest.raises(RockingError, match=words):
        section_from_geojson(given, name="a.geojson")


def test_geojson_kinds():
    """Collections of collections, features with and without density, text and dict."""
    upper = polygon([0, 1], [1, 1], [1, 2], [0, 2], [0, 1])
    whole = {
        "type": "GeometryCollection",
        "geometries": [SQUARE, {"type": "MultiPolygon", "coordinates": [upper["coordinates"]]}],
    }
    for given in (
        whole,
        json.dumps(whole),
        feature(whole),
        {"type": "FeatureCollection", "features": [feature(whole)]},
    ):
        assert section_from_geojson(given, 1000.0).mass == pytest.approx(2000.0)
    two = {"type": "FeatureCollection", "features": [feature(density=500.0), {**feature(upper), "properties": None}]}
    assert section_from_geojson(two, 1000.0).mass == pytest.approx(1500.0)
    loop = {"type": "GeometryCollection", "geometries": []}
    loop["geometries"].append(loop)
    with pytest.raises(BodyFileError, match="nested more than"):
        section_from_geojson(loop)


def test_read_body(tmp_path):
    """Suffix, missing file, folder, size, encoding, units: each in one sentence with the file's name."""
    (tmp_path / "a.wkt").write_text(LOAD.replace("0 0", "0 5").replace("1 0", "1 5").replace(" 1,", " 6,"))
    (tmp_path / "b.toml").write_text('units = "cm"\n[block]\nwidth = 1\nheight = 2', encoding="utf-8-sig")
    (tmp_path / "c.toml").write_bytes(b"\xff\xfe")
    (tmp_path / "d.toml").mkdir()
    (tmp_path / "e.json").write_text(json.dumps(SQUARE))
    assert read_body(tmp_path / "a.wkt", units="cm").ground == 0.05
    assert read_body(str(tmp_path / "b.toml"), units="cm") == Block(width=0.01, height=0.02)
    assert read_body(tmp_path / "e.json", units="m", density=3.0, depth=2.0).mass == 6.0
    for name, options, said in (
        ("a.wkt", {}, "a.wkt: The file states no unit; add units=, one of m, cm"),
        ("b.toml", {"units": "m"}, 'b.toml: The file has units = "cm", but units = "m" is requested'),
        ("b.toml", {"density": 3.0}, "b.toml: density is not allowed with a TOML body file; edit the file"),
        ("c.toml", {}, "c.toml: The file is not UTF-8 text"),
        ("d.toml", {}, "d.toml: This is not a file"),
        (
            "e.json",
            {"units": "m", "ground": -1.0},
            "e.json: the lowest point of the body, y = 0 m, is above the ground",
        ),
        ("f.toml", {}, "f.toml: no such file"),
        ("g.txt", {}, "g.txt: Unsupported file. Use .toml, .wkt"),
    ):
        with pytest.raises(RockingError) as caught:
            read_body(tmp_path / name, **options)
        assert said in str(caught.value)
    for strange in (3, "a\0.toml", "x" * 9999 + ".toml"):
        with pytest.raises(BodyFileError):
            read_body(strange)


def test_large_files_and_outlines(tmp_path, monkeypatch):
    """A file above the limit is not even opened; vertices have a limit of their own."""
    with (tmp_path / "a.wkt").open("wb") as file:
        os.truncate(file.fileno(), words.LARGEST_FILE + 1)
    with pytest.raises(BodyFileError, match=r"a.wkt: A body file has at most 64 MiB, got 64.0 MiB"):
        read_body(tmp_path / "a.wkt", units="m")
    monkeypatch.setattr(words, "MOST_VERTICES", 4)
    for read, given in ((section_from_wkt, LOAD), (section_from_geojson, SQUARE)):
        with pytest.raises(BodyFileError, match="The body has 5 vertices; at most 4 are allowed"):
            read(given)


def test_files_beside_the_body_file(tmp_path):
    """Regions come from files in the folder, in their own unit; nothing outside the folder is opened."""
    folder = tmp_path / "here"
    folder.mkdir()
    (folder / "a.geojson").write_text(json.dumps(SQUARE))
    (tmp_path / "out.geojson").write_text(json.dumps(SQUARE))
    toml = folder / "body.toml"
    toml.write_text(REGION + 'geojson = "a.geojson"\nunits = "cm"\ndensity = 1000\n')
    assert read_body(toml).mass == pytest.approx(0.1)
    for name in ("../out.geojson", str(tmp_path / "out.geojson"), "a\\u0000", "~/a.geojson", "none.geojson"):
        toml.write_text(REGION + f'geojson = "{name}"')
        with pytest.raises(BodyFileError, match=r"body.toml: section.region\[0\]: "):
            read_body(toml)


def test_dxf_extra_missing(tmp_path, monkeypatch):
    """Without ezdxf the error says what to install."""
    real = builtins.__import__

    def without(name, *rest, **more):
        if name.startswith("ezdxf"):
            raise ImportError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtraError, match=r'^reading DXF needs ezdxf: pip install "rocking\[dxf\]"'):
        read_body(tmp_path / "a.dxf", units="m")


def test_schema_agrees_with_the_package():
    """The schema's units are the package's, and every format has a reader."""
    assert schema.UnitName.__args__ == tuple(LENGTH_UNITS)
    assert set(FORMATS) == {".toml", ".wkt", ".geojson", ".json", ".dxf", ".stl", ".obj", ".ply", ".glb", ".xyz"}


def test_whatever_a_reader_raises_is_a_refusal(monkeypatch, tmp_path):
    """Of sections, of meshes and of solids in TOML; the error itself stays chained, so that a bug is seen."""
    cause = IndexError("list index out of range")

    def broken(*_, **__):
        raise cause

    monkeypatch.setitem(FORMATS, ".wkt", broken)
    monkeypatch.setitem(FORMATS, ".toml", broken)
    monkeypatch.setattr("rocking.bodies.formats.reader.solid_from_mesh", broken)
    for name, units in (("a.wkt", "m"), ("a.stl", "m"), ("a.toml", None)):
        with pytest.raises(BodyFileError, match=rf"{name}: The file is unreadable \(IndexError: list index") as caught:
            read_body(tmp_path / name, units=units)
        assert caught.value.__cause__ is cause


def test_a_keyword_that_does_not_exist_is_no_damage(tmp_path):
    """It stays the TypeError of a wrong call."""
    with pytest.raises(TypeError, match="read_body\\(\\) has no foot"):
        read_body(tmp_path / "a.wkt", foot=(0.0, 1.0))
