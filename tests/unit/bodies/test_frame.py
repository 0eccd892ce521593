"""Frames: files, copies, refusals, and commands."""

import pytest

import rocking as rk
from rocking.bodies.formats import body_from_toml, body_to_toml
from rocking.errors import GeometryError, InvalidValueError, RockingError

pytestmark = pytest.mark.verifies(room="bodies")

FILE = """units = "cm"
[trapezoid]
base = 80
top = 50
height = 300
lean = 10
density = 2000
[frame]
columns = 3
beam_mass = 5000
beam_on = "hinge"
"""
TIE = '[[restraint]]\nkind = "spring"\nground = [-100, 200]\npoint = [5, 200]\nstiffness = 1e4\n'
COLUMN = rk.Block(width=0.75, height=3.0, mass=1000.0)
FRAME = rk.Frame([COLUMN] * 2, 6000.0)


def test_a_file_gives_the_frame_and_back():
    """A body file with [frame] describes equal columns; its text gives equal numbers."""
    frame = body_from_toml(FILE)
    outline = rk.bodies.shapes.trapezoid(0.8, 0.5, 3.0, 0.1)
    own = rk.Frame([rk.Section.from_points(outline, 2000.0)] * 3, 5000.0, beam_on="hinge")
    again = body_from_toml(body_to_toml(frame))
    for foot in ("left", "right"):
        assert frame.side(foot).frequency_parameter == pytest.approx(own.side(foot).frequency_parameter, rel=1e-14)
        assert again.side(foot) == frame.side(foot)
        assert again.projection(foot) == frame.projection(foot)
    tied = body_from_toml(FILE + TIE)
    assert isinstance(tied, rk.Restrained)
    assert tied.body.side("left") == frame.side("left")


def test_a_file_needs_equal_columns():
    other = rk.Block(width=0.75, height=3.0, mass=500.0)
    with pytest.raises(InvalidValueError, match="describes frames with equal columns only"):
        body_to_toml(rk.Frame([COLUMN, other], 100.0))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [("columns = 3", "columns = 0", "columns"), ("density = 2000\n", "", "State the mass or the density"),
     ('"hinge"', '"rail"', "beam_on"), ("beam_mass = 5000", "beam_mass = -1", "beam_mass")],
)  # fmt: skip
def test_bad_files(old, new, message):
    with pytest.raises(RockingError, match=message):
        body_from_toml(FILE.replace(old, new))


@pytest.mark.parametrize(
    ("columns", "options", "message"),
    [([], {}, "one or more columns"), ([COLUMN, "wall"], {}, "Block or Section"),
     ([rk.Block(width=1.0, height=3.0)], {}, "State the mass"), ([COLUMN], {"beam_on": "rail"}, "corner"),
     ([rk.MassPoints([(0.0, 2.0)], [1.0], feet=(-1.0, 1.0))], {}, "Block or Section")],
)  # fmt: skip
def test_bad_frames(columns, options, message):
    with pytest.raises(InvalidValueError, match=message):
        rk.Frame(columns, 100.0, **options)


def test_a_beam_outside_the_base_is_refused():
    """A beam on the hinge of a tilted column can make the frame unstable."""
    tilted = rk.Section.from_points([(0.0, 0.0), (1.0, 0.0), (1.5, 3.0), (1.1, 3.0)], 2000.0)
    with pytest.raises(GeometryError, match="not stable without motion about the right feet"):
        rk.Frame([tilted] * 2, 1e6, beam_on="hinge")


def test_copies():
    """A mirrored frame exchanges its sides; twice the size gives 1 / sqrt(2) of p and an equal coefficient."""
    frame = body_from_toml(FILE)
    mirrored, large = frame.mirrored(), frame.scaled(size=2.0)
    assert mirrored.projection("left") == pytest.approx(frame.projection("right"), rel=1e-12)
    assert large.projection("left") == pytest.approx(frame.projection("left"), rel=1e-12)
    ratio = large.side("left").frequency_parameter / frame.side("left").frequency_parameter
    assert ratio == pytest.approx(0.5**0.5, rel=1e-12)
    assert large.beam_mass == 40e3
    with pytest.raises(InvalidValueError, match="feet of its columns"):
        frame.with_feet(0.0, 1.0)


PULSES = [rk.pulses.sine(5.0, period) for period in (0.8, 1.0)]


@pytest.mark.parametrize(
    "analysis",
    [
        lambda: rk.predict(FRAME, PULSES), lambda: rk.predict(FRAME, PULSES, restitution=0.9),
        lambda: rk.assess(FRAME, PULSES), lambda: rk.simulate(FRAME, PULSES[0], friction=0.5),
        lambda: rk.restitution.energy_balance(FRAME),
    ],
)  # fmt: skip
def test_analyses_of_single_bodies_refuse_a_frame(analysis):
    with pytest.raises(InvalidValueError, match=r"does not support frames|no mass distribution for a Frame"):
        analysis()


def test_studies_accept_a_frame():
    """Maps, fragility curves and batches name the projection of the frame, and follow it as `simulate` does."""
    curves = rk.fragility(FRAME, PULSES, [3.0, 5.0, 7.0])
    assert curves.attrs["restitution"] == "projection of the frame"
    many = rk.simulate_many([FRAME], PULSES)
    peak = float(many["peak_rotation"].isel(motion=0).squeeze())
    assert peak == pytest.approx(rk.simulate(FRAME, PULSES[0]).peak_rotation, rel=1e-9)
    maps = [
        rk.overturning_map(body, PULSES[0], ("pga", [3.0, 9.0, 15.0]), ("period", [0.6, 1.2]))
        for body in (FRAME, rk.Frame([COLUMN] * 5, 15000.0))
    ]
    assert maps[0]["mode"].equals(maps[1]["mode"])
    assert len(set(maps[0]["mode"].values.ravel().tolist())) > 1
