"""Lists in files: read a workbook, or text in any encoding, to rows of cells, with limits on the size."""

import contextlib
import csv
import io
import itertools
import re
import warnings
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sized
from dataclasses import dataclass, field
from datetime import date, time
from typing import Any
from xml.parsers import expat

from rocking.errors import InvalidValueError, RockingError, extra

MOST_ROWS, MOST_BYTES = 100_000, 64 << 20
"""Largest numbers of rows and of bytes, packed or unpacked, of an inventory."""

MOST_COLUMNS, _MOST_LINES, _MOST_SHEETS, _MOST_MERGED = 200, 1 << 20, 50, 1000

Cell = str | float
"""Text, or a number of a spreadsheet; an empty cell is an empty text."""


class Shown(float):
    """A number of a spreadsheet with a text in its format, such as a unit; `unity` is 1 in this format."""

    unity = "1"


Row = tuple[int, list[Cell]]
"""First line of the row, and its cells."""


@dataclass(frozen=True)
class Sheet:
    """A table of a file."""

    source: str  # name of the file, with table or encoding
    rows: list[Row]
    delimiter: str = ""  # delimiter of a text file
    spans: Mapping[tuple[int, int], int] = field(default_factory=dict)  # number of merged columns by line and column


def sheets_in(content: bytes, source: str) -> Iterator[Sheet] | None:
    """Return the tables of a workbook; None for other files."""
    if content.startswith(b"\xd0\xcf\x11\xe0"):
        raise InvalidValueError(
            "the file is an old .xls or has a password", hint="Save it as .xlsx, .ods or CSV UTF-8."
        ).at(source)
    if not content.startswith(b"PK\x03\x04"):
        return None
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # warnings about ignored styles and data validation
            names, size = archive.namelist(), sum(entry.file_size for entry in archive.infolist())
            if size > MOST_BYTES:
                raise InvalidValueError(
                    "the unpacked file is larger than {limit} MiB", limit=MOST_BYTES >> 20, hint="Save it as CSV."
                ).at(source)
            if "xl/workbook.xml" in names:
                tables = list(_of_excel(archive, content))
            elif "content.xml" in names:
                tables = _of_open_document(archive.read("content.xml"))
            else:
                raise InvalidValueError("unsupported file", hint="Use .xlsx, .ods or CSV UTF-8.").at(source)
    except (RockingError, ModuleNotFoundError):
        raise
    except Exception as error:  # for a damaged file, the reader raises any error
        raise InvalidValueError(
            "the workbook is damaged ({error})", error=type(error).__name__,
            hint="Open it in a spreadsheet and save it again.",
        ).at(source) from error  # fmt: skip
    several = len(tables) > 1
    return (
        Sheet(f"{source} ({name})" if several else source, _filled(rows, merged, source), spans=_spans(merged))
        for name, rows, merged in tables
    )


_Merged = list[tuple[int, int, int, int]]  # first line and column, last line and column


def _of_excel(archive: zipfile.ZipFile, content: bytes) -> Iterator[tuple[str, Iterable[Row], _Merged]]:
    book = extra("openpyxl", "reading a workbook").load_workbook(io.BytesIO(content), read_only=True, data_only=True)
    for sheet in book.worksheets[:_MOST_SHEETS]:
        if sheet.sheet_state != "visible":
            continue
        text = archive.read(sheet._worksheet_path)
        merges = itertools.islice(
            re.finditer(rb'<mergeCell ref="([A-Z]{1,3})(\d{1,7}):([A-Z]{1,3})(\d{1,7})"', text), _MOST_MERGED
        )
        merged = [(int(mark[2]), _place(mark[1]), int(mark[4]), _place(mark[3])) for mark in merges]
        yield sheet.title, _held(_lines(sheet)), merged


def _lines(sheet: Any) -> Iterator[Row]:
    blank = None
    for line, cells in enumerate(sheet.iter_rows(max_row=_MOST_LINES, max_col=MOST_COLUMNS), start=1):
        if cells is blank:  # a file can repeat a row a million times
            continue
        if all(cell.value is None for cell in cells):
            blank = cells
        else:
            yield line, [_shown(_cell(cell.value), cell) for cell in cells]


_LITERAL = r'(?:"([^"]*)"|\\(.)|( ))'
_FORMAT = re.compile(rf"({_LITERAL}*)[#0?][#0?,.]*({_LITERAL}*)")


