"""A body and its coefficients as tables."""

from collections.abc import Sequence

from rocking.app.takeaway.sheets import Column, Sheet
from rocking.bodies import Body
from rocking.evidence._coefficient_table import CoefficientRow
from rocking.report.facts.body import body_facts
from rocking.report.facts.impact import ImpactAnswer

Fact = tuple[str, str, float, str]
"""Quantity, foot, value, unit."""

_UNITS = {"m_s2": "m/s2", "rad_s": "rad/s", "rad": "rad", "kg_m2": "kg m2", "kg": "kg", "m": "m"}
"""Endings of keys; the longer ones come first."""


def body_sheet(body: Body, gravity: float, name: str, about: dict[str, str]) -> Sheet:
    """Return what a body is.

    gravity: acceleration of gravity [m/s2].
    """
    facts = _facts(body, gravity)
    columns = [
        Column.of("body", "", [name or type(body).__name__] * len(facts)),
        Column.of("quantity", "", [fact[0] for fact in facts]),
        Column.of("foot", "", [fact[1] for fact in facts]),
        Column.of("value", "unit of its row", [fact[2] for fact in facts]),
        Column.of("unit", "", [fact[3] for fact in facts]),
    ]
    return Sheet("body", columns, about)


def coefficient_sheet(answer: ImpactAnswer, about: dict[str, str]) -> Sheet:
    """Return the coefficients of a body under every model."""
    rows = [(foot, row) for foot, table in answer.tables.items() for row in table]
    plain: Sequence[CoefficientRow] = [row for _, row in rows]
    columns = [
        Column.of("onto", "", [foot for foot, _ in rows]),
        Column.of("model", "", [row.name for row in plain]),
        Column.of("coefficient_of_restitution", "-", [row.coefficient for row in plain]),
        Column.of("low_95", "-", [row.low for row in plain]),
        Column.of("high_95", "-", [row.high for row in plain]),
        Column.of("impulse_ratio_k", "-", [row.implication.impulse_ratio for row in plain]),
        Column.of("impulse_x", "m", [row.implication.impulse_x for row in plain]),
        Column.of("energy_loss", "-", [row.implication.energy_loss for row in plain]),
        Column.of("friction_demand", "-", [row.implication.friction_demand for row in plain]),
        Column.of("admissible", "1 yes, 0 no", [int(row.implication.admissible) for row in plain]),
        Column.of("warnings", "", ["; ".join(row.warnings) for row in plain]),
    ]
    return Sheet("coefficients", columns, about)


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
