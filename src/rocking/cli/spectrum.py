"""`rocking spectrum`: peak rotation of blocks of many sizes under motions."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_OUTPUT = "Output"


def spectrum(
    motions: Annotated[
        list[str] | None, typer.Argument(help="Record files, or pulses such as sine:amplitude=3,period=0.8.")
    ] = None,
    motion: Annotated[list[str] | None, typer.Option(help="The same, as an option; again for more.")] = None,
    slenderness: Annotated[
        str, typer.Option(help="h/b: 4,6,8 or 4:8:5; with deg or rad the angle alpha: 10deg,15deg.")
    ] = "4,6,8",
    periods: Annotated[
        str, typer.Option(help="2 pi / p in s: FIRST:LAST:COUNT in equal ratios, or with :linear, or A,B,C.")
    ] = "1:10:100",
    restitution: options.Restitution = "ked",
    scale: Annotated[float, typer.Option(help="Factor on the acceleration of the ground.")] = 1.0,
    format: options.Format = None,
    units: options.RecordUnits = None,
    time_step: options.TimeStep = None,
    component: options.Component = None,
    vertical: options.Vertical = None,
    vertical_file: options.VerticalFile = None,
    linear: options.Linear = False,
    engine: options.Engine = "auto",
    gravity: options.Gravity = None,
    threads: options.Threads = None,
    picture: Annotated[
        Path | None, typer.Option(help="Draw the spectra (.png, .svg, .pdf).", rich_help_panel=_OUTPUT)
    ] = None,
    csv: Annotated[Path | None, typer.Option(help="Write a line for every block.", rich_help_panel=_OUTPUT)] = None,
    netcdf: Annotated[Path | None, typer.Option(help="Write everything as netCDF.", rich_help_panel=_OUTPUT)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print the peak rotation of blocks of many sizes and slendernesses under motions, and which sizes overturn."""
    from rocking.cli import spectrum_output
    from rocking.cli.output import check_files, settings_from

    check_files(picture, csv, netcdf)
    told = {"format": format, "units": units, "time_step": time_step, "component": component}
    answer = spectrum_output.answer(
        spectrum_output.motions_from([*(motions or ()), *(motion or ())], {
            **told, "vertical": vertical, "vertical_file": vertical_file,
        }),
        spectrum_output.angles_from(slenderness),
        spectrum_output.periods_from(periods),
        restitution,
        {**settings_from(gravity, engine, linear, threads), "scale": scale},
        quiet=as_json,
    )  # fmt: skip
    written = spectrum_output.write(answer, picture, csv, netcdf)
    if as_json:
        print(spectrum_output.as_json(answer))
        return
    spectrum_output.show(answer)
    for path in written:
        print(f"wrote {path}")
