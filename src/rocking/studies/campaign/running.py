"""The run of a campaign: what is missing is computed, written, and only then recorded."""

from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import numpy as np

from rocking.studies.campaign import disk
from rocking.studies.campaign.chunks import Chunk
from rocking.studies.campaign.errors import CampaignInterrupted
from rocking.studies.campaign.executors import Done, Executor, Job
from rocking.studies.campaign.identity import SHARDS, Identity
from rocking.studies.campaign.interruption import Interruption
from rocking.studies.campaign.ledger import Ledger, Record
from rocking.studies.campaign.lock import FolderLock
from rocking.studies.campaign.recovery import Found, now, recover
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
    """Compute what is missing of a campaign.

    Parameters
    ----------
    folder : Path
        The campaign.
    identity : Identity
        What it is.
    histories : Histories
        What to compute.
    executor : Executor
        Who computes.
    order_seed : int, optional
        Seed of the order of the chunks; that of the histories, if not given.
    progress : callable, optional
        Called with `Progress` after every chunk.

    Returns
    -------
    Summary
        What was done.

    Raises
    ------
    CampaignInterrupted
        If it was asked to stop.
    """
    meter = Meter(folder, identity.plan, progress)
    with disk.guarded(folder, meter.sentence, meter.raised), FolderLock(folder), Interruption() as interruption:
        disk.make_folder(folder / SHARDS)
        disk.remove_unfinished(folder)
        with Ledger(folder, writable=True) as ledger:
            ledger.check(identity.plan)
            found = recover(folder / SHARDS, identity.plan, ledger, interruption.asked)
            before = ledger.finished()
            meter.begin(*before)
            chunks = _missing(identity, found, order_seed, interruption.asked)
            job = Job(histories, identity.plan.engine, identity.plan.software, folder / SHARDS)
            _compute(job, executor, chunks, ledger, meter, interruption.asked)
        if interruption.asked():
            raise CampaignInterrupted(f"stopped: {meter.sentence()} in {folder}; run the campaign again to go on")
    return Summary(
        meter.chunks - before[0], before[0], found.adopted, tuple(found.set_aside), tuple(meter.retries), meter.seconds
    )


def _compute(
    job: Job, executor: Executor, chunks: Iterator[Chunk], ledger: Ledger, meter: Meter, stop: Callable[[], bool]
) -> None:
    """Record what the executor finishes; the record is what makes a chunk finished."""

    def retried(chunk: Chunk, why: str) -> None:
        meter.retries.append(why)
        ledger.note("retried", chunk.number, why)

    with closing(executor.run(job, chunks, stop, retried)) as finished:  # type: ignore[type-var]
        for done in finished:
            ledger.record(_record(done))
            meter.add(done.chunk.last - done.chunk.first)


def _missing(identity: Identity, found: Found, seed: int | None, stop: Callable[[], bool]) -> Iterator[Chunk]:
    numbers = np.flatnonzero(~found.finished)
    if seed is not None:
        numbers = np.random.default_rng(seed).permutation(numbers)
    for number in numbers:
        if stop():
            return
        yield identity.plan.chunk(int(number))


def _record(done: Done) -> Record:
    return Record(*done.chunk[:4], done.seal, done.size, done.attempts, done.seconds, done.worker, now())
