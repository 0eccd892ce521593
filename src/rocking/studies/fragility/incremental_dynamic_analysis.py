"""Incremental dynamic analysis: every motion at rising levels, with every interval in which it overturns the body."""

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
"""Takes numbers of motions and levels; returns sides overturned to (0 if none), and which could be computed."""

PARTS = 16  # pieces that a bracket is cut into in the first round, and as long as there are few of them
WIDE = 0.01  # long records have narrower survivals, in which the body balances on its corner: over their level [-]
FEW = 1000  # brackets up to which more pieces cost less than more rounds; above, brackets are halved


@dataclass(frozen=True)
class OverturningInterval:
    """Levels between which a motion overturns the body."""

    motion: int  # number of the motion
    start: float  # level at which overturning starts [unit of the measure]
    # level at which it stops: above it the body stays standing again; infinite if it did up to the last level
    end: float
    start_width: float  # start_width, end_width: widths of the brackets that hold them [unit of the measure]
    end_width: float

    @property
    def is_open(self) -> bool:
        """Whether the motion still overturned the body at the highest level."""
        return math.isinf(self.end)


@dataclass(frozen=True)
class OutcomeBrackets:
    """Pairs of levels between which the outcome of a motion changes."""

    motion: IntArray  # number of the motion
    low: FloatArray  # low, high: the levels [unit of the measure]
    high: FloatArray
    # before, after: side that the body overturns to at either level: 1 right, -1 left, 0 if it stays standing
    before: IntArray
    after: IntArray

    @property
    def starts(self) -> BoolArray:
        """Where overturning starts."""
        return np.asarray((self.before == 0) & (self.after != 0))

    @property
    def stops(self) -> BoolArray:
        """Where overturning stops."""
        return np.asarray((self.before != 0) & (self.after == 0))

    def __len__(self) -> int:
        return int(self.motion.size)

    def chosen(self, which: Any) -> "OutcomeBrackets":
        return OutcomeBrackets(*(values[which] for values in vars(self).values()))

    def joined(self, other: "OutcomeBrackets") -> "OutcomeBrackets":
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        both = OutcomeBrackets(*(np.concatenate(pair) for pair in pairs))
        return both.chosen(np.lexsort((both.low, both.motion)))


def brackets_of(motion: IntArray, levels: FloatArray, sides: IntArray) -> OutcomeBrackets:
    """Return neighbouring levels, increasing along each row, between which the outcome, or the side of it, changes."""
    row, place = np.nonzero(sides[:, 1:] != sides[:, :-1])
    return OutcomeBrackets(
        motion[row], levels[row, place], levels[row, place + 1], sides[row, place], sides[row, place + 1]
    )


def refined(brackets: OutcomeBrackets, outcomes: Outcomes, tolerance: float) -> OutcomeBrackets:
    """Return narrower brackets, all cut at once in every round, to a width over level [-]."""
    # Levels that overturn to the right and levels that overturn to the left are both open sets, so that between two of
    # them there is one that leaves the body standing: it is searched for, and splits the bracket. The first round keeps
    # every change of outcome that it finds; later ones the lowest in each bracket, so that a fractal boundary cannot
    # make their number explode. A bracket within which a history fails stays as it is.
    done = brackets.chosen(slice(0, 0))
    first = True
    while len(brackets):
        wanted = np.maximum(tolerance * brackets.high, 4.0 * np.spacing(brackets.high))
        wide = brackets.high - brackets.low > wanted  # Eq. 184
        done, brackets = done.joined(brackets.chosen(~wide)), brackets.chosen(wide)
        if len(brackets):
            parts = PARTS if first or len(brackets) <= FEW else 2
            stuck, brackets = _cut(brackets, outcomes, parts, every=first)
            done, first = done.joined(stuck), False
    return done


