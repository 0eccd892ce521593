"""Equations of a stack whose joints stick: bodies that turn about corners of the joints (docs/theory/stacks.md)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from rocking.bodies.stack import Stack

Vector = tuple[float, float]
Sides = tuple[int, ...]  # corner of every joint: 1 right, -1 left, 0 both


class JointForce(NamedTuple):
    """Force of a joint on the bodies above, in the directions of its face."""

    left: float  # normal force at the left corner of a closed joint [N]
    right: float  # normal force at the right corner of a closed joint [N]
    normal: float  # normal force [N]
    tangential: float  # force along the face [N]


def turned(angle: float, vector: Vector) -> Vector:
    """Return a vector after a clockwise rotation [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return vector[0] * c + vector[1] * s, vector[1] * c - vector[0] * s


def solved(matrix: list[list[float]], vector: list[float]) -> list[float]:
    """Return x of ``A x = b`` by elimination with the largest pivots."""
    rows = [[*row, value] for row, value in zip(matrix, vector, strict=True)]
    count = len(rows)
    for k in range(count):
        top = max(range(k, count), key=lambda i: abs(rows[i][k]))
        rows[k], rows[top] = rows[top], rows[k]
        for i in range(k + 1, count):
            factor = rows[i][k] / rows[k][k]
            for j in range(k, count + 1):
                rows[i][j] -= factor * rows[k][j]
    result = [0.0] * count
    for k in reversed(range(count)):
        value = rows[k][count]
        for j in range(k + 1, count):
            value -= rows[k][j] * result[j]
        result[k] = value / rows[k][k]
    return result


@dataclass(frozen=True)
class Chain:
    """Masses and points of a stack in its initial position."""

    mass: list[float]
    inertia: list[float]  # about the centres of mass [kg m2]
    centre: list[Vector]
    corner: list[dict[int, Vector]]  # corners of every joint, by side
    above: list[dict[int, bool]]  # True if the corner belongs to the upper body, by side
    width: list[float]
    gravity: float

    @classmethod
    def of(cls, stack: Stack, gravity: float) -> "Chain":
        joints = stack.joints
        return cls(
            [float(body.mass) for body in stack.bodies], [float(body.moment_of_inertia) for body in stack.bodies],
            list(stack.centres), [{1: (j.right, j.height), -1: (j.left, j.height)} for j in joints],
            [{1: j.right_above, -1: j.left_above} for j in joints], [j.width for j in joints], gravity,
        )  # fmt: skip

    @property
    def count(self) -> int:
        """Number of bodies."""
        return len(self.mass)

    def pivot(self, joint: int, sides: Sides) -> Vector:
        """Return the corner of a joint about which the upper body turns. For a closed joint: the right corner."""
        return self.corner[joint][sides[joint] or 1]

    def arms(self, sides: Sides, rotation: Sequence[float]) -> list[list[Vector]]:
        """Return the rotated vectors along the chain to every centre of mass, one for every body below."""
        pivots = [self.pivot(joint, sides) for joint in range(self.count)]
        links = [
            turned(rotation[i], (pivots[i + 1][0] - pivots[i][0], pivots[i + 1][1] - pivots[i][1]))
            for i in range(self.count - 1)
        ]
        ends = [
            turned(rotation[i], (self.centre[i][0] - pivots[i][0], self.centre[i][1] - pivots[i][1]))
            for i in range(self.count)
        ]
        return [[*links[:i], ends[i]] for i in range(self.count)]

    def positions(self, sides: Sides, rotation: Sequence[float]) -> tuple[list[Vector], list[Vector]]:
        """Return the pivots of the joints and the centres of mass."""
        arms = self.arms(sides, rotation)
        points = [self.pivot(0, sides)]
        for arm in arms[-1][:-1]:
            points.append((points[-1][0] + arm[0], points[-1][1] + arm[1]))  # Eq. 358
        ends = [(p[0] + row[-1][0], p[1] + row[-1][1]) for p, row in zip(points, arms, strict=True)]
        return points, ends

    def velocities(self, sides: Sides, rotation: Sequence[float], rates: Sequence[float]) -> list[Vector]:
        """Return the velocities of the centres of mass."""
        return [_turning(row, rates) for row in self.arms(sides, rotation)]

    def energy(self, sides: Sides, rotation: Sequence[float], rates: Sequence[float]) -> tuple[float, float]:
        """Return kinetic energy, and potential energy above the initial position [J]."""
        velocities = self.velocities(sides, rotation, rates)
        ends = self.positions(sides, rotation)[1]
        kinetic = potential = 0.0
        for i, (vx, vz) in enumerate(velocities):
            kinetic += 0.5 * (self.mass[i] * (vx * vx + vz * vz) + self.inertia[i] * rates[i] * rates[i])
            potential += self.mass[i] * self.gravity * (ends[i][1] - self.centre[i][1])
        return kinetic, potential

    def angular_accelerations(
        self, sides: Sides, rotation: Sequence[float], rates: Sequence[float], ground: Vector
    ) -> list[float]:
        """Return theta'' of every body. `ground` is the acceleration of the ground."""
        arms = self.arms(sides, rotation)
        groups = _groups(sides)
        count = max(groups) + 1
        matrix = [[0.0] * count for _ in range(count)]
        right = [0.0] * count
        for i, row in enumerate(arms):
            ways = [(0.0, 0.0)] * count
            cx, cz = -ground[0], -self.gravity - ground[1]
            for j, (x, z) in enumerate(row):
                cx, cz = cx + x * rates[j] ** 2, cz + z * rates[j] ** 2
                if (group := groups[j]) >= 0:
                    ways[group] = (ways[group][0] + z, ways[group][1] - x)
            for a, (ax, az) in enumerate(ways):
                right[a] += self.mass[i] * (ax * cx + az * cz)
                for b, (bx, bz) in enumerate(ways):
                    matrix[a][b] += self.mass[i] * (ax * bx + az * bz)
            if groups[i] >= 0:
                matrix[groups[i]][groups[i]] += self.inertia[i]
        result = solved(matrix, right)  # Eq. 359
        return [result[group] if group >= 0 else 0.0 for group in groups]

    def forces(
        self, sides: Sides, rotation: Sequence[float], rates: Sequence[float], ground: Vector
    ) -> list[JointForce]:
        """Return the forces of all joints on the bodies above."""
        second = self.angular_accelerations(sides, rotation, rates, ground)
        arms = self.arms(sides, rotation)
        points, ends = self.positions(sides, rotation)
        inertial = []
        for i, row in enumerate(arms):
            ax, az = _turning(row, second)
            for j, (x, z) in enumerate(row):
                ax, az = ax - x * rates[j] ** 2, az - z * rates[j] ** 2
            inertial.append((self.mass[i] * (ax + ground[0]), self.mass[i] * (az + self.gravity + ground[1])))
        result = []
        for joint, (px, pz) in enumerate(points):
            fx = fz = moment = 0.0
            for i in range(joint, self.count):
                x, z = inertial[i]
                fx, fz = fx + x, fz + z
                moment += self.inertia[i] * second[i] + (ends[i][1] - pz) * x - (ends[i][0] - px) * z
            angle = self.face(joint, sides, rotation)
            c, s = math.cos(angle), math.sin(angle)
            normal, left = fx * s + fz * c, moment / self.width[joint]  # Eq. 360
            result.append(JointForce(left, normal - left, normal, fx * c - fz * s))
        return result

    def face(self, joint: int, sides: Sides, rotation: Sequence[float]) -> float:
        """Return the angle of the face on which the corner of a joint rests."""
        if self.above[joint][sides[joint] or 1]:
            return rotation[joint - 1] if joint else 0.0
        return rotation[joint]


def _turning(row: Sequence[Vector], rates: Sequence[float]) -> Vector:
    x = z = 0.0
    for (a, b), rate in zip(row, rates, strict=False):
        x, z = x + b * rate, z - a * rate
    return x, z


def _groups(sides: Sides) -> list[int]:
    """Return the number of the rigid group of every body; -1 for bodies that rest on the ground."""
    groups, group = [], -1
    for side in sides:
        group += side != 0
        groups.append(group)
    return groups
