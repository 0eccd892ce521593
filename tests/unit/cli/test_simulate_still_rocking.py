"""A response goes on until the body rests; where it still rocks at the end, `rocking simulate` says so."""

import itertools
import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics.impact_laws import ImpactLaw, RandomRestitution, SpeedRestitution
from rocking.studies import SampledRestitution

G = 9.80665
COMMAND = "simulate --width 0.5 --height 2"
LOSSLESS, KED = ("--restitution", "1"), ("--restitution", "ked")
PULSE = ("--motion", "sine:amplitude=3.2,period=0.8")
WORDS = "still rocking at the end of the computation,"


@pytest.fixture
def long_record(tmp_path):
    """Record of the same pulse, and then a minute of ground at rest."""
    time = np.arange(0.0, 60.0, 0.01)
    push = np.where(time <= 0.8, 3.2 * np.sin(2.0 * math.pi * time / 0.8), 0.0)
    path = tmp_path / "long.txt"
    path.write_text("".join(f"{t:.3f} {a:.9f}\n" for t, a in zip(time, push, strict=True)), encoding="utf-8")
    return "--motion", path, "--units", "m/s2"


def test_last_state_is_the_closed_form(answered):
    """After the last impact of the linear equations theta is alpha - alpha cosh + v / p sinh, on the right foot."""
    told = answered(*PULSE, *LOSSLESS, "--set", "settings.linear=true")
    last, end = told["impacts"][-1], told["last_state"]
    alpha, p = math.atan(0.25), math.sqrt(0.75 * G / math.hypot(0.25, 1.0))
    sign, speed = math.copysign(1.0, last["velocity_after"]), abs(last["velocity_after"])
    x = p * (end["time"] - last["time"])
    theta = alpha - alpha * math.cosh(x) + speed / p * math.sinh(x)
    rate = p * (speed / p * math.cosh(x) - alpha * math.sinh(x))
    assert x > 0.01
    assert end["rotation"] == pytest.approx(sign * theta, rel=1e-9)
    assert end["angular_velocity"] == pytest.approx(sign * rate, rel=1e-9)


def test_page_says_it(printed, answered):
    """The page and the sentence in --json name time, angle and velocity of the last state."""
    page, told = printed(*PULSE, *LOSSLESS), answered(*PULSE, *LOSSLESS)
    end = told["last_state"]
    degrees = math.degrees(end["rotation"])
    words = f"{WORDS} {end['time']:.4g} s, at {degrees:.3g} degrees and {end['angular_velocity']:.3g} rad/s"
    assert page.count(words) == 1
    assert words in end["unfinished"]
    assert "no impact loses energy, so that the body never comes to rest" in end["unfinished"]


@pytest.mark.verifies("closed form", "the linear equations from impact to impact", within="1e-6", room="doors")
def test_a_pulse_is_followed_until_the_body_rests(printed, answered, long_record):
    """Impacts come at the times of the closed form of free rocking, up to rest; a minute of rest after the same pulse
    gives the same impacts."""
    told, recorded = answered(*PULSE, *KED, "--set", "settings.linear=true"), answered(*long_record, *KED)
    assert told["still_rocking"] is False
    assert "still rocking" not in printed(*PULSE, *KED)
    alpha, p = math.atan(0.25), math.sqrt(0.75 * G / math.hypot(0.25, 1.0))
    after = [one for one in told["impacts"] if one["time"] > 0.8]
    assert len(after) > 40
    for one, two in itertools.pairwise(after[:20]):
        v = abs(one["velocity_after"]) / (p * alpha)
        assert two["time"] - one["time"] == pytest.approx(2.0 * math.atanh(v) / p, rel=1e-6)
    assert recorded["still_rocking"] is False
    # negative control: 15 / p after the pulse, where a duration ends it, it has not come to rest
    short = rk.simulate(rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.2, 0.8), "ked", duration=0.8 + 15.0 / p)
    assert short.still_rocking
    assert len(answered(*PULSE, *KED)["impacts"]) > 2 * short.impacts.size


class OwnRestitution(ImpactLaw):
    """A law without a table."""

    def __init__(self):
        pass

    def factor(self, speed, stream, impact):
        return 0.95


