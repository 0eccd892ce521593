"""Motion during a contact: accelerations, and steps by the fifth-order method of Dormand and Prince (1980).

The contact problem gives the forces at every stage. Normal forces, friction and gaps locate the events.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.contact_problem import CORNERS, SINGULAR, HullContact, Problem, Solution, solve
from rocking.dynamics.frictional.ground import (
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
    """Position of the centre of mass, attitude and velocities."""

    position: Vector
    attitude: tuple[float, ...]
    velocity: Vector
    spin: Vector


@dataclass(frozen=True)
class HullMode:
    """Contact of a step, with the initial directions of sliding of its vertices in axes of the ground."""

    contact: HullContact
    friction: float
    starts: dict[int, Vector]
    pulled: bool = False  # True if no contact satisfies all laws; this contact has the smallest tension


class Rates(NamedTuple):
    """Rates of a state, and the solution of the contact problem; None without a solution."""

    position: Vector
    attitude: tuple[float, ...]
    velocity: Vector
    spin: Vector
    solution: Solution | None


def problem_of(body: HullBody, state: State, field: Vector, friction: float) -> Problem:
    """Return the contact problem of the accelerations. `field` is gravity minus ground acceleration [m/s2]."""
    axes, w = frame(state.attitude), state.spin
    free = applied(body.compliance, scaled(-1.0, cross(w, applied(body.tensor, w))))
    return Problem(body, axes, back(axes, field), free, friction)


def rates_of(body: HullBody, state: State, mode: HullMode, field: Vector) -> Rates:
    """Return the rates of a state in a mode."""
    problem = problem_of(body, state, field, mode.friction)
    axes, w = problem.axes, state.spin
    problem.bias = {i: cross(w, cross(w, body.points[i])) for i in mode.contact.members}
    directions = {i: slip_direction(body, state, mode, i) for i in mode.contact.members if i not in mode.contact.stuck}
    solution = solve(problem, mode.contact, {i: back(axes, d) for i, d in directions.items()})
    linear, angular = (problem.linear, problem.angular) if solution is None else (solution.linear, solution.angular)
    attitude_rate = quaternion_rate(state.attitude, w)
    return Rates(state.velocity, attitude_rate, applied(axes, linear), angular, solution)


def quaternion_rate(q: tuple[float, ...], w: Vector) -> tuple[float, ...]:
    """Return the rate of the quaternion of an attitude."""
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
    """Return the direction of sliding of a vertex, in axes of the ground."""
    if i in mode.starts:
        return mode.starts[i]
    x, y, _ = point_velocity(body, state, i)
    return unit((x, y, 0.0))


def gap(body: HullBody, state: State, i: int) -> float:
    """Return the height of a vertex over the ground."""
    return state.position[2] + dot(frame(state.attitude)[2], body.points[i])


def _moved(state: State, stages: list[Rates], weights: tuple[float, ...], h: float) -> State:
    position, velocity, spin, attitude = state.position, state.velocity, state.spin, list(state.attitude)
    for weight, k in zip(weights, stages, strict=False):
        if weight:
            c = h * weight
            position, velocity, spin = (
                added(position, c, k.position),
                added(velocity, c, k.velocity),
                added(spin, c, k.spin),
            )
            for j in range(4):
                attitude[j] += c * k.attitude[j]
    return State(position, tuple(attitude), velocity, spin)


class StepResult(NamedTuple):
    """Result of a step, with its stages."""

    state: State
    error: float  # norm of the local error / size of the body [-]
    samples: list[tuple[float, State, Rates]]  # start, two stages and end, with the fraction of the step


def step(
    body: HullBody, state: State, mode: HullMode, field: list[Vector], span: tuple[float, float], pace: float
) -> StepResult:
    """Return the result of a step over a fraction of its duration.

    `field` is gravity minus ground acceleration over the full step, as a polynomial of the fraction of the step [m/s2].
    `span` contains the duration of the full step [s] and the fraction [-]. `pace` is sqrt(g / size), the scale of
    velocity errors [1/s].
    """
    fraction = span[1]
    h = fraction * span[0]
    stages: list[Rates] = []
    samples: list[tuple[float, State, Rates]] = []
    current = state
    for index, (node, weights) in enumerate(zip(NODES, _STAGES, strict=True)):
        current = _moved(state, stages, weights, h) if index else state
        rates = rates_of(body, current, mode, valued(field, fraction * node))
        stages.append(rates)
        if index in (0, 2, 3, 6):
            samples.append((node, current, rates))
    difference = _moved(State(ZERO, (0.0, 0.0, 0.0, 0.0), ZERO, ZERO), stages, _ERROR, h)
    attitude_error = max(abs(c) for c in difference.attitude)
    error = max(
        length(difference.position) / body.size, 2.0 * attitude_error, length(difference.velocity) / (body.size * pace)
    )
    error = max(error, length(difference.spin) / pace)
    return StepResult(current._replace(attitude=normalised(current.attitude)), error, samples)


def valued(field: list[Vector], x: float) -> Vector:
    """Return the value of a polynomial."""
    total = ZERO
    for c in reversed(field):
        total = added(c, x, total)
    return total


def energies(body: HullBody, state: State, gravity: Vector) -> tuple[float, float]:
    """Return the kinetic energy, and the potential energy relative to the origin of the ground [J]."""
    w = state.spin
    kinetic = 0.5 * (body.mass * dot(state.velocity, state.velocity) + dot(w, applied(body.tensor, w)))
    return kinetic, -body.mass * dot(gravity, state.position)


def slip_speed(body: HullBody, state: State, i: int) -> float:
    """Return the speed of a vertex along the ground."""
    x, y, _ = point_velocity(body, state, i)
    return math.hypot(x, y)


def levelled(body: HullBody, attitude: tuple[float, ...], members: tuple[int, ...]) -> tuple[float, ...]:
    """Return an attitude turned by the smallest angle that brings an edge or a facet onto the ground."""
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
    """Return the state at rest on a facet, with a tilt and its azimuth [rad].

    Without facet, the axes of the vertices are upright.
    """
    # the lowest vertex is on the ground, and the centre of mass above the origin
    attitude: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)
    if facet is not None:
        down = unit(body.facets[facet])
        axis = cross(down, (0.0, 0.0, -1.0))
        attitude = normalised((1.0 - down[2], *axis)) if down[2] < 1.0 - 1e-12 else (0.0, 1.0, 0.0, 0.0)
    half = 0.5 * tilt
    tilting = (math.cos(half), -math.sin(half) * math.sin(azimuth), math.sin(half) * math.cos(azimuth), 0.0)
    attitude = normalised(product(tilting, attitude))
    up = frame(attitude)[2]
    lowest = min(dot(up, p) for p in body.points)
    return State((0.0, 0.0, -lowest), attitude, ZERO, ZERO)


_TURNS, _STRAIGHT = 300, 1e-12
# Newton's method: limits of steps and bisections, angle of the finite difference
_NEWTON, _TRIES, _SWING = 20, 6, 1e-7
_NOTHING = 1e-300
_BEGIN = 6  # iterations before Newton's method for a facet with many corners


def sliding(problem: Problem, contact: HullContact, imposed: dict[int, Vector], still: float) -> Solution | None:
    """Return a candidate with the initial sliding directions of its free vertices, by iteration. None if it fails.

    `imposed` contains the directions of vertices that already slide. `still` is a limit of the slip rate: a slower
    vertex slides in the direction opposite to the former friction force.
    """
    free = [i for i in contact.members if i not in contact.stuck and i not in imposed]
    if not free or problem.friction == 0.0:
        return solve(problem, contact, {**dict.fromkeys(free, ZERO), **imposed})
    directions, up = {**dict.fromkeys(free, ZERO), **imposed}, problem.axes[2]
    sticking = solve(
        problem,
        HullContact(contact.members, tuple(i for i in contact.members if i not in imposed)),
        imposed,
    )
    if sticking is not None:
        directions.update({i: unit(scaled(-1.0, sticking.pulls[i])) for i in free})
    soft = {i: _compliance(problem, i) * problem.friction * len(free) for i in free}
    initial_directions = directions
    if len(free) < 3 and (turned := _turned(problem, contact, initial_directions, soft)) is not None:
        return turned
    for k in range(_TURNS):
        solution = solve(problem, contact, directions)
        if solution is None:
            return None
        if len(free) > CORNERS and k == _BEGIN:
            return _turned_whole(problem, solution, free, still)
        change, before = 0.0, directions
        for i in free:
            rate = problem.rate(i, solution.linear, solution.angular)
            slip = added(rate, -dot(rate, up), up)
            if length(slip) <= still and length(before[i]) > 0.0:
                continue
            new = unit(added(slip, soft[i] * max(solution.normals[i], 0.0), before[i]))  # Eq. 257
            change = max(change, length(minus(new, before[i])))
            directions = {**directions, i: new}
        if change <= _STRAIGHT:
            return solution
    return _turned(problem, contact, initial_directions, soft) if 2 < len(free) <= CORNERS else None


def _turned_whole(problem: Problem, begun: Solution, free: list[int], still: float) -> Solution | None:
    """Return the start of sliding of a facet with many corners, by Newton's method for three accelerations."""
    (x, y, up), size = problem.axes, problem.body.size

    def beside(u: FloatArray) -> tuple[Solution, FloatArray] | None:
        directions = dict(begun.directions)
        for i in free:
            rate = plus(scaled(u[0], x), scaled(u[1], y))
            rate = added(rate, u[2] / size, cross(up, problem.body.points[i]))
            rate = plus(rate, problem.bias[i]) if problem.bias else rate
            rate = added(rate, -dot(rate, up), up)
            directions[i] = unit(added(rate, max(still - length(rate), 0.0), begun.directions[i]))
        solution = solve(problem, begun.contact, directions)
        return None if solution is None else (solution, read(solution) - u)

    def read(solution: Solution) -> FloatArray:
        return np.array([dot(x, solution.linear), dot(y, solution.linear), size * dot(up, solution.angular)])

    u = read(begun)
    current = beside(u)
    for _ in range(2 * _NEWTON):
        if current is None:
            return None
        solution, residual = current
        scale, residual_norm = length(tuple(u)), length(tuple(residual))
        if residual_norm <= _STRAIGHT * scale:
            return solution
        increment = _SWING * max(scale, still)
        shifted = [beside(u + increment * axis) for axis in np.eye(3)]
        if any(s is None for s in shifted):
            return None
        step = _solved(np.array([(s[1] - residual) / increment for s in shifted if s]).T, -residual)
        if step is None:
            return None
        for k in range(2 * _TRIES):
            candidate = u + 0.5**k * step
            if (current := beside(candidate)) is None:
                return None
            if length(tuple(current[1])) < residual_norm:
                break
        u = candidate
    # accelerations below `still` define no direction
    is_close = current is not None and length(tuple(current[1])) <= max(still, 1e-9 * length(tuple(u)))
    return current[0] if current is not None and is_close else None


