"""Output, progress and exit codes of `rocking campaign`."""

import shlex
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

from rocking.answers import Answer
from rocking.campaigns import (
    CampaignBusyError,
    CampaignDamagedError,
    CampaignInterrupted,
    CampaignStorageError,
    DaskExecutor,
    Estimate,
    Executor,
    Progress,
)
from rocking.campaigns.jobs import Job, JobFolder, forecast, status_of, verified
from rocking.campaigns.jobs.folder import JOB, JobStatus
from rocking.campaigns.jobs.rounds import resume_hint
from rocking.cli.page import lines, print_json
from rocking.cli.spelling import UsageError
from rocking.quantities import Quantity

INTERRUPTED, STORAGE, BUSY, DAMAGED = 3, 4, 5, 6  # exit codes; 0 is done, 2 invalid input

_CODES: dict[type[BaseException], int] = {
    CampaignInterrupted: INTERRUPTED,
    CampaignStorageError: STORAGE,
    CampaignBusyError: BUSY,
    CampaignDamagedError: DAMAGED,
}


@contextmanager
def codes(folder: Path | None = None) -> Iterator[None]:
    """Convert the interruption of a campaign into a message and an exit code; raise other errors unchanged."""
    try:
        yield
    except tuple(_CODES) as error:
        print(f"rocking: {error}", file=sys.stderr)
        raise typer.Exit(next(code for kind, code in _CODES.items() if isinstance(error, kind))) from error
    except KeyboardInterrupt as error:
        has_begun = folder is not None and (folder / JOB).exists()
        state = "finished results are kept" if has_begun else "nothing was computed"
        print(f"rocking: stopped; {state}", file=sys.stderr)
        raise typer.Exit(INTERRUPTED) from error


def executor_of(name: str, workers: int | None, address: str | None) -> tuple[str | Executor, int | None]:
    """Return the executor and its number of workers."""
    if name not in {"serial", "processes", "dask"}:
        raise UsageError(parameter="--executor", allowed="serial, processes or dask", value=name)
    if (address is not None) != (name == "dask"):
        raise UsageError("--executor dask and --address tcp://host:8786 must be given together")
    if address is None:
        return name, workers
    if workers is not None:
        raise UsageError("--workers cannot be used with --executor dask: the cluster sets the number of workers")
    return DaskExecutor(address), None


def compute(folder: JobFolder, executor: tuple[str | Executor, int | None], as_json: bool) -> None:
    """Compute the missing histories of a campaign, with a progress bar; print a summary."""
    name = folder.job.document.campaign.name
    with bar(name, folder.campaign.plan.count, quiet=as_json) as show:
        done = folder.run(executor[0], workers=executor[1], progress=show)
    status = status_of(folder.path)
    facts = {
        **_facts(status),
        "computed_chunks": done.computed,
        "resumed_chunks": done.resumed,
        "adopted_chunks": done.adopted,
        "set_aside": list(done.set_aside),
        "retries": list(done.retries),
        "run_seconds": done.seconds,
    }
    if as_json:
        print_json(Answer(facts))
        return
    print(_sentence(status))
    for sentence in (*done.set_aside, *done.retries):
        print(f"note: {sentence}")
    target = "report.html" if folder.job.study.assess is not None else "result.nc"
    print(f"next: rocking campaign export {shlex.quote(str(folder.path))} --output {target}")


def show_status(folder: Path, as_json: bool) -> None:
    """Print the progress of a campaign."""
    job_status = status_of(folder)
    status = job_status.status
    if as_json:
        print_json(Answer(_facts(job_status)))
    else:
        print(_sentence(job_status))
        for sentence in (*status.damaged, *status.broken) if status else ():
            print(f"note: {sentence}")
    if status and status.broken:
        raise typer.Exit(DAMAGED)


def show_verification(folder: Path, as_json: bool) -> None:
    """Print the result of the verification of all stored results."""
    check = verified(folder)
    if as_json:
        print_json(Answer({"folder": str(folder), "is_complete": check.is_complete, **vars(check)}))
    else:
        summary = f"{check.verified} of {check.histories} histories verified"
        print(f"{folder}: {summary}, in {_chunks(check.chunks)}{'' if check.is_complete else ' and parts of others'}")
        for sentence in check.damaged:
            print(f"damaged: {sentence}")
        for first, last in check.missing:
            print(f"missing: histories {first} to {last - 1}")
        if not check.is_complete:
            print(resume_hint(folder))
    if not check.is_complete:
        raise typer.Exit(DAMAGED)


