"""Functions that return pulses. A pulse has acceleration, velocity and displacement at any time.

`amplitude` is the peak ground acceleration a_p [m/s2]. `period` is the period T_p of the full sinusoid [s], also for
pulses of a half period.
"""

import math
from collections.abc import Callable
from typing import Any

from rocking import checks, plausibility
from rocking.errors import InvalidValueError, UnknownModelError
from rocking.motions.motion import LARGEST_ACCELERATION
from rocking.motions.pulse import Pulse, Ricker, Sinusoids

__all__ = [
    "antisymmetric_ricker",
    "catalogue",
    "cosine",
    "half_cosine",
    "half_sine",
    "harmonic",
    "mavroeidis_papageorgiou",
    "pulse",
    "rectangular",
    "ricker",
    "sine",
    "type_a",
    "type_b",
    "type_c",
]


def rectangular(amplitude: float, duration: float) -> Sinusoids:
    """Return a constant acceleration.

    Parameters
    ----------
    amplitude : float
        Acceleration [m/s2].
    duration : float
        Duration of the pulse [s].

    Returns
    -------
    Sinusoids
        Pulse.

    Examples
    --------
    >>> rectangular(2.0, 0.5).velocity(0.5).item()
    1.0
    """
    amplitude, duration = _amplitude(amplitude), checks.positive("duration", duration, "s")
    return Sinusoids(
        "rectangular pulse",
        ((amplitude, 0.0, 0.5 * math.pi),),
        duration,
        abs(amplitude),
        abs(amplitude),
        duration,
    )


def half_sine(amplitude: float, period: float) -> Sinusoids:
    """Return half a period of a sine: ``a_p sin(2 pi t / T_p)`` up to T_p / 2.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p of the full sine [s].

    Returns
    -------
    Sinusoids
        Pulse.
    """
    return _windowed("half-sine pulse", amplitude, period, 0.0, 0.5)


def sine(amplitude: float, period: float) -> Sinusoids:
    """Return one period of a sine: ``a_p sin(2 pi t / T_p)``.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p [s].

    Returns
    -------
    Sinusoids
        Pulse.

    Examples
    --------
    >>> pulse = sine(amplitude=3.0, period=0.8)
    >>> round(pulse.acceleration(0.2).item(), 12), round(pulse.velocity(0.8).item(), 12)
    (3.0, 0.0)
    """
    return _windowed("sine pulse", amplitude, period, 0.0, 1.0)


def half_cosine(amplitude: float, period: float) -> Sinusoids:
    """Return half a period of a cosine: ``a_p cos(2 pi t / T_p)`` up to T_p / 2.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p of the full cosine [s].

    Returns
    -------
    Sinusoids
        Pulse.
    """
    return _windowed("half-cosine pulse", amplitude, period, 0.5 * math.pi, 0.5)


def cosine(amplitude: float, period: float) -> Sinusoids:
    """Return one period of a cosine: ``a_p cos(2 pi t / T_p)``.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p [s].

    Returns
    -------
    Sinusoids
        Pulse.
    """
    return _windowed("cosine pulse", amplitude, period, 0.5 * math.pi, 1.0)


def type_a(amplitude: float, period: float) -> Sinusoids:
    """Return a forward pulse, type A of Makris and Chang (2000): one sine, with a residual displacement.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p [s].

    Returns
    -------
    Sinusoids
        Pulse.
    """
    return _windowed("type A pulse", amplitude, period, 0.0, 1.0)


def type_b(amplitude: float, period: float) -> Sinusoids:
    """Return a forward-and-back pulse, type B of Makris and Chang (2000): one cosine, without residual displacement.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p [s].

    Returns
    -------
    Sinusoids
        Pulse.
    """
    return _windowed("type B pulse", amplitude, period, 0.5 * math.pi, 1.0)


def type_c(amplitude: float, period: float, n: int = 1) -> Sinusoids:
    """Return a pulse of n main cycles in displacement, type C_n of Makris and Chang (2000).

    The acceleration is ``a_p cos(2 pi t / T_p + phi)`` up to ``(n + 1/2 - phi / pi) T_p``. The phase phi gives zero
    velocity and displacement at the end: ``cos[(2n + 1) pi - phi] + [(2n + 1) pi - 2 phi] sin phi - cos phi = 0``.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p [s].
    n : int
        Number of cycles, from 1.

    Returns
    -------
    Sinusoids
        Pulse.
    """
    n = checks.whole("n", n, 1, 1000)
    phase = _closing_phase(n)
    return _windowed(f"type C{n} pulse", amplitude, period, 0.5 * math.pi + phase, n + 0.5 - phase / math.pi)


