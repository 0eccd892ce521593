"""How long it will still take: what the histories of every part of a campaign have taken, and how many remain there."""

from dataclasses import dataclass
from typing import Any

import numpy as np

PARTS = 16
"""Equal parts of the histories, each of which is measured: costs change from the first history to the last one."""

_SETTLED = 4.0
NOISE = 0.1
"""A machine is no steadier than this from one minute to the next [-]."""


@dataclass(frozen=True)
class Estimate:
    """Time that is left.

    Parameters
    ----------
    seconds : float
        The best guess [s].
    low, high : float
        Between these it is likely to be [s].
    """

    seconds: float
    low: float
    high: float

    def at(self, speed: float) -> "Estimate":
        """Return the time of several workers for the work of one.

        Parameters
        ----------
        speed : float
            Seconds of work that are done in a second, by all of them together [-].

        Returns
        -------
        Estimate
            That many times less.
        """
        return Estimate(self.seconds / speed, self.low / speed, self.high / speed)


class Speed:
    """How much work is done in a second, since the first piece was finished.

    >>> speed = Speed()
    >>> speed.look(1.0, 10.0), speed.look(3.0, 11.0), speed.look(13.0, 16.0)
    (0.0, 0.0, 2.0)
    """

    def __init__(self) -> None:
        self._first: tuple[float, float] | None = None

    def look(self, work: float, now: float) -> float:
        """Note the work of all pieces that are finished, right after one was.

        work: of all workers together [s]; now: instant of a clock that never goes back [s]. Returns seconds of work in
        a second; 0 during the first seconds, when that says nothing [-].
        """
        self._first = self._first or (work, now)
        spent = now - self._first[1]
        return (work - self._first[0]) / spent if spent >= _SETTLED else 0.0


class Costs:
    """What histories have taken, in equal parts of all of them.

    >>> costs = Costs(32)
    >>> costs.add(0, 16, 8.0)
    >>> costs.left() is None, costs.unseen().tolist()
    (True, [8, 9, 10, 11, 12, 13, 14, 15])
    >>> costs.add(16, 31, 15.0)
    >>> costs.left().seconds
    1.0
    """

    def __init__(self, count: int) -> None:
        self.edges = np.unique(np.linspace(0, count, PARTS + 1).astype(np.int64))
        self._missing = np.diff(self.edges).astype(np.float64)
        self._seen, self._spent = np.zeros_like(self._missing), np.zeros_like(self._missing)

    def add(self, first: Any, last: Any, seconds: Any = 0.0) -> None:
        """Note histories that are finished.

        seconds: what they took; 0 where that is not known [s].
        """
        share = self._overlap(first, last)
        seconds = np.broadcast_to(np.atleast_1d(seconds), len(share))
        self._missing -= share.sum(axis=0)
        self._seen += share[seconds > 0.0].sum(axis=0)
        self._spent += (share / share.sum(axis=1, keepdims=True) * seconds[:, None]).sum(axis=0)

    def shares(self, first: Any, last: Any) -> np.ndarray:
        """Return how many histories of every part are among some."""
        return np.asarray(self._overlap(first, last).sum(axis=0))

    def _overlap(self, first: Any, last: Any) -> np.ndarray:
        first, last = (np.atleast_1d(np.asarray(each, np.int64))[:, None] for each in (first, last))
        return np.asarray(np.clip(np.minimum(self.edges[1:], last) - np.maximum(self.edges[:-1], first), 0, None))

    def unseen(self) -> np.ndarray:
        """Return the parts of which nothing was measured yet, and which are not finished."""
        return np.flatnonzero((self._missing > 0.0) & (self._seen == 0.0))

    def left(self) -> Estimate | None:
        """Return the time of one worker for what is missing.

        Returns none while a part that is not finished has not been measured.
        """
        if self.unseen().size:
            return None
        if not self._missing.any():
            return Estimate(0.0, 0.0, 0.0)
        numbers, known = np.arange(self._missing.size), self._seen > 0.0
        each = np.interp(numbers, numbers[known], self._spent[known] / self._seen[known])
        steps = np.abs(np.diff(each, prepend=each[0], append=each[-1]))
        # within a part the cost may be as far off its mean as halfway to its neighbours'
        doubt = np.sqrt(np.sum((self._missing * 0.5 * np.maximum(steps[:-1], steps[1:])) ** 2))
        best = float(np.sum(self._missing * each))
        wide = 2.0 * float(doubt) + NOISE * best
        return Estimate(best, max(0.0, best - wide), best + wide)
