"""SAC, a binary format of seismology, read with ObsPy.

SAC files contain no unit, so that the user must state the unit. The reader was verified with one file of the 2019
Ridgecrest earthquake.
"""

import math
import struct
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import RecordError, extra
from rocking.motions.formats import directions, headers
from rocking.motions.formats.foreign import ForeignReader
from rocking.motions.formats.record import Component, Record, RecordFormat, Source

_HEADER = 632  # bytes
_UNDEFINED = -12345.0
_VERSIONS = (6, 7)
_TIME_SERIES = 1
_OTHER = {6: "displacement", 7: "velocity"}
_PLACES = {"stla": (124, 90.0), "stlo": (128, 360.0), "evla": (140, 90.0), "evlo": (144, 360.0)}  # bytes, degrees


class Sac(RecordFormat):
    """SAC, evenly spaced time series."""

    name: ClassVar[str] = "sac"
    title: ClassVar[str] = "SAC, binary, version 6 or 7"
    suffixes: ClassVar[tuple[str, ...]] = (".sac",)
    unit_is_free: ClassVar[bool] = True
    states_unit: ClassVar[bool] = False
    notes: ClassVar[str] = "SAC files contain no unit: add units=. Counts are not accelerations. ObsPy is required."

    def recognises(self, source: Source) -> bool:
        """Return True if the file has the version and the logical fields of a SAC header."""
        return _byte_order(source) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        order = _byte_order(source)
        if order is None:
            raise source.error(None, "not a SAC file of version 6 or 7")
        # ObsPy reduces longitudes in steps of 360 degrees, which is slow for large values
        for quantity, (offset, most) in _PLACES.items():
            value = struct.unpack_from(order + "f", source.content, offset)[0]
            if value != _UNDEFINED and not abs(value) <= most:
                raise source.error(
                    None, "{quantity} in the header must be within {most:g} degrees of 0, found {degrees:g}",
                    quantity=quantity, most=most, degrees=value,
                )  # fmt: skip
        trace = read_traces(source, "SAC", checksize=True)[0]
        sac = trace.sac
        own = str(sac.get("kuser0", "")).strip()
        unit = headers.acceleration_unit(source, own if own in ACCELERATION_UNITS else None, units)
        if sac.get("iftype") != _TIME_SERIES or not sac.get("leven"):
            raise source.error(None, "an evenly spaced time series is required")
        if sac.get("idep") in _OTHER:
            raise source.error(
                None, "accelerations required, but the file contains {quantity}", quantity=_OTHER[sac["idep"]]
            )
        values = trace.samples.astype(np.float64)
        headers.check_count(source, int(sac["npts"]), values.size)
        if values.size < 2 or not np.isfinite(values).all():
            raise source.error(None, "at least 2 finite samples required, found {count}", count=values.size)
        step = headers.step_between_samples(source, _step(float(sac["delta"])), time_step)
        limits = {key: float(sac.get(key, _UNDEFINED)) for key in ("b", "e", "depmin", "depmax")}
        if not all(math.isfinite(value) for value in limits.values()):
            raise source.error(None, "the header contains numbers that are not finite")
        if _UNDEFINED not in {limits["b"], limits["e"]}:
            headers.check_duration(source, limits["e"] - limits["b"], values.size, step, 1e-6 * abs(limits["e"]) + 1e-4)
        for key, computed in (("depmax", float(values.max())), ("depmin", float(values.min()))):
            if limits[key] != _UNDEFINED:
                headers.check_stated(source, limits[key], computed, 1e-6 * abs(computed), key)
        peak = max(abs(limits["depmax"]), abs(limits["depmin"]))
        stated = None if _UNDEFINED in {limits["depmax"], limits["depmin"]} else peak
        name = trace.about["channel"] or "unnamed"
        headers.doubt_channel(source, name)
        side = {directions.KEY: directions.as_text(_direction(name, sac))}
        return Record(self.name, (Component(name, values, unit, step, stated, side),), trace.header, trace.about)

    def write(self, record: Record) -> bytes:
        """Return a SAC file in the unit of the component. The header field kuser0 contains the unit."""
        (values,) = headers.in_unit(record, self.name, None, 1)
        if np.abs(values).max() > 1e37:
            raise RecordError(
                "SAC allows accelerations below 1e37, got {largest:g}", largest=float(np.abs(values).max()),
                hint="check the unit",
            )  # fmt: skip
        component = record.components[0]
        trace = trace_of(values.astype(np.float32), component, record)
        trace.stats.sac = {"kuser0": component.unit}
        content = BytesIO()
        trace.write(content, format="SAC")
        return content.getvalue()


