"""Stacks in files and in `rocking simulate`."""

import json

import pytest

import rocking as rk
from rocking.bodies.formats.body_file import body_from_toml, body_to_toml
from rocking.errors import BodyFileError, RockingError

COLUMN = """units = "cm"

[stack]
friction = [0.6, 0.5, 0.4]
offsets = [0, 2]

[[stack.body]]
block = { width = 120, height = 50 }

[[stack.body]]
block = { width = 90, height = 120 }

[[stack.body]]
trapezoid = { base = 50, top = 30, height = 90 }
"""
PULSE = "sine:amplitude=6,period=0.8"


@pytest.fixture
def column(tmp_path):
    path = tmp_path / "column.toml"
    path.write_text(COLUMN, "utf-8")
    return path


def test_the_file_is_the_stack_of_python(column):
    """The file gives the stack of the same bodies in Python; written and read again it is the same."""
    body = rk.read_body(column)
    top = rk.Section.from_trapezoid(0.5, 0.3, 0.9)
    lower = [rk.Block(width=1.2, height=0.5), rk.Block(width=0.9, height=1.2)]
    expected = rk.Stack([*lower, top], friction=(0.6, 0.5, 0.4), offsets=(0.0, 0.02))
    assert body.height == pytest.approx(expected.height)
    assert [joint.width for joint in body.joints] == pytest.approx([joint.width for joint in expected.joints])
    assert (body.friction, body.restitution, body.offsets) == (expected.friction, expected.restitution, (0.0, 0.02))
    text = body_to_toml(body)
    again = body_from_toml(text)
    assert again.joints == body.joints
    assert [one.mass for one in again.bodies] == [one.mass for one in body.bodies]
    assert body_to_toml(again) == text


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (("friction = [0.6, 0.5, 0.4]", "friction = [0.6]"), "friction must be one value, or one value per joint"),
        (("friction", "frictoin"), "unknown key 'frictoin'"),
        (("width = 90", "widht = 90"), r"stack.body\[1\]"),
        (("width = 90, ", ""), "width is missing"),
        (("offsets = [0, 2]", "offsets = [0, 60]"), "joint 3 does not support"),
    ],
)
def test_refusals(change, match):
    """A wrong key or value is refused with its place."""
    with pytest.raises(RockingError, match=match):
        body_from_toml(COLUMN.replace(*change))


@pytest.mark.parametrize(
    "more", ['[[stack.body.restraint]]\nkind = "tendon"\nx = 0\nstiffness = 1.0\n', "floor_slope = 0.1\n"]
)
def test_restraints_and_slopes_are_refused(more):
    """No body of a stack has restraints or a floor of its own."""
    with pytest.raises(BodyFileError, match=r"Key '(restraint|floor_slope)' is not allowed for a body of a stack"):
        body_from_toml(COLUMN + more)


def test_simulate_prints_the_joints(column, run):
    """`rocking simulate` prints the response of Python: state and displacements of each joint."""
    code, out, _ = run("simulate", column, PULSE)
    assert code == 0
    assert "Normal restitution of the joints: 0" in out
    response = rk.simulate(rk.read_body(column), rk.pulses.sine(amplitude=6.0, period=0.8))
    assert response.summary.capitalize() in out
    code, out, _ = run("simulate", column, PULSE, "--json")
    answer = json.loads(out)
    assert code == 0
    assert [row["joint_state"] for row in answer["joints"]] == list(response.joint_states)
    assert "headline" not in answer
    column.write_text(COLUMN.replace("[0.6, 0.5, 0.4]", "0.9"), "utf-8")
    code, out, _ = run("simulate", column, PULSE, "--details")
    assert "Events of joints" in out
    assert "Energy balance error" in out


@pytest.mark.parametrize(
    ("words", "match"),
    [
        (["simulate", "FILE", PULSE, "--restitution", "0.9"], "a stack has its own restitution"),
        (["simulate", "FILE", PULSE, "--friction", "0.3"], "--friction does not apply to a stack"),
        (["simulate", "FILE", PULSE, PULSE], "Several records do not support a stack"),
        (["simulate", "FILE", "--motion", f"x={PULSE}", "--motion", f"y={PULSE}"], "A stack moves along x and z only"),
        (["restitution", "FILE"], "does not support stacks"),
        (["predict", "FILE", PULSE], "does not support stacks"),
        (["overturning-pga", "FILE", PULSE], "does not support stacks"),
    ],
)
def test_refusals_of_commands(column, run, words, match):
    """Options and commands that no stack has are refused."""
    code, _, err = run(*[column if word == "FILE" else word for word in words])
    assert code != 0
    assert match in err
