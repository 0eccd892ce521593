"""Columns as text: separator, line of names, and quantities of the columns from their names and units."""

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rocking.conventions import ACCELERATION_UNITS, FloatArray
from rocking.messages import Message
from rocking.motions.formats.directions import orientation
from rocking.motions.formats.headers import acceleration_unit, unit_to_state
from rocking.motions.formats.numbers import plain_table, read_rows
from rocking.motions.formats.record import Source, readable

MOST_NAMED = 20  # largest number of named columns
_FIRST_ROWS = 50
MARK = "\xef\xbb\xbf"  # byte order mark of UTF-8
_MOST_WORDS = 60  # largest number of text lines above the numbers
_WORD = re.compile(r"[^\W\d_]{2,}")
_PROPERTY = re.compile(r"[^\W\d_]{2,20}\s*(?:[=:;]|[\[(]\s*[^\W\d]+\s*[\])]|(?<=dt)\s)", re.IGNORECASE)
_BLANKS = " \t\x1a"
_MIXED = re.compile(r"\s*,\s*|\s+")
_QUOTED = re.compile(r'"[^"]*"')
_UNIT_BEHIND = re.compile(r"[^\s\[(]+(?:\s*\[[^\]]*\]|\s*\([^)]*\))?")
_DECIMAL_COMMAS = re.compile(r"(?:[^\s,]+|[^\s,]*\d,\d[^\s,]*)(?:\s+(?:[^\s,]+|[^\s,]*\d,\d[^\s,]*))+")
# a name begins with a letter, or is an azimuth followed by a unit; it contains no equals sign
_NAME = re.compile(r"(?:[^\W\d_]|\d+\s*[\[(])[^=\x00-\x1f]{0,79}")
_NO_NAME = re.compile(r"nan|inf(inity)?|null|none|n/?a|true|false", re.IGNORECASE)
_DAMAGED_NUMBER = re.compile(r"[^\W\d_][+-]?[\d.,]+([eEdD][+-]?\d*)?")
# lines with sampling data belong to a damaged header of another format; they are neither comments nor names
_OTHER_FORMAT = re.compile(r"sample\s*rate|sampling|record\s*length|npts|ndata", re.IGNORECASE)
SAMPLING_LINE = re.compile(r"NPTS\s*=\s*\d+\s*,?\s*DT\s*=\s*[\d.eE+-]+\s*(?:s|sec\w*)?\.?", re.IGNORECASE)
"""Last header line of a PEER file, for files without the other header lines."""

_BRACKETS = re.compile(r"(.*?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\))")
_TAIL = re.compile(
    r"(.*[^\W_])_((?:mm|cm|m)_s2?)"
    r"|(.*[^\W_]{2})[_ ]((?:mm|cm|m)_?s_?2|(?:mm|cm|m)_s_s|(?:mm|cm|m)/s(?:/s|\^?2)|g|gal|mg|ms|us|min)"
)
_PLAIN_WORD = re.compile(r"[^\W\d_]{4,}(?:[ -][^\W\d_]+)*")
_SECONDS = {"s", "sec", "secs", "second", "seconds", "sek"}
_TIMES = {
    "zaman",
    "czas",
    "vrijeme",
    "cas",
    "\u010das",
    "id\u0151",
    "\u0432\u0440\u0435\u043c\u044f",
    "time",
    "times",
    "timestamp",
    "elapsed",
    "zeit",
    "temps",
    "tiempo",
    "tempo",
    "tid",
    "tijd",
}
_OTHER_WORDS = ("vel", "disp", "geschw", "verschieb", "rotation", "period", "freq")
_COUNTS = {"count", "counts", "cnt"}
_VELOCITIES, _LENGTHS = {"m/s", "cm/s", "mm/s", "in/s", "ft/s"}, {"m", "cm", "mm", "in", "ft"}
_OTHER_UNITS = {
    *(*_VELOCITIES, *_LENGTHS, "in/s2", "ft/s2"),
    *("rad", "deg", "rad/s", "deg/s", "rad/s2", "deg/s2", "s", "ms", "us", "min", "h", "hz", "khz"),
    *("v", "mv", "n", "kn", "pa", "kpa", "mpa", *_COUNTS, "%", "%g", "-", "1"),
}
_OF_ANY_CASE = {unit for unit in ACCELERATION_UNITS if unit not in {"g", "mg", "g/10"}}
_SPELT = {
    **{f"{length}{second}": f"{length}/s2" for length in ("m", "cm", "mm") for second in ("/s/s", "s2", "s-2", ".s-2")},
    "gals": "gal",
}
_UNITS = ", ".join(ACCELERATION_UNITS)


