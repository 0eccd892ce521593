"""A job: a TOML file that says what a campaign computes."""

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.spec.reading import document_of, located, read_text

if TYPE_CHECKING:
    from rocking.campaigns.jobs.study import Study
    from rocking.spec.document import CampaignDocument
    from rocking.spec.study import StudyProblem


@dataclass(frozen=True)
class Job:
    r"""What a campaign computes, as a TOML file says it.

    Parameters
    ----------
    text : str
        The file.
    name : str
        Name that errors show.
    folder : Path
        Where the files are that it names.

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
        """Return the job of a file, checked as a whole; all files that it names are read.

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
        """Return the job that a text describes, checked as a whole; all files that it names are read.

        Parameters
        ----------
        text : str
            TOML.
        name : str
            Name that errors show.
        folder : path
            Where the files are that it names.

        Returns
        -------
        Job
            The job.
        """
        made = cls(text, name, Path(folder))
        with located(name):
            _ = made.study
        return made

    @cached_property
    def document(self) -> "CampaignDocument":
        """Its tables."""
        return document_of(self.text)

    @cached_property
    def problem(self) -> "StudyProblem":
        """Bodies, motions, restitutions and settings."""
        from rocking.spec.study import StudyProblem

        return StudyProblem.of(self.document, self.folder)

    @cached_property
    def study(self) -> "Study":
        """Histories, what they are over, and what is read off their results."""
        from rocking.campaigns.jobs.kinds import KINDS

        return KINDS[self.document.campaign.kind](self.problem)

    @property
    def inputs(self) -> list[dict[str, Any]]:
        """The files that it names: path, sha256 and bytes of each."""
        return self.problem.inputs.told()

    @cached_property
    def provenance(self) -> dict[str, Any]:
        """Where its results come from."""
        from rocking.campaigns.jobs.provenance import provenance

        return provenance(self)
