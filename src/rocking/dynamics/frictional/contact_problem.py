"""Forces or impulses on a set of touching vertices. The same problem applies to accelerations and to velocities.

A candidate contact is a face of the hull or a subset of its border. Its vertices stick or slide. A candidate is a
linear system of at most six unknowns (docs/theory/hull.md).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import combinations

from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.ground import (
    ZERO,
    Frame,
    Vector,
    added,
    applied,
    cross,
    dot,
    length,
    minus,
    plus,
    scaled,
    unit,
)

SINGULAR = 1e-12
CORNERS = 8  # largest number of corners of a facet for which single sticking corners are tried
_TURNS = 20  # largest number of iterations for the set of corners under pressure

Wrench = tuple[Vector, Vector]


@dataclass(frozen=True)
class HullContact:
    """Vertices in contact, and the sticking vertices among them."""

    members: tuple[int, ...]
    stuck: tuple[int, ...] = ()


FLIGHT = HullContact(())


@dataclass
class Problem:
    """Motion without contact forces, and points of action of the forces."""

    body: HullBody
    axes: Frame  # axes of the ground in those of the body
    linear: Vector  # acceleration of the centre of mass without contact, or velocity before the impact, in body axes
    angular: Vector
    friction: float
    bias: dict[int, Vector] = field(default_factory=dict)  # w x (w x r) of each vertex; empty in impacts
    force_points: dict[int, Vector] = field(default_factory=dict)  # points of action of impulses, if not at the vertex

    def rate(self, i: int, linear: Vector, angular: Vector) -> Vector:
        """Return the acceleration or velocity of a vertex."""
        free = plus(linear, cross(angular, self.body.points[i]))  # Eq. 250
        return plus(free, self.bias[i]) if self.bias else free

    def force_point(self, i: int) -> Vector:
        """Return the point of action of the force of a vertex."""
        return self.force_points.get(i, self.body.points[i]) if self.force_points else self.body.points[i]


@dataclass
class Solution:
    """Motion and forces of a candidate."""

    contact: HullContact
    linear: Vector
    angular: Vector
    normals: dict[int, float]
    directions: dict[int, Vector]  # directions of sliding, of the sliding vertices
    pulls: dict[int, Vector]  # forces along the ground, at the sticking vertices
    shape: tuple[float, ...] = ()  # linear distribution of more than three normal forces


def solve(problem: Problem, contact: HullContact, directions: dict[int, Vector]) -> Solution | None:
    """Return accelerations and forces of a candidate with given directions of sliding; None if there is no solution."""
    if not contact.members:
        return Solution(contact, problem.linear, problem.angular, {}, {}, {})
    loaded = list(contact.members)
    for _ in range(_TURNS if len(contact.members) > CORNERS else 0):
        # iterate the vertices under a linear pressure
        solution = linear(problem, contact, loaded, directions)
        if solution is None:
            break
        a, b, c = solution.shape
        x, y, _ = problem.axes
        points = [(i, problem.force_point(i)) for i in contact.members]
        compressed = [i for i, point in points if a + b * dot(x, point) + c * dot(y, point) >= 0.0]
        if compressed == loaded:
            return solution
        if len(compressed) <= 3:
            break
        loaded = compressed
    loaded = list(contact.members)
    while True:
        solution = linear(problem, contact, loaded, directions)
        if solution is None or len(contact.members) <= 3:
            return solution
        before, normals = len(loaded), solution.normals
        for _ in range(max(before // 16, 1)):
            weakest = min(loaded, key=lambda i: normals[i])
            if normals[weakest] >= 0.0 or len(loaded) == 3:
                break
            loaded.remove(weakest)
        if len(loaded) == before:
            return solution


def linear(problem: Problem, contact: HullContact, loaded: list[int], directions: dict[int, Vector]) -> Solution | None:
    """Return the solution that keeps the contact closed by forces at the loaded vertices. The forces may be tensile."""
    weights = _weights(problem, loaded)
    rows = [_normal_row(problem, shape) for shape in weights]
    columns = [_normal_column(problem, shape, directions) for shape in weights]
    stuck = contact.stuck
    if stuck:
        _stick(problem, stuck, columns, rows)
    answer = _eliminated(problem, columns, rows)
    if answer is None:
        return None
    force, moment = ZERO, ZERO
    for c, (f, m) in zip(answer, columns, strict=True):
        force, moment = added(force, c, f), added(moment, c, m)
    centre_rate = added(problem.linear, 1.0 / problem.body.mass, force)
    angular = plus(problem.angular, applied(problem.body.compliance, moment))
    normals = dict.fromkeys(contact.members, 0.0)
    for c, weight_of in zip(answer, weights, strict=False):
        for i, w in weight_of.items():
            normals[i] += c * w
    pulls = {} if problem.friction == math.inf else _pulls(problem, stuck, normals, answer[len(weights) :])
    return Solution(contact, centre_rate, angular, normals, directions, pulls, tuple(answer[:3]))


def _weights(problem: Problem, loaded: list[int]) -> list[dict[int, float]]:
    """Return the distributions of the normal forces: one per vertex, or linear in position above three vertices."""
    if len(loaded) <= 3:
        return [{i: 1.0} for i in loaded]
    level = [{i: dot(axis, problem.force_point(i)) for i in loaded} for axis in problem.axes[:2]]
    return [dict.fromkeys(loaded, 1.0), *level]  # Eq. 253


def _normal_column(problem: Problem, weights: dict[int, float], directions: dict[int, Vector]) -> Wrench:
    force = moment = ZERO
    for i, w in weights.items():
        up = problem.axes[2]
        push = added(up, -problem.friction, directions[i]) if i in directions else up
        force, moment = added(force, w, push), added(moment, w, cross(problem.force_point(i), push))
    return force, moment


def _normal_row(problem: Problem, weights: dict[int, float]) -> tuple[Wrench, float]:
    force, moment, bias, up = ZERO, ZERO, 0.0, problem.axes[2]
    for i, w in weights.items():
        force, moment = added(force, w, up), added(moment, w, cross(problem.body.points[i], up))
        bias += w * dot(up, problem.bias[i]) if problem.bias else 0.0
    return (force, moment), bias


def _stick(problem: Problem, stuck: tuple[int, ...], columns: list[Wrench], rows: list[tuple[Wrench, float]]) -> None:
    """Add the tangential forces of sticking vertices: two components, and a couple that prevents rotation."""
    points, up, weight = problem.body.points, problem.axes[2], 1.0 / len(stuck)
    force_point = motion_point = bias = ZERO  # mean values; if all forces act at the vertices, the matrix is symmetric
    for i in stuck:
        force_point, motion_point = (
            added(force_point, weight, problem.force_point(i)),
            added(motion_point, weight, points[i]),
        )
        bias = added(bias, weight, problem.bias[i]) if problem.bias else bias
    for axis in problem.axes[:2]:
        columns.append((axis, cross(force_point, axis)))
        rows.append(((axis, cross(motion_point, axis)), dot(axis, bias)))
    if len(stuck) > 1:
        first, other = stuck[0], stuck[len(stuck) // 2]
        across = cross(up, minus(points[other], points[first]))
        turn = dot(across, minus(problem.bias[other], problem.bias[first])) if problem.bias else 0.0
        columns.append((ZERO, up))
        rows.append(((ZERO, up), turn / dot(across, across)))


def _eliminated(problem: Problem, columns: list[Wrench], rows: list[tuple[Wrench, float]]) -> list[float] | None:
    """Return the multipliers by Gauss elimination; None if a pivot is not positive."""
    n, mass = len(columns), problem.body.mass
    soft = [(scaled(1.0 / mass, f), applied(problem.body.compliance, m)) for f, m in columns]
    table = []
    for (f, m), bias in rows:
        line = [dot(f, cf) + dot(m, cm) for cf, cm in soft]
        line.append(-(dot(f, problem.linear) + dot(m, problem.angular) + bias))  # Eq. 252
        table.append(line)
    sizes = [SINGULAR * table[k][k] for k in range(n)]
    for k in range(n):
        pivot = table[k][k]
        if not pivot > sizes[k]:
            return None
        for j in range(k + 1, n):
            factor = table[j][k] / pivot
            if factor:
                for c in range(k + 1, n + 1):
                    table[j][c] -= factor * table[k][c]
    multipliers = [0.0] * n
    for k in range(n - 1, -1, -1):
        total = table[k][n]
        for c in range(k + 1, n):
            total -= table[k][c] * multipliers[c]
        multipliers[k] = total / table[k][k]
    return multipliers


def _pulls(
    problem: Problem, stuck: tuple[int, ...], normals: dict[int, float], multipliers: list[float]
) -> dict[int, Vector]:
    """Return the tangential forces of sticking vertices.

    They are divided in proportion to normal forces and resistance to rotation.
    """
    if not stuck:
        return {}
    x, y, up = problem.axes
    total = plus(scaled(multipliers[0], x), scaled(multipliers[1], y))
    if len(stuck) == 1:
        return {stuck[0]: total}
    weights = {i: max(normals[i], 0.0) for i in stuck}
    weight = sum(weights.values())
    if not weight > 0.0:
        weights, weight = dict.fromkeys(stuck, 1.0), float(len(stuck))
    arms = {i: problem.force_point(i) for i in stuck}
    loaded_centre = mean_centre = ZERO
    for i in stuck:
        loaded_centre = added(loaded_centre, weights[i] / weight, arms[i])
        mean_centre = added(mean_centre, 1.0 / len(stuck), arms[i])
    couple = multipliers[2] + dot(up, cross(minus(mean_centre, loaded_centre), total))
    tangents = {i: cross(up, minus(arms[i], loaded_centre)) for i in stuck}
    resistance = sum(weights[i] * dot(tangents[i], tangents[i]) for i in stuck)
    rate = couple / resistance if resistance > 0.0 else 0.0
    # Eq. 255
    forces = {i: scaled(weights[i], plus(scaled(1.0 / weight, total), scaled(rate, tangents[i]))) for i in stuck}
    if len(stuck) > 2:
        return forces
    # along an edge, only the sum of the two forces is determined; it is divided by the remaining friction of the ends
    along = unit(minus(arms[stuck[1]], arms[stuck[0]]))
    across = {i: added(pull, -dot(pull, along), along) for i, pull in forces.items()}
    squares = {i: (problem.friction * weights[i]) ** 2 - dot(across[i], across[i]) for i in stuck}
    capacity = {i: math.sqrt(max(square, 0.0)) for i, square in squares.items()}  # Eq. 256
    total_capacity = sum(capacity.values())
    if not total_capacity > 0.0:
        return forces
    return {i: added(across[i], capacity[i] / total_capacity * dot(total, along), along) for i in stuck}


def faces(
    problem: Problem, touching: tuple[int, ...], staying: tuple[int, ...] | None = None
) -> Iterator[tuple[int, ...]]:
    """Yield possible contacts of touching vertices: all vertices, the edges of their border, single vertices.

    `staying` contains the vertices that do not leave, by default all. A chord with vertices beyond it is not an edge.
    """
    border, staying_set = outline(problem, touching), set(touching if staying is None else staying)
    if len(border) > 2 and staying_set.issuperset(border):
        yield border
    if len(border) > 1:
        for k, i in enumerate(border if len(border) > 2 else border[:1]):
            next_vertex = border[(k + 1) % len(border)]
            if i in staying_set and next_vertex in staying_set:
                yield i, next_vertex
    for i in border:
        if i in staying_set:
            yield (i,)


def outline(problem: Problem, touching: tuple[int, ...]) -> tuple[int, ...]:
    """Return the vertices of the convex polygon of points on the ground, in order (Andrew's monotone chain)."""
    x, y, _ = problem.axes
    points = sorted((dot(x, problem.body.points[i]), dot(y, problem.body.points[i]), i) for i in touching)
    if len(points) < 3:
        return tuple(i for _, _, i in points)
    slack = 1e-10 * problem.body.size**2

    def chain(ordered: list[tuple[float, float, int]]) -> list[tuple[float, float, int]]:
        hull: list[tuple[float, float, int]] = []
        for p in ordered:
            while len(hull) > 1:
                (ax, ay, _), (bx, by, _) = hull[-2:]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > slack:
                    break
                hull.pop()
            hull.append(p)
        return hull[:-1]

    return tuple(i for _, _, i in chain(points) + chain(points[::-1]))


def friction_states(members: tuple[int, ...], resting: tuple[int, ...]) -> Iterator[HullContact]:
    """Yield contacts with different sets of sticking vertices: all, all but one, a single one, none."""
    if len(resting) == len(members) or len(resting) < 2:
        yield HullContact(members, resting)
    if len(resting) > 1 and len(members) <= CORNERS:
        # a facet with two sticking vertices cannot move along the ground
        sizes = (1,) if len(members) > 2 else range(len(resting) - 1, 0, -1)
        for n in sizes:
            yield from (HullContact(members, subset) for subset in combinations(resting, n))
    if resting:
        yield HullContact(members)


def valid(problem: Problem, solution: Solution, touching: tuple[int, ...], slack: float) -> bool:
    """Return True if no force is tensile, no force exceeds the friction, and no gap closes."""
    mass, mu = problem.body.mass, problem.friction
    if any(n < -slack * mass for n in solution.normals.values()):
        return False
    if any(length(pull) > mu * solution.normals[i] + slack * mass * (1.0 + mu) for i, pull in solution.pulls.items()):
        return False
    return clear(problem, solution, touching, slack)  # Eq. 251


def clear(problem: Problem, solution: Solution, touching: tuple[int, ...], slack: float) -> bool:
    """Return True if no gap closes."""
    up, others = problem.axes[2], (i for i in touching if i not in solution.contact.members)
    return all(dot(up, problem.rate(i, solution.linear, solution.angular)) >= -slack for i in others)


def min_tension(
    problem: Problem, candidates: list[Solution], touching: tuple[int, ...], slack: float
) -> Solution | None:
    """Return the candidate without a closing gap and with the smallest tension. None of them satisfies all laws."""
    clear_ones = [c for c in candidates if c.contact.members and clear(problem, c, touching, slack)]
    compressive = (c for c in clear_ones if min(c.normals.values()) >= -slack * problem.body.mass)
    return next(compressive, None) or max(clear_ones, key=lambda c: min(c.normals.values()), default=None)
