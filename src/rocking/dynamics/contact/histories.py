"""One plane body whose feet may slide, hop and bounce."""

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from rocking import checks, conventions, plausibility
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.dynamics.contact.base import PlaneBase, Start, state_at_start
from rocking.dynamics.contact.batch import (
    AFTER,
    FAST,
    FINE,
    NUMBERS,
    REFERENCE,
    chosen,
    ends_of,
    library_of,
    run_compiled,
)
from rocking.dynamics.contact.engine import ContactEngine
from rocking.dynamics.contact.impact_resolution import GroundContact
from rocking.dynamics.contact.response import ContactResponse
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters, is_none
from rocking.dynamics.response_base import followed, ground_at_rest
from rocking.dynamics.settings import Settings, check_progress, check_threads, processors
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, of_results, overturned

_FREE = 60.0
PIECE = 1 << 14
"""Histories that are handed to the fast engine at a time."""


def response_with_contact(  # noqa: PLR0913 - what the front door hands on
    body: Body,
    motion: GroundMotion | Pulse | None,
    friction: float,
    restitution: Any,
    settings: Settings,
    *,
    bounce: float = 0.0,
    bounce_law: str = "newton",
    start: Start,
    scale: float = 1.0,
    duration: float | None = None,
) -> ContactResponse:
    """Return how a body rests, slides, rocks, slides while it rocks, and flies; on ground at rest without a motion."""
    # restitution: None for impacts by complementarity alone; duration: how long to follow the body [s]; if not given,
    # the motion and 15 sqrt(R / g) after it, 60 sqrt(R / g) on ground at rest
    base = PlaneBase.of_body(body)
    law = GroundContact(
        friction if isinstance(friction, conventions.Assumed) else checks.number("friction", friction),
        checks.number("bounce", bounce),
        _imposed(body, restitution, settings),
        bounce_law,
    )
    scale = checks.within("scale", scale, -1e6, 1e6)
    segments = _segments(motion, base, settings.gravity, duration)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    history = ContactEngine(base, segments, law, settings, scale).run(state_at_start(start, base))
    return ContactResponse(body, motion, base, law, settings, segments, scale, history)


def many_with_contact(  # noqa: PLR0913 - what the front door hands on
    bodies: Sequence[Body],
    motions: Sequence[GroundMotion | Pulse],
    scales: FloatArray,
    restitutions: Sequence[Any],
    friction: FloatArray,
    settings: Settings,
    *,
    bounce: float = 0.0,
    bounce_law: str = "newton",
    start: Start | None = None,
    duration: float | None = None,
    engine: str = "auto",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> tuple[dict[str, np.ndarray], str]:
    """Return the results of every combination, the last axis (friction) running fastest, and which engine ran."""
    if start is not None and not isinstance(start, Start):
        raise InvalidValueError(f"start must be a Start(...), got {start!r:.60}")
    check_progress(progress)
    check_threads(threads)
    for mu in friction:
        plausibility.warn(plausibility.of_friction(checks.within("friction", float(mu), 0.0, 1e6)))
    if chosen(engine) == "fast":
        imposed = [[_imposed(body, each, settings) or (np.nan, np.nan) for each in restitutions] for body in bodies]
        law = GroundContact(0.0, checks.number("bounce", bounce), None, bounce_law)
        bases = [PlaneBase.of_body(body) for body in bodies]
        table = _Table(bases, motions, scales, np.array(imposed), friction, law, start or Start(), duration, settings)
        return table.run(threads or processors(), progress), FAST
    rows = []
    for body, motion, scale, restitution, mu in product(bodies, motions, scales, restitutions, friction):
        with warnings.catch_warnings():  # said once, before
            warnings.simplefilter("ignore", PlausibilityWarning)
            response = response_with_contact(
                body, motion, float(mu), restitution, settings, bounce=bounce, bounce_law=bounce_law,
                start=start or Start(), scale=float(scale), duration=duration,
            )  # fmt: skip
        rows.append(_row_of(response))
        if progress is not None:
            progress(1)
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}, REFERENCE


