"""Histories of bodies with restraints, by the requested engine."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.bodies.restrained import Restrained
from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.restrained.devices import devices_of
from rocking.dynamics.restrained.reference import RestrainedReference, RestrainedTrajectory
from rocking.dynamics.restrained.settings import RestrainedSettings
from rocking.dynamics.settings import check_progress
from rocking.motions.segments import Segments

RESULTS: dict[str, Any] = {
    "outcome": np.int8, "status": np.int8, "side": np.int8, "peak_rotation": np.float64, "peak_time": np.float64,
    "peak_velocity": np.float64, "overturning_time": np.float64, "first_uplift": np.float64, "impacts": np.int64,
    "uplifts": np.int64, "still_rocking": np.int8, "residual_rotation": np.float64,
}  # fmt: skip
"""Results of every history, with their types."""
RESTRAINT_RESULTS = (
    "largest_force", "smallest_force", "largest_elongation", "smallest_elongation", "plastic_elongation", "yield_count",
    "is_broken", "dissipated_energy",
)  # fmt: skip
"""Results of every restraint of a history."""


@dataclass(frozen=True)
class History:
    """Inputs of one history."""

    body: Restrained
    parameters: RockingParameters
    motion: int  # index
    start: tuple[float, float]  # theta [rad], theta' [rad/s]
    scale: float
    length: float  # [s]


def run(
    body: Restrained,
    parameters: RockingParameters,
    segments: Segments,
    settings: RestrainedSettings,
    start: tuple[float, float],
    *,
    scale: float = 1.0,
    stream: int = 0,
    engine: str = "auto",
) -> RestrainedTrajectory:
    """Return one history from theta [rad] and theta' [rad/s]."""
    devices = devices_of(body, linear=settings.linear)
    reference = RestrainedReference(parameters, body.mass, devices, segments, settings, scale, stream)
    return reference.run(*start)


def run_rows(
    histories: Sequence[History],
    segments: Sequence[Segments],
    settings: RestrainedSettings,
    *,
    engine: str,
    threads: int,
    progress: Callable[[int], None] | None = None,
) -> tuple[str, dict[str, np.ndarray], dict[str, FloatArray]]:
    """Return the name of the engine, and the results of histories and of their restraints."""
    check_progress(progress)
    width = max(len(history.body.restraints) for history in histories)
    results = {name: np.zeros(len(histories), dtype) for name, dtype in RESULTS.items()}
    restraints = {name: np.full((len(histories), width), np.nan) for name in RESTRAINT_RESULTS}
    for k, history in enumerate(histories):
        motion = segments[history.motion].extended(history.length)
        count = max(1, math.ceil(history.length / motion.step - 1e-9))
        trajectory = run(
            history.body, history.parameters, motion.first(count), settings, history.start, scale=history.scale,
            engine="reference",
        )  # fmt: skip
        for name, value in summary_of(trajectory).items():
            results[name][k] = value
        for i, device in enumerate(trajectory.devices):
            for name, value in device.summary.items():
                restraints[name][k, i] = value
        if progress is not None:
            progress(1)
    return "reference", results, restraints


def summary_of(trajectory: RestrainedTrajectory) -> dict[str, Any]:
    """Return the results of one history by the names of `RESULTS`."""
    codes = {"outcome": trajectory.outcome.code, "status": trajectory.status.code}
    last = trajectory.rotation[np.isfinite(trajectory.rotation)][-1]
    values = {name: getattr(trajectory, name) for name in RESULTS if name not in {*codes, "residual_rotation"}}
    return codes | values | {"residual_rotation": last}
