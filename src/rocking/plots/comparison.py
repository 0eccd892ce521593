"""Animations of several responses next to each other: one body with different models, or different bodies."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome
from rocking.plots.animation import MOST_FRAMES, draw_body, draw_ground, target_of
from rocking.plots.animation_scene import Scene, scene_of
from rocking.plots.response import motion_curves, over_slenderness
from rocking.plots.style import DASHED, GREY, PALE, in_journal_style, look
from rocking.tables.table import writing

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from PIL.Image import Image

_DOTS, _WIDTH, _HEAD, _CAPTION, _CURVES = 110, 7.4, 0.34, 0.5, 1.45
"""Dots per inch, and sizes of the parts from top to bottom [in]."""

_HOLD = 2.0  # duration of the last frame [s]

_MOST_PANELS, _SHADES, _PAPER = 4, 64, 248
_VERDICTS = {True: ("overturned", "#A23B00"), False: ("did not overturn", "#00664A")}


def animate_comparison(
    responses: Mapping[str, Response],
    path: str | Path,
    *,
    title: str = "",
    fps: float = 25.0,
    speed: float = 1.0,
    until: float | None = None,
) -> Path:
    """Write a GIF of several responses next to each other, with the rotations below.

    Parameters
    ----------
    responses : mapping of str to Response
        Two to four responses by caption.
    path : str or Path
        File with extension .gif.
    title : str
        Line above the responses.
    fps : float
        Frames per second, from 1 to 50; rounded to a duration of whole hundredths of a second.
    speed : float
        Seconds of the response per second of the animation, from 0.01 to 100 [-].
    until : float, optional
        Time of the response at the end; default: the end of the longest response [s].

    Returns
    -------
    Path
        The written file. The animation repeats, and its last frame lasts two seconds.

    Raises
    ------
    RockingError
        If the extension is not .gif, or the file cannot be written.
    InvalidValueError
        If a value is outside its range, or there are more than 500 frames.

    Examples
    --------
    >>> import rocking as rk
    >>> cabinet, pulse = rk.Block(width=0.6, height=2.0), rk.pulses.sine(amplitude=7.6, period=0.5)
    >>> both = {name: rk.simulate(cabinet, pulse, restitution=name) for name in ("housner", "ked")}
    >>> animate_comparison(both, "both.gif", until=2.0)  # doctest: +SKIP
    PosixPath('both.gif')
    """
    target = target_of(path, ".gif")
    if not 2 <= len(responses) <= _MOST_PANELS:
        raise InvalidValueError(parameter="responses", allowed=f"2 to {_MOST_PANELS} responses", value=len(responses))
    lasts = round(100.0 / checks.within("fps", fps, 1.0, 50.0)) / 100.0
    step = lasts * checks.within("speed", speed, 0.01, 100.0)
    scenes = [scene_of(response, step) for response in responses.values()]
    end = max(float(scene.time[-1]) for scene in scenes)
    end = end if until is None else min(end, checks.positive("until", until))
    count = int(np.ceil(end / step)) + 1
    if count > MOST_FRAMES:
        raise InvalidValueError(
            "a GIF has at most {limit} frames, got {count}: {end:.3g} s of response at fps = {fps:g}",
            limit=MOST_FRAMES, count=count, end=end, fps=fps,
            hint=f"use until, or a speed above {speed:g}",
        )  # fmt: skip
    with writing(target):
        _save(_frames(responses, scenes, title, count, end), target, lasts)
    return target


@in_journal_style
def _frames(
    responses: Mapping[str, Response], scenes: list[Scene], title: str, count: int, end: float
) -> "list[Image]":
    """Draw the fixed parts once, and the moving parts in each frame."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    window = np.array([scene.window for scene in scenes])
    x0, y0 = window[:, :2].min(axis=0)
    x1, y1 = window[:, 2:].max(axis=0)
    view_width = _WIDTH / len(scenes)
    view_height = view_width * (y1 - y0) / (x1 - x0)
    total_height = _HEAD + view_height + _CAPTION + _CURVES
    figure = Figure(figsize=(_WIDTH, total_height), facecolor="white")
    figure.text(0.5, 1.0 - 0.5 * _HEAD / total_height, title, ha="center", va="center", fontsize=11, fontweight="bold")
    curves = figure.add_axes((0.075, 0.4 / total_height, 0.905, (_CURVES - 0.5) / total_height))
    _draw_curves(curves, responses, end)
    panels = []
    for k, (caption, response) in enumerate(responses.items()):
        bounds = (k / len(scenes), (_CURVES + _CAPTION) / total_height, 1.0 / len(scenes), view_height / total_height)
        view = figure.add_axes(bounds, xlim=(x0, x1), ylim=(y0, y1))
        panels.append(_Panel(view, curves, caption, response, scenes[k], k))
    canvas: Any = FigureCanvasAgg(figure)
    moving = [artist for panel in panels for artist in panel.moving]
    for artist in moving:
        artist.set_animated(True)
    canvas.draw()
    background = canvas.copy_from_bbox(figure.bbox)
    frames = []
    for frame in range(count):
        canvas.restore_region(background)
        for panel in panels:
            panel.show(frame, last=frame == count - 1)
        for artist in moving:
            figure.draw_artist(artist)
        frames.append(Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy()))
    return frames


