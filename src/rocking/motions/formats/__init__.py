"""Reading and writing of ground-motion files, one module per format."""

from rocking.motions.formats.reader import formats, read_motion, read_record, write_motion, write_record
from rocking.motions.formats.record import Component, Record
from rocking.motions.formats.record import RecordFormat as RecordFormat  # RecordFormat and Source are for new formats
from rocking.motions.formats.record import Source as Source
from rocking.motions.formats.record_set import RecordSet, read_records

__all__ = [
    "Component",
    "Record",
    "RecordSet",
    "formats",
    "read_motion",
    "read_record",
    "read_records",
    "write_motion",
    "write_record",
]
