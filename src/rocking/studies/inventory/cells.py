"""Measures in cells: a number with or without its unit, about or between two, or none; and one of several parts."""

# ruff: noqa: RUF001 - signs and words of other alphabets are meant

import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from rocking import checks
from rocking.conventions import LENGTH_UNITS
from rocking.errors import InvalidValueError
from rocking.messages import Message
from rocking.studies.inventory.columns import FACTORS, UNITS, WORDS, order_of, plain, side_of, words_of
from rocking.studies.inventory.sheets import Cell, Shown

ABOUT = 0.05
"""Half the interval of a measure that is said to be about right, "ca. 120" or "120?", as a share of it [-]."""

_NUMBER = re.compile(r"[+-]?[0-9]+(?:([.,])([0-9]+))?(?:[eE][+-]?[0-9]+)?")
# three digits after the mark could be thousands, unless what is before cannot be
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}[.,][0-9]{3}")
# what can only be thousands: blanks, apostrophes, the same mark twice, or one mark before the other
_GROUPED = re.compile(
    r"(?<![0-9.,'])(?:[1-9](?: [0-9]{3})+(?:[.,][0-9]+)?"
    r"|[1-9][0-9]{0,2}(?:(?:[\u00a0\u202f\u2009'\u2019][0-9]{3})+(?:[.,][0-9]+)?"
    r"|(?:\.[0-9]{3}){2,}(?:,[0-9]+)?|(?:,[0-9]{3}){2,}(?:\.[0-9]+)?|\.[0-9]{3},[0-9]+|,[0-9]{3}\.[0-9]+))"
    r"(?![0-9.,'\"])"
)


def without_thousands(text: str) -> str:
    """Return text whose numbers have no separators of thousands, where these can be nothing else.

    >>> [without_thousands(text) for text in ("1.234,5", "2 350 mm", "1.234", "4' 6")]
    ['1234,5', '2350 mm', '1.234', "4' 6"]
    """
    return _GROUPED.sub(lambda match: _ungrouped(match[0]), text)


def _ungrouped(number: str) -> str:
    last = re.search(r"[.,][0-9]+$", number)
    mark = last[0] if last and number.count(last[0][0]) == 1 else ""
    return re.sub(r"[^0-9]", "", number.removesuffix(mark)) + mark


class DecimalMark:
    """The mark that separates the decimals in a table, by all of its numbers together.

    ``12,5`` can only have a decimal comma. ``1,234`` could have thousands, and so could ``1.234``. Its mark separates
    decimals if the same mark does elsewhere in the table and the other does not. It separates thousands if it does in
    a number such as ``1.234,5``, or if the other numbers of the column are near. Where commas separate the fields,
    decimals have points, and ``1.234`` is one unless a decimal comma contradicts it.

    >>> mark = DecimalMark(["12,5", "1,234", "7 cm"])
    >>> mark.number("width_cm", "1,234")
    1.234
    """

    def __init__(
        self, cells: Iterable[str], *, comma_delimited: bool = False, columns: Mapping[str, Sequence[str]] | None = None
    ) -> None:
        marks, groups = set(), set()
        for cell in cells:
            groups |= {match[0].lstrip("0123456789")[0] for match in _GROUPED.finditer(cell[:_LONGEST])}
            for match in _NUMBER.finditer(without_thousands(cell[:_LONGEST])):
                if match[1] and not _THOUSANDS.fullmatch(match[0]):
                    marks.add(match[1])
        self.commas, self.points, self.comma_delimited = "," in marks, "." in marks, comma_delimited
        self.groups = groups - marks
        self.columns = columns or {}  # the texts of each column, by its title

    def number(self, name: str, cell: str) -> float:
        """Return the number in a cell, in the unit of the column."""
        text = without_thousands(cell.strip())
        match = _NUMBER.fullmatch(text)
        if not match:
            raise InvalidValueError(
                "{title} must be one number such as 12.5, without unit and without separators of thousands, got {cell}",
                title=name,
                cell=f"{text[:40]!r}",
            )
        if _THOUSANDS.fullmatch(text) and not self._separates_decimals(match[1]):
            if match[1] in self.groups or self._settles(name, text):
                return checks.number(name, float(text.replace(match[1], "")))
            digits = text.replace(match[1], "")
            decimal = text.replace(",", ".")
            raise _ambiguous(name, text, (decimal, digits), f"{decimal}0")
        return checks.number(name, float(text.replace(",", ".")))

    def is_settled_by_column(self, name: str, cell: str) -> bool:
        """Return whether only the other numbers of its column say that a mark in a number parts thousands."""
        text = cell.strip()
        mark = re.sub(r"[0-9+-]", "", text)
        by_table = mark in self.groups or self._separates_decimals(mark)
        return bool(_THOUSANDS.fullmatch(text)) and not by_table and self._settles(name, text)

    def _separates_decimals(self, mark: str) -> bool:
        """Return whether the other numbers of the table say that a mark separates decimals."""
        if mark == ",":
            return self.commas and not self.points
        return not self.commas and (self.points or self.comma_delimited)

    def _settles(self, name: str, text: str) -> bool:
        """Return whether the other numbers of a column are near a number with thousands, and far from its decimals."""
        others = [
            float(each.replace(",", "."))
            for each in self.columns.get(name, ()) if _NUMBER.fullmatch(each) and not _THOUSANDS.fullmatch(each)
        ]  # fmt: skip
        decimal = float(text.replace(",", "."))
        return len(others) >= _ENOUGH and all(
            1.0 / _NEAR < 1000.0 * decimal / other < _NEAR and other > _NEAR * decimal for other in others if other
        )


