"""`rocking simulate` of a body that drops or is launched: closed forms of the fall, Python's numbers, refusals."""

import math

import pytest

import rocking as rk
from rocking.dynamics import SpatialStart, Start

pytestmark = pytest.mark.verifies("behaviour", room="doors")
COMMAND = "simulate"
PRISM = 'units = "m"\nname = "prism"\n[[solid.part]]\nbox = { width = 0.5, depth = 0.6, height = 1.4 }\n'
HEIGHT, DOWN, G = 0.08, 0.3, rk.conventions.g
LANDING = (math.sqrt(DOWN**2 + 2.0 * G * HEIGHT) - DOWN) / G
BLOCK = ("--width", "0.5", "--height", "1.4", "--friction", "0.6")


@pytest.fixture
def body(file):
    """Body file of a prism."""
    return file(PRISM, "prism.toml")


@pytest.mark.verifies("closed form", "time and energy of a landing, of a solid and of a plane body", within="1e-9")
def test_the_landing_is_that_of_a_free_fall(answered, body):
    """The first impact is at the end of the fall; its energy is that of the fall and of the first velocity."""
    found = answered(body, "--friction", "0.6", "--start-height", HEIGHT, f"--start-velocity=0,0,{-DOWN}")
    assert (found["start_height"], found["start_velocity"]) == (HEIGHT, [0.0, 0.0, -DOWN])
    first, mass = found["impacts"][0], found["body"]["mass"]
    assert first["time"] == pytest.approx(LANDING, rel=1e-9)
    assert first["energy_before"] == pytest.approx(mass * (G * HEIGHT + 0.5 * DOWN**2), rel=1e-9)
    plane = answered(*BLOCK, "--start-height", HEIGHT, f"--start-velocity=0,{-DOWN}")
    assert plane["start_velocity"] == [0.0, -DOWN]
    assert plane["impacts"][0]["time"] == pytest.approx(LANDING, rel=1e-9)
    # negative control: from rest it lands later
    later = answered(body, "--friction", "0.6", "--start-height", HEIGHT)
    assert later["impacts"][0]["time"] == pytest.approx(math.sqrt(2.0 * HEIGHT / G), rel=1e-9)


def test_options_file_and_python_give_one_answer(answered, body, tmp_path):
    """A tilted drop by options, by a file and by Python, of a solid and of a plane body; under a motion too."""
    words = ("--initial-rotation", "0.3", "--friction", "0.6", "--start-height", HEIGHT)
    velocity = (0.2, -0.1, 0.4)
    found = answered(body, *words, "--start-velocity=0.2,-0.1,0.4")
    solid = rk.read_body(body)
    start = SpatialStart(found["initial_tilt"], height=HEIGHT, velocity=velocity)
    assert found["summary"] == rk.free_rocking(solid, friction=0.6, start=start).summary
    file = tmp_path / "drop.toml"
    table = f"initial_rotation = 0.3\nfriction = 0.6\nstart_height = {HEIGHT}\nstart_velocity = {list(velocity)}\n"
    file.write_text(f'[body]\nfile = "prism.toml"\n[response]\n{table}', encoding="utf-8")
    assert answered(file)["impacts"] == found["impacts"]
    plane = answered(*BLOCK, "--initial-rotation", "0.3", "--start-height", HEIGHT)
    block = rk.Block(width=0.5, height=1.4)
    begin = Start(0.3 * block.slenderness_angle, height=HEIGHT)
    assert plane["summary"] == rk.free_rocking(block, friction=0.6, start=begin).summary
    shaken = answered(body, "sine:amplitude=3,period=0.6", "--friction", "0.6", "--start-height", HEIGHT)
    pulse, above = rk.pulses.sine(3.0, 0.6), SpatialStart(height=HEIGHT)
    assert shaken["summary"] == rk.simulate(solid, {"x": pulse}, friction=0.6, start=above).summary
    # negative control: without the drop it is another response
    assert answered(body, *words[:4])["impacts"][0] != found["impacts"][0]


def test_the_page_states_the_start(printed, body):
    """Height and velocity of the start are on the page; without them no line of a start is."""
    out = printed(body, "--friction", "0.6", "--start-height", HEIGHT, "--start-velocity=0,0,-0.3")
    assert "released 0.08 m above the ground" in out
    assert "initial velocity (0, 0, -0.3) m/s" in out
    assert "above the ground" not in printed(body, "--friction", "0.6", "--initial-rotation", "0.3")
