"""A response in motion: one web page that needs nothing else, or a GIF."""

import base64
import hashlib
import html
import json
from collections.abc import Callable
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError, RockingError
from rocking.motions.motion import GroundMotion
from rocking.outcome import Outcome
from rocking.plots.animation_film import film
from rocking.plots.animation_scene import scene_of, scene_until

MOST_FRAMES = 500
"""Frames of a GIF: more would make a file that no page wants to carry."""

_LIFTED = "The vertical motion of the ground counts in the forces but is not drawn."
_FALLS = (
    "The fall is computed by the same equation until a corner meets the ground; there the body is left lying, since a "
    "landing on a side is not computed."
)
_FOLDER = Path(__file__).parent


def animate_html(response: Response, path: str | Path) -> Path:
    """Write a web page in which the body rocks: play, slow down, step, drag to any instant.

    The page is one file: no network, no other script; it declares and keeps a content security policy that allows
    nothing but its own script and style. It opens at an instant if ``#t=1.5`` is added to its address.

    Parameters
    ----------
    response : Response
        What `simulate` or `free_rocking` returned.
    path : str or Path
        File ending in .html.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    RockingError
        If the name does not end in .html, or the file cannot be written.
    """
    target = _target(path, ".html")
    try:
        target.write_text(page(response), encoding="utf-8")
    except OSError as error:
        raise RockingError(f"cannot write {target}: {error.strerror or error}") from error
    return target


def page(response: Response) -> str:
    """Return the web page of a response.

    >>> import rocking as rk
    >>> block = rk.Block(width=0.5, height=2.0)
    >>> page(rk.free_rocking(block, rotation=0.1))[:15]
    '<!DOCTYPE html>'
    """
    style, form = _part("animation_page.css"), _part("animation_page.html")
    script = _part("animation_page.js") + _part("animation_drawing.js")
    policy = f"default-src 'none'; script-src {_hash(script)}; style-src {_hash(style)}; base-uri 'none'"
    summary = response.summary[:1].upper() + response.summary[1:]
    motion = response.motion
    about = [
        "free rocking, the ground at rest" if motion is None else motion.name,
        *([f"{response.scale:g} times"] if response.scale != 1.0 else []),
        f"restitution {response.parameters.label}",
        f"engine {response.engine}",
    ]
    lifted = isinstance(motion, GroundMotion) and motion.vertical is not None
    # "<" cannot end the script element early, whatever a motion is called
    data = json.dumps(page_data(response), allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    return Template(form).substitute(
        policy=html.escape(policy, quote=False),
        title=html.escape(summary),
        about=html.escape("; ".join(about)),
        picture=html.escape(f"Animation of a {type(response.body).__name__} on moving ground: {response.summary}."),
        count=response.impacts.size,
        note=" ".join(
            [_LIFTED] * lifted + [_FALLS] * (response.outcome is Outcome.OVERTURNED)  # both, one, or nothing to add
        ),
        style=style,
        script=script,
        data=data,
    )


def page_data(response: Response) -> dict[str, Any]:
    """Return what the page draws: histories as little-endian float32 in base64, events to the last digit.

    Returns SI units; `rotation`, `velocity`, `ground` and `acceleration` at equal steps from 0 to `end`, both included.
    """
    scene = scene_of(response)
    parameters, fall = response.parameters, response.overturning_time
    impacts = response.impacts
    signs = np.where(impacts["onto"] == "right", 1, -1)
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
    response: Response,
    path: str | Path,
    fps: float = 25.0,
    speed: float = 1.0,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Write a GIF in which the body rocks, with the rotation below it.

    Parameters
    ----------
    response : Response
        What `simulate` or `free_rocking` returned.
    path : str or Path
        File ending in .gif.
    fps : float
        Frames in a second of playing, from 1 to 50; rounded so that a frame lasts whole hundredths of a second.
    speed : float
        Seconds of the response in a second of playing, from 0.01 to 100 [-].
    progress : callable, optional
        Called after each frame with the frames done and all frames.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    RockingError
        If the name does not end in .gif, or the file cannot be written.
    InvalidValueError
        If a value is outside its range, or there would be more than 500 frames.
    """
    target = _target(path, ".gif")
    lasts = round(100.0 / checks.within("fps", fps, 1.0, 50.0)) / 100.0
    speed = checks.within("speed", speed, 0.01, 100.0)
    end = scene_until(response)
    count = int(np.ceil(end / (lasts * speed))) + 1
    if count > MOST_FRAMES:
        raise InvalidValueError(
            f"a GIF has at most {MOST_FRAMES} frames, got {count}: {end:.3g} s of response at fps = {fps:g}; "
            f"speed = {slowest_speed(response, fps):.3g} would do, or a web page"
        )
    try:
        film(response, target, lasts, lasts * speed, progress)
    except OSError as error:
        raise RockingError(f"cannot write {target}: {error.strerror or error}") from error
    return target


def slowest_speed(response: Response, fps: float = 25.0) -> float:
    """Return the slowest speed at which a GIF of a response has few enough frames, at least real speed.

    Returns seconds of the response in a second of playing, rounded up to two digits behind the point [-].
    """
    lasts = round(100.0 / fps) / 100.0
    return max(1.0, float(np.ceil(100.0 * scene_until(response) / (lasts * (MOST_FRAMES - 2)))) / 100.0)


def _target(path: str | Path, suffix: str) -> Path:
    target = Path(path)
    if target.suffix.lower() != suffix:
        raise RockingError(f"this animation is a {suffix} file, got {target.name!r}")
    return target


def _part(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8")


def _hash(words: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(words.encode()).digest()).decode()}'"


def _packed(values: FloatArray) -> str:
    return base64.b64encode(values.astype("<f4").tobytes()).decode()


def _short(points: FloatArray) -> list[list[float]]:
    # a tenth of a millionth of the body is below anything that can be seen
    unit = 10.0 ** np.floor(np.log10(np.abs(points).max(initial=0.0) or 1.0) - 6.0)
    return [[float(f"{value:.7g}") for value in row] for row in (np.round(points / unit) * unit).tolist()]
