"""The documentation of the keys of a question, and the options that say them, come from its tables."""

import tomllib
from pathlib import Path
from typing import get_args

import pytest
from pydantic import BaseModel

from rocking.bodies.formats.schema import BodyFile, RestraintTable
from rocking.errors import InvalidValueError
from rocking.motions import pulses
from rocking.motions.intensity import MEASURES
from rocking.motions.pipeline import steps_of
from rocking.motions.synthetic import families
from rocking.spec import bodies, schema
from rocking.spec.documents.identification import IdentificationDocument
from rocking.spec.documents.response import ResponseDocument
from rocking.spec.questions import question_in
from rocking.spec.questions.map import MapQuestion
from rocking.spec.reading import checked
from rocking.spec.reference import reference, steps, targets
from rocking.studies import axes

ROOT = Path(__file__).parents[2]


def test_every_key_has_a_meaning():
    """The pages of keys have a row per key, with type, unit, default, range and meaning."""
    rows = [line for page in reference().values() for line in page.splitlines() if line.startswith("| `")]
    assert [row for row in rows if row.endswith("|  |")] == []
    assert "| `friction` | number | - |" in reference()["input_files"]
    assert "| `count` | integer |  |  | >= 1" in reference()["input_files"]


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
