"""The curves of a response as they are drawn: samples that matter, and the state just before every impact."""

from typing import Any

import numpy as np

from rocking.app.api.series import merged, thinned
from rocking.conventions import FloatArray
from rocking.dynamics import equations
from rocking.dynamics.response import Response
from rocking.motions.kinematics import ground_displacement
from rocking.motions.pulse import Pulse
from rocking.report.facts.response import finite


def response_series(response: Response, points: int) -> dict[str, Any]:
    """Return the curves of a response.

    Parameters
    ----------
    response : Response
        The response.
    points : int
        How many samples at most; the impacts come besides.

    Returns
    -------
    dict
        ``time``, ``rotation``, ``velocity``, ``kinetic``, ``potential``, ``work``, ``lost``, ``friction_demand`` (None
        where it is infinite), ``vertical_force``, ``ground_acceleration``, ``ground_displacement``: SI units; and
        ``shown`` of how many samples (``of``).
    """
    kept = thinned((response.rotation, response.angular_velocity, response.ground_acceleration), points)
    time, at = merged(response.time[kept], response.impacts["time"])
    samples_at, before = np.searchsorted(time, response.time[kept]), _before_impacts(response, time[at])
    columns = {}
    for name, values in _curves(response).items():
        columns[name] = np.empty_like(time)
        columns[name][samples_at], columns[name][at] = values[kept], before[name]
    return {
        "time": time.tolist(),
        **{name: values.tolist() for name, values in columns.items() if name != "friction_demand"},
        "friction_demand": [finite(value) for value in columns["friction_demand"].tolist()],
        "ground_displacement": _moved(response, time).tolist(),
        "shown": int(time.size),
        "of": int(response.time.size),
    }


def _curves(response: Response) -> dict[str, FloatArray]:
    """Return every curve at every sample."""
    size, energy, forces = response.time.size, response.energy, response.contact
    return {
        "rotation": response.rotation,
        "velocity": response.angular_velocity,
        "kinetic": energy.kinetic[:size],
        "potential": energy.potential[:size],
        "work": energy.work[:size],
        "lost": energy.lost[:size],
        "friction_demand": _demand(forces.horizontal[:size], forces.vertical[:size]),
        "vertical_force": forces.vertical[:size],
        "ground_acceleration": response.ground_acceleration,
    }


def _before_impacts(response: Response, instants: FloatArray) -> dict[str, FloatArray]:
    """Return the state just before impacts."""
    intervals, mass, energy = response.intervals, response.body.mass, response.energy
    k = intervals.places(instants)
    speed, side = intervals.velocity[k, 1], intervals.side[k]
    pull = response.settings.gravity + intervals.lift[k, 1]
    f_x, f_z = equations.reactions(
        intervals.rotation[k, 1], speed, intervals.acceleration[k, 1], side, intervals.alpha[k],
        intervals.semi_diagonal[k], intervals.push[k, 1], pull,
    )  # fmt: skip
    kinetic = mass * response.settings.gravity * intervals.semi_diagonal[k] * 0.5 * np.square(speed / intervals.p[k])
    lost = energy.lost[np.maximum(np.searchsorted(response.time, instants, side="right") - 1, 0)]
    return {
        "rotation": np.zeros_like(instants),
        "velocity": speed,
        "kinetic": kinetic,
        "potential": np.zeros_like(instants),
        "lost": lost,
        "work": kinetic + lost - energy.kinetic[0] - energy.potential[0],
        "friction_demand": _demand(f_x, f_z),
        "vertical_force": mass * f_z,
        "ground_acceleration": intervals.push[k, 1],
    }


def _demand(horizontal: FloatArray, vertical: FloatArray) -> FloatArray:
    held = vertical > 0.0
    return np.where(held, np.abs(horizontal) / np.where(held, vertical, 1.0), np.inf)


def _moved(response: Response, time: FloatArray) -> FloatArray:
    """Return the displacement of the ground, which is taken to stay where the motion ends."""
    motion = response.motion
    if motion is None:
        return np.zeros_like(time)
    if isinstance(motion, Pulse):
        return response.scale * motion.displacement(np.minimum(time, motion.duration))
    return response.scale * np.interp(time, motion.time, ground_displacement(motion))
