"""Inventories from CSV files: columns by name with the unit in it, each row checked by itself."""

import csv
import difflib
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rocking.conventions import LENGTH_UNITS
from rocking.errors import InvalidValueError
from rocking.studies.inventory.numerals import DecimalMark
from rocking.studies.inventory.objects import InventoryObject, NotAssessed

LENGTHS = ("width", "depth", "height", "base_width", "base_depth", "centre_of_mass_height")
"""Columns that are lengths; the name of the column ends with the unit, as in ``width_cm``."""

REQUIRED = ("name", "width", "depth", "height")
"""Columns that an inventory must have."""

WEIGHTS = {"kg": 1.0, "g": 0.001, "t": 1000.0, "lb": 0.45359237}
"""Units of the column of weights [kg]."""

MOST_ROWS, MOST_BYTES = 100_000, 64 << 20
"""No inventory is longer, no file larger: it is something else."""

_DELIMITERS = {",": "commas", ";": "semicolons", "\t": "tabs"}
_PLAIN = ("name", "count", "note")


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


@dataclass(frozen=True)
class _Column:
    field: str
    factor: float
    title: str


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
        Lines of CSV with commas, semicolons or tabs between the fields; the first names the columns.
    source : str
        What to call it.

    Returns
    -------
    Inventory
        Objects, and rows with the reason why they are none.

    Raises
    ------
    InvalidValueError
        If there is no header with the columns needed, or a column is named twice or without its unit.

    Examples
    --------
    >>> found = parse_inventory("name;width_cm;depth_cm;height_cm\nvase;12,5;12,5;60\nbox;?;20;30")
    >>> found.objects[0].width, found.not_assessed[0].row
    (0.125, 3)
    """
    lines = text.removeprefix("\ufeff")
    delimiter = _delimiter(lines, source)
    rows = _rows(lines, delimiter, source)
    columns, ignored = _columns(rows[0][1], source)
    body = [(line, cells) for line, cells in rows[1:] if any(cell.strip() for cell in cells)]
    numeric = [k for k, column in enumerate(columns) if column and column.field not in {"name", "note"}]
    mark = DecimalMark(cells[k] for _, cells in body for k in numeric if k < len(cells))
    objects, refused = [], []
    for line, cells in body:
        try:
            objects.append(_object(line, cells, columns, mark))
        except InvalidValueError as error:
            refused.append(NotAssessed(line, _name(cells, columns), str(error)))
    if not objects and not refused:
        raise InvalidValueError(f"{source}: an inventory needs at least one row below its header")
    return Inventory(tuple(objects), tuple(refused), ignored, source)


def _delimiter(text: str, source: str) -> str:
    first = next((line for line in text.splitlines() if line.strip()), "")
    fits = [mark for mark in _DELIMITERS if _has_required(next(csv.reader([first], delimiter=mark), []))]
    if len(fits) == 1:
        return fits[0]
    raise InvalidValueError(
        f"{source}: the first line must name the columns name, width_cm, depth_cm, height_cm (or _mm, _m, _in, _ft) "
        f"with commas, semicolons or tabs between, got {first[:100]!r}"
    )


def _has_required(titles: Sequence[str]) -> bool:
    stems = {_split(title)[0] for title in titles}
    return all(each in stems for each in REQUIRED)


def _split(title: str) -> tuple[str, str]:
    """Return what a column holds, and its unit."""
    plain = title.strip().casefold().replace("center", "centre")
    for mark in "()[]":
        plain = plain.replace(mark, " ")
    words = "_".join(plain.replace("_", " ").replace("-", " ").split())
    stem, _, unit = words.rpartition("_")
    return (stem, unit) if stem in LENGTHS or stem == "weight" else (words, "")


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


def _columns(titles: Sequence[str], source: str) -> tuple[list[_Column | None], tuple[str, ...]]:
    columns = [_column(title, source) for title in titles]
    fields = [column.field for column in columns if column]
    for each in fields:
        if fields.count(each) > 1:
            raise InvalidValueError(f"{source}: two columns give the {each.replace('_', ' ')}; leave one")
    pairs = zip(titles, columns, strict=True)
    return columns, tuple(title.strip() for title, column in pairs if column is None and title.strip())


def _column(title: str, source: str) -> _Column | None:
    stem, unit = _split(title)
    if stem in LENGTHS or stem == "weight":
        units = WEIGHTS if stem == "weight" else LENGTH_UNITS
        if unit not in units:
            known = ", ".join(f"{stem}_{each}" for each in units)
            raise InvalidValueError(f"{source}: column {title.strip()!r} must name its unit: {known}")
        return _Column("mass" if stem == "weight" else stem, units[unit], title.strip())
    if stem in _PLAIN:
        return _Column(stem, 1.0, title.strip())
    close = difflib.get_close_matches(stem.rpartition("_")[0] or stem, [*LENGTHS, "weight"], n=1, cutoff=0.8)
    if close:
        unit = "kg" if close[0] == "weight" else "cm"
        raise InvalidValueError(f"{source}: column {title.strip()!r} is not known; {close[0]}_{unit}?")
    return None


def _object(line: int, cells: Sequence[str], columns: Sequence[_Column | None], mark: DecimalMark) -> InventoryObject:
    if len(cells) != len(columns):
        hint = "a decimal comma between commas?" if len(cells) > len(columns) else "a separator missing?"
        raise InvalidValueError(f"it has {len(cells)} fields, the header {len(columns)}; {hint}")
    values: dict[str, object] = {"row": line}
    for column, cell in zip(columns, cells, strict=True):
        if column is None or not cell.strip():
            continue
        values[column.field] = _value(column, cell, mark)
    titles = {column.field: column.title for column in columns if column}
    for each in REQUIRED:
        if each not in values:
            raise InvalidValueError(f"{titles[each]} is empty")
    return InventoryObject(**values)  # type: ignore[arg-type]


def _value(column: _Column, cell: str, mark: DecimalMark) -> object:
    if column.field in {"name", "note"}:
        return cell.strip()
    number = mark.number(column.title, cell) * column.factor
    if column.field != "count":
        return number
    if number != int(number):
        raise InvalidValueError(f"count must be a whole number, got {cell.strip()!r:.40}")
    return int(number)


def _name(cells: Sequence[str], columns: Sequence[_Column | None]) -> str:
    place = next(k for k, column in enumerate(columns) if column and column.field == "name")
    return cells[place].strip() if place < len(cells) else ""
