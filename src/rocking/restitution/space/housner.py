"""Housner's impact in 3D: plastic and sticking, with angular momentum conserved about the new support."""

from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.restitution.space.impact import SpatialImpact
from rocking.restitution.space.model import SpatialModel


@dataclass(frozen=True)
class SpatialHousner(SpatialModel):
    """Angular momentum about the new corner, or its component along the new edge, is conserved.

    ``I_B omega_+ = I_C omega_- + m rho_B x (omega_- x rho_A)`` about a corner B, and
    ``omega_+ = e . L_O'/(e . I_O' e)`` about an edge: the orthogonal projection of the motion, in the kinetic
    metric, onto the admissible motions of the new support.
    """

    name = "housner-3d"
    title = "angular momentum about the new corner or edge is conserved"
    reference = "Housner 1963, BSSA 53(2) 403-417, extended to space by projection in this project"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding",
        "the impulse acts at the new corner or on the new edge only",
    )
    domain = "all impacts on one corner or edge; the body stops where it would penetrate the ground at an edge"
    known_defects = (
        "squat bodies would penetrate the ground near the new corner",
        "larger energy loss than most measurements for bodies of slenderness below about 4",
    )

    def angular_velocity(self, impact: SpatialImpact) -> FloatArray:
        return impact.with_momentum(impact.angular_momentum)
