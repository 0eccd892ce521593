"""Contact bed: restitution from an impact resolved in time on springs and dashpots under the base."""

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

_NEARLY = 1.02  # for larger ratios of friction to demand, the base sticks during the impact


class CoefficientSource(Enum):
    """Source of a coefficient of the contact bed. The value is a sentence for reports."""

    TABLE = "interpolated in the table of resolved impacts, within its stated error"
    RESOLVED = "resolved in time for this body on this bed, outside the range of the table"


@dataclass(frozen=True, slots=True)
class BedRestitution(Restitution):
    """Coefficient of restitution with its source: the table, or an impact resolved in time."""

    source: CoefficientSource = CoefficientSource.TABLE  # the table, or an impact resolved in time
    stated_error: float = 0.0  # error of the table, or of the integration of the impact [-]


@dataclass(frozen=True)
class ContactBedModel(InertiaModel):
    """Impulse position from a bed of Kelvin-Voigt points: kappa times half the base from the middle of the base.

    The model is ``r = (rho - s a) / (rho + s (2 - a))`` with rho = (I_C + m h^2) / (m w^2), w half the distance of the
    feet, a the old lever over w, and s the distance of the impulse ahead of the plumb line over w. A table of impacts
    resolved in time gives kappa by interpolation. Two points give Housner's impact, kappa = 1. For many points with
    large damping, kappa is about 0.5. Impacts outside the table or with sliding are resolved in time, which takes
    about one millisecond per impact. `evaluate` returns the source.

    Parameters
    ----------
    points : int
        Number of contact points from foot to foot [-]. The table has 2, 3, 5, 11 and 41 points.
    damping : float
        Damping ratio zeta = c / (2 sqrt(k m)) of the bed [-]. The table has values from 0.05 to 5.
    hardness : float
        Landing speed of the new foot times sqrt(k / m) / gravity [-]. The table has values from 30 to 1000. A harder
        bed and a faster impact are equivalent.
    friction : float
        Coefficient of friction [-]; infinite by default. For all numbers of points, a base sticks for values above m h
        w / (I_C + m h^2) with the lever w of the new foot. For smaller values, the impact is resolved in time.
    allowed_error : float
        Largest stated error for the use of the table [-]. For damping >= 1, the error is 0.001 to 0.002, and is largest
        for squat bodies.

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
    title = "impact resolved in time on springs and dashpots along the base"
    reference = (
        "derived in this project (the contact bed of rocking.restitution.bed); beds of two springs and of Winkler "
        "springs: Psycharis & Jennings 1983"
    )
    assumptions = (
        "flat base in contact from foot to foot, equal points with half weight at the ends",
        "points with force k d + c d' without tension, on rigid ground",
        "rocking of small amplitude; r is determined from the next peak, so that the energy of hops counts as loss",
    )
    domain = (
        "table: (I_C + m h^2) / (m w^2) from 1.6 (a rectangle with h/b = 0.97) to 199, the plumb line within a "
        "third of the half base from its middle; r within 0.002 of the resolved impact for damping >= 1, see "
        "bed_table.STATED_ERRORS below; outside, the impulse position is that at the edge of the table; beds "
        "outside the table are resolved in time; for r <= 0 the body stops"
    )
    known_defects = (
        "with damping below 0.3 the body hops: r applies to a landing from rest on one foot, and scatters from impact "
        "to impact in a history",
        "r depends on the speed through the hardness, which is constant here: see bed_speed_law for histories",
        "at large rotations (0.6 of the slenderness angle) the resolved r is lower by about 0.001",
    )
    inertia_only = True

    def __post_init__(self) -> None:
        number = checks.within("points", self.points, 2, 1000)
        if number != int(number):
            raise InvalidValueError(parameter="points", allowed="a whole number", value=self.points)
        object.__setattr__(self, "points", int(number))
        checks.within("damping", self.damping, 1e-3, 100.0)
        checks.within("hardness", self.hardness, 5.0, 1e4, hint="a softer bed has no impact; for a harder bed use 1e4")
        if cast("object", self.friction) != math.inf:
            checks.within("friction", self.friction, 0.05, 100.0)
        checks.within("allowed_error", self.allowed_error, 0.0, 1.0)

    @property
    def label(self) -> str:
        """Name with the parameters that differ from their defaults, such as ``contact-bed:points=5``."""
        defaults = {field.name: field.default for field in fields(self)}
        values = ",".join(f"{name}={value:.4g}" for name, value in self.parameters.items() if value != defaults[name])
        return f"{self.name}:{values}" if values else self.name

    @property
    def tabulated(self) -> bool:
        """True if the bed is inside the table. A squat or sliding body on this bed may still be outside."""
        inside = self.points in POINTS and DAMPING[0] <= self.damping <= DAMPING[1]
        return inside and HARDNESS[0] <= self.hardness <= HARDNESS[1]

    def evaluate(self, body: Body, foot: Foot = "right") -> BedRestitution:
        """Return the coefficient of a body with flags and source."""
        result = super().evaluate(body, foot)
        geometry = ImpactGeometry.of_body(body, foot)
        read = bool(self._uses_table(geometry))
        source, error = (
            (CoefficientSource.TABLE, float(self._error(geometry))) if read else (CoefficientSource.RESOLVED, 1e-6)
        )
        return BedRestitution(result.model, result.raw, result.coefficient, result.flags, source, error)

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return r from angular momentum about the impulse position, within the energy bound [-]."""
        read = self._uses_table(geometry)
        r = (
            tabulated(geometry, self.points, self.damping, self.hardness)
            if bool(read.any())
            else np.empty_like(geometry.base_gyration)
        )
        if not bool(read.all()):
            r = np.array(r)
            r[~read] = self._resolved(geometry, ~read)
        return np.asarray(np.minimum(r, np.sqrt(geometry.old_gyration / geometry.new_gyration)))  # Eq. 29

    def _uses_table(self, geometry: ImpactGeometry) -> BoolArray:
        """Return True if the table applies: the bed is inside, the stated error is small, and the base sticks."""
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
        height_share = geometry.height**2 / geometry.base_gyration
        bodies = np.stack([flatness, geometry.old_lever / half - 1.0, height_share], axis=-1)[where]
        bed = (self.points, float(self.damping), float(self.hardness), float(self.friction))
        return resolved_coefficients(
            [ScaledImpact(flat, offset, *bed, height_share=height) for flat, offset, height in bodies.tolist()]
        )


def tabulated(
    geometry: ImpactGeometry, points: int, damping: FloatArray | float, hardness: FloatArray | float
) -> FloatArray:
    """Return the coefficients from the table for broadcast arrays of beds, within the energy bound [-]."""
    half = 0.5 * (geometry.old_lever + geometry.new_lever)
    gyration = geometry.base_gyration / half**2
    old, new = geometry.old_lever / half, geometry.new_lever / half
    table = bed_table()
    bed = table.bed(points, damping, hardness)
    arm = table.position(bed, 1.0 / (1.0 + gyration), old - 1.0) - (old - 1.0)
    denominator = gyration + arm * new
    # for a plumb line far outside the table, the impulse could be behind the plumb line
    bound = np.sqrt(geometry.old_gyration / geometry.new_gyration)
    # Eq. 19
    r = np.where(denominator > 0.0, (gyration - arm * old) / np.where(denominator > 0.0, denominator, 1.0), bound)
    return np.minimum(r, bound)  # Eq. 29


def _flatness(geometry: ImpactGeometry) -> FloatArray:
    half = 0.5 * (geometry.old_lever + geometry.new_lever)
    return np.asarray(1.0 / (1.0 + geometry.base_gyration / half**2))
