"""What `rocking campaign export` writes."""

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
from rocking.errors import InvalidValueError, RockingError, extra
from rocking.tables import target_of

REPORT, PICTURE = "report", "picture"  # the ranked table of an inventory with its lights; the picture of a study
_SAFE = "the campaign itself is safe"


def write(
    folder: Path, out: list[str], *, restitution: str | None, crossing_curves: Any, inputs: Path | None, as_json: bool
) -> None:
    """Write the results of a campaign into files, and say so; ``WHAT=FILE`` says what a file holds."""
    opened = JobFolder.open(folder, inputs)
    targets = [_target(text, opened) for text in out]
    paths = [path.resolve() for path, _ in targets]
    if twice := next((path for path in paths if paths.count(path) > 1), None):
        raise InvalidValueError(
            "{parameter} names {file} twice: the second would replace the first", parameter="--output", file=twice.name
        )
    for path, what in targets:
        _check(opened, path, what, restitution, crossing_curves)
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
            _file(opened, path, what, restitution, crossing_curves, quiet=as_json)
        facts += [_facts(opened, each, what) for each in written]
    if as_json:
        print_json(*map(Answer, facts))
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


def _check(folder: JobFolder, to: Path, what: str, restitution: str | None, crossing_curves: Any) -> None:
    """Refuse a file that could not be written, before any is."""
    if what == REPORT:
        from rocking.reports.inventory_folder import check_form

        if folder.job.study.assess is None or restitution is not None or crossing_curves is not None:
            raise InvalidValueError("a report is of an inventory, without restitution and crossing_curves")
        if to.suffix:
            check_form(to)
            if not to.parent.is_dir():
                raise InvalidValueError("cannot write {file}: there is no folder {folder}", file=to, folder=to.parent)
    elif what == PICTURE:
        from rocking.plots.campaign import check_picture

        target_of(to)
        if to.suffix.lower() not in PICTURES:
            raise InvalidValueError(
                "a picture is {endings}, got {ending!r}", endings=", ".join(PICTURES), ending=to.suffix or "no ending"
            )
        if crossing_curves is not None:
            raise InvalidValueError(
                "crossing_curves goes with fragility and fema-p58: it is about curves that are written"
            )
        check_picture(folder, restitution)
        extra("matplotlib", "a picture")
    elif what not in ENDINGS:
        raise InvalidValueError(
            parameter="what", allowed=f"one of {', '.join((*ENDINGS, REPORT, PICTURE))}", value=what
        )
    else:
        checked(folder, to, what, restitution, crossing_curves)


def _words(what: str, facts: dict[str, Any]) -> str:
    if "rounds" not in facts:
        return f"{facts['histories']} histories" if what == "histories" else f"{what} of {facts['histories']} histories"
    if what == "histories":
        return f"{facts['histories']} histories of the first round, of {facts['all_histories']} in all rounds"
    return f"{what} of {facts['histories']} histories in {facts['rounds']} rounds"


def _file(
    folder: JobFolder, to: Path, what: str, restitution: str | None, crossing_curves: Any, *, quiet: bool
) -> None:
    total = folder.campaign.plan.count
    done = 0
    with bar(f"writing {to.name}", total, quiet=quiet) as tell:

        def step(count: int) -> None:
            nonlocal done
            done += count
            tell(Progress(done, total, 0, 0, 0.0, None, 0.0, 0))

        jobs.export(folder, to, what, restitution=restitution, crossing_curves=crossing_curves, progress=step)


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
            refusal = error.copied(CampaignStorageError)
            refusal.add_hint(f"{_SAFE}; make room or allow writing, then export again")
            raise refusal from error


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
