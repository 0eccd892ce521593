"""Bodies in space: parts of any shape and density on a base."""

from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid.base import Base, Corner, Edge, RoundBase, SupportPolygon, hull
from rocking.bodies.solid.part import Part, rotation_about
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.prism import Box, Prism, box, extrusion
from rocking.bodies.solid.shape import Shape
from rocking.bodies.solid.solid import Solid
from rocking.bodies.solid.turned import Turned, cone, cylinder, ellipsoid, frustum, revolution, sphere_cap
from rocking.bodies.solid.units import Units, divided, voxels

__all__ = [
    "Base",
    "Box",
    "Corner",
    "Edge",
    "Part",
    "Polyhedron",
    "Prism",
    "RoundBase",
    "Shape",
    "Solid",
    "SolidMoments",
    "SupportPolygon",
    "Turned",
    "Units",
    "box",
    "cone",
    "cylinder",
    "divided",
    "ellipsoid",
    "extrusion",
    "frustum",
    "hull",
    "revolution",
    "rotation_about",
    "sphere_cap",
    "voxels",
]
