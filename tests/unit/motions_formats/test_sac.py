"""SAC through ObsPy: no unit in the file, and a peak in its header."""

import importlib.util
import os
import random
import struct

import numpy as np
import pytest

from rocking.errors import MissingExtraError, RecordError
from rocking.motions.formats import Component, Record, Source, formats, read_record
from rocking.motions.formats.sac import OBSPY, read_traces

SAC = formats()["sac"]

WITHOUT = importlib.util.find_spec("obspy") is None
COPIES = max(1, int(os.environ.get("ROCKING_FUZZ", "2000")) * 3 // 20)
"""Damaged copies; fewer than of a text format, since ObsPy takes longer over each: 300 unless ROCKING_FUZZ is set."""


def typed(values: list[float], order: str = "<", **numbers: float) -> bytes:
    """A SAC file by its published layout: 70 floats, 40 integers, 192 characters, samples."""
    floats, integers = [-12345.0] * 70, [-12345] * 40
    floats[0], floats[1], floats[2] = numbers.get("delta", 0.02), min(values), max(values)
    floats[5], floats[6] = 0.0, numbers.get("e", (len(values) - 1) * 0.02)
    floats[1], floats[2] = numbers.get("depmin", floats[1]), numbers.get("depmax", floats[2])
    for place, name in ((31, "stla"), (32, "stlo"), (35, "evla"), (36, "evlo")):
        floats[place] = numbers.get(name, floats[place])
    integers[6], integers[9] = 6, int(numbers.get("npts", len(values)))
    integers[15], integers[16] = int(numbers.get("iftype", 1)), int(numbers.get("idep", 8))
    integers[35], integers[38] = int(numbers.get("leven", 1)), 1
    text = b"ABC     " + b"-12345  " * 18 + b"-12345  " + b"HNN     " + b"XX      " + b"-12345  " * 2
    head = struct.pack(order + "70f40i", *floats, *integers) + text
    return head[:632].ljust(632) + struct.pack(f"{order}{len(values)}f", *values)


VALUES = [0.0, 0.5, -1.25, 0.75, 0.25]


def test_recognition_needs_no_obspy() -> None:
    """Both byte orders are known by their version; text and noise are not."""
    for order in "<>":
        assert SAC.recognises(Source("a.sac", typed(VALUES, order)))
    for content in (b"", b"0.01 0.02\n" * 200, bytes(700), typed(VALUES)[:600]):
        assert not SAC.recognises(Source("a.sac", content))


@pytest.mark.skipif(not WITHOUT, reason="ObsPy is installed")
def test_without_obspy_the_extra_is_named() -> None:
    """The error says what to install."""
    with pytest.raises(MissingExtraError, match=r'needs obspy: pip install "rocking\[obspy\]"'):
        SAC.read(Source("a.sac", typed(VALUES)), units="m/s2")


@pytest.mark.parametrize("order", ["<", ">"])
def test_a_typed_file_is_read(order: str) -> None:
    """Samples, step and peak in both byte orders; the unit is what the user says."""
    pytest.importorskip("obspy")
    record = SAC.read(Source("a.sac", typed(VALUES, order)), units="g")
    (part,) = record.components
    assert part.acceleration.tolist() == VALUES
    assert (part.name, part.unit, part.time_step, part.stated_peak) == ("HNN", "g", 0.02, 1.25)


def test_the_unit_is_never_guessed() -> None:
    """Without units= it is refused."""
    pytest.importorskip("obspy")
    with pytest.raises(RecordError, match="units="):
        SAC.read(Source("a.sac", typed(VALUES)))


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"depmax": 0.76}, "depmax"),
        ({"depmin": 1.25}, "depmin"),
        ({"npts": 6}, "ObsPy cannot read"),
        ({"npts": 2_000_000_000}, "ObsPy cannot read"),
        ({"delta": -0.02}, "time step|ObsPy"),
        ({"iftype": 4}, "time series"),
        ({"leven": 0}, "evenly spaced"),
        ({"idep": 7}, "velocity"),
        ({"idep": 6}, "displacement"),
        ({"depmax": float("nan")}, "not finite"),
        (
            {"stla": 35.0, "stlo": 1e30, "evla": 36.0, "evlo": 139.0},
            "stlo in the header must be within 360",
        ),  # ObsPy would not end
        ({"evlo": -1e9}, "evlo"),
        ({"evla": 91.0}, "evla"),
        ({"stla": float("nan")}, "stla"),
    ],
)
def test_files_at_odds_with_their_header_are_refused(numbers: dict[str, float], message: str) -> None:
    """Both extremes, count, step, end, kind and quantity are checked."""
    pytest.importorskip("obspy")
    with pytest.raises(RecordError, match=message):
        SAC.read(Source("a.sac", typed(VALUES, "<", **numbers)), units="g")


@pytest.mark.parametrize("numbers", [{"delta": 0.04}, {"e": 1.0}])
def test_an_end_that_its_steps_do_not_reach_is_doubted(numbers: dict[str, float]) -> None:
    """The file is read, and the duration is a doubt."""
    pytest.importorskip("obspy")
    source = Source("a.sac", typed(VALUES, "<", **numbers))
    assert SAC.read(source, units="g").components[0].acceleration.tolist() == VALUES
    assert "duration" in source.doubts[0]


