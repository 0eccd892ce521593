"""Contact of a body after an impact, or after a choice by forces."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.rolling import complementarity
from rocking.dynamics.rolling.attitude import cross
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.complementarity import (
    ContactSet,
    Continuation,
    SpatialState,
    candidates,
    forces,
    impulses,
    of_forces,
    of_impact,
)
from rocking.dynamics.rolling.event_functions import START_ROLLING, STOP_ROLLING
from rocking.dynamics.rolling.impact_laws import SpatialImpactLaw
from rocking.outcome import ContactMode
from rocking.portable import applied, dot, norm

CLOSED = 1e-12  # a smaller ratio of gap / size of the body counts as closed


def landed(body: SpatialBody, state: SpatialState, touching: tuple[int, ...], law: SpatialImpactLaw) -> Continuation:
    """Return the contact and velocity after an impact on a set of vertices."""
    # if all contacts are tensile (a fast grazing vertex sticks only under tension), choose the smallest tension
    continuations = of_impact(body, state, touching, law)
    return continuations[0] if continuations else _min_tension(body, state, touching)


def _min_tension(body: SpatialBody, state: SpatialState, touching: tuple[int, ...]) -> Continuation:
    best: Continuation | None = None
    for contact in candidates(body, touching):
        velocity = state.plastic(body, contact)
        opening = applied(cross(velocity, body.vertices[list(touching)] - contact.pivot), state.up)
        if opening.min() < -1e-9 * float(np.abs(velocity).max()) * body.size:
            continue
        push = impulses(body, state, contact, velocity)
        if best is None or push.min() > best.supports.min():
            best = Continuation(contact, velocity, push)
    assert best is not None  # an edge or a face always qualifies, because no other gap closes
    return best


def stuck(body: SpatialBody, state: SpatialState, touching: tuple[int, ...]) -> Continuation:
    """Return the contact after an accumulation of impacts at one time: the largest set of touching points."""
    # A body may turn about the vertical on one corner while the next corner chatters. Without slip, the limit is rest
    # on both corners. The impulses then contain the tension; a real corner would slip. The result is an edge or a face
    # after a plastic impact.
    contact = next(candidates(body, touching))
    velocity = state.plastic(body, contact)
    return Continuation(contact, velocity, impulses(body, state, contact, velocity))


def laid_down(body: SpatialBody, state: SpatialState) -> Continuation | None:
    """Return a round base at rest on its face, because rolling never ends; None if the base would lift at once."""
    flat, still = complementarity.face(body), np.zeros(3)
    holds = forces(body, flat, still, state.up, state.field)[1].min() > 0.0
    return Continuation(flat, still, impulses(body, state, flat, still)) if holds else None


def rim_landed(body: SpatialBody, state: SpatialState, law: SpatialImpactLaw) -> Continuation:
    """Return the contact of a round base that lands flat (its far side or its face), and the velocity after landing."""
    far = complementarity.rim(body, -state.pivot[:2])
    push = impulses(body, state, far, state.plastic(body, far))
    velocity = law.velocity_after(body, state.impact(body, far))
    opens = dot(cross(velocity, state.pivot - far.pivot), state.up) > 0.0
    if opens and push.min() >= 0.0:
        return Continuation(far, velocity, push)
    flat = complementarity.face(body)
    return Continuation(flat, np.zeros(3), impulses(body, state, flat, np.zeros(3)))


def settled(
    body: SpatialBody, state: SpatialState, choice: Continuation, touching: tuple[int, ...], slow: float, *, weak: bool
) -> Continuation:
    """Return the contact if points with opening speeds up to `slow` [m/s] stay closed."""
    if body.round:
        push = forces(body, complementarity.face(body), np.zeros(3), state.up, state.field)[1]
        rests = (weak or choice.contact.mode is ContactMode.REST) and push.min() >= 0.0
        return Continuation(complementarity.face(body), np.zeros(3), choice.supports) if rests else choice
    opening = applied(cross(choice.velocity, body.vertices - choice.contact.pivot), state.up)
    indices = range(len(body.vertices)) if weak else touching
    nearby = tuple(i for i in indices if weak or i in choice.contact.points or opening[i] <= slow)
    continuations = of_forces(body, state, nearby, choice.contact)
    return (
        Continuation(continuations[0].contact, continuations[0].velocity, choice.supports) if continuations else choice
    )


def started(body: SpatialBody, velocity: FloatArray, up: FloatArray) -> tuple[ContactSet, tuple[int, ...]]:
    """Return contact and touching points for initial conditions. The lowest points stay in contact."""
    # a body at rest stands on its face
    if body.round:
        return _started_round(body, velocity, up), ()
    height = applied(body.vertices, up)
    touching = tuple(np.flatnonzero(height - height.min() <= CLOSED * body.size).tolist())
    size = float(np.abs(velocity).max())
    if size == 0.0 and len(touching) == len(body.vertices):
        return complementarity.face(body), touching
    rates = applied(cross(velocity, body.vertices), up)
    lowest = [i for i in touching if rates[i] <= min(rates[list(touching)]) + CLOSED * size * body.size]
    for index in lowest:
        along = body.edges[index]
        alone = float(np.abs(velocity - along * dot(along, velocity)).max()) <= CLOSED * size
        if (index + 1) % len(body.vertices) in lowest and alone:
            return complementarity.edge(body, index), touching
    return complementarity.vertex(body, lowest[0]), touching


def _started_round(body: SpatialBody, velocity: FloatArray, up: FloatArray) -> ContactSet:
    sine = norm(up[:2])
    direction = up[:2] if sine > STOP_ROLLING else np.array([-velocity[1], velocity[0]])
    if not np.any(direction):
        return complementarity.face(body)
    contact = complementarity.rim(body, -direction)
    return complementarity.rolling(contact) if sine > START_ROLLING else contact
