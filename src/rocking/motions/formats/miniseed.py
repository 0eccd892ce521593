"""The exchange format of seismology, miniSEED, through ObsPy.

It holds counts of the recorder, which are no accelerations: a StationXML file, named by the user and never looked for,
turns them into m/s2 by the overall sensitivity of the channel, after their mean is removed: it is the recorder's offset
(0.02 g in the file that this was checked on). Whole responses are not removed: above the corner of the sensor the
sensitivity is no longer true. Checked on one channel of the 2019 Ridgecrest earthquake.
"""

import re
import struct
from io import BytesIO
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats import headers
from rocking.motions.formats.record import Component, Record, RecordFormat, Source
from rocking.motions.formats.sac import Trace, need_obspy, read_traces, trace_of

_ACCELERATION = frozenset({"M/S**2", "M/S/S", "M/(S**2)", "M/S^2"})
_COUNTS = frozenset({"COUNTS", "COUNT"})
_ENCODING = 1000
"""Blockette that says how samples are encoded, and how long a record is (SEED Reference Manual, version 2.4)."""
_SI = "SI"
"""Location code of real numbers in m/s2: what the format leaves to whoever writes, and no network is known to use."""
_LEAST_BITS = {0: 8.0, 1: 16.0, 2: 24.0, 3: 32.0, 4: 32.0, 5: 64.0, 10: 8.0, 11: 32.0 / 7.0, 19: 8.0}
"""Least number of bits that a sample takes, by encoding: text, whole numbers, real numbers, Steim 1, 2 and 3."""


class MiniSeed(RecordFormat):
    """The miniSEED format, with the overall sensitivity of a StationXML file if one is named."""

    name: ClassVar[str] = "miniseed"
    title: ClassVar[str] = "miniSEED, version 2"
    suffixes: ClassVar[tuple[str, ...]] = (".mseed", ".miniseed", ".ms")
    states_unit: ClassVar[bool] = False
    notes: ClassVar[str] = (
        "Whole numbers are counts: use MiniSeed.with_response(stationxml_path), which also removes the offset. "
        "Real numbers may be accelerations: say units=; those written here are in m/s2, which their location code SI "
        "says. Files with gaps or overlaps are refused. It needs ObsPy."
    )

    def __init__(self) -> None:
        self._stations: Source | None = None

    @classmethod
    def with_response(cls, stationxml_path: str | Path) -> "MiniSeed":
        """Return a reader that divides counts by the overall sensitivity of their channel: records in m/s2."""
        made = cls()
        made._stations = Source.of_path(Path(stationxml_path))
        return made

    def recognises(self, source: Source) -> bool:
        """Return whether a miniSEED record stands at the beginning."""
        return re.match(rb"\d{6}[DRQM][ \0]", source.content) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        if not self.recognises(source):
            raise source.error(None, "no miniSEED file of version 2")
        _check_room(source)
        traces = read_traces(source, "MSEED", self._stations)
        names = [trace.id for trace in traces]
        if len(set(names)) != len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise source.error(None, f"channel {twice} has a gap, an overlap or a change of rate; cut it out first")
        components = tuple(_component(source, trace, units, time_step) for trace in traces)
        metadata = {key: traces[0].about[key] for key in ("network", "station", "starttime")}
        header = "\n".join(trace.text for trace in traces)
        return Record(self.name, components, header, {key: text for key, text in metadata.items() if text})

    def write(self, record: Record) -> bytes:
        """Return a miniSEED file of real numbers in m/s2, which their location code says."""
        rows = headers.in_unit(record, self.name, "m/s2", 100)
        codes = [part.name[:3] for part in record.components]
        if len(set(codes)) != len(codes):
            raise RecordError(f"components need different channel codes of 3 letters, got {', '.join(codes)[:60]}")
        obspy = need_obspy("miniSEED")
        pairs = zip(rows, record.components, strict=True)
        stream = obspy.Stream([trace_of(values, part, record) for values, part in pairs])
        for trace in stream:
            trace.stats.location = _SI
        content = BytesIO()
        stream.write(content, format="MSEED", encoding="FLOAT64")
        return content.getvalue()


def _check_room(source: Source) -> None:
    """Refuse records that state more samples than they have room for: ObsPy reads on in whatever lies behind them."""
    content, at = source.content, 0
    while at + 48 <= len(content):
        order = ">" if 1900 <= struct.unpack_from(">H", content, at + 20)[0] <= 2100 else "<"
        count, start, blockette = struct.unpack_from(f"{order}H12xHH", content, at + 30)
        kind = 0
        while kind != _ENCODING and 48 <= blockette <= len(content) - at - 8:
            where = at + blockette
            kind, blockette, encoding, length = struct.unpack_from(f"{order}HHBxB", content, where)
        if kind != _ENCODING or not 7 <= length <= 20:
            return
        bits = _LEAST_BITS.get(encoding, 16.0)
        most = int(max((1 << length) - start, 0) * 8 / bits)
        if count > most:
            raise source.error(None, f"the record at byte {at} states {count} samples, it has room for {most}; damaged")
        at += 1 << length


def _component(source: Source, trace: Trace, units: str | None, asked: float | None) -> Component:
    values: FloatArray = trace.samples.astype(np.float64)
    if values.size < 2 or not np.isfinite(values).all():
        raise source.error(None, f"{trace.id}: at least 2 finite samples are needed, found {values.size}")
    step = headers.step_between_samples(source, trace.step, asked)
    name = trace.about["channel"] or "unnamed"
    if trace.channels is None:
        if trace.samples.dtype.kind in "iu":
            raise source.error(
                None, f"{trace.id} holds counts, no accelerations: use MiniSeed.with_response(stationxml_path)"
            )
        headers.doubt_channel(source, name)
        stated = "m/s2" if trace.id.split(".")[2:3] == [_SI] else None
        return Component(name, values, headers.acceleration_unit(source, stated, units), step)
    unit = headers.acceleration_unit(source, "m/s2", units)
    sensitivity = _sensitivity(source, trace, trace.channels)
    offset = float(values.mean())
    about = {
        "sensitivity": f"{sensitivity:.9g} counts/(m/s2)",
        "processing": "mean of the whole record removed, divided by the overall sensitivity",
        "mean removed": f"{offset:.9g} counts",
    }
    return Component(name, (values - offset) / sensitivity, unit, step, None, about)


def _sensitivity(source: Source, trace: Trace, channels: list[dict[str, Any]]) -> float:
    if len(channels) != 1:
        when = trace.about["starttime"]
        raise source.error(None, f"{trace.id} at {when}: the StationXML has {len(channels)} such channels")
    rate, total = channels[0]["rate"], channels[0]["sensitivity"]
    if not total:
        raise source.error(None, f"{trace.id}: the StationXML states no overall sensitivity; ask for level=response")
    before, after = (str(unit).upper().strip() for unit in total[1:])
    if before not in _ACCELERATION or after not in _COUNTS:
        raise source.error(None, f"{trace.id}: sensitivity from M/S**2 to counts needed, found {before} to {after}")
    if abs(rate * trace.step - 1.0) > 1e-4:
        raise source.error(None, f"{trace.id}: {1 / trace.step:g} samples/s, the StationXML states {rate:g}")
    value = float(total[0])
    if not 1e-12 < abs(value) < 1e15:
        raise InvalidValueError(f"{trace.id}: sensitivity must be within 1e-12 to 1e15 counts/(m/s2), got {value:g}")
    return value