def _ambiguous(title: str, text: str, readings: tuple[str, str], first: str = "") -> InvalidValueError:
    return InvalidValueError(
        "{title} is ambiguous: {cell} could be {one} or {other}; write {clear} or {other}",
        title=title,
        cell=repr(text),
        one=readings[0],
        other=readings[1],
        clear=first or readings[0],
    )


_ENOUGH, _NEAR = 3, 30.0  # numbers of a column that settle another, and how far they may be from it [-]
_LONGEST = 200
_SAME = 0.02  # a measure in centimetres and in inches, rounded [-]
_OTHERWISE = 0.5  # two sizes that are no size and what it might be instead [-]
_ABOUT = "|".join(sorted(words_of(WORDS["about"]), key=len, reverse=True))
_WITH = "|".join(words_of(WORDS["with"]))
_UNKNOWN = words_of(WORDS["unknown"])
_FRACTION = r"[0-9]{1,2}/(?:2|3|4|8|16|32|64)(?![0-9])"  # as of inches: 120/130 is none
_ONE = rf"{_FRACTION}|[0-9]+(?:[.,][0-9]+)?(?: {_FRACTION})?"
_UNIT = rf"(?:(?!(?:{_WITH})\b)[^\W\d]{{1,15}}\.?|['\"])"
_QUANTITY = rf"(?:{_ONE})\s*(?:{_UNIT}\s*(?:(?:{_ONE})\s*{_UNIT})?)?"
_ABOUT_FIRST = re.compile(rf"(?:~|≈|±|(?:{_ABOUT})(?=[\s.0-9])\.?)\s*(?=\S)")
_BETWEEN = re.compile(rf"({_QUANTITY})\s*(-|–|—|/|bis|to|until|a|hasta|εως|至|~)\s*({_QUANTITY})")
_BESIDE = re.compile(rf"({_QUANTITY})\s*\(=?\s*({_QUANTITY})[^\d()]*\)")
_IN_BRACKETS = re.compile(rf"[(\[]([^()\[\]]*\d[^()\[\]]*)[)\]]\s*({_UNIT})?")
# a foot before a number is that of the object, and "in" a word
_UNIT_FIRST = re.compile(r"(mm|cm|m|kg|g|lbs?)\.?\s*(\D{0,20}\d.*)")
_DOUBT = re.compile(rf"\s*(?:\?+|[(\[][^\d()\[\]]*[)\]]|\b(?:ca|circa|approx)\.?|\b(?:{_WITH})\b[^\d()]*)$")
_GIVE_OR_TAKE = re.compile(rf"({_QUANTITY})\s*(?:±|\+ ?/ ?-|\+-)\s*({_QUANTITY})")
_PAIR = re.compile(rf"({_ONE})\s*([^\W\d]{{1,15}}|['\"])?\.?\s*")
_MARKS = {"'": "ft", '"': "in"}
_TWO_SIZES = "{title} says two sizes, got {cell}"
_DATE = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}.*|[0-9]{2}:[0-9]{2}.*")


