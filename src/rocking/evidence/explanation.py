"""What explains the measurements: the explanations of the contact bed against each other, and a verdict in words."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rocking.conventions import FloatArray
from rocking.evidence.bed_fit import BLOCKS, BedFit, bed_fits, left_out

UNRESOLVED = 2.0  # difference in BIC below which two explanations are not told apart


@dataclass(frozen=True, eq=False)
class Ranked:
    """An explanation and how it fares."""

    fit: BedFit  # at its most likely parameters
    scores: FloatArray  # logarithmic scores of the measurements, each left out [-]
    behind: float  # BIC above the least [-]
    # gain, gain_error: sum of the scores above that of one bed for all, and its standard error over the measurements
    # [-]
    gain: float
    gain_error: float

    @property
    def name(self) -> str:
        return self.fit.physics.name

    @property
    def score(self) -> float:
        """Sum of the logarithmic scores [-]."""
        return float(self.scores.sum())


@dataclass(frozen=True, eq=False)
class Explanation:
    """All explanations, least BIC first."""

    ranked: tuple[Ranked, ...]  # the explanations

    @property
    def plain(self) -> Ranked:
        """One bed for all: the explanation in which mass has no effect."""
        return next(each for each in self.ranked if each.name == "one bed")

    @property
    def unresolved(self) -> tuple[str, ...]:
        """Names of the explanations that BIC does not tell from the best one."""
        return tuple(each.name for each in self.ranked if each.behind < UNRESOLVED)

    @property
    def better_unseen(self) -> tuple[str, ...]:
        """Names of those that predict measurements they have not seen better than one bed, by two standard errors."""
        return tuple(each.name for each in self.ranked if each.gain > 2.0 * each.gain_error > 0.0)

    @property
    def verdict(self) -> tuple[str, ...]:
        """What follows, in words."""
        best, plain = self.ranked[0], self.plain
        bed = ", ".join(f"{name} {value:.3g}" for name, value in best.fit.values.items())
        first = (
            f'Least BIC: "{best.name}" ({best.fit.physics.sentence}), {best.fit.points} contact points, {bed}; RMSE of '
            f"r {best.fit.rmse:.4f}. One bed for all blocks has an RMSE of {plain.fit.rmse:.4f} and a BIC higher by "
            f"{plain.behind:.1f}."
        )
        return first, self._rivals(best), self._unseen(), self._of_mass(), _WIDTHS

    @property
    def shares_lost(self) -> dict[str, float]:
        """Share of the energy that each group loses beside the bed, 1 - eta^2, where each has a factor of its own."""
        values = next(each for each in self.ranked if each.name == "loss by group").fit.values
        return {name: 1.0 - values[f"eta {name}"] ** 2 for name in BLOCKS}

    def _of_mass(self) -> str:
        shares = self.shares_lost
        losses = ", ".join(f"{100.0 * share:.1f} % ({name})" for name, share in shares.items())
        falls = list(shares.values()) == sorted(shares.values(), reverse=True)
        order = "falls from the lightest group to the heaviest" if falls else "does not follow the mass"
        limits = _listed(list(self.ranked[0].fit.at_a_limit)) if self.ranked[0].fit.at_a_limit else "no parameter"
        return (
            f"With a factor for each group the energy lost beside the bed is {losses}: it {order}. The shape of the "
            f"bed need not change with mass for that; at the end of its range the best fit has {limits}."
        )

    def _rivals(self, best: Ranked) -> str:
        rivals = [name for name in self.unresolved if name != best.name]
        if rivals:
            return f"BIC does not tell it from {_listed(rivals)}: the 39 measurements do not decide between them."
        second = self.ranked[1]
        return f'The next, "{second.name}", is {second.behind:.1f} behind.'

    def _unseen(self) -> str:
        better = list(self.better_unseen)
        if not better:
            return (
                "Left out one by one, no explanation predicts the measurements better than one bed for all by two "
                "standard errors: a mass effect is not resolved."
            )
        return (
            f"Left out one by one, {_listed(better)} predict{'s' if len(better) == 1 else ''} the measurements "
            "better than one bed for all, by more than two standard errors."
        )


_WIDTHS = (
    "The paper gives no widths, landing speeds or moduli: hardness is fitted, widths enter as ratios that follow from "
    "the masses, and a loss that does not grow with mass, a narrower base and unevenness of one height all act on "
    "light blocks most; only tests that vary one of them alone could tell them apart for certain."
)


@lru_cache(maxsize=1)
def explanation() -> Explanation:
    """Compare the explanations on all 39 measurements, ranked by BIC, each with its left-out scores."""
    fits = bed_fits()
    scores = {fit.physics.name: left_out(fit) for fit in fits}
    return Explanation(tuple(_ranked(fit, scores, fits[0].bic) for fit in fits))


def _ranked(fit: BedFit, scores: dict[str, FloatArray], least: float) -> Ranked:
    own = scores[fit.physics.name]
    ahead = own - scores["one bed"]
    error = math.sqrt(ahead.size) * float(np.std(ahead, ddof=1))
    return Ranked(fit, own, fit.bic - least, float(ahead.sum()), error)


def _listed(names: list[str]) -> str:
    quoted = [f'"{name}"' for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"
