"""Processing of records: correction, resampling, trimming and scaling. Every step adds a line to the provenance."""

import math
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions import intensity
from rocking.motions.filters import cosine_sine
from rocking.motions.integrals import significant_times, velocity_of
from rocking.motions.intensity import RockingScale
from rocking.motions.motion import LONGEST_STEP, SHORTEST_STEP, GroundMotion, checked_motion

ROUNDING = 1e-6  # tolerance of a whole-number ratio of times
MOST_SAMPLES = 100_000_000  # larger numbers result from a wrong unit


def demeaned(motion: GroundMotion) -> GroundMotion:
    """Return the motion without its mean acceleration.

    Parameters
    ----------
    motion : GroundMotion
        Motion. The mean is removed from every component.

    Returns
    -------
    GroundMotion
        Corrected motion.

    Examples
    --------
    >>> demeaned(GroundMotion([1.0, 3.0], 0.1)).acceleration.tolist()
    [-1.0, 1.0]
    """
    motion = checked_motion(motion)
    return _each_component(motion, lambda a: a - a.mean(), "mean acceleration removed")


def detrended(
    motion: GroundMotion, order: int = 1, fit: Literal["velocity", "acceleration"] = "velocity"
) -> GroundMotion:
    """Return the motion without a polynomial trend from least squares.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Every component has its own trend.
    order : int
        Order of the polynomial, from 1 to 3 [-].
    fit : {"velocity", "acceleration"}
        Quantity for the fit. A velocity trend starts from rest, and its derivative is subtracted from the
        acceleration. An acceleration trend has a constant term.

    Returns
    -------
    GroundMotion
        Corrected motion.

    Examples
    --------
    >>> detrended(GroundMotion([2.0, 2.0, 2.0], 0.1)).peak < 1e-12
    True
    """
    motion = checked_motion(motion)
    order, kind = checks.whole("order", order, 1, 3), checks.one_of("fit", fit, ("velocity", "acceleration"))
    if len(motion) < order + 2:
        raise InvalidValueError(
            "a trend of order {order} needs at least {fewest} samples, got {count}", order=order, fewest=order + 2,
            count=len(motion),
        )  # fmt: skip
    action = f"polynomial of order {order} fitted to the {kind} removed"
    return _each_component(motion, lambda a: a - _trend(a, motion.time_step, order, kind), action)


def tapered(motion: GroundMotion, fraction: float = 0.05) -> GroundMotion:
    """Return the motion with a half-cosine taper at both ends.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Both components are tapered.
    fraction : float
        Length of each taper / duration, up to 0.5 [-].

    Returns
    -------
    GroundMotion
        Tapered motion. The first and last samples are zero.

    Examples
    --------
    >>> tapered(GroundMotion([1.0] * 5, 1.0), 0.5).acceleration.round(12).tolist()
    [0.0, 0.5, 1.0, 0.5, 0.0]
    """
    motion = checked_motion(motion)
    fraction = checks.within("fraction", fraction, 0.0, 0.5, open_low=True, hint="fraction of the duration at each end")
    position = np.linspace(0.0, 1.0, len(motion))
    edge = np.minimum(np.minimum(position, 1.0 - position) / fraction, 1.0)
    window = 0.5 * (1.0 - cosine_sine(np.pi * edge)[0])  # Eq. 154
    return _each_component(motion, lambda a: a * window, f"cosine taper over {fraction:g} of each end")


