"""Several responses in motion side by side: the same body with different models, or different bodies."""

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
"""Dots in an inch, and sizes of what stands above one another [in]."""

_HOLD = 2.0  # how long the last frame stays [s]

_MOST_PANELS, _SHADES, _PAPER = 4, 64, 248
_VERDICTS = {True: ("overturned", "#A23B00"), False: ("stands", "#00664A")}


def animate_comparison(
    responses: Mapping[str, Response],
    path: str | Path,
    *,
    title: str = "",
    fps: float = 25.0,
    speed: float = 1.0,
    until: float | None = None,
) -> Path:
    """Write a GIF in which several responses run side by side, with their rotations below them.

    Parameters
    ----------
    responses : mapping of str to Response
        Two to four responses under their captions.
    path : str or Path
        File ending in .gif.
    title : str
        A line above them.
    fps : float
        Frames in a second of playing, from 1 to 50; rounded so that a frame lasts whole hundredths of a second.
    speed : float
        Seconds of the response in a second of playing, from 0.01 to 100 [-].
    until : float, optional
        Time of the response at which it ends; if not given, where nothing happens any more in any of them [s].

    Returns
    -------
    Path
        The file, which plays again and again; its last frame stays for two seconds.

    Raises
    ------
    RockingError
        If the name does not end in .gif, or the file cannot be written.
    InvalidValueError
        If a value is outside its range, or there would be more than 500 frames.

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
        raise InvalidValueError(
            parameter="responses", allowed=f"2 to {_MOST_PANELS} to stand side by side", value=len(responses)
        )
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
            hint=f"until, or a higher speed than {speed:g}, makes it shorter",
        )  # fmt: skip
    with writing(target):
        _save(_frames(responses, scenes, title, count, end), target, lasts)
    return target


@in_journal_style
def _frames(
    responses: Mapping[str, Response], scenes: list[Scene], title: str, count: int, end: float
) -> "list[Image]":
    """Draw what stays once, and over it what moves in each frame."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    window = np.array([scene.window for scene in scenes])
    x0, y0 = window[:, :2].min(axis=0)
    x1, y1 = window[:, 2:].max(axis=0)
    wide = _WIDTH / len(scenes)
    tall = wide * (y1 - y0) / (x1 - x0)
    whole = _HEAD + tall + _CAPTION + _CURVES
    figure = Figure(figsize=(_WIDTH, whole), facecolor="white")
    figure.text(0.5, 1.0 - 0.5 * _HEAD / whole, title, ha="center", va="center", fontsize=11, fontweight="bold")
    curves = figure.add_axes((0.075, 0.4 / whole, 0.905, (_CURVES - 0.5) / whole))
    _draw_curves(curves, responses, end)
    panels = []
    for k, (caption, response) in enumerate(responses.items()):
        place = (k / len(scenes), (_CURVES + _CAPTION) / whole, 1.0 / len(scenes), tall / whole)
        view = figure.add_axes(place, xlim=(x0, x1), ylim=(y0, y1))
        panels.append(_Panel(view, curves, caption, response, scenes[k], k))
    canvas: Any = FigureCanvasAgg(figure)
    moving = [artist for panel in panels for artist in panel.moving]
    for artist in moving:
        artist.set_animated(True)
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    frames = []
    for frame in range(count):
        canvas.restore_region(still)
        for panel in panels:
            panel.show(frame, last=frame == count - 1)
        for artist in moving:
            figure.draw_artist(artist)
        frames.append(Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy()))
    return frames


def _draw_curves(axes: "Axes", responses: Mapping[str, Response], end: float) -> None:
    """Draw all rotations, pale: what moves draws them again as far as they have come."""
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
        under: dict[str, Any] = {"transform": view.transAxes, "ha": "center", "va": "top", "fontsize": 9.5}
        view.text(0.5, -0.02, caption, color=color, **under)
        self.verdict = view.text(0.5, -0.14, "", fontweight="bold", **under)
        (self.curve,) = curves.plot([], [], **look(number))
        (self.mark,) = curves.plot([], [], "o", color=color, clip_on=True)
        time, rotation, _ = motion_curves(response)
        self.known = time, over_slenderness(response, rotation)
        self.moving: list[Artist] = [*view.collections, *view.patches, *view.lines, self.verdict, self.curve, self.mark]

    def show(self, frame: int, *, last: bool) -> None:
        """Move everything to where it is in a frame."""
        scene, k = self.scene, min(frame, self.scene.time.size - 1)
        time, rotation, ground = float(scene.time[k]), float(scene.rotation[k]), float(scene.ground[k])
        foot = scene.shape.feet[1] if rotation > 0.0 else scene.shape.feet[0]
        camera = ground if scene.follows else 0.0
        self.body.clear().rotate_around(foot, 0.0, -rotation).translate(ground - camera, 0.0)
        self.ground.clear().translate(float(np.fmod(-ground if scene.follows else ground, self.period)), 0.0)
        passed = int(np.searchsorted(self.known[0], time, side="right"))
        self.curve.set_data(self.known[0][:passed], self.known[1][:passed])
        self.mark.set_data([time], [float(over_slenderness(self.response, np.array([rotation]))[0])])
        falls = self.response.outcome is Outcome.OVERTURNED
        words, color = _VERDICTS[falls]
        known = time >= self.response.overturning_time if falls else last
        self.verdict.set(text=words if known else "", color=color)


def _save(frames: "list[Image]", path: Path, lasts: float) -> None:
    """Write frames, all in the colours of the first, a middle and the last one."""
    from PIL import Image

    few = [frames[k] for k in (0, len(frames) // 2, -1)]
    together = Image.fromarray(np.vstack([np.asarray(frame) for frame in few]))
    palette = together.quantize(_SHADES, dither=Image.Dither.NONE)
    palette.putpalette([255 if shade > _PAPER else shade for shade in palette.getpalette() or []])
    shown = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    duration = [round(1000.0 * lasts)] * (len(shown) - 1) + [round(1000.0 * _HOLD)]
    shown[0].save(path, save_all=True, append_images=shown[1:], duration=duration, loop=0, optimize=False)
