"""Common functions of the commands with many histories: input document, study, and first lines of the output."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.answers import Display
from rocking.bodies import PLANE_BODIES
from rocking.bodies.body import assumed_rows
from rocking.cli.arguments import NO_MOTION, Arguments, document_file, parsed_sets, with_sets
from rocking.cli.numbers import SIDE, body_line
from rocking.cli.page import Page, sentence
from rocking.cli.spelling import UsageError
from rocking.dynamics.settings import NEVER_SLIDES, Settings
from rocking.errors import located
from rocking.motions.summary import MotionSummary, motion_answer, short_provenance
from rocking.spec.motion_tables import OF_FILES
from rocking.spec.question import StudyQuestion
from rocking.spec.questions import question_in, questions
from rocking.spec.reading import CommandFiles, InputFiles, tables_in
from rocking.spec.schema import SCHEMA
from rocking.spec.study import StudyProblem

if TYPE_CHECKING:
    import typer

TABLES = ("body", "motion", "restitution", "settings")
"""Tables with keys that `--set` can change, in addition to the own table of a study."""
MOST_HISTORIES = 10_000_000
"""Larger studies need `rocking campaign`."""
_OF_ONE_FILE = {"component", "vertical", "vertical_file"}  # keys that apply to a motion of one record file


def problem_in(context: "typer.Context", word: str | None, command: str, *allowed: str) -> StudyProblem | None:
    """Return the study of an input file with the keys of `--set`, or None if the argument is no input file."""
    if (file := document_file(context, word, ("campaign", command), allowed)) is None:
        return None
    kinds = [kind for kind, question in questions().items() if question.own_table() == command]
    with located(str(file), "file"):
        tables = dict(tables_in(file) or {})
        if len(kinds) == 1:
            tables.setdefault("campaign", {"name": command, "kind": kinds[0]})
        document = question_in(
            with_sets(tables, parsed_sets(context.params.get("sets"), (*TABLES, command)), lists=True)
        )
        if document.kind not in kinds:
            raise UsageError('kind "{kind}" needs rocking campaign run', kind=document.kind)
        return _in_memory(document, InputFiles(file.parent))


def problem_of(kind: str, arguments: Arguments, motions: list[dict[str, Any]], **tables: Any) -> StudyProblem:
    """Return the study of the options; `tables` are the tables of the document except motions and settings."""
    settings = {"settings": arguments.table("settings", {"friction": arguments.options.get("friction")})}
    if stated := arguments.restitution(tables.pop("restitution", {})):
        tables["restitution"] = stated
    document = {
        "schema": SCHEMA,
        "campaign": {"name": questions()[kind].own_table(), "kind": kind},
        "motions": motions,
        **settings,
        **tables,
    }
    return _in_memory(question_in(document), CommandFiles(Path()))


def _in_memory(document: StudyQuestion, files: InputFiles) -> StudyProblem:
    """Return the study of a document; refuse keys of campaigns and studies that are too large."""
    for name, keys in document.of_files.items():
        if odd := sorted(keys & getattr(document, name).model_fields_set):
            raise UsageError(
                "{parameter} is for rocking campaign: remove the key, or use rocking campaign",
                parameter=f"{name}.{odd[0]}",
            )  # fmt: skip
    problem = StudyProblem.of(document, files)
    if (count := histories_in(problem)) > MOST_HISTORIES:
        raise UsageError(
            "at most {limit} histories are allowed, got {count}", limit=MOST_HISTORIES, count=count,
            hint="use rocking campaign for more",
        )  # fmt: skip
    return problem


def histories_in(problem: StudyProblem, *, compared: bool = False) -> int:
    """Return the number of histories with all files of folders; for an adaptive study, that of the first round.

    compared: include the histories of the models compared with the default.
    """
    document, models = problem.document, 1 + len(problem.with_compared_models) * compared
    motions = len(problem.motions) / document.motion_count if document.motions else 1.0
    return int(round(math.prod(document.sizes) * motions) * models)


def body_and_motion(
    arguments: Arguments, kind: str, own: dict[str, Any], restitution: Sequence[str] | None
) -> StudyProblem:
    """Return a study of one body and one motion; `own` is the own table of the study."""
    _, named = arguments.body_and_motions()
    if not named:
        raise UsageError(NO_MOTION)
    if several := arguments.several:
        raise UsageError(
            "this command accepts one motion, and {set} contains several. For several use rocking fragility, predict "
            "or simulate",
            set=" ".join(several)[:100],
        )  # fmt: skip
    return of_body(arguments, kind, own, restitution, in_lists([arguments.of_body(named)]))


def of_body(
    arguments: Arguments,
    kind: str,
    own: dict[str, Any],
    restitution: Sequence[str] | None,
    motions: list[dict[str, Any]],
) -> StudyProblem:
    """Return a study of one body under several motions; `own` is the own table of the study."""
    stated = restitution or ()
    if twice := next((text for text in stated if stated.count(text) > 1), None):
        raise UsageError("{parameter} {model} is given twice", parameter="--restitution", model=twice[:60])
    with arguments.hinted():
        body, _ = arguments.body_and_motions()
        tables = {
            "body": arguments.body_table(body),
            "restitution": models_table(restitution),
            questions()[kind].own_table(): own,
        }
        return problem_of(kind, arguments, motions, **tables)


def models_table(restitution: Sequence[str] | None) -> dict[str, Any]:
    """Return the table [restitution] of the given models; empty without a model."""
    return {"models": list(restitution)} if restitution else {}


def in_lists(motions: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the tables of single motions as [[motions]]; successive record files with equal keys have one table."""
    names = {"record": "records", "pulse": "pulse"}
    tables: list[dict[str, Any]] = []
    for motion in motions:
        table = {names.get(key, key): [value] if key in names else value for key, value in motion.items()}
        if tables and "record" in motion and not _OF_ONE_FILE & motion.keys() and _differ_in_files(table, tables[-1]):
            tables[-1]["records"] += table["records"]
        else:
            tables.append(table)
    return tables


