"""Equilibria of a body: stable poses, saddles, summits, and the passes between poses."""

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.conventions import FloatArray, g
from rocking.errors import InvalidValueError

Kind = Literal["stable", "saddle", "summit"]


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """An attitude with the centre of mass vertically above the contact.

    Parameters
    ----------
    kind : {"stable", "saddle", "summit"}
        Equilibrium on a facet, an edge, or a vertex of the hull.
    down : ndarray, shape (3,)
        Downward unit vector in the body's frame [-].
    height : float
        Height of the centre of mass above the ground [m].
    energy : float
        Potential energy relative to the lowest stable pose: m g x height difference [J].
    points : ndarray, shape (n, 3)
        Corners of the contact, in the body's coordinates [m].
    """

    kind: Kind
    down: FloatArray
    height: float
    energy: float
    points: FloatArray


@dataclass(frozen=True, eq=False)
class StablePose(Equilibrium):
    """A stable pose of a body on a facet of its hull.

    Parameters
    ----------
    kind : {"stable"}
        Type of equilibrium.
    down : ndarray, shape (3,)
        Downward unit vector in the body's frame [-].
    height : float
        Height of the centre of mass above the ground [m].
    energy : float
        Potential energy relative to the lowest stable pose [J].
    points : ndarray, shape (n, 3)
        Corners of the facet, in the body's coordinates [m].
    number : int
        Index of the pose, sorted by the height of the centre of mass.
    centre : ndarray, shape (3,)
        Centre of mass in the body's coordinates [m].
    barrier : float
        Energy barrier: rise of the centre of mass on the lowest path to another stable pose [m]; infinite without path.
    """

    number: int
    centre: FloatArray
    barrier: float

    @property
    def rotation(self) -> FloatArray:
        """Smallest rotation into this pose, shape (3, 3) [-]; azimuths refer to the rotated body."""
        return set_down(self.down)

    @property
    def support(self) -> FloatArray:
        """Corners of the support polygon relative to the centre of mass, counter-clockwise, shape (n, 2) [m]."""
        flat: FloatArray = ((self.points - self.centre) @ self.rotation.T)[:, :2]
        return flat

    @property
    def edge_distances(self) -> FloatArray:
        """Distances of the edges of `support` from the projection of the centre of mass, shape (n,) [m]."""
        corners = self.support
        along = np.roll(corners, -1, axis=0) - corners
        distances: FloatArray = (along[:, 1] * corners[:, 0] - along[:, 0] * corners[:, 1]) / np.linalg.norm(
            along, axis=1
        )
        return distances

    @property
    def overturning_tilts(self) -> tuple[float, float]:
        """Tilt with the centre of mass above the nearest edge, and above the farthest corner, of `support` [rad]."""
        farthest = float(np.linalg.norm(self.support, axis=1).max())
        return math.atan2(float(self.edge_distances.min()), self.height), math.atan2(farthest, self.height)

    def uplift_acceleration(self, azimuth: ArrayLike) -> FloatArray:
        """Return the smallest constant ground acceleration with uplift towards an azimuth.

        Parameters
        ----------
        azimuth : array_like
            Direction of the tilt, counter-clockwise from x of the body in this pose [rad].

        Returns
        -------
        ndarray
            Ground acceleration in the opposite direction [m/s2].
        """
        angle = azimuths(azimuth)
        corners, distances = self.support, self.edge_distances
        along = np.roll(corners, -1, axis=0) - corners
        outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
        slope = np.cos(angle)[..., None] * outward[:, 0] + np.sin(angle)[..., None] * outward[:, 1]
        lever = np.where(slope > 0.0, distances / np.where(slope > 0.0, slope, 1.0), np.inf).min(axis=-1)
        acceleration: FloatArray = g * lever / self.height  # Eq. 249
        return acceleration


@dataclass(frozen=True)
class Pass:
    """The lowest path from one stable pose to another.

    Parameters
    ----------
    start, end : int
        Indices of the poses.
    height : float
        Height of the centre of mass at the highest saddle [m].
    rise : float
        Height difference between the saddle and the first pose [m].
    energy : float
        Energy of the rise [J].
    tilt : float
        Angle between the first pose and the saddle [rad].
    azimuth : float
        Direction of the tilt in the first pose [rad].
    down : ndarray, shape (3,)
        Downward unit vector at the saddle, in the body's frame [-].
    """

    start: int
    end: int
    height: float
    rise: float
    energy: float
    tilt: float
    azimuth: float
    down: FloatArray = field(repr=False, compare=False)


@dataclass(frozen=True)
class Ring:
    """A circle of equilibria of a body of revolution, which can roll along the circle.

    Parameters
    ----------
    kind : {"stable", "summit"}
        "stable" for the smallest and "summit" for the largest height of the centre of mass over the tilt.
    tilt : float
        Angle between the axis of the body and the vertical [rad].
    height : float
        Height of the centre of mass above the ground [m].
    energy : float
        Potential energy relative to the lowest pose [J].
    """

    kind: Literal["stable", "summit"]
    tilt: float
    height: float
    energy: float


def set_down(down: FloatArray) -> FloatArray:
    """Return the smallest rotation of a unit vector to -z."""
    x, y, z = down.tolist()
    level = x * x + y * y
    if z > 0.0 and not level > 0.0:
        return np.diag([1.0, -1.0, -1.0])
    # the cosine is -z, the axis is down x (-z) = (-y, x, 0); the factor 1 / (1 - z) has no cancellation
    factor = (1.0 + z) / level if z > 0.0 else 1.0 / (1.0 - z)
    turn: FloatArray = np.array(
        [[1.0 - x * x * factor, -x * y * factor, x], [-x * y * factor, 1.0 - y * y * factor, y], [-x, -y, -z]]
    )
    return turn


def azimuths(values: ArrayLike) -> FloatArray:
    """Return checked azimuths [rad]."""
    angles = checks.real_array("azimuth", values, "rad")
    if not np.isfinite(angles).all():
        raise InvalidValueError(parameter="azimuth", allowed="finite numbers [rad]", value=values)
    return angles


def tilt_towards(pose: StablePose, down: FloatArray) -> tuple[float, float]:
    """Return tilt and azimuth of a downward direction relative to a pose [rad]."""
    x, y, z = (pose.rotation @ down).tolist()
    return math.atan2(math.hypot(x, y), -z), math.atan2(y, x)


def tilted(pose: StablePose, azimuth: float) -> FloatArray:
    """Return the horizontal unit vector of an azimuth in the body's frame [-]."""
    turned: FloatArray = pose.rotation.T @ np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    return turned
