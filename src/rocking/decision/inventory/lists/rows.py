"""Rows of a list: reasons why rows are not objects, and the sizes, shape and remarks of objects."""

import itertools
import math
import re
from collections.abc import Callable, Collection, Sequence
from pathlib import Path, PureWindowsPath
from typing import Any

from rocking.bodies import Block, Body, Isolated, Restrained, Section, Solid, Stack
from rocking.bodies.formats import read_body
from rocking.bodies.frame import refuse_frame
from rocking.decision.inventory.lists.cells import CellMeasure, is_missing
from rocking.decision.inventory.lists.columns import MEASURED, WORDS, plain, stem_of, words_of
from rocking.decision.inventory.lists.header import LocatedHeader
from rocking.decision.inventory.lists.sheets import Cell, Row, Sheet, text_of, text_of_row
from rocking.errors import InvalidValueError
from rocking.messages import Amount, Message

_SHAPES = {word: shape for shape, text in WORDS["shapes"].items() for word in words_of(text)}
_CONSEQUENCES = {word: level for level, text in WORDS["consequences"].items() for word in words_of(text)}
_TOTALS, _FOOTERS, _HEADINGS = (words_of(WORDS[name]) for name in ("totals", "footers", "headings"))
_LONGEST_NAME = 80
_REMARK = Message("a remark or a signature")
_HEADING = Message("a heading")


FIELD_NAMES = {
    ("width",): Message("width"), ("depth",): Message("depth"), ("height",): Message("height"),
    ("diameter",): Message("diameter"), ("pedestal",): Message("pedestal"), ("length",): Message("length"),
    ("base_width",): Message("base width"), ("base_depth",): Message("base depth"),
    ("centre_of_mass_height",): Message("centre of mass height"), ("width", "depth"): Message("width and depth"),
    ("base_width", "base_depth"): Message("base width and base depth"), ("weight",): Message("weight"),
    ("count",): Message("count"), ("friction",): Message("friction"),
}  # fmt: skip
"""Names of the fields of a column."""


class RowKinds:
    """Classification of rows below a header that are not objects: headings, sums, remarks, repeated headers."""

    def __init__(self, sheet: Sheet, location: LocatedHeader, rows: Sequence[Row]) -> None:
        self.sheet, self.header = sheet, location.header
        self.titles = [{plain(level) for level in levels} for levels in location.titles]
        self.above = {plain(text_of_row(cells)) for _, cells in sheet.rows[: location.first]}
        measured = [row for row in rows if self._is_measured(row[1]) and not self._is_sum_or_title(row[1])]
        self.last = measured[-1][0] if measured else 0
        numbers = [self.header.text(cells, "number") for _, cells in measured]
        self.number_patterns = {_number_pattern(number) for number in numbers} - {""}
        self.numbered = bool(measured) and sum(map(bool, numbers)) > 0.8 * len(measured)
        lines = [sheet.rows[location.end - 1][0], *(line for line, _ in rows)]
        self.after_gap = {line for previous, line in itertools.pairwise(lines) if line > previous + 1}

    def reason(self, line: int, cells: Sequence[Cell]) -> Message | None:
        """Return the reason why a row is not an object; None for a possible object."""
        texts = _texts(cells)
        first, measured = next(iter(texts.values())), self._is_measured(cells)
        if self._is_title_row(cells):
            return Message("a repeated header")
        if first in _TOTALS or (not measured and _begins_with(first, _TOTALS)):
            return Message("a sum or an average")
        if measured:
            return None
        if len(texts) == 1 and _begins_with(first, _HEADINGS) and line < self.last:
            return _HEADING
        number = self.header.text(cells, "number")
        if (
            number
            and _number_pattern(number) in self.number_patterns
            and (len(texts) > 1 or any(map(str.isalpha, number)))
        ):
            return None
        return self._reason_unmeasured(line, cells, texts)

    def _reason_unmeasured(self, line: int, cells: Sequence[Cell], texts: dict[int, str]) -> Message | None:
        """Return the reason why a row without sizes and regular number is not an object; None for a possible object."""
        first, own = next(iter(texts.values())), text_of(cells[next(iter(texts))])
        stems, alone = {self.header.stem(k) for k in texts}, len(texts) == 1
        if _begins_with(first, _FOOTERS) or own.startswith("*") or "___" in text_of_row(cells):
            return _REMARK
        if not stems & {"name", "number"}:
            return Message("no name, number or size")
        if alone and stems == {"number"} and first.replace(" ", "").isdigit():
            return Message("only a number")
        is_separate = self.numbered or line in self.after_gap
        merged = any((line, k) in self.sheet.spans for k in texts)
        if line > self.last:
            return _REMARK if is_separate or merged or own.endswith(":") or _begins_with(first, _HEADINGS) else None
        is_long = len(own) > _LONGEST_NAME
        return _HEADING if alone and (is_separate or merged or "name" not in stems or is_long) else None

    def _is_sum_or_title(self, cells: Sequence[Cell]) -> bool:
        return next(iter(_texts(cells).values())) in _TOTALS or self._is_title_row(cells)

    def _is_title_row(self, cells: Sequence[Cell]) -> bool:
        texts = _texts(cells)
        if any(text[:1].isdigit() for text in texts.values()) and self._is_measured(cells):
            return False  # fast exit for most rows
        repeated = sum(self._is_title(k, text) for k, text in texts.items())
        return repeated >= 0.7 * len(texts) or plain(text_of_row(cells)) in self.above

    def _is_title(self, column: int, text: str) -> bool:
        stem = self.header.stem(column)
        return column < len(self.titles) and (
            text in self.titles[column] or bool(stem and stem == stem_of(text, self.header.language))
        )

    def _is_measured(self, cells: Sequence[Cell]) -> bool:
        return any(self.header.stem(k) in MEASURED and text_of(cell) for k, cell in enumerate(cells))


