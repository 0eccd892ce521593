"""The exchange format of seismology, miniSEED, read with ObsPy.

The files contain counts of the recorder. StationXML files convert them to m/s2 with the overall sensitivity of the
channel. The mean, the offset of the recorder (0.02 g in the test file), is removed first. The frequency dependence of
the response is not removed. The sensitivity is not valid above the corner frequency of the sensor. The reader was
verified with one channel of the 2019 Ridgecrest earthquake.
"""

import re
import struct
from collections.abc import Sequence
from io import BytesIO
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.messages import Message, Option
from rocking.motions.formats import directions, headers
from rocking.motions.formats.record import Component, Record, RecordFormat, Source
from rocking.motions.formats.sac import Trace, need_obspy, read_traces, trace_of
from rocking.motions.formats.stations import Places, channel_at, sensitivity_of, station_sources

_HEAD = re.compile(rb"\d{6}[DRQM][ \0](.{5})")  # start of a record and station code
_ENCODING = 1000
"""Number of the blockette with the encoding and the record length (SEED Reference Manual, version 2.4)."""
_SI = "SI"
"""Location code for real numbers in m/s2 in files of this package. No known network uses this code."""
STATIONS = Message(
    "add the StationXML file of the station or a folder of such files with {process}, or use a folder with the record "
    "and its StationXML file",
    {"process": Option("motion.process", "response:stations=FILE.xml")},
)
"""Hint about the conversion of counts to accelerations."""

_MIN_BITS = {0: 8.0, 1: 16.0, 2: 24.0, 3: 32.0, 4: 32.0, 5: 64.0, 10: 8.0, 11: 32.0 / 7.0, 19: 8.0}
"""Smallest number of bits per sample by encoding: text, integers, real numbers, Steim 1, 2 and 3."""


class MiniSeed(RecordFormat):
    """The miniSEED format, with the overall sensitivity of an optional StationXML file."""

    name: ClassVar[str] = "miniseed"
    title: ClassVar[str] = "miniSEED, version 2"
    suffixes: ClassVar[tuple[str, ...]] = (".mseed", ".miniseed", ".ms")
    states_unit: ClassVar[bool] = False
    notes: ClassVar[str] = (
        "Integers are counts: a StationXML file converts them to m/s2, and their offset is removed. Real numbers may "
        "be accelerations: add units=; files of this package are in m/s2, with the location code SI. Files with gaps "
        "or overlaps raise an error. ObsPy is required."
    )

    def __init__(self) -> None:
        self._stations: Places | None = None

    @classmethod
    def with_response(cls, stations: Places) -> "MiniSeed":
        """Return a reader that converts counts to m/s2 with the overall sensitivity of the channel.

        Stations are StationXML files, or folders of them.
        """
        reader = cls()
        reader._stations = stations
        return reader

    def recognises(self, source: Source) -> bool:
        """Return True if the file begins with a miniSEED record."""
        return re.match(rb"\d{6}[DRQM][ \0]", source.content) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        if not self.recognises(source):
            raise source.error(None, "no miniSEED file of version 2")
        _check_room(source)
        stations: list[Source] = []
        if self._stations is not None:
            station_codes = {code.decode("latin-1").strip() for code in _HEAD.findall(source.content)}
            stations = station_sources(self._stations, station_codes)
        traces = read_traces(source, "MSEED", stations)
        ids = [trace.id for trace in traces]
        if len(set(ids)) != len(ids):
            twice = next(name for name in ids if ids.count(name) > 1)
            raise source.error(
                None,
                "channel {channel} has a gap, an overlap or a change of rate; remove this section first",
                channel=twice,
            )
        codes = [trace.about["channel"] for trace in traces]
        names = codes if len(set(codes)) == len(codes) else ids
        components = tuple(
            _component(source, trace, stations, name or "unnamed", units, time_step)
            for trace, name in zip(traces, names, strict=True)
        )
        metadata = {key: traces[0].about[key] for key in ("network", "station", "starttime")}
        header = "\n".join(trace.text for trace in traces)
        return Record(self.name, components, header, {key: text for key, text in metadata.items() if text})

    def write(self, record: Record) -> bytes:
        """Return a miniSEED file of real numbers in m/s2, with the location code of this unit."""
        rows = headers.in_unit(record, self.name, "m/s2", 100)
        codes = [component.name[:3] for component in record.components]
        if len(set(codes)) != len(codes):
            raise RecordError(
                "components need different channel codes of 3 letters, got {codes}", codes=", ".join(codes)[:60]
            )
        obspy = need_obspy("miniSEED")
        pairs = zip(rows, record.components, strict=True)
        stream = obspy.Stream([trace_of(values, component, record) for values, component in pairs])
        for trace in stream:
            trace.stats.location = _SI
        content = BytesIO()
        stream.write(content, format="MSEED", encoding="FLOAT64")
        return content.getvalue()


