"""What `rocking simulate` shows of each mechanics: pure rocking, sliding and hopping, a body in space."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rocking.cli.numbers import in_unit
from rocking.cli.page import Page, sentence
from rocking.conventions import LENGTH_UNITS, Assumed, given_or_assumed
from rocking.errors import InvalidValueError, RockingError
from rocking.outcome import Outcome, Regime
from rocking.spec.response import COMPLEMENTARITY, ResponseProblem

_FIRST_IMPACTS = 10
"""Impacts of pure rocking that are printed."""

_FIRST = 12
"""Contacts, modes and impacts of the others that are printed."""

_IN_PYTHON = "simulate(body, motion, friction=...)"
_CLOSURE = "{:.1e} of the largest energy"


def answer_of(problem: ResponseProblem, length: str, acceleration: str, *, listed: bool) -> Any:
    """Return what a problem has for an answer.

    length, acceleration: units in which it is printed; listed: whether the restitutions beside the first are those
    that the problem lists, in place of every model that needs no value.
    """
    response = problem.answer()
    if response.outcome is Outcome.FAILED:
        raise RockingError(f"there is no response: {response.status.value}")
    if problem.mechanics == "space":
        return SpaceAnswer(problem, response, length)
    if problem.mechanics == "contact":
        return ContactAnswer(problem, response, length)
    return RockingAnswer(problem, response, _others(problem, response, listed=listed), length, acceleration)


def _others(problem: ResponseProblem, response: Any, *, listed: bool) -> dict[str, Any]:
    """Return by model the response, or why the model has none for this body."""
    rivals = dict(list(problem.restitutions.items())[1:])
    if not listed:
        from rocking.evidence._coefficient_table import default_models

        rivals = {model.label: model for model in default_models() if model.label != response.parameters.label}
    others = {}
    for name, law in rivals.items():
        try:
            others[name] = problem.answer(law)
        except InvalidValueError as error:
            others[name] = str(error)
    return others


def _moved(response: Any) -> str:
    if response.motion is None:
        return f"none; let go at {math.degrees(float(response.rotation[0])):.4g} deg"
    return f"{'' if response.scale == 1.0 else f'{response.scale:g} times '}{response.motion.name}"


def _some(page: Page, rows: Any, most: int, head: Sequence[str], cells: Any, left: Sequence[str]) -> None:
    """Write the first rows of a table, and how many more there are."""
    if not len(rows):
        return
    page.line()
    page.table(head, [cells(k, row) for k, row in enumerate(rows[:most])], left, dense=True)
    if len(rows) > most:
        page.line(f"... and {len(rows) - most} more; --json has them all", style="dim")


@dataclass(frozen=True)
class RockingAnswer:
    """A response of pure rocking, and what the other models of impact make of the same problem."""

    problem: ResponseProblem
    response: Any
    others: dict[str, Any]  # by model: the response, or why the model has none for this body
    length: str
    acceleration: str

    def draw(self) -> Any:
        """Return its picture."""
        from rocking.plots.response import response_picture

        return response_picture(self.response, self.problem.assumed_friction)

    def facts(self) -> dict[str, Any]:
        """Return everything as plain values."""
        from rocking.reports.response_facts import other_facts, response_facts

        facts = response_facts(self.response, self.problem.assumed_friction)
        facts["other_models"] = {name: other_facts(other) for name, other in self.others.items()}
        return facts

    def show(self, page: Page) -> None:
        """Write body, motion, outcome, impacts, doubts, and what other models say."""
        from rocking.reports.response_facts import ModelAgreement

        response = self.response
        page.facts(self._head())
        page.line()
        page.line(sentence(response.summary), "bold")
        head = ("impact", "time [s]", "velocity before [rad/s]", "after [rad/s]", "r", "onto")
        _some(page, response.impacts.tolist(), _FIRST_IMPACTS, head, _impact_row, ("onto",))
        page.line()
        page.facts(self._measures(), 16)
        doubts = response.doubts(self.problem.assumed_friction)
        page.warn(doubt.replace(_IN_PYTHON, "--friction") for doubt in doubts)
        page.line()
        page.line("With other restitution models", "bold")
        names = ("model", "r", "outcome", "peak deg", "/ alpha", "impacts")
        rows = [_model_row(name, one) for name, one in {response.parameters.label: response, **self.others}.items()]
        page.table(names, rows, ("model", "outcome"), bold={0}, dense=True)
        page.warn(f"{name}: {other}" for name, other in self.others.items() if isinstance(other, str))
        answers = {name: other for name, other in self.others.items() if not isinstance(other, str)}
        page.line(ModelAgreement.of({response.parameters.label: response, **answers}).sentence)

    def _head(self) -> list[tuple[str, str]]:
        from rocking.cli.study import body_lines
        from rocking.motions.pulse import Pulse

        response, motion, parameters = self.response, self.response.motion, self.response.parameters
        left, right = parameters.left.coefficient, parameters.right.coefficient
        value = f"r = {left:.6f}"
        if left != right:
            value = f"onto the left foot {value}, onto the right one r = {right:.6f}"
        ground = _moved(response)
        if motion is not None:
            peak = f", peak {in_unit(abs(response.scale) * motion.peak, self.acceleration)}"
            if not isinstance(motion, Pulse):
                ground += f", {motion.duration:.4g} s{peak}"
            elif response.scale != 1.0:
                ground += peak
        equations = ", slender-linear equations" if response.settings.linear else ""
        return [
            *body_lines(response.body, response.settings.gravity, self.length),
            ("motion", ground),
            ("restitution", f"{parameters.label}, {value}"),
            ("engine", f"{response.engine}{equations}"),
        ]

    def _measures(self) -> list[tuple[str, str]]:
        response, friction = self.response, self.problem.assumed_friction
        demand, error = response.contact.friction_demand, response.error_estimate
        peak = f"{math.degrees(response.peak_rotation):.6g} deg, {_over_alpha(response):.6g} of the slenderness angle"
        needed = "more than any surface has" if math.isinf(demand) else f"{demand:.3g}"
        doubt = (
            "another step changes the outcome: it hangs by a thread"
            if math.isinf(error)
            else f"{error:.1e} rad, the largest change of the rotation if every step is halved"
        )
        return [
            ("peak rotation", "it overturned" if response.outcome is Outcome.OVERTURNED else peak),
            ("energy closure", _CLOSURE.format(response.energy.closure)),
            ("friction", f"{needed} needed, {friction:g} {given_or_assumed(friction)}"),
            ("error estimate", doubt),
        ]


def _impact_row(k: int, row: Any) -> tuple[str, ...]:
    time, before, after, r, onto = row
    return str(k + 1), f"{time:.6f}", f"{before:+.6f}", f"{after:+.6f}", f"{r:.6f}", onto


def _model_row(name: str, response: Any) -> tuple[str, ...]:
    if isinstance(response, str):
        return name, "", "not for this body", "", "", ""
    left, right = response.parameters.left.coefficient, response.parameters.right.coefficient
    r = f"{right:.4f}" if left == right else f"{left:.3f}/{right:.3f}"
    size = f"{math.degrees(response.peak_rotation):.4g}", f"{_over_alpha(response):.4g}"
    if response.outcome is Outcome.OVERTURNED:
        outcome, size = f"overturned {'right' if response.trajectory.side > 0 else 'left'}", ("-", "-")
    elif response.outcome is Outcome.ROCKED:
        outcome = "still rocking" if response.still_rocking else "rocked"
    else:
        outcome = "no uplift"
    return name, r, outcome, *size, str(response.impacts.size)


def _over_alpha(response: Any) -> float:
    side = response.parameters.side(response.trajectory.peak_rotation)
    return float(response.peak_rotation / side.slenderness_angle)


@dataclass(frozen=True)
class ContactAnswer:
    """A response with rest, slide, rock, slide while rocking, flight."""

    problem: ResponseProblem
    response: Any
    length: str

    def draw(self) -> Any:
        """Return its picture."""
        from rocking.plots.regimes import regimes_picture

        return regimes_picture(self.response)

    def facts(self) -> dict[str, Any]:
        """Return everything as plain values."""
        from rocking.reports.response_facts import finite, moved_facts, still_rocking_facts

        response, law, energy = self.response, self.response.law, self.response.energy
        imposed = None if law.restitution is None else dict(zip(("left", "right"), law.restitution, strict=True))
        mode_keys = ("start_s", "end_s", "mode", "feet", "slip", "distance_m")
        impact_keys = (
            "time_s", "feet", "velocity_before_rad_s", "velocity_after_rad_s", "normal_left_N_s", "normal_right_N_s",
            "tangential_left_N_s", "tangential_right_N_s", "lost_J", "slips",
        )  # fmt: skip
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
            "modes": [dict(zip(mode_keys, row, strict=True)) for row in response.regimes.tolist()],
            "impacts": [dict(zip(impact_keys, row, strict=True)) for row in response.impacts.tolist()],
            "lost_in_impacts_J": float(energy.lost_in_impacts[-1]),
            "lost_in_friction_J": float(energy.lost_in_friction[-1]),
            "energy_closure": energy.closure,
        }

    def show(self, page: Page) -> None:
        """Write contact, outcome, modes, impacts and measures."""
        response, length = self.response, self.length
        page.facts(self._head())
        page.line()
        page.line(sentence(response.summary), "bold")
        head = ("from [s]", "to [s]", "mode", "feet", f"slid [{length}]")
        _some(page, response.regimes.tolist(), _FIRST, head, self._mode_row, ("mode", "feet"))
        names = ("impact [s]", "feet", "velocity before [rad/s]", "after [rad/s]", "lost [J]", "feet slide")
        _some(page, response.impacts.tolist(), _FIRST, names, _contact_impact_row, ("feet",))
        page.line()
        page.facts(self._measures(), 16)

    def _head(self) -> list[tuple[str, str]]:
        body, law = self.response.body, self.response.law
        imposed = COMPLEMENTARITY
        if law.restitution is not None:
            left, right = law.restitution
            imposed = f"r = {right:.6f}" if left == right else f"left r = {left:.6f}, right r = {right:.6f}"
        return [
            ("body", f"{type(body).__name__}, {body.mass:.4g} kg"),
            *(("density", each.removeprefix("density ")) for each in body.assumed),
            ("motion", _moved(self.response)),
            ("contact", f"friction {law.friction:g}, {given_or_assumed(law.friction)}; bounce {law.bounce:g}"),
            ("restitution", imposed),
        ]

    def _mode_row(self, _: int, row: Any) -> tuple[str, ...]:
        start, end, regime, feet, _slip, distance = row
        slid = f"{distance / LENGTH_UNITS[self.length]:+.6f}" if distance else ""
        return f"{start:.6f}", f"{end:.6f}", Regime[regime].value, feet, slid

    def _measures(self) -> list[tuple[str, str]]:
        response, energy, length = self.response, self.response.energy, self.length
        fell = response.outcome is Outcome.OVERTURNED
        at_the_end = in_unit(float(response.displacement[-1]), length, "+.6g")
        lost = energy.lost_in_impacts[-1], energy.lost_in_friction[-1]
        return [
            ("peak rotation", "it overturned" if fell else f"{math.degrees(response.peak_rotation):.6g} deg"),
            ("slid", f"{in_unit(response.sliding_distance, length, '.6g')} in all, {at_the_end} at the end"),
            ("friction used", f"{100.0 * response.friction_usage:.4g} % of what there is, at most"),
            ("energy lost", f"{lost[0]:.5g} J in impacts, {lost[1]:.5g} J in friction"),
            ("energy closure", _CLOSURE.format(energy.closure)),
        ]


def _contact_impact_row(_: int, row: Any) -> tuple[str, ...]:
    time, feet, before, after, *_impulses, lost, slips = row
    return f"{time:.6f}", feet, f"{before:+.6f}", f"{after:+.6f}", f"{lost:.4g}", "yes" if slips else ""


@dataclass(frozen=True)
class SpaceAnswer:
    """A response of a body in space."""

    problem: ResponseProblem
    response: Any
    length: str

    def draw(self) -> Any:
        """Return its picture."""
        from rocking.plots.spatial import spatial_picture

        return spatial_picture(self.response)

    def facts(self) -> dict[str, Any]:
        """Return everything as plain values."""
        from rocking.cli.solids import base_facts, body_facts
        from rocking.reports.response_facts import finite

        response, solid = self.response, self.problem.body
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
            "still_rocking": self._last_state(),
            "peak_tilt_rad": response.peak_tilt,
            "overturning_time_s": finite(response.overturning_time),
            "overturning_direction_rad": finite(response.overturning_direction),
            "overturned_over": response.overturned_over or None,
            "contacts": [
                {"start_s": start, "end_s": end, "contact": contact.name.lower(), "vertices": list(vertices)}
                for start, end, contact, vertices in response.intervals
            ],
            "impacts": [dict(zip(keys, row, strict=True)) for row in response.impacts.tolist()],
            "energy_closure": response.energy.closure,
        }

    def _last_state(self) -> dict[str, Any] | None:
        response = self.response
        if not response.still_rocking:
            return None
        last = response.at(response.end)
        return {
            "time_s": response.end,
            "quaternion": last.quaternion[0].tolist(),
            "angular_velocity_rad_s": last.angular_velocity[0].tolist(),
            "sentence": response.unfinished,
        }

    def show(self, page: Page) -> None:
        """Write body, motion, outcome, contacts, impacts and measures."""
        from rocking.cli.solids import show_body

        response = self.response
        show_body(page, self.problem.body, self.length)
        page.facts(((f"motion {a}", n) for a, n in zip(("x", "y", "vertical"), response.names, strict=True)), 16)
        page.facts([("restitution", response.law.label)], 16)
        page.line()
        page.line(sentence(response.summary), "bold")
        head = ("from [s]", "to [s]", "contact", "vertices")
        _some(page, response.intervals, _FIRST, head, _interval_row, ("contact", "vertices"))
        names = ("impact [s]", "energy before [J]", "after [J]", "impulse [N s]", "stays", "vertices")
        _some(page, response.impacts.tolist(), _FIRST, names, _space_impact_row, ("stays", "vertices"))
        page.line()
        fell = response.outcome is Outcome.OVERTURNED
        peak = "it overturned" if fell else f"{math.degrees(response.peak_tilt):.6g} deg"
        page.facts([("peak tilt", peak), ("energy closure", _CLOSURE.format(response.energy.closure))], 16)


def _interval_row(_: int, row: Any) -> tuple[str, ...]:
    start, end, contact, vertices = row
    return f"{start:.6f}", f"{end:.6f}", contact.value, "-".join(map(str, vertices))


def _space_impact_row(_: int, row: Any) -> tuple[str, ...]:
    time, before, after, impulse, _pull, contact, vertices = row
    return f"{time:.6f}", f"{before:.5g}", f"{after:.5g}", f"{impulse:.5g}", contact, vertices
