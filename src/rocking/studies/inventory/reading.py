"""Inventories from CSV files: columns by name with the unit in it, each row checked by itself."""

import csv
import difflib
import io
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.bodies import Block, Section, Solid
from rocking.bodies.formats import read_body
from rocking.conventions import LENGTH_UNITS
from rocking.errors import InvalidValueError, RockingError
from rocking.studies.inventory.objects import InventoryObject, NotAssessed

LENGTHS = ("width", "depth", "height", "base_width", "base_depth", "centre_of_mass_height")
"""Columns that are lengths; the name of the column ends with the unit, as in ``width_cm``."""

REQUIRED = ("name", "width", "depth", "height")
"""Columns that an inventory must have."""

WEIGHTS = {"kg": 1.0, "g": 0.001, "t": 1000.0, "lb": 0.45359237}
"""Units of the column of weights [kg]."""

WORDS = ("name", "count", "note", "friction", "body_file", "units")
"""Columns without a unit."""

_MEASURES = (*LENGTHS, "base", "weight")
_ALIASES = {"mass": "weight", "centre_of_gravity": "centre_of_mass_height", "com_height": "centre_of_mass_height"}
_FIELDS = {"weight": ("mass",), "base": ("base_width", "base_depth")}

# a column of such a name may decide the verdict: not to read it needs the user's word, not a guess
_TELLING = frozenset({
    "base", "foot", "feet", "centre", "gravity", "mass", "diameter", "height", "width", "depth", "weight",
})  # fmt: skip


@dataclass(frozen=True)
class InventoryColumn:
    """What a column holds."""

    fields: tuple[str, ...]  # fields of `InventoryObject` that it gives: a base without a direction gives both
    factor: float  # what turns its numbers into SI units
    title: str  # its name in the file


def columns_of(titles: Sequence[str], source: str) -> tuple[list[InventoryColumn | None], tuple[str, ...]]:
    """Return what the columns of a file hold, None for one that is not read; and the names of these.

    >>> columns, ignored = columns_of(["name", "base_cm", "room"], "list.csv")
    >>> columns[1].fields, ignored
    (('base_width', 'base_depth'), ('room',))
    """
    columns = [_column(title, source) for title in titles]
    fields = [field for column in columns if column for field in column.fields]
    for each in fields:
        if fields.count(each) > 1:
            raise InvalidValueError(f"{source}: two columns give the {each.replace('_', ' ')}; leave one")
    pairs = zip(titles, columns, strict=True)
    return columns, tuple(title.strip() for title, column in pairs if column is None and title.strip())


def _split(title: str) -> tuple[str, str]:
    """Return what a column holds, and its unit."""
    plain = title.strip().casefold().replace("center", "centre")
    for mark in "()[]":
        plain = plain.replace(mark, " ")
    words = "_".join(plain.replace("_", " ").replace("-", " ").split())
    stem, _, unit = words.rpartition("_")
    whole, stem = _ALIASES.get(words, words), _ALIASES.get(stem, stem)
    return (stem, unit) if stem in _MEASURES and whole not in _MEASURES else (whole, "")


def _column(title: str, source: str) -> InventoryColumn | None:
    stem, unit = _split(title)
    if stem in _MEASURES:
        units = WEIGHTS if stem == "weight" else LENGTH_UNITS
        if unit not in units:
            known = ", ".join(f"{stem}_{each}" for each in units)
            raise InvalidValueError(f"{source}: column {title.strip()!r} must name its unit: {known}")
        return InventoryColumn(_FIELDS.get(stem, (stem,)), units[unit], title.strip())
    if stem in WORDS:
        return InventoryColumn((stem,), 1.0, title.strip())
    _refuse_measure(title.strip(), stem, source)
    return None


def _refuse_measure(title: str, words: str, source: str) -> None:
    """Refuse an unknown column that looks like a measure: the verdict might hang on it."""
    stem, _, unit = words.rpartition("_")
    measured = bool(stem) and (unit in LENGTH_UNITS or unit in WEIGHTS)
    close = difflib.get_close_matches(stem or words, _MEASURES, n=1, cutoff=0.8)
    if not (measured or close or _TELLING.intersection(words.split("_"))):
        return
    near = close or difflib.get_close_matches(stem or words, _MEASURES, n=3, cutoff=0.5) or _MEASURES
    names = ", ".join(f"{each}_{'kg' if each == 'weight' else 'cm'}" for each in near)
    raise InvalidValueError(
        f"{source}: column {title!r} is not known but looks like a measure; {names}? "
        "Rename it, or leave it out if it is none"
    )


