"""What `rocking simulate` prints."""

import math
from typing import Any

from rocking.cli.inputs import body_words
from rocking.cli.options import in_unit
from rocking.cli.simulate_question import ResponseComparison
from rocking.conventions import given_or_assumed
from rocking.dynamics.response import Response
from rocking.motions.pulse import Pulse
from rocking.outcome import Outcome
from rocking.reports.response_facts import ModelAgreement

_FIRST = 10
"""Impacts that are printed."""

_IN_PYTHON = "simulate(body, motion, friction=...)"


def show(answer: ResponseComparison, length: str = "m", acceleration: str = "m/s2") -> None:
    """Print body, motion, outcome, impacts, doubts, and what other models say."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    response = answer.response
    for word, value in _facts(response, length, acceleration):
        console.print(f"{word + ':':<13} {value}", markup=False)
    console.print()
    console.print(_sentence(response.summary) + ".", style="bold", markup=False)
    if response.impacts.size:
        console.print()
        console.print(_impacts(response))
        if response.impacts.size > _FIRST:
            console.print(f"... and {response.impacts.size - _FIRST} more; --json has them all", style="dim")
    console.print()
    for word, value in _measures(answer):
        console.print(f"{word + ':':<16} {value}", markup=False)
    for warning in response.doubts(answer.friction):
        console.print(f"! {warning.replace(_IN_PYTHON, '--contact')}", style="yellow", markup=False)
    console.print()
    console.print("With other restitution models", style="bold")
    console.print(_rivals(answer))
    for name, found in answer.others.items():
        if isinstance(found, str):
            console.print(f"! {name}: {found}", style="yellow", markup=False)
    console.print(_verdict(answer), markup=False)


def _facts(response: Response, length: str, acceleration: str) -> list[tuple[str, str]]:
    body, parameters, motion = response.body, response.parameters, response.motion
    r = {parameters.left.coefficient, parameters.right.coefficient}
    value = f"r = {parameters.left.coefficient:.6f}"
    if len(r) > 1:
        value = f"onto the left foot {value}, onto the right one r = {parameters.right.coefficient:.6f}"
    if motion is None:
        ground = f"none; let go at {math.degrees(float(response.rotation[0])):.4g} deg"
    else:
        times = "" if response.scale == 1.0 else f"{response.scale:g} times "
        peak = f", peak {in_unit(abs(response.scale) * motion.peak, acceleration)}"
        ground = times + motion.name
        if not isinstance(motion, Pulse):
            ground += f", {motion.duration:.4g} s{peak}"
        elif times:
            ground += peak
    equations = ", slender-linear equations" if response.settings.linear else ""
    return [
        ("body", body_words(body, response.settings.gravity, length)),
        *(("density", sentence.removeprefix("density ")) for sentence in body.assumed),
        ("motion", ground),
        ("restitution", f"{parameters.label}, {value}"),
        ("engine", f"{response.engine}{equations}"),
    ]


def _impacts(response: Response) -> Any:
    rows = response.impacts[:_FIRST]
    head = ("impact", "time [s]", "velocity before [rad/s]", "after [rad/s]", "r", "onto")
    table = _table(head, left=("onto",))
    for k, row in enumerate(rows.tolist()):
        time, before, after, r, onto = row
        table.add_row(str(k + 1), f"{time:.6f}", f"{before:+.6f}", f"{after:+.6f}", f"{r:.6f}", onto)
    return table


def _measures(answer: ResponseComparison) -> list[tuple[str, str]]:
    response = answer.response
    contact, error = response.contact, response.error_estimate
    fell = response.outcome is Outcome.OVERTURNED
    peak = f"{math.degrees(response.peak_rotation):.6g} deg, {_over_alpha(response):.6g} of the slenderness angle"
    demand = contact.friction_demand
    needed = "more than any surface has" if math.isinf(demand) else f"{demand:.3g}"
    doubt = (
        "another step changes the outcome: it hangs by a thread"
        if math.isinf(error)
        else f"{error:.1e} rad, the largest change of the rotation if every step is halved"
    )
    return [
        ("peak rotation", "it overturned" if fell else peak),
        ("energy closure", f"{response.energy.closure:.1e} of the largest energy"),
        ("friction", f"{needed} needed, {answer.friction:g} {given_or_assumed(answer.friction)}"),
        ("error estimate", doubt),
    ]


def _rivals(answer: ResponseComparison) -> Any:
    table = _table(("model", "r", "outcome", "peak deg", "/ alpha", "impacts"), left=("model", "outcome"))
    chosen = answer.response.parameters.label
    for name, found in {chosen: answer.response, **answer.others}.items():
        if isinstance(found, str):
            table.add_row(name, "", "not for this body", "", "", "")
            continue
        left, right = found.parameters.left.coefficient, found.parameters.right.coefficient
        r = f"{right:.4f}" if left == right else f"{left:.3f}/{right:.3f}"
        fell = found.outcome is Outcome.OVERTURNED
        size = ("-", "-") if fell else (f"{math.degrees(found.peak_rotation):.4g}", f"{_over_alpha(found):.4g}")
        table.add_row(name, r, _short(found), *size, str(found.impacts.size), style="bold" if name == chosen else None)
    return table


def _verdict(answer: ResponseComparison) -> str:
    found = {answer.response.parameters.label: answer.response}
    found |= {name: one for name, one in answer.others.items() if isinstance(one, Response)}
    return ModelAgreement.of(found).sentence


def _short(response: Response) -> str:
    if response.outcome is Outcome.OVERTURNED:
        return f"overturned {'right' if response.trajectory.side > 0 else 'left'}"
    if response.outcome is Outcome.ROCKED:
        return "still rocking" if response.still_rocking else "rocked"
    return "no uplift"


def _over_alpha(response: Response) -> float:
    side = response.parameters.side(response.trajectory.peak_rotation)
    return response.peak_rotation / side.slenderness_angle


def _sentence(words: str) -> str:
    return words[:1].upper() + words[1:]


def _table(head: tuple[str, ...], left: tuple[str, ...]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, collapse_padding=True, header_style="bold")
    for word in head:
        table.add_column(word.replace("[", r"\["), justify="left" if word in left else "right", overflow="fold")
    return table
