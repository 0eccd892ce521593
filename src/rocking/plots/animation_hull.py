"""Animations of 3D bodies, and of plane bodies with sliding: the convex hull in parallel projection."""

import math
from dataclasses import dataclass
from textwrap import wrap
from typing import Any

import numpy as np

from rocking.bodies import Block, Section
from rocking.bodies.solid import Solid
from rocking.conventions import FloatArray
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.response import HullResponse
from rocking.dynamics.plane_frictional import ContactResponse
from rocking.dynamics.rolling.attitude import matrix
from rocking.dynamics.rolling.response import SpatialResponse
from rocking.errors import InvalidValueError
from rocking.plots.style import GREY, INK, PALE

_RATE, _MOST = 60.0, 6000
"""Poses per second, and maximum number of poses."""

_TURNED, _PLANE, _RAISED = 0.6, -1.35, 0.35
"""Direction of view: azimuth from x towards y, azimuth for motion in the plane of x, and elevation [rad]."""

_LIGHT = np.array([0.35, -0.25, 0.9])
_ROTATION = "#0070B2"
_DARK, _LINE = 0.35, 80
_SUNK = 1e-3  # largest plotted depth of a corner below the ground / size


InSpace = HullResponse | SpatialResponse | ContactResponse


def hull_of(response: InSpace) -> HullBody:
    """Return the body on its convex hull. A plane body keeps its depth."""
    body: Any = response.body
    if isinstance(response, ContactResponse):
        if not isinstance(body, (Block, Section)):
            raise InvalidValueError("an animation of sliding requires a Block or Section; mass points have no outline")
        body = Solid.from_section(body)
    return HullBody.of(body)


