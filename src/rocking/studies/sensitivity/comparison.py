"""Results of one study with several choices of restitution, compared in numbers and words."""

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

_COUNTS = ("count", "only_second", "only_first", "compared", "unknown", "share", "share_low", "share_high")


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity:
    """Results of one study with several restitutions, compared.

    Parameters
    ----------
    results : dict of str to result
        Results by the name of the choice: datasets with an outcome, or analyses that have a `dataset`.
    baseline : str
        The choice that the others are compared with.
    repetitions : int
        Sets of motions that are drawn for the intervals of fragility curves.
    seed : int
        Seed of these draws.
    drawn : collection of str
        Names of the choices whose coefficients are drawn, so that other draws might flip other verdicts.

    Raises
    ------
    InvalidValueError
        If a result has no outcome, results are of different shapes, or there is no such choice.
    """

    results: dict[str, Any]
    baseline: str = field(kw_only=True)
    repetitions: int = field(default=1000, kw_only=True)
    seed: int = field(default=0, kw_only=True)
    drawn: Collection[str] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "baseline", checks.one_of("baseline", self.baseline, self.results))
        shapes = {label: dict(dataset["outcome"].sizes) for label, dataset in self.datasets.items()}
        odd = next((label for label, shape in shapes.items() if shape != shapes[self.baseline]), None)
        if odd is not None:
            raise InvalidValueError(
                "{parameter} must be of one shape, got {shape} with {choice}, {expected} with {baseline}",
                parameter="results", shape=shapes[odd], choice=odd, expected=shapes[self.baseline],
                baseline=self.baseline, hint="are they of the same study?",
            )  # fmt: skip

    def __repr__(self) -> str:
        """Which choices are compared; `verdict` says how they differ."""
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
        """What is counted: histories where there are motions to count over, otherwise cells of a map."""
        return "histories" if "motion" in self.datasets[self.baseline]["outcome"].dims else "cells"

    def flips_between(self, first: str, second: str) -> Flips:
        """Return how many verdicts differ between two choices.

        Parameters
        ----------
        first, second : str
            Names of choices.

        Returns
        -------
        Flips
            The counts; the interval takes motions for independent where there are several, otherwise the draws of
            the histories, and is missing (NaN) where nothing is drawn. A choice compared with itself is known to flip
            nothing.
        """
        first, second = (checks.one_of("choice", label, self.labels) for label in (first, second))
        a, b = (self.datasets[label]["outcome"] for label in (first, second))
        if first == second:
            return replace(flips_of(a.values, b.values), share_low=0.0, share_high=0.0)
        drawn = not {first, second}.isdisjoint(self.drawn)
        if "motion" not in a.dims:
            return flips_of(a.values, b.values, drawn=drawn)
        shape = [-1 if name == "motion" else 1 for name in a.dims]
        return flips_of(a.values, b.values, np.arange(a.sizes["motion"]).reshape(shape), drawn=drawn)

    def flips(self) -> "xr.Dataset":
        """Return how many verdicts differ between every two choices.

        Returns
        -------
        xarray.Dataset
            Over ``first, second``: count, only_second (overturned in the second only), only_first, compared, unknown,
            and the share with its 95 % interval, missing where there is no sample of motions or draws.
        """
        xarray = extra("xarray", "a table of flips")
        pairs = [self.flips_between(first, second) for first, second in product(self.labels, self.labels)]
        shape, both = (len(self.labels),) * 2, ("first", "second")
        data = {name: (both, np.array([getattr(p, name) for p in pairs]).reshape(shape)) for name in _COUNTS}
        table: xr.Dataset = xarray.Dataset(data, coords={name: list(self.labels) for name in both})
        clusters = max(pair.clusters for pair in pairs)
        independent = f"{clusters} motions" if clusters else self.cases if self.drawn else "nothing"
        return table.assign_attrs(cases=self.cases, independent=independent)

    def differences(self, name: str = "verdict") -> "xr.DataArray":
        """Return how a value moves from the baseline to every other choice.

        Parameters
        ----------
        name : str
            ``verdict`` (-1 overturned with the baseline only, 0 the same, 1 overturned with the choice only, 2 one of
            them failed), or a variable of the results such as ``peak_ratio``.

        Returns
        -------
        xarray.DataArray
            Over ``restitution`` and the dimensions of the study; values are missing where either did not stand.
        """
        xarray = extra("xarray", "a map of differences")
        base, others = self.datasets[self.baseline], self.labels[1:]
        maps = [difference_of(base, self.datasets[label], name) for label in others]
        labelled: xr.DataArray = xarray.concat(
            maps, xarray.DataArray(list(others), dims="restitution", name="restitution")
        )
        return labelled.assign_attrs(maps[0].attrs, baseline=self.baseline)

    def curve_change(self, choice: str, state: str = "overturned", *, baseline: str | None = None) -> CurveChange:
        """Return what changes of a fragility curve.

        Parameters
        ----------
        choice : str
            Name of the choice.
        state : str
            Name of the state.
        baseline : str, optional
            The choice to compare with; the baseline if not given.

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
        pair = [self.results[checks.one_of("choice", each, self.labels)] for each in both]
        if state not in self.states:
            known = ", ".join(self.states) or "none: it is no fragility analysis by stripes"
            raise InvalidValueError(
                "{parameter} must be one of the study's, {names}; got {value}", parameter="state", names=known,
                value=state,
            )  # fmt: skip
        first, second = (_curve(result.fits[state]) for result in pair)
        reached = [one.responses.exceed(next(s for s in one.limit_states if s.name == state)) for one in pair]
        return curve_change((first, second), pair[0].levels, *reached, repetitions=self.repetitions, seed=self.seed)

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states that have a fragility curve; none unless the study is of stripes."""
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
            except InvalidValueError as error:  # data without a curve are an answer, not a mistake of the user
                changes[label][state] = str(error)
        return changes

    def summary(self) -> list[dict[str, Any]]:
        """Return one row of plain values for every choice.

        Returns
        -------
        list of dict
            The choice, the share that overturns, flips against the baseline with the 95 % interval of their share, and
            for every state the change of its curve.
        """
        rows = []
        for label in self.labels:
            outcome = self.datasets[label]["outcome"].values
            good = int((outcome != Outcome.FAILED.code).sum())
            flips = self.flips_between(self.baseline, label)
            row = {"choice": label, "overturned": int((outcome == Outcome.OVERTURNED.code).sum()), "computed": good}
            row |= {"flips" if name == "count" else name: _known(getattr(flips, name)) for name in _COUNTS}
            for state, change in self._curve_changes.get(label, {}).items():
                row |= _plain(state, change) | {f"{state}: fit": self.results[label].fits[state].method}
            rows.append(row)
        return rows

    @property
    def verdict(self) -> str:
        """The comparison in words, a sentence for every choice but the baseline."""
        return self.told()

    def told(self, unit: tuple[str, float] | None = None) -> str:
        """Return the comparison in words, with intensities in another unit.

        Parameters
        ----------
        unit : tuple of str and float, optional
            Name, and size [unit of the intensity measure]; otherwise that of the measure.

        Returns
        -------
        str
            A sentence for every choice but the baseline.
        """
        return "\n".join(self._sentence(label, unit) for label in self.labels[1:])

    def _sentence(self, label: str, unit: tuple[str, float] | None) -> str:
        flips = self.flips_between(self.baseline, label)
        share = percent(flips.share)
        if _known(flips.share_low) is not None:
            share += f", 95 % interval {percent(flips.share_low)} to {percent(flips.share_high)}"
        words = [
            f"With {label} instead of {self.baseline}, the outcome differs in {flips.count:,} of {flips.compared:,} "
            f"{self.cases} ({share})"
        ]
        if flips.count:
            words.append(
                f"{flips.only_second:,} overturn only with {label}, {flips.only_first:,} only with {self.baseline}"
            )
        if flips.unknown:
            words.append(f"{flips.unknown:,} could not be computed")
        changes = self._curve_changes.get(label, {})
        unit = unit or ((self.results[label].subject.measure.unit, 1.0) if changes else ("-", 1.0))
        words += [
            f"{state}: {change if isinstance(change, str) else change.told(*unit)}" for state, change in changes.items()
        ]
        return "; ".join(words) + "."


