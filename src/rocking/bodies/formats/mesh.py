"""Surface meshes and clouds through trimesh: mended where that is safe, refused where it is not."""

import io
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.equilibria.poses import set_down
from rocking.bodies.formats.words import MOST_VERTICES, checked_file
from rocking.bodies.solid._changes import InnerParts, Repair, in_words
from rocking.bodies.solid._repair import Repaired, repaired
from rocking.bodies.solid._skin import Surface
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.solid import Solid
from rocking.bodies.solid.standing import settled, stands
from rocking.bodies.solid.surfaces import vector
from rocking.checks import length_unit
from rocking.conventions import LENGTH_UNITS, FloatArray, IntArray
from rocking.errors import BodyFileError, GeometryError, InvalidValueError, MissingExtraError, how_to_install, located
from rocking.messages import Message

MESH_FORMATS = ("stl", "obj", "ply", "glb", "xyz")  # formats that are read, by the end of the file's name
_UP = {"z": (0.0, 0.0, 1.0), "y": (0.0, 1.0, 0.0)}
FEWEST_POINTS = 50  # fewer points without faces are no cloud [-]

_LOWEST, _HIGHEST = 1e-3, 300.0
_SINGLE = 2.0**-24
_LEAN = 5.0
_BASE_TOLERANCE = 1e-6  # over the size: corners of a mesh in single precision lie that far from one plane


def mesh_from_file(
    path: str | Path,
    *,
    units: str,
    up: str | ArrayLike = "z",
    weld_tolerance: float | None = None,
    repair: Repair = "safe",
    surface: Surface = "faces",
    wall: float | None = None,
    inner_parts: InnerParts = "refuse",
) -> Repaired:
    """Return the volume inside a mesh: welded, oriented, closed, centred, z up; with a sentence for each doubt."""
    # with no weld tolerance equal vertices are merged; if that leaves the surface open, those within 1e-6 of its size
    path = Path(path)
    scale = length_unit(units)
    turn = _turn(up)
    with located(path.name, "file"):
        kind = path.suffix[1:].lower()
        if kind not in MESH_FORMATS:
            raise BodyFileError("is no mesh that is read here: {formats}", formats=", ".join(MESH_FORMATS))
        try:
            content = checked_file(path).read_bytes()
        except OSError as error:
            raise BodyFileError("cannot be opened ({reason})", reason=error.strerror) from error
        vertices, faces = _loaded(content, kind)
        surface = checks.one_of("surface", surface, get_args(Surface))
        surface = "wrap" if surface == "faces" and not len(faces) else surface
        done = repaired(
            (vertices * scale) @ turn.T, faces,
            weld_tolerance=weld_tolerance, repair=repair, surface=surface, wall=wall, inner_parts=inner_parts,
            place=lambda where: in_words(where @ turn / scale, units),
        )  # fmt: skip
        doubts = [*_size_doubts(done.shape, units), *_precision_doubts(vertices, kind)]
        if kind == "glb" and units != "m":
            doubts.append(
                Message("GLB files are in m by their specification; read in {units} as asked", {"units": units})
            )
        return replace(done, repairs=(*done.repairs, *doubts))


def _turn(up: str | ArrayLike) -> FloatArray:
    """Return the least rotation after which a direction of the file is up."""
    direction = np.asarray(_UP.get(up, ()) if isinstance(up, str) else up)
    known = direction.shape == (3,) and direction.dtype.kind in "iuf" and np.isfinite(direction).all()
    if not known or not direction.any():
        directions = '"z", "y", or a direction (x, y, z) in the file'
        raise InvalidValueError(parameter="up", allowed=directions, value=up)
    return set_down(-direction / np.linalg.norm(direction.astype(np.float64)))


