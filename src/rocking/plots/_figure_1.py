"""Figure 1 of the paper, our own drawing: the classical model of a rocking block."""

import math
from typing import TYPE_CHECKING

import numpy as np

from rocking.plots.style import GREY, INK, SINGLE, in_journal_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_B, _H, _THETA = 0.5, 1.25, 0.16


@in_journal_style
def figure_1() -> "Figure":
    """Draw the block, its feet, half sizes, semi-diagonal and angles.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.
    """
    from matplotlib.patches import Arc, Polygon

    figure, (axes,) = new_figure(SINGLE, 3.3)
    corners = np.array([(0.0, 0.0), (2 * _B, 0.0), (2 * _B, 2 * _H), (0.0, 2 * _H)])
    foot = corners[1]
    turned = (corners - foot) @ _rotation(_THETA).T + foot
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
    axes.add_patch(Arc(tuple(foot), 1.5, 1.5, theta1=tilt, theta2=tilt + math.degrees(alpha), color=INK, linewidth=0.8))
    middle = math.radians(tilt + 0.5 * math.degrees(alpha))
    _text(axes, r"$\alpha$", foot + 0.9 * np.array([math.cos(middle), math.sin(middle)]), (-3, -3))
    axes.add_patch(Arc(tuple(foot), 3.6, 3.6, theta1=tilt, theta2=90.0, color=INK, linewidth=0.8))
    _text(axes, r"$\theta > 0$", foot + 1.8 * np.array([math.sin(_THETA), math.cos(_THETA)]), (6, -2), align="left")
    _dimension(axes, turned[3], turned[2], "2b", (0, 9))
    _dimension(axes, turned[3], turned[0], "2h", (-16, 0))
    axes.annotate("", (0.55, -0.3), (0.0, -0.3), arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 0.8})
    _text(axes, "ground acceleration > 0", np.array([0.6, -0.3]), (3, -3), align="left")
    axes.set_xlim(-0.75, 2.1)
    axes.set_ylim(-0.45, 3.0)
    axes.set_aspect("equal")
    axes.axis("off")
    return figure


def _rotation(clockwise: float) -> np.ndarray:
    c, s = math.cos(clockwise), math.sin(clockwise)
    return np.array([[c, s], [-s, c]])


def _text(axes: "Axes", words: str, at: np.ndarray, shift: tuple[float, float], align: str = "center") -> None:
    axes.annotate(words, (float(at[0]), float(at[1])), shift, textcoords="offset points", ha=align, fontsize=8)


def _dimension(axes: "Axes", a: np.ndarray, b: np.ndarray, words: str, shift: tuple[float, float]) -> None:
    normal = np.array([-(b - a)[1], (b - a)[0]]) / np.linalg.norm(b - a)
    outward = 0.1 * normal if words == "2b" else -0.1 * normal
    axes.annotate("", tuple(a + outward), tuple(b + outward), arrowprops={"arrowstyle": "<->", "linewidth": 0.6})
    _text(axes, words, 0.5 * (a + b) + outward, shift if words == "2b" else (-17, -3))
