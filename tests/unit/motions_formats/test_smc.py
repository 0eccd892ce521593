"""SMC: 8 columns of 10 characters that may touch each other, or Boore's 5 of 14."""

from collections.abc import Callable

import numpy as np
import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Component, Record, Source, formats

SMC_USGS = formats()["smc-usgs"]

SMC_BOORE = formats()["smc-boore"]

NONE, BLANK = -32768, 1.7e38
SAMPLES = [" 1.5057E+0", "-2.2223E+0", "-1.9234E+0", "-3.1562E+0", "-3.2440E+0", "-3.5638E+0", "-5.1941E+0"]
SAMPLES += ["-5.7933E+0", " 0.0000E+0", " 1.0442E+2", "-7.8821E+1"]
VALUES = [1.5057, -2.2223, -1.9234, -3.1562, -3.2440, -3.5638, -5.1941, -5.7933, 0.0, 104.42, -78.821]


def typed(
    kind: str = "2 CORRECTED ACCELEROGRAM",
    count: int = 11,
    rate: str = "  0.2000000E+03",
    high: tuple[str, str] = ("  0.4500000E-01", "  0.1044170E+03"),
    low: tuple[str, str] = ("  0.5000000E-01", " -0.7882104E+02"),
    printed: str = "104.4",
) -> list[str]:
    """A file typed by hand after the published description of the format."""
    text = [kind, "*", "STAT1", "     1999  12  31    0004 Somewhere", "Moment Mag=      7.1"]
    text += [
        "station = Cellar, 3 Main St        component=    360",
        f"epicentral dist =     89.0       pk     =    {printed}",
    ]
    text += ["inst type=SMA-1      data source = USGS", "*", "*", "*"]
    whole = [f"{NONE:10d}"] * 48
    whole[12], whole[13], whole[15], whole[16] = f"{90:10d}", f"{360:10d}", f"{2:10d}", f"{count:10d}"
    real = ["  0.1700000E+39"] * 50
    real[1], real[28], real[29], real[30], real[31] = rate, *high, *low
    lines = [line.ljust(80) for line in text]
    lines += ["".join(whole[k : k + 8]) for k in range(0, 48, 8)] + ["".join(real[k : k + 5]) for k in range(0, 50, 5)]
    return [*lines, "|", "|made up", "".join(SAMPLES[:8]), "".join(SAMPLES[8:])]


def source(lines: list[str], end: str = "\n") -> Source:
    return Source("typed.smc", (end.join(lines) + end).encode())


def test_numbers_that_touch_are_read_by_columns() -> None:
    """Samples, step, name, unit and peak of a typed file; splitting on blanks would find other numbers."""
    record = SMC_USGS.read(source(typed(), "\r\n"))
    (part,) = record.components
    np.testing.assert_array_equal(part.acceleration, VALUES)
    assert (part.name, part.unit, part.time_step, part.stated_peak) == ("360", "cm/s2", 0.005, 104.417)
    assert record.metadata == {
        "kind": "corrected accelerogram",
        "event": "1999 12 31 0004 Somewhere",
        "station": "station = Cellar, 3 Main St",
        "instrument": "inst type=SMA-1 data source = USGS",
        "azimuth": "360",
    }
    assert record.header.splitlines()[0].startswith("2 CORRECTED")
    bare = [line for line in typed() if not line.startswith("|")]
    bare[12] = bare[12][:70] + f"{0:10d}"  # the sixteenth whole number counts the lines of comment
    np.testing.assert_array_equal(SMC_USGS.read(source(bare)).components[0].acceleration, VALUES)
    # the negative control: blanks are no separators here
    assert len("".join(SAMPLES[:8]).split()) != 8


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": "3 VELOCITY"}, "velocity"),
        ({"kind": "5 RESPONSE SPECTRA"}, "response spectra"),
        ({"rate": "  0.1700000E+39"}, "must be even"),
        ({"rate": "  0.0000000E+00"}, "sampling rate"),
        ({"count": 12}, "columns of 10 characters expected"),
        ({"count": 10}, "columns of 10 characters expected"),
        ({"count": 999_999_999}, "columns of 10 characters expected"),
        ({"count": 8}, "after the last sample"),
        ({"count": 1}, "at least 2"),
        ({"high": ("  0.4500000E-01", "  0.1054170E+03")}, "maximum"),
        ({"low": ("  0.5000000E-01", "  0.7882104E+02")}, "minimum"),
        ({"low": ("  0.5000000E-01", "  0.1700000E+39")}, "one extreme"),
        ({"printed": "84.6"}, "pk"),
    ],
)
def test_files_at_odds_with_their_header_are_refused(change: dict[str, object], message: str) -> None:
    """Counts, extremes with sign and time, the printed peak, the rate and the kind are all checked."""
    with pytest.raises(RecordError, match=message):
        SMC_USGS.read(source(typed(**change)))  # type: ignore[arg-type]


def test_an_extreme_at_another_time_is_doubted() -> None:
    """The header's time of the maximum is not the one of the data: the file is read all the same."""
    odd = source(typed(high=("  0.4000000E-01", "  0.1044170E+03")))
    np.testing.assert_array_equal(SMC_USGS.read(odd).components[0].acceleration, VALUES)
    assert "the header states a maximum of 104.417 at 0.04 s, which the data do not" in odd.doubts[0]


