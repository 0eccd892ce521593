"""Times of impacts: which of those heard are impacts, with which number, and the posterior of what they say.

Hypotheses are followed from time to time by an extended Kalman filter, the best of them are kept (a beam). The slender
closed form is close enough here.
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
_HEARD, _FALSE_SHARE = 0.9, 0.2  # of the impacts that are heard, of the times that are no impacts
_BOUNCE, _BOUNCES = 0.045, 6.0  # seconds after an impact, clicks a second there
_SHORTEST, _MOST_IMPACTS, _GATE = 0.03, 80, 4.5
_SCATTER = 0.03
_WORTH = 4.0  # of a time, as the logarithm of a likelihood ratio
_FIRST, _SECOND = 6, 5
_LONGEST = 3.5  # p T / 2: a body that just does not overturn


@dataclass(frozen=True, eq=False)
class Track:
    """The times that are impacts."""

    clicks: IntArray  # which of the times they are
    impacts: IntArray  # their numbers, from zero; a number that is left out was missed
    score: float  # ln of how much likelier it is than that nothing belongs together
    bounces: int  # times shortly after impacts
    within: int  # times from the first to the last impact


@dataclass(eq=False)
class _Beam:
    """Hypotheses side by side: of time, ln y after the last impact, ln r, alternation of ln r, ln p."""

    mean: FloatArray  # h, 5
    covariance: FloatArray  # h, 5, 5
    number: IntArray  # of the last impact
    last: IntArray  # the time that was matched last
    missed: IntArray  # impacts since
    score: FloatArray
    of_click: IntArray  # h, clicks: number of the impact, -1 none
    bounces: IntArray

    def taken(self, which: IntArray) -> "_Beam":
        return _Beam(*(value[which] for value in vars(self).values()))

    def joined(self, other: "_Beam") -> "_Beam":
        return _Beam(*(np.concatenate(pair) for pair in zip(vars(self).values(), vars(other).values(), strict=True)))


def associate(
    times: FloatArray, sure: FloatArray, noise: float, ln_p: tuple[float, float], alternation: tuple[float, float]
) -> Track | None:
    """Return the likeliest track, or None."""
    # sure: probability of each time to be an impact [-]; ln_p, alternation: mean and standard deviation
    generic = np.log(_FALSE_SHARE * times.size / (times[-1] - times[0]))
    gain = np.log(sure) - np.log1p(-np.minimum(sure, 0.98)) - np.log(0.98 / 0.02)  # nothing where all are sure
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
                best, best_score = beam.taken(np.array([top])), float(beam.score[top])
        taken = _advanced(beam)
        if not taken.score.size:
            break
        spread = np.sqrt(taken.covariance[:, 0, 0] + noise**2)
        off = times - taken.mean[:, :1]
        since = times[taken.last][:, None]
        # a long half cycle is hard to foretell, but it does not come out short
        later = times - since > np.maximum(_SHORTEST, 0.5 * (taken.mean[:, :1] - since))
        which, click = np.nonzero((np.abs(off) < _GATE * spread[:, None]) & later)
        heard = _updated(taken.taken(which), times[click], noise)
        innovation = off[which, click] / spread[which]
        heard.score += np.log(_HEARD) - 0.5 * innovation**2 - np.log(spread[which] * np.sqrt(2.0 * np.pi)) - generic
        heard.score += explained[click]
        heard.bounces = heard.bounces + following[click]
        heard.last, heard.missed = click, np.zeros_like(click)
        heard.of_click[np.arange(click.size), click] = heard.number
        taken.score += np.log(1.0 - _HEARD)
        taken.missed = taken.missed + 1
        # two may be missed after each other, and nothing is missed behind the last time
        silent = taken.taken(np.flatnonzero((taken.missed <= 2) & (taken.mean[:, 0] < times[-1])))
        beam = heard.joined(silent)
        # those of the same number of impacts have come differently far: what is passed over must not look cheap
        beam = beam.taken(np.argsort(_WORTH * beam.last - beam.score, kind="stable")[:KEPT])
        if not beam.score.size:
            break
    if best is None or (best.of_click >= 0).sum() < 3:
        return None
    clicks = np.flatnonzero(best.of_click[0] >= 0)
    return Track(clicks, best.of_click[0][clicks], best_score, int(best.bounces[0]), int(clicks[-1] - clicks[0] + 1))


def _started(times: FloatArray, noise: float, ln_p: tuple[float, float], alternation: tuple[float, float]) -> _Beam:
    """Every pair of early times as the first two impacts."""
    pairs = [(i, j) for i in range(_FIRST) for j in range(i + 1, i + _SECOND) if j < times.size]
    first, second = np.array(pairs + pairs).T
    silent = np.repeat([0, 1], len(pairs))  # impacts between them that were missed
    half = 0.5 * np.exp(ln_p[0]) * (times[second] - times[first]) * np.where(silent, 0.47, 1.0)
    y = np.tanh(half)
    slope = np.where(half > 1e-6, half * (1.0 - y * y) / y, 1.0)  # of ln y over ln(p T)
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
    return begun.taken(np.flatnonzero((half < _LONGEST) & (times[second] - times[first] > _SHORTEST)))


def _advanced(beam: _Beam) -> _Beam:
    """To the next impact, of those that can still be told apart."""
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
    taken = _Beam(
        mean, covariance, beam.number + 1, beam.last, beam.missed, beam.score.copy(), beam.of_click, beam.bounces
    )
    apart = (scaled / p > _SHORTEST) & (scaled / p > 2.5 * np.sqrt(covariance[:, 0, 0]))
    return taken.taken(np.flatnonzero(apart))


def _updated(beam: _Beam, heard: FloatArray, noise: float) -> _Beam:
    """With the time of the impact known."""
    spread = beam.covariance[:, 0, 0] + noise**2
    weight = beam.covariance[:, :, 0] / spread[:, None]
    beam.mean = beam.mean + weight * (heard - beam.mean[:, 0])[:, None]
    beam.covariance = beam.covariance - weight[:, :, None] * beam.covariance[:, None, 0, :]
    return beam


UNKNOWN_NOISE = Noise(3e-4, 1.2)
"""Of times whose reader does not say how sure they are [s]."""

_USUAL = 0.9
_FEWEST, _LARGEST_RESIDUAL = 5, 2.2  # times that remain; standardized residual of an impact [-]
_NO_IMPACT = float(np.log((1.0 - _HEARD) * _BOUNCES / _HEARD))
"""Ln of how much likelier it is a priori, for each second, that an impact was missed and a bounce heard."""


def fit_times(measurement: ImpactTimes, known: Knowledge) -> tuple[Track, Posterior] | None:
    """Return the impacts among the times, and what they say; None if no three of them belong together."""
    sure = np.full(measurement.times.size, 0.98) if measurement.probabilities is None else measurement.probabilities
    noise = UNKNOWN_NOISE if measurement.sigma is None else Noise(measurement.sigma)
    guess = max(2.0 * noise.median, 1e-3) if noise.dispersion else noise.median
    tracks = [
        (track, frequency)
        for frequency in known.frequencies
        if (track := associate(measurement.times, sure, guess, frequency, known.alternation))
    ]
    if not tracks:
        return None
    track, frequency = max(tracks, key=lambda pair: pair[0].score)
    found, observer = _fitted(track, measurement.times, known, noise, frequency)
    while found.no_scatter < 0.5 and track.clicks.size > _FEWEST:
        # r seems to scatter: perhaps only since a bounce was taken for an impact that was missed
        sizes = np.abs(found.standardized_residuals(observer))[1:]  # the first time fixes the foot: it is kept
        if sizes.max() < _LARGEST_RESIDUAL:
            break
        worst = int(np.argmax(sizes)) + 1
        fewer = replace(track, clicks=np.delete(track.clicks, worst), impacts=np.delete(track.impacts, worst))
        refitted, fewer_clicks = _fitted(fewer, measurement.times, known, noise, frequency)
        if refitted.evidence + _NO_IMPACT <= found.evidence:  # Eq. 326
            break
        track, found, observer = fewer, refitted, fewer_clicks
    return track, found


def _fitted(
    track: Track, all_times: FloatArray, known: Knowledge, noise: Noise, frequency: tuple[float, float]
) -> tuple[Posterior, Clicks]:
    times = all_times[track.clicks]
    observer = Clicks(times, track.impacts - track.impacts[0])
    speeds = speeds_between(times, observer.impacts, known, frequency[0])
    model = known.model(known.sides(speeds.size), float(times[0]), speeds, frequency)
    return posterior(model, observer, None, noise, lambda s: start(model, speeds, s)), observer


def speeds_between(times: FloatArray, impacts: IntArray, known: Knowledge, ln_p: float) -> FloatArray:
    """Return ln of the speed after every impact but the last, roughly; p is the same over both feet."""
    alpha, p = np.array(known.slenderness_angles), np.exp(ln_p)
    y = np.tanh(np.geomspace(1e-3, 5.0, 400))
    found: list[FloatArray] = []
    for time, gap in zip(np.diff(times), np.diff(impacts), strict=True):
        # impacts between them were missed, each of which took about as much
        each = state_space.duration(y * _USUAL ** np.arange(gap)[:, None], np.array(alpha.mean())) / p
        shares = np.array([np.interp(time, each.sum(axis=0), one) for one in each])
        found.append(time * shares / shares.sum())
    intervals = np.concatenate(found)
    alphas = alpha[known.sides(intervals.size)]
    y = np.minimum(state_space.speed(p * intervals, alphas), 0.999)
    return np.asarray(np.log(y * p * state_space.overturning_speed(alphas)))


def start(model: Model, speeds: FloatArray, scatters: FloatArray) -> FloatArray:
    """Return unknowns that lead to such speeds, for each scatter."""
    u = np.zeros(model.size)
    changes = np.diff(speeds)
    mean = float(np.median(changes)) if changes.size else float(model.mean[MEAN])
    u[SPEED] = (speeds[0] - model.mean[SPEED]) / model.deviation[SPEED]
    u[MEAN] = (mean - model.mean[MEAN]) / model.deviation[MEAN]
    u[len(SHARED) :] = changes - mean
    return rescaled(u, 1.0, scatters)
