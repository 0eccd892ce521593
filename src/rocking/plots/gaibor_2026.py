"""Figures of `rocking reproduce gaibor-2026`."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.evidence.gaibor_2026 import (
    BASIN_AMPLITUDE,
    BASIN_FREQUENCY,
    BIFURCATIONS,
    HIGHEST,
    MODELS,
    SLENDERNESS,
    TOP_SPEED,
    GaiborReproduction,
)
from rocking.plots.long_run import FINAL_STATES, draw_cells
from rocking.plots.style import (
    DOUBLE,
    GREY,
    INK,
    MARKS,
    in_journal_style,
    legend_below,
    model_styles,
    new_figure,
    patch,
    stroke,
)
from rocking.studies.longrun.basins import cells

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AMPLITUDE, EXPONENT = r"amplitude $a / (g\,\tan\alpha)$ [-]", r"largest exponent $\lambda_1 / p$ [-]"
DOTS: dict[str, Any] = {"marker": ".", "linestyle": "none", "mew": 0.0, "rasterized": True}


def gaibor_figures(result: GaiborReproduction) -> "dict[str, Callable[[], Figure]]":
    """Return the drawing function of each figure by file name."""
    figures: dict[str, Callable[[], Figure]] = {}
    for frequency in result.effort.frequencies:
        figures[f"bifurcations_{frequency:g}"] = partial(_bifurcations, result, frequency)
        figures[f"exponents_{frequency:g}"] = partial(_exponents, result, frequency)
    drawn = {"cascades": _cascades, "thresholds": _thresholds, "prevalence": _prevalence, "basins": _basins}
    return figures | {name: partial(draw, result) for name, draw in drawn.items()}


def _color(model: str) -> str:
    return str(model_styles()[model]["color"])


def _line(model: str) -> dict[str, Any]:
    return {name: model_styles()[model][name] for name in ("color", "linestyle")}


def _legend(figure: "Figure", looks: Sequence[dict[str, Any]], *more: Any) -> None:
    """Put the legend of the models below a figure."""
    handles = [stroke(model_styles()[model]["label"], **look) for model, look in zip(MODELS, looks, strict=True)]
    legend_below(figure, [*handles, *more], len(handles) + len(more), handlelength=2.5)


def _title(axes: "Axes", text: str) -> None:
    axes.set_title(text, loc="left", fontsize=7)


def _of_model(result: GaiborReproduction, slenderness: int, model: str) -> str:
    r = result.case(slenderness, model, result.effort.frequencies[0]).numbers["restitution"]
    return f"h/b = {slenderness}, {model_styles()[model]['label']}, r = {r:.4f}"


@in_journal_style
def _bifurcations(result: GaiborReproduction, frequency: float) -> "Figure":
    """Draw the attractors of all starts over the amplitude, one row per slenderness and one column per model."""
    figure, panels = new_figure(DOUBLE, 8.6, rows=len(SLENDERNESS), columns=len(MODELS), sharex=True, sharey=True)
    grid = [(slenderness, model) for slenderness in SLENDERNESS for model in MODELS]
    amplitudes = [result.case(*key, frequency).attractors[:, 0] for key in grid]
    highest = max((float(values.max()) for values in amplitudes if values.size), default=HIGHEST)
    lines = {"fold": ("fold", ":"), "pitchfork": ("loss of symmetry", "--")}
    shown = set()
    for axes, (slenderness, model) in zip(panels, grid, strict=True):
        case = result.case(slenderness, model, frequency)
        axes.plot(*case.attractors.T, color=_color(model), ms=2.0, **DOTS)
        for name, (_, style) in lines.items():
            if case.numbers[name] < highest:
                shown.add(name)
                axes.axvline(case.numbers[name], color=GREY, lw=0.6, ls=style)
        _title(axes, _of_model(result, slenderness, model))
        axes.set_xlim(0.0, 1.02 * highest)
    for axes in panels[-len(MODELS) :]:
        axes.set_xlabel(AMPLITUDE)
    figure.supylabel(r"rotation at the ends of periods $\theta / \alpha$ [-]", fontsize=8)
    handles = [stroke(label, color=GREY, ls=style) for name, (label, style) in lines.items() if name in shown]
    legend_below(figure, handles, 2, handlelength=2.5)
    return figure


@in_journal_style
def _exponents(result: GaiborReproduction, frequency: float) -> "Figure":
    """Draw the largest exponent for starts from rest over the amplitude, one panel per slenderness."""
    figure, panels = new_figure(DOUBLE, 4.0, rows=2, columns=3, sharex=True)
    looks: list[dict[str, Any]] = [
        {"color": _color(model), "marker": mark, "ls": "none"} for model, mark in zip(MODELS, MARKS, strict=False)
    ]
    for axes, slenderness in zip(panels, SLENDERNESS, strict=True):
        for model, look in zip(MODELS, looks, strict=True):
            axes.plot(*result.case(slenderness, model, frequency).exponents.T, ms=1.6, mew=0.0, **look)
        axes.axhline(0.0, color=GREY, lw=0.6)
        _title(axes, f"h/b = {slenderness}")
    for axes in panels[3:]:
        axes.set_xlabel(AMPLITUDE)
    for axes in panels[::3]:
        axes.set_ylabel(EXPONENT)
    _legend(figure, looks)
    return figure


@in_journal_style
def _cascades(result: GaiborReproduction) -> "Figure":
    """Draw the attractor after the second period doubling, with its largest exponent, for the squattest body."""
    figure, panels = new_figure(DOUBLE, 3.6, rows=2, columns=len(MODELS), sharex="col", sharey="row")
    for model, above, below in zip(MODELS, panels[: len(MODELS)], panels[len(MODELS) :], strict=True):
        case = result.case(SLENDERNESS[0], model, result.effort.frequencies[0])
        amplitude, rotation, exponent = case.cascade.T
        above.plot(amplitude, rotation, color=_color(model), ms=1.0, **DOTS)
        below.plot(amplitude[::64], exponent[::64], color=_color(model), lw=0.8)
        below.axhline(0.0, color=GREY, lw=0.6)
        below.set_xlabel(AMPLITUDE)
        below.locator_params(axis="x", nbins=4)
        _title(above, _of_model(result, SLENDERNESS[0], model))
    panels[0].set_ylabel(r"rotation $\theta / \alpha$ [-]")
    panels[len(MODELS)].set_ylabel(EXPONENT)
    return figure


@in_journal_style
def _thresholds(result: GaiborReproduction) -> "Figure":
    """Draw fold, loss of symmetry and first doubling over slenderness, and differences from Housner's model."""
    figure, (left, middle, right) = new_figure(DOUBLE, 2.7, columns=3)

    def values(name: str, model: str, frequency: float) -> list[float]:
        return [result.case(slenderness, model, frequency).numbers[name] for slenderness in SLENDERNESS]

    for model in MODELS:
        for axes, name in ((middle, BIFURCATIONS[0]), (left, BIFURCATIONS[1]), (left, BIFURCATIONS[2])):
            axes.plot(SLENDERNESS, values(name, model, result.effort.frequencies[0]), **_line(model), marker=".")
    marks = list(zip(result.effort.frequencies, MARKS, strict=False))
    for frequency, mark in marks:
        for model in MODELS[1:]:
            ratio = np.divide(values("pitchfork", model, frequency), values("pitchfork", MODELS[0], frequency))
            right.loglog(SLENDERNESS, 100.0 * np.abs(ratio - 1.0), **_line(model), marker=mark, ms=3.0)
    right.loglog(SLENDERNESS, 20.0 / np.array(SLENDERNESS, dtype=float) ** 4, color=GREY, lw=0.6)
    right.text(2.1, 0.2, r"$(h/b)^{-4}$", color=GREY, fontsize=7)
    right.set_xticks(SLENDERNESS, list(map(str, SLENDERNESS)))
    right.minorticks_off()
    _title(left, f"loss of symmetry, doubling; frequency {result.effort.frequencies[0]:g} p")
    _title(middle, f"fold; frequency {result.effort.frequencies[0]:g} p")
    _title(right, "loss of symmetry, against Housner")
    for axes, label in ((left, AMPLITUDE), (middle, AMPLITUDE), (right, "difference [%]")):
        axes.set(xlabel="slenderness h/b [-]", ylabel=label)
    more = [stroke(f"frequency {value:g}", color=INK, marker=mark, ls="none", ms=3.0) for value, mark in marks]
    _legend(figure, [_line(model) for model in MODELS], *more)
    return figure


