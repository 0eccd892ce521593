"""Stochastic point source after Boore (2003): noise with the spectrum of a distant source."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.filters import exponential, logarithm
from rocking.motions.motion import GroundMotion
from rocking.motions.synthetic.sampling import described, normals, times

REFERENCE_DISTANCE = 1000.0  # distance of the source spectrum [m]

PEAK_AT, LEVEL_AT_END, STRETCH = 0.2, 0.05, 2.0
"""Parameters of the window: position of the peak, level at the end, and length / duration of the motion."""


@dataclass(frozen=True)
class PointSource:
    """Source, path and site of a stochastic point-source motion.

    The defaults are examples. They are typical for western North America, without site amplification.

    Parameters
    ----------
    magnitude : float
        Moment magnitude, from 0 to 10 [-].
    distance : float
        Distance to the source, at least 1 km [m].
    stress_drop : float
        Stress parameter [Pa].
    shear_velocity : float
        Shear-wave velocity at the source [m/s].
    density : float
        Density at the source [kg/m3].
    radiation : float
        Average radiation pattern [-].
    free_surface : float
        Amplification by the free surface [-].
    partition : float
        Partition onto one of two horizontal components [-].
    spreading : tuple of (float, float)
        Segments of the geometric spreading: start distance [m] and exponent. The first segment starts at 1 km, with
        the factor 1.
    quality : tuple of (float, float)
        Q0 and n of ``Q(f) = Q0 (f / 1 Hz)^n`` [-].
    kappa : float
        Attenuation close to the site [s].
    path_duration : float
        Increase of the duration with distance [s/m].

    Examples
    --------
    >>> source = PointSource(magnitude=6.0, distance=20e3)
    >>> f"{source.moment:.4g} N m, {source.corner_frequency:.3f} Hz"
    '1.122e+18 N m, 0.330 Hz'
    """

    magnitude: float
    distance: float
    stress_drop: float = 8e6
    shear_velocity: float = 3500.0
    density: float = 2800.0
    radiation: float = 0.55
    free_surface: float = 2.0
    partition: float = math.sqrt(0.5)
    spreading: tuple[tuple[float, float], ...] = ((REFERENCE_DISTANCE, -1.0), (40e3, -0.5))
    quality: tuple[float, float] = (180.0, 0.45)
    kappa: float = 0.04
    path_duration: float = 5e-5

    def __post_init__(self) -> None:
        checks.within("magnitude", self.magnitude, 0.0, 10.0)
        checks.within("distance", self.distance, REFERENCE_DISTANCE, 2e7, unit="m", hint="enter metres, not km")
        checks.within("stress_drop", self.stress_drop, 1e3, 1e9, unit="Pa", hint="1 bar is 1e5 Pa")
        checks.within("shear_velocity", self.shear_velocity, 100.0, 1e4, unit="m/s", hint="enter m/s, not km/s")
        checks.within("density", self.density, 500.0, 1e4, unit="kg/m3", hint="enter kg/m3, not g/cm3")
        for name in ("radiation", "free_surface", "partition"):
            checks.positive(name, getattr(self, name))
        q0, power = _pairs("quality", (self.quality,))[0]
        checks.positive("quality[0]", q0)
        checks.within("quality[1]", power, -2.0, 1.0)
        checks.within("kappa", self.kappa, 0.0, 1.0, unit="s")
        checks.within("path_duration", self.path_duration, 0.0, 1.0, unit="s/m", hint="enter s/m, not s/km")
        starts, exponents = _pairs("spreading", self.spreading).T
        if starts[0] != REFERENCE_DISTANCE or not np.all(np.diff(starts) > 0.0):
            raise InvalidValueError(
                "{parameter} must start at 1000 m with increasing distances, got {distances} m", parameter="spreading",
                distances=str(starts),
            )  # fmt: skip
        for exponent in exponents:
            checks.within("spreading exponent", exponent, -5.0, 5.0)

    @cached_property
    def moment(self) -> float:
        """Seismic moment, ``10^(1.5 M + 16.05)`` dyn cm [N m]."""
        return float(_power(np.array(10.0), 1.5 * self.magnitude + 16.05 - 7.0))  # Eq. 173

    @cached_property
    def corner_frequency(self) -> float:
        """Corner frequency, ``4.9e6 beta (stress / M0)^(1/3)`` in km/s, bar and dyn cm [Hz]."""
        # Eq. 174
        return float(0.49 * self.shear_velocity * _power(np.array(self.stress_drop / self.moment), 1.0 / 3.0))

    @property
    def duration(self) -> float:
        """Duration of source and path [s]."""
        return 1.0 / self.corner_frequency + self.path_duration * self.distance  # Eq. 175

    def geometric_spreading(self) -> float:
        """Return the factor of geometric spreading at the distance.

        Returns
        -------
        float
            Factor, 1 at 1 km [-].
        """
        starts = [start for start, _ in self.spreading]
        factor = 1.0
        for (start, exponent), end in zip(self.spreading, [*starts[1:], math.inf], strict=True):
            factor *= float(_power(np.array(max(min(self.distance, end) / start, 1.0)), exponent))
        return factor

    def amplitude(self, frequency: FloatArray) -> FloatArray:
        """Return the Fourier amplitude of the acceleration.

        Parameters
        ----------
        frequency : ndarray
            Frequencies, at least zero [Hz].

        Returns
        -------
        ndarray
            Amplitude [m/s].
        """
        beta = self.shear_velocity
        constant = self.radiation * self.partition * self.free_surface
        constant /= 4.0 * math.pi * self.density * beta**3 * REFERENCE_DISTANCE
        source = (2.0 * np.pi * frequency) ** 2 / (1.0 + (frequency / self.corner_frequency) ** 2)
        # f / Q(f), computed without division by zero at zero frequency
        path = _power(frequency, 1.0 - self.quality[1]) * self.distance / (self.quality[0] * beta)
        loss = exponential(-np.pi * (path + self.kappa * frequency))
        return np.asarray(constant * self.moment * self.geometric_spreading() * source * loss)  # Eq. 176


def point_source_motion(
    source: PointSource, *, seed: int, time_step: float = 0.01, duration: float | None = None
) -> GroundMotion:
    """Return one synthetic motion.

    The spectrum of windowed white noise is divided by its root mean square and multiplied by the spectrum of the
    source. The window begins one source duration ``1 / fc`` after the start.

    Parameters
    ----------
    source : PointSource
        Source, path and site parameters.
    seed : int
        Random seed; equal seeds give equal bits [-].
    time_step : float
        Time step between samples [s].
    duration : float, optional
        Duration [s]. The default is the length of the window plus ``1 / fc`` before and after the window.

    Returns
    -------
    GroundMotion
        Motion with its parameters as metadata.

    Raises
    ------
    InvalidValueError
        If the duration is shorter than the window, or the time step is too long for the corner frequency.

    Examples
    --------
    >>> motion = point_source_motion(PointSource(magnitude=5.0, distance=10e3), seed=3)
    >>> 0.1 < motion.peak < 10.0
    True
    """
    from scipy.fft import next_fast_len

    lead, length = 1.0 / source.corner_frequency, STRETCH * source.duration
    if duration is None:
        duration = 2.0 * lead + length
    elif checks.positive("duration", duration, "s") < lead + length:
        raise InvalidValueError(
            "duration must be at least {limit:g} s for this source, got {duration:g}",
            limit=lead + length,
            duration=duration,
        )
    time = times(time_step, duration)
    step = float(time[1])
    if source.corner_frequency * step >= 0.5:
        raise InvalidValueError(
            "{parameter} must be below {limit:g} s for this source, got {value}", parameter="time_step", value=step,
            limit=0.5 * lead,
        )  # fmt: skip
    noise = normals(seed, time.size) * window((time - lead) / length)
    # zero padding to an efficient transform length
    size = next_fast_len(time.size, real=True)
    spectrum = np.fft.rfft(noise, size)
    spread = math.sqrt(float(np.mean(spectrum.real**2 + spectrum.imag**2)))
    target = source.amplitude(np.arange(spectrum.size, dtype=np.float64) / (size * step)) / (spread * step)
    # real products are used, because the rounding of complex products depends on the processor
    spectrum.real *= target
    spectrum.imag *= target
    acceleration = np.fft.irfft(spectrum, size)[: time.size]
    parameters = described(source=source, seed=int(seed), time_step=step, duration=duration)
    line = f"simulated: stochastic point source (Boore 2003), seed {seed}"
    return GroundMotion(
        acceleration, step, name=f"synthetic, point source, seed {seed}", metadata=parameters, provenance=(line,)
    )


def window(position: FloatArray) -> FloatArray:
    """Return the Saragoni-Hart window of Boore: 0 before the start, 1 at 0.2 of its length, 0.05 at its end."""
    power = -PEAK_AT * math.log(LEVEL_AT_END) / (1.0 + PEAK_AT * (math.log(PEAK_AT) - 1.0))
    ratio = np.maximum(position, 0.0) / PEAK_AT
    return exponential(power * (logarithm(ratio) + 1.0 - ratio))  # Eq. 177


def _power(base: FloatArray, exponent: float) -> FloatArray:
    # 0 to the power 0 is 1
    return exponential(exponent * logarithm(base)) if exponent else np.ones_like(base)


def _pairs(name: str, values: Any) -> FloatArray:
    pairs = checks.real_array(name, values)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise InvalidValueError(
            "{parameter} must contain pairs of numbers, got shape {shape}", parameter=name, shape=pairs.shape
        )
    return pairs
