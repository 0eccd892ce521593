"""Sensitivity to the restitution: the same study with several choices of it, in one call."""

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

from rocking.bodies import Body
from rocking.dynamics.impact_laws import ImpactLaw, RandomRestitution
from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.studies._axes import axis_of
from rocking.studies.body_axes import RestitutionAxis
from rocking.studies.motion_set import MotionSet
from rocking.studies.sensitivity.choices import named_choices
from rocking.studies.sensitivity.comparison import Sensitivity
from rocking.studies.sensitivity.sampled import sampled

_RANDOM = RandomRestitution.kind


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
        raise InvalidValueError(f"study must be a function that takes restitution=, got {study!r:.60}")
    choices = named_choices(restitutions)
    first = next(iter(choices)) if baseline is None else baseline
    if first not in choices:
        raise InvalidValueError(f"baseline must be one of {', '.join(choices)}, got {baseline!r:.60}")
    results = {label: study(restitution=choice) for label, choice in choices.items()}
    drawn = [label for label, choice in choices.items() if isinstance(choice, ImpactLaw) and choice.kind == _RANDOM]
    return Sensitivity(results, baseline=first, repetitions=repetitions, seed=seed, drawn=drawn)


def map_sensitivity(
    body: Body, motion: Motion, x: Any, y: Any, restitutions: Any, *, baseline: str | None = None, **options: Any
) -> Sensitivity:
    """Return how the restitution changes an overturning map.

    Parameters
    ----------
    body : Body
        The body.
    motion : GroundMotion or Pulse
        The motion.
    x, y : Axis or (str, array_like)
        Axes of the map, none of them the restitution.
    restitutions : list of choices, or dict of them by name
        At least two models, coefficients [-], pairs by side, or laws of impact.
    baseline : str, optional
        Name of the choice that the others are compared with; the first if not given.
    **options
        Those of `overturning_map`.

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
    >>> found = map_sensitivity(block, pulse, *axes, ["ked", "0.999999999*ked"])
    >>> bool(found.differences("verdict").any())
    False
    """
    from rocking.studies._overturning_map import overturning_map

    along = axis_of(x), axis_of(y)
    if any(isinstance(axis, RestitutionAxis) for axis in along):
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
    motions : GroundMotion or Pulse, or a sequence of them
        The motions, the same for all choices.
    slenderness_angles : array_like
        alpha [rad].
    periods : array_like
        2 pi / p [s].
    restitutions : list of choices, or dict of them by name
        At least two models, coefficients [-], pairs by side, or laws of impact.
    baseline : str, optional
        Name of the choice that the others are compared with; the first if not given.
    **options
        Those of `rocking_spectrum`.

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
    body : Body
        The body.
    motions : GroundMotion or Pulse, a sequence of them, or MotionSet
        The motions, the same for all choices.
    levels : array_like
        Levels of the intensity measure [its unit].
    restitutions : list of choices, or dict of them by name
        At least two models, coefficients [-], pairs by side, or laws of impact.
    baseline : str, optional
        Name of the choice that the others are compared with; the first if not given.
    repetitions : int
        Sets of motions that are drawn for the intervals of what changes of the curves; 0 for no intervals.
    seed : int
        Seed of these draws.
    **options
        Those of `multiple_stripes`.

    Returns
    -------
    Sensitivity
        Flips, and for every state the ratio of medians, difference of dispersions and distance of the curves.
    """
    from rocking.studies.fragility.multiple_stripe_analysis import stripes_plan
    from rocking.studies.fragility.subject import results_of

    threads, progress = options.pop("threads", None), options.pop("progress", None)
    given = _kept(motions)

    def study(*, restitution: Any) -> Any:
        histories, finish = stripes_plan(body, given, levels, restitution, **options)
        return finish(results_of(sampled(histories), threads=threads, progress=progress))

    return sensitivity(study, restitutions, baseline, repetitions=repetitions, seed=seed)


def _kept(motions: Any) -> Any:
    """Return motions that can be gone through again and again: a generator would be empty after the first choice."""
    kept = isinstance(motions, (GroundMotion, Pulse, MotionSet)) or not isinstance(motions, Iterable)
    return motions if kept else list(motions)