def ricker(amplitude: float, period: float) -> Ricker:
    """Return the symmetric Ricker wavelet, the second derivative of a Gaussian.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p [s].

    Returns
    -------
    Ricker
        Wavelet with its middle at 2 T_p.
    """
    return Ricker(_amplitude(amplitude), _period(period), "symmetric")


def antisymmetric_ricker(amplitude: float, period: float) -> Ricker:
    """Return the antisymmetric Ricker wavelet, the third derivative of a Gaussian.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p [s].

    Returns
    -------
    Ricker
        Wavelet with its middle at 2.5 T_p.
    """
    return Ricker(_amplitude(amplitude), _period(period), "antisymmetric")


def mavroeidis_papageorgiou(velocity: float, period: float, cycles: float = 1.5, phase: float = 0.0) -> Sinusoids:
    """Return the near-fault pulse of Mavroeidis and Papageorgiou (2003), BSSA 93:1099, DOI 10.1785/0120020100.

    The velocity is ``(A / 2) [1 + cos(2 pi f t / gamma)] cos(2 pi f t + nu)`` for ``|t| <= gamma / (2 f)``. The time
    of the returned pulse is zero at its start.

    Parameters
    ----------
    velocity : float
        Amplitude A of the velocity [m/s].
    period : float
        Prevailing period 1 / f [s].
    cycles : float
        Number gamma of zero crossings of the velocity, at least 1 [-].
    phase : float
        Phase nu: 0 for a symmetric, pi / 2 for an antisymmetric velocity [rad].

    Returns
    -------
    Sinusoids
        Pulse.
    """
    velocity, period = checks.number("velocity", velocity, "m/s"), _period(period)
    cycles = checks.within("cycles", cycles, 1.0, 1000.0)
    phase = checks.number("phase", phase, "rad")
    main = 2.0 * math.pi / period
    # the product of cosines is written as a sum of three; the start of the pulse, t = -gamma / (2 f), is time zero
    waves = tuple(
        (-weight * frequency, frequency, phase - frequency * 0.5 * cycles * period)  # Eq. 159
        for weight, frequency in ((0.5, main), (0.25, main * (1.0 + 1.0 / cycles)), (0.25, main * (1.0 - 1.0 / cycles)))
    )
    shape = "Mavroeidis-Papageorgiou pulse"
    # computed with 1 m/s first, so that a very large velocity causes no overflow
    most = LARGEST_ACCELERATION / _largest(Sinusoids(shape, waves, cycles * period, 0.0, 0.0, period))
    velocity = checks.within("velocity", velocity, -most, most, unit="m/s", hint="the acceleration would pass 1e6 m/s2")
    scaled = tuple((velocity * amplitude, frequency, phase) for amplitude, frequency, phase in waves)
    largest = abs(velocity) / most * LARGEST_ACCELERATION
    return Sinusoids(shape, scaled, cycles * period, largest, abs(velocity), period, "m/s")


def harmonic(amplitude: float, period: float, cycles: float, phase: float = 0.0) -> Sinusoids:
    """Return many periods of a sine: ``a_p sin(2 pi t / T_p + phase)``.

    Parameters
    ----------
    amplitude, period : float
        Peak acceleration a_p [m/s2] and period T_p [s].
    cycles : float
        Number of periods, at least one half [-].
    phase : float
        Phase at time zero [rad].

    Returns
    -------
    Sinusoids
        Pulse.
    """
    cycles = checks.within("cycles", cycles, 0.5, 1e5)
    return _windowed("harmonic motion", amplitude, period, checks.number("phase", phase, "rad"), cycles)


def catalogue() -> dict[str, Callable[..., Pulse]]:
    """Return the functions of all pulses by their names on the command line.

    Returns
    -------
    dict of str to callable
        Functions by name.

    Examples
    --------
    >>> sorted(catalogue())[:3]
    ['antisymmetric-ricker', 'cosine', 'half-cosine']
    """
    return {function.__name__.replace("_", "-"): function for function in _ALL}


