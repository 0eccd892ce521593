"""Contact bed: what emerges from an impact that takes time, on springs and dashpots along the base."""

from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.restitution.bed_table import DAMPING, HARDNESS, POINTS, bed_table
from rocking.restitution.impact import ImpactGeometry
from rocking.restitution.model import InertiaModel


@dataclass(frozen=True)
class ContactBedModel(InertiaModel):
    """The impulse acts where a bed of Kelvin-Voigt points puts it: kappa of the half base from the base's middle.

    ``r = (rho - s a) / (rho + s (2 - a))`` with rho = (I_C + m h^2) / (m w^2), w half the distance of the feet,
    a the old lever and s the impulse ahead of the plumb line over w; kappa is read from a table of impacts resolved
    in time. Two points are Housner's impact, many damped points an impulse near the middle of the half base.

    Parameters
    ----------
    points : int
        Contact points from foot to foot: 2, 3, 5, 11 or 41 [-].
    damping : float
        Damping ratio zeta = c / (2 sqrt(k m)) of the whole bed, 1 to 5 [-].
    hardness : float
        Landing speed of the new foot times sqrt(k / m) over gravity, 30 to 1000 [-]: a harder bed and a faster
        impact are the same thing.

    Raises
    ------
    InvalidValueError
        If a parameter is outside the table.

    Examples
    --------
    >>> from rocking import Block
    >>> block = Block(width=1.0, height=2.0)
    >>> [round(ContactBedModel(points=n).coefficient(block), 2) for n in (2, 5, 41)]
    [0.7, 0.81, 0.85]
    """

    points: int = 41
    damping: float = 1.0
    hardness: float = 100.0

    name = "contact-bed"
    title = "what emerges from an impact resolved in time on springs and dashpots along the base"
    reference = (
        "derived in this project (the contact bed of rocking.dynamics.bed); beds of two springs and of Winkler "
        "springs go back to Psycharis & Jennings 1983"
    )
    assumptions = (
        "flat base that touches from foot to foot, equal points with half a share at the ends, no sliding",
        "points push with k d + c d' and never pull; the ground below them is rigid",
        "rocking of small amplitude; r is measured by the next peak, so that hops count as lost",
    )
    domain = (
        "table: (I_C + m h^2) / (m w^2) from 1.6 (a rectangle with h/b = 0.97) to 199, the plumb line within a "
        "third of the half base of its middle; r within 0.001 of the resolved impact there; beyond, the impulse keeps "
        "the place it has at the edge of the table; where r <= 0 the body stops"
    )
    known_defects = (
        "damping below 1 is not tabulated: the body hops and r scatters from impact to impact",
        "r depends on the speed through the hardness, which is one number here: see bed_speed_law for histories",
        "at large rotations (0.6 of the slenderness angle) the resolved r is lower by about 0.001",
    )
    inertia_only = True

    def __post_init__(self) -> None:
        """Refuse a bed that was not tabulated."""
        if checks.number("points", self.points) not in POINTS:
            raise InvalidValueError(
                f"points must be one of {', '.join(map(str, POINTS))}, got {self.points}; other beds: bed_impact"
            )
        object.__setattr__(self, "points", int(self.points))
        checks.within("damping", self.damping, *DAMPING, hint="lighter damping hops and scatters: use bed_impact")
        checks.within("hardness", self.hardness, *HARDNESS, hint="other beds: use bed_impact")

    @property
    def label(self) -> str:
        """Name with the parameters that are not the usual ones: ``contact-bed:points=5``."""
        usual = {"points": 41, "damping": 1.0, "hardness": 100.0}
        values = ",".join(f"{name}={value:.4g}" for name, value in self.parameters.items() if value != usual[name])
        return f"{self.name}:{values}" if values else self.name

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Angular momentum about the place of the impulse, and no more energy after than before.

        Parameters
        ----------
        geometry : ImpactGeometry
            Levers and inertia.

        Returns
        -------
        ndarray
            Coefficients, negative where the body stops [-].
        """
        half = 0.5 * (geometry.old_lever + geometry.new_lever)
        gyration = geometry.base_gyration / half**2
        old, new = geometry.old_lever / half, geometry.new_lever / half
        table = bed_table()
        plane = table.plane(self.points, float(self.damping), float(self.hardness))
        arm = table.position(plane, 1.0 / (1.0 + gyration), old - 1.0) - (old - 1.0)
        most = np.sqrt(geometry.old_gyration / geometry.new_gyration)
        after = gyration + arm * new
        # the impulse of a plumb line far outside the table could lie behind it
        r = (gyration - arm * old) / np.where(after > 0.0, after, 1.0)
        return np.asarray(np.where(after > 0.0, np.minimum(r, most), most))
