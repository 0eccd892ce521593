"""The outcome of a cloud analysis: the line, the curves, and the three parts of the probability."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError, extra
from rocking.studies.fragility.barely_lifted import LEAST, ClearShare, barely_lifted, clearly_lifted
from rocking.studies.fragility.fits import fits_of
from rocking.studies.fragility.regression import Regression, regression
from rocking.studies.fragility.states import LimitState, Responses
from rocking.studies.fragility.subject import Subject
from rocking.studies.fragility.uplift import UpliftCheck, uplift_check
from rocking.studies.histories import Product

if TYPE_CHECKING:
    import xarray as xr

    from rocking.studies.fragility.lognormal import LognormalFit

DEFINITION = (
    "cloud: overturning is fitted to the outcome of each motion at its own level; among histories that rocked, not "
    "barely, and stayed standing, ln(theta/alpha) is a straight line in the ln of the measure; a rotation is exceeded "
    "by what overturned, and by what rocked beyond it"
)


@dataclass(frozen=True, eq=False)
class CloudAnalysis:
    """The outcome of a cloud analysis.

    Parameters
    ----------
    subject : Subject
        The body, the motions and the measure.
    motion_levels : ndarray
        Measure of each motion, with the factor [its unit].
    states : tuple of LimitState
        From rocking to overturned.
    histories : Product
        What was computed: one history a motion.
    responses : Responses
        States and rotations, one entry a motion.
    least : float
        Rotation over alpha below which a history counts as barely lifted, and is left out of the line [-].
    """

    subject: Subject
    motion_levels: FloatArray
    states: tuple[LimitState, ...]
    histories: Product
    responses: Responses
    least: float = LEAST

    @property
    def definition(self) -> str:
        """What is meant by the probability of a state."""
        return DEFINITION

    @property
    def failed(self) -> int:
        """Number of histories that could not be computed; they are left out."""
        return int((~self.responses.good).sum())

    @cached_property
    def _sorted(self) -> tuple[FloatArray, IntArray]:
        return np.unique(self.motion_levels, return_inverse=True)

    @property
    def levels(self) -> FloatArray:
        """Levels at which there are motions, increasing [unit of the measure]."""
        return self._sorted[0]

    @property
    def trials(self) -> IntArray:
        """Number of motions at each level whose history could be computed."""
        return self._counted(self.responses.good)

    @cached_property
    def counts(self) -> dict[str, IntArray]:
        """Number of motions that reach each state, by name of the state, at each level."""
        return {s.name: self._counted(self.responses.exceed(s) == 1.0) for s in self.states}

    def _counted(self, chosen: BoolArray) -> IntArray:
        return np.bincount(self._sorted[1][chosen], minlength=self.levels.size).astype(np.int64)

    @cached_property
    def fits(self) -> "dict[str, LognormalFit]":
        """Lognormal curve of each state from the outcomes alone; none for rocking where a level decides it."""
        return fits_of(self.subject, self.states, self.motion_levels, self.responses)

    @cached_property
    def regression(self) -> Regression:
        """Straight line of ln(theta/alpha) over ln of the measure, of histories clearly lifted and still standing."""
        rocked = clearly_lifted(self.responses, self.least)
        return regression(np.log(self.motion_levels[rocked]), np.log(self.responses.rotation[rocked]))

    @property
    def barely_lifted(self) -> int:
        """Number of histories that rocked by less than `least`: they are left out of the line."""
        return barely_lifted(self.responses, self.least)

    @cached_property
    def _clear_share(self) -> ClearShare:
        return ClearShare(self.motion_levels, self.responses, self.least)

    @cached_property
    def uplift(self) -> UpliftCheck:
        """Check of the histories against the threshold of uplift."""
        return uplift_check(self.subject, self.motion_levels, self.responses)

    def probability_of_rocking(self, level: Any) -> FloatArray:
        """Return the probability that the body rocks or overturns.

        Parameters
        ----------
        level : float or array_like
            Levels of the measure [its unit].

        Returns
        -------
        ndarray
            Zero or one where a level decides it, else the fitted curve [-].
        """
        levels = checks.positive_array("level", level, self.subject.measure.unit)
        threshold = self.subject.uplift_threshold
        if threshold is not None:
            return np.asarray(levels > threshold, dtype=np.float64)
        return np.asarray(self.fits["rocking"].probability(levels), dtype=np.float64)

    def probability(self, level: Any, rotation: float) -> FloatArray:
        """Return the probability that the rotation exceeds a value, from all three parts.

        Parameters
        ----------
        level : float or array_like
            Levels of the measure [its unit].
        rotation : float
            Rotation over alpha, at least `least` [-].

        Returns
        -------
        ndarray
            P(overturned) + P(rocked, not overturned) P(rotation exceeded | rocked, not overturned) [-].
        """
        parts = self.parts(level, rotation)
        return parts["overturned"] + parts["exceeded"]  # Eq. 221

    def parts(self, level: Any, rotation: float) -> dict[str, FloatArray]:
        """Return the parts of the total probability, which add up to one.

        Parameters
        ----------
        level : float or array_like
            Levels of the measure [its unit].
        rotation : float
            Rotation over alpha, at least `least`: what is barely lifted reaches none above it [-].

        Returns
        -------
        dict of str to ndarray
            ``no rocking``, ``below`` (rocked, not beyond the rotation), ``exceeded`` (rocked beyond it, did not
            overturn) and ``overturned`` [-].
        """
        levels = checks.positive_array("level", level, self.subject.measure.unit)
        hint = "the line knows nothing of histories barely lifted; choose another least="
        limit = math.log(checks.positive("rotation", checks.within("rotation", rotation, self.least, 1e6, hint=hint)))
        # whatever overturned has rocked: where the curves cross, rocking is at least as probable
        rocks = self.probability_of_rocking(levels)
        over = np.minimum(np.asarray(self.fits["overturned"].probability(levels), dtype=np.float64), rocks)
        beyond = self.regression.probability_above(limit, np.log(levels)) * self._clear_share.at(levels)
        return {
            "no rocking": 1.0 - rocks,
            "below": (rocks - over) * (1.0 - beyond),
            "exceeded": (rocks - over) * beyond,  # Eq. 221
            "overturned": over,
        }

    @cached_property
    def dataset(self) -> "xr.Dataset":
        """All outcomes with their units, over motion."""
        xarray = extra("xarray", "a labelled dataset")
        data = {**self.responses.labelled("motion"), "level": ("motion", self.motion_levels, self.subject.label)}
        more = {"definition": self.definition, "uplift": self.uplift.verdict, "failed": self.failed}
        more["contact"] = self.responses.contact
        coords = {"motion_name": ("motion", self.subject.names)}
        made: xr.Dataset = xarray.Dataset(data, coords=coords, attrs=self.subject.about() | more)
        return made

    def summary(self) -> dict[str, Any]:
        """Return what is printed: the definition, the check, the line and the curves.

        Returns
        -------
        dict
            Plain values; median in the unit of the measure.
        """
        return {
            "analysis": "cloud",
            "definition": self.definition,
            "measure": self.subject.measure.name,
            "unit": self.subject.measure.unit,
            "uplift": self.uplift.verdict,
            "failed": self.failed,
            "contact": self.responses.contact,
            "outcomes": {outcome.name.lower(): n for outcome, n in self.responses.counts().items()},
            "regression": _told(self),
            "least": self.least,
            "barely lifted": self.barely_lifted,
            "curves": {name: fit.summary() for name, fit in self.fits.items()},
        }


def _told(analysis: CloudAnalysis) -> dict[str, Any]:
    try:
        return analysis.regression.summary()
    except InvalidValueError as error:
        return {"none": str(error)}
