"""Recordings of sound: WAV files are read here, and FLAC, OGG, MP3 and AIFF files through libsndfile."""

import io
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import MeasurementError, extra

RATES = (4_000, 384_000)
"""Allowed range of the sampling rate [Hz], because an impact is a click of a few kHz."""

MOST_SAMPLES = 32_000_000
"""Largest number of samples of a recording: 12 minutes at 44.1 kHz. A trial lasts seconds."""

_SHORTEST = 0.25
_CLIPPED = 3


@dataclass(frozen=True, eq=False)
class Recording:
    """Samples of shape (samples, channels) with full scale 1, and their rate [Hz]."""

    name: str
    samples: FloatArray
    rate: int

    def __post_init__(self) -> None:
        """Refuse recordings that cannot contain the sound of impacts."""
        if not RATES[0] <= self.rate <= RATES[1]:
            raise self.error(
                "the sampling rate must be in [{lowest}, {highest}] Hz, got {rate}; the header may be damaged",
                lowest=RATES[0],
                highest=RATES[1],
                rate=self.rate,
            )
        count = self.samples.shape[0]
        if count > MOST_SAMPLES:
            raise self.error(
                "the sound has {count} samples; at most {limit} samples are allowed", count=count, limit=MOST_SAMPLES,
                hint="cut out the trial",
            )  # fmt: skip
        if count < _SHORTEST * self.rate:
            raise self.error(
                "the duration is {duration:.3g} s; at least {shortest} s are required", duration=count / self.rate,
                shortest=_SHORTEST,
            )  # fmt: skip
        if not np.isfinite(self.samples).all():
            bad = int(np.flatnonzero(~np.isfinite(self.samples).all(axis=1))[0])
            raise self.error(
                "sample {index} is not finite ({time:.4g} s)",
                index=bad,
                time=bad / self.rate,
                hint="the file may be damaged",
            )

    def error(self, cause: str, **facts: Any) -> MeasurementError:
        """Return the error for a cause, with the facts of `RockingError`."""
        return MeasurementError(cause, **facts).at(self.name)

    @property
    def channel(self) -> FloatArray:
        """The channel with the largest contrast to its own noise, without its mean."""
        centred = self.samples - self.samples.mean(axis=0)
        peaks = np.abs(centred).max(axis=0)
        if not peaks.any():
            raise self.error("the sound is silent: all samples are equal; check the microphone")
        median = np.median(np.abs(centred), axis=0)
        best = np.argmax(np.divide(peaks, median, out=np.array(peaks), where=median > 0.0))
        return np.asarray(centred[:, best] / peaks[best])

    @property
    def clipped(self) -> int:
        """Largest number of runs of three or more samples at the maximum of a channel."""
        most = 0
        for channel in self.samples.T[np.ptp(self.samples, axis=0) > 0.0]:
            at_limit = np.abs(channel) >= 0.999 * np.abs(channel).max()
            runs = np.diff(np.flatnonzero(np.diff(np.concatenate(([0], at_limit, [0])))))[::2]
            most = max(most, int((runs >= _CLIPPED).sum()))
        return most


COMPRESSED = (".flac", ".ogg", ".oga", ".opus", ".mp3", ".aif", ".aiff")
"""Extensions of files for libsndfile."""


