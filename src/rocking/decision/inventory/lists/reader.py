"""Read inventories from files: columns from the header, with a separate check of each row."""

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rocking import language as languages
from rocking.conventions import LENGTH_UNITS
from rocking.decision.inventory.lists.cells import DecimalMark, count_of, is_missing, measure, parts
from rocking.decision.inventory.lists.columns import (
    FACTORS,
    LENGTHS,
    SIZES,
    TEXTS,
    UNITS,
    WEIGHTS,
    WORDS,
    InventoryColumn,
    check_header,
    mapping_of,
    names_of,
    order_of,
    plain,
    stem_of,
    words_of,
)  # fmt: skip
from rocking.decision.inventory.lists.header import LocatedHeader, find_header
from rocking.decision.inventory.lists.rows import FIELD_NAMES, RowKinds, RowValues, body_of, ignored_remark
from rocking.decision.inventory.lists.sheets import (
    ENCODINGS,
    MOST_BYTES,
    Cell,
    Row,
    Sheet,
    Shown,
    rows_of,
    sheets_in,
    tables_of,
    text_of,
    text_of_row,
    texts_in,
)  # fmt: skip
from rocking.decision.inventory.objects import SIZES as SIDES
from rocking.decision.inventory.objects import InventoryObject, NotAssessed
from rocking.errors import InvalidValueError, RockingError
from rocking.messages import Message, Option

_STATING = words_of(WORDS["stating"])


@dataclass(frozen=True)
class Inventory:
    """Content of an inventory file.

    Parameters
    ----------
    objects : tuple of InventoryObject
        Rows without an error.
    not_assessed : tuple of NotAssessed
        Rows with an error, with reasons.
    ignored : tuple of str
        Columns that were not read.
    source : str
        Name of the file, with the name of the table if there are several, or with an assumed encoding.
    language : str
        Language of its report: ``en``, ``de``, ``it`` and more.
    not_objects : tuple of NotAssessed
        Rows that are not objects: titles, headings, sums, remarks, repeated headers.
    stated : tuple of str or Message
        Used statements of the list outside its table: a unit, or the order of the sizes.
    header_lines : tuple of int
        Lines of its header [-].
    """

    objects: tuple[InventoryObject, ...]
    not_assessed: tuple[NotAssessed, ...] = ()
    ignored: tuple[str, ...] = ()
    source: str = "objects"
    language: str = "en"
    not_objects: tuple[NotAssessed, ...] = ()
    stated: tuple[str | Message, ...] = ()
    header_lines: tuple[int, ...] = ()


def read_inventory(
    path: str | Path,
    encoding: str | None = None,
    find: Callable[[str], Path] | None = None,
    map_columns: str | Mapping[str, str] | None = None,
    language: str | None = None,
) -> Inventory:
    """Return the inventory in a workbook or a CSV file.

    Parameters
    ----------
    path : str or Path
        The file: .xlsx, .ods, or text with commas, semicolons or tabs.
    encoding : str, optional
        Encoding of a text, such as ``cp1252``; default: detected. `Inventory.source` contains an encoding other than
        Unicode.
    find : callable, optional
        Function from the name of a body file or photo to its path; default: the folder of the list.
    map_columns : str or mapping of str to str, optional
        Meaning of columns with unknown titles: ``"Objekt=name, Maß B=width_cm, Rahmenbreite="``. A column without a
        meaning is ignored.
    language : str, optional
        Language of the report (ISO 639-1); default: language of the header.

    Returns
    -------
    Inventory
        Objects, and other rows with reasons.

    Raises
    ------
    InvalidValueError
        If the file is unreadable.
    MissingExtraError
        If openpyxl is not installed, for .xlsx.
    """
    path = Path(path)
    if path.stat().st_size > MOST_BYTES:
        raise InvalidValueError(
            "an inventory must be below {limit} MiB", limit=MOST_BYTES >> 20, hint="Check the file."
        ).at(path.name)
    content, mapped = path.read_bytes(), mapping_of(map_columns)
    find = find or (lambda name: path.parent / name)
    sheets = sheets_in(content, path.name)
    if sheets is None:
        texts = [(text, name) for text, name in texts_in(content, path.name, encoding)]
        return _of_texts(texts, path.name, mapped, find, language)
    lists = [(find_header(sheet, mapped), sheet) for sheet in sheets]
    complete = [(located, sheet) for located, sheet in lists if located and not located.header.missing]
    if len(complete) > 1:
        names = ", ".join(sheet.source for _, sheet in complete)
        raise InvalidValueError(
            "the file contains several lists: {names}", names=names, hint="Keep one list, or use one file per list."
        ).at(path.name)
    if not complete:
        raise _no_header(path.name, [(located, sheet.rows) for located, sheet in lists])
    located, sheet = complete[0]
    return _Reader(sheet, located, mapped, find, language).inventory()


