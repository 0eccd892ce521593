"""Arcs as inscribed polygons, to a chord tolerance: no chord lies further from its arc than that."""

import cmath
import math
from collections.abc import Sequence

import numpy as np

from rocking.bodies.formats.source import check_count
from rocking.conventions import FloatArray
from rocking.errors import BodyFileError

FINEST = 1e-9
"""Chord tolerances below this share of a curve's size are refused: the vertices would be too many."""

_LARGEST_BULGE = 1000.0


def sides(angle: float, radius: float, tolerance: float) -> int:
    """Return how many chords an arc needs.

    angle: angle that the arc spans [rad]. Returns number of chords: at least three for a full turn [-].

    >>> sides(2.0 * math.pi, 1.0, 1e-3)
    71
    """
    if not (math.isfinite(radius) and tolerance >= FINEST * radius):
        raise BodyFileError(f"a chord tolerance of {tolerance:g} is too fine for a radius of {radius:g}")
    step = 2.0 * math.acos(max(1.0 - tolerance / radius, -0.5))
    return max(1, math.ceil(abs(angle) / step))


def closed_ellipse(centre: complex, major: complex, minor: complex, tolerance: float) -> FloatArray:
    """Return a full ellipse, or circle, as an inscribed polygon.

    Returns Vertices; n is a multiple of 4, so that the polygon has the symmetry of the ellipse.

    >>> closed_ellipse(0j, 2.0 + 0j, 1j, 1.0).tolist()[0]
    [2.0, 0.0]
    """
    # an ellipse is a stretched circle, and the stretch makes no chord error larger than on the circle of its major axis
    count = 4 * math.ceil(sides(2.0 * math.pi, abs(major), tolerance) / 4)
    angle = 2.0 * math.pi * np.arange(count) / count
    points = centre + major * np.cos(angle) + minor * np.sin(angle)
    return np.column_stack([points.real, points.imag])


def closed_polyline(points: Sequence[complex], bulges: Sequence[float], tolerance: float) -> FloatArray:
    """Return a closed polyline with its bulges flattened.

    bulges: of the segment that starts at each vertex: the tangent of a quarter of the arc's angle, above zero where the
    arc turns counter-clockwise [-].

    A square whose top is a half circle:

    >>> ring = closed_polyline([0j, 2 + 0j, 2 + 2j, 2j], [0.0, 0.0, 1.0, 0.0], tolerance=0.01)
    >>> round(float(ring[:, 1].max()), 2)
    3.0
    """
    found: list[complex] = []
    for i, (start, bulge) in enumerate(zip(points, bulges, strict=True)):
        end = points[(i + 1) % len(points)]
        found.append(start)
        if not abs(bulge) <= _LARGEST_BULGE:
            raise BodyFileError(f"the bulge at vertex {i} must be within {_LARGEST_BULGE:g}, got {bulge:g}")
        if 0.5 * abs(bulge) * abs(end - start) > tolerance:  # the arc's rise over its chord
            found += _arc(start, end, bulge, tolerance)
        check_count(len(found))
    z = np.array(found)
    return np.column_stack([z.real, z.imag])


def _arc(start: complex, end: complex, bulge: float, tolerance: float) -> list[complex]:
    chord = end - start
    centre = 0.5 * (start + end) + 0.5j * chord * (1.0 - bulge * bulge) / (2.0 * bulge)
    angle = 4.0 * math.atan(bulge)
    count = sides(angle, abs(start - centre), tolerance)
    return [centre + (start - centre) * cmath.exp(1j * angle * k / count) for k in range(1, count)]
