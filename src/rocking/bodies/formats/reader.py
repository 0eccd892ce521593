"""Reading of bodies from files; the extension selects the format, and units are explicit."""

import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypedDict, TypeVar, Unpack

from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY, Body
from rocking.bodies.formats.body_file import LARGEST_TOML, body_from_toml, parsed_toml
from rocking.bodies.formats.dxf import regions_from_dxf
from rocking.bodies.formats.geojson import regions_from_geojson
from rocking.bodies.formats.mesh import MESH_FORMATS, solid_from_mesh
from rocking.bodies.formats.solid_file import solid_from_toml
from rocking.bodies.formats.wkt import regions_from_wkt
from rocking.bodies.formats.words import Placement, read_text, readable, unit_to_state
from rocking.bodies.isolated import Isolated
from rocking.bodies.region import Region
from rocking.bodies.restrained import Restrained
from rocking.bodies.section import Section
from rocking.bodies.solid.repair.log import InnerParts, Repair
from rocking.bodies.solid.repair.wrap import SurfaceSource
from rocking.bodies.solid.solid import Solid
from rocking.bodies.stack import Stack
from rocking.errors import BodyFileError, RockingError, located

T = TypeVar("T")


class MeshOptions(TypedDict, total=False):
    """Options for reading a mesh and for its pose."""

    up: str | ArrayLike | None
    repair: Repair
    surface: SurfaceSource
    wall: float | None
    inner_parts: InnerParts
    base_tolerance: float | None


class KnownOptions(TypedDict, total=False):
    """Known values, as in `Section` for drawings, and as in `Solid` for meshes."""

    mass: float | None
    centre: Any
    moment_of_inertia: float | None
    inertia: Any


KNOWN = tuple(KnownOptions.__annotations__)


class Options(Placement, MeshOptions, KnownOptions, total=False):
    """Further options of `read_body`."""


@dataclass(frozen=True)
class Request:
    """Arguments of `read_body`: file, unit, density [kg/m3] and options."""

    path: Path
    units: str | None
    density: float | None
    options: Options

    @property
    def density_or_default(self) -> float:
        """Density, by default that of plain concrete [kg/m3]."""
        return DEFAULT_DENSITY if self.density is None else self.density

    def stated(self, names: Iterable[str]) -> str:
        """Return the stated options among the names, as a text."""
        stated: dict[str, Any] = {"density": self.density, **self.options}
        return ", ".join(name for name in names if stated.get(name) is not None)


