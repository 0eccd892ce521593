"""Periodic orbits of harmonic rocking by Newton's method."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError, RockingError
from rocking.studies.longrun.system import IMPACT, HarmonicRocking, ImpactFlights, over_impacts
from rocking.studies.longrun.thresholds import slender_conditions, slender_thresholds

ComplexArray = np.ndarray[tuple[int, ...], np.dtype[np.complex128]]
TOLERANCE = 1e-12  # of phase [rad] and speed / (alpha p) that close an orbit


class OrbitNotFoundError(RockingError):
    """Newton's method found no periodic orbit near the start."""


@dataclass(frozen=True, eq=False)
class PeriodicOrbit:
    """A periodic orbit, defined by its state after an impact.

    For a symmetric body the state after an impact on one foot is equivalent to the mirrored state half a period later.
    The orbit closes after `impacts` impacts and `halves` half periods of the ground motion, up to this symmetry.

    Parameters
    ----------
    system : HarmonicRocking
        Body and ground motion.
    phase, speed : float
        Phase of the ground motion [rad] and speed / (alpha p) after an impact onto the right foot [-].
    impacts, halves : int
        Impacts and half periods until the orbit closes.
    jacobian : ndarray
        Derivatives after `impacts` impacts with respect to the initial phase and speed, shape (2, 2).
    peak : float
        Largest rotation / alpha [-].
    trough : float
        Smallest minimum of the rotation between impacts / alpha [-]; infinite without one.
    """

    system: HarmonicRocking
    phase: float
    speed: float
    impacts: int
    halves: int
    jacobian: FloatArray
    peak: float
    trough: float

    @property
    def trace(self) -> float:
        """Trace of the jacobian [-]."""
        return float(np.trace(self.jacobian))

    @property
    def determinant(self) -> float:
        """Determinant of the jacobian [-]."""
        (a, b), (c, d) = self.jacobian
        return float(a * d - b * c)

    @property
    def multipliers(self) -> ComplexArray:
        """Eigenvalues of the jacobian, the largest modulus first, shape (2,)."""
        values = np.linalg.eigvals(self.jacobian).astype(complex)
        return values[np.argsort(-np.abs(values))]

    @property
    def is_stable(self) -> bool:
        """True if all multipliers lie within the unit circle."""
        return bool(np.abs(self.multipliers[0]) < 1.0)

    @property
    def slowest(self) -> float:
        """Smallest speed before an impact / (alpha p) [-]."""
        numbers = range(1, self.impacts + 1)
        return min(float(over_impacts(self.system, self.phase, self.speed, n).before[0]) for n in numbers)

    @property
    def exponents(self) -> FloatArray:
        """Lyapunov exponents [1/s], shape (2,)."""
        duration = self.halves * math.pi / self.system.excitation.frequency
        return np.log(np.abs(self.multipliers)) / duration


def find_orbit(
    system: HarmonicRocking, phase: float, speed: float, *, impacts: int = 1, halves: int | None = None
) -> PeriodicOrbit:
    """Return the periodic orbit near a state, by Newton's method with exact derivatives.

    Parameters
    ----------
    system : HarmonicRocking
        Body and ground motion.
    phase, speed : float
        Phase of the ground motion [rad] and speed / (alpha p) after an impact onto the right foot [-].
    impacts : int, optional
        Impacts until the orbit closes; even for a body that is not symmetric.
    halves : int, optional
        Half periods of the ground motion until the orbit closes; the number of impacts by default.

    Returns
    -------
    PeriodicOrbit
        The orbit; phase and speed close to 1e-12.

    Raises
    ------
    OrbitNotFoundError
        If the iteration does not converge.
    InvalidValueError
        If impacts and half periods do not have the same parity, or are odd for a body that is not symmetric.

    Examples
    --------
    >>> from rocking import Block
    >>> system = HarmonicRocking.of_ratios(Block(width=1.0, height=2.0), 2.0, 2.0, restitution="housner")
    >>> orbit = find_orbit(system, 5.9, 1.2)
    >>> orbit.is_stable
    True
    """
    halves = impacts if halves is None else halves
    if impacts < 1 or (impacts - halves) % 2 or (impacts % 2 and not system.is_symmetric):
        raise InvalidValueError(
            "this body has no orbit of {impacts} impacts in {halves} half periods: both numbers must be even, or "
            "both odd for a symmetric body", impacts=impacts, halves=halves,
        )  # fmt: skip
    state = np.array([phase, speed], dtype=float)
    for _ in range(60):
        flight = over_impacts(system, state[0], state[1], impacts)
        if flight.event[0] != IMPACT:
            break
        residual = np.array([flight.phase[0] - state[0] - halves * math.pi, flight.speed[0] - state[1]])
        step = np.linalg.solve(flight.jacobian[0] - np.eye(2), -residual)
        if np.max(np.abs(residual)) < TOLERANCE and np.max(np.abs(step)) < 1e-9:
            state = state + step
            return orbit_at(system, state, impacts, halves, over_impacts(system, state[0], state[1], impacts))
        step /= max(1.0, abs(step[0]) / 0.3, abs(step[1]) / (0.3 * abs(state[1])))
        state = state + step
    raise OrbitNotFoundError(
        "no periodic orbit of {impacts} impacts found near phase {phase:.6g} rad and speed {speed:.6g}",
        impacts=impacts, phase=phase, speed=speed, hint="start nearer to the orbit",
    )  # fmt: skip


