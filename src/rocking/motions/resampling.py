"""Records cut, padded and resampled, each with a line of provenance."""

import math
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.energy import significant_times
from rocking.motions.motion import LONGEST_STEP, SHORTEST_STEP, GroundMotion, checked_motion

ROUNDING = 1e-6
"""A ratio of times this close to a whole number is one."""

MOST_SAMPLES = 100_000_000
"""No motion has more samples: asking for more is a wrong unit."""


def resampled(motion: GroundMotion, time_step: float) -> GroundMotion:
    """Return the motion at another time step.

    A finer step, of any ratio, takes the straight lines between the samples: every new sample is exact, and if the
    ratio is whole the motion drives bodies as before; its Arias intensity falls to that of the lines. A coarser step
    must be a whole multiple; then a linear-phase low pass (Hamming window, 20 taps a multiple on either side, no
    shift) removes first what the new step cannot carry.

    Parameters
    ----------
    motion : GroundMotion
        The motion; both components are resampled.
    time_step : float
        New step [s].

    Returns
    -------
    GroundMotion
        The resampled motion. If the last sample falls between two steps, it ends with a zero one step later.

    Raises
    ------
    InvalidValueError
        If the step is coarser and not a whole multiple, or leaves fewer than two samples or far too many.

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
                f"time_step must leave at most {MOST_SAMPLES:g} samples, got {count:g}; wrong unit?"
            )
        place = np.arange(count) * ratio
        # rounding must not push the last new sample beyond the last old one
        last = len(motion) - 1
        place[np.abs(place - last) <= ROUNDING] = last
        grid = np.arange(len(motion), dtype=np.float64)
        what = f"interpolated linearly from {motion.time_step:g} s to {new:g} s"
        return _each(motion, lambda a: np.interp(place, grid, a, right=0.0), what, new)
    factor = round(ratio)
    if abs(ratio - factor) > ROUNDING * factor:
        raise InvalidValueError(
            f"time_step must be a whole multiple of {motion.time_step:g} s if above, got {new:g} s, {ratio:g} times"
        )
    if factor > len(motion) - 1:
        raise InvalidValueError(f"time_step must leave 2 samples, at most {motion.duration:g} s, got {new:g} s")
    what = f"low-passed (linear phase) and coarsened from {motion.time_step:g} s to {new:g} s"
    return _each(motion, lambda a: _coarse(a, factor), what, new)


def trimmed(motion: GroundMotion, start: float, end: float) -> GroundMotion:
    """Return the part of the motion between two times.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its clock starts again at zero.
    start, end : float
        Times within the record; these go outwards to the next sample [s].

    Returns
    -------
    GroundMotion
        The part.

    Raises
    ------
    InvalidValueError
        If the times are outside the record or not in order.

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
    what = f"trimmed to {first * motion.time_step:g} to {last * motion.time_step:g} s"
    return _each(motion, lambda a: a[first : last + 1], what)


def trimmed_to_significant(
    motion: GroundMotion, start: float = 5.0, end: float = 95.0, padding: float = 0.0
) -> GroundMotion:
    """Return the part of the motion that holds most of its Arias intensity.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    start, end : float
        Percentages of the Arias intensity [%].
    padding : float
        Time to keep before and after, as far as there is a record [s].

    Returns
    -------
    GroundMotion
        The part.
    """
    motion = checked_motion(motion)
    padding = checks.within("padding", padding, 0.0, math.inf, unit="s")
    first, last = significant_times(motion, start, end)
    return trimmed(motion, max(first - padding, 0.0), min(last + padding, motion.duration))


def padded(motion: GroundMotion, before: float, after: float | None = None) -> GroundMotion:
    """Return the motion with zeros before and after.

    Parameters
    ----------
    motion : GroundMotion
        The motion. Where it does not start and end at zero, a straight line of one step leads there.
    before : float
        Time to add before, rounded up to whole steps [s].
    after : float, optional
        Time to add after; as much as before if not given [s].

    Returns
    -------
    GroundMotion
        The longer motion.

    Raises
    ------
    InvalidValueError
        If a time is negative or far too long.

    Examples
    --------
    >>> padded(GroundMotion([1.0, 2.0], 0.5), 0.5).acceleration.tolist()
    [0.0, 1.0, 2.0, 0.0]
    """
    motion = checked_motion(motion)
    times = [checks.within("before", before, 0.0, math.inf, unit="s")]
    times.append(times[0] if after is None else checks.within("after", after, 0.0, math.inf, unit="s"))
    if sum(times) / motion.time_step > MOST_SAMPLES:
        raise InvalidValueError(f"padding must add at most {MOST_SAMPLES:g} samples, got {sum(times):g} s; wrong unit?")
    counts = (_whole(times[0] / motion.time_step), _whole(times[1] / motion.time_step))
    what = f"padded with zeros, {counts[0]} samples before and {counts[1]} after"
    return _each(motion, lambda a: np.pad(a, counts), what)


def _whole(ratio: float) -> int:
    return math.ceil(ratio - ROUNDING)


def _coarse(samples: FloatArray, factor: int) -> FloatArray:
    from scipy.signal import decimate

    result: Any = decimate(samples, factor, ftype="fir", zero_phase=True)
    return np.asarray(result, dtype=np.float64)


def _each(motion: GroundMotion, change: Any, what: str, time_step: float | None = None) -> GroundMotion:
    vertical = None if motion.vertical is None else change(motion.vertical)
    step = motion.time_step if time_step is None else time_step
    return motion.changed(what, acceleration=change(motion.acceleration), vertical=vertical, time_step=step)
