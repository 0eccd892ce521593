"""Base and stability of a body if points slightly above the ground are contact points."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.equilibria._equilibria import Equilibria, equilibria
from rocking.bodies.equilibria.poses import StablePose
from rocking.conventions import FloatArray, g

TOLERANCES = (0.0, 0.0005, 0.001, 0.002, 0.005)
"""Default tolerances, typical of scans, gaps and dust [m]."""


@dataclass(frozen=True, eq=False)
class BaseTolerance:
    """Stability of a body if all points of its hull up to a tolerance are contact points.

    Parameters
    ----------
    tolerance : float
        Largest height of contact points above the ground [m].
    points : int
        Number of contact points.
    support : ndarray, shape (n, 2)
        Support polygon relative to the projection of the centre of mass, counter-clockwise seen from above [m].
    edge_distance : float
        Distance of the nearest edge from the projection of the centre of mass [m].
    azimuth : float
        Direction of this edge from the projection of the centre of mass [rad].
    uplift_acceleration : float
        Smallest constant ground acceleration with uplift about the nearest edge [m/s2].
    barrier : float
        Energy barrier to another stable pose, as a rise of the centre of mass [m].
    energy : float
        Energy of this rise [J].
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
    equilibria: Equilibria, pose: StablePose | None = None, tolerances: Sequence[float] = TOLERANCES
) -> tuple[BaseTolerance, ...]:
    """Return the stability of a body if points close to the ground are contact points.

    The contact points of a real body are often its largest uncertainty. For each tolerance, all points below this
    height are moved to the ground. Then hull, support polygon and passes are recomputed.

    Parameters
    ----------
    equilibria : Equilibria
        Equilibria of the body.
    pose : StablePose, optional
        Pose of the body; the default is the pose that the body reaches from -z downward.
    tolerances : sequence of float
        Largest heights of contact points above the ground [m].

    Returns
    -------
    tuple of BaseTolerance
        One result per tolerance.

    Raises
    ------
    InvalidValueError
        If a tolerance is negative, or not below the height of the centre of mass.

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
    start = equilibria.settling((0.0, 0.0, -1.0)) if pose is None else pose
    heights = np.atleast_1d(checks.real_array("tolerances", tolerances, "m")).tolist()
    return tuple(_row(equilibria, start, tolerance) for tolerance in heights)


def _row(equilibria_of_body: Equilibria, pose: StablePose, tolerance: float) -> BaseTolerance:
    limit = checks.within("tolerance", tolerance, 0.0, pose.height, unit="m", open_high=True)
    corners, surface = (
        points @ pose.rotation.T for points in (equilibria_of_body.hull.vertices, equilibria_of_body.surface)
    )
    touching = surface[surface[:, 2] + pose.height <= max(limit, equilibria_of_body.flatness)]
    turned = np.concatenate([corners, touching])
    turned[turned[:, 2] + pose.height <= max(limit, equilibria_of_body.flatness), 2] = -pose.height
    down = np.array([0.0, 0.0, -1.0])
    flat = equilibria(
        turned, np.zeros(3), equilibria_of_body.mass, min_barrier=equilibria_of_body.min_barrier, standing=down
    ).settling(down)
    nearest = int(np.argmin(flat.edge_distances))
    chord = np.roll(flat.support, -1, axis=0)[nearest] - flat.support[nearest]
    distance = float(flat.edge_distances[nearest])
    return BaseTolerance(
        limit, len(touching), flat.support, distance, math.atan2(-float(chord[0]), float(chord[1])),
        g * distance / flat.height, flat.barrier, equilibria_of_body.mass * g * flat.barrier,
    )  # fmt: skip
