"""The three stages of KED in plain values: how much kinetic energy each leaves, and which velocities."""

from typing import Any

import numpy as np

from rocking.bodies import Body, MassPoints
from rocking.conventions import FloatArray, Foot
from rocking.restitution import EnergyBalance, energy_balance

_ARROWS = 7
_WORDS = {
    "before": "before the impact",
    "stage 1": "stage 1: vertical part lost",
    "stage 2": "stage 2: part along O'S lost",
    "after": "stage 3: redistributed",
}


def stages_facts(body: Body, onto: Foot, angular_velocity: float = 1.0) -> dict[str, Any]:
    """Return the energy balance of an impact with a field of velocities for each stage.

    angular_velocity: angular velocity before the impact [rad/s]. Returns ``velocity_before_rad_s``,
    ``velocity_after_rad_s``, ``points_m`` at which the fields are given, and ``stages``: ``name``, ``words``,
    ``energy_J``, ``share`` and ``velocity_m_s`` at the points.
    """
    balance = energy_balance(body, onto=onto, angular_velocity=angular_velocity)
    points = _places(body)
    fields = balance.velocities(points[:, 0], points[:, 1])
    return {
        "velocity_before_rad_s": balance.velocity_before,
        "velocity_after_rad_s": balance.velocity_after,
        "points_m": points.tolist(),
        "stages": [_stage(balance, name, fields[name]) for name in balance.totals],
    }


def _stage(balance: EnergyBalance, name: str, field: FloatArray) -> dict[str, Any]:
    return {
        "name": name,
        "words": _WORDS[name],
        "energy_J": balance.totals[name],
        "share": balance.shares[name],
        "velocity_m_s": field.tolist(),
    }


def _places(body: Body) -> FloatArray:
    """Return points within a body, in rows and columns; of mass points themselves."""
    if isinstance(body, MassPoints):
        return np.asarray(body.points, dtype=np.float64)
    x0, _, x1, height = body.local_box
    step = max(x1 - x0, height) / (2.0 * _ARROWS)
    x, y = np.meshgrid(np.arange(x0 + 0.5 * step, x1, step), np.arange(0.5 * step, height, step))
    points = np.stack([x.ravel() + body.origin_x, y.ravel() + body.ground], axis=-1)
    return points[body.density_at(points[:, 0], points[:, 1]) > 0.0]
