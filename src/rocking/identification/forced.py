"""What a rotation under a known ground motion says of a body: the answer of `identify` for forced records."""

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
from rocking.identification.posterior import Knowledge
from rocking.identification.results import (
    ForcedRocking,
    Identification,
    Impact,
    IntervalEstimate,
    compared,
    estimated,
    impulses,
    next_impact,
)
from rocking.messages import Message
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.pulse import Pulse

_OF_PULSE = 400
_GUESS = 0.02  # of the scatter
_MOST_SCATTER, _ADVANTAGE = 0.12, 5.0
_CLOSE, _DIFFERENCE = 0.1, 1e-4
_ENDING, _CALM, _FAR = (
    0.5,
    0.02,
    3.0,
)  # seconds, over the peak: a record that ends at rest; standard deviations of a clock


def identify_forced(measurement: Any, known: Knowledge, motion: Any, clock: Any) -> Identification | None:
    """Return what a series says, or None if fewer than three impacts are seen."""
    if not isinstance(measurement, RotationSeries):
        what = "times of impacts" if isinstance(measurement, ImpactTimes) else type(measurement).__name__
        raise InvalidValueError(
            "under a motion the {parameter} must be {allowed}, got {type}", parameter="measurement",
            allowed="a rotation or an angular velocity (RotationSeries)", type=what,
        )  # fmt: skip
    if measurement.from_acceleration:
        raise InvalidValueError(
            "under a motion the measurement must be a rotation, an angular velocity or a displacement relative to the "
            "ground, got an acceleration, to which the ground adds its own"
        )
    if known.body is None:
        raise InvalidValueError("under a motion the body must be given: what lifts it is its slenderness angle")
    if known.damping:
        raise InvalidValueError("damping must be False under a motion: it is fitted to free rocking only")
    if whole := isinstance(motion, Pulse):
        motion = motion.sampled(motion.duration / _OF_PULSE)
    checked_motion(motion)
    shift, error = (0.0, clock) if np.ndim(clock) == 0 else clock
    clock = checks.number("clock", shift, "s"), checks.within("standard deviation of clock", error, 0.0, 10.0, unit="s")
    found = fit_forced(measurement, known, motion, clock)
    if found is None:
        return None
    said = answer(*forced_friction.with_sliding(found), found)
    return replace(said, doubts=(*said.doubts, *_of_clocks(said, motion, clock, whole=whole)))


def _of_clocks(said: Identification, motion: GroundMotion, clock: tuple[float, float], *, whole: bool) -> list[str]:
    """Return doubts about when it was measured: after the record, or by another clock than was said."""
    assert said.forced is not None
    assert isinstance(said.measurement, RotationSeries)
    doubts, ahead, last = [], said.forced.clock.value, float(motion.time[-1])
    measured = float(said.measurement.time[-1]) - ahead
    ends = np.abs(motion.acceleration[motion.time >= last - _ENDING]).max()
    if not whole and measured > last + _ENDING and ends > _CALM * motion.peak:
        doubts.append(
            f"The motion ends at {last:.3g} s while it still shakes, the measurement at {measured:.3g} s of its time: "
            "the ground is taken to stand still between; perhaps the record was cut off."
        )
    if abs(ahead - clock[0]) > _FAR * clock[1] > 0.0:
        doubts.append(
            f"The clock of the measurement is found to be ahead by {ahead:.3g} s, though {clock[0]:g} +- {clock[1]:g} "
            "s was said: perhaps half cycles are matched with the wrong shaking."
        )
    return doubts


def fit_forced(
    series: RotationSeries, known: Knowledge, motion: GroundMotion, clock: tuple[float, float]
) -> ForcedPosterior | None:
    """Return the posterior, or None if fewer than three impacts are seen."""
    problem = forced_start.problem_of(series, known, motion, clock)
    if clock[1] > forced_start.SURE:
        near = forced_start.sought(problem, clock), forced_start.SURE / 3.0
        problem = forced_start.problem_of(series, known, motion, near)
    shared = problem.mean
    for _ in range(2):  # the second one knows offset and drift
        first = forced_start.first_fit(problem, shared)
        if first is None:
            return None
        problem, fit, noise = first
        shared = fit.x[:SIZE]
    problem = replace(problem, middle=float(np.median(fit.x[SIZE + 1 :: 2][problem.seen.joined])))
    guess = _GUESS
    for _ in range(2):
        fit = fitted(problem, fit.x, noise, guess, SAME_TIME)
        noise = forced_start.deviations(problem, fit)
        found = ForcedPosterior(problem, fit, noise)
        guess = max(found.likely_scatter.value, 1e-3)
    return found


