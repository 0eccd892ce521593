"""Names of studies and files, as users make them up."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.app.studies.study_folder import file_name, is_id, new_id, shown

HOSTILE = [
    "../../etc/passwd", "..", ".", "", " ", "a/b\\c", "CON", "nul.txt", "a\x00b", "a\nb", "a\u202etxt.exe", "x" * 5000,
    "*?[ab]", "-rf", "'; DROP TABLE", "<script>", "\ud800", "\u200b", ".hidden", "~root",
    "%2e%2e%2f", "a:b", "LPT1.AT2",
]  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE)
def test_no_name_becomes_more_than_one_plain_file(text: str) -> None:
    """A file name of a user has no path, no pattern, no reserved word, and no leading dot or dash left in it."""
    made = file_name(text)
    assert made
    assert len(made) <= 90
    assert set(made) <= set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-")
    assert made[0] not in ".-"
    assert made.partition(".")[0].lower() not in {"con", "nul", "lpt1"}


@given(st.text())
def test_what_is_shown_is_one_line_that_hides_nothing(text: str) -> None:
    """Control characters, direction marks and halves of characters never reach a page."""
    made = shown(text)
    assert made == made.strip()
    assert 0 < len(made) <= 120
    assert not {unicodedata.category(mark) for mark in made} & {"Cc", "Cf", "Cs", "Co", "Cn"}


@pytest.mark.parametrize("text", ["", "..", "0" * 15, "0" * 17, "A" * 16, "g" * 16, "0" * 16 + "\n", "../" + "0" * 13])
def test_only_drawn_names_are_folders(text: str) -> None:
    """What is not sixteen hexadecimal digits is no study; what is drawn is."""
    assert not is_id(text)
    assert is_id(new_id())