_NUMBER = re.compile(r"[+-]?[0-9]+(?:([.,])([0-9]+))?(?:[eE][+-]?[0-9]+)?")
# three digits after the mark could be thousands, unless what is before cannot be
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}[.,][0-9]{3}")


class DecimalMark:
    """What separates the decimals in a table, found in all of its numbers together.

    ``12,5`` can only be a decimal comma; ``1,234`` could be a thousand, and so could ``1.234``. Either is taken only
    where the same mark stands for decimals elsewhere in the table and the other does not. Where commas part the fields,
    decimals have points, and ``1.234`` is taken unless a decimal comma contradicts it.

    >>> mark = DecimalMark(["12,5", "1,234", "7"])
    >>> mark.number("width_cm", "1,234")
    1.234
    """

    def __init__(self, cells: Iterable[str], *, comma_delimited: bool = False) -> None:
        marks = set()
        for cell in cells:
            match = _NUMBER.fullmatch(cell.strip())
            if match and match[1] and not _THOUSANDS.fullmatch(cell.strip()):
                marks.add(match[1])
        self.commas, self.points, self.comma_delimited = "," in marks, "." in marks, comma_delimited

    def number(self, name: str, cell: str) -> float:
        """Return the number in a cell, in the unit of the column."""
        text = cell.strip()
        match = _NUMBER.fullmatch(text)
        if not match:
            raise InvalidValueError(
                f"{name} must be one number such as 12.5, without unit and without separators of thousands, "
                f"got {text[:40]!r}"
            )
        settled = (
            self.commas and not self.points
            if match[1] == ","
            else not self.commas and (self.points or self.comma_delimited)
        )
        if _THOUSANDS.fullmatch(text) and not settled:
            digits = text.replace(match[1], "")
            decimal = text.replace(",", ".")
            raise InvalidValueError(
                f"{name} is ambiguous: {text!r} could be {decimal} or {digits}; write {decimal}0 or {digits}"
            )
        return checks.number(name, float(text.replace(",", ".")))


MOST_ROWS, MOST_BYTES = 100_000, 64 << 20
"""No inventory is longer, no file larger: it is something else."""

_LONGEST_HEADER = 10_000
_TEXTS = ("name", "note", "body_file", "units")
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
    language : str
        In which its header is written, and its report is: ``en``, ``de``, ``it`` and more.
    """

    objects: tuple[InventoryObject, ...]
    not_assessed: tuple[NotAssessed, ...] = ()
    ignored: tuple[str, ...] = ()
    source: str = "objects"
    language: str = "en"


def read_inventory(
    path: str | Path, encoding: str = "utf-8-sig", find: Callable[[str], Path] | None = None
) -> Inventory:
    """Return the inventory in a CSV file.

    Parameters
    ----------
    path : str or Path
        The file.
    encoding : str
        Encoding of the text, such as ``cp1252`` for older spreadsheets.
    find : callable, optional
        Where a body file is that the list names; beside the list if not given.

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
    return parse_inventory(text, path.name, find or (lambda name: path.parent / name))


