"""How far bodies are from overturning: the least factor on every motion that overturns one, of either way round."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import plausibility
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.motions.intensity import measure as measure_of
from rocking.studies.fragility.subject import Responses, Subject
from rocking.studies.histories import Histories, results_of
from rocking.studies.motion_sets import MotionList

POINTS, REACH, HALVINGS = 64, 50.0, 6
"""Levels at which the least that overturns is looked for, up to so many times what lifts, and halvings of its place."""


@dataclass(frozen=True, eq=False)
class Margins:
    """Histories of one body under all motions, of both ways round where these differ."""

    least_each: FloatArray  # least factor that overturns, by way round (as it stands, mirrored) and motion [-]
    fell_each: FloatArray  # 1 where it overturns, NaN without a result, by way round, motion and level
    factors: FloatArray  # by motion and level [-]
    label: str  # of the restitution

    @classmethod
    def of(
        cls, body: Body, motions: MotionList, restitution: Any, measure: Any, levels: FloatArray | None,
        options: dict[str, Any],
    ) -> "Margins":  # fmt: skip
        """Return the margins of a body; levels: of the measure, the motions as they are if none."""
        ground = {name: value for name, value in options.items() if name not in {"threads", "progress"}}
        subjects = [Subject.of(*each, measure, ground) for each in ways_round(body, motions, restitution)]
        one = subjects[0]
        factors = np.ones((len(motions), 1)) if levels is None else measure.factors(one.intensities, levels)

        def overturned(subject: Subject, histories: Histories, shape: tuple[int, ...]) -> FloatArray:
            arrays = results_of(histories, threads=options.get("threads"), progress=options.get("progress"))
            return Responses.of(arrays, subject.parameters, shape).overturned

        fell = [overturned(each, each.product(factors), factors.shape) for each in subjects]
        least = [_least(each, overturned) for each in subjects]
        return cls(np.array(least), np.array(fell), factors, one.parameters.label)

    @property
    def least(self) -> FloatArray:
        """Least factor on each motion that overturns; infinite if none did, NaN without a result [-]."""
        return np.asarray(np.minimum.reduce(self.least_each))

    @property
    def overturned(self) -> FloatArray:
        """1 where it overturns, of either way round, by motion and level; NaN without a result."""
        return np.asarray(np.maximum.reduce(self.fell_each))


def ways_round(body: Body, motions: Any, restitution: Any) -> list[tuple[Body, Any, Any]]:
    """Return a body with its motions and restitution, and mirrored with the same where that differs."""
    swapped, differ = restitution, not body.is_symmetric
    if isinstance(restitution, Mapping) and {"left", "right"} <= set(restitution):
        swapped = {"left": restitution["right"], "right": restitution["left"]}
        differ |= restitution["left"] != restitution["right"]
    if not differ:
        return [(body, motions, restitution)]
    return [(body, motions, restitution), (body.mirrored(), motions, swapped)]


def _least(subject: Subject, overturned: Callable[[Subject, Histories, tuple[int, ...]], FloatArray]) -> FloatArray:
    """Return the least factor on each motion that was found to overturn; infinite if none, NaN without a result."""
    peaks, lifts = measure_of("pga").values(subject.motions, subject.scale), subject.scale.threshold
    light = not subject.are_horizontal
    grid = np.geomspace((0.1 if light else 1.0) * lifts, highest(lifts), POINTS) / peaks[:, None]
    return first_to_fall(
        grid, lambda rows, factors: overturned(subject, subject.table(rows, factors), factors.shape), POINTS
    )


def highest(lifts: float, reach: float = REACH) -> float:
    """Return up to which acceleration it is looked for what overturns, of that which lifts [m/s2]."""
    return min(reach * lifts, max(plausibility.LARGEST_PGA, 4.0 * lifts))


def first_to_fall(
    grid: FloatArray, overturned: Callable[[IntArray, FloatArray], FloatArray], together: int
) -> FloatArray:
    """Return the least factor that was found to overturn; infinite if none did, NaN without a result.

    grid: factors of each row, upwards; overturned: says it of numbers of rows, each with its factor; together: so many
    factors are tried at once of the rows of which none overturned yet.
    """
    count, points = grid.shape
    fell = np.zeros(grid.shape)
    for begin in range(0, points, together):
        part = slice(begin, begin + together)
        some = np.flatnonzero(~(fell == 1.0).any(axis=1))
        if some.size:
            tried = grid[some, part]
            numbers = np.repeat(some, tried.shape[1])
            fell[some, part] = overturned(numbers, tried.ravel()).reshape(tried.shape)
    first = np.argmax(fell == 1.0, axis=1)
    rows = np.arange(count)
    found = np.where(fell[rows, first] == 1.0, grid[rows, first], np.inf)
    low, high = grid[rows, np.maximum(first - 1, 0)], found
    some = np.flatnonzero(np.isfinite(found) & (first > 0))
    for _ in range(HALVINGS if some.size else 0):
        middle = np.sqrt(low[some] * high[some])
        falls = overturned(some, middle) == 1.0
        high[some], low[some] = np.where(falls, middle, high[some]), np.where(falls, low[some], middle)
    high[some] = np.sqrt(low[some] * high[some])
    before = np.where(np.isfinite(found), first, points)[:, None] > np.arange(points)
    return np.where((np.isnan(fell) & before).any(axis=1), np.nan, high)
