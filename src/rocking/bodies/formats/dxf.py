"""DXF drawings through ezdxf: closed polylines, circles and ellipses of the model space.

Texts, dimensions, hatches and points are ignored. Any other entity on a selected layer is an error.
"""

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.formats.words import Placement, check_count, checked_file, suggestion, unit_to_state
from rocking.bodies.region import Region, nested
from rocking.bodies.section import Section
from rocking.conventions import LENGTH_UNITS, FloatArray
from rocking.errors import BodyFileError, MissingExtraError, how_to_install, located

if TYPE_CHECKING:
    from ezdxf.document import Drawing


INSUNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
"""Units by code of the header variable $INSUNITS (DXF reference, HEADER section)."""

RELATIVE_CHORD = 1e-5  # default chord tolerance / larger dimension of the curve [-]
_TEXTS = ("TEXT", "MTEXT", "ATTDEF", "LEADER", "MULTILEADER", "MLEADER", "TOLERANCE", "ACAD_TABLE")
_DIMENSIONS = ("DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION")
_IGNORED = frozenset((*_TEXTS, *_DIMENSIONS, "POINT", "HATCH", "VIEWPORT", "RAY", "XLINE", "IMAGE", "WIPEOUT"))
_Curve = tuple[str, str, FloatArray]


def section_from_dxf(
    path: str | Path,
    density: float = DEFAULT_DENSITY,
    *,
    units: str | None = None,
    layers: Mapping[str, float] | None = None,
    chord_tolerance: float | None = None,
    **placement: Unpack[Placement],
) -> Section:
    """Return the section from a DXF drawing.

    Parameters
    ----------
    path : str or Path
        DXF file.
    density : float
        Density without `layers` [kg/m3].
    units : {"m", "cm", "mm", "ft", "in"}, optional
        Unit of the drawing, required for a file without $INSUNITS, otherwise equal to the unit in the file.
    layers : mapping of str to float, optional
        Densities by name of the selected layers [kg/m3]; the default is all layers with `density`.
    chord_tolerance : float, optional
        Largest distance between an arc and its chords [m]; the default is 1e-5 x size of the curve.
    **placement
        ``feet`` [m], ``depth`` [m] and ``ground`` [m], as for `Section`; always in m.

    Returns
    -------
    Section
        The body.

    Raises
    ------
    BodyFileError
        If the file is not a DXF drawing of closed curves, or its unit is unknown or different from `units`.
    GeometryError
        If the curves do not describe a body.
    InvalidValueError
        If a density, the unit or the tolerance is invalid.
    MissingExtraError
        If ezdxf is not installed.

    Notes
    -----
    Rings inside other rings are holes (even-odd rule). The rule applies to all rings together, or within each layer if
    `layers` is given. An inlay is therefore a hole on one layer and an outline on another layer.
    """
    regions = regions_from_dxf(path, density, units=units, layers=layers, chord_tolerance=chord_tolerance)
    with located(Path(path).name, "file"):
        return Section(regions, **placement)


def regions_from_dxf(
    path: str | Path,
    density: float = DEFAULT_DENSITY,
    *,
    units: str | None = None,
    layers: Mapping[str, float] | None = None,
    chord_tolerance: float | None = None,
) -> list[Region]:
    """Return the polygons of a DXF drawing, by layer, in the order of the drawing."""
    path = Path(path)
    with located(path.name, "file"):
        drawing = _opened(path)
        scale = LENGTH_UNITS[_unit(drawing, units)]
        if chord_tolerance is not None:
            chord_tolerance = checks.length("chord_tolerance", chord_tolerance) / scale
        groups: dict[str | None, list[_Curve]] = {} if layers is None else {layer: [] for layer in layers}
        vertices = 0
        for name, layer, ring in _curves(drawing, layers, chord_tolerance):
            groups.setdefault(None if layers is None else layer, []).append((name, layer, ring * scale))
            vertices += len(ring)
            check_count(vertices)
        if not any(groups.values()):
            raise BodyFileError("The drawing contains no closed polyline, circle or ellipse.")
        return [region for layer, curves in groups.items() for region in _regions(layer, curves, density, layers)]


def _regions(
    layer: str | None, curves: list[_Curve], density: float, layers: Mapping[str, float] | None
) -> list[Region]:
    if not curves:
        raise BodyFileError("Layer {layer!r} contains no closed polyline, circle or ellipse.", layer=layer)
    value = density if layers is None or layer is None else checks.density(f"density of layer {layer!r}", layers[layer])
    return [Region(ring, value, holes) for ring, holes in nested([c[2] for c in curves], [c[0] for c in curves])]


