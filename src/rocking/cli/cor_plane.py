"""`rocking cor` of plane bodies: what it computes, prints and writes."""

import json
import math
import sys
from pathlib import Path
from typing import Any

from rocking.bodies import Body
from rocking.cli.inputs import body_from, models_from, refuse, spelt
from rocking.cli.options import in_unit
from rocking.conventions import FEET, Foot, g
from rocking.errors import InvalidValueError
from rocking.evidence._coefficient_table import CoefficientRow, outside_evidence
from rocking.reports.body_facts import ImpactAnswer, impact_facts
from rocking.restitution import energy_balance
from rocking.spec.construction import body_of
from rocking.spec.document import SettingsTable
from rocking.spec.fields import JobTable
from rocking.spec.reading import InputFiles, is_response, located, read_text, validated


class BodyOfDocument(JobTable):
    """The tables of such a file of which only the body and the settings are looked at."""

    body: dict[str, Any]
    settings: SettingsTable = SettingsTable()
    response: Any = None
    motion: Any = None
    restitution: Any = None


def body_and_gravity(path: Path, size: dict[str, object]) -> tuple[Body, float | None]:
    """Return the body of a file with a table [response], and the gravity that it states.

    Returns gravity: acceleration of gravity, None if the file states none [m/s2].
    """
    given = [name for name, value in spelt(size).items() if value is not None]
    if given:
        raise InvalidValueError(f"{path} has a table [body] and says everything itself, so it takes no {given[0]}")
    with located(str(path)):
        document = validated(BodyOfDocument, read_text(path))
        with located("body"):
            body = body_of(document.body, InputFiles(path.parent))
    return body, document.settings.gravity


def sentence(path: Path) -> str:
    """Return what is not used of such a file."""
    return f"{path.name}: body and gravity are taken from it; everything else it says is for `rocking simulate`."


def answer_of_plane_body(
    body: Path | None,
    size: dict[str, Any],
    mesh: dict[str, Any],
    asked: dict[str, Any],
    files: dict[str, Path | None],
    *,
    models: list[str] | None,
    gravity: float | None,
    as_json: bool,
) -> None:
    """Print, write and draw the coefficients of a plane body.

    gravity: acceleration of gravity; that of the file or the standard one if not given [m/s2].
    """
    refuse("a plane body is no mesh", spelt(mesh))
    made, stated = _body(body, size, as_json=as_json)
    chosen = next((one for one in (gravity, stated) if one is not None), g)
    found = ImpactAnswer.of(made, models_from(models), gravity=chosen, **asked)
    csv, picture, stages = files["csv"], files["picture"], files["stages"]
    if csv is not None:
        write_csv(found, csv)
    if picture is not None:
        draw(found, picture)
    if stages is not None:
        draw_stages(found, stages)
    if as_json:
        print(as_text(found))
        return
    show(found, size["unit"] or "m")
    for path in filter(None, files.values()):
        print(f"wrote {path}")


def _body(file: Path | None, size: dict[str, Any], *, as_json: bool) -> tuple[Body, float | None]:
    """Return the body, and the gravity of a file that says a whole response; JSON stays alone on its stream."""
    if file is None or not is_response(file):
        return body_from(file, **size), None

    print(sentence(file), file=sys.stderr if as_json else sys.stdout)
    return body_and_gravity(file, size)


def show(answer: ImpactAnswer, length: str = "m") -> None:
    """Print body, tables and warnings."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    for line in _body_lines(answer, length):
        console.print(line, markup=False)
    for foot, rows in answer.tables.items():
        console.print()
        where = f" (landing on the {foot} foot)" if len(answer.tables) > 1 else ""
        console.print(f"Coefficient of restitution, velocity after / velocity before{where}", style="bold")
        console.print(_table(rows))
        for text in dict.fromkeys(f"{row.name}: {warning}" for row in rows for warning in row.warnings):
            console.print(f"! {text}", style="yellow", markup=False)
    console.print(
        "+- is the 95 % interval of one measured body, from each model's misfit to 39 published measurements;"
    )
    console.print(
        "k: implied impulse position over half base; loss: share of kinetic energy; friction: needed at impact."
    )
    for foot in answer.tables:
        shares = energy_balance(answer.body, onto=foot).shares
        kept = ", ".join(f"{100.0 * share:.1f} % {stage}" for stage, share in shares.items())
        console.print(f"KED's kinetic energy onto the {foot} foot: {kept}.", markup=False)
    for name, report in answer.identities.items():
        broken = [check for check in report if not check.holds]
        console.print(f"\n{name}: {'keeps all identities' if not broken else 'breaks identities'}", style="bold")
        for check in broken:
            console.print(f"  {check.sentence}", markup=False)


def as_text(answer: ImpactAnswer) -> str:
    """Return everything as JSON.

    Returns one object; SI units, named in the keys where a quantity has one.
    """
    return json.dumps(impact_facts(answer), indent=2, allow_nan=False)


def write_csv(answer: ImpactAnswer, path: Path) -> None:
    """Write the tables as one CSV file."""
    from rocking.tables import Column, Table, text_array, to_csv

    records = [
        {"onto": foot, **row.as_dict(), "warnings": "; ".join(row.warnings)}
        for foot, rows in answer.tables.items()
        for row in rows
    ]
    columns = {name: Column(text_array([record[name] for record in records]), "") for name in records[0]}
    to_csv(Table("coefficient", columns), path)


def draw(answer: ImpactAnswer, path: Path) -> None:
    """Draw the body and its coefficients against the published measurements."""
    from rocking.plots import coefficient_picture, write

    write(coefficient_picture(answer.body, answer.tables), path)


def draw_stages(answer: ImpactAnswer, path: Path) -> None:
    """Draw the three stages of KED over the body."""
    from rocking.plots import energy_stages_picture, write

    write(energy_stages_picture(answer.body, onto=next(reversed(answer.tables))), path)


def _body_lines(answer: ImpactAnswer, length: str) -> list[str]:
    body = answer.body
    x, y = (in_unit(place, length) for place in body.centre)
    lines = [f"{type(body).__name__}: mass {body.mass:.4g} kg, centre of mass at x = {x}, y = {y}"]
    lines += body.assumed
    feet: tuple[Foot, ...] = ("right",) if body.is_symmetric else FEET
    for foot in feet:
        side = body.side(foot, answer.gravity)
        where = "" if body.is_symmetric else f"{foot} foot: "
        lines.append(
            f"{where}h/b = {side.slenderness_ratio:.4g}, alpha = {side.slenderness_angle:.4g} rad "
            f"({math.degrees(side.slenderness_angle):.3g} deg), R = {in_unit(side.semi_diagonal, length)}, "
            f"p = {side.frequency_parameter:.4g} rad/s, "
            f"uplift at {side.uplift_acceleration:.3g} m/s2 ({side.uplift_acceleration / answer.gravity:.3g} g)"
        )
    if body.is_symmetric and (sentence := outside_evidence(body)):
        lines.append(sentence)
    return lines


def _table(rows: tuple[CoefficientRow, ...]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("model")
    for word in ("r", "+-", "k", "loss", "friction"):
        table.add_column(word, justify="right")
    table.add_column("")
    for row in rows:
        fact = row.implication
        table.add_row(
            row.name,
            f"{row.coefficient:.6f}",
            f"{row.half_interval:.3f}",
            f"{fact.impulse_ratio:.3f}",
            f"{100.0 * fact.energy_loss:.2f} %",
            f"{fact.friction_demand:.3f}",
            "!" if row.warnings else "",
            style="bold" if row.name == "calibrated" else None,
        )
    return table
