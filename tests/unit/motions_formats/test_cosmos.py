"""COSMOS v1.20: headers in stated formats, several channels, and what is refused."""

import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Source, formats

COSMOS = formats()["cosmos"]
VALUES = [0.5, -1.25, 3.0, -12.345, 2.0, 0.0, 0.25, 1.0, -1.0, 0.125]


def _table(kind: str, count: int, known: dict[int, float], per_line: int, width: int, decimals: int) -> list[str]:
    """Lay out a header by the description of the format: places from 1, -999 where unknown."""
    words = [f"{known.get(place, -999):{width}.{decimals}f}" for place in range(1, count + 1)]
    lines = ["".join(words[k : k + per_line]) for k in range(0, count, per_line)]
    form = f"{per_line}I{width}" if kind == "Integer" else f"{per_line}F{width}.{decimals}"
    return [f" {count} {kind}-header values follow on  {len(lines)} lines, Format= ({form})", *lines]


def _channel(number: int = 1, azimuth: int = 340, unit: str = "cm/sec2(04)", code: int = 4) -> list[str]:
    texts = [f"text line {k}" for k in range(1, 14)]
    texts[0] = "Corrected acceleration    (Format v01.20 with 13 text lines) Src: hand"
    texts[1] = f"{'Somewhere near':<40}June 16,2005 13:53"
    texts[4] = "Statn No: 01-23075  Code:CE-J2236  Cellar"
    texts[8] = f"Sta Cha:  {number}: {azimuth} deg (Rcrdr Chan  1) Location: floor"
    wholes = {1: 2, 2: 1, 3: code, 4: 120, 54: azimuth, 70: 10}
    reals = {62: 10.0, 63: 0.1, 64: -12.345, 65: 0.03}
    return [
        *texts,
        *_table("Integer", 100, wholes, 10, 8, 0),
        *_table("Real", 100, reals, 6, 13, 6),
        '  2 Comment line(s) follow, each starting with a "|":',
        " | one",
        "| two",
        f"     10  acceleration pts, approx     0 secs, units={unit},Format=(8F10.5)",
        "".join(f"{value:10.5f}" for value in VALUES[:8]),
        "".join(f"{value:10.5f}" for value in VALUES[8:]),
        f"/&  ----------  End of data for channel  {number}  ----------",
    ]


def _source(lines: list[str]) -> Source:
    return Source("hand.v1", "\n".join(lines).encode("latin-1"))


def test_hand_made_file() -> None:
    """Values, unit, step, peak, azimuth and names are what was laid out by the description of the format."""
    source = _source(_channel())
    assert COSMOS.recognises(source)
    record = COSMOS.read(source)
    part = record.components[0]
    assert part.acceleration.tolist() == VALUES
    assert (part.name, part.unit, part.time_step, part.stated_peak) == ("340", "cm/s2", 0.01, 12.345)
    assert record.metadata["event"] == "Somewhere near"
    assert record.metadata["station"] == "Cellar"
    assert (record.metadata["station number"], record.metadata["station code"]) == ("01-23075", "CE-J2236")
    assert record.header.splitlines() == _channel()[:-3]


def test_several_channels_follow_one_another() -> None:
    """Each channel is a component, named by azimuth, or by number where these repeat; nothing follows the last."""
    record = COSMOS.read(_source([*_channel(1, 340), *_channel(2, 70), ""]))
    assert [part.name for part in record.components] == ["340", "70"]
    record = COSMOS.read(_source([*_channel(3, 90), *_channel(4, 90)]))
    assert [part.name for part in record.components] == ["CHAN 3", "CHAN 4"]
    with pytest.raises(RecordError, match="after the last sample"):
        COSMOS.read(_source([*_channel(), "", "0.1"]))


