"""When exactly impacts began: clicks of one foot are alike, so they are laid over each other and their mean is picked.

A faint click alone would be picked late, once it has grown beyond the noise; the mean of all clicks on a foot stands
out more, and the lags between them come from cross-correlation, to a part of a sample. Clicks of the two feet are not
alike, but the same modes of the body ring in both, with real factors: see `_agreement`.
"""

import numpy as np
from scipy.fft import next_fast_len, rfft
from scipy.signal import oaconvolve

from rocking.conventions import FloatArray, IntArray
from rocking.identification.readers.clicks import causal, spectra
from rocking.identification.readers.rocking_sequence import alternation_misfit

_BEFORE, _AFTER, _REACH = 0.004, 0.030, 0.008
_QUIET, _RINGING = 0.012, 0.100
_PICK_BEFORE, _PICK_AFTER = 0.008, 0.004
_ROUNDS = 4
_EQUALISED = 0.1
_FARTHEST, _STEP, _NOISES = 0.012, 1e-5, 2.0
_PULL, _NEAR, _FAILED = 0.05, 5e-4, 0.1
_LAW, _LAW_SCATTER, _MOST = 0.01, 0.012, 30.0
_LEAST, _SEARCHED = 5, 0.15
_LIKE = 0.15
"""Of 180 rooms at 8 dB impacts that the times alone missed had about .18 and more, noise where none was .14 at most."""
_BAND = (150.0, 9_000.0)


def sharpened(sound: FloatArray, rate: float, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a sound in which the clicks at about some times are short, and one whose noise is white."""
    size, noise, power = spectra(sound, rate)
    frames = np.clip(np.rint((times * rate - 0.3 * size) / (size // 2)).astype(int), 0, power.shape[0] - 1)
    clicks = np.maximum(power[frames].mean(axis=0) - noise, 0.0)
    # filters of minimum phase: nothing comes before its cause; the mean spectrum of clicks is made flat where it can be
    gains = (np.sqrt(clicks) / (noise + _EQUALISED * clicks), 1.0 / np.sqrt(noise))
    sharp, white = (oaconvolve(sound, causal(gain, rate, size))[: sound.size] for gain in gains)
    return sharp, white


def onsets(
    sharp: FloatArray, white: FloatArray, rate: float, times: FloatArray, orders: IntArray
) -> tuple[FloatArray, float]:
    """Return when impacts at about some times began [s], and how alike those on the same of two feet are, 1 at most.

    That is the median correlation of a click with the sum of the others.
    """
    found, alike, picks, means = times.copy(), np.ones(times.size), [], []
    groups = [here for foot in (0, 1) if (here := np.flatnonzero(orders % 2 == foot)).size]
    for here in groups:
        places, parts = _aligned(sharp, rate, times[here])
        alike[here] = _likeness(_cuts(sharp, rate, places, _BEFORE, _AFTER))
        pick = _first(_mean(white, rate, places, _PICK_BEFORE, _PICK_AFTER)) / rate - _PICK_BEFORE
        found[here] = (places + parts) / rate + pick
        picks.append(pick)
        means.append(_mean(sharp, rate, places, _QUIET, _RINGING))
    if len(groups) == 2:
        lags = np.arange(-_FARTHEST, _FARTHEST, _STEP)
        off = lags - picks[1] + picks[0]
        law = alternation_misfit(found, orders, off) / _LAW_SCATTER**2
        # a pick may fail, and the law leaves a millisecond: neither outweighs modes that agree much better
        doubt = np.minimum(_PULL * np.log1p((off / _NEAR) ** 2), _FAILED)
        doubt += _LAW * np.minimum(law - law.min(), _MOST)
        later = off[np.argmax(_agreement(means[0], means[1], rate, lags) - doubt)]
        found[groups[0]] -= 0.5 * later
        found[groups[1]] += 0.5 * later
    return found, float(np.median(alike))


def revised(
    sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray, members: IntArray
) -> tuple[FloatArray, IntArray, IntArray]:
    """Return impacts less the last ones that are none, and with those that were missed, whose member is -1.

    An impact is like those before it on the same foot, nearly as loud, and when the last intervals say.
    """
    while times.size > _LEAST:
        if _resembling(sharp, rate, times, orders, (orders[-1], times[-1], _REACH))[1] >= _LIKE:
            break
        times, orders, members = times[:-1], orders[:-1], members[:-1]
    order = _LEAST
    while order <= orders[-1] + 1:
        known = dict(zip(orders.tolist(), times.tolist(), strict=True))
        spans = {n: known[n] - known[n - 1] for n in known if n - 1 in known and n < order}
        falls = [spans[n] / spans[n - 2] for n in spans if n - 2 in spans]
        if order not in known and order - 1 in known and order - 2 in spans and falls:
            span = spans[order - 2] * float(np.median(falls[-4:]))
            asked = (order, known[order - 1] + span, _SEARCHED * span)
            at, like = _resembling(sharp, rate, times, orders, asked)
            if like >= _LIKE:
                place = int(np.searchsorted(orders, order))
                times, orders = np.insert(times, place, at), np.insert(orders, place, order)
                members = np.insert(members, place, -1)
        order += 1
    return times, orders, members


def _resembling(
    sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray, asked: tuple[int, float, float]
) -> tuple[float, float]:
    """Return what is most like the impacts before on the same foot: when, and its correlation times how loud it is.

    An order is asked for, about when, and how far from it.
    """
    order, about, reach = asked
    earlier = np.flatnonzero((orders < order) & (orders % 2 == order % 2))
    begin, end = int(_BEFORE * rate), int(_AFTER * rate)
    first, last = max(int((about - reach) * rate), begin), min(int((about + reach) * rate), sharp.size - end)
    if earlier.size < 2 or last <= first:
        return about, 0.0
    places, _ = _aligned(sharp, rate, times[earlier])
    cuts = _cuts(sharp, rate, places, _BEFORE, _AFTER)
    mean = cuts.mean(axis=0)
    match = np.correlate(sharp[first - begin : last + end], mean, "valid")
    peak = int(match.argmax())
    own = sharp[first + peak - begin : first + peak + end]
    alike = match[peak] / np.sqrt((own @ own) * (mean @ mean) + np.finfo(float).tiny)
    loud = match[peak] / max(float(cuts[-1] @ mean), np.finfo(float).tiny)
    return float(times[earlier[-1]] + (first + peak - places[-1]) / rate), float(alike * min(loud, 1.0))


def _likeness(cuts: FloatArray) -> FloatArray:
    """Return the correlation of each row with the sum of the others."""
    others = cuts.sum(axis=0) - cuts
    scale = np.sqrt((cuts**2).sum(axis=1) * (others**2).sum(axis=1)) + np.finfo(float).tiny
    return np.asarray((cuts * others).sum(axis=1) / scale)


def _agreement(one: FloatArray, two: FloatArray, rate: float, lags: FloatArray) -> FloatArray:
    """Return how well lags of the second of two clicks explain both, each of modes m with factors of its own.

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
        weight *= np.maximum(np.abs(spectrum) ** 2 - _NOISES * noise, 0.0)
    frequency = np.arange(cross.size) * rate / size
    inside = (frequency > _BAND[0]) & (frequency < _BAND[1]) & (weight > 0.0)
    phase = 2.0 * np.angle(cross[inside]) + 4.0 * np.pi * np.outer(lags, frequency[inside])
    weight = weight[inside] ** 0.25
    return np.asarray(np.cos(phase) @ (weight / max(float(weight.sum()), np.finfo(float).tiny)))


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
