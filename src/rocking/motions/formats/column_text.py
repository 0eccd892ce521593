"""Columns as text, none a number yet: what parts them, which line names them, and what each is by its name and unit."""

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

MOST_NAMED = 20  # columns of a file that names them
_FIRST_ROWS = 50
MARK = "\xef\xbb\xbf"  # the three bytes with which some programs begin a file in UTF-8
_MOST_WORDS = 60  # lines of words above the numbers
_WORD = re.compile(r"[^\W\d_]{2,}")
_PROPERTY = re.compile(r"[^\W\d_]{2,20}\s*(?:[=:;]|[\[(]\s*[^\W\d]+\s*[\])]|(?<=dt)\s)", re.IGNORECASE)
_BLANKS = " \t\x1a"
_MIXED = re.compile(r"\s*,\s*|\s+")
_QUOTED = re.compile(r'"[^"]*"')
_UNIT_BEHIND = re.compile(r"[^\s\[(]+(?:\s*\[[^\]]*\]|\s*\([^)]*\))?")
_DECIMAL_COMMAS = re.compile(r"(?:[^\s,]+|[^\s,]*\d,\d[^\s,]*)(?:\s+(?:[^\s,]+|[^\s,]*\d,\d[^\s,]*))+")
# a letter first, or the digits of an azimuth with a unit behind them; what has an equals sign states something else
_NAME = re.compile(r"(?:[^\W\d_]|\d+\s*[\[(])[^=\x00-\x1f]{0,79}")
_NO_NAME = re.compile(r"nan|inf(inity)?|null|none|n/?a|true|false", re.IGNORECASE)
_DAMAGED_NUMBER = re.compile(r"[^\W\d_][+-]?[\d.,]+([eEdD][+-]?\d*)?")
# what states its own sampling is a header of another format, damaged: not to be passed over as a comment or as names
_OTHER_FORMAT = re.compile(r"sample\s*rate|sampling|record\s*length|npts|ndata", re.IGNORECASE)
SAMPLING_LINE = re.compile(r"NPTS\s*=\s*\d+\s*,?\s*DT\s*=\s*[\d.eE+-]+\s*(?:s|sec\w*)?\.?", re.IGNORECASE)
"""The line above the samples of a PEER file, where the lines above it were taken away."""

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


_TAKEN_FOR = {"velocity", "displacement", "count of a recorder"}  # quantities that are taken for accelerations


@dataclass(frozen=True)
class ColumnText:
    """The cells of a file of columns, none of them read as a number yet."""

    source: Source
    names: tuple[str, ...] | None  # what the columns are called, with their units; None if the file begins with numbers
    heading: str  # the line of the names; empty if there is none
    words: tuple[tuple[int, str], ...]  # lines above that are neither names nor comments, with their places
    separator: str  # ``;``, a tab, ``,``, a blank for white space, or nothing if blanks and commas both part
    first: list[tuple[int, list[str]]]  # index of each of the first lines of numbers, and its cells

    @classmethod
    def of(cls, source: Source, most: int = _FIRST_ROWS) -> "ColumnText":
        """Part the first lines of a file into cells."""
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
        """Whether no line of numbers comes before the words that close the file."""
        return not self.first or self.first[0][0] >= self.source.end

    @cached_property
    def rows(self) -> list[tuple[int, list[str]]]:
        """Index of each line of numbers, and its cells."""
        top = self.first[0][0] if self.first else len(self.source.lines)
        end = self.source.end
        lines = [(line, text) for line, text in _lines(self.source, None) if top <= line < end]
        return [(line, _cells(text, self.separator, self.names)) for line, text in lines]

    @cached_property
    def _columns(self) -> int:
        return len(self.first[0][1] if self.names is None else self.names)

    @cached_property
    def _plain(self) -> tuple[list[str], str | None]:
        """The lines from the first with numbers to the end, and what separates the columns of all; None for blanks."""
        lines = self.source.lines[self.first[0][0] : self.source.end]
        if self.separator == "":
            return lines, "," if "," in lines[0] and "." in lines[0] else None
        return lines, None if self.separator == " " else self.separator

    @cached_property
    def at_once(self) -> FloatArray | None:
        """All numbers, where there is nothing but plain decimal numbers in all columns."""
        numbers = plain_table(*self._plain)
        return numbers if numbers is not None and numbers.shape[1] == self._columns else None

    def column(self, place: int) -> list[str]:
        """Return the cells of one column, with decimal points."""
        if self.at_once is None:
            return [cells[place].replace(",", ".") for _, cells in self.rows]
        lines, separator = self._plain
        return "\n".join(lines).replace(separator or " ", " ").split()[place :: self._columns]

    def numbers(self, *, last_short: bool = False) -> FloatArray:
        """Return all numbers, of shape (rows, columns); where the last row may be short, NaN for what it lacks."""
        values = self.at_once
        if values is None:
            self._check_commas()
            short = len(self.rows[-1][1])
            missing = self._columns - short if last_short and 0 < short < self._columns else 0
            values = np.append(read_rows(self.source, self._checked_rows(missing)), np.full(missing, np.nan))
        if values.size < 2 * self._columns and not last_short:
            raise self.source.error(None, "at least 2 samples are needed, found 1")
        return values.reshape(-1, self._columns)

    def _check_commas(self) -> None:
        commas = [line for line, _ in self.rows if "," in self.source.lines[line]]
        points = [line for line, cells in self.rows if any("." in cell for cell in cells)] if commas else []
        if commas and self.separator == "" and not points:
            raise self.source.error(commas[0], "commas but no decimal point: write decimal commas as points")
        if commas and points and self.separator not in {"", ","}:
            raise self.source.error(
                commas[0], "decimal commas here and decimal points on line {other}: write one kind", other=points[0] + 1
            )

    def _checked_rows(self, missing: int) -> Iterator[tuple[int, list[str]]]:
        """Yield rows of as many cells as there are columns; the last one may lack some."""
        why = " as on the first line" if self.names is None else ", as many as there are names"
        hint = "; where commas part the columns, decimals need a point" if self.separator == "," else ""
        for row, (line, cells) in enumerate(self.rows, 1):
            if len(cells) + missing * (row == len(self.rows)) != self._columns:
                cause = f"{self._columns} numbers expected{why}, found {len(cells)}{hint}"
                raise self.source.error(line, cause)
            yield line, [cell.replace(",", ".") for cell in cells]


