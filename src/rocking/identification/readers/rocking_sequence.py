"""Detection of the impacts of one rocking body among many clicks, by the law of the times of impacts.

The time between impacts of a slender body is T_n = (2/p) atanh y_n, and y_n decreases by the coefficient of
restitution: y_(n+1) = r y_n (Housner 1963). With unequal sides or a tilted floor, y_n alternates. The ratio to the last
interval on the same side does not alternate: y_(n+2) = r_left r_right y_n.
"""

from dataclasses import dataclass, field

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray

_MODERATE = 0.6
"""Value of y of the longest interval for an unknown p."""

_FIRST_FALLS = (0.2, 0.45, 0.65, 0.8, 0.9, 0.96)
"""Tried values of y of the first interval. The value 0.2 is the limit of small rotations."""

_FALL, _FALL_SPREAD = -0.22, 0.12
"""Prior mean and standard deviation of ln(r_left r_right), for r from 0.8 to 0.99."""

SCATTER = 0.035
"""Standard deviation of ln(y_(n+2) / y_n) about its mean, because the coefficient scatters by 1 to 3 %."""

_LAW_SCATTER = 0.015
"""Standard deviation of ln(y_(n+1) / y_n) in the comparison of sequences."""

_FADING_SCATTER = 1.0
"""Standard deviation of the log power of a click about the decayed power of the last click on the same side."""

_INTERVALS = (0.02, 3.0)
_RATIOS = (0.5, 1.25)
_SEEDS, _CLICKS, _MOST = 24, 80, 60

MISSED = -3.0
"""Log probability of a missed impact."""

_FEWEST, _SHRUNK, _SHARE = 7, 0.9, 0.7
_ECHO = 0.1
"""Largest ratio of the power of an echo to the power of its impact."""
_CHANCE = 23.0
"""Limit of the score, between the scores of seven impacts in quiet rooms (at least 25.9) and of rain (20.6)."""
_LARGEST_SCATTER, _LARGEST_ALTERNATION, _SLOWEST_FALL = 0.05, 0.25, 0.985


@dataclass(frozen=True, eq=False)
class RockingSequence:
    """Impacts among clicks."""

    members: IntArray  # indices of the clicks
    orders: IntArray  # impact number of each click in the sequence; a missing number is a missed impact
    score: float  # log likelihood ratio relative to random clicks


def half_cycle_fall(intervals: FloatArray, half_p: FloatArray) -> FloatArray:
    """Return ln y of intervals T between impacts, with y = tanh(p T / 2)."""
    return np.asarray(np.log(np.tanh(half_p * intervals)))


def half_cycle(fall: FloatArray, half_p: FloatArray) -> FloatArray:
    """Return the interval between impacts from ln y; inverse of `half_cycle_fall`."""
    return np.asarray(np.arctanh(np.minimum(np.exp(fall), 1.0 - 1e-9)) / half_p)


def find_sequence(
    times: FloatArray, evidence: FloatArray, strengths: FloatArray, length: float
) -> RockingSequence | None:
    """Return the most likely sequence of impacts among clicks; None without three clicks that can begin one.

    `evidence` is the log likelihood ratio of impact to noise for each click, without information from its time.
    `strengths` are the powers, which decrease as the square of y.
    """
    kept = np.sort(np.argsort(-evidence)[:_CLICKS])
    strongest = np.sort(np.argsort(-evidence[kept])[:_SEEDS])
    begun = _Beams.started(times[kept], evidence[kept], np.log(strengths[kept]), strongest, kept.size / length)
    if begun is None:
        return None
    for order in range(3, _MOST):
        if not begun.step(order):
            break
    row = int(begun.best.argmax())
    chain = begun.chains[row, : begun.best_order[row] + 1]
    orders = np.flatnonzero(chain >= 0)
    return RockingSequence(kept[chain[orders]], orders, float(begun.best[row]))


