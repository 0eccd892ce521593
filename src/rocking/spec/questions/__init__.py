"""Studies: one module per study; every module of this folder is used."""

from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from rocking.spec.question import QUESTIONS, StudyQuestion
from rocking.spec.reading import tables_of, validated
from rocking.spec.schema import migrated


def questions() -> dict[str, type[StudyQuestion]]:
    """Return the classes of studies by their kind."""
    for module in iter_modules(__path__):
        import_module(f"{__name__}.{module.name}")
    return dict(sorted(QUESTIONS.items()))


def question_of(text: str) -> StudyQuestion:
    r"""Return the study of a job file.

    >>> question_of('[campaign]\nname = "a"\nkind = "stripe"')
    Traceback (most recent call last):
    rocking.errors.InvalidValueError: campaign.kind must be one of ... got 'stripe'; did you mean stripes? (and 1 more)
    """
    return question_in(tables_of(text))


def question_in(tables: dict[str, Any]) -> StudyQuestion:
    """Return the study of the tables, as an instance of the class of its kind."""
    tables, classes = migrated(tables), questions()
    campaign = tables.get("campaign")
    kind = campaign.get("kind") if isinstance(campaign, dict) else None
    if isinstance(kind, str) and kind in classes:
        return validated(classes[kind], tables)
    own = {name for question in classes.values() for name in question.model_fields} - {*StudyQuestion.model_fields}
    return validated(StudyQuestion, {name: table for name, table in tables.items() if name not in own})  # fails
