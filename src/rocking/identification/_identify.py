"""The function `identify`: coefficients of restitution with intervals from a measurement."""

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
from rocking.identification.next_impacts import NextImpacts
from rocking.identification.posterior import LEVEL, Knowledge, Posterior, interval_of_nodes
from rocking.identification.results import (
    Identification,
    Impact,
    IntervalEstimate,
    compared,
    estimated,
    impulses,
    mean_quantiles,
)
from rocking.identification.series import fit_series
from rocking.identification.state_space import DAMPING, FREQUENCY, HALF, MEAN, SHARED, SLENDERNESS, TILT, TREND
from rocking.messages import Message, Option
from rocking.motions.pulse import Motion

Reason = str | Message
_TREND = Message("use {trend}", {"trend": Option("identify.trend", True)})
_MIN_FRACTION, _MIN_FRACTION_OF_ALL = 0.66, 0.5  # smallest fraction of the times that must be impacts
_FADED_AFTER = 1.0  # time after the last audible impact [s]
_MIN_ADVANTAGE, _MAX_SCATTER, _MIN_P_VALUE, _MIN_EXPLAINED = 5.0, 0.12, 1e-4, 0.9
_DOUBTED_SIZE, _REFUSED_SIZE = 4.0, 6.0  # limits in standard deviations of p and of the slenderness angle


def identify(  # noqa: PLR0913 - prior knowledge
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
    """Return the coefficient of restitution from measured rocking, free or under a known ground motion.

    Parameters
    ----------
    measurement : ImpactTimes or RotationSeries
        Times of impacts, possibly with missing and false impacts; or rotations or angular velocities.
    body : Block, Section or MassPoints, optional
        The body. Without a body, the frequency parameter is fitted too, and intervals are wider.
    size_error : float
        Relative standard deviation of a length of the body [-].
    tilt : float or (float, float)
        Standard deviation of the tilt of the floor, or tilt and standard deviation, clockwise; 0 for a level floor.
        If the tilt is unknown, times alone hardly determine the coefficient of each side [rad].
    asymmetry : float
        Standard deviation of the difference of ln r between both feet; 0 for equal coefficients [-].
    trend, damping : bool
        Fit a change of r with the speed, or the damping between impacts.
    first : {"left", "right"}
        Foot in contact after the first impact; for times only.
    motion : GroundMotion or Pulse, optional
        Ground motion of a body that is at rest before this motion; rotations are relative to the ground.
    clock : float or (float, float)
        Standard deviation of the time by which the clock of the measurement is ahead of the clock of the motion, or
        this time and its standard deviation [s].

    Returns
    -------
    Identification
        Coefficients, scatter, impacts, and agreeing models; for a refused measurement, the reasons.

    Raises
    ------
    InvalidValueError
        If the measurement or the body has another class, or a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> times = [0.0, 1.2158, 2.2432, 3.1403, 3.9387, 4.6583, 5.3126, 5.9119, 6.4634]
    >>> result = identify(ImpactTimes(times, sigma=1e-3), rk.Block(width=1.0, height=4.0), tilt=0.0)
    >>> result.refused, 0.90 < result.mean.low < result.mean.high < 0.94
    ((), True)
    """
    prior = Knowledge.checked(body, size_error, tilt, asymmetry, trend=bool(trend), damping=bool(damping), first=first)
    if motion is not None:
        return identify_forced(measurement, prior, motion, clock) or _refused(
            measurement, "fewer than three impacts are above the noise"
        )
    if isinstance(measurement, ImpactTimes):
        return _from_times(measurement, prior)
    if isinstance(measurement, RotationSeries):
        return _from_series(measurement, prior)
    raise InvalidValueError(parameter="measurement", allowed="ImpactTimes or a RotationSeries", value=measurement)


def _from_times(measurement: ImpactTimes, prior: Knowledge) -> Identification:
    fit = fit_times(measurement, prior)
    if fit is None or fit[0].clicks.size < 4:
        return _refused(measurement, "fewer than four times are impacts of one body")
    (track, posterior), refused, doubts = fit, list[Reason](), list[Reason](measurement.doubts)
    times = measurement.times[track.clicks]
    advantage = posterior.evidence - _log_density_at_constant_intervals(np.diff(times) / np.diff(track.impacts))
    missed, extra = int(np.ptp(track.impacts)) + 1 - track.impacts.size, track.within - track.clicks.size
    bounces = min(track.bounces, extra)
    outside = int(np.sum((measurement.times < times[0]) | (measurement.times > times[-1] + _FADED_AFTER)))
    share = times.size / (times.size + extra - bounces + missed)
    if share < _MIN_FRACTION or times.size + bounces < _MIN_FRACTION_OF_ALL * (track.within + outside):
        refused.append(
            Message(
                "only {count} of {total} times are impacts of one body, {missed} impacts between them are missing",
                {"count": times.size, "total": measurement.times.size, "missed": missed},
            )
        )
    if advantage < _MIN_ADVANTAGE:
        refused.append("the intervals do not decrease as those of a rocking body")
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
                "{count} recorded time between the first and the last impact is not an impact time; bounces or "
                "echoes: {bounces}.",
                {"count": extra, "bounces": bounces},
                many="{count} recorded times between the first and the last impact are not impact times; bounces or "
                "echoes: {bounces}.",
            )
        )
    if prior.asymmetry and prior.tilt_error:
        doubts.append("Times cannot distinguish a tilted floor from unequal sides. The intervals by side include both.")
    result = _result(
        measurement,
        prior,
        posterior,
        prior.first,
        refused,
        doubts,
        independent=float(times.size),
        advantage=advantage,
    )
    return replace(result, residual_times=times)


