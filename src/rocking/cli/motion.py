"""`rocking motion`: what a record or a pulse is, and how strong."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_OUTPUT = "Output"


def motion(
    record: Annotated[str, typer.Argument(help="Record file, or a pulse such as sine:amplitude=3,period=0.8.")],
    format: options.Format = None,
    units: options.RecordUnits = None,
    time_step: options.TimeStep = None,
    component: options.Component = None,
    vertical: options.Vertical = None,
    vertical_file: options.VerticalFile = None,
    scale: Annotated[float | None, typer.Option(help="Factor on the acceleration.")] = None,
    damping: Annotated[float, typer.Option(help="Damping ratio of the spectrum.")] = 0.05,
    periods: Annotated[
        str, typer.Option(help=r"Periods of the spectrum, with commas between \[s].")
    ] = "0.1,0.2,0.5,1,2,3",
    picture: Annotated[
        Path | None, typer.Option(help="Draw it and its spectrum (.png, .svg, .pdf).", rich_help_panel=_OUTPUT)
    ] = None,
    csv: Annotated[
        Path | None,
        typer.Option(help="Write time, acceleration, velocity, displacement.", rich_help_panel=_OUTPUT),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print what a record or a pulse is, its intensity measures and its response spectrum."""
    from rocking.cli import motion_output
    from rocking.cli.inputs import motion_from
    from rocking.conventions import ACCELERATION_UNITS
    from rocking.reports.motion_facts import MotionAnswer

    (units,) = options.units_of(units, ACCELERATION_UNITS)
    subject = motion_from(
        record,
        format=format,
        units=units,
        time_step=time_step,
        component=component,
        vertical=vertical,
        vertical_file=vertical_file,
        scale=scale,
    )
    answer = MotionAnswer.of(subject, motion_output.periods_from(periods), damping)
    if csv is not None:
        motion_output.write_csv(answer, csv)
    if picture is not None:
        motion_output.draw(answer, picture)
    if as_json:
        print(motion_output.as_json(answer))
    else:
        motion_output.show(answer, units or "m/s2")
        for path in filter(None, (csv, picture)):
            print(f"wrote {path}")
