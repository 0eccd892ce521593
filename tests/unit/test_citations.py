"""Equations are cited where they are computed: code cites numbers of docs/theory, and each of these is cited."""

import pytest
from benchmarks import house_citations
from benchmarks.house_citations import Equation, cited, computed, numbered, pages, referred, sources, text_of_comments

PAPER = set(range(1, 18))  # Eqs. 1 to 17, Mao et al. 2024


def faults(theory: dict[str, str], code: dict[str, str]) -> list[str]:
    """Return what is wrong with some pages, and with the citations of some sources."""
    equations = [equation for page in theory.values() for equation in numbered(page)]
    listed = sorted(equation.number for equation in equations)
    found = [f"numbers must be 1, 2, 3, ..., got {listed}"] if listed != list(range(1, len(listed) + 1)) else []
    found += [f"Eq. {equation.number} has no name" for equation in equations if not equation.name]
    for name, page in theory.items():
        found += [
            f"{name} refers to Eq. {number}, which no page has" for number in referred(page) if number not in listed
        ]
        if page.count("(eq-") != len(numbered(page)):
            found.append(f"{name} has labels that are not those of displayed equations")
    ours: set[int] = set()
    for name, source in code.items():
        own, paper = cited(text_of_comments(name, source))
        ours |= set(own)
        found += [f"{name} cites Eq. {number}, which no page has" for number in own if number not in listed]
        found += [f"{name} cites Eq. {number} of the paper, which lacks it" for number in paper if number not in PAPER]
    return found + [f"Eq. {number} is computed nowhere" for number in listed if number not in ours]


def test_every_citation_is_listed_and_every_number_is_cited():
    assert faults(pages(), sources()) == []


PAGE = (
    "The **ratio**\n\n$$ r = a / b $$ (eq-1)\n\nand by Eq. {eq}`eq-1`, with no number\n\n$$ r = 1 $$\n\nthe **sum**\n"
    "of **two\nlines**:\n\n$$ \\begin{split} r &= c \\\\ &+ d \\end{split} $$ (eq-2)\n"
)
OTHER = "**Arias intensity.**\n\n$$ \\pi/(2 g) $$ (eq-3)\n"
THEORY = {"one": PAGE, "two": OTHER}
GOOD = {
    "a.py": "r = a / b  # Eqs. 1, 3\n# Eq. 2; Eq. 17, Mao et al. 2024\nr = c\n",
    "b.hpp": "x = 1;  // Eqs. 8, 9, Mao et al. 2024\n",
}


def test_a_good_text_has_no_faults():
    assert numbered(PAGE)[0] == Equation(1, "ratio", "r = a / b")
    assert [equation.name for equation in numbered(PAGE + OTHER)] == ["ratio", "two lines", "Arias intensity"]
    assert faults(THEORY, GOOD) == []


@pytest.mark.parametrize(
    ("theory", "code", "what"),
    [
        (THEORY, GOOD | {"c.py": "x = 1  # Eq. 4"}, "c.py cites Eq. 4, which no page has"),
        (THEORY, GOOD | {"c.hpp": "x = 1;  // Eq. 4"}, "c.hpp cites Eq. 4, which no page has"),
        (THEORY, GOOD | {"c.py": "x = 1  # Eq. 18, Mao et al. 2024"}, "c.py cites Eq. 18 of the paper, which lacks it"),
        (THEORY, {"a.py": "x = 1  # Eqs. 1, 2"}, "Eq. 3 is computed nowhere"),
        (THEORY, {"a.py": '"""Text of Eq. 3."""\nx = 1  # Eqs. 1, 2'}, "Eq. 3 is computed nowhere"),
        (THEORY, {"a.py": "x = 1  # Eqs. 1, 2; Eq. 3, Mao et al. 2024"}, "Eq. 3 is computed nowhere"),
        (THEORY | {"three": "**A**\n\n$$ x $$ (eq-5)\n"}, GOOD, "numbers must be 1, 2, 3, ..., got [1, 2, 3, 5]"),
        (THEORY | {"three": "**A**\n\n$$ x $$ (eq-3)\n"}, GOOD, "numbers must be 1, 2, 3, ..., got [1, 2, 3, 3]"),
        (THEORY | {"three": "**A**\n\n$$ x $$ (eq-4)\n\n$$ y $$ (eq-5)\n"}, GOOD, "Eq. 5 has no name"),
        (THEORY | {"three": "By Eq. {eq}`eq-4`"}, GOOD, "three refers to Eq. 4, which no page has"),
        (THEORY | {"three": "$x$ (eq-4)"}, GOOD, "three has labels that are not those of displayed equations"),
    ],
)
def test_every_fault_is_seen(theory, code, what):
    """Negative control: made-up texts with one fault each."""
    assert what in faults(theory, code)


def test_the_index_names_the_files_that_compute_an_equation(monkeypatch):
    """Of the code as it is, and of made-up files."""
    assert "src/rocking/bodies/body.py" in computed()[26]
    assert "engine/roots.hpp" in computed()[56]
    monkeypatch.setattr(house_citations, "sources", lambda: GOOD)
    assert house_citations.computed.__wrapped__() == {1: ["a.py"], 2: ["a.py"], 3: ["a.py"]}
