"""What an impact, or a moment at which forces decide, leaves a body standing on."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space import complementarity
from rocking.dynamics.space.attitude import cross
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.complementarity import (
    ContactSet,
    Continuation,
    SpatialState,
    candidates,
    forces,
    impulses,
    of_forces,
    of_impact,
)
from rocking.dynamics.space.event_functions import START_ROLLING, STOP_ROLLING
from rocking.dynamics.space.impact_laws import SpatialImpactLaw
from rocking.outcome import ContactMode
from rocking.portable import applied, dot, norm

CLOSED = 1e-12  # gaps below this share of the size of a body are closed


def landed(body: SpatialBody, state: SpatialState, touching: tuple[int, ...], law: SpatialImpactLaw) -> Continuation:
    """Return what an impact on some vertices leaves, and the angular velocity after."""
    # where all contacts pull (a vertex that grazes fast would stick only if pulled) the one with the least, which shows
    found = of_impact(body, state, touching, law)
    return found[0] if found else _least_pull(body, state, touching)


def _least_pull(body: SpatialBody, state: SpatialState, touching: tuple[int, ...]) -> Continuation:
    best: Continuation | None = None
    for contact in candidates(body, touching):
        velocity = state.plastic(body, contact)
        opening = applied(cross(velocity, body.vertices[list(touching)] - contact.pivot), state.up)
        if opening.min() < -1e-9 * float(np.abs(velocity).max()) * body.size:
            continue
        push = impulses(body, state, contact, velocity)
        if best is None or push.min() > best.supports.min():
            best = Continuation(contact, velocity, push)
    assert best is not None  # an edge or a face opens no gap
    return best


def stuck(body: SpatialBody, state: SpatialState, touching: tuple[int, ...]) -> Continuation:
    """Return what impacts leave that pile up at one moment: the largest set of touching points, pulled or not."""
    # A body that turns about the vertical on one corner while its neighbour chatters beside it comes to stick on both:
    # in the limit both are at rest, and without slip nothing else is. Its impulses show the pull: in truth a corner
    # slips. Returns edge or face, after a plastic impact.
    contact = next(candidates(body, touching))
    velocity = state.plastic(body, contact)
    return Continuation(contact, velocity, impulses(body, state, contact, velocity))


def laid_down(body: SpatialBody, state: SpatialState) -> Continuation | None:
    """Return a round base laid flat, as rolling alone never comes to rest; None where it would lift at once."""
    flat, still = complementarity.face(body), np.zeros(3)
    holds = forces(body, flat, still, state.up, state.field)[1].min() > 0.0
    return Continuation(flat, still, impulses(body, state, flat, still)) if holds else None


def rim_landed(body: SpatialBody, state: SpatialState, law: SpatialImpactLaw) -> Continuation:
    """Return what a round base that falls flat stands on, its far side or all of it, and the angular velocity after."""
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
    """Return what a body stands on once points that leave slower than `slow` [m/s] are taken to stay."""
    if body.round:
        push = forces(body, complementarity.face(body), np.zeros(3), state.up, state.field)[1]
        rests = (weak or choice.contact.mode is ContactMode.REST) and push.min() >= 0.0
        return Continuation(complementarity.face(body), np.zeros(3), choice.supports) if rests else choice
    opening = applied(cross(choice.velocity, body.vertices - choice.contact.pivot), state.up)
    every = range(len(body.vertices)) if weak else touching
    near = tuple(i for i in every if weak or i in choice.contact.points or opening[i] <= slow)
    found = of_forces(body, state, near, choice.contact)
    return Continuation(found[0].contact, found[0].velocity, choice.supports) if found else choice


def started(body: SpatialBody, velocity: FloatArray, up: FloatArray) -> tuple[ContactSet, tuple[int, ...]]:
    """Return the contact that initial conditions imply: the lowest touching points stay."""
    # the face for a body that stands still
    if body.round:
        return _started_round(body, velocity, up), ()
    height = applied(body.vertices, up)
    touching = tuple(np.flatnonzero(height - height.min() <= CLOSED * body.size).tolist())
    size = float(np.abs(velocity).max())
    if size == 0.0 and len(touching) == len(body.vertices):
        return complementarity.face(body), touching
    rates = applied(cross(velocity, body.vertices), up)
    low = [i for i in touching if rates[i] <= min(rates[list(touching)]) + CLOSED * size * body.size]
    for number in low:
        along = body.edges[number]
        alone = float(np.abs(velocity - along * dot(along, velocity)).max()) <= CLOSED * size
        if (number + 1) % len(body.vertices) in low and alone:
            return complementarity.edge(body, number), touching
    return complementarity.vertex(body, low[0]), touching


def _started_round(body: SpatialBody, velocity: FloatArray, up: FloatArray) -> ContactSet:
    sine = norm(up[:2])
    lean = up[:2] if sine > STOP_ROLLING else np.array([-velocity[1], velocity[0]])
    if not np.any(lean):
        return complementarity.face(body)
    contact = complementarity.rim(body, -lean)
    return complementarity.rolling(contact) if sine > START_ROLLING else contact
