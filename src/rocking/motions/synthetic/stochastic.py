"""Fully nonstationary motions after Rezaeian and Der Kiureghian (2008, 2010): filtered, modulated white noise."""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.filters import NEIGHBOURS, cosine_sine, exponential, highpassed, logarithm, resonances
from rocking.motions.motion import GroundMotion
from rocking.motions.synthetic.sampling import described, normals, times

MIDDLE = 0.45  # fraction of the Arias intensity at the middle of the strong motion (Rezaeian & Der Kiureghian 2010)

WIDEST, NARROWEST = 1.0, 1e4
"""Allowed shape parameters of the gamma distribution of the energy."""

FORGOTTEN = 27.0  # length of an impulse response in decay times; exp(-27) = 2e-12
SPACING = 0.05  # frequency spacing of the oscillators divided by the slowest decay rate [-]


@dataclass(frozen=True)
class GammaModulation:
    """Standard deviation of the acceleration, ``q(t) = a1 t^(a2 - 1) exp(-a3 t)``.

    Parameters
    ----------
    a1 : float
        Amplitude [m/s2 over s^(a2 - 1)].
    a2 : float
        Shape, at least 1 [-].
    a3 : float
        Decay [1/s].

    Examples
    --------
    >>> GammaModulation(a1=math.e, a2=2.0, a3=1.0)(np.array([0.0, 1.0])).round(12).tolist()
    [0.0, 1.0]
    """

    a1: float
    a2: float
    a3: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "a1", checks.positive("a1", self.a1, "m/s2"))
        object.__setattr__(self, "a2", checks.within("a2", self.a2, 1.0, 0.5 * (1.0 + NARROWEST)))
        object.__setattr__(self, "a3", checks.positive("a3", self.a3, "1/s"))

    def __call__(self, time: FloatArray) -> FloatArray:
        """Return the standard deviation at times >= 0 [m/s2]."""
        # the logarithm avoids an overflow of the power
        grown = (self.a2 - 1.0) * logarithm(time) if self.a2 > 1.0 else np.zeros_like(time)
        return exponential(logarithm(np.array(self.a1)) + grown - self.a3 * time)  # Eq. 169

    def arias_intensity(self, gravity: float = g) -> float:
        """Return the expected Arias intensity of the motion.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        float
            Arias intensity [m/s].
        """
        gravity = checks.positive("gravity", gravity, "m/s2")
        shape, rate = 2.0 * self.a2 - 1.0, 2.0 * self.a3
        energy = 2.0 * math.log(self.a1) + math.lgamma(shape) - shape * math.log(rate)  # Eq. 170
        return 0.5 * math.pi / gravity * math.exp(energy)

    def time_of(self, share: float) -> float:
        """Return the time of a fraction of the expected Arias intensity.

        Parameters
        ----------
        share : float
            Fraction, between 0 and 1 [-].

        Returns
        -------
        float
            Time [s].
        """
        share = checks.within("share", share, 0.0, 1.0, open_high=True, hint="not a percentage")
        return _quantile(2.0 * self.a2 - 1.0, share) / (2.0 * self.a3)