def _shown(value: Cell, cell: Any) -> Cell:
    """Return a number with the text of its format."""
    if isinstance(value, str):
        return value
    written = _FORMAT.fullmatch(re.sub(r"_.|\*.|\[[^\]]*\]", "", cell.number_format.partition(";")[0]))
    before, after = (re.sub(_LITERAL, r"\1\2\3", written[k]) if written else "" for k in (1, 5))
    return _with_format(value, before, after)


def _with_format(value: float, before: str, after: str) -> float:
    if not (before + after).strip():
        return value
    shown = Shown(value)
    shown.unity = f"{before}1{after}"
    return shown


def _place(letters: bytes) -> int:
    index = 0
    for letter in letters:
        index = 26 * index + letter - 64
    return index - 1


def _cell(value: Any) -> Cell:
    if value is None:
        return ""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value) if abs(value) < 1e300 else str(value)
    if isinstance(value, (date, time)):
        return value.isoformat().removesuffix("T00:00:00")
    return str(value).strip()


def _of_open_document(content: bytes) -> list[tuple[str, Iterable[Row], _Merged]]:
    reader = _OpenDocument()
    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = reader.start, reader.end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = reader.characters, reader.doctype
    parser.Parse(content, True)
    return [(name, rows, merged) for name, rows, merged in reader.tables]


class _OpenDocument:
    """Parser of ``content.xml``, whose tables can repeat cells and rows a million times."""

    def __init__(self) -> None:
        self.tables: list[tuple[str, list[Row], _Merged]] = []
        self.line, self.row, self.text, self.depth = 0, [], [], 0  # type: ignore[var-annotated]
        self.cell: dict[str, str] | None = None

    def doctype(self, *_: Any) -> None:
        raise InvalidValueError("an .ods file with its own document type (DTD) is not supported")

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        if tag == "table:table" and len(self.tables) < _MOST_SHEETS:
            self.tables.append((attributes.get("table:name", ""), [], []))
            self.line = 0
        elif tag == "table:table-row":
            self.row, self.repeated = [], int(attributes.get("table:number-rows-repeated", 1))
        elif tag in {"table:table-cell", "table:covered-table-cell"}:
            self.cell, self.text = attributes, []
        elif tag == "office:annotation":
            self.depth += 1
        elif tag == "text:p" and self.text and not self.depth:
            self.text.append(" ")

    def characters(self, text: str) -> None:
        if self.cell is not None and not self.depth:
            self.text.append(text)

    def end(self, tag: str) -> None:
        if tag == "office:annotation":
            self.depth -= 1
        elif tag in {"table:table-cell", "table:covered-table-cell"} and self.cell is not None:
            self._close()
        elif tag == "table:table-row" and self.tables:
            _, rows, _ = self.tables[-1]
            blank = not any(cell != "" for cell in self.row)
            for k in range(0 if blank else min(self.repeated, MOST_ROWS + 1 - len(rows))):
                rows.append((self.line + k + 1, list(self.row)))
            self.line += self.repeated

    def _close(self) -> None:
        attributes, text = self.cell or {}, "".join(self.text).strip()
        self.cell = None
        down, across = (int(attributes.get(f"table:number-{way}-spanned", 1)) for way in ("rows", "columns"))
        if max(down, across) > 1 and self.tables and len(self.tables[-1][2]) < _MOST_MERGED:
            column = len(self.row)
            self.tables[-1][2].append((self.line + 1, column, self.line + down, column + across - 1))
        value: Cell = text
        if attributes.get("office:value-type") in {"float", "currency"} and not text.startswith("#"):
            value = _cell(float(attributes.get("office:value", "nan")))
            if isinstance(value, float) and (written := re.fullmatch(r"([^\d-]*)\d[\d.,' ]*(.*)", text)):
                value = _with_format(value, *written.groups())
        elif attributes.get("office:value-type") == "date":
            value = attributes.get("office:date-value", text)
        repeats = min(int(attributes.get("table:number-columns-repeated", 1)), MOST_COLUMNS - len(self.row))
        self.row += [value] * repeats


def _held(rows: Iterable[Row]) -> list[Row]:
    """Return the non-empty rows."""
    filled = (row for row in rows if any(cell != "" for cell in row[1]))
    return list(itertools.islice(filled, MOST_ROWS + 1))