def _step(delta: float) -> float:
    """Return the step of a single-precision number [s]: for a whole number of samples/s, or with seven digits.

    >>> _step(0.0199999996), _step(0.0166666675) == 1.0 / 60.0, _step(0.0320000015)
    (0.02, True, 0.032)
    """
    rate = round(1.0 / delta) if delta > 0.0 else 0
    return 1.0 / rate if rate and abs(rate * delta - 1.0) < 1.2e-7 else float(f"{delta:.7g}")


def _direction(name: str, sac: dict[str, Any]) -> directions.Direction:
    """Return the direction from the code of the channel and, if stated, from the angles of the sensor."""
    azimuth, from_up = (float(sac.get(key, _UNDEFINED)) for key in ("cmpaz", "cmpinc"))
    if from_up == _UNDEFINED:
        return directions.orientation(name)
    stated_azimuth = None if azimuth == _UNDEFINED else azimuth
    return directions.both(directions.orientation(name), directions.of_angles(stated_azimuth, from_up))


def _byte_order(source: Source) -> str | None:
    """Return the byte order of the header; None for other files."""
    if len(source.content) < _HEADER:
        return None
    for order in "<>":
        version, even, own = (struct.unpack_from(order + "i", source.content, offset)[0] for offset in (304, 420, 432))
        if version in _VERSIONS and even in {0, 1} and own in {0, 1, int(_UNDEFINED)}:
            return order
    return None


@dataclass(frozen=True)
class Trace:
    """A trace as read by ObsPy."""

    id: str  # network, station, location and channel in one word
    text: str  # summary in one line
    step: float  # step between samples [s]
    about: dict[str, str]  # network, station, location, channel and time of the first sample
    sac: dict[str, Any]  # header of a SAC file
    header: str  # header of a SAC file as text
    # matching channels of StationXML files (file, location, dates, rate, sensitivity, angles); None without files
    channels: list[dict[str, Any]] | None
    samples: Any  # samples of the file


OBSPY = ForeignReader(Path(__file__).with_name("obspy_reader.py"), "ObsPy", "obspy")


def read_traces(source: Source, form: str, stations: Sequence[Source] = (), **options: Any) -> list[Trace]:
    """Return the traces of a file, read by ObsPy in a separate process.

    Warnings of ObsPy become warnings of the source.
    """
    if find_spec("obspy") is None:
        need_obspy(form)
    files = [source.content, *(station.content for station in stations)]
    answer, arrays = OBSPY.answer(source, {"format": form, "options": options}, *files)
    check_stations(answer, stations)
    for warning in answer.get("warnings", ()):
        source.doubt(None, f"ObsPy warns: {warning}")
    if not answer["traces"]:
        raise source.error(None, "no trace in this {format} file", format=form)
    for description, samples in zip(answer["traces"], arrays, strict=True):
        if samples.dtype.kind not in "iuf":
            raise source.error(None, "{channel} contains text, not samples", channel=description["id"])
    return [
        Trace(**description, samples=samples) for description, samples in zip(answer["traces"], arrays, strict=True)
    ]


def check_stations(answer: dict[str, Any], stations: Sequence[Source]) -> None:
    """Raise an error for a StationXML file that ObsPy cannot read."""
    if "stations" in answer:
        raise stations[answer["file_index"]].error(
            None, "ObsPy cannot read the file as StationXML: {reason}", reason=answer["stations"]
        )


def need_obspy(form: str) -> Any:
    """Return the module ObsPy, or raise an error if it is not installed."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return extra("obspy", f"reading {form}")


def trace_of(values: Any, component: Component, record: Record) -> Any:
    """Return an ObsPy trace of a component, for writers."""
    obspy = need_obspy("SAC and miniSEED")
    trace = obspy.Trace(data=values)
    trace.stats.delta = component.time_step
    trace.stats.network = str(record.metadata.get("network", ""))[:2]
    trace.stats.station = str(record.metadata.get("station", ""))[:5]
    trace.stats.channel = component.name[:3]
    return trace
