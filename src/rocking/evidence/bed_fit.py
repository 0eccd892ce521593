"""What could make the measured groups differ: explanations by the contact bed, their fit, and a verdict in words."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.evidence.comparison import rmse
from rocking.evidence.likelihood import interval_log_likelihood
from rocking.evidence.measurements import DataSet, all_measurements
from rocking.restitution.bed_table import DAMPING, HARDNESS, POINTS, bed_table
from rocking.restitution.calibrated import scatter
from rocking.restitution.impact import ImpactGeometry
from rocking.restitution.shifted_impulse import shifted

_SCATTER = ((-2.3, 0.8), ((-6.0, 0.0), (0.0, 1.5)))
_FIRST, _POLISHED, _AGAIN = 300, 1500, 100

Predict = Callable[[FloatArray, DataSet, int], FloatArray]
BLOCKS = ("S", "M", "L")
DAMPED = (1.0, DAMPING[1])
"""Damping ratios that are fitted [-]: below 1 hops are left over, and the stated error nears the scatter."""


@dataclass(frozen=True)
class Physics:
    """One explanation, as a family of predictions."""

    name: str  # short name
    sentence: str  # what it says
    parameters: tuple[str, ...]  # names of the fitted numbers, the number of points not among them
    start: tuple[float, ...]  # where the fit starts
    bounds: tuple[tuple[float, float], ...]  # range of each
    predict: Predict  # takes parameters, a `DataSet` and the number of points; returns coefficients


def bed_coefficients(
    slenderness: FloatArray,
    points: int,
    damping: FloatArray | float,
    hardness: FloatArray | float,
    *,
    share: FloatArray | float = 1.0,
    shift: FloatArray | float = 0.0,
) -> FloatArray:
    """Return the bed's coefficients of rectangles of a slenderness h/b that stand on the middle of their base [-]."""
    # share: part of the base that the bed reaches over [-]; shift: added to the position of the impulse, which stays
    # between the middle and the foot [-]
    block = ImpactGeometry.of_slenderness(slenderness)
    lever = share * block.old_lever
    geometry = ImpactGeometry(block.height, lever, lever, block.spread_x, block.spread_y)
    flatness = 1.0 / (1.0 + geometry.base_gyration / share**2)
    table = bed_table()
    kappa = table.position(table.plane(points, damping, hardness), flatness, np.zeros_like(flatness))
    return shifted(geometry, np.minimum(np.maximum(kappa + shift, 0.0), 1.0))


def relative_width(data: DataSet) -> FloatArray:
    """Return widths of the blocks over that of a 1 kg cube, as far as masses tell: (mass / slenderness)^(1/3)."""
    # The paper gives no widths. Blocks of one material with depth in proportion to width have this scale; nothing but
    # ratios of it enters. Table 1 gives no masses: there the width is infinite, which leaves unevenness out.
    width = np.cbrt(data.mass / data.slenderness)
    return np.where(np.isnan(width), np.inf, width)


def explanations() -> tuple[Physics, ...]:
    """Return the explanations that are compared."""
    zeta, hard, eta, base = ("damping", DAMPED), ("hardness", HARDNESS), (0.9, 1.0), (0.5, 1.0)
    bed = ((zeta[0], hard[0]), (1.5, 100.0), (zeta[1], hard[1]))
    return (
        Physics("one bed", "all blocks stand on one bed; mass has no effect", *bed, _bed),
        Physics(
            "loss beside the bed",
            "a factor eta for all blocks on tape (S, M, L), none for Table 1",
            (*bed[0], "eta"), (*bed[1], 0.98), (*bed[2], eta),
            lambda p, data, points: _by_row(data, 1.0, p[2], p[2], p[2]) * _bed(p, data, points),
        ),
        Physics(
            "loss that does not grow with mass",
            "a loss of energy that falls as 1/mass in relation, as of a tape under all blocks",
            (*bed[0], "tape"), (*bed[1], 0.01), (*bed[2], (0.0, 0.2)), _tape,
        ),
        Physics(
            "loss by group",
            "an interface factor eta of its own for each group",
            (*bed[0], *_by_group("eta")), (*bed[1], 0.98, 0.98, 0.98), (*bed[2], eta, eta, eta),
            lambda p, data, points: _by_row(data, 1.0, *p[2:]) * _bed(p, data, points),
        ),
        Physics(
            "damping by group",
            "the damping ratio of the bed differs between the groups",
            ("hardness", "damping Table 1", *_by_group("damping")), (100.0, 1.5, 1.5, 1.5, 1.5),
            (hard[1], *(DAMPED,) * 4),
            lambda p, data, points: bed_coefficients(data.slenderness, points, _by_row(data, *p[1:]), float(p[0])),
        ),
        Physics(
            "hardness by group",
            "the hardness of the bed, or the landing speed, differs between the groups",
            ("damping", "hardness Table 1", *_by_group("hardness")), (1.5, 100.0, 100.0, 100.0, 100.0),
            (zeta[1], *(HARDNESS,) * 4),
            lambda p, data, points: bed_coefficients(data.slenderness, points, float(p[0]), _by_row(data, *p[1:])),
        ),
        Physics(
            "narrower base by group",
            "the base rests on a part of its width that differs between the groups",
            (*bed[0], *_by_group("share")), (*bed[1], 0.95, 0.95, 0.95), (*bed[2], base, base, base),
            lambda p, data, points: _bed(p, data, points, share=_by_row(data, 1.0, *p[2:])),
        ),
        Physics(
            "unevenness of one height",
            "millimetres of the same height under all blocks move the impulse by an amount over the width",
            (*bed[0], "uneven"), (*bed[1], 0.05), (*bed[2], (-0.5, 0.5)),
            lambda p, data, points: _bed(p, data, points, shift=p[2] / relative_width(data)),
        ),
    )  # fmt: skip


