"""Friction from half cycles whose feet may slide: the evidence of coefficients of friction, all else fitted anew.

What an impact leaves to a foot that then slides for a moment hardly depends on friction, since friction has no moment
about the foot; friction is told by how the half cycles go on. So slips are followed through impacts.
"""

import math
from contextlib import suppress
from dataclasses import replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from rocking.conventions import FloatArray
from rocking.identification import forced_start
from rocking.identification.forced_model import FRICTION, MEAN, SAME_TIME, SIZE, Fit, Forced, fitted
from rocking.identification.forced_posterior import ForcedPosterior
from rocking.identification.results import LEVELS, IntervalEstimate, estimated

_LIFTS, _MOST = 0.95, 2.0  # coefficients that are thought of: over what lifts a body from rest, else it slides; [-]
_HIGHER, _COARSE = 1.3, 0.06  # above what holds the feet, where the search begins; its steps of ln of the coefficient
_FIRST, _GROWS, _LONGEST = 0.4, 1.25, 0.05  # steps from the likeliest one: over the deviation, the last one; at most
_LARGE = 0.1  # scatter
_SAME = 1e-9  # of ln of the coefficient
_STEPS = 15  # of a fit that begins near its end
_EXCLUDED, _ROSE = 12.0, 6.0  # fall of ln of the evidence beyond which none is tried; of the objective, to try harder
_UNLIKELY = math.exp(-0.5 * 1.645**2)  # over the likeliest: what is excluded, of one side, at 95 %
_SURE, _PERHAPS = 0.975, 0.25  # whether it slid
_ROUNDS = 3


def with_sliding(found: ForcedPosterior) -> tuple[ForcedPosterior, IntervalEstimate, tuple[str, ...]]:
    """Return the posterior, with feet that slide if that is what they did, the coefficient of friction, and doubts.

    Of one that is not identified only the low end is a number.
    """
    problem, noise, scatter = _later(found.problem), found.noise, max(found.likely_scatter.value, 1e-3)
    lifts = min(width / height for width, height in zip(*problem.believed[:2], strict=True))
    least = math.log(_LIFTS * lifts)
    top = max(math.log(_HIGHER * min(found.problem.demand(found.fit.x), 0.5 * _MOST)), least + _COARSE)
    far = math.inf if found.problem.odd or scatter > _LARGE else 3.0 * _EXCLUDED  # feet that hold explain little
    tried = _walked(problem, _begun(problem, found), (noise, scatter), (top, -_COARSE, 1.0), (least, top, far))
    if top > math.log(_MOST) or sum(math.isfinite(value) for _, value in tried.values()) < 2:
        return found, IntervalEstimate(math.nan, math.exp(least), math.nan), ("Feet that slide were not followed.",)
    _, lowest, above = _quantiles(tried)
    if above < _PERHAPS:
        fit = max(tried.values(), key=lambda each: each[1])[0]
        for _ in range(_ROUNDS):
            near = sliding(problem, fit.x[FRICTION], 1.0)
            fit = fitted(near, fit.x, noise, scatter, SAME_TIME)
            noise = forced_start.deviations(near, fit)
            slid = ForcedPosterior(near, fit, noise)
            scatter = max(slid.likely_scatter.value, 1e-3)
        ln, mixture = min(max(float(fit.x[FRICTION]), least), top), slid.shared((FRICTION, 1.0))
        step, tried = min(_FIRST * mixture.deviation, _LONGEST), {}
        for by in (-step, step):
            tried |= _walked(problem, fit.x, (noise, scatter), (ln, by, _GROWS), (least, top, _EXCLUDED))
        interval, lowest, above = _quantiles(tried)
        if above < 1.0 - _SURE:
            return slid, interval, ()
    held = estimated(found.shared((MEAN, 1.0)), 1.0)
    r = math.exp(tried[min(tried, key=lambda each: abs(each - math.log(lowest)))][0].x[MEAN])
    doubt = (
        f"Whether the feet slid at impacts is not told: with a friction of {lowest:.2g} they did, and r is about "
        f"{r:.3g}; said is what it is if they held."
    )
    return found, IntervalEstimate(math.nan, lowest, math.nan), () if held.low <= r <= held.high else (doubt,)


