"""What `rocking cor` prints, writes and draws of a body in space."""

import json
import math
from pathlib import Path
from typing import Any

from rocking.bodies.formats import SolidFile
from rocking.bodies.solid import RoundBase
from rocking.cli.shared_options import in_unit
from rocking.cli.solid_impact import EdgeImpact, SolidAnswer, edge_facts, solid_facts
from rocking.conventions import LENGTH_UNITS

_MOST = 12
"""Corners of a base that are printed."""


def show(answer: SolidAnswer, length: str = "m") -> None:
    """Print body, repairs, base, and edges with the coefficients of every model."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    show_body(answer.file, length)
    console.print()
    console.print("Edges it may rock about" if _numbered(answer) else "Directions it may be tipped in", style="bold")
    console.print(_geometry(answer.edges, length))
    console.print()
    console.print("Coefficient of restitution, angular velocity after / before", style="bold")
    console.print(_coefficients(answer.edges))
    if answer.left_out:
        console.print(f"{answer.left_out} edges that are less slender are left out", style="dim")
    for sentence in _flags(answer):
        console.print(f"! {sentence}", style="yellow", markup=False)


def show_body(file: SolidFile, length: str = "m") -> None:
    """Print mass, centre, base and repairs of a body in space."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    solid = file.solid
    x, y, z = (solid.centre - [0.0, 0.0, solid.ground]).tolist()
    size = " x ".join(f"{side / LENGTH_UNITS[length]:.4g}" for side in (solid.box[1] - solid.box[0]).tolist())
    parts = len(solid.local_parts)
    console.print(
        f"{file.name}: {size} {length}, {parts} part{'s' * (parts > 1)}, mass {solid.mass:.6g} kg, "
        f"volume {solid.volume:.6g} m3",
        markup=False,
    )
    middle = f"x = {_rounded(x, length)} {length}, y = {_rounded(y, length)} {length}"
    console.print(f"centre of mass at {middle}, {in_unit(z, length, '.5g')} above the ground")
    console.print(_base(file, length), markup=False)
    for sentence in solid.assumed:
        console.print(sentence, markup=False)
    for sentence in file.repairs:
        console.print(f"! {sentence}", style="yellow", markup=False)


def as_json(answer: SolidAnswer) -> str:
    """Return everything as JSON.

    Returns one object; SI units, named in the keys where a quantity has one.
    """
    return json.dumps(solid_facts(answer), indent=2, allow_nan=False)


def write_csv(answer: SolidAnswer, path: Path) -> None:
    """Write edges and coefficients as one CSV file."""
    from rocking.tables import Column, Table, text_array, to_csv

    records = [_record(edge, name) for edge in answer.edges for name in edge.results]
    columns = {name: Column(text_array([record[name] for record in records]), "") for name in records[0]}
    to_csv(Table("coefficient", columns), path)


def draw(file: SolidFile, path: Path) -> None:
    """Draw the body on its base."""
    from rocking.plots.solid import solid_picture
    from rocking.plots.style import write

    write(solid_picture(file.solid), path)


def _record(edge: EdgeImpact, name: str) -> dict[str, Any]:
    facts = edge_facts(edge)
    found = facts.pop("coefficients")[name]
    start, end = facts.pop("from_m"), facts.pop("to_m")
    places = {"from_x_m": start[0], "from_y_m": start[1], "to_x_m": end[0], "to_y_m": end[1]}
    return {
        **facts,
        **places,
        "model": name,
        "coefficient_of_restitution": found["coefficient"],
        "energy_ratio": found["energy_ratio"],
        "flags": " ".join(found["flags"]),
    }


def _numbered(answer: SolidAnswer) -> bool:
    return not isinstance(answer.file.solid.base, RoundBase)


def _base(file: SolidFile, length: str) -> str:
    base = file.solid.base
    if isinstance(base, RoundBase):
        x, y = base.centre.tolist()
        middle = f"({_rounded(x, length)}, {_rounded(y, length)}) {length}"
        return f"base: a circle of radius {in_unit(base.radius, length, '.5g')} about {middle}"
    vertices = getattr(base, "vertices", None)
    points = [] if vertices is None else vertices.tolist()
    listed = ", ".join(f"({_rounded(x, length)}, {_rounded(y, length)})" for x, y in points[:_MOST])
    return f"base: {len(points)} corners, {listed}{' ...' if len(points) > _MOST else ''} {length}"


def _rounded(place: float, length: str) -> str:
    # a nanometre is rounding
    return f"{(round(place, 9) + 0.0) / LENGTH_UNITS[length]:.5g}"


def _geometry(edges: tuple[EdgeImpact, ...], length: str) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    places = (f"from (x, y) {length}", f"to (x, y) {length}")
    for word in ("edge", *places, "alpha rad", "deg", "h/b", f"R {length}", "p rad/s"):
        table.add_column(word, justify="left" if word == "edge" else "right")
    for edge in edges:
        ends = (f"{_rounded(x, length)}, {_rounded(y, length)}" for x, y in edge.ends)
        table.add_row(
            edge.name,
            *ends,
            f"{edge.slenderness_angle:.4f}",
            f"{math.degrees(edge.slenderness_angle):.2f}",
            f"{1.0 / math.tan(edge.slenderness_angle):.3f}",
            f"{edge.semi_diagonal / LENGTH_UNITS[length]:.{4 if length == 'm' else 2}f}",
            f"{edge.frequency_parameter:.4f}",
        )
    return table


def _coefficients(edges: tuple[EdgeImpact, ...]) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("from edge")
    table.add_column("onto")
    for name in edges[0].results:
        table.add_column(name, justify="right")
    for edge in edges:
        found = (f"{one.coefficient:.6f}{' !' if one.flags else ''}" for one in edge.results.values())
        table.add_row(edge.name, edge.onto, *found)
    return table


def _flags(answer: SolidAnswer) -> list[str]:
    told: dict[tuple[str, str], list[str]] = {}
    for edge in answer.edges:
        for name, found in edge.results.items():
            for flag in found.flags:
                told.setdefault((name, flag.value), []).append(edge.name)
    return [
        f"{name}, from {', '.join(edges[:_MOST])}{' ...' if len(edges) > _MOST else ''}: {sentence}"
        for (name, sentence), edges in told.items()
    ]
