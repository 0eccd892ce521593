"""What rocks: blocks, sections of any shape, mass points, solids."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.bodies import shapes as shapes
    from rocking.bodies import solid as solid
    from rocking.bodies.block import Block as Block
    from rocking.bodies.body import Body as Body
    from rocking.bodies.body import Side as Side
    from rocking.bodies.mass_points import MassPoints as MassPoints
    from rocking.bodies.region import Region as Region
    from rocking.bodies.section import Section as Section
    from rocking.bodies.solid import Part as Part
    from rocking.bodies.solid import Solid as Solid
else:
    __all__, __getattr__, __dir__ = exports(__name__)
