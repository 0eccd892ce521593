"""Results read piece by piece, and what an earlier run has left: no number leaves a shard whose seal is broken."""

import hashlib
import os
import time
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rocking.campaigns import chunks as shard
from rocking.campaigns import disk
from rocking.campaigns.chunks import Chunk, Plan
from rocking.campaigns.disk import CampaignDamagedError, CampaignIncompleteError
from rocking.campaigns.executors import PIECES, SUFFIX, path_of
from rocking.campaigns.identity import SHARDS, Identity
from rocking.campaigns.ledger import NAME, Ledger, LedgerEntry
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays
from rocking.errors import InvalidValueError


class HistoryRange(NamedTuple):
    """Results of some histories.

    Parameters
    ----------
    first, last : int
        Their numbers: from the first up to but not including the last.
    results : dict of str to ndarray
        The keys of `fast_engine.RESULTS`.
    """

    first: int
    last: int
    results: Arrays


def pieces(folder: Path, plan: Plan) -> Iterator[HistoryRange]:
    """Return the results of a finished campaign in the order of the histories, one chunk in memory at a time."""
    seals = _seals(folder, plan)
    if len(seals) < plan.chunks:
        raise CampaignIncompleteError(f"{folder}: {len(seals)} of {plan.chunks} chunks are finished; run the campaign")
    for number in range(plan.chunks):
        chunk = plan.chunk(number)
        yield HistoryRange(chunk.first, chunk.last, _read(folder, chunk, seals[number]))


def results(folder: Path, plan: Plan, names: Collection[str] = ()) -> Arrays:
    """Return results of all histories at once.

    Returns one entry a history: 83 bytes each of all keys.
    """
    for name in names:
        _check_name(name)
    whole = {name: np.empty(plan.count, RESULTS[name]) for name in names or RESULTS}
    for piece in pieces(folder, plan):
        for name, values in whole.items():
            values[piece.first : piece.last] = piece.results[name]
    return whole


def column(folder: Path, plan: Plan, name: str) -> Iterator[np.ndarray]:
    """Return one result of all histories, piece by piece.

    Returns its values for one chunk after another.
    """
    _check_name(name)
    for piece in pieces(folder, plan):
        yield piece.results[name]


def _check_name(name: str) -> None:
    if name not in RESULTS:
        raise InvalidValueError(f"column must be one of {', '.join(RESULTS)}, got {name!r:.60}")


def digest(found: Iterator[HistoryRange]) -> str:
    """Return the hash of results: it does not depend on how they are cut.

    Returns SHA-256, 64 hexadecimal digits, of names, types and the hashes of the columns.
    """
    columns = {name: hashlib.sha256() for name in RESULTS}
    for piece in found:
        for name, values in piece.results.items():
            columns[name].update(np.ascontiguousarray(values, values.dtype.newbyteorder("<")).tobytes())
    text = "".join(f"{name} {np.dtype(RESULTS[name]).name} {made.hexdigest()}\n" for name, made in columns.items())
    return hashlib.sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class Verification:
    """What was found of a campaign's results, each of which was read.

    Parameters
    ----------
    histories, verified : int
        All of them, and those whose results are there, to the last bit as they were written.
    chunks : int
        Whole chunks among the latter.
    damaged : tuple of str
        A sentence for each shard that the ledger has and that is changed, cut short, of other histories, or missing;
        one for a ledger that cannot be read, without which nothing counts.
    missing : tuple of tuple of int
        Histories that are not there: from the first up to but not including the last.
    """

    histories: int
    verified: int
    chunks: int
    damaged: tuple[str, ...]
    missing: tuple[tuple[int, int], ...]

    @property
    def whole(self) -> bool:
        """Whether all results are there, and are what was written."""
        return not self.damaged and not self.missing


def verified(folder: Path) -> Verification:
    """Read every shard that the ledger has, and see that they hold all histories, and none of them twice."""
    with disk.guarded(folder):
        plan = Identity.read(folder).plan
        try:
            with disk.guarded(folder):
                records = _records(folder, plan)
        except CampaignDamagedError as error:
            return Verification(plan.count, 0, 0, (str(error),), ())
        return _verified(folder, plan, records)


