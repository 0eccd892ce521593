"""Reading of surface meshes and point clouds through trimesh, with safe repairs."""

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
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.repair.log import InnerParts, Repair
from rocking.bodies.solid.repair.steps import RepairedSurface, repair_surface
from rocking.bodies.solid.repair.wrap import SurfaceSource
from rocking.bodies.solid.solid import Solid
from rocking.bodies.solid.standing import settled, stands
from rocking.bodies.solid.surfaces import coordinates_text, vector
from rocking.checks import length_unit
from rocking.conventions import LENGTH_UNITS, FloatArray, IntArray
from rocking.errors import BodyFileError, GeometryError, InvalidValueError, MissingExtraError, how_to_install, located
from rocking.messages import Message

MESH_FORMATS = ("stl", "obj", "ply", "glb", "xyz")  # extensions of mesh files
_UP = {"z": (0.0, 0.0, 1.0), "y": (0.0, 1.0, 0.0)}
FEWEST_POINTS = 50  # smallest number of points of a cloud without faces [-]

_LOWEST, _HIGHEST = 1e-3, 300.0
_SINGLE = 2.0**-24
SMALL_ROTATION = 5.0  # largest rotation without a warning [degree]
_BASE_TOLERANCE = 1e-6  # distance of corners from one plane / size of a mesh in single precision


def mesh_from_file(
    path: str | Path,
    *,
    units: str,
    up: str | ArrayLike = "z",
    weld_tolerance: float | None = None,
    repair: Repair = "safe",
    surface: SurfaceSource = "faces",
    wall: float | None = None,
    inner_parts: InnerParts = "refuse",
) -> RepairedSurface:
    """Return the repaired, closed volume inside a mesh, centred and with z up, and one sentence per doubt."""
    # By default, equal vertices are merged. In an open surface, vertices within 1e-6 x the size are merged too.
    path = Path(path)
    scale = length_unit(units)
    turn = _turn(up)
    with located(path.name, "file"):
        kind = path.suffix[1:].lower()
        if kind not in MESH_FORMATS:
            raise BodyFileError("Unsupported mesh. Use {formats}.", formats=", ".join(MESH_FORMATS))
        try:
            content = checked_file(path).read_bytes()
        except OSError as error:
            raise BodyFileError("The file cannot be opened ({reason}).", reason=error.strerror) from error
        vertices, faces = _loaded(content, kind)
        surface = checks.one_of("surface", surface, get_args(SurfaceSource))
        surface = "wrap" if surface == "faces" and not len(faces) else surface
        repaired_mesh = repair_surface(
            (vertices * scale) @ turn.T, faces,
            weld_tolerance=weld_tolerance, repair=repair, surface=surface, wall=wall, inner_parts=inner_parts,
            describe=lambda point: coordinates_text(point @ turn / scale, units),
        )  # fmt: skip
        doubts = [*_size_doubts(repaired_mesh.shape, units), *_precision_doubts(vertices, kind)]
        if kind == "glb" and units != "m":
            doubts.append(
                Message("GLB files are in m by their specification; {units} used as requested", {"units": units})
            )
        return replace(repaired_mesh, repairs=(*repaired_mesh.repairs, *doubts))


