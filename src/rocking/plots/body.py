"""Pictures for `rocking restitution`: the body, and its coefficient compared with published measurements."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies import Body, MassPoints, Restrained, Section
from rocking.bodies.frame import section_of
from rocking.conventions import FloatArray, Foot
from rocking.evidence._coefficient_table import CALIBRATED, CoefficientRow
from rocking.evidence.measurements import all_measurements
from rocking.plots.evidence import R, draw_calibrated, draw_measurements
from rocking.plots.style import (
    COLORS,
    DASHED,
    DOUBLE,
    GREY,
    INK,
    PALE,
    SINGLE,
    in_journal_style,
    legend_above,
    model_styles,
    new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.path import Path


@in_journal_style
def body_picture(body: Body | Restrained) -> "Figure":
    """Draw a body on its ground: outline, densities, feet, centre of mass, semi-diagonals, restraints.

    Parameters
    ----------
    body : Body or Restrained
        The body.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.
    """
    figure, (axes,) = new_figure(SINGLE, 3.4)
    if isinstance(body, Restrained):
        _body(axes, body.body)
        _restraints(axes, body)
    else:
        _body(axes, body)
    return figure


@in_journal_style
def coefficient_picture(body: Body, tables: Mapping[Foot, Sequence[CoefficientRow]]) -> "Figure":
    """Draw a body, the coefficients of all models, and the slenderness of both feet compared with the measurements.

    Parameters
    ----------
    body : Body
        The body.
    tables : dict of {"left", "right"} to sequence of CoefficientRow
        Coefficients by landing foot: one table for a symmetric body, otherwise two.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels.
    """
    figure, axes = new_figure(DOUBLE, 2.9 if len(tables) == 1 else 3.4, columns=3, width_ratios=[0.75, 1.0, 1.15])
    _body(axes[0], body)
    markers: dict[Foot, str] = {"left": "<", "right": ">"} if len(tables) > 1 else dict.fromkeys(tables, "D")
    _rows(axes[1], tables, markers)
    ratios = {foot: body.side(foot).slenderness_ratio for foot in tables}
    draw_calibrated(axes[2], low=min(1.2, 0.9 * min(ratios.values())), high=max(10.5, 1.08 * max(ratios.values())))
    draw_measurements(axes[2], all_measurements())
    for foot, rows in tables.items():
        for row in rows:
            axes[2].plot([ratios[foot]], [row.coefficient], markers[foot], markersize=4, color=_color(row))
    axes[2].set_title("diamonds: this body" if len(tables) == 1 else "triangles: this body's feet", loc="left")
    axes[2].legend(loc="lower right")
    return figure


def _rows(axes: "Axes", tables: Mapping[Foot, Sequence[CoefficientRow]], markers: dict[Foot, str]) -> None:
    rows, is_single = next(iter(tables.values())), len(tables) == 1
    rows_y, apart = np.arange(len(rows))[::-1], 0.6 / len(tables)
    for i, (foot, table) in enumerate(tables.items()):
        for y, row in zip((rows_y + apart * (0.5 * (len(tables) - 1) - i)).tolist(), table, strict=True):
            axes.plot([row.low, row.high], [y, y], color=_color(row), linewidth=1.2)
            axes.plot([row.coefficient], [y], marker=markers[foot], markersize=4, color=_color(row))
            # above the marker if there is room, otherwise after the interval
            x, shift, ha, va = (
                (row.coefficient, (0, 4), "center", "bottom") if is_single else (row.high, (3, 0), "left", "center")
            )
            text = f"{row.coefficient:.3f}"
            axes.annotate(text, (x, y), shift, textcoords="offset points", ha=ha, va=va, fontsize=6)
    axes.margins(x=0.05 if is_single else 0.12)
    axes.set_yticks(rows_y, [row.name.replace(":", "\n") for row in rows], fontsize=6)
    axes.set_ylim(-0.6, len(rows) - 0.3)
    axes.grid(axis="y", color=PALE, linewidth=0.5)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel(R)
    left, right = "\N{BLACK LEFT-POINTING TRIANGLE}", "\N{BLACK RIGHT-POINTING TRIANGLE}"
    title = f"landing on the left ({left}) and right foot ({right}),\n95 % intervals"
    axes.set_title(f"landing on the {next(iter(tables))} foot, 95 % interval" if is_single else title, loc="left")


def _color(row: CoefficientRow) -> str:
    if row.name == CALIBRATED:
        return INK
    look = model_styles().get(row.name.rpartition("*")[2].partition(":")[0])
    return str(look["color"]) if look else GREY


def _body(axes: "Axes", body: Body) -> None:
    from matplotlib.patches import PathPatch

    for path, shade in outlines(body):
        axes.add_patch(
            PathPatch(path, facecolor=(*[1.0 - 0.45 * shade] * 3, 1.0), edgecolor=INK, linewidth=0.9, zorder=2)
        )
    if isinstance(body, MassPoints):
        size = 30.0 * body.masses / body.masses.max()
        axes.scatter(body.points[:, 0], body.points[:, 1], s=size, color=INK, zorder=3)
    _ground(axes, body)
    x, y = body.centre
    for foot in body.feet:
        axes.plot([foot, x], [body.ground, y], color=INK, linewidth=0.7, linestyle=DASHED, zorder=4)
    axes.annotate("C", (x, y), (4, 3), textcoords="offset points", fontsize=7, zorder=5)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.locator_params(nbins=4)


def _restraints(axes: "Axes", body: Restrained) -> None:
    for k, restraint in enumerate(body.restraints):
        (x, z), (x_body, z_body) = restraint.ends
        axes.plot(
            [x, x_body], [body.body.ground + z, body.body.ground + z_body], "o-", color=COLORS[k % len(COLORS)],
            linewidth=1.4, markersize=3.5, zorder=6, label=restraint.name,
        )  # fmt: skip
    if body.restraints:
        legend_above(axes, 2)


def outlines(body: Body) -> "list[tuple[Path, float]]":
    """Return regions with their holes as paths [m], and density / largest density; empty for mass points."""
    section = section_of(body)
    if not isinstance(section, Section):
        return []
    densest = max(region.density for region in section.regions)
    shift = np.array([section.origin_x, section.ground])
    rings = [([ring + shift for ring in region.rings], region.density / densest) for region in section.regions]
    return [(closed(region_rings), shade) for region_rings, shade in rings]


def closed(rings: Sequence[FloatArray]) -> "Path":
    """Return one path around an outline and its holes."""
    from matplotlib.path import Path

    return Path.make_compound_path(*(Path(np.vstack([ring, ring[:1]]), closed=True) for ring in rings))


def _ground(axes: "Axes", body: Body) -> None:
    x0, _, x1, y1 = body.local_box
    margin = 0.12 * max(x1 - x0, y1)
    left, right = body.origin_x + x0 - 1.5 * margin, body.origin_x + x1 + 1.5 * margin
    axes.plot([left, right], [body.ground] * 2, color=INK, linewidth=0.8, zorder=1)
    axes.set_xlim(left, right)
    axes.set_ylim(body.ground - 1.3 * margin, body.ground + y1 + 0.7 * margin)
    axes.set_aspect("equal")
    for foot, x in zip(("O", "O'"), body.feet, strict=True):
        axes.plot([x], [body.ground], marker="^", color=INK, markersize=5, clip_on=False, zorder=4)
        axes.annotate(foot, (x, body.ground), (0, -13), textcoords="offset points", ha="center", fontsize=7)
    x, y = body.centre
    axes.plot([x], [y], marker="+", color=INK, markersize=7, markeredgewidth=1.0, zorder=5)
    for a, b in body.local_contact:
        axes.plot([body.origin_x + a, body.origin_x + b], [body.ground] * 2, color=GREY, linewidth=3.0, zorder=1)
