"""The data of the search page contain formulas as words."""

import sys
from pathlib import Path

import pytest
from docutils import nodes

sys.path.insert(0, str(Path(__file__).parents[2] / "docs" / "_ext"))

from section_search import entries, plain


@pytest.mark.parametrize(
    ("latex", "text"),
    [
        (r"a_{\mathrm{p}}/(g\,\tan\alpha)", "a_p/(g tan alpha)"),
        (r"\dot\theta_2 = \sqrt{3g/(4R)}", "dot theta_2 = sqrt(3g/(4R))"),
        (r"1 - \tfrac{3}{2}\sin^2\alpha", "1 - (3)/(2) sin^2 alpha"),
        (r"\left(\frac{\frac{a}{b}}{c}\right)", "(((a)/(b))/(c))"),
    ],
)
def test_a_formula_becomes_words(latex, text):
    """Commands of layout disappear, fractions and roots keep their meaning, and names stay separate words."""
    assert plain(latex) == text


def test_titles_and_texts_of_the_search_contain_no_latex():
    """A section with a formula in title and text has neither a backslash nor a brace in the data of the search."""
    title = nodes.title("", "", nodes.Text("Period "), nodes.math("", r"\frac{2\pi}{p}"))
    paragraph = nodes.paragraph("", "", nodes.math("", r"\tan\alpha"), nodes.Text(" is b/h"))
    document = nodes.document(None, None)
    document += nodes.section("", title, paragraph, ids=["period"])
    (entry,) = entries(document, "page.html")
    assert (entry["title"], entry["page"]) == ("Period (2 pi)/(p)", "Period (2 pi)/(p)")
    assert entry["text"] == "tan alpha is b/h"
