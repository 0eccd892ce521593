"""Files of schema 1 open: questions, jobs, campaigns, projects and studies of the page, kept as they were written."""

import shutil
from pathlib import Path

import pytest

from rocking.campaigns.identity import Identity, engine_of, software
from rocking.campaigns.jobs import Job, JobFolder
from rocking.errors import InvalidValueError
from rocking.spec.documents.identification import IdentificationDocument
from rocking.spec.documents.prediction import AssessmentDocument, PredictionDocument
from rocking.spec.documents.records import RecordDocument, RecordSetDocument
from rocking.spec.documents.response import ResponseDocument
from rocking.spec.documents.validation import ValidationDocument
from rocking.spec.questions import question_in
from rocking.spec.reading import checked, tables_of
from rocking.spec.schema import RENAMED, SCHEMA, migrated, migrated_document

DATA = Path(__file__).parents[1] / "data"
OLD, NEW = DATA / "schema_1", DATA / "schema_2"
DOCUMENTS = {
    "response": ResponseDocument, "drop": ResponseDocument, "prediction": PredictionDocument,
    "assessment": AssessmentDocument, "identification": IdentificationDocument, "record": RecordDocument,
    "records": RecordSetDocument, "validation": ValidationDocument,
}  # fmt: skip


def parsed(name, tables):
    return checked(DOCUMENTS[name], tables) if name in DOCUMENTS else question_in(tables)


@pytest.mark.parametrize("path", sorted(OLD.glob("*.toml")), ids=lambda path: path.stem)
def test_a_file_of_schema_1_is_the_same_question(path):
    """A file of schema 1, with or without its number, is the question that is written by hand in present keys."""
    old = tables_of(path.read_text("utf-8"))
    new = tables_of((NEW / path.name).read_text("utf-8")) if (NEW / path.name).exists() else old
    present = parsed(path.stem, {"schema": SCHEMA, **new})
    assert parsed(path.stem, old) == parsed(path.stem, {"schema": 1, **old}) == parsed(path.stem, new) == present
    if new != old:
        with pytest.raises(InvalidValueError, match="unknown key"):
            parsed(path.stem, {"schema": SCHEMA, **old})


def test_every_renamed_key_is_in_a_kept_file():
    """No key is in the table of renamed keys of which no file is kept."""
    kept = [tables_of(path.read_text("utf-8")) for path in OLD.glob("*.toml")]
    names = {f"{table}.{key}" for one in kept for table, keys in one.items() if isinstance(keys, dict) for key in keys}
    assert set(RENAMED[1]) <= names


def test_both_names_of_a_key_are_refused():
    with pytest.raises(InvalidValueError, match="free and initial_rotation are the same key"):
        migrated({"response": {"free": 0.5, "initial_rotation": 0.5}})


@pytest.mark.parametrize("name", ["map", "minimum", "stripes"])
def test_a_campaign_of_schema_1_opens(name, tmp_path):
    """Its job is the same and its missing histories are computed; those without levels in ratios keep their name."""
    folder = tmp_path / name
    shutil.copytree(OLD / f"campaign_{name}", folder)
    job = Job.of_text((NEW / f"{name}.toml").read_text("utf-8"))
    for path in [each.parent for each in folder.glob("*/campaign.json")]:
        kept = Identity.read(path)
        if name != "minimum":  # since then, levels in equal ratios have the same bits on every processor
            assert kept.plan.key == job.study.histories.key()
        if (kept.plan.key, kept.plan.engine, kept.plan.software) != (
            job.study.histories.key(),
            engine_of(job.study.histories),
            software(),
        ):
            shutil.rmtree(path)  # the last digits of another processor or version: the job alone opens here
    opened = JobFolder.open(folder)
    opened.run(workers=1)
    assert opened.job.document == job.document


def test_forms_of_a_project_have_the_present_keys():
    """Each form keeps its values; a form with the present keys stays as it is."""
    old = {"measure": {"what": "identify", "known": "no", "unit": "m"}, "space": {"asked": "motion"}}
    new = {"measure": {"command": "identify", "body": "no", "unit": "m"}, "space": {"analysis": "motion"}}
    assert migrated_document({"forms": old}) == migrated_document({"forms": new}) == {"forms": new}


def test_documents_without_forms_or_inputs_stay():
    for document in ({}, {"inputs": None}, {"forms": {"decide": 3}}):
        assert migrated_document(document) == document
