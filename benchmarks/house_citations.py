"""Citations of equations: which numbers docs/theory.md lists, and which of them comments of the code cite."""

import io
import re
import tokenize


def numbered(theory: str) -> list[int]:
    """Return the numbers of the displayed equations, in order: behind one, or before it where they are listed."""
    found = []
    for line in theory.splitlines():
        mark = re.match(r" {4,}\((\d+)\)  ", line) or re.match(r" {4}.* \((\d+)(?:; [^)]*)?\)$", line)
        if mark:
            found.append(int(mark[1]))
    return found


def text_of_comments(name: str, source: str) -> list[str]:
    """Return the comments of a Python or C++ file, each without its mark."""
    if not name.endswith(".py"):
        return [line.split("//", 1)[1].strip() for line in source.splitlines() if "//" in line]
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return [token.string.lstrip("# ") for token in tokens if token.type == tokenize.COMMENT]


def cited(comments: list[str]) -> tuple[list[int], list[int]]:
    """Return the numbers that comments cite: of docs/theory.md, and of the paper."""
    ours: list[int] = []
    paper: list[int] = []
    for comment in comments:
        for numbers, of_paper in re.findall(r"Eqs?\. (\d+(?:, \d+)*)(, Mao et al\. 2024)?", comment):
            (paper if of_paper else ours).extend(int(number) for number in numbers.split(", "))
    return ours, paper
