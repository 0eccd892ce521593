"""Reading ground-motion files and writing them, one format a file."""

from rocking.motions.formats.reader import read_motion, read_record, write_motion, write_record
from rocking.motions.formats.record import Component, Record
from rocking.motions.formats.record_format import RecordFormat
from rocking.motions.formats.registry import formats

__all__ = [
    "Component",
    "Record",
    "RecordFormat",
    "formats",
    "read_motion",
    "read_record",
    "write_motion",
    "write_record",
]
