"""Results of a campaign, read piece by piece: no number leaves a shard whose seal is broken."""

import hashlib
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rocking.dynamics.engine import RESULTS, Arrays
from rocking.errors import InvalidValueError
from rocking.studies.campaign import disk, shard
from rocking.studies.campaign.chunks import Chunk, Plan
from rocking.studies.campaign.errors import CampaignDamagedError, CampaignIncompleteError
from rocking.studies.campaign.executors import path_of
from rocking.studies.campaign.identity import SHARDS, Identity
from rocking.studies.campaign.ledger import NAME, Ledger


class Piece(NamedTuple):
    """Results of some histories.

    Parameters
    ----------
    first, last : int
        Their numbers: from the first up to but not including the last.
    results : dict of str to ndarray
        The keys of `rocking.dynamics.engine.RESULTS`.
    """

    first: int
    last: int
    results: Arrays


def pieces(folder: Path, plan: Plan) -> Iterator[Piece]:
    """Return the results of a finished campaign in the order of the histories, one chunk in memory at a time."""
    seals = _seals(folder, plan)
    if len(seals) < plan.chunks:
        raise CampaignIncompleteError(f"{folder}: {len(seals)} of {plan.chunks} chunks are finished; run the campaign")
    for number in range(plan.chunks):
        chunk = plan.chunk(number)
        yield Piece(chunk.first, chunk.last, _read(folder, chunk, seals[number]))


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


def digest(found: Iterator[Piece]) -> str:
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
