"""`rocking overturning-pga`: all intervals of PGA in which a body overturns under a motion."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.answers import Answer, AnswerRows, Display
from rocking.cli import options
from rocking.cli.compared import model_facts, show_models, with_models
from rocking.cli.exports import DRAWN, Export, Exports, write_records
from rocking.cli.help import HOW
from rocking.cli.numbers import beside_g
from rocking.cli.page import MOST_ROWS, Page, bar, deliver, sentence
from rocking.conventions import g, percent
from rocking.dynamics.mechanics import restitution_label
from rocking.messages import Message
from rocking.quantities import closely
from rocking.spec.construction import COMPLEMENTARITY
from rocking.spec.questions.minimum import MinimumTable

if TYPE_CHECKING:
    from pathlib import Path

    from rocking.spec.study import StudyProblem
    from rocking.studies.minimum_acceleration import Transitions

_SPOKEN = 4  # largest number of overturning intervals in a sentence
_MOST = 8  # largest number of printed crossings
_SHOWN = ("peak_ground_acceleration", "uplift_ratio", "mode_below", "mode_above")
_CLOSELY = closely(peak_ground_acceleration=".6f", uplift_acceleration=".6g")


def _crossings(transitions: "Transitions") -> AnswerRows:
    """Return the accelerations at which the outcome changes, and the modes below and above."""
    below, above = (modes.tolist() for modes in transitions.modes.T)
    columns = {
        "peak_ground_acceleration": transitions.acceleration, "uplift_ratio": transitions.ratio,
        "scale": transitions.scale, "bracket_width": transitions.width,
    }  # fmt: skip
    return AnswerRows(
        {name: values.tolist() for name, values in columns.items()} | {"mode_below": below, "mode_above": above}
    )


def _write_csv(answer: "MinimumAnswer", path: "Path") -> None:
    write_records(path, _crossings(answer.transitions).records)


EXPORTS = {"picture": DRAWN, "csv": Export((".csv",), _write_csv)}


@options.takes(
    options.keys(MinimumTable, min_pga=": 0.1g, 1m/s2", max_pga=": 5g"),
    options.keys(MinimumTable, "samples", "bisections", panel=HOW),
    options.SIZES,
)
def overturning_pga(
    context: typer.Context,
    body: options.BodyFile = None,
    record: options.Record = None,
    motion: options.Motion = None,
    restitution: options.Restitution = None,
    sets: options.Set = None,
    friction: options.Friction = None,
    threads: options.Threads = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking overturning-pga`."""
    from rocking.cli.arguments import Arguments
    from rocking.cli.study import TABLES, body_and_motion, problem_in

    exports = Exports.of(output, EXPORTS)
    length: str | None = None
    acceleration: str | None = None
    if (problem := problem_in(context, body, "minimum")) is None:
        arguments = Arguments(context, *TABLES, "minimum")
        length, acceleration = arguments.length, arguments.acceleration
        table = arguments.table("minimum", arguments.values(MinimumTable))
        problem = body_and_motion(arguments, "minimum-acceleration", table, restitution and [restitution])
    with bar("histories", quiet=as_json) as progress:
        transitions, others = with_models(lambda study: study.answer(progress, threads), problem)
    answer = MinimumAnswer(problem, transitions, length or "m", acceleration or "m/s2", others, details)
    deliver(answer, exports, as_json=as_json)