def _by_group(parameter: str) -> tuple[str, ...]:
    return tuple(f"{parameter} {group}" for group in BLOCKS)


def _bed(p: FloatArray, data: DataSet, points: int, **more: FloatArray) -> FloatArray:
    return bed_coefficients(data.slenderness, points, float(p[0]), float(p[1]), **more)


def _tape(p: FloatArray, data: DataSet, points: int) -> FloatArray:
    light = np.where(np.isnan(data.mass), 0.0, 1.0 / np.where(np.isnan(data.mass), 1.0, data.mass))
    return np.asarray(np.sqrt(np.maximum(1.0 - p[2] * light, 0.0)) * _bed(p, data, points))


def _by_row(data: DataSet, *values: float) -> FloatArray:
    """Return the value of each row's group."""
    return np.array(values)[data.group_number]


@dataclass(frozen=True, eq=False)
class BedFit:
    """One explanation at its most likely parameters."""

    physics: Physics  # the explanation
    points: int  # most likely number of contact points of those tabulated [-]
    values: dict[str, float]  # most likely parameters
    floor: float  # floor, slope: scatter around the prediction, as `likelihood.scatter` [-]
    slope: float
    log_likelihood: float  # of the printed digits
    bic: float  # -2 ln L + p ln n, p counting the parameters, the number of points and the two of the scatter
    rmse: float  # of r [-]
    predicted: FloatArray  # coefficients [-]

    @property
    def count(self) -> int:
        """Number of fitted parameters: of the bed, its points, and the scatter."""
        return len(self.values) + 3

    @property
    def at_a_limit(self) -> tuple[str, ...]:
        """Parameters that the fit has pushed to the end of their range."""
        pairs = zip(self.values.items(), self.physics.bounds, strict=True)
        return tuple(
            name for (name, value), (low, high) in pairs if min(value - low, high - value) < 2e-3 * (high - low)
        )


def fit_bed(physics: Physics, data: DataSet | None = None, *, points: Sequence[int] = POINTS) -> BedFit:
    """Fit one explanation with each of some numbers of contact points [-]."""
    rows = data or all_measurements()
    first = np.array([*physics.start, *_SCATTER[0]])
    tried = [(*_most_likely(physics, rows, n, first, _FIRST), n) for n in points]
    near, _, n = max(tried, key=lambda each: each[1])
    # a simplex that has collapsed at a bound is started once more
    near, _ = _most_likely(physics, rows, n, near, _POLISHED)
    best, log_likelihood = _most_likely(physics, rows, n, near, _POLISHED)
    mean = physics.predict(best[:-2], rows, n)
    count = len(physics.parameters) + 3
    return BedFit(
        physics, n, dict(zip(physics.parameters, best[:-2].tolist(), strict=True)),
        math.exp(best[-2]), float(best[-1]), log_likelihood,
        count * math.log(len(rows)) - 2.0 * log_likelihood, rmse(mean, rows.coefficient), mean,  # Eq. 138
    )  # fmt: skip


def bed_fits(data: DataSet | None = None) -> tuple[BedFit, ...]:
    """Fit every explanation."""
    return tuple(sorted((fit_bed(each, data) for each in explanations()), key=lambda fit: fit.bic))


def left_out(fit: BedFit, data: DataSet | None = None) -> FloatArray:
    """Return the logarithm of the probability of each printed number by a fit that has not seen it; points are kept."""
    rows = data or all_measurements()
    start = np.array([*fit.values.values(), math.log(fit.floor), fit.slope])
    every = np.arange(len(rows))
    scores = np.empty(len(rows))
    for i in every.tolist():
        seen, unseen = rows.rows((every != i).tolist()), rows.rows([i])
        best, _ = _most_likely(fit.physics, seen, fit.points, start, _AGAIN)
        scores[i] = _log_likelihood(fit.physics, unseen, fit.points, best)
    return scores


def _log_likelihood(physics: Physics, data: DataSet, points: int, at: FloatArray) -> float:
    mean = physics.predict(at[:-2], data, points)
    sd = scatter(mean, math.exp(float(at[-2])), float(at[-1]))
    return float(interval_log_likelihood(data.low, data.high, mean, sd).sum())


def _most_likely(
    physics: Physics, data: DataSet, points: int, start: FloatArray, steps: int
) -> tuple[FloatArray, float]:
    from scipy.optimize import minimize

    limits = np.array([*physics.bounds, *_SCATTER[1]])
    low, span = limits[:, 0], limits[:, 1] - limits[:, 0]

    def inside(free: FloatArray) -> FloatArray:
        return np.asarray(low + span * np.clip(free, 0.0, 1.0))

    def misfit(free: Any) -> float:
        outside = np.abs(free - np.clip(free, 0.0, 1.0)).sum()
        return -_log_likelihood(physics, data, points, inside(free)) + 10.0 * float(outside)

    options: Any = {"xatol": 1e-5, "fatol": 1e-5, "maxfev": steps, "adaptive": True}
    result: Any = minimize(misfit, np.clip((start - low) / span, 0.02, 0.98), method="Nelder-Mead", options=options)
    best = inside(result.x)
    return best, _log_likelihood(physics, data, points, best)


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