def is_words(text: str) -> bool:
    """Return whether a line is of words, and none of numbers of which one is damaged.

    >>> [is_words(text) for text in ("Station A", "1940 El Centro NS", "0.01 nan", "0.5 x3 1.0", "acc [g]")]
    [True, True, False, False, True]
    """
    words = [word for word in _WORD.findall(text[:400]) if not _NO_NAME.fullmatch(word)]
    begins_with_number = re.match(r"[-+.,\d]", text.strip()) is not None
    are_words = len(words) > begins_with_number and max(map(len, words)) > 2
    states_property = _PROPERTY.match(text.strip()) is not None
    return (are_words or states_property) and len(text) <= 100 * MOST_NAMED


def _names_above(above: list[tuple[int, str]], body: list[tuple[int, str]]) -> tuple[str, ...] | None:
    """Return the names in the last line of words, if it has as many as there are columns, or is alone with marks."""
    text = above[-1][1]
    separator = _separator(text)
    names = _names(text, separator)
    if names is None:
        return None
    first = _cells(body[0][1], _separator_of_numbers([row for _, row in body]), None)
    fits = len(names) == len(first)
    if len(above) == 1 and (fits or separator in {";", "\t", ","} or len(names) == 1):
        return names
    columns = [ColumnName.of(place, name) for place, name in enumerate(names)]
    are_names = any(one.is_time for one in columns) or all(one.unit for one in columns) or separator != " "
    return names if fits and (are_names or all(orientation(one.name) is not None for one in columns)) else None


def states_sampling(text: str) -> bool:
    """Return whether a line speaks of a sampling, as headers of other formats do."""
    return _OTHER_FORMAT.search(text[:200]) is not None


def names_on(text: str) -> tuple[str, ...] | None:
    """Return the names of columns that a line holds, if it holds nothing else."""
    return _names(text, _separator(text)) if text and not states_sampling(text) else None


def kind_of(unit: str) -> tuple[str | None, str]:
    """Return what unit of acceleration a word is, and of which quantity it is one; nothing if it is no unit.

    >>> kind_of("cm/s/s"), kind_of("cm/sec"), kind_of("furlong")
    (('cm/s2', 'acceleration'), (None, 'velocity'), (None, ''))
    """
    behind = _plain(unit if unit in ACCELERATION_UNITS else unit.replace("SEC", "sec"))
    small = _SPELT.get(behind.lower(), behind.lower())
    if behind in ACCELERATION_UNITS or small in _OF_ANY_CASE:
        return (behind if behind in ACCELERATION_UNITS else small), "acceleration"
    kinds = {"velocity": _VELOCITIES, "displacement": _LENGTHS, "count of a recorder": _COUNTS, "other": _OTHER_UNITS}
    return None, next((kind for kind, units in kinds.items() if small in units), "other" if small in _SECONDS else "")