@dataclass(frozen=True)
class MinimumAnswer:
    """All accelerations at which the outcome of a body changes under a motion."""

    problem: "StudyProblem"
    transitions: "Transitions"
    length: str  # units of lengths and of accelerations
    acceleration: str
    others: dict[str, Any]  # results of the compared models
    details: bool = False

    def draw(self) -> Any:
        from rocking.plots.transitions import transitions_picture

        problem = self.problem
        subject = (problem.bodies[0], problem.motions[0], problem.restitution)
        return transitions_picture(self.transitions, *subject, **problem.stated)

    @property
    def label(self) -> str:
        model = self.problem.restitution
        name = COMPLEMENTARITY if model is None else str(getattr(model, "label", model))
        return restitution_label(name, self.problem.bodies[0])

    def answer(self) -> Answer:
        """Return every crossing, and the intervals between them."""
        from rocking.cli.study import subject_values

        transitions, problem = self.transitions, self.problem
        return Answer({
            **subject_values(problem),
            "restitution": self.label,
            "gravity": problem.settings.gravity,
            "linear": problem.settings.linear,
            "crossings": _crossings(transitions),
            "minimum_acceleration": transitions.minimum,
            "certain_acceleration": transitions.certain,
            "overturning_intervals": transitions.overturning_intervals,
            "safe_intervals": transitions.safe_intervals,
            "min_pga": transitions.min_pga,
            "max_pga": transitions.max_pga,
            "uplift_acceleration": transitions.uplift_acceleration,
            "resolution": transitions.resolution,
            "resolution_below": transitions.resolution_below if transitions.minimum is not None else None,
            "starts_overturned": transitions.starts_overturned,
            "samples": transitions.samples,
            "failed": transitions.failed,
            "contact": transitions.contact,
            "sentence": stretches(transitions),
            **model_facts(self.label, self.others, _of_model, problem.bodies[0]),
        }, _CLOSELY)  # fmt: skip

    def show(self, page: Page) -> None:
        from rocking.cli.study import show_assumed, show_subject

        problem, transitions, answer = self.problem, self.transitions, self.answer()
        display = Display(self.length, beside_g(self.acceleration), own=answer.quantities)
        show_subject(page, problem, display, f"{problem.motions[0].name}, scaled")
        page.line(f"Restitution: {answer['restitution']}")
        page.line()
        lowest = answer["minimum_acceleration"]
        if lowest is not None and (peak := problem.motions[0].peak) > 0.0:
            text = display.text("minimum_acceleration", lowest)
            page.line(f"Overturning from {text}, {lowest / peak:.4g} x motion.", "bold")
        page.line(sentence(answer["sentence"]), "bold")
        uplift, sliding = answer["uplift_acceleration"], problem.settings.friction * problem.settings.gravity
        name = "uplift" if uplift < sliding else "sliding"
        page.values([(name, f"from {display.text('uplift_acceleration', min(uplift, sliding))}")])
        if transitions.failed:
            page.warn([f"{transitions.failed} of {transitions.samples} histories could not be computed"])
        page.warn(filter(None, [transitions.contact]))
        if len(transitions) > 1 or self.details:
            page.line()
            page.rows(answer["crossings"], _SHOWN, display, most=MOST_ROWS if self.details else _MOST)
        show_models(page, answer, display, self.label, _of_model(transitions))
        show_assumed(page, problem, details=self.details)
        if not self.details:
            page.line("Source and all crossings: --details    Files: -o crossings.csv, -o crossings.png")


def _of_model(transitions: "Transitions") -> dict[str, Any]:
    return {"minimum_acceleration": transitions.minimum}


_SCANNED = "scanned from {low} to {high}, resolution {resolution}"
_SCANNED_FINER = (
    "scanned from {low} to {high}, resolution {resolution} ({below} below the first crossing); smaller intervals may "
    "exist"
)


def stretches(transitions: "Transitions") -> str:
    """Return the overturning intervals as text; for many intervals, only the first and the last."""
    intervals = transitions.overturning_intervals
    facts = {
        "low": _g(transitions.min_pga), "high": _g(transitions.max_pga), "resolution": percent(transitions.resolution),
        "below": percent(transitions.resolution_below),
    }  # fmt: skip
    finer = transitions.minimum is not None and transitions.resolution_below < 0.5 * transitions.resolution
    scanned = Message(_SCANNED_FINER if finer else _SCANNED, facts)
    if not intervals:
        return Message.followed(Message("does not overturn"), scanned)
    if intervals == ((transitions.min_pga, transitions.max_pga),):
        return Message.followed(Message("overturns at every acceleration"), scanned)
    texts = [_interval(transitions, intervals, k) for k in range(len(intervals))]
    if len(texts) > _SPOKEN:
        left_out = len(texts) - _SPOKEN
        texts = [*texts[: _SPOKEN - 1], Message("{count} more intervals", {"count": left_out}), texts[-1]]
    first = texts[0]
    for text in texts[1:]:
        first = Message("{first}, {second}", {"first": first, "second": text})
    return Message.followed(first, scanned)


def _interval(transitions: "Transitions", intervals: tuple[tuple[float, float], ...], k: int) -> str:
    """Return the text of an interval of overturning; the first text has a verb."""
    low, high = intervals[k]
    facts = {"low": _g(low), "high": _g(high)}
    if k == len(intervals) - 1 and high == transitions.max_pga:
        return Message("above {low}", facts) if k else Message("overturns above {low}", facts)
    return Message("from {low} to {high}", facts) if k else Message("overturns from {low} to {high}", facts)


def _g(acceleration: float) -> str:
    return f"{acceleration / g:.4g} g"
