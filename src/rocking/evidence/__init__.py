"""What was measured, and what it says about the models."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.evidence._claims import claims
    from rocking.evidence._coefficient_table import coefficient_table
    from rocking.evidence._errata import errata
    from rocking.evidence._league import league, verdict
    from rocking.evidence._restitution_distribution import RestitutionDistribution, restitution_distribution
    from rocking.evidence.calibration import Calibration, calibrate, interval_for
    from rocking.evidence.measurements import DataSet, all_measurements, datasets
    from rocking.evidence.recommendation import ModelForBody, Recommendation

__all__ = [
    "Calibration",
    "DataSet",
    "ModelForBody",
    "Recommendation",
    "RestitutionDistribution",
    "all_measurements",
    "calibrate",
    "claims",
    "coefficient_table",
    "datasets",
    "errata",
    "interval_for",
    "league",
    "restitution_distribution",
    "verdict",
]

__getattr__, __dir__ = exports(
    __name__,
    {
        "Calibration": "rocking.evidence.calibration",
        "DataSet": "rocking.evidence.measurements",
        "ModelForBody": "rocking.evidence.recommendation",
        "Recommendation": "rocking.evidence.recommendation",
        "RestitutionDistribution": "rocking.evidence._restitution_distribution",
        "all_measurements": "rocking.evidence.measurements",
        "calibrate": "rocking.evidence.calibration",
        "claims": "rocking.evidence._claims",
        "coefficient_table": "rocking.evidence._coefficient_table",
        "datasets": "rocking.evidence.measurements",
        "errata": "rocking.evidence._errata",
        "interval_for": "rocking.evidence.calibration",
        "league": "rocking.evidence._league",
        "restitution_distribution": "rocking.evidence._restitution_distribution",
        "verdict": "rocking.evidence._league",
    },
)
