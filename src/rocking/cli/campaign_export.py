"""Files of `rocking campaign export`."""

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rocking.answers import Answer
from rocking.campaigns import CampaignStorageError, Progress, disk, jobs
from rocking.campaigns.jobs import JobFolder, assessment
from rocking.campaigns.jobs.exporting import ENDINGS, checked, exports_of, write_provenance
from rocking.campaigns.jobs.rounds import finished_rounds
from rocking.cli.campaign_output import bar
from rocking.cli.exports import PICTURES
from rocking.cli.page import print_json
from rocking.cli.spelling import UsageError
from rocking.errors import RockingError, extra
from rocking.tables import target_of

REPORT, PICTURE = "report", "picture"  # ranked table of an inventory with its ratings; figure of a study
_SAFE = "the campaign is unchanged"


def write(
    folder: Path, out: list[str], *, restitution: str | None, crossing_curves: Any, inputs: Path | None, as_json: bool
) -> None:
    """Write the results of a campaign into files; ``CONTENT=FILE`` selects the content of a file."""
    opened = JobFolder.open(folder, inputs)
    targets = [_target(text, opened) for text in out]
    paths = [path.resolve() for path, _ in targets]
    if duplicate := next((path for path in paths if paths.count(path) > 1), None):
        raise UsageError(
            "{parameter} {file} is given twice; use another name", parameter="--output", file=duplicate.name
        )
    for path, content in targets:
        _check(opened, path, content, restitution, crossing_curves)
    facts: list[dict[str, Any]] = []
    left_out: list[str] = []
    for path, content in targets:
        written = [path]
        if content == REPORT:
            written, missing = _report(opened, path)
            left_out += missing
        elif content == PICTURE:
            from rocking.plots.campaign import campaign_picture
            from rocking.plots.style import write as write_picture

            with _stored(path):
                write_picture(campaign_picture(opened, restitution), path)
        else:
            _file(opened, path, content, restitution, crossing_curves, quiet=as_json)
        facts += [_facts(opened, file, content) for file in written]
    if as_json:
        print_json(*map(Answer, facts))
        return
    for entry in facts:
        print(f"wrote {entry['file']} ({entry['bytes']} bytes, {_described(entry['what'], entry)})")
    for sentence in left_out:
        print(f"left out: {sentence}")


def _target(text: str, folder: JobFolder) -> tuple[Path, str]:
    """Return a file and its content: the stated content, or the default for its extension and the study."""
    content, equals, file = text.partition("=")
    if equals and (content in {*ENDINGS, REPORT, PICTURE} or ("/" not in content and "." not in content)):
        return Path(file), content
    path, is_inventory = Path(text), folder.job.study.assess is not None
    if path.suffix.lower() in PICTURES and not (is_inventory and path.suffix.lower() == ".pdf"):
        return path, PICTURE
    return path, REPORT if is_inventory else exports_of(folder)[0]


def _check(folder: JobFolder, to: Path, content: str, restitution: str | None, crossing_curves: Any) -> None:
    """Refuse a file that could not be written, before the first file is written."""
    if content == REPORT:
        from rocking.reports.inventory_folder import check_form

        if folder.job.study.assess is None or restitution is not None or crossing_curves is not None:
            raise UsageError("report can be used for inventories only, and not with --restitution or --crossing-curves")
        if to.suffix:
            check_form(to)
            if not to.parent.is_dir():
                raise UsageError("cannot write {file}: folder {folder} does not exist", file=to, folder=to.parent)
    elif content == PICTURE:
        from rocking.plots.campaign import check_picture

        target_of(to)
        if to.suffix.lower() not in PICTURES:
            raise UsageError(
                "a picture must be {endings}, got {ending!r}",
                endings=", ".join(PICTURES),
                ending=to.suffix or "no extension",
            )
        if crossing_curves is not None:
            raise UsageError("--crossing-curves is for fragility and fema-p58, not for a picture")
        check_picture(folder, restitution)
        extra("matplotlib", "a picture")
    elif content not in ENDINGS:
        raise UsageError(parameter="CONTENT", allowed=f"one of {', '.join((*ENDINGS, REPORT, PICTURE))}", value=content)
    else:
        checked(folder, to, content, restitution, crossing_curves)


def _described(content: str, facts: dict[str, Any]) -> str:
    if "rounds" not in facts:
        return (
            f"{facts['histories']} histories"
            if content == "histories"
            else f"{content} of {facts['histories']} histories"
        )
    if content == "histories":
        return f"{facts['histories']} histories of the first round, of {facts['all_histories']} in all rounds"
    return f"{content} of {facts['histories']} histories in {facts['rounds']} rounds"


def _file(
    folder: JobFolder, to: Path, content: str, restitution: str | None, crossing_curves: Any, *, quiet: bool
) -> None:
    total = folder.campaign.plan.count
    done = 0
    with bar(f"writing {to.name}", total, quiet=quiet) as show:

        def step(count: int) -> None:
            nonlocal done
            done += count
            show(Progress(done, total, 0, 0, 0.0, None, 0.0, 0))

        jobs.export(folder, to, content, restitution=restitution, crossing_curves=crossing_curves, progress=step)


def _report(folder: JobFolder, to: Path) -> tuple[list[Path], list[str]]:
    """Write the report of an inventory: one file, or a folder with all formats."""
    from rocking.reports.inventory_folder import STEM, write_inventory, write_inventory_file

    result = assessment(folder)
    with _stored(to):
        if not to.suffix:
            to.mkdir(parents=True, exist_ok=True)
            write_provenance(folder.job.provenance, to / STEM)
            return write_inventory(result, to)
        # the provenance comes first, so that every report has its provenance
        provenance = write_provenance(folder.job.provenance, to)
        try:
            return [write_inventory_file(result, to)], []
        except BaseException:
            if not to.exists():
                provenance.unlink(missing_ok=True)
            raise


@contextmanager
def _stored(to: Path) -> Iterator[None]:
    """Convert an error of the disk into an error with a note that the campaign is unchanged."""
    with disk.guarded(to, lambda: _SAFE):
        try:
            yield
        except RockingError as error:
            if not isinstance(error.__cause__, OSError):
                raise
            refusal = error.copied(CampaignStorageError)
            refusal.add_hint(f"{_SAFE}; free disk space or allow writing, then export again")
            raise refusal from error


def _facts(folder: JobFolder, path: Path, content: str) -> dict[str, Any]:
    rounds = finished_rounds(folder.path)
    # tables of an adaptive study contain all rounds; its histories contain only the first round
    of_all = rounds is not None and content != "histories"
    with path.open("rb") as file:
        return {
            "file": str(path),
            "what": content,
            "histories": rounds["histories"] if rounds is not None and of_all else folder.campaign.plan.count,
            "bytes": path.stat().st_size,
            "sha256": hashlib.file_digest(file, "sha256").hexdigest(),
            **({} if rounds is None else {"rounds": rounds["rounds"], "all_histories": rounds["histories"]}),
        }
