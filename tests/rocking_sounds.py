"""Sounds for tests of readers: a body that rocks in a room, and what is no rocking. From a generator, always the same.

An impact is a half-sine of force of .2 to 1 ms that excites damped modes of the body; its sound is their velocity, in
closed form, so that an impact may lie between samples. A foot has weights of its own for the modes. The room adds
early reflections and a tail of noise that decays by 60 dB in .3 to .8 s, 0 to 10 dB weaker in energy than the direct
sound; the noise has a spectrum f^-a, a in [0, 1]; the mains hum at 50 or 60 Hz with eleven harmonics, up to 20 dB above
the noise. Every third sound is clipped at .3 to .8 of its peak.

**Decibels above the noise**: peak of the direct sound of the weakest impact over the root mean square of the noise,
hum not counted. It is the strictest of the usual measures, since the first impacts are some 10 dB stronger.
"""

import io
import struct
from dataclasses import dataclass

import numpy as np
from scipy.signal import fftconvolve

RATE = 44_100


@dataclass(frozen=True)
class RockingSound:
    """A recording and the truth about it."""

    samples: np.ndarray
    times: np.ndarray  # at which the force of each impact begins [s]


def impact_times(rng, count=11):
    """Times and speeds of impacts: T = (2/p) atanh y, y falls by r of each side, a tilt and a scatter of 1 %."""
    p, y = rng.uniform(1.5, 4.0), rng.uniform(0.6, 0.9)
    sides = rng.uniform(0.85, 0.93) + rng.uniform(-0.02, 0.02, 2)
    tilt = rng.uniform(-0.05, 0.05)
    times, speeds = [rng.uniform(0.5, 1.5)], [y]
    for n in range(count - 1):
        ratio = sides[n % 2] * ((1.0 + tilt) / (1.0 - tilt)) ** (1 - 2 * (n % 2)) * np.exp(rng.normal(0.0, 0.01))
        y = min(y * ratio, 0.98)
        times.append(times[-1] + 2.0 / p * np.arctanh(y))
        speeds.append(y)
    return np.array(times), np.array(speeds)


def struck(time, frequencies, damping, weights, width):
    """Velocity of modes under a half-sine of force that begins at time 0 and lasts `width`."""
    a, until = np.pi / width, np.clip(time, 0.0, width)[:, None]
    pole = 2.0 * np.pi * frequencies * (1j * np.sqrt(1.0 - damping**2) - damping)
    grown = np.exp(-pole * until) * (pole * np.sin(a * until) + a * np.cos(a * until))
    modes = np.exp(pole * np.maximum(time, 0.0)[:, None]) * (a - grown) / (pole**2 + a**2)
    return (modes.real * weights).sum(axis=1) * (time > 0.0)


def room(rng):
    """Impulse response: direct sound, early reflections, a tail."""
    decay = rng.uniform(0.3, 0.8)
    time = np.arange(int(decay * RATE)) / RATE
    tail = rng.normal(size=time.size) * np.exp(-6.9 * time / decay) * (time > rng.uniform(0.004, 0.012))
    for delay in rng.uniform(0.002, 0.04, rng.integers(4, 10)):
        tail[int(delay * RATE)] += rng.choice([-1.0, 1.0]) * 6.0 * np.exp(-delay / 0.02)
    tail *= np.sqrt(10.0 ** (-rng.uniform(0.0, 10.0) / 10.0) / (tail**2).sum())
    tail[0] += 1.0
    return tail


def noise(rng, count):
    """Coloured noise of root mean square 1."""
    spectrum = np.fft.rfft(rng.normal(size=count))
    frequency = np.maximum(np.fft.rfftfreq(count, 1.0 / RATE), 50.0)
    made = np.fft.irfft(spectrum * frequency ** -rng.uniform(0.0, 0.5), count)
    return made / made.std()


def hum(rng, count):
    """Mains hum, 0 to 20 dB above noise of root mean square 1."""
    time = np.arange(count) / RATE
    base = rng.choice([50.0, 60.0]) * (1.0 + rng.uniform(-1e-3, 1e-3))
    made = sum(
        rng.uniform(0.2, 1.0) / k * np.sin(2.0 * np.pi * k * base * time + rng.uniform(0.0, 6.3)) for k in range(1, 13)
    )
    return made * 10.0 ** rng.uniform(0.0, 1.0) / made.std()


class Clicks:
    """Impacts of one body on its two feet."""

    def __init__(self, rng):
        count = rng.integers(6, 13)
        self.rng = rng
        self.frequencies = np.exp(rng.uniform(np.log(200.0), np.log(6000.0), count))
        self.damping = rng.uniform(0.005, 0.04, count)
        self.weights = rng.normal(size=(2, count)) * rng.uniform(0.5, 1.5, (2, 1))
        self.width = rng.uniform(2e-4, 1e-3)

    def at(self, times, strengths, count):
        """Direct sound of impacts, on one foot after the other, and the peak of each."""
        made, peaks = np.zeros(count), []
        for n, (time, strength) in enumerate(zip(times, strengths, strict=True)):
            first = int(time * RATE)
            reach = min(count - first, int(0.25 * RATE))
            weights = self.weights[n % 2] * np.exp(self.rng.normal(0.0, 0.15, self.frequencies.size))
            local = (first + np.arange(reach)) / RATE - time
            sound = strength * struck(local, self.frequencies, self.damping, weights, self.width * strength**-0.2)
            made[first : first + reach] += sound
            peaks.append(np.abs(sound).max())
        return made, np.array(peaks)


