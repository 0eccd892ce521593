"""What raw headers of record files state, read by a few patterns a format that share nothing with the readers."""

import re
from collections.abc import Callable
from typing import NamedTuple


class Stated(NamedTuple):
    """One component by the raw header: samples, step, and peak with the error that printing leaves."""

    samples: int
    step: float | None
    peak: float | None = None
    rounding: float = 0.0


def _unit_of(word: str) -> float:
    mantissa, _, exponent = word.upper().partition("E")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def _all(pattern: str, text: str) -> list[str]:
    return [found[1] for found in re.finditer(pattern, text, re.MULTILINE | re.IGNORECASE)]


def _peer(text: str) -> list[Stated]:
    return [Stated(int(_all(r"NPTS\s*=\s*(\d+)", text)[0]), float(_all(r"\bDT\s*=\s*([\d.]+)", text)[0]))]


def _esm(text: str) -> list[Stated]:
    peaks = _all(r"^PGA_CM/S\^2:\s*(\S+)", text)
    step = float(_all(r"^SAMPLING_INTERVAL_S:\s*(\S+)", text)[0])
    count = int(_all(r"^NDATA:\s*(\d+)", text)[0])
    return [Stated(count, step, abs(float(peaks[0])), _unit_of(peaks[0])) if peaks else Stated(count, step)]


def _columns_of(lines: list[str], width: int) -> list[float]:
    return [float(line[k : k + width]) for line in lines for k in range(0, len(line.rstrip()), width)]


def _cosmos(text: str) -> list[Stated]:
    lines = text.split("\n")
    starts = [k + 1 for k, line in enumerate(lines) if "Real-header values follow" in line]
    counts = [int(word) for word in _all(r"^ *(\d+) .*,Format=\(", text)]
    reals = [_columns_of(lines[start : start + 17], 13) for start in starts]
    # agencies print the peak to a thousandth, whatever the digits of the column
    return [Stated(n, real[61] / 1000.0, abs(real[63]), 6.1e-4) for n, real in zip(counts, reals, strict=True)]


def _csmip_v1(text: str) -> list[Stated]:
    lines = text.split("\n")
    found = []
    for start in (k for k, line in enumerate(lines) if re.match(r"\W*UNCORRECTED\s+ACCEL", line, re.IGNORECASE)):
        wholes = _columns_of(lines[start + 13 : start + 20], 5)
        reals = _columns_of(lines[start + 20 : start + 27], 10)
        # printed in g to a thousandth, samples in g/10 to a thousandth
        found.append(Stated(int(wholes[32] or wholes[27]), None, abs(10.0 * reals[6]) or None, 0.0106))
    return found


def _csmip_v2(text: str) -> list[Stated]:
    counts = _all(r"^ *(\d+) +POINTS OF ACCEL", text)
    steps = _all(r"POINTS OF ACCEL DATA EQUALLY SPACED AT +([\d.]+) +SEC", text)
    lines = text.split("\n")
    starts = [k for k, line in enumerate(lines) if re.match(r"\W*CORRECTED ACCEL", line, re.IGNORECASE)]
    # the peak stands among the 25 lines of text, which may have lost it
    peaks = ["".join(_all(r"^PEAK ACCELERATION *= *(-?[\d.]+)", "\n".join(lines[k : k + 25]))[:1]) for k in starts]
    rows = zip(counts, steps, peaks, strict=True)
    found = [(int(n), float(step), peak) for n, step, peak in rows]
    # words may round the peak that the numbers of the header state: within 5 % they are doubted
    slack = [max(_unit_of(peak), 0.055 * abs(float(peak))) if peak else 0.0 for _, _, peak in found]
    return [
        Stated(n, step, abs(float(peak)), rounding) if peak else Stated(n, step)
        for (n, step, peak), rounding in zip(found, slack, strict=True)
    ]


def _smc(text: str) -> list[Stated]:
    lines = text.split("\n")
    extremes = [abs(float(word)) for word in (lines[22][60:75], lines[23][15:30])]
    peak = max(extremes)
    known = 1e38 not in (min(extreme, 1e38) for extreme in extremes)
    return [Stated(int(lines[13][:10]), 1.0 / float(lines[17][15:30]), peak if known else None, 1e-4 * peak)]


def _knet(text: str) -> list[Stated]:
    rate = float(_all(r"^Sampling Freq\(Hz\) +(\S+) ?Hz", text)[0])
    seconds = float(_all(r"^Duration Time\(s\) +(\S+)", text)[0])
    peak = _all(r"^Max\. Acc\. \(gal\) +(\S+)", text)[0]
    return [Stated(round(rate * seconds), 1.0 / rate, abs(float(peak)), _unit_of(peak))]


def _cwa(text: str) -> list[Stated]:
    rate, seconds = (
        float(_all(r"SampleRate\(Hz\): +(\S+)", text)[0]),
        float(_all(r"RecordLength\(sec\): +(\S+)", text)[0]),
    )
    found = []
    for name in "UNE":
        both = re.findall(r"-?\d+\.\d+", _all(rf"^#AmplitudeMAX\. {name}:(.*)", text)[0])
        peak = max(abs(float(word)) for word in both)
        found.append(Stated(round(rate * seconds), 1.0 / rate, peak, max(map(_unit_of, both))))
    return found


