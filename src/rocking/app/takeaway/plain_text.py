"""Words that came from a user, made harmless before they go into a file that another program opens."""

import re

LONGEST_LINE = 160
"""Characters of a name that are kept in pictures and tables."""

LONGEST_CELL = 2000
"""Characters of a text that are kept in one cell."""

_OF_DEVICES = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\.|$)", re.IGNORECASE)
_OURS = ("response.toml", "readme.txt")
_LONGEST_FILE_NAME = 80


def plain_line(text: str, longest: int = LONGEST_LINE) -> str:
    r"""Return a text as one line of characters that can be seen.

    Control characters, marks that turn the direction of writing, line breaks and tabs are what makes a name do
    something in a terminal, a file of XML or a comment; none of them is left.

    >>> plain_line("a\n[b]\x1b[31m\u202e")
    'a [b][31m'
    """
    seen = "".join(each for each in text if each.isprintable() or each.isspace())
    line = " ".join(seen.split())
    return line if len(line) <= longest else f"{line[: longest - 3]}..."


def record_file_name(name: str, otherwise: str = "record.txt") -> str:
    r"""Return the name under which a record file is put into an archive: letters, digits, dot, dash, underscore.

    Returns A name without folders that every system accepts.

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
    return f"_{safe}" if _OF_DEVICES.match(safe) or safe.lower() in _OURS else safe
