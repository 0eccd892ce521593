"""Goodness of fit and bootstrap in the fragility files of campaigns: those of the Python call, however it was cut."""

import csv
import re
from functools import cache, partial

import numpy as np
import pytest
from campaign_jobs import BODY, job

import rocking as rk
from rocking.campaigns import Campaign
from rocking.campaigns.jobs import Job, JobFolder, analyses, export
from rocking.campaigns.jobs.findings import READ
from rocking.errors import InvalidValueError
from rocking.studies import fragility_analysis
from rocking.studies.fragility import model_of, to_csv, to_nrml

pytestmark = pytest.mark.slow

PERIODS = [round(0.4 + 0.05 * k, 2) for k in range(24)]
STRIPES = job(
    "stripes", BODY, f"[motions]\npulse = {[f'sine:amplitude=1,period={period}' for period in PERIODS]}\n",
    "[fragility]\nlevels = { from = 2, to = 8, count = 7 }\nlimit_states = [0.3]\n", name="many states", seed=6,
)  # fmt: skip
ASKED = STRIPES + "[export]\nbootstrap = 99\n"


def cut(folder, text, chunk=None):
    """Return a campaign cut into chunks of a size, and computed in an order of its own."""
    job = Job.of_text(text)
    made = JobFolder(folder, job)
    Campaign.create(folder / "histories", job.study.histories, chunk).run(workers=1, order_seed=chunk or 0)
    return made


@pytest.fixture(scope="module")
def campaigns(tmp_path_factory):
    """The job as it is, and with a bootstrap, both through."""
    folder = tmp_path_factory.mktemp("fragility")
    return {name: cut(folder / name, text) for name, text in (("plain", STRIPES), ("asked", ASKED))}


@cache
def from_python(bootstrap, seed):
    """Return the model of the same study by the Python calls."""
    motions = [rk.pulses.sine(1.0, period) for period in PERIODS]
    body = rk.Block(width=0.5, height=2.0)
    found = fragility_analysis(body, motions, np.linspace(2.0, 8.0, 7), limit_states=(0.3,))
    return model_of(found, "many states", bootstrap=bootstrap, seed=seed)


@pytest.mark.parametrize(("what", "which"), [("fragility", "parameters"), ("fragility-points", "points")])
def test_the_bytes_of_the_python_call(campaigns, tmp_path, what, which):
    """Intervals, bands and p-values have the seed of the campaign; another seed makes another file."""
    path = export(campaigns["asked"], tmp_path / "r.csv", what)
    assert path.read_bytes() == to_csv(from_python(99, 6), tmp_path / "w.csv", which).read_bytes()
    assert path.read_bytes() != to_csv(from_python(99, 7), tmp_path / "w.csv", which).read_bytes()
    assert "bootstrap" in path.read_text(encoding="utf-8")


def test_the_same_bytes_whatever_the_chunks(campaigns, tmp_path):
    """Files with goodness of fit and bootstrap do not depend on chunks and their order; the repetitions count."""
    made = [campaigns["asked"], cut(tmp_path / "c7", ASKED, 7), cut(tmp_path / "c64", ASKED, 64)]
    found = [export(folder, tmp_path / f"{k}.csv", "fragility").read_bytes() for k, folder in enumerate(made)]
    assert len(set(found)) == 1
    for end in (".nc", ".mat"):
        files = [export(folder, tmp_path / f"{k}{end}", "fragility") for k, folder in enumerate(made[:2])]
        # the head of a .mat has a time
        assert len({file.read_bytes()[128 if end == ".mat" else 0 :] for file in files}) == 1
    assert export(made[0], tmp_path / "other.csv", "fragility", bootstrap=101).read_bytes() not in found


def test_off_unless_asked_for(campaigns, tmp_path):
    """Without the key there is no bootstrap; the call may ask for it, or against it."""
    plain, asked = campaigns["plain"], campaigns["asked"]
    one = export(plain, tmp_path / "a.csv", "fragility")
    assert "median bootstrap" not in one.read_text(encoding="utf-8")
    with one.open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["method"] != "common-dispersion"]
        assert all(0.0 < float(row["deviance p-value [-]"]) <= 1.0 for row in rows)
        assert {row["state"].removesuffix(", alone") for row in rows} == {"rotation > 0.3 alpha", "overturned"}
    assert export(asked, tmp_path / "b.csv", "fragility", bootstrap=0).read_bytes() == one.read_bytes()
    called = export(plain, tmp_path / "c.csv", "fragility", bootstrap=99).read_bytes()
    assert called == to_csv(from_python(99, 6), tmp_path / "w.csv").read_bytes() != one.read_bytes()


