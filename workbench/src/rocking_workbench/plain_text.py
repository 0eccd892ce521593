"""Safe text from users for files, and plain values as readable TOML."""

import json
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rocking.errors import InvalidValueError

LONGEST_CELL = 2000  # largest length of a text in one cell [characters]
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_STRANGE = re.compile(r"(?:[^A-Za-z0-9._-]|(?<![A-Za-z0-9])\.|\.(?![A-Za-z0-9]))+")
_OURS = ("response.toml", "readme.txt")
_LONGEST_FILE_NAME = 80
_LONGEST_TITLE = 120
_HIDDEN = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_ONE_LINE = 80  # longest list on one line [characters]


def plain_line(text: str, longest: int = 160) -> str:
    r"""Return a text as one line of visible characters.

    The result contains no control characters, direction marks, line breaks and tabs, which can have effects in a
    terminal, an XML file or a comment.

    >>> plain_line("a\n[b]\x1b[31m\u202e")
    'a [b][31m'
    """
    seen = "".join(character for character in text if character.isprintable() or character.isspace())
    line = " ".join(seen.split())
    return line if len(line) <= longest else f"{line[: longest - 3]}..."


def shown(text: str) -> str:
    r"""Return a text of a user as a title: one line of 1 to 120 visible characters.

    >>> shown("a\u202eb\n  c")
    'ab c'
    """
    plain = "".join(" " if mark.isspace() else mark for mark in unicodedata.normalize("NFC", text[:4000]))
    seen = "".join(mark for mark in plain if unicodedata.category(mark) not in _HIDDEN)
    return " ".join(seen.split())[:_LONGEST_TITLE].rstrip() or "study"


def safe_name(name: str, fallback: str = "rocking") -> str:
    """Return a file name that is harmless on every system: ASCII letters, digits, dot, dash and underscore.

    The name has at most 80 characters, and is never hidden, reserved or empty.

    >>> safe_name("../../Vase Nº 3 <b>.csv")
    'Vase-No-3-b.csv'
    >>> safe_name("statue v1.2 report.pdf")
    'statue-v1.2-report.pdf'
    """
    plain = unicodedata.normalize("NFKD", name[:1000]).encode("ascii", "ignore").decode()
    stem, dot, suffix = plain.rpartition(".")
    if not dot or not re.fullmatch(r"[A-Za-z0-9]{1,8}", suffix):
        stem, dot, suffix = plain, "", ""
    stem = _STRANGE.sub("-", stem).strip("-_") or fallback
    stem = f"{fallback}-{stem}" if _RESERVED.fullmatch(stem) else stem
    return stem[: _LONGEST_FILE_NAME - len(suffix) - 1].rstrip(".-_") + dot + suffix


def record_file_name(name: str, otherwise: str = "record.txt") -> str:
    r"""Return a safe name of a record file, without folders, patterns and reserved names.

    >>> record_file_name(r"C:\records\Kobe 1995.AT2"), record_file_name("../../etc/passwd"), record_file_name("CON.txt")
    ('Kobe_1995.AT2', 'passwd', '_CON.txt')
    """
    last = re.split(r"[/\\]", name)[-1]
    safe = re.sub(r"[^A-Za-z0-9._-]+", "_", last).strip("_").lstrip(".-").rstrip(".")
    if len(safe) > _LONGEST_FILE_NAME:
        stem, dot, suffix = safe.rpartition(".")
        tail = dot + suffix[:16] if dot else ""
        safe = (stem or suffix)[: _LONGEST_FILE_NAME - len(tail)] + tail
    if not safe.strip("._-"):
        return otherwise
    return f"_{safe}" if _RESERVED.fullmatch(safe) or safe.lower() in _OURS else safe


def toml_of(document: Mapping[str, Any]) -> str:
    r"""Return tables as TOML, with all digits of numbers and without None."""
    return "\n".join(_lines(document, ())).strip("\n") + "\n"


def toml_value(value: Any) -> str:
    r"""Return one value as TOML in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, Mapping):
        pairs = [f"{_key(key)} = {toml_value(item)}" for key, item in value.items() if item is not None]
        return "{" + ", ".join(pairs) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    raise InvalidValueError("an input file cannot contain {entry!r:.60}", entry=value)


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
            for item in value:
                yield from ("", f"[[{head}]]", *_lines(item, inside))


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping)


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(item, Mapping) for item in value)


def _value(value: Any) -> str:
    text = toml_value(value)
    if len(text) <= _ONE_LINE or not isinstance(value, (list, tuple)):
        return text
    return "[\n" + "".join(f"  {toml_value(item)},\n" for item in value) + "]"


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else _quoted(key)


def _quoted(text: str) -> str:
    # invisible characters are escaped, so that all characters of the file are visible
    marks = json.dumps(text, ensure_ascii=False)
    return "".join(mark if mark == " " or mark.isprintable() else _code(ord(mark)) for mark in marks)


def _code(number: int) -> str:
    return f"\\u{number:04x}" if number < 1 << 16 else f"\\U{number:08x}"
