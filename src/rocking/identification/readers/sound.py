"""Times of impacts from their sound. Clicks of one foot are similar, so they are aligned and averaged.

The onset of a single faint click would be detected late, after its growth beyond the noise. The mean of all clicks of a
foot has a better contrast, and cross-correlation gives the lags to a fraction of a sample. Clicks of the two feet
differ, but contain the same modes with other real factors, see `_agreement`.
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
    rejection_reason,
)
from rocking.identification.readers.sound_constants import SOUND


def sharpened(sound: FloatArray, rate: float, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a sound with short clicks near given times, and a sound with white noise."""
    size, noise, power = spectra(sound, rate)
    frames = np.clip(np.rint((times * rate - 0.3 * size) / (size // 2)).astype(int), 0, power.shape[0] - 1)
    clicks = np.maximum(power[frames].mean(axis=0) - noise, 0.0)
    # filters of minimum phase are causal; the mean spectrum of clicks becomes as flat as possible
    gains = (np.sqrt(clicks) / (noise + SOUND.equalisation * clicks), 1.0 / np.sqrt(noise))
    sharp, white = (oaconvolve(sound, causal(gain, rate, size))[: sound.size] for gain in gains)
    return sharp, white


def onsets(
    sharp: FloatArray, white: FloatArray, rate: float, times: FloatArray, orders: IntArray
) -> tuple[FloatArray, FloatArray, float, float]:
    """Return onset times of impacts [s], certainty of positions, similarity of clicks, error of the time between feet.

    The certainty is the log likelihood ratio to other positions. The similarity is the median correlation of a click
    with the sum of the other clicks of its foot, at most 1. The error is the standard deviation of the time between
    both feet [s].
    """
    onset_times, likenesses, begun, clicks = times.copy(), np.ones(times.size), [], []
    all_places, certainties = _best_places(sharp, rate, times, orders)
    for here in _feet(orders):
        places = all_places[here]
        likenesses[here] = _likeness(_cuts(sharp, rate, places, SOUND.before, SOUND.after))
        after, share = _onset_density(white, rate, places)
        begun.append(share)
        onset_times[here] = (places + _subsample_offsets(sharp, rate, places)) / rate + after @ share
        clicks.append(_mean(sharp, rate, places, SOUND.mode_noise, SOUND.mode_decay))
    if len(begun) < 2:
        return onset_times, certainties, float(np.median(likenesses)), 0.0
    off = np.arange(-SOUND.largest_foot_lag, SOUND.largest_foot_lag, SOUND.foot_lag_step)
    first, second = begun
    step = after[1] - after[0]
    apart = float(after @ (second - first))
    ties = np.convolve(second, first[::-1]) / step
    picked = np.interp(off + apart, (np.arange(ties.size) - after.size + 1) * step, ties, left=0.0, right=0.0)
    law = law_misfit(onset_times + np.outer(off, orders % 2), orders)
    likely = SOUND.agreement_weight * _agreement(clicks[0], clicks[1], rate, off + apart) - 0.5 * np.minimum(
        law - law.min(), SOUND.largest_law_misfit
    )
    likely += np.log(picked + SOUND.onset_failure)
    share = np.exp(likely - likely.max())  # Eq. 318
    share /= share.sum()
    later = float(share @ off)  # for several likely times between feet, the mean has the smallest square error
    onset_times += later * (orders % 2 - 0.5)
    return onset_times, certainties, float(np.median(likenesses)), float(np.sqrt(share @ (off - later) ** 2))


def _feet(orders: IntArray) -> list[IntArray]:
    """Return the impacts on each of two feet, if there are any."""
    return [here for foot in (0, 1) if (here := np.flatnonzero(orders % 2 == foot)).size]


def revised(
    sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray, members: IntArray
) -> tuple[FloatArray, IntArray, IntArray]:
    """Return impacts without false impacts and with missed impacts; a missed impact has the member -1.

    An impact is similar to earlier impacts on its foot, nearly as loud, and near its expected time, see `_impact`.
    """
    for order in range(SOUND.first_revised, int(orders[-1])):
        times, orders, members = _with_missed_impact(sharp, rate, times, orders, members, order)
    # a missing audible impact is evidence against all later impacts
    numbers = range(int(orders[-1]) + 1)
    certainties = np.nan_to_num(
        [_impact(sharp, rate, times, orders, n)[1] if n >= SOUND.first_revised else 0.0 for n in numbers]
    )
    last = numbers[-1] - int(np.cumsum(certainties)[::-1].argmax())
    kept = (orders <= last) & (certainties[orders] > MISSED)
    times, orders, members = times[kept], orders[kept], members[kept]
    # only one more impact, because a second impact would depend on an undetected impact
    return _with_missed_impact(sharp, rate, times, orders, members, int(orders[-1]) + 1)


def _with_missed_impact(
    sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray, members: IntArray, order: int
) -> tuple[FloatArray, IntArray, IntArray]:
    """Return impacts with one more impact, if it was missed and is more likely than no impact."""
    at, sure = (np.nan, np.nan) if order in orders else _impact(sharp, rate, times, orders, order)
    if not sure > 0.0:
        return times, orders, members
    index = int(np.searchsorted(orders, order))
    more = np.insert(times, index, at)
    if np.any(np.diff(more) <= 0.0):
        return times, orders, members
    return more, np.insert(orders, index, order), np.insert(members, index, -1)


def _impact(sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray, order: int) -> tuple[float, float]:
    """Return the likeliest time of an impact, and the logarithm of its likelihood ratio: impact to no impact.

    Earlier impacts predict the time and the shape of the sound. Both values are NaN for too few earlier impacts.
    """
    about, span = next_impact(times[orders < order], orders[orders < order], order)
    if np.isnan(about):
        return np.nan, np.nan
    reach = SOUND.search_range * span
    earlier = np.flatnonzero((orders < order) & (orders % 2 == order % 2))
    begin, end, around = int(SOUND.before * rate), int(SOUND.after * rate), max(SOUND.noise_range, reach)
    first, last = max(int((about - around) * rate), begin), min(int((about + around) * rate), sharp.size - end)
    if earlier.size < 2 or last <= first or about - reach >= last / rate:
        return np.nan, np.nan
    places = _arrangements(sharp, rate, times[earlier])[0]
    cuts = _cuts(sharp, rate, places, SOUND.before, SOUND.after)
    mean = cuts.mean(axis=0)
    match = np.correlate(sharp[first - begin : last + end], mean, "valid")
    noise = 1.4826 * float(np.median(np.abs(match))) + np.finfo(float).tiny
    loud, expected = match / noise, SOUND.loudness_ratio * float(cuts[-1] @ mean) / noise
    off = (np.arange(first, first + match.size) / rate - about) / span
    spread = 1.0 + (SOUND.loudness_scatter * expected) ** 2
    likely = (
        0.5 * (SOUND.noise_tail + 1.0) * np.log1p(loud**2 / SOUND.noise_tail) - 0.5 * (loud - expected) ** 2 / spread
    )  # Eq. 323
    likely -= 0.5 * np.log(spread) + 0.5 * (off / SCATTER) ** 2 + np.log(np.sqrt(2.0 * np.pi) * SCATTER * span * rate)
    likely[np.abs(off) > SOUND.search_range] = -np.inf
    peak = int(likely.argmax())
    # Laplace's rule of succession, because each of these impacts had a successor
    sure = float(np.logaddexp.reduce(likely) + np.log(orders[orders < order].size + 1.0))
    return float(times[earlier[-1]] + (first + peak - places[-1]) / rate), sure


def _likeness(cuts: FloatArray) -> FloatArray:
    """Return the correlation of each row with the sum of the other rows."""
    others = cuts.sum(axis=0) - cuts
    scale = np.sqrt((cuts**2).sum(axis=1) * (others**2).sum(axis=1)) + np.finfo(float).tiny
    return np.asarray((cuts * others).sum(axis=1) / scale)


def _agreement(left: FloatArray, right: FloatArray, rate: float, lags: FloatArray) -> FloatArray:
    """Return the agreement of each lag of two clicks with common modes of independent real factors.

    The factors a_m, b_m are real. Near a mode the cross-spectrum therefore has the phase of a_m b_m exp(-i w d), and
    its square has the phase of exp(-2 i w d) for any sign. Only the true lag d agrees with all modes.
    """
    size = next_fast_len(2 * left.size, real=True)
    quiet = int(0.75 * SOUND.mode_noise * rate)
    cross, weight = np.ones(size // 2 + 1, dtype=np.complex128), np.ones(size // 2 + 1)
    for click in (left, right):
        spectrum = rfft(click, size)
        cross = spectrum * np.conj(cross)
        noise = float((click[:quiet] ** 2).mean()) * click.size
        weight *= np.maximum(np.abs(spectrum) ** 2 - SOUND.subtracted_noise * noise, 0.0)
    frequency = np.arange(cross.size) * rate / size
    inside = (frequency > SOUND.mode_band[0]) & (frequency < SOUND.mode_band[1]) & (weight > 0.0)
    phase = 2.0 * np.angle(cross[inside]) + 4.0 * np.pi * np.outer(lags, frequency[inside])
    weight = weight[inside] ** 0.25
    return np.asarray(np.cos(phase) @ (weight / max(float(weight.sum()), np.finfo(float).tiny)))


def _best_places(sharp: FloatArray, rate: float, times: FloatArray, orders: IntArray) -> tuple[IntArray, FloatArray]:
    """Return the matching samples of clicks on each foot, and their certainty.

    The certainty is the log likelihood ratio to other positions, milliseconds away. A mode with a slow decay matches
    nearly as well one or two periods later. The law of rocking with a loose tolerance often excludes these positions.
    """
    feet = _feet(orders)

    def law(places: IntArray) -> FloatArray:
        placed = places / rate
        for here in feet:
            placed[:, here] -= np.median(placed[:, here] - times[here], axis=1, keepdims=True)
        misfit = law_misfit(placed, orders, SOUND.law_tolerance)
        return np.asarray(-0.5 * SOUND.law_tail * np.log1p(misfit / SOUND.law_tail))  # Eq. 317

    tried, alike, reach = [], [], int(SOUND.reach * rate)
    for rows in product(*(_arrangements(sharp, rate, times[here]) for here in feet)):
        tried.append(np.empty(times.size, dtype=np.int64))
        alike.append(0.0)
        for here, row in zip(feet, rows, strict=True):
            tried[-1][here] = row
            alike[-1] += float(_lag_log_likelihood(_matches(sharp, rate, row, 0)[1], SOUND.fewest_values).sum())
    places = tried[int(np.argmax(np.array(alike) + law(np.array(tried))))]
    for _ in range(SOUND.rounds):
        moves: list[tuple[int, int, float]] = [(0, 0, 0.0)]
        for here in feet:
            correlations = _matches(sharp, rate, places[here], reach)[1]
            clicks = _lag_log_likelihood(correlations, _independent_numbers(correlations))
            for which, row, clicked in zip(here, correlations, clicks, strict=True):
                peaks = np.flatnonzero((row[1:-1] > row[:-2]) & (row[1:-1] >= row[2:])) + 1
                peaks = peaks[np.abs(peaks - reach) > SOUND.peak_distance * rate]
                gains = clicked - clicked[reach]
                moves += [(which, k - reach, float(gains[k])) for k in peaks[np.argsort(-row[peaks])][: SOUND.peaks]]
        moved = np.repeat(places[None], len(moves), axis=0)
        moved[np.arange(len(moves)), [move[0] for move in moves]] += [move[1] for move in moves]
        score = law(moved) + [move[2] for move in moves]
        best = int(score.argmax())
        places = moved[best]
        if not best:
            break
    sure = np.full(times.size, np.inf)
    for (which, move, _), rival in zip(moves, score, strict=True):
        if abs(move - moves[best][1]) > SOUND.rival_distance * rate:
            sure[which] = min(sure[which], score[best] - rival)
    return places, sure


def _lag_log_likelihood(correlations: FloatArray, numbers: FloatArray | float) -> FloatArray:
    """Return the log likelihood of lags from correlations with some number of independent values."""
    return np.asarray(-0.5 * numbers * np.log1p(-(np.clip(correlations, 0.0, 0.999) ** 2)))


def _independent_numbers(correlations: FloatArray) -> FloatArray:
    """Return the number of independent values of a click, from its correlations away from the match, in rows."""
    squares = (correlations**2).mean(axis=1, keepdims=True)
    return np.asarray(np.clip(1.0 / (squares + np.finfo(float).tiny), SOUND.fewest_values, SOUND.most_values))


def _arrangements(sound: FloatArray, rate: float, times: FloatArray) -> list[IntArray]:
    """Return the best matching samples of clicks, for each possible first click, the loudest first.

    Each other click is positioned by the sum of the louder clicks. Then each click is positioned by the sum of all
    other clicks.
    """
    start, reach = np.rint(times * rate).astype(np.int64), int(SOUND.reach * rate)
    cuts = _cuts(sound, rate, start, SOUND.before, SOUND.long_after)
    size = next_fast_len(cuts.shape[1] + 2 * reach + 1, real=True)
    spectrum, lags, here = rfft(cuts, size), np.arange(-2 * reach, 2 * reach + 1), np.arange(-reach, reach + 1)
    cross = np.array([irfft(np.conj(row) * spectrum, size)[:, lags] for row in spectrum])
    cross[np.arange(start.size), np.arange(start.size)] = 0.0
    likely = np.exp(-0.5 * (here / reach) ** 2)  # far from the detection, noise can resemble the click
    order = np.argsort(-np.abs(cuts).max(axis=1))
    arrangements: dict[bytes, IntArray] = {}
    for first in order:
        lag, placed = np.zeros(start.size, dtype=np.int64), [first]
        for turn in range(SOUND.rounds):
            before = lag.copy()
            for row in order:
                if turn == 0 and row == first:
                    continue
                total = sum(cross[other, row, 2 * reach + here - lag[other]] for other in placed)
                lag[row] = here[np.argmax(total * likely)]
                if turn == 0:
                    placed.append(row)
            if turn and np.array_equal(before, lag):
                break
        arrangements.setdefault(
            np.rint((start + lag - np.median(start + lag)) / (SOUND.peak_distance * rate)).tobytes(), start + lag
        )
    return list(arrangements.values())


def _matches(sound: FloatArray, rate: float, places: IntArray, reach: int) -> tuple[FloatArray, FloatArray]:
    """Return the match of each click with the sum of the other clicks at lags within `reach`, and the correlations."""
    cuts = _cuts(sound, rate, places, SOUND.before, SOUND.long_after)
    size = cuts.shape[1]
    wide = _cuts(sound, rate, places, SOUND.before + reach / rate, SOUND.long_after + reach / rate)[
        :, : size + 2 * reach
    ]
    others = cuts.sum(axis=0) - cuts
    total = np.cumsum(np.pad(wide**2, ((0, 0), (1, 0))), axis=1)
    match = np.array([np.correlate(row, other, "valid") for row, other in zip(wide, others, strict=True)])
    power = (total[:, size:] - total[:, :-size]) * (others**2).sum(axis=1, keepdims=True)
    return match, match / np.sqrt(power + np.finfo(float).tiny)


def _subsample_offsets(sound: FloatArray, rate: float, places: IntArray) -> FloatArray:
    """Return the offsets of positions within a sample, from the match with the sum of the other clicks."""
    return np.array([_vertex(match, 1) for match in _matches(sound, rate, places, 1)[0]])


def _vertex(values: FloatArray, peak: int) -> float:
    """Return the offset of the parabola through a peak and its neighbours, in samples."""
    if not 0 < peak < values.size - 1:
        return 0.0
    before, here, after = values[peak - 1 : peak + 2]
    bend = before - 2.0 * here + after
    return float(0.5 * (before - after) / bend) if bend < 0.0 else 0.0


def _cuts(sound: FloatArray, rate: float, places: IntArray, before: float, after: float) -> FloatArray:
    """Return the sound around some samples, one row each, with zeros beyond the ends."""
    reach = np.arange(-int(before * rate), int(after * rate))
    around = places[:, None] + reach
    inside = (around >= 0) & (around < sound.size)
    return np.where(inside, sound[np.clip(around, 0, sound.size - 1)], 0.0)


def _mean(sound: FloatArray, rate: float, places: IntArray, before: float, after: float) -> FloatArray:
    return np.asarray(_cuts(sound, rate, places, before, after).mean(axis=0))


def _onset_density(white: FloatArray, rate: float, places: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return possible delays of the onset of clicks on one foot [s], and their probabilities.

    The mean click is noise first, then a random sound with the spectrum of clicks, which grows during the impact. The
    likelihood of these normal values prevents a late onset for low modes.
    """
    step = max(1, round(SOUND.onset_step * rate))
    cuts = _cuts(white, rate, places, -SOUND.noise_start, SOUND.decay_end)
    cuts = cuts[:, : cuts.shape[1] // step * step].reshape(places.size, -1, step).mean(axis=2)
    rate /= step
    quiet, first, last, until = (
        int((at - SOUND.noise_start) * rate)
        for at in (SOUND.analysis_start, SOUND.onset_earliest, SOUND.onset_latest, SOUND.analysis_end)
    )
    before = irfft((np.abs(rfft(cuts[:, :quiet], 2 * quiet)) ** 2).mean(axis=0))[: SOUND.prediction_order + 1]
    before[0] = 1.000001 * before[0] + np.finfo(float).tiny
    # echoes and hum are removed: the predictable part of the noise
    cuts = lfilter(np.append(1.0, -solve_toeplitz(before[:-1], before[1:])), [1.0], cuts, axis=1)
    noise = np.median(cuts[:, :quiet] ** 2) / 0.4549 + np.finfo(float).tiny  # median of a squared normal number
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
    for rise, loud in product(SOUND.push_durations, SOUND.click_powers):
        grown = 0.5 - 0.5 * np.cos(np.pi * np.minimum((np.arange(mean.size) + 0.5) / (rise * rate), 1.0))
        root = cholesky(loud * np.outer(grown, grown) * alike / alike[0, 0] + np.eye(mean.size), lower=True)
        # a later onset has fewer values with an equal covariance, so the first rows of the root apply
        cost = np.cumsum(0.5 * solve_triangular(root, behind, lower=True) ** 2 + np.log(np.diag(root))[:, None], axis=0)
        likely = np.logaddexp(likely, -cost[mean.size - late - 1, np.arange(late.size)])
    likely -= 0.5 * np.cumsum(mean**2)[late - 1]
    share = np.exp(likely - likely.max())
    return (late + quiet) / rate + SOUND.noise_start, share / share.sum()


def impacts_from_sound(recording: Recording) -> ImpactTimes:
    """Return the times of impacts, or raise an error for a sound without rocking."""
    channel = recording.channel
    clicks = find_clicks(channel, recording.rate)
    length = recording.samples.shape[0] / recording.rate
    sequence = find_sequence(clicks.times, _evidence(clicks.contrasts), np.maximum(clicks.strengths, 0.3), length)
    if sequence is None:
        raise recording.error(
            "fewer than three clicks are above the noise; record closer to the body or in a quieter room"
        )
    lost = float(((channel >= 0.999 * channel.max()) | (channel <= 0.999 * channel.min())).mean())
    if lost > SOUND.largest_clipped:
        raise recording.error(
            "{clipped:.0f} % of the sound is clipped, at most {limit:.0f} % is allowed; record at a lower level",
            clipped=100.0 * lost, limit=100.0 * SOUND.largest_clipped,
        )  # fmt: skip
    rate, rough, orders, members = recording.rate, clicks.times[sequence.members], sequence.orders, sequence.members
    sharp, white = sharpened(clicks.sound, rate, rough)
    times, chosen, alike, tied = onsets(sharp, white, rate, rough, orders)
    grows = bool(np.all(np.diff(times) > 0.0))
    lawful = times if grows and chosen.min() > SOUND.rival_margin else rough
    reason = rejection_reason(lawful, sequence, clicks.contrasts, clicks.strengths)
    if not reason and alike < SOUND.smallest_similarity:
        limit = SOUND.smallest_similarity
        reason = f"the clicks are not similar (median correlation {alike:.2f}; at least {limit} is required)"
    if reason:
        raise recording.error("not the sound of a rocking body: {reason}", reason=reason)
    heard = rough = times if grows else rough
    rough, orders, members = revised(sharp, rate, rough, orders, members)
    if not np.array_equal(rough, heard):
        times, chosen, _, tied = onsets(sharp, white, rate, rough, orders)
    is_timed = chosen > SOUND.rival_margin
    if is_timed.sum() < SOUND.fewest_times:
        raise recording.error(
            "only {count} of {clicks} clicks have a certain time", count=int(is_timed.sum()), clicks=is_timed.size,
            hint="record closer to the body",
        )  # fmt: skip
    times, rough, orders, members = (
        times[is_timed],
        rough[is_timed],
        orders[is_timed] - orders[is_timed][0],
        members[is_timed],
    )
    if np.any(np.diff(times) <= 0.0):
        times = rough
    contrasts = np.where(members < 0, SOUND.revised_contrast, clicks.contrasts[members])
    probabilities = 1.0 / (1.0 + np.exp(-_evidence(contrasts) - 2.0))
    doubts = _doubts(recording, contrasts, orders, times)
    if tied > SOUND.doubtful_foot_lag:
        doubts += (f"the time between impacts on both feet has an uncertainty of {1e3 * tied:.1f} ms",)
    return ImpactTimes(times, None, np.clip(probabilities, 0.01, 1.0), recording.name, doubts, _loudness(channel, rate))


def _loudness(channel: FloatArray, rate: float) -> FloatArray:
    """Return times and largest amplitudes of segments of a sound, for figures."""
    step = max(1, channel.size // SOUND.picture_pieces)
    loud = np.abs(channel[: channel.size // step * step]).reshape(-1, step).max(axis=1)
    return np.column_stack([(np.arange(loud.size) + 0.5) * step / rate, loud])


def _evidence(contrasts: FloatArray) -> FloatArray:
    """Return the log likelihood ratio of impact and noise from contrasts.

    The frequency of contrasts of noise and echoes decreases with a power. A neutral contrast has the ratio 1.
    """
    return np.clip(SOUND.contrast_power * np.log(contrasts / SOUND.neutral_contrast), -4.0, 4.0)


def _doubts(recording: Recording, contrasts: FloatArray, orders: IntArray, times: FloatArray) -> tuple[str, ...]:
    doubts = []
    for order in np.setdiff1d(np.arange(orders[-1]), orders):
        before = int(np.flatnonzero(orders < order)[-1])
        doubts.append(f"an impact seems to be missing between {times[before]:.3f} and {times[before + 1]:.3f} s")
    if recording.clipped:
        doubts.append(f"the sound is clipped {recording.clipped} times; record at a lower level")
    faint = contrasts < SOUND.neutral_contrast
    if faint.any():
        doubts.append(f"{int(faint.sum())} of {faint.size} impacts are hardly above noise and echoes")
    return tuple(doubts)


def undecoded_sound(name: str, suffix: str) -> MeasurementError:
    """Return the error for a sound that cannot be decoded."""
    return MeasurementError(
        "{extension} is not supported. Save the sound as WAV or FLAC, with the recorder or an audio editor",
        extension=suffix,
    ).at(name)
