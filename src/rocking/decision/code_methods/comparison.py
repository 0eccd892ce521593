"""Compare code methods with histories of bodies under a set of motions."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.answers import Answer
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, BoolArray, FloatArray, IntArray
from rocking.decision.code_methods.methods import CODE_METHODS, BodySides, CodeMethod, Shaking
from rocking.decision.remedies import Margins
from rocking.errors import InvalidValueError
from rocking.motions.intensity import measure as measure_of
from rocking.motions.summary import MotionSummary, summaries_of
from rocking.statistics.counts import MIN_CLUSTERS, share_interval
from rocking.statistics.quantiles import quantiles
from rocking.studies.fragility.subject import checked_levels
from rocking.studies.motion_sets import MotionList, MotionSet

MEASURE = "pga/(g tan alpha)"  # default measure of the levels
REPETITIONS, TAIL = 1000, 0.025
AT_MOST = 1.0 + 1e-9  # largest ratio of demand to capacity of a safe case; equal values are safe [-]
FACTS = "title", "reference", "domain", "reading", "example", "vertical_motion"  # texts of each method
QUARTERS = 0.16, 0.5, 0.84  # quantiles of median and scatter [-]


@dataclass(frozen=True)
class Bias:
    """Ratio of the capacity of a method to the overturning intensity of the histories."""

    # median ratio; the method is not conservative above 1; 0 if the median is a censored ratio [-]
    median: float
    # 95 % interval of the median, by resampling motions; NaN for fewer than five motions [-]
    interval: tuple[float, float]
    # half the difference between the 16 % and 84 % quantiles of the logarithm of the ratio; infinite if too many
    # motions do not overturn within the searched range, NaN for fewer than five motions [-]
    scatter: float
    # count: number of pairs of a motion and a body; censored: number of pairs without overturning at any level, with
    # a ratio below all other ratios
    count: int
    censored: int


@dataclass(frozen=True)
class CalledSafe:
    """Numbers of cases that a method rates safe, and of safe cases that overturn.

    Parameters
    ----------
    total : int
        Number of cases with computed histories in the domain of the method [-].
    safe : int
        Number of cases rated safe [-].
    overturned : int
        Number of safe cases that overturn [-].
    ratio : float
        Median of demand over capacity, above 1 for cases not rated safe [-].
    interval : tuple of float, optional
        95 % interval of the overturning fraction; None without safe cases, or with partial overturning under fewer than
        five motions [-].
    """

    total: int
    safe: int
    overturned: int
    ratio: float
    interval: tuple[float, float] | None

    @property
    def fraction(self) -> float:
        """Overturning fraction of the cases rated safe; NaN without such cases [-]."""
        return self.overturned / self.safe if self.safe else math.nan


@dataclass(frozen=True, eq=False)
class CodeComparison:
    """Capacities of bodies by code methods, with the outcomes of histories.

    Parameters
    ----------
    methods : tuple of CodeMethod
        The methods.
    bodies, motions : tuple of str
        Their names.
    levels : tuple of str
        Levels of the scaled motions, as text.
    capacity : ndarray, shape (methods, motions, bodies)
        Limit factor of each motion by method and body; NaN outside the domain [-].
    overturning : ndarray, shape (motions, bodies)
        Smallest overturning factor, both polarities; infinite if none overturns, NaN without a result [-].
    factors : ndarray, shape (motions, bodies, levels)
        Scale factors of the motions at the levels [-].
    overturned : ndarray, shape (motions, bodies, levels)
        1 if a body overturns at a level in at least one polarity; NaN without a result [-].
    asymmetric : ndarray, shape (bodies,)
        True for bodies with two polarities.
    restitution : str
        Restitution of the histories, as text.
    outside : dict of str to str
        Reasons for excluded bodies or motions by method; empty if there are none.
    vertical : int
        Number of motions with a vertical component.
    sources : tuple of MotionSummary
        Intensity, source and processing of each motion.
    """

    methods: tuple[CodeMethod, ...]
    bodies: tuple[str, ...]
    motions: tuple[str, ...]
    levels: tuple[str, ...]
    capacity: FloatArray
    overturning: FloatArray
    factors: FloatArray
    overturned: FloatArray
    asymmetric: BoolArray
    restitution: str
    outside: Mapping[str, str] = field(default_factory=dict)
    vertical: int = 0
    sources: tuple[MotionSummary, ...] = ()

    def called_safe(self, method: str, body: int | slice = slice(None), level: int | slice = slice(None)) -> CalledSafe:
        """Return the numbers of safe cases of a method, and of safe cases that overturn.

        Parameters
        ----------
        method : str
            Name of the method.
        body, level : int, optional
            Indices of one body and one level; default: all bodies and levels together.

        Returns
        -------
        CalledSafe
            Counts and interval. The interval is exact for one body at one level, otherwise from resampled motions.
        """
        ratio = (self.factors / self.capacity[self._index(method)][:, :, None])[:, body, level]
        fallen = self.overturned[:, body, level]
        valid = np.isfinite(ratio) & ~np.isnan(fallen)
        safe = valid & (ratio <= AT_MOST)
        rows = [np.reshape(flags, (len(self.motions), -1)).sum(axis=1) for flags in (safe & (fallen == 1.0), safe)]
        hits, count = (int(row.sum()) for row in rows)
        interval = None
        alone = isinstance(body, int) and isinstance(level, int)
        if count and (alone or hits in {0, count}):  # if 0 or all cases overturn, all resamples are equal
            independent = count if alone else int((rows[1] > 0.0).sum())
            interval = share_interval(min(hits, independent), independent)
        elif count and (rows[1] > 0.0).sum() >= MIN_CLUSTERS:
            resampled = np.stack(rows, axis=1)[self._samples].sum(axis=1)
            interval = _ends(resampled[:, 0] / np.where(resampled[:, 1] > 0.0, resampled[:, 1], np.nan))
        middle = float(quantiles(ratio[valid], 0.5))
        return CalledSafe(int(valid.sum()), count, hits, middle, interval)

    def bias(self, method: str, body: int | None = None) -> Bias:
        """Return the bias of a method for all bodies or for one body.

        Parameters
        ----------
        method : str
            Name of the method.
        body : int, optional
            Index of the body; default: all together.

        Returns
        -------
        Bias
            Median, interval and scatter; NaN without a valid pair.
        """
        columns = slice(None) if body is None else slice(body, body + 1)
        truth = self.overturning[:, columns]
        ratio = self.capacity[self._index(method)][:, columns] / truth  # Eq. 303
        good = np.isfinite(ratio)
        if not good.any():
            return Bias(math.nan, (math.nan, math.nan), math.nan, 0, 0)
        sample = np.where(np.isinf(truth), -np.inf, ratio)  # these ratios are below all other ratios
        sample[~good] = np.nan
        low, middle, high = np.maximum(quantiles(sample.ravel(), QUARTERS), 0.0).tolist()
        interval, scatter = (math.nan, math.nan), math.nan
        if good.any(axis=1).sum() >= MIN_CLUSTERS:
            medians = quantiles(sample[self._samples].reshape(REPETITIONS, -1), 0.5, axis=1)
            interval = _ends(np.maximum(medians, 0.0))
            scatter = 0.5 * math.log(high / low) if low > 0.0 else math.inf
        return Bias(middle, interval, scatter, int(good.sum()), int((good & np.isinf(truth)).sum()))

    def answer(self) -> Answer:
        """Return the complete result.

        Returns
        -------
        Answer
            By method: its source, and for every body the bias and the safe cases at every level.
        """
        numbers = range(len(self.bodies))
        return Answer({
            "bodies": list(self.bodies),
            "worse_side_counts": self.asymmetric.tolist(),
            "motions": list(self.motions),
            "sources": [source.answer() for source in self.sources],
            "levels": list(self.levels),
            "restitution": self.restitution,
            "motions_with_vertical": self.vertical,
            "methods": {
                method.name: {
                    **{name: getattr(method, name) for name in FACTS},
                    "outside": self.outside.get(method.name, ""),
                    "bias": [vars(self.bias(method.name, k)) for k in numbers],
                    "called_safe": [
                        [_facts(self.called_safe(method.name, k, j)) for j in range(len(self.levels))] for k in numbers
                    ],
                    "all_bodies": {
                        "bias": vars(self.bias(method.name)), "called_safe": _facts(self.called_safe(method.name)),
                    },
                }
                for method in self.methods
            },
        })  # fmt: skip

    def _index(self, method: str) -> int:
        names = [known_method.name for known_method in self.methods]
        return names.index(checks.one_of("method", method, names))

    @cached_property
    def _samples(self) -> IntArray:
        """Indices of motions sampled with replacement, one row per repetition."""
        count = len(self.motions)
        times = np.random.default_rng(0).multinomial(count, np.full(count, 1.0 / count), REPETITIONS)
        return np.repeat(np.tile(np.arange(count), REPETITIONS), times.ravel()).reshape(REPETITIONS, count)


def _facts(called: CalledSafe) -> dict[str, Any]:
    return {
        "histories_known": called.total, "safe": called.safe, "overturned": called.overturned,
        "limit_ratio": called.ratio, "fraction": called.fraction, "fraction_95": called.interval,
    }  # fmt: skip


def _ends(values: FloatArray) -> tuple[float, float]:
    low, high = quantiles(values, (TAIL, 1.0 - TAIL)).tolist()
    return low, high


def compare_code_methods(
    bodies: Body | Sequence[Body],
    motions: Any,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    levels: Any = None,
    im: Any = MEASURE,
    methods: Sequence[str] | None = None,
    **options: Any,
) -> CodeComparison:
    """Compare the capacities of bodies by code methods with their histories under the same motions.

    An unsymmetric body is rated by its worse side. Its histories are computed for both polarities, and overturning in
    one polarity counts. The overturning intensity is the smallest overturning factor of each motion, from 64 levels in
    equal ratios and 6 bisections. The search ends at 50 times uplift or the largest recorded acceleration. The search
    can miss a narrow overturning interval below the result.

    Parameters
    ----------
    bodies : Body or sequence of Body
        Plane bodies.
    motions : GroundMotion, Pulse, MotionSet or a sequence
        The motions; each method's `vertical_motion` is its treatment of their vertical part.
    restitution : as for `simulate`
        Restitution of the histories.
    levels : array_like, optional
        Levels of the scaled motions; default: unscaled [unit of the measure].
    im : str or IntensityMeasure
        The measure of the levels; the limit of the Italian linear check is 2 in ``pga/(g tan alpha)``.
    methods : sequence of str, optional
        Names of `CODE_METHODS`; default: all.
    **options
        ``threads``, ``progress`` (called with the number of histories done since the last call), ``gravity`` [m/s2],
        ``engine``, ``friction`` and other fields of `Settings`.

    Returns
    -------
    CodeComparison
        Capacities by method, outcomes, bias.

    Raises
    ------
    InvalidValueError
        If a body is not plane, a motion is zero, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> small, large = (rk.Block(width=0.2 * height, height=height) for height in (0.6, 6.0))
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.4, 0.6, 0.8)]
    >>> comparison = compare_code_methods([small, large], pulses, "housner", levels=[1.9])
    >>> [comparison.called_safe("italian-linear", body, 0).fraction for body in (0, 1)]
    [1.0, 0.0]
    """
    all_bodies: list[Any] = list(bodies) if isinstance(bodies, Sequence) else [bodies]
    if not all_bodies:
        raise InvalidValueError("bodies must contain at least one body, got 0")
    selected = tuple(
        CODE_METHODS[checks.one_of("methods", name, list(CODE_METHODS))] for name in methods or CODE_METHODS
    )
    gravity = options.get("gravity")
    sides = BodySides.of(all_bodies) if gravity is None else BodySides.of(all_bodies, gravity)
    motion_list = MotionList([motions[k] for k in range(len(motions))] if isinstance(motions, MotionSet) else motions)
    shaking, level = Shaking.of(motion_list), measure_of(im)
    at = None if levels is None else checked_levels("levels", levels, level.unit)
    cases = [Margins.of(body, motion_list, restitution, level, at, options) for body in all_bodies]
    return CodeComparison(
        methods=selected,
        bodies=tuple(map(repr, all_bodies)),
        motions=tuple(motion.name for motion in shaking.motions),
        levels=("as recorded",)
        if at is None
        else tuple(f"{level.name} = {value:g} {level.unit}".removesuffix(" -") for value in at),
        capacity=np.array([method.capacity(sides, shaking) for method in selected]),
        overturning=np.stack([case.min_factors for case in cases], axis=1),
        factors=np.stack([case.factors for case in cases], axis=1),
        overturned=np.stack([case.overturned for case in cases], axis=1),
        asymmetric=np.array([len(case.min_factors_by_polarity) > 1 for case in cases]),
        restitution=cases[0].label,
        outside={method.name: method.outside(sides, shaking) for method in selected},
        vertical=int(shaking.vertical.sum()),
        sources=summaries_of(motion_list),
    )
