"""When exactly impacts began: clicks of one foot are alike, so they are laid over each other and their mean is picked.

A faint click alone would be picked late, once it has grown beyond the noise; the mean of all clicks on a foot stands
out more, and the lags between them come from cross-correlation, to a part of a sample. Clicks of the two feet are not
alike, but the same modes of the body ring in both, with real factors: see `_between`.
"""

import numpy as np
from scipy.fft import next_fast_len, rfft
from scipy.signal import oaconvolve

from rocking.conventions import FloatArray, IntArray
from rocking.identification.readers.clicks import causal, spectra

_BEFORE, _AFTER, _REACH = 0.004, 0.030, 0.008
_QUIET, _RINGING = 0.012, 0.100
_PICK_BEFORE, _PICK_AFTER = 0.008, 0.004
_ROUNDS = 4
_EQUALISED = 0.1
_FARTHEST, _STEP, _PULL, _NEAR = 0.006, 1e-5, 0.1, 5e-4
_BAND = (150.0, 9_000.0)


def onsets(sound: FloatArray, rate: float, times: FloatArray, feet: IntArray) -> tuple[FloatArray, float]:
    """Return when the clicks at about some times began [s], and how alike those on the same of two feet are, 1 at most.

    That is the median correlation of a click with the sum of the others.
    """
    size, noise, power = spectra(sound, rate)
    frames = np.clip(np.rint((times * rate - 0.3 * size) / (size // 2)).astype(int), 0, power.shape[0] - 1)
    clicks = np.maximum(power[frames].mean(axis=0) - noise, 0.0)
    # filters of minimum phase: nothing comes before its cause; the mean spectrum of clicks is made flat where it can be
    gains = (np.sqrt(clicks) / (noise + _EQUALISED * clicks), 1.0 / np.sqrt(noise))
    sharp, white = (oaconvolve(sound, causal(gain, rate, size))[: sound.size] for gain in gains)
    found, alike, picks, means = times.copy(), np.ones(times.size), [], []
    groups = [here for foot in (0, 1) if (here := np.flatnonzero(feet == foot)).size]
    for here in groups:
        places, parts = _aligned(sharp, rate, times[here])
        alike[here] = _likeness(_cuts(sharp, rate, places, _BEFORE, _AFTER))
        pick = _first(_mean(white, rate, places, _PICK_BEFORE, _PICK_AFTER)) / rate - _PICK_BEFORE
        found[here] = (places + parts) / rate + pick
        picks.append(pick)
        means.append(_mean(sharp, rate, places, _QUIET, _RINGING))
    if len(groups) == 2:
        off = _between(means[0], means[1], rate, picks[1] - picks[0]) - picks[1] + picks[0]
        found[groups[0]] -= 0.5 * off
        found[groups[1]] += 0.5 * off
    return found, float(np.median(alike))


def _likeness(cuts: FloatArray) -> FloatArray:
    """Return the correlation of each row with the sum of the others."""
    others = cuts.sum(axis=0) - cuts
    scale = np.sqrt((cuts**2).sum(axis=1) * (others**2).sum(axis=1)) + np.finfo(float).tiny
    return np.asarray((cuts * others).sum(axis=1) / scale)


def _between(one: FloatArray, two: FloatArray, rate: float, guess: float) -> float:
    """Return how much later the second of two clicks begins, each of modes m with factors of its own.

    The factors a_m, b_m are real, so near a mode the cross-spectrum has the phase of a_m b_m exp(-i w d), and its
    square that of exp(-2 i w d) whatever their signs: of all lags d only the true one suits all modes.
    """
    size = next_fast_len(2 * one.size, real=True)
    quiet = int(0.75 * _QUIET * rate)
    cross, weight = np.ones(size // 2 + 1, dtype=np.complex128), np.ones(size // 2 + 1)
    for each in (one, two):
        spectrum = rfft(each, size)
        cross = spectrum * np.conj(cross)
        noise = float((each[:quiet] ** 2).mean()) * each.size
        weight *= np.maximum(np.abs(spectrum) ** 2 - 4.0 * noise, 0.0)
    frequency = np.arange(cross.size) * rate / size
    inside = (frequency > _BAND[0]) & (frequency < _BAND[1]) & (weight > 0.0)
    lags = np.arange(-_FARTHEST, _FARTHEST, _STEP)
    if not inside.any():
        return guess
    phase = 2.0 * np.angle(cross[inside]) + 4.0 * np.pi * np.outer(lags, frequency[inside])
    weight = weight[inside] ** 0.25
    agree = np.cos(phase) @ (weight / weight.sum())
    return float(lags[np.argmax(agree - _PULL * np.log1p(((lags - guess) / _NEAR) ** 2))])


def _aligned(sound: FloatArray, rate: float, times: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the samples at which clicks match the mean of the others best, and the rest to a part of a sample.

    The loudest begins, and each finds its place by the sum of those that are louder; then by all the others.
    """
    start = np.rint(times * rate).astype(np.int64)
    places, parts = start.copy(), np.zeros(times.size)
    reach = int(_REACH * rate)
    wide = _cuts(sound, rate, start, _BEFORE + _REACH, _AFTER + _REACH)
    size = int(_AFTER * rate) + int(_BEFORE * rate)
    order = np.argsort(-np.abs(wide).max(axis=1))
    # far from where the click was heard noise may look like it
    likely = np.exp(-0.5 * ((np.arange(wide.shape[1] - size + 1) - reach) / reach) ** 2)
    total = wide[order[0], reach : reach + size].copy()
    cut = np.zeros((times.size, size))
    cut[order[0]] = total
    for turn in range(_ROUNDS):
        moved = False
        for row in order[1:] if turn == 0 else order:
            match = np.correlate(wide[row], total - cut[row], "valid")
            peak = int((match * likely).argmax())
            moved |= places[row] != start[row] + peak - reach
            places[row], parts[row] = start[row] + peak - reach, _vertex(match, peak)
            total -= cut[row]
            cut[row] = wide[row, peak : peak + size]
            total += cut[row]
        if times.size == 1 or not moved:
            break
    return places, parts


def _vertex(values: FloatArray, peak: int) -> float:
    """Return how far from a peak the parabola through it and its neighbours peaks, in samples."""
    if not 0 < peak < values.size - 1:
        return 0.0
    before, here, after = values[peak - 1 : peak + 2]
    bend = before - 2.0 * here + after
    return float(0.5 * (before - after) / bend) if bend < 0.0 else 0.0


def _cuts(sound: FloatArray, rate: float, places: IntArray, before: float, after: float) -> FloatArray:
    """Return what is around some samples, a row each, with silence beyond the ends."""
    reach = np.arange(-int(before * rate), int(after * rate))
    around = places[:, None] + reach
    inside = (around >= 0) & (around < sound.size)
    return np.where(inside, sound[np.clip(around, 0, sound.size - 1)], 0.0)


def _mean(sound: FloatArray, rate: float, places: IntArray, before: float, after: float) -> FloatArray:
    return np.asarray(_cuts(sound, rate, places, before, after).mean(axis=0))


def _first(values: FloatArray) -> int:
    """Return the sample that parts a quiet beginning from a loud rest best: Maeda's (1985) criterion of Akaike."""
    total = np.cumsum(values**2) + np.finfo(float).tiny
    count = np.arange(1, values.size)
    quiet, loud = total[:-1] / count, (total[-1] - total[:-1]) / (values.size - count)
    with np.errstate(divide="ignore", invalid="ignore"):
        criterion = count * np.log(quiet) + (values.size - count) * np.log(loud)
    edge = max(2, values.size // 40)
    return int(edge + 1 + np.nanargmin(criterion[edge:-edge]))
