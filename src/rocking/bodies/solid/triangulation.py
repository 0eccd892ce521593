"""A polygon with holes cut into triangles between its own corners (constrained Delaunay, by GEOS)."""

from collections.abc import Sequence

import numpy as np

from rocking.conventions import FloatArray


def triangulated(outline: FloatArray, holes: Sequence[FloatArray] = ()) -> FloatArray:
    """Return counter-clockwise triangles that fill a polygon.

    outline: outer ring [m]; holes: inner rings [m]. Returns Corners, all of them corners of the polygon [m].

    >>> len(triangulated(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])))
    2
    """
    import shapely

    pieces = shapely.constrained_delaunay_triangles(shapely.Polygon(outline, holes))
    triangles = shapely.get_coordinates(shapely.get_parts(pieces)).reshape(-1, 4, 2)[:, :3]
    side, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    turned = side[:, 0] * other[:, 1] - side[:, 1] * other[:, 0] < 0.0
    ordered: FloatArray = np.where(turned[:, None, None], triangles[:, ::-1], triangles)
    return ordered
