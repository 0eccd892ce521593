"""A response and its motion in plain values: SI units, None where there is nothing; the API describes every key."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from rocking import plausibility
from rocking.conventions import FEET, Assumed
from rocking.dynamics.response import Response
from rocking.motions.intensity import Measure, intensity_measures, key_with_unit
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion, Pulse
from rocking.motions.spectrum import ResponseSpectrum
from rocking.motions.summary import provenance_of, support_of
from rocking.outcome import Outcome
from rocking.plots.labels import Traces, traces
from rocking.restitution import models

if TYPE_CHECKING:
    from rocking.dynamics.contact import ContactResponse

OUTCOME_WORDS = {
    Outcome.OVERTURNED: "overturns",
    Outcome.ROCKED: "stays standing",
    Outcome.NO_UPLIFT: "is never lifted",
}
_EQUALS = "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}"


def response_facts(response: Response, friction: float) -> dict[str, Any]:
    """Return everything that is said of a response on a ground of a coefficient of friction [-]."""
    keys = ("time_s", "velocity_before_rad_s", "velocity_after_rad_s", "coefficient", "onto")
    contact = response.contact
    return {
        "body": rocker_facts(response),
        "motion": moved_facts(response.motion, response.scale),
        "initial_rotation_rad": float(response.rotation[0]),
        "restitution": response.parameters.label,
        "engine": response.engine,
        "gravity_m_s2": response.settings.gravity,
        "linear": response.settings.linear,
        **outcome_facts(response),
        "uplifts_s": response.uplifts.tolist(),
        "impacts": [dict(zip(keys, row, strict=True)) for row in response.impacts.tolist()],
        "energy_closure": response.energy.closure,
        "error_estimate_rad": finite(response.error_estimate),
        # what rocking without slip and flight takes, beside the coefficient of friction that there is [-]
        "friction": {
            "given": friction,
            "assumed": isinstance(friction, Assumed),
            "of_motion": finite(contact.friction_of_motion),
            "of_impacts": finite(contact.friction_of_impacts),
        },
        "least_vertical_force_N": contact.least_vertical,
        "warnings": response.doubts(friction),
    }


def rocker_facts(response: Response) -> dict[str, Any]:
    """Return the body as its equations of motion see it."""
    body, parameters = response.body, response.parameters
    sides = {foot: getattr(parameters, foot) for foot in FEET}
    return {
        "kind": type(body).__name__,
        "mass_kg": body.mass,
        "assumed": list(body.assumed),
        "warnings": list(body.doubts),
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


def moved_facts(motion: Motion | None, scale: float) -> dict[str, Any] | None:
    """Return what moved the ground, with the factor on it [-]."""
    if motion is None:
        return None
    return {
        "kind": "record" if isinstance(motion, GroundMotion) else "pulse",
        "name": motion.name,
        "support": support_of(motion),
        "provenance": list(provenance_of(motion)),
        "scale": scale,
        "duration_s": motion.duration,
        "peak_acceleration_m_s2": abs(scale) * motion.peak,
        "warnings": list(plausibility.of_acceleration(abs(scale) * motion.peak)),
    }


def outcome_facts(response: Response) -> dict[str, Any]:
    """Return how a response ended: outcome, its sentence, overturning, peak, and whether it still rocks."""
    run = response.trajectory
    return {
        "outcome": response.outcome.name.lower(),
        "summary": response.summary,
        "overturned_to": {1: "right", -1: "left"}.get(int(run.side)),
        "overturning_time_s": finite(response.overturning_time),
        "peak_rotation_rad": response.peak_rotation,
        "peak_rotation_over_alpha": response.peak_rotation
        / response.parameters.side(run.peak_rotation).slenderness_angle,
        "still_rocking": still_rocking_facts(response),
        "lost_contact": response.lost_contact,
    }


def still_rocking_facts(response: "Response | ContactResponse") -> dict[str, float | str] | None:
    """Return the last state of a body that does not yet rest; None if it rests or has overturned."""
    if not response.still_rocking:
        return None
    return {
        "time_s": float(response.time[-1]),
        "rotation_rad": float(response.rotation[-1]),
        "angular_velocity_rad_s": float(response.angular_velocity[-1]),
        "sentence": response.unfinished,
    }


def other_facts(found: Response | str) -> dict[str, Any]:
    """Return what another model says, in short."""
    if isinstance(found, str):
        return {"error": found}
    coefficients = {foot: getattr(found.parameters, foot).coefficient for foot in FEET}
    return {**outcome_facts(found), "impact_count": int(found.impacts.size), "coefficients": coefficients}


def finite(value: float) -> float | None:
    """Return a number, or None where it is infinite or does not exist."""
    return float(value) if math.isfinite(value) else None


@dataclass(frozen=True, slots=True)
class ModelAgreement:
    """What the models say together."""

    decides: bool  # whether they end differently
    sentence: str  # the same in words

    @classmethod
    def of(cls, responses: Mapping[str, Response]) -> "ModelAgreement":
        groups: dict[str, list[str]] = {}
        for name, one in responses.items():
            groups.setdefault(OUTCOME_WORDS[one.outcome], []).append(name)
        rocking = ", ".join(name for name, one in responses.items() if one.still_rocking)
        pulled = ", ".join(name for name, one in responses.items() if one.lost_contact)
        doubts = f" Still rocking when the computation ends: with {rocking}." if rocking else ""
        doubts += f" The ground would have to pull, and the verdict assumes contact: with {pulled}." if pulled else ""
        if len(groups) > 1:
            parts = ", ".join(f"{word} with {', '.join(names)}" for word, names in groups.items())
            return cls(True, f"The model decides: the body {parts}.{doubts}")
        (word,) = groups
        return cls(False, f"With every one of these models the body {word}.{doubts}")


def restitution_words(label: str) -> str:
    """Return what a restitution is called: a model by its short name, a coefficient with its symbol.

    >>> restitution_words("ked"), restitution_words("shifted-impulse:k=0.6").replace(chr(160), " ")
    ('KED', 'shifted impulse, k = 0.6')
    >>> restitution_words("0.9"), restitution_words("left 0.9, right 0.8")
    ('r = 0.9', 'r: left 0.9, right 0.8')
    """
    factor, _, model = label.rpartition("*")
    name, _, parameters = model.partition(":")
    if name in (kinds := models()) and kinds[name].short_name:
        named = [kinds[name].short_name, *(one.strip().replace("=", _EQUALS) for one in parameters.split(",") if one)]
        times = f"{factor}\N{NO-BREAK SPACE}\N{MULTIPLICATION SIGN}\N{NO-BREAK SPACE}" if factor else ""
        return times + ", ".join(named)
    if label.startswith("left "):
        return f"r: {label}"
    try:
        float(label)
    except ValueError:
        return label
    return f"r = {label}"


def measures_of(
    motion: GroundMotion | Pulse, samples: GroundMotion, curves: Traces | None = None
) -> dict[str, Measure]:
    """Return the intensity measures of a motion; those of a pulse that its formulas give come from these."""
    measures = intensity_measures(samples)
    if not isinstance(motion, Pulse):
        return measures
    # these three are known from the formulas, not only from samples
    peaks = (traces(motion) if curves is None else curves).peaks
    exact = {f"pg{name[0]}": abs(value) for name, (_, value) in peaks.items()}
    return measures | {key: replace(measures[key], value=value) for key, value in exact.items()}


def motion_facts(motion: GroundMotion | Pulse, samples: GroundMotion, measures: dict[str, Measure]) -> dict[str, Any]:
    """Return what a motion is and how strong."""
    record = isinstance(motion, GroundMotion)
    metadata = motion.metadata if isinstance(motion, GroundMotion) else {}
    return {
        "kind": "record" if record else "pulse",
        "name": motion.name,
        **{key: metadata.get(key) for key in ("format", "event", "station", "component")},
        "vertical_component": metadata.get("vertical component"),
        "file_unit": metadata.get("unit"),
        "samples": len(samples) if record else None,
        "time_step_s": samples.time_step if record else None,
        "duration_s": motion.duration,
        "warnings": list(motion.doubts),
        "provenance": list(provenance_of(motion)),
        "peak_vertical_acceleration_m_s2": None if samples.vertical is None else samples.peak_vertical,
        "intensity": {key_with_unit(key, one.unit): one.value for key, one in measures.items()},
    }


def spectrum_facts(spectrum: ResponseSpectrum) -> dict[str, Any]:
    """Return a response spectrum."""
    return {
        "damping_ratio": spectrum.damping,
        "period_s": spectrum.periods.tolist(),
        "psa_m_s2": spectrum.pseudo_acceleration.tolist(),
        "psv_m_s": spectrum.pseudo_velocity.tolist(),
        "sd_m": spectrum.displacement.tolist(),
        "absolute_acceleration_m_s2": spectrum.absolute_acceleration.tolist(),
    }
