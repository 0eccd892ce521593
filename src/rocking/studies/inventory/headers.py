"""The header of a table: the rows that name its columns, below which most measures are found."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from rocking.studies.inventory.columns import (
    SIZES,
    UNITS,
    Header,
    InventoryColumn,
    header_of,
    levels_of,
    order_of,
    plain,
)  # fmt: skip
from rocking.studies.inventory.sheets import Cell, Sheet

_HIGHEST = 50  # rows of titles above it
_TALLEST = 4
_SAMPLE = 200  # rows below it that are looked at


@dataclass(frozen=True)
class FoundHeader:
    """A header and where it is."""

    first: int  # place of its first row in the table
    end: int  # place of the row below it
    header: Header
    titles: tuple[tuple[str, ...], ...]  # of each column, those of a group of columns first
    measures: int  # cells below that are measures

    @property
    def score(self) -> tuple[bool, int, int, int, int]:
        """Whether the columns needed are there, measures below, what is understood; the lower and higher of equals."""
        header = self.header
        units = sum(each is not None and each.factor not in {None, 1.0} for each in header.columns)
        return (
            not header.missing, self.measures, len(header.known) + units, self.first - self.end, -self.first
        )  # fmt: skip


def find_header(sheet: Sheet, mapped: Mapping[str, str]) -> FoundHeader | None:
    """Return the rows that name what a list must have, or those that name most; None of an empty table."""
    return max(_candidates(sheet, mapped), key=lambda each: each.score, default=None)


def _candidates(sheet: Sheet, mapped: Mapping[str, str]) -> Iterator[FoundHeader]:
    rows = [(line, [text_of(cell) for cell in cells]) for line, cells in sheet.rows[: _HIGHEST + _TALLEST]]
    for first in range(min(len(rows), _HIGHEST)):
        for end in range(first + 1, min(first + _TALLEST, len(rows)) + 1):
            if end > first + 1 and any(text[:1].isdigit() for text in rows[end - 1][1]):
                break  # a row of numbers
            if end > first + 1 and _is_title_line(rows[first][1], rows[end - 1][1]):
                break
            if first and end - first < _TALLEST and _belongs(*rows[first - 1 : first + 1]):
                continue
            titles = _ordered(_titles(rows[first:end], sheet.spans), [cells for _, cells in sheet.rows[end:][:_SAMPLE]])
            header = header_of(titles, mapped)
            if header.known:
                measures = 0 if header.missing else _count_measures(header, sheet, end)
                yield FoundHeader(first, end, header, titles, measures)


def _belongs(above: tuple[int, list[str]], below: tuple[int, list[str]]) -> bool:
    """Return whether a row above a row of a header belongs to it: words without numbers, next to it, and no title."""
    words = not any(text[:1].isdigit() for text in above[1])
    return above[0] + 1 == below[0] and words and not _is_title_line(above[1], below[1])


def _is_title_line(texts: Sequence[str], below: Sequence[str]) -> bool:
    """Return whether a row is one text that begins where the table does: a title of all, and of no group of columns."""
    places = [k for k, text in enumerate(texts) if text]
    return len(places) == 1 and places[0] <= next((k for k, text in enumerate(below) if text), 0)


def _titles(rows: Sequence[tuple[int, list[str]]], spans: Mapping[tuple[int, int], int]) -> tuple[tuple[str, ...], ...]:
    """Return the titles of each column, those of a group for each of its columns."""
    width = max([len(rows[-1][1]), *(k + 1 for _, texts in rows for k, text in enumerate(texts) if text)])
    table = [(texts + [""] * (width - len(texts)))[:width] for _, texts in rows]
    spread = [_spread(table, k, line, spans) for k, (line, _) in enumerate(rows)]
    return tuple(levels_of([row[place] for row in spread]) for place in range(width))


def _ordered(titles: tuple[tuple[str, ...], ...], below: Sequence[Sequence[Cell]]) -> tuple[tuple[str, ...], ...]:
    """Return titles with one of an order, such as ``Maße (B x T x H)``, above each of as many columns of numbers."""
    found = list(titles)
    for first, levels in enumerate(titles):
        places = range(first + 1, first + max(1, max((len(order_of(each)) for each in levels), default=0)))
        if places and places.stop <= len(titles) and not any(titles[k] for k in places):
            rows = [[text_of(cells[k]) for k in places] for cells in below if len(cells) >= places.stop]
            if any(all(text[:1].isdigit() for text in row) for row in rows):
                found[places.start : places.stop] = [levels] * len(places)
    return tuple(found)


def _spread(table: list[list[str]], k: int, line: int, spans: Mapping[tuple[int, int], int]) -> list[str]:
    """Return a row of a header with each title over all of its columns: those merged, or as far as no other stands."""
    row = list(table[k])
    merged = {place: spans[line, place] for place in range(len(row)) if (line, place) in spans and row[place]}
    for place, many in merged.items():
        row[place : place + many] = [row[place]] * min(many, len(row) - place)
    if merged or (k == len(table) - 1 and not _is_of_units(row)):
        return row
    for place in range(1, len(row)):
        above = any(table[j][place] for j in range(k))
        below = any(each[place] and not _is_of_units(each) for each in table[k + 1 :])
        if not row[place] and (above if _is_of_units(table[k]) else below and not above):
            row[place] = row[place - 1]
    return row


def _is_of_units(row: Sequence[str]) -> bool:
    return all(not text or plain(text) in UNITS for text in row)


def _count_measures(header: Header, sheet: Sheet, end: int) -> int:
    """Return how many sizes the rows below a header give, none of them by two columns."""
    columns = [
        (k, each) for k, each in enumerate(header.columns) if each and each.stem in {*SIZES, "size", "body_file"}
    ]
    fields = [field for _, each in columns if each.stem in SIZES for field in each.fields]
    if len(set(fields)) < len(fields):
        return 0
    rows = (cells for _, cells in sheet.rows[end : end + _SAMPLE])
    return sum(min(3, sum(_count_sizes(each, cells[k]) for k, each in columns if k < len(cells))) for cells in rows)


def _count_sizes(column: InventoryColumn, cell: Cell) -> int:
    """Return how many sizes a cell may give."""
    if column.stem == "body_file":
        return 3 if text_of(cell) else 0
    numbers = len(re.findall(r"\d+(?:[.,]\d+)?", text_of(cell)))
    return 3 * (numbers > 1) if column.stem == "size" else min(numbers, 1)


def text_of(cell: Cell) -> str:
    """Return what a cell shows.

    >>> text_of(12.0), text_of(" a ")
    ('12', 'a')
    """
    if isinstance(cell, str):
        return cell.strip()
    return str(int(cell)) if cell == int(cell) else repr(cell)
