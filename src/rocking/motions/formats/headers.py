"""What a header states, or the user where it is silent: unit, step, channels; count, peak and duration must agree."""

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
"""Header lines of a channel, the one with its number and direction, and its samples."""

LONGEST_LINE = 200  # characters of a header line that patterns look at


def unit_to_state() -> Message:
    """Return the hint that a unit of acceleration has to be stated."""
    units = ", ".join(ACCELERATION_UNITS)
    return Message("say {option} one of {units}", {"option": Option("motion.units"), "units": units})


def acceleration_unit(source: Source, stated: str | None, asked: str | None) -> str:
    """Return the unit of a file's accelerations: what it states, or what the user says where it states nothing."""
    asked = None if asked is None else checks.one_of("units", asked, ACCELERATION_UNITS)
    if stated is None and asked is None:
        raise source.error(None, "the file does not state its unit", hint=unit_to_state())
    if stated is not None and asked is not None and ACCELERATION_UNITS[stated] != ACCELERATION_UNITS[asked]:
        raise source.error(
            None, "the file states the unit {stated}, you say {requested}", stated=stated, requested=asked
        )
    return stated or asked or ""


_OTHER = re.compile(
    r"(?<![^\W_])(?:(vel|velocity|velocities|vt2)|(disp|dis|displacements?|dt2))(?![^\W_])", re.IGNORECASE
)


_ACCELERATION = re.compile(r"(?<![^\W_])acc", re.IGNORECASE)


def refuse_other(source: Source, words: str = "") -> None:
    """Refuse a file whose name, or what it says of itself, is that of velocities or displacements."""
    for text, where in ((source.name, "its name"), (words, "its header")):
        found = _OTHER.search(text[:LONGEST_LINE])
        if found and not _ACCELERATION.search(text[:LONGEST_LINE]):
            kind = "velocity" if found[1] else "displacement"
            raise source.error(
                None, "accelerations are needed, and {origin} says {entry!r}, a {quantity}; take the file of "
                "accelerations, or correct that if it holds them", origin=where, entry=found[0], quantity=kind,
            )  # fmt: skip


def doubt_channel(source: Source, code: str) -> None:
    """Doubt accelerations of a channel whose SEED code is that of a seismometer, which records velocities."""
    # SEED Reference Manual 2.4, appendix A: the second letter is the instrument, H and L for high and low gain
    if re.fullmatch(r"[A-Z][HLM][A-Z0-9]", code):
        source.doubt(None, f"channel {code} is by its code one of velocities; were its samples made accelerations?")


def step_between_samples(source: Source, stated: float | None, asked: float | None) -> float:
    """Return the step of a file: what it states, or what the user says where it states nothing; 1e-6 to 10 s [s]."""
    step = stated if stated is not None else asked
    if step is None:
        hint = Message("say {option} in seconds", {"option": Option("motion.time_step")})
        raise source.error(None, "the file does not state its time step", hint=hint)
    if stated is not None and asked is not None and abs(stated - asked) > 1e-9 * stated:
        raise source.error(
            None, "the file states a time step of {stated:g} s, you say {requested:g}", stated=stated, requested=asked
        )
    if not 1e-6 <= step <= 10.0:
        raise source.error(None, Message("time step must be in [1e-6, 10] s, got {step:g}", {"step": step}))
    return float(step)


def in_unit(record: Record, title: str, unit: str | None, most: int) -> list[FloatArray]:
    """Return the samples of a record in the one unit that a format holds, for writers."""
    if not 1 <= len(record.components) <= most:
        raise RecordError(
            "{format} holds 1 to {most} components a file, got {count}", format=title, most=most,
            count=len(record.components),
        )  # fmt: skip
    rows = []
    unit = unit or record.components[0].unit
    for part in record.components:
        values = np.asarray(part.acceleration, dtype=np.float64)
        if values.ndim != 1 or values.size < 2 or not np.isfinite(values).all():
            raise RecordError(
                "component {component!r:.60} must be a row of at least 2 finite samples", component=part.name
            )
        if part.unit not in ACCELERATION_UNITS:
            raise RecordError(
                "unit must be one of {units}, got {unit}",
                units=", ".join(ACCELERATION_UNITS),
                unit=f"{part.unit!r:.60}",
            )
        if not 1e-6 <= part.time_step <= 10.0:
            raise RecordError("time step must be in [1e-6, 10] s, got {step}", step=f"{part.time_step!r:.60}")
        same = ACCELERATION_UNITS[part.unit] == ACCELERATION_UNITS[unit]
        rows.append(values if same else values * (ACCELERATION_UNITS[part.unit] / ACCELERATION_UNITS[unit]))
    return rows


