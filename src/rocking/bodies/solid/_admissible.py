"""What parts of a body may not contradict: they overlap nowhere, and have moments of some mass in their box."""

from collections.abc import Sequence

import numpy as np

from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.conventions import FloatArray
from rocking.errors import GeometryError

GRID = 20  # points along each side of the box that two parts share; smaller overlaps than its cells may pass
_SHARED = 1e-9


def check_disjoint(parts: Sequence[Part]) -> None:
    """Refuse parts that overlap; shared faces are welcome."""
    # two parts overlap if any of 20 x 20 x 20 points in the common box of both lies inside both
    boxes = np.array([part.box() for part in parts])
    for i in range(len(parts)):
        for j in range(i + 1, len(parts)):
            low, high = np.maximum(boxes[i, 0], boxes[j, 0]), np.minimum(boxes[i, 1], boxes[j, 1])
            if (high - low > _SHARED * np.ptp(boxes[[i, j]], axis=(0, 1)).max()).all():
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


_SLACK = 1e-6

_CAUSE = "does its surface pass through itself, or look inward in part?"


def check_possible(parts: Sequence[Part]) -> None:
    """Refuse parts whose moments are not those of any mass inside their box and hull."""
    # The volume is above zero; the centre lies in the box, and for a mesh in the convex hull; the second moments J are
    # nowhere negative, which is the triangle inequality of the inertia ``tr(J) 1 - J``; and along each axis they are at
    # most ``m (c - low) (high - c)``, the greatest that masses between low and high with the centre c can have (R.
    # Bhatia, C. Davis, "A better bound on the variance", 2000).
    for number, part in enumerate(parts):
        words = _impossible(part.moments(), part.box()) or _out_of_hull(part)
        if words:
            raise GeometryError(f"part {number} {words}; {_CAUSE}")


def _impossible(found: SolidMoments, box: FloatArray) -> str:
    low, high = box
    slack = _SLACK * float((high - low).max())
    if not (np.isfinite(found.mass) and np.isfinite(found.centre).all() and np.isfinite(found.second).all()):
        return "has moments that are not finite"
    if found.mass <= 0.0:
        return f"has the mass {found.mass:g} kg, which must be above zero"
    if (found.centre < low - slack).any() or (found.centre > high + slack).any():
        return f"has its centre at {_at(found.centre)} m, outside its box {_at(low)} to {_at(high)} m"
    spread = np.asarray(np.linalg.eigvalsh(found.second), dtype=np.float64)
    if spread[0] < -_SLACK * abs(spread[2]) or spread[2] <= 0.0:
        return (
            f"has principal second moments {_at(spread)} kg m2, which must not be negative: its inertia breaks the "
            "triangle inequality"
        )
    most = found.mass * ((found.centre - low) * (high - found.centre) + slack * (high - low + slack))
    if (np.diag(found.second) > most).any():
        return (
            f"has second moments {_at(np.diag(found.second))} kg m2 along x, y, z, more than any mass in its box can "
            f"have, {_at(most)} kg m2"
        )
    return ""


def _out_of_hull(part: Part) -> str:
    if type(part.shape) is not Polyhedron:
        return ""
    from scipy.spatial import QhullError

    vertices, centre = part.shape.vertices, part.shape.moments().centre
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    try:
        planes = part.shape.hull.equations
    except QhullError:  # too flat for a hull: the box has spoken
        return ""
    beyond = float((planes[:, :3] @ (centre - middle) + planes[:, 3]).max())
    if beyond > _SLACK * float(np.ptp(vertices, axis=0).max()):
        return f"has its centre {beyond:.3g} m outside its convex hull"
    return ""


def _at(values: FloatArray) -> str:
    return f"({', '.join(f'{x:.4g}' for x in values.tolist())})"
