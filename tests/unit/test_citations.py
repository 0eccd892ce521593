"""Equations are cited where they are computed: code cites numbers of docs/theory.md, and each of these is cited."""

from pathlib import Path

import pytest
from benchmarks.house_citations import cited, numbered, text_of_comments

ROOT = Path(__file__).parents[2]
PAPER = set(range(1, 18))  # Eqs. 1 to 17, Mao et al. 2024


def faults(theory: str, sources: dict[str, str]) -> list[str]:
    """Return what is wrong with the citations of some sources."""
    listed = numbered(theory)
    found = [f"numbers must be 1, 2, 3, ..., got {listed}"] if listed != list(range(1, len(listed) + 1)) else []
    ours: set[int] = set()
    for name, source in sources.items():
        own, paper = cited(text_of_comments(name, source))
        ours |= set(own)
        found += [f"{name} cites Eq. {number}, which theory.md lacks" for number in own if number not in listed]
        found += [f"{name} cites Eq. {number} of the paper, which lacks it" for number in paper if number not in PAPER]
    return found + [f"Eq. {number} is computed nowhere" for number in listed if number not in ours]


def test_every_citation_is_listed_and_every_number_is_cited():
    kinds = {"src": ("*.py",), "engine": ("*.hpp", "*.cpp")}
    paths = [path for top, ends in kinds.items() for end in ends for path in (ROOT / top).rglob(end)]
    sources = {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in paths}
    assert faults((ROOT / "docs/theory.md").read_text("utf-8"), sources) == []


THEORY = (
    "    r = a / b                      (1)\n\n    r = c    (2; Mao Eq. 17)\n\nText (5).\n\n    (3)  Arias: π/(2 g)\n"
)
GOOD = {
    "a.py": "r = a / b  # Eqs. 1, 3\n# Eq. 2; Eq. 17, Mao et al. 2024\nr = c\n",
    "b.hpp": "x = 1;  // Eqs. 8, 9, Mao et al. 2024\n",
}


def test_a_good_text_has_no_faults():
    assert numbered(THEORY) == [1, 2, 3]
    assert faults(THEORY, GOOD) == []


@pytest.mark.parametrize(
    ("theory", "sources", "what"),
    [
        (THEORY, GOOD | {"c.py": "x = 1  # Eq. 4"}, "c.py cites Eq. 4, which theory.md lacks"),
        (THEORY, GOOD | {"c.hpp": "x = 1;  // Eq. 4"}, "c.hpp cites Eq. 4, which theory.md lacks"),
        (THEORY, GOOD | {"c.py": "x = 1  # Eq. 18, Mao et al. 2024"}, "c.py cites Eq. 18 of the paper, which lacks it"),
        (THEORY, {"a.py": "x = 1  # Eqs. 1, 2"}, "Eq. 3 is computed nowhere"),
        (THEORY, {"a.py": '"""Text of Eq. 3."""\nx = 1  # Eqs. 1, 2'}, "Eq. 3 is computed nowhere"),
        (THEORY, {"a.py": "x = 1  # Eqs. 1, 2; Eq. 3, Mao et al. 2024"}, "Eq. 3 is computed nowhere"),
        (THEORY + "    (5)  x\n", GOOD, "numbers must be 1, 2, 3, ..., got [1, 2, 3, 5]"),
        (THEORY + "    (3)  x\n", GOOD, "numbers must be 1, 2, 3, ..., got [1, 2, 3, 3]"),
    ],
)
def test_every_fault_is_seen(theory, sources, what):
    """Negative control: made-up texts with one fault each."""
    assert what in faults(theory, sources)