def read_body(
    path: str | Path, *, units: str | None = None, density: float | None = None, **options: Unpack[Options]
) -> Body | Restrained | Isolated | Stack | Solid:
    r"""Return the 2D or 3D body from a file.

    Parameters
    ----------
    path : str or Path
        2D bodies: TOML body file, WKT (.wkt), GeoJSON (.geojson, .json) or DXF drawing (.dxf). 3D bodies: TOML with a
        table [solid], surface mesh (.stl, .obj, .ply, .glb), or point cloud (.ply, .xyz).
    units : {"m", "cm", "mm", "ft", "in"}, optional
        Unit of the coordinates, required for WKT, GeoJSON, STL, OBJ and PLY, and for a drawing without a unit. GLB is
        in m by its specification. The unit must not contradict the file.
    density : float, optional
        Density of bodies and parts without a density, not for TOML [kg/m3]; the default is that of plain concrete.
    **options
        Known values: ``mass`` [kg] and ``centre`` [m], for drawings ``moment_of_inertia`` [kg m2] as in `Section`, for
        meshes ``inertia`` [kg m2] as in `Solid`. The other options of drawings are ``feet``, ``depth`` and ``ground``
        [m], as in `Section`; the default ground is the lowest point. The other options of meshes are in the notes.

    Returns
    -------
    Body, Restrained, Isolated, Stack or Solid
        Block, Section, MassPoints, a body with the restraints of a TOML file, a stack, or a `Solid` with its `name`.
        `repairs` of a solid contains one sentence for each change of the mesh and for each doubt about the mesh.

    Raises
    ------
    BodyFileError
        If the file does not contain a readable body.
    GeometryError
        If the shapes do not form a body, or a safe repair of a mesh is impossible. The message locates the opening.
    InvalidValueError
        If a number or the unit is outside its range.
    MissingExtraError
        If ezdxf (for drawings) or trimesh (for meshes) is not installed.
    TypeError
        If a keyword is unknown.

    Notes
    -----
    Options of meshes:

    - ``up``: upward axis "z" or "y", or upward direction (x, y, z), in the file. The default is "z", for GLB "y".
    - ``repair``: allowed repairs "none", "safe" (default) or "all". Safe repairs change at most 1 % of the volume and
      move the centre of mass by at most 0.5 % of the size. They close open bottoms and small holes, smooth folds, and
      remove small loose pieces.
    - ``surface``: "faces" of the mesh, "wrap" (a skin around the points), or convex "hull" of the points. The default
      is "faces", for files with points only "wrap".
    - ``wall``: wall thickness of a hollow body [m].
    - ``inner_parts``: closed parts inside another part with the same orientation are "solid" or "cavity". The default
      "refuse" is an error if the two choices differ by more than 1 % of the volume.
    - ``base_tolerance``: largest height of contact points above the lowest vertex [m].

    A mesh that is not stable in the pose of the file is lowered from there to a stable pose.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     crate, drum = Path(folder) / "crate.wkt", Path(folder) / "drum.toml"
    ...     _ = crate.write_text("POLYGON ((0 0, 1000 0, 1000 2000, 0 2000, 0 0))")
    ...     text = 'units = "m"\n[[solid.part]]\ncylinder = { diameter = 2.0, height = 1.0 }\ndensity = 1000.0'
    ...     _ = drum.write_text(text)
    ...     read_body(crate, units="mm", density=800.0).mass, round(read_body(drum).mass, 6)
    (1600.0, 3141.592654)
    """
    body: Body | Solid = _read(path, units, density, options, FORMATS)
    return body


def read_plane_body(path: str | Path, *, units: str | None = None, density: float | None = None) -> Body:
    """Return the 2D body from a file; refuse a 3D body before reading it.

    Parameters
    ----------
    path : str or Path
        TOML body file, WKT, GeoJSON or DXF drawing.
    units : {"m", "cm", "mm", "ft", "in"}, optional
        As in `read_body`.
    density : float, optional
        As in `read_body` [kg/m3].

    Returns
    -------
    Body
        Block, Section or MassPoints.

    Raises
    ------
    BodyFileError
        If the file does not contain a readable 2D body.
    """
    body: Body = _read(path, units, density, {}, PLANE)
    return body


def _read(path: Any, units: str | None, density: float | None, options: Options, formats: Mapping[str, Any]) -> Any:
    try:
        path = Path(path)
    except TypeError as error:
        raise BodyFileError(
            "path must be the path of a body file, got {value}", parameter="path", value=path
        ) from error
    reader = formats.get(path.suffix.lower())
    if reader is None:
        raise BodyFileError("Unsupported file. Use {extensions}.", extensions=", ".join(formats)).at(path.name)
    if unknown := options.keys() - Options.__annotations__.keys():
        raise TypeError(f"read_body() has no {', '.join(sorted(unknown))}")
    with readable(path):
        return reader(Request(path, units, density, options))


def describes_solid(path: str | Path) -> bool:
    """Return True for the file of a 3D body: a mesh by its extension, or TOML with a table [solid].

    Parameters
    ----------
    path : str or Path
        File; the result for unreadable TOML is False.

    Returns
    -------
    bool
        True if `read_body` returns a `Solid` for this file.

    Examples
    --------
    >>> describes_solid("statue.stl"), describes_solid("section.dxf")
    (True, False)
    """
    path = Path(path)
    if path.suffix[1:].lower() in MESH_FORMATS:
        return True
    if path.suffix.lower() != ".toml":
        return False
    try:
        return "solid" in parsed_toml(read_text(path, LARGEST_TOML))
    except RockingError:
        return False


