"""Rounds of an adaptive study on disk: each round is a separate campaign and is computed once."""

import json
import shlex
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any, TypeVar

from rocking.campaigns import (
    Campaign,
    CampaignDamagedError,
    CampaignIncompleteError,
    CampaignInterrupted,
    CampaignStorageError,
    Executor,
    Progress,
    disk,
)
from rocking.campaigns.disk import FolderLock
from rocking.campaigns.executors import Interruption, WorkerTask
from rocking.campaigns.identity import NAME, SHARDS, Identity
from rocking.campaigns.processes import chosen
from rocking.campaigns.status import Summary
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.studies.histories import Histories
from rocking.studies.study_plan import AdaptiveResult, Search, first_round

_T = TypeVar("_T")

NEEDED = ("outcome", "status", "side", "peak_rotation", "impacts", "overturning_time", "least_force")
"""Results that studies need; a round keeps only these results in memory."""

HISTORIES = "histories"  # the only round of a study that is not adaptive

FINISHED = "finished.json"
"""File with the number of rounds and the number of histories, written after the last round."""


def round_folder(folder: Path, number: int) -> Path:
    """Return the folder of a round, which may be absent."""
    return folder / f"round-{number:03}"


def resume_hint(folder: Path) -> str:
    """Return the hint with the command that resumes a campaign.

    >>> resume_hint(Path("my study"))
    "go on with: rocking campaign resume 'my study'"
    """
    return f"go on with: rocking campaign resume {shlex.quote(str(folder))}"


@contextmanager
def way_out(folder: Path, number: int) -> Iterator[None]:
    """Add a remedy for the user to the error of a damaged round."""
    try:
        yield
    except CampaignDamagedError as error:
        path = round_folder(folder, number)
        if not any(
            PurePath(location.name).name == NAME for location in error.places
        ):  # a resumed run rebuilds shards and ledger
            error.hint = resume_hint(folder)
            raise
        raise CampaignDamagedError(
            "{file} is damaged", file=path / NAME,
            hint=f"remove {path} and {resume_hint(folder)}; the other rounds are kept",
        ) from error  # fmt: skip


def of_rounds(folder: Path, adaptive: bool, report_on: Callable[[Path], _T]) -> list[_T]:
    """Return a report on each round. A study that is not adaptive has one round."""
    if not adaptive:
        return [report_on(folder / HISTORIES)] if (folder / HISTORIES / NAME).exists() else []
    reports: list[_T] = []
    while ((path := round_folder(folder, len(reports))) / NAME).exists():
        with way_out(folder, len(reports)):
            reports.append(report_on(path))
    return reports


def summed(reports: Sequence[_T], *names: str) -> _T:
    """Return the first report with sums of numbers, and joined lists of sentences."""
    columns = {name: [getattr(report, name) for report in reports] for name in names}
    sums = {name: sum(values, type(values[0])()) for name, values in columns.items()}
    return replace(reports[0], **sums)  # type: ignore[type-var]


def finished_rounds(folder: Path) -> dict[str, int] | None:
    """Return the number of rounds and histories of a finished study; None before its end."""
    try:
        noted = json.loads((folder / FINISHED).read_bytes())
        return {name: int(noted[name]) for name in ("rounds", "histories")}
    except FileNotFoundError:
        return None
    except (ValueError, KeyError, TypeError) as error:
        raise CampaignDamagedError(
            "{file} is damaged ({reason})", file=folder / FINISHED, reason=str(error),
            hint=f"remove it, and {resume_hint(folder)}",
        ) from error  # fmt: skip


