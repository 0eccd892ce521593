"""Incremental dynamic analysis: every motion at increasing levels, with all intervals of overturning."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.errors import InvalidValueError
from rocking.messages import Message
from rocking.statistics.censored import CensoredFit, fit_crossings
from rocking.studies.fragility.multiple_stripe_analysis import MultipleStripeAnalysis
from rocking.studies.fragility.subject import Responses
from rocking.studies.histories import results_of

if TYPE_CHECKING:
    import xarray as xr

Outcomes = Callable[[IntArray, FloatArray], tuple[IntArray, BoolArray]]
"""Function of motion indices and levels that returns sides of overturning (0 without) and flags of success."""

PARTS = 16  # pieces per bracket in the first round, and in later rounds with few brackets
WIDE = 0.01  # relative width [-]; long records have narrower survivals, in which the body balances on its corner
FEW = 1000  # largest number of brackets that are divided into PARTS pieces, with fewer rounds; others are bisected


@dataclass(frozen=True)
class OverturningInterval:
    """An interval of levels at which a motion overturns the body."""

    motion: int  # index of the motion
    start: float  # level at which overturning starts [unit of the measure]
    # level at which overturning stops [unit of the measure]; infinite if the body overturns up to the last level
    end: float
    start_width: float  # start_width, end_width: widths of the brackets of both levels [unit of the measure]
    end_width: float

    @property
    def is_open(self) -> bool:
        """True if the motion overturned the body at the highest level."""
        return math.isinf(self.end)


@dataclass(frozen=True)
class OutcomeBrackets:
    """Pairs of levels between which the outcome of a motion changes."""

    motion: IntArray  # index of the motion
    low: FloatArray  # low, high: the levels [unit of the measure]
    high: FloatArray
    # before, after: side of overturning at the two levels: 1 right, -1 left, 0 without overturning
    before: IntArray
    after: IntArray

    @property
    def starts(self) -> BoolArray:
        """True for brackets in which overturning starts."""
        return np.asarray((self.before == 0) & (self.after != 0))

    @property
    def stops(self) -> BoolArray:
        """True for brackets in which overturning stops."""
        return np.asarray((self.before != 0) & (self.after == 0))

    def __len__(self) -> int:
        return int(self.motion.size)

    def chosen(self, selection: Any) -> "OutcomeBrackets":
        return OutcomeBrackets(*(values[selection] for values in vars(self).values()))

    def joined(self, other: "OutcomeBrackets") -> "OutcomeBrackets":
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        both = OutcomeBrackets(*(np.concatenate(pair) for pair in pairs))
        return both.chosen(np.lexsort((both.low, both.motion)))


def brackets_of(motion: IntArray, levels: FloatArray, sides: IntArray) -> OutcomeBrackets:
    """Return pairs of neighbouring levels with different outcomes or sides of overturning.

    Levels increase along rows.
    """
    row, column = np.nonzero(sides[:, 1:] != sides[:, :-1])
    return OutcomeBrackets(
        motion[row], levels[row, column], levels[row, column + 1], sides[row, column], sides[row, column + 1]
    )


def refined(brackets: OutcomeBrackets, outcomes: Outcomes, tolerance: float) -> OutcomeBrackets:
    """Return brackets narrowed to a relative width [-]. A round cuts all brackets together."""
    # Levels with overturning to the right and levels with overturning to the left are both open sets. Between two of
    # them, there is a level without overturning. The search looks for this level and splits the bracket. The first
    # round keeps every change of outcome. Later rounds keep the lowest change per bracket, so that a fractal boundary
    # does not increase the number of brackets without limit. A bracket with a failed history is not changed.
    done = brackets.chosen(slice(0, 0))
    first = True
    while len(brackets):
        target_width = np.maximum(tolerance * brackets.high, 4.0 * np.spacing(brackets.high))
        wide = brackets.high - brackets.low > target_width  # Eq. 184
        done, brackets = done.joined(brackets.chosen(~wide)), brackets.chosen(wide)
        if len(brackets):
            parts = PARTS if first or len(brackets) <= FEW else 2
            stuck, brackets = _cut(brackets, outcomes, parts, every=first)
            done, first = done.joined(stuck), False
    return done


def _cut(
    brackets: OutcomeBrackets, outcomes: Outcomes, parts: int, *, every: bool
) -> tuple[OutcomeBrackets, OutcomeBrackets]:
    """Return the brackets with a failed history, and the pieces of the other brackets."""
    fraction = np.linspace(0.0, 1.0, parts + 1)
    levels = brackets.low[:, None] + fraction * (brackets.high - brackets.low)[:, None]
    levels[:, -1] = brackets.high
    shape = (len(brackets), parts - 1)
    inner, good = outcomes(np.repeat(brackets.motion, parts - 1), levels[:, 1:-1].ravel())
    is_complete = good.reshape(shape).all(axis=1)
    sides = np.hstack([brackets.before[:, None], inner.reshape(shape), brackets.after[:, None]])[is_complete]
    pieces = brackets_of(np.flatnonzero(is_complete), levels[is_complete], sides)
    if not every:
        pieces = _lowest(pieces, brackets)
    return brackets.chosen(~is_complete), replace(pieces, motion=brackets.motion[pieces.motion])


def _lowest(pieces: OutcomeBrackets, parents: OutcomeBrackets) -> OutcomeBrackets:
    """Return the lowest change per bracket. Between two sides, the first stop and, if any, the next start."""
    meeting = parents.starts[pieces.motion] == parents.stops[pieces.motion]
    ends = pieces.starts | pieces.stops
    split = np.isin(pieces.motion, pieces.motion[ends])
    # if a level without overturning is known, changes from side to side are omitted
    kept = pieces.chosen(ends | (meeting & ~split))
    n_wanted = np.where(parents.starts == parents.stops, 2, 1)[kept.motion]
    _, first, count = np.unique(kept.motion, return_index=True, return_counts=True)
    rank = np.arange(len(kept)) - np.repeat(first, count)
    pair = kept.starts | kept.stops
    return kept.chosen(rank < np.where(pair, n_wanted, 1))


def intervals_of(brackets: OutcomeBrackets) -> list[OverturningInterval]:
    """Return the intervals of levels with overturning, from starts and stops."""
    brackets = brackets.chosen(brackets.starts | brackets.stops)
    intervals = []
    middle, width = 0.5 * (brackets.low + brackets.high), brackets.high - brackets.low
    for k in np.flatnonzero(brackets.starts):
        motion, end, end_width = int(brackets.motion[k]), math.inf, 0.0
        if k + 1 < len(brackets) and brackets.motion[k + 1] == motion:
            end, end_width = float(middle[k + 1]), float(width[k + 1])
        intervals.append(OverturningInterval(motion, float(middle[k]), end, float(width[k]), end_width))
    return intervals


def overturning_intervals(
    stripes: MultipleStripeAnalysis, tolerance: float, threads: int | None = None
) -> list[OverturningInterval]:
    """Return all intervals of levels with overturning, by a search between the levels of stripes."""
    subject, responses = stripes.subject, stripes.responses
    motion = np.flatnonzero(responses.good.all(axis=1))
    zero = np.zeros((motion.size, 1))
    levels = np.hstack([zero, np.broadcast_to(stripes.levels, (motion.size, stripes.levels.size))])
    sides = np.hstack([zero.astype(np.int64), responses.sides[motion]])

    def outcomes(motions: IntArray, level: FloatArray) -> tuple[IntArray, BoolArray]:
        factors = (level / subject.intensities[motions]) ** (1.0 / subject.measure.power)
        arrays = results_of(subject.table(motions, factors), threads=threads)
        reached = Responses.of(arrays, subject.parameters, motions.shape)
        return reached.sides, reached.good

    brackets = brackets_of(motion, levels, sides)
    return intervals_of(refined(brackets, outcomes, tolerance))


FIRST_CROSSING = (
    "first crossing: the level of a motion is the lowest at which it overturns the body; what it does above does not "
    "count, and the probability is that this level has been passed"
)
FRACTION = (
    "fraction: the probability at a level is the fraction of the motions that overturn the body at that level, "
    "whatever they do below or above: that of the stripes"
)

OWN, RANDOM = -1, 2  # kinds of `ImpactLaw`: a user-defined law, and a law with sampled coefficients

OWN_LAW = (
    "The restitution is a user-defined law. The limits of the intervals are valid only if a repeated motion gives "
    "the same coefficients."
)


def check_repeatable(law: ImpactLaw) -> None:
    """Raise an error for a restitution that changes when a motion is repeated."""
    if law.kind == RANDOM or law.per_history:
        raise InvalidValueError(
            "{parameter} must be repeatable, got {law}: sampled coefficients have no level at which overturning starts",
            parameter="restitution", law=type(law).__name__,
            hint='Use analysis="stripes".',
        )  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False)
class IncrementalDynamicAnalysis(MultipleStripeAnalysis):
    """Result of an incremental dynamic analysis: stripes, and intervals between the levels of the stripes.

    A body that overturns at one level of a motion may not overturn at a higher level (resurrection). Therefore, two
    definitions of the probability of overturning differ. The result contains both, with their names.
    """

    # all intervals of levels with overturning, by motion and level, for motions without a failed history; survival
    # between overturning to one side and to the other side is always detected; other intervals that are narrower than
    # the distance between levels may be missed
    intervals: tuple[OverturningInterval, ...]

    kind = "incremental"
    definition = FRACTION
    definitions: ClassVar[dict[str, str]] = {"first crossing": FIRST_CROSSING, "fraction": FRACTION}

    @property
    def curves(self) -> FloatArray:
        """Rotation / alpha [-], shape (motions, levels); infinite for overturned bodies."""
        return self.responses.rotation

    @property
    def restitution_note(self) -> str:
        """Condition of the intervals for a user-defined law; empty for other laws."""
        return OWN_LAW if self.histories.law.kind == OWN else ""

    @cached_property
    def complete(self) -> BoolArray:
        """True for motions without a failed history. Only these motions have a first crossing."""
        return np.asarray(self.responses.good.all(axis=1))

    @property
    def fractions(self) -> FloatArray:
        """Fraction of the motions that overturn the body at every level [-]; NaN without a result."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self.counts["overturned"] / self.trials)

    @cached_property
    def first_crossings(self) -> FloatArray:
        """Lowest levels at which the motions overturn the body; infinite if never, NaN after a failed history."""
        crossings = np.where(self.complete, math.inf, math.nan)
        for interval in reversed(self.intervals):
            crossings[interval.motion] = interval.start
        return crossings

    @cached_property
    def first_crossing_fit(self) -> CensoredFit | None:
        """Lognormal distribution of the first crossings; None if fewer than two motions overturn the body.

        If every motion overturns the body, the fit is by moments. Otherwise, the fit is by maximum likelihood, with the
        other crossings above the highest level.
        """
        return fit_crossings(self.first_crossings[self.complete], float(self.levels[-1]))

    @property
    def survivals(self) -> list[tuple[int, float, float]]:
        """Motion and ends of the intervals without overturning above a level with overturning."""
        highest = float(self.levels[-1])
        return [
            (
                interval.motion,
                interval.end,
                following.start if following is not None and following.motion == interval.motion else highest,
            )
            for interval, following in zip(self.intervals, (*self.intervals[1:], None), strict=False)
            if not interval.is_open
        ]

    def resurrected(self, wider_than: float = 0.0) -> list[int]:
        """Return the indices of motions that have levels without overturning above a level with overturning."""
        # wider_than: a relative width [-] such as WIDE excludes narrow survivals
        min_width = checks.within("wider_than", wider_than, 0.0, 1e6)
        return sorted({motion for motion, low, high in self.survivals if high - low > min_width * low})

    @property
    def resurrection(self) -> str:
        """Number of motions without overturning above a level with overturning, as a sentence."""
        facts = {
            "standing": len(self.resurrected()), "count": int(self.complete.sum()), "wide": len(self.resurrected(WIDE)),
        }  # fmt: skip
        return Message(
            "Under {standing} of {count} motion the body overturns at a level but not at a higher level ({wide} "
            "with a safe interval wider than 1 % of the level).",
            facts,
            "Under {standing} of {count} motions the body overturns at a level but not at a higher level ({wide} "
            "with a safe interval wider than 1 % of the level).",
        )

    def fraction_resurrected(self, wider_than: float = 0.0) -> float:
        """Return the fraction of resurrected motions among those without a failed history [-]."""
        return len(self.resurrected(wider_than)) / max(1, int(self.complete.sum()))

    @property
    def dataset(self) -> "xr.Dataset":
        """Dataset of the outcomes at the levels, the first crossings and the intervals, with units."""
        rows = [(i.motion, i.start, i.end) for i in self.intervals]
        motion, start, end = (np.array(column) for column in zip(*rows, strict=True)) if rows else (np.empty(0),) * 3
        definitions = {f"definition_{name.replace(' ', '_')}": meaning for name, meaning in self.definitions.items()}
        return (
            super()
            .dataset.assign(
                first_crossing=("motion", self.first_crossings, self.subject.label),
                interval_motion=("interval", motion.astype(np.int64), {"units": "1"}),
                interval_start=("interval", start, self.subject.label),
                interval_end=("interval", end, self.subject.label),
            )
            .assign_attrs(**definitions)
        )

    def summary(self) -> dict[str, Any]:
        """Return both definitions of the probability with their curves, and the resurrections."""
        first = self.first_crossing_fit
        return {
            **super().summary(),
            "definition": self.definitions,
            "first crossing": first and first.summary(),
            "incomplete motions": np.flatnonzero(~self.complete).tolist(),
            "restitution note": self.restitution_note,
            "motions with resurrection": len(self.resurrected()),
            "fraction with resurrection": self.fraction_resurrected(),
            "fraction with resurrection wider than 1 %": self.fraction_resurrected(WIDE),
        }
