"""`rocking identify`: the coefficient of restitution from a sound, a video, a table, or a folder of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.answers import Answer
from rocking.cli import options
from rocking.cli.exports import CSV, NETCDF, REPORTED, Export, Exports
from rocking.cli.page import Page, bar, deliver
from rocking.conventions import FEET, NORMAL_95
from rocking.errors import InvalidValueError, MeasurementError, located
from rocking.messages import Message, WrittenFile

if TYPE_CHECKING:
    from rocking.identification import Identification, ModelComparison
    from rocking.spec.documents.identification import IdentificationDocument
    from rocking.spec.identification import IdentifiedTrials
    from rocking.spec.reading import InputFiles

TABLES = ("body", "measurement", "motion", "identify")
_TELLING = 3
"""Experiments that are told."""

_NOISES = {"times": "ms", "rotation": "mrad", "angular_velocity": "mrad/s"}
"""Units of what a measurement leaves over."""


def _excel(answer: Any, path: Path) -> None:
    from rocking.tables import to_excel

    table = answer.found.exported()
    sheets = [(f"{table.row}s", table), *((f"{name}s", each) for name, each in table.beside.items())]
    to_excel(sheets, path, table.provenance, dressed=True)


EXPORTS = {**REPORTED, "csv": CSV, "netcdf": NETCDF, "excel": Export((".xlsx",), _excel, "openpyxl")}


@options.takes(options.SIZES)
def identify(
    context: typer.Context,
    body: Annotated[
        str | None, typer.Argument(help="Body file or input file; omit with --width, or if unknown.")
    ] = None,
    record: Annotated[
        str | None,
        typer.Argument(help="Measurement: sound (.wav, .flac), video (.mp4), table (.csv, .xlsx) or folder."),
    ] = None,
    motion: Annotated[
        list[str] | None, typer.Option(help="Ground motion during the measurement: record or pulse.")
    ] = None,
    sets: options.Set = None,
    workers: Annotated[int | None, typer.Option(min=1, max=4096, help="Number of processes for a folder.")] = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking identify`."""
    from rocking.spec.identification import IdentificationProblem

    exports = Exports.of(output, EXPORTS)
    problem = IdentificationProblem.of(*_question(context, [each for each in (body, record) if each is not None]))
    exports.spare(*(problem.trials if problem.path.is_dir() else [problem.path]), *(motion or ()))
    if problem.path.is_dir():
        table = next((path for name, path in exports.files if name == "csv"), None)
        with bar("trials", len(problem.trials), quiet=as_json) as progress:
            trials = problem.answers(table, workers, progress)
        deliver(TrialsAnswer(trials), exports, as_json=as_json)
        return
    with bar("measurement", quiet=as_json):
        found = problem.answer()
    answer = IdentifiedAnswer(found, Path(body or "").stem if record else "")
    if found.refused:
        written = exports.write(answer)
        see = Message(" See {file}.", {"file": WrittenFile(str(written[0]))}) if written else ""
        raise MeasurementError("{refusal}{see}", refusal=found.refusal, see=see).at(found.source)
    deliver(answer, exports, as_json=as_json)


def _question(context: typer.Context, words: list[str]) -> "tuple[IdentificationDocument, InputFiles]":
    """Return what was asked; a body file and a measurement may stand in either order."""
    from rocking.cli.arguments import Arguments, document_file, is_body, with_sets
    from rocking.spec.documents.identification import IdentificationDocument
    from rocking.spec.identification import bodies_in
    from rocking.spec.reading import CommandFiles, InputFiles, checked, tables_in

    arguments = Arguments(context, *TABLES)
    bodies, measured = [w for w in words if is_body(w)], [w for w in words if not is_body(w)]
    if len(bodies) > 1 or len(measured) > 1:
        raise InvalidValueError("one body and one measurement, please: got {arguments}", arguments=" and ".join(words))
    if measured and Path(measured[0]).is_dir() and not bodies and not arguments.sizes:
        bodies = [str(path) for path in bodies_in(Path(measured[0]))]
        if len(bodies) > 1:
            raise InvalidValueError(
                "several body files, {bodies}", bodies=", ".join(bodies), hint="name one before it"
            ).at(measured[0])
    file = document_file(context, bodies[0] if bodies else None, ("measurement", "identify"), ("record", "workers"))
    if file is not None:
        tables = with_sets(dict(tables_in(file) or {}), arguments.sets)
        if measured:
            at = {"file": str(Path(measured[0]).absolute())}
            tables["measurement"] = {**tables.get("measurement", {}), **at}
        with located(str(file), "file"):
            return checked(IdentificationDocument, tables), InputFiles(file.parent)
    if not measured:
        raise InvalidValueError("what was measured? Give a sound, a table of times or rotations, or a folder of trials")
    document: dict[str, Any] = {
        "measurement": arguments.table("measurement", {"file": measured[0]}),
        "identify": arguments.table("identify", {}),
    }
    if motions := arguments.options["motion"]:
        document["motion"] = arguments.one_motion(motions)
    if bodies or arguments.sizes or arguments.sets.get("body"):
        document["body"] = arguments.body_table(bodies[0] if bodies else None)
    return checked(IdentificationDocument, document), CommandFiles(Path())


