"""Search of amplitudes of many bodies: samples, bisection of suspicious intervals, brackets. A round is one batch."""

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.outcome import lost_contact
from rocking.studies.question import FAILED

Run = Callable[[dict[str, FloatArray], IntArray], Arrays]
"""Function of sides, scales and body indices that returns mode, side, peak_ratio and overturning_time."""

# number of bisections to neighbouring float64 numbers, and relative width at which a hunt ends
_MOST_ROUNDS, _GIVEN_UP = 70, 1e-9


@dataclass
class Samples:
    """Histories of many bodies at many scales, sorted by body and scale."""

    body: IntArray  # index of the body
    scale: FloatArray  # factor on the motion [-]
    mode: IntArray  # mode of the history
    side: IntArray  # side to which the body overturned
    peak: FloatArray  # peak rotation / slenderness angle [-]
    time: FloatArray  # time of overturning [s]; NaN without overturning
    lost: FloatArray  # 1 for a tensile contact force [-]; NaN if not computed

    def joined(self, other: "Samples") -> "Samples":
        """Return both sets of samples, sorted."""
        both = Samples(*(np.concatenate([getattr(self, f.name), getattr(other, f.name)]) for f in fields(self)))
        return both.where(np.lexsort((both.scale, both.body)))

    def where(self, keep: BoolArray | IntArray) -> "Samples":
        """Return a subset of the samples."""
        return Samples(*(getattr(self, f.name)[keep] for f in fields(self)))

    @property
    def good(self) -> "Samples":
        """Samples with a result."""
        return self.where(self.mode != FAILED)

    @property
    def falls(self) -> BoolArray:
        return self.mode >= 0

    @property
    def same_body(self) -> BoolArray:
        """True for samples of the same body as the next sample."""
        return np.asarray(self.body[1:] == self.body[:-1])


@dataclass
class ScaleBrackets:
    """Pairs of scales with a change between them."""

    body: IntArray  # index of the body
    ends: FloatArray  # scales below and above [-]; shape (n, 2)
    modes: IntArray  # modes at these scales; shape (n, 2)

    @classmethod
    def between(cls, samples: Samples, changes: BoolArray) -> "ScaleBrackets":
        """Return brackets between neighbouring samples."""
        low, high = (np.flatnonzero(changes) + k for k in (0, 1))
        ends = np.stack([samples.scale[low], samples.scale[high]], axis=1)
        return cls(samples.body[low], ends, np.stack([samples.mode[low], samples.mode[high]], axis=1))

    def wide(self, tolerance: float) -> IntArray:
        """Return the indices of brackets that are wider than a relative width [-]."""
        (low, high), middle = self.ends.T, self.ends.mean(axis=1)
        return np.flatnonzero((high - low > tolerance * high) & (middle > low) & (middle < high))  # Eq. 184

    def move(self, rows: IntArray, upper: BoolArray, middle: Samples) -> None:
        """Move one end of brackets to their middles."""
        end = upper.astype(np.int64)
        self.ends[rows, end], self.modes[rows, end] = middle.scale, middle.mode


