"""`--mass`, `--centre` and `--moment-of-inertia`, the same keys in files and with `--set`, and what is refused."""

import json
import math

import pytest

import rocking as rk

COMMAND = "cor"

SIZE = ("--width", 80, "--height", 200, "--depth", 60, "--units", "cm")
KNOWN = (*SIZE, "--mass", 300, "--centre", "42,70")
BLOCK = rk.Block(width=0.8, height=2.0, depth=0.6, mass=300.0, centre=(0.42, 0.7))
CRATE = 'units = "cm"\n[solid]\nmass = 300\ncentre = [2, 0, 70]\n[[solid.part]]\n'
CRATE += "box = { width = 80, depth = 60, height = 200 }\n"


def test_options_files_and_sets_say_the_same(run, answered, tmp_path):
    """The body of options, of a body file, of a question's file and of --set is the Block of Python."""
    file = tmp_path / "cabinet.toml"
    file.write_text('units = "cm"\n[block]\nwidth = 80\nheight = 200\ndepth = 60\nmass = 300\ncentre = [42, 70]\n')
    question = tmp_path / "question.toml"
    question.write_text(
        '[body]\nunits = "cm"\nwidth = 80\nheight = 200\ndepth = 60\nmass = 300\ncentre = [42, 70]\n'
        '[motion]\npulse = "sine:amplitude=7,period=0.8"\n[response]\n'
    )
    drawing = tmp_path / "cabinet.wkt"
    drawing.write_text("POLYGON ((0 0, 800 0, 800 2000, 0 2000, 0 0))")
    sets = (*SIZE, "--set", "body.mass=300", "--set", "body.centre=[42, 70]")
    ways = [KNOWN, (file,), (question,), sets, (drawing, "--units", "mm", "--mass", 300, "--centre", "420,700")]
    for words in ways:
        code, out, err = run(*words, "--restitution", "housner", "--json")
        assert code == 0, err
        body = json.loads(out)["body"]
        assert body["mass"] == pytest.approx(300.0, rel=1e-14)
        assert body["centre"] == pytest.approx([0.42, 0.7], rel=1e-14)
        assert body["moment_of_inertia"] == pytest.approx(BLOCK.moment_of_inertia, rel=1e-14)
        assert body["assumed"] == list(BLOCK.assumed)
        assert body["sides"]["left"]["slenderness_angle"] == pytest.approx(math.atan(0.42 / 0.7), rel=1e-14)
    plain = answered(*SIZE, "--restitution", "housner")["body"]
    assert plain["mass"] != pytest.approx(300.0)


def test_every_model_has_a_row_and_what_was_assumed_is_printed(printed):
    """No model fails for a plane body of known moments; the moment of inertia stands as it was given."""
    page = printed(*KNOWN)
    for name in rk.restitution.models():
        assert name == "fixed" or f"\n{name}" in page
    assert "moment of inertia assumed" in page
    given = printed(*KNOWN, "--moment-of-inertia", 95)
    assert "moment of inertia assumed" not in given
    assert "distribution of mass assumed by ked" in given


def test_a_solid_leaves_out_the_models_that_need_more(printed, answered, tmp_path):
    """Of a solid of known moments ked-3d is left out of the table, with its reason; asked for, it is refused."""
    file = tmp_path / "crate.toml"
    file.write_text(CRATE)
    page = printed(file)
    assert "left out: ked-3d" in page
    assert "needs the distribution of mass" in page
    assert list(answered(file)["edges"][0]["coefficients"]) == ["housner-3d", "horizontal-momentum-3d"]
    file.write_text(CRATE.replace("centre = [2, 0, 70]\n", ""))
    assert "ked-3d" in answered(file)["edges"][0]["coefficients"]
    assert "left out" not in printed(file)


def test_a_mesh_takes_mass_and_centre(answered, tmp_path):
    """Beside a mesh: the mass in place of the density, the centre in the coordinates and the unit of the mesh."""
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / "box.stl"
    trimesh.creation.box((800.0, 600.0, 2000.0)).export(path)
    words = (path, "--units", "mm", "--mass", 300, "--set", "body.centre=[20, 0, -300]")
    body = answered(*words)["body"]
    assert body["mass"] == pytest.approx(300.0, rel=1e-12)
    assert body["centre_height"] == pytest.approx(0.7, rel=1e-9)


def test_a_centre_in_another_unit_is_doubted(answered):
    """The answer is there, with a warning that asks for the unit."""
    doubts = answered(*SIZE, "--centre", "0.42,0.7")["body"]["warnings"]
    assert "were lengths in m taken for mm or cm?" in " ".join(doubts)
