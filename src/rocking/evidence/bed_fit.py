"""What could make the measured groups differ: explanations by the contact bed, their fit, and a verdict in words."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.evidence.comparison import rmse
from rocking.evidence.likelihood import interval_log_likelihood
from rocking.evidence.measurements import DataSet, all_measurements
from rocking.evidence.searches import minimise_many
from rocking.restitution.bed_table import DAMPING, HARDNESS, POINTS, Bed, bed_table
from rocking.restitution.calibrated import scatter
from rocking.restitution.impact import ImpactGeometry

_SCATTER = ((-2.3, 0.8), ((-6.0, 0.0), (0.0, 1.5)))
_FIRST, _POLISHED, _AGAIN = 300, 1500, 100

BLOCKS = ("S", "M", "L")
DAMPED = (1.0, DAMPING[1])
"""Damping ratios that are fitted [-]: below 1 hops are left over, and the stated error nears the scatter."""


_DAMPING, _HARDNESS, _FACTOR, _SHARE = (slice(first, first + 4) for first in (0, 4, 8, 12))  # of each group
_TAPE, _UNEVEN = 16, 17
_WITHOUT = (math.nan,) * 8 + (1.0,) * 8 + (0.0, 0.0)


@dataclass(frozen=True)
class FittedNumber:
    """One fitted number of an explanation."""

    name: str  # name
    start: float  # where the fit starts
    bounds: tuple[float, float]  # its range
    sets: slice  # columns of `coefficients` that have its value


@dataclass(frozen=True)
class Physics:
    """One explanation, as a family of predictions."""

    name: str  # short name
    sentence: str  # what it says
    parameters: tuple[FittedNumber, ...]  # the fitted numbers, the number of points not among them

    def columns(self, behind: int) -> IntArray:
        """Return where each number of `coefficients` is: a parameter's number, or behind them those without effect."""
        columns = behind + np.arange(len(_WITHOUT))
        for number, parameter in enumerate(self.parameters):
            columns[parameter.sets] = number
        return columns

    def predict(self, values: Sequence[float], data: DataSet, points: int) -> FloatArray:
        """Return the coefficients of the rows of data [-]."""
        return coefficients(np.array([*values, *_WITHOUT])[self.columns(len(values))], data, points)


def coefficients(numbers: FloatArray, data: DataSet, points: IntArray | int) -> FloatArray:
    """Return coefficients of rows, of shape (..., rows), for numbers of shape (..., 18) [-].

    The columns are damping ratio, hardness, factor of the interface and share of the base, each of Table 1, S, M and
    L; the energy lost beside the bed times mass [kg]; and the shift of the impulse times the relative width.
    """
    group = data.group_number
    cell, across, along = bed_table().bed(points, numbers[..., _DAMPING], numbers[..., _HARDNESS])
    light = np.where(np.isnan(data.mass), 0.0, 1.0 / np.where(np.isnan(data.mass), 1.0, data.mass))
    tape = np.sqrt(np.maximum(1.0 - numbers[..., _TAPE, None] * light, 0.0))
    shift = numbers[..., _UNEVEN, None] / relative_width(data)
    of_rows = cell[..., group], across[..., group], along[..., group]
    r = _on_bed(data.slenderness, of_rows, numbers[..., _SHARE][..., group], shift)
    return np.asarray(numbers[..., _FACTOR][..., group] * tape * r)


def bed_coefficients(
    slenderness: FloatArray, points: int, damping: float, hardness: float, share: float = 1.0, shift: float = 0.0
) -> FloatArray:
    """Return the bed's coefficients of rectangles of a slenderness h/b that stand on the middle of their base [-]."""
    # share: part of the base that the bed reaches over [-]; shift: added to the position of the impulse [-]
    return _on_bed(slenderness, bed_table().bed(points, damping, hardness), np.asarray(share), np.asarray(shift))


def _on_bed(slenderness: FloatArray, bed: Bed, share: FloatArray, shift: FloatArray) -> FloatArray:
    gyration = ImpactGeometry.of_slenderness(slenderness).base_gyration
    kappa = bed_table().position(bed, 1.0 / (1.0 + gyration / share**2), 0.0)
    # the impulse stays between the middle and the foot
    arm = np.minimum(np.maximum(kappa + shift, 0.0), 1.0) * share
    return np.asarray((gyration - arm * share) / (gyration + arm * share))  # Eq. 3