_TAKEN_FOR = {"velocity", "displacement", "count of a recorder"}  # not accelerations, but similar columns


@dataclass(frozen=True)
class ColumnText:
    """Cells of a file of columns, as text."""

    source: Source
    names: tuple[str, ...] | None  # names of the columns with units; None if the file begins with numbers
    heading: str  # the line of the names; empty if there is none
    preamble: tuple[tuple[int, str], ...]  # line index and text of header lines, except names and comments
    separator: str  # ``;``, tab, ``,``, a blank for white space, or empty for blanks and commas
    first: list[tuple[int, list[str]]]  # line index and cells of the first lines of numbers

    @classmethod
    def of(cls, source: Source, most: int = _FIRST_ROWS) -> "ColumnText":
        """Return the cells of the first lines of a file."""
        lines = _lines(source, max(most, _FIRST_ROWS) + _MOST_WORDS + 1)
        top = next((k for k, (_, text) in enumerate(lines[: _MOST_WORDS + 1]) if not is_words(text)), 0)
        above, body, names, heading = lines[:top], lines[top:], None, ""
        if above and not body:
            return cls(source, None, "", (), "", [])
        if above and (names := _names_above(above, body)) is not None:
            heading = above.pop()[1]
        elif not above and body and (names := _names(body[0][1], _separator(body[0][1]))) is not None:
            heading = body.pop(0)[1]
        separator = _separator(heading) if names else ""
        if names is None or separator == " ":
            separator = " " if names and len(names) == 1 else _separator_of_numbers([text for _, text in body])
        first = [(line, _cells(text, separator, names)) for line, text in body[:most]]
        return cls(source, names, readable(heading), tuple(above), separator, first)

    @property
    def is_empty(self) -> bool:
        """True if the file has no lines of numbers."""
        return not self.first or self.first[0][0] >= self.source.end

    @cached_property
    def rows(self) -> list[tuple[int, list[str]]]:
        """Line index and cells of every line of numbers."""
        top = self.first[0][0] if self.first else len(self.source.lines)
        end = self.source.end
        lines = [(line, text) for line, text in _lines(self.source, None) if top <= line < end]
        return [(line, _cells(text, self.separator, self.names)) for line, text in lines]

    @cached_property
    def _columns(self) -> int:
        return len(self.first[0][1] if self.names is None else self.names)

    @cached_property
    def _plain(self) -> tuple[list[str], str | None]:
        """Lines from the first line with numbers to the end, and the separator of columns (None for blanks)."""
        lines = self.source.lines[self.first[0][0] : self.source.end]
        if self.separator == "":
            return lines, "," if "," in lines[0] and "." in lines[0] else None
        return lines, None if self.separator == " " else self.separator

    @cached_property
    def at_once(self) -> FloatArray | None:
        """All numbers if all cells are plain decimal numbers, otherwise None."""
        numbers = plain_table(*self._plain)
        return numbers if numbers is not None and numbers.shape[1] == self._columns else None

    def column(self, index: int) -> list[str]:
        """Return the cells of one column, with decimal points."""
        if self.at_once is None:
            return [cells[index].replace(",", ".") for _, cells in self.rows]
        lines, separator = self._plain
        return "\n".join(lines).replace(separator or " ", " ").split()[index :: self._columns]

    def numbers(self, *, last_short: bool = False) -> FloatArray:
        """Return all numbers, shape (rows, columns). Missing cells of an allowed short last row are NaN."""
        values = self.at_once
        if values is None:
            self._check_commas()
            short = len(self.rows[-1][1])
            missing = self._columns - short if last_short and 0 < short < self._columns else 0
            values = np.append(read_rows(self.source, self._checked_rows(missing)), np.full(missing, np.nan))
        if values.size < 2 * self._columns and not last_short:
            raise self.source.error(None, "at least 2 samples required, found 1")
        return values.reshape(-1, self._columns)

    def _check_commas(self) -> None:
        commas = [line for line, _ in self.rows if "," in self.source.lines[line]]
        points = [line for line, cells in self.rows if any("." in cell for cell in cells)] if commas else []
        if commas and self.separator == "" and not points:
            raise self.source.error(commas[0], "commas without decimal points; replace decimal commas by points")
        if commas and points and self.separator not in {"", ","}:
            raise self.source.error(
                commas[0], "decimal commas here and decimal points on line {other}; use one kind", other=points[0] + 1
            )

    def _checked_rows(self, missing: int) -> Iterator[tuple[int, list[str]]]:
        """Yield rows with one cell per column. The last row may be shorter."""
        reason = " as on the first line" if self.names is None else ", one per name"
        hint = "; with commas as separators, use decimal points" if self.separator == "," else ""
        for row, (line, cells) in enumerate(self.rows, 1):
            if len(cells) + missing * (row == len(self.rows)) != self._columns:
                cause = f"{self._columns} numbers expected{reason}, found {len(cells)}{hint}"
                raise self.source.error(line, cause)
            yield line, [cell.replace(",", ".") for cell in cells]