def parse_inventory(text: str, source: str = "objects", find: Callable[[str], Path] | None = None) -> Inventory:
    r"""Return the inventory in a text.

    Parameters
    ----------
    text : str
        Lines of CSV with commas, semicolons or tabs between the fields; the first names the columns. Before it may
        stand Excel's own, such as ``sep=;``.
    source : str
        What to call it.
    find : callable, optional
        Where a body file is that a row names; without it none may be named.

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
    lines = text.removeprefix("\ufeff")
    allowed: tuple[str, ...] = _DELIMITERS
    if separator := _SEPARATOR.match(lines):
        lines, allowed = lines[separator.end() :], (separator[1],)
    delimiter = _delimiter(lines, allowed, source)
    rows = rows_of(lines, delimiter, source)
    columns, ignored = columns_of(rows[0][1], source)
    body = [(line, cells) for line, cells in rows[1:] if any(cell.strip() for cell in cells)]
    numeric = [k for k, column in enumerate(columns) if column and column.fields[0] not in _TEXTS]
    numbers = (cells[k] for _, cells in body for k in numeric if k < len(cells))
    mark = DecimalMark(numbers, comma_delimited=delimiter == ",")
    name = next(k for k, column in enumerate(columns) if column and column.fields == ("name",))
    objects, refused = [], []
    for line, cells in body:
        try:
            objects.append(_object(line, cells, columns, mark, find))
        except RockingError as error:
            refused.append(NotAssessed(line, "".join(cells[name : name + 1]).strip(), str(error)))
    if not objects and not refused:
        raise InvalidValueError(f"{source}: an inventory needs at least one row below its header")
    return Inventory(tuple(objects), tuple(refused), ignored, source)


def _delimiter(text: str, allowed: tuple[str, ...], source: str) -> str:
    first = next((line for line in text.splitlines() if line.strip()), "")[:_LONGEST_HEADER]
    fits = []
    for mark in allowed:
        if mark in _DELIMITERS:
            stems = {_split(title)[0] for title in next(csv.reader([first], delimiter=mark))}  # whatever the units
            fits += [mark] * (stems.issuperset(REQUIRED) or stems.issuperset({"name", "body_file"}))
    if len(fits) == 1:
        return fits[0]
    raise InvalidValueError(
        f"{source}: the first line must name the columns name, width_cm, depth_cm, height_cm (or _mm, _m, _in, _ft) "
        f"with commas, semicolons or tabs between, got {first[:100]!r}"
    )


def rows_of(text: str, delimiter: str, source: str) -> list[tuple[int, list[str]]]:
    """Return the rows of CSV that are not empty before the first, with the line on which each begins."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    rows: list[tuple[int, list[str]]] = []
    line = 1
    try:
        for cells in reader:
            if rows or any(cell.strip() for cell in cells):
                rows.append((line, cells))
            line = reader.line_num + 1
            if len(rows) > MOST_ROWS:
                raise InvalidValueError(f"{source}: a list must have at most {MOST_ROWS} rows")
    except csv.Error as error:
        raise InvalidValueError(f"{source}: not a table, line {line}: {error}; a quotation mark left open?") from error
    return rows


def _object(
    line: int,
    cells: Sequence[str],
    columns: Sequence[InventoryColumn | None],
    mark: DecimalMark,
    find: Callable[[str], Path] | None,
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
    name, units = values.pop("body_file", None), values.pop("units", None)
    if name is not None:
        if stated := sorted({*LENGTHS, "mass"} & set(values)):
            raise InvalidValueError(f"its body file says what it is: leave {titles[stated[0]]} empty")
        values |= _body(str(name), units, find)
    for each in REQUIRED:
        if each not in values:
            raise InvalidValueError(f"{titles.get(each, each)} is empty")
    return InventoryObject(**values)  # type: ignore[arg-type]


def _body(name: str, units: Any, find: Callable[[str], Path] | None) -> dict[str, object]:
    """Return the body of a file, and its size."""
    if find is None:
        raise InvalidValueError(f"names the body file {name!r:.60}, but no file can be named here")
    body = read_body(find(name), units=units)
    if isinstance(body, (Block, Section)):
        body = Solid.from_section(body)
    if not isinstance(body, Solid):
        raise InvalidValueError(f"{name}: mass points have no shape to stand on in three dimensions")
    size = body.box[1] - body.box[0]
    return {"solid": body, **dict(zip(("width", "depth", "height"), size.tolist(), strict=True))}


def _value(column: InventoryColumn, cell: str, mark: DecimalMark) -> object:
    if column.fields[0] in _TEXTS:
        return cell.strip()
    number = mark.number(column.title, cell) * column.factor
    if column.fields != ("count",):
        return number
    if number != int(number):
        raise InvalidValueError(f"count must be a whole number, got {cell.strip()!r:.40}")
    return int(number)
