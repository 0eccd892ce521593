"""Columns with and without names: shapes, times to the rounding of their digits, nothing guessed, damage refused."""

import csv
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats import Component, Record, Source, formats
from rocking.motions.formats.column_text import ColumnText

COLUMNS = formats()["columns"]


def _source(text: str, alphabet: str = "latin-1") -> Source:
    return Source("hand.txt", text.encode(alphabet, "replace"))


def test_one_value_a_line() -> None:
    """One column needs unit and step from the user, and says so."""
    source = _source("# comment\n0.1\n\n -0.2e0\n+.3D-1\n")
    assert COLUMNS.recognises(source)
    part = COLUMNS.read(source, "g", 0.02).components[0]
    assert (part.name, part.unit, part.time_step) == ("acceleration", "g", 0.02)
    assert part.acceleration.tolist() == [0.1, -0.2, 0.03]
    with pytest.raises(RecordError, match="add units= with one of"):
        COLUMNS.read(source, time_step=0.02)
    with pytest.raises(RecordError, match="add time_step="):
        COLUMNS.read(source, "g")
    with pytest.raises(InvalidValueError, match="got 'cm/s'"):
        COLUMNS.read(source, "cm/s", 0.02)


@pytest.mark.parametrize("gap", [" ", ",", ", ", "\t", "  "])
def test_four_columns(gap: str) -> None:
    """Blanks or commas part a time, which may start at one step, and three accelerations."""
    rows = [["0.02", "1", "2", "3"], ["0.04", "-4", "5", "6.5"], ["0.06", "7", "8", "9"]]
    record = COLUMNS.read(_source("% t a b c\n" + "\n".join(gap.join(row) for row in rows)), "cm/s2")
    assert [part.name for part in record.components] == ["column 2", "column 3", "column 4"]
    assert [part.acceleration.tolist() for part in record.components] == [[1, -4, 7], [2, 5, 8], [3, 6.5, 9]]
    assert {part.time_step for part in record.components} == {0.02}
    assert record.metadata["first time"] == "0.02 s"
    assert record.header == "% t a b c"


def _oscillating(columns: int, cycles: float = 8.0) -> str:
    """Return lines of accelerations that change their sign twice per cycle, with two other columns of other sizes."""
    wave = np.sin(2.0 * np.pi * cycles * np.arange(0.5, 200.0) / 200.0)
    return "\n".join(" ".join(f"{size * value:.6f}" for size in range(1, columns + 1)) for value in wave)


@pytest.mark.parametrize("columns", [2, 3])
def test_accelerations_without_times(columns: int) -> None:
    """Two or three columns whose first one oscillates are x, y and z, with a note; a time step is still required."""
    source = _source(_oscillating(columns))
    assert COLUMNS.recognises(source)
    record = COLUMNS.read(source, "cm/s2", 0.005)
    assert [part.name for part in record.components] == list("xyz"[:columns])
    assert {part.time_step for part in record.components} == {0.005}
    for size, part in enumerate(record.components, 1):
        assert part.peak == pytest.approx(size, rel=0.01)  # a sample may miss the peak by 1 %
    assert [part.direction for part in record.components][2:] == ["up"] * (columns - 2)
    (doubt,) = source.doubts
    assert "is not a time" in doubt
    with pytest.raises(RecordError, match="add time_step="):
        COLUMNS.read(_source(_oscillating(columns)), "cm/s2")


def test_first_column_that_may_be_a_time() -> None:
    """A first column with few changes of sign, four columns, and rising times are never read as accelerations."""
    remedy = "the first column is read as time; if all columns are accelerations, add a header line"
    swapped = "-0.02 1\n0.01 2\n-0.01 1\n0.02 3\n0.03 2"  # two lines of times from -0.02 s are misplaced
    uneven = "0.00 1.0\n0.01 2.0\n0.03 1.0\n0.04 1.0\n"
    for text in (_oscillating(3, cycles=3.0), _oscillating(4), swapped, uneven):
        source = _source(text)
        with pytest.raises(RecordError, match=remedy):
            COLUMNS.read(source, "g", 0.005)
        assert not source.doubts
    with pytest.raises(RecordError, match=r"states a time step of 0.01 s, not 0.005 s; .*add a header line"):
        COLUMNS.read(_source("0.00 1\n0.01 2\n0.02 1\n0.03 2\n0.04 1\n0.05 2"), "g", 0.005)
    with pytest.raises(RecordError, match="not evenly spaced") as refusal:  # the first column has a name
        COLUMNS.read(_source(f"time [s] acc [g]\n{uneven}"), "g")
    assert "header line" not in str(refusal.value)
    # times before zero
    times = "\n".join(f"{0.01 * step:.2f} {(-1) ** step}" for step in range(-20, 20))
    record = COLUMNS.read(_source(times), "g", 0.01)
    assert [part.name for part in record.components] == ["column 2"]
    # the remedy of the error
    four = COLUMNS.read(_source("# A [g], B [g], C [g], D [g]\n" + _oscillating(4)), None, 0.005)
    assert [part.name for part in four.components] == list("ABCD")


