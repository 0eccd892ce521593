"""Reading and writing of bodies: TOML body files, WKT, GeoJSON, DXF, and meshes of 3D bodies.

These modules import pydantic, shapely, ezdxf and trimesh only to read a body.
"""

from rocking.bodies.formats.body_file import body_from_toml, body_to_toml
from rocking.bodies.formats.dxf import section_from_dxf
from rocking.bodies.formats.geojson import section_from_geojson
from rocking.bodies.formats.reader import FORMATS, describes_solid, read_body, read_plane_body
from rocking.bodies.formats.solid_file import solid_from_toml
from rocking.bodies.formats.wkt import section_from_wkt

__all__ = [
    "FORMATS",
    "body_from_toml",
    "body_to_toml",
    "describes_solid",
    "read_body",
    "read_plane_body",
    "section_from_dxf",
    "section_from_geojson",
    "section_from_wkt",
    "solid_from_toml",
]
