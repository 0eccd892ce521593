"""`rocking restitution`: coefficients of restitution of a body with all models."""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.answers import Answer, Display
from rocking.bodies import Body, Isolated, Restrained
from rocking.cli import completion, options
from rocking.cli.arguments import Arguments, document_file, hinted, with_sets
from rocking.cli.exports import DRAWN, PICTURES, Export, Exports, write_records
from rocking.cli.numbers import SIDE, body_line, recommendation_values, show_recommendation
from rocking.cli.page import Page, deliver
from rocking.cli.spelling import UsageError
from rocking.conventions import g
from rocking.errors import located
from rocking.messages import listed
from rocking.quantities import closely
from rocking.spec.bodies import body_for_motion, without_restraints
from rocking.spec.fields import JobTable
from rocking.spec.reading import CommandFiles, InputFiles, checked, tables_in
from rocking.spec.settings_tables import SettingsTable

if TYPE_CHECKING:
    from rocking.reports.body_facts import ImpactAnswer

_DETAILS = ("model", "coefficient", "impulse_ratio", "energy_loss", "friction_demand")
_SHOWN = ("model", "coefficient", "energy_loss", "friction_demand")


class BodyDocument(JobTable):
    """The tables of a file of a response; only body and settings are used."""

    body: dict[str, Any]
    settings: SettingsTable = SettingsTable()
    response: Any = None
    motion: Any = None
    restitution: Any = None


def _stages(answer: Any, path: Path) -> None:
    from rocking.plots import energy_stages_picture, write

    write(energy_stages_picture(answer.impact.body, foot=next(reversed(answer.impact.tables))), path)


EXPORTS = {
    "picture": DRAWN,
    "csv": Export((".csv",), lambda answer, path: answer.write_csv(path)),
    "stages": Export(PICTURES, _stages),
    "space": Export((".glb",), lambda answer, path: answer.write_glb(path)),
}


