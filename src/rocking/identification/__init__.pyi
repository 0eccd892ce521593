from ._identify import identify as identify
from .measurement import ImpactTimes as ImpactTimes
from .measurement import RotationSeries as RotationSeries
from .readers.reader import read_measurement as read_measurement
from .results import Identification as Identification
from .results import IntervalEstimate as IntervalEstimate
from .results import ModelComparison as ModelComparison
