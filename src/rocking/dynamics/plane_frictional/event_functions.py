"""Choice of the next mode by complementarity of contact forces and motions, and functions whose zeros end a mode.

The sign of a series just after its start is the sign of its first nonzero coefficient. If the
ground acceleration is continuous at an uplift, the relative acceleration is zero there, and a higher derivative counts.
"""

import math
from enum import Enum
from itertools import chain, combinations
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.plane_frictional.base import BOTH, ContactState, Mode, PlaneBase, along, away
from rocking.dynamics.plane_frictional.mode_series import GroundSeries, ModeSeries, mode_series, padded
from rocking.dynamics.taylor import first_fall
from rocking.outcome import Status

_DEPTH = 7  # number of coefficients that are used for the sign


class ModeEnd(Enum):
    """Events that end a mode."""

    LANDING = "a foot lands"
    LOSS_OF_CONTACT = "a foot loses contact"
    SLIPPING = "the friction limit is reached"
    STICKING = "sliding stops"
    LYING = "the body lies"


class EventFunction(NamedTuple):
    """A quantity that is not negative during a mode."""

    kind: ModeEnd  # event at which the quantity becomes negative
    series: FloatArray
    exact: int  # number of leading coefficients without rounding errors; their sign always counts
    scale: float  # scale of the rounding errors of the other coefficients


def event_functions(
    base: PlaneBase, mode: Mode, series: ModeSeries, friction: float, weight: float
) -> list[EventFunction]:
    """Return the functions that are not negative during a mode."""
    # weight: scale of the forces per mass, such as g + |a_x| + |a_z| [m/s2]
    functions = [EventFunction(ModeEnd.LOSS_OF_CONTACT, normal, 0, weight) for normal in series.normals.values()]
    per_gap = weight * series.unit**2 / (1.0 if not mode.feet else base.size)
    functions += [EventFunction(ModeEnd.LANDING, gap, 2, per_gap) for gap in series.gaps.values()]
    if mode.slip and series.sliding is not None:
        functions.append(EventFunction(ModeEnd.STICKING, mode.slip * series.sliding, 1, weight * series.unit))
    elif mode.feet:
        capacity = np.asarray(friction * sum(series.normals.values()))
        scale = weight * (1.0 + friction)
        functions.append(EventFunction(ModeEnd.SLIPPING, capacity - series.tangential, 0, scale))  # Eq. 69
        functions.append(EventFunction(ModeEnd.SLIPPING, capacity + series.tangential, 0, scale))  # Eq. 69
    if mode.feet != BOTH:
        quarter = padded([0.5 * math.pi], series.rotation.size)
        functions.append(EventFunction(ModeEnd.LYING, quarter - series.rotation, 2, math.inf))
        functions.append(EventFunction(ModeEnd.LYING, quarter + series.rotation, 2, math.inf))
    return functions


def leading(function: EventFunction, stretch: float, tolerance: float) -> int:
    """Return the index of the coefficient that determines the sign just after the start; -1 if all vanish."""
    # stretch: duration of the series over the natural time of the body, a common scale of all coefficients [-]
    # tolerance: coefficients below tolerance times scale count as zero [-]
    bound = tolerance * function.scale
    for k, c in enumerate(function.series[:_DEPTH].tolist()):
        size = abs(c) if k < function.exact else abs(c) - bound * stretch ** (k - function.exact)
        if size > 0.0:
            return k
    return -1


def consistent(functions: list[EventFunction], stretch: float, tolerance: float) -> bool:
    """Return True if no event function becomes negative just after the start."""
    # stretch and tolerance as in `leading`
    decisive = ((function, leading(function, stretch, tolerance)) for function in functions)
    return all(k < 0 or function.series[k] > 0.0 for function, k in decisive)


def first_end(functions: list[EventFunction], stretch: float, tolerance: float) -> tuple[float, ModeEnd] | None:
    """Return the first zero crossing, in units of the series, and its event; None if there is none."""
    earliest: tuple[float, ModeEnd] | None = None
    for function in functions:
        k = leading(function, stretch, tolerance)
        if k < 0:
            continue
        tail = function.series[k:]
        x = first_fall(tail[: np.flatnonzero(tail)[-1] + 1].tolist())
        if x is not None and (earliest is None or x < earliest[0]):
            earliest = x, function.kind
    return earliest


def excited_stretches(base: PlaneBase, push: FloatArray, lift: FloatArray, friction: float) -> np.ndarray:
    """Return segments that may move a body at rest. `push` and `lift` are coefficients of a_x and g + a_z [m/s2]."""
    turn = push * base.height
    # Eq. 69
    margins = [lift * base.right + turn, lift * base.left - turn, friction * lift - push, friction * lift + push]
    lower_bounds = [margin[:, 0] + np.minimum(margin[:, 1:], 0.0).sum(axis=1) for margin in margins]
    return np.flatnonzero(np.min(lower_bounds, axis=0) <= 0.0)


TOLERANCE = 1e-12
_LADDER = (TOLERANCE, 1e-10, 1e-8)
_ORDER = 8


def candidates(base: PlaneBase, state: ContactState) -> list[Mode]:
    """Return the modes that are compatible with the velocities: more feet first, sticking before sliding."""
    resting = [foot for foot in state.touching if away(base, state, foot) == 0.0]
    subsets = chain.from_iterable(combinations(resting, n) for n in range(len(resting), 0, -1))
    modes = []
    for feet in subsets:
        speed = along(base, state, feet[0])
        if speed == 0.0:
            modes.append(Mode(feet))
        modes += [Mode(feet, slip) for slip in (1, -1) if slip * speed >= 0.0]
    return [*modes, Mode(())]


class NextMode(NamedTuple):
    """The mode that follows."""

    mode: Mode
    tolerance: float  # coefficients below tolerance times scale counted as zero [-]


def choose(base: PlaneBase, state: ContactState, ground: GroundSeries, friction: float) -> NextMode | Status:
    """Return the next mode after a state, or a status if there is none."""
    # the first consistent mode is chosen, so that contacts persist and stick if possible
    weight = weight_of(ground)
    series_by_mode = [
        (mode, mode_series(base, state, mode, ground, friction, _ORDER)) for mode in candidates(base, state)
    ]
    possible = [(m, event_functions(base, m, c, friction, weight)) for m, c in series_by_mode if c.stiff > 0.0]
    for tolerance in _LADDER:
        consistent_mode = next(
            (mode for mode, functions in possible if consistent(functions, 1.0, tolerance)), None
        )  # Eq. 20
        if consistent_mode is not None:
            return NextMode(consistent_mode, tolerance)
    return Status.NO_CONTACT_FORCE


def weight_of(ground: GroundSeries) -> float:
    """Return the scale of contact forces per unit of mass, |g + a_z| + |a_x|, at least 1e-3 [m/s2]."""
    return max(abs(ground.lift[0]) + abs(ground.push[0]), 1e-3)
