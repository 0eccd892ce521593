"""What `rocking cor` prints, writes and draws."""

import csv
import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FEET, Foot
from rocking.errors import InvalidValueError
from rocking.evidence.coefficient_table import CoefficientRow, coefficient_table, default_models, outside_evidence
from rocking.restitution import IdentityCheck, RestitutionModel, energy_ledger, identity_report


@dataclass(frozen=True, slots=True)
class Answer:
    """The tables of one body, one for each foot that was asked for.

    Parameters
    ----------
    body : Body
        The body.
    tables : dict
        Foot to rows.
    gravity : float
        Acceleration of gravity [m/s2].
    identities : dict of str to tuple of IdentityCheck
        Model to its checks; empty if not asked for.
    """

    body: Body
    tables: dict[Foot, tuple[CoefficientRow, ...]]
    gravity: float
    identities: dict[str, tuple[IdentityCheck, ...]]

    @classmethod
    def of(
        cls,
        body: Body,
        models: list[RestitutionModel] | None,
        *,
        onto: str,
        eta: float,
        gravity: float,
        identities: bool,
    ) -> "Answer":
        """Compute the tables.

        Parameters
        ----------
        body : Body
            The body.
        models : list of RestitutionModel, optional
            Models to show; all if none.
        onto : str
            ``"left"``, ``"right"`` or ``"both"``; both is one table where the sides are equal.
        eta : float
            Interface factor [-].
        gravity : float
            Acceleration of gravity [m/s2].
        identities : bool
            Whether to try the identities of mechanics.

        Returns
        -------
        Answer
            Everything that is printed.

        Raises
        ------
        InvalidValueError
            If `onto` or `gravity` is not allowed.
        """
        if onto not in (*FEET, "both"):
            raise InvalidValueError(f'onto must be "left", "right" or "both", got {onto!r}')
        gravity = checks.positive("gravity", gravity, "m/s2")
        tables = {foot: coefficient_table(body, models, onto=foot, eta=eta) for foot in FEET if onto in (foot, "both")}
        if len(tables) == 2 and _same(tables["left"], tables["right"]):
            del tables["left"]
        foot = next(reversed(tables))
        tried = (models or default_models()) if identities else []
        return cls(body, tables, gravity, {each.label: identity_report(body, each, onto=foot) for each in tried})


def show(answer: Answer) -> None:
    """Print body, tables and warnings.

    Parameters
    ----------
    answer : Answer
        What `Answer.of` computed.
    """
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    for line in _body_lines(answer):
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
        shares = energy_ledger(answer.body, onto=foot).shares
        kept = ", ".join(f"{100.0 * share:.1f} % {stage}" for stage, share in shares.items())
        console.print(f"KED's kinetic energy onto the {foot} foot: {kept}.", markup=False)
    for name, report in answer.identities.items():
        broken = [check for check in report if not check.holds]
        console.print(f"\n{name}: {'keeps all identities' if not broken else 'breaks identities'}", style="bold")
        for check in broken:
            console.print(f"  {check.sentence}", markup=False)


def as_json(answer: Answer) -> str:
    """Return everything as JSON.

    Parameters
    ----------
    answer : Answer
        What `Answer.of` computed.

    Returns
    -------
    str
        One object; SI units, named in the keys where a quantity has one.
    """
    body = answer.body
    return json.dumps(
        {
            "body": {
                "kind": type(body).__name__,
                "mass_kg": body.mass,
                "centre_m": body.centre,
                "feet_m": body.feet,
                "moment_of_inertia_kg_m2": body.moment_of_inertia,
                "gravity_m_s2": answer.gravity,
                "sides": {foot: _side_facts(answer, foot) for foot in FEET},
            },
            "ked_energy_shares": {foot: energy_ledger(body, onto=foot).shares for foot in answer.tables},
            "coefficients": {foot: [row.as_dict() for row in rows] for foot, rows in answer.tables.items()},
            "identities": {
                name: {check.name: check.holds for check in report} for name, report in answer.identities.items()
            },
        },
        indent=2,
        allow_nan=False,
    )


def write_csv(answer: Answer, path: Path) -> None:
    """Write the tables as one CSV file.

    Parameters
    ----------
    answer : Answer
        What `Answer.of` computed.
    path : Path
        File to write.
    """
    records = [
        {"onto": foot, **row.as_dict(), "warnings": "; ".join(row.warnings)}
        for foot, rows in answer.tables.items()
        for row in rows
    ]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=list(records[0]))
        writer.writeheader()
        writer.writerows(records)


def draw(answer: Answer, path: Path) -> None:
    """Draw the body and its coefficients against the published measurements.

    Parameters
    ----------
    answer : Answer
        What `Answer.of` computed.
    path : Path
        File to write; its suffix says the format.
    """
    from rocking.plots import coefficient_picture, write

    foot, rows = next(reversed(answer.tables.items()))
    write(coefficient_picture(answer.body, rows, onto=foot), path)


def draw_stages(answer: Answer, path: Path) -> None:
    """Draw the three stages of KED over the body.

    Parameters
    ----------
    answer : Answer
        What `Answer.of` computed.
    path : Path
        File to write; its suffix says the format.
    """
    from rocking.plots import figure_2, write

    write(figure_2(answer.body, onto=next(reversed(answer.tables))), path)


def _same(left: tuple[CoefficientRow, ...], right: tuple[CoefficientRow, ...]) -> bool:
    pairs = zip(left, right, strict=True)
    return all(math.isclose(a.coefficient, b.coefficient, rel_tol=1e-12, abs_tol=1e-15) for a, b in pairs)


def _side_facts(answer: Answer, foot: Foot) -> dict[str, float]:
    side = answer.body.side(foot, answer.gravity)
    return {
        "slenderness_ratio": side.slenderness_ratio,
        "slenderness_angle_rad": side.slenderness_angle,
        "semi_diagonal_m": side.semi_diagonal,
        "frequency_parameter_rad_s": side.frequency_parameter,
        "uplift_acceleration_m_s2": side.uplift_acceleration,
    }


def _body_lines(answer: Answer) -> list[str]:
    body = answer.body
    x, y = body.centre
    lines = [f"{type(body).__name__}: mass {body.mass:.4g} kg, centre of mass at x = {x:.4g} m, y = {y:.4g} m"]
    feet: tuple[Foot, ...] = ("right",) if body.is_symmetric else FEET
    for foot in feet:
        side = body.side(foot, answer.gravity)
        where = "" if body.is_symmetric else f"{foot} foot: "
        lines.append(
            f"{where}h/b = {side.slenderness_ratio:.4g}, alpha = {side.slenderness_angle:.4g} rad "
            f"({math.degrees(side.slenderness_angle):.3g} deg), R = {side.semi_diagonal:.4g} m, "
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
