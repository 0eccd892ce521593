"""Pictures of 3D bodies: energy loss, stable poses, and height of the centre of mass between stable poses."""

import math
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from rocking.bodies.equilibria import Equilibria, StablePose
from rocking.bodies.equilibria.poses import tilt_towards
from rocking.bodies.solid import Edge, Solid, box, voxels
from rocking.bodies.solid.surfaces import TriangleSurface
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.plots.space_glb import corners_of
from rocking.plots.style import (
    COLORS,
    DASHED,
    DOUBLE,
    GREY,
    INK,
    PALE,
    SINGLE,
    in_journal_style,
    legend_below,
    new_figure,
    stroke,
)
from rocking.restitution.space import SpatialImpact, SpatialRestitution, UnitEnergies, unit_energies
from rocking.restitution.space.energies import lost_density

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

_LIGHT = np.array([0.4, -0.7, 0.6]) / np.linalg.norm([0.4, -0.7, 0.6])
_COLOURS = "cividis"
_MOST_TRIANGLES = 60_000


@in_journal_style
def solid_picture(solid: Solid, *, azimuth: float = -60.0, elevation: float = 18.0) -> "Figure":
    """Draw a body on its base in parallel projection.

    Parameters
    ----------
    solid : Solid
        The body.
    azimuth, elevation : float
        Direction of view [degree].

    Returns
    -------
    matplotlib.figure.Figure
        One panel.
    """
    figure, (axes,) = new_figure(SINGLE, 4.0)
    shaded_solid(axes, solid, azimuth, elevation)
    axes.set_title(f"{solid.mass:.4g} kg, centre {solid.centre[2] - solid.ground:.4g} m high", loc="left")
    return figure


@in_journal_style
def energy_picture(
    result: SpatialRestitution, *, divisions: int = 16, azimuth: float = -60.0, elevation: float = 18.0
) -> "Figure":
    """Draw the energy loss of a body in an impact: of each cube, in a vertical slice, and over the height.

    Parameters
    ----------
    result : SpatialRestitution
        The impact.
    divisions : int
        Number of cubes along the longest side of the body [-].
    azimuth, elevation : float
        Direction of view [degree].

    Returns
    -------
    matplotlib.figure.Figure
        Three panels: loss of the units [J/m3], loss in the slice through the centre across the axis [J/m3], and loss
        over the height [J/m].
    """
    impact = result.impact
    figure, axes = new_figure(DOUBLE, 3.4, columns=3, width_ratios=[1.0, 1.0, 0.7])
    step = impact.solid.size / divisions
    energies = unit_energies(impact, voxels(impact.solid, divisions))
    frame = _frame(azimuth, elevation)
    image = _slice(axes[1], impact, 8 * divisions)
    _shaded(axes[0], *_cubes(impact.solid, energies, step), frame, top=image.norm.vmax)
    axes[0].set_title(f"{len(energies.units)} units", loc="left")
    figure.colorbar(image, ax=[axes[0], axes[1]], label="energy lost [J/m$^3$]", shrink=0.7)
    _profile(axes[2], result, 4 * divisions)
    return figure


@in_journal_style
def slices_picture(result: SpatialRestitution, heights: FloatArray, *, divisions: int = 24) -> "Figure":
    """Draw the energy loss in horizontal slices of a body.

    Parameters
    ----------
    result : SpatialRestitution
        The impact.
    heights : ndarray, shape (n,)
        Heights of the slices above the ground [m].
    divisions : int
        A quarter of the number of points along a side of a slice [-].

    Returns
    -------
    matplotlib.figure.Figure
        One panel per slice, one colour bar [J/m3].

    Raises
    ------
    InvalidValueError
        If a slice misses the body.
    """
    impact, fields = result.impact, []
    for height in np.atleast_1d(heights).tolist():
        field, extent = _level(impact, height, 4 * divisions)
        if np.isnan(field).all():
            raise InvalidValueError("the slice at a height of {height:g} m misses the body", height=height)
        fields.append((height, field, extent))
    figure, axes = new_figure(DOUBLE, 2.6, columns=len(fields))
    top = max(float(np.nanmax(field)) for _, field, _ in fields)
    for panel, (height, field, extent) in zip(axes, fields, strict=True):
        image = panel.imshow(field.T, origin="lower", extent=extent, cmap=_COLOURS, vmin=0.0, vmax=top)
        panel.set_title(f"{height:.3g} m above the ground", loc="left")
        panel.set_xlabel("x [m]")
    axes[0].set_ylabel("y [m]")
    figure.colorbar(image, ax=axes, label="energy lost [J/m$^3$]", shrink=0.8)
    return figure


def shaded_solid(axes: "Axes", solid: Solid, azimuth: float = -60.0, elevation: float = 18.0) -> None:
    """Draw a body and its base into a panel in parallel projection.

    The angles define the direction of view [degree].
    """
    _shaded(axes, _surface(solid, 8), None, _frame(azimuth, elevation))
    _base(axes, solid, _frame(azimuth, elevation))


