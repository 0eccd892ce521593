"""Integrals over a volume from samples of its surface, refined towards a point or a line.

For a function f that is homogeneous of degree k about a point B, ``div(f s) = (k + 3) f`` with s = S - B. Therefore
``Int_V f dV = 1/(k + 3) Int_surface f (s . dA)``. A singular integrand such as x y / |s|^2 is smooth on every face
without B, and zero on every face through B.
"""

import math
from collections.abc import Callable, Iterable, Iterator

import numpy as np

from rocking.bodies.solid.surfaces import Surface
from rocking.conventions import FloatArray

Distance = Callable[[FloatArray], FloatArray]

_DIGITS = 14.5
_RATIOS = (1.0, 0.5, 0.25, 0.1, 0.03, 0.003)
_MOST_LEVELS = 80
_MOST_SAMPLES = 400_000


def gauss_order(ratio: float) -> int:
    """Return the number of Gauss points per direction of a cell from the ratio size / distance to the singular set."""
    # the integrand is analytic within a Bernstein ellipse through the singular set; with ``z = 2/ratio`` its size is
    # ``rho = z + sqrt(1 + z^2)``, and the error of a rule with n points is rho^(-2n)
    z = 2.0 / ratio
    return math.ceil(_DIGITS * math.log(10.0) / (2.0 * math.log(z + math.hypot(1.0, z))))


def samples(
    surfaces: Iterable[Surface], distance: Distance, negligible: float, bound: Distance | None = None
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield Gauss points [m] of a closed surface in batches, with weighted outward normals [m2] (shape (n, 3))."""
    # Cells are split until each is smaller than its distance to the singular set, which contains the origin.
    # `bound` is an upper bound of the integrand at points, by default 1 [-].
    for surface in surfaces:
        cells = surface.cells()
        for level in range(_MOST_LEVELS + 1):
            if not len(cells):
                break
            ratio, cone = _measured(surface, cells, distance, bound)
            ignored = cone <= negligible
            done = (ratio <= _RATIOS[0]) | ignored | (level == _MOST_LEVELS)
            yield from _by_class(surface, cells[done], np.where(ignored, _RATIOS[-1], ratio)[done])
            cells = surface.split(cells[~done])


def _measured(
    surface: Surface, cells: FloatArray, distance: Distance, bound: Distance | None
) -> tuple[FloatArray, FloatArray]:
    points, areas = surface.outline(cells)
    middle = points[:, 0]
    radius = 1.02 * np.linalg.norm(points - middle[:, None], axis=2).max(axis=1)
    distance_to_set = np.maximum(distance(middle) - radius, 0.0)
    ratio = np.divide(2.0 * radius, distance_to_set, out=np.full(len(cells), np.inf), where=distance_to_set > 0.0)
    cone = np.abs((points * areas).sum(axis=2)).max(axis=1)
    if bound is not None:
        cone = cone * bound(points.reshape(-1, 3)).reshape(points.shape[:2]).max(axis=1)
    return ratio, cone


def _by_class(surface: Surface, cells: FloatArray, ratio: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
    largest = (*_RATIOS[1:], 0.0)
    for high, low in zip(_RATIOS, largest, strict=True):
        chosen = cells[(ratio > low) & ((ratio <= high) | (high == _RATIOS[0]))]
        order = max(gauss_order(high), 3)
        step = max(1, _MOST_SAMPLES // max(order, 8) ** 2)
        for start in range(0, len(chosen), step):
            yield surface.sample(chosen[start : start + step], order)
