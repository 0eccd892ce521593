"""Figures of `rocking reproduce gaibor-2026`."""

from collections.abc import Callable
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
    GaiborReproduction,
    HarmonicCase,
)
from rocking.plots.style import (
    COLORS,
    DOUBLE,
    GREY,
    INK,
    MARKS,
    PALE,
    in_journal_style,
    legend_below,
    model_styles,
    new_figure,
    patch,
    stroke,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AMPLITUDE = r"amplitude $a / (g\,\tan\alpha)$ [-]"
CELLS = ((COLORS[1], "overturned"), (PALE, "small"), (COLORS[0], "keeps rocking"), (INK, "failed"))


def gaibor_figures(result: GaiborReproduction) -> "dict[str, Callable[[], Figure]]":
    """Return the drawing function of each figure by file name."""
    figures: dict[str, Callable[[], Figure]] = {}
    for frequency in result.effort.frequencies:
        figures[f"bifurcations_{frequency:g}"] = partial(_bifurcations, result, frequency)
        figures[f"exponents_{frequency:g}"] = partial(_exponents, result, frequency)
    drawn = {"cascades": _cascades, "thresholds": _thresholds, "prevalence": _prevalence, "basins": _basins}
    return figures | {name: partial(draw, result) for name, draw in drawn.items()}


def _look(model: str, *, line: bool = True) -> dict[str, Any]:
    look = model_styles()[model]
    return {"color": look["color"], "linestyle": look["linestyle"] if line else "none"}


def _legend(figure: "Figure", *more: Any) -> None:
    handles = [stroke(model_styles()[model]["label"], **_look(model)) for model in MODELS]
    legend_below(figure, [*handles, *more], len(handles) + len(more), handlelength=2.5)


def _name(axes: "Axes", text: str) -> None:
    axes.set_title(text, loc="left", fontsize=7)


@in_journal_style
def _bifurcations(result: GaiborReproduction, frequency: float) -> "Figure":
    """Draw the attractors of all starts over the amplitude; one row per slenderness, one column per model."""
    figure, panels = new_figure(DOUBLE, 8.6, rows=len(SLENDERNESS), columns=len(MODELS), sharex=True, sharey=True)
    cases = [result.case(slenderness, model, frequency) for slenderness in SLENDERNESS for model in MODELS]
    for axes, case in zip(panels, cases, strict=True):
        axes.plot(*case.attractors.T, ".", color=_look(case.model)["color"], ms=2.0, mew=0.0, rasterized=True)
        for name, line in (("fold", ":"), ("pitchfork", "--")):
            axes.axvline(case.numbers[name], color=GREY, lw=0.6, ls=line)
        _name(axes, f"h/b = {case.slenderness}, {model_styles()[case.model]['label']}, r = {_r(case)}")
        axes.set_xlim(0.0, HIGHEST)
    for axes in panels[-len(MODELS) :]:
        axes.set_xlabel(AMPLITUDE)
    figure.supylabel(r"rotation at the ends of periods $\theta / \alpha$ [-]", fontsize=8)
    lines = [stroke("fold", color=GREY, ls=":"), stroke("loss of symmetry", color=GREY, ls="--")]
    legend_below(figure, lines, 2, handlelength=2.5)
    return figure


def _r(case: HarmonicCase) -> str:
    return f"{case.numbers['restitution']:.4f}"


@in_journal_style
def _exponents(result: GaiborReproduction, frequency: float) -> "Figure":
    """Draw the largest exponent from rest over the amplitude; one panel per slenderness."""
    figure, panels = new_figure(DOUBLE, 4.0, rows=2, columns=3, sharex=True)
    for axes, slenderness in zip(panels, SLENDERNESS, strict=True):
        for k, model in enumerate(MODELS):
            amplitude, exponent = result.case(slenderness, model, frequency).exponents.T
            axes.plot(amplitude, exponent, MARKS[k], color=_look(model)["color"], ms=1.6, mew=0.0)
        axes.axhline(0.0, color=GREY, lw=0.6)
        _name(axes, f"h/b = {slenderness}")
    for axes in panels[3:]:
        axes.set_xlabel(AMPLITUDE)
    for axes in panels[::3]:
        axes.set_ylabel(r"largest exponent $\lambda_1 / p$ [-]")
    marks = [
        stroke(model_styles()[model]["label"], color=_look(model)["color"], marker=MARKS[k], linestyle="none")
        for k, model in enumerate(MODELS)
    ]
    legend_below(figure, marks, len(marks))
    return figure


@in_journal_style
def _cascades(result: GaiborReproduction) -> "Figure":
    """Draw the attractor after the second period doubling, with its largest exponent, for the squattest body."""
    figure, panels = new_figure(DOUBLE, 3.6, rows=2, columns=len(MODELS), sharex="col", sharey="row")
    for k, model in enumerate(MODELS):
        case = result.case(SLENDERNESS[0], model, result.effort.frequencies[0])
        amplitude, rotation, exponent = case.cascade.T
        panels[k].plot(amplitude, rotation, ".", color=_look(model)["color"], ms=1.0, mew=0.0, rasterized=True)
        axes = panels[k + len(MODELS)]
        axes.plot(amplitude[::64], exponent[::64], color=_look(model)["color"], lw=0.8)
        axes.axhline(0.0, color=GREY, lw=0.6)
        axes.set_xlabel(AMPLITUDE)
        _name(panels[k], f"h/b = {case.slenderness}, {model_styles()[model]['label']}, r = {_r(case)}")
    panels[0].set_ylabel(r"rotation $\theta / \alpha$ [-]")
    panels[len(MODELS)].set_ylabel(r"largest exponent $\lambda_1 / p$ [-]")
    return figure


@in_journal_style
def _thresholds(result: GaiborReproduction) -> "Figure":
    """Draw fold, loss of symmetry and first doubling over slenderness, and differences from Housner's."""
    frequency = result.effort.frequencies[0]
    figure, (left, middle, right) = new_figure(DOUBLE, 2.7, columns=3)
    for model in MODELS:
        numbers = [result.case(slenderness, model, frequency).numbers for slenderness in SLENDERNESS]
        for axes, names in ((left, BIFURCATIONS[1:3]), (middle, BIFURCATIONS[:1])):
            for name in names:
                axes.plot(SLENDERNESS, [n[name] for n in numbers], **_look(model), marker=".")
    for k, frequency in enumerate(result.effort.frequencies):
        values = [[result.case(s, model, frequency).numbers["pitchfork"] for s in SLENDERNESS] for model in MODELS]
        for model, row in zip(MODELS[1:], values[1:], strict=True):
            gap = 100.0 * np.abs(np.divide(row, values[0]) - 1.0)
            right.loglog(SLENDERNESS, gap, **_look(model), marker=MARKS[k], ms=3.0)
    right.loglog(SLENDERNESS, 20.0 / np.array(SLENDERNESS, dtype=float) ** 4, color=GREY, lw=0.6)
    right.text(2.1, 0.2, r"$(h/b)^{-4}$", color=GREY, fontsize=7)
    right.set_xticks(SLENDERNESS, list(map(str, SLENDERNESS)))
    right.minorticks_off()
    _name(left, "loss of symmetry, first period doubling")
    _name(middle, "fold")
    _name(right, "loss of symmetry, against Housner")
    for axes in (left, middle, right):
        axes.set_xlabel("slenderness h/b [-]")
    left.set_ylabel(AMPLITUDE)
    middle.set_ylabel(AMPLITUDE)
    right.set_ylabel("difference [%]")
    marks = [
        stroke(f"frequency {value:g}", color=INK, marker=MARKS[k], linestyle="none", ms=3.0)
        for k, value in enumerate(result.effort.frequencies)
    ]
    _legend(figure, *marks)
    return figure


@in_journal_style
def _prevalence(result: GaiborReproduction) -> "Figure":
    """Draw the fraction of amplitudes with complex attractors over slenderness; bars are the counting noise."""
    frequencies = result.effort.frequencies
    figure, panels = new_figure(DOUBLE, 2.5, columns=len(frequencies), sharey=True)
    for axes, frequency in zip(panels, frequencies, strict=True):
        for k, model in enumerate(MODELS):
            masks = [result.case(slenderness, model, frequency).is_complex for slenderness in SLENDERNESS]
            shares = np.array([mask.mean() for mask in masks])
            shifted = np.array(SLENDERNESS) + 0.12 * (k - 1)
            axes.errorbar(shifted, shares, 1.0 / masks[0].size, **_look(model), marker=".", elinewidth=0.6, lw=0.8)
        axes.set_xlabel("slenderness h/b [-]")
        _name(axes, f"frequency {frequency:g} p")
    panels[0].set_ylabel("fraction of amplitudes with several periods or chaos [-]")
    _legend(figure)
    return figure


@in_journal_style
def _basins(result: GaiborReproduction) -> "Figure":
    """Draw the basins; one row per model, one column per slenderness."""
    from matplotlib.colors import BoundaryNorm, ListedColormap

    figure, panels = new_figure(DOUBLE, 4.2, rows=len(MODELS), columns=len(SLENDERNESS), sharex=True, sharey=True)
    colors = ListedColormap([color for color, _ in CELLS])
    for k, (axes, (model, slenderness)) in enumerate(
        zip(panels, [(model, slenderness) for model in MODELS for slenderness in SLENDERNESS], strict=True)
    ):
        basin = result.basins[slenderness, model]
        size = (0.0, 2.0, 0.0, basin.speed[-1] + basin.speed[0])
        axes.imshow(
            basin.kind.T, cmap=colors, norm=BoundaryNorm(np.arange(5) - 0.5, 4), extent=size, origin="lower",
            aspect="auto", interpolation="none",
        )  # fmt: skip
        _name(axes, f"h/b = {slenderness}: {100.0 * result.lost(slenderness, model):.1f} %")
        if k % len(SLENDERNESS) == 0:
            axes.set_ylabel(f"{model_styles()[model]['label']}\nspeed / ($\\alpha p$) [-]")
    for axes in panels[-len(SLENDERNESS) :]:
        axes.set_xlabel(r"phase / $\pi$ [-]")
    legend_below(figure, [patch(*cell) for cell in CELLS[:3]], 3)
    return figure


CAPTIONS = {
    "bifurcations": "Attractors over amplitude at frequency {value} p: rotation at the ends of periods, all starts.",
    "exponents": "Largest Lyapunov exponent over amplitude at frequency {value} p, from rest. A gap is a body that "
    "overturns, comes to rest or moves less than 0.01 alpha; a rest erases memory.",
    "cascades": "Attractor and largest exponent after the second period doubling, followed until it overturns.",
    "thresholds": "Loss of symmetry, first period doubling and fold over slenderness, and the difference from Housner.",
    "prevalence": "Fraction of amplitudes with an attractor of several periods or chaos. Bars: one amplitude.",
    "basins": f"Basins at amplitude {BASIN_AMPLITUDE:g} and frequency {BASIN_FREQUENCY:g} p, with the overturning "
    "fraction of the cells.",
}
"""Captions of the figures by the first word of their names."""
