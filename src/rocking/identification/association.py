"""Assignment of measured times to impacts, and the posterior of these impacts.

An extended Kalman filter advances hypotheses from one measured time to the next. A beam search keeps the best
hypotheses. The closed form for slender bodies is sufficiently accurate here.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.identification import state_space
from rocking.identification.measurement import ImpactTimes
from rocking.identification.posterior import Knowledge, Noise, Posterior, posterior, rescaled
from rocking.identification.state_space import MEAN, SHARED, SPEED, Clicks, Model

KEPT: Final = 300
_HEARD, _FALSE_SHARE = 0.9, 0.2  # expected fraction of audible impacts; expected fraction of false times
_BOUNCE, _BOUNCES = 0.045, 6.0  # duration of bounces after an impact [s]; rate of clicks in this duration [1/s]
_SHORTEST, _MOST_IMPACTS, _GATE = 0.03, 80, 4.5
_SCATTER = 0.03
_WORTH = 4.0  # usual log likelihood ratio of a time that is an impact
_FIRST, _SECOND = 6, 5
_LONGEST = 3.5  # p T / 2 of a body close to overturning


@dataclass(frozen=True, eq=False)
class Track:
    """A selection of the times that are impacts."""

    clicks: IntArray  # indices of the times
    impacts: IntArray  # impact numbers, which start at zero; a missing number is a missed impact
    score: float  # log likelihood ratio relative to unrelated times
    bounces: int  # number of times shortly after impacts
    within: int  # number of times from the first to the last impact


@dataclass(eq=False)
class _Beam:
    """Hypotheses in rows. The state is: time, ln y after the last impact, ln r, alternation of ln r, ln p."""

    mean: FloatArray  # mean of the state, shape (h, 5)
    covariance: FloatArray  # covariance of the state, shape (h, 5, 5)
    number: IntArray  # number of the last impact
    last: IntArray  # index of the last matched time
    missed: IntArray  # number of missed impacts since the last matched time
    score: FloatArray
    of_click: IntArray  # impact number of each click, -1 for no impact; shape (h, clicks)
    bounces: IntArray

    def selected(self, indices: IntArray) -> "_Beam":
        return _Beam(*(value[indices] for value in vars(self).values()))

    def concatenated(self, other: "_Beam") -> "_Beam":
        return _Beam(*(np.concatenate(pair) for pair in zip(vars(self).values(), vars(other).values(), strict=True)))


def associate(
    times: FloatArray,
    probabilities: FloatArray,
    noise: float,
    ln_p: tuple[float, float],
    alternation: tuple[float, float],
) -> Track | None:
    """Return the most likely track, or None without a track."""
    # probabilities: probability that each time is an impact [-]; ln_p, alternation: mean and standard deviation
    generic = np.log(_FALSE_SHARE * times.size / (times[-1] - times[0]))
    gain = (
        np.log(probabilities) - np.log1p(-np.minimum(probabilities, 0.98)) - np.log(0.98 / 0.02)
    )  # zero if all times are certain
    following = np.searchsorted(times, times + _BOUNCE, side="right") - np.arange(1, times.size + 1)
    bounce = max(np.log(_BOUNCES) - generic, 0.0)
    beam = _started(times, noise, ln_p, alternation)
    explained = gain + bounce * np.minimum(following, 2)
    beam.score += np.array([explained[row >= 0].sum() for row in beam.of_click])
    best, best_score = None, -np.inf
    for _ in range(_MOST_IMPACTS):
        if top := beam.score.size:
            top = int(np.argmax(beam.score))
            if beam.missed[top] == 0 and beam.score[top] > best_score:
                best, best_score = beam.selected(np.array([top])), float(beam.score[top])
        advanced = _advanced(beam)
        if not advanced.score.size:
            break
        spread = np.sqrt(advanced.covariance[:, 0, 0] + noise**2)
        deviations = times - advanced.mean[:, :1]
        since = times[advanced.last][:, None]
        # the duration of a long half cycle is uncertain, but not short
        later = times - since > np.maximum(_SHORTEST, 0.5 * (advanced.mean[:, :1] - since))
        rows, click = np.nonzero((np.abs(deviations) < _GATE * spread[:, None]) & later)
        heard = _updated(advanced.selected(rows), times[click], noise)
        innovation = deviations[rows, click] / spread[rows]
        heard.score += np.log(_HEARD) - 0.5 * innovation**2 - np.log(spread[rows] * np.sqrt(2.0 * np.pi)) - generic
        heard.score += explained[click]
        heard.bounces = heard.bounces + following[click]
        heard.last, heard.missed = click, np.zeros_like(click)
        heard.of_click[np.arange(click.size), click] = heard.number
        advanced.score += np.log(1.0 - _HEARD)
        advanced.missed = advanced.missed + 1
        # at most two successive impacts can be missed, and no impact after the last time
        silent = advanced.selected(np.flatnonzero((advanced.missed <= 2) & (advanced.mean[:, 0] < times[-1])))
        beam = heard.concatenated(silent)
        # tracks with equal impact counts can end at different times, so each skipped time has a cost
        beam = beam.selected(np.argsort(_WORTH * beam.last - beam.score, kind="stable")[:KEPT])
        if not beam.score.size:
            break
    if best is None or (best.of_click >= 0).sum() < 3:
        return None
    clicks = np.flatnonzero(best.of_click[0] >= 0)
    return Track(clicks, best.of_click[0][clicks], best_score, int(best.bounces[0]), int(clicks[-1] - clicks[0] + 1))


def _started(times: FloatArray, noise: float, ln_p: tuple[float, float], alternation: tuple[float, float]) -> _Beam:
    """Return a hypothesis for every pair of early times as the first two impacts."""
    pairs = [(i, j) for i in range(_FIRST) for j in range(i + 1, i + _SECOND) if j < times.size]
    first, second = np.array(pairs + pairs).T
    silent = np.repeat([0, 1], len(pairs))  # number of missed impacts between the first two times
    half = 0.5 * np.exp(ln_p[0]) * (times[second] - times[first]) * np.where(silent, 0.47, 1.0)
    y = np.tanh(half)
    slope = np.where(half > 1e-6, half * (1.0 - y * y) / y, 1.0)  # slope of ln y over ln(p T)
    count, mean = silent.size, np.zeros((silent.size, 5))
    sign = np.where(silent, 1.0, -1.0)
    mean[:, 0], mean[:, 1], mean[:, 4] = times[second], np.log(y) - 0.1 + sign * alternation[0], ln_p[0]
    mean[:, 2], mean[:, 3] = -0.1, alternation[0]
    covariance = np.zeros((count, 5, 5))
    by_time = slope / (times[second] - times[first])
    covariance[:, 0, 0] = noise**2
    covariance[:, 0, 1] = covariance[:, 1, 0] = by_time * noise**2
    covariance[:, 2, 2], covariance[:, 3, 3], covariance[:, 4, 4] = 0.1**2, alternation[1] ** 2, ln_p[1] ** 2
    prior_variance = 0.1**2 + alternation[1] ** 2 + _SCATTER**2 + (slope * ln_p[1]) ** 2
    covariance[:, 1, 1] = 2.0 * (by_time * noise) ** 2 + prior_variance
    covariance[:, 1, 2] = covariance[:, 2, 1] = 0.1**2
    covariance[:, 1, 3] = covariance[:, 3, 1] = sign * alternation[1] ** 2
    covariance[:, 1, 4] = covariance[:, 4, 1] = slope * ln_p[1] ** 2
    of_click = np.full((count, times.size), -1)
    of_click[np.arange(count), first], of_click[np.arange(count), second] = 0, 1 + silent
    zero, score = np.zeros(count, dtype=np.int64), np.log(1.0 - _HEARD) * silent
    begun = _Beam(mean, covariance, zero + 1 + silent, second, zero, score, of_click, zero)
    return begun.selected(np.flatnonzero((half < _LONGEST) & (times[second] - times[first] > _SHORTEST)))


def _advanced(beam: _Beam) -> _Beam:
    """Return the states at the next impact, without intervals that are too short to resolve."""
    y = np.exp(np.minimum(beam.mean[:, 1], np.log(0.9999)))
    scaled, p = 2.0 * np.arctanh(y), np.exp(beam.mean[:, 4])
    step = np.zeros_like(beam.covariance)
    step[:] = np.eye(5)
    step[:, 0, 1], step[:, 0, 4] = 2.0 * y / (1.0 - y * y) / p, -scaled / p
    sign = np.where(beam.number % 2 == 0, -1.0, 1.0)
    step[:, 1, 2], step[:, 1, 3] = 1.0, sign
    mean = np.einsum("hij,hj->hi", step, beam.mean)
    mean[:, 0] = beam.mean[:, 0] + scaled / p
    covariance = step @ beam.covariance @ step.transpose(0, 2, 1)
    covariance[:, 1, 1] += _SCATTER**2
    moved = _Beam(
        mean, covariance, beam.number + 1, beam.last, beam.missed, beam.score.copy(), beam.of_click, beam.bounces
    )
    apart = (scaled / p > _SHORTEST) & (scaled / p > 2.5 * np.sqrt(covariance[:, 0, 0]))
    return moved.selected(np.flatnonzero(apart))


def _updated(beam: _Beam, heard: FloatArray, noise: float) -> _Beam:
    """Return the states after the measured time of the impact."""
    spread = beam.covariance[:, 0, 0] + noise**2
    weight = beam.covariance[:, :, 0] / spread[:, None]
    beam.mean = beam.mean + weight * (heard - beam.mean[:, 0])[:, None]
    beam.covariance = beam.covariance - weight[:, :, None] * beam.covariance[:, None, 0, :]
    return beam


UNKNOWN_NOISE = Noise(3e-4, 1.2)
"""Prior of the noise of times without a stated standard deviation [s]."""

_USUAL = 0.9
# smallest number of remaining times; largest standardized residual of an impact [-]
_FEWEST, _LARGEST_RESIDUAL = 5, 2.2
_NO_IMPACT = float(np.log((1.0 - _HEARD) * _BOUNCES / _HEARD))
"""Prior log odds, per second, of a missed impact and a detected bounce."""


def fit_times(measurement: ImpactTimes, prior: Knowledge) -> tuple[Track, Posterior] | None:
    """Return the impacts among the times, and their posterior; None for fewer than three impacts."""
    probabilities = (
        np.full(measurement.times.size, 0.98) if measurement.probabilities is None else measurement.probabilities
    )
    noise = UNKNOWN_NOISE if measurement.sigma is None else Noise(measurement.sigma)
    guess = max(2.0 * noise.median, 1e-3) if noise.dispersion else noise.median
    tracks = [
        (track, frequency)
        for frequency in prior.frequencies
        if (track := associate(measurement.times, probabilities, guess, frequency, prior.alternation))
    ]
    if not tracks:
        return None
    track, frequency = max(tracks, key=lambda pair: pair[0].score)
    fit, observer = _fitted(track, measurement.times, prior, noise, frequency)
    while fit.no_scatter < 0.5 and track.clicks.size > _FEWEST:
        # a bounce that is used as an impact can cause an apparent scatter of r
        sizes = np.abs(fit.standardized_residuals(observer))[1:]  # the first time is kept for the foot
        if sizes.max() < _LARGEST_RESIDUAL:
            break
        worst = int(np.argmax(sizes)) + 1
        fewer = replace(track, clicks=np.delete(track.clicks, worst), impacts=np.delete(track.impacts, worst))
        refitted, fewer_clicks = _fitted(fewer, measurement.times, prior, noise, frequency)
        if refitted.evidence + _NO_IMPACT <= fit.evidence:  # Eq. 326
            break
        track, fit, observer = fewer, refitted, fewer_clicks
    return track, fit


def _fitted(
    track: Track, all_times: FloatArray, prior: Knowledge, noise: Noise, frequency: tuple[float, float]
) -> tuple[Posterior, Clicks]:
    times = all_times[track.clicks]
    observer = Clicks(times, track.impacts - track.impacts[0])
    speeds = speeds_between(times, observer.impacts, prior, frequency[0])
    model = prior.model(prior.sides(speeds.size), float(times[0]), speeds, frequency)
    return posterior(model, observer, None, noise, lambda s: start(model, speeds, s)), observer


def speeds_between(times: FloatArray, impacts: IntArray, prior: Knowledge, ln_p: float) -> FloatArray:
    """Return approximate ln of the speed after each impact except the last; p is assumed equal for both feet."""
    alpha, p = np.array(prior.slenderness_angles), np.exp(ln_p)
    y = np.tanh(np.geomspace(1e-3, 5.0, 400))
    pieces: list[FloatArray] = []
    for time, gap in zip(np.diff(times), np.diff(impacts), strict=True):
        # missed impacts between two times have about the usual coefficient
        durations = state_space.duration(y * _USUAL ** np.arange(gap)[:, None], np.array(alpha.mean())) / p
        lengths = np.array([np.interp(time, durations.sum(axis=0), row) for row in durations])
        pieces.append(time * lengths / lengths.sum())
    intervals = np.concatenate(pieces)
    alphas = alpha[prior.sides(intervals.size)]
    y = np.minimum(state_space.speed(p * intervals, alphas), 0.999)
    return np.asarray(np.log(y * p * state_space.overturning_speed(alphas)))


def start(model: Model, speeds: FloatArray, scatters: FloatArray) -> FloatArray:
    """Return unknowns that give approximately the speeds, for each scatter."""
    u = np.zeros(model.size)
    changes = np.diff(speeds)
    mean = float(np.median(changes)) if changes.size else float(model.mean[MEAN])
    u[SPEED] = (speeds[0] - model.mean[SPEED]) / model.deviation[SPEED]
    u[MEAN] = (mean - model.mean[MEAN]) / model.deviation[MEAN]
    u[len(SHARED) :] = changes - mean
    return rescaled(u, 1.0, scatters)
