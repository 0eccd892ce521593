"""The pages of the theory as the manual shows them: every equation becomes MathML that browsers draw."""

import io
import re
import sys
from importlib import import_module
from xml.etree import ElementTree

import pytest
from benchmarks.house_citations import ROOT, numbered, pages
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

sys.path.append(str(ROOT / "docs" / "_ext"))
mathml = import_module("mathml").mathml

SCRIPTS = {"msub", "msup", "msubsup", "munder", "mover", "munderover"}
TABLES = {"mtable", "mtr", "mtd"}
CORE = {"math", "mrow", "mi", "mo", "mn", "mtext", "mspace", "mfrac", "msqrt", "mroot", "mstyle", *SCRIPTS, *TABLES}
EQUATIONS = [equation for page in pages().values() for equation in numbered(page)]


def unfit(text):
    """Return what browsers would not draw as it is meant: elements, commands of LaTeX, names that are no operators."""
    tree = ElementTree.fromstring(text)
    found = [element.tag for element in tree.iter() if element.tag not in CORE]
    found += [text for mark in ("\\", "&amp;") if mark in text]
    found += ["an empty operator" for element in tree.iter("mo") if not element.text]
    return found + [element.text for element in tree.iter("mi") if len(element.text or "") > 1]


@pytest.mark.parametrize("equation", EQUATIONS, ids=lambda equation: str(equation.number))
def test_an_equation_is_drawn(equation):
    assert unfit(mathml(equation.latex, "block")) == []


@pytest.mark.parametrize("page", pages())
def test_equations_within_lines_are_drawn(page):
    text = re.sub(r"\$\$[^$]+\$\$", "", pages()[page])
    for equation in re.findall(r"\$([^$]+)\$", text):
        assert unfit(mathml(equation)) == [], equation


@pytest.mark.parametrize("latex", [r"\atan x", r"\begin{aligned} a &= b \end{aligned}", r"a & b"])
def test_what_cannot_be_drawn_is_refused(latex):
    """Negative control: a command that is not known, an environment that is not, a stray ampersand."""
    with pytest.raises(ExtensionError):
        mathml(latex, "block")


@pytest.mark.parametrize("text", ["<menclose/>", "<mi>\\atan</mi>", "<mi>&amp;</mi>", "<mo/>", "<mi>sin</mi>"])
def test_what_is_unfit_is_noticed(text):
    """Negative control."""
    assert unfit(f"<math>{text}</math>") != []


@pytest.mark.parametrize(
    ("latex", "expected"),
    [
        (r"p \sin^2 x", [("sin", "0.167em", "0.167em")]),
        (r"\ln(x)", [("ln", "0", "0"), ("(", None, None), (")", None, None)]),
        (r"r'", [("\u2032", "0", "0")]),
        (r"a/b", [("/", "0", "0")]),
    ],
)
def test_operators_have_the_space_of_a_book(latex, expected):
    tree = ElementTree.fromstring(mathml(latex))
    assert [(element.text, element.get("lspace"), element.get("rspace")) for element in tree.iter("mo")] == expected


@pytest.mark.parametrize(
    ("latex", "expected"),
    [
        (r"\mathbf I", '<mi class="bold" mathvariant="normal">I</mi>'),
        (r"\boldsymbol\omega", '<mi class="bold">\u03c9</mi>'),
        (r"\Phi", '<mi mathvariant="normal">\u03a6</mi>'),
        ("x = -1", '<mo form="prefix">\u2212</mo>'),
        ("x - 1", "<mo>\u2212</mo>"),
    ],
)
def test_letters_and_signs_are_those_of_a_book(latex, expected):
    """Bold by a class, since browsers know no other; capitals of Greek upright; a sign with what follows it."""
    assert expected in mathml(latex)


def built(folder, pages):
    """Build a small manual; return its pages, and what was warned of."""
    (folder / "conf.py").write_text("")
    for name, text in pages.items():
        (folder / f"{name}.md").write_text(text)
    warnings = io.StringIO()
    settings = {
        "extensions": ["myst_parser", "mathml"],
        "myst_enable_extensions": ["dollarmath"],
        "html_math_renderer": "mathml",
        "html_theme": "basic",
    }
    paths = [str(folder), str(folder), str(folder / "html"), str(folder / "trees")]
    Sphinx(*paths, "html", settings, status=None, warning=warnings).build()
    return {name: (folder / "html" / f"{name}.html").read_text("utf-8") for name in pages}, warnings.getvalue()


MANUAL = {
    "index": "# One\n\n```{toctree}\nother\n```\n\n$$ b = 2 $$ (eq-7)\n\nSee {eq}`eq-3` and {eq}`eq-7`.\n",
    "other": "# Two\n\n$$ a = 1 $$ (eq-3)\n",
}


@pytest.mark.slow
def test_a_number_is_that_of_its_label_wherever_it_stands(tmp_path):
    pages, warnings = built(tmp_path, MANUAL)
    assert warnings == ""
    assert re.search(r'href="other.html#equation-eq-3"[^>]*>\(3\)<', pages["index"])
    assert re.search(r'href="#equation-eq-7"[^>]*>\(7\)<', pages["index"])
    assert 'id="equation-eq-3"' in pages["other"]


def test_a_reference_to_no_equation_is_warned_of(tmp_path):
    """Negative control: with `make docs` a warning is an error."""
    _, warnings = built(tmp_path, MANUAL | {"other": "# Two\n\n$$ a = 1 $$ (eq-4)\n"})
    assert "equation not found: eq-3" in warnings
