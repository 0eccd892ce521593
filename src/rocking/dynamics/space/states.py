"""The state of a body in space at many times, from the polynomials of its history."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.space import attitude
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.trajectory import SpatialTrajectory, StepPiece
from rocking.outcome import ContactMode
from rocking.portable import applied, times


@dataclass(frozen=True, eq=False)
class States:
    """A body at n instants."""

    body: SpatialBody
    quaternion: FloatArray  # attitude (s, x, y, z), body axes to axes of the ground [-]; shape (n, 4)
    body_velocity: FloatArray  # angular velocity in body axes [rad/s]; shape (n, 3)
    pivot: FloatArray  # A point on the ground, in body axes [m]; shape (n, 3)
    place: FloatArray  # the same point on the ground [m]; shape (n, 2)
    contact: IntArray  # number of the regime; shape (n,)

    @cached_property
    def rotation(self) -> FloatArray:
        """Rotation matrices, shape (n, 3, 3) [-]."""
        return attitude.matrix(self.quaternion)

    @cached_property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity in axes of the ground, shape (n, 3) [rad/s]."""
        return applied(self.rotation, self.body_velocity)

    def point(self, point: FloatArray) -> FloatArray:
        """Return where a point of the body is.

        point: in body axes [m]. Returns relative to the ground, which carries the origin along [m].
        """
        moved = applied(self.rotation, point - self.pivot)
        moved[:, :2] += self.place
        return np.asarray(moved)

    @property
    def least_gap(self) -> FloatArray:
        """Height of the lowest vertex or point of the rim over the ground; below zero it would be inside [m]."""
        up = self.rotation[:, 2]
        if self.body.round:
            lowest = -self.body.radius * np.sqrt(np.square(up[:, :2]).sum(axis=1))
        else:
            lowest = times(up, self.body.vertices.T).min(axis=1)
        return np.asarray(lowest - (up * self.pivot).sum(axis=1))

    @property
    def centre_velocity(self) -> FloatArray:
        """Velocity of the centre of mass relative to the ground, shape (n, 3) [m/s]."""
        local = attitude.cross(self.body_velocity, self.body.centre - self.pivot)
        return applied(self.rotation, local)

    @property
    def kinetic(self) -> FloatArray:
        """Kinetic energy relative to the ground [J]."""
        spin = (self.body_velocity * times(self.body_velocity, self.body.inertia)).sum(axis=1)
        return np.asarray(0.5 * spin + 0.5 * self.body.mass * np.square(self.centre_velocity).sum(axis=1))

    @property
    def rise(self) -> FloatArray:
        """How much higher the centre of mass is than at rest [m]."""
        up, arm = self.rotation[:, 2], self.body.centre - self.pivot
        sunk = 2.0 * np.square(self.quaternion[:, 1:3]).sum(axis=1)  # 1 - cos(tilt)
        return np.asarray((up[:, :2] * arm[:, :2]).sum(axis=1) - sunk * arm[:, 2])  # Eq. 86


def states_of(body: SpatialBody, trajectory: SpatialTrajectory, time: FloatArray) -> States:
    """Return the states of a history; at an impact, after it.

    time: times within it [s].
    """
    pieces = trajectory.pieces
    starts = np.array([piece.start for piece in pieces])
    place = np.clip(np.searchsorted(starts, time, side="right") - 1, 0, len(pieces) - 1)
    parts = [np.empty((time.size, k)) for k in (4, 3, 3, 2)]
    modes = np.empty(time.size, dtype=np.int64)
    for k in np.unique(place):
        rows = np.flatnonzero(place == k) if k else place == 0
        piece = pieces[k]
        share = (
            np.clip((time[rows] - piece.start) / piece.length, 0.0, piece.until) if piece.length else 0.0 * time[rows]
        )
        q, w, where = piece.at(share)
        for target, values in zip(parts, (q, w, pivots(body, piece, q), where), strict=True):
            target[rows] = values
        modes[rows] = piece.contact.mode.code
    return States(body, parts[0], parts[1], parts[2], parts[3], modes)


def pivots(body: SpatialBody, piece: StepPiece, quaternions: FloatArray) -> FloatArray:
    """Return the points on the ground, in body axes.

    quaternions: attitudes within it [-]. Returns pivot of the contact; of a rolling body the lowest points of its rim
    [m].
    """
    if piece.contact.mode is not ContactMode.ROLLING:
        return np.broadcast_to(piece.contact.pivot, (len(quaternions), 3))
    level = attitude.matrix(quaternions)[:, 2, :2]
    low = -body.radius * level / np.linalg.norm(level, axis=1)[:, None]
    return np.column_stack([low, np.zeros(len(low))])
