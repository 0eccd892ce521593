"""The ground: a plane that may be tilted, and may end, and its acceleration."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.dynamics.hull.vectors import Frame, Vector, applied, minus
from rocking.dynamics.space.ground import SpatialGround, ground_of


@dataclass(frozen=True, eq=False)
class HullGround:
    """The plane that a body stands on, and how it moves.

    Parameters
    ----------
    x, y, vertical : GroundMotion, pulse or None
        Accelerations, in level axes [m/s2].
    slope : float
        Angle of the plane from the horizontal [rad].
    azimuth : float
        Direction in which it falls, from x towards y [rad].
    shelf : tuple of float, optional
        Half sizes of the plane along its two axes from the origin; points beyond do not touch. Edges of the shelf do
        not touch the body either. None for a plane without end [m].
    gravity : float
        Acceleration of gravity [m/s2].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    x: Any = None
    y: Any = None
    vertical: Any = None
    slope: float = 0.0
    azimuth: float = 0.0
    shelf: tuple[float, float] | None = None
    gravity: float = conventions.g
    motion: SpatialGround = field(init=False, repr=False)  # the three components on common stretches of time
    level: Frame = field(init=False, repr=False)  # level axes to axes of the plane

    def __post_init__(self) -> None:
        """Check the values and cut the motions to common stretches."""
        checks.within("slope", self.slope, 0.0, 0.5 * math.pi, unit="rad", open_high=True)
        checks.within("gravity", self.gravity, 0.0, 1e6, unit="m/s2", open_low=True)
        object.__setattr__(self, "motion", ground_of(self.x, self.y, self.vertical))
        c, s, cc, ss = math.cos(self.azimuth), math.sin(self.azimuth), math.cos(self.slope), math.sin(self.slope)
        # turned about the horizontal line across the direction in which the plane falls
        rows: Frame = (
            (c * c * cc + s * s, c * s * (cc - 1.0), -c * ss),
            (c * s * (cc - 1.0), s * s * cc + c * c, -s * ss),
            (c * ss, s * ss, cc),
        )
        object.__setattr__(self, "level", rows)

    @classmethod
    def placed(cls, motion: SpatialGround, level: Any, shelf: Any, gravity: float) -> "HullGround":
        """Return a ground from its motion and its axes.

        Parameters
        ----------
        motion : SpatialGround
            The three components, in level axes [m/s2].
        level : array_like, 9 numbers
            Level axes to axes of the plane [-].
        shelf : array_like, 2 numbers
            Half sizes of the plane, infinite without end [m].
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        HullGround
            The ground.
        """
        ends = float(shelf[0]), float(shelf[1])
        made = cls(shelf=None if ends == (math.inf, math.inf) else ends, gravity=gravity)
        object.__setattr__(made, "motion", motion)
        a, b, c = (tuple(map(float, row)) for row in np.reshape(level, (3, 3)))
        object.__setattr__(made, "level", (a, b, c))
        return made

    @property
    def weight(self) -> Vector:
        """Gravity, in axes of the plane [m/s2]."""
        return applied(self.level, (0.0, 0.0, -self.gravity))

    def field(self, stretch: int, start: float, span: float) -> list[Vector]:
        """Return gravity less the ground's acceleration over a span, by powers of its share, in axes of the plane.

        Parameters
        ----------
        stretch : int
            Number of the stretch.
        start, span : float
            When the span starts, and its duration [s].

        Returns
        -------
        list of tuple of float
            Coefficients, from the power 0 [m/s2].
        """
        rows = self.motion.part(stretch, start, span)
        found = []
        for k in range(rows.shape[1]):
            a = applied(self.level, (float(rows[0, k]), float(rows[1, k]), float(rows[2, k])))
            found.append(minus(self.weight if k == 0 else (0.0, 0.0, 0.0), a))
        return found

    def under(self, place: Vector) -> bool:
        """Return whether there is ground under a point.

        Parameters
        ----------
        place : tuple of float
            The point [m].

        Returns
        -------
        bool
            False beyond the shelf.
        """
        return self.shelf is None or self.inside(place) >= 0.0

    def inside(self, place: Vector) -> float:
        """Return the distance of a point from the nearest edge of the shelf.

        Parameters
        ----------
        place : tuple of float
            The point [m].

        Returns
        -------
        float
            Below zero beyond it [m].
        """
        assert self.shelf is not None
        return min(self.shelf[0] - abs(place[0]), self.shelf[1] - abs(place[1]))
