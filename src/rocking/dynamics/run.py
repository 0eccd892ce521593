"""One history, by the engine that was asked for."""

import math
from dataclasses import replace

import numpy as np

from rocking.dynamics import engine as fast_engine
from rocking.dynamics.reference import Reference
from rocking.dynamics.response import Response
from rocking.dynamics.rocker import Rocker
from rocking.dynamics.settings import Settings
from rocking.dynamics.trajectory import Trajectory
from rocking.motions.segments import Segments


def run(
    rocker: Rocker,
    segments: Segments,
    settings: Settings,
    *,
    engine: str = "auto",
    scale: float = 1.0,
    key: int = 0,
    rotation: float = 0.0,
    velocity: float = 0.0,
) -> Trajectory:
    """Return one history.

    Parameters
    ----------
    rocker : Rocker
        The body.
    segments : Segments
        The motion [m/s2].
    settings : Settings
        How to integrate.
    engine : {"auto", "fast", "reference"}
        Which engine; "auto" takes the fast one if it was built.
    scale : float
        Factor on the motion [-].
    key : int
        Number of the history, for random coefficients.
    rotation, velocity : float
        theta [rad] and theta' [rad/s] at time zero.

    Returns
    -------
    Trajectory
        The history.
    """
    if fast_engine.chosen(engine) == "reference":
        made = Reference(rocker, segments, settings, scale=scale, key=key)
        return made.run(rotation, velocity)
    from rocking.dynamics.fast import run_fast

    return run_fast(rocker, segments, settings, scale=scale, key=key, rotation=rotation, velocity=velocity)


def rerun_finer(response: Response) -> float:
    """Return how much a response changes when every step is halved.

    Parameters
    ----------
    response : Response
        The response.

    Returns
    -------
    float
        Largest change of theta at the samples that both have; infinite if the outcome changes [rad].
    """
    name = "reference" if response.engine.startswith("reference") else "fast"
    settings = replace(response.settings, longest_step=0.5 * response.settings.longest_step)
    first = response.trajectory
    again = run(
        response.rocker, response.segments.refined(2), settings, engine=name, scale=response.scale, key=response.key,
        rotation=float(first.rotation[0]), velocity=float(first.angular_velocity[0]),
    )  # fmt: skip
    if again.outcome is not first.outcome:
        return math.inf
    change = np.abs(again.rotation[::2] - first.rotation)
    return float(np.nanmax(change))
