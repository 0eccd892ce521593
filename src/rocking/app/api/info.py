"""GET /api/info: what there is to choose from."""

import inspect
import math
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from typing import Any

from fastapi import APIRouter, Request

from rocking.app.answers import JsonAnswer
from rocking.app.schemas.answers import Info, answered
from rocking.app.schemas.inputs import CAPS
from rocking.app.settings import state_of
from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS, g

router = APIRouter(prefix="/api", tags=["info"])

_ABOUT = "Version, engine, models, pulses, families of motions, formats, units, measures, axes of maps and limits."

PARAMETERS = {
    "amplitude": ("m/s2", "peak acceleration"),
    "velocity": ("m/s", "velocity amplitude"),
    "period": ("s", "period"),
    "duration": ("s", "duration"),
    "cycles": ("-", "cycles"),
    "phase": ("rad", "phase"),
    "n": ("-", "main cycles"),
}
"""Unit and words of the parameters of pulses."""

UNLIMITED = "unlimited"
"""What stands for an infinite default, which JSON has no number for."""


@router.get(
    "/info",
    summary="What there is to choose from",
    description=_ABOUT,
    response_class=JsonAnswer,
    responses=answered(Info, "What there is."),
)
def info(request: Request) -> JsonAnswer:
    """Answer with version, engine, models, pulses, families, formats, units, measures, axes, kinds and limits."""
    limits = {**asdict(state_of(request).settings.limits), **CAPS}
    return JsonAnswer({**_constant(), "limits": limits})


@cache
def _constant() -> dict[str, Any]:
    from rocking.app.studies.job_document import KINDS
    from rocking.spec.document import NEEDS

    return {
        "version": version("rocking"),
        "engine": _engine(),
        "gravity_m_s2": g,
        "models": _models(),
        "pulses": _pulses(),
        "families": _families(),
        "formats": _formats(),
        "units": {"length": list(LENGTH_UNITS), "acceleration": list(ACCELERATION_UNITS)},
        "measures": listed_measures(),
        "axes": _axes(),
        "study_kinds": [{"name": name, "table": NEEDS[name]} for name in KINDS],
    }


def _engine() -> dict[str, Any]:
    from rocking.dynamics.plane import fast_engine

    if not fast_engine.available():
        return {"name": "reference", "instruction_set": None}
    return {"name": "fast", "instruction_set": fast_engine.instruction_set()}


def _models() -> list[dict[str, Any]]:
    from rocking.restitution import models

    return [
        {
            "name": name,
            "label": name,
            "title": kind.title,
            "citation": kind.reference,
            "summary": " ".join(kind.assumptions),
            "assumptions": list(kind.assumptions),
            "domain": kind.domain,
            "known_defects": list(kind.known_defects),
            "parameters": _parameters(kind),
        }
        for name, kind in models().items()
    ]


def _parameters(made_by: Any) -> dict[str, dict[str, Any]]:
    """Return what something takes, with unit and usual value."""
    found = {}
    for name, one in inspect.signature(made_by).parameters.items():
        unit, words = PARAMETERS.get(name, ("-", name.replace("_", " ")))
        found[name] = {"unit": unit, "words": words, "default": _usual(one)}
    return found


def _usual(one: inspect.Parameter) -> Any:
    """Return the default of a parameter; None where a value must be given, which an infinite default is not."""
    if one.default is inspect.Parameter.empty:
        return None
    return UNLIMITED if isinstance(one.default, float) and math.isinf(one.default) else one.default


def _pulses() -> dict[str, dict[str, Any]]:
    from rocking.motions.pulses import catalogue

    return {
        name: {"summary": (inspect.getdoc(made) or "").partition("\n")[0], "parameters": _parameters(made)}
        for name, made in sorted(catalogue().items())
    }


def _families() -> list[dict[str, Any]]:
    from rocking.motions.synthetic.families import families

    return [
        {
            "name": name,
            "title": one.title,
            "summary": f"{one.title}; {one.origin}",
            "generator": one.generator,
            "time_step_s": one.time_step,
        }
        for name, one in families().items()
    ]


def _formats() -> list[dict[str, Any]]:
    from rocking.motions.formats import formats

    return [
        {
            "name": name,
            "title": one.title,
            "suffixes": list(one.suffixes),
            "states_unit": one.states_unit,
            "states_time_step": one.states_time_step,
            "notes": one.notes,
        }
        for name, one in formats().items()
    ]


def listed_measures() -> list[dict[str, Any]]:
    """Return the measures of intensity that have names."""
    from rocking.motions.intensity import measures

    return [{"name": one.name, "words": one.words, "unit": one.unit} for one in measures().values()]


def _axes() -> list[dict[str, Any]]:
    from rocking.studies.axis import axes

    return [{"name": one.name, "unit": one.unit, "words": one.words} for one in axes().values()]