def modulation_from_intensity(
    arias_intensity: float, significant_duration: float, middle: float, gravity: float = g
) -> GammaModulation:
    """Return the gamma modulation with a given intensity, duration and middle.

    The squared modulation is a gamma distribution with shape ``2 a2 - 1`` and rate ``2 a3``. The ratio of duration to
    middle depends only on the shape. The shape is computed from this ratio.

    Parameters
    ----------
    arias_intensity : float
        Expected Arias intensity [m/s].
    significant_duration : float
        Duration between 5 and 95 % of the Arias intensity [s].
    middle : float
        Time of 45 % of the Arias intensity [s].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    GammaModulation
        Modulation with these values.

    Raises
    ------
    InvalidValueError
        If no gamma modulation has this ratio of duration to middle.

    Examples
    --------
    >>> q = modulation_from_intensity(1.0, significant_duration=10.0, middle=8.0)
    >>> round(q.arias_intensity(), 9), round(q.time_of(0.95) - q.time_of(0.05), 9), round(q.time_of(0.45), 9)
    (1.0, 10.0, 8.0)
    """
    from scipy.optimize import brentq

    intensity = checks.positive("arias_intensity", arias_intensity, "m/s")
    duration = checks.positive("significant_duration", significant_duration, "s")
    middle = checks.positive("middle", middle, "s")
    gravity = checks.positive("gravity", gravity, "m/s2")
    ratio = duration / middle
    low, high = _ratio(NARROWEST), _ratio(WIDEST)
    if not low <= ratio <= high:
        raise InvalidValueError(
            "significant_duration / middle must be in [{low:.4g}, {high:.4g}], got "
            "{ratio:.4g}; enter the middle as a time from the start of the motion",
            low=low,
            high=high,
            ratio=ratio,
        )
    # rounding errors are possible at the bounds
    log_shape = (
        0.0
        if ratio == high
        else float(brentq(lambda x: _ratio(math.exp(x)) - ratio, math.log(WIDEST), math.log(NARROWEST), xtol=1e-14))
    )
    # rounded to eleven and twelve digits, because further digits depend on the C library
    shape = float(f"{math.exp(log_shape):.11g}")
    rate = float(f"{_quantile(shape, MIDDLE) / middle:.11g}")
    energy = 2.0 * gravity * intensity / math.pi
    size = math.exp(0.5 * (math.log(energy) + shape * math.log(rate) - math.lgamma(shape)))  # Eq. 170
    return GammaModulation(float(f"{size:.12g}"), 0.5 * (shape + 1.0), 0.5 * rate)


@dataclass(frozen=True)
class NonstationaryFilter:
    """Filter of the noise: an oscillator with a drifting frequency.

    The defaults are examples that are typical for firm ground. They are not a prediction for a site.

    Parameters
    ----------
    frequency : float
        Frequency at the middle time [Hz].
    slope : float
        Change of the frequency with time [Hz/s].
    middle : float
        Time of the frequency `frequency` [s].
    damping : float
        Damping ratio, between 0 and 1 [-]. A small ratio gives a narrow band.
    lowest : float
        Lower limit of the drifting frequency [Hz].
    """

    frequency: float = 6.0
    slope: float = -0.1
    middle: float = 8.0
    damping: float = 0.3
    lowest: float = 0.3

    def __post_init__(self) -> None:
        object.__setattr__(self, "frequency", checks.positive("frequency", self.frequency, "Hz"))
        object.__setattr__(self, "slope", checks.number("slope", self.slope, "Hz/s"))
        object.__setattr__(self, "middle", checks.within("middle", self.middle, 0.0, math.inf, unit="s"))
        damping = checks.within("damping", self.damping, 0.0, 1.0, open_low=True, open_high=True)
        object.__setattr__(self, "damping", damping)
        object.__setattr__(self, "lowest", checks.within("lowest", self.lowest, 0.0, self.frequency, open_low=True))

    def omega(self, time: FloatArray) -> FloatArray:
        """Return the circular frequency at given times.

        Parameters
        ----------
        time : ndarray
            Times [s].

        Returns
        -------
        ndarray
            Circular frequency [rad/s].
        """
        return 2.0 * np.pi * np.maximum(self.frequency + self.slope * (time - self.middle), self.lowest)  # Eq. 171


