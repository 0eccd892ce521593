"""The motion while the contact lasts: accelerations, and steps of the fifth order of Dormand and Prince (1980).

Forces come from the contact problem at every stage, so that normal forces, friction and gaps there can be watched.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.contact_problem import CORNERS, SINGULAR, HullContact, Problem, Solution, solve
from rocking.dynamics.hull.ground import (
    ZERO,
    Vector,
    added,
    applied,
    back,
    cross,
    dot,
    frame,
    length,
    minus,
    normalised,
    plus,
    product,
    scaled,
    unit,
)

NODES = (0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0)
_STAGES = (
    (),
    (1.0 / 5.0,),
    (3.0 / 40.0, 9.0 / 40.0),
    (44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0),
    (19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0),
    (9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0),
    (35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0),
)
_ERROR = (
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
)


class State(NamedTuple):
    """Where the body is and how it moves."""

    place: Vector
    attitude: tuple[float, ...]
    velocity: Vector
    spin: Vector


@dataclass(frozen=True)
class HullMode:
    """The contact that lasts, with the directions in which its vertices start to slide, in axes of the ground."""

    contact: HullContact
    friction: float
    starts: dict[int, Vector]
    pulled: bool = False  # whether no contact obeys every law, and this one, with the least pull, stands in


class Rates(NamedTuple):
    """Rates of a state, and the contact that they come from; `found` is None where no force answers the motion."""

    place: Vector
    attitude: tuple[float, ...]
    velocity: Vector
    spin: Vector
    found: Solution | None


def problem_of(body: HullBody, state: State, field: Vector, friction: float) -> Problem:
    """Return the contact problem of the accelerations; field: gravity less the acceleration of the ground [m/s2]."""
    axes, w = frame(state.attitude), state.spin
    free = applied(body.compliance, scaled(-1.0, cross(w, applied(body.tensor, w))))
    return Problem(body, axes, back(axes, field), free, friction)


def rates_of(body: HullBody, state: State, mode: HullMode, field: Vector) -> Rates:
    """Return the rates of a state in a mode."""
    problem = problem_of(body, state, field, mode.friction)
    axes, w = problem.axes, state.spin
    problem.bias = {i: cross(w, cross(w, body.points[i])) for i in mode.contact.members}
    directions = {i: slip_direction(body, state, mode, i) for i in mode.contact.members if i not in mode.contact.stuck}
    found = solve(problem, mode.contact, {i: back(axes, d) for i, d in directions.items()})
    linear, angular = (problem.linear, problem.angular) if found is None else (found.linear, found.angular)
    turning = quaternion_rate(state.attitude, w)
    return Rates(state.velocity, turning, applied(axes, linear), angular, found)


def quaternion_rate(q: tuple[float, ...], w: Vector) -> tuple[float, ...]:
    """Return the rate of an attitude."""
    s, x, y, z = q
    return (
        -0.5 * (x * w[0] + y * w[1] + z * w[2]),  # Eq. 22
        0.5 * (s * w[0] + y * w[2] - z * w[1]),
        0.5 * (s * w[1] + z * w[0] - x * w[2]),
        0.5 * (s * w[2] + x * w[1] - y * w[0]),
    )


def point_velocity(body: HullBody, state: State, i: int) -> Vector:
    """Return the velocity of a vertex, in axes of the ground."""
    return plus(state.velocity, applied(frame(state.attitude), cross(state.spin, body.points[i])))


def slip_direction(body: HullBody, state: State, mode: HullMode, i: int) -> Vector:
    """Return the direction in which a vertex slides, in axes of the ground."""
    if i in mode.starts:
        return mode.starts[i]
    x, y, _ = point_velocity(body, state, i)
    return unit((x, y, 0.0))


def gap(body: HullBody, state: State, i: int) -> float:
    """Return the height of a vertex over the ground."""
    return state.place[2] + dot(frame(state.attitude)[2], body.points[i])


def _moved(state: State, stages: list[Rates], weights: tuple[float, ...], h: float) -> State:
    place, velocity, spin, attitude = state.place, state.velocity, state.spin, list(state.attitude)
    for weight, k in zip(weights, stages, strict=False):
        if weight:
            c = h * weight
            place, velocity, spin = added(place, c, k.place), added(velocity, c, k.velocity), added(spin, c, k.spin)
            for j in range(4):
                attitude[j] += c * k.attitude[j]
    return State(place, tuple(attitude), velocity, spin)


class StepResult(NamedTuple):
    """A step, and what happened at its stages."""

    state: State
    error: float  # of the local error, its size over that of the body
    samples: list[tuple[float, State, Rates]]  # start, some stages and end, with the part of the step


def step(
    body: HullBody, state: State, mode: HullMode, field: list[Vector], span: tuple[float, float], pace: float
) -> StepResult:
    """Advance by a part of a step.

    field: gravity less the acceleration of the ground over the whole step, by powers of its share [m/s2]; span:
    duration of the whole step [s] and share to advance by [-]; pace: sqrt(g / size), by which errors of velocities are
    measured [1/s].
    """
    part = span[1]
    h = part * span[0]
    stages: list[Rates] = []
    samples: list[tuple[float, State, Rates]] = []
    at = state
    for number, (node, weights) in enumerate(zip(NODES, _STAGES, strict=True)):
        at = _moved(state, stages, weights, h) if number else state
        rates = rates_of(body, at, mode, valued(field, part * node))
        stages.append(rates)
        if number in (0, 2, 3, 6):
            samples.append((node, at, rates))
    off = _moved(State(ZERO, (0.0, 0.0, 0.0, 0.0), ZERO, ZERO), stages, _ERROR, h)
    turned = max(abs(c) for c in off.attitude)
    error = max(length(off.place) / body.size, 2.0 * turned, length(off.velocity) / (body.size * pace))
    error = max(error, length(off.spin) / pace)
    return StepResult(at._replace(attitude=normalised(at.attitude)), error, samples)


def valued(field: list[Vector], share: float) -> Vector:
    """Return the value of a polynomial."""
    total = ZERO
    for c in reversed(field):
        total = added(c, share, total)
    return total


def energies(body: HullBody, state: State, gravity: Vector) -> tuple[float, float]:
    """Return the kinetic energy and the potential energy over the origin of the ground [J]."""
    w = state.spin
    kinetic = 0.5 * (body.mass * dot(state.velocity, state.velocity) + dot(w, applied(body.tensor, w)))
    return kinetic, -body.mass * dot(gravity, state.place)


def slip_speed(body: HullBody, state: State, i: int) -> float:
    """Return the speed of a vertex along the ground."""
    x, y, _ = point_velocity(body, state, i)
    return math.hypot(x, y)


def levelled(body: HullBody, attitude: tuple[float, ...], members: tuple[int, ...]) -> tuple[float, ...]:
    """Return an attitude turned by the least small angle that brings an edge or a facet onto the ground."""
    axes, count = frame(attitude), len(members)
    a, b = (body.points[members[k]] for k in (0, count // 2 if count < 4 else count // 3))
    edge = applied(axes, minus(b, a))
    if count == 2:
        level = edge[0] * edge[0] + edge[1] * edge[1]
        turn = (-edge[2] * edge[1] / level, edge[2] * edge[0] / level, 0.0)
    else:
        other = applied(axes, minus(body.points[members[(2 * count) // 3]], a))
        normal = unit(cross(edge, other))
        normal = normal if normal[2] > 0.0 else scaled(-1.0, normal)
        turn = (normal[1], -normal[0], 0.0)
    return normalised(product((1.0, 0.5 * turn[0], 0.5 * turn[1], 0.5 * turn[2]), attitude))


def standing(body: HullBody, *, facet: int | None = None, tilt: float = 0.0, azimuth: float = 0.0) -> State:
    """Return a body at rest on a facet, or in the axes of its vertices, leaning by an angle from x towards y [rad]."""
    # the lowest vertex is on the ground, the centre of mass over the origin
    attitude: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)
    if facet is not None:
        down = unit(body.facets[facet])
        axis = cross(down, (0.0, 0.0, -1.0))
        attitude = normalised((1.0 - down[2], *axis)) if down[2] < 1.0 - 1e-12 else (0.0, 1.0, 0.0, 0.0)
    half = 0.5 * tilt
    lean = (math.cos(half), -math.sin(half) * math.sin(azimuth), math.sin(half) * math.cos(azimuth), 0.0)
    attitude = normalised(product(lean, attitude))
    up = frame(attitude)[2]
    lowest = min(dot(up, p) for p in body.points)
    return State((0.0, 0.0, -lowest), attitude, ZERO, ZERO)


_TURNS, _STRAIGHT = 300, 1e-12
_NEWTON, _TRIES, _SWING = 20, 6, 1e-7  # steps, halvings, and the angle by which a direction is turned for the slope
_NOTHING = 1e-300
_BEGIN = 6  # turns after which a facet of many corners goes on by Newton


def sliding(problem: Problem, contact: HullContact, known: dict[int, Vector], still: float) -> Solution | None:
    """Return a candidate with the directions in which its free vertices start to slide, by iteration; None if none.

    known: directions of those that slide already; still: rate of a vertex below which it only just starts to slide, so
    that friction alone has the direction: against the force that held it.
    """
    free = [i for i in contact.members if i not in contact.stuck and i not in known]
    if not free or problem.friction == 0.0:
        return solve(problem, contact, {**dict.fromkeys(free, ZERO), **known})
    directions, up = {**dict.fromkeys(free, ZERO), **known}, problem.axes[2]
    holding = solve(problem, HullContact(contact.members, tuple(i for i in contact.members if i not in known)), known)
    if holding is not None:
        directions.update({i: unit(scaled(-1.0, holding.pulls[i])) for i in free})
    soft = {i: _compliance(problem, i) * problem.friction * len(free) for i in free}
    begun = directions
    if len(free) < 3 and (turned := _turned(problem, contact, begun, soft)) is not None:
        return turned
    for k in range(_TURNS):
        found = solve(problem, contact, directions)
        if found is None:
            return None
        if len(free) > CORNERS and k == _BEGIN:
            return _turned_whole(problem, found, free, still)
        change, before = 0.0, directions
        for i in free:
            rate = problem.rate(i, found.linear, found.angular)
            slip = added(rate, -dot(rate, up), up)
            if length(slip) <= still and length(before[i]) > 0.0:
                continue
            new = unit(added(slip, soft[i] * max(found.normals[i], 0.0), before[i]))  # Eq. 257
            change = max(change, length(minus(new, before[i])))
            directions = {**directions, i: new}
        if change <= _STRAIGHT:
            return found
    return _turned(problem, contact, begun, soft) if 2 < len(free) <= CORNERS else None


def _turned_whole(problem: Problem, begun: Solution, free: list[int], still: float) -> Solution | None:
    """Return how a facet of many corners starts to slide, as a rigid body: Newton for its three accelerations."""
    (x, y, up), size = problem.axes, problem.body.size

    def beside(u: FloatArray) -> tuple[Solution, FloatArray] | None:
        turned = dict(begun.directions)
        for i in free:
            rate = plus(scaled(u[0], x), scaled(u[1], y))
            rate = added(rate, u[2] / size, cross(up, problem.body.points[i]))
            rate = plus(rate, problem.bias[i]) if problem.bias else rate
            rate = added(rate, -dot(rate, up), up)
            turned[i] = unit(added(rate, max(still - length(rate), 0.0), begun.directions[i]))
        found = solve(problem, begun.contact, turned)
        return None if found is None else (found, read(found) - u)

    def read(found: Solution) -> FloatArray:
        return np.array([dot(x, found.linear), dot(y, found.linear), size * dot(up, found.angular)])

    u = read(begun)
    reached = beside(u)
    for _ in range(2 * _NEWTON):
        if reached is None:
            return None
        found, off = reached
        large, most = length(tuple(u)), length(tuple(off))
        if most <= _STRAIGHT * large:
            return found
        by = _SWING * max(large, still)
        swung = [beside(u + by * axis) for axis in np.eye(3)]
        if any(s is None for s in swung):
            return None
        step = _solved(np.array([(s[1] - off) / by for s in swung if s]).T, -off)
        if step is None:
            return None
        for k in range(2 * _TRIES):
            to = u + 0.5**k * step
            if (reached := beside(to)) is None:
                return None
            if length(tuple(reached[1])) < most:
                break
        u = to
    # accelerations below `still` have no direction of their own
    near = reached is not None and length(tuple(reached[1])) <= max(still, 1e-9 * length(tuple(u)))
    return reached[0] if reached is not None and near else None


def _turned(
    problem: Problem, contact: HullContact, directions: dict[int, Vector], soft: dict[int, float]
) -> Solution | None:
    """Return a candidate whose vertices start to slide where they accelerate to, by Newton; None where it fails."""
    up, free = problem.axes[2], list(soft)

    def across(turned: dict[int, Vector]) -> tuple[Solution, list[float], list[float]] | None:
        found = solve(problem, contact, directions | turned)
        if found is None:
            return None
        rates = {i: problem.rate(i, found.linear, found.angular) for i in free}
        most = {i: max(soft[i] * abs(found.normals[i]) + length(rates[i]), _NOTHING) for i in free}
        side = [dot(cross(up, turned[i]), rates[i]) / most[i] for i in free]
        return found, side, [dot(turned[i], rates[i]) / most[i] for i in free]

    def turn(a: Vector, angle: float) -> Vector:
        return added(scaled(math.cos(angle), a), math.sin(angle), cross(up, a))

    now = {i: directions[i] for i in free}
    for _ in range(_NEWTON):
        if (reached := across(now)) is None:
            return None
        found, side, along = reached
        size = max(map(abs, side))
        if size <= _STRAIGHT:
            against = [i for i, a in zip(free, along, strict=True) if a < -_STRAIGHT]
            if not against:
                return found
            now |= {i: scaled(-1.0, now[i]) for i in against}
            continue
        swung = [across(now | {i: turn(now[i], _SWING)}) for i in free]
        if any(s is None for s in swung):
            return None
        slopes = np.array([[(b - a) / _SWING for a, b in zip(side, s[1], strict=True)] for s in swung if s]).T
        by = _solved(slopes, np.array(side))
        if by is None:
            return None
        share = min(1.0, 0.5 / max(np.abs(by).max(), _NOTHING))
        start = now
        for _ in range(_TRIES):
            now = {i: turn(start[i], -share * float(b)) for i, b in zip(free, by, strict=True)}
            if (reached := across(now)) is None:
                return None
            if max(map(abs, reached[1])) < size:
                break
            share *= 0.5
    return None


def _solved(table: FloatArray, side: FloatArray) -> FloatArray | None:
    """Solve by Gauss with exchange of rows, the same on every processor; None where the table is singular."""
    rows = np.column_stack([table, side])
    for k in range(len(side)):
        best = k + int(np.argmax(np.abs(rows[k:, k])))
        if not abs(rows[best, k]) > SINGULAR:
            return None
        rows[[k, best]] = rows[[best, k]]
        factors = rows[:, k] / rows[k, k]
        factors[k] = 0.0
        rows -= factors[:, None] * rows[k]
    return rows[:, -1] / rows.diagonal()


def _compliance(problem: Problem, i: int) -> float:
    """Return the larger of what one unit of force along each axis of the ground moves a vertex along it."""
    arm, found = problem.body.points[i], 0.0
    for axis in problem.axes[:2]:
        turned = cross(applied(problem.body.compliance, cross(arm, axis)), arm)
        found = max(found, 1.0 / problem.body.mass + dot(turned, axis))
    return found
