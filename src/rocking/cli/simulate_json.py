"""The JSON of `rocking simulate`: one object in SI units, null where something does not exist.

Keys
----
- ``body``: ``kind``, ``mass_kg``, ``sides`` by foot: ``slenderness_angle_rad``, ``frequency_parameter_rad_s``,
  ``semi_diagonal_m``, ``coefficient`` (of restitution, when the body lands on this foot).
- ``motion``: null for free rocking, else ``kind`` (record or pulse), ``name``, ``scale``, ``duration_s``,
  ``peak_acceleration_m_s2`` (scaled).
- ``initial_rotation_rad``, ``restitution`` (label), ``engine`` (which one ran), ``gravity_m_s2``, ``linear``.
- ``outcome``: no_uplift, rocked or overturned; ``summary``: the same in a sentence; ``overturned_to``: foot or null;
  ``overturning_time_s`` or null; ``peak_rotation_rad`` (a quarter turn if it overturned) and
  ``peak_rotation_over_alpha``.
- ``uplifts_s``: times; ``impacts``: ``time_s``, ``velocity_before_rad_s``, ``velocity_after_rad_s``, ``coefficient``,
  ``onto``.
- ``energy_closure``: what does not add up over the largest energy; ``error_estimate_rad``: null if another step changes
  the outcome.
- ``friction``: ``given``, ``of_motion`` (null if infinite), ``of_impacts``; ``least_vertical_force_N``; ``warnings``.
- ``other_models``: by model either ``error`` or outcome, summary, times, peaks, ``impact_count`` and ``coefficients``.
"""

import json
import math
from typing import Any

from rocking.cli.simulate_output import Answer
from rocking.conventions import FEET
from rocking.dynamics.response import Response
from rocking.motions.motion import GroundMotion


def as_json(answer: Answer) -> str:
    """Return everything as JSON.

    Parameters
    ----------
    answer : Answer
        What `Answer.of` computed.

    Returns
    -------
    str
        One object, with the keys above.
    """
    response = answer.response
    contact = response.contact
    facts = {
        "body": _body(response),
        "motion": _motion(response),
        "initial_rotation_rad": float(response.rotation[0]),
        "restitution": response.rocker.label,
        "engine": response.engine,
        "gravity_m_s2": response.settings.gravity,
        "linear": response.settings.linear,
        **_outcome(response),
        "uplifts_s": response.uplifts.tolist(),
        "impacts": [
            {
                "time_s": time,
                "velocity_before_rad_s": before,
                "velocity_after_rad_s": after,
                "coefficient": r,
                "onto": onto,
            }
            for time, before, after, r, onto in response.impacts.tolist()
        ],
        "energy_closure": response.energy.closure,
        "error_estimate_rad": _finite(response.error_estimate),
        "friction": {
            "given": answer.friction,
            "of_motion": _finite(contact.friction_of_motion),
            "of_impacts": _finite(contact.friction_of_impacts),
        },
        "least_vertical_force_N": contact.least_vertical,
        "warnings": contact.warnings(answer.friction),
        "other_models": {name: _other(found) for name, found in answer.others.items()},
    }
    return json.dumps(facts, indent=2, allow_nan=False)


def _body(response: Response) -> dict[str, Any]:
    body, rocker = response.body, response.rocker
    sides = {foot: rocker.right if foot == "right" else rocker.left for foot in FEET}
    return {
        "kind": type(body).__name__,
        "mass_kg": body.mass,
        "sides": {
            foot: {
                "slenderness_angle_rad": side.slenderness_angle,
                "frequency_parameter_rad_s": side.frequency_parameter,
                "semi_diagonal_m": side.semi_diagonal,
                "coefficient": side.coefficient,
            }
            for foot, side in sides.items()
        },
    }


def _motion(response: Response) -> dict[str, Any] | None:
    motion = response.motion
    if motion is None:
        return None
    return {
        "kind": "record" if isinstance(motion, GroundMotion) else "pulse",
        "name": motion.name,
        "scale": response.scale,
        "duration_s": motion.duration,
        "peak_acceleration_m_s2": abs(response.scale) * motion.peak,
    }


def _outcome(response: Response) -> dict[str, Any]:
    run = response.trajectory
    return {
        "outcome": response.outcome.name.lower(),
        "summary": response.summary,
        "overturned_to": {1: "right", -1: "left"}.get(int(run.side)),
        "overturning_time_s": _finite(response.overturning_time),
        "peak_rotation_rad": response.peak_rotation,
        "peak_rotation_over_alpha": response.peak_rotation / response.rocker.side(run.peak_rotation).slenderness_angle,
    }


def _other(found: Response | str) -> dict[str, Any]:
    if isinstance(found, str):
        return {"error": found}
    rocker = found.rocker
    coefficients = {"left": rocker.left.coefficient, "right": rocker.right.coefficient}
    return {**_outcome(found), "impact_count": int(found.impacts.size), "coefficients": coefficients}


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
