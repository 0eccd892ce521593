"""One plane body whose feet may slide, hop and bounce."""

import math
import warnings
from collections.abc import Callable, Sequence
from itertools import product
from typing import Any

import numpy as np

from rocking import checks, conventions, plausibility
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.dynamics.contact.base import PlaneBase, Start, state_at_start
from rocking.dynamics.contact.engine import ContactEngine
from rocking.dynamics.contact.impact_resolution import GroundContact
from rocking.dynamics.contact.response import ContactResponse
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.response_base import followed, ground_at_rest
from rocking.dynamics.settings import Settings, check_progress
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.segments import Segments
from rocking.outcome import Outcome, overturned

# sqrt(g / R) times the step between samples of a pulse's response, and times what is followed after the motion
_FINE, _AFTER, _FREE = 0.1, 15.0, 60.0


def response_with_contact(  # noqa: PLR0913 - what the front door hands on
    body: Body,
    motion: GroundMotion | Pulse | None,
    friction: float,
    restitution: Any,
    settings: Settings,
    *,
    bounce: float = 0.0,
    start: Start,
    scale: float = 1.0,
    duration: float | None = None,
) -> ContactResponse:
    """Return how a body rests, slides, rocks, slides while it rocks, and flies; on ground at rest without a motion.

    restitution: None for impacts by complementarity alone; duration: how long to follow the body [s]; if not given, the
    motion and 15 sqrt(R / g) after it, 60 sqrt(R / g) on ground at rest.
    """
    base = PlaneBase.of_body(body)
    law = GroundContact(
        friction if isinstance(friction, conventions.Assumed) else checks.number("friction", friction),
        checks.number("bounce", bounce),
        _imposed(body, restitution, settings),
    )
    scale = checks.within("scale", scale, -1e6, 1e6)
    segments = _segments(motion, base, settings.gravity, duration)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    history = ContactEngine(base, segments, law, settings, scale).run(state_at_start(start, base))
    return ContactResponse(body, motion, base, law, settings, segments, scale, history)


def many_with_contact(  # noqa: PLR0913, PLR0917 - what the front door hands on
    bodies: Sequence[Body],
    motions: Sequence[GroundMotion | Pulse],
    scales: FloatArray,
    restitutions: Sequence[Any],
    friction: FloatArray,
    settings: Settings,
    bounce: float,
    start: Start | None,
    duration: float | None,
    progress: Callable[[int], None] | None,
) -> dict[str, np.ndarray]:
    """Return the results of every combination, the last axis (friction) running fastest; one history at a time."""
    if start is not None and not isinstance(start, Start):
        raise InvalidValueError(f"start must be a Start(...), got {start!r:.60}")
    check_progress(progress)
    for mu in friction:
        plausibility.warn(plausibility.of_friction(checks.positive("friction", float(mu))))
    rows = []
    for body, motion, scale, restitution, mu in product(bodies, motions, scales, restitutions, friction):
        with warnings.catch_warnings():  # said once, before
            warnings.simplefilter("ignore", PlausibilityWarning)
            response = response_with_contact(
                body, motion, float(mu), restitution, settings, bounce=bounce, start=start or Start(),
                scale=float(scale), duration=duration,
            )  # fmt: skip
        rows.append(_row_of(response))
        if progress is not None:
            progress(1)
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _row_of(response: ContactResponse) -> dict[str, float]:
    """Results of one history; NaN where it has none."""
    good = response.outcome is not Outcome.FAILED
    rotation = response.rotation
    side = np.sign(rotation[np.argmax(np.abs(rotation))]) if rotation.size else 0.0
    measured = {
        "peak_rotation": side * response.peak_rotation,
        "sliding_distance": response.sliding_distance,
        "residual_displacement": response.displacement[-1] if response.time.size else np.nan,
        "friction_usage": response.friction_usage,
        "impacts": len(response.impacts),
        "still_rocking": float(response.still_rocking),
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
    if restitution is None:
        return None
    if isinstance(restitution, ImpactLaw):
        raise InvalidValueError(
            f"restitution must be a model, a name or a number here, got {type(restitution).__name__}: "
            "laws that change from impact to impact are for simulate()"
        )
    parameters = RockingParameters.of_body(body, restitution, settings.gravity)
    return parameters.left.coefficient, parameters.right.coefficient


def _segments(motion: object, base: PlaneBase, gravity: float, duration: float | None) -> Segments:
    slow = math.sqrt(base.size / gravity)
    if motion is None:
        length = _FREE * slow if duration is None else checks.positive("duration", duration, "s")
        return ground_at_rest(length / max(1, math.ceil(length / (_FINE * slow) - 1e-9)), length)
    if not isinstance(motion, (GroundMotion, Pulse)):
        raise InvalidValueError(f"motion must be a GroundMotion, a pulse or None, got {motion!r:.60}")
    length = motion.duration + _AFTER * slow if duration is None else checks.positive("duration", duration, "s")
    segments = motion.segments()
    return followed(segments, length, math.ceil(segments.step / (_FINE * slow)), motion)
