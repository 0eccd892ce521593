"""Columns of numbers, with or without a line of names: one value a line, or a time and accelerations."""

import math
import re
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats import headers
from rocking.motions.formats.column_text import (
    MARK,
    MOST_NAMED,
    SAMPLING_LINE,
    ColumnName,
    ColumnText,
    NamedColumns,
    kind_of,
    names_on,
    readable,
    states_sampling,
    unit_named,
)
from rocking.motions.formats.header_values import columns_of
from rocking.motions.formats.headers import step_between_samples, step_of_times
from rocking.motions.formats.numbers import number
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, one_line

_MOST_COLUMNS = 4
_LOOK = 5
_LONGEST_HEADER = 100


class Columns(RecordFormat):
    """Plain columns of text; the last resort, since such a file says little about itself.

    Without names, a line holds one acceleration, or a time and one to three of them; blanks, tabs or commas part
    them, or semicolons. Lines that begin with ``#`` or ``%`` are comments, and stay so.

    One line of names may stand above the numbers, ``time [s], NS [g], EW [g]``, with the unit of a column in brackets
    or parentheses. A key of `rocking.conventions.ACCELERATION_UNITS` is taken, m/s^2, m/s/s and Gal as well; any
    other unit, or none, is asked for. A column that is called time, or t where it stands first, is the time, in
    seconds; one in another unit (m/s, m, rad), or called a velocity or displacement, is left out, and the metadata
    say so. Without a time the step is asked for, if the rest is clear: otherwise the error names the columns and says
    what to write or remove. Semicolons, tabs, commas or blanks part names and numbers alike.

    Where commas part nothing they are decimal points, as a spreadsheet of much of Europe writes them; a file with
    both, or one where commas may be either, is refused.
    """

    name: ClassVar[str] = "columns"
    title: ClassVar[str] = "Columns of numbers: a, or t a, or t a1 a2 a3, or under a line of names"
    suffixes: ClassVar[tuple[str, ...]] = (".txt", ".dat", ".csv")
    states_unit: ClassVar[bool] = False
    states_time_step: ClassVar[bool] = False
    notes: ClassVar[str] = (
        "Verified on five real files. Without names, as time [s], acc [g], nothing tells an acceleration from a "
        "velocity, nor g from m/s2: the unit must be known from elsewhere. A missing first or last line cannot be "
        "noticed, nor any without a time column."
    )

    def recognises(self, source: Source) -> bool:
        """Return whether the first lines hold nothing but 1 to 4 numbers each, or names and as many numbers."""
        looked = _looked_at(source)
        if looked is None:
            return False
        try:
            _ = [_value(source, line, cell) for line, cells in looked for cell in cells]
        except RecordError:
            return False
        return True

    def refusal(self, source: Source) -> RecordError | None:
        """Return the error for a NaN or infinity on the first lines of what would be columns without it."""
        looked = _looked_at(source)
        if looked is None:
            return None
        found: RecordError | None = None
        for line, cells in looked:
            for cell in cells:
                try:
                    _value(source, line, cell)
                except RecordError as error:
                    if not _beyond_numbers(cell):
                        return None
                    found = found or error
        return found

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record, a component for each column of accelerations; without times it needs the step."""
        # without names they are "acceleration", or "column 2", "column 3", "column 4" after the times
        if not source.is_text:
            raise source.error(None, "not a text file")
        headers.refuse_other(source)
        text = ColumnText.of(source)
        if not text.rows:
            raise source.error(None, "no line with numbers")
        # such a number comes first: what it does to names, commas and widths would only hide it
        for line, cells in text.rows[:_LOOK]:
            _ = [_value(source, line, cell) for cell in cells if _beyond_numbers(cell)]
        comments = _comments(source)
        said = Said.of(source, comments, len(text.rows[0][1]))
        names = text.names or said.names
        wide = names is None and len(text.rows[0][1]) > _MOST_COLUMNS
        if wide:
            chosen, values = _row_by_row(source, _table(source, text, ragged=True))
        else:
            chosen = _by_place(source, text) if names is None else NamedColumns.of(source, names)
            values = _table(source, text, ragged=False)
        told = time_step if said.step is None else step_between_samples(source, said.step, time_step)
        step, metadata = told, {}
        if chosen.time is not None:
            times, place = values[:, chosen.time.place], chosen.time.place
            step = step_of_times(source, times, [cells[place] for _, cells in text.rows], told)
            metadata = {"first time": f"{times[0]:g} s"}
        step = step_between_samples(source, None, step)
        if said.count is not None:
            headers.check_count(source, said.count, len(values))
        if said.unit is not None and all(one.unit is None for one in chosen.accelerations):
            chosen = replace(chosen, accelerations=tuple(replace(one, unit=said.unit) for one in chosen.accelerations))
        if chosen.left_out:
            metadata["left out"] = ", ".join(chosen.left_out)
        parts = tuple(
            Component(one.name, values[:, one.place].copy(), one.unit or "", step)
            for one in chosen.with_unit(source, units).accelerations
        )
        header = [*(comment for _, comment in comments), *filter(None, [text.heading])]
        return Record(self.name, parts, "\n".join(header), metadata)

    def write(self, record: Record) -> bytes:
        """Return a file with a column of times and one to three of accelerations, to all digits and with the unit."""
        samples, step = columns_of(record, self.name, None, _MOST_COLUMNS - 1)
        named = [re.sub(r"[\[\](),;=]", " ", one_line(part.name, 40)).strip() for part in record.components]
        unit = record.components[0].unit
        heading = ", ".join(["time [s]", *(f"{name} [{unit}]" for name in named)])
        # a name that could not be read as one
        if len({name.casefold() for name in named}) < len(named) or len(names_on(heading) or ()) != len(named) + 1:
            heading = ", ".join(["time [s]", *(f"column {place + 2} [{unit}]" for place in range(len(named)))])
        lines = [f"# {heading}"]
        for place, sample in enumerate(samples):
            lines.append(" ".join([f"{place * step:.9f}", *(repr(float(value)) for value in sample)]))
        return ("\n".join(lines) + "\n").encode("latin-1")


def _looked_at(source: Source) -> list[tuple[int, list[str]]] | None:
    """Return the first lines of cells, not yet numbers, that decide whether these are columns; None if they are not."""
    comments = [text for _, text in _comments(source, _LONGEST_HEADER)]
    if not source.is_text or any(states_sampling(text) and not is_understood(text) for text in comments):
        return None
    text = ColumnText.of(source, _LOOK)
    # damage further down is told by the reader, with its line, where names say that these are columns
    looked = text.rows if text.names is None else text.rows[:1]
    # an acceleration that goes on row after row ends where it ends
    if 1 < len(looked) < _LOOK and len(looked[0][1]) > _MOST_COLUMNS:
        looked = looked[:-1]
    counts = {len(cells) for _, cells in looked}
    if len(counts) != 1:
        return None
    if text.names is None:
        return looked if max(counts) <= MOST_NAMED else None
    # so is one name more or less, where the separator is clear
    clear = counts == {len(text.names)} or text.separator in {";", "\t", ","}
    return looked if clear and max(counts) <= MOST_NAMED else None


def _beyond_numbers(cell: str) -> bool:
    """Return whether a cell is a NaN or an infinity, in letters or by its exponent."""
    try:
        return not math.isfinite(float(cell.replace(",", ".").lower().replace("d", "e")))
    except ValueError:
        return False


def _comments(source: Source, most: int | None = None) -> list[tuple[int, str]]:
    bare = ((line, text.removeprefix(MARK)) for line, text in enumerate(source.lines[:most]))
    return [
        (line, text) for line, text in bare if text.lstrip()[:1] in {"#", "%"} or SAMPLING_LINE.fullmatch(text.strip())
    ]


def _by_place(source: Source, text: ColumnText) -> NamedColumns:
    """Return what columns without names are: a lone acceleration, or a time and one to three of them."""
    line, cells = text.rows[0]
    if not 1 <= len(cells) <= _MOST_COLUMNS:
        raise source.error(line, f"1 to {_MOST_COLUMNS} columns expected, found {len(cells)}; which format is it?")
    if len(cells) == 1:
        return NamedColumns(None, (ColumnName(0, "", "acceleration"),), ())
    named = [ColumnName(place, "", f"column {place + 1}") for place in range(len(cells))]
    return NamedColumns(named[0], tuple(named[1:]), ())


def _row_by_row(source: Source, values: FloatArray) -> tuple[NamedColumns, FloatArray]:
    """Return what many columns without names are: times and accelerations, or one acceleration that goes on and on."""
    accelerations = tuple(ColumnName(place, "", f"column {place + 1}") for place in range(1, values.shape[1]))
    first = values[:, 0][np.isfinite(values[:, 0])]
    rises = np.diff(first)
    if first.size > 2 and (rises > 0.0).all() and np.ptp(rises) <= 0.5 * rises.mean():
        if not np.isfinite(values).all():
            raise source.error(None, f"the last line must have {values.shape[1]} numbers, as the first")
        return NamedColumns(ColumnName(0, "", "column 1"), accelerations, ()), values
    one = NamedColumns(None, (ColumnName(0, "", "acceleration"),), ())
    return one, values[np.isfinite(values)].reshape(-1, 1)


def _table(source: Source, text: ColumnText, *, ragged: bool) -> FloatArray:
    commas = [line for line, _ in text.rows if "," in source.lines[line]]
    points = [line for line, cells in text.rows if any("." in cell for cell in cells)]
    if commas and text.separator == "" and not points:
        raise source.error(commas[0], "commas but no decimal point: write decimal commas as points")
    if commas and points and text.separator not in {"", ","}:
        raise source.error(commas[0], f"decimal commas here and decimal points on line {points[0] + 1}: write one kind")
    hint = "; where commas part the columns, decimals need a point" if text.separator == "," else ""
    if text.names is None:
        columns, why = len(text.rows[0][1]), " as on the first line"
    else:
        columns, why = len(text.names), ", as many as there are names"
    values = np.full((len(text.rows), columns), np.nan)
    for row, (line, cells) in enumerate(text.rows):
        if ragged and row == len(text.rows) - 1 and 0 < len(cells) < columns:
            values[row, : len(cells)] = [_value(source, line, cell) for cell in cells]
            continue
        if len(cells) != columns:
            raise source.error(line, f"{columns} numbers expected{why}, found {len(cells)}{hint}")
        values[row] = [_value(source, line, cell) for cell in cells]
    if len(text.rows) < 2 and not ragged:
        raise source.error(None, "at least 2 samples are needed, found 1")
    return values


def _value(source: Source, line: int, cell: str) -> float:
    return number(source, line, cell.replace(",", "."))


# what comments above columns say of them, or that these are no accelerations
_NUMBER = r"(\d*\.?\d+(?:[eE][-+]?\d+)?)"
_SAYS = r"\b[^\d=:]{0,20}[=:]\s*"
_BOTH = re.compile(rf"\bNPTS\s*,\s*DT\s*[=:]?\s*(\d+)[\s,]+{_NUMBER}", re.IGNORECASE)
_COUNT = re.compile(rf"\b(?:npts|nsamples|number of (?:points|samples|data)){_SAYS}(\d+)\b", re.IGNORECASE)
_STEP = re.compile(
    rf"\b(?:(?:dt|delta_?t|time[_ -]?(?:step|increment)|sampling[_ -](?:interval|period|step)){_SAYS}"
    rf"|(?:zeitschritt|abtastintervall|passo temporale|paso de tiempo)\b\s*[=:]?\s*)"
    r"(\d*[.,]?\d+(?:[eE][-+]?\d+)?)\s*(ms\b)?",
    re.I,
)
_SPECTRUM = re.compile(
    r"^\W*(?:periods?|t)\s*[\[(]\s*s(?:ec)?\s*[\])][\s,;|]+(?:p?s[adv]|spectral)(?![^\W_])", re.IGNORECASE
)
_COUNTS = re.compile(r"^\W*(?:raw\s+)?counts?\b(?!\s*[:=]?\s*\d)", re.IGNORECASE)
_RATE = re.compile(rf"\b(?:sampling|sample)[_ -](?:rate|freq\w*){_SAYS}{_NUMBER}", re.IGNORECASE)
_UNIT = re.compile(r"\bunits?\b\s*(?:[:=]|of|are|is|in)\s*[\[(]?\s*([A-Za-z][\w/^*.-]*)", re.IGNORECASE)
_UNIT_OF = re.compile(r"\b(?:accel|veloc|displ)\w*\s+(?:in\s+|\[|\()\s*([A-Za-z][\w/^*.-]*)", re.IGNORECASE)
_OTHER = re.compile(
    r"^\W*(?:ground )?(velocity|displacement)(?:\b.*(?:series|histor|record|trace)|\s*$)", re.IGNORECASE
)


@dataclass(frozen=True)
class Said:
    """What the comments of a file say; None and nothing where they are silent."""

    names: tuple[str, ...] | None = None
    unit: str | None = None  # a key of `rocking.conventions.ACCELERATION_UNITS`
    step: float | None = None  # [s]
    count: int | None = None

    @classmethod
    def of(cls, source: Source, comments: list[tuple[int, str]], columns: int) -> "Said":
        """Read comments by their lines; what speaks of velocities or displacements alone is refused."""
        names, unit, step, count = None, None, None, None
        for line, text in comments:
            bare = readable(text.strip().lstrip("#% \t")[:400])
            if _SPECTRUM.search(bare):
                raise source.error(line, f"{bare[:40]!r}: a response spectrum is no record; motion.target= takes one")
            if _COUNTS.search(bare):
                raise source.error(line, f"{bare[:40]!r}: counts of a recorder are no accelerations; divide them first")
            if both := _BOTH.search(bare):
                count, step = int(both[1][:9]), number(source, line, both[2])
            elif found := _COUNT.search(bare):
                count = int(found[1][:9])
            if not both and (found := _STEP.search(bare)):
                step = number(source, line, found[1].replace(",", ".")) * (1e-3 if found[2] else 1.0)
            if (found := _RATE.search(bare)) and (rate := number(source, line, found[1])) > 0.0:
                step = 1.0 / rate
            for word in (*_UNIT.findall(bare), *_UNIT_OF.findall(bare)):
                said = unit_named(source, line, word.rstrip(".-"))
                unit = headers.acceleration_unit(source, unit, said) if said else unit
            called = names_on(bare)
            found_names = [ColumnName.of(place, one) for place, one in enumerate(called or ())]
            # words with a unit somewhere are names if they name a time, or are accelerations all
            named = any(one.is_time for one in found_names) or all(one.unit for one in found_names)
            if len(found_names) == columns and named and any(kind_of(one.behind)[1] for one in found_names):
                names = called
        spoken = " ".join(text for _, text in comments).lower()
        other = next((one for _, text in comments if (one := _OTHER.match(text[:200]))), None)
        if other and not unit and not names and "accel" not in spoken:
            headers.refuse_other(source, other[1])
        return cls(names, unit, step, count)


def is_understood(text: str) -> bool:
    """Return whether a comment that speaks of a sampling says it in a way that is read here."""
    return any(form.search(text[:400]) for form in (_BOTH, _COUNT, _STEP, _RATE))
