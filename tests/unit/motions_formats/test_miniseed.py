"""miniSEED through ObsPy: counts are no accelerations."""

import importlib.util
import io
import os
import random
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from station_files import channel, station_xml

from rocking.errors import InvalidValueError, MissingExtraError, RecordError
from rocking.motions.formats import Component, Record, RecordFormat, Source, formats

MINISEED = formats()["miniseed"]
WITHOUT = importlib.util.find_spec("obspy") is None
COPIES = max(1, int(os.environ.get("ROCKING_FUZZ", "2000")) // 10)
"""Damaged copies; fewer than of a text format, since ObsPy takes longer over each: 200 unless ROCKING_FUZZ is set."""
COUNTS = [1000, 3000, -1000, 1000, 2000, 0]  # mean 1000
STATIONS = station_xml(channel(gain=2000.0))


def recorded(*rows: Any, codes: tuple[str, ...] = ("HNE",), late: float = 0.0) -> Source:
    """A file that ObsPy writes, all rows from 1970 on or each later than the one before."""
    obspy = pytest.importorskip("obspy")
    stream = obspy.Stream()
    for k, row in enumerate(rows):
        trace = obspy.Trace(np.asarray(row))
        trace.stats.update({"network": "XX", "station": "ABC", "channel": codes[k % len(codes)], "delta": 0.01})
        trace.stats.starttime += k * late
        stream.append(trace)
    content = BytesIO()
    stream.write(content, format="MSEED")
    return Source("a.mseed", content.getvalue())


def reader(folder: Path, old: str = "", new: str = "") -> RecordFormat:
    path = folder / "stations.xml"
    path.write_text(STATIONS.replace(old, new) if old else STATIONS, encoding="utf-8")
    return type(MINISEED).with_response(path)


def test_recognition_needs_no_obspy() -> None:
    """Six digits and a quality letter begin a record; a number in a text does not."""
    assert MINISEED.recognises(Source("a", b"000001D XX".ljust(512, b"\0")))
    for content in (b"", b"000001", b"0000012 \n", b"12.345 D 1", b"Origin Time"):
        assert not MINISEED.recognises(Source("a", content))
    with pytest.raises(RecordError, match="no miniSEED"):
        MINISEED.read(Source("a", b"nothing of the kind"))


@pytest.mark.skipif(not WITHOUT, reason="ObsPy is installed")
def test_without_obspy_the_extra_is_named() -> None:
    """The error says what to install."""
    with pytest.raises(MissingExtraError, match=r'needs obspy: pip install "rocking\[obspy\]"'):
        MINISEED.read(Source("a", b"000001D XX".ljust(512, b"\0")))


def test_counts_alone_are_refused() -> None:
    """Also where the user gives them a unit."""
    source = recorded(np.array(COUNTS, dtype=np.int32))
    for units in (None, "m/s2", "gal"):
        with pytest.raises(RecordError, match="contains counts, not accelerations; add the StationXML file"):
            MINISEED.read(source, units=units)


def test_sensitivity_turns_counts_into_accelerations(tmp_path: Path) -> None:
    """(count - mean) / 2000 by hand, in m/s2; with the offset the peak would be 1.5 m/s2, not 1."""
    record = reader(tmp_path).read(recorded(np.array(COUNTS, dtype=np.int32)))
    (part,) = record.components
    np.testing.assert_allclose(part.acceleration, [0.0, 1.0, -1.0, 0.0, 0.5, -0.5], rtol=0.0, atol=1e-15)
    assert (part.name, part.unit, part.time_step) == ("HNE", "m/s2", 0.01)
    assert part.metadata["mean removed"] == "1000 counts"
    assert record.metadata["station"] == "ABC"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("M/S**2", "M/S", "M/S to COUNTS"),
        ("COUNTS", "V", "required, found"),
        ("HNE", "HNN", "do not describe this channel"),
        ("1960-01-01", "1999-01-01", "do not describe this channel"),
        ("<SampleRate>100.0", "<SampleRate>200.0", "but 200 in the StationXML"),
        ("<Value>2000.0", "<Value>0.0", "sensitivity must be within"),
        ("</Network>", "", "cannot read the file as StationXML"),
    ],
)
def test_responses_that_do_not_fit_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    """Unit, channel, epoch, rate and value of the sensitivity are checked."""
    with pytest.raises((RecordError, InvalidValueError), match=message):
        reader(tmp_path, old, new).read(recorded(np.array(COUNTS, dtype=np.int32)))


def test_gaps_and_overlaps_are_refused() -> None:
    """The second piece of a channel may start neither late nor early; at the right time it is joined."""
    row = np.linspace(-1.0, 1.0, 100)
    for late in (1.5, 0.5):
        with pytest.raises(RecordError, match=r"XX\.ABC\.\.HNE has a gap"):
            MINISEED.read(recorded(row, row, late=late), units="m/s2")
    (part,) = MINISEED.read(recorded(row, row, late=1.0), units="m/s2").components
    assert part.acceleration.size == 200


