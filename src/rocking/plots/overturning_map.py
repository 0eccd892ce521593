"""Pictures of overturning maps (modes, safe islands, boundary, peaks), on a grid or refined along the boundary."""

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

FAILED, UNLIFTED, ROCKED, ISLAND, FIRST, SECOND, LATER, FELL = range(8)  # classes of a map

CLASSES: dict[int, tuple[str, str]] = {
    FAILED: ("not computed", "#000000"),
    UNLIFTED: ("no uplift", "#FFFFFF"),
    ROCKED: ("rocks, does not overturn", "#E4EFF8"),
    ISLAND: ("safe island", "#E4EFF8"),
    FIRST: ("overturns without impact", "#A8420A"),
    SECOND: ("overturns after 1 impact", "#E0812F"),
    LATER: ("overturns after 2 or more impacts", "#F0B26B"),
    FELL: ("overturns", "#E0812F"),
}
"""Names and colours of classes. Colours are light without overturning and dark with overturning, even in grey."""

_SHORT = {UNLIFTED: "", FIRST: "no impact", SECOND: "after 1 impact", LATER: "after 2 or more"}
"""Short names for regions without room for the names in `CLASSES`."""

_CONTOURS = (0.1, 0.25, 0.5, 0.75)
_BOUNDARY: dict[str, Any] = {"color": INK, "linewidth": 0.9, "zorder": 4, "solid_joinstyle": "round"}


@in_journal_style
def overturning_map_picture(
    results: "xr.Dataset", boundary: Sequence["Polyline"] = (), *, contours: Sequence[float] = _CONTOURS
) -> "Figure":
    r"""Draw an overturning map.

    Parameters
    ----------
    results : xarray.Dataset
        Result of `overturning_map`.
    boundary : sequence of Polyline
        Result of `boundary` along the same axes. It is plotted over the map.
    contours : sequence of float
        Peak rotations / alpha of the contour lines [-].

    Returns
    -------
    matplotlib.figure.Figure
        One panel, one column wide.

    Raises
    ------
    InvalidValueError
        If the dataset is not a map, or the boundary has other axes.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies._overturning_map import overturning_map
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> axes = ("frequency_ratio", [1.0, 2.0, 3.0]), ("amplitude_ratio", [1.0, 2.0, 3.0])
    >>> overturning_map_picture(overturning_map(block, pulse, *axes, 0.9)).axes[0].get_xlabel()
    '$\\omega_p\\,/\\,p$ [-]'
    """
    names = _axes_of(results)
    other_axes = next((line.axes for line in boundary if line.axes != names), None)
    if other_axes is not None:
        raise InvalidValueError(
            "{parameter} must be along {axes}, got {others}", parameter="boundary", axes=" and ".join(names),
            others=" and ".join(other_axes),
        )  # fmt: skip
    figure, (axes,) = new_figure(SINGLE, _HEIGHT)
    kinds = classes_of(results)
    draw_map(axes, results, kinds)
    bands = _contours(axes, results, contours)
    for line in boundary:
        axes.plot(*line.points.T, **_BOUNDARY)
    _labels(axes, results, kinds, bands)
    note(axes, f"{plain(results.attrs.get('motion', ''))}; restitution {plain(results.attrs.get('restitution', ''))}")
    return figure


def _axes_of(results: Any) -> tuple[str, str]:
    if not hasattr(results, "data_vars") or "mode" not in results or results["mode"].ndim != 2:
        raise InvalidValueError(
            parameter="results", allowed="a map, a dataset with a mode over two axes", value=results
        )
    y, x = (str(name) for name in results["mode"].dims)
    if min(results.sizes[x], results.sizes[y]) < 2:
        raise InvalidValueError("a map must have two or more values along {x} and {y} for a picture", x=x, y=y)
    return x, y


def classes_of(results: "xr.Dataset") -> IntArray:
    """Return the class of every point of a map."""
    from rocking.studies.islands import safe_islands

    kinds = _kinds(np.asarray(results["mode"].values))
    islands = safe_islands(results)
    kinds[islands.labels > 0] = ISLAND
    return kinds


