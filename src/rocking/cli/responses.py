"""Output of `rocking simulate`: body and motion, outcome, peaks, and the outcome with other models."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from rocking.answers import Answer, Display
from rocking.bodies import PLANE_BODIES
from rocking.bodies.frame import is_frame
from rocking.cli.compared import by_foot, grouped, spanned
from rocking.cli.page import Page, sentence
from rocking.conventions import COMPARED_RESTITUTIONS, DEFAULT_RESTITUTION, given_or_assumed
from rocking.dynamics import SpatialStart
from rocking.dynamics.mechanics import restitution_label
from rocking.errors import RockingError
from rocking.messages import Message
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.summary import MotionSummary, peak_name
from rocking.outcome import Outcome
from rocking.restitution import models
from rocking.restitution.headline import headline
from rocking.spec.construction import COMPLEMENTARITY
from rocking.spec.response import ResponseProblem

_PEAKS = (
    "peak_rotation", "peak_ratio", "peak_tilt", "sliding_distance", "residual_displacement", "friction_usage",
    "error_estimate", "residual_rotation", "uplift_height", "largest_base_shear", "largest_overturning_moment",
    "lost_contact_time", "largest_base_displacement", "residual_base_displacement",
)  # fmt: skip
_NOT_ANIMATED = {"restraints", "joints", "largest_base_displacement"}  # results of responses without animation
_RESTRAINTS = (
    "restraint", "largest_force", "smallest_force", "largest_elongation", "yield_count", "is_broken", "residual_force",
    "dissipated_energy",
)  # fmt: skip
_JOINTS = (
    "joint", "joint_state", "peak_opening", "peak_joint_displacement", "residual_joint_displacement", "friction_demand",
    "impacts",
)  # fmt: skip
_DETAILS = (
    "gravity", "friction_of_motion", "friction_of_impacts", "least_force", "energy_lost", "lost_in_friction",
    "lost_in_joints", "lost_in_isolators", "energy_closure", "engine", "growth_rate", "growth_time", "relative_change",
)  # fmt: skip
_OF_STANDING = {"peak_rotation", "peak_ratio", "peak_tilt"}
_TABLES = {
    "intervals": (
        "Contacts", ("start", "end", "regime", "contact", "feet", "vertices", "sliding_vertices", "distance"),
    ),
    "impacts": (
        "Impacts",
        (
            "time", "feet", "velocity_before", "velocity_after", "coefficient", "foot", "energy_before",
            "energy_after", "impulse", "contact", "vertices", "energy_lost", "slips", "base_velocity_before",
            "base_velocity_after",
        ),
    ),
    "joint_events": (
        "Events of joints",
        ("time", "joint", "joint_event", "corners_before", "corners_after", "opening", "velocity_before",
         "velocity_after"),
    ),
    "restraint_events": (
        "Events of restraints",
        ("time", "restraint", "restraint_phase", "rotation", "elongation", "restraint_force"),
    ),
}  # fmt: skip
_COMPARED = ("model", "coefficient", "outcome", "peak_ratio", "impacts")
_NAMED = (DEFAULT_RESTITUTION, *COMPARED_RESTITUTIONS)
_AGREE, _DIFFER = "All models have the same outcome.", "The outcome depends on the restitution model."
_IN_PYTHON = "simulate(body, motion, friction=...)"


def answer_of(
    problem: ResponseProblem, display: Display, *, listed: bool, is_stated: bool, details: bool
) -> "ResponseAnswer":
    """Return the response to a problem, and the responses of other models: listed models, or the default comparison.

    `is_stated` is True if the input states the restitution.
    """
    response = problem.answer()
    if response.outcome is Outcome.FAILED:
        raise RockingError("there is no response: {reason}", reason=response.status.value)
    models = dict(list(problem.restitutions.items())[1:])
    if not problem.mechanics.has_restitution:
        models = {}
    elif not problem.mechanics.is_compared:
        is_default = next(iter(problem.restitutions)) == DEFAULT_RESTITUTION
        models = {restitution_label(name, problem.body): name for name in COMPARED_RESTITUTIONS if is_default}
    elif not listed and not is_frame(problem.body):
        from rocking.evidence._coefficient_table import default_models

        models = {model.label: model for model in default_models() if model.label != response.parameters.label}
    others: dict[str, Any] = {}
    for name, law in models.items():
        try:
            others[name] = problem.answer(law)
        except RockingError as error:
            others[name] = str(error)
    return ResponseAnswer(problem, response, display, others, is_stated=is_stated, details=details)


@dataclass(frozen=True)
class ResponseAnswer:
    """A response of any mechanics, and the responses of other models to the same problem."""

    problem: ResponseProblem
    response: Any
    display: Display
    others: dict[str, Any] = field(default_factory=dict)  # response of each model, or the reason for its absence
    is_stated: bool = False  # True if the input states the restitution
    details: bool = False  # True to show every impact and model
    name: str = ""  # name of the body

    @property
    def _friction(self) -> dict[str, float]:
        return {"friction": self.problem.assumed_friction} if self.problem.mechanics.is_compared else {}

    def draw(self) -> Any:
        return self.response.plot(**self._friction)

    def answer(self) -> Answer:
        """Return the response, with the body and the initial conditions."""
        problem, start = self.problem, self.problem.start
        more: dict[str, Any] = {}
        if not isinstance(problem.body, PLANE_BODIES):
            more["body"] = problem.body.answer()
            if isinstance(start, SpatialStart) and problem.initial_rotation is not None:
                more |= {"initial_tilt": start.tilt, "initial_azimuth": start.azimuth}
        if problem.dropped:
            still = [0.0] * len(problem.axes)
            more |= {"start_height": problem.start_height, "start_velocity": list(problem.start_velocity) or still}
        answer: Answer = self.response.answer(**self._friction)
        if self.details and self.problem.mechanics.is_compared:
            more |= self.response.tangent().answer().values
        others = self.others.items()
        more["other_models"] = {
            name: {"error": response} if isinstance(response, str) else _facts(response) for name, response in others
        }
        if problem.mechanics.has_restitution:
            more["headline"] = headline(answer["restitution"], is_stated=self.is_stated)
        return answer | more

    def show(self, page: Page) -> None:
        from rocking.cli.numbers import body_line

        answer, display = self.answer(), self.display
        page.line(f"{body_line(self.problem.body, answer['body'], display)}; {self._moved(answer)}")
        kind = "Restitution" if self.problem.mechanics.has_restitution else "Normal restitution of the joints"
        page.line(f"{kind}: {self._restitution(answer)}")
        if slope := answer["body"].values.get("floor_slope"):
            page.line(f"Floor: slope {display.text('floor_slope', slope)}")
        if "friction" in answer and not self.problem.mechanics.is_compared:
            page.line(f"Contact: {', '.join(self._contact(answer))}")
        page.line()
        page.line(sentence(answer["summary"]), "bold")
        overturned = answer["outcome"] == "overturned"
        peaks = [name for name in _PEAKS if not (overturned and name in _OF_STANDING)]
        lines = list(display.lines(answer.values, peaks))
        if "friction_demand" in answer:
            demand, friction = display.cell("friction_demand", answer["friction_demand"]), answer["friction"]
            lines.append(("friction demand", f"{demand} ({given_or_assumed(friction)} {friction:g})"))
        page.values([*lines, *(display.lines(answer.values, _DETAILS) if self.details else ())])
        if "restraints" in answer:
            page.line("\nRestraints", "bold")
            page.rows(answer["restraints"], _RESTRAINTS, display)
        if "joints" in answer:
            page.line("\nJoints", "bold")
            page.rows(answer["joints"], _JOINTS, display)
        page.warn(doubt.replace(_IN_PYTHON, "--friction") for doubt in answer.values.get("warnings", ()))
        if self.problem.mechanics.is_compared and self.others:
            self._compare(page)
        else:
            self._compare_outcomes(page, answer)
        page.line(answer.values.get("headline", ""))
        self._show_tables(page, answer)
        page.line()
        for assumed in answer["body"]["assumed"]:
            page.line(sentence(assumed))
        page.facts(_sources(self._components.values()) if self.details else (), 8)
        page.warn(answer["body"].values.get("repairs", ()))
        if not self.details:
            is_animated = not _NOT_ANIMATED & answer.values.keys()
            film = "animation.html" if is_animated else "picture.png"
            page.line(f"Impacts, energy, sources: --details    Files: -o rows.csv, -o {film}, -o report=report.pdf")

    def _show_tables(self, page: Page, answer: Answer) -> None:
        for name, (title, columns) in _TABLES.items() if self.details else ():
            if name in answer and len(answer[name]):
                page.line(f"\n{title}", "bold")
                page.rows(answer[name], columns, self.display)

    def _moved(self, answer: Answer) -> str:
        motions = answer["motions"] if "motions" in answer else {"": answer["motion"]}
        moved = {axis: motion for axis, motion in self._components.items() if motion is not None}
        parts = [_motion_words(axis, motion, motions[axis], self.display) for axis, motion in moved.items()]
        if not parts and self.problem.initial_rotation is not None:
            angle, name = self.problem.rotation, "initial_rotation"
            balance = self.display.text("slenderness_angle", self.problem.balance_angle)
            return f"released at {self.display.text(name, angle)}, {self.problem.initial_rotation:g} of {balance}"
        text = ", ".join(parts) or "ground at rest"
        if self.problem.start_height:
            text += f", released {self.display.text('start_height', self.problem.start_height)} above the ground"
        if any(self.problem.start_velocity):
            text += f", initial velocity ({', '.join(f'{velocity:g}' for velocity in self.problem.start_velocity)}) m/s"
        return text

    @property
    def _components(self) -> dict[str, Any]:
        """Motions by their axis; a plane body has one motion and no name of an axis."""
        if hasattr(self.response, "components"):
            return dict(zip("xyz", self.response.components, strict=True))
        return {"": self.response.motion}

    def _restitution(self, answer: Answer) -> str:
        label = answer.values.get("restitution", "")
        if "coefficient" not in answer:
            return str(label)
        if answer["coefficient"] is None:
            return COMPLEMENTARITY
        if self.problem.mechanics.is_compared and hasattr(self.response.parameters.law, "quantile"):
            return str(label)
        r = self._coefficient_words(answer["coefficient"])
        linear = ", slender-linear equations" if answer.values.get("linear") else ""
        return f"{label}{', ' if label else ''}r = {r}{linear}"

    def _coefficient_words(self, coefficient: dict[str, float]) -> str:
        left, right = (self.display.cell("coefficient", coefficient[foot]) for foot in ("left", "right"))
        return right if coefficient["left"] == coefficient["right"] else f"{left} left, {right} right"

    def _contact(self, answer: Answer) -> list[str]:
        bounces = answer.values.get("normal_restitution")
        names = ("friction", *(("normal_restitution", "normal_restitution_law") if bounces else ()))
        return [f"{name} {text}" for name, text in self.display.lines(answer.values, names)]

    def _compare(self, page: Page) -> None:
        from rocking.reports.response_facts import ModelAgreement

        responses = {self.response.parameters.label: self.response, **self.others}
        outcomes = {label: _outcome(response) for label, response in responses.items()}
        shown = outcomes.keys() if self.details else {self.response.parameters.label, *_NAMED}
        rows = [
            self._compared(labels, outcomes[labels[0]], [responses[label] for label in labels])
            for labels in grouped(outcomes, shown)
        ]
        page.line("\nCompare restitution models", "bold")
        head = [self.display.heading(name) for name in _COMPARED]
        page.table(head, rows, ("model", "outcome"), bold={0}, dense=True)
        page.warn(f"{name}: {other}" for name, other in self.others.items() if isinstance(other, str))
        computed = {name: response for name, response in responses.items() if not isinstance(response, str)}
        agreement = ModelAgreement.of(computed)
        if self.details or not agreement.models_differ:
            page.line(agreement.sentence)
            return
        count = sum(response.outcome is Outcome.OVERTURNED for response in computed.values())
        is_model = self.response.parameters.label.partition(":")[0] in models()
        cases = f"{count} of {len(computed)} {'models' if is_model else 'restitution cases'}"
        page.line(f"The result depends on the restitution model: overturning with {cases}.")
        for doubt in agreement.doubts:
            page.line(doubt)

    def _compare_outcomes(self, page: Page, answer: Answer) -> None:
        """Write the outcome with each model."""
        models = answer["other_models"]
        computed = {name: row for name, row in models.items() if "error" not in row}
        if computed:
            rows = {answer["restitution"]: _facts(self.response), **computed}
            page.line("\nCompare restitution models", "bold")
            page.rows([{"model": name, **row.values} for name, row in rows.items()], (), self.display)
            differ = len({row["outcome"] for row in rows.values()}) > 1
            page.line(Message(_DIFFER if differ else _AGREE))
        page.warn(f"{name}: {row['error']}" for name, row in models.items() if "error" in row)

    def _compared(self, labels: list[str], outcome: str, responses: list[Any]) -> tuple[str, ...]:
        """Return the row of models with one outcome, with the ranges of their values."""
        label = labels[0] if len(labels) == 1 else f"{len(labels)} other models"
        answers = [response.outcome_answer() for response in responses if not isinstance(response, str)]
        if not answers:
            return label, "-", outcome, "-", "-"
        overturned = answers[0]["outcome"] == "overturned"
        r = by_foot(self.display, *([row["coefficient"][foot] for row in answers] for foot in ("left", "right")))
        ratio, impacts = (spanned(self.display, name, [row[name] for row in answers]) for name in _COMPARED[-2:])
        return label, r, outcome, "-" if overturned else ratio, impacts


def _outcome(response: Any) -> str:
    """Return the outcome of a response for the comparison of models, as text."""
    if isinstance(response, str):
        return "not for this body"
    answer = response.outcome_answer()
    if answer["outcome"] == "overturned":
        return f"overturned {answer['side']}"
    return "still rocking" if answer["still_rocking"] else str(answer["outcome"]).replace("_", " ")


def _facts(response: Any) -> Answer:
    """Return the outcome of a response for the comparison of models."""
    if hasattr(response, "outcome_answer"):
        answer: Answer = response.outcome_answer()
        return answer
    peak = "peak_tilt" if hasattr(response, "peak_tilt") else "peak_rotation"
    facts = {"outcome": response.outcome.name.lower(), peak: getattr(response, peak), "impacts": len(response.impacts)}
    return Answer({**facts, "still_rocking": response.still_rocking})


def _motion_words(axis: str, motion: Any, answer: Answer, display: Display) -> str:
    pulse = isinstance(motion, Pulse)
    name = motion.named(strength=False) if pulse else f"{motion.name}, {display.text('duration', motion.duration)}"
    scale = "" if answer["scale"] == 1.0 else f"{answer['scale']:g} times "
    peak = display.text("peak_ground_acceleration", answer["peak_ground_acceleration"])
    return f"{f'{axis}: ' if axis else ''}{scale}{name}, {peak_name(answer['support'])} {peak}"


def _sources(motions: Iterable[Any]) -> list[tuple[str, str]]:
    """Return the printed lines of source and processing of record files."""
    from rocking.cli.study import source_lines

    return source_lines([MotionSummary.of(motion) for motion in motions if isinstance(motion, GroundMotion)])
