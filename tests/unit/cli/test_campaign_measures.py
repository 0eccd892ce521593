"""`rocking campaign export --what measures`: the ranking of intensity measures of a cloud, and why there is none."""

import csv
import json
import math

import pytest

import rocking as rk
from rocking.studies import SyntheticSet, compare_measures, fragility_analysis

HEAD = '[campaign]\nname = "a cloud"\nkind = "cloud"\n[body]\nunits = "m"\nwidth = 0.4\nheight = 2.0\n'
MOTIONS = '[motions]\nsynthetic = "point-source"\ncount = 30\nseed = 1\n[restitution]\nmodels = {models}\n'
REST = '[fragility]\nmeasure = "pga"\nfactor = 2.0\n[export]\nmeasures = ["pga", "pgv", "arias"]\n'


COMMAND = "campaign"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder of its own."""
    monkeypatch.chdir(tmp_path)


def made(run, tmp_path, models='["ked"]'):
    (tmp_path / "job.toml").write_text(HEAD + MOTIONS.format(models=models) + REST, encoding="utf-8")
    assert run("run", "job.toml", "--out", "c")[0] == 0


def test_export(run, tmp_path):
    """The file has the numbers of the Python call to the last bit; JSON says what was written."""
    made(run, tmp_path)
    code, out, _ = run("export", "c", "--out", "measures=m.csv")
    assert (code, "measures of 30 histories" in out.replace("\n", " ")) == (0, True)
    with (tmp_path / "m.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    motions = list(SyntheticSet("point-source", 30, seed=1))
    metadata = {
        "magnitude": [float(motion.metadata["magnitude"]) for motion in motions],
        "ln distance_km": [math.log(float(motion.metadata["distance_km"])) for motion in motions],
    }
    found = fragility_analysis(
        rk.Block(width=0.4, height=2.0), motions, restitution="ked", factor=2.0, analysis="cloud"
    )
    wanted = compare_measures(found, ["pga", "pgv", "arias"], metadata)
    assert [row["measure"] for row in rows] == [score.measure for score in wanted.scores]
    for name in ("efficiency", "slope"):
        assert [float(row[name]) for row in rows] == [getattr(score, name) for score in wanted.scores]
    told = [float(row["p(magnitude)"]) for row in rows]
    assert told == [score.sufficiency["magnitude"] for score in wanted.scores]
    code, out, _ = run("export", "c", "--out", "measures=m.nc", "--json")
    assert (code, json.loads(out)["what"]) == (0, "measures")


def test_which_restitution(run, tmp_path):
    """Two restitutions: each has its own, chosen by --restitution; without it nothing is written."""
    made(run, tmp_path, '["housner", "ked"]')
    code, _, error = run("export", "c", "--out", "measures=m.csv")
    assert code != 0
    assert "restitution must be one of housner, ked" in error.replace("\n", " ")
    assert not (tmp_path / "m.csv").exists()
    texts = []
    for label in ("housner", "ked"):
        assert run("export", "c", "--out", f"measures={label}.csv", "--restitution", label)[0] == 0
        texts.append((tmp_path / f"{label}.csv").read_text(encoding="utf-8"))
    assert texts[0] != texts[1]


def test_nothing_to_export(run, tmp_path):
    """A plain product of histories says why it has no measures."""
    text = HEAD.replace('"cloud"', '"histories"') + MOTIONS.format(models='["ked"]')
    (tmp_path / "job.toml").write_text(text, encoding="utf-8")
    assert run("run", "job.toml", "--out", "c")[0] == 0
    code, _, error = run("export", "c", "--out", "measures=m.csv")
    assert code != 0
    assert 'nothing to export because a campaign of kind "histories" has no measures' in error.replace("\n", " ")
