"""Forces or impulses on a set of touching vertices: one problem for accelerations and for velocities.

What stays is a face of the hull or a part of its border, and each of its vertices sticks or slides: every candidate is
a linear system of at most six unknowns (docs/theory/hull.md).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import combinations

from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.ground import (
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
CORNERS = 8  # of a facet with more no single one sticks
_TURNS = 20  # in which the corners that a pressure pushes are found

Wrench = tuple[Vector, Vector]


@dataclass(frozen=True)
class HullContact:
    """Which vertices stay on the ground, and which of them stick."""

    members: tuple[int, ...]
    stuck: tuple[int, ...] = ()


FLIGHT = HullContact(())


@dataclass
class Problem:
    """What would happen without forces, and where they act."""

    body: HullBody
    axes: Frame  # axes of the ground in those of the body
    linear: Vector  # acceleration of the centre without contact, or its velocity before the impact, in axes of the body
    angular: Vector
    friction: float
    bias: dict[int, Vector] = field(default_factory=dict)  # w x (w x r) of each vertex; none in impacts
    places: dict[int, Vector] = field(default_factory=dict)  # where the impulse of a vertex acts, if not at the vertex

    def rate(self, i: int, linear: Vector, angular: Vector) -> Vector:
        """Return the acceleration or velocity of a vertex."""
        free = plus(linear, cross(angular, self.body.points[i]))  # Eq. 250
        return plus(free, self.bias[i]) if self.bias else free

    def place(self, i: int) -> Vector:
        """Return where the force of a vertex acts."""
        return self.places.get(i, self.body.points[i]) if self.places else self.body.points[i]


@dataclass
class Solution:
    """What a candidate does."""

    contact: HullContact
    linear: Vector
    angular: Vector
    normals: dict[int, float]
    directions: dict[int, Vector]  # of those that slide
    pulls: dict[int, Vector]  # forces along the ground of those that stick
    shape: tuple[float, ...] = ()  # of the normal forces of more than three


def solve(problem: Problem, contact: HullContact, directions: dict[int, Vector]) -> Solution | None:
    """Return accelerations and forces of a candidate with given directions of sliding; None where there are none."""
    if not contact.members:
        return Solution(contact, problem.linear, problem.angular, {}, {}, {})
    carrying = list(contact.members)
    for _ in range(_TURNS if len(contact.members) > CORNERS else 0):
        # those that a linear pressure pushes, until it is theirs
        found = linear(problem, contact, carrying, directions)
        if found is None:
            break
        a, b, c = found.shape
        x, y, _ = problem.axes
        places = [(i, problem.place(i)) for i in contact.members]
        pushed = [i for i, at in places if a + b * dot(x, at) + c * dot(y, at) >= 0.0]
        if pushed == carrying:
            return found
        if len(pushed) <= 3:
            break
        carrying = pushed
    carrying = list(contact.members)
    while True:
        found = linear(problem, contact, carrying, directions)
        if found is None or len(contact.members) <= 3:
            return found
        before, normals = len(carrying), found.normals
        for _ in range(max(before // 16, 1)):
            least = min(carrying, key=lambda i: normals[i])
            if normals[least] >= 0.0 or len(carrying) == 3:
                break
            carrying.remove(least)
        if len(carrying) == before:
            return found


def linear(
    problem: Problem, contact: HullContact, carrying: list[int], directions: dict[int, Vector]
) -> Solution | None:
    """Return what certain forces do, pulled or not, so that the vertices of the contact stay on the ground."""
    weights = _weights(problem, carrying)
    rows = [_normal_row(problem, share) for share in weights]
    columns = [_normal_column(problem, share, directions) for share in weights]
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
    for c, share_of in zip(answer, weights, strict=False):
        for i, w in share_of.items():
            normals[i] += c * w
    pulls = {} if problem.friction == math.inf else _pulls(problem, stuck, normals, answer[len(weights) :])
    return Solution(contact, centre_rate, angular, normals, directions, pulls, tuple(answer[:3]))


def _weights(problem: Problem, carrying: list[int]) -> list[dict[int, float]]:
    """Return the shapes of the normal forces: of each vertex, or linear in its place where more than three carry."""
    if len(carrying) <= 3:
        return [{i: 1.0} for i in carrying]
    level = [{i: dot(axis, problem.place(i)) for i in carrying} for axis in problem.axes[:2]]
    return [dict.fromkeys(carrying, 1.0), *level]  # Eq. 253


def _normal_column(problem: Problem, share: dict[int, float], directions: dict[int, Vector]) -> Wrench:
    force = moment = ZERO
    for i, w in share.items():
        up = problem.axes[2]
        push = added(up, -problem.friction, directions[i]) if i in directions else up
        force, moment = added(force, w, push), added(moment, w, cross(problem.place(i), push))
    return force, moment


def _normal_row(problem: Problem, share: dict[int, float]) -> tuple[Wrench, float]:
    force, moment, known, up = ZERO, ZERO, 0.0, problem.axes[2]
    for i, w in share.items():
        force, moment = added(force, w, up), added(moment, w, cross(problem.body.points[i], up))
        known += w * dot(up, problem.bias[i]) if problem.bias else 0.0
    return (force, moment), known


def _stick(problem: Problem, stuck: tuple[int, ...], columns: list[Wrench], rows: list[tuple[Wrench, float]]) -> None:
    """Add the forces along the ground that make vertices stick: two, and a couple that keeps them from turning."""
    points, up, share = problem.body.points, problem.axes[2], 1.0 / len(stuck)
    acts = moves = known = ZERO  # means: the matrix is symmetric where the forces are at the vertices
    for i in stuck:
        acts, moves = added(acts, share, problem.place(i)), added(moves, share, points[i])
        known = added(known, share, problem.bias[i]) if problem.bias else known
    for axis in problem.axes[:2]:
        columns.append((axis, cross(acts, axis)))
        rows.append(((axis, cross(moves, axis)), dot(axis, known)))
    if len(stuck) > 1:
        first, other = stuck[0], stuck[len(stuck) // 2]
        across = cross(up, minus(points[other], points[first]))
        turn = dot(across, minus(problem.bias[other], problem.bias[first])) if problem.bias else 0.0
        columns.append((ZERO, up))
        rows.append(((ZERO, up), turn / dot(across, across)))


def _eliminated(problem: Problem, columns: list[Wrench], rows: list[tuple[Wrench, float]]) -> list[float] | None:
    """Solve for the multipliers by Gauss; None where a pivot is not positive, so that no force answers a motion."""
    n, mass = len(columns), problem.body.mass
    soft = [(scaled(1.0 / mass, f), applied(problem.body.compliance, m)) for f, m in columns]
    table = []
    for (f, m), known in rows:
        line = [dot(f, cf) + dot(m, cm) for cf, cm in soft]
        line.append(-(dot(f, problem.linear) + dot(m, problem.angular) + known))  # Eq. 252
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
    answer = [0.0] * n
    for k in range(n - 1, -1, -1):
        total = table[k][n]
        for c in range(k + 1, n):
            total -= table[k][c] * answer[c]
        answer[k] = total / table[k][k]
    return answer


def _pulls(
    problem: Problem, stuck: tuple[int, ...], normals: dict[int, float], parts: list[float]
) -> dict[int, Vector]:
    """Share what holds the sticking vertices as their normal forces are shared, and as these would resist turning."""
    if not stuck:
        return {}
    x, y, up = problem.axes
    total = plus(scaled(parts[0], x), scaled(parts[1], y))
    if len(stuck) == 1:
        return {stuck[0]: total}
    weights = {i: max(normals[i], 0.0) for i in stuck}
    weight = sum(weights.values())
    if not weight > 0.0:
        weights, weight = dict.fromkeys(stuck, 1.0), float(len(stuck))
    arms = {i: problem.place(i) for i in stuck}
    loaded = even = ZERO
    for i in stuck:
        loaded = added(loaded, weights[i] / weight, arms[i])
        even = added(even, 1.0 / len(stuck), arms[i])
    couple = parts[2] + dot(up, cross(minus(even, loaded), total))
    turning = {i: cross(up, minus(arms[i], loaded)) for i in stuck}
    resistance = sum(weights[i] * dot(turning[i], turning[i]) for i in stuck)
    rate = couple / resistance if resistance > 0.0 else 0.0
    # Eq. 255
    shares = {i: scaled(weights[i], plus(scaled(1.0 / weight, total), scaled(rate, turning[i]))) for i in stuck}
    if len(stuck) > 2:
        return shares
    # along an edge only the sum is determined: each end takes of it what its cone leaves
    along = unit(minus(arms[stuck[1]], arms[stuck[0]]))
    across = {i: added(pull, -dot(pull, along), along) for i, pull in shares.items()}
    most = {i: (problem.friction * weights[i]) ** 2 - dot(across[i], across[i]) for i in stuck}
    room = {i: math.sqrt(max(square, 0.0)) for i, square in most.items()}  # Eq. 256
    whole = sum(room.values())
    if not whole > 0.0:
        return shares
    return {i: added(across[i], room[i] / whole * dot(total, along), along) for i in stuck}


def faces(
    problem: Problem, touching: tuple[int, ...], staying: tuple[int, ...] | None = None
) -> Iterator[tuple[int, ...]]:
    """Yield what may stay of the touching vertices: all, the edges of their border, single ones.

    staying: those that do not leave, if not all; a chord between two of them, with others beyond it, is no edge.
    """
    border, stays = outline(problem, touching), set(touching if staying is None else staying)
    if len(border) > 2 and stays.issuperset(border):
        yield border
    if len(border) > 1:
        for k, i in enumerate(border if len(border) > 2 else border[:1]):
            after = border[(k + 1) % len(border)]
            if i in stays and after in stays:
                yield i, after
    for i in border:
        if i in stays:
            yield (i,)


def outline(problem: Problem, touching: tuple[int, ...]) -> tuple[int, ...]:
    """Return the vertices of the convex polygon of points on the ground, in order (Andrew's monotone chain)."""
    x, y, _ = problem.axes
    places = sorted((dot(x, problem.body.points[i]), dot(y, problem.body.points[i]), i) for i in touching)
    if len(places) < 3:
        return tuple(i for _, _, i in places)
    slack = 1e-10 * problem.body.size**2

    def chain(ordered: list[tuple[float, float, int]]) -> list[tuple[float, float, int]]:
        kept: list[tuple[float, float, int]] = []
        for p in ordered:
            while len(kept) > 1:
                (ax, ay, _), (bx, by, _) = kept[-2:]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > slack:
                    break
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return tuple(i for _, _, i in chain(places) + chain(places[::-1]))


def friction_states(members: tuple[int, ...], still: tuple[int, ...]) -> Iterator[HullContact]:
    """Yield which of the vertices that do not slide yet stick: all, all but one, one, none."""
    if len(still) == len(members) or len(still) < 2:
        yield HullContact(members, still)
    if len(still) > 1 and len(members) <= CORNERS:
        # two sticking vertices of a facet make it rest
        sizes = (1,) if len(members) > 2 else range(len(still) - 1, 0, -1)
        for n in sizes:
            yield from (HullContact(members, part) for part in combinations(still, n))
    if still:
        yield HullContact(members)


def valid(problem: Problem, found: Solution, touching: tuple[int, ...], slack: float) -> bool:
    """Whether no force pulls, no sticking one takes more friction than there is, and no gap closes."""
    mass, mu = problem.body.mass, problem.friction
    if any(n < -slack * mass for n in found.normals.values()):
        return False
    if any(length(pull) > mu * found.normals[i] + slack * mass * (1.0 + mu) for i, pull in found.pulls.items()):
        return False
    return clear(problem, found, touching, slack)  # Eq. 251


def clear(problem: Problem, found: Solution, touching: tuple[int, ...], slack: float) -> bool:
    """Whether no gap closes."""
    up, free = problem.axes[2], (i for i in touching if i not in found.contact.members)
    return all(dot(up, problem.rate(i, found.linear, found.angular)) >= -slack for i in free)


def least_pull(
    problem: Problem, candidates: list[Solution], touching: tuple[int, ...], slack: float
) -> Solution | None:
    """Return what stands in where no candidate obeys every law: no gap closes, and the ground pulls least."""
    kept = [c for c in candidates if c.contact.members and clear(problem, c, touching, slack)]
    pushed = (c for c in kept if min(c.normals.values()) >= -slack * problem.body.mass)
    return next(pushed, None) or max(kept, key=lambda c: min(c.normals.values()), default=None)
