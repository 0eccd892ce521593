"""Energy loss of the units of a 3D body in an impact, after the division into units in the paper."""

from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.solid import Part
from rocking.bodies.solid.units import Units, divided
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.restitution.space.impact import SpatialImpact
from rocking.restitution.space.ked import stage_velocities
from rocking.restitution.space.model import SpatialRestitution


@dataclass(frozen=True, eq=False)
class UnitEnergies:
    """Kinetic energy of every unit through the stages of KED.

    Parameters
    ----------
    units : Units
        The units.
    before, level, left : ndarray, shape (n,)
        Energy before the impact, after stage 1 and after stage 2 [J].
    ground : float
        Height of the ground [m].
    """

    units: Units
    before: FloatArray
    level: FloatArray
    left: FloatArray
    ground: float

    @property
    def lost(self) -> FloatArray:
        """Energy losses of the units in stages 1 and 2 [J]."""
        return np.asarray(self.before - self.left)

    @property
    def density(self) -> FloatArray:
        """Energy losses of the units / their masses [J/kg]."""
        return np.asarray(self.lost / self.units.mass)

    def layers(self, count: int, height: float | None = None) -> tuple[FloatArray, FloatArray]:
        """Return the energy loss by layer.

        Parameters
        ----------
        count : int
            Number of layers of equal height.
        height : float, optional
            Top of the highest layer above the ground [m]. By default, the top of the highest unit.

        Returns
        -------
        heights : ndarray, shape (count + 1,)
            Ends of the layers above the ground [m].
        lost : ndarray, shape (count,)
            Energy losses of the layers [J].

        Raises
        ------
        InvalidValueError
            If `count` is below 1.
        """
        heights = self.units.centre[:, 2] - self.ground
        top = float(heights.max()) * (1.0 + 1e-12) if height is None else checks.positive("height", height, "m")
        if count < 1:
            raise InvalidValueError("count must be at least 1, got {count}", count=f"{count!r}")
        lost, ends = np.histogram(heights, bins=count, range=(0.0, top), weights=self.lost)
        return ends, lost


def unit_energies(result: SpatialRestitution | SpatialImpact, units: Units | int = 12) -> UnitEnergies:
    """Return the energy loss of every unit of a body in an impact by the stages of KED.

    Parameters
    ----------
    result : SpatialRestitution or SpatialImpact
        The impact of an upright body, with its matter.
    units : Units or int
        The units, or the number of divisions for `divided`.

    Returns
    -------
    UnitEnergies
        Energies of the units. Their sums converge to the exact integrals with the declared order of the units.

    Raises
    ------
    InvalidValueError
        If the body is tilted or has no matter.

    Examples
    --------
    >>> from rocking.bodies.solid import Solid, box
    >>> from rocking.restitution.space import impact_in_space
    >>> prism = Solid(box(1.0, 1.0, 2.0))
    >>> edges = prism.base.edges
    >>> result = impact_in_space(prism, -edges[0].direction, pivot=edges[0], onto=prism.base.opposite(0), model="ked")
    >>> energies = unit_energies(result, 24)
    >>> round(float(energies.left.sum() / energies.before.sum()), 3), round(result.energy_ratio, 3)
    (0.689, 0.689)
    """
    impact = result.impact if isinstance(result, SpatialRestitution) else result
    (solid, origin), _ = impact.standing_solid, impact.placed_solid
    unit_set = divided(solid, units) if isinstance(units, int) else units
    fields = stage_velocities(impact, unit_set.centre - solid.origin + origin)
    before, level, left = (0.5 * unit_set.mass * np.square(field).sum(axis=1) for field in fields)
    return UnitEnergies(unit_set, before, level, left, solid.ground)


def lost_density(impact: SpatialImpact, part: Part, points: FloatArray) -> FloatArray:
    """Return the energy loss per volume of stages 1 and 2 at points of a part [m], in J/m3."""
    # the body is upright, and the points are in coordinates of the user
    (solid, origin), _ = impact.standing_solid, impact.placed_solid
    before, _, left = stage_velocities(impact, checks.real_array("points", points, "m") - solid.origin + origin)
    return np.asarray(0.5 * part.density * (np.square(before).sum(axis=1) - np.square(left).sum(axis=1)))
