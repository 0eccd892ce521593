"""The hum of the mains, taken out of a sound without touching its clicks."""

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from rocking.conventions import FloatArray

_LOW_RATE = 4_000.0
_HIGHEST = 1_500.0
_BLOCK = 2.0


def without_hum(sound: FloatArray, rate: float) -> FloatArray:
    """Return a sound less the multiples of 50 or 60 Hz that fit it best, block by block.

    A comb filter would repeat every click, and narrow filters would ring for a second; a least-squares fit of some
    fifty sines to two seconds takes less than one part in a hundred of a click.
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
        part = slice(first, first + size)
        hum[part] += window * (sines @ (sines.T @ sound[part]))
        weight[part] += window
    return np.asarray(hum / weight)


def _base(sound: FloatArray, rate: float) -> float:
    """Return the frequency near 50 or 60 Hz whose multiples stand out most [Hz]."""
    size = next_fast_len(4 * sound.size, real=True)
    power = np.abs(rfft(sound * np.hanning(sound.size), size)) ** 2
    width = rate / size
    floor = np.median(power[: int(_HIGHEST / width)]) + np.finfo(float).tiny
    bases = np.concatenate([mains + np.arange(-0.3, 0.301, 0.002) for mains in (50.0, 60.0)])
    places = np.rint(np.outer(bases, np.arange(1, 25)) / width).astype(int)
    heights = np.log(np.maximum(power[np.minimum(places, power.size - 1)] / floor, 1.0))
    return float(bases[heights.sum(axis=1).argmax()])
