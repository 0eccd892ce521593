"""Fragility of a body by one of three analyses, as a labelled dataset."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body, Restrained
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray
from rocking.errors import InvalidValueError
from rocking.statistics.goodness import ends_of
from rocking.studies.fragility.cloud_analysis import CloudAnalysis
from rocking.studies.fragility.curves import curve_of
from rocking.studies.fragility.multiple_stripe_analysis import MultipleStripeAnalysis
from rocking.studies.fragility.question import ANALYSES, FragilityQuestion
from rocking.studies.fragility.subject import Motions, Progress, Subject

if TYPE_CHECKING:
    import xarray as xr


def fragility(  # noqa: PLR0913 - users set every one of them
    body: Body | Restrained,
    motions: Motions,
    levels: Any = None,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    analysis: str = "stripes",
    im: Any = "pga",
    limit_states: Sequence[float | str] = (0.5,),
    scale: float | None = None,
    min_rotation: float | None = None,
    tolerance: float | None = None,
    progress: Progress = None,
    **options: Any,
) -> "xr.Dataset":
    """Return the probability of rocking, of large rotations and of overturning over the intensity level.

    Parameters
    ----------
    body : Body or Restrained
        The body, or a plane body with restraints.
    motions : GroundMotion or Pulse, a sequence of them, or MotionSet
        Either records only or pulses only.
    levels : array_like, optional
        Increasing levels of the measure [unit of the measure], to which every motion is scaled. A cloud has no levels.
        An incremental analysis searches boundaries between neighbouring levels with different outcomes, and between
        zero and the first level. Default: 16 levels from 0.9 to 9 times the uplift level, if the measure has an uplift
        level.
    restitution : as for `simulate`
        Model, name of a model, coefficient, pair by side, or law.
    analysis : {"stripes", "cloud", "incremental"}
        Multiple stripes; cloud of the motions as recorded; or stripes with all levels between them at which a motion
        begins or ceases to overturn the body.
    im : str or IntensityMeasure
        A name from `rocking.motions.intensity.measures`, or ``sa(period)``. Levels need a measure that increases with
        the scale factor.
    limit_states : sequence of float or str
        Limit states as rotations / alpha [-]. Rocking and overturning are added, unless ``"rocking"`` or
        ``"overturning"`` is in the sequence. States of restraints are ``"yield"`` and ``"rupture"`` of any restraint,
        and ``"yield of NAME"`` and ``"rupture of NAME"``. An overturned body has reached them all.
    scale : float, optional
        Scale factor of all motions of a cloud [-]. The default is 1.
    min_rotation : float, optional
        Smallest rotation / alpha with which a history of a cloud is part of the regression [-]. The default is 0.01.
    tolerance : float, optional
        Relative width at which the search of an incremental analysis ends [-]. 0 means the last bit; the default is
        1e-8.
    progress : callable, optional
        Called with the number of histories done since the last call.
    **options
        ``gravity`` [m/s2], ``engine``, ``threads`` and fields of `Settings`.

    Returns
    -------
    xarray.Dataset
        Dataset of outcome and rotation over ``motion`` and ``level`` (cloud: over ``motion``). The lognormal curves are
        over ``state``: median [unit of the measure], dispersion [-], 95 % intervals of both, and the verdict. Missing
        values are NaN. All variables have units.

    Raises
    ------
    InvalidValueError
        If a value is outside its range or is for another analysis, or if levels are missing.
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
    if tolerance is not None:
        kind = checks.one_of("analysis", analysis, ANALYSES)
        if kind != "incremental":
            raise InvalidValueError(
                '{parameter} is for analysis="incremental" only, this is "{kind}"', parameter="tolerance", kind=kind
            )
        options["tolerance"] = tolerance
    return _with_curves(fragility_analysis(
        body, motions, levels, restitution, analysis=analysis, im=im, limit_states=limit_states, scale=scale,
        min_rotation=min_rotation, progress=progress, **options,
    ))  # fmt: skip


