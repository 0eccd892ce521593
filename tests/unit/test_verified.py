"""The manual's page of verification comes from marks of the tests, which are complete and state no other figures."""

import re
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2] / "docs" / "_ext"))  # what makes the tables lies beside the page
pytest.importorskip("sphinx")

from verified import (
    COUNTED,
    KINDS,
    ROOMS,
    ROOT,
    RUNS,
    STATED,
    Outcome,
    claims,
    claims_of,
    faults,
    figures,
    outcomes,
    stated,
)

PAGE = (ROOT / "docs/verified.md").read_text("utf-8")

GOOD = '''
import pytest
pytestmark = [pytest.mark.verifies(room="bodies"), pytest.mark.slow]
BOUND = 1e-9
@pytest.mark.verifies("closed form", "the sum", within="1e-9, or 2 %", control="test_wrong", doi="10.1000/abc")
def test_right():
    """It is right,
    as always.

    And more."""
    assert abs(found() - 1.0) < BOUND + 0.02
@pytest.mark.verifies("negative control")
def test_wrong():
    """It is wrong."""
    assert 3.0
'''
PATH = "tests/verification/test_made.py"


@pytest.fixture(scope="module")
def found():
    """All claims of the tests."""
    return claims()


def test_marks_have_no_faults(found):
    """Every test of verification and validation says what it verifies, against what, and with figures of its own."""
    assert faults(found) == []
    assert len([claim for claim in found if "/unit/" not in claim.path]) > 500
    assert {claim.kind for claim in found} == set(KINDS)
    assert {claim.room for claim in found} == set(ROOMS)


def test_a_mark_is_read():
    """Words, kind and figures of the test, its room from the file; numbers of other tests are not its own."""
    right, wrong = claims_of(GOOD, PATH)
    assert faults([right, wrong]) == []
    assert right.description == "It is right, as always."
    assert (right.room, right.kind, right.control) == ("bodies", "closed form", "test_wrong")
    assert (wrong.room, wrong.kind, wrong.control) == ("bodies", "negative control", "")
    assert 3.0 in wrong.numbers
    assert 3.0 not in right.numbers


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ('@pytest.mark.verifies("negative control")', "", "has no mark"),
        ("It is wrong.", "", "does not say in its docstring"),
        ('"closed form"', '"closed"', "unknown kind 'closed'"),
        ('"bodies"', '"cellar"', "unknown room 'cellar'"),
        (', "the sum"', "", "does not say against what"),
        ("doi=", "by=", "unknown word 'by'"),
        ("10.1000/abc", "doi:10.1000/abc", "malformed DOI"),
        ("BOUND = 1e-9", "BOUND = 1e-8", "states 1e-09"),
        ("1e-9, or 2 %", "1e-9, or 3 %", "states 3 in its mark"),
        ('control="test_wrong"', 'control="test_right"', "no negative control"),
        ('control="test_wrong"', 'control="test_gone"', "no negative control"),
    ],
)
def test_every_fault_is_seen(old, new, fault):
    """Negative control: a good file with one fault each."""
    assert old in GOOD
    assert [line for line in faults(claims_of(GOOD.replace(old, new), PATH)) if fault in line]


def test_tests_elsewhere_need_no_mark():
    """Of the other tests those are taken that have one."""
    assert [each.test for each in claims_of(GOOD.replace("pytestmark", "x"), "tests/unit/test_made.py")] == [
        "test_right", "test_wrong",
    ]  # fmt: skip
    assert claims_of("def test_plain():\n    assert f()", "tests/unit/test_made.py") == []


def test_figures_of_words():
    """Powers of ten, thousands and decimals; nought needs no proof."""
    assert figures("1e-12 of 2,000 in 0.5 %, 0 lost, 3e5 found") == [1e-12, 2000.0, 0.5, 3e5]


def test_what_a_run_measured_stands_beside_what_was_asked(tmp_path):
    """The largest deviation over the cases of a test in both runs; failures and skipped tests are said."""
    cases = [
        f'<testcase classname="tests.verification.test_made" name="{name}">{inside}</testcase>'
        for name, inside in (
            ("test_right[a]", '<properties><property name="deviation" value="3e-12"/></properties>'),
            ("test_right[b]", '<properties><property name="deviation" value="1e-10"/></properties>'),
            ("test_wrong", '<skipped message="no"/>'),
            ("test_bad", '<failure message="no"/>'),
        )
    ]
    (tmp_path / "build").mkdir()
    for path, day, of_run in zip(RUNS[:2], ("01", "02"), (cases[::2], cases[1::2]), strict=True):
        suite = f'<testsuite timestamp="2026-01-{day}T03:04:05">{"".join(of_run)}</testsuite>'
        (tmp_path / path).write_text(f"<testsuites>{suite}</testsuites>")
    results, when = outcomes(tmp_path)
    assert when == "2026-01-02"
    assert results[PATH, "test_right"] == Outcome(passed=2, measured=1e-10)
    assert results[PATH, "test_wrong"] == Outcome(skipped=1)
    assert results[PATH, "test_bad"] == Outcome(failed=1)
    assert outcomes(tmp_path / "none") == ({}, "")


def test_every_room_has_its_table(found):
    """The page asks for the claims of each room once, and for no others."""
    asked = re.findall(r"^:room: (.+)$", PAGE, re.M)
    assert asked == list(ROOMS)
    assert sum(claim.room in asked for claim in found) == len(found)


def test_what_the_page_names_is_there(found):
    """Every figure that it asks for is stated where it is looked for, and every test it names is one that is marked."""
    names = {f"{claim.path.rpartition('/')[2]}::{claim.test}" for claim in found}
    assert set(re.findall(r"\{claim\}`([^`]+)`", PAGE)) <= names
    asked = re.findall(r"\{stated\}`([^`]+)`", PAGE)
    assert set(asked) == STATED.keys() | COUNTED.keys()
    assert [name for name in asked if not stated(name)] == []


def test_a_figure_that_is_no_longer_stated_is_missed(monkeypatch):
    """Negative control: the page does not go on with a figure that a file states no more."""
    monkeypatch.setitem(STATED, "kills", ("Makefile", r"ROCKING_NOTHING=(\d+)"))
    with pytest.raises(LookupError, match=r"kills in Makefile, which no longer"):
        stated("kills")
