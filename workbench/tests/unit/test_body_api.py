"""POST /api/body, /api/body/file, /api/impact and /api/contact-bed; GET /api/info."""

import json
import math
from dataclasses import MISSING, fields
from importlib.resources import files
from typing import get_args

import numpy as np
import pytest
from web_clients import refusal

import rocking as rk
from rocking.plots.style import model_styles
from rocking.reports.response_facts import restitution_words
from rocking.restitution import models
from rocking.studies.impact_laboratory import STUDIES, Laboratory, study
from rocking_workbench.api.contact_bed import MOST_POINTS, Varied
from rocking_workbench.api.info import Info

OCTETS = {"Content-Type": "application/octet-stream"}


def body_of(client, table):
    """Facts of a body."""
    answer = client.post("/api/body", json={"body": table})
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_facts_of_a_block_are_those_of_the_formulas(client):
    """Mass, centre, slenderness, p and uplift acceleration of a block are the closed forms, in any unit."""
    facts = body_of(client, {"units": "cm", "width": 50, "height": 200, "depth": 40, "density": 700})
    side = facts["sides"]["left"]
    radius = math.hypot(0.25, 1.0)
    assert math.isclose(facts["mass"], 280.0)
    assert facts["centre"] == [0.25, 1.0]
    assert side["slenderness_ratio"] == 4.0
    assert math.isclose(side["frequency_parameter"], math.sqrt(0.75 * 9.80665 / radius))
    assert math.isclose(side["uplift_acceleration"], 9.80665 / 4.0)
    assert math.isclose(facts["moment_of_inertia"], 280.0 / 3.0 * radius**2)
    assert facts["outline"][0]["outline"] == [[0.0, 0.0], [0.5, 0.0], [0.5, 2.0], [0.0, 2.0]]
    assert (facts["foot_positions"], facts["ground"]) == ([0.0, 0.5], 0.0)


def test_holes_and_densities_are_drawn(client):
    """A section comes back with its rings in the user's coordinates and its densities."""
    ring, hole = [[0, 1], [1, 1], [1, 4], [0, 4]], [[0.4, 2], [0.6, 2], [0.6, 3], [0.4, 3]]
    region = {"outline": ring, "holes": [hole], "density": 1800.0}
    facts = body_of(client, {"units": "m", "section": {"region": [region], "ground": 1.0}})
    drawn = facts["outline"][0]
    assert sorted(map(tuple, drawn["outline"])) == sorted(map(tuple, ring))
    assert sorted(map(tuple, drawn["holes"][0])) == sorted(map(tuple, hole))
    assert (drawn["density"], facts["ground"]) == (1800.0, 1.0)


def test_wkt_text_is_a_body(client):
    """Pasted WKT stands in the document as text; no file is named."""
    wkt = "POLYGON ((0 0, 1000 0, 1000 2000, 0 2000, 0 0))"
    facts = body_of(client, {"units": "mm", "section": {"region": [{"wkt": wkt, "density": 800.0}]}})
    assert math.isclose(facts["mass"], 1600.0)


def test_gravity_goes_into_p(client):
    """On the moon p is smaller by the root of the ratio of gravities."""
    table = {"units": "m", "width": 1, "height": 4}
    earth = body_of(client, table)["sides"]["left"]["frequency_parameter"]
    moon = client.post("/api/body", json={"body": table, "settings": {"gravity": 1.62}}).json()
    assert math.isclose(moon["sides"]["left"]["frequency_parameter"], earth * math.sqrt(1.62 / 9.80665))


def test_a_stout_body_is_warned_of(client):
    """A body outside the measured slendernesses gets a sentence, one inside gets none."""
    assert "outside the measured range" in body_of(client, {"units": "m", "width": 1, "height": 0.5})["warnings"][0]
    assert body_of(client, {"units": "m", "width": 1, "height": 4})["warnings"] == []


FILES = {
    "x.wkt": (b"POLYGON ((0 0, 1000 0, 1000 2000, 0 2000, 0 0))", {"units": "mm"}),
    "x.geojson": (b'{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 2], [0, 2], [0, 0]]]}', {"units": "m"}),
    "x.toml": (b'units = "m"\n[block]\nwidth = 1\nheight = 2\n', {}),
    "short.toml": (b'[body]\nunits = "m"\nwidth = 1\nheight = 2\n', {}),
}