def parse_inventory(
    text: str,
    source: str = "objects",
    find: Callable[[str], Path] | None = None,
    map_columns: str | Mapping[str, str] | None = None,
    language: str | None = None,
) -> Inventory:
    r"""Return the inventory in a text.

    Parameters
    ----------
    text : str
        Lines of CSV with commas, semicolons or tabs between the fields, with a header in the first lines. Titles and
        the separator line of Excel, such as ``sep=;``, may precede the header.
    source : str
        Name of the inventory.
    find : callable, optional
        Function from the name of a body file or photo to its path. Without this function, such names are refused.
    map_columns : str or mapping of str to str, optional
        As for `read_inventory`.
    language : str, optional
        Language of the report (ISO 639-1); default: language of the header.

    Returns
    -------
    Inventory
        Objects, and other rows with reasons.

    Raises
    ------
    InvalidValueError
        If no header has the required columns, two columns contain one size, a size has no unit, or an unknown column
        resembles a size.

    Examples
    --------
    >>> items = parse_inventory("Objekt;Breite (cm);Tiefe (cm);Höhe\nVase;12,5;ca. 12;60 cm\nKiste;?;20;30 cm")
    >>> items.objects[0].width, items.objects[0].approximate, items.not_assessed[0].row, items.language
    (0.125, {'depth': 0.006}, 3, 'de')
    """
    return _of_texts([(text, "")], source, mapping_of(map_columns), find, language)


def _of_texts(
    texts: Sequence[tuple[str, str]], source: str, mapped: Mapping[str, str], find: Callable[[str], Path] | None,
    language: str | None,
) -> Inventory:  # fmt: skip
    """Return the inventory of a text, with the encoding and delimiter that give most known columns."""
    readings = []
    for text, name in texts:
        for delimiter, first, lines in tables_of(text):
            beginning = Sheet(source, [(k, list(row)) for k, row in enumerate(first) if any(map(str.strip, row))])
            label = f"{source} ({name})" if name in ENCODINGS else source
            readings.append((find_header(beginning, mapped), lines, delimiter, label))
    complete = [(reading[0], *reading[1:]) for reading in readings if reading[0] and not reading[0].header.missing]
    if not complete:
        raise _no_header(
            source, [(reading[0], [(1, list(row)) for row in reading[1].splitlines()[:1]]) for reading in readings]
        )
    _, lines, delimiter, label = max(complete, key=lambda reading: (len(reading[0].header.fields), reading[0].measures))
    rows: list[Row] = [(line, list(cells)) for line, cells in rows_of(lines, delimiter, source)]
    sheet = Sheet(label, [row for row in rows if any(map(text_of, row[1]))], delimiter)
    located = find_header(sheet, mapped)
    assert located is not None
    return _Reader(sheet, located, mapped, find, language).inventory()


