"""The archive of inputs and record, read again: the record is kept as if it had been dropped."""

import hashlib
from typing import Any

from rocking.app.api.records import Looked, RecordOptions
from rocking.app.errors import NotFound, Refused
from rocking.app.records import RecordStore
from rocking.app.schemas.inputs import LONGEST, Inputs, parsed_toml
from rocking.app.takeaway.archive import Archive
from rocking.app.takeaway.inputs_file import FindRecord, inputs_from_toml
from rocking.app.takeaway.plain_text import record_file_name


def inputs_from_file(data: bytes, records: RecordStore) -> Inputs:
    """Return what a file of inputs says: TOML, or the archive of it and its record."""
    if Archive.begins(data):
        return _inputs_from_archive(Archive(data), records)
    return inputs_from_toml(_text(data), _finder(records))


def _inputs_from_archive(archive: Archive, records: RecordStore) -> Inputs:
    texts = [name for name in archive.names if name.lower().endswith(".toml")]
    if len(texts) != 1:
        raise Refused(f"the archive must hold one TOML file of inputs, it has {len(texts)}")
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
        Looked.at(content, name, RecordOptions(inputs.motion.format, inputs.motion.units, inputs.motion.time_step))
        records.add(content, inputs.motion.file_name or name)
    return inputs


def _record_of(text: str) -> str:
    """Return the name of the record file that inputs name; empty if they name none."""
    motion: Any = parsed_toml(text).get("motion")
    word = motion.get("record") if isinstance(motion, dict) else None
    return word if isinstance(word, str) else ""


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise Refused(f"this is not a text file in UTF-8 (byte {error.start})") from error


def _finder(records: RecordStore) -> FindRecord:
    """Return what finds the hash of an uploaded record, given that or its name: the latest of that name."""

    def found(word: str) -> str | None:
        try:
            return records.get(word).record
        except NotFound:
            named = (
                one.record for one in records.stored() if record_file_name(one.file_name) == record_file_name(word)
            )
            return next(named, None)

    return found
