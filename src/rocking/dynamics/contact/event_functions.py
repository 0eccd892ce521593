"""What must stay above zero while a mode lasts, its sign a moment after the start, and when it first falls below.

A mode is consistent where the forces and gaps that complementarity asks for are above zero *for a while*: the first
coefficient of their series that is not zero decides. At the start only, that is the linear complementarity problem of
the contact accelerations; where these vanish, as at every uplift under a continuous motion, the next derivatives speak.
"""

import math
from enum import Enum
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.contact.base import BOTH, Mode, PlaneBase
from rocking.dynamics.contact.mode_series import ModeSeries, padded
from rocking.dynamics.taylor import first_fall

_DEPTH = 7
"""Coefficients that are asked for a sign."""


class Kind(Enum):
    """What ends a mode."""

    LANDING = "a foot lands"
    RELEASE = "a foot carries no more"
    SLIPPING = "friction is used up"
    STICKING = "sliding comes to a stop"
    LYING = "the body lies"


class Margin(NamedTuple):
    """A quantity that must not fall below zero."""

    kind: Kind  # what happens where it does
    series: FloatArray
    exact: int  # how many leading coefficients carry no rounding, so that their sign counts however small they are
    scale: float  # size that rounding of the others is measured by


def margins(base: PlaneBase, mode: Mode, course: ModeSeries, friction: float, weight: float) -> list[Margin]:
    """Return what must stay above zero in a mode.

    friction: Coulomb's coefficient [-]; weight: acceleration that forces are measured by, such as g + |a_x| + |a_z|
    [m/s2].
    """
    found = [Margin(Kind.RELEASE, normal, 0, weight) for normal in course.normals.values()]
    per_gap = weight * course.unit**2 / (1.0 if not mode.feet else base.size)
    found += [Margin(Kind.LANDING, gap, 2, per_gap) for gap in course.gaps.values()]
    if mode.slip and course.sliding is not None:
        found.append(Margin(Kind.STICKING, mode.slip * course.sliding, 1, weight * course.unit))
    elif mode.feet:
        most = np.asarray(friction * sum(course.normals.values()))
        scale = weight * (1.0 + friction)
        found.append(Margin(Kind.SLIPPING, most - course.tangential, 0, scale))  # Eq. 69
        found.append(Margin(Kind.SLIPPING, most + course.tangential, 0, scale))  # Eq. 69
    if mode.feet != BOTH:
        quarter = padded([0.5 * math.pi], course.rotation.size)
        found.append(Margin(Kind.LYING, quarter - course.rotation, 2, math.inf))
        found.append(Margin(Kind.LYING, quarter + course.rotation, 2, math.inf))
    return found


def leading(margin: Margin, stretch: float, tolerance: float) -> int:
    """Return which coefficient decides the sign of a margin a moment after the start.

    stretch: duration of the course over the natural time of the body, so that all coefficients are measured alike [-];
    tolerance: below it, over the scale, a coefficient counts as zero [-]. Returns its number; -1 where all of them
    vanish.
    """
    bound = tolerance * margin.scale
    for k, c in enumerate(margin.series[:_DEPTH].tolist()):
        size = abs(c) if k < margin.exact else abs(c) - bound * stretch ** (k - margin.exact)
        if size > 0.0:
            return k
    return -1


def consistent(found: list[Margin], stretch: float, tolerance: float) -> bool:
    """Return whether all margins are above zero, or zero, for a while.

    stretch: duration of the course over the natural time of the body [-]; tolerance: below it a coefficient counts as
    zero [-].
    """
    decisive = ((m, leading(m, stretch, tolerance)) for m in found)
    return all(k < 0 or m.series[k] > 0.0 for m, k in decisive)


def first_end(found: list[Margin], stretch: float, tolerance: float) -> tuple[float, Kind] | None:
    """Return when the first margin falls below zero.

    stretch: duration of the course over the natural time of the body [-]; tolerance: below it a coefficient counts as
    zero [-]. Returns kind: what happens; None instead of both where nothing does.
    """
    first: tuple[float, Kind] | None = None
    for margin in found:
        k = leading(margin, stretch, tolerance)
        if k < 0:
            continue
        at = first_fall(_trimmed(margin.series[k:]))
        if at is not None and (first is None or at < first[0]):
            first = at, margin.kind
    return first


def _trimmed(series: FloatArray) -> list[float]:
    kept = np.flatnonzero(series)
    return series[: kept[-1] + 1].tolist() if kept.size else [0.0]


def stirring(base: PlaneBase, push: FloatArray, lift: FloatArray, friction: float) -> np.ndarray:
    """Return the stretches in which a body at rest might be lifted or moved.

    push, lift: coefficients of a_x and g + a_z [m/s2]; friction: Coulomb's coefficient [-]. Returns numbers of the
    stretches; in all others every margin stays above zero.
    """
    turn = push * base.height
    # Eq. 69
    held = [lift * base.right + turn, lift * base.left - turn, friction * lift - push, friction * lift + push]
    low = [m[:, 0] + np.minimum(m[:, 1:], 0.0).sum(axis=1) for m in held]
    return np.flatnonzero(np.min(low, axis=0) <= 0.0)