def _no_header(source: str, candidates: Sequence[tuple[LocatedHeader | None, Sequence[Row]]]) -> InvalidValueError:
    best = max(
        (located.header for located, _ in candidates if located), key=lambda header: len(header.fields), default=None
    )
    if best and len(best.fields) > 1:
        titles = ", ".join(f"{column.title!r:.40} as {column.stem}" for column in best.columns if column)
        hint = Message(
            "add a column depth_cm, or map one with {mapping}; if the depth is unknown, copy the width (square base)"
            if best.missing == ["depth"]
            else "add the columns, or map columns with {mapping}",
            {"mapping": Option("inventory.map_columns")},
        )
        return InvalidValueError(
            "the header contains no {missing}, only {titles}", missing=" and no ".join(best.missing), titles=titles,
            hint=hint,
        ).at(source)  # fmt: skip
    first = next((text_of(cell) for _, rows in candidates for _, row in rows[:1] for cell in row), "")
    return InvalidValueError(
        "the first line must contain the columns name, width_cm, depth_cm, height_cm (or _mm, _m, _in, _ft; or their "
        "words in {languages}) with commas, semicolons or tabs between them, got {line!r}",
        languages=", ".join(WORDS["headers"]), line=first[:99],
    ).at(source)  # fmt: skip


