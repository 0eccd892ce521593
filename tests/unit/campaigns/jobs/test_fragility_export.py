"""Goodness of fit and bootstrap in the fragility files of campaigns: those of the Python call, however it was cut."""

import csv
import hashlib
import re
from contextlib import suppress

import numpy as np
import pytest

import rocking as rk
from rocking.campaigns import Campaign
from rocking.campaigns.jobs import Job, JobFolder, analyses, export
from rocking.campaigns.jobs.findings import READ
from rocking.cli import main
from rocking.errors import InvalidValueError
from rocking.studies import multiple_stripe_analysis
from rocking.studies.fragility.curves import model_of
from rocking.studies.fragility.export import to_csv

PERIODS = [round(0.4 + 0.05 * k, 2) for k in range(24)]
STRIPES = f"""[campaign]
name = "many states"
kind = "stripes"
seed = 6
[body]
units = "m"
width = 0.5
height = 2.0
[motions]
pulse = {[f"sine:amplitude=1,period={period}" for period in PERIODS]}
[fragility]
levels = {{ from = 2, to = 8, count = 13 }}
states = [0.3]
"""
ASKED = STRIPES + "[export]\nbootstrap = 150\n"


def cut(folder, text, chunk=None):
    """Return a campaign cut into chunks of a size, and computed in an order of its own."""
    job = Job.of_text(text)
    made = JobFolder(folder, job)
    Campaign.create(folder / "histories", job.study.histories, chunk).run(workers=1, order_seed=chunk or 0)
    return made


def from_python(bootstrap, seed):
    """Return the model of the same study by the Python calls."""
    motions = [rk.pulses.sine(1.0, period) for period in PERIODS]
    body = rk.Block(width=0.5, height=2.0)
    found = multiple_stripe_analysis(body, motions, np.linspace(2.0, 8.0, 13), states=(0.3,))
    return model_of(found, "many states", bootstrap=bootstrap, seed=seed)


@pytest.mark.parametrize(("what", "which"), [("fragility", "parameters"), ("fragility-points", "points")])
def test_the_bytes_of_the_python_call(tmp_path, what, which):
    """Intervals, bands and p-values have the seed of the campaign; another seed makes another file."""
    path = export(cut(tmp_path / "c", ASKED), tmp_path / "r.csv", what)
    assert path.read_bytes() == to_csv(from_python(150, 6), tmp_path / "w.csv", which).read_bytes()
    assert path.read_bytes() != to_csv(from_python(150, 7), tmp_path / "w.csv", which).read_bytes()
    assert "bootstrap" in path.read_text(encoding="utf-8")


def test_the_same_bytes_whatever_the_chunks(tmp_path):
    """Files with goodness of fit and bootstrap do not depend on chunks and their order; fewer repetitions do."""
    made = {chunk: cut(tmp_path / f"c{chunk}", ASKED, chunk) for chunk in (7, 64, 312)}
    for end in (".csv", ".nc", ".mat"):
        found = []
        for chunk, folder in made.items():
            data = export(folder, tmp_path / f"{chunk}{end}", "fragility").read_bytes()
            found.append(hashlib.sha256(data[128:] if end == ".mat" else data).hexdigest())  # the head has a time
        assert len(set(found)) == 1
        other = export(made[7], tmp_path / f"other{end}", "fragility", bootstrap=140).read_bytes()
        assert hashlib.sha256(other[128:] if end == ".mat" else other).hexdigest() not in found


def test_off_unless_asked_for(tmp_path):
    """Without the key there is no bootstrap; the call may ask for it, or against it."""
    plain, asked = cut(tmp_path / "c", STRIPES), cut(tmp_path / "d", ASKED)
    one = export(plain, tmp_path / "a.csv", "fragility")
    assert "median bootstrap" not in one.read_text(encoding="utf-8")
    with one.open(encoding="utf-8") as file:
        assert all(0.0 < float(row["deviance p-value [-]"]) <= 1.0 for row in csv.DictReader(file))
    assert export(asked, tmp_path / "b.csv", "fragility", bootstrap=0).read_bytes() == one.read_bytes()
    pair = enumerate((plain, asked))
    both = [export(folder, tmp_path / f"{k}.csv", "fragility", bootstrap=150) for k, folder in pair]
    assert both[0].read_bytes() == both[1].read_bytes() != one.read_bytes()


