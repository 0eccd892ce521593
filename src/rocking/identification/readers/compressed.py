"""FLAC, OGG, MP3 and AIFF, through libsndfile; what phones call M4A is none of these."""

import io

import numpy as np

from rocking.errors import MeasurementError, extra
from rocking.identification.readers.recording import MOST_SAMPLES, Recording

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
