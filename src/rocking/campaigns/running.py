"""The run of a campaign: recovery of shards, distribution of the remaining histories, and their records."""

import os
import time
from bisect import insort
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rocking.campaigns import chunks as shard
from rocking.campaigns import disk
from rocking.campaigns.chunks import Chunk, Plan
from rocking.campaigns.disk import CampaignDamagedError, CampaignInterrupted, FolderLock
from rocking.campaigns.executors import PIECE, PIECES, SUFFIX, Done, Executor, Interruption, Pace, WorkerTask, path_of
from rocking.campaigns.identity import SHARDS, Identity
from rocking.campaigns.ledger import NAME, Ledger, LedgerEntry
from rocking.campaigns.status import Costs, Meter, Progress, Summary
from rocking.dynamics.plane.fast_engine import empty_results
from rocking.errors import InvalidValueError
from rocking.studies.histories import Histories


@dataclass
class EarlierRun:
    """Shards and records of an earlier run."""

    folder: Path  # folder of the shards
    plan: Plan
    ledger: Ledger
    adopted: int = 0  # number of adopted shards: the run ended after writing and before recording them
    # sentences about damaged and missing shards
    set_aside: list[str] = field(default_factory=list)
    # sorted pieces of unfinished chunks, by chunk number
    pieces: dict[int, list[Chunk]] = field(default_factory=dict)
    finished: np.ndarray = field(init=False)  # True for finished chunks

    def __post_init__(self) -> None:
        """Mark all chunks as unfinished."""
        self.finished = np.zeros(self.plan.chunks, bool)

    def recover(self, stop: Callable[[], bool] = lambda: False) -> "EarlierRun":
        """Check all shards, remove the records of damaged shards, and adopt unrecorded shards."""
        for path in (self.folder, self.folder.with_name(PIECES)):
            disk.remove_unfinished(path)
        is_recorded = np.zeros(self.plan.chunks, bool)
        for record in self.ledger.records():
            if stop():
                return self
            is_recorded[record.number] = True
            self.finished[record.number] = self._intact(self.plan.chunk(record.number), record.seal) is not None
        names = {entry.name for entry in os.scandir(self.folder)}
        for number in np.flatnonzero(~is_recorded):
            if stop() or not names:
                break
            chunk = self.plan.chunk(int(number))
            if chunk.name + SUFFIX in names:
                self.finished[number] = self._adopt(chunk)
        self._recover_pieces(stop)
        return self

    def _recover_pieces(self, stop: Callable[[], bool]) -> None:
        """Check the pieces of unfinished chunks, adopt unrecorded pieces, and remove all other pieces."""
        recorded: set[str] = set()
        for record in list(self.ledger.pieces()):
            if stop():
                return
            piece = self.plan.chunk(record.number).piece(record.first, record.last)
            if self.finished[record.number]:
                self.ledger.forget(piece.name)  # the chunk of this piece is complete
            elif self._intact(piece, record.seal) is not None:
                self.pieces.setdefault(record.number, []).append(piece)
                recorded.add(piece.name + SUFFIX)
        for path in sorted(self.folder.with_name(PIECES).glob(f"*{SUFFIX}")):
            if stop():
                return
            if path.name not in recorded and not self._adopt_piece(path):
                path.unlink(missing_ok=True)  # a damaged file already has another name
        for pieces in self.pieces.values():
            pieces.sort()

    def _adopt_piece(self, path: Path) -> bool:
        """Record a valid piece, unless its histories are recorded."""
        try:
            first, last = shard.range_of(path.read_bytes())
            chunk = self.plan.chunk(first // self.plan.size)
            piece = chunk.piece(first, last)
        except (CampaignDamagedError, InvalidValueError):
            return False
        others = self.pieces.get(piece.number, [])
        if self.finished[piece.number] or not piece.parent or f"{piece.name}{SUFFIX}" != path.name or last > chunk.last:
            return False
        if any(first < other.last and other.first < last for other in others) or not self._adopt(piece):
            return False
        self.pieces[piece.number] = sorted([*others, piece])
        return True

    def _adopt(self, chunk: Chunk) -> bool:
        """Record a valid shard."""
        data = self._intact(chunk)
        if data is None:
            return False
        disk.sync_folder(path_of(self.folder, chunk).parent)  # necessary if the run was killed after renaming
        record = LedgerEntry(*chunk[:4], shard.seal(data), len(data), 1, 0.0, "an earlier run", now())
        (self.ledger.record_piece if chunk.parent else self.ledger.record)(record)
        self.adopted += 1
        return True

    def _intact(self, chunk: Chunk, sealed: str | None = None) -> bytes | None:
        """Return a valid shard, or None. A damaged shard is renamed, removed from the ledger and noted."""
        path = path_of(self.folder, chunk)
        try:
            data = path.read_bytes()
            shard.unpack(data, chunk, sealed)
            return data
        except FileNotFoundError:
            reason = f"{path.name} is missing; it is computed again"
        except CampaignDamagedError as error:
            reason = f"{path.name}: {error}; kept as {disk.set_aside(path).name}, and computed again"
        self.ledger.forget(chunk.name)
        self.ledger.note("damaged", chunk.number, reason)
        self.set_aside.append(reason)
        return None


def set_aside_if_damaged(folder: Path, plan: Plan) -> list[str]:
    """Rename a damaged ledger. A new ledger adopts the shards, because each shard contains its own seal."""
    try:
        with disk.guarded(folder), Ledger(folder, writable=True) as ledger:
            ledger.check(plan)
        return []
    except CampaignDamagedError as error:
        paths = sorted(path for path in folder.glob(f"{NAME}*") if ".damaged-" not in path.name)
        copies = [disk.set_aside(path).name for path in paths]
        return [f"{error.cause}; kept as {copies[0]}, and rebuilt from the shards"]


def now() -> str:
    """Return the UTC time."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())


_LEAST, _FIRST, _MOST = 0.2, 0.25, 1.2
"""Time of a piece: smallest, before all segments have a measured cost, and largest [s]."""

_LONG = 20.0  # a campaign longer than this time begins with small pieces in all segments [s]


class Remaining(Iterator[Chunk]):
    """Remaining chunks and pieces. Each is returned once, unless its remaining histories are put back.

    They come from all segments of the campaign in turn, so that the measured cost represents the remaining cost.
    """

    def __init__(
        self, plan: Plan, numbers: np.ndarray, pieces: dict[int, list[Chunk]], together: int, costs: Costs, *,
        sharers: Callable[[], int], stop: Callable[[], bool] = lambda: False, seed: int | None = None,
    ) -> None:  # fmt: skip
        self._plan, self._together, self._costs = plan, together, costs
        self._least = Pace(plan.engine).step
        self._sharers, self._stop, self._rate = sharers, stop, 0.0
        self._out: dict[int, Chunk] = {}
        self._gaps = {number: _gaps(plan.chunk(number), done) for number, done in pieces.items()}
        self._fresh = set(numbers.tolist()) - set(self._gaps)
        self._free = costs.shares(numbers * plan.size, np.minimum((numbers + 1) * plan.size, plan.count))
        for done in pieces.values():
            self._free -= costs.shares([piece.first for piece in done], [piece.last for piece in done])
        order = np.random.default_rng(seed).permutation if seed is not None else np.asarray
        self._rank = order(np.arange(len(self._free)))
        ends = zip(costs.edges[:-1], costs.edges[1:], strict=True)
        # the last chunk of the list is returned first
        self._chunks = [
            order(numbers[(numbers * plan.size < high) & ((numbers + 1) * plan.size > low)])[::-1].tolist()
            for low, high in ends
        ]

    def __next__(self) -> Chunk:
        """Return the next piece. After the end, a later call can return a piece that was put back."""
        if self._stop() or not self._free.any():
            raise StopIteration
        done = np.where(self._free > 0, 1.0 - self._free / np.diff(self._costs.edges), np.inf)
        piece = self._next(int(np.lexsort((self._rank, done))[0]))
        self._out[piece.first] = piece
        self._free -= self._costs.shares(piece.first, piece.last)
        return piece

    def back(self, done: Chunk, seconds: float) -> None:
        """Record the computed histories and their time [s], and put back the remaining histories of their piece."""
        self._rate = (done.last - done.first) / max(seconds, 1e-9)
        piece = self._out.pop(done.first, done)
        if piece.last == done.last:
            return
        gaps: list[Chunk] = []  # sorted gaps; adjacent gaps are joined
        for gap in sorted([piece.piece(done.last, piece.last), *self._gaps.get(done.number, [])]):
            if gaps and gaps[-1].last == gap.first:
                gaps[-1] = gap.piece(gaps[-1].first, gap.last)
            else:
                gaps.append(gap)
        self._gaps[done.number] = gaps
        shares = self._costs.shares(done.last, piece.last)
        self._free += shares
        for segment in np.flatnonzero(shares):
            self._chunks[segment].append(done.number)

    def _next(self, segment: int) -> Chunk:
        """Return a piece from the first gap of a segment."""
        low, high = self._costs.edges[segment : segment + 2].tolist()
        count = self._share()
        while True:
            number = self._chunks[segment][-1]
            if number in self._fresh:
                self._fresh.discard(number)
                self._gaps[number] = [self._plan.chunk(number)]
            for position, gap in enumerate(self._gaps.get(number, [])):
                if gap.last > low and gap.first < high:
                    is_short = gap.last - gap.first <= count
                    first = gap.first if is_short else max(gap.first, low - low % self._together)
                    return self._cut(number, position, first, count)
            self._chunks[segment].pop()

    def _share(self) -> int:
        """Return the number of histories of the next piece, so that several workers finish at similar times."""
        left, sharers = int(self._free.sum()), self._sharers()
        small = self._costs.unseen().size and left > self._worth(_LONG)
        most = self._worth(_FIRST if small else _MOST) if self._rate else left
        return most if sharers == 1 else max(self._worth(_LEAST), min(most, -(-left // (2 * sharers))))

    def _worth(self, seconds: float) -> int:
        """Return the number of histories for a time [s], at the rate of the last piece."""
        return max(1, int(seconds * self._rate)) if self._rate else self._least

    def _cut(self, number: int, position: int, first: int, count: int) -> Chunk:
        """Remove histories from a gap, and keep the remaining gaps on both sides."""
        gaps = self._gaps[number]
        gap = gaps.pop(position)
        last = min(first + count, gap.last)
        between = last - last % self._together
        if between <= first and self._together <= self._worth(PIECE):  # keep a short motion in one piece
            between += self._together
        last = min(between, gap.last) if between > first else last
        last = gap.last if gap.last - last < (last - first) // 2 else last  # avoid a small remaining gap
        sides = ((gap.first, first), (last, gap.last))
        gaps[position:position] = [gap.piece(*side) for side in sides if side[0] < side[1]]
        return gap.piece(first, last)


def _gaps(chunk: Chunk, pieces: list[Chunk]) -> list[Chunk]:
    """Return the parts of a chunk outside its pieces."""
    gaps, first = [], chunk.first
    for begin, end in [*(piece[1:3] for piece in pieces), (chunk.last, chunk.last)]:
        if first < begin:
            gaps.append(chunk.piece(first, begin))
        first = end
    return gaps


def run(
    folder: Path,
    identity: Identity,
    histories: Histories,
    executor: Executor,
    order_seed: int | None,
    progress: Callable[[Progress], object] | None,
) -> Summary:
    """Compute the missing results of a campaign."""
    meter = Meter(folder, identity.plan, progress)
    with disk.guarded(folder, meter.sentence, meter.raised), FolderLock(folder), Interruption() as interruption:
        for name in (SHARDS, PIECES):
            disk.make_folder(folder / name)
        disk.remove_unfinished(folder)
        rebuilt = set_aside_if_damaged(folder, identity.plan)
        with Ledger(folder, writable=True) as ledger:
            for sentence in rebuilt:
                ledger.note("damaged", None, sentence)
            earlier = EarlierRun(folder / SHARDS, identity.plan, ledger).recover(interruption.requested)
            before = ledger.finished()[0]
            meter.begin(before, ((record.first, record.last) for record in (*ledger.records(), *ledger.pieces())))
            job = WorkerTask(histories, identity.plan.engine, identity.plan.software, folder / SHARDS)
            run = _CampaignRun(job, identity.plan, ledger, meter, earlier)
            run.merge_all()
            remaining = Remaining(
                identity.plan, np.flatnonzero(~earlier.finished), earlier.pieces, histories.together, meter.costs,
                sharers=lambda: executor.at_once, stop=interruption.requested, seed=order_seed,
            )  # fmt: skip
            run.compute(executor, remaining, interruption.requested)
        if interruption.requested():
            raise CampaignInterrupted(f"stopped: {meter.sentence()} in {folder}; run the campaign again to go on")
        with suppress(OSError):  # a folder with damaged pieces remains
            (folder / PIECES).rmdir()
    return Summary(
        meter.chunks - before,
        before,
        earlier.adopted,
        (*rebuilt, *earlier.set_aside),
        tuple(meter.retries),
        meter.seconds,
    )


@dataclass
class _CampaignRun:
    """Records finished chunks; the pieces of a complete chunk become its shard, with the same bytes."""

    job: WorkerTask
    plan: Plan
    ledger: Ledger
    meter: Meter
    earlier: EarlierRun

    def compute(self, executor: Executor, remaining: Remaining, stop: Callable[[], bool]) -> None:
        def retried(chunk: Chunk, reason: str) -> None:
            self.meter.retries.append(reason)
            self.ledger.note("retried", chunk.number, reason)

        with closing(executor.run(self.job, remaining, stop, retried)) as finished:  # type: ignore[type-var]
            for done in finished:
                is_chunk = not done.chunk.parent
                (self.ledger.record if is_chunk else self.ledger.record_piece)(_record(done))
                remaining.back(done.chunk, done.seconds)
                if not is_chunk:
                    insort(self.earlier.pieces.setdefault(done.chunk.number, []), done.chunk)
                    is_chunk = self.merge(done.chunk.number)
                self.meter.add(done.chunk, done.seconds, is_chunk=is_chunk)

    def merge_all(self) -> None:
        """Merge the complete chunks of an earlier run."""
        for number in list(self.earlier.pieces):
            if self.merge(number):
                self.earlier.finished[number] = True
                self.meter.chunks += 1

    def merge(self, number: int) -> bool:
        """Merge the pieces of a complete chunk."""
        chunk, pieces = self.plan.chunk(number), self.earlier.pieces[number]
        if sum(piece.last - piece.first for piece in pieces) < chunk.last - chunk.first:
            return False
        results = empty_results(chunk.last - chunk.first, self.job.histories.columns)
        for piece in pieces:
            path = path_of(self.job.folder, piece)
            try:
                arrays = shard.unpack(path.read_bytes(), piece)
            except (FileNotFoundError, CampaignDamagedError) as error:
                hint = "run the campaign again to compute it"
                raise CampaignDamagedError(str(error), hint=hint).at(str(path)) from error
            for name, values in arrays.items():
                results[name][piece.first - chunk.first : piece.last - chunk.first] = values
        records = [record for record in self.ledger.pieces() if record.number == number]
        seconds, attempts = (
            sum(record.seconds for record in records),
            sum(record.attempts - 1 for record in records) + 1,
        )
        workers = ", ".join(sorted({record.worker for record in records}))
        done = self.job.keep(chunk, shard.pack(chunk, results), seconds, workers)
        self.ledger.record(_record(done._replace(attempts=attempts)))
        for piece in self.earlier.pieces.pop(number):
            path_of(self.job.folder, piece).unlink(missing_ok=True)
        return True


def _record(done: Done) -> LedgerEntry:
    return LedgerEntry(*done.chunk[:4], done.seal, done.size, done.attempts, done.seconds, done.worker, now())
