"""All figures of `rocking reproduce`: figures of Mao et al.

(2024), redrawn from the printed values, and new figures.
"""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.checks import one_of
from rocking.conventions import FloatArray
from rocking.evidence._league import league
from rocking.evidence.bed_fit import explanation
from rocking.evidence.calibration import calibrate, calibrate_on
from rocking.evidence.comparison import relative_error
from rocking.evidence.measurements import DataSet, all_measurements, datasets
from rocking.plots import evidence
from rocking.plots.energy_stages import energy_stages_picture, hero
from rocking.plots.evidence import GROUP_STYLE, SLENDERNESS, R, draw_model
from rocking.plots.style import DOUBLE, GREY, INK, SINGLE, in_journal_style, model_styles, new_figure
from rocking.restitution import model

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_B, _H, _THETA = 0.5, 1.25, 0.16
_PAIR = ("housner", "ked")
_MARKER = {"housner": "s", "ked": "o"}


def paper_figure(name: str) -> "Figure":
    """Draw a figure of `rocking reproduce`.

    Parameters
    ----------
    name : str
        ``figure_1`` to ``figure_9`` (4 is a photograph), ``league``, ``models_and_measurements``, ``calibration``,
        ``bed_dependence``, ``explanations``, ``explanation_residuals``, or ``hero``, the picture of the README.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Raises
    ------
    InvalidValueError
        If there is no such figure.

    Examples
    --------
    >>> paper_figure("figure_3").axes[0].get_xlabel()
    'slenderness ratio h/b [-]'
    """
    figures = paper_figures() | {"hero": hero}
    return figures[one_of("name", name, figures)]()


def paper_figures(data: DataSet | None = None) -> "dict[str, Callable[[], Figure]]":
    """Return the drawing functions of the figures of the report by file name. `data` are measurements."""
    data = all_measurements() if data is None else data
    posterior = calibrate() if data is all_measurements() else calibrate_on(data)
    return {
        "figure_1": _figure_1,
        "figure_2": energy_stages_picture,
        "figure_3": _figure_3,
        "figure_5": _figure_5,
        "figure_6": _figure_6,
        "figure_7": _figure_7,
        "figure_8": _figure_8,
        "figure_9": _figure_9,
        "league": lambda: evidence.league_figure(league(measurements=data), len(data)),
        "models_and_measurements": lambda: evidence.models_and_measurements(posterior, data),
        "calibration": lambda: evidence.calibration_figure(posterior, data),
        "bed_dependence": evidence.bed_dependence_figure,
        "explanations": lambda: evidence.explanations_figure(explanation()),
        "explanation_residuals": lambda: evidence.residuals_figure(explanation()),
    }


