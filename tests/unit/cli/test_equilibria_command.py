"""`rocking equilibria`: the page, JSON, picture and table of a solid, and what it refuses."""

import csv
import json
import math

import numpy as np
import pytest
import trimesh
from PIL import Image
from scipy.optimize import minimize_scalar

import rocking as rk

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


def test_the_tilt_to_overturning_in_closed_form(answered, printed, file):
    """The tilt is atan(distance / height of the centre of mass), for the nearest edge and the farthest corner."""
    body = file(PRISM)
    answer = answered(body)
    tilts = math.atan(0.5 / 1.5), math.atan(math.hypot(0.5, 1.0) / 1.5)
    assert answer["smallest_overturning_tilt"] == pytest.approx(tilts[0], rel=1e-12)
    assert answer["largest_overturning_tilt"] == pytest.approx(tilts[1], rel=1e-12)
    assert answer["units"]["smallest_overturning_tilt"] == "rad"
    line = next(line for line in printed(body).splitlines() if "Tilt to overturning" in line)
    edge, corner = (f"{math.degrees(tilt):.4g} deg" for tilt in tilts)
    assert line.split("overturning")[1].strip() == f"{edge} over the nearest edge, {corner} over the farthest corner"


@pytest.mark.parametrize(("azimuth", "index"), [(0.0, 0), (math.pi, 0), (math.pi + math.atan(2.0), 1)])
def test_the_centre_of_mass_is_highest_at_the_tilt_to_overturning(file, azimuth, index):
    """The height of the centre of mass has its largest value at this tilt, by a search without the closed form."""
    equilibria = rk.read_body(file(PRISM)).equilibria()
    pose = equilibria.settling((0.0, 0.0, -1.0))
    sideways = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])

    def depth(tilt):
        return -float(equilibria.height(math.cos(tilt) * np.array([0.0, 0.0, -1.0]) + math.sin(tilt) * sideways))

    highest = minimize_scalar(depth, bounds=(0.0, 0.8), method="bounded", options={"xatol": 1e-9}).x
    assert pose.overturning_tilts[index] == pytest.approx(highest, abs=1e-6)
    assert pose.overturning_tilts[1 - index] != pytest.approx(highest, abs=0.1)


def test_the_first_line_states_whether_the_body_stands(answered, printed, tmp_path):
    """A mesh that stands on an edge of a box is rotated onto a face, by the angle of the box."""
    angle = math.radians(30.0)
    mesh = trimesh.creation.box((0.4, 0.5, 1.0))
    for name, turn in (("stands.stl", 0.0), ("leans.stl", angle)):
        turned = mesh.copy()
        turned.apply_transform(trimesh.transformations.rotation_matrix(turn, [0.0, 1.0, 0.0]))
        turned.export(tmp_path / name)
    assert printed(tmp_path / "stands.stl", "--units", "m").splitlines()[0] == "The body stands."
    pose = answered(tmp_path / "leans.stl", "--units", "m")["stands_in"]
    first = printed(tmp_path / "leans.stl", "--units", "m").splitlines()[0]
    assert answered(tmp_path / "stands.stl", "--units", "m")["settling_rotation"] == pytest.approx(0.0, abs=1e-6)
    rotation = answered(tmp_path / "leans.stl", "--units", "m")["settling_rotation"]
    assert rotation == pytest.approx(0.5 * math.pi - angle, abs=1e-6)  # 30 degrees exceed atan(0.4 / 1.0)
    assert first == f"The body does not stand as placed: it rotates by 60 deg into pose {pose}."


def test_the_unit_of_the_lowest_barrier(answered, run, tmp_path, file):
    """A barrier has its own unit, or that of --units, or m."""
    mesh = tmp_path / "box.stl"
    trimesh.creation.box((1000.0, 2000.0, 3000.0)).export(mesh)
    barrier = math.hypot(0.5, 1.0) - 1.0  # 118 mm, of the two poses with a height of 2 m
    assert 0.10 < barrier < 0.12
    for text, count in (("120mm", 4), ("120", 4), ("12cm", 4), ("0.12m", 4), ("100mm", 6), ("0.12", 6)):
        assert len(answered(mesh, "--units", "mm", "--min-barrier", text)["stable"]) == count
    assert len(answered(file(PRISM), "--min-barrier", "0.12")["stable"]) == 4
    for text in ("4m", "4000", "-1mm", "3001mm"):
        code, _, err = run(mesh, "--units", "mm", "--min-barrier", text)
        assert code == 2
        assert "--min-barrier must be in [0, 3] m" in err
    code, _, err = run(file(PRISM), "--min-barrier", "2s")
    assert code == 2
    assert "with one of m, cm, mm, ft, in, got '2s'" in err


def test_the_note_names_the_option(printed, tmp_path):
    """A sphere of facets has shallow poses; the note names the option, in Python the parameter."""
    trimesh.creation.icosphere(3, 0.5).export(tmp_path / "ball.stl")
    page = printed(tmp_path / "ball.stl", "--units", "m")
    assert "the body is round or rough there; --min-barrier ignores such poses" in page
    notes = rk.read_body(tmp_path / "ball.stl", units="m").equilibria().notes
    assert any("min_barrier= ignores such poses" in note for note in notes)


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
