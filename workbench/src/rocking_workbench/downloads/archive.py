"""Inputs, record and commands in one archive, and unpacking of archives of users within limits."""

import hashlib
import io
import zlib
from typing import Any
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

from rocking_workbench.api.records import record_facts
from rocking_workbench.downloads.evaluation import Evaluation
from rocking_workbench.downloads.inputs_file import (
    FILE_NAME,
    FindRecord,
    commands,
    fingerprint,
    inputs_as_toml,
    inputs_from_toml,
    record_name,
)
from rocking_workbench.errors import NotFound, Refused, TooLarge
from rocking_workbench.inputs import LONGEST, Inputs, parsed_toml
from rocking_workbench.plain_text import plain_line, record_file_name
from rocking_workbench.records import RecordStore

_EARLIEST = (1980, 1, 1, 0, 0, 0)
_ORDINARY_FILE = 0o644 << 16
MOST_FILES = 8  # largest number of files of an archive; archives of this package have at most three
_BEGINNINGS = (b"PK\x03\x04", b"PK\x05\x06")
_ENTRY = b"PK\x01\x02"
_MOST_ENTRIES = 56
_ENCRYPTED = 0x1


def bundle_of(evaluation: Evaluation) -> bytes:
    """Return a reproducible ZIP file with the inputs of the command line."""
    inputs, record = evaluation.inputs, record_name(evaluation.inputs)
    stream = io.BytesIO()
    with ZipFile(stream, "w") as archive:
        add_file(archive, FILE_NAME, inputs_as_toml(inputs).encode("utf-8"))
        if record is not None and inputs.motion is not None and inputs.motion.record is not None:
            add_file(archive, record, evaluation.records.content(inputs.motion.record))
        add_file(archive, "README.txt", _words(evaluation, record).encode("utf-8"))
    return stream.getvalue()


def add_file(archive: ZipFile, name: str, data: bytes) -> None:
    """Add a file with a fixed time, so that the archive depends only on the inputs."""
    entry = ZipInfo(name, _EARLIEST)
    entry.compress_type, entry.external_attr, entry.create_system = ZIP_DEFLATED, _ORDINARY_FILE, 3
    archive.writestr(entry, data)


def _words(evaluation: Evaluation, record: str | None) -> str:
    typed = commands(evaluation.inputs) or ["(no motion: choose a motion or free rocking first)"]
    files = [f"  {FILE_NAME:<16} body, motion, restitution and settings"]
    if record is not None:
        files.append(f"  {record:<16} the record that it names")
    return "\n".join(
        [
            f"How {evaluation.name or 'a body'} rocks",
            "",
            *files,
            "",
            "In this folder, with rocking installed, each of these gives the same numbers as the application:",
            "",
            *(f"  {plain_line(command, 4000)}" for command in typed),
            "",
            "Add --json for all numbers, --output response.svg for the picture, --output response.csv for the samples.",
            "",
            f"{evaluation.about['software']}; SHA-256 of the inputs: {fingerprint(evaluation.inputs)}",
            "",
        ]
    )


def inputs_from_file(data: bytes, records: RecordStore) -> Inputs:
    """Return the inputs of a TOML file, or of an archive with its record."""
    if Archive.begins(data):
        return _inputs_from_archive(Archive(data), records)
    return inputs_from_toml(_text(data), _finder(records))


def _inputs_from_archive(archive: "Archive", records: RecordStore) -> Inputs:
    texts = [name for name in archive.names if name.lower().endswith(".toml")]
    if len(texts) != 1:
        raise Refused("the archive must contain one TOML input file, got {count}", count=len(texts))
    text = _text(archive.content(texts[0], LONGEST))
    name = _record_of(text)
    if name not in archive.names:
        return inputs_from_toml(text, _finder(records))
    content = archive.content(name, records.largest)
    sha = hashlib.sha256(content).hexdigest()
    others = _finder(records)
    inputs = inputs_from_toml(text, lambda word: sha if word in {name, sha} else others(word))
    if inputs.motion is not None and inputs.motion.record == sha:
        records.check_upload(content)
        record_facts(content, name, {key: getattr(inputs.motion, key) for key in ("format", "units", "time_step")})
        records.add(content, inputs.motion.file_name or name)
    return inputs


def _record_of(text: str) -> str:
    """Return the name of the record file in inputs, or an empty text."""
    motion: Any = parsed_toml(text).get("motion")
    word = motion.get("record") if isinstance(motion, dict) else None
    return word if isinstance(word, str) else ""


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise Refused("the file is not UTF-8 text (byte {byte})", byte=error.start) from error


def _finder(records: RecordStore) -> FindRecord:
    """Return a function that gives the hash of a record from its hash or name; for equal names, the newest record."""

    def find(word: str) -> str | None:
        try:
            return records.get(word).record
        except NotFound:
            name = record_file_name(word)
            return next(
                (stored.record for stored in records.stored() if record_file_name(stored.file_name) == name), None
            )

    return find


class Archive:
    """The files of a ZIP archive by name."""

    def __init__(self, data: bytes, most_files: int = MOST_FILES) -> None:
        # the check comes before reading the entries; a packed record can contain the four bytes by chance
        if data.count(_ENTRY) > _MOST_ENTRIES + most_files:
            raise TooLarge("an archive may contain up to {limit} files", limit=most_files)
        try:
            self._archive = ZipFile(io.BytesIO(data))
        except (BadZipFile, ValueError, NotImplementedError, OSError) as error:
            raise Refused("the ZIP archive is not readable; it is probably damaged") from error
        entries = self._archive.infolist()
        if len(entries) > most_files:
            raise TooLarge(
                "an archive may contain up to {limit} files, got {count}", limit=most_files, count=len(entries)
            )
        for entry in entries:
            _check_entry(entry)
        self._entries = {entry.filename: entry for entry in entries}
        if len(self._entries) < len(entries):
            raise Refused("the archive contains two files with the same name")

    @staticmethod
    def begins(data: bytes) -> bool:
        """Return True if bytes start as a ZIP archive."""
        return data.startswith(_BEGINNINGS)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the files."""
        return tuple(self._entries)

    def content(self, name: str, most: int) -> bytes:
        """Return an unpacked file; `most` is the largest allowed size [bytes]."""
        try:
            with self._archive.open(self._entries[name]) as file:
                content = file.read(most + 1)
        except (BadZipFile, zlib.error, EOFError, ValueError, NotImplementedError, RuntimeError, OSError) as error:
            raise Refused("{name} in the archive is damaged", name=plain_line(name, 60)) from error
        if len(content) > most:
            raise TooLarge("{name} in the archive has more than {limit} bytes", name=plain_line(name, 60), limit=most)
        return content


def _check_entry(entry: ZipInfo) -> None:
    name = plain_line(entry.filename, 60)
    # orig_filename is the name in the archive; filename ends at the first NUL
    if (
        entry.orig_filename != entry.filename
        or set(entry.filename) & set("/\\:\0")
        or entry.filename in {"", ".", ".."}
    ):
        raise Refused("the archive contains {name!r}; folders are not allowed", name=name)
    if entry.flag_bits & _ENCRYPTED:
        raise Refused("{name} in the archive is encrypted", name=name)
    if entry.compress_type not in {ZIP_STORED, ZIP_DEFLATED}:
        raise Refused("{name} in the archive has an unsupported compression; use deflate", name=name)
