"""A map refined along its boundaries: the points that were computed, and the polylines that they lead to."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.plots.overturning_map import CLASSES, FAILED, FIRST, LATER, ROCKED, SECOND, UNLIFTED
from rocking.plots.study_words import axis_label, geometric, note, plain, plain_log
from rocking.plots.style import DOUBLE, INK, SINGLE, in_journal_style, new_figure
from rocking.studies.adaptive_grid import RefinedMap
from rocking.studies.boundaries import Polyline

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 3.2
_RASTER = 700
Window = tuple[tuple[float, float], tuple[float, float]]


@in_journal_style
def refined_map_picture(
    points: RefinedMap, boundary: Sequence[Polyline], *, window: Window | None = None, words: str = ""
) -> "Figure":
    r"""Draw a refined map: the regions, the points that were computed in the window, and the boundaries.

    Parameters
    ----------
    points : RefinedMap
        As of `refined_map`.
    boundary : sequence of Polyline
        As of `boundary` on the same axes, at least one.
    window : pair of pairs of float, optional
        Ends along x and along y of what a second panel shows larger, in the units of the axes.
    words : str
        What stands above, such as motion and restitution.

    Returns
    -------
    matplotlib.figure.Figure
        One panel, one column wide; two panels, two columns wide, with a window.

    Raises
    ------
    InvalidValueError
        If the points are of no refined map, there is no polyline, or the window is empty.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies import boundary, refined_map
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> axes = ("frequency_ratio", [1.0, 2.0, 3.0]), ("amplitude_ratio", [1.0, 2.0, 3.0])
    >>> made = refined_map(block, pulse, *axes, 0.9, levels=1), boundary(block, pulse, *axes, 0.9, levels=1)
    >>> refined_map_picture(*made).axes[0].get_xlabel()
    '$\\omega_p\\,/\\,p$ [-]'
    """
    if not isinstance(points, RefinedMap):
        raise InvalidValueError(f"points must be of refined_map, got {points!r:.60}")
    if not boundary:
        raise InvalidValueError("boundary must have at least one polyline; nothing changes over this map")
    if window is not None and not all(low < high for low, high in window):
        raise InvalidValueError(f"window must be two increasing pairs, got {window!r:.80}")
    figure, axes = new_figure(SINGLE if window is None else DOUBLE, HEIGHT, columns=1 if window is None else 2)
    whole = [(float(v[points.base].min()), float(v[points.base].max())) for v in (points.x, points.y)]
    _panel(axes[0], points, boundary, (whole[0], whole[1]), dots=False)
    new = points.modes.size - int(points.base.sum())
    told = f"{int(points.base.sum()):,} points of the map, {new:,} along its boundaries"
    note(axes[0], f"{plain(words)}; {told}" if words else told)
    if window is not None:
        _panel(axes[1], points, boundary, window, dots=True)
        _enlarged(axes, window)
    _legend(figure, points)
    return figure


def _panel(axes: "Axes", points: RefinedMap, boundary: Sequence[Polyline], window: Window, *, dots: bool) -> None:
    from matplotlib.colors import ListedColormap

    ends = [np.unique(values[points.base]) for values in (points.x, points.y)]
    scales = [geometric(values) for values in ends]
    x, y = (_fine(*pair, scale) for pair, scale in zip(window, scales, strict=True))
    colors = ListedColormap([color for _, color in CLASSES.values()])
    axes.pcolormesh(
        x, y, _nearest(points, x, y, scales), cmap=colors, vmin=-0.5, vmax=len(CLASSES) - 0.5, shading="nearest",
        rasterized=True,
    )  # fmt: skip
    axes.set_xlim(window[0])
    axes.set_ylim(window[1])
    if dots:
        axes.plot(points.x, points.y, ".", color=INK, markersize=1.3, markeredgewidth=0, rasterized=True)
    for line in boundary:
        axes.plot(*line.points.T, color=INK, linewidth=0.9, zorder=4, solid_joinstyle="round")
    for which, scale, name in zip("xy", scales, boundary[0].axes, strict=True):
        if scale:
            plain_log(axes, which)
        getattr(axes, f"set_{which}label")(axis_label(name))
    axes.spines[["top", "right"]].set_visible(True)


def _fine(low: float, high: float, scale: bool) -> FloatArray:
    return np.geomspace(low, high, _RASTER) if scale else np.linspace(low, high, _RASTER)


def _nearest(points: RefinedMap, x: FloatArray, y: FloatArray, scales: list[bool]) -> IntArray:
    """Return the class of the nearest point, distances in spacings of the map: cells as fine as the points are."""
    from scipy.spatial import cKDTree

    def measured(values: FloatArray, base: FloatArray, scale: bool) -> FloatArray:
        places = np.log(values) if scale else values
        known = np.unique(np.log(base) if scale else base)
        return np.asarray(places / np.diff(known).mean())

    bases = [values[points.base] for values in (points.x, points.y)]
    known = [measured(v, b, s) for v, b, s in zip((points.x, points.y), bases, scales, strict=True)]
    asked = [measured(v, b, s) for v, b, s in zip((x, y), bases, scales, strict=True)]
    grid = np.stack(np.meshgrid(*asked), axis=-1).reshape(-1, 2)
    _, place = cKDTree(np.stack(known, axis=1)).query(grid)
    return np.asarray(_kinds(points.modes)[place].reshape(y.size, x.size))


def _kinds(modes: IntArray) -> IntArray:
    found = np.select(
        [modes == -3, modes == -2, modes == 0, modes == 1, modes > 1],
        [FAILED, UNLIFTED, FIRST, SECOND, LATER],
        default=ROCKED,
    )
    return np.asarray(found, dtype=np.int64)


def _enlarged(axes: "list[Axes]", window: Window) -> None:
    """Show a part of the first panel in the second, and where it is."""
    from matplotlib.patches import Rectangle

    (left, right), (low, high) = window
    axes[0].add_patch(
        Rectangle(
            (left, low),
            right - left,
            high - low,
            fill=False,
            edgecolor=INK,
            linewidth=0.8,
            linestyle=(0, (3, 2)),
            zorder=5,
        )
    )
    note(axes[1], "within the dashed frame; dots: points that were computed")


def _legend(figure: "Figure", points: RefinedMap) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Patch | Line2D] = [
        Patch(facecolor=CLASSES[kind][1], edgecolor=INK, linewidth=0.5, label=CLASSES[kind][0])
        for kind in np.unique(_kinds(points.modes)).tolist()
    ]
    handles.append(Line2D([], [], color=INK, linewidth=0.9, label="boundary, bisected"))
    columns = 2 if figure.get_figwidth() < 5.0 else 3
    figure.legend(handles=handles, loc="outside lower center", ncols=columns, fontsize=6.5, handlelength=1.2)
