"""Vertical velocities vanish, the angular momentum of the rest is kept, in space."""

from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.restitution.space.impact import SpatialImpact
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

    def angular_velocity(self, impact: SpatialImpact) -> FloatArray:
        return impact.with_momentum(impact.level_momentum)
