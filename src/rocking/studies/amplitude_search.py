"""Amplitudes of many bodies, sampled, zoomed where something may hide, and bracketed: always in one batch a round."""

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.outcome import lost_contact
from rocking.studies.question import FAILED

Run = Callable[[dict[str, FloatArray], IntArray], Arrays]
"""Takes sides and scales, and the numbers of the bodies; returns mode, side, peak_ratio and overturning_time."""

# halvings after which neighbouring doubles have met, and the relative width at which a hunt is given up
_MOST_ROUNDS, _GIVEN_UP = 70, 1e-9


@dataclass
class Samples:
    """Histories of many bodies at many scales, sorted by body and scale."""

    body: IntArray  # number of the body
    scale: FloatArray  # factor on the motion [-]
    mode: IntArray  # how it ended
    side: IntArray  # side to which it overturned
    peak: FloatArray  # peak rotation over the slenderness angle [-]
    time: FloatArray  # time of overturning, NaN where it did not [s]
    lost: FloatArray  # 1 where the ground would have to pull, NaN where that is not known [-]

    def joined(self, other: "Samples") -> "Samples":
        """Return these and others, sorted."""
        both = Samples(*(np.concatenate([getattr(self, f.name), getattr(other, f.name)]) for f in fields(self)))
        return both.where(np.lexsort((both.scale, both.body)))

    def where(self, keep: BoolArray | IntArray) -> "Samples":
        """Return some of them."""
        return Samples(*(getattr(self, f.name)[keep] for f in fields(self)))

    @property
    def good(self) -> "Samples":
        """Those that have a result."""
        return self.where(self.mode != FAILED)

    @property
    def falls(self) -> BoolArray:
        return self.mode >= 0

    @property
    def same_body(self) -> BoolArray:
        """Whether each is of the same body as the next."""
        return np.asarray(self.body[1:] == self.body[:-1])


@dataclass
class ScaleBrackets:
    """Pairs of scales between which something changes."""

    body: IntArray  # number of the body
    ends: FloatArray  # scales below and above [-]; shape (n, 2)
    modes: IntArray  # modes there; shape (n, 2)

    @classmethod
    def between(cls, samples: Samples, changes: BoolArray) -> "ScaleBrackets":
        """Return brackets between neighbouring samples."""
        low, high = (np.flatnonzero(changes) + k for k in (0, 1))
        ends = np.stack([samples.scale[low], samples.scale[high]], axis=1)
        return cls(samples.body[low], ends, np.stack([samples.mode[low], samples.mode[high]], axis=1))

    def wide(self, tolerance: float) -> IntArray:
        """Return which are wider than a relative width [-]."""
        (low, high), middle = self.ends.T, self.ends.mean(axis=1)
        return np.flatnonzero((high - low > tolerance * high) & (middle > low) & (middle < high))  # Eq. 184

    def move(self, rows: IntArray, upper: BoolArray, middle: Samples) -> None:
        """Put one end of some brackets into their middles."""
        end = upper.astype(np.int64)
        self.ends[rows, end], self.modes[rows, end] = middle.scale, middle.mode


class AmplitudeSearch:
    """Histories of some bodies, each under a motion of its own or all under one, at more and more scales."""

    def __init__(self, run: Run, sides: dict[str, FloatArray], scales: FloatArray) -> None:
        self.run, self.sides = run, sides
        self.samples = self.compute(np.repeat(np.arange(len(scales)), scales.shape[1]), scales.ravel())

    def compute(self, body: IntArray, scale: FloatArray) -> Samples:
        """Return histories at factors on the motion [-]; random numbers of a body are the same at every factor."""
        values = {name: array[body] for name, array in self.sides.items()}
        results = self.run({**values, "scale": scale}, body)
        names = ("mode", "side", "peak_ratio", "overturning_time")
        mode, side, peak, time = (results[name] for name in names)
        return Samples(body, scale, mode, side, peak, time, lost_contact(results))

    def zoom(self) -> None:
        """Halve the intervals in which a change of verdict may hide between ends that agree."""
        s = self.samples.good
        wanted = suspicious(s)
        middle = 0.5 * (s.scale[:-1] + s.scale[1:])
        self.samples = self.samples.joined(self.compute(s.body[:-1][wanted], middle[wanted]))

    def hunt(self) -> None:
        """Look for survival between neighbours that overturn differently: one must pass it to get to the other."""
        # each such pair is bisected between its own two ways of overturning until a survivor is met; of a third way the
        # nearest is followed
        s = self.samples.good
        ways = 2 * s.mode + (s.side > 0)
        changes = s.same_body & s.falls[1:] & s.falls[:-1] & (ways[1:] != ways[:-1])
        pairs, lower = ScaleBrackets.between(s, changes), ways[:-1][changes]
        lost = np.zeros(lower.size, dtype=np.bool_)
        for _ in range(_MOST_ROUNDS):
            rows = pairs.wide(_GIVEN_UP)
            rows = rows[~lost[rows]]
            if not rows.size:
                break
            middle = self.compute(pairs.body[rows], pairs.ends[rows].mean(axis=1))
            lost[rows[~middle.falls]] = True
            self.samples = self.samples.joined(middle.where(~middle.falls))
            pairs.move(rows, 2 * middle.mode + (middle.side > 0) != lower[rows], middle)

    def brackets(self, tolerance: float) -> ScaleBrackets:
        """Return all changes of verdict between neighbouring samples, bisected together to a relative width [-]."""
        # one whose middle failed stays as wide as it was
        s = self.samples.good
        brackets = ScaleBrackets.between(s, s.same_body & (s.falls[1:] != s.falls[:-1]))
        stuck = np.zeros(brackets.body.size, dtype=np.bool_)
        for _ in range(_MOST_ROUNDS):
            rows = brackets.wide(tolerance)
            rows = rows[~stuck[rows]]
            if not rows.size:
                break
            middle = self.compute(brackets.body[rows], brackets.ends[rows].mean(axis=1))
            failed = middle.mode == FAILED
            stuck[rows[failed]] = True
            rows, middle = rows[~failed], middle.where(~failed)
            brackets.move(rows, middle.falls != (brackets.modes[rows, 0] >= 0), middle)
        return brackets


