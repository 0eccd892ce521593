"""On what a body stands: its whole base, an edge, a vertex, a point of its rim; and the forces that it takes there."""

from dataclasses import dataclass, replace

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space.attitude import cross
from rocking.dynamics.space.body import SpatialBody
from rocking.outcome import ContactMode
from rocking.portable import dot, norm

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
