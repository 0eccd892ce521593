"""Three states of one body: no rocking, rocking to a level, overturned; two nested lognormal curves.

Fitted one by one, two curves of different dispersion cross at some level, beyond which overturning would be likelier
than rocking: where, and by how much, is reported. With one dispersion for both they never cross.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.fragility.counts import StateCounts, count_states
from rocking.studies.fragility.lognormal import LognormalFit, fit_lognormal
from rocking.studies.fragility.ordered_probit import Curve, nested_curves

OrderedMethod = Literal["separate", "common-dispersion"]
ORDERED_METHODS: tuple[OrderedMethod, ...] = ("separate", "common-dispersion")


@dataclass(frozen=True, eq=False)
class OrderedFit:
    """Curves of rocking at least and of overturning; `fit_ordered` makes one.

    Parameters
    ----------
    counts : StateCounts
        The outcomes.
    separate : tuple of LognormalFit
        Rocking at least, and overturning, each fitted by itself.
    method : {"separate", "common-dispersion"}
        How `rocked` and `overturned` were found.
    rocked, overturned : tuple of float, optional
        Median [unit of the levels] and dispersion [-] of rocking at least and of overturning; None where there is none.
    """

    counts: StateCounts
    separate: tuple[LognormalFit, LognormalFit]
    method: str
    rocked: Curve | None
    overturned: Curve | None

    @property
    def crossing(self) -> float | None:
        """Level where the curves cross; None if they do not, or one is missing [unit of the levels]."""
        if self.rocked is None or self.overturned is None:
            return None
        (m, s), (n, t) = self.rocked, self.overturned
        if s == t:
            return None
        with np.errstate(over="ignore", under="ignore"):
            level = float(np.exp((t * np.log(m) - s * np.log(n)) / (t - s)))
        return level if 0.0 < level < np.inf else None

    @property
    def excess(self) -> float | None:
        """By how much overturning is likelier than rocking, at worst among the levels tried [-]."""
        if self.rocked is None or self.overturned is None:
            return None
        ends = np.log(self.counts.levels[[0, -1]])
        places = np.concatenate([ends, np.clip(difference_extremes(self.rocked, self.overturned), *ends)])
        apart = _probability(np.exp(places), self.overturned) - _probability(np.exp(places), self.rocked)
        return max(0.0, float(apart.max()))

    @property
    def verdict(self) -> str:
        """What can be claimed, in plain words."""
        parts = [f"{name}: {fit.verdict}" for name, fit in zip(("Rocking", "Overturning"), self.separate, strict=True)]
        excess, crossing = self.excess, self.crossing
        if excess is None:
            parts.append("There are not two curves to compare.")
        elif crossing is None:
            parts.append("The curves do not cross.")
        elif excess > 0.0:
            parts.append(
                f"The curves cross at {crossing:.4g}, among the levels tried, and overturning would be likelier than"
                f" rocking by up to {excess:.2g}: take one dispersion for both."
            )
        else:
            parts.append(f"The curves cross at {crossing:.4g}, outside the levels tried.")
        return " ".join(parts)

    def probabilities(self, im: Any) -> FloatArray:
        """Return the probabilities of the three states.

        Parameters
        ----------
        im : array_like
            Levels of the intensity measure, >= 0 [unit of the levels].

        Returns
        -------
        ndarray
            No rocking, rocking, overturned along the last axis, adding up to one; beyond a crossing, overturning is
            held to the probability of rocking at least [-].

        Raises
        ------
        InvalidValueError
            If a curve is missing.
        """
        if self.rocked is None or self.overturned is None:
            raise InvalidValueError(f"two fragility curves are needed, got fewer: {self.verdict}")
        level = checks.real_array("im", im)
        if not (np.isfinite(level) & (level >= 0.0)).all():
            raise InvalidValueError("im must be finite and >= 0, got a value that is not")
        rocked = _probability(level, self.rocked)
        worst = np.minimum(_probability(level, self.overturned), rocked)
        return np.stack([1.0 - rocked, rocked - worst, worst], axis=-1)  # Eq. 217


def fit_ordered(
    levels: Any, rocked: Any, overturned: Any, trials: Any = None, *, method: OrderedMethod = "separate"
) -> OrderedFit:
    """Fit the curves of rocking at least and of overturning.

    Parameters
    ----------
    levels : array_like
        Level of the intensity measure of each entry, in any order, > 0 [any unit].
    rocked : array_like
        How many trials of each entry rocked to the chosen level or further, the overturned ones among them [-].
    overturned : array_like
        How many trials of each entry overturned [-].
    trials : array_like, optional
        How many trials each entry holds, at least 1; 1 each by default [-].
    method : {"separate", "common-dispersion"}
        Each curve by itself, or both with one dispersion by the likelihood of all three states (ordered probit).

    Returns
    -------
    OrderedFit
        The curves, and where they cross.

    Raises
    ------
    InvalidValueError
        If a value is refused, or one dispersion is asked for where the likelihood has no maximum.

    Examples
    --------
    >>> counts = {"rocked": [2, 9, 18, 20], "overturned": [0, 3, 9, 16], "trials": [20] * 4}
    >>> fit = fit_ordered([0.2, 0.4, 0.6, 0.8], **counts, method="common-dispersion")
    >>> fit.crossing is None, fit.rocked[1] == fit.overturned[1]
    (True, True)
    """
    if method not in ORDERED_METHODS:
        raise InvalidValueError(f"method must be one of {', '.join(ORDERED_METHODS)}, got {method!r}")
    counts = count_states(levels, rocked, overturned, trials)
    least, worst = (fit_lognormal(counts.levels, z, counts.trials) for z in (counts.rocked, counts.overturned))
    if method == "separate":
        return OrderedFit(counts, (least, worst), method, _curve(least), _curve(worst))
    curves = nested_curves(counts.levels, np.stack([counts.rocked, counts.overturned]), counts.trials)
    return OrderedFit(counts, (least, worst), method, curves[0], curves[1])


def _curve(fit: LognormalFit) -> Curve | None:
    return (fit.intervals.fractile(0.5), fit.intervals.dispersion) if fit.exists else None


def _probability(level: FloatArray, curve: Curve) -> FloatArray:
    from scipy.special import ndtr

    some = level > 0.0
    return np.asarray(np.where(some, ndtr(np.log(np.where(some, level, 1.0) / curve[0]) / curve[1]), 0.0))  # Eq. 190


def difference_extremes(first: Curve, second: Curve) -> FloatArray:
    """Return where the difference of two lognormal curves is extreme: there their densities are equal.

    first, second: median [any unit] and dispersion [-] of each. Returns ln level, of none, one or two places [-].

    >>> difference_extremes((1.0, 0.5), (1.0, 0.25)).round(4).tolist()
    [-0.3399, 0.3399]
    """
    (m, s), (n, t) = (first, second)
    x, y = 1.0 / s**2, 1.0 / t**2
    u, v = np.log(m), np.log(n)
    # (z - u)^2 / s^2 - (z - v)^2 / t^2 + 2 ln(s / t) = 0
    roots = np.roots([x - y, -2.0 * (u * x - v * y), u * u * x - v * v * y + 2.0 * np.log(s / t)])  # Eq. 189
    return np.asarray(roots.real[np.abs(roots.imag) <= 1e-9 * np.maximum(1.0, np.abs(roots.real))], dtype=np.float64)
