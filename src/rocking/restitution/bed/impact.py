"""Impacts on a bed, resolved in time, and the coefficient that emerges, by three measures that share one limit.

By the next peak, where the energy of hops and vibration is not counted; by the energy at the end, where it is; by the
angular velocity at the end of an impulsive impact, which has no peak (docs/theory/contact_bed.md).
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any, Literal

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import InvalidValueError, MissingExtraError
from rocking.restitution.bed import fast, reference
from rocking.restitution.bed.contact_bed import ContactBed
from rocking.restitution.bed.setup import Results, Setup, settlement, setup_of


class BedStatus(Enum):
    """How the computation of an impact ended; the value is the sentence a user reads."""

    PEAK = "the rotation reached its next peak"
    PARTED = "the bed has parted"
    TIME_OUT = "neither a peak nor the end of the impact came in the time allowed"
    TOO_MANY_STEPS = "the steps allowed did not suffice"
    FAILED = "the step fell below rounding: no result"
    TOPPLED = "the body passed its highest point: it topples"


@dataclass(frozen=True, slots=True)
class Emergent:
    """Coefficients of restitution of one impact."""

    # by_peak, by_energy, by_velocity: theta_dot_after / theta_dot_before by each measure; NaN where it does not apply
    # [-]
    by_peak: float
    by_energy: float
    by_velocity: float
    stopped: bool  # whether the body did not step onto the new foot

    @property
    def coefficient(self) -> float:
        """By the peak where there is one, by the velocity of an impulsive impact, else by energy [-]."""
        values = (self.by_peak, self.by_velocity, self.by_energy)
        return next((value for value in values if not math.isnan(value)), math.nan)


def emergent_of(setup: Setup, row: Results) -> Emergent:
    """Return the coefficients of restitution of an impact."""
    status = status_of(row["status"])
    if status in {BedStatus.FAILED, BedStatus.TOO_MANY_STEPS}:
        raise InvalidValueError(
            "no coefficient of restitution of this impact: {status}", status=status.value,
            hint="stiffness or damping far off?",
        )  # fmt: skip
    rigid = setup.rigid
    rotation, velocity = row["rotation"], row["angular_velocity"]
    if setup.impulsive:
        value = velocity / setup.landing_velocity
        return Emergent(math.nan, math.nan, value, stopped=value <= 1e-9)
    inertia = rigid.inertia_about(rigid.pivot(abs(rotation)))
    reached = rigid.potential(rotation) if rotation > 0.0 else 0.0

    def ratio(energy: float) -> float:
        return math.sqrt(2.0 * max(energy, 0.0) / inertia) / setup.landing_velocity  # Eq. 128

    by_peak = ratio(reached) if status is BedStatus.PEAK else math.nan
    if not rotation > 0.0:
        return Emergent(by_peak, 0.0, math.nan, stopped=True)
    weight = rigid.mass * setup.gravity
    depth, elastic = settlement(rigid, setup.law, rotation, weight)
    # above rigid standing, the static energy of the foot added back
    energy = row["energy_end"] - weight * rigid.lift(0.0) + (weight * depth - elastic)
    return Emergent(by_peak, ratio(energy), math.nan, stopped=False)


def status_of(code: float) -> BedStatus:
    """Return how a computation ended."""
    return tuple(BedStatus)[int(code)]


BedEngine = Literal["auto", "fast", "reference"]
ENGINES: tuple[BedEngine, ...] = ("auto", "fast", "reference")


@dataclass(frozen=True, eq=False)
class BedImpact:
    """An impact with its history.

    Parameters
    ----------
    setup : Setup
        Body, bed, start.
    results : dict of str to float
        Of the names in `setup.RESULTS` and `setup.COUNTS`, such as "bed_loss" [J] or "contacts": how often the body as
        a whole came into contact with the bed; hops are one less.
    samples : dict of str to ndarray
        History, of the names in `setup.SAMPLES`.
    forces : ndarray, shape (samples, points)
        Normal force of each point [N].
    intervals : ndarray, shape (contacts, 3)
        Point, begin and end of each contact; the end is infinite for those that last [-, s, s].
    """

    setup: Setup
    results: Results
    samples: dict[str, FloatArray]
    forces: FloatArray
    intervals: FloatArray

    @cached_property
    def emergent(self) -> Emergent:
        """The coefficient of restitution, by three measures."""
        return emergent_of(self.setup, self.results)

    @property
    def coefficient(self) -> float:
        """Ratio theta_dot_after / theta_dot_before, as `emergent` defines it [-]."""
        return self.emergent.coefficient

    @property
    def status(self) -> BedStatus:
        """How the computation ended."""
        return status_of(self.results["status"])

    @property
    def impulse_position(self) -> FloatArray:
        """Position k(t) of the resultant over the half base, from its middle to the new foot; NaN in flight [-]."""
        normal = self.samples["normal"]
        with np.errstate(invalid="ignore", divide="ignore"):
            at = self.samples["moment"] / normal
        at[normal <= 0.0] = np.nan
        return np.asarray(self._over_half_base(at))

    @property
    def mean_impulse_position(self) -> float:
        """Position k of the whole impulse between first touch and parting, the weight's share of it included [-]."""
        impulse = self.results["impulse"]
        return float(self._over_half_base(self.results["impulse_moment"] / impulse)) if impulse > 0.0 else math.nan

    def _over_half_base(self, at: Any) -> Any:
        first, last = self.setup.rigid.bed.ends
        return (at - 0.5 * (first + last)) / (0.5 * (last - first))

    @property
    def duration(self) -> float:
        """From the first touch beyond the old foot until only the new foot presses and is arrested [s]."""
        touch, parting = self.results["touch"], self.results["parting"]
        return float(parting - touch) if 0.0 <= touch <= parting else math.nan

    @property
    def audit(self) -> float:
        """Energy at the end plus losses minus energy at the start, over the energy before the impact [-]."""
        return float(self.results["residual"] / self.setup.energy)


