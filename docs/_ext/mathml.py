"""Equations as MathML, which browsers draw by themselves: no script, no font to fetch, read aloud by screen readers."""

import html
import re

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator


def inline(self: HTML5Translator, node: nodes.math) -> None:
    """Write an equation within a line."""
    self.body.append(convert(node.astext()))
    raise nodes.SkipNode


def displayed(self: HTML5Translator, node: nodes.math_block) -> None:
    """Write an equation on a line of its own, with the number that its label `eq-NUMBER` states, which code cites."""
    label = node.get("label") or ""
    number = re.fullmatch(r"eq-(\d+)", label)
    self.body.append(f'<div class="equation"{f""" id="equation-{html.escape(label)}" """ if label else ""}>')
    self.body.append(convert(node.astext(), display="block"))
    self.body.append(f'<span class="eqno">({number[1]})</span></div>' if number else "</div>")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.add_html_math_renderer("mathml", (inline, None), (displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
