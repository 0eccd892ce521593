"""An object of an inventory: its measured sizes, and its plane body in each direction."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from rocking import checks, portable
from rocking.bodies import Block, Body, MassPoints, Solid
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.solid import Part, box, cylinder, frustum
from rocking.conventions import g
from rocking.dynamics.settings import NEVER_SLIDES
from rocking.errors import InvalidValueError
from rocking.messages import Amount, Message

Direction = Literal["width", "depth"]

DIRECTIONS: tuple[Direction, Direction] = ("width", "depth")
"""The two horizontal directions in which an object may rock."""

SIZES = ("width", "depth", "height")
LENGTHS = (*SIZES, "base_width", "base_depth", "centre_of_mass_height")
"""Fields of an object that are lengths; the first three are its outer size."""

SMALLEST, LARGEST = 0.001, 100.0
"""Allowed lengths [m]."""

LIGHTEST, DENSEST = 1.0, 23000.0
"""Allowed ratio of mass to volume of the enclosing box [kg/m3]: from air to the densest metal."""

# numbers of mass points of a round body: across, and over the height of either half. Error of KED's integral: 1e-5
_CHORDS, _LEVELS = 32, 16


@dataclass(frozen=True, kw_only=True)
class InventoryObject:
    """A free-standing rigid object on level ground.

    In each direction the object is a rectangle of its outer size, or a cylinder if it is round. If the base is smaller
    than the body, the feet lie inside. For a known height of the centre of mass, the masses below and above this
    centre are each uniform, and their ratio follows from the height. The weight does not affect rocking.

    Parameters
    ----------
    name : str
        Name of the object.
    width, depth, height : float
        Outer size [m].
    mass : float, optional
        Mass [kg].
    base_width, base_depth : float, optional
        Size of the base on the floor, at most that of the body [m].
    centre_of_mass_height : float, optional
        Height of the centre of mass above the floor; default: half the height [m].
    count : int
        Number of equal pieces [-].
    note : str
        Note of the list.
    row : int
        Line of the object in the file, 0 for none [-].
    friction : float, optional
        Coefficient of friction between object and ground; with this value the object moves in three dimensions [-].
    solid : Solid, optional
        3D body in its pose, which defines the size. This body moves in three dimensions, and does not slide without a
        coefficient of friction.
    shape : {"box", "round"}
        Outline from above; a round one is a circle or an ellipse with width and depth as axes.
    consequence : {"low", "medium", "high"}
        Consequence of a fall.
    photo : Path, optional
        Path of a picture.
    approximate : mapping of str to float, optional
        Half width of the interval of approximate sizes, by the name of the field [m].
    remarks : tuple of str or Message
        Assumptions and ignored values, one sentence each.
    number : str
        Inventory number, may be empty.

    Raises
    ------
    InvalidValueError
        If a value is outside its range; the message names the field.

    Examples
    --------
    >>> vase = InventoryObject(name="tall vase", width=0.2, depth=0.2, height=1.0)
    >>> round(vase.uplift_acceleration("width"), 5)
    1.96133
    """

    name: str
    width: float
    depth: float
    height: float
    mass: float | None = None
    base_width: float | None = None
    base_depth: float | None = None
    centre_of_mass_height: float | None = None
    count: int = 1
    note: str = ""
    row: int = 0
    friction: float | None = None
    solid: Solid | None = None
    shape: Literal["box", "round"] = "box"
    consequence: Literal["low", "medium", "high"] = "medium"
    photo: Path | None = None
    approximate: Mapping[str, float] = field(default_factory=dict)
    remarks: tuple[str | Message, ...] = ()
    number: str = ""

    def __post_init__(self) -> None:
        word: object = self.name
        if not isinstance(word, str) or not word.strip():
            raise InvalidValueError("name must not be empty")
        for name in SIZES:
            object.__setattr__(self, name, _length(name, getattr(self, name)))
        for name, most in (("base_width", self.width), ("base_depth", self.depth)):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, self._base(name, value, most))
        if self.centre_of_mass_height is not None:
            centre = _length("centre_of_mass_height", self.centre_of_mass_height)
            if not centre < self.height:
                raise InvalidValueError(
                    "centre_of_mass_height must be below the height of the body, {height}, got {centre}",
                    height=Amount(self.height, "m"),
                    centre=Amount(centre, "m"),
                )
            object.__setattr__(self, "centre_of_mass_height", centre)
        if self.mass is not None:
            object.__setattr__(self, "mass", self._checked_mass(self.mass))
        if self.friction:
            checks.within("friction", self.friction, 0.0, NEVER_SLIDES)
        for name, allowed in (("shape", ("box", "round")), ("consequence", ("low", "medium", "high"))):
            checks.one_of(name, getattr(self, name), allowed)
        object.__setattr__(self, "count", checks.whole("count", self.count, 1, 1_000_000))

    @property
    def label(self) -> str:
        """Inventory number and name."""
        return labelled(self.number, self.name)

    def base(self, direction: Direction) -> float:
        """Return the size of the base in a direction.

        Parameters
        ----------
        direction : {"width", "depth"}
            The direction.

        Returns
        -------
        float
            Size of the base; default: that of the body [m].
        """
        size = self.base_width if direction == "width" else self.base_depth
        return self._size(direction) if size is None else size

    def uplift_acceleration(self, direction: Direction, gravity: float = g) -> float:
        """Return the ground acceleration of uplift, ``g b / h``, with half the base ``b``.

        Parameters
        ----------
        direction : {"width", "depth"}
            The direction.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        float
            The acceleration [m/s2].
        """
        height = 0.5 * self.height if self.centre_of_mass_height is None else self.centre_of_mass_height
        return gravity * 0.5 * self.base(direction) / height

    def body(self, direction: Direction) -> Body:
        """Return the plane body that rocks in a direction.

        Parameters
        ----------
        direction : {"width", "depth"}
            The direction.

        Returns
        -------
        Body
            A `Block`, a `Section` if the base is smaller, or the `MassPoints` of a cylinder if the object is round.
        """
        if self.shape == "round":
            return self._cylinder(self._size(direction), self.base(direction))
        size, across = self._size(direction), self._size("depth" if direction == "width" else "width")
        base, height = self.base(direction), self.centre_of_mass_height
        centre = None if height is None else (0.5 * size, height)
        body = Block(width=size, height=self.height, depth=across, mass=self.mass, centre=centre)
        return body if base == size else body.with_feet(0.5 * (size - base), 0.5 * (size + base))

    def as_solid(self) -> Solid:
        """Return the 3D body with its width along x and its depth along y.

        Returns
        -------
        Solid
            The solid of the object, or a box or cylinder with uniform masses below and above the centre of mass; a
            round body narrows to a smaller base at 45 degrees.

        Raises
        ------
        InvalidValueError
            If the object has a smaller base and is not round, or is an ellipse: the shape is unknown.
        """
        if self.solid is not None:
            return self.solid
        if self.shape == "round" and self.base("width") == self.base("depth") and self.width == self.depth:
            return self._turned()
        if self.shape == "round" or any(self.base(way) < self._size(way) for way in DIRECTIONS):
            raise InvalidValueError(
                "With friction the object moves in three dimensions, but its shape above the smaller base is "
                "unknown. Remove the base, or add a body file of the object."
            )
        height = self.height
        middle = 0.5 * height if self.centre_of_mass_height is None else self.centre_of_mass_height
        heights, densities = (middle, height - middle), ((height - middle) ** 2, middle**2)
        low, high = (
            Part(box(self.width, self.depth, tall), 1000.0 * density / max(densities))
            for tall, density in zip(heights, densities, strict=True)
        )
        return Solid([low, high.moved(0.0, 0.0, middle)])

    def _turned(self) -> Solid:
        """Return a cylinder that narrows to its base at 45 degrees, below half the height of its centre of mass."""
        (middle, above), _ = self._halves()
        flare = min(0.5 * (self.width - self.base("width")), 0.5 * middle)
        low = [Part(cylinder(self.width, middle - flare)).moved(0.0, 0.0, flare)]
        if flare > 0.0:
            low.append(Part(frustum(self.base("width"), self.width, flare)))
        below = Solid(low)
        # densities of both halves for which the common centre of mass is at the middle
        dense = 0.5 * above / (below.mass / DEFAULT_DENSITY)
        light = (middle - below.centre[2]) / (0.25 * math.pi * self.width**2 * above)
        most = max(dense, light)
        low = [Part(part.shape, 1000.0 * dense / most).moved(*part.translation) for part in low]
        return Solid([*low, Part(cylinder(self.width, above), 1000.0 * light / most).moved(0.0, 0.0, middle)])

    def _halves(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the heights below and above the centre of mass, and the mass fractions of both."""
        middle = 0.5 * self.height if self.centre_of_mass_height is None else self.centre_of_mass_height
        above = self.height - middle
        return (middle, above), (above / self.height, middle / self.height)

    def _cylinder(self, size: float, base: float) -> MassPoints:
        """Return the mass points of a cylinder in side view, with its exact second moments.

        The chords of an ellipse have the same proportions as the chords of a circle.
        """
        turns = math.pi * np.arange(1, _CHORDS + 1) / (_CHORDS + 1)
        # Gauss-Chebyshev rule of the second kind, because chords are proportional to sqrt(1 - x^2)
        across, chords = portable.each(math.cos, turns), np.square(portable.each(math.sin, turns))
        nodes, weights = portable.gauss_legendre(_LEVELS)
        heights, masses = self._halves()
        levels = np.concatenate([0.5 * heights[0] * (1.0 + nodes), heights[0] + 0.5 * heights[1] * (1.0 + nodes)])
        shares = 0.5 * np.concatenate([masses[0] * weights, masses[1] * weights])
        volume = 0.25 * math.pi * self.width * self.depth * self.height
        mass = DEFAULT_DENSITY * volume if self.mass is None else self.mass
        x, y = (grid.ravel() for grid in np.meshgrid(0.5 * size * across, levels))
        points = mass * np.outer(shares, chords / chords.sum()).ravel()
        return MassPoints(np.column_stack([x, y]), points, (-0.5 * base, 0.5 * base))

    def _size(self, direction: Direction) -> float:
        return self.width if direction == "width" else self.depth

    @staticmethod
    def _base(name: str, value: float, most: float) -> float:
        size = _length(name, value)
        if size > most * (1.0 + 1e-9):
            raise InvalidValueError(
                "{parameter} must be at most the {side} of the body, {most}, got {size}; "
                "measure an object on a wider plinth together with the plinth",
                parameter=name,
                value=size,
                side=Message(name.removeprefix("base_")),
                most=Amount(most, "m"),
                size=Amount(size, "m"),
            )
        return most if size > most * (1.0 - 1e-9) else size

    def _checked_mass(self, value: float) -> float:
        mass = checks.positive("weight", value, "kg")
        density = mass / (self.width * self.depth * self.height)
        if not LIGHTEST <= density <= DENSEST:
            raise InvalidValueError(
                "The weight over the volume of the bounding box must be between {low} and {high}, got {mass}, that is "
                "{density}. Check the units of weight and lengths.",
                low=Amount(LIGHTEST),
                high=Amount(DENSEST, "kg/m3"),
                mass=Amount(mass, "kg"),
                density=Amount(density, "kg/m3", ".3g"),
            )
        return mass


@dataclass(frozen=True)
class NotAssessed:
    """A row without a verdict, or without an object."""

    row: int  # line of the file [-]
    name: str  # name of the object, or text of a row that is not an object; may be empty
    reason: str | Message  # reason, in one sentence
    number: str = ""  # inventory number, may be empty
    note: str = ""  # note of the list

    @property
    def label(self) -> str:
        """Inventory number and name."""
        return labelled(self.number, self.name)

    @classmethod
    def of(cls, item: InventoryObject, reason: str | Message) -> "NotAssessed":
        """Return an object as a row without a verdict."""
        return cls(item.row, item.name, reason, item.number, item.note)


def labelled(number: str, name: str) -> str:
    """Return inventory number and name, or only one of them if the other is missing or equal.

    >>> labelled("A-17", "Vase"), labelled("A-17", "A-17")
    ('A-17 Vase', 'A-17')
    """
    return " ".join(dict.fromkeys(filter(None, (number, name))))


def _length(name: str, value: float) -> float:
    return checks.within(name, value, SMALLEST, LARGEST, unit="m", hint="Check the unit of the column.")
