"""Times of impacts from their sound; of one foot clicks are alike, so they are laid over each other and picked.

A faint click alone would be picked late, once it has grown beyond the noise; the mean of all clicks on a foot stands
out more, and the lags between them come from cross-correlation, to a part of a sample. Clicks of the two feet are not
alike, but the same modes of the body ring in both, with real factors: see `_agreement`.
"""

from itertools import product

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft
from scipy.linalg import cholesky, solve_toeplitz, solve_triangular, toeplitz
from scipy.signal import lfilter, oaconvolve

from rocking.conventions import FloatArray, IntArray
from rocking.errors import MeasurementError
from rocking.identification.measurement import ImpactTimes
from rocking.identification.readers.clicks import causal, find_clicks, spectra
from rocking.identification.readers.recording import Recording
from rocking.identification.readers.rocking_sequence import (
    MISSED,
    SCATTER,
    find_sequence,
    law_misfit,
    next_impact,
    why_no_rocking,
)

_BEFORE, _AFTER, _LONG, _REACH = 0.004, 0.030, 0.060, 0.012
_QUIET, _RINGING = 0.012, 0.100
_SILENT, _FROM, _EARLIEST, _LATEST, _UNTIL, _RING = -0.026, -0.014, -0.010, 0.004, 0.006, 0.030
"""Where noise is measured, what is looked at, where a click may begin, how far it rings, about its place [s]."""

_PICK_STEP, _PAST, _FAILED = 9e-5, 6, 0.05
"""Step of that [s]; samples from which noise is foretold; density of beginnings if that fails, one of a thousand."""

_RISES, _LOUD = (3e-4, 8e-4), np.geomspace(0.5, 500.0, 6)
"""How long an impact pushes [s]; power of a click over that of the noise."""

_ROUNDS, _PEAKS, _APART, _RIVAL, _FAR = 6, 10, 5e-4, 0.25, 2e-3
_EQUALISED = 0.1
_FARTHEST, _STEP, _NOISES = 0.010, 1e-5, 2.0
_NUMBERS, _MOST_NUMBERS, _FAILS, _LOOSE = 25.0, 60.0, 10.0, 3e-3
"""Independent numbers of a click, at least and at most; degrees of freedom of how the law fails; how well feet are tied
before that is looked at [s]."""

_AGREED, _MOST = 30.0, 30.0
"""Weight of modes that agree, with which the right tie of 207 rooms at 8 dB is likeliest; most that the law says."""

_LEAST, _SEARCHED, _AROUND = 5, 0.15, 0.040
_FADED, _FADES, _TAIL = 0.75, 0.25, 8.0
"""How loud an impact is over the last one on its foot, of 119 rooms, and the deviation of that over it; degrees of
freedom of noise and echoes."""

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
) -> tuple[FloatArray, FloatArray, float, float]:
    """Return when impacts at about some times began [s], how sure places are, how alike clicks are, how sure the tie.

    Places by how much less likely others are, in logarithms; alike is the median correlation of a click with the sum of
    the others on its foot, 1 at most; the tie is the standard deviation of the time between the two feet [s].
    """
    found, alike, begun, clicks = times.copy(), np.ones(times.size), [], []
    all_places, sure = _chosen(sharp, rate, times, orders)
    for here in _feet(orders):
        places = all_places[here]
        alike[here] = _likeness(_cuts(sharp, rate, places, _BEFORE, _AFTER))
        after, share = _begun(white, rate, places)
        begun.append(share)
        found[here] = (places + _parts(sharp, rate, places)) / rate + after @ share
        clicks.append(_mean(sharp, rate, places, _QUIET, _RINGING))
    if len(begun) < 2:
        return found, sure, float(np.median(alike)), 0.0
    off = np.arange(-_FARTHEST, _FARTHEST, _STEP)
    one, two = begun
    step = after[1] - after[0]
    apart = float(after @ (two - one))
    ties = np.convolve(two, one[::-1]) / step
    picked = np.interp(off + apart, (np.arange(ties.size) - after.size + 1) * step, ties, left=0.0, right=0.0)
    law = law_misfit(found + np.outer(off, orders % 2), orders)
    likely = _AGREED * _agreement(clicks[0], clicks[1], rate, off + apart) - 0.5 * np.minimum(law - law.min(), _MOST)
    likely += np.log(picked + _FAILED)
    share = np.exp(likely - likely.max())  # Eq. 318
    share /= share.sum()
    later = float(share @ off)  # the mean has the least square error where several ties are likely
    found += later * (orders % 2 - 0.5)
    return found, sure, float(np.median(alike)), float(np.sqrt(share @ (off - later) ** 2))


