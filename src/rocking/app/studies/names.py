"""Names of studies and of files in them: words that users gave, made harmless before anybody sees or opens them."""

import re
import secrets
import unicodedata

_ID = re.compile(r"[0-9a-f]{16}\Z")
_LONGEST = 120
_HIDDEN = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}
_RESERVED = {"con", "prn", "aux", "nul", *(f"{kind}{k}" for kind in ("com", "lpt") for k in range(10))}


def new_id() -> str:
    """Return the name of a new study's folder."""
    return secrets.token_hex(8)


def is_id(text: str) -> bool:
    """Return whether words can be the name of a study's folder."""
    return _ID.match(text) is not None


def shown(text: str) -> str:
    r"""Return words of a user as they may be shown: one line, nothing hidden in it.

    Returns at most 120 characters, without control, formatting and direction marks; never empty.

    >>> shown("a\u202eb\n  c")
    'ab c'
    """
    plain = "".join(" " if mark.isspace() else mark for mark in unicodedata.normalize("NFC", text[:4000]))
    seen = "".join(mark for mark in plain if unicodedata.category(mark) not in _HIDDEN)
    return " ".join(seen.split())[:_LONGEST].rstrip() or "study"


def file_name(text: str) -> str:
    """Return the name under which a record is kept in a study.

    Returns Letters, digits, dots, dashes and underscores; no pattern, no path, no reserved word.

    >>> file_name("../../etc/pass wd*.AT2")
    'pass_wd_.AT2'
    """
    last = re.split(r"[/\\]", text)[-1]
    plain = re.sub(r"[^A-Za-z0-9._-]+", "_", last).lstrip(".")[-80:].lstrip("._-").rstrip(".")
    return plain if plain and plain.partition(".")[0].lower() not in _RESERVED else f"record_{plain}".rstrip("_")
