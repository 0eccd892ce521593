"""Which points stay on the ground: complementarity over the few contact sets that a convex base allows.

A set of touching points either stays (the ground pushes there) or leaves (its gap opens). On a flat base only three
kinds of sets can stay: a vertex, an edge, or everything, since a body that turns about any other pair of vertices
would dip another one into the ground. Each candidate is tried: the motion that it leaves must not close a gap of
another touching point, and the ground must not pull. This is the linear complementarity problem with sticking points
(physics: plastic impact as a projection in the kinetic metric, forces by Euler's equations), solved by listing.
"""

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rocking.bodies.solid import Corner, Edge
from rocking.conventions import FloatArray
from rocking.dynamics.space import contact_mode
from rocking.dynamics.space.attitude import cross
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.contact_mode import ContactSet
from rocking.dynamics.space.impact_laws import PLASTIC, SpatialImpactLaw
from rocking.outcome import ContactMode
from rocking.portable import applied, dot, norm, solution
from rocking.restitution.space import SpatialImpact

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
        return SpatialImpact(body.moments, self.velocity, pivot, onto, self.up, body.matter)

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
        yield contact_mode.face(body)
    for number in touching:
        if (number + 1) % count in touching:
            yield contact_mode.edge(body, number)
    for number in touching:
        yield contact_mode.vertex(body, number)


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
    return contact_mode.supports(body, contact, push, moment, state.up)


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
    return rate, contact_mode.supports(body, contact, force, moment, up)