@dataclass(frozen=True)
class _Table:
    """Every combination of bodies, motions, scales, restitutions and coefficients of friction, for the fast engine."""

    bases: Sequence[PlaneBase]
    motions: Sequence[GroundMotion | Pulse]
    scales: FloatArray
    imposed: FloatArray  # of each body and restitution, landing left and right [-]
    friction: FloatArray
    law: GroundContact
    start: Start
    duration: float | None
    settings: Settings

    def run(self, threads: int, progress: Callable[[int], None] | None) -> dict[str, np.ndarray]:
        """Return the columns of `_row_of`, computed piece by piece."""
        segments = [motion.segments() for motion in self.motions]
        library = library_of(segments)
        numbers = [(base.inertia, base.height, base.left, base.right) for base in self.bases]
        starts = [state_at_start(self.start, base) for base in self.bases]
        ends = np.array([
            [ends_of(_length(motion, slow, self.duration), each.step, isinstance(motion, Pulse), slow)
             for motion, each in zip(self.motions, segments, strict=True)]
            for slow in (math.sqrt(base.size / self.settings.gravity) for base in self.bases)
        ])  # fmt: skip
        shape = (len(self.bases), len(self.motions), self.scales.size, self.imposed.shape[1], self.friction.size)
        touching = np.array([sum(1 if foot < 0 else 2 for foot in each.touching) for each in starts])
        count, pieces = int(np.prod(shape)), []
        for first in range(0, count, PIECE):
            last = min(first + PIECE, count)
            body, motion, scale, choice, mu = np.unravel_index(np.arange(first, last), shape)
            values: dict[str, Any] = dict(zip(NUMBERS[:4], np.array(numbers)[body].T, strict=True))
            values |= {"friction": self.friction[mu], "bounce": self.law.bounce, "scale": self.scales[scale]}
            values |= dict(zip(("imposed_left", "imposed_right"), self.imposed[body, choice].T, strict=True))
            values |= {"end": ends[body, motion]}
            values |= dict(zip(NUMBERS[10:], np.array([each[:6] for each in starts])[body].T, strict=True))
            law, how = self.law.bounce_law, self.settings
            pieces.append(run_compiled(library, values, motion, law, touching[body], settings=how, threads=threads))
            if progress is not None:
                progress(last - first)
        return _columns({name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]})


_COUNTED = ("impacts", "still_rocking", "impacts_replaced", "shocks")
_MEASURED = ("peak_rotation", "sliding_distance", "residual_displacement", "friction_usage")


def _columns(found: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    outcome = found["outcome"]
    return {
        **{name: found[name] for name in ("outcome", "status", "side")},
        "overturned": overturned(outcome),
        "overturning_time": found["overturning_time"],
        **{name: found[name] for name in _MEASURED},
        **{name: of_results(outcome, found[name]) for name in _COUNTED},
    }


def _row_of(response: ContactResponse) -> dict[str, float]:
    """Results of one history; NaN where it has none."""
    good = response.outcome is not Outcome.FAILED
    rotation = response.rotation
    side = np.sign(rotation[np.argmax(np.abs(rotation))]) if rotation.size else 0.0
    measured = {
        "peak_rotation": side * response.peak_rotation,
        "sliding_distance": response.sliding_distance,
        "residual_displacement": response.trajectory.last_x,
        "friction_usage": response.friction_usage,
        "impacts": len(response.impacts),
        "still_rocking": float(response.still_rocking),
        "impacts_replaced": response.trajectory.replaced,
        "shocks": response.trajectory.shocks,
    }
    return {
        "outcome": response.outcome.code,
        "status": response.status.code,
        "side": int(side) if response.outcome is Outcome.OVERTURNED else 0,
        "overturned": float(overturned(np.array(response.outcome.code))),
        "overturning_time": response.overturning_time,
        **{name: float(value) if good else np.nan for name, value in measured.items()},
    }


def _imposed(body: Body, restitution: Any, settings: Settings) -> tuple[float, float] | None:
    if is_none(restitution):
        return None
    if isinstance(restitution, ImpactLaw):
        raise InvalidValueError(
            f"restitution must be a model, a name or a number here, got {type(restitution).__name__}: "
            "laws that change from impact to impact are for simulate()"
        )
    parameters = RockingParameters.of_body(body, restitution, settings.gravity)
    return parameters.left.coefficient, parameters.right.coefficient


def _length(motion: GroundMotion | Pulse, slow: float, duration: float | None) -> float:
    """How long to follow a body [s]; slow: sqrt(R / g)."""
    if duration is not None:
        return checks.positive("duration", duration, "s")
    return motion.duration + AFTER * slow


def _segments(motion: object, base: PlaneBase, gravity: float, duration: float | None) -> Segments:
    slow = math.sqrt(base.size / gravity)
    if motion is None:
        length = _FREE * slow if duration is None else checks.positive("duration", duration, "s")
        return ground_at_rest(length / max(1, math.ceil(length / (FINE * slow) - 1e-9)), length)
    if not isinstance(motion, (GroundMotion, Pulse)):
        raise InvalidValueError(f"motion must be a GroundMotion, a pulse or None, got {motion!r:.60}")
    length = _length(motion, slow, duration)
    segments = motion.segments()
    return followed(segments, length, math.ceil(segments.step / (FINE * slow)), motion)
