"""What `rocking simulate` was asked: a body, a motion or a first rotation, and how to compute."""

import math
from pathlib import Path
from typing import Any

from rocking import checks, plausibility
from rocking.bodies import Body
from rocking.cli.model_options import models_from
from rocking.cli.motion_options import motion_from
from rocking.cli.solid_options import is_body
from rocking.conventions import DEFAULT_FRICTION, g
from rocking.dynamics.response import Motion
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.spec.response import ResponseQuestion

Question = ResponseQuestion
"""Everything that a response depends on."""


def question_of(
    body: Body,
    motion: Motion | None,
    free: float | None,
    *,
    scale: float,
    gravity: float | None,
    engine: str,
    linear: bool,
    friction: float | None,
) -> Question:
    """Put the question together.

    free: first rotation over the slenderness angle of the side it leans to, for free rocking [-]; scale: factor on the
    motion [-]; gravity: acceleration of gravity; the standard one if not given [m/s2]; friction: coefficient of
    friction between body and ground, above zero; assumed if not given [-]. Returns checked as far as the engines do not
    check it.
    """
    pull = g if gravity is None else checks.positive("--gravity", gravity, "m/s2")
    share = None if free is None else _share(body, checks.number("--free", free))
    settings = Settings(gravity=pull, linear=linear)
    mu = DEFAULT_FRICTION if friction is None else checks.positive("--friction", friction)
    return Question(body, motion, {}, settings, engine, friction=mu, free=share, scale=scale)


def _share(body: Body, free: float) -> float:
    alpha = body.side("right" if free > 0.0 else "left").slenderness_angle
    if abs(free) * alpha >= 0.5 * math.pi:
        raise InvalidValueError(
            f"--free is a share of the slenderness angle, here {math.degrees(alpha):.3g} degrees, and 1 is where the "
            f"body balances; got {free:g}. An angle of {free:g} degrees is --free {math.radians(free) / alpha:.3g}"
        )
    if abs(free) > 1.0:
        plausibility.warn(
            [
                f"let go at {free:g} slenderness angles, beyond where the body balances: it can only fall. An angle of "
                f"{free:g} degrees is --free {math.radians(free) / alpha:.3g}"
            ]
        )
    return free


def body_and_motion(
    body: str | None, record: str | None, motion: str | None, *, sized: bool, free: bool
) -> tuple[Path | None, str | None]:
    """Return which word names the body and which one the motion.

    Returns motion: record file or pulse; None for free rocking.
    """
    if sized and record is None:
        body, record = None, body
    refuse_reversed(body, record)
    if record is not None and motion is not None:
        # a word that is a file beside dimensions is more likely a body
        raise InvalidValueError(f"one motion and one body, please: got {record[:100]!r} and --motion {motion[:100]!r}")
    word = record if record is not None else motion
    if free and word is not None:
        raise InvalidValueError(f"give a motion or --free, not both; got {word[:100]!r}")
    if not free and word is None:
        raise InvalidValueError(
            "what moves the ground? Give a record file, a pulse such as sine:amplitude=3,period=0.8, or --free 0.5"
        )
    return None if body is None else Path(body), word


def refuse_reversed(body: str | None, record: str | None) -> None:
    """Refuse a motion before its body."""
    if body is not None and record is not None and is_body(record) and not is_body(body):
        raise InvalidValueError(f"the body comes first, then the motion: {record[:100]} {body[:100]}, not the reverse")


def motion_asked(word: str | None, told: dict[str, Any], scale: float) -> Motion | None:
    """Return the motion, none for free rocking.

    scale: factor on the motion, refused for free rocking [-].
    """
    if word is not None:
        return motion_from(word, **told)
    given = [f"--{name.replace('_', '-')}" for name, value in told.items() if value is not None]
    given += ["--scale"] if scale != 1.0 else []
    if given:
        raise InvalidValueError(f"--free has no motion, so it takes no {', '.join(given)}")
    return None


def restitution_from(word: str) -> Any:
    """Return a model or a coefficient from one word."""
    try:
        return float(word)
    except ValueError:
        return next(iter(models_from([word]) or []))