@pytest.mark.parametrize("name", FILES)
def test_a_body_file_becomes_the_body_of_the_inputs(client, name):
    """A file is answered with a table that, sent back, is the same body: a rectangle of 1 m by 2 m."""
    content, query = FILES[name]
    answer = client.post("/api/body/file", params={"name": name, **query}, content=content, headers=OCTETS)
    assert answer.status_code == 200, answer.text
    told = answer.json()
    again = body_of(client, told.pop("body"))
    assert again == told
    assert math.isclose(again["mass"], 4800.0)


def test_a_drawing_becomes_a_body(client, tmp_path):
    """A DXF drawing of a closed polyline is a section in metres, whatever its unit."""
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new(units=4)
    drawing.modelspace().add_lwpolyline([(0, 0), (500, 0), (500, 2000), (0, 2000)], close=True)
    drawing.saveas(tmp_path / "a.dxf")
    content = (tmp_path / "a.dxf").read_bytes()
    answer = client.post("/api/body/file", params={"name": "a.dxf"}, content=content, headers=OCTETS)
    assert answer.status_code == 200, answer.text
    assert math.isclose(answer.json()["sides"]["right"]["slenderness_ratio"], 4.0)


BROKEN = {
    "no unit": ("x.wkt", b"POLYGON ((0 0, 1 0, 1 2, 0 0))", "states no unit"),
    "ending": ("x.exe", b"MZ", "Unsupported file. Use "),
    "not TOML": ("x.toml", b"units = ", "is not readable TOML"),
    "not text": ("x.toml", b"\xff\xfe", "is not readable TOML"),
    "names a file": ("x.toml", b'units = "m"\n[[section.region]]\ndxf = "/etc/passwd"\n', "cannot open files by name"),
    "not WKT": ("x.wkt", b"POLYGON", ""),
}


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_body_file_is_refused(client, case):
    """A file that is no body is refused with 422 and a sentence that names the file, not its place on disk."""
    name, content, words = BROKEN[case]
    answer = client.post("/api/body/file", params={"name": f"../../{name}"}, content=content, headers=OCTETS)
    assert words in refusal(answer)
    assert "/tmp" not in answer.text


def test_impact_has_every_model_with_evidence_and_stages(client):
    """Housner's coefficient is the formula; 39 measurements; the stages of KED lose energy one after the other."""
    answer = client.post("/api/impact", json={"body": {"units": "m", "width": 1, "height": 4}}).json()
    rows = {row["model"]: row for row in answer["coefficients"]["right"]}
    assert math.isclose(rows["housner"]["coefficient"], 1.0 - 1.5 / 17.0)
    assert rows["ked"]["coefficient_low"] < rows["ked"]["coefficient"] < rows["ked"]["coefficient_high"]
    assert len(answer["measured"]["measurements"]) == 39
    assert "doi:" in answer["measured"]["source"]
    stages = answer["stages"]["right"]
    shares = [stage["fraction"] for stage in stages["stages"]]
    assert shares[0] == 1.0
    assert shares == sorted(shares, reverse=True)
    assert math.isclose(math.sqrt(shares[-1]), rows["ked"]["coefficient"])
    vertical = [pair[1] for pair in stages["stages"][1]["velocity"]]
    assert not any(vertical)
    assert len(stages["points"]) == len(vertical) > 50
    assert {curve["model"] for curve in answer["curves"]} <= {*rows, "calibrated"}


def test_impact_tells_both_feet_where_they_differ(client):
    """A leaning trapezoid has two tables, a block one; one foot alone can be asked for."""
    leaning = {"units": "m", "trapezoid": {"base": 1.0, "top": 0.5, "height": 3.0, "lean": 0.2}}
    assert set(client.post("/api/impact", json={"body": leaning}).json()["coefficients"]) == {"left", "right"}
    one = client.post("/api/impact", json={"body": leaning, "foot": "left"}).json()
    assert set(one["coefficients"]) == {"left"}


def test_mass_points_have_stages_too(client):
    """A body of mass points is drawn by its points, and its velocities are given there."""
    points = {"points": [[0.0, 1.0], [1.0, 1.0], [0.5, 3.0]], "masses": [10.0, 10.0, 5.0], "feet": [0.0, 1.0]}
    answer = client.post("/api/impact", json={"body": {"units": "m", "mass_points": points}}).json()
    assert (answer["body"]["points"], answer["body"]["masses"]) == (points["points"], points["masses"])
    assert answer["stages"]["right"]["points"] == points["points"]


