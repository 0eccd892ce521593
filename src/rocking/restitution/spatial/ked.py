"""KED in space: the paper's three stages with this project's closure for the direction."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.bodies.solid import Edge
from rocking.conventions import FloatArray
from rocking.restitution.spatial.geometry import LEVEL, UP, SpatialImpact
from rocking.restitution.spatial.horizontal_momentum import SpatialHorizontalMomentum
from rocking.restitution.spatial.integrals import line_matrix, line_moment, point_matrix
from rocking.restitution.spatial.model import SpatialModel

_PLANE = 1e-14


@dataclass(frozen=True)
class SpatialKed(SpatialModel):
    """Kinetic energy distribution in space: momentum gives the direction, energy the magnitude.

    Stage 1 removes the vertical velocity of every mass point, ``v = P_h v_-``; stage 2 the part along the line to
    the new corner, ``v'' = (1 - d d^T) v``, or all but the part that turns about the new edge. Energy alone fixes no
    direction in space, so that the closure is this project's own: ``I_B w* = Int s x v'' dm`` and
    ``omega_+ = w* sqrt(2 T''/(w* . I_B w*))``. The factor is never below 1 (Cauchy-Schwarz), and a plane motion
    about an edge gives Eq. 17, Mao et al. 2024.
    """

    name = "ked-3d"
    title = "kinetic energy distribution over the mass points in space (the paper, with this project's closure)"
    reference = "Mao, Deng, Shen & Wang 2024, doi:10.3390/buildings14072119, extended to space in this project"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "the vertical velocity of every mass point is lost, then its part along the line to the new corner",
        "the kinetic energy that is left becomes rotation in the direction of the angular momentum that is left",
    )
    domain = "every impact on one corner or edge; the paper publishes homogeneous rectangles in the plane"
    known_defects = (
        "all defects of KED in the plane",
        "the closure is a choice: the paper's energy alone fixes no direction in space",
        "about a point and about a line through it the coefficients differ (0.9132 and 0.9125 for a prism 1 x 1 x 4 "
        "over its diagonal)",
    )

    def on_corner(self, impact: SpatialImpact) -> FloatArray:
        """Return the direction of the momentum left, times what gives it the energy left.

        Parameters
        ----------
        impact : SpatialImpact
            The impact.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity [rad/s].
        """
        direction = SpatialHorizontalMomentum().on_corner(impact)
        twice = float(direction @ impact.inertia @ direction)
        if twice == 0.0:
            return direction
        return direction * math.sqrt(2.0 * energy_left(impact) / twice)

    def on_edge(self, impact: SpatialImpact, direction: FloatArray) -> float:
        """Return the angular velocity that the energy left gives, with the sign of the momentum left.

        Parameters
        ----------
        impact : SpatialImpact
            The impact.
        direction : ndarray, shape (3,)
            Unit vector along the edge [-].

        Returns
        -------
        float
            Angular velocity [rad/s].
        """
        sign = float(np.sign(SpatialHorizontalMomentum().on_edge(impact, direction)))
        return sign * math.sqrt(2.0 * energy_left(impact) / float(direction @ impact.inertia @ direction))


def energy_left(impact: SpatialImpact) -> float:
    """Return the kinetic energy after stage 2, T'' [J].

    Parameters
    ----------
    impact : SpatialImpact
        The impact.

    Returns
    -------
    float
        Energy [J].
    """
    if isinstance(impact.onto, Edge):
        return 0.5 * _kept_about_line(impact, impact.onto)
    point, drift = impact.onto.point, impact.landing_velocity
    state = np.array([*impact.velocity[:2], *drift[:2]])
    return impact.level_energy - 0.5 * float(state @ point_matrix(impact.solid, point) @ state)


def _kept_about_line(impact: SpatialImpact, edge: Edge) -> float:
    velocity, across = impact.velocity, np.cross(edge.direction, UP)
    state = np.array([velocity @ edge.direction, velocity[2], impact.landing_velocity @ across])
    slow = _PLANE * impact.speed
    if abs(state[1]) <= slow and abs(state[2]) <= slow * impact.solid.size:
        return float(state[0] ** 2) * line_moment(impact.solid, edge)
    return float(state @ line_matrix(impact.solid, edge) @ state)


def stage_velocities(impact: SpatialImpact, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the velocities of mass points before the impact, after stage 1 and after stage 2.

    Parameters
    ----------
    impact : SpatialImpact
        The impact.
    points : ndarray, shape (n, 3)
        Points in the body's frame [m].

    Returns
    -------
    before, level, left : ndarray, shape (n, 3)
        Velocities [m/s].
    """
    arms = points - impact.onto.point
    before = impact.velocities(arms)
    level = before @ LEVEL
    if isinstance(impact.onto, Edge):
        allowed = _unit(np.cross(impact.onto.direction, arms))
        return before, level, allowed * np.einsum("nd,nd->n", allowed, level)[:, None]
    outward = _unit(arms)
    return before, level, level - outward * np.einsum("nd,nd->n", outward, level)[:, None]


def _unit(vectors: FloatArray) -> FloatArray:
    sizes = np.linalg.norm(vectors, axis=1, keepdims=True)
    units: FloatArray = np.divide(vectors, sizes, out=np.zeros_like(vectors), where=sizes > 0.0)
    return units