def test_unknown_values_are_passed_over() -> None:
    """What the headers mark as unknown by -999 is not checked; a missing step must be said."""
    text = "\n".join(_channel())
    for known, unknown in (("     340    -999", "    -999    -999"), ("    -999      10\n", "    -999    -999\n")):
        assert known in text
        text = text.replace(known, unknown)
    blank = f"{-999:13.6f}"
    for word in ("     0.100000   -12.345000", "     0.030000"):
        text = text.replace(word, blank * (len(word) // 13))
    part = COSMOS.read(_source([text])).components[0]
    assert part.acceleration.tolist() == VALUES
    assert part.stated_peak is None
    with pytest.raises(RecordError, match="add time_step="):
        COSMOS.read(_source([text.replace("    10.000000", blank)]))
    assert COSMOS.read(_source(_channel(unit="g(02)", code=2))).components[0].unit == "g"


DAMAGES = [
    ("     10  acc", "     11  acc", "columns of 10 characters expected|11 samples"),
    ("     10  acc", "999999999  acc", "columns of 10 characters expected"),
    ("    -999      10\n", "    -999      12\n", "states 12 samples, but the file contains 10"),
    ("  -12.345000", "  -12.355000", "peak of 12.355, but the data have 12.345"),
    ("     0.030000", "     0.080000", "doubt:states the peak at 0.08 s, but the data have it at 0.03 s"),
    ("    10.000000     0.100000", "    20.000000     0.100000", "doubt:duration of 0.1 s"),
    ("cm/sec2(04)", "cm/sec(05)", "acceleration in g .02. or cm/sec2 .04. expected"),
    ("cm/sec2(04)", "counts (50)", "counts of the recorder"),
    ("cm/sec2(04)", "g(04)", "contradicts its code 04"),
    ("cm/sec2(04)", "g(02)", "must contain acceleration"),
    ("acceleration pts", "velocity pts", "found velocity"),
    ("(8F10.5)", "(9F10.5)", "9 columns of 10"),
    ("(8F10.5)", "(0F10.5)", "format such as"),
    ("on  10 lines", "on  11 lines", "contradict 11 lines"),
    ("on  17 lines", "on  16 lines", "contradict 16 lines"),
    ("  2 Comment", "  3 Comment", "comment line that begins with"),
    ("with 13 text", "with 12 text", "integer-header|Integer-header"),
    ("with 13 text", "with 999999999 text", "12 to 200 text lines expected"),
    ("/&  ----------", "   0.00000", "End of data for channel expected"),
    ("-1.25000", "-1.2500O", "number expected"),
    ("  -1.25000", "", "8 columns of 10 characters expected"),
]


def test_damage_is_refused() -> None:
    """Whatever the headers state and the data contradict is refused."""
    refused(COSMOS, "\n".join(_channel()), DAMAGES)


def test_round_trip(made_up) -> None:
    """Three channels come back to 5 decimals of cm/s2."""
    again = read_back(COSMOS, made_up("0", "90", "270"), 100.0, atol=5.1e-6)
    assert [part.name for part in again.components] == ["0", "90", "270"]
    with pytest.raises(RecordError, match=r"does not fit into 1. characters"):
        COSMOS.write(made_up("0", scale=1e6))


@pytest.mark.parametrize("end", ["/&  ----------  End of data for channel  1", "End-of-data for ChanHNE acceleration"])
def test_both_end_marks(end: str) -> None:
    """CGS ends a channel with /& and the U.S. Geological Survey in words; another channel may follow either."""
    lines = [*_channel()[:-1], end]
    assert len(COSMOS.read(_source([*lines, *_channel(2, 70)[:-1], end, ""])).components) == 2
    with pytest.raises(RecordError, match="End of data for channel expected"):
        COSMOS.read(_source([*lines[:-1], "The end"]))


@pytest.mark.parametrize("unit", ["g(02)", "g.     (02)", "G.(02)", "g (02)"])
@pytest.mark.parametrize("comma", [",", "", " , "])
def test_units_as_agencies_write_them(unit: str, comma: str) -> None:
    """With a full stop, blanks, and no comma before the format."""
    text = "\n".join(_channel(unit=unit, code=2)).replace("),Format", f"){comma}Format")
    assert COSMOS.read(_source([text])).components[0].unit == "g"


def test_counts_are_named() -> None:
    """Volume 0 holds counts of the recorder, which its own lines say."""
    text = "\n".join(_channel(unit=" counts(50)", code=50)).replace("acceleration pts", "raw accel.   pts")
    with pytest.raises(RecordError, match="line 46: the file contains counts of the recorder"):
        COSMOS.read(_source([text]))
    with pytest.raises(RecordError, match="line 1: the file contains spectra"):
        COSMOS.read(_source(["\n".join(_channel()).replace("Corrected acceleration", "Response spectra")]))


def test_a_channel_is_named_by_its_code_where_no_azimuth_is_stated() -> None:
    """An azimuth of 0 without degrees in the text is none where SCNL names the channel."""
    text = (
        "\n".join(_channel(azimuth=0)).replace("  1: 0 deg (", "  ?:Other (").replace("| two", "|<SCNL>BMR.BNZ.AK.--")
    )
    assert COSMOS.read(_source([text])).components[0].name == "BNZ"
    assert COSMOS.read(_source(_channel(azimuth=0))).components[0].name == "0"


@pytest.mark.parametrize(
    ("azimuth", "code", "side"), [(0, "HNZ", "unclear"), (90, "HNZ", "unclear"), (90, "HNE", 90.0)]
)
def test_a_code_that_contradicts_the_azimuth_makes_the_direction_unclear(azimuth: int, code: str, side: object) -> None:
    """A channel with the code of the vertical is no horizontal motion, whatever its azimuth says."""
    text = "\n".join(_channel(azimuth=azimuth)).replace("| two", f"|<SCNL>BMR.{code}.AK.--")
    assert COSMOS.read(_source([text])).components[0].direction == side


@pytest.mark.parametrize(
    ("printed", "good"), [("  -12.345000", True), ("  -12.345400", False), ("  -12.346000", False)]
)
def test_a_peak_is_as_sharp_as_its_digits(printed: str, good: bool) -> None:
    """Zeros at its end may be none of its digits, down to three decimals; half a digit of either is rounding."""
    text = "\n".join(_channel())
    source = _source([text.replace("  -12.345000", printed)])
    if good:
        assert COSMOS.read(source).components[0].stated_peak == 12.345
    else:
        with pytest.raises(RecordError, match=r"the data have 12.345"):
            COSMOS.read(source)
    rounded = text.replace("-12.34500   2.00000", "-12.34549   2.00000")
    assert COSMOS.read(_source([rounded])).components[0].peak == 12.34549