@pytest.mark.parametrize("step", [0.005, 0.01, 0.02, 1.0 / 256.0, 1.0 / 300.0])
@pytest.mark.parametrize("digits", [4, 6])
def test_times_uniform_to_their_digits(step: float, digits: int) -> None:
    """Rounded or cut times are even to their digits; the step is found to the digit over the whole record."""
    for cut in (np.round, lambda x, k: np.floor(x * 10.0**k) / 10.0**k):
        times = cut(np.arange(2000) * step, digits)
        text = "\n".join(f"{t:.{digits}f} 1.0" for t in times)
        found = COLUMNS.read(_source(text), "g").components[0].time_step
        assert abs(found - step) * 1999 <= 10.0**-digits + 1.2e-7 * 2000 * step


def test_times_with_as_many_digits_as_the_step() -> None:
    """Times printed as 0, 0.01, 0.02 are even; with one line missing they are not."""
    rows = [f"{0.01 * k:.6g} {k}.5" for k in range(400)]
    assert COLUMNS.read(_source("\n".join(rows)), "g").components[0].time_step == 0.01
    # times that went through single precision are accepted
    times = np.arange(5000, dtype=np.float32) * np.float32(0.02)
    text = "\n".join(f"{float(t):.9f} 1.0" for t in times)
    assert COLUMNS.read(_source(text), "g").components[0].time_step == 0.02
    for missing in (1, 200, 398):
        with pytest.raises(RecordError, match="not evenly spaced"):
            COLUMNS.read(_source("\n".join(rows[:missing] + rows[missing + 1 :])), "g")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.00 1.0\n0.01 2.0\n0.03 1.0\n0.04 1.0\n", "not evenly spaced"),
        ("0.00 1.0\n0.02 2.0\n0.01 1.0\n0.03 1.0\n", "not evenly spaced"),
        ("0.0 1.0\n0.0 2.0\n0.0 1.0\n", "check that the first column is a time"),
        ("0.00 1.0\n0.00 2.0\n0.01 1.0\n0.01 1.0\n0.02 1.0\n", "too few digits"),
        ("0.00 1.0\n0.01\n0.02 1.0\n", "line 2: 2 numbers expected as on the first line, found 1"),
        ("0.00 1.0\n0.01 nan\n0.02 1.0\n", "line 2: number expected, found 'nan'"),
        ("0.00 1.0\n0.01 1.0.0\n0.02 1.0\n", "line 2: number expected"),
        ("1,5\n2,5\n3,5\n", "decimal commas"),
        ("0.5\n", "at least 2 samples"),
        ("# only a comment\n", "no line with numbers"),
        ("a\0b", "not a text file"),
    ],
)
def test_damage_is_refused(text: str, message: str) -> None:
    """Uneven times, ragged lines, words and decimal commas are refused."""
    with pytest.raises(RecordError, match=message):
        COLUMNS.read(_source(text), "g", 0.01 if text.startswith("0.5") else None)


@pytest.mark.parametrize(
    "text",
    ["Header\n1 2\n", "1 2\n1 2 3\n", "\0\0", "# none\n", "#RecordLength(sec): 50\n#NDATA 3\n0 1\n1 2\n",
     "time,acc\ns,g\n0.0,1\n0.1,2", "hello world\n" * 5],
)  # fmt: skip
def test_recognition_is_by_the_first_lines(text: str) -> None:
    """Text, ragged lines, binary content, a foreign header, two lines of words and a bare sentence are no columns."""
    assert not COLUMNS.recognises(_source(text))


