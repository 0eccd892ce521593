"""Pictures of long-run dynamics: bifurcation diagrams, sections, exponents, basins and branches of orbits."""

import json
from collections.abc import Container, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.plots.labels import plain
from rocking.plots.style import (
    COLORS,
    DOUBLE,
    GREY,
    INK,
    MARKS,
    PALE,
    SINGLE,
    in_journal_style,
    legend_below,
    look,
    new_figure,
    patch,
)
from rocking.quantities import quantity
from rocking.restitution import models

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FINAL_STATES = ((COLORS[1], "overturned"), (PALE, "small"), (COLORS[0], "settled"), (INK, "failed"))
_KINDS = ((3, COLORS[1], "irregular"), (2, COLORS[0], "periodic"), (1, COLORS[2], "with rests"), (0, GREY, "at rest"))
_THRESHOLDS = {
    "uplift": "uplift", "fold": "fold", "melnikov": "Melnikov", "heteroclinic": "tangency", "housner": "Housner",
    "no_impact": "no impact", "one_impact": "one impact",
}  # fmt: skip
_OF_BOUNDARIES, _FROM_REST = ("melnikov", "heteroclinic"), ("uplift", "housner", "no_impact", "one_impact")
_LABELS = {
    "amplitude_ratio": r"$a\,/\,(g\,\tan\,\alpha)$ [-]", "frequency_ratio": r"$\omega\,/\,p$ [-]",
    "slenderness_ratio": "slenderness h/b [-]", "semi_diagonal": "semi-diagonal R [m]",
    "coefficient": "coefficient of restitution r [-]", "rotation_ratio": r"$\theta\,/\,\alpha$ [-]",
    "velocity_ratio": r"$\dot\theta\,/\,(\alpha\,p)$ [-]", "ground_phase": "phase of the ground motion [rad]",
    "speed_ratio": r"speed after impact $/\,(\alpha\,p)$ [-]",
}  # fmt: skip


@in_journal_style
def bifurcation_picture(results: Any) -> "Figure":
    """Draw bifurcation diagrams: rotation once per period over the parameter, and the largest exponent.

    Parameters
    ----------
    results : xarray.Dataset or mapping
        Result of `bifurcation`, or one result per restitution by label.

    Returns
    -------
    matplotlib.figure.Figure
        One column of panels per restitution.
    """
    shown = _by_restitution(results)
    has_exponents = all("exponent" in data for data in shown.values())
    figure, columns = _panels(shown, 3.4, (2.2, 1.0)) if has_exponents else _panels(shown, 2.6)
    for data, column in zip(shown.values(), columns, strict=True):
        axis = str(data["attractor"].dims[1])
        x = data[axis].broadcast_like(data["rotation_ratio"])
        for code, color, _ in _KINDS:
            points = data["rotation_ratio"].where(data["attractor"] == code)
            options: Any = {"color": color, "rasterized": True, "zorder": 3 - code, "markersize": 0.9}
            column[0].plot(x.values.ravel(), points.values.ravel(), "o", markeredgewidth=0.0, **options)
        _mark_overturning(column[0], data, axis)
        if axis == "amplitude_ratio":
            _draw_thresholds(column[0], _thresholds_of(data, _THRESHOLDS))
        if has_exponents:
            exponent = data["exponent"].isel(period_number=0)
            largest = exponent.where(np.isfinite(exponent)).max(dim=("sweep", "initial_state"))
            largest = largest / data.attrs["frequency_parameter"]
            column[1].axhline(0.0, color=GREY, linewidth=0.6)
            column[1].plot(data[axis], largest, linewidth=0.8, color=COLORS[0])
    _label(columns, axis, _LABELS["rotation_ratio"], *["largest\nexponent / p [-]"] * has_exponents)
    legend = [*(patch(color, name) for _, color, name in _KINDS), patch(INK, "fraction overturned (top)")]
    legend_below(figure, legend, 3 if len(shown) == 1 else 5)
    return figure


def _thresholds_of(data: "xr.Dataset", names: Container[str], color: str = GREY) -> list[tuple[float, str, str]]:
    """Return value, label and colour of the thresholds in closed form of a result."""
    by_model = json.loads(data.attrs.get("thresholds", "{}"))
    thresholds = by_model.get(data.attrs.get("restitution"), {})
    return [(value, _THRESHOLDS[name], color) for name, value in thresholds.items() if name in names]


def _draw_thresholds(axes: "Axes", lines: list[tuple[float, str, str]], *, is_upright: bool = False) -> None:
    """Draw thin lines within the limits of the axis of amplitudes, with labels side by side."""
    from matplotlib.patheffects import withStroke

    low, high = axes.get_ylim() if is_upright else axes.get_xlim()
    pixels = axes.bbox.height if is_upright else axes.bbox.width
    width = (high - low) * 0.09 * axes.figure.dpi / pixels  # of a label
    end = low
    for value, label, color in sorted(line for line in lines if low < line[0] < high):
        start = max(value - width, end)
        end = start + width
        options: Any = {
            "fontsize": 5.0,
            "color": color,
            "path_effects": [withStroke(linewidth=1.2, foreground="white")],
        }
        if is_upright:
            axes.axhline(value, color=color, linewidth=0.5, linestyle=":")
            axes.text(0.99, start, label, ha="right", va="bottom", transform=axes.get_yaxis_transform(), **options)
        else:
            axes.axvline(value, color=color, linewidth=0.5, linestyle=":")
            options |= {"rotation": 90, "transform": axes.get_xaxis_transform()}
            axes.text(start, 0.99, label, ha="left", va="top", **options)


