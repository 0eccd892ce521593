"""Units, time steps and channels from headers or the user, and checks of count, peak and duration."""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from rocking import checks
from rocking.conventions import ACCELERATION_UNITS, FloatArray
from rocking.errors import RecordError
from rocking.messages import Message, Option
from rocking.motions.formats.record import Component, Record, Source, metadata_of

Channel = tuple[list[str], str, Component]
"""Header lines of a channel, the line with its number and direction, and its samples."""

LONGEST_LINE = 200  # largest number of characters of a header line that patterns search


def unit_to_state() -> Message:
    """Return the hint about a missing unit of acceleration."""
    units = ", ".join(ACCELERATION_UNITS)
    return Message("add {option} with one of {units}", {"option": Option("motion.units"), "units": units})


def acceleration_unit(source: Source, stated: str | None, requested: str | None) -> str:
    """Return the unit of accelerations: the unit in the file, or otherwise the requested unit."""
    requested = None if requested is None else checks.one_of("units", requested, ACCELERATION_UNITS)
    if stated is None and requested is None:
        raise source.error(None, "the file does not state its unit", hint=unit_to_state())
    if stated is not None and requested is not None and ACCELERATION_UNITS[stated] != ACCELERATION_UNITS[requested]:
        raise source.error(
            None, "the file states the unit {stated}, not {requested}", stated=stated, requested=requested
        )
    return stated or requested or ""


_OTHER = re.compile(
    r"(?<![^\W_])(?:(vel|velocity|velocities|vt2)|(disp|dis|displacements?|dt2))(?![^\W_])", re.IGNORECASE
)


_ACCELERATION = re.compile(r"(?<![^\W_])acc", re.IGNORECASE)


def refuse_other(source: Source, header_text: str = "") -> None:
    """Raise an error if the name or header of a file indicates velocities or displacements."""
    for text, origin in ((source.name, "its name"), (header_text, "its header")):
        match = _OTHER.search(text[:LONGEST_LINE])
        if match and not _ACCELERATION.search(text[:LONGEST_LINE]):
            kind = "velocity" if match[1] else "displacement"
            raise source.error(
                None, "accelerations required, but {origin} contains {entry!r}, a {quantity}; use the file of "
                "accelerations, or correct the text", origin=origin, entry=match[0], quantity=kind,
            )  # fmt: skip


def doubt_channel(source: Source, code: str) -> None:
    """Add a warning if the SEED code of a channel is that of a seismometer, which records velocities."""
    # SEED Reference Manual 2.4, appendix A: the second letter is the instrument; H and L mean high and low gain
    if re.fullmatch(r"[A-Z][HLM][A-Z0-9]", code):
        source.doubt(None, f"the code of channel {code} means velocities; check that the samples are accelerations")


def step_between_samples(source: Source, stated: float | None, requested: float | None) -> float:
    """Return the time step in the file, or otherwise the requested time step, from 1e-6 to 10 s [s]."""
    step = stated if stated is not None else requested
    if step is None:
        hint = Message("add {option} in seconds", {"option": Option("motion.time_step")})
        raise source.error(None, "the file does not state its time step", hint=hint)
    if stated is not None and requested is not None and abs(stated - requested) > 1e-9 * stated:
        raise source.error(
            None, "the file states a time step of {stated:g} s, not {requested:g} s", stated=stated, requested=requested
        )
    if not 1e-6 <= step <= 10.0:
        raise source.error(None, Message("time step must be in [1e-6, 10] s, got {step:g}", {"step": step}))
    return float(step)


def in_unit(record: Record, title: str, unit: str | None, most: int) -> list[FloatArray]:
    """Return the samples of a record in the unit of a format, for writers."""
    if not 1 <= len(record.components) <= most:
        raise RecordError(
            "{format} allows 1 to {most} components per file, got {count}", format=title, most=most,
            count=len(record.components),
        )  # fmt: skip
    rows = []
    unit = unit or record.components[0].unit
    for component in record.components:
        values = np.asarray(component.acceleration, dtype=np.float64)
        if values.ndim != 1 or values.size < 2 or not np.isfinite(values).all():
            raise RecordError(
                "component {component!r:.60} must have at least 2 finite samples", component=component.name
            )
        if component.unit not in ACCELERATION_UNITS:
            raise RecordError(
                "unit must be one of {units}, got {unit}",
                units=", ".join(ACCELERATION_UNITS),
                unit=f"{component.unit!r:.60}",
            )
        if not 1e-6 <= component.time_step <= 10.0:
            raise RecordError("time step must be in [1e-6, 10] s, got {step}", step=f"{component.time_step!r:.60}")
        same = ACCELERATION_UNITS[component.unit] == ACCELERATION_UNITS[unit]
        rows.append(values if same else values * (ACCELERATION_UNITS[component.unit] / ACCELERATION_UNITS[unit]))
    return rows