def test_contradicting_step_is_refused() -> None:
    """A step that differs from the time column's is refused, one within its digits is taken."""
    text = "0.0000 1.0\n0.0033 2.0\n0.0067 1.0\n0.0100 1.0\n"
    assert COLUMNS.read(_source(text), "g", 0.01 / 3.0).components[0].time_step == 0.01 / 3.0
    with pytest.raises(RecordError, match=r"not 0.004 s"):
        COLUMNS.read(_source(text), "g", 0.004)


@pytest.mark.slow
@given(st.lists(st.floats(-1e5, 1e5), min_size=2, max_size=20), st.sampled_from([1e-3, 0.005, 1.0 / 128.0, 0.02]))
def test_round_trip_is_exact(values: list[float], step: float) -> None:
    """Every sample comes back to the last bit, and the step with it."""
    record = Record("x", (Component("a", np.array(values), "m/s2", step),))
    part = COLUMNS.read(_source(COLUMNS.write(record).decode()), "m/s2", step).components[0]
    assert part.acceleration.tolist() == values
    assert part.time_step == step


def test_columns_are_separated_by_commas(made_up) -> None:
    """The csv module of Python reads a written file; a comma is in the header and in every line."""
    heading, *rows = csv.reader(COLUMNS.write(made_up("NS", "EW")).decode().splitlines())
    assert [name.strip() for name in heading] == ["# time [s]", "NS [m/s2]", "EW [m/s2]"]
    assert {len(row) for row in rows} == {3}
    assert float(rows[1][0]) == 0.02


def test_writer_refuses_what_columns_cannot_hold(made_up) -> None:
    """Components of unequal length, and more than three, do not fit."""
    two = made_up("a", "b")
    short = Component("b", two.components[1].acceleration[:-1], "m/s2", 0.02)
    with pytest.raises(RecordError, match="equal length and time step"):
        COLUMNS.write(Record("x", (two.components[0], short)))
    with pytest.raises(RecordError, match="1 to 3 components"):
        COLUMNS.write(made_up("a", "b", "c", "d"))


VALUES = [0.125, -0.5, 0.25, 1.5, -2.0, 0.75]
GERMAN = str.maketrans(".", ",")


def _lines(gap: str, end: str = "\n") -> str:
    return end.join(f"{0.01 * k:.2f}{gap}{value}" for k, value in enumerate(VALUES))


@pytest.mark.parametrize("name", ["acc [g]", "acc (g)", "acc[ g ]", '"acc [g]"'])
@pytest.mark.parametrize("gap", [",", ";", "\t", ", ", "; "])
def test_a_unit_behind_the_name_is_taken(name: str, gap: str) -> None:
    """Comma, semicolon or tab part names and numbers; with its unit and times a file says everything."""
    source = _source(f"time{gap}{name}\n{_lines(gap)}\n")
    assert COLUMNS.recognises(source)
    (part,) = COLUMNS.read(source).components
    assert (part.name, part.unit, part.time_step, part.acceleration.tolist()) == ("acc", "g", 0.01, VALUES)


def test_a_name_without_a_unit_is_asked_for_it() -> None:
    """Of ``time,acc`` the unit must be told; one that is told and stated differently is refused."""
    bare = _source("time,acc\n" + _lines(","))
    with pytest.raises(RecordError, match="does not state its unit; add units="):
        COLUMNS.read(bare)
    with pytest.raises(InvalidValueError, match="units must be one of"):
        COLUMNS.read(bare, "m/s")
    assert COLUMNS.read(bare, "gal").components[0].unit == "gal"
    with pytest.raises(RecordError, match="states the unit g, not gal"):
        COLUMNS.read(_source("time,acc [g]\n" + _lines(",")), "gal")


@pytest.mark.parametrize("gap", [";", "\t"])
@pytest.mark.parametrize("alphabet", ["latin-1", "utf-8", "utf-8-sig"])
def test_what_a_german_spreadsheet_writes(gap: str, alphabet: str) -> None:
    """Semicolons or tabs, decimal commas, m/s2 with a raised two, and empty cells and rows at the end."""
    end = f"{gap}\r\n"
    table = f"Zeit [s]{gap}Beschleunigung [m/s\xb2]{end}{_lines(gap, end).translate(GERMAN)}{end}"
    source = _source(f"{table}{gap}{gap}\r\n\r\n", alphabet)
    assert COLUMNS.recognises(source)
    (part,) = COLUMNS.read(source).components
    assert (part.name, part.unit, part.time_step) == ("Beschleunigung", "m/s2", 0.01)
    assert part.acceleration.tolist() == VALUES
    # where commas part nothing they are decimal points, without a line of names as well
    for bare in (gap, "  "):
        (part,) = COLUMNS.read(_source(_lines(bare).translate(GERMAN)), "g").components
        assert (part.acceleration.tolist(), part.time_step) == (VALUES, 0.01)


