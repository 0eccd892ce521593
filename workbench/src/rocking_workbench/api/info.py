"""GET /api/info: available models, pulses, formats, units and limits."""

import inspect
import math
from dataclasses import asdict
from functools import cache
from typing import Any, Literal

from fastapi import APIRouter, Request
from pydantic import Field

from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS, g
from rocking.restitution import models
from rocking.version import __version__
from rocking_workbench.answers import JsonAnswer, QuantityAnswer, answered, shape
from rocking_workbench.inputs import CAPS
from rocking_workbench.settings import state_of

router = APIRouter(prefix="/api", tags=["info"])
_OF_FORMATS = ("title", "states_unit", "states_time_step", "notes")
PARAMETERS = {
    "amplitude": ("m/s2", "peak acceleration"),
    "velocity": ("m/s", "velocity amplitude"),
    "period": ("s", "period"),
    "duration": ("s", "duration"),
    "cycles": ("-", "cycles"),
    "phase": ("rad", "phase"),
    "n": ("-", "main cycles"),
}
"""Unit and description of the parameters of pulses."""

_DASHES = {"-": [], "--": [6.0, 4.0], "-.": [8.0, 3.0, 2.0, 3.0], ":": [2.0, 3.0]}
UNLIMITED = "unlimited"  # JSON text for an infinite default
EngineFacts: Any = shape("EngineFacts", "Engine of the simulations.", name=str, instruction_set=str | None)
ParameterFacts: Any = shape(
    "ParameterFacts",
    "A parameter of a model or pulse.",
    unit=str,
    description=str,
    default=(
        float | Literal["unlimited"] | None,
        'in `unit`; "unlimited" for an infinite value, null for a required value',
    ),
)
ModelFacts: Any = shape(
    "ModelFacts",
    "A restitution model.",
    "name summary",
    label=str,
    short_name=(str, "name in sentences and legends"),
    colour=(str, "colour of the curves; empty for the default colour"),
    dash=(list[float], "dashes of the curves: lengths of strokes and gaps [px]; empty for a solid line"),
    title=str,
    citation=str,
    assumptions=list[str],
    domain=str,
    known_defects=list[str],
    parameters=dict[str, ParameterFacts],
)
PulseFacts: Any = shape("PulseFacts", "A kind of pulse.", summary=str, parameters=dict[str, ParameterFacts])
FamilyFacts: Any = shape(
    "FamilyFacts",
    "A family of synthetic motions.",
    "name time_step",
    title=str,
    generator=str,
    origin=str,
)
FormatFacts: Any = shape(
    "FormatFacts",
    "A format of record files.",
    name=str,
    title=str,
    suffixes=list[str],
    states_unit=bool,
    states_time_step=bool,
    notes=str,
)
UnitNames: Any = shape("UnitNames", "Allowed units.", length=list[str], acceleration=list[str])
KindOfStudy: Any = shape(
    "KindOfStudy",
    "A kind of study, and the table of this kind in the job file.",
    name=str,
    table=str,
    has_body=(bool, "true if the job file has a table of a body"),
    has_motions=(bool, "true if the job file has a table of motions"),
)
KeyFacts: Any = shape(
    "KeyFacts",
    "A key of a table or of a step.",
    unit=(str, "empty without a unit"),
    description=str,
    kind=(str, "text, number, whole number, list of number"),
    usual=(str, "default as text; empty without a default"),
    needed=bool,
    choices=(list[str], "allowed values, if few"),
    ge=(float | None, Field(None, description="lowest value, in the unit of the key")),
    gt=(float | None, Field(None, description="lower limit, not included, in the unit of the key")),
    le=(float | None, Field(None, description="highest value, in the unit of the key")),
    lt=(float | None, Field(None, description="upper limit, not included, in the unit of the key")),
)
StepFacts: Any = shape(
    "StepFacts",
    "A step, or a spectrum.",
    description=str,
    single_key=(bool, "the step accepts one of its keys"),
    keys=dict[str, KeyFacts],
)
AxisFacts: Any = shape(
    "AxisFacts",
    "An axis of a map.",
    QuantityAnswer,
    usual=(list[float], "first and last value that a form proposes, in `unit`"),
)
Info: Any = shape(
    "Info",
    "Available models, pulses, formats, units and limits.",
    version=str,
    engine=EngineFacts,
    gravity=(float, "default gravity"),
    models=list[ModelFacts],
    pulses=dict[str, PulseFacts],
    families=list[FamilyFacts],
    formats=list[FormatFacts],
    units=UnitNames,
    measures=list[QuantityAnswer],
    axes=list[AxisFacts],
    study_kinds=list[KindOfStudy],
    steps=(dict[str, StepFacts], "processing steps of records"),
    targets=(dict[str, StepFacts], "spectra that records are scaled to"),
    keys=(dict[str, dict[str, KeyFacts]], "keys of input tables"),
    limits=(dict[str, float], "limits of the server: bytes [B], seconds [s], counts"),
)


