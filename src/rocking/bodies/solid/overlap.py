"""Do two parts of a solid claim the same place? Asked at a grid of points, with the resolution stated."""

from collections.abc import Sequence

import numpy as np

from rocking.bodies.solid.part import Part
from rocking.conventions import FloatArray
from rocking.errors import GeometryError

GRID = 20
"""Points along each side of the box that two parts share; smaller overlaps than its cells may pass."""

_SLACK = 1e-9


def check_disjoint(parts: Sequence[Part]) -> None:
    """Refuse parts that overlap; shared faces are welcome.

    Two parts overlap if any of 20 x 20 x 20 points in the common box of both lies inside both.
    """
    boxes = np.array([part.box() for part in parts])
    for i in range(len(parts)):
        for j in range(i + 1, len(parts)):
            low, high = np.maximum(boxes[i, 0], boxes[j, 0]), np.minimum(boxes[i, 1], boxes[j, 1])
            if (high - low > _SLACK * np.ptp(boxes[[i, j]], axis=(0, 1)).max()).all():
                _check_pair(parts, (i, j), low, high)


def _check_pair(parts: Sequence[Part], pair: tuple[int, int], low: FloatArray, high: FloatArray) -> None:
    share = (np.arange(GRID) + 0.5) / GRID
    grid = np.stack(np.meshgrid(share, share, share, indexing="ij"), axis=-1).reshape(-1, 3)
    points = low + (high - low) * grid
    common = points[parts[pair[0]].contains(points)]
    count = int(parts[pair[1]].contains(common).sum()) if len(common) else 0
    if count:
        volume = count / GRID**3 * float((high - low).prod())
        raise GeometryError(
            f"parts {pair[0]} and {pair[1]} overlap over about {volume:.3g} m3; a solid is the sum of parts that do "
            "not share any volume: cut one where the other lies"
        )