class Rounds:
    """The rounds of a study in order. With an executor they are computed, otherwise read from disk.

    Ctrl-C and SIGTERM between two rounds are recorded.
    """

    def __init__(self, folder: Path, chunk: int | None = None, who: str | Executor | None = None, **how: Any) -> None:
        self.folder, self.chunk, self.who, self.how = folder, chunk, who, how
        self.number = self.histories = 0
        self.done: list[Summary] = []
        self.between = Interruption()

    @property
    def counts(self) -> dict[str, int]:
        """Rounds and histories so far."""
        return {"rounds": self.number, "histories": self.histories}

    def compute(self, histories: Histories) -> Arrays:
        """Return the results of the next round; results of an earlier computation are read from disk."""
        path, results = round_folder(self.folder, self.number), None
        with self._stopping():
            if self.between.requested():
                raise CampaignInterrupted("between rounds")
            if self.who is None and not (path / NAME).exists():
                raise CampaignIncompleteError("{folder} is missing", folder=path, hint=resume_hint(self.folder))
            campaign = opened(path, histories, self.chunk)
            if self.who is not None:
                with suppress(CampaignDamagedError):  # damaged results are renamed, reported, and computed again
                    results = campaign.results(*NEEDED) if campaign.status(verify=False).complete else None
                if results is None:
                    self.advance(campaign)
            results = results or campaign.results(*NEEDED)
        self.number += 1
        self.histories += histories.count
        return results

    def advance(self, campaign: Campaign) -> None:
        """Compute the missing results of a round."""
        # a round of one chunk needs only one worker
        alone = {"executor": "serial", "workers": 1, "start_method": None} if campaign.plan.chunks == 1 else {}
        self.between.__exit__()  # the campaign handles Ctrl-C and SIGTERM within a round
        if self.between.requested():
            raise CampaignInterrupted("between rounds")
        self.done.append(campaign.run(**({"executor": self.who} | self.how | alone)))
        self.between = Interruption().__enter__()

    def __enter__(self) -> "Rounds":
        """Begin to record signals between rounds."""
        self.between.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        """End the record of signals."""
        self.between.__exit__()

    @contextmanager
    def _stopping(self) -> Iterator[None]:
        """Convert the error of a round into an error of the campaign with its folder."""
        folder = self.folder
        try:
            with way_out(folder, self.number):
                yield
        except CampaignInterrupted as error:
            stopped = f"{folder}: stopped in round {self.number + 1}; {disk.NOTHING_LOST}"
            raise CampaignInterrupted(f"{stopped}; {resume_hint(folder)}") from error
        except CampaignStorageError as error:
            cause = error.__cause__
            raise CampaignStorageError(
                "{fault} in round {number}; {kept}", fault=str(getattr(cause, "strerror", None) or cause or error),
                number=self.number + 1, kept=disk.NOTHING_LOST,
                hint=f"free disk space or allow writing, then {resume_hint(folder)}",
            ).at(str(folder)) from error  # fmt: skip


def opened(path: Path, histories: Histories, chunk: int | None) -> Campaign:
    """Return a campaign; an absent campaign is created."""
    if (path / NAME).exists():
        return Campaign.open(path, histories)
    return Campaign.create(path, histories, chunk)


def replayed(search: Search, folder: Path) -> AdaptiveResult:
    """Return the result of a finished study from its rounds on disk, without computation."""
    noted = finished_rounds(folder)
    if noted is None:
        raise CampaignIncompleteError("not finished", hint=resume_hint(folder)).at(str(folder))
    rounds = Rounds(folder)
    result = search(rounds.compute)
    if noted != rounds.counts:
        raise CampaignDamagedError(
            "{file} contains {expected}, but the rounds have {counts}", file=folder / FINISHED, expected=noted,
            counts=rounds.counts, hint=resume_hint(folder),
        )  # fmt: skip
    more = {"rounds": noted["rounds"], "all_histories": noted["histories"]}
    return replace(result, attributes={**result.attributes, **more})


def run_rounds(
    search: Search, folder: Path, chunk: int | None, executor: str | Executor = "serial", *,
    workers: int | None = None, progress: Callable[[Progress], object] | None = None, **options: Any,
) -> Summary:  # fmt: skip
    """Compute the missing results of all rounds, and return the summary."""
    who = chosen(executor, workers, options.get("start_method"))
    if isinstance(executor, Executor):  # an unusable executor is refused, even if no rounds remain
        histories = first_round(search)
        plan = Identity.of(histories).plan
        task = WorkerTask(histories, plan.engine, plan.software, Path(SHARDS))
        assert not list(who.run(task, iter(()), bool, lambda *_: None))
    rounds = Rounds(folder, chunk, executor, workers=workers, progress=progress, **options)
    with ExitStack() as stack:
        with disk.guarded(folder):
            stack.enter_context(FolderLock(folder))
            disk.remove_unfinished(folder)
        with rounds:
            search(rounds.compute)
        with disk.guarded(folder):
            disk.write_new(folder / FINISHED, (json.dumps(rounds.counts, indent=1) + "\n").encode())
    nothing = Summary(0, 0, 0, (), (), 0)
    return summed([nothing, *rounds.done], "computed", "resumed", "adopted", "set_aside", "retries", "seconds")
