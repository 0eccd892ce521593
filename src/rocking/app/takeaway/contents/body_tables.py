"""A body and its coefficients as tables."""

from collections.abc import Sequence

from rocking.app.takeaway.table_files import column, table
from rocking.bodies import Body
from rocking.evidence._coefficient_table import CoefficientRow
from rocking.reports.body_facts import ImpactAnswer, body_facts
from rocking.tables import Table

Fact = tuple[str, str, float, str]
"""Quantity, foot, value, unit."""

_UNITS = {"m_s2": "m/s2", "rad_s": "rad/s", "rad": "rad", "kg_m2": "kg m2", "kg": "kg", "m": "m"}
"""Endings of keys; the longer ones come first."""


def body_table(body: Body, gravity: float, name: str, about: dict[str, str]) -> Table:
    """Return what a body is.

    gravity: acceleration of gravity [m/s2].
    """
    facts = _facts(body, gravity)
    columns = {
        "body": column("", [name or type(body).__name__] * len(facts)),
        "quantity": column("", [fact[0] for fact in facts]),
        "foot": column("", [fact[1] for fact in facts]),
        "value": column("unit of its row", [fact[2] for fact in facts]),
        "unit": column("", [fact[3] for fact in facts]),
    }
    return table(columns, about)


def coefficient_table(answer: ImpactAnswer, about: dict[str, str]) -> Table:
    """Return the coefficients of a body under every model."""
    rows = [(foot, row) for foot, each in answer.tables.items() for row in each]
    plain: Sequence[CoefficientRow] = [row for _, row in rows]
    columns = {
        "onto": column("", [foot for foot, _ in rows]),
        "model": column("", [row.name for row in plain]),
        "coefficient_of_restitution": column("-", [row.coefficient for row in plain]),
        "low_95": column("-", [row.low for row in plain]),
        "high_95": column("-", [row.high for row in plain]),
        "impulse_ratio_k": column("-", [row.implication.impulse_ratio for row in plain]),
        "impulse_x": column("m", [row.implication.impulse_x for row in plain]),
        "energy_loss": column("-", [row.implication.energy_loss for row in plain]),
        "friction_demand": column("-", [row.implication.friction_demand for row in plain]),
        "admissible": column("1 yes, 0 no", [int(row.implication.admissible) for row in plain]),
        "warnings": column("", ["; ".join(row.warnings) for row in plain]),
    }
    return table(columns, about)


def _facts(body: Body, gravity: float) -> list[Fact]:
    told = body_facts(body, gravity)
    (left, right), (x, y) = told["feet_m"], told["centre_m"]
    whole: list[Fact] = [
        ("centre_x", "", x, "m"), ("centre_y", "", y, "m"),
        ("foot_x", "left", left, "m"), ("foot_x", "right", right, "m"),
    ]  # fmt: skip
    numbers = {key: value for key, value in told.items() if isinstance(value, float)}
    whole += [_fact(key, "", value) for key, value in numbers.items()]
    return whole + [_fact(key, foot, value) for foot, side in told["sides"].items() for key, value in side.items()]


def _fact(key: str, foot: str, value: float) -> Fact:
    for ending, unit in _UNITS.items():
        if key.endswith(f"_{ending}"):
            return key.removesuffix(f"_{ending}"), foot, value, unit
    # "-" alone in a cell would be taken for the start of a formula
    return key, foot, value, "1"