@router.get("/info", summary="Available options", responses=answered(Info, "The available options."))
def info(request: Request) -> JsonAnswer:
    """Answer with version, engine, models, pulses, families of motions, formats, units, measures, axes and limits."""
    from rocking_workbench.studies.job_document import MOST_MOTIONS

    limits = {**asdict(state_of(request).settings.limits), **CAPS, "study_motions": MOST_MOTIONS}
    return JsonAnswer({**_constant(*models().values()), "limits": limits})


@cache
def _constant(*kinds: type) -> dict[str, Any]:
    """Return the options for these restitution models."""
    from rocking.dynamics.plane import fast_engine
    from rocking.motions.formats import formats
    from rocking.motions.pulses import catalogue
    from rocking.motions.synthetic import families
    from rocking.spec.documents.prediction import PredictTable
    from rocking.spec.motion_tables import MotionTable, OneMotionTable
    from rocking.spec.question import BodyQuestion
    from rocking.spec.questions import questions
    from rocking.spec.questions.inventory import InventoryTable
    from rocking.spec.reference import described, steps, targets
    from rocking.studies import axes
    from rocking_workbench.api.contact_bed import ContactBedRequest
    from rocking_workbench.studies.job_document import launched_kinds

    fast = fast_engine.available()
    launched: Any = {kind: questions()[kind] for kind in launched_kinds()}
    own = {question.own_table(): question for question in launched.values()}
    return {
        "version": __version__,
        "engine": {
            "name": "fast" if fast else "reference", "instruction_set": fast_engine.instruction_set() if fast else None,
        },
        "gravity": g,
        "models": _models(),
        "pulses": {
            name: {"summary": (inspect.getdoc(entry) or "").partition("\n")[0], "parameters": _parameters(entry)}
            for name, entry in sorted(catalogue().items())
        },
        "families": [
            {
                "name": name, "title": entry.title, "origin": entry.origin, "generator": entry.generator,
                "time_step": entry.time_step,
            }
            for name, entry in families().items()
        ],
        "formats": [
            {"name": name, "suffixes": list(entry.suffixes), **{key: getattr(entry, key) for key in _OF_FORMATS}}
            for name, entry in formats().items()
        ],
        "units": {"length": list(LENGTH_UNITS), "acceleration": list(ACCELERATION_UNITS)},
        "measures": listed_measures(),
        "axes": [{**_quantity(entry, entry.meaning), "usual": entry.usual} for entry in axes().values()],
        "study_kinds": [
            {
                "name": kind,
                "table": question.own_table(),
                "has_body": issubclass(question, BodyQuestion),
                "has_motions": question.has_motions(),
            }
            for kind, question in launched.items()
        ],
        "steps": steps(),
        "targets": targets(),
        "keys": {
            **{table: described(question.model_fields[table].annotation) for table, question in own.items()},
            "motion": described(OneMotionTable), "motions": described(MotionTable),
            "predict": described(PredictTable), "contact_bed": described(ContactBedRequest),
            "inventory": described(InventoryTable),
        },
    }  # fmt: skip


def listed_measures() -> list[dict[str, str]]:
    """Return the measures of intensity that have names."""
    from rocking.motions import measures

    return [_quantity(measure, measure.description) for measure in measures().values()]


def _quantity(quantity: Any, description: str) -> dict[str, str]:
    return {"name": quantity.name, "description": description, "unit": quantity.unit}


def _models() -> list[dict[str, Any]]:
    return [
        {
            "name": name,
            "label": name,
            "short_name": kind.short_name or name,
            "colour": kind.colour,
            "dash": _dash(kind.linestyle),
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


def _dash(linestyle: str | tuple[int, tuple[int, ...]]) -> list[float]:
    """Return a line style of matplotlib as lengths of strokes and gaps, for a line width of two pixels [px]."""
    return _DASHES[linestyle] if isinstance(linestyle, str) else [2.0 * length for length in linestyle[1]]


def _parameters(kind: Any) -> dict[str, dict[str, Any]]:
    """Return the parameters of a callable, with unit and default."""
    parameters = {}
    for name, parameter in inspect.signature(kind).parameters.items():
        unit, text = PARAMETERS.get(name, ("-", name.replace("_", " ")))
        # None means that a value is required
        default = None if parameter.default is inspect.Parameter.empty else parameter.default
        unlimited = isinstance(default, float) and math.isinf(default)
        parameters[name] = {"unit": unit, "description": text, "default": UNLIMITED if unlimited else default}
    return parameters
