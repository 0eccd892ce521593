"""The front door: the fragility of a body by one of the three analyses, as a labelled dataset."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.intensity import measure as measure_of
from rocking.statistics.goodness import ends_of
from rocking.studies.fragility._incremental_dynamic_analysis import incremental_dynamic_analysis
from rocking.studies.fragility._multiple_stripe_analysis import MultipleStripeAnalysis, multiple_stripe_analysis
from rocking.studies.fragility.cloud_analysis import LEAST, CloudAnalysis, cloud
from rocking.studies.fragility.curves import curve_of
from rocking.studies.fragility.subject import Motions, Progress, Subject

if TYPE_CHECKING:
    import xarray as xr

ANALYSES = ("stripes", "cloud", "incremental")

_REACH = (0.9, 9.0, 16)
"""Levels that serve where none are given: from, to in what lifts the body, how many, in equal ratios."""


def fragility(  # noqa: PLR0913 - every one of them is a question that users ask
    body: Body,
    motions: Motions,
    levels: Any = None,
    restitution: Any = "ked",
    *,
    analysis: str = "stripes",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    factor: float | None = None,
    least: float | None = None,
    tolerance: float | None = None,
    progress: Progress = None,
    **options: Any,
) -> "xr.Dataset":
    """Return how likely a body is to rock, to rock far and to overturn at levels of shaking.

    Parameters
    ----------
    body : Body
        The body.
    motions : GroundMotion or Pulse, a sequence of them, or MotionSet
        All records or all pulses.
    levels : array_like, optional
        Levels of the measure, increasing, to which every motion is brought; not for a cloud. An incremental analysis
        searches the boundary between neighbours of unlike outcome, and below the first one down to zero. If not
        given, 16 from .9 to 9 times what lifts the body, for a measure that says what that is [unit of the measure].
    restitution : as for `simulate`
        Model or its name, number, pair by side, or law.
    analysis : {"stripes", "cloud", "incremental"}
        Multiple stripes; the motions as they are; or stripes and every level between them at which a motion begins or
        ceases to overturn the body.
    measure : str or IntensityMeasure
        A name of `rocking.motions.intensity.measures`, or ``sa(period)``; for levels one that grows with the motion.
    states : sequence of float
        Rotations over alpha that count as states of their own [-].
    factor : float, optional
        One factor on all motions of a cloud; 1 if not given [-].
    least : float, optional
        Rotation over alpha below which a history of a cloud counts as barely lifted, and is left out of the line; .01
        if not given [-].
    tolerance : float, optional
        Width over level to which an incremental analysis searches; 0 for the last bit, 1e-8 if not given [-].
    progress : callable, optional
        Called with the number of histories done since the last call.
    **options
        ``gravity`` [m/s2], ``engine``, ``threads`` and fields of `Settings`.

    Returns
    -------
    xarray.Dataset
        Outcome and rotation over ``motion`` and ``level`` (a cloud: over ``motion``); over ``state`` the lognormal
        curves: median [unit of the measure], dispersion [-], their 95 % intervals, missing (NaN) where there is none,
        and what can be claimed of each; with units.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, goes with another analysis, or levels are missing.
    MissingExtraError
        If xarray is not installed.

    Examples
    --------
    >>> import rocking as rk
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.4, 0.5, 0.6, 0.7, 0.8, 1.0)]
    >>> curves = rk.fragility(rk.Block(width=0.4, height=1.6), pulses, [2.0, 4.0, 6.0, 8.0])
    >>> curves["exceeded"].sel(state="overturned").values.tolist()
    [0, 4, 5, 6]
    >>> median = curves["median"].sel(state="overturned")
    >>> round(float(median), 2), median.attrs["units"]
    (3.83, 'm/s2')
    """
    of_kind = fragility_analysis(
        body, motions, levels, restitution, analysis=analysis, measure=measure, states=states, factor=factor,
        least=least, tolerance=tolerance, progress=progress, **options,
    )  # fmt: skip
    return _with_curves(of_kind)


def fragility_analysis(  # noqa: PLR0913 - those of `fragility`
    body: Body, motions: Motions, levels: Any = None, restitution: Any = "ked", *, analysis: str = "stripes",
    measure: Any = "pga", factor: float | None = None, least: float | None = None, tolerance: float | None = None,
    **options: Any,
) -> MultipleStripeAnalysis | CloudAnalysis:  # fmt: skip
    """Return the analysis behind `fragility`, which pictures and files are made of.

    Parameters
    ----------
    body, motions, levels, restitution, analysis, measure, factor, least, tolerance, **options
        As for `fragility`.

    Returns
    -------
    MultipleStripeAnalysis, CloudAnalysis or IncrementalDynamicAnalysis
        Outcomes, counts and curves.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, goes with another analysis, or levels are missing.
    """
    kind = checks.one_of("analysis", analysis, ANALYSES)
    measure = measure_of(measure)
    _refuse_others(kind, {"cloud": {"factor": factor, "least": least}, "incremental": {"tolerance": tolerance}})
    if kind == "cloud":
        if levels is not None:
            raise InvalidValueError("levels are not for a cloud, which takes the motions as they are")
        of_cloud: dict[str, Any] = {
            "factor": 1.0 if factor is None else factor,
            "least": LEAST if least is None else least,
        }
        return cloud(body, motions, restitution, measure, **of_cloud, **options)
    if levels is None:
        about = {name: value for name, value in options.items() if name not in {"threads", "progress", "states"}}
        levels = default_levels(Subject.of(body, motions, restitution, measure, about))
    if kind == "stripes":
        return multiple_stripe_analysis(body, motions, levels, restitution, measure, **options)
    if tolerance is not None:
        options["tolerance"] = tolerance
    return incremental_dynamic_analysis(body, motions, levels, restitution, measure, **options)


def default_levels(subject: Subject) -> FloatArray:
    """Return levels around those that lift the body, for a measure that says which these are [its unit]."""
    if subject.measure.uplift is None:
        raise InvalidValueError(f"which levels of {subject.measure.name}? Give levels in {subject.measure.unit}")
    low, high, count = _REACH
    lifts = subject.measure.uplift(subject.scale)
    return np.geomspace(low * lifts, high * lifts, count)


def _refuse_others(kind: str, by_kind: dict[str, dict[str, Any]]) -> None:
    for other, values in by_kind.items():
        odd = [name for name, value in values.items() if value is not None]
        if odd and other != kind:
            raise InvalidValueError(f'{odd[0]} is for analysis="{other}" only, this is "{kind}"')


def _with_curves(analysis: MultipleStripeAnalysis | CloudAnalysis) -> "xr.Dataset":
    """Return the dataset of an analysis with the curve of each state beside what was counted."""
    names = [state.name for state in analysis.states]
    curves = [name in analysis.fits and curve_of(name, analysis.fits[name]) for name in names]
    verdicts = [analysis.fits[name].verdict if name in analysis.fits else analysis.uplift.verdict for name in names]
    units, of_each = {"units": analysis.subject.label["units"]}, {"units": "1"}

    def over_states(name: str, unit: dict[str, str]) -> tuple[Any, FloatArray, dict[str, str]]:
        return "state", np.array([getattr(curve, name) if curve else np.nan for curve in curves]), unit

    def intervals(name: str, unit: dict[str, str]) -> tuple[Any, FloatArray, dict[str, str]]:
        ends = np.array([ends_of(getattr(curve, name) if curve else None) for curve in curves])
        return ("state", "end"), ends, unit

    return analysis.dataset.assign(
        median=over_states("median", units),
        dispersion=over_states("dispersion", of_each),
        median_95=intervals("median_95", units),
        dispersion_95=intervals("dispersion_95", of_each),
        verdict=("state", np.array(verdicts)),
    ).assign_coords(state=names, end=["low", "high"])
