"""Contour lines of the peak rotation, each with its number where there is most room for it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLOR, _BACK = "#0072B2", "#E4EFF8"
_ROOM = 0.035
"""Least distance of a number from other lines and from where there is nothing, in shares of the panel [-]."""


def labelled_contours(axes: "Axes", x: FloatArray, y: FloatArray, values: FloatArray, levels: Sequence[float]) -> None:
    """Draw contour lines with their numbers; a line without room for its number goes without."""
    look: dict[str, Any] = {"colors": _COLOR, "linewidths": 0.6, "zorder": 3}
    drawn = axes.contour(x, y, np.ma.masked_invalid(values), levels, **look)
    lines = [_inside(axes, np.concatenate([path.vertices, np.empty((0, 2))])) for path in drawn.get_paths()]
    columns, rows = np.meshgrid(x, y)
    empty = _inside(axes, np.stack([columns[np.isnan(values)], rows[np.isnan(values)]], axis=1))
    for number, (level, line) in enumerate(zip(levels, lines, strict=True)):
        others = np.concatenate([empty, *(other for k, other in enumerate(lines) if k != number)])
        place = _roomiest(line, others)
        if place is not None:
            axes.text(
                float(place[0]), float(place[1]), f"{level:g}", transform=axes.transAxes, ha="center", va="center",
                fontsize=6, color=_COLOR, zorder=3.5,
                bbox={"boxstyle": "square,pad=0.1", "facecolor": _BACK, "edgecolor": "none"},
            )  # fmt: skip


def _inside(axes: "Axes", points: FloatArray) -> FloatArray:
    """Return points in shares of the panel."""
    return np.asarray(axes.transAxes.inverted().transform(axes.transData.transform(points)))


def _roomiest(line: FloatArray, others: FloatArray) -> FloatArray | None:
    from scipy.spatial import cKDTree

    if not len(line):
        return None
    room = np.minimum(line, 1.0 - line).min(axis=1)
    if len(others):
        room = np.minimum(room, cKDTree(others).query(line)[0])
    best = int(np.argmax(room))
    return line[best] if room[best] > _ROOM else None
