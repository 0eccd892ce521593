"""What a user gives by mistake is refused by its cause, and what serves instead; what one door takes others take."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError, RockingError, UnknownModelError
from rocking.motions import pulses
from rocking.restitution import RestitutionModel

BLOCK, PULSE = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6)
BOX = rk.dynamics.SpatialBody.box(0.5, 0.5, 2.0)
ANY: Any = rk  # takes what no signature allows


@pytest.mark.parametrize(
    "call",
    [
        lambda given: ANY.simulate(BLOCK, given),
        lambda given: ANY.simulate(BOX, {"x": given}),
        lambda given: ANY.simulate(BLOCK, given, friction=0.4),
        lambda given: ANY.simulate_many(BLOCK, given),
        lambda given: ANY.simulate_many(BLOCK, [PULSE, given]),
        lambda given: ANY.overturning_map(BLOCK, given, ("scale", [1.0]), ("width", [0.5])),
        lambda given: ANY.fragility(BLOCK, given, levels=[1.0, 2.0]),
        lambda given: ANY.fragility(BLOCK, [given], levels=[1.0, 2.0]),
        lambda given: ANY.predict(BLOCK, given),
        lambda given: ANY.assess(BLOCK, [given]),
    ],
)
def test_a_path_in_place_of_a_motion_names_the_reader(call: Any) -> None:
    """Of a file `read_motion`, of words `pulses.pulse`, at every door; a number gets no such advice."""
    for path in ("x.at2", Path("x.at2")):
        with pytest.raises(InvalidValueError, match=r"rocking\.read_motion\('x\.at2'\) reads a file"):
            call(path)
    with pytest.raises(InvalidValueError, match=r"rocking\.pulses\.pulse\('sine:amplitude=3,period=1'\)"):
        call("sine:amplitude=3,period=1")
    with pytest.raises(RockingError) as refused:
        call(3.0)
    assert "read_motion" not in str(refused.value)


def test_samples_in_place_of_a_motion_name_the_class() -> None:
    with pytest.raises(InvalidValueError, match=r"rocking\.GroundMotion\(acceleration, time_step\)"):
        ANY.simulate(BLOCK, np.zeros(9))


@pytest.mark.parametrize(
    "call",
    [
        lambda given: ANY.simulate(given, PULSE),
        lambda given: ANY.simulate_many(given, PULSE),
        ANY.coefficient_of_restitution,
        lambda given: ANY.coefficient_of_restitution(given, 0.9),
        lambda given: ANY.predict(given, [PULSE]),
        ANY.evidence.recommend,
    ],
)
def test_a_path_in_place_of_a_body_names_the_reader(call: Any) -> None:
    with pytest.raises(InvalidValueError, match=r"rocking\.read_body\('body\.toml'\) reads a file"):
        call("body.toml")


UNEVEN = rk.Block(width=0.8, height=2.0, centre=(0.3, 0.8))


@pytest.mark.parametrize(
    "restitution",
    [0.6, np.float64(0.6), {"left": 0.5, "right": 0.65}, "housner", "0.98*ked", rk.restitution.model("ked")],
    ids=str,
)
def test_a_coefficient_takes_what_a_simulation_takes(restitution: Any) -> None:
    """On both feet of an asymmetric body the coefficient is the one that the history uses."""
    response = rk.simulate(UNEVEN, PULSE, restitution)
    for foot in ("left", "right"):
        found = rk.coefficient_of_restitution(UNEVEN, restitution, foot=foot)
        assert found == getattr(response.parameters, foot).coefficient


def test_a_coefficient_that_creates_energy_is_refused_by_both() -> None:
    """Onto the longer lever the bound is sqrt(I_O / I_O') < 1, onto the shorter one above 1."""
    inertia = {foot: UNEVEN.side(foot).moment_of_inertia for foot in ("left", "right")}
    most = float(np.sqrt(inertia["left"] / inertia["right"]))  # the centre is nearer to the left foot
    assert rk.coefficient_of_restitution(UNEVEN, 0.999 * most, foot="right") == 0.999 * most
    for call in (
        lambda: rk.coefficient_of_restitution(UNEVEN, 1.001 * most, foot="right"),
        lambda: rk.simulate(UNEVEN, PULSE, 1.001 * most),
    ):
        with pytest.raises(InvalidValueError, match="the impact would create energy"):
            call()
    assert rk.coefficient_of_restitution(BLOCK, 0.9, eta=0.5) == 0.45


class Without(RestitutionModel):
    """A model of a user who misspelt the method."""

    name = "without"

    def raw_coeficient(self, body: Any, foot: Any) -> float:
        return 0.5


class Bare:
    """No model at all."""

    label = "bare"


@pytest.mark.parametrize(
    ("restitution", "says"),
    [
        (Bare(), "got a Bare object without method raw_coefficient; a model of your own must be a subclass"),
        (Bare, r"got the class Bare; use an object, Bare\(\)"),
        (rk.restitution.models()["ked"], r"got the class Ked; use an object, Ked\(\)"),
        (None, "got None"),
    ],
)
def test_what_is_no_model_names_what_it_lacks(restitution: Any, says: str) -> None:
    with pytest.raises(InvalidValueError, match=says):
        rk.coefficient_of_restitution(BLOCK, restitution)
    if restitution is not None:
        with pytest.raises(InvalidValueError, match=says):
            rk.simulate(BLOCK, PULSE, restitution)


def test_a_law_has_no_single_coefficient() -> None:
    with pytest.raises(InvalidValueError, match="SpeedRestitution object, a law that varies from impact to impact"):
        ANY.coefficient_of_restitution(BLOCK, rk.dynamics.SpeedRestitution([0.0, 1.0], [0.9, 0.5]))  # type: ignore[arg-type]


def test_a_law_in_space_names_what_it_lacks() -> None:
    with pytest.raises(InvalidValueError, match="got a Bare object without velocity_after"):
        rk.simulate(BOX, PULSE, Bare())
    with pytest.raises(InvalidValueError, match="got a Housner object without velocity_after"):
        rk.simulate(BOX, PULSE, rk.restitution.model("housner"))


def test_a_missing_method_is_named_by_every_door(tmp_path: Path) -> None:
    """By `register`, and from a file: the method that lacks, not the parameters that were not given."""
    with pytest.raises(InvalidValueError, match="the model Without has no method raw_coefficient"):
        rk.restitution.register(Without)
    file = tmp_path / "mine.py"
    file.write_text(
        "import rocking as rk\nclass Mine(rk.restitution.RestitutionModel):\n    name = 'mine'\n", encoding="utf-8"
    )
    from rocking.restitution.from_file import model_in_file

    with pytest.raises(RockingError, match="Mine has no method raw_coefficient") as refused:
        model_in_file(str(file))
    assert "parameters" not in str(refused.value)


@pytest.mark.parametrize(
    ("words", "plain"),
    [
        ("sine:amplitude=0.3g,period=0.6", "sine:amplitude=2.941995,period=0.6"),
        ("sine:amplitude=300gal,period=600ms", "sine:amplitude=3,period=0.6"),
        ("sine:amplitude=300 cm/s2,period=0.6s", "sine:amplitude=3.0,period=0.6"),
        ("ricker:amplitude=-3000mm/s2,period=600ms", "ricker:amplitude=-3,period=0.6"),
        ("mavroeidis-papageorgiou:velocity=50cm/s,period=1,phase=90deg",
         f"mavroeidis-papageorgiou:velocity=0.5,period=1,phase={np.pi / 2!r}"),
        ("type-c:amplitude=0.1g,period=1,n=2", "type-c:amplitude=0.980665,period=1,n=2"),
    ],
)  # fmt: skip
def test_units_in_pulses(words: str, plain: str) -> None:
    """g is 9.80665 m/s2, gal and cm/s2 are 0.01 m/s2; a pulse with units is that of the numbers."""
    times = np.linspace(0.0, 0.6, 7)
    np.testing.assert_allclose(
        pulses.pulse(words).acceleration(times), pulses.pulse(plain).acceleration(times), rtol=1e-12, atol=1e-12
    )


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (
            "sine:amplitude=0.3gg,period=1",
            "amplitude must be a number, without unit or with one of m/s2, .*, got '0.3gg'",
        ),
        ("sine:amplitude=3s,period=1", "amplitude must be a number, without unit or with one of m/s2, .*, got '3s'"),
        ("sine:amplitude=3,period=1min", "period must be a number, without unit or with one of s, ms, got '1min'"),
        ("harmonic:amplitude=3,period=1,cycles=5g", "cycles must be a number without a unit, got '5g'"),
        ("sine:amplitude=nan,period=1", "amplitude must be a number"),
        ("sine:amplitude=1e999,period=1", "amplitude must be a finite number"),
        ("type-c:amplitude=3,period=1,n=1.5", "n must be a whole number"),
    ],
)
def test_units_that_do_not_fit_are_named(words: str, says: str) -> None:
    with pytest.raises(InvalidValueError, match=says):
        pulses.pulse(words)


