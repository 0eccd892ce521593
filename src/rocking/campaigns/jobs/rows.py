"""Results as tables with a row a history: Parquet, CSV and Excel, written chunk by chunk."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np

from rocking.campaigns.jobs.results import Results
from rocking.campaigns.jobs.study import TYPES, Coordinate
from rocking.campaigns.jobs.workbook import new_book, save_book
from rocking.errors import InvalidValueError, extra
from rocking.quantities import QUANTITIES
from rocking.studies.fragility.tables import safe_cell

MOST_ROWS_OF_EXCEL = 1_048_575
"""Rows of a sheet, its header apart."""


def to_parquet(results: Results, path: Path) -> None:
    """Write results as Parquet, a group of rows a chunk; units are in the metadata of the columns."""
    pa: Any = extra("pyarrow", "Parquet")
    parquet: Any = extra("pyarrow.parquet", "Parquet")
    fields = []
    for name, coordinate in results.study.coordinates.items():
        kind = (
            pa.dictionary(pa.int32(), pa.string())
            if coordinate.is_words
            else pa.from_numpy_dtype(coordinate.values.dtype)
        )
        fields.append(pa.field(name, kind, metadata={"units": coordinate.unit, "long_name": coordinate.words}))
    for name, number in TYPES.items():
        about = {"units": QUANTITIES[name].unit, "long_name": QUANTITIES[name].meaning}
        fields.append(pa.field(name, pa.from_numpy_dtype(np.dtype(number)), metadata=about))
    told = {name: value if isinstance(value, str) else json.dumps(value) for name, value in results.attributes.items()}
    schema = pa.schema(fields, metadata=told)
    with parquet.ParquetWriter(path, schema) as writer:
        for first, last, arrays in results.pieces():
            columns = [_arrow(pa, coordinate, at) for _, coordinate, at in results.coordinates(first, last)]
            columns += [pa.array(np.asarray(values)) for values in arrays.values()]
            writer.write_table(pa.table(columns, schema=schema))


def _arrow(pa: Any, coordinate: Coordinate, at: np.ndarray) -> Any:
    flat = coordinate.values.ravel()
    if not coordinate.is_words:
        return pa.array(flat[at])
    return pa.DictionaryArray.from_arrays(pa.array(at.astype(np.int32)), pa.array(flat.tolist(), pa.string()))


def to_csv(results: Results, path: Path) -> None:
    """Write results as comma-separated values, all digits kept; units stand in the header."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(_header(results))
        for first, last, arrays in results.pieces():
            writer.writerows(zip(*_columns(results, first, last, arrays), strict=True))


def to_excel(results: Results, path: Path) -> None:
    """Write results as a workbook: one sheet of histories, one that says where they come from."""
    count = results.study.histories.count
    if count > MOST_ROWS_OF_EXCEL:
        raise InvalidValueError(
            f"a sheet of Excel has {MOST_ROWS_OF_EXCEL} rows, these are {count} histories; take .nc, .parquet or .csv"
        )
    book = new_book()
    sheet = book.create_sheet("histories")
    sheet.append(_header(results))
    for first, last, arrays in results.pieces():
        for row in zip(*_columns(results, first, last, arrays), strict=True):
            sheet.append(row)
    sheet = book.create_sheet("provenance")
    for name, value in results.attributes.items():
        sheet.append([name, safe_cell(str(value)[:32_000])])
    save_book(book, path)


def _header(results: Results) -> list[str]:
    units = {name: coordinate.unit for name, coordinate in results.study.coordinates.items()}
    units |= {name: QUANTITIES[name].unit for name in TYPES}
    return [name if unit in {"1", "-"} else f"{name} [{unit}]" for name, unit in units.items()]


def _columns(results: Results, first: int, last: int, arrays: dict[str, Any]) -> list[list[Any]]:
    """Return the cells of some rows, column by column; what is no finite number is left empty."""
    found = []
    for _, coordinate, at in results.coordinates(first, last):
        flat = coordinate.values.ravel()
        found.append([safe_cell(word) for word in flat[at].tolist()] if coordinate.is_words else flat[at].tolist())
    for values in arrays.values():
        cells = np.asarray(values).tolist()
        found.append(cells if np.all(np.isfinite(values)) else [cell if np.isfinite(cell) else None for cell in cells])
    return found
