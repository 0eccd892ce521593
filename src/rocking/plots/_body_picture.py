"""A body, and its coefficient against the published measurements: the picture of `rocking cor`."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies import Body
from rocking.conventions import Foot
from rocking.evidence._coefficient_table import CALIBRATED, CoefficientRow
from rocking.evidence.calibration import calibrate
from rocking.evidence.measurements import GROUPS, datasets
from rocking.plots.curves import points, slenderness_axis
from rocking.plots.outline import draw_body
from rocking.plots.overview import band
from rocking.plots.style import DOUBLE, GREY, INK, PALE, SINGLE, in_journal_style, model_styles, new_figure

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
def coefficient_picture(body: Body, tables: Mapping[Foot, Sequence[CoefficientRow]]) -> "Figure":
    """Draw a body, its coefficient under every model, and where each foot's slenderness lies among the measurements.

    Parameters
    ----------
    body : Body
        The body.
    tables : dict of {"left", "right"} to sequence of CoefficientRow
        Its coefficients by the foot on which it lands: one table of a symmetric body, two of another.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels.
    """
    figure, axes = new_figure(DOUBLE, 2.9 if len(tables) == 1 else 3.4, columns=3, width_ratios=[0.75, 1.0, 1.15])
    _body(axes[0], body)
    _rows(axes[1], tables)
    ratios = {foot: body.side(foot).slenderness_ratio for foot in tables}
    low, high = min(1.2, 0.9 * min(ratios.values())), max(10.5, 1.08 * max(ratios.values()))
    band(axes[2], calibrate(), low, high)
    for group in GROUPS:
        points(axes[2], datasets()[group], group)
    markers = _markers(tables)
    for foot, rows in tables.items():
        for row in rows:
            axes[2].plot([ratios[foot]], [row.coefficient], markers[foot], markersize=4, color=_color(row))
    slenderness_axis(axes[2])
    axes[2].set_ylabel("coefficient of restitution r [-]")
    axes[2].set_title("diamonds: this body" if len(tables) == 1 else "triangles: this body's feet", loc="left")
    axes[2].legend(loc="lower right")
    return figure


def _markers(tables: Mapping[Foot, Sequence[CoefficientRow]]) -> dict[Foot, str]:
    return {"left": "<", "right": ">"} if len(tables) > 1 else dict.fromkeys(tables, "D")


def _rows(axes: "Axes", tables: Mapping[Foot, Sequence[CoefficientRow]]) -> None:
    markers, rows = _markers(tables), next(iter(tables.values()))
    place, apart = np.arange(len(rows))[::-1], 0.6 / len(tables)
    for i, (foot, found) in enumerate(tables.items()):
        for y, row in zip((place + apart * (0.5 * (len(tables) - 1) - i)).tolist(), found, strict=True):
            axes.plot([row.low, row.high], [y, y], color=_color(row), linewidth=1.2)
            axes.plot([row.coefficient], [y], marker=markers[foot], markersize=4, color=_color(row))
            # over the marker where there is room, else behind the interval
            place_of, shift, ha, va = (
                (row.coefficient, (0, 4), "center", "bottom")
                if len(tables) == 1
                else (row.high, (3, 0), "left", "center")
            )
            axes.annotate(
                f"{row.coefficient:.3f}", (place_of, y), shift, textcoords="offset points", ha=ha, va=va, fontsize=6
            )
    axes.margins(x=0.05 if len(tables) == 1 else 0.12)
    axes.set_yticks(place, [row.name.replace(":", "\n") for row in rows], fontsize=6)
    axes.set_ylim(-0.6, len(rows) - 0.3)
    axes.grid(axis="y", color=PALE, linewidth=0.5)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("coefficient of restitution r [-]")
    both = "onto the left foot (\N{BLACK LEFT-POINTING TRIANGLE}) and right foot (\N{BLACK RIGHT-POINTING TRIANGLE})"
    alone = f"onto the {next(iter(tables))} foot, 95 % interval"
    axes.set_title(alone if len(tables) == 1 else f"{both},\n95 % intervals", loc="left")


def _color(row: CoefficientRow) -> str:
    if row.name == CALIBRATED:
        return INK
    look = model_styles().get(row.name.rpartition("*")[2].partition(":")[0])
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
