"""A study as a campaign sees it: histories, what they are over, and what is read off their results."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking.campaigns.jobs.answer import Answer
from rocking.campaigns.jobs.asked import Compute
from rocking.dynamics.engine import RESULTS, Arrays
from rocking.dynamics.lost_contact import flags
from rocking.errors import InvalidValueError
from rocking.quantities import HISTORY
from rocking.studies.histories import Histories
from rocking.studies.question import modes_of, peak_ratio

TYPES: dict[str, Any] = {
    name: np.float64 if name in {"overturned", "still_rocking", "lost_contact"} else RESULTS.get(name, np.float64)
    for name in HISTORY
} | {"mode": np.int64}
"""Type of what is known of every history."""
Block = tuple[tuple[slice, ...], slice]


@dataclass(frozen=True)
class Coordinate:
    """Something that is known along one or more dimensions of a study."""

    dims: tuple[str, ...]  # the dimensions
    values: np.ndarray  # the values: numbers, or words
    unit: str = "1"  # unit, words: unit and meaning
    words: str = ""

    @property
    def is_words(self) -> bool:
        """Whether the values are words."""
        return self.values.dtype.kind not in "iufb"


@dataclass(frozen=True)
class Study:
    """Histories over dimensions."""

    histories: Histories  # what is computed; the last dimension changes fastest
    dims: dict[str, int]  # length of every dimension, in order
    coordinates: dict[str, Coordinate]  # what is known along the dimensions
    attributes: dict[str, Any] = field(default_factory=dict)  # what the study is, as plain values
    # takes the results of all histories and returns the fragility analysis of each restitution by label
    finish: Callable[[Arrays], dict[str, Any]] | None = None
    # takes first and last number of histories and their results, and changes those whose unit is not yet the user's
    rescale: Callable[[int, int, Arrays], Arrays] | None = None
    # of an adaptive study: takes what computes a round of histories, asks for one round after another, and returns what
    # it has found. The histories of the study are then those of the first round
    search: Callable[[Compute], Answer] | None = None
    # takes outcome and peak_rotation of all histories and returns the assessment of an inventory
    assess: Callable[[Arrays], Any] | None = None

    def __post_init__(self) -> None:
        """Check the dimensions."""
        if int(np.prod(self.shape, dtype=np.int64)) != self.histories.count:
            raise InvalidValueError(f"dimensions {self.dims} do not fit {self.histories.count} histories")

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of every dimension."""
        return tuple(self.dims.values())

    def derived(self, first: int, last: int, results: Arrays) -> Arrays:
        """Return the results of some histories as users know them, with what follows from them."""
        found = results if self.rescale is None else self.rescale(first, last, dict(results))
        sides = self.histories.rows(first, last).values
        ratio = peak_ratio(found["peak_rotation"], sides["alpha_right"], sides["alpha_left"])
        whole = {**found, **flags(found), "mode": modes_of(found), "peak_ratio": ratio}
        return {name: whole[name] for name in HISTORY}

    def places(self, first: int, last: int) -> dict[str, np.ndarray]:
        """Return where some histories are along every dimension."""
        found = np.unravel_index(np.arange(first, last, dtype=np.int64), self.shape)
        return dict(zip(self.dims, found, strict=True))


def blocks(first: int, last: int, shape: tuple[int, ...]) -> Iterator[Block]:
    """Return the rectangular blocks of an array that some of its entries, numbered row by row, fill.

    Returns where a block is in the array, and where its entries are among those from first to last.

    >>> for place, part in blocks(1, 8, (3, 3)):
    ...     print([(p.start, p.stop) for p in place], part.start, part.stop)
    [(0, 1), (1, 3)] 0 2
    [(1, 2), (0, 3)] 2 5
    [(2, 3), (0, 2)] 5 7
    """
    at = first
    while at < last:
        place = [int(i) for i in np.unravel_index(at, shape)]
        # the longest run that starts here: whole rows of the innermost dimensions, as far as they are at their start
        axis, width = len(shape) - 1, 1
        while axis > 0 and place[axis] == 0 and at + width * shape[axis] <= last:
            width *= shape[axis]
            axis -= 1
        run = max(1, min(shape[axis] - place[axis], (last - at) // width))
        where = [slice(i, i + 1) for i in place]
        where[axis] = slice(place[axis], place[axis] + run)
        where[axis + 1 :] = [slice(0, n) for n in shape[axis + 1 :]]
        yield tuple(where), slice(at - first, at - first + run * width)
        at += run * width
