"""Results of a campaign as its study knows them, piece by piece."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.campaigns import Campaign
from rocking.campaigns.jobs.study import Coordinate, Study
from rocking.dynamics.engine import Arrays

PIECE = 1 << 16
"""Histories that are in memory at once when a file is written."""


@dataclass(frozen=True)
class Results:
    """Results of a finished campaign."""

    study: Study  # what they are over
    campaign: Campaign  # where they are
    provenance: dict[str, Any]  # where they come from
    progress: Callable[[int], None] | None = None  # called with the number of histories done since the last call

    @property
    def attributes(self) -> dict[str, Any]:
        """Where they come from, as attributes of a file."""
        from rocking.campaigns.jobs.netcdf import attributes_of

        return attributes_of(self.provenance, self.study.attributes)

    def pieces(self) -> Iterator[tuple[int, int, Arrays]]:
        """Return the results in the order of the histories.

        Returns first history, last one (not included), and what is known of them: the keys of `HISTORY`.
        """
        for piece in self.campaign.pieces():
            for first in range(piece.first, piece.last, PIECE):
                last = min(first + PIECE, piece.last)
                part = {name: v[first - piece.first : last - piece.first] for name, v in piece.results.items()}
                yield first, last, self.study.derived(first, last, part)
                if self.progress is not None:
                    self.progress(last - first)

    def coordinates(self, first: int, last: int) -> Iterator[tuple[str, Coordinate, np.ndarray]]:
        """Return what is known of where some histories are, for tables with a row a history.

        Returns Name, coordinate, and the place of each history in its flat values.
        """
        places = self.study.places(first, last)
        for name, coordinate in self.study.coordinates.items():
            index = tuple(places[dim] for dim in coordinate.dims)
            yield name, coordinate, np.ravel_multi_index(index, coordinate.values.shape)
