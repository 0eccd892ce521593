"""What was measured, and what it says about the models."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.evidence._claims import claims as claims
    from rocking.evidence._coefficient_table import coefficient_table as coefficient_table
    from rocking.evidence._coefficient_table import interval_for as interval_for
    from rocking.evidence._errata import errata as errata
    from rocking.evidence._league import league as league
    from rocking.evidence._league import verdict as verdict
    from rocking.evidence._restitution_distribution import RestitutionDistribution as RestitutionDistribution
    from rocking.evidence._restitution_distribution import restitution_distribution as restitution_distribution
    from rocking.evidence.calibration import Calibration as Calibration
    from rocking.evidence.calibration import calibrate as calibrate
    from rocking.evidence.hierarchy import calibrate_hierarchy as calibrate_hierarchy
    from rocking.evidence.measurement_file import Measurement as Measurement
    from rocking.evidence.measurement_file import measurement_of as measurement_of
    from rocking.evidence.measurement_file import read_measurements as read_measurements
    from rocking.evidence.measurement_file import write_measurements as write_measurements
    from rocking.evidence.measurements import DataSet as DataSet
    from rocking.evidence.measurements import all_measurements as all_measurements
    from rocking.evidence.measurements import datasets as datasets
    from rocking.evidence.recommendation import Recommendation as Recommendation
    from rocking.evidence.recommending import recommend as recommend
else:
    __all__, __getattr__, __dir__ = exports(__name__)
