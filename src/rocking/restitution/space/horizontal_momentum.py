"""Horizontal momentum in 3D: vertical velocities vanish, and angular momentum of horizontal velocities is conserved."""

from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.restitution.space.impact import SpatialImpact
from rocking.restitution.space.model import SpatialModel


@dataclass(frozen=True)
class SpatialHorizontalMomentum(SpatialModel):
    """First stage of KED in 3D, followed by conservation of angular momentum.

    ``I_B w* = Int s x P_h v_- dm``. About an edge, only the component along the edge is used.
    """

    name = "horizontal-momentum-3d"
    title = "vertical velocities vanish, angular momentum of the horizontal velocities is conserved"
    reference = "derived in this project from stage 1 of Mao et al. 2024, doi:10.3390/buildings14072119"
    assumptions = (
        "the impact removes the vertical velocity of every mass point, as in KED",
        "the remaining velocities conserve their angular momentum about the new corner or edge",
    )
    domain = "all impacts on one corner or edge"
    known_defects = (
        "depends on the old pivot only for spin about the vertical: with coincident pivots (no impact) it still has "
        "an energy loss",
        "not derived from a force model",
    )

    def angular_velocity(self, impact: SpatialImpact) -> FloatArray:
        return impact.with_momentum(impact.level_momentum)