def solid_from_mesh(
    path: str | Path,
    density: float = DEFAULT_DENSITY,
    *,
    units: str,
    base: ArrayLike | None = None,
    base_tolerance: float | None = None,
    mass: float | None = None,
    centre: ArrayLike | None = None,
    inertia: ArrayLike | None = None,
    **options: Any,
) -> Solid:
    """Return the body that a surface mesh describes, standing, with what was repaired."""
    # it stands as it is in the file if its centre lies above the points that touch the ground; otherwise it is let down
    # from there until it rests. base: points (x, y) that it stands on as it is in the file [m]; base_tolerance:
    # vertices this close to the lowest one touch the ground [m]; mass [kg], centre [m] and inertia [kg m2], where they
    # are known, as the mesh is before it is let down
    path = Path(path)
    mesh = mesh_from_file(path, units=units, **options)
    with located(path.name, "file"):
        part, said = mesh.part(density), mesh.repairs
        tolerance = base_tolerance or _BASE_TOLERANCE * float(np.ptp(part.box(), axis=0).max())
        points, place = mesh.shape.vertices, mesh.shape.moments().centre
        if centre is not None:
            place = vector("centre", centre) - mesh.middle
            outside = float((mesh.shape.hull.equations @ np.append(place, 1.0)).max())
            if outside >= 0.0:
                raise GeometryError(
                    "the centre of mass {value} m lies {outside:.3g} m outside of the hull of the mesh, as the file "
                    "has it", parameter="centre", value=centre, outside=outside,
                    hint="was it measured from another origin, or in another unit?",
                )  # fmt: skip
        if base is None and not stands(points, place, checks.positive("base_tolerance", tolerance, "m")):
            turn = settled(mesh.shape.hull.points[mesh.shape.hull.vertices], place)
            part = Part(mesh.shape, density, rotation=turn, translation=mesh.middle)
            place = turn @ place
            if inertia is not None:
                tensor = checks.real_array("inertia", inertia, "kg m2")
                inertia = turn @ (np.diag(tensor) if tensor.shape == (3,) else tensor) @ turn.T
            said = (*said, _settled_words(turn, float((place + mesh.middle)[2] - part.box()[0, 2])))
        solid = Solid(
            part, base=base, ground=float(part.box()[0, 2]), base_tolerance=tolerance,
            mass=mass, centre=None if centre is None else place + mesh.middle, inertia=inertia,
        )  # fmt: skip
    solid.name, solid.repairs, solid.turn = path.name, said, part.rotation @ _turn(options.get("up", "z"))
    return solid


def _settled_words(turn: FloatArray, height: float) -> str:
    angle = math.degrees(math.acos(min(1.0, float(turn[2, 2]))))
    if angle < _LEAN:
        return Message(
            "turned by {angle:.2g} degrees onto the points that it rests on, its centre {height:.4g} m high",
            {"angle": angle, "height": height},
        )
    return Message(
        "does not stand as the file has it: let down from there, it rests turned by {angle:.3g} degrees, its centre "
        "{height:.4g} m high; up= says which of its sides is up",
        {"angle": angle, "height": height},
    )


def _loaded(content: bytes, kind: str) -> tuple[FloatArray, IntArray]:
    try:
        import trimesh
    except ImportError as error:
        raise MissingExtraError(how_to_install("reading meshes", "trimesh", error)) from error
    _check_stated(content, kind)
    try:
        # from memory and without a resolver: no other file is opened, whatever this one names
        scene = trimesh.load_scene(io.BytesIO(content), file_type=kind, process=False)
        pieces: list[Any] = scene.dump()
        vertices = np.concatenate([np.zeros((0, 3)), *(piece.vertices for piece in pieces)])
        starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces)])
        numbers = [np.asarray(getattr(piece, "faces", ())).reshape(-1, 3) for piece in pieces]
        faces = np.concatenate([np.zeros((0, 3), dtype=np.int64), *map(np.add, numbers, starts[:-1])]).astype(np.int64)
    except Exception as error:  # trimesh lets whatever a damaged file provokes pass
        raise BodyFileError(
            "is no readable {format} mesh ({type})", format=kind.upper(), type=type(error).__name__
        ) from error
    if not len(faces) and len(vertices) < FEWEST_POINTS:
        raise BodyFileError("holds no triangles, and {count} points are too few for a cloud", count=len(vertices))
    if len(vertices) > 10 * MOST_VERTICES:
        raise BodyFileError(
            "has {count} vertices; a mesh may have up to {limit}", count=len(vertices), limit=10 * MOST_VERTICES
        )
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise BodyFileError("has faces that name vertices it does not hold")
    return vertices, faces


