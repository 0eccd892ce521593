"""An overturning map: what overturns how, where it survives, the boundary, and the peak rotation of what survives."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import BoolArray, IntArray
from rocking.errors import InvalidValueError
from rocking.plots.contour_labels import labelled_contours
from rocking.plots.region_labels import LabelPlace, place_in, rastered
from rocking.plots.study_words import axis_label, geometric, note, plain, plain_log
from rocking.plots.style import INK, SINGLE, in_journal_style, new_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rocking.studies.boundaries import Polyline

HEIGHT = 3.3
_PANEL = (2.95, 2.55)
"""Width and height of the panel, roughly [in]."""

FAILED, UNLIFTED, ROCKED, ISLAND, FIRST, SECOND, LATER = range(7)
"""What is told apart in a map."""

CLASSES: dict[int, tuple[str, str]] = {
    FAILED: ("not computed", "#000000"),
    UNLIFTED: ("not lifted", "#FFFFFF"),
    ROCKED: ("rocks, stays standing", "#E4EFF8"),
    ISLAND: ("safe island", "#E4EFF8"),
    FIRST: ("overturns without impact", "#A8420A"),
    SECOND: ("overturns after 1 impact", "#E0812F"),
    LATER: ("overturns after 2 or more impacts", "#F0B26B"),
}
"""Words and colours: light stays standing, dark overturns, in grey too."""

_SHORT = {UNLIFTED: "", FIRST: "no impact", SECOND: "after 1 impact", LATER: "after 2 or more"}
"""Words where those of `CLASSES` do not fit."""

_LEAST = 4
"""Islands of fewer points are drawn as any survival: a coarse grid cuts a narrow channel into such pieces."""

_CONTOURS = (0.1, 0.25, 0.5, 0.75)


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
        raise InvalidValueError(f"boundary must be along {' and '.join(names)}, got {' and '.join(odd)}")
    figure, (axes,) = new_figure(SINGLE, HEIGHT)
    kinds = classes_of(found)
    draw_map(axes, found, kinds)
    bands = _contours(axes, found, contours)
    for line in boundary:
        axes.plot(line.points[:, 0], line.points[:, 1], color=INK, linewidth=0.9, zorder=4, solid_joinstyle="round")
    _labels(axes, found, kinds, bands)
    note(axes, f"{plain(found.attrs.get('motion', ''))}; restitution {plain(found.attrs.get('restitution', ''))}")
    return figure


def _axes_of(found: Any) -> tuple[str, str]:
    if not hasattr(found, "data_vars") or "mode" not in found or found["mode"].ndim != 2:
        raise InvalidValueError(f"found must be a map, a dataset with a mode over two axes, got {found!r:.60}")
    y, x = (str(name) for name in found["mode"].dims)
    if min(found.sizes[x], found.sizes[y]) < 2:
        raise InvalidValueError(f"a map must have two values or more along {x} and {y} to be drawn")
    return x, y


def classes_of(found: "xr.Dataset") -> IntArray:
    """Return what each point of a map is drawn as."""
    from rocking.studies.islands import safe_islands

    mode = np.asarray(found["mode"].values)
    kinds = np.select([mode == -3, mode == -2, mode == 0, mode == 1, mode > 1], [0, 1, 4, 5, 6], default=ROCKED)
    islands = safe_islands(found)
    wide = [island.label for island in islands.islands if island.cells >= _LEAST]
    kinds[np.isin(islands.labels, wide)] = ISLAND
    return np.asarray(kinds, dtype=np.int64)


def draw_map(axes: "Axes", found: "xr.Dataset", kinds: IntArray) -> None:
    """Draw the regions of a map, with labelled axes, logarithmic where the values grow by equal ratios."""
    from matplotlib.colors import ListedColormap

    x, y = _axes_of(found)
    colors = ListedColormap([color for _, color in CLASSES.values()])
    values = [np.asarray(found[name].values) for name in (x, y)]
    axes.pcolormesh(*values, kinds, cmap=colors, vmin=-0.5, vmax=len(CLASSES) - 0.5, shading="nearest", rasterized=True)
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
    from matplotlib.patches import Patch

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
            small.append(Patch(facecolor=color, edgecolor=INK, linewidth=0.5, label=words, hatch=hatch))
            continue
        axes.text(
            place.x, place.y, place.words, transform=axes.transAxes, ha="center", va="center", fontsize=7, zorder=5,
            color="white" if kind in {FIRST, FAILED} else INK,
        )  # fmt: skip
    if small:
        axes.figure.legend(handles=small, loc="outside lower center", ncols=2, fontsize=6.5, handlelength=1.2)


def _place(regions: Sequence[BoolArray], kind: int) -> LabelPlace | None:
    """Return where the words of a class fit best, in one line if they can."""
    for words in (CLASSES[kind][0], _SHORT.get(kind, "")):
        found = [place for region in regions if words and (place := place_in(region, words, _PANEL)) is not None]
        if found:
            return min(found, key=lambda place: place.words.count("\n"))
    return None
