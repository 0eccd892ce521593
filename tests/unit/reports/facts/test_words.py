"""Restitutions are called the same on paper as on the pages."""

import re
from pathlib import Path

import pytest

from rocking import app
from rocking.evidence._coefficient_table import CALIBRATED, default_models
from rocking.plots.style import model_styles
from rocking.reports.facts.words import restitution_words
from rocking.restitution import models

PALETTE = Path(app.__file__).parent / "static" / "app" / "palette.js"


def words_of_the_pages() -> dict[str, str]:
    """Return the names in the table of the pages."""
    table = re.search(r"const WORDS = {(.*?)};", PALETTE.read_text("utf-8"), re.DOTALL)
    assert table
    rows = re.findall(r'"?([a-z-]+)"?: "([^"]+)",', table[1])
    return {name: re.sub(r"\\u([0-9a-f]{4})", lambda found: chr(int(found[1], 16)), words) for name, words in rows}


def test_paper_and_pages_agree() -> None:
    """Every model of the registry, and the calibrated one, has the same short name in both places."""
    pages = words_of_the_pages()
    assert set(pages) == {*models(), CALIBRATED}
    assert {name: restitution_words(name) for name in pages} == pages


def test_curves_have_the_same_colour_on_paper_and_on_pages() -> None:
    """The colour of a model stands with the model; the table of the pages repeats it."""
    rows = re.findall(r'"?([a-z-]+)"?: { colour: "(#[0-9A-F]{6})"', PALETTE.read_text("utf-8"))
    styles = {name: style["color"] for name, style in model_styles().items()}
    assert len(styles) == 7
    assert {name: colour for name, colour in rows if name != CALIBRATED} == styles


def test_no_model_is_called_by_its_key() -> None:
    """With its parameters, too, a model is told by words; only one word is both name and key."""
    for model in default_models():
        words = restitution_words(model.label)
        assert words != model.label
        assert "-" not in words
        assert ":" not in words


@pytest.mark.parametrize(
    ("label", "words"),
    [
        ("ked", "KED"),
        ("0.98*shifted-impulse:k=0.6", "0.98 \u00d7 shifted impulse, k = 0.6"),
        ("contact-bed:points=8,loss=0.1", "contact bed, points = 8, loss = 0.1"),
        ("0.9", "r = 0.9"),
        ("left 0.9, right 0.8", "r: left 0.9, right 0.8"),
        ("drawn anew at every impact", "drawn anew at every impact"),
    ],
)
def test_labels_in_words(label: str, words: str) -> None:
    """A factor, parameters and coefficients are told as the field writes them; anything else stays as it is."""
    assert restitution_words(label).replace("\u00a0", " ") == words
