"""Transitions of many bodies under many motions, as tables."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rocking.studies.minimum_acceleration import Cases, Effort, Transitions
from rocking.tables import Column, Table, text_array

_MODE = "not lifted -2, survived -1, n >= 0 overturned after n impacts"

_NUMBERS: dict[str, tuple[str, str]] = {
    "minimum": ("m/s2", "least peak acceleration that overturns, of those sampled; NaN if none, or the lowest does"),
    "certain": ("m/s2", "peak acceleration above which all that were sampled overturn; NaN if the highest survives"),
    "uplift_acceleration": ("m/s2", "ground acceleration that lifts the body"),
    "lowest": ("m/s2", "where the search began"),
    "highest": ("m/s2", "where it ended"),
    "resolution": ("1", "relative spacing of the first samples"),
    "resolution_below": ("1", "widest relative gap between samples below the minimum; NaN if there is none"),
}
_COUNTS = {
    "crossings": "changes of verdict that were found",
    "starts_overturned": "1 if the lowest acceleration overturns already",
    "samples": "histories of the scan",
    "failed": "histories without a result; if all failed, nothing is known",
}
_CROSSING = {
    "acceleration": ("m/s2", "peak ground acceleration at which the verdict changes"),
    "ratio": ("1", "the same over the acceleration that lifts the body"),
    "scale": ("1", "the same as factor on the motion"),
    "width": ("m/s2", "width of the bracket"),
}


def tables_of(
    found: Sequence[Transitions | None], cases: Cases, effort: Effort, shape: tuple[int, int, int],
    names: Mapping[str, list[str]],
) -> dict[str, Table]:  # fmt: skip
    """Return crossings as tables.

    Returns ``minima``, a row for each case; ``crossings``, a row for each crossing.
    """
    rows = [_row(each, cases, effort, k) for k, each in enumerate(found)]
    facts = {
        name: Column(np.array([row[name] for row in rows], np.float64), unit, words)
        for name, (unit, words) in _NUMBERS.items()
    }
    counts = {
        name: Column(np.array([row[name] for row in rows], np.int64), "1", words) for name, words in _COUNTS.items()
    }
    minima = Table("case", _prefixed("case", _places(np.arange(len(found)), shape, names) | facts | counts))
    known = [(k, each) for k, each in enumerate(found) if each is not None and len(each)]
    case = np.repeat(np.array([k for k, _ in known], np.int64), [len(each) for _, each in known])
    columns = _places(case, shape, names)
    for name, (unit, words) in _CROSSING.items():
        columns[name] = Column(np.concatenate([np.empty(0), *(getattr(c, name) for _, c in known)]), unit, words)
    modes = np.concatenate([np.empty((0, 2), np.int64), *(c.modes for _, c in known)])
    for place, name in enumerate(("mode_below", "mode_above")):
        columns[name] = Column(modes[:, place], "1", f"just {name[5:]}: {_MODE}")
    return {"crossings": Table("crossing", _prefixed("crossing", columns)), "minima": minima}


def _row(found: Transitions | None, cases: Cases, effort: Effort, k: int) -> dict[str, Any]:
    if found is None:  # nothing but the first samples was tried, and all of them failed
        asked = {"uplift_acceleration": cases.uplift[k], "lowest": cases.low[k], "highest": cases.high[k]}
        counts = {"crossings": 0, "starts_overturned": 0, "samples": effort.points, "failed": effort.points}
        return dict.fromkeys(_NUMBERS, np.nan) | asked | counts
    row = {name: getattr(found, name) for name in (*_NUMBERS, *_COUNTS) if name != "crossings"}
    return {name: np.nan if value is None else value for name, value in row.items()} | {"crossings": len(found)}


def _places(case: np.ndarray, shape: tuple[int, int, int], names: Mapping[str, list[str]]) -> dict[str, Column]:
    motion, choice, body = np.unravel_index(case, shape)
    return {
        "motion": Column(text_array([names["motion"][k] for k in motion]), "1", "name of the motion"),
        "restitution": Column(text_array([names["restitution"][k] for k in choice]), "1", "restitution"),
        "body": Column(np.asarray(body, np.int64), "1", "number of the body in the job"),
    }


def _prefixed(prefix: str, columns: Mapping[str, Column]) -> dict[str, Column]:
    """Give the columns names under which both tables fit into one file."""
    return {name: Column(each.values, each.unit, each.meaning, f"{prefix}_{name}") for name, each in columns.items()}
