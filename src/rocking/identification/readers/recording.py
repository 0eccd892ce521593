"""Recordings of sound: WAV, read here, and FLAC, OGG, MP3 and AIFF through libsndfile."""

import io
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

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
            raise self.error(
                "its rate must be in [{lowest}, {highest}] Hz, got {rate}; a damaged header?",
                lowest=RATES[0],
                highest=RATES[1],
                rate=self.rate,
            )
        count = self.samples.shape[0]
        if count > MOST_SAMPLES:
            raise self.error(
                "it has {count} samples, more than the {limit} that are read", count=count, limit=MOST_SAMPLES,
                hint="cut out the trial",
            )  # fmt: skip
        if count < _SHORTEST * self.rate:
            raise self.error(
                "it lasts {duration:.3g} s; a trial takes at least {shortest} s", duration=count / self.rate,
                shortest=_SHORTEST,
            )  # fmt: skip
        if not np.isfinite(self.samples).all():
            bad = int(np.flatnonzero(~np.isfinite(self.samples).all(axis=1))[0])
            raise self.error(
                "sample {index} is not finite ({time:.4g} s)", index=bad, time=bad / self.rate, hint="a damaged file?"
            )

    def error(self, cause: str, **facts: Any) -> MeasurementError:
        """Return the error for a cause, to be raised; facts: as of `RockingError`."""
        return MeasurementError(cause, **facts).at(self.name)

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
        for channel in self.samples.T[np.ptp(self.samples, axis=0) > 0.0]:
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
                    "it has {count} samples, more than the {limit} that are read", count=file.frames, limit=MOST_SAMPLES
                ).at(name)
            samples, rate, stated = file.read(dtype="float64", always_2d=True), file.samplerate, file.frames
    except soundfile.LibsndfileError as error:
        raise MeasurementError("cannot be read as sound ({reason})", reason=str(error), hint="damaged?").at(
            name
        ) from error
    if samples.shape[0] != stated:
        raise MeasurementError(
            "states {stated} samples, {count} could be read", stated=stated, count=samples.shape[0], hint="cut off?"
        ).at(name)
    return Recording(name, np.asarray(samples), int(rate))


_PCM, _FLOAT, _EXTENSIBLE = 1, 3, 0xFFFE
_REST_OF_GUID = bytes.fromhex("000000001000800000aa00389b71")
_MOST_CHANNELS = 32


def read_wav(content: bytes, name: str) -> Recording:
    """Return the sound of a WAV file.

    Microsoft, Multimedia Programming Interface and Data Specifications 1.0 (1991); WAVE_FORMAT_EXTENSIBLE as well.
    """
    form: tuple[int, int, int, int] | None = None
    for kind, chunk in _chunks(content, name):
        if kind == b"fmt ":
            if form is not None:
                raise MeasurementError("it has two format chunks", hint="damaged?").at(name)
            form = _form(chunk, name)
        elif kind == b"data":
            if form is None:
                raise MeasurementError("its samples come before their format", hint="damaged?").at(name)
            return Recording(name, _samples(chunk, form, name), form[2])
    raise MeasurementError(
        "it has no format: cut off, or damaged" if form is None else "it has no samples: cut off, or damaged"
    ).at(name)


def _chunks(content: bytes, name: str) -> Iterator[tuple[bytes, bytes]]:
    if content[:4] != b"RIFF" or content[8:12] != b"WAVE":
        raise MeasurementError("is no WAV file: it begins with {start}, not RIFF....WAVE", start=repr(content[:12])).at(
            name
        )
    (stated,) = struct.unpack_from("<I", content, 4)
    if stated + 8 not in {len(content), len(content) - 1, len(content) + 1}:  # some writers forget to pad
        raise MeasurementError(
            "its header states {stated} bytes, the file has {size}; cut off, or never finished: save it again from "
            "the recorder or an audio editor", stated=stated + 8, size=len(content),
        ).at(name)  # fmt: skip
    at = 12
    while at + 8 <= len(content):
        kind, size = struct.unpack_from("<4sI", content, at)
        if at + 8 + size > len(content):
            raise MeasurementError(
                "chunk {chunk} at byte {byte} states {stated} bytes, {size} are left", chunk=repr(kind), byte=at,
                stated=size, size=len(content) - at - 8, hint="cut off?",
            ).at(name)  # fmt: skip
        yield kind, content[at + 8 : at + 8 + size]
        at += 8 + size + size % 2


def _form(chunk: bytes, name: str) -> tuple[int, int, int, int]:
    """Return the code of the encoding, channels, rate and bits."""
    if len(chunk) < 16:
        raise MeasurementError(
            "its format chunk has {size} bytes, at least 16 expected", size=len(chunk), hint="damaged?"
        ).at(name)
    code, channels, rate, per_second, per_frame, bits = struct.unpack_from("<HHIIHH", chunk)
    if code == _EXTENSIBLE:
        if len(chunk) < 40 or chunk[26:40] != _REST_OF_GUID:
            raise MeasurementError("its extended format cannot be understood", hint="save it as plain PCM").at(name)
        (code,) = struct.unpack_from("<H", chunk, 24)
    if (code, bits) not in {(_PCM, 8), (_PCM, 16), (_PCM, 24), (_PCM, 32), (_FLOAT, 32), (_FLOAT, 64)}:
        raise MeasurementError(
            "encoding {code} of {bits} bits is not read", code=code, bits=bits, hint="save it as PCM of 16 or 24 bits"
        ).at(name)
    if not 1 <= channels <= _MOST_CHANNELS:
        raise MeasurementError(
            "{name}: channels must be in [1, {most}], got {channels}; damaged?",
            name=name,
            most=_MOST_CHANNELS,
            channels=channels,
        )
    if per_frame != channels * bits // 8 or per_second != rate * per_frame:
        raise MeasurementError(
            "{channels} channels of {bits} bits at {rate} Hz are {frame} bytes a frame and {second} a second, the "
            "header states {stated_frame} and {stated_second}", channels=channels, bits=bits, rate=rate,
            frame=channels * bits // 8, second=rate * channels * bits // 8, stated_frame=per_frame,
            stated_second=per_second, hint="damaged?",
        ).at(name)  # fmt: skip
    return code, channels, rate, bits


def _samples(chunk: bytes, form: tuple[int, int, int, int], name: str) -> FloatArray:
    code, channels, _, bits = form
    if not chunk or len(chunk) % (channels * bits // 8):
        raise MeasurementError(
            "it has {size} bytes of samples, no whole number of frames" if chunk else "it has no samples",
            size=len(chunk), hint="cut off, or never finished",
        ).at(name)  # fmt: skip
    if code == _FLOAT:
        values: FloatArray = np.frombuffer(chunk, f"<f{bits // 8}").astype(np.float64)
    elif bits == 8:
        values = np.asarray((np.frombuffer(chunk, np.uint8) - 128.0) / 128.0, dtype=np.float64)
    elif bits == 24:
        wide = np.zeros((len(chunk) // 3, 4), np.uint8)
        wide[:, 1:] = np.frombuffer(chunk, np.uint8).reshape(-1, 3)
        values = np.asarray(wide.view("<i4")[:, 0] / 2.0**31, dtype=np.float64)
    else:
        values = np.asarray(
            np.frombuffer(chunk, f"<i{bits // 8}").astype(np.float64) / 2.0 ** (bits - 1), dtype=np.float64
        )
    return np.asarray(values.reshape(-1, channels))