@pytest.mark.parametrize(
    ("unit", "read"),
    [("m/s^2", "m/s2"), ("m/s/s", "m/s2"), ("cm/sec**2", "cm/s2"), ("Gal", "gal"), ("MM/S2", "mm/s2"), ("mg", "mg")],
)
def test_spellings_of_units(unit: str, read: str) -> None:
    """Units are known in their usual spellings, before a remark too; one that is not known contradicts every other."""
    assert COLUMNS.read(_source(f"acc ({unit})\n1\n2\n"), time_step=0.01).components[0].unit == read
    for other, stated in (("G", "g"), ("m/s2 filtered", "m/s2"), ("cm/s/s filtered", "cm/s2")):
        (part,) = COLUMNS.read(_source(f"acc [{other}]\n1\n2\n"), time_step=0.01).components
        assert part.unit == stated
    for other in ("Mg", "furlong/s2", "NS", "corrected"):
        source = _source(f"acc [{other}]\n1\n2\n")
        with pytest.raises(RecordError, match="add units="):
            COLUMNS.read(source, time_step=0.01)
        if other in {"NS", "corrected"}:
            assert COLUMNS.read(source, "g", 0.01).components[0].name == f"acc [{other}]"
            continue
        with pytest.raises(RecordError, match=f"the unit of the file is '{other}', not g; allowed are m/s2"):
            COLUMNS.read(source, "g", 0.01)


def test_what_is_no_acceleration_is_left_out_and_told() -> None:
    """Velocities and displacements, by unit or by name, are no components; the metadata name them."""
    rows = "\n".join(f"{0.01 * k:.2f},{v},{2 * v},{3 * v}" for k, v in enumerate(VALUES))
    for names in ("time [s],a [g],v [m/s],d [m]", "time,a [g],velocity,Displacement", "t,a [g],x [V],y [counts]"):
        record = COLUMNS.read(_source(f"{names}\n{rows}"))
        (part,) = record.components
        assert (part.name, part.acceleration.tolist()) == ("a", VALUES)
        assert record.metadata["left out"] == ", ".join(names.split(",")[2:])
        assert record.header == names


def test_several_accelerations_keep_their_names_and_units() -> None:
    """Each column has its own unit; a time may stand anywhere; without one the step is asked for."""
    source = _source("NS [g];time;UD [cm/s2]\n1;0,00;4\n2;0,01;5\n3;0,02;6")
    north, up = COLUMNS.read(source).components
    assert (north.name, north.unit, north.acceleration.tolist()) == ("NS", "g", [1.0, 2.0, 3.0])
    assert (up.name, up.unit, up.time_step) == ("UD", "cm/s2", 0.01)
    bare = _source("NS [g] EW [g]\n1 2\n3 4\n")
    with pytest.raises(RecordError, match="add time_step="):
        COLUMNS.read(bare)
    assert [part.acceleration.tolist() for part in COLUMNS.read(bare, None, 0.02).components] == [[1, 3], [2, 4]]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x,y\n0.0,1\n0.1,2", "no time among 'x', 'y'"),
        ("L V T\n1 2 3\n2 3 4", "no time among 'L', 'V', 'T'"),
        ("T [s],a [g]\n0.0,1\n0.1,2", r"'T \[s\]' may be periods"),
        ("period [s],Sa [m/s2]\n0.1,1\n0.2,2", "may be periods of a spectrum"),
        ("time,elapsed time,acc\n0,0.0,1\n1,0.1,2", "'time', 'elapsed time' are times with different steps; keep"),
        (",time,acc\n0,0.0,1\n1,0.1,2", "column 1 has no name; add a name"),
        ("time,acc,acc\n0.0,1,1\n0.1,2,2", "column 'acc' appears twice; rename or remove one"),
        ("time [ms],acc\n0,1\n10,2", "must be in seconds"),
        ("time,v [m/s]\n0.0,1\n0.1,2", "none of the columns 'time', 'v .m/s.' is an acceleration"),
        ("time,a [ft/s2]\n0.0,1\n0.1,2", "none of the columns"),
        (
            "time,a [g],x\n0.0,1,2\n0.1,2,3",
            "'x' has no unit; add the unit to the name, or remove the column; add units=",
        ),
        ("time,acc\n0,00,1,5\n0,01,2,5", "line 2: 2 numbers expected, one per name, found 4; with comm"),
        ("time;acc\n0,00;1.5\n0,01;2", "decimal commas here and decimal points on line 2"),
        ("time;acc\n0,00;1\n0,01;1.234,5", "decimal commas here and decimal points on line 3"),
        ("time;acc [g]\n0,00;1,234,567\n0,01;1", "line 2: number expected"),
        ("time,acc [g]\n0.0,1\n0.1,\n0.2,1", "line 3: number expected, found ''"),
        ("time,acc [g]\n0.0,1\n0.1,nan\n0.2,1", "line 3: number expected, found 'nan'"),
        ("time,acc [g]\n0.0,1\n0.1,2\n0.3,1\n0.4,1", "not evenly spaced"),
        ("time,acc [g]\n0.0,1", "at least 2 samples"),
        ("time,acc [g]", "no line with numbers"),
        ("acc\n1,5;2\n2,5;3", "line 2: number expected"),
    ],
)
def test_what_is_not_clear_is_refused_in_words(text: str, words: str) -> None:
    """The error names the columns and says what to write or remove."""
    with pytest.raises(RecordError, match=words):
        COLUMNS.read(_source(text), "g" if "units=" not in words else None)


