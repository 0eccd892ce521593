"""Pictures of overturning in 3D: fraction and direction by azimuth of the ground motion and restitution model."""

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.plots.style import DOUBLE, GREY, INK, in_journal_style, model_styles, new_figure, patch

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SECTORS = 36
_DIMENSIONS = ("body", "motion", "scale", "restitution", "start")
_BOTH, _NONE, _UNKNOWN = "#BDBDBD", "white", "#222222"


@in_journal_style
def falling_picture(results: "xr.Dataset", azimuths: Any, base: Any = None) -> "Figure":
    """Draw fraction and direction of overturning by azimuth, and the differences between two restitutions.

    Parameters
    ----------
    results : xarray.Dataset
        Result of `simulate_many`: one body under one record rotated to all azimuths, at ascending scales, with two
        restitutions.
    azimuths : array_like
        Directions of the first components of the motions, from x towards y, ascending [rad].
    base : array_like, shape (n, 2), optional
        Corners of the base at any scale. They are plotted in the centre of the rose for orientation.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels, two columns wide.

    Raises
    ------
    InvalidValueError
        If there are several bodies or starts, not two restitutions, or another number of motions than azimuths.

    Examples
    --------
    >>> import rocking as rk
    >>> pulse, angles = rk.pulses.sine(amplitude=4.0, period=0.8), np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    >>> motions = [{"x": pulse.scaled(np.cos(a)), "y": pulse.scaled(np.sin(a))} for a in angles]
    >>> box = rk.dynamics.SpatialBody.box(0.5, 0.4, 2.0)
    >>> results = rk.simulate_many(box, motions, ["housner", "ked"], scale=np.linspace(0.5, 2.0, 4))
    >>> len(falling_picture(results, angles).axes)
    3
    """
    angles = checks.real_array("azimuths", azimuths, "rad")
    counts = tuple(results.sizes.get(name, 0) for name in _DIMENSIONS)
    if counts[0] != 1 or counts[4] != 1 or counts[3] != 2 or angles.shape != (counts[1],) or counts[1] < 2:
        raise InvalidValueError(
            "{parameter} must have one body and start, two restitutions and a motion for each of {size} azimuths, got "
            "({dimensions}) = {counts}", parameter="results", size=angles.size, dimensions=", ".join(_DIMENSIONS),
            counts=counts,
        )  # fmt: skip
    figure, panels = new_figure(DOUBLE, 3.1)
    panels[0].remove()
    grid = figure.add_gridspec(1, 3, width_ratios=[1.0, 1.0, 1.25])
    share = figure.add_subplot(grid[0, 0], projection="polar")
    rose = figure.add_subplot(grid[0, 1], projection="polar")
    difference = figure.add_subplot(grid[0, 2])
    _share(share, results, angles)
    _rose(rose, results, None if base is None else checks.real_array("base", base, "m"))
    _difference(difference, results, angles)
    return figure


def _look(results: "xr.Dataset", number: int) -> tuple[str, Any, str]:
    """Colour, line and label of a restitution."""
    name = str(results["restitution"].values[number])
    style = model_styles().get(name.removesuffix("-3d"), {"color": INK, "linestyle": "-", "label": f"r = {name}"})
    return style["color"], style["linestyle"], style["label"]


def _compass(axes: "Axes", letter: str, title: str) -> None:
    axes.set_title(f"{letter}  {title}", loc="left", pad=12.0)
    axes.set_xticks(np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False))
    axes.tick_params(axis="x", pad=-1.0)
    axes.grid(linewidth=0.4, color="#d5d5d5")
    axes.spines["polar"].set_linewidth(0.6)  # the only spine of a polar panel
    axes.set_axisbelow(True)
    for label in axes.get_yticklabels():
        label.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.8})
        label.set_zorder(5.0)


def _radial(axes: "Axes", top: float) -> None:
    axes.set_ylim(0.0, top)
    axes.set_yticks([0.5 * top, top], [f"{0.5 * top:g}", f"{top:g} %"])
    axes.set_rlabel_position(22.5)  # type: ignore[attr-defined]


