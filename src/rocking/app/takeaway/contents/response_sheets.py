"""Responses as tables: samples, impacts, and what the models say side by side."""

from collections.abc import Mapping

from rocking.app.takeaway.sheets import Column, Sheet
from rocking.dynamics.response import Response
from rocking.dynamics.samples import columns
from rocking.quantities import QUANTITIES
from rocking.report.facts.response import outcome_facts


def response_sheet(response: Response, name: str, about: dict[str, str]) -> Sheet:
    """Return the samples of a response."""
    return Sheet(
        name, [Column.of(key, QUANTITIES[key].unit, values) for key, values in columns(response).items()], about
    )


def impacts_sheet(responses: Mapping[str, Response], about: dict[str, str]) -> Sheet:
    """Return the impacts of every response.

    Returns one impact a row; none if there is no impact.
    """
    rows = [
        (label, number, *row)
        for label, response in responses.items()
        for number, row in enumerate(response.impacts.tolist(), start=1)
    ]
    heads = (
        ("restitution", ""), ("impact", "-"), ("time", "s"), ("velocity_before", "rad/s"),
        ("velocity_after", "rad/s"), ("coefficient", "-"), ("onto", ""),
    )  # fmt: skip
    made = [Column.of(name, unit, [row[k] for row in rows]) for k, (name, unit) in enumerate(heads)]
    return Sheet("impacts", made, about)


def outcomes_sheet(responses: Mapping[str, Response], about: dict[str, str]) -> Sheet:
    """Return how every response ended."""
    found = [outcome_facts(response) for response in responses.values()]
    rockers = [response.rocker for response in responses.values()]
    made = [
        Column.of("restitution", "", list(responses)),
        Column.of("coefficient_onto_left", "-", [rocker.left.coefficient for rocker in rockers]),
        Column.of("coefficient_onto_right", "-", [rocker.right.coefficient for rocker in rockers]),
        Column.of("outcome", "", [one["outcome"] for one in found]),
        Column.of("summary", "", [one["summary"] for one in found]),
        Column.of("peak_rotation", "rad", [one["peak_rotation_rad"] for one in found]),
        Column.of("peak_over_slenderness_angle", "-", [one["peak_rotation_over_alpha"] for one in found]),
        Column.of("overturning_time", "s", [one["overturning_time_s"] for one in found]),
        Column.of("impacts", "-", [int(response.impacts.size) for response in responses.values()]),
    ]
    return Sheet("outcomes", made, about)
