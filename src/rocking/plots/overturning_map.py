"""Overturning maps: what overturns how, where it survives, the boundary, the peaks; on a grid, or refined along it."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.outcome import UNCOUNTED
from rocking.plots.labels import axis_label, geometric, note, plain, plain_log
from rocking.plots.map_labels import LabelPlace, labelled_contours, place_in, rastered
from rocking.plots.style import DOUBLE, INK, SINGLE, in_journal_style, legend_below, new_figure, patch, stroke

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    from rocking.studies.adaptive_grid import RefinedMap
    from rocking.studies.boundaries import Polyline

    Window = tuple[tuple[float, float], tuple[float, float]]

_HEIGHT = 3.3
_RASTER = 700
_PANEL = (2.95, 2.55)  # width and height of the panel, roughly [in]

FAILED, UNLIFTED, ROCKED, ISLAND, FIRST, SECOND, LATER, FELL = range(8)  # what is told apart in a map

CLASSES: dict[int, tuple[str, str]] = {
    FAILED: ("not computed", "#000000"),
    UNLIFTED: ("not lifted", "#FFFFFF"),
    ROCKED: ("rocks, stays standing", "#E4EFF8"),
    ISLAND: ("safe island", "#E4EFF8"),
    FIRST: ("overturns without impact", "#A8420A"),
    SECOND: ("overturns after 1 impact", "#E0812F"),
    LATER: ("overturns after 2 or more impacts", "#F0B26B"),
    FELL: ("overturns", "#E0812F"),
}
"""Words and colours: light stays standing, dark overturns, in grey too."""

_SHORT = {UNLIFTED: "", FIRST: "no impact", SECOND: "after 1 impact", LATER: "after 2 or more"}
"""Words where those of `CLASSES` do not fit."""

_CONTOURS = (0.1, 0.25, 0.5, 0.75)
_BOUNDARY: dict[str, Any] = {"color": INK, "linewidth": 0.9, "zorder": 4, "solid_joinstyle": "round"}


@in_journal_style
def overturning_map_picture(
    found: "xr.Dataset", boundary: Sequence["Polyline"] = (), *, contours: Sequence[float] = _CONTOURS
) -> "Figure":
    r"""Draw an overturning map.

    Parameters
    ----------
    found : xarray.Dataset
        As of `overturning_map`.
    boundary : sequence of Polyline
        As of `boundary` along the same axes, drawn over the map.
    contours : sequence of float
        Peak rotations over alpha that get a line where the body survives [-].

    Returns
    -------
    matplotlib.figure.Figure
        One panel, one column wide.

    Raises
    ------
    InvalidValueError
        If it is no map, or the boundary is of other axes.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies._overturning_map import overturning_map
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> axes = ("frequency_ratio", [1.0, 2.0, 3.0]), ("amplitude_ratio", [1.0, 2.0, 3.0])
    >>> overturning_map_picture(overturning_map(block, pulse, *axes, 0.9)).axes[0].get_xlabel()
    '$\\omega_p\\,/\\,p$ [-]'
    """
    names = _axes_of(found)
    odd = next((line.axes for line in boundary if line.axes != names), None)
    if odd is not None:
        raise InvalidValueError(
            "{parameter} must be along {axes}, got {others}", parameter="boundary", axes=" and ".join(names),
            others=" and ".join(odd),
        )  # fmt: skip
    figure, (axes,) = new_figure(SINGLE, _HEIGHT)
    kinds = classes_of(found)
    draw_map(axes, found, kinds)
    bands = _contours(axes, found, contours)
    for line in boundary:
        axes.plot(*line.points.T, **_BOUNDARY)
    _labels(axes, found, kinds, bands)
    note(axes, f"{plain(found.attrs.get('motion', ''))}; restitution {plain(found.attrs.get('restitution', ''))}")
    return figure


def _axes_of(found: Any) -> tuple[str, str]:
    if not hasattr(found, "data_vars") or "mode" not in found or found["mode"].ndim != 2:
        raise InvalidValueError(parameter="found", allowed="a map, a dataset with a mode over two axes", value=found)
    y, x = (str(name) for name in found["mode"].dims)
    if min(found.sizes[x], found.sizes[y]) < 2:
        raise InvalidValueError("a map must have two values or more along {x} and {y} to be drawn", x=x, y=y)
    return x, y


def classes_of(found: "xr.Dataset") -> IntArray:
    """Return what each point of a map is drawn as."""
    from rocking.studies.islands import safe_islands

    kinds = _kinds(np.asarray(found["mode"].values))
    islands = safe_islands(found)
    kinds[islands.labels > 0] = ISLAND
    return kinds


def _kinds(mode: IntArray) -> IntArray:
    cases = [mode == -3, mode == -2, mode == 0, mode == 1, mode == UNCOUNTED, mode > 1]
    kinds = np.select(cases, [FAILED, UNLIFTED, FIRST, SECOND, FELL, LATER], default=ROCKED)
    return np.asarray(kinds, dtype=np.int64)


def class_patches(kinds: Iterable[IntArray]) -> "list[Patch]":
    """Return the legend of all classes that some maps have."""
    present = sorted({int(kind) for each in kinds for kind in np.unique(each)})
    return [patch(CLASSES[kind][1], CLASSES[kind][0], edgecolor=INK, linewidth=0.5) for kind in present]


def _mesh(axes: "Axes", x: FloatArray, y: FloatArray, kinds: IntArray) -> None:
    from matplotlib.colors import ListedColormap

    colors = ListedColormap([color for _, color in CLASSES.values()])
    axes.pcolormesh(x, y, kinds, cmap=colors, vmin=-0.5, vmax=len(CLASSES) - 0.5, shading="nearest", rasterized=True)


def draw_map(axes: "Axes", found: "xr.Dataset", kinds: IntArray) -> None:
    """Draw the regions of a map, with labelled axes, logarithmic where the values grow by equal ratios."""
    x, y = _axes_of(found)
    values = [np.asarray(found[name].values) for name in (x, y)]
    _mesh(axes, values[0], values[1], kinds)
    linear = bool(found.attrs.get("setting_linear", 0))
    axes.set_xlabel(axis_label(x, found[x].attrs.get("units", "1"), linear=linear))
    axes.set_ylabel(axis_label(y, found[y].attrs.get("units", "1"), linear=linear))
    for which, part in zip("xy", values, strict=True):
        if geometric(part):
            plain_log(axes, which)
    if (kinds == ISLAND).any():
        dots: Any = {"colors": "none", "hatches": ["......"]}
        axes.contourf(*values, (kinds == ISLAND).astype(float), [0.5, 1.5], **dots)
    axes.spines[["top", "right"]].set_visible(True)


def _contours(axes: "Axes", found: "xr.Dataset", levels: Sequence[float]) -> IntArray:
    """Draw the peak rotation where the body survives; return in which band between the lines each point lies."""
    x, y = _axes_of(found)
    peak = np.where(np.isin(found["mode"].values, (-2, -1)), np.asarray(found["peak_ratio"].values), np.nan)
    known = peak[np.isfinite(peak)]
    wanted = [level for level in levels if known.size and known.min() < level < known.max()]
    if wanted:
        labelled_contours(axes, np.asarray(found[x].values), np.asarray(found[y].values), peak, wanted)
    return np.asarray(np.digitize(np.nan_to_num(peak, nan=-1.0), [0.0, *wanted]), dtype=np.int64)


def _labels(axes: "Axes", found: "xr.Dataset", kinds: IntArray, bands: IntArray) -> None:
    """Name every region within it; a legend below names those that are too small for words."""
    x, y = (np.asarray(found[name].values) for name in _axes_of(found))
    x, y = (np.log(part) if geometric(part) else part for part in (x, y))
    fine, band = rastered(kinds, x, y), rastered(bands, x, y)
    small = []
    for kind in np.unique(kinds).tolist():
        parts = np.unique(band[fine == kind]) if kind in {ROCKED, ISLAND} else [None]
        place = _place([(fine == kind) & ((band == b) | (b is None)) for b in parts], kind)
        if place is None:
            words, color = CLASSES[kind]
            hatch = "......" if kind == ISLAND else None
            small.append(patch(color, words, edgecolor=INK, linewidth=0.5, hatch=hatch))
            continue
        axes.text(
            place.x, place.y, place.words, transform=axes.transAxes, ha="center", va="center", fontsize=7, zorder=5,
            color="white" if kind in {FIRST, FAILED} else INK,
        )  # fmt: skip
    if small:
        legend_below(axes.figure, small, 2)  # type: ignore[arg-type]


def _place(regions: Sequence[BoolArray], kind: int) -> LabelPlace | None:
    """Return where the words of a class fit best, in one line if they can."""
    for words in (CLASSES[kind][0], _SHORT.get(kind, "")):
        found = [place for region in regions if words and (place := place_in(region, words, _PANEL)) is not None]
        if found:
            return min(found, key=lambda place: place.words.count("\n"))
    return None


@in_journal_style
def refined_map_picture(
    points: "RefinedMap", boundary: "Sequence[Polyline]", *, window: "Window | None" = None, words: str = ""
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
    from rocking.studies.adaptive_grid import RefinedMap

    checks.of_kind("points", points, RefinedMap, "of refined_map")
    if not boundary:
        raise InvalidValueError("boundary must have at least one polyline; nothing changes over this map")
    if window is not None and not all(low < high for low, high in window):
        raise InvalidValueError(parameter="window", allowed="two increasing pairs", value=window)
    figure, axes = new_figure(SINGLE if window is None else DOUBLE, 3.2, columns=1 if window is None else 2)
    whole = [(float(v[points.base].min()), float(v[points.base].max())) for v in (points.x, points.y)]
    _panel(axes[0], points, boundary, (whole[0], whole[1]), dots=False)
    new = points.modes.size - int(points.base.sum())
    counts = f"{int(points.base.sum()):,} points of the map, {new:,} along its boundaries"
    note(axes[0], f"{plain(words)}; {counts}" if words else counts)
    if window is not None:
        _panel(axes[1], points, boundary, window, dots=True)
        _enlarged(axes, window)
    handles = [*class_patches([_kinds(points.modes)]), stroke("boundary, bisected", color=INK, linewidth=0.9)]
    legend_below(figure, handles, 2 if window is None else 3)
    return figure


def _panel(axes: "Axes", points: "RefinedMap", boundary: "Sequence[Polyline]", window: "Window", *, dots: bool) -> None:
    scales = [geometric(np.unique(values[points.base])) for values in (points.x, points.y)]
    x, y = (
        np.asarray((np.geomspace if scale else np.linspace)(*ends, _RASTER))
        for ends, scale in zip(window, scales, strict=True)
    )
    _mesh(axes, x, y, _nearest_kinds(points, x, y, scales))
    axes.set(xlim=window[0], ylim=window[1])
    if dots:
        axes.plot(points.x, points.y, ".", color=INK, markersize=1.3, markeredgewidth=0, rasterized=True)
    for line in boundary:
        axes.plot(*line.points.T, **_BOUNDARY)
    for which, scale, name in zip("xy", scales, boundary[0].axes, strict=True):
        if scale:
            plain_log(axes, which)
        getattr(axes, f"set_{which}label")(axis_label(name))
    axes.spines[["top", "right"]].set_visible(True)


def _nearest_kinds(points: "RefinedMap", x: FloatArray, y: FloatArray, scales: list[bool]) -> IntArray:
    """Return the class of the nearest point, distances in spacings of the map: cells as fine as the points are."""
    from scipy.spatial import cKDTree

    known, wanted = [], []
    for values, at, scale in zip((points.x, points.y), (x, y), scales, strict=True):
        places, pixels = (np.log(values), np.log(at)) if scale else (values, at)
        base = np.log(values[points.base]) if scale else values[points.base]
        spacing = np.diff(np.unique(base)).mean()
        known.append(places / spacing)
        wanted.append(pixels / spacing)
    grid = np.stack(np.meshgrid(*wanted), axis=-1).reshape(-1, 2)
    _, place = cKDTree(np.stack(known, axis=1)).query(grid)
    return np.asarray(_kinds(points.modes)[place].reshape(y.size, x.size))


def _enlarged(axes: "list[Axes]", window: "Window") -> None:
    """Show a part of the first panel in the second, and where it is."""
    from matplotlib.patches import Rectangle

    (left, right), (low, high) = window
    frame: dict[str, Any] = {"fill": False, "edgecolor": INK, "linewidth": 0.8, "linestyle": (0, (3, 2)), "zorder": 5}
    axes[0].add_patch(Rectangle((left, low), right - left, high - low, **frame))
    note(axes[1], "within the dashed frame; dots: points that were computed")
