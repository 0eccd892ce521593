"""Commands with a body file that has `[[restraint]]` or `[frame]`."""

import json

import pytest

import rocking as rk
from rocking.bodies.formats import body_from_toml, body_to_toml

BLOCK = 'units = "m"\n[block]\nwidth = 1.0\nheight = 6.0\ndepth = 1.0\nmass = 4000.0\n'
PIER = BLOCK + '[[restraint]]\nkind = "tendon"\nx = 0.5\nstiffness = 500e3\nprestress = 20e3\n'
DOCUMENT = PIER.replace("[block]", "[body.block]").replace("[[restraint]]", "[[body.restraint]]")
DOCUMENT = DOCUMENT.replace('units = "m"', '[body]\nunits = "m"') + "[response]\nfriction = 0.5\n"
REFUSAL = "This analysis does not support restraints. Remove [[restraint]]"


@pytest.mark.parametrize("options", [(), ("--recommend",), ("--details",)])
def test_restitution_is_that_of_the_body_without_restraints(run, file, options):
    """A restraint gives no impulse at an impact; a sentence states that."""
    code, out, err = run("restitution", file(PIER, "pier.toml"), *options)
    assert (code, err) == (0, "")
    note, _, results = out.partition("\n")
    assert note.endswith("pier.toml: restraints give no impulse at an impact; the coefficients are of the body without "
                         "restraints.")  # fmt: skip
    assert results == run("restitution", file(BLOCK, "block.toml"), *options)[1]


def test_json_of_restitution_contains_results_only(run, file):
    code, out, err = run("restitution", file(PIER, "pier.toml"), "--json")
    assert code == 0
    assert "restraints give no impulse" in err
    assert json.loads(out) == json.loads(run("restitution", file(BLOCK, "block.toml"), "--json")[1])


@pytest.mark.parametrize("text", [PIER, DOCUMENT])
@pytest.mark.parametrize("options", [(), ("--json",), ("--details",)])
def test_equilibria_refuses_restraints(run, file, text, options):
    code, out, err = run("equilibria", file(text, "pier.toml"), *options)
    assert code != 0
    assert REFUSAL in err
    assert "Traceback" not in out + err


def test_a_3d_picture_refuses_restraints(run, file, tmp_path):
    code, _, err = run("restitution", file(PIER, "pier.toml"), "--output", tmp_path / "pier.glb")
    assert code != 0
    assert REFUSAL in err


FRAME = BLOCK + "[frame]\ncolumns = 3\nbeam_mass = 5000\n"


def test_simulate_names_the_projection(run, file):
    """The command states the coefficient of the frame and compares no models of single bodies."""
    path = file(FRAME, "frame.toml")
    code, out, _ = run("simulate", path, "sine:amplitude=4,period=0.8")
    assert code == 0
    assert "Restitution: projection of the frame, r = " in out
    assert "There are no published measurements of frames." in out
    answer = json.loads(run("simulate", path, "sine:amplitude=4,period=0.8", "--json")[1])
    assert answer["body"]["beam_mass"] == 5000.0
    assert answer["other_models"] == {}


ISOLATED = BLOCK + "[isolator]\nbase_mass = 500\nperiod = 1.5\ndamping_ratio = 0.1\n"


def test_simulate_shows_the_clearance_of_an_isolated_base(run, file):
    """The command states the displacement of the base; the text of the file gives the same base."""
    path = file(ISOLATED, "isolated.toml")
    code, out, err = run("simulate", path, "sine:amplitude=4,period=0.8")
    assert (code, err) == (0, "")
    assert "Largest base displacement" in out
    answer = json.loads(run("simulate", path, "sine:amplitude=4,period=0.8", "--json")[1])
    isolated = body_from_toml(ISOLATED)
    response = rk.simulate(isolated, rk.pulses.sine(4.0, 0.8))
    assert answer["largest_base_displacement"] == pytest.approx(response.largest_base_displacement, rel=1e-9)
    assert answer["body"]["base_mass"] == 500.0
    assert body_from_toml(body_to_toml(isolated)).stiffness == isolated.stiffness


@pytest.mark.parametrize("command", ["map", "fragility", "predict", "assess", "overturning-pga", "equilibria"])
def test_other_commands_refuse_an_isolated_base(run, file, command):
    motion = [] if command == "equilibria" else ["sine:amplitude=4,period=0.8"]
    code, out, err = run(command, file(ISOLATED, "isolated.toml"), *motion)
    assert code != 0
    assert "This analysis does not support isolated bases." in err
    assert "Traceback" not in out + err


def test_an_isolated_base_has_no_restraints(run, file):
    code, _, err = run("simulate", file(ISOLATED + PIER[len(BLOCK) :], "both.toml"), "sine:amplitude=4,period=0.8")
    assert code != 0
    assert "A body with [isolator] has no [[restraint]] and no floor_slope" in err


def test_simulate_suggests_files_that_it_writes(run, file, tmp_path):
    """A response with restraints has a picture; an animation is refused and not suggested."""
    command = ("simulate", file(PIER, "pier.toml"), "--motion", "sine:amplitude=3,period=0.8", "--restitution", "ked")
    code, out, _ = run(*command, "--output", tmp_path / "response.png")
    assert (code, ".html" in out, (tmp_path / "response.png").stat().st_size > 0) == (0, False, True)
    assert "-o picture.png" in out
    code, _, err = run(*command, "--output", tmp_path / "response.html")
    assert code == 2
    assert "for a single body without restraints and isolators; save a picture (.png or .svg)" in err
    free = run("simulate", file(BLOCK, "block.toml"), *command[2:])[1]
    assert "-o animation.html" in free
    isolated = run("simulate", file(ISOLATED, "isolated.toml"), *command[2:4])[1]
    assert "-o picture.png" in isolated