def test_a_state_that_is_never_reached(tmp_path):
    """A state without a curve is a row that says why, in place of numbers."""
    short = ", ".join(f'"sine:amplitude=1,period=0.{k}"' for k in (15, 2, 25, 3))
    low = re.sub(r"pulse = .*", f"pulse = [{short}]", STRIPES).replace("states = [0.3]", "states = [0.02]")
    low = low.replace("to = 8", "to = 4")
    path = export(cut(tmp_path / "c", low), tmp_path / "r.csv", "fragility")
    with path.open(encoding="utf-8") as file:
        rows = {row["state"]: row for row in csv.DictReader(file)}
    row = rows["overturned"]
    assert (row["method"], row["median [m/s2]"], row["pearson [-]"]) == ("none", "", "")
    assert row["verdict"].startswith("Nothing failed: ")
    assert float(rows["rotation > 0.02 alpha"]["median [m/s2]"]) > 2.0


@pytest.mark.parametrize(
    ("what", "bootstrap", "words"),
    [
        ("histories", 200, "bootstrap goes with fragility"),
        ("fragility", 50, r"bootstrap must be 0 or a whole number >= 99, got 50"),
        ("fragility", 1e9, "bootstrap must be"),
        ("fragility", float("nan"), "bootstrap must be"),
    ],
)
def test_refusals(tmp_path, what, bootstrap, words):
    """Too few, too many, and where there are no curves."""
    folder = cut(tmp_path / "c", STRIPES)
    with pytest.raises(InvalidValueError, match=words):
        export(folder, tmp_path / "r.csv", what, bootstrap=bootstrap)
    assert not (tmp_path / "r.csv").exists()


@pytest.mark.parametrize("value", ["50", "true", "1e3", "200000"])
def test_refused_in_the_job(value):
    """The key is 0 or a whole number of repetitions from 99 to 100 000."""
    with pytest.raises(InvalidValueError, match=r"export\.bootstrap"):
        Job.of_text(f"{STRIPES}[export]\nbootstrap = {value}\n")


def test_command_line(tmp_path, capsys, monkeypatch):
    """`rocking campaign export` writes what the job asks for."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "job.toml").write_text(ASKED, encoding="utf-8")
    for words in (("run", "job.toml", "--out", "c"), ("export", "c", "--to", "r.csv", "--what", "fragility")):
        with suppress(SystemExit):
            main(["campaign", *words])
    capsys.readouterr()
    assert (tmp_path / "r.csv").read_bytes() == to_csv(from_python(150, 6), tmp_path / "w.csv").read_bytes()


def test_what_analyses_read(tmp_path, monkeypatch):
    """An analysis reads seventeen bytes of a history, and all else would change nothing in it."""
    folder = cut(tmp_path / "c", STRIPES)
    read = folder.campaign.results(*READ)
    assert {name: values.itemsize for name, values in read.items()} == {
        "outcome": 1,
        "peak_rotation": 8,
        "least_force": 8,
    }
    whole = folder.campaign.results()
    assert all(read[name].tobytes() == whole[name].tobytes() for name in READ)
    with pytest.raises(InvalidValueError, match="column must be one of"):
        folder.campaign.results("outcom")
    (found,) = analyses(folder).values()
    for values in whole.values():  # what is not read may be anything
        if not any(values is whole[name] for name in READ):
            values[...] = 7
    (same,) = folder.job.study.finish(whole).values()
    assert found.fits["overturned"].median == same.fits["overturned"].median
    whole["outcome"][: whole["outcome"].size // 2] = 1
    (other,) = folder.job.study.finish(whole).values()
    assert other.fits["overturned"].median != same.fits["overturned"].median