def _share(axes: "Axes", results: "xr.Dataset", angles: FloatArray) -> None:
    with warnings.catch_warnings():  # a direction without a result has no fraction
        warnings.simplefilter("ignore", RuntimeWarning)
        fractions = results["overturned"].mean("scale").values[0, :, :, 0]
    closed = np.append(angles, angles[0] + 2.0 * np.pi)
    for k in range(2):
        color, line, label = _look(results, k)
        percentages = 100.0 * np.append(fractions[:, k], fractions[0, k])
        axes.plot(closed, percentages, linewidth=1.1, color=color, linestyle=line, label=label)
    top = max(10.0, 10.0 * np.ceil(10.0 * np.nanmax(fractions, initial=0.0)))
    _radial(axes, top)
    _compass(axes, "a", "Scales with overturning")
    axes.set_xlabel("by azimuth of the motion", labelpad=2.0)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.24), ncols=2, borderaxespad=0.0)


def _rose(axes: "Axes", results: "xr.Dataset", base: FloatArray | None) -> None:
    edges = (np.arange(_SECTORS + 1) - 0.5) * 2.0 * np.pi / _SECTORS
    maxima = []
    for k in range(2):
        overturned = results["overturned"].values[0, :, :, k, 0] == 1.0
        directions = np.mod(results["direction"].values[0, :, :, k, 0][overturned] - edges[0], 2.0 * np.pi) + edges[0]
        percentages = 100.0 * np.histogram(directions, edges)[0] / max(1, overturned.sum())
        color, line, _ = _look(results, k)
        axes.stairs(percentages, edges, fill=False, linewidth=1.1, color=color, linestyle=line)
        maxima.append(float(percentages.max()))
    top = max(5.0, 5.0 * np.ceil(max(maxima) / 5.0))
    _radial(axes, top)
    if base is not None:
        outline = np.vstack([base, base[:1]])
        size = 0.22 * top / float(np.hypot(*outline.T).max())
        turns = np.arctan2(outline[:, 1], outline[:, 0])
        stations = np.linspace(0.0, len(base), 40 * len(base) + 1)
        x, y = (np.interp(stations, np.arange(len(outline)), outline[:, i]) for i in range(2))
        axes.fill(np.arctan2(y, x), size * np.hypot(x, y), facecolor="#f0f0f0", edgecolor=GREY, linewidth=0.8, zorder=1)
        axes.plot(turns, size * np.hypot(*outline.T), linestyle="none")
        axes.annotate("base", (0.0, 0.0), ha="center", va="center", fontsize=6.0, color=GREY)
    axes.set_xlabel("fraction of overturned bodies", labelpad=2.0)
    _compass(axes, "b", "Direction, 10 degree bins")


def _difference(axes: "Axes", results: "xr.Dataset", angles: FloatArray) -> None:
    from matplotlib.colors import ListedColormap

    overturned = results["overturned"].values[0, :, :, :, 0]
    classes = np.nan_to_num(
        overturned[..., 0] + 2.0 * overturned[..., 1], nan=4.0
    )  # the class is unknown if there is no result
    looks = [_look(results, k) for k in range(2)]
    colors = [_NONE, looks[0][0], looks[1][0], _BOTH, _UNKNOWN]
    scales = results["scale"].values
    mesh = axes.pcolormesh(
        np.degrees(angles), scales, classes.T, cmap=ListedColormap(colors), vmin=-0.5, vmax=4.5, shading="nearest",
        rasterized=True,
    )  # fmt: skip
    mesh.set_edgecolor("face")
    axes.set_xticks([0, 90, 180, 270, 360])
    axes.set_xlim(np.degrees(angles[0]), np.degrees(angles[-1]))
    axes.set_xlabel("azimuth of the motion [degrees]")
    axes.set_ylabel("scale of the record [-]")
    differ = float(((classes == 1) | (classes == 2)).sum() / max(1, (classes < 4).sum()))
    axes.set_title(f"c  Outcomes: {100.0 * differ:.1f} % differ", loc="left", pad=12.0)
    labels = ["neither", f"{looks[0][2]} only", f"{looks[1][2]} only", "both", "no result"]
    present = [k for k in range(5) if (classes == k).any() or k in (1, 2)]
    handles = [patch(colors[k], labels[k], edgecolor=GREY, linewidth=0.5) for k in present]
    layout: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.22), "borderaxespad": 0.0}
    axes.legend(handles=handles, ncols=3, handlelength=1.2, columnspacing=1.0, **layout)
