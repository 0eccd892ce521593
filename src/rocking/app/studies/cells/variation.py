"""What a history of a study is made of: its body, its restitution, its factor on the motion and on its time."""

import tomllib
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rocking.app.studies.cells.place import Place
from rocking.app.studies.opened import OpenStudy
from rocking.bodies import Block, Body
from rocking.bodies.formats.body_writer import body_to_toml
from rocking.studies._axes import axis_of
from rocking.studies.body_axes import Restitution
from rocking.studies.geometry import changed_body
from rocking.studies.plane import Plane
from rocking.studies.question import Question


@dataclass(frozen=True)
class Variation:
    """What a history is made of."""

    body: Body
    table: dict[str, Any]  # the same, as inputs tell it
    label: str  # the restitution in words
    restitution: Any  # the same, as `simulate` takes it
    choice: dict[str, Any] | None  # the same, as inputs tell it; None where they cannot
    scale: float  # factor on the motion as the study has it [-]
    stretch: float = 1.0  # factor on its time [-]

    @classmethod
    def of(cls, study: OpenStudy, place: Place) -> "Variation":
        """Return what a history is made of."""
        job = study.job.job
        label, restitution, choice = _choice(study, place)
        rows = job.study.histories.rows(place.number, place.number + 1)
        scale = float(rows.values["scale"][0])
        if getattr(restitution, "per_history", False):
            drawn = {side: float(rows.values[f"r_{side}"][0]) for side in ("left", "right")}
            restitution, choice = drawn, dict(drawn)
        if job.document.map is not None:
            made = cls(job.parts.bodies[0], _table(study, 0), label, restitution, choice, scale)
            return _on_map(made, study, place)
        if job.document.spectrum is not None:
            angle, period = (job.study.coordinates[name].values for name in ("slenderness_angle", "semi_diagonal"))
            body = Block.from_angle(
                float(angle[place.index["slenderness_angle"]]), float(period[place.index["period"]])
            )
            return cls(body, body_table(body), label, restitution, choice, scale)
        number = place.index.get("body", 0)
        return cls(job.parts.bodies[number], _table(study, number), label, restitution, choice, scale)


def _on_map(made: Variation, study: OpenStudy, place: Place) -> Variation:
    """Return the variation of a cell of a map: its axes change it."""
    job = study.job.job
    assert job.document.map is not None  # asked before
    axes = {side: axis_of((table.axis, table.numbers())) for side, table in (
        ("x", job.document.map.x), ("y", job.document.map.y),
    )}  # fmt: skip
    question = Question(made.body, job.parts.motions[0], made.restitution, job.parts.settings)
    at = {side: axis.values[place.index[axis.name]][None] for side, axis in axes.items()}
    case = Plane(question, axes["x"], axes["y"]).case(at["x"], at["y"])
    geometry = {name: float(values[0]) for name, values in case.geometry.items()}
    body = changed_body(made.body, geometry)
    made = replace(made, scale=float(case.scale[0]), stretch=float(case.stretch[0]))
    if geometry:
        made = replace(made, body=body, table=body_table(body))
    if any(isinstance(axis, Restitution) for axis in axes.values()):
        value = float(case.sides["r_right"][0])
        made = replace(made, label=f"{value!r}", restitution=value, choice={"value": value})
    return made


def body_table(body: Body) -> dict[str, Any]:
    """Return a body as inputs tell it.

    Returns in m and kg/m3; the same to the last bit, but for sections that were scaled.
    """
    told = tomllib.loads(body_to_toml(body))
    return {"units": told["units"], **told["block"]} if "block" in told else told


def _table(study: OpenStudy, number: int) -> dict[str, Any]:
    return dict((study.job.job.document.body or [])[number])


def _choice(study: OpenStudy, place: Place) -> tuple[str, Any, dict[str, Any] | None]:
    """Return label, restitution, and what inputs say of it."""
    table, number = study.job.job.document.restitution, place.restitution
    label, restitution = list(study.job.job.parts.choices.items())[number]
    told: list[dict[str, Any] | None] = [{"model": table.model}] if table.model else []
    told += [{"model": word} for word in table.models or []]
    told += [{"value": value} for value in ([] if table.value is None else [table.value]) + (table.values or [])]
    if table.left is not None:
        told.append({"left": table.left, "right": table.right})
    told.append(None)  # a draw at every impact: its number is not among the inputs
    return label, restitution, told[number]


def valid(variation: Variation) -> bool:
    """Return whether a history could be computed at all.

    Returns false where the coefficient would create energy.
    """
    value = variation.restitution
    return not isinstance(value, float) or bool(np.isfinite(value))