def _toml(request: Request) -> Body | Restrained | Isolated | Stack | Solid:
    with located(request.path.name, "file"):
        solid = "solid" in parsed_toml(read_text(request.path, LARGEST_TOML))
    return _stated(request, solid_from_toml) if solid else _stated(request, body_from_toml)


def _stated(request: Request, read: Callable[[str, str, Path], T]) -> T:
    path = request.path
    with located(path.name, "file"):
        text = read_text(path, LARGEST_TOML)
        if refused := request.stated(("density", *Options.__annotations__)):
            raise BodyFileError("{options} is not allowed with a TOML body file", options=refused, hint="edit the file")
    body = read(text, path.name, path.parent)
    stated = tomllib.loads(text)["units"]
    if request.units not in (None, stated):
        raise BodyFileError(
            'The file has units = "{stated}", but units = "{units}" is requested. Remove units.',
            stated=stated,
            units=request.units,
        ).at(path.name)
    return body


def _text(request: Request, read: Callable[..., list[Region]]) -> Section:
    name = request.path.name
    with located(name, "file"):
        if request.units is None:
            raise BodyFileError("The file states no unit", hint=unit_to_state())
        text = read_text(request.path)
    return _standing(read(text, request.density_or_default, units=request.units, name=name), request)


def _standing(regions: list[Region], request: Request) -> Section:
    lowest = min(float(region.outline[:, 1].min()) for region in regions)
    with located(request.path.name, "file"):
        if refused := request.stated((*MeshOptions.__annotations__, "inertia")):
            raise BodyFileError("A drawing does not accept {options}, which are for meshes.", options=refused)
        placement: Any = {"ground": lowest, **request.options}
        allowed = {*Placement.__annotations__, *KNOWN} - {"inertia"}
        return Section(regions, **{key: value for key, value in placement.items() if key in allowed})


def _mesh(request: Request) -> Solid:
    path, kind = request.path, request.path.suffix[1:].lower()
    options: dict[str, Any] = {key: value for key, value in request.options.items() if value is not None}
    units, by_specification = request.units, kind == "glb"
    if refused := request.stated((*Placement.__annotations__, "moment_of_inertia")):
        raise BodyFileError("A mesh does not accept {options}, which are for drawings.", options=refused).at(path.name)
    assumptions = (("in m", units is None), ("with y up", "up" not in options)) if by_specification else ()
    assumed = [assumption for assumption, is_assumed in assumptions if is_assumed]
    density = DEFAULT_DENSITY if request.density is None else checks.density("density", request.density)
    if units is None and not by_specification:
        raise BodyFileError("{format} files state no unit", format=kind.upper(), hint=unit_to_state()).at(path.name)
    options.setdefault("up", "y" if by_specification else "z")
    solid = solid_from_mesh(path, density, units=units or "m", **options)
    if assumed:
        solid.repairs = (f"read {' and '.join(assumed)}, by the specification of GLB", *solid.repairs)
    return solid


PLANE: dict[str, Callable[[Request], Body | Restrained | Isolated | Stack]] = {
    ".toml": partial(_stated, read=body_from_toml),
    ".wkt": partial(_text, read=regions_from_wkt),
    **dict.fromkeys((".geojson", ".json"), partial(_text, read=regions_from_geojson)),
    ".dxf": lambda r: _standing(regions_from_dxf(r.path, r.density_or_default, units=r.units), r),
}
"""Readers of 2D bodies by extension; a new format is one line here, or in `FORMATS` for 3D bodies."""

FORMATS: dict[str, Callable[[Request], Body | Restrained | Isolated | Stack | Solid]] = {
    **PLANE,
    ".toml": _toml,
    **dict.fromkeys([f".{kind}" for kind in MESH_FORMATS], _mesh),
}
"""Readers of all bodies by extension."""
