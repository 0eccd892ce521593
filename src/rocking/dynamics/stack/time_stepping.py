"""The compiled engine of a stack: time stepping of Moreau and Jean, for any number of bodies."""

import math
from collections.abc import Sequence

import numpy as np

from rocking.bodies.stack import Stack
from rocking.bodies.top_edge import top_edge
from rocking.conventions import FEET, FloatArray
from rocking.dynamics.settings import CompiledEngine
from rocking.dynamics.stack.chain import Chain
from rocking.dynamics.stack.settings import StackSettings
from rocking.dynamics.stack.trajectory import IMPACT, StackEvent, StackTrajectory
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

COMPILED = CompiledEngine(
    "rocking.dynamics._stack",
    "the fast engine of stacks was not built; install rocking with a C++17 compiler (in a checkout, `make engine`)",
)
FAST = "fast (time stepping of Moreau and Jean, compiled)"
_STICKS = 1e3  # friction of joints that do not slide, in the compiled engine
_OUTCOMES, _STATUSES = list(Outcome), list(Status)
_NOTHING = np.zeros((0, 2))


def time_stepping(
    stack: Stack,
    segments: Segments,
    settings: StackSettings,
    rotation: Sequence[float],
    rates: Sequence[float],
    scale: float,
) -> StackTrajectory:
    """Return a history from rotations [rad] and angular velocities [rad/s]."""
    count, step = len(stack.bodies), segments.step
    bodies, joints = _bodies(stack, settings.gravity, rotation, rates), _joints(stack, settings)
    table, of_joints = np.full((segments.count + 1, 5 * count + 5), np.nan), np.zeros((count, 7))
    vertical = _NOTHING if segments.vertical is None else segments.vertical
    written, outcome, status, fallen, time, moves, events, quality = COMPILED.module().trace(
        bodies, joints, np.ascontiguousarray(segments.horizontal), np.ascontiguousarray(vertical), table, of_joints,
        step, scale, settings.gravity, settings.tolerance, settings.most_events,
        steps_per_segment(stack, segments, settings), segments.moving, not segments.moving,
    )  # fmt: skip
    theta, omega, x, z, slip = np.hsplit(table[:written, 1:-4], 5)
    work, kinetic, potential, lost = table[:written, -4:].T
    opening, peak_slip, normal, ratio, slip_time, gap, flight_time = of_joints.T
    trajectory = StackTrajectory(
        table[:written, 0], theta, omega, np.stack([x, z], axis=-1), slip, work, kinetic, potential, lost,
        opening, peak_slip, normal, ratio, slip_time, _events(events, count), _OUTCOMES[outcome], _STATUSES[status],
        fallen, time, moves and fallen < 0,
    )  # fmt: skip
    trajectory.assumes_sticking, trajectory.engine = False, FAST
    trajectory.largest_gap, trajectory.flight_time = gap, flight_time
    trajectory.unsolved_steps, trajectory.interpenetration, trajectory.energy_created = quality
    return trajectory


def steps_per_segment(stack: Stack, segments: Segments, settings: StackSettings) -> int:
    """Return the number of steps per segment of the motion."""
    radius = min(body.side(foot).semi_diagonal for body in stack.bodies for foot in FEET)
    return max(1, math.ceil(segments.step / (settings.longest_step * math.sqrt(radius / settings.gravity)) - 1e-9))


def _bodies(stack: Stack, gravity: float, rotation: Sequence[float], rates: Sequence[float]) -> FloatArray:
    chain, sides = Chain.of(stack, gravity), _sides(rotation, rates)
    centres, velocities = chain.positions(sides, rotation)[1], chain.velocities(sides, rotation, rates)
    rows = []
    for k, body in enumerate(stack.bodies):
        moments, (left, right) = body.local_moments, body.local_feet
        top = top_edge(body) if k + 1 < len(stack.bodies) else (left, right)
        rows.append([
            body.mass, body.moment_of_inertia, left - moments.x, right - moments.x, -moments.y,
            top[0] - moments.x, top[1] - moments.x, body.local_box[3] - moments.y,
            *centres[k], *velocities[k], rotation[k], rates[k],
        ])  # fmt: skip
    return np.array(rows, dtype=np.float64)


def _joints(stack: Stack, settings: StackSettings) -> FloatArray:
    rows = []
    offsets = np.diff([x for x, _ in stack.centres], prepend=0.0)
    for k, joint in enumerate(stack.joints):
        sides = [stack.side_above(k, foot, settings.gravity) for foot in FEET]
        slow = settings.rest_speed * min(side.frequency_parameter * side.slenderness_angle for side in sides)
        friction, weight = min(stack.friction[k], _STICKS), sides[0].mass * settings.gravity
        rows.append([friction, stack.restitution[k], slow, joint.width, offsets[k], weight])
    return np.array(rows, dtype=np.float64)


def _sides(rotation: Sequence[float], rates: Sequence[float]) -> tuple[int, ...]:
    openings = np.diff(rotation, prepend=0.0)
    speeds = np.diff(rates, prepend=0.0)
    return tuple(int(value) for value in np.sign(np.where(openings != 0.0, openings, speeds)))


def _events(values: Sequence[float], count: int) -> list[StackEvent]:
    events = []
    for time, joint, *numbers in np.reshape(values, (-1, 2 + 3 * count)).tolist():
        rotation, before, after = (tuple(numbers[k * count : (k + 1) * count]) for k in range(3))
        sides = (_sides(rotation, before), _sides(rotation, after))
        events.append(StackEvent(time, int(joint), IMPACT, *sides, rotation, before, after))
    return events