def _filled(rows: Iterable[Row], merged: _Merged, source: str) -> list[Row]:
    """Return rows of equal width; the value of vertically merged cells is repeated in each of their rows."""
    rows = list(rows)
    _check_number(rows, source)
    width = max((len(cells) for _, cells in rows), default=0)
    table = {line: cells + [""] * (width - len(cells)) for line, cells in rows}
    for first, column, last, _ in merged:
        if first in table and column < width:
            for line in range(first + 1, min(last, first + _MOST_MERGED) + 1):
                if line in table:
                    table[line][column] = table[first][column]
    return list(table.items())


def _spans(merged: _Merged) -> dict[tuple[int, int], int]:
    """Return the number of merged columns by line and column."""
    return {
        (line, first): last - first + 1
        for top, first, bottom, last in merged if last > first
        for line in range(top, min(bottom, top + _MOST_MERGED) + 1)
    }  # fmt: skip


def _check_number(rows: Sized, source: str) -> None:
    if len(rows) > MOST_ROWS:
        raise InvalidValueError("a list must have at most {limit} rows", limit=MOST_ROWS).at(source)


ENCODINGS = ("cp1252", "cp1253", "cp1254", "gb18030", "mac_roman")
"""Encodings of older spreadsheets. The encoding with the best header is used."""


def texts_in(content: bytes, source: str, encoding: str | None) -> Iterator[tuple[str, str]]:
    """Yield the possible texts of a file with their encodings, or one text if the encoding is known."""
    marks = {b"\xef\xbb\xbf": "utf-8-sig", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
    stated = encoding or next((name for mark, name in marks.items() if content.startswith(mark)), None)
    wide = ("utf-16-le", "utf-16-be") if b"\0" in content[:2000] else ()
    count = 0
    for name in (stated,) if stated else wide or ("utf-8", *ENCODINGS):
        with contextlib.suppress(UnicodeDecodeError, LookupError, ValueError):
            text = content.decode(name)
            count += 1
            yield text, name
            if name == "utf-8":
                return
    if not count:
        raise InvalidValueError(
            '{file} is not text in {encodings}. Save it as "CSV UTF-8", or state its encoding, such as cp1252.',
            file=source, encodings=stated or "any encoding of spreadsheets",
        )  # fmt: skip


_DELIMITERS = (",", ";", "\t")
# separator line of Excel
_SEPARATOR = re.compile(r'"?sep=(.)"?[ \t]*(?=\r?\n|$)', re.IGNORECASE)
_BEGINNING, _LONGEST_LINE = 50, 10_000


def tables_of(text: str) -> Iterator[tuple[str, list[list[str]], str]]:
    """Yield each possible delimiter of a text, its first rows with this delimiter, and the text."""
    lines, allowed = text.removeprefix("\ufeff"), _DELIMITERS
    if separator := _SEPARATOR.match(lines):
        lines, allowed = lines[separator.end() :], (separator[1],)  # type: ignore[assignment]
    first = [line[:_LONGEST_LINE] for line in itertools.islice(io.StringIO(lines), _BEGINNING)]
    for delimiter in allowed:
        if delimiter in _DELIMITERS:
            with contextlib.suppress(csv.Error):
                yield delimiter, list(csv.reader(first, delimiter=delimiter)), lines


def rows_of(text: str, delimiter: str, source: str) -> list[tuple[int, list[str]]]:
    """Return the rows of CSV from the first row that is not empty, with their first lines."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    rows: list[tuple[int, list[str]]] = []
    line = 1
    try:
        for cells in reader:
            if rows or any(cell.strip() for cell in cells):
                rows.append((line, cells))
            line = reader.line_num + 1
            _check_number(rows, source)
    except csv.Error as error:
        raise InvalidValueError(
            "the file is not a table; line {line}: {reason}",
            line=line,
            reason=str(error),
            hint="Check for an open quotation mark.",
        ).at(source) from error
    return rows


def text_of(cell: Cell) -> str:
    """Return the text of a cell.

    >>> text_of(12.0), text_of(" a ")
    ('12', 'a')
    """
    if isinstance(cell, str):
        return cell.strip()
    return str(int(cell)) if cell == int(cell) else repr(cell)


def text_of_row(cells: Iterable[Cell], separator: str = " ") -> str:
    """Return the texts of the non-empty cells of a row in one line."""
    return separator.join(filter(None, map(text_of, cells)))
