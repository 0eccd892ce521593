"""A model in the user's own file works in a campaign: in every process, and only as long as it is the same."""

import json
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from campaign_jobs import BODY, PULSE, axes, finished, job

from rocking.campaigns.jobs import Job, JobFolder
from rocking.errors import InvalidValueError, UnknownModelError
from rocking.restitution.from_file import model_in_file

MINE = """import rocking as rk


class Mine(rk.restitution.RestitutionModel):
    name = "mine"

    def raw_coefficient(self, body, onto):
        return {value}
"""


def job_of(restitution):
    """Text of a job with a restitution."""
    return job("overturning-map", BODY, PULSE, f"[restitution]\n{restitution}\n", axes((1, 7, 6), (1, 9, 5)), chunk=10)


@pytest.fixture
def own(tmp_path: Path) -> Path:
    """A folder with a job, and the file of the model that it names."""
    (tmp_path / "mine.py").write_text(MINE.format(value=0.9), encoding="utf-8")
    (tmp_path / "job.toml").write_text(job_of('model = "mine.py:Mine"'), encoding="utf-8")
    return tmp_path


def digest(folder: Path, restitution: str) -> str:
    """Hash of the results of the same job with another restitution."""
    return finished(folder, job_of(restitution)).campaign.sha256()


@pytest.mark.parametrize("executor", ["serial", "processes"])
def test_own_model_computes_in_every_process(own: Path, executor: str) -> None:
    """A model that returns 0.9 gives the bits of the value 0.9, in this process and in spawned ones; not of 0.8."""
    made = JobFolder.create(own / "c", Job.read(own / "job.toml"))
    made.run(executor, workers=1)
    assert made.campaign.sha256() == digest(own / "same", "value = 0.9")
    assert made.campaign.sha256() != digest(own / "other", "value = 0.8")
    assert [item["path"] for item in json.loads((own / "c" / "inputs.json").read_text())["files"]] == ["mine.py"]


def test_own_model_may_stand_among_others(own: Path) -> None:
    """In a list beside a name, and as what a distribution multiplies."""
    (own / "job.toml").write_text(job_of('models = ["ked", "mine.py:Mine"]'), encoding="utf-8")
    assert list(Job.read(own / "job.toml").study.dims.values()) == [2, 5, 6]
    drawn = 'distribution = { mean = 0.95, deviation = 0.01, times = "mine.py" }'
    (own / "job.toml").write_text(job_of(drawn), encoding="utf-8")
    rows = Job.read(own / "job.toml").study.histories.rows(0, 30)
    assert np.array_equal(rows.values["r_right"], np.full(30, 0.9))


def test_changed_model_is_refused(own: Path) -> None:
    """Another number in the file, or none of it: the campaign is not gone on with, and says why."""
    JobFolder.create(own / "c", Job.read(own / "job.toml"))
    (own / "mine.py").write_text(MINE.format(value=0.9) + "# a remark\n", encoding="utf-8")
    with pytest.raises(InvalidValueError, match=r"mine\.py: has changed since the campaign began"):
        JobFolder.open(own / "c")
    (own / "mine.py").unlink()
    with pytest.raises(InvalidValueError, match=r"mine\.py: No such file"):
        JobFolder.open(own / "c")
    (own / "mine.py").write_text(MINE.format(value=0.9), encoding="utf-8")
    assert JobFolder.open(own / "c").run(workers=1).computed == 3


def test_model_travels_with_its_source(own: Path) -> None:
    """A process without the file makes the same model; with a remark in the file it is another class."""
    made = model_in_file(f"{own / 'mine.py'}:Mine")
    sent = pickle.dumps(made)
    (own / "mine.py").unlink()
    code = "import pickle, sys, rocking as rk; made = pickle.load(sys.stdin.buffer)\n"
    code += "print(type(made).__name__, made.raw_coefficient(None, None), "
    code += "isinstance(made, rk.restitution.RestitutionModel))"
    told = subprocess.run([sys.executable, "-c", code], input=sent, capture_output=True, check=True).stdout
    assert told.split() == [b"Mine", b"0.9", b"True"]
    (own / "mine.py").write_text(MINE.format(value=0.9) + "# a remark\n", encoding="utf-8")
    assert type(model_in_file(str(own / "mine.py"))) is not type(made)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("import nothing_of_that_name", "ModuleNotFoundError"),
        ("x = 1", "has no restitution model Mine; it has none"),
        ("def", "SyntaxError"),
    ],
)
def test_what_is_wrong_with_the_file_is_said(own: Path, source: str, words: str) -> None:
    """A file that fails, twice in a row, and one without the class: with the key of the job."""
    (own / "mine.py").write_text(source, encoding="utf-8")
    for _ in range(2):
        with pytest.raises(InvalidValueError, match=f"job.toml: restitution: .*mine.py.*{words}"):
            Job.read(own / "job.toml")
    with pytest.raises(UnknownModelError, match="no file"):
        model_in_file("nowhere.py:Mine")
