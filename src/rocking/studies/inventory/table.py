"""The ranked table: as plain values for JSON, as text for CSV and spreadsheets."""

import csv
import io
from typing import Any

from rocking.conventions import g
from rocking.studies.inventory.verdict import Assessment, DirectionResult, Verdict
from rocking.studies.inventory.words import LIMITS, advice, model_note, rotation_words, sentence
from rocking.tables import escaped

HEADER = (
    "rank", "light", "name", "count", "row", "worse direction", "uplift acceleration [g]", "motions", "lifted",
    "overturned", "overturned, low [%]", "overturned, high [%]", "median rotation / angle", "84 % rotation / angle",
    "light by the other model", "in words", "what to do", "note",
)  # fmt: skip
"""Columns of the table in files."""


def rows(assessment: Assessment) -> list[list[str | float | int]]:
    """Return the table, the worst object first and rows without a verdict at the end.

    Returns one row an object, in the order of `HEADER`; text that a spreadsheet would take for a formula has an
    apostrophe before it.
    """
    lines: list[list[str | float | int]] = []
    for rank, verdict in enumerate(assessment.verdicts, start=1):
        worse, item, (low, high) = verdict.worse, verdict.item, verdict.interval
        lines.append([
            rank, f"{verdict.light.value} {verdict.light.word}", escaped(item.name), item.count, item.row,
            worse.direction, round(verdict.uplift_acceleration / g, 4), worse.count, worse.lifted, worse.overturned,
            round(100.0 * low, 2), round(100.0 * high, 2), _rounded(worse.median_rotation),
            _rounded(worse.high_rotation), verdict.worse_compared.light.word, sentence(verdict, assessment),
            _advice(verdict, assessment), escaped(item.note),
        ])  # fmt: skip
    for refused in assessment.not_assessed:
        line: list[str | float | int] = [""] * len(HEADER)
        line[1], line[2], line[4] = "not assessed", escaped(refused.name), refused.row
        line[HEADER.index("in words")] = f"not assessed: {refused.reason}"
        lines.append(line)
    return lines


def as_csv(assessment: Assessment) -> str:
    """Return the table as CSV.

    Returns Commas, points before decimals, one line an object; a last line if columns of the list were not read.
    """
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(HEADER)
    writer.writerows(rows(assessment))
    if assessment.ignored:
        writer.writerow(
            [
                f"columns of the list that were not read: {', '.join(assessment.ignored)}" * (title == "in words")
                for title in HEADER
            ]
        )
    return text.getvalue()


def as_plain(assessment: Assessment) -> dict[str, Any]:
    """Return everything as plain values, for JSON.

    Returns SI units, named in the keys; text as it was typed.
    """
    hazard, limits = assessment.hazard, assessment.thresholds
    low, high = hazard.velocity()
    return {
        "inventory": assessment.source,
        "hazard": {
            # the description comes first: its pgv_m_s is the level asked for, not the range that came out
            **hazard.description,
            "level": hazard.words(),
            "motions": hazard.source,
            "number_of_motions": len(hazard.motions),
            "pgv_range_m_s": [low, high],
        },
        "restitution": assessment.restitution,
        "comparison": assessment.comparison,
        "thresholds": dict(vars(limits)) | {light.word: words for light, words in limits.sentences().items()},
        "counts": {light.word: count for light, count in assessment.counts().items()}
        | {"not_assessed": len(assessment.not_assessed)},
        "objects": [_plain(rank, each, assessment) for rank, each in enumerate(assessment.verdicts, start=1)],
        "not_assessed": [
            {"row": each.row, "name": each.name, "reason": each.reason} for each in assessment.not_assessed
        ],
        "columns_not_read": list(assessment.ignored),
        "assumptions": list(LIMITS),
    }


def _rounded(value: float | None) -> str | float:
    return rotation_words(value) if value is None else round(value, 3)


def _advice(verdict: Verdict, assessment: Assessment) -> str:
    return f"{advice(verdict, assessment)} {model_note(verdict, assessment)}".strip()


def _plain(rank: int, verdict: Verdict, assessment: Assessment) -> dict[str, Any]:
    item = verdict.item
    return {
        "rank": rank,
        "name": item.name,
        "row": item.row,
        "count": item.count,
        "note": item.note,
        "light": verdict.light.word,
        "worse_direction": verdict.worse.direction,
        "uplift_acceleration_m_s2": verdict.uplift_acceleration,
        "overturned_interval": list(verdict.interval),
        "directions": [_direction(each) for each in verdict.results],
        "directions_by_comparison": [_direction(each) for each in verdict.compared],
        "light_by_comparison": verdict.worse_compared.light.word,
        "model_decides": verdict.model_decides,
        "in_words": sentence(verdict, assessment),
        "what_to_do": advice(verdict, assessment),
        "model_note": model_note(verdict, assessment),
    }


def _direction(result: DirectionResult) -> dict[str, Any]:
    return {
        "direction": result.direction,
        "light": result.light.word,
        "uplift_acceleration_m_s2": result.uplift_acceleration,
        "motions": result.count,
        "lifted": result.lifted,
        "overturned": result.overturned,
        "failed": result.failed,
        "lost_contact": result.lost_contact,
        "overturned_share": result.overturned_share,
        "median_rotation_over_angle": result.median_rotation,
        "high_rotation_over_angle": result.high_rotation,
    }
