"""Measured or computed centre of mass and moment of inertia, which replace the values of the outline."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.moments import PlaneMoments
from rocking.conventions import Assumed, FloatArray
from rocking.errors import GeometryError, InvalidValueError
from rocking.messages import Amount, Message, Range

_SLACK = 1e-6  # tolerance for rounding: (moment - largest possible moment) / largest possible moment


Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Known:
    """Known centre of mass and moment of inertia; None if unknown."""

    centre: Point | None = None  # centre of mass in the local frame [m]
    moment_of_inertia: float | None = None  # polar moment of inertia about the centre of mass [kg m2]

    @classmethod
    def of(cls, centre: Any, moment_of_inertia: Any, origin: Point = (0.0, 0.0)) -> "Known | None":
        """Return the checked values, or None if no value is given. The centre of mass is in the user's frame [m]."""
        if centre is None and moment_of_inertia is None:
            return None
        if moment_of_inertia is not None:
            moment_of_inertia = checks.positive("moment_of_inertia", moment_of_inertia, "kg m2")
        if centre is None:
            return cls(None, moment_of_inertia)
        try:
            x, y = centre
        except (TypeError, ValueError) as error:
            raise GeometryError(parameter="centre", allowed="a pair (x, y) in m, y upwards", value=centre) from error
        x, y = checks.number("x of the centre", x, "m"), checks.number("y of the centre", y, "m")
        return cls((x - origin[0], y - origin[1]), moment_of_inertia)

    def arguments(self, origin: Point = (0.0, 0.0)) -> dict[str, Any]:
        """Return the known values by argument name. The centre of mass is in the user's frame [m]."""
        centre = None if self.centre is None else (self.centre[0] + origin[0], self.centre[1] + origin[1])
        named = {"centre": centre, "moment_of_inertia": self.moment_of_inertia}
        return {name: value for name, value in named.items() if value is not None}

    def moments(self, homogeneous: PlaneMoments, vertices: FloatArray, origin: Point = (0.0, 0.0)) -> PlaneMoments:
        """Return the moments of the body from the homogeneous moments and the vertices in the local frame [m]."""
        # An unknown moment of inertia is a fraction of the largest possible moment. The homogeneous body gives this
        # fraction. For a rectangle, the result is the moment of four homogeneous quarters about the centre of mass. The
        # moments xx and yy are computed in the same way.
        x, y = self.centre or (homogeneous.x, homogeneous.y)
        (left, low), (right, high) = vertices.min(axis=0).tolist(), vertices.max(axis=0).tolist()
        gyration = largest_gyration(vertices, x, y) if left < x < right and low < y < high else None
        if gyration is None:
            dx, dy = origin
            raise GeometryError(
                "the centre of mass must lie within the outline, x {x_allowed}, y {y_allowed}, and within its convex "
                "hull, got ({x}, {y})",
                parameter="centre", value=(x + dx, y + dy),
                hint="check the origin and the unit",
                x_allowed=Range(left + dx, right + dx, "m", True, True),
                y_allowed=Range(low + dy, high + dy, "m", True, True),
                x=Amount(x + dx, "m", ".6g"), y=Amount(y + dy, "m", ".6g"),
            )  # fmt: skip
        largest, polar = homogeneous.mass * gyration, self.moment_of_inertia
        if polar is None:
            before = largest_gyration(vertices, homogeneous.x, homogeneous.y)
            polar = homogeneous.polar * (gyration / before if before else 1.0)  # Eq. 240
        elif polar > largest * (1.0 + _SLACK):
            raise GeometryError(
                "{parameter} must be at most {largest} (all mass in the corners of the outline), got {value}",
                parameter="moment_of_inertia", value=polar, largest=Amount(largest, "kg m2", ".6g"),
                hint="check the unit, and that the moment is about the centre of mass",
            )  # fmt: skip
        xx = homogeneous.xx * (x - left) * (right - x) / ((homogeneous.x - left) * (right - homogeneous.x))
        yy = homogeneous.yy * (y - low) * (high - y) / ((homogeneous.y - low) * (high - homogeneous.y))
        wide = polar * xx / (xx + yy)
        return PlaneMoments(homogeneous.mass, x, y, wide, polar - wide)

    def mirrored(self, twice_axis: float = 0.0) -> "Known":
        """Return the mirrored values; `twice_axis` is twice the position of the vertical mirror axis [m]."""
        return self if self.centre is None else replace(self, centre=(twice_axis - self.centre[0], self.centre[1]))

    def scaled(self, size: float, density: float) -> "Known":
        """Return the values of the scaled body; `size` and `density` are scale factors [-]."""
        centre, moment = self.centre, self.moment_of_inertia
        return Known(
            None if centre is None else (centre[0] * size, centre[1] * size),
            None if moment is None else moment * density * size**5,
        )

    @property
    def assumed(self) -> tuple[str, ...]:
        """Further assumptions, as texts."""
        distribution = Message(
            "mass distribution assumed by ked and horizontal-momentum: uniform in each quarter of the bounding box "
            "about the centre of mass, contracted or moved to the corners according to the moment of inertia"
        )
        if self.moment_of_inertia is not None:
            return (distribution,)
        return (
            Message(
                "moment of inertia assumed: its ratio to the largest possible value in the outline is that of the "
                "homogeneous body"
            ),
            distribution,
        )


