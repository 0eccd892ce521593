"""Answers that a browser saves as a file."""

import re
import unicodedata

from starlette.responses import Response

_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_STRANGE = re.compile(r"(?:[^A-Za-z0-9._-]|(?<![A-Za-z0-9])\.|\.(?![A-Za-z0-9]))+")
_LONGEST = 80


def safe_name(name: str, fallback: str = "rocking") -> str:
    """Return a file name that is harmless on every system: ASCII letters, digits, dot, dash and underscore.

    Returns at most 80 characters; never a hidden, reserved or empty name.

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
    return stem[: _LONGEST - len(suffix) - 1].rstrip(".-_") + dot + suffix


def attachment(data: bytes, name: str, media_type: str) -> Response:
    """Return an answer that a browser saves as a file and never shows as a page."""
    headers = {
        "Content-Disposition": f'attachment; filename="{safe_name(name)}"',
        "X-Content-Type-Options": "nosniff",
    }
    return Response(data, media_type=media_type, headers=headers)
