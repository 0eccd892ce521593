"""Housner (1963): angular momentum about the new foot is conserved. Generalised to any inertia and asymmetric feet."""

from dataclasses import dataclass

from rocking.bodies import Frame
from rocking.conventions import FloatArray, Foot
from rocking.restitution._model import InertiaModel
from rocking.restitution.impact import ImpactGeometry


@dataclass(frozen=True)
class Housner(InertiaModel):
    """The classical model: the impulse acts at the new foot.

    ``r = (I_C + m (h^2 - b_old b_new)) / (I_C + m (h^2 + b_new^2))`` (Eq. 4 of Mao et al. 2024, generalised to
    any inertia and asymmetric feet), ``1 - 3/2 sin(alpha)^2`` for a homogeneous rectangle (Eq. 5).

    Examples
    --------
    >>> from rocking import Block
    >>> round(Housner().coefficient(Block(width=1.0, height=2.0)), 12)
    0.7
    """

    name = "housner"
    short_name = "Housner"
    colour, linestyle = "#0070B2", "--"
    title = "angular momentum about the new foot is conserved"
    reference = "Housner 1963, Bull. Seismol. Soc. Am. 53(2) 403-417, doi:10.1785/BSSA0530020403"
    assumptions = (
        "rigid body and rigid ground, instantaneous impact",
        "the impulse acts at the new foot only: the base is in contact at its corners",
        "no sliding, no bouncing",
    )
    domain = "r > 0 (rectangles with h/b > 1/sqrt(2)); below, impulses act at both corners and the body stops: r = 0"
    known_defects = (
        "measured coefficients of squat blocks (h/b below about 4) are larger",
        "real bases have contact over an area, so that the impulse acts inside the base",
    )
    inertia_only = True

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return r by Eq. 4 of Mao et al. (2024), for any inertia and asymmetric feet [-]."""
        # Eq. 2; Eq. 4, Mao et al. 2024
        return (geometry.base_gyration - geometry.old_lever * geometry.new_lever) / geometry.new_gyration

    def of_frame(self, frame: Frame, foot: Foot) -> float:
        """Return the projection of the frame, with impulses at both ends of each column [-]."""
        return frame.projection(foot)  # Eq. 371
