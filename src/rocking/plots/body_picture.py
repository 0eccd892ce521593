"""A body, and its coefficient against the published measurements: the picture of `rocking cor`."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies import Body
from rocking.conventions import Foot, opposite
from rocking.evidence.calibration import calibrate
from rocking.evidence.coefficient_table import CALIBRATED, CoefficientRow
from rocking.evidence.measurements import GROUPS, datasets
from rocking.plots.curves import points, slenderness_axis
from rocking.plots.outline import draw_body
from rocking.plots.overview import band
from rocking.plots.style import DOUBLE, GREY, INK, MODEL_STYLE, PALE, SINGLE, in_journal_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@in_journal_style
def body_picture(body: Body) -> "Figure":
    """Draw a body on its ground: outline, densities, feet, centre, semi-diagonals.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.
    """
    figure, (axes,) = new_figure(SINGLE, 3.4)
    _body(axes, body)
    return figure


@in_journal_style
def coefficient_picture(body: Body, rows: Sequence[CoefficientRow], *, onto: Foot = "right") -> "Figure":
    """Draw a body, its coefficient under every model, and where it lies among the measurements.

    Parameters
    ----------
    body : Body
        The body.
    rows : sequence of CoefficientRow
        Its coefficients.
    onto : {"left", "right"}
        The foot on which it lands.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels.
    """
    figure, axes = new_figure(DOUBLE, 2.9, columns=3, width_ratios=[0.75, 1.0, 1.15])
    _body(axes[0], body)
    _rows(axes[1], rows, onto)
    ratio = body.side(opposite(onto)).slenderness_ratio
    low, high = min(1.2, 0.9 * ratio), max(10.5, 1.08 * ratio)
    band(axes[2], calibrate(), low, high)
    for group in GROUPS:
        points(axes[2], datasets()[group], group)
    for row in rows:
        axes[2].plot([ratio], [row.coefficient], marker="D", markersize=4, linestyle="none", color=_color(row))
    slenderness_axis(axes[2])
    axes[2].set_ylabel("coefficient of restitution r [-]")
    axes[2].set_title("diamonds: this body", loc="left")
    axes[2].legend(loc="lower right")
    return figure


def _rows(axes: "Axes", rows: Sequence[CoefficientRow], onto: Foot) -> None:
    place = np.arange(len(rows))[::-1]
    for y, row in zip(place.tolist(), rows, strict=True):
        axes.plot([row.low, row.high], [y, y], color=_color(row), linewidth=1.2)
        axes.plot([row.coefficient], [y], marker="D", markersize=4, color=_color(row))
        axes.annotate(
            f"{row.coefficient:.3f}", (row.coefficient, y), (0, 4), textcoords="offset points", ha="center", fontsize=6
        )
    axes.set_yticks(place, [row.name.replace(":", "\n") for row in rows], fontsize=6)
    axes.set_ylim(-0.6, len(rows) - 0.3)
    axes.grid(axis="y", color=PALE, linewidth=0.5)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("coefficient of restitution r [-]")
    axes.set_title(f"onto the {onto} foot, 95 % interval", loc="left")


def _color(row: CoefficientRow) -> str:
    if row.name == CALIBRATED:
        return INK
    look = MODEL_STYLE.get(row.name.rpartition("*")[2].partition(":")[0])
    return str(look["color"]) if look else GREY


def _body(axes: "Axes", body: Body) -> None:
    draw_body(axes, body)
    x, y = body.centre
    for foot in body.feet:
        axes.plot([foot, x], [body.ground, y], color=INK, linewidth=0.7, linestyle=(0, (4, 2)), zorder=4)
    axes.annotate("C", (x, y), (4, 3), textcoords="offset points", fontsize=7, zorder=5)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.locator_params(nbins=4)
