"""A job: the TOML description of a campaign."""

import hashlib
import os
import platform
import sys
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.campaigns.identity import software
from rocking.dynamics.mechanics import mechanics_of
from rocking.dynamics.plane import fast_engine
from rocking.errors import located
from rocking.motions.summary import summaries_of
from rocking.restitution import RestitutionModel
from rocking.spec.questions import question_of
from rocking.spec.reading import read_text
from rocking.studies.motion_sets import MotionList

if TYPE_CHECKING:
    from rocking.spec.question import StudyQuestion
    from rocking.spec.study import StudyProblem
    from rocking.studies.study_plan import Study


@dataclass(frozen=True)
class Job:
    r"""A campaign described by a TOML file.

    Parameters
    ----------
    text : str
        Text of the file.
    name : str
        Name in errors.
    folder : Path
        Folder of the input files.

    Examples
    --------
    >>> job = Job.of_text('''
    ... [campaign]
    ... name = "a small map"
    ... kind = "overturning-map"
    ... [body]
    ... units = "m"
    ... width = 0.5
    ... height = 2.0
    ... [motions]
    ... pulse = "sine:amplitude=3,period=0.6"
    ... [map]
    ... x = { axis = "frequency_ratio", from = 1, to = 6, count = 4 }
    ... y = { axis = "amplitude_ratio", values = [1.0, 3.0] }
    ... ''')
    >>> job.study.dims
    {'amplitude_ratio': 2, 'frequency_ratio': 4}
    """

    text: str
    name: str
    folder: Path

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "Job":
        """Return the checked job of a file, including its input files.

        Parameters
        ----------
        path : path
            The file.

        Returns
        -------
        Job
            The job.
        """
        file = Path(path)
        return cls.of_text(read_text(file), file.name, file.resolve().parent)

    @classmethod
    def of_text(cls, text: str, name: str = "job", folder: str | os.PathLike[str] = ".") -> "Job":
        """Return the checked job of a text, including its input files.

        Parameters
        ----------
        text : str
            TOML.
        name : str
            Name in errors.
        folder : path
            Folder of the input files.

        Returns
        -------
        Job
            The job.
        """
        job = cls(text, name, Path(folder))
        with located(name, "file"):
            _ = job.study
        return job

    @cached_property
    def document(self) -> "StudyQuestion":
        """Tables of the file."""
        return question_of(self.text)

    @cached_property
    def problem(self) -> "StudyProblem":
        """Bodies, motions, restitutions and settings."""
        from rocking.spec.study import StudyProblem

        return StudyProblem.of(self.document, self.folder)

    @cached_property
    def study(self) -> "Study":
        """Histories, their dimensions, and the evaluation of their results."""
        return self.document.study(self.problem)

    @property
    def inputs(self) -> list[dict[str, Any]]:
        """Path, SHA-256 and size in bytes of each input file."""
        return self.problem.inputs.facts()

    @cached_property
    def provenance(self) -> dict[str, Any]:
        """Provenance of the results as plain values, without time and folder."""
        histories, campaign, problem = self.study.histories, self.document.campaign, self.problem
        engine = fast_engine.chosen(histories.engine, histories.law)
        motions = {name: value for name, value in problem.motions.description().items() if name != "motions"}
        if isinstance(problem.motions, MotionList):
            motions["sources"] = [summary.answer().plain() for summary in summaries_of(problem.motions)]
        return {
            "software": f"rocking {software()}",
            "campaign": campaign.name,
            "kind": campaign.kind,
            "note": campaign.note or "",
            "job": self.text,
            "job_sha256": hashlib.sha256(self.text.encode()).hexdigest(),
            "inputs": self.inputs,
            "histories": histories.count,
            "histories_key": histories.key(),
            "restitution": [_model(label, restitution) for label, restitution in problem.restitutions.items()],
            "settings": problem.settings.stated,
            "engine": "; ".join(
                dict.fromkeys(
                    mechanics_of(block.settings).engine_of_study(fast=engine == "fast") for block in histories.parts
                )
            ),
            "seeds": {
                "campaign": campaign.seed,
                "motions": [table.seed or 0 for table in self.document.motions if table.synthetic is not None],
                "restitution": [law.seed for law in problem.restitutions.values() if hasattr(law, "seed")],
            },
            "motions": motions | {"count": len(problem.motions)},
            "platform": {
                "system": platform.system(),
                "machine": platform.machine(),
                "byteorder": sys.byteorder,
                "python": platform.python_version(),
                "numpy": np.__version__,
                "scipy": version("scipy"),
            },
        }


def _model(label: str, restitution: Any) -> dict[str, str]:
    if not isinstance(restitution, RestitutionModel):
        return {"label": label}
    return {"label": label, "title": restitution.title, "reference": restitution.reference}
