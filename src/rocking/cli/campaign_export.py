"""What `rocking campaign export` writes."""

import hashlib
import json
from pathlib import Path
from typing import Any

from rocking.cli.campaign_output import bar
from rocking.errors import InvalidValueError
from rocking.studies.campaign import Progress
from rocking.studies.job import JobFolder, assessment, export, exports_of, status_of
from rocking.studies.job.exporting import write_provenance

REPORT = "report"
"""The ranked table of an inventory with its lights."""


def write(
    folder: Path, to: Path, what: str | None, *, restitution: str | None, crossing: str | None, inputs: Path | None,
    as_json: bool,
) -> None:  # fmt: skip
    """Write the results of a campaign into a file, and say so.

    Parameters
    ----------
    folder : Path
        The campaign.
    to : Path
        The file; of an inventory also a folder.
    what : str, optional
        What of it; what suits its kind if not given.
    restitution : str, optional
        Which restitution's.
    crossing : str, optional
        What to do with fragility curves that cross.
    inputs : Path, optional
        Where the files of the job are now.
    as_json : bool
        Whether to print JSON.

    Raises
    ------
    InvalidValueError
        If the kind of the campaign has nothing of the sort.
    """
    opened = JobFolder.open(folder, inputs)
    is_inventory = opened.job.study.assess is not None
    what = (REPORT if is_inventory else exports_of(opened)[0]) if what is None else what
    left_out: list[str] = []
    if what == REPORT:
        if not is_inventory or restitution is not None or crossing is not None:
            raise InvalidValueError("a report is of an inventory, without restitution and crossing")
        paths, left_out = _report(opened, to)
    else:
        paths = [_file(opened, to, what, restitution, crossing, quiet=as_json)]
    status = status_of(folder).status
    total = opened.campaign.plan.count if status is None else status.histories  # of all rounds
    facts = [_facts(path, what, total) for path in paths]
    if as_json:
        print(json.dumps(facts[0] if len(facts) == 1 else facts, indent=1))
        return
    for told in facts:
        print(f"wrote {told['file']} ({told['bytes']} bytes, {what} of {total} histories)")
    for sentence in left_out:
        print(f"left out: {sentence}")


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
            return export(folder, to, what, restitution=restitution, crossing=crossing, progress=step)
        except InvalidValueError as error:
            words = str(error).replace('crossing="common-dispersion"', "--crossing common-dispersion")
            raise InvalidValueError(words) from error


def _report(folder: JobFolder, to: Path) -> tuple[list[Path], list[str]]:
    """Write the report of an inventory: in one form, or into a folder in all."""
    from rocking.report.inventory_folder import write_inventory, write_inventory_file

    found = assessment(folder)
    if to.suffix:
        path = write_inventory_file(found, to)
        write_provenance(folder.job.provenance, path)
        return [path], []
    written, left_out = write_inventory(found, to)
    write_provenance(folder.job.provenance, to / written[0].stem)
    return written, left_out


def _facts(path: Path, what: str, total: int) -> dict[str, Any]:
    with path.open("rb") as file:
        return {
            "file": str(path),
            "what": what,
            "histories": total,
            "bytes": path.stat().st_size,
            "sha256": hashlib.file_digest(file, "sha256").hexdigest(),
        }