def _turn(up: str | ArrayLike) -> FloatArray:
    """Return the smallest rotation that turns a direction of the file upwards."""
    direction = np.asarray(_UP.get(up, ()) if isinstance(up, str) else up)
    is_vector = direction.shape == (3,) and direction.dtype.kind in "iuf" and np.isfinite(direction).all()
    if not is_vector or not direction.any():
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
    """Return the body from a surface mesh in a stable pose, with its repairs."""
    # The pose of the file is used if the centre of mass lies above the contact points. Otherwise the body is lowered
    # from there to a stable pose. In the pose of the file: base, contact points (x, y) [m]; base_tolerance, largest
    # height of contact points above the lowest vertex [m]; known mass [kg], centre of mass [m] and inertia [kg m2].
    path = Path(path)
    mesh = mesh_from_file(path, units=units, **options)
    with located(path.name, "file"):
        part, repairs = mesh.part(density), mesh.repairs
        tolerance = base_tolerance or _BASE_TOLERANCE * float(np.ptp(part.box(), axis=0).max())
        points, centre_of_mass = mesh.shape.vertices, mesh.shape.moments().centre
        if centre is not None:
            centre_of_mass = vector("centre", centre) - mesh.middle
            outside = float((mesh.shape.hull.equations @ np.append(centre_of_mass, 1.0)).max())
            if outside >= 0.0:
                raise GeometryError(
                    "the centre of mass {value} m lies {outside:.3g} m outside the hull of the mesh, in coordinates of "
                    "the file", parameter="centre", value=centre, outside=outside,
                    hint="check the origin and the unit",
                )  # fmt: skip
        if base is None and not stands(points, centre_of_mass, checks.positive("base_tolerance", tolerance, "m")):
            turn = settled(mesh.shape.hull.points[mesh.shape.hull.vertices], centre_of_mass)
            part = Part(mesh.shape, density, rotation=turn, translation=mesh.middle)
            centre_of_mass = turn @ centre_of_mass
            if inertia is not None:
                tensor = checks.real_array("inertia", inertia, "kg m2")
                inertia = turn @ (np.diag(tensor) if tensor.shape == (3,) else tensor) @ turn.T
            repairs = (*repairs, _settled_words(turn, float((centre_of_mass + mesh.middle)[2] - part.box()[0, 2])))
        solid = Solid(
            part, base=base, ground=float(part.box()[0, 2]), base_tolerance=tolerance,
            mass=mass, centre=None if centre is None else centre_of_mass + mesh.middle, inertia=inertia,
        )  # fmt: skip
    solid.name, solid.repairs, solid.turn = path.name, repairs, part.rotation @ _turn(options.get("up", "z"))
    if (angle := _angle(part.rotation)) >= SMALL_ROTATION:
        solid.settling_rotation = math.radians(angle)
    return solid


def _angle(turn: FloatArray) -> float:
    """Return the angle between the vertical directions before and after a rotation [degree]."""
    return math.degrees(math.acos(max(-1.0, min(1.0, float(turn[2, 2])))))


def _settled_words(turn: FloatArray, height: float) -> str:
    angle = _angle(turn)
    if angle < SMALL_ROTATION:
        return Message(
            "rotated by {angle:.2g} degrees onto its contact points; height of the centre of mass {height:.4g} m",
            {"angle": angle, "height": height},
        )
    return Message(
        "not stable in the pose of the file: rotated by {angle:.3g} degrees to a stable pose, height of the centre of "
        "mass {height:.4g} m; up= selects another pose",
        {"angle": angle, "height": height},
    )


def _loaded(content: bytes, kind: str) -> tuple[FloatArray, IntArray]:
    try:
        import trimesh
    except ImportError as error:
        raise MissingExtraError(how_to_install("reading meshes", "trimesh", error)) from error
    _check_stated(content, kind)
    try:
        # trimesh reads from memory and without a resolver, which prevents access to other files
        scene = trimesh.load_scene(io.BytesIO(content), file_type=kind, process=False)
        pieces: list[Any] = scene.dump()
        vertices = np.concatenate([np.zeros((0, 3)), *(piece.vertices for piece in pieces)])
        starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces)])
        numbers = [np.asarray(getattr(piece, "faces", ())).reshape(-1, 3) for piece in pieces]
        faces = np.concatenate([np.zeros((0, 3), dtype=np.int64), *map(np.add, numbers, starts[:-1])]).astype(np.int64)
    except Exception as error:  # trimesh raises any exception for a damaged file
        raise BodyFileError(
            "The {format} mesh is not readable ({type}).", format=kind.upper(), type=type(error).__name__
        ) from error
    if not len(faces) and len(vertices) < FEWEST_POINTS:
        raise BodyFileError("The file contains no triangles, and {count} points are too few.", count=len(vertices))
    if len(vertices) > 10 * MOST_VERTICES:
        raise BodyFileError(
            "The mesh has {count} vertices; at most {limit} are allowed.",
            count=len(vertices),
            limit=10 * MOST_VERTICES,
        )
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise BodyFileError("Faces refer to missing vertices.")
    return vertices, faces


