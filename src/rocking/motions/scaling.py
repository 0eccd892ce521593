"""Motions scaled to a target: PGA, PGV or spectral acceleration."""

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.motions.intensity import peak_ground_acceleration, peak_ground_velocity, spectral_acceleration
from rocking.motions.motion import GroundMotion


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
    return _scaled(motion, peak_ground_acceleration(motion), target, "PGA", "m/s2")


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
    return _scaled(motion, peak_ground_velocity(motion), target, "PGV", "m/s")


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
    now = spectral_acceleration(motion, period, damping)
    return _scaled(motion, now, target, f"PSA({float(period):g} s, {float(damping):g})", "m/s2")


def _scaled(motion: GroundMotion, now: float, target: float, name: str, unit: str) -> GroundMotion:
    target = checks.positive("target", target, unit)
    if not now > 0.0:
        raise InvalidValueError(f"motion must have {name} > 0 {unit} to be scaled, got {now:g}; zero throughout?")
    factor = checks.number("factor", target / now)
    vertical = None if motion.vertical is None else motion.vertical * factor
    what = f"multiplied by {factor!r} so that {name} is {target:g} {unit}"
    return motion.changed(what, acceleration=motion.acceleration * factor, vertical=vertical)
