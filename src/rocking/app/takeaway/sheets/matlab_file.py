"""Tables as a MATLAB file."""

import io
import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking.app.takeaway.plain_text import LONGEST_CELL, plain_line
from rocking.app.takeaway.sheets.sheet import Column, Sheet


def matlab_of(sheets: Sequence[Sheet]) -> bytes:
    """Return tables as a MATLAB file (version 5): one structure ``rocking`` with columns, units and provenance."""
    from scipy.io import savemat

    first = sheets[0]
    made = _structure(first) if len(sheets) == 1 else {sheet.variable[:31]: _structure(sheet) for sheet in sheets}
    stream: Any = io.BytesIO()  # its stubs know only of files with names
    savemat(stream, {"rocking": made}, oned_as="column", long_field_names=True)
    data: bytes = stream.getvalue()
    return data


def _structure(sheet: Sheet) -> dict[str, Any]:
    return {
        **{column.name: _values(column) for column in sheet.columns},
        "units": {column.name: column.unit for column in sheet.columns},
        "provenance": json.dumps({key: plain_line(value) for key, value in sheet.about.items()}),
    }


def _values(column: Column) -> np.ndarray:
    if not column.is_text:
        return column.numbers
    made = np.empty(len(column.values), dtype=object)
    made[:] = [plain_line(words, LONGEST_CELL) for words in column.words]
    return made
