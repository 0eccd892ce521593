"""Texts and numbers in a map: in regions with enough room, and on contour lines. They do not overlap borders."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.plots.style import broken

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FINE = (240, 300)  # rows and columns of the pixel grid for the search of positions

_COLOR, _BACK = "#0070B2", "#E4EFF8"
_ROOM = 0.035  # smallest distance of a number from other lines and empty areas, as a fraction of the panel [-]


@dataclass(frozen=True)
class LabelPlace:
    """Position of a text in a panel."""

    x: float  # x, y: centre, as fractions of the panel [-]
    y: float
    text: str  # the text, in one or more lines


def rastered(values: IntArray, x: FloatArray, y: FloatArray) -> IntArray:
    """Return the nearest value of a map at every pixel. The lowest row is first."""
    picks = [_nearest(coordinates, count) for coordinates, count in ((y, FINE[0]), (x, FINE[1]))]
    return np.asarray(values[np.ix_(*picks)])


def _nearest(values: FloatArray, count: int) -> IntArray:
    if values.size < 2:
        return np.zeros(count, dtype=np.int64)
    edges = 0.5 * (values[1:] + values[:-1])
    low, high = values[0] - (edges[0] - values[0]), values[-1] + (values[-1] - edges[-1])
    pixels = low + (np.arange(count) + 0.5) / count * (high - low)
    return np.asarray(np.searchsorted(edges, pixels), dtype=np.int64)


def place_in(region: BoolArray, text: str, panel: tuple[float, float], size: float = 7.0) -> LabelPlace | None:
    """Return the position of a text [pt] in a region of a panel [in] that is farthest from the border, or None."""
    from scipy import ndimage

    if not region.any():
        return None
    distance = ndimage.distance_transform_edt(np.pad(region, 1))[1:-1, 1:-1]
    for lines in (1, 2, 3):
        lettering = broken(text, lines)
        rows, columns = _box(lettering, panel, size)
        if rows >= FINE[0] or columns >= FINE[1]:
            continue
        inside = ndimage.minimum_filter(region, size=(rows, columns), mode="constant", cval=0)
        if inside.any():
            row, column = np.unravel_index(np.argmax(np.where(inside, distance, -1.0)), FINE)
            return LabelPlace((float(column) + 0.5) / FINE[1], (float(row) + 0.5) / FINE[0], lettering)
    return None


def _box(text: str, panel: tuple[float, float], size: float) -> tuple[int, int]:
    """Return the rows and columns of a text with its margin."""
    from matplotlib.textpath import TextPath

    lines = text.split("\n")
    widest = max(TextPath((0.0, 0.0), line, size=size).get_extents().width for line in lines)
    width, height = (widest + 0.9 * size) / 72.0, (1.25 * len(lines) + 0.5) * size / 72.0
    return int(np.ceil(height / panel[1] * FINE[0])), int(np.ceil(width / panel[0] * FINE[1]))


def labelled_contours(axes: "Axes", x: FloatArray, y: FloatArray, values: FloatArray, levels: Sequence[float]) -> None:
    """Draw contour lines with their numbers at the widest gap. Lines without room have no number."""
    masked = np.ma.masked_invalid(values)
    contours = axes.contour(x, y, masked, levels, colors=_COLOR, linewidths=0.6, zorder=3)
    lines = [_inside(axes, np.concatenate([path.vertices, np.empty((0, 2))])) for path in contours.get_paths()]
    columns, rows = np.meshgrid(x, y)
    empty = _inside(axes, np.stack([columns[np.isnan(values)], rows[np.isnan(values)]], axis=1))
    for number, (level, line) in enumerate(zip(levels, lines, strict=True)):
        position = _roomiest(line, np.concatenate([empty, *(other for k, other in enumerate(lines) if k != number)]))
        if position is not None:
            axes.text(
                float(position[0]), float(position[1]), f"{level:g}", transform=axes.transAxes, ha="center",
                va="center",
                fontsize=6, color=_COLOR, zorder=3.5,
                bbox={"boxstyle": "square,pad=0.1", "facecolor": _BACK, "edgecolor": "none"},
            )  # fmt: skip


def _inside(axes: "Axes", points: FloatArray) -> FloatArray:
    """Return points as fractions of the panel."""
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
