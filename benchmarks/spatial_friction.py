"""Friction demand of impacts, and limits of the agreement with the friction law of a peer.

A vertex that separates in an impact slides while it rises. In a convex contact law (MuJoCo) friction holds the vertex
unless it rises at least as fast as mu times its slip; a complementarity law releases it. Such a peer can therefore
agree only if mu is above the demand of the new contact, |Jt| / Jn, and below the slope of the old one, vn / |vt|.
"""

import math
from dataclasses import dataclass

import numpy as np

from rocking.dynamics.rolling import SpatialResponse


@dataclass(frozen=True)
class Demand:
    """Of one impact: friction that the new contact needs [-], slope at which the old one leaves [-]."""

    time: float
    needed: float
    slope: float


def demands(response: SpatialResponse, until: float = math.inf) -> list[Demand]:
    """Demands of impacts between vertices, in order."""
    body, impacts = response.body, []
    for time in response.impacts["time"]:
        if time > until:
            break
        instants = response.at([time * (1.0 - 1e-9), time * (1.0 + 1e-9)])
        change = body.mass * np.diff(instants.centre_velocity, axis=0)[0]
        arm = instants.pivot[0] - instants.pivot[1]
        leaves = instants.rotation[1] @ np.cross(instants.body_velocity[1], arm)
        impacts.append(Demand(float(time), _ratio(math.hypot(*change[:2]), change[2]), _slope(leaves)))
    return impacts


def _slope(velocity: np.ndarray) -> float:
    along = math.hypot(*velocity[:2])
    return math.inf if along < 1e-12 else float(velocity[2]) / along


def _ratio(along: float, up: float) -> float:
    return math.inf if not up > 0.0 else along / float(up)
