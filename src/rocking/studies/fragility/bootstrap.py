"""Bootstrap: the study repeated many times on the computer, all repetitions fitted at once."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.fragility.counts import Counts
from rocking.studies.fragility.estimate import (
    FittedCurves,
    LogScale,
    find_curves,
    log_dispersion,
    log_fractile,
    quadratic_error,
    standard_errors,
)
from rocking.studies.fragility.robust import with_cluster_errors

Resampling = Literal["parametric", "cases", "clusters"]
Ends = Literal["studentised", "percentile", "basic"]
RESAMPLING: tuple[Resampling, ...] = ("parametric", "cases", "clusters")
Pair = tuple[FloatArray, FloatArray]
ENDS: tuple[Ends, ...] = ("studentised", "percentile", "basic")


def resample(
    counts: Counts, probability: FloatArray, kind: Resampling, repetitions: int, seed: int
) -> tuple[FloatArray, FloatArray]:
    """Return data sets that might have been found instead.

    probability: probability of failure at each level, from the fitted curve [-]. Returns failures and trials, one row a
    data set, one column a level [-].
    """
    checks.within("repetitions", repetitions, 1, 10**7)
    random = np.random.default_rng(seed)
    if kind == "parametric":
        trials = np.broadcast_to(counts.trials, (repetitions, counts.levels.size))
        return random.binomial(trials.astype(np.int64), probability).astype(np.float64), trials  # Eq. 208
    if kind == "cases":
        cells = np.concatenate([counts.failures, counts.survivals]) / counts.trials.sum()
        drawn = random.multinomial(counts.observations, cells, size=repetitions).astype(np.float64)
        failures, survivals = np.split(drawn, 2, axis=1)
        return failures, failures + survivals
    if kind != "clusters":
        raise InvalidValueError(f"kind must be one of {', '.join(RESAMPLING)} or capacities, got {kind!r}")
    if counts.cluster_trials is None:
        raise InvalidValueError("kind must not be 'clusters' unless clusters= names the record of each outcome")
    if counts.scarcity:
        raise InvalidValueError(
            f"kind must not be 'clusters' for {counts.scarcity}: drawn again they repeat one another, and the interval"
            " would be far too narrow; take more records, or the profile interval with that caution"
        )
    failures, trials = np.split(_drawn_clusters(counts, repetitions, seed) @ counts.distinct_clusters[0], 2, axis=1)
    return failures, trials


def _drawn_clusters(counts: Counts, repetitions: int, seed: int) -> FloatArray:
    """Return how often each distinct cluster is drawn: a hundred thousand cost no more than their distinct outcomes."""
    share, number = counts.distinct_clusters[1], round(counts.distinct_clusters[1].sum())
    drawn = np.random.default_rng(seed).multinomial(number, share / share.sum(), size=repetitions)  # Eq. 209
    return drawn.astype(np.float64)


@dataclass(frozen=True, eq=False)
class BootstrapSample:
    """Curves of repeated studies, beside the one of the study itself.

    Repetitions whose outcomes form a step are fitted by the penalised likelihood. Those that no rising curve fits are
    taken to lie beyond both ends of every interval, so that they can only widen it.

    Parameters
    ----------
    curves : Curves
        The curves of the repetitions.
    original : Curves
        The curve of the study: one row.
    scale : Scale
        Scale of the coefficients.
    kind : {"parametric", "cases", "clusters"}
        How the repetitions were drawn.
    """

    curves: FittedCurves
    original: FittedCurves
    scale: LogScale
    kind: Resampling
    ends = ENDS[0]

    @property
    def repetitions(self) -> int:
        """Number of repeated studies [-]."""
        return self.curves.found.size

    @property
    def undetermined(self) -> int:
        """Number of repeated studies that no rising curve fits [-]."""
        return int(np.sum(~self.curves.found))

    @property
    def penalised(self) -> int:
        """Number of repeated studies fitted by the penalised likelihood [-]."""
        return int(np.sum(self.curves.penalised & self.curves.found))

    def log_interval(self, variate: float | None, level: float, ends: Ends = "studentised") -> tuple[float, float]:
        """Return the interval of a logarithmic fractile or of the logarithmic dispersion.

        Parameters
        ----------
        variate : float, optional
            Standard normal variate of the fractile; the dispersion without [-].
        level : float
            Confidence level [-].
        ends : {"studentised", "percentile", "basic"}
            How ends follow from the repetitions: by their distances in standard errors, which is second-order
            accurate; as their percentiles; or mirrored.

        Returns
        -------
        tuple of float
            Lower and upper end, infinite where the repetitions leave it open [-].
        """
        one, many = (
            (
                self._quantity(curves, variate)[:, None],
                standard_errors(curves.theta, curves.curvature, self.scale, variate)[:, None],
            )
            for curves in (self.original, self.curves)
        )
        low, high = self._ends(one, many, level, ends)
        return float(low[0]), float(high[0])

    def variate_band(
        self, position: FloatArray, level: float, ends: Ends = "studentised"
    ) -> tuple[FloatArray, FloatArray]:
        """Return pointwise intervals of the variate a + b u of the probability.

        Parameters
        ----------
        position : ndarray
            u [-].
        level : float
            Confidence level [-].
        ends : {"studentised", "percentile", "basic"}
            How ends follow from the repetitions.

        Returns
        -------
        tuple of ndarray
            Lower and upper ends [-].
        """
        slope = np.stack([np.ones_like(position), position], axis=1)
        one, many = (
            (
                curves.theta @ slope.T,
                np.stack([quadratic_error(row[None], curves.curvature) for row in slope], axis=1),
            )
            for curves in (self.original, self.curves)
        )
        return self._ends(one, many, level, ends)

    def _ends(self, one: Pair, many: Pair, level: float, ends: Ends) -> Pair:
        """Return both ends, column by column, from values and errors of the study and of the repetitions."""
        if ends not in ENDS:
            raise InvalidValueError(f"ends must be one of {', '.join(ENDS)}, got {ends!r}")
        distance = many[0] if ends == "percentile" else many[0] - one[0]
        distance = distance / many[1] if ends == "studentised" else distance  # Eq. 210
        found, tail = self.curves.found[:, None], 0.5 * (1.0 - level)
        low = _order_statistic(np.where(found, distance, -np.inf), tail)
        high = -_order_statistic(np.where(found, -distance, -np.inf), tail)
        if ends == "percentile":
            return low, high
        unit = one[1][0] if ends == "studentised" else 1.0
        return one[0][0] - high * unit, one[0][0] - low * unit  # Eq. 210

    def _quantity(self, curves: FittedCurves, variate: float | None) -> FloatArray:
        if variate is None:
            return log_dispersion(curves.theta, self.scale)
        return log_fractile(curves.theta, self.scale, variate)


def bootstrap(
    counts: Counts, original: FittedCurves, scale: LogScale, kind: Resampling, repetitions: int, seed: int
) -> BootstrapSample:
    """Repeat a study many times and fit every repetition as the study itself was."""
    probability = curve_probability(original, scale, counts.levels)
    failures, trials = resample(counts, probability, kind, repetitions, seed)
    curves = find_curves(counts.levels, scale, failures, trials, penalised=bool(original.penalised[0]))
    if kind == "clusters":
        curves = with_cluster_errors(counts, scale, curves, _drawn_clusters(counts, repetitions, seed))
        original = with_cluster_errors(counts, scale, original, counts.distinct_clusters[1][None])
    return BootstrapSample(curves, original, scale, kind)


def curve_probability(curves: FittedCurves, scale: LogScale, levels: FloatArray) -> FloatArray:
    """Return the probability of failure of the first curve.

    levels: levels, > 0 [any unit]. Returns probabilities [-].
    """
    from scipy.special import ndtr

    return np.asarray(ndtr(curves.theta[0, 0] + curves.theta[0, 1] * scale.position(levels)))  # Eq. 190


def _order_statistic(values: FloatArray, share: float) -> FloatArray:
    """Return the value below which a share of the rows lie, rounded outwards (B + 1 points make B + 1 equal parts)."""
    place = int(np.floor(share * (values.shape[0] + 1))) - 1  # Eq. 211
    if place < 0:
        return np.full(values.shape[1], -np.inf)
    return np.asarray(np.partition(values, place, axis=0)[place])
