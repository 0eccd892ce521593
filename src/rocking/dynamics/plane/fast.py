"""One history by the fast engine, with all its samples and events."""

import numpy as np

from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.plane.trajectory import Event, EventKind, Trajectory
from rocking.dynamics.settings import Settings
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, Status

_OUTCOMES, _STATUSES, _KINDS = list(Outcome), list(Status), {kind.value: kind for kind in EventKind}


def run_fast(
    parameters: RockingParameters,
    segments: Segments,
    settings: Settings,
    *,
    scale: float = 1.0,
    stream: int = 0,
    rotation: float = 0.0,
    velocity: float = 0.0,
) -> Trajectory:
    """Return one history by the fast engine; the numbers are those that it gives within a batch, bit for bit.

    segments: the motion, of degree 1 or 7 [m/s2]; scale: factor on the motion [-]; rotation, velocity: theta [rad] and
    theta' [rad/s] at time zero.
    """
    library = fast_engine.Library([segments])
    values = {
        "alpha_right": parameters.right.slenderness_angle, "alpha_left": parameters.left.slenderness_angle,
        "p_right": parameters.right.frequency_parameter, "p_left": parameters.left.frequency_parameter,
        "q_right": parameters.right.inertia_ratio, "q_left": parameters.left.inertia_ratio,
        "r_right": parameters.right.coefficient, "r_left": parameters.left.coefficient,
        "share_right": parameters.right.share, "share_left": parameters.left.share,
        "scale": scale, "rotation": rotation, "velocity": velocity,
    }  # fmt: skip
    rows = {name: np.array([value]) for name, value in values.items()}
    rows |= {"motion": np.zeros(1, np.int64), "key": np.array([stream], np.int64)}
    out = fast_engine.empty_results(1)
    rotations, velocities = np.zeros(segments.count + 1), np.zeros(segments.count + 1)
    arguments = fast_engine.common(settings, parameters.law)
    noted = fast_engine.module().run_single(
        library.handle, rows, out, to_the_ground=True, rotation=rotations, velocity=velocities, **arguments
    )
    outcome = _OUTCOMES[out["outcome"][0]]
    if outcome in {Outcome.OVERTURNED, Outcome.FAILED}:
        latest = max((event[0] for event in noted), default=0.0)
        after = max(_last_written(rotations, velocities), int(latest / segments.step) + 1)
        rotations[after:] = velocities[after:] = np.nan
    return Trajectory(
        rotation=rotations,
        angular_velocity=velocities,
        events=[Event(t, _KINDS[kind], side, before, then, r) for t, kind, side, before, then, r in noted],
        outcome=outcome,
        status=_STATUSES[out["status"][0]],
        side=int(out["side"][0]),
        peak_rotation=float(out["peak_rotation"][0]),
        peak_time=float(out["peak_time"][0]),
        peak_angular_velocity=float(out["peak_velocity"][0]),
        overturning_time=float(out["overturning_time"][0]),
        impacts=int(out["impacts"][0]),
        uplifts=int(out["uplifts"][0]),
        truncation=float(out["truncation"][0]),
        least_force=float(out["least_force"][0]),
        friction_demand=float(out["friction_demand"][0]),
        engine=f"fast (Taylor, order 8, {arguments['isa']})",
    )


def _last_written(rotations: np.ndarray, velocities: np.ndarray) -> int:
    moving = np.flatnonzero((rotations != 0.0) | (velocities != 0.0))
    return int(moving[-1]) + 1 if moving.size else 1