def test_info_names_everything_that_can_be_chosen(client):
    """Every pulse parameter has a unit, every list is there, and the numbers are the library's."""
    from rocking_workbench.api.info import PARAMETERS

    info = client.get("/api/info").json()
    assert set(info["pulses"]) == set(rk.pulses.catalogue())
    assert {name for one in info["pulses"].values() for name in one["parameters"]} <= set(PARAMETERS)
    assert info["pulses"]["harmonic"]["parameters"]["phase"]["default"] == 0.0
    assert info["pulses"]["sine"]["parameters"]["period"] == {"unit": "s", "description": "period", "default": None}
    assert {one["name"] for one in info["models"]} >= {"ked", "housner", "fixed"}
    assert {"m", "cm", "mm"} <= set(info["units"]["length"])
    assert info["limits"]["upload_bytes"] > 0
    for key in ("families", "formats", "measures", "axes", "study_kinds"):
        assert info[key], key
    for kind in info["study_kinds"]:  # each can be launched here: what is refused is the missing rest of the job
        answer = client.post("/api/studies", json={"job": {"campaign": {"name": "x", "kind": kind["name"]}}})
        assert "kind must be one of" not in answer.json()["error"]["message"]


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"width": 0.6, "height": 1.8, "density": 1e-320}, "density is 1e-320, below the smallest normal number"),
        ({"width": 5e-324, "height": 1.8}, "width is 5e-324, below the smallest normal number"),
        ({"block": {"width": 0.6, "height": 1.8, "density": 2e-308}}, "block.density"),
        (
            {"mass_points": {"points": [[0.0, 0.0], [1.0, 1.0]], "masses": [1.0, 5e-324], "feet": [0.0, 1.0]}},
            "mass_points.masses[1]",
        ),
        ({"width": 0.6, "height": 1.8, "density": 1e-250}, "must be > "),
    ],
)
@pytest.mark.parametrize("path", ["body", "impact"])
def test_numbers_that_have_lost_digits_are_no_body(client, path, body, words):
    """Subnormal sizes, densities and masses are refused by their key, and a body without weight in words."""
    assert words in refusal(client.post(f"/api/{path}", json={"body": {"units": "m", **body}}))
    light = {"units": "m", "width": 0.6, "height": 1.8, "density": 1e-100}
    assert client.post(f"/api/{path}", json={"body": light}).status_code == 200  # the control: odd, and computed


BLOCK = {"units": "m", "width": 0.6, "height": 1.8}


def refuse_constant(word):
    """Stand for a reader of JSON that knows no NaN and no Infinity."""
    raise ValueError(f"{word} is no JSON")


@pytest.fixture
def told(client):
    """Return the answer, read by a strict reader."""
    answer = client.get("/api/info")
    assert answer.status_code == 200
    return json.loads(answer.text, parse_constant=refuse_constant)


def test_the_strict_reader_has_teeth():
    """An infinite number, as Python writes it, is refused by the reader of these tests."""
    with pytest.raises(ValueError, match="Infinity is no JSON"):
        json.loads(json.dumps({"friction": math.inf}), parse_constant=refuse_constant)


def test_every_registered_model_is_listed(told):
    """Names and order are those of the registry, and the answer has the form that the schema states."""
    assert [one["name"] for one in told["models"]] == list(models())
    Info.model_validate(told)


def test_a_model_has_one_name_and_one_look_on_paper_and_on_the_page(told):
    """Short name and colour are those of the pictures, dashes differ, and the page's script has no table of its own."""
    facts = {one["name"]: one for one in told["models"]}
    assert {name: one["short_name"] for name, one in facts.items()} == {name: restitution_words(name) for name in facts}
    drawn = {name: style["color"] for name, style in model_styles().items()}
    assert {name: one["colour"] for name, one in facts.items() if one["colour"]} == drawn
    assert len({tuple(facts[name]["dash"]) for name in drawn}) == len(drawn)
    palette = files("rocking_workbench").joinpath("static", "app", "palette.js").read_text("utf-8")
    assert not [colour for colour in drawn.values() if colour in palette]


