"""What an animation shows of a body in space with friction: its convex hull on the ground, seen from a side."""

import math
from dataclasses import dataclass
from textwrap import wrap
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.hull.response import HullResponse
from rocking.dynamics.space.attitude import matrix
from rocking.plots.style import GREY, INK, PALE

_RATE, _MOST = 60.0, 6000
"""Poses in a second, and in all."""

_TURNED, _RAISED = 0.6, 0.35
"""From where it is seen: from x towards y, and above the ground [rad]."""

_LIGHT = np.array([0.35, -0.25, 0.9])
_ROTATION = "#0072B2"
_DARK, _LINE = 0.35, 80


@dataclass(frozen=True, eq=False)
class HullScene:
    """The hull of a body from its centre of mass, and where it is at equal steps of time."""

    time: FloatArray  # [s]
    quaternion: FloatArray  # attitude (s, x, y, z) [-]; shape (n, 4)
    centre: FloatArray  # place of the centre of mass over the ground [m]; shape (n, 3)
    tilt: FloatArray  # angle from the pose at the start [rad]
    points: FloatArray  # vertices of the hull [m]; shape (k, 3)
    facets: list[list[int]]  # their vertices, counter-clockwise seen from outside
    normals: FloatArray  # of the facets, outward [-]
    middle: FloatArray  # of all that is shown [m]
    reach: float  # how far from there anything goes [m]

    @classmethod
    def of(cls, response: HullResponse, step: float | None = None) -> "HullScene":
        """Return a response at steps of time [s], 60 a second or fewer if not given."""
        end, hull = response.end, response.body.hull
        if step is None:
            time = np.linspace(0.0, end, min(max(2, int(end * _RATE)), _MOST))
        else:
            time = np.append(np.arange(0.0, end, step), end)
        states, size = response.at(time), response.body.size
        low, high = states.centre.min(axis=0) - size, states.centre.max(axis=0) + size
        low[2] = 0.0
        follows: list[dict[int, int]] = [{} for _ in hull.normals]
        for (start, stop), (left, right) in zip(hull.ends.tolist(), hull.sides.tolist(), strict=True):
            follows[left][start], follows[right][stop] = stop, start
        return cls(
            time, states.quaternion, states.centre, np.interp(time, response.time, response.tilt), hull.vertices,
            [_loop(each) for each in follows], hull.normals, 0.5 * (low + high), 0.5 * float((high - low).max()),
        )  # fmt: skip


def _loop(after: dict[int, int]) -> list[int]:
    """Return the vertices of a facet in order, of which each says which one follows."""
    found = [next(iter(after))]
    while len(found) < len(after):
        found.append(after[found[-1]])
    return found


class HullStage:
    """The figure of a film, and what moves in it."""

    def __init__(self, response: HullResponse, step: float) -> None:
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
        curve.plot(response.time, np.degrees(response.tilt), color=_ROTATION, linewidth=1.0)
        curve.plot(response.impacts["time"], np.zeros(response.impacts.size), ".", color="#D55E00", markersize=3.5)
        curve.set_xlim(0.0, float(scene.time[-1]))
        curve.set_ylabel("tilt [deg]", fontsize=6)
        curve.set_xlabel("time [s]", fontsize=7, labelpad=1)
        curve.tick_params(labelsize=6)
        self.mark = curve.axvline(0.0, color=GREY, linewidth=0.8)

    @staticmethod
    def _seen(points: FloatArray) -> FloatArray:
        """Return where points are in the picture."""
        c, s = math.cos(_TURNED), math.sin(_TURNED)
        x, y, z = np.moveaxis(np.asarray(points), -1, 0)
        upright = math.cos(_RAISED) * z - math.sin(_RAISED) * (c * x + s * y)
        return np.stack([c * y - s * x, upright], axis=-1)

    def show(self, k: int, _: float) -> None:
        """Show a frame: of a convex body the facets that face the eye, none of which hides another."""
        scene = self.scene
        turn = matrix(scene.quaternion[k])
        normals, points = scene.normals @ turn.T, scene.points @ turn.T + scene.centre[k]
        eye = np.array(
            [math.cos(_RAISED) * math.cos(_TURNED), math.cos(_RAISED) * math.sin(_TURNED), math.sin(_RAISED)]
        )
        front = np.flatnonzero(normals @ eye > 0.0)
        seen = self._seen(points)
        shade = 1.0 - _DARK * (1.0 - np.clip(normals[front] @ _LIGHT, 0.0, 1.0))
        self.body.set_verts([seen[scene.facets[facet]] for facet in front])
        self.body.set_facecolor(np.repeat(shade[:, None], 3, axis=1))
        self.words.set_text(f"t = {scene.time[k]:6.2f} s   tilt {math.degrees(scene.tilt[k]):6.2f} deg")
        self.mark.set_xdata([scene.time[k], scene.time[k]])
