"""Does a closed surface pass through itself? Asked of its faces, and of how often it winds round points beside them."""

from collections.abc import Callable

import numpy as np

from rocking.bodies.solid.crossings import winding
from rocking.bodies.solid.piercing import DEPTH, pierced
from rocking.bodies.solid.surfaces import area_vectors
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import GeometryError

PROBED = 500
"""Faces beside which the winding number is asked for [-]."""

_REPAIR = (
    "what it encloses is not defined: repair it in the program that made it, for instance by a boolean union or by "
    "removing self-intersections"
)


def in_metres(place: FloatArray) -> str:
    """Return a place in words.

    place: the place [m].

    >>> in_metres(np.array([0.5, 0.0, 2.0]))
    '(0.5, 0, 2) m'
    """
    return f"({', '.join(f'{round(x, 9) + 0.0:.4g}' for x in place.tolist())}) m"


def check_crossings(triangles: FloatArray, said: Callable[[FloatArray], str] = in_metres) -> bool:
    """Refuse a surface that passes through itself.

    Every pair of faces is tried, to a millionth of the size. Beside 500 faces, chosen by their area, the surface must
    wind once or not at all round points on either side: that finds lobes that are inside out and overlaps that meet in
    corners and edges of the mesh only. Not seen are such lobes where they take less than about a hundredth of the
    surface, folds within one plane, which enclose nothing, and crossings shallower than a millionth of the size.

    triangles: corners of the faces of a closed, oriented surface [m]; said: turns a place [m] into the user's words.
    Returns whether every pair of faces could be tried; False on surfaces of which tens of millions lie side by side.

    >>> from rocking.bodies.solid import box
    >>> check_crossings(box(1.0, 1.0, 4.0).corners)
    True
    """
    middle = 0.5 * (triangles.min(axis=(0, 1)) + triangles.max(axis=(0, 1)))
    centred = triangles - middle
    found = pierced(centred)
    if found.pairs:
        raise GeometryError(
            f"the surface passes through itself, most plainly near {said(middle + found.place)}; {found.pairs} pair(s) "
            f"of faces cross; {_REPAIR}"
        )
    wrong = _wrongly_wound(centred)
    if wrong is not None:
        place, times = wrong
        raise GeometryError(
            f"the surface passes through itself or is inside out in part: it winds {times} times round the point near "
            f"{said(middle + place)}, where a body has 1 and its surroundings 0; {_REPAIR}"
        )
    return found.complete


def _wrongly_wound(triangles: FloatArray) -> tuple[FloatArray, int] | None:
    points = _beside(triangles)
    times = winding(points, triangles)
    suspects = np.flatnonzero(_impossible(times))
    # a plumb line through an edge may miscount: only what all three axes say is believed
    for axes in ([1, 2, 0], [2, 0, 1]):
        if not len(suspects):
            return None
        suspects = suspects[_impossible(winding(points[suspects][:, axes], triangles[..., axes]))]
    return None if not len(suspects) else (points[suspects[0]], int(times[suspects[0]]))


def _impossible(times: FloatArray) -> BoolArray:
    found: BoolArray = (times != 0.0) & (times != 1.0)
    return found


def _beside(triangles: FloatArray) -> FloatArray:
    """Points a little inside and outside some faces, not near their edges."""
    generator = np.random.default_rng(0)
    vectors = area_vectors(triangles)
    areas = np.linalg.norm(vectors, axis=1)
    usable = np.flatnonzero(areas > 1e-12 * np.ptp(triangles, axis=(0, 1)).max() ** 2)
    count = min(PROBED, len(usable))
    chosen = generator.choice(usable, count, replace=False, p=areas[usable] / areas[usable].sum())
    shares = generator.dirichlet((4.0, 4.0, 4.0), count)
    on = np.einsum("kc,kci->ki", shares, triangles[chosen])
    # farther than what counts as touching
    off = vectors[chosen] / areas[chosen, None] * (3.0 * DEPTH * float(np.ptp(triangles, axis=(0, 1)).max()))
    return np.concatenate([on - off, on + off])
