"""How deep a tilted base settles in the bed under a static load."""

import math

import numpy as np

from rocking.portable import dot
from rocking.restitution.bed.law import LawNumbers, depth_under, stored
from rocking.restitution.bed.rigid import RigidRocking


def settlement(rigid: RigidRocking, law: LawNumbers, rotation: float, load: float) -> tuple[float, float]:
    """Return the static depth of the pivot and the elastic energy, all points that touch counted.

    rotation: theta of the base [rad]; load: vertical force [N]. Returns below rigid rocking [m], and what the points
    store [J].
    """
    bed, pivot = rigid.bed, rigid.pivot(rotation)
    tilt = rotation if bed.kinematics == "small" else math.sin(rotation)
    turned = 1.0 if bed.kinematics == "small" else math.cos(rotation)
    above = rigid.lift(rotation) - (bed.positions * tilt - bed.heights * turned)
    deepest = depth_under(law, load / float(bed.shares[pivot]))
    depth = deepest
    shallow = np.delete(above, pivot).min() >= deepest
    # the load carried grows with the depth and curves upwards: Newton's method comes down from one foot alone
    for _ in range(0 if shallow else 60):
        pressed = np.maximum(depth - above, 0.0)
        slope = law.exponent * law.stiffness * pressed ** (law.exponent - 1.0)
        excess = dot(bed.shares, law.stiffness * pressed**law.exponent) - load  # Eq. 129
        down = excess / dot(bed.shares, np.where(pressed > 0.0, slope, 0.0))
        depth -= down
        if down <= 1e-15 * depth:
            break
    depths = np.maximum(depth - above, 0.0)
    return depth, dot(bed.shares, stored(law, depths, depths))