def _draw_curves(axes: "Axes", responses: Mapping[str, Response], end: float) -> None:
    """Draw all rotations in pale colours. The moving curves are plotted over them."""
    for level in (-1.0, 1.0):
        axes.axhline(level, color=GREY, linewidth=0.7, linestyle=DASHED)
    for response in responses.values():
        time, rotation, _ = motion_curves(response)
        axes.plot(time, over_slenderness(response, rotation), color=PALE, linewidth=1.0)
    axes.set(xlim=(0.0, end), ylim=(-1.6, 1.6), xlabel="time [s]", ylabel="rotation / alpha [-]")


class _Panel:
    """One response: its body, its caption and its curve."""

    def __init__(
        self,
        view: "Axes",
        curves: "Axes",
        caption: str,
        response: Response,
        scene: Scene,
        number: int,
    ) -> None:
        from matplotlib.transforms import Affine2D

        self.response, self.scene = response, scene
        view.set_axis_off()
        self.body, self.ground = Affine2D(), Affine2D()
        self.period = draw_ground(view, scene, self.ground)
        draw_body(view, scene.shape, self.body)
        color: str = look(number)["color"]
        text_style: dict[str, Any] = {"transform": view.transAxes, "ha": "center", "va": "top", "fontsize": 9.5}
        view.text(0.5, -0.02, caption, color=color, **text_style)
        self.verdict = view.text(0.5, -0.14, "", fontweight="bold", **text_style)
        (self.curve,) = curves.plot([], [], **look(number))
        (self.mark,) = curves.plot([], [], "o", color=color, clip_on=True)
        time, rotation, _ = motion_curves(response)
        self.known = time, over_slenderness(response, rotation)
        self.moving: list[Artist] = [*view.collections, *view.patches, *view.lines, self.verdict, self.curve, self.mark]

    def show(self, frame: int, *, last: bool) -> None:
        """Move the artists to their positions in a frame."""
        scene, k = self.scene, min(frame, self.scene.time.size - 1)
        time, rotation, ground = float(scene.time[k]), float(scene.rotation[k]), float(scene.ground[k])
        foot = scene.shape.feet[1] if rotation > 0.0 else scene.shape.feet[0]
        camera = ground if scene.follows else 0.0
        self.body.clear().rotate_around(foot, 0.0, -rotation).translate(ground - camera, 0.0)
        self.ground.clear().translate(float(np.fmod(-ground if scene.follows else ground, self.period)), 0.0)
        passed = int(np.searchsorted(self.known[0], time, side="right"))
        self.curve.set_data(self.known[0][:passed], self.known[1][:passed])
        self.mark.set_data([time], [float(over_slenderness(self.response, np.array([rotation]))[0])])
        overturns = self.response.outcome is Outcome.OVERTURNED
        verdict, color = _VERDICTS[overturns]
        is_decided = time >= self.response.overturning_time if overturns else last
        self.verdict.set(text=verdict if is_decided else "", color=color)


def _save(frames: "list[Image]", path: Path, lasts: float) -> None:
    """Write frames with one palette, made from the first frame, a middle frame and the last frame."""
    from PIL import Image

    few = [frames[k] for k in (0, len(frames) // 2, -1)]
    together = Image.fromarray(np.vstack([np.asarray(frame) for frame in few]))
    palette = together.quantize(_SHADES, dither=Image.Dither.NONE)
    palette.putpalette([255 if shade > _PAPER else shade for shade in palette.getpalette() or []])
    shown = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    duration = [round(1000.0 * lasts)] * (len(shown) - 1) + [round(1000.0 * _HOLD)]
    shown[0].save(path, save_all=True, append_images=shown[1:], duration=duration, loop=0, optimize=False)