@pytest.mark.parametrize("east", [139.0, -221.0, 359.0])
def test_places_on_earth_are_taken(east: float) -> None:
    """The control: longitudes of either convention."""
    pytest.importorskip("obspy")
    content = typed(VALUES, stla=35.0, stlo=east, evla=-90.0, evlo=140.0)
    assert SAC.read(Source("a.sac", content), units="g").components[0].acceleration.tolist() == VALUES


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(("name", "most"), [("stla", 90.0), ("stlo", 360.0), ("evla", 90.0), ("evlo", 360.0)])
def test_each_place_has_its_own_limit(order: str, name: str, most: float) -> None:
    """The next number of single precision above 90 or 360 degrees is refused, the one below is taken."""
    pytest.importorskip("obspy")
    known = {"stla": 35.3, "stlo": 139.7, "evla": -36.1, "evlo": 140.9}
    for sign in (1.0, -1.0):
        beyond, within = (float(np.nextafter(np.float32(sign * most), np.float32(sign * to))) for to in (1e3, 0.0))
        with pytest.raises(RecordError, match=f"{name} in the header must be within {most:g} degrees of 0"):
            SAC.read(Source("a.sac", typed(VALUES, order, **known | {name: beyond})), units="g")
        inside = typed(VALUES, order, **known | {name: within})
        assert SAC.read(Source("a.sac", inside), units="g").components[0].acceleration.tolist() == VALUES


@pytest.mark.slow
def test_damaged_files_give_no_other_error() -> None:
    """Files with flipped bits or cut short are refused, or keep what their header states."""
    pytest.importorskip("obspy")
    chance = random.Random(1)
    for _ in range(COPIES):
        content = bytearray(typed([float(np.float32(np.sin(0.3 * k))) for k in range(60)]))
        content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
        whole = bytes(content[: chance.choice([len(content)] * 3 + [chance.randrange(len(content))])])
        try:
            (part,) = SAC.read(Source("a.sac", whole), units="g").components
        except RecordError:
            continue
        order = "<" if struct.unpack_from("<i", whole, 304)[0] in {6, 7} else ">"
        low, high = struct.unpack_from(order + "2f", whole, 4)
        if -12345.0 not in {low, high}:
            assert part.peak == pytest.approx(max(abs(low), abs(high)), rel=2e-6)
        assert part.acceleration.size == struct.unpack_from(order + "i", whole, 316)[0]


def test_what_is_written_is_read_back() -> None:
    """Single precision survives."""
    pytest.importorskip("obspy")
    given = Record("", (Component("HNE", np.sin(np.arange(90.0)), "mg", 0.005),), "", {"station": "ABC"})
    (part,) = SAC.read(Source("w", SAC.write(given))).components
    assert part.unit == "mg"
    with pytest.raises(RecordError, match="states the unit mg, not g"):
        SAC.read(Source("w", SAC.write(given)), units="g")
    np.testing.assert_allclose(part.acceleration, given.components[0].acceleration, rtol=6e-8)
    assert (part.name, part.time_step) == ("HNE", 0.005)
    with pytest.raises(RecordError, match="check the unit"):
        SAC.write(Record("", (Component("a", np.array([0.0, 1e38]), "g", 0.1),)))


def test_two_samples_are_a_record() -> None:
    """One interval is the least that has a time step; one sample has none."""
    pytest.importorskip("obspy")
    assert SAC.read(Source("a", typed([0.5, -1.25], e=0.02)), units="g").components[0].acceleration.size == 2
    with pytest.raises(RecordError, match="at least 2"):
        SAC.read(Source("a", typed([0.5], e=0.0)), units="g")


@pytest.mark.parametrize(
    "rate", [60, 62.5, 75, 100, 120, 125, 128, 200, 250, 256, 300, 31.25, 500, 512, 1000, 1.0 / 0.15]
)
def test_every_rate_is_read(tmp_path, rate):
    """The step is that of the header to single precision, whatever ObsPy warns of rounding; no doubt is left."""
    obspy = pytest.importorskip("obspy")
    trace = obspy.Trace(np.sin(0.1 * np.arange(500, dtype=np.float32)))
    trace.stats.update({"network": "XX", "station": "A", "channel": "HNE"})
    trace.stats.sac = {"delta": np.float32(1.0 / rate)}
    path = tmp_path / "a.sac"
    trace.write(str(path), format="SAC")
    content = bytearray(path.read_bytes())
    struct.pack_into("<f", content, 0, 1.0 / rate)  # ObsPy writes it rounded too
    struct.pack_into("<f", content, 24, 499.0 / rate)
    source = Source("a.sac", bytes(content))
    (part,) = formats()["sac"].read(source, "m/s2").components
    assert part.time_step == pytest.approx(1.0 / rate, rel=6e-8, abs=0.0)  # half a unit of single precision
    assert not source.doubts


def test_the_case_at_250_samples_a_second(case_records):
    """It is read with a unit, at 0.004 s."""
    pytest.importorskip("obspy")
    (part,) = read_record(case_records / "sac_250hz.sac", units="m/s2").components
    assert (part.time_step, part.acceleration.size) == (0.004, 600)


def test_warnings_of_a_foreign_reader_are_doubts(monkeypatch):
    """What ObsPy warns of is passed on; what it says of its own code is not."""
    said = {"traces": [_SAID], "warnings": ["something is odd"]}
    monkeypatch.setattr(OBSPY, "answer", lambda *_: (said, [np.zeros(3)]))
    source = Source("a.sac", b"x")
    read_traces(source, "SAC")
    assert source.doubts == ["a.sac: ObsPy warns: something is odd"]


_SAID = {"id": "XX.A..HNE", "text": "", "step": 0.01, "about": {}, "sac": {}, "header": "", "channels": None}