def answer(
    found: ForcedPosterior, friction: IntervalEstimate, also: tuple[str, ...], held: ForcedPosterior
) -> Identification:
    """Return what a posterior says, with the friction and doubts of it; held: the one with feet that hold."""
    problem, fit, noise = found.problem, found.fit, found.noise
    known, body, series = problem.known, problem.known.body, problem.series
    assert body is not None
    by_side = {foot: found.shared((MEAN, 1.0), (HALF, 1.0 if foot == "right" else -1.0)) for foot in FEET}
    mean = found.shared((MEAN, 1.0))
    r, scatter = estimated(mean, 1.0), found.likely_scatter
    coefficients = {foot: estimated(each, 1.0) for foot, each in by_side.items()}
    shaken, rest = held.problem, replace(held.problem, motion=problem.motion.scaled(0.0))
    still, alone = (fitted(each, held.fit.x, held.noise, 1.0, None).objective for each in (rest, shaken))
    advantage = 0.5 * (still - alone)
    refused, doubts = [], [*series.doubts, *also]
    if advantage < _ADVANTAGE:
        refused.append("the motion of the ground explains the rotation no better than ground at rest; another clock?")
    if mean.below(0.0) < 0.975:
        refused.append(Message("impacts take no energy: r is {coefficient}", {"coefficient": r}))
    if scatter.value > _MOST_SCATTER:
        refused.append(Message("what impacts take scatters by {share:.0f} %", {"share": 100.0 * scatter.value}))
    if problem.odd:
        doubts.append(f"{problem.odd} half cycles are none of rocking alone under this motion, and are left out.")
    if not fit.converged:
        doubts.append("The maximum of the posterior was not found: intervals may be wrong.")
    sides = [body.side(foot) for foot in FEET]
    p = math.sqrt(math.prod(side.frequency_parameter for side in sides))
    half = 0.5 * float(np.mean([math.sin(side.slenderness_angle) ** 2 for side in sides]))
    at = np.concatenate([problem.samples[0], problem.rest])
    order = np.argsort(at)
    residuals = np.concatenate([residual[order] for residual, _ in fit.terms.samples])
    one = float(noise[0])
    return Identification(
        source=series.source, refused=tuple(refused), doubts=tuple(doubts), mean=r, coefficients=coefficients,
        scatter=scatter, no_scatter=found.no_scatter,
        frequency_parameter=estimated(found.shared((WIDTH, -half), (HEIGHT, half - 0.5)), p),
        tilt=estimated(found.shared((TILT, 1.0))),
        trend=estimated(found.shared((TREND, 1.0))) if known.trend else None, damping=None,
        impacts=_impacts(found), residuals=residuals, noise=IntervalEstimate(one, one, one),
        independent=float(residuals.size), p_value=math.nan, advantage=advantage, converged=fit.converged,
        impulse={} if refused else impulses(body, coefficients), models=() if refused else compared(body, r),
        designs=(), _next={foot: next_impact(each, found.scatter) for foot, each in by_side.items()},
        measurement=series, residual_times=np.tile(series.time[at[order]], len(problem.kinds)),
        quantiles=next_impact(mean, 0.0), forced=_forced(found, friction),
        _common=found.explained(MEAN, (WIDTH, HEIGHT)),
    )  # fmt: skip


def _impacts(found: ForcedPosterior) -> tuple[Impact, ...]:
    """Return what every impact took."""
    problem, fit = found.problem, found.fit
    drawn, by = fit.terms.draws
    states, x, made = fit.x[SIZE:].reshape(-1, 2), fit.x, []
    for n, k in enumerate(np.flatnonzero(problem.seen.joined)):
        sign = problem.seen.sign[k]
        slopes = -by[n].copy()
        slopes[[MEAN, HALF]] = 0.0
        each = estimated(found.of(slopes, float(drawn[n] + x[MEAN] + sign * x[HALF])), 1.0)
        foot: Foot = "right" if sign > 0.0 else "left"
        before = math.exp(states[k, 1]) / each.value
        made.append(Impact(n, float(states[k, 0]), foot, before, each))
    return tuple(made)


def _forced(found: ForcedPosterior, friction: IntervalEstimate) -> ForcedRocking:
    problem, fit = found.problem, found.fit
    seen, kind = problem.seen, problem.kinds[0]
    return ForcedRocking(
        clock=estimated(found.shared((CLOCK, 1.0))), gain=estimated(found.shared((GAIN + kind, 1.0)), 1.0),
        friction=friction, stretches=int(np.sum(~seen.joined)), half_cycles_left_out=problem.odd,
        used=float(np.sum(seen.end - seen.begin)), measured=float(np.ptp(problem.series.time)),
        predictable=_foreseen(problem, fit.x),
    )  # fmt: skip


def _foreseen(problem: Forced, x: FloatArray) -> float:
    """Return until when a motion that begins at rest is told by r, though it differed by a ten-thousandth [s]."""
    body = problem.known.body
    parameters = RockingParameters.of_body(body, dict.fromkeys(FEET, 0.0), PlaneSettings().gravity)
    sides = {}
    for foot, sign in (("right", 1.0), ("left", -1.0)):
        alpha, p, _ = problem.sides(sign, x[WIDTH], x[HEIGHT], x[TILT])
        sides[foot] = replace(
            getattr(parameters, foot), slenderness_angle=float(alpha), frequency_parameter=float(p),
            coefficient=math.exp(x[MEAN] + sign * x[HALF]),
        )  # fmt: skip
    segments, rotations = problem.motion.segments(), []
    for factor in (1.0, 1.0 - _DIFFERENCE):
        both = {foot: replace(side, coefficient=side.coefficient * factor) for foot, side in sides.items()}
        made = RockingParameters(both["right"], both["left"], ConstantRestitution(), "")
        rotations.append(np.nan_to_num(run(made, segments, PlaneSettings()).rotation, nan=0.5 * math.pi))
    apart = np.flatnonzero(np.abs(rotations[0] - rotations[1]) > _CLOSE * np.abs(rotations[0]).max())
    return float(segments.step * apart[0]) if apart.size else math.nan
