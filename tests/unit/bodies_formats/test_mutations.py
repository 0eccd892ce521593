"""Damaged files give a body or a RockingError, and nothing else."""

import json
import math
import random
import re
import tomllib

import pytest

from rocking import examples
from rocking.bodies import Body
from rocking.bodies.formats import body_file, body_from_toml, read_body, section_from_geojson, section_from_wkt
from rocking.errors import RockingError

pytestmark = pytest.mark.verifies(room="bodies")

EXAMPLES = examples.path("statue").parent
PLANE = [text for path in sorted(EXAMPLES.glob("*.toml")) if "[solid" not in (text := path.read_text("utf-8"))]
TOML = [
    *PLANE,
    'units = "m"\n[mass_points]\npoints = [[0, 1], [0.5, 2]]\nmasses = [1, 2.5]\nfeet = [-1, 1]\ncontact = [[-1, 0]]',
    'units = "in"\nname = "x"\n[block]\nwidth = 10\nheight = 20.5\ndensity = 1e3\nfeet = [1, 9]',
    'units = "ft"\n[ellipse]\nwidth = 1\nheight = 2\nsides = 12',
    'units = "m"\n[[section.region]]\nwkt = "POLYGON ((0 0, 1 0, 1 2, 0 2, 0 0))"',
]
WKT = [(EXAMPLES / "cabinet.wkt").read_text(encoding="utf-8"), "MULTIPOLYGON (((0 0, 1 0, 1 2, 0 0)))"]
RING = [[0, 0], [1, 0], [1.5, 2], [0, 2], [0, 0]]
SQUARE = {"type": "Polygon", "coordinates": [RING, [[0.2, 0.5], [0.8, 0.5], [0.5, 1], [0.2, 0.5]]]}
FEATURE = {"type": "Feature", "properties": {"density": 2400.0}, "geometry": SQUARE}
GEOJSON = [json.dumps(SQUARE), json.dumps({"type": "FeatureCollection", "features": [FEATURE]})]

TOKEN = re.compile(r"[\w.+-]+|\s+|.", re.DOTALL)
STRANGE = [
    "nan", "inf", "-inf", "1e400", "-1", "0", "true", "null", '"x"', "[]", "{}", "1979-05-27", "9" * 5000, "1e308",
    "-0.0", "5e-324", "\0", "\ud7ff", "units", "width", "EMPTY", "Z", "(", "))", "[[", "Infinity", "0x1F", "1_0",
]  # fmt: skip


def mutated(text, rng):
    """Return the text with bytes flipped, cut off, or tokens swapped, repeated, dropped or replaced."""
    kind = rng.randrange(4)
    if kind == 0:
        data = bytearray(text.encode())
        for _ in range(rng.randint(1, 4)):
            data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
        return data.decode("utf-8", "replace")
    if kind == 1:
        return text[: rng.randrange(len(text))]
    tokens = TOKEN.findall(text)
    for _ in range(rng.randint(1, 3)):
        i, j = rng.randrange(len(tokens)), rng.randrange(len(tokens))
        if kind == 2:
            tokens[i], tokens[j] = tokens[j], tokens[i]
        else:
            tokens[i] = rng.choice([*STRANGE, "", tokens[i] * 2])
    return "".join(tokens)


READERS = {
    "toml": (body_from_toml, TOML),
    "wkt": (lambda text: section_from_wkt(text, units="mm"), WKT),
    "geojson": (section_from_geojson, GEOJSON),
}


def outcomes(read, texts, count, seed):
    """Return how many mutations gave a body, a refusal of ours, and anything else."""
    rng = random.Random(seed)
    bodies, refused, leaks = 0, 0, []
    for _ in range(count):
        text = mutated(rng.choice(texts), rng)
        try:
            assert isinstance(read(text), Body)
            bodies += 1
        except RockingError as error:
            refused += 1
            if "\n" in str(error):
                leaks.append(("more than one line", str(error)[:200], text[:200]))
        except Exception as error:  # noqa: BLE001 - what must not happen is counted
            leaks.append((type(error).__name__, str(error)[:200], text[:200]))
    return bodies, refused, leaks


