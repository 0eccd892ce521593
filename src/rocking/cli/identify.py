"""`rocking identify`: coefficient of restitution from a sound, a video, a table, or a folder of trials."""

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
"""Number of proposed experiments that are printed."""

_NOISES = {"times": "ms", "rotation": "mrad", "angular_velocity": "mrad/s"}
"""Units of the noise by kind of measurement."""


def _excel(answer: Any, path: Path) -> None:
    from rocking.tables import to_excel

    table = answer.result.exported()
    sheets = [(f"{table.row}s", table), *((f"{name}s", sheet) for name, sheet in table.beside.items())]
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
    problem = IdentificationProblem.of(*_question(context, [text for text in (body, record) if text is not None]))
    exports.spare(*(problem.trials if problem.path.is_dir() else [problem.path]), *(motion or ()))
    if problem.path.is_dir():
        table = next((path for name, path in exports.files if name == "csv"), None)
        with bar("trials", len(problem.trials), quiet=as_json) as progress:
            trials = problem.answers(table, workers, progress)
        deliver(TrialsAnswer(trials), exports, as_json=as_json)
        return
    with bar("measurement", quiet=as_json):
        result = problem.answer()
    answer = IdentifiedAnswer(result, Path(body or "").stem if record else "")
    if result.refused:
        written = exports.write(answer)
        see = Message(" See {file}.", {"file": WrittenFile(str(written[0]))}) if written else ""
        raise MeasurementError("{refusal}{see}", refusal=result.refusal, see=see).at(result.source)
    deliver(answer, exports, as_json=as_json)


def _question(context: typer.Context, texts: list[str]) -> "tuple[IdentificationDocument, InputFiles]":
    """Return the input; body file and measurement may have any order."""
    from rocking.cli.arguments import Arguments, document_file, is_body, with_sets
    from rocking.spec.documents.identification import IdentificationDocument
    from rocking.spec.identification import bodies_in
    from rocking.spec.reading import CommandFiles, InputFiles, checked, tables_in

    arguments = Arguments(context, *TABLES)
    bodies, measured = [text for text in texts if is_body(text)], [text for text in texts if not is_body(text)]
    if len(bodies) > 1 or len(measured) > 1:
        raise InvalidValueError("Give one body and one measurement, got {arguments}", arguments=" and ".join(texts))
    if measured and Path(measured[0]).is_dir() and not bodies and not arguments.sizes:
        bodies = [str(path) for path in bodies_in(Path(measured[0]))]
        if len(bodies) > 1:
            raise InvalidValueError(
                "several body files, {bodies}", bodies=", ".join(bodies), hint="give one body file before the folder"
            ).at(measured[0])
    file = document_file(context, bodies[0] if bodies else None, ("measurement", "identify"), ("record", "workers"))
    if file is not None:
        tables = with_sets(dict(tables_in(file) or {}), arguments.sets)
        if measured:
            source = {"file": str(Path(measured[0]).absolute())}
            tables["measurement"] = {**tables.get("measurement", {}), **source}
        with located(str(file), "file"):
            return checked(IdentificationDocument, tables), InputFiles(file.parent)
    if not measured:
        raise InvalidValueError("No measurement. Give a sound, a table of times or rotations, or a folder of trials")
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
    """Result of a measurement."""

    result: "Identification"
    name: str = ""  # of the body

    def answer(self) -> Answer:
        """Return the coefficients, impacts and fit."""
        return self.result.answer()

    def draw(self) -> Any:
        return self.result.plot()

    def show(self, page: Page) -> None:
        from rocking.reports._identification import IMPACT

        result = self.result
        page.line(result.verdict, style="bold")
        for foot in FEET:
            page.line(f"Landing {foot}: {result.coefficients[foot]}.")
        if result.forced:
            page.line(str(result.forced))
        page.line()
        page.rows(result.answer()["impacts"], IMPACT, most=len(result.impacts))
        _compared(page, result.models)
        page.line()
        page.facts(_facts(result), width=20)
        page.line()
        for design in result.designs[:_TELLING]:
            page.line(
                f"Let go from {design.release_ratio:g} of its slenderness angle, {design.impacts} impacts timed to "
                f"{1e3 * design.timing_noise:.2g} ms: r to +- {NORMAL_95 * design.deviation:.2g}."
            )
        page.warn(result.doubts)


def _facts(result: "Identification") -> list[tuple[str, str]]:
    """Return labels and texts of the other identified quantities."""
    p, tilt, noise = result.frequency_parameter, result.tilt, result.noise
    unit = next(unit for name, unit in _NOISES.items() if getattr(result.measurement, name, None) is not None)
    lines = [
        ("scatter of ln r", f"{result.scatter}; none with a probability of {result.no_scatter:.3g}"),
        ("p", f"{p} rad/s"),
        ("tilt of the floor", f"{1e3 * tilt.value:.3g} ({1e3 * tilt.low:.3g} to {1e3 * tilt.high:.3g}) mrad"),
        ("noise", f"{1e3 * noise.value:.3g} {unit}"),
    ]
    if result.p_value == result.p_value:
        lines += [("steadiness", f"p = {result.p_value:.2g} that impacts change with their number by chance alone")]
    if result.forced:
        lines += [("clock, ahead by", f"{result.forced.clock} s"), ("gain", str(result.forced.gain))]
    lines += [(f"impulse, {foot}", f"k = {position}") for foot, position in result.impulse.items()]
    return lines + [(name, str(getattr(result, name))) for name in ("trend", "damping") if getattr(result, name)]


@dataclass(frozen=True)
class TrialsAnswer:
    """Result of the trials of a folder."""

    result: "IdentifiedTrials"

    def answer(self) -> Answer:
        """Return the trials and their mean."""
        return self.result.answer()

    def draw(self) -> Any:
        from rocking.plots.identification import trials_picture

        return trials_picture(self.result)

    def show(self, page: Page) -> None:
        from rocking.reports._identification import TRIAL

        result = self.result
        page.line(result.verdict, style="bold")
        if result.mean is not None:
            page.line(
                "The interval is from how trials differ, and never narrower than their own allow; the error of the "
                "size of the body, common to all, is in it."
            )
        page.line()
        page.rows(result.good_rows, TRIAL, most=len(result.rows))
        _compared(page, result.models)
        kept = len(result.rows) - result.computed
        if kept:
            page.line(f"{kept} of {len(result.rows)} were there already, and were not computed again.")
        if result.passed_over:
            page.line(result.passed_over_verdict)
        page.warn(result.doubts)
        page.warn(f"{row['trial']}: {row['refused']}" for row in result.rows if row["refused"])
