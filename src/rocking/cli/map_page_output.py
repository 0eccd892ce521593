"""What `rocking map` prints: shares of each way to end, safe islands, where overturning begins, and JSON.

Keys of the JSON
----------------
- ``body``, ``assumed`` (sentences),
  ``motion`` (kind, name, duration_s, peak_acceleration_m_s2), ``restitution``, ``engine``, ``gravity_m_s2``,
  ``linear``.
- ``x``, ``y``: name, unit, values. ``mode`` and ``peak_ratio``: rows along y, null where there is no number.
- ``cells``, ``modes`` (mode, meaning, count, share), ``refined_points`` (null without ``--refine``).
- ``islands``: count and, the largest first, cells, area, x, y.
- ``overturning``: null, or x and y (least and greatest), and ``first``: x and y of the lowest overturning point.
- ``sensitivity``: null, or baseline and pairs of restitutions with their flips.
"""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking.cli.files_output import plain
from rocking.cli.map_output import MapAnswer
from rocking.cli.study_output import body_lines, motion_facts, table
from rocking.conventions import FloatArray, IntArray, percent
from rocking.studies.axis import Axis

_LAST = 3
"""Overturning after more impacts than that is printed together; JSON parts it."""

_MEANINGS = {-3: "not computed", -2: "not lifted", -1: "rocks, stays standing", 0: "overturns without impact"}


def as_json(answer: MapAnswer) -> str:
    """Return everything as JSON."""
    asked, found = answer.question, answer.found
    facts = {
        "body": repr(asked.body),
        "assumed": list(asked.body.assumed),
        "motion": motion_facts(asked.motion),
        "restitution": found.attrs["restitution"],
        "engine": found.attrs["engine"],
        "gravity_m_s2": asked.settings["gravity"],
        "linear": asked.settings["linear"],
        "x": {"name": asked.x.name, "unit": asked.x.unit, "values": asked.x.values.tolist()},
        "y": {"name": asked.y.name, "unit": asked.y.unit, "values": asked.y.values.tolist()},
        "mode": found["mode"].values.tolist(),
        "peak_ratio": plain(found["peak_ratio"].values),
        "cells": found["mode"].size,
        "modes": shares(answer),
        "refined_points": found.sizes.get("point"),
        "islands": {"count": len(answer.islands), "all": [_island(one) for one in answer.islands.islands]},
        "overturning": extent(answer),
        "contact": found.attrs["contact"],
        "sensitivity": _sensitivity(answer),
    }
    return json.dumps(facts, indent=1, allow_nan=False)