def _texts(cells: Sequence[Cell]) -> dict[int, str]:
    """Return the plain text of the non-empty cells by column index."""
    return {k: plain(text) or text for k, cell in enumerate(cells) if (text := text_of(cell))}


def _begins_with(text: str, beginnings: Collection[str]) -> bool:
    return any(text == word or text.startswith(f"{word} ") for word in beginnings)


def _number_pattern(text: str) -> str:
    """Return the pattern of an inventory number, with 9 for digits and A or a for letters.

    >>> _number_pattern("A-17"), _number_pattern("1932.4 b")
    ('A-9', '9.9 a')
    """
    return re.sub(r"[^\W\d_]+", lambda match: "A" if match[0].isupper() else "a", re.sub(r"\d+", "9", text))


class RowValues:
    """Values of the cells of a row."""

    def __init__(self, row: int) -> None:
        self.fields: dict[str, Any] = {"row": row}
        self.titles: dict[str, str] = {}
        self.unknown: dict[str, Message] = {}
        self.approximate: dict[str, float] = {}
        self.remarks: list[Message] = []

    def take(self, fields: Sequence[str], size: CellMeasure, title: str, cell: Cell) -> None:
        for field in fields:
            if abs(self.fields.get(field, size.value) - size.value) > 1e-9 * abs(size.value):
                raise InvalidValueError(
                    "{title} and {other} state different values of {side}. Remove one.",
                    title=self.titles[field],
                    other=title,
                    side=FIELD_NAMES[field,],
                )
        self.fields |= dict.fromkeys(fields, size.value)
        self.titles |= dict.fromkeys(fields, title)
        if size.half_width:
            self.approximate |= dict.fromkeys(fields, size.half_width)
            facts = {
                "title": title, "cell": f"{cell!r:.60}", "size": FIELD_NAMES[tuple(fields)],
                "value": Amount(size.value, "m", ".4g"), "half": Amount(size.half_width, "m", ".2g"),
            }  # fmt: skip
            self.remarks.append(Message("{title} {cell}: {size} is {value} ± {half}", facts))

    def optional(self, field: str, value: Any, remark: Message) -> None:
        if value is None:
            self.remarks.append(remark)
        else:
            self.fields[field] = value

    def settle_shape(self) -> None:
        """Convert diameter, pedestal and shape to fields of an object."""
        fields, word = self.fields, self.fields.pop("shape", "")
        shape = "" if is_missing(word) else _SHAPES.get(plain(word), "unknown")
        if (across := fields.pop("diameter", None)) is not None:
            other = next(
                (way for way in ("width", "depth") if abs(fields.get(way, across) - across) > 1e-9 * across), None
            )
            title, cell = self.titles["diameter"], f"{word!r:.40}"
            if shape == "box":
                raise InvalidValueError(
                    "The object has a {title} and the shape {cell}. Remove one of these entries.",
                    title=title,
                    cell=cell,
                )
            if other:
                side = FIELD_NAMES[other,]
                raise InvalidValueError(
                    "The object has a {title} and a different {side}. Remove one of these entries.",
                    title=title,
                    side=side,
                )
            fields |= {"width": across, "depth": across}
            if half := self.approximate.pop("diameter", 0.0):
                self.approximate |= {"width": half, "depth": half}
            shape = "round" if shape in {"", "unknown"} else shape
        self._settle_pedestal()
        if "solid" in fields or shape in {"", "box"}:
            return
        if shape == "unknown":
            raise InvalidValueError(
                "Unknown shape {cell}. Use round, oval, rectangular, triangular or polygonal; a box is not "
                "conservative. An empty cell is a box.",
                cell=f"{word!r:.40}",
            )
        sides = [way for way in ("width", "depth") if way in fields]
        if len(sides) == 1 and shape != "triangle":
            (own,), (other,) = sides, {"width", "depth"} - set(sides)
            fields[other] = fields[own]
            if own in self.approximate:
                self.approximate[other] = self.approximate[own]
        elif len(sides) < 2:
            return
        if shape != "round" and min(fields["width"], fields["depth"]) > 0.0:  # other values are refused later
            self._inscribe(shape, word)
        fields["shape"] = "round"

    def _inscribe(self, shape: str, word: str) -> None:
        """Use the inscribed round body of an outline with corners: its uplift acceleration is the smallest.

        Its radius is the distance to the nearest side: a third of the height over the longest side of a triangle, and
        at least the cosine of 36 degrees of half the size of a regular polygon with five or more sides.
        """
        fields = self.fields
        width, depth = fields["width"], fields["depth"]
        across = 2.0 * width * depth / (3.0 * math.hypot(width, depth))
        if shape == "polygon":
            across = min(width, depth) * math.cos(math.pi / 5.0)
        half = max((self.approximate.get(way, 0.0) / fields[way] for way in ("width", "depth")), default=0.0)
        fields |= {"width": across, "depth": across}
        if half:
            self.approximate |= {"width": half * across, "depth": half * across}
        for base in {"base_width", "base_depth"} & fields.keys():
            fields[base] = min(fields[base], across)
        facts = {"cell": f"{word!r:.40}", "across": Amount(across, "m", ".3g")}
        self.remarks.append(Message("shape {cell}: the inscribed round body is used, diameter {across}", facts))

    def _settle_pedestal(self) -> None:
        fields, title = self.fields, self.titles.get("pedestal", "")
        pedestal, half = fields.pop("pedestal", None), self.approximate.pop("pedestal", 0.0)
        if pedestal is None:
            return
        size = min((fields[way] for way in ("width", "depth") if way in fields), default=0.0)
        if {"base_width", "base_depth", "solid"} & fields.keys() or pedestal > size:
            self.remarks.append(
                ignored_remark(
                    title, Message("the pedestal is larger than the object, or the list contains the size of the base")
                )
            )
        else:
            both = ("base_width", "base_depth")
            fields |= dict.fromkeys(both, pedestal)
            self.approximate |= dict.fromkeys(both, half) if half else {}
            self.remarks.append(Message("{title} is used as its base", {"title": title}))

    def settle_words(self, find: Callable[[str], Path] | None) -> None:
        """Convert consequence and photo to fields of an object."""
        if (word := self.fields.pop("consequence", None)) and not is_missing(word):
            self.fields["consequence"] = _CONSEQUENCES.get(plain(word), "high")  # unknown words count as high
            if plain(word) not in _CONSEQUENCES:
                facts = {"cell": f"{word!r:.40}"}
                self.remarks.append(Message("consequence {cell} is not low, medium or high; high is used", facts))
        if photo := self.fields.pop("photo", None):
            remark = Message("photo {cell} is no picture in the folder of the list", {"cell": f"{photo!r:.80}"})
            self.optional("photo", photo_of(photo, find), remark)


