"""The folder of a campaign with a job: the job, the hashes of its inputs, and the results."""

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

JOB, INPUTS = "job.toml", "inputs.json"  # names of the files in the folder


@dataclass(frozen=True)
class JobFolder:
    """A campaign on disk with its job.

    Parameters
    ----------
    path : Path
        The folder.
    job : Job
        The job, with checked hashes of its inputs.
    """

    path: Path
    job: Job

    @classmethod
    def create(cls, folder: str | os.PathLike[str], job: Job) -> "JobFolder":
        """Create a campaign: copy the job, with the hashes of its inputs.

        Parameters
        ----------
        folder : path
            A new or empty folder.
        job : Job
            The job.

        Returns
        -------
        JobFolder
            The campaign without results.
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
                raise CampaignMismatchError("this is a file; a folder is needed").at(str(path))
            disk.make_folder(path)
            disk.refuse_used(path, JOB, {INPUTS}, resume_hint(path))
            disk.write_new(path / INPUTS, (json.dumps(content, indent=1, sort_keys=True) + "\n").encode())
            disk.write_new(path / JOB, job.text.encode())
        begun = cls(path, job)
        _ = begun.campaign
        return begun

    @classmethod
    def open(cls, folder: str | os.PathLike[str], inputs: str | os.PathLike[str] | None = None) -> "JobFolder":
        """Open a campaign with unchanged inputs to continue it.

        Parameters
        ----------
        folder : path
            The folder.
        inputs : path, optional
            Present folder of the input files. Default: their folder at the creation.

        Returns
        -------
        JobFolder
            The campaign with its finished results.

        Raises
        ------
        InvalidValueError
            If an input file has changed.
        CampaignDamagedError
            If the job has changed.
        """
        path = Path(folder)
        text, content = _kept(path)
        base = Path(content["job_folder"] if inputs is None else inputs)
        if not base.is_dir() and content["files"]:
            raise InvalidValueError(
                "the folder of the input files, {inputs}, does not exist", inputs=base, hint="add --inputs"
            ).at(str(path))
        with located(str(path), "file"):
            files = InputFiles(base)
            for item in content["files"]:  # the check comes before reading, because a changed file may be unreadable
                files.file(item["path"])
            refuse_changes(content["files"], files.facts())
        job = Job.of_text(text, content["job_file"], base)
        with located(str(path), "file"):
            refuse_changes(content["files"], job.inputs)
        return cls(path, job)

    @cached_property
    def campaign(self) -> Campaign:
        """The campaign, or the first round of an adaptive study. A killed process may not have created it."""
        chunk = self.job.document.campaign.chunk
        if self.job.study.search is None:
            return opened(self.path / HISTORIES, self.job.study.histories, chunk)
        with way_out(self.path, 0):
            return opened(round_folder(self.path, 0), self.job.study.histories, chunk)

    def run(
        self, executor: str | Executor = "serial", *, workers: int | None = None,
        progress: Callable[[Progress], object] | None = None, **options: Any,
    ) -> Summary:  # fmt: skip
        """Compute the missing results; all rounds of an adaptive study in order.

        Parameters
        ----------
        executor : {"serial", "processes"} or Executor
            The executor.
        workers : int, optional
            Threads or processes.
        progress : callable, optional
            Called with a `Progress` at the start and after every chunk; for one round of an adaptive study.
        **options
            ``start_method`` and ``order_seed`` of `Campaign.run`.

        Returns
        -------
        Summary
            Computed and damaged chunks.

        Raises
        ------
        CampaignMismatchError
            If a round on disk belongs to another job.
        CampaignInterrupted
            After Ctrl-C or SIGTERM.
        """
        search = self.job.study.search
        if search is None:
            return self.campaign.run(executor, workers=workers, progress=progress, **options)
        chunk = self.job.document.campaign.chunk
        return run_rounds(search, self.path, chunk, executor, workers=workers, progress=progress, **options)


@dataclass(frozen=True)
class JobStatus:
    """Progress and kind of a campaign."""

    path: Path
    name: str
    kind: str
    # status of the campaign, or of all rounds so far of an adaptive study; None before the start of the campaign
    status: CampaignStatus | None
    complete: bool  # True if all histories are computed
    # number of rounds so far of an adaptive study, whose total is unknown before the end; None for other studies
    rounds: int | None = None


def status_of(folder: str | os.PathLike[str], *, verify: bool = True) -> JobStatus:
    """Return the progress of a campaign without its inputs; nothing is written.

    Parameters
    ----------
    folder : path
        The folder.
    verify : bool
        Read all results, and exclude damaged results. Otherwise the ledger is used without a check.

    Returns
    -------
    JobStatus
        Recorded progress at the time of the call.
    """
    path = Path(folder)
    return job_status(path, _document(path), verify)


def job_status(path: Path, document: "StudyQuestion", verify: bool) -> JobStatus:
    """Return the progress of the campaign of a document."""
    name, kind, adaptive = document.campaign.name, document.campaign.kind, document.is_adaptive
    reports = of_rounds(path, adaptive, lambda folder: Campaign.status_of(folder, verify=verify))
    if not reports:
        return JobStatus(path, name, kind, None, False, 0 if adaptive else None)
    if not adaptive:
        return JobStatus(path, name, kind, reports[0], reports[0].complete)
    status = summed(
        reports, "histories", "histories_done", "chunks", "chunks_done", "seconds", "retries", "damaged", "broken"
    )
    status = replace(status, folder=path, running=disk.holder(path), work=None)
    finished = finished_rounds(path)
    complete = finished is not None and finished["rounds"] == len(reports) and status.complete
    return JobStatus(path, name, kind, status, complete, len(reports))


def verified(folder: str | os.PathLike[str]) -> Verification:
    """Read all results of a campaign, and check that they are complete and unchanged.

    Parameters
    ----------
    folder : path
        The folder; the inputs are not required, and nothing is written.

    Returns
    -------
    Verification
        Result of the check; for an adaptive study, of all rounds together.
    """
    path = Path(folder)
    adaptive = _document(path).is_adaptive
    rounds = of_rounds(path, adaptive, ledger.verified)
    wrong = [] if rounds or adaptive else [f"{path}: nothing is computed yet"]
    if adaptive and ((noted := finished_rounds(path)) is None or noted["rounds"] != len(rounds)):
        wrong = [f"{path} is not finished, and more rounds may follow"]
    begins = np.cumsum([0, *(report.histories for report in rounds)]).tolist()
    return Verification(
        begins[-1],
        sum(report.verified for report in rounds),
        sum(report.chunks for report in rounds),
        (*wrong, *(sentence for report in rounds for sentence in report.damaged)),
        tuple((a + k, b + k) for k, report in zip(begins, rounds, strict=False) for a, b in report.missing),
    )


def _document(path: Path) -> "StudyQuestion":
    text, content = _kept(path)
    with located(content["job_file"], "file"):
        return question_of(text)


def _kept(path: Path) -> tuple[str, dict[str, Any]]:
    """Return the copied job, and the record of its inputs."""
    with disk.guarded(path):
        if not (path / JOB).is_file():
            raise CampaignMismatchError(
                "the folder contains no campaign of a job file ({file} is missing)", file=JOB
            ).at(str(path))
        text, noted = (path / JOB).read_bytes(), (path / INPUTS).read_bytes() if (path / INPUTS).exists() else b""
    try:
        content = json.loads(noted)
        files = [(item["path"], item["sha256"], item["bytes"]) for item in content["files"]]
        assert all(isinstance(name, str) and isinstance(sha, str) for name, sha, _ in files)
        if content.get("job_sha256", _sha256(text)) != _sha256(text):  # older folders contain no hash of the job
            raise CampaignDamagedError(
                "{file} has changed since the campaign began", file=path / JOB,
                hint="restore the file, or begin a new campaign in another folder",
            )  # fmt: skip
        names = {name: str(content[name]) for name in ("job_folder", "job_file")}
        return _of_schema(content.get("schema", 1), text.decode()), content | names
    except (ValueError, KeyError, TypeError, AssertionError) as error:
        raise CampaignDamagedError(
            "{file} is missing or damaged ({reason})", file=path / INPUTS, reason=str(error),
            hint=f"begin a new campaign of {path / JOB} in another folder",
        ) from error  # fmt: skip


def _of_schema(number: int, text: str) -> str:
    """Return a stored job with a stated restitution, because the default of schema 1 was ked."""
    tables = tomllib.loads(text) if number < 2 else {"restitution": {}}
    is_stated = "restitution" in tables or tables.get("campaign", {}).get("kind") == "inventory"
    return text if is_stated else f'{text}\n[restitution]\nmodel = "ked"\n'


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
