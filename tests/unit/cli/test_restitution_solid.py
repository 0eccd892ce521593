"""`rocking restitution` of bodies in space: closed forms edge by edge, repairs of meshes, refusals."""

import csv
import math

import numpy as np
import pytest
from PIL import Image

from rocking.bodies.formats import read_body
from rocking.bodies.solid import box, extrusion
from rocking.dynamics.rolling import SpatialBody
from rocking.restitution.space import edge_coefficient, impact_in_space

COMMAND = "restitution"

G = 9.80665
MODELS = ("housner-3d", "horizontal-momentum-3d", "ked-3d")
PRISM = 'units = "m"\n[[solid.part]]\nbox = { width = 1.0, depth = 1.0, height = 4.0 }\ndensity = 2400.0\n'
DRUM = 'units = "m"\n[[solid.part]]\ncylinder = { diameter = 1.0, height = 2.0 }\ndensity = 2400.0\n'
WEDGE = (
    'units = "m"\nname = "wedge"\n[[solid.part]]\ndensity = 2400.0\n'
    "extrusion = { outline = [[0, 0], [1.2, 0], [0.3, 0.9]], height = 1.5 }\n"
)


def test_prism_edge_by_edge(answered, file):
    """Prism 1 x 1 x 4: Housner 31/34, horizontal momentum 16/17, KED 0.9473668350323697, p^2 = 3 g / (4 R)."""
    answer = answered(file(PRISM))
    assert answer["body"]["mass"] == pytest.approx(9600.0, rel=1e-14, abs=0.0)
    assert answer["body"]["centre_height"] == pytest.approx(2.0, rel=1e-14, abs=0.0)
    assert len(answer["edges"]) == 4
    half = math.hypot(0.5, 2.0)
    for number, edge in enumerate(answer["edges"]):
        assert edge["slenderness_angle"] == pytest.approx(math.atan(0.25), rel=1e-13, abs=0.0)
        assert edge["semi_diagonal"] == pytest.approx(half, rel=1e-13, abs=0.0)
        assert edge["frequency_parameter"] == pytest.approx(math.sqrt(0.75 * G / half), rel=1e-13, abs=0.0)
        assert edge["lands_on"] == f"edge {(number + 2) % 4}"
        r = [edge["coefficients"][name]["coefficient"] for name in MODELS]
        assert r == pytest.approx([31 / 34, 16 / 17, 0.947366835032369679], rel=1e-9)
        assert not any(found["flags"] for found in edge["coefficients"].values())
        # negative control: the same check refuses the value of a slenderness of 3.75
        assert r[2] != pytest.approx(0.940898907220637169, rel=1e-3)


def test_round_base(run, answered, file):
    """A drum with H / D = 2 has the same values in all directions: 0.696202, 0.810127, 0.837211."""
    answer = answered(file(DRUM))
    assert answer["body"]["base"] == {"kind": "circle", "base_centre": [0.0, 0.0], "base_radius": 0.5}
    assert [edge["edge"] for edge in answer["edges"]] == ["0 deg", "90 deg", "180 deg", "270 deg"]
    for edge in answer["edges"]:
        r = [edge["coefficients"][name]["coefficient"] for name in MODELS]
        assert r == pytest.approx([0.6962025316455696, 0.810126582278481, 0.8372108803084781], rel=1e-8)
        assert edge["frequency_parameter"] == pytest.approx(
            math.sqrt(G * math.hypot(0.5, 1.0) / (0.25 / 4.0 + 4.0 / 12.0 + 1.25)), rel=1e-12, abs=0.0
        )  # I / m = R2 / 4 + H2 / 12 + R2 + H2 / 4
    page = run(file(DRUM), "--restitution", "housner")[1]
    assert "Directions of rocking" in page
    assert "  Base radius           0.5 m\n" in page


def test_round_base_says_that_it_rolls(run, answered, file):
    """Page and JSON say that the values of a drum hold in one plane only; a prism needs no such words."""
    drum, prism = file(DRUM, "drum.toml"), file(PRISM, "prism.toml")
    (note,) = answered(drum)["notes"]
    assert "rolls on its rim" in note
    assert "one vertical plane" in note
    assert f"! {note}" in run(drum)[1]
    assert answered(prism)["notes"] == []
    assert "rolls" not in run(prism)[1]