@options.takes(options.SIZES, before="foot")
def restitution(
    context: typer.Context,
    body: options.BodyFile = None,
    foot: Annotated[str, typer.Option(help="Landing foot: right, left or both.")] = "both",
    restitution: Annotated[
        list[str] | None,
        typer.Option(
            help="Model, such as 0.98*ked or FILE.py:MODEL; repeatable. [default: all models]",
            autocompletion=completion.every_model,
        ),
    ] = None,
    check_identities: Annotated[
        bool, typer.Option("--check-identities", help="Check of each model against the identities of mechanics.")
    ] = False,
    recommend: Annotated[bool, typer.Option("--recommend", help="Recommended model and its evidence.")] = False,
    sets: options.Set = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking restitution`."""
    exports = Exports.of(output, EXPORTS)
    arguments = Arguments(context, "body", "settings")
    if odd := sorted(set(arguments.sets.get("settings", {})) - {"gravity"}):
        raise UsageError(
            "{parameter} {key}: rocking restitution accepts settings.gravity only",
            parameter="--set",
            key=f"settings.{odd[0]}",
        )
    subject, gravity = named_body(arguments, quiet=as_json, in_space="space" in exports.names)
    length = arguments.length or "m"
    if isinstance(subject, Isolated):
        without_restraints(subject)
    if isinstance(subject, Restrained):
        note = "restraints give no impulse at an impact; the coefficients are of the body without restraints."
        print(f"{context.params['body']}: {note}", file=sys.stderr if as_json else sys.stdout)
        subject = subject.body
    if isinstance(subject, Body):
        from rocking.reports.body_facts import ImpactAnswer

        models = None if restitution is None else [_model(text) for text in restitution]
        impact = ImpactAnswer.of(subject, models, foot=foot, gravity=gravity, identities=check_identities)
        answer: Any = PlaneAnswer(impact, length, _recommended(subject, models) if recommend else None, details)
    else:
        from rocking.cli.solids import SolidAnswer

        plane = {"--foot": foot != "both", "--check-identities": check_identities}
        plane["--output stages=FILE"] = "stages" in exports.names
        if stated := [name for name, is_stated in plane.items() if is_stated]:
            raise UsageError(
                "{options} is for 2D bodies; a 3D body rocks about every edge of its base", options=", ".join(stated),
            )  # fmt: skip
        recommendation = _recommended(subject, restitution) if recommend else None
        answer = SolidAnswer.of(subject, restitution, gravity, length, recommendation)
    deliver(answer, exports, as_json=as_json)


def _recommended(subject: Any, models: Any) -> Any:
    from rocking.evidence import recommend

    return recommend(subject, models=models)


def _model(text: str) -> Any:
    from rocking.restitution import model
    from rocking.restitution.from_file import file_of, model_in_file

    return model_in_file(text) if file_of(text) else model(text)


def named_body(arguments: Arguments, *, quiet: bool, in_space: bool = False) -> tuple[Any, float]:
    """Return the body and the gravity [m/s2], also from the input file of a response.

    With `quiet`, notes are printed on standard error. With `in_space`, a 2D body with depth becomes a 3D body.
    """
    word, sets = arguments.options["body"], arguments.sets
    allowed_options = ("foot", "restitution", "check_identities", "min_barrier")
    if file := document_file(arguments.context, word, ("response",), allowed_options, "has a table [body] and "):
        with located(word, "file"):
            body_and_gravity = _made(with_sets(tables_in(file) or {}, sets), InputFiles(file.parent), in_space)
        note = "only body and gravity are used; `rocking simulate` uses the other tables."
        print(f"{file.name}: {note}", file=sys.stderr if quiet else sys.stdout)
        return body_and_gravity
    with hinted(word, None):
        return body_of(arguments, word, in_space)


def body_of(arguments: Arguments, word: str | None, in_space: bool = False) -> tuple[Any, float]:
    """Return the body of a file or of dimensions, and the gravity [m/s2]."""
    tables = {"body": arguments.body_table(word), "settings": arguments.sets.get("settings", {})}
    return _made(tables, CommandFiles(Path()), in_space)


def _made(tables: dict[str, Any], files: InputFiles, in_space: bool) -> tuple[Any, float]:
    document = checked(BodyDocument, tables)
    with located("body"):
        return body_for_motion(document.body, files, in_space=in_space), document.settings.gravity or g


@dataclass(frozen=True)
class PlaneAnswer:
    """Coefficients of restitution of a 2D body with all models."""

    impact: "ImpactAnswer"
    length: str  # unit of lengths
    recommendation: Any = None  # recommended model, with --recommend
    details: bool = False

    def answer(self) -> Answer:
        """Return the body and the coefficient of each model."""
        return self.impact.answer() | recommendation_values(self.recommendation)

    def draw(self) -> Any:
        from rocking.plots import coefficient_picture

        return coefficient_picture(self.impact.body, self.impact.tables)

    def write_csv(self, path: Path) -> None:
        write_records(path, [
            {"foot": foot, **row.answer().values, "warnings": listed(row.warnings)}
            for foot, rows in self.impact.tables.items() for row in rows
        ])  # fmt: skip

    def show(self, page: Page) -> None:
        from rocking.evidence._coefficient_table import outside_evidence

        body, answer = self.impact.body, self.answer()
        own = answer.quantities if self.details else {**answer.quantities, **closely(coefficient=".3f")}
        display = Display(self.length, own=own)
        names = ("slenderness_ratio", *SIDE, "uplift_acceleration")
        page.line(body_line(body, answer["body"], display, ("centre", *(names if body.is_symmetric else ()))))
        for foot, side in {} if body.is_symmetric else answer["body"]["sides"].items():
            page.line(f"{foot} foot: {', '.join(f'{label} {text}' for label, text in display.lines(side, names))}")
        for line in body.assumed:
            page.line(line)
        if body.is_symmetric and (outside := outside_evidence(body)):
            page.line(outside)
        is_short = self.recommendation is not None and not self.details
        if not is_short:
            self._show_coefficients(page, answer, display)
        if self.details:
            page.line("k: impulse position / half base; friction demand: at the impact")
            for foot, fractions in answer["ked_energy_fractions"].items():
                remaining = ", ".join(f"{100.0 * fraction:.1f} % {stage}" for stage, fraction in fractions.items())
                page.line(f"KED, kinetic energy at the {foot} foot: {remaining}.")
        for name, report in self.impact.identities.items():
            broken = [check for check in report if not check.holds]
            page.line(f"\n{name}: {'keeps all identities' if not broken else 'breaks identities'}", "bold")
            for check in broken:
                page.line(f"  {check.sentence}")
        show_recommendation(page, self.recommendation, details=self.details)
        if is_short:
            page.line("All coefficients, and the evidence of the recommendation: --details")
        elif not self.details:
            page.line("Recommended model: --recommend    Impulse position and energy: --details")

    def _show_coefficients(self, page: Page, answer: Answer, display: Display) -> None:
        """Write one table of coefficients per landing foot."""
        for foot, rows in answer["coefficients"].items():
            page.line()
            where = f" (landing on the {foot} foot)" if len(answer["coefficients"]) > 1 else ""
            page.line(f"Coefficient of restitution, velocity after / velocity before{where}", "bold")
            records, names = [row.values for row in rows], _DETAILS if self.details else _SHOWN
            page.rows(records, names, display, bold=_bold(records), most=len(rows), dense=False)
            page.warn(dict.fromkeys(f"{row['model']}: {warning}" for row in rows for warning in row["warnings"]))
        page.line("95 %: interval for one measured body (39 published measurements)")


def _bold(records: list[dict[str, Any]]) -> set[int]:
    return {k for k, row in enumerate(records) if row["model"] == "calibrated"}
