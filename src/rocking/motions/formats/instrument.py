"""The response of an instrument, taken out of a record by what a StationXML file says of it."""

from pathlib import Path

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.filters import cosine_sine
from rocking.motions.formats.record import Source
from rocking.motions.formats.sac import OBSPY
from rocking.motions.motion import GroundMotion, checked_motion

ABOVE = 1.25  # the edge of the band goes to zero at so many times its upper end, and at half its lower end [-]


def without_response(motion: GroundMotion, stations: Path, low: float, high: float) -> GroundMotion:
    """Return a record, divided by its sensitivity already, without the rest of its instrument's response.

    Between `low` and `high` [Hz] it is the acceleration of the ground; beyond, cosine edges end at half and 1.25 times.
    """
    motion = checked_motion(motion)
    if "sensitivity" not in motion.metadata:
        raise InvalidValueError(f"response is for counts of a recorder, as miniSEED files hold, got {motion!r:.100}")
    nyquist = 0.5 / motion.time_step
    low = checks.within("low", low, 0.0, nyquist, unit="Hz", open_low=True, open_high=True)
    high = checks.within("high", high, low, nyquist / ABOVE, unit="Hz", open_low=True, hint="1.25 of it below Nyquist")
    count = 1 << (2 * len(motion) - 1).bit_length()  # as many zeros behind it at least: nothing wraps round
    channel = {key: motion.metadata.get(key, "*") for key in ("network", "station")}
    channel["channel"] = motion.metadata["component"]
    source = Source.of_path(stations)
    request = {"channel": channel, "start": motion.metadata["starttime"], "step": motion.time_step, "count": count}
    found, arrays = OBSPY.answer(source, request, source.content)
    if not arrays:
        what = f"it must describe {channel['channel']} once, with its response, found {found['channels']}"
        raise source.error(None, what)
    frequencies = np.asarray(np.fft.rfftfreq(count, motion.time_step), dtype=np.float64)
    edge = _edge((frequencies - 0.5 * low) / (0.5 * low)) * _edge((ABOVE * high - frequencies) / ((ABOVE - 1.0) * high))
    gain = np.where(edge > 0.0, edge / np.where(edge > 0.0, arrays[0], 1.0), 0.0)  # Eq. 311
    samples = np.fft.irfft(np.fft.rfft(motion.acceleration, count) * gain, count)[: len(motion)]
    what = f"response of the instrument by {stations.name} removed from {low:g} to {high:g} Hz"
    return motion.changed(what, acceleration=samples)


def _edge(place: FloatArray) -> FloatArray:
    cosine = cosine_sine(np.asarray(np.pi * np.clip(place, 0.0, 1.0), dtype=np.float64))[0]
    return np.asarray(0.5 * (1.0 - cosine), dtype=np.float64)  # Eq. 154