def show(answer: MapAnswer, length: str = "m") -> None:
    """Print the map in words."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    asked, found = answer.question, answer.found
    for name, words in body_lines(asked.body, asked.settings["gravity"], length):
        console.print(f"{name + ':':13} {words}", markup=False)
    console.print(f"motion:       {asked.motion.name}", markup=False)
    console.print(f"restitution:  {found.attrs['restitution']};  engine: {found.attrs['engine']}", markup=False)
    for name, axis in (("x", asked.x), ("y", asked.y)):
        span = _span(answer, axis, (axis.values[0], axis.values[-1]))
        console.print(f"{name}:            {span.replace(' ', ', ', 1)}, {axis.values.size} values", markup=False)
    console.print()
    console.print(table(("how it ends", "cells", "share"), _share_rows(shares(answer))))
    console.print()
    for sentence in (_begins(answer), _islands_words(answer)):
        console.print(sentence, markup=False)
    if found.attrs["contact"]:
        console.print(f"! {found.attrs['contact']}", style="yellow", markup=False)
    if "point" in found.sizes:
        console.print(f"Refined along boundaries: {found.sizes['point']} points.", markup=False)
    if answer.compared is not None:
        console.print()
        console.print(table(*_flip_rows(answer), left=2))
        console.print(answer.compared.verdict, markup=False)


def shares(answer: MapAnswer) -> list[dict[str, Any]]:
    """Return how many cells end in which way.

    Returns mode, meaning, count, share [-], by mode.
    """
    modes, counts = np.unique(answer.found["mode"].values, return_counts=True)
    return [
        {"mode": mode, "meaning": meaning(mode), "count": count, "share": count / answer.found["mode"].size}
        for mode, count in zip(modes.tolist(), counts.tolist(), strict=True)
    ]


def meaning(mode: int) -> str:
    """Return a mode in words.

    >>> meaning(-1), meaning(2)
    ('rocks, stays standing', 'overturns after 2 impacts')
    """
    return _MEANINGS.get(mode) or f"overturns after {mode} impact{'s' if mode != 1 else ''}"


def extent(answer: MapAnswer) -> dict[str, Any] | None:
    """Return where overturning lies, of all points that were computed.

    Returns ``x`` and ``y``, least and greatest, and ``first``, the lowest point along y; None if nothing overturns.
    """
    x, y, modes = _points(answer)
    x, y = x[modes >= 0], y[modes >= 0]
    if not x.size:
        return None
    lowest = np.lexsort((x, y))[0]
    first = {"x": float(x[lowest]), "y": float(y[lowest])}
    return {"x": [float(x.min()), float(x.max())], "y": [float(y.min()), float(y.max())], "first": first}


def _points(answer: MapAnswer) -> tuple[FloatArray, FloatArray, IntArray]:
    found = answer.found
    if "point" in found.sizes:
        return found["refined_x"].values, found["refined_y"].values, found["refined_mode"].values
    x, y = np.meshgrid(answer.question.x.values, answer.question.y.values)
    return x.ravel(), y.ravel(), found["mode"].values.ravel()


def _begins(answer: MapAnswer) -> str:
    found, x, y = extent(answer), answer.question.x, answer.question.y
    if found is None:
        return "Nothing on this map overturns."
    first = found["first"]
    spans = f"{_span(answer, x, found['x'])}, {_span(answer, y, found['y'])}"
    return (
        f"Overturning begins at {y.name} = {_in_unit(answer, y, first['y'])}, where {x.name} = "
        f"{_in_unit(answer, x, first['x'])}; it lies within {spans}."
    )


def _islands_words(answer: MapAnswer) -> str:
    count = len(answer.islands)
    if not count:
        return "No safe islands: no survival on this map is surrounded by overturning."
    one, x, y = answer.islands[0], answer.question.x, answer.question.y
    spans = f"{_span(answer, x, one.x)}, {_span(answer, y, one.y)}"
    cells = f"{one.cells} cell{'s' if one.cells != 1 else ''}"
    return f"Safe islands: {count}; the largest has {cells}: {spans}."


def _island(island: Any) -> dict[str, Any]:
    return {"cells": island.cells, "area": island.area, "x": list(island.x), "y": list(island.y)}


def _sensitivity(answer: MapAnswer) -> dict[str, Any] | None:
    if answer.compared is None:
        return None
    names = ("count", "gained", "lost", "compared", "unknown", "share", "low", "high")
    pairs = [
        {"first": a, "second": b, **{n: plain(getattr(flips, n)) for n in names}} for a, b, flips in _pairs(answer)
    ]
    return {"baseline": answer.compared.baseline, "pairs": pairs}


def _pairs(answer: MapAnswer) -> list[tuple[str, str, Any]]:
    from itertools import combinations

    compared = answer.compared
    if compared is None:
        return []
    return [(a, b, compared.flips_between(a, b)) for a, b in combinations(compared.labels, 2)]


def _flip_rows(answer: MapAnswer) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    head = ("restitution", "against", "flips", "share", "only with the second", "only with the first")
    rows: list[tuple[str, ...]] = [
        (a, b, str(f.count), percent(f.share), str(f.gained), str(f.lost)) for a, b, f in _pairs(answer)
    ]
    return head, rows


def _share_rows(told: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    """Return a line for each way to end; under long records the many late ones are one line."""
    late = [one for one in told if one["mode"] > _LAST]
    rows = [one for one in told if one["mode"] <= _LAST]
    if len(late) > 1:
        words = f"overturns after {_LAST + 1} or more impacts"
        late = [{"meaning": words, "count": sum(one["count"] for one in late), "share": sum(o["share"] for o in late)}]
    return [(one["meaning"], str(one["count"]), f"{100.0 * one['share']:.2f} %") for one in [*rows, *late]]


def _span(answer: MapAnswer, axis: Axis, ends: Sequence[float]) -> str:
    unit, size = answer.question.unit(axis)
    low, high = (f"{end / size:.4g}" for end in ends)
    return f"{axis.name} {low if low == high else f'{low} to {high}'}{'' if unit == '1' else f' {unit}'}"


def _in_unit(answer: MapAnswer, axis: Axis, value: float) -> str:
    unit, size = answer.question.unit(axis)
    return f"{value / size:.4g}{'' if unit == '1' else f' {unit}'}"