def step_of_times(source: Source, times: FloatArray, words: list[str], told: float | None) -> float:
    """Return the step of a column of times [s]; the user's where it is the same to the digits of the column."""
    decimals = [len(word.partition(".")[2]) for word in words]
    powers = [_last_place(word) for word in words if _has_power(word)] if _has_power("".join(words)) else []
    # plain numbers may have lost zeros at their end, numbers with an exponent lose digits as they grow
    places = min(powers) if powers else max(decimals)
    digit = float(10.0 ** -min(15, max(-3, places)))
    last = digit if powers else np.maximum(digit, _last_digits(times, decimals))
    step = uniform_step(source, times, last)
    if told is not None and abs(step - told) * times.size <= 2.0 * float(np.max(last)):
        return told
    return step_between_samples(source, step, told)


def _has_power(text: str) -> bool:
    low = text.lower()
    return "e" in low or "d" in low


def _last_place(word: str) -> int:
    """Return the place behind the point of the last digit of a number with an exponent."""
    digits, _, power = word.lower().replace("d", "e").partition("e")
    return len(digits.partition(".")[2]) - int(power)


def _last_digits(times: FloatArray, decimals: list[int]) -> FloatArray:
    """Return the last digit of each time, where all above 1 s have so many digits as the longest of them [s].

    Programs that print six digits write 9.98625, and 40.9862 for 40.98625.
    """
    before = np.floor(np.log10(np.maximum(np.abs(times), 1.0))) + 1.0
    digits = before + np.array(decimals, dtype=np.float64)
    beyond = digits[np.abs(times) >= 1.0]
    return np.asarray(10.0 ** (before - float((beyond if beyond.size else digits).max())), dtype=np.float64)


def uniform_step(source: Source, times: FloatArray, unit: float | FloatArray) -> float:
    """Return the step of times uniform to rounding at `unit`, the last digit: the shortest decimal that fits [s]."""
    if times.size < 2:
        raise source.error(None, "at least 2 samples are needed, found {count}", count=times.size)
    steps = times.size - 1
    mean = (float(times[-1]) - float(times[0])) / steps
    if not 1e-6 <= mean <= 10.0:
        raise source.error(
            None,
            Message("time step must be in [1e-6, 10] s, got {step:g}; is the first column a time?", {"step": mean}),
        )
    # beyond rounding or cutting at the last digit, times that went through single precision are accepted
    slack = unit + 1.2e-7 * float(np.abs(times).max())
    most = float(np.max(slack))
    rounded = (round(mean, digits) for digits in range(1, 10))
    step = next((step for step in rounded if step > 0.0 and abs(step - mean) * steps <= most), mean)
    even = mean if np.ndim(unit) == 0 or np.ptp(unit) == 0.0 else step
    if most > 0.26 * mean:
        # so few digits could hide a missing line: the times must lie on the decimal step itself
        even, slack = step, 0.501 * unit
    if float(np.max(slack)) > 0.51 * mean:
        raise source.error(None, "the times have too few digits to tell their step of about {step:g} s", step=mean)
    off = np.abs(times - times[0] - even * np.arange(times.size))
    worst = int((off - slack).argmax())
    if off[worst] > np.broadcast_to(slack, off.shape)[worst]:
        raise source.error(
            None, "the times are not evenly spaced: sample {sample} at {time:g} s is {deviation:.3g} s off the even "
            "step of {step:g} s; resample it first, or a line is missing", sample=worst + 1, time=float(times[worst]),
            deviation=float(off[worst]), step=even,
        )  # fmt: skip
    return step


