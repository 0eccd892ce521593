"""Code methods beside histories: what each says of bodies, and what then happens to them under a set of motions."""

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
from rocking.errors import InvalidValueError
from rocking.motions.intensity import measure as measure_of
from rocking.motions.summary import MotionSummary, summaries_of
from rocking.statistics.counts import LEAST_CLUSTERS, share_interval
from rocking.statistics.quantiles import quantiles
from rocking.studies.code_methods.methods import CODE_METHODS, BodySides, CodeMethod, Shaking
from rocking.studies.fragility.subject import checked_levels
from rocking.studies.motion_sets import MotionList, MotionSet
from rocking.studies.remedies import Margins

MEASURE = "pga/(g tan alpha)"  # of levels, where nobody says another
REPETITIONS, TAIL = 1000, 0.025
AT_MOST = 1.0 + 1e-9  # a demand that is all of the capacity passes: the clauses say "at least" [-]
FACTS = "title", "reference", "domain", "reading", "example", "vertical_motion"  # words of each method
QUARTERS = 0.16, 0.5, 0.84  # quantiles that give median and scatter [-]


@dataclass(frozen=True)
class Bias:
    """How a method's capacity compares with the intensity that overturns: method over truth."""

    # median ratio; above 1 the method takes a body for stronger than it is; 0 where a ratio below all others enters [-]
    median: float
    # 95 % interval of the median, by drawing whole motions again; NaN of fewer than five [-]
    interval: tuple[float, float]
    # half the distance of the 16 % and 84 % quantiles of the ratio's logarithm; infinite where too many motions do
    # not overturn within the range that was searched, NaN of fewer than five motions [-]
    scatter: float
    # count, censored: pairs of a motion and a body, and those of them which no level overturned: their ratio lies
    # below all others
    count: int
    censored: int


@dataclass(frozen=True)
class CalledSafe:
    """Those that a method calls safe, and how many of them overturn.

    Parameters
    ----------
    total : int
        Cases whose histories were computed and that lie in the method's domain [-].
    safe : int
        Cases that it calls safe [-].
    overturned : int
        Cases of these that overturn [-].
    ratio : float
        Median of demand over capacity, above 1 where it does not call the case safe [-].
    interval : tuple of float, optional
        95 % interval of the share that overturns; None where nothing is called safe, or of fewer than five motions some
        are, in some of which it overturns [-].
    """

    total: int
    safe: int
    overturned: int
    ratio: float
    interval: tuple[float, float] | None

    @property
    def share(self) -> float:
        """Share that overturns of those that are called safe; NaN where there are none [-]."""
        return self.overturned / self.safe if self.safe else math.nan


