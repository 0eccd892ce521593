"""One object of an inventory: what a tape measure says, and the two plane bodies that it stands for."""

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
"""Allowed mass over the volume of the enclosing box [kg/m3]: from air to the densest metal."""

# mass points of a round body across and up either half: KED's integral is within 1e-5 of the limit
_CHORDS, _LEVELS = 32, 16


@dataclass(frozen=True, kw_only=True)
class InventoryObject:
    """A rigid object that stands freely on level ground.

    In either direction it is a rectangle of its outer size, or a cylinder if it is round. If the base is smaller than
    the body, the feet stand inside. If the height of the centre of mass is known, the mass below it and the mass above
    it are each spread evenly, in the one ratio that puts the centre there. The weight does not change how it rocks.

    Parameters
    ----------
    name : str
        What it is called.
    width, depth, height : float
        Outer size [m].
    mass : float, optional
        Its mass [kg].
    base_width, base_depth : float, optional
        Size of the base that stands on the floor, at most that of the body [m].
    centre_of_mass_height : float, optional
        Height of the centre of mass above the floor; half the height if not given [m].
    count : int
        How many alike [-].
    note : str
        Anything.
    row : int
        Line of the file that it comes from, 0 for none [-].
    friction : float, optional
        Coefficient of friction between it and the ground, with which it moves in three dimensions [-].
    solid : Solid, optional
        The body itself, standing as it does, where more is known than its size, which it then gives: it moves in three
        dimensions, and without friction it does not slide.
    shape : {"box", "round"}
        Of its outline from above; a round one is a circle or an ellipse with its width and depth as axes.
    consequence : {"low", "medium", "high"}
        How bad it is if it falls.
    photo : Path, optional
        Where a picture of it is.
    approximate : mapping of str to float, optional
        Half the width of the interval of a size that is not known well, by the name of the field [m].
    remarks : tuple of str or Message
        What was assumed of it, or left aside, in one sentence each.
    number : str
        Its inventory number, possibly nothing.

    Raises
    ------
    InvalidValueError
        If a value is outside its range; it names what was measured.

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
        for name, words in (("shape", ("box", "round")), ("consequence", ("low", "medium", "high"))):
            checks.one_of(name, getattr(self, name), words)
        object.__setattr__(self, "count", checks.whole("count", self.count, 1, 1_000_000))

    @property
    def label(self) -> str:
        """Its inventory number and its name, which tell it from others of the same name."""
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
            That of the body if no other was given [m].
        """
        size = self.base_width if direction == "width" else self.base_depth
        return self._size(direction) if size is None else size

    def uplift_acceleration(self, direction: Direction, gravity: float = g) -> float:
        """Return the ground acceleration ``g b / h`` below which the object stays still, with half the base.

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
            A `Block`, or a `Section` if the base says otherwise; of a round object the `MassPoints` of a cylinder.
        """
        if self.shape == "round":
            return self._cylinder(self._size(direction), self.base(direction))
        size, across = self._size(direction), self._size("depth" if direction == "width" else "width")
        base, height = self.base(direction), self.centre_of_mass_height
        centre = None if height is None else (0.5 * size, height)
        body = Block(width=size, height=self.height, depth=across, mass=self.mass, centre=centre)
        return body if base == size else body.with_feet(0.5 * (size - base), 0.5 * (size + base))

    def as_solid(self) -> Solid:
        """Return the body in three dimensions, along x its width and along y its depth.

        Returns
        -------
        Solid
            The one given, or a box or cylinder, of which the mass below and above the centre is spread evenly; a round
            one narrows to a smaller base at 45 degrees.

        Raises
        ------
        InvalidValueError
            If its base is smaller than itself and not round as it is, or it is an ellipse: the shape must be known.
        """
        if self.solid is not None:
            return self.solid
        if self.shape == "round" and self.base("width") == self.base("depth") and self.width == self.depth:
            return self._turned()
        if self.shape == "round" or any(self.base(way) < self._size(way) for way in DIRECTIONS):
            raise InvalidValueError(
                "with friction it moves in three dimensions, and its shape above a smaller base is not known: leave "
                "the base out, or name its body file"
            )
        height = self.height
        middle = 0.5 * height if self.centre_of_mass_height is None else self.centre_of_mass_height
        heights, densities = (middle, height - middle), ((height - middle) ** 2, middle**2)
        low, high = (
            Part(box(self.width, self.depth, tall), 1000.0 * each / max(densities))
            for tall, each in zip(heights, densities, strict=True)
        )
        return Solid([low, high.moved(0.0, 0.0, middle)])

    def _turned(self) -> Solid:
        """Return a cylinder that narrows to its base at 45 degrees, below half the height of its centre."""
        (middle, above), _ = self._halves()
        flare = min(0.5 * (self.width - self.base("width")), 0.5 * middle)
        low = [Part(cylinder(self.width, middle - flare)).moved(0.0, 0.0, flare)]
        if flare > 0.0:
            low.append(Part(frustum(self.base("width"), self.width, flare)))
        below = Solid(low)
        # the masses that put the common centre at the middle, over the volumes
        dense = 0.5 * above / (below.mass / DEFAULT_DENSITY)
        light = (middle - below.centre[2]) / (0.25 * math.pi * self.width**2 * above)
        most = max(dense, light)
        low = [Part(each.shape, 1000.0 * dense / most).moved(*each.translation) for each in low]
        return Solid([*low, Part(cylinder(self.width, above), 1000.0 * light / most).moved(0.0, 0.0, middle)])

    def _halves(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the heights below and above the centre, and shares of the mass there that put it there."""
        middle = 0.5 * self.height if self.centre_of_mass_height is None else self.centre_of_mass_height
        above = self.height - middle
        return (middle, above), (above / self.height, middle / self.height)

    def _cylinder(self, size: float, base: float) -> MassPoints:
        """Return the mass points of a cylinder seen from the side: their second moments are its own, exactly.

        The chords of an ellipse are in the same proportions as those of a circle.
        """
        turns = math.pi * np.arange(1, _CHORDS + 1) / (_CHORDS + 1)
        # Gauss-Chebyshev of the second kind: chords are in proportion to sqrt(1 - x^2)
        across, chords = portable.each(math.cos, turns), np.square(portable.each(math.sin, turns))
        nodes, weights = portable.gauss_legendre(_LEVELS)
        heights, masses = self._halves()
        levels = np.concatenate([0.5 * heights[0] * (1.0 + nodes), heights[0] + 0.5 * heights[1] * (1.0 + nodes)])
        shares = 0.5 * np.concatenate([masses[0] * weights, masses[1] * weights])
        volume = 0.25 * math.pi * self.width * self.depth * self.height
        mass = DEFAULT_DENSITY * volume if self.mass is None else self.mass
        x, y = (each.ravel() for each in np.meshgrid(0.5 * size * across, levels))
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
                "an object fixed to a wider plinth is measured together with it",
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
                "weight must give between {low} and {high} over the box of the object, got {mass}, that is {density}; "
                "wrong unit of the weight or of a length?",
                low=Amount(LIGHTEST),
                high=Amount(DENSEST, "kg/m3"),
                mass=Amount(mass, "kg"),
                density=Amount(density, "kg/m3", ".3g"),
            )
        return mass


@dataclass(frozen=True)
class NotAssessed:
    """A row that could not be assessed, or is no object."""

    row: int  # line of the file [-]
    name: str  # what the row says the object is called, possibly nothing; all that it says where it is no object
    reason: str | Message  # why not, in one sentence
    number: str = ""  # its inventory number, possibly nothing
    note: str = ""  # what the list notes about it

    @property
    def label(self) -> str:
        """Its inventory number and its name."""
        return labelled(self.number, self.name)

    @classmethod
    def of(cls, item: InventoryObject, reason: str | Message) -> "NotAssessed":
        """Return an object as one that could not be assessed."""
        return cls(item.row, item.name, reason, item.number, item.note)


def labelled(number: str, name: str) -> str:
    """Return an inventory number and a name; one of them where the other is missing or the same.

    >>> labelled("A-17", "Vase"), labelled("A-17", "A-17")
    ('A-17 Vase', 'A-17')
    """
    return " ".join(dict.fromkeys(filter(None, (number, name))))


def _length(name: str, value: float) -> float:
    return checks.within(name, value, SMALLEST, LARGEST, unit="m", hint="wrong unit in the name of the column?")
