"""When exactly impacts began: clicks of one foot are alike, so they are laid over each other and their mean is picked.

A faint click alone would be picked late, once it has grown beyond the noise; the mean of all clicks on a foot stands
out more, and the lags between them come from cross-correlation, to a part of a sample.
"""

import numpy as np
from scipy.signal import butter, oaconvolve, sosfilt

from rocking.conventions import FloatArray, IntArray
from rocking.identification.readers.clicks import causal, spectra

_BEFORE, _AFTER, _REACH = 0.004, 0.010, 0.004
_PICK_BEFORE, _PICK_AFTER = 0.006, 0.002
_PAD = 0.05
_ROUNDS = 4
_EQUALISED = 0.1
_LOWEST = 100.0


def onsets(sound: FloatArray, rate: float, times: FloatArray, feet: IntArray) -> FloatArray:
    """Return when the clicks at about some times began [s]; clicks on the same of two feet are taken for alike."""
    found = times.copy()
    # of what no filter has dispersed save a gentle one against rumble
    plain = sosfilt(butter(1, _LOWEST, "high", fs=rate, output="sos"), sound)
    for foot in (0, 1):
        here = np.flatnonzero(feet == foot)
        if here.size:
            sharp = _equalised(sound, rate, times[here])
            places, parts = _aligned(sharp, rate, times[here])
            rough = _first(_mean(sharp, rate, places, _BEFORE, 0.004)) - int(_BEFORE * rate)
            mean = _mean(plain, rate, places + rough, _PICK_BEFORE, _PICK_AFTER)
            found[here] = (places + parts + rough + _first(mean) - int(_PICK_BEFORE * rate)) / rate
    return found


def _equalised(sound: FloatArray, rate: float, times: FloatArray) -> FloatArray:
    """Return a sound in which clicks at some times are short: their mean spectrum is made flat where it can be."""
    size, noise, power = spectra(sound, rate)
    frames = np.clip(np.rint((times * rate - 0.3 * size) / (size // 2)).astype(int), 0, power.shape[0] - 1)
    clicks = np.maximum(power[frames].mean(axis=0) - noise, 0.0)
    gain = np.sqrt(clicks) / (noise + _EQUALISED * clicks)
    return np.asarray(oaconvolve(sound, causal(gain, rate, size))[: sound.size])


def _aligned(sound: FloatArray, rate: float, times: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the samples at which clicks match the mean of the others best, and the rest to a part of a sample."""
    start = np.rint(times * rate).astype(np.int64)
    places, parts = start, np.zeros(times.size)
    reach = int(_REACH * rate)
    for _ in range(_ROUNDS if times.size > 1 else 0):
        cuts = _cuts(sound, rate, places, _BEFORE, _AFTER)
        wide = _cuts(sound, rate, start, _BEFORE + _REACH, _AFTER + _REACH)
        moved = places.copy()
        for row in range(times.size):
            match = np.correlate(wide[row], cuts.sum(axis=0) - cuts[row], "valid")
            peak = int(match.argmax())
            moved[row] = start[row] + peak - reach
            parts[row] = _vertex(match, peak)
        if np.array_equal(moved, places):
            break
        places = moved
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
