"""Numbers as people type them: a point or a comma before the decimals, never both, never guessed."""

import re
from collections.abc import Iterable

from rocking import checks
from rocking.errors import InvalidValueError

_NUMBER = re.compile(r"[+-]?[0-9]+(?:([.,])([0-9]+))?(?:[eE][+-]?[0-9]+)?")
# three digits after the mark could be thousands, unless what is before cannot be
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}[.,][0-9]{3}")


class DecimalMark:
    """What separates the decimals in a table, found in all of its numbers together.

    ``12,5`` can only be a decimal comma; ``1,234`` could be a thousand, and so could ``1.234``. Either is taken only
    where the same mark stands for decimals elsewhere in the table and the other does not. Where commas part the fields,
    decimals have points, and ``1.234`` is taken unless a decimal comma contradicts it.

    >>> mark = DecimalMark(["12,5", "1,234", "7"])
    >>> mark.number("width_cm", "1,234")
    1.234
    """

    def __init__(self, cells: Iterable[str], *, comma_delimited: bool = False) -> None:
        found = set()
        for cell in cells:
            match = _NUMBER.fullmatch(cell.strip())
            if match and match[1] and not _THOUSANDS.fullmatch(cell.strip()):
                found.add(match[1])
        self.commas, self.points, self.comma_delimited = "," in found, "." in found, comma_delimited

    def number(self, name: str, cell: str) -> float:
        """Return the number in a cell.

        Returns the number, in the unit of the column.
        """
        text = cell.strip()
        match = _NUMBER.fullmatch(text)
        if not match:
            raise InvalidValueError(
                f"{name} must be one number such as 12.5, without unit and without separators of thousands, "
                f"got {text[:40]!r}"
            )
        if _THOUSANDS.fullmatch(text) and not self._settled(match[1]):
            digits = text.replace(match[1], "")
            decimal = text.replace(",", ".")
            raise InvalidValueError(
                f"{name} is ambiguous: {text!r} could be {decimal} or {digits}; write {decimal}0 or {digits}"
            )
        return checks.number(name, float(text.replace(",", ".")))

    def _settled(self, mark: str) -> bool:
        if mark == ",":
            return self.commas and not self.points
        return not self.commas and (self.points or self.comma_delimited)