@dataclass(eq=False)
class _Beams:
    """Partial sequences in rows, from every three of the strongest clicks and several y of the first interval."""

    times: FloatArray
    evidence: FloatArray
    powers: FloatArray  # log powers
    rate: float
    half_p: FloatArray
    last: FloatArray  # time of the last impact
    falls: FloatArray  # ln y of the last two intervals
    faded: FloatArray  # logarithms of the power of the last two impacts
    mean: FloatArray  # mean of ln(r_left r_right); the next field is its variance
    variance: FloatArray
    score: FloatArray
    chains: IntArray
    best: FloatArray = field(init=False)
    best_order: IntArray = field(init=False)
    missed: IntArray = field(init=False)

    @classmethod
    def started(
        cls, times: FloatArray, evidence: FloatArray, powers: FloatArray, strongest: IntArray, rate: float
    ) -> "_Beams | None":
        """Return the sequences of three clicks with possible successive intervals."""
        first, second, third = (
            strongest[places] for places in np.array(np.meshgrid(*3 * [np.arange(strongest.size)])).reshape(3, -1)
        )
        early, late = times[second] - times[first], times[third] - times[second]
        ratio = np.divide(late, early, out=np.zeros_like(late), where=early > 0.0)
        could = (early > _INTERVALS[0]) & (early < _INTERVALS[1]) & (ratio > _RATIOS[0]) & (ratio < _RATIOS[1])
        if not could.any():
            return None
        tries = len(_FIRST_FALLS)
        first, second, third = (np.repeat(row[could], tries) for row in (first, second, third))
        early, late = np.repeat(early[could], tries), np.repeat(late[could], tries)
        half_p = np.tile(np.arctanh(_FIRST_FALLS), could.sum()) / early
        falls = np.column_stack([half_cycle_fall(early, half_p), half_cycle_fall(late, half_p)])
        chains = np.full((first.size, _MOST), -1, dtype=np.int64)
        chains[:, :3] = np.column_stack([first, second, third])
        score = evidence[first] + evidence[second] + evidence[third]
        score -= 0.5 * ((falls[:, 1] - falls[:, 0] - 0.5 * _FALL) / 0.12) ** 2
        fading = (powers[third] - powers[first] - 2.0 * _FALL) / _FADING_SCATTER
        score -= 0.5 * np.clip(fading, -4.0, 4.0) ** 2
        size = first.size
        faded = np.column_stack([powers[second], powers[third]])
        return cls(
            times, evidence, powers, rate, half_p, times[third], falls, faded, np.full(size, _FALL),
            np.full(size, _FALL_SPREAD**2), score, chains,
        )  # fmt: skip

    def __post_init__(self) -> None:
        """Store the first scores as the best scores."""
        self.best, self.best_order = self.score.copy(), np.full(self.score.size, 2)
        self.missed = np.zeros(self.score.size, dtype=np.int64)

    def step(self, order: int) -> bool:
        """Search for the next impact of every sequence; return True if any sequence continues."""
        going = self.missed < 2
        if not going.any():
            return False
        expected = self.falls[:, 0] + self.mean
        variance = self.variance + SCATTER**2 * (1.0 + 3.0 * self.missed)
        interval = self.times[None, :] - self.last[:, None]
        later = interval > 0.3 * half_cycle(expected, self.half_p)[:, None]
        safe = np.where(later, interval, 1.0)
        fall = half_cycle_fall(safe, self.half_p[:, None])
        # ratio of the density of the expected time of the next impact to the density of random clicks
        slope = 2.0 * self.half_p[:, None] / np.sinh(np.minimum(2.0 * self.half_p[:, None] * safe, 50.0))
        surprise = (fall - expected[:, None]) ** 2 / variance[:, None]
        fading = (self.powers - self.faded[:, :1] - 2.0 * self.mean[:, None]) / _FADING_SCATTER
        gain = self.evidence - 0.5 * surprise - 0.5 * np.clip(fading, -4.0, 4.0) ** 2
        gain += np.log(slope / (self.rate * np.sqrt(2.0 * np.pi * variance[:, None])))
        gain[~later | (surprise > 16.0)] = -np.inf
        pick = gain.argmax(axis=1)
        rows = np.arange(pick.size)
        hit = going & (gain[rows, pick] > MISSED)
        self.score += np.where(hit, gain[rows, pick], MISSED)
        self._advance(order, hit, pick, np.where(hit, fall[rows, pick], expected), expected, variance)
        return True

    def _advance(
        self, order: int, hit: BoolArray, pick: IntArray, fall: FloatArray, expected: FloatArray, variance: FloatArray
    ) -> None:
        weight = np.where(hit & (self.missed == 0), self.variance / variance, 0.0)
        self.mean += weight * (fall - expected)
        self.variance *= 1.0 - weight
        self.last = np.where(hit, self.times[pick], self.last + half_cycle(expected, self.half_p))
        self.falls = np.column_stack([self.falls[:, 1], fall])
        self.missed = np.where(hit, 0, self.missed + 1)
        power = np.where(hit, self.powers[pick], self.faded[:, 0] + 2.0 * self.mean)
        self.faded = np.column_stack([self.faded[:, 1], power])
        self.chains[hit, order] = pick[hit]
        better = hit & (self.score > self.best)
        self.best[better], self.best_order[better] = self.score[better], order


@dataclass(frozen=True)
class Regularity:
    """Deviation of the intervals of a sequence from the law of rocking."""

    fall: float  # ratio of successive y, the mean coefficient of both sides [-]
    scatter: float  # scatter of ln y about the law [-]
    alternation: float  # deviation of ln y of each side from the mean [-]


def regularity(times: FloatArray, orders: IntArray) -> Regularity:
    """Return the law of the intervals with the best fit; p, the decrease and both sides are free."""
    adjacent = np.flatnonzero(np.diff(orders) == 1)
    intervals, at = np.diff(times)[adjacent], orders[:-1][adjacent]
    design = np.column_stack([np.ones(at.size), at, 1.0 - 2.0 * (at % 2)])
    best = Regularity(1.0, np.inf, 0.0)
    for y in np.linspace(0.1, 0.98, 45):
        fall = half_cycle_fall(intervals, np.arctanh(y) / intervals.max())
        terms, *_ = np.linalg.lstsq(design, fall, rcond=None)
        residuals = fall - design @ terms
        scatter = float(np.sqrt((residuals**2).sum() / max(1, at.size - 4)))
        if scatter < best.scatter:
            best = Regularity(float(np.exp(terms[1])), scatter, float(abs(terms[2])))
    return best


