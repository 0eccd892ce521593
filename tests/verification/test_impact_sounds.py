"""Impacts heard in rooms: every one found, none added, and what is no rocking refused.

The sounds are those of tests/rocking_sounds.py; the detector was tuned on seeds 10000 to 10029 alone. With
ROCKING_CAMPAIGN=1 there are 60 rooms at each level and 100 sounds of each other kind; otherwise a few of them.
"""

import os
import re
import time

import numpy as np
import pytest
import rocking_sounds
from rocking_sounds import RATE, no_rocking, wav

from rocking.errors import MeasurementError
from rocking.identification.readers import read_measurement
from rocking.identification.readers.recording import Recording
from rocking.identification.readers.sound import impacts_heard

pytestmark = pytest.mark.verifies(room="evidence")
CAMPAIGN = os.environ.get("ROCKING_CAMPAIGN") == "1"
ROOMS, OTHERS, FIRST = (60, 100, 700_000) if CAMPAIGN else (6, 1, 700_000)


def heard(samples):
    return impacts_heard(Recording("made", samples[:, None], RATE))


def complete(found, times):
    """Every impact within 12 ms, and no other."""
    return found.size == times.size and np.abs(found - times).max() < 0.012


def errors_of(runs, decibels):
    """Errors of the runs that are complete, less the mean of each: only differences of times are ever used [s]."""
    errors = []
    for seed in range(FIRST, FIRST + runs):
        sound = rocking_sounds.rocking(seed, decibels)
        try:
            found = heard(sound.samples).times
        except MeasurementError:
            continue
        if complete(found, sound.times):
            errors.append(found - sound.times - (found - sound.times).mean())
    return np.array(errors)


@pytest.mark.verifies(
    "computed anew",
    "impacts of random bodies in random rooms, 11 each, at 25, 15 and 8 dB above the noise",
    within="0.9 of the rooms complete, 0.8 at 8 dB; half of the onsets to 5e-5 s, 1e-4 s at 8 dB",
    control="test_a_plain_threshold_does_not_do",
)
@pytest.mark.parametrize(("decibels", "share", "median"), [(25.0, 0.9, 5e-5), (15.0, 0.9, 5e-5), (8.0, 0.8, 1e-4)])
def test_impacts_are_found(decibels, share, median):
    """Reverberation, hum and clipping: all impacts are found, none is added, and half of the onsets are close.

    Of a few rooms one more may fail, since a share of six says little. In the campaign 57, 55 and 51 of 60 rooms were
    complete (the aim is 59, 58 and 50), with .04, .17 and .95 ms root mean square (the aim is .15), half of the onsets
    within .02, .02 and .03 ms: in one run at 15 dB and eight at 8 dB one foot is off against the other.
    """
    errors = errors_of(ROOMS, decibels)
    assert errors.shape[0] >= share * ROOMS - (0 if CAMPAIGN else 1)
    assert np.median(np.abs(errors)) < median


@pytest.mark.verifies("negative control")
def test_a_plain_threshold_does_not_do():
    """Wherever the sound exceeds five deviations of its quiet beginning: hum and echoes are taken for impacts."""
    good = 0
    for seed in range(FIRST, FIRST + 6):
        sound = rocking_sounds.rocking(seed, 15.0)
        loud = np.flatnonzero(np.abs(sound.samples) > 5.0 * sound.samples[: RATE // 4].std()) / RATE
        found = loud[np.diff(loud, prepend=-1.0) > 0.03]
        good += complete(found, sound.times)
    assert good <= 1


@pytest.mark.verifies(
    "behaviour", "clapping, metronomes, rain, speech", within="0.95 of rain and speech refused, all of the others"
)
@pytest.mark.parametrize("kind", ["clapping", "metronome", "rain", "speech"])
def test_what_is_no_rocking_is_refused(kind):
    """Clapping, a metronome, rain and speech are no rocking, and the refusal says why.

    The aim is 100 of 100 of each: 99 of rain and 97 of speech were refused before clicks had to be alike.
    """
    refusals = []
    for seed in range(FIRST, FIRST + OTHERS):
        try:
            heard(no_rocking(kind, seed))
        except MeasurementError as refusal:
            refusals.append(str(refusal))
    assert len(refusals) >= (0.95 if kind in ("rain", "speech") else 1.0) * OTHERS
    assert all(re.search("no sound of a rocking body|fewer than three clicks", words) for words in refusals)


@pytest.mark.timed
@pytest.mark.verifies("behaviour", "a minute of sound at 44.1 kHz", within="2 s of CPU")
def test_a_minute_takes_seconds(tmp_path):
    """From file to times, with a rocking body in its middle."""
    sound = rocking_sounds.rocking(FIRST, 25.0)
    rng = np.random.default_rng(1)
    quiet = rng.normal(0.0, sound.samples[: RATE // 4].std(), (2, 27 * RATE))
    path = tmp_path / "minute.wav"
    path.write_bytes(wav(np.concatenate([quiet[0], sound.samples, quiet[1]])[: 60 * RATE].clip(-1.0, 1.0)))
    begun = time.process_time()
    read_measurement(path)
    assert time.process_time() - begun < 2.0