def at_even_steps(
    source: Source, times: FloatArray, values: FloatArray, unit: float
) -> tuple[FloatArray, float, dict[str, str]]:
    """Return samples at even steps, their step [s], and what was done to them.

    Where the times are uneven beyond rounding at `unit`, straight lines between the samples are sampled at a round
    step not above the usual one, at instants of which one is that of the largest sample.
    """
    try:
        return values.copy(), uniform_step(source, times, unit), {}
    except RecordError:
        gaps = np.diff(times)
        half = times.size // 2
        usual = float(np.median((times[half:] - times[: times.size - half]) / half)) if half else 0.0
        line = times - usual * np.arange(times.size)
        # a few times off an even row are damage, and no way of sampling
        odd = np.abs(line - np.median(line)) > 2.0 * unit
        reach = float(times[-1] - times[0])
        if not 1e-6 <= usual <= 10.0 or (gaps < 0.0).any() or odd.sum() <= max(10, times.size // 100):
            raise
        step = max(
            round(one * 10.0**power, 9) for power in range(-6, 2) for one in (1, 2, 5) if one * 10.0**power <= usual
        )
        if reach > 3.0 * usual * times.size:
            raise
    top = int(np.abs(values).argmax())
    before, behind = (int(span / step + 1e-9) for span in (times[top] - times[0], times[-1] - times[top]))
    # of samples at one printed time the larger is kept
    order = np.lexsort((-np.abs(values), times))
    _, first = np.unique(times[order], return_index=True)
    kept = order[first]
    even = np.interp(times[top] + step * np.arange(-before, behind + 1), times[kept], values[kept])
    even[before] = values[top]
    gap = f", the longest gap {gaps.max():.3g} s" if gaps.max() > 10.0 * usual else ""
    told = f"{times.size} samples at uneven times{gap}, resampled at {step:g} s by straight lines"
    source.doubt(None, told)
    return even, step, {"resampled": told}


def check_count(source: Source, stated: int, found: int) -> None:
    """Refuse a file that holds another number of samples than its header states."""
    if stated != found:
        raise source.error(
            None, "the header states {stated} samples, the file holds {count}", stated=stated, count=found
        )


def check_said_peak(
    source: Source, stated: float, values: FloatArray, rounding: float, what: str, *, confirmed: bool
) -> None:
    """Check a peak in words, which may be rounded: a doubt within 5 % where numbers of the header confirm the data."""
    largest = float(np.abs(values).max())
    if confirmed and abs(abs(stated) - largest) <= 0.05 * largest:
        with source.doubting():
            check_peak(source, stated, values, rounding, what)
    else:
        check_peak(source, stated, values, rounding, what)


def check_peak(source: Source, stated: float, values: FloatArray, rounding: float, what: str = "peak") -> None:
    """Refuse a file whose largest value is not the one that its header states."""
    check_stated(source, abs(stated), float(np.abs(values).max()), rounding, what)


def check_end(source: Source, first: int) -> None:
    """Refuse anything but blank lines and words that close the file from some line to its end."""
    more = [line for line in range(first, len(source.lines)) if source.lines[line].strip(" \t\r\x1a")]
    for line in more:
        if line < source.end:
            raise source.error(line, "nothing may follow the last sample, found more; wrong count in the header?")


def check_peak_time(source: Source, stated: float, values: FloatArray, step: float, rounding: float) -> None:
    """Doubt a header whose largest value is not where it states, to a step [s]; some count from another instant."""
    largest = np.abs(values)
    at = stated / step
    near = largest[max(0, math.ceil(at - 1.01)) : max(0, math.floor(at + 1.01) + 1)] if 0.0 <= at < 1e9 else largest[:0]
    if not near.size or near.max() < largest.max() - rounding:
        found = float(largest.argmax()) * step
        source.doubt(
            None, f"the header states the peak at {stated:g} s, the data have it at {found:g} s (from the trigger?)"
        )


def check_duration(source: Source, stated: float, count: int, step: float, rounding: float) -> None:
    """Doubt a stated duration, of all steps or from first to last sample, that is not that of the samples [s]."""
    off = min(abs(stated - samples * step) for samples in (count - 1, count))
    if not off <= 1.001 * rounding + 1e-9:
        source.doubt(
            None, f"the header states a duration of {stated:g} s, {count} samples at {step:g} s last {count * step:g} s"
        )


def half_digit(word: str) -> float:
    """Return half a unit of a printed number's last digit, the most that rounding can leave, and a millionth to spare.

    >>> f"{half_digit('4.954'):.3g}", f"{half_digit('4.136E+1'):.3g}", f"{half_digit('-12'):.3g}"
    ('0.0005', '0.005', '0.5')
    """
    mantissa, _, exponent = word.strip().upper().replace("D", "E").partition("E")
    return 0.500001 * 10.0 ** min(int(exponent or "0") - len(mantissa.partition(".")[2]), 300)


def printed_rounding(stated: str, sample: str, least: int) -> float:
    """Return how far a printed peak may be from a printed sample: half a last digit of each.

    Zeros at the end of the peak, beyond `least` decimals, may be none of its digits.

    >>> f"{printed_rounding('-29.340', '29.342', 2):.4g}", f"{printed_rounding('.0791795', '.079180', 3):.3g}"
    ('0.0055', '5.5e-07')
    """
    mantissa, mark, exponent = stated.strip().upper().replace("D", "E").partition("E")
    whole, _, digits = mantissa.partition(".")
    digits = digits[:least] + digits[least:].rstrip("0")
    return half_digit(f"{whole}.{digits}{mark}{exponent}") + half_digit(sample)


def check_stated(source: Source, stated: float, found: float, rounding: float, what: str) -> None:
    """Refuse a file whose header states another number than its data give; signs count."""
    if not abs(stated - found) <= rounding:
        raise source.error(
            None, "the header states a {quantity} of {stated:g}, the data have {computed:g}", quantity=what,
            stated=stated, computed=found,
        )  # fmt: skip


def samples_of(source: Source, line: int | None, rate: float, seconds: float, what: str) -> int:
    """Return the number of samples that a stated rate [Hz] and duration [s] make, which must be whole."""
    wanted = rate * seconds
    if not 2 <= wanted < 1e9 or abs(wanted - round(wanted)) > 1e-6:
        raise source.error(
            line, "{quantity} times rate must be a whole number of samples, found {count:g}", quantity=what,
            count=wanted,
        )  # fmt: skip
    return round(wanted)


def read_channels(
    source: Source, begins: Callable[[str], object], read: Callable[[int], tuple[Channel, int]]
) -> list[Channel]:
    """Return the channels that follow one another to the end of a file; `read` returns one and the line after it."""
    channel, line = read(0)
    channels = [channel]
    while line < len(source.lines) and begins(source.lines[line]):
        channel, line = read(line)
        channels.append(channel)
    check_end(source, line)
    return channels


def record_of_channels(format: str, channels: Sequence[Channel], metadata: dict[str, str]) -> Record:
    """Return a record whose components are named by direction, or by channel number where directions repeat."""
    header = "\n".join("\n".join(lines) for lines, _, _ in channels)
    form = re.compile(r"(?:CHAN\s*(\d+)\s*:|^\s*COMP\b)\s*(.*?)\s*(?:DEG\b.*|\s{3}.*)?$", re.IGNORECASE)
    found = [form.search(label) for _, label, _ in channels]
    numbers = [(one and one[1]) or str(place) for place, one in enumerate(found, 1)]
    names = directions = [one[2].strip() if one else "" for one in found]
    if len({name.casefold() for name in directions}) < len(channels) or "" in directions:
        unique = len(set(numbers)) == len(channels)
        names = [f"CHAN {n}" for n in (numbers if unique else range(1, len(channels) + 1))]
    parts = (
        replace(part, name=name, metadata={**part.metadata, "channel": chan, "direction": direction})
        for (_, _, part), name, chan, direction in zip(channels, names, numbers, directions, strict=True)
    )
    return Record(format, tuple(parts), header, metadata)


def names_in(texts: Sequence[str]) -> dict[str, str]:
    """Return event and station from the text lines after the titles."""
    station = re.search(r"STATION (?:NO\.?|ID\.?|USC#)\s*(\w+)", texts[3][:LONGEST_LINE], re.IGNORECASE)
    number = station[1] if station else ""
    # what stands beyond column 40 or three blanks belongs to the network, or counts letters
    event, date, place = (re.split(r"\s{3}|\(", text.strip())[0] for text in (texts[0], texts[1], texts[4]))
    return metadata_of(event=event, date=date, station_number=number, station=place)
