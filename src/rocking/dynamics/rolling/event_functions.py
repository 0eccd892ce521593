"""Events that end a step: a gap closes, a round base starts to roll or becomes flat, a contact is released."""

import math
from dataclasses import dataclass
from operator import mul

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.rolling import complementarity
from rocking.dynamics.rolling.attitude import cross
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.complementarity import ContactSet, SpatialState, of_forces
from rocking.dynamics.rolling.ground import SpatialGround
from rocking.dynamics.taylor import first_fall, shifted, value
from rocking.outcome import ContactMode
from rocking.portable import applied, convolved, inverse, norm, times
from rocking.portable import dot as dot_of

NOTHING = 1e-13  # a coefficient counts as rounding below this ratio to the largest coefficient


def first_zero(series: FloatArray, *, started: bool, floor: float = 0.0) -> float | None:
    """Return the first x from 0 to 1 at which a series becomes negative; None if the series does not."""
    terms = series.tolist()
    if started:
        small = NOTHING * max(map(abs, terms))
        first_index = next(
            (k for k, c in enumerate(terms) if k and abs(c) > (max(floor, small) if k < 3 else small)), None
        )
        if first_index is None:
            return None
        terms = terms[first_index:]
    elif terms[0] == 0.0 and len(terms) > 1:
        terms = terms[1:]
    if not all(map(math.isfinite, terms)):
        return None
    if terms[0] < 0.0:
        return 0.0
    terms[0] = terms[0] or 5e-324
    return first_fall(terms)


