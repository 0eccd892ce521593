"""A study as a campaign sees it: histories, what they are over, and what is read off their results."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking.campaigns.jobs.answer import AdaptiveResult
from rocking.campaigns.jobs.asked import Compute
from rocking.dynamics.loss_of_contact import flags
from rocking.dynamics.plane.fast_engine import RESULTS, Arrays
from rocking.errors import InvalidValueError
from rocking.quantities import HISTORY
from rocking.studies.histories import Histories
from rocking.studies.question import modes_of, peak_ratio
from rocking.tables import Column

TYPES: dict[str, Any] = {
    name: np.float64 if name in {"overturned", "still_rocking", "lost_contact"} else RESULTS.get(name, np.float64)
    for name in HISTORY
} | {"mode": np.int64}
"""Type of what is known of every history."""


@dataclass(frozen=True)
class Study:
    """Histories over dimensions."""

    histories: Histories  # what is computed; the last dimension changes fastest
    dims: dict[str, int]  # length of every dimension, in order
    coordinates: dict[str, Column]  # what is known along the dimensions: columns with `dims`
    attributes: dict[str, Any] = field(default_factory=dict)  # what the study is, as plain values
    # takes the results of all histories and returns the fragility analysis of each restitution by label
    finish: Callable[[Arrays], dict[str, Any]] | None = None
    # takes first and last number of histories and their results, and changes those whose unit is not yet the user's
    rescale: Callable[[int, int, Arrays], Arrays] | None = None
    # of an adaptive study: takes what computes a round of histories, asks for one round after another, and returns what
    # it has found. The histories of the study are then those of the first round
    search: Callable[[Compute], AdaptiveResult] | None = None
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
