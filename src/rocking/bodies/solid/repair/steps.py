"""From the triangles or points of a file to a closed surface: the order of the repairs.

Vertices are merged first, because orientation and closing of holes need the neighbours of each face. Volumes need a
closed surface, and the union of shells needs separate shells.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import get_args

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.repair.holes import close_holes
from rocking.bodies.solid.repair.hollow import hollow_out
from rocking.bodies.solid.repair.log import SKINS, InnerParts, Repair, RepairLog
from rocking.bodies.solid.repair.merge import merge_vertices, remove_duplicates
from rocking.bodies.solid.repair.orient import orient_faces
from rocking.bodies.solid.repair.remove import remove_fins, remove_loose_pieces
from rocking.bodies.solid.repair.shells import orient_shells
from rocking.bodies.solid.repair.simplify import simplify
from rocking.bodies.solid.repair.smooth import smooth_crossings
from rocking.bodies.solid.repair.wrap import SurfaceSource, surface_around_points
from rocking.bodies.solid.surfaces import coordinates_text
from rocking.bodies.solid.triangles import checked_triangles, largest_extent, open_edges, used_points
from rocking.conventions import FloatArray, IntArray
from rocking.errors import GeometryError
from rocking.messages import Message


@dataclass(frozen=True, eq=False)
class RepairedSurface:
    """A closed surface with its repairs."""

    shape: Polyhedron  # the volume, with the middle of its box at the origin
    middle: FloatArray  # middle of the box in the coordinates of the input [m]; shape (3,)
    repairs: tuple[str, ...]  # one sentence per change; empty without changes

    def part(self, density: float = DEFAULT_DENSITY) -> Part:
        """Return the volume at its original position with one density [kg/m3]."""
        return Part(self.shape, density, translation=self.middle)


def repair_surface(
    vertices: FloatArray,
    faces: IntArray,
    *,
    weld_tolerance: float | None = None,
    repair: Repair = "safe",
    surface: SurfaceSource = "faces",
    wall: float | None = None,
    inner_parts: InnerParts = "refuse",
    describe: Callable[[FloatArray], str] = coordinates_text,
) -> RepairedSurface:
    """Return the closed surface of triangles or of points, with one sentence per change."""
    surface = checks.one_of("surface", surface, get_args(SurfaceSource))
    vertices, faces = checked_triangles(vertices, faces, int(surface == "faces"))
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    points = vertices - middle
    size = checks.length("largest dimension of the mesh", largest_extent(points))
    log = RepairLog(repair, inner_parts, lambda point: describe(point + middle))
    if surface == "faces":
        points, faces = _close_surface(points, faces, weld_tolerance, size, log)
    else:
        points, faces = surface_around_points(points, surface, log)
    points, faces = orient_shells(points, faces, log)
    points, faces = simplify(points, faces, log)
    points, faces = smooth_crossings(points, faces, log)
    if wall is not None:
        points, faces = hollow_out(
            points, faces, checks.within("wall", wall, 0.0, 0.5 * size, unit="m", open_low=True), log
        )
    shape = Polyhedron(*used_points(points, faces), simple=True, patches=log.patches)
    _check_hull(shape)
    return RepairedSurface(shape, middle, log.sentences(shape.moments(), largest_extent(shape.vertices)))


def _close_surface(
    points: FloatArray, faces: IntArray, weld_tolerance: float | None, size: float, log: RepairLog
) -> tuple[FloatArray, IntArray]:
    points, faces = merge_vertices(points, faces, weld_tolerance, size, log)
    faces = remove_duplicates(faces, log)
    faces = remove_fins(points, remove_loose_pieces(points, faces, log), log)
    points, faces = used_points(points, orient_faces(faces, log))
    count = len(faces)
    points, faces = close_holes(points, faces, log)
    faces = orient_faces(faces, log) if len(faces) > count else faces
    if count := len(open_edges(faces)):
        raise GeometryError(
            "The surface has no consistent orientation: {count} edges have no matching neighbour. Check for edges with "
            "more than two faces, and for a one-sided surface", count=count,
            hint=Message("{wrap} uses a skin around the points", SKINS),
        )  # fmt: skip
    return points, faces


def _check_hull(shape: Polyhedron) -> None:
    hull_volume = float(shape.hull.volume)
    volume = shape.moments().mass
    if volume > hull_volume * (1.0 + 1e-9):
        raise GeometryError(
            "The surface encloses {volume:.6g} m3, more than its hull ({hull:.6g} m3): the surface intersects itself",
            volume=volume, hull=hull_volume,
        )  # fmt: skip
