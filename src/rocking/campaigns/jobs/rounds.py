"""Rounds of an adaptive study on disk: each is a campaign of its own, and is not computed again by whoever goes on."""

import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from rocking.campaigns import (
    Campaign,
    CampaignDamagedError,
    CampaignIncompleteError,
    CampaignInterrupted,
    CampaignStorageError,
    Executor,
    Progress,
    Summary,
    disk,
)
from rocking.campaigns.disk import FolderLock
from rocking.campaigns.executors import Interruption, WorkerTask
from rocking.campaigns.identity import NAME, SHARDS, Identity
from rocking.campaigns.jobs.answer import AdaptiveResult
from rocking.campaigns.jobs.asked import Compute, first_round
from rocking.campaigns.jobs.round_status import FINISHED, finished_rounds, resume, round_folder, way_out
from rocking.campaigns.processes import chosen
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays
from rocking.studies.histories import Histories

NEEDED = ("outcome", "status", "side", "peak_rotation", "impacts", "overturning_time", "least_force")
"""What studies decide on: no more of a round is held in memory."""


Search = Callable[[Compute], AdaptiveResult]


@dataclass
class Rounds:
    """The rounds that a study asks for, one after another."""

    folder: Path  # the campaign of the job
    chunk: int | None = None  # histories of a chunk
    # computes what is missing of a round; without it nothing is computed
    advance: Callable[[Campaign], object] | None = None
    asked_to_stop: Callable[[], bool] = lambda: False  # whether to stop before the next round
    number: int = field(default=0, init=False)
    histories: int = field(default=0, init=False)

    def compute(self, histories: Histories) -> Arrays:
        """Return the results of the next round; as they were, if it was computed before."""
        path = round_folder(self.folder, self.number)
        if self.asked_to_stop():
            raise CampaignInterrupted(_stopped(self.folder, self.number))
        if self.advance is None and not (path / NAME).exists():
            raise CampaignIncompleteError(f"{path} is missing; go on with: {resume(self.folder)}")
        with _of_the_job(self.folder, self.number):
            found = self._results(opened(path, histories, self.chunk))
        self.number += 1
        self.histories += histories.count
        return found

    def _results(self, campaign: Campaign) -> Arrays:
        if self.advance is None:
            return _held(campaign)
        with suppress(CampaignDamagedError):  # what is damaged is set aside, said, and computed again
            if campaign.status(verify=False).complete:
                return _held(campaign)
        self.advance(campaign)
        return _held(campaign)


def _held(campaign: Campaign) -> Arrays:
    """Return what is needed of a round, of which one chunk at a time is in memory as a whole."""
    found = {name: np.empty(campaign.plan.count, dtype=RESULTS[name]) for name in NEEDED}
    for piece in campaign.pieces():
        for name, values in found.items():
            values[piece.first : piece.last] = piece.results[name]
    return found


@contextmanager
def _of_the_job(folder: Path, number: int) -> Iterator[None]:
    """Say what stops a round in words of the job: its user knows that folder, and no other."""
    try:
        with way_out(folder, number):
            yield
    except CampaignInterrupted as error:
        raise CampaignInterrupted(_stopped(folder, number)) from error
    except CampaignStorageError as error:
        cause = error.__cause__
        why = getattr(cause, "strerror", None) or cause or error
        advice = f"make room or allow writing, then go on with: {resume(folder)}"
        raise CampaignStorageError(f"{folder}: {why} in round {number + 1}; {disk.NOTHING_LOST}; {advice}") from error


def opened(path: Path, histories: Histories, chunk: int | None) -> Campaign:
    """Return a campaign, begun where it is not."""
    if (path / NAME).exists():
        return Campaign.open(path, histories)
    return Campaign.create(path, histories, chunk)


