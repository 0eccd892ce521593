"""Scenes of animations at equal steps of time, for a plane body on its feet until it has fallen."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.bodies import Body, MassPoints, Section
from rocking.bodies.frame import section_of
from rocking.conventions import FloatArray
from rocking.dynamics.plane import equations
from rocking.dynamics.response import Response
from rocking.outcome import Outcome
from rocking.plots.response import ground_displacement_at, shown_until, velocity_at

FASTEST_RATE, MOST_SAMPLES = 120.0, 60_000  # samples per second, and maximum number of samples
_MARGIN = 0.10
_FAR = 1.5
_POSES = 400
_LEVEL = 1e-9  # tolerance of the height of a corner on the ground / its distance from the foot

_STEP = 0.01
"""Step of the integration of a fall, over 1 / p. The truncation error is below 1e-8 of the angle."""
_MOST_STEPS = 20_000
_HALVINGS = 50


@dataclass(frozen=True)
class DrawnShape:
    """A body with its ground at y = 0 and the middle between its feet at x = 0."""

    # density / largest density, and rings: the outline and its holes [m]
    regions: list[tuple[float, list[FloatArray]]]
    # mass points (x, y) [m] with their mass / largest mass; empty for a solid body; shape (n, 3)
    points: FloatArray
    feet: tuple[float, float]  # left and right foot [m]
    centre: tuple[float, float]  # centre of mass [m]

    @classmethod
    def of(cls, body: Body) -> "DrawnShape":
        """Return the shape of a body, moved to the middle between its feet."""
        left, right = body.local_feet
        middle = 0.5 * (left + right)
        moments = body.local_moments
        solid = section_of(body)
        regions: list[tuple[float, list[FloatArray]]] = []
        points = np.empty((0, 3))
        if isinstance(solid, Section):
            densest = max(region.density for region in solid.regions)
            # the section of a block has its own origin, so the middle of its feet is computed again
            shift = np.array([0.5 * sum(solid.local_feet), 0.0])
            regions = [(item.density / densest, [ring - shift for ring in item.rings]) for item in solid.regions]
        elif isinstance(body, MassPoints):
            points = np.column_stack([body.points - (middle, 0.0), body.masses / body.masses.max()])
        return cls(regions, points, (left - middle, right - middle), (moments.x - middle, moments.y))

    @property
    def corners(self) -> FloatArray:
        """Extreme points of the body: vertices, points and feet [m]."""
        parts = [ring for _, rings in self.regions for ring in rings]
        feet = np.array([[foot, 0.0] for foot in self.feet])
        return np.vstack([*parts, self.points[:, :2], feet, [self.centre]])

    @property
    def lying(self) -> tuple[float, float]:
        """Negative and positive rotations of a body that lies on its left or right side [rad].

        These rotations are at most a quarter turn plus the slenderness angle.
        """
        angles = []
        for foot, side in zip(self.feet, (-1.0, 1.0), strict=True):
            ahead, high = side * (self.corners[:, 0] - foot), self.corners[:, 1]
            above = high > _LEVEL * np.hypot(ahead, high)
            angles.append(side * float(np.arctan2(high[above], ahead[above]).min()))
        return angles[0], angles[1]

    def turned(self, corners: FloatArray, rotation: float) -> FloatArray:
        """Return points of the body [m] after a rotation by theta [rad] about its foot."""
        pivot = np.array([self.feet[1] if rotation > 0.0 else self.feet[0], 0.0])
        c, s = np.cos(rotation), np.sin(rotation)
        return np.asarray((corners - pivot) @ np.array([[c, -s], [s, c]]) + pivot)


@dataclass(frozen=True, eq=False)
class Scene:
    """A response at equal steps of time, and the window of view."""

    shape: DrawnShape
    time: FloatArray  # from zero to the end of the animation [s]
    rotation: FloatArray  # theta [rad]
    velocity: FloatArray  # theta' [rad/s]
    ground: FloatArray  # displacement of the ground [m]
    acceleration: FloatArray  # acceleration of the ground [m/s2]
    follows: bool  # True if the window moves with the ground, for ground displacements larger than the body
    window: tuple[float, float, float, float]  # x_min, y_min, x_max, y_max [m]


def scene_of(response: Response, step: float | None = None) -> Scene:
    """Return a response until its last event or until the body has fallen.

    The default is at most 120 samples per second.
    """
    shape = DrawnShape.of(response.body)
    fall = fall_of(response, shape.lying)
    end = scene_until(response, fall)
    if step is None:
        time = np.linspace(0.0, end, max(2, min(int(end * FASTEST_RATE), MOST_SAMPLES)))
    else:
        time = np.append(np.arange(0.0, end, step), end)
    response_end, motion_end = float(response.dense_output.end[-1]), response.segments.count * response.segments.step
    rotation, velocity = response.at(np.minimum(time, response_end)), velocity_at(response, time)
    if fall.time.size:
        is_falling = time > response_end
        rotation = np.clip(np.where(is_falling, np.interp(time, fall.time, fall.rotation), rotation), *shape.lying)
        velocity = np.where(is_falling, np.interp(time, fall.time, fall.velocity), velocity)
    ground = ground_displacement_at(response, np.minimum(time, motion_end))
    follows, window = _window(shape, rotation, ground)
    acceleration = np.where(time > motion_end, 0.0, np.interp(time, response.time, response.ground_acceleration))
    return Scene(shape, time, rotation, velocity, ground, acceleration, follows, window)


def scene_until(response: Response, fall: "Fall | None" = None) -> float:
    """Return the end of the animation of a response [s]. An overturning body is shown until it has fallen."""
    fall = fall_of(response, DrawnShape.of(response.body).lying) if fall is None else fall
    return float(fall.time[-1]) if fall.time.size else shown_until(response)


def _window(
    shape: DrawnShape, rotation: FloatArray, ground: FloatArray
) -> tuple[bool, tuple[float, float, float, float]]:
    corners = shape.corners
    poses = np.unique(np.linspace(0, rotation.size - 1, _POSES).astype(np.int64))
    # both extreme rotations are added, because they may be between the poses of a long history
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


@dataclass(frozen=True, eq=False)
class Fall:
    """Continuation of a response with overturning after its last state.

    The response ends at a quarter turn, or earlier at the end of its motion. After this end, the equation of motion is
    integrated under the remaining ground motion until a corner of the body reaches the ground. The animation then ends,
    because the impact on a side is not part of the model.
    """

    time: FloatArray  # times from the end of the response [s]; empty if the body does not overturn
    rotation: FloatArray  # theta [rad]
    velocity: FloatArray  # theta' [rad/s]


def fall_of(response: Response, lying: tuple[float, float]) -> Fall:
    """Return the continuation of a response after its last state.

    `lying` contains the rotations of the fallen body [rad].
    """
    if response.outcome is not Outcome.OVERTURNED:
        return Fall(np.empty(0), np.empty(0), np.empty(0))
    last = response.dense_output
    falling = _Falling(response, lying)
    rows = [(float(last.end[-1]), float(last.rotation[-1, 1]), float(last.velocity[-1, 1]))]
    side = 1.0 if (rows[0][1] or rows[0][2]) > 0.0 else -1.0
    while not falling.lies(rows[-1], side) and len(rows) < _MOST_STEPS:
        side, state = falling.advanced(side, rows[-1])
        rows.append(state)
    time, rotation, velocity = np.array(rows).T
    return Fall(time, np.clip(rotation, *lying), velocity)


_State = tuple[float, float, float]


@dataclass(frozen=True)
class _Falling:
    """Integration of a fall with states (time, theta, theta')."""

    response: Response
    lying: tuple[float, float]

    def lies(self, state: _State, side: float) -> bool:
        return side * state[1] >= side * self.lying[side > 0.0]

    def advanced(self, side: float, state: _State) -> tuple[float, _State]:
        """Return side and state after a step, or at an earlier contact with the ground or the other foot."""
        step = _STEP / self.response.parameters.side(side).frequency_parameter
        after = self._step(side, state, step)
        lands = side * after[1] < 0.0
        if not (lands or self.lies(after, side)):
            return side, after
        low, high = 0.0, step
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            within = self._step(side, state, middle)
            beyond = side * within[1] < 0.0 if lands else self.lies(within, side)
            low, high = (low, middle) if beyond else (middle, high)
        time, rotation, speed = self._step(side, state, high)
        if not lands:
            return side, (time, rotation, speed)
        return -side, (time, 0.0, self._coefficient(-side, speed) * speed)

    def _coefficient(self, foot: float, speed: float) -> float:
        parameters, run = self.response.parameters, self.response.trajectory
        return parameters.coefficient(foot, abs(speed), self.response.stream, run.impacts + 1)

    def _step(self, side: float, state: _State, step: float) -> _State:
        """Return the state after a step, by the classical method of Runge and Kutta."""
        time, start = state[0], np.array(state[1:])

        def slope(share: float, y: FloatArray) -> FloatArray:
            return np.array([y[1], self._acceleration(side, time + share * step, float(y[0]))])

        first = slope(0.0, start)
        second = slope(0.5, start + 0.5 * step * first)
        third = slope(0.5, start + 0.5 * step * second)
        fourth = slope(1.0, start + step * third)
        end = start + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
        return time + step, float(end[0]), float(end[1])

    def _acceleration(self, side: float, time: float, rotation: float) -> float:
        response, segments = self.response, self.response.segments
        position, k = time / segments.step, math.floor(time / segments.step)
        push = weight = 0.0
        if k < segments.count:
            powers = (position - k) ** np.arange(segments.degree + 1) * response.scale / response.settings.gravity
            push = float(segments.horizontal[k] @ powers)
            weight = 0.0 if segments.vertical is None else float(segments.vertical[k] @ powers)
        side_parameters = response.parameters.side(side)
        return float(
            equations.angular_acceleration(
                rotation, side, side_parameters.slenderness_angle, side_parameters.frequency_parameter, push,
                1.0 + weight,
                linear=response.settings.linear,
            )
        )  # fmt: skip
