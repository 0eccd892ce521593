"""Horizontal momentum: vertical velocities vanish, and angular momentum of horizontal velocities is conserved."""

from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.restitution._model import InertiaModel
from rocking.restitution.impact import ImpactGeometry


@dataclass(frozen=True)
class HorizontalMomentum(InertiaModel):
    """First stage of KED, followed by conservation of angular momentum instead of energy.

    ``r = Int y^2 dm / I_O'``, which is ``cos(alpha)^2 = lambda^2 / (1 + lambda^2)`` for a homogeneous rectangle.

    Examples
    --------
    >>> from rocking import Block
    >>> round(HorizontalMomentum().coefficient(Block(width=1.0, height=2.0)), 12)
    0.8
    """

    name = "horizontal-momentum"
    can_stop = sees_old_foot = False
    short_name = "horizontal momentum (cos\N{SUPERSCRIPT TWO}\N{GREEK SMALL LETTER ALPHA})"
    colour, linestyle = "#009960", "-."
    legend = r"cos$^2\,\alpha$"
    title = "vertical velocities vanish, angular momentum of the horizontal velocities is conserved (cos^2 alpha)"
    reference = "derived in this project from stage 1 of Mao et al. 2024, doi:10.3390/buildings14072119"
    assumptions = (
        "the impact removes the vertical velocity of every mass point, as in KED",
        "the remaining velocities conserve their angular momentum about the new foot",
    )
    domain = "every body: r > 0"
    known_defects = (
        "independent of the old foot: coincident feet (no impact) still have an energy loss",
        "depends on the second moment of height, not on the polar inertia alone",
        "not derived from a force model",
    )

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return the ratio of the second moment of height to the polar moment about the new foot [-]."""
        return (geometry.spread_y + geometry.height**2) / geometry.new_gyration  # Eq. 10
