"""`rocking campaign`: large studies of a job file, which can be stopped and resumed."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_CODES = (
    "Exit codes: 0 done; 2 invalid input, or no result to export; 3 interrupted, finished results are kept; "
    "4 disk full or read-only; 5 the campaign runs in another process; 6 damaged or missing results."
)

campaign = typer.Typer(
    name="campaign",
    help="Compute a large study from a job file (TOML); stop and resume it.",
    epilog=_CODES,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
)

JobFile = Annotated[Path, typer.Argument(help="Job file (TOML); its files are relative to its folder.")]
Folder = Annotated[Path, typer.Argument(help="Folder of the campaign.")]
AsJson = Annotated[bool, typer.Option("--json", help="Result as JSON.")]
Workers = Annotated[
    int | None,
    typer.Option(min=1, max=4096, help="Number of processes, or of threads with executor serial. [default: all cores]"),
]
Executor = Annotated[str, typer.Option(help="Executor: serial, processes or dask.")]
Address = Annotated[str | None, typer.Option(help="Address of a running Dask scheduler: tcp://host:8786.")]
Inputs = Annotated[Path | None, typer.Option(help="Folder of the input files, if they were moved.")]


@campaign.command(epilog=_CODES)
def check(
    job: JobFile,
    output: Annotated[Path | None, options.output("Folder of the campaign, to check the free disk space.")] = None,
    workers: Annotated[int, typer.Option(min=1, max=4096, help="Number of cores.")] = 1,
    as_json: AsJson = False,
) -> None:
    """Check a job file; estimate time, memory and disk space."""
    from rocking.cli import campaign_output

    with campaign_output.codes():
        campaign_output.show_forecast(job, workers, output, as_json)


@campaign.command(epilog=_CODES)
def run(
    job: JobFile,
    output: Annotated[Path, options.output("New folder of the campaign.")],
    workers: Workers = None,
    executor: Executor = "serial",
    address: Address = None,
    as_json: AsJson = False,
) -> None:
    """Start a campaign in a new folder, with a copy of the job file."""
    from rocking.campaigns.jobs import Job, JobFolder
    from rocking.cli import campaign_output

    with campaign_output.codes(output):
        how = campaign_output.executor_of(executor, workers, address)
        campaign_output.compute(JobFolder.create(output, Job.read(job)), how, as_json)


@campaign.command(epilog=_CODES)
def resume(
    folder: Folder,
    workers: Workers = None,
    executor: Executor = "serial",
    address: Address = None,
    inputs: Inputs = None,
    as_json: AsJson = False,
) -> None:
    """Resume a campaign; changed input files are refused."""
    from rocking.campaigns.jobs import JobFolder
    from rocking.cli import campaign_output

    with campaign_output.codes(folder):
        how = campaign_output.executor_of(executor, workers, address)
        campaign_output.compute(JobFolder.open(folder, inputs), how, as_json)


@campaign.command(epilog=_CODES)
def status(folder: Folder, as_json: AsJson = False) -> None:
    """Show the progress of a campaign, also while it runs."""
    from rocking.cli import campaign_output

    with campaign_output.codes(folder):
        campaign_output.show_status(folder, as_json)


@campaign.command(epilog=_CODES)
def verify(folder: Folder, as_json: AsJson = False) -> None:
    """Verify every result of a campaign; resume repairs it."""
    from rocking.cli import campaign_output

    with campaign_output.codes(folder):
        campaign_output.show_verification(folder, as_json)


@campaign.command(epilog=_CODES)
def export(
    folder: Folder,
    output: Annotated[
        list[str],
        options.output(
            "File: .nc, .parquet, .csv, .mat, .xlsx, .xml (NRML), .png, .svg, .pdf; or CONTENT=FILE with histories, "
            "picture, fragility, fragility-points, fema-p58, refined, boundary, crossings, minima, report, ims, flips "
            "or differences; inventories: also .html, .json or a folder; repeatable."
        ),
    ],
    restitution: Annotated[
        str | None, typer.Option(help="Restitution model of the exported fragility curves or intensity measures.")
    ] = None,
    crossing_curves: Annotated[
        str | None,
        typer.Option(
            help="Treatment of crossing fragility curves: keep-uplift, common-dispersion or refuse. "
            "[default: as in the job]"
        ),
    ] = None,
    inputs: Inputs = None,
    as_json: AsJson = False,
) -> None:
    """Export the results of a finished campaign, with their provenance."""
    from rocking.cli import campaign_output
    from rocking.cli.campaign_export import write

    with campaign_output.codes(folder):
        write(folder, output, restitution=restitution, crossing_curves=crossing_curves, inputs=inputs, as_json=as_json)
