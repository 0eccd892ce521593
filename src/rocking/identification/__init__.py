"""Coefficients of restitution from measured rocking: times of impacts, rotations, angular velocities."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.identification._identify import identify as identify
    from rocking.identification.measurement import ImpactTimes as ImpactTimes
    from rocking.identification.measurement import RotationSeries as RotationSeries
    from rocking.identification.readers.reader import read_measurement as read_measurement
    from rocking.identification.results import Identification as Identification
    from rocking.identification.results import IntervalEstimate as IntervalEstimate
    from rocking.identification.results import ModelComparison as ModelComparison
else:
    __all__, __getattr__, __dir__ = exports(__name__)
