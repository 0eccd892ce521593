"""Lines of numbers and of text, for writers."""

from collections.abc import Sequence

from rocking.conventions import FloatArray
from rocking.errors import RecordError


def in_columns(values: Sequence[float] | FloatArray, per_line: int, form: str) -> list[str]:
    """Return lines of numbers, for writers."""
    words = [form.format(value) for value in values]
    return ["".join(words[start : start + per_line]) for start in range(0, len(words), per_line)]


def in_width(values: Sequence[float] | FloatArray, per_line: int, width: int, decimals: int) -> list[str]:
    """Return lines of numbers in columns of fixed width, for writers.

    >>> in_width([1.0, -2.5, 3.0], 2, 6, 2)
    ['  1.00 -2.50', '  3.00']
    """
    lines = in_columns(values, per_line, f"{{:{width}.{decimals}f}}")
    full = [per_line] * (len(lines) - 1) + [len(values) - per_line * (len(lines) - 1)]
    for text, count in zip(lines, full, strict=True):
        if len(text) != count * width:
            raise RecordError(f"a number does not fit into {width} characters with {decimals} decimals; wrong unit?")
    return lines


def one_line(text: object, width: int) -> str:
    r"""Return text that fits on one line of a header, for writers.

    Returns Latin-1 characters without line ends; others become question marks.

    >>> one_line("El Centro\r\n 1940", 12)
    'El Centro 19'
    """
    plain = " ".join(str(text).split()).encode("latin-1", "replace").decode("latin-1")
    return "".join(mark if mark.isprintable() else "?" for mark in plain)[:width].strip()
