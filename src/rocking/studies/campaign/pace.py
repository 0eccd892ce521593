"""How many histories are computed at a time, and when a piece is long enough to be kept."""

import time

from rocking.studies.campaign.chunks import DEFAULT_CHUNK
from rocking.studies.campaign.fingerprint import kind_of

PIECE = 1.0
"""Time after which what is computed is kept [s]: a kill costs no more, a count moves as often."""

_ASK = 0.3
_FIRST = {"fast": 64, "reference": 4}
_FASTER = 4
_REST = 0.5


class Pace:
    """How many histories at a time take as long as nobody minds to wait, learned from one step to the next."""

    def __init__(self, engine: str, together: int = 1, made: bool = False) -> None:
        self.least = _FIRST[kind_of(engine)]
        self.step = min(self.least, together) if made else self.least
        self.together = together
        self._first: tuple[int, float] | None = None
        self._startup = 0.0
        self.begun = False

    def until(self, first: int, last: int) -> int:
        """Return where to stop: after equal steps, since short ones leave lanes idle."""
        left = last - first
        end = first + -(-left // -(-left // self.step))
        between = end - end % self.together
        return between if end < last and between > first else end

    def took(self, count: int, seconds: float) -> None:
        """Learn from a step.

        seconds: what they took [s].
        """
        if self._first is None:
            self._first = count, seconds
        elif not self.begun:
            self.begun, self._startup = True, max(0.0, self._first[1] - self._first[0] * seconds / count)
        wanted = int(count * _ASK / max(seconds, 1e-6))
        if wanted < self.step or 2 * count >= self.step:  # the end of a piece says nothing about longer steps
            self.step = max(1, min(wanted, _FASTER * self.step, DEFAULT_CHUNK))

    def settled(self, seconds: float) -> float:
        """Return what a piece took without what its first step took beyond its histories: code, motions laid out.

        seconds: what it took [s]. Returns the rest; all of it where the first step was in an earlier piece [s].
        """
        found, self._startup = self._startup, 0.0
        return seconds - found if found < seconds else seconds


class Watch:
    """Says when a piece is long enough: after a second, unless the rest takes less than half of one."""

    def __init__(self) -> None:
        self._start = time.perf_counter()

    def over(self, done: int, left: int) -> bool:
        """Return whether to keep what is done, and leave the rest to whoever is free.

        Returns false as long as nothing is done.
        """
        spent = time.perf_counter() - self._start
        return spent > PIECE and done > 0 and left * spent > _REST * PIECE * done
