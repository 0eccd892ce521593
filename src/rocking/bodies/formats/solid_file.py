"""A 3D body from the text of a TOML file, with parts of simple shapes and of meshes."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.formats.body_file import beside, parsed_toml
from rocking.bodies.formats.mesh import mesh_from_file
from rocking.bodies.formats.words import check_count, validated
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.prism import box, extrusion
from rocking.bodies.solid.solid import Solid
from rocking.bodies.solid.surfaces import Shape
from rocking.bodies.solid.turned import cone, cylinder, ellipsoid, frustum, revolution
from rocking.checks import length_unit
from rocking.errors import BodyFileError, located
from rocking.messages import Message

if TYPE_CHECKING:
    from rocking.bodies.formats import schema

_FARTHEST = 1e8


def solid_from_toml(text: str, name: str = "<text>", folder: str | Path | None = None) -> Solid:
    r"""Return the 3D body from the text of a file.

    A part has one shape (box, cylinder, cone, frustum, sphere, ellipsoid, extrusion, revolution, mesh) and a density
    [kg/m3]. It is rotated about axes through the origin in the given order, and then moved to `at`. The default ground
    is the lowest point.

    Parameters
    ----------
    text : str
        TOML.
    name : str
        Name of the text in error messages.
    folder : str or Path, optional
        Folder of the meshes that the text names. By default, the text must not name files.

    Returns
    -------
    Solid
        Body with its `name`, and with the `repairs` of its meshes.

    Raises
    ------
    BodyFileError
        If the text is not TOML, a key is unknown or missing, or a value has a wrong type or is outside its range.
    GeometryError
        If the parts do not form a stable body, or a mesh does not enclose a volume.
    InvalidValueError
        If a size or a density is outside the range for bodies.
    MissingExtraError
        If the text names a mesh and trimesh is not installed.

    Examples
    --------
    >>> text = 'units = "cm"\n[[solid.part]]\nbox = { width = 50, depth = 50, height = 200 }\ndensity = 2000'
    >>> solid_from_toml(text).mass
    1000.0
    """
    from rocking.bodies.formats.schema import SolidDocument

    with located(name, "file"):
        document = validated(SolidDocument, parsed_toml(text))
        root = None if folder is None else Path(folder)
        repairs: list[str] = []
        parts: list[Part] = []
        for number, table in enumerate(document.solid.part):
            with located(f"solid.part[{number}]"):
                parts.append(_part(table, document.units, root, repairs))
        with located("solid"):
            solid = _standing(document, parts)
            solid.name, solid.repairs = document.name or name, tuple(repairs)
            return solid


def _standing(document: "schema.SolidDocument", parts: list[Part]) -> Solid:
    table, scale = document.solid, length_unit(document.units)
    lowest = min(float(part.box()[0, 2]) for part in parts)
    return Solid(
        parts,
        base=None if table.base is None else np.array(table.base) * scale,
        ground=lowest if table.ground is None else table.ground * scale,
        base_tolerance=None if table.base_tolerance is None else table.base_tolerance * scale,
        mass=table.mass,
        centre=None if table.centre is None else [scale * x for x in table.centre],
        inertia=table.inertia,
    )


def _part(table: "schema.PartTable", units: str, folder: Path | None, repairs: list[str]) -> Part:
    density = DEFAULT_DENSITY if table.density is None else table.density
    scale = length_unit(units)
    if table.mesh is not None:
        part = _mesh(table.mesh, units, folder, density, repairs)
    else:
        part = Part(_shape(table, scale), density)
    for turn in table.turned or ():
        part = part.turned(turn.axis, math.radians(turn.degrees))
    return part if table.at is None else _moved(part, [scale * x for x in table.at])


def _moved(part: Part, position: list[float]) -> Part:
    size = float(np.ptp(part.box(), axis=0).max())
    if max(map(abs, position)) > _FARTHEST * size:
        raise BodyFileError(
            "{parameter} must be within {limit:g} x the size of its part, {size:.4g} m, got {largest:.4g} m. Larger "
            "distances cause rounding errors.", parameter="at", value=position, limit=_FARTHEST, size=size,
            largest=max(position, key=abs),
        )  # fmt: skip
    return part.moved(*position)


def _mesh(table: "schema.MeshTable", units: str, folder: Path | None, density: float, repairs: list[str]) -> Part:
    path = beside(folder, table.file)
    mesh_units = table.units or units
    weld_tolerance, wall = (
        None if x is None else x * length_unit(mesh_units) for x in (table.weld_tolerance, table.wall)
    )
    mesh = mesh_from_file(
        path, units=mesh_units, up=table.up, weld_tolerance=weld_tolerance, repair=table.repair,
        surface=table.surface, wall=wall, inner_parts=table.inner_parts,
    )  # fmt: skip
    repairs += [Message("{file}: {repair}", {"file": path.name, "repair": repair}) for repair in mesh.repairs]
    return mesh.part(density)


def _shape(table: "schema.PartTable", scale: float) -> Shape:
    if table.extrusion is not None:
        rings = [np.array(ring) * scale for ring in (table.extrusion.outline, *(table.extrusion.holes or ()))]
        check_count(sum(map(len, rings)))
        return extrusion(rings[0], table.extrusion.height * scale, tuple(rings[1:]))
    if table.revolution is not None:
        check_count(len(table.revolution.profile))
        return revolution(np.array(table.revolution.profile) * scale)
    kind, make = next((kind, make) for kind, make in _SIMPLE.items() if getattr(table, kind) is not None)
    sizes = getattr(table, kind).model_dump()
    return make(**{key: value * scale for key, value in sizes.items()})


def _sphere(diameter: float, cut_below: float, cut_above: float) -> Shape:
    return ellipsoid(diameter, diameter, diameter, cut_below=cut_below, cut_above=cut_above)


_SIMPLE: dict[str, Callable[..., Shape]] = {
    "box": box,
    "cylinder": cylinder,
    "cone": cone,
    "frustum": frustum,
    "sphere": _sphere,
    "ellipsoid": ellipsoid,
}
"""Functions for shapes; their arguments are the keys of the tables, all lengths."""
