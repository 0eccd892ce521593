"""How fast a study is, from looks at what is finished."""

import time
from collections import deque

_WINDOW = 6.0
_LEAST = 0.15


class Pace:
    """How fast histories are finished, over the last seconds.

    Examples
    --------
    >>> pace = Pace()
    >>> pace.look(0, now=10.0), pace.look(100, now=12.0)
    (0.0, 50.0)
    """

    def __init__(self) -> None:
        self._looks: deque[tuple[float, int]] = deque()

    def look(self, done: int, now: float | None = None) -> float:
        """Note how many histories are finished, and return how fast they are.

        Parameters
        ----------
        done : int
            Finished histories [-].
        now : float, optional
            Instant of a clock that never goes back; this one, if not given [s].

        Returns
        -------
        float
            Histories a second; 0 while nothing is known [1/s].
        """
        instant = time.monotonic() if now is None else now
        # a study finishes in jumps, a chunk at a time: only looks that found more say anything
        if not self._looks or done > self._looks[-1][1]:
            self._looks.append((instant, done))
        while len(self._looks) > 2 and instant - self._looks[0][0] > _WINDOW:
            self._looks.popleft()
        (first, before), (_, after) = self._looks[0], self._looks[-1]
        spent = max(self._looks[-1][0] - first, instant - first - _WINDOW)
        return (after - before) / spent if spent > _LEAST else 0.0