def _compared(page: Page, models: "Sequence[ModelComparison]") -> None:
    from rocking.reports._identification import COMPARED

    if models:
        page.line()
        page.rows(map(vars, models), COMPARED)


@dataclass(frozen=True)
class IdentifiedAnswer:
    """What a measurement says."""

    found: "Identification"
    name: str = ""  # of the body

    def answer(self) -> Answer:
        """Return the coefficients, impacts and fit."""
        return self.found.answer()

    def draw(self) -> Any:
        return self.found.plot()

    def show(self, page: Page) -> None:
        from rocking.reports._identification import IMPACT

        found = self.found
        page.line(found.verdict, style="bold")
        for foot in FEET:
            page.line(f"Landing {foot}: {found.coefficients[foot]}.")
        if found.forced:
            page.line(str(found.forced))
        page.line()
        page.rows(found.answer()["impacts"], IMPACT, most=len(found.impacts))
        _compared(page, found.models)
        page.line()
        page.facts(_facts(found), width=20)
        page.line()
        for each in found.designs[:_TELLING]:
            page.line(
                f"Let go from {each.release_ratio:g} of its slenderness angle, {each.impacts} impacts timed to "
                f"{1e3 * each.timing_noise:.2g} ms: r to +- {NORMAL_95 * each.deviation:.2g}."
            )
        page.warn(found.doubts)


def _facts(found: "Identification") -> list[tuple[str, str]]:
    """Return what else was found, in words."""
    p, tilt, noise = found.frequency_parameter, found.tilt, found.noise
    unit = next(unit for name, unit in _NOISES.items() if getattr(found.measurement, name, None) is not None)
    lines = [
        ("scatter of ln r", f"{found.scatter}; none with a probability of {found.no_scatter:.3g}"),
        ("p", f"{p} rad/s"),
        ("tilt of the floor", f"{1e3 * tilt.value:.3g} ({1e3 * tilt.low:.3g} to {1e3 * tilt.high:.3g}) mrad"),
        ("noise", f"{1e3 * noise.value:.3g} {unit}"),
    ]
    if found.p_value == found.p_value:
        lines += [("steadiness", f"p = {found.p_value:.2g} that impacts change with their number by chance alone")]
    if found.forced:
        lines += [("clock, ahead by", f"{found.forced.clock} s"), ("gain", str(found.forced.gain))]
    lines += [(f"impulse, {foot}", f"k = {each}") for foot, each in found.impulse.items()]
    return lines + [(name, str(getattr(found, name))) for name in ("trend", "damping") if getattr(found, name)]


@dataclass(frozen=True)
class TrialsAnswer:
    """What the trials of a folder say."""

    found: "IdentifiedTrials"

    def answer(self) -> Answer:
        """Return the trials and their mean."""
        return self.found.answer()

    def draw(self) -> Any:
        from rocking.plots.identification import trials_picture

        return trials_picture(self.found)

    def show(self, page: Page) -> None:
        from rocking.reports._identification import TRIAL

        found = self.found
        page.line(found.verdict, style="bold")
        if found.mean is not None:
            page.line(
                "The interval is from how trials differ, and never narrower than their own allow; the error of the "
                "size of the body, common to all, is in it."
            )
        page.line()
        page.rows(found.good_rows, TRIAL, most=len(found.rows))
        _compared(page, found.models)
        kept = len(found.rows) - found.computed
        if kept:
            page.line(f"{kept} of {len(found.rows)} were there already, and were not computed again.")
        if found.passed_over:
            page.line(found.passed_over_verdict)
        page.warn(found.doubts)
        page.warn(f"{row['trial']}: {row['refused']}" for row in found.rows if row["refused"])