def _check_stated(content: bytes, kind: str) -> None:
    """Refuse files that contradict their header."""
    if kind == "stl":
        _check_stl(content)
    if kind == "glb" and (len(content) < 12 or int.from_bytes(content[8:12], "little") != len(content)):
        raise BodyFileError(
            "The file has {size} bytes, different from its header",
            size=len(content),
            hint="check that the file is complete",
        )
    if kind == "ply":
        header = content[: content.find(b"end_header") + 1]
        lines = content.count(b"\n", len(header)) if b"format ascii" in header else None
        stated = sum(int(number) for number in re.findall(rb"element \w+ (\d+)", header))
        if lines is not None and lines < stated:
            raise BodyFileError(
                "The file has fewer lines than the {stated} elements of its header",
                stated=stated,
                hint="check that the file is complete",
            )


def _check_stl(content: bytes) -> None:
    stated = int.from_bytes(content[80:84], "little") if len(content) >= 84 else -1
    if len(content) == 84 + 50 * stated:
        return
    if content.lstrip()[:5].lower() != b"solid":
        raise BodyFileError(
            "The file has {size} bytes, but {faces} faces in its header need {expected} in a binary STL",
            size=len(content), faces=max(stated, 0), expected=84 + 50 * max(stated, 0),
            hint="check that the file is complete",
        )  # fmt: skip
    opened, closed = (len(re.findall(word, content)) for word in (rb"(?m)^\s*facet\b", rb"(?m)^\s*endfacet\b"))
    if b"endsolid" not in content or opened != closed:
        raise BodyFileError(
            "The file opens {opened} facets and closes {closed}, or endsolid is missing", opened=opened,
            closed=closed, hint="check that the file is complete",
        )  # fmt: skip


def _size_doubts(shape: Polyhedron, units: str) -> list[str]:
    box = np.ptp(shape.vertices, axis=0)
    size_text = " x ".join(f"{side:.4g}" for side in box)
    size = float(box.max())
    plausible_units = [unit for unit in LENGTH_UNITS if 0.1 <= size * length_unit(unit) / length_unit(units) <= 10.0]
    hint = " or ".join(f'units="{unit}"' for unit in plausible_units)
    advice = Message("Possible: {unit}", {"unit": hint}) if hint else Message("Use another unit")
    if not _LOWEST <= size <= _HIGHEST:
        raise BodyFileError(
            "The body has {size} m in the unit {units}. Check the unit. {advice}.", size=size_text,
            units=units, advice=advice,
        )  # fmt: skip
    if not 0.02 <= size <= 30.0:
        return [f"the body has {size_text} m in the unit {units}; check the unit. {advice}"]
    return []


def _precision_doubts(vertices: FloatArray, kind: str) -> list[str]:
    size, distance = float(np.ptp(vertices, axis=0).max()), float(np.abs(vertices).max())
    is_single = bool((vertices.astype(np.float32) == vertices).all())
    step = 2.0 * _SINGLE * distance
    if not is_single or kind == "obj" or step <= 1e-5 * size:
        return []
    relative_step = step / size
    if relative_step > 1e-3:
        raise BodyFileError(
            "The coordinates are in single precision, {distance:.3g} x body size from the origin. Their resolution is "
            "{resolution:.1g} of the size", distance=distance / size, resolution=relative_step,
            hint="export the mesh in coordinates near the body",
        )  # fmt: skip
    return [f"single-precision coordinates far from the origin: resolution {relative_step:.1g} of the body size"]
