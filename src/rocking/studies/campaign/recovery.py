"""What an earlier run has left: every shard is read again before it counts."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rocking.errors import InvalidValueError
from rocking.studies.campaign import disk, shard
from rocking.studies.campaign.chunks import Chunk, Plan
from rocking.studies.campaign.errors import CampaignDamagedError
from rocking.studies.campaign.executors import PIECES, SUFFIX, path_of
from rocking.studies.campaign.identity import SHARDS
from rocking.studies.campaign.ledger import NAME, Ledger, Record


@dataclass
class Found:
    """What an earlier run has left."""

    finished: np.ndarray  # for every chunk, whether it is
    adopted: int = 0  # shards that the ledger did not know: the run ended between writing and recording them
    # shards that were damaged or missing, and where the former are now
    set_aside: list[str] = field(default_factory=list)
    # by number of the chunk, the pieces of those that are not finished, in order
    pieces: dict[int, list[Chunk]] = field(default_factory=dict)


def recover(folder: Path, plan: Plan, ledger: Ledger, stop: Callable[[], bool] = lambda: False) -> Found:
    """Check all shards, take back what the ledger has of damaged ones, adopt what it does not know."""
    for each in (folder, folder.with_name(PIECES)):
        disk.remove_unfinished(each)
    found = Found(np.zeros(plan.chunks, bool))
    known = np.zeros(plan.chunks, bool)
    for record in ledger.records():
        if stop():
            return found
        known[record.number] = True
        found.finished[record.number] = _recall(folder, plan.chunk(record.number), record.seal, ledger, found)
    there = {entry.name for entry in os.scandir(folder)}
    for number in np.flatnonzero(~known):
        if stop() or not there:
            break
        chunk = plan.chunk(int(number))
        if chunk.name + SUFFIX in there:
            found.finished[number] = _adopt(folder, chunk, ledger, found)
    _recover_pieces(folder, plan, ledger, stop, found)
    return found


def _recover_pieces(folder: Path, plan: Plan, ledger: Ledger, stop: Callable[[], bool], found: Found) -> None:
    """Check the pieces of chunks that are not finished, adopt what the ledger does not know; the others may go."""
    known: set[str] = set()
    for record in list(ledger.pieces()):
        if stop():
            return
        piece = plan.chunk(record.number).piece(record.first, record.last)
        if found.finished[record.number]:
            ledger.forget(piece.name)  # its chunk was adopted
        elif _recall(folder, piece, record.seal, ledger, found):
            found.pieces.setdefault(record.number, []).append(piece)
            known.add(piece.name + SUFFIX)
    for path in sorted(folder.with_name(PIECES).glob(f"*{SUFFIX}")):
        if stop():
            return
        if path.name not in known and not _adopt_piece(path, plan, ledger, found):
            path.unlink(missing_ok=True)  # or it was damaged, and set aside
    for pieces in found.pieces.values():
        pieces.sort()


def _adopt_piece(path: Path, plan: Plan, ledger: Ledger, found: Found) -> bool:
    """Record a piece that is there and whole, and whose histories are not there yet."""
    try:
        first, last = shard.range_of(path.read_bytes())
        whole = plan.chunk(first // plan.size)
        piece = whole.piece(first, last)
    except (CampaignDamagedError, InvalidValueError):
        return False
    others = found.pieces.get(piece.number, [])
    if found.finished[piece.number] or not piece.of or f"{piece.name}{SUFFIX}" != path.name or last > whole.last:
        return False
    if any(first < other.last and other.first < last for other in others) or not _adopt(
        path.parent.with_name(SHARDS), piece, ledger, found
    ):
        return False
    found.pieces[piece.number] = sorted([*others, piece])
    return True


def set_aside_if_damaged(folder: Path, plan: Plan) -> list[str]:
    """Set a ledger aside that cannot be believed: a new one adopts the shards, each of which bears its own seal."""
    try:
        with disk.guarded(folder), Ledger(folder, writable=True) as ledger:
            ledger.check(plan)
        return []
    except CampaignDamagedError as error:
        there = sorted(path for path in folder.glob(f"{NAME}*") if ".damaged-" not in path.name)
        kept = [disk.set_aside(path).name for path in there]
        return [f"{str(error).split('; run ')[0]}; kept as {kept[0]}, and made anew from the shards"]


def now() -> str:
    """Return the time."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())


def _recall(folder: Path, chunk: Chunk, sealed: str, ledger: Ledger, found: Found) -> bool:
    """See whether a recorded shard is still what it was."""
    path = path_of(folder, chunk)
    try:
        shard.unpack(path.read_bytes(), chunk, sealed)
    except FileNotFoundError:
        _take_back(ledger, chunk, found, f"{path.name} is missing; it is computed again")
        return False
    except CampaignDamagedError as error:
        aside = disk.set_aside(path)
        _take_back(ledger, chunk, found, f"{path.name}: {error}; kept as {aside.name}, and computed again")
        return False
    return True


def _take_back(ledger: Ledger, chunk: Chunk, found: Found, why: str) -> None:
    ledger.forget(chunk.name)
    ledger.note("damaged", chunk.number, why)
    found.set_aside.append(why)


def _adopt(folder: Path, chunk: Chunk, ledger: Ledger, found: Found) -> bool:
    """Record a shard that is there and whole."""
    path = path_of(folder, chunk)
    data = path.read_bytes()
    try:
        shard.unpack(data, chunk)
    except CampaignDamagedError as error:
        aside = disk.set_aside(path)
        why = f"{path.name}: {error}; kept as {aside.name}, and computed again"
        ledger.note("damaged", chunk.number, why)
        found.set_aside.append(why)
        return False
    disk.sync_folder(path.parent)  # it was perhaps renamed in the last instant before a kill
    record = Record(*chunk[:4], shard.seal(data), len(data), 1, 0.0, "an earlier run", now())
    (ledger.record_piece if chunk.of else ledger.record)(record)
    found.adopted += 1
    return True
