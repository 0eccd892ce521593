"""Read a body from a file: the suffix says which format, and the units are never guessed."""

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
from rocking.bodies.region import Region
from rocking.bodies.section import Section
from rocking.bodies.solid._changes import InnerParts, Repair
from rocking.bodies.solid._skin import Surface
from rocking.bodies.solid.solid import Solid
from rocking.errors import BodyFileError, RockingError, located

T = TypeVar("T")


class MeshOptions(TypedDict, total=False):
    """How a mesh is read and stands."""

    up: str | ArrayLike | None
    repair: Repair
    surface: Surface
    wall: float | None
    inner_parts: InnerParts
    base_tolerance: float | None


class KnownOptions(TypedDict, total=False):
    """What is known beside the shape: as `Section` takes it of drawings, and `Solid` of meshes."""

    mass: float | None
    centre: Any
    moment_of_inertia: float | None
    inertia: Any


KNOWN = tuple(KnownOptions.__annotations__)


class Options(Placement, MeshOptions, KnownOptions, total=False):
    """What `read_body` takes beside unit and density."""


@dataclass(frozen=True)
class Request:
    """What the user asked for: a file, a unit, a density [kg/m3], and how the body is read and stands."""

    path: Path
    units: str | None
    density: float | None
    options: Options

    @property
    def some_density(self) -> float:
        """The density, by default that of plain concrete [kg/m3]."""
        return DEFAULT_DENSITY if self.density is None else self.density

    def given(self, names: Iterable[str]) -> str:
        """Return which of some options were given, in words."""
        asked: dict[str, Any] = {"density": self.density, **self.options}
        return ", ".join(name for name in names if asked.get(name) is not None)


def read_body(
    path: str | Path, *, units: str | None = None, density: float | None = None, **options: Unpack[Options]
) -> Body | Solid:
    r"""Return the body that a file describes, plane or in space.

    Parameters
    ----------
    path : str or Path
        Of plane bodies a TOML body file, WKT (.wkt), GeoJSON (.geojson, .json) or DXF drawing (.dxf); of solids TOML
        with a table [solid], a surface mesh (.stl, .obj, .ply, .glb), or a cloud of points (.ply, .xyz).
    units : {"m", "cm", "mm", "ft", "in"}, optional
        Unit of the coordinates: needed for WKT, GeoJSON, STL, OBJ and PLY, and for a drawing that does not state its
        unit; GLB is in m by its specification. A unit that contradicts the file is refused.
    density : float, optional
        Density of what has none of its own, TOML apart [kg/m3]; plain concrete if not given.
    **options
        Of drawings ``feet`` [m], ``depth`` [m] and ``ground`` [m], as for `Section`; a drawing stands on its lowest
        point if ``ground`` is not given. Of meshes ``up``, the axis that points up, "z", "y" or a direction (x, y, z)
        in the file ("z" if not given, but for GLB "y", by its specification); ``repair``, what may be mended:
        "none", "safe" (if not given: what changes at most 1 % of the volume and moves the centre by at most 0.5 % of
        the size, open bottoms and small holes closed, folds smoothed, dust left out) or "all"; ``surface``, "faces", or
        a skin over its points alone, "wrap" (if not given: of files that hold points alone), or their "hull";
        ``wall``, how thick it is where it is hollow [m]; ``inner_parts``, how closed parts inside another one that
        are wound like it are read: "solid", "cavity" or "refuse" (if not given: refused where the two readings differ
        by more than 1 % of the volume); and ``base_tolerance`` [m]: vertices this close to the lowest
        one touch the ground. A mesh that does not stand as it is in the file is let down from there until it rests. Of
        both ``mass`` [kg] and ``centre`` [m] where they are known, of drawings ``moment_of_inertia`` [kg m2], as for
        `Section`, and of meshes ``inertia`` [kg m2], as for `Solid`.

    Returns
    -------
    Body or Solid
        Block, Section or MassPoints; or a `Solid`, with its `name` and a sentence in `repairs` for each change of a
        mesh and each doubt about it.

    Raises
    ------
    BodyFileError
        If the file cannot be read as a body.
    GeometryError
        If its shapes do not describe a body, or a mesh cannot be closed safely: the message says where it is open.
    InvalidValueError
        If one of its numbers, or the unit, is outside its range.
    MissingExtraError
        If it is a drawing or a mesh and ezdxf or trimesh is not installed.
    TypeError
        If there is no such keyword.

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
    found: Body | Solid = _read(path, units, density, options, FORMATS)
    return found


def read_plane_body(path: str | Path, *, units: str | None = None, density: float | None = None) -> Body:
    """Return the plane body that a file describes; a body in space is refused before it is read.

    Parameters
    ----------
    path : str or Path
        TOML body file, WKT, GeoJSON or DXF drawing.
    units : {"m", "cm", "mm", "ft", "in"}, optional
        As of `read_body`.
    density : float, optional
        As of `read_body` [kg/m3].

    Returns
    -------
    Body
        Block, Section or MassPoints.

    Raises
    ------
    BodyFileError
        If the file cannot be read as a plane body.
    """
    found: Body = _read(path, units, density, {}, PLANE)
    return found


def _read(path: Any, units: str | None, density: float | None, options: Options, formats: Mapping[str, Any]) -> Any:
    try:
        path = Path(path)
    except TypeError as error:
        raise BodyFileError("a body file is given by its path, got {value}", parameter="path", value=path) from error
    reader = formats.get(path.suffix.lower())
    if reader is None:
        raise BodyFileError("the name must end in {extensions}", extensions=", ".join(formats)).at(path.name)
    if unknown := options.keys() - Options.__annotations__.keys():
        raise TypeError(f"read_body() has no {', '.join(sorted(unknown))}")
    with readable(path):
        return reader(Request(path, units, density, options))


def describes_solid(path: str | Path) -> bool:
    """Return whether a file is one of a body in space: by its ending a mesh, or TOML with a table [solid].

    Parameters
    ----------
    path : str or Path
        The file; one that cannot be read as TOML is none.

    Returns
    -------
    bool
        Whether `read_body` would return a `Solid`.

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