def relative_width(data: DataSet) -> FloatArray:
    """Return widths of the blocks over that of a 1 kg cube, as far as masses tell: (mass / slenderness)^(1/3)."""
    # The paper gives no widths. Blocks of one material with depth in proportion to width have this scale; nothing but
    # ratios of it enters. Table 1 gives no masses: there the width is infinite, which leaves unevenness out.
    width = np.cbrt(data.mass / data.slenderness)
    return np.where(np.isnan(width), np.inf, width)


def explanations() -> tuple[Physics, ...]:
    """Return the explanations that are compared."""
    bed = FittedNumber("damping", 1.5, DAMPED, _DAMPING), FittedNumber("hardness", 100.0, HARDNESS, _HARDNESS)
    damping, hardness = bed
    eta, base = (0.98, (0.9, 1.0), _FACTOR), (0.95, (0.5, 1.0), _SHARE)
    return (
        Physics("one bed", "all blocks stand on one bed; mass has no effect", bed),
        Physics(
            "loss beside the bed",
            "a factor eta for all blocks on tape (S, M, L), none for Table 1",
            (*bed, FittedNumber("eta", 0.98, (0.9, 1.0), slice(9, 12))),
        ),
        Physics(
            "loss that does not grow with mass",
            "a loss of energy that falls as 1/mass in relation, as of a tape under all blocks",
            (*bed, FittedNumber("tape", 0.01, (0.0, 0.2), slice(_TAPE, _TAPE + 1))),
        ),
        Physics(
            "loss by group", "an interface factor eta of its own for each group", (*bed, *_by_group("eta", *eta)[1:])
        ),
        Physics(
            "damping by group",
            "the damping ratio of the bed differs between the groups",
            (hardness, *_by_group("damping", 1.5, DAMPED, _DAMPING)),
        ),
        Physics(
            "hardness by group",
            "the hardness of the bed, or the landing speed, differs between the groups",
            (damping, *_by_group("hardness", 100.0, HARDNESS, _HARDNESS)),
        ),
        Physics(
            "narrower base by group",
            "the base rests on a part of its width that differs between the groups",
            (*bed, *_by_group("share", *base)[1:]),
        ),
        Physics(
            "unevenness of one height",
            "millimetres of the same height under all blocks move the impulse by an amount over the width",
            (*bed, FittedNumber("uneven", 0.05, (-0.5, 0.5), slice(_UNEVEN, _UNEVEN + 1))),
        ),
    )


def _by_group(name: str, start: float, bounds: tuple[float, float], columns: slice) -> list[FittedNumber]:
    groups = enumerate(("Table 1", *BLOCKS), columns.start)
    return [FittedNumber(f"{name} {group}", start, bounds, slice(column, column + 1)) for column, group in groups]


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
        at = {each.name: (self.values[each.name], *each.bounds) for each in self.physics.parameters}
        return tuple(
            name for name, (value, low, high) in at.items() if min(value - low, high - value) < 2e-3 * (high - low)
        )


def fit_bed(physics: Physics, data: DataSet | None = None, *, points: Sequence[int] = POINTS) -> BedFit:
    """Fit one explanation with each of some numbers of contact points [-]."""
    return bed_fits(data, (physics,), points)[0]


def bed_fits(
    data: DataSet | None = None, compared: Sequence[Physics] | None = None, points: Sequence[int] = POINTS
) -> tuple[BedFit, ...]:
    """Fit explanations, all if none are given, with each of some numbers of contact points [-]; least BIC first."""
    rows = data or all_measurements()
    searches = [
        _BedSearch(physics, number, np.array([*(each.start for each in physics.parameters), *_SCATTER[0]]))
        for physics in compared or explanations()
        for number in points
    ]
    found = _most_likely(searches, rows, _FIRST)
    families = [found[first : first + len(points)] for first in range(0, len(found), len(points))]
    best = [max(family, key=lambda search: search.log_likelihood) for family in families]
    for _ in range(2):  # a simplex that has collapsed at a bound is started once more
        best = _most_likely(best, rows, _POLISHED)
    return tuple(sorted((_fit(search, rows) for search in best), key=lambda fit: fit.bic))


def left_out(fits: Sequence[BedFit], data: DataSet | None = None) -> FloatArray:
    """Return the logarithm of the probability of each printed number by fits that have not seen it, (fits, rows)."""
    rows = data or all_measurements()
    searches = [
        _BedSearch(fit.physics, fit.points, np.array([*fit.values.values(), math.log(fit.floor), fit.slope]), unseen)
        for fit in fits  # their points are kept
        for unseen in range(len(rows))
    ]
    unseen = [search.log_likelihood_unseen for search in _most_likely(searches, rows, _AGAIN)]
    return np.array(unseen).reshape(len(fits), len(rows))


