"""`rocking campaign export`: pictures of every kind that has one, and nothing written where one WHAT cannot be."""

import pytest
from campaign_jobs import BODY, PULSE, TWO_MODELS, axes, job, search
from campaign_jobs import finished as through

from rocking.cli.campaign_export import write
from rocking.errors import InvalidValueError
from rocking.spec.question import StudyQuestion
from rocking.spec.questions import questions

pytest.importorskip("matplotlib")
NOTHING = {"restitution": None, "crossing_curves": None, "inputs": None, "as_json": False}
OTHERS = {
    "several maps": job("overturning-map", BODY, PULSE, TWO_MODELS, axes()),
    "refined": job("overturning-map", BODY, PULSE, axes(), "refine = 1\ntolerance = 0.01\n"),
    "minimum-acceleration": job("minimum-acceleration", search(6, 0.05)),
    "nothing computed": job("minimum-acceleration", "[settings]\nmost_events = 1\n", search(6, 0.05)),
}
OF_CALL = ["overturning-map", "rocking-spectrum", "stripes", "incremental", "cloud"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", [*OF_CALL, "several maps", "refined", "minimum-acceleration"])
def test_picture(finished, tmp_path, capsys, kind):
    """By its ending, or by name, whatever the kind; several restitutions are compared where none is named."""
    folder = through(tmp_path / "c", OTHERS[kind]) if kind in OTHERS else finished(kind)
    write(folder.path, [str(tmp_path / "a.png"), f"picture={tmp_path / 'b.svg'}"], **NOTHING)
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (tmp_path / "b.svg").read_bytes()
    assert capsys.readouterr().out.count("picture of ") == 2


def test_kinds_with_and_without():
    """Of the kinds there are, one has no picture; the picture of an inventory stands beside its report."""
    without = {kind for kind, question in questions().items() if question.plot is StudyQuestion.plot}
    assert without == {"histories"}


@pytest.mark.parametrize(
    ("kind", "second", "words"),
    [
        ("histories", "maps={}/b.nc", "CONTENT must be one of histories, .*, report, picture, got 'maps'"),
        ("histories", "fragility={}/b.nc", 'nothing to export because a campaign of kind "histories" has no'),
        ("histories", "{}/b.doc", r"histories can be written as .* got '\.doc'"),
        ("histories", "{}/none/b.nc", "no folder"),
        ("histories", "report={}/b.html", "report can be used for inventories only"),
        ("histories", "{}/b.png", 'A campaign of kind "histories" has no figure; export its table'),
        ("histories", "{}/a.nc", "a.nc is given twice"),
        ("overturning-map", "picture={}/b.nc", r"a picture must be \.png, \.svg, \.pdf, got '\.nc'"),
        ("overturning-map", "{}/none/b.png", "no folder"),
    ],
)
def test_all_is_checked_before_anything_is_written(finished, tmp_path, kind, second, words):
    """The second file cannot be: the first one, which could, is not written either."""
    folder = finished(kind)
    with pytest.raises(InvalidValueError, match=words):
        write(folder.path, [str(tmp_path / "a.nc"), second.format(tmp_path)], **NOTHING)
    assert not list(tmp_path.glob("*.*"))


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"restitution": "ked"}, r"restitution must be one of 0\.9, got 'ked'"),
        ({"crossing_curves": "refuse"}, "--crossing-curves is for"),
    ],
)
def test_options_of_a_picture(finished, tmp_path, how, words):
    """A restitution that the job has not, and what is about written curves."""
    with pytest.raises(InvalidValueError, match=words):
        write(finished("incremental").path, [str(tmp_path / "a.png")], **(NOTHING | how))


def test_search_without_a_result(tmp_path):
    """Where no history of a motion could be computed, the sentence says of which."""
    folder = through(tmp_path / "c", OTHERS["nothing computed"])
    with pytest.raises(InvalidValueError, match=r"no history of .*, body \d with restitution 0\.85 has a result"):
        write(folder.path, [str(tmp_path / "a.png")], **NOTHING)


@pytest.mark.slow
def test_which_restitution_is_drawn(finished, tmp_path, text):
    """Clouds and incremental analyses have a picture of each restitution, and none that compares them."""
    folder = finished("cloud", None, text("cloud") + TWO_MODELS)
    with pytest.raises(InvalidValueError, match="one of housner, ked, because every restitution has a picture of its"):
        write(folder.path, [str(tmp_path / "a.png")], **NOTHING)
    write(folder.path, [str(tmp_path / "a.png")], **(NOTHING | {"restitution": "ked"}))
    assert (tmp_path / "a.png").exists()
