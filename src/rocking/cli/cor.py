"""`rocking cor`: the coefficient of restitution of a body under every model."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_OUTPUT = "Output"


def cor(
    body: Annotated[
        Path | None,
        typer.Argument(help="Body file: TOML, or WKT, GeoJSON, DXF, or a mesh STL, OBJ, PLY with --units, or GLB."),
    ] = None,
    width: options.Width = None,
    height: options.Height = None,
    depth: options.Depth = None,
    density: options.Density = None,
    angle: options.Angle = None,
    semi_diagonal: options.SemiDiagonal = None,
    units: options.Units = None,
    up: options.Up = None,
    fill_holes: options.FillHoles = False,
    base_tolerance: options.BaseTolerance = None,
    onto: Annotated[str, typer.Option(help="Foot on which the body lands: right, left or both.")] = "both",
    model: Annotated[
        list[str] | None,
        typer.Option(help="Model, repeatable: ked, 0.98*ked, shifted-impulse:k=0.6, my_file.py:MyModel; or ked-3d."),
    ] = None,
    eta: Annotated[float, typer.Option(help="Interface factor in (0, 1] on every model.")] = 1.0,
    gravity: Annotated[float | None, typer.Option(help=r"Acceleration of gravity \[m/s2].")] = None,
    identities: Annotated[
        bool, typer.Option("--identities", help="Also try the identities of mechanics on every model.")
    ] = False,
    as_json: options.AsJson = False,
    csv: Annotated[Path | None, typer.Option(help="Write the table for Excel.", rich_help_panel=_OUTPUT)] = None,
    picture: Annotated[
        Path | None,
        typer.Option(help="Draw the body against the published data (.png, .svg, .pdf).", rich_help_panel=_OUTPUT),
    ] = None,
    stages: Annotated[
        Path | None, typer.Option(help="Draw the three energy stages of KED over the body.", rich_help_panel=_OUTPUT)
    ] = None,
) -> None:
    """Print the coefficient of restitution of a body under every model, with its interval and what it implies."""
    from rocking.cli import cor_plane, cor_solid
    from rocking.cli.inputs import is_solid
    from rocking.conventions import LENGTH_UNITS

    sizes = {"width": width, "height": height, "depth": depth, "angle": angle, "semi_diagonal": semi_diagonal}
    mesh = {"up": up, "fill_holes": fill_holes, "base_tolerance": base_tolerance}
    (unit,) = options.units_of(units, LENGTH_UNITS)
    told = {"density": density, "unit": unit}
    files = {"csv": csv, "picture": picture, "stages": stages}
    asked = {"onto": onto, "eta": eta, "identities": identities}
    if body is not None and is_solid(body):
        cor_solid.answer_of_solid(
            body, sizes, {**told, **mesh}, asked, files, models=model, gravity=gravity, as_json=as_json
        )
        return
    cor_plane.answer_of_plane_body(
        body, {**sizes, **told}, mesh, asked, files, models=model, gravity=gravity, as_json=as_json
    )