def _opened(path: Path) -> "Drawing":
    try:
        from ezdxf.filemanagement import readfile
    except ImportError as error:
        raise MissingExtraError(how_to_install("reading DXF", "ezdxf", error)) from error
    try:
        return readfile(str(checked_file(path)))
    except BodyFileError:
        raise
    except OSError as error:
        raise BodyFileError("The file is not a DXF file.") from error
    except Exception as error:  # ezdxf raises any exception for a damaged file
        raise BodyFileError("The DXF file is damaged ({type}).", type=type(error).__name__) from error


def _unit(drawing: "Drawing", requested: str | None) -> str:
    if requested is not None:
        checks.length_unit(requested)
    code = drawing.header.get("$INSUNITS", 0)
    if code == 0:
        if requested is None:
            raise BodyFileError("The drawing states no unit ($INSUNITS is 0)", hint=unit_to_state())
        return requested
    if code not in INSUNITS:
        raise BodyFileError(
            "The unit of the drawing ($INSUNITS is {code}) must be one of {units}.",
            code=code,
            units=", ".join(LENGTH_UNITS),
        )
    stated = INSUNITS[code]
    if requested is not None and requested != stated:
        raise BodyFileError(
            'The unit of the drawing is {stated} ($INSUNITS is {code}), but units = "{units}". Remove units.',
            stated=stated, code=code, units=requested,
        )  # fmt: skip
    return stated


def _curves(drawing: "Drawing", layers: Mapping[str, float] | None, tolerance: float | None) -> Iterator[_Curve]:
    layer_names = {layer.dxf.name for layer in drawing.layers}
    entities = list(drawing.modelspace())
    layer_names |= {entity.dxf.layer for entity in entities}
    for layer in layers or ():
        if layer not in layer_names:
            raise BodyFileError("Unknown layer {layer!r}", layer=layer, hint=suggestion(layer, sorted(layer_names)))
    for entity in entities:
        layer, kind = entity.dxf.layer, entity.dxftype()
        if kind in _IGNORED or (layers is not None and layer not in layers):
            continue
        name = f"{kind} {entity.dxf.handle} on layer {layer!r}"
        if kind not in _READERS:
            raise BodyFileError(
                "{entity} is not a closed outline", entity=name, hint="join it into a closed polyline, or select layers"
            )
        with located(name, "file"):
            try:
                yield name, layer, _READERS[kind](entity, tolerance)
            except (ArithmeticError, AttributeError, LookupError, TypeError) as error:
                raise BodyFileError("The entity is damaged ({type}).", type=type(error).__name__) from error


def _circle(entity: Any, tolerance: float | None) -> FloatArray:
    radius = checks.positive("radius", entity.dxf.radius)
    _check_plane(entity)
    centre = _flat(entity.ocs().to_wcs(entity.dxf.center))
    return closed_ellipse(centre, complex(radius), 1j * radius, tolerance or RELATIVE_CHORD * 2.0 * radius)


def _ellipse(entity: Any, tolerance: float | None) -> FloatArray:
    _check_plane(entity)
    if abs(abs(entity.dxf.end_param - entity.dxf.start_param) - 2.0 * math.pi) > 1e-9:
        raise BodyFileError("The ellipse is an open arc. Close it.")
    major = _flat(entity.dxf.major_axis)
    ratio = checks.within("ratio of the axes", abs(entity.dxf.ratio), 0.0, 1.0, open_low=True)
    size = checks.positive("major axis", abs(major))
    return closed_ellipse(_flat(entity.dxf.center), major, 1j * major * ratio, tolerance or RELATIVE_CHORD * 2.0 * size)


def _lwpolyline(entity: Any, tolerance: float | None) -> FloatArray:
    vertices = [(complex(x, y), bulge) for x, y, bulge in entity.get_points("xyb")]
    return _polyline(entity, vertices, bool(entity.closed), tolerance)


def _old_polyline(entity: Any, tolerance: float | None) -> FloatArray:
    if entity.get_mode() not in {"AcDb2dPolyline", "AcDb3dPolyline"}:
        raise BodyFileError("The entity is a mesh. Use a closed polyline.")
    if entity.dxf.flags & 6:  # bits for fitted curves and fitted splines
        raise BodyFileError("The polyline is a fitted curve. Explode it into arcs.")
    vertices = [(_flat(v.dxf.location), float(v.dxf.bulge)) for v in entity.vertices]
    return _polyline(entity, vertices, bool(entity.is_closed), tolerance)


