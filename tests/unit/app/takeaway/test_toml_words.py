"""TOML of our own: a standard reader returns what was written, digit by digit."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.app.takeaway.toml_words import toml_of, toml_value
from rocking.errors import InvalidValueError

TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)
NUMBERS = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(2**63), 2**63 - 1)
FLAT = st.booleans() | NUMBERS | TEXT | st.lists(NUMBERS, max_size=30) | st.lists(st.lists(NUMBERS, max_size=3))
TABLES = st.recursive(
    st.dictionaries(TEXT, FLAT, max_size=4),
    lambda inner: st.dictionaries(TEXT, FLAT | inner | st.lists(inner, min_size=1, max_size=3), max_size=4),
    max_leaves=8,
)


@given(TABLES)
def test_what_is_written_is_read(document):
    """Keys and text with any character, numbers to the last digit, tables in tables and lists of tables survive."""
    read = tomllib.loads(toml_of(document))
    assert read == document
    assert repr(read) == repr(document) or sorted(read) == sorted(document)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_keep_every_digit(number):
    """A float comes back with the same bits, the sign of zero included."""
    read = tomllib.loads(f"x = {toml_value(number)}")["x"]
    assert isinstance(read, float)
    assert read.hex() == number.hex()


def test_text_cannot_leave_its_quotes():
    """A name that looks like TOML stays a name, and what cannot be seen is spelled out."""
    name = 'x"\n[restitution]\nvalue = 0.1\n#\u202e\x7f'
    text = toml_of({"body": {"name": name}})
    assert tomllib.loads(text) == {"body": {"name": name}}
    assert text.count("\n") == 2
    assert "\u202e" not in text


def test_what_toml_does_not_know_is_refused():
    """A value of another kind is refused with its name."""
    with pytest.raises(InvalidValueError, match="object"):
        toml_value(object())
