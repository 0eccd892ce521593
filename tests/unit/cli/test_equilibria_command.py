"""`rocking equilibria`: the page, JSON, picture and table of a solid, and what it refuses."""

import csv
import json
import math

import pytest
from PIL import Image

COMMAND = "equilibria"

PRISM = (
    'units = "m"\nname = "prism"\n[[solid.part]]\nbox = { width = 1.0, depth = 2.0, height = 3.0 }\ndensity = 1000.0\n'
)
DRUM = 'units = "m"\n[[solid.part]]\ncylinder = { diameter = 1.0, height = 2.0 }\ndensity = 2400.0\n'
G = 9.80665


def test_a_box_in_closed_form(answered, file):
    """Six poses, the one that it stands in, and the rise over its edges and towards its corners."""
    answer = answered(file(PRISM))
    assert (len(answer["stable"]), answer["saddles"], answer["summits"]) == (6, 12, 8)
    standing = answer["stable"][answer["stands_in"]]
    assert standing["centre_height"] == pytest.approx(1.5, abs=1e-12)
    narrow, wide = math.hypot(0.5, 1.5) - 1.5, math.hypot(1.0, 1.5) - 1.5
    assert standing["barrier"] == pytest.approx(narrow, abs=1e-12)
    assert answer["directions"][0]["straight_rise"] == pytest.approx(narrow, abs=1e-12)
    assert answer["directions"][3]["straight_rise"] == pytest.approx(wide, abs=1e-12)
    assert answer["directions"][0]["uplift_acceleration"] == pytest.approx(G / 3.0, rel=1e-12)
    assert answer["passes"][0]["energy"] == pytest.approx(6000.0 * G * narrow, rel=1e-12)
    assert [row["nearest_edge"] for row in answer["base_tolerances"]] == pytest.approx([0.5] * 5, abs=1e-12)


@pytest.mark.slow
def test_the_page_says_it_in_words(printed, file):
    """Of a box, and of a drum that rolls; lengths in the unit of the question."""
    page = printed(file(PRISM))
    assert "6 stable poses" in page
    assert "12 saddles, 8 summits" in page
    page = printed(file(DRUM))
    assert "axis 90 deg from the vertical, centre of mass 0.5 m high." in page
    assert "! round faces are polygons with 360 corners" in page


@pytest.mark.slow
def test_files(run, file, tmp_path):
    """A picture, and a table of the poses."""
    picture, table = tmp_path / "poses.png", tmp_path / "poses.csv"
    assert run(file(PRISM), "--output", picture, "--output", table)[0] == 0
    with Image.open(picture) as image:
        assert min(image.size) > 500
    assert len(list(csv.DictReader(table.read_text("utf-8").splitlines()))) == 6


def test_a_block_is_extruded(answered, file):
    """Over its depth, under the name of its file; points of mass have no surface."""
    told = answered(file('units = "m"\n[block]\nwidth = 1.0\nheight = 4.0\ndepth = 2.0\n'))
    assert (len(told["stable"]), told["saddles"], told["summits"]) == (6, 12, 8)
    assert [pose["centre_height"] for pose in told["stable"]] == pytest.approx([0.5, 0.5, 1.0, 1.0, 2.0, 2.0])


@pytest.mark.slow
def test_a_file_that_asks_for_a_response(answered, run, file, tmp_path):
    """Its table [body] is what stands, as the body alone does; --set changes it."""
    body = file(PRISM)
    asked = tmp_path / "asked.toml"
    asked.write_text('[response]\nfriction = 0.5\n[body]\nfile = "body.toml"\n')
    code, out, err = run(asked, "--json")
    assert (code, "only body and gravity are used" in err) == (0, True)
    assert json.loads(out) == answered(body)
    (tmp_path / "other.toml").write_text(PRISM.replace("height = 3.0", "height = 2.5"))
    _, out, _ = run(asked, "--json", "--set", "body.file=other.toml")
    assert json.loads(out) == answered(tmp_path / "other.toml")
