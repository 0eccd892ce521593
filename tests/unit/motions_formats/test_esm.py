"""ESM ASCII: keys, checks against the header, and what is refused."""

from contextlib import nullcontext

import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Source, formats

ESM = formats()["esm"]
# typed by hand: an older header without HEADER_FORMAT may have fewer keys
HAND = """EVENT_NAME: SOMEWHERE
NETWORK: XX
STATION_CODE: CELL
SAMPLING_INTERVAL_S: 0.005000
NDATA: 5
DURATION_S: 0.025
STREAM: HNE
UNITS: cm/s^2
PGA_CM/S^2: -3.250000
TIME_PGA_S: 0.010000
DATA_TYPE: ACCELERATION
USER5:
0.500000
-1.000000
-3.250000
2.000000
0.000000
"""


def _source(text: str) -> Source:
    return Source("hand.asc", text.encode("latin-1"))


def test_hand_made_file() -> None:
    """Values, unit, step, peak and names are what was typed."""
    source = _source(HAND)
    assert ESM.recognises(source)
    assert not ESM.recognises(_source("a line of its own\n" + HAND))
    record = ESM.read(source)
    part = record.components[0]
    assert part.acceleration.tolist() == [0.5, -1.0, -3.25, 2.0, 0.0]
    assert (part.name, part.unit, part.time_step, part.stated_peak) == ("HNE", "cm/s2", 0.005, 3.25)
    assert (record.metadata["event"], record.metadata["station"]) == ("SOMEWHERE", "CELL")
    assert record.header.splitlines() == HAND.splitlines()[:12]
    # a duration from the first to the last sample, one step shorter, is accepted too
    assert ESM.read(_source(HAND.replace("DURATION_S: 0.025", "DURATION_S: 0.020"))).components[0].time_step == 0.005


DAMAGES = [
    ("NDATA: 5", "NDATA: 6", "states 6 samples, but the file contains 5"),
    ("NDATA: 5", "NDATA: 5.0", "line 5: number of samples expected"),
    ("NDATA: 5\n", "", "header line NDATA is missing"),
    ("-1.000000\n", "", "states 5 samples, but the file contains 4"),
    ("-1.000000", "-1.0000OO", "line 14: number expected"),
    ("-1.000000", "-1.0 2.0", "line 14: 1 numbers expected, found 2"),
    ("DURATION_S: 0.025", "DURATION_S: 0.035", "doubt:states a duration of 0.035 s"),
    ("DURATION_S: 0.025", "DURATION_S: 0", "doubt:states a duration of 0 s"),
    ("PGA_CM/S^2: -3.250000", "PGA_CM/S^2: -3.260000", "PGA_CM/S.2 of 3.26, but the data have 3.25"),
    ("-3.250000\n2.0", "-3.260000\n2.0", "the data have 3.26"),
    ("PGA_CM/S^2: -3.250000", "PGA_CM/S^2: 0", "states a PGA_CM/S.2 of 0"),
    ("PGA_CM/S^2: -3.250000\n", "", "header line PGA_CM/S.2 is missing"),
    ("PGA_CM/S^2: -3.250000", "PGA_CM/S^3: -3.250000", "header line PGA_CM/S.2 is missing"),
    ("PGA_CM/S^2: -3.250000", "PGA_CM/S^2:", "line 9: PGA_CM/S.2 must contain a number"),
    ("UNITS: cm/s^2", "UNITS: m/s^2", "header line PGA_M/S.2 is missing"),
    ("TIME_PGA_S: 0.010000", "TIME_PGA_S: 0.020000", "doubt:states the peak at 0.02 s, but the data have it at 0.01 s"),
    ("cm/s^2\n", "furlong\n", "line 8: UNITS must be one of"),
    ("DATA_TYPE: ACCELERATION", "DATA_TYPE: VELOCITY", "line 11: DATA_TYPE must be ACCELERATION"),
    ("NETWORK: XX", "NDATA: 5", "NDATA appears twice"),
    ("SAMPLING_INTERVAL_S: 0.005000", "SAMPLING_INTERVAL_S: 0.006000", "doubt:5 samples at 0.006 s have 0.03 s"),
    ("SAMPLING_INTERVAL_S: 0.005000", "SAMPLING_INTERVAL_S:", "add time_step="),
    ("STREAM: HNE", "HEADER_FORMAT: DYNA 1.2", "64 header lines KEY: value expected for DYNA 1.2, found 12"),
]


def test_damage_is_refused() -> None:
    """Count, unit, step and peak that the data contradict are refused; duration and time of the peak are doubted."""
    refused(ESM, HAND, DAMAGES)


@pytest.mark.parametrize(("unit", "label"), [("m/s^2", "PGA_M/S^2"), ("mm/s^2", "PGA_MM/S^2"), ("g", "PGA_G")])
def test_other_units_need_their_own_peak(unit: str, label: str) -> None:
    """A file in another unit is read if its peak is stated in that unit, and the peak is checked."""
    text = HAND.replace("UNITS: cm/s^2", f"UNITS: {unit}").replace("PGA_CM/S^2", label)
    part = ESM.read(_source(text)).components[0]
    assert (part.unit, part.stated_peak) == (unit.replace("^", ""), 3.25)
    with pytest.raises(RecordError, match=r"of 3.26, but the data have 3.25"):
        ESM.read(_source(text.replace(": -3.250000", ": -3.260000")))


def test_a_peak_is_as_sharp_as_its_digits() -> None:
    """One more in the last digit is rounding, two are not."""
    for word, good in (("-3.2501", True), ("-3.2502", False), ("-3.251", True), ("-3.252", False)):
        text = HAND.replace("PGA_CM/S^2: -3.250000", f"PGA_CM/S^2: {word}")
        with nullcontext() if good else pytest.raises(RecordError, match=r"the data have 3\.25"):
            ESM.read(_source(text))


def test_no_peak_comes_before_the_first_sample() -> None:
    """Half a step before it is doubted, at it is not."""
    first = HAND.replace("0.500000\n-1.000000\n-3.250000", "-3.250000\n-1.000000\n0.500000")
    assert ESM.read(_source(first.replace("TIME_PGA_S: 0.010000", "TIME_PGA_S: 0"))).components[0].peak == 3.25
    early = _source(first.replace("TIME_PGA_S: 0.010000", "TIME_PGA_S: -0.0025"))
    ESM.read(early)
    assert "states the peak at -0.0025 s, but the data have it at 0 s" in early.doubts[0]


def test_round_trip(made_up) -> None:
    """A written file has the 64 lines of DYNA 1.2 and reads back to 6 decimals of cm/s2."""
    record = made_up("HNN")
    again = read_back(ESM, record, 100.0, atol=5.1e-7)
    assert again.header.count("\n") == 63
    assert (again.metadata["event"], again.metadata["station"]) == ("Somewhere", "Cellar")
