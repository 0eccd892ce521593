"""Choice of the engine of a stack."""

import math
from collections.abc import Sequence

from rocking import checks
from rocking.bodies.stack import Stack
from rocking.dynamics.settings import ENGINES
from rocking.dynamics.stack.reference import StackReference
from rocking.dynamics.stack.settings import StackSettings
from rocking.dynamics.stack.time_stepping import COMPILED, time_stepping
from rocking.dynamics.stack.trajectory import StackTrajectory
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments

MOST_OF_REFERENCE = 2


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

    The reference engine is for at most two bodies whose joints stick, with plastic impacts.
    """
    requested = checks.one_of("engine", engine, ENGINES)
    suits = len(body.bodies) <= MOST_OF_REFERENCE and not any(body.restitution)
    if requested == "reference" and not suits:
        raise InvalidValueError(
            "the reference engine accepts at most {allowed} bodies and restitution 0, got {value} bodies",
            parameter="bodies", allowed=MOST_OF_REFERENCE, value=len(body.bodies),
        )  # fmt: skip
    if requested == "auto":
        sticks = suits and min(body.friction) == math.inf
        requested = "reference" if sticks else COMPILED.chosen("auto") if suits else "fast"
    if requested == "reference":
        return StackReference(body, segments, settings, scale).run(rotation, rates)
    return time_stepping(body, segments, settings, rotation, rates, scale)
