"""Responses as tables: samples, impacts, and what the models say side by side."""

from collections.abc import Mapping

from rocking.app.takeaway.table_files import column, table
from rocking.dynamics.plane.export import columns
from rocking.dynamics.response import Response
from rocking.quantities import QUANTITIES
from rocking.reports.response_facts import outcome_facts
from rocking.tables import Table


def response_table(response: Response, about: dict[str, str]) -> Table:
    """Return the samples of a response."""
    return table({key: column(QUANTITIES[key].unit, values) for key, values in columns(response).items()}, about)


def impacts_table(responses: Mapping[str, Response], about: dict[str, str]) -> Table:
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
    return table({name: column(unit, [row[k] for row in rows]) for k, (name, unit) in enumerate(heads)}, about)


def outcomes_table(responses: Mapping[str, Response], about: dict[str, str]) -> Table:
    """Return how every response ended."""
    found = [outcome_facts(response) for response in responses.values()]
    all_parameters = [response.parameters for response in responses.values()]
    made = {
        "restitution": column("", list(responses)),
        "coefficient_onto_left": column("-", [parameters.left.coefficient for parameters in all_parameters]),
        "coefficient_onto_right": column("-", [parameters.right.coefficient for parameters in all_parameters]),
        "outcome": column("", [one["outcome"] for one in found]),
        "summary": column("", [one["summary"] for one in found]),
        "peak_rotation": column("rad", [one["peak_rotation_rad"] for one in found]),
        "peak_over_slenderness_angle": column("-", [one["peak_rotation_over_alpha"] for one in found]),
        "overturning_time": column("s", [one["overturning_time_s"] for one in found]),
        "impacts": column("-", [int(response.impacts.size) for response in responses.values()]),
    }
    return table(made, about)
