"""Results of a campaign as its study knows them, piece by piece."""

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from rocking.campaigns import Campaign
from rocking.campaigns.jobs.study import TYPES, Study
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.tables import PIECE, Grid

_MAIN = ("software", "campaign", "kind", "engine", "histories_key")


@dataclass(frozen=True)
class Results:
    """Results of a finished campaign."""

    study: Study  # what they are over
    campaign: Campaign  # where they are
    provenance: dict[str, Any]  # where they come from
    progress: Callable[[int], None] | None = None  # called with the number of histories done since the last call

    @property
    def attributes(self) -> dict[str, Any]:
        """Where they come from, as attributes of a file: the main facts each by itself, and all of it as JSON."""
        main = {name: self.provenance[name] for name in _MAIN}
        plain = {k: int(v) if isinstance(v, bool) else v for k, v in self.study.attributes.items() if v is not None}
        return {**main, **plain, "provenance": json.dumps(self.provenance, sort_keys=True)}

    @property
    def grid(self) -> Grid:
        """The results as files take them."""
        study = self.study
        return Grid("histories", study.dims, study.coordinates, TYPES, self.pieces, self.attributes)

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
