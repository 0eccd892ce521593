"""The frames of a GIF: the body on its ground, and the rotation with a moving mark."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.dynamics.response import Response
from rocking.outcome import Outcome
from rocking.plots.animation_scene import DrawnShape, Scene, scene_of
from rocking.plots.response_curves import motion_curves, over_slenderness
from rocking.plots.style import GREY, INK, PALE, in_journal_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.text import Text
    from matplotlib.transforms import Affine2D

_DOTS, _WIDTH = 100, 4.8
_LINE = 80
"""Characters that fit into one line of the title."""
_HEAD, _CURVE, _LEAST, _MOST = 0.42, 1.35, 1.4, 3.4
_HATCHES = 40
_ROTATION, _IMPACT = "#0072B2", "#D55E00"
_FLASH = 0.3
"""How long an impact is seen, in seconds of playing."""


@dataclass(frozen=True, eq=False)
class _Stage:
    figure: "Figure"
    body: "Affine2D"
    ground: "Affine2D"
    view: "Axes"
    mark: "Line2D"
    flash: "Line2D"
    words: "Text"
    coefficient: "Text"


@in_journal_style
def film(
    response: Response, path: Path, lasts: float, step: float, progress: Callable[[int, int], object] | None = None
) -> None:
    """Write the frames of a response as a GIF.

    lasts: how long a frame is shown, whole hundredths of a second [s]; step: time of the response between frames [s].
    """
    from matplotlib.animation import PillowWriter

    scene = scene_of(response, step)
    stage = _stage(response, scene)
    # the writer cuts 1000 / fps down to whole milliseconds; it takes any number, though it is declared for whole ones
    rate: Any = (1.0 - 1e-9) / lasts
    writer = PillowWriter(fps=rate)
    with writer.saving(stage.figure, str(path), _DOTS):
        for k in range(scene.time.size):
            _show(stage, response, scene, k, _FLASH * step / lasts)
            writer.grab_frame()
            if progress is not None:
                progress(k + 1, scene.time.size)


def _stage(response: Response, scene: Scene) -> _Stage:
    from matplotlib.figure import Figure
    from matplotlib.transforms import Affine2D

    x0, y0, x1, y1 = scene.window
    tall = min(max(_WIDTH * (y1 - y0) / (x1 - x0), _LEAST), _MOST)
    title = response.summary[:1].upper() + response.summary[1:]
    first, _, rest = title.partition(": ")
    lines = [first, *wrap(rest, _LINE)] if rest else first.replace(", past", ",\npast").split("\n")
    whole = _HEAD + 0.125 * max(len(lines) - 2, 0) + tall + _CURVE
    figure = Figure(figsize=(_WIDTH, whole), facecolor="white")
    figure.text(0.02, 1.0 - 0.06 / whole, "\n".join(lines), va="top", fontsize=7.5)
    view = figure.add_axes((0.0, _CURVE / whole, 1.0, tall / whole))
    view.set_axis_off()
    wide, high = _span(scene, tall)
    middle = 0.5 * (x0 + x1)
    view.set_xlim(middle - 0.5 * wide, middle + 0.5 * wide)
    view.set_ylim(y0, y0 + high)
    body, ground = Affine2D(), Affine2D()
    _ground(view, scene, ground, wide)
    _body(view, scene.shape, body)
    curve = figure.add_axes((0.11, 0.42 / whole, 0.86, (_CURVE - 0.55) / whole))
    (mark,) = _curve(curve, response, scene)
    (flash,) = view.plot([], [], marker="o", markersize=16, markerfacecolor="none", markeredgewidth=2, color=_IMPACT)
    texts = [
        view.text(0.02, 0.98, "", transform=view.transAxes, va="top", fontsize=8, family="monospace"),
        view.text(0.98, 0.98, "", transform=view.transAxes, va="top", ha="right", fontsize=9, color=_IMPACT),
    ]
    return _Stage(figure, body, ground, view, mark, flash, *texts)


def _span(scene: Scene, tall: float) -> tuple[float, float]:
    """Return width and height of what the view shows, the scale the same in both directions [m]."""
    x0, y0, x1, y1 = scene.window
    unit = max((x1 - x0) / _WIDTH, (y1 - y0) / tall)
    return unit * _WIDTH, unit * tall


def _ground(view: "Axes", scene: Scene, moved: "Affine2D", wide: float) -> None:
    from matplotlib.collections import LineCollection

    (left, right), gap = view.get_xlim(), wide / _HATCHES
    view.axhline(0.0, color=INK, linewidth=0.9)
    feet = np.arange(left - wide, right + wide, gap)
    strokes = [[(x, 0.0), (x - 0.6 * gap, -0.6 * gap)] for x in feet.tolist()]
    if scene.follows:
        # the window moves with the ground, so the world behind it is what moves
        view.add_collection(LineCollection(strokes, colors=GREY, linewidths=0.7))
        strokes = [[(x, 0.0), (x, 4.0 * wide)] for x in feet[::8].tolist()]
    color = PALE if scene.follows else GREY
    view.add_collection(
        LineCollection(strokes, colors=color, linewidths=0.7, transform=moved + view.transData, zorder=0)
    )


def _body(view: "Axes", shape: DrawnShape, turned: "Affine2D") -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    place: Any = turned + view.transData
    for shade, rings in shape.regions:
        parts = [Outline(np.vstack([ring, ring[:1]]), closed=True) for ring in rings]
        face = [1.0 - 0.35 * shade] * 3
        outline = Outline.make_compound_path(*parts)
        view.add_patch(PathPatch(outline, facecolor=face, edgecolor=INK, linewidth=1.0, transform=place, zorder=3))
    if shape.points.size:
        sizes = 20.0 + 60.0 * shape.points[:, 2]
        left, right = shape.feet
        x, y = shape.centre
        view.plot([left, x, right, left], [0.0, y, 0.0, 0.0], color=GREY, linewidth=0.8, transform=place, zorder=2)
        view.scatter(shape.points[:, 0], shape.points[:, 1], s=sizes, color=INK, transform=place, zorder=3)
    view.plot(*([value] for value in shape.centre), "+", color=_ROTATION, markersize=7, transform=place, zorder=4)


def _curve(axes: "Axes", response: Response, scene: Scene) -> "list[Line2D]":
    curves = motion_curves(response)
    values = over_slenderness(response, curves.rotation)
    axes.axhline(0.0, color=PALE, linewidth=0.6)
    for level in (-1.0, 1.0):
        axes.axhline(level, color=GREY, linewidth=0.7, linestyle=(0, (4, 2)))
    axes.plot(curves.time, values, color=_ROTATION, linewidth=1.0)
    times = response.impacts["time"]
    axes.plot(times, np.zeros(times.size), ".", color=_IMPACT, markersize=3.5)
    axes.set_xlim(0.0, float(scene.time[-1]))
    most = 2.0 if response.outcome is Outcome.OVERTURNED else max(1.0, float(np.abs(values).max()))
    axes.set_ylim(-1.15 * most, 1.15 * most)
    axes.set_ylabel("rotation / alpha [-]", fontsize=6)
    axes.set_xlabel("time [s]", fontsize=7, labelpad=1)
    axes.tick_params(labelsize=6)
    return axes.plot([], [], marker="o", markersize=5, color=INK, clip_on=True, zorder=5)


def _show(stage: _Stage, response: Response, scene: Scene, k: int, window: float) -> None:
    time, rotation, ground = (float(values[k]) for values in (scene.time, scene.rotation, scene.ground))
    foot = scene.shape.feet[1] if rotation > 0.0 else scene.shape.feet[0]
    camera = ground if scene.follows else 0.0
    stage.body.clear().rotate_around(foot, 0.0, -rotation).translate(ground - camera, 0.0)
    left, right = stage.view.get_xlim()
    # hatches and lines repeat, so that the ground may move as far as it likes
    period = (right - left) / _HATCHES * (8.0 if scene.follows else 1.0)
    stage.ground.clear().translate(float(np.fmod(-ground if scene.follows else ground, period)), 0.0)
    ratio = over_slenderness(response, np.array([rotation]))
    stage.mark.set_data([time], ratio)
    stage.words.set_text(f"t = {time:6.2f} s   rotation {np.degrees(rotation):7.2f} deg")
    times = response.impacts["time"]
    last = int(np.searchsorted(times, time, side="right")) - 1
    if last >= 0 and time - times[last] < window:
        onto = 1 if response.impacts["onto"][last] == "right" else 0
        stage.flash.set_data([scene.shape.feet[onto] + ground - camera], [0.0])
        stage.coefficient.set_text(f"impact, r = {response.impacts['coefficient'][last]:.3f}")
    else:
        stage.flash.set_data([], [])
        stage.coefficient.set_text("")
