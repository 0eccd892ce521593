"""What was measured, and what it says about the models."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.evidence._claims import claims
    from rocking.evidence._coefficient_table import coefficient_table, interval_for
    from rocking.evidence._errata import errata
    from rocking.evidence._league import league, verdict
    from rocking.evidence._restitution_distribution import RestitutionDistribution, restitution_distribution
    from rocking.evidence.calibration import Calibration, calibrate
    from rocking.evidence.hierarchy import HierarchicalCalibration, calibrate_hierarchy
    from rocking.evidence.measurement_file import Measurement, measurement_of, read_measurements, write_measurements
    from rocking.evidence.measurements import DataSet, all_measurements, datasets
    from rocking.evidence.recommendation import ModelForBody, Recommendation

__all__ = [
    "Calibration",
    "DataSet",
    "HierarchicalCalibration",
    "Measurement",
    "ModelForBody",
    "Recommendation",
    "RestitutionDistribution",
    "all_measurements",
    "calibrate",
    "calibrate_hierarchy",
    "claims",
    "coefficient_table",
    "datasets",
    "errata",
    "interval_for",
    "league",
    "measurement_of",
    "read_measurements",
    "restitution_distribution",
    "verdict",
    "write_measurements",
]

_HOMES = {
    "_claims": ("claims",),
    "_coefficient_table": ("coefficient_table", "interval_for"),
    "_errata": ("errata",),
    "_league": ("league", "verdict"),
    "_restitution_distribution": ("RestitutionDistribution", "restitution_distribution"),
    "calibration": ("Calibration", "calibrate"),
    "hierarchy": ("HierarchicalCalibration", "calibrate_hierarchy"),
    "measurement_file": ("Measurement", "measurement_of", "read_measurements", "write_measurements"),
    "measurements": ("DataSet", "all_measurements", "datasets"),
    "recommendation": ("ModelForBody", "Recommendation"),
}

__getattr__, __dir__ = exports(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)
