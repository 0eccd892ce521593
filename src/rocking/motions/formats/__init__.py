"""Reading ground-motion files and writing them, one format a file."""

from rocking.motions.formats.reader import formats, read_motion, read_record, write_motion, write_record
from rocking.motions.formats.record import Component, Record, RecordFormat, Source

__all__ = [
    "Component",
    "Record",
    "RecordFormat",
    "Source",
    "formats",
    "read_motion",
    "read_record",
    "write_motion",
    "write_record",
]
