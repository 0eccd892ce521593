"""Animations of a response: a self-contained web page, or a GIF."""

import base64
import hashlib
import html
import json
from collections.abc import Callable
from pathlib import Path
from string import Template
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError, RockingError
from rocking.motions.motion import GroundMotion
from rocking.outcome import Outcome
from rocking.plots.animation_hull import HullScene, HullStage, InSpace, description_of, end_of
from rocking.plots.animation_scene import DrawnShape, Scene, scene_of, scene_until
from rocking.plots.body import closed
from rocking.plots.response import motion_curves, over_slenderness
from rocking.plots.style import DASHED, GREY, INK, PALE, in_journal_style
from rocking.tables.table import writing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from matplotlib.transforms import Affine2D

NOT_MOVED = (
    "an animation needs a result of simulate or free_rocking, for a single body without restraints and isolators"
)
MOST_FRAMES = 500  # maximum number of frames of a GIF, for files of moderate size

_LIFTED = "The forces include the vertical ground motion; the animation does not show this motion."
_FALLS = (
    "The fall is computed by the same equation until a corner reaches the ground. The impact on a side is not computed."
)
_FOLDER = Path(__file__).parent

_DOTS, _WIDTH, _LINE = 100, 4.8, 80
"""Dots per inch of a GIF, its width [in], and the number of characters in a line of its title."""

_HEAD, _CURVE, _LEAST, _MOST = 0.42, 1.35, 1.4, 3.4
_HATCHES = 40
_ROTATION, _IMPACT = "#0070B2", "#D96C00"
_FLASH = 0.3  # duration of the mark of an impact in the animation [s]


def animate_html(response: Response | InSpace, path: str | Path) -> Path:
    """Write a web page with an animation of the body. The page can play, slow down, step, and show any instant.

    The page is one file without network access. Its content security policy allows only its own script and style.
    With ``#t=1.5`` at the end of the address, the page opens at this time.

    Parameters
    ----------
    response : Response, ContactResponse, SpatialResponse or HullResponse
        Result of `simulate` or `free_rocking`. 3D bodies, and plane bodies with sliding, appear as their convex hull.
    path : str or Path
        File with extension .html.

    Returns
    -------
    Path
        The written file.

    Raises
    ------
    RockingError
        If the extension is not .html, or the file cannot be written.
    """
    target = target_of(path, ".html")
    _shown_until(response)
    with writing(target):
        target.write_text(page(response), encoding="utf-8")
    return target


def page(response: Response | InSpace) -> str:
    """Return the web page of a response."""
    if isinstance(response, InSpace):
        return _page_in_space(response)
    motion = response.motion
    about = [
        "free rocking, the ground at rest" if motion is None else motion.name,
        *([f"{response.scale:g} times"] if response.scale != 1.0 else []),
        f"restitution {response.parameters.label}",
        f"engine {response.engine}",
    ]
    lifted = isinstance(motion, GroundMotion) and motion.vertical is not None
    return _assembled(
        "animation_page.html",
        _part("animation_page.js") + _part("animation_drawing.js"),
        response.summary,
        about,
        page_data(response),
        picture=html.escape(f"Animation of a {type(response.body).__name__} on moving ground: {response.summary}."),
        count=response.impacts.size,
        note=" ".join(
            [_LIFTED] * lifted + [_FALLS] * (response.outcome is Outcome.OVERTURNED)  # if they occurred
        ),
    )


def _page_in_space(response: InSpace) -> str:
    scene = HullScene.of(response)
    packed = {name: _packed(getattr(scene, name)) for name in ("quaternion", "centre", "tilt")}
    data = {
        **packed,
        "end": float(scene.time[-1]),
        "points": _short(scene.points),
        "normals": _short(scene.normals),
        "facets": scene.facets,
        "middle": scene.middle.tolist(),
        "reach": scene.reach,
        "turned": scene.turned,
    }
    picture = html.escape(f"Animation of a body in space on its ground: {response.summary}.")
    script, about = _part("animation_hull.js"), description_of(response)
    return _assembled("animation_hull.html", script, response.summary, about, data, picture=picture)


