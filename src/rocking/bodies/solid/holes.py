"""Holes in a welded surface: found, described, and closed where they are small and the user asks for it."""

import numpy as np

from rocking.conventions import FloatArray, IntArray, percent
from rocking.errors import GeometryError

SMALL = 0.01
"""Holes are filled up to this share of the surface, all together [-]."""

_LISTED = 3


def boundary_loops(faces: IntArray, points: FloatArray) -> list[IntArray]:
    """Return the rings of edges that have a face on one side only.

    points: vertices [m]. Returns vertices of each ring, in the sense that the missing faces would have.
    """
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    _, inverse, counts = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True)
    open_ = edges[counts[inverse.ravel()] == 1][:, ::-1]
    following = dict(open_.tolist())
    if len(following) < len(open_):
        where = points[open_[:, 0]].mean(axis=0)
        raise GeometryError(
            f"the surface has {len(open_)} open edges that meet in more than pairs, around "
            f"({where[0]:.3g}, {where[1]:.3g}, {where[2]:.3g}) m from the middle of the mesh; "
            "repair it in the program that made it"
        )
    loops = []
    while following:
        start, vertex = next(iter(following.items()))
        ring = [start]
        del following[start]
        while vertex != start:
            if vertex not in following:
                raise GeometryError("the open edges of the surface form no rings; are faces turned against each other?")
            ring.append(vertex)
            vertex = following.pop(vertex)
        loops.append(np.array(ring))
    return loops


def holes_sentence(loops: list[IntArray], points: FloatArray) -> str:
    """Return what a user must know about the holes of a surface.

    points: vertices in the user's coordinates [m]. Returns the sentence: how many, how large, where.
    """
    order = sorted(loops, key=lambda ring: -_width(points[ring]))
    listed = "; ".join(
        f"{_width(points[ring]):.3g} m wide ({len(ring)} edges) at "
        f"({', '.join(f'{x:.3g}' for x in points[ring].mean(axis=0))}) m"
        for ring in order[:_LISTED]
    )
    more = f" and {len(loops) - _LISTED} smaller" if len(loops) > _LISTED else ""
    return (
        f"the surface is not closed, it has {len(loops)} hole(s): {listed}{more}; close them in the program that made "
        "it, or pass fill_holes=True if together they are below 1 % of the surface"
    )


def filled(points: FloatArray, faces: IntArray, loops: list[IntArray], said: list[str]) -> tuple[FloatArray, IntArray]:
    """Return the surface with a fan of triangles over each hole.

    points: vertices [m]. Returns points: vertices with the middle of each hole added.
    """
    if not loops:
        return points, faces
    whole = _area(points[faces])
    extra_points, extra_faces = [], []
    for number, ring in enumerate(loops):
        extra_points.append(points[ring].mean(axis=0))
        middle = np.full(len(ring), len(points) + number)
        extra_faces.append(np.stack([ring, np.roll(ring, -1), middle], axis=1))
    points, fans = np.concatenate([points, extra_points]), np.concatenate(extra_faces)
    share = _area(points[fans]) / whole
    if share > SMALL:
        raise GeometryError(
            f"{len(loops)} hole(s) are {percent(share)} of the surface; only up to 1 % is filled, as a larger "
            "patch would invent part of the body: close them in the program that made the mesh"
        )
    said.append(f"filled {len(loops)} hole(s), together {percent(share)} of the surface, each with a fan")
    return points, np.concatenate([faces, fans])


def _area(triangles: FloatArray) -> float:
    a, b, c = np.moveaxis(triangles, 1, 0)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _width(ring: FloatArray) -> float:
    return float(np.linalg.norm(np.ptp(ring, axis=0)))
