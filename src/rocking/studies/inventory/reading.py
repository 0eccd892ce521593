"""Inventories from CSV files: columns by name with the unit in it, each row checked by itself."""

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rocking.errors import InvalidValueError
from rocking.studies.inventory.columns import REQUIRED, InventoryColumn, columns_of, has_required
from rocking.studies.inventory.numerals import DecimalMark
from rocking.studies.inventory.objects import InventoryObject, NotAssessed

MOST_ROWS, MOST_BYTES = 100_000, 64 << 20
"""No inventory is longer, no file larger: it is something else."""

_LONGEST_HEADER = 10_000
_TEXTS = ("name", "note")
_DELIMITERS = (",", ";", "\t")
# the line by which Excel is told, and tells, what separates the fields
_SEPARATOR = re.compile(r'"?sep=(.)"?[ \t]*(?=\r?\n|$)', re.IGNORECASE)


@dataclass(frozen=True)
class Inventory:
    """What a file says.

    Parameters
    ----------
    objects : tuple of InventoryObject
        The rows that could be read.
    not_assessed : tuple of NotAssessed
        The rows that could not.
    ignored : tuple of str
        Columns that were not read.
    source : str
        Name of the file.
    """

    objects: tuple[InventoryObject, ...]
    not_assessed: tuple[NotAssessed, ...] = ()
    ignored: tuple[str, ...] = ()
    source: str = "objects"


def read_inventory(path: str | Path, encoding: str = "utf-8-sig") -> Inventory:
    """Return the inventory in a CSV file.

    Parameters
    ----------
    path : str or Path
        The file.
    encoding : str
        Encoding of the text, such as ``cp1252`` for older spreadsheets.

    Returns
    -------
    Inventory
        Objects, and rows with the reason why they are none.

    Raises
    ------
    InvalidValueError
        If the file as a whole cannot be understood.
    """
    path = Path(path)
    if path.stat().st_size > MOST_BYTES:
        raise InvalidValueError(
            f"{path.name}: an inventory must be below {MOST_BYTES >> 20} MiB; another kind of file?"
        )
    try:
        text = path.read_bytes().decode(encoding)
    except (UnicodeDecodeError, LookupError) as error:
        raise InvalidValueError(
            f'{path.name} is not text in {encoding}: save it as "CSV UTF-8", or name its encoding, such as cp1252'
        ) from error
    return parse_inventory(text, path.name)


def parse_inventory(text: str, source: str = "objects") -> Inventory:
    r"""Return the inventory in a text.

    Parameters
    ----------
    text : str
        Lines of CSV with commas, semicolons or tabs between the fields; the first names the columns. Before it may
        stand Excel's own, such as ``sep=;``.
    source : str
        What to call it.

    Returns
    -------
    Inventory
        Objects, and rows with the reason why they are none.

    Raises
    ------
    InvalidValueError
        If there is no header with the columns needed, or a column is named twice, without its unit, or is unknown
        and looks like a measure.

    Examples
    --------
    >>> found = parse_inventory("name;width_cm;depth_cm;height_cm\nvase;12,5;12,5;60\nbox;?;20;30")
    >>> found.objects[0].width, found.not_assessed[0].row
    (0.125, 3)
    """
    lines, allowed = _separator(text.removeprefix("\ufeff"))
    delimiter = _delimiter(lines, allowed, source)
    rows = _rows(lines, delimiter, source)
    columns, ignored = columns_of(rows[0][1], source)
    body = [(line, cells) for line, cells in rows[1:] if any(cell.strip() for cell in cells)]
    numeric = [k for k, column in enumerate(columns) if column and column.fields[0] not in _TEXTS]
    found = (cells[k] for _, cells in body for k in numeric if k < len(cells))
    mark = DecimalMark(found, comma_delimited=delimiter == ",")
    objects, refused = [], []
    for line, cells in body:
        try:
            objects.append(_object(line, cells, columns, mark))
        except InvalidValueError as error:
            refused.append(NotAssessed(line, _name(cells, columns), str(error)))
    if not objects and not refused:
        raise InvalidValueError(f"{source}: an inventory needs at least one row below its header")
    return Inventory(tuple(objects), tuple(refused), ignored, source)


def _separator(text: str) -> tuple[str, tuple[str, ...]]:
    """Return a text with Excel's line about the separator emptied, and what may separate the fields."""
    given = _SEPARATOR.match(text)
    return (text[given.end() :], (given[1],)) if given else (text, _DELIMITERS)


def _delimiter(text: str, allowed: tuple[str, ...], source: str) -> str:
    first = next((line for line in text.splitlines() if line.strip()), "")[:_LONGEST_HEADER]
    fits = [mark for mark in allowed if mark in _DELIMITERS and has_required(next(csv.reader([first], delimiter=mark)))]
    if len(fits) == 1:
        return fits[0]
    raise InvalidValueError(
        f"{source}: the first line must name the columns name, width_cm, depth_cm, height_cm (or _mm, _m, _in, _ft) "
        f"with commas, semicolons or tabs between, got {first[:100]!r}"
    )


def _rows(text: str, delimiter: str, source: str) -> list[tuple[int, list[str]]]:
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    found: list[tuple[int, list[str]]] = []
    line = 1
    try:
        for cells in reader:
            if found or any(cell.strip() for cell in cells):
                found.append((line, cells))
            line = reader.line_num + 1
            if len(found) > MOST_ROWS:
                raise InvalidValueError(f"{source}: an inventory must have at most {MOST_ROWS} rows")
    except csv.Error as error:
        raise InvalidValueError(f"{source}: not a table, line {line}: {error}; a quotation mark left open?") from error
    return found


def _object(
    line: int, cells: Sequence[str], columns: Sequence[InventoryColumn | None], mark: DecimalMark
) -> InventoryObject:
    if len(cells) != len(columns):
        hint = "a decimal comma between commas?" if len(cells) > len(columns) else "a separator missing?"
        raise InvalidValueError(f"it has {len(cells)} fields, the header {len(columns)}; {hint}")
    values: dict[str, object] = {"row": line}
    for column, cell in zip(columns, cells, strict=True):
        if column is None or not cell.strip():
            continue
        values |= dict.fromkeys(column.fields, _value(column, cell, mark))
    titles = {field: column.title for column in columns if column for field in column.fields}
    for each in REQUIRED:
        if each not in values:
            raise InvalidValueError(f"{titles[each]} is empty")
    return InventoryObject(**values)  # type: ignore[arg-type]


def _value(column: InventoryColumn, cell: str, mark: DecimalMark) -> object:
    if column.fields[0] in _TEXTS:
        return cell.strip()
    number = mark.number(column.title, cell) * column.factor
    if column.fields != ("count",):
        return number
    if number != int(number):
        raise InvalidValueError(f"count must be a whole number, got {cell.strip()!r:.40}")
    return int(number)


def _name(cells: Sequence[str], columns: Sequence[InventoryColumn | None]) -> str:
    place = next(k for k, column in enumerate(columns) if column and column.fields == ("name",))
    return cells[place].strip() if place < len(cells) else ""