@pytest.mark.slow
@pytest.mark.verifies("damage", "2,000 damaged files of each format", control="test_a_reader_without_guards_leaks")
@pytest.mark.parametrize("kind", READERS)
def test_mutations(kind):
    """Two thousand mutations a format: bodies and our own one-line refusals, no other error, both kinds occurring."""
    read, texts = READERS[kind]
    assert all(isinstance(read(text), Body) for text in texts)
    bodies, refused, leaks = outcomes(read, texts, 2000, seed=11)
    assert leaks == []
    assert min(bodies, refused) > 20  # most damage to JSON ends in its brackets


def replaced(thing, rng):
    """Return a parsed document with one of its nodes replaced by something strange."""
    if not isinstance(thing, (list, dict)) or not thing or rng.random() < 0.15:
        return rng.choice([None, True, -1, 0, 10**400, 1e308, math.nan, "", "density", [], {}, [[]], [0, 0], 2.5])
    copy = dict(thing) if isinstance(thing, dict) else list(thing)
    key = rng.choice(list(copy) if isinstance(copy, dict) else range(len(copy)))
    copy[key] = replaced(copy[key], rng)
    return copy


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "count"), [("geojson", 2000), ("toml", 2000)])
def test_replaced_nodes(kind, count):
    """Values of any other kind anywhere in a parsed document: a body or a refusal of ours, never a leak."""
    rng = random.Random(5)
    if kind == "geojson":
        texts, load, read = GEOJSON, json.loads, section_from_geojson
    else:  # through the same doors as text, once it is parsed
        texts, load, read = TOML, tomllib.loads, _body_from_parsed
    seen = {"body": 0, "refused": 0}
    for _ in range(count):
        given = replaced(load(rng.choice(texts)), rng)
        try:
            assert isinstance(read(given), Body)
            seen["body"] += 1
        except RockingError:
            seen["refused"] += 1
    assert min(seen.values()) > 20


def _body_from_parsed(given):
    """Read a parsed document as if the TOML parser had returned it."""
    if not isinstance(given, dict):
        raise RockingError("TOML is always a table")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(body_file, "parsed_toml", lambda _: given)
        return body_from_toml("")


@pytest.mark.verifies("negative control", "readers that trust the text")
def test_a_reader_without_guards_leaks():
    """Negative control: readers that trust the text let errors of others through."""
    from rocking import Block

    def naive_toml(text):
        return Block(**tomllib.loads(text)["block"])

    def naive_json(text):
        from shapely.geometry import shape

        return shape(json.loads(text))

    assert len(outcomes(naive_toml, TOML, 200, seed=11)[2]) > 100
    assert len(outcomes(naive_json, GEOJSON, 200, seed=11)[2]) > 100


@pytest.mark.slow
def test_mutated_dxf(tmp_path):
    """Three hundred damaged drawings: a body or a refusal of ours."""
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new("R12")
    space = drawing.modelspace()
    space.add_polyline2d([(0, 0), (1, 0), (1, 3), (0, 3)], close=True)
    space.add_circle((0.5, 1.5), 0.2)
    path = tmp_path / "x.dxf"
    drawing.saveas(path)
    text = path.read_text()
    at = text.index("ENTITIES")
    rng = random.Random(3)
    kinds = {"body": 0, "refused": 0}
    for _ in range(300):
        path.write_bytes((text[:at] + mutated(text[at:], rng)).encode("utf-8", "replace"))
        try:
            assert isinstance(read_body(path, units="m"), Body)
            kinds["body"] += 1
        except RockingError:
            kinds["refused"] += 1
    assert min(kinds.values()) > 10
