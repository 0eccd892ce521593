"""What a body may rest or be balanced on: stable poses, saddles, summits, and the passes between poses."""

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
    """A way up in which the centre of mass is straight above what the body touches.

    Parameters
    ----------
    kind : {"stable", "saddle", "summit"}
        On a facet of the hull, on an edge, on a vertex.
    down : ndarray, shape (3,)
        The direction that is then downward, in the body's own frame; a unit vector [-].
    height : float
        Height of the centre of mass over the ground [m].
    energy : float
        What it costs to raise the centre from the lowest stable pose, m g times the difference in height [J].
    points : ndarray, shape (n, 3)
        Corners of what touches the ground, in the body's coordinates [m].
    """

    kind: Kind
    down: FloatArray
    height: float
    energy: float
    points: FloatArray


@dataclass(frozen=True, eq=False)
class StablePose(Equilibrium):
    """A facet of the hull that a body stands on by itself.

    Parameters
    ----------
    kind : {"stable"}
        As of every equilibrium.
    down : ndarray, shape (3,)
        The direction that is downward, in the body's own frame; a unit vector [-].
    height : float
        Height of the centre of mass over the ground [m].
    energy : float
        What it costs to raise the centre from the lowest stable pose [J].
    points : ndarray, shape (n, 3)
        Corners of the facet, in the body's coordinates [m].
    number : int
        Its place among the stable poses, the lowest first.
    centre : ndarray, shape (3,)
        Centre of mass in the body's coordinates [m].
    barrier : float
        Rise of the centre on the lowest way into another stable pose [m]; infinite if there is no other.
    """

    number: int
    centre: FloatArray
    barrier: float

    @property
    def rotation(self) -> FloatArray:
        """The shortest rotation that sets the body down in this pose, shape (3, 3) [-]; azimuths are those after it."""
        return set_down(self.down)

    @property
    def support(self) -> FloatArray:
        """Corners of the support polygon from the plumb line, as set down, counter-clockwise, shape (n, 2) [m]."""
        flat: FloatArray = ((self.points - self.centre) @ self.rotation.T)[:, :2]
        return flat

    @property
    def edge_distances(self) -> FloatArray:
        """How far each edge of `support` is from the plumb line, shape (n,) [m]; edge i runs from corner i on."""
        here = self.support
        along = np.roll(here, -1, axis=0) - here
        distances: FloatArray = (along[:, 1] * here[:, 0] - along[:, 0] * here[:, 1]) / np.linalg.norm(along, axis=1)
        return distances

    def uplift_acceleration(self, azimuth: ArrayLike) -> FloatArray:
        """Return the least steady acceleration of the ground that lifts the body towards an azimuth.

        Parameters
        ----------
        azimuth : array_like
            Direction towards which the body tilts, counter-clockwise from x of the body as set down [rad].

        Returns
        -------
        ndarray
            Acceleration, against the azimuth [m/s2].
        """
        angle = azimuths(azimuth)
        here, far = self.support, self.edge_distances
        along = np.roll(here, -1, axis=0) - here
        outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
        slope = np.cos(angle)[..., None] * outward[:, 0] + np.sin(angle)[..., None] * outward[:, 1]
        reach = np.where(slope > 0.0, far / np.where(slope > 0.0, slope, 1.0), np.inf).min(axis=-1)
        lifted: FloatArray = g * reach / self.height  # Eq. 249
        return lifted


@dataclass(frozen=True)
class Pass:
    """The lowest way from one stable pose into another.

    Parameters
    ----------
    start, end : int
        Numbers of the poses.
    height : float
        Height of the centre on its highest saddle [m].
    rise : float
        The same over the pose at the start [m].
    energy : float
        What the rise costs [J].
    tilt : float
        Angle between the pose at the start and the saddle [rad].
    azimuth : float
        Towards which the body tilts, in the pose at the start as set down [rad].
    down : ndarray, shape (3,)
        The direction that is downward on the saddle, in the body's own frame [-].
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
    """A circle of equilibria of a body of revolution: it rolls from each into the next.

    Parameters
    ----------
    kind : {"stable", "summit"}
        Whether the centre is lower or higher there than at other tilts.
    tilt : float
        Angle between the body's axis and the vertical [rad].
    height : float
        Height of the centre of mass over the ground [m].
    energy : float
        What it costs to raise the centre there from the lowest pose [J].
    """

    kind: Literal["stable", "summit"]
    tilt: float
    height: float
    energy: float


def set_down(down: FloatArray) -> FloatArray:
    """Return the shortest rotation that turns a unit vector downward, to -z."""
    x, y, z = down.tolist()
    level = x * x + y * y
    if z > 0.0 and not level > 0.0:
        return np.diag([1.0, -1.0, -1.0])
    # of the cosine -z and the axis down x (-z) = (-y, x, 0); 1 / (1 - z) without a difference of nearly equal numbers
    share = (1.0 + z) / level if z > 0.0 else 1.0 / (1.0 - z)
    turn: FloatArray = np.array(
        [[1.0 - x * x * share, -x * y * share, x], [-x * y * share, 1.0 - y * y * share, y], [-x, -y, -z]]
    )
    return turn


def azimuths(values: ArrayLike) -> FloatArray:
    """Return azimuths, after a check [rad]."""
    angles = checks.real_array("azimuth", values, "rad")
    if not np.isfinite(angles).all():
        raise InvalidValueError(parameter="azimuth", allowed="finite numbers [rad]", value=values)
    return angles


def tilt_towards(pose: StablePose, down: FloatArray) -> tuple[float, float]:
    """Return tilt and azimuth of a direction down, seen from a pose [rad]."""
    x, y, z = (pose.rotation @ down).tolist()
    return math.atan2(math.hypot(x, y), -z), math.atan2(y, x)


def tilted(pose: StablePose, azimuth: float) -> FloatArray:
    """Return the horizontal direction of an azimuth, in the body's frame."""
    turned: FloatArray = pose.rotation.T @ np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    return turned
