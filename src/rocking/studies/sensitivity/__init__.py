"""Sensitivity of maps, spectra and fragility to the restitution, with changed verdicts."""

from rocking.studies.sensitivity.comparison import (
    Sensitivity,
    fragility_sensitivity,
    map_sensitivity,
    sensitivity,
    spectrum_sensitivity,
)
from rocking.studies.sensitivity.restitutions import SampledRestitution

__all__ = [
    "SampledRestitution",
    "Sensitivity",
    "fragility_sensitivity",
    "map_sensitivity",
    "sensitivity",
    "spectrum_sensitivity",
]
