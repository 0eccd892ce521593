"""Impacts on a bed, resolved in time, and their coefficients of restitution by three measures with a common limit.

The first measure is the next peak, which excludes the energy of hops and vibration. The second measure is the energy at
the end, which includes the energy of hops and vibration. The third measure is the angular velocity at the end of an
impulsive impact, for which there is no peak (docs/theory/contact_bed.md).
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
    """Status of the computation of an impact. The value is a sentence for reports."""

    PEAK = "the rotation reached its next peak"
    PARTED = "the contact with the bed has ended"
    TIME_OUT = "neither a peak nor the end of the impact within the time limit"
    TOO_MANY_STEPS = "too many steps"
    FAILED = "no result: the step is smaller than rounding"
    TOPPLED = "the body passed its highest point and overturns"


@dataclass(frozen=True, slots=True)
class Emergent:
    """Coefficients of restitution of one impact."""

    # theta_dot_after / theta_dot_before by the three measures [-]; NaN if a measure does not apply
    by_peak: float
    by_energy: float
    by_velocity: float
    stopped: bool  # True if the body did not step onto the new foot

    @property
    def coefficient(self) -> float:
        """Coefficient by the first available measure: peak, velocity of an impulsive impact, energy [-]."""
        values = (self.by_peak, self.by_velocity, self.by_energy)
        return next((value for value in values if not math.isnan(value)), math.nan)


def emergent_of(setup: Setup, row: Results) -> Emergent:
    """Return the coefficients of restitution of an impact."""
    status = status_of(row["status"])
    if status in {BedStatus.FAILED, BedStatus.TOO_MANY_STEPS}:
        raise InvalidValueError(
            "no coefficient of restitution of this impact: {status}", status=status.value,
            hint="check stiffness and damping",
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
    # energy above rigid rest, plus the static energy of the foot
    energy = row["energy_end"] - weight * rigid.lift(0.0) + (weight * depth - elastic)
    return Emergent(by_peak, ratio(energy), math.nan, stopped=False)


def status_of(code: float) -> BedStatus:
    """Return the status of a code."""
    return tuple(BedStatus)[int(code)]


BedEngine = Literal["auto", "fast", "reference"]
ENGINES: tuple[BedEngine, ...] = ("auto", "fast", "reference")


@dataclass(frozen=True, eq=False)
class BedImpact:
    """Impact with its history.

    Parameters
    ----------
    setup : Setup
        Body, bed, start.
    results : dict of str to float
        Results by the names in `setup.RESULTS` and `setup.COUNTS`, such as "bed_loss" [J]. "contacts" is the number of
        contacts of the body with the bed, which is the number of hops plus one.
    samples : dict of str to ndarray
        History by the names in `setup.SAMPLES`.
    forces : ndarray, shape (samples, points)
        Normal forces of the points [N].
    intervals : ndarray, shape (contacts, 3)
        Point, start and end of every contact [-, s, s]. The end is infinite for a permanent contact.
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
        """Ratio theta_dot_after / theta_dot_before from the result `emergent` [-]."""
        return self.emergent.coefficient

    @property
    def status(self) -> BedStatus:
        """Status of the computation."""
        return status_of(self.results["status"])

    @property
    def impulse_position(self) -> FloatArray:
        """Position k(t) of the resultant [-], from the middle of the base (0) to the new foot (1); NaN in flight."""
        normal = self.samples["normal"]
        with np.errstate(invalid="ignore", divide="ignore"):
            positions = self.samples["moment"] / normal
        positions[normal <= 0.0] = np.nan
        return np.asarray(self._over_half_base(positions))

    @property
    def mean_impulse_position(self) -> float:
        """Position k of the impulse between first touch and parting, including that of the weight [-]."""
        impulse = self.results["impulse"]
        return float(self._over_half_base(self.results["impulse_moment"] / impulse)) if impulse > 0.0 else math.nan

    def _over_half_base(self, at: Any) -> Any:
        first, last = self.setup.rigid.bed.ends
        return (at - 0.5 * (first + last)) / (0.5 * (last - first))

    @property
    def duration(self) -> float:
        """Time from the first touch beyond the old foot until only the new foot, at rest, is in contact [s]."""
        touch, parting = self.results["touch"], self.results["parting"]
        return float(parting - touch) if 0.0 <= touch <= parting else math.nan

    @property
    def audit(self) -> float:
        """Energy balance error (energy at the end + losses - energy at the start) / energy before impact [-]."""
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
    """Return the impact of a rocking body on its bed, resolved in time up to the next peak.

    Parameters
    ----------
    body : Body
        The body.
    bed : ContactBed
        Contact points, laws and friction.
    rotation : float, optional
        Initial rotation about the old foot [rad].
    angular_velocity : float, optional
        theta_dot at landing [rad/s], instead of `rotation`.
    impulsive : bool
        True for an impact without gravity, from flat contact to the end of contact. For laws that absorb the impact in
        one contact, this is the limit of a hard bed.
    ground_acceleration : (float, float)
        Horizontal and vertical acceleration of the ground during the impact [m/s2].
    tolerance : float
        Error of a step, relative to the depth and speed of the impact [-].
    engine : {"auto", "fast", "reference"}
        Compiled engine ("fast") or SciPy ("reference").

    Returns
    -------
    BedImpact
        History, losses and coefficient of restitution.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, the law cannot carry the body, or the engine is unknown.
    MissingExtraError
        If the fast engine is requested but not built.

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
    requested = checks.one_of("engine", engine, ENGINES)
    setup = setup_of(
        body, bed, rotation=rotation, angular_velocity=angular_velocity, impulsive=impulsive,
        ground_acceleration=ground_acceleration, tolerance=tolerance,
    )  # fmt: skip
    if requested == "fast" and not fast.available():
        raise MissingExtraError("the fast engine of the bed was not built; install rocking with a C++17 compiler")
    chosen = reference if requested == "reference" or not fast.available() else fast
    return BedImpact(setup, *chosen.compute_one(setup))


@dataclass(frozen=True, eq=False)
class BedImpacts:
    """Results of many impacts, one row per impact.

    Parameters
    ----------
    setups : sequence of Setup
        The impacts.
    results : dict of str to ndarray
        Columns by name, as for `BedImpact`.
    emergent : tuple of Emergent
        Coefficients of restitution by three measures; NaN for failed impacts.
    """

    setups: Sequence[Setup]
    results: Results
    emergent: tuple[Emergent, ...]

    @property
    def coefficient(self) -> FloatArray:
        """Coefficients of restitution [-]; NaN for failed impacts, see `status`."""
        return np.array([row.coefficient for row in self.emergent])

    @property
    def stopped(self) -> BoolArray:
        """True if the body did not step onto the new foot."""
        return np.array([row.stopped for row in self.emergent])

    @property
    def status(self) -> list[BedStatus]:
        """Status of every computation."""
        return [status_of(code) for code in self.results["status"]]

    @property
    def audit(self) -> FloatArray:
        """Energy balance errors (energy at the end + losses - energy at the start) over energy before impact [-]."""
        return np.asarray(self.results["residual"] / np.array([setup.energy for setup in self.setups]))


def bed_impacts(setups: Iterable[Setup], *, threads: int = 1) -> BedImpacts:
    """Return many impacts. Results of a row depend neither on the number of threads nor on other rows.

    Parameters
    ----------
    setups : iterable of Setup
        Impacts from `setup_of`.
    threads : int
        Number of threads of the fast engine.

    Returns
    -------
    BedImpacts
        One row per impact, in the order of `setups`. A failed impact has a status, and its coefficient is NaN.

    Raises
    ------
    InvalidValueError
        If there is no impact, or the number of threads is not an integer above zero.

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
        raise InvalidValueError("at least one impact is needed, got 0")
    number = checks.whole("threads", threads, 1)
    if fast.available():
        results = fast.many(rows, number)
    else:
        computed = [reference.compute_one(row)[0] for row in rows]
        results = {name: np.array([result[name] for result in computed]) for name in computed[0]}
    emergent = []
    for setup, *row in zip(rows, *(column.tolist() for column in results.values()), strict=True):
        try:
            emergent.append(emergent_of(setup, dict(zip(results, row, strict=True))))
        except InvalidValueError:
            emergent.append(Emergent(math.nan, math.nan, math.nan, stopped=False))
    return BedImpacts(rows, results, tuple(emergent))
