"""Multiple stripes: every motion is scaled to every level of the measure, and states are counted."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.studies.fragility.subject import FragilityAnalysis

if TYPE_CHECKING:
    import xarray as xr

DEFINITION = (
    "stripes: the probability of a state at a level is the fraction of the motions, each multiplied by its own factor "
    "to that level, that reach the state or a worse one there"
)


@dataclass(frozen=True, eq=False, repr=False)
class MultipleStripeAnalysis(FragilityAnalysis):
    """Result of a multiple stripe analysis. States and rotations have the shape (motions, levels)."""

    levels: FloatArray  # levels of the measure [unit of the measure]

    kind = "multiple stripes"
    definition = DEFINITION

    @property
    def history_levels(self) -> FloatArray:
        return np.broadcast_to(self.levels, self.responses.outcome.shape)

    @property
    def trials(self) -> IntArray:
        """Number of motions at each level whose history could be computed."""
        return np.asarray(self.responses.good.sum(axis=0, dtype=np.int64))

    @cached_property
    def counts(self) -> dict[str, IntArray]:
        """Number of motions that reach each state, by name of the state, at each level."""
        return {s.name: np.sum(self.responses.exceed(s) == 1.0, axis=0, dtype=np.int64) for s in self.limit_states}

    @cached_property
    def dataset(self) -> "xr.Dataset":
        """Dataset of outcomes, counts and factors with units, over motion and level."""
        both = ("motion", "level")
        names = [state.name for state in self.limit_states]
        data: dict[str, Any] = {
            **self.responses.labelled(both),
            "scale": (
                both,
                np.asarray(self.histories.scales),
                {"units": "1", "long_name": "scale factor of the motion"},
            ),
            "exceeded": (("state", "level"), np.array([self.counts[name] for name in names]), {"units": "1"}),
            "trials": ("level", self.trials, {"units": "1"}),
        }
        return self._labelled(data, {"level": ("level", self.levels, self.subject.label), "state": names}, DEFINITION)
