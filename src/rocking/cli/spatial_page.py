"""What `rocking simulate` prints of a body in space."""

import json
import math
from typing import Any

from rocking.bodies import Solid
from rocking.cli.cor_solid import base_facts, body_facts, show_body
from rocking.dynamics.space import SpatialResponse
from rocking.outcome import Outcome
from rocking.reports.response_facts import finite

_FIRST = 12
"""Contacts and impacts that are printed."""


def spatial_facts(response: SpatialResponse, solid: Solid) -> dict[str, Any]:
    """Return everything that is said of a response in space, as plain values.

    Returns SI units, named in the keys; None where something does not exist.
    """
    impacts = response.impacts
    keys = ("time_s", "energy_before_J", "energy_after_J", "impulse_N_s", "pull_N_s", "contact", "vertices")
    return {
        "body": body_facts(solid),
        "base": base_facts(solid.base),
        "repairs": list(solid.repairs),
        "motion": dict(zip(("x", "y", "vertical"), response.names, strict=True)),
        "restitution": response.law.label,
        "engine": response.trajectory.engine,
        "gravity_m_s2": response.settings.gravity,
        "outcome": response.outcome.name.lower(),
        "summary": response.summary,
        "still_rocking": _last_state(response),
        "peak_tilt_rad": response.peak_tilt,
        "overturning_time_s": finite(response.overturning_time),
        "overturning_direction_rad": finite(response.overturning_direction),
        "overturned_over": response.overturned_over or None,
        "contacts": [
            {"start_s": start, "end_s": end, "contact": contact.name.lower(), "vertices": list(vertices)}
            for start, end, contact, vertices in response.intervals
        ],
        "impacts": [dict(zip(keys, row, strict=True)) for row in impacts.tolist()],
        "energy_closure": response.energy.closure,
    }


def _last_state(response: SpatialResponse) -> dict[str, Any] | None:
    if not response.still_rocking:
        return None
    last = response.at(response.end)
    return {
        "time_s": response.end,
        "quaternion": last.quaternion[0].tolist(),
        "angular_velocity_rad_s": last.angular_velocity[0].tolist(),
        "sentence": response.unfinished,
    }


def as_json(response: SpatialResponse, solid: Solid) -> str:
    """Return everything as JSON."""
    return json.dumps(spatial_facts(response, solid), indent=2, allow_nan=False)


def show(response: SpatialResponse, solid: Solid, length: str = "m") -> None:
    """Print body, motion, outcome, contacts, impacts and measures."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    show_body(solid, length)
    for axis, name in zip(("x", "y", "vertical"), response.names, strict=True):
        console.print(f"{'motion ' + axis + ':':<16} {name}", markup=False)
    console.print(f"{'restitution:':<16} {response.law.label}", markup=False)
    console.print()
    console.print(f"{response.summary[:1].upper()}{response.summary[1:]}.", style="bold", markup=False)
    for count, table in ((len(response.intervals), _contacts(response)), (response.impacts.size, _impacts(response))):
        if count:
            console.print()
            console.print(table)
            if count > _FIRST:
                console.print(f"... and {count - _FIRST} more; --json has them all", style="dim")
    console.print()
    for word, value in _measures(response):
        console.print(f"{word + ':':<16} {value}", markup=False)


def _contacts(response: SpatialResponse) -> Any:
    table = _table(("from [s]", "to [s]", "contact", "vertices"), left=("contact", "vertices"))
    for start, end, contact, vertices in response.intervals[:_FIRST]:
        table.add_row(f"{start:.6f}", f"{end:.6f}", contact.value, "-".join(map(str, vertices)))
    return table


def _impacts(response: SpatialResponse) -> Any:
    head = ("impact [s]", "energy before [J]", "after [J]", "impulse [N s]", "stays", "vertices")
    table = _table(head, left=("stays", "vertices"))
    for time, before, after, impulse, _, contact, vertices in response.impacts[:_FIRST].tolist():
        table.add_row(f"{time:.6f}", f"{before:.5g}", f"{after:.5g}", f"{impulse:.5g}", contact, vertices)
    return table


def _measures(response: SpatialResponse) -> list[tuple[str, str]]:
    fell = response.outcome is Outcome.OVERTURNED
    peak = "it overturned" if fell else f"{math.degrees(response.peak_tilt):.6g} deg"
    return [("peak tilt", peak), ("energy closure", f"{response.energy.closure:.1e} of the largest energy")]


def _table(head: tuple[str, ...], left: tuple[str, ...]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, collapse_padding=True, header_style="bold")
    for word in head:
        table.add_column(word.replace("[", r"\["), justify="left" if word in left else "right", overflow="fold")
    return table
