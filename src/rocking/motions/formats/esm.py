"""ESM, European strong-motion database: DYNA 1.2 ASCII, 64 lines of ``KEY: value`` and one value per line."""

import re
from typing import ClassVar

from rocking.conventions import FloatArray
from rocking.motions.formats import headers
from rocking.motions.formats.numbers import free, number, whole
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

_KEY = re.compile(r"([A-Z][A-Z0-9_/^]*):(?:\s(.*))?")
_MOST_KEYS = 200
_UNITS = {"cm/s^2": "cm/s2", "cm/s2": "cm/s2", "m/s^2": "m/s2", "mm/s^2": "mm/s2", "g": "g", "mg": "mg", "gal": "gal"}
_PEAKS = {
    "cm/s2": "PGA_CM/S^2",
    "gal": "PGA_CM/S^2",
    "m/s2": "PGA_M/S^2",
    "mm/s2": "PGA_MM/S^2",
    "g": "PGA_G",
    "mg": "PGA_MG",
}
_KEPT = {
    "event": "EVENT_NAME",
    "station": "STATION_CODE",
    "station name": "STATION_NAME",
    "network": "NETWORK",
    "channel": "STREAM",
    "event date": "EVENT_DATE_YYYYMMDD",
    "event time": "EVENT_TIME_HHMMSS",
    "magnitude Mw": "MAGNITUDE_W",
    "magnitude ML": "MAGNITUDE_L",
    "epicentral distance km": "EPICENTRAL_DISTANCE_KM",
    "processing": "PROCESSING",
    "filter": "FILTER_TYPE",
    "low cut Hz": "LOW_CUT_FREQUENCY_HZ",
    "high cut Hz": "HIGH_CUT_FREQUENCY_HZ",
    "baseline": "BASELINE_CORRECTION",
}
# keys of DYNA 1.2 in order; unknown values are empty
# fmt: off
_KEYS = (
    "EVENT_NAME", "EVENT_ID", "EVENT_DATE_YYYYMMDD", "EVENT_TIME_HHMMSS", "EVENT_LATITUDE_DEGREE",
    "EVENT_LONGITUDE_DEGREE", "EVENT_DEPTH_KM", "HYPOCENTER_REFERENCE", "MAGNITUDE_W", "MAGNITUDE_W_REFERENCE",
    "MAGNITUDE_L", "MAGNITUDE_L_REFERENCE", "FOCAL_MECHANISM", "NETWORK", "STATION_CODE", "STATION_NAME",
    "STATION_LATITUDE_DEGREE", "STATION_LONGITUDE_DEGREE", "STATION_ELEVATION_M", "LOCATION", "SENSOR_DEPTH_M",
    "VS30_M/S", "SITE_CLASSIFICATION_EC8", "MORPHOLOGIC_CLASSIFICATION", "EPICENTRAL_DISTANCE_KM",
    "EARTHQUAKE_BACKAZIMUTH_DEGREE", "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS", "DATE_TIME_FIRST_SAMPLE_PRECISION",
    "SAMPLING_INTERVAL_S", "NDATA", "DURATION_S", "STREAM", "UNITS", "INSTRUMENT", "INSTRUMENT_ANALOG/DIGITAL",
    "INSTRUMENTAL_FREQUENCY_HZ", "INSTRUMENTAL_DAMPING", "FULL_SCALE_G", "N_BIT_DIGITAL_CONVERTER", "PGA_CM/S^2",
    "TIME_PGA_S", "BASELINE_CORRECTION", "FILTER_TYPE", "FILTER_ORDER", "LOW_CUT_FREQUENCY_HZ",
    "HIGH_CUT_FREQUENCY_HZ", "LATE/NORMAL_TRIGGERED", "DATABASE_VERSION", "HEADER_FORMAT", "DATA_TYPE",
    "PROCESSING", "DATA_TIMESTAMP_YYYYMMDD_HHMMSS", "DATA_LICENSE", "DATA_CITATION", "DATA_CREATOR",
    "ORIGINAL_DATA_MEDIATOR_CITATION", "ORIGINAL_DATA_MEDIATOR", "ORIGINAL_DATA_CREATOR_CITATION",
    "ORIGINAL_DATA_CREATOR", "USER1", "USER2", "USER3", "USER4", "USER5",
)
# fmt: on