@dataclass(frozen=True, eq=False)
class CodeComparison:
    """What methods say of bodies under motions, and what histories show.

    Parameters
    ----------
    methods : tuple of CodeMethod
        The methods.
    bodies, motions : tuple of str
        Their names.
    levels : tuple of str
        What the motions were brought to, in words.
    capacity : ndarray, shape (methods, motions, bodies)
        Factor on each motion up to which a method calls a body safe; NaN outside its domain [-].
    overturning : ndarray, shape (motions, bodies)
        Least factor that overturns, of either way round; infinite if none did, NaN without a result [-].
    factors : ndarray, shape (motions, bodies, levels)
        Factors that bring the motions to the levels [-].
    overturned : ndarray, shape (motions, bodies, levels)
        1 where a body overturns at a level, of either way round; NaN without a result [-].
    asymmetric : ndarray, shape (bodies,)
        Whether the worse side of a body counts.
    restitution : str
        Of the histories, in words.
    outside : dict of str to str
        By method, what excludes bodies or motions from its domain; empty where nothing does.
    vertical : int
        Number of motions with a vertical part.
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
        """Return how many a method calls safe, of all bodies and levels or of one, and how many of these overturn.

        Parameters
        ----------
        method : str
            Name of the method.
        body, level : int, optional
            Numbers of one body and one level; all together if not given.

        Returns
        -------
        CalledSafe
            The interval is exact for one body at one level, else by drawing whole motions again.
        """
        ratio = (self.factors / self.capacity[self._place(method)][:, :, None])[:, body, level]
        fell = self.overturned[:, body, level]
        known = np.isfinite(ratio) & ~np.isnan(fell)
        safe = known & (ratio <= AT_MOST)
        rows = [np.reshape(each, (len(self.motions), -1)).sum(axis=1) for each in (safe & (fell == 1.0), safe)]
        hits, count = (int(row.sum()) for row in rows)
        interval = None
        alone = isinstance(body, int) and isinstance(level, int)
        if count and (alone or hits in {0, count}):  # none or all: no draw would show anything else
            independent = count if alone else int((rows[1] > 0.0).sum())
            interval = share_interval(min(hits, independent), independent)
        elif count and (rows[1] > 0.0).sum() >= LEAST_CLUSTERS:
            again = np.stack(rows, axis=1)[self._drawn].sum(axis=1)
            shares = again[:, 0] / np.where(again[:, 1] > 0.0, again[:, 1], np.nan)
            interval = _ends(shares)
        middle = float(quantiles(ratio[known], 0.5))
        return CalledSafe(int(known.sum()), count, hits, middle, interval)

    def bias(self, method: str, body: int | None = None) -> Bias:
        """Return how a method's capacity compares with what overturns, of all bodies or of one.

        Parameters
        ----------
        method : str
            Name of the method.
        body : int, optional
            Number of the body; all together if not given.

        Returns
        -------
        Bias
            Median, interval and scatter; NaN where no pair has both.
        """
        chosen = slice(None) if body is None else slice(body, body + 1)
        truth = self.overturning[:, chosen]
        ratio = self.capacity[self._place(method)][:, chosen] / truth  # Eq. 303
        good = np.isfinite(ratio)
        if not good.any():
            return Bias(math.nan, (math.nan, math.nan), math.nan, 0, 0)
        sample = np.where(np.isinf(truth), -np.inf, ratio)  # below all others
        sample[~good] = np.nan
        low, middle, high = np.maximum(quantiles(sample.ravel(), QUARTERS), 0.0).tolist()
        interval, scatter = (math.nan, math.nan), math.nan
        if good.any(axis=1).sum() >= LEAST_CLUSTERS:
            medians = quantiles(sample[self._drawn].reshape(REPETITIONS, -1), 0.5, axis=1)
            interval = _ends(np.maximum(medians, 0.0))
            scatter = 0.5 * math.log(high / low) if low > 0.0 else math.inf
        return Bias(middle, interval, scatter, int(good.sum()), int((good & np.isinf(truth)).sum()))

    def answer(self) -> Answer:
        """Return everything that is shown.

        Returns
        -------
        Answer
            By method: where it stands, and for every body its bias and what it calls safe at every level.
        """
        numbers = range(len(self.bodies))
        return Answer({
            "bodies": list(self.bodies),
            "worse_side_counts": self.asymmetric.tolist(),
            "motions": list(self.motions),
            "sources": [each.answer() for each in self.sources],
            "levels": list(self.levels),
            "restitution": self.restitution,
            "motions_with_vertical": self.vertical,
            "methods": {
                one.name: {
                    **{name: getattr(one, name) for name in FACTS},
                    "outside": self.outside.get(one.name, ""),
                    "bias": [vars(self.bias(one.name, k)) for k in numbers],
                    "called_safe": [
                        [_facts(self.called_safe(one.name, k, j)) for j in range(len(self.levels))] for k in numbers
                    ],
                    "all_bodies": {
                        "bias": vars(self.bias(one.name)), "called_safe": _facts(self.called_safe(one.name)),
                    },
                }
                for one in self.methods
            },
        })  # fmt: skip

    def _place(self, method: str) -> int:
        names = [each.name for each in self.methods]
        return names.index(checks.one_of("method", method, names))

    @cached_property
    def _drawn(self) -> IntArray:
        """Numbers of the motions that are drawn with replacement, one row a repetition."""
        count = len(self.motions)
        times = np.random.default_rng(0).multinomial(count, np.full(count, 1.0 / count), REPETITIONS)
        return np.repeat(np.tile(np.arange(count), REPETITIONS), times.ravel()).reshape(REPETITIONS, count)


def _facts(called: CalledSafe) -> dict[str, Any]:
    return {
        "histories_known": called.total, "safe": called.safe, "overturned": called.overturned,
        "limit_ratio": called.ratio, "share": called.share, "share_95": called.interval,
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
    """Say of bodies what code methods say, and compute under the same motions what happens to them.

    A body that is not symmetric is judged by its worse side, and its histories are computed both ways round: it
    overturns where either does. The intensity that overturns is the least factor on each motion that was found to, at
    64 levels in equal ratios and six halvings, up to 50 times what lifts the body or the largest acceleration that was
    ever recorded; a thinner stretch below may have been missed.

    Parameters
    ----------
    bodies : Body or sequence of Body
        Plane bodies.
    motions : GroundMotion, Pulse, MotionSet or a sequence
        The motions; each method's `vertical_motion` is its treatment of their vertical part.
    restitution : as for `simulate`
        Of the histories.
    levels : array_like, optional
        To what every motion is brought; as they are if not given [unit of the measure].
    im : str or IntensityMeasure
        The measure of the levels; of ``pga/(g tan alpha)`` 2 is the limit of the Italian linear check.
    methods : sequence of str, optional
        Names of `CODE_METHODS`; all if not given.
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
        If a body is not plane, a motion is zero throughout, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> small, large = (rk.Block(width=0.2 * height, height=height) for height in (0.6, 6.0))
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.4, 0.6, 0.8)]
    >>> found = compare_code_methods([small, large], pulses, "housner", levels=[1.9])
    >>> [found.called_safe("italian-linear", body, 0).share for body in (0, 1)]
    [1.0, 0.0]
    """
    several: list[Any] = list(bodies) if isinstance(bodies, Sequence) else [bodies]
    if not several:
        raise InvalidValueError("bodies must be at least one body, got none")
    chosen = tuple(CODE_METHODS[checks.one_of("methods", each, list(CODE_METHODS))] for each in methods or CODE_METHODS)
    gravity = options.get("gravity")
    sides = BodySides.of(several) if gravity is None else BodySides.of(several, gravity)
    kept = MotionList([motions[k] for k in range(len(motions))] if isinstance(motions, MotionSet) else motions)
    shaking, level = Shaking.of(kept), measure_of(im)
    at = None if levels is None else checked_levels("levels", levels, level.unit)
    cases = [Margins.of(body, kept, restitution, level, at, options) for body in several]
    return CodeComparison(
        methods=chosen,
        bodies=tuple(map(repr, several)),
        motions=tuple(motion.name for motion in shaking.motions),
        levels=("as they are",)
        if at is None
        else tuple(f"{level.name} = {value:g} {level.unit}".removesuffix(" -") for value in at),
        capacity=np.array([each.capacity(sides, shaking) for each in chosen]),
        overturning=np.stack([each.least for each in cases], axis=1),
        factors=np.stack([each.factors for each in cases], axis=1),
        overturned=np.stack([each.overturned for each in cases], axis=1),
        asymmetric=np.array([len(each.least_each) > 1 for each in cases]),
        restitution=cases[0].label,
        outside={each.name: each.outside(sides, shaking) for each in chosen},
        vertical=int(shaking.vertical.sum()),
        sources=summaries_of(kept),
    )
