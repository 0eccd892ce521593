"""The calibrated model in 3D: the plane model gives a landing of the whole base, in each direction."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid.base import Base
from rocking.errors import InvalidValueError
from rocking.restitution.calibrated import Calibrated
from rocking.restitution.impact import ImpactGeometry
from rocking.restitution.space.impact import SpatialImpact
from rocking.restitution.space.impulse_position import BaseLanding, ImpulsePosition, ImpulsePositionModel

_PLANE = Calibrated()


class CalibratedPosition(ImpulsePosition):
    """Position k with which a landing of the whole base has the coefficient of the plane model."""

    def coefficient(self, landing: BaseLanding) -> float:
        """Return the coefficient of the plane model, which depends on levers and moment of inertia alone."""
        gyration = landing.over_foot / self.moments.mass - self.height**2
        lengths = self.height, landing.old_lever, landing.new_lever, gyration, 0.0
        geometry = ImpactGeometry(*map(np.asarray, lengths))
        return float(_PLANE.of_geometry(geometry))  # Eq. 293


@lru_cache(maxsize=256)
def calibrated_position(moments: SolidMoments, base: Base) -> CalibratedPosition:
    """Return the position of the impulse by the calibrated model, kept for moments and base."""
    return CalibratedPosition(moments, base)


@dataclass(frozen=True)
class SpatialCalibrated(ImpulsePositionModel):
    """The calibrated model: a landing of the whole base has the coefficient of the plane model in its direction.

    The coefficient gives the position k of the impulse between the feet (Eqs. 4, 104). As in `SpatialKed` this k holds
    for steps of any length in the same direction, with angular momentum about the impulse's point (Eq. 103). A loss
    larger than Housner's has k above 1, beyond the new foot.

    This closure is this project's own. No measurement of impacts in 3D is known to it.
    """

    name = "calibrated-3d"
    title = "fitted to the published measurements in the plane, with its impulse position in every direction"
    reference = "this project, from the measurements in Mao et al. 2024, Buildings 14(7) 2119"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "a landing of the whole base loses the energy that the plane model gives in the direction of the step",
        "a shorter step has its impulse at the same fraction of the way",
        "the interface is like the interfaces of the measurements, of different laboratories and materials",
    )
    domain = (
        "every impact on one corner or edge, in any attitude; measured for rectangles with 1.5 <= h/b <= 9.75 in the "
        "plane, an extrapolation elsewhere"
    )
    known_defects = (
        "its numbers are those of 39 tests of small blocks that rocked in the plane; no test in 3D is among them",
        "it is assumed that the fraction of the way is the same for small and large steps, and that the rotation at "
        "the landing has no influence",
        "onto an edge through the old pivot, and onto the whole base, it is Housner's impact",
    )
    highest = np.inf

    def position(self, impact: SpatialImpact) -> ImpulsePosition:
        """Return the position by the plane model."""
        if impact.base is None:
            raise InvalidValueError("calibrated-3d needs the base of the body: give the impact its base")
        return calibrated_position(impact.body, impact.base)