def _surface(solid: Solid, divisions: int) -> FloatArray:
    pieces = []
    for solid_part in solid.local_parts:
        for surface in solid_part.surfaces():
            fine = isinstance(surface, TriangleSurface) and len(surface.corners) * divisions**2 > _MOST_TRIANGLES
            pieces.append(surface.triangles(1 if fine else divisions))
    return np.concatenate(pieces)


def _frame(azimuth: float, elevation: float) -> FloatArray:
    turn, tilt = np.deg2rad(azimuth), np.deg2rad(elevation)
    right = np.array([-np.sin(turn), np.cos(turn), 0.0])
    toward = np.array([np.cos(tilt) * np.cos(turn), np.cos(tilt) * np.sin(turn), np.sin(tilt)])
    return np.stack([right, np.cross(toward, right), toward])


def _shaded(
    axes: "Axes", triangles: FloatArray, values: FloatArray | None, frame: FloatArray, top: float | None = None
) -> None:
    from matplotlib import colormaps
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import Normalize

    seen = triangles @ frame.T
    normals = np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    front = np.flatnonzero(normals[:, 2] > 0.0)
    # far faces are plotted first
    front = front[np.argsort(seen[front, :, 2].mean(axis=1), kind="stable")]
    scale = Normalize(0.0, top)
    colours = np.full((len(front), 4), 0.8) if values is None else colormaps[_COLOURS](scale(values[front]))
    light = 0.6 + 0.4 * np.maximum(normals[front] @ (frame @ _LIGHT), 0.0)
    colours[:, :3] *= light[:, None] if values is None else (0.8 + 0.2 * light)[:, None]
    colours[:, 3] = 1.0
    axes.add_collection(
        PolyCollection(list(seen[front, :, :2]), facecolors=colours, edgecolors=colours, linewidths=0.2)
    )
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()


def _base(axes: "Axes", solid: Solid, frame: FloatArray) -> None:
    corners = corners_of(solid)
    ring = np.concatenate([corners, corners[:1]]) @ frame.T
    axes.plot(ring[:, 0], ring[:, 1], color=INK, linewidth=0.8)
    centre = frame @ solid.local_moments.centre
    axes.plot([centre[0]], [centre[1]], marker="+", color=INK)


def _cubes(solid: Solid, energies: UnitEnergies, side: float) -> tuple[FloatArray, FloatArray]:
    cube = box(side, side, side).corners - np.array([0.0, 0.0, 0.5 * side])
    triangles = (energies.units.centre[:, None, None] + cube).reshape(-1, 3, 3)
    # a volume unit at the surface is smaller than its cube; the energy loss is divided by the volume of the unit
    density = np.array([solid_part.density for solid_part in solid.local_parts])[energies.units.part]
    return triangles, np.repeat(energies.density * density, len(cube))


def _slice(axes: "Axes", impact: SpatialImpact, count: int) -> Any:
    # the vertical plane through the centre, across the axis of rotation of the body
    along = impact.onto.direction if isinstance(impact.onto, Edge) else impact.velocity / impact.speed
    across = np.array([along[1], -along[0], 0.0])
    across /= max(float(np.linalg.norm(across)), 1e-300)
    solid = impact.solid
    low, high = solid.box
    top = float(high[2]) - solid.ground
    reach = 0.5 * float(np.linalg.norm((high - low)[:2]))
    share = (np.arange(count) + 0.5) / count
    s, z = np.meshgrid(reach * (2.0 * share - 1.0), top * share, indexing="ij")
    points = (
        np.array([*solid.centre[:2], solid.ground]) + s[..., None] * across + z[..., None] * np.array([0.0, 0.0, 1.0])
    )
    field = _field(impact, points.reshape(-1, 3)).reshape(count, count)
    image = axes.imshow(field.T, origin="lower", extent=(-reach, reach, 0.0, top), cmap=_COLOURS, vmin=0.0)
    axes.set_xlabel("across the axis [m]")
    axes.set_ylabel("height [m]")
    axes.set_title("vertical slice through the centre", loc="left")
    return image


def _profile(axes: "Axes", result: SpatialRestitution, count: int) -> None:
    top = float(result.impact.solid.box[1, 2]) - result.impact.solid.ground
    heights = top * (np.arange(count) + 0.5) / count
    lost = []
    for height in heights.tolist():
        field, (left, right, near, far) = _level(result.impact, height, count)
        lost.append(float(np.nansum(field)) * (right - left) * (far - near) / count**2)
    axes.fill_betweenx(heights, 0.0, lost, color=GREY, linewidth=0.0)
    axes.set_xlim(0.0, None)
    axes.set_ylim(0.0, None)
    axes.set_xlabel("energy lost [J/m]")
    axes.set_title(f"{result.model.name}: r = {result.coefficient:.4f}", loc="left")


def _field(impact: SpatialImpact, points: FloatArray) -> FloatArray:
    field = np.full(len(points), np.nan)
    for solid_part in impact.solid.parts:
        is_inside = solid_part.contains(points)
        field[is_inside] = lost_density(impact, solid_part, points[is_inside])
    return field


