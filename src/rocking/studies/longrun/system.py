"""A rocking body under harmonic ground motion, and its state over whole periods or from impact to impact."""

import math
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, FEET, FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution, SpeedRestitution
from rocking.dynamics.parameters import RockingParameters
from rocking.errors import InvalidValueError, MissingExtraError
from rocking.restitution._implied import energy_bound

Parameter = Literal["amplitude", "frequency", "restitution", "slenderness"]
_CODES = {"none": -1, "": 0, "amplitude": 1, "frequency": 2, "restitution": 3, "slenderness": 4}
REST_SPEED = 1e-7  # / (alpha p): slower impacts end in rest where the ground does not lift the body
STEP_ERROR = 1e-16  # error of one step / alpha
NONE, IMPACT, REST, OVERTURNED, FAILED = range(5)  # events of the engine


@dataclass(frozen=True)
class Harmonic:
    """Harmonic horizontal ground acceleration, a(t) = amplitude sin(2 pi t / period + phase).

    Parameters
    ----------
    amplitude : float
        Peak ground acceleration [m/s2].
    period : float
        Period [s].
    phase : float, optional
        Phase at time zero [rad].

    Raises
    ------
    InvalidValueError
        If a value is not finite, the amplitude is negative or the period not positive.

    Examples
    --------
    >>> Harmonic(amplitude=2.0, period=0.8).frequency
    7.853981633974483
    """

    amplitude: float
    period: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        checks.within("amplitude", self.amplitude, 0.0, 1e4)
        checks.positive("period", self.period, "s")
        checks.number("phase", self.phase, "rad")

    @property
    def frequency(self) -> float:
        """Circular frequency [rad/s]."""
        return 2.0 * math.pi / self.period


@dataclass(frozen=True, eq=False)
class HarmonicRocking:
    """A plane body with its restitution under harmonic ground motion.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints.
    excitation : Harmonic
        Ground motion.
    restitution : str, RestitutionModel, float, mapping or SpeedRestitution, optional
        Model, coefficients or law over the impact speed, as for `simulate`.
    linear : bool, optional
        Equations of a slender body: sin x = x, cos x = 1.
    gravity : float, optional
        Acceleration of gravity [m/s2].

    Raises
    ------
    InvalidValueError
        If the restitution is random, or a coefficient would create energy.

    References
    ----------
    Hogan (1989), Proc. R. Soc. Lond. A 425:441-476; Spanos and Koh (1984), J. Eng. Mech. 110:1627-1642.
    """

    body: Body
    excitation: Harmonic
    restitution: Any = DEFAULT_RESTITUTION
    linear: bool = False
    gravity: float = conventions.g

    def __post_init__(self) -> None:
        checks.of_kind("excitation", self.excitation, Harmonic, "a Harmonic")
        law = self._parameters.law
        if not isinstance(law, ConstantRestitution | SpeedRestitution):
            raise InvalidValueError(
                parameter="restitution", allowed="a model, coefficients or a SpeedRestitution", value=type(law).__name__
            )

    @classmethod
    def of_ratios(
        cls, body: Body, amplitude: float, frequency: float, *, gravity: float = conventions.g, **options: Any
    ) -> "HarmonicRocking":
        """Return a system from ratios that do not depend on size.

        Parameters
        ----------
        body : Body
            Block, Section or MassPoints.
        amplitude : float
            Peak ground acceleration / (g tan alpha) of the right foot; with ``linear=True`` / (g alpha) [-].
        frequency : float
            Circular frequency / frequency parameter p of the right foot [-].
        gravity : float, optional
            Acceleration of gravity [m/s2].
        **options
            Further parameters of the class.

        Returns
        -------
        HarmonicRocking
            The system.
        """
        checks.positive("frequency", frequency)
        side = body.side("right", gravity)
        angle = side.slenderness_angle
        reach = angle if options.get("linear") else math.tan(angle)
        motion = Harmonic(amplitude * gravity * reach, 2.0 * math.pi / (frequency * side.frequency_parameter))
        return cls(body, motion, gravity=gravity, **options)

    @cached_property
    def sides(self) -> FloatArray:
        """Slenderness angle [rad], p squared [1/s2] and coefficient of both feet, right first, shape (6,)."""
        right, left = self._parameters.right, self._parameters.left
        feet = ((right, left), (left, right))  # an impact ends the contact of one foot and lands on the other
        sides = [(foot.slenderness_angle, foot.frequency_parameter**2, other.coefficient) for foot, other in feet]
        return np.ravel(sides)

    @cached_property
    def _parameters(self) -> RockingParameters:
        return RockingParameters.of_body(self.body, self.restitution, self.gravity)

    @property
    def alpha(self) -> float:
        """Slenderness angle about the right foot [rad]."""
        return float(self.sides[0])

    @property
    def p(self) -> float:
        """Frequency parameter of the right foot [rad/s]."""
        return math.sqrt(float(self.sides[1]))

    @property
    def is_symmetric(self) -> bool:
        """True if both feet have the same angle, frequency parameter and coefficient."""
        return bool(np.allclose(self.sides[:3], self.sides[3:], rtol=1e-13, atol=0.0))

    @property
    def unit(self) -> float:
        """Ground acceleration that lifts the body from its right foot [m/s2]."""
        return self.gravity * (self.alpha if self.linear else math.tan(self.alpha))  # Eq. 331

    @property
    def amplitude_ratio(self) -> float:
        """Peak ground acceleration / uplift acceleration of the right foot [-]."""
        return self.excitation.amplitude / self.unit

    @property
    def frequency_ratio(self) -> float:
        """Circular frequency / p of the right foot [-]."""
        return self.excitation.frequency / self.p

    def changed(self, parameter: Parameter, value: float) -> "HarmonicRocking":
        """Return the system with another value of one parameter.

        Parameters
        ----------
        parameter : {"amplitude", "frequency", "restitution", "slenderness"}
            Amplitude and frequency ratio [-], the coefficient of both feet [-], or the slenderness angle of both feet
            with constant p [rad].
        value : float
            The new value.

        Returns
        -------
        HarmonicRocking
            The new system.

        Raises
        ------
        InvalidValueError
            If the parameter is unknown or the value outside its range.
        """
        checks.one_of("parameter", parameter, ("amplitude", "frequency", "restitution", "slenderness"))
        sides, motion = self.sides.copy(), self.excitation
        if parameter == "amplitude":
            motion = replace(motion, amplitude=checks.within("amplitude", value, 0.0, math.inf) * self.unit)
        elif parameter == "frequency":
            motion = replace(motion, period=2.0 * math.pi / (checks.positive("frequency", value) * self.p))
        elif parameter == "restitution":
            sides[2::3] = checks.within("restitution", value, 0.0, min(energy_bound(self.body, foot) for foot in FEET))
        else:
            sides[0::3] = checks.within(
                "slenderness", value, 0.0, 0.5 * math.pi, unit="rad", open_low=True, open_high=True
            )
        system = copy(self)
        system.__dict__.update(excitation=motion, sides=sides)
        return system

    def value(self, parameter: Parameter) -> float:
        """Return the value of a parameter, in the unit that `changed` accepts.

        Parameters
        ----------
        parameter : {"amplitude", "frequency", "restitution", "slenderness"}
            The parameter.

        Returns
        -------
        float
            Its value.
        """
        if parameter == "amplitude":
            return self.amplitude_ratio
        if parameter == "frequency":
            return self.frequency_ratio
        return float(self.sides[2 if parameter == "restitution" else 0])

    @property
    def sine(self) -> FloatArray:
        """Amplitude / g [-], circular frequency [rad/s] and phase [rad], shape (3,)."""
        motion = self.excitation
        return np.array([motion.amplitude / self.gravity, motion.frequency, motion.phase])

    @property
    def factors(self) -> FloatArray:
        """Points of the speed law: rates [rad/s] and factors [-], shape (2, points)."""
        law = self._parameters.law
        if isinstance(law, SpeedRestitution):
            return np.ascontiguousarray([law.at, law.factors])
        return np.empty((2, 0))


