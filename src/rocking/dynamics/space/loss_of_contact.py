"""Where the ground lets go: forces at a point and at both ends of an edge, as series of the time within a step."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space.attitude import cross
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.contact_mode import ContactSet
from rocking.dynamics.space.event_functions import Step
from rocking.dynamics.space.polynomials import cauchy, dot, first_zero, padded, square_root
from rocking.dynamics.taylor import value
from rocking.outcome import ContactMode
from rocking.portable import applied, inverse, times
from rocking.portable import dot as dot_of


def first_release(body: SpatialBody, contact: ContactSet, step: Step) -> tuple[float, int] | None:
    """Return when the ground first lets go.

    An end of an edge is released where its force would be a pull and its gap would open. Where it would not open (the
    friction at that end holds it down, so that neither the edge nor its other end alone is without contradiction), the
    edge stays, and the pull shows in `end_forces`: such a corner slips in truth.

    Returns which: number of the end in the contact that is released, -1 for all contact; None instead of both if none
    is.
    """
    normal = _normal(body, contact, step)
    lost = first_zero(normal, started=False)
    found = [] if lost is None else [(lost, -1)]
    if contact.axis is not None:
        second = _second(body, contact, step)
        for which, force in ((0, normal - second), (1, second)):
            if force[0] - np.abs(force[1:]).sum() > 0.0:
                continue
            at = _opens(force, _opening(body, contact, step, which))
            if at is not None:
                found.append((at, which))
    return min(found, default=None)


def end_forces(body: SpatialBody, contact: ContactSet, step: Step, at: float) -> tuple[float, float]:
    """Return the vertical forces per unit mass at both ends of an edge.

    Returns below zero the ground would have to pull [N/kg].
    """
    second = value(_second(body, contact, step).tolist(), at)
    return value(_normal(body, contact, step).tolist(), at) - second, second


def _opens(force: FloatArray, opening: FloatArray) -> float | None:
    """When a force is a pull while its gap would open."""
    at = first_zero(force, started=False)
    if at is None:
        return None
    if value(opening.tolist(), at) > 0.0:
        return at
    later = first_zero(-opening, started=False)
    return later if later is not None and later > at and value(force.tolist(), later) < 0.0 else None


def _normal(body: SpatialBody, contact: ContactSet, step: Step) -> FloatArray:
    """Vertical force per unit mass."""
    if contact.mode is ContactMode.ROLLING:
        # height of the centre over the ground: Z . C + b sin(tilt)
        level = step.up[:, :2]
        height = applied(step.up, body.centre) + body.radius * square_root(dot(level, level))
    else:
        height = applied(step.up, body.centre - contact.pivot)
    k = np.arange(len(height))
    rise = (k * (k - 1) * height)[2:] / step.length**2  # Eq. 96
    return rise - padded(step.field[2], len(rise))


def _second(body: SpatialBody, contact: ContactSet, step: Step) -> FloatArray:
    """Vertical force per unit mass at the second end of an edge."""
    axis, arm, n = _axis(contact), body.centre - contact.pivot, len(step.up)
    about = applied(body.inertia_about(contact.pivot), axis) / body.mass
    spin = applied(step.velocities, axis)
    rate = np.append((np.arange(n) * spin)[1:], 0.0) / step.length
    # Z . (Z x M) along the edge, with M = I w' + w x I w - rho x m g
    made = -cauchy(applied(step.up, cross(axis, about)), rate)
    made -= cauchy(applied(step.up, cross(axis, cross(axis, about))), cauchy(spin, spin))
    made += cauchy(applied(step.up, arm), padded(applied(step.field.T, step.heading), n))
    made -= padded(step.field[2], n) * dot_of(axis, arm)
    return made[: n - 2] / contact.length  # Eq. 97


def _opening(body: SpatialBody, contact: ContactSet, step: Step, which: int) -> FloatArray:
    """Acceleration of the gap of an end of an edge if the body turned about the other end alone."""
    axis, n = _axis(contact), len(step.up)
    stays = contact.pivot if which else contact.pivot + contact.length * axis
    leaves = axis * (contact.length if which else -contact.length)
    inertia, arm = body.inertia_about(stays), body.centre - stays
    across = np.array([-step.heading[1], step.heading[0], 0.0])  # Z x e on the ground
    field = np.outer(padded(applied(step.field.T, step.heading), n), axis)
    for direction, series in ((step.up, step.field[2]), (cross(step.up, axis), applied(step.field.T, across))):
        strength = padded(series, n)
        field += np.column_stack([cauchy(direction[:, i], strength) for i in range(3)])
    spin = applied(step.velocities, axis)
    torque = body.mass * cross(arm, field) - np.outer(cauchy(spin, spin), cross(axis, applied(inertia, axis)))
    return dot(times(cross(leaves, step.up), inverse(inertia)), torque)[: n - 2]  # Eq. 98


def _axis(contact: ContactSet) -> FloatArray:
    assert contact.axis is not None
    return contact.axis