def _assembled(form: str, script: str, summary: str, about: list[str], data: dict[str, Any], **texts: Any) -> str:
    """Return a page from a template, with its content security policy."""
    style = _part("animation_page.css")
    policy = f"default-src 'none'; script-src {_hash(script)}; style-src {_hash(style)}; base-uri 'none'"
    # "<" is escaped, so that the name of a motion cannot end the script element
    text = json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    return Template(_part(form)).substitute(
        policy=html.escape(policy, quote=False), title=html.escape(summary[:1].upper() + summary[1:]),
        about=html.escape("; ".join(about)), style=style, script=script, data=text, **texts,
    )  # fmt: skip


def page_data(response: Response) -> dict[str, Any]:
    """Return the data of the page in SI units.

    Histories are little-endian float32 in base64, and events have full precision. `rotation`, `velocity`, `ground` and
    `acceleration` have equal time steps from 0 to `end`, including both ends.
    """
    scene = scene_of(response)
    parameters, fall = response.parameters, response.overturning_time
    impacts = response.impacts
    signs = np.where(impacts["foot"] == "right", 1, -1)
    columns = (impacts["time"], impacts["velocity_before"], impacts["velocity_after"], impacts["coefficient"], signs)
    shape = scene.shape
    return {
        "outcome": response.summary,
        "end": float(scene.time[-1]),
        "rotation": _packed(scene.rotation),
        "velocity": _packed(scene.velocity),
        "ground": _packed(scene.ground),
        "acceleration": _packed(scene.acceleration),
        "impacts": [list(row) for row in zip(*(column.tolist() for column in columns), strict=True)],
        "fall": None if np.isnan(fall) else fall,
        "overturnedTo": response.trajectory.side,
        "alpha": [parameters.left.slenderness_angle, parameters.right.slenderness_angle],
        "regions": [{"shade": shade, "rings": [_short(ring) for ring in rings]} for shade, rings in shape.regions],
        "points": _short(shape.points),
        "feet": list(shape.feet),
        "centre": list(shape.centre),
        "follows": scene.follows,
        "window": list(scene.window),
    }