def _check_stated(content: bytes, kind: str) -> None:
    """Refuse files at odds with their own header."""
    if kind == "stl":
        _check_stl(content)
    if kind == "glb" and (len(content) < 12 or int.from_bytes(content[8:12], "little") != len(content)):
        raise BodyFileError(
            "has {size} bytes, not the number that its header states", size=len(content), hint="was it cut short?"
        )
    if kind == "ply":
        header = content[: content.find(b"end_header") + 1]
        lines = content.count(b"\n", len(header)) if b"format ascii" in header else None
        stated = sum(int(number) for number in re.findall(rb"element \w+ (\d+)", header))
        if lines is not None and lines < stated:
            raise BodyFileError(
                "has fewer lines than the {stated} elements its header states", stated=stated, hint="was it cut short?"
            )


def _check_stl(content: bytes) -> None:
    stated = int.from_bytes(content[80:84], "little") if len(content) >= 84 else -1
    if len(content) == 84 + 50 * stated:
        return
    if content.lstrip()[:5].lower() != b"solid":
        raise BodyFileError(
            "has {size} bytes, but a binary STL of the {faces} faces its header states has {expected}",
            size=len(content), faces=max(stated, 0), expected=84 + 50 * max(stated, 0), hint="was it cut short?",
        )  # fmt: skip
    opened, closed = (len(re.findall(word, content)) for word in (rb"(?m)^\s*facet\b", rb"(?m)^\s*endfacet\b"))
    if b"endsolid" not in content or opened != closed:
        raise BodyFileError(
            "opens {opened} facets and closes {closed}, or has no endsolid", opened=opened, closed=closed,
            hint="was it cut short?",
        )  # fmt: skip


def _size_doubts(shape: Polyhedron, units: str) -> list[str]:
    box = np.ptp(shape.vertices, axis=0)
    words = " x ".join(f"{side:.4g}" for side in box)
    size = float(box.max())
    likely = [unit for unit in LENGTH_UNITS if 0.1 <= size * length_unit(unit) / length_unit(units) <= 10.0]
    hint = " or ".join(f'units="{unit}"' for unit in likely)
    likelier = Message("{unit} is likelier", {"unit": hint}) if hint else Message("another is likelier")
    if not _LOWEST <= size <= _HIGHEST:
        raise BodyFileError(
            "describes a body of {size} m, read in {units}; is that the file's unit? {likelier}", size=words,
            units=units, likelier=likelier,
        )  # fmt: skip
    if not 0.02 <= size <= 30.0:
        return [f"the body measures {words} m, read in {units}: please check the unit; {likelier}"]
    return []


def _precision_doubts(vertices: FloatArray, kind: str) -> list[str]:
    size, far = float(np.ptp(vertices, axis=0).max()), float(np.abs(vertices).max())
    single = bool((vertices.astype(np.float32) == vertices).all())
    step = 2.0 * _SINGLE * far
    if not single or kind == "obj" or step <= 1e-5 * size:
        return []
    share = step / size
    if share > 1e-3:
        raise BodyFileError(
            "holds single-precision coordinates {distance:.3g} times the body's size from the origin, which keeps "
            "only {share:.1g} of its size", distance=far / size, share=share,
            hint="export it in coordinates near the body",
        )  # fmt: skip
    return [f"single-precision coordinates far from the origin keep {share:.1g} of the body's size only"]
