"""The step of a column of times."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.formats.source import Source
from rocking.motions.formats.units_and_steps import step_between_samples


def step_of_times(source: Source, times: FloatArray, words: list[str], told: float | None) -> float:
    """Return the step of a column of times; the told one where it is the same to the digits of the column.

    times: the times [s]; told: what the user says of the step [s]. Returns the step [s].
    """
    digit = _last_digit(words)
    step = uniform_step(source, times, digit)
    if told is not None and abs(step - told) * times.size <= 2.0 * digit:
        return told
    return step_between_samples(source, step, told)


def uniform_step(source: Source, times: FloatArray, unit: float) -> float:
    """Return the step of a time column that is uniform to the rounding of its digits.

    times: times as printed [s]; unit: one unit of the last printed digit [s]. Returns the step; the shortest decimal
    number that fits the column [s].
    """
    if times.size < 2:
        raise source.error(None, f"at least 2 samples are needed, found {times.size}")
    steps = times.size - 1
    mean = (float(times[-1]) - float(times[0])) / steps
    if not 1e-6 <= mean <= 10.0:
        raise source.error(None, f"time step must be in [1e-6, 10] s, got {mean:g}; is the first column a time?")
    # beyond rounding or cutting at the last digit, times that went through single precision are accepted
    slack = unit + 1.2e-7 * float(np.abs(times).max())
    rounded = (round(mean, digits) for digits in range(1, 10))
    step = next((step for step in rounded if step > 0.0 and abs(step - mean) * steps <= slack), mean)
    even = mean
    if slack > 0.26 * mean:
        # so few digits could hide a missing line: the times must lie on the decimal step itself
        even, slack = step, 0.501 * unit
    if slack > 0.51 * mean:
        raise source.error(None, f"the times have too few digits to tell their step of about {mean:g} s")
    off = np.abs(times - times[0] - even * np.arange(times.size))
    worst = int(off.argmax())
    if off[worst] > slack:
        raise source.error(
            None,
            f"the times are not evenly spaced: sample {worst + 1} at {times[worst]:g} s is {off[worst]:.3g} s off the "
            f"even step of {even:g} s; resample it first, or a line is missing",
        )
    return step


def _last_digit(words: list[str]) -> float:
    plain: list[int] = []
    powers: list[int] = []
    for word in words:
        digits, _, power = word.lower().replace("d", "e").replace(",", ".").partition("e")
        (powers if power else plain).append(len(digits.partition(".")[2]) - int(power or 0))
    # plain numbers may have lost zeros at their end, numbers with an exponent lose digits as they grow
    places = min(powers) if powers else max(plain)
    return float(10.0 ** -min(15, max(-3, places)))
