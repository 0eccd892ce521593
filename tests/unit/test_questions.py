"""The documentation of the keys of a question, and the options that say them, come from its tables."""

import dataclasses
import inspect
import math
import tomllib
from pathlib import Path
from typing import Literal, get_args

import pytest
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rocking.bodies.formats import body_from_toml
from rocking.bodies.formats.schema import BodyFile, RestraintTable
from rocking.bodies.restraints import KINDS
from rocking.decision.inventory import Thresholds
from rocking.errors import BodyFileError, InvalidValueError
from rocking.identification import identify
from rocking.motions import pulses
from rocking.motions.intensity import MEASURES
from rocking.motions.pipeline import steps_of
from rocking.motions.synthetic import families
from rocking.spec import bodies, schema
from rocking.spec.documents.identification import IdentificationDocument, IdentifyTable
from rocking.spec.documents.response import ResponseDocument
from rocking.spec.fields import JobTable, Text, key
from rocking.spec.key_facts import facts
from rocking.spec.questions import question_in
from rocking.spec.questions.inventory import ThresholdsTable
from rocking.spec.questions.map import MapQuestion
from rocking.spec.reading import checked
from rocking.spec.reference import reference, steps, targets
from rocking.studies import axes

ROOT = Path(__file__).parents[2]


def _rows(page):
    """Return the cells of the rows of keys in a page."""
    lines = [line for line in page.splitlines() if line.startswith("| `")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines]


def test_every_key_has_type_unit_default_range_and_meaning():
    """All rows of the pages of keys and of the table [body] have six cells; "any" is followed by its reason."""
    pages = [text for name, text in reference().items() if name != "names"]
    body = (ROOT / "docs" / "questions.md").read_text(encoding="utf-8").partition("### [body]")[2]
    rows = [row for page in (*pages, body) for row in _rows(page)]
    assert len(rows) > 300
    assert [row for row in rows if len(row) != 6 or not all(row)] == []
    assert [row for row in rows if row[4].startswith("any") and len(row[4].split()) < 3] == []
    assert [row for row in rows if "default" in row[5]] == []


def test_facts_come_from_the_field():
    """Limits, choices and lengths come from the type, the default from its fact and never from the description."""

    class Table(JobTable):
        length: float | None = key("length, default 3 m [m]", None, usual="2 m", gt=0.0)
        loads: list[float] = key("loads [N]", ...)
        side: Literal["left", "right"] = key("side", "left")
        name: Text | None = key("name", usual="name of the file")

    fields = Table.model_fields
    assert facts(fields["length"]) == ("number", "m", "2 m", "> 0", "length, default 3 m")
    assert facts(fields["loads"]) == ("list of numbers", "N", "required", "any number of numbers", "loads")
    assert facts(fields["side"]) == ("text", "-", "`left`", "left, right", "side")
    assert facts(fields["name"]) == ("text", "-", "name of the file", "1 to 200 characters", "name")
    assert facts(FieldInfo(annotation=float, default=1.0, description="offset [m]"))[3] == ""


def _bounds(text):
    """Yield sign and number of each limit in a range such as "> 0, <= 1"."""
    for limit in text.split(", "):
        sign, _, number = limit.partition(" ")
        if number.replace(".", "").isdigit():
            yield sign, float(number)


@pytest.mark.parametrize("name", ThresholdsTable.model_fields)
def test_the_ranges_of_thresholds_are_those_of_the_class(name):
    """A threshold at a limit of the page is accepted if the limit is included; a threshold beyond it is refused."""
    for sign, limit in _bounds(facts(ThresholdsTable.model_fields[name])[3]):
        beyond = limit + (1e-9 if sign[0] == "<" else -1e-9)
        with pytest.raises(InvalidValueError):
            Thresholds(**{name: beyond})
        if sign.endswith("="):
            Thresholds(**{name: limit})
        else:
            with pytest.raises(InvalidValueError):
                Thresholds(**{name: limit})


def test_the_defaults_of_restraints_and_identifications_are_those_of_the_functions():
    """A stated default is the default of the class or function."""
    for kind in KINDS.values():
        for entry in dataclasses.fields(kind):
            if isinstance(entry.default, (bool, int, float)) and entry.default < math.inf:
                stated = facts(RestraintTable.model_fields[entry.name])[2]
                assert stated == (str(entry.default).lower() if entry.default is False else f"{entry.default:g}")
    parameters = inspect.signature(identify).parameters
    for name in ("size_error", "asymmetry", "clock", "first", "trend", "damping"):
        assert facts(IdentifyTable.model_fields[name])[2] == str(parameters[name].default).lower()
    assert float(facts(IdentifyTable.model_fields["tilt"])[2]) == pytest.approx(parameters["tilt"].default, abs=5e-5)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("stiffness = -1.0", "stiffness must be a number >= 0 N/m"),
        ("stiffness = 1.0\nhardening = 1.0", "hardening must be a number < 1, got"),
    ],
)
def test_limits_of_restraints_have_their_unit(line, message):
    """The unit in an error is that of the key, not that of the lengths of the file."""
    text = f'units = "m"\n[block]\nwidth = 1\nheight = 3\n[[restraint]]\nkind = "tendon"\nx = 0.5\n{line}'
    with pytest.raises(BodyFileError, match=message):
        body_from_toml(text)


