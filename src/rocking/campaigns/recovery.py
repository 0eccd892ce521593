"""What an earlier run has left: every shard is checked, whole ones are taken over, damaged ones set aside."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rocking.campaigns import chunks as shard
from rocking.campaigns import disk
from rocking.campaigns.chunks import Chunk, Plan
from rocking.campaigns.disk import CampaignDamagedError
from rocking.campaigns.executors import PIECES, SUFFIX, path_of
from rocking.campaigns.ledger import NAME, Ledger, LedgerEntry
from rocking.errors import InvalidValueError


@dataclass
class EarlierRun:
    """What an earlier run has left."""

    folder: Path  # of the shards
    plan: Plan
    ledger: Ledger
    adopted: int = 0  # shards that the ledger did not know: the run ended between writing and recording them
    # shards that were damaged or missing, and where the former are now
    set_aside: list[str] = field(default_factory=list)
    # by number of the chunk, the pieces of those that are not finished, in order
    pieces: dict[int, list[Chunk]] = field(default_factory=dict)
    finished: np.ndarray = field(init=False)  # for every chunk, whether it is

    def __post_init__(self) -> None:
        """Nothing is known to be finished yet."""
        self.finished = np.zeros(self.plan.chunks, bool)

    def recover(self, stop: Callable[[], bool] = lambda: False) -> "EarlierRun":
        """Check all shards, take back what the ledger has of damaged ones, adopt what it does not know."""
        for each in (self.folder, self.folder.with_name(PIECES)):
            disk.remove_unfinished(each)
        known = np.zeros(self.plan.chunks, bool)
        for record in self.ledger.records():
            if stop():
                return self
            known[record.number] = True
            self.finished[record.number] = self._intact(self.plan.chunk(record.number), record.seal) is not None
        there = {entry.name for entry in os.scandir(self.folder)}
        for number in np.flatnonzero(~known):
            if stop() or not there:
                break
            chunk = self.plan.chunk(int(number))
            if chunk.name + SUFFIX in there:
                self.finished[number] = self._adopt(chunk)
        self._recover_pieces(stop)
        return self

    def _recover_pieces(self, stop: Callable[[], bool]) -> None:
        """Check the pieces of chunks that are not finished, adopt what the ledger does not know; the others may go."""
        known: set[str] = set()
        for record in list(self.ledger.pieces()):
            if stop():
                return
            piece = self.plan.chunk(record.number).piece(record.first, record.last)
            if self.finished[record.number]:
                self.ledger.forget(piece.name)  # its chunk was adopted
            elif self._intact(piece, record.seal) is not None:
                self.pieces.setdefault(record.number, []).append(piece)
                known.add(piece.name + SUFFIX)
        for path in sorted(self.folder.with_name(PIECES).glob(f"*{SUFFIX}")):
            if stop():
                return
            if path.name not in known and not self._adopt_piece(path):
                path.unlink(missing_ok=True)  # or it was damaged, and set aside
        for pieces in self.pieces.values():
            pieces.sort()

    def _adopt_piece(self, path: Path) -> bool:
        """Record a piece that is there and whole, and whose histories are not there yet."""
        try:
            first, last = shard.range_of(path.read_bytes())
            whole = self.plan.chunk(first // self.plan.size)
            piece = whole.piece(first, last)
        except (CampaignDamagedError, InvalidValueError):
            return False
        others = self.pieces.get(piece.number, [])
        if self.finished[piece.number] or not piece.of or f"{piece.name}{SUFFIX}" != path.name or last > whole.last:
            return False
        if any(first < other.last and other.first < last for other in others) or not self._adopt(piece):
            return False
        self.pieces[piece.number] = sorted([*others, piece])
        return True

    def _adopt(self, chunk: Chunk) -> bool:
        """Record a shard that is there and whole."""
        data = self._intact(chunk)
        if data is None:
            return False
        disk.sync_folder(path_of(self.folder, chunk).parent)  # perhaps renamed in the last instant before a kill
        record = LedgerEntry(*chunk[:4], shard.seal(data), len(data), 1, 0.0, "an earlier run", now())
        (self.ledger.record_piece if chunk.of else self.ledger.record)(record)
        self.adopted += 1
        return True

    def _intact(self, chunk: Chunk, sealed: str | None = None) -> bytes | None:
        """Return a shard that is still what it was; one that is not is set aside, taken back and noted."""
        path = path_of(self.folder, chunk)
        try:
            data = path.read_bytes()
            shard.unpack(data, chunk, sealed)
            return data
        except FileNotFoundError:
            why = f"{path.name} is missing; it is computed again"
        except CampaignDamagedError as error:
            why = f"{path.name}: {error}; kept as {disk.set_aside(path).name}, and computed again"
        self.ledger.forget(chunk.name)
        self.ledger.note("damaged", chunk.number, why)
        self.set_aside.append(why)
        return None


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
