"""`rocking map`: how a body ends over two parameters of it and its motion."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_OUTPUT = "Output"
_AXIS = (
    "NAME=FIRST:LAST:COUNT, with :log for equal ratios, or NAME=A,B,C; with units where the axis has one: "
    "pga=0.1g:1g:50, slenderness_angle=5deg:20deg:16."
)


def map(
    body: options.BodyFile = None,
    record: options.Record = None,
    motion: options.Motion = None,
    x: Annotated[str, typer.Option(help=_AXIS)] = "frequency_ratio=0.5:10:100",
    y: Annotated[str, typer.Option(help="The same for the upright axis.")] = "amplitude_ratio=1:12:100",
    restitution: Annotated[
        list[str] | None,
        typer.Option(help="Model as in rocking models, or a coefficient; again for more, to compare; ked if none."),
    ] = None,
    refine: Annotated[
        int | None, typer.Option(help="Levels of refinement along boundaries, each of half the spacing.")
    ] = None,
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
        Path | None, typer.Option(help="Draw the first map (.png, .svg, .pdf).", rich_help_panel=_OUTPUT)
    ] = None,
    csv: Annotated[Path | None, typer.Option(help="Write a line for every cell.", rich_help_panel=_OUTPUT)] = None,
    netcdf: Annotated[
        Path | None, typer.Option(help="Write everything, refined points too, as netCDF.", rich_help_panel=_OUTPUT)
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print how a body ends over two parameters: shares of each way to overturn, safe islands, and where it begins."""
    from rocking.cli import map_output
    from rocking.cli.output import body_and_motion_of, check_files, settings_from
    from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS

    check_files(picture, csv, netcdf)
    unit, units = options.units_of(units, LENGTH_UNITS, ACCELERATION_UNITS)
    size = {"width": width, "height": height, "depth": depth, "density": density}
    told = {"format": format, "units": units, "time_step": time_step, "component": component}
    question = map_output.MapQuestion.of(
        *body_and_motion_of(
            (body, record, motion),
            {**size, "angle": angle, "semi_diagonal": semi_diagonal, "unit": unit},
            {**told, "vertical": vertical, "vertical_file": vertical_file},
        ),
        (x, y),
        restitution,
        refine,
        settings_from(gravity, engine, linear, threads),
        drawn=picture is not None,
    )
    answer = question.answered(quiet=as_json)
    written = map_output.write(answer, picture, csv, netcdf)
    if as_json:
        print(map_output.as_json(answer))
        return
    map_output.show(answer, unit or "m")
    for path in written:
        print(f"wrote {path}")
