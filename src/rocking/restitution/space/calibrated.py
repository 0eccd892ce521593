"""The calibrated model in 3D.

For every direction, the plane model gives the coefficient of a landing of the full base.
"""

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
    """Position k at which a landing of the full base has the coefficient of the plane model."""

    def coefficient(self, landing: BaseLanding) -> float:
        """Return the coefficient of the plane model, which depends only on levers and moment of inertia [-]."""
        gyration = landing.over_foot / self.moments.mass - self.height**2
        lengths = self.height, landing.old_lever, landing.new_lever, gyration, 0.0
        geometry = ImpactGeometry(*map(np.asarray, lengths))
        return float(_PLANE.of_geometry(geometry))  # Eq. 293


@lru_cache(maxsize=256)
def calibrated_position(moments: SolidMoments, base: Base) -> CalibratedPosition:
    """Return the impulse position by the calibrated model. Results are cached by moments and base."""
    return CalibratedPosition(moments, base)


@dataclass(frozen=True)
class SpatialCalibrated(ImpulsePositionModel):
    """The calibrated model: a landing of the full base has the coefficient of the plane model in its direction.

    The coefficient gives the impulse position k between the feet (Eqs. 4, 104). As in `SpatialKed`, this k applies to
    steps of any length in the same direction, with angular momentum conserved about the point of the impulse (Eq. 103).
    An energy loss larger than Housner's gives k above 1, beyond the new foot.

    This closure is an assumption of this project. It is not validated by measurements of 3D impacts.
    """

    name = "calibrated-3d"
    title = "fitted to the published measurements in the plane, with the impulse position in all directions"
    reference = "this project, from the measurements in Mao et al. 2024, Buildings 14(7) 2119"
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "a landing of the full base has the energy loss of the plane model in the direction of the step",
        "a shorter step has its impulse at the same fraction of the step",
        "the interface is similar to those of the measurements, from different laboratories and materials",
    )
    domain = (
        "all impacts on one corner or edge, in any attitude; measured for rectangles with 1.5 <= h/b <= 9.75 in the "
        "plane, an extrapolation elsewhere"
    )
    known_defects = (
        "an empirical fit to 39 plane tests of small blocks, without tests in 3D",
        "the assumptions that the fraction is equal for small and large steps, and that the rotation at the landing "
        "has no influence, are not verified",
        "equal to Housner's model onto an edge through the old pivot, and onto the full base",
    )
    highest = np.inf

    def position(self, impact: SpatialImpact) -> ImpulsePosition:
        """Return the position by the plane model."""
        if impact.base is None:
            raise InvalidValueError("calibrated-3d needs the base of the body; give base= of the impact")
        return calibrated_position(impact.body, impact.base)