def _differ_in_files(table: dict[str, Any], other: dict[str, Any]) -> bool:
    """Return True if two tables of records differ only in their files."""
    return "records" in other and {**table, "records": ()} == {**other, "records": ()}


def family(arguments: Arguments, usual: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return the table of synthetic motions, or None if motions are given; `usual` contains the defaults."""
    options = {name: arguments.options[name] for name in ("synthetic", "count", "seed")}
    if arguments.body_and_motions()[1]:
        if odd := [f"--{name}" for name, value in options.items() if value is not None]:
            raise UsageError(
                "{options} is for synthetic motions, not for --motion: remove {options}", options=", ".join(odd)
            )
        return None
    odd = ["--units"] if arguments.acceleration is not None else []
    of_files = OF_FILES - {"time_step"}
    if odd := [*odd, *(f"motion.{key}" for key in arguments.sets.get("motion", {}) if key in of_files)]:
        raise UsageError("{options} is for record files: remove {options}, or give --motion", options=", ".join(odd))
    return {**usual, **arguments.table("motion", options)}


def motions_of(
    arguments: Arguments, table: Callable[[Sequence[str]], dict[str, Any]], usual: Mapping[str, Any]
) -> list[dict[str, Any]]:
    """Return the tables of the given motions, built by `table`, or that of synthetic motions."""
    if (synthetic := family(arguments, usual)) is None:
        return in_lists(arguments.each(arguments.body_and_motions()[1], table))
    if "synthetic" not in synthetic:
        raise UsageError(NO_MOTION + ", or --synthetic firm-ground")
    return [synthetic]


def source_lines(motions: Sequence[MotionSummary]) -> list[tuple[str, str]]:
    """Return the printed lines of the source and the processing of motions."""
    several = len(motions) > 1
    return [("source", f"{name}: {text}" if several else text) for name, text in short_provenance(motions)]


def contact_lines(settings: Settings, *, varied: bool = False) -> list[tuple[str, str]]:
    """Return the printed line of a contact with sliding; `varied` is True if friction is an axis of the study."""
    stated = settings.stated
    if "friction" not in stated:
        return []
    e, law = stated.get("normal_restitution"), stated.get("normal_restitution_law")
    bounce = f"; normal restitution {e:g} ({law})" if e else ""
    friction = "varied" if varied else f"{settings.friction:g}"
    motions = "sliding, hopping" if settings.friction < NEVER_SLIDES else "hopping"
    return [("contact", f"friction {friction}{bounce}; {motions} and free flight are possible")]


def subject_lines(problem: StudyProblem, display: Display, *, varied: bool = False) -> list[tuple[str, str]]:
    """Return the printed lines of the body of a study and of its contact."""
    body, settings = problem.bodies[0], problem.settings
    answer = body.answer(settings.gravity) if isinstance(body, PLANE_BODIES) else body.answer()
    line = body_line(body, answer, display, ("parts", "centre_height", *SIDE))
    return [("body", line), *_restraints(body), *assumed_rows(body), *contact_lines(settings, varied=varied)]


def _restraints(body: Any) -> list[tuple[str, str]]:
    """Return the printed line of the restraints of a body; empty without restraints."""
    names = ", ".join(restraint.name for restraint in getattr(body, "restraints", ()))
    return [("restraints", names)] if names else []


def show_subject(page: Page, problem: StudyProblem, display: Display, motion: str, *, varied: bool = False) -> None:
    """Write body, motion and contact of a study of one body."""
    body, settings = problem.bodies[0], problem.settings
    answer = body.answer(settings.gravity) if isinstance(body, PLANE_BODIES) else body.answer()
    page.line(f"{body_line(body, answer, display)}; {motion}")
    page.facts([*_restraints(body), *contact_lines(settings, varied=varied)])


def show_assumed(page: Page, problem: StudyProblem, *, details: bool) -> None:
    """Write the assumed values of the body, and with details the source and the processing of the motion."""
    for text in problem.bodies[0].assumed:
        page.line(sentence(text))
    if details:
        page.facts(source_lines([MotionSummary.of(problem.motions[0])]))


_GROUND = {"friction", "normal_restitution", "normal_restitution_law"}


def subject_values(problem: StudyProblem) -> dict[str, Any]:
    """Return the values of body and motion of a study of one body and one motion."""
    body, motion = problem.bodies[0], problem.motions[0]
    stated = problem.settings.stated
    varied = {axis.name for axis in problem.document.axes}
    ground = {name: value for name, value in stated.items() if name in _GROUND - varied}
    return {
        "body": repr(body),
        **ground,
        "assumed": list(getattr(body, "assumed", ())),
        "motion": motion_answer(motion),
    }