@in_journal_style
def _figure_1() -> "Figure":
    """Draw the classical model (a new drawing): the block, its feet, half sizes, semi-diagonal and angles."""
    from matplotlib.patches import Arc, Polygon

    figure, (axes,) = new_figure(SINGLE, 3.3)
    corners = np.array([(0.0, 0.0), (2 * _B, 0.0), (2 * _B, 2 * _H), (0.0, 2 * _H)])
    foot = corners[1]
    c, s = math.cos(_THETA), math.sin(_THETA)
    turned = (corners - foot) @ np.array([[c, s], [-s, c]]).T + foot
    axes.add_patch(Polygon(corners, closed=True, fill=False, edgecolor=GREY, linestyle=(0, (4, 3)), linewidth=0.8))
    axes.add_patch(Polygon(turned, closed=True, facecolor="#f2f2f2", edgecolor=INK, linewidth=1.1))
    axes.plot([-0.7, 1.9], [0.0, 0.0], color=INK, linewidth=0.9)
    centre = turned.mean(axis=0)
    axes.plot(*zip(foot, centre, strict=True), color=INK, linewidth=0.9)
    axes.plot([centre[0]], [centre[1]], marker="o", color=INK, markersize=3.5)
    _text(axes, "C", centre, (5, 3))
    _text(axes, "R", 0.55 * centre + 0.45 * foot, (-11, -2))
    _text(axes, "O", corners[0], (-2, -12))
    _text(axes, "O'", foot, (2, -12))
    side = turned[2] - turned[1]
    up = foot + 1.05 * side / np.linalg.norm(side)
    axes.plot(*zip(foot, up, strict=True), color=INK, linewidth=0.0)
    alpha = math.atan2(_B, _H)
    tilt = 90.0 - math.degrees(_THETA)
    arc: dict[str, Any] = {"color": INK, "linewidth": 0.8}
    axes.add_patch(Arc(tuple(foot), 1.5, 1.5, theta1=tilt, theta2=tilt + math.degrees(alpha), **arc))
    middle = math.radians(tilt + 0.5 * math.degrees(alpha))
    _text(axes, r"$\alpha$", foot + 0.9 * np.array([math.cos(middle), math.sin(middle)]), (-3, -3))
    axes.add_patch(Arc(tuple(foot), 3.6, 3.6, theta1=tilt, theta2=90.0, **arc))
    _text(axes, r"$\theta > 0$", foot + 1.8 * np.array([math.sin(_THETA), math.cos(_THETA)]), (6, -2), align="left")
    _dimension(axes, turned[3], turned[2], "2b", 0.1, (0, 9))
    _dimension(axes, turned[3], turned[0], "2h", -0.1, (-17, -3))
    axes.annotate("", (0.55, -0.3), (0.0, -0.3), arrowprops={"arrowstyle": "-|>", **arc})
    _text(axes, "ground acceleration > 0", np.array([0.6, -0.3]), (3, -3), align="left")
    axes.set(xlim=(-0.75, 2.1), ylim=(-0.45, 3.0), aspect="equal")
    axes.axis("off")
    return figure


def _text(axes: "Axes", text: str, position: FloatArray, shift: tuple[float, float], align: str = "center") -> None:
    axes.annotate(
        text, (float(position[0]), float(position[1])), shift, textcoords="offset points", ha=align, fontsize=8
    )


def _dimension(
    axes: "Axes", a: FloatArray, b: FloatArray, text: str, outward: float, shift: tuple[float, float]
) -> None:
    offset = outward * np.array([-(b - a)[1], (b - a)[0]]) / np.linalg.norm(b - a)
    axes.annotate("", tuple(a + offset), tuple(b + offset), arrowprops={"arrowstyle": "<->", "linewidth": 0.6})
    _text(axes, text, 0.5 * (a + b) + offset, shift)


@in_journal_style
def _figure_3() -> "Figure":
    """Draw slenderness over r for Table 2. Bars are |r_r - r_e|, as in the paper."""
    figure, (axes,) = new_figure(SINGLE, 2.7)
    for name in _PAIR:
        draw_model(axes, name, 1.5, 9.0)
    _with_distance_to_ked(axes, datasets()["table2"], "s", "Table 2, means", 0.0)
    axes.set_ylim(0.55, 1.02)
    axes.legend(loc="lower right")
    return figure


@in_journal_style
def _figure_5() -> "Figure":
    """Draw slenderness over r for S, M and L, with an offset for S and L. Bars are |r_r - r_e|, as in Figure 3."""
    figure, (axes,) = new_figure(SINGLE, 2.9)
    for name in _PAIR:
        draw_model(axes, name, 1.3, 10.2)
    for group, aside in (("S", -0.09), ("M", 0.0), ("L", 0.09)):
        _with_distance_to_ked(axes, datasets()[group], str(GROUP_STYLE[group]["marker"]), f"group {group}", aside)
    axes.legend(loc="lower right")
    return figure


def _with_distance_to_ked(axes: "Axes", data: DataSet, marker: str, label: str, aside: float) -> None:
    reach = np.abs(model("ked").of_slenderness(data.slenderness) - data.coefficient)
    axes.errorbar(
        data.slenderness + aside, data.coefficient, yerr=reach, linestyle="none", marker=marker, markersize=3.5,
        color=INK, markerfacecolor=INK if aside == 0.0 else "white", markeredgewidth=0.7, capsize=1.5, elinewidth=0.7,
        label=label,
    )  # fmt: skip
    axes.set(xlabel=SLENDERNESS, ylabel=R)