def test_every_table_of_a_body_file_is_documented():
    """Each table inside a body file has a section with a row per key; a table that is not listed is detected."""
    page = reference()["body_files"]
    tables = _inner_tables(BodyFile)
    assert RestraintTable in tables
    for table in tables:
        rows = [f"| `{field.alias or key}` |" for key, field in table.model_fields.items()]
        assert any(all(row in section for row in rows) for section in page.split("\n## ")[2:]), table
    assert "\n## [[restraint]]" in page


def _inner_tables(table):
    """Return the classes of all tables inside a table."""
    kinds, inner = [field.annotation for field in table.model_fields.values()], set()
    while kinds:
        kind = kinds.pop()
        kinds += get_args(kind)
        if isinstance(kind, type) and issubclass(kind, BaseModel) and not get_args(kind):
            inner |= {kind, *_inner_tables(kind)}
    return inner


def test_the_keys_of_a_body_are_documented():
    """The table of [body], which no description makes, has every key that may stand beside a file or an angle."""
    page = (ROOT / "docs" / "questions.md").read_text(encoding="utf-8")
    table = page.partition("### [body]")[2].partition("###")[0]
    keys = {"file", *bodies._WITH_FILE, *bodies._OUTSIDE, "width", "height", *bodies._OF_ANGLE}
    assert {key for key in keys if f"`{key}`" not in table} == set()


def test_the_files_on_the_page_are_questions():
    """The files that docs/questions.md shows are what they say, and none is of another kind."""
    page = (ROOT / "docs" / "questions.md").read_text(encoding="utf-8")
    response, study, measured = (tomllib.loads(block.partition("```")[0]) for block in page.split("```toml")[1:])
    study["campaign"] = {"name": "map", "kind": "overturning-map"}
    assert checked(ResponseDocument, response).restitution.models == ["ked", "housner"]
    assert question_in(study).map.x.count == 60
    assert checked(IdentificationDocument, measured).identify.tilt == [0.0, 0.001]
    for tables in (response, study, measured):
        bodies.any_body_of(tables["body"], None)
    others = (ResponseDocument, study), (MapQuestion, response), (IdentificationDocument, response)
    for kind, tables in others:
        with pytest.raises(InvalidValueError):
            checked(kind, tables)


def test_names_that_stand_as_values_are_documented():
    """Every axis, measure, synthetic family and pulse is in the documentation, and what is none is not."""
    text = reference()["names"]
    names = [f"`{name}`" for name in (*axes(), *MEASURES, *families())] + [f"`{name}:" for name in pulses.catalogue()]
    assert [name for name in names if f"| {name}" not in text] == []
    assert "| `amplitude`" not in text


def test_steps_say_what_they_take():
    """Every step and target spectrum is described by its own function: no key without words, none that it refuses."""
    for name, step in steps().items():
        usual = "stations=x.xml,angle=1,time_step=1,low=1,high=2,before=1,start=0,end=1,number=1,storeys=2,period=1"
        given = [word for word in usual.split(",") if step["keys"].get(word.partition("=")[0], {}).get("needed")]
        given += ["factor=2"] if step["single_key"] else []
        ((found, keys),) = steps_of(f"{name}:{','.join(given)}")
        assert (found, len(keys)) == (name, len(given))
    described = [*steps().values(), *targets().values()]
    assert [key for one in described for key, each in one["keys"].items() if not each["description"]] == []
    assert steps()["bandpass"]["keys"]["high"]["unit"] == "Hz"
    assert steps()["bandpass"]["keys"]["pads"]["choices"] == ["cut", "keep"]
    with pytest.raises(InvalidValueError, match="step taper: allowed keys are fraction"):
        steps_of("taper:low=1")


MAP = {
    "campaign": {"name": "a", "kind": "overturning-map"},
    "body": {"units": "m", "width": 0.5, "height": 2.0},
    "motions": {"pulse": "sine:amplitude=3,period=0.6"},
    "map": {"x": {"axis": "pga", "values": [1.0, 2.0]}, "y": {"axis": "semi_diagonal", "values": [1.0, 2.0]}},
}


def test_files_of_older_schemas_are_read(monkeypatch):
    """A made-up schema in which the table [map] was called [plane]: with or without its number, the file is read."""

    monkeypatch.setitem(schema.RENAMED, 1, {"plane": "map", "map.x.name": "axis"})
    old = {"plane" if name == "map" else name: table for name, table in MAP.items()}
    old["plane"] = {**MAP["map"], "x": {"name": "pga", "values": [1.0, 2.0]}}
    for tables in (old, {"schema": 1, **old}, {"schema": 2, **MAP}, MAP):
        assert question_in(tables).map.x.size == 2
    with pytest.raises(InvalidValueError, match="unknown key 'plane'"):
        question_in({"schema": 2, **old})


@pytest.mark.parametrize("number", [0, 3, "1", True, 1.0])
def test_unknown_schemas_are_refused(number):
    with pytest.raises(InvalidValueError, match=r"schema must be a whole number from 1 to 2, got ") as refused:
        question_in({"schema": number, **MAP})
    assert (refused.value.parameter, refused.value.value) == ("schema", number)
    assert ("later version" in str(refused.value)) == (number == 3)
