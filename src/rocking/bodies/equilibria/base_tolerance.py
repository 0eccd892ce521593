"""What a body would stand on, and how firmly, if points a little above the ground touched it too."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.equilibria._equilibria import Equilibria, equilibria
from rocking.bodies.equilibria.poses import StablePose
from rocking.conventions import FloatArray, g

TOLERANCES = (0.0, 0.0005, 0.001, 0.002, 0.005)
"""By default [m]: what a scan, a gap or dust leaves open."""


@dataclass(frozen=True, eq=False)
class BaseTolerance:
    """How a body would stand if all points of its hull up to some height touched the ground.

    Parameters
    ----------
    tolerance : float
        That height [m].
    points : int
        How many vertices of the hull would touch.
    support : ndarray, shape (n, 2)
        Support polygon from the plumb line, counter-clockwise seen from above [m].
    edge_distance : float
        Distance of its nearest edge from the plumb line [m].
    azimuth : float
        Direction of that edge from the plumb line [rad].
    uplift_acceleration : float
        Least steady acceleration of the ground that lifts the body, over that edge [m/s2].
    barrier : float
        Rise of the centre on the lowest way into another stable pose [m].
    energy : float
        What this rise costs [J].
    """

    tolerance: float
    points: int
    support: FloatArray
    edge_distance: float
    azimuth: float
    uplift_acceleration: float
    barrier: float
    energy: float


def base_tolerances(
    found: Equilibria, pose: StablePose | None = None, tolerances: Sequence[float] = TOLERANCES
) -> tuple[BaseTolerance, ...]:
    """Return what would change if the points of the surface that are close to the ground touched it.

    How a real body touches the ground is often the largest uncertainty about it. The points within each tolerance are
    taken down onto the ground, and the hull, its support polygon and its passes are computed anew.

    Parameters
    ----------
    found : Equilibria
        Of the body.
    pose : StablePose, optional
        In which it stands; by default the one into which it settles with -z downward.
    tolerances : sequence of float
        Heights up to which points touch [m].

    Returns
    -------
    tuple of BaseTolerance
        One for each tolerance.

    Raises
    ------
    InvalidValueError
        If a tolerance is negative or as large as the height of the centre.

    Examples
    --------
    >>> from rocking.bodies.equilibria import equilibria
    >>> import numpy as np
    >>> corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 2)]) * 0.1
    >>> foot = np.append(corners, [[0.11, 0.05, 0.0008]], axis=0)
    >>> rows = base_tolerances(equilibria(foot, foot.mean(axis=0), 1.0), tolerances=(0.0, 0.001))
    >>> [len(row.support) for row in rows]
    [4, 5]
    """
    start = found.settling((0.0, 0.0, -1.0)) if pose is None else pose
    heights = np.atleast_1d(checks.real_array("tolerances", tolerances, "m")).tolist()
    return tuple(_row(found, start, tolerance) for tolerance in heights)


def _row(found: Equilibria, pose: StablePose, tolerance: float) -> BaseTolerance:
    most = checks.within("tolerance", tolerance, 0.0, pose.height, unit="m", open_high=True)
    corners, surface = (points @ pose.rotation.T for points in (found.hull.vertices, found.surface))
    touching = surface[surface[:, 2] + pose.height <= max(most, found.flatness)]
    turned = np.concatenate([corners, touching])
    turned[turned[:, 2] + pose.height <= max(most, found.flatness), 2] = -pose.height
    down = np.array([0.0, 0.0, -1.0])
    flat = equilibria(turned, np.zeros(3), found.mass, min_barrier=found.min_barrier, standing=down).settling(down)
    nearest = int(np.argmin(flat.edge_distances))
    chord = np.roll(flat.support, -1, axis=0)[nearest] - flat.support[nearest]
    distance = float(flat.edge_distances[nearest])
    return BaseTolerance(
        most, len(touching), flat.support, distance, math.atan2(-float(chord[0]), float(chord[1])),
        g * distance / flat.height, flat.barrier, found.mass * g * flat.barrier,
    )  # fmt: skip
