"""Words and numbers within a map: in the regions that they fit into, and on the contour lines, crossing no border."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.plots.style import broken

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FINE = (240, 300)  # rows and columns of the grid of pixels on which places are sought

_COLOR, _BACK = "#0070B2", "#E4EFF8"
_ROOM = 0.035  # least distance of a number from other lines and from where there is nothing, in shares of the panel [-]


@dataclass(frozen=True)
class LabelPlace:
    """Where some words fit."""

    x: float  # x, y: centre, in shares of the panel [-]
    y: float
    words: str  # the words, perhaps in two lines


def rastered(values: IntArray, x: FloatArray, y: FloatArray) -> IntArray:
    """Return the nearest value of a map at every pixel, the lowest row first."""
    picks = [_nearest(part, count) for part, count in ((y, FINE[0]), (x, FINE[1]))]
    return np.asarray(values[np.ix_(*picks)])


def _nearest(values: FloatArray, count: int) -> IntArray:
    if values.size < 2:
        return np.zeros(count, dtype=np.int64)
    edges = 0.5 * (values[1:] + values[:-1])
    low, high = values[0] - (edges[0] - values[0]), values[-1] + (values[-1] - edges[-1])
    pixels = low + (np.arange(count) + 0.5) / count * (high - low)
    return np.asarray(np.searchsorted(edges, pixels), dtype=np.int64)


def place_in(region: BoolArray, words: str, panel: tuple[float, float], size: float = 7.0) -> LabelPlace | None:
    """Return where letters of a size [pt] fit into a region of a panel [in], as far from its border as they can."""
    from scipy import ndimage

    if not region.any():
        return None
    away = ndimage.distance_transform_edt(np.pad(region, 1))[1:-1, 1:-1]
    for lines in (1, 2, 3):
        lettering = broken(words, lines)
        rows, columns = _box(lettering, panel, size)
        if rows >= FINE[0] or columns >= FINE[1]:
            continue
        inside = ndimage.minimum_filter(region, size=(rows, columns), mode="constant", cval=0)
        if inside.any():
            row, column = np.unravel_index(np.argmax(np.where(inside, away, -1.0)), FINE)
            return LabelPlace((float(column) + 0.5) / FINE[1], (float(row) + 0.5) / FINE[0], lettering)
    return None


def _box(words: str, panel: tuple[float, float], size: float) -> tuple[int, int]:
    """Return rows and columns that words take, with a margin."""
    from matplotlib.textpath import TextPath

    lines = words.split("\n")
    widest = max(TextPath((0.0, 0.0), line, size=size).get_extents().width for line in lines)
    width, height = (widest + 0.9 * size) / 72.0, (1.25 * len(lines) + 0.5) * size / 72.0
    return int(np.ceil(height / panel[1] * FINE[0])), int(np.ceil(width / panel[0] * FINE[1]))


def labelled_contours(axes: "Axes", x: FloatArray, y: FloatArray, values: FloatArray, levels: Sequence[float]) -> None:
    """Draw contour lines with their numbers where there is most room; one without room for its number goes without."""
    masked = np.ma.masked_invalid(values)
    drawn = axes.contour(x, y, masked, levels, colors=_COLOR, linewidths=0.6, zorder=3)
    lines = [_inside(axes, np.concatenate([path.vertices, np.empty((0, 2))])) for path in drawn.get_paths()]
    columns, rows = np.meshgrid(x, y)
    empty = _inside(axes, np.stack([columns[np.isnan(values)], rows[np.isnan(values)]], axis=1))
    for number, (level, line) in enumerate(zip(levels, lines, strict=True)):
        place = _roomiest(line, np.concatenate([empty, *(other for k, other in enumerate(lines) if k != number)]))
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
