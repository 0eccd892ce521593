"""Inputs, the record and the commands in one archive."""

import io
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from rocking.app.takeaway.asked import Evaluation
from rocking.app.takeaway.inputs_file import FILE_NAME, commands, fingerprint, inputs_as_toml, record_name
from rocking.app.takeaway.plain_text import plain_line

_EARLIEST = (1980, 1, 1, 0, 0, 0)
_ORDINARY_FILE = 0o644 << 16


def bundle_of(asked: Evaluation) -> bytes:
    """Return an archive with everything that the command line needs for the same result.

    Returns A ZIP file, the same bytes for the same inputs.
    """
    inputs, record = asked.inputs, record_name(asked.inputs)
    stream = io.BytesIO()
    with ZipFile(stream, "w") as archive:
        _add(archive, FILE_NAME, inputs_as_toml(inputs).encode("utf-8"))
        if record is not None and inputs.motion is not None and inputs.motion.record is not None:
            _add(archive, record, asked.records.content(inputs.motion.record))
        _add(archive, "README.txt", _words(asked, record).encode("utf-8"))
    return stream.getvalue()


def _add(archive: ZipFile, name: str, data: bytes) -> None:
    # the time is always the same: the archive then depends on nothing but the inputs
    entry = ZipInfo(name, _EARLIEST)
    entry.compress_type, entry.external_attr, entry.create_system = ZIP_DEFLATED, _ORDINARY_FILE, 3
    archive.writestr(entry, data)


def _words(asked: Evaluation, record: str | None) -> str:
    said = commands(asked.inputs) or ["(nothing moves the body yet: choose a motion or free rocking first)"]
    files = [f"  {FILE_NAME:<16} body, motion, restitution and settings"]
    if record is not None:
        files.append(f"  {record:<16} the record that it names")
    lines = [
        f"How {asked.name or 'a body'} rocks",
        "",
        *files,
        "",
        "In this folder, with rocking installed, each of these gives the same numbers as the application:",
        "",
        *(f"  {plain_line(command, 4000)}" for command in said),
        "",
        "Add --json for all numbers, --picture response.svg for the picture, --csv response.csv for the samples.",
        "",
        f"{asked.about['software']}; SHA-256 of the inputs: {fingerprint(asked.inputs)}",
        "",
    ]
    return "\n".join(lines)
