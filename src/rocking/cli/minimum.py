"""`rocking minimum`: every acceleration at which a body begins or ceases to overturn under a motion."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_HOW = "How it is computed"
_OUTPUT = "Output"


def minimum(
    body: options.BodyFile = None,
    record: options.Record = None,
    motion: options.Motion = None,
    restitution: options.Restitution = "ked",
    lowest: Annotated[
        str | None, typer.Option(help="Where to begin: 0.1g, 1m/s2; what lifts the body if not given.")
    ] = None,
    highest: Annotated[
        str | None, typer.Option(help="Where to end: 5g; 50 times what lifts the body if not given.")
    ] = None,
    points: Annotated[int, typer.Option(help="First samples, in equal ratios.", rich_help_panel=_HOW)] = 400,
    levels: Annotated[
        int, typer.Option(help="How often suspicious intervals are halved, 0 to 12.", rich_help_panel=_HOW)
    ] = 4,
    width: options.Width = None,
    height: options.Height = None,
    depth: options.Depth = None,
    density: options.Density = None,
    angle: options.Angle = None,
    semi_diagonal: options.SemiDiagonal = None,
    format: options.Format = None,
    units: options.Units = None,
    time_step: options.TimeStep = None,
    component: options.Component = None,
    vertical: options.Vertical = None,
    vertical_file: options.VerticalFile = None,
    linear: options.Linear = False,
    engine: options.Engine = "auto",
    gravity: options.Gravity = None,
    threads: options.Threads = None,
    picture: Annotated[
        Path | None, typer.Option(help="Draw peak rotation over amplitude (.png, .svg, .pdf).", rich_help_panel=_OUTPUT)
    ] = None,
    csv: Annotated[Path | None, typer.Option(help="Write a line for every crossing.", rich_help_panel=_OUTPUT)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print all peak ground accelerations at which a body begins or ceases to overturn, not the first alone."""
    from rocking.cli import minimum_output
    from rocking.cli.output import body_and_motion_of, check_files, settings_from
    from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS

    check_files(picture, csv)
    unit, units = options.units_of(units, LENGTH_UNITS, ACCELERATION_UNITS)
    size = {"width": width, "height": height, "depth": depth, "density": density}
    told = {"format": format, "units": units, "time_step": time_step, "component": component}
    answer = minimum_output.MinimumAnswer.of(
        *body_and_motion_of(
            (body, record, motion),
            {**size, "angle": angle, "semi_diagonal": semi_diagonal, "unit": unit},
            {**told, "vertical": vertical, "vertical_file": vertical_file},
        ),
        restitution,
        {**minimum_output.search_from(lowest, highest), "points": points, "levels": levels},
        settings_from(gravity, engine, linear, threads),
        quiet=as_json,
    )
    written = minimum_output.write(answer, picture, csv)
    if as_json:
        print(minimum_output.as_json(answer))
        return
    minimum_output.show(answer, unit or "m", units or "m/s2")
    for path in written:
        print(f"wrote {path}")