def positions_of(response: InSpace, time: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return attitudes [-] and positions of the centre of mass relative to the ground [m]."""
    if isinstance(response, HullResponse):
        states = response.at(time)
        return states.quaternion, states.centre
    if isinstance(response, SpatialResponse):
        sampled = response.at(time)
        return sampled.quaternion, sampled.point(response.body.centre)
    x, rise, theta = response.at(time).T
    nought = np.zeros(theta.size)
    upright = response.base.height + rise
    return np.stack([np.cos(0.5 * theta), nought, np.sin(0.5 * theta), nought], axis=-1), np.stack(
        [x, nought, upright], axis=-1
    )


def tilt_of(response: InSpace) -> FloatArray:
    """Return the angle from the initial pose at the samples [rad]."""
    return np.abs(response.rotation) if isinstance(response, ContactResponse) else response.tilt


def end_of(response: InSpace) -> float:
    """Return the end of a response [s]."""
    return response.trajectory.end if isinstance(response, ContactResponse) else response.end


def description_of(response: InSpace) -> list[str]:
    """Return texts on motion, scale, restitution and friction."""
    if isinstance(response, ContactResponse):
        motion = response.motion
        shaken = "free rocking, the ground at rest" if motion is None else motion.name
        law, r = response.law, response.law.restitution
        value = (
            "complementarity" if r is None else f"{r[1]:.6g}" if r[0] == r[1] else f"left {r[0]:.6g}, right {r[1]:.6g}"
        )
        return [shaken, *_times(response.scale), f"restitution {value}", f"friction {law.friction:g}"]
    moved = [f"{axis}: {name}" for axis, name in zip("xyz", response.names, strict=True) if name != "none"]
    if isinstance(response, SpatialResponse):
        return [*moved, f"restitution {response.law.label}"]
    stops = f"restitution {response.restitution}", f"friction {response.settings.friction:g}"
    return [*moved, *_times(response.scale), *stops]


def _times(scale: float) -> list[str]:
    return [] if scale == 1.0 else [f"{scale:g} times"]


@dataclass(frozen=True, eq=False)
class HullScene:
    """The hull of a body relative to its centre of mass, and its pose at equal steps of time."""

    time: FloatArray  # [s]
    quaternion: FloatArray  # attitude (s, x, y, z) [-]; shape (n, 4)
    centre: FloatArray  # position of the centre of mass relative to the ground [m]; shape (n, 3)
    tilt: FloatArray  # angle from the initial pose [rad]
    points: FloatArray  # vertices of the hull [m]; shape (k, 3)
    facets: list[list[int]]  # vertices of the facets, counter-clockwise as seen from outside
    normals: FloatArray  # outward normals of the facets [-]
    middle: FloatArray  # centre of the scene [m]
    reach: float  # radius of the scene [m]
    turned: float  # azimuth of the view, from x towards y [rad]

    @classmethod
    def of(cls, response: InSpace, step: float | None = None) -> "HullScene":
        """Return the scene of a response at steps of time [s]. The default is at most 60 steps per second."""
        end, body = end_of(response), hull_of(response)
        hull = body.hull
        if step is None:
            time = np.linspace(0.0, end, min(max(2, int(end * _RATE)), _MOST))
        else:
            time = np.append(np.arange(0.0, end, step), end)
        (attitudes, centre), size = positions_of(response, time), body.size
        in_plane = isinstance(response, ContactResponse)
        if in_plane:  # the scene ends when a corner of the overturning body reaches the ground
            lowest = [float((hull.vertices @ matrix(q)[2]).min()) for q in attitudes] + centre[:, 2]
            lies = int(np.append(np.flatnonzero(lowest < -_SUNK * size), time.size)[0])
            time, attitudes, centre = time[:lies], attitudes[:lies], centre[:lies]
        low, high = centre.min(axis=0) - size, centre.max(axis=0) + size
        low[2] = 0.0
        follows: list[dict[int, int]] = [{} for _ in hull.normals]
        for (start, stop), (left, right) in zip(hull.ends.tolist(), hull.sides.tolist(), strict=True):
            follows[left][start], follows[right][stop] = stop, start
        return cls(
            time, attitudes, centre, np.interp(time, response.time, tilt_of(response)), hull.vertices,
            [_loop(successors) for successors in follows], hull.normals, 0.5 * (low + high),
            0.5 * float((high - low).max()),
            _PLANE if in_plane else _TURNED,
        )  # fmt: skip


def _loop(successors: dict[int, int]) -> list[int]:
    """Return the vertices of a facet in order, from the successors of its vertices."""
    loop = [next(iter(successors))]
    while len(loop) < len(successors):
        loop.append(successors[loop[-1]])
    return loop


class HullStage:
    """The figure of an animation and its moving artists."""

    def __init__(self, response: InSpace, step: float) -> None:
        from matplotlib.collections import LineCollection, PolyCollection
        from matplotlib.figure import Figure

        self.scene = scene = HullScene.of(response, step)
        self.time = scene.time
        self.figure = Figure(figsize=(4.8, 5.2), facecolor="white")
        title = response.summary[:1].upper() + response.summary[1:]
        self.figure.text(0.02, 0.985, "\n".join(wrap(title, _LINE)), va="top", fontsize=7.5)
        view = self.figure.add_axes((0.0, 0.26, 1.0, 0.66))
        view.set_axis_off()
        view.set_aspect("equal")
        x, y = self._seen(scene.middle)
        view.set_xlim(x - 1.05 * scene.reach, x + 1.05 * scene.reach)
        view.set_ylim(y - 0.75 * scene.reach, y + 0.75 * scene.reach)
        gap, far = 0.25 * scene.reach, 12.0 * scene.reach
        lines = [[(k * gap, -far, 0.0), (k * gap, far, 0.0)] for k in range(-48, 49)]
        lines += [[(b, a, c) for a, b, c in line] for line in lines]
        view.add_collection(LineCollection([self._seen(np.array(line)) for line in lines], colors=PALE, linewidths=0.6))
        self.body: Any = PolyCollection([], edgecolors=INK, linewidths=0.7, zorder=3)
        view.add_collection(self.body)
        self.words = view.text(0.02, 0.97, "", fontsize=8, family="monospace", transform=view.transAxes, va="top")
        curve = self.figure.add_axes((0.11, 0.08, 0.86, 0.15))
        curve.plot(response.time, np.degrees(tilt_of(response)), color=_ROTATION, linewidth=1.0)
        curve.plot(response.impacts["time"], np.zeros(response.impacts.size), ".", color="#D96C00", markersize=3.5)
        curve.set_xlim(0.0, float(scene.time[-1]))
        curve.set_ylabel("tilt [deg]", fontsize=6)
        curve.set_xlabel("time [s]", fontsize=7, labelpad=1)
        curve.tick_params(labelsize=6)
        self.mark = curve.axvline(0.0, color=GREY, linewidth=0.8)

    def _seen(self, points: FloatArray) -> FloatArray:
        """Return the positions of points in the picture."""
        c, s = math.cos(self.scene.turned), math.sin(self.scene.turned)
        x, y, z = np.moveaxis(np.asarray(points), -1, 0)
        upright = math.cos(_RAISED) * z - math.sin(_RAISED) * (c * x + s * y)
        return np.stack([c * y - s * x, upright], axis=-1)

    def show(self, k: int, _: float) -> None:
        """Show the visible facets in a frame. Visible facets of a convex body do not overlap."""
        scene = self.scene
        turn = matrix(scene.quaternion[k])
        normals, points = scene.normals @ turn.T, scene.points @ turn.T + scene.centre[k]
        level, around = math.cos(_RAISED), scene.turned
        eye = np.array([level * math.cos(around), level * math.sin(around), math.sin(_RAISED)])
        front = np.flatnonzero(normals @ eye > 0.0)
        seen = self._seen(points)
        shade = 1.0 - _DARK * (1.0 - np.clip(normals[front] @ _LIGHT, 0.0, 1.0))
        self.body.set_verts([seen[scene.facets[facet]] for facet in front])
        self.body.set_facecolor(np.repeat(shade[:, None], 3, axis=1))
        self.words.set_text(f"t = {scene.time[k]:6.2f} s   tilt {math.degrees(scene.tilt[k]):6.2f} deg")
        self.mark.set_xdata([scene.time[k], scene.time[k]])
