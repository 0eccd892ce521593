"""Read a body in space from a file: a TOML file with [solid], or a surface mesh."""

import tomllib
from pathlib import Path

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.formats.body_file import LARGEST_TOML, parsed_toml
from rocking.bodies.formats.mesh import MESH_FORMATS, solid_from_mesh
from rocking.bodies.formats.solid_file import SolidFile, solid_from_toml
from rocking.bodies.formats.source import blamed, read_text, readable
from rocking.conventions import LENGTH_UNITS
from rocking.errors import BodyFileError, RockingError


def describes_solid(path: str | Path) -> bool:
    """Return whether a file is one of a body in space: by its ending a mesh, or TOML with a table [solid].

    Parameters
    ----------
    path : str or Path
        The file; one that cannot be read as TOML is none.

    Returns
    -------
    bool
        Whether `read_solid` is the reader to ask.

    Examples
    --------
    >>> describes_solid("statue.stl"), describes_solid("section.dxf")
    (True, False)
    """
    given = Path(path)
    if given.suffix[1:].lower() in MESH_FORMATS:
        return True
    if given.suffix.lower() != ".toml":
        return False
    try:
        return "solid" in parsed_toml(read_text(given, LARGEST_TOML))
    except RockingError:
        return False


def read_solid(
    path: str | Path,
    *,
    units: str | None = None,
    density: float | None = None,
    up: str | None = None,
    fill_holes: bool = False,
    base_tolerance: float | None = None,
) -> SolidFile:
    r"""Return the body in space that a file describes.

    Parameters
    ----------
    path : str or Path
        TOML with a table [solid], or a surface mesh (STL, OBJ, PLY, GLB).
    units : {"m", "cm", "mm", "ft", "in"}, optional
        Unit of the coordinates of a mesh: needed for STL, OBJ and PLY; GLB is in m by its specification. A unit that
        contradicts a TOML file is refused.
    density : float, optional
        Density of a mesh [kg/m3]; plain concrete if not given.
    up : {"z", "y"}, optional
        Axis of a mesh that points up: z if not given, but for GLB y, by its specification.
    fill_holes : bool
        Whether holes of a mesh of less than 1 % of its surface may be closed.
    base_tolerance : float, optional
        Vertices of a mesh this close to the lowest one stand on the ground [m]; scans need some millimetres.

    Returns
    -------
    SolidFile
        The body, with a sentence for each repair of a mesh and each doubt about it.

    Raises
    ------
    BodyFileError
        If the file cannot be read as a body in space.
    GeometryError
        If it is none, or a mesh cannot be closed safely: the message says where it is open.
    InvalidValueError
        If one of its numbers, or the unit, is outside its range.
    MissingExtraError
        If it is a mesh and trimesh is not installed.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "drum.toml"
    ...     text = 'units = "m"\n[[solid.part]]\ncylinder = { diameter = 2.0, height = 1.0 }\ndensity = 1000.0'
    ...     _ = file.write_text(text)
    ...     round(read_solid(file).solid.mass, 6)
    3141.592654
    """
    try:
        given = Path(path)
    except TypeError as error:
        raise BodyFileError(f"a body file is given by its path, got {path!r:.60}") from error
    with readable(given):
        kind = given.suffix[1:].lower()
        if kind == "toml":
            _refuse(
                given,
                {"density": density, "up": up, "fill_holes": fill_holes or None, "base_tolerance": base_tolerance},
            )
            return _toml(given, units)
        if kind not in MESH_FORMATS:
            raise BodyFileError(
                f"{given.name}: the name of a body in space must end in .toml, .{', .'.join(MESH_FORMATS)}"
            )
        said = _by_specification(kind, units, up)
        solid, repairs = solid_from_mesh(
            given,
            DEFAULT_DENSITY if density is None else checks.density("density", density),
            units=_unit(given, units),
            up=up or ("y" if kind == "glb" else "z"),
            fill_holes=fill_holes,
            base_tolerance=base_tolerance,
        )
        return SolidFile(solid, (*said, *repairs), given.name)


def _toml(path: Path, units: str | None) -> SolidFile:
    with blamed(path.name):
        text = read_text(path, LARGEST_TOML)
    found = solid_from_toml(text, path.name, path.parent)
    stated = tomllib.loads(text)["units"]
    if units is not None and stated != units:
        raise BodyFileError(f'{path.name}: states units = "{stated}", but units = "{units}" was asked for')
    return found


def _refuse(path: Path, options: dict[str, object]) -> None:
    given = [name for name, value in options.items() if value is not None]
    if given:
        raise BodyFileError(f"{path.name}: a TOML body file states {', '.join(given)} itself; change it there")


def _unit(path: Path, units: str | None) -> str:
    if units is None and path.suffix.lower() != ".glb":
        raise BodyFileError(
            f"{path.name}: {path.suffix[1:].upper()} files do not state their unit; give units=, one of "
            f"{', '.join(LENGTH_UNITS)}"
        )
    return units or "m"


def _by_specification(kind: str, units: str | None, up: str | None) -> list[str]:
    if kind != "glb":
        return []
    taken = [*(["in m"] if units is None else []), *(["with y up"] if up is None else [])]
    return [f"read {' and '.join(taken)}, as the specification of GLB says"] if taken else []
