"""Choice of the engine of a stack."""

import math
from collections.abc import Sequence

import numpy as np

from rocking import checks
from rocking.bodies.stack import Stack
from rocking.conventions import FEET
from rocking.dynamics.settings import ENGINES
from rocking.dynamics.stack.reference import StackReference
from rocking.dynamics.stack.settings import StackSettings
from rocking.dynamics.stack.time_stepping import COMPILED, time_stepping
from rocking.dynamics.stack.trajectory import StackTrajectory
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments

MOST_OF_REFERENCE = 2
_AFTER = 30.0  # product of p and the time on ground at rest that determines the outcome
_REACH = 0.5  # theta + theta' / p over alpha; a block with small angles needs 1 to overturn


def run(
    body: Stack,
    segments: Segments,
    settings: StackSettings,
    rotation: Sequence[float],
    rates: Sequence[float],
    *,
    scale: float = 1.0,
    engine: str = "auto",
) -> StackTrajectory:
    """Return one history from the rotations [rad] and angular velocities [rad/s] of all bodies.

    The reference engine is for at most two bodies whose joints stick, with plastic impacts. Ground at rest after the
    segments determines the outcome of bodies that still fall at their end.
    """
    requested = checks.one_of("engine", engine, ENGINES)
    n = len(body.bodies)
    suits = n <= MOST_OF_REFERENCE and not any(body.restitution)
    if requested == "reference" and not suits:
        raise InvalidValueError(
            "the reference engine accepts at most {allowed} bodies and restitution 0, got {value} bodies",
            parameter="bodies", allowed=MOST_OF_REFERENCE, value=n,
        )  # fmt: skip
    if requested == "auto":
        sticks = suits and min(body.friction) == math.inf
        requested = "reference" if sticks else COMPILED.chosen("auto") if suits else "fast"

    def computed(ground: Segments) -> StackTrajectory:
        if requested == "reference":
            return StackReference(body, ground, settings, scale).run(rotation, rates)
        return time_stepping(body, ground, settings, rotation, rates, scale)

    trajectory = computed(segments)
    if trajectory.still_rocking and _may_overturn(body, trajectory, settings.gravity):
        slow = min(body.side_above(k, foot, settings.gravity).frequency_parameter for k in range(n) for foot in FEET)
        trajectory.take_fall(computed(segments.extended(segments.duration + _AFTER / slow)))
    return trajectory


def _may_overturn(body: Stack, trajectory: StackTrajectory, gravity: float) -> bool:
    """Return True if bodies are beyond their equilibrium at the end, or move outwards fast enough to reach it."""
    rotation, opening = trajectory.rotation[-1], trajectory.opening[-1]
    speed = np.diff(trajectory.angular_velocity[-1], prepend=0.0) * np.sign(opening)
    sides = [body.side_above(k, "right" if angle > 0.0 else "left", gravity) for k, angle in enumerate(opening)]
    alpha = np.array([side.slenderness_angle for side in sides])
    reach = np.abs(opening) + speed / np.array([side.frequency_parameter for side in sides])
    outwards = (speed > 0.0) & (reach > _REACH * alpha)
    return bool(np.any(outwards | (np.abs(opening) > alpha) | (np.abs(rotation) > alpha)))
