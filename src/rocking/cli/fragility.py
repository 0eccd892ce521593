"""`rocking fragility`: how likely a body is to rock or to overturn at a level of shaking."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_SHAKING = "What shakes it"
_OUTPUT = "Output"


def fragility(
    body: Annotated[
        str | None, typer.Argument(help="Body file: TOML, or WKT, GeoJSON, DXF with --units; left out with --width.")
    ] = None,
    motions: Annotated[
        list[str] | None, typer.Argument(help="Record files, or pulses such as sine:amplitude=1,period=0.5.")
    ] = None,
    record: Annotated[
        list[str] | None,
        typer.Option(help="The same, as an option; again for more.", rich_help_panel=_SHAKING),
    ] = None,
    synthetic: Annotated[
        str | None,
        typer.Option(
            help="Family of motions in their place: firm-ground, soft-ground, kanai-tajimi, point-source, pulse-like.",
            rich_help_panel=_SHAKING,
        ),
    ] = None,
    count: Annotated[
        int | None, typer.Option(help="How many synthetic motions, 100 if not given.", rich_help_panel=_SHAKING)
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Seed of the synthetic motions, 1 if not given.", rich_help_panel=_SHAKING)
    ] = None,
    analysis: Annotated[
        str,
        typer.Option(
            help="stripes: every motion at every level; incremental: and every level at which one begins or ceases to "
            "overturn; cloud: motions as they are."
        ),
    ] = "stripes",
    measure: Annotated[str, typer.Option(help="Measure of intensity: pga, pgv, arias, sa(0.5) and more.")] = "pga",
    levels: Annotated[
        str | None,
        typer.Option(help="FIRST:LAST:COUNT, with :log for equal ratios, or A,B,C; with units: 0.05g:1g:20."),
    ] = None,
    states: Annotated[str, typer.Option(help="Rotations over the slenderness angle that count: 0.2,0.5.")] = "0.5",
    factor: Annotated[float | None, typer.Option(help="Factor on all motions of a cloud.")] = None,
    restitution: Annotated[
        list[str] | None,
        typer.Option(help="Model as in rocking models, or a coefficient; again for more, to compare; ked if none."),
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
    linear: options.Linear = False,
    engine: options.Engine = "auto",
    gravity: options.Gravity = None,
    threads: options.Threads = None,
    name: Annotated[
        str | None, typer.Option(help="Name of the body in the files; its kind if not given.", rich_help_panel=_OUTPUT)
    ] = None,
    picture: Annotated[Path | None, typer.Option(help="Draw it (.png, .svg, .pdf).", rich_help_panel=_OUTPUT)] = None,
    csv: Annotated[
        Path | None, typer.Option(help="Write what was counted at each level.", rich_help_panel=_OUTPUT)
    ] = None,
    p58: Annotated[
        Path | None, typer.Option(help="Write the curves as FEMA P-58 asks for them (CSV).", rich_help_panel=_OUTPUT)
    ] = None,
    nrml: Annotated[
        Path | None, typer.Option(help="Write the curves for OpenQuake (NRML 0.5).", rich_help_panel=_OUTPUT)
    ] = None,
    excel: Annotated[Path | None, typer.Option(help="Write a workbook.", rich_help_panel=_OUTPUT)] = None,
    mat: Annotated[Path | None, typer.Option(help="Write for MATLAB.", rich_help_panel=_OUTPUT)] = None,
    netcdf: Annotated[Path | None, typer.Option(help="Write as netCDF.", rich_help_panel=_OUTPUT)] = None,
    common_dispersion: Annotated[
        bool,
        typer.Option(
            "--common-dispersion",
            help="In files of curves one dispersion for all states, so that no curves cross.",
            rich_help_panel=_OUTPUT,
        ),
    ] = False,
    as_json: options.AsJson = False,
) -> None:
    """Print how likely a body is to rock or to overturn at a level of shaking, and how well that is known."""
    from rocking.cli import fragility_output
    from rocking.cli.fragility_question import FragilityQuestion, body_and_records
    from rocking.cli.inputs import body_from
    from rocking.cli.output import settings_from
    from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS

    unit, units = options.units_of(units, LENGTH_UNITS, ACCELERATION_UNITS)
    size = {"width": width, "height": height, "depth": depth, "density": density}
    sized = any(one is not None for one in (width, height, angle, semi_diagonal))
    file, records = body_and_records(body, motions or [], sized=sized)
    files = fragility_output.FragilityFiles(picture, csv, p58, nrml, excel, mat, netcdf, common_dispersion)
    question = FragilityQuestion.of(
        body_from(file, **size, angle=angle, semi_diagonal=semi_diagonal, unit=unit),
        {"analysis": analysis, "measure": measure, "levels": levels, "states": states, "factor": factor},
        restitution,
        settings_from(gravity, engine, linear, threads),
    )
    files.check(question)
    told = {"format": format, "units": units, "time_step": time_step, "component": component}
    sources = {"record": [*records, *(record or [])], "synthetic": synthetic, "count": count, "seed": seed}
    answer = question.answered(sources, told, as_json)
    # the numbers are shown even if a file cannot be made of them
    if as_json:
        print(fragility_output.as_json(answer))
    else:
        fragility_output.show(answer, unit or "m")
    for path in files.write(answer, name):
        if not as_json:
            print(f"wrote {path}")
