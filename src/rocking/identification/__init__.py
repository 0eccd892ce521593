"""Coefficients of restitution from measured rocking: times of impacts, rotations, angular velocities."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.identification.measurement import ImpactTimes, RotationSeries

__all__ = ["ImpactTimes", "RotationSeries"]

_HOMES = {"measurement": ("ImpactTimes", "RotationSeries")}
__getattr__, __dir__ = exports(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)