def nonstationary_motion(
    modulation: GammaModulation,
    shaper: NonstationaryFilter,
    *,
    seed: int,
    time_step: float = 0.01,
    duration: float = 40.0,
    corner: float | None = 0.1,
) -> GroundMotion:
    """Return one synthetic motion.

    Before the high pass, the standard deviation of the motion equals `modulation` at every sample except the first,
    which is zero.

    Parameters
    ----------
    modulation : GammaModulation
        Standard deviation over time, for example from `modulation_from_intensity`.
    shaper : NonstationaryFilter
        Frequency and bandwidth over time.
    seed : int
        Random seed; equal seeds give equal bits [-].
    time_step : float
        Time step between samples [s].
    duration : float
        Duration of the motion [s].
    corner : float or None
        Frequency of the critically damped high pass [Hz], which brings velocity and displacement back to zero. None for
        no high pass.

    Returns
    -------
    GroundMotion
        Motion with its parameters as metadata.

    Raises
    ------
    InvalidValueError
        If a parameter is outside its range, or the filter frequency exceeds the Nyquist frequency.

    Examples
    --------
    >>> modulation = GammaModulation(a1=0.5, a2=2.0, a3=0.3)
    >>> first = nonstationary_motion(modulation, NonstationaryFilter(), seed=1, duration=20.0)
    >>> second = nonstationary_motion(modulation, NonstationaryFilter(), seed=1, duration=20.0)
    >>> bool((first.acceleration == second.acceleration).all())
    True
    """
    time = times(time_step, duration)
    step = float(time[1])
    omega = shaper.omega(time)
    if omega.max() * step >= math.pi:
        raise InvalidValueError(
            "filter frequency must be below {limit:g} Hz for steps of {step:g} s, got {frequency:g} Hz",
            limit=0.5 / step, step=step, frequency=float(omega.max()) / (2.0 * math.pi),
            hint="check the sign of the slope",
        )  # fmt: skip
    noise = normals(seed, time.size)
    acceleration = modulation(time) * _unit_process(noise, omega, shaper.damping, step)
    if corner is not None:
        acceleration = highpassed(acceleration, step, checks.positive("corner", corner, "Hz"))
    parameters = described(
        modulation=modulation, filter=shaper, seed=int(seed), time_step=step, duration=duration, corner=corner
    )
    line = f"simulated: modulated filtered white noise (Rezaeian & Der Kiureghian 2008), seed {seed}"
    return GroundMotion(
        acceleration, step, name=f"synthetic, nonstationary, seed {seed}", metadata=parameters, provenance=(line,)
    )


def _quantile(shape: float, fraction: float) -> float:
    from scipy.special import gammaincinv

    return float(gammaincinv(shape, fraction))


def _ratio(shape: float) -> float:
    return (_quantile(shape, 0.95) - _quantile(shape, 0.05)) / _quantile(shape, MIDDLE)


def _unit_process(noise: FloatArray, omega: FloatArray, damping: float, step: float) -> FloatArray:
    """Return noise after the drifting filter, normalised to variance 1 after the start."""
    # Every impulse excites the oscillator of its own time. The frequency drifts in one direction, so that few
    # oscillators with small spacing are sufficient: polynomials of degree 9 between their responses have errors below
    # 1e-10. If this requires more oscillators than impulses, each impulse has its own oscillator.
    used, count = omega[:-1], noise.size - 1
    spacing = SPACING * damping * float(used.min())
    position, own = np.abs(used - used[0]) / spacing, used
    nodes = int(position.max()) + NEIGHBOURS
    if shared := nodes < count:
        steps = np.arange(nodes, dtype=np.float64) - (NEIGHBOURS - 1) // 2
        own = used[0] + math.copysign(spacing, float(used[-1] - used[0])) * steps
    else:
        position = np.arange(count, dtype=np.float64)
    decay = exponential(-damping * step * own)
    cosine, sine = cosine_sine(math.sqrt(1.0 - damping * damping) * step * own)
    lasting = np.ceil(FORGOTTEN / (damping * step * own))
    total, squares = resonances(noise, omega, position, shared, (decay * cosine, decay * sine), lasting)
    # the response at the first sample is zero
    squares[0] = 2.0
    return total / np.sqrt(0.5 * squares)  # Eq. 172