@dataclass(frozen=True)
class CellMeasure:
    """What a cell says, in SI units."""

    value: float
    half_width: float = 0.0  # of the interval, if it is not known well
    across: bool = False  # whether it is said to be a diameter


def is_missing(cell: Cell) -> bool:
    """Return whether a cell says that nothing is known, or nothing at all.

    >>> [is_missing(cell) for cell in ("?", "k. A.", "#REF!", "unbekannt", "120?")]
    [True, True, True, True, False]
    """
    return isinstance(cell, str) and (cell.startswith("#") or not cell.strip(" ?-–—./…") or plain(cell) in _UNKNOWN)


def measure(
    title: str, cell: Cell, factor: float | None, mark: DecimalMark, units: Mapping[str, float] = LENGTH_UNITS
) -> CellMeasure:
    """Return what a cell measures; factor: of numbers without a unit, if that is known; units: those it may have."""
    if isinstance(cell, Shown):
        one = measure(title, cell.one, factor, mark, units)
        return CellMeasure(cell * one.value, cell * one.half_width, one.across)
    if isinstance(cell, float):
        return CellMeasure(checks.number(title, cell) * _named(title, cell, factor))
    if _NUMBER.fullmatch(cell.strip()):
        return CellMeasure(mark.number(title, cell) * _named(title, cell, factor))

    def quantity(text: str, beside: str = "") -> float:
        return _quantity(title, text, factor, mark, units, beside)

    text = _tidied(without_thousands(cell))
    across = text.startswith(("ø", "dm "))
    text, about = _without_about(re.sub(r"^(?:ø|dm )\s*", "", text))
    if match := _GIVE_OR_TAKE.fullmatch(text):
        return CellMeasure(quantity(match[1], match[2]), quantity(match[2]), across)
    two = _two(title, text, quantity)
    value, half = (quantity(text), 0.0) if two is None else (0.5 * (two[1] + two[0]), 0.5 * (two[1] - two[0]))
    return CellMeasure(value, half or (ABOUT * value if about else 0.0), across)


def _two(title: str, text: str, quantity: Callable[[str, str], float]) -> tuple[float, float] | None:
    """Return the smaller and the larger of two measures in a text, twice the first if they say the same."""
    if (match := _BETWEEN.fullmatch(text)) and not (match[2] == "/" and re.match(_FRACTION, text)):
        low, high = quantity(match[1], match[3]), quantity(match[3], "")
        if match[2] == "/" and low > high > 0.0:  # in front and behind, of which neither is the first
            low, high = high, low
        if not low < high:
            raise InvalidValueError(
                "{title} must go from the smaller to the larger, got {cell}", title=title, cell=f"{text!r:.40}"
            )
        return low, high
    if match := _BESIDE.fullmatch(text):  # the same in another unit, or what else it might be
        value, other = quantity(match[1], ""), quantity(match[2], match[1])
        if abs(value - other) > _OTHERWISE * value:
            raise InvalidValueError(_TWO_SIZES, title=title, cell=f"{text!r:.40}")
        return (value, value) if abs(value - other) <= _SAME * value else (min(value, other), max(value, other))
    return None


def _tidied(cell: str) -> str:
    text = re.sub(r"(?<=\d)?([¼½¾⅓⅔⅛⅜⅝⅞])", r" \1", cell[:_LONGEST])
    text = unicodedata.normalize("NFKC", text.lower()).replace("⁄", "/").replace("⌀", "ø")
    for odd, usual in (("''", '"'), ("″", '"'), ("”", '"'), ("“", '"'), ("′", "'"), ("’", "'")):
        text = text.replace(odd, usual)
    return " ".join(text.split())


