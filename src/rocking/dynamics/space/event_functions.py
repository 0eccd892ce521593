"""What may end a step, as polynomials: gaps that close, and a round base that begins to roll or lies flat."""

import math
from dataclasses import dataclass
from operator import mul

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.contact_mode import ContactSet
from rocking.dynamics.taylor import first_fall
from rocking.outcome import ContactMode
from rocking.portable import applied, convolved, norm

NOTHING = 1e-13  # coefficients below this share of the largest one are rounding


def first_zero(series: FloatArray, *, started: bool, floor: float = 0.0) -> float | None:
    """Return where a series first falls below zero; from 0 to 1; None if it does not fall."""
    terms = series.tolist()
    if started:
        small = NOTHING * max(map(abs, terms))
        first = next((k for k, c in enumerate(terms) if k and abs(c) > (max(floor, small) if k < 3 else small)), None)
        if first is None:
            return None
        terms = terms[first:]
    elif terms[0] == 0.0 and len(terms) > 1:
        terms = terms[1:]
    if not all(map(math.isfinite, terms)):
        return None
    if terms[0] < 0.0:
        return 0.0
    terms[0] = terms[0] or 5e-324
    return first_fall(terms)


def cauchy(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the product of two series, up to the order of the first."""
    return convolved(left, right[: len(left)])[: len(left)]


def dot(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the scalar product of two series of vectors."""
    return np.asarray(sum(cauchy(left[:, i], right[:, i]) for i in range(left.shape[1])))


def square_root(square: FloatArray) -> FloatArray:
    """Return the square root of a series that starts above zero."""
    root = [math.sqrt(square[0])]
    for k, term in enumerate(square.tolist()[1:], 1):
        root.append((term - sum(map(mul, root[1:k], root[k - 1 : 0 : -1]))) / (2.0 * root[0]))
    return np.array(root)


def padded(series: FloatArray, count: int) -> FloatArray:
    """Return a series of another length."""
    return np.pad(series, (0, max(0, count - len(series))))[:count]


SLOW_OPENING = 1e-9  # accelerations of a gap below this share of gravity count as none, as in the choice of what stays
START_ROLLING, STOP_ROLLING = 1e-11, 1e-13  # sines of the tilt at which a round base rolls, and at which it lies flat
NEARLY_FLAT = 0.01
"""Share of the slenderness angle below which a round base that would lose contact is held down; see `nearly_flat`."""


@dataclass(frozen=True, eq=False)
class Step:
    """The series of a step, over a unit of time that is the step."""

    length: float  # duration [s]
    velocities: FloatArray  # angular velocity in body axes [rad/s]; shape (order + 1, 3)
    up: FloatArray  # vertical in body axes [-]; shape (order + 1, 3)
    # gravity less the acceleration of the ground, in axes of the ground [m/s2]; shape (3, degree + 1)
    field: FloatArray
    heading: FloatArray  # where the edge of the contact points on the ground; zero without an edge [-]; shape (3,)


def watched(body: SpatialBody, contact: ContactSet) -> tuple[int, ...]:
    """Return the vertices whose gaps may close first: both neighbours of a vertex, or the one farthest from an edge."""
    count = len(body.vertices)
    if contact.mode is ContactMode.VERTEX and contact.points:
        return ((contact.points[0] - 1) % count, (contact.points[0] + 1) % count)
    if contact.mode is ContactMode.EDGE:
        distance = applied(body.vertices[:, :2] - contact.pivot[:2], body.inward[contact.points[0]])
        return (int(np.argmax(distance)),)
    return ()


def first_contact(
    body: SpatialBody, contact: ContactSet, step: Step, touching: tuple[int, ...]
) -> tuple[float, int] | None:
    """Return when a gap first closes, and of which vertex; None if none does."""
    found: list[tuple[float, int]] = []
    floor = 0.5 * SLOW_OPENING * norm(step.field[:, 0]) * step.length**2
    for number in watched(body, contact):
        gap = applied(step.up, body.vertices[number] - contact.pivot)
        closes = first_zero(gap, started=number in touching, floor=floor)
        if closes is not None:
            found.append((closes, number))
    return min(found) if found else None


def nearly_flat(body: SpatialBody, up: FloatArray) -> bool:
    """Return whether a round base leans so little that a loss of contact is a hop below its own gap.

    A spin about its own axis can draw the rim of a body without slip down while it passes by lying flat, as 1 / sin^2
    of the tilt: faster than gravity, for milliseconds. In truth the rim slips or hops by less than the gap under the
    base; here it is held down, without work, and the history says for how long.

    up: vertical in body axes [-]. Returns below 1 % of the slenderness angle.

    >>> bottle = SpatialBody.cylinder(0.5, 2.0)
    >>> [nearly_flat(bottle, np.array([sine, 0.0, 1.0])) for sine in (1e-3, 1e-2)]
    [True, False]
    """
    return body.round and bool(math.hypot(up[0], up[1]) * float(body.centre[2]) < NEARLY_FLAT * body.radius)


def rim_events(body: SpatialBody, contact: ContactSet, step: Step) -> float | None:
    """Return when a round base begins to roll, or lies flat."""
    if contact.mode is ContactMode.ROLLING:
        first = step.up[0, :2]
        sine = applied(step.up[:, :2], first) / norm(first)
        sine[0] -= STOP_ROLLING
        return first_zero(sine, started=False)
    lean = applied(step.up[:, :2], contact.pivot[:2]) / -body.radius  # sine of the tilt away from the point
    flat, steep = lean.copy(), -lean
    steep[0] += START_ROLLING
    # lifted from rest it leans with the cube of time: what rounding leaves of lower powers decides nothing
    floor = 0.25 * SLOW_OPENING * norm(step.field[:, 0]) * step.length**2 / body.radius
    found = [first_zero(flat, started=abs(lean[0]) < NOTHING, floor=floor), first_zero(steep, started=False)]
    return min((at for at in found if at is not None), default=None)