def unit_named(source: Source, line: int | None, word: str) -> str | None:
    """Return which unit of acceleration a word is, or none; one of velocity, displacement or counts is refused."""
    unit, kind = kind_of(word)
    if kind in _TAKEN_FOR:
        raise source.error(
            line, "accelerations are needed, the file states {unit}, a {quantity}", unit=word[:20], quantity=kind
        )
    return unit


def looks_like_unit(text: str, *, square: bool = True) -> bool:
    """Return whether a text in brackets may be a unit: no direction, no word of a remark.

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
    """A column by what stands above it."""

    place: int  # where it is, from 0
    text: str  # as it stands
    name: str  # without a unit of ours
    unit: str | None = None  # A key of `rocking.conventions.ACCELERATION_UNITS`, where that stands in brackets
    behind: str = ""  # what else stands in the brackets, in small letters and without exponents' marks
    unknown_unit: str = ""  # a unit in brackets that is not known

    @classmethod
    def of(cls, place: int, text: str) -> "ColumnName":
        """Read what stands above a column."""
        # as our own tables name them: acceleration_m_s2
        bracketed = text
        if tail := _TAIL.fullmatch(text):
            stem, unit_behind = filter(None, tail.groups())
            bracketed = f"{stem} [{unit_behind.replace('_', '/')}]"
        found = _BRACKETS.fullmatch(bracketed)
        if found is None:
            return cls(place, text, text)
        inside = (found[2] if found[2] is not None else found[3]).strip()
        behind = _plain(inside)
        small = _SPELT.get(behind.lower(), behind.lower())
        unit, kind = kind_of(behind)
        name = (found[1].strip() if kind else "") or text
        if not kind:  # a unit and a remark, or the capital of g
            first = re.split(r"[\s,;]", inside)[0]
            unit, kind = ("g", "acceleration") if first in {"G", "g's", "gn"} else kind_of(first)
        unknown = inside if not kind and looks_like_unit(inside, square=found[2] is not None) else ""
        return cls(place, text, name, unit, small, unknown)

    @property
    def is_time(self) -> bool:
        """Whether it is called a time; a T may be a period, or transversal."""
        words = set(re.split(r"[\W\d_]+", self.name.casefold()))
        called = bool(words & _TIMES) or (self.name == "t" and (self.place == 0 or self.behind in _SECONDS))
        return called and self.unit is None

    @property
    def is_period(self) -> bool:
        """Whether it may be what a spectrum is drawn over."""
        return self.behind in {*_SECONDS, "hz"} or self.name.casefold().startswith(("period", "freq"))

    @property
    def is_acceleration(self) -> bool:
        """Whether it is an acceleration, or may be one because nothing says otherwise."""
        if self.unit is not None:
            return True
        other = self.behind in _OTHER_UNITS | _SECONDS or self.name.casefold().startswith(_OTHER_WORDS)
        return not self.is_time and not other


@dataclass(frozen=True, slots=True)
class NamedColumns:
    """Which of the named columns is what."""

    time: ColumnName | None
    accelerations: tuple[ColumnName, ...]
    left_out: tuple[str, ...]  # what is neither
    more_times: tuple[ColumnName, ...] = ()  # columns that are called a time as well

    @classmethod
    def of(cls, source: Source, texts: tuple[str, ...]) -> "NamedColumns":
        """Tell columns apart by their names."""
        named = tuple(ColumnName.of(place, text) for place, text in enumerate(texts))
        for one in named:
            if not one.text:
                raise source.error(None, "column {number} has no name; name it, or remove it", number=one.place + 1)
            if not one.is_time and one.name.casefold() in {other.name.casefold() for other in named[: one.place]}:
                raise source.error(None, "two columns are called {column!r:.60}; rename or remove one", column=one.name)
        times = [one for one in named if one.is_time]
        found = tuple(one for one in named if one.is_acceleration)
        if not found:
            kinds = {kind_of(one.behind)[1] for one in named} & _TAKEN_FOR
            hold = f", they hold {' and '.join(sorted(kinds))}" if kinds else ""
            raise source.error(
                None, "none of the columns {columns} is an acceleration in {units}{quantities}; name one such as acc "
                "[g]", columns=_listed(named), units=_UNITS, quantities=hold,
            )  # fmt: skip
        spectral = [one for one in named if one not in found and one.is_period]
        if not times and spectral:
            raise source.error(
                None,
                "{columns} may be periods of a spectrum: call it time [s] if it is that",
                columns=_listed(spectral),
            )
        if not times and len(found) > 1 and any(one.unit is None for one in found):
            raise source.error(
                None, "which of {columns} is the time? Name it time [s], or write the unit behind every acceleration, "
                "or remove all columns but one acceleration", columns=_listed(found),
            )  # fmt: skip
        times.sort(key=lambda one: one.behind not in {"", *_SECONDS})
        if times and times[0].behind not in {"", *_SECONDS}:
            raise source.error(
                None,
                Message(
                    "{columns}: the times must be in seconds; convert them, or remove them", {"columns": _listed(times)}
                ),
            )
        left_out = tuple(one.text for one in named if one not in found and one not in times)
        return cls(times[0] if times else None, found, left_out, tuple(times[1:]))

    def with_one_time(self, source: Source, values: FloatArray) -> "NamedColumns":
        """Return these columns with one time, of which the other times must be copies."""
        if not self.more_times or self.time is None:
            return self
        if any((values[:, one.place] != values[:, self.time.place]).any() for one in self.more_times):
            times = _listed([self.time, *self.more_times])
            raise source.error(None, "{columns} are both called a time; remove all but one", columns=times)
        return replace(self, more_times=(), left_out=(*self.left_out, *(one.text for one in self.more_times)))

    def with_stated_unit(self, source: Source, unit: str | None, unknown: str, asked: str | None) -> "NamedColumns":
        """Return these columns with a unit that words state for all; an unknown unit contradicts the requested one."""
        own = (one.unknown_unit for one in self.accelerations if one.unknown_unit and one.unit is None)
        unknown = next(own, unknown if unit is None else "")
        if unknown and asked is not None and all(one.unit is None for one in self.accelerations):
            raise source.error(
                None, "the file states the unit {unit!r}, you say {requested}; known are {units}", unit=unknown[:20],
                requested=asked, units=_UNITS,
            )  # fmt: skip
        if unit is None or any(one.unit is not None for one in self.accelerations):
            return self
        return replace(self, accelerations=tuple(replace(one, unit=unit) for one in self.accelerations))

    def with_unit(self, source: Source, asked: str | None) -> "NamedColumns":
        """Return the same with a unit for every acceleration."""
        silent = [one for one in self.accelerations if one.unit is None]
        if silent and asked is None and len(silent) < len(self.accelerations):
            raise source.error(
                None,
                "{columns} states no unit: write one behind, or remove the column" if len(silent) == 1
                else "{columns} state no unit: write one behind, or remove the column",
                columns=_listed(silent), hint=unit_to_state(),
            )  # fmt: skip
        said = (replace(one, unit=acceleration_unit(source, one.unit, asked)) for one in self.accelerations)
        return replace(self, accelerations=tuple(said))


def _lines(source: Source, most: int | None) -> list[tuple[int, str]]:
    lines: list[tuple[int, str]] = []
    for line, text in enumerate(source.lines):
        bare = (text if line else text.removeprefix(MARK)).strip(_BLANKS)
        if bare and bare[0] not in "#%" and (lines or not SAMPLING_LINE.fullmatch(bare)):
            lines.append((line, bare))
            if len(lines) == most:
                break
    while lines and not lines[-1][1].strip(",; \t"):  # empty rows of a spreadsheet
        lines.pop()
    return lines


def _separator(text: str) -> str:
    bare = _QUOTED.sub("", text)
    return next((mark for mark in (";", "\t", ",") if mark in bare), " ")


def _names(text: str, separator: str) -> tuple[str, ...] | None:
    """Return the names that a line holds; None if it holds anything else, such as numbers or a damaged one."""
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
    told = [name for name in names if name]
    good = all(_NAME.fullmatch(name) and not _NO_NAME.fullmatch(name) for name in told)
    # alone on its line, a letter with a number is rather a damaged number than a name
    damaged = len(told) == 1 and _DAMAGED_NUMBER.fullmatch(told[0])
    return names if told and good and not damaged else None


def _separator_of_numbers(rows: list[str]) -> str:
    """Return what parts rows of numbers; nothing where it may be blanks as well as commas."""
    looked = rows[:_FIRST_ROWS]
    if looked and ";" in looked[0]:
        return ";"
    commas, points = ("".join(looked).count(mark) for mark in ",.")
    if commas and not points and all(map(_DECIMAL_COMMAS.fullmatch, looked)):
        return "\t" if "\t" in looked[0] else " "
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
    return ", ".join(repr(one.text[:40]) for one in columns)
