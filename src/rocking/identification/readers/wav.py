"""WAV: PCM of 8, 16, 24 and 32 bits and floats, read by the sizes that the header states, which must hold."""

import struct
from collections.abc import Iterator

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import MeasurementError
from rocking.identification.readers.recording import Recording

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
                raise MeasurementError(f"{name}: it has two format chunks; damaged?")
            form = _form(chunk, name)
        elif kind == b"data":
            if form is None:
                raise MeasurementError(f"{name}: its samples come before their format; damaged?")
            return Recording(name, _samples(chunk, form, name), form[2])
    raise MeasurementError(f"{name}: it has no {'format' if form is None else 'samples'}: cut off, or damaged")


def _chunks(content: bytes, name: str) -> Iterator[tuple[bytes, bytes]]:
    if content[:4] != b"RIFF" or content[8:12] != b"WAVE":
        raise MeasurementError(f"{name}: is no WAV file: it begins with {content[:12]!r}, not RIFF....WAVE")
    (stated,) = struct.unpack_from("<I", content, 4)
    if stated + 8 not in {len(content), len(content) - 1, len(content) + 1}:  # some writers forget to pad
        raise MeasurementError(
            f"{name}: its header states {stated + 8} bytes, the file has {len(content)}; cut off, or never finished:"
            " save it again from the recorder or an audio editor"
        )
    at = 12
    while at + 8 <= len(content):
        kind, size = struct.unpack_from("<4sI", content, at)
        if at + 8 + size > len(content):
            raise MeasurementError(
                f"{name}: chunk {kind!r} at byte {at} states {size} bytes, {len(content) - at - 8} are left; cut off?"
            )
        yield kind, content[at + 8 : at + 8 + size]
        at += 8 + size + size % 2


def _form(chunk: bytes, name: str) -> tuple[int, int, int, int]:
    """Return the code of the encoding, channels, rate and bits."""
    if len(chunk) < 16:
        raise MeasurementError(f"{name}: its format chunk has {len(chunk)} bytes, at least 16 expected; damaged?")
    code, channels, rate, per_second, per_frame, bits = struct.unpack_from("<HHIIHH", chunk)
    if code == _EXTENSIBLE:
        if len(chunk) < 40 or chunk[26:40] != _REST_OF_GUID:
            raise MeasurementError(f"{name}: its extended format cannot be understood; save it as plain PCM")
        (code,) = struct.unpack_from("<H", chunk, 24)
    if (code, bits) not in {(_PCM, 8), (_PCM, 16), (_PCM, 24), (_PCM, 32), (_FLOAT, 32), (_FLOAT, 64)}:
        raise MeasurementError(f"{name}: encoding {code} of {bits} bits is not read; save it as PCM of 16 or 24 bits")
    if not 1 <= channels <= _MOST_CHANNELS:
        raise MeasurementError(f"{name}: channels must be in [1, {_MOST_CHANNELS}], got {channels}; damaged?")
    if per_frame != channels * bits // 8 or per_second != rate * per_frame:
        raise MeasurementError(
            f"{name}: {channels} channels of {bits} bits at {rate} Hz are {channels * bits // 8} bytes a frame and"
            f" {rate * channels * bits // 8} a second, the header states {per_frame} and {per_second}; damaged?"
        )
    return code, channels, rate, bits


def _samples(chunk: bytes, form: tuple[int, int, int, int], name: str) -> FloatArray:
    code, channels, _, bits = form
    if not chunk or len(chunk) % (channels * bits // 8):
        what = "no samples" if not chunk else f"{len(chunk)} bytes of samples, no whole number of frames"
        raise MeasurementError(f"{name}: it has {what}; cut off, or never finished")
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