def test_a_default_is_a_number_unlimited_or_missing(told):
    """The defaults are those of the classes: a number, the word for an infinite one, null where one must be given."""
    for one in told["models"]:
        for field in fields(models()[one["name"]]):
            if not field.init:
                continue
            said = one["parameters"][field.name]["default"]
            if field.default is MISSING:
                assert said is None
            elif field.default == math.inf:
                assert said == "unlimited"
            else:
                assert said == field.default
    (bed,) = (one for one in told["models"] if one["name"] == "contact-bed")
    assert bed["parameters"]["friction"]["default"] == "unlimited"


def complete(model):
    """Say what the page says of a model that needs no number: it is offered."""
    return all(one["default"] is not None for one in model["parameters"].values())


def test_the_page_offers_every_model_that_needs_no_number(told):
    """By the rule of the page, a model is offered if and only if it can be made without arguments."""
    for one in told["models"]:
        try:
            models()[one["name"]]()
        except TypeError:
            assert not complete(one), one["name"]
        else:
            assert complete(one), one["name"]


def test_the_contact_bed_answers_at_impact(client):
    """The coefficient of the contact bed is that of the library to the last digit."""
    answer = client.post("/api/impact", json={"body": BLOCK, "foot": "right"})
    assert answer.status_code == 200
    rows = json.loads(answer.text, parse_constant=refuse_constant)["coefficients"]["right"]
    (bed,) = (row for row in rows if row["model"] == "contact-bed")
    block = rk.Block(width=0.6, height=1.8)
    assert bed["coefficient"] == rk.coefficient_of_restitution(block, "contact-bed")


def test_the_contact_bed_answers_in_a_response(client):
    """Its response is that of the library to the last digit, alone and with parameters that are told."""
    names = ["contact-bed", "contact-bed:points=5,friction=2"]
    asked = {"body": BLOCK, "motion": {"pulse": "sine:amplitude=6,period=0.8"}, "restitution": {"models": names}}
    answer = client.post("/api/response", json=asked)
    assert answer.status_code == 200, answer.text
    motion = rk.pulses.sine(6.0, 0.8)
    for name, one in zip(names, json.loads(answer.text, parse_constant=refuse_constant)["answers"], strict=True):
        response = rk.simulate(rk.Block(width=0.6, height=1.8), motion, restitution=name)
        assert one["peak_rotation"] == response.peak_rotation > 0.0


def asked(client, **table):
    """Answer of a study."""
    answer = client.post("/api/contact-bed", json=table)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_what_python_finds_and_the_closed_form_beside_it(client):
    """Numbers are those of `study`; Housner is its closed form, and slender blocks lose less."""
    found = asked(client, **{"from": 2, "to": 6}, count=4, damping=0.3)
    same = study("slenderness", np.linspace(2.0, 6.0, 4), Laboratory(damping=0.3))
    for name, each in found["results"].items():
        assert each["values"] == same[name].values.tolist()
    expected = [1.0 - 1.5 * math.sin(math.atan(1.0 / x)) ** 2 for x in found["values"]]
    assert found["rigid"]["housner"] == pytest.approx(expected, rel=1e-12)
    assert all(np.diff(found["results"]["coefficient"]["values"]) > 0.0)
    assert found["results"]["peak_force"]["unit"] == "N"


@pytest.mark.parametrize("varied", STUDIES)
def test_everything_that_can_change_has_a_usual_range(client, varied):
    """Each study of Python is offered, and answers where nothing but its name is said."""
    assert set(get_args(Varied)) == set(STUDIES)
    found = asked(client, varied=varied, count=5, points=21)
    assert len(found["values"]) == len(found["results"]["coefficient"]["values"]) == 5
    assert all(abs(each) < 1e-6 for each in found["results"]["audit"]["values"])


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"varied": "damping", "from": 0}, "must be > 0"),
        ({"varied": "damping", "shape": "convex"}, "has no options, got shape"),
        ({"varied": "points", "to": MOST_POINTS + 1}, f"at most {MOST_POINTS}"),
        ({"count": 201}, "count"),
        ({"from": -1, "to": 2}, "slenderness must be > 0, got -1"),
        ({"width": 0}, "width"),
        ({"wdith": 1}, "unknown key"),
        ({"varied": "release", "to": 1}, "release"),
        ({"varied": "width", "to": 1e308}, "must be"),
    ],
)
def test_what_cannot_be_is_refused_in_words(client, table, words):
    """Ranges and keys that cannot be are told, and give no number."""
    assert words in refusal(client.post("/api/contact-bed", json=table))
