"""A study as a campaign sees it: histories, what they are over, and what is read off their results."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking.campaigns.jobs.adaptive import Search
from rocking.campaigns.reading import HistoryRange
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays
from rocking.errors import InvalidValueError
from rocking.outcome import flags
from rocking.quantities import HISTORY
from rocking.studies.histories import Histories
from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.studies.question import modes_of, peak_ratio
from rocking.tables import PIECE, Column, text_array

TYPES: dict[str, Any] = {
    name: np.float64 if name in {"overturned", "still_rocking", "lost_contact"} else RESULTS.get(name, np.float64)
    for name in HISTORY
} | {"mode": np.int64}
"""Type of what is known of every history."""


@dataclass(frozen=True)
class Study:
    """Histories over dimensions."""

    histories: Histories  # what is computed, of an adaptive study first; the last dimension changes fastest
    dims: dict[str, int]  # length of every dimension, in order
    coordinates: dict[str, Column]  # what is known along the dimensions: columns with `dims`
    attributes: dict[str, Any] = field(default_factory=dict)  # what the study is, as plain values
    exports: tuple[str, ...] = ("histories",)  # what can be written of it; the first unless something else is asked for
    # takes the results of all histories and returns the fragility analysis of each restitution by label
    finish: Callable[[Arrays], dict[str, Any]] | None = None
    # takes first and last number of histories and their results, and changes those whose unit is not yet the user's
    rescale: Callable[[int, int, Arrays], Arrays] | None = None
    # of an adaptive study: takes what computes a round of histories, and returns the result of all rounds
    search: Search | None = None
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
        own = results if self.rescale is None else self.rescale(first, last, dict(results))
        sides = self.histories.rows(first, last).values
        ratio = peak_ratio(own["peak_rotation"], sides["alpha_right"], sides["alpha_left"])
        whole = {**own, **flags(own), "mode": modes_of(own), "peak_ratio": ratio}
        return {name: whole[name] for name in HISTORY}


def pieces_of(
    study: Study, ranges: Iterable[HistoryRange], progress: Callable[[int], None] | None = None
) -> Iterator[tuple[int, int, Arrays]]:
    """Return first history, last one (not included) and the keys of `HISTORY`, a piece after another."""
    for each in ranges:
        for first in range(each.first, each.last, PIECE):
            last = min(first + PIECE, each.last)
            part = {name: values[first - each.first : last - each.first] for name, values in each.results.items()}
            yield first, last, study.derived(first, last, part)
            if progress is not None:
                progress(last - first)


def along(dim: str, values: Any, unit: str = "1", meaning: str = "") -> Column:
    """Return numbers along a dimension."""
    return Column(np.asarray(values), unit, meaning, dims=(dim,))


def labels_along(dim: str, values: Iterable[str], meaning: str) -> Column:
    """Return labels along a dimension."""
    return Column(text_array(list(values)), "1", meaning, dims=(dim,))


def motions_along(motions: MotionSet) -> Column:
    """Return what the motions are called: by name, or by number where each is made from a seed when it is needed."""
    if isinstance(motions, MotionList):
        return labels_along("motion", (motions[k].name for k in range(len(motions))), "name of the motion")
    return along("motion", np.arange(len(motions)), "1", "number of the motion in its set")
