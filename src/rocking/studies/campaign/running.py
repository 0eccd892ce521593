"""The run of a campaign: what is missing is computed, written, and only then recorded."""

from bisect import insort
from collections.abc import Callable
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking.dynamics.engine import empty_results
from rocking.studies.campaign import disk, shard
from rocking.studies.campaign.chunks import Chunk, Plan
from rocking.studies.campaign.errors import CampaignDamagedError, CampaignInterrupted
from rocking.studies.campaign.executors import PIECES, Done, Executor, Job, path_of
from rocking.studies.campaign.identity import SHARDS, Identity
from rocking.studies.campaign.interruption import Interruption
from rocking.studies.campaign.ledger import Ledger, Record
from rocking.studies.campaign.lock import FolderLock
from rocking.studies.campaign.recovery import Found, now, recover, set_aside_if_damaged
from rocking.studies.campaign.remaining import Remaining
from rocking.studies.campaign.status import Meter, Progress, Summary
from rocking.studies.histories import Histories


def run(
    folder: Path,
    identity: Identity,
    histories: Histories,
    executor: Executor,
    order_seed: int | None,
    progress: Callable[[Progress], object] | None,
) -> Summary:
    """Compute what is missing of a campaign."""
    meter = Meter(folder, identity.plan, progress)
    with disk.guarded(folder, meter.sentence, meter.raised), FolderLock(folder), Interruption() as interruption:
        for name in (SHARDS, PIECES):
            disk.make_folder(folder / name)
        disk.remove_unfinished(folder)
        anew = set_aside_if_damaged(folder, identity.plan)
        with Ledger(folder, writable=True) as ledger:
            for sentence in anew:
                ledger.note("damaged", None, sentence)
            found = recover(folder / SHARDS, identity.plan, ledger, interruption.asked)
            before = ledger.finished()[0]
            meter.begin(before, ((record.first, record.last) for record in (*ledger.records(), *ledger.pieces())))
            job = Job(histories, identity.plan.engine, identity.plan.software, folder / SHARDS)
            run = _Run(job, identity.plan, ledger, meter, found)
            run.merge_all()
            remaining = Remaining(
                identity.plan, np.flatnonzero(~found.finished), found.pieces, histories.together, meter.costs,
                sharers=lambda: executor.at_once, stop=interruption.asked, seed=order_seed,
            )  # fmt: skip
            run.compute(executor, remaining, interruption.asked)
        if interruption.asked():
            raise CampaignInterrupted(f"stopped: {meter.sentence()} in {folder}; run the campaign again to go on")
        with suppress(OSError):  # damaged pieces that were set aside stay
            (folder / PIECES).rmdir()
    return Summary(
        meter.chunks - before, before, found.adopted, (*anew, *found.set_aside), tuple(meter.retries), meter.seconds
    )


@dataclass
class _Run:
    """Records what is finished; the record is what makes it finished. Pieces that are a whole chunk become its shard.

    The shards of a finished campaign are the same files whatever the pieces were.
    """

    job: Job
    plan: Plan
    ledger: Ledger
    meter: Meter
    found: Found

    def compute(self, executor: Executor, remaining: Remaining, stop: Callable[[], bool]) -> None:
        def retried(chunk: Chunk, why: str) -> None:
            self.meter.retries.append(why)
            self.ledger.note("retried", chunk.number, why)

        with closing(executor.run(self.job, remaining, stop, retried)) as finished:  # type: ignore[type-var]
            for done in finished:
                whole = not done.chunk.of
                (self.ledger.record if whole else self.ledger.record_piece)(_record(done))
                remaining.back(done.chunk, done.seconds)
                if not whole:
                    insort(self.found.pieces.setdefault(done.chunk.number, []), done.chunk)
                    whole = self.merge(done.chunk.number)
                self.meter.add(done.chunk, done.seconds, whole=whole)

    def merge_all(self) -> None:
        """Make chunks of what an earlier run left without coming to that."""
        for number in list(self.found.pieces):
            if self.merge(number):
                self.found.finished[number] = True
                self.meter.chunks += 1

    def merge(self, number: int) -> bool:
        """Make a chunk of its pieces, if all are there."""
        chunk, pieces = self.plan.chunk(number), self.found.pieces[number]
        if sum(each.last - each.first for each in pieces) < chunk.last - chunk.first:
            return False
        results = empty_results(chunk.last - chunk.first)
        for each in pieces:
            path = path_of(self.job.folder, each)
            try:
                found = shard.unpack(path.read_bytes(), each)
            except (FileNotFoundError, CampaignDamagedError) as error:
                raise CampaignDamagedError(f"{path}: {error}; run the campaign again: it is computed anew") from error
            for name, values in found.items():
                results[name][each.first - chunk.first : each.last - chunk.first] = values
        parts = [record for record in self.ledger.pieces() if record.number == number]
        seconds, attempts = sum(each.seconds for each in parts), sum(each.attempts - 1 for each in parts) + 1
        workers = ", ".join(sorted({each.worker for each in parts}))
        done = self.job.keep(chunk, shard.pack(chunk, results), seconds, workers)
        self.ledger.record(_record(done._replace(attempts=attempts)))
        for each in self.found.pieces.pop(number):
            path_of(self.job.folder, each).unlink(missing_ok=True)
        return True


def _record(done: Done) -> Record:
    return Record(*done.chunk[:4], done.seal, done.size, done.attempts, done.seconds, done.worker, now())