def _geonet(text: str) -> list[Stated]:
    counts = _all(r"^Number of points +(\d+)", text)
    steps = _all(r"^Instrument corrected data at +(\S+)", text)
    peaks = _all(r"^Acceleration: +peak +(\S+)", text)
    rows = zip(counts, steps, peaks, strict=True)
    return [Stated(int(n), float(step), abs(float(peak)), _unit_of(peak)) for n, step, peak in rows]


def _usc(text: str) -> list[Stated]:
    lines = text.split("\n")
    starts = [k for k, line in enumerate(lines) if re.match(r"\W*FILE\s+\d+ OF UNCORRECTED", line, re.IGNORECASE)]
    return [Stated(int(_columns_of(lines[start + 13 : start + 20], 5)[27]), None) for start in starts]


def _geonet_v1(text: str) -> list[Stated]:
    counts = _all(r"^Number of points +(\d+)", text)
    steps = _all(r"^Raw readings .* at +intervals +of +(\S+) +s", text)
    peaks = _all(r"^Acceleration: +peak +(\S+)", text)
    rows = zip(counts, steps, peaks, strict=True)
    return [Stated(int(n), float(step), abs(float(peak)), _unit_of(peak)) for n, step, peak in rows]


def _csmnc(text: str) -> list[Stated]:
    peak = _all(r"^PEAK VALUE: *(\S+)", text)[0]
    count, step = _all(r"^NO\. OF POINTS: *(\d+)", text)[0], _all(r"INTERVALS OF: *(\S+)", text)[0]
    return [Stated(int(count), float(step), abs(float(peak)), _unit_of(peak))]


def _nsmn(text: str) -> list[Stated]:
    count, step = _all(r"^NUMBER OF DATA *: *(\d+)", text)[0], _all(r"^SAMPLING INTERVAL \(sec\) *: *(\S+)", text)[0]
    line = _all(r"PGA VALUES \(gal\) *:(.*)", text)[0]
    return [Stated(int(count), float(step), abs(float(peak)), _unit_of(peak)) for peak in _all(r"\)\s*(\S+)", line)]


def _unam(text: str) -> list[Stated]:
    peaks, steps, counts = (
        _all(rf"^{key}[^:\n]*: */(.*)", text)[0].split("/")
        for key in (r"ACEL\. MAX\.\(Gal\)", "INTERVALO DE MUESTREO, C1", r"NUM\. TOTAL DE MUESTRAS, C1")
    )
    rows = zip(counts, steps, peaks, strict=True)
    return [Stated(int(n), float(step), abs(float(peak)), _unit_of(peak.strip())) for n, step, peak in rows]


def _itaca(text: str) -> list[Stated]:
    peak = _all(r"^PGA \(m/s/s\) *: *(\S+)", text)[0]
    count, step = _all(r"^Number of Data *: *(\d+)", text)[0], _all(r"^Time Increment \(s\) *: *(\S+)", text)[0]
    return [Stated(int(count), float(step), abs(float(peak)), _unit_of(peak))]


def _csn(text: str) -> list[Stated]:
    rate = float(_all(r"^# *Tasa de muestreo: *(\S+)", text)[0])
    counts = _all(r"^# *N\S*mero de muestras: *(\S+)", text)
    rows = [line for line in text.split("\n") if line.strip() and not line.startswith("#")]
    return [Stated(int(counts[0]) if counts else len(rows), 1.0 / rate)]


def _slist(text: str) -> list[Stated]:
    counts, rates = _all(r"^TIMESERIES [^,]*, (\d+) samples", text), _all(r" samples, (\S+) sps", text)
    return [Stated(int(n), 1.0 / float(rate)) for n, rate in zip(counts, rates, strict=True)]


def _eqsig(text: str) -> list[Stated]:
    count, step = re.findall(r"^\s*(\d+)[\s,]+(\d*\.\S+)[\s,]*$", text, re.MULTILINE)[0]
    return [Stated(int(count), float(step))]


def _bhrc(text: str) -> list[Stated]:
    counts, seconds = _all(r"^NO\. OF POINTS = +(\d+)", text), _all(r"DURATION = +(\S+)", text)
    return [Stated(int(n), None) for n, _ in zip(counts, seconds, strict=True)]


HEADERS: dict[str, Callable[[str], list[Stated]]] = {
    "peer": _peer,
    "esm": _esm,
    "cosmos": _cosmos,
    "csmip-v1": _csmip_v1,
    "csmip-v2": _csmip_v2,
    "smc-usgs": _smc,
    "smc-boore": _smc,
    "knet": _knet,
    "cwa": _cwa,
    "geonet-v2a": _geonet,
    "bhrc": _bhrc,
    "usc": _usc,
    "geonet-v1a": _geonet_v1,
    "csmnc": _csmnc,
    "nsmn": _nsmn,
    "unam": _unam,
    "itaca": _itaca,
    "csn": _csn,
    "slist": _slist,
    "eqsig": _eqsig,
}
