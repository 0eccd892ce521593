"""`rocking examples`: every example runs in an empty folder, leaves what it says, and takes nothing away."""

import dataclasses
import json

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from rocking.examples import table

ALL = rk.examples.catalogue()
COMMAND = "examples"


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_every_example_runs_in_an_empty_folder(name, printed, tmp_path, monkeypatch):
    """All its commands are shown and succeed; its files and what it promises are there, and nothing else."""
    monkeypatch.chdir(tmp_path)
    page = printed(name)
    example = ALL[name]
    assert page.startswith(f"{name}: {example.title}\n")
    assert [line[2:] for line in page.splitlines() if line.startswith("$ ")] == list(example.commands)
    there = {path.name for path in tmp_path.iterdir() if not path.name.endswith(".provenance.json")}
    assert there == {*example.writes, *example.outputs}
    for picture in tmp_path.glob("*.png"):
        assert len(np.unique(np.asarray(Image.open(picture).convert("L")))) > 10
    if example.kind != "list" and name not in {"inventory", "histories"}:
        assert f"{name}.png" in there


def test_the_list(printed, answered):
    """Every name and kind on the page; JSON has the commands too, of one or of all."""
    page = printed()
    for name in ALL:
        assert f"\n{name} " in page
    assert printed("--dry-run") == page
    assert [each["name"] for each in answered()["examples"]] == list(ALL)
    (one,) = answered("stele")["examples"]
    assert one["writes"] == ["stele.toml", "far-field.csv"]
    assert one["commands"] == list(ALL["stele"].commands)


def test_one_is_only_listed(printed, tmp_path, monkeypatch):
    """Nothing is written by --dry-run and --json."""
    monkeypatch.chdir(tmp_path)
    assert "files: bust.toml, three-components.csv; files of its commands: bust.png" in printed("bust", "--dry-run")
    assert json.loads(printed("bust", "--json"))["examples"][0]["outputs"] == ["bust.png"]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("there", ["far-field.png", "far-field.csv"])
def test_nothing_of_the_user_is_written_over(run, refuses, tmp_path, monkeypatch, there):
    """A file of the name of one that it would write is named and left; --force writes over it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / there).write_text("mine")
    refuses(["far-field"], there)
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [(there, "mine")]
    assert run("far-field", "--force")[0] == 0
    assert (tmp_path / there).read_bytes() != b"mine"


def test_a_folder_of_the_user_is_never_taken(refuses, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "histories").mkdir()
    refuses(["histories", "--force"], "histories: a folder of this name already exists; use another folder")
    assert [path.name for path in tmp_path.iterdir()] == ["histories"]


def test_a_command_that_fails_ends_it(run, tmp_path, monkeypatch):
    """Negative control: the exit code is that of the command, and what follows is not run."""
    monkeypatch.chdir(tmp_path)
    broken = ("rocking record show nothing.csv --output a.png", "rocking record show pulse.csv --output b.png")
    monkeypatch.setitem(table.EXAMPLES, "pulse", dataclasses.replace(table.EXAMPLES["pulse"], commands=broken))
    code, out, err = run("pulse")
    assert (code, "nothing.csv: no such file" in err) == (2, True)
    assert "b.png" not in out
    assert not (tmp_path / "b.png").exists()
