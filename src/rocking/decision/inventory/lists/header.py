"""Locate the header of a table: the title rows above most measures."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from rocking.decision.inventory.lists.columns import (
    MEASURED,
    SIZES,
    UNITS,
    Header,
    InventoryColumn,
    header_of,
    levels_of,
    order_of,
    plain,
)  # fmt: skip
from rocking.decision.inventory.lists.sheets import Cell, Sheet, text_of

_HIGHEST = 50  # largest number of rows above the header [-]
_TALLEST = 4
_SAMPLE = 200  # number of examined rows below the header [-]


@dataclass(frozen=True)
class LocatedHeader:
    """A header and its position."""

    first: int  # index of the first row of the header in the table
    end: int  # index of the row below the header
    header: Header
    titles: tuple[tuple[str, ...], ...]  # titles by column, titles of column groups first
    measures: int  # number of measures below the header

    @property
    def score(self) -> tuple[bool, int, int, int, int]:
        """Sort key: required columns present, number of measures, number of known columns, position."""
        header = self.header
        units = sum(column is not None and column.factor not in {None, 1.0} for column in header.columns)
        return (
            not header.missing, self.measures, len(header.fields) + units, self.first - self.end, -self.first
        )  # fmt: skip


def find_header(sheet: Sheet, mapped: Mapping[str, str]) -> LocatedHeader | None:
    """Return the header with the required columns, or with the most known columns; None for an empty table."""
    return max(_candidates(sheet, mapped), key=lambda candidate: candidate.score, default=None)


def _candidates(sheet: Sheet, mapped: Mapping[str, str]) -> Iterator[LocatedHeader]:
    rows = [(line, [text_of(cell) for cell in cells]) for line, cells in sheet.rows[: _HIGHEST + _TALLEST]]
    for first in range(min(len(rows), _HIGHEST)):
        for end in range(first + 1, min(first + _TALLEST, len(rows)) + 1):
            if end > first + 1 and any(text[:1].isdigit() for text in rows[end - 1][1]):
                break  # a row of numbers is below the header
            if end > first + 1 and _is_title_line(rows[first][1], rows[end - 1][1]):
                break
            if first and end - first < _TALLEST and _belongs(*rows[first - 1 : first + 1]):
                continue
            titles = _ordered(_titles(rows[first:end], sheet.spans), [cells for _, cells in sheet.rows[end:][:_SAMPLE]])
            header = header_of(titles, mapped)
            if header.fields:
                measures = 0 if header.missing else _count_measures(header, sheet, end)
                yield LocatedHeader(first, end, header, titles, measures)


def _belongs(above: tuple[int, list[str]], below: tuple[int, list[str]]) -> bool:
    """Return True if the row above a header row belongs to the header: it has text without numbers, and is no title."""
    is_text = not any(text[:1].isdigit() for text in above[1])
    return above[0] + 1 == below[0] and is_text and not _is_title_line(above[1], below[1])


def _is_title_line(texts: Sequence[str], below: Sequence[str]) -> bool:
    """Return True for a title of the table (one text above the first column), but not for a title of a column group."""
    filled = [k for k, text in enumerate(texts) if text]
    return len(filled) == 1 and filled[0] <= next((k for k, text in enumerate(below) if text), 0)


def _titles(rows: Sequence[tuple[int, list[str]]], spans: Mapping[tuple[int, int], int]) -> tuple[tuple[str, ...], ...]:
    """Return the titles of each column, with the titles of its group."""
    width = max([len(rows[-1][1]), *(k + 1 for _, texts in rows for k, text in enumerate(texts) if text)])
    table = [(texts + [""] * (width - len(texts)))[:width] for _, texts in rows]
    spread = [_spread(table, k, line, spans) for k, (line, _) in enumerate(rows)]
    return tuple(levels_of([row[column] for row in spread]) for column in range(width))


def _ordered(titles: tuple[tuple[str, ...], ...], below: Sequence[Sequence[Cell]]) -> tuple[tuple[str, ...], ...]:
    """Return titles with a title such as ``Maße (B x T x H)`` above all number columns to which it applies."""
    ordered = list(titles)
    for first, levels in enumerate(titles):
        columns = range(first + 1, first + max(1, max((len(order_of(title)) for title in levels), default=0)))
        if columns and columns.stop <= len(titles) and not any(titles[k] for k in columns):
            rows = [[text_of(cells[k]) for k in columns] for cells in below if len(cells) >= columns.stop]
            if any(all(text[:1].isdigit() for text in row) for row in rows):
                ordered[columns.start : columns.stop] = [levels] * len(columns)
    return tuple(ordered)


def _spread(table: list[list[str]], k: int, line: int, spans: Mapping[tuple[int, int], int]) -> list[str]:
    """Return a row of a header with each title repeated in its columns: merged columns, or up to the next title."""
    row = list(table[k])
    merged = {column: spans[line, column] for column in range(len(row)) if (line, column) in spans and row[column]}
    for column, count in merged.items():
        row[column : column + count] = [row[column]] * min(count, len(row) - column)
    if merged or (k == len(table) - 1 and not _is_of_units(row)):
        return row
    for column in range(1, len(row)):
        above = any(table[j][column] for j in range(k))
        below = any(lower_row[column] and not _is_of_units(lower_row) for lower_row in table[k + 1 :])
        if not row[column] and (above if _is_of_units(table[k]) else below and not above):
            row[column] = row[column - 1]
    return row


def _is_of_units(row: Sequence[str]) -> bool:
    return all(not text or plain(text) in UNITS for text in row)


def _count_measures(header: Header, sheet: Sheet, end: int) -> int:
    """Return the number of sizes in the rows below a header; 0 if two columns have the same size."""
    columns = [(k, column) for k, column in enumerate(header.columns) if column and column.stem in MEASURED]
    fields = [field for _, column in columns if column.stem in SIZES for field in column.fields]
    if len(set(fields)) < len(fields):
        return 0
    rows = (cells for _, cells in sheet.rows[end : end + _SAMPLE])
    return sum(min(3, sum(_count_sizes(column, cells[k]) for k, column in columns if k < len(cells))) for cells in rows)


def _count_sizes(column: InventoryColumn, cell: Cell) -> int:
    """Return the possible number of sizes in a cell."""
    if column.stem == "body_file":
        return 3 if text_of(cell) else 0
    numbers = len(re.findall(r"\d+(?:[.,]\d+)?", text_of(cell)))
    return 3 * (numbers > 1) if column.stem == "size" else min(numbers, 1)
