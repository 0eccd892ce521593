"""What `rocking simulate` shows of each mechanics: pure rocking, sliding and hopping, a body in space."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rocking.bodies.body import assumed_rows
from rocking.cli.numbers import in_unit
from rocking.cli.page import Page, sentence
from rocking.conventions import LENGTH_UNITS, Assumed, given_or_assumed
from rocking.dynamics import SpatialStart
from rocking.errors import InvalidValueError, RockingError
from rocking.motions.summary import MotionSummary
from rocking.outcome import Outcome, Regime
from rocking.spec.construction import COMPLEMENTARITY
from rocking.spec.response import ResponseProblem

_FIRST_IMPACTS = 10  # impacts of pure rocking that are printed
_FIRST = 12  # contacts, modes and impacts of the others that are printed
_IN_PYTHON = "simulate(body, motion, friction=...)"
_CLOSURE = "{:.1e} of the largest energy"


def answer_of(problem: ResponseProblem, length: str, acceleration: str, *, listed: bool) -> Any:
    """Return what a problem has for an answer."""
    # length, acceleration: units in which it is printed; listed: whether the restitutions beside the first are those
    # that the problem lists, in place of every model that needs no value
    response = problem.answer()
    if response.outcome is Outcome.FAILED:
        raise RockingError(f"there is no response: {response.status.value}")
    if not problem.mechanics.is_compared:
        kinds: dict[str, Any] = {"space": SpaceAnswer, "hull": HullAnswer, "contact": ContactAnswer}
        return kinds[problem.mechanics.name](problem, response, length)
    rivals = dict(list(problem.restitutions.items())[1:])
    if not listed:
        from rocking.evidence._coefficient_table import default_models

        rivals = {model.label: model for model in default_models() if model.label != response.parameters.label}
    others: dict[str, Any] = {}
    for name, law in rivals.items():
        try:
            others[name] = problem.answer(law)
        except InvalidValueError as error:
            others[name] = str(error)
    return RockingAnswer(problem, response, others, length, acceleration)


def _moved(response: Any) -> str:
    if response.motion is None:
        return f"none; let go at {math.degrees(float(response.rotation[0])):.4g} deg"
    return f"{'' if response.scale == 1.0 else f'{response.scale:g} times '}{response.motion.name}"


def _start_lines(problem: ResponseProblem, length: str) -> list[tuple[str, str]]:
    """Return the initial height and velocity of a body that does not start at rest on the ground."""
    velocity = ", ".join(f"{value:g}" for value in problem.start_velocity)
    height = in_unit(problem.start_height, length, ".4g")
    lines = [("start", f"lowest point {height} above the ground")] if problem.start_height else []
    return [*lines, *([("start", f"lowest point at ({velocity}) m/s")] if any(problem.start_velocity) else [])]


def _drop_facts(problem: ResponseProblem) -> dict[str, Any]:
    """Return the initial height and velocity, of a body that does not start at rest on the ground."""
    velocity = list(problem.start_velocity) or [0.0] * len(problem.axes)
    return {"start_height_m": problem.start_height, "start_velocity_m_s": velocity} if problem.dropped else {}


def _sources(*motions: Any) -> list[tuple[str, str]]:
    """Return what is printed of the source and the processing of the components of a motion."""
    from rocking.cli.study import source_lines

    return source_lines([MotionSummary.of(motion) for motion in motions if motion is not None])


def _components(response: Any) -> dict[str, Any]:
    """Return the motions along x, y and upwards as plain values."""
    return {
        axis: None if motion is None else MotionSummary.of(motion).as_dict()
        for axis, motion in zip(("x", "y", "vertical"), response.components, strict=True)
    }


def _first(page: Page, columns: dict[str, str], rows: Sequence[Sequence[Any]], most: int = _FIRST) -> None:
    """Write the first rows of a table, and how many more there are; columns: formats by their heads, none of text."""
    if not rows:
        return
    page.line()
    cells = [[f"{value:{how}}" for value, how in zip(row, columns.values(), strict=True)] for row in rows[:most]]
    page.table(list(columns), cells, [name for name, how in columns.items() if not how], dense=True)
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
        from rocking.plots.response import response_picture

        return response_picture(self.response, self.problem.assumed_friction)

    def facts(self) -> dict[str, Any]:
        from rocking.reports.response_facts import other_facts, response_facts

        facts = response_facts(self.response, self.problem.assumed_friction)
        facts["other_models"] = {name: other_facts(other) for name, other in self.others.items()}
        return facts

    def show(self, page: Page) -> None:
        from rocking.reports.response_facts import ModelAgreement

        response = self.response
        page.facts(self._head())
        page.line()
        page.line(sentence(response.summary), "bold")
        impacts = [(k, *row) for k, row in enumerate(response.impacts.tolist(), start=1)]
        speeds = {"velocity before [rad/s]": "+.6f", "after [rad/s]": "+.6f"}
        _first(page, {"impact": "d", "time [s]": ".6f", **speeds, "r": ".6f", "onto": ""}, impacts, _FIRST_IMPACTS)
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
            *body_lines(response.body, response.settings, self.length),
            ("motion", ground),
            *_sources(motion),
            (
                "restitution",
                parameters.label if hasattr(parameters.law, "quantile") else f"{parameters.label}, {value}",
            ),
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
        from rocking.plots.regimes import regimes_picture

        return regimes_picture(self.response)

    def facts(self) -> dict[str, Any]:
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
            **_drop_facts(self.problem),
            "friction": law.friction,
            "friction_assumed": isinstance(law.friction, Assumed),
            "bounce": law.bounce,
            "bounce_law": law.bounce_law,
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
        response, length = self.response, self.length
        page.facts(self._head())
        page.line()
        page.line(sentence(response.summary), "bold")
        modes = [
            (start, end, Regime[mode].value, feet, f"{slid / LENGTH_UNITS[length]:+.6f}" if slid else "")
            for start, end, mode, feet, _, slid in response.regimes.tolist()
        ]
        _first(page, {"from [s]": ".6f", "to [s]": ".6f", "mode": "", "feet": "", f"slid [{length}]": "s"}, modes)
        impacts = [(*row[:4], lost, "yes" if slips else "") for *row, lost, slips in response.impacts.tolist()]
        speeds = {"velocity before [rad/s]": "+.6f", "after [rad/s]": "+.6f"}
        _first(page, {"impact [s]": ".6f", "feet": "", **speeds, "lost [J]": ".4g", "feet slide": "s"}, impacts)
        page.line()
        page.facts(self._measures(), 16)

    def _head(self) -> list[tuple[str, str]]:
        body, law = self.response.body, self.response.law
        imposed = COMPLEMENTARITY
        if law.restitution is not None:
            left, right = law.restitution
            imposed = f"r = {right:.6f}" if left == right else f"left r = {left:.6f}, right r = {right:.6f}"
        of_law = "" if law.bounce_law == "newton" else f" ({law.bounce_law})"
        return [
            ("body", f"{type(body).__name__}, {body.mass:.4g} kg"),
            *assumed_rows(body),
            ("motion", _moved(self.response)),
            *_start_lines(self.problem, self.length),
            *_sources(self.response.motion),
            ("contact", f"friction {law.friction:g}, {given_or_assumed(law.friction)}; bounce {law.bounce:g}{of_law}"),
            ("restitution", imposed),
        ]

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


@dataclass(frozen=True)
class SpaceAnswer:
    """A response of a body in space."""

    problem: ResponseProblem
    response: Any
    length: str

    def draw(self) -> Any:
        from rocking.plots.spatial import spatial_picture

        return spatial_picture(self.response)

    def facts(self) -> dict[str, Any]:
        from rocking.cli.solids import base_facts, body_facts
        from rocking.reports.response_facts import finite

        response, solid = self.response, self.problem.body
        keys = ("time_s", "energy_before_J", "energy_after_J", "impulse_N_s", "pull_N_s", "contact", "vertices")
        return {
            "body": body_facts(solid),
            "base": base_facts(solid.base),
            "repairs": list(solid.repairs),
            "motion": dict(zip(("x", "y", "vertical"), response.names, strict=True)),
            "motions": _components(response),
            **self._start_facts(),
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

    def _start_facts(self) -> dict[str, Any]:
        """Return the initial tilt of free rocking, and its direction; of a body that drops, height and velocity."""
        facts, start = _drop_facts(self.problem), self.problem.start
        if self.problem.free is None or not isinstance(start, SpatialStart):
            return facts
        return {"initial_tilt_rad": start.tilt, "initial_azimuth_rad": start.azimuth, **facts}

    def _motion_lines(self) -> list[tuple[str, str]]:
        problem = self.problem
        start = _start_lines(problem, self.length)
        if problem.motion is not None:
            names = zip(("x", "y", "vertical"), self.response.names, strict=True)
            return [*((f"motion {axis}", name) for axis, name in names), *start]
        if problem.free is None:
            return [("motion", "none"), *start]
        tilt, balance = math.degrees(abs(problem.rotation)), math.degrees(problem.balance_angle)
        way = "x" if problem.rotation >= 0.0 else "-x"
        words = f"none; released at {tilt:.4g} deg towards {way}, where {balance:.4g} deg is the balance"
        return [("motion", words), *start]

    def _last_state(self) -> dict[str, Any] | None:
        response = self.response
        if not response.still_rocking:
            return None
        last = response.at(response.end)
        return {
            "time_s": response.end,
            "quaternion": last.quaternion[0].tolist(),
            "angular_velocity_rad_s": last.angular_velocity[0].tolist(),
            "ends_early": response.ends_early,
            "sentence": response.unfinished,
        }

    def show(self, page: Page) -> None:
        from rocking.cli.solids import show_body

        response = self.response
        show_body(page, self.problem.body, self.length)
        page.facts(self._motion_lines(), 16)
        page.facts(_sources(*response.components), 16)
        page.facts([("restitution", response.law.label)], 16)
        page.line()
        page.line(sentence(response.summary), "bold")
        contacts = [
            (*times, contact.value, "-".join(map(str, points))) for *times, contact, points in response.intervals
        ]
        _first(page, {"from [s]": ".6f", "to [s]": ".6f", "contact": "", "vertices": ""}, contacts)
        impacts = [(*row[:4], *row[5:]) for row in response.impacts.tolist()]
        sizes = {"energy before [J]": ".5g", "after [J]": ".5g", "impulse [N s]": ".5g"}
        _first(page, {"impact [s]": ".6f", **sizes, "stays": "", "vertices": ""}, impacts)
        page.line()
        fell = response.outcome is Outcome.OVERTURNED
        peak = "it overturned" if fell else f"{math.degrees(response.peak_tilt):.6g} deg"
        page.facts([("peak tilt", peak), ("energy closure", _CLOSURE.format(response.energy.closure))], 16)


@dataclass(frozen=True)
class HullAnswer(SpaceAnswer):
    """A response of a body in space with friction."""

    def facts(self) -> dict[str, Any]:
        from rocking.cli.solids import base_facts, body_facts
        from rocking.reports.response_facts import finite

        response, solid = self.response, self.problem.body
        keys = ("time_s", "energy_before_J", "energy_after_J", "vertices")
        return {
            "body": body_facts(solid),
            "base": base_facts(solid.base),
            "repairs": list(solid.repairs),
            "motion": dict(zip(("x", "y", "vertical"), response.names, strict=True)),
            "motions": _components(response),
            **self._start_facts(),
            "restitution": response.restitution,
            "friction": response.settings.friction,
            "engine": response.engine,
            "gravity_m_s2": response.settings.gravity,
            "outcome": response.outcome.name.lower(),
            "summary": response.summary,
            "still_rocking": response.still_rocking,
            "peak_tilt_rad": response.peak_tilt,
            "sliding_distance_m": response.sliding_distance,
            "pose": response.pose,
            "overturning_time_s": finite(response.overturning_time),
            "overturning_direction_rad": finite(response.overturning_direction),
            "contacts": [
                {"start_s": start, "end_s": end, "vertices": list(touching), "sliding": list(sliding)}
                for start, end, touching, sliding in response.intervals
            ],
            "impacts": [dict(zip(keys, row, strict=True)) for row in response.impacts.tolist()],
            "lost_in_impacts_J": response.trajectory.lost,
        }

    def show(self, page: Page) -> None:
        from rocking.cli.solids import show_body

        response = self.response
        show_body(page, self.problem.body, self.length)
        page.facts(self._motion_lines(), 16)
        page.facts(_sources(*response.components), 16)
        page.facts([("restitution", response.restitution), ("friction", f"{response.settings.friction:g}")], 16)
        page.line()
        page.line(sentence(response.summary), "bold")
        contacts = [
            (start, end, "-".join(map(str, touching)) or "none: in flight", "-".join(map(str, sliding)))
            for start, end, touching, sliding in response.intervals
        ]
        _first(page, {"from [s]": ".6f", "to [s]": ".6f", "vertices": "", "sliding": ""}, contacts)
        sizes = {"energy before [J]": ".5g", "after [J]": ".5g"}
        _first(page, {"impact [s]": ".6f", **sizes, "vertices": ""}, response.impacts.tolist())
        page.line()
        slid, lost = in_unit(response.sliding_distance, self.length, ".6g"), response.trajectory.lost
        peak = f"{math.degrees(response.peak_tilt):.6g} deg from the pose at the start"
        page.facts([("peak tilt", peak), ("slid", slid), ("energy lost", f"{lost:.5g} J in impacts")], 16)