def ignored_remark(title: str | Message, reason: Message) -> Message:
    """Return the remark on a value that is not used."""
    return Message("{title} was ignored: {reason}", {"title": title, "reason": reason})


def body_of(name: str, units: Any, find: Callable[[str], Path] | None) -> dict[str, object]:
    """Return the body of a file, and its size."""
    if find is None:
        raise InvalidValueError("Body file {cell} is not allowed here. Use sizes.", cell=f"{name!r:.60}")
    body = read_body(find(name), units=units)
    if isinstance(body, (Block, Section)):
        body = Solid.from_section(body)
    refuse_frame(body)
    if isinstance(body, (Restrained, Isolated, Stack)):
        raise InvalidValueError(
            "{file}: an inventory needs a body without restraints, isolated base and joints", file=name
        )
    if isinstance(body, Body):
        raise InvalidValueError("{file}: mass points define no shape in three dimensions", file=name)
    size = body.box[1] - body.box[0]
    return {"solid": body, **dict(zip(("width", "depth", "height"), size.tolist(), strict=True))}


def photo_of(name: str, find: Callable[[str], Path] | None) -> Path | None:
    """Return the path of a picture; None for another file, or outside the folder of the list and its subfolders."""
    parts_of = PureWindowsPath(name).parts
    if find is None or PureWindowsPath(name).anchor or name.startswith("/") or ".." in parts_of:
        return None
    try:
        from PIL import Image

        path = find("/".join(parts_of))
        if not path.resolve().is_relative_to(path.parents[len(parts_of) - 1].resolve()):
            return None
        with Image.open(path) as picture:
            picture.verify()
    except Exception:  # noqa: BLE001 - a damaged picture raises any error of its reader
        return None
    return path
