"""Comparison of the results of a study with several choices of restitution."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import percent
from rocking.dynamics.impact_laws import ImpactLaw, RandomRestitution
from rocking.errors import InvalidValueError, extra
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion, Pulse
from rocking.outcome import Outcome
from rocking.studies.axis import axis_of
from rocking.studies.fragility.multiple_stripe_analysis import MultipleStripeAnalysis
from rocking.studies.fragility.question import FragilityQuestion
from rocking.studies.fragility.subject import Subject
from rocking.studies.motion_sets import MotionSet
from rocking.studies.sensitivity.changes import CurveChange, Flips, curve_change, difference_of, flips_of
from rocking.studies.sensitivity.restitutions import named_restitutions, sampled

if TYPE_CHECKING:
    import xarray as xr

_COUNTS = ("count", "only_second", "only_first", "compared", "unknown", "fraction", "fraction_low", "fraction_high")


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity:
    """Comparison of the results of a study with several restitutions.

    Parameters
    ----------
    results : dict of str to result
        Results by the name of the choice: datasets with an outcome, or analyses with a `dataset`.
    baseline : str
        The reference choice of the comparison.
    repetitions : int
        Number of resampled sets of motions for the intervals of fragility curves.
    seed : int
        Random seed of the samples.
    sampled : collection of str
        Names of the choices with random coefficients, for which other samples may change other verdicts.

    Raises
    ------
    InvalidValueError
        If a result has no outcome, if results have different shapes, or if a choice is unknown.
    """

    results: dict[str, Any]
    baseline: str = field(kw_only=True)
    repetitions: int = field(default=1000, kw_only=True)
    seed: int = field(default=0, kw_only=True)
    sampled: Collection[str] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "baseline", checks.one_of("baseline", self.baseline, self.results))
        shapes = {label: dict(dataset["outcome"].sizes) for label, dataset in self.datasets.items()}
        odd = next((label for label, shape in shapes.items() if shape != shapes[self.baseline]), None)
        if odd is not None:
            raise InvalidValueError(
                "{parameter} must be of one shape, got {shape} with {choice}, {expected} with {baseline}",
                parameter="results", shape=shapes[odd], choice=odd, expected=shapes[self.baseline],
                baseline=self.baseline, hint="Check that all results belong to one study.",
            )  # fmt: skip

    def __repr__(self) -> str:
        """Names of the compared choices."""
        return f"<Sensitivity: {', '.join(self.labels[1:])} against {self.baseline}>"

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the choices, the baseline first."""
        return (self.baseline, *(label for label in self.results if label != self.baseline))

    @cached_property
    def datasets(self) -> dict[str, "xr.Dataset"]:
        """The outcomes by the name of the choice."""
        return {label: _dataset(label, result) for label, result in self.results.items()}

    @property
    def cases(self) -> str:
        """Unit of the counts: histories if the study has motions, otherwise cells of a map."""
        return "histories" if "motion" in self.datasets[self.baseline]["outcome"].dims else "cells"

    def flips_between(self, first: str, second: str) -> Flips:
        """Return the number of different verdicts between two choices.

        Parameters
        ----------
        first, second : str
            Names of choices.

        Returns
        -------
        Flips
            The counts. If there are several motions, the interval assumes independent motions; otherwise it assumes
            independent samples of the histories. Without samples, the interval is NaN. For a choice compared with
            itself, it is zero.
        """
        first, second = (checks.one_of("choice", label, self.labels) for label in (first, second))
        a, b = (self.datasets[label]["outcome"] for label in (first, second))
        if first == second:
            return replace(flips_of(a.values, b.values), fraction_low=0.0, fraction_high=0.0)
        is_random = not {first, second}.isdisjoint(self.sampled)
        if "motion" not in a.dims:
            return flips_of(a.values, b.values, sampled=is_random)
        shape = [-1 if name == "motion" else 1 for name in a.dims]
        return flips_of(a.values, b.values, np.arange(a.sizes["motion"]).reshape(shape), sampled=is_random)

    def flips(self) -> "xr.Dataset":
        """Return the number of different verdicts between all pairs of choices.

        Returns
        -------
        xarray.Dataset
            Dataset over ``first, second``: count, only_second (overturned only in the second), only_first, compared,
            unknown, and the fraction with its 95 % interval. The interval is missing without several motions or random
            coefficients.
        """
        xarray = extra("xarray", "a table of flips")
        pairs = [self.flips_between(first, second) for first, second in product(self.labels, self.labels)]
        shape, both = (len(self.labels),) * 2, ("first", "second")
        data = {name: (both, np.array([getattr(p, name) for p in pairs]).reshape(shape)) for name in _COUNTS}
        table: xr.Dataset = xarray.Dataset(data, coords={name: list(self.labels) for name in both})
        clusters = max(pair.clusters for pair in pairs)
        independent = f"{clusters} motions" if clusters else self.cases if self.sampled else "nothing"
        return table.assign_attrs(cases=self.cases, independent=independent)

    def differences(self, name: str = "verdict") -> "xr.DataArray":
        """Return the difference of a value between the baseline and every other choice.

        Parameters
        ----------
        name : str
            ``verdict`` (-1 overturned only with the baseline, 0 equal verdicts, 1 overturned only with the choice, 2
            failed with one of the two), or a variable of the results such as ``peak_ratio``.

        Returns
        -------
        xarray.DataArray
            Differences over ``restitution`` and the dimensions of the study. Values are missing if one of the two
            histories overturned or failed.
        """
        xarray = extra("xarray", "a map of differences")
        base, others = self.datasets[self.baseline], self.labels[1:]
        maps = [difference_of(base, self.datasets[label], name) for label in others]
        labelled: xr.DataArray = xarray.concat(
            maps, xarray.DataArray(list(others), dims="restitution", name="restitution")
        )
        return labelled.assign_attrs(maps[0].attrs, baseline=self.baseline)

    def curve_change(self, choice: str, state: str = "overturned", *, baseline: str | None = None) -> CurveChange:
        """Return the differences between two fragility curves.

        Parameters
        ----------
        choice : str
            Name of the choice.
        state : str
            Name of the state.
        baseline : str, optional
            The reference choice. Default: the baseline of the comparison.

        Returns
        -------
        CurveChange
            Ratio of the medians, difference of the dispersions and largest distance, with intervals paired by motion.

        Raises
        ------
        InvalidValueError
            If the study has no such curves.
        """
        both = (baseline or self.baseline, choice)
        pair = [self.results[checks.one_of("choice", label, self.labels)] for label in both]
        if state not in self.states:
            names = ", ".join(self.states) or "none: it is no fragility analysis by stripes"
            raise InvalidValueError(
                "{parameter} must be one of {names}, got {value}", parameter="state", names=names,
                value=state,
            )  # fmt: skip
        first, second = (_curve(result.fits[state]) for result in pair)
        reached = [result.responses.exceed(next(s for s in result.limit_states if s.name == state)) for result in pair]
        return curve_change((first, second), pair[0].levels, *reached, repetitions=self.repetitions, seed=self.seed)

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states with a fragility curve; empty unless the analysis uses stripes."""
        results = self.results.values()
        if any(getattr(result, "kind", None) != MultipleStripeAnalysis.kind for result in results):
            return ()
        return tuple(name for name in self.results[self.baseline].fits if all(name in r.fits for r in results))

    @cached_property
    def _curve_changes(self) -> dict[str, dict[str, CurveChange | str]]:
        changes: dict[str, dict[str, CurveChange | str]] = {label: {} for label in self.labels[1:]}
        for label, state in product(changes, self.states):
            try:
                changes[label][state] = self.curve_change(label, state)
            except InvalidValueError as error:  # missing curves are a result, not an error of the user
                changes[label][state] = str(error)
        return changes

    def summary(self) -> list[dict[str, Any]]:
        """Return one row of plain values per choice.

        Returns
        -------
        list of dict
            Choice, overturning fraction, verdicts that differ from the baseline with the 95 % interval of their
            fraction, and differences of the curves of the states.
        """
        rows = []
        for label in self.labels:
            outcome = self.datasets[label]["outcome"].values
            good = int((outcome != Outcome.FAILED.code).sum())
            flips = self.flips_between(self.baseline, label)
            row = {"choice": label, "overturned": int((outcome == Outcome.OVERTURNED.code).sum()), "computed": good}
            row |= {"flips" if name == "count" else name: _or_none(getattr(flips, name)) for name in _COUNTS}
            for state, change in self._curve_changes.get(label, {}).items():
                row |= _plain(state, change) | {f"{state}: fit": self.results[label].fits[state].method}
            rows.append(row)
        return rows

    @property
    def verdict(self) -> str:
        """The comparison as text, one sentence per choice other than the baseline."""
        return self.text()

    def text(self, unit: tuple[str, float] | None = None) -> str:
        """Return the comparison as text, with levels in another unit.

        Parameters
        ----------
        unit : tuple of str and float, optional
            Name of the unit, and its size [unit of the intensity measure]. Default: the unit of the measure.

        Returns
        -------
        str
            One sentence per choice other than the baseline.
        """
        return "\n".join(self._sentence(label, unit) for label in self.labels[1:])

    def _sentence(self, label: str, unit: tuple[str, float] | None) -> str:
        flips = self.flips_between(self.baseline, label)
        fraction = percent(flips.fraction)
        if _or_none(flips.fraction_low) is not None:
            fraction += f", 95 % interval {percent(flips.fraction_low)} to {percent(flips.fraction_high)}"
        clauses = [
            f"With {label} instead of {self.baseline}, the outcome differs in {flips.count:,} of {flips.compared:,} "
            f"{self.cases} ({fraction})"
        ]
        if flips.count:
            clauses.append(
                f"{flips.only_second:,} overturn only with {label}, {flips.only_first:,} only with {self.baseline}"
            )
        if flips.unknown:
            clauses.append(f"{flips.unknown:,} could not be computed")
        changes = self._curve_changes.get(label, {})
        unit = unit or ((self.results[label].subject.measure.unit, 1.0) if changes else ("-", 1.0))
        clauses += [
            f"{state}: {change if isinstance(change, str) else change.text(*unit)}" for state, change in changes.items()
        ]
        return "; ".join(clauses) + "."


def _dataset(label: str, result: Any) -> "xr.Dataset":
    data = getattr(result, "dataset", result)
    if not hasattr(data, "data_vars") or "outcome" not in data:
        raise InvalidValueError(
            "the study must return a dataset or an analysis with an outcome, got {value} with {choice}",
            parameter="study", value=data, choice=label,
        )  # fmt: skip
    if data.sizes.get("restitution", 1) > 1:
        raise InvalidValueError("the study already varies the restitution. Use a study with one restitution.")
    squeezed: xr.Dataset = data.squeeze("restitution", drop=True) if "restitution" in data.dims else data
    return squeezed


def _or_none(value: float) -> float | None:
    return None if np.isnan(value) else value


def _curve(fit: Any) -> tuple[float, float]:
    """Return median and dispersion. If there is no curve, raise an error with the verdict of the fit."""
    if fit.median is None or fit.dispersion is None:
        raise InvalidValueError("no curve to compare: {reason}", reason=fit.verdict.rstrip("."))
    return float(fit.median), float(fit.dispersion)


def _plain(state: str, change: CurveChange | str) -> dict[str, Any]:
    if isinstance(change, str):
        return {f"{state}: no comparison": change}
    plain: dict[str, Any] = {}
    for name, label in (("median", "median ratio"), ("dispersion", "dispersion"), ("distance", "largest distance")):
        changed = getattr(change, name)
        plain[f"{state}: {label}"] = changed.value
        plain |= {f"{state}: {label} {end}": v for end, v in zip(("low", "high"), changed.interval or (), strict=False)}
    return plain


def sensitivity(
    study: Callable[..., Any], restitutions: Any, baseline: str | None = None, *, repetitions: int = 1000, seed: int = 0
) -> Sensitivity:
    """Compare the results of a study with several restitutions.

    All other inputs are equal, including motions and indices of histories.

    Parameters
    ----------
    study : callable
        Function with a parameter ``restitution`` that returns a dataset or an analysis with an outcome, such as a
        ``functools.partial`` of `overturning_map` or `simulate_many`.
    restitutions : list of choices, or dict of them by name
        At least two models, coefficients [-], pairs by side, or impact laws.
    baseline : str, optional
        Name of the reference choice. Default: the first choice.
    repetitions : int
        Number of resampled sets of motions for the intervals of fragility curves.
    seed : int
        Random seed of the samples.

    Returns
    -------
    Sensitivity
        The comparison.

    Raises
    ------
    InvalidValueError
        If a choice is not a restitution, or if the results have different shapes.

    Examples
    --------
    >>> from functools import partial
    >>> import rocking as rk
    >>> blocks = [rk.Block(width=0.5, height=h) for h in (1.0, 2.0, 3.0)]
    >>> study = partial(rk.simulate_many, blocks, rk.pulses.sine(4.0, 0.6), scale=[0.5, 1.0, 1.5])
    >>> comparison = sensitivity(study, ["housner", "ked"])
    >>> comparison.flips()["compared"].values.tolist()
    [[9, 9], [9, 9]]
    """
    if not callable(study):
        raise InvalidValueError(parameter="study", allowed="a function with a parameter restitution", value=study)
    choices = named_restitutions(restitutions)
    first = next(iter(choices)) if baseline is None else checks.one_of("baseline", baseline, choices)
    results = {label: study(restitution=choice) for label, choice in choices.items()}
    return Sensitivity(results, baseline=first, repetitions=repetitions, seed=seed, sampled=sampled_in(choices))


def sampled_in(choices: Mapping[str, Any]) -> list[str]:
    """Return the names of the choices with random coefficients at every impact."""
    kind = RandomRestitution.kind
    return [label for label, choice in choices.items() if isinstance(choice, ImpactLaw) and choice.kind == kind]


def map_sensitivity(
    body: Body, motion: Motion, x: Any, y: Any, restitutions: Any, *, baseline: str | None = None, **options: Any
) -> Sensitivity:
    """Return the sensitivity of an overturning map to the restitution.

    Parameters
    ----------
    body, motion, x, y
        As for `rocking.overturning_map`. The restitution must not be an axis.
    restitutions, baseline
        As for `sensitivity`.
    **options
        Options of `rocking.overturning_map`.

    Returns
    -------
    Sensitivity
        Different verdicts and values, for every cell.

    Raises
    ------
    InvalidValueError
        If an axis is the restitution, if a choice is not a restitution, or if a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> ratios = [1.0, 2.0, 3.0, 4.0]
    >>> axes = ("frequency_ratio", ratios), ("amplitude_ratio", ratios)
    >>> changes = map_sensitivity(block, pulse, *axes, ["ked", "0.999999999*ked"])
    >>> bool(changes.differences("verdict").any())
    False
    """
    from rocking.studies._overturning_map import overturning_map

    along = axis_of(x), axis_of(y)
    if any(axis.name == "restitution" for axis in along):
        raise InvalidValueError("restitution cannot be an axis in a comparison of restitutions")
    return sensitivity(partial(overturning_map, body, motion, *along, **options), restitutions, baseline)


def spectrum_sensitivity(
    motions: Motion | Sequence[Motion],
    slenderness_angles: Any,
    periods: Any,
    restitutions: Any,
    *,
    baseline: str | None = None,
    **options: Any,
) -> Sensitivity:
    """Return the sensitivity of rocking spectra to the restitution.

    Parameters
    ----------
    motions, slenderness_angles, periods
        As for `rocking.rocking_spectrum`.
    restitutions, baseline
        As for `sensitivity`.
    **options
        Options of `rocking.rocking_spectrum`.

    Returns
    -------
    Sensitivity
        Different verdicts and values, by block and motion.
    """
    from rocking.studies._rocking_spectrum import rocking_spectrum

    study = partial(rocking_spectrum, _reusable(motions), slenderness_angles, periods, **options)
    return sensitivity(study, restitutions, baseline)


def fragility_sensitivity(
    body: Body,
    motions: Any,
    levels: Any,
    restitutions: Any,
    *,
    baseline: str | None = None,
    repetitions: int = 1000,
    seed: int = 0,
    **options: Any,
) -> Sensitivity:
    """Return the sensitivity of multiple-stripe fragility curves to the restitution model.

    Parameters
    ----------
    body, motions, levels
        As for `rocking.fragility`.
    restitutions, baseline, repetitions, seed
        As for `sensitivity`. 0 repetitions mean no intervals.
    **options
        ``im``, ``limit_states`` and the other options of `rocking.studies.fragility_analysis`.

    Returns
    -------
    Sensitivity
        Different verdicts, and for every state ratio of medians, difference of dispersions and distance of the curves.
    """
    from rocking.studies.histories import results_of

    threads, progress = options.pop("threads", None), options.pop("progress", None)
    im, limit_states = options.pop("im", "pga"), options.pop("limit_states", (0.5,))
    same_motions = _reusable(motions)

    def study(*, restitution: Any) -> Any:
        subject = Subject.of(body, same_motions, restitution, im, options)
        question = FragilityQuestion.of(subject, "stripes", levels, limit_states)
        return question.answer(results_of(sampled(question.histories), threads=threads, progress=progress))

    return sensitivity(study, restitutions, baseline, repetitions=repetitions, seed=seed)


def _reusable(motions: Any) -> Any:
    """Return motions for repeated iteration, because a generator would be empty after the first choice."""
    is_reusable = isinstance(motions, (GroundMotion, Pulse, MotionSet)) or not isinstance(motions, Iterable)
    return motions if is_reusable else list(motions)
