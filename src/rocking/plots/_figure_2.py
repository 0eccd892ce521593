"""Figure 2 of the paper: the kinetic energy of a body through the stages of KED."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies import Body, Section
from rocking.conventions import FloatArray, Foot
from rocking.plots.outline import outline_path
from rocking.plots.style import DOUBLE, INK, in_journal_style, new_figure
from rocking.restitution import EnergyLedger, energy_ledger
from rocking.restitution.ledger import STAGES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure

_GRID = 120
_ARROWS = 7
_WORDS = {
    "before": "before the impact",
    "stage 1": "stage 1: vertical part lost",
    "stage 2": "stage 2: part along O'S lost",
    "after": "stage 3: redistributed",
}


@in_journal_style
def figure_2(body: Body | None = None, *, onto: Foot = "right", angular_velocity: float = 1.0) -> "Figure":
    """Draw energy density and velocities over a body, stage by stage.

    Parameters
    ----------
    body : Body, optional
        Block or Section; by default a pedestal with a hollow.
    onto : {"left", "right"}
        The foot on which it lands.
    angular_velocity : float
        Angular velocity before the impact [rad/s].

    Returns
    -------
    matplotlib.figure.Figure
        Four panels with one colour scale, and the share of energy in each.
    """
    body = _example() if body is None else body
    ledger = energy_ledger(body, onto=onto, angular_velocity=angular_velocity)
    x0, _, x1, height = body.local_box
    shape = min(max(height / (x1 - x0), 0.6), 3.0)
    figure, axes = new_figure(DOUBLE, 0.85 + 1.3 * shape, columns=4, sharey=True)
    x, y = _grid(body)
    fields = _energy(body, ledger, x, y)
    inside = body.density_at(x, y) > 0.0
    top = max(float(field[inside].max()) for field in fields.values())
    for panel, stage in zip(axes, STAGES, strict=True):
        image = _panel(panel, body, ledger, stage, (x, y, fields[stage]), top)
    bar = figure.colorbar(image, ax=axes, shrink=0.8, aspect=30, pad=0.01)
    bar.set_label("kinetic energy per volume [J/m$^3$]", fontsize=7)
    bar.ax.tick_params(labelsize=7)
    axes[0].set_ylabel("y [m]")
    return figure


def _panel(
    axes: "Axes",
    body: Body,
    ledger: EnergyLedger,
    stage: str,
    field: tuple[FloatArray, FloatArray, FloatArray],
    top: float,
) -> "QuadMesh":
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    x, y, values = field
    image = axes.pcolormesh(x, y, values, cmap="viridis", vmin=0.0, vmax=top, shading="gouraud", rasterized=True)
    rings = [Path(np.vstack([ring, ring[:1]]), closed=True) for ring in outline_path(body)]
    patch = PathPatch(Path.make_compound_path(*rings), facecolor="none", edgecolor=INK, linewidth=0.8)
    axes.add_patch(patch)
    image.set_clip_path(patch)
    _arrows(axes, body, ledger, stage)
    share = ledger.shares[stage]
    axes.set_title(f"{_WORDS[stage]}\n{100.0 * share:.1f} % of the kinetic energy", fontsize=7)
    for foot, at in zip(("O", "O'"), body.feet, strict=True):
        axes.annotate(foot, (at, body.ground), (0, -9), textcoords="offset points", ha="center", fontsize=7)
        axes.plot([at], [body.ground], marker="^", color=INK, markersize=4, clip_on=False, zorder=5)
    x0, _, x1, height = body.local_box
    margin = 0.16 * max(x1 - x0, 0.4 * height)
    axes.set_xlim(body.origin_x + x0 - margin, body.origin_x + x1 + margin)
    axes.set_ylim(body.ground - 0.09 * height, body.ground + 1.06 * height)
    axes.set_aspect("equal")
    axes.axhline(body.ground, color=INK, linewidth=0.7, zorder=0)
    axes.set_xlabel("x [m]")
    axes.locator_params(axis="x", nbins=3)
    return image


def _energy(body: Body, ledger: EnergyLedger, x: FloatArray, y: FloatArray) -> dict[str, FloatArray]:
    # beyond the outline, which clips the picture, the field goes on: no dark seam along sloping edges
    density = body.density_at(x, y)
    density = np.where(density > 0.0, density, density.max())
    return {stage: 0.5 * density * (v**2).sum(axis=-1) for stage, v in ledger.velocities(x, y).items()}


def _arrows(axes: "Axes", body: Body, ledger: EnergyLedger, stage: str) -> None:
    x0, _, x1, height = body.local_box
    step = max(x1 - x0, height) / (2.0 * _ARROWS)
    columns = np.arange(x0 + 0.5 * step, x1, step)
    rows = np.arange(0.5 * step, height, step)
    x, y = np.meshgrid(columns + body.origin_x, rows + body.ground)
    inside = ledger.energy_density(x, y)["before"] > 0.0
    velocity = ledger.velocities(x[inside], y[inside])
    fastest = float(np.hypot(*velocity["before"].T).max())
    u, v = velocity[stage].T
    axes.quiver(
        x[inside],
        y[inside],
        u,
        v,
        angles="xy",
        scale_units="xy",
        scale=fastest / (0.95 * step),
        color="white",
        edgecolor=INK,
        linewidth=0.3,
        width=0.012,
        headwidth=3.4,
        headlength=3.6,
        headaxislength=3.2,
        zorder=4,
    )


def _grid(body: Body) -> tuple[FloatArray, FloatArray]:
    x0, _, x1, height = body.local_box
    # density is constant within a region: sampling a little inside the box keeps its edge coloured
    shrink = 1e-6 * max(x1 - x0, height)
    columns = np.linspace(x0 + shrink, x1 - shrink, _GRID) + body.origin_x
    rows = np.linspace(shrink, height - shrink, _GRID) + body.ground
    x, y = np.meshgrid(columns, rows)
    return x, y


def _example() -> Section:
    return Section.from_trapezoid(
        1.0, 0.5, 2.5, density=2700.0, holes=[[(0.4, 0.4), (0.6, 0.4), (0.6, 1.4), (0.4, 1.4)]]
    )
