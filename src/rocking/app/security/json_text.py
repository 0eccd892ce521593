"""JSON as it may arrive: UTF-8, not deep, no key twice, no NaN, nothing that is no number of this machine."""

import json
import math
import re
from typing import Any, NoReturn

from rocking.app.problems import Refused

_BRACKETS = re.compile(rb'"(?:[^"\\]|\\.)*"|[\[\]{}]', re.DOTALL)
_LARGEST = 2**63


def check_json(data: bytes, depth: int) -> None:
    """Refuse a text that is not plain JSON."""
    if not data.strip():
        return
    _check_depth(data, depth)
    try:
        text = data.decode("utf-8")
        json.loads(text, parse_constant=_constant, parse_float=_float, parse_int=_int, object_pairs_hook=_object)
    except UnicodeDecodeError as error:
        raise Refused("the JSON is not in UTF-8") from error
    except json.JSONDecodeError as error:
        raise Refused(f"this is not JSON: {error.msg} at line {error.lineno}, column {error.colno}") from error
    lower = text.lower()
    if "\\u0000" in lower or "\0" in text:
        raise Refused("a text in the JSON holds a NUL")
    if "\\ud" in lower:
        _check_characters(text)


def _check_depth(data: bytes, most: int) -> None:
    depth = 0
    for match in _BRACKETS.finditer(data):
        mark = match[0]
        depth += (mark in b"[{") - (mark in b"]}")
        if depth > most:
            raise Refused(f"the JSON is nested deeper than {most}")


def _check_characters(text: str) -> None:
    try:
        json.dumps(json.loads(text), ensure_ascii=False).encode("utf-8")
    except UnicodeEncodeError as error:
        raise Refused("a text in the JSON holds half a character (a lone surrogate)") from error


def _constant(word: str) -> NoReturn:
    raise Refused(f"{word} is not a number that can be computed with")


def _float(word: str) -> float:
    value = float(word)
    if not math.isfinite(value):
        raise Refused(f"the number {word[:40]} is larger than float64 holds")
    return value


def _int(word: str) -> int:
    if len(word) > 20 or not -_LARGEST <= int(word) < _LARGEST:
        raise Refused(f"the whole number {word[:40]} does not fit into 64 bits")
    return int(word)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) != len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise Refused(f"the key {twice[:60]!r} is there twice")
    return content
