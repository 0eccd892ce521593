"""An impact in plain values: every model's coefficient with its interval, what it implies, and the energy of KED."""

import math
from dataclasses import dataclass
from typing import Any

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FEET, Foot
from rocking.errors import InvalidValueError
from rocking.evidence._coefficient_table import CoefficientRow, coefficient_table, default_models
from rocking.reports.facts.body import body_facts
from rocking.restitution import IdentityCheck, RestitutionModel, energy_balance, identity_report


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
        eta: float,
        gravity: float,
        identities: bool,
    ) -> "ImpactAnswer":
        """Compute the tables.

        eta: interface factor [-]; gravity: acceleration of gravity [m/s2].
        """
        if onto not in (*FEET, "both"):
            raise InvalidValueError(f'onto must be "left", "right" or "both", got {onto!r}')
        gravity = checks.positive("gravity", gravity, "m/s2")
        tables = {foot: coefficient_table(body, models, onto=foot, eta=eta) for foot in FEET if onto in (foot, "both")}
        if len(tables) == 2 and _same(tables["left"], tables["right"]):
            del tables["left"]
        foot = next(reversed(tables))
        tried = (models or default_models()) if identities else []
        return cls(body, tables, gravity, {each.label: identity_report(body, each, onto=foot) for each in tried})


def impact_facts(answer: ImpactAnswer) -> dict[str, Any]:
    """Return everything as plain values.

    Returns SI units, named in the keys where a quantity has one.
    """
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
