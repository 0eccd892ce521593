"""Which closed curves of a drawing are outlines, and which are their holes."""

from collections.abc import Sequence

import numpy as np

from rocking.bodies import topology
from rocking.conventions import FloatArray
from rocking.errors import BodyFileError

Nested = tuple[FloatArray, list[FloatArray]]


def nested(rings: Sequence[FloatArray], names: Sequence[str]) -> list[Nested]:
    """Sort rings into outlines and their holes by the even-odd rule.

    A ring inside no other or inside an even number of others is an outline; one inside an odd number is a hole of the
    innermost of them.

    rings: closed curves that do not cross, in any order and sense [m]. Returns in the order in which the outlines were
    given.

    >>> square = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    >>> [(outline, hole)] = nested([square + 1.0, 3.0 * square], ["inner", "outer"])
    >>> float(outline.max()), float(hole[0].max())
    (3.0, 2.0)
    """
    import shapely

    kept = [topology.ring(name, ring) for name, ring in zip(names, rings, strict=True)]
    for name, ring in zip(names, kept, strict=True):
        topology.check_polygon(name, ring, [])
    origin = np.min([ring.min(axis=0) for ring in kept], axis=0)
    shapes = np.array([shapely.Polygon(ring - origin) for ring in kept])
    areas = shapely.area(shapes)
    inner, outer = shapely.STRtree(shapes).query(shapely.point_on_surface(shapes), predicate="within")
    around: list[list[int]] = [[] for _ in kept]
    for i, j in zip(inner.tolist(), outer.tolist(), strict=True):
        if i < j and shapes[i].normalize().equals_exact(shapes[j].normalize(), 1e-12 * float(np.sqrt(areas[i]))):
            raise BodyFileError(f"{names[i]} and {names[j]} are the same curve drawn twice; delete one")
        # a point of a large ring may fall inside a small one in its middle: that is no nesting
        if areas[i] < areas[j] and shapes[j].covers(shapes[i]):
            around[i].append(j)
    return [
        (ring, [kept[k] for k in range(len(kept)) if _is_hole_of(k, i, around)])
        for i, ring in enumerate(kept)
        if len(around[i]) % 2 == 0
    ]


def _is_hole_of(ring: int, outline: int, around: list[list[int]]) -> bool:
    return outline in around[ring] and len(around[ring]) == len(around[outline]) + 1