@pytest.mark.parametrize(
    "law",
    [
        RandomRestitution.normal(0.95, 1e-9, seed=1),
        SampledRestitution.of_law(RandomRestitution.normal(0.95, 1e-9, seed=1)),
        RandomRestitution({"left": [0.95, 0.95], "right": [0.95, 0.95]}, 1),
        RandomRestitution([1.0, 1.0], 1, times=0.95),
        SpeedRestitution([0.0, 1.0], [0.95, 0.95]),
        OwnRestitution(),
    ],
)
def test_a_law_is_followed_until_the_body_rests(law):
    """A law whose coefficients all are 0.95 gives the impacts and the end of the constant coefficient 0.95."""
    block, pulse = rk.Block(width=0.1, height=0.4), rk.pulses.sine(amplitude=4.0, period=0.2)
    constant, varied = (rk.simulate(block, pulse, restitution) for restitution in (0.95, law))
    assert not varied.still_rocking
    assert "never comes to rest" not in varied.summary
    large = constant.impacts["velocity_before"].size // 2
    assert varied.impacts["time"][:large] == pytest.approx(constant.impacts["time"][:large], abs=1e-5)
    # the own law runs on the reference engine, which counts impacts down to smaller speeds
    assert varied.time[-1] == pytest.approx(constant.time[-1], rel=2e-3)


@pytest.mark.parametrize(
    "law", [RandomRestitution([1.0, 1.0], 1), SpeedRestitution([0.0, 1.0], [1.0, 1.0]), {"left": 1.0, "right": 1.0}]
)
def test_a_law_without_loss_never_rests(law):
    """Negative control: if all coefficients of a law are 1, the response ends 15 / p after the pulse and says so."""
    block, pulse = rk.Block(width=0.1, height=0.4), rk.pulses.sine(amplitude=4.0, period=0.2)
    response = rk.simulate(block, pulse, law)
    assert "no impact loses energy, so that the body never comes to rest" in response.unfinished
    assert response.time[-1] == rk.simulate(block, pulse, 1.0).time[-1]


def test_the_first_part_is_as_before():
    """What is followed on is the same history: its first part is that of a shorter duration, to the last bit."""
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.2, 0.8)
    short, whole = rk.simulate(block, pulse, "ked", duration=4.0), rk.simulate(block, pulse, "ked")
    count = short.rotation.size
    assert whole.rotation[:count].tolist() == short.rotation.tolist()
    assert whole.rotation[-1] == whole.angular_velocity[-1] == 0.0
    assert whole.peak_rotation == short.peak_rotation


@pytest.mark.parametrize("amplitude", [1.0, 9.0])
def test_no_uplift_and_overturned(printed, answered, amplitude):
    """Negative control: neither a body at rest nor one that fell still rocks."""
    motion = "--motion", f"sine:amplitude={amplitude},period=1"
    told = answered(*motion, *KED)
    assert told["outcome"] == ("no_uplift" if amplitude < 0.25 * G else "overturned")
    assert told["still_rocking"] is False
    assert "still rocking" not in printed(*motion, *KED)


def test_python_says_it():
    """`Response.still_rocking` is true where a duration ends it, and false where none does."""
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.2, 0.8)
    short, whole = rk.simulate(block, pulse, "ked", duration=4.0), rk.simulate(block, pulse, "ked")
    assert (short.still_rocking, whole.still_rocking) == (True, False)
    assert WORDS in short.summary
    assert "still rocking" not in whole.summary
    told = [one.exported().provenance["still_rocking"] for one in (short, whole)]
    assert told == [True, False]


def test_contact_says_it(printed, answered):
    """With the last state, of the energy after the last impact, is told on the page and in --json; nothing
    is said of a response that comes to rest."""
    question = ("--friction", "10", "--restitution", "1")
    told, page = answered(*PULSE, *question), printed(*PULSE, *question)
    end, last = told["last_state"], told["impacts"][-1]
    alpha, p = math.atan(0.25), math.sqrt(0.75 * G / math.hypot(0.25, 1.0))
    kinetic = 0.5 * (end["angular_velocity"] ** 2 - last["velocity_after"] ** 2)
    raised = p**2 * (math.cos(alpha - abs(end["rotation"])) - math.cos(alpha))
    assert kinetic == pytest.approx(-raised, rel=1e-9)
    assert raised > 0.0
    for words in (page, end["unfinished"], told["summary"]):
        assert f"still rocking about one foot at the end of the computation, {end['time']:.4g} s" in words
    assert "never comes to rest" in page
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.2, 0.8)
    whole = rk.simulate(block, pulse, "ked", friction=10.0)
    assert not whole.still_rocking
    assert "still" not in whole.summary
    many = rk.simulate_many(block, pulse, "ked", friction=10.0).squeeze()  # the batch follows it as far
    assert (int(many.impacts), int(many.still_rocking)) == (len(whole.impacts), 0)


def test_in_space():
    """A block in space comes to rest as the plane one does; on its round base a cylinder is followed for 15 / p."""
    solid, pulse = rk.Solid.from_section(rk.Block(width=0.5, height=2.0, depth=0.6)), rk.pulses.sine(3.2, 0.8)
    found = rk.simulate(solid, {"x": pulse}, 0.9)
    assert not found.still_rocking
    assert rk.simulate(solid, {"x": pulse}, 0.9, duration=2.0).still_rocking
