"""A new study is one file in `rocking.spec.questions`: for jobs, campaigns, exports, the application and the manual."""

import json
import re
import sys

import numpy as np
import pytest

from rocking import cli, spec
from rocking.app.api.info import _constant
from rocking.app.studies.job_document import JobDocument, launched_kinds
from rocking.campaigns.jobs import Job, JobFolder, status_of
from rocking.errors import InvalidValueError
from rocking.spec import questions
from rocking.spec.question import QUESTIONS
from rocking.spec.reference import keys_of, reference

STUDY = '''
"""Polarity: every motion as recorded and reversed."""

from typing import ClassVar

import numpy as np

from rocking.spec.fields import JobTable, Positive, key
from rocking.spec.question import BodyQuestion
from rocking.studies.sensitivity.restitutions import sampled
from rocking.studies.study_plan import Study, along, motions_along


class PolarityTable(JobTable):
    """The scale of the motions."""

    factor: Positive = key("scale factor of both polarities [-]", 1.0)


class PolarityQuestion(BodyQuestion):
    """Every motion as recorded and reversed."""

    kind: ClassVar[str] = "polarity"

    polarity: PolarityTable

    @property
    def sizes(self):
        return [*super().sizes, 2]

    def study(self, problem):
        scales = self.polarity.factor * np.array([1.0, -1.0])
        product, attributes = problem.product(problem.bodies, scales)
        dims = {"motion": len(problem.motions), "scale": 2}
        coordinates = {"motion": motions_along(problem.motions), "scale": along("scale", scales)}
        return Study(sampled(product), dims, coordinates, attributes)

    def plot(self, finished, restitution):
        from matplotlib.figure import Figure

        figure = Figure()
        figure.subplots().plot(finished.dataset(restitution)["peak_ratio"].values.ravel())
        return figure
'''
JOB = """
[campaign]
name = "both ways"
kind = "polarity"
[body]
units = "m"
width = 0.5
height = 2.0
[motions]
pulse = ["sine:amplitude=4,period=0.5", "ricker:amplitude=6,period=0.9"]
[polarity]
factor = 2.0
"""
TABLES = {
    "campaign": {"name": "both ways", "kind": "polarity"}, "body": {"units": "m", "width": 0.5, "height": 2.0},
    "motions": {"pulse": ["sine:amplitude=4,period=0.5"]}, "polarity": {"factor": 2.0},
}  # fmt: skip


@pytest.fixture
def added(tmp_path, monkeypatch):
    """Add the file of a study to the folder of studies."""
    folder = tmp_path / "questions"
    folder.mkdir()
    (folder / "polarity.py").write_text(STUDY.strip() + "\n", encoding="utf-8")
    for package, path in ((spec, tmp_path), (questions, folder)):
        monkeypatch.setattr(package, "__path__", [*package.__path__, str(path)])
    yield tmp_path
    QUESTIONS.pop("polarity", None)
    sys.modules.pop(f"{questions.__name__}.polarity", None)


def test_one_file_is_a_study_everywhere(added, capsys):
    (added / "job.toml").write_text(JOB, encoding="utf-8")
    job = Job.read(added / "job.toml")
    assert job.study.dims == {"motion": 2, "scale": 2}
    assert (job.problem.answer()["outcome"] == 2).any()
    for words in (
        "check job.toml",
        "run job.toml --output c",
        "status c",
        "export c -o a.nc -o a.csv -o a.png",
    ):
        arguments = [str(added / word) if "." in word or word == "c" else word for word in words.split()]
        with pytest.raises(SystemExit, match="0"):
            cli.main(["campaign", *arguments, "--json"])
    assert capsys.readouterr().out.count('"kind": "polarity"') == 3
    assert (added / "a.png").read_bytes().startswith(b"\x89PNG")
    assert status_of(added / "c").complete
    assert JobFolder.open(added / "c").campaign.results()["outcome"].size == 4
    assert "polarity" in launched_kinds()
    assert JobDocument.of(TABLES).histories == 2
    assert keys_of("polarity") == ["factor"]
    page = reference()["input_files"]
    assert "## [polarity]" in page
    assert "| `factor` | number |" in page.partition("## [polarity]")[2]


def test_one_file_has_a_form(added):
    """The page hears of the kind, its table, and the unit, default and limits of each key."""
    info = _constant.__wrapped__()
    kind = {"name": "polarity", "table": "polarity", "has_body": True, "has_motions": True}
    assert kind in info["study_kinds"]
    facts = {"unit": "-", "words": "scale factor of both polarities", "kind": "number", "usual": "1.0", "gt": 0.0}
    assert info["keys"]["polarity"] == {"factor": {**facts, "needed": False, "choices": []}}


def test_one_file_is_a_command(added, run, refuses, monkeypatch):
    """Its options are the keys of its table; files say the same, and the list has it."""
    words = [
        "polarity",
        "--width",
        "0.5",
        "--height",
        "2",
        "sine:amplitude=4,period=0.5",
        "ricker:amplitude=6,period=0.9",
    ]
    files = [word for name in ("a.png", "a.csv") for word in ("--output", added / name)]
    code, out, err = run(*words, "--factor", 2, "--json", *files)
    assert (code, err) == (0, "")
    answer = json.loads(out)
    assert answer["scale"] == [2.0, -2.0]
    assert 2 in np.ravel(answer["outcome"])
    assert (added / "a.png").read_bytes().startswith(b"\x89PNG")
    (added / "job.toml").write_text(JOB, encoding="utf-8")
    assert json.loads(run("polarity", added / "job.toml", "--json")[1])["outcome"] == answer["outcome"]
    monkeypatch.setenv("COLUMNS", "200")
    assert "Scale factor of both polarities [-]. [default: 1.0]" in run("polarity", "--help")[1]
    assert re.search(r"polarity +Every motion as recorded and reversed\.", run("--help")[1])
    refuses((*words, "--factor", "0"), "--factor must be")
    refuses(("polarities",), "polarit")


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"polarity": {"factor": -1.0}}, r"polarity\.factor must be a number > 0, got -1"),
        ({"polarity": {"factors": 1.0}}, "polarity: unknown key 'factors'; did you mean factor"),
        ({"polarity": None}, "polarity"),
        ({"map": {}}, r'kind = "polarity" does not accept \[map\]. Use \[polarity\]'),
        ({"body": None}, r"\[body\] is missing"),
    ],
)
def test_its_refusals_are_those_of_its_class(added, tables, words):
    with pytest.raises(InvalidValueError, match=words):
        JobDocument.of(TABLES | tables)
