"""CSMIP volumes 1 and 2: columns without blanks, unequal channels, blocks between, and what is refused."""

import numpy as np
import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Component, Record, RecordFormat, Source, formats

V1, V2 = formats()["csmip-v1"], formats()["csmip-v2"]
ACCEL = [0.5, -1.25, 3.0, -1234.567, -23456.789, 0.0, 0.25, 1.0, -1.0, 0.125]
VELOC = [0.0, 0.1, -5.5, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
DISPL = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 7.25]
TIMES = [0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12]
TENTHS = [0.01, -0.25, 3.5, -12.345, 2.0, 0.0, 0.25]


def _block(values: list[float], per_line: int, width: int, decimals: int) -> list[str]:
    """Lay numbers out in Fortran's manner, without the zero before the point."""
    words = [f"{v:.{decimals}f}" for v in values]
    bare = [word.replace("0.", ".", 1) if word.lstrip("-").startswith("0.") else word for word in words]
    words = [f"{word:>{width}}" for word in bare]
    return ["".join(words[k : k + per_line]) for k in range(0, len(words), per_line)]


def _headers(
    texts: dict[int, str], count: int, wholes: dict[int, int], reals: dict[int, float], size: int
) -> list[str]:
    lines = [texts.get(k, "") for k in range(count)]
    lines += _block([wholes.get(k, 0) for k in range(100)], 16, 5, 0)
    return lines + _block([reals.get(k, 0.0) for k in range(size)], 8, 10, 3)


def _v2(number: int = 1, direction: str = " 90 DEG", cut: int = 10, tail: str = "(UNITS: CM/SEC/SEC)") -> list[str]:
    texts = {
        0: f"CORRECTED ACCELEROGRAM   36456-S4384       CHAN  {number}: {direction}     FROM",
        1: "UNCORRECTED ACCELEROGRAM DATA",
        2: "SOMEWHERE EARTHQUAKE",
        3: "MAY 2, 1983 16:42 PDT   (ORIGIN: 05/02/83)",
        5: "STATION NO. 36456   35.908N, 120.458W",
        6: "CELLAR",
        7: f"CHAN  {number}: {direction}",
        15: f"  {cut} POINTS OF INSTRUMENT- AND BASELINE-CORRECTED ACCEL, VELOC AND DISPL DATA",
        17: "PEAK ACCELERATION = -23456.789    CM/SEC/SEC  AT     .080   SEC.",
    }
    reals = {60: 0.02, 64: 0.08, 65: -23456.789, 66: 0.04, 67: -5.5, 68: 0.02 * (cut - 1), 69: 7.25}
    return [
        *_headers(texts, 25, {52: cut, 63: cut, 65: cut}, reals, 100),
        f" {cut:5d} POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  {tail}",
        *_block(ACCEL[:cut], 8, 10, 3),
        f" {cut:5d} POINTS OF VELOC DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC)",
        *_block(VELOC[:cut], 8, 10, 3),
        f" {cut:5d} POINTS OF DISPL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM)",
        *_block([*DISPL[: cut - 1], 7.25], 8, 10, 3),
        f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------",
    ]


def _v1(number: int = 1, direction: str = "360 DEG", unit: str = "SEC AND G/10.     MAX  = -1.235 G.") -> list[str]:
    texts = {
        0: "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 02/28/94",
        1: "SOMEWHERE EARTHQUAKE",
        2: "JANUARY 17, 1994 04:31 PST",
        4: "STATION NO. 24436   34.160N, 118.534W",
        5: "CELLAR",
        6: f"CHAN  {number}: {direction}",
        11: f"UNITS OF UNCOR ACCEL ARE {unit}",
    }
    pairs = [number for pair in zip(TIMES, TENTHS, strict=True) for number in pair]
    return [
        *_headers(texts, 13, {27: 7}, {0: 0.04, 2: 0.12, 6: -1.235, 7: 0.06}, 50),
        *_block(pairs, 10, 7, 3),
        f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------",
    ]


def _source(lines: list[str], end: str = "\r\n") -> Source:
    return Source("hand.v", end.join(lines).encode("latin-1"))


