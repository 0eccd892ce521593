"""A body and its impact as plain values in SI units: coefficients of all models, energy of KED, measurements."""

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from rocking import checks
from rocking.answers import Answer, AnswerRows
from rocking.bodies import Body, MassPoints, Section
from rocking.bodies.frame import section_of
from rocking.conventions import FEET, FloatArray, Foot
from rocking.errors import InvalidValueError
from rocking.evidence._coefficient_table import CoefficientRow, coefficient_table, default_models
from rocking.evidence.measurements import all_measurements
from rocking.quantities import Quantity, closely
from rocking.restitution import IdentityCheck, RestitutionModel, energy_balance, identity_report, models

CLOSELY = closely(coefficient=".6f", friction_demand=".3f", impulse_ratio=".3f") | {
    f"coefficient{end}": Quantity(f"coefficient{end}", "1", "end of the 95 % interval", digits=".3f")
    for end in ("_low", "_high")
}
"""Digits of the coefficient of a model and of derived quantities."""
_MOST_VERTICES = 2000  # maximum number of plotted vertices of a ring
_RATIOS = np.geomspace(0.8, 12.0, 40)


def outline_answer(body: Body) -> Answer:
    """Return the geometry of a body in the user's coordinates: polygons, mass points, ground and contact intervals."""
    # rings of more than 2000 vertices are thinned
    shift = body.origin_x
    return Answer({
        "outline": _polygons(body),
        "points": body.points if isinstance(body, MassPoints) else [],
        "masses": body.masses if isinstance(body, MassPoints) else [],
        "ground": body.ground,
        "base_contact": [[shift + a, shift + b] for a, b in body.local_contact],
    })  # fmt: skip


def _polygons(body: Body) -> list[dict[str, Any]]:
    section = section_of(body)
    if not isinstance(section, Section):
        return []
    shift = np.array([section.origin_x, section.ground])
    rings = [([_thinned(ring + shift) for ring in region.rings], region.density) for region in section.regions]
    return [{"outline": outline, "holes": holes, "density": density} for (outline, *holes), density in rings]


def _thinned(ring: FloatArray) -> list[list[float]]:
    kept: list[list[float]] = ring[:: max(1, -(-len(ring) // _MOST_VERTICES))].tolist()
    return kept


@dataclass(frozen=True, slots=True)
class ImpactAnswer:
    """The tables of one body, one table per requested foot."""

    body: Body
    tables: dict[Foot, tuple[CoefficientRow, ...]]  # rows by foot
    gravity: float  # acceleration of gravity [m/s2]
    identities: dict[str, tuple[IdentityCheck, ...]]  # checks by model; empty if not requested

    @classmethod
    def of(
        cls,
        body: Body,
        models: list[RestitutionModel] | None,
        *,
        foot: str,
        gravity: float,
        identities: bool,
    ) -> "ImpactAnswer":
        """Compute the tables under a gravity [m/s2]."""
        if foot not in (*FEET, "both"):
            raise InvalidValueError(parameter="foot", allowed='"left", "right" or "both"', value=foot)
        gravity = checks.positive("gravity", gravity, "m/s2")
        tables = {side: coefficient_table(body, models, foot=side) for side in FEET if foot in (side, "both")}
        if len(tables) == 2 and _same(tables["left"], tables["right"]):
            del tables["left"]
        last = next(reversed(tables))
        checked = (models or default_models()) if identities else []
        return cls(body, tables, gravity, {model.label: identity_report(body, model, foot=last) for model in checked})

    def answer(self) -> Answer:
        """Return the body, the energy of KED, and the coefficients of all models with derived quantities."""
        return Answer({
            "body": self.body.answer(self.gravity),
            "ked_energy_fractions": {foot: energy_balance(self.body, foot=foot).fractions for foot in self.tables},
            "coefficients": {foot: [row.answer() for row in rows] for foot, rows in self.tables.items()},
            "identities": {
                name: {check.name: check.holds for check in report} for name, report in self.identities.items()
            },
        }, CLOSELY)  # fmt: skip


def _same(left: tuple[CoefficientRow, ...], right: tuple[CoefficientRow, ...]) -> bool:
    pairs = zip(left, right, strict=True)
    return all(math.isclose(a.coefficient, b.coefficient, rel_tol=1e-12, abs_tol=1e-15) for a, b in pairs)


def stages_answer(body: Body, foot: Foot, angular_velocity: float = 1.0) -> Answer:
    """Return the energy balance of an impact at a velocity [rad/s], with a velocity field per stage of KED."""
    from rocking.plots.energy_stages import STAGE_WORDS

    balance = energy_balance(body, foot=foot, angular_velocity=angular_velocity)
    points = _arrow_feet(body)
    fields = balance.velocities(points[:, 0], points[:, 1])
    stages = [
        {"name": name, "description": STAGE_WORDS[name], "energy": energy, "fraction": balance.fractions[name],
         "velocity": fields[name]}
        for name, energy in balance.totals.items()
    ]  # fmt: skip
    return Answer({
        "velocity_before": balance.velocity_before,
        "velocity_after": balance.velocity_after,
        "points": points,
        "stages": stages,
    })  # fmt: skip


def _arrow_feet(body: Body) -> FloatArray:
    """Return a grid of points within a body; for mass points, the points themselves [m]."""
    from rocking.plots.energy_stages import arrow_feet

    if isinstance(body, MassPoints):
        return np.asarray(body.points, dtype=np.float64)
    points = np.stack([coordinate.ravel() for coordinate in arrow_feet(body)], axis=-1)
    return points[body.density_at(points[:, 0], points[:, 1]) > 0.0]


@cache
def measured_answer() -> Answer:
    """Return all independent published measurements; ``low`` and ``high`` bound the rounding of the printed digits."""
    data = all_measurements()
    columns = {
        "group": data.group,
        "label": data.labels,
        "slenderness_ratio": data.slenderness.tolist(),
        "slenderness_angle": np.arctan(1.0 / data.slenderness).tolist(),
        "coefficient": data.coefficient.tolist(),
        "coefficient_low": data.low.tolist(),
        "coefficient_high": data.high.tolist(),
    }
    return Answer({"source": data.source, "measurements": AnswerRows(columns)})


def curves_answer() -> list[dict[str, Any]]:
    """Return the coefficient of homogeneous rectangles under every model [-]."""
    return _curves(*models().values())


@cache
def _curves(*kinds: type) -> list[dict[str, Any]]:
    ratios = _RATIOS.tolist()
    return [
        {"model": model.label, "slenderness_ratio": ratios, "coefficient": model.of_slenderness(_RATIOS).tolist()}
        for model in default_models()
    ]
