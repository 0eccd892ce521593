"""Colours of the page: distinct for four kinds of sight, and visible on light and dark surfaces."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
from colours import GROUNDS, LEAST, SIGHTS, ciede2000, contrast, lab, linear

import rocking_workbench

SCRIPT = (Path(rocking_workbench.__file__).parent / "static/app/palette.js").read_text("utf-8")


def in_page(name):
    """Return the colours of a list in the page's palette."""
    return re.findall(r"#[0-9A-F]{6}", re.search(rf"const {name} = \[(.*?)\];", SCRIPT, re.DOTALL)[1])


@pytest.mark.parametrize("sight", SIGHTS)
def test_no_two_look_alike(sight):
    """Any two colours of azimuths are CIEDE2000 10 apart for normal sight and each of three deficiencies."""
    seen = {colour: lab(np.asarray(SIGHTS[sight]) @ linear(colour)) for colour in in_page("ANGLES")}
    distances = {(a, b): ciede2000(seen[a], seen[b]) for a, b in itertools.combinations(seen, 2)}
    assert min(distances.values()) >= LEAST, min(distances, key=distances.get)


@pytest.mark.parametrize("name", ["ANGLES", "SPARE"])
def test_strong_on_both_grounds(name):
    """A line stands out from its ground as WCAG 2.2, 1.4.11 asks of graphics: 3 to 1, light and dark."""
    assert in_page(name)
    for colour, ground in itertools.product(in_page(name), GROUNDS):
        assert contrast(colour, ground) >= 3.0, (colour, ground)
