"""Contact set after an impact or under forces, by complementarity over the few contact sets of a convex base."""

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from rocking.bodies.solid import Corner, Edge
from rocking.conventions import FloatArray
from rocking.dynamics.rolling.attitude import cross
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.impact_laws import PLASTIC, SpatialImpactLaw
from rocking.outcome import ContactMode
from rocking.portable import applied, dot, norm, solution
from rocking.restitution.space import SpatialImpact

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class ContactSet:
    """Points in contact with the ground."""

    mode: ContactMode  # mode of the contact
    points: tuple[int, ...]  # indices of the vertices in contact; empty for round bases
    pivot: FloatArray  # point in contact, in body axes [m]; shape (3,)
    axis: FloatArray | None = None  # unit vector along an edge in contact, in body axes [-]; shape (3,)
    length: float = 0.0  # length of the edge [m]


def face(body: SpatialBody) -> ContactSet:
    """Return the contact on the full base."""
    pivot = np.zeros(3) if body.round else body.vertices[0]
    return ContactSet(ContactMode.REST, tuple(range(len(body.vertices))), pivot)


def edge(body: SpatialBody, index: int) -> ContactSet:
    """Return the contact on an edge."""
    next_index = (index + 1) % len(body.vertices)
    length = norm(body.vertices[next_index] - body.vertices[index])
    return ContactSet(ContactMode.EDGE, (index, next_index), body.vertices[index], body.edges[index], length)


def vertex(body: SpatialBody, index: int) -> ContactSet:
    """Return the contact on a vertex."""
    return ContactSet(ContactMode.VERTEX, (index,), body.vertices[index])


def rim(body: SpatialBody, direction: FloatArray) -> ContactSet:
    """Return the contact on a point of a round base, for rotation about this point at the start of rolling."""
    unit = direction / norm(direction)
    return ContactSet(ContactMode.VERTEX, (), np.array([*(body.radius * unit), 0.0]))


def rolling(contact: ContactSet) -> ContactSet:
    """Return the rolling contact that starts at the point of a contact."""
    return replace(contact, mode=ContactMode.ROLLING)


def supports(
    body: SpatialBody, contact: ContactSet, force: FloatArray, moment: FloatArray, up: FloatArray
) -> FloatArray:
    """Return the contact forces. All values are >= 0 if no force is tensile."""
    # Without slip, horizontal forces have no limit, so that only vertical forces matter. With M the moment about the
    # pivot and Z upwards, Z x M = sum N_i r_i over the points of contact. An edge has the two forces at its ends, and a
    # face has the moments of the vertical forces about its edges, divided by the size of the body.
    # force, moment: force of the ground and its moment about the pivot, in body axes [N], [N m], or impulses
    # up: vertical in body axes [-]
    # Returns the vertical force at a vertex, the forces at both ends of an edge, or for a face N times the distance of
    # the centre of pressure from every edge, divided by the size of the body [N].
    normal = dot(force, up)
    if contact.axis is not None:
        second = dot(cross(up, moment), contact.axis) / contact.length  # Eq. 92
        return np.array([normal - second, second])
    if contact.mode is not ContactMode.REST:
        return np.array([normal])
    pressure = cross(up, moment)[:2] + normal * contact.pivot[:2]  # Eq. 93
    if body.round:
        return np.array([normal * body.radius - norm(pressure)]) / body.size
    inside = ((pressure - normal * body.vertices[:, :2]) * body.inward).sum(axis=1)
    return np.append(inside / body.size, normal)


def touching_point(body: SpatialBody, contact: ContactSet, up: FloatArray) -> FloatArray:
    """Return the point in contact in body axes [m]: the pivot, or the lowest point of a rolling rim."""
    if contact.mode is not ContactMode.ROLLING:
        return contact.pivot
    level = up[:2] / norm(up[:2])
    return np.array([-body.radius * level[0], -body.radius * level[1], 0.0])


def rise(body: SpatialBody, pivot: FloatArray, up: FloatArray) -> float:
    """Return the rise of the centre of mass above its position at rest [m].

    `pivot` is a point on the ground, in body axes [m].
    """
    arm = body.centre - pivot
    level2 = float(up[0] ** 2 + up[1] ** 2)
    # 1 - cos(tilt), computed without cancellation
    sunk = level2 / (1.0 + up[2]) if up[2] > 0.0 else 1.0 - float(up[2])
    return float(dot(up[:2], arm[:2]) - sunk * arm[2])  # Eq. 86