def bed_impact(
    body: Body,
    bed: ContactBed,
    *,
    rotation: float | None = None,
    angular_velocity: float | None = None,
    impulsive: bool = False,
    ground_acceleration: tuple[float, float] = (0.0, 0.0),
    tolerance: float = 1e-9,
    engine: BedEngine = "auto",
) -> BedImpact:
    """Let a body rock down onto its bed and resolve the impact in time, until the next peak.

    Parameters
    ----------
    body : Body
        The body.
    bed : ContactBed
        Its contact points, laws and friction.
    rotation : float, optional
        Rotation about the old foot at which it is let go [rad].
    angular_velocity : float, optional
        theta_dot at which it lands, instead [rad/s].
    impulsive : bool
        Leave gravity out, start flat and end when the bed has parted: the limit of a hard bed for laws that absorb
        the impact in one contact.
    ground_acceleration : (float, float)
        Horizontal and vertical acceleration of the ground during the impact [m/s2].
    tolerance : float
        Error of a step relative to the depth and speed of the impact [-].
    engine : {"auto", "fast", "reference"}
        Compiled engine or SciPy.

    Returns
    -------
    BedImpact
        History, losses and coefficient of restitution.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, the law cannot carry the body, or there is no such engine.
    MissingExtraError
        If the fast engine was asked for and not built.

    Examples
    --------
    >>> from rocking import Block
    >>> from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_impact
    >>> block = Block(width=0.2, height=0.4)
    >>> law = KelvinVoigt(block.mass * (2 * 3.141592653589793 * 400) ** 2, damping_ratio=1.0)
    >>> impact = bed_impact(block, ContactBed.uniform(block, 2, law), angular_velocity=1.0)
    >>> round(impact.coefficient, 2)
    0.7
    """
    asked = checks.one_of("engine", engine, ENGINES)
    setup = setup_of(
        body, bed, rotation=rotation, angular_velocity=angular_velocity, impulsive=impulsive,
        ground_acceleration=ground_acceleration, tolerance=tolerance,
    )  # fmt: skip
    if asked == "fast" and not fast.available():
        raise MissingExtraError(
            "the bed's fast engine was not built: it takes a C++17 compiler when rocking is installed"
        )
    return BedImpact(setup, *(reference if asked == "reference" or not fast.available() else fast).one(setup))


@dataclass(frozen=True, eq=False)
class BedImpacts:
    """Results of many impacts, a row each.

    Parameters
    ----------
    setups : sequence of Setup
        The impacts.
    results : dict of str to ndarray
        Columns by name, as of `BedImpact`.
    emergent : tuple of Emergent
        Coefficients of restitution by three measures; NaN for an impact that failed.
    """

    setups: Sequence[Setup]
    results: Results
    emergent: tuple[Emergent, ...]

    @property
    def coefficient(self) -> FloatArray:
        """Coefficients of restitution; NaN for an impact that failed, see `status` [-]."""
        return np.array([row.coefficient for row in self.emergent])

    @property
    def stopped(self) -> BoolArray:
        """Whether the body did not step onto the new foot."""
        return np.array([row.stopped for row in self.emergent])

    @property
    def status(self) -> list[BedStatus]:
        """How each computation ended."""
        return [status_of(code) for code in self.results["status"]]

    @property
    def audit(self) -> FloatArray:
        """Energy at the end plus losses minus energy at the start, over the energy before each impact [-]."""
        return np.asarray(self.results["residual"] / np.array([setup.energy for setup in self.setups]))


def bed_impacts(setups: Iterable[Setup], *, threads: int = 1) -> BedImpacts:
    """Compute many impacts; the bits of a row depend neither on the threads nor on the other rows.

    Parameters
    ----------
    setups : iterable of Setup
        Impacts from `setup_of`.
    threads : int
        Threads of the fast engine.

    Returns
    -------
    BedImpacts
        A row an impact, in the order given; one that fails says so in its status and has a coefficient of NaN.

    Raises
    ------
    InvalidValueError
        If there is no impact, or the number of threads is not a whole number above zero.

    Examples
    --------
    >>> from rocking import Block
    >>> from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_impacts, setup_of
    >>> block = Block(width=0.2, height=0.4)
    >>> bed = ContactBed.uniform(block, 2, KelvinVoigt(1e9, damping_ratio=1.0))
    >>> impacts = bed_impacts([setup_of(block, bed, angular_velocity=v) for v in (0.5, 1.0)])
    >>> impacts.coefficient.round(2).tolist()
    [0.7, 0.7]
    """
    rows = list(setups)
    if not rows:
        raise InvalidValueError("at least one impact is needed, got none")
    number = checks.whole("threads", threads, 1)
    if fast.available():
        results = fast.many(rows, number)
    else:
        computed = [reference.one(row)[0] for row in rows]
        results = {name: np.array([each[name] for each in computed]) for name in computed[0]}
    emergent = []
    for setup, *row in zip(rows, *(column.tolist() for column in results.values()), strict=True):
        try:
            emergent.append(emergent_of(setup, dict(zip(results, row, strict=True))))
        except InvalidValueError:
            emergent.append(Emergent(math.nan, math.nan, math.nan, stopped=False))
    return BedImpacts(rows, results, tuple(emergent))