def _mark_overturning(axes: "Axes", data: "xr.Dataset", axis: str) -> None:
    """Draw a strip above the diagram with the fraction of initial states that overturn, from white to black."""
    lost = (data["attractor"].isel(period_number=0) == 4).mean(dim=("sweep", "initial_state")).values
    x = data[axis].values
    middles = 0.5 * (x[1:] + x[:-1])
    edges = np.concatenate([x[:1], middles, x[-1:]])
    options: Any = {"transform": axes.get_xaxis_transform(), "clip_on": False, "rasterized": True}
    axes.pcolormesh(edges, [1.01, 1.06], lost[None], cmap="Greys", vmin=0.0, vmax=1.0, **options)
    axes.set_xlim(x[0], x[-1])


@in_journal_style
def lyapunov_picture(results: Any) -> "Figure":
    """Draw the largest exponent of each orbit, with mean and three standard errors.

    Parameters
    ----------
    results : xarray.Dataset or mapping
        Result of `lyapunov`, or one result per restitution by label.

    Returns
    -------
    matplotlib.figure.Figure
        One row of points per restitution; one column wide.
    """
    shown = _by_restitution(results)
    figure, (axes,) = new_figure(SINGLE, 1.2 + 0.3 * len(shown))
    axes.axvline(0.0, color=GREY, linewidth=0.6)
    for row, data in enumerate(shown.values()):
        values = data["exponent"].values / data.attrs["frequency_parameter"]
        finite = values[np.isfinite(values)]
        axes.plot(finite, np.full(finite.size, row), "|", color=COLORS[0], alpha=0.5)
        if finite.size > 1:
            error = 3.0 * finite.std(ddof=1) / np.sqrt(finite.size)
            axes.errorbar(finite.mean(), row + 0.2, xerr=error, fmt="o", color=INK, markersize=3, capsize=2)
        elif not finite.size:
            text = "orbits with rests: minus infinity" if np.isneginf(values).any() else "all orbits overturn"
            axes.text(0.5, row, text, transform=axes.get_yaxis_transform(), ha="center", va="center", fontsize=7)
    axes.set_yticks(range(len(shown)), [_name(label) for label in shown])
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_xlabel("largest Lyapunov exponent / p [-]")
    return figure


@in_journal_style
def basins_picture(results: Any) -> "Figure":
    """Draw basins over phase and speed, or the erosion of basins over the amplitude.

    Parameters
    ----------
    results : xarray.Dataset or mapping
        Result of `basin`, or one result per restitution by label.

    Returns
    -------
    matplotlib.figure.Figure
        One map per restitution for one amplitude or one speed; otherwise one curve per restitution.
    """
    from rocking.studies.longrun.basins import basin_stability

    shown = _by_restitution(results)
    sizes = next(iter(shown.values())).sizes
    upward = "amplitude_ratio" if sizes["speed_ratio"] == 1 else "speed_ratio"
    if sizes["amplitude_ratio"] > 1 and upward == "speed_ratio":
        figure, (axes,) = new_figure(SINGLE, 2.4)
        for k, (label, data) in enumerate(shown.items()):
            safe, low, high = np.transpose([basin_stability(kinds) for kinds in data["final_state"].values])
            x, style = data["amplitude_ratio"], look(k)
            axes.fill_between(x, low, high, color=style["color"], alpha=0.2, lw=0)
            axes.plot(x, safe, label=_name(label), **style)
        axes.margins(x=0.0)
        colored = [(data, look(k)["color"]) for k, data in enumerate(shown.values())]
        _draw_thresholds(axes, [line for pair in colored for line in _thresholds_of(pair[0], _OF_BOUNDARIES, pair[1])])
        axes.set(xlabel=_LABELS["amplitude_ratio"], ylabel="fraction without overturning [-]", ylim=(-0.02, 1.02))
        axes.legend()
        return figure
    figure, columns = _panels(shown, 2.6)
    for data, (axes,) in zip(shown.values(), columns, strict=True):
        cells = data.transpose(upward, "ground_phase", ...)
        kinds, uncertain = (cells[name].values[..., 0] for name in ("final_state", "is_uncertain"))
        phases, heights = data["ground_phase"].values, data[upward].values
        draw_cells(axes, phases, heights, kinds)
        if upward == "amplitude_ratio":
            _draw_thresholds(axes, _thresholds_of(data, _FROM_REST, INK), is_upright=True)
        rows, across = np.nonzero(uncertain)
        axes.plot(phases[across], heights[rows], "x", color=INK, markersize=2)
    _label(columns, "ground_phase", _LABELS[upward])
    legend_below(figure, [patch(*state) for state in FINAL_STATES[:3]], 3)
    return figure


