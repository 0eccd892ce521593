"""Where along the levels a motion starts and stops to overturn a body, found as closely as wanted."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.studies.fragility._multiple_stripe_analysis import MultipleStripeAnalysis
from rocking.studies.fragility.subject import Responses
from rocking.studies.histories import results_of

Outcomes = Callable[[IntArray, FloatArray], tuple[IntArray, BoolArray]]
"""Takes numbers of motions and levels; returns sides overturned to (0 if none), and which could be computed."""

PARTS = 16  # pieces that a bracket is cut into in the first round, and as long as there are few of them
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
