"""What rocks: blocks, sections of any shape, mass points, solids."""

from typing import TYPE_CHECKING

from rocking.bodies import shapes
from rocking.bodies.block import Block
from rocking.bodies.body import Body, Side
from rocking.bodies.mass_points import MassPoints
from rocking.bodies.region import Region
from rocking.bodies.section import Section
from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.bodies import solid
    from rocking.bodies.solid import Part, Solid

__all__ = ["Block", "Body", "MassPoints", "Part", "Region", "Section", "Side", "Solid", "shapes", "solid"]

__getattr__, __dir__ = exports(
    "rocking.bodies",
    {"Part": "rocking.bodies.solid", "Solid": "rocking.bodies.solid", "solid": "rocking.bodies.solid"},
)