def _dataset(label: str, result: Any) -> "xr.Dataset":
    data = getattr(result, "dataset", result)
    if not hasattr(data, "data_vars") or "outcome" not in data:
        raise InvalidValueError(
            "the study must return a dataset with an outcome, or an analysis with one, got {value} with {choice}",
            parameter="study", value=data, choice=label,
        )  # fmt: skip
    if data.sizes.get("restitution", 1) > 1:
        raise InvalidValueError("the study varies the restitution itself: give one of its axes to the study instead")
    squeezed: xr.Dataset = data.squeeze("restitution", drop=True) if "restitution" in data.dims else data
    return squeezed


def _known(value: float) -> float | None:
    return None if np.isnan(value) else value


def _curve(fit: Any) -> tuple[float, float]:
    """Return median and dispersion, or refuse with the fit's own words why there is no curve."""
    if fit.median is None or fit.dispersion is None:
        raise InvalidValueError("no curve to compare: {reason}", reason=fit.verdict.rstrip("."))
    return float(fit.median), float(fit.dispersion)


def _plain(state: str, change: CurveChange | str) -> dict[str, Any]:
    if isinstance(change, str):
        return {f"{state}: no comparison": change}
    plain: dict[str, Any] = {}
    for name, word in (("median", "median ratio"), ("dispersion", "dispersion"), ("distance", "largest distance")):
        changed = getattr(change, name)
        plain[f"{state}: {word}"] = changed.value
        plain |= {f"{state}: {word} {end}": v for end, v in zip(("low", "high"), changed.interval or (), strict=False)}
    return plain