def is_words(text: str) -> bool:
    """Return True if a line contains words and is not a line of numbers with one damaged number.

    >>> [is_words(text) for text in ("Station A", "1940 El Centro NS", "0.01 nan", "0.5 x3 1.0", "acc [g]")]
    [True, True, False, False, True]
    """
    tokens = [word for word in _WORD.findall(text[:400]) if not _NO_NAME.fullmatch(word)]
    begins_with_number = re.match(r"[-+.,\d]", text.strip()) is not None
    are_words = len(tokens) > begins_with_number and max(map(len, tokens)) > 2
    states_property = _PROPERTY.match(text.strip()) is not None
    return (are_words or states_property) and len(text) <= 100 * MOST_NAMED


def _names_above(above: list[tuple[int, str]], body: list[tuple[int, str]]) -> tuple[str, ...] | None:
    """Return the names in the last line of words, if the line has one name per column or alone has separators."""
    text = above[-1][1]
    separator = _separator(text)
    names = _names(text, separator)
    if names is None:
        return None
    first = _cells(body[0][1], _separator_of_numbers([row for _, row in body]), None)
    fits = len(names) == len(first)
    if len(above) == 1 and (fits or separator in {";", "\t", ","} or len(names) == 1):
        return names
    columns = [ColumnName.of(index, name) for index, name in enumerate(names)]
    are_names = any(column.is_time for column in columns) or all(column.unit for column in columns) or separator != " "
    return names if fits and (are_names or all(orientation(column.name) is not None for column in columns)) else None


def states_sampling(text: str) -> bool:
    """Return True if a line contains information on the sampling, as in headers of other formats."""
    return _OTHER_FORMAT.search(text[:200]) is not None


def names_on(text: str) -> tuple[str, ...] | None:
    """Return the column names in a line; None if the line contains anything else."""
    return _names(text, _separator(text)) if text and not states_sampling(text) else None


