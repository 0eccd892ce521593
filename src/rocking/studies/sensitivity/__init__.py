"""How the choice of a restitution changes a study: maps, spectra and fragility, with the verdicts that flip."""

from rocking.studies.sensitivity.changes import Change, CurveChange, Flips
from rocking.studies.sensitivity.comparison import (
    Sensitivity,
    fragility_sensitivity,
    map_sensitivity,
    sensitivity,
    spectrum_sensitivity,
)
from rocking.studies.sensitivity.restitutions import SampledHistories, SampledRestitution

__all__ = [
    "Change",
    "CurveChange",
    "Flips",
    "SampledHistories",
    "SampledRestitution",
    "Sensitivity",
    "fragility_sensitivity",
    "map_sensitivity",
    "sensitivity",
    "spectrum_sensitivity",
]
