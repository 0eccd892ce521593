"""Contact bed: what emerges from an impact that takes time, on springs and dashpots under the base, in units of it."""

import math
from dataclasses import dataclass, fields
from enum import Enum
from typing import cast

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import BoolArray, FloatArray, Foot
from rocking.errors import InvalidValueError
from rocking.restitution._model import InertiaModel, Restitution
from rocking.restitution.bed_table import DAMPING, HARDNESS, POINTS, bed_table, stated_error
from rocking.restitution.impact import ImpactGeometry

_NEARLY = 1.02  # friction this much above the need: the base sticks through the whole impact


class CoefficientSource(Enum):
    """Where a coefficient of the contact bed comes from; the value is the sentence a user reads."""

    TABLE = "read from the table of resolved impacts, within its stated error"
    RESOLVED = "resolved in time for this body on this bed, which is outside the table"


@dataclass(frozen=True, slots=True)
class BedRestitution(Restitution):
    """A coefficient of restitution that says whether it was read or resolved."""

    source: CoefficientSource = CoefficientSource.TABLE  # Table, or an impact resolved in time
    stated_error: float = 0.0  # error stated for it: of the table, or of the impact's steps [-]


@dataclass(frozen=True)
class ContactBedModel(InertiaModel):
    """The impulse acts where a bed of Kelvin-Voigt points puts it: kappa of the half base from the base's middle.

    ``r = (rho - s a) / (rho + s (2 - a))`` with rho = (I_C + m h^2) / (m w^2), w half the distance of the feet,
    a the old lever and s the impulse ahead of the plumb line over w; kappa is read from a table of impacts resolved
    in time. Two points are Housner's impact, many damped points an impulse near the middle of the half base. A bed
    outside the table, and a base that would slide, are resolved in time instead, a millisecond each: `evaluate` says
    which it was.

    Parameters
    ----------
    points : int
        Contact points from foot to foot; 2, 3, 5, 11 and 41 are tabulated [-].
    damping : float
        Damping ratio zeta = c / (2 sqrt(k m)) of the whole bed; 0.05 to 5 is tabulated [-].
    hardness : float
        Landing speed of the new foot times sqrt(k / m) over gravity; 30 to 1000 is tabulated [-]: a harder bed and a
        faster impact are the same thing.
    friction : float
        Coefficient of friction; infinite by default. A base sticks from m h w / (I_C + m h^2) on, w the lever of the
        new foot, whatever the number of points; below, the impact is resolved [-].
    allowed_error : float
        The table is read for bodies for which its stated error is no larger; from damping 1 on that is 0.001 to 0.002,
        the most for the most squat bodies [-].

    Raises
    ------
    InvalidValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> from rocking import Block
    >>> block = Block(width=1.0, height=2.0)
    >>> [round(ContactBedModel(points=n).coefficient(block), 2) for n in (2, 5, 41)]
    [0.7, 0.81, 0.85]
    >>> ContactBedModel(points=5).evaluate(block).source.name
    'TABLE'
    """

    points: int = 41
    damping: float = 1.0
    hardness: float = 100.0
    friction: float = math.inf
    allowed_error: float = 0.01

    name = "contact-bed"
    short_name = "contact bed"
    colour, linestyle = "#9181AC", (0, (4, 2))
    title = "what emerges from an impact resolved in time on springs and dashpots along the base"
    reference = (
        "derived in this project (the contact bed of rocking.restitution.bed); beds of two springs and of Winkler "
        "springs go back to Psycharis & Jennings 1983"
    )
    assumptions = (
        "flat base that touches from foot to foot, equal points with half a share at the ends",
        "points push with k d + c d' and never pull; the ground below them is rigid",
        "rocking of small amplitude; r is measured by the next peak, so that hops count as lost",
    )
    domain = (
        "table: (I_C + m h^2) / (m w^2) from 1.6 (a rectangle with h/b = 0.97) to 199, the plumb line within a "
        "third of the half base of its middle; r within 0.002 of the resolved impact there for damping >= 1, see "
        "bed_table.STATED_ERRORS below; beyond, the impulse keeps the place it has at the edge of the table; beds "
        "outside the table are resolved in time; where r <= 0 the body stops"
    )
    known_defects = (
        "with damping below 0.3 the body hops: r holds for a landing from rest on one foot, and scatters from impact "
        "to impact in a history",
        "r depends on the speed through the hardness, which is one number here: see bed_speed_law for histories",
        "at large rotations (0.6 of the slenderness angle) the resolved r is lower by about 0.001",
    )
    inertia_only = True

    def __post_init__(self) -> None:
        number = checks.within("points", self.points, 2, 1000)
        if number != int(number):
            raise InvalidValueError(parameter="points", allowed="a whole number", value=self.points)
        object.__setattr__(self, "points", int(number))
        checks.within("damping", self.damping, 1e-3, 100.0)
        checks.within("hardness", self.hardness, 5.0, 1e4, hint="a softer bed has no impact, a harder one is the limit")
        if cast("object", self.friction) != math.inf:
            checks.within("friction", self.friction, 0.05, 100.0)
        checks.within("allowed_error", self.allowed_error, 0.0, 1.0)

    @property
    def label(self) -> str:
        """Name with the parameters that are not the usual ones: ``contact-bed:points=5``."""
        usual = {field.name: field.default for field in fields(self)}
        values = ",".join(f"{name}={value:.4g}" for name, value in self.parameters.items() if value != usual[name])
        return f"{self.name}:{values}" if values else self.name

    @property
    def tabulated(self) -> bool:
        """Whether the bed is inside the table; a body on it may be squatter than is read there, or slide."""
        inside = self.points in POINTS and DAMPING[0] <= self.damping <= DAMPING[1]
        return inside and HARDNESS[0] <= self.hardness <= HARDNESS[1]

    def evaluate(self, body: Body, onto: Foot = "right") -> BedRestitution:
        """Return the coefficient of a body with its flags and where it comes from."""
        found = super().evaluate(body, onto)
        geometry = ImpactGeometry.of_body(body, onto)
        read = bool(self._read(geometry))
        source, error = (
            (CoefficientSource.TABLE, float(self._error(geometry))) if read else (CoefficientSource.RESOLVED, 1e-6)
        )
        return BedRestitution(found.model, found.raw, found.coefficient, found.flags, source, error)

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Angular momentum about the place of the impulse, and no more energy after than before."""
        read = self._read(geometry)
        r = (
            tabulated(geometry, self.points, self.damping, self.hardness)
            if bool(read.any())
            else np.empty_like(geometry.base_gyration)
        )
        if not bool(read.all()):
            r = np.array(r)
            r[~read] = self._resolved(geometry, ~read)
        return np.asarray(np.minimum(r, np.sqrt(geometry.old_gyration / geometry.new_gyration)))  # Eq. 29

    def _read(self, geometry: ImpactGeometry) -> BoolArray:
        """Whether the table serves: the bed is in it, it is good enough there, and the base does not slide."""
        longest = np.maximum(geometry.old_lever, geometry.new_lever)
        need = geometry.height * longest / geometry.base_gyration
        sticks = self.friction >= _NEARLY * need
        return np.asarray(sticks & (self._error(geometry) <= self.allowed_error) if self.tabulated else sticks & False)

    def _error(self, geometry: ImpactGeometry) -> FloatArray:
        return stated_error(self.points, self.damping, _flatness(geometry))

    def _resolved(self, geometry: ImpactGeometry, where: BoolArray) -> FloatArray:
        from rocking.restitution.bed.scaled import ScaledImpact, resolved_coefficients

        half = 0.5 * (geometry.old_lever + geometry.new_lever)
        flatness = _flatness(geometry)
        share = geometry.height**2 / geometry.base_gyration
        bodies = np.stack([flatness, geometry.old_lever / half - 1.0, share], axis=-1)[where]
        bed = (self.points, float(self.damping), float(self.hardness), float(self.friction))
        return resolved_coefficients(
            [ScaledImpact(flat, offset, *bed, height_share=height) for flat, offset, height in bodies.tolist()]
        )


def tabulated(
    geometry: ImpactGeometry, points: int, damping: FloatArray | float, hardness: FloatArray | float
) -> FloatArray:
    """Return the coefficients that the table gives, for arrays of beds, broadcast; no impact adds energy."""
    half = 0.5 * (geometry.old_lever + geometry.new_lever)
    gyration = geometry.base_gyration / half**2
    old, new = geometry.old_lever / half, geometry.new_lever / half
    table = bed_table()
    bed = table.bed(points, damping, hardness)
    arm = table.position(bed, 1.0 / (1.0 + gyration), old - 1.0) - (old - 1.0)
    after = gyration + arm * new
    # the impulse of a plumb line far outside the table could lie behind it
    most = np.sqrt(geometry.old_gyration / geometry.new_gyration)
    # Eq. 19
    r = np.where(after > 0.0, (gyration - arm * old) / np.where(after > 0.0, after, 1.0), most)
    return np.minimum(r, most)  # Eq. 29


def _flatness(geometry: ImpactGeometry) -> FloatArray:
    half = 0.5 * (geometry.old_lever + geometry.new_lever)
    return np.asarray(1.0 / (1.0 + geometry.base_gyration / half**2))