@dataclass(frozen=True)
class Numerics:
    """Numerical settings of long histories.

    Parameters
    ----------
    rest_speed : float, optional
        Speed / (alpha p) after an impact below which the body comes to rest if the ground does not lift it [-].
    step_error : float, optional
        Error of one Taylor step / alpha [-].
    threads : int, optional
        Number of threads.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    rest_speed: float = REST_SPEED
    step_error: float = STEP_ERROR
    threads: int = 1

    def __post_init__(self) -> None:
        checks.within("rest_speed", self.rest_speed, 0.0, 10.0)
        checks.within("step_error", self.step_error, 1e-20, 1e-3)
        checks.whole("threads", self.threads, 1, 1024)


DEFAULTS = Numerics()


@dataclass(frozen=True)
class Periods:
    """States of histories at the ends of periods; counts and peaks are those of the kept periods."""

    ending: Any  # event that ended each history; 0 if it was followed to its end, shape (rows,)
    impacts: Any
    rests: Any  # impacts that ended in rest
    peak: FloatArray  # largest rotation / alpha
    growth: FloatArray  # sums of the logarithms of the growth of the tangent vectors, shape (rows, 2)
    states: FloatArray  # rotation [rad] and angular velocity [rad/s], shape (rows, periods, 2); NaN after the end
    # of the first impacts: time [s], angular velocity after the impact, speed before the impact [rad/s], shape
    # (rows, most_impacts, 3)
    hits: FloatArray


def engine() -> Any:
    """Return the compiled engine."""
    try:
        from rocking.dynamics import _longrun
    except ImportError as error:
        raise MissingExtraError(
            "long-run dynamics needs the compiled engine, which is missing; install rocking with a C++17 compiler"
        ) from error
    return _longrun


def over_periods(
    systems: "HarmonicRocking | list[HarmonicRocking]",
    starts: FloatArray,
    *,
    settled: int = 0,
    kept: int = 1,
    vectors: int = 0,
    most_impacts: int = 0,
    numerics: Numerics = DEFAULTS,
) -> Periods:
    """Follow histories over whole periods, from times, rotations and angular velocities, shape (rows, 3).

    One system for all rows, or one per row; the law and the equations of the first apply to all.
    """
    checks.whole("settled", settled, 0), checks.whole("kept", kept, 1), checks.whole("most_impacts", most_impacts, 0)
    checks.whole("vectors", vectors, 0, 2)
    starts = np.ascontiguousarray(np.atleast_2d(checks.real_array("starts", starts)))
    rows = len(starts)
    if (
        starts.ndim != 2
        or starts.shape[1] != 3
        or not np.isfinite(starts).all()
        or (isinstance(systems, list) and len(systems) != rows)
    ):
        raise InvalidValueError(
            "starts must be finite, with 3 columns, time, rotation and angular velocity, and one row per system, got "
            "shape {shape}", shape=starts.shape,
        )  # fmt: skip
    first = systems[0] if isinstance(systems, list) else systems
    results = np.full((rows, 9), np.nan)
    states, hits = np.full((rows, kept, 2), np.nan), np.full((rows, most_impacts, 3), np.nan)
    engine().many(
        *_tables(systems, rows), starts, results, states, hits, first.factors, settled, vectors, first.linear,
        math.pi / 2.0, numerics.rest_speed, numerics.step_error, numerics.threads,
    )  # fmt: skip
    ending, _, impacts, rests = results[:, :4].astype(np.int64).T
    return Periods(ending, impacts, rests, results[:, 4], results[:, 5:7], states, hits)


def _tables(systems: "HarmonicRocking | list[HarmonicRocking]", rows: int) -> tuple[FloatArray, FloatArray]:
    if isinstance(systems, list):
        return np.array([system.sides for system in systems]), np.array([[system.sine] for system in systems])
    return np.tile(systems.sides, (rows, 1)), np.tile(systems.sine, (rows, 1, 1))


@dataclass(frozen=True)
class ImpactFlights:
    """Ends of flights from one impact over several: speeds / (alpha p), rotations / alpha."""

    phase: FloatArray  # of the ground motion at the last impact [rad], shape (rows,)
    speed: FloatArray  # after the last impact
    event: Any  # IMPACT if all impacts took place, REST, OVERTURNED or FAILED
    jacobian: FloatArray  # derivatives with respect to initial phase and speed, shape (rows, 2, 2)
    by_parameter: FloatArray  # derivatives of phase and speed, at constant phase at the start, shape (rows, 2)
    peak: FloatArray  # largest rotation
    trough: FloatArray  # smallest minimum of the rotation between impacts, with derivatives; infinite without one
    before: FloatArray  # speed before the last impact


def over_impacts(
    system: HarmonicRocking,
    phase: Any,
    speed: Any,
    impacts: int = 1,
    *,
    parameter: Parameter | Literal["", "none"] = "",
    side: Any = 1.0,
    numerics: Numerics = DEFAULTS,
) -> ImpactFlights:
    """Follow flights from phases and speeds / (alpha p) after one impact over several impacts, with derivatives.

    parameter: that of `by_parameter`, "none" without derivatives; side: 1 for a body over its right foot, -1 left.
    """
    checks.whole("impacts", impacts, 1), checks.one_of("parameter", parameter, tuple(_CODES))
    if parameter == "amplitude" and not system.excitation.amplitude:
        raise InvalidValueError(parameter="amplitude", allowed="above 0 for a derivative", value=0.0)
    phase, speed, side = np.broadcast_arrays(*map(np.atleast_1d, (phase, speed, side)))
    rate = system.alpha * system.p
    sine = system.sine
    omega = sine[1]
    starts = np.ascontiguousarray(np.stack([(phase - sine[2]) / omega, speed * rate, side], axis=1), dtype=float)
    ends = np.full((len(starts), 13), np.nan)
    engine().over_impacts(
        *_tables(system, len(starts)), starts, ends, system.factors, impacts, _CODES[parameter], system.linear,
        math.pi / 2.0, numerics.rest_speed, numerics.step_error, numerics.threads,
    )  # fmt: skip
    units = np.array([omega, 1.0 / rate])  # of phase and speed per time [s] and angular velocity [rad/s]
    by_state = ends[:, [4, 5, 7, 8]].reshape(-1, 2, 2)
    jacobian, by = by_state * np.divide.outer(units, units), ends[:, [6, 9]] * units
    if parameter == "amplitude":  # the engine's is relative
        by /= system.amplitude_ratio
    elif parameter == "frequency":  # at constant phase the start time changes with the frequency
        by -= starts[:, :1] / omega * by_state[:, :, 0] * units
        by[:, 0] += ends[:, 0]
        by *= system.p
    elif parameter == "slenderness":  # speeds are in units of alpha p
        by += jacobian[:, :, 1] * speed[:, None] / system.alpha
        by[:, 1] -= ends[:, 1] / rate / system.alpha
    return ImpactFlights(
        ends[:, 0] * omega + sine[2], ends[:, 1] / rate, ends[:, 3].astype(np.int64), jacobian, by, ends[:, 10],
        ends[:, 12], -ends[:, 11] / rate,
    )  # fmt: skip