def test_a_state_that_is_never_reached(tmp_path):
    """A state without a curve is a row that says why, in place of numbers."""
    short = ", ".join(f'"sine:amplitude=1,period=0.{k}"' for k in (15, 2, 25, 3))
    low = re.sub(r"pulse = .*", f"pulse = [{short}]", STRIPES).replace("limit_states = [0.3]", "limit_states = [0.02]")
    low = low.replace("to = 8", "to = 4")
    path = export(cut(tmp_path / "c", low), tmp_path / "r.csv", "fragility")
    with path.open(encoding="utf-8") as file:
        rows = {row["state"]: row for row in csv.DictReader(file)}
    row = rows["overturned"]
    assert (row["method"], row["median [m/s2]"], row["pearson [-]"]) == ("none", "", "")
    assert row["verdict"].startswith("No failures: ")
    assert float(rows["rotation > 0.02 alpha"]["median [m/s2]"]) > 2.0


@pytest.mark.parametrize(
    ("what", "bootstrap", "words"),
    [
        ("histories", 200, "bootstrap applies to fragility"),
        ("fragility", 50, r"bootstrap must be 0 or a whole number >= 99, got 50"),
        ("fragility", 1e9, "bootstrap must be"),
        ("fragility", float("nan"), "bootstrap must be"),
    ],
)
def test_refusals(campaigns, tmp_path, what, bootstrap, words):
    """Too few, too many, and where there are no curves."""
    with pytest.raises(InvalidValueError, match=words):
        export(campaigns["plain"], tmp_path / "r.csv", what, bootstrap=bootstrap)
    assert not (tmp_path / "r.csv").exists()


@pytest.mark.parametrize("value", ["50", "true", "1e3", "200000"])
def test_refused_in_the_job(value):
    """The key is 0 or a whole number of repetitions from 99 to 100 000."""
    with pytest.raises(InvalidValueError, match=r"export\.bootstrap"):
        Job.of_text(f"{STRIPES}[export]\nbootstrap = {value}\n")


def test_command_line(tmp_path, printed, monkeypatch):
    """`rocking campaign export` writes what the job asks for."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "job.toml").write_text(ASKED, encoding="utf-8")
    printed("campaign", "run", "job.toml", "--output", "c")
    printed("campaign", "export", "c", "--output", "fragility=r.csv")
    assert (tmp_path / "r.csv").read_bytes() == to_csv(from_python(99, 6), tmp_path / "w.csv").read_bytes()


def test_what_analyses_read(campaigns):
    """An analysis reads seventeen bytes of a history, and all else would change nothing in it."""
    folder = campaigns["plain"]
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


SMALL = "a small stripes"
COMMON = '[export]\ncrossing_curves = "common-dispersion"\n'


@pytest.fixture
def crossed(finished, text):
    """Campaign of stripes whose states have unlike dispersions, and cross within the levels."""
    words = text("stripes").replace("count = 5", "count = 9")
    return lambda more="": finished("stripes", 64 + len(more), words + more)


@pytest.mark.parametrize(
    ("what", "name", "write"),
    [("fragility", "r.xml", to_nrml), ("fema-p58", "r.csv", partial(to_csv, which="fema-p58"))],
)
def test_common_dispersion(crossed, tmp_path, what, name, write):
    """Refused on request; without and with the option, the bytes of the Python export with the same option."""
    folder = crossed()
    with pytest.raises(InvalidValueError, match="curves must not cross"):
        export(folder, tmp_path / name, what, crossing_curves="refuse")
    assert not list(tmp_path.glob("r.*"))
    (analysis,) = analyses(folder).values()
    for crossing_curves in ("keep-uplift", "common-dispersion"):
        found = export(folder, tmp_path / name, what, crossing_curves=crossing_curves).read_bytes()
        model = model_of(analysis, SMALL, crossing_curves=crossing_curves)
        assert found == write(model, tmp_path / f"w{name}").read_bytes()
        if crossing_curves == "keep-uplift":
            assert found == export(folder, tmp_path / name, what).read_bytes()


def test_the_job_may_say_crossing(crossed, tmp_path):
    """[export] in the job is what counts unless the call says otherwise."""
    folder = crossed(COMMON)
    called = export(crossed(), tmp_path / "s.xml", "fragility", crossing_curves="common-dispersion")
    assert export(folder, tmp_path / "r.xml", "fragility").read_bytes() == called.read_bytes()
    with pytest.raises(InvalidValueError, match="curves must not cross"):
        export(folder, tmp_path / "t.xml", "fragility", crossing_curves="refuse")


def test_refusals_of_crossing(crossed, text, tmp_path):
    """It is about curves only, and there are two ways."""
    folder = crossed()
    with pytest.raises(
        InvalidValueError, match="crossing_curves must be one of keep-uplift, common-dispersion, refuse, got 'maybe'"
    ):
        export(folder, tmp_path / "r.xml", "fragility", crossing_curves="maybe")
    with pytest.raises(InvalidValueError, match="crossing_curves applies to"):
        export(folder, tmp_path / "r.nc", crossing_curves="refuse")
    with pytest.raises(InvalidValueError, match=r"export\.crossing"):
        Job.of_text(text("stripes") + COMMON.replace("common-", "un"))
    with pytest.raises(InvalidValueError, match=r"kind = .overturning-map. does not accept \[export\]"):
        JobFolder.create(tmp_path / "m", Job.of_text(text("overturning-map") + COMMON))
