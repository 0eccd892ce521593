"""How fast a study is, from looks at what is finished."""

import time
from collections import deque

from rocking.studies.campaign.estimate import Speed

_WINDOW = 6.0
_LEAST = 0.15


class Pace:
    """How fast histories are finished, over the last seconds, and how much work is done in a second.

    >>> pace = Pace()
    >>> pace.look(0, 0.0, now=10.0), pace.look(100, 1.5, now=11.0), pace.look(600, 11.5, now=16.0)
    ((0.0, 0.0), (100.0, 0.0), (100.0, 2.0))
    """

    def __init__(self) -> None:
        self._looks: deque[tuple[float, int]] = deque()
        self._speed, self._pace = Speed(), 0.0

    def look(self, done: int, work: float, now: float | None = None) -> tuple[float, float]:
        """Note how many histories are finished, and return how fast they are.

        done: finished histories [-]; work: what they have taken, of all workers together [s]; now: instant of a clock
        that never goes back; this one, if not given [s]. Returns rate: histories a second, over the last seconds; 0
        while nothing is known [1/s]; speed: work that was done in a second, since the first histories were finished; 0
        while nothing is known [-].
        """
        instant = time.monotonic() if now is None else now
        # a study finishes in jumps, a piece at a time: only looks that found more say anything
        if not self._looks or done > self._looks[-1][1]:
            if self._looks:
                self._pace = self._speed.look(work, instant)
            self._looks.append((instant, done))
        while len(self._looks) > 2 and instant - self._looks[0][0] > _WINDOW:
            self._looks.popleft()
        (first, before), (_, after) = self._looks[0], self._looks[-1]
        spent = max(self._looks[-1][0] - first, instant - first - _WINDOW)
        return (after - before) / spent if spent > _LEAST else 0.0, self._pace
