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

    Parameters
    ----------
    least : float
        Rotation over alpha, from 0 to below 1 [-].

    Returns
    -------
    float
        The same [-].
    """
    return checks.within("least", least, 0.0, 1.0, open_high=True, hint="a rotation over alpha")


def clearly_lifted(responses: Responses, least: float) -> BoolArray:
    """Return which histories rocked, not barely, and stayed standing.

    Parameters
    ----------
    responses : Responses
        The outcomes.
    least : float
        Rotation over alpha below which a history counts as barely lifted [-].

    Returns
    -------
    ndarray of bool
        One entry a history.
    """
    return np.asarray(responses.rocked & (responses.rotation >= least) & (responses.rotation > 0.0))


def barely_lifted(responses: Responses, least: float) -> int:
    """Return how many histories rocked barely.

    Parameters
    ----------
    responses : Responses
        The outcomes.
    least : float
        Rotation over alpha below which a history counts as barely lifted [-].

    Returns
    -------
    int
        Their number.
    """
    return int(np.sum(responses.rocked & ~clearly_lifted(responses, least)))


class ClearShare:
    """How many of the histories that rocked and stayed standing were clearly lifted, level by level.

    A lognormal curve where the outcomes fix one, else their share at all levels.

    Parameters
    ----------
    levels : ndarray
        Level of each history [unit of the measure].
    responses : Responses
        Their outcomes.
    least : float
        Rotation over alpha below which a history counts as barely lifted [-].
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

        Parameters
        ----------
        levels : ndarray
            Levels [unit of the measure].

        Returns
        -------
        ndarray
            Probability that what rocked and stayed standing was clearly lifted [-].
        """
        if self.fit is None or not self.fit.exists:
            return np.full(np.shape(levels), self.share)
        return np.asarray(self.fit.probability(levels))
