"""Long-run dynamics of rocking under harmonic ground motion: orbits, bifurcations, exponents, basins, thresholds."""

from rocking.studies.longrun.attractors import start_states as start_states
from rocking.studies.longrun.basins import UncertaintyExponent, basin_stability, box_dimension, uncertainty_exponent
from rocking.studies.longrun.basins import ends_of as ends_of
from rocking.studies.longrun.continuation import Bifurcation, Branch, bifurcation_curve, branch_off, continue_orbit
from rocking.studies.longrun.exponents import LyapunovExponents
from rocking.studies.longrun.exponents import lyapunov_exponents as lyapunov_exponents
from rocking.studies.longrun.orbits import OrbitNotFoundError, PeriodicOrbit, find_orbit, slender_orbit, symmetric_orbit
from rocking.studies.longrun.system import Harmonic, HarmonicRocking, Numerics
from rocking.studies.longrun.system import over_impacts as over_impacts
from rocking.studies.longrun.system import over_periods as over_periods
from rocking.studies.longrun.thresholds import SlenderThresholds, slender_thresholds

__all__ = [
    "Bifurcation",
    "Branch",
    "Harmonic",
    "HarmonicRocking",
    "LyapunovExponents",
    "Numerics",
    "OrbitNotFoundError",
    "PeriodicOrbit",
    "SlenderThresholds",
    "UncertaintyExponent",
    "basin_stability",
    "bifurcation_curve",
    "box_dimension",
    "branch_off",
    "continue_orbit",
    "find_orbit",
    "slender_orbit",
    "slender_thresholds",
    "symmetric_orbit",
    "uncertainty_exponent",
]