def next_impact(times: FloatArray, orders: IntArray, order: int) -> tuple[float, float]:
    """Return the expected time of an impact after other impacts, and the interval before this impact, at a moderate p.

    ln y changes over two half cycles by the median of the last changes of both sides. The result is NaN for too few
    intervals.
    """
    adjacent = np.flatnonzero(np.diff(orders) == 1)
    intervals = np.diff(times)[adjacent]
    half_p = np.asarray(np.arctanh(_MODERATE) / intervals.max() if adjacent.size else np.nan)
    fall = dict(zip(orders[1:][adjacent].tolist(), half_cycle_fall(intervals, half_p).tolist(), strict=True))
    falls = [fall[n] - fall[n - 2] for n in fall if n - 2 in fall]
    at, span = float(times[-1]), np.nan
    for n in range(int(orders[-2:].min()) + 1, order + 1):
        if n not in fall:
            if n - 2 not in fall or not falls:
                return np.nan, np.nan
            fall[n] = fall[n - 2] + float(np.median(falls[-4:]))
            span = float(half_cycle(np.array(fall[n]), half_p))
            at += span if n > orders[-1] else 0.0
    return at, span


def law_misfit(times: FloatArray, orders: IntArray, loose: float = 0.0) -> FloatArray:
    """Return the squared deviations of ln(y_(n+1) / y_n) / usual squared deviations, for times in rows.

    An offset of one side changes all its intervals equally. Unequal sides and tilts change long intervals more than
    short intervals. With `loose`, one side may be shifted by about this time [s].
    """
    adjacent = np.flatnonzero(np.diff(orders) == 1)
    pairs = np.flatnonzero(np.diff(adjacent) == 1)
    intervals, sign = np.maximum(np.diff(times)[:, adjacent], 1e-3), 1.0 - 2.0 * (orders[adjacent] % 2)
    best = np.full(len(times), np.inf)
    for y in np.linspace(0.1, 0.98, 23):
        half_p = np.arctanh(y) / intervals.max(axis=1, keepdims=True)
        change = np.pad(np.diff(half_cycle_fall(intervals, half_p))[:, pairs], ((0, 0), (0, 1)))
        later = np.diff(sign * 2.0 * half_p[0] / np.sinh(2.0 * half_p[0] * intervals[0]))[pairs]
        design = np.zeros((pairs.size + 1, 3))
        design[:-1, 0], design[:-1, 1] = 1.0, sign[pairs]
        if loose:
            design[:, 2] = np.append(later, _LAW_SCATTER / loose)
        residuals = change @ (np.eye(pairs.size + 1) - design @ np.linalg.pinv(design))
        best = np.minimum(best, ((residuals / _LAW_SCATTER) ** 2).sum(axis=1))
    return best


def rejection_reason(
    times: FloatArray, sequence: RockingSequence, contrasts: FloatArray, strengths: FloatArray
) -> str | None:
    """Return the reason to reject a sequence of clicks; None for a possible sequence of a rocking body."""
    if times.size < _FEWEST:
        return (
            f"the longest sequence of clicks that obeys the law of rocking has {times.size}; at least {_FEWEST} are "
            "required"
        )
    lawful = regularity(times, sequence.orders)
    if lawful.scatter > _LARGEST_SCATTER:
        return (
            f"the intervals scatter by {lawful.scatter:.3f} about the law of rocking; at most {_LARGEST_SCATTER} is "
            "allowed"
        )
    if lawful.alternation > _LARGEST_ALTERNATION:
        return f"the intervals alternate by {lawful.alternation:.2f}; tilts explain at most {_LARGEST_ALTERNATION}"
    if lawful.fall > _SLOWEST_FALL or times[-1] - times[-2] > _SHRUNK * (times[1] - times[0]):
        return f"the intervals do not decrease (ratio {lawful.fall:.3f})"
    mine = strengths[sequence.members]
    as_loud = (strengths >= np.quantile(mine, 0.25)) & (contrasts >= np.quantile(contrasts[sequence.members], 0.25))
    before = np.searchsorted(sequence.members, np.arange(strengths.size), side="right")[:, None] - [1, 2]
    last = np.where(before >= 0, mine[np.maximum(before, 0)], 0.0).max(axis=1)
    as_loud &= strengths >= _ECHO * last  # compared with the louder foot
    own = as_loud[sequence.members].sum()
    reason = None
    if own < _SHARE * as_loud.sum():
        reason = f"the sequence contains only {own} of {as_loud.sum()} equally loud clicks"
    elif sequence.score < _CHANCE:
        reason = (
            f"the sequence may be random (log likelihood ratio {sequence.score:.1f}; at least {_CHANCE:g} is required)"
        )
    return reason
