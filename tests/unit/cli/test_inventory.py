"""`rocking inventory`: what it prints and writes, and refusals in one sentence."""

import json

import pytest
from unit.decision.inventory import museum_list

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.restitution.headline import headline

pytestmark = pytest.mark.slow

LIST = "name;width_cm;depth_cm;height_cm\ntall vase;12,5;12,5;95\nchest;120;60;50\nmirror;?;20;160\n"
# a triangle of 1 m/s2
RECORD = "0.0 0.0\n0.5 1.0\n1.0 0.0\n"


COMMAND = "inventory"


@pytest.fixture
def objects(file):
    """File of two objects and a bad row."""
    return file(LIST, "objects.csv")


@pytest.fixture
def record(file):
    """File of a record."""
    return file(RECORD, "record.txt")


FEW = ("--synthetic", "point-source", "--count", "80", "--seed", "2")


def test_json_is_the_same_twice_and_other_with_another_seed(printed, objects):
    """JSON of the same seed is the same text; another seed gives other counts."""
    texts = []
    for seed in (2, 2, 3):
        few = ("--synthetic", "point-source", "--count", "40", "--seed", seed)
        texts.append(printed(objects, "--pgv", "15cm/s", *few, "--json"))
    assert texts[0] == texts[1]
    answers = [json.loads(text) for text in texts]
    assert answers[0]["hazard"]["level"] == "PGV 0.15 m/s"
    assert answers[0]["objects"] != answers[2]["objects"]
    assert answers[0]["not_assessed"] == [
        {"row": 4, "number": "", "name": "mirror", "note": "", "reason": answers[0]["not_assessed"][0]["reason"]}
    ]


def test_records_as_recorded_and_scaled(answered, objects, record):
    """A record of 1 m/s2 does not lift the vase, g b / h = 1.29 m/s2; scaled to 0.14 g it does."""
    lifted = []
    for level in ([], ["--pga", "0.14g"]):
        answer = answered(objects, "--motion", record, "--units", "m/s2", *level)
        vase = next(item for item in answer["objects"] if item["name"] == "tall vase")
        lifted.append(vase["directions"][0]["lifted"])
        assert answer["hazard"]["number_of_motions"] == 1
    assert lifted == [0, 1]


def test_report_is_written(printed, objects, tmp_path):
    """Files are written and named; a coefficient serves as restitution."""
    out = printed(objects, "--pga", "0.3g", *FEW, "--restitution", "0.9", "--output", tmp_path / "out")
    for kind in ("html", "pdf", "csv", "json"):
        assert (tmp_path / "out" / f"inventory.{kind}").stat().st_size > 500
        assert f"inventory.{kind}" in out
    assert json.loads((tmp_path / "out" / "inventory.json").read_text(encoding="utf-8"))["restitution"] == "0.9"


def test_the_table_has_the_rating_of_each_model(printed, answered, objects):
    """The columns of an object are its ratings by the model of the result, then by the models of comparison."""
    options = (objects, "--pga", "0.2g", *FEW)
    answer, lines = answered(*options), printed(*options).splitlines()
    models = [answer["restitution"], *answer["comparisons"]]
    start = next(k for k, line in enumerate(lines) if line.split()[: len(models)] == models)
    assert models == ["calibrated", "housner", "ked"]
    for line, item in zip(lines[start + 1 :], answer["objects"], strict=False):
        ratings = [item["rating"], *(item["rating_by_comparison"][name] for name in models[1:])]
        assert line.split()[1:4] == [rating.upper() for rating in ratings]
        assert item["depends_on_model"] is (len(set(ratings)) > 1)
    assert sum(item["depends_on_model"] for item in answer["objects"]) < len(answer["objects"])  # negative control


def test_level_without_a_leading_zero(answered, objects):
    """A level may be typed as .3g."""
    assert answered(objects, "--pga", ".3g", *FEW)["hazard"]["level"] == "PGA 0.3 g"


def test_in_german_with_a_plan(printed, objects):
    """A language by --set: German sentences, decimal commas, and what to do first; of none, English and said so."""
    out = printed(objects, "--pga", "0.3g", *FEW, "--set", "inventory.language=de")
    for words in (
        "1  ROT         ROT      ROT      tall vase: Steht still bis 0,13 g",
        "Standfläche auf jeder Seite",
    ):
        assert words in out
    assert "No uplift below" not in out
    english = printed(objects, "--pga", "0.3g", *FEW, "--set", "inventory.language=el")
    assert "in the language el. No translation exists" in english
    assert "First measures" in english