def test_a_damaged_sample_names_its_line() -> None:
    """Stars, as Fortran prints numbers that do not fit, are refused with the line."""
    lines = typed()
    lines[29] = lines[29].replace("-1.9234E+0", "**********")
    with pytest.raises(RecordError, match="line 30"):
        SMC_USGS.read(source(lines))


def test_other_units_and_steps_are_refused() -> None:
    """What the user says must not contradict the file."""
    with pytest.raises(RecordError, match=r"states (the|a) .*, not "):
        SMC_USGS.read(source(typed()), units="g")
    with pytest.raises(RecordError, match=r"states (the|a) .*, not "):
        SMC_USGS.read(source(typed()), time_step=0.01)
    assert SMC_USGS.read(source(typed()), units="gal", time_step=0.005).components[0].unit == "cm/s2"


def test_it_tells_the_two_kinds_of_smc_apart_and_survives_a_missing_line() -> None:
    """Whole number 47 decides; a file that lost a header line is still SMC, and refused by the reader."""
    assert SMC_USGS.recognises(source(typed()))
    assert not SMC_BOORE.recognises(source(typed()))
    lost = source(typed()[1:])
    assert not SMC_USGS.recognises(lost)  # its first line says what it is
    shorter = source(typed()[:5] + typed()[6:])
    assert SMC_USGS.recognises(shorter)
    with pytest.raises(RecordError, match="header numbers expected"):
        SMC_USGS.read(shorter)


@pytest.mark.parametrize("line", [*range(11, 17), *range(17, 27)])
def test_a_file_with_one_damaged_header_line_is_still_known(line: int) -> None:
    """One line of whole or real numbers out of six or ten may be damaged: the reader knows the file and names it."""
    lines = typed()
    lines[line] = "damaged " + lines[line][8:]
    assert SMC_USGS.recognises(source(lines))
    with pytest.raises(RecordError, match=f"line {line + 1}: full line of header numbers expected"):
        SMC_USGS.read(source(lines))


def test_what_is_written_is_read_back(made_up: Callable[..., Record]) -> None:
    """In cm/s2, to the five digits of the format or the eight of Boore's; the azimuth is the fourteenth number."""
    record = made_up("45", scale=3.0)
    read_back(SMC_USGS, record, 100.0, rtol=5.1e-5, atol=1e-9)
    read_back(SMC_BOORE, made_up("17", unit="cm/s2", scale=123.0), 1.0, rtol=5.1e-8, atol=1e-9)
    lines = SMC_USGS.write(record).decode().splitlines()
    assert {len(line) for line in lines[:11]} == {80}
    # the thirteenth, of the vertical, stays open
    assert [int(lines[12][10 * k : 10 * k + 10]) for k in (4, 5)] == [NONE, 45]
    with pytest.raises(RecordError, match="1 components"):
        SMC_USGS.write(made_up("a", "b"))
    with pytest.raises(RecordError, match="below 1e10"):
        SMC_USGS.write(Record("", (Component("a", np.array([0.0, 1e10]), "cm/s2", 0.01),)))


def typed_by_boore(first: str = "0 UNKNOWN") -> str:
    """A file typed by hand: 6 samples, the largest 1.25 at 0.02 s, the least -2.5 at 0.05 s."""
    whole = ["    -32768"] * 48
    whole[15], whole[16], whole[46] = "         1", "         6", "         8"
    real = ["  0.1700000E+39"] * 50
    real[1] = "  0.1000000E+03"
    real[28:32] = ["  0.2000000E-01", "  0.1250000E+01", "  0.5000000E-01", " -0.2500000E+01"]
    lines = [first] + ["*"] * 5 + ["*                                pk mtn =-2.500E+0"] + ["*"] * 4
    lines += ["".join(whole[k : k + 8]) for k in range(0, 48, 8)] + ["".join(real[k : k + 5]) for k in range(0, 50, 5)]
    lines += ["|", " 0.0000000E+00 1.0000000E+00 1.2500000E+00-1.0000000E-01 0.0000000E+00", "-2.5000000E+00"]
    return "\n".join(lines) + "\n"


def test_a_typed_file_is_read() -> None:
    """Samples, step and peak; the kind UNKNOWN is kept in the metadata."""
    source = Source("typed", typed_by_boore().encode())
    assert SMC_BOORE.recognises(source)
    assert not SMC_USGS.recognises(source)
    record = SMC_BOORE.read(source)
    (part,) = record.components
    assert part.acceleration.tolist() == [0.0, 1.0, 1.25, -0.1, 0.0, -2.5]
    assert (part.time_step, part.stated_peak, part.unit) == (0.01, 2.5, "cm/s2")
    assert record.metadata["kind"] == "unknown"


DAMAGES = [
    ("pk mtn =-2.500E+0", "pk mtn =-2.600E+0", "doubt:states a pk of -?2.6"),
    ("pk mtn =-2.500E+0", "pk mtn =-2.700E+0", "pk"),
    ("0 UNKNOWN", "4 DISPLACEMENT", "displacement"),
    (" -0.2500000E+01", " -0.2500010E+01", "minimum"),
    ("-2.5000000E+00\n", "-2.5000000E+00\n 1.0000000E+00\n", "after the last sample"),
    ("-2.5000000E+00\n", "", "1 columns of 14 characters expected"),
]


def test_damage_is_refused() -> None:
    """The text peak, the extremes to seven digits, the kind and the end of the file are checked."""
    refused(SMC_BOORE, typed_by_boore(), DAMAGES)
