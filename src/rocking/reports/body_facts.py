"""A body and its impact in plain values, SI units: what every model says of it, the energy of KED, the measurements."""

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Block, Body, MassPoints, Section
from rocking.conventions import FEET, FloatArray, Foot
from rocking.errors import InvalidValueError
from rocking.evidence._coefficient_table import CoefficientRow, coefficient_table, default_models
from rocking.evidence.measurements import all_measurements
from rocking.restitution import IdentityCheck, RestitutionModel, energy_balance, identity_report, models

_MOST_VERTICES = 2000  # vertices of a ring that is drawn
_RATIOS = np.geomspace(0.8, 12.0, 40)


def body_facts(body: Body, gravity: float) -> dict[str, Any]:
    """Return what is said of a body under a gravity [m/s2]."""
    return {
        "kind": type(body).__name__,
        "mass_kg": body.mass,
        "centre_m": body.centre,
        "feet_m": body.feet,
        "moment_of_inertia_kg_m2": body.moment_of_inertia,
        "gravity_m_s2": gravity,
        "assumed": list(body.assumed),
        "warnings": list(body.doubts),
        "sides": {foot: side_facts(body, foot, gravity) for foot in FEET},
    }


def side_facts(body: Body, foot: Foot, gravity: float) -> dict[str, float]:
    """Return what one side of a body decides under a gravity [m/s2]."""
    side = body.side(foot, gravity)
    return {
        "slenderness_ratio": side.slenderness_ratio,
        "slenderness_angle_rad": side.slenderness_angle,
        "semi_diagonal_m": side.semi_diagonal,
        "frequency_parameter_rad_s": side.frequency_parameter,
        "uplift_acceleration_m_s2": side.uplift_acceleration,
    }


def outline_facts(body: Body) -> dict[str, Any]:
    """Return what draws a body, in the user's coordinates."""
    # returns ``outline``: polygons with holes [m] and density [kg/m3], rings of more than 2000 vertices thinned;
    # ``points``: x, y [m] and mass [kg] of mass points; ``centre``; ``base``: both feet; ``ground``: its height;
    # ``contact``: stretches of the base that touch [m]
    shift = body.origin_x
    points = np.column_stack([body.points, body.masses]).tolist() if isinstance(body, MassPoints) else []
    return {
        "outline": _polygons(body),
        "points": points,
        "centre": list(body.centre),
        "base": list(body.feet),
        "ground": body.ground,
        "contact": [[shift + a, shift + b] for a, b in body.local_contact],
    }


def _polygons(body: Body) -> list[dict[str, Any]]:
    whole = body.to_section() if isinstance(body, Block) else body
    if not isinstance(whole, Section):
        return []
    shift = np.array([whole.origin_x, whole.ground])
    rings = [([_thinned(ring + shift) for ring in region.rings], region.density) for region in whole.regions]
    return [{"outline": outline, "holes": holes, "density": density} for (outline, *holes), density in rings]


def _thinned(ring: FloatArray) -> list[list[float]]:
    chosen: list[list[float]] = ring[:: max(1, -(-len(ring) // _MOST_VERTICES))].tolist()
    return chosen


@dataclass(frozen=True, slots=True)
class ImpactAnswer:
    """The tables of one body, one for each foot that was asked for."""

    body: Body
    tables: dict[Foot, tuple[CoefficientRow, ...]]  # foot to rows
    gravity: float  # acceleration of gravity [m/s2]
    identities: dict[str, tuple[IdentityCheck, ...]]  # model to its checks; empty if not asked for

    @classmethod
    def of(
        cls,
        body: Body,
        models: list[RestitutionModel] | None,
        *,
        onto: str,
        gravity: float,
        identities: bool,
    ) -> "ImpactAnswer":
        """Compute the tables under a gravity [m/s2]."""
        if onto not in (*FEET, "both"):
            raise InvalidValueError(f'onto must be "left", "right" or "both", got {onto!r}')
        gravity = checks.positive("gravity", gravity, "m/s2")
        tables = {foot: coefficient_table(body, models, onto=foot) for foot in FEET if onto in (foot, "both")}
        if len(tables) == 2 and _same(tables["left"], tables["right"]):
            del tables["left"]
        foot = next(reversed(tables))
        checked = (models or default_models()) if identities else []
        return cls(body, tables, gravity, {each.label: identity_report(body, each, onto=foot) for each in checked})


def impact_facts(answer: ImpactAnswer) -> dict[str, Any]:
    """Return everything that is said of an impact."""
    body = answer.body
    return {
        "body": body_facts(body, answer.gravity),
        "ked_energy_shares": {foot: energy_balance(body, onto=foot).shares for foot in answer.tables},
        "coefficients": {foot: [row.as_dict() for row in rows] for foot, rows in answer.tables.items()},
        "identities": {
            name: {check.name: check.holds for check in report} for name, report in answer.identities.items()
        },
    }


def _same(left: tuple[CoefficientRow, ...], right: tuple[CoefficientRow, ...]) -> bool:
    pairs = zip(left, right, strict=True)
    return all(math.isclose(a.coefficient, b.coefficient, rel_tol=1e-12, abs_tol=1e-15) for a, b in pairs)


def stages_facts(body: Body, onto: Foot, angular_velocity: float = 1.0) -> dict[str, Any]:
    """Return the energy balance of an impact at a velocity [rad/s] with a field of velocities for each stage of KED."""
    from rocking.plots.energy_stages import STAGE_WORDS

    balance = energy_balance(body, onto=onto, angular_velocity=angular_velocity)
    points = _arrow_feet(body)
    fields = balance.velocities(points[:, 0], points[:, 1])
    stages = [
        {"name": name, "words": STAGE_WORDS[name], "energy_J": energy, "share": balance.shares[name],
         "velocity_m_s": fields[name].tolist()}
        for name, energy in balance.totals.items()
    ]  # fmt: skip
    return {
        "velocity_before_rad_s": balance.velocity_before,
        "velocity_after_rad_s": balance.velocity_after,
        "points_m": points.tolist(),
        "stages": stages,
    }


def _arrow_feet(body: Body) -> FloatArray:
    """Return points within a body, in rows and columns; of mass points themselves."""
    from rocking.plots.energy_stages import arrow_feet

    if isinstance(body, MassPoints):
        return np.asarray(body.points, dtype=np.float64)
    points = np.stack([each.ravel() for each in arrow_feet(body)], axis=-1)
    return points[body.density_at(points[:, 0], points[:, 1]) > 0.0]


@cache
def measured_facts() -> dict[str, Any]:
    """Return every independent published measurement; ``low`` and ``high`` are what the printed digits leave open."""
    data = all_measurements()
    columns = {
        "group": data.group,
        "label": data.labels,
        "slenderness_ratio": data.slenderness.tolist(),
        "slenderness_angle_rad": np.arctan(1.0 / data.slenderness).tolist(),
        "coefficient": data.coefficient.tolist(),
        "low": data.low.tolist(),
        "high": data.high.tolist(),
    }
    rows = zip(*columns.values(), strict=True)
    return {"source": data.source, "points": [dict(zip(columns, row, strict=True)) for row in rows]}


def curves_facts() -> list[dict[str, Any]]:
    """Return the coefficient of homogeneous rectangles under every model [-]."""
    return _curves(*models().values())


@cache
def _curves(*kinds: type) -> list[dict[str, Any]]:
    ratios = _RATIOS.tolist()
    return [
        {"model": model.label, "slenderness_ratio": ratios, "coefficient": model.of_slenderness(_RATIOS).tolist()}
        for model in default_models()
    ]
