"""A closed surface around points: their convex hull, or a skin that follows hollows wider than a ball."""

from typing import Literal

import numpy as np

from rocking.bodies.solid.repair.log import RepairLog
from rocking.bodies.solid.surfaces import area_vectors
from rocking.bodies.solid.triangles import box_diagonal, connected, largest_extent, oriented_along
from rocking.conventions import BoolArray, FloatArray, IntArray, percent
from rocking.errors import GeometryError
from rocking.messages import Message

SurfaceSource = Literal["faces", "wrap", "hull"]
"""Faces of a mesh, skin around its points, or convex hull of its points."""

MOST_POINTS = 30_000  # largest number of points inside the convex hull; denser clouds are thinned [-]
_STABLE = 0.01  # largest volume change of the skin for a ball larger by `_GROWTH` [-]
_GROWTH = 1.5  # factor between the radii of tried balls [-]
_COVERED = 0.95  # smallest fraction of points in the skin [-]
_BOTTOM = 0.02  # largest height of the rim of an open bottom / height of the body [-]
_EMPTY = 0.2  # smallest fraction of the plan without points at an open bottom [-]
_SECTORS = 24  # number of sectors of the plan in which the rim has its lowest point [-]
_JIGGLE = 1e-7  # size of the random shift that prevents coplanar and cospherical points / size of the body [-]
_CRUMB = 1e-2  # largest volume of a removed separate group of cells / volume of the largest group [-]
_OPPOSITE = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])  # vertices of the face opposite to each vertex


def surface_around_points(points: FloatArray, surface: SurfaceSource, log: RepairLog) -> tuple[FloatArray, IntArray]:
    """Return a closed, oriented surface around points."""
    points = points if surface == "hull" else _with_bottom(points, log)
    hull = _hull(points)
    if surface == "hull":
        log.add_note(Message("used the convex hull of {number} points; hollows are filled", {"number": len(points)}))
        return points, hull
    kept = _thinned(points, np.unique(hull))
    count, points = len(points), points[kept]
    faces, volume, wider, radius = _wrapped(points)
    half = np.union1d(np.arange(0, len(kept), 2), np.searchsorted(kept, np.unique(hull)))
    coarse = 2.0 * abs(volume - _wrapped(points[half])[1]) + wider - volume
    depth, area = _depth(points, faces)
    number = Message("{number} of {total}", {"number": len(kept), "total": count}) if len(kept) < count else len(kept)
    log.add_note(
        Message(
            "used a skin around {number} points (ball diameter {diameter:.3g} mm); mean depth of the points below the "
            "skin: {depth:.2g} mm; possible volume change with a larger ball and twice as many points: {share}",
            {
                "number": number,
                "diameter": 2000.0 * radius,
                "depth": 1000.0 * depth,
                "share": percent(coarse / volume),
            },
        ),
        coarse + area * depth,
    )
    return points, faces


def _depth(points: FloatArray, faces: IntArray) -> tuple[float, float]:
    """Return the mean depth of points below a skin, along the normals of its nearest corners [m], and its area [m2]."""
    from scipy.spatial import cKDTree

    vectors = area_vectors(points[faces])
    normals = np.stack([np.bincount(faces.ravel(), np.repeat(v, 3), len(points)) for v in vectors.T], axis=1)
    corners = np.flatnonzero(normals.any(axis=1))
    nearest = corners[cKDTree(points[corners]).query(points)[1]]
    unit = normals[nearest] / np.linalg.norm(normals[nearest], axis=1)[:, None]
    depth = np.maximum(((points[nearest] - points) * unit).sum(axis=1), 0.0)
    return float(depth.mean()), float(np.linalg.norm(vectors, axis=1).sum())


def _with_bottom(points: FloatArray, log: RepairLog) -> FloatArray:
    """Return the points, with a horizontal grid at the lowest point in an empty bottom."""
    from scipy.spatial import Delaunay, QhullError, cKDTree

    low, height = points[:, 2].min(), np.ptp(points[:, 2])
    rim = points[points[:, 2] < low + _BOTTOM * height]
    plan, step = rim[:, :2], 1.5 * _spacing(points)
    try:
        within = Delaunay(plan)
    except (QhullError, ValueError):  # the rim is a line or a point
        return points
    sides = [np.arange(start, end, step) for start, end in zip(plan.min(axis=0), plan.max(axis=0), strict=True)]
    grid = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
    grid = grid[within.find_simplex(grid) >= 0]
    empty = np.asarray(cKDTree(plan).query(grid)[0]) > 2.0 * step if len(grid) else np.zeros(1)
    if empty.mean() < _EMPTY:
        return points
    floor = np.concatenate([plan, grid])
    arms = plan - plan.mean(axis=0)
    sector = ((np.arctan2(arms[:, 1], arms[:, 0]) / (2.0 * np.pi) + 0.5) * _SECTORS).astype(np.int64) % _SECTORS
    lowest = np.full(_SECTORS, np.inf)
    np.minimum.at(lowest, sector, rim[:, 2] - low)
    depth = float(lowest[np.isfinite(lowest)].mean())
    log.add_repair(
        Message(
            "closed the open bottom, {width:.3g} m wide, by a horizontal face at its lowest point",
            {"width": box_diagonal(plan)},
        ),
        depth * len(grid) * step**2,
        np.append(plan.mean(axis=0), low),
    )
    return np.unique(np.concatenate([points, np.column_stack([floor, np.full(len(floor), low)])]), axis=0)


