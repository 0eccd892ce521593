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

    ``12,5`` can only be a decimal comma; ``1,234`` could be a thousand. The second is taken only where the first
    stands elsewhere in the table and no decimal point does; ``1.234`` only where no decimal comma stands.

    Parameters
    ----------
    cells : iterable of str
        Every cell that should be a number; others among them say nothing.

    Examples
    --------
    >>> mark = DecimalMark(["12,5", "1,234", "7"])
    >>> mark.number("width_cm", "1,234")
    1.234
    """

    def __init__(self, cells: Iterable[str]) -> None:
        found = set()
        for cell in cells:
            match = _NUMBER.fullmatch(cell.strip())
            if match and match[1] and not _THOUSANDS.fullmatch(cell.strip()):
                found.add(match[1])
        self.commas, self.points = "," in found, "." in found

    def number(self, name: str, cell: str) -> float:
        """Return the number in a cell.

        Parameters
        ----------
        name : str
            Name of the column, for the error.
        cell : str
            What stands in the cell.

        Returns
        -------
        float
            The number, in the unit of the column.

        Raises
        ------
        InvalidValueError
            If it is no number, or could be two.
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
        return self.commas and not self.points if mark == "," else not self.commas
