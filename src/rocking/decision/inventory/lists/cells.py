"""Read cells of a list: measures with units, approximate values and intervals, and measures of several sizes."""

# ruff: noqa: RUF001 - signs and words of other alphabets are intended

import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from rocking import checks
from rocking.conventions import LENGTH_UNITS
from rocking.decision.inventory.lists.columns import FACTORS, UNITS, WORDS, order_of, plain, side_of, words_of
from rocking.decision.inventory.lists.sheets import Cell, Shown
from rocking.errors import InvalidValueError
from rocking.messages import Message

ABOUT = 0.05
"""Half width of the interval of an approximate measure, such as "ca. 120" or "120?", divided by the measure [-]."""

_NUMBER = re.compile(r"[+-]?[0-9]+(?:([.,])([0-9]+))?(?:[eE][+-]?[0-9]+)?")
# three digits after a mark can be thousands, unless the digits before the mark exclude thousands
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}[.,][0-9]{3}")
# separators that are certainly for thousands: blanks, apostrophes, one mark twice, or two different marks
_GROUPED = re.compile(
    r"(?<![0-9.,'])(?:[1-9](?: [0-9]{3})+(?:[.,][0-9]+)?"
    r"|[1-9][0-9]{0,2}(?:(?:[\u00a0\u202f\u2009'\u2019][0-9]{3})+(?:[.,][0-9]+)?"
    r"|(?:\.[0-9]{3}){2,}(?:,[0-9]+)?|(?:,[0-9]{3}){2,}(?:\.[0-9]+)?|\.[0-9]{3},[0-9]+|,[0-9]{3}\.[0-9]+))"
    r"(?![0-9.,'\"])"
)


def without_thousands(text: str) -> str:
    """Return a text without unambiguous separators of thousands.

    >>> [without_thousands(text) for text in ("1.234,5", "2 350 mm", "1.234", "4' 6")]
    ['1234,5', '2350 mm', '1.234', "4' 6"]
    """
    return _GROUPED.sub(lambda match: _ungrouped(match[0]), text)


def _ungrouped(number: str) -> str:
    last = re.search(r"[.,][0-9]+$", number)
    mark = last[0] if last and number.count(last[0][0]) == 1 else ""
    return re.sub(r"[^0-9]", "", number.removesuffix(mark)) + mark