_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class SpatialState:
    """State of a body at an instant, in body axes."""

    pivot: FloatArray  # a point at rest on the ground [m]; shape (3,)
    velocity: FloatArray  # angular velocity [rad/s]; shape (3,)
    up: FloatArray  # vertical [-]; shape (3,)
    field: FloatArray  # gravity minus the acceleration of the ground [m/s2]; shape (3,)
    # for a body on an edge, the vector from the pivot to the other end of the edge [m]; zero on a vertex; shape (3,)
    along: FloatArray = dataclasses.field(default_factory=lambda: np.zeros(3))

    def impact(self, body: SpatialBody, contact: ContactSet) -> SpatialImpact:
        """Return the impact on a contact. The step of the impact starts at the nearest point at rest."""
        onto = Corner(contact.pivot) if contact.axis is None else Edge(contact.pivot, contact.axis)
        length, pivot = float((self.along * self.along).sum()), self.pivot
        if length > 0.0:
            middle = contact.pivot if contact.axis is None else contact.pivot + 0.5 * contact.length * contact.axis
            fraction = float(((middle - pivot) * self.along).sum()) / length
            pivot = pivot + min(max(fraction, 0.0), 1.0) * self.along
        return SpatialImpact(body.moments, self.velocity, pivot, onto, self.up, body.matter, body.footprint)

    def plastic(self, body: SpatialBody, contact: ContactSet) -> FloatArray:
        """Return the angular velocity after the plastic impact without slip on a contact [rad/s]."""
        if contact.mode is ContactMode.REST:
            return np.zeros(3)
        onto = Corner(contact.pivot) if contact.axis is None else Edge(contact.pivot, contact.axis)
        return PLASTIC.turned(SpatialImpact(body.moments, self.velocity, self.pivot, onto))


@dataclass(frozen=True, eq=False)
class Continuation:
    """Contact and velocity after an impact, or after a choice by forces."""

    contact: ContactSet
    velocity: FloatArray  # angular velocity, in body axes [rad/s]; shape (3,)
    supports: FloatArray  # impulses [N s] or forces [N] of the ground, in the form of `supports`


def candidates(body: SpatialBody, touching: tuple[int, ...]) -> Iterator[ContactSet]:
    """Yield the possible contact sets, larger ones first."""
    count = len(body.vertices)
    if len(touching) == count:
        yield face(body)
    for index in touching:
        if (index + 1) % count in touching:
            yield edge(body, index)
    for index in touching:
        yield vertex(body, index)


def of_impact(
    body: SpatialBody, state: SpatialState, touching: tuple[int, ...], law: SpatialImpactLaw
) -> list[Continuation]:
    """Return the consistent contact sets after an impact, the largest first."""
    continuations = []
    scale = float(np.abs(state.velocity).max()) * body.size
    for contact in candidates(body, touching):
        velocity = state.plastic(body, contact)
        push = impulses(body, state, contact, velocity)
        if push.min() < -_ROUNDING * body.mass * scale:
            continue
        if contact.mode is not ContactMode.REST:
            velocity = law.velocity_after(body, state.impact(body, contact))
        others = [i for i in touching if i not in contact.points]
        opening = applied(cross(velocity, body.vertices[others] - contact.pivot), state.up)
        if not others or opening.min() >= -_ROUNDING * scale:
            continuations.append(Continuation(contact, velocity, push))
    return continuations


def of_forces(
    body: SpatialBody, state: SpatialState, touching: tuple[int, ...], preferred: ContactSet | None = None
) -> list[Continuation]:
    """Return the contact sets whose forces are not tensile, a preferred contact set first."""
    continuations: list[Continuation] = []
    scale, contacts = norm(state.field), list(candidates(body, touching))
    if preferred is not None:
        contacts = [preferred, *(contact for contact in contacts if contact.points != preferred.points)]
    for contact in contacts:
        velocity = state.plastic(body, contact)
        rate, push = forces(body, contact, velocity, state.up, state.field)
        if push.min() < -_ROUNDING * body.mass * scale:
            continue
        arms = body.vertices - contact.pivot
        opening = applied(cross(rate, arms) + cross(velocity, cross(velocity, arms)), state.up)
        others = [i for i in touching if i not in contact.points]
        if not others or opening[others].min() >= -_ROUNDING * scale:
            continuations.append(Continuation(contact, velocity, push))
    return continuations


def impulses(body: SpatialBody, state: SpatialState, contact: ContactSet, velocity: FloatArray) -> FloatArray:
    """Return the impulses of the ground in an impact, in the form of `supports` [N s]."""
    # velocity: angular velocity after the impact, in body axes
    new = body.centre - contact.pivot
    push = body.mass * (cross(velocity, new) - cross(state.velocity, body.centre - state.pivot))  # Eq. 90
    moment = applied(body.inertia, velocity - state.velocity) + cross(new, push)  # Eq. 90
    return supports(body, contact, push, moment, state.up)


def forces(
    body: SpatialBody, contact: ContactSet, velocity: FloatArray, up: FloatArray, field: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return angular acceleration in body axes [rad/s2] and supports [N]."""
    # field: gravity minus the acceleration of the ground [m/s2]
    arm, inertia = body.centre - contact.pivot, body.inertia_about(contact.pivot)
    rate: FloatArray
    gyroscopic, weight = cross(velocity, applied(inertia, velocity)), body.mass * cross(arm, field)
    if contact.mode is ContactMode.REST:
        rate = np.zeros(3)
    elif contact.axis is not None:
        rate = contact.axis * (
            dot(contact.axis, weight - gyroscopic) / dot(contact.axis, applied(inertia, contact.axis))
        )
    else:
        rate = solution(inertia, weight - gyroscopic)
    moment = applied(inertia, rate) + gyroscopic - weight  # Eq. 91
    force = body.mass * (cross(rate, arm) + cross(velocity, cross(velocity, arm)) - field)  # Eq. 91
    return rate, supports(body, contact, force, moment, up)
