"""`rocking simulate`: response of a body to records and pulses, or after release."""

import math
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking import plausibility
from rocking.answers import Answer, Display
from rocking.bodies import PLANE_BODIES
from rocking.cli import completion, options
from rocking.cli.arguments import Arguments, document_file, parsed_sets, with_sets
from rocking.cli.compared import model_facts, show_models
from rocking.cli.exports import DRAWN, Export, Exports
from rocking.cli.page import Page, bar, deliver
from rocking.cli.spelling import UsageError
from rocking.conventions import COMPARED_RESTITUTIONS, DEFAULT_RESTITUTION
from rocking.dynamics.mechanics import restitution_label
from rocking.errors import RockingError, located
from rocking.messages import Message
from rocking.motions.components import leading
from rocking.motions.summary import MotionSummary, peak_names, support_of
from rocking.outcome import Outcome
from rocking.spec.bodies import any_body_of, name_of
from rocking.spec.construction import motions_of
from rocking.spec.documents.response import ResponseDocument, ResponseTable, ResponseTables
from rocking.spec.fields import Angle
from rocking.spec.motion_tables import MotionKeys, MotionTable
from rocking.spec.reading import CommandFiles, InputFiles, checked, tables_in
from rocking.spec.response import problem_of, response_problem

if TYPE_CHECKING:
    from rocking.spec.response import ResponseProblem

_TABLES = ("body", "motion", "response", "restitution", "settings")


def _animate(answer: Any, path: Path) -> None:
    from rocking.plots.animation import animate_gif, animate_html, slowest_speed

    if path.suffix.lower() == ".glb":
        from rocking.plots.space_glb import GltfFile

        file = GltfFile(answer.problem.body)
        file.add_motion(answer.response)
        file.write(path)
        return
    if path.suffix.lower() == ".html":
        animate_html(answer.response, path)
        return
    from rich.console import Console
    from rich.progress import Progress

    hidden = not sys.stderr.isatty()
    # `quiet` is necessary, because older versions of rich print an empty line after a hidden bar
    with Progress(console=Console(stderr=True, quiet=hidden), transient=True, disable=hidden) as progress:
        task = progress.add_task("frames")
        animate_gif(
            answer.response,
            path,
            speed=slowest_speed(answer.response),
            progress=lambda done, total: progress.update(task, completed=done, total=total),
        )


def _report(answer: Any, path: Path) -> None:
    answer.response.report(path, name=answer.name)


EXPORTS = {
    "picture": DRAWN,
    "animation": Export((".html", ".gif", ".glb"), _animate),
    "report": Export((".pdf", ".html"), _report, "matplotlib"),
    "csv": Export((".csv",), lambda answer, path: answer.response.to_csv(path)),
    "mat": Export((".mat",), lambda answer, path: answer.response.to_mat(path)),
    "netcdf": Export((".nc",), lambda answer, path: answer.response.to_netcdf(path)),
}


