"""Where words fit into the regions of a map: found on a grid of pixels, so that no word crosses a border."""

from dataclasses import dataclass

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray

FINE = (240, 300)
"""Rows and columns of the grid on which places are sought."""


@dataclass(frozen=True)
class LabelPlace:
    """Where some words fit."""

    x: float  # x, y: centre, in shares of the panel [-]
    y: float
    words: str  # the words, perhaps in two lines


def rastered(values: IntArray, x: FloatArray, y: FloatArray) -> IntArray:
    """Return a map as it appears on a panel, pixel by pixel.

    Returns the nearest value at every pixel, the lowest row first.
    """
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
    """Return where words fit into a region, as far from its border as they can.

    panel: width and height of the panel [in]; size: size of the letters [pt].
    """
    from scipy import ndimage

    if not region.any():
        return None
    away = ndimage.distance_transform_edt(np.pad(region, 1))[1:-1, 1:-1]
    for lines in (1, 2, 3):
        told = _broken(words, lines)
        rows, columns = _box(told, panel, size)
        if rows >= FINE[0] or columns >= FINE[1]:
            continue
        inside = ndimage.minimum_filter(region, size=(rows, columns), mode="constant", cval=0)
        if inside.any():
            row, column = np.unravel_index(np.argmax(np.where(inside, away, -1.0)), FINE)
            return LabelPlace((float(column) + 0.5) / FINE[1], (float(row) + 0.5) / FINE[0], told)
    return None


def _broken(words: str, lines: int) -> str:
    """Return words in some lines of nearly equal length."""
    from textwrap import wrap

    width = len(words) // lines
    while len(made := wrap(words, max(width, 1), break_long_words=False)) > lines:
        width += 1
    return "\n".join(made)


def _box(words: str, panel: tuple[float, float], size: float) -> tuple[int, int]:
    """Return rows and columns that words take, with a margin."""
    from matplotlib.textpath import TextPath

    lines = words.split("\n")
    widest = max(TextPath((0.0, 0.0), line, size=size).get_extents().width for line in lines)
    width, height = (widest + 0.9 * size) / 72.0, (1.25 * len(lines) + 0.5) * size / 72.0
    return int(np.ceil(height / panel[1] * FINE[0])), int(np.ceil(width / panel[0] * FINE[1]))
