"""What is made on a lathe: cylinders, cones, ellipsoids, sphere caps and any profile of straight pieces."""

import math

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies import topology
from rocking.bodies.solid.turned import Meridian, Turned
from rocking.errors import GeometryError


def revolution(profile: ArrayLike) -> Turned:
    """Return a profile of straight pieces turned about the z axis.

    Parameters
    ----------
    profile : array_like, shape (n, 2)
        Points (radius, height) [m] from the axis at the bottom to the axis at the top; a profile that does not
        start or end on the axis is closed by a flat disc.

    Returns
    -------
    Turned
        The shape.

    Raises
    ------
    GeometryError
        If the profile crosses itself or leaves the half plane.

    Examples
    --------
    >>> round(revolution([(1.0, 0.0), (1.0, 2.0)]).moments().mass / np.pi, 12)
    2.0
    """
    points = checks.real_array("profile", profile, "m")
    if points.ndim != 2 or points.shape[1:] != (2,) or len(points) < 2 or not np.isfinite(points).all():
        raise GeometryError("profile must be at least two points (radius, height) in m, all finite")
    if (points[:, 0] < 0.0).any():
        raise GeometryError(f"radii of the profile must be >= 0 m, got {points[:, 0].min():g}")
    first, last = points[0, 1], points[-1, 1]
    if last <= first:
        raise GeometryError(f"the profile must end above its start, got heights {first:g} and {last:g} m")
    closed = topology.ring("profile", np.concatenate([[(0.0, first)], points, [(0.0, last)]]))
    topology.check_polygon("profile", closed, ())
    checks.length("largest dimension of the profile", float(np.ptp(closed, axis=0).max()))
    start = int(np.flatnonzero((closed == (0.0, first)).all(axis=1))[0])
    ordered = np.roll(closed, -start, axis=0)
    return Turned(tuple(Meridian(ordered[i : i + 2].copy()) for i in range(len(ordered) - 1)), (1.0, 1.0))


def cylinder(diameter: float, height: float) -> Turned:
    """Return an upright cylinder on z = 0.

    Parameters
    ----------
    diameter, height : float
        Full sizes [m].

    Returns
    -------
    Turned
        The shape.

    Examples
    --------
    >>> round(cylinder(2.0, 1.0).moments().mass / np.pi, 12)
    1.0
    """
    return frustum(diameter, diameter, height)


def frustum(lower_diameter: float, upper_diameter: float, height: float) -> Turned:
    """Return an upright cone cut off at the top, on z = 0.

    Parameters
    ----------
    lower_diameter, upper_diameter : float
        Diameters below and above; the upper one may be zero, which gives a cone [m].
    height : float
        Height [m].

    Returns
    -------
    Turned
        The shape.

    Examples
    --------
    >>> round(frustum(2.0, 0.0, 3.0).moments().mass / np.pi, 12)
    1.0
    """
    lower = 0.5 * checks.length("lower_diameter", lower_diameter)
    upper = 0.5 * checks.within("upper_diameter", upper_diameter, 0.0, checks.LARGEST, unit="m")
    high = checks.length("height", height)
    return revolution([(lower, 0.0), (upper, high)])


def cone(diameter: float, height: float) -> Turned:
    """Return an upright cone on z = 0.

    Parameters
    ----------
    diameter, height : float
        Diameter of the base and height [m].

    Returns
    -------
    Turned
        The shape.

    Examples
    --------
    >>> round(float(cone(2.0, 4.0).moments().centre[2]), 12)
    1.0
    """
    return frustum(diameter, 0.0, height)


def ellipsoid(width: float, depth: float, height: float, *, cut_below: float = 0.0, cut_above: float = 0.0) -> Turned:
    """Return an ellipsoid, or what two level cuts leave of it, its lowest point on z = 0.

    Parameters
    ----------
    width, depth, height : float
        Full axes along x, y and z of the whole ellipsoid [m].
    cut_below, cut_above : float
        Heights of the caps that are cut off [m].

    Returns
    -------
    Turned
        The shape: a sphere cap, for instance, is an equal-sided ellipsoid cut from below.

    Raises
    ------
    GeometryError
        If the cuts leave nothing.

    Examples
    --------
    >>> round(ellipsoid(2.0, 2.0, 2.0, cut_below=1.0).moments().mass / (2.0 * np.pi / 3.0), 12)
    1.0
    """
    a, b = 0.5 * checks.length("width", width), 0.5 * checks.length("depth", depth)
    half = 0.5 * checks.length("height", height)
    below = checks.within("cut_below", cut_below, 0.0, 2.0 * half, unit="m")
    above = checks.within("cut_above", cut_above, 0.0, 2.0 * half, unit="m")
    if below + above >= 2.0 * half * (1.0 - 1e-9):
        raise GeometryError(f"cuts of {below:g} and {above:g} m leave nothing of an ellipsoid {2.0 * half:g} m high")
    low, high = math.acos(max(below / half - 1.0, -1.0)), math.acos(min(1.0 - above / half, 1.0))
    top = 2.0 * half - below - above
    pieces = [Meridian(np.array([[low, high], [half - below, half]]), arc=True)]
    if below > 0.0:
        pieces.insert(0, Meridian(np.array([[0.0, 0.0], [math.sin(low), 0.0]])))
    if above > 0.0:
        pieces.append(Meridian(np.array([[math.sin(high), top], [0.0, top]])))
    return Turned(tuple(pieces), (a, b))


def sphere_cap(diameter: float, height: float) -> Turned:
    """Return what a level cut leaves of a sphere above it, standing on the cut.

    Parameters
    ----------
    diameter : float
        Diameter of the sphere [m].
    height : float
        Height of the cap, at most the diameter [m].

    Returns
    -------
    Turned
        The shape.

    Examples
    --------
    >>> round(sphere_cap(2.0, 0.5).moments().mass * 24.0 / np.pi, 12)
    5.0
    """
    high = checks.within("height", height, 0.0, checks.length("diameter", diameter), unit="m", open_low=True)
    return ellipsoid(diameter, diameter, diameter, cut_below=diameter - high)