def _feet(orders: IntArray) -> list[IntArray]:
    """Return which impacts are on each of two feet, where there are some."""
    return [here for foot in (0, 1) if (here := np.flatnonzero(orders % 2 == foot)).size]


def revised(
    sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray, members: IntArray
) -> tuple[FloatArray, IntArray, IntArray]:
    """Return impacts less those that are none, and with those that were missed, whose member is -1.

    An impact is like those before it on the same foot, nearly as loud, and when the law says: see `_impact`.
    """
    for order in range(_LEAST, int(orders[-1])):
        times, orders, members = _with(sharp, rate, times, orders, members, order)
    # what should be heard and is not speaks against all behind it
    asked = range(int(orders[-1]) + 1)
    sure = np.nan_to_num([_impact(sharp, rate, times, orders, n)[1] if n >= _LEAST else 0.0 for n in asked])
    last = asked[-1] - int(np.cumsum(sure)[::-1].argmax())
    kept = (orders <= last) & (sure[orders] > MISSED)
    times, orders, members = times[kept], orders[kept], members[kept]
    # one behind the last, since a second would rest on one that no click told
    return _with(sharp, rate, times, orders, members, int(orders[-1]) + 1)


def _with(
    sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray, members: IntArray, order: int
) -> tuple[FloatArray, IntArray, IntArray]:
    """Return impacts with one more, if it was missed and is likelier than none."""
    at, sure = (np.nan, np.nan) if order in orders else _impact(sharp, rate, times, orders, order)
    if not sure > 0.0:
        return times, orders, members
    place = int(np.searchsorted(orders, order))
    more = np.insert(times, place, at)
    if np.any(np.diff(more) <= 0.0):
        return times, orders, members
    return more, np.insert(orders, place, order), np.insert(members, place, -1)


def _impact(sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray, order: int) -> tuple[float, float]:
    """Return when an impact of some order came, from those before it, and how much likelier one is than none.

    Nan where that cannot be said.
    """
    about, span = next_impact(times[orders < order], orders[orders < order], order)
    if np.isnan(about):
        return np.nan, np.nan
    reach = _SEARCHED * span
    earlier = np.flatnonzero((orders < order) & (orders % 2 == order % 2))
    begin, end, around = int(_BEFORE * rate), int(_AFTER * rate), max(_AROUND, reach)
    first, last = max(int((about - around) * rate), begin), min(int((about + around) * rate), sharp.size - end)
    if earlier.size < 2 or last <= first or about - reach >= last / rate:
        return np.nan, np.nan
    places = _arrangements(sharp, rate, times[earlier])[0]
    cuts = _cuts(sharp, rate, places, _BEFORE, _AFTER)
    mean = cuts.mean(axis=0)
    match = np.correlate(sharp[first - begin : last + end], mean, "valid")
    noise = 1.4826 * float(np.median(np.abs(match))) + np.finfo(float).tiny
    loud, expected = match / noise, _FADED * float(cuts[-1] @ mean) / noise
    off = (np.arange(first, first + match.size) / rate - about) / span
    spread = 1.0 + (_FADES * expected) ** 2
    likely = 0.5 * (_TAIL + 1.0) * np.log1p(loud**2 / _TAIL) - 0.5 * (loud - expected) ** 2 / spread  # Eq. 323
    likely -= 0.5 * np.log(spread) + 0.5 * (off / SCATTER) ** 2 + np.log(np.sqrt(2.0 * np.pi) * SCATTER * span * rate)
    likely[np.abs(off) > _SEARCHED] = -np.inf
    peak = int(likely.argmax())
    # of so many impacts each was followed by one: Laplace's rule of succession
    sure = float(np.logaddexp.reduce(likely) + np.log(orders[orders < order].size + 1.0))
    return float(times[earlier[-1]] + (first + peak - places[-1]) / rate), sure


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