def replayed(search: Search, folder: Path) -> AdaptiveResult:
    """Return what a finished study has found, from its rounds on disk; nothing is computed."""
    told = finished_rounds(folder)
    if told is None:
        raise CampaignIncompleteError(f"{folder}: not finished; go on with: {resume(folder)}")
    rounds = Rounds(folder)
    answer = search(rounds.compute)
    if told != _facts(rounds):
        raise CampaignDamagedError(
            f"{folder / FINISHED} tells of {told}, and there are {_facts(rounds)}; go on with: {resume(folder)}"
        )
    return replace(
        answer, attributes={**answer.attributes, "rounds": told["rounds"], "all_histories": told["histories"]}
    )


class _RoundsRun:
    """One run of the rounds that are missing; what it did is summed up."""

    def __init__(
        self, who: str | Executor, workers: int | None, progress: Callable[[Progress], object] | None, **options: Any
    ) -> None:
        self.who, self.workers, self.progress, self.options = who, workers, progress, options
        self.done: list[Summary] = []
        self.between = Interruption()

    def advance(self, campaign: Campaign) -> None:
        # a round of one chunk has work for one only: others would be started for nothing
        alone = campaign.plan.chunks == 1
        who, workers = ("serial", 1) if alone else (self.who, self.workers)
        options = {"order_seed": self.options["order_seed"]} if alone else self.options
        self.between.__exit__()  # within a round Ctrl-C and SIGTERM are its campaign's, which knows how to stop
        if self.between.asked():
            raise CampaignInterrupted("between rounds")  # said in other words by whoever counts them
        self.done.append(campaign.run(who, workers=workers, progress=self.progress, **options))
        self.between = Interruption().__enter__()

    def asked_to_stop(self) -> bool:
        return self.between.asked()

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Note Ctrl-C and SIGTERM that come between the rounds."""
        self.between.__enter__()
        try:
            yield
        finally:
            self.between.__exit__()

    def summary(self) -> Summary:
        counts = {name: sum(getattr(each, name) for each in self.done) for name in ("computed", "resumed", "adopted")}
        set_aside = tuple(word for each in self.done for word in each.set_aside)
        retries = tuple(word for each in self.done for word in each.retries)
        return Summary(**counts, set_aside=set_aside, retries=retries, seconds=sum(each.seconds for each in self.done))


def run_rounds(
    search: Search, folder: Path, chunk: int | None, executor: str | Executor = "serial", *,
    workers: int | None = None, progress: Callable[[Progress], object] | None = None, **options: Any,
) -> Summary:  # fmt: skip
    """Compute what is missing of all rounds; those that are finished are read.

    Returns what was done in the rounds that were not finished before.
    """
    _check(executor, workers, search, options.get("start_method"))
    run = _RoundsRun(executor, workers, progress, **{"order_seed": None, **options})
    rounds = Rounds(folder, chunk, run.advance, run.asked_to_stop)
    with ExitStack() as stack:
        with disk.guarded(folder):
            stack.enter_context(FolderLock(folder))
            disk.remove_unfinished(folder)
        with run.watched():
            search(rounds.compute)
        with disk.guarded(folder):
            disk.write_new(folder / FINISHED, (json.dumps(_facts(rounds), indent=1) + "\n").encode())
    return run.summary()


def _check(executor: str | Executor, workers: int | None, search: Search, start_method: str | None) -> None:
    """Refuse an executor that cannot compute, also where every round is of one chunk and none would be sent to it."""
    who = chosen(executor, workers, start_method)
    if isinstance(executor, Executor):
        histories = first_round(search)
        plan = Identity.of(histories).plan
        nothing = who.run(
            WorkerTask(histories, plan.engine, plan.software, Path(SHARDS)), iter(()), bool, lambda *_: None
        )
        assert not list(nothing)


def _stopped(folder: Path, number: int) -> str:
    return f"{folder}: stopped in round {number + 1}; {disk.NOTHING_LOST}; go on with: {resume(folder)}"


def _facts(rounds: Rounds) -> dict[str, int]:
    return {"rounds": rounds.number, "histories": rounds.histories}
