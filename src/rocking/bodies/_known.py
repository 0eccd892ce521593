"""Centre of mass and moment of inertia that somebody measured or computed, checked against the outline."""

from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.moments import PlaneMoments
from rocking.conventions import FloatArray
from rocking.errors import GeometryError

_SLACK = 1e-6
"""A centre or a moment may lie this far, relative to the body's size, beyond what its outline allows: rounding."""


def known_moments(
    homogeneous: PlaneMoments, vertices: FloatArray, centre: FloatArray | None, moment_of_inertia: float | None
) -> PlaneMoments:
    """Return moments with what is known in place of those of the homogeneous body.

    vertices, centre: in the local frame [m]; moment_of_inertia: polar, about the centre [kg m2]. What is not given
    keeps the centre or the radius of gyration of the homogeneous body, and always its share of xx and yy.
    """
    x, y = (homogeneous.x, homogeneous.y) if centre is None else (float(centre[0]), float(centre[1]))
    largest = homogeneous.mass * _largest_gyration(vertices, np.array([x, y]))
    polar = homogeneous.polar if moment_of_inertia is None else moment_of_inertia
    if polar > largest * (1.0 + _SLACK):
        given = "" if moment_of_inertia is not None else ", that of the homogeneous body, which is assumed,"
        raise GeometryError(
            f"moment_of_inertia = {polar:.6g} kg m2{given} is more than the {largest:.6g} kg m2 of all mass in the "
            "corners; it is the polar moment about the centre of mass: was it taken about a foot, or in other units?"
        )
    share = polar / homogeneous.polar
    return PlaneMoments(homogeneous.mass, x, y, homogeneous.xx * share, homogeneous.yy * share)


def _largest_gyration(vertices: FloatArray, centre: FloatArray) -> float:
    """Largest squared radius of gyration [m2] of masses within the hull of the vertices that have this centre."""
    from scipy.optimize import linprog

    size = float(np.ptp(vertices, axis=0).max())
    arms = (vertices - centre) / size
    sums = np.vstack([arms.T, np.ones(len(arms))])
    # the square of the arm is convex, so that the most is reached with all mass in vertices: a linear programme
    found = linprog(-(arms**2).sum(axis=1), A_eq=sums, b_eq=[0.0, 0.0, 1.0], bounds=(0.0, None))
    if not found.success or found.fun is None:
        raise GeometryError("the centre of mass lies outside the outline; was it measured from another origin?")
    return -float(found.fun) * size**2


def checked_centre(centre: Any) -> FloatArray:
    """Return a centre (x, y) [m] as numbers."""
    try:
        x, y = centre
    except (TypeError, ValueError) as error:
        raise GeometryError(f"centre must be a pair (x, y) in m, got {centre!r:.60}") from error
    return np.array([checks.number("x of the centre", x, "m"), checks.number("y of the centre", y, "m")])
