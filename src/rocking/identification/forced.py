"""Identification from a rotation under a known ground motion."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FEET, FloatArray, Foot
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.fast_engine import run
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError
from rocking.identification import forced_friction, forced_start
from rocking.identification.forced_model import (
    CLOCK,
    GAIN,
    HALF,
    HEIGHT,
    MEAN,
    SAME_TIME,
    SIZE,
    TILT,
    TREND,
    WIDTH,
    Forced,
    fitted,
)
from rocking.identification.forced_posterior import ForcedPosterior
from rocking.identification.measurement import ImpactTimes, RotationSeries
from rocking.identification.next_impacts import NextImpacts
from rocking.identification.posterior import Knowledge
from rocking.identification.results import (
    ForcedRocking,
    Identification,
    Impact,
    IntervalEstimate,
    compared,
    estimated,
    impulses,
    mean_quantiles,
)
from rocking.messages import Message
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.pulse import Pulse

_OF_PULSE = 400
_GUESS = 0.02  # initial value of the scatter
_MOST_SCATTER, _ADVANTAGE = 0.12, 5.0
_CLOSE, _DIFFERENCE = 0.1, 1e-4
_ENDING, _CALM, _FAR = (
    0.5,
    0.02,
    3.0,
)  # duration [s] and fraction of the peak at the end of a record; number of standard deviations of a clock


def identify_forced(measurement: Any, prior: Knowledge, motion: Any, clock: Any) -> Identification | None:
    """Return the identification of a series, or None for fewer than three detected impacts."""
    if not isinstance(measurement, RotationSeries):
        kind = "times of impacts" if isinstance(measurement, ImpactTimes) else type(measurement).__name__
        raise InvalidValueError(
            "with a ground motion, the {parameter} must be {allowed}, got {type}", parameter="measurement",
            allowed="a rotation or an angular velocity (RotationSeries)", type=kind,
        )  # fmt: skip
    if measurement.from_acceleration:
        raise InvalidValueError(
            "with a ground motion, the measurement must be a rotation, an angular velocity or a displacement "
            "relative to the ground, got an acceleration, which includes the ground acceleration"
        )
    if prior.body is None:
        raise InvalidValueError("with a ground motion, the body is required: its slenderness angle determines uplift")
    if prior.damping:
        raise InvalidValueError("damping must be False with a ground motion: it applies to free rocking only")
    if is_pulse := isinstance(motion, Pulse):
        motion = motion.sampled(motion.duration / _OF_PULSE)
    checked_motion(motion)
    shift, error = (0.0, clock) if np.ndim(clock) == 0 else clock
    clock = checks.number("clock", shift, "s"), checks.within("standard deviation of clock", error, 0.0, 10.0, unit="s")
    posterior = fit_forced(measurement, prior, motion, clock)
    if posterior is None:
        return None
    identification = answer(*forced_friction.with_sliding(posterior), posterior)
    return replace(
        identification,
        doubts=(*identification.doubts, *_clock_doubts(identification, motion, clock, is_pulse=is_pulse)),
    )


def _clock_doubts(
    identification: Identification, motion: GroundMotion, clock: tuple[float, float], *, is_pulse: bool
) -> list[str]:
    """Return doubts about the times: a measurement after the end of the record, or an unexpected clock."""
    assert identification.forced is not None
    assert isinstance(identification.measurement, RotationSeries)
    doubts, ahead, last = [], identification.forced.clock.value, float(motion.time[-1])
    measured = float(identification.measurement.time[-1]) - ahead
    ends = np.abs(motion.acceleration[motion.time >= last - _ENDING]).max()
    if not is_pulse and measured > last + _ENDING and ends > _CALM * motion.peak:
        doubts.append(
            f"The ground motion ends at {last:.3g} s with strong shaking, the measurement ends at {measured:.3g} s. "
            "The ground is assumed at rest between these times. Check that the record is complete."
        )
    if abs(ahead - clock[0]) > _FAR * clock[1] > 0.0:
        doubts.append(
            f"The clock of the measurement is ahead by {ahead:.3g} s, but {clock[0]:g} +- {clock[1]:g} s was stated."
            " Half cycles may be matched with wrong parts of the record: check the clock."
        )
    return doubts


def fit_forced(
    series: RotationSeries, prior: Knowledge, motion: GroundMotion, clock: tuple[float, float]
) -> ForcedPosterior | None:
    """Return the posterior, or None for fewer than three detected impacts."""
    problem = forced_start.problem_of(series, prior, motion, clock)
    if clock[1] > forced_start.SURE:
        near = forced_start.best_clock(problem, clock), forced_start.SURE / 3.0
        problem = forced_start.problem_of(series, prior, motion, near)
    shared = problem.mean
    for _ in range(2):  # the second pass uses the fitted offset and drift
        first = forced_start.first_fit(problem, shared)
        if first is None:
            return None
        problem, fit, noise = first
        shared = fit.x[:SIZE]
    problem = replace(problem, middle=float(np.median(fit.x[SIZE + 1 :: 2][problem.excursions.joined])))
    guess = _GUESS
    for _ in range(2):
        fit = fitted(problem, fit.x, noise, guess, SAME_TIME)
        noise = forced_start.deviations(problem, fit)
        posterior = ForcedPosterior(problem, fit, noise)
        guess = max(posterior.likely_scatter.value, 1e-3)
    return posterior


def answer(
    posterior: ForcedPosterior, friction: IntervalEstimate, sliding_doubts: tuple[str, ...], holding: ForcedPosterior
) -> Identification:
    """Return the identification from a posterior; `holding` is the posterior without sliding."""
    problem, fit, noise = posterior.problem, posterior.fit, posterior.noise
    prior, body, series = problem.prior, problem.prior.body, problem.series
    assert body is not None
    by_side = {foot: posterior.shared((MEAN, 1.0), (HALF, 1.0 if foot == "right" else -1.0)) for foot in FEET}
    mean = posterior.shared((MEAN, 1.0))
    r, scatter = estimated(mean, 1.0), posterior.likely_scatter
    coefficients = {foot: estimated(mixture, 1.0) for foot, mixture in by_side.items()}
    shaken, resting = holding.problem, replace(holding.problem, motion=problem.motion.scaled(0.0))
    objective_at_rest, objective_under_motion = (
        fitted(forced, holding.fit.x, holding.noise, 1.0, None).objective for forced in (resting, shaken)
    )
    advantage = 0.5 * (objective_at_rest - objective_under_motion)
    refused, doubts = [], [*series.doubts, *sliding_doubts]
    if advantage < _ADVANTAGE:
        refused.append("the ground motion explains the rotation no better than ground at rest: check the clock")
    if mean.below(0.0) < 0.975:
        refused.append(Message("the impacts lose no energy: r is {coefficient}", {"coefficient": r}))
    if scatter.value > _MOST_SCATTER:
        refused.append(
            Message("the coefficient of restitution scatters by {share:.0f} %", {"share": 100.0 * scatter.value})
        )
    if problem.excluded:
        doubts.append(
            f"{problem.excluded} half cycles are excluded: rocking under this ground motion does not explain them."
        )
    if not fit.converged:
        doubts.append("The maximum of the posterior was not found. The intervals may be wrong.")
    sides = [body.side(foot) for foot in FEET]
    p = math.sqrt(math.prod(side.frequency_parameter for side in sides))
    half = 0.5 * float(np.mean([math.sin(side.slenderness_angle) ** 2 for side in sides]))
    at = np.concatenate([problem.samples[0], problem.rest_samples])
    order = np.argsort(at)
    residuals = np.concatenate([residual[order] for residual, _ in fit.terms.samples])
    noise_deviation = float(noise[0])
    return Identification(
        source=series.source, refused=tuple(refused), doubts=tuple(doubts), mean=r, coefficients=coefficients,
        scatter=scatter, no_scatter=posterior.no_scatter,
        frequency_parameter=estimated(posterior.shared((WIDTH, -half), (HEIGHT, half - 0.5)), p),
        tilt=estimated(posterior.shared((TILT, 1.0))),
        trend=estimated(posterior.shared((TREND, 1.0))) if prior.trend else None, damping=None,
        impacts=_impacts(posterior), residuals=residuals,
        noise=IntervalEstimate(noise_deviation, noise_deviation, noise_deviation),
        independent=float(residuals.size), p_value=math.nan, advantage=advantage, converged=fit.converged,
        impulse={} if refused else impulses(body, coefficients), models=() if refused else compared(body, r),
        _next=NextImpacts.of(mean, posterior.shared((HALF, 1.0)), by_side["right"], posterior.scatter, body),
        measurement=series, residual_times=np.tile(series.time[at[order]], len(problem.kinds)),
        designs=(), quantiles=mean_quantiles(mean), forced=_forced(posterior, friction),
        _common=posterior.explained(MEAN, (WIDTH, HEIGHT)),
    )  # fmt: skip


def _impacts(posterior: ForcedPosterior) -> tuple[Impact, ...]:
    """Return the coefficient of each impact."""
    problem, fit = posterior.problem, posterior.fit
    drawn, by = fit.terms.draws
    states, x, impacts = fit.x[SIZE:].reshape(-1, 2), fit.x, []
    for n, k in enumerate(np.flatnonzero(problem.excursions.joined)):
        sign = problem.excursions.sign[k]
        slopes = -by[n].copy()
        slopes[[MEAN, HALF]] = 0.0
        coefficient = estimated(posterior.distribution(slopes, float(drawn[n] + x[MEAN] + sign * x[HALF])), 1.0)
        foot: Foot = "right" if sign > 0.0 else "left"
        before = math.exp(states[k, 1]) / coefficient.value
        impacts.append(Impact(n, float(states[k, 0]), foot, before, coefficient))
    return tuple(impacts)


def _forced(posterior: ForcedPosterior, friction: IntervalEstimate) -> ForcedRocking:
    problem, fit = posterior.problem, posterior.fit
    excursions, kind = problem.excursions, problem.kinds[0]
    return ForcedRocking(
        clock=estimated(posterior.shared((CLOCK, 1.0))), gain=estimated(posterior.shared((GAIN + kind, 1.0)), 1.0),
        friction=friction, stretches=int(np.sum(~excursions.joined)), excluded_half_cycles=problem.excluded,
        used=float(np.sum(excursions.end - excursions.begin)), measured=float(np.ptp(problem.series.time)),
        predictable=_predictable_time(problem, fit.x),
    )  # fmt: skip


def _predictable_time(problem: Forced, x: FloatArray) -> float:
    """Return the time until a change of r by 1e-4 changes the response by 10 % of its peak [s]; NaN if never.

    The change is of first order, by the tangent dynamics.
    """
    body: Any = problem.prior.body
    settings, segments = PlaneSettings(), problem.motion.segments()
    nominal = RockingParameters.of_body(body, dict.fromkeys(FEET, 0.0), settings.gravity)
    sides = {}
    for foot, sign in (("right", 1.0), ("left", -1.0)):
        alpha, p, _ = problem.sides(sign, x[WIDTH], x[HEIGHT], x[TILT])
        sides[foot] = replace(
            getattr(nominal, foot), slenderness_angle=float(alpha), frequency_parameter=float(p),
            coefficient=math.exp(x[MEAN] + sign * x[HALF]),
        )  # fmt: skip
    parameters = RockingParameters(sides["right"], sides["left"], ConstantRestitution(), "")
    trajectory = run(parameters, segments, settings)
    response = Response(body, None, parameters, settings, segments, 1.0, 0, trajectory)
    change = _DIFFERENCE * math.exp(x[MEAN]) * response.tangent().by_parameter["restitution"][:, 0]
    apart = np.flatnonzero(np.abs(change) > _CLOSE * np.abs(response.rotation).max())
    return float(response.time[apart[0]]) if apart.size else math.nan
