"""`rocking simulate`: how a body rocks under a record or a pulse, or when let go."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import shared_options as shared

_OUTPUT = "Output"


def simulate(
    context: typer.Context,
    body: shared.BodyFile = None,
    record: shared.Record = None,
    motion: shared.Motion = None,
    free: Annotated[
        float | None, typer.Option(help="No motion: let the body go at this share of its slenderness angle.")
    ] = None,
    restitution: shared.Restitution = "ked",
    scale: Annotated[float, typer.Option(help="Factor on the acceleration of the ground.")] = 1.0,
    friction: Annotated[float, typer.Option(help="Coefficient of friction between body and ground.")] = 0.5,
    width: shared.Width = None,
    height: shared.Height = None,
    depth: shared.Depth = None,
    density: shared.Density = None,
    angle: shared.Angle = None,
    semi_diagonal: shared.SemiDiagonal = None,
    unit: shared.Unit = None,
    format: shared.Format = None,
    units: shared.Units = None,
    time_step: shared.TimeStep = None,
    component: shared.Component = None,
    vertical: shared.Vertical = None,
    vertical_file: shared.VerticalFile = None,
    linear: shared.Linear = False,
    engine: shared.Engine = "auto",
    gravity: shared.Gravity = None,
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
    as_json: shared.AsJson = False,
) -> None:
    """Print how a body rocks under a ground motion, whether it overturns, and whether the model of impact decides."""
    from rocking.cli import simulate_document, simulate_json, simulate_output, simulate_page
    from rocking.cli.body_options import body_from
    from rocking.cli.simulate_question import body_and_motion, motion_asked, question_of

    files = simulate_output.Files(picture, animation, csv, mat, netcdf)
    document = simulate_document.path_of(context)
    if document is not None:
        answer = simulate_document.answer_of(document)
    else:
        sized = any(value is not None for value in (width, height, angle, semi_diagonal))
        file, word = body_and_motion(body, record, motion, sized=sized, free=free is not None)
        subject = body_from(
            file,
            width=width,
            height=height,
            depth=depth,
            density=density,
            angle=angle,
            semi_diagonal=semi_diagonal,
            unit=unit,
        )
        told = {
            "format": format,
            "units": units,
            "time_step": time_step,
            "component": component,
            "vertical": vertical,
            "vertical_file": vertical_file,
        }
        question = question_of(
            subject,
            motion_asked(word, told, scale),
            free,
            scale=scale,
            gravity=gravity,
            engine=engine,
            linear=linear,
            friction=friction,
        )
        answer = simulate_output.Answer.of(question, restitution)
    written = files.write(answer)
    if as_json:
        print(simulate_json.as_json(answer))
    else:
        simulate_page.show(answer)
        for path in written:
            print(f"wrote {path}")
