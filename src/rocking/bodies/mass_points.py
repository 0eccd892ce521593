"""A body of mass points, as in the model of Mao et al. (2024)."""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.body import Body, Interval, feet_of
from rocking.bodies.moments import PlaneMoments
from rocking.conventions import FloatArray
from rocking.errors import GeometryError, InvalidValueError
from rocking.messages import Index

HEAVIEST = 1e36  # largest mass of a point [kg]; this limit prevents overflow of sums and moments


class MassPoints(Body):
    """A rigid body of mass points, for instance from a mesh.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Positions (x, y) with y >= 0; the ground is y = 0 [m].
    masses : array_like, shape (n,)
        Masses, all above zero [kg].
    feet : (float, float)
        Positions of the left and right foot on the ground [m].
    contact : sequence of (float, float), optional
        Contact intervals of the base [m]; the default is the complete base between the feet.

    Raises
    ------
    GeometryError
        If a point is not finite or below the ground, or the centre of mass is not between the feet.
    InvalidValueError
        If a mass is not a finite number above zero.

    Examples
    --------
    A single mass at the polar angle phi from the new pivot has r = sin(phi)**2:

    >>> import rocking as rk
    >>> lollipop = rk.MassPoints([(0.0, 2.0)], [1.0], feet=(-1.0, 1.0))
    >>> round(rk.coefficient_of_restitution(lollipop, "ked"), 12)
    0.8
    """

    def __init__(
        self,
        points: Any,
        masses: Any,
        feet: tuple[float, float],
        contact: Sequence[tuple[float, float]] | None = None,
    ) -> None:
        self.masses = np.atleast_1d(checks.positive_array("masses", masses, "kg"))
        if self.masses.max(initial=0.0) > HEAVIEST:
            raise GeometryError(
                "{parameter} must not exceed {limit:g} kg, got {value}", parameter="masses",
                value=float(self.masses.max()), limit=HEAVIEST, hint="check the unit",
            )  # fmt: skip
        if self.masses.ndim != 1:
            raise GeometryError(
                "{parameter} must be {allowed}, got an array of shape {shape}", parameter="masses",
                allowed="a list of numbers", shape=self.masses.shape,
            )  # fmt: skip
        self.points = _points(points, len(self.masses))
        self._feet = feet_of(feet)
        self._contact = None if contact is None else _stretches(contact)
        self._check_support()

    @property
    def local_feet(self) -> Interval:
        return self._feet

    @cached_property
    def local_moments(self) -> PlaneMoments:
        """Mass, centre of mass and central second moments, as sums over the points."""
        mass = float(self.masses.sum())
        x, y = (self.masses[:, None] * self.points).sum(axis=0) / mass
        xx, yy = (self.masses[:, None] * (self.points - (x, y)) ** 2).sum(axis=0)
        return PlaneMoments(mass, float(x), float(y), float(xx), float(yy))

    @property
    def local_contact(self) -> tuple[Interval, ...]:
        """Stated contact intervals between the feet, by default the complete base [m]."""
        if self._contact is None:
            return (self._feet,)
        left, right = self._feet
        cut = ((max(float(a), left), min(float(b), right)) for a, b in sorted(self._contact))
        return tuple((a, b) for a, b in cut if b > a)

    @property
    def local_box(self) -> tuple[float, float, float, float]:
        """Bounding box of points and feet (x_min, y_min, x_max, y_max) [m]."""
        left, right = self._feet
        x, y = self.points.T
        return min(left, float(x.min())), 0.0, max(right, float(x.max())), float(y.max())

    def mirrored(self) -> "MassPoints":
        """Return the points mirrored about x = 0."""
        left, right = self._feet
        contact = None if self._contact is None else [(-b, -a) for a, b in self._contact]
        return MassPoints(self.points * (-1.0, 1.0), self.masses, (-right, -left), contact)

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "MassPoints":
        size, density = checks.positive("size", size), checks.positive("density", density)
        left, right = self._feet
        contact = None if self._contact is None else [(a * size, b * size) for a, b in self._contact]
        return MassPoints(self.points * size, self.masses * density, (left * size, right * size), contact)

    def with_feet(self, left: float, right: float) -> "MassPoints":
        return MassPoints(self.points, self.masses, (left, right), self._contact)


def _stretches(contact: Any) -> list[Interval]:
    try:
        pairs = [(float(a), float(b)) for a, b in contact]
    except (TypeError, ValueError) as error:
        raise GeometryError("contact must be a list of pairs (x_left, x_right) in m") from error
    for a, b in pairs:
        if not (math.isfinite(a) and math.isfinite(b) and a <= b):
            raise GeometryError(
                "An interval of {parameter} must be finite with left <= right, got ({left:g}, {right:g}) m.",
                parameter="contact", left=a, right=b,
            )  # fmt: skip
    return pairs


def _points(points: Any, count: int) -> FloatArray:
    try:
        result = checks.real_array("points", points)
    except InvalidValueError as error:
        raise GeometryError("points must be a list of (x, y) in m") from error
    if result.shape != (count, 2) or count == 0:
        raise GeometryError(
            "{parameter} must have shape ({count}, 2), one (x, y) per mass, got {shape}", parameter="points",
            count=count, shape=result.shape,
        )  # fmt: skip
    bad = ~(np.isfinite(result).all(axis=1) & (result[:, 1] >= 0.0))
    if np.abs(result).max() > checks.LARGEST:
        raise GeometryError(
            "{parameter} must be within {limit:g} m of the origin", parameter="points", limit=checks.LARGEST,
            hint="check the unit",
        )  # fmt: skip
    if bad.any():
        i = int(np.argmax(bad))
        raise GeometryError(
            "point {index} must be finite with y >= 0 m, got {point}", index=Index(i), point=tuple(result[i].tolist())
        )
    return result