def _chosen(sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray) -> tuple[IntArray, FloatArray]:
    """Return the samples at which clicks on the same foot match, by the law of rocking where several are as likely.

    Also by how much, in logarithms, other places of each, milliseconds away, are less likely.

    A mode that rings for long matches a period or two late nearly as well, which the law often tells, loose as it is.
    """
    feet = _feet(orders)

    def law(places: IntArray) -> FloatArray:
        placed = places / rate
        for here in feet:
            placed[:, here] -= np.median(placed[:, here] - times[here], axis=1, keepdims=True)
        misfit = law_misfit(placed, orders, _LOOSE)
        return np.asarray(-0.5 * _FAILS * np.log1p(misfit / _FAILS))  # Eq. 317

    tried, alike, reach = [], [], int(_REACH * rate)
    for rows in product(*(_arrangements(sharp, rate, times[here]) for here in feet)):
        tried.append(np.empty(times.size, dtype=np.int64))
        alike.append(0.0)
        for here, row in zip(feet, rows, strict=True):
            tried[-1][here] = row
            alike[-1] += float(_clicked(_matches(sharp, rate, row, 0)[1], _NUMBERS).sum())
    places = tried[int(np.argmax(np.array(alike) + law(np.array(tried))))]
    for _ in range(_ROUNDS):
        moves: list[tuple[int, int, float]] = [(0, 0, 0.0)]
        for here in feet:
            correlations = _matches(sharp, rate, places[here], reach)[1]
            clicks = _clicked(correlations, _numbers(correlations))
            for which, row, clicked in zip(here, correlations, clicks, strict=True):
                peaks = np.flatnonzero((row[1:-1] > row[:-2]) & (row[1:-1] >= row[2:])) + 1
                peaks = peaks[np.abs(peaks - reach) > _APART * rate]
                gains = clicked - clicked[reach]
                moves += [(which, k - reach, float(gains[k])) for k in peaks[np.argsort(-row[peaks])][:_PEAKS]]
        moved = np.repeat(places[None], len(moves), axis=0)
        moved[np.arange(len(moves)), [move[0] for move in moves]] += [move[1] for move in moves]
        score = law(moved) + [move[2] for move in moves]
        best = int(score.argmax())
        places = moved[best]
        if not best:
            break
    sure = np.full(times.size, np.inf)
    for (which, move, _), rival in zip(moves, score, strict=True):
        if abs(move - moves[best][1]) > _FAR * rate:
            sure[which] = min(sure[which], score[best] - rival)
    return places, sure


def _clicked(correlations: FloatArray, numbers: FloatArray | float) -> FloatArray:
    """Return the logarithm of how likely lags of clicks are from their correlations, of so many independent numbers."""
    return np.asarray(-0.5 * numbers * np.log1p(-(np.clip(correlations, 0.0, 0.999) ** 2)))


def _numbers(correlations: FloatArray) -> FloatArray:
    """Return how many independent numbers a faint click has, by how it correlates where it does not match, rows."""
    squares = (correlations**2).mean(axis=1, keepdims=True)
    return np.asarray(np.clip(1.0 / (squares + np.finfo(float).tiny), _NUMBERS, _MOST_NUMBERS))


def _arrangements(sound: FloatArray, rate: float, times: FloatArray) -> list[IntArray]:
    """Return the samples at which clicks match the others best, for each that may begin; the loudest comes first.

    Each of the others finds its place by the sum of those that are louder; then all do by all the others.
    """
    start, reach = np.rint(times * rate).astype(np.int64), int(_REACH * rate)
    cuts = _cuts(sound, rate, start, _BEFORE, _LONG)
    size = next_fast_len(cuts.shape[1] + 2 * reach + 1, real=True)
    spectrum, lags, here = rfft(cuts, size), np.arange(-2 * reach, 2 * reach + 1), np.arange(-reach, reach + 1)
    cross = np.array([irfft(np.conj(each) * spectrum, size)[:, lags] for each in spectrum])
    cross[np.arange(start.size), np.arange(start.size)] = 0.0
    likely = np.exp(-0.5 * (here / reach) ** 2)  # far from where the click was heard noise may look like it
    order = np.argsort(-np.abs(cuts).max(axis=1))
    found: dict[bytes, IntArray] = {}
    for first in order:
        lag, known = np.zeros(start.size, dtype=np.int64), [first]
        for turn in range(_ROUNDS):
            before = lag.copy()
            for row in order:
                if turn == 0 and row == first:
                    continue
                total = sum(cross[other, row, 2 * reach + here - lag[other]] for other in known)
                lag[row] = here[np.argmax(total * likely)]
                if turn == 0:
                    known.append(row)
            if turn and np.array_equal(before, lag):
                break
        found.setdefault(np.rint((start + lag - np.median(start + lag)) / (_APART * rate)).tobytes(), start + lag)
    return list(found.values())