def orbit_at(
    system: HarmonicRocking, state: FloatArray, impacts: int, halves: int, flight: ImpactFlights
) -> PeriodicOrbit:
    """Return the orbit through a state that closes, from its flight over the impacts."""
    return PeriodicOrbit(
        system, float(state[0] % (2.0 * math.pi)), float(state[1]), impacts, halves, flight.jacobian[0],
        float(flight.peak[0]), float(flight.trough[0]),
    )  # fmt: skip


def symmetric_orbit(system: HarmonicRocking) -> PeriodicOrbit:
    """Return the symmetric orbit of one impact per half period with the larger speed.

    The closed form of slender bodies is the start of Newton's method.

    Parameters
    ----------
    system : HarmonicRocking
        A symmetric body and its ground motion.

    Returns
    -------
    PeriodicOrbit
        The orbit.

    Raises
    ------
    OrbitNotFoundError
        If the amplitude is too small for this orbit.
    InvalidValueError
        If the body is not symmetric.
    """
    if not system.is_symmetric:
        raise InvalidValueError("a symmetric body is needed, with equal feet and coefficients")
    slender_speed, slender_phase = slender_orbit(system.amplitude_ratio, system.frequency_ratio, float(system.sides[2]))
    phase = (slender_phase + math.pi) % (2.0 * math.pi)  # the ground pulls the body over its right foot
    if system.linear:
        return find_orbit(system, phase, slender_speed)
    angle, orbit = system.alpha, None
    for fraction in (0.05, 0.25, 0.5, 0.75, 1.0):  # from the slender body to the real one
        near = system.changed("slenderness", fraction * angle).changed("amplitude", system.amplitude_ratio)
        try:
            orbit = find_orbit(near, phase, slender_speed)
        except OrbitNotFoundError:
            continue
        phase, slender_speed = orbit.phase, orbit.speed
    if orbit is None or orbit.system.alpha != angle:
        orbit = find_orbit(system, phase, slender_speed)
    return orbit


def slender_orbit(amplitude: float, frequency: float, restitution: float) -> tuple[float, float]:
    """Return speed and phase after impact of the symmetric orbit of a slender body, in closed form.

    Parameters
    ----------
    amplitude, frequency : float
        Ratios as for `HarmonicRocking.of_ratios` with ``linear=True`` [-].
    restitution : float
        Coefficient of restitution [-].

    Returns
    -------
    speed, phase : float
        Speed / (alpha p), and phase of -a(t) [rad].

    Raises
    ------
    OrbitNotFoundError
        If the amplitude is too small for this orbit.

    References
    ----------
    Spanos and Koh (1984), J. Eng. Mech. 110:1627-1642.
    """
    free, by_speed = slender_conditions(frequency, restitution)
    size = amplitude / (1.0 + frequency**2)
    a, b, d = by_speed @ by_speed, free @ by_speed, free @ free - size**2
    root = b * b - a * d
    if root < 0.0:
        raise OrbitNotFoundError(
            "no symmetric orbit at amplitude ratio {amplitude:.6g} and frequency ratio {frequency:.6g}: the smallest "
            "amplitude ratio is {minimum:.6g}", amplitude=amplitude, frequency=frequency,
            minimum=slender_thresholds(frequency, restitution).fold,
        )  # fmt: skip
    speed = float((-b + math.sqrt(root)) / a)
    x, y = free + by_speed * speed
    return speed, math.atan2(x, y) % (2.0 * math.pi)
