"""Tables of the report of a response."""

import math
from collections.abc import Mapping

from rocking.conventions import Foot, g, given_or_assumed
from rocking.dynamics.response import Response
from rocking.evidence._coefficient_table import CALIBRATED, CoefficientRow
from rocking.motions.intensity import Measure
from rocking.outcome import Outcome
from rocking.reports.document import Cell, ReportTable, cell
from rocking.reports.facts.impact import ImpactAnswer
from rocking.reports.facts.response import outcome_facts
from rocking.reports.facts.words import restitution_words

MOST_IMPACTS = 24
"""Impacts that are printed."""

_MARKS = {Outcome.OVERTURNED: "bad", Outcome.ROCKED: "good", Outcome.NO_UPLIFT: "good"}
_SHORT = {Outcome.OVERTURNED: "overturns", Outcome.ROCKED: "stays standing", Outcome.NO_UPLIFT: "is never lifted"}


def coefficients_table(answer: ImpactAnswer, foot: Foot) -> ReportTable:
    """Return the coefficients of a body under every model."""
    header = ["model", "r [-]", "95 % interval", "impulse k [-]", "energy lost", "friction needed [-]", "notes"]
    rows = [_coefficient(row) for row in answer.tables[foot]]
    note = (
        "r: velocity after the impact over velocity before. The interval is that of one measured body, from each "
        "model's misfit to the published measurements. k: place of the impulse over half the base."
    )
    where = f", landing on the {foot} foot" if len(answer.tables) > 1 else ""
    return ReportTable(f"Coefficient of restitution{where}", header, rows, note)


def measures_table(measures: Mapping[str, Measure]) -> ReportTable:
    """Return intensity measures."""
    rows = [[cell(one.name), cell(f"{one.value:.5g}"), cell(one.unit), cell(_in_g(one))] for one in measures.values()]
    return ReportTable("Intensity of the motion", ["measure", "value", "unit", "in g"], rows)


def outcomes_table(responses: Mapping[str, Response], friction: float) -> ReportTable:
    """Return how the body ends under every restitution.

    friction: coefficient of friction between body and ground [-].
    """
    header = [
        "restitution", "r left", "r right", "outcome", "peak [deg]", "peak / \N{GREEK SMALL LETTER ALPHA} [-]",
        "impacts", "friction taken [-]", "friction at impacts [-]",
    ]  # fmt: skip
    rows = [_outcome(label, response, friction) for label, response in responses.items()]
    note = (
        "A peak beyond 1 means that the centre of mass passed the foot and came back. Friction taken: largest ratio of "
        "horizontal to vertical force while the body stands on one foot; "
        f"{friction:g} was {given_or_assumed(friction)}."
    )
    return ReportTable("How it ends", header, rows, note)


def impacts_table(label: str, response: Response) -> ReportTable:
    """Return the impacts of a response.

    Returns one impact a row, at most 24.
    """
    header = ["impact", "time [s]", "velocity before [rad/s]", "after [rad/s]", "r [-]", "onto"]
    shown = response.impacts[:MOST_IMPACTS].tolist()
    rows = [
        [cell(k), cell(f"{time:.6f}"), cell(_signed(before)), cell(_signed(after)), cell(f"{r:.6f}"), cell(onto)]
        for k, (time, before, after, r, onto) in enumerate(shown, start=1)
    ]
    rest = response.impacts.size - len(shown)
    note = f"{rest} more, smaller and smaller; the table of impacts has them all." if rest > 0 else ""
    return ReportTable(f"Impacts with {restitution_words(label)}", header, rows, note)


def _coefficient(row: CoefficientRow) -> list[Cell]:
    fact = row.implication
    return [
        cell(restitution_words(row.name)),
        cell(f"{row.coefficient:.5f}"),
        cell(f"{row.low:.3f} to {row.high:.3f}"),
        cell(f"{fact.impulse_ratio:.3f}"),
        cell(f"{100.0 * fact.energy_loss:.2f} %"),
        cell(f"{fact.friction_demand:.3f}"),
        cell("see below" if row.warnings else ("fitted" if row.name == CALIBRATED else ""), "fair"),
    ]


def _outcome(label: str, response: Response, friction: float) -> list[Cell]:
    facts, contact = outcome_facts(response), response.contact
    fell = response.outcome is Outcome.OVERTURNED
    word = _SHORT[response.outcome] + (f" to the {facts['overturned_to']}" if fell else "")
    return [
        cell(restitution_words(label)),
        cell(f"{response.parameters.left.coefficient:.4f}"),
        cell(f"{response.parameters.right.coefficient:.4f}"),
        cell(word, _MARKS.get(response.outcome, "plain")),
        cell("-" if fell else f"{math.degrees(response.peak_rotation):.4g}"),
        cell("-" if fell else f"{facts['peak_rotation_over_alpha']:.4g}"),
        cell(response.impacts.size),
        _friction(contact.friction_of_motion, friction),
        _friction(contact.friction_of_impacts, friction),
    ]


def _friction(value: float, given: float) -> Cell:
    words = f"{value:.3f}" if math.isfinite(value) else "no surface has it"
    return cell(words, "bad" if value > given else "plain")


def _signed(value: float) -> str:
    return f"{value:+.6f}".replace("-", "\N{MINUS SIGN}")


def _in_g(measure: Measure) -> str:
    return f"{measure.value / g:.4g}" if measure.unit == "m/s2" else ""