def test_one_default_seed(printed, objects, tmp_path):
    """Without a seed a question in a file is that of the command line; another seed is another answer."""
    few = ("--synthetic", "point-source", "--count", "5")
    told = json.loads(printed(objects, "--pga", "0,3g", *few, "--json"))
    job = tmp_path / "job.toml"
    text = "[inventory]\nobjects = 'objects.csv'\npga = '0.3g'\n[motions]\nsynthetic = 'point-source'\ncount = 5\n"
    job.write_text(text, encoding="utf-8")
    assert json.loads(printed(job, "--json"))["objects"] == told["objects"]
    job.write_text(f"{text}seed = 0\n", encoding="utf-8")
    assert json.loads(printed(job, "--json"))["objects"] != told["objects"]


def test_no_object_assessed_is_a_failure(run, tmp_path):
    """A list of which no row can be assessed ends with status 1, its rows and reasons, and no file."""
    path = tmp_path / "list.csv"
    path.write_text("name,width_cm,depth_cm,height_cm\n" + "".join(f"x{k},?,1,1\n" for k in range(7)), "utf-8")
    out = tmp_path / "out"
    for words in (("--output", out), ("--output", tmp_path / "x.pdf"), ("--json",)):
        code, told, error = run(path, "--pga", "0.3g", *FEW, *words)
        assert (code, told) == (1, "")
        assert error.startswith("rocking: list.csv: no object could be assessed")
        assert "line 2: width_cm is '?'" in error
        assert "and 2 more lines" in error
    assert not out.exists()
    assert not (tmp_path / "x.pdf").exists()


def test_a_row_that_cannot_be_assessed_is_no_failure(printed, tmp_path):
    """The control: with one object beside them the status is 0 and the report is there."""
    path = tmp_path / "list.csv"
    path.write_text("name,width_cm,depth_cm,height_cm\nx,?,1,1\nvase,20,20,60\n", "utf-8")
    printed(path, "--pga", "0.3g", *FEW, "--output", tmp_path / "x.csv")
    assert (tmp_path / "x.csv").exists()


def test_columns_are_said_alike_at_every_door(answered, refuses, tmp_path):
    """A museum's own titles are mapped by an option, a key of a file, and in Python: the same verdicts."""
    (tmp_path / "objects.csv").write_text("Ding;Maß 1;Maß 2;Maß 3\nUrne;12,5;20;90\n", encoding="utf-8")
    columns = "Ding=name, Maß 1=width_cm, Maß 2=depth_cm, Maß 3=height_cm"
    few = ("--synthetic", "point-source", "--count", "5")
    refuses((tmp_path / "objects.csv", "--pga", "0.3g", *few), "the first line must contain the columns")
    by_option = answered(tmp_path / "objects.csv", "--map-columns", columns, "--pga", "0.3g", *few)
    table = f'objects = "objects.csv"\npga = "0.3g"\nmap_columns = "{columns}"'
    motions = '[[motions]]\nsynthetic = "point-source"\ncount = 5\nseed = 1'
    (tmp_path / "job.toml").write_text(f"[inventory]\n{table}\n{motions}\n", encoding="utf-8")
    assert answered(tmp_path / "job.toml")["objects"] == by_option["objects"]
    shares = rk.inventory(tmp_path / "objects.csv", "point-source", pga="0.3g", count=5, map_columns=columns)
    assert shares["overturned"].isel(restitution=0, object=0).values.tolist() == [
        each["overturned"] for each in by_option["objects"][0]["directions"]
    ]
    with pytest.raises(InvalidValueError, match="map_columns"):
        rk.inventory([], "point-source", pga="0.3g", map_columns=columns)


def test_a_museum_list_in_one_command(printed, tmp_path):
    """Thirty untidy rows of a German workbook: each has a verdict, or its reason."""
    museum_list.write_museum_list(tmp_path / "liste.xlsx")
    out = printed(tmp_path / "liste.xlsx", "--pga", "0.3g", *FEW, "--details")
    assert out.startswith("liste.xlsx (Objekte): PGA 0")
    labels = [" ".join(filter(None, line.split("|")[:2])) for line in museum_list.LIST.splitlines()[1:]]
    assert len(labels) == 30
    for label in labels:
        assert f"  {label}" in out or f" {label}, " in out


@pytest.mark.parametrize(
    ("more", "in_space"),
    [((), False), (("--restitution", "ked"), False), (("--friction", 0.4), True)],
    ids=["default", "ked", "friction"],
)
def test_ratings_name_their_model(answered, printed, objects, more, in_space):
    words = (objects, "--count", 5, "--pga", "0.3g", *more)
    model = headline(answered(*words)["restitution"], in_space=in_space)
    assert str(model) in " ".join(printed(*words).split())