def _cut(
    brackets: OutcomeBrackets, outcomes: Outcomes, parts: int, *, every: bool
) -> tuple[OutcomeBrackets, OutcomeBrackets]:
    """Return the brackets that a failed history keeps from being cut, and the pieces of the others."""
    share = np.linspace(0.0, 1.0, parts + 1)
    levels = brackets.low[:, None] + share * (brackets.high - brackets.low)[:, None]
    levels[:, -1] = brackets.high
    shape = (len(brackets), parts - 1)
    inner, good = outcomes(np.repeat(brackets.motion, parts - 1), levels[:, 1:-1].ravel())
    known = good.reshape(shape).all(axis=1)
    sides = np.hstack([brackets.before[:, None], inner.reshape(shape), brackets.after[:, None]])[known]
    pieces = brackets_of(np.flatnonzero(known), levels[known], sides)
    if not every:
        pieces = _lowest(pieces, brackets)
    return brackets.chosen(~known), replace(pieces, motion=brackets.motion[pieces.motion])


def _lowest(pieces: OutcomeBrackets, parents: OutcomeBrackets) -> OutcomeBrackets:
    """Return the lowest change of each bracket: for sides that meet, the first stop and the start after it, if any."""
    meeting = parents.starts[pieces.motion] == parents.stops[pieces.motion]
    ends = pieces.starts | pieces.stops
    split = np.isin(pieces.motion, pieces.motion[ends])
    # where a level that leaves the body standing was found, changes from side to side are left
    kept = pieces.chosen(ends | (meeting & ~split))
    wanted = np.where(parents.starts == parents.stops, 2, 1)[kept.motion]
    _, first, count = np.unique(kept.motion, return_index=True, return_counts=True)
    place = np.arange(len(kept)) - np.repeat(first, count)
    pair = kept.starts | kept.stops
    return kept.chosen(place < np.where(pair, wanted, 1))


def intervals_of(brackets: OutcomeBrackets) -> list[OverturningInterval]:
    """Return the intervals of levels that overturn, from where they start and stop."""
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
    """Return all intervals of levels in which motions overturn a body, searched between those of stripes."""
    subject, responses = stripes.subject, stripes.responses
    motion = np.flatnonzero(responses.good.all(axis=1))
    zero = np.zeros((motion.size, 1))
    levels = np.hstack([zero, np.broadcast_to(stripes.levels, (motion.size, stripes.levels.size))])
    sides = np.hstack([zero.astype(np.int64), responses.sides[motion]])

    def outcomes(which: IntArray, level: FloatArray) -> tuple[IntArray, BoolArray]:
        factors = (level / subject.intensities[which]) ** (1.0 / subject.measure.power)
        arrays = results_of(subject.table(which, factors), threads=threads)
        reached = Responses.of(arrays, subject.parameters, which.shape)
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

OWN, RANDOM = -1, 2  # kinds of `ImpactLaw`: one of one's own, and one whose coefficients are drawn

OWN_LAW = (
    "the restitution is a law of one's own: boundaries between levels are those of the body only if its factor is the "
    "same whenever a motion is repeated"
)


def check_repeatable(law: ImpactLaw) -> None:
    """Refuse a restitution that is another one whenever a motion is repeated."""
    if law.kind == RANDOM or law.per_history:
        raise InvalidValueError(
            "{parameter} must be the same whenever a motion is repeated, got {law}: no level starts the overturning "
            "if the coefficients are drawn anew", parameter="restitution", law=type(law).__name__,
            hint='analysis="stripes" takes it',
        )  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False)