@pytest.mark.parametrize(
    "first",
    ["x5", "nan", "E.01", "NPTS=3", "Sampling rate 100 Hz", "a b c", "inf", "5g", "acc = g", "x0.5", "\xe9" + "5"],
)
def test_a_damaged_number_or_another_header_is_no_name(first: str) -> None:
    """What may be a damaged first sample, or a header that states its own sampling, is not taken for a name."""
    assert not COLUMNS.recognises(_source(f"{first}\n1\n2\n3\n"))
    assert COLUMNS.recognises(_source("acc\n1\n2\n3\n"))


def _damaged(text: str, chance: random.Random) -> str:
    place = chance.randrange(len(text))
    kinds = (
        text[:place] + chance.choice(" \t;,.x7-#\n\0") + text[place:],
        text[:place] + text[place + chance.choice((1, 1, 2, 9)) :],
        text[:place],
        text[:place] + chr(chance.randrange(256)) + text[place + 1 :],
        text + text,
    )
    return chance.choice(kinds)


@pytest.mark.slow
@pytest.mark.parametrize("gap", [",", ";", "\t"])
def test_damaged_copies_are_refused_or_have_a_sample_for_every_line(gap: str) -> None:
    """Of 600 damaged copies none raises another error, and none loses a line of numbers between the first and last."""
    values = np.random.default_rng(3).normal(size=40)
    table = "\n".join(f"{0.02 * k:.2f}{gap}{value:.5f}" for k, value in enumerate(values))
    good = f"time [s]{gap}acc [g]\n{table if gap == ',' else table.translate(GERMAN)}\n"
    readers, chance, refused = formats(), random.Random(11), 0
    for _ in range(600):
        source = _source(_damaged(good, chance))
        assert not any(one.recognises(source) for name, one in readers.items() if name != "columns")
        try:
            (part, *_) = COLUMNS.read(source).components
        except RecordError:
            refused += 1
            continue
        plain = [line for line in source.lines if line.strip() and line.strip()[0] not in "#%"]
        assert part.acceleration.size == len(plain) - any(word in plain[0] for word in ("time", "acc", "[", "]"))
        assert abs(part.time_step - 0.02) < 1e-12
    assert refused > 200


LAYOUTS = {
    "comma": ("time [s],acc [g]\n", "{0:.2f},{1:.5f}"),
    "comma and blank": ("", "{0:.2f}, {1:.5e}"),
    "blanks": ("# time s, acceleration m/s2\n", " {0:8.2f} {1:12.5f}"),
    "tab": ("time [s]\tacc [g]\n", "{0:.2f}\t{1:.5f}"),
    "semicolon": ("time [s];acc [g]\n", "{0:.2f};{1:.5f}"),
    "one column": ("acc [g]\n", "{1:.6g}"),
    "fortran": ("acc [g]\n", "{1:.6D}"),
}