def _from_series(measurement: RotationSeries, prior: Knowledge) -> Identification:
    fit = fit_series(measurement, prior)
    if fit is None:
        return _refused(measurement, "the rotation crosses its middle fewer than three times")
    posterior, rows, independent = fit
    parts = np.split(posterior.average(posterior.residuals), np.cumsum([row.values.size for row in rows])[:-1])
    missed = [residuals * row.scale for row, residuals in zip(rows, parts, strict=True)]
    centred = [row.values - row.values.mean() for row in rows]
    unexplained = max(float(a @ a) / float((b**2).sum()) for a, b in zip(missed, centred, strict=True))
    refused: list[Reason] = []
    if unexplained > 1.0 - _MIN_EXPLAINED:
        refused.append(
            Message("rocking explains only {share:.0f} % of the motion", {"share": 100.0 * (1.0 - unexplained)})
        )
    first: Foot = "right" if posterior.model.sides[0] == 0 else "left"
    doubts: list[Reason] = [*measurement.doubts]
    size_deviation = float(np.linalg.norm(posterior.average(posterior.u)[[FREQUENCY, SLENDERNESS]]))
    if prior.body is not None and size_deviation > _DOUBTED_SIZE:
        size_message = (
            f"the motion is that of a body of another size, by {size_deviation:.2g} standard deviations of size_error: "
            "check the sizes and the clock"
        )
        (refused if size_deviation > _REFUSED_SIZE else doubts).append(size_message)
    result = _result(measurement, prior, posterior, first, refused, doubts, independent=independent, advantage=math.nan)
    return replace(result, residual_times=np.concatenate([row.time for row in rows]))


def _refused(measurement: ImpactTimes | RotationSeries, reason: str) -> Identification:
    no_estimate = IntervalEstimate(math.nan, math.nan, math.nan)
    sides: dict[Foot, IntervalEstimate] = dict.fromkeys(FEET, no_estimate)
    return Identification(
        measurement.source, (reason,), measurement.doubts, no_estimate, sides, no_estimate, math.nan, no_estimate,
        no_estimate, None, None, (),
        np.zeros(0), no_estimate, 0.0, math.nan, math.nan, False, {}, (), (), None, measurement,
    )  # fmt: skip