def _toml(request: Request) -> Body | Solid:
    with located(request.path.name, "file"):
        solid = "solid" in parsed_toml(read_text(request.path, LARGEST_TOML))
    return _stated(request, solid_from_toml) if solid else _stated(request, body_from_toml)


def _stated(request: Request, read: Callable[[str, str, Path], T]) -> T:
    path = request.path
    with located(path.name, "file"):
        text = read_text(path, LARGEST_TOML)
        if given := request.given(("density", *Options.__annotations__)):
            raise BodyFileError("a TOML body file states {options} itself", options=given, hint="change it there")
    body = read(text, path.name, path.parent)
    stated = tomllib.loads(text)["units"]
    if request.units not in (None, stated):
        raise BodyFileError(
            'states units = "{stated}", but units = "{units}" was asked for', stated=stated, units=request.units
        ).at(path.name)
    return body


def _text(request: Request, read: Callable[..., list[Region]]) -> Section:
    name = request.path.name
    with located(name, "file"):
        if request.units is None:
            raise BodyFileError("does not state its unit", hint=unit_to_state())
        text = read_text(request.path)
    return _standing(read(text, request.some_density, units=request.units, name=name), request)


def _standing(regions: list[Region], request: Request) -> Section:
    lowest = min(float(region.outline[:, 1].min()) for region in regions)
    with located(request.path.name, "file"):
        if given := request.given((*MeshOptions.__annotations__, "inertia")):
            raise BodyFileError("is a drawing and takes no {options}: these are for meshes", options=given)
        placement: Any = {"ground": lowest, **request.options}
        taken = {*Placement.__annotations__, *KNOWN} - {"inertia"}
        return Section(regions, **{key: value for key, value in placement.items() if key in taken})


def _mesh(request: Request) -> Solid:
    path, kind = request.path, request.path.suffix[1:].lower()
    options: dict[str, Any] = {key: value for key, value in request.options.items() if value is not None}
    units, by_specification = request.units, kind == "glb"
    if given := request.given((*Placement.__annotations__, "moment_of_inertia")):
        raise BodyFileError("is a mesh, which stands on its lowest point and takes no {options}", options=given).at(
            path.name
        )
    said = (("in m", units is None), ("with y up", "up" not in options)) if by_specification else ()
    taken = [words for words, silent in said if silent]
    density = DEFAULT_DENSITY if request.density is None else checks.density("density", request.density)
    if units is None and not by_specification:
        raise BodyFileError("{format} files do not state their unit", format=kind.upper(), hint=unit_to_state()).at(
            path.name
        )
    options.setdefault("up", "y" if by_specification else "z")
    solid = solid_from_mesh(path, density, units=units or "m", **options)
    if taken:
        solid.repairs = (f"read {' and '.join(taken)}, as the specification of GLB says", *solid.repairs)
    return solid


PLANE: dict[str, Callable[[Request], Body]] = {
    ".toml": partial(_stated, read=body_from_toml),
    ".wkt": partial(_text, read=regions_from_wkt),
    **dict.fromkeys((".geojson", ".json"), partial(_text, read=regions_from_geojson)),
    ".dxf": lambda asked: _standing(regions_from_dxf(asked.path, asked.some_density, units=asked.units), asked),
}
"""Suffix and reader of plane bodies: a new format is one line here, or in `FORMATS` for a body in space."""

FORMATS: dict[str, Callable[[Request], Body | Solid]] = {
    **PLANE,
    ".toml": _toml,
    **dict.fromkeys([f".{kind}" for kind in MESH_FORMATS], _mesh),
}
"""Suffix and reader of every body."""
