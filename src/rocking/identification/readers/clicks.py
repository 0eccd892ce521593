"""Clicks in a sound: sudden increases of power at the frequencies with the best contrast to the noise."""

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.fft import irfft, next_fast_len, rfft
from scipy.signal import oaconvolve

from rocking.conventions import FloatArray, IntArray

_LOW_RATE = 4_000.0
_HIGHEST = 1_500.0
_BLOCK = 2.0


def without_hum(sound: FloatArray, rate: float) -> FloatArray:
    """Return a sound without the best-fitting multiples of 50 or 60 Hz, block by block.

    A comb filter would repeat every click, and narrow filters would ring for a second. A least-squares fit of about
    fifty sines to blocks of two seconds removes less than 1 % of a click.
    """
    size = next_fast_len(sound.size, real=True)
    spectrum = rfft(sound, size)
    count = round(size * _LOW_RATE / rate)
    low_rate, bins = count * rate / size, count // 2 + 1
    if bins > spectrum.size:
        return sound
    low = irfft(spectrum[:bins], count)[: int(sound.size * low_rate / rate)]
    fitted = np.zeros(count)
    fitted[: low.size] = _hum(low, low_rate)
    spectrum[:bins] -= rfft(fitted)[:bins]
    return np.asarray(irfft(spectrum, size)[: sound.size])


