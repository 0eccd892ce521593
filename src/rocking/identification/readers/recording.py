"""A recording of sound, whatever file it came from: FLAC, OGG, MP3 and AIFF through libsndfile."""

import io
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import MeasurementError, extra

RATES = (4_000, 384_000)
"""Sounds of other rates are refused [Hz]: an impact is a click of a few kHz."""

MOST_SAMPLES = 32_000_000
"""Longer recordings are refused, 12 minutes at 44.1 kHz: a trial lasts seconds."""

_SHORTEST = 0.25
_CLIPPED = 3


@dataclass(frozen=True, eq=False)
class Recording:
    """Samples of shape (samples, channels), full scale 1, and their rate [Hz]."""

    name: str
    samples: FloatArray
    rate: int

    def __post_init__(self) -> None:
        """Refuse what cannot hold the sound of impacts."""
        if not RATES[0] <= self.rate <= RATES[1]:
            raise self.error(f"its rate must be in [{RATES[0]}, {RATES[1]}] Hz, got {self.rate}; a damaged header?")
        count = self.samples.shape[0]
        if count > MOST_SAMPLES:
            raise self.error(f"it has {count} samples, more than the {MOST_SAMPLES} that are read; cut out the trial")
        if count < _SHORTEST * self.rate:
            raise self.error(f"it lasts {count / self.rate:.3g} s; a trial takes at least {_SHORTEST} s")
        if not np.isfinite(self.samples).all():
            bad = int(np.flatnonzero(~np.isfinite(self.samples).all(axis=1))[0])
            raise self.error(f"sample {bad} is not finite ({bad / self.rate:.4f} s); a damaged file?")

    def error(self, cause: str) -> MeasurementError:
        """Return the error for a cause, to be raised."""
        return MeasurementError(f"{self.name}: {cause}")

    @property
    def channel(self) -> FloatArray:
        """The channel that stands out of its own noise most, without its mean."""
        found = self.samples - self.samples.mean(axis=0)
        peaks = np.abs(found).max(axis=0)
        if not peaks.any():
            raise self.error("it is silent: every sample has the same value; was the microphone off?")
        median = np.median(np.abs(found), axis=0)
        best = np.argmax(np.divide(peaks, median, out=np.array(peaks), where=median > 0.0))
        return np.asarray(found[:, best] / peaks[best])

    @property
    def clipped(self) -> int:
        """Runs of samples that stay at the largest value of a channel, three or more."""
        most = 0
        for channel in self.samples.T:
            at_limit = np.abs(channel) >= 0.999 * np.abs(channel).max()
            runs = np.diff(np.flatnonzero(np.diff(np.concatenate(([0], at_limit, [0])))))[::2]
            most = max(most, int((runs >= _CLIPPED).sum()))
        return most


COMPRESSED = (".flac", ".ogg", ".oga", ".opus", ".mp3", ".aif", ".aiff")
"""Suffixes of what libsndfile reads."""


def read_compressed(content: bytes, name: str) -> Recording:
    """Return the sound of a file that libsndfile reads."""
    soundfile = extra("soundfile", "reading FLAC, OGG or MP3")
    try:
        with soundfile.SoundFile(io.BytesIO(content)) as file:
            if file.frames > MOST_SAMPLES:
                raise MeasurementError(
                    f"{name}: it has {file.frames} samples, more than the {MOST_SAMPLES} that are read"
                )
            samples, rate, stated = file.read(dtype="float64", always_2d=True), file.samplerate, file.frames
    except soundfile.LibsndfileError as error:
        raise MeasurementError(f"{name}: cannot be read as sound ({error}); damaged?") from error
    if samples.shape[0] != stated:
        raise MeasurementError(f"{name}: states {stated} samples, {samples.shape[0]} could be read; cut off?")
    return Recording(name, np.asarray(samples), int(rate))
