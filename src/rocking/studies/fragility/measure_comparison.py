"""Comparison of efficiency and sufficiency of intensity measures for the same histories."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.settings import check_progress
from rocking.errors import InvalidValueError, extra
from rocking.messages import listed
from rocking.motions.intensity import measure
from rocking.statistics.least_squares import regression
from rocking.studies.fragility.cloud_analysis import MIN_ROTATION, CloudAnalysis, checked_min_rotation
from rocking.studies.fragility.curves import curve_of
from rocking.studies.fragility.limit_states import NAMED
from rocking.studies.fragility.subject import Progress, fits_of

if TYPE_CHECKING:
    import pandas as pd

DEFAULT_MEASURES = (
    "pga", "pgv", "p pgv/(g tan alpha)", "pgv/pga", "sa(0.5)", "sa(1.0)", "arias", "cav", "housner",
)  # fmt: skip
"""Default measures of the comparison."""


@dataclass(frozen=True)
class MeasureScore:
    """Efficiency and sufficiency of one measure."""

    im: str  # im, unit: name and unit of the measure
    unit: str
    # standard deviation of ln(theta/alpha) about its regression on ln of the measure, for histories that rocked
    # without overturning [-]; with a smaller value, fewer motions are needed
    efficiency: float
    slope: float  # slope of the regression [-]
    proficiency: float  # efficiency divided by the absolute slope: equivalent dispersion of the measure [-]
    determination: float  # R squared of the regression [-]
    overturning_dispersion: float  # dispersion of the lognormal curve of overturning [-]; NaN if there is no curve
    overturning_verdict: str  # verdict on the curve of overturning
    # p-values of the slopes of the residuals over the columns of the metadata [-]; a small value shows that the measure
    # does not include the effect of the column
    sufficiency: Mapping[str, float]
    rocked: int  # rocked, overturned: numbers of histories of the regression and the curve
    overturned: int
    barely_lifted: int = 0  # number of histories that rocked too little for the regression


@dataclass(frozen=True)
class MeasureComparison:
    """Intensity measures ranked by efficiency, with the best measure first."""

    scores: tuple[MeasureScore, ...]  # one score per measure
    # measures without a rank, because their values are equal for all motions, with the reason
    left_out: Mapping[str, str]
    min_rotation: float = MIN_ROTATION  # limit of the rotation / alpha for barely lifted histories [-]

    @property
    def best(self) -> str:
        """Name of the most efficient measure."""
        return self.scores[0].im

    def rows(self) -> list[dict[str, Any]]:
        """Return rank, the fields of `MeasureScore`, and ``p(name)`` for all columns of the metadata."""
        rows = []
        for rank, score in enumerate(self.scores, 1):
            fields = {name: value for name, value in vars(score).items() if name != "sufficiency"}
            rows.append({"rank": rank, **fields, **{f"p({k})": v for k, v in score.sufficiency.items()}})
        return rows

    def to_dataframe(self) -> "pd.DataFrame":
        """Return the table, one row per measure, by rank."""
        frame: pd.DataFrame = extra("pandas", "a table").DataFrame(self.rows()).set_index("rank")
        return frame


def compare_measures(
    analysis: CloudAnalysis,
    ims: Sequence[Any] = DEFAULT_MEASURES,
    metadata: Mapping[str, Any] | None = None,
    *,
    min_rotation: float | None = None,
    progress: Progress = None,
) -> MeasureComparison:
    """Rank intensity measures by their efficiency for the histories of one cloud analysis.

    Efficiency is the scatter of the response for a given measure (Luco & Cornell 2007, Earthquake Spectra 23:357).
    Sufficiency is tested by the residuals: for a given measure, other properties of the motion should have no effect.
    With several columns and measures, some p-values are below 0.05 by chance.

    Parameters
    ----------
    analysis : CloudAnalysis
        The histories, which are common to all measures.
    ims : sequence of str or IntensityMeasure
        The measures.
    metadata : mapping of str to array_like, optional
        Quantities of the motions, one number per motion, such as magnitude, ln of the distance or duration.
    min_rotation : float, optional
        Smallest rotation / alpha of a history in the regressions [-]. Without a limit, the logarithms of very small
        rotations would dominate. Default: the value of the analysis.
    progress : callable, optional
        Function called with the number of motions measured since the last call. All motions are measured once per
        measure.

    Returns
    -------
    MeasureComparison
        The ranking.

    Raises
    ------
    InvalidValueError
        If no measure is named, if a measure is named twice, if no measure varies, if a column does not fit the motions,
        or if fewer than three histories rocked.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies.fragility import fragility_analysis
    >>> pulses = [rk.pulses.half_sine(a, t) for a in (3.0, 3.5, 4.0) for t in (0.2, 0.3, 0.4)]
    >>> cloud = fragility_analysis(rk.Block(width=0.4, height=1.6), pulses, restitution=0.9, analysis="cloud")
    >>> compare_measures(cloud, ["pga", "pgv", "pgv/pga"]).best
    'pgv'
    """
    measures = [measure(im) for im in ims]
    names = [im.name for im in measures]
    if not names or len(set(names)) < len(names):
        raise InvalidValueError("ims must contain at least one measure, each once, got {names}", names=names)
    check_progress(progress)
    if min_rotation is not None:
        analysis = replace(analysis, min_rotation=checked_min_rotation(min_rotation))
    columns = {name: _column(name, values, analysis) for name, values in (metadata or {}).items()}
    scores, left_out = [], {}
    for im in measures:
        candidate = replace_measure(analysis, im)
        if progress is not None:
            progress(len(analysis.subject.motions))
        if len(np.unique(candidate.motion_levels[candidate.clear])) == 1:
            left_out[im.name] = f"{im.name} is {candidate.motion_levels[0]:g} {im.unit} for all that rocked"
        else:
            scores.append(_score(candidate, columns))
    if not scores:
        raise InvalidValueError("no measure can be ranked: {reasons}", reasons=listed(left_out.values()))
    return MeasureComparison(tuple(sorted(scores, key=lambda score: score.efficiency)), left_out, analysis.min_rotation)


def replace_measure(analysis: CloudAnalysis, name: Any) -> CloudAnalysis:
    """Return the same histories with another measure. Only the measure and its fits are computed."""
    subject = replace(analysis.subject, measure=measure(name))
    factor = float(np.asarray(analysis.histories.scales).ravel()[0])
    return replace(analysis, subject=subject, motion_levels=subject.measure.scaled(subject.intensities, factor))


def _score(analysis: CloudAnalysis, columns: Mapping[str, FloatArray]) -> MeasureScore:
    line, worst, im = analysis.regression, NAMED["overturning"], analysis.subject.measure
    dispersion = math.nan
    try:
        fit = fits_of(analysis.subject, [worst], analysis.motion_levels, analysis.responses)[worst.name]
    except InvalidValueError as error:
        verdict = str(error)
    else:
        curve, verdict = curve_of(worst.name, fit), fit.verdict
        dispersion = math.nan if curve is None else curve.dispersion
    proficiency = line.scatter / abs(line.slope) if line.slope else math.inf  # Eq. 222
    residual_fits = {name: regression(values[analysis.clear], line.residuals) for name, values in columns.items()}
    return MeasureScore(
        im.name, im.unit, line.scatter, line.slope, proficiency, line.determination, dispersion, verdict,
        {name: fit_of_column.p_value for name, fit_of_column in residual_fits.items()}, line.count,
        int(np.nansum(analysis.responses.overturned)), analysis.barely_lifted,
    )  # fmt: skip


def _column(name: str, column: Any, analysis: CloudAnalysis) -> FloatArray:
    values = checks.real_array(f"metadata[{name!r:.40}]", column)
    count = len(analysis.subject.motions)
    if values.shape != (count,) or not np.isfinite(values).all():
        raise InvalidValueError(
            "metadata[{name!r:.40}] must be {count} finite numbers, one per motion, got shape {shape}", name=name,
            count=count, shape=values.shape,
        )  # fmt: skip
    return values
