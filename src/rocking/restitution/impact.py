"""Geometry of a plane impact: levers, height, gyration, and contact of the base."""

from dataclasses import dataclass

import numpy as np

from rocking.bodies import Body
from rocking.bodies.frame import refuse_frame
from rocking.conventions import FloatArray, Foot, opposite


@dataclass(frozen=True, slots=True)
class ImpactGeometry:
    """Levers and inertia of an impact, per unit mass. Fields are numbers or arrays of equal shape.

    The body turns about the old foot before the impact and about the new foot after the impact. The x axis is directed
    from the old to the new foot. Its origin is the plumb line of the centre of mass.

    Parameters
    ----------
    height : ndarray
        Height h of the centre of mass [m].
    old_lever : ndarray
        Distance of the old foot behind the plumb line [m].
    new_lever : ndarray
        Distance of the new foot ahead of the plumb line [m].
    spread_x, spread_y : ndarray
        Central second moments of x and of y, divided by the mass [m2].

    Examples
    --------
    >>> round(float(ImpactGeometry.of_slenderness(2.0).base_gyration), 12)
    5.666666666667
    """

    height: FloatArray
    old_lever: FloatArray
    new_lever: FloatArray
    spread_x: FloatArray
    spread_y: FloatArray

    def __post_init__(self) -> None:
        """Convert numbers to arrays."""
        for name in self.__slots__:
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=np.float64))

    @classmethod
    def of_body(cls, body: Body, foot: Foot) -> "ImpactGeometry":
        """Return the impact of a body onto one of its feet.

        Parameters
        ----------
        body : Body
            The body.
        foot : {"left", "right"}
            The new foot.

        Returns
        -------
        ImpactGeometry
            Geometry; its fields are zero-dimensional arrays.
        """
        refuse_frame(body)
        new, old, moments = body.side(foot), body.side(opposite(foot)), body.local_moments
        return cls(
            np.asarray(moments.y),
            np.asarray(old.half_width),
            np.asarray(new.half_width),
            np.asarray(moments.xx / moments.mass),
            np.asarray(moments.yy / moments.mass),
        )

    @classmethod
    def of_slenderness(cls, slenderness: FloatArray | float) -> "ImpactGeometry":
        """Return the impact of homogeneous rectangles with b = 1 m and h = slenderness ratio x 1 m.

        Parameters
        ----------
        slenderness : array_like
            Slenderness ratios h/b [-].

        Returns
        -------
        ImpactGeometry
            Geometry; its fields are arrays with the shape of `slenderness`.
        """
        h = np.asarray(slenderness, dtype=np.float64)
        ones = np.ones_like(h)
        return cls(h, ones, ones, ones / 3.0, h * h / 3.0)

    @property
    def base_gyration(self) -> FloatArray:
        """(I_C + m h^2) / m, about the point of the ground below the centre of mass [m2]."""
        return self.spread_x + self.spread_y + self.height**2  # Eq. 108

    @property
    def old_gyration(self) -> FloatArray:
        """I_O / m about the old foot [m2]."""
        return self.base_gyration + self.old_lever**2  # Eq. 108

    @property
    def new_gyration(self) -> FloatArray:
        """I_O' / m about the new foot [m2]."""
        return self.base_gyration + self.new_lever**2  # Eq. 108


def contact_of(body: Body, foot: Foot) -> FloatArray:
    """Return the flat segments of the base relative to the plumb line of the centre of mass [m], shape (n, 2)."""
    patches = np.array(body.local_contact, dtype=np.float64).reshape(-1, 2) - body.local_moments.x
    return patches if foot == "right" else np.ascontiguousarray(-patches[::-1, ::-1])


def is_whole_base(patches: FloatArray, geometry: ImpactGeometry) -> bool:
    """Return True if the base is in contact from foot to foot without a gap."""
    if len(patches) != 1:
        return False
    ends = np.array([-float(geometry.old_lever), float(geometry.new_lever)])
    return bool(np.abs(patches[0] - ends).max() <= 1e-9 * (ends[1] - ends[0]))
