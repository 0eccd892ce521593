"""`rocking inventory`: which objects of a list stay standing, the worst first."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_SHAKING = "How it shakes"
_OUTPUT = "Output"


def inventory(
    objects: Annotated[
        Path, typer.Argument(help="CSV file with the columns name, width_cm, depth_cm, height_cm and more.")
    ],
    pga: Annotated[
        str | None,
        typer.Option(help="Peak ground acceleration of every motion: 0.3g, 2.9m/s2.", rich_help_panel=_SHAKING),
    ] = None,
    pgv: Annotated[
        str | None,
        typer.Option(help="Peak ground velocity in its place: 25cm/s, 0.25m/s.", rich_help_panel=_SHAKING),
    ] = None,
    record: Annotated[
        list[str] | None,
        typer.Option(help="Record file, again for more; as recorded without a level.", rich_help_panel=_SHAKING),
    ] = None,
    synthetic: Annotated[
        str | None,
        typer.Option(
            help="Family of motions: firm-ground (default), soft-ground, kanai-tajimi, point-source, pulse-like.",
            rich_help_panel=_SHAKING,
        ),
    ] = None,
    count: Annotated[
        int | None, typer.Option(help="How many synthetic motions, 200 if not given.", rich_help_panel=_SHAKING)
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Seed of the synthetic motions, 1 if not given.", rich_help_panel=_SHAKING)
    ] = None,
    restitution: options.Restitution = "ked",
    encoding: Annotated[
        str, typer.Option(help="Encoding of the CSV file; cp1252 for some spreadsheets.")
    ] = "utf-8-sig",
    format: options.Format = None,
    units: options.RecordUnits = None,
    time_step: options.TimeStep = None,
    component: options.Component = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the report: HTML, PDF, Excel, CSV, JSON.", rich_help_panel=_OUTPUT),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print which objects of a list stay standing at a level of shaking, the worst first, in plain words."""
    from rocking.cli import inventory_output
    from rocking.cli.inventory_output import hazard_from

    told = {"format": format, "units": units, "time_step": time_step, "component": component}
    answer = inventory_output.answer(
        objects,
        encoding,
        lambda progress: hazard_from(record, synthetic, pga, pgv, count=count, seed=seed, told=told, progress=progress),
        restitution,
    )
    written, left_out = inventory_output.write(answer, out)
    if as_json:
        print(inventory_output.as_json(answer))
        return
    inventory_output.show(answer)
    for path in written:
        print(f"wrote {path}")
    for sentence in left_out:
        print(f"left out: {sentence}")
