"""Long-run dynamics of rocking under harmonic ground motion: orbits, bifurcations, exponents, basins, thresholds."""

from rocking.studies.longrun.attractors import PoincareSection, bifurcation, poincare, start_states
from rocking.studies.longrun.basins import Basin, UncertaintyExponent, basin, ends_of, uncertainty_exponent
from rocking.studies.longrun.exponents import LyapunovExponents, lyapunov_exponents
from rocking.studies.longrun.orbits import (
    Bifurcation,
    Branch,
    OrbitNotFoundError,
    PeriodicOrbit,
    bifurcation_curve,
    branch_off,
    continue_orbit,
    find_orbit,
    slender_orbit,
    symmetric_orbit,
)
from rocking.studies.longrun.system import Harmonic, HarmonicRocking, Numerics, over_impacts, over_periods
from rocking.studies.longrun.thresholds import SlenderThresholds, slender_thresholds

__all__ = [
    "Basin",
    "Bifurcation",
    "Branch",
    "Harmonic",
    "HarmonicRocking",
    "LyapunovExponents",
    "Numerics",
    "OrbitNotFoundError",
    "PeriodicOrbit",
    "PoincareSection",
    "SlenderThresholds",
    "UncertaintyExponent",
    "basin",
    "bifurcation",
    "bifurcation_curve",
    "branch_off",
    "continue_orbit",
    "ends_of",
    "find_orbit",
    "lyapunov_exponents",
    "over_impacts",
    "over_periods",
    "poincare",
    "slender_orbit",
    "slender_thresholds",
    "start_states",
    "symmetric_orbit",
    "uncertainty_exponent",
]
