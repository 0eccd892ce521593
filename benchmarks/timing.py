"""CPU time of two ways to do one thing, in turn, several times: medians and their ratio."""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Comparison:
    """Median CPU seconds per item of ours and of theirs, from interleaved repeats."""

    subject: str
    against: str
    ours: float
    theirs: float
    goal: float | None
    unit: str = "value"

    @property
    def ratio(self) -> float:
        """Ratio of the time of the peer to the time of this package."""
        return self.theirs / self.ours

    @property
    def met(self) -> bool:
        """Whether the goal is met."""
        return self.goal is None or self.ratio >= self.goal


def cpu_seconds(work: Callable[[], object]) -> float:
    """CPU seconds of one call."""
    start = time.process_time()
    work()
    return time.process_time() - start


def compare(
    subject: str,
    against: str,
    ours: Callable[[], object],
    theirs: Callable[[], object],
    *,
    goal: float | None,
    counts: tuple[int, int],
    repeats: int = 15,
) -> Comparison:
    """Time both alternately; `counts` is the number of items per call."""
    ours()
    pairs = [(cpu_seconds(ours) / counts[0], cpu_seconds(theirs) / counts[1]) for _ in range(repeats)]
    mine, other = (statistics.median(column) for column in zip(*pairs, strict=True))
    return Comparison(subject, against, mine, other, goal)
