"""Equations as MathML for browsers: no script, no font, and accessible to screen readers.

An equation with the label `eq-NUMBER` has that number, which code cites.
"""

import html
import re
import unicodedata
from itertools import zip_longest
from xml.etree import ElementTree

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.domains.math import MathDomain
from sphinx.errors import ExtensionError
from sphinx.writers.html5 import HTML5Translator

SCRIPTS = {"msub", "msup", "msubsup", "munder", "mover", "munderover"}
ACCENTS = "^~\u00a8\u00af\u02d9\u2192"  # hat, tilde, two dots, bar, dot, arrow
CLOSE = "/|\u2016\u2308\u2309\u230a\u230b\u27e8\u27e9"  # stand without space: slash, bars, floors, angles
SIGNS = "+-\u2212\u00b1\u2213"
CAPITALS = "\u0393\u0394\u0398\u039b\u039e\u03a0\u03a3\u03a5\u03a6\u03a8\u03a9"  # Greek, upright
THIN = "0.167em"


def mathml(equation: str, display: str = "inline") -> str:
    """Return an equation in LaTeX as MathML; an unknown command is an error."""
    text = convert(equation, display=display).replace(' xmlns="http://www.w3.org/1998/Math/MathML"', "")
    try:
        tree = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise ExtensionError(f"not an equation that can be written as MathML: {equation}") from error
    mend(tree, display == "block")
    text = ElementTree.tostring(tree, "unicode", short_empty_elements=False)
    if "\\" in text:
        raise ExtensionError(f"a command of LaTeX that is not known: {equation}")
    return text


def mend(tree: ElementTree.Element, block: bool) -> None:
    """Correct output of latex2mathml that MathML Core renders differently."""
    for element in list(tree.iter()):
        mend_letter(element)
        mend_primes(element)
    for element in tree.iter():
        mend_operator(element)
    for row in tree.iter():
        if row.tag not in SCRIPTS:
            mend_spaces(row, block)


def mend_letter(element: ElementTree.Element) -> None:
    """Write bold letters by a class, Greek capitals upright."""
    variant, text = element.get("mathvariant"), element.text or ""
    if variant in {"bold", "bold-italic"}:
        element.set("class", "bold")
        del element.attrib["mathvariant"]
    if variant == "bold" or (element.tag == "mi" and text and text in CAPITALS):
        element.set("mathvariant", "normal")
    if element.tag == "mspace" and element.get("width") == "negativethinmathspace":
        element.set("width", f"-{THIN}")


def mend_primes(element: ElementTree.Element) -> None:
    """Write a prime on the line of its letter, since fonts raise it already."""
    if element.tag not in {"msup", "msubsup"} or set(element[-1].text or " ") - {"\u2032", "\u2033"}:
        return
    letter, prime = element[0], element[-1]
    prime.tag = "mo"
    prime.attrib |= {"form": "postfix", "lspace": "0", "rspace": "0"}
    element.remove(prime)
    row = ElementTree.Element("mrow")
    row.extend([letter, prime])
    if element.tag == "msubsup":
        element.tag, element[0] = "msub", row
    else:
        element.tag = "mrow"
        element[:] = [letter, prime]


def mend_operator(element: ElementTree.Element) -> None:
    """Write symbols as operators, with the space that they should have."""
    text = element.text or ""
    if element.tag == "mi" and text and unicodedata.category(text[0]) in {"Sm", "Ps", "Pe"}:
        element.tag = "mo"
    if element.tag == "mo" and text == "\u221e":
        element.tag = "mi"
    if element.tag == "mo" and text and text in CLOSE:
        element.attrib |= {"lspace": "0", "rspace": "0"} | ({} if element.get("fence") else {"stretchy": "false"})
    if element.tag == "mover" and element[1].text and element[1].text in ACCENTS:
        element.set("accent", "true")


def mend_spaces(row: ElementTree.Element, block: bool) -> None:
    """Add space around function names, and remove space after prefix signs."""
    before = None
    for child, after in zip_longest(row, list(row)[1:]):
        name = child
        while name.tag in SCRIPTS and len(name):
            name = name[0]
        if name.tag in {"mi", "mo"} and name.text and len(name.text) > 1 and name.text.isalpha():
            name.tag = "mo"
            bracket = after is None or (after.text or (after[0].text if len(after) else "")) in {"(", ")", ","}
            name.attrib |= {"lspace": "0" if opens(before) else THIN, "rspace": "0" if bracket else THIN}
            if block and child.tag == "msub" and name.text in {"max", "min"}:
                child.tag = "munder"
        elif child.tag == "mo" and child.text and child.text in SIGNS and opens(before):
            child.set("form", "prefix")
        before = child


def opens(before: ElementTree.Element | None) -> bool:
    """Return True if the previous element begins an expression."""
    if before is None or before.tag == "mspace":
        return True
    return before.tag == "mo" and before.text not in {")", "]", "}", "|", "\u2032"}


def inline(self: HTML5Translator, node: nodes.math) -> None:
    """Write an equation within a line."""
    self.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def displayed(self: HTML5Translator, node: nodes.math_block) -> None:
    """Write an equation on a line of its own, with its number."""
    label = node.get("label") or ""
    anchor, number = f"equation-{html.escape(label)}", number_of(label)
    self.body.append(f'<div class="equation" id="{anchor}">' if label else '<div class="equation">')
    self.body.append(mathml(node.astext(), "block"))
    self.body.append(f'<a class="eqno" href="#{anchor}">({number})</a></div>' if number else "</div>")
    raise nodes.SkipNode


def number_of(label: str) -> int | None:
    """Return the number of an equation."""
    match = re.fullmatch(r"eq-(\d+)", label)
    return int(match[1]) if match else None


class Numbered(MathDomain):
    """Equations whose label states their number."""

    def note_equation(self, docname: str, labelid: str, location: object = None) -> None:
        super().note_equation(docname, labelid, location)
        self.equations[labelid] = (docname, number_of(labelid) or self.equations[labelid][1])


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.add_domain(Numbered, override=True)
    app.add_html_math_renderer("mathml", (inline, None), (displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