def kind_of(unit: str) -> tuple[str | None, str]:
    """Return the unit of acceleration (or None) and the quantity of a unit. An unknown unit has an empty quantity.

    >>> kind_of("cm/s/s"), kind_of("cm/sec"), kind_of("furlong")
    (('cm/s2', 'acceleration'), (None, 'velocity'), (None, ''))
    """
    plain = _plain(unit if unit in ACCELERATION_UNITS else unit.replace("SEC", "sec"))
    small = _SPELT.get(plain.lower(), plain.lower())
    if plain in ACCELERATION_UNITS or small in _OF_ANY_CASE:
        return (plain if plain in ACCELERATION_UNITS else small), "acceleration"
    kinds = {"velocity": _VELOCITIES, "displacement": _LENGTHS, "count of a recorder": _COUNTS, "other": _OTHER_UNITS}
    return None, next((kind for kind, units in kinds.items() if small in units), "other" if small in _SECONDS else "")


def unit_named(source: Source, line: int | None, word: str) -> str | None:
    """Return the unit of acceleration of a word, or None.

    Raise an error for units of velocity, displacement or counts.
    """
    unit, kind = kind_of(word)
    if kind in _TAKEN_FOR:
        raise source.error(
            line,
            "accelerations required, but the file states {unit}, a {quantity}",
            unit=word[:20],
            quantity=kind,
        )
    return unit


def looks_like_unit(text: str, *, square: bool = True) -> bool:
    """Return True if a text in brackets may be a unit, that is neither a direction nor a remark.

    >>> [looks_like_unit(text) for text in ("furlong/s2", "Mg", "NS", "x", "corrected")]
    [True, True, False, False, False]
    """
    if len(text) < 2 or orientation(text) is not None or text.isdigit():
        return False
    if re.search(r"[/^*\xb2]|\d", text):
        return True
    return len(text) <= 3 if not square else _PLAIN_WORD.fullmatch(text) is None


@dataclass(frozen=True, slots=True)
class ColumnName:
    """A column, described by its heading."""

    index: int  # index of the column, from 0
    text: str  # heading
    name: str  # heading without the unit
    unit: str | None = None  # unit in brackets, a key of `rocking.conventions.ACCELERATION_UNITS`
    suffix: str = ""  # other text in the brackets, in lower case and without exponent signs
    unknown_unit: str = ""  # unknown unit in brackets

    @classmethod
    def of(cls, index: int, text: str) -> "ColumnName":
        """Return the column of a heading."""
        # names with units as written by this package, such as acceleration_m_s2
        bracketed = text
        if tail := _TAIL.fullmatch(text):
            stem, unit_behind = filter(None, tail.groups())
            bracketed = f"{stem} [{unit_behind.replace('_', '/')}]"
        match = _BRACKETS.fullmatch(bracketed)
        if match is None:
            return cls(index, text, text)
        inside = (match[2] if match[2] is not None else match[3]).strip()
        plain = _plain(inside)
        small = _SPELT.get(plain.lower(), plain.lower())
        unit, kind = kind_of(plain)
        name = (match[1].strip() if kind else "") or text
        if not kind:  # a unit followed by a remark, or a capital G
            first = re.split(r"[\s,;]", inside)[0]
            unit, kind = ("g", "acceleration") if first in {"G", "g's", "gn"} else kind_of(first)
        unknown = inside if not kind and looks_like_unit(inside, square=match[2] is not None) else ""
        return cls(index, text, name, unit, small, unknown)

    @property
    def is_time(self) -> bool:
        """True if the name means time. The name T alone may also mean period or transversal."""
        tokens = set(re.split(r"[\W\d_]+", self.name.casefold()))
        is_named_time = bool(tokens & _TIMES) or (self.name == "t" and (self.index == 0 or self.suffix in _SECONDS))
        return is_named_time and self.unit is None

    @property
    def is_period(self) -> bool:
        """True if the column may be the period or frequency of a spectrum."""
        return self.suffix in {*_SECONDS, "hz"} or self.name.casefold().startswith(("period", "freq"))

    @property
    def is_acceleration(self) -> bool:
        """True if the column is an acceleration, or no unit or name contradicts it."""
        if self.unit is not None:
            return True
        other = self.suffix in _OTHER_UNITS | _SECONDS or self.name.casefold().startswith(_OTHER_WORDS)
        return not self.is_time and not other


