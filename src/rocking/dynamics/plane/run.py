"""One history, by the engine that was asked for."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.plane.trajectory import Trajectory
from rocking.dynamics.settings import SHORTEST_STEP, Settings
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments

if TYPE_CHECKING:
    from rocking.dynamics.response import Response

_ORDER = 8


def run(
    parameters: RockingParameters,
    segments: Segments,
    settings: Settings,
    *,
    engine: str = "auto",
    scale: float = 1.0,
    stream: int = 0,
    rotation: float = 0.0,
    velocity: float = 0.0,
) -> Trajectory:
    """Return one history.

    segments: the motion [m/s2]; scale: factor on the motion [-]; rotation, velocity: theta [rad] and theta' [rad/s] at
    time zero.
    """
    taken = fast_engine.chosen(engine, parameters.law)
    if engine != "reference" and settings.order != _ORDER:
        raise InvalidValueError(
            f"order must be {_ORDER} for one history, got {settings.order}: orders 4 and 6 exist only in batches "
            "(simulate_many), for nonlinear equations and motions without a vertical part"
        )
    if taken == "reference":
        from rocking.dynamics.plane.reference import Reference

        made = Reference(parameters, segments, settings, scale=scale, stream=stream)
        return made.run(rotation, velocity)
    from rocking.dynamics.plane.fast_engine import run_fast

    return run_fast(parameters, segments, settings, scale=scale, stream=stream, rotation=rotation, velocity=velocity)


def rerun_finer(response: "Response") -> float:
    """Return how much a response changes when every step is halved.

    Where the steps of the fast engine are as short as they may be, the reference engine stands in for shorter ones.

    Returns largest change of theta at the samples that both have; infinite if the outcome changes [rad].
    """
    name, settings = "reference", response.settings
    half = 0.5 * settings.longest_step
    if response.engine.startswith("fast") and half >= SHORTEST_STEP:
        name, settings = "fast", replace(settings, longest_step=half)
    first = response.trajectory
    again = run(
        response.parameters, response.segments.refined(2), settings, engine=name, scale=response.scale,
        stream=response.stream, rotation=float(first.rotation[0]), velocity=float(first.angular_velocity[0]),
    )  # fmt: skip
    if again.outcome is not first.outcome:
        return math.inf
    change = np.abs(again.rotation[::2] - first.rotation)  # Eq. 47
    return float(np.nanmax(change))
