"""Inventories from files: their columns by the words of the header, each row checked by itself."""

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rocking import language as languages
from rocking.conventions import LENGTH_UNITS
from rocking.errors import InvalidValueError, RockingError
from rocking.messages import Message
from rocking.studies.inventory.cells import DecimalMark, count_of, is_missing, measure, parts
from rocking.studies.inventory.columns import (
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
from rocking.studies.inventory.headers import FoundHeader, find_header, text_of
from rocking.studies.inventory.objects import InventoryObject, NotAssessed
from rocking.studies.inventory.rows import FIELD_NAMES, RowKinds, RowValues, body_of, left_aside
from rocking.studies.inventory.sheets import (
    ENCODINGS,
    MOST_BYTES,
    Cell,
    Row,
    Sheet,
    Shown,
    rows_of,
    sheets_in,
    tables_of,
    texts_in,
)  # fmt: skip

_STATING = words_of(WORDS["stating"])


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
        Name of the file, with its table if it has several, or its encoding if that was assumed.
    language : str
        Language of its report: ``en``, ``de``, ``it`` and more.
    not_objects : tuple of NotAssessed
        Rows that are no objects: titles, headings, sums, remarks, and the header again.
    stated : tuple of str or Message
        What the list states beside its table and was used: a unit, or the order of measures.
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
        Encoding of a text, such as ``cp1252``; told from the text if not given, and said in `Inventory.source` unless
        it is Unicode.
    find : callable, optional
        Where a body file or a photo is that the list names; beside the list if not given.
    map_columns : str or mapping of str to str, optional
        What columns are that are not understood, by their titles: ``"Objekt=name, Maß B=width_cm, Rahmenbreite="``; one
        that is nothing is not read.
    language : str, optional
        Language of the report, as of ISO 639-1; that of the header if not given.

    Returns
    -------
    Inventory
        Objects, and rows with the reason why they are none.

    Raises
    ------
    InvalidValueError
        If the file as a whole cannot be understood.
    MissingExtraError
        If openpyxl is not installed, of .xlsx.
    """
    path = Path(path)
    if path.stat().st_size > MOST_BYTES:
        raise InvalidValueError(
            "an inventory must be below {limit} MiB", limit=MOST_BYTES >> 20, hint="another kind of file?"
        ).at(path.name)
    content, mapped = path.read_bytes(), mapping_of(map_columns)
    find = find or (lambda name: path.parent / name)
    sheets = sheets_in(content, path.name)
    if sheets is None:
        texts = [(text, name) for text, name in texts_in(content, path.name, encoding)]
        return _of_texts(texts, path.name, mapped, find, language)
    lists = [(find_header(sheet, mapped), sheet) for sheet in sheets]
    whole = [(found, sheet) for found, sheet in lists if found and not found.header.missing]
    if len(whole) > 1:
        names = ", ".join(sheet.source for _, sheet in whole)
        raise InvalidValueError(
            "more than one table is a list: {names}", names=names, hint="keep one, or make a file of each"
        ).at(path.name)
    if not whole:
        raise _no_header(path.name, [(found, sheet.rows) for found, sheet in lists])
    found, sheet = whole[0]
    return _Reader(sheet, found, mapped, find, language).inventory()


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
        Lines of CSV with commas, semicolons or tabs between the fields; one of the first names the columns. Before it
        may stand titles, and Excel's own line, such as ``sep=;``.
    source : str
        What to call it.
    find : callable, optional
        Where a body file or a photo is that a row names; without it none may be named.
    map_columns : str or mapping of str to str, optional
        As for `read_inventory`.
    language : str, optional
        Language of the report, as of ISO 639-1; that of the header if not given.

    Returns
    -------
    Inventory
        Objects, and rows with the reason why they are none.

    Raises
    ------
    InvalidValueError
        If there is no header with the columns needed, or two columns give the same measure, or one names no unit or is
        unknown and looks like a measure.

    Examples
    --------
    >>> found = parse_inventory("Objekt;Breite (cm);Tiefe (cm);Höhe\nVase;12,5;ca. 12;60 cm\nKiste;?;20;30 cm")
    >>> found.objects[0].width, found.objects[0].approximate, found.not_assessed[0].row, found.language
    (0.125, {'depth': 0.006}, 3, 'de')
    """
    return _of_texts([(text, "")], source, mapping_of(map_columns), find, language)


def _of_texts(
    texts: Sequence[tuple[str, str]], source: str, mapped: Mapping[str, str], find: Callable[[str], Path] | None,
    language: str | None,
) -> Inventory:  # fmt: skip
    """Return the inventory of a text that may be read in several ways: that of which most columns are understood."""
    ways = []
    for text, name in texts:
        for delimiter, first, lines in tables_of(text):
            beginning = Sheet(source, [(k, list(row)) for k, row in enumerate(first) if any(map(str.strip, row))])
            called = f"{source} ({name})" if name in ENCODINGS else source
            ways.append((find_header(beginning, mapped), lines, delimiter, called))
    whole = [(way[0], *way[1:]) for way in ways if way[0] and not way[0].header.missing]
    if not whole:
        raise _no_header(source, [(way[0], [(1, list(row)) for row in way[1].splitlines()[:1]]) for way in ways])
    _, lines, delimiter, called = max(whole, key=lambda way: (len(way[0].header.known), way[0].measures))
    rows: list[Row] = [(line, list(cells)) for line, cells in rows_of(lines, delimiter, source)]
    sheet = Sheet(called, [row for row in rows if any(map(text_of, row[1]))], delimiter)
    found = find_header(sheet, mapped)
    assert found is not None
    return _Reader(sheet, found, mapped, find, language).inventory()


def _no_header(source: str, tried: Sequence[tuple[FoundHeader | None, Sequence[Row]]]) -> InvalidValueError:
    best = max((found.header for found, _ in tried if found), key=lambda header: len(header.known), default=None)
    if best and len(best.known) > 1:
        titles = ", ".join(f"{each.title!r:.40} as {each.stem}" for each in best.columns if each)
        return InvalidValueError(
            "no {missing} in the header, only {titles}", missing=" and no ".join(best.missing), titles=titles,
            hint='say what another column is, as in map_columns "Maß B=width_cm"',
        ).at(source)  # fmt: skip
    first = next((text_of(cell) for _, rows in tried for _, row in rows[:1] for cell in row), "")
    return InvalidValueError(
        "the first line must name the columns name, width_cm, depth_cm, height_cm (or _mm, _m, _in, _ft; or their "
        "words in {languages}) with commas, semicolons or tabs between, got {line!r}",
        languages=", ".join(WORDS["headers"]), line=first[:99],
    ).at(source)  # fmt: skip


@dataclass
class _Reader:
    """A table, its header, and what is known of its cells."""

    sheet: Sheet
    found: FoundHeader
    mapped: Mapping[str, str]
    find: Callable[[str], Path] | None
    language: str | None  # of the report; that of the header if None

    def inventory(self) -> Inventory:
        self.header, source, titles = self.found.header, self.sheet.source, self.found.header.titles
        names = {*itertools.chain.from_iterable(names_of(self.found.titles))}
        if odd := [own for own in self.mapped if plain(own) not in names]:
            raise InvalidValueError(
                "{parameter}: no {value} among {titles}", parameter="map_columns", value=odd[0],
                titles=", ".join(filter(None, titles))[:300],
            ).at(source)  # fmt: skip
        below = self.sheet.rows[self.found.end :]
        kinds = RowKinds(self.sheet, self.found, below)
        reasons = [kinds.reason(*row) for row in below]
        self.rows = [row for row, reason in zip(below, reasons, strict=True) if not reason]
        above = [(*row, Message("above the header")) for row in self.sheet.rows[: self.found.first]]
        others = [(*row, reason) for row, reason in zip(below, reasons, strict=True) if reason]
        passed = tuple(NotAssessed(line, _said(cells), reason) for line, cells, reason in [*above, *others])
        stated = self._take_stated(passed)
        self._check_units()
        wordless = [title for k, title in enumerate(titles) if not any(map(str.isdigit, "".join(self._column(k))))]
        dismissed = [*wordless, *(own for own, ours in self.mapped.items() if not ours)]
        check_header(self.header, self.found.titles, source, dismissed)
        columns = self.header.columns
        texts = {each.title: [*self._column(k)] for k, each in enumerate(columns) if each and each.stem not in TEXTS}
        every = (text for column in texts.values() for text in column)
        self.mark = DecimalMark(every, comma_delimited=self.sheet.delimiter == ",", columns=texts)
        objects, refused = [], []
        for line, row in self.rows:
            try:
                objects.append(self._object(line, row))
            except RockingError as error:
                number, name, note = (self._text(row, stem) for stem in ("number", "name", "note"))
                refused.append(NotAssessed(line, name or number, error.sentence, number, note))
        if not objects and not refused:
            raise InvalidValueError("an inventory needs at least one row below its header").at(source)
        ignored = tuple(title for title, column in zip(titles, columns, strict=True) if column is None and title)
        lines = tuple(line for line, _ in self.sheet.rows[self.found.first : self.found.end])
        language = self.language or self.header.language
        return Inventory(tuple(objects), tuple(refused), ignored, source, language, passed, stated, lines)

    def _column(self, place: int) -> Iterator[str]:
        """Yield the texts of a column; numbers of spreadsheets have no mark."""
        cells = (cell for _, row in self.rows for cell in row[place : place + 1])
        return (
            cell if isinstance(cell, str) else cell.one if isinstance(cell, Shown) else str(int(cell)) for cell in cells
        )

    def _text(self, row: Sequence[Cell], stem: str) -> str:
        pairs = zip(self.header.columns, row, strict=False)
        return next((text_of(cell) for column, cell in pairs if column and column.stem == stem), "")

    def _take_stated(self, lines: Sequence[NotAssessed]) -> tuple[Message, ...]:
        """Take units and an order that lines beside the table state, such as ``Alle Maße in cm (H x B x T)``."""
        columns, said = list(self.header.columns), []
        unit_of, order = _stated(lines, self.header.language)
        for kind, stems in ((LENGTH_UNITS, {*LENGTHS, "size"}), (WEIGHTS, {"weight"})):
            bare = [k for k, each in enumerate(columns) if each and each.stem in stems and each.factor is None]
            stated = {unit: line for unit, line in unit_of.items() if unit in kind}
            if len(stated) == 1 and bare and "units" not in self.header.known:
                ((unit, line),) = stated.items()
                said.append(Message("line {line} of the list states the unit {unit}", {"line": line, "unit": unit}))
                for k in bare:
                    columns[k] = replace(_known(columns[k]), factor=FACTORS[unit])
        for k, each in enumerate(columns):
            if each and each.stem == "size" and not each.fields and len(order) == 1:
                ((sides, line),) = order.items()
                facts = {"line": line, "order": " x ".join(sides)}
                said.append(Message("line {line} of the list states the order {order}", facts))
                columns[k] = replace(each, fields=sides)
        self.header = replace(self.header, columns=tuple(columns))
        return tuple(said)

    def _check_units(self) -> None:
        """Refuse lengths without a unit; weights without one decide nothing, and are not read, nor is a pedestal."""
        if "units" in self.header.known:
            return
        columns = list(self.header.columns)
        for k, column in enumerate(columns):
            if column is None or column.factor or column.stem not in {*LENGTHS, "weight"}:
                continue
            cells = [cell.strip() for cell in self._column(k) if not is_missing(cell)]
            if cells and all(cell.replace(".", "").replace(",", "").isdigit() for cell in cells):
                if column.stem not in {"weight", "pedestal"}:
                    known = ", ".join(f"{column.stem}_{each}" for each in LENGTH_UNITS)
                    raise InvalidValueError(
                        "column {column!r} must name its unit: {units}", column=column.title, units=known
                    ).at(self.sheet.source)
                columns[k] = None
        self.header = replace(self.header, columns=tuple(columns))

    def _object(self, line: int, row: Sequence[Cell]) -> InventoryObject:
        columns = self.header.columns
        row = row[: len(columns)] if not any(map(text_of, row[len(columns) :])) else row
        if len(row) != len(columns):
            comma, separator = Message("a decimal comma between commas?"), Message("a separator missing?")
            raise InvalidValueError(
                "it has {fields} fields, the header {titles}",
                fields=len(row),
                titles=len(columns),
                hint=comma if len(row) > len(columns) else separator,
            )
        found = RowValues(row=line)
        unit = UNITS.get(plain(self._text(row, "units")), "")
        for column, cell in zip(columns, row, strict=True):
            if column and text_of(cell):
                self._read(found, column, cell, column.factor or LENGTH_UNITS.get(unit))
        self._settle(found)
        return InventoryObject(**found.fields, approximate=found.approximate, remarks=tuple(found.remarks))

    def _read(self, found: RowValues, column: InventoryColumn, cell: Cell, factor: float | None) -> None:
        stem, title, fields = column.stem, column.title, column.fields
        facts = {"title": title, "cell": f"{cell!r:.40}"}
        if stem in TEXTS:
            found.fields[stem] = text_of(cell)
        elif stem == "count":
            remark = Message("{title} {cell} is no number of pieces: one is taken", facts)
            found.optional("count", count_of(cell), remark)
        elif is_missing(cell):
            found.unknown |= dict.fromkeys(fields or SIZES, Message("{title} is {cell}", facts))
            if stem in {"base", "base_width", "base_depth", "base_diameter", "centre_of_mass_height"}:
                found.remarks.append(Message("{title} is {cell}: as if none were given", facts))
        elif stem == "size":
            self._read_size(found, column, cell, factor)
        elif stem in LENGTHS and stem != "pedestal":
            self._read_length(found, column, cell, factor)
        else:
            try:
                if stem == "pedestal":
                    found.take(fields, measure(title, cell, factor, self.mark), title, cell)
                else:
                    scale, units = (1.0, {}) if stem == "friction" else (column.factor, WEIGHTS)
                    found.fields[fields[0]] = measure(title, cell, scale, self.mark, units).value
            except InvalidValueError as error:
                found.remarks.append(left_aside(FIELD_NAMES[stem,], error.sentence))

    def _read_length(self, found: RowValues, column: InventoryColumn, cell: Cell, factor: float | None) -> None:
        title, stem, one = column.title, column.stem, measure(column.title, cell, factor, self.mark)
        if isinstance(cell, str) and self.mark.is_settled_by_column(title, cell):
            facts = {"title": title, "cell": f"{cell!r:.40}"}
            remark = Message("{title} {cell}: the mark is read as one of thousands, as its column has it", facts)
            found.remarks.append(remark)
        is_diameter = one.across and stem in {"width", "depth"}
        found.take(("diameter",) if is_diameter else column.fields, one, title, cell)

    def _read_size(self, found: RowValues, column: InventoryColumn, cell: Cell, factor: float | None) -> None:
        try:
            sizes = parts(column.title, cell, column.fields, factor, self.mark, self.header.language)
        except InvalidValueError as error:  # it counts where no other column says it
            found.unknown |= dict.fromkeys(SIZES, error.sentence)
            found.remarks.append(left_aside(column.title, error.sentence))
            return
        for side, one in sizes.items():
            found.take((side,), one, column.title, cell)

    def _settle(self, found: RowValues) -> None:
        """Bring what a row says to the fields of an object; what decides nothing is left aside with a remark."""
        fields, remarks = found.fields, found.remarks
        name, units = fields.pop("body_file", None), fields.pop("units", None)
        if name:
            if stated := [each for each in (*LENGTHS, "mass") if each in fields]:
                title = found.titles.get(stated[0], stated[0])
                raise InvalidValueError("its body file says what it is: leave {title} empty", title=title)
            fields |= body_of(str(name), units, self.find)
        found.settle_shape()
        for each in ("width", "depth", "height"):
            if each not in fields:
                ways = [each, *(["diameter"] if each != "height" else [])]
                title = next((c.title for c in self.header.columns if c and each in c.fields), each)
                empty = Message("{title} is empty", {"title": title})
                raise InvalidValueError("{reason}", reason=next(filter(None, map(found.unknown.get, ways)), empty))
        line = languages.language(self.language or self.header.language)("line")
        if not fields.get("name"):
            fields["name"] = fields.get("number") or f"{line} {fields['row']}"
            remarks.append(Message("it has no name"))
        found.settle_words(self.find)
        size = {each: fields[each] for each in ("width", "depth", "height")}
        for each in {"mass", "count", "friction"} & fields.keys():
            try:
                InventoryObject(name="thing", **size, **{each: fields[each]})
            except InvalidValueError as error:
                del fields[each]
                remarks.append(left_aside(FIELD_NAMES[each.replace("mass", "weight"),], error.sentence))


def _said(cells: Sequence[Cell]) -> str:
    """Return what a row says, shortened."""
    return f"{' | '.join(filter(None, map(text_of, cells))):.100}"


def _known(column: InventoryColumn | None) -> InventoryColumn:
    assert column is not None
    return column


def _stated(lines: Sequence[NotAssessed], language: str) -> tuple[dict[str, int], dict[tuple[str, ...], int]]:
    """Return the units and the orders of measures that lines state, and which line does."""
    units: dict[str, int] = {}
    orders: dict[tuple[str, ...], int] = {}
    for each in lines:
        words = plain(each.name).split()
        if not any(word in _STATING or stem_of(word, language) in {*LENGTHS, "size", "weight"} for word in words):
            continue
        for before, word in itertools.pairwise(["", *words]):
            if word in UNITS and not word.isdigit() and (len(word) > 1 or before in {"in", "en"}) and word != "in":
                units.setdefault(UNITS[word], each.row)
        if len(order := order_of(each.name, language)) == 3:
            orders.setdefault(order, each.row)
    return units, orders
