"""Bodies as pictures: outlines, holes, densities, feet."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies import Block, Body, MassPoints, Section
from rocking.conventions import FloatArray
from rocking.plots.style import GREY, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.path import Path


def draw_body(axes: "Axes", body: Body, *, filled: bool = True) -> None:
    """Draw a body on its ground, darker where it is denser."""
    from matplotlib.patches import PathPatch

    for path, shade in _paths(body):
        face = (*[1.0 - 0.45 * shade] * 3, 1.0) if filled else "none"
        axes.add_patch(PathPatch(path, facecolor=face, edgecolor=INK, linewidth=0.9, zorder=2))
    if isinstance(body, MassPoints):
        size = 30.0 * body.masses / body.masses.max()
        axes.scatter(body.points[:, 0], body.points[:, 1], s=size, color=INK, zorder=3)
    _ground(axes, body)


def outline_path(body: Body) -> list[FloatArray]:
    """Return every ring of a body in the user's coordinates.

    Returns outlines and holes [m]; none for mass points.
    """
    if isinstance(body, Block):
        body = body.to_section()
    if not isinstance(body, Section):
        return []
    shift = np.array([body.origin_x, body.ground])
    return [ring + shift for region in body.regions for ring in region.rings]


def _paths(body: Body) -> "list[tuple[Path, float]]":
    from matplotlib.path import Path

    if isinstance(body, Block):
        body = body.to_section()
    if not isinstance(body, Section):
        return []
    densest = max(region.density for region in body.regions)
    shift = np.array([body.origin_x, body.ground])
    found = []
    for region in body.regions:
        parts = [Path(np.vstack([ring, ring[:1]]) + shift, closed=True) for ring in region.rings]
        found.append((Path.make_compound_path(*parts), region.density / densest))
    return found


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
