"""`rocking campaign` with studies that ask in rounds, and with inventories."""

import errno
import json
import os
import pathlib

import pytest
from campaign_jobs import BODY, PULSE, axes, job

REFINED = "refine = 1\ntolerance = 0.01\n"
MAP = job("overturning-map", BODY, PULSE, axes((1.5, 4.5, 3), (1.5, 6.5, 3)), REFINED, name="refined")
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


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with two jobs."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "map.toml").write_text(MAP)
    (tmp_path / "inventory.toml").write_text(INVENTORY)
    (tmp_path / "objects.csv").write_text(OBJECTS)


@pytest.mark.slow
def test_rounds_in_words_and_in_json(refuses, run, printed, tmp_path):
    """Check is honest about the first round; status counts rounds; a campaign is complete after the last one."""
    out = run("campaign", "check", "map.toml")[1]
    assert "histories, time and disk of the first round" in out
    checked = json.loads(run("campaign", "check", "map.toml", "--json")[1])
    assert checked["first_round_only"] is True
    assert f"usually add {checked['later'][0]} to {checked['later'][1]} histories" in out
    code, out, err = run("campaign", "run", "map.toml", "--output", "c")
    assert (code, err) == (0, "")
    rounds = len(list((tmp_path / "c").glob("round-*")))
    assert f"({rounds} rounds, {rounds} chunks) are stored in c" in out
    told = json.loads(run("campaign", "status", "c", "--json")[1])
    assert (told["rounds_begun"], told["complete"]) == (rounds, True)
    assert told["histories"] == json.loads((tmp_path / "c" / "finished.json").read_text())["histories"]
    (tmp_path / "c" / "finished.json").unlink()
    assert f"round {rounds} has begun, the number of rounds is open" in run("campaign", "status", "c")[1]
    refuses(("campaign", "export", "c", "--output", "boundary=r.csv"), "go on with: rocking campaign resume c")
    assert run("campaign", "resume", "c", "--workers", "1")[0] == 0
    out = printed("campaign", "export", "c", "--output", "boundary=r.csv")
    assert f"boundary of {told['histories']} histories in {rounds} rounds" in out
    provenance = json.loads((tmp_path / "r.csv.provenance.json").read_text())
    assert (provenance["rounds"], provenance["all_histories"]) == (rounds, told["histories"])
    code, out, _ = run("campaign", "export", "c", "--output", "histories=h.csv")
    lines = (tmp_path / "h.csv").read_text().splitlines()
    assert f"9 histories of the first round, of {told['histories']} in all rounds" in out
    found = json.loads(run("campaign", "export", "c", "--output", "histories=h.csv", "--json")[1])
    assert found["histories"] == len(lines) - 1 == 9
    assert (found["rounds"], found["all_histories"]) == (rounds, told["histories"])
    code, _, err = run("campaign", "export", "c", "--output", "refined=r.nc")
    assert (code, "--output histories=FILE.nc) holds points and polylines" in err.replace("\n", " ")) == (2, True)


def test_stopped_while_the_job_is_read(run, tmp_path, monkeypatch):
    """Ctrl-C before and during a campaign: the message states that results are kept only if there are results."""
    from rocking.campaigns.jobs import Job, JobFolder

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(Job, "read", stopped)
    for words in (("check", "map.toml"), ("run", "map.toml", "--output", "c")):
        assert run("campaign", *words) == (3, "", "rocking: stopped; nothing was computed\n")
    monkeypatch.undo()
    monkeypatch.chdir(tmp_path)
    JobFolder.create("c", Job.read("map.toml"))
    monkeypatch.setattr(Job, "of_text", stopped)
    assert run("campaign", "resume", "c") == (3, "", "rocking: stopped; finished results are kept\n")


@pytest.mark.slow
@pytest.mark.parametrize("target", ["r.html", "r.csv", "r.json", "r.xlsx", "all"])
def test_reports_on_a_full_disk(run, tmp_path, monkeypatch, target):
    """A write that fails half way: exit code 4 with the path, no report under its name, no half of one beside it."""
    if target.endswith("xlsx"):
        pytest.importorskip("openpyxl")
    assert run("campaign", "run", "inventory.toml", "--output", "c")[0] == 0
    real = {name: getattr(pathlib.Path, name) for name in ("write_text", "write_bytes")}

    def full(name):
        def write(self, data, *given, **named):
            real[name](self, data[: len(data) // 2], *given, **named)
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(self))

        return write

    before = set(tmp_path.iterdir())
    for name in real:
        monkeypatch.setattr(pathlib.Path, name, full(name))
    code, out, err = run("campaign", "export", "c", "--output", target)
    words = err.replace("\n", " ")
    assert (code, out) == (4, "")
    assert f"cannot write {target}" in words
    assert "No space left on device; the campaign is unchanged" in words
    left = set(tmp_path.rglob("*")) - set((tmp_path / "c").rglob("*")) - before
    assert left <= {tmp_path / "all", tmp_path / "all" / "inventory.provenance.json"}


@pytest.mark.parametrize("key", ["rocking", "overturning_red", "level"])
def test_thresholds_are_named_with_their_table(run, tmp_path, key):
    """A threshold that is none is named as it stands in the job."""
    (tmp_path / "bad.toml").write_text(f"{INVENTORY}[inventory.thresholds]\n{key} = 7.0\n")
    code, _, err = run("campaign", "check", "bad.toml")
    assert code == 2
    assert f"inventory.thresholds: {key} must be" in err.replace("\n", " ")


@pytest.mark.slow
def test_inventory_is_that_of_the_other_command(run, tmp_path):
    """The same table and the same numbers as `rocking inventory`, in every form; provenance beside it."""
    pytest.importorskip("openpyxl")
    shaking = ("--synthetic", "firm-ground", "--count", 8, "--seed", 1, "--pga", "0.3g")
    assert run("inventory", "objects.csv", *shaking, "--output", "wanted")[0] == 0
    assert run("campaign", "run", "inventory.toml", "--output", "c")[0] == 0
    for suffix in (".csv", ".json", ".html"):
        code, out, _ = run("campaign", "export", "c", "--output", f"found{suffix}")
        assert (code, "report of" in out) == (0, True)
        assert (tmp_path / f"found{suffix}").read_bytes() == (tmp_path / "wanted" / f"inventory{suffix}").read_bytes()
        told = json.loads((tmp_path / f"found{suffix}.provenance.json").read_text())
        assert [each["path"] for each in told["inputs"]] == ["objects.csv"]
    told = json.loads(run("campaign", "export", "c", "--output", "all", "--json")[1])
    assert [each["what"] for each in told] == ["report"] * len(told)
    names = {path.name for path in (tmp_path / "wanted").iterdir()}
    assert {path.name for path in (tmp_path / "all").iterdir()} == names | {"inventory.provenance.json"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (("--output", "r.txt"), "an inventory can be written as .html, .pdf, .xlsx, .csv, .json"),
        (("--output", "boundary=r.csv"), 'a campaign of kind "inventory" has no boundary'),
        (("--output", "r.html", "--crossing-curves", "refuse"), "not with --restitution or --crossing-curves"),
        (("--output", "missing/r.html"), "cannot write missing/r.html"),
    ],
)
def test_refusals_of_export(run, tmp_path, words, wanted):
    """What cannot be written is refused in a sentence, and nothing is left behind."""
    assert run("campaign", "run", "inventory.toml", "--output", "c")[0] == 0
    before = set(tmp_path.iterdir())
    code, _, err = run("campaign", "export", "c", *words)
    assert code == 2
    assert wanted in err.replace("\n", " ")
    assert set(tmp_path.iterdir()) == before
