"""Results read piece by piece: no number leaves a shard whose seal is broken."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rocking.campaigns import chunks as shard
from rocking.campaigns import disk
from rocking.campaigns.chunks import Chunk, Plan
from rocking.campaigns.disk import CampaignDamagedError, CampaignIncompleteError
from rocking.campaigns.executors import path_of
from rocking.campaigns.identity import SHARDS, Identity
from rocking.campaigns.ledger import NAME, Ledger
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays


class HistoryRange(NamedTuple):
    """Results of some histories."""

    first: int
    last: int  # not included
    results: Arrays  # the keys of `fast_engine.RESULTS`


def pieces(folder: Path, plan: Plan) -> Iterator[HistoryRange]:
    """Return the results of a finished campaign in the order of the histories, one chunk in memory at a time."""
    seals = {chunk.number: seal for chunk, seal in _records(folder, plan) if not chunk.of}
    if len(seals) < plan.chunks:
        raise CampaignIncompleteError(f"{folder}: {len(seals)} of {plan.chunks} chunks are finished; run the campaign")
    for number in range(plan.chunks):
        chunk = plan.chunk(number)
        yield HistoryRange(chunk.first, chunk.last, _read(folder, chunk, seals[number]))


def digest(ranges: Iterator[HistoryRange]) -> str:
    """Return the SHA-256 of results, names and types; it does not depend on how they are cut."""
    columns = {name: hashlib.sha256() for name in RESULTS}
    for piece in ranges:
        for name, values in piece.results.items():
            columns[name].update(np.ascontiguousarray(values, values.dtype.newbyteorder("<")).tobytes())
    text = "".join(f"{name} {np.dtype(RESULTS[name]).name} {each.hexdigest()}\n" for name, each in columns.items())
    return hashlib.sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class Verification:
    """The state of a campaign's results, each of which was read."""

    histories: int
    verified: int  # histories whose results are there, to the last bit as they were written
    chunks: int  # whole chunks among the latter
    # a sentence for each shard that the ledger has and that is changed, cut short, of other histories, or missing; one
    # for a ledger that cannot be read, without which nothing counts
    damaged: tuple[str, ...]
    missing: tuple[tuple[int, int], ...]  # histories that are not there: first, last (not included)

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
        # a chunk's piece that is all of it is the chunk
        every = (*ledger.records(), *ledger.pieces())
        return [(plan.chunk(each.number).piece(each.first, each.last), each.seal) for each in every]


def _read(folder: Path, chunk: Chunk, sealed: str) -> Arrays:
    path = path_of(folder / SHARDS, chunk)
    advice = "run the campaign again: it is computed anew"
    try:
        return shard.unpack(path.read_bytes(), chunk, sealed)
    except FileNotFoundError as error:
        raise CampaignDamagedError(f"{path} is missing; {advice}") from error
    except CampaignDamagedError as error:
        raise CampaignDamagedError(f"{path}: {error}; {advice}") from error
