"""Where the energy of a body in space goes: work of the ground in, losses at impacts out, the rest stays."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.plane.energy_balance import ResponseEnergy
from rocking.dynamics.space.states import States, pivots
from rocking.dynamics.space.trajectory import StepPiece
from rocking.portable import applied, gauss_legendre

if TYPE_CHECKING:
    from rocking.dynamics.space.response import SpatialResponse

_NODES, _WEIGHTS = gauss_legendre(20)


def energy_of(response: "SpatialResponse") -> ResponseEnergy:
    """Return the energy of a response in space.

    The work of the ground is integrated along the history, -m a_g . v_C by Gauss's rule on every step of the engine;
    the losses are those of the impacts. Nothing is computed from the balance, so that the balance can be checked.
    """
    body, time = response.body, response.time
    states, impacts = response.states, response.trajectory.impacts
    lost = np.concatenate([[0.0], np.cumsum([event.before - event.after for event in impacts])])
    when = np.array([event.time for event in impacts])
    found = lost[np.searchsorted(when, time, side="right")]
    return ResponseEnergy(
        time=time,
        kinetic=states.kinetic,
        potential=body.mass * response.settings.gravity * states.rise,
        work=_work(response),
        lost=found - found[0],  # an impact at the start comes before the first sample
    )


def _work(response: "SpatialResponse") -> FloatArray:
    """Work of the ground up to each sample."""
    made, total = np.zeros(response.time.size), 0.0
    for piece in response.trajectory.pieces:
        first, last = np.searchsorted(response.time, [piece.start, piece.end], side="left")
        stops = np.concatenate([[piece.start], response.time[first:last], [piece.end]])
        if piece.end > piece.start and len(piece.quaternions) > 1 and piece.start < response.ground.end:
            parts = _of_piece(response, piece, stops)
            made[first:last] = total + np.cumsum(parts)[:-1]
            total += float(parts.sum())
        else:
            made[first:last] = total
    made[response.time >= response.trajectory.pieces[-1].end] = total
    return made


def _of_piece(response: "SpatialResponse", piece: StepPiece, stops: FloatArray) -> FloatArray:
    """Work between the stops of a step."""
    half = 0.5 * np.diff(stops)
    times = (0.5 * (stops[1:] + stops[:-1]))[:, None] + half[:, None] * _NODES
    q, w, place = piece.at(np.clip((times.ravel() - piece.start) / piece.length, 0.0, piece.until))
    body = response.body
    states = States(body, q, w, pivots(body, piece, q), place, np.zeros(len(q), dtype=np.int64))
    power = -body.mass * (response.ground.at(times.ravel()) * states.centre_velocity).sum(axis=1)  # Eq. 46
    return applied(power.reshape(times.shape), _WEIGHTS) * half
