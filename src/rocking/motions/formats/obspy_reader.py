"""Files and instrument responses, read with ObsPy in a separate process (`foreign_worker` runs this file)."""

import io
import math
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np


def prepare() -> None:
    """Load ObsPy and its plugins before processes are forked, by reading one file of every format."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        obspy = import_module("obspy")
        for form in ("MSEED", "SAC"):
            obspy.Trace(np.zeros(8, np.float32)).write(file := io.BytesIO(), format=form)
            file.seek(0)
            obspy.read(file, format=form)
        import_module("obspy.io.stationxml.core")


def answer(request: dict[str, Any], *files: bytes) -> tuple[dict[str, Any], list[Any]]:
    """Return descriptions of the traces in a file with their channels in StationXML files, and the samples.

    For a request about a channel, `files` contains only StationXML files.
    """
    if "channel" in request:
        return _response(request, files)
    content, *stations = files
    obspy = import_module("obspy")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for damage in _damage():
            warnings.simplefilter("error", damage)
        traces = list(obspy.read(io.BytesIO(content), format=request["format"], **request["options"]))
    inventories, refusal = _inventories(stations)
    if refusal:
        return refusal, []
    described = [_described(trace, inventories) for trace in traces]
    doubts = dict.fromkeys(
        " ".join(str(warning.message).split())[:200] for warning in caught if not _is_of_programs(warning)
    )
    return {"traces": described, "warnings": list(doubts)}, [np.asarray(trace.data) for trace in traces]


def _damage() -> list[type[Warning]]:
    """Return the classes of warnings about damaged or missing samples."""
    return [import_module("obspy.io.mseed").InternalMSEEDWarning, RuntimeWarning]


def _is_of_programs(warning: warnings.WarningMessage) -> bool:
    """Return True if a warning is about program code, or about the rounding of a step (which is read separately)."""
    return issubclass(warning.category, (DeprecationWarning, FutureWarning, ImportWarning)) or (
        "Sample spacing read from SAC" in str(warning.message)
    )


def _inventories(files: Sequence[bytes]) -> tuple[list[Any], dict[str, Any]]:
    """Return StationXML files as inventories of ObsPy, or the index and error of an unreadable file."""
    obspy, read = import_module("obspy"), []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for index, content in enumerate(files):
            try:
                read.append(obspy.read_inventory(io.BytesIO(content), format="STATIONXML"))
            except Exception as error:  # noqa: BLE001 - its layers raise nearly any class
                return [], {"stations": str(error)[:120], "file_index": index}
    return read, {}


def _described(trace: Any, inventories: Sequence[Any]) -> dict[str, Any]:
    stats = trace.stats
    sac_header = dict(stats.get("sac", {}))
    about = {key: str(stats[key]) for key in ("network", "station", "location", "channel", "starttime")}
    return {
        "id": trace.id,
        "text": str(trace),
        "step": float(stats.delta),
        "about": about,
        "sac": {key: _plain(value) for key, value in sac_header.items()},
        "header": "\n".join(f"{key} = {sac_header[key]}" for key in sorted(sac_header)),
        "channels": [_described_channel(about, *match) for match in _channels(about, inventories)]
        if inventories
        else None,
    }


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value if isinstance(value, (int, float)) else str(value)


def _location(code: Any) -> str:
    return str(code or "").strip().strip("-")


def _channels(about: dict[str, str], inventories: Sequence[Any]) -> list[tuple[int, Any]]:
    """Return the channels of one network, station and code, for all locations and times, with their file index."""
    return [
        (index, channel)
        for index, inventory in enumerate(inventories)
        for network in inventory
        for station in network
        for channel in station
        if (network.code, station.code, channel.code) == (about["network"], about["station"], about["channel"])
    ]


def _described_channel(about: dict[str, str], file_index: int, channel: Any) -> dict[str, Any]:
    when = import_module("obspy").UTCDateTime(about["starttime"])
    begins, ends = channel.start_date, channel.end_date
    at_time = (begins is None or begins <= when) and (ends is None or when <= ends)
    total = channel.response and channel.response.instrument_sensitivity
    return {
        "matches": at_time and _location(channel.location_code) == _location(about["location"]),
        "file_index": file_index,
        "location": _location(channel.location_code),
        "from": str(begins or "")[:19],
        "to": str(ends or "today")[:19],
        "azimuth": None if channel.azimuth is None else float(channel.azimuth),
        "dip": None if channel.dip is None else float(channel.dip),
        "rate": float(channel.sample_rate or math.nan),
        "sensitivity": None if not total else [float(total.value), str(total.input_units), str(total.output_units)],
    }


def _response(request: dict[str, Any], files: Sequence[bytes]) -> tuple[dict[str, Any], list[Any]]:
    """Return descriptions of a channel, and for every description response / sensitivity at FFT frequencies."""
    warnings.simplefilter("ignore")
    inventories, refusal = _inventories(files)
    if refusal:
        return refusal, []
    described: list[dict[str, Any]] = []
    arrays: list[Any] = []
    for index, channel in _channels(request["channel"], inventories):
        description = _described_channel(request["channel"], index, channel)
        described.append(description)
        if description["matches"] and description["sensitivity"] and channel.response.response_stages:
            _in_one_unit(channel.response)
            values, _ = channel.response.get_evalresp_response(request["step"], request["count"], output="ACC")
            description["array"] = len(arrays)
            arrays.append(np.asarray(values / description["sensitivity"][0], dtype=np.complex128))
    return {"channels": described}, arrays


def _in_one_unit(response: Any) -> None:
    """Set one name for the unit of acceleration in a response, because ObsPy has no factors for some names."""
    total, first = response.instrument_sensitivity, response.response_stages[0]
    if first.input_units == total.input_units:
        total.input_units = first.input_units = "M/S**2"
