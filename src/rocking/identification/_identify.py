"""The front door: a measurement in, coefficients with intervals out."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.special import logsumexp, stdtr

from rocking.conventions import FEET, FloatArray, Foot, opposite
from rocking.errors import InvalidValueError
from rocking.identification.association import fit_times
from rocking.identification.design import Design, designs
from rocking.identification.forced import identify_forced
from rocking.identification.measurement import ImpactTimes, RotationSeries
from rocking.identification.posterior import LEVEL, Knowledge, Posterior, interval_of_nodes
from rocking.identification.results import (
    Identification,
    Impact,
    IntervalEstimate,
    compared,
    estimated,
    impulses,
    next_impact,
)
from rocking.identification.series import fit_series
from rocking.identification.state_space import DAMPING, FREQUENCY, HALF, MEAN, SHARED, SLENDERNESS, TILT, TREND
from rocking.messages import Message, Option
from rocking.motions.pulse import Motion

Reason = str | Message
_TREND = Message("try {trend}", {"trend": Option("identify.trend", True)})
_SHARE, _OF_ALL, _AFTER = 0.66, 0.5, 1.0  # of times; seconds, after which nobody hears the last impacts any more
_ADVANTAGE, _MOST_SCATTER, _UNLIKELY, _EXPLAINED = 5.0, 0.12, 1e-4, 0.9
_STRANGE, _FOREIGN = 4.0, 6.0  # standard deviations of p and the slenderness angle: doubted, refused


def identify(  # noqa: PLR0913 - what is known beside the measurement
    measurement: ImpactTimes | RotationSeries,
    body: Any = None,
    *,
    size_error: float = 0.01,
    tilt: float | Sequence[float] = LEVEL,
    asymmetry: float = 0.06,
    trend: bool = False,
    damping: bool = False,
    first: Foot = "right",
    motion: Motion | None = None,
    clock: float | Sequence[float] = 0.02,
) -> Identification:
    """Return what a measurement of rocking says about restitution: of free rocking, or under a known ground motion.

    Parameters
    ----------
    measurement : ImpactTimes or RotationSeries
        Times of impacts, of which some may be missing and some none; or rotations or angular velocities.
    body : Block, Section or MassPoints, optional
        The body. Without it the frequency parameter is fitted too, and intervals are wider.
    size_error : float
        Standard deviation of a length of the body, relative [-].
    tilt : float or (float, float)
        Standard deviation of the tilt of the floor, or tilt and standard deviation, clockwise; 0 of a level floor.
        It is the floor that makes times alone tell little about each side [rad].
    asymmetry : float
        Standard deviation of ln r landing right less ln r landing left; 0 if both are the same [-].
    trend, damping : bool
        Whether r may change with the speed, and whether damping between impacts is fitted.
    first : {"left", "right"}
        Foot on which the body stands after the first impact, of times, which do not tell.
    motion : GroundMotion or Pulse, optional
        How the ground moved under a body that stood at rest before; rotations are relative to the ground.
    clock : float or (float, float)
        Standard deviation of by how much the clock of the measurement is ahead of that of the motion, or that and
        its standard deviation [s].

    Returns
    -------
    Identification
        Coefficients, scatter, impacts, what they agree with; why it is refused, if it is no rocking.

    Raises
    ------
    InvalidValueError
        If the measurement or the body is none, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> times = [0.0, 1.2158, 2.2432, 3.1403, 3.9387, 4.6583, 5.3126, 5.9119, 6.4634]
    >>> found = identify(ImpactTimes(times, sigma=1e-3), rk.Block(width=1.0, height=4.0), tilt=0.0)
    >>> found.refused, 0.90 < found.mean.low < found.mean.high < 0.94
    ((), True)
    """
    known = Knowledge.of(body, size_error, tilt, asymmetry, trend=bool(trend), damping=bool(damping), first=first)
    if motion is not None:
        return identify_forced(measurement, known, motion, clock) or _nothing(
            measurement, "fewer than three impacts stand out of the noise"
        )
    if isinstance(measurement, ImpactTimes):
        return _of_times(measurement, known)
    if isinstance(measurement, RotationSeries):
        return _of_series(measurement, known)
    raise InvalidValueError(parameter="measurement", allowed="ImpactTimes or a RotationSeries", value=measurement)


def _of_times(measurement: ImpactTimes, known: Knowledge) -> Identification:
    found = fit_times(measurement, known)
    if found is None or found[0].clicks.size < 4:
        return _nothing(measurement, "fewer than four times belong together as impacts")
    (track, told), refused, doubts = found, list[Reason](), list[Reason](measurement.doubts)
    times = measurement.times[track.clicks]
    advantage = told.evidence - _steady(np.diff(times) / np.diff(track.impacts))
    missed, extra = int(np.ptp(track.impacts)) + 1 - track.impacts.size, track.within - track.clicks.size
    bounces = min(track.bounces, extra)
    outside = int(np.sum((measurement.times < times[0]) | (measurement.times > times[-1] + _AFTER)))
    share = times.size / (times.size + extra - bounces + missed)
    if share < _SHARE or times.size + bounces < _OF_ALL * (track.within + outside):
        refused.append(
            Message(
                "{count} of {total} times belong together, {missed} between them are missing",
                {"count": times.size, "total": measurement.times.size, "missed": missed},
            )
        )
    if advantage < _ADVANTAGE:
        refused.append("intervals do not shrink from impact to impact as those of a rocking body do")
    if missed:
        doubts.append(
            Message(
                "{count} impact was missed between the others.",
                {"count": missed},
                many="{count} impacts were missed between the others.",
            )
        )
    if extra:
        doubts.append(
            Message(
                "{count} time between the impacts is no impact; bounces or echoes: {bounces}.",
                {"count": extra, "bounces": bounces},
                many="{count} times between the impacts are no impacts; bounces or echoes: {bounces}.",
            )
        )
    if known.asymmetry and known.tilt_error:
        doubts.append("Times alone do not tell a tilted floor from sides that differ: intervals by side include both.")
    result = _result(
        measurement,
        known,
        told,
        known.first,
        refused,
        doubts,
        independent=float(times.size),
        advantage=advantage,
    )
    return replace(result, residual_times=times)


def _of_series(measurement: RotationSeries, known: Knowledge) -> Identification:
    found = fit_series(measurement, known)
    if found is None:
        return _nothing(measurement, "the rotation does not pass through its middle often enough")
    told, rows, independent = found
    parts = np.split(told.average(told.residuals), np.cumsum([row.values.size for row in rows])[:-1])
    missed = [part * row.scale for row, part in zip(rows, parts, strict=True)]
    about = [row.values - row.values.mean() for row in rows]
    total = max(float(a @ a) / float((b**2).sum()) for a, b in zip(missed, about, strict=True))
    refused: list[Reason] = []
    if total > 1.0 - _EXPLAINED:
        refused.append(Message("rocking explains {share:.0f} % of the motion only", {"share": 100.0 * (1.0 - total)}))
    first: Foot = "right" if told.model.sides[0] == 0 else "left"
    doubts: list[Reason] = [*measurement.doubts]
    far = float(np.linalg.norm(told.average(told.u)[[FREQUENCY, SLENDERNESS]]))
    if known.body is not None and far > _STRANGE:
        words = (
            f"it moves as a body of other sizes would, by {far:.2g} standard deviations of size_error; another clock?"
        )
        (refused if far > _FOREIGN else doubts).append(words)
    result = _result(measurement, known, told, first, refused, doubts, independent=independent, advantage=math.nan)
    return replace(result, residual_times=np.concatenate([row.time for row in rows]))


def _nothing(measurement: ImpactTimes | RotationSeries, why: str) -> Identification:
    none = IntervalEstimate(math.nan, math.nan, math.nan)
    sides: dict[Foot, IntervalEstimate] = dict.fromkeys(FEET, none)
    return Identification(
        measurement.source, (why,), measurement.doubts, none, sides, none, math.nan, none, none, None, None, (),
        np.zeros(0), none, 0.0, math.nan, math.nan, False, {}, (), (), {}, measurement,
    )  # fmt: skip


def _result(
    measurement: ImpactTimes | RotationSeries,
    known: Knowledge,
    found: Posterior,
    first: Foot,
    refused: list[Reason],
    doubts: list[Reason],
    *,
    independent: float,
    advantage: float,
) -> Identification:
    mean = found.shared((MEAN, 1.0))
    by_side = {foot: found.shared((MEAN, 1.0), (HALF, 1.0 if foot == "right" else -1.0)) for foot in FEET}
    coefficients = {foot: estimated(each, 1.0) for foot, each in by_side.items()}
    r, scattered = estimated(mean, 1.0), _of_grid(found, found.scatter)
    p_value = _steadiness(found)
    if mean.below(0.0) < 0.975:
        refused.append(Message("impacts take no energy: r is {coefficient}", {"coefficient": r}))
    if scattered.value > _MOST_SCATTER:
        refused.append(Message("what impacts take scatters by {share:.0f} %", {"share": 100.0 * scattered.value}))
    remedy = Message("check the sizes of the body, then {way}", {"way": _TREND}) if known.body is not None else _TREND
    trend = {"probability": p_value, "remedy": remedy}
    if p_value < _UNLIKELY and not known.trend:
        refused.append(
            Message(
                "the energy loss changes steadily with the number of impacts (p = {probability:.1g}); {remedy}", trend
            )
        )
    elif p_value < 0.01:
        doubts.append(
            Message("The energy loss changes with the number of impacts, p = {probability:.2g}: {remedy}.", trend)
        )
    if not found.converged:
        doubts.append("The maximum of the posterior was not found everywhere: intervals may be wrong.")
    frequency = math.sqrt(found.model.p[0] * found.model.p[1])
    body, alpha = known.body, found.model.alpha
    experiments: tuple[Design, ...] = ()
    if math.isfinite(r.value):
        p_error = float(found.model.deviation[FREQUENCY])
        noise = float(found.average(found.noise)) if isinstance(measurement, ImpactTimes) else 1e-3
        experiments = designs(
            math.sqrt(alpha[0] * alpha[1]), frequency, p_error, min(r.value, 0.999), scattered.value, noise
        )
    return Identification(
        source=measurement.source, refused=tuple(refused), doubts=tuple(doubts), mean=r, coefficients=coefficients,
        scatter=scattered, no_scatter=found.no_scatter,
        frequency_parameter=estimated(found.shared((FREQUENCY, 1.0)), frequency),
        tilt=estimated(found.shared((TILT, 1.0))),
        trend=estimated(found.shared((TREND, 1.0))) if known.trend else None,
        damping=estimated(found.shared((DAMPING, 1.0))) if known.damping else None,
        impacts=_impacts(found, first), residuals=found.average(found.residuals),
        noise=_of_grid(found, found.noise), independent=independent, p_value=p_value, advantage=advantage,
        converged=found.converged, impulse=impulses(body, coefficients) if body is not None and not refused else {},
        models=compared(body, r) if body is not None and not refused else (), designs=experiments,
        measurement=measurement, quantiles=next_impact(mean, 0.0),
        _common=found.explained(MEAN, (FREQUENCY, SLENDERNESS)),
        _next={foot: next_impact(each, found.scatter) for foot, each in by_side.items()},
    )  # fmt: skip


def _impacts(found: Posterior, first: Foot) -> tuple[Impact, ...]:
    """Return what every impact took of whose speeds before and after something is known."""
    best = int(np.argmax(found.weights))
    path = found.model.path(found.u[best : best + 1], found.scatter[best : best + 1])
    made, foot = [], first
    for number in range(1, found.model.sides.size):
        foot = opposite(foot)
        slopes = np.zeros_like(found.u)
        slopes[:, MEAN] = found.model.deviation[MEAN]
        slopes[:, HALF] = found.model.deviation[HALF] * (1.0 if foot == "right" else -1.0)
        slopes[:, TREND] = found.model.deviation[TREND] * (path.speeds[0, number - 1] - found.model.middle)
        slopes[:, len(SHARED) + number - 1] = found.scatter
        each = estimated(found.normal(slopes, float(found.model.mean[MEAN])), 1.0)
        speed = float(np.exp(path.speeds[0, number - 1]))
        made.append(Impact(number, float(path.times[0, number]), foot, speed, each))
    return tuple(made)


def _of_grid(found: Posterior, values: FloatArray) -> IntervalEstimate:
    """IntervalEstimate of the scatter or the noise, which the grid holds."""
    return IntervalEstimate(*interval_of_nodes(values, found.weights))


def _steadiness(found: Posterior) -> float:
    """Probability that draws change as steadily with their number as these, by Student's t."""
    draws = found.average(found.u[:, len(SHARED) :] * found.scatter[:, None])
    degrees = draws.size - 3
    if degrees < 2 or not np.ptp(draws) > 0.0:
        return 1.0
    r = float(np.corrcoef(draws, np.arange(draws.size))[0, 1])
    t = abs(r) * math.sqrt(degrees / max(1.0 - r * r, 1e-12))
    return float(2.0 * stdtr(degrees, -t))


def _steady(intervals: FloatArray) -> float:
    """Ln of the probability density of intervals whose logarithms are normal about one mean."""
    ln, n = np.log(intervals), intervals.size
    tau = np.geomspace(1e-3, 1.0, 60)
    about = float(((ln - ln.mean()) ** 2).sum())
    each = -0.5 * about / tau**2 - (n - 1) * np.log(tau * np.sqrt(2.0 * np.pi)) - 0.5 * np.log(n)
    return float(logsumexp(each) - np.log(tau.size) - np.log(np.log(20.0 / 0.02)) - ln.sum())  # Eq. 279