@dataclass(frozen=True, slots=True)
class NamedColumns:
    """Named columns, sorted by quantity."""

    time: ColumnName | None
    accelerations: tuple[ColumnName, ...]
    left_out: tuple[str, ...]  # names of other columns
    more_times: tuple[ColumnName, ...] = ()  # additional columns with times

    @classmethod
    def of(cls, source: Source, texts: tuple[str, ...]) -> "NamedColumns":
        """Return columns by their names."""
        named = tuple(ColumnName.of(index, text) for index, text in enumerate(texts))
        for column in named:
            if not column.text:
                raise source.error(
                    None, "column {number} has no name; add a name, or remove the column", number=column.index + 1
                )
            if not column.is_time and column.name.casefold() in {
                other.name.casefold() for other in named[: column.index]
            }:
                raise source.error(
                    None, "column {column!r:.60} appears twice; rename or remove one", column=column.name
                )
        times = [column for column in named if column.is_time]
        accelerations = tuple(column for column in named if column.is_acceleration)
        if not accelerations:
            kinds = {kind_of(column.suffix)[1] for column in named} & _TAKEN_FOR
            quantities = f", but {' and '.join(sorted(kinds))}" if kinds else ""
            raise source.error(
                None, "none of the columns {columns} is an acceleration in {units}{quantities}; use a name such as acc "
                "[g]", columns=_listed(named), units=_UNITS, quantities=quantities,
            )  # fmt: skip
        spectral = [column for column in named if column not in accelerations and column.is_period]
        if not times and spectral:
            raise source.error(
                None,
                "{columns} may be periods of a spectrum; use the name time [s] for times",
                columns=_listed(spectral),
            )
        if not times and len(accelerations) > 1 and any(column.unit is None for column in accelerations):
            raise source.error(
                None, "no time among {columns}; use the name time [s], or add the unit of every acceleration, or "
                "keep only one acceleration", columns=_listed(accelerations),
            )  # fmt: skip
        times.sort(key=lambda column: column.suffix not in {"", *_SECONDS})
        if times and times[0].suffix not in {"", *_SECONDS}:
            raise source.error(
                None,
                Message(
                    "{columns}: the times must be in seconds; convert or remove the column", {"columns": _listed(times)}
                ),
            )
        left_out = tuple(column.text for column in named if column not in accelerations and column not in times)
        return cls(times[0] if times else None, accelerations, left_out, tuple(times[1:]))

    def with_one_time(self, source: Source, values: FloatArray) -> "NamedColumns":
        """Return these columns with a single time column, if all time columns agree within half a step."""
        if not self.more_times or self.time is None:
            return self
        times = values[:, self.time.index] - values[0, self.time.index]
        for column in self.more_times:
            others = values[:, column.index] - values[0, column.index]
            if not (np.abs(others - times) <= 0.5 * times[-1] / max(1, times.size - 1)).all():
                raise source.error(
                    None, "{columns} are times with different steps; keep only one, or use one file per time",
                    columns=_listed([self.time, *self.more_times]),
                )  # fmt: skip
        return replace(self, more_times=(), left_out=(*self.left_out, *(column.text for column in self.more_times)))

    def with_stated_unit(self, source: Source, unit: str | None, unknown: str, requested: str | None) -> "NamedColumns":
        """Return these columns with the common unit of the header.

        An unknown unit and a requested unit raise an error.
        """
        unknown_units = (
            column.unknown_unit for column in self.accelerations if column.unknown_unit and column.unit is None
        )
        unknown = next(unknown_units, unknown if unit is None else "")
        if unknown and requested is not None and all(column.unit is None for column in self.accelerations):
            raise source.error(
                None, "the unit of the file is {unit!r}, not {requested}; allowed are {units}", unit=unknown[:20],
                requested=requested, units=_UNITS,
            )  # fmt: skip
        if unit is None or any(column.unit is not None for column in self.accelerations):
            return self
        return replace(self, accelerations=tuple(replace(column, unit=unit) for column in self.accelerations))

    def with_unit(self, source: Source, requested: str | None) -> "NamedColumns":
        """Return these columns with a unit for every acceleration."""
        silent = [column for column in self.accelerations if column.unit is None]
        if silent and requested is None and len(silent) < len(self.accelerations):
            raise source.error(
                None,
                "{columns} has no unit; add the unit to the name, or remove the column" if len(silent) == 1
                else "{columns} have no unit; add the unit to each name, or remove the columns",
                columns=_listed(silent), hint=unit_to_state(),
            )  # fmt: skip
        accelerations = (
            replace(column, unit=acceleration_unit(source, column.unit, requested)) for column in self.accelerations
        )
        return replace(self, accelerations=tuple(accelerations))


