"""Cloud analysis: regression of the rotation on the measure of recorded motions, and a curve of overturning."""

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.statistics.least_squares import Regression, regression
from rocking.statistics.lognormal import LognormalFit, fit_lognormal
from rocking.studies.fragility.subject import FragilityAnalysis, Responses

if TYPE_CHECKING:
    import xarray as xr

MIN_ROTATION = 0.01  # default limit of the rotation / alpha [-]; histories with smaller rotations are barely lifted

DEFINITION = (
    "cloud: overturning is fitted to the outcome of each motion at its own level. For histories without overturning "
    "and with rotations of at least min_rotation, ln(theta/alpha) is a linear function of the logarithm of the "
    "measure. A rotation is exceeded if the body overturns, or if its peak rotation is larger"
)


def checked_min_rotation(rotation: float) -> float:
    """Return the checked limit of the rotation / alpha [-] for barely lifted histories."""
    return checks.within("min_rotation", rotation, 0.0, 1.0, open_high=True, hint="a rotation / alpha")


def clearly_lifted(responses: Responses, min_rotation: float) -> BoolArray:
    """Return True for histories without overturning whose rotation / alpha reaches `min_rotation` [-]."""
    return np.asarray(responses.rocked & (responses.rotation >= min_rotation) & (responses.rotation > 0.0))


@dataclass(frozen=True, eq=False, repr=False)
class CloudAnalysis(FragilityAnalysis):
    """Result of a cloud analysis. States and rotations have one entry per motion."""

    motion_levels: FloatArray  # measures of the scaled motions [unit of the measure]
    min_rotation: float = MIN_ROTATION  # smallest rotation / alpha in the regression [-]

    kind = "cloud"
    definition = DEFINITION

    @property
    def history_levels(self) -> FloatArray:
        return self.motion_levels

    @cached_property
    def _sorted(self) -> tuple[FloatArray, IntArray]:
        return np.unique(self.motion_levels, return_inverse=True)

    @property
    def levels(self) -> FloatArray:
        """Levels of the motions [unit of the measure], increasing and unique."""
        return self._sorted[0]

    @property
    def trials(self) -> IntArray:
        """Number of motions with a computed history, at every level."""
        return self._counted(self.responses.good)

    @cached_property
    def counts(self) -> dict[str, IntArray]:
        """Number of motions that reach a state, by name of the state and at every level."""
        return {s.name: self._counted(self.responses.exceed(s) == 1.0) for s in self.limit_states}

    def _counted(self, selected: BoolArray) -> IntArray:
        return np.bincount(self._sorted[1][selected], minlength=self.levels.size).astype(np.int64)

    @cached_property
    def regression(self) -> Regression:
        """Regression of ln(theta/alpha) on ln of the measure, from clearly lifted histories without overturning."""
        levels, rotation = self.motion_levels[self.clear], self.responses.rotation[self.clear]
        return regression(np.log(levels), np.log(rotation))

    @property
    def barely_lifted(self) -> int:
        """Number of histories that rocked by less than `min_rotation`. The regression excludes these histories."""
        return int(np.sum(self.responses.rocked & ~self.clear))

    @cached_property
    def clear(self) -> BoolArray:
        """True for histories without overturning that rocked by `min_rotation` or more."""
        return clearly_lifted(self.responses, self.min_rotation)

    def clear_fraction(self, level: FloatArray) -> FloatArray:
        """Return the fraction of clearly lifted histories among those that rocked without overturning [-]."""
        # a lognormal curve if the outcomes determine a curve, otherwise the fraction over all levels
        rocked, fit = self.responses.rocked, self._clear_fit
        if fit is not None and fit.exists:
            return np.asarray(fit.probability(level))
        fraction = float(self.clear.sum() / rocked.sum()) if rocked.any() else 1.0
        return np.full(np.shape(level), fraction)

    @cached_property
    def _clear_fit(self) -> LognormalFit | None:
        rocked = self.responses.rocked
        with suppress(InvalidValueError):  # if all motions have one level, there is no curve, and the fraction is used
            if rocked.any() and 0 < self.clear.sum() < rocked.sum():
                return fit_lognormal(self.motion_levels[rocked], self.clear[rocked])
        return None

    def probability_of_rocking(self, level: Any) -> FloatArray:
        """Return the probability of rocking or overturning [-], from the uplift level (0 or 1) or from a fit."""
        levels = checks.positive_array("level", level, self.subject.measure.unit)
        threshold = self.subject.uplift_threshold
        if threshold is not None:
            return np.asarray(levels > threshold, dtype=np.float64)
        return np.asarray(self.fit_of("rocking").probability(levels), dtype=np.float64)

    def probability(self, level: Any, rotation: float) -> FloatArray:
        """Return the probability at levels that the rotation / alpha exceeds a value >= `min_rotation` [-]."""
        # P(overturned) + P(rocked, not overturned) P(rotation exceeded | rocked, not overturned)
        terms = self.parts(level, rotation)
        return terms["overturned"] + terms["exceeded"]  # Eq. 221

    def parts(self, level: Any, rotation: float) -> dict[str, FloatArray]:
        """Return the terms of the total probability at levels, for a rotation / alpha [-]. They add up to 1.

        The terms are ``no rocking``, ``below`` (rocked up to the rotation), ``exceeded`` (rocked beyond the rotation
        without overturning) and ``overturned``. A barely lifted body does not exceed `min_rotation`.
        """
        levels = checks.positive_array("level", level, self.subject.measure.unit)
        hint = "The regression does not include barely lifted histories. Reduce min_rotation."
        limit = math.log(
            checks.positive("rotation", checks.within("rotation", rotation, self.min_rotation, 1e6, hint=hint))
        )
        # an overturned body has rocked; if the curves cross, the probability of rocking is at least that of overturning
        rocks = self.probability_of_rocking(levels)
        over = np.minimum(np.asarray(self.fit_of("overturning").probability(levels), dtype=np.float64), rocks)
        beyond = self.regression.probability_above(limit, np.log(levels)) * self.clear_fraction(levels)
        return {
            "no rocking": 1.0 - rocks,
            "below": (rocks - over) * (1.0 - beyond),
            "exceeded": (rocks - over) * beyond,  # Eq. 221
            "overturned": over,
        }

    @cached_property
    def dataset(self) -> "xr.Dataset":
        """Dataset of all outcomes with units, over motion."""
        data = {**self.responses.labelled("motion"), "level": ("motion", self.motion_levels, self.subject.label)}
        return self._labelled(data, {}, DEFINITION)

    def _summary_of_kind(self) -> dict[str, Any]:
        try:
            line = self.regression.summary()
        except InvalidValueError as error:
            line = {"none": str(error)}
        return {
            "outcomes": {outcome.name.lower(): n for outcome, n in self.responses.counts().items()},
            "regression": line,
            "min_rotation": self.min_rotation,
            "barely lifted": self.barely_lifted,
        }