class IncrementalDynamicAnalysis(MultipleStripeAnalysis):
    """The outcome of an incremental dynamic analysis: that of the stripes, and the intervals between their levels.

    A stronger motion may leave standing what a weaker one overturns (resurrection). Two definitions of the probability
    of overturning therefore differ; both are given, each with its name.
    """

    # all intervals of levels in which a motion overturns the body, by motion and level, of motions without a failed
    # history. Survival between overturning to one side and to the other is always found; other intervals of either
    # kind that are narrower than the distance between levels may be missed
    intervals: tuple[OverturningInterval, ...]

    kind = "incremental"
    definition = FRACTION
    definitions: ClassVar[dict[str, str]] = {"first crossing": FIRST_CROSSING, "fraction": FRACTION}

    @property
    def curves(self) -> FloatArray:
        """Rotation over alpha, infinite where overturned, of shape (motions, levels) [-]."""
        return self.responses.rotation

    @property
    def restitution_note(self) -> str:
        """What the boundaries take for granted of a law of one's own; empty for the others."""
        return OWN_LAW if self.histories.law.kind == OWN else ""

    @cached_property
    def complete(self) -> BoolArray:
        """Which motions have no failed history; the others have no first crossing."""
        return np.asarray(self.responses.good.all(axis=1))

    @property
    def fractions(self) -> FloatArray:
        """Fraction of the motions that overturn the body at each level; NaN where none could be computed [-]."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self.counts["overturned"] / self.trials)

    @cached_property
    def first_crossings(self) -> FloatArray:
        """Lowest level at which each motion overturns the body; infinite if it does not, NaN if one failed."""
        crossings = np.where(self.complete, math.inf, math.nan)
        for interval in reversed(self.intervals):
            crossings[interval.motion] = interval.start
        return crossings

    @cached_property
    def first_crossing_fit(self) -> CensoredFit | None:
        """Lognormal distribution of the first crossings; None if fewer than two motions overturn the body.

        By moments if every motion overturns it, else by maximum likelihood with the others above the highest level.
        """
        return fit_crossings(self.first_crossings[self.complete], float(self.levels[-1]))

    @property
    def survivals(self) -> list[tuple[int, float, float]]:
        """Motion and ends of the levels, above an overturning one, at which it leaves the body standing after all."""
        highest = float(self.levels[-1])
        return [
            (one.motion, one.end, after.start if after is not None and after.motion == one.motion else highest)
            for one, after in zip(self.intervals, (*self.intervals[1:], None), strict=False)
            if not one.is_open
        ]

    def resurrected(self, wider_than: float = 0.0) -> list[int]:
        """Return which motions leave the body standing at levels above one at which they overturn it."""
        # a width over the lowest of these levels such as WIDE leaves narrow survivals out [-]
        least = checks.within("wider_than", wider_than, 0.0, 1e6)
        return sorted({motion for motion, low, high in self.survivals if high - low > least * low})

    @property
    def resurrection(self) -> str:
        """How many motions leave the body standing at levels above one at which they overturn it, in a sentence."""
        facts = {
            "standing": len(self.resurrected()), "count": int(self.complete.sum()), "wide": len(self.resurrected(WIDE)),
        }  # fmt: skip
        return Message(
            "{standing} of {count} motion left it standing at levels above one that overturns it, {wide} of them over "
            "more than 1 % of the level.",
            facts,
            "{standing} of {count} motions left it standing at levels above one that overturns it, {wide} of them over "
            "more than 1 % of the level.",
        )

    def share_resurrected(self, wider_than: float = 0.0) -> float:
        """Return the share of resurrected motions among those without a failed history, from 0 to 1 [-]."""
        return len(self.resurrected(wider_than)) / max(1, int(self.complete.sum()))

    @property
    def dataset(self) -> "xr.Dataset":
        """All outcomes of the levels, the first crossings and the intervals, with their units."""
        rows = [(i.motion, i.start, i.end) for i in self.intervals]
        motion, start, end = (np.array(column) for column in zip(*rows, strict=True)) if rows else (np.empty(0),) * 3
        words = {f"definition_{name.replace(' ', '_')}": meaning for name, meaning in self.definitions.items()}
        return (
            super()
            .dataset.assign(
                first_crossing=("motion", self.first_crossings, self.subject.label),
                interval_motion=("interval", motion.astype(np.int64), {"units": "1"}),
                interval_start=("interval", start, self.subject.label),
                interval_end=("interval", end, self.subject.label),
            )
            .assign_attrs(**words)
        )

    def summary(self) -> dict[str, Any]:
        """Both definitions, each with its curve, and the resurrections too."""
        first = self.first_crossing_fit
        return {
            **super().summary(),
            "definition": self.definitions,
            "first crossing": first and first.summary(),
            "incomplete motions": np.flatnonzero(~self.complete).tolist(),
            "restitution note": self.restitution_note,
            "motions with resurrection": len(self.resurrected()),
            "share with resurrection": self.share_resurrected(),
            "share with resurrection wider than 1 %": self.share_resurrected(WIDE),
        }
