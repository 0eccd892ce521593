"""Times of impacts: which of them belong together, and the posterior of what they say."""

from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.identification import half_cycles
from rocking.identification.association import Track, associate
from rocking.identification.measurement import ImpactTimes
from rocking.identification.posterior import Noise, Posterior, posterior
from rocking.identification.prior import Knowledge
from rocking.identification.state_space import MEAN, SHARED, SPEED, Clicks, Model

UNKNOWN_NOISE = Noise(3e-4, 1.2)
"""Of times whose reader does not say how sure they are [s]."""

_USUAL = 0.9


@dataclass(frozen=True, eq=False)
class TimesFit:
    """The impacts among the times, and the posterior."""

    track: Track
    posterior: Posterior


def fit_times(measurement: ImpactTimes, known: Knowledge, scatter: float | None) -> TimesFit | None:
    """Return what impact times say, or None if no three of them belong together."""
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
    times = measurement.times[track.clicks]
    first = int(track.impacts[0])
    observer = Clicks(times, track.impacts - first)
    speeds = speeds_between(times, observer.impacts, known, frequency[0])
    model = known.model(known.sides(speeds.size), float(times[0]), speeds, frequency)
    return TimesFit(track, posterior(model, observer, scatter, noise, lambda s: start(model, speeds, s)))


def speeds_between(times: FloatArray, impacts: IntArray, known: Knowledge, ln_p: float) -> FloatArray:
    """Return ln of the speed after every impact but the last, roughly; p is the same over both feet."""
    alpha, p = np.array(known.slenderness_angles), np.exp(ln_p)
    y = np.tanh(np.geomspace(1e-3, 5.0, 400))
    found: list[FloatArray] = []
    for time, gap in zip(np.diff(times), np.diff(impacts), strict=True):
        # impacts between them were missed, each of which took about as much
        each = half_cycles.duration(y * _USUAL ** np.arange(gap)[:, None], np.array(alpha.mean())) / p
        shares = np.array([np.interp(time, each.sum(axis=0), one) for one in each])
        found.append(time * shares / shares.sum())
    intervals = np.concatenate(found)
    alphas = alpha[known.sides(intervals.size)]
    y = np.minimum(half_cycles.speed(p * intervals, alphas), 0.999)
    return np.asarray(np.log(y * p * half_cycles.overturning_speed(alphas)))


def start(model: Model, speeds: FloatArray, scatters: FloatArray) -> FloatArray:
    """Return unknowns that lead to such speeds, for each scatter."""
    u = np.zeros((scatters.size, model.size))
    changes = np.diff(speeds)
    mean = float(np.median(changes)) if changes.size else float(model.mean[MEAN])
    u[:, SPEED] = (speeds[0] - model.mean[SPEED]) / model.deviation[SPEED]
    u[:, MEAN] = (mean - model.mean[MEAN]) / model.deviation[MEAN]
    u[:, len(SHARED) :] = (changes - mean) / np.maximum(scatters, 1e-9)[:, None]
    return u
