"""Impacts that the restitution model `contact-bed` asks for where its table ends."""

from rocking.conventions import FloatArray
from rocking.dynamics.bed.scaled import ScaledImpact, resolved_coefficients


def model_coefficients(bodies: FloatArray, bed: tuple[int, float, float, float]) -> FloatArray:
    """Return coefficients of restitution of bodies on one bed, resolved in time.

    bodies: flatness, offset and height share, as in `ScaledImpact` [-]; bed: points, damping, hardness and friction
    [-]. Returns theta_dot_after / theta_dot_before [-].

    >>> import numpy as np
    >>> model_coefficients(np.array([[0.15, 0.0, 0.7]]), (2, 7.0, 300.0, 0.8)).round(2).tolist()
    [0.7]
    """
    return resolved_coefficients(
        [ScaledImpact(flatness, offset, *bed, height_share=share) for flatness, offset, share in bodies.tolist()]
    )
