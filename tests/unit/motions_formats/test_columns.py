"""Columns without a header: shapes, times to the rounding of their digits, and nothing guessed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats import Component, Record, Source
from rocking.motions.formats.columns import Columns

COLUMNS = Columns()


def _source(text: str) -> Source:
    return Source("hand.txt", text.encode("latin-1"))


def test_one_value_a_line() -> None:
    """One column needs unit and step from the user, and says so."""
    source = _source("# comment\n0.1\n\n -0.2e0\n+.3D-1\n")
    assert COLUMNS.recognises(source)
    part = COLUMNS.read(source, "g", 0.02).components[0]
    assert (part.name, part.unit, part.time_step) == ("acceleration", "g", 0.02)
    assert part.acceleration.tolist() == [0.1, -0.2, 0.03]
    with pytest.raises(RecordError, match="say units= one of"):
        COLUMNS.read(source, time_step=0.02)
    with pytest.raises(RecordError, match="say time_step="):
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
    for missing in (1, 200, 398):
        with pytest.raises(RecordError, match="not evenly spaced"):
            COLUMNS.read(_source("\n".join(rows[:missing] + rows[missing + 1 :])), "g")


def test_single_precision_times() -> None:
    """Times that went through single precision are accepted."""
    times = np.arange(5000, dtype=np.float32) * np.float32(0.02)
    text = "\n".join(f"{float(t):.9f} 1.0" for t in times)
    assert COLUMNS.read(_source(text), "g").components[0].time_step == 0.02


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.00 1.0\n0.01 2.0\n0.03 1.0\n0.04 1.0\n", "not evenly spaced"),
        ("0.00 1.0\n0.02 2.0\n0.01 1.0\n0.03 1.0\n", "not evenly spaced"),
        ("0.0 1.0\n0.0 2.0\n0.0 1.0\n", "is the first column a time"),
        ("0.00 1.0\n0.00 2.0\n0.01 1.0\n0.01 1.0\n0.02 1.0\n", "too few digits"),
        ("0.00 1.0\n0.01\n0.02 1.0\n", "line 2: 2 numbers expected as on the first line, found 1"),
        ("0.00 1.0\n0.01 nan\n0.02 1.0\n", "line 2: number expected, found 'nan'"),
        ("0.00 1.0\n0.01 1.0.0\n0.02 1.0\n", "line 2: number expected"),
        ("1 2 3 4 5\n1 2 3 4 5\n", "1 to 4 columns expected, found 5"),
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


def test_recognition_is_by_the_first_lines() -> None:
    """Text, five columns, binary content and a foreign header are no columns."""
    for text in ("Header\n1 2\n", "1 2 3 4 5\n", "1 2\n1 2 3\n", "\0\0", "# none\n", "#SampleRate(Hz): 50\n0 1\n1 2\n"):
        assert not COLUMNS.recognises(_source(text))


def test_contradicting_step_is_refused() -> None:
    """A step that differs from the time column's is refused, one within its digits is taken."""
    text = "0.0000 1.0\n0.0033 2.0\n0.0067 1.0\n0.0100 1.0\n"
    assert COLUMNS.read(_source(text), "g", 0.01 / 3.0).components[0].time_step == 0.01 / 3.0
    with pytest.raises(RecordError, match=r"you say 0.004"):
        COLUMNS.read(_source(text), "g", 0.004)


@given(st.lists(st.floats(-1e5, 1e5), min_size=2, max_size=20), st.sampled_from([1e-3, 0.005, 1.0 / 128.0, 0.02]))
def test_round_trip_is_exact(values: list[float], step: float) -> None:
    """Every sample comes back to the last bit, and the step with it."""
    record = Record("x", (Component("a", np.array(values), "m/s2", step),))
    part = COLUMNS.read(_source(COLUMNS.write(record).decode()), "m/s2", step).components[0]
    assert part.acceleration.tolist() == values
    assert part.time_step == step


def test_writer_refuses_what_columns_cannot_hold(made_up) -> None:
    """Components of unequal length, and more than three, do not fit."""
    two = made_up("a", "b")
    short = Component("b", two.components[1].acceleration[:-1], "m/s2", 0.02)
    with pytest.raises(RecordError, match="same length and step"):
        COLUMNS.write(Record("x", (two.components[0], short)))
    with pytest.raises(RecordError, match="1 to 3 components"):
        COLUMNS.write(made_up("a", "b", "c", "d"))
