"""What ObsPy says of an instrument, in a process of its own (see `foreign_worker`, which runs this file)."""

import io
import warnings
from importlib import import_module
from typing import Any

import numpy as np


def answer(request: dict[str, Any], content: bytes) -> tuple[dict[str, Any], list[Any]]:
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
