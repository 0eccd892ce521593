"""The times of impacts from their sound."""

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.errors import MeasurementError
from rocking.identification.measurement import ImpactTimes
from rocking.identification.readers.clicks import find_clicks
from rocking.identification.readers.onsets import onsets, revised, sharpened
from rocking.identification.readers.recording import Recording
from rocking.identification.readers.rocking_sequence import find_sequence, why_no_rocking

_PIECES = 2000
_UNHEARD = 3.0
"""Contrast of an impact that only its likeness to others tells."""

_TIED = 3e-4
"""Standard deviation of the time between both feet that is told [s]: that of times whose reader states none."""

_FEWEST = 4
"""Times that identification needs."""

_ALIKE = 0.45
"""Between what 80 rocking bodies have, .69 at least at 8 dB, and speech taken for one, .24 at most."""


def impacts_heard(recording: Recording) -> ImpactTimes:
    """Return when a rocking body struck, or refuse a sound that is no rocking."""
    channel = recording.channel
    clicks = find_clicks(channel, recording.rate)
    length = recording.samples.shape[0] / recording.rate
    found = find_sequence(clicks.times, _evidence(clicks.contrasts), np.maximum(clicks.strengths, 0.3), length)
    if found is None:
        raise recording.error("fewer than three clicks stand out of its noise; nearer to the body, or a quieter room?")
    rate, rough, orders, members = recording.rate, clicks.times[found.members], found.orders, found.members
    sharp, white = sharpened(clicks.sound, rate, rough)
    times, alike, _ = onsets(sharp, white, rate, rough, orders)
    why = why_no_rocking(times if np.all(np.diff(times) > 0.0) else rough, found, clicks.contrasts, clicks.strengths)
    if not why and alike < _ALIKE:
        why = f"its clicks are not alike (median correlation {alike:.2f}, at least {_ALIKE}): no two feet made them"
    if why:
        raise recording.error(f"this is no sound of a rocking body: {why}")
    rough, orders, members = revised(sharp, rate, rough, orders, members)
    times, _, tied = onsets(sharp, white, rate, rough, orders)
    known = np.isfinite(times)
    if known.sum() < _FEWEST:
        raise recording.error(f"{known.sum()} of its {known.size} clicks can be told in time only; nearer to the body?")
    times, rough, orders, members = times[known], rough[known], orders[known] - orders[known][0], members[known]
    if np.any(np.diff(times) <= 0.0):
        times = rough
    contrasts = np.where(members < 0, _UNHEARD, clicks.contrasts[members])
    sure = 1.0 / (1.0 + np.exp(-_evidence(contrasts) - 2.0))
    doubts = _doubts(recording, contrasts, orders, times)
    if tied > _TIED:
        doubts += (f"how long after impacts on one foot those on the other came is known to {1e3 * tied:.1f} ms only",)
    return ImpactTimes(times, None, np.clip(sure, 0.01, 1.0), recording.name, doubts, _loudness(channel, rate))


def _loudness(channel: FloatArray, rate: float) -> FloatArray:
    """Return times and largest amplitudes of pieces of a sound, as many as a picture shows."""
    step = max(1, channel.size // _PIECES)
    loud = np.abs(channel[: channel.size // step * step]).reshape(-1, step).max(axis=1)
    return np.column_stack([(np.arange(loud.size) + 0.5) * step / rate, loud])


def _evidence(contrasts: FloatArray) -> FloatArray:
    """Return the logarithm of how much likelier an impact has such a contrast than noise and echoes have.

    Contrasts of those fall off as the power -5; a click that is louder than what went before by 3.2 may be either.
    """
    return np.clip(5.0 * np.log(contrasts / 3.2), -4.0, 4.0)


def _doubts(recording: Recording, contrasts: FloatArray, orders: IntArray, times: FloatArray) -> tuple[str, ...]:
    doubts = []
    for order in np.setdiff1d(np.arange(orders[-1]), orders):
        before = int(np.flatnonzero(orders < order)[-1])
        doubts.append(f"an impact seems to be missing between {times[before]:.3f} and {times[before + 1]:.3f} s")
    if recording.clipped:
        doubts.append(f"the sound is clipped {recording.clipped} times: record it at a lower level")
    faint = contrasts < 3.2
    if faint.any():
        doubts.append(f"{int(faint.sum())} of {faint.size} impacts hardly stand out of noise and echoes")
    return tuple(doubts)


def refuse_sound(name: str, suffix: str) -> MeasurementError:
    """Return the refusal of a sound that nobody here can decode, to be raised."""
    return MeasurementError(
        f"{name}: {suffix} sounds are not read: save it as WAV or FLAC, with the recorder's own export or"
        " an audio editor"
    )
