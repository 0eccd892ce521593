"""Which points stay on the ground: complementarity over the few contact sets of a convex base, tried one by one."""

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from rocking.bodies.solid import Corner, Edge
from rocking.conventions import FloatArray
from rocking.dynamics.space.attitude import cross
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.impact_laws import PLASTIC, SpatialImpactLaw
from rocking.outcome import ContactMode
from rocking.portable import applied, dot, norm, solution
from rocking.restitution.space import SpatialImpact

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class ContactSet:
    """What stays on the ground."""

    mode: ContactMode  # the regime
    points: tuple[int, ...]  # numbers of the vertices that stay; none for round bases
    pivot: FloatArray  # A point that stays, in body axes [m]; shape (3,)
    axis: FloatArray | None = None  # unit vector along an edge that stays, in body axes [-]; shape (3,)
    length: float = 0.0  # length of that edge [m]


def face(body: SpatialBody) -> ContactSet:
    """Return standing on the whole base."""
    pivot = np.zeros(3) if body.round else body.vertices[0]
    return ContactSet(ContactMode.REST, tuple(range(len(body.vertices))), pivot)


def edge(body: SpatialBody, number: int) -> ContactSet:
    """Return standing on an edge."""
    after = (number + 1) % len(body.vertices)
    length = norm(body.vertices[after] - body.vertices[number])
    return ContactSet(ContactMode.EDGE, (number, after), body.vertices[number], body.edges[number], length)


def vertex(body: SpatialBody, number: int) -> ContactSet:
    """Return standing on a vertex."""
    return ContactSet(ContactMode.VERTEX, (number,), body.vertices[number])


def rim(body: SpatialBody, direction: FloatArray) -> ContactSet:
    """Return standing on a point of a round base, turning about it: rolling starts so on a base that is nearly flat."""
    unit = direction / norm(direction)
    return ContactSet(ContactMode.VERTEX, (), np.array([*(body.radius * unit), 0.0]))


def rolling(contact: ContactSet) -> ContactSet:
    """Return rolling that starts on the point of a contact."""
    return replace(contact, mode=ContactMode.ROLLING)


def supports(
    body: SpatialBody, contact: ContactSet, force: FloatArray, moment: FloatArray, up: FloatArray
) -> FloatArray:
    """Return what must not be negative for the ground to give a force without pulling."""
    # Horizontal forces are free, since nothing slips; what remains is where the vertical one acts. With M the moment
    # about the pivot and Z upwards, Z x M = sum N_i r_i over the points of contact: so an edge has the two forces at
    # its ends, and a face the moments of the vertical forces about each edge, over its distance scale. force, moment:
    # force of the ground and its moment about the pivot, in body axes [N], [N m]; or impulses; up: vertical in body
    # axes [-]. Returns vertical force at a vertex; at both ends of an edge; for a face N times the distance of its
    # centre of pressure from each edge over the size of the body [N].
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
    """Return the point of the body on the ground, in body axes [m]: the pivot, or the lowest of a rolling rim."""
    if contact.mode is not ContactMode.ROLLING:
        return contact.pivot
    level = up[:2] / norm(up[:2])
    return np.array([-body.radius * level[0], -body.radius * level[1], 0.0])


def rise(body: SpatialBody, pivot: FloatArray, up: FloatArray) -> float:
    """Return how much higher the centre of mass is than at rest; pivot: a point on the ground, in body axes [m]."""
    arm = body.centre - pivot
    level2 = float(up[0] ** 2 + up[1] ** 2)
    # 1 - cos(tilt) without the loss of digits
    sunk = level2 / (1.0 + up[2]) if up[2] > 0.0 else 1.0 - float(up[2])
    return float(dot(up[:2], arm[:2]) - sunk * arm[2])  # Eq. 86


