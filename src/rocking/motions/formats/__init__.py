"""Reading ground-motion files and writing them, one format a file."""

from rocking.motions.formats.reader import formats, read_motion, read_record, write_motion, write_record
from rocking.motions.formats.record import Component, Record
from rocking.motions.formats.record import RecordFormat as RecordFormat  # both for who adds a format
from rocking.motions.formats.record import Source as Source

__all__ = [
    "Component",
    "Record",
    "formats",
    "read_motion",
    "read_record",
    "write_motion",
    "write_record",
]
