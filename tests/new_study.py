"""A study in one file, added for tests to `rocking.spec.questions`."""

import sys

import pytest

from rocking import spec
from rocking.spec import questions
from rocking.spec.question import QUESTIONS

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
