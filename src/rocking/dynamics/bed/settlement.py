"""How deep a tilted base settles in the bed under a static load."""

import math

import numpy as np

from rocking.dynamics.bed.law import LawNumbers, depth_under, force, stored
from rocking.dynamics.bed.rigid import RigidRocking


def settlement(rigid: RigidRocking, law: LawNumbers, rotation: float, load: float) -> tuple[float, float]:
    """Return the static depth of the pivot and the elastic energy, all points that touch counted.

    Parameters
    ----------
    rigid : RigidRocking
        Body and bed.
    law : LawNumbers
        Contact law.
    rotation : float
        theta of the base [rad].
    load : float
        Vertical force [N].

    Returns
    -------
    depth, energy : float
        Below rigid rocking [m], and what the points store [J].
    """
    bed, pivot = rigid.bed, rigid.pivot(rotation)
    tilt = rotation if bed.kinematics == "small" else math.sin(rotation)
    turned = 1.0 if bed.kinematics == "small" else math.cos(rotation)
    above = rigid.lift(rotation) - (bed.positions * tilt - bed.heights * turned)
    deepest = depth_under(law, load / float(bed.shares[pivot]))
    still, low, high = np.zeros_like(above), 0.0, deepest
    shallow = np.delete(above, pivot).min() >= deepest
    for _ in range(0 if shallow else 80):
        middle = 0.5 * (low + high)
        depths = middle - above
        carried = float(bed.shares @ force(law, depths, still, np.maximum(depths, 0.0)))
        low, high = (middle, high) if carried < load else (low, middle)
    depths = np.maximum(high - above, 0.0)
    return high, float(bed.shares @ stored(law, depths, depths))
