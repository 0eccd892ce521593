"""Tables of what was seen: separators, words and decimals; each bad row by itself, and tables that mislead."""

import math

import pytest

from rocking.decision.prediction._score import Outcomes, is_outcomes
from rocking.errors import InvalidValueError

HEAD = "motion,scale,overturned,rocked,slid,day"


def parsed(*lines, head=HEAD):
    return Outcomes.parsed("\n".join([head, *lines]), "seen.csv")


def test_what_a_table_says():
    found = parsed("a.at2,1.5,yes,TRUE,0,Monday", "", "a.at2#NS,,0,,,")
    first, second = found.trials
    assert (first.files, first.scale, first.observed["sliding"]) == ((("x", "a.at2"),), 1.5, 0.0)
    assert (first.observed["overturning"], first.observed["uplift"]) == (1.0, 1.0)
    assert (second.line, second.scale, second.motion) == (4, 1.0, "a.at2#NS")
    assert math.isnan(second.observed["uplift"])
    assert (found.refused, found.ignored) == ((), ("day",))


@pytest.mark.parametrize(
    ("head", "row"), [("X;y;Z;scale;Overturned", "a;b;;0,5;1"), ("x\ty\tz\tscale\toverturned", "a\tb\t\t0.5\t1")]
)
def test_components_and_separators(head, row):
    (trial,) = parsed(row, head=head).trials
    assert (trial.files, trial.scale, trial.motion) == ((("x", "a"), ("y", "b")), 0.5, "x=a y=b")


def test_a_bad_row_does_not_touch_the_others():
    """Every kind of it, with its line; the good rows around are as they are alone."""
    bad = {
        "a,1,perhaps,,,": "overturned must be 1, 0, yes, no, true, false or empty, got 'perhaps'",
        "a,1,1,2,,": "rocked must be 1, 0, yes, no, true, false or empty, got '2'",
        "a,twice,1,,,": "scale must be one number",
        "a,0,1,,,": "scale must not be 0",
        ",1,1,,,": "motion is empty",
        "a,1,1": "the line has 3 fields, but the first line has 6; check the separators",
        "a,1,5,1,0,,": "the line has 7 fields, but the first line has 6; check for decimal commas",
    }
    found = parsed("a,1,1,,,", *bad, "b,2,0,,,")
    assert [(trial.line, trial.motion) for trial in found.trials] == [(2, "a"), (10, "b")]
    assert [each.line for each in found.refused] == list(range(3, 10))
    for each, why in zip(found.refused, bad.values(), strict=True):
        assert each.reason.startswith(why)


@pytest.mark.parametrize(
    ("head", "why"),
    [
        ("motion,result", "first line names the columns motion"),
        ("scale,overturned", "either the column motion, or x with y and z"),
        ("motion,x,overturned", "use either"),
        ("motion,y,overturned", "column 'y' requires the column x"),
        ("motion,scale,scale,overturned", "column 'scale' appears twice"),
        ("motion,scale factor,overturned", "unknown column 'scale factor'; rename it to 'scale'"),
        ("motion,scael,overturned", "rename it to 'scale'"),
    ],
)
def test_tables_that_mislead_are_refused(head, why):
    with pytest.raises(InvalidValueError, match=why):
        parsed("a,1,1,1", head=head)


def test_which_file_is_a_table(tmp_path):
    (tmp_path / "seen.csv").write_text("\ufeffmotion;overturned\na;1", "utf-8")
    (tmp_path / "record.csv").write_text("0,1\n2,3", "utf-8")
    assert is_outcomes(tmp_path / "seen.csv")
    assert not is_outcomes(tmp_path / "record.csv")
    assert not is_outcomes(tmp_path / "none.csv")
    (tmp_path / "old.csv").write_bytes("motion,overturned\nSägewerk,1".encode("latin-1"))
    with pytest.raises(InvalidValueError, match="not UTF-8"):
        Outcomes.read(tmp_path / "old.csv")
