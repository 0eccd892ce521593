"""`rocking campaign`: very many histories that a job file describes, computed once, whatever happens on the way."""

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.campaigns import CampaignStorageError, Progress, disk, jobs
from rocking.campaigns.jobs import JobFolder, assessment
from rocking.campaigns.jobs.exporting import ENDINGS, checked, exports_of, write_provenance
from rocking.campaigns.jobs.rounds import finished_rounds
from rocking.cli.campaign_output import bar
from rocking.cli.exports import PICTURES
from rocking.cli.page import print_json
from rocking.errors import InvalidValueError, RockingError, extra
from rocking.tables import target_of

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
    out: Annotated[Path | None, typer.Option(help="Where it would be kept, to see if the disk has room.")] = None,
    workers: Annotated[int, typer.Option(min=1, max=4096, help="Cores that would compute.")] = 1,
    as_json: AsJson = False,
) -> None:
    """Read a job and all its files, and say what it will take, from a trial of two seconds."""
    from rocking.cli import campaign_output

    with campaign_output.codes():
        campaign_output.show_forecast(job, workers, out, as_json)


@campaign.command(epilog=_CODES)
def run(
    job: JobFile,
    out: Annotated[Path, typer.Option(help="New folder of the campaign.")],
    workers: Workers = None,
    executor: Executor = "serial",
    address: Address = None,
    as_json: AsJson = False,
) -> None:
    """Begin a campaign and compute it; the job is copied into its folder."""
    from rocking.campaigns.jobs import Job, JobFolder
    from rocking.cli import campaign_output

    with campaign_output.codes(out):
        who = campaign_output.executor_of(executor, workers, address)
        campaign_output.compute(JobFolder.create(out, Job.read(job)), who, as_json)


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
    out: Annotated[
        list[str],
        typer.Option(
            help="File, again for more: .nc, .parquet, .csv, .mat or .xlsx; .xml for NRML; .png, .svg or .pdf for a "
            "picture; of an inventory .html, .pdf, .xlsx, .csv, .json, or a folder for all. It holds what suits the "
            "kind; WHAT=FILE says which: histories; picture; of fragility campaigns fragility, fragility-points, "
            "fema-p58 (.csv); of refined maps refined, boundary; of minimum accelerations crossings, minima; of "
            "inventories report; of clouds measures; of several restitutions flips, differences."
        ),
    ],
    restitution: Annotated[
        str | None, typer.Option(help="Which restitution's fragility or measures, where the job has several.")
    ] = None,
    crossing: Annotated[
        str | None,
        typer.Option(help="Fragility curves that cross: refuse, or common-dispersion; what the job says if not given."),
    ] = None,
    inputs: Inputs = None,
    as_json: AsJson = False,
) -> None:
    """Write the results of a finished campaign into files, with where they come from."""
    from rocking.cli import campaign_output

    with campaign_output.codes(folder):
        write(folder, out, restitution=restitution, crossing=crossing, inputs=inputs, as_json=as_json)


REPORT, PICTURE = "report", "picture"  # the ranked table of an inventory with its lights; the picture of a study
_SAFE = "the campaign itself is safe"


def write(
    folder: Path, out: list[str], *, restitution: str | None, crossing: Any, inputs: Path | None, as_json: bool
) -> None:
    """Write the results of a campaign into files, and say so; ``WHAT=FILE`` says what a file holds."""
    opened = JobFolder.open(folder, inputs)
    targets = [_target(text, opened) for text in out]
    paths = [path.resolve() for path, _ in targets]
    if twice := next((path for path in paths if paths.count(path) > 1), None):
        raise InvalidValueError(f"--out names {twice.name} twice: the second would replace the first")
    for path, what in targets:
        _check(opened, path, what, restitution, crossing)
    facts: list[dict[str, Any]] = []
    left_out: list[str] = []
    for path, what in targets:
        written = [path]
        if what == REPORT:
            written, missing = _report(opened, path)
            left_out += missing
        elif what == PICTURE:
            from rocking.plots.campaign import campaign_picture
            from rocking.plots.style import write as write_picture

            with _stored(path):
                write_picture(campaign_picture(opened, restitution), path)
        else:
            _file(opened, path, what, restitution, crossing, quiet=as_json)
        facts += [_facts(opened, each, what) for each in written]
    if as_json:
        print_json(facts[0] if len(facts) == 1 else facts)
        return
    for each in facts:
        print(f"wrote {each['file']} ({each['bytes']} bytes, {_words(each['what'], each)})")
    for sentence in left_out:
        print(f"left out: {sentence}")


