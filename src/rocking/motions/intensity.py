"""How strong a motion is: intensity measures, by the definitions and rules of the field.

Each says how it treats what lies between the samples: energies and areas take the trapezoidal rule of the samples,
velocities and spectra the straight lines that also drive bodies.
"""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import g
from rocking.motions.energy import arias_intensity, significant_duration, significant_times
from rocking.motions.kinematics import largest_displacement, largest_velocity
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.spectrum import response_spectrum

__all__ = [
    "Measure",
    "arias_intensity",
    "cumulative_absolute_velocity",
    "housner_intensity",
    "intensity_measures",
    "normalised_acceleration",
    "normalised_velocity",
    "peak_ground_acceleration",
    "peak_ground_displacement",
    "peak_ground_velocity",
    "significant_duration",
    "significant_times",
    "spectral_acceleration",
]

HOUSNER_PERIODS = np.linspace(0.1, 2.5, 241)
"""Periods of Housner's spectrum intensity [s]: every 0.01 s."""


@dataclass(frozen=True)
class Measure:
    """One intensity measure.

    Parameters
    ----------
    name : str
        What it is called.
    value : float
        Its value in `unit`.
    unit : str
        Its unit, of the SI; ``-`` if it has none.
    """

    name: str
    value: float
    unit: str


def peak_ground_acceleration(motion: GroundMotion) -> float:
    """Return the peak ground acceleration PGA, the largest magnitude of a sample, as the field does.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.

    Returns
    -------
    float
        PGA [m/s2].
    """
    motion = checked_motion(motion)
    return motion.peak


def peak_ground_velocity(motion: GroundMotion) -> float:
    """Return the peak ground velocity PGV.

    The samples are summed by the trapezoidal rule, as the field does; the extreme is that of the quadratic pieces
    between them, where the body that this motion drives sees it.

    Parameters
    ----------
    motion : GroundMotion
        The motion, from rest; correct its baseline first if it drifts.

    Returns
    -------
    float
        PGV up to the last sample [m/s].
    """
    return largest_velocity(motion)


def peak_ground_displacement(motion: GroundMotion) -> float:
    """Return the peak ground displacement PGD.

    The second integral of the straight lines between the samples, as the body sees it, and its extreme also inside
    steps.

    Parameters
    ----------
    motion : GroundMotion
        The motion, from rest; correct its baseline first if it drifts.

    Returns
    -------
    float
        PGD up to the last sample [m].
    """
    return largest_displacement(motion)


def cumulative_absolute_velocity(motion: GroundMotion) -> float:
    """Return the cumulative absolute velocity CAV, the integral of the magnitude of the acceleration.

    EPRI (1988), report NP-5930. The trapezoidal rule of the samples' magnitudes is within 0.5 % of the band-limited
    signal on strong-motion records.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.

    Returns
    -------
    float
        CAV [m/s].

    Examples
    --------
    >>> cumulative_absolute_velocity(GroundMotion([1.0, -1.0], 1.0))
    1.0
    """
    return float(np.trapezoid(np.abs(checked_motion(motion).acceleration), dx=motion.time_step))  # Eq. 143


def housner_intensity(motion: GroundMotion, damping: float = 0.05) -> float:
    """Return Housner's spectrum intensity, the integral of the pseudo-velocity from 0.1 to 2.5 s.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    damping : float
        Damping ratio, from 0 to below 1 [-].

    Returns
    -------
    float
        The intensity, by the trapezoidal rule with 0.01 s [m].
    """
    pseudo = response_spectrum(motion, HOUSNER_PERIODS, damping).pseudo_velocity
    return float(np.trapezoid(pseudo, HOUSNER_PERIODS))  # Eq. 144


def spectral_acceleration(motion: GroundMotion, period: float, damping: float = 0.05) -> float:
    """Return the pseudo-spectral acceleration PSA at one period.

    This is what ground-motion models predict; the true absolute acceleration is in `response_spectrum`.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    period : float
        Undamped natural period of the oscillator [s].
    damping : float
        Damping ratio, from 0 to below 1 [-].

    Returns
    -------
    float
        PSA [m/s2].
    """
    return float(response_spectrum(motion, checks.positive("period", period, "s"), damping).pseudo_acceleration[0])


def normalised_acceleration(motion: GroundMotion, slenderness_angle: float, gravity: float = g) -> float:
    """Return PGA over ``g tan(alpha)``: a body at rest rocks if this is above 1.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    slenderness_angle : float
        Angle alpha of the body, between 0 and pi/2 [rad].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float
        The ratio [-].
    """
    return peak_ground_acceleration(motion) / _threshold(slenderness_angle, gravity)  # Eq. 145


def normalised_velocity(
    motion: GroundMotion, slenderness_angle: float, frequency_parameter: float, gravity: float = g
) -> float:
    """Return ``p PGV / (g tan(alpha))``, the measure that knows how large the body is.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    slenderness_angle : float
        Angle alpha of the body, between 0 and pi/2 [rad].
    frequency_parameter : float
        Frequency parameter p of the body [rad/s].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float
        The ratio [-].
    """
    p = checks.positive("frequency_parameter", frequency_parameter, "rad/s")
    return p * peak_ground_velocity(motion) / _threshold(slenderness_angle, gravity)  # Eq. 146


def intensity_measures(motion: GroundMotion) -> dict[str, Measure]:
    """Return the intensity measures that need no body.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts. One that is zero throughout is refused: it has no duration.

    Returns
    -------
    dict of str to Measure
        By short name, in the order of a table.

    Examples
    --------
    >>> intensity_measures(GroundMotion([0.0, 1.0, -1.0, 0.0], 0.1))["pga"]
    Measure(name='peak ground acceleration', value=1.0, unit='m/s2')
    """
    return {
        "pga": Measure("peak ground acceleration", peak_ground_acceleration(motion), "m/s2"),
        "pgv": Measure("peak ground velocity", peak_ground_velocity(motion), "m/s"),
        "pgd": Measure("peak ground displacement", peak_ground_displacement(motion), "m"),
        "arias": Measure("Arias intensity", arias_intensity(motion), "m/s"),
        "cav": Measure("cumulative absolute velocity", cumulative_absolute_velocity(motion), "m/s"),
        "d5_95": Measure("significant duration 5-95 %", significant_duration(motion), "s"),
        "d5_75": Measure("significant duration 5-75 %", significant_duration(motion, 5.0, 75.0), "s"),
        "housner": Measure("Housner intensity", housner_intensity(motion), "m"),
    }


def _threshold(slenderness_angle: float, gravity: float) -> float:
    alpha = checks.within(
        "slenderness_angle", slenderness_angle, 0.0, 0.5 * math.pi, unit="rad", open_low=True, open_high=True
    )
    return checks.positive("gravity", gravity, "m/s2") * math.tan(alpha)  # Eq. 25