def _polyline(entity: Any, vertices: list[tuple[complex, float]], closed: bool, tolerance: float | None) -> FloatArray:
    if len(vertices) < 2:
        raise BodyFileError("The polyline has fewer than two vertices.")
    if not closed and vertices[0][0] == vertices[-1][0]:
        closed, vertices = True, vertices[:-1]
    if not closed:
        raise BodyFileError("The polyline is open. Close it.")
    points = [point for point, _ in vertices]
    x, y = [p.real for p in points], [p.imag for p in points]
    size = max(max(x) - min(x), max(y) - min(y))
    if not (math.isfinite(size) and size > 0.0):
        raise BodyFileError("The vertices must be finite and different.")
    ring = closed_polyline(points, [bulge for _, bulge in vertices], tolerance or RELATIVE_CHORD * size)
    if _check_plane(entity) < 0.0:  # the object coordinates are mirrored (DXF reference, OCS)
        ring[:, 0] *= -1.0
    return ring


def _check_plane(entity: Any) -> float:
    normal = entity.dxf.extrusion
    if not (abs(normal.x) <= 1e-9 and abs(normal.y) <= 1e-9 and normal.z != 0.0):
        raise BodyFileError("The entity must lie in the x-y plane.")
    return float(normal.z)


def _flat(point: Any) -> complex:
    x, y = checks.number("x", point.x), checks.number("y", point.y)
    return complex(x, y)


_READERS = {"CIRCLE": _circle, "ELLIPSE": _ellipse, "LWPOLYLINE": _lwpolyline, "POLYLINE": _old_polyline}


FINEST = 1e-9  # smallest chord tolerance / radius, which limits the number of vertices
_LARGEST_BULGE = 1000.0


def sides(angle: float, radius: float, tolerance: float) -> int:
    """Return the number of chords of an arc.

    >>> sides(2.0 * math.pi, 1.0, 1e-3)
    71
    """
    if not (math.isfinite(radius) and tolerance >= FINEST * radius):
        raise BodyFileError(
            "A chord tolerance of {tolerance:g} is too small for a radius of {radius:g}.", tolerance=tolerance,
            radius=radius,
        )  # fmt: skip
    step = 2.0 * math.acos(max(1.0 - tolerance / radius, -0.5))
    return max(1, math.ceil(abs(angle) / step))


def closed_ellipse(centre: complex, major: complex, minor: complex, tolerance: float) -> FloatArray:
    """Return a full ellipse as an inscribed polygon of 4 k sides, which has the symmetry of the ellipse."""
    # the chord errors of an ellipse are not larger than those of the circle with its major axis
    count = 4 * math.ceil(sides(2.0 * math.pi, abs(major), tolerance) / 4)
    angle = 2.0 * math.pi * np.arange(count) / count
    points = centre + major * np.cos(angle) + minor * np.sin(angle)
    return np.column_stack([points.real, points.imag])


def closed_polyline(points: Sequence[complex], bulges: Sequence[float], tolerance: float) -> FloatArray:
    """Return the vertices of a closed polyline with arcs replaced by chords."""
    # bulges: tan(angle of the arc from each vertex / 4), > 0 for counter-clockwise arcs [-]
    flattened: list[complex] = []
    for i, (start, bulge) in enumerate(zip(points, bulges, strict=True)):
        end = points[(i + 1) % len(points)]
        flattened.append(start)
        if not abs(bulge) <= _LARGEST_BULGE:
            raise BodyFileError(
                "The bulge at vertex {vertex} must be from -{limit:g} to {limit:g}, got {bulge:g}.", vertex=i,
                limit=_LARGEST_BULGE, bulge=bulge,
            )  # fmt: skip
        if 0.5 * abs(bulge) * abs(end - start) > tolerance:  # rise of the arc above its chord
            flattened += _arc(start, end, bulge, tolerance)
        check_count(len(flattened))
    z = np.array(flattened)
    return np.column_stack([z.real, z.imag])


def _arc(start: complex, end: complex, bulge: float, tolerance: float) -> list[complex]:
    chord = end - start
    centre = 0.5 * (start + end) + 0.5j * chord * (1.0 - bulge * bulge) / (2.0 * bulge)
    angle = 4.0 * math.atan(bulge)
    count = sides(angle, abs(start - centre), tolerance)
    return [centre + (start - centre) * cmath.exp(1j * angle * k / count) for k in range(1, count)]
