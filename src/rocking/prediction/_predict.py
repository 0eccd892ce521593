"""`predict`: bodies are drawn from what is known, followed under every motion, and counted."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body, Solid
from rocking.conventions import FloatArray
from rocking.dynamics.mechanics import mechanics_for
from rocking.dynamics.settings import check_progress, thread_count
from rocking.errors import InvalidValueError, RockingError
from rocking.motions.pulse import Motion
from rocking.motions.summary import summaries_of
from rocking.prediction.forecast import Chance, EndsOfRange, Growth, Prediction
from rocking.prediction.mechanics import MEASURED, SampledBodies, several
from rocking.statistics.counts import LEAST_CLUSTERS, share_interval
from rocking.statistics.shares import REPETITIONS, SaltelliDesign

COUNT = 128
SLIDING_BEYOND = 0.01
"""What serves where nobody says otherwise: bodies drawn for every motion, and the distance from which one slid [m]."""

PAIRS = 16
CHANGE = 1e-6
REPRODUCED = 0.01
"""Pairs of histories under each motion that differ by so much in scale, and by how much peaks then may [-]."""

FIFTH = 0.2


def predict(  # noqa: PLR0913 - everything that is not known is an argument
    body: Body | Solid,
    motions: Motion | Mapping[str, Motion] | Sequence[Any],
    *,
    restitution: Any = None,
    friction: Any = None,
    base: Any = None,
    centre: Any = None,
    polarity: Any = None,
    azimuth: Any = None,
    sliding_beyond: float = SLIDING_BEYOND,
    pga: float | None = None,
    count: int = COUNT,
    shares: bool = True,
    seed: int = 0,
    bounce: float = 0.0,
    bounce_law: str = "newton",
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Prediction:
    """Return the probability that a body rocks, slides or overturns under motions.

    What is not known is drawn: many bodies that may be the one in question stand under every motion, and the share of
    them that overturns is its probability. Each input may be a number, which is then known; a pair ``(low, high)``, all
    between alike; a sample of three numbers or more; ``{"mean": .., "deviation": ..}``, normal; ``{"median": ..,
    "dispersion": ..}``, lognormal; ``{"values": [..]}``; or a frozen distribution of `scipy.stats`. What is left out
    is sampled too, with what `Prediction.assumed` says and why.

    Parameters
    ----------
    body : Block, Section, MassPoints or Solid
        The body as it is drawn. A solid stands in space on the vertices of its hull, in the pose into which it settles.
    motions : GroundMotion, Pulse, or mapping with x, y and z, or a sequence of them
        Under which it stands, each as likely; with y, the body stands at an azimuth to both components.
    restitution : str, RestitutionModel or input, optional
        "measured", what the published measurements say of the body with the scatter of single bodies, if not given; a
        model or its name; a coefficient, onto both feet; ``{"left": .., "right": ..}``; or "complementarity", nothing
        but the laws of contact at the corners. Of a solid "measured", "housner-3d", "ked-3d" or a coefficient [-].
    friction : input, optional
        Coulomb's coefficient, from 0.3 to 0.8 if not given [-].
    base : input, optional
        How far either foot lies inside of the drawn base, by itself; up to 2 % of its width if not given. Of a solid
        below zero how far the corners of its base lie inside, up to 1 % of its mean radius, and above zero how high
        points are that touch the ground too, up to 0.5 % of the height of the centre and 5 mm [m].
    centre : input, optional
        Factor on the height of the centre of mass, from 0.97 to 1.03 if not given [-].
    polarity : input, optional
        1 as recorded, -1 mirrored; both alike if not given; of plane bodies [-].
    azimuth : input, optional
        Of the body's plane, or of its x axis, from x towards y; any if not given. With one component, of solids [rad].
    sliding_beyond : float
        How far it slides at least where it is said to slide [m].
    pga : float, optional
        Peak ground acceleration to which each motion is scaled; components are multiplied by the factor of the
        stronger horizontal one [m/s2].
    count : int
        Bodies drawn for each motion, a power of two.
    shares : bool
        Whether to find which input matters how much: half as many bodies more for each input.
    seed : int
        Seed of the draws: the same one gives the same answer, on any number of threads.
    bounce, bounce_law
        How corners of plane bodies bounce off the ground, as for `simulate`.
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Threads of the engine.
    progress : callable, optional
        Called with the number of histories done since the last call.

    Returns
    -------
    Prediction
        Probabilities with intervals, over motions and for each; the share of each input; what cannot be predicted.

    Raises
    ------
    InvalidValueError
        If it is no body, an input is outside of what makes sense, or no history has a result.

    Examples
    --------
    >>> import rocking as rk
    >>> pulses = [rk.pulses.sine(amplitude=a, period=0.8) for a in (3.0, 3.4, 5.0)]
    >>> found = rk.predict(rk.Block(width=0.5, height=2.0), pulses, friction=(0.2, 0.4), count=64)
    >>> found.chances["overturning"].per_motion.round(1).tolist()
    [0.0, 0.7, 0.8]
    """
    check_progress(progress)
    thread_count(threads)
    given = {
        "restitution": restitution, "friction": friction, "base": base, "centre": centre, "polarity": polarity,
        "azimuth": azimuth,
    }  # fmt: skip
    half = checks.whole("count", count, 4, 1 << 24) // 2
    least = checks.positive("sliding_beyond", sliding_beyond, "m")
    motions = several(motions, pga)
    mechanics = _mechanics(body, motions, given, gravity, bounce, bounce_law)
    design = SaltelliDesign(half, mechanics.widths, checks.whole("seed", seed))
    points = design.points if shares else design.points[: 2 * half]
    found = _counted(mechanics, points, least, threads, progress)
    drawn = {name: values[: 2 * half] for name, values in found.items() if name != "peak"}
    failed = int(np.isnan(found["overturning"]).sum())
    if np.isnan(found["overturning"]).all():
        raise InvalidValueError("no history has a result: is the motion of the body's size, and in m/s2?")
    falls = found["overturning"][: len(points)]
    others: dict[str, Chance] = {}
    if isinstance(body, Body) and (restitution is None or (isinstance(restitution, str) and restitution in MEASURED)):
        for name in conventions.COMPARED_RESTITUTIONS:
            try:
                other = _mechanics(body, motions, {**given, "restitution": name}, gravity, bounce, bounce_law)
            except RockingError:
                continue  # it says nothing of this body
            fell = _counted(other, points[:half, mechanics.widths["restitution"] :], least, threads, None, 0)
            if not np.isnan(fell["overturning"]).all():
                others[name] = _chance(fell["overturning"], design.seed)
    return Prediction(
        body=body,
        motions=summaries_of(mechanics.motions),
        inputs={name: each.words for name, each in mechanics.inputs.items()},
        assumptions=mechanics.assumed,
        fixed=mechanics.not_sampled,
        sliding_beyond=least,
        chances={name: _chance(values, design.seed) for name, values in drawn.items()},
        shares=design.shares(falls) if shares and not np.isnan(falls).all() else {},
        ends=_ends(mechanics, points[: 2 * half], falls[: 2 * half]),
        growth=_growth(found, len(points), mechanics.names),
        outcomes=np.unique(found["overturning"][~np.isnan(found["overturning"])]).size,
        count=2 * half,
        histories=found["overturning"].size,
        failed=failed,
        seed=design.seed,
        gravity=float(gravity),
        beside=others,
    )


def _mechanics(
    body: Any, motions: Any, given: Mapping[str, Any], gravity: float, bounce: float, bounce_law: str
) -> SampledBodies:
    """Return what a body is on its engine."""
    checks.of_kind("body", body, (Body, Solid), "a Block, Section, MassPoints or Solid")
    if not mechanics_for(body, None, study=True).in_plane:
        from rocking.prediction.space import SampledInSpace

        if bounce:
            raise InvalidValueError(
                "{parameter} is of plane bodies: in space corners do not bounce, got {value}", parameter="bounce",
                value=bounce,
            )  # fmt: skip
        return SampledInSpace(body, motions, given, gravity)
    from rocking.prediction.plane import SampledInPlane, whole_settings

    return SampledInPlane(body, motions, given, whole_settings(gravity, bounce, bounce_law))


def _counted(
    mechanics: SampledBodies,
    points: FloatArray,
    least: float,
    threads: int | None,
    progress: Callable[[int], None] | None,
    pairs: int = PAIRS,
) -> dict[str, FloatArray]:
    """Return what happened, one row a body, one column a motion: at all points, then again at a changed scale."""
    again = points[:pairs]
    factor = np.concatenate([np.ones(len(points)), np.full(len(again), 1.0 + CHANGE)])
    columns: dict[str, list[FloatArray]] = {name: [] for name in ("uplift", "sliding", "overturning", "peak")}
    for number in range(len(mechanics.names)):
        one = mechanics.run(np.vstack([points, again]), number, factor, threads)
        slid = np.where(np.isnan(one.sliding), np.nan, one.sliding >= least)
        for name, values in zip(columns, (one.uplift, slid, one.overturning, one.peak), strict=True):
            columns[name].append(values)
        if progress is not None:
            progress(factor.size)
    return {name: np.column_stack(values) for name, values in columns.items()}


def _chance(happened: FloatArray, seed: int) -> Chance:
    """Return how likely something is of which it is known whether it happened to each body under each motion."""
    known = (~np.isnan(happened)).sum(axis=0)
    hits = np.nansum(happened, axis=0)
    each = np.where(known > 0, hits / np.maximum(known, 1), np.nan)
    ends = np.array(
        [share_interval(h, n) if n else (0.0, 1.0) for h, n in zip(hits.tolist(), known.tolist(), strict=True)]
    )
    seen = each[known > 0]
    value = float(seen.mean())  # Eq. 259
    # bodies are the same under all motions: as many independent histories as the scatter of their means says
    bodies = np.nanmean(happened[~np.isnan(happened).all(axis=1)][:, known > 0], axis=1)
    spread = float(bodies.var()) / bodies.size
    trials = float(np.clip(value * (1.0 - value) / spread if spread else 0.0, bodies.size, happened.size))
    low, high = share_interval(value * trials, trials)  # Eq. 260
    within = float(np.mean(seen * (1.0 - seen) / known[known > 0]))
    between = max(float(seen.var(ddof=1)) - within, 0.0) ** 0.5 if seen.size > 1 else np.nan  # Eq. 261
    wide = (np.nan, np.nan)
    if seen.size >= LEAST_CLUSTERS:
        random = np.random.default_rng(seed)
        drawn = random.multinomial(seen.size, np.full(seen.size, 1.0 / seen.size), size=REPETITIONS) @ seen / seen.size
        ends_of_means = np.quantile(drawn, (0.025, 0.975))
        wide = (min(low, float(ends_of_means[0])), max(high, float(ends_of_means[1])))
    return Chance(value, low, high, between, *wide, each, ends[:, 0], ends[:, 1])


def _ends(mechanics: SampledBodies, points: FloatArray, falls: FloatArray) -> dict[str, EndsOfRange]:
    """Return the probability of overturning in the lowest and the highest fifth of each input's draws."""
    values, found, at = mechanics.values(points), {}, 0
    for name, width in mechanics.widths.items():
        level = points[:, at : at + width].sum(axis=1)
        at += width
        order, part = np.argsort(level, kind="stable"), max(1, int(FIFTH * len(points)))
        low, high = order[:part], order[-part:]
        ends = [(float(values[name][end].mean()), _mean(falls[end])) for end in (low, high)]
        found[name] = EndsOfRange(*ends[0], *ends[1])
    return found


def _mean(happened: FloatArray) -> float:
    known = happened[~np.isnan(happened)]
    return float(known.mean()) if known.size else np.nan


def _growth(found: Mapping[str, FloatArray], count: int, names: Sequence[str]) -> Growth:
    """Return what a change of one part in a million does to histories that rock."""
    pairs = len(found["peak"]) - count
    (peak, rose, fell), (peaks, _, falls) = (
        [found[name][rows] for name in ("peak", "uplift", "overturning")] for rows in (slice(pairs), slice(count, None))
    )
    rocks = (rose == 1.0) & np.isfinite(fell) & np.isfinite(falls)
    largest = np.maximum(np.maximum(peak, peaks), 1e-300)
    apart = np.where(rocks, np.abs(peak - peaks) / largest, 0.0)
    standing = rocks & (fell == 0.0) & (falls == 0.0)
    lost = rocks & ((fell != falls) | (standing & (apart > REPRODUCED)))
    growth = apart[standing] / CHANGE
    names_lost = tuple(name for name, bad in zip(names, lost.any(axis=0), strict=True) if bad)
    median = float(np.median(growth)) if growth.size else np.nan
    return Growth(pairs, int(rocks.sum()), int(lost.sum()), names_lost, len(names), median)
