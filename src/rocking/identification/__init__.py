"""Coefficients of restitution from measured rocking: times of impacts, rotations, angular velocities."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.identification._identify import identify
    from rocking.identification.design import Design
    from rocking.identification.measurement import ImpactTimes, RotationSeries
    from rocking.identification.readers.reader import read_measurement
    from rocking.identification.results import ForcedRocking, Identification, Impact, IntervalEstimate, ModelComparison

__all__ = [
    "Design",
    "ForcedRocking",
    "Identification",
    "Impact",
    "ImpactTimes",
    "IntervalEstimate",
    "ModelComparison",
    "RotationSeries",
    "identify",
    "read_measurement",
]

_HOMES = {
    "_identify": ("identify",),
    "design": ("Design",),
    "measurement": ("ImpactTimes", "RotationSeries"),
    "readers.reader": ("read_measurement",),
    "results": ("ForcedRocking", "IntervalEstimate", "Identification", "Impact", "ModelComparison"),
}
__getattr__, __dir__ = exports(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)
