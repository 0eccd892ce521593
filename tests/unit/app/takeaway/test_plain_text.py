"""Words of users: one line, nothing invisible, no formula, no folder."""

import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.app.takeaway.plain_text import plain_line, record_file_name
from rocking.tables import escaped

ALLOWED = set(string.ascii_letters + string.digits + "._-")
FORMULAS = ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "\n=1", " =1", "\u202e=1", "\x00=1", "\uff1d1", "\uff0b1"]


@given(st.text(max_size=300))
def test_lines_are_printable_and_bounded(text):
    """Whatever comes in, one printable line of bounded length comes out, and doing it twice changes nothing."""
    line = plain_line(text)
    assert line.isprintable()
    assert len(line) <= 160
    assert plain_line(line) == line


@pytest.mark.parametrize("text", FORMULAS)
def test_formulas_become_text(text):
    """What a spreadsheet would compute gets an apostrophe, also behind white space and invisible marks."""
    assert escaped(plain_line(text)).startswith("'")


@pytest.mark.parametrize("text", ["Vase 3", "3-1", "a=b", "'quoted", "(-1)", ""])
def test_other_text_stays(text):
    """Text that starts no formula is not touched: the negative control of the rule above."""
    assert escaped(plain_line(text)) == text


@given(st.text(max_size=300))
def test_file_names_are_harmless(name):
    """Any name becomes letters, digits, dots, dashes and underscores: no folder, not hidden, not reserved, bounded."""
    safe = record_file_name(name)
    assert safe
    assert set(safe) <= ALLOWED
    assert not safe.startswith((".", "-"))
    assert ".." not in safe.split("/")
    assert len(safe) <= 82
    assert safe.lower() not in {"response.toml", "readme.txt", "con", "nul", "aux", "prn"}


def test_ordinary_file_names_stay():
    """A usual name of a record keeps every character, its ending in particular."""
    for name in ("RSN1106_KOBE_KJM000.AT2", "x.smc", "IWT0101103111446.EW", "record-1.csv"):
        assert record_file_name(name) == name
