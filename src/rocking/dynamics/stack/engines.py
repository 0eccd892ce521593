"""Choice of the engine of a stack."""

from collections.abc import Sequence

from rocking import checks
from rocking.bodies.stack import Stack
from rocking.dynamics.settings import ENGINES
from rocking.dynamics.stack.reference import StackReference
from rocking.dynamics.stack.settings import StackSettings
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
    """Return one history from the rotations [rad] and angular velocities [rad/s] of all bodies."""
    requested = checks.one_of("engine", engine, ENGINES)
    if requested == "fast" or len(body.bodies) > MOST_OF_REFERENCE:
        raise InvalidValueError(
            parameter="bodies", allowed="one or two bodies with engine reference", value=len(body.bodies)
        )
    return StackReference(body, segments, settings, scale).run(rotation, rates)