def cauchy(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the product of two series, up to the order of the first series."""
    return convolved(left, right[: len(left)], len(left))


def dot(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the scalar product of two series of vectors."""
    return np.asarray(sum(cauchy(left[:, i], right[:, i]) for i in range(left.shape[1])))


def square_root(square: FloatArray) -> FloatArray:
    """Return the square root of a series with a positive first term."""
    root = [math.sqrt(square[0])]
    for k, term in enumerate(square.tolist()[1:], 1):
        root.append((term - sum(map(mul, root[1:k], root[k - 1 : 0 : -1]))) / (2.0 * root[0]))
    return np.array(root)


def padded(series: FloatArray, count: int) -> FloatArray:
    """Return a series, cut or padded with zeros to a length."""
    result = np.zeros(count)
    result[: len(series)] = series[:count]
    return result


SLOW_OPENING = 1e-9  # smaller values of acceleration of a gap / gravity count as zero, as in the choice of contacts
START_ROLLING, STOP_ROLLING = 1e-11, 1e-13  # sines of the tilt at which a round base starts and ends rolling
LANDING, FLAT = 1e-3, 1e-6
"""Sines of the tilt: the passage of a falling rim is predicted at the first; below the second, it is a landing."""
NEARLY_FLAT = 0.01
"""A round base keeps contact below this fraction of the slenderness angle, see `nearly_flat`."""


@dataclass(frozen=True, eq=False)
class Step:
    """Series of a step. The unit of time is the step."""

    length: float  # duration [s]
    velocities: FloatArray  # angular velocity in body axes [rad/s]; shape (order + 1, 3)
    up: FloatArray  # vertical in body axes [-]; shape (order + 1, 3)
    # gravity minus the acceleration of the ground, in axes of the ground [m/s2]; shape (3, degree + 1)
    field: FloatArray
    heading: FloatArray  # direction of the edge in contact, on the ground [-]; zero without an edge; shape (3,)


Forces = tuple[FloatArray, FloatArray | None]
"""Series of a step: the vertical force per unit mass, and that at the second end of an edge [N/kg]."""


def watched(body: SpatialBody, contact: ContactSet) -> tuple[int, ...]:
    """Return the vertices whose gaps may close: both neighbours of a vertex, or the vertex farthest from an edge."""
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
    """Return time over the step and vertex of the first closing of a gap; None if no gap closes."""
    contacts: list[tuple[float, int]] = []
    floor = 0.5 * SLOW_OPENING * norm(step.field[:, 0]) * step.length**2
    for index in watched(body, contact):
        gap = applied(step.up, body.vertices[index] - contact.pivot)
        time = first_zero(gap, started=index in touching, floor=floor)
        if time is not None:
            contacts.append((time, index))
    return min(contacts) if contacts else None


def nearly_flat(body: SpatialBody, up: FloatArray) -> bool:
    """Return True if the tilt of a round base is so small that loss of contact is negligible. `up` gives the tilt.

    A spin about the axis can accelerate the rim downwards by more than gravity for milliseconds. The model then keeps
    the contact, which does no work, and the history contains the duration of this state.

    >>> bottle = SpatialBody.cylinder(0.5, 2.0)
    >>> [nearly_flat(bottle, np.array([sine, 0.0, 1.0])) for sine in (1e-3, 1e-2)]
    [True, False]
    """
    return body.round and bool(math.hypot(up[0], up[1]) * float(body.centre[2]) < NEARLY_FLAT * body.radius)


def lands_flat(up: FloatArray, velocity: FloatArray) -> FloatArray | None:
    """Return the direction of fall of a rim that lands flat; None for a rim that rolls on.

    A rigid rim that passes close to the flat position rolls on without loss. Only an exact passage would be an impact.
    Real bases are flat only to about 1e-6, so that a closer passage is treated as an impact of the full base.
    """
    falling = cross(up, velocity)[:2]
    past = abs(float(up[0] * falling[1] - up[1] * falling[0]))  # Eq. 327
    return falling if past < FLAT * norm(falling) and float(dot_of(up[:2], falling)) < 0.0 else None


def rim_events(body: SpatialBody, contact: ContactSet, step: Step, *, landing: bool = False) -> float | None:
    """Return the time over the step at which a round base starts to roll, passes `LANDING`, or becomes flat."""
    if contact.mode is ContactMode.ROLLING:
        direction = step.up[0, :2]
        size = norm(direction)
        sine = applied(step.up[:, :2], direction) / size
        sine[0] -= LANDING if size > LANDING * (1.0 + 1e-6) else STOP_ROLLING
        return first_zero(sine, started=False)
    tilt_sine = applied(step.up[:, :2], contact.pivot[:2]) / -body.radius  # of the tilt away from the contact point
    flat, steep = tilt_sine.copy(), -tilt_sine
    steep[0] += 2.0 * LANDING if landing else START_ROLLING
    # after uplift from rest, the tilt grows with the cube of time, so that lower powers are rounding errors
    floor = 0.25 * SLOW_OPENING * norm(step.field[:, 0]) * step.length**2 / body.radius
    zeros = [first_zero(flat, started=abs(tilt_sine[0]) < NOTHING, floor=floor), first_zero(steep, started=False)]
    return min((at for at in zeros if at is not None), default=None)


def vertical_forces(body: SpatialBody, contact: ContactSet, step: Step) -> Forces:
    """Return the vertical force per unit mass as a series, and that at the second end of an edge [N/kg]."""
    return _normal(body, contact, step), None if contact.axis is None else _second(body, contact, step)


def first_release(body: SpatialBody, contact: ContactSet, step: Step, forces: Forces) -> tuple[float, int] | None:
    """Return time over the step and index of the end of the first release; None if there is no release."""
    # An end of an edge is released if its force is tensile and its gap opens. If the gap does not open (friction at
    # this end keeps the gap closed, so that neither the edge nor its other end alone is consistent), the edge stays in
    # contact. The tensile force is then visible in `end_forces`; a real corner would slip. The index is -1 if all
    # contact is released.
    normal, second = forces
    lost = first_zero(normal, started=False)
    releases = [] if lost is None else [(lost, -1)]
    if second is not None:
        for end_index, force in ((0, normal - second), (1, second)):
            if force[0] - np.abs(force[1:]).sum() > 0.0:
                continue
            at = _opens(force, _opening(body, contact, step, end_index))
            if at is not None:
                releases.append((at, end_index))
    return min(releases, default=None)


def end_forces(forces: Forces, at: float) -> tuple[float, float]:
    """Return the vertical forces per unit mass at both ends of an edge [N/kg]. A negative force is tensile."""
    normal, second = (0.0 if series is None else value(series.tolist(), at) for series in forces)
    return normal - second, second


def _opens(force: FloatArray, opening: FloatArray) -> float | None:
    """Return the first time at which a force is tensile and its gap opens; None if there is none."""
    at = first_zero(force, started=False)
    if at is None:
        return None
    if value(opening.tolist(), at) > 0.0:
        return at
    opening_time = first_zero(-opening, started=False)
    return (
        opening_time
        if opening_time is not None and opening_time > at and value(force.tolist(), opening_time) < 0.0
        else None
    )


def _normal(body: SpatialBody, contact: ContactSet, step: Step) -> FloatArray:
    """Return the vertical force per unit mass as a series [N/kg]."""
    if contact.mode is ContactMode.ROLLING:
        # height of the centre of mass over the ground: Z . C + b sin(tilt)
        level = step.up[:, :2]
        height = applied(step.up, body.centre) + body.radius * square_root(dot(level, level))
    else:
        height = applied(step.up, body.centre - contact.pivot)
    k = np.arange(len(height))
    rise = (k * (k - 1) * height)[2:] / step.length**2  # Eq. 96
    return rise - padded(step.field[2], len(rise))


def _second(body: SpatialBody, contact: ContactSet, step: Step) -> FloatArray:
    """Return the vertical force per unit mass at the second end of an edge as a series [N/kg]."""
    axis, arm, n = _axis(contact), body.centre - contact.pivot, len(step.up)
    about = applied(body.inertia_about(contact.pivot), axis) / body.mass
    spin = applied(step.velocities, axis)
    rate = np.append((np.arange(n) * spin)[1:], 0.0) / step.length
    # Z . (Z x M) along the edge, with M = I w' + w x I w - rho x m g
    moment = -cauchy(applied(step.up, cross(axis, about)), rate)
    moment -= cauchy(applied(step.up, cross(axis, cross(axis, about))), cauchy(spin, spin))
    moment += cauchy(applied(step.up, arm), padded(applied(step.field.T, step.heading), n))
    moment -= padded(step.field[2], n) * dot_of(axis, arm)
    return moment[: n - 2] / contact.length  # Eq. 97


def _opening(body: SpatialBody, contact: ContactSet, step: Step, end_index: int) -> FloatArray:
    """Return the acceleration of the gap at one end of an edge for rotation about the other end."""
    axis, n = _axis(contact), len(step.up)
    stays = contact.pivot if end_index else contact.pivot + contact.length * axis
    leaves = axis * (contact.length if end_index else -contact.length)
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


_SAME = 1e-11
_WHOLE = 1.0 - 1e-12


def next_uplift(
    body: SpatialBody, ground: SpatialGround, rotation: FloatArray, gravity: float, position: tuple[int, float]
) -> tuple[int, float, tuple[int, ...]] | None:
    """Return the next uplift: segment, time within the segment, and edges; None without uplift."""
    # The centre of pressure is at c - h a / (g + a_z). It is inside if (c - v_i) . n_i (g + a_z) - h n_i . a >= 0 for
    # every edge; these are polynomials of time. For a round base, b^2 (g + a_z)^2 - |c (g + a_z) - h a|^2 >= 0.
    # gravity: acceleration of gravity [m/s2]
    # The time is in units of the segment. The result contains the edges that the centre of pressure crosses. It
    # contains no edges if the centre of pressure jumps out of the base, and for a round base.
    stretch, tau = position
    if stretch >= ground.count:
        return None
    holds = _holds(body, ground.coefficients[stretch:], rotation, gravity)
    low = holds[:, :, 0] + np.minimum(holds[:, :, 1:], 0.0).sum(axis=2)
    low[0] = np.where(tau > 0.0, -np.inf, low[0])
    for k in np.flatnonzero((low <= 0.0).any(axis=1)):
        crossing = _within(holds[k], tau if k == 0 else 0.0, _SAME * gravity * body.size)
        if crossing is not None:
            return stretch + int(k), crossing[0], () if body.round else crossing[1]
    return None


def lifted(body: SpatialBody, state: SpatialState, edges: tuple[int, ...]) -> ContactSet | None:
    """Return the contact of a body after uplift from rest; None if the contact force is tensile."""
    if body.round:
        pressure = -state.field[2] * body.centre[:2] + body.centre[2] * state.field[:2]
        return complementarity.rim(body, pressure) if state.field[2] < 0.0 else None
    count = len(body.vertices)
    if len(edges) == 1:
        return complementarity.edge(body, edges[0])
    if len(edges) == 2:
        first, second = edges
        return complementarity.vertex(body, second if (first + 1) % count == second else first)
    continuations = of_forces(body, state, tuple(range(count)))
    return continuations[0].contact if continuations else None


def _holds(body: SpatialBody, accelerations: FloatArray, rotation: FloatArray, gravity: float) -> FloatArray:
    """Return the functions that are positive at rest, by segment, edge and power."""
    level = times(rotation[:2, :2].T, accelerations[:, :2])
    weight = accelerations[:, 2].copy()
    weight[:, 0] += gravity
    if not body.round:
        inside = ((body.centre[:2] - body.vertices[:, :2]) * body.inward).sum(axis=1)
        tipping = times(body.inward, level)
        return np.asarray(inside[None, :, None] * weight[:, None, :] - body.centre[2] * tipping)  # Eq. 94
    values = np.zeros((len(weight), 2, 2 * weight.shape[1] - 1))
    values[:, 1, : weight.shape[1]] = weight * body.size  # positive if the contact force is compressive
    for k, w in enumerate(weight):
        values[k, 0] = body.radius**2 * convolved(w, w)
        for axis in range(2):
            arm = body.centre[axis] * w - body.centre[2] * level[k, axis]
            values[k, 0] -= convolved(arm, arm)  # Eq. 95
    return values


def _within(holds: FloatArray, tau: float, same: float) -> tuple[float, tuple[int, ...]] | None:
    """Return the first uplift in a segment and its edges. There are no edges if the uplift is immediate."""
    rows = [shifted(row.tolist(), tau, 1.0 - tau) if tau > 0.0 else row.tolist() for row in holds]
    if min(row[0] for row in rows) < -same:
        return tau, ()
    falls: list[tuple[float, int]] = []
    for index, row in enumerate(rows):
        at = first_fall(row) if row[0] > 0.0 else (0.0 if _falls_at_once(row) else None)
        if at is not None and at < _WHOLE:  # the end of a segment belongs to the next segment
            falls.append((at, index))
    if not falls:
        return None
    first = min(falls)[0]
    edges = tuple(index for index, row in enumerate(rows) if value(row, first) <= same)
    return tau + (1.0 - tau) * first, edges


def _falls_at_once(row: list[float]) -> bool:
    """Return True if a polynomial that is zero at the start becomes negative at once."""
    return next((c for c in row[1:] if c != 0.0), 0.0) < 0.0