def bandpassed(
    motion: GroundMotion, low: float, high: float, order: int = 4, pads: Literal["cut", "keep"] = "cut"
) -> GroundMotion:
    """Return the motion filtered by a Butterworth band pass, forwards and backwards.

    The two passes cancel the phase shift and square the response, so that the response is 1/2 at both corners. Zeros of
    length 1.5 `order` / `low` are added at both ends before filtering (Converse & Brady 1992).

    Parameters
    ----------
    motion : GroundMotion
        Motion. Both components are filtered.
    low, high : float
        Corner frequencies; `high` is below half the sampling rate [Hz].
    order : int
        Order of one pass, from 1 to 10 [-].
    pads : {"cut", "keep"}
        Treatment of the filtered padding. With "keep", velocity and displacement end at rest; with "cut", the length
        of the motion is unchanged.

    Returns
    -------
    GroundMotion
        Filtered motion.
    """
    motion = checked_motion(motion)
    from scipy.signal import butter, sosfiltfilt

    nyquist = 0.5 / motion.time_step
    low = checks.within("low", low, 0.0, nyquist, unit="Hz", open_low=True, open_high=True)
    high = checks.within(
        "high", high, low, nyquist, unit="Hz", open_low=True, open_high=True, hint="low < high < Nyquist"
    )
    order = checks.whole("order", order, 1, 10)
    keep = checks.one_of("pads", pads, ("cut", "keep")) == "keep"
    sections: Any = butter(order, [low, high], btype="bandpass", fs=1.0 / motion.time_step, output="sos")
    pad = math.ceil(1.5 * order / low / motion.time_step)  # Eq. 155

    def filtered(samples: FloatArray) -> FloatArray:
        result: Any = sosfiltfilt(sections, np.pad(samples, pad), padtype=None)
        return np.asarray(result if keep else result[pad:-pad], dtype=np.float64)

    action = f"band-pass {low:g} to {high:g} Hz, Butterworth order {order}, forwards and backwards"
    action += f", with pads of {pad * motion.time_step:g} s kept at both ends" if keep else ""
    return _moved(_each_component(motion, filtered, action), -pad * motion.time_step if keep else 0.0)


def resampled(motion: GroundMotion, time_step: float) -> GroundMotion:
    """Return the motion at another time step.

    A finer step of any ratio interpolates linearly between the samples, so that every new sample is exact. If the ratio
    is a whole number, simulations do not change, but the Arias intensity decreases to the Arias intensity of the linear
    interpolation. A coarser step must be an integer multiple of the time step of the motion. For a coarser step, a
    linear-phase low pass (Hamming window, 10 taps per multiple on each side, no shift) first removes the frequencies
    above the new Nyquist frequency.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Both components are resampled.
    time_step : float
        New time step [s].

    Returns
    -------
    GroundMotion
        Resampled motion. If the last sample is between two new samples, a zero is added one step later.

    Raises
    ------
    InvalidValueError
        If the time step is coarser and not an integer multiple, or leaves fewer than two or too many samples.

    Examples
    --------
    >>> resampled(GroundMotion([0.0, 1.0], 0.1), 0.05).acceleration.tolist()
    [0.0, 0.5, 1.0]
    """
    motion = checked_motion(motion)
    new = checks.within("time_step", time_step, SHORTEST_STEP, LONGEST_STEP, unit="s", hint="in seconds")
    ratio = new / motion.time_step
    if abs(ratio - 1.0) <= ROUNDING:
        return motion
    if ratio < 1.0:
        count = _whole(motion.duration / new) + 1
        if count > MOST_SAMPLES:
            raise InvalidValueError(
                "{parameter} must leave at most {limit:g} samples, got {count:g}", parameter="time_step",
                limit=MOST_SAMPLES, count=count, hint="check the unit",
            )  # fmt: skip
        position = np.arange(count) * ratio
        # rounding must not move the last new sample after the last old sample
        last = len(motion) - 1
        position[np.abs(position - last) <= ROUNDING] = last
        grid = np.arange(len(motion), dtype=np.float64)
        action = f"interpolated linearly from {motion.time_step:g} s to {new:g} s"
        return _each_component(motion, lambda a: np.interp(position, grid, a, right=0.0), action, new)
    factor = round(ratio)
    if abs(ratio - factor) > ROUNDING * factor:
        raise InvalidValueError(
            "{parameter} above {step:g} s must be an integer multiple of {step:g} s, got {value} s, {ratio:g} times "
            "{step:g} s",
            parameter="time_step", value=new, step=motion.time_step, ratio=ratio,
        )  # fmt: skip
    if factor > len(motion) - 1:
        raise InvalidValueError(
            "{parameter} must be at most {longest:g} s, so that 2 samples remain, got {value} s",
            parameter="time_step", value=new, longest=motion.duration,
        )  # fmt: skip
    action = f"low-passed (linear phase) and coarsened from {motion.time_step:g} s to {new:g} s"
    return _each_component(motion, lambda a: _coarse(a, factor), action, new)


