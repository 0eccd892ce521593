"""Intensity measures as an analysis needs them: of many motions, for a body, and how each grows with a factor."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions import intensity
from rocking.motions.energy import arias_intensity, significant_duration
from rocking.motions.motion import GroundMotion
from rocking.studies.fragility.sampling import sampled
from rocking.studies.motion_set import MotionSet


@dataclass(frozen=True)
class RockingScale:
    """What of a body some measures are divided by."""

    # Ground acceleration that lifts it: g tan(alpha), or g alpha of the slender-linear equations [m/s2]
    threshold: float
    frequency_parameter: float  # p of the side that lifts first [rad/s]
    gravity: float  # acceleration of gravity [m/s2]


@dataclass(frozen=True)
class IntensityMeasure:
    """One measure of how strong a motion is.

    Parameters
    ----------
    name : str
        Its short name.
    words : str
        What it is.
    unit : str
        Its unit, of the SI; ``-`` if it has none.
    power : int
        It grows with this power of a factor on the motion: 1, 2 (Arias intensity) or 0 (ratios and durations).
    of_motion : callable
        Its value, of a record and what is known of the body.
    """

    name: str
    words: str
    unit: str
    power: int
    of_motion: Callable[[GroundMotion, RockingScale], float]

    def values(self, motions: MotionSet, body: RockingScale) -> FloatArray:
        """Return the measure of every motion.

        Parameters
        ----------
        motions : MotionSet
            Records, or pulses, which are sampled finely.
        body : RockingScale
            What of the body counts.

        Returns
        -------
        ndarray
            One value a motion [unit of the measure].

        Raises
        ------
        InvalidValueError
            If the measure of a motion is not a finite number above zero; the motion is named.
        """
        each = (self.of_motion(sampled(motions[k]), body) for k in range(len(motions)))
        found = np.fromiter(each, np.float64, len(motions))
        bad = np.flatnonzero(~((found > 0.0) & np.isfinite(found)))
        if bad.size:
            raise InvalidValueError(
                f"{self.name} of every motion must be finite and > 0 {self.unit}, got {found[bad[0]]:g} of motion "
                f"{bad[0]}, {motions[int(bad[0])].name!r:.60}; zero throughout?"
            )
        return found

    def scaled(self, values: FloatArray, factor: Any) -> FloatArray:
        """Return what the measure becomes when motions are multiplied by a factor.

        Parameters
        ----------
        values : ndarray
            Of the motions as they are [unit of the measure].
        factor : float or array_like
            Factor on the motions [-].

        Returns
        -------
        ndarray
            Of the scaled motions [unit of the measure].

        Examples
        --------
        >>> measure("arias").scaled(np.array([1.5]), 2.0).tolist()
        [6.0]
        """
        return np.asarray(values * np.abs(factor) ** self.power, dtype=np.float64)  # Eq. 229

    def factors(self, values: FloatArray, targets: FloatArray) -> FloatArray:
        """Return the factors that bring every motion to every target.

        Parameters
        ----------
        values : ndarray, shape (motions,)
            Of the motions as they are [unit of the measure].
        targets : ndarray, shape (levels,)
            Wanted values [unit of the measure].

        Returns
        -------
        ndarray, shape (motions, levels)
            Factors [-].

        Raises
        ------
        InvalidValueError
            If no factor changes the measure.
        """
        if self.power == 0:
            raise InvalidValueError(
                f"measure must be one that grows with the motion, got {self.name!r}, which no factor changes; "
                "cloud() takes it"
            )
        return np.asarray((targets[None, :] / values[:, None]) ** (1.0 / self.power), dtype=np.float64)  # Eq. 229


def spectral_measure(period: float, damping: float = 0.05) -> IntensityMeasure:
    """Return the pseudo-spectral acceleration at a period as a measure.

    Parameters
    ----------
    period : float
        Undamped natural period [s].
    damping : float
        Damping ratio, from 0 to below 1 [-].

    Returns
    -------
    IntensityMeasure
        Named ``sa(period)``, or ``sa(period,damping)`` if that is not 0.05.

    Examples
    --------
    >>> spectral_measure(0.5).name
    'sa(0.5)'
    """
    period = checks.positive("period", period, "s")
    damping = checks.within("damping", damping, 0.0, 1.0, open_high=True, hint="a ratio, not a percentage")
    name = f"sa({period!r})" if damping == 0.05 else f"sa({period!r},{damping!r})"
    words = f"pseudo-spectral acceleration at {period:g} s with {100.0 * damping:g} % damping"
    return IntensityMeasure(name, words, "m/s2", 1, lambda m, _: intensity.spectral_acceleration(m, period, damping))


def measures() -> dict[str, IntensityMeasure]:
    """Return the measures that have names; ``sa(period)`` comes besides.

    Returns
    -------
    dict of str to IntensityMeasure
        By name, in the order of a table.

    Examples
    --------
    >>> list(measures())
    ['pga', 'pgv', 'pgd', 'pga/(g tan alpha)', 'p pgv/(g tan alpha)', 'pgv/pga', 'p pgv/pga', 'arias', 'cav',
     'housner', 'd5_95']
    """
    return {one.name: one for one in _NAMED}


def measure(given: Any) -> IntensityMeasure:
    """Return a measure by its name.

    Parameters
    ----------
    given : str or IntensityMeasure
        A key of `measures`, ``sa(period)`` or ``sa(period,damping)`` [s, -], or a measure of one's own.

    Returns
    -------
    IntensityMeasure
        The measure.

    Raises
    ------
    InvalidValueError
        If there is none of that name.

    Examples
    --------
    >>> measure("sa(1.0)").words
    'pseudo-spectral acceleration at 1 s with 5 % damping'
    """
    if isinstance(given, IntensityMeasure):
        return given
    known = measures()
    if isinstance(given, str):
        if (name := checks.spelling(given, known)) in known:
            return known[name]
        if found := spectral_period(given):
            return spectral_measure(*found)
    why = checks.nearest(given, known)
    raise InvalidValueError(f"measure must be one of {', '.join(known)}, or sa(period in s), got {given!r:.60}{why}")


def spectral_period(name: str) -> tuple[float, float] | None:
    """Return period and damping of a spectral measure by its name.

    Returns period [s] and damping ratio [-]; None if the name is of another kind.

    >>> spectral_period("sa(0.5)")
    (0.5, 0.05)
    """
    found = _SPECTRAL.fullmatch(name)
    return None if found is None else (float(found[1]), float(found[2] or 0.05))


_NUMBER = r"\s*(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+)\s*"
_SPECTRAL = re.compile(rf"sa\({_NUMBER}(?:,{_NUMBER})?\)")

_pga, _pgv = intensity.peak_ground_acceleration, intensity.peak_ground_velocity
_NAMED = (
    IntensityMeasure("pga", "peak ground acceleration", "m/s2", 1, lambda m, _: _pga(m)),
    IntensityMeasure("pgv", "peak ground velocity", "m/s", 1, lambda m, _: _pgv(m)),
    IntensityMeasure(
        "pgd", "peak ground displacement", "m", 1, lambda m, _: intensity.peak_ground_displacement(m)
    ),
    IntensityMeasure(
        "pga/(g tan alpha)", "peak ground acceleration over the one that lifts", "-", 1,
        lambda m, b: _pga(m) / b.threshold,  # Eq. 145
    ),
    IntensityMeasure(
        "p pgv/(g tan alpha)", "peak ground velocity that knows how large the body is", "-", 1,
        lambda m, b: b.frequency_parameter * _pgv(m) / b.threshold,  # Eq. 146
    ),
    IntensityMeasure("pgv/pga", "ratio of the peaks, a time scale", "s", 0, lambda m, _: _ratio(_pgv(m), _pga(m))),
    IntensityMeasure(
        "p pgv/pga", "ratio of the peaks over the time scale of the body", "-", 0,
        lambda m, b: _ratio(b.frequency_parameter * _pgv(m), _pga(m)),
    ),
    IntensityMeasure("arias", "Arias intensity", "m/s", 2, lambda m, b: arias_intensity(m, b.gravity)),
    IntensityMeasure(
        "cav", "cumulative absolute velocity", "m/s", 1, lambda m, _: intensity.cumulative_absolute_velocity(m)
    ),
    IntensityMeasure("housner", "Housner intensity", "m", 1, lambda m, _: intensity.housner_intensity(m)),
    IntensityMeasure("d5_95", "significant duration 5-95 %", "s", 0, lambda m, _: _duration(m)),
)  # fmt: skip


def _ratio(above: float, below: float) -> float:
    return above / below if below > 0.0 else 0.0


def _duration(motion: GroundMotion) -> float:
    return significant_duration(motion) if motion.peak > 0.0 else 0.0
