"""3D bodies: parts of any shape and density on a base."""

from rocking.bodies.moments import SolidMoments as SolidMoments
from rocking.bodies.solid.base import Base as Base
from rocking.bodies.solid.base import Corner as Corner
from rocking.bodies.solid.base import Edge as Edge
from rocking.bodies.solid.base import RoundBase as RoundBase
from rocking.bodies.solid.base import SupportPolygon as SupportPolygon
from rocking.bodies.solid.base import hull as hull
from rocking.bodies.solid.part import Part, rotation_about
from rocking.bodies.solid.polyhedron import Polyhedron as Polyhedron
from rocking.bodies.solid.prism import Prism as Prism
from rocking.bodies.solid.prism import box, extrusion
from rocking.bodies.solid.solid import Solid
from rocking.bodies.solid.surfaces import Shape as Shape
from rocking.bodies.solid.turned import Turned as Turned
from rocking.bodies.solid.turned import cone, cylinder, ellipsoid, frustum, revolution, sphere_cap
from rocking.bodies.solid.units import Units, divided, voxels

__all__ = [
    "Part",
    "Solid",
    "Units",
    "box",
    "cone",
    "cylinder",
    "divided",
    "ellipsoid",
    "extrusion",
    "frustum",
    "revolution",
    "rotation_about",
    "sphere_cap",
    "voxels",
]