def read_compressed(content: bytes, name: str) -> Recording:
    """Return the sound of a file read by libsndfile."""
    soundfile = extra("soundfile", "reading FLAC, OGG or MP3")
    try:
        with soundfile.SoundFile(io.BytesIO(content)) as file:
            if file.frames > MOST_SAMPLES:
                raise MeasurementError(
                    "the sound has {count} samples; at most {limit} samples are allowed",
                    count=file.frames,
                    limit=MOST_SAMPLES,
                ).at(name)
            samples, rate, stated = file.read(dtype="float64", always_2d=True), file.samplerate, file.frames
    except soundfile.LibsndfileError as error:
        raise MeasurementError(
            "the file cannot be read as sound ({reason})", reason=str(error), hint="the file may be damaged"
        ).at(name) from error
    if samples.shape[0] != stated:
        raise MeasurementError(
            "the header states {stated} samples, the file contains {count}",
            stated=stated,
            count=samples.shape[0],
            hint="the file may be incomplete",
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
                raise MeasurementError("the file has two format chunks", hint="the file may be damaged").at(name)
            form = _form(chunk, name)
        elif kind == b"data":
            if form is None:
                raise MeasurementError("the samples precede the format chunk", hint="the file may be damaged").at(name)
            return Recording(name, _samples(chunk, form, name), form[2])
    raise MeasurementError(
        "no format chunk: the file may be incomplete" if form is None else "no samples: the file may be incomplete"
    ).at(name)


def _chunks(content: bytes, name: str) -> Iterator[tuple[bytes, bytes]]:
    if content[:4] != b"RIFF" or content[8:12] != b"WAVE":
        raise MeasurementError("not a WAV file: it begins with {start}, not RIFF....WAVE", start=repr(content[:12])).at(
            name
        )
    (stated,) = struct.unpack_from("<I", content, 4)
    if stated + 8 not in {len(content), len(content) - 1, len(content) + 1}:  # some programs omit the padding byte
        raise MeasurementError(
            "the header states {stated} bytes, the file has {size}; save the sound again from the recorder or an "
            "audio editor", stated=stated + 8, size=len(content),
        ).at(name)  # fmt: skip
    at = 12
    while at + 8 <= len(content):
        kind, size = struct.unpack_from("<4sI", content, at)
        if at + 8 + size > len(content):
            raise MeasurementError(
                "chunk {chunk} at byte {byte} states {stated} bytes, {size} remain", chunk=repr(kind), byte=at,
                stated=size, size=len(content) - at - 8, hint="the file may be incomplete",
            ).at(name)  # fmt: skip
        yield kind, content[at + 8 : at + 8 + size]
        at += 8 + size + size % 2


def _form(chunk: bytes, name: str) -> tuple[int, int, int, int]:
    """Return the code of the encoding, channels, rate and bits."""
    if len(chunk) < 16:
        raise MeasurementError(
            "the format chunk has {size} bytes; at least 16 are required",
            size=len(chunk),
            hint="the file may be damaged",
        ).at(name)
    code, channels, rate, per_second, per_frame, bits = struct.unpack_from("<HHIIHH", chunk)
    if code == _EXTENSIBLE:
        if len(chunk) < 40 or chunk[26:40] != _REST_OF_GUID:
            raise MeasurementError("unknown extended format", hint="save it as plain PCM").at(name)
        (code,) = struct.unpack_from("<H", chunk, 24)
    if (code, bits) not in {(_PCM, 8), (_PCM, 16), (_PCM, 24), (_PCM, 32), (_FLOAT, 32), (_FLOAT, 64)}:
        raise MeasurementError(
            "encoding {code} with {bits} bits is not supported",
            code=code,
            bits=bits,
            hint="save it as PCM with 16 or 24 bits",
        ).at(name)
    if not 1 <= channels <= _MOST_CHANNELS:
        raise MeasurementError(
            "{name}: channels must be in [1, {most}], got {channels}; the file may be damaged",
            name=name,
            most=_MOST_CHANNELS,
            channels=channels,
        )
    if per_frame != channels * bits // 8 or per_second != rate * per_frame:
        raise MeasurementError(
            "{channels} channels of {bits} bits at {rate} Hz are {frame} bytes a frame and {second} a second, the "
            "header states {stated_frame} and {stated_second}", channels=channels, bits=bits, rate=rate,
            frame=channels * bits // 8, second=rate * channels * bits // 8, stated_frame=per_frame,
            stated_second=per_second, hint="the file may be damaged",
        ).at(name)  # fmt: skip
    return code, channels, rate, bits


def _samples(chunk: bytes, form: tuple[int, int, int, int], name: str) -> FloatArray:
    code, channels, _, bits = form
    if not chunk or len(chunk) % (channels * bits // 8):
        raise MeasurementError(
            "{size} bytes of samples are not an integer number of frames" if chunk else "no samples",
            size=len(chunk), hint="the file may be incomplete",
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
