"""The directions in which vertices start to slide: against the friction that their acceleration overcomes."""

import math

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.hull.contact_problem import CORNERS, SINGULAR, HullContact, Problem, Solution, solve
from rocking.dynamics.hull.vectors import ZERO, Vector, added, applied, cross, dot, length, minus, scaled, unit

_TURNS, _STRAIGHT = 300, 1e-12
_NEWTON, _TRIES, _SWING = 20, 6, 1e-7  # steps, halvings, and the angle by which a direction is turned for the slope
_NOTHING = 1e-300


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
    for _ in range(_TURNS):
        found = solve(problem, contact, directions)
        if found is None:
            return None
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
