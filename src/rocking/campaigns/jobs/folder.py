"""The folder of a campaign that a job file describes: the job, the hashes of its inputs, and the results."""

import hashlib
import json
import os
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.campaigns import (
    Campaign,
    CampaignDamagedError,
    CampaignMismatchError,
    Executor,
    Progress,
    disk,
    ledger,
)
from rocking.campaigns.jobs.job import Job
from rocking.campaigns.jobs.rounds import (
    HISTORIES,
    finished_rounds,
    of_rounds,
    opened,
    resume_hint,
    round_folder,
    run_rounds,
    summed,
    way_out,
)
from rocking.campaigns.ledger import Verification
from rocking.campaigns.status import CampaignStatus, Summary
from rocking.errors import InvalidValueError, located
from rocking.spec.questions import question_of
from rocking.spec.reading import InputFiles, refuse_changes
from rocking.spec.schema import SCHEMA

if TYPE_CHECKING:
    from rocking.spec.question import StudyQuestion

JOB, INPUTS = "job.toml", "inputs.json"  # files of the folder


@dataclass(frozen=True)
class JobFolder:
    """A campaign on disk with the job that describes it.

    Parameters
    ----------
    path : Path
        The folder.
    job : Job
        The job, its inputs checked against their hashes.
    """

    path: Path
    job: Job

    @classmethod
    def create(cls, folder: str | os.PathLike[str], job: Job) -> "JobFolder":
        """Begin a campaign: the job is copied, with the hashes of its inputs.

        Parameters
        ----------
        folder : path
            A new folder, or an empty one.
        job : Job
            The job.

        Returns
        -------
        JobFolder
            Nothing is computed yet.
        """
        path = Path(folder)
        content = {
            "job_file": job.name,
            "job_folder": str(job.folder),
            "job_sha256": _sha256(job.text.encode()),
            "files": job.inputs,
            "schema": SCHEMA,
        }
        with disk.guarded(path, lambda: "nothing was written"):
            if path.exists() and not path.is_dir():
                raise CampaignMismatchError("a file, not a folder").at(str(path))
            disk.make_folder(path)
            disk.refuse_used(path, JOB, {INPUTS}, resume_hint(path))
            disk.write_new(path / INPUTS, (json.dumps(content, indent=1, sort_keys=True) + "\n").encode())
            disk.write_new(path / JOB, job.text.encode())
        begun = cls(path, job)
        _ = begun.campaign
        return begun

    @classmethod
    def open(cls, folder: str | os.PathLike[str], inputs: str | os.PathLike[str] | None = None) -> "JobFolder":
        """Go on with a campaign, if its inputs are what they were.

        Parameters
        ----------
        folder : path
            The folder.
        inputs : path, optional
            Where the files are now that the job names; where they were, if not given.

        Returns
        -------
        JobFolder
            With all that is finished.

        Raises
        ------
        InvalidValueError
            If a file that the job names is not what it was.
        CampaignDamagedError
            If the job itself is not.
        """
        path = Path(folder)
        text, content = _kept(path)
        base = Path(content["job_folder"] if inputs is None else inputs)
        if not base.is_dir() and content["files"]:
            raise InvalidValueError(
                "the folder of its inputs, {inputs}, is not there", inputs=base, hint="give --inputs"
            ).at(str(path))
        with located(str(path), "file"):
            files = InputFiles(base)
            for item in content["files"]:  # before they are read: what has changed may not be readable
                files.file(item["path"])
            refuse_changes(content["files"], files.facts())
        job = Job.of_text(text, content["job_file"], base)
        with located(str(path), "file"):
            refuse_changes(content["files"], job.inputs)
        return cls(path, job)

    @cached_property
    def campaign(self) -> Campaign:
        """The campaign, of an adaptive study its first round; begun where a killed process had not come that far."""
        chunk = self.job.document.campaign.chunk
        if self.job.study.search is None:
            return opened(self.path / HISTORIES, self.job.study.histories, chunk)
        with way_out(self.path, 0):
            return opened(round_folder(self.path, 0), self.job.study.histories, chunk)

    def run(
        self, executor: str | Executor = "serial", *, workers: int | None = None,
        progress: Callable[[Progress], object] | None = None, **options: Any,
    ) -> Summary:  # fmt: skip
        """Compute what is missing; of an adaptive study all rounds, one after another.

        Parameters
        ----------
        executor : {"serial", "processes"} or Executor
            Who computes.
        workers : int, optional
            Threads or processes.
        progress : callable, optional
            Called with a `Progress` at the start and after every chunk; of an adaptive study it tells of one round.
        **options
            ``start_method`` and ``order_seed`` of `Campaign.run`.

        Returns
        -------
        Summary
            What was done.

        Raises
        ------
        CampaignMismatchError
            If a round on disk is not the one that the job asks for.
        CampaignInterrupted
            If Ctrl-C or SIGTERM asked it to stop.
        """
        search = self.job.study.search
        if search is None:
            return self.campaign.run(executor, workers=workers, progress=progress, **options)
        chunk = self.job.document.campaign.chunk
        return run_rounds(search, self.path, chunk, executor, workers=workers, progress=progress, **options)