def draw_cells(axes: "Axes", phases: Any, heights: Any, kinds: Any) -> None:
    """Draw the final states of the cells of a basin, shape (heights, phases)."""
    from matplotlib.colors import ListedColormap

    options: Any = {"cmap": ListedColormap([color for color, _ in FINAL_STATES]), "vmin": -0.5, "vmax": 3.5}
    axes.pcolormesh(phases, heights, kinds, shading="nearest", rasterized=True, **options)
    axes.set_xticks([0.0, np.pi, 2.0 * np.pi], ["0", r"$\pi$", r"$2\pi$"])


@in_journal_style
def orbits_picture(results: Any) -> "Figure":
    """Draw branches of periodic orbits: speed after impact over the parameter, and their bifurcations.

    Parameters
    ----------
    results : xarray.Dataset or mapping
        Result of `periodic_orbits`, or one result per restitution by label.

    Returns
    -------
    matplotlib.figure.Figure
        One panel per restitution; stable orbits are solid, unstable ones dashed.
    """
    shown = _by_restitution(results)
    figure, columns = _panels(shown, 2.6)
    titles = quantity("branch_point").codes  # type: ignore[union-attr]
    for data, (axes,) in zip(shown.values(), columns, strict=True):
        axis = next(name for name in _LABELS if name in data.data_vars and name not in {"ground_phase", "speed_ratio"})
        for number in range(data.sizes["branch"]):
            branch = data.isel(branch=number)
            curve = branch.isel(orbit_number=np.flatnonzero(branch["branch_point"].values == 0))
            for is_stable, style in ((1, "-"), (0, (0, (3, 2)))):
                y = curve["speed_ratio"].where(curve["is_stable"] == is_stable)
                axes.plot(curve[axis], y, linestyle=style, color=COLORS[number % 6], linewidth=0.9)
        for code in list(titles)[1:]:
            points = data.where(data["branch_point"] == code)
            values = points["speed_ratio"].values.ravel()
            axes.plot(points[axis].values.ravel(), values, MARKS[code], color=INK, markersize=3.5, label=titles[code])
    _label(columns, axis, _LABELS["speed_ratio"])
    columns[0][0].legend(loc="best")
    return figure


@in_journal_style
def poincare_picture(results: Any) -> "Figure":
    """Draw Poincare sections.

    Parameters
    ----------
    results : xarray.Dataset or mapping
        Result of `poincare`, or one result per restitution by label.

    Returns
    -------
    matplotlib.figure.Figure
        One panel per restitution.
    """
    shown = _by_restitution(results)
    figure, columns = _panels(shown, 2.6)
    for data, (axes,) in zip(shown.values(), columns, strict=True):
        first, second = list(data.data_vars)[:2]
        options: Any = {"color": COLORS[0], "rasterized": True, "markersize": 0.8, "markeredgewidth": 0.0}
        axes.plot(data[first].values.ravel(), data[second].values.ravel(), "o", **options)
    _label(columns, str(first), _LABELS[str(second)])
    return figure


def _by_restitution(results: Any) -> "dict[str, xr.Dataset]":
    """Return one dataset per restitution, by label."""
    if isinstance(results, Mapping) and not hasattr(results, "data_vars"):
        return dict(results)
    if "restitution" not in results.dims:
        return {str(results.attrs.get("restitution", "")): results}
    return {
        str(label): results.sel(restitution=label).assign_attrs(restitution=str(label))
        for label in results["restitution"].values
    }


def _panels(
    shown: Mapping[str, Any], height: float, ratios: tuple[float, ...] = (1.0,), **options: Any
) -> "tuple[Figure, list[list[Axes]]]":
    """Return a figure with one column of panels per restitution, at most four side by side."""
    across = min(len(shown), 4)
    bands, rows = -(-len(shown) // across), len(ratios)
    options = {"sharex": True, "sharey": "row" if rows > 1 else True, "height_ratios": ratios * bands, **options}
    width = SINGLE if across == 1 else DOUBLE
    figure, panels = new_figure(width, height * bands, rows=rows * bands, columns=across, **options)
    grid = np.array(panels).reshape(bands, rows, across)
    columns = [list(grid[k // across, :, k % across]) for k in range(bands * across)]
    for label, column in zip(shown, columns, strict=False):
        column[-1].tick_params(labelbottom=True)
        column[0].set_title(_name(label), loc="left", y=1.06 if rows > 1 else None)
    for column in columns[len(shown) :]:
        for axes in column:
            axes.set_visible(False)
    return figure, columns[: len(shown)]


def _label(columns: "list[list[Axes]]", x: str, *y: str) -> None:
    """Label the lowest panel of each column, and all panels of the first columns."""
    for k, column in enumerate(columns):
        column[-1].set_xlabel(_LABELS[x])
        if k % 4 == 0:
            for axes, label in zip(column, y, strict=True):
                axes.set_ylabel(label)


def _name(label: str) -> str:
    return plain(models()[label].short_name if label in models() else label)