def _without_about(text: str) -> tuple[str, bool]:
    """Return a measure without what says that it is not known well, or how it was taken; and whether anything did."""
    whole = "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))
    match = _ABOUT_FIRST.match(whole)
    bare = _DOUBT.sub("", whole[match.end() :] if match else whole)
    bare = _IN_BRACKETS.sub(r"\1 \2", bare).strip() if _IN_BRACKETS.fullmatch(bare) else bare.strip()
    if bare != whole:
        return _without_about(bare)[0], True
    match = _UNIT_FIRST.fullmatch(whole)
    if match:
        return _without_about(f"{match[2]} {match[1]}")
    return whole, False


def _quantity(
    title: str, text: str, factor: float | None, mark: DecimalMark, units: Mapping[str, float], beside: str
) -> float:
    """Return a number with its unit, or feet with inches; beside: where the unit of one without may stand."""
    pairs = _PAIR.findall(text) if re.fullmatch(_QUANTITY, text) else []
    factors = [units.get(_unit(word), 0.0) for _, word in pairs]
    if not pairs or (
        len(pairs) > 1 and (sorted(set(factors), reverse=True) != factors or len(pairs) > 2 or 0.0 in factors)
    ):
        date = Message("a date, which a spreadsheet made of a number?")
        raise InvalidValueError(
            "{title} must be one number such as 12.5, 120 cm, ca. 120 or 120-130, without separators of thousands, "
            "got {cell}",
            title=title,
            cell=f"{text[:40]!r}",
            hint=date if _DATE.fullmatch(text) else "",
        )
    if odd := next((word for (_, word), one in zip(pairs, factors, strict=True) if word and not one), ""):
        raise InvalidValueError(
            "{title} must be one number with a unit of {units}, got {cell}",
            title=title,
            units=", ".join(units) or Message("none"),
            cell=f"{odd[:20]!r}",
        )
    if not factors[0]:
        other = next((word for _, word in _PAIR.findall(beside) if word), "")
        factors[0] = units.get(_unit(other), 0.0) or _named(title, text, factor)
    return sum(_number(title, one, mark, by) * by for (one, _), by in zip(pairs, factors, strict=True))


def _number(title: str, text: str, mark: DecimalMark, by: float) -> float:
    whole, _, part = text.rpartition(" ")
    if "/" not in part:
        return mark.number(title, text)
    above, below = map(int, part.split("/"))
    if not whole and by in {FACTORS["cm"], FACTORS["mm"]}:
        raise _ambiguous(title, text, (f"{above / below:.4g}", f"{above}-{below}"))
    return (mark.number(title, whole) if whole else 0.0) + above / below


def _unit(word: str) -> str:
    return _MARKS.get(word) or UNITS.get(plain(word), word)


def _named(title: str, cell: Cell, factor: float | None) -> float:
    if factor is None:
        raise InvalidValueError(
            "{title} must name its unit, in its header or beside the number, got {cell}",
            title=title,
            cell=f"{cell!r:.40}",
        )
    return factor


_PARTS = re.compile(
    r"\s*[x×✕*;]\s*|\s*,\s+(?=[^\W\d])|\s+(?!(?:[cm]?m|in)\b)(?=[^\W\d]{1,12}\s*[.:=]?\s*(?:[cm]?m\s+)?\d)"
)
_LABEL = re.compile(r"(ø|[^\W\d]+)\s*[.:=]?\s*(?=[~≈(\[]|\d|(?:ca|circa|etwa|[cm]?m)\b)")
_ORDER = re.compile(r"[(\[]?([^\W\d]+(?:\s*[x×✕*/]\s*[^\W\d]+){1,2})[)\]]?\s*$")
_TWICE = re.compile(r"([^()]*\d[^()]*)\(([^()]*\d\s*x[^()]*)\)")


