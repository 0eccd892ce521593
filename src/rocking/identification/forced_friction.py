"""Coefficient of friction from half cycles with sliding. All other unknowns are fitted for each tried coefficient.

Friction has no moment about the foot, so an impact hardly depends on friction. The half cycle after the impact depends
on friction. Therefore slip is computed through impacts.
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

_LIFTS, _MOST = 0.95, 2.0  # range of the coefficient: lower end / uplift limit; upper end
_HIGHER, _COARSE = 1.3, 0.06  # first value / friction demand; largest step of ln of the coefficient
_FIRST, _GROWS, _LONGEST = 0.4, 1.25, 0.05  # first step / standard deviation; ratio of successive steps; largest step
_LARGE = 0.1  # scatter above which a fit without sliding is poor
_SAME = 1e-9  # tolerance of ln of the coefficient
_STEPS = 15  # largest number of steps of a fit near its minimum
# largest decrease of ln of the evidence; increase of the objective that requires another fit
_EXCLUDED, _ROSE = 12.0, 6.0
_UNLIKELY = math.exp(-0.5 * 1.645**2)  # ratio of the density at a one-sided 95 % bound to its maximum
_SURE, _PERHAPS = 0.975, 0.25  # probabilities of sliding for a certain and for a possible result
_ROUNDS = 3


def with_sliding(posterior: ForcedPosterior) -> tuple[ForcedPosterior, IntervalEstimate, tuple[str, ...]]:
    """Return the posterior (with sliding feet if the evidence requires sliding), the friction, and doubts.

    If friction is not identified, only the lower end of its interval is a number.
    """
    problem, noise, scatter = (
        _from_midpoints(posterior.problem),
        posterior.noise,
        max(posterior.likely_scatter.value, 1e-3),
    )
    lifts = min(width / height for width, height in zip(*problem.believed[:2], strict=True))
    min_ln_friction = math.log(_LIFTS * lifts)
    top = max(
        math.log(_HIGHER * min(posterior.problem.demand(posterior.fit.x), 0.5 * _MOST)), min_ln_friction + _COARSE
    )
    far = (
        math.inf if posterior.problem.excluded or scatter > _LARGE else 3.0 * _EXCLUDED
    )  # a fit without sliding is poor
    fits = _continued_fits(
        problem,
        _initial_unknowns(problem, posterior),
        (noise, scatter),
        (top, -_COARSE, 1.0),
        (min_ln_friction, top, far),
    )
    if top > math.log(_MOST) or sum(math.isfinite(value) for _, value in fits.values()) < 2:
        return (
            posterior,
            IntervalEstimate(math.nan, math.exp(min_ln_friction), math.nan),
            ("Sliding was not analysed.",),
        )
    _, lowest, above = _quantiles(fits)
    if above < _PERHAPS:
        fit = max(fits.values(), key=lambda pair: pair[1])[0]
        for _ in range(_ROUNDS):
            near = sliding(problem, fit.x[FRICTION], 1.0)
            fit = fitted(near, fit.x, noise, scatter, SAME_TIME)
            noise = forced_start.deviations(near, fit)
            slid = ForcedPosterior(near, fit, noise)
            scatter = max(slid.likely_scatter.value, 1e-3)
        ln, mixture = min(max(float(fit.x[FRICTION]), min_ln_friction), top), slid.shared((FRICTION, 1.0))
        step, fits = min(_FIRST * mixture.deviation, _LONGEST), {}
        for by in (-step, step):
            fits |= _continued_fits(
                problem, fit.x, (noise, scatter), (ln, by, _GROWS), (min_ln_friction, top, _EXCLUDED)
            )
        interval, lowest, above = _quantiles(fits)
        if above < 1.0 - _SURE:
            return slid, interval, ()
    holding = estimated(posterior.shared((MEAN, 1.0)), 1.0)
    r = math.exp(fits[min(fits, key=lambda friction: abs(friction - math.log(lowest)))][0].x[MEAN])
    doubt = (
        f"Sliding at impacts cannot be excluded. With a friction of {lowest:.2g} the feet slide and r is about "
        f"{r:.3g}. The stated r assumes no sliding."
    )
    return posterior, IntervalEstimate(math.nan, lowest, math.nan), () if holding.low <= r <= holding.high else (doubt,)


def sliding(problem: Forced, ln_friction: float, error: float = 0.0) -> Forced:
    """Return the problem with sliding feet and a coefficient of friction, which is known or has an error."""
    mean, deviation = problem.mean.copy(), problem.deviation.copy()
    mean[FRICTION], deviation[FRICTION] = ln_friction, error
    return replace(problem, slides=True, mean=mean, deviation=deviation)


def _from_midpoints(problem: Forced) -> Forced:
    """Return the problem with shorter half cycles: without a first impact, only the second half is used.

    Sliding feet are at rest at the start of this half.
    """
    excursions = problem.excursions
    first = np.where(excursions.joined, excursions.first, (excursions.first + excursions.last) // 2)
    begin = np.where(excursions.joined, excursions.begin, problem.series.time[first])
    return replace(problem, excursions=replace(excursions, first=first, begin=begin))


def _initial_unknowns(problem: Forced, posterior: ForcedPosterior) -> FloatArray:
    """Return the unknowns; the state of a shortened half cycle is the state at the middle of its time."""
    flights, begin = posterior.problem.flights(posterior.fit.x, np.zeros((1, SIZE + 2)))
    x, which = posterior.fit.x.copy(), np.flatnonzero(~problem.excursions.joined)
    x[SIZE:].reshape(-1, 2)[which] = np.stack(flights.at((problem.excursions.begin - begin[0])[which], which), axis=1)
    return x


def _continued_fits(
    problem: Forced,
    x: FloatArray,
    noise_and_scatter: tuple[FloatArray, float],
    steps: tuple[float, float, float],
    within: tuple[float, float, float],
) -> dict[float, tuple[Fit, float]]:
    """Return fits and ln of their evidence, by ln of a known friction; each fit begins at the previous fit.

    `noise_and_scatter` are those of the fits. `steps` are the start, the first step, and the ratio of successive steps.
    `within` are both ends, and the largest decrease of ln of the evidence.
    """
    (noise, scatter), (ln, step, grows), (lowest, highest, excluded) = noise_and_scatter, steps, within
    fits: dict[float, tuple[Fit, float]] = {}
    best, min_objective, value = -math.inf, math.inf, -math.inf
    while lowest - _SAME <= ln <= highest + _SAME and not value < best - excluded:
        at, x = sliding(problem, ln), x.copy()
        x[FRICTION] = ln
        fit = fitted(at, x, noise, scatter, SAME_TIME, _STEPS)
        if not fit.converged or fit.objective > min_objective + _ROSE:  # half cycles may be separated
            for softer, same in forced_start.ANNEALED:
                x = fitted(at, x, noise, softer, same, _STEPS).x
            other = fitted(at, x, noise, scatter, SAME_TIME, _STEPS)
            fit = other if other.objective < fit.objective else fit
        value = -math.inf
        if math.isfinite(fit.objective):
            with suppress(np.linalg.LinAlgError):  # too few samples cannot determine a state
                value = ForcedPosterior(at, fit, noise).ln_evidence
        fits[ln], best, min_objective, x = (fit, value), max(best, value), min(min_objective, fit.objective), fit.x
        ln, step = ln + step, min(max(grows * step, -_COARSE), _COARSE)
    return fits


def _quantiles(fits: dict[float, tuple[Fit, float]]) -> tuple[IntervalEstimate, float, float]:
    """Return the interval of friction, its lower bound, and the probability above the largest tried value."""
    at = np.array(sorted(ln for ln, (_, value) in fits.items() if math.isfinite(value)))
    values = np.array([fits[ln][1] for ln in at])
    fine = np.linspace(at[0], at[-1], 20001)
    density = np.exp(PchipInterpolator(at, values - values.max())(fine))  # Eq. 286
    share = np.cumsum(density) * (fine[1] - fine[0])
    share = np.append(share, share[-1] + density[-1] * (math.log(_MOST) - at[-1]))
    ends = np.exp(np.interp(LEVELS, share / share[-1], np.append(fine, math.log(_MOST))))
    below = np.flatnonzero(density[: density.argmax()] < _UNLIKELY)
    lowest = math.exp(fine[below[-1] if below.size else 0])
    return IntervalEstimate(*(float(end) for end in ends)), lowest, float(1.0 - share[-2] / share[-1])
