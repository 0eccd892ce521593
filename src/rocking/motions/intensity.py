"""Intensity measures of motions, by the usual definitions.

Energies and areas use the trapezoidal rule over the samples. Velocities and spectra use straight lines between the
samples, as in simulations. To add a measure to `rocking record show`, fragility, scaling, plots and files for
OpenQuake, an entry in `MEASURES` is sufficient.
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
"""Samples per shortest period of a pulse. Relative errors are below 1e-6, and the PGA is exact."""

_NUMBER = r"\s*(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+)\s*"
_SPECTRAL = re.compile(rf"sa\({_NUMBER}(?:,{_NUMBER})?\)")


@dataclass(frozen=True)
class Measure:
    """One intensity measure of one motion.

    Parameters
    ----------
    name : str
        Full name.
    value : float
        Value in `unit`.
    unit : str
        SI unit; ``-`` if dimensionless.
    """

    name: str
    value: float
    unit: str


def peak_ground_acceleration(motion: GroundMotion) -> float:
    """Return the peak ground acceleration PGA, the largest magnitude of a sample.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.

    Returns
    -------
    float
        PGA [m/s2].
    """
    return checked_motion(motion).peak


def cumulative_absolute_velocity(motion: GroundMotion) -> float:
    """Return the cumulative absolute velocity CAV, the integral of the magnitude of the acceleration.

    EPRI (1988), report NP-5930. For strong-motion records, the trapezoidal rule over the magnitudes of the samples is
    within 0.5 % of the band-limited signal.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.

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
        Motion. Only the horizontal part is used.
    damping : float
        Damping ratio, from 0 to below 1 [-].

    Returns
    -------
    float
        Spectrum intensity, by the trapezoidal rule with 0.01 s [m].
    """
    pseudo = response_spectrum(motion, HOUSNER_PERIODS, damping).pseudo_velocity
    return trapezoid(pseudo, np.diff(HOUSNER_PERIODS))  # Eq. 144


def spectral_acceleration(motion: GroundMotion, period: float, damping: float = 0.05) -> float:
    """Return the pseudo-spectral acceleration PSA at one period.

    Ground-motion models predict PSA. (`response_spectrum` also returns the absolute acceleration.)

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.
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
    """Return PGA over ``g tan(alpha)``: a body at rest rocks if the ratio is above 1.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.
    slenderness_angle : float
        Angle alpha of the body, between 0 and pi/2 [rad].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float
        Ratio [-].
    """
    return peak_ground_acceleration(motion) / _threshold(slenderness_angle, gravity)  # Eq. 145


def normalised_velocity(
    motion: GroundMotion, slenderness_angle: float, frequency_parameter: float, gravity: float = g
) -> float:
    """Return ``p PGV / (g tan(alpha))``, a velocity measure that depends on the size of the body.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.
    slenderness_angle : float
        Angle alpha of the body, between 0 and pi/2 [rad].
    frequency_parameter : float
        Frequency parameter p of the body [rad/s].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float
        Ratio [-].
    """
    p = checks.positive("frequency_parameter", frequency_parameter, "rad/s")
    return p * peak_ground_velocity(motion) / _threshold(slenderness_angle, gravity)  # Eq. 146


def intensity_measures(motion: GroundMotion) -> dict[str, Measure]:
    """Return the intensity measures that are independent of a body.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used. A motion of zeros raises an error, because it has no duration.

    Returns
    -------
    dict of str to Measure
        Measures by short name, in the order of tables.

    Examples
    --------
    >>> intensity_measures(GroundMotion([0.0, 1.0, -1.0, 0.0], 0.1))["pga"]
    Measure(name='peak ground acceleration', value=1.0, unit='m/s2')
    """
    listed = [item for item in MEASURES.values() if item.is_listed and not item.needs_body]
    return {item.name: Measure(item.description, item.of(motion), item.unit) for item in listed}


def key_with_unit(name: str, unit: str) -> str:
    """Return a name with its unit, as in JSON keys.

    >>> key_with_unit("pgv", "m/s"), key_with_unit("pga/(g tan alpha)", "-")
    ('pgv_m_s', 'pga/(g tan alpha)')
    """
    return name if unit == "-" else f"{name}_{unit.replace('/', '_')}"


def _threshold(slenderness_angle: float, gravity: float) -> float:
    """Return the ground acceleration at uplift [m/s2]."""
    alpha = checks.within(
        "slenderness_angle", slenderness_angle, 0.0, 0.5 * math.pi, unit="rad", open_low=True, open_high=True
    )
    return checks.positive("gravity", gravity, "m/s2") * math.tan(alpha)  # Eq. 25


