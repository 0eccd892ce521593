"""Plane bodies on each other: drums of a column, a showcase on a pedestal, courses of a wall."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.answers import Answer
from rocking.bodies.block import Block
from rocking.bodies.body import Body, Side, assumed_together
from rocking.bodies.isolated import Isolated
from rocking.bodies.mass_points import MassPoints
from rocking.bodies.restrained import Restrained
from rocking.bodies.section import Section
from rocking.bodies.top_edge import top_edge
from rocking.conventions import Foot
from rocking.errors import GeometryError, InvalidValueError

MOST_BODIES = 100


@dataclass(frozen=True)
class Joint:
    """The joint below a body. Left and right are the ends of the common stretch of both faces.

    Parameters
    ----------
    height : float
        Height of the joint above the ground [m].
    left, right : float
        Positions of the contact corners [m].
    left_above, right_above : bool
        True if the corner belongs to the upper body, False if the corner belongs to the lower body.

    Examples
    --------
    >>> import rocking as rk
    >>> stack = rk.Stack([rk.Block(width=1.0, height=2.0), rk.Block(width=0.6, height=2.0)])
    >>> round(stack.joints[1].left, 12), stack.joints[1].left_above
    (-0.3, True)
    """

    height: float
    left: float
    right: float
    left_above: bool = True
    right_above: bool = True

    @property
    def width(self) -> float:
        """Distance of the contact corners [m]."""
        return self.right - self.left


@dataclass(frozen=True)
class Stack:
    """Plane bodies on each other, from bottom to top, on the ground.

    Parameters
    ----------
    bodies : sequence of Body
        Blocks and sections, lowest first. Mass points are allowed at the top only, because they have no top edge.
    friction : float or sequence of float, optional
        Coulomb's coefficient of every joint, lowest first, from 0 to 1e6 [-]. None: no joint slides.
    restitution : float or sequence of float
        Coefficient of normal restitution of the corners of every joint, in [0, 1) [-]. The default 0 is a plastic
        impact.
    offsets : float or sequence of float
        Horizontal distance of the middle of the feet of a body from the middle of the top edge below, one value for
        every body above the lowest body [m].

    Raises
    ------
    InvalidValueError
        If there is no body, a body is not a plane body, or a coefficient is outside its range.
    GeometryError
        If a body has no horizontal top edge below another body, faces do not overlap, or a joint does not support the
        bodies above.

    Notes
    -----
    The joints are dry and without mortar. The contact points of a joint are the corners of the narrower face
    (Psycharis 1990; docs/theory/stacks.md).

    Examples
    --------
    >>> import rocking as rk
    >>> pedestal, bust = rk.Block(width=0.6, height=1.2), rk.Block(width=0.4, height=0.8)
    >>> stack = rk.Stack([pedestal, bust], friction=0.7)
    >>> len(stack.joints), round(stack.height, 12)
    (2, 2.0)
    """

    bodies: tuple[Body, ...]
    friction: tuple[float, ...]  # infinite for joints that do not slide
    restitution: tuple[float, ...]
    offsets: tuple[float, ...]

    def __init__(
        self,
        bodies: Sequence[Body],
        friction: float | Sequence[float] | None = None,
        restitution: float | Sequence[float] = 0.0,
        offsets: float | Sequence[float] = 0.0,
    ) -> None:
        entries: Any = bodies
        listed = tuple(entries) if isinstance(entries, Iterable) else (entries,)
        for body in listed:
            checks.of_kind("bodies", body, (Block, Section, MassPoints), "a Block, Section or MassPoints")
        count = checks.whole("number of bodies", len(listed), 1, MOST_BODIES)
        object.__setattr__(self, "bodies", listed)
        object.__setattr__(self, "friction", _per_joint("friction", friction, count, 1e6))
        object.__setattr__(self, "restitution", _per_joint("restitution", restitution, count, 1.0, open_high=True))
        object.__setattr__(self, "offsets", _offsets(offsets, count - 1))
        self._check_support()

    @cached_property
    def origins(self) -> tuple[tuple[float, float], ...]:
        """Origin of the local frame of every body: horizontal position and height [m].

        The middle of the feet of the lowest body is at zero.
        """
        left, right = self.bodies[0].local_feet
        origins = [(-0.5 * (left + right), 0.0)]
        for below, body, offset in zip(self.bodies, self.bodies[1:], self.offsets, strict=False):
            (x, y), (start, end) = origins[-1], top_edge(below)
            left, right = body.local_feet
            origins.append((x + 0.5 * (start + end) - 0.5 * (left + right) + offset, y + below.local_box[3]))
        return tuple(origins)

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Joints, lowest first. Joint 1 is the joint on the ground."""
        (x, _), (left, right) = self.origins[0], self.bodies[0].local_feet
        joints = [Joint(0.0, x + left, x + right)]
        for index in range(1, len(self.bodies)):
            (below, _), (above, height) = self.origins[index - 1], self.origins[index]
            start, end = (below + value for value in top_edge(self.bodies[index - 1]))
            left, right = (above + value for value in self.bodies[index].local_feet)
            if not min(end, right) > max(start, left):
                raise GeometryError("body {number} has no support on the body below", number=index + 1)
            joints.append(Joint(height, max(start, left), min(end, right), left >= start, right <= end))
        return tuple(joints)

    @cached_property
    def centres(self) -> tuple[tuple[float, float], ...]:
        """Centre of mass of every body: horizontal position and height [m]."""
        pairs = zip(self.origins, self.bodies, strict=True)
        return tuple((x + body.local_moments.x, y + body.local_moments.y) for (x, y), body in pairs)

    @property
    def mass(self) -> float:
        """Mass of all bodies [kg]."""
        return float(sum(body.mass for body in self.bodies))

    @property
    def height(self) -> float:
        """Height of the stack [m]."""
        return self.origins[-1][1] + self.bodies[-1].local_box[3]

    @property
    def densities(self) -> tuple[float, ...]:
        """Densities of the parts of all bodies [kg/m3]."""
        return tuple(density for body in self.bodies for density in body.densities)

    @property
    def assumed(self) -> tuple[str, ...]:
        """Assumed values of the bodies, as texts."""
        return assumed_together(self.bodies)

    def side(self, foot: Foot, gravity: float = conventions.g) -> Side:
        """Return the parameters of the stack as one body for rotation about one foot.

        Parameters
        ----------
        foot : {"left", "right"}
            The foot of the rotation.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Side
            Slenderness, semi-diagonal, frequency parameter and uplift acceleration of the rigidly connected bodies.
        """
        return self.side_above(0, foot, gravity)

    def side_above(self, joint: int, foot: Foot, gravity: float = conventions.g) -> Side:
        """Return the parameters of all bodies above a joint as one body for rotation about a corner of the joint.

        Parameters
        ----------
        joint : int
            Index of the joint, 0 for the ground.
        foot : {"left", "right"}
            The corner of the rotation.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Side
            Slenderness, semi-diagonal, frequency parameter and uplift acceleration.
        """
        foot, base = checks.foot("foot", foot), self.joints[joint]
        bodies, centres = self.bodies[joint:], self.centres[joint:]
        mass = float(sum(body.mass for body in bodies))
        pairs = list(zip(bodies, centres, strict=True))
        x, y = (sum(body.mass * centre[axis] for body, centre in pairs) / mass for axis in (0, 1))
        half_width = x - base.left if foot == "left" else base.right - x
        pivot = base.left if foot == "left" else base.right
        inertia = sum(
            body.moment_of_inertia + body.mass * ((cx - pivot) ** 2 + (cy - base.height) ** 2)
            for body, (cx, cy) in pairs
        )
        return Side(foot, half_width, y - base.height, mass, inertia, checks.positive("gravity", gravity, "m/s2"))

    def answer(self, gravity: float = conventions.g) -> Answer:
        """Return the results of the stack.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Answer
            Number of bodies, mass, and for every joint height, width, friction, restitution and uplift acceleration of
            the bodies above.
        """
        return Answer({
            "kind": type(self).__name__, "mass": self.mass, "gravity": gravity, "assumed": self.assumed,
            "joints": [
                {
                    "joint": index + 1, "joint_height": joint.height, "joint_width": joint.width,
                    "friction": self.friction[index] if self.friction[index] < math.inf else None,
                    "normal_restitution": self.restitution[index],
                    "uplift_acceleration": min(
                        self.side_above(index, foot, gravity).uplift_acceleration for foot in conventions.FEET
                    ),
                }
                for index, joint in enumerate(self.joints)
            ],
        })  # fmt: skip

    def _check_support(self) -> None:
        for index, joint in enumerate(self.joints):
            for foot in conventions.FEET:
                if not self.side_above(index, foot).half_width > 1e-12 * joint.width:
                    raise GeometryError(
                        "joint {joint} does not support the bodies above: their centre of mass is not between the "
                        "corners of the joint", joint=index + 1,
                    )  # fmt: skip


PLANE_BODIES = (Body, Restrained, Isolated, Stack)
"""Classes of plane bodies: alone, with restraints, on an isolated base, and on each other."""


def _per_joint(name: str, values: Any, count: int, high: float, **options: Any) -> tuple[float, ...]:
    """Return one coefficient per joint; infinite without values."""
    if values is None:
        return (math.inf,) * count
    listed = [values] * count if np.ndim(values) == 0 else list(values)
    if len(listed) != count:
        raise InvalidValueError(
            parameter=name, allowed="one value, or one value per joint, lowest first", value=len(listed)
        )
    return tuple(checks.within(name, value, 0.0, high, **options) for value in listed)


def _offsets(values: Any, count: int) -> tuple[float, ...]:
    listed = [values] * (count or values != 0.0) if np.ndim(values) == 0 else list(values)
    if len(listed) != count:
        raise InvalidValueError(
            parameter="offsets", allowed="one value per body above the lowest body", value=len(listed)
        )
    return tuple(checks.number("offsets", value, "m") for value in listed)