@options.takes(options.SIZES)
@options.takes(
    options.keys(MotionKeys, "scale"),
    options.keys(ResponseTable, "friction", "normal_restitution", "start_height", "start_velocity"),
)
@options.takes(options.keys(ResponseTable, "initial_rotation"), before="restitution")
def simulate(
    context: typer.Context,
    body: options.BodyFile = None,
    record: Annotated[
        list[str] | None,
        typer.Argument(
            help="Record file, FILE#COMPONENT or pulse: sine:amplitude=3,period=0.8. Several records: one row per "
            "record.",
            autocompletion=completion.pulses,
        ),
    ] = None,
    motion: options.Motion = None,
    restitution: options.Restitution = None,
    sets: options.Set = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking simulate`."""
    from rocking.cli.responses import answer_of

    exports, stated = Exports.of(output, EXPORTS), False
    in_space = any(path.suffix.lower() == ".glb" for _, path in exports.files)
    display = Display(acceleration="g")
    if file := document_file(context, body, ("response",), has="has a table [body] and "):
        with located(str(file), "file"):
            tables = with_sets(tables_in(file) or {}, parsed_sets(sets, _TABLES))
            document = checked(ResponseDocument, tables)
            problem = response_problem(document, InputFiles(file.parent), in_space=in_space)
            stated = "restitution" in document.model_fields_set
    else:
        arguments = Arguments(context, *_TABLES)
        display = Display(arguments.length or "m", arguments.acceleration or "g")
        if motions := arguments.several:
            if output:
                raise UsageError(
                    "{parameter} accepts one record, and {set} contains several: use --json", parameter="--output",
                    set=motions[0][:100],
                )  # fmt: skip
            deliver(_several(arguments, motions, display, quiet=as_json), as_json=as_json)
            return
        with arguments.hinted():
            document = _document(arguments)
            problem = response_problem(document, CommandFiles(Path()), in_space=in_space)
    if problem.initial_rotation is not None:
        has_unit = isinstance(document.response.initial_rotation, Angle)
        _check_rotation(problem, "response.initial_rotation" if file else "--initial-rotation", has_unit=has_unit)
    if in_space and problem.mechanics.name != "hull":
        raise UsageError(".glb is for 3D bodies with friction; use .html or .gif")
    with bar("history", quiet=as_json):
        is_stated = "restitution" in document.model_fields_set
        answer = answer_of(problem, display, listed=stated, is_stated=is_stated, details=details)
    answer = replace(answer, name=name_of(document.body, file.parent if file else Path()))
    deliver(answer, exports, as_json=as_json)


_TILTS = ("peak_rotation", "peak_tilt")


def _document(arguments: Arguments) -> ResponseDocument:
    """Return the input file with the same content as the options."""
    body, motions = arguments.body_and_motions()
    response = arguments.table("response", arguments.values(ResponseTable))
    free = "initial_rotation" in response
    dropped = "start_height" in response or "start_velocity" in response
    if free and motions:
        raise UsageError("Give a motion or --initial-rotation, not both; got {motion!r}", motion=motions[0][:100])
    stated = [arguments.spelt("scale"), "--units" if arguments.acceleration else ""]
    stated = [*filter(None, stated), *(f"motion.{key}" for key in arguments.sets.get("motion", {}))]
    if stated and not motions and (free or dropped):
        name = "--initial-rotation" if free else "a drop"
        raise UsageError(
            "{options} can only be used with a motion, not with {option}", option=name, options=", ".join(stated)
        )
    if not free and not dropped and not motions and not arguments.solid:
        raise UsageError("No ground motion. Add --motion or --initial-rotation")
    tables: dict[str, Any] = {
        "body": arguments.body_table(body),
        "response": response,
        **_restitution(arguments),
        "settings": arguments.sets.get("settings", {}),
    }
    if motions or not (free or dropped):
        motion = arguments.of_body(motions)
        scale = arguments.options["scale"] if arguments.spelt("scale") else None
        tables["motion"] = {**motion, **arguments.table("motion", {"scale": scale}, keys={"scale"})}
    return checked(ResponseDocument, tables)


def _restitution(arguments: Arguments) -> dict[str, Any]:
    """Return the table [restitution] by its name; empty without a stated model."""
    return {"restitution": stated} if (stated := arguments.restitution()) else {}


def _several(arguments: Arguments, texts: list[str], display: Display, *, quiet: bool) -> "SeveralAnswer":
    """Return the responses to several motions."""
    from rocking.cli.study import in_lists

    body, _ = arguments.body_and_motions()
    if arguments.options["initial_rotation"] is not None:
        raise UsageError("Give a motion or --initial-rotation, not both; got {motion!r}", motion=texts[0][:100])
    files = CommandFiles(Path())
    with arguments.hinted():
        tables = {
            "response": arguments.table("response", arguments.values(ResponseTable)),
            **_restitution(arguments),
            "settings": arguments.sets.get("settings", {}),
        }  # fmt: skip
        scale = arguments.table("motion", {"scale": arguments.options["scale"]}, keys={"scale"})
        tables_of = in_lists(arguments.motion_table(word) for word in texts)
        named = [checked(MotionTable, {**motion_table, **scale}) for motion_table in tables_of]
        subject = any_body_of(arguments.body_table(body), files)
        motions = motions_of(named, files, paired=not isinstance(subject, PLANE_BODIES))
        problem = problem_of(checked(ResponseTables, tables), subject, motions[0], scale=1.0, inputs=files)
        if not problem.mechanics.has_restitution:
            raise UsageError(
                "Several records do not support {subject}. Give one record", subject=problem.mechanics.subject
            )
        listed = [motions[k] for k in range(len(motions))]
        label = next(iter(problem.restitutions))
        others = COMPARED_RESTITUTIONS if label == DEFAULT_RESTITUTION else ()
        responses: dict[str, Any] = {}
        with bar("histories", len(listed) * (1 + len(others)), quiet=quiet) as progress:
            for name in (label, *others):
                try:
                    responses[name] = _followed(problem, listed, name if name != label else ..., progress)
                except RockingError as error:
                    if name == label:
                        raise
                    responses[name] = error
    own = responses.pop(label)
    name = restitution_label(label, problem.body)
    return SeveralAnswer(problem.body, listed, own, display, name, responses, "restitution" in tables)


def _followed(problem: "ResponseProblem", motions: list[Any], law: Any, progress: Any) -> list[Any]:
    """Return the responses to motions with one restitution model."""
    responses = []
    for motion in motions:
        responses.append(replace(problem, motion=motion).answer(law))
        progress(1)
    return responses


@dataclass(frozen=True)
class SeveralAnswer:
    """Outcomes of a body under several motions with one restitution model."""

    body: Any
    motions: list[Any]
    responses: list[Any]
    display: Display
    label: str  # label of the restitution
    others: dict[str, Any]  # responses with the compared models
    is_stated: bool  # True if the input states the restitution

    def answer(self) -> Answer:
        """Return each motion with its outcome, peak and number of impacts."""
        pairs = zip(self.motions, self.responses, strict=True)
        rows = [
            MotionSummary.of(motion).answer() | {
                "name": leading(motion).name, "outcome": response.outcome.name.lower(), **_peak(response),
                "impacts": int(response.impacts.size),
            }
            for motion, response in pairs
        ]  # fmt: skip
        facts = model_facts(self.label, self.others, _overturned, self.body, is_stated=self.is_stated)
        return Answer({"overturned": self._overturned, "restitution": self.label, "motions": rows, **facts})

    @property
    def _overturned(self) -> int:
        return int(_overturned(self.responses)["overturned"])

    def show(self, page: Page) -> None:
        from rocking.cli.study import source_lines

        count, display = len(self.motions), self.display
        page.line(f"Overturning under {self._overturned} of {count} motion{'s' * (count != 1)}.", "bold")
        page.line()
        acceleration = peak_names(map(support_of, self.motions))[0]
        peak = display.entry("peak_ground_acceleration")
        rows = [
            {**row.values, "motion": row["name"]} | (dict.fromkeys(_TILTS) if row["outcome"] == "overturned" else {})
            for row in self.answer()["motions"]
        ]
        named = replace(display, own={peak.name: replace(peak, label=acceleration)})
        shown = [name for name in _TILTS if any(row.get(name) is not None for row in rows)]
        page.rows(rows, ("motion", peak.name, "outcome", *shown, "impacts"), named, most=count)
        page.line()
        page.facts(source_lines([MotionSummary.of(motion) for motion in self.motions]))
        show_models(page, self.answer(), display, self.label, _overturned(self.responses))
        page.line("Probability of overturning: rocking predict    Margin: rocking assess")


def _overturned(responses: list[Any]) -> dict[str, Any]:
    count = sum(response.outcome is Outcome.OVERTURNED for response in responses)
    return {"overturned": count, "fraction": count / len(responses)}


def _peak(response: Any) -> dict[str, float]:
    """Return the peak rotation of a 2D body, or the peak tilt of a 3D body [rad]."""
    name = "peak_tilt" if hasattr(response, "peak_tilt") else "peak_rotation"
    return {name: abs(float(getattr(response, name)))}


def _check_rotation(problem: "ResponseProblem", option: str, *, has_unit: bool) -> None:
    """Refuse an initial rotation of 90 degrees or more; warn beyond equilibrium, because a unit can be missing."""
    fraction, angle = float(problem.initial_rotation or 0.0), math.degrees(problem.rotation)
    if abs(angle) >= 90.0:
        facts = {"option": option, "angle": fraction}
        raise UsageError(
            "{parameter} is a fraction of the slenderness angle, {slenderness_angle:.3g} degrees, or an angle with "
            "its unit, deg or rad; got {free:g}", parameter=option,
            slenderness_angle=math.degrees(problem.balance_angle), free=fraction,
            hint=Message("for {angle:g} degrees use {option} {angle:g}deg", facts) if abs(fraction) < 90.0 else "",
        )  # fmt: skip
    if abs(fraction) > 1.0:
        plausibility.warn([
            f"an initial rotation of {fraction:.4g} slenderness angles, {angle:.3g} degrees, is beyond equilibrium and "
            f"leads to overturning{'' if has_unit else f'. Angles have a unit: {option} 5deg or 0.1rad'}"
        ])  # fmt: skip