def parts(
    title: str, cell: Cell, order: Sequence[str], factor: float | None, mark: DecimalMark, language: str
) -> dict[str, CellMeasure]:
    """Return the measures of a cell such as ``120 x 80 x 220 cm`` or ``H 120, Ø 30 cm``; order: what its header says.

    >>> found = parts("Maße", "H 120 x B 80 x T 40 cm", (), None, DecimalMark([]), "de")
    >>> {side: one.value for side, one in found.items()}
    {'height': 1.2, 'width': 0.8, 'depth': 0.4}
    """
    text = _tidied(without_thousands(cell if isinstance(cell, str) else f"{cell:.10g}"))
    if (stated := _ORDER.search(text)) and (of_cell := order_of(stated[1], language)):  # 40 x 30 x 120 cm (B x T x H)
        text, order = text[: stated.start()].strip(), of_cell
    text, about = _without_about(text)
    if match := _TWICE.fullmatch(text):
        found, again = (parts(title, each, order, factor, mark, language) for each in match.groups())
        if any(abs(one.value - again[side].value) > _SAME * one.value for side, one in found.items()):
            raise InvalidValueError(_TWO_SIZES, title=title, cell=f"{text[:60]!r}")
        return found
    apart = re.sub(r"(?<=[0-9])\s*/\s*(?=[0-9])", " x ", text) if text.count("/") + 1 == len(order) == 3 else text
    pieces = [piece for piece in _PARTS.split(re.sub(rf"\b({_ABOUT})\b\.? *", "~", apart)) if piece]
    labels = []
    for k, piece in enumerate(pieces):
        label = _LABEL.match(piece)
        side = side_of(plain(label[1]), language) if label else ""
        labels.append("width" if side == "length" in labels else side)  # a longer and a shorter one: L 90, l 40
        pieces[k] = piece[label.end() :] if label and side else piece
    said = set(labels) | ({"width", "depth"} if "diameter" in labels else set())
    left = [side for side in order or ("height",) if side not in said] if order or "diameter" in labels else []
    for k in range(len(labels)):
        if not labels[k] and left:
            labels[k] = left.pop(0)
    if not pieces or "" in labels or len(set(labels)) < len(labels) or (left and "diameter" not in labels):
        hint = (
            Message("its header names {count} parts", {"count": len(order)})
            if order
            else Message(
                "which is the height? Write the order into the header, or say it: columns {example}",
                {"example": f'"{title}=height x width x depth cm"'},
            )
        )
        raise InvalidValueError(
            "{title} must have its parts in a known order, got {cell}", title=title, cell=f"{text[:40]!r}", hint=hint
        )
    units = [[by for _, word in _PAIR.findall(piece) if (by := LENGTH_UNITS.get(_unit(word)))] for piece in pieces]
    found = {}
    for side, piece, own in zip(labels, pieces, units, strict=True):
        if is_missing(piece):
            raise InvalidValueError("{title} is {cell}", title=title, cell=f"{text[:40]!r}")
        one = ("~" if about and not piece.startswith("~") else "") + piece
        found[side] = measure(title, one, None if own else next(iter(units[-1]), factor), mark)
    if "length" in found:
        found["width" if "width" not in found else "depth"] = found.pop("length")
    return found


def count_of(cell: Cell) -> int | None:
    """Return how many a cell says there are, if it does.

    >>> [count_of(cell) for cell in ("2 Stk.", "3x", "3 Paar", 4.0, "-4", "viele")]
    [2, 3, 6, 4, None, None]
    """
    if isinstance(cell, float):
        return int(cell) if cell == int(cell) else None
    words = plain(cell)
    if words in _PAIRS:
        return 2
    match = re.fullmatch(r"x? ?([0-9]{1,7}) ?([^\W\d]*)", words)
    if match is None or re.search(r"\d[.,]\d|^\s*-", cell):
        return None
    return int(match[1]) * (2 if match[2] in _PAIRS else 1)


_PAIRS = words_of(WORDS["pairs"])
