"""The folder that an inventory is written to: HTML, PDF, spreadsheet, CSV, JSON."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from rocking.errors import InvalidValueError, MissingExtraError, RockingError
from rocking.reports.html import render_html
from rocking.reports.inventory_document import inventory_document
from rocking.reports.inventory_spreadsheet import write_spreadsheet
from rocking.reports.pdf import render_pdf
from rocking.studies.inventory.assessment import Assessment
from rocking.studies.inventory.table import as_csv, as_plain

STEM = "inventory"
"""Name of every file, before its suffix."""


def write_inventory(assessment: Assessment, folder: Path) -> tuple[list[Path], list[str]]:
    """Write an assessment in every form; what needs a library that is not installed is left out and named.

    Returns written: the files, each of which is there as a whole or not at all; left_out: what could not be written and
    how to get it, one sentence each.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RockingError(f"cannot write to {folder}: {error.strerror}") from error
    written: list[Path] = []
    left_out: list[str] = []
    for suffix in _WRITERS:
        try:
            written.append(_write_whole(assessment, folder / f"{STEM}.{suffix}"))
        except MissingExtraError as error:
            left_out.append(str(error))
    return written, left_out


def write_inventory_file(assessment: Assessment, path: Path) -> Path:
    """Write an assessment in one form, which is there as a whole or not at all."""
    check_form(path)
    return _write_whole(assessment, path)


def check_form(path: Path) -> None:
    """Refuse the name of a file in whose form no inventory can be written."""
    if _form(path) not in _WRITERS:
        forms = ", ".join(f".{suffix}" for suffix in _WRITERS)
        raise InvalidValueError(f"an inventory can be written as {forms}, got {path.suffix!r:.40}")


def _form(path: Path) -> str:
    return path.suffix.lower().removeprefix(".")


def _write_whole(assessment: Assessment, path: Path) -> Path:
    unfinished = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        _WRITERS[_form(path)](assessment, unfinished)
        unfinished.replace(path)
    except OSError as error:
        raise RockingError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        unfinished.unlink(missing_ok=True)
    return path


def inventory_json(assessment: Assessment) -> str:
    """Return an assessment as JSON.

    Returns one object; SI units, named in the keys.
    """
    return json.dumps(as_plain(assessment), indent=2, allow_nan=False, ensure_ascii=False)


def _html(assessment: Assessment, path: Path) -> None:
    path.write_text(render_html(inventory_document(assessment), path.parent), encoding="utf-8")


def _pdf(assessment: Assessment, path: Path) -> None:
    # the renderer leaves its source beside the pictures for a moment: not among the user's files
    with TemporaryDirectory() as folder:
        render_pdf(inventory_document(assessment), Path(folder), path)


def _csv(assessment: Assessment, path: Path) -> None:
    # the byte order mark tells Excel that it is UTF-8
    path.write_text(as_csv(assessment), encoding="utf-8-sig", newline="")


def _json(assessment: Assessment, path: Path) -> None:
    path.write_text(inventory_json(assessment) + "\n", encoding="utf-8")


_WRITERS: dict[str, Callable[[Assessment, Path], None]] = {
    "html": _html,
    "pdf": _pdf,
    "xlsx": write_spreadsheet,
    "csv": _csv,
    "json": _json,
}
