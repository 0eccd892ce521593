"""What adaptive studies have found: tables with their units."""

from typing import Any

from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results.plain import coordinate, plain


def minimum_result(study: OpenStudy) -> dict[str, Any]:
    """Return minimum overturning accelerations.

    Returns ``motions``, ``bodies``, and the ``tables`` of crossings and minima.
    """
    return {
        "motions": coordinate(study, "motion"),
        "bodies": coordinate(study, "body"),
        "tables": tables_of(study),
    }


def tables_of(study: OpenStudy) -> dict[str, Any]:
    """Return the tables of an adaptive study.

    Returns by name: a list of columns, each with name, unit, words and values.
    """
    return {
        name: [
            {"name": title, "unit": each.unit, "words": each.words, "values": plain(each.values)}
            for title, each in sheet.columns.items()
        ]
        for name, sheet in study.answer.sheets.items()
    }
