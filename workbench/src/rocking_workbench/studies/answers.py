"""Answers of studies: state, progress, results, and the time history of a point."""

from typing import Annotated, Any, Literal

from pydantic import Field

from rocking_workbench.answers import Messages, QuantityAnswer, Units, shape
from rocking_workbench.api.response import ResponseFacts
from rocking_workbench.inputs import Inputs

Number = float | None  # null without a finite number
Interval = tuple[Number, Number]
Counts = list[list[list[int]]]
"""Values by restitution, then by row along y; or by restitution, body and scale."""

_OUTCOME = "0 no uplift, 1 uplift without overturning, 2 overturned, 3 not computed"
_MODE = "-3 not computed, -2 no uplift, -1 uplift without overturning, n >= 0 overturning after n impacts"
_MEASURE = "in the unit of the measure"
_PEAK = "peak rotation / slenderness angle"


def _left_out(description: str, default: Any = None) -> Any:
    """Return the description of an optional key."""
    return Field(default, description=description)


Coordinate: Any = shape(
    "Coordinate",
    "A dimension of a study.",
    name=str,
    values=(list[float | int | str | None], "in `unit`; null for a value that is not finite"),
    unit=str,
    description=str,
)
Result: Any = shape(
    "Result",
    "Common keys of all results.",
    id=str,
    messages=Messages,
    name=str,
    restitutions=list[str],
    contact=(str, _left_out("number of simulations with a tensile contact force; empty if 0", "")),
)
PointsOfState: Any = shape(
    "PointsOfState",
    "Number of motions that reach a limit state at each level.",
    x=(list[float], f"level, {_MEASURE}"),
    reached=(list[float], "motions that reach it [-]"),
    trials=(list[float], "motions whose history could be computed [-]"),
    share=(list[float], "[-]"),
    low=(list[float], "lower end of the 95 % interval [-]"),
    high=(list[float], "upper end of the 95 % interval [-]"),
)
StandardErrors: Any = shape(
    "StandardErrors", "Of the parameters of a curve.", median=(Number, _MEASURE), dispersion=(Number, "[-]")
)
FitFacts: Any = shape(
    "FitFacts",
    "The lognormal curve of one limit state; null if the data do not determine a curve.",
    median=(Number, _MEASURE),
    dispersion=(Number, "standard deviation of the natural logarithm [-]"),
    median_95=(Interval, f"95 % interval, {_MEASURE}; null for an open interval"),
    dispersion_95=(Interval, "95 % interval [-]; null for an open interval"),
    interval_method=str | None,
    standard_errors=StandardErrors | None,
    log_likelihood=(Number, "[-]"),
    method=str,
    separation=str,
    median_interval=(Interval, f"between which the median lies where no curve exists, {_MEASURE}"),
    observations=int,
    failures=int,
    levels=int,
    verdict=str,
    exists=bool,
    intervals_hold=bool,
    scarcity=(str, "why the intervals do not hold; empty if they do"),
)
CurveOfState: Any = shape(
    "CurveOfState",
    "A fragility curve.",
    x=(list[float], f"level, {_MEASURE}"),
    probability=(list[float], "[-]"),
    low=(list[float] | None, "lower end of the band [-]"),
    high=(list[float] | None, "upper end of the band [-]"),
    band=(str, "what the band is, or why there is none"),
)
RegressionAnswer: Any = shape(
    "RegressionAnswer",
    "The line of a cloud analysis, in logarithms.",
    slope=(float, "[-]"),
    scatter=(float, "standard deviation of the natural logarithm [-]"),
    determination=(float, "R squared [-]"),
    count=int,
)
CloudPoints: Any = shape(
    "CloudPoints",
    "The motions of a cloud.",
    x=(list[Number], f"level, {_MEASURE}"),
    rotation=(list[Number], _PEAK, "peak_ratio"),
    outcome=(list[int], _OUTCOME),
)
Crossing: Any = shape(
    "Crossing",
    "Levels at which one motion overturns the body.",
    motion=str | int,
    start=(Number, _MEASURE),
    end=(Number, f"null for an open end, {_MEASURE}"),
)
FirstCrossingFit: Any = shape(
    "FirstCrossingFit",
    "The lognormal curve of first crossings.",
    median=(float, _MEASURE),
    dispersion=(float, "[-]"),
    crossings=int,
    censored=int,
    method=str,
)
AnalysisFacts: Any = shape(
    "AnalysisFacts",
    "The analysis of one restitution; keys that an analysis does not have are left out.",
    restitution=str,
    levels=(list[float], _MEASURE, ""),
    trials=(list[float], "motions at each level whose history could be computed [-]"),
    failed=int,
    states=list[str],
    points=(dict[str, PointsOfState], "by state", ""),
    adjusted=(str, "reason for curves that were not fitted separately; empty for separate fits"),
    fits=(dict[str, FitFacts], "by state"),
    curves=(dict[str, CurveOfState], "by state"),
    verdicts=(dict[str, str], "what can be said of each fit, by state"),
    common=(list[str], "states whose curves have one dispersion"),
    regression=(RegressionAnswer | None, _left_out("regression of a cloud analysis")),
    regression_words=(str | None, _left_out("reason for a missing regression line")),
    cloud=(CloudPoints | None, Field(None)),
    definitions=(dict[str, str] | None, _left_out("of an incremental analysis")),
    first_crossings=(list[Number] | None, _left_out(f"by motion, {_MEASURE}; null if it never overturns")),
    first_crossing=(FirstCrossingFit | None, Field(None)),
    intervals=(list[Crossing] | None, Field(None)),
    resurrection=(str | None, Field(None)),
)
FragilityResult: Any = shape(
    "FragilityResult",
    "Fragility curves.",
    Result,
    kind=Literal["stripes", "cloud", "incremental"],
    im=QuantityAnswer,
    motions=Coordinate,
    definition=str,
    uplift_threshold=(float | None, f"smallest level with uplift, {_MEASURE}; null if unknown"),
    analyses=list[AnalysisFacts],
)
ColumnAnswer: Any = shape(
    "ColumnAnswer",
    "A column of a table.",
    name=str,
    unit=str,
    description=str,
    values=(list[float | int | bool | str | None], "in `unit`"),
)
Share: Any = shape(
    "Share", "How many histories end in one way.", mode=(int, _MODE), meaning=str, count=int, share=(float, "[-]")
)
Packed: Any = shape(
    "Packed",
    "Many numbers as bytes: by restitution, then rows along y, the last dimension the quickest.",
    kind=Literal["uint8", "int8", "uint16", "int16", "int32", "float32"],
    shape=tuple[int, int, int],
    base64=(str, "little-endian; NaN where a number was not computed"),
)
MapResult: Any = shape(
    "MapResult",
    "An overturning map; its tables are packed from 100,000 values on, in single precision.",
    Result,
    kind=Literal["overturning-map"],
    x=Coordinate,
    y=Coordinate,
    outcome=(Counts | Packed, _OUTCOME),
    mode=(Counts | Packed, _MODE),
    mode_words=dict[str, str],
    peak=(list[list[list[Number]]] | Packed, f"{_PEAK} [-]; null if it was not computed"),
    impacts=Counts | Packed,
    shares=list[list[Share]],
    islands=(list[list[str]], "sentences on safe islands, by restitution"),
    contours=(list[list[list[tuple[float, float]]]], "lines x, y around what overturns, in units"),
    body=str,
    motion=str,
    tables=(dict[str, list[ColumnAnswer]], "points and boundary of a refined map; else empty"),
)
SpectrumCurve: Any = shape(
    "SpectrumCurve",
    "One curve of a rocking spectrum; entries along `x`.",
    restitution=str,
    angle=(float, "slenderness angle", "rotation"),
    low=(list[Number], "16 % quantile of the peak rotation / slenderness angle [-]; null if overturned"),
    median=(list[Number], f"{_PEAK} [-]; null if half of the motions overturn the body"),
    high=(list[Number], "84 % quantile of the peak rotation / slenderness angle [-]; null if overturned"),
    overturned=(list[float | None], "overturning fraction of the motions with a result [-]"),
    coefficient=(list[Number], "of restitution", "coefficient"),
)
SpectrumResult: Any = shape(
    "SpectrumResult",
    "Rocking spectra.",
    Result,
    kind=Literal["rocking-spectrum"],
    x=(Coordinate, "periods 2 pi / p"),
    angles=Coordinate,
    motions=Coordinate,
    semi_diagonals=Coordinate,
    curves=list[SpectrumCurve],
    shares=list[list[Share]],
)
Cells: Any = shape(
    "Cells",
    "Counts by restitution, body and scale.",
    computed=Counts,
    lifted=Counts,
    overturned=Counts,
    median_peak=(list[list[list[Number]]], f"of those that stand: {_PEAK}", "peak_ratio"),
)
HistoriesResult: Any = shape(
    "HistoriesResult",
    "Results of a study of kind `histories`.",
    Result,
    kind=Literal["histories"],
    motions=Coordinate,
    bodies=Coordinate,
    scales=Coordinate,
    slenderness_angles=Coordinate,
    shares=list[list[Share]],
    cells=Cells,
    mode=(list[Counts] | None, _left_out("of each simulation, if there are at most 20,000")),
    peak=(list[list[list[list[Number]]]] | None, _left_out(f"{_PEAK} of each simulation [-]")),
)
MinimumResult: Any = shape(
    "MinimumResult",
    "Minimum overturning accelerations.",
    Result,
    kind=Literal["minimum-acceleration"],
    motions=Coordinate,
    bodies=Coordinate,
    tables=dict[str, list[ColumnAnswer]],
)
OutcomesResult: Any = shape(
    "OutcomesResult",
    "The outcomes of a study of another kind.",
    Result,
    kind=str,
    dimensions=list[Coordinate],
    shares=list[list[Share]],
    tables=(dict[str, list[ColumnAnswer]], "of an adaptive study; else empty"),
)
StudyResult = (
    Annotated[
        MapResult | SpectrumResult | FragilityResult | HistoriesResult | MinimumResult, Field(discriminator="kind")
    ]
    | OutcomesResult
)
"""Result of a study, by kind."""