def _turned(
    problem: Problem, contact: HullContact, directions: dict[int, Vector], soft: dict[int, float]
) -> Solution | None:
    """Return a candidate that slides in the directions of its accelerations, by Newton's method. None if it fails."""
    up, free = problem.axes[2], list(soft)

    def across(trial: dict[int, Vector]) -> tuple[Solution, list[float], list[float]] | None:
        solution = solve(problem, contact, directions | trial)
        if solution is None:
            return None
        rates = {i: problem.rate(i, solution.linear, solution.angular) for i in free}
        scales = {i: max(soft[i] * abs(solution.normals[i]) + length(rates[i]), _NOTHING) for i in free}
        side = [dot(cross(up, trial[i]), rates[i]) / scales[i] for i in free]
        return solution, side, [dot(trial[i], rates[i]) / scales[i] for i in free]

    def turn(a: Vector, angle: float) -> Vector:
        return added(scaled(math.cos(angle), a), math.sin(angle), cross(up, a))

    rotated = {i: directions[i] for i in free}
    for _ in range(_NEWTON):
        if (current := across(rotated)) is None:
            return None
        solution, side, along = current
        size = max(map(abs, side))
        if size <= _STRAIGHT:
            against = [i for i, a in zip(free, along, strict=True) if a < -_STRAIGHT]
            if not against:
                return solution
            rotated |= {i: scaled(-1.0, rotated[i]) for i in against}
            continue
        shifted = [across(rotated | {i: turn(rotated[i], _SWING)}) for i in free]
        if any(s is None for s in shifted):
            return None
        slopes = np.array([[(b - a) / _SWING for a, b in zip(side, s[1], strict=True)] for s in shifted if s]).T
        angles = _solved(slopes, np.array(side))
        if angles is None:
            return None
        fraction = min(1.0, 0.5 / max(np.abs(angles).max(), _NOTHING))
        start = rotated
        for _ in range(_TRIES):
            rotated = {i: turn(start[i], -fraction * float(b)) for i, b in zip(free, angles, strict=True)}
            if (current := across(rotated)) is None:
                return None
            if max(map(abs, current[1])) < size:
                break
            fraction *= 0.5
    return None


def _solved(table: FloatArray, side: FloatArray) -> FloatArray | None:
    """Return the solution by Gauss elimination with pivoting, with equal bits on all processors; None if singular."""
    rows = np.column_stack([table, side])
    for k in range(len(side)):
        pivot_row = k + int(np.argmax(np.abs(rows[k:, k])))
        if not abs(rows[pivot_row, k]) > SINGULAR:
            return None
        rows[[k, pivot_row]] = rows[[pivot_row, k]]
        factors = rows[:, k] / rows[k, k]
        factors[k] = 0.0
        rows -= factors[:, None] * rows[k]
    return rows[:, -1] / rows.diagonal()


def _compliance(problem: Problem, i: int) -> float:
    """Return the larger of the compliances of a vertex along the two axes of the ground [1/kg]."""
    arm, largest = problem.body.points[i], 0.0
    for axis in problem.axes[:2]:
        turned = cross(applied(problem.body.compliance, cross(arm, axis)), arm)
        largest = max(largest, 1.0 / problem.body.mass + dot(turned, axis))
    return largest
