"""`rocking measurements`: a file is added, listed and counted in; `rocking reproduce` on a selection."""

import pytest

from rocking.evidence import store

pytestmark = pytest.mark.verifies(room="doors")

ROWS = """source,licence,interface,method,block,laboratory,width,height,r,uncertainty
me,CC0,oak/steel,sound,A,me,0.1,0.4,0.94,0.004
me,CC0,oak/steel,sound,B,me,0.1,0.3,0.91,0.004
"""


@pytest.fixture
def own(monkeypatch, tmp_path):
    monkeypatch.setattr(store, "data_folder", lambda: tmp_path / "data")
    path = tmp_path / "mine.csv"
    path.write_text(ROWS, "utf-8")
    return path


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_add_list_calibrate(printed, answered, own):
    """A file is added once and listed; models and calibration are then of 41 measurements in ten groups."""
    assert "added to the own measurements" in printed("measurements", "add", own)
    assert answered("measurements", "add", own)["new"] is False
    assert "already in the own measurements" in printed("measurements", "add", own)
    assert [each["measurements"] for each in answered("measurements", "list")["sets"]] == [12, 9, 9, 9, 2]
    assert "Ceh" in (page := printed("measurements", "list"))
    assert f"\n{store.own_files()[0].name} " in page  # by its name; the folder is said once
    found = answered("measurements", "calibrate")
    assert (found["measurements"], len(found["left_out_groups"])) == (41, 10)
    assert sum(found["shares"].values()) == pytest.approx(1.0)
    assert answered("measurements", "calibrate", "published")["measurements"] == 39
    page = printed("measurements", "calibrate", "S", "M", own)
    assert "20 measurements of r" in page
    assert "me: oak/steel" in page


@pytest.mark.verifies("behaviour")
def test_details_list_every_measurement(printed, answered, own):
    """--details lists the 39 published rows, with block S1 of Table 3 of Mao et al. (2024); without, there are none."""
    assert "values" not in answered("measurements", "list")
    rows = answered("measurements", "list", "--details")["values"]
    assert len(rows) == 39
    first = {"set": "S", "block": "S1", "slenderness_ratio": 1.5, "mass": 0.1133, "coefficient": 0.69}
    (row,) = (row for row in rows if row["block"] == "S1")
    assert {name: row[name] for name in first} == pytest.approx(first)
    assert rows[0]["mass"] is None  # not stated in Table 1
    assert "granite/granite" in printed("measurements", "list", "--details")
    assert "granite/granite" not in printed("measurements", "list")


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_paper_on_a_selection(answered, own):
    """League and calibration of the paper's report are of what is selected; tables, errata and claims stay."""
    found = answered("reproduce", "published", own)
    assert "me" in found["league"][0]["by_group"]
    assert found["covered"]["one_by_one"][1] == 41
    assert len(found["hierarchy"]["left_out_groups"]) == 10
    whole = answered("reproduce")
    assert found["claims"] == whole["claims"]
    assert found["league"] != whole["league"]


@pytest.mark.verifies("damage")
def test_what_is_refused(refuses, own, tmp_path):
    """A word that is no selection, a file that is none, and too few blocks are refused in a sentence."""
    refuses(["measurements", "calibrate", "T"], "unknown measurements 'T'")
    refuses(["measurements", "calibrate", "own"], "rocking measurements add FILE")
    refuses(["measurements", "calibrate", own], "at least 5 blocks are required, got 2")
    refuses(["measurements", "add", tmp_path / "none.csv"], "cannot be read")
    assert store.own_files() == []


def test_a_name_that_cannot_be_reproduced_lists_the_papers(refuses):
    """A refusal lists papers, sets and output; a near miss has a suggestion, and no other name has one."""
    refuses(("reproduce", "figure8"), "papers: mao-2024, gaibor-2026")
    refuses(("reproduce", "gaibor2026"), "did you mean 'gaibor-2026'?")
    refuses(("reproduce", "publshed"), "did you mean 'published'?")
    refuses(("reproduce", "published", "gaibor-2026"), "gaibor-2026 cannot be combined with other names")
