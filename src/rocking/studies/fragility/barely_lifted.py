"""Histories in which the ground lifted the body by next to nothing: states of their own, but no points of a line."""

from typing import TYPE_CHECKING

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.fragility.states import Responses

if TYPE_CHECKING:
    from rocking.studies.fragility.lognormal import LognormalFit

LEAST = 0.01
"""Rotation over alpha below which a history counts as barely lifted, unless another one is chosen [-]."""


def checked_least(least: float) -> float:
    """Return the rotation below which a history counts as barely lifted, if it is one.

    least: rotation over alpha, from 0 to below 1 [-]. Returns the same [-].
    """
    return checks.within("least", least, 0.0, 1.0, open_high=True, hint="a rotation over alpha")


def clearly_lifted(responses: Responses, least: float) -> BoolArray:
    """Return which histories rocked, not barely, and stayed standing.

    least: rotation over alpha below which a history counts as barely lifted [-].
    """
    return np.asarray(responses.rocked & (responses.rotation >= least) & (responses.rotation > 0.0))


def barely_lifted(responses: Responses, least: float) -> int:
    """Return how many histories rocked barely.

    least: rotation over alpha below which a history counts as barely lifted [-].
    """
    return int(np.sum(responses.rocked & ~clearly_lifted(responses, least)))


class ClearShare:
    """How many of the histories that rocked and stayed standing were clearly lifted, level by level.

    A lognormal curve where the outcomes fix one, else their share at all levels.

    levels: level of each history [unit of the measure]; least: rotation over alpha below which a history counts as
    barely lifted [-].
    """

    def __init__(self, levels: FloatArray, responses: Responses, least: float) -> None:
        rocked, clear = responses.rocked, clearly_lifted(responses, least)
        self.share = float(clear.sum() / rocked.sum()) if rocked.any() else 1.0
        self.fit: LognormalFit | None = None
        if 0.0 < self.share < 1.0:
            from rocking.studies.fragility.lognormal import fit_lognormal

            try:
                self.fit = fit_lognormal(levels[rocked], clear[rocked])
            except InvalidValueError:
                # all at one level: there is no curve, and the share says all there is
                self.fit = None

    def at(self, levels: FloatArray) -> FloatArray:
        """Return the share at levels of the measure.

        levels: levels [unit of the measure]. Returns probability that what rocked and stayed standing was clearly
        lifted [-].
        """
        if self.fit is None or not self.fit.exists:
            return np.full(np.shape(levels), self.share)
        return np.asarray(self.fit.probability(levels))