def _check_room(source: Source) -> None:
    """Raise an error for records whose number of samples exceeds their space; ObsPy would read past the end."""
    content, position = source.content, 0
    while position + 48 <= len(content):
        order = ">" if 1900 <= struct.unpack_from(">H", content, position + 20)[0] <= 2100 else "<"
        count, start, blockette = struct.unpack_from(f"{order}H12xHH", content, position + 30)
        kind = 0
        while kind != _ENCODING and 48 <= blockette <= len(content) - position - 8:
            offset = position + blockette
            kind, blockette, encoding, length = struct.unpack_from(f"{order}HHBxB", content, offset)
        if kind != _ENCODING or not 7 <= length <= 20:
            return
        bits = _MIN_BITS.get(encoding, 16.0)
        most = int(max((1 << length) - start, 0) * 8 / bits)
        if count > most:
            raise source.error(
                None, "the record at byte {byte} states {count} samples, but has space for {most}; the file is damaged",
                byte=position, count=count, most=most,
            )  # fmt: skip
        position += 1 << length


def _component(
    source: Source, trace: Trace, stations: Sequence[Source], name: str, units: str | None, requested_step: float | None
) -> Component:
    values: FloatArray = trace.samples.astype(np.float64)
    if values.size < 2 or not np.isfinite(values).all():
        raise source.error(
            None, "{channel}: at least 2 finite samples required, found {count}", channel=trace.id, count=values.size
        )
    step = headers.step_between_samples(source, trace.step, requested_step)
    about = {key: text for key, text in trace.about.items() if text}
    side = directions.orientation(trace.about["channel"])
    if trace.channels is None:
        if trace.samples.dtype.kind in "iu":
            raise source.error(None, "{channel} contains counts, not accelerations", channel=trace.id, hint=STATIONS)
        headers.doubt_channel(source, trace.about["channel"])
        stated = "m/s2" if trace.id.split(".")[2:3] == [_SI] else None
        about[directions.KEY] = directions.as_text(side)
        return Component(name, values, headers.acceleration_unit(source, stated, units), step, None, about)
    unit = headers.acceleration_unit(source, "m/s2", units)
    channel, described_in = channel_at(source, trace.channels, stations, trace.id, trace.about["starttime"])
    sensitivity = sensitivity_of(source, channel, trace.id)
    if abs(channel["rate"] * trace.step - 1.0) > 1e-4:
        raise source.error(
            None, "{channel}: {rate:g} samples/s in the file, but {stated:g} in the StationXML", channel=trace.id,
            rate=1 / trace.step, stated=channel["rate"],
        )  # fmt: skip
    if channel["dip"] is not None:  # the dip is the angle downwards from horizontal
        side = directions.both(side, directions.of_angles(channel["azimuth"], 90.0 + channel["dip"]))
    offset = float(values.mean())
    about |= {
        directions.KEY: directions.as_text(side),
        "sensitivity": f"{sensitivity:.9g} counts/(m/s2)",
        "stations": f"{described_in.name}, SHA-256 {described_in.sha256}",
        "processing": "mean of the record removed, divided by the overall sensitivity",
        "mean removed": f"{offset:.9g} counts",
    }
    return Component(name, (values - offset) / sensitivity, unit, step, None, about)
