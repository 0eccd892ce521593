"""Horizontal momentum: vertical velocities vanish, the angular momentum of the rest is kept (cos^2 alpha)."""

from dataclasses import dataclass

from rocking.conventions import FloatArray
from rocking.restitution._model import InertiaModel
from rocking.restitution.impact import ImpactGeometry


@dataclass(frozen=True)
class HorizontalMomentum(InertiaModel):
    """KED's first stage followed by conservation of angular momentum instead of energy.

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
    title = "vertical velocities vanish, angular momentum of the horizontal ones is kept (cos^2 alpha)"
    reference = "derived in this project from stage 1 of Mao et al. 2024, doi:10.3390/buildings14072119"
    assumptions = (
        "the impact removes the vertical velocity of every mass point, as in KED",
        "what is left keeps its angular momentum about the new foot",
    )
    domain = "every body: r > 0"
    known_defects = (
        "ignores where the old foot is: with coincident feet (no impact at all) it still loses energy",
        "depends on the second moment of height, not on the polar inertia alone",
        "no force model stands behind it",
    )

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Ratio of the second moment of height to the polar moment about the new foot."""
        return (geometry.spread_y + geometry.height**2) / geometry.new_gyration  # Eq. 10
