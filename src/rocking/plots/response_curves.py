"""The curves of a response, at any instant: rotation, velocity, and the place of the ground."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.response import Response
from rocking.motions.motion import GroundMotion
from rocking.outcome import Outcome

_INSIDE = np.linspace(0.0, 1.0, 5)
_REST = 0.06
"""Rest that is shown after the last event, as a share of the time shown."""


@dataclass(frozen=True, eq=False)
class MotionCurves:
    """Rotation and velocity at many instants, with both values where the velocity jumps."""

    time: FloatArray  # instants, never decreasing; an impact is there twice [s]
    rotation: FloatArray  # theta [rad]
    velocity: FloatArray  # theta' [rad/s]


def motion_curves(response: Response) -> MotionCurves:
    """Return rotation and velocity of a response with every jump upright."""
    dense_output = response.dense_output
    rotation, velocity = dense_output.evaluated(_INSIDE)
    time = dense_output.start[:, None] + _INSIDE * dense_output.length[:, None]
    return MotionCurves(time.ravel(), rotation.ravel(), velocity.ravel())


def velocity_at(response: Response, time: Any) -> FloatArray:
    """Return the angular velocity at any times within a response; at an impact the one after it.

    time: times [s]. Returns theta' [rad/s].
    """
    dense_output = response.dense_output
    t = np.clip(np.asarray(time, dtype=np.float64), 0.0, dense_output.end[-1])
    k = np.clip(np.searchsorted(dense_output.start, t, side="right") - 1, 0, dense_output.start.size - 1)
    x = (t - dense_output.start[k]) / dense_output.length[k]
    slopes = dense_output.quintics()[k][..., 1:] * np.arange(1, 6)
    return np.asarray((slopes * x[..., None] ** np.arange(5)).sum(axis=-1) / dense_output.length[k])


def over_slenderness(response: Response, rotation: FloatArray) -> FloatArray:
    """Return rotations over the slenderness angle of the side they stand on.

    rotation: theta [rad]. Returns beyond one the centre of mass is past the foot [-].
    """
    parameters = response.parameters
    return rotation / np.where(rotation > 0.0, parameters.right.slenderness_angle, parameters.left.slenderness_angle)


def shown_until(response: Response) -> float:
    """Return the time up to which there is something to see: the motion, the last event, and a little rest.

    Returns Time, at most the end of the response [s].
    """
    end = float(response.time[-1]) or float(response.dense_output.end[-1])  # it may lie before the second sample
    if response.outcome is Outcome.OVERTURNED or not response.trajectory.events:
        return end if response.outcome is not Outcome.NO_UPLIFT else min(end, _quiet_end(response))
    last = max(event.time for event in response.trajectory.events)
    if np.any(response.rotation[response.time > last] != 0.0):
        return end
    motion = 0.0 if response.motion is None else response.motion.duration
    return min(end, (1.0 + _REST) * max(last, motion))


def _quiet_end(response: Response) -> float:
    return float(response.time[-1]) if response.motion is None else response.motion.duration


def ground_curve(response: Response) -> tuple[FloatArray, FloatArray]:
    """Return the horizontal acceleration of the ground as it is drawn, jumps at the ends of the motion upright.

    Returns times [s], the same one twice at a jump, and accelerations [m/s2].
    """
    segments = response.segments
    parts = np.arange(1 if isinstance(response.motion, GroundMotion) else 3)
    tau = np.append(parts / parts.size, 1.0)
    powers = tau[None, :] ** np.arange(segments.degree + 1)[:, None]
    time = (np.arange(segments.count)[:, None] + tau) * segments.step
    values = response.scale * (segments.horizontal @ powers)
    rise = [0.0]
    return np.concatenate([rise, time.ravel()]), np.concatenate([rise, values.ravel()])


def ground_place(response: Response, time: FloatArray) -> FloatArray:
    """Return the horizontal displacement of the ground, from rest, integrated exactly.

    time: times [s]. Returns displacement [m].
    """
    segments = response.segments
    h, order = segments.step, np.arange(segments.degree + 1)
    c = response.scale * segments.horizontal
    faster = h * (c / (order + 1)).sum(axis=1)
    velocity = np.concatenate([[0.0], np.cumsum(faster)])
    farther = h * velocity[:-1] + h * h * (c / ((order + 1) * (order + 2))).sum(axis=1)
    place = np.concatenate([[0.0], np.cumsum(farther)])
    k = np.clip((time / h).astype(np.int64), 0, segments.count - 1)
    tau = time / h - k
    inside = (c[k] / ((order + 1) * (order + 2)) * tau[:, None] ** (order + 2)).sum(axis=1)
    return np.asarray(place[k] + h * velocity[k] * tau + h * h * inside)
