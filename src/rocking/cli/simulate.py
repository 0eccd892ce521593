"""`rocking simulate`: how a body rocks under a record or a pulse, or when let go."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_OUTPUT = "Output"
_SPACE = "Body in space"
_CONTACT = "Sliding and hopping"


def simulate(
    context: typer.Context,
    body: options.BodyFile = None,
    record: options.Record = None,
    motion: options.Motion = None,
    free: Annotated[
        float | None, typer.Option(help="No motion: let the body go at this share of its slenderness angle.")
    ] = None,
    restitution: options.Restitution = "ked",
    scale: Annotated[float, typer.Option(help="Factor on the acceleration of the ground.")] = 1.0,
    friction: Annotated[
        float | None, typer.Option(help="Coefficient of friction between body and ground; 0.5 is assumed.")
    ] = None,
    contact: Annotated[
        bool,
        typer.Option("--contact", help="Let it slide, hop and fly with --friction.", rich_help_panel=_CONTACT),
    ] = False,
    bounce: Annotated[
        float | None,
        typer.Option(help="Newton's coefficient of normal velocities, from 0.", rich_help_panel=_CONTACT),
    ] = None,
    motion_y: Annotated[
        str | None, typer.Option(help="Motion along y; the other one is along x.", rich_help_panel=_SPACE)
    ] = None,
    motion_z: Annotated[str | None, typer.Option(help="Motion along z, upwards.", rich_help_panel=_SPACE)] = None,
    component_y: Annotated[
        str | None, typer.Option(help="Component of the file of --motion-y.", rich_help_panel=_SPACE)
    ] = None,
    component_z: Annotated[
        str | None, typer.Option(help="Component of the file of --motion-z.", rich_help_panel=_SPACE)
    ] = None,
    up: options.Up = None,
    fill_holes: options.FillHoles = False,
    base_tolerance: options.BaseTolerance = None,
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
    picture: Annotated[
        Path | None, typer.Option(help="Draw the response (.png, .svg, .pdf).", rich_help_panel=_OUTPUT)
    ] = None,
    animation: Annotated[
        Path | None, typer.Option(help="Show it moving: a web page (.html) or a .gif.", rich_help_panel=_OUTPUT)
    ] = None,
    csv: Annotated[Path | None, typer.Option(help="Write the samples for Excel.", rich_help_panel=_OUTPUT)] = None,
    mat: Annotated[Path | None, typer.Option(help="Write the samples for MATLAB.", rich_help_panel=_OUTPUT)] = None,
    netcdf: Annotated[
        Path | None, typer.Option(help="Write samples and impacts as netCDF.", rich_help_panel=_OUTPUT)
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print how a body rocks under a ground motion, whether it overturns, and whether the model of impact decides."""
    from rocking.cli import simulate_output
    from rocking.cli.simulate_output import ResponseFiles
    from rocking.cli.simulate_question import SimulateOptions

    asked = SimulateOptions.of(context)
    files = ResponseFiles(picture, animation, csv, mat, netcdf)
    if asked.solid is not None:
        simulate_output.answer_of_solid(asked, files, as_json=as_json)
    elif contact:
        simulate_output.answer_of_contact(asked, files, as_json=as_json)
    else:
        simulate_output.answer_of_pure_rocking(asked, files, as_json=as_json)
