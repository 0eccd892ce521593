"""What is said of studies: state, progress, what they found, and the history behind a point."""

from typing import Annotated, Literal

from pydantic import Field

from rocking.app.schemas.answers import Answer, QuantityAnswer
from rocking.app.schemas.inputs import Inputs
from rocking.app.schemas.response_answers import ResponseFacts

Number = float | None
"""Null where there is no finite number."""

Interval = tuple[Number, Number]
Grid = list[list[list[int]]]
"""By restitution, then rows along y."""


class Coordinate(Answer):
    """A dimension of a study."""

    name: str
    values: list[float | int | str | None] = Field(description="in `unit`; null where a value is not finite")
    unit: str
    words: str


class Result(Answer):
    """What every result tells."""

    id: str
    name: str
    restitutions: list[str]
    contact: str = Field("", description="in how many histories the ground would have to pull; empty if in none")


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


class RegressionAnswer(Answer):
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
    regression: RegressionAnswer | None = Field(None, description="of a cloud")
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
    measure: QuantityAnswer
    motions: Coordinate
    definition: str
    uplift_threshold: float | None = Field(
        description="least level that lifts, in the unit of the measure; null where none is known"
    )
    analyses: list[AnalysisFacts]


class ColumnAnswer(Answer):
    """A column of a table."""

    name: str
    unit: str
    words: str
    values: list[float | int | bool | str | None] = Field(description="in `unit`")


class Share(Answer):
    """How many histories end in one way."""

    mode: int = Field(description="-3 not computed, -2 not lifted, -1 stands, n >= 0 overturns after n impacts")
    meaning: str
    count: int
    share: float = Field(description="[-]")


class MapResult(Result):
    """An overturning map."""

    kind: Literal["overturning-map"]
    x: Coordinate
    y: Coordinate
    outcome: Grid = Field(description="0 not lifted, 1 stands, 2 overturned, 3 not computed")
    mode: Grid = Field(description="-3 not computed, -2 not lifted, -1 stands, n >= 0 overturns after n impacts")
    mode_words: dict[str, str]
    peak: list[list[list[Number]]] = Field(description="peak rotation over alpha [-]; null if it was not computed")
    impacts: Grid
    shares: list[list[Share]]
    contours: list[list[list[tuple[float, float]]]] = Field(description="lines x, y around what overturns, in units")
    body: str
    motion: str
    tables: dict[str, list[ColumnAnswer]] = Field(description="points and boundary of a refined map; else empty")


class SpectrumCurve(Answer):
    """One curve of a rocking spectrum; entries along `x`."""

    restitution: str
    angle: float = Field(description="slenderness angle [rad]")
    low: list[Number] = Field(description="16 % of the motions: peak over alpha [-]; null where they overturn")
    median: list[Number] = Field(description="peak rotation over alpha [-]; null where half of the motions overturn")
    high: list[Number] = Field(description="84 % of the motions: peak over alpha [-]; null where they overturn")
    overturned: list[float | None] = Field(description="share that overturns of the motions with a result [-]")
    coefficient: list[Number] = Field(description="of restitution [-]")


class SpectrumResult(Result):
    """Rocking spectra."""

    kind: Literal["rocking-spectrum"]
    x: Coordinate = Field(description="periods 2 pi / p")
    angles: Coordinate
    motions: Coordinate
    semi_diagonals: Coordinate
    curves: list[SpectrumCurve]
    shares: list[list[Share]]


Counted = list[list[list[int]]]


class Cells(Answer):
    """Counts by restitution, body and scale."""

    computed: Counted
    lifted: Counted
    overturned: Counted
    median_peak: list[list[list[Number]]] = Field(description="of those that stand: peak rotation over alpha [-]")


class HistoriesResult(Result):
    """Plain histories."""

    kind: Literal["histories"]
    motions: Coordinate
    bodies: Coordinate
    scales: Coordinate
    slenderness_angles: Coordinate
    shares: list[list[Share]]
    cells: Cells
    mode: list[list[list[list[int]]]] | None = Field(None, description="of each, where there are at most 20,000")
    peak: list[list[list[list[Number]]]] | None = Field(None, description="peak rotation over alpha of each [-]")


class MinimumResult(Result):
    """Minimum overturning accelerations."""

    kind: Literal["minimum-acceleration"]
    motions: Coordinate
    bodies: Coordinate
    tables: dict[str, list[ColumnAnswer]]


StudyResult = Annotated[
    MapResult | SpectrumResult | FragilityResult | HistoriesResult | MinimumResult, Field(discriminator="kind")
]
"""What a study found, by its kind."""


class StudyFacts(Answer):
    """State and progress of a study."""

    id: str = Field(description="its name in addresses")
    name: str
    kind: str
    created: str = Field(description="when, in UTC")
    histories: int = Field(description="of an adaptive study those that are known so far")
    state: Literal["waiting", "running", "cancelled", "interrupted", "failed", "done"]
    message: str = Field(description="a sentence on the state; empty where there is nothing to say")
    histories_done: int
    rate: float | None = Field(description="while it runs [1/s]")
    seconds_left: float | None = Field(description="while it runs; null while that is measured, or cannot be known [s]")
    seconds_left_between: tuple[float, float] | None = Field(description="between which it probably is [s]")


class Studies(Answer):
    """All studies, the newest first."""

    studies: list[StudyFacts]


class Launched(Answer):
    """A study that was put in line."""

    id: str = Field(description="its name in addresses")


class StoredHistory(Answer):
    """What a study has of one history, to the last digit."""

    history: int = Field(description="its number")
    meaning: str = Field(description="the mode in words")
    outcome: int
    mode: int = Field(description="-3 not computed, -2 not lifted, -1 stands, n >= 0 overturns after n impacts")
    impacts: int
    peak_rotation_rad: float | None = Field(description="null if it was not computed [rad]")
    peak_rotation_over_alpha: float | None = Field(description="null if it was not computed [-]")
    overturning_time_s: float | None = Field(description="null if it stands [s]")


class HistoryAnswer(Answer):
    """The history behind a point of the picture of a study."""

    stored: StoredHistory
    inputs: Inputs | None = Field(description="what to ask for the same history; null where inputs cannot say it")
    answer: ResponseFacts | None = Field(description="null where there is no response")
    difference_rad: float | None = Field(description="between the peaks of `stored` and `answer` [rad]")
    note: str = Field(description="on what is missing; empty if nothing is")
