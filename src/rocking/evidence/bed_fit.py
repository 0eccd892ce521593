"""Explanations by the contact bed of the differences between measured groups: fits and conclusions."""

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
"""Range of fitted damping ratios [-]. Below 1, hops remain, and the stated error is close to the scatter."""


_DAMPING, _HARDNESS, _FACTOR, _SHARE = (slice(first, first + 4) for first in (0, 4, 8, 12))  # columns per group
_TAPE, _UNEVEN = 16, 17
_WITHOUT = (math.nan,) * 8 + (1.0,) * 8 + (0.0, 0.0)


@dataclass(frozen=True)
class FittedNumber:
    """One fitted number of an explanation."""

    name: str
    start: float  # initial value of the fit
    bounds: tuple[float, float]  # range
    sets: slice  # columns of the argument of `coefficients` with this value


@dataclass(frozen=True)
class Physics:
    """One explanation, as a family of predictions."""

    name: str  # short name of the explanation
    sentence: str  # explanation as a sentence
    parameters: tuple[FittedNumber, ...]  # the fitted numbers, without the number of points

    def columns(self, behind: int) -> IntArray:
        """Return the index of the parameter in each column of `coefficients`; a larger index has no effect."""
        columns = behind + np.arange(len(_WITHOUT))
        for number, parameter in enumerate(self.parameters):
            columns[parameter.sets] = number
        return columns

    def predict(self, values: Sequence[float], data: DataSet, points: int) -> FloatArray:
        """Return the coefficients of the rows of data [-]."""
        return coefficients(np.array([*values, *_WITHOUT])[self.columns(len(values))], data, points)


