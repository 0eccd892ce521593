"""Figure 2 of the paper: the kinetic energy of a body through the stages of KED."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies import Body, Region, Section
from rocking.conventions import FloatArray, Foot
from rocking.plots.body import outlines
from rocking.plots.style import DOUBLE, INK, in_journal_style, new_figure
from rocking.restitution import EnergyBalance, energy_balance
from rocking.restitution.ked import STAGES, known_density

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure

_GRID = 120
_ARROWS = 7

STAGE_WORDS = {
    "before": "before the impact",
    "stage 1": "stage 1: vertical part lost",
    "stage 2": "stage 2: part along O'S lost",
    "after": "stage 3: redistributed",
}


@in_journal_style
def energy_stages_picture(body: Body | None = None, *, foot: Foot = "right", angular_velocity: float = 1.0) -> "Figure":
    """Draw energy density and velocities over a body, by stage.

    Parameters
    ----------
    body : Body, optional
        Block or Section; by default a pedestal with a hollow.
    foot : {"left", "right"}
        Landing foot.
    angular_velocity : float
        Angular velocity before the impact [rad/s].

    Returns
    -------
    matplotlib.figure.Figure
        Four panels with one colour scale. A panel contains the fraction of energy.
    """
    body = _pedestal() if body is None else body
    balance = energy_balance(body, foot=foot, angular_velocity=angular_velocity)
    x0, _, x1, height = body.local_box
    shape = min(max(height / (x1 - x0), 0.6), 3.0)
    figure, axes = new_figure(DOUBLE, 0.85 + 1.3 * shape, columns=4, sharey=True)
    x, y = _grid(body)
    # the field extends beyond the clipping outline, which avoids a dark line along sloping edges
    density = known_density(body, x, y)
    inside = density > 0.0
    density = np.where(inside, density, density.max())
    fields = {stage: 0.5 * density * (v**2).sum(axis=-1) for stage, v in balance.velocities(x, y).items()}
    top = max(float(field[inside].max()) for field in fields.values())
    for panel, stage in zip(axes, STAGES, strict=True):
        image = panel.pcolormesh(
            x, y, fields[stage], cmap="viridis", vmin=0.0, vmax=top, shading="gouraud", rasterized=True
        )
        _panel(panel, body, balance, stage, image)
    bar = figure.colorbar(image, ax=axes, shrink=0.8, aspect=30, pad=0.01)
    bar.set_label("kinetic energy per volume [J/m$^3$]", fontsize=7)
    bar.ax.tick_params(labelsize=7)
    axes[0].set_ylabel("y [m]")
    return figure


def hero() -> "Figure":
    """Draw the picture of the README: the stages of KED on a figure on a pedestal."""
    pedestal = Region([(0.0, 0.0), (1.0, 0.0), (1.0, 0.7), (0.0, 0.7)], density=2700.0)
    figure = Region(
        [(0.2, 0.7), (0.8, 0.7), (0.72, 1.5), (0.78, 2.0), (0.58, 2.3), (0.42, 2.3), (0.22, 2.0), (0.28, 1.5)],
        density=2300.0,
    )
    return energy_stages_picture(Section([pedestal, figure]))


def _pedestal() -> Section:
    hollow = [(0.4, 0.4), (0.6, 0.4), (0.6, 1.4), (0.4, 1.4)]
    return Section.from_trapezoid(1.0, 0.5, 2.5, density=2700.0, holes=[hollow])


def _panel(axes: "Axes", body: Body, balance: EnergyBalance, stage: str, image: "QuadMesh") -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    outline = Path.make_compound_path(*(path for path, _ in outlines(body)))
    patch = PathPatch(outline, facecolor="none", edgecolor=INK, linewidth=0.8)
    axes.add_patch(patch)
    image.set_clip_path(patch)
    _arrows(axes, body, balance, stage)
    axes.set_title(f"{STAGE_WORDS[stage]}\n{100.0 * balance.fractions[stage]:.1f} % of the kinetic energy", fontsize=7)
    for foot, foot_x in zip(("O", "O'"), body.feet, strict=True):
        axes.annotate(foot, (foot_x, body.ground), (0, -9), textcoords="offset points", ha="center", fontsize=7)
        axes.plot([foot_x], [body.ground], marker="^", color=INK, markersize=4, clip_on=False, zorder=5)
    x0, _, x1, height = body.local_box
    margin = 0.16 * max(x1 - x0, 0.4 * height)
    axes.set_xlim(body.origin_x + x0 - margin, body.origin_x + x1 + margin)
    axes.set_ylim(body.ground - 0.09 * height, body.ground + 1.06 * height)
    axes.set_aspect("equal")
    axes.axhline(body.ground, color=INK, linewidth=0.7, zorder=0)
    axes.set_xlabel("x [m]")
    axes.locator_params(axis="x", nbins=3)


def _arrows(axes: "Axes", body: Body, balance: EnergyBalance, stage: str) -> None:
    x, y = arrow_feet(body)
    inside = balance.energy_density(x, y)["before"] > 0.0
    velocity = balance.velocities(x[inside], y[inside])
    fastest = float(np.hypot(*velocity["before"].T).max())
    step = arrow_spacing(body)
    axes.quiver(
        x[inside], y[inside], *velocity[stage].T, angles="xy", scale_units="xy", scale=fastest / (0.95 * step),
        color="white", edgecolor=INK, linewidth=0.3, width=0.012, headwidth=3.4, headlength=3.6, headaxislength=3.2,
        zorder=4,
    )  # fmt: skip


def arrow_spacing(body: Body) -> float:
    """Return the spacing of arrows over a body [m]."""
    x0, _, x1, height = body.local_box
    return float(max(x1 - x0, height) / (2.0 * _ARROWS))


def arrow_feet(body: Body) -> tuple[FloatArray, FloatArray]:
    """Return the grid of starting points of arrows over the box of a body [m]."""
    x0, _, x1, height = body.local_box
    step = arrow_spacing(body)
    columns, rows = np.arange(x0 + 0.5 * step, x1, step), np.arange(0.5 * step, height, step)
    x, y = np.meshgrid(columns + body.origin_x, rows + body.ground)
    return x, y


def _grid(body: Body) -> tuple[FloatArray, FloatArray]:
    x0, _, x1, height = body.local_box
    # density is constant within a region; samples slightly inside the box give a colour to the edge of the box
    shrink = 1e-6 * max(x1 - x0, height)
    columns = np.linspace(x0 + shrink, x1 - shrink, _GRID) + body.origin_x
    rows = np.linspace(shrink, height - shrink, _GRID) + body.ground
    x, y = np.meshgrid(columns, rows)
    return x, y
