"""What a user mistypes gets a sentence that says what was probably meant; capitals do not matter."""

import json

import pytest

import rocking as rk
from rocking.bodies import Block
from rocking.checks import nearest, number_hint
from rocking.errors import RockingError, UnknownModelError
from rocking.motions import measure, pulses
from rocking.motions.formats.reader import format_named
from rocking.restitution import model
from rocking.restitution.from_file import in_own_model
from rocking.restitution.space import spatial_model, spatial_models
from rocking.studies.axis import axis_of

SIZE = ("--width", "0.5", "--height", "2")
PULSE = "sine:amplitude=3,period=0.8"


@pytest.mark.parametrize(
    "same",
    [
        lambda: model("Housner").name == "housner",
        lambda: model("0.98*Shifted-Impulse:k=0.6").label == "0.98*shifted-impulse:k=0.6",
        lambda: spatial_model("KED").name == spatial_model("Ked-3D").name == "ked-3d",
        lambda: pulses.pulse("Sine:amplitude=3,period=0.8") == pulses.pulse(PULSE),
        lambda: format_named("PEER") is not None,
        lambda: axis_of(("PGA", [1.0])).name == "pga",
        lambda: measure("PGV").name == "pgv",
    ],
)
def test_capitals_do_not_matter(same):
    """A name in other capitals is that name."""
    assert same()


@pytest.mark.parametrize(
    ("ask", "meant"),
    [
        (lambda: model("housener"), "did you mean 'housner'?"),
        (lambda: spatial_model("ked-3"), "did you mean 'ked-3d'?"),
        (lambda: pulses.pulse("rickr:amplitude=3,period=1"), "did you mean 'ricker'?"),
        (lambda: format_named("peeer"), "did you mean 'peer'?"),
        (lambda: axis_of(("widht", [1.0])), "did you mean 'width'?"),
        (lambda: measure("pgaa"), "did you mean 'pga'?"),
        (lambda: model("0,9"), "numbers have a decimal point: 0.9"),
        (lambda: pulses.pulse("sine:amplitude=0,5,period=1"), "numbers have a decimal point: 0.5"),
        (lambda: model("fixed:r=0,93"), "numbers have a decimal point: 0.93"),
        (lambda: model("mine:Mine"), "a model of your own as my_file.py:MyModel"),
        (lambda: pulses.pulse("sine:amplitude=0.3lb,period=1"), "amplitude"),
    ],
)
def test_what_was_meant(ask, meant):
    """An unknown word names the nearest known one; a decimal comma is called one."""
    with pytest.raises(RockingError) as refused:
        ask()
    assert meant in str(refused.value)


def test_nothing_is_guessed_from_far():
    """Negative control: a word unlike all others, a list of numbers and a map's range get no suggestion."""
    assert nearest("zzz", ["housner", "ked"]) == ""
    assert number_hint("0.1,0.5,1") == number_hint("1,2,4") == number_hint("a=1,b=2") == number_hint("1e5") == ""
    with pytest.raises(UnknownModelError) as refused:
        model("zzz")
    assert "did you mean" not in str(refused.value)


@pytest.mark.filterwarnings("default::rocking.errors.PlausibilityWarning")
def test_share_of_the_slenderness_angle(run):
    """`--initial-rotation 10` is refused with the spelling of 10 degrees, which gives that angle."""
    code, _, err = run("simulate", *SIZE, "--initial-rotation", "10")
    alpha = Block(width=0.5, height=2.0).slenderness_angle
    share = 10.0 * 3.141592653589793 / 180.0 / alpha
    assert code == 2
    assert "--initial-rotation 10deg" in err
    for angle in ("10deg", f"{share!r}", f"{share * alpha!r}rad"):
        answer = json.loads(run("simulate", *SIZE, "--initial-rotation", angle, "--json")[1])
        assert answer["initial_rotation"] == pytest.approx(share * alpha, rel=1e-12)
    left = json.loads(run("simulate", *SIZE, "--set", "response.initial_rotation=-10deg", "--json")[1])
    assert left["initial_rotation"] == pytest.approx(-share * alpha, rel=1e-12)
    # 5 alpha is less than a right angle: a warning with the units of angles, no refusal
    code, _, err = run("simulate", *SIZE, "--initial-rotation", "5")
    assert (code, "--initial-rotation 5deg or 0.1rad" in err) == (0, True)
    # an angle with its unit needs no advice about units
    code, _, err = run("simulate", *SIZE, "--initial-rotation", "70deg")
    assert (code, "leads to overturning" in err, "5deg" in err) == (0, True, False)
    # 100 degrees would be refused, and are not proposed
    code, _, err = run("simulate", *SIZE, "--initial-rotation", "100")
    assert (code, "fraction of the slenderness angle" in err, "100deg" in err) == (2, True, False)


def test_models_in_space_are_listed_and_shown(printed):
    """Every model that `cor` prints for a solid is one of `rocking models`, with its facts; capitals do not matter."""
    rows = [line.split()[0] for line in printed("models").splitlines() if line]
    assert set(spatial_models()) < set(rows)
    assert len(rows) == 2 + len(rk.restitution.models()) + len(spatial_models())
    out = printed("models", "--details")
    assert all(f"\n{name}: " in f"\n{out}" for name in spatial_models())
    out = printed("models", "KED-3D")
    assert out.startswith("ked-3d: ")
    assert "known defects" in out


def test_other_errors_are_not_those_of_an_own_model():
    """Errors of the program itself are not swallowed."""
    assert in_own_model(ZeroDivisionError("ours")) == ""
