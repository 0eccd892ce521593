"""Vertical velocities vanish, the angular momentum of the rest is kept, in space."""

from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.portable import applied, dot
from rocking.restitution.space.impact import RigidImpact, solved
from rocking.restitution.space.model import SpatialModel


@dataclass(frozen=True)
class SpatialHorizontalMomentum(SpatialModel):
    """KED's first stage followed by conservation of angular momentum, in space.

    ``I_B w* = Int s x P_h v_- dm``; about an edge its component along the edge.
    """

    name = "horizontal-momentum-3d"
    title = "vertical velocities vanish, angular momentum of the horizontal ones is kept"
    reference = "derived in this project from stage 1 of Mao et al. 2024, doi:10.3390/buildings14072119"
    assumptions = (
        "the impact removes the vertical velocity of every mass point, as in KED",
        "what is left keeps its angular momentum about the new corner or edge",
    )
    domain = "every impact on one corner or edge"
    known_defects = (
        "where the old pivot was matters only as far as the body spins about the vertical: with both pivots in one "
        "place (no impact at all) it still loses energy",
        "no force model stands behind it",
    )

    def on_corner(self, impact: RigidImpact) -> FloatArray:
        """Solve for the angular velocity with the angular momentum of the horizontal velocities."""
        return solved(impact.inertia, impact.level_momentum)  # Eq. 102

    def on_edge(self, impact: RigidImpact, direction: FloatArray) -> float:
        """Divide the angular momentum of the horizontal velocities by the moment of inertia about the edge."""
        return dot(direction, impact.level_momentum) / dot(direction, applied(impact.inertia, direction))  # Eq. 89