def test_rows_that_decrease_are_named() -> None:
    for call in (
        lambda values: rk.fragility(BLOCK, [PULSE], levels=values),
        lambda values: rk.overturning_map(BLOCK, PULSE, ("pga", values), ("width", [0.5])),
    ):
        with pytest.raises(InvalidValueError, match=r"must increase \[m/s2\] from value to value; reverse the order"):
            call([3.0, 2.0, 1.0])
        with pytest.raises(InvalidValueError, match="2 follows 3 at index 2"):
            call([1.0, 3.0, 2.0])


def test_a_missing_sample_is_named(tmp_path: Path) -> None:
    """A NaN in a record is a gap, in its line; a word that is none of these is a word."""
    for word, gap in (("NaN", True), ("nan", True), ("1.2.3", False)):
        path = tmp_path / "record.csv"
        rows = [f"{0.01 * k:.2f},{word if k == 7 else 0.1 * k}" for k in range(20)]
        path.write_text("\n".join(["t [s],a [m/s2]", *rows]), encoding="utf-8")
        with pytest.raises(RockingError, match="line 9: number expected") as refused:
            rk.read_motion(path)
        assert ("a sample has no value" in str(refused.value)) is gap


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            'units = "m"\nwidth = 0.5\nheight = 2.0\n',
            r"Key 'width' is not allowed outside a table. Write \[block\]",
        ),
        ("width = 0.5\n", r"Write \[block\] in a line above width"),
        ('units = "m"\nsides = 5\n', r"Write \[regular_polygon\]|Write \[ellipse\]"),
        ('units = "m"\nwidht = 0.5\n', "unknown key 'widht'; allowed: units"),
    ],
)
def test_keys_outside_of_their_table_are_named(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "body.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RockingError, match=says):
        rk.read_body(path)


FEET = rk.Block(width=0.8, height=2.0, depth=0.5, density=2000.0, feet=(0.05, 0.7))


@pytest.mark.parametrize("model", [*rk.restitution.models()])
def test_a_block_on_feet_is_the_section(model: str) -> None:
    """A block on feet has every coefficient of the polygon on these feet; on its corners it has others."""
    polygon = rk.Section.from_rectangle(0.8, 2.0, density=2000.0, depth=0.5, feet=(0.05, 0.7))
    parameters = {"r": 0.7} if model == "fixed" else {"k": 0.6} if model == "shifted-impulse" else {}
    for foot in ("left", "right"):
        r, expected = (rk.coefficient_of_restitution(body, model, foot=foot, **parameters) for body in (FEET, polygon))
        assert r == pytest.approx(expected, rel=1e-12)
        assert FEET.side(foot).frequency_parameter == pytest.approx(polygon.side(foot).frequency_parameter, rel=1e-12)
    if model != "fixed":
        corners = rk.Block(width=0.8, height=2.0, depth=0.5, density=2000.0)
        assert rk.coefficient_of_restitution(corners, model, **parameters) != pytest.approx(r, rel=1e-3)


def test_a_block_on_feet_is_one_wherever_it_goes(tmp_path: Path) -> None:
    """Closed forms of its sides; files, mirror, size, repr and equality keep the feet."""
    assert (FEET.side("left").half_width, FEET.side("right").half_width) == pytest.approx((0.35, 0.3), rel=1e-12)
    mirror = FEET.mirrored()
    assert mirror.side("left").half_width == pytest.approx(0.3, rel=1e-12)
    assert FEET.scaled(size=2.0).feet == (0.1, 1.4)
    assert FEET.with_feet(0.0, 0.8) == rk.Block(width=0.8, height=2.0, depth=0.5, density=2000.0) != FEET
    assert eval(repr(FEET), {"Block": rk.Block}) == FEET
    path = tmp_path / "block.toml"
    path.write_text(
        'units = "cm"\n[block]\nwidth = 80\nheight = 200\ndepth = 50\ndensity = 2000\nfeet = [5, 70]\n',
        encoding="utf-8",
    )
    read = rk.read_body(path)
    assert isinstance(read, rk.Block)
    assert read.feet == pytest.approx((0.05, 0.7), rel=1e-12)
    from rocking.bodies.formats.body_file import body_from_toml, body_to_toml

    assert body_from_toml(body_to_toml(FEET)) == FEET
    assert rk.Solid.from_section(FEET).mass == pytest.approx(FEET.mass, rel=1e-12)


@pytest.mark.parametrize(
    ("feet", "says"),
    [
        ((-0.3, 0.3), "feet must be a left and a right foot on the base"),
        ((0.3, 0.9), "on the base"),
        ((0.7, 0.1), "feet must be a left and a right foot"),
        ((0.5, 0.7), "must lie between the feet"),
        (0.1, "feet must be a pair"),
        ((0.1, float("nan")), "right foot must be finite"),
    ],
)
def test_feet_that_carry_no_block(feet: Any, says: str) -> None:
    with pytest.raises(RockingError, match=says):
        rk.Block(width=0.8, height=2.0, feet=feet)
    with pytest.raises(InvalidValueError, match="Remove feet"):
        rk.Block.from_angle(0.2, 1.0, feet=(0.1, 0.3))


def test_parameters_of_a_number_are_refused() -> None:
    with pytest.raises(UnknownModelError, match="a coefficient accepts no parameters, got k"):
        rk.coefficient_of_restitution(BLOCK, 0.9, k=0.5)
