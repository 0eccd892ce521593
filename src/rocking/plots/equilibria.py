"""In which ways a body can stand: the landscape of the height of its centre, and the body on its support polygon."""

import math
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from rocking.bodies.equilibria import Equilibria, StablePose
from rocking.bodies.equilibria.poses import tilt_towards
from rocking.bodies.solid import Solid
from rocking.conventions import FloatArray
from rocking.plots.solid import shaded_solid
from rocking.plots.style import COLORS, DASHED, DOUBLE, INK, PALE, in_journal_style, legend_below, new_figure, stroke

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

_MARKS = {"stable": ("o", COLORS[0]), "saddle": ("x", "white"), "summit": ("^", COLORS[1])}
_TILTS, _AZIMUTHS, _FEW = 91, 181, 40


@in_journal_style
def equilibria_picture(solid: Solid, pose: StablePose | None = None, *, found: Equilibria | None = None) -> "Figure":
    """Draw how high a body's centre of mass is, whichever way it leans, and the body on its support polygon.

    Parameters
    ----------
    solid : Solid
        The body.
    pose : StablePose, optional
        In which it stands, in the middle of the map; by default the one into which it settles from its way up.
    found : Equilibria, optional
        Its equilibria, if they are known already.

    Returns
    -------
    matplotlib.figure.Figure
        A polar map, the rise of the centre by tilt and azimuth [mm], with stable poses, saddles and summits; the
        base from above, with the plumb line; the body as it stands in the pose.
    """
    known = solid.equilibria() if found is None else found
    start = known.settling((0.0, 0.0, -1.0)) if pose is None else pose
    figure, axes = new_figure(DOUBLE, 3.1, columns=3, width_ratios=[1.25, 0.9, 0.9])
    place: Any = axes[0].get_subplotspec()
    axes[0].remove()
    _landscape(figure, cast("PolarAxes", figure.add_subplot(place, projection="polar")), known, start)
    _support(axes[1], start)
    shaded_solid(axes[2], solid.settled(start))
    axes[2].set_title(f"{known.mass:.4g} kg,\ncentre {start.height:.4g} m high", loc="left")
    return figure


def _landscape(figure: "Figure", axes: "PolarAxes", found: Equilibria, pose: StablePose) -> None:
    tilt, azimuth = np.linspace(0.0, math.pi, _TILTS), np.linspace(0.0, 2.0 * math.pi, _AZIMUTHS)
    lean = np.sin(tilt)[:, None] * np.stack([np.cos(azimuth), np.sin(azimuth)])[:, None, :]
    downward = np.stack([*lean, np.broadcast_to(-np.cos(tilt)[:, None], lean[0].shape)], axis=-1)
    rise = 1e3 * (found.height(downward @ pose.rotation) - pose.height)
    image = axes.contourf(azimuth, np.rad2deg(tilt), rise, levels=24, cmap="cividis")
    axes.contour(azimuth, np.rad2deg(tilt), rise, levels=12, colors="white", linewidths=0.25, linestyles="solid")
    handles = []
    for kind, members in (("summit", found.summits), ("saddle", found.saddles), ("stable", found.stable)):
        mark, color = _MARKS[kind]
        places = np.array([tilt_towards(pose, one.down) for one in members]).reshape(-1, 2)
        edge: dict[str, Any] = {} if mark == "x" else {"edgecolors": "white", "linewidths": 0.5}
        axes.scatter(places[:, 1], np.rad2deg(places[:, 0]), s=22, marker=mark, color=color, zorder=4, **edge)
        # white on white paper cannot be seen in a legend
        shown = INK if color == "white" else color
        name = kind if len(members) == 1 or kind == "stable" else f"{kind}s"
        handles.append(stroke(f"{len(members)} {name}", marker=mark, color=shown, linestyle="none"))
    if found.rings:
        handles.insert(0, stroke(f"{len(found.rings)} rings, not marked", linestyle="none"))
    axes.set_rlim(0.0, 180.0)
    axes.set_rgrids([60.0, 120.0], labels=["60°", "120°"], color="white")
    axes.set_thetagrids([0.0, 90.0, 180.0, 270.0], labels=["x", "y", "\N{MINUS SIGN}x", "\N{MINUS SIGN}y"])
    axes.grid(linewidth=0.3, color="white", alpha=0.5)
    figure.colorbar(image, ax=axes, shrink=0.75, pad=0.12, label="rise of the centre [mm]")
    legend_below(figure, handles[::-1], 4)


def _support(axes: "Axes", pose: StablePose) -> None:
    corners: FloatArray = 1e3 * pose.support
    ring = corners[[*range(len(corners)), 0]]
    axes.fill(*ring.T, facecolor=PALE, edgecolor=INK, linewidth=0.8)
    if len(corners) <= _FEW:
        axes.plot(*ring.T, "o", color=INK, markersize=3)
    axes.plot([0.0], [0.0], "+", color=COLORS[1], markersize=9)
    along = np.roll(corners, -1, axis=0) - corners
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
    nearest = int(np.argmin(pose.edge_distances))
    foot = 1e3 * pose.edge_distances[nearest] * outward[nearest]
    axes.plot([0.0, foot[0]], [0.0, foot[1]], color=COLORS[1], linestyle=DASHED)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.1)
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    axes.set_title(f"support polygon,\nnearest edge {1e3 * pose.edge_distances[nearest]:.3g} mm off", loc="left")
