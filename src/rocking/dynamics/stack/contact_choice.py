"""Impacts and openings of joints that stick: a complementarity problem over all corners (docs/theory/stacks.md)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from rocking.dynamics.stack.chain import Chain, Sides, Vector, solved

_ROUNDING = 1e-12
_MOST_EXCHANGES = 1000


@dataclass
class CornerRow:
    """Row of the problem: a direction at one corner of a joint."""

    joint: int
    side: int
    direction: Vector
    point: Vector
    is_one_sided: bool


@dataclass
class CornerSolution:
    """Solution of the problem: change of velocity or acceleration, and contacts."""

    rows: list[CornerRow]
    motion: list[float]  # x, z and rotation of every body, after the impact or with the forces
    multipliers: list[float]  # impulses or forces
    gaps: list[float]  # velocities or accelerations of the corners along the rows
    active: list[bool] = field(default_factory=list)

    def side_of(self, joint: int) -> int | None:
        """Return the corner of a joint that stays in contact: 0 both, None no corner."""
        active = {
            row.side
            for row, kept in zip(self.rows, self.active, strict=True)
            if row.joint == joint and row.is_one_sided and kept
        }
        return 0 if len(active) == 2 else active.pop() if active else None


def corner_rows(chain: Chain, sides: Sides, rotation: Sequence[float], flat: set[int]) -> list[CornerRow]:
    """Return the rows of all corners in contact: both corners of flat joints, and the pivots of the other joints."""
    points = chain.positions(sides, rotation)[0]
    rows = []
    for joint, point in enumerate(points):
        angle = chain.face(joint, sides, rotation)
        along, up = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
        own = sides[joint] or 1
        rows.append(CornerRow(joint, own, along, point, is_one_sided=False))
        rows.append(CornerRow(joint, own, up, point, is_one_sided=True))
        if joint in flat:
            step = -own * chain.width[joint]
            other = (point[0] + step * along[0], point[1] + step * along[1])
            rows.append(CornerRow(joint, -own, up, other, is_one_sided=True))
    return rows


def after_impact(
    chain: Chain,
    sides: Sides,
    rotation: Sequence[float],
    rates: Sequence[float],
    flat: set[int],
    *,
    keeps_contact: bool = False,
) -> CornerSolution:
    """Return the velocities after a plastic impact of the open joints in `flat`. The other flat joints are closed.

    With `keeps_contact`, no corner leaves the contact: the projection has equalities only.
    """
    rows = corner_rows(chain, sides, rotation, flat)
    for row in rows:
        row.is_one_sided = row.is_one_sided and not keeps_contact
    velocities = chain.velocities(sides, rotation, rates)
    before = [value for v, rate in zip(velocities, rates, strict=True) for value in (*v, rate)]
    jacobian = _jacobian(chain, sides, rotation, rows)
    return _solved_problem(chain, rows, jacobian, before, [0.0] * len(rows))  # Eq. 361


def under_forces(
    chain: Chain, sides: Sides, rotation: Sequence[float], rates: Sequence[float], ground: Vector
) -> CornerSolution:
    """Return the accelerations of all corners in contact. Pivots of open joints keep their contact."""
    closed = {joint for joint, side in enumerate(sides) if side == 0}
    rows = corner_rows(chain, sides, rotation, closed)
    for row in rows:
        row.is_one_sided = row.is_one_sided and row.joint in closed
    free = [value for _ in range(chain.count) for value in (-ground[0], -chain.gravity - ground[1], 0.0)]
    ends = chain.positions(sides, rotation)[1]
    offsets = []
    for row in rows:
        below = row.joint - 1
        ax, az = (-(rates[row.joint] ** 2) * (row.point[k] - ends[row.joint][k]) for k in (0, 1))
        if below >= 0:
            ax, az = (a + rates[below] ** 2 * (row.point[k] - ends[below][k]) for k, a in enumerate((ax, az)))
        offsets.append(row.direction[0] * ax + row.direction[1] * az)
    return _solved_problem(chain, rows, _jacobian(chain, sides, rotation, rows), free, offsets)


def _jacobian(chain: Chain, sides: Sides, rotation: Sequence[float], rows: list[CornerRow]) -> list[list[float]]:
    ends = chain.positions(sides, rotation)[1]
    jacobian = []
    for row in rows:
        (dx, dz), line = row.direction, [0.0] * (3 * chain.count)
        for body, sign in ((row.joint, 1.0), (row.joint - 1, -1.0)):
            if body >= 0:
                x, z = row.point[0] - ends[body][0], row.point[1] - ends[body][1]
                line[3 * body : 3 * body + 3] = [sign * dx, sign * dz, sign * (z * dx - x * dz)]
        jacobian.append(line)
    return jacobian


def _solved_problem(
    chain: Chain, rows: list[CornerRow], jacobian: list[list[float]], free: list[float], offsets: list[float]
) -> CornerSolution:
    """Return the projection of the free motion. The symmetric positive definite problem has one solution."""
    inverse = [value for m, i in zip(chain.mass, chain.inertia, strict=True) for value in (1 / m, 1 / m, 1 / i)]
    weighted = [[value * w for value, w in zip(row, inverse, strict=True)] for row in jacobian]
    matrix = [[_product(row, other) for other in jacobian] for row in weighted]
    right = [_product(row, free) + offset for row, offset in zip(jacobian, offsets, strict=True)]
    active, scale = [True] * len(rows), max((abs(value) for value in right), default=0.0)
    for _ in range(_MOST_EXCHANGES):  # exchanges of the lowest index (Murty 1974) end after finite steps
        multipliers = _equalities(matrix, right, active)
        gaps = [_product(row, multipliers) + value for row, value in zip(matrix, right, strict=True)]
        size = max((abs(value) for value in multipliers), default=0.0)
        wrong = [
            k for k, row in enumerate(rows)
            if row.is_one_sided and (multipliers[k] < -_ROUNDING * size or gaps[k] < -_ROUNDING * scale)
        ]  # fmt: skip
        if not wrong:  # Eq. 362
            break
        active[wrong[0]] = not active[wrong[0]]
    motion = list(free)
    for row, multiplier in zip(weighted, multipliers, strict=True):
        motion = [value + change * multiplier for value, change in zip(motion, row, strict=True)]
    return CornerSolution(rows, motion, multipliers, gaps, active)


def _equalities(matrix: list[list[float]], right: list[float], active: list[bool]) -> list[float]:
    kept = [k for k, is_active in enumerate(active) if is_active]
    values = solved([[matrix[i][j] for j in kept] for i in kept], [-right[i] for i in kept])
    result = [0.0] * len(right)
    for k, value in zip(kept, values, strict=True):
        result[k] = value
    return result


def _product(left: Sequence[float], right: Sequence[float]) -> float:
    total = 0.0
    for a, b in zip(left, right, strict=True):
        total += a * b
    return total
