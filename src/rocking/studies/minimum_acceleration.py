"""Minimum overturning acceleration: all amplitudes at which overturning under a motion begins or ends."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body, Restrained
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray, IntArray
from rocking.dynamics.mechanics import mechanics_of, study_settings
from rocking.dynamics.parameters import sides_of
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.messages import Parameter
from rocking.motions.filters import geometric
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion
from rocking.outcome import contact_words
from rocking.studies.amplitude_search import AmplitudeSearch, Run, below_minimum, search_below
from rocking.studies.question import FAILED, Question

Interval = tuple[float, float]

_FEW = 3  # largest number of intervals that are printed separately


@dataclass(frozen=True, eq=False, repr=False)
class Transitions:
    """Amplitudes of a motion at which overturning of a body begins and ends.

    All intervals of amplitudes wider than `resolution` have been sampled. Narrower intervals are searched near peak
    rotations close to overturning, at maxima of the peak rotation and of the overturning time, and between modes of
    overturning. This is a search, not a proof. Under a record, narrower intervals are possible at all amplitudes. Below
    the minimum, the search continues to `resolution_below`.
    """

    acceleration: FloatArray  # peak ground accelerations of the transitions, increasing [m/s2]
    ratio: FloatArray  # accelerations over `uplift_acceleration` [-]
    scale: FloatArray  # scale factors of the motion [-]
    # modes below and above: -2 no uplift, -1 no overturning, n >= 0 overturned after n impacts
    modes: IntArray
    width: FloatArray  # widths of the brackets, whose middles are the transitions [m/s2]
    min_pga: float  # min_pga, max_pga: range of the search [m/s2]
    max_pga: float
    # ground acceleration of uplift: g tan alpha, or g alpha in the linear equations [m/s2]
    uplift_acceleration: float
    resolution: float  # relative spacing of the first samples [-]
    starts_overturned: bool  # True if the smallest acceleration overturns
    # samples, failed: number of histories, and number of histories without a result; a bracket with a failed history
    # stays wide
    samples: int
    failed: int
    # largest relative gap between samples below the minimum [-]; NaN if there is no minimum
    resolution_below: float = math.nan
    # 1 for histories with a tensile contact force, 0 for others, NaN without a result [-]
    lost_contact: FloatArray = field(default_factory=lambda: np.empty(0))

    def __repr__(self) -> str:
        intervals = self.overturning_intervals
        falls = " and ".join(f"from {low:.4g} to {high:.4g}" for low, high in intervals[:_FEW])
        if len(intervals) > _FEW:  # there may be hundreds under a record
            falls = f"in {len(intervals)} intervals from {intervals[0][0]:.4g} to {intervals[-1][1]:.4g}"
        searched = (
            f"searched from {self.min_pga:.4g} to {self.max_pga:.4g} m/s2 with a resolution of {self.resolution:.2%}"
        )
        return (
            f"<Transitions: overturns {falls} m/s2; {searched}>"
            if falls
            else f"<Transitions: does not overturn; {searched}>"
        )

    def __len__(self) -> int:
        return int(self.acceleration.size)

    @property
    def contact(self) -> str:
        """Number of histories with a tensile contact force, as a sentence; empty if 0."""
        return contact_words(self.lost_contact)

    @property
    def minimum(self) -> float | None:
        """Smallest sampled overturning acceleration; under a record narrower intervals may lie below [m/s2].

        None if no acceleration in the range overturns the body, or if the smallest acceleration does.
        """
        return None if self.starts_overturned or not len(self) else float(self.acceleration[0])

    @property
    def certain(self) -> float | None:
        """Acceleration above which all samples overturn; under a record narrower gaps may lie above [m/s2].

        None if the largest acceleration does not overturn the body.
        """
        if not len(self):
            return self.min_pga if self.starts_overturned else None
        return float(self.acceleration[-1]) if self.modes[-1, 1] >= 0 else None

    @property
    def safe_intervals(self) -> tuple[Interval, ...]:
        """Intervals of the range without overturning [m/s2]. The first interval ends at the minimum."""
        return self._intervals(overturned=False)

    @property
    def overturning_intervals(self) -> tuple[Interval, ...]:
        """Intervals of the range with overturning [m/s2]."""
        return self._intervals(overturned=True)

    def _intervals(self, *, overturned: bool) -> tuple[Interval, ...]:
        ends = [self.min_pga, *self.acceleration.tolist(), self.max_pga]
        falls = [self.starts_overturned, *(self.modes[:, 1] >= 0).tolist()]
        pairs = pairwise(ends)
        return tuple(pair for pair, fall in zip(pairs, falls, strict=True) if fall == overturned)


# limits of the search / uplift acceleration; the lower limit is smaller with a vertical component
_FROM, _FROM_VERTICAL, _TO = 1.0, 0.1, 50.0
_MOST_SAMPLES = 1_000_000


@dataclass(frozen=True)
class Effort:
    """Samples, bisections and tolerance of a search."""

    samples: int = 400  # number of first samples, in equal ratios [-]
    bisections: int = 4  # number of bisections of suspicious intervals, from 0 to 12 [-]
    tolerance: float = 1e-12  # width of the last brackets / acceleration [-]

    def __post_init__(self) -> None:
        for name, low, high in (("samples", 2, _MOST_SAMPLES), ("bisections", 0, 12)):
            checks.whole(name, getattr(self, name), low, high)
        object.__setattr__(self, "tolerance", checks.within("tolerance", self.tolerance, 0.0, 0.1))


@dataclass(frozen=True)
class Cases:
    """Cases of a common search. A case is a body under a motion."""

    sides: dict[str, FloatArray]  # sides of the bodies, as from `sides_of` [rad, rad/s, -]
    peak: FloatArray  # peak acceleration of the motion, by body [m/s2]
    uplift: FloatArray  # acceleration of uplift, by body [m/s2]
    low: FloatArray  # low, high: range of the search [m/s2]
    high: FloatArray
    record: bool  # True for records, under which narrow intervals below the minimum are possible

    @classmethod
    def of(
        cls, motion: Motion, sides: dict[str, FloatArray], settings: Settings, min_pga: float | None,
        max_pga: float | None,
    ) -> "Cases":  # fmt: skip
        """Return the cases of bodies under one motion, with a range of peak accelerations [m/s2]."""
        if not motion.peak > 0.0:
            raise InvalidValueError(
                "{parameter} must have a peak above zero to be scaled, got {motion!r}", parameter="motion",
                motion=motion.name,
            )  # fmt: skip
        uplift_by_side = mechanics_of(settings).uplift_accelerations(settings, sides)
        uplift, record = uplift_by_side.min(axis=0), isinstance(motion, GroundMotion)
        # other components may lift a 3D body before the scaled component does
        lower_start = not mechanics_of(settings).in_plane or getattr(motion, "vertical", None) is not None
        low, high = (_FROM_VERTICAL if lower_start else _FROM) * uplift, _TO * uplift_by_side.max(axis=0)
        if min_pga is not None:
            low = np.full_like(low, checks.positive("min_pga", min_pga, "m/s2"))
        if max_pga is not None:
            high = np.full_like(high, checks.positive("max_pga", max_pga, "m/s2"))
        bad = np.flatnonzero(~(low < high))
        if bad.size:
            k = bad[0]
            raise InvalidValueError(
                "{lowest} must be below {highest}, got {low:g} and {high:g} m/s2 for body {index}"
                if low.size > 1
                else "{lowest} must be below {highest}, got {low:g} and {high:g} m/s2",
                lowest=Parameter("minimum.min_pga", "min_pga"), highest=Parameter("minimum.max_pga", "max_pga"),
                low=low[k], high=high[k], index=k,
            )  # fmt: skip
        return cls(sides, np.full(uplift.size, motion.peak), uplift, low, high, record)

    @classmethod
    def joined(cls, groups: Sequence["Cases"]) -> "Cases":
        sides = {name: np.concatenate([group.sides[name] for group in groups]) for name in groups[0].sides}
        names = ("peak", "uplift", "low", "high")
        arrays = {name: np.concatenate([getattr(group, name) for group in groups]) for name in names}
        return cls(sides, **arrays, record=groups[0].record)

    def grid(self, samples: int) -> FloatArray:
        """Return the first scale factors of the cases, in equal ratios [-]."""
        return np.asarray(geometric(self.low, self.high, samples) / self.peak[:, None])  # Eq. 182


def searched(cases: Cases, effort: Effort, run: Run) -> tuple[Transitions | None, ...]:
    """Return the transitions of all cases, which are computed together. Cases without a result are None."""
    scan = AmplitudeSearch(run, cases.sides, cases.grid(effort.samples))
    if cases.record:
        search_below(scan, effort.samples)
    for _ in range(effort.bisections):
        scan.zoom()
    scan.hunt()
    return _transitions(scan, cases, effort)


def _transitions(scan: AmplitudeSearch, cases: Cases, effort: Effort) -> tuple[Transitions | None, ...]:
    brackets, all_modes, count = scan.brackets(effort.tolerance), scan.samples.mode, cases.uplift.size
    gaps = {k: float(np.max(s[1:] / s[:-1])) - 1.0 for k, s in below_minimum(scan.samples.good).items()}
    # both are sorted by body
    bounds, marks = (
        np.searchsorted(sorted_rows.body, np.arange(count + 1)) for sorted_rows in (brackets, scan.samples)
    )
    transitions: list[Transitions | None] = []
    for k in range(count):
        own, mine = slice(bounds[k], bounds[k + 1]), slice(marks[k], marks[k + 1])
        modes = all_modes[mine]
        has_result = modes != FAILED
        good = modes[has_result]
        if not good.size:
            transitions.append(None)
            continue
        scale, low, high = brackets.ends[own].mean(axis=1), float(cases.low[k]), float(cases.high[k])
        peak, uplift = float(cases.peak[k]), float(cases.uplift[k])
        # the ends of the range are the outermost histories with a result
        first, last = (scan.samples.scale[mine][has_result][[0, -1]] * peak).tolist()
        transitions.append(
            Transitions(
                acceleration=scale * peak,
                ratio=scale * peak / uplift,
                scale=scale,
                modes=brackets.modes[own],
                width=np.diff(brackets.ends[own])[:, 0] * peak,
                min_pga=low if has_result[0] else first,
                max_pga=high if has_result[-1] else last,
                uplift_acceleration=uplift,
                resolution=(high / low) ** (1.0 / (effort.samples - 1)) - 1.0,
                starts_overturned=bool(good[0] >= 0),
                samples=int(modes.size),
                failed=int(np.sum(modes == FAILED)),
                resolution_below=gaps.get(k, math.nan),
                lost_contact=scan.samples.lost[mine],
            )
        )
    return tuple(transitions)


def minimum_overturning_acceleration(
    body: Body | Restrained,
    motion: Motion,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    min_pga: float | None = None,
    max_pga: float | None = None,
    samples: int = 400,
    tolerance: float = 1e-12,
    **options: Any,
) -> Transitions:
    """Return all peak accelerations at which overturning begins or ends.

    The motion is scaled over a range of amplitudes in equal ratios. Intervals that may contain narrow changes are
    bisected several times. Then all changes are bisected together. Under long records, amplitudes with and without
    overturning can alternate within any small interval. The result then contains only the changes between samples.
    Below the smallest overturning amplitude, a record is sampled in up to four more rounds, until two rounds do not
    change the minimum.

    Parameters
    ----------
    body : Body or Restrained
        The body, or a plane body with restraints.
    motion : GroundMotion, Pulse or mapping
        The motion, or its components as for `simulate`. Its amplitude must not be zero.
    restitution : as for `simulate`
        Restitution. A random restitution uses equal random numbers at all amplitudes.
    min_pga, max_pga : float, optional
        Range of peak accelerations [m/s2]. Default: 1 (0.1 with a vertical component) and 50 times the acceleration of
        uplift.
    samples : int
        Number of first samples in equal ratios, and number of samples per round below the minimum [-]. No interval
        wider than the spacing of the samples is missed.
    tolerance : float
        Width of the last brackets over the acceleration [-]. 0 means neighbouring float64 numbers.
    **options
        ``bisections`` (number of bisections of suspicious intervals, 0 to 12, default 4), ``gravity`` [m/s2],
        ``threads``, ``progress`` (function called with the number of histories finished since the last call),
        ``engine`` and fields of `Settings`.

    Returns
    -------
    Transitions
        The transitions, in increasing order.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or if the motion is zero.

    Examples
    --------
    A full sine with three times the frequency parameter of the body. With increasing amplitude, the body overturns
    after an impact, does not overturn, and overturns without impact.

    >>> import math
    >>> import rocking as rk
    >>> block = rk.Block.from_angle(0.2, 1.0)
    >>> pulse = rk.pulses.sine(1.0, 2.0 * math.pi / (3.0 * block.frequency_parameter))
    >>> transitions = minimum_overturning_acceleration(block, pulse, 0.85)
    >>> transitions.modes.tolist()
    [[-1, 1], [1, -1], [-1, 0]]
    """
    if isinstance(body, Sequence):
        raise InvalidValueError(
            parameter="body", allowed="one body", value=body,
            hint="Use minimum_overturning_accelerations for several bodies.",
        )  # fmt: skip
    search: dict[str, Any] = {"min_pga": min_pga, "max_pga": max_pga, "samples": samples, "tolerance": tolerance}
    return minimum_overturning_accelerations([body], motion, restitution, **search, **options)[0]


def minimum_overturning_accelerations(  # noqa: PLR0913 - users set every one of them
    bodies: Sequence[Body | Restrained],
    motion: Motion,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    min_pga: float | None = None,
    max_pga: float | None = None,
    samples: int = 400,
    bisections: int = 4,
    tolerance: float = 1e-12,
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    **settings: Any,
) -> tuple[Transitions, ...]:
    """Return the results of `minimum_overturning_acceleration` for many bodies, which are computed together.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies. The restitution is evaluated for every body.
    motion, restitution, min_pga, max_pga, samples, bisections, tolerance, gravity, threads, progress, **settings
        As for `minimum_overturning_acceleration`.

    Returns
    -------
    tuple of Transitions
        Transitions of the bodies.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or if the motion is zero.
    """
    several: object = bodies
    if not isinstance(several, Sequence) or not several:
        raise InvalidValueError(parameter="bodies", allowed="a sequence of at least one body", value=bodies)
    engine = settings.pop("engine", "auto")
    question = Question(bodies[0], motion, restitution, study_settings(bodies[0], settings, gravity), threads, engine)
    effort = Effort(samples, bisections, tolerance)
    sides = sides_of([question.parameters_of(b) for b in bodies])
    cases = Cases.of(question.motion, sides, question.settings, min_pga, max_pga)

    def run(values: dict[str, FloatArray], body: IntArray) -> Arrays:
        return question.run(values, np.ones(body.size), body, progress)[0]

    transitions = []
    for k, result in enumerate(searched(cases, effort, run)):
        if result is None:
            raise InvalidValueError(
                "no history of body {index} could be computed", index=k, hint="Reduce the range of accelerations."
            )
        transitions.append(result)
    return tuple(transitions)
