"""What `rocking campaign export` writes."""

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rocking.campaigns import CampaignStorageError, Progress, disk, jobs
from rocking.campaigns.jobs import JobFolder, assessment, exports_of
from rocking.campaigns.jobs.exporting import write_provenance
from rocking.campaigns.jobs.rounds import finished_rounds
from rocking.cli.campaign_output import bar
from rocking.cli.page import print_json
from rocking.errors import InvalidValueError, RockingError

REPORT = "report"
"""The ranked table of an inventory with its lights."""

_SAFE = "the campaign itself is safe"


_WHATS = (
    "histories", "fragility", "fragility-points", "fema-p58", "refined", "boundary", "crossings", "minima", REPORT,
    "measures", "flips", "differences",
)  # fmt: skip


def write(
    folder: Path, out: list[str], *, restitution: str | None, crossing: str | None, inputs: Path | None, as_json: bool
) -> None:
    """Write the results of a campaign into files, and say so; ``WHAT=FILE`` says what a file holds."""
    opened = JobFolder.open(folder, inputs)
    facts: list[dict[str, Any]] = []
    left_out: list[str] = []
    targets = [_target(text) for text in out]
    paths = [path.resolve() for path, _ in targets]
    if twice := next((path for path in paths if paths.count(path) > 1), None):
        raise InvalidValueError(f"--out names {twice.name} twice: the second would replace the first")
    for target, what in targets:
        made, missing = _written(opened, target, what, restitution, crossing, quiet=as_json)
        facts, left_out = [*facts, *made], [*left_out, *missing]
    if as_json:
        print_json(facts[0] if len(facts) == 1 else facts)
        return
    for each in facts:
        print(f"wrote {each['file']} ({each['bytes']} bytes, {_words(each['what'], each)})")
    for sentence in left_out:
        print(f"left out: {sentence}")


def _target(text: str) -> tuple[Path, str | None]:
    what, equals, rest = text.partition("=")
    named = bool(equals) and (what in _WHATS or ("/" not in what and "." not in what))
    return Path(rest if named else text), what if named else None


def _written(
    opened: JobFolder, to: Path, what: str | None, restitution: str | None, crossing: str | None, *, quiet: bool
) -> tuple[list[dict[str, Any]], list[str]]:
    is_inventory = opened.job.study.assess is not None
    what = (REPORT if is_inventory else exports_of(opened)[0]) if what is None else what
    left_out: list[str] = []
    if what == REPORT:
        if not is_inventory or restitution is not None or crossing is not None:
            raise InvalidValueError("a report is of an inventory, without restitution and crossing")
        paths, left_out = _report(opened, to)
    else:
        paths = [_file(opened, to, what, restitution, crossing, quiet=quiet)]
    rounds = finished_rounds(opened.path)
    # tables of an adaptive study are made from all its rounds, its histories are those of the first
    of_all = rounds is not None and what != "histories"
    total = rounds["histories"] if rounds is not None and of_all else opened.campaign.plan.count
    more = {} if rounds is None else {"rounds": rounds["rounds"], "all_histories": rounds["histories"]}
    return [_facts(path, what, total) | more for path in paths], left_out


def _words(what: str, told: dict[str, Any]) -> str:
    if "rounds" not in told:
        return f"{what} of {told['histories']} histories"
    if what == "histories":
        return f"{told['histories']} histories of the first round, of {told['all_histories']} in all rounds"
    return f"{what} of {told['histories']} histories in {told['rounds']} rounds"


def _file(
    folder: JobFolder, to: Path, what: str, restitution: str | None, crossing: Any, *, quiet: bool
) -> Path:  # fmt: skip
    total = folder.campaign.plan.count
    done = 0
    with bar(f"writing {to.name}", total, quiet=quiet) as tell:

        def step(count: int) -> None:
            nonlocal done
            done += count
            tell(Progress(done, total, 0, 0, 0.0, None, 0.0, 0))

        try:
            return jobs.export(folder, to, what, restitution=restitution, crossing=crossing, progress=step)
        except InvalidValueError as error:
            words = str(error).replace('crossing="common-dispersion"', "--crossing common-dispersion")
            raise InvalidValueError(words) from error


def _report(folder: JobFolder, to: Path) -> tuple[list[Path], list[str]]:
    """Write the report of an inventory: in one form, or into a folder in all."""
    from rocking.reports.inventory_folder import STEM, check_form, write_inventory, write_inventory_file

    found = assessment(folder)
    with _stored(to):
        if not to.suffix:
            to.mkdir(parents=True, exist_ok=True)
            write_provenance(folder.job.provenance, to / STEM)
            return write_inventory(found, to)
        check_form(to)
        if not to.parent.is_dir():
            raise InvalidValueError(f"cannot write {to}: there is no folder {to.parent}")
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


def _facts(path: Path, what: str, total: int) -> dict[str, Any]:
    with path.open("rb") as file:
        return {
            "file": str(path),
            "what": what,
            "histories": total,
            "bytes": path.stat().st_size,
            "sha256": hashlib.file_digest(file, "sha256").hexdigest(),
        }
