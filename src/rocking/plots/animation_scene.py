"""What an animation shows: the body about its feet, the ground under it, and both at equal steps of time."""

from dataclasses import dataclass, field

import numpy as np

from rocking.bodies import Block, Body, MassPoints, Section
from rocking.conventions import FloatArray
from rocking.dynamics.response import Response
from rocking.plots.lying import Fall, fall_of
from rocking.plots.response_curves import ground_place, shown_until, velocity_at

FASTEST_RATE, MOST_SAMPLES = 120.0, 60_000
"""Samples in a second, and in all."""

_MARGIN = 0.10
_FAR = 1.5
_POSES = 400
_LEVEL = 1e-9
"""Height of a corner that stands on the ground, over its distance from the foot, to rounding."""


@dataclass(frozen=True)
class DrawnShape:
    """A body with its ground at y = 0 and the middle between its feet at x = 0."""

    # density over the largest one, and rings: the outline and its holes [m]
    regions: list[tuple[float, list[FloatArray]]]
    # mass points (x, y) [m] with their mass over the largest one; none for a solid body; shape (n, 3)
    points: FloatArray
    feet: tuple[float, float]  # left and right foot [m]
    centre: tuple[float, float]  # centre of mass [m]

    @classmethod
    def of(cls, body: Body) -> "DrawnShape":
        """Return the shape of a body.

        Returns moved to the middle between its feet.
        """
        left, right = body.local_feet
        middle = 0.5 * (left + right)
        moments = body.local_moments
        solid = body.to_section() if isinstance(body, Block) else body
        regions: list[tuple[float, list[FloatArray]]] = []
        points = np.empty((0, 3))
        if isinstance(solid, Section):
            densest = max(region.density for region in solid.regions)
            # a block turned into a section keeps its feet but not its frame
            shift = np.array([0.5 * sum(solid.local_feet), 0.0])
            regions = [(one.density / densest, [ring - shift for ring in one.rings]) for one in solid.regions]
        elif isinstance(body, MassPoints):
            points = np.column_stack([body.points - (middle, 0.0), body.masses / body.masses.max()])
        return cls(regions, points, (left - middle, right - middle), (moments.x - middle, moments.y))

    @property
    def corners(self) -> FloatArray:
        """Everything that the body reaches: vertices, points and feet [m]."""
        parts = [ring for _, rings in self.regions for ring in rings]
        feet = np.array([[foot, 0.0] for foot in self.feet])
        return np.vstack([*parts, self.points[:, :2], feet, [self.centre]])

    @property
    def lying(self) -> tuple[float, float]:
        """Rotations, below and above zero, at which a corner meets the ground: it lies on its left or right side [rad].

        Both are at most a quarter turn and the slenderness angle beyond it, since the centre of mass is no lower.
        """
        angles = []
        for foot, side in zip(self.feet, (-1.0, 1.0), strict=True):
            ahead, high = side * (self.corners[:, 0] - foot), self.corners[:, 1]
            above = high > _LEVEL * np.hypot(ahead, high)
            angles.append(side * float(np.arctan2(high[above], ahead[above]).min()))
        return angles[0], angles[1]

    def turned(self, corners: FloatArray, rotation: float) -> FloatArray:
        """Return points of the body after it has turned about the foot that it stands on.

        corners: points of the body at rest [m]; rotation: theta, positive clockwise about the right foot [rad]. Returns
        where they are then [m].
        """
        pivot = np.array([self.feet[1] if rotation > 0.0 else self.feet[0], 0.0])
        c, s = np.cos(rotation), np.sin(rotation)
        return np.asarray((corners - pivot) @ np.array([[c, -s], [s, c]]) + pivot)


@dataclass(frozen=True, eq=False)
class Scene:
    """A response at equal steps of time, and the window through which it is seen."""

    shape: DrawnShape  # the body
    time: FloatArray = field(repr=False)  # Equal steps from zero to the end of what is shown [s]
    rotation: FloatArray = field(repr=False)  # rotation, velocity: theta [rad] and theta' [rad/s]
    velocity: FloatArray = field(repr=False)
    # ground, acceleration: displacement [m] and acceleration of the ground [m/s2]
    ground: FloatArray = field(repr=False)
    acceleration: FloatArray = field(repr=False)
    follows: bool  # whether the window moves with the ground, since it moves farther than the body is large
    window: tuple[float, float, float, float]  # x_min, y_min, x_max, y_max [m]


def scene_of(response: Response, step: float | None = None) -> Scene:
    """Return the scene of a response.

    step: step of time; if not given, 120 samples a second or fewer [s]. Returns from its start to where nothing happens
    any more, or to where the body lies.
    """
    shape = DrawnShape.of(response.body)
    fall = fall_of(response, shape.lying)
    end = scene_until(response, fall)
    if step is None:
        time = np.linspace(0.0, end, max(2, min(int(end * FASTEST_RATE), MOST_SAMPLES)))
    else:
        time = np.append(np.arange(0.0, end, step), end)
    known, ends = float(response.dense_output.end[-1]), response.segments.count * response.segments.step
    rotation, velocity = response.at(np.minimum(time, known)), velocity_at(response, time)
    if fall.time.size:
        falls = time > known
        rotation = np.clip(np.where(falls, np.interp(time, fall.time, fall.rotation), rotation), *shape.lying)
        velocity = np.where(falls, np.interp(time, fall.time, fall.velocity), velocity)
    ground = ground_place(response, np.minimum(time, ends))
    follows, window = _window(shape, rotation, ground)
    acceleration = np.where(time > ends, 0.0, np.interp(time, response.time, response.ground_acceleration))
    return Scene(shape, time, rotation, velocity, ground, acceleration, follows, window)


def scene_until(response: Response, fall: Fall | None = None) -> float:
    """Return the time up to which a response is shown in motion: to where the body lies, if it falls.

    Returns time [s].
    """
    fall = fall_of(response, DrawnShape.of(response.body).lying) if fall is None else fall
    return float(fall.time[-1]) if fall.time.size else shown_until(response)


def _window(
    shape: DrawnShape, rotation: FloatArray, ground: FloatArray
) -> tuple[bool, tuple[float, float, float, float]]:
    corners = shape.corners
    poses = np.unique(np.linspace(0, rotation.size - 1, _POSES).astype(np.int64))
    # with the two ends of the swing, which fall between the poses of a long history
    poses = np.append(poses, [rotation.argmin(), rotation.argmax()])
    turned = [shape.turned(corners, float(rotation[k])) for k in poses]
    low = np.min([pose.min(axis=0) for pose in turned], axis=0)
    high = np.max([pose.max(axis=0) for pose in turned], axis=0)
    follows = bool(np.ptp(ground) > _FAR * max(high - low))
    if not follows:
        low[0] = min(pose[:, 0].min() + ground[k] for k, pose in zip(poses, turned, strict=True))
        high[0] = max(pose[:, 0].max() + ground[k] for k, pose in zip(poses, turned, strict=True))
    room = _MARGIN * max(high - low)
    return follows, (float(low[0] - room), float(min(low[1], 0.0) - room), float(high[0] + room), float(high[1] + room))
