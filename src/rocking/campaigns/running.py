"""The run of a campaign: what remains is handed out in pieces, computed, written, and only then recorded."""

from bisect import insort
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking.campaigns import chunks as shard
from rocking.campaigns import disk
from rocking.campaigns.chunks import Chunk, Plan
from rocking.campaigns.disk import CampaignDamagedError, CampaignInterrupted, FolderLock
from rocking.campaigns.executors import PIECE, PIECES, Done, Executor, Interruption, Pace, WorkerTask, path_of
from rocking.campaigns.identity import SHARDS, Identity
from rocking.campaigns.ledger import Ledger, LedgerEntry
from rocking.campaigns.recovery import EarlierRun, now, set_aside_if_damaged
from rocking.campaigns.status import Costs, Meter, Progress, Summary
from rocking.dynamics.plane.fast_engine import empty_results
from rocking.studies.histories import Histories

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
        results = empty_results(chunk.last - chunk.first)
        for each in pieces:
            path = path_of(self.job.folder, each)
            try:
                arrays = shard.unpack(path.read_bytes(), each)
            except (FileNotFoundError, CampaignDamagedError) as error:
                raise CampaignDamagedError(f"{path}: {error}; run the campaign again: it is computed anew") from error
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