@in_journal_style
def _prevalence(result: GaiborReproduction) -> "Figure":
    """Draw the fraction of amplitudes with complex attractors over slenderness, with bars for the counting error."""
    frequencies = result.effort.frequencies
    figure, panels = new_figure(DOUBLE, 2.5, columns=len(frequencies), sharey=True)
    for axes, frequency in zip(panels, frequencies, strict=True):
        for k, model in enumerate(MODELS):
            masks = np.array([result.case(slenderness, model, frequency).is_complex for slenderness in SLENDERNESS])
            x, noise = np.array(SLENDERNESS) + 0.12 * (k - 1), 1.0 / masks.shape[1]
            axes.errorbar(x, masks.mean(axis=1), noise, **_line(model), marker=".", elinewidth=0.6, lw=0.8)
        axes.set_xlabel("slenderness h/b [-]")
        _title(axes, f"frequency {frequency:g} p")
    panels[0].set_ylabel("fraction of amplitudes with\nseveral periods or chaos [-]")
    _legend(figure, [_line(model) for model in MODELS])
    return figure


@in_journal_style
def _basins(result: GaiborReproduction) -> "Figure":
    """Draw the basins, one row per model and one column per slenderness."""
    figure, panels = new_figure(DOUBLE, 4.2, rows=len(MODELS), columns=len(SLENDERNESS), sharex=True, sharey=True)
    grid = [(slenderness, model) for model in MODELS for slenderness in SLENDERNESS]
    for axes, (slenderness, model) in zip(panels, grid, strict=True):
        kinds = result.basins[slenderness, model]
        draw_cells(axes, *cells(len(kinds), len(kinds.T), TOP_SPEED), kinds.T)
        _title(axes, f"h/b = {slenderness}: {100.0 * result.lost(slenderness, model):.1f} %")
    for axes, model in zip(panels[:: len(SLENDERNESS)], MODELS, strict=True):
        axes.set_ylabel(f"{model_styles()[model]['label']}\nspeed / ($\\alpha p$) [-]")
    for axes in panels[-len(SLENDERNESS) :]:
        axes.set_xlabel("phase [rad]")
    legend_below(figure, [patch(*state) for state in FINAL_STATES[:3]], 3)
    return figure


CAPTIONS = {
    "bifurcations": "Attractors over amplitude at frequency {value} p: rotation at the ends of periods, all starts. "
    "Amplitudes without points: all starts overturn or come to rest.",
    "exponents": "Largest Lyapunov exponent over amplitude at frequency {value} p, from rest, over 200 periods. A gap "
    "is a body that overturns, comes to rest or moves less than 0.01 alpha; a rest erases memory.",
    "cascades": "Attractor and largest exponent after the second period doubling, followed until it overturns.",
    "thresholds": "Loss of symmetry (lower curves), first period doubling (upper curves) and fold over slenderness, "
    "and the difference from Housner.",
    "prevalence": "Fraction of amplitudes with an attractor of several periods or chaos. Bars: one amplitude.",
    "basins": f"Basins at amplitude {BASIN_AMPLITUDE:g} and frequency {BASIN_FREQUENCY:g} p, with the overturning "
    "fraction of the cells.",
}
"""Captions of the figures by the first word of their names."""
