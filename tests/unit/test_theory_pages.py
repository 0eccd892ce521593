"""The pages of the theory as the manual shows them: every equation becomes MathML that browsers draw."""

import sys
from xml.etree import ElementTree

import pytest
from benchmarks.house_citations import ROOT, numbered, pages

sys.path.append(str(ROOT / "docs" / "_ext"))
latex2mathml = pytest.importorskip("latex2mathml", reason="the manual's tools are an extra")
errors = pytest.importorskip("sphinx.errors", reason="the manual's tools are an extra")
mathml = pytest.importorskip("mathml")

CORE = set("math mrow mi mo mn mtext mspace msub msup msubsup munder mover munderover mfrac msqrt mroot".split()) | set(
    "mtable mtr mtd mstyle mpadded mphantom".split()
)  # elements of MathML Core
EQUATIONS = [equation for page in pages().values() for equation in numbered(page)]


@pytest.mark.parametrize("equation", EQUATIONS, ids=lambda equation: str(equation.number))
def test_an_equation_is_mathml_without_a_command_that_is_left(equation):
    """Elements that browsers know, and no backslash, ampersand or empty operator."""
    text = mathml.mathml(equation.latex, "block")
    tree = ElementTree.fromstring(text)
    assert {element.tag for element in tree.iter()} <= CORE
    assert "\\" not in text and "&amp;" not in text
    assert all(element.text for element in tree.iter("mo"))
    words = {element.text for element in tree.iter("mi") if len(element.text or "") > 1}
    assert words == set(), "names of functions must be operators, for their space"


@pytest.mark.parametrize("latex", [r"\atan x", r"\begin{aligned} a &= b \end{aligned}", r"a & b"])
def test_what_cannot_be_drawn_is_refused(latex):
    """Negative control: a command that is not known, an environment that is not, a stray ampersand."""
    with pytest.raises(errors.ExtensionError):
        mathml.mathml(latex, "block")


def names(latex, display="inline"):
    """Return the operators of an equation, with the space around them."""
    tree = ElementTree.fromstring(mathml.mathml(latex, display))
    return [(element.text, element.get("lspace"), element.get("rspace")) for element in tree.iter("mo")]


@pytest.mark.parametrize(
    ("latex", "expected"),
    [
        (r"p \sin^2 x", [("sin", "0.167em", "0.167em")]),
        (r"\ln(x)", [("ln", "0", "0"), ("(", None, None), (")", None, None)]),
        (r"r'", [("\u2032", "0", "0")]),
        (r"a/b", [("/", "0", "0")]),
    ],
)
def test_space_is_that_of_a_book(latex, expected):
    assert names(latex) == expected


def test_letters_and_signs_are_those_of_a_book():
    """Bold by a class, since browsers know no other; capitals of Greek upright; a sign with what follows it."""
    assert '<mi class="bold" mathvariant="normal">I</mi>' in mathml.mathml(r"\mathbf I")
    assert '<mi class="bold">\u03c9</mi>' in mathml.mathml(r"\boldsymbol\omega")
    assert '<mi mathvariant="normal">\u03a6</mi>' in mathml.mathml(r"\Phi")
    assert '<mo form="prefix">\u2212</mo>' in mathml.mathml("x = -1")
    assert "prefix" not in mathml.mathml("x - 1")
