"""`rocking cor`: the coefficient of restitution of a body under every model."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import shared_options as shared

_OUTPUT = "Output"


def cor(
    body: Annotated[Path | None, typer.Argument(help="Body file: TOML, or WKT, GeoJSON, DXF with --unit.")] = None,
    width: shared.Width = None,
    height: shared.Height = None,
    depth: shared.Depth = None,
    density: shared.Density = None,
    angle: shared.Angle = None,
    semi_diagonal: shared.SemiDiagonal = None,
    unit: shared.Unit = None,
    onto: Annotated[str, typer.Option(help="Foot on which the body lands: right, left or both.")] = "both",
    model: Annotated[
        list[str] | None,
        typer.Option(help="Model, repeatable: ked, 0.98*ked, shifted-impulse:k=0.6, my_file.py:MyModel."),
    ] = None,
    eta: Annotated[float, typer.Option(help="Interface factor in (0, 1] on every model.")] = 1.0,
    gravity: Annotated[float | None, typer.Option(help=r"Acceleration of gravity \[m/s2].")] = None,
    identities: Annotated[
        bool, typer.Option("--identities", help="Also try the identities of mechanics on every model.")
    ] = False,
    as_json: shared.AsJson = False,
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
    from rocking.cli import cor_output
    from rocking.cli.body_options import body_from
    from rocking.cli.model_options import models_from
    from rocking.conventions import g
    from rocking.report.facts.impact import ImpactAnswer

    subject = body_from(
        body,
        width=width,
        height=height,
        depth=depth,
        density=density,
        angle=angle,
        semi_diagonal=semi_diagonal,
        unit=unit,
    )
    answer = ImpactAnswer.of(
        subject,
        models_from(model),
        onto=onto,
        eta=eta,
        gravity=g if gravity is None else gravity,
        identities=identities,
    )
    if csv is not None:
        cor_output.write_csv(answer, csv)
    if picture is not None:
        cor_output.draw(answer, picture)
    if stages is not None:
        cor_output.draw_stages(answer, stages)
    if as_json:
        print(cor_output.as_json(answer))
    else:
        cor_output.show(answer)
        for path in filter(None, (csv, picture, stages)):
            print(f"wrote {path}")
