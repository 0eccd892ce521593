"""How the choice of a restitution changes a study: maps, spectra and fragility, with the verdicts that flip."""

from rocking.studies.sensitivity.compare import (
    fragility_sensitivity,
    map_sensitivity,
    sensitivity,
    spectrum_sensitivity,
)
from rocking.studies.sensitivity.comparison import Sensitivity
from rocking.studies.sensitivity.curves import Change, CurveChange
from rocking.studies.sensitivity.differences import Flips
from rocking.studies.sensitivity.sampled import SampledHistories, SampledRestitution

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
