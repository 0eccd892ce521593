"""Bodies from files: TOML body files and drawings in WKT, GeoJSON and DXF."""

from rocking.bodies.formats.body_file import body_from_toml, read_body
from rocking.bodies.formats.dxf import regions_from_dxf
from rocking.bodies.formats.geojson import regions_from_geojson
from rocking.bodies.formats.wkt import regions_from_wkt

__all__ = ["body_from_toml", "read_body", "regions_from_dxf", "regions_from_geojson", "regions_from_wkt"]
