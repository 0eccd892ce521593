"""TOML as it may arrive: not long, not deep, with no number or text that JSON could not carry."""

import tomllib
from typing import Any

from rocking.app.problems import Refused

LONGEST = 4 << 20
"""Bytes of a TOML file that is read."""

_DEEPEST = 32
_LARGEST = 2**63


def parsed_toml(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text that somebody sent.

    Returns its tables; every whole number fits into 64 bits, so that it can be told again.
    """
    if len(text) > LONGEST:
        raise Refused(f"a TOML file may have up to {LONGEST >> 20} MiB, this has {len(text) / 2**20:.1f}")
    try:
        tables = tomllib.loads(text.removeprefix("\ufeff"))
    except tomllib.TOMLDecodeError as error:
        raise Refused(f"this is not TOML that can be read: {' '.join(str(error).split())[:200]}") from error
    except (ValueError, RecursionError) as error:
        raise Refused("this is not TOML that can be read: nested too deeply, or a number is too long") from error
    _check_values(tables)
    return tables


def _check_values(tables: dict[str, Any]) -> None:
    level: list[Any] = [tables]
    for _ in range(_DEEPEST):
        for each in level:
            _check_value(each)
        level = [item for each in level for item in _inside(each)]
        if not level:
            return
    raise Refused(f"the TOML is nested deeper than {_DEEPEST}")


def _check_value(value: Any) -> None:
    if type(value) is int and not -_LARGEST <= value < _LARGEST:  # not written out: that itself may be refused
        raise Refused(f"a whole number of {value.bit_length()} bits in the TOML does not fit into 64 bits")
    words = value if isinstance(value, dict) else (value,) if isinstance(value, str) else ()
    if any("\0" in word for word in words):
        raise Refused("a text in the TOML holds a NUL")


def _inside(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return list(value.values())
    return value if isinstance(value, list) else []