def _spacing(points: FloatArray) -> float:
    """Return the 95 % quantile of the distance to the nearest point [m]."""
    from scipy.spatial import cKDTree

    return float(np.quantile(np.asarray(cKDTree(points).query(points, 2)[0])[:, 1], 0.95))


def _hull(points: FloatArray) -> IntArray:
    """Return the outward faces of the convex hull."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        convex_hull = ConvexHull(points)
    except QhullError as error:
        raise GeometryError("The points are coplanar, collinear or equal, and enclose no volume.") from error
    return oriented_along(points, convex_hull.simplices.astype(np.int64), convex_hull.equations[:, :3])


def _thinned(points: FloatArray, keep: IntArray) -> IntArray:
    """Return the indices of one point per grid cell, and of all points to keep."""
    kept, cell = np.unique(points, axis=0, return_index=True)[1], 1e-3 * largest_extent(points)
    while len(kept) > MOST_POINTS:
        kept = np.unique(np.floor(points / cell), axis=0, return_index=True)[1]
        cell *= 1.2
    return np.union1d(kept, keep)


def _wrapped(points: FloatArray) -> tuple[IntArray, float, float, float]:
    """Return faces and volume of a skin, the volume with a larger ball, and the radius of the ball."""
    # The skin is the hull without the cells that a ball reaches from outside. The ball enters a Delaunay tetrahedron
    # through a face with a circumcircle larger than the ball (J.-D. Boissonnat, "Geometric structures for
    # three-dimensional shape representation", 1984). The radius is the smallest with nearly all points in the skin, and
    # with a volume change below 1 % for a radius larger by half.
    from scipy.spatial import Delaunay

    size = largest_extent(points)
    # a small random shift avoids coplanar and cospherical points
    points = points + _JIGGLE * size * np.random.default_rng(0).uniform(-1.0, 1.0, points.shape)
    cells = Delaunay(points)
    corners, across = cells.simplices.astype(np.int64), cells.neighbors.astype(np.int64)
    sides = corners[:, _OPPOSITE]  # four faces of each cell
    gate = _circle(points[sides])
    first = points[corners[:, 0]]
    volumes = np.abs(np.linalg.det(points[corners[:, 1:]] - first[:, None])) / 6.0
    radius = _spacing(points)
    wider = before = _inside(across, gate, radius)
    while radius < size:
        wider = _inside(across, gate, _GROWTH * radius)
        covered = len(np.unique(corners[before])) >= _COVERED * len(points)
        if covered and volumes[before].sum() >= (1.0 - _STABLE) * volumes[wider].sum():
            break
        radius, before = _GROWTH * radius, wider
    before = _without_crumbs(before, across, volumes)
    volume = float(volumes[before].sum())
    return _boundary(points, corners, sides, across, before), volume, float(volumes[wider].sum()), radius


def _circle(triangles: FloatArray) -> FloatArray:
    """Return the circumradii of triangles."""
    a, b, c = np.moveaxis(triangles, -2, 0)
    product = np.linalg.norm(b - a, axis=-1) * np.linalg.norm(c - b, axis=-1) * np.linalg.norm(a - c, axis=-1)
    twice = np.linalg.norm(np.cross(b - a, c - a), axis=-1)
    radii: FloatArray = np.divide(product, 2.0 * twice, out=np.full(product.shape, np.inf), where=twice > 0.0)
    return radii


def _inside(across: IntArray, gate: FloatArray, radius: float) -> BoolArray:
    """Return True for cells that a ball from outside does not reach."""
    cell, side = np.nonzero(gate > radius)
    next_cell = across[cell, side]
    labels = connected(len(across) + 1, cell, np.where(next_cell < 0, len(across), next_cell))
    inside: BoolArray = labels[:-1] != labels[-1]
    return inside


def _without_crumbs(inside: BoolArray, across: IntArray, volumes: FloatArray) -> BoolArray:
    """Return True for cells inside, but not for cells in small separate groups."""
    cell, side = np.nonzero(inside[:, None] & (across >= 0) & inside[across])
    labels = connected(len(across), cell, across[cell, side])
    room = np.bincount(labels, weights=np.where(inside, volumes, 0.0))
    kept: BoolArray = inside & (room > _CRUMB * room.max())[labels]
    return kept


def _boundary(points: FloatArray, corners: IntArray, sides: IntArray, across: IntArray, inside: BoolArray) -> IntArray:
    """Return the outward faces between cells inside and outside."""
    other = np.where(across < 0, False, inside[across])
    cell, side = np.nonzero(inside[:, None] & ~other)
    faces = sides[cell, side]
    return oriented_along(points, faces, points[faces[:, 0]] - points[corners[cell, side]])
