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
from rocking.cli.spelling import UsageError
from rocking.conventions import FEET, NORMAL_95
from rocking.errors import MeasurementError, located
from rocking.messages import Message, WrittenFile

if TYPE_CHECKING:
    from rocking.identification import Identification, ModelComparison
    from rocking.spec.documents.identification import IdentificationDocument
    from rocking.spec.identification import IdentifiedTrials
    from rocking.spec.reading import InputFiles

TABLES = ("body", "measurement", "motion", "identify")
_PROPOSED = 3
"""Number of proposed experiments that are printed."""
_FACTS = 2
"""Number of other quantities that are printed without --details."""
_TRIALS = 8
"""Number of trials that are printed without --details."""

_NOISES = {"times": "ms", "rotation": "mrad", "angular_velocity": "mrad/s"}
"""Units of the noise by kind of measurement."""


def _excel(answer: Any, path: Path) -> None:
    from rocking.tables import to_excel

    table = answer.result.exported()
    sheets = [(f"{table.row}s", table), *((f"{name}s", sheet) for name, sheet in table.related.items())]
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
    details: options.Details = False,
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
        deliver(TrialsAnswer(trials, details), exports, as_json=as_json)
        return
    with bar("measurement", quiet=as_json):
        result = problem.answer()
    answer = IdentifiedAnswer(result, Path(body or "").stem if record else "", details)
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
        raise UsageError("Give one body and one measurement, got {arguments}", arguments=" and ".join(texts))
    if measured and Path(measured[0]).is_dir() and not bodies and not arguments.sizes:
        bodies = [str(path) for path in bodies_in(Path(measured[0]))]
        if len(bodies) > 1:
            raise UsageError(
                "the arguments contain several body files, {bodies}",
                bodies=", ".join(bodies),
                hint="give one body file before the folder",
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
        raise UsageError("No measurement. Give a sound, a table of times or rotations, or a folder of trials")
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
    name: str = ""  # name of the body
    details: bool = False

    def answer(self) -> Answer:
        """Return the coefficients, impacts and fit."""
        return self.result.answer()

    def draw(self) -> Any:
        return self.result.plot()

    def show(self, page: Page) -> None:
        from rocking.reports._identification import IMPACT

        result = self.result
        page.line(result.verdict, style="bold")
        facts = _facts(result)
        feet = [(f"landing {foot}", str(result.coefficients[foot])) for foot in FEET]
        page.values([*feet, *(facts if self.details else facts[:_FACTS])])
        if result.forced:
            page.line(str(result.forced))
        if self.details:
            page.line()
            page.rows(result.answer()["impacts"], IMPACT, most=len(result.impacts))
        _compared(page, result.models)
        page.warn(result.doubts)
        if not self.details:
            page.line("Impacts, noise and better experiments: --details    Files: -o impacts.csv, -o report.pdf")
            return
        page.line("\nProposed experiments", "bold")
        for design in result.designs[:_PROPOSED]:
            page.line(
                f"Release at {design.release_ratio:g} of the slenderness angle, {design.impacts} impacts, timing "
                f"error {1e3 * design.timing_noise:.2g} ms: 95 % interval of r +- {NORMAL_95 * design.deviation:.2g}."
            )


def _facts(result: "Identification") -> list[tuple[str, str]]:
    """Return labels and texts of the other identified quantities."""
    p, tilt, noise = result.frequency_parameter, result.tilt, result.noise
    unit = next(unit for name, unit in _NOISES.items() if getattr(result.measurement, name, None) is not None)
    lines = [
        ("scatter of ln r", f"{result.scatter}; probability of no scatter {result.no_scatter:.3g}"),
        ("frequency parameter p", f"{p} rad/s"),
        ("tilt of the floor", f"{1e3 * tilt.value:.3g} ({1e3 * tilt.low:.3g} to {1e3 * tilt.high:.3g}) mrad"),
        ("noise", f"{1e3 * noise.value:.3g} {unit}"),
    ]
    if result.p_value == result.p_value:
        lines += [("constant r", f"p-value {result.p_value:.2g} (r independent of the number of the impact)")]
    if result.forced:
        lines += [("clock offset", f"{result.forced.clock} s"), ("gain", str(result.forced.gain))]
    lines += [(f"impulse position, {foot}", f"k = {position}") for foot, position in result.impulse.items()]
    return lines + [(name, str(getattr(result, name))) for name in ("trend", "damping") if getattr(result, name)]


@dataclass(frozen=True)
class TrialsAnswer:
    """Result of the trials of a folder."""

    result: "IdentifiedTrials"
    details: bool = False

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
                "The interval is that of the differences between trials, and at least that of single trials. It "
                "includes the error of the size of the body, common to all trials."
            )
        page.line()
        page.rows(result.good_rows, TRIAL, most=len(result.rows) if self.details else _TRIALS)
        _compared(page, result.models)
        kept = len(result.rows) - result.computed
        if kept:
            page.line(f"{kept} of {len(result.rows)} trials were stored and not recomputed.")
        if result.passed_over:
            page.line(result.passed_over_verdict)
        page.warn(result.doubts)
        page.warn(f"{row['trial']}: {row['refused']}" for row in result.rows if row["refused"])
        if not self.details:
            page.line("All trials: --details    Files: -o trials.csv, -o trials.png")
