"""What rocks: blocks, sections of any shape, mass points."""

from rocking.bodies import shapes
from rocking.bodies.block import Block
from rocking.bodies.body import Body
from rocking.bodies.mass_points import MassPoints
from rocking.bodies.region import Region
from rocking.bodies.section import Section
from rocking.bodies.side import Side

__all__ = ["Block", "Body", "MassPoints", "Region", "Section", "Side", "shapes"]