def animate_gif(
    response: Response | InSpace,
    path: str | Path,
    fps: float = 25.0,
    speed: float = 1.0,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Write a GIF of the rocking body, with its rotation below.

    Parameters
    ----------
    response : Response, ContactResponse, SpatialResponse or HullResponse
        Result of `simulate` or `free_rocking`. 3D bodies, and plane bodies with sliding, appear as their convex hull.
    path : str or Path
        File with extension .gif.
    fps : float
        Frames per second, from 1 to 50; rounded to a duration of whole hundredths of a second.
    speed : float
        Seconds of the response per second of the animation, from 0.01 to 100 [-].
    progress : callable, optional
        Called after each frame with the number of completed frames and the total number.

    Returns
    -------
    Path
        The written file.

    Raises
    ------
    RockingError
        If the extension is not .gif, or the file cannot be written.
    InvalidValueError
        If a value is outside its range, or there are more than 500 frames.
    """
    target = target_of(path, ".gif")
    lasts = round(100.0 / checks.within("fps", fps, 1.0, 50.0)) / 100.0
    speed = checks.within("speed", speed, 0.01, 100.0)
    end = _shown_until(response)
    count = int(np.ceil(end / (lasts * speed))) + 1
    if count > MOST_FRAMES:
        raise InvalidValueError(
            "a GIF has at most {limit} frames, got {count}: {end:.3g} s of response at fps = {fps:g}",
            limit=MOST_FRAMES, count=count, end=end, fps=fps,
            hint=f"use speed = {slowest_speed(response, fps):.3g}, or a web page",
        )  # fmt: skip
    with writing(target):
        _film(response, target, lasts, lasts * speed, progress)
    return target


def slowest_speed(response: Response | InSpace, fps: float = 25.0) -> float:
    """Return the slowest speed (two digits, 1 or more) for which a GIF has an allowed number of frames [-]."""
    lasts = round(100.0 / fps) / 100.0
    return max(1.0, float(np.ceil(100.0 * _shown_until(response) / (lasts * (MOST_FRAMES - 2)))) / 100.0)


def _shown_until(response: Response | InSpace) -> float:
    """Return the end of the animation [s]; raise an error for objects without animation."""
    if isinstance(response, InSpace):
        return end_of(response)
    if not isinstance(response, Response):
        raise InvalidValueError(NOT_MOVED, hint="save a picture (.png or .svg)")
    return scene_until(response)


def target_of(path: str | Path, suffix: str) -> Path:
    """Return the path of an animation; raise an error for another extension."""
    target = Path(path)
    if target.suffix.lower() != suffix:
        raise RockingError(
            "the file of this animation must end in {suffix}, got {file!r}", suffix=suffix, file=target.name
        )
    return target


def _part(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8")


def _hash(script: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"


def _packed(values: FloatArray) -> str:
    return base64.b64encode(values.astype("<f4").tobytes()).decode()


def _short(points: FloatArray) -> list[list[float]]:
    # distances of 1e-7 of the body size are invisible
    unit = 10.0 ** np.floor(np.log10(np.abs(points).max(initial=0.0) or 1.0) - 6.0)
    return [[float(f"{value:.7g}") for value in row] for row in (np.round(points / unit) * unit).tolist()]


@in_journal_style
def _film(
    response: Response | InSpace,
    path: Path,
    lasts: float,
    step: float,
    progress: Callable[[int, int], object] | None = None,
) -> None:
    """Write the frames of a film.

    `lasts` is the duration of a frame in whole hundredths of a second [s], `step` the step of the response [s].
    """
    from matplotlib.animation import PillowWriter

    stage: Any = (
        HullStage(response, step) if isinstance(response, InSpace) else _Stage(response, scene_of(response, step))
    )
    # the writer truncates 1000 / fps to whole milliseconds; it accepts any number, although its type is integer
    rate: Any = (1.0 - 1e-9) / lasts
    writer = PillowWriter(fps=rate)
    with writer.saving(stage.figure, str(path), _DOTS):
        for k in range(stage.time.size):
            stage.show(k, _FLASH * step / lasts)
            writer.grab_frame()
            if progress is not None:
                progress(k + 1, stage.time.size)


class _Stage:
    """The figure of an animation and its moving artists."""

    def __init__(self, response: Response, scene: Scene) -> None:
        from matplotlib.figure import Figure
        from matplotlib.transforms import Affine2D

        self.response, self.scene, self.time = response, scene, scene.time
        x0, y0, x1, y1 = scene.window
        view_height = min(max(_WIDTH * (y1 - y0) / (x1 - x0), _LEAST), _MOST)
        lines = _title(response)
        total_height = _HEAD + 0.125 * max(len(lines) - 2, 0) + view_height + _CURVE
        self.figure = Figure(figsize=(_WIDTH, total_height), facecolor="white")
        self.figure.text(0.02, 1.0 - 0.06 / total_height, "\n".join(lines), va="top", fontsize=7.5)
        self.view = view = self.figure.add_axes((0.0, _CURVE / total_height, 1.0, view_height / total_height))
        view.set_axis_off()
        unit = max((x1 - x0) / _WIDTH, (y1 - y0) / view_height)  # the scale is the same in both directions
        wide, high, middle = unit * _WIDTH, unit * view_height, 0.5 * (x0 + x1)
        view.set_xlim(middle - 0.5 * wide, middle + 0.5 * wide)
        view.set_ylim(y0, y0 + high)
        self.body, self.ground = Affine2D(), Affine2D()
        self.period = draw_ground(view, scene, self.ground)
        draw_body(view, scene.shape, self.body)
        curve = self.figure.add_axes((0.11, 0.42 / total_height, 0.86, (_CURVE - 0.55) / total_height))
        self.mark = _draw_curve(curve, response, scene)
        ring: dict[str, Any] = {"markersize": 16, "markerfacecolor": "none", "markeredgewidth": 2, "color": _IMPACT}
        (self.flash,) = view.plot([], [], marker="o", **ring)
        corner: dict[str, Any] = {"transform": view.transAxes, "va": "top"}
        self.words = view.text(0.02, 0.98, "", fontsize=8, family="monospace", **corner)
        self.coefficient = view.text(0.98, 0.98, "", ha="right", fontsize=9, color=_IMPACT, **corner)

    def show(self, k: int, window: float) -> None:
        """Show a frame, and an impact within a window before it [s]."""
        response, scene = self.response, self.scene
        time, rotation, ground = (float(values[k]) for values in (scene.time, scene.rotation, scene.ground))
        foot = scene.shape.feet[1] if rotation > 0.0 else scene.shape.feet[0]
        camera = ground if scene.follows else 0.0
        self.body.clear().rotate_around(foot, 0.0, -rotation).translate(ground - camera, 0.0)
        self.ground.clear().translate(float(np.fmod(-ground if scene.follows else ground, self.period)), 0.0)
        ratio = over_slenderness(response, np.array([rotation]))
        self.mark.set_data([time], ratio)
        self.words.set_text(f"t = {time:6.2f} s   rotation {np.degrees(rotation):7.2f} deg")
        times = response.impacts["time"]
        last = int(np.searchsorted(times, time, side="right")) - 1
        if last >= 0 and time - times[last] < window:
            landing = 1 if response.impacts["foot"][last] == "right" else 0
            self.flash.set_data([scene.shape.feet[landing] + ground - camera], [0.0])
            self.coefficient.set_text(f"impact, r = {response.impacts['coefficient'][last]:.3f}")
        else:
            self.flash.set_data([], [])
            self.coefficient.set_text("")


def _title(response: Response) -> list[str]:
    title = response.summary[:1].upper() + response.summary[1:]
    first, _, details = title.partition(": ")
    return [first, *wrap(details, _LINE)] if details else first.replace(", past", ",\npast").split("\n")


def draw_ground(view: "Axes", scene: Scene, moved: "Affine2D") -> float:
    """Draw the ground, moved by a transformation, and return its spatial period [m]."""
    from matplotlib.collections import LineCollection

    left, right = view.get_xlim()
    wide = right - left
    gap = wide / _HATCHES
    view.axhline(0.0, color=INK, linewidth=0.9)
    feet = np.arange(left - wide, right + wide, gap)
    strokes = [[(x, 0.0), (x - 0.6 * gap, -0.6 * gap)] for x in feet.tolist()]
    if scene.follows:
        # the window moves with the ground, so that the background moves in the picture
        view.add_collection(LineCollection(strokes, colors=GREY, linewidths=0.7))
        strokes = [[(x, 0.0), (x, 4.0 * wide)] for x in feet[::8].tolist()]
    look: dict[str, Any] = {"colors": PALE if scene.follows else GREY, "linewidths": 0.7, "zorder": 0}
    view.add_collection(LineCollection(strokes, transform=moved + view.transData, **look))
    # hatches and lines are periodic, so that any displacement of the ground is possible
    return gap * (8.0 if scene.follows else 1.0)


def draw_body(view: "Axes", shape: DrawnShape, turned: "Affine2D") -> None:
    """Draw a body, rotated and moved by a transformation."""
    from matplotlib.patches import PathPatch

    transform: Any = turned + view.transData
    for shade, rings in shape.regions:
        look: dict[str, Any] = {"facecolor": [1.0 - 0.35 * shade] * 3, "edgecolor": INK, "linewidth": 1.0}
        view.add_patch(PathPatch(closed(rings), transform=transform, zorder=3, **look))
    if shape.points.size:
        sizes = 20.0 + 60.0 * shape.points[:, 2]
        left, right = shape.feet
        x, y = shape.centre
        view.plot([left, x, right, left], [0.0, y, 0.0, 0.0], color=GREY, linewidth=0.8, transform=transform, zorder=2)
        view.scatter(shape.points[:, 0], shape.points[:, 1], s=sizes, color=INK, transform=transform, zorder=3)
    view.plot(*([value] for value in shape.centre), "+", color=_ROTATION, markersize=7, transform=transform, zorder=4)


def _draw_curve(axes: "Axes", response: Response, scene: Scene) -> "Line2D":
    """Draw the rotation, and return its moving mark."""
    time, rotation, _ = motion_curves(response)
    values = over_slenderness(response, rotation)
    axes.axhline(0.0, color=PALE, linewidth=0.6)
    for level in (-1.0, 1.0):
        axes.axhline(level, color=GREY, linewidth=0.7, linestyle=DASHED)
    axes.plot(time, values, color=_ROTATION, linewidth=1.0)
    times = response.impacts["time"]
    axes.plot(times, np.zeros(times.size), ".", color=_IMPACT, markersize=3.5)
    axes.set_xlim(0.0, float(scene.time[-1]))
    most = 2.0 if response.outcome is Outcome.OVERTURNED else max(1.0, float(np.abs(values).max()))
    axes.set_ylim(-1.15 * most, 1.15 * most)
    axes.set_ylabel("rotation / alpha [-]", fontsize=6)
    axes.set_xlabel("time [s]", fontsize=7, labelpad=1)
    axes.tick_params(labelsize=6)
    (mark,) = axes.plot([], [], marker="o", markersize=5, color=INK, clip_on=True, zorder=5)
    return mark