def _read_or_refused(text: str) -> tuple[list[list[float]], float] | str:
    try:
        record = COLUMNS.read(_source(text), "g" if "[g]" not in text else None, 0.02 if "time" not in text else None)
    except RecordError as error:
        return str(error)
    return [part.acceleration.tolist() for part in record.components], record.components[0].time_step


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_plain_numbers_are_read_at_once_as_one_by_one(layout: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 300 damaged copies each has the same samples, or the same refusal with its line, as number by number."""
    heading, form = LAYOUTS[layout]
    values = np.random.default_rng(4).normal(size=30)
    rows = [form.replace("D", "e").format(0.02 * k, value) for k, value in enumerate(values)]
    good = heading + "\n".join(row.replace("e", "D") if "D" in form else row for row in rows) + "\n"
    chance = random.Random(layout)
    copies = [good, *(_damaged(good, chance) for _ in range(300))]
    copies += [good.replace(".", mark, 3) for mark in (",", "..", "e9999", "e-0001", "_", ".\u0661", "inf", "nan")]
    at_once, used = [], 0
    for text in copies:
        at_once.append(_read_or_refused(text))
        columns = ColumnText.of(_source(text))
        used += bool(columns.first) and columns.at_once is not None
    monkeypatch.setattr("rocking.motions.formats.column_text.plain_table", lambda *_: None)
    assert [_read_or_refused(text) for text in copies] == at_once
    assert sum(isinstance(found, str) for found in at_once) > 30
    assert (used > 30) == (layout != "fortran")  # the copies that are read one by one alone would compare nothing


@pytest.mark.parametrize("text", ["END\nEND\n", "end of data\nEOF", "***\n---\n", "acc [g]\nEND\n", "acc [g]\n"])
def test_a_file_without_a_line_of_numbers_is_refused(text: str) -> None:
    """Words that close a file are no line of numbers."""
    with pytest.raises(RecordError):
        COLUMNS.read(_source(text), "g", 0.02)


BBP = (
    "#    time(sec)      N-S({0})      E-W({0})      U-D({0})\n"
    "0.0\t1.0\t2.0\t3.0\n2.5e-2\t4.0\t5.0\t6.0\n5.0e-2\t7.0\t8.0\t9.0\n"
)
PAIRS = "0.00 0.1\n0.01 -0.2\n0.02 0.3\n"


def test_names_in_a_comment_are_names() -> None:
    """Units behind the names of a comment, as of SCEC's broadband platform, say what the columns are."""
    record = COLUMNS.read(_source(BBP.format("cm/s/s")))
    assert [(part.name, part.unit) for part in record.components] == [(name, "cm/s2") for name in ("N-S", "E-W", "U-D")]
    assert record.components[2].acceleration.tolist() == [3.0, 6.0, 9.0]
    with pytest.raises(RecordError, match="states the unit cm/s2, not g"):
        COLUMNS.read(_source(BBP.format("cm/s/s")), "g")
    for unit, quantity in (("cm/s", "velocity"), ("cm", "displacement")):
        for told in (None, "cm/s2"):
            with pytest.raises(RecordError, match=rf"is an acceleration in .*, but {quantity}"):
                COLUMNS.read(_source(BBP.format(unit)), told)
    # names without any unit stay a remark
    assert COLUMNS.read(_source("# t NS EW UD\n" + BBP.split("\n", 1)[1]), "g").components[0].name == "column 2"


PLATFORM = """# Station= 2001-SCE
#    time= 01/17/1994,12:30:55.00 UTC
#     lon= -118.48130000
#   units= {0}
# orientation= 0,90,UP
#
# Data fields are TAB-separated
# Column 1: Time (s)
# Column 2: North component ground {1} ({0}) (+ is 000)
# Column 3: East component ground {1} ({0}) (+ is 090)
# Column 4: Up component ground {1} ({0}) (+ is upward)
#
"""
OLDER = """% synthetic broadband seismogram (Mai&Olsen 2008)
% N = 8 header lines
% site: 5017-A-GLP
% NPTS, DT: 3 0.025
%
% time(s)    NS ({0})      EW({0})      UP ({0})
% --------------------------------------------------
"""


@pytest.mark.parametrize("header", [PLATFORM, OLDER])
def test_headers_of_the_broadband_platform(header: str) -> None:
    """The guide to its files has both: accelerations are read, velocities refused whatever the user says."""
    body = BBP.split("\n", 1)[1]
    record = COLUMNS.read(_source(header.format("cm/s^2", "acceleration") + body))
    assert {(part.unit, part.time_step, part.acceleration.size) for part in record.components} == {("cm/s2", 0.025, 3)}
    for told in (None, "cm/s2", "g"):
        with pytest.raises(RecordError, match="velocity"):
            COLUMNS.read(_source(header.format("cm/s", "velocity") + body), told)


@pytest.mark.parametrize(
    ("comment", "unit", "step"),
    [
        ("# units= cm/s^2", "cm/s2", 0.01), ("% Acceleration in g", "g", 0.01), ("# Unit: m/s/s", "m/s2", 0.01),
        ("# acceleration (gal), dt = 0.01 s", "gal", 0.01), ("# units of g, NPTS= 3, time step [s]: 0.01", "g", 0.01),
        ("# units: mg; sampling rate [Hz] = 100", "mg", 0.01), ("# units g\n# units = g", "g", 0.01),
    ],
)  # fmt: skip
def test_comments_state_unit_step_and_number(comment: str, unit: str, step: float) -> None:
    """They are used, and what the user says must agree; a lone column needs no option then."""
    part = COLUMNS.read(_source(f"{comment}\n{PAIRS}")).components[0]
    assert (part.unit, part.time_step) == (unit, step)
    with pytest.raises(RecordError, match=f"states the unit {unit}, not mm/s2"):
        COLUMNS.read(_source(f"{comment}\n{PAIRS}"), "mm/s2")
    if "0.01" in comment or "100" in comment:
        source = _source(f"{comment}\n0.1\n-0.2\n0.3\n")
        assert COLUMNS.recognises(source)
        assert COLUMNS.read(source).components[0].time_step == step
        with pytest.raises(RecordError, match=r"states a time step of 0\.01 s, not 0\.02"):
            COLUMNS.read(source, time_step=0.02)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("# units= cm/s\n" + PAIRS, "the file states cm/s, a velocity"),
        ("% Velocity in m/s\n" + PAIRS, "the file states m/s, a velocity"),
        ("# unit: cm\n" + PAIRS, "the file states cm, a displacement"),
        ("# units = counts\n" + PAIRS, "the file states counts, a count of a recorder"),
        ("# Velocity time series\n" + PAIRS, "its header contains 'Velocity'"),
        ("# dt = 0.02\n" + PAIRS, r"states a time step of 0\.01 s, not 0\.02"),
        ("# NPTS = 4\n" + PAIRS, "states 4 samples, but the file contains 3"),
        ("# NPTS, DT: 3 0.02\n" + PAIRS, r"not 0\.02 s"),
        ("# units= g\n# units= cm/s2\n" + PAIRS, "the file states the unit g, not cm/s2"),
    ],
)
def test_what_comments_contradict_is_refused(text: str, words: str) -> None:
    """A velocity is none of g, whatever the user says; a step or number that the columns do not have is damage."""
    with pytest.raises(RecordError, match=words):
        COLUMNS.read(_source(text), None if "units= g" in text else "g")