StudyFacts: Any = shape(
    "StudyFacts",
    "State and progress of a study.",
    "name kind",
    id=(str, "identifier in URLs"),
    created=(str, "time in UTC"),
    histories=(int, "of an adaptive study those that are known so far"),
    state=Literal["waiting", "running", "cancelled", "interrupted", "failed", "done"],
    message=(str, "a sentence on the state, or empty"),
    project=(str, "project of the study; empty if none"),
    histories_done=int,
    rate=(float | None, "while it runs [1/s]"),
    seconds_left=(float | None, "while it runs; null while that is measured, or cannot be known [s]"),
    seconds_left_between=(tuple[float, float] | None, "between which it probably is [s]"),
)
Studies: Any = shape("Studies", "All studies, newest first.", studies=list[StudyFacts])
Launched: Any = shape("Launched", "A queued study.", id=(str, "identifier in URLs"))
StoredHistory: Any = shape(
    "StoredHistory",
    "Stored results of one simulation.",
    history=(int, "its number"),
    meaning=(str, "the mode in words"),
    outcome=int,
    mode=(int, _MODE),
    impacts=int,
    peak_rotation=(float | None, "null if it was not computed"),
    peak_ratio=(float | None, "null if it was not computed"),
    overturning_time=(float | None, "null without overturning"),
)
HistoryAnswer: Any = shape(
    "HistoryAnswer",
    "The simulation of one point of a study.",
    stored=StoredHistory,
    messages=Messages,
    inputs=(Inputs | None, "inputs of the same simulation; null if inputs cannot express it"),
    answer=(ResponseFacts | None, "null without a response"),
    difference=(float | None, "between the peaks of `stored` and `answer`"),
    note=(str, "note on missing data, or empty"),
    units=Units,
)