class AmplitudeSearch:
    """Histories of bodies at an increasing number of scales. A body has one motion."""

    def __init__(self, run: Run, sides: dict[str, FloatArray], scales: FloatArray) -> None:
        self.run, self.sides = run, sides
        self.samples = self.compute(np.repeat(np.arange(len(scales)), scales.shape[1]), scales.ravel())

    def compute(self, body: IntArray, scale: FloatArray) -> Samples:
        """Return histories at scale factors [-]. The random numbers of a body do not depend on the factor."""
        values = {name: array[body] for name, array in self.sides.items()}
        results = self.run({**values, "scale": scale}, body)
        names = ("mode", "side", "peak_ratio", "overturning_time")
        mode, side, peak, time = (results[name] for name in names)
        return Samples(body, scale, mode, side, peak, time, lost_contact(results))

    def zoom(self) -> None:
        """Bisect the intervals between equal verdicts that may contain a change."""
        s = self.samples.good
        selected = suspicious(s)
        middle = 0.5 * (s.scale[:-1] + s.scale[1:])
        self.samples = self.samples.joined(self.compute(s.body[:-1][selected], middle[selected]))

    def hunt(self) -> None:
        """Search scales without overturning between neighbours with different modes of overturning."""
        # a pair is bisected between its two modes of overturning until a scale without overturning appears; a third
        # mode replaces the nearest mode
        s = self.samples.good
        ways = 2 * s.mode + (s.side > 0)
        changes = s.same_body & s.falls[1:] & s.falls[:-1] & (ways[1:] != ways[:-1])
        pairs, lower = ScaleBrackets.between(s, changes), ways[:-1][changes]
        done = np.zeros(lower.size, dtype=np.bool_)
        for _ in range(_MOST_ROUNDS):
            rows = pairs.wide(_GIVEN_UP)
            rows = rows[~done[rows]]
            if not rows.size:
                break
            middle = self.compute(pairs.body[rows], pairs.ends[rows].mean(axis=1))
            done[rows[~middle.falls]] = True
            self.samples = self.samples.joined(middle.where(~middle.falls))
            pairs.move(rows, 2 * middle.mode + (middle.side > 0) != lower[rows], middle)

    def brackets(self, tolerance: float) -> ScaleBrackets:
        """Return brackets of all changes of verdict. They are bisected together to a relative width [-]."""
        # a bracket is not bisected if the simulation at its middle failed
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
    """Return True for intervals between equal verdicts that may contain another verdict."""
    # intervals with an extrapolated peak above 1, and intervals next to a local maximum of the peak rotation without
    # overturning or of the time of overturning
    same = s.same_body
    peak = np.where(s.falls, np.nan, s.peak)
    steps = np.where(same, np.abs(np.diff(peak)), np.nan)
    steep = np.fmax(steps, np.fmax(np.append(steps[1:], np.nan), np.append(np.nan, steps[:-1])))
    with np.errstate(invalid="ignore"):
        near = np.maximum(peak[1:], peak[:-1]) + steep >= 1.0  # Eq. 183
    return np.asarray(same & (near | _beside_largest(peak, same) | _beside_largest(s.time, same)))


def _beside_largest(values: FloatArray, same: BoolArray) -> BoolArray:
    """Return True for intervals next to a local maximum among finite neighbours."""
    with np.errstate(invalid="ignore"):
        rise, fall = same & (values[1:] > values[:-1]), same & (values[:-1] > values[1:])
        is_finite = same & np.isfinite(values[1:]) & np.isfinite(values[:-1])
    left = np.append(True, rise | ~is_finite)  # True if there is no higher value on the left
    right = np.append(fall | ~is_finite, True)
    top = left & right & np.isfinite(values)
    return np.asarray(is_finite & (top[1:] | top[:-1]))


# offsets of the points by round, and number of rounds without a change after which the search ends
_SHIFTS, _ENOUGH = (0.25, 0.75, 0.5, 0.125), 2


def below_minimum(samples: Samples) -> dict[int, FloatArray]:
    """Return the scales of the bodies up to the first scale with overturning, unless it is the lowest scale."""
    bodies, start = np.unique(samples.body, return_index=True)
    below = {}
    for body, first, last in zip(bodies.tolist(), start, np.append(start, samples.body.size)[1:], strict=True):
        falls = np.flatnonzero(samples.falls[first:last])
        if falls.size and falls[0] > 0:
            below[body] = samples.scale[first : first + falls[0] + 1]
    return below


def search_below(scan: AmplitudeSearch, points: int) -> None:
    """Sample below the smallest overturning amplitude until it does not change."""
    # The points of a round cover the range up to the first sample with overturning. A body is finished after two
    # consecutive rounds without overturning below the sample next to the first sample with overturning, or after four
    # rounds.
    unchanged: dict[int, int] = {}
    for shift in _SHIFTS:
        active = {
            k: scales_below
            for k, scales_below in below_minimum(scan.samples.good).items()
            if unchanged.get(k, 0) < _ENOUGH
        }
        if not active:
            return
        fractions = (np.arange(points) + shift) / points
        scales = np.concatenate([s[0] * (s[-1] / s[0]) ** fractions for s in active.values()])
        new = scan.compute(np.repeat(np.array(list(active)), points), scales)
        scan.samples = scan.samples.joined(new)
        limits = np.full(1 + max(active), -np.inf)
        limits[list(active)] = [s[-2] for s in active.values()]
        improved = set(np.unique(new.body[new.falls & (new.scale < limits[new.body])]).tolist())
        unchanged |= {k: 0 if k in improved else unchanged.get(k, 0) + 1 for k in active}