def test_remarks_say_nothing() -> None:
    """The control: words that are no statement are passed over."""
    for remark in (
        "# velocity model of the basin",
        "# dt unknown",
        "# filtered at 0.1 Hz, see units below",
        "# seed: 1",
        "# Station PGA(g)",
    ):
        part = COLUMNS.read(_source(f"{remark}\n{PAIRS}"), "g").components[0]
        assert (part.unit, part.time_step, part.acceleration.tolist()) == ("g", 0.01, [0.1, -0.2, 0.3])


@pytest.mark.parametrize("name", ["2001-SCE.vel.bbp", "a_velocity.txt", "RSN1.VT2", "x-disp.dat", "H.DT2"])
def test_a_name_of_velocities_is_refused(name: str) -> None:
    """A file that is called a velocity or displacement is none of accelerations, unless it is called that as well."""
    with pytest.raises(RecordError, match="accelerations required, but its name contains"):
        COLUMNS.read(Source(name, PAIRS.encode()), "cm/s2")
    for good in ("velvet.txt", "acc_vel_disp.txt", "displaced.txt", "level.dat"):
        assert COLUMNS.read(Source(good, PAIRS.encode()), "cm/s2").components[0].unit == "cm/s2"


def test_many_numbers_a_line_go_on_row_after_row() -> None:
    """Five or more without names are one acceleration, the last line shorter; with rising times they are columns."""
    values = [round(0.1 * k * (-1) ** k, 3) for k in range(17)]
    lines = [" ".join(map(str, values[k : k + 5])) for k in range(0, 17, 5)]
    source = _source("\n".join(lines))
    assert COLUMNS.recognises(source)
    part = COLUMNS.read(source, "g", 0.01).components[0]
    assert (part.acceleration.tolist(), part.time_step) == (values, 0.01)
    with pytest.raises(RecordError, match="add time_step="):
        COLUMNS.read(source, "g")
    for damaged, words in (("0.5 1", "line 2: 5 numbers expected"), (" ".join(["1"] * 6), "found 6")):
        with pytest.raises(RecordError, match=words):
            COLUMNS.read(_source("\n".join([lines[0], damaged, *lines[2:]])), "g", 0.01)
    wide = "\n".join(f"{0.01 * k:.2f} {k} {-k} {2 * k} {k * k}" for k in range(9))
    many = COLUMNS.read(_source(wide), "g").components
    assert [part.name for part in many] == [f"column {place}" for place in range(2, 6)]
    assert many[3].acceleration.tolist() == [float(k * k) for k in range(9)]


