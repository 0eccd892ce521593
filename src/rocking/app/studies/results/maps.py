"""An overturning map, as the browser draws it."""

from typing import Any

import numpy as np

from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.results.plain import by_restitution, coordinate, meaning, plain, shares
from rocking.app.studies.results.tables import tables_of
from rocking.conventions import FloatArray
from rocking.studies.contours import chains, edge_numbers, segments


def map_result(study: OpenStudy) -> dict[str, Any]:
    """Return an overturning map.

    Returns ``x`` and ``y`` (name, values, unit, words); ``outcome``, ``mode``, ``peak`` (over alpha) and ``impacts`` by
    restitution, then rows along y; ``mode_words``; ``shares`` and ``contours`` (polylines between what overturns and
    what does not) by restitution; ``body`` and ``motion`` in words; ``tables`` of a refined map: all points (refined)
    and the vertices of the polylines (boundary).
    """
    y, x = (coordinate(study, name) for name in study.axes)
    modes = by_restitution(study, "mode")
    axes = np.asarray(x["values"], dtype=np.float64), np.asarray(y["values"], dtype=np.float64)
    about = study.job.job.study.attributes
    return {
        "x": x,
        "y": y,
        "outcome": by_restitution(study, "outcome").tolist(),
        "mode": modes.tolist(),
        "mode_words": {str(mode): meaning(mode) for mode in np.unique(modes).tolist()},
        "peak": plain(by_restitution(study, "peak_ratio")),
        "impacts": by_restitution(study, "impacts").tolist(),
        "shares": [shares(each) for each in modes],
        "contours": [contours_of(each >= 0, *axes, known=each != -3) for each in modes],
        "body": str(about.get("body", "")),
        "motion": str(about.get("motion", "")),
        "tables": {} if study.job.job.study.search is None else tables_of(study),
    }


def contours_of(
    inside: np.ndarray, x: FloatArray, y: FloatArray, known: np.ndarray | None = None
) -> list[list[list[float]]]:
    """Return the lines that part a region of a grid from the rest.

    Returns polylines of x and y, halfway between the points that they part; closed ones end where they begin.

    >>> inside = np.array([[False, False, False], [False, True, False], [False, False, False]])
    >>> (ring,) = contours_of(inside, np.arange(3.0), np.arange(3.0))
    >>> ring[0] == ring[-1], sorted(ring[1:])
    (True, [[0.5, 1.0], [1.0, 0.5], [1.0, 1.5], [1.5, 1.0]])
    """
    if min(inside.shape) < 2:
        return []
    corners = _corners(inside)
    mixed = np.flatnonzero(
        corners.any(axis=1) & ~corners.all(axis=1) & (True if known is None else _corners(known).all(axis=1))
    )
    j, i = np.divmod(mixed, inside.shape[1] - 1)
    joined = segments(corners[mixed], edge_numbers(i, j, inside.shape[1]), np.zeros(mixed.size, dtype=bool))
    return [_points(np.array(chain), x, y) for chain in chains(joined)]


def _corners(grid: np.ndarray) -> np.ndarray:
    return np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1).reshape(-1, 4)


def _points(edges: np.ndarray, x: FloatArray, y: FloatArray) -> list[list[float]]:
    """Return the middles of edges, numbered as `edge_numbers` does."""
    j, i = np.divmod(edges // 2, x.size)
    upright = edges % 2 == 1
    right = np.minimum(i + 1, x.size - 1)
    above = np.minimum(j + 1, y.size - 1)
    across = np.where(upright, x[i], 0.5 * (x[i] + x[right]))
    along = np.where(upright, 0.5 * (y[j] + y[above]), y[j])
    return np.stack([across, along], axis=-1).tolist()  # type: ignore[no-any-return]