def step_of_times(source: Source, times: FloatArray, texts: list[str], requested: float | None) -> float:
    """Return the step of a column of times [s]. A requested step that agrees within the digits takes precedence."""
    decimals = [len(word.partition(".")[2]) for word in texts]
    powers = [_last_place(word) for word in texts if _has_power(word)] if _has_power("".join(texts)) else []
    # final zeros of plain numbers may be missing; large numbers with an exponent have fewer decimals
    decimal_places = min(powers) if powers else max(decimals)
    digit = float(10.0 ** -min(15, max(-3, decimal_places)))
    last = digit if powers else np.maximum(digit, _last_digits(times, decimals))
    step = uniform_step(source, times, last)
    if requested is not None and abs(step - requested) * times.size <= 2.0 * float(np.max(last)):
        return requested
    return step_between_samples(source, step, requested)


def _has_power(text: str) -> bool:
    low = text.lower()
    return "e" in low or "d" in low


def _last_place(word: str) -> int:
    """Return the number of decimals of a number with an exponent."""
    digits, _, power = word.lower().replace("d", "e").partition("e")
    return len(digits.partition(".")[2]) - int(power)


def _last_digits(times: FloatArray, decimals: list[int]) -> FloatArray:
    """Return the value of the last digit of every time [s], if all times above 1 s have equally many digits.

    Programs with six digits print 9.98625, and 40.9862 for 40.98625.
    """
    before = np.floor(np.log10(np.maximum(np.abs(times), 1.0))) + 1.0
    digits = before + np.array(decimals, dtype=np.float64)
    beyond = digits[np.abs(times) >= 1.0]
    return np.asarray(10.0 ** (before - float((beyond if beyond.size else digits).max())), dtype=np.float64)


def uniform_step(source: Source, times: FloatArray, unit: float | FloatArray) -> float:
    """Return the step of uniform times [s], as the shortest decimal within rounding at `unit`, the last digit."""
    if times.size < 2:
        raise source.error(None, "at least 2 samples required, found {count}", count=times.size)
    steps = times.size - 1
    mean = (float(times[-1]) - float(times[0])) / steps
    if not 1e-6 <= mean <= 10.0:
        raise source.error(
            None,
            Message(
                "time step must be in [1e-6, 10] s, got {step:g}; check that the first column is a time", {"step": mean}
            ),
        )
    # tolerance for rounding or truncation of the last digit, and for single precision
    slack = unit + 1.2e-7 * float(np.abs(times).max())
    most = float(np.max(slack))
    rounded = (round(mean, digits) for digits in range(1, 10))
    step = next((step for step in rounded if step > 0.0 and abs(step - mean) * steps <= most), mean)
    even = mean if np.ndim(unit) == 0 or np.ptp(unit) == 0.0 else step
    if most > 0.26 * mean:
        # with few digits, a missing line could remain unnoticed; therefore, the times must match the decimal step
        even, slack = step, 0.501 * unit
    if float(np.max(slack)) > 0.51 * mean:
        raise source.error(None, "the times have too few digits for their step of about {step:g} s", step=mean)
    off = np.abs(times - times[0] - even * np.arange(times.size))
    worst = int((off - slack).argmax())
    if off[worst] > np.broadcast_to(slack, off.shape)[worst]:
        raise source.error(
            None, "the times are not evenly spaced: sample {sample} at {time:g} s deviates by {deviation:.3g} s from "
            "the step of {step:g} s; resample the record, or add a missing line", sample=worst + 1,
            time=float(times[worst]), deviation=float(off[worst]), step=even,
        )  # fmt: skip
    return step