@dataclass
class _Reader:
    """Reader of a table below its header."""

    sheet: Sheet
    location: LocatedHeader
    mapped: Mapping[str, str]
    find: Callable[[str], Path] | None
    language: str | None  # language of the report; None for the language of the header

    def inventory(self) -> Inventory:
        self.header, source, titles = self.location.header, self.sheet.source, self.location.header.titles
        names = {*itertools.chain.from_iterable(names_of(self.location.titles))}
        if odd := [own for own in self.mapped if plain(own) not in names]:
            raise InvalidValueError(
                "{parameter}: the list has no column {value}. Its columns are {titles}",
                parameter="map_columns", value=odd[0],
                titles=", ".join(filter(None, titles))[:300],
            ).at(source)  # fmt: skip
        below = self.sheet.rows[self.location.end :]
        kinds = RowKinds(self.sheet, self.location, below)
        reasons = [kinds.reason(*row) for row in below]
        self.rows = [row for row, reason in zip(below, reasons, strict=True) if not reason]
        above = [(*row, Message("above the header")) for row in self.sheet.rows[: self.location.first]]
        others = [(*row, reason) for row, reason in zip(below, reasons, strict=True) if reason]
        not_objects = tuple(
            NotAssessed(line, f"{text_of_row(cells, ' | '):.100}", reason) for line, cells, reason in [*above, *others]
        )
        stated = self._take_stated(not_objects)
        self._check_units()
        wordless = [title for k, title in enumerate(titles) if not any(map(str.isdigit, "".join(self._column(k))))]
        dismissed = [*wordless, *(own for own, ours in self.mapped.items() if not ours)]
        check_header(self.header, self.location.titles, source, dismissed)
        columns = self.header.columns
        texts = {
            column.title: [*self._column(k)]
            for k, column in enumerate(columns) if column and column.stem not in TEXTS
        }  # fmt: skip
        all_texts = (text for column_texts in texts.values() for text in column_texts)
        self.mark = DecimalMark(all_texts, comma_delimited=self.sheet.delimiter == ",", columns=texts)
        objects, refused = [], []
        for line, row in self.rows:
            try:
                objects.append(self._object(line, row))
            except RockingError as error:
                number, name, note = (self.header.text(row, stem) for stem in ("number", "name", "note"))
                refused.append(NotAssessed(line, name or number, error.sentence, number, note))
        if not objects and not refused:
            raise InvalidValueError("an inventory needs at least one row below its header").at(source)
        ignored = tuple(title for title, column in zip(titles, columns, strict=True) if column is None and title)
        lines = tuple(line for line, _ in self.sheet.rows[self.location.first : self.location.end])
        language = self.language or self.header.language
        return Inventory(tuple(objects), tuple(refused), ignored, source, language, not_objects, stated, lines)

    def _column(self, index: int) -> Iterator[str]:
        """Yield the texts of a column; numbers of spreadsheets are omitted, because they have no decimal mark."""
        cells = (cell for _, row in self.rows for cell in row[index : index + 1])
        return (
            cell if isinstance(cell, str) else cell.unity if isinstance(cell, Shown) else str(int(cell))
            for cell in cells
        )

    def _take_stated(self, lines: Sequence[NotAssessed]) -> tuple[Message, ...]:
        """Use units and an order from lines outside the table, such as ``Alle Maße in cm (H x B x T)``."""
        columns, messages = list(self.header.columns), []
        unit_of, order = _stated(lines, self.header.language)
        for kind, stems in ((LENGTH_UNITS, {*LENGTHS, "size"}), (WEIGHTS, {"weight"})):
            bare = [(k, c) for k, c in enumerate(columns) if c and c.stem in stems and c.factor is None]
            stated = {unit: line for unit, line in unit_of.items() if unit in kind}
            if len(stated) == 1 and bare and "units" not in self.header.fields:
                ((unit, line),) = stated.items()
                messages.append(Message("line {line} of the list states the unit {unit}", {"line": line, "unit": unit}))
                for k, unitless in bare:
                    columns[k] = replace(unitless, factor=FACTORS[unit])
        for k, column in enumerate(columns):
            if column and column.stem == "size" and not column.fields and len(order) == 1:
                ((sides, line),) = order.items()
                facts = {"line": line, "order": " x ".join(sides)}
                messages.append(Message("line {line} of the list states the order {order}", facts))
                columns[k] = replace(column, fields=sides)
        self.header = replace(self.header, columns=tuple(columns))
        return tuple(messages)

    def _check_units(self) -> None:
        """Raise an error for lengths without a unit; ignore weights and pedestals without a unit."""
        if "units" in self.header.fields:
            return
        columns = list(self.header.columns)
        for k, column in enumerate(columns):
            if column is None or column.factor or column.stem not in {*LENGTHS, "weight"}:
                continue
            cells = [cell.strip() for cell in self._column(k) if not is_missing(cell)]
            if cells and all(cell.replace(".", "").replace(",", "").isdigit() for cell in cells):
                if column.stem not in {"weight", "pedestal"}:
                    names = ", ".join(f"{column.stem}_{unit}" for unit in LENGTH_UNITS)
                    raise InvalidValueError(
                        "column {column!r} must state its unit: {units}", column=column.title, units=names
                    ).at(self.sheet.source)
                columns[k] = None
        self.header = replace(self.header, columns=tuple(columns))

    def _object(self, line: int, row: Sequence[Cell]) -> InventoryObject:
        columns = self.header.columns
        row = row[: len(columns)] if not any(map(text_of, row[len(columns) :])) else row
        if len(row) != len(columns):
            comma, separator = Message("Check for a decimal comma."), Message("Check the separator.")
            raise InvalidValueError(
                "the line has {fields} fields, but the header has {titles}",
                fields=len(row),
                titles=len(columns),
                hint=comma if len(row) > len(columns) else separator,
            )
        values = RowValues(row=line)
        unit = UNITS.get(plain(self.header.text(row, "units")), "")
        for column, cell in zip(columns, row, strict=True):
            if column and text_of(cell):
                self._read(values, column, cell, column.factor or LENGTH_UNITS.get(unit))
        self._settle(values)
        return InventoryObject(**values.fields, approximate=values.approximate, remarks=tuple(values.remarks))

    def _read(self, values: RowValues, column: InventoryColumn, cell: Cell, factor: float | None) -> None:
        stem, title, fields = column.stem, column.title, column.fields
        facts = {"title": title, "cell": f"{cell!r:.40}"}
        if stem in TEXTS:
            values.fields[stem] = text_of(cell)
        elif stem == "count":
            remark = Message("{title} {cell} is not a count; 1 is used", facts)
            values.optional("count", count_of(cell), remark)
        elif is_missing(cell):
            values.unknown |= dict.fromkeys(fields or SIZES, Message("{title} is {cell}", facts))
            if stem in {"base", "base_width", "base_depth", "base_diameter", "centre_of_mass_height"}:
                values.remarks.append(Message("{title} is {cell}: the default is used", facts))
        elif stem == "size":
            self._read_size(values, column, cell, factor)
        elif stem in LENGTHS and stem != "pedestal":
            self._read_length(values, column, cell, factor)
        else:
            try:
                if stem == "pedestal":
                    values.take(fields, measure(title, cell, factor, self.mark), title, cell)
                else:
                    scale, units = (1.0, {}) if stem == "friction" else (column.factor, WEIGHTS)
                    values.fields[fields[0]] = measure(title, cell, scale, self.mark, units).value
            except InvalidValueError as error:
                values.remarks.append(ignored_remark(FIELD_NAMES[stem,], error.sentence))

    def _read_length(self, values: RowValues, column: InventoryColumn, cell: Cell, factor: float | None) -> None:
        title, stem, length = column.title, column.stem, measure(column.title, cell, factor, self.mark)
        if isinstance(cell, str) and self.mark.is_settled_by_column(title, cell):
            facts = {"title": title, "cell": f"{cell!r:.40}"}
            remark = Message(
                "{title} {cell}: read with a thousands separator, as in the other cells of this column", facts
            )
            values.remarks.append(remark)
        is_diameter = length.across and stem in {"width", "depth"}
        values.take(("diameter",) if is_diameter else column.fields, length, title, cell)

    def _read_size(self, values: RowValues, column: InventoryColumn, cell: Cell, factor: float | None) -> None:
        try:
            sizes = parts(column.title, cell, column.fields, factor, self.mark, self.header.language)
        except InvalidValueError as error:  # the error is raised only if no other column contains the size
            values.unknown |= dict.fromkeys(SIZES, error.sentence)
            values.remarks.append(ignored_remark(column.title, error.sentence))
            return
        for side, size in sizes.items():
            values.take((side,), size, column.title, cell)

    def _settle(self, values: RowValues) -> None:
        """Convert the values of a row to fields of an object; unimportant invalid values are ignored with a remark."""
        fields, remarks = values.fields, values.remarks
        body_file, units = fields.pop("body_file", None), fields.pop("units", None)
        if body_file:
            if stated := [name for name in (*LENGTHS, "mass") if name in fields]:
                title = values.titles.get(stated[0], stated[0])
                raise InvalidValueError("the body file of the object defines the sizes. Clear {title}.", title=title)
            fields |= body_of(str(body_file), units, self.find)
        values.settle_shape()
        for side in SIDES:
            if side not in fields:
                names = [side, *(["diameter"] if side != "height" else [])]
                title = next((c.title for c in self.header.columns if c and side in c.fields), side)
                empty = Message("Enter {title}.", {"title": title})
                raise InvalidValueError("{reason}", reason=next(filter(None, map(values.unknown.get, names)), empty))
        line = languages.language(self.language or self.header.language)("line")
        if not fields.get("name"):
            fields["name"] = fields.get("number") or f"{line} {fields['row']}"
            remarks.append(Message("it has no name"))
        values.settle_words(self.find)
        size = {side: fields[side] for side in SIDES}
        for name in {"mass", "count", "friction"} & fields.keys():
            try:
                InventoryObject(name="thing", **size, **{name: fields[name]})
            except InvalidValueError as error:
                del fields[name]
                remarks.append(ignored_remark(FIELD_NAMES[name.replace("mass", "weight"),], error.sentence))


def _stated(lines: Sequence[NotAssessed], language: str) -> tuple[dict[str, int], dict[tuple[str, ...], int]]:
    """Return the units and the orders of sizes in lines, with their line numbers."""
    units: dict[str, int] = {}
    orders: dict[tuple[str, ...], int] = {}
    for line in lines:
        tokens = plain(line.name).split()
        if not any(word in _STATING or stem_of(word, language) in {*LENGTHS, "size", "weight"} for word in tokens):
            continue
        for previous, word in itertools.pairwise(["", *tokens]):
            if word in UNITS and not word.isdigit() and (len(word) > 1 or previous in {"in", "en"}) and word != "in":
                units.setdefault(UNITS[word], line.row)
        if len(order := order_of(line.name, language)) == 3:
            orders.setdefault(order, line.row)
    return units, orders