def test_v2_hand_made_file_with_unequal_channels() -> None:
    """Channels of 10 and 9 samples, numbers that touch, velocity and displacement passed over, Ctrl-Z at the end."""
    source = _source([*_v2(1), *_v2(2, "UP", 9), "\x1a" * 100])
    assert V2.recognises(source)
    assert not V1.recognises(source)
    record = V2.read(source)
    first, second = record.components
    assert first.acceleration.tolist() == ACCEL
    assert second.acceleration.tolist() == ACCEL[:9]
    assert (first.name, first.unit, first.time_step, first.stated_peak) == ("90", "cm/s2", 0.02, 23456.789)
    assert second.name == "UP"
    assert record.metadata["event"] == "SOMEWHERE EARTHQUAKE"
    assert record.metadata["station"] == "CELLAR"
    assert record.metadata["station number"] == "36456"


def test_v2_newer_line_before_the_data() -> None:
    """Lower case and a stated Fortran format, as newer files have, are read too."""
    lines = [text.lower() if "POINTS OF ACCEL" in text else text for text in _v2(tail="in cm/sec2. (8f10.3)")]
    assert V2.read(_source(lines)).components[0].acceleration.tolist() == ACCEL


V2_DAMAGES = [
    ("    10 POINTS OF ACCEL", "    11 POINTS OF ACCEL", "characters|header states"),
    ("    10 POINTS OF ACCEL", "999999999 POINTS OF ACCEL", "8 columns of 10 characters expected"),
    ("    10 POINTS OF VELOC", "     9 POINTS OF VELOC", "doubt:columns of 10 characters expected"),
    ("  10 POINTS OF INSTRUMENT", "  12 POINTS OF INSTRUMENT", "states 12 samples, but the file contains 10"),
    (
        "-23456.789    CM/SEC/SEC",
        "-23456.889    CM/SEC/SEC",
        "doubt:peak in words of -?23456.9, but the data have 23456.8",
    ),
    ("-23456.789    CM/SEC/SEC", "-25456.789    CM/SEC/SEC", "peak in words of 25456.8, but the data have 23456.8"),
    ("AT     .080   SEC", "AT     .180   SEC", "doubt:states the peak at 0.18 s"),
    ("      .040    -5.500", "      .040    -5.600", "doubt:VELOC peak of 5.6"),
    ("     7.250      .000", "     7.350      .000", "doubt:DISPL peak of 7.35"),
    ("ACCEL DATA EQUALLY SPACED AT  .020", "ACCEL DATA EQUALLY SPACED AT  .030", "time step is 0.02 s in the header"),
    ("(UNITS: CM/SEC/SEC)", "(UNITS: CM/SEC)", "must be in CM/SEC/SEC"),
    ("(UNITS: CM/SEC/SEC)", "", "must be in CM/SEC/SEC"),
    ("-1234.567-23456.789", "-1234.567-23456.78B", "number expected, found '-23456.78B'"),
    ("POINTS OF ACCEL DATA", "POINTS OF DISPL DATA", "POINTS OF ACCEL DATA EQUALLY SPACED"),
    ("/&  ------", "   ------", "END OF DATA FOR CHANNEL expected"),
]


def test_v2_damage_is_refused() -> None:
    """Counts, peaks, their times, steps and units that header and data do not share are refused."""
    refused(V2, "\n".join(_v2()), V2_DAMAGES)


def test_v1_hand_made_file() -> None:
    """Pairs of time and acceleration in columns of 7 characters; the unit is g/10, the peak in the header g."""
    source = _source([*_v1(), *_v1(2, "UP"), ""])
    assert V1.recognises(source)
    assert not V2.recognises(source)
    record = V1.read(source)
    assert [part.name for part in record.components] == ["360", "UP"]
    part = record.components[0]
    assert part.acceleration.tolist() == TENTHS
    assert (part.unit, part.time_step) == ("g/10", 0.02)
    assert part.stated_peak == pytest.approx(12.35)
    assert record.metadata["station"] == "CELLAR"


