"""Figures 3 and 5 to 9 of the paper, from the measurements as printed."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.evidence.agreement import relative_error
from rocking.evidence.measurements import DataSet, datasets
from rocking.plots.curves import curve, slenderness_axis
from rocking.plots.style import DOUBLE, GREY, GROUP_STYLE, INK, SINGLE, in_journal_style, model_styles, new_figure
from rocking.restitution import model

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PAIR = ("housner", "ked")
_MARKER = {"housner": "s", "ked": "o"}


@in_journal_style
def figure_3() -> "Figure":
    """Draw slenderness against r with Table 2; bars are |r_r - r_e|, as in the paper.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.
    """
    figure, (axes,) = new_figure(SINGLE, 2.7)
    for name in _PAIR:
        curve(axes, name, 1.5, 9.0)
    _with_distance_to_ked(axes, datasets()["table2"], "s", "Table 2, means", 0.0)
    slenderness_axis(axes)
    axes.set_ylabel("coefficient of restitution r [-]")
    axes.set_ylim(0.55, 1.02)
    axes.legend(loc="lower right")
    return figure


@in_journal_style
def figure_5() -> "Figure":
    """Draw slenderness against r for the groups S, M and L; bars are |r_r - r_e|, as in Figure 3.

    Returns
    -------
    matplotlib.figure.Figure
        One panel; S and L are moved sideways a little, so that the bars can be told apart.
    """
    figure, (axes,) = new_figure(SINGLE, 2.9)
    for name in _PAIR:
        curve(axes, name, 1.3, 10.2)
    for group, aside in (("S", -0.09), ("M", 0.0), ("L", 0.09)):
        _with_distance_to_ked(axes, datasets()[group], str(GROUP_STYLE[group]["marker"]), f"group {group}", aside)
    slenderness_axis(axes)
    axes.set_ylabel("coefficient of restitution r [-]")
    axes.legend(loc="lower right")
    return figure


def _with_distance_to_ked(axes: "Axes", data: DataSet, marker: str, label: str, aside: float) -> None:
    reach = np.abs(model("ked").of_slenderness(data.slenderness) - data.coefficient)
    axes.errorbar(
        data.slenderness + aside,
        data.coefficient,
        yerr=reach,
        linestyle="none",
        marker=marker,
        markersize=3.5,
        color=INK,
        markerfacecolor=INK if aside == 0.0 else "white",
        markeredgewidth=0.7,
        capsize=1.5,
        elinewidth=0.7,
        label=label,
    )


@in_journal_style
def figure_6() -> "Figure":
    """Draw the relative errors of both models for Table 2, with the paper's zones.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.
    """
    figure, (axes,) = new_figure(SINGLE, 2.7)
    _zoned(axes, datasets()["table2"])
    axes.set_ylim(-0.4, 17.0)
    axes.legend(loc="upper right")
    return figure


@in_journal_style
def figure_7() -> "Figure":
    """Draw the relative errors of both models for the groups S, M and L.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels.
    """
    figure, axes = new_figure(DOUBLE, 2.5, columns=3, sharey=True)
    for panel, letter, group in zip(axes, "abc", ("S", "M", "L"), strict=True):
        _zoned(panel, datasets()[group])
        panel.set_title(f"({letter}) group {group}")
    axes[0].set_ylim(-0.6, 26.0)
    for panel in axes[1:]:
        panel.set_ylabel("")
    axes[-1].legend(loc="upper right")
    return figure


@in_journal_style
def figure_8() -> "Figure":
    """Draw the absolute errors r_r - r_e and r_e - r_H against mass.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.
    """
    figure, (axes,) = new_figure(SINGLE, 2.9)
    for name, sign, words in (("housner", -1.0, "$r_e - r_H$"), ("ked", 1.0, "$r_r - r_e$")):
        for group in ("S", "M", "L"):
            data = datasets()[group]
            error = sign * (model(name).of_slenderness(data.slenderness) - data.coefficient)
            color = model_styles()[name]["color"]
            axes.plot(
                data.mass,
                error,
                linestyle="none",
                marker=GROUP_STYLE[group]["marker"],
                color=color,
                markerfacecolor="white" if name == "housner" else color,
                label=f"{words}, {group}",
            )
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    axes.set_xscale("log")
    axes.set_xlabel("mass [kg]")
    axes.set_ylabel("absolute error of r [-]")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, columnspacing=1.2, handletextpad=0.2)
    return figure


@in_journal_style
def figure_9() -> "Figure":
    """Draw the relative errors at equal slenderness for the three groups and both models.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.
    """
    figure, (axes,) = new_figure(SINGLE, 2.9)
    for name in _PAIR:
        for group in ("S", "M", "L"):
            data = datasets()[group]
            error = 100.0 * relative_error(model(name).of_slenderness(data.slenderness), data.coefficient)
            look = model_styles()[name]
            axes.plot(
                data.slenderness,
                error,
                color=look["color"],
                linestyle=look["linestyle"],
                linewidth=0.9,
                marker=GROUP_STYLE[group]["marker"],
                markerfacecolor="white",
                markersize=3.5,
                label=f"{look['label']}, {group}",
            )
    slenderness_axis(axes)
    axes.set_ylabel("relative error of r [%]")
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="upper right", ncols=2, columnspacing=0.8)
    return figure


def _zoned(axes: "Axes", data: DataSet) -> None:
    for low, high, shade, name in ((0.0, 1.0, "#ececec", "I"), (1.0, 5.0, "#f7f7f7", "II")):
        axes.axhspan(low, high, color=shade, linewidth=0.0, zorder=0)
        _zone_name(axes, name, 0.5 * (low + high))
    _zone_name(axes, "III", 7.0)
    for name in _PAIR:
        error = 100.0 * relative_error(model(name).of_slenderness(data.slenderness), data.coefficient)
        look = model_styles()[name]
        axes.plot(
            data.slenderness,
            error,
            linestyle="none",
            marker=_MARKER[name],
            color=look["color"],
            label=look["label"],
            markerfacecolor="white" if name == "housner" else look["color"],
        )
    slenderness_axis(axes)
    axes.set_ylabel("relative error of r [%]")


def _zone_name(axes: "Axes", name: str, height: float) -> None:
    place = axes.get_yaxis_transform()
    axes.text(1.01, height, name, transform=place, ha="left", va="center", fontsize=7, color=GREY)
