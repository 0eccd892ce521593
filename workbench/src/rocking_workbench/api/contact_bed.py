"""POST /api/contact-bed: impacts on springs and dashpots, over one varied parameter."""

import math
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Request
from pydantic import ConfigDict, Field, model_validator

from rocking.errors import InvalidValueError
from rocking.messages import Range
from rocking.spec.fields import JobTable, Positive, Seed, Values
from rocking_workbench.answers import JsonAnswer, answered, shape
from rocking_workbench.studies.results import plain
from rocking_workbench.work import heavy

router = APIRouter(prefix="/api", tags=["impact"])
MOST_VALUES, MOST_POINTS = 200, 401

Varied = Literal[
    "slenderness", "damping", "modulus_over_thickness", "friction", "release", "density", "width", "points",
    "amplitude", "seed",
]  # fmt: skip

_USUAL: dict[str, tuple[float, float, str]] = {
    "slenderness": (1.5, 8.0, "linear"), "damping": (0.01, 3.0, "log"), "modulus_over_thickness": (1e7, 1e11, "log"),
    "friction": (0.05, 1.0, "linear"), "release": (0.05, 0.95, "linear"), "density": (500.0, 8000.0, "linear"),
    "width": (0.05, 5.0, "log"), "points": (3.0, 81.0, "linear"), "amplitude": (0.0, 1e-3, "linear"),
    "seed": (0.0, 39.0, "linear"),
}  # fmt: skip
"""Default range and spacing by parameter."""
_OPTIONS: dict[str, dict[str, Any]] = {"amplitude": {"shape": "concave"}, "seed": {"amplitude": 1e-4}}
_OF_LABORATORY = {
    "slenderness", "width", "density", "points", "frequency", "modulus_over_thickness", "damping", "release",
}  # fmt: skip


class ContactBedRequest(JobTable):
    """A block on a bed of contact points, and the varied parameter."""

    model_config = ConfigDict(
        json_schema_extra={"examples": [{"varied": "damping", "slenderness": 4}]}, defer_build=False
    )

    varied: Varied = Field("slenderness", description="varied parameter; amplitude and seed are for an uneven base")
    start: float | None = Field(None, alias="from", description="first value; default depends on the parameter")
    stop: float | None = Field(None, alias="to", description="last value; default depends on the parameter")
    count: Annotated[int, Field(ge=1, le=MOST_VALUES)] = Field(40, description="number of values")
    spacing: Literal["usual", "linear", "log"] = Field("usual", description="spacing of the values")
    slenderness: Positive = Field(2.0, description="h/b of the block [-]")
    width: Positive = Field(0.2, description="width of the base [m]")
    density: Positive = Field(2400.0, description="density of the block [kg/m3]")
    points: Annotated[int, Field(ge=2, le=MOST_POINTS)] = Field(41, description="contact points")
    frequency: Positive = Field(400.0, description="frequency of the bed under the block, unless a layer is given [Hz]")
    modulus_over_thickness: Positive | None = Field(
        None,
        description="in place of the frequency: elastic modulus / thickness of the layer, for a depth of 1 m [Pa/m]",
    )
    damping: Annotated[float, Field(ge=0.0)] = Field(1.0, description="damping ratio of the bed [-]")
    release: Annotated[float, Field(gt=0.0, lt=1.0)] = Field(
        0.5, description="initial rotation / slenderness angle [-]"
    )
    friction: Annotated[float, Field(gt=0.0)] | None = Field(
        None, description="coefficient of friction; default: no sliding [-]"
    )
    shape: Literal["usual", "convex", "concave", "tilted", "random"] = Field(
        "usual", description="shape of an uneven base if the amplitude is varied; default: concave"
    )
    amplitude: Positive | None = Field(
        None, description="amplitude of a random base if the seed is varied; default: 0.0001 [m]"
    )
    seed: Seed | None = Field(None, description="seed of a random base if the amplitude is varied")

    @model_validator(mode="after")
    def _range(self) -> "ContactBedRequest":
        ends = [end for end in (self.start, self.stop) if end is not None]
        may_vanish = self.varied in {"damping", "amplitude", "seed"}
        for end in ends:
            if end < 0.0 or (end == 0.0 and not may_vanish):
                raise InvalidValueError(
                    parameter=self.varied, allowed=Range(0.0, math.inf, low_open=not may_vanish), value=end
                )
            if self.varied == "points" and end > MOST_POINTS:
                raise InvalidValueError(parameter="points", allowed=f"at most {MOST_POINTS}", value=end)
        return self


BedResult: Any = shape(
    "BedResult",
    "Results over the varied parameter.",
    unit=str,
    description=str,
    values=(list[float | None], "in `unit`"),
)
ContactBedAnswered: Any = shape(
    "ContactBedAnswered",
    "Results of impacts on a contact bed.",
    varied=Varied,
    unit=str,
    values=(list[float], "values of the varied parameter, in `unit`"),
    results=(dict[str, BedResult], "`coefficient` is the coefficient of restitution; null for a failed impact"),
    rigid=(dict[str, list[float]], "coefficient of the same blocks by instantaneous models [-]"),
)


@router.post(
    "/contact-bed", summary="An impact on a contact bed", responses=answered(ContactBedAnswered, "The results.")
)
async def contact_bed(request: Request, inputs: ContactBedRequest) -> JsonAnswer:
    """Return the results of the impact laboratory, compared with Housner and KED."""
    return await heavy(request, answer, inputs)


def answer(inputs: ContactBedRequest) -> JsonAnswer:
    """Return the results of impacts on a contact bed."""
    from rocking.restitution import Housner, Ked
    from rocking.restitution.bed import Coulomb
    from rocking.studies.impact_laboratory import STUDIES, Laboratory, study

    first, last, spacing = _USUAL[inputs.varied]
    ends = {"from": first if inputs.start is None else inputs.start, "to": last if inputs.stop is None else inputs.stop}
    values = Values.model_validate(
        {**ends, "spacing": spacing if inputs.spacing == "usual" else inputs.spacing, "count": inputs.count}
    ).numbers()
    if inputs.varied in {"points", "seed"}:
        values = np.unique(values.round())
    stated = inputs.model_dump(include={"shape", "amplitude", "seed"}, exclude_defaults=True)
    options = {**_OPTIONS.get(inputs.varied, {}), **stated}
    start = Laboratory(**inputs.model_dump(include=_OF_LABORATORY))
    if inputs.friction:
        start = start.but(friction=Coulomb(inputs.friction))
    dataset = study(inputs.varied, values, start, **options)
    slender = [entry if inputs.varied == "slenderness" else inputs.slenderness for entry in values.tolist()]
    return JsonAnswer(plain({
        "varied": inputs.varied, "unit": _unit(STUDIES[inputs.varied][0]), "values": values,
        "results": {
            str(name): {
                "unit": _unit(entry.attrs["units"]), "description": entry.attrs.get("long_name", ""),
                "values": entry.values,
            }
            for name, entry in dataset.data_vars.items()
        },
        "rigid": {
            name: [model.coefficient(start.but(slenderness=entry).block) for entry in slender]
            for name, model in (("ked", Ked()), ("housner", Housner()))
        },
    }))  # fmt: skip


def _unit(unit: str) -> str:
    return "-" if unit == "1" else unit
