"""`rocking inventory`: what it prints and writes, and refusals in one sentence."""

import json

import pytest
import typer

from rocking.cli.inventory import inventory
from rocking.errors import InvalidValueError, RecordError, UnknownModelError

LIST = "name;width_cm;depth_cm;height_cm\ntall vase;12,5;12,5;95\nchest;120;60;50\nmirror;?;20;160\n"
# a triangle of 1 m/s2
RECORD = "0.0 0.0\n0.5 1.0\n1.0 0.0\n"


def run(*words):
    """Run the command; its errors pass through."""
    app = typer.Typer(pretty_exceptions_enable=False)
    app.callback()(lambda: None)
    app.command()(inventory)
    app(args=["inventory", *(str(word) for word in words)], standalone_mode=False)


@pytest.fixture
def objects(tmp_path):
    """File of two objects and a bad row."""
    path = tmp_path / "objects.csv"
    path.write_text(LIST, encoding="utf-8")
    return path


@pytest.fixture
def record(tmp_path):
    """File of a record."""
    path = tmp_path / "record.txt"
    path.write_text(RECORD, encoding="utf-8")
    return path


FEW = ("--synthetic", "point-source", "--count", "80", "--seed", "2")


def test_ranking_is_printed(capsys, objects):
    """The worst first with letter and word, then the row that could not be read, the thresholds and sliding."""
    run(objects, "--pga", "0.3g", *FEW)
    out = capsys.readouterr().out
    marks = (
        "1  R RED    tall vase",
        "2  G GREEN  chest",
        "not assessed: mirror, line 4",
        "GREEN: No motion",
        "Sliding",
    )
    places = [out.index(words) for words in marks]
    assert places == sorted(places)
    # 12.5 / 95 = 0.1316, rounded down
    assert "Stays still up to 0.13 g; at PGA 0.3 g it rocks, and fell over in " in out


def test_json_is_the_same_twice_and_other_with_another_seed(capsys, objects):
    """JSON of the same seed is the same text; another seed gives other counts."""
    texts = []
    for seed in (2, 2, 3):
        run(objects, "--pgv", "15cm/s", "--synthetic", "point-source", "--count", "40", "--seed", seed, "--json")
        texts.append(capsys.readouterr().out)
    assert texts[0] == texts[1]
    answers = [json.loads(text) for text in texts]
    assert answers[0]["hazard"]["level"] == "PGV 0.15 m/s"
    assert answers[0]["objects"] != answers[2]["objects"]
    assert answers[0]["not_assessed"] == [
        {"row": 4, "name": "mirror", "reason": answers[0]["not_assessed"][0]["reason"]}
    ]


def test_records_as_recorded_and_scaled(capsys, objects, record):
    """A record of 1 m/s2 does not lift the vase, g b / h = 1.29 m/s2; scaled to 0.14 g it does."""
    lifted = []
    for level in ([], ["--pga", "0.14g"]):
        run(objects, "--motion", record, "--units", "m/s2", *level, "--json")
        answer = json.loads(capsys.readouterr().out)
        vase = next(item for item in answer["objects"] if item["name"] == "tall vase")
        lifted.append(vase["directions"][0]["lifted"])
        assert answer["hazard"]["number_of_motions"] == 1
    assert lifted == [0, 1]


def test_report_is_written(capsys, objects, tmp_path):
    """Files are written and named; a coefficient serves as restitution."""
    run(objects, "--pga", "0.3g", *FEW, "--restitution", "0.9", "--out", tmp_path / "out")
    out = capsys.readouterr().out
    for kind in ("html", "pdf", "csv", "json"):
        assert (tmp_path / "out" / f"inventory.{kind}").stat().st_size > 500
        assert f"inventory.{kind}" in out
    assert json.loads((tmp_path / "out" / "inventory.json").read_text(encoding="utf-8"))["restitution"] == "0.9"


@pytest.mark.parametrize(
    ("words", "kind", "sentence"),
    [
        ((), InvalidValueError, "how strong is the shaking"),
        (("--pga", "0.3"), InvalidValueError, "with its unit"),
        (("--pga", "0.3g", "--pgv", "1m/s"), InvalidValueError, "not both"),
        (("--pga", "0.3g", "--synthetic", "x"), InvalidValueError, "family must be one of"),
        (("--pga", "0.3g", "--count", "0"), InvalidValueError, "count must be"),
        (("--pga", "0.3g", "--count", "2", "--seed", "-1"), InvalidValueError, "seed must be"),
        (("--pga", "0.3g", "--units", "g"), InvalidValueError, "--units is for record files"),
        (("--pga", "0.3g", "--restitution", "no-such"), UnknownModelError, "no-such"),
        (("--motion", "no-such.txt"), RecordError, "no such file"),
        (("--motion", "x", "--count", "3"), InvalidValueError, "--count is for synthetic motions"),
        (("--motion", "sine:amplitude=3,period=0.8"), InvalidValueError, "--motion takes record files"),
    ],
)
def test_refusals(objects, words, kind, sentence):
    """Every contradiction is an error of this package, in one sentence."""
    with pytest.raises(kind, match=sentence):
        run(objects, *words)


def test_file_that_is_not_there(tmp_path):
    """A list that does not exist is the operating system's error, which `main` prints."""
    with pytest.raises(FileNotFoundError):
        run(tmp_path / "none.csv", "--pga", "0.3g")


def test_a_column_that_looks_like_a_measure_is_not_dropped(objects):
    """A narrow foot under a name that is not known refuses the list in one sentence: no confident green without it."""
    objects.write_text("name,width_cm,depth_cm,height_cm,foot_diameter_cm\nurn,40,40,90,8\n", encoding="utf-8")
    with pytest.raises(InvalidValueError, match=r"column 'foot_diameter_cm' is not known but looks like a measure"):
        run(objects, "--pga", "0.1g", *FEW)


def test_level_without_a_leading_zero(capsys, objects):
    """A level may be typed as .3g."""
    run(objects, "--pga", ".3g", *FEW, "--json")
    assert json.loads(capsys.readouterr().out)["hazard"]["level"] == "PGA 0.3 g"
