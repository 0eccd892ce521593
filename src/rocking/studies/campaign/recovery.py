"""What an earlier run has left: every shard is read again before it counts."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rocking.studies.campaign import disk, shard
from rocking.studies.campaign.chunks import Chunk, Plan
from rocking.studies.campaign.errors import CampaignDamagedError
from rocking.studies.campaign.executors import SUFFIX
from rocking.studies.campaign.identity import SHARDS
from rocking.studies.campaign.ledger import NAME, Ledger, Record


@dataclass
class Found:
    """What an earlier run has left.

    Parameters
    ----------
    finished : ndarray of bool
        For every chunk, whether it is.
    adopted : int
        Shards that the ledger did not know: the run ended between writing and recording them.
    set_aside : list of str
        Shards that were damaged or missing, and where the former are now.
    """

    finished: np.ndarray
    adopted: int = 0
    set_aside: list[str] = field(default_factory=list)


def recover(folder: Path, plan: Plan, ledger: Ledger, stop: Callable[[], bool] = lambda: False) -> Found:
    """Check all shards, take back what the ledger has of damaged ones, adopt what it does not know.

    Parameters
    ----------
    folder : Path
        Where the shards are.
    plan : Plan
        How the campaign is cut.
    ledger : Ledger
        The ledger, already checked.
    stop : callable
        Whether to stop; chunks not looked at by then count as unfinished.

    Returns
    -------
    Found
        What there is.
    """
    disk.remove_unfinished(folder)
    found = Found(np.zeros(plan.chunks, bool))
    known = np.zeros(plan.chunks, bool)
    for record in ledger.records():
        if stop():
            return found
        known[record.number] = True
        _recall(folder, plan.chunk(record.number), record.seal, ledger, found)
    there = {entry.name for entry in os.scandir(folder)}
    for number in np.flatnonzero(~known):
        if stop() or not there:
            return found
        chunk = plan.chunk(int(number))
        if chunk.name + SUFFIX in there:
            _adopt(folder, chunk, ledger, found)
    return found


def rebuild(folder: Path, plan: Plan) -> int:
    """Make the ledger anew from the shards; the old one is kept beside it.

    Parameters
    ----------
    folder : Path
        The campaign, locked.
    plan : Plan
        How it is cut.

    Returns
    -------
    int
        Chunks that are finished.
    """
    for path in sorted(folder.glob(f"{NAME}*")):
        if ".damaged-" not in path.name:
            disk.set_aside(path)
    disk.make_folder(folder / SHARDS)
    with Ledger(folder, writable=True) as ledger:
        ledger.note("rebuilt", None, "from the shards")
        return int(recover(folder / SHARDS, plan, ledger).finished.sum())


def now() -> str:
    """Return the time.

    Returns
    -------
    str
        UTC, to the second.
    """
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())


def _recall(folder: Path, chunk: Chunk, sealed: str, ledger: Ledger, found: Found) -> None:
    """See whether a recorded shard is still what it was."""
    path = folder / f"{chunk.name}{SUFFIX}"
    try:
        shard.unpack(path.read_bytes(), chunk, sealed)
    except FileNotFoundError:
        _take_back(ledger, chunk, found, f"{path.name} is missing; it is computed again")
    except CampaignDamagedError as error:
        aside = disk.set_aside(path)
        _take_back(ledger, chunk, found, f"{path.name}: {error}; kept as {aside.name}, and computed again")
    else:
        found.finished[chunk.number] = True


def _take_back(ledger: Ledger, chunk: Chunk, found: Found, why: str) -> None:
    ledger.forget(chunk.number)
    ledger.note("damaged", chunk.number, why)
    found.set_aside.append(why)


def _adopt(folder: Path, chunk: Chunk, ledger: Ledger, found: Found) -> None:
    """Record a shard that is there and whole."""
    path = folder / f"{chunk.name}{SUFFIX}"
    data = path.read_bytes()
    try:
        shard.unpack(data, chunk)
    except CampaignDamagedError as error:
        aside = disk.set_aside(path)
        why = f"{path.name}: {error}; kept as {aside.name}, and computed again"
        ledger.note("damaged", chunk.number, why)
        found.set_aside.append(why)
        return
    disk.sync_folder(folder)  # it was perhaps renamed in the last instant before a kill
    ledger.record(Record(*chunk, shard.seal(data), len(data), 1, 0.0, "an earlier run", now()))
    found.finished[chunk.number] = True
    found.adopted += 1
