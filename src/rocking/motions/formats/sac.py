"""SAC, the binary format of seismology, through ObsPy.

SAC says nothing of its unit, so the user must. Checked on one file of the 2019 Ridgecrest earthquake.
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
    states_unit: ClassVar[bool] = False
    notes: ClassVar[str] = "SAC states no unit: say units=. Counts are no accelerations. It needs ObsPy."

    def recognises(self, source: Source) -> bool:
        """Return whether the version and the logical fields of a SAC header stand at their places."""
        return _byte_order(source) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        order = _byte_order(source)
        if order is None:
            raise source.error(None, "no SAC file of version 6 or 7")
        # ObsPy turns longitudes back by 360 degrees at a time, however large
        for place, (offset, most) in _PLACES.items():
            value = struct.unpack_from(order + "f", source.content, offset)[0]
            if value != _UNDEFINED and not abs(value) <= most:
                raise source.error(
                    None, "the header's {quantity} must be within {most:g} degrees of 0, found {degrees:g}",
                    quantity=place, most=most, degrees=value,
                )  # fmt: skip
        trace = read_traces(source, "SAC", checksize=True)[0]
        said = trace.sac
        own = str(said.get("kuser0", "")).strip()
        unit = headers.acceleration_unit(source, own if own in ACCELERATION_UNITS else None, units)
        if said.get("iftype") != _TIME_SERIES or not said.get("leven"):
            raise source.error(None, "an evenly spaced time series is needed")
        if said.get("idep") in _OTHER:
            raise source.error(
                None, "accelerations are needed, the file holds {quantity}", quantity=_OTHER[said["idep"]]
            )
        values = trace.samples.astype(np.float64)
        headers.check_count(source, int(said["npts"]), values.size)
        if values.size < 2 or not np.isfinite(values).all():
            raise source.error(None, "at least 2 finite samples are needed, found {count}", count=values.size)
        step = headers.step_between_samples(source, _step(float(said["delta"])), time_step)
        known = {key: float(said.get(key, _UNDEFINED)) for key in ("b", "e", "depmin", "depmax")}
        if not all(math.isfinite(value) for value in known.values()):
            raise source.error(None, "the header holds numbers that are not finite")
        if _UNDEFINED not in {known["b"], known["e"]}:
            headers.check_duration(source, known["e"] - known["b"], values.size, step, 1e-6 * abs(known["e"]) + 1e-4)
        for key, found in (("depmax", float(values.max())), ("depmin", float(values.min()))):
            if known[key] != _UNDEFINED:
                headers.check_stated(source, known[key], found, 1e-6 * abs(found), key)
        peak = max(abs(known["depmax"]), abs(known["depmin"]))
        stated = None if _UNDEFINED in {known["depmax"], known["depmin"]} else peak
        name = trace.about["channel"] or "unnamed"
        headers.doubt_channel(source, name)
        side = {directions.KEY: directions.as_text(_direction(name, said))}
        return Record(self.name, (Component(name, values, unit, step, stated, side),), trace.header, trace.about)

    def write(self, record: Record) -> bytes:
        """Return a SAC file, in the unit of the component, which stands in the header's first text of the user."""
        (values,) = headers.in_unit(record, self.name, None, 1)
        if np.abs(values).max() > 1e37:
            raise RecordError(
                "SAC holds accelerations below 1e37, got {largest:g}", largest=float(np.abs(values).max()),
                hint="wrong unit?",
            )  # fmt: skip
        part = record.components[0]
        trace = trace_of(values.astype(np.float32), part, record)
        trace.stats.sac = {"kuser0": part.unit}
        content = BytesIO()
        trace.write(content, format="SAC")
        return content.getvalue()


def _step(delta: float) -> float:
    """Return the step that single precision stands for [s]: that of a whole number of samples/s, or seven digits.

    >>> _step(0.0199999996), _step(0.0166666675) == 1.0 / 60.0, _step(0.0320000015)
    (0.02, True, 0.032)
    """
    rate = round(1.0 / delta) if delta > 0.0 else 0
    return 1.0 / rate if rate and abs(rate * delta - 1.0) < 1.2e-7 else float(f"{delta:.7g}")


def _direction(name: str, said: dict[str, Any]) -> directions.Direction:
    """Return the direction by the code of the channel, and by the angles of the sensor where they are stated."""
    azimuth, from_up = (float(said.get(key, _UNDEFINED)) for key in ("cmpaz", "cmpinc"))
    if from_up == _UNDEFINED:
        return directions.orientation(name)
    known = None if azimuth == _UNDEFINED else azimuth
    return directions.both(directions.orientation(name), directions.of_angles(known, from_up))


def _byte_order(source: Source) -> str | None:
    """Return the byte order in which the header makes sense, None if it makes none."""
    if len(source.content) < _HEADER:
        return None
    for order in "<>":
        version, even, own = (struct.unpack_from(order + "i", source.content, at)[0] for at in (304, 420, 432))
        if version in _VERSIONS and even in {0, 1} and own in {0, 1, int(_UNDEFINED)}:
            return order
    return None


@dataclass(frozen=True)
class Trace:
    """What ObsPy finds in a file."""

    id: str  # id, text: network, station, location and channel in one word, and all in a line
    text: str
    step: float  # step between samples [s]
    about: dict[str, str]  # network, station, location, channel and time of the first sample
    sac: dict[str, Any]  # header of a SAC file
    header: str  # the same as text
    # channels of its codes in StationXML files: file, location, dates, rate, sensitivity, angles; None without files
    channels: list[dict[str, Any]] | None
    samples: Any  # as they stand in the file


OBSPY = ForeignReader(Path(__file__).with_name("obspy_reader.py"), "ObsPy", "obspy")


def read_traces(source: Source, form: str, stations: Sequence[Source] = (), **options: Any) -> list[Trace]:
    """Return the traces that ObsPy finds in a file, in a process of its own; its warnings are doubts of the file."""
    if find_spec("obspy") is None:
        need_obspy(form)
    files = [source.content, *(one.content for one in stations)]
    found, arrays = OBSPY.answer(source, {"format": form, "options": options}, *files)
    check_stations(found, stations)
    for warning in found.get("warnings", ()):
        source.doubt(None, f"ObsPy warns: {warning}")
    if not found["traces"]:
        raise source.error(None, "no trace in this {format} file", format=form)
    for said, samples in zip(found["traces"], arrays, strict=True):
        if samples.dtype.kind not in "iuf":
            raise source.error(None, "{channel} holds text, no samples", channel=said["id"])
    return [Trace(**said, samples=samples) for said, samples in zip(found["traces"], arrays, strict=True)]


def check_stations(found: dict[str, Any], stations: Sequence[Source]) -> None:
    """Refuse a StationXML file that ObsPy cannot read."""
    if "stations" in found:
        raise stations[found["file_index"]].error(
            None, "ObsPy cannot read it as StationXML: {reason}", reason=found["stations"]
        )


def need_obspy(form: str) -> Any:
    """Return ObsPy."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return extra("obspy", f"reading {form}")


def trace_of(values: Any, part: Component, record: Record) -> Any:
    """Return an ObsPy trace of a component, for writers."""
    obspy = need_obspy("SAC and miniSEED")
    trace = obspy.Trace(data=values)
    trace.stats.delta = part.time_step
    trace.stats.network = str(record.metadata.get("network", ""))[:2]
    trace.stats.station = str(record.metadata.get("station", ""))[:5]
    trace.stats.channel = part.name[:3]
    return trace