def coefficients(numbers: FloatArray, data: DataSet, points: IntArray | int) -> FloatArray:
    """Return coefficients of rows, of shape (..., rows), for numbers of shape (..., 18) [-].

    The columns are damping ratio, hardness, interface factor and fraction of the base, each for Table 1, S, M and L.
    The last two columns are the additional energy loss times mass [kg], and the impulse shift times the relative width.
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
    """Return the coefficients of rectangles of slenderness h/b with a bed in the middle of the base [-]."""
    # share: fraction of the base width with the bed [-]; shift: addition to the impulse position [-]
    return _on_bed(slenderness, bed_table().bed(points, damping, hardness), np.asarray(share), np.asarray(shift))


def _on_bed(slenderness: FloatArray, bed: Bed, share: FloatArray, shift: FloatArray) -> FloatArray:
    gyration = ImpactGeometry.of_slenderness(slenderness).base_gyration
    kappa = bed_table().position(bed, 1.0 / (1.0 + gyration / share**2), 0.0)
    # the impulse acts between the middle and the foot
    arm = np.minimum(np.maximum(kappa + shift, 0.0), 1.0) * share
    return np.asarray((gyration - arm * share) / (gyration + arm * share))  # Eq. 3


def relative_width(data: DataSet) -> FloatArray:
    """Return ratios of the widths of blocks to the width of a 1 kg cube, from masses: (mass / slenderness)^(1/3)."""
    # The paper contains no widths. Blocks of one material with depth proportional to width have this scale, and only
    # its ratios are used. Table 1 contains no masses: an infinite width there removes the effect of unevenness.
    width = np.cbrt(data.mass / data.slenderness)
    return np.where(np.isnan(width), np.inf, width)


def explanations() -> tuple[Physics, ...]:
    """Return the compared explanations."""
    bed = FittedNumber("damping", 1.5, DAMPED, _DAMPING), FittedNumber("hardness", 100.0, HARDNESS, _HARDNESS)
    damping, hardness = bed
    eta, base = (0.98, (0.9, 1.0), _FACTOR), (0.95, (0.5, 1.0), _SHARE)
    return (
        Physics("one bed", "all blocks have the same bed; mass has no effect", bed),
        Physics(
            "additional loss on tape",
            "a factor eta for all blocks on tape (S, M, L), none for Table 1",
            (*bed, FittedNumber("eta", 0.98, (0.9, 1.0), slice(9, 12))),
        ),
        Physics(
            "loss independent of mass",
            "a relative loss of energy proportional to 1/mass, such as of a tape under all blocks",
            (*bed, FittedNumber("tape", 0.01, (0.0, 0.2), slice(_TAPE, _TAPE + 1))),
        ),
        Physics("loss by group", "a separate interface factor eta for each group", (*bed, *_by_group("eta", *eta)[1:])),
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
            "the supported fraction of the base width differs between the groups",
            (*bed, *_by_group("share", *base)[1:]),
        ),
        Physics(
            "unevenness of one height",
            "unevenness of equal height under all blocks shifts the impulse by an amount proportional to 1/width",
            (*bed, FittedNumber("uneven", 0.05, (-0.5, 0.5), slice(_UNEVEN, _UNEVEN + 1))),
        ),
    )


def _by_group(name: str, start: float, bounds: tuple[float, float], columns: slice) -> list[FittedNumber]:
    groups = enumerate(("Table 1", *BLOCKS), columns.start)
    return [FittedNumber(f"{name} {group}", start, bounds, slice(column, column + 1)) for column, group in groups]


@dataclass(frozen=True, eq=False)
class BedFit:
    """One explanation at its maximum likelihood parameters."""

    physics: Physics  # the fitted explanation
    points: int  # number of contact points with the largest likelihood [-]
    values: dict[str, float]  # maximum likelihood parameters
    floor: float  # floor, slope: scatter around the prediction, as in `likelihood.scatter` [-]
    slope: float
    log_likelihood: float  # logarithm of the likelihood of the printed digits
    bic: float  # -2 ln L + p ln n; p includes the parameters, the number of points and two parameters of the scatter
    rmse: float  # RMSE of r [-]
    predicted: FloatArray  # coefficients [-]

    @property
    def count(self) -> int:
        """Number of fitted parameters: bed, number of points, and scatter."""
        return len(self.values) + 3

    @property
    def at_a_limit(self) -> tuple[str, ...]:
        """Names of the parameters at an end of their range."""
        ranges = {
            parameter.name: (self.values[parameter.name], *parameter.bounds) for parameter in self.physics.parameters
        }
        return tuple(
            name for name, (value, low, high) in ranges.items() if min(value - low, high - value) < 2e-3 * (high - low)
        )


def fit_bed(physics: Physics, data: DataSet | None = None, *, points: Sequence[int] = POINTS) -> BedFit:
    """Fit one explanation with several numbers of contact points [-]."""
    return bed_fits(data, (physics,), points)[0]


def bed_fits(
    data: DataSet | None = None, compared: Sequence[Physics] | None = None, points: Sequence[int] = POINTS
) -> tuple[BedFit, ...]:
    """Fit explanations (default: all) with several numbers of contact points [-]; lowest BIC first."""
    rows = data or all_measurements()
    searches = [
        _BedSearch(physics, number, np.array([*(parameter.start for parameter in physics.parameters), *_SCATTER[0]]))
        for physics in compared or explanations()
        for number in points
    ]
    ended = _most_likely(searches, rows, _FIRST)
    families = [ended[first : first + len(points)] for first in range(0, len(ended), len(points))]
    best = [max(family, key=lambda search: search.log_likelihood) for family in families]
    for _ in range(2):  # the second search restarts simplices that collapsed at a bound
        best = _most_likely(best, rows, _POLISHED)
    return tuple(sorted((_fit(search, rows) for search in best), key=lambda fit: fit.bic))


def left_out(fits: Sequence[BedFit], data: DataSet | None = None) -> FloatArray:
    """Return ln of the probability of each printed number, from fits without this number; shape (fits, rows)."""
    rows = data or all_measurements()
    searches = [
        _BedSearch(fit.physics, fit.points, np.array([*fit.values.values(), math.log(fit.floor), fit.slope]), unseen)
        for fit in fits  # the numbers of points are kept
        for unseen in range(len(rows))
    ]
    unseen = [search.log_likelihood_unseen for search in _most_likely(searches, rows, _AGAIN)]
    return np.array(unseen).reshape(len(fits), len(rows))


@dataclass(frozen=True, eq=False)
class _BedSearch:
    """State of a search for the maximum likelihood parameters of an explanation."""

    physics: Physics
    points: int
    at: FloatArray  # parameters, logarithm of the floor of the scatter, and slope of the scatter
    unseen: int | None = None  # index of the omitted row
    log_likelihood: float = math.nan
    log_likelihood_unseen: float = math.nan  # log likelihood of the omitted row


def _fit(search: _BedSearch, data: DataSet) -> BedFit:
    *values, log_floor, slope = search.at.tolist()
    mean = search.physics.predict(values, data, search.points)
    names = [parameter.name for parameter in search.physics.parameters]
    return BedFit(
        search.physics, search.points, dict(zip(names, values, strict=True)),
        math.exp(log_floor), slope, search.log_likelihood,
        (len(values) + 3) * math.log(len(data)) - 2.0 * search.log_likelihood,  # Eq. 138
        rmse(mean, data.coefficient), mean,
    )  # fmt: skip


def _most_likely(searches: Sequence[_BedSearch], data: DataSet, steps: int) -> list[_BedSearch]:
    """Return the final states of simultaneous searches."""
    sizes = np.array([search.at.size for search in searches])
    width = int(sizes.max())
    points = np.array([[search.points] for search in searches])
    columns = np.array([[*item.physics.columns(width), item.at.size - 2, item.at.size - 1] for item in searches])
    seen = np.array([np.delete(np.arange(len(data)), [] if (i := item.unseen) is None else i) for item in searches])
    starts, low, span = np.zeros((3, len(searches), width))
    for index, search in enumerate(searches):
        limits = np.array([*(item.bounds for item in search.physics.parameters), *_SCATTER[1]])
        low[index, : search.at.size], span[index, : search.at.size] = limits[:, 0], limits[:, 1] - limits[:, 0]
        starts[index, : search.at.size] = np.clip(
            (search.at - limits[:, 0]) / (limits[:, 1] - limits[:, 0]), 0.02, 0.98
        )

    def unscaled(free: FloatArray, number: IntArray) -> FloatArray:
        return np.asarray(low[number] + span[number] * np.clip(free, 0.0, 1.0))

    def log_likelihoods(free: FloatArray, number: IntArray) -> FloatArray:
        candidates = np.concatenate(
            [unscaled(free, number), np.broadcast_to(_WITHOUT, (len(free), len(_WITHOUT)))], axis=1
        )
        numbers = np.take_along_axis(candidates, columns[number], axis=1)
        mean = coefficients(numbers[:, :-2], data, points[number])
        sd = scatter(mean, np.exp(numbers[:, -2:-1]), numbers[:, -1:])
        return interval_log_likelihood(data.low, data.high, mean, sd)

    def misfit(free: FloatArray, number: IntArray) -> FloatArray:
        likelihood = np.take_along_axis(log_likelihoods(free, number), seen[number], axis=1).sum(axis=1)
        return np.asarray(10.0 * np.abs(free - np.clip(free, 0.0, 1.0)).sum(axis=1) - likelihood)

    best = minimise_many(misfit, starts, sizes, tolerance=1e-5, evaluations=steps)
    all_searches = np.arange(len(searches))
    parameters, rows = unscaled(best, all_searches), log_likelihoods(best, all_searches)
    return [
        replace(
            search, at=parameters[i, : sizes[i]], log_likelihood=float(rows[i, seen[i]].sum()),
            log_likelihood_unseen=float(rows[i, search.unseen]) if search.unseen is not None else math.nan,
        )
        for i, search in enumerate(searches)
    ]  # fmt: skip


UNRESOLVED = 2.0  # difference in BIC below which two explanations are not distinguishable


@dataclass(frozen=True, eq=False)
class Ranked:
    """An explanation and its scores."""

    fit: BedFit  # explanation at its most likely parameters
    scores: FloatArray  # logarithmic scores of the measurements, each omitted from its fit [-]
    behind: float  # BIC minus the lowest BIC [-]
    # gain: sum of scores minus that of one common bed; gain_error: its standard error over the measurements [-]
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
    """All explanations, lowest BIC first."""

    ranked: tuple[Ranked, ...]  # the explanations

    @property
    def plain(self) -> Ranked:
        """Explanation by one common bed, without an effect of mass."""
        return next(item for item in self.ranked if item.name == "one bed")

    @property
    def unresolved(self) -> tuple[str, ...]:
        """Names of the explanations whose BIC is not distinguishable from that of the best explanation."""
        return tuple(item.name for item in self.ranked if item.behind < UNRESOLVED)

    @property
    def better_unseen(self) -> tuple[str, ...]:
        """Names of explanations that predict omitted measurements better than one bed, by two standard errors."""
        return tuple(item.name for item in self.ranked if item.gain > 2.0 * item.gain_error > 0.0)

    @property
    def verdict(self) -> tuple[str, ...]:
        """Conclusions as sentences."""
        best, plain = self.ranked[0], self.plain
        bed = ", ".join(f"{name} {value:.3g}" for name, value in best.fit.values.items())
        first = (
            f'Lowest BIC: "{best.name}" ({best.fit.physics.sentence}), {best.fit.points} contact points, {bed}; RMSE '
            f"of r {best.fit.rmse:.4f}. One bed for all blocks has an RMSE of {plain.fit.rmse:.4f} and a BIC higher by "
            f"{plain.behind:.1f}."
        )
        return first, self._rivals(best), self._unseen(), self._of_mass(), _WIDTHS

    @property
    def shares_lost(self) -> dict[str, float]:
        """Additional energy loss of each group, 1 - eta^2, from the fit with one factor per group."""
        values = next(item for item in self.ranked if item.name == "loss by group").fit.values
        return {name: 1.0 - values[f"eta {name}"] ** 2 for name in BLOCKS}

    def _of_mass(self) -> str:
        shares = self.shares_lost
        losses = ", ".join(f"{100.0 * share:.1f} % ({name})" for name, share in shares.items())
        falls = list(shares.values()) == sorted(shares.values(), reverse=True)
        order = "falls from the lightest group to the heaviest" if falls else "does not follow the mass"
        limits = _listed(list(self.ranked[0].fit.at_a_limit)) if self.ranked[0].fit.at_a_limit else "none"
        return (
            f"With one factor per group the additional energy loss is {losses}: it {order}. This does not require a "
            f"change of the bed with mass. Parameters of the best fit at the end of their range: {limits}."
        )

    def _rivals(self, best: Ranked) -> str:
        rivals = [name for name in self.unresolved if name != best.name]
        if rivals:
            return f"By BIC, the 39 measurements do not distinguish it from {_listed(rivals)}."
        second = self.ranked[1]
        return f'The BIC of the next, "{second.name}", is higher by {second.behind:.1f}.'

    def _unseen(self) -> str:
        better = list(self.better_unseen)
        if not better:
            return (
                "For left-out measurements, no explanation predicts better than one common bed by two standard errors. "
                "A mass effect is not resolved."
            )
        return (
            f"For left-out measurements, {_listed(better)} predict{'s' if len(better) == 1 else ''} better than one "
            "common bed, by more than two standard errors."
        )


_WIDTHS = (
    "The paper contains no widths, landing speeds or moduli. Hardness is fitted, and ratios of widths follow from the "
    "masses. A loss independent of mass, a narrower base and unevenness of one height all have the largest effect on "
    "light blocks. Only tests that vary one of these alone can distinguish them."
)


@lru_cache(maxsize=1)
def explanation() -> Explanation:
    """Return the explanations of all 39 measurements, ranked by BIC, with left-out scores."""
    fits = bed_fits()
    scores = {fit.physics.name: scores for fit, scores in zip(fits, left_out(fits), strict=True)}
    return Explanation(tuple(_ranked(fit, scores, fits[0].bic) for fit in fits))


def _ranked(fit: BedFit, scores: dict[str, FloatArray], min_bic: float) -> Ranked:
    own_scores = scores[fit.physics.name]
    gains = own_scores - scores["one bed"]
    error = math.sqrt(gains.size) * float(np.std(gains, ddof=1))
    return Ranked(fit, own_scores, fit.bic - min_bic, float(gains.sum()), error)


def _listed(names: list[str]) -> str:
    quoted = [f'"{name}"' for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"
