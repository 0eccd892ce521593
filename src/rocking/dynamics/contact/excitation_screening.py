"""Which stretches of a motion might move a body at rest."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.contact.base import PlaneBase


def stirring(base: PlaneBase, push: FloatArray, lift: FloatArray, friction: float) -> np.ndarray:
    """Return the stretches in which a body at rest might be lifted or moved.

    push, lift: coefficients of a_x and g + a_z [m/s2]; friction: Coulomb's coefficient [-]. Returns numbers of the
    stretches; in all others every margin stays above zero.
    """
    turn = push * base.height
    # Eq. 69
    held = [lift * base.right + turn, lift * base.left - turn, friction * lift - push, friction * lift + push]
    low = [m[:, 0] + np.minimum(m[:, 1:], 0.0).sum(axis=1) for m in held]
    return np.flatnonzero(np.min(low, axis=0) <= 0.0)
