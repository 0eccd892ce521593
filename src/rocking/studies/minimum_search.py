"""The search for all crossings of many bodies, each under a motion: one batch of histories a round."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.response import Motion
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.studies.below import below, search_below
from rocking.studies.crossings import Crossings
from rocking.studies.question import FAILED
from rocking.studies.scan import Run, Scan

# range searched over the acceleration that lifts the body, and how far below it where a vertical part lightens it
_FROM, _FROM_VERTICAL, _TO = 1.0, 0.1, 50.0
_MOST_POINTS = 1_000_000


@dataclass(frozen=True)
class Effort:
    """How closely to look."""

    points: int = 400  # first samples, in equal ratios [-]
    levels: int = 4  # how often suspicious intervals are halved, from 0 to 12 [-]
    tolerance: float = 1e-12  # width of the last brackets over the acceleration [-]

    def __post_init__(self) -> None:
        """Check the values."""
        for name, low, high in (("points", 2, _MOST_POINTS), ("levels", 0, 12)):
            value: object = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
                raise InvalidValueError(f"{name} must be a whole number in [{low}, {high}], got {value!r:.60}")
        object.__setattr__(self, "tolerance", checks.within("tolerance", self.tolerance, 0.0, 0.1))


@dataclass(frozen=True)
class Cases:
    """Bodies whose crossings are looked for together, each under a motion."""

    sides: dict[str, FloatArray]  # sides of the bodies, as of `sides_of` [rad, rad/s, -]
    peak: FloatArray  # peak acceleration of the motion of each [m/s2]
    uplift: FloatArray  # acceleration that lifts each [m/s2]
    low: FloatArray  # low, high: accelerations between which to look [m/s2]
    high: FloatArray
    record: bool  # whether the motions are records, under which thin stretches may hide below the minimum

    @classmethod
    def of(
        cls, motion: Motion, sides: dict[str, FloatArray], settings: Settings, lowest: float | None,
        highest: float | None,
    ) -> "Cases":  # fmt: skip
        """Return the cases of some bodies under one motion.

        sides: sides of the bodies, as of `sides_of` [rad, rad/s, -]; lowest, highest: peak accelerations between which
        to look [m/s2].
        """
        if not motion.peak > 0.0:
            raise InvalidValueError(f"motion must have a peak above zero to be scaled, got {motion.name!r}")
        uplift, (low, high) = _range(motion, sides, settings, lowest, highest)
        return cls(sides, np.full(uplift.size, motion.peak), uplift, low, high, isinstance(motion, GroundMotion))

    @classmethod
    def joined(cls, parts: Sequence["Cases"]) -> "Cases":
        """Return the cases of several motions or restitutions as one."""
        sides = {name: np.concatenate([each.sides[name] for each in parts]) for name in parts[0].sides}
        names = ("peak", "uplift", "low", "high")
        arrays = {name: np.concatenate([getattr(each, name) for each in parts]) for name in names}
        return cls(sides, **arrays, record=parts[0].record)

    def grid(self, points: int) -> FloatArray:
        """Return the first factors on the motions.

        points: how many for each case [-]. Returns in equal ratios [-].
        """
        return np.asarray(np.geomspace(self.low, self.high, points, axis=1) / self.peak[:, None])  # Eq. 182


def searched(cases: Cases, effort: Effort, run: Run) -> tuple[Crossings | None, ...]:
    """Return the crossings of all cases, which are computed together and do not know of one another.

    Returns one for each case; None where no history could be computed.
    """
    scan = Scan(run, cases.sides, cases.grid(effort.points))
    if cases.record:
        search_below(scan, effort.points)
    for _ in range(effort.levels):
        scan.zoom()
    scan.hunt()
    return _crossings(scan, cases, effort)


def _range(
    motion: Motion, sides: dict[str, FloatArray], settings: Settings, lowest: float | None, highest: float | None
) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Return the accelerations that lift the bodies, and between which to look."""
    both = np.stack([sides["alpha_right"], sides["alpha_left"]])
    lifts = settings.gravity * (both if settings.linear else np.tan(both))  # Eq. 25
    light = isinstance(motion, GroundMotion) and motion.vertical is not None
    low = (_FROM_VERTICAL if light else _FROM) * lifts.min(axis=0)
    high = _TO * lifts.max(axis=0)
    if lowest is not None:
        low = np.full_like(low, checks.positive("lowest", lowest, "m/s2"))
    if highest is not None:
        high = np.full_like(high, checks.positive("highest", highest, "m/s2"))
    bad = np.flatnonzero(~(low < high))
    if bad.size:
        k = bad[0]
        raise InvalidValueError(f"lowest must be below highest, got {low[k]:g} and {high[k]:g} m/s2 for body {k}")
    return lifts.min(axis=0), (low, high)


def _crossings(scan: Scan, cases: Cases, effort: Effort) -> tuple[Crossings | None, ...]:
    found, all_modes, count = scan.brackets(effort.tolerance), scan.samples.mode, cases.uplift.size
    gaps = {k: each.gap for k, each in below(scan.samples.good).items()}
    # both are sorted by body
    bounds, marks = (np.searchsorted(each.body, np.arange(count + 1)) for each in (found, scan.samples))
    made: list[Crossings | None] = []
    for k in range(count):
        own, mine = slice(bounds[k], bounds[k + 1]), slice(marks[k], marks[k + 1])
        modes = all_modes[mine]
        known = modes != FAILED
        good = modes[known]
        if not good.size:
            made.append(None)
            continue
        scale, low, high = found.ends[own].mean(axis=1), float(cases.low[k]), float(cases.high[k])
        peak, uplift = float(cases.peak[k]), float(cases.uplift[k])
        # what is said of the ends of the range is said of the outermost histories that have a result
        first, last = (scan.samples.scale[mine][known][[0, -1]] * peak).tolist()
        ends = low if known[0] else first, high if known[-1] else last
        made.append(
            Crossings(
                scale * peak, scale * peak / uplift, scale, found.modes[own], np.diff(found.ends[own])[:, 0] * peak,
                *ends, uplift, (high / low) ** (1.0 / (effort.points - 1)) - 1.0, bool(good[0] >= 0),
                int(modes.size), int(np.sum(modes == FAILED)), gaps.get(k, math.nan),
                scan.samples.lost[mine],
            )
        )  # fmt: skip
    return tuple(made)
