"""What fragility studies found."""

from typing import Literal

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer
from rocking.app.schemas.answers.coordinate import Coordinate, Number, Result
from rocking.app.schemas.answers.info import Quantity

Interval = tuple[Number, Number]


class PointsOfState(Answer):
    """How many motions reach a state at each level."""

    x: list[float] = Field(description="level, in the unit of the measure")
    reached: list[float] = Field(description="motions that reach it [-]")
    trials: list[float] = Field(description="motions whose history could be computed [-]")
    share: list[float] = Field(description="[-]")
    low: list[float] = Field(description="lower end of the 95 % interval [-]")
    high: list[float] = Field(description="upper end of the 95 % interval [-]")


class StandardErrors(Answer):
    """Of the parameters of a curve."""

    median: Number = Field(description="in the unit of the measure")
    dispersion: Number = Field(description="[-]")


class FitFacts(Answer):
    """The lognormal curve of one state; null where the data fix none."""

    median: Number = Field(description="in the unit of the measure")
    dispersion: Number = Field(description="standard deviation of the natural logarithm [-]")
    median_95: Interval = Field(description="95 % interval, in the unit of the measure; null where it is open")
    dispersion_95: Interval = Field(description="95 % interval [-]; null where it is open")
    interval_method: str | None
    standard_errors: StandardErrors | None
    log_likelihood: Number = Field(description="[-]")
    method: str
    separation: str
    median_interval: Interval = Field(
        description="between which the median lies where no curve exists, in the unit of the measure"
    )
    observations: int
    failures: int
    levels: int
    verdict: str
    exists: bool
    intervals_hold: bool
    scarcity: str = Field(description="why the intervals do not hold; empty if they do")


class CurveOfState(Answer):
    """A fragility curve."""

    x: list[float] = Field(description="level, in the unit of the measure")
    probability: list[float] = Field(description="[-]")
    low: list[float] | None = Field(description="lower end of the band [-]")
    high: list[float] | None = Field(description="upper end of the band [-]")
    band: str = Field(description="what the band is, or why there is none")


class Regression(Answer):
    """The line of a cloud analysis, in logarithms."""

    slope: float = Field(description="[-]")
    scatter: float = Field(description="standard deviation of the natural logarithm [-]")
    determination: float = Field(description="R squared [-]")
    count: int


class CloudPoints(Answer):
    """The motions of a cloud."""

    x: list[Number] = Field(description="level, in the unit of the measure")
    rotation: list[Number] = Field(description="peak rotation over alpha [-]")
    outcome: list[int] = Field(description="0 not lifted, 1 stands, 2 overturned, 3 not computed")


class Crossing(Answer):
    """Levels at which one motion overturns the body."""

    motion: str | int
    start: Number = Field(description="in the unit of the measure")
    end: Number = Field(description="null where it is open, in the unit of the measure")


class FirstCrossingFit(Answer):
    """The lognormal curve of first crossings."""

    median: float = Field(description="in the unit of the measure")
    dispersion: float = Field(description="[-]")
    crossings: int
    censored: int
    method: str


class AnalysisFacts(Answer):
    """The analysis of one restitution; keys that an analysis does not have are left out."""

    restitution: str
    levels: list[float] = Field(description="in the unit of the measure")
    trials: list[float] = Field(description="motions at each level whose history could be computed [-]")
    failed: int
    states: list[str]
    points: dict[str, PointsOfState] = Field(description="by state")
    fits: dict[str, FitFacts] = Field(description="by state")
    curves: dict[str, CurveOfState] = Field(description="by state")
    sentences: list[str]
    regression: Regression | None = Field(None, description="of a cloud")
    regression_words: str | None = Field(None, description="why a cloud has no line")
    cloud: CloudPoints | None = None
    definitions: dict[str, str] | None = Field(None, description="of an incremental analysis")
    first_crossings: list[Number] | None = Field(
        None, description="by motion, in the unit of the measure; null if it never overturns"
    )
    first_crossing: FirstCrossingFit | None = None
    intervals: list[Crossing] | None = None
    resurrection: str | None = None


class FragilityResult(Result):
    """Fragility curves."""

    kind: Literal["stripes", "cloud", "incremental"]
    measure: Quantity
    motions: Coordinate
    definition: str
    uplift_threshold: float | None = Field(
        description="least level that lifts, in the unit of the measure; null where none is known"
    )
    analyses: list[AnalysisFacts]
