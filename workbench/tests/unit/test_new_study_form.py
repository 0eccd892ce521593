"""A new study is one file: the application lists it, starts it and has its form."""

from new_study import TABLES, added

from rocking_workbench.api.info import _constant
from rocking_workbench.studies.job_document import JobDocument, launched_kinds

__all__ = ["added"]  # a fixture


def test_one_file_is_a_study_of_the_application(added):
    assert "polarity" in launched_kinds()
    assert JobDocument.of(TABLES).histories == 2


def test_one_file_has_a_form(added):
    """The page hears of the kind, its table, and the unit, default and limits of each key."""
    info = _constant.__wrapped__()
    kind = {"name": "polarity", "table": "polarity", "has_body": True, "has_motions": True}
    assert kind in info["study_kinds"]
    facts = {"unit": "-", "description": "scale factor of both polarities", "kind": "number", "usual": "1.0", "gt": 0.0}
    assert info["keys"]["polarity"] == {"factor": {**facts, "needed": False, "choices": []}}
