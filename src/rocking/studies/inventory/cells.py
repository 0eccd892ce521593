"""Measures in cells: a number with or without its unit, about or between two, or none; and one of several parts."""

# ruff: noqa: RUF001 - signs and words of other alphabets are meant

import re
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.studies.inventory import header_words
from rocking.studies.inventory.columns import FACTORS, UNITS, plain, side_of, words_of
from rocking.studies.inventory.sheets import Cell

ABOUT = 0.05
"""Half the interval of a measure that is said to be about right, "ca. 120" or "120?", as a share of it [-]."""

_NUMBER = re.compile(r"[+-]?[0-9]+(?:([.,])([0-9]+))?(?:[eE][+-]?[0-9]+)?")
# three digits after the mark could be thousands, unless what is before cannot be
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}[.,][0-9]{3}")


class DecimalMark:
    """What separates the decimals in a table, found in all of its numbers together.

    ``12,5`` can only be a decimal comma; ``1,234`` could be a thousand, and so could ``1.234``. Either is taken only
    where the same mark stands for decimals elsewhere in the table and the other does not. Where commas part the fields,
    decimals have points, and ``1.234`` is taken unless a decimal comma contradicts it.

    >>> mark = DecimalMark(["12,5", "1,234", "7 cm"])
    >>> mark.number("width_cm", "1,234")
    1.234
    """

    def __init__(self, cells: Iterable[str], *, comma_delimited: bool = False) -> None:
        marks = set()
        for cell in cells:
            for match in _NUMBER.finditer(cell[:_LONGEST]):
                if match[1] and not _THOUSANDS.fullmatch(match[0]):
                    marks.add(match[1])
        self.commas, self.points, self.comma_delimited = "," in marks, "." in marks, comma_delimited

    def number(self, name: str, cell: str) -> float:
        """Return the number in a cell, in the unit of the column."""
        text = cell.strip()
        match = _NUMBER.fullmatch(text)
        if not match:
            raise InvalidValueError(
                f"{name} must be one number such as 12.5, without unit and without separators of thousands, "
                f"got {text[:40]!r}"
            )
        settled = (
            self.commas and not self.points
            if match[1] == ","
            else not self.commas and (self.points or self.comma_delimited)
        )
        if _THOUSANDS.fullmatch(text) and not settled:
            digits = text.replace(match[1], "")
            decimal = text.replace(",", ".")
            raise InvalidValueError(
                f"{name} is ambiguous: {text!r} could be {decimal} or {digits}; write {decimal}0 or {digits}"
            )
        return checks.number(name, float(text.replace(",", ".")))


_LONGEST = 200
_ABOUT = "|".join(sorted(words_of(header_words.ABOUT), key=len, reverse=True))
_UNKNOWN = words_of(header_words.UNKNOWN)
_ONE = r"[0-9]+(?:[.,][0-9]+)?(?: [0-9]{1,3}/[0-9]{1,3})?|[0-9]{1,3}/[0-9]{1,3}"
_UNIT = r"(?:[^\W\d]{1,15}\.?|['\"])"
_QUANTITY = rf"(?:{_ONE})\s*(?:{_UNIT}\s*(?:(?:{_ONE})\s*{_UNIT})?)?"
_ABOUT_FIRST = re.compile(rf"(?:~|≈|±|(?:{_ABOUT})(?=[\s.0-9])\.?)\s*(?=\S)")
_BETWEEN = re.compile(rf"({_QUANTITY})\s*(?:-|–|—|bis|to|until|hasta|εως|至|~)\s*({_QUANTITY})")
_GIVE_OR_TAKE = re.compile(rf"({_QUANTITY})\s*(?:±|\+ ?/ ?-|\+-)\s*({_QUANTITY})")
_PAIR = re.compile(rf"({_ONE})\s*([^\W\d]{{1,15}}|['\"])?\.?\s*")
_MARKS = {"'": "ft", '"': "in"}
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


def measure(title: str, cell: Cell, factor: float | None, mark: DecimalMark) -> CellMeasure:
    """Return what a cell measures; factor: of numbers without a unit, if that is known."""
    if isinstance(cell, float):
        return CellMeasure(checks.number(title, cell) * _named(title, cell, factor))
    if _NUMBER.fullmatch(cell.strip()):
        return CellMeasure(mark.number(title, cell) * _named(title, cell, factor))
    text = _tidied(cell)
    across = text.startswith(("ø", "dm "))
    text = re.sub(r"^(?:ø|dm )\s*", "", text)
    text, about = _without_about(text)
    if match := _GIVE_OR_TAKE.fullmatch(text):
        half = _quantity(title, match[2], factor, mark)
        return CellMeasure(_quantity(title, match[1], factor, mark, match[2]), half, across)
    if match := _BETWEEN.fullmatch(text):
        low, high = _quantity(title, match[1], factor, mark, match[2]), _quantity(title, match[2], factor, mark)
        if not low < high:
            raise InvalidValueError(f"{title} must go from the smaller to the larger, got {cell!r:.40}")
        return CellMeasure(0.5 * (low + high), 0.5 * (high - low), across)
    value = _quantity(title, text, factor, mark)
    return CellMeasure(value, ABOUT * value if about else 0.0, across)