_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class SpatialState:
    """A body at an instant, in its own axes."""

    pivot: FloatArray  # A point at rest on the ground [m]; shape (3,)
    velocity: FloatArray  # angular velocity [rad/s]; shape (3,)
    up: FloatArray  # vertical [-]; shape (3,)
    field: FloatArray  # gravity less the acceleration of the ground [m/s2]; shape (3,)
    # of a body on an edge, from the pivot to the other end of the edge; zero on a vertex [m]; shape (3,)
    along: FloatArray = dataclasses.field(default_factory=lambda: np.zeros(3))

    def impact(self, body: SpatialBody, contact: ContactSet) -> SpatialImpact:
        """Return the impact onto a contact; laws measure the step from the point at rest that is nearest to it."""
        onto = Corner(contact.pivot) if contact.axis is None else Edge(contact.pivot, contact.axis)
        length, pivot = float((self.along * self.along).sum()), self.pivot
        if length > 0.0:
            middle = contact.pivot if contact.axis is None else contact.pivot + 0.5 * contact.length * contact.axis
            share = float(((middle - pivot) * self.along).sum()) / length
            pivot = pivot + min(max(share, 0.0), 1.0) * self.along
        return SpatialImpact(body.moments, self.velocity, pivot, onto, self.up, body.matter, body.footprint)

    def plastic(self, body: SpatialBody, contact: ContactSet) -> FloatArray:
        """Return the angular velocity that the plastic impact without slip leaves on a contact [rad/s]."""
        if contact.mode is ContactMode.REST:
            return np.zeros(3)
        onto = Corner(contact.pivot) if contact.axis is None else Edge(contact.pivot, contact.axis)
        return PLASTIC.turned(SpatialImpact(body.moments, self.velocity, self.pivot, onto))


@dataclass(frozen=True, eq=False)
class Continuation:
    """What stays, and how the body goes on."""

    contact: ContactSet  # on what the body stands
    velocity: FloatArray  # angular velocity, in body axes [rad/s]; shape (3,)
    supports: FloatArray  # impulses or forces of the ground, as `supports` of the contact has them [N s] or [N]


def candidates(body: SpatialBody, touching: tuple[int, ...]) -> Iterator[ContactSet]:
    """Yield the contact sets that can stay, larger ones first."""
    count = len(body.vertices)
    if len(touching) == count:
        yield face(body)
    for number in touching:
        if (number + 1) % count in touching:
            yield edge(body, number)
    for number in touching:
        yield vertex(body, number)


def of_impact(
    body: SpatialBody, state: SpatialState, touching: tuple[int, ...], law: SpatialImpactLaw
) -> list[Continuation]:
    """Return every contact set that an impact may leave, the largest first."""
    found = []
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
            found.append(Continuation(contact, velocity, push))
    return found


def of_forces(
    body: SpatialBody, state: SpatialState, touching: tuple[int, ...], first: ContactSet | None = None
) -> list[Continuation]:
    """Return every contact set that stays without a pull when no gap opens with a speed, a preferred one first."""
    found: list[Continuation] = []
    scale, every = norm(state.field), list(candidates(body, touching))
    if first is not None:
        every = [first, *(contact for contact in every if contact.points != first.points)]
    for contact in every:
        velocity = state.plastic(body, contact)
        rate, push = forces(body, contact, velocity, state.up, state.field)
        if push.min() < -_ROUNDING * body.mass * scale:
            continue
        arms = body.vertices - contact.pivot
        opening = applied(cross(rate, arms) + cross(velocity, cross(velocity, arms)), state.up)
        others = [i for i in touching if i not in contact.points]
        if not others or opening[others].min() >= -_ROUNDING * scale:
            found.append(Continuation(contact, velocity, push))
    return found


def impulses(body: SpatialBody, state: SpatialState, contact: ContactSet, velocity: FloatArray) -> FloatArray:
    """Return the impulses of the ground in an impact, as `supports` of the contact [N s]."""
    # velocity: afterwards, in body axes
    new = body.centre - contact.pivot
    push = body.mass * (cross(velocity, new) - cross(state.velocity, body.centre - state.pivot))  # Eq. 90
    moment = applied(body.inertia, velocity - state.velocity) + cross(new, push)  # Eq. 90
    return supports(body, contact, push, moment, state.up)


def forces(
    body: SpatialBody, contact: ContactSet, velocity: FloatArray, up: FloatArray, field: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return angular acceleration in body axes [rad/s2] and supports [N]."""
    # field: gravity less the ground's acceleration [m/s2]
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