def fragility_analysis(  # noqa: PLR0913 - those of `fragility`
    body: Body | Restrained,
    motions: Motions,
    levels: Any = None,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    analysis: str = "stripes",
    im: Any = "pga",
    limit_states: Sequence[float | str] = (0.5,),
    scale: float | None = None,
    min_rotation: float | None = None,
    progress: Progress = None,
    **options: Any,
) -> Any:
    """Return the analysis of `fragility` as an object for plots, rankings of measures and files.

    Parameters
    ----------
    body, motions, levels, restitution, analysis, im, limit_states, scale, min_rotation, progress
        As for `fragility`. `progress` does not count the histories of a search.
    **options
        As for `fragility`. For stripes and clouds, ``tolerance`` is the tolerance of `Settings`.

    Returns
    -------
    MultipleStripeAnalysis, CloudAnalysis or IncrementalDynamicAnalysis
        Outcomes, counts and curves; for a cloud the regression, for an incremental analysis the intervals.

    Raises
    ------
    InvalidValueError
        If a value is outside its range or is for another analysis, or if levels are missing.

    Examples
    --------
    >>> import rocking as rk
    >>> block, sine = rk.Block(width=0.4, height=1.6), rk.pulses.sine
    >>> stripes = fragility_analysis(block, [sine(1.0, period) for period in (0.4, 0.6, 0.8)], [2.0, 4.0, 6.0])
    >>> stripes.counts["rocking"].tolist()
    [0, 3, 3]
    >>> stripes.uplift.verdict
    'rocking is certain above 2.45166 and impossible below: 0 of 9 histories contradict it'
    >>> pulses = [sine(a, 0.6) for a in (2.0, 2.6, 2.8, 3.0, 3.2, 6.0, 8.0)]
    >>> cloud = fragility_analysis(block, pulses, analysis="cloud")
    >>> {outcome.name: n for outcome, n in cloud.responses.counts().items()}
    {'NO_UPLIFT': 1, 'ROCKED': 4, 'OVERTURNED': 2}
    >>> pulses = [sine(1.0, period) for period in (0.5, 0.7)]
    >>> growing = fragility_analysis(block, pulses, [3.0, 6.0, 9.0], restitution=0.9, analysis="incremental")
    >>> growing.fractions.tolist()  # a motion that overturns the body at 6 m/s2 may not at 9
    [0.0, 1.0, 0.5]
    >>> [(round(i.start, 3), round(i.end, 3)) for i in growing.intervals]
    [(4.789, inf), (3.449, 8.667)]
    """
    kind, threads = checks.one_of("analysis", analysis, ANALYSES), options.pop("threads", None)
    search = options.pop("tolerance", None) if kind == "incremental" else None
    question = FragilityQuestion.of(
        Subject.of(body, motions, restitution, im, options), kind, levels, limit_states, scale=scale,
        min_rotation=min_rotation,
        tolerance=search,
    )  # fmt: skip
    return question.computed(threads, progress)


def _with_curves(analysis: MultipleStripeAnalysis | CloudAnalysis) -> "xr.Dataset":
    """Return the dataset of an analysis, including the curves of the states."""
    names = [state.name for state in analysis.limit_states]
    curves = [name in analysis.fits and curve_of(name, analysis.fits[name]) for name in names]
    verdicts = [analysis.fits[name].verdict if name in analysis.fits else analysis.uplift.verdict for name in names]
    units, dimensionless = {"units": analysis.subject.label["units"]}, {"units": "1"}

    def over_states(name: str, unit: dict[str, str]) -> tuple[Any, FloatArray, dict[str, str]]:
        return "state", np.array([getattr(curve, name) if curve else np.nan for curve in curves]), unit

    def intervals(name: str, unit: dict[str, str]) -> tuple[Any, FloatArray, dict[str, str]]:
        ends = np.array([ends_of(getattr(curve, name) if curve else None) for curve in curves])
        return ("state", "end"), ends, unit

    return analysis.dataset.assign(
        median=over_states("median", units),
        dispersion=over_states("dispersion", dimensionless),
        median_95=intervals("median_95", units),
        dispersion_95=intervals("dispersion_95", dimensionless),
        verdict=("state", np.array(verdicts)),
    ).assign_coords(state=names, end=["low", "high"])
