"""`predict`: sample bodies from uncertain inputs, simulate them under all motions, and count the outcomes."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body, Solid
from rocking.bodies.frame import refuse_frame
from rocking.conventions import FloatArray
from rocking.decision.prediction.forecast import Chance, EndsOfRange, OutcomePairs, Prediction
from rocking.decision.prediction.mechanics import MEASURED, SampledBodies, motion_sequence
from rocking.decision.prediction.model_error import MODEL_ERROR, sharpened
from rocking.dynamics.mechanics import mechanics_for
from rocking.dynamics.settings import check_progress, thread_count
from rocking.errors import InvalidValueError, RockingError
from rocking.motions.pulse import Motion
from rocking.motions.summary import summaries_of
from rocking.statistics.counts import MIN_CLUSTERS, share_interval
from rocking.statistics.shares import REPETITIONS, SaltelliDesign, VarianceShare

COUNT = 128
SLIDING_BEYOND = 0.01
"""Default number of sampled bodies, and default sliding distance that counts as sliding [m]."""

PAIRS = 16
CHANGE = 1e-6
"""Pairs of histories under each motion, and their relative difference in scale [-]."""

FIFTH = 0.2
FEWEST = 4
"""Smallest number of histories with the rarer outcome for a computation of contributions to the variance."""


def predict(  # noqa: PLR0913 - each uncertain input is an argument
    body: Body | Solid,
    motions: Motion | Mapping[str, Motion] | Sequence[Any],
    *,
    restitution: Any = None,
    friction: Any = None,
    base: Any = None,
    centre: Any = None,
    offset: Any = None,
    level: Any = None,
    polarity: Any = None,
    azimuth: Any = None,
    model_error: Any = None,
    sliding_beyond: float = SLIDING_BEYOND,
    pga: float | None = None,
    count: int = COUNT,
    contributions: bool = True,
    seed: int = 0,
    normal_restitution: float = 0.0,
    normal_restitution_law: str = "newton",
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Prediction:
    """Return the probability that a body rocks, slides or overturns under motions.

    Bodies are sampled from the uncertain inputs and simulated under each motion. The probability is the fraction of
    bodies that overturn. An input is a number (fixed), a pair ``(low, high)`` (uniform), a sample of three or more
    numbers or ``{"values": [..]}``, ``{"mean": .., "deviation": ..}`` (normal), ``{"median": .., "dispersion": ..}``
    (lognormal), or a frozen distribution of `scipy.stats`. Omitted inputs are sampled from defaults, listed in
    `Prediction.assumed`.

    Parameters
    ----------
    body : Block, Section, MassPoints or Solid
        Nominal body. A solid has contact at the vertices of its hull, in its stable pose.
    motions : GroundMotion, Pulse, or mapping with x, y and z, or a sequence of them
        Ground motions, equally likely. With a y component, the azimuth of the body is sampled.
    restitution : str, RestitutionModel or input, optional
        "measured" (default), the distribution of the published measurements with the scatter between bodies; a
        model or its name; a coefficient for both feet; ``{"left": .., "right": ..}``; or "complementarity", only the
        contact laws at the corners. Solids: "measured", "housner-3d", "ked-3d" or a coefficient [-].
    friction : input, optional
        Coefficient of Coulomb friction; default: uniform, 0.3 to 0.8 [-].
    base : input, optional
        Inset of each foot from the nominal base, independent; default: up to 2 % of the base width. Solids: negative
        values are the inset of all contact points from the outline, with the same default. Positive values are the
        height of further contact points [m].
    centre : input, optional
        Factor on the height of the centre of mass; default: uniform, 0.97 to 1.03 [-].
    offset : input, optional
        Horizontal offset of the centre of mass. Solids: in x and y, independent. Default: uniform, up to 3 % of the
        half size of the body. It is smaller where the body would not remain in its pose [m].
    level : input or {"floor", "shelf", "pedestal", "road"}, optional
        Slope of the support, positive if the support descends towards x of the body; solids: towards x and y,
        independent. Default: that of a floor by DIN 18202, over the width of the base [rad].
    polarity : input, optional
        1 as recorded, -1 reversed; default: both, equally likely; plane bodies only [-].
    azimuth : input, optional
        Azimuth of the body's plane or x axis, from x towards y; default: uniform over all directions. Solids also with
        one component [rad].
    model_error : str, path-like, ModelError or dict, optional
        Factors on the uplift acceleration and on the energy barrier, for the error that remains with known inputs.
        The class of the body: "machined" (machined or cast, default of a `Block`), "object" (as a statue or a cabinet,
        default of other plane bodies), or "natural" (rough body or scan, default of solids). The factors are from the
        kept shaking-table tests and the variance of the class. "off" switches the factors off. A file of
        ``rocking validate-predictions --update`` or a table with `mean` and `covariance` of ln of both factors
        replaces the default [-].
    sliding_beyond : float
        Sliding distance that counts as sliding [m].
    pga : float, optional
        Peak ground acceleration to which each motion is scaled; components are multiplied by the factor of the
        stronger horizontal one [m/s2].
    count : int
        Number of sampled bodies, a power of two.
    contributions : bool
        If True, compute the contribution of each input to the variance. This adds ``count / 4`` bodies per input
        if the outcomes differ.
    seed : int
        Random seed; results do not depend on the number of threads.
    normal_restitution, normal_restitution_law
        Bounce of corners of plane bodies, as for `simulate`.
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Threads of the engine.
    progress : callable, optional
        Called with the number of histories done since the last call.

    Returns
    -------
    Prediction
        Probabilities with intervals, of all motions and of each; contributions of inputs; limits of predictability.

    Raises
    ------
    InvalidValueError
        If the body has another type, an input is outside its range, or no history has a result.

    Examples
    --------
    >>> import rocking as rk
    >>> pulses = [rk.pulses.sine(amplitude=a, period=0.8) for a in (3.0, 3.4, 5.0)]
    >>> prediction = rk.predict(rk.Block(width=0.5, height=2.0), pulses, friction=(0.2, 0.4), count=64)
    >>> prediction.chances["overturning"].per_motion.round(1).tolist()
    [0.0, 0.5, 0.8]
    """
    check_progress(progress)
    thread_count(threads)
    inputs = {
        "restitution": restitution, "friction": friction, "base": base, "centre": centre, "offset": offset,
        "level": level, "polarity": polarity, "azimuth": azimuth, "model_error": model_error,
    }  # fmt: skip
    half_count = checks.whole("count", count, 4, 1 << 24) // 2
    min_sliding = checks.positive("sliding_beyond", sliding_beyond, "m")
    motions = motion_sequence(motions, pga)
    mechanics = _mechanics(body, motions, inputs, gravity, normal_restitution, normal_restitution_law)
    design = SaltelliDesign(half_count, mechanics.widths, checks.whole("seed", seed))
    points = design.points[: 2 * half_count]
    results = _counted(mechanics, points, min_sliding, threads, progress)
    sampled = {name: values[: 2 * half_count] for name, values in results.items()}
    overturned = sampled["overturning"]
    if np.isnan(results["overturning"]).all():
        raise InvalidValueError("no history has a result; check the scale of the motion and its unit (m/s2)")
    shares, others = (
        _shares(mechanics, design, overturned, min_sliding, threads, progress)
        if contributions
        else ({}, overturned[:0])
    )
    histories = np.concatenate([results["overturning"], others])
    quarter = half_count // 2
    beside: dict[str, Chance] = {}
    if restitution is None or (isinstance(restitution, str) and restitution in MEASURED):
        for name in conventions.COMPARED_RESTITUTIONS:
            try:
                other_mechanics = mechanics.with_restitution(name)
            except RockingError:
                continue  # a model that does not apply to this body is omitted
            other_results = _counted(
                other_mechanics, points[:quarter, mechanics.widths["restitution"] :], min_sliding, threads,
                None, 0,
            )  # fmt: skip
            if not np.isnan(other_results["overturning"]).all():
                beside[name] = _chance(_calibrated(other_results["overturning"], mechanics.slope), design.seed)
    if beside:  # with the same samples
        of_default = _chance(_calibrated(overturned[:quarter], mechanics.slope), design.seed)
        beside = {conventions.DEFAULT_RESTITUTION: of_default, **beside}
    return Prediction(
        body=body,
        motions=summaries_of(mechanics.motions),
        inputs={name: uncertain.text for name, uncertain in mechanics.inputs.items()},
        assumptions=mechanics.assumed,
        fixed=mechanics.not_sampled,
        sliding_beyond=min_sliding,
        chances={
            name: _chance(_calibrated(values, mechanics.slope) if name == "overturning" else values, design.seed)
            for name, values in sampled.items()
        },
        contributions=shares,
        ends=_ends(mechanics, points, overturned),
        outcome_pairs=_outcome_pairs(results, len(points), mechanics.names),
        outcomes=np.unique(histories[~np.isnan(histories)]).size,
        count=2 * half_count,
        histories=histories.size,
        failed=int(np.isnan(histories).sum()),
        seed=design.seed,
        gravity=float(gravity),
        beside=beside,
        directions=_directions(mechanics, points, overturned) if "azimuth" in mechanics.assumed else (),
    )


_INPUTS = ("restitution", "friction", "base", "centre", "offset", "level", "polarity", "azimuth", "model_error")


def sampled_bodies(body: Body | Solid, motions: Any, options: Mapping[str, Any]) -> SampledBodies:
    """Return the sampled bodies of `predict` with keywords `options`."""
    return _mechanics(
        body, motion_sequence(motions, options.get("pga")), {name: options.get(name) for name in _INPUTS},
        options.get("gravity", conventions.g), options.get("normal_restitution", 0.0),
        options.get("normal_restitution_law", "newton"),
    )  # fmt: skip


def _mechanics(
    body: Any,
    motions: Any,
    inputs: Mapping[str, Any],
    gravity: float,
    normal_restitution: float,
    normal_restitution_law: str,
) -> SampledBodies:
    """Return the sampled bodies of the engine for a body."""
    checks.of_kind("body", refuse_frame(body), (Body, Solid), "a Block, Section, MassPoints or Solid")
    if not mechanics_for(body, None, study=True).in_plane:
        from rocking.decision.prediction.space import SampledInSpace

        if normal_restitution:
            raise InvalidValueError(
                "{parameter} applies to plane bodies only, got {value}; 3D corners do not bounce",
                parameter="normal_restitution", value=normal_restitution,
            )  # fmt: skip
        return SampledInSpace(body, motions, inputs, gravity)
    from rocking.decision.prediction.plane import SampledInPlane, contact_settings

    return SampledInPlane(body, motions, inputs, contact_settings(gravity, normal_restitution, normal_restitution_law))


def _shares(
    mechanics: SampledBodies, design: SaltelliDesign, overturned: FloatArray, min_sliding: float,
    threads: int | None, progress: Callable[[int], None] | None,
) -> tuple[dict[str, VarianceShare], FloatArray]:  # fmt: skip
    """Return the contributions by the first half of both samples, and the outcomes of further bodies."""
    smaller = SaltelliDesign(max(design.count // 2, 2), design.inputs, design.seed)
    both = np.concatenate([overturned[: smaller.count], overturned[design.count :][: smaller.count]])
    mixed = smaller.points[2 * smaller.count :]
    if np.isnan(both).all():
        return {}, both[:0]
    rarer = min(np.nansum(both), np.nansum(1.0 - both))
    if rarer < FEWEST:  # the variance is zero, or too small for its contributions
        return dict.fromkeys([*design.inputs, *["case"] * (both.shape[1] > 1)], VarianceShare(*[0.0] * 6)), both[:0]
    others = _counted(mechanics, mixed, min_sliding, threads, progress, 0)["overturning"]
    return smaller.shares(np.concatenate([both, others])), others


def _counted(
    mechanics: SampledBodies,
    points: FloatArray,
    min_sliding: float,
    threads: int | None,
    progress: Callable[[int], None] | None,
    pairs: int = PAIRS,
) -> dict[str, FloatArray]:
    """Return outcomes of all sample points, then of repeated points at a changed scale; shape (bodies, motions)."""
    repeated = points[:pairs]
    factor = np.concatenate([np.ones(len(points)), np.full(len(repeated), 1.0 + CHANGE)])
    columns: dict[str, list[FloatArray]] = {name: [] for name in ("uplift", "sliding", "overturning")}
    for motion in range(len(mechanics.names)):
        outcomes = mechanics.run(np.vstack([points, repeated]), motion, factor, threads)
        slid = np.where(np.isnan(outcomes.sliding), np.nan, outcomes.sliding >= min_sliding)
        for name, values in zip(columns, (outcomes.uplift, slid, outcomes.overturning), strict=True):
            columns[name].append(values)
        if progress is not None:
            progress(factor.size)
    return {name: np.column_stack(values) for name, values in columns.items()}


def _calibrated(occurred: FloatArray, slope: float) -> FloatArray:
    """Return outcomes with the calibrated probability as mean under each motion, and a scatter in proportion."""
    if slope == 1.0:
        return occurred
    mean = np.nansum(occurred, axis=0) / np.maximum((~np.isnan(occurred)).sum(axis=0), 1)
    calibrated = sharpened(mean, slope)
    variance = mean * (1.0 - mean)
    rate = slope * calibrated * (1.0 - calibrated) / np.where(variance > 0.0, variance, 1.0)
    return np.asarray(calibrated + (occurred - mean) * rate)


def _chance(occurred: FloatArray, seed: int) -> Chance:
    """Return the probability of an event from its occurrences, shape (bodies, motions)."""
    valid = (~np.isnan(occurred)).sum(axis=0)
    hits = np.nansum(occurred, axis=0)
    fractions = np.where(valid > 0, hits / np.maximum(valid, 1), np.nan)
    ends = np.array(
        [share_interval(h, n) if n else (0.0, 1.0) for h, n in zip(hits.tolist(), valid.tolist(), strict=True)]
    )
    valid_fractions = fractions[valid > 0]
    value = float(valid_fractions.mean())  # Eq. 259
    # the bodies are equal under all motions; the scatter of their means gives the number of independent histories
    bodies = np.nanmean(occurred[~np.isnan(occurred).all(axis=1)][:, valid > 0], axis=1)
    spread = float(bodies.var()) / bodies.size
    trials = float(np.clip(value * (1.0 - value) / spread if spread else 0.0, bodies.size, occurred.size))
    low, high = share_interval(value * trials, trials)  # Eq. 260
    within = float(np.mean(valid_fractions * (1.0 - valid_fractions) / valid[valid > 0]))
    between = (
        max(float(valid_fractions.var(ddof=1)) - within, 0.0) ** 0.5 if valid_fractions.size > 1 else np.nan
    )  # Eq. 261
    wide_interval = (np.nan, np.nan)
    if valid_fractions.size >= MIN_CLUSTERS:
        random = np.random.default_rng(seed)
        resampled = (
            random.multinomial(
                valid_fractions.size, np.full(valid_fractions.size, 1.0 / valid_fractions.size), size=REPETITIONS
            )
            @ valid_fractions
            / valid_fractions.size
        )
        ends_of_means = np.quantile(resampled, (0.025, 0.975))
        wide_interval = (min(low, float(ends_of_means[0])), max(high, float(ends_of_means[1])))
    return Chance(value, low, high, between, *wide_interval, fractions, ends[:, 0], ends[:, 1])


def _ends(mechanics: SampledBodies, points: FloatArray, overturned: FloatArray) -> dict[str, EndsOfRange]:
    """Return the probability of overturning in the lowest and the highest fifth of each input's samples."""
    values, by_input, column = mechanics.values(points), {}, 0
    for name, width in mechanics.widths.items():
        level, sampled = points[:, column : column + width].sum(axis=1), values[name]
        if name == MODEL_ERROR:  # both factors have different means; the factor on the uplift acceleration is used
            level = sampled = sampled[:, 0]
        column += width
        order, size = np.argsort(level, kind="stable"), max(1, int(FIFTH * len(points)))
        low, high = order[:size], order[-size:]
        ends = [(float(sampled[end].mean()), _mean(overturned[end], mechanics.slope)) for end in (low, high)]
        by_input[name] = EndsOfRange(*ends[0], *ends[1])
    return by_input


