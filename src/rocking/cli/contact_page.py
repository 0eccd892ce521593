"""What `rocking simulate --contact` computes and prints: rest, slide, rock, slide while rocking, flight."""

import json
import math
from typing import Any

from rocking.cli.options import in_unit
from rocking.cli.simulate_question import Question, restitution_from
from rocking.conventions import LENGTH_UNITS, Assumed, given_or_assumed
from rocking.dynamics import ContactResponse, free_rocking, simulate
from rocking.errors import RockingError
from rocking.outcome import Outcome, Regime
from rocking.reports.response_facts import finite, moved_facts, still_rocking_facts

_FIRST = 12
"""Modes and impacts that are printed."""

_MODE_KEYS = ("start_s", "end_s", "mode", "feet", "slip", "distance_m")
_IMPACT_KEYS = (
    "time_s", "feet", "velocity_before_rad_s", "velocity_after_rad_s", "normal_left_N_s", "normal_right_N_s",
    "tangential_left_N_s", "tangential_right_N_s", "lost_J", "slips",
)  # fmt: skip

COMPLEMENTARITY = "complementarity"
"""Word for rocking impacts that follow from complementarity, as all others do."""


def contact_response(question: Question, restitution: str, bounce: float) -> ContactResponse:
    """Return what a body does that may slide and hop.

    bounce: Newton's coefficient of normal velocities [-].
    """
    law = None if restitution == COMPLEMENTARITY else restitution_from(restitution)
    contact = {"friction": question.assumed_friction, "bounce": bounce, "gravity": question.settings.gravity}
    response: ContactResponse = (
        free_rocking(question.body, question.rotation, law, **contact)
        if question.motion is None
        else simulate(question.body, question.motion, law, scale=question.scale, **contact)
    )
    if response.outcome is Outcome.FAILED:
        raise RockingError(f"there is no response: {response.status.value}")
    return response


def contact_facts(response: ContactResponse) -> dict[str, Any]:
    """Return everything that is said of a response with contact, as plain values.

    Returns SI units, named in the keys; None where something does not exist.
    """
    law, energy = response.law, response.energy
    imposed = None if law.restitution is None else dict(zip(("left", "right"), law.restitution, strict=True))
    return {
        "body": {
            "kind": type(response.body).__name__,
            "mass_kg": response.body.mass,
            "assumed": list(response.body.assumed),
            "warnings": list(response.body.doubts),
        },
        "motion": moved_facts(response.motion, response.scale),
        "initial_rotation_rad": float(response.rotation[0]),
        "friction": law.friction,
        "friction_assumed": isinstance(law.friction, Assumed),
        "bounce": law.bounce,
        "imposed_restitution": imposed,
        "gravity_m_s2": response.settings.gravity,
        "outcome": response.outcome.name.lower(),
        "summary": response.summary,
        "still_rocking": still_rocking_facts(response),
        "overturning_time_s": finite(response.overturning_time),
        "peak_rotation_rad": response.peak_rotation,
        "sliding_distance_m": response.sliding_distance,
        "final_displacement_m": float(response.displacement[-1]),
        "friction_usage": response.friction_usage,
        "modes": _rows(response.regimes, _MODE_KEYS),
        "impacts": _rows(response.impacts, _IMPACT_KEYS),
        "lost_in_impacts_J": float(energy.lost_in_impacts[-1]),
        "lost_in_friction_J": float(energy.lost_in_friction[-1]),
        "energy_closure": energy.closure,
    }


def as_json(response: ContactResponse) -> str:
    """Return everything as JSON."""
    return json.dumps(contact_facts(response), indent=2, allow_nan=False)


def show(response: ContactResponse, length: str = "m") -> None:
    """Print contact, outcome, modes, impacts and measures."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    for word, value in _facts(response):
        console.print(f"{word + ':':<13} {value}", markup=False)
    console.print()
    console.print(f"{response.summary[:1].upper()}{response.summary[1:]}.", style="bold", markup=False)
    modes, impacts = (rows[:_FIRST] for rows in (response.regimes, response.impacts))
    for rows, table in ((response.regimes, _modes(modes, length)), (response.impacts, _impacts(impacts))):
        if rows.size:
            console.print()
            console.print(table)
            if rows.size > _FIRST:
                console.print(f"... and {rows.size - _FIRST} more; --json has them all", style="dim")
    console.print()
    for word, value in _measures(response, length):
        console.print(f"{word + ':':<16} {value}", markup=False)


def _rows(table: Any, keys: tuple[str, ...]) -> list[dict[str, Any]]:
    return [dict(zip(keys, row, strict=True)) for row in table.tolist()]


def _facts(response: ContactResponse) -> list[tuple[str, str]]:
    motion, law = response.motion, response.law
    times = "" if response.scale == 1.0 else f"{response.scale:g} times "
    let_go = f"none; let go at {math.degrees(float(response.rotation[0])):.4g} deg"
    imposed = COMPLEMENTARITY
    if law.restitution is not None:
        left, right = law.restitution
        imposed = f"r = {right:.6f}" if left == right else f"left r = {left:.6f}, right r = {right:.6f}"
    return [
        ("body", f"{type(response.body).__name__}, {response.body.mass:.4g} kg"),
        *(("density", sentence.removeprefix("density ")) for sentence in response.body.assumed),
        ("motion", let_go if motion is None else times + motion.name),
        ("contact", f"friction {law.friction:g}, {given_or_assumed(law.friction)}; bounce {law.bounce:g}"),
        ("restitution", imposed),
    ]


def _modes(rows: Any, length: str) -> Any:
    table = _table(("from [s]", "to [s]", "mode", "feet", f"slid [{length}]"), left=("mode", "feet"))
    for start, end, regime, feet, _, distance in rows.tolist():
        slid = f"{distance / LENGTH_UNITS[length]:+.6f}" if distance else ""
        table.add_row(f"{start:.6f}", f"{end:.6f}", Regime[regime].value, feet, slid)
    return table


def _impacts(rows: Any) -> Any:
    head = ("impact [s]", "feet", "velocity before [rad/s]", "after [rad/s]", "lost [J]", "feet slide")
    table = _table(head, left=("feet",))
    for row in rows.tolist():
        time, feet, before, after, *_, lost, slips = row
        table.add_row(f"{time:.6f}", feet, f"{before:+.6f}", f"{after:+.6f}", f"{lost:.4g}", "yes" if slips else "")
    return table


def _measures(response: ContactResponse, length: str) -> list[tuple[str, str]]:
    fell, energy = response.outcome is Outcome.OVERTURNED, response.energy
    at_the_end = in_unit(float(response.displacement[-1]), length, "+.6g")
    return [
        ("peak rotation", "it overturned" if fell else f"{math.degrees(response.peak_rotation):.6g} deg"),
        ("slid", f"{in_unit(response.sliding_distance, length, '.6g')} in all, {at_the_end} at the end"),
        ("friction used", f"{100.0 * response.friction_usage:.4g} % of what there is, at most"),
        (
            "energy lost",
            f"{energy.lost_in_impacts[-1]:.5g} J in impacts, {energy.lost_in_friction[-1]:.5g} J in friction",
        ),
        ("energy closure", f"{energy.closure:.1e} of the largest energy"),
    ]


def _table(head: tuple[str, ...], left: tuple[str, ...]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, collapse_padding=True, header_style="bold")
    for word in head:
        table.add_column(word.replace("[", r"\["), justify="left" if word in left else "right", overflow="fold")
    return table
