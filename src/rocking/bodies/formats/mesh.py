"""Surface meshes through trimesh: STL, OBJ, PLY and GLB, repaired where that is safe, refused where it is not."""

import io
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.formats.source import MOST_VERTICES, blamed, checked_file
from rocking.bodies.solid._repair import Repaired, repaired
from rocking.bodies.solid._self_crossing import in_words
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.solid import Solid
from rocking.conventions import FloatArray, IntArray
from rocking.errors import BodyFileError, InvalidValueError, MissingExtraError, how_to_install

MESH_FORMATS = ("stl", "obj", "ply", "glb")
"""Formats that are read, by the end of the file's name."""

_UP: dict[str, FloatArray] = {"z": np.eye(3), "y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])}
_LOWEST, _HIGHEST = 1e-3, 300.0
_SINGLE = 2.0**-24


def mesh_from_file(
    path: str | Path,
    *,
    units: str,
    up: str = "z",
    weld_tolerance: float | None = None,
    fill_holes: bool = False,
) -> Repaired:
    """Return the volume inside a surface mesh: welded, oriented, closed, centred; z up, with a sentence for each doubt.

    weld_tolerance: vertices this close are merged [m]; by default equal ones, and if that leaves the surface open,
    those within 1e-6 of its size.
    """
    path = Path(path)
    scale = checks.length_unit(units)
    if up not in _UP:
        raise InvalidValueError(f'up must be "z" or "y", got {up!r}')
    with blamed(path.name):
        kind = path.suffix[1:].lower()
        if kind not in MESH_FORMATS:
            raise BodyFileError(f"is no mesh that is read here: {', '.join(MESH_FORMATS)}")
        try:
            content = checked_file(path).read_bytes()
        except OSError as error:
            raise BodyFileError(f"cannot be opened ({error.strerror})") from error
        vertices, faces = _loaded(content, kind)
        done = repaired(
            vertices * scale @ _UP[up].T, faces, weld_tolerance=weld_tolerance, fill_holes=fill_holes,
            place=lambda where: in_words(where @ _UP[up] / scale, units),
        )  # fmt: skip
        doubts = [*_size_doubts(done.shape, units), *_precision_doubts(vertices, kind)]
        if kind == "glb" and units != "m":
            doubts.append(f"GLB files are in m by their specification; read in {units} as asked")
        return replace(done, repairs=(*done.repairs, *doubts))


def solid_from_mesh(
    path: str | Path,
    density: float = DEFAULT_DENSITY,
    *,
    units: str,
    base: ArrayLike | None = None,
    base_tolerance: float | None = None,
    **options: Any,
) -> Solid:
    """Return the body that a surface mesh describes, standing on its lowest point, with what was repaired.

    base: points (x, y) that it stands on [m]; base_tolerance: vertices this close to the lowest one stand on the
    ground [m]; scans need some millimetres.
    """
    path = Path(path)
    mesh = mesh_from_file(path, units=units, **options)
    with blamed(path.name):
        part = mesh.part(density)
        solid = Solid(part, base=base, ground=float(part.box()[0, 2]), base_tolerance=base_tolerance)
    solid.name, solid.repairs = path.name, mesh.repairs
    return solid


def _loaded(content: bytes, kind: str) -> tuple[FloatArray, IntArray]:
    try:
        import trimesh
    except ImportError as error:
        raise MissingExtraError(how_to_install("reading meshes", "trimesh", error)) from error
    _check_stated(content, kind)
    try:
        # from memory and without a resolver: no other file is opened, whatever this one names
        scene = trimesh.load_scene(io.BytesIO(content), file_type=kind, process=False)
        mesh = scene.to_mesh() if scene.geometry else None
        vertices = np.array(mesh.vertices, dtype=np.float64) if mesh is not None else np.zeros((0, 3))
        faces = np.array(mesh.faces, dtype=np.int64) if mesh is not None else np.zeros((0, 3), dtype=np.int64)
    except Exception as error:  # trimesh lets whatever a damaged file provokes pass
        raise BodyFileError(f"is no readable {kind.upper()} mesh ({type(error).__name__})") from error
    if not len(faces):
        raise BodyFileError("holds no triangles")
    if len(vertices) > 3 * MOST_VERTICES:
        raise BodyFileError(f"has {len(vertices)} vertices; a mesh may have up to {3 * MOST_VERTICES}")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise BodyFileError("has faces that name vertices it does not hold")
    return vertices, faces


def _check_stated(content: bytes, kind: str) -> None:
    """Refuse files at odds with their own header."""
    if kind == "stl":
        _check_stl(content)
    if kind == "glb" and (len(content) < 12 or int.from_bytes(content[8:12], "little") != len(content)):
        raise BodyFileError(f"has {len(content)} bytes, not the number that its header states; was it cut short?")
    if kind == "ply":
        header = content[: content.find(b"end_header") + 1]
        lines = content.count(b"\n", len(header)) if b"format ascii" in header else None
        stated = sum(int(number) for number in re.findall(rb"element \w+ (\d+)", header))
        if lines is not None and lines < stated:
            raise BodyFileError(f"has fewer lines than the {stated} elements its header states; was it cut short?")


def _check_stl(content: bytes) -> None:
    stated = int.from_bytes(content[80:84], "little") if len(content) >= 84 else -1
    if len(content) == 84 + 50 * stated:
        return
    if content.lstrip()[:5].lower() != b"solid":
        raise BodyFileError(
            f"has {len(content)} bytes, but a binary STL of the {max(stated, 0)} faces its header states has "
            f"{84 + 50 * max(stated, 0)}; was it cut short?"
        )
    opened, closed = (len(re.findall(word, content)) for word in (rb"(?m)^\s*facet\b", rb"(?m)^\s*endfacet\b"))
    if b"endsolid" not in content or opened != closed:
        raise BodyFileError(f"opens {opened} facets and closes {closed}, or has no endsolid; was it cut short?")


def _size_doubts(shape: Polyhedron, units: str) -> list[str]:
    box = np.ptp(shape.vertices, axis=0)
    words = " x ".join(f"{side:.4g}" for side in box)
    if not _LOWEST <= float(box.max()) <= _HIGHEST:
        raise BodyFileError(f"describes a body of {words} m, read in {units}; is that the file's unit?")
    if not 0.02 <= float(box.max()) <= 30.0:
        return [f"the body measures {words} m, read in {units}: please check the unit"]
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
            f"holds single-precision coordinates {far / size:.3g} times the body's size from the origin, which keeps "
            f"only {share:.1g} of its size; export it in coordinates near the body"
        )
    return [f"single-precision coordinates far from the origin keep {share:.1g} of the body's size only"]