def trimmed(motion: GroundMotion, start: float, end: float) -> GroundMotion:
    """Return the motion between two times.

    Parameters
    ----------
    motion : GroundMotion
        Motion. The time of the result starts at zero.
    start, end : float
        Times within the record, rounded outwards to samples [s].

    Returns
    -------
    GroundMotion
        Trimmed motion.

    Examples
    --------
    >>> trimmed(GroundMotion([0.0, 1.0, 2.0, 3.0], 1.0), 1.0, 2.5).acceleration.tolist()
    [1.0, 2.0, 3.0]
    """
    motion = checked_motion(motion)
    length = motion.duration
    start = checks.within("start", start, 0.0, length * (1.0 + 1e-9), unit="s")
    end = checks.within(
        "end", end, start, length * (1.0 + 1e-9), unit="s", open_low=True, hint="end must be after start"
    )
    first = math.floor(start / motion.time_step + ROUNDING)
    last = min(_whole(end / motion.time_step), len(motion) - 1)
    first = min(first, last - 1)
    action = f"trimmed to {first * motion.time_step:g} to {last * motion.time_step:g} s"
    return _moved(_each_component(motion, lambda a: a[first : last + 1], action), first * motion.time_step)


def trimmed_to_significant(
    motion: GroundMotion, start: float = 5.0, end: float = 95.0, padding: float = 0.0
) -> GroundMotion:
    """Return the motion between two percentages of its Arias intensity.

    Parameters
    ----------
    motion : GroundMotion
        Motion. The horizontal part determines the times.
    start, end : float
        Percentages of the Arias intensity [%].
    padding : float
        Additional time before and after, within the record [s].

    Returns
    -------
    GroundMotion
        Trimmed motion.
    """
    return trimmed(motion, *significant_bounds(motion, start, end, padding))


def significant_bounds(
    motion: GroundMotion, start: float = 5.0, end: float = 95.0, padding: float = 0.0
) -> tuple[float, float]:
    """Return the times of two percentages of the Arias intensity, with padding [s]."""
    motion = checked_motion(motion)
    padding = checks.within("padding", padding, 0.0, math.inf, unit="s")
    first, last = significant_times(motion, start, end)
    return max(first - padding, 0.0), min(last + padding, motion.duration)


def padded(motion: GroundMotion, before: float, after: float | None = None) -> GroundMotion:
    """Return the motion with zeros before and after.

    Parameters
    ----------
    motion : GroundMotion
        Motion. A straight line of one step connects a nonzero first or last sample to zero.
    before : float
        Additional time before, rounded up to whole steps [s].
    after : float, optional
        Additional time after; the default is `before` [s].

    Returns
    -------
    GroundMotion
        Padded motion.

    Examples
    --------
    >>> padded(GroundMotion([1.0, 2.0], 0.5), 0.5).acceleration.tolist()
    [0.0, 1.0, 2.0, 0.0]
    """
    motion = checked_motion(motion)
    times = [checks.within("before", before, 0.0, math.inf, unit="s")]
    times.append(times[0] if after is None else checks.within("after", after, 0.0, math.inf, unit="s"))
    if sum(times) / motion.time_step > MOST_SAMPLES:
        raise InvalidValueError(
            "padding must add at most {limit:g} samples, got {time:g} s", limit=MOST_SAMPLES, time=sum(times),
            hint="check the unit",
        )  # fmt: skip
    counts = (_whole(times[0] / motion.time_step), _whole(times[1] / motion.time_step))
    action = f"padded with zeros, {counts[0]} samples before and {counts[1]} after"
    return _moved(_each_component(motion, lambda a: np.pad(a, counts), action), -counts[0] * motion.time_step)