def _tidied(cell: str) -> str:
    text = re.sub(r"(?<=\d)?([¼½¾⅓⅔⅛⅜⅝⅞])", r" \1", cell[:_LONGEST])
    text = unicodedata.normalize("NFKC", text.lower()).replace("⁄", "/").replace("⌀", "ø")
    for odd, usual in (("''", '"'), ("″", '"'), ("”", '"'), ("“", '"'), ("′", "'"), ("’", "'")):
        text = text.replace(odd, usual)
    return " ".join(text.split())


def _without_about(text: str) -> tuple[str, bool]:
    unaccented = "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))
    match = _ABOUT_FIRST.match(unaccented)
    bare = re.sub(r"\s*\(?(?:\?+|ca\.?|circa|approx\.?)\)?$", "", unaccented[match.end() :] if match else unaccented)
    return bare.strip(), bool(match) or bare != unaccented


def _quantity(title: str, text: str, factor: float | None, mark: DecimalMark, beside: str = "") -> float:
    """Return a number with its unit, or feet with inches; beside: where the unit of one without may stand."""
    pairs = _PAIR.findall(text) if re.fullmatch(_QUANTITY, text) else []
    units = [_MARKS.get(word) or UNITS.get(plain(word), word) for _, word in pairs]
    factors = [FACTORS.get(unit, 0.0) for unit in units]
    if not pairs or (
        len(pairs) > 1 and (sorted(set(factors), reverse=True) != factors or len(pairs) > 2 or 0.0 in factors)
    ):
        hint = "; a date, which a spreadsheet made of a number?" if _DATE.fullmatch(text) else ""
        raise InvalidValueError(
            f"{title} must be one number such as 12.5, 120 cm, ca. 120 or 120-130, without separators of thousands, "
            f"got {text[:40]!r}{hint}"
        )
    if odd := next((unit for unit, one in zip(units, factors, strict=True) if unit and not one), ""):
        raise InvalidValueError(f"{title} must be one number with a unit of {', '.join(FACTORS)}, got {odd[:20]!r}")
    if not units[0] and (other := next((word for _, word in _PAIR.findall(beside) if word), "")):
        factors[0] = FACTORS.get(_MARKS.get(other) or UNITS.get(plain(other), ""), 0.0) or _named(title, text, factor)
    elif not units[0]:
        factors[0] = _named(title, text, factor)
    return sum(_number(title, one, mark) * by for (one, _), by in zip(pairs, factors, strict=True))


def _number(title: str, text: str, mark: DecimalMark) -> float:
    whole, _, part = text.rpartition(" ")
    if "/" not in part:
        return mark.number(title, text)
    above, below = part.split("/")
    if int(below) == 0:
        raise InvalidValueError(f"{title} must be one number, got {text[:40]!r}")
    return (mark.number(title, whole) if whole else 0.0) + int(above) / int(below)


def _named(title: str, cell: Cell, factor: float | None) -> float:
    if factor is None:
        raise InvalidValueError(f"{title} must name its unit, in its header or beside the number, got {cell!r:.40}")
    return factor


_PARTS = re.compile(r"\s*[x×✕*;]\s*|\s*,\s+(?=[^\W\d])|\s+(?=[^\W\d]{1,12}\s*[.:=]?\s*\d)")
_LABEL = re.compile(r"(ø|[^\W\d]+)\s*[.:=]?\s*(?=[~≈]|\d|(?:ca|circa|etwa)\b)")


def parts(
    title: str, cell: Cell, order: Sequence[str], factor: float | None, mark: DecimalMark, language: str
) -> dict[str, CellMeasure]:
    """Return the measures of a cell such as ``120 x 80 x 220 cm`` or ``H 120, Ø 30 cm``; order: what its header says.

    >>> found = parts("Maße", "H 120 x B 80 x T 40 cm", (), None, DecimalMark([]), "de")
    >>> {side: one.value for side, one in found.items()}
    {'height': 1.2, 'width': 0.8, 'depth': 0.4}
    """
    text, about = _without_about(_tidied(str(cell)))
    pieces = [piece for piece in _PARTS.split(re.sub(rf"\b({_ABOUT})\b\.? *", "~", text)) if piece]
    labels = []
    for k, piece in enumerate(pieces):
        label = _LABEL.match(piece)
        side = side_of(plain(label[1]), language) if label else ""
        labels.append(side)
        pieces[k] = piece[label.end() :] if label and side else piece
    left = [side for side in order if side not in labels]
    if "diameter" in labels:
        left = [side for side in left if side not in {"width", "depth"}] or ["height"]
    for k in range(len(labels)):
        if not labels[k] and left:
            labels[k] = left.pop(0)
    if not pieces or "" in labels or len(set(labels)) < len(labels) or left:
        why = (
            f"its header names {len(order)} parts" if order
            else "which is the height? Write the order into the header, or say it: columns "
            f'"{title}=height x width x depth cm"'
        )  # fmt: skip
        raise InvalidValueError(f"{title} must have its parts in a known order, got {text[:40]!r}; {why}")
    last = _PAIR.findall(pieces[-1].lstrip("~"))
    unit = next((word for _, word in reversed(last) if word), "")
    found = {}
    for side, piece in zip(labels, pieces, strict=True):
        own = any(word for _, word in _PAIR.findall(piece.lstrip("~")))
        said = ("~" if about and not piece.startswith("~") else "") + (piece if own or not unit else f"{piece} {unit}")
        found[side] = measure(title, said, factor, mark)
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


_PAIRS = words_of(header_words.PAIRS)