def _verified(folder: Path, plan: Plan, records: list[tuple[Chunk, str]]) -> Verification:
    damaged: list[str] = []
    there: list[tuple[int, int]] = []
    chunks = 0
    for chunk, sealed in records:
        try:
            _read(folder, chunk, sealed)
        except CampaignDamagedError as error:
            if chunk.of and not any(each == chunk for each, _ in _records(folder, plan)):
                return verified(folder)  # meanwhile whoever runs it has made a chunk of it
            damaged.append(str(error))
        else:
            there.append((chunk.first, chunk.last))
            chunks += not chunk.of
    missing, end = [], 0
    for first, last in [*sorted(there), (plan.count, plan.count)]:
        if end < first:
            missing.append((end, first))
        end = last
    done = sum(last - first for first, last in there)
    return Verification(plan.count, done, chunks, tuple(damaged), tuple(missing))


def _records(folder: Path, plan: Plan) -> list[tuple[Chunk, str]]:
    """Return the chunks and pieces that the ledger has, with their seals; it refuses those that overlap."""
    if not (folder / NAME).exists():
        return []
    with Ledger(folder) as ledger, ledger.instant():
        if not ledger.begun:
            return []
        ledger.check(plan)
        found = [(plan.chunk(record.number), record.seal) for record in ledger.records()]
        parts = (
            (plan.chunk(record.number).piece(record.first, record.last), record.seal) for record in ledger.pieces()
        )
        return [*found, *parts]


def _seals(folder: Path, plan: Plan) -> dict[int, str]:
    return {chunk.number: sealed for chunk, sealed in _records(folder, plan) if not chunk.of}


def _read(folder: Path, chunk: Chunk, sealed: str) -> Arrays:
    path = path_of(folder / SHARDS, chunk)
    advice = "run the campaign again: it is computed anew"
    try:
        return shard.unpack(path.read_bytes(), chunk, sealed)
    except FileNotFoundError as error:
        raise CampaignDamagedError(f"{path} is missing; {advice}") from error
    except CampaignDamagedError as error:
        raise CampaignDamagedError(f"{path}: {error}; {advice}") from error


@dataclass
class EarlierRun:
    """What an earlier run has left."""

    finished: np.ndarray  # for every chunk, whether it is
    adopted: int = 0  # shards that the ledger did not know: the run ended between writing and recording them
    # shards that were damaged or missing, and where the former are now
    set_aside: list[str] = field(default_factory=list)
    # by number of the chunk, the pieces of those that are not finished, in order
    pieces: dict[int, list[Chunk]] = field(default_factory=dict)


def recover(folder: Path, plan: Plan, ledger: Ledger, stop: Callable[[], bool] = lambda: False) -> EarlierRun:
    """Check all shards, take back what the ledger has of damaged ones, adopt what it does not know."""
    for each in (folder, folder.with_name(PIECES)):
        disk.remove_unfinished(each)
    found = EarlierRun(np.zeros(plan.chunks, bool))
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


def _recover_pieces(folder: Path, plan: Plan, ledger: Ledger, stop: Callable[[], bool], found: EarlierRun) -> None:
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


def _adopt_piece(path: Path, plan: Plan, ledger: Ledger, found: EarlierRun) -> bool:
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


def _recall(folder: Path, chunk: Chunk, sealed: str, ledger: Ledger, found: EarlierRun) -> bool:
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


def _take_back(ledger: Ledger, chunk: Chunk, found: EarlierRun, why: str) -> None:
    ledger.forget(chunk.name)
    ledger.note("damaged", chunk.number, why)
    found.set_aside.append(why)


def _adopt(folder: Path, chunk: Chunk, ledger: Ledger, found: EarlierRun) -> bool:
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
    record = LedgerEntry(*chunk[:4], shard.seal(data), len(data), 1, 0.0, "an earlier run", now())
    (ledger.record_piece if chunk.of else ledger.record)(record)
    found.adopted += 1
    return True