def _hum(sound: FloatArray, rate: float) -> FloatArray:
    size = min(int(_BLOCK * rate), sound.size)
    base = _base(sound, rate)
    phase = 2.0 * np.pi * base / rate * np.outer(np.arange(size), np.arange(1, int(_HIGHEST / base) + 1))
    sines, _ = np.linalg.qr(np.concatenate((np.cos(phase), np.sin(phase)), axis=1))
    window = np.hanning(size + 2)[1:-1]
    hum, weight = np.zeros(sound.size), np.zeros(sound.size)
    for first in [*range(0, sound.size - size, size // 2), sound.size - size]:
        block = slice(first, first + size)
        hum[block] += window * (sines @ (sines.T @ sound[block]))
        weight[block] += window
    return np.asarray(hum / weight)


def _base(sound: FloatArray, rate: float) -> float:
    """Return the frequency near 50 or 60 Hz with the strongest multiples [Hz]."""
    size = next_fast_len(4 * sound.size, real=True)
    power = np.abs(rfft(sound * np.hanning(sound.size), size)) ** 2
    width = rate / size
    floor = np.median(power[: int(_HIGHEST / width)]) + np.finfo(float).tiny
    bases = np.concatenate([mains + np.arange(-0.3, 0.301, 0.002) for mains in (50.0, 60.0)])
    places = np.rint(np.outer(bases, np.arange(1, 25)) / width).astype(int)
    heights = np.log(np.maximum(power[np.minimum(places, power.size - 1)] / floor, 1.0))
    return float(bases[heights.sum(axis=1).argmax()])


STEP = 5e-4
"""Time step of the power of a sound [s]."""

_SPECTRUM = 0.023
_AFTER, _BEFORE, _GAP = 8, (12, 40), 2
_FAINTEST = 1.8
_DEAD = 0.012
_MOST = 4_000
_LOWEST = 150.0


@dataclass(frozen=True, eq=False)
class HeardClicks:
    """Clicks of a sound, in their order."""

    times: FloatArray  # times, accurate to some milliseconds [s]
    contrasts: FloatArray  # ratio of the power after a click to the power before
    strengths: FloatArray  # difference of the power after and before a click / noise power
    sound: FloatArray  # sound without hum


def find_clicks(sound: FloatArray, rate: float) -> HeardClicks:
    """Return the clicks of a sound, including faint clicks."""
    sound = without_hum(sound, rate)
    filtered = emphasised(sound, rate)
    hop = max(1, round(rate * STEP))
    power = (filtered[: filtered.size // hop * hop].reshape(-1, hop) ** 2).mean(axis=1)
    floor = np.median(power) + np.finfo(float).tiny
    behind = _means(power, 0, _AFTER)
    # the sound before a click decays: the larger mean of a short and a long interval also masks echoes
    before = np.maximum(_means(power, -_BEFORE[0], -_GAP), _means(power, -_BEFORE[1], -_GAP))
    contrast = behind / np.maximum(before, floor)
    at = _peaks(contrast, int(_DEAD / STEP))
    return HeardClicks(at * hop / rate, contrast[at], np.maximum(behind - before, 0.0)[at] / floor, sound)


def emphasised(sound: FloatArray, rate: float) -> FloatArray:
    """Return a sound after the optimal filter for bursts in noise: Eckart, Scripps Report 52-11 (1952).

    The gain at each frequency is sqrt(S) / N, with the power N of the noise and the additional power S. The noise is
    that of the quietest quarter of the windows. A variable with two degrees of freedom is there below 0.288 of its
    mean.
    """
    size, noise, power = spectra(sound, rate)
    beyond = smooth(np.maximum(power.mean(axis=0) - noise, 0.0), 9)
    return np.asarray(oaconvolve(sound, causal(np.sqrt(beyond) / noise, rate, size))[: sound.size])


def spectra(sound: FloatArray, rate: float) -> tuple[int, FloatArray, FloatArray]:
    """Return the size of windows, the noise power by frequency, and the power of windows with 50 % overlap."""
    size = max(64, round(_SPECTRUM * rate))
    windows = sliding_window_view(sound, size)[:: size // 2]
    power = np.abs(rfft(windows * np.hanning(size))) ** 2
    noise = np.quantile(power, 0.25, axis=0) / 0.288
    return size, smooth(np.maximum(noise, 1e-9 * noise.max() + np.finfo(float).tiny), 3), power


def causal(gain: FloatArray, rate: float, size: int) -> FloatArray:
    """Return the impulse response of a gain with minimum phase, by the cepstrum, without low frequencies.

    With this response no output precedes its cause, and onsets stay sharp. Oppenheim & Schafer, Discrete-Time Signal
    Processing.
    """
    frequency = np.arange(gain.size) * rate / size
    gain = gain / (1.0 + (_LOWEST / np.maximum(frequency, 1e-9)) ** 8)
    count = 8 * (gain.size - 1)
    fine = np.interp(np.linspace(0.0, gain.size - 1.0, count // 2 + 1), np.arange(gain.size), gain)
    cepstrum = irfft(np.log(np.maximum(fine, 1e-6 * fine.max() + np.finfo(float).tiny)), count)
    cepstrum[1 : count // 2] *= 2.0
    cepstrum[count // 2 + 1 :] = 0.0
    response = irfft(np.exp(rfft(cepstrum)), count)[: count // 4]
    return np.asarray(response / np.abs(response).max())


def _means(values: FloatArray, first: int, last: int) -> FloatArray:
    """Return the mean over [i + first, i + last) at each i; intervals are truncated at both ends."""
    total = np.concatenate(([0.0], np.cumsum(values)))
    here = np.arange(values.size)
    low, high = np.clip(here + first, 0, values.size), np.clip(here + last, 0, values.size)
    return np.asarray((total[high] - total[low]) / np.maximum(high - low, 1))


def smooth(values: FloatArray, width: int) -> FloatArray:
    """Return running weighted means."""
    weights = np.hanning(width + 2)[1:-1]
    return np.convolve(np.pad(values, width // 2, mode="edge"), weights / weights.sum(), "valid")


def _peaks(contrast: FloatArray, apart: int) -> IntArray:
    """Return the peaks of the contrast; only the higher of two close peaks is returned."""
    inner = (contrast[1:-1] > contrast[:-2]) & (contrast[1:-1] >= contrast[2:]) & (contrast[1:-1] > _FAINTEST)
    peaks = np.flatnonzero(inner) + 1
    is_near_peak = np.zeros(contrast.size, dtype=bool)
    kept = []
    for peak in peaks[np.argsort(-contrast[peaks])][:_MOST]:
        if not is_near_peak[peak]:
            kept.append(peak)
            is_near_peak[max(0, peak - apart) : peak + apart + 1] = True
    return np.sort(np.array(kept, dtype=np.int64))