def scaled_to(motion: GroundMotion, measure: Any, target: float, body: RockingScale | None = None) -> GroundMotion:
    """Return the motion scaled to an intensity measure.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Both components are multiplied by the factor of the horizontal component.
    measure : str or IntensityMeasure
        A name from `measures`, ``sa(period)``, or another measure. The power of the measure must not be zero.
    target : float
        Target value [unit of the measure].
    body : RockingScale, optional
        Quantities of a body, for measures that require one.

    Returns
    -------
    GroundMotion
        Scaled motion.

    Raises
    ------
    InvalidValueError
        If the measure is unknown, has power zero or requires a body, or if the measure of the motion is zero.

    Examples
    --------
    >>> from rocking.motions.integrals import arias_intensity
    >>> round(arias_intensity(scaled_to(GroundMotion([0.0, 1.0, -2.0], 0.1), "arias", 1.5)), 12)
    1.5
    """
    item = intensity.measure(measure, "measure")
    item.check_grows()
    current, name = item.of(motion, body), item.symbol or item.name
    target = checks.positive("target", target, item.unit)
    if not current > 0.0:
        raise InvalidValueError(
            "{parameter} must have {measure} > 0 {unit} to be scaled, got {peak:g}", parameter="motion", measure=name,
            unit=item.unit, peak=current, hint="check for a record of zeros",
        )  # fmt: skip
    factor = checks.number("factor", (target / current) ** (1.0 / item.power))
    vertical = None if motion.vertical is None else motion.vertical * factor
    action = f"multiplied by {factor!r} so that {name} is {target:g} {item.unit}"
    return motion.changed(action, acceleration=motion.acceleration * factor, vertical=vertical)


def _trend(samples: FloatArray, time_step: float, order: int, fit: str) -> FloatArray:
    """Return the trend from polynomials that are orthogonal over the samples (Stieltjes' recurrence, no matrix)."""
    x, duration = np.linspace(0.0, 1.0, samples.size), (samples.size - 1) * time_step
    velocity = fit == "velocity"
    weight, values = (x, velocity_of(samples, time_step)) if velocity else (np.ones_like(x), samples)
    trend, before, p, slope_before, slope = 0.0 * x, 0.0 * x, np.ones_like(x), 0.0 * x, 0.0 * x
    last = 1.0
    for _ in range(order if velocity else order + 1):
        q = weight * p
        size = (q * q).sum()
        term = (p + x * slope) / duration if velocity else p
        trend += (q * values).sum() / size * term
        middle, ratio = (x * q * q).sum() / size, size / last
        before, p, slope_before, slope = (
            p,
            (x - middle) * p - ratio * before,  # Eq. 153
            slope,
            p + (x - middle) * slope - ratio * slope_before,
        )
        last = size
    return trend


def begins_at(motion: GroundMotion) -> float:
    """Return the start time of a trimmed or padded motion in the original record [s]."""
    return float(motion.metadata.get("begins at", "0 s").removesuffix(" s"))


def _moved(motion: GroundMotion, by: float) -> GroundMotion:
    metadata = {**motion.metadata, "begins at": f"{begins_at(motion) + by!r} s"}
    return motion if by == 0.0 else replace(motion, metadata=metadata)


def _whole(ratio: float) -> int:
    return math.ceil(ratio - ROUNDING)


def _coarse(samples: FloatArray, factor: int) -> FloatArray:
    from scipy.signal import decimate

    result: Any = decimate(samples, factor, ftype="fir", zero_phase=True)
    return np.asarray(result, dtype=np.float64)


def _each_component(motion: GroundMotion, change: Any, action: str, time_step: float | None = None) -> GroundMotion:
    vertical = None if motion.vertical is None else change(motion.vertical)
    step = motion.time_step if time_step is None else time_step
    return motion.changed(action, acceleration=change(motion.acceleration), vertical=vertical, time_step=step)
