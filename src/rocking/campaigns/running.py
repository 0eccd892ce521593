"""The run of a campaign: whole shards are taken over, what remains is handed out, computed, written, recorded."""

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
        return [f"{error.cause}; kept as {kept[0]}, and made anew from the shards"]


def now() -> str:
    """Return the time."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())


_LEAST, _FIRST, _MOST = 0.2, 0.25, 1.2
"""What a piece is to take at least, while parts were not measured yet, and at most, as far as that is known [s]."""

_LONG = 20.0  # a campaign that takes longer is measured everywhere at first, by small pieces [s]


class Remaining(Iterator[Chunk]):
    """Chunks and pieces that nobody has computed yet; each is handed out once, unless it is put back.

    They are taken from all parts of the campaign in turn: what was measured is like what will come.
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
            self._free -= costs.shares([each.first for each in done], [each.last for each in done])
        order = np.random.default_rng(seed).permutation if seed is not None else np.asarray
        self._rank = order(np.arange(len(self._free)))
        ends = zip(costs.edges[:-1], costs.edges[1:], strict=True)
        # the next chunk is the last of the list
        self._chunks = [
            order(numbers[(numbers * plan.size < high) & ((numbers + 1) * plan.size > low)])[::-1].tolist()
            for low, high in ends
        ]

    def __next__(self) -> Chunk:
        """Return the next piece; the next call may find one that was put back, also after there was none."""
        if self._stop() or not self._free.any():
            raise StopIteration
        done = np.where(self._free > 0, 1.0 - self._free / np.diff(self._costs.edges), np.inf)
        piece = self._next(int(np.lexsort((self._rank, done))[0]))
        self._out[piece.first] = piece
        self._free -= self._costs.shares(piece.first, piece.last)
        return piece

    def back(self, done: Chunk, seconds: float) -> None:
        """Take note of what was computed in some seconds, and put the rest of its piece back."""
        self._rate = (done.last - done.first) / max(seconds, 1e-9)
        whole = self._out.pop(done.first, done)
        if whole.last == done.last:
            return
        gaps: list[Chunk] = []  # in order, those without anything between them as one
        for gap in sorted([whole.piece(done.last, whole.last), *self._gaps.get(done.number, [])]):
            if gaps and gaps[-1].last == gap.first:
                gaps[-1] = gap.piece(gaps[-1].first, gap.last)
            else:
                gaps.append(gap)
        self._gaps[done.number] = gaps
        shares = self._costs.shares(done.last, whole.last)
        self._free += shares
        for part in np.flatnonzero(shares):
            self._chunks[part].append(done.number)

    def _next(self, part: int) -> Chunk:
        """Return a piece from the first gap of a part, which has one."""
        low, high = self._costs.edges[part : part + 2].tolist()
        wanted = self._share()
        while True:
            number = self._chunks[part][-1]
            if number in self._fresh:
                self._fresh.discard(number)
                self._gaps[number] = [self._plan.chunk(number)]
            for place, gap in enumerate(self._gaps.get(number, [])):
                if gap.last > low and gap.first < high:
                    whole = gap.last - gap.first <= wanted
                    first = gap.first if whole else max(gap.first, low - low % self._together)
                    return self._cut(number, place, first, wanted)
            self._chunks[part].pop()

    def _share(self) -> int:
        """Return how many histories to hand out at once: with several workers never so many that one has to wait."""
        left, sharers = int(self._free.sum()), self._sharers()
        small = self._costs.unseen().size and left > self._worth(_LONG)
        most = self._worth(_FIRST if small else _MOST) if self._rate else left
        return most if sharers == 1 else max(self._worth(_LEAST), min(most, -(-left // (2 * sharers))))

    def _worth(self, seconds: float) -> int:
        """Return how many histories take some time, as far as that is known from the last piece."""
        return max(1, int(seconds * self._rate)) if self._rate else self._least

    def _cut(self, number: int, place: int, first: int, wanted: int) -> Chunk:
        """Take some histories out of a gap; what is left of it on either side stays."""
        gaps = self._gaps[number]
        gap = gaps.pop(place)
        last = min(first + wanted, gap.last)
        between = last - last % self._together
        if between <= first and self._together <= self._worth(PIECE):  # a motion that is no more than a piece stays one
            between += self._together
        last = min(between, gap.last) if between > first else last
        last = gap.last if gap.last - last < (last - first) // 2 else last  # no crumbs
        sides = ((gap.first, first), (last, gap.last))
        gaps[place:place] = [gap.piece(*side) for side in sides if side[0] < side[1]]
        return gap.piece(first, last)


def _gaps(chunk: Chunk, pieces: list[Chunk]) -> list[Chunk]:
    """Return what of a chunk is in none of its pieces."""
    gaps, first = [], chunk.first
    for begin, end in [*(each[1:3] for each in pieces), (chunk.last, chunk.last)]:
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
        with suppress(OSError):  # damaged pieces that were set aside stay
            (folder / PIECES).rmdir()
    return Summary(
        meter.chunks - before, before, earlier.adopted, (*anew, *earlier.set_aside), tuple(meter.retries), meter.seconds
    )


@dataclass
class _CampaignRun:
    """Records what is finished; pieces that are a whole chunk become its shard, the same file whatever they were."""

    job: WorkerTask
    plan: Plan
    ledger: Ledger
    meter: Meter
    earlier: EarlierRun

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
                    insort(self.earlier.pieces.setdefault(done.chunk.number, []), done.chunk)
                    whole = self.merge(done.chunk.number)
                self.meter.add(done.chunk, done.seconds, whole=whole)

    def merge_all(self) -> None:
        """Make chunks of what an earlier run left without coming to that."""
        for number in list(self.earlier.pieces):
            if self.merge(number):
                self.earlier.finished[number] = True
                self.meter.chunks += 1

    def merge(self, number: int) -> bool:
        """Make a chunk of its pieces, if all are there."""
        chunk, pieces = self.plan.chunk(number), self.earlier.pieces[number]
        if sum(each.last - each.first for each in pieces) < chunk.last - chunk.first:
            return False
        results = empty_results(chunk.last - chunk.first, self.job.histories.columns)
        for each in pieces:
            path = path_of(self.job.folder, each)
            try:
                arrays = shard.unpack(path.read_bytes(), each)
            except (FileNotFoundError, CampaignDamagedError) as error:
                hint = "run the campaign again: it is computed anew"
                raise CampaignDamagedError(str(error), hint=hint).at(str(path)) from error
            for name, values in arrays.items():
                results[name][each.first - chunk.first : each.last - chunk.first] = values
        records = [record for record in self.ledger.pieces() if record.number == number]
        seconds, attempts = sum(each.seconds for each in records), sum(each.attempts - 1 for each in records) + 1
        workers = ", ".join(sorted({each.worker for each in records}))
        done = self.job.keep(chunk, shard.pack(chunk, results), seconds, workers)
        self.ledger.record(_record(done._replace(attempts=attempts)))
        for each in self.earlier.pieces.pop(number):
            path_of(self.job.folder, each).unlink(missing_ok=True)
        return True


def _record(done: Done) -> LedgerEntry:
    return LedgerEntry(*done.chunk[:4], done.seal, done.size, done.attempts, done.seconds, done.worker, now())