def at_even_steps(
    source: Source, times: FloatArray, values: FloatArray, unit: float
) -> tuple[FloatArray, float, dict[str, str]]:
    """Return samples at even time steps, the step [s], and metadata about resampling.

    If times are uneven beyond rounding at `unit`, the samples are interpolated linearly. The new step is a round
    number, at most the usual step. The largest sample remains a sample.
    """
    try:
        return values.copy(), uniform_step(source, times, unit), {}
    except RecordError:
        gaps = np.diff(times)
        half = times.size // 2
        usual = float(np.median((times[half:] - times[: times.size - half]) / half)) if half else 0.0
        line = times - usual * np.arange(times.size)
        # a few uneven times mean damage, not uneven sampling
        odd = np.abs(line - np.median(line)) > 2.0 * unit
        reach = float(times[-1] - times[0])
        if not 1e-6 <= usual <= 10.0 or (gaps < 0.0).any() or odd.sum() <= max(10, times.size // 100):
            raise
        step = max(
            round(digit * 10.0**power, 9)
            for power in range(-6, 2)
            for digit in (1, 2, 5)
            if digit * 10.0**power <= usual
        )
        if reach > 3.0 * usual * times.size:
            raise
    top = int(np.abs(values).argmax())
    before, behind = (int(span / step + 1e-9) for span in (times[top] - times[0], times[-1] - times[top]))
    # if samples have equal printed times, keep the larger sample
    order = np.lexsort((-np.abs(values), times))
    _, first = np.unique(times[order], return_index=True)
    kept = order[first]
    even = np.interp(times[top] + step * np.arange(-before, behind + 1), times[kept], values[kept])
    even[before] = values[top]
    gap = f", the longest gap {gaps.max():.3g} s" if gaps.max() > 10.0 * usual else ""
    note = f"{times.size} samples at uneven times{gap}, resampled at {step:g} s by straight lines"
    source.doubt(None, note)
    return even, step, {"resampled": note}


def check_count(source: Source, stated: int, count: int) -> None:
    """Raise an error if the number of samples differs from the number in the header."""
    if stated != count:
        raise source.error(
            None, "the header states {stated} samples, but the file contains {count}", stated=stated, count=count
        )


def check_said_peak(
    source: Source, stated: float, values: FloatArray, rounding: float, quantity: str, *, confirmed: bool
) -> None:
    """Check a rounded peak in header text. With `confirmed` data, a deviation within 5 % only gives a warning."""
    largest = float(np.abs(values).max())
    if confirmed and abs(abs(stated) - largest) <= 0.05 * largest:
        with source.doubting():
            check_peak(source, stated, values, rounding, quantity)
    else:
        check_peak(source, stated, values, rounding, quantity)


def check_peak(source: Source, stated: float, values: FloatArray, rounding: float, quantity: str = "peak") -> None:
    """Raise an error if the peak differs from the peak in the header."""
    check_stated(source, abs(stated), float(np.abs(values).max()), rounding, quantity)


def check_end(source: Source, first: int) -> None:
    """Raise an error if there are other lines than blank lines and closing words from a line to the end."""
    more = [line for line in range(first, len(source.lines)) if source.lines[line].strip(" \t\r\x1a")]
    for line in more:
        if line < source.end:
            raise source.error(line, "text after the last sample; check the count in the header")


def check_peak_time(source: Source, stated: float, values: FloatArray, step: float, rounding: float) -> None:
    """Add a warning if the time of the peak [s] differs by more than a step. Some headers have another origin."""
    largest = np.abs(values)
    position = stated / step
    near = (
        largest[max(0, math.ceil(position - 1.01)) : max(0, math.floor(position + 1.01) + 1)]
        if 0.0 <= position < 1e9
        else largest[:0]
    )
    if not near.size or near.max() < largest.max() - rounding:
        data_time = float(largest.argmax()) * step
        source.doubt(
            None,
            f"the header states the peak at {stated:g} s, but the data have it at {data_time:g} s "
            "(perhaps from the trigger)",
        )


def check_duration(source: Source, stated: float, count: int, step: float, rounding: float) -> None:
    """Add a warning if a stated duration [s] differs from the samples, with or without a step after the last sample."""
    off = min(abs(stated - samples * step) for samples in (count - 1, count))
    if not off <= 1.001 * rounding + 1e-9:
        source.doubt(
            None,
            f"the header states a duration of {stated:g} s, but {count} samples at {step:g} s have {count * step:g} s",
        )


def half_digit(word: str) -> float:
    """Return the rounding error of a printed number: half a unit of the last digit, plus one millionth.

    >>> f"{half_digit('4.954'):.3g}", f"{half_digit('4.136E+1'):.3g}", f"{half_digit('-12'):.3g}"
    ('0.0005', '0.005', '0.5')
    """
    mantissa, _, exponent = word.strip().upper().replace("D", "E").partition("E")
    return 0.500001 * 10.0 ** min(int(exponent or "0") - len(mantissa.partition(".")[2]), 300)


def printed_rounding(stated: str, sample: str, minimum: int) -> float:
    """Return the largest difference between a printed peak and a printed sample that rounding explains.

    Final zeros of the peak after `minimum` decimals do not count as digits.

    >>> f"{printed_rounding('-29.340', '29.342', 2):.4g}", f"{printed_rounding('.0791795', '.079180', 3):.3g}"
    ('0.0055', '5.5e-07')
    """
    mantissa, mark, exponent = stated.strip().upper().replace("D", "E").partition("E")
    integer_digits, _, digits = mantissa.partition(".")
    digits = digits[:minimum] + digits[minimum:].rstrip("0")
    return half_digit(f"{integer_digits}.{digits}{mark}{exponent}") + half_digit(sample)


def check_stated(source: Source, stated: float, computed: float, rounding: float, quantity: str) -> None:
    """Raise an error if a number in the header differs from the computed number, including the sign."""
    if not abs(stated - computed) <= rounding:
        raise source.error(
            None, "the header states a {quantity} of {stated:g}, but the data have {computed:g}", quantity=quantity,
            stated=stated, computed=computed,
        )  # fmt: skip


def samples_of(source: Source, line: int | None, rate: float, seconds: float, quantity: str) -> int:
    """Return the number of samples from a stated rate [Hz] and duration [s]. Raise an error for a fraction."""
    count = rate * seconds
    if not 2 <= count < 1e9 or abs(count - round(count)) > 1e-6:
        raise source.error(
            line, "{quantity} times rate must be a whole number of samples, found {count:g}", quantity=quantity,
            count=count,
        )  # fmt: skip
    return round(count)


def read_channels(
    source: Source, begins: Callable[[str], object], read: Callable[[int], tuple[Channel, int]]
) -> list[Channel]:
    """Return the channels up to the end of a file. `read` returns a channel and the line after the channel."""
    channel, line = read(0)
    channels = [channel]
    while line < len(source.lines) and begins(source.lines[line]):
        channel, line = read(line)
        channels.append(channel)
    check_end(source, line)
    return channels


def record_of_channels(format: str, channels: Sequence[Channel], metadata: dict[str, str]) -> Record:
    """Return a record. Components are named by direction, or by channel number if directions are repeated."""
    header = "\n".join("\n".join(lines) for lines, _, _ in channels)
    form = re.compile(r"(?:CHAN\s*(\d+)\s*:|^\s*COMP\b)\s*(.*?)\s*(?:DEG\b.*|\s{3}.*)?$", re.IGNORECASE)
    matches = [form.search(label) for _, label, _ in channels]
    numbers = [(match and match[1]) or str(index) for index, match in enumerate(matches, 1)]
    names = directions = [match[2].strip() if match else "" for match in matches]
    if len({name.casefold() for name in directions}) < len(channels) or "" in directions:
        unique = len(set(numbers)) == len(channels)
        names = [f"CHAN {n}" for n in (numbers if unique else range(1, len(channels) + 1))]
    components = (
        replace(component, name=name, metadata={**component.metadata, "channel": chan, "direction": direction})
        for (_, _, component), name, chan, direction in zip(channels, names, numbers, directions, strict=True)
    )
    return Record(format, tuple(components), header, metadata)


def names_in(texts: Sequence[str]) -> dict[str, str]:
    """Return the event and the station from the text lines after the titles."""
    station = re.search(r"STATION (?:NO\.?|ID\.?|USC#)\s*(\w+)", texts[3][:LONGEST_LINE], re.IGNORECASE)
    number = station[1] if station else ""
    # text after column 40 or after three blanks is the network
    event, date, station_name = (re.split(r"\s{3}|\(", text.strip())[0] for text in (texts[0], texts[1], texts[4]))
    return metadata_of(event=event, date=date, station_number=number, station=station_name)
