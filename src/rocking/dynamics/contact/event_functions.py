"""Which mode follows: complementarity of contact forces and motions; what must stay above zero while a mode lasts.

The first coefficient of a series that is not zero decides whether it is above zero for a while: at an uplift under a
continuous motion accelerations vanish, and the next derivatives speak.
"""

import math
from enum import Enum
from itertools import chain, combinations
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.contact.base import BOTH, ContactState, Mode, PlaneBase, along, away
from rocking.dynamics.contact.mode_series import GroundSeries, ModeSeries, mode_series, padded
from rocking.dynamics.taylor import first_fall
from rocking.outcome import Status

_DEPTH = 7  # coefficients that are asked for a sign


class ModeEnd(Enum):
    """What ends a mode."""

    LANDING = "a foot lands"
    LOSS_OF_CONTACT = "a foot carries no more"
    SLIPPING = "friction is used up"
    STICKING = "sliding comes to a stop"
    LYING = "the body lies"


class EventFunction(NamedTuple):
    """A quantity that must not fall below zero."""

    kind: ModeEnd  # what happens where it does
    series: FloatArray
    exact: int  # how many leading coefficients carry no rounding, so that their sign counts however small they are
    scale: float  # size that rounding of the others is measured by


def event_functions(
    base: PlaneBase, mode: Mode, series: ModeSeries, friction: float, weight: float
) -> list[EventFunction]:
    """Return what must stay above zero in a mode."""
    # weight: what forces are measured by, such as g + |a_x| + |a_z| [m/s2]
    found = [EventFunction(ModeEnd.LOSS_OF_CONTACT, normal, 0, weight) for normal in series.normals.values()]
    per_gap = weight * series.unit**2 / (1.0 if not mode.feet else base.size)
    found += [EventFunction(ModeEnd.LANDING, gap, 2, per_gap) for gap in series.gaps.values()]
    if mode.slip and series.sliding is not None:
        found.append(EventFunction(ModeEnd.STICKING, mode.slip * series.sliding, 1, weight * series.unit))
    elif mode.feet:
        most = np.asarray(friction * sum(series.normals.values()))
        scale = weight * (1.0 + friction)
        found.append(EventFunction(ModeEnd.SLIPPING, most - series.tangential, 0, scale))  # Eq. 69
        found.append(EventFunction(ModeEnd.SLIPPING, most + series.tangential, 0, scale))  # Eq. 69
    if mode.feet != BOTH:
        quarter = padded([0.5 * math.pi], series.rotation.size)
        found.append(EventFunction(ModeEnd.LYING, quarter - series.rotation, 2, math.inf))
        found.append(EventFunction(ModeEnd.LYING, quarter + series.rotation, 2, math.inf))
    return found


def leading(function: EventFunction, stretch: float, tolerance: float) -> int:
    """Return which coefficient decides the sign of a function a moment after the start."""
    # stretch: duration of the series over the natural time of the body, so that all coefficients are measured alike
    # [-]; tolerance: below it, over the scale, a coefficient counts as zero [-]. Returns its number; -1 where all of
    # them vanish.
    bound = tolerance * function.scale
    for k, c in enumerate(function.series[:_DEPTH].tolist()):
        size = abs(c) if k < function.exact else abs(c) - bound * stretch ** (k - function.exact)
        if size > 0.0:
            return k
    return -1


def consistent(found: list[EventFunction], stretch: float, tolerance: float) -> bool:
    """Return whether all event functions are above zero, or zero, for a while."""
    # stretch and tolerance as of `leading`
    decisive = ((m, leading(m, stretch, tolerance)) for m in found)
    return all(k < 0 or m.series[k] > 0.0 for m, k in decisive)


def first_end(found: list[EventFunction], stretch: float, tolerance: float) -> tuple[float, ModeEnd] | None:
    """Return when the first function falls below zero, and what then happens; None where nothing does."""
    first: tuple[float, ModeEnd] | None = None
    for function in found:
        k = leading(function, stretch, tolerance)
        if k < 0:
            continue
        rest = function.series[k:]
        at = first_fall(rest[: np.flatnonzero(rest)[-1] + 1].tolist())
        if at is not None and (first is None or at < first[0]):
            first = at, function.kind
    return first


def excited_stretches(base: PlaneBase, push: FloatArray, lift: FloatArray, friction: float) -> np.ndarray:
    """Return stretches that might lift or move a body at rest; push, lift: coefficients of a_x and g + a_z [m/s2]."""
    turn = push * base.height
    # Eq. 69
    held = [lift * base.right + turn, lift * base.left - turn, friction * lift - push, friction * lift + push]
    low = [m[:, 0] + np.minimum(m[:, 1:], 0.0).sum(axis=1) for m in held]
    return np.flatnonzero(np.min(low, axis=0) <= 0.0)


TOLERANCE = 1e-12
_LADDER = (TOLERANCE, 1e-10, 1e-8)
_ORDER = 8


def candidates(base: PlaneBase, state: ContactState) -> list[Mode]:
    """Return the modes that the velocities allow: most feet first, those that stick before those that slide."""
    resting = [foot for foot in state.touching if away(base, state, foot) == 0.0]
    subsets = chain.from_iterable(combinations(resting, n) for n in range(len(resting), 0, -1))
    found = []
    for feet in subsets:
        speed = along(base, state, feet[0])
        if speed == 0.0:
            found.append(Mode(feet))
        found += [Mode(feet, slip) for slip in (1, -1) if slip * speed >= 0.0]
    return [*found, Mode(())]


class NextMode(NamedTuple):
    """The mode that follows."""

    mode: Mode
    tolerance: float  # below it, over their scale, coefficients counted as zero [-]


def choose(base: PlaneBase, state: ContactState, ground: GroundSeries, friction: float) -> NextMode | Status:
    """Return the mode that follows a state, a status if there is none."""
    # of several the first: contacts last, and stick, where they can
    weight = weight_of(ground)
    tried = [(mode, mode_series(base, state, mode, ground, friction, _ORDER)) for mode in candidates(base, state)]
    possible = [(m, event_functions(base, m, c, friction, weight)) for m, c in tried if c.stiff > 0.0]
    for tolerance in _LADDER:
        good = next((mode for mode, found in possible if consistent(found, 1.0, tolerance)), None)  # Eq. 20
        if good is not None:
            return NextMode(good, tolerance)
    return Status.NO_CONTACT_FORCE


def weight_of(ground: GroundSeries) -> float:
    """Return the acceleration that contact forces are measured by; |g + a_z| + |a_x|, and at least a little [m/s2]."""
    return max(abs(ground.lift[0]) + abs(ground.push[0]), 1e-3)