def _result(
    measurement: ImpactTimes | RotationSeries,
    prior: Knowledge,
    posterior: Posterior,
    first: Foot,
    refused: list[Reason],
    doubts: list[Reason],
    *,
    independent: float,
    advantage: float,
) -> Identification:
    mean = posterior.shared((MEAN, 1.0))
    by_side = {foot: posterior.shared((MEAN, 1.0), (HALF, 1.0 if foot == "right" else -1.0)) for foot in FEET}
    coefficients = {foot: estimated(mixture, 1.0) for foot, mixture in by_side.items()}
    r, scattered = estimated(mean, 1.0), _grid_interval(posterior, posterior.scatter)
    p_value = _trend_p_value(posterior)
    if mean.below(0.0) < 0.975:
        refused.append(Message("the impacts lose no energy: r is {coefficient}", {"coefficient": r}))
    if scattered.value > _MAX_SCATTER:
        refused.append(
            Message("the coefficient of restitution scatters by {share:.0f} %", {"share": 100.0 * scattered.value})
        )
    body = prior.body
    remedy = Message("check the sizes of the body, then {way}", {"way": _TREND}) if body is not None else _TREND
    trend = {"probability": p_value, "remedy": remedy}
    if p_value < _MIN_P_VALUE and not prior.trend:
        refused.append(
            Message(
                "the energy loss changes steadily with the number of impacts (p = {probability:.1g}); {remedy}", trend
            )
        )
    elif p_value < 0.01:
        doubts.append(
            Message("The energy loss changes with the number of impacts, p = {probability:.2g}: {remedy}.", trend)
        )
    if not posterior.converged:
        doubts.append("The maximum of the posterior was not found for all nodes. The intervals may be wrong.")
        if body is None:
            doubts.append(
                Message("State the size of the body: without the size, p and the slenderness angle are unknown.")
            )
    frequency, alpha = math.sqrt(posterior.model.p[0] * posterior.model.p[1]), posterior.model.alpha
    experiments: tuple[Design, ...] = ()
    if math.isfinite(r.value):
        p_error = float(posterior.model.deviation[FREQUENCY])
        noise = float(posterior.average(posterior.noise)) if isinstance(measurement, ImpactTimes) else 1e-3
        experiments = designs(
            math.sqrt(alpha[0] * alpha[1]), frequency, p_error, min(r.value, 0.999), scattered.value, noise
        )
    return Identification(
        source=measurement.source, refused=tuple(refused), doubts=tuple(doubts), mean=r, coefficients=coefficients,
        scatter=scattered, no_scatter=posterior.no_scatter,
        frequency_parameter=estimated(posterior.shared((FREQUENCY, 1.0)), frequency),
        tilt=estimated(posterior.shared((TILT, 1.0))),
        trend=estimated(posterior.shared((TREND, 1.0))) if prior.trend else None,
        damping=estimated(posterior.shared((DAMPING, 1.0))) if prior.damping else None,
        impacts=_impacts(posterior, first), residuals=posterior.average(posterior.residuals),
        noise=_grid_interval(posterior, posterior.noise), independent=independent, p_value=p_value, advantage=advantage,
        converged=posterior.converged, impulse=impulses(body, coefficients) if body is not None and not refused else {},
        models=compared(body, r) if body is not None and not refused else (), designs=experiments,
        measurement=measurement, quantiles=mean_quantiles(mean),
        _common=posterior.explained(MEAN, (FREQUENCY, SLENDERNESS)),
        _next=NextImpacts.of(mean, posterior.shared((HALF, 1.0)), by_side["right"], posterior.scatter, prior.body),
    )  # fmt: skip


def _impacts(posterior: Posterior, first: Foot) -> tuple[Impact, ...]:
    """Return the coefficient of each impact with known speeds before and after the impact."""
    best = int(np.argmax(posterior.weights))
    path = posterior.model.path(posterior.u[best : best + 1], posterior.scatter[best : best + 1])
    impacts, foot = [], first
    for number in range(1, posterior.model.sides.size):
        foot = opposite(foot)
        slopes = np.zeros_like(posterior.u)
        slopes[:, MEAN] = posterior.model.deviation[MEAN]
        slopes[:, HALF] = posterior.model.deviation[HALF] * (1.0 if foot == "right" else -1.0)
        slopes[:, TREND] = posterior.model.deviation[TREND] * (path.speeds[0, number - 1] - posterior.model.middle)
        slopes[:, len(SHARED) + number - 1] = posterior.scatter
        coefficient = estimated(posterior.normal(slopes, float(posterior.model.mean[MEAN])), 1.0)
        speed = float(np.exp(path.speeds[0, number - 1]))
        impacts.append(Impact(number, float(path.times[0, number]), foot, speed, coefficient))
    return tuple(impacts)


def _grid_interval(posterior: Posterior, values: FloatArray) -> IntervalEstimate:
    """Return median and 95 % interval of the scatter or the noise from the weights of the grid."""
    return IntervalEstimate(*interval_of_nodes(values, posterior.weights))


def _trend_p_value(posterior: Posterior) -> float:
    """Return the probability of an equal or steadier change of r with the impact number, by Student's t."""
    draws = posterior.average(posterior.u[:, len(SHARED) :] * posterior.scatter[:, None])
    degrees = draws.size - 3
    if degrees < 2 or not np.ptp(draws) > 0.0:
        return 1.0
    r = float(np.corrcoef(draws, np.arange(draws.size))[0, 1])
    t = abs(r) * math.sqrt(degrees / max(1.0 - r * r, 1e-12))
    return float(2.0 * stdtr(degrees, -t))


def _log_density_at_constant_intervals(intervals: FloatArray) -> float:
    """Return ln of the density of intervals whose logarithms are normal with one common mean."""
    ln, n = np.log(intervals), intervals.size
    tau = np.geomspace(1e-3, 1.0, 60)
    square_sum = float(((ln - ln.mean()) ** 2).sum())
    log_densities = -0.5 * square_sum / tau**2 - (n - 1) * np.log(tau * np.sqrt(2.0 * np.pi)) - 0.5 * np.log(n)
    return float(logsumexp(log_densities) - np.log(tau.size) - np.log(np.log(20.0 / 0.02)) - ln.sum())  # Eq. 279