def test_our_own_tables_read_back_without_options(made_up) -> None:
    """Columns that are written state their unit; so do the tables of `rocking record show`, with velocities."""
    record = made_up("N-S", "a [odd], name", unit="g")
    again = COLUMNS.read(_source(COLUMNS.write(record).decode()))
    assert [(part.name, part.unit) for part in again.components] == [("N-S", "g"), ("a odd name", "g")]
    part = record.components[0]
    for name in ("#1", "N-S"):
        twice = Record("", tuple(Component(name, part.acceleration, "g", 0.02) for _ in range(2)))
        names = [one.name for one in COLUMNS.read(_source(COLUMNS.write(twice).decode())).components]
        assert names == ["column 2", "column 3"]
    table = (
        "time_s,acceleration_m_s2,velocity_m_s,displacement_m\n0.0,1.0,0.0,0.0\n0.02,2.0,0.03,0.0\n0.04,0.0,0.05,0.1\n"
    )
    (part,) = COLUMNS.read(_source(table)).components
    assert (part.name, part.unit, part.time_step, part.acceleration.tolist()) == (
        "acceleration",
        "m/s2",
        0.02,
        [1, 2, 0],
    )


def test_a_line_of_a_sampling_without_a_mark() -> None:
    """What is left of a PEER file without its first lines is a column with its step; the number of samples counts."""
    text = b"NPTS=  4, DT= .02 SEC\n1.0\n-2.0\n3.0\n0.5\n"
    (part,) = COLUMNS.read(Source("a", text), units="g").components
    assert (part.time_step, part.acceleration.tolist()) == (0.02, [1.0, -2.0, 3.0, 0.5])
    with pytest.raises(RecordError, match="5"):
        COLUMNS.read(Source("a", text.replace(b"=  4", b"=  5")), units="g")


@pytest.mark.parametrize("said", ["# dt = 0,02 s", "# Zeitschritt 0,02 s", "# passo temporale: 0.02 s", "# dt=20 ms"])
def test_steps_in_other_words(said: str) -> None:
    """A decimal comma, and other languages."""
    (part,) = COLUMNS.read(Source("a", f"{said}\n1.0\n-2.0\n3.0\n".encode()), units="g").components
    assert part.time_step == 0.02


@pytest.mark.parametrize(
    ("said", "why"), [("# period (s)  Sa (g)", "response spectrum"), ("# T [s], PSA [g]", "response spectrum"),
                      ("# counts, 200 Hz", "counts of a recorder")],
)  # fmt: skip
def test_what_is_no_acceleration_is_named(said: str, why: str) -> None:
    """A spectrum and counts, whatever unit and step the user says; a count of samples is none of a recorder."""
    rows = b"\n0.01 0.5\n0.02 0.6\n0.03 0.7\n"
    with pytest.raises(RecordError, match=why):
        COLUMNS.read(Source("a", said.encode() + rows), units="g")
    assert COLUMNS.read(Source("a", b"# counts: 3" + rows), units="g").components
