"""What was measured, and what it says about the models."""

from rocking.evidence.calibration import Calibration, Prediction, calibrate, interval_for
from rocking.evidence.claims import Claim, claims
from rocking.evidence.coefficient_table import CoefficientRow, coefficient_table
from rocking.evidence.errata import Erratum, errata
from rocking.evidence.league import LeagueRow, league
from rocking.evidence.measurements import DataSet, all_measurements, datasets
from rocking.evidence.restitution_distribution import RestitutionDistribution, restitution_distribution
from rocking.evidence.verdict import verdict

__all__ = [
    "Calibration",
    "Claim",
    "CoefficientRow",
    "DataSet",
    "Erratum",
    "LeagueRow",
    "Prediction",
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
