"""`rocking campaign` with studies that ask in rounds, and with inventories."""

import json

import pytest

from rocking.cli import main

MAP = """[campaign]
name = "refined"
kind = "overturning-map"
[body]
units = "m"
width = 0.5
height = 2.0
[motions]
pulse = "sine:amplitude=3,period=0.6"
[map]
x = { axis = "frequency_ratio", values = [1.5, 3.0, 4.5] }
y = { axis = "amplitude_ratio", values = [1.5, 4.0, 6.5] }
refine = 1
tolerance = 0.01
"""
INVENTORY = """[campaign]
name = "objects"
kind = "inventory"
[inventory]
objects = "objects.csv"
pga = "0.3g"
[motions]
synthetic = "firm-ground"
count = 8
seed = 1
"""
OBJECTS = "name,width_cm,depth_cm,height_cm\ntall vase,20,20,100\ncabinet,90,45,180\nmirror,75,?,160\n"


@pytest.fixture
def run(capsys, tmp_path, monkeypatch):
    """Run the command as the shell does, in a folder with a job: exit code, what it printed, what it complained of."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "map.toml").write_text(MAP)
    (tmp_path / "inventory.toml").write_text(INVENTORY)
    (tmp_path / "objects.csv").write_text(OBJECTS)

    def call(*words):
        with pytest.raises(SystemExit) as left:
            main([str(word) for word in words])
        out, err = capsys.readouterr()
        return left.value.code, out, err

    return call


def test_rounds_in_words_and_in_json(run, tmp_path):
    """Check is honest about the first round; status counts rounds; a campaign is complete after the last one."""
    assert "in the first round, as are time, memory and disk" in run("campaign", "check", "map.toml")[1]
    assert json.loads(run("campaign", "check", "map.toml", "--json")[1])["first_round_only"] is True
    code, out, err = run("campaign", "run", "map.toml", "--out", "c")
    assert (code, err) == (0, "")
    rounds = len(list((tmp_path / "c").glob("round-*")))
    assert f"({rounds} rounds, {rounds} chunks) are safe in c" in out
    told = json.loads(run("campaign", "status", "c", "--json")[1])
    assert (told["rounds_begun"], told["complete"]) == (rounds, True)
    assert told["histories"] == json.loads((tmp_path / "c" / "finished.json").read_text())["histories"]
    (tmp_path / "c" / "finished.json").unlink()
    assert f"round {rounds} has begun, how many follow is not known" in run("campaign", "status", "c")[1]
    code, _, err = run("campaign", "export", "c", "--to", "r.csv", "--what", "boundary")
    assert code == 2
    assert "go on with: rocking campaign resume c" in err
    assert run("campaign", "resume", "c", "--workers", "1")[0] == 0
    code, out, _ = run("campaign", "export", "c", "--to", "r.csv", "--what", "boundary")
    assert code == 0
    assert f"boundary of {told['histories']} histories" in out


def test_inventory_is_that_of_the_other_command(run, tmp_path):
    """The same table and the same numbers as `rocking inventory`, in every form; provenance beside it."""
    pytest.importorskip("openpyxl")
    shaking = ("--synthetic", "firm-ground", "--count", 8, "--seed", 1, "--pga", "0.3g")
    assert run("inventory", "objects.csv", *shaking, "--out", "wanted")[0] == 0
    assert run("campaign", "run", "inventory.toml", "--out", "c")[0] == 0
    for suffix in (".csv", ".json", ".html"):
        code, out, _ = run("campaign", "export", "c", "--to", f"found{suffix}")
        assert (code, "report of" in out) == (0, True)
        assert (tmp_path / f"found{suffix}").read_bytes() == (tmp_path / "wanted" / f"inventory{suffix}").read_bytes()
        told = json.loads((tmp_path / f"found{suffix}.provenance.json").read_text())
        assert [each["path"] for each in told["inputs"]] == ["objects.csv"]
    told = json.loads(run("campaign", "export", "c", "--to", "all", "--json")[1])
    assert [each["what"] for each in told] == ["report"] * len(told)
    names = {path.name for path in (tmp_path / "wanted").iterdir()}
    assert {path.name for path in (tmp_path / "all").iterdir()} == names | {"inventory.provenance.json"}


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (("--to", "r.txt"), "an inventory can be written as .html, .pdf, .xlsx, .csv, .json, got '.txt'"),
        (("--to", "r.csv", "--what", "boundary"), 'a campaign of kind "inventory" has no boundary'),
        (("--to", "r.html", "--crossing", "refuse"), "without restitution and crossing"),
        (("--to", "missing/r.html"), "cannot write missing/r.html"),
    ],
)
def test_refusals_of_export(run, tmp_path, words, wanted):
    """What cannot be written is refused in a sentence, and nothing is left behind."""
    assert run("campaign", "run", "inventory.toml", "--out", "c")[0] == 0
    before = set(tmp_path.iterdir())
    code, _, err = run("campaign", "export", "c", *words)
    assert code == 2
    assert wanted in err.replace("\n", " ")
    assert set(tmp_path.iterdir()) == before
