"""Fragility curves for export, independent of the analysis. Crossing curves raise an error or are fitted again."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError, extra
from rocking.messages import Message, Option, listed, plain_texts
from rocking.motions.intensity import exchange_unit
from rocking.statistics.goodness import STATISTICS, Agreement, Ends, Repeated, agreement_of, ends_of, repeated_of
from rocking.statistics.lognormal import LognormalFit, difference_extremes, lognormal_probability
from rocking.statistics.ordered_probit import nested_curves
from rocking.studies.fragility.limit_states import NAMED, damage_state
from rocking.studies.fragility.subject import Subject, checked_levels

if TYPE_CHECKING:
    import xarray as xr

CLAIMS = ("method", "verdict", "interval_method")  # texts that are exported with every curve
Crossing = Literal["keep-uplift", "common-dispersion", "refuse"]

COMMON = "common-dispersion"  # method of curves with a common dispersion
ROCKING, OVERTURNED = NAMED["rocking"].name, NAMED["overturning"].name
STATES = Option("fragility.limit_states")
TOLERANCE = 1e-6  # largest allowed difference of probabilities in a file: worse state - lesser state [-]


@dataclass(frozen=True)
class FragilityCurve:
    """Lognormal fragility curve of one limit state.

    Parameters
    ----------
    state : str
        Name of the state.
    median : float
        Level at which the probability of the state is 0.5 [unit of the measure].
    dispersion : float
        Standard deviation of the natural logarithm of the level [-].
    method : str
        Method of the fit.
    verdict : str
        Verdict on the fit.
    median_95, dispersion_95 : tuple, optional
        Ends of the 95 % intervals [unit of median, dispersion]. An open end is None; a missing interval is None.
    interval_method : str
        Method of the intervals.
    agreement : Agreement, optional
        Goodness of fit; None if not requested.
    repeated : Repeated, optional
        Intervals from the bootstrap; None if not requested.
    alone : FragilityCurve, optional
        The curve that was fitted to this state alone, with intervals; None if this curve is that fit.

    Raises
    ------
    InvalidValueError
        If the median or the dispersion is not a finite number above zero.
    """

    state: str
    median: float
    dispersion: float
    method: str = ""
    verdict: str = ""
    median_95: Ends | None = None
    dispersion_95: Ends | None = None
    interval_method: str = ""
    agreement: Agreement | None = None
    repeated: Repeated | None = None
    alone: "FragilityCurve | None" = None

    def __post_init__(self) -> None:
        checks.positive(f"median of {self.state!r:.60}", self.median)
        checks.positive(f"dispersion of {self.state!r:.60}", self.dispersion)

    @property
    def facts(self) -> dict[str, Any]:
        """The curve, with the keys of `LognormalFit.summary`. Missing values are None."""
        absent = dict.fromkeys(("interval_method", "standard_errors", "log_likelihood"))
        ends = {name: list(getattr(self, name) or (None, None)) for name in ("median_95", "dispersion_95")}
        values = {name: getattr(self, name) for name in ("median", "dispersion", "method", "verdict")}
        return {**absent, **ends, **values}

    def probability(self, level: Any) -> FloatArray:
        """Return the probability of the state at levels of the measure.

        Parameters
        ----------
        level : float or array_like
            Levels >= 0 [unit of the measure].

        Returns
        -------
        ndarray
            Probabilities [-].

        Examples
        --------
        >>> float(FragilityCurve("overturned", 3.0, 0.4).probability(3.0))
        0.5
        """
        return lognormal_probability(np.asarray(level, dtype=np.float64), self.median, self.dispersion)


@dataclass(frozen=True, eq=False, repr=False)
class FragilityModel:
    """Fragility curves of one body over one measure, with the data of the fit.

    Parameters
    ----------
    name : str
        Name of the body, as in an inventory.
    im : str
        Name of the intensity measure.
    unit : str
        Unit of the measure; ``-`` if dimensionless.
    curves : tuple of FragilityCurve
        Curves from the mildest to the worst state.
    levels : ndarray
        Levels of the histories [unit of the measure].
    trials : ndarray of int
        Number of histories at every level.
    reached : dict of str to ndarray
        Number of histories that reached each state.
    source : str
        Source of the data.
    uplift_threshold : float, optional
        Level below which no body rocks, if known [unit of the measure].
    about : dict
        Provenance as plain values.
    without : dict of str to str
        States without a curve, with the reason.
    adjusted : str
        Reason why curves differ from fits to single states; empty if they do not differ.

    Raises
    ------
    InvalidValueError
        If there is no curve, if two curves have the same name, or if the counts do not fit the levels.
    """

    name: str
    im: str
    unit: str
    curves: tuple[FragilityCurve, ...]
    levels: FloatArray
    trials: np.ndarray
    reached: Mapping[str, np.ndarray]
    source: str = ""
    uplift_threshold: float | None = None
    about: Mapping[str, Any] = field(default_factory=dict)
    without: Mapping[str, str] = field(default_factory=dict)
    adjusted: str = ""

    def __post_init__(self) -> None:
        names = [curve.state for curve in self.curves]
        if not names or len(set(names)) < len(names):
            raise InvalidValueError("curves must contain at least one curve, one per state, got {names}", names=names)
        levels = np.asarray(self.levels, dtype=np.float64)
        object.__setattr__(self, "levels", checked_levels("levels", levels, self.unit))
        for name, counts in {"trials": self.trials, **self.reached}.items():
            if np.shape(counts) != self.levels.shape:
                raise InvalidValueError(
                    "{parameter} must be {size} counts, got shape {shape}", parameter=name, size=self.levels.size,
                    shape=np.shape(counts),
                )  # fmt: skip

    def __repr__(self) -> str:
        curves = "; ".join(f"{c.state}: median {c.median:.4g}, dispersion {c.dispersion:.3g}" for c in self.curves)
        return f"<FragilityModel {self.name!r} over {self.im} [{self.unit}]: {curves or 'no curve'}>"

    @property
    def shared(self) -> "dict[str, FragilityCurve]":
        """Curves with a common dispersion, by state."""
        return {curve.state: curve for curve in self.curves if curve.method == COMMON}

    @property
    def highest(self) -> float:
        """Level above which all curves are 1: 4 dispersions above all medians, at least the last level."""
        return max(float(self.levels[-1]), *(c.median * math.exp(min(4.0 * c.dispersion, 600.0)) for c in self.curves))

    @property
    def dataset(self) -> "xr.Dataset":
        """Dataset of curves, levels and counts with units, over state and level."""
        xarray = extra("xarray", "a labelled dataset")
        unit = "1" if self.unit == "-" else self.unit
        counted = [name for name in self.reached if len(self.levels)]
        data = {
            "median": ("state", [c.median for c in self.curves], {"units": unit}),
            "dispersion": ("state", [c.dispersion for c in self.curves], {"units": "1"}),
            "probability": (("state", "level"), np.array([c.probability(self.levels) for c in self.curves])),
            "exceeded": (("counted_state", "level"), np.array([self.reached[name] for name in counted])),
            "trials": ("level", np.asarray(self.trials), {"units": "1"}),
            **variables_of(self.curves, self.levels.size, unit),
        }
        coords = {
            "state": [c.state for c in self.curves],
            "counted_state": counted,
            "end": ["low", "high"],
            "level": ("level", self.levels, {"units": unit, "long_name": self.im}),
        }
        texts = {claim: listed(f"{c.state}: {getattr(c, claim)}" for c in self.curves) for claim in CLAIMS}
        texts |= {f"without_curve {state}": reason for state, reason in self.without.items()}
        texts |= {"adjusted": self.adjusted} if self.adjusted else {}
        about = {"component": self.name, "im": self.im, "source": self.source, **texts, **self.about}
        labelled: xr.Dataset = xarray.Dataset(data, coords=coords, attrs=plain_texts(about))
        return labelled


def model_of(
    analysis: Any, name: str, source: str = "", *, crossing_curves: Crossing = "keep-uplift", bootstrap: int = 0,
    seed: int = 0, limit_states: Sequence[str] | None = None,
) -> FragilityModel:  # fmt: skip
    """Return the curves of an analysis, ready for export.

    Parameters
    ----------
    analysis : MultipleStripeAnalysis, CloudAnalysis or IncrementalDynamicAnalysis
        The analysis.
    name : str
        Name of the body, as in an inventory.
    source : str
        Source of the data. Default: the definition of the analysis.
    crossing_curves : {"keep-uplift", "common-dispersion", "refuse"}
        Treatment of curves that cross. "keep-uplift": one dispersion for all crossing states except rocking. The curve
        of rocking is not changed if uplift is impossible below a level, and is omitted if it still crosses.
        "common-dispersion": always one dispersion for all states. "refuse": the curves of the single states. For
        crossing curves, export for FEMA P-58, PELICUN and OpenQuake then raises an error.
    bootstrap : int
        Number of bootstrap repetitions for additional intervals and bands. 0 means no bootstrap.
    seed : int
        Seed of all random numbers.
    limit_states : sequence of str, optional
        Names of the states of the model. Default: all states.

    Returns
    -------
    FragilityModel
        The curves. States without a finite median and dispersion are omitted, and ``without`` contains the reasons. If
        curves differ from the fits to single states, ``adjusted`` contains the reason.

    Raises
    ------
    InvalidValueError
        If `crossing_curves` or a state is unknown, if no state has a curve, or if no common dispersion exists.
    """
    check_crossing(crossing_curves)
    alone = _alone(analysis, name, source, limit_states)
    curves = [with_evidence(c, analysis.fits[c.state], analysis.levels, bootstrap, seed) for c in alone.curves]
    return without_crossing(replace(alone, curves=tuple(curves)), crossing_curves)


def shown_curves(analysis: Any, crossing_curves: Crossing = "keep-uplift") -> FragilityModel | None:
    """Return the curves of exported files, without goodness of fit; None if there are no curves."""
    try:
        return without_crossing(_alone(analysis, "body"), crossing_curves)
    except InvalidValueError:  # the export of files raises an error with the reason
        return None


def _alone(analysis: Any, name: str, source: str = "", limit_states: Sequence[str] | None = None) -> FragilityModel:
    """Return the curves fitted to single states."""
    states = (
        list(analysis.fits)
        if limit_states is None
        else [checks.one_of("limit_states", s, analysis.fits) for s in limit_states]
    )
    subject: Subject = analysis.subject
    measure = subject.measure
    curves = {s: curve_of(s, fit, measure.name, measure.unit) for s, fit in analysis.fits.items() if s in states}
    without = [state for state, curve in curves.items() if curve is None]
    if len(without) == len(curves):
        raise InvalidValueError(
            "nothing to export: no state of {name!r:.60} has a lognormal curve", name=name,
            hint=f"Some histories must reach a state and others not, at levels that overlap ({', '.join(without)}).",
        )  # fmt: skip
    about = subject.about() | {"definition": analysis.definition, "without_curve": ", ".join(without)}
    return FragilityModel(
        name, measure.name, measure.unit, tuple(filter(None, curves.values())), analysis.levels, analysis.trials,
        analysis.counts, source or analysis.definition, subject.lowest_uplift, about,
        {state: analysis.fits[state].verdict_in(*_shown(measure.name, measure.unit)) for state in without},
    )  # fmt: skip


def curve_of(state: str, fit: LognormalFit, measure: str = "", unit: str = "-") -> FragilityCurve | None:
    """Return a fit as a curve; None if median and dispersion are not finite and above zero.

    The verdict contains levels of the measure in the unit of exported files.
    """
    median, dispersion = fit.median, fit.dispersion
    if median is None or dispersion is None or not 0.0 < median < math.inf or not 0.0 < dispersion < math.inf:
        return None
    summary = fit.summary()
    return FragilityCurve(
        state, float(median), float(dispersion), fit.method, fit.verdict_in(*_shown(measure, unit)),
        tuple(summary["median_95"]), tuple(summary["dispersion_95"]), summary["interval_method"],
    )  # fmt: skip


def _shown(measure: str, unit: str) -> tuple[str, float]:
    """Return the unit of a measure in texts of exported files, and the size of one SI unit in this unit."""
    name, size = exchange_unit(measure, unit)
    return "" if name == "-" else name, size


def with_evidence(
    curve: FragilityCurve, fit: LognormalFit, levels: FloatArray, bootstrap: int = 0, seed: int = 0
) -> FragilityCurve:
    """Return a curve with goodness of fit and, if requested, bootstrap intervals and bands at levels."""
    repeated = repeated_of(fit, levels, bootstrap, seed) if bootstrap else None
    return replace(curve, agreement=agreement_of(fit, seed), repeated=repeated)


def without_crossing(model: FragilityModel, crossing_curves: Crossing = "keep-uplift") -> FragilityModel:
    """Return the model with curves that do not cross, by one of the treatments. With "refuse", it is unchanged."""
    own = tuple(curve for curve in model.curves if damage_state(curve.state))
    if own:  # they have no order with the rotations; an overturned body has reached all of them
        return _with_restraints(model, own, crossing_curves)
    match check_crossing(crossing_curves):
        case "common-dispersion" if len(model.curves) > 1:
            return with_common_dispersion(model)
        case "keep-uplift" if (excess := crosses(model)) is not None:
            return _keeping_uplift(model, excess)
    return model


def _with_restraints(
    model: FragilityModel, own: tuple[FragilityCurve, ...], crossing_curves: Crossing
) -> FragilityModel:
    """Return the model with its curves of the rotation treated, and the curves of restraints as fitted."""
    ordered = tuple(curve for curve in model.curves if curve not in own)
    if not ordered:
        return model
    joined = without_crossing(replace(model, curves=ordered), crossing_curves)
    last = joined.curves[-1]
    excesses = [crosses(replace(joined, curves=(curve, last))) for curve in own if last.state == OVERTURNED]
    text = "The curves of restraints stay as fitted: {excess}."
    notes = [Message(text, {"excess": excess.describe(joined)}) for excess in excesses if excess is not None]
    adjusted = Message.joined(filter(None, [joined.adjusted, *notes])) if notes else joined.adjusted
    return replace(joined, curves=(*joined.curves[:-1], *own, last), adjusted=adjusted)


def _keeping_uplift(model: FragilityModel, excess: "Excess") -> FragilityModel:
    """Return the model with one dispersion for the states without a threshold of uplift."""
    reason = Message("Separately fitted curves cross: {excess}.", {"excess": excess.describe(model)})
    decided = tuple(c for c in model.curves if c.state == ROCKING and model.uplift_threshold is not None)
    others = replace(model, curves=tuple(c for c in model.curves if c not in decided))
    try:
        nested_model = with_common_dispersion(others) if crosses(others) is not None else others
    except InvalidValueError:
        names = ", ".join(curve.state for curve in others.curves)
        kept = Message(
            "The curves stay separate, because no common dispersion fits the states {states}.", {"states": names}
        )
        return replace(model, adjusted=Message.joined([reason, kept]))
    joined = replace(nested_model, curves=(*decided, *nested_model.curves))
    reasons = [reason, nested_model.adjusted]
    if not decided:
        return replace(joined, adjusted=Message.joined(reasons))
    facts = {"state": ROCKING, "uplift": uplift_words(model)}
    if crosses(joined) is None:
        reasons.append(Message("The curve of {state} is not changed: {uplift}.", facts))
    else:
        omitted = "The limit state {state} is omitted, because its curve would cross another curve: {uplift}."
        reasons.append(Message(omitted, facts))
        joined = replace(nested_model, without={**model.without, ROCKING: reasons[-1]})
    return replace(joined, adjusted=Message.joined(reasons))


def uplift_words(model: FragilityModel) -> str:
    """Return a sentence with the level below which no motion causes uplift."""
    unit, size = _shown(model.im, model.unit)
    level = f"{(model.uplift_threshold or 0.0) * size:.4g} {unit}".rstrip()
    return Message("no motion causes uplift below {level}", {"level": level})


_COMMON = (
    "The states have a common dispersion, so that their curves do not cross. The separate fit of this state has median "
    "{median}, dispersion {dispersion:.3g}."
)


def with_common_dispersion(model: FragilityModel) -> FragilityModel:
    """Return the model after a new fit of all states with one dispersion, from its counts."""
    missing = [curve.state for curve in model.curves if curve.state not in model.reached]
    if missing:
        raise InvalidValueError(
            "a common dispersion needs the counts of all states; state {state!r:.60} has none", state=missing[0]
        )
    has_trials = np.asarray(model.trials) > 0
    reached = np.array([np.asarray(model.reached[c.state], dtype=np.float64)[has_trials] for c in model.curves])
    try:
        fitted = nested_curves(
            model.levels[has_trials], reached, np.asarray(model.trials, dtype=np.float64)[has_trials]
        )
    except InvalidValueError as error:
        names = ", ".join(curve.state for curve in model.curves)
        hint = Message(f"The states are {names}. {{option}} selects fewer states.", {"option": STATES})
        error.hint = hint
        raise
    unit, size = _shown(model.im, model.unit)
    names = ", ".join(curve.state for curve in model.curves)
    text = (
        "The states {states} have a common dispersion, so that their curves do not cross. The common fit has no "
        "confidence intervals."
    )
    adjusted: str = Message(text, {"states": names})
    curves = []
    for curve, (median, dispersion) in zip(model.curves, fitted, strict=True):
        facts = {"median": f"{curve.median * size:.4g} {unit}".rstrip(), "dispersion": curve.dispersion}
        verdict = Message.joined([Message(_COMMON, facts), curve.verdict])
        curves.append(FragilityCurve(curve.state, median, dispersion, COMMON, verdict, alone=curve))
        if curve.state == ROCKING and model.uplift_threshold is not None:
            probability_at_uplift = float(curves[-1].probability(model.uplift_threshold))
            at_uplift = {"state": ROCKING, "share": probability_at_uplift, "uplift": uplift_words(model)}
            gives = "The curve of {state} gives the probability {share:.2g} at the level of uplift: {uplift}."
            adjusted = Message.joined([adjusted, Message(gives, at_uplift)])
    return replace(model, curves=tuple(curves), adjusted=adjusted)


def variables_of(curves: Sequence[FragilityCurve], levels: int, unit: str) -> dict[str, Any]:
    """Return intervals, goodness of fit and bootstrap of curves over state. Missing values are NaN."""

    def intervals(ends: Sequence[Ends | None], units: str, meaning: str) -> tuple[Any, np.ndarray, dict[str, str]]:
        long_name = f"95 % interval{meaning}; missing for an open end or a missing interval"
        return (
            ("state", "end"),
            np.array([ends_of(interval) for interval in ends]),
            {"units": units, "long_name": long_name},
        )

    variables: dict[str, Any] = {
        "median_95": intervals([curve.median_95 for curve in curves], unit, ""),
        "dispersion_95": intervals([curve.dispersion_95 for curve in curves], "1", ""),
    }
    agreements = [curve.agreement or Agreement() for curve in curves]
    for name, long_name in STATISTICS.items():
        value, p_value = np.array([agreement.numbers[name] for agreement in agreements]).T
        variables[name] = ("state", value, {"units": "1", "long_name": long_name})
        variables[f"{name}_p_value"] = ("state", p_value, {"units": "1", "long_name": f"p-value: {long_name}"})
    variables["agreement"] = ("state", np.array([agreement.basis for agreement in agreements]))
    if any(curve.alone for curve in curves):
        alone = [curve.alone or curve for curve in curves]
        about = {"long_name": "of the curve fitted to the state alone"}
        variables["median_alone"] = ("state", np.array([c.median for c in alone]), {"units": unit, **about})
        variables["dispersion_alone"] = ("state", np.array([c.dispersion for c in alone]), {"units": "1", **about})
        variables |= {f"{name}_alone": variable for name, variable in variables_of(alone, levels, unit).items()}
    if not any(curve.repeated for curve in curves):
        return variables
    bootstraps, meaning = [curve.repeated or Repeated() for curve in curves], " from the bootstrap"
    open_band = np.full((2, levels), math.nan)
    bands = np.array([open_band if bootstrap.band is None else bootstrap.band for bootstrap in bootstraps])
    dispersion = intervals([bootstrap.dispersion_95 for bootstrap in bootstraps], "1", meaning)
    return variables | {
        "median_bootstrap_95": intervals([bootstrap.median_95 for bootstrap in bootstraps], unit, meaning),
        "dispersion_bootstrap_95": dispersion,
        "probability_bootstrap_95": (("state", "end", "level"), bands, dispersion[2]),
        "bootstrap": ("state", np.array([bootstrap.basis for bootstrap in bootstraps])),
    }


@dataclass(frozen=True)
class Excess:
    """Level with the largest excess of the curve of a worse state over the curve of a lesser state."""

    lesser: str  # lesser, worse: names of the states
    worse: str
    level: float  # [unit of the measure]
    size: float  # difference of the probabilities at this level [-]

    def describe(self, model: FragilityModel) -> str:
        """Return a phrase with the level, the states and the difference."""
        unit, size = _shown(model.im, model.unit)
        level = f"{self.level * size:.4g} {unit}".rstrip()
        facts = {"level": level, "worse": self.worse, "lesser": self.lesser, "size": self.size}
        return Message(
            "at {level} the probability of '{worse}' exceeds the probability of '{lesser}' by {size:.2g}", facts
        )


def largest_excess(model: FragilityModel, lowest: float, highest: float) -> Excess | None:
    """Return the largest excess of neighbouring curves between two levels; None if the curves do not cross."""
    largest = None
    for lesser, worse in pairwise(model.curves):
        medians, dispersions = np.array([(c.median, c.dispersion) for c in (lesser, worse)]).T
        with np.errstate(over="ignore", under="ignore"):
            extremes = np.exp(difference_extremes(np.log(medians), dispersions))
        candidates = np.array([lowest, highest, *extremes[(extremes > lowest) & (extremes < highest)]])
        differences = worse.probability(candidates) - lesser.probability(candidates)
        k = int(np.argmax(differences))
        if differences[k] > (0.0 if largest is None else largest.size):
            largest = Excess(lesser.state, worse.state, float(candidates[k]), float(differences[k]))
    return largest


def crosses(model: FragilityModel, highest: float | None = None) -> Excess | None:
    """Return the largest excess above the tolerance between uplift level and highest level; None if none."""
    worst = largest_excess(model, model.uplift_threshold or 0.0, model.highest if highest is None else highest)
    return None if worst is None or worst.size <= TOLERANCE else worst


def nested(model: FragilityModel, crossing_curves: Crossing = "refuse", highest: float | None = None) -> FragilityModel:
    """Return curves that do not cross up to the highest level, by one of the treatments."""
    if own := [curve.state for curve in model.curves if damage_state(curve.state)]:
        raise InvalidValueError(
            "this file needs limit states in an order, without states of restraints, got {states}",
            parameter="limit_states", states=", ".join(own),
        )  # fmt: skip
    model = without_crossing(model, crossing_curves)
    if (worst := crosses(model, highest)) is None:
        return model
    if model.adjusted:
        hint = Message("No common dispersion fits these states. Select fewer states with {option}.", {"option": STATES})
    else:
        keep = Option("export.crossing_curves", "keep-uplift")
        hint = Message(
            "Their dispersions differ. {option} fits one dispersion for all limit states except rocking.",
            {"option": keep},
        )
    raise InvalidValueError(
        "curves must not cross, but {crossing}, at most {limit:g} is allowed", crossing=worst.describe(model),
        limit=TOLERANCE, hint=hint,
    )  # fmt: skip


def check_crossing(crossing_curves: Any) -> str:
    """Return the treatment of curves that cross. Raise an error for an unknown treatment."""
    return str(checks.one_of("crossing_curves", crossing_curves, get_args(Crossing)))