def _level(impact: SpatialImpact, height: float, count: int) -> tuple[FloatArray, tuple[float, float, float, float]]:
    low, high = impact.solid.box
    share = (np.arange(count) + 0.5) / count
    x, y = (low[i] + (high[i] - low[i]) * share for i in range(2))
    points = np.stack(np.meshgrid(x, y, [impact.solid.ground + height], indexing="ij"), axis=-1).reshape(-1, 3)
    field = _field(impact, points)
    return field.reshape(count, count), (float(low[0]), float(high[0]), float(low[1]), float(high[1]))


_MARKS = {"stable": ("o", COLORS[0]), "saddle": ("x", "white"), "summit": ("^", COLORS[1])}
_TILTS, _AZIMUTHS, _FEW, _MANY = 91, 181, 40, 24


@in_journal_style
def equilibria_picture(
    solid: Solid, pose: StablePose | None = None, *, equilibria: Equilibria | None = None
) -> "Figure":
    """Draw the height of the centre of mass in all orientations, and the body on its support polygon.

    Parameters
    ----------
    solid : Solid
        The body.
    pose : StablePose, optional
        Pose in the centre of the map. The default is the stable pose to which the solid moves.
    equilibria : Equilibria, optional
        Equilibria of the solid, if computed before.

    Returns
    -------
    matplotlib.figure.Figure
        Polar map of the rise of the centre of mass by tilt and azimuth [mm], with stable poses, saddles and summits;
        the base in plan, with the projection of the centre of mass; the body in the pose.
    """
    computed = solid.equilibria() if equilibria is None else equilibria
    start = computed.settling((0.0, 0.0, -1.0)) if pose is None else pose
    figure, axes = new_figure(DOUBLE, 3.1, columns=3, width_ratios=[1.25, 0.9, 0.9])
    subplot: Any = axes[0].get_subplotspec()
    axes[0].remove()
    _landscape(figure, cast("PolarAxes", figure.add_subplot(subplot, projection="polar")), computed, start)
    _support(axes[1], start)
    shaded_solid(axes[2], solid.settled(start))
    axes[2].set_title(f"{computed.mass:.4g} kg,\ncentre {start.height:.4g} m high", loc="left")
    return figure


def _landscape(figure: "Figure", axes: "PolarAxes", equilibria: Equilibria, pose: StablePose) -> None:
    tilt, azimuth = np.linspace(0.0, math.pi, _TILTS), np.linspace(0.0, 2.0 * math.pi, _AZIMUTHS)
    horizontal = np.sin(tilt)[:, None] * np.stack([np.cos(azimuth), np.sin(azimuth)])[:, None, :]
    downward = np.stack([*horizontal, np.broadcast_to(-np.cos(tilt)[:, None], horizontal[0].shape)], axis=-1)
    rise = 1e3 * (equilibria.height(downward @ pose.rotation) - pose.height)
    image = axes.contourf(azimuth, np.rad2deg(tilt), rise, levels=24, cmap="cividis")
    axes.contour(azimuth, np.rad2deg(tilt), rise, levels=12, colors="white", linewidths=0.25, linestyles="solid")
    handles = []
    for kind, members in (
        ("summit", equilibria.summits),
        ("saddle", equilibria.saddles),
        ("stable", equilibria.stable),
    ):
        mark, color = _MARKS[kind]
        positions = np.array([tilt_towards(pose, member.down) for member in members]).reshape(-1, 2)
        edge: dict[str, Any] = {} if mark == "x" else {"edgecolors": "white", "linewidths": 0.5}
        size = 22.0 * min(1.0, _MANY / max(len(members), 1))  # small marks if there are many of them
        level = 5 if kind == "stable" else 4
        axes.scatter(
            positions[:, 1], np.rad2deg(positions[:, 0]), s=size, marker=mark, color=color, zorder=level, **edge
        )
        # white marks are invisible in a legend on white paper
        shown = INK if color == "white" else color
        name = kind if len(members) == 1 or kind == "stable" else f"{kind}s"
        handles.append(stroke(f"{len(members)} {name}", marker=mark, color=shown, linestyle="none"))
    axes.scatter([0.0], [0.0], s=22, marker=_MARKS["stable"][0], color=_MARKS["stable"][1], zorder=6,
                 edgecolors="white", linewidths=0.5)  # fmt: skip
    if equilibria.rings:
        handles.insert(0, stroke(f"{len(equilibria.rings)} rings, not marked", linestyle="none"))
    axes.set_rlim(0.0, 180.0)
    axes.set_rgrids([60.0, 120.0], labels=["60°", "120°"], color="white")
    axes.set_thetagrids([0.0, 90.0, 180.0, 270.0], labels=["x", "y", "\N{MINUS SIGN}x", "\N{MINUS SIGN}y"])
    axes.grid(linewidth=0.3, color="white", alpha=0.5)
    figure.colorbar(image, ax=axes, shrink=0.75, pad=0.12, label="rise of the centre of mass [mm]")
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
    axes.set_title(f"support polygon,\nnearest edge at {1e3 * pose.edge_distances[nearest]:.3g} mm", loc="left")