def _target(text: str, folder: JobFolder) -> tuple[Path, str]:
    """Return the file that is meant and what it will hold: what was said, or what suits its ending and the kind."""
    what, equals, rest = text.partition("=")
    if equals and (what in {*ENDINGS, REPORT, PICTURE} or ("/" not in what and "." not in what)):
        return Path(rest), what
    path, is_inventory = Path(text), folder.job.study.assess is not None
    if path.suffix.lower() in PICTURES and not (is_inventory and path.suffix.lower() == ".pdf"):
        return path, PICTURE
    return path, REPORT if is_inventory else exports_of(folder)[0]


def _check(folder: JobFolder, to: Path, what: str, restitution: str | None, crossing: Any) -> None:
    """Refuse a file that could not be written, before any is."""
    if what == REPORT:
        from rocking.reports.inventory_folder import check_form

        if folder.job.study.assess is None or restitution is not None or crossing is not None:
            raise InvalidValueError("a report is of an inventory, without restitution and crossing")
        if to.suffix:
            check_form(to)
            if not to.parent.is_dir():
                raise InvalidValueError(f"cannot write {to}: there is no folder {to.parent}")
    elif what == PICTURE:
        from rocking.plots.campaign import check_picture

        target_of(to)
        if to.suffix.lower() not in PICTURES:
            raise InvalidValueError(f"a picture is {', '.join(PICTURES)}, got {to.suffix or 'no ending'!r}")
        if crossing is not None:
            raise InvalidValueError("crossing goes with fragility and fema-p58: it is about curves that are written")
        check_picture(folder, restitution)
        extra("matplotlib", "a picture")
    elif what not in ENDINGS:
        raise InvalidValueError(f"what must be one of {', '.join((*ENDINGS, REPORT, PICTURE))}, got {what!r:.60}")
    else:
        checked(folder, to, what, restitution, crossing)


def _words(what: str, facts: dict[str, Any]) -> str:
    if "rounds" not in facts:
        return f"{facts['histories']} histories" if what == "histories" else f"{what} of {facts['histories']} histories"
    if what == "histories":
        return f"{facts['histories']} histories of the first round, of {facts['all_histories']} in all rounds"
    return f"{what} of {facts['histories']} histories in {facts['rounds']} rounds"


def _file(folder: JobFolder, to: Path, what: str, restitution: str | None, crossing: Any, *, quiet: bool) -> None:
    total = folder.campaign.plan.count
    done = 0
    with bar(f"writing {to.name}", total, quiet=quiet) as tell:

        def step(count: int) -> None:
            nonlocal done
            done += count
            tell(Progress(done, total, 0, 0, 0.0, None, 0.0, 0))

        try:
            jobs.export(folder, to, what, restitution=restitution, crossing=crossing, progress=step)
        except InvalidValueError as error:
            words = str(error).replace('crossing="common-dispersion"', "--crossing common-dispersion")
            raise InvalidValueError(words) from error


def _report(folder: JobFolder, to: Path) -> tuple[list[Path], list[str]]:
    """Write the report of an inventory: in one form, or into a folder in all."""
    from rocking.reports.inventory_folder import STEM, write_inventory, write_inventory_file

    found = assessment(folder)
    with _stored(to):
        if not to.suffix:
            to.mkdir(parents=True, exist_ok=True)
            write_provenance(folder.job.provenance, to / STEM)
            return write_inventory(found, to)
        # before the report: no report is ever there without it
        beside = write_provenance(folder.job.provenance, to)
        try:
            return [write_inventory_file(found, to)], []
        except BaseException:
            if not to.exists():
                beside.unlink(missing_ok=True)
            raise


@contextmanager
def _stored(to: Path) -> Iterator[None]:
    """Say that the disk, and not the campaign, is at fault."""
    with disk.guarded(to, lambda: _SAFE):
        try:
            yield
        except RockingError as error:
            if not isinstance(error.__cause__, OSError):
                raise
            advice = "make room or allow writing, then export again"
            raise CampaignStorageError(f"{error}; {_SAFE}; {advice}") from error


def _facts(folder: JobFolder, path: Path, what: str) -> dict[str, Any]:
    rounds = finished_rounds(folder.path)
    # tables of an adaptive study are made from all its rounds, its histories are those of the first
    of_all = rounds is not None and what != "histories"
    with path.open("rb") as file:
        return {
            "file": str(path),
            "what": what,
            "histories": rounds["histories"] if rounds is not None and of_all else folder.campaign.plan.count,
            "bytes": path.stat().st_size,
            "sha256": hashlib.file_digest(file, "sha256").hexdigest(),
            **({} if rounds is None else {"rounds": rounds["rounds"], "all_histories": rounds["histories"]}),
        }
