"""Plain values as TOML that people read: tables with their own head, long lists one item a line."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rocking.errors import InvalidValueError

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_SHORT = {"\b": r"\b", "\t": r"\t", "\n": r"\n", "\f": r"\f", "\r": r"\r", '"': r"\"", "\\": r"\\"}
_ONE_LINE = 80
"""Longest list that stands in one line [characters]."""


def toml_of(document: Mapping[str, Any]) -> str:
    r"""Return tables as TOML; numbers keep every digit, and what is None is left out.

    >>> print(toml_of({"body": {"units": "m", "block": {"width": 0.5}}}), end="")
    [body]
    units = "m"
    <BLANKLINE>
    [body.block]
    width = 0.5
    """
    return "\n".join(_lines(document, ())).strip("\n") + "\n"


def toml_value(value: Any) -> str:
    r"""Return one value as TOML in one line.

    >>> toml_value([0.1, True, 'a "b"\x00'])
    '[0.1, true, "a \\"b\\"\\u0000"]'
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, Mapping):
        pairs = [f"{_key(key)} = {toml_value(one)}" for key, one in value.items() if one is not None]
        return "{" + ", ".join(pairs) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml_value(one) for one in value) + "]"
    raise InvalidValueError(f"a file of inputs has no place for {value!r:.60}")


def _lines(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    present = {key: value for key, value in table.items() if value is not None}
    for key, value in present.items():
        if not _is_table(value) and not _is_tables(value):
            yield f"{_key(key)} = {_value(value)}"
    for key, value in present.items():
        inside = (*path, key)
        head = ".".join(map(_key, inside))
        if _is_table(value):
            yield from ("", f"[{head}]", *_lines(value, inside))
        elif _is_tables(value):
            for one in value:
                yield from ("", f"[[{head}]]", *_lines(one, inside))


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping)


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(one, Mapping) for one in value)


def _value(value: Any) -> str:
    words = toml_value(value)
    if len(words) <= _ONE_LINE or not isinstance(value, (list, tuple)):
        return words
    return "[\n" + "".join(f"  {toml_value(one)},\n" for one in value) + "]"


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else _quoted(key)


def _quoted(text: str) -> str:
    return '"' + "".join(map(_escaped, text)) + '"'


def _escaped(character: str) -> str:
    if character in _SHORT:
        return _SHORT[character]
    # what cannot be seen is spelled out: a reader of the file shall see all that stands in it
    if character == " " or character.isprintable():
        return character
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"