@dataclass(frozen=True)
class RockingScale:
    """Quantities of a body for dimensionless measures. Without a body, only gravity.

    Parameters
    ----------
    threshold : float
        Uplift acceleration: g tan(alpha), or g alpha of the slender-linear equations [m/s2].
    frequency_parameter : float
        p of the side with the smallest uplift acceleration [rad/s].
    gravity : float
        Acceleration of gravity [m/s2].
    """

    threshold: float = math.nan
    frequency_parameter: float = math.nan
    gravity: float = g


@dataclass(frozen=True)
class IntensityMeasure:
    """An intensity measure of motions.

    Parameters
    ----------
    name : str
        Short name.
    description : str
        Full name.
    unit : str
        SI unit; ``-`` if dimensionless.
    power : int
        Exponent of a factor on the motion: 1, 2 (Arias intensity) or 0 (ratios and durations).
    of_motion : callable
        Function of a record and a `RockingScale`; returns the value.
    symbol : str
        Symbol. If empty, the name.
    needs_body : bool
        True if the measure requires a body.
    is_listed : bool
        True if tables of motions contain the measure. These tables omit ratios of other rows.
    openquake : tuple of str, str and float, optional
        Name and unit in OpenQuake, and the value of one SI unit in this unit. None if OpenQuake has no such measure.
    uplift : callable, optional
        Function of a `RockingScale` that returns the value of the measure at uplift of a body with equal sides. None if
        this value depends on the motion.

    Examples
    --------
    >>> MEASURES["pga"].of(GroundMotion([0.0, 1.0, -2.0], 0.1))
    2.0
    """

    name: str
    description: str
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
            Motion. Only the horizontal part is used.
        body : RockingScale, optional
            Quantities of the body; required if `needs_body`.

        Returns
        -------
        float
            Value [unit of the measure].
        """
        if self.needs_body and body is None:
            raise InvalidValueError("{measure} requires a body", measure=self.name)
        return self.of_motion(motion, body or RockingScale())

    @property
    def key(self) -> str:
        """Name and unit, as in JSON keys, such as ``pga_m_s2``."""
        return key_with_unit(self.name, self.unit)

    def values(self, motions: Any, body: RockingScale) -> FloatArray:
        """Return the measure of every motion. All values must be finite and above zero.

        Parameters
        ----------
        motions : MotionSet
            Records or pulses. If there are several components, the leading component is used.
        body : RockingScale
            Quantities of the body.

        Returns
        -------
        ndarray
            One value per motion [unit of the measure].
        """
        records = (sampled(leading(motions[k])) for k in range(len(motions)))
        results = (self.of_motion(motion, body) if motion.peak > 0.0 else 0.0 for motion in records)
        values = np.fromiter(results, np.float64, len(motions))
        bad = np.flatnonzero(~((values > 0.0) & np.isfinite(values)))
        if bad.size:
            raise InvalidValueError(
                "{name} of every motion must be finite and > 0 {unit}, got {size:g} of motion "
                "{index}, {motion}; check for a record of zeros",
                name=self.name,
                unit=self.unit,
                size=values[bad[0]],
                index=bad[0],
                motion=f"{motions[int(bad[0])].name!r:.60}",
            )
        return values

    def scaled(self, values: FloatArray, factor: Any) -> FloatArray:
        """Return the intensity measure of the scaled motions.

        Parameters
        ----------
        values : ndarray
            Values of the unscaled motions [unit of the measure].
        factor : float or array_like
            Factor on the motions [-].

        Returns
        -------
        ndarray
            Values of the scaled motions [unit of the measure].

        Examples
        --------
        >>> measure("arias").scaled(np.array([1.5]), 2.0).tolist()
        [6.0]
        """
        return np.asarray(values * np.abs(factor) ** self.power, dtype=np.float64)  # Eq. 229

    def check_grows(self) -> None:
        """Raise an error for a measure of power zero, because no scale factor changes its value."""
        if self.power == 0:
            raise InvalidValueError(
                "{parameter} must grow with the scale factor, got {value}",
                parameter="im", value=self.name, hint='use analysis="cloud"',
            )  # fmt: skip

    def factors(self, values: FloatArray, targets: FloatArray) -> FloatArray:
        """Return the factors that scale every motion to every target. `power` must not be zero.

        Parameters
        ----------
        values : ndarray, shape (motions,)
            Values of the unscaled motions [unit of the measure].
        targets : ndarray, shape (levels,)
            Target values [unit of the measure].

        Returns
        -------
        ndarray, shape (motions, levels)
            Scale factors [-].
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
        Measure named ``sa(period)``, or ``sa(period,damping)`` unless `damping` is 0.05.

    Examples
    --------
    >>> spectral_measure(0.5).name
    'sa(0.5)'
    """
    period = checks.positive("period", period, "s")
    damping = checks.within("damping", damping, 0.0, 1.0, open_high=True, hint="a ratio, not a percentage")
    name = f"sa({period!r})" if damping == 0.05 else f"sa({period!r},{damping!r})"
    description = f"pseudo-spectral acceleration at {period:g} s with {100.0 * damping:g} % damping"
    return IntensityMeasure(
        name, description, "m/s2", 1, lambda m, _: spectral_acceleration(m, period, damping),
        symbol=f"PSA({period:g} s, {damping:g})",
        openquake=(f"SA({period!r})", "g", 1.0 / g) if damping == 0.05 else None,
    )  # fmt: skip


def measures() -> dict[str, IntensityMeasure]:
    """Return the measures with fixed names, without ``sa(period)``.

    Returns
    -------
    dict of str to IntensityMeasure
        Measures by name, in the order of tables.

    Examples
    --------
    >>> list(measures())[:4]
    ['pga', 'pgv', 'pgd', 'pga/(g tan alpha)']
    """
    return dict(MEASURES)


def measure(name: Any, parameter: str = "im") -> IntensityMeasure:
    """Return a measure by its name.

    Parameters
    ----------
    name : str or IntensityMeasure
        A key of `measures`, ``sa(period)`` or ``sa(period,damping)`` [s, -], or another measure.
    parameter : str
        Name of the parameter in the error about an unknown measure.

    Returns
    -------
    IntensityMeasure
        Intensity measure.

    Examples
    --------
    >>> measure("sa(1.0)").description
    'pseudo-spectral acceleration at 1 s with 5 % damping'
    """
    if isinstance(name, IntensityMeasure):
        return name
    if isinstance(name, str):
        if (spelled := checks.spelling(name, MEASURES)) in MEASURES:
            return MEASURES[spelled]
        if spectral := spectral_period(name):
            return spectral_measure(*spectral)
    names, hint = ", ".join(MEASURES), checks.nearest(name, MEASURES)
    raise InvalidValueError(parameter=parameter, allowed=f"one of {names}, or sa(period in s)", value=name, hint=hint)


def spectral_period(name: str) -> tuple[float, float] | None:
    """Return period [s] and damping ratio [-] of a spectral measure from its name; None for other measures."""
    match = _SPECTRAL.fullmatch(name)
    return None if match is None else (float(match[1]), float(match[2] or 0.05))


def exchange_unit(name: str, unit: str) -> tuple[str, float]:
    """Return the unit of a measure for other programs, and the value of one SI unit in this unit.

    The unit is that of OpenQuake for its measures, g for other accelerations, and otherwise the SI unit.

    >>> exchange_unit("pgv", "m/s")
    ('cm/s', 100.0)
    """
    period = spectral_period(name)
    item = MEASURES.get(name) if period is None else spectral_measure(*period)
    if item is not None and item.openquake is not None:
        return item.openquake[1:]
    return ("g", 1.0 / g) if unit == "m/s2" else (unit, 1.0)


def sampled(motion: GroundMotion | Pulse) -> GroundMotion:
    """Return a motion as a record. Measures of a sampled pulse have errors below 1e-6, and its peak is exact."""
    if not isinstance(motion, Pulse):
        return motion
    count = max(200, int(np.ceil(SAMPLES_PER_PERIOD * motion.fastest * motion.duration / (2.0 * np.pi))))
    record = motion.sampled(motion.duration / count)
    samples = np.array(record.acceleration)
    top = int(np.argmax(np.abs(samples)))
    samples[top] = np.copysign(motion.peak, samples[top])
    return record.changed("the largest sample set to the peak of the pulse", acceleration=samples)


_ITEMS = (
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
        "pga/(g tan alpha)", "peak ground acceleration over uplift acceleration", "-", 1,
        lambda m, b: peak_ground_acceleration(m) / b.threshold,  # Eq. 145
        symbol="PGA/(g tan alpha)", needs_body=True, uplift=lambda _: 1.0,
    ),
    IntensityMeasure(
        "p pgv/(g tan alpha)", "peak ground velocity normalised by the body", "-", 1,
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
MEASURES = {item.name: item for item in _ITEMS}
"""Measures with fixed names, in the order of tables."""
