"""What a record file holds: components with their unit and step, and the header as it stands."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from rocking.conventions import FloatArray


@dataclass(frozen=True, eq=False)
class Component:
    """One component of a record, in the unit of the file.

    Parameters
    ----------
    name : str
        What the file calls it: an azimuth, a channel code, ``U``, ``column 2``.
    acceleration : ndarray
        Samples, in `unit`.
    unit : str
        A key of `rocking.conventions.ACCELERATION_UNITS`.
    time_step : float
        Step between samples [s].
    stated_peak : float, optional
        Largest acceleration by the file's own header, without its sign, in `unit`; the reader has checked it.
    metadata : mapping of str to str
        What the header says about this component.
    """

    name: str
    acceleration: FloatArray
    unit: str
    time_step: float
    stated_peak: float | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)

    @property
    def peak(self) -> float:
        """Largest acceleration without its sign, in the unit of the file."""
        return float(np.abs(self.acceleration).max())


@dataclass(frozen=True, eq=False)
class Record:
    """A record file: its components and its header, kept as it stands.

    Parameters
    ----------
    format : str
        Name of the format it was read as.
    components : tuple of Component
        In the order of the file.
    header : str
        The raw header.
    metadata : mapping of str to str
        What the header says: event, station, network, processing.
    """

    format: str
    components: tuple[Component, ...]
    header: str = ""
    metadata: Mapping[str, str] = field(default_factory=dict)