def pulse(text: str) -> Pulse:
    """Return a pulse from a text, as on the command line.

    Parameters
    ----------
    text : str
        Text ``name:parameter=value,parameter=value``. Values may have units: m/s2, cm/s2, mm/s2, gal or g for an
        amplitude, s or ms for a time, m/s, cm/s or mm/s for a velocity, rad or deg for a phase.

    Returns
    -------
    Pulse
        Pulse.

    Raises
    ------
    UnknownModelError
        If the pulse or a parameter is unknown, or a parameter is missing.
    InvalidValueError
        If `text` is not a string, or a value is not a number in its range.

    Examples
    --------
    >>> pulse("sine:amplitude=3,period=0.8").duration
    0.8
    >>> pulse("sine:amplitude=0.3g,period=800ms").peak
    2.941995
    """
    value: object = text
    if not isinstance(text, str):
        raise InvalidValueError(
            "{parameter} must be a text such as sine:amplitude=3,period=0.8, got {value}",
            parameter="text",
            value=text,
        )
    name, _, tail = text.partition(":")
    functions = catalogue()
    name = checks.spelling(name, functions)
    if name not in functions:
        raise UnknownModelError(
            "unknown pulse {name!r}; allowed are {names}", name=name, names=", ".join(sorted(functions)),
            hint=checks.nearest(name, functions),
        )  # fmt: skip
    values: dict[str, Any] = {}
    for item in filter(None, tail.split(",")):
        key, equals, value = (text.strip() for text in item.partition("="))
        if not equals or key in values:
            raise UnknownModelError(
                "write a pulse as sine:amplitude=3,period=0.8, got {pulse!r}", pulse=text,
                hint=checks.number_hint(text),
            )  # fmt: skip
        values[key] = whole_or_number(key, value)
    try:
        return functions[name](**values)
    except TypeError as error:
        names = ", ".join(key for key in functions[name].__annotations__ if key != "return")
        raise UnknownModelError(
            "pulse {name!r} requires {names}; got {stated}", name=name, names=names, stated=", ".join(values) or "none"
        ) from error


UNITS_OF = {"amplitude": "m/s2", "period": "s", "duration": "s", "velocity": "m/s", "phase": "rad"}
"""Units of the parameters of pulses. Other parameters are dimensionless."""


def whole_or_number(key: str, text: str) -> float:
    """Return the value of a parameter in its SI unit from a text with or without unit. n is a whole number."""
    value = checks.quantity(key, text, UNITS_OF.get(key, "1"))[0]
    return int(value) if key == "n" and value.is_integer() else value


_ALL: tuple[Callable[..., Pulse], ...] = (
    rectangular,
    half_sine,
    sine,
    half_cosine,
    cosine,
    type_a,
    type_b,
    type_c,
    ricker,
    antisymmetric_ricker,
    mavroeidis_papageorgiou,
    harmonic,
)


def _windowed(shape: str, amplitude: float, period: float, phase: float, cycles: float) -> Sinusoids:
    amplitude, period = _amplitude(amplitude), _period(period)
    waves, peak = ((amplitude, 2.0 * math.pi / period, phase),), abs(amplitude)
    return Sinusoids(shape, waves, cycles * period, peak, peak, period)


def _amplitude(value: Any) -> float:
    amplitude = checks.within("amplitude", value, -LARGEST_ACCELERATION, LARGEST_ACCELERATION, unit="m/s2")
    plausibility.warn(plausibility.of_acceleration(abs(amplitude)))
    return amplitude


def _period(value: Any) -> float:
    period = checks.within("period", value, 1e-6, 1e6, unit="s")
    plausibility.warn(plausibility.of_period(period))
    return period


def _closing_phase(n: int) -> float:
    turns = (2 * n + 1) * math.pi

    def gap(phase: float) -> float:
        return math.cos(turns - phase) + (turns - 2.0 * phase) * math.sin(phase) - math.cos(phase)  # Eq. 158

    low, high = 0.0, 0.25 * math.pi
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if gap(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)


def _largest(pulse: Sinusoids) -> float:
    """Return the largest acceleration, from a time grid that is refined around the maximum."""
    import numpy as np

    times = np.linspace(0.0, pulse.duration, 4096 + 1)
    size = np.abs(pulse.acceleration(times))
    k = int(size.argmax())
    if not 0 < k < size.size - 1:
        return float(size[k])
    fine = np.linspace(times[k - 1], times[k + 1], 4096 + 1)
    return float(np.abs(pulse.acceleration(fine)).max())