class DecimalMark:
    """The decimal mark of a table, from all of its numbers.

    ``12,5`` has a decimal comma; ``1,234`` and ``1.234`` are ambiguous. Their mark separates decimals if another
    number of the table has this decimal mark, and no number has the other decimal mark. Their mark separates
    thousands if it does in a number such as ``1.234,5``, or if the other numbers of the column have a similar size.
    If commas separate the fields, the decimal mark is a point, unless a number has a decimal comma.

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
        self.columns = columns or {}  # texts of the columns, by title

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
        """Return True if the mark separates thousands, and only the other numbers of the column prove this."""
        text = cell.strip()
        mark = re.sub(r"[0-9+-]", "", text)
        by_table = mark in self.groups or self._separates_decimals(mark)
        return bool(_THOUSANDS.fullmatch(text)) and not by_table and self._settles(name, text)

    def _separates_decimals(self, mark: str) -> bool:
        """Return True if the other numbers of the table prove that a mark separates decimals."""
        if mark == ",":
            return self.commas and not self.points
        return not self.commas and (self.points or self.comma_delimited)

    def _settles(self, name: str, text: str) -> bool:
        """Return True if the other numbers of a column are near the value with thousands and far from the decimals."""
        others = [
            float(cell.replace(",", "."))
            for cell in self.columns.get(name, ()) if _NUMBER.fullmatch(cell) and not _THOUSANDS.fullmatch(cell)
        ]  # fmt: skip
        decimal = float(text.replace(",", "."))
        return len(others) >= _ENOUGH and all(
            1.0 / _NEAR < 1000.0 * decimal / other < _NEAR and other > _NEAR * decimal for other in others if other
        )


def _ambiguous(title: str, text: str, readings: tuple[str, str], first: str = "") -> InvalidValueError:
    return InvalidValueError(
        "{title} is ambiguous: {cell} could be {one} or {other}. Write {clear} or {other}.",
        title=title,
        cell=repr(text),
        one=readings[0],
        other=readings[1],
        clear=first or readings[0],
    )


_ENOUGH, _NEAR = 3, 30.0  # smallest number of other numbers in a column for a decision, and their largest ratio [-]
_LONGEST = 200
_SAME = 0.02  # largest relative difference between rounded values in centimetres and in inches [-]
_OTHERWISE = 0.5  # largest relative difference of two alternative sizes [-]
_ABOUT = "|".join(sorted(words_of(WORDS["about"]), key=len, reverse=True))
_WITH = "|".join(words_of(WORDS["with"]))
_UNKNOWN = words_of(WORDS["unknown"])
_FRACTION = r"[0-9]{1,2}/(?:2|3|4|8|16|32|64)(?![0-9])"  # fractions of inches; 120/130 is not a fraction
_ONE = rf"{_FRACTION}|[0-9]+(?:[.,][0-9]+)?(?: {_FRACTION})?"
_UNIT = rf"(?:(?!(?:{_WITH})\b)[^\W\d]{{1,15}}\.?|['\"])"
_QUANTITY = rf"(?:{_ONE})\s*(?:{_UNIT}\s*(?:(?:{_ONE})\s*{_UNIT})?)?"
_ABOUT_FIRST = re.compile(rf"(?:~|≈|±|(?:{_ABOUT})(?=[\s.0-9])\.?)\s*(?=\S)")
_BETWEEN = re.compile(rf"({_QUANTITY})\s*(-|–|—|/|bis|to|until|a|hasta|εως|至|~)\s*({_QUANTITY})")
_BESIDE = re.compile(rf"({_QUANTITY})\s*\(=?\s*({_QUANTITY})[^\d()]*\)")
_IN_BRACKETS = re.compile(rf"[(\[]([^()\[\]]*\d[^()\[\]]*)[)\]]\s*({_UNIT})?")
# "foot" before a number means the foot of the object, and "in" is a word
_UNIT_FIRST = re.compile(r"(mm|cm|m|kg|g|lbs?)\.?\s*(\D{0,20}\d.*)")
_DOUBT = re.compile(rf"\s*(?:\?+|[(\[][^\d()\[\]]*[)\]]|\b(?:ca|circa|approx)\.?|\b(?:{_WITH})\b[^\d()]*)$")
_GIVE_OR_TAKE = re.compile(rf"({_QUANTITY})\s*(?:±|\+ ?/ ?-|\+-)\s*({_QUANTITY})")
_PAIR = re.compile(rf"({_ONE})\s*([^\W\d]{{1,15}}|['\"])?\.?\s*")
_MARKS = {"'": "ft", '"': "in"}
_TWO_SIZES = "{title} contains two different sizes, got {cell}"
_DATE = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}.*|[0-9]{2}:[0-9]{2}.*")


@dataclass(frozen=True)
class CellMeasure:
    """Measure in a cell, in SI units."""

    value: float
    half_width: float = 0.0  # half width of the interval of an approximate measure
    across: bool = False  # True for a diameter


def is_missing(cell: Cell) -> bool:
    """Return True if a cell is empty or contains a word for an unknown value.

    >>> [is_missing(cell) for cell in ("?", "k. A.", "#REF!", "unbekannt", "120?")]
    [True, True, True, True, False]
    """
    return isinstance(cell, str) and (cell.startswith("#") or not cell.strip(" ?-–—./…") or plain(cell) in _UNKNOWN)


def measure(
    title: str, cell: Cell, factor: float | None, mark: DecimalMark, units: Mapping[str, float] = LENGTH_UNITS
) -> CellMeasure:
    """Return the measure in a cell; `factor` is the SI factor of numbers without a unit, or None."""
    if isinstance(cell, Shown):
        unit_measure = measure(title, cell.unity, factor, mark, units)
        return CellMeasure(cell * unit_measure.value, cell * unit_measure.half_width, unit_measure.across)
    if isinstance(cell, float):
        return CellMeasure(checks.number(title, cell) * _named(title, cell, factor))
    if _NUMBER.fullmatch(cell.strip()):
        return CellMeasure(mark.number(title, cell) * _named(title, cell, factor))

    def quantity(text: str, neighbour: str = "") -> float:
        return _quantity(title, text, factor, mark, units, neighbour)

    text = _tidied(without_thousands(cell))
    across = text.startswith(("ø", "dm "))
    text, about = _without_about(re.sub(r"^(?:ø|dm )\s*", "", text))
    if match := _GIVE_OR_TAKE.fullmatch(text):
        return CellMeasure(quantity(match[1], match[2]), quantity(match[2]), across)
    two = _two(title, text, quantity)
    value, half = (quantity(text), 0.0) if two is None else (0.5 * (two[1] + two[0]), 0.5 * (two[1] - two[0]))
    return CellMeasure(value, half or (ABOUT * value if about else 0.0), across)


def _two(title: str, text: str, quantity: Callable[[str, str], float]) -> tuple[float, float] | None:
    """Return the smaller and the larger of two measures in a text; if they agree, the first measure twice."""
    if (match := _BETWEEN.fullmatch(text)) and not (match[2] == "/" and re.match(_FRACTION, text)):
        low, high = quantity(match[1], match[3]), quantity(match[3], "")
        if match[2] == "/" and low > high > 0.0:  # measures of front and back, in any order
            low, high = high, low
        if not low < high:
            raise InvalidValueError(
                "{title} must go from the smaller to the larger, got {cell}", title=title, cell=f"{text!r:.40}"
            )
        return low, high
    if match := _BESIDE.fullmatch(text):  # size in two units, or two alternative sizes
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
    """Return a measure without words for an approximate value, and a flag for such words."""
    plain_text = "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))
    match = _ABOUT_FIRST.match(plain_text)
    bare = _DOUBT.sub("", plain_text[match.end() :] if match else plain_text)
    bare = _IN_BRACKETS.sub(r"\1 \2", bare).strip() if _IN_BRACKETS.fullmatch(bare) else bare.strip()
    if bare != plain_text:
        return _without_about(bare)[0], True
    match = _UNIT_FIRST.fullmatch(plain_text)
    if match:
        return _without_about(f"{match[2]} {match[1]}")
    return plain_text, False


def _quantity(
    title: str, text: str, factor: float | None, mark: DecimalMark, units: Mapping[str, float], neighbour: str
) -> float:
    """Return a number with its unit, or feet with inches; `neighbour` contains the unit of a number without unit."""
    pairs = _PAIR.findall(text) if re.fullmatch(_QUANTITY, text) else []
    factors = [units.get(_unit(word), 0.0) for _, word in pairs]
    if not pairs or (
        len(pairs) > 1 and (sorted(set(factors), reverse=True) != factors or len(pairs) > 2 or 0.0 in factors)
    ):
        date = Message("The cell contains a date. Format the column as numbers.")
        raise InvalidValueError(
            "{title} must be one number such as 12.5, 120 cm, ca. 120 or 120-130, without separators of thousands, "
            "got {cell}",
            title=title,
            cell=f"{text[:40]!r}",
            hint=date if _DATE.fullmatch(text) else "",
        )
    if odd := next(
        (word for (_, word), number_factor in zip(pairs, factors, strict=True) if word and not number_factor), ""
    ):
        raise InvalidValueError(
            "{title} must be one number with a unit of {units}, got {cell}",
            title=title,
            units=", ".join(units) or Message("none"),
            cell=f"{odd[:20]!r}",
        )
    if not factors[0]:
        other = next((word for _, word in _PAIR.findall(neighbour) if word), "")
        factors[0] = units.get(_unit(other), 0.0) or _named(title, text, factor)
    return sum(
        _number(title, number_factor, mark, by) * by for (number_factor, _), by in zip(pairs, factors, strict=True)
    )


def _number(title: str, text: str, mark: DecimalMark, by: float) -> float:
    integer, _, fraction = text.rpartition(" ")
    if "/" not in fraction:
        return mark.number(title, text)
    above, below = map(int, fraction.split("/"))
    if not integer and by in {FACTORS["cm"], FACTORS["mm"]}:
        raise _ambiguous(title, text, (f"{above / below:.4g}", f"{above}-{below}"))
    return (mark.number(title, integer) if integer else 0.0) + above / below


def _unit(word: str) -> str:
    return _MARKS.get(word) or UNITS.get(plain(word), word)


def _named(title: str, cell: Cell, factor: float | None) -> float:
    if factor is None:
        raise InvalidValueError(
            "{title} must state its unit, in its header or after the number, got {cell}",
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
    """Return the measures of a cell such as ``120 x 80 x 220 cm`` or ``H 120, Ø 30 cm``; `order` is from its header.

    >>> sizes = parts("Maße", "H 120 x B 80 x T 40 cm", (), None, DecimalMark([]), "de")
    >>> {side: size.value for side, size in sizes.items()}
    {'height': 1.2, 'width': 0.8, 'depth': 0.4}
    """
    text = _tidied(without_thousands(cell if isinstance(cell, str) else f"{cell:.10g}"))
    if (stated := _ORDER.search(text)) and (of_cell := order_of(stated[1], language)):  # 40 x 30 x 120 cm (B x T x H)
        text, order = text[: stated.start()].strip(), of_cell
    text, about = _without_about(text)
    if match := _TWICE.fullmatch(text):
        sizes, repeated = (parts(title, piece, order, factor, mark, language) for piece in match.groups())
        if any(abs(size.value - repeated[side].value) > _SAME * size.value for side, size in sizes.items()):
            raise InvalidValueError(_TWO_SIZES, title=title, cell=f"{text[:60]!r}")
        return sizes
    separated = re.sub(r"(?<=[0-9])\s*/\s*(?=[0-9])", " x ", text) if text.count("/") + 1 == len(order) == 3 else text
    pieces = [piece for piece in _PARTS.split(re.sub(rf"\b({_ABOUT})\b\.? *", "~", separated)) if piece]
    labels = []
    for k, piece in enumerate(pieces):
        label = _LABEL.match(piece)
        side = side_of(plain(label[1]), language) if label else ""
        labels.append("width" if side == "length" in labels else side)  # two lengths: L 90, l 40
        pieces[k] = piece[label.end() :] if label and side else piece
    labelled = set(labels) | ({"width", "depth"} if "diameter" in labels else set())
    left = [side for side in order or ("height",) if side not in labelled] if order or "diameter" in labels else []
    for k in range(len(labels)):
        if not labels[k] and left:
            labels[k] = left.pop(0)
    if not pieces or "" in labels or len(set(labels)) < len(labels) or (left and "diameter" not in labels):
        hint = (
            Message("The header has {count} sizes.", {"count": len(order)})
            if order
            else Message(
                "Add the order of the sizes to the header, or use columns {example}.",
                {"example": f'"{title}=height x width x depth cm"'},
            )
        )
        raise InvalidValueError(
            "The order of the sizes in {title} is not stated, got {cell}", title=title, cell=f"{text[:40]!r}", hint=hint
        )
    units = [[by for _, word in _PAIR.findall(piece) if (by := LENGTH_UNITS.get(_unit(word)))] for piece in pieces]
    measures = {}
    for side, piece, own in zip(labels, pieces, units, strict=True):
        if is_missing(piece):
            raise InvalidValueError("{title} is {cell}", title=title, cell=f"{text[:40]!r}")
        text_of_side = ("~" if about and not piece.startswith("~") else "") + piece
        measures[side] = measure(title, text_of_side, None if own else next(iter(units[-1]), factor), mark)
    if "length" in measures:
        measures["width" if "width" not in measures else "depth"] = measures.pop("length")
    return measures


def count_of(cell: Cell) -> int | None:
    """Return the number of pieces in a cell, or None.

    >>> [count_of(cell) for cell in ("2 Stk.", "3x", "3 Paar", 4.0, "-4", "viele")]
    [2, 3, 6, 4, None, None]
    """
    if isinstance(cell, float):
        return int(cell) if cell == int(cell) else None
    text = plain(cell)
    if text in _PAIRS:
        return 2
    match = re.fullmatch(r"x? ?([0-9]{1,7}) ?([^\W\d]*)", text)
    if match is None or re.search(r"\d[.,]\d|^\s*-", cell):
        return None
    return int(match[1]) * (2 if match[2] in _PAIRS else 1)


_PAIRS = words_of(WORDS["pairs"])