def _kinds(mode: IntArray) -> IntArray:
    cases = [mode == -3, mode == -2, mode == 0, mode == 1, mode == UNCOUNTED, mode > 1]
    kinds = np.select(cases, [FAILED, UNLIFTED, FIRST, SECOND, FELL, LATER], default=ROCKED)
    return np.asarray(kinds, dtype=np.int64)


def class_patches(kinds: Iterable[IntArray]) -> "list[Patch]":
    """Return the legend of all classes in maps."""
    present = sorted({int(kind) for classes in kinds for kind in np.unique(classes)})
    return [patch(CLASSES[kind][1], CLASSES[kind][0], edgecolor=INK, linewidth=0.5) for kind in present]


def _mesh(axes: "Axes", x: FloatArray, y: FloatArray, kinds: IntArray) -> None:
    from matplotlib.colors import ListedColormap

    colors = ListedColormap([color for _, color in CLASSES.values()])
    axes.pcolormesh(x, y, kinds, cmap=colors, vmin=-0.5, vmax=len(CLASSES) - 0.5, shading="nearest", rasterized=True)


def draw_map(axes: "Axes", results: "xr.Dataset", kinds: IntArray) -> None:
    """Draw the regions of a map, with labelled axes. Axes with equal ratios are logarithmic."""
    x, y = _axes_of(results)
    values = [np.asarray(results[name].values) for name in (x, y)]
    _mesh(axes, values[0], values[1], kinds)
    linear = bool(results.attrs.get("setting_linear", 0))
    axes.set_xlabel(axis_label(x, results[x].attrs.get("units", "1"), linear=linear))
    axes.set_ylabel(axis_label(y, results[y].attrs.get("units", "1"), linear=linear))
    for which, coordinates in zip("xy", values, strict=True):
        if geometric(coordinates):
            plain_log(axes, which)
    if (kinds == ISLAND).any():
        dots: Any = {"colors": "none", "hatches": ["......"]}
        axes.contourf(*values, (kinds == ISLAND).astype(float), [0.5, 1.5], **dots)
    axes.spines[["top", "right"]].set_visible(True)


def _contours(axes: "Axes", results: "xr.Dataset", levels: Sequence[float]) -> IntArray:
    """Draw contours of the peak rotation without overturning. Return the band of every point."""
    x, y = _axes_of(results)
    peak = np.where(np.isin(results["mode"].values, (-2, -1)), np.asarray(results["peak_ratio"].values), np.nan)
    finite = peak[np.isfinite(peak)]
    shown_levels = [level for level in levels if finite.size and finite.min() < level < finite.max()]
    if shown_levels:
        labelled_contours(axes, np.asarray(results[x].values), np.asarray(results[y].values), peak, shown_levels)
    return np.asarray(np.digitize(np.nan_to_num(peak, nan=-1.0), [0.0, *shown_levels]), dtype=np.int64)


def _labels(axes: "Axes", results: "xr.Dataset", kinds: IntArray, bands: IntArray) -> None:
    """Write names into the regions. A legend below names small regions."""
    x, y = (np.asarray(results[name].values) for name in _axes_of(results))
    x, y = (np.log(coordinates) if geometric(coordinates) else coordinates for coordinates in (x, y))
    class_raster, band_raster = rastered(kinds, x, y), rastered(bands, x, y)
    handles = []
    for kind in np.unique(kinds).tolist():
        bands_of_class = np.unique(band_raster[class_raster == kind]) if kind in {ROCKED, ISLAND} else [None]
        label = _place([(class_raster == kind) & ((band_raster == b) | (b is None)) for b in bands_of_class], kind)
        if label is None:
            text, color = CLASSES[kind]
            hatch = "......" if kind == ISLAND else None
            handles.append(patch(color, text, edgecolor=INK, linewidth=0.5, hatch=hatch))
            continue
        axes.text(
            label.x, label.y, label.text, transform=axes.transAxes, ha="center", va="center", fontsize=7, zorder=5,
            color="white" if kind in {FIRST, FAILED} else INK,
        )  # fmt: skip
    if handles:
        legend_below(axes.figure, handles, 2)  # type: ignore[arg-type]


