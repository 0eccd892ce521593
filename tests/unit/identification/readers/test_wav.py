"""WAV files of every encoding, and damaged ones."""

import random
import struct

import numpy as np
import pytest
from rocking_sounds import RATE, rocking, wav

from rocking.errors import MeasurementError, MissingExtraError
from rocking.identification.readers import read_measurement
from rocking.identification.readers.recording import read_compressed, read_wav

SINE = 0.5 * np.sin(np.arange(4410) * 0.1)


@pytest.mark.parametrize(("bits", "step"), [(8, 0.02), (16, 4e-5), (24, 2e-7), (32, 1e-9), (-32, 1e-7), (-64, 0.0)])
def test_encodings(bits, step):
    """Every encoding, of two channels, gives the samples back to its resolution."""
    samples = np.column_stack([SINE, -0.5 * SINE])
    read = read_wav(wav(samples, 8000, bits), "a.wav")
    assert read.rate == 8000
    np.testing.assert_allclose(read.samples, samples, rtol=0.0, atol=step)


def test_the_channel_that_stands_out():
    quiet = np.random.default_rng(1).normal(size=SINE.size)
    click = 0.01 * quiet
    click[2000] = 0.9
    read = read_wav(wav(np.column_stack([0.2 * quiet.clip(-2, 2), click]), 8000), "a.wav")
    assert np.abs(read.channel).argmax() == 2000


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (wav(SINE)[:-100], "save the sound again"),
        (b"RIFX" + wav(SINE)[4:], "not a WAV file"),
        (wav(SINE[:0]), "no samples"),
        (wav(SINE[:100]), "the duration is"),
        (wav(0.0 * SINE, 8000), "silent"),
        (wav(np.where(np.arange(4410) == 100, np.nan, SINE), 8000, -32), "sample 100 is not finite"),
        (wav(SINE, 100), "rate must be in"),
        (wav(SINE)[:28] + struct.pack("<I", 7) + wav(SINE)[32:], "the header states"),
        (wav(SINE)[:20] + struct.pack("<H", 85) + wav(SINE)[22:], "encoding 85"),
    ],
)
def test_refusals(tmp_path, content, words):
    path = tmp_path / "bad.wav"
    path.write_bytes(content)
    with pytest.raises(MeasurementError, match=words):
        read_measurement(path)


def test_damaged_files_are_read_or_refused():
    """3,000 files with bytes changed, cut out or put in: refused by one class, or finite numbers."""
    draw, whole, refused = random.Random(3), wav(SINE, 8000), 0
    for _ in range(3000):
        content = bytearray(whole)
        place = draw.randrange(60 if draw.random() < 0.8 else len(content))
        if (way := draw.randrange(3)) == 0:
            content[place] = draw.randrange(256)
        elif way == 1:
            del content[place : place + draw.randrange(1, 200)]
        else:
            content[place:place] = draw.randbytes(draw.randrange(1, 40))
        try:
            assert np.isfinite(read_wav(bytes(content), "a.wav").samples).all()
        except MeasurementError:
            refused += 1
    assert refused > 1500


@pytest.mark.slow
def test_flac_or_what_it_needs(tmp_path):
    """A rocking body in FLAC, or the name of the extra that reads it."""
    try:
        import soundfile
    except ImportError:
        with pytest.raises(MissingExtraError, match=r"rocking\[sound\]"):
            read_compressed(b"fLaC", "a.flac")
        return
    sound = rocking(1, 25.0)
    soundfile.write(tmp_path / "a.flac", sound.samples, RATE)
    assert read_measurement(tmp_path / "a.flac").times.size == sound.times.size
    with pytest.raises(MeasurementError, match="damaged"):
        read_compressed(b"fLaC" + b"\0" * 100, "a.flac")
