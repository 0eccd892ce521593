"""How a history ended, in three states with levels between, and the lognormal curve of each state.

No rocking, rocking beyond a level, overturned. Whether a body rocks at all is certain once PGA is known: that is a
check of the histories, not a curve.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray
from rocking.dynamics.loss_of_contact import contact_words, lost_contact
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome, of_results, overturned
from rocking.quantities import attributes
from rocking.statistics.counts import pooled
from rocking.statistics.lognormal import LognormalFit, fit_counts
from rocking.studies.fragility.subject import Subject


@dataclass(frozen=True)
class LimitState:
    """A state that a history reaches or does not; one that reaches a state has reached all before it.

    Parameters
    ----------
    name : str
        ``rocking``, ``rotation > 0.5 alpha`` or ``overturned``.
    level : float
        Rotation over alpha that must be exceeded: 0 for rocking at all, infinite for overturning [-].
    """

    name: str
    level: float


def limit_states(levels: Sequence[float] = (0.5,)) -> tuple[LimitState, ...]:
    """Return the limit states: rocking, rotations beyond levels, overturned.

    Parameters
    ----------
    levels : sequence of float
        Rotations over alpha, above zero, each above the one before [-].

    Returns
    -------
    tuple of LimitState
        From the least to the worst.

    Raises
    ------
    InvalidValueError
        If a level is not a finite number above zero, or they do not increase.

    Examples
    --------
    >>> [state.name for state in limit_states((0.2, 0.5))]
    ['rocking', 'rotation > 0.2 alpha', 'rotation > 0.5 alpha', 'overturned']
    """
    given = np.atleast_1d(np.asarray(levels))
    wanted = checks.positive_array("states", given) if given.size else np.empty(0)
    if wanted.ndim != 1 or np.any(np.diff(wanted) <= 0.0):
        raise InvalidValueError(f"states must be rotations over alpha, each above the one before, got {levels!r:.60}")
    between = [LimitState(f"rotation > {level:.6g} alpha", float(level)) for level in wanted]
    return LimitState("rocking", 0.0), *between, LimitState("overturned", math.inf)


@dataclass(frozen=True, eq=False)
class Responses:
    """What the states are read from: the results of some histories, of any shape."""

    outcome: np.ndarray  # codes of `Outcome`
    # largest rotation over the alpha of its side; infinite if overturned, NaN if the history failed [-]
    rotation: FloatArray
    sides: np.ndarray  # side overturned to: 1 right, -1 left, 0 if it did not
    # 1 where the ground would have to pull, as of `lost_contact`; None where it is not known [-]
    lost: FloatArray | None = None

    @classmethod
    def of(cls, arrays: Arrays, rocker: Any, shape: tuple[int, ...]) -> "Responses":
        """Return the responses of one body from results.

        Returns of that shape.
        """
        missing = {"outcome", "peak_rotation"} - set(arrays)
        sizes = {np.size(arrays[name]) for name in ("outcome", "peak_rotation") if name in arrays}
        if missing or sizes != {math.prod(shape)}:
            raise InvalidValueError(
                f"results must be outcome and peak_rotation of {math.prod(shape)} histories, got {sorted(arrays)} of "
                f"{sorted(sizes)}; of another study?"
            )
        outcome = np.asarray(arrays["outcome"], dtype=np.int8).reshape(shape)
        peak = np.asarray(arrays["peak_rotation"], dtype=np.float64).reshape(shape)
        right, left = rocker.right.slenderness_angle, rocker.left.slenderness_angle
        over, to_right = outcome == Outcome.OVERTURNED.code, peak > 0.0
        rotation = np.abs(peak)  # there may be ten million of them: no more copies than needed
        rotation /= right if right == left else np.where(to_right, right, left)
        rotation[over], rotation[outcome == Outcome.FAILED.code] = math.inf, math.nan
        lost = lost_contact(arrays).reshape(shape) if "least_force" in arrays else None
        return cls(outcome, rotation, over * np.where(to_right, np.int8(1), np.int8(-1)), lost)

    @property
    def contact(self) -> str:
        """In how many histories the ground would have to pull, as a sentence; empty if in none."""
        return "" if self.lost is None else contact_words(self.lost)

    @property
    def good(self) -> BoolArray:
        """Which histories could be computed."""
        return np.asarray(self.outcome != Outcome.FAILED.code)

    @property
    def rocked(self) -> BoolArray:
        """Which histories rocked and stayed standing."""
        return np.asarray(self.outcome == Outcome.ROCKED.code)

    @property
    def overturned(self) -> FloatArray:
        """1 where it overturned, 0 where it did not, NaN where there is no result [-]."""
        return overturned(self.outcome)

    def exceed(self, state: LimitState) -> FloatArray:
        """Return which histories reached a limit state; no result is neither.

        Returns 1 for those that did, 0 for those that did not, NaN for those without a result [-].
        """
        if state.level == 0.0:
            return of_results(self.outcome, self.rocked | (self.overturned == 1.0))
        if math.isinf(state.level):
            return self.overturned
        with np.errstate(invalid="ignore"):
            return of_results(self.outcome, self.rotation > state.level)

    def labelled(self, dimensions: Any) -> dict[str, Any]:
        """Return outcome and rotation as variables of a labelled dataset."""
        told = "largest rotation over alpha; infinite if overturned, NaN if the history failed"
        made: dict[str, Any] = {
            "outcome": (dimensions, self.outcome, attributes("outcome")),
            "rotation": (dimensions, self.rotation, {"units": "1", "long_name": told}),
        }
        if self.lost is not None:
            made["lost_contact"] = (dimensions, self.lost, attributes("lost_contact"))
        return made

    def counts(self) -> dict[Outcome, int]:
        """Return how many histories ended in which way.

        Returns not lifted, rocked and stayed standing, overturned; those without a result are in none.
        """
        outcomes = Outcome.NO_UPLIFT, Outcome.ROCKED, Outcome.OVERTURNED
        return {outcome: int((self.outcome == outcome.code).sum()) for outcome in outcomes}


@dataclass(frozen=True)
class UpliftCheck:
    """Whether the histories rocked exactly where rocking is known beforehand.

    A body with equal sides under horizontal motions rocks if and only if PGA exceeds g tan(alpha): that is no matter of
    probability, and no curve is fitted to it.
    """

    # level of the measure that lifts the body [unit of the measure]; None if no level of this measure decides
    threshold: float | None
    checked: int  # histories that were compared; those within 1e-9 of the threshold are not
    contradictions: int  # histories that rocked below it or did not above it

    @property
    def verdict(self) -> str:
        """The result in words."""
        if self.threshold is None:
            return "no level of this measure alone decides whether the body rocks"
        return (
            f"rocking is certain above {self.threshold:.6g} and impossible below: "
            f"{self.contradictions} of {self.checked} histories contradict it"
        )


def uplift_check(subject: Subject, levels: FloatArray, responses: Responses) -> UpliftCheck:
    """Compare which histories rocked with the threshold of uplift.

    levels: level of the measure of each history [its unit].
    """
    threshold = subject.uplift_threshold
    if threshold is None:
        return UpliftCheck(None, 0, 0)
    clear = responses.good & (np.abs(levels / threshold - 1.0) > 1e-9)
    rocked = responses.exceed(LimitState("rocking", 0.0))
    return UpliftCheck(threshold, int(clear.sum()), int((clear & (rocked != (levels > threshold))).sum()))


def fits_of(
    subject: Subject, states: Sequence[LimitState], levels: FloatArray, responses: Responses
) -> dict[str, LognormalFit]:
    """Return the lognormal curve of each state.

    levels: level of the measure of each history [its unit].
    """
    wanted = [state for state in states if state.level > 0.0 or subject.uplift_threshold is None]
    reached = [responses.exceed(state) == 1.0 for state in wanted]
    counts = pooled(levels, responses.good, reached, subject.clusters)
    return {state.name: fit_counts(each) for state, each in zip(wanted, counts, strict=True)}
