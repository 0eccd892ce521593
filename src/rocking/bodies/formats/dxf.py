"""Regions from DXF: closed polylines and circles; rings inside rings are holes."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.region import Region
from rocking.conventions import FloatArray
from rocking.errors import BodyFileError, MissingExtraError

_UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
_SAGITTA = 1e-4
"""Arcs become chords that stray this little from them, relative to the radius."""


def regions_from_dxf(path: Path, density: float = DEFAULT_DENSITY, *, units: str | None = None) -> list[Region]:
    """Return the regions that the closed polylines and circles of a DXF file enclose.

    Parameters
    ----------
    path : Path
        DXF file.
    density : float
        Density of all regions [kg/m3].
    units : str, optional
        Unit of the drawing; needed if the file states none, refused if it states another.

    Returns
    -------
    list of Region
        Outer rings with the rings directly inside them as holes [m].

    Raises
    ------
    MissingExtraError
        If ezdxf is not installed.
    BodyFileError
        If the file cannot be read, states no unit or another, or holds no closed ring.
    """
    try:
        from ezdxf.filemanagement import readfile
        from ezdxf.lldxf.const import DXFError
    except ImportError as error:
        raise MissingExtraError("DXF files need ezdxf: pip install 'rocking[dxf]'") from error
    try:
        drawing = readfile(path)
        entities = list(drawing.modelspace())
        stated = _UNITS.get(int(drawing.header.get("$INSUNITS", 0)))
    except (DXFError, OSError, ValueError, UnicodeDecodeError) as error:
        raise BodyFileError(f"{path.name}: not a DXF file that can be read: {error}") from error
    if stated and units and stated != units:
        raise BodyFileError(f"{path.name}: the drawing states {stated}, units={units!r} was given")
    if not (stated or units):
        raise BodyFileError(f"{path.name}: the drawing states no unit; give units='mm' or another")
    scale = checks.length_unit(units or stated)
    rings = [ring * scale for ring in map(_ring, entities) if ring is not None]
    if not rings:
        raise BodyFileError(f"{path.name}: no closed polyline or circle in the drawing")
    return _nested(rings, density)


def _ring(entity: Any) -> FloatArray | None:
    kind = entity.dxftype()
    if kind == "CIRCLE":
        count = math.ceil(math.pi / math.acos(1.0 - _SAGITTA))
        angle = 2.0 * math.pi * np.arange(count) / count
        centre, radius = entity.dxf.center, float(entity.dxf.radius)
        return np.column_stack([centre.x + radius * np.cos(angle), centre.y + radius * np.sin(angle)])
    if kind not in ("LWPOLYLINE", "POLYLINE") or not entity.is_closed:
        return None
    from ezdxf.path import make_path

    path = make_path(entity)
    low, high = path.control_vertices()[0], path.control_vertices()[0]
    size = max((abs(v.x - low.x) + abs(v.y - high.y) for v in path.control_vertices()), default=1.0)
    points = [(v.x, v.y) for v in path.flattening(_SAGITTA * max(size, 1e-12))]
    return np.array(points, dtype=np.float64)


def _nested(rings: list[FloatArray], density: float) -> list[Region]:
    import shapely

    shapes = [shapely.Polygon(ring) for ring in rings]
    depth = [
        sum(i != j and other.contains(inner.representative_point()) for j, other in enumerate(shapes))
        for i, inner in enumerate(shapes)
    ]
    regions = []
    for i, outer in enumerate(shapes):
        if depth[i] % 2:
            continue
        holes = [
            rings[j]
            for j, inner in enumerate(shapes)
            if depth[j] == depth[i] + 1 and outer.contains(inner.representative_point())
        ]
        regions.append(Region(rings[i], density, holes))
    return regions