class Esm(RecordFormat):
    """ESM / ITACA ASCII files with a DYNA 1.2 header."""

    name: ClassVar[str] = "esm"
    title: ClassVar[str] = "ESM ASCII (DYNA 1.2), European strong-motion database"
    suffixes: ClassVar[tuple[str, ...]] = (".asc",)
    notes: ClassVar[str] = (
        "Verified with one real file of acceleration in cm/s^2. Count, duration, peak and time of the peak must match "
        "the header. The peak is required in the unit of the data. Only DATA_TYPE ACCELERATION is allowed."
    )

    def recognises(self, source: Source) -> bool:
        """Return True if the header has the keys of DYNA."""
        if not source.is_text or not source.lines[0].startswith("EVENT_NAME:"):
            return False
        head = [text.partition(":")[0] for text in source.lines[:_MOST_KEYS]]
        return "NDATA" in head or "SAMPLING_INTERVAL_S" in head

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record with one component, named by its stream, such as HNN."""
        keys = _header(source)
        line, kind = _value(source, keys, "DATA_TYPE")
        if kind.upper() != "ACCELERATION":
            raise source.error(
                line,
                "DATA_TYPE must be ACCELERATION, got {quantity!r}; use the .ACC. file",
                quantity=kind[:40],
            )
        step = headers.step_between_samples(source, _number(source, keys, "SAMPLING_INTERVAL_S"), time_step)
        line, word = _value(source, keys, "NDATA")
        count = whole(source, line, word, "number of samples", 2)
        line, word = _value(source, keys, "UNITS")
        if word.lower() not in _UNITS:
            raise source.error(
                line, "UNITS must be one of {units}, found {unit!r}", units=", ".join(_UNITS), unit=word[:40]
            )
        unit = headers.acceleration_unit(source, _UNITS[word.lower()], units)
        values = free(source, len(keys), len(source.lines), 1)[:, 0]
        headers.check_count(source, count, values.size)
        peak = _check_peaks(source, keys, values, step, unit)
        metadata = metadata_of(**{name: keys[key][1] for name, key in _KEPT.items() if key in keys})
        component = Component(metadata.get("channel", "acceleration"), values, unit, step, peak)
        return Record(self.name, (component,), "\n".join(source.lines[: len(keys)]), metadata)

    def write(self, record: Record) -> bytes:
        """Return the content of an ESM file, in cm/s^2 with 6 decimals."""
        (values,) = headers.in_unit(record, self.name, "cm/s2", 1)
        values = values.round(6)
        component = record.components[0]
        largest = int(abs(values).argmax())
        stated = {
            **{key: record.text(name, 200) for name, key in _KEPT.items()},
            "SAMPLING_INTERVAL_S": f"{component.time_step:.9f}",
            "NDATA": str(values.size),
            "DURATION_S": f"{values.size * component.time_step:.6f}",
            "STREAM": one_line(component.name, 40),
            "UNITS": "cm/s^2",
            "PGA_CM/S^2": f"{values[largest]:.6f}",
            "TIME_PGA_S": f"{largest * component.time_step:.6f}",
            "HEADER_FORMAT": "DYNA 1.2",
            "DATA_TYPE": "ACCELERATION",
        }
        lines = [f"{key}: {stated.get(key, '')}" for key in _KEYS] + [f"{value:.6f}" for value in values]
        return ("\n".join(lines) + "\n").encode("latin-1")


def _header(source: Source) -> dict[str, tuple[int, str]]:
    keys: dict[str, tuple[int, str]] = {}
    for line, text in enumerate(source.lines[:_MOST_KEYS] if source.is_text else []):
        match = _KEY.fullmatch(text.rstrip())
        if match is None:
            break
        if match[1] in keys:
            raise source.error(line, "{key} appears twice", key=match[1])
        keys[match[1]] = (line, (match[2] or "").strip())
    if not keys:
        raise source.error(0, "header lines KEY: value expected")
    if keys.get("HEADER_FORMAT", (0, ""))[1] == "DYNA 1.2" and len(keys) != len(_KEYS):
        raise source.error(
            len(keys), "{expected} header lines KEY: value expected for DYNA 1.2, found {count}", expected=len(_KEYS),
            count=len(keys),
        )  # fmt: skip
    return keys


def _value(source: Source, keys: dict[str, tuple[int, str]], key: str) -> tuple[int, str]:
    if key not in keys:
        raise source.error(None, "header line {key} is missing", key=key)
    return keys[key]


def _number(source: Source, keys: dict[str, tuple[int, str]], key: str) -> float | None:
    line, word = keys.get(key, (0, ""))
    return number(source, line, word, key) if word else None


def _check_peaks(source: Source, keys: dict[str, tuple[int, str]], values: FloatArray, step: float, unit: str) -> float:
    duration = _number(source, keys, "DURATION_S")
    if duration is not None:
        digits = len(keys["DURATION_S"][1].partition(".")[2])
        headers.check_duration(source, duration, values.size, step, min(0.005, 0.5 * 10.0**-digits))
    # this line is required, because only this line confirms the unit
    label = _PEAKS[unit]
    _, word = _value(source, keys, label)
    peak = _number(source, keys, label)
    if peak is None:
        raise source.error(keys[label][0], "{key} must contain a number, which confirms unit and data", key=label)
    # the peak has 6 decimals, as the data; a peak with fewer than 3 decimals is not checked
    rounding = min(1.1e-3, 1.1 * 10.0 ** -len(word.partition(".")[2]))
    headers.check_peak(source, peak, values, rounding, label)
    peak_time = _number(source, keys, "TIME_PGA_S")
    if peak_time is not None:
        headers.check_peak_time(source, peak_time, values, step, rounding)
    return abs(peak)
