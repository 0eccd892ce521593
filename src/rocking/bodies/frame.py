"""A rocking frame: columns that carry a rigid beam."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any, Literal, NamedTuple, NoReturn

import numpy as np

from rocking import checks, conventions
from rocking.answers import Answer
from rocking.bodies.block import Block
from rocking.bodies.body import GROUND_TOLERANCE, Body, Interval, Side
from rocking.bodies.moments import PlaneMoments
from rocking.bodies.section import Section
from rocking.bodies.top_edge import top_edge
from rocking.conventions import FEET, Assumed, Foot, opposite
from rocking.errors import GeometryError, InvalidValueError

SUPPORTS = ("corner", "hinge")
_UNEQUAL = (
    "column {index} must have the height, the base and the top of column 1: otherwise the columns turn by different "
    "angles, and the beam tilts or leaves a column"
)


class _Column(NamedTuple):
    """A column in coordinates from its left foot [m]."""

    moments: PlaneMoments
    centre: float  # horizontal position of the centre of mass
    base: float  # distance of the feet
    top: tuple[float, float, float]  # left and right end of the top, and the height


class Frame(Body):
    """Columns under a rigid beam that rock together.

    All columns turn by the same angle, and the beam moves without rotation. The frame is exactly equivalent to one
    rocking body, for all rotations.

    Parameters
    ----------
    columns : sequence of Block or Section
        The columns. Their heights, bases and tops must be equal. Masses, centres of mass and moments of inertia may
        differ. The positions of the columns along the beam have no influence.
    beam_mass : float
        Mass of the beam and of everything that moves with the beam, zero or positive [kg].
    beam_on : {"corner", "hinge"}
        Support of the beam. With "corner", the beam rests on the tops. Each column carries the beam at the corner
        opposite to its foot in contact. With "hinge", a hinge at the middle of the top of each column carries the beam.

    Raises
    ------
    GeometryError
        If the columns have different shapes, or the frame is not stable.
    InvalidValueError
        If a column is not a Block or a Section, the density of a column is not stated, or a value is outside its range.

    Notes
    -----
    The model is that of Makris & Vassiliou (2013). The columns do not slide, and the beam does not leave the columns.
    The restitution is the projection of the motion before the impact, with ideal impulses at both ends of each column
    (Housner's model for the frame). There are no measurements of frames. Therefore other models of restitution refuse
    a frame, and a coefficient can be given.

    Examples
    --------
    >>> import rocking as rk
    >>> column = rk.Block(width=1.0, height=4.0, mass=10e3)
    >>> frame = rk.Frame([column] * 4, beam_mass=40e3)
    >>> round((frame.frequency_parameter / column.frequency_parameter) ** 2, 12)
    0.75
    >>> round(136 * rk.coefficient_of_restitution(frame), 9)
    121.0
    """

    def __init__(
        self, columns: Sequence[Body], beam_mass: float, *, beam_on: Literal["corner", "hinge"] = "corner"
    ) -> None:
        checks.of_kind("columns", columns, Sequence, "a list of columns")
        listed = [*columns]
        if not listed:
            raise InvalidValueError(parameter="columns", allowed="one or more columns", value=columns)
        for column in listed:
            checks.of_kind("columns", column, (Block, Section), "Block or Section objects")
            if any(isinstance(density, Assumed) for density in column.densities):
                raise InvalidValueError(
                    "State the mass or the density of each column: with a beam, the mass of the columns affects "
                    "rotations.", parameter="columns",
                )  # fmt: skip
        if beam_on not in SUPPORTS:
            raise InvalidValueError(parameter="beam_on", allowed='"corner" or "hinge"', value=beam_on)
        self.columns: tuple[Body, ...] = tuple(listed)
        self.beam_mass = checks.within("beam_mass", beam_mass, 0.0, 1e36, unit="kg")
        self.beam_on = beam_on
        self._items = tuple(map(_column, listed))
        first = self._items[0]
        shape = np.array([first.base, *first.top])
        for i, item in enumerate(self._items):
            if np.abs(np.array([item.base, *item.top]) - shape).max() > GROUND_TOLERANCE * first.top[2]:
                raise GeometryError(_UNEQUAL, parameter="columns", index=i + 1)
        for foot in FEET:
            if not self.side(foot).half_width > 0.0:
                raise GeometryError("the frame is not stable without motion about the {foot} feet", foot=foot)

    def __repr__(self) -> str:
        return f"Frame({len(self.columns)} column(s), beam_mass={self.beam_mass:g} kg, beam_on={self.beam_on!r})"

    @property
    def origin_x(self) -> float:
        """Horizontal position of the local frame of the first column in the user's coordinates [m]."""
        return self.columns[0].origin_x

    @property
    def ground(self) -> float:
        """Height of the ground in the user's coordinates [m]."""
        return self.columns[0].ground

    @property
    def local_feet(self) -> Interval:
        """Positions of the feet of the first column [m]."""
        return self.columns[0].local_feet

    @property
    def local_contact(self) -> tuple[Interval, ...]:
        """Contact intervals of the base of the first column [m]."""
        return self.columns[0].local_contact

    @property
    def local_box(self) -> tuple[float, float, float, float]:
        """Bounding box of the first column [m]."""
        return self.columns[0].local_box

    @cached_property
    def local_moments(self) -> PlaneMoments:
        """Moments of the equivalent body, with the centre of mass above the base of the first column."""
        sides = [self.side(foot) for foot in FEET]
        mass, height = sides[0].mass, sides[0].centre_height
        polar = sum(s.moment_of_inertia - mass * s.semi_diagonal**2 for s in sides) / 2.0
        rise = sum(m.yy + m.mass * (m.y - height) ** 2 for m, *_ in self._items)
        rise += self.beam_mass * (self._items[0].top[2] - height) ** 2
        x = 0.5 * (sides[0].half_width - sides[1].half_width + self._items[0].base)
        return PlaneMoments(mass, self.local_feet[0] + x, height, polar - rise, rise)

    def beam_point(self, foot: Foot) -> tuple[float, float]:
        """Return the point of a column that carries the beam, during rotation about one foot.

        Parameters
        ----------
        foot : {"left", "right"}
            The foot of the rotation.

        Returns
        -------
        (float, float)
            Horizontal distance from this foot towards the other foot, and height [m].
        """
        column = self._items[0]
        left, right, height = column.top
        middle = 0.5 * (left + right)
        if checks.foot("foot", foot) == "left":
            return (right if self.beam_on == "corner" else middle), height
        return column.base - (left if self.beam_on == "corner" else middle), height

    def side(self, foot: Foot, gravity: float = conventions.g) -> Side:
        """Return the parameters of the equivalent body for rotation about one foot of each column.

        Parameters
        ----------
        foot : {"left", "right"}
            The foot of the rotation.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Side
            Slenderness, semi-diagonal, frequency parameter and uplift acceleration of the equivalent body.
        """
        reach, height = self.beam_point(foot)
        masses = [(item.moments.mass, self._lever(item, foot), item.moments.y) for item in self._items]
        masses.append((self.beam_mass, reach, height))
        mass = sum(m for m, _, _ in masses)
        inertia = sum(item.moments.polar for item in self._items) + sum(m * (x * x + y * y) for m, x, y in masses)
        return Side(
            foot, sum(m * x for m, x, _ in masses) / mass, sum(m * y for m, _, y in masses) / mass,  # Eq. 369
            mass, inertia, checks.positive("gravity", gravity, "m/s2"),  # Eq. 370
        )  # fmt: skip

    def projection(self, foot: Foot) -> float:
        """Return the coefficient of restitution with ideal impulses at both ends of each column.

        Parameters
        ----------
        foot : {"left", "right"}
            The foot on which each column lands.

        Returns
        -------
        float
            Angular velocity after the impact / angular velocity before the impact [-].
        """
        new, height = self.beam_point(foot)
        old, _ = self.beam_point(opposite(foot))
        kept = self.beam_mass * (height**2 - old * new)
        for item in self._items:
            levers = self._lever(item, opposite(foot)) * self._lever(item, foot)
            kept += item.moments.polar + item.moments.mass * (item.moments.y**2 - levers)
        return float(kept / self.side(foot).moment_of_inertia)  # Eq. 371

    def _lever(self, item: _Column, foot: Foot) -> float:
        return item.centre if foot == "left" else item.base - item.centre

    def mirrored(self) -> "Frame":
        """Return the frame with left and right exchanged."""
        return Frame([column.mirrored() for column in self.columns], self.beam_mass, beam_on=self.beam_on)

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Frame":
        columns = [column.scaled(size=size, density=density) for column in self.columns]
        return Frame(columns, self.beam_mass * density * size**3, beam_on=self.beam_on)

    def with_feet(self, left: float, right: float) -> NoReturn:
        """Raise an error: the feet belong to the columns."""
        raise InvalidValueError("A frame has the feet of its columns. Set the feet of each column.")

    @property
    def assumed(self) -> tuple[str, ...]:
        """Assumed values of the columns, as texts."""
        return tuple(dict.fromkeys(text for column in self.columns for text in column.assumed))

    def answer(self, gravity: float = conventions.g) -> Answer:
        """Return the results of the equivalent body, with the beam.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Answer
            Results of a body, the number of columns, the mass and the support of the beam.
        """
        return super().answer(gravity) | {
            "column_count": len(self.columns), "beam_mass": self.beam_mass, "beam_on": self.beam_on,
        }  # fmt: skip


def section_of(body: Body) -> Body:
    """Return the section for a picture of a body: of a block itself, or of the first column of a frame."""
    shown = body.columns[0] if isinstance(body, Frame) else body
    return shown.to_section() if isinstance(shown, Block) else shown


def is_frame(body: Any) -> bool:
    """Return True for a frame, without or with restraints."""
    return isinstance(getattr(body, "body", body), Frame)


def refuse_frame(body: Any) -> Any:
    """Return a body, or raise an error if the body is a frame."""
    if is_frame(body):
        raise InvalidValueError("This analysis does not support frames. It needs a single body.", parameter="body")
    return body


def _column(column: Body) -> _Column:
    """Return the geometry of a column."""
    (left, right), moments = column.local_feet, column.local_moments
    low, high = top_edge(column)
    return _Column(moments, moments.x - left, right - left, (low - left, high - left, column.local_box[3]))