V1_DAMAGES = [
    ("   .040  3.500", "   .050  3.500", "not evenly spaced"),
    ("    0    7    0", "    0    8    0", "columns of 7 characters expected"),
    ("      .120", "     1.120", "doubt:is 1.12 s, but the last sample is at 0.12 s"),
    ("    -1.235", "    -1.335", "peak of 1.335, but the data have 1.2345"),
    ("      .060", "      .100", "doubt:states the peak at 0.1 s"),
    ("-12.345", "-12.34S", "number expected"),
    ("/&  ------", "   ------", "END OF DATA FOR CHANNEL expected"),
    ("SEC AND G/10", "SEC AND WHAT", "add units="),
    ("SEC AND G/10", "SEC AND CM/SEC/SEC", "MAX of 1.235"),
    ("MAX  = -1.235 G", "MAX  = 0.270 G", "MAX of 0.27, but the data have 1.2345"),
    ("MAX  = -1.235 G", "MAX  = -1.236 G", "doubt:MAX of 1.236, but the data have 1.2345"),
    ("MAX  = -1.235 G", "MAX  = -1.336 G", "MAX of 1.336, but the data have 1.2345"),
    ("MAX  = -1.235 G", "MAX  = -1.235 CM/SEC/SEC", "MAX of 1.235, but the data have 1210"),
    ("MAX  = -1.235 G", "MAX  = -1.2B5 G", "line 12: number and unit after MAX = expected"),
]


def test_v1_damage_is_refused() -> None:
    """Uneven times, and counts, lengths, peaks and units that contradict the data, are refused."""
    refused(V1, "\n".join(_v1()), V1_DAMAGES)


def test_v1_text_alone_states_the_peak() -> None:
    """Where the header of reals leaves the peak open, the text line is checked and kept; 12.345 g/10 is 1.2345 g."""
    text = "\n".join(_v1()).replace("    -1.235", "      .000").replace("MAX  =", "MAX=")
    assert V1.read(_source([text], "\n")).components[0].stated_peak == pytest.approx(12.35)
    with pytest.raises(RecordError, match=r"MAX of 0.27, but the data have 1.2345"):
        V1.read(_source([text.replace("-1.235 G", ".270G")], "\n"))
    without = text.replace("     MAX= -1.235 G.", "")
    assert V1.read(_source([without], "\n")).components[0].stated_peak is None


def test_v1_modern_channels_state_rate_unit_and_format() -> None:
    """Two channels of their own length in (8f9.6), in g, with the end in newer words; one is asked for by its name."""
    channels = []
    for number, direction in ((1, "360 Deg"), (2, " Up")):
        lines = _v1(number, direction, unit="sec and g .        Max  =  -1.235 g , at  .06 sec.")
        lines[0] = "Uncorrected Accelerogram Data             Processed: 02/13/12"
        even = "".join(f"{v / 10:9.6f}" for v in TENTHS)
        head = "   7 Accelerogram points at 50 pts/sec in units of g .      Format: (8f9.6)"
        channels += [*lines[:27], head, even, f"/&  ----------  End of Data for Station Channel   {number}"]
    text = "\n".join(channels)
    record = V1.read(_source([text]))
    assert [(part.name, part.unit, part.time_step) for part in record.components] == [
        ("360", "g", 0.02),
        ("Up", "g", 0.02),
    ]
    np.testing.assert_allclose(record.components[1].acceleration, np.array(TENTHS) / 10.0, rtol=0.0, atol=1e-12)
    for old, new, words in (
        ("at 50 pts/sec", "at 0 pts/sec", "time step must be in"),
        ("in units of g .", "in units of counts .", "counts of the recorder"),
        ("in units of g .", "in units of gal .", "states the unit gal, not g"),
        ("   7 Accelero", "   8 Accelero", "states 7 samples, but the file contains 8"),
    ):
        with pytest.raises(RecordError, match=words):
            V1.read(_source([text.replace(old, new)]))


def test_v1_peak_time_from_the_trigger_is_doubted() -> None:
    """RENADIC counts it from the trigger: the record is read, and its peak stays checked."""
    lines = _v1()
    text = "\n".join(lines).replace("    -1.235      .060", "    -1.235      .020")
    source = _source([text])
    assert V1.read(source).components[0].acceleration.tolist() == TENTHS
    assert source.doubts == [
        "hand.v: the header states the peak at 0.02 s, but the data have it at 0.06 s (perhaps from the trigger)"
    ]


def test_v2_velocity_that_was_rounded_is_doubted_only_beyond_its_digits() -> None:
    """-5.500 beside -5.504 is a zero that is no digit; -5.506 is a doubt, and neither refuses."""
    for other, doubts in (("    -5.504", 0), ("    -5.506", 1)):
        source = _source(["\n".join(_v2()).replace("      .100    -5.500", f"      .100{other}")])
        assert V2.read(source).components[0].acceleration.tolist() == ACCEL
        assert len(source.doubts) == doubts


