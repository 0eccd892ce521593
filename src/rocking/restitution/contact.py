"""Where the base touches, as the contact models see it: from the plumb line, towards the new foot."""

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot
from rocking.restitution.impact import ImpactGeometry


def contact_of(body: Body, onto: Foot) -> FloatArray:
    """Return the flat stretches of the base, measured from the plumb line of the centre of mass.

    Returns ends of the stretches, in growing order; none for a body that stands on points [m].
    """
    patches = np.array(body.local_contact, dtype=np.float64).reshape(-1, 2) - body.local_moments.x
    return patches if onto == "right" else np.ascontiguousarray(-patches[::-1, ::-1])


def is_whole_base(patches: FloatArray, geometry: ImpactGeometry) -> bool:
    """Return whether the base touches from foot to foot without a gap.

    patches: from `contact_of` [m]. Returns true for one stretch that ends at both feet.
    """
    if len(patches) != 1:
        return False
    ends = np.array([-float(geometry.old_lever), float(geometry.new_lever)])
    return bool(np.abs(patches[0] - ends).max() <= 1e-9 * (ends[1] - ends[0]))
