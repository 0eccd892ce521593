"""Motions scaled to a target: any measure that grows with the motion."""

from typing import Any

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.motions import intensity
from rocking.motions.intensity import RockingScale
from rocking.motions.motion import GroundMotion


def scaled_to(motion: GroundMotion, measure: Any, target: float, body: RockingScale | None = None) -> GroundMotion:
    """Return the motion scaled to a measure of its intensity.

    Parameters
    ----------
    motion : GroundMotion
        The motion; both components are multiplied by the factor of the horizontal one.
    measure : str or IntensityMeasure
        A name of `measures`, ``sa(period)``, or a measure of one's own; one that grows with the motion.
    target : float
        Value that it shall have [unit of the measure].
    body : RockingScale, optional
        What of a body counts, for measures that need one.

    Returns
    -------
    GroundMotion
        The scaled motion.

    Raises
    ------
    InvalidValueError
        If there is no such measure, no factor changes it, it needs a body, or the motion has none of it.

    Examples
    --------
    >>> from rocking.motions.energy import arias_intensity
    >>> round(arias_intensity(scaled_to(GroundMotion([0.0, 1.0, -2.0], 0.1), "arias", 1.5)), 12)
    1.5
    """
    one = intensity.measure(measure)
    one.check_grows()
    now, name = one.of(motion, body), one.symbol or one.name
    target = checks.positive("target", target, one.unit)
    if not now > 0.0:
        raise InvalidValueError(f"motion must have {name} > 0 {one.unit} to be scaled, got {now:g}; zero throughout?")
    factor = checks.number("factor", (target / now) ** (1.0 / one.power))
    vertical = None if motion.vertical is None else motion.vertical * factor
    what = f"multiplied by {factor!r} so that {name} is {target:g} {one.unit}"
    return motion.changed(what, acceleration=motion.acceleration * factor, vertical=vertical)


def scaled_to_pga(motion: GroundMotion, target: float) -> GroundMotion:
    """Return the motion scaled to a peak ground acceleration.

    Parameters
    ----------
    motion : GroundMotion
        The motion; both components are multiplied by the factor of the horizontal one.
    target : float
        PGA that it shall have [m/s2].

    Returns
    -------
    GroundMotion
        The scaled motion.

    Examples
    --------
    >>> scaled_to_pga(GroundMotion([0.0, 1.0, -2.0], 0.1), 3.0).peak
    3.0
    """
    return scaled_to(motion, "pga", target)


def scaled_to_pgv(motion: GroundMotion, target: float) -> GroundMotion:
    """Return the motion scaled to a peak ground velocity.

    Parameters
    ----------
    motion : GroundMotion
        The motion; both components are multiplied by the factor of the horizontal one.
    target : float
        PGV that it shall have [m/s].

    Returns
    -------
    GroundMotion
        The scaled motion.
    """
    return scaled_to(motion, "pgv", target)


def scaled_to_sa(motion: GroundMotion, target: float, period: float, damping: float = 0.05) -> GroundMotion:
    """Return the motion scaled to a pseudo-spectral acceleration.

    Parameters
    ----------
    motion : GroundMotion
        The motion; both components are multiplied by the factor of the horizontal one.
    target : float
        PSA that it shall have at `period` [m/s2].
    period : float
        Undamped natural period of the oscillator [s].
    damping : float
        Damping ratio, from 0 to below 1 [-].

    Returns
    -------
    GroundMotion
        The scaled motion.
    """
    return scaled_to(motion, intensity.spectral_measure(period, damping), target)