def test_v1_evenly_spaced_variant() -> None:
    """A line that states an even spacing stands for the column of times."""
    lines = _v1(unit="IN G. MAX")
    even = [f"{v / 10:9.6f}" for v in TENTHS]
    lines = [*lines[:27], "  7 POINTS OF DATA EQUALLY SPACED AT .020 SEC, (8F9.6)", "".join(even), lines[-1]]
    part = V1.read(_source(lines)).components[0]
    assert part.unit == "g"
    np.testing.assert_allclose(part.acceleration, np.array(TENTHS) / 10.0, rtol=0.0, atol=1e-12)


def test_v1_evenly_spaced_without_a_form() -> None:
    """Where the line of the spacing names no Fortran format, the numbers stand in 8 columns of 9 characters."""
    tenths = [0.001 * k * (-1) ** k for k in range(12)]
    lines = _v1(unit="IN G. MAX")
    text = "\n".join(lines[:27]).replace("    0    7    0", "    0   12    0").replace("      .120", "      .220")
    text = text.replace("    -1.235", "      .000").replace("      .060", "      .000")
    even = ["  12 POINTS OF DATA EQUALLY SPACED AT .020 SEC", *_block(tenths, 8, 9, 6), lines[-1]]
    part = V1.read(_source([*text.split("\n"), *even], "\n")).components[0]
    assert (part.acceleration.tolist(), part.time_step) == (pytest.approx(tenths, abs=1e-15), 0.02)
    for other in (8, 10):
        wrong = [even[0], *_block(tenths, 8, other, 5), even[-1]]
        with pytest.raises(RecordError, match=r"line 29: .* expected"):
            V1.read(_source([*text.split("\n"), *wrong], "\n"))


@pytest.mark.parametrize("size", range(49, 57))
def test_v1_last_line_of_the_reals(size: int) -> None:
    """It holds from one to eight numbers; peak and length are checked and the samples follow whichever it is."""
    lines = _v1()
    reals = _block([0.04, 0.0, 0.12, 0.0, 0.0, 0.0, -1.235, 0.06, *[0.0] * (size - 8)], 8, 10, 3)
    part = V1.read(_source([*lines[:20], *reals, *lines[27:]])).components[0]
    assert (part.acceleration.tolist(), part.stated_peak) == (TENTHS, pytest.approx(12.35))


@pytest.mark.parametrize(("kind", "factor"), [(V1, 10.0 / 9.80665), (V2, 100.0)])
def test_round_trips(kind: RecordFormat, factor: float, made_up) -> None:
    """Channels of unequal length come back to 3 decimals of the format's unit."""
    whole = made_up("90", "UP")
    parts = (whole.components[0], Component("UP", whole.components[1].acceleration[:-1], "m/s2", 0.02))
    record = Record("x", parts, metadata=whole.metadata)
    again = read_back(kind, record, factor, atol=5.1e-4)
    assert [part.name for part in again.components] == ["90", "UP"]
    assert (again.metadata["event"], again.metadata["station"]) == ("Somewhere", "Cellar")
    with pytest.raises(RecordError, match="does not fit"):
        kind.write(made_up("90", scale=1e6))


def test_v2_velocities_and_displacements_are_written() -> None:
    """Of 1 m/s2 they are v = a t and, by the trapezoids of the samples, d = a t^2 / 2."""
    lines = V2.write(Record("x", (Component("90", np.ones(9), "m/s2", 0.02),))).decode().splitlines()
    time = 0.02 * np.arange(9.0)
    for kind, expected in (("VELOC", 100.0 * time), ("DISPL", 50.0 * time**2)):
        at = next(k for k, line in enumerate(lines) if f"POINTS OF {kind} DATA" in line)
        written = " ".join(lines[at + 1 : at + 3]).split()
        np.testing.assert_allclose(np.array(written, dtype=float), expected, rtol=0.0, atol=5.1e-4)


def test_v2_damaged_line_of_the_peak(made_up) -> None:
    """A line that states a peak but cannot be read is refused, not passed over."""
    text = V2.write(made_up("90")).decode()
    whole = next(line for line in text.splitlines() if line.startswith("PEAK ACCELERATION"))
    V2.read(Source("whole", text.encode()))
    for damaged in (whole.replace("= ", "=7 "), whole.replace(" AT ", " A "), whole.replace("CM/", "CM")):
        with pytest.raises(RecordError, match=r"line 18.*PEAK ACCELERATION = ... CM/SEC/SEC AT"):
            V2.read(Source("damaged", text.replace(whole, damaged).encode()))