@dataclass(frozen=True)
class JobStatus:
    """How far a campaign is, and what it is."""

    path: Path
    name: str
    kind: str
    # None if it was killed before it had begun; of an adaptive study it is of all rounds that have begun
    status: CampaignStatus | None
    complete: bool  # whether all is computed
    # rounds of an adaptive study that have begun; how many will follow is not known before they do. None of others
    rounds: int | None = None


def status_of(folder: str | os.PathLike[str], *, verify: bool = True) -> JobStatus:
    """Return how far a campaign is; nothing is written, and its inputs are not needed.

    Parameters
    ----------
    folder : path
        The folder.
    verify : bool
        Whether to read all results: what is damaged does not count. Without it the ledger is believed.

    Returns
    -------
    JobStatus
        As recorded at this instant.
    """
    path = Path(folder)
    return job_status(path, _document(path), verify)


def job_status(path: Path, document: "StudyQuestion", verify: bool) -> JobStatus:
    """Return how far the campaign of a document is."""
    name, kind, adaptive = document.campaign.name, document.campaign.kind, document.is_adaptive
    each = of_rounds(path, adaptive, lambda folder: Campaign.status_of(folder, verify=verify))
    if not each:
        return JobStatus(path, name, kind, None, False, 0 if adaptive else None)
    if not adaptive:
        return JobStatus(path, name, kind, each[0], each[0].complete)
    status = summed(
        each, "histories", "histories_done", "chunks", "chunks_done", "seconds", "retries", "damaged", "broken"
    )
    status = replace(status, folder=path, running=disk.holder(path), work=None)
    finished = finished_rounds(path)
    complete = finished is not None and finished["rounds"] == len(each) and status.complete
    return JobStatus(path, name, kind, status, complete, len(each))


def verified(folder: str | os.PathLike[str]) -> Verification:
    """Read everything that a campaign has, and see that it is there once, and is what was written.

    Parameters
    ----------
    folder : path
        The folder; its inputs are not needed, and nothing is written.

    Returns
    -------
    Verification
        Of an adaptive study that of all rounds that have begun, which count on.
    """
    path = Path(folder)
    adaptive = _document(path).is_adaptive
    rounds = of_rounds(path, adaptive, ledger.verified)
    wrong = [] if rounds or adaptive else [f"{path}: nothing is computed yet"]
    if adaptive and ((noted := finished_rounds(path)) is None or noted["rounds"] != len(rounds)):
        wrong = [f"{path} is not finished, and more rounds may follow"]
    begins = np.cumsum([0, *(each.histories for each in rounds)]).tolist()
    return Verification(
        begins[-1],
        sum(each.verified for each in rounds),
        sum(each.chunks for each in rounds),
        (*wrong, *(sentence for each in rounds for sentence in each.damaged)),
        tuple((a + k, b + k) for k, each in zip(begins, rounds, strict=False) for a, b in each.missing),
    )


def _document(path: Path) -> "StudyQuestion":
    text, content = _kept(path)
    with located(content["job_file"], "file"):
        return question_of(text)


def _kept(path: Path) -> tuple[str, dict[str, Any]]:
    """Return the job as it was copied, and what was noted of its inputs."""
    with disk.guarded(path):
        if not (path / JOB).is_file():
            raise CampaignMismatchError("no campaign of a job file here ({file} is missing)", file=JOB).at(str(path))
        text, noted = (path / JOB).read_bytes(), (path / INPUTS).read_bytes() if (path / INPUTS).exists() else b""
    try:
        content = json.loads(noted)
        files = [(item["path"], item["sha256"], item["bytes"]) for item in content["files"]]
        assert all(isinstance(name, str) and isinstance(sha, str) for name, sha, _ in files)
        if content.get("job_sha256", _sha256(text)) != _sha256(text):  # older folders have none
            raise CampaignDamagedError(
                "{file} has changed since the campaign began", file=path / JOB,
                hint="restore it, or begin a new campaign in another folder",
            )  # fmt: skip
        names = {name: str(content[name]) for name in ("job_folder", "job_file")}
        return _of_schema(content.get("schema", 1), text.decode()), content | names
    except (ValueError, KeyError, TypeError, AssertionError) as error:
        raise CampaignDamagedError(
            "{file} is missing or damaged ({reason})", file=path / INPUTS, reason=str(error),
            hint=f"begin a new campaign of {path / JOB} in another folder",
        ) from error  # fmt: skip


def _of_schema(number: int, text: str) -> str:
    """Return a kept job that states its restitution: the default of schema 1 was ked."""
    tables = tomllib.loads(text) if number < 2 else {"restitution": {}}
    is_stated = "restitution" in tables or tables.get("campaign", {}).get("kind") == "inventory"
    return text if is_stated else f'{text}\n[restitution]\nmodel = "ked"\n'


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
