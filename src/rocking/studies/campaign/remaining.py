"""What remains to be done of a campaign, handed out in pieces that suit those who share it."""

import time
from collections.abc import Callable, Iterator

import numpy as np

from rocking.studies.campaign.chunks import Chunk, Plan
from rocking.studies.campaign.estimate import Costs
from rocking.studies.campaign.pace import PIECE

_SURVEY_AFTER = 3.0
_SURVEY = 0.25
_LEAST = 0.2


class Remaining(Iterator[Chunk]):
    """Chunks, and pieces of chunks, that nobody has computed yet; each is handed out once, unless it is put back.

    After a few seconds a piece in the middle of every part of the campaign goes before the others, so that what will
    come is known soon.

    Parameters
    ----------
    plan : Plan
        How the campaign is cut.
    order : ndarray of int
        Numbers of the chunks that are not finished, in the order in which they are to be computed.
    pieces : dict of int to list of Chunk
        Pieces of them that are finished.
    together : int
        Histories of one motion that stand in a row: pieces end between motions, where they can.
    least : int
        How many histories several workers take at first, while nothing is known of their cost, and more remain.
    costs : Costs
        What was measured so far.
    sharers : callable
        Returns how many workers there are.
    stop : callable
        Whether to hand out nothing more.
    """

    def __init__(
        self, plan: Plan, order: np.ndarray, pieces: dict[int, list[Chunk]], together: int, least: int,
        costs: Costs, sharers: Callable[[], int], stop: Callable[[], bool],
    ) -> None:  # fmt: skip
        self._plan, self._together, self._costs = plan, together, costs
        self._sharers, self._stop, self._least = sharers, stop, least
        self._fresh, self._wanted = iter(order.tolist()), set(order.tolist())
        self._gaps = {number: _gaps(plan.chunk(number), done) for number, done in pieces.items()}
        self._opened, self._surveyed = set(self._gaps), set[int]()
        chunks = [plan.chunk(number) for number in self._wanted]
        self._left = sum(each.last - each.first for each in chunks)
        self._left -= sum(each.last - each.first for done in pieces.values() for each in done)
        self._out: dict[int, Chunk] = {}
        self._begun = self._spent = 0.0
        self._done = 0

    def __next__(self) -> Chunk:
        """Return the next piece; the next call may find one that was put back, also after there was none."""
        found = None if self._stop() else self._middle() or self._front()
        if found is None:
            raise StopIteration
        self._out[found.first] = found
        self._left -= found.last - found.first
        return found

    def back(self, done: Chunk, seconds: float) -> None:
        """Take note of what was computed, and put the rest of its piece back.

        Parameters
        ----------
        done : Chunk
            What is finished.
        seconds : float
            What it took [s].
        """
        asked = self._out.pop(done.first, done)
        if asked.last > done.last:
            self._gaps[done.number] = _joined([asked.piece(done.last, asked.last), *self._gaps.get(done.number, [])])
            self._left += asked.last - done.last
        self._begun = self._begun or time.monotonic() - seconds
        self._spent, self._done = self._spent + seconds, self._done + done.last - done.first

    def _front(self) -> Chunk | None:
        """Return the next piece: of chunks that were begun first."""
        if not self._gaps:
            self._open(next((number for number in self._fresh if number not in self._opened), -1))
        for number, gaps in self._gaps.items():
            return self._cut(number, 0, gaps[0].first, self._share())
        return None

    def _middle(self) -> Chunk | None:
        """Return a piece from the middle of a part that was not measured yet, where it is time for that."""
        if not self._begun or time.monotonic() - self._begun < _SURVEY_AFTER:
            return None
        for part in set(self._costs.unseen().tolist()) - self._surveyed:
            self._surveyed.add(part)
            low, high = self._costs.edges[part : part + 2].tolist()
            middle = (low + high) // 2
            middle -= middle % (self._plan.size if high - low >= 2 * self._plan.size else self._together)
            number = middle // self._plan.size
            self._open(number if number in self._wanted else -1)
            for place, gap in enumerate(self._gaps.get(number, [])):
                if middle < gap.last:
                    return self._cut(number, place, max(middle, gap.first), self._worth(_SURVEY))
        return None

    def _open(self, number: int) -> None:
        if number >= 0 and number not in self._opened:
            self._opened.add(number)
            self._gaps[number] = [self._plan.chunk(number)]

    def _share(self) -> int:
        """Return how many histories to hand out at once: with several workers never so many that one has to wait."""
        sharers = self._sharers()
        return self._left if sharers == 1 else max(self._worth(_LEAST), -(-self._left // (2 * sharers)))

    def _worth(self, seconds: float) -> int:
        """Return how many histories take some time, as far as that is known."""
        return max(1, int(seconds * self._done / self._spent)) if self._spent > 0.0 else self._least

    def _cut(self, number: int, place: int, first: int, wanted: int) -> Chunk:
        """Take some histories out of a gap; what is left of it on either side stays."""
        gaps = self._gaps[number]
        gap = gaps.pop(place)
        last = min(first + wanted, gap.last)
        between = last - last % self._together
        if between <= first and self._together <= self._worth(PIECE):  # a motion that is no more than a piece stays one
            between += self._together
        last = between if first < between < gap.last else last
        last = gap.last if gap.last - last < (last - first) // 2 else last  # no crumbs
        sides = ((gap.first, first), (last, gap.last))
        gaps[place:place] = [gap.piece(*side) for side in sides if side[0] < side[1]]
        if not gaps:
            del self._gaps[number]
        return gap.piece(first, last)


def _gaps(chunk: Chunk, pieces: list[Chunk]) -> list[Chunk]:
    """Return what of a chunk is in none of its pieces."""
    found, first = [], chunk.first
    for begin, end in [*(each[1:3] for each in pieces), (chunk.last, chunk.last)]:
        if first < begin:
            found.append(chunk.piece(first, begin))
        first = end
    return found


def _joined(gaps: list[Chunk]) -> list[Chunk]:
    """Return gaps in order, those without anything between them as one."""
    found: list[Chunk] = []
    for gap in sorted(gaps):
        if found and found[-1].last == gap.first:
            found[-1] = gap.piece(found[-1].first, gap.last)
        else:
            found.append(gap)
    return found