def _place(regions: Sequence[BoolArray], kind: int) -> LabelPlace | None:
    """Return the best position of the name of a class, preferably on one line."""
    for text in (CLASSES[kind][0], _SHORT.get(kind, "")):
        labels = [label for region in regions if text and (label := place_in(region, text, _PANEL)) is not None]
        if labels:
            return min(labels, key=lambda label: label.text.count("\n"))
    return None


@in_journal_style
def refined_map_picture(
    points: "RefinedMap", boundary: "Sequence[Polyline]", *, window: "Window | None" = None, title: str = ""
) -> "Figure":
    r"""Draw a refined map: regions, computed points in a window, and boundaries.

    Parameters
    ----------
    points : RefinedMap
        Result of `refined_map`.
    boundary : sequence of Polyline
        One or more results of `boundary` on the same axes.
    window : pair of pairs of float, optional
        Limits along x and along y of an enlarged second panel, in the units of the axes.
    title : str
        Text above the map, such as motion and restitution.

    Returns
    -------
    matplotlib.figure.Figure
        One panel, one column wide. With a window, two panels, two columns wide.

    Raises
    ------
    InvalidValueError
        If the points are not from a refined map, there is no polyline, or the window is empty.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.studies import boundary, refined_map
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> axes = ("frequency_ratio", [1.0, 2.0, 3.0]), ("amplitude_ratio", [1.0, 2.0, 3.0])
    >>> refined = refined_map(block, pulse, *axes, 0.9, levels=1), boundary(block, pulse, *axes, 0.9, levels=1)
    >>> refined_map_picture(*refined).axes[0].get_xlabel()
    '$\\omega_p\\,/\\,p$ [-]'
    """
    from rocking.studies.adaptive_grid import RefinedMap

    checks.of_kind("points", points, RefinedMap, "of refined_map")
    if not boundary:
        raise InvalidValueError("boundary must have one or more polylines; this map has no boundary")
    if window is not None and not all(low < high for low, high in window):
        raise InvalidValueError(parameter="window", allowed="two increasing pairs", value=window)
    figure, axes = new_figure(SINGLE if window is None else DOUBLE, 3.2, columns=1 if window is None else 2)
    extent = [(float(v[points.base].min()), float(v[points.base].max())) for v in (points.x, points.y)]
    _panel(axes[0], points, boundary, (extent[0], extent[1]), dots=False)
    refined_count = points.modes.size - int(points.base.sum())
    counts = f"{int(points.base.sum()):,} points of the map, {refined_count:,} along its boundaries"
    note(axes[0], f"{plain(title)}; {counts}" if title else counts)
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
    """Return the class of the nearest point. Distances are in units of the spacing of the map."""
    from scipy.spatial import cKDTree

    scaled_points, scaled_pixels = [], []
    for values, pixel_values, scale in zip((points.x, points.y), (x, y), scales, strict=True):
        coordinates, pixels = (np.log(values), np.log(pixel_values)) if scale else (values, pixel_values)
        base = np.log(values[points.base]) if scale else values[points.base]
        spacing = np.diff(np.unique(base)).mean()
        scaled_points.append(coordinates / spacing)
        scaled_pixels.append(pixels / spacing)
    grid = np.stack(np.meshgrid(*scaled_pixels), axis=-1).reshape(-1, 2)
    _, nearest = cKDTree(np.stack(scaled_points, axis=1)).query(grid)
    return np.asarray(_kinds(points.modes)[nearest].reshape(y.size, x.size))


def _enlarged(axes: "list[Axes]", window: "Window") -> None:
    """Mark the window of the second panel in the first panel."""
    from matplotlib.patches import Rectangle

    (left, right), (low, high) = window
    frame: dict[str, Any] = {"fill": False, "edgecolor": INK, "linewidth": 0.8, "linestyle": (0, (3, 2)), "zorder": 5}
    axes[0].add_patch(Rectangle((left, low), right - left, high - low, **frame))
    note(axes[1], "within the dashed frame; dots: computed points")
