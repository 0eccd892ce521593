"""`rocking minimum`: every acceleration at which a body begins or ceases to overturn under a motion."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import shared_options as shared

_HOW = "How it is computed"
_OUTPUT = "Output"


def minimum(
    body: Annotated[
        str | None, typer.Argument(help="Body file: TOML, or WKT, GeoJSON, DXF with --unit; left out with --width.")
    ] = None,
    record: Annotated[
        str | None, typer.Argument(help="Record file, or a pulse such as sine:amplitude=3,period=0.8.")
    ] = None,
    motion: Annotated[str | None, typer.Option(help="The same, as an option.")] = None,
    restitution: Annotated[
        str, typer.Option(help="Model as in rocking models, my_file.py:MyModel, or a coefficient.")
    ] = "ked",
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
    linear: Annotated[bool, typer.Option("--linear", help="Slender-linear equations.", rich_help_panel=_HOW)] = False,
    engine: Annotated[str, typer.Option(help="auto, fast or reference.", rich_help_panel=_HOW)] = "auto",
    gravity: Annotated[
        float | None, typer.Option(help=r"Acceleration of gravity \[m/s2].", rich_help_panel=_HOW)
    ] = None,
    threads: Annotated[
        int | None, typer.Option(help="Threads; the results do not depend on them.", rich_help_panel=_HOW)
    ] = None,
    picture: Annotated[
        Path | None, typer.Option(help="Draw peak rotation over amplitude (.png, .svg, .pdf).", rich_help_panel=_OUTPUT)
    ] = None,
    csv: Annotated[Path | None, typer.Option(help="Write a line for every crossing.", rich_help_panel=_OUTPUT)] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.", rich_help_panel=_OUTPUT)] = False,
) -> None:
    """Print all peak ground accelerations at which a body begins or ceases to overturn, not the first alone."""
    from rocking.cli import minimum_output
    from rocking.cli.files_output import check_files
    from rocking.cli.study_output import body_and_motion_of, settings_from

    check_files(picture, csv)
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
    minimum_output.show(answer)
    for path in written:
        print(f"wrote {path}")