def _matches(sound: FloatArray, rate: float, places: IntArray, reach: int) -> tuple[FloatArray, FloatArray]:
    """Return how clicks match the sum of the others up to some samples from their places, and the correlations."""
    cuts = _cuts(sound, rate, places, _BEFORE, _LONG)
    size = cuts.shape[1]
    wide = _cuts(sound, rate, places, _BEFORE + reach / rate, _LONG + reach / rate)[:, : size + 2 * reach]
    others = cuts.sum(axis=0) - cuts
    total = np.cumsum(np.pad(wide**2, ((0, 0), (1, 0))), axis=1)
    match = np.array([np.correlate(row, other, "valid") for row, other in zip(wide, others, strict=True)])
    power = (total[:, size:] - total[:, :-size]) * (others**2).sum(axis=1, keepdims=True)
    return match, match / np.sqrt(power + np.finfo(float).tiny)


def _parts(sound: FloatArray, rate: float, places: IntArray) -> FloatArray:
    """Return the rest of places to a part of a sample, where clicks match the sum of the others best."""
    return np.array([_vertex(match, 1) for match in _matches(sound, rate, places, 1)[0]])


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


def _begun(white: FloatArray, rate: float, places: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return how long after some samples the clicks on one foot may begin [s], and how likely, 1 together.

    Their mean is noise first, then a random sound of their spectrum that grows while the impact pushes. Such normal
    numbers have a likelihood, and what rises slowly, as low modes do, is not picked late.
    """
    step = max(1, round(_PICK_STEP * rate))
    cuts = _cuts(white, rate, places, -_SILENT, _RING)
    cuts = cuts[:, : cuts.shape[1] // step * step].reshape(places.size, -1, step).mean(axis=2)
    rate /= step
    quiet, first, last, until = (int((at - _SILENT) * rate) for at in (_FROM, _EARLIEST, _LATEST, _UNTIL))
    before = irfft((np.abs(rfft(cuts[:, :quiet], 2 * quiet)) ** 2).mean(axis=0))[: _PAST + 1]
    before[0] = 1.000001 * before[0] + np.finfo(float).tiny
    # what noise foretells of itself is taken away: echoes, and what is left of hum
    cuts = lfilter(np.append(1.0, -solve_toeplitz(before[:-1], before[1:])), [1.0], cuts, axis=1)
    noise = np.median(cuts[:, :quiet] ** 2) / 0.4549 + np.finfo(float).tiny  # of the square of a normal number
    window = np.hanning(cuts.shape[1] - first)
    power = (np.abs(rfft(window * cuts[:, first:], 2 * window.size)) ** 2).mean(axis=0)
    clicks = np.maximum(power - noise * (window @ window), 1e-9 * power.max() + np.finfo(float).tiny)
    alike = toeplitz(irfft(clicks)[: until - quiet])
    mean = cuts.mean(axis=0)
    own = max(float(np.median(mean[:quiet] ** 2)) / 0.4549, 1e-9 * float((mean**2).mean())) + np.finfo(float).tiny
    mean = mean[quiet:until] / np.sqrt(own)
    late = np.arange(first, last) - quiet
    behind = np.array([np.pad(mean[begin:], (0, begin)) for begin in late.tolist()]).T
    likely = np.full(late.size, -np.inf)
    for rise, loud in product(_RISES, _LOUD):
        grown = 0.5 - 0.5 * np.cos(np.pi * np.minimum((np.arange(mean.size) + 0.5) / (rise * rate), 1.0))
        root = cholesky(loud * np.outer(grown, grown) * alike / alike[0, 0] + np.eye(mean.size), lower=True)
        # what is behind a later beginning is fewer numbers of the same covariance, whose root is the first part of it
        rest = np.cumsum(0.5 * solve_triangular(root, behind, lower=True) ** 2 + np.log(np.diag(root))[:, None], axis=0)
        likely = np.logaddexp(likely, -rest[mean.size - late - 1, np.arange(late.size)])
    likely -= 0.5 * np.cumsum(mean**2)[late - 1]
    share = np.exp(likely - likely.max())
    return (late + quiet) / rate + _SILENT, share / share.sum()


_PIECES = 2000
_UNHEARD = 3.0
"""Contrast of an impact that only its likeness to others tells."""

_TIED = 3e-4
"""Standard deviation of the time between both feet that is told [s]: that of times whose reader states none."""

_FEWEST, _LOST = 4, 1.0 / 3.0
"""Times that identification needs; share of a sound that tells nothing, since hum or noise clips, not clicks alone."""

_ALIKE = 0.45
"""Between what 80 rocking bodies have, .69 at least at 8 dB, and speech taken for one, .24 at most."""


def impacts_heard(recording: Recording) -> ImpactTimes:
    """Return when a rocking body struck, or refuse a sound that is no rocking."""
    channel = recording.channel
    clicks = find_clicks(channel, recording.rate)
    length = recording.samples.shape[0] / recording.rate
    found = find_sequence(clicks.times, _evidence(clicks.contrasts), np.maximum(clicks.strengths, 0.3), length)
    if found is None:
        raise recording.error("fewer than three clicks stand out of its noise; nearer to the body, or a quieter room?")
    lost = float(((channel >= 0.999 * channel.max()) | (channel <= 0.999 * channel.min())).mean())
    if lost > _LOST:
        raise recording.error(
            "{clipped:.0f} % of it is clipped, more than {limit:.0f} %: record at a lower level", clipped=100.0 * lost,
            limit=100.0 * _LOST,
        )  # fmt: skip
    rate, rough, orders, members = recording.rate, clicks.times[found.members], found.orders, found.members
    sharp, white = sharpened(clicks.sound, rate, rough)
    times, chosen, alike, tied = onsets(sharp, white, rate, rough, orders)
    grows = bool(np.all(np.diff(times) > 0.0))
    lawful = times if grows and chosen.min() > _RIVAL else rough
    why = why_no_rocking(lawful, found, clicks.contrasts, clicks.strengths)
    if not why and alike < _ALIKE:
        why = f"its clicks are not alike (median correlation {alike:.2f}, at least {_ALIKE}): no two feet made them"
    if why:
        raise recording.error("this is no sound of a rocking body: {reason}", reason=why)
    heard = rough = times if grows else rough
    rough, orders, members = revised(sharp, rate, rough, orders, members)
    if not np.array_equal(rough, heard):
        times, chosen, _, tied = onsets(sharp, white, rate, rough, orders)
    known = chosen > _RIVAL
    if known.sum() < _FEWEST:
        raise recording.error(
            "{count} of its {clicks} clicks can be told in time only", count=int(known.sum()), clicks=known.size,
            hint="nearer to the body?",
        )  # fmt: skip
    times, rough, orders, members = times[known], rough[known], orders[known] - orders[known][0], members[known]
    if np.any(np.diff(times) <= 0.0):
        times = rough
    contrasts = np.where(members < 0, _UNHEARD, clicks.contrasts[members])
    sure = 1.0 / (1.0 + np.exp(-_evidence(contrasts) - 2.0))
    doubts = _doubts(recording, contrasts, orders, times)
    if tied > _TIED:
        doubts += (f"how long after impacts on one foot those on the other came is known to {1e3 * tied:.1f} ms only",)
    return ImpactTimes(times, None, np.clip(sure, 0.01, 1.0), recording.name, doubts, _loudness(channel, rate))


def _loudness(channel: FloatArray, rate: float) -> FloatArray:
    """Return times and largest amplitudes of pieces of a sound, as many as a picture shows."""
    step = max(1, channel.size // _PIECES)
    loud = np.abs(channel[: channel.size // step * step]).reshape(-1, step).max(axis=1)
    return np.column_stack([(np.arange(loud.size) + 0.5) * step / rate, loud])


def _evidence(contrasts: FloatArray) -> FloatArray:
    """Return the logarithm of how much likelier an impact has such a contrast than noise and echoes have.

    Contrasts of those fall off as the power -5; a click that is louder than what went before by 3.2 may be either.
    """
    return np.clip(5.0 * np.log(contrasts / 3.2), -4.0, 4.0)


def _doubts(recording: Recording, contrasts: FloatArray, orders: IntArray, times: FloatArray) -> tuple[str, ...]:
    doubts = []
    for order in np.setdiff1d(np.arange(orders[-1]), orders):
        before = int(np.flatnonzero(orders < order)[-1])
        doubts.append(f"an impact seems to be missing between {times[before]:.3f} and {times[before + 1]:.3f} s")
    if recording.clipped:
        doubts.append(f"the sound is clipped {recording.clipped} times: record it at a lower level")
    faint = contrasts < 3.2
    if faint.any():
        doubts.append(f"{int(faint.sum())} of {faint.size} impacts hardly stand out of noise and echoes")
    return tuple(doubts)


def refuse_sound(name: str, suffix: str) -> MeasurementError:
    """Return the refusal of a sound that nobody here can decode, to be raised."""
    return MeasurementError(
        "{extension} sounds are not read: save it as WAV or FLAC, with the recorder's own export or an audio editor",
        extension=suffix,
    ).at(name)