def recorded(rng, direct, peak, decibels):
    """Put a direct sound into a room with noise and hum; `peak` stands `decibels` above the noise."""
    heard = fftconvolve(direct, room(rng))[: direct.size]
    level = peak / 10.0 ** (decibels / 20.0)
    heard += level * (noise(rng, direct.size) + hum(rng, direct.size))
    heard *= 0.7 / np.abs(heard).max()
    if rng.random() < 1.0 / 3.0:
        limit = 0.7 * rng.uniform(0.3, 0.8)
        heard = np.clip(heard, -limit, limit)
    return heard


def rocking(seed, decibels, count=11, silent=()):
    """A rocking body: its recording, and when it struck; some impacts may make no sound, and are no times."""
    rng = np.random.default_rng(seed)
    times, speeds = impact_times(rng, count)
    size = int((times[-1] + rng.uniform(0.5, 1.5)) * RATE)
    heard = ~np.isin(np.arange(count), silent)
    direct, peaks = Clicks(rng).at(times, np.where(heard, speeds, 1e-9), size)
    return RockingSound(recorded(rng, direct, peaks[heard].min(), decibels), times[heard])


def clapping(rng):
    """Somebody claps: a tempo that wanders, a scatter of 3 to 8 % a clap, and of 3 dB in strength."""
    count, period = rng.integers(8, 30), rng.uniform(0.25, 0.8)
    tempo = period * np.exp(np.cumsum(rng.normal(0.0, 0.02, count)) + rng.normal(0.0, rng.uniform(0.03, 0.08), count))
    return 0.5 + np.cumsum(tempo), np.exp(rng.normal(0.0, 0.35, count))


def metronome(rng):
    """Beats to a millisecond, the first of every bar accented or not."""
    count, period = rng.integers(8, 40), rng.uniform(0.25, 1.2)
    accent = 1.0 + rng.uniform(0.0, 1.0) * (np.arange(count) % rng.integers(2, 5) == 0)
    return 0.5 + period * np.arange(count) + rng.normal(0.0, 1e-3, count), accent


def rain(rng):
    """Drops that fall when they like."""
    length = rng.uniform(5.0, 12.0)
    count = rng.poisson(length * np.exp(rng.uniform(np.log(2.0), np.log(60.0))))
    return np.sort(rng.uniform(0.2, length, count)), np.exp(rng.normal(0.0, 0.8, count))


def speech(rng):
    """Syllables of a voiced buzz through formants, or of hiss, three to six a second."""
    length = rng.uniform(5.0, 10.0)
    made, at = np.zeros(int(length * RATE)), 0.3
    while at < length - 0.6:
        lasts = rng.uniform(0.08, 0.25)
        size = int(lasts * RATE)
        time = np.arange(size) / RATE
        if rng.random() < 0.7:
            pitch = rng.uniform(90.0, 240.0) * (1.0 + rng.uniform(-0.2, 0.2) * time / lasts)
            source = np.diff(np.floor(np.cumsum(pitch) / RATE), prepend=0.0)
        else:
            source = 0.05 * rng.normal(size=size)
        for formant in rng.uniform([300.0, 900.0, 2200.0], [800.0, 2000.0, 3000.0]):
            ring = np.exp(-250.0 * time[:2000]) * np.sin(2.0 * np.pi * formant * time[:2000])
            source = fftconvolve(source, ring)[:size]
        envelope = np.minimum(1.0, np.minimum(time / rng.uniform(0.005, 0.04), (lasts - time) / 0.05))
        first = int(at * RATE)
        made[first : first + size] += source / np.abs(source).max() * envelope * rng.uniform(0.3, 1.0)
        at += lasts + rng.exponential(0.06) + (rng.random() < 0.15) * 0.4
    return made


def no_rocking(kind, seed):
    """A sound that is no rocking, 30 dB above its noise."""
    rng = np.random.default_rng(seed)
    if kind == "speech":
        made = speech(rng)
        return recorded(rng, made, np.abs(made).max(), 30.0)
    times, strengths = {"clapping": clapping, "metronome": metronome, "rain": rain}[kind](rng)
    made, peaks = Clicks(rng).at(times, strengths, int((times[-1] + 1.0) * RATE))
    return recorded(rng, made, np.median(peaks), 30.0)


def wav(samples, rate=RATE, bits=16):
    """Content of a WAV file: PCM of 8, 16, 24 or 32 bits, or with `bits` -32 or -64 floats; channels are columns."""
    samples = np.asarray(samples)
    channels, width = (1 if samples.ndim == 1 else samples.shape[1]), abs(bits) // 8
    if bits < 0:
        data = samples.astype(f"<f{width}").tobytes()
    elif bits == 8:
        data = np.round(samples * 127.0 + 128.0).astype(np.uint8).tobytes()
    else:
        whole = np.round(samples * (2.0 ** (bits - 1) - 1.0)).astype("<i8")
        data = whole.reshape(-1, 1).view(np.uint8)[:, :width].tobytes()
    form = struct.pack(
        "<HHIIHH", 3 if bits < 0 else 1, channels, rate, rate * channels * width, channels * width, abs(bits)
    )
    padded = data + b"\0" * (len(data) % 2)
    made = io.BytesIO()
    made.write(b"RIFF" + struct.pack("<I", 4 + 24 + 8 + len(padded)) + b"WAVEfmt " + struct.pack("<I", 16) + form)
    made.write(b"data" + struct.pack("<I", len(data)) + padded)
    return made.getvalue()