def _lines(source: Source, most: int | None) -> list[tuple[int, str]]:
    lines: list[tuple[int, str]] = []
    for line, text in enumerate(source.lines):
        bare = (text if line else text.removeprefix(MARK)).strip(_BLANKS)
        if bare and bare[0] not in "#%" and (lines or not SAMPLING_LINE.fullmatch(bare)):
            lines.append((line, bare))
            if len(lines) == most:
                break
    while lines and not lines[-1][1].strip(",; \t"):  # lines of separators only are empty rows of a spreadsheet
        lines.pop()
    return lines


def _separator(text: str) -> str:
    bare = _QUOTED.sub("", text)
    return next((mark for mark in (";", "\t", ",") if mark in bare), " ")


def _names(text: str, separator: str) -> tuple[str, ...] | None:
    """Return the names in a line; None if the line contains anything else, such as numbers."""
    if "=" in text or states_sampling(text) or len(text) > 100 * MOST_NAMED:
        return None
    text = readable(text)
    if separator == " " and '"' not in text:
        cells = _UNIT_BEHIND.findall(text)
    else:
        cells = next(csv.reader([text], delimiter=separator, skipinitialspace=True), [])
    names = tuple(" ".join(cell.split()) for cell in cells)
    while names and not names[-1]:
        names = names[:-1]
    listed = [name for name in names if name]
    good = all(_NAME.fullmatch(name) and not _NO_NAME.fullmatch(name) for name in listed)
    # a single letter followed by a number is a damaged number, not a name
    damaged = len(listed) == 1 and _DAMAGED_NUMBER.fullmatch(listed[0])
    return names if listed and good and not damaged else None


def _separator_of_numbers(rows: list[str]) -> str:
    """Return the separator of rows of numbers; empty if blanks and commas separate numbers."""
    first = rows[:_FIRST_ROWS]
    if first and ";" in first[0]:
        return ";"
    commas, points = ("".join(first).count(mark) for mark in ",.")
    if commas and not points and all(map(_DECIMAL_COMMAS.fullmatch, first)):
        return "\t" if "\t" in first[0] else " "
    return ""


def _cells(text: str, separator: str, names: tuple[str, ...] | None) -> list[str]:
    if separator == " " or (separator == "" and "," not in text):
        return text.split()
    if separator == "":
        return _MIXED.split(text.rstrip(",").rstrip())
    cells = [cell.strip() for cell in text.split(separator)]
    while cells and not cells[-1] and (names is None or len(cells) > len(names)):
        cells.pop()
    return cells


def _plain(unit: str) -> str:
    bare = re.sub(r"[\s^]|\*\*", "", unit.replace("\xb2", "2").replace("\xb7", "."))
    return re.sub(r"sec(?=\d|$|/)", "s", bare)


def _listed(columns: "list[ColumnName] | tuple[ColumnName, ...]") -> str:
    return ", ".join(repr(column.text[:40]) for column in columns)