def test_edge_without_a_parallel_one_lands_on_a_corner(answered, file):
    """On a triangle the body falls from an edge onto the corner that faces it, with the flags of the models."""
    path = file(WEDGE)
    answer, solid = answered(path), read_body(path)
    assert [edge["lands_on"] for edge in answer["edges"]] == ["corner 2", "corner 0", "corner 1"]
    base = solid.base
    for number, edge in enumerate(answer["edges"]):
        corner = base.vertices[(number + 2) % 3]
        for name in MODELS:
            start = base.edge(number)
            found = impact_in_space(solid, -start.direction, pivot=start, onto=corner, model=name)
            assert edge["coefficients"][name]["coefficient"] == found.coefficient
            assert set(edge["coefficients"][name]["flags"]) == {flag.name.lower() for flag in found.flags}
    least = min(edge["frequency_parameter"] for edge in answer["edges"])
    assert least == pytest.approx(SpatialBody.of(solid).frequency(G), rel=1e-12, abs=0.0)


def test_options(run, capsys, file, tmp_path):
    """One model, another gravity, CSV and picture: what is printed is what is written."""
    path, table, picture = file(PRISM), tmp_path / "a.csv", tmp_path / "a.png"
    code, out, err = run(
        path, "--restitution", "ked", "--set", "settings.gravity=1.6", "--output", table, "--output", picture
    )
    assert (code, err) == (0, "")
    assert f"wrote {table}" in out
    assert "0.947367" in out
    assert "housner" not in out
    with table.open(encoding="utf-8") as opened:
        rows = list(csv.DictReader(opened))
    assert [row["model"] for row in rows] == ["ked-3d"] * 4
    assert float(rows[0]["frequency_parameter [rad/s]"]) == pytest.approx(
        math.sqrt(1.2 / math.hypot(0.5, 2.0)), rel=1e-13, abs=0.0
    )
    assert float(rows[0]["coefficient"]) == edge_coefficient(read_body(path), "ked-3d")
    assert np.asarray(Image.open(picture)).std() > 1.0


def test_meshes_and_their_repairs(run, answered, mesh):
    """A scaled mesh with a flipped face has the prism's values, and says what was repaired."""
    path = mesh("prism.stl", scale=1000.0, turn=3)
    answer = answered(path, "--units", "mm", "--density", "2700")
    assert answer["body"]["mass"] == pytest.approx(10800.0, rel=1e-6)
    assert any("reversed 1 of 12 faces" in sentence for sentence in answer["body"]["repairs"])
    r = answer["edges"][0]["coefficients"]["ked-3d"]["coefficient"]
    assert r == pytest.approx(0.947366835032369679, rel=1e-6)
    assert "! reversed 1 of 12 faces" in run(path, "--units", "mm")[1]


def test_edges_that_files_round_are_still_parallel(answered, mesh):
    """A prism turned by 0.3 rad in an STL file, whose coordinates are rounded, still lands on its far edges."""
    turned = box(1.0, 1.0, 4.0)
    c, s = math.cos(0.3), math.sin(0.3)
    shape = extrusion(turned.vertices[[0, 1, 3, 2], :2] @ np.array([[c, s], [-s, c]]), 4.0)
    answer = answered(mesh("turned.stl", shape=shape), "--units", "m")
    assert [edge["lands_on"] for edge in answer["edges"]] == ["edge 2", "edge 3", "edge 0", "edge 1"]
    for edge in answer["edges"]:
        assert edge["coefficients"]["housner-3d"]["coefficient"] == pytest.approx(31 / 34, rel=1e-5)


def test_bases_of_many_corners_keep_the_most_slender_edges(run, answered, file):
    """Of 40 edges of an oval the 16 over which it falls most easily are kept, all about its short axis; it is told."""
    angle = 2.0 * math.pi * np.arange(40) / 40.0
    outline = np.column_stack([np.cos(angle), 0.5 * np.sin(angle)]).round(6).tolist()
    path = file(f'units = "m"\n[[solid.part]]\nextrusion = {{ outline = {outline}, height = 3.0 }}\n')
    answer = answered(path, "--restitution", "housner")
    assert (len(answer["edges"]), answer["edges_left_out"]) == (16, 24)
    assert all(abs(edge["edge_start"][1]) > 0.35 for edge in answer["edges"])
    assert "24 edges with larger slenderness angles are left out" in run(path, "--restitution", "housner")[1]


def test_a_solid_has_no_recommendation_from_measurements(printed, file):
    """What is known is said: no measurement of a body in space, and two models to run."""
    out = printed(file(PRISM), "--recommend")
    assert "all measurements are of blocks that rock in one plane" in out
    assert "run housner-3d (r = 0.9118) and ked-3d" in out
    assert "all measurements are of blocks" not in printed(file(PRISM))
