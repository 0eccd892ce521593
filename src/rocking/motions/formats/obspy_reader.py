"""What ObsPy does with a file or says of an instrument, in a process of its own (`foreign_worker` runs this file)."""

import io
import math
import warnings
from importlib import import_module
from typing import Any

import numpy as np


def prepare() -> None:
    """Load ObsPy with its plugins, by one file of each kind, before there is a process for each file."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        obspy = import_module("obspy")
        for form in ("MSEED", "SAC"):
            obspy.Trace(np.zeros(8, np.float32)).write(file := io.BytesIO(), format=form)
            file.seek(0)
            obspy.read(file, format=form)
        import_module("obspy.io.stationxml.core")


def answer(request: dict[str, Any], content: bytes, stations: bytes | None = None) -> tuple[dict[str, Any], list[Any]]:
    """Return descriptions of a file's traces, each with its own channels of a StationXML file, and their samples."""
    if "channel" in request:
        return _response(request, content)
    obspy = import_module("obspy")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        for damage in _damage():
            warnings.simplefilter("error", damage)
        traces = list(obspy.read(io.BytesIO(content), format=request["format"], **request["options"]))
    inventory = None
    if stations is not None:
        try:
            inventory = obspy.read_inventory(io.BytesIO(stations), format="STATIONXML")
        except Exception as error:  # noqa: BLE001 - its layers raise nearly any class
            return {"stations": str(error)[:120]}, []
    described = [_described(trace, inventory) for trace in traces]
    told = dict.fromkeys(" ".join(str(each.message).split())[:200] for each in said if not _is_of_programs(each))
    return {"traces": described, "warnings": list(told)}, [np.asarray(trace.data) for trace in traces]


def _damage() -> list[type[Warning]]:
    """Return the classes of warnings that say that samples are damaged or missing."""
    return [import_module("obspy.io.mseed").InternalMSEEDWarning, RuntimeWarning]


def _is_of_programs(warning: warnings.WarningMessage) -> bool:
    """Return whether a warning is about code, or about the rounding of a step that is read without it."""
    return issubclass(warning.category, (DeprecationWarning, FutureWarning, ImportWarning)) or (
        "Sample spacing read from SAC" in str(warning.message)
    )


def _described(trace: Any, inventory: Any) -> dict[str, Any]:
    stats = trace.stats
    said = dict(stats.get("sac", {}))
    return {
        "id": trace.id,
        "text": str(trace),
        "step": float(stats.delta),
        "about": {key: str(stats[key]) for key in ("network", "station", "location", "channel", "starttime")},
        "sac": {key: _plain(value) for key, value in said.items()},
        "header": "\n".join(f"{key} = {said[key]}" for key in sorted(said)),
        "channels": None if inventory is None else [_channel(one) for one in _channels(trace, inventory)],
    }


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value if isinstance(value, (int, float)) else str(value)


def _channels(trace: Any, inventory: Any) -> list[Any]:
    stats = trace.stats
    found = inventory.select(
        network=stats.network,
        station=stats.station,
        location=stats.location,
        channel=stats.channel,
        time=stats.starttime,
    )
    return [channel for network in found for station in network for channel in station]


def _channel(channel: Any) -> dict[str, Any]:
    total = channel.response and channel.response.instrument_sensitivity
    return {
        "rate": float(channel.sample_rate or math.nan),
        "sensitivity": None if not total else [float(total.value), str(total.input_units), str(total.output_units)],
    }


def _response(request: dict[str, Any], content: bytes) -> tuple[dict[str, Any], list[Any]]:
    """Return the response of a channel to acceleration, over its overall sensitivity, at the frequencies of an FFT."""
    warnings.simplefilter("ignore")
    obspy = import_module("obspy")
    inventory = obspy.read_inventory(io.BytesIO(content), format="STATIONXML")
    found = inventory.select(**request["channel"], time=obspy.UTCDateTime(request["start"]))
    channels = [channel for network in found for station in network for channel in station]
    if len(channels) != 1 or not channels[0].response or not channels[0].response.instrument_sensitivity:
        return {"channels": len(channels)}, []
    response = channels[0].response
    values, _ = response.get_evalresp_response(request["step"], request["count"], output="ACC")
    return {"channels": 1}, [np.asarray(values / response.instrument_sensitivity.value, dtype=np.complex128)]
