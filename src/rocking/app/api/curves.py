"""The curves of a response as they are drawn: every state that matters, thinned to the dots of the picture."""

from typing import Any

import numpy as np

from rocking.app.api.series import thinned
from rocking.conventions import FloatArray
from rocking.dynamics.contact import forces
from rocking.dynamics.intervals import Intervals
from rocking.dynamics.ledger import energies
from rocking.dynamics.response import Response
from rocking.motions.kinematics import ground_displacement
from rocking.motions.pulse import Pulse
from rocking.plots.animation_scene import Shape
from rocking.plots.lying import fall_of
from rocking.report.facts.response import finite

_NEWTON_STEPS = 8


def response_series(response: Response, points: int, window: tuple[float, float] | None = None) -> dict[str, Any]:
    """Return the curves of a response.

    window: the part of the time that is drawn [s]. Returns ``time``, ``rotation``, ``velocity``, ``kinetic``,
    ``potential``, ``work``, ``lost``, ``friction_demand`` (None where it is infinite), ``vertical_force``,
    ``ground_acceleration``, ``ground_displacement``: SI units; and ``shown`` of how many states (``of``): samples,
    events with the states before and after them, and where the body turns round.
    """
    whole, curves = _states(response)
    kept = thinned(whole, list(curves.values()), points, window)
    time, columns = whole[kept], {name: values[kept].tolist() for name, values in curves.items()}
    return {
        "time": time.tolist(),
        **columns,
        "friction_demand": [finite(value) for value in columns["friction_demand"]],
        "ground_displacement": _moved(response, time).tolist(),
        "shown": int(time.size),
        "of": int(whole.size),
    }


def fall_series(response: Response) -> dict[str, Any]:
    """Return how the fall of a response goes on after its curves end.

    Returns ``time`` [s] and ``rotation`` [rad], empty if there is no more to fall; ``lying``: the rotations at which
    the body lies on its left and on its right side [rad].
    """
    lying = Shape.of(response.body).lying
    fall = fall_of(response, lying)
    return {"time": fall.time[1:].tolist(), "rotation": fall.rotation[1:].tolist(), "lying": list(lying)}


def _states(response: Response) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Return times and curves; what comes after a jump stands the smallest step of time after it."""
    intervals = response.intervals
    curves = _at_both_ends(response, intervals)
    jumps = np.any([np.append(True, each[1:, 0] != each[:-1, 1]) for each in curves.values()], axis=0)
    turns, x = _turns(intervals)
    late = np.nextafter(intervals.start, np.inf)
    late[0] = intervals.start[0]
    # of those at one instant the first stays: the state before an event, at it
    time = np.concatenate([intervals.end, late[jumps], intervals.start[turns] + x * intervals.length[turns]])
    time, chosen = np.unique(time, return_index=True)
    turned = {
        "rotation": (intervals.quintics()[turns] * x[:, None] ** np.arange(6)).sum(axis=1),
        "velocity": np.zeros(x.size),
    }
    columns = {}
    for name, each in curves.items():
        between = turned.get(name, each[turns, 0] + x * (each[turns, 1] - each[turns, 0]))
        columns[name] = np.concatenate([each[:, 1], each[jumps, 0], between])[chosen]
    return time, columns


def _at_both_ends(response: Response, intervals: Intervals) -> dict[str, FloatArray]:
    """Return every curve at the start and at the end of every interval."""
    mass, settings = response.body.mass, response.settings
    kinetic, potential, work, lost = energies(intervals, mass, settings)
    _, vertical, demand = forces(intervals, settings.gravity)
    return {
        "rotation": intervals.rotation,
        "velocity": intervals.velocity,
        "kinetic": kinetic,
        "potential": potential,
        "work": work,
        "lost": lost,
        "friction_demand": demand,
        "vertical_force": mass * vertical,
        "ground_acceleration": intervals.push,
    }


def _turns(intervals: Intervals) -> tuple[np.ndarray, FloatArray]:
    """Return in which intervals the body turns round, and where within them, from 0 to 1."""
    at = np.flatnonzero(intervals.velocity[:, 0] * intervals.velocity[:, 1] < 0.0)
    c, (start, end) = intervals.quintics()[at], intervals.velocity[at].T
    x, power = start / (start - end), np.arange(6)
    for _ in range(_NEWTON_STEPS):
        slope = (c[:, 1:] * power[1:] * x[:, None] ** power[:5]).sum(axis=1)
        bend = (c[:, 2:] * (power[2:] * power[1:5]) * x[:, None] ** power[:4]).sum(axis=1)
        x = np.clip(x - np.divide(slope, bend, out=np.zeros_like(x), where=bend != 0.0), 0.0, 1.0)
    return at, x


def _moved(response: Response, time: FloatArray) -> FloatArray:
    """Return the displacement of the ground, which is taken to stay where the motion ends."""
    motion = response.motion
    if motion is None:
        return np.zeros_like(time)
    if isinstance(motion, Pulse):
        return response.scale * motion.displacement(np.minimum(time, motion.duration))
    return response.scale * np.interp(time, motion.time, ground_displacement(motion))