@dataclass(frozen=True, eq=False)
class _BedSearch:
    """Where a search for the most likely parameters of an explanation starts, or where it has ended."""

    physics: Physics
    points: int
    at: FloatArray  # the parameters, and floor (its logarithm) and slope of the scatter
    unseen: int | None = None  # row that takes no part
    log_likelihood: float = math.nan
    log_likelihood_unseen: float = math.nan  # of that row


def _fit(search: _BedSearch, data: DataSet) -> BedFit:
    *values, log_floor, slope = search.at.tolist()
    mean = search.physics.predict(values, data, search.points)
    names = [each.name for each in search.physics.parameters]
    return BedFit(
        search.physics, search.points, dict(zip(names, values, strict=True)),
        math.exp(log_floor), slope, search.log_likelihood,
        (len(values) + 3) * math.log(len(data)) - 2.0 * search.log_likelihood,  # Eq. 138
        rmse(mean, data.coefficient), mean,
    )  # fmt: skip


def _most_likely(searches: Sequence[_BedSearch], data: DataSet, steps: int) -> list[_BedSearch]:
    """Return where searches end that all take their steps at once."""
    sizes = np.array([search.at.size for search in searches])
    width = int(sizes.max())
    points = np.array([[search.points] for search in searches])
    columns = np.array([[*each.physics.columns(width), each.at.size - 2, each.at.size - 1] for each in searches])
    seen = np.array([np.delete(np.arange(len(data)), [] if (i := each.unseen) is None else i) for each in searches])
    starts, low, span = np.zeros((3, len(searches), width))
    for place, search in enumerate(searches):
        limits = np.array([*(each.bounds for each in search.physics.parameters), *_SCATTER[1]])
        low[place, : search.at.size], span[place, : search.at.size] = limits[:, 0], limits[:, 1] - limits[:, 0]
        starts[place, : search.at.size] = np.clip(
            (search.at - limits[:, 0]) / (limits[:, 1] - limits[:, 0]), 0.02, 0.98
        )

    def at(free: FloatArray, number: IntArray) -> FloatArray:
        return np.asarray(low[number] + span[number] * np.clip(free, 0.0, 1.0))

    def of_rows(free: FloatArray, number: IntArray) -> FloatArray:
        both = np.concatenate([at(free, number), np.broadcast_to(_WITHOUT, (len(free), len(_WITHOUT)))], axis=1)
        numbers = np.take_along_axis(both, columns[number], axis=1)
        mean = coefficients(numbers[:, :-2], data, points[number])
        sd = scatter(mean, np.exp(numbers[:, -2:-1]), numbers[:, -1:])
        return interval_log_likelihood(data.low, data.high, mean, sd)

    def misfit(free: FloatArray, number: IntArray) -> FloatArray:
        likelihood = np.take_along_axis(of_rows(free, number), seen[number], axis=1).sum(axis=1)
        return np.asarray(10.0 * np.abs(free - np.clip(free, 0.0, 1.0)).sum(axis=1) - likelihood)

    best = minimise_many(misfit, starts, sizes, tolerance=1e-5, evaluations=steps)
    every = np.arange(len(searches))
    found, rows = at(best, every), of_rows(best, every)
    return [
        replace(
            search, at=found[i, : sizes[i]], log_likelihood=float(rows[i, seen[i]].sum()),
            log_likelihood_unseen=float(rows[i, search.unseen]) if search.unseen is not None else math.nan,
        )
        for i, search in enumerate(searches)
    ]  # fmt: skip


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
    scores = {fit.physics.name: scores for fit, scores in zip(fits, left_out(fits), strict=True)}
    return Explanation(tuple(_ranked(fit, scores, fits[0].bic) for fit in fits))


def _ranked(fit: BedFit, scores: dict[str, FloatArray], least: float) -> Ranked:
    own = scores[fit.physics.name]
    ahead = own - scores["one bed"]
    error = math.sqrt(ahead.size) * float(np.std(ahead, ddof=1))
    return Ranked(fit, own, fit.bic - least, float(ahead.sum()), error)


def _listed(names: list[str]) -> str:
    quoted = [f'"{name}"' for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"