def show_forecast(path: Path, workers: int, out: Path | None, as_json: bool) -> None:
    """Print the estimated time, memory and disk space of a job."""
    job = Job.read(path)
    estimate = forecast(job, workers, out)
    facts = {
        "job": str(path),
        "campaign": job.document.campaign.name,
        "kind": job.document.campaign.kind,
        "dimensions": dict(job.study.dims),
        "inputs": job.inputs,
        **{name: value for name, value in vars(estimate).items() if name != "later"},
        **({"first_round_only": True, "later": estimate.later} if job.document.is_adaptive else {}),
    }
    if as_json:
        print_json(Answer(facts, {name: Quantity(name, "1", "size of a dimension") for name in job.study.dims}))
    else:
        dimensions = " x ".join(f"{size} {name}" for name, size in job.study.dims.items())
        files = "1 input file" if len(job.inputs) == 1 else f"{len(job.inputs)} input files"
        print(f"{path}: {facts['campaign']} ({facts['kind']}), {files}, valid")
        print(f"  histories  {estimate.histories} = {dimensions}, in {_chunks(estimate.chunks)} of {estimate.chunk}")
        if estimate.later is not None:
            low, high = estimate.later
            print("             histories, time and disk of the first round")
            print(f"             later rounds usually add {low} to {high} histories")
        between = " to ".join(_span(seconds) for seconds in estimate.between)
        rate = f"{estimate.rate:.3g} histories/s per core"
        print(f"  time       about {_span(estimate.seconds)} ({between}) with {workers} core(s), {rate}")
        print(f"  memory     about {estimate.memory / 1e6:.0f} MB{'' if estimate.later is None else ' in all rounds'}")
        free = "" if estimate.free is None else f", {estimate.free / 1e6:.0f} MB free"
        print(f"  disk       {estimate.disk / 1e6:.1f} MB{free}")
    if estimate.free is not None and estimate.free < estimate.disk:
        raise CampaignStorageError(
            "the campaign needs {needed:.0f} MB, but only {free:.0f} MB are free",
            needed=estimate.disk / 1e6,
            free=estimate.free / 1e6,
        ).at(str(out))


def _facts(job_status: JobStatus) -> dict[str, Any]:
    """Return the progress of a campaign under stable keys."""
    status = job_status.status
    facts = {
        "campaign": job_status.name,
        "kind": job_status.kind,
        "folder": str(job_status.path),
        "complete": job_status.complete,
        "histories": None if status is None else status.histories,
        "histories_done": 0 if status is None else status.histories_done,
        "chunks": None if status is None else status.chunks,
        "chunks_done": 0 if status is None else status.chunks_done,
        "running": None if status is None else status.running,
        "worker_seconds": 0.0 if status is None else status.seconds,
        "retried": 0 if status is None else status.retries,
        "damaged": [] if status is None else list(status.damaged),
        "broken": [] if status is None else list(status.broken),
        "software": None if status is None else status.software,
    }
    return facts if job_status.rounds is None else facts | {"rounds_begun": job_status.rounds}


def _chunks(number: int) -> str:
    return f"{number} chunk{'' if number == 1 else 's'}"


def _sentence(job_status: JobStatus) -> str:
    status, name, folder = job_status.status, job_status.name, job_status.path
    if status is None:
        return f"{name}: no history is computed yet; {resume_hint(folder)}"
    if job_status.complete:
        rounds = "" if job_status.rounds is None else f"{job_status.rounds} rounds, "
        return f"{name}: all {status.histories} histories ({rounds}{_chunks(status.chunks)}) are stored in {folder}"
    next_step = f"running in {status.running}" if status.running else resume_hint(folder)
    progress = (
        f"{status.histories_done} of {status.histories} histories ({status.chunks_done} of {_chunks(status.chunks)})"
    )
    if job_status.rounds is not None:
        progress = f"round {job_status.rounds} has begun, the number of rounds is open; of these rounds {progress}"
    return f"{name}: {progress} are stored in {folder}; {next_step}"


@contextmanager
def bar(title: str, total: int, *, quiet: bool) -> Iterator[Callable[[Progress], None]]:
    """Show the progress, rate and remaining time by a bar on a terminal, or otherwise by a line every few seconds."""
    if quiet:
        yield lambda progress: None
        return
    if not sys.stderr.isatty():
        status_line = f"{title}: 0 of {total} histories"

        def note(progress: Progress) -> None:
            nonlocal status_line
            left = "" if progress.left is None else f", {time_left(progress.left)}"
            status_line = f"{title}: {progress.done_histories} of {progress.total} histories{left}"

        with lines(lambda: status_line):
            yield note
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}"), BarColumn(bar_width=20), TextColumn("{task.percentage:.0f} %"),
        TextColumn("{task.fields[rate]}"), TimeElapsedColumn(), TextColumn("{task.fields[left]}"),
    )  # fmt: skip
    with Bar(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(title.replace("[", "\\["), total=total, rate="", left="")

        def show(progress: Progress) -> None:
            rate = f"{progress.rate:.0f} histories/s" if progress.rate else ""
            left = "estimating the remaining time" if progress.left is None else time_left(progress.left)
            shown.update(task, completed=progress.done_histories, total=progress.total, rate=rate, left=left)

        yield show


def time_left(left: Estimate) -> str:
    """Return the remaining time as text."""
    low, high = _span(left.low), _span(left.high)
    return f"about {_span(left.seconds)} left" + ("" if low == high else f" ({low} to {high})")


def _span(seconds: float) -> str:
    """Return a time with its unit, to two digits."""
    for unit, size in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.1f} s"