def suspicious(s: Samples) -> BoolArray:
    """Return in which intervals between neighbouring samples of equal verdict another may hide."""
    # where the peak of survivors, carried on as steeply as next to it, passes the top; next to a largest peak of
    # survivors; next to a longest time of overturning
    same = s.same_body
    peak = np.where(s.falls, np.nan, s.peak)
    steps = np.where(same, np.abs(np.diff(peak)), np.nan)
    steep = np.fmax(steps, np.fmax(np.append(steps[1:], np.nan), np.append(np.nan, steps[:-1])))
    with np.errstate(invalid="ignore"):
        near = np.maximum(peak[1:], peak[:-1]) + steep >= 1.0  # Eq. 183
    return np.asarray(same & (near | _beside_largest(peak, same) | _beside_largest(s.time, same)))


def _beside_largest(values: FloatArray, same: BoolArray) -> BoolArray:
    """Return which intervals touch a local maximum among neighbours that are numbers."""
    with np.errstate(invalid="ignore"):
        rise, fall = same & (values[1:] > values[:-1]), same & (values[:-1] > values[1:])
        known = same & np.isfinite(values[1:]) & np.isfinite(values[:-1])
    left = np.append(True, rise | ~known)  # nothing higher on the left
    right = np.append(fall | ~known, True)
    top = left & right & np.isfinite(values)
    return np.asarray(known & (top[1:] | top[:-1]))


# where the points of a round lie between those of the others, and how many rounds without news are enough
_SHIFTS, _ENOUGH = (0.25, 0.75, 0.5, 0.125), 2


def below_minimum(samples: Samples) -> dict[int, FloatArray]:
    """Return by body the scales up to the first that overturns, if that is not the lowest sampled."""
    bodies, start = np.unique(samples.body, return_index=True)
    below = {}
    for body, first, last in zip(bodies.tolist(), start, np.append(start, samples.body.size)[1:], strict=True):
        falls = np.flatnonzero(samples.falls[first:last])
        if falls.size and falls[0] > 0:
            below[body] = samples.scale[first : first + falls[0] + 1]
    return below


def search_below(scan: AmplitudeSearch, points: int) -> None:
    """Sample below the least amplitude that overturns until it holds."""
    # A round spreads points over the range up to the first sample that overturns. A body is done when two rounds in a
    # row have found nothing that overturns below the survivors next to that sample, or after four.
    held: dict[int, int] = {}
    for shift in _SHIFTS:
        known = {k: each for k, each in below_minimum(scan.samples.good).items() if held.get(k, 0) < _ENOUGH}
        if not known:
            return
        share = (np.arange(points) + shift) / points
        scales = np.concatenate([s[0] * (s[-1] / s[0]) ** share for s in known.values()])
        new = scan.compute(np.repeat(np.array(list(known)), points), scales)
        scan.samples = scan.samples.joined(new)
        least = np.full(1 + max(known), -np.inf)
        least[list(known)] = [s[-2] for s in known.values()]
        news = set(np.unique(new.body[new.falls & (new.scale < least[new.body])]).tolist())
        held |= {k: 0 if k in news else held.get(k, 0) + 1 for k in known}