@in_journal_style
def _figure_6() -> "Figure":
    """Draw the relative errors of both models for Table 2, with the zones of the paper."""
    figure, (axes,) = new_figure(SINGLE, 2.7)
    _zoned(axes, datasets()["table2"])
    axes.set_ylim(-0.4, 17.0)
    axes.legend(loc="upper right")
    return figure


@in_journal_style
def _figure_7() -> "Figure":
    """Draw the relative errors of both models for the groups S, M and L."""
    figure, axes = new_figure(DOUBLE, 2.5, columns=3, sharey=True)
    for panel, letter, group in zip(axes, "abc", "SML", strict=True):
        _zoned(panel, datasets()[group])
        panel.set_title(f"({letter}) group {group}")
    axes[0].set_ylim(-0.6, 26.0)
    for panel in axes[1:]:
        panel.set_ylabel("")
    axes[-1].legend(loc="upper right")
    return figure


@in_journal_style
def _figure_8() -> "Figure":
    """Draw the absolute errors r_r - r_e and r_e - r_H over mass."""
    figure, (axes,) = new_figure(SINGLE, 2.9)
    for name, sign, label in (("housner", -1.0, "$r_e - r_H$"), ("ked", 1.0, "$r_r - r_e$")):
        look = {"linestyle": "none", **_filled(name)}
        for group in "SML":
            data = datasets()[group]
            error = sign * (model(name).of_slenderness(data.slenderness) - data.coefficient)
            axes.plot(data.mass, error, marker=GROUP_STYLE[group]["marker"], label=f"{label}, {group}", **look)
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    axes.set_xscale("log")
    axes.set(xlabel="mass [kg]", ylabel="absolute error of r [-]")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, columnspacing=1.2, handletextpad=0.2)
    return figure


@in_journal_style
def _figure_9() -> "Figure":
    """Draw the relative errors at equal slenderness for the three groups and both models."""
    figure, (axes,) = new_figure(SINGLE, 2.9)
    for name in _PAIR:
        look = {"linewidth": 0.9, "markerfacecolor": "white", "markersize": 3.5, **model_styles()[name]}
        for group in "SML":
            look |= {"marker": GROUP_STYLE[group]["marker"], "label": f"{model_styles()[name]['label']}, {group}"}
            axes.plot(datasets()[group].slenderness, _relative_error(name, datasets()[group]), **look)
    axes.set(xlabel=SLENDERNESS, ylabel="relative error of r [%]")
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="upper right", ncols=2, columnspacing=0.8)
    return figure


def _relative_error(name: str, data: DataSet) -> FloatArray:
    return 100.0 * relative_error(model(name).of_slenderness(data.slenderness), data.coefficient)


def _filled(name: str) -> dict[str, Any]:
    color = model_styles()[name]["color"]
    return {"color": color, "markerfacecolor": "white" if name == "housner" else color}


def _zoned(axes: "Axes", data: DataSet) -> None:
    for low, high, shade in ((0.0, 1.0, "#ececec"), (1.0, 5.0, "#f7f7f7")):
        axes.axhspan(low, high, color=shade, linewidth=0.0, zorder=0)
    for zone, height in (("I", 0.5), ("II", 3.0), ("III", 7.0)):
        transform = axes.get_yaxis_transform()
        axes.text(1.01, height, zone, transform=transform, ha="left", va="center", fontsize=7, color=GREY)
    for name in _PAIR:
        look = {"linestyle": "none", "marker": _MARKER[name], "label": model_styles()[name]["label"], **_filled(name)}
        axes.plot(data.slenderness, _relative_error(name, data), **look)
    axes.set(xlabel=SLENDERNESS, ylabel="relative error of r [%]")