def sliding(problem: Forced, ln_friction: float, error: float = 0.0) -> Forced:
    """Return it with feet that may slide, of a known coefficient of friction, or one with an error."""
    mean, deviation = problem.mean.copy(), problem.deviation.copy()
    mean[FRICTION], deviation[FRICTION] = ln_friction, error
    return replace(problem, slides=True, mean=mean, deviation=deviation)


def _later(problem: Forced) -> Forced:
    """Return it with half cycles that no impact begins from their middle on, when feet that slid have come to rest."""
    seen = problem.seen
    first = np.where(seen.joined, seen.first, (seen.first + seen.last) // 2)
    begin = np.where(seen.joined, seen.begin, problem.series.time[first])
    return replace(problem, seen=replace(seen, first=first, begin=begin))


def _begun(problem: Forced, found: ForcedPosterior) -> FloatArray:
    """Return unknowns, with states where half cycles begin from their middle on."""
    flights, begin = found.problem.flights(found.fit.x, np.zeros((1, SIZE + 2)))
    x, which = found.fit.x.copy(), np.flatnonzero(~problem.seen.joined)
    x[SIZE:].reshape(-1, 2)[which] = np.stack(flights.at((problem.seen.begin - begin[0])[which], which), axis=1)
    return x


def _walked(
    problem: Forced,
    x: FloatArray,
    known: tuple[FloatArray, float],
    steps: tuple[float, float, float],
    within: tuple[float, float, float],
) -> dict[float, tuple[Fit, float]]:
    """Return fits and ln of their evidence, by ln of a known friction, each begun where the one before ended.

    known: noise and scatter; steps: where they begin, the first, and each over the last; within: ends, and the fall of
    ln of the evidence beyond which none is tried.
    """
    (noise, scatter), (ln, step, grows), (lowest, highest, excluded) = known, steps, within
    tried: dict[float, tuple[Fit, float]] = {}
    best, least, value = -math.inf, math.inf, -math.inf
    while lowest - _SAME <= ln <= highest + _SAME and not value < best - excluded:
        at, x = sliding(problem, ln), x.copy()
        x[FRICTION] = ln
        fit = fitted(at, x, noise, scatter, SAME_TIME, _STEPS)
        if not fit.converged or fit.objective > least + _ROSE:  # impacts may part half cycles at first
            for softer, same in forced_start.ANNEALED:
                x = fitted(at, x, noise, softer, same, _STEPS).x
            other = fitted(at, x, noise, scatter, SAME_TIME, _STEPS)
            fit = other if other.objective < fit.objective else fit
        value = -math.inf
        if math.isfinite(fit.objective):
            with suppress(np.linalg.LinAlgError):  # a half cycle of which too little is left tells no state
                value = ForcedPosterior(at, fit, noise).ln_evidence
        tried[ln], best, least, x = (fit, value), max(best, value), min(least, fit.objective), fit.x
        ln, step = ln + step, min(max(grows * step, -_COARSE), _COARSE)
    return tried


def _quantiles(tried: dict[float, tuple[Fit, float]]) -> tuple[IntervalEstimate, float, float]:
    """Return the interval of friction, what it is at least, and the share above all that were tried."""
    at = np.array(sorted(each for each, (_, value) in tried.items() if math.isfinite(value)))
    values = np.array([tried[each][1] for each in at])
    fine = np.linspace(at[0], at[-1], 20001)
    density = np.exp(PchipInterpolator(at, values - values.max())(fine))  # Eq. 286
    share = np.cumsum(density) * (fine[1] - fine[0])
    share = np.append(share, share[-1] + density[-1] * (math.log(_MOST) - at[-1]))
    ends = np.exp(np.interp(LEVELS, share / share[-1], np.append(fine, math.log(_MOST))))
    below = np.flatnonzero(density[: density.argmax()] < _UNLIKELY)
    lowest = math.exp(fine[below[-1] if below.size else 0])
    return IntervalEstimate(*(float(each) for each in ends)), lowest, float(1.0 - share[-2] / share[-1])
