"""How strong a motion is: intensity measures, by the definitions and rules of the field.

Energies and areas take the trapezoidal rule of the samples, velocities and spectra the straight lines that also drive
bodies. An entry in `MEASURES` is all that a measure needs: `rocking motion`, fragility, scaling, pictures and
OpenQuake's files read it there.
"""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.components import leading
from rocking.motions.integrals import (
    arias_intensity,
    peak_ground_displacement,
    peak_ground_velocity,
    significant_duration,
)
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.pulse import Pulse
from rocking.motions.spectrum import response_spectrum
from rocking.portable import trapezoid

HOUSNER_PERIODS = np.linspace(0.1, 2.5, 241)  # periods of Housner's spectrum intensity [s]: every 0.01 s

SAMPLES_PER_PERIOD = 4000
"""Samples of the shortest period of a pulse: its measures are off by less than 1e-6, its PGA by nothing."""

_NUMBER = r"\s*(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+)\s*"
_SPECTRAL = re.compile(rf"sa\({_NUMBER}(?:,{_NUMBER})?\)")


@dataclass(frozen=True)
class Measure:
    """One intensity measure of one motion.

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
    return checked_motion(motion).peak


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
    return trapezoid(np.abs(checked_motion(motion).acceleration), motion.time_step)  # Eq. 143


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
    return trapezoid(pseudo, np.diff(HOUSNER_PERIODS))  # Eq. 144


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
    shown = [one for one in MEASURES.values() if one.is_listed and not one.needs_body]
    return {one.name: Measure(one.words, one.of(motion), one.unit) for one in shown}


def key_with_unit(name: str, unit: str) -> str:
    """Return a name with its unit, as keys of JSON have them.

    >>> key_with_unit("pgv", "m/s"), key_with_unit("pga/(g tan alpha)", "-")
    ('pgv_m_s', 'pga/(g tan alpha)')
    """
    return name if unit == "-" else f"{name}_{unit.replace('/', '_')}"


def _threshold(slenderness_angle: float, gravity: float) -> float:
    """Return the ground acceleration that lifts a body [m/s2]."""
    alpha = checks.within(
        "slenderness_angle", slenderness_angle, 0.0, 0.5 * math.pi, unit="rad", open_low=True, open_high=True
    )
    return checks.positive("gravity", gravity, "m/s2") * math.tan(alpha)  # Eq. 25


@dataclass(frozen=True)
class RockingScale:
    """What of a body some measures are divided by; without a body, gravity alone.

    Parameters
    ----------
    threshold : float
        Ground acceleration that lifts it: g tan(alpha), or g alpha of the slender-linear equations [m/s2].
    frequency_parameter : float
        p of the side that lifts first [rad/s].
    gravity : float
        Acceleration of gravity [m/s2].
    """

    threshold: float = math.nan
    frequency_parameter: float = math.nan
    gravity: float = g


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
    symbol : str
        How it is written in short; the name, if empty.
    needs_body : bool
        Whether a motion alone does not tell it.
    is_listed : bool
        Whether it stands in the table of a motion, where ratios of what stands there would say nothing new.
    openquake : tuple of str, str and float, optional
        Name in OpenQuake, unit there, and one SI unit in that unit; None if OpenQuake has no such measure.
    uplift : callable, optional
        Its value above which every horizontal motion lifts a body with equal sides and below which none does, of what
        is known of the body; None if there is none.

    Examples
    --------
    >>> MEASURES["pga"].of(GroundMotion([0.0, 1.0, -2.0], 0.1))
    2.0
    """

    name: str
    words: str
    unit: str
    power: int
    of_motion: Callable[[GroundMotion, RockingScale], float]
    symbol: str = ""
    needs_body: bool = False
    is_listed: bool = True
    openquake: tuple[str, str, float] | None = None
    uplift: Callable[[RockingScale], float] | None = None

    def of(self, motion: GroundMotion, body: RockingScale | None = None) -> float:
        """Return the measure of one motion.

        Parameters
        ----------
        motion : GroundMotion
            The motion; its horizontal part counts.
        body : RockingScale, optional
            What of the body counts; a measure that needs it is refused without.

        Returns
        -------
        float
            The value [unit of the measure].
        """
        if self.needs_body and body is None:
            raise InvalidValueError(
                "{measure} is known of a motion and a body, got the motion alone", measure=self.name
            )
        return self.of_motion(motion, body or RockingScale())

    @property
    def key(self) -> str:
        """Name and unit, as keys of JSON have them, such as ``pga_m_s2``."""
        return key_with_unit(self.name, self.unit)

    def values(self, motions: Any, body: RockingScale) -> FloatArray:
        """Return the measure of every motion, all of which must be finite and above zero.

        Parameters
        ----------
        motions : MotionSet
            Records, or pulses, which are sampled finely; of several components the leading one counts.
        body : RockingScale
            What of the body counts.

        Returns
        -------
        ndarray
            One value a motion [unit of the measure].
        """
        each = (sampled(leading(motions[k])) for k in range(len(motions)))
        strong = (self.of_motion(motion, body) if motion.peak > 0.0 else 0.0 for motion in each)
        found = np.fromiter(strong, np.float64, len(motions))
        bad = np.flatnonzero(~((found > 0.0) & np.isfinite(found)))
        if bad.size:
            raise InvalidValueError(
                "{name} of every motion must be finite and > 0 {unit}, got {size:g} of motion "
                "{index}, {motion}; zero throughout?",
                name=self.name,
                unit=self.unit,
                size=found[bad[0]],
                index=bad[0],
                motion=f"{motions[int(bad[0])].name!r:.60}",
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

    def check_grows(self) -> None:
        """Refuse a measure that no factor on the motion changes: one of power zero."""
        if self.power == 0:
            raise InvalidValueError(
                "{parameter} must be one that grows with the motion, got {value}, which no factor changes",
                parameter="measure", value=self.name, hint='analysis="cloud" takes it',
            )  # fmt: skip

    def factors(self, values: FloatArray, targets: FloatArray) -> FloatArray:
        """Return the factors that bring every motion to every target; a measure must grow with the motion for that.

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
        """
        self.check_grows()
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
    return IntensityMeasure(
        name, words, "m/s2", 1, lambda m, _: spectral_acceleration(m, period, damping),
        symbol=f"PSA({period:g} s, {damping:g})",
        openquake=(f"SA({period!r})", "g", 1.0 / g) if damping == 0.05 else None,
    )  # fmt: skip


def measures() -> dict[str, IntensityMeasure]:
    """Return the measures that have names; ``sa(period)`` comes besides.

    Returns
    -------
    dict of str to IntensityMeasure
        By name, in the order of a table.

    Examples
    --------
    >>> list(measures())[:4]
    ['pga', 'pgv', 'pgd', 'pga/(g tan alpha)']
    """
    return dict(MEASURES)


def measure(name: Any) -> IntensityMeasure:
    """Return a measure by its name.

    Parameters
    ----------
    name : str or IntensityMeasure
        A key of `measures`, ``sa(period)`` or ``sa(period,damping)`` [s, -], or a measure of one's own.

    Returns
    -------
    IntensityMeasure
        The measure.

    Examples
    --------
    >>> measure("sa(1.0)").words
    'pseudo-spectral acceleration at 1 s with 5 % damping'
    """
    if isinstance(name, IntensityMeasure):
        return name
    if isinstance(name, str):
        if (known := checks.spelling(name, MEASURES)) in MEASURES:
            return MEASURES[known]
        if spectral := spectral_period(name):
            return spectral_measure(*spectral)
    there, why = ", ".join(MEASURES), checks.nearest(name, MEASURES)
    raise InvalidValueError(parameter="measure", allowed=f"one of {there}, or sa(period in s)", value=name, hint=why)


def spectral_period(name: str) -> tuple[float, float] | None:
    """Return period [s] and damping ratio [-] of a spectral measure by its name; None of another kind."""
    found = _SPECTRAL.fullmatch(name)
    return None if found is None else (float(found[1]), float(found[2] or 0.05))


def exchange_unit(name: str, unit: str) -> tuple[str, float]:
    """Return the unit in which other programs read a measure, and one SI unit in that unit.

    The unit of OpenQuake where OpenQuake has the measure; g for other accelerations; else the unit of the measure.

    >>> exchange_unit("pgv", "m/s")
    ('cm/s', 100.0)
    """
    period = spectral_period(name)
    known = MEASURES.get(name) if period is None else spectral_measure(*period)
    if known is not None and known.openquake is not None:
        return known.openquake[1:]
    return ("g", 1.0 / g) if unit == "m/s2" else (unit, 1.0)


def sampled(motion: GroundMotion | Pulse) -> GroundMotion:
    """Return a motion as a record: a pulse is sampled so finely that its measures are right to 1e-6, its peak exact."""
    if not isinstance(motion, Pulse):
        return motion
    count = max(200, int(np.ceil(SAMPLES_PER_PERIOD * motion.fastest * motion.duration / (2.0 * np.pi))))
    made = motion.sampled(motion.duration / count)
    samples = np.array(made.acceleration)
    top = int(np.argmax(np.abs(samples)))
    samples[top] = np.copysign(motion.peak, samples[top])
    return made.changed("the largest sample raised to the peak of the pulse", acceleration=samples)


_NAMED = (
    IntensityMeasure(
        "pga", "peak ground acceleration", "m/s2", 1, lambda m, _: peak_ground_acceleration(m),
        symbol="PGA", openquake=("PGA", "g", 1.0 / g), uplift=lambda b: b.threshold,
    ),
    IntensityMeasure(
        "pgv", "peak ground velocity", "m/s", 1, lambda m, _: peak_ground_velocity(m),
        symbol="PGV", openquake=("PGV", "cm/s", 100.0),
    ),
    IntensityMeasure(
        "pgd", "peak ground displacement", "m", 1, lambda m, _: peak_ground_displacement(m),
        symbol="PGD", openquake=("PGD", "cm", 100.0),
    ),
    IntensityMeasure(
        "pga/(g tan alpha)", "peak ground acceleration over the one that lifts", "-", 1,
        lambda m, b: peak_ground_acceleration(m) / b.threshold,  # Eq. 145
        symbol="PGA/(g tan alpha)", needs_body=True, uplift=lambda _: 1.0,
    ),
    IntensityMeasure(
        "p pgv/(g tan alpha)", "peak ground velocity that knows how large the body is", "-", 1,
        lambda m, b: b.frequency_parameter * peak_ground_velocity(m) / b.threshold,  # Eq. 146
        symbol="p PGV/(g tan alpha)", needs_body=True,
    ),
    IntensityMeasure(
        "pgv/pga", "ratio of the peaks, a time scale", "s", 0,
        lambda m, _: peak_ground_velocity(m) / peak_ground_acceleration(m), symbol="PGV/PGA", is_listed=False,
    ),
    IntensityMeasure(
        "p pgv/pga", "ratio of the peaks over the time scale of the body", "-", 0,
        lambda m, b: b.frequency_parameter * peak_ground_velocity(m) / peak_ground_acceleration(m),
        symbol="p PGV/PGA", needs_body=True,
    ),
    IntensityMeasure(
        "arias", "Arias intensity", "m/s", 2, lambda m, b: arias_intensity(m, b.gravity),
        symbol="Arias", openquake=("IA", "m/s", 1.0),
    ),
    IntensityMeasure(
        "cav", "cumulative absolute velocity", "m/s", 1, lambda m, _: cumulative_absolute_velocity(m),
        symbol="CAV", openquake=("CAV", "g s", 1.0 / g),
    ),
    IntensityMeasure(
        "d5_95", "significant duration 5-95 %", "s", 0, lambda m, _: significant_duration(m), symbol="D5-95",
    ),
    IntensityMeasure(
        "d5_75", "significant duration 5-75 %", "s", 0, lambda m, _: significant_duration(m, 5.0, 75.0),
        symbol="D5-75",
    ),
    IntensityMeasure("housner", "Housner intensity", "m", 1, lambda m, _: housner_intensity(m), symbol="Housner"),
)  # fmt: skip
MEASURES = {one.name: one for one in _NAMED}
"""Every measure that has a name, in the order of a table; a new one is one more entry."""