def test_real_numbers_come_back_in_their_unit() -> None:
    """Several channels are several components, in m/s2, which the file says; real numbers of others need a unit."""
    pytest.importorskip("obspy")
    given = Record("", tuple(Component(name, np.sin(np.arange(90.0) + k), "g", 0.005) for k, name in enumerate("ENZ")))
    source = Source("w", MINISEED.write(given))
    back = MINISEED.read(source)
    assert [part.name for part in back.components] == ["E", "N", "Z"]
    for part, other in zip(back.components, given.components, strict=True):
        assert part.unit == "m/s2"
        np.testing.assert_allclose(part.acceleration, 9.80665 * other.acceleration, rtol=1e-14)
    with pytest.raises(RecordError, match=", not g"):
        MINISEED.read(source, units="g")
    other = Source("w", source.content.replace(b"SI", b"00"))
    assert other.content != source.content
    with pytest.raises(RecordError, match="units="):
        MINISEED.read(other)
    assert not MINISEED.states_unit
    with pytest.raises(RecordError, match="channel codes"):
        MINISEED.write(Record("", given.components[:1] * 2))


@pytest.mark.parametrize("row", [[1.5], [1.0, np.nan, 2.0]])
def test_few_samples_and_infinite_ones_are_refused(row: list[float]) -> None:
    """One alone has no step; NaN is no acceleration."""
    with pytest.raises(RecordError, match="at least 2 finite samples required"):
        MINISEED.read(recorded(row), units="g", time_step=0.01)


def test_records_that_state_more_samples_than_they_hold_are_refused() -> None:
    """A damaged count would make ObsPy read on behind the record: 32537 samples of 300, or a crash."""
    content = bytearray(recorded(np.sin(np.arange(300.0))).content)
    assert MINISEED.read(Source("a", bytes(content)), units="g").components[0].acceleration.size == 300
    content[30] = 127
    with pytest.raises(RecordError, match="states 32556 samples, but has space for 505"):
        MINISEED.read(Source("a", bytes(content)), units="g")


@pytest.mark.parametrize(
    ("encoding", "room"),
    [(0, 4040), (1, 2020), (2, 1346), (3, 1010), (4, 1010), (5, 505), (10, 4040), (11, 7070), (19, 4040), (30, 2020)],
)
def test_room_by_encoding(encoding: int, room: int) -> None:
    """4096 bytes less 56 of headers hold as many: text, 16, 24, 32 bits, reals, Steim 1 to 3 at their closest."""
    content = bytearray(recorded(np.sin(np.arange(300.0))).content)
    content[52], content[30:32] = encoding, (room + 1).to_bytes(2, "big")
    with pytest.raises(RecordError, match=f"states {room + 1} samples, but has space for {room}"):
        MINISEED.read(Source("a", bytes(content)), units="g")


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("encoding", ["STEIM1", "STEIM2", "INT32", "INT16", "FLOAT32", "FLOAT64"])
def test_every_encoding_has_room(encoding: str, order: str) -> None:
    """The control: what ObsPy writes is read, also where zeros are packed as closely as they can be."""
    obspy = pytest.importorskip("obspy")
    kind = {"INT16": np.int16, "FLOAT32": np.float32, "FLOAT64": np.float64}.get(encoding, np.int32)
    content = BytesIO()
    obspy.Trace(np.zeros(5000, kind)).write(content, format="MSEED", encoding=encoding, byteorder=order)
    source = Source("a", content.getvalue())
    if kind in {np.float32, np.float64}:
        assert MINISEED.read(source, units="g").components[0].acceleration.size == 5000
    else:
        with pytest.raises(RecordError, match="contains counts"):
            MINISEED.read(source)


def test_text_is_refused() -> None:
    """A log in a miniSEED file holds no samples."""
    obspy = pytest.importorskip("obspy")
    content = BytesIO()
    obspy.Trace(np.frombuffer(b"clock locked", dtype="S1")).write(content, format="MSEED", encoding="ASCII")
    with pytest.raises(RecordError, match="contains text"):
        MINISEED.read(Source("a", content.getvalue()), units="g")


@pytest.mark.slow
def test_damaged_files_give_no_other_error() -> None:
    """Files with flipped bits or cut short are refused, or hold finite samples."""
    whole = recorded(np.sin(np.arange(300.0))).content
    chance = random.Random(2)
    for _ in range(COPIES):
        content = bytearray(whole)
        content[chance.randrange(len(content) if chance.random() < 0.3 else 64)] ^= 1 << chance.randrange(8)
        cut = chance.choice([len(content)] * 3 + [chance.randrange(len(content))])
        try:
            record = MINISEED.read(Source("a", bytes(content[:cut])), units="g")
        except RecordError:
            continue
        assert all(np.isfinite(part.acceleration).all() for part in record.components)


def test_codes_are_cut_to_the_places_that_the_format_has() -> None:
    """Two characters for a network, five for a station (SEED 2.4 manual, Chapter 8, fixed section of data header)."""
    obspy = pytest.importorskip("obspy")
    part = Component("HNE", np.sin(np.arange(90.0)), "g", 0.005)
    content = MINISEED.write(Record("", (part,), "", {"network": "NETW", "station": "STATION"}))
    (trace,) = obspy.read(io.BytesIO(content), format="MSEED")
    assert (trace.stats.network, trace.stats.station) == ("NE", "STATI")