def _directions(mechanics: SampledBodies, points: FloatArray, overturned: FloatArray) -> tuple[float, ...]:
    """Return the probability of overturning in each quarter of the sampled azimuths."""
    quarter = np.floor(4.0 * mechanics.probabilities(points)["azimuth"][:, 0])
    return tuple(
        _mean(overturned[quarter == number], mechanics.slope) for number in range(4) if (quarter == number).any()
    )


def _mean(occurred: FloatArray, slope: float) -> float:
    valid = occurred[~np.isnan(occurred)]
    return float(sharpened(valid.mean(), slope)) if valid.size else np.nan


def _outcome_pairs(results: Mapping[str, FloatArray], count: int, names: Sequence[str]) -> OutcomePairs:
    """Return the effect of a relative change of 1e-6 on the outcomes of histories with rocking."""
    overturned, pairs = results["overturning"], len(results["overturning"]) - count
    first, second = overturned[:pairs], overturned[count:]
    rocks = (results["uplift"][:pairs] == 1.0) & np.isfinite(first) & np.isfinite(second)
    apart = rocks & (first != second)
    motions = tuple(name for name, is_apart in zip(names, apart.any(axis=0), strict=True) if is_apart)
    return OutcomePairs(pairs, int(rocks.sum()), int(apart.sum()), motions, len(names))
