"""Rounds of an adaptive study on disk: each is a campaign of its own, and is not computed again by whoever goes on."""

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
"""What studies decide on: no more of a round is held in memory."""

HISTORIES = "histories"  # the only round of a study that is not adaptive

FINISHED = "finished.json"
"""Written when a study has asked for its last round: how many there were, and of how many histories."""


def round_folder(folder: Path, number: int) -> Path:
    """Return the folder of a round; it may not be there yet."""
    return folder / f"round-{number:03}"


def resume_hint(folder: Path) -> str:
    """Return the hint with the command that resumes a campaign.

    >>> resume_hint(Path("my study"))
    "go on with: rocking campaign resume 'my study'"
    """
    return f"go on with: rocking campaign resume {shlex.quote(str(folder))}"


@contextmanager
def way_out(folder: Path, number: int) -> Iterator[None]:
    """Say of a damaged round what its user can do: rounds are not campaigns that anybody began."""
    try:
        yield
    except CampaignDamagedError as error:
        path = round_folder(folder, number)
        if not any(PurePath(place.name).name == NAME for place in error.places):  # a shard or the ledger: made anew
            error.hint = resume_hint(folder)
            raise
        raise CampaignDamagedError(
            "{file} is damaged", file=path / NAME,
            hint=f"remove {path} and {resume_hint(folder)}; the other rounds are kept",
        ) from error  # fmt: skip


def of_rounds(folder: Path, adaptive: bool, look: Callable[[Path], _T]) -> list[_T]:
    """Return what is seen in the folders of the rounds that have begun; what is not adaptive has one."""
    if not adaptive:
        return [look(folder / HISTORIES)] if (folder / HISTORIES / NAME).exists() else []
    seen: list[_T] = []
    while ((path := round_folder(folder, len(seen))) / NAME).exists():
        with way_out(folder, len(seen)):
            seen.append(look(path))
    return seen


def summed(each: Sequence[_T], *names: str) -> _T:
    """Return the first of some reports with numbers summed up, and lists of sentences one after another."""
    columns = {name: [getattr(one, name) for one in each] for name in names}
    sums = {name: sum(values, type(values[0])()) for name, values in columns.items()}
    return replace(each[0], **sums)  # type: ignore[type-var]


def finished_rounds(folder: Path) -> dict[str, int] | None:
    """Return how many rounds and histories there were, as noted when the last round was through; None before."""
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
    """The rounds that a study asks for, one after another: computed where an executor is given, read where not.

    Ctrl-C and SIGTERM between two rounds are noted.
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
        """Return the results of the next round; as they were, if it was computed before."""
        path, results = round_folder(self.folder, self.number), None
        with self._stopping():
            if self.between.requested():
                raise CampaignInterrupted("between rounds")
            if self.who is None and not (path / NAME).exists():
                raise CampaignIncompleteError("{folder} is missing", folder=path, hint=resume_hint(self.folder))
            campaign = opened(path, histories, self.chunk)
            if self.who is not None:
                with suppress(CampaignDamagedError):  # what is damaged is set aside, said, and computed again
                    results = campaign.results(*NEEDED) if campaign.status(verify=False).complete else None
                if results is None:
                    self.advance(campaign)
            results = results or campaign.results(*NEEDED)
        self.number += 1
        self.histories += histories.count
        return results

    def advance(self, campaign: Campaign) -> None:
        """Compute what is missing of a round."""
        # a round of one chunk has work for one only: others would be started for nothing
        alone = {"executor": "serial", "workers": 1, "start_method": None} if campaign.plan.chunks == 1 else {}
        self.between.__exit__()  # within a round Ctrl-C and SIGTERM are its campaign's, which knows how to stop
        if self.between.requested():
            raise CampaignInterrupted("between rounds")
        self.done.append(campaign.run(**({"executor": self.who} | self.how | alone)))
        self.between = Interruption().__enter__()

    def __enter__(self) -> "Rounds":
        """Begin to note what comes between the rounds."""
        self.between.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        """Note it no longer."""
        self.between.__exit__()

    @contextmanager
    def _stopping(self) -> Iterator[None]:
        """Say what stops a round in words of the job: its user knows that folder, and no other."""
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
                hint=f"make room or allow writing, then {resume_hint(folder)}",
            ).at(str(folder)) from error  # fmt: skip


def opened(path: Path, histories: Histories, chunk: int | None) -> Campaign:
    """Return a campaign, begun where it is not."""
    if (path / NAME).exists():
        return Campaign.open(path, histories)
    return Campaign.create(path, histories, chunk)


def replayed(search: Search, folder: Path) -> AdaptiveResult:
    """Return the result of a finished study, from its rounds on disk; nothing is computed."""
    noted = finished_rounds(folder)
    if noted is None:
        raise CampaignIncompleteError("not finished", hint=resume_hint(folder)).at(str(folder))
    rounds = Rounds(folder)
    result = search(rounds.compute)
    if noted != rounds.counts:
        raise CampaignDamagedError(
            "{file} tells of {expected}, and there are {counts}", file=folder / FINISHED, expected=noted,
            counts=rounds.counts, hint=resume_hint(folder),
        )  # fmt: skip
    more = {"rounds": noted["rounds"], "all_histories": noted["histories"]}
    return replace(result, attributes={**result.attributes, **more})


def run_rounds(
    search: Search, folder: Path, chunk: int | None, executor: str | Executor = "serial", *,
    workers: int | None = None, progress: Callable[[Progress], object] | None = None, **options: Any,
) -> Summary:  # fmt: skip
    """Compute what is missing of all rounds, read the others, and return what was done in the former."""
    who = chosen(executor, workers, options.get("start_method"))
    if isinstance(executor, Executor):  # one that cannot compute is refused, also where no round is sent to it
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