def sensitivity(
    study: Callable[..., Any], restitutions: Any, baseline: str | None = None, *, repetitions: int = 1000, seed: int = 0
) -> Sensitivity:
    """Return the results of a study with several restitutions, compared.

    Everything else stays the same, motions and numbers of histories included: what differs is the restitution's.

    Parameters
    ----------
    study : callable
        Takes ``restitution=`` and returns a dataset with an outcome, or an analysis that has one;
        ``functools.partial`` makes one from `overturning_map`, `simulate_many` and their like.
    restitutions : list of choices, or dict of them by name
        At least two models, coefficients [-], pairs by side, or laws of impact.
    baseline : str, optional
        Name of the choice that the others are compared with; the first if not given.
    repetitions : int
        Sets of motions that are drawn for the intervals of fragility curves.
    seed : int
        Seed of these draws.

    Returns
    -------
    Sensitivity
        The comparison.

    Raises
    ------
    InvalidValueError
        If a choice is no restitution, or the results cannot be compared.

    Examples
    --------
    >>> from functools import partial
    >>> import rocking as rk
    >>> blocks = [rk.Block(width=0.5, height=h) for h in (1.0, 2.0, 3.0)]
    >>> study = partial(rk.simulate_many, blocks, rk.pulses.sine(4.0, 0.6), scale=[0.5, 1.0, 1.5])
    >>> found = sensitivity(study, ["housner", "ked"])
    >>> found.flips()["compared"].values.tolist()
    [[9, 9], [9, 9]]
    """
    if not callable(study):
        raise InvalidValueError(parameter="study", allowed="a function that takes restitution=", value=study)
    choices = named_restitutions(restitutions)
    first = next(iter(choices)) if baseline is None else checks.one_of("baseline", baseline, choices)
    results = {label: study(restitution=choice) for label, choice in choices.items()}
    return Sensitivity(results, baseline=first, repetitions=repetitions, seed=seed, drawn=drawn_in(choices))


def drawn_in(choices: Mapping[str, Any]) -> list[str]:
    """Return the names of the choices whose coefficients are drawn at every impact."""
    kind = RandomRestitution.kind
    return [label for label, choice in choices.items() if isinstance(choice, ImpactLaw) and choice.kind == kind]


def map_sensitivity(
    body: Body, motion: Motion, x: Any, y: Any, restitutions: Any, *, baseline: str | None = None, **options: Any
) -> Sensitivity:
    """Return how the restitution changes an overturning map.

    Parameters
    ----------
    body, motion, x, y
        As for `rocking.overturning_map`; neither axis is the restitution.
    restitutions, baseline
        As for `sensitivity`.
    **options
        Those of `rocking.overturning_map`.

    Returns
    -------
    Sensitivity
        Flips and differences, cell by cell.

    Raises
    ------
    InvalidValueError
        If an axis is the restitution, a choice is none, or a value is outside its range.

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
        raise InvalidValueError("restitution cannot be an axis where it is what is compared")
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
    """Return how the restitution changes rocking spectra.

    Parameters
    ----------
    motions, slenderness_angles, periods
        As for `rocking.rocking_spectrum`.
    restitutions, baseline
        As for `sensitivity`.
    **options
        Those of `rocking.rocking_spectrum`.

    Returns
    -------
    Sensitivity
        Flips and differences, block by block and motion by motion.
    """
    from rocking.studies._rocking_spectrum import rocking_spectrum

    study = partial(rocking_spectrum, _kept(motions), slenderness_angles, periods, **options)
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
    """Return how the restitution changes fragility by multiple stripes.

    Parameters
    ----------
    body, motions, levels
        As for `rocking.fragility`.
    restitutions, baseline, repetitions, seed
        As for `sensitivity`; no repetitions, no intervals.
    **options
        ``im``, ``limit_states`` and the other options of `rocking.studies.fragility_analysis`.

    Returns
    -------
    Sensitivity
        Flips, and for every state the ratio of medians, difference of dispersions and distance of the curves.
    """
    from rocking.studies.histories import results_of

    threads, progress = options.pop("threads", None), options.pop("progress", None)
    im, limit_states = options.pop("im", "pga"), options.pop("limit_states", (0.5,))
    same_motions = _kept(motions)

    def study(*, restitution: Any) -> Any:
        subject = Subject.of(body, same_motions, restitution, im, options)
        question = FragilityQuestion.of(subject, "stripes", levels, limit_states)
        return question.answer(results_of(sampled(question.histories), threads=threads, progress=progress))

    return sensitivity(study, restitutions, baseline, repetitions=repetitions, seed=seed)


def _kept(motions: Any) -> Any:
    """Return motions that can be gone through again and again: a generator would be empty after the first choice."""
    kept = isinstance(motions, (GroundMotion, Pulse, MotionSet)) or not isinstance(motions, Iterable)
    return motions if kept else list(motions)