def largest_gyration(vertices: FloatArray, x: float, y: float) -> float | None:
    """Return the largest squared radius of gyration of masses in the hull about (x, y) [m2]; None outside the hull."""
    low, high, centre = vertices.min(axis=0), vertices.max(axis=0), np.array([x, y])
    corners = vertices[((vertices == low) | (vertices == high)).all(axis=1)]
    if len(np.unique(corners, axis=0)) == 4:  # the hull of the vertices is their bounding box
        return float(((centre - low) * (high - centre)).sum())
    return _largest_of_polygon(vertices, centre)


def _largest_of_polygon(vertices: FloatArray, centre: FloatArray) -> float | None:
    from scipy.optimize import linprog

    size = float(np.ptp(vertices, axis=0).max())
    arms = (vertices - centre) / size
    squares = (arms**2).sum(axis=1)
    # the squared distance is convex: at the maximum, all mass is in vertices (a linear programme)
    sums = np.vstack([arms.T, np.ones(len(arms))])
    optimum = linprog(-squares, A_eq=sums, b_eq=[0.0, 0.0, 1.0], bounds=(0.0, None))  # Eq. 239
    if not optimum.success or optimum.x is None:
        return None
    # recompute the weights of the three corners in arithmetic with equal results on every processor
    chosen = np.argsort(-optimum.x, kind="stable")[:3]
    a, b, c = arms[chosen].tolist()
    weights = np.array([p[0] * q[1] - p[1] * q[0] for p, q in ((b, c), (c, a), (a, b))])
    if abs(weights.sum()) < 1e-9:  # centre and corners are collinear
        return float((optimum.x * squares).sum()) * size**2
    return float((weights * squares[chosen]).sum() / weights.sum()) * size**2


def density_of(mass: float, volume: float, densities: tuple[float, ...]) -> float:
    """Return mass / volume [kg/m3] after a check that none of the densities is stated."""
    mass = checks.positive("mass", mass, "kg")
    stated = next((value for value in densities if not isinstance(value, Assumed)), None)
    if stated is not None:
        raise InvalidValueError(
            "Use mass = {mass:g} kg or density = {density:g} kg/m3, not both.", mass=mass, density=stated
        )
    density = mass / volume
    if not math.isfinite(density):
        raise InvalidValueError(
            "mass = {mass:g} kg is too large for {volume:g} m3. Check the unit.", mass=mass, volume=volume
        )
    return checks.density("density from mass and size", density)
