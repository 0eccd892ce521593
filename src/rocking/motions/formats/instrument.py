"""Removal of the instrument response from a record, by a StationXML file."""

from dataclasses import replace
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.filters import cosine_sine
from rocking.motions.formats.sac import OBSPY, check_stations
from rocking.motions.formats.stations import Places, channel_at, sensitivity_of, station_sources
from rocking.motions.motion import GroundMotion, checked_motion

ABOVE = 1.25  # upper end of the cosine edge / upper frequency [-]; the lower edge ends at half the lower frequency


def without_response(motion: GroundMotion, stations: Places, low: float, high: float) -> GroundMotion:
    """Return a record without the frequency dependence of its instrument.

    The input record is already divided by the sensitivity.

    The result is the acceleration of the ground from `low` to `high` [Hz], with cosine edges to 0.5 `low` and 1.25
    `high`. Stations are StationXML files or folders of them; one of them must describe the channel.
    """
    motion = checked_motion(motion)
    if "sensitivity" not in motion.metadata:
        raise InvalidValueError(
            "response requires counts of a recorder, as in miniSEED files, got {motion}", motion=f"{motion!r:.100}"
        )
    nyquist = 0.5 / motion.time_step
    low = checks.within("low", low, 0.0, nyquist, unit="Hz", open_low=True, open_high=True)
    high = checks.within(
        "high",
        high,
        low,
        nyquist / ABOVE,
        unit="Hz",
        open_low=True,
        hint="1.25 times this frequency must be below Nyquist",
    )
    count = 1 << (2 * len(motion) - 1).bit_length()  # zero padding avoids circular convolution
    about = {key: motion.metadata.get(key, "") for key in ("network", "station", "location", "channel", "starttime")}
    response, file = _relative_response(about, stations, motion.time_step, count)
    frequencies = np.asarray(np.fft.rfftfreq(count, motion.time_step), dtype=np.float64)
    edge = _edge((frequencies - 0.5 * low) / (0.5 * low)) * _edge((ABOVE * high - frequencies) / ((ABOVE - 1.0) * high))
    fields, files = {"acceleration": _without(motion.acceleration, response, edge, count)}, [file]
    if motion.vertical is not None:
        about["channel"] = motion.metadata.get("vertical channel", "")
        response, file = _relative_response(about, stations, motion.time_step, count)
        fields["vertical"] = _without(motion.vertical, response, edge, count)
        files.append(file)
    sources = " and ".join(dict.fromkeys(files))
    return motion.changed(f"response of the instrument by {sources} removed from {low:g} to {high:g} Hz", **fields)


def _without(samples: FloatArray, response: Any, edge: FloatArray, count: int) -> FloatArray:
    gain = np.where(edge > 0.0, edge / np.where(edge > 0.0, response, 1.0), 0.0)  # Eq. 311
    return np.asarray(np.fft.irfft(np.fft.rfft(samples, count) * gain, count)[: samples.size], dtype=np.float64)


def _relative_response(about: dict[str, str], stations: Places, step: float, count: int) -> tuple[Any, str]:
    """Return the response of a channel / sensitivity at FFT frequencies, and the file with its SHA-256."""
    sources = station_sources(stations, [about["station"]])
    name = ".".join(about[key] for key in ("network", "station", "location", "channel"))
    answer, arrays = OBSPY.answer(
        sources[0],
        {"channel": about, "step": step, "count": count},
        *(station_source.content for station_source in sources),
    )
    check_stations(answer, sources)
    channel, source = channel_at(sources[0], answer["channels"], sources, name, about["starttime"])
    sensitivity_of(replace(source, doubts=[]), channel, name)  # raises an error for other quantities than acceleration
    if "array" not in channel:
        raise source.error(
            None,
            "{station}: the StationXML contains no response stages; request the file with level=response",
            station=name,
        )
    return arrays[channel["array"]], f"{source.name}, SHA-256 {source.sha256}"


def _edge(position: FloatArray) -> FloatArray:
    cosine = cosine_sine(np.asarray(np.pi * np.clip(position, 0.0, 1.0), dtype=np.float64))[0]
    return np.asarray(0.5 * (1.0 - cosine), dtype=np.float64)  # Eq. 154
