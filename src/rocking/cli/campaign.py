"""`rocking campaign`: very many histories that a job file describes, computed once, whatever happens on the way."""

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import options

_CODES = (
    "Exit codes: 0 done; 2 bad input, or nothing to export yet; 3 interrupted, what is finished is safe; "
    "4 the disk is full or cannot be written; 5 another process runs this campaign; "
    "6 something is damaged, or verify found it missing."
)

campaign = typer.Typer(
    name="campaign",
    help="Compute very many histories that a job file (TOML) describes; stop it, kill it, and resume it.",
    epilog=_CODES,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
)

JobFile = Annotated[Path, typer.Argument(help="Job file (TOML); files in it are relative to it.")]
Folder = Annotated[Path, typer.Argument(help="Folder of the campaign.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Workers = Annotated[
    int | None,
    typer.Option(min=1, max=4096, help="Processes, or threads of the serial executor; all cores if not given."),
]
Executor = Annotated[str, typer.Option(help="Who computes: serial (this process), processes, or dask.")]
Address = Annotated[str | None, typer.Option(help="Address of a Dask scheduler that is there: tcp://host:8786.")]
Inputs = Annotated[Path | None, typer.Option(help="Where the files of the job are now, if they were moved.")]


@campaign.command(epilog=_CODES)
def check(
    job: JobFile,
    output: Annotated[Path | None, options.output("Folder of the campaign, to check the free disk space.")] = None,
    workers: Annotated[int, typer.Option(min=1, max=4096, help="Cores that would compute.")] = 1,
    as_json: AsJson = False,
) -> None:
    """Read a job and all its files, and say what it will take, from a trial of two seconds."""
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
    """Begin a campaign and compute it; the job is copied into its folder."""
    from rocking.campaigns.jobs import Job, JobFolder
    from rocking.cli import campaign_output

    with campaign_output.codes(output):
        who = campaign_output.executor_of(executor, workers, address)
        campaign_output.compute(JobFolder.create(output, Job.read(job)), who, as_json)


@campaign.command(epilog=_CODES)
def resume(
    folder: Folder,
    workers: Workers = None,
    executor: Executor = "serial",
    address: Address = None,
    inputs: Inputs = None,
    as_json: AsJson = False,
) -> None:
    """Go on with a campaign where it stopped; files that have changed since are refused."""
    from rocking.campaigns.jobs import JobFolder
    from rocking.cli import campaign_output

    with campaign_output.codes(folder):
        who = campaign_output.executor_of(executor, workers, address)
        campaign_output.compute(JobFolder.open(folder, inputs), who, as_json)


@campaign.command(epilog=_CODES)
def status(folder: Folder, as_json: AsJson = False) -> None:
    """Say how far a campaign is, also while another process runs it; what it calls safe was read and is whole."""
    from rocking.cli import campaign_output

    with campaign_output.codes(folder):
        campaign_output.show_status(folder, as_json)


@campaign.command(epilog=_CODES)
def verify(folder: Folder, as_json: AsJson = False) -> None:
    """Read a campaign as a whole: every result is there once, and every bit is as it was written; resume mends it."""
    from rocking.cli import campaign_output

    with campaign_output.codes(folder):
        campaign_output.show_verification(folder, as_json)


@campaign.command(epilog=_CODES)
def export(
    folder: Folder,
    output: Annotated[
        list[str],
        options.output(
            "File, again for more: .nc, .parquet, .csv, .mat or .xlsx; .xml for NRML; .png, .svg or .pdf for a "
            "picture; of an inventory .html, .pdf, .xlsx, .csv, .json, or a folder for all. It holds what suits the "
            "kind; WHAT=FILE says which: histories; picture; of fragility campaigns fragility, fragility-points, "
            "fema-p58 (.csv); of refined maps refined, boundary; of minimum accelerations crossings, minima; of "
            "inventories report; of clouds ims; of several restitutions flips, differences."
        ),
    ],
    restitution: Annotated[
        str | None, typer.Option(help="Which restitution's fragility or measures, where the job has several.")
    ] = None,
    crossing_curves: Annotated[
        str | None,
        typer.Option(
            help="Fragility curves that cross: keep-uplift, common-dispersion or refuse; that of the job if not given."
        ),
    ] = None,
    inputs: Inputs = None,
    as_json: AsJson = False,
) -> None:
    """Write the results of a finished campaign into files, with where they come from."""
    from rocking.cli import campaign_output
    from rocking.cli.campaign_export import write

    with campaign_output.codes(folder):
        write(folder, output, restitution=restitution, crossing_curves=crossing_curves, inputs=inputs, as_json=as_json)
