"""Citations of equations: which numbers the pages of docs/theory list, and which of them comments of the code cite."""

import io
import re
import tokenize
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
KINDS = {"src": ("*.py",), "engine": ("*.hpp", "*.cpp")}


class Equation(NamedTuple):
    """A displayed equation with a number in bold before it."""

    number: int
    name: str
    latex: str


def pages() -> dict[str, str]:
    """Return the text of every page of the theory, by its name."""
    return {path.stem: path.read_text("utf-8") for path in sorted((ROOT / "docs" / "theory").glob("*.md"))}


def numbered(page: str) -> list[Equation]:
    """Return the numbered equations of a page as text."""
    equations, start = [], 0
    for mark in re.finditer(r"^\$\$([^$]+)\$\$ \(eq-(\d+)\)$", page, flags=re.M):
        names = re.findall(r"\*\*(.+?)\*\*", page[start : mark.start()], flags=re.S)
        equations.append(
            Equation(int(mark[2]), " ".join(names[-1].split()).rstrip(".,:") if names else "", mark[1].strip())
        )
        start = mark.end()
    return equations


def referred(page: str) -> list[int]:
    """Return the numbers of the equations that a page refers to."""
    return [int(number) for number in re.findall(r"\{eq\}`eq-(\d+)`", page)]


def sources() -> dict[str, str]:
    """Return the text of every file of the code, by its path."""
    paths = sorted(path for top, ends in KINDS.items() for end in ends for path in (ROOT / top).rglob(end))
    return {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in paths}


def text_of_comments(name: str, source: str) -> list[str]:
    """Return the comments of a Python or C++ file, each without its mark."""
    if not name.endswith(".py"):
        return [line.split("//", 1)[1].strip() for line in source.splitlines() if "//" in line]
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return [token.string.lstrip("# ") for token in tokens if token.type == tokenize.COMMENT]


def cited(comments: list[str]) -> tuple[list[int], list[int]]:
    """Return the numbers that comments cite: of docs/theory, and of the paper."""
    ours: list[int] = []
    paper: list[int] = []
    for comment in comments:
        for numbers, of_paper in re.findall(r"Eqs?\. (\d+(?:, \d+)*)(, Mao et al\. 2024)?", comment):
            (paper if of_paper else ours).extend(int(number) for number in numbers.split(", "))
    return ours, paper


@cache
def computed() -> dict[int, list[str]]:
    """Return the files that compute each equation."""
    files: dict[int, list[str]] = {}
    for path, source in sources().items():
        for number in sorted(set(cited(text_of_comments(path, source))[0])):
            files.setdefault(number, []).append(path)
    return files
