"""Axes: what each changes, in what order, and what is refused."""

import copy
import math
import pickle

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import SpeedRestitution
from rocking.errors import InvalidValueError
from rocking.studies import axes
from rocking.studies.adaptive_grid import Plane
from rocking.studies.axis import axis_of, main_period, peak_velocity
from rocking.studies.question import changed_body, reference_side

BLOCK = rk.Block(width=0.6, height=2.4, depth=0.5, density=2000.0)
PULSE = rk.pulses.sine(3.0, 0.6)
RECORD = rk.GroundMotion([0.0, 2.0, -4.0, 1.0, 0.0], 0.1)


def case(x, y, *, motion=PULSE, body=BLOCK, restitution="housner", **options):
    """Variation at the point (x[1], y[1]) of two axes."""
    plane = Plane.of(body, motion, (x[0], [x[1]]), (y[0], [y[1]]), restitution, gravity=9.81, **options)
    return plane.case(plane.x.values, plane.y.values)


@pytest.mark.parametrize("name", axes())
def test_every_axis_has_unit_and_words(name):
    """Every axis of the registry says what it is, and takes values within its range only."""
    kind = axes()[name]
    axis = kind([0.3, 0.6])
    assert axis.name == name
    assert set(axis.attributes) == {"units", "long_name"}
    assert axis_of(axis) is axis
    for bad in ([0.6, 0.3], [0.3, 0.3], [0.3, np.nan], [0.3, np.inf], [], [[0.3]], ["a"], -2e9):
        with pytest.raises(InvalidValueError, match=name):
            kind(bad)


@pytest.mark.parametrize("bad", ["scale", ("scale",), ("size", [1.0]), (1, [1.0]), 3, ("scale", [1.0], 2)])
def test_what_is_no_axis_is_refused(bad):
    """A word alone, an unknown name and a number are refused in one sentence."""
    with pytest.raises(InvalidValueError, match="axis"):
        axis_of(bad)


@pytest.mark.parametrize("name", axes())
def test_an_axis_without_values_is_none_of_a_map(name):
    """A row of the registry is refused by a map before it has values; it can be copied, pickled and read."""
    bare = axes()[name]
    with pytest.raises(InvalidValueError, match=f"the axis {name} has no values"):
        axis_of(bare)
    for again in (pickle.loads(pickle.dumps(bare)), copy.copy(bare), copy.deepcopy(bare)):
        assert again is bare
    assert pickle.loads(pickle.dumps(bare([0.3, 0.6]))).values.tolist() == [0.3, 0.6]
    assert " at 0x" not in repr(bare)
    with pytest.raises(InvalidValueError, match=f"the axis {name} has no values"):
        rk.overturning_map(BLOCK, PULSE, bare, ("scale", [1.0]), "housner")


@pytest.mark.parametrize(
    ("x", "y"),
    [("scale", "pga"), ("amplitude_ratio", "scale"), ("period", "frequency_ratio"), ("duration", "period"),
     ("slenderness_ratio", "slenderness_angle"), ("scale", "scale"), ("pgv", "pgv")],
)  # fmt: skip
def test_axes_that_set_the_same_are_refused(x, y):
    """Two axes cannot decide the same thing."""
    with pytest.raises(InvalidValueError, match="both set"):
        case((x, 0.5), (y, 0.5))


def test_classical_axes():
    """omega_p / p and a_p / (g tan alpha) give the pulse whose period and amplitude they say; linear: g alpha."""
    side = BLOCK.side("right", 9.81)
    made = case(("frequency_ratio", 3.0), ("amplitude_ratio", 2.0))
    assert made.stretch * 0.6 == pytest.approx(2.0 * math.pi / (3.0 * side.frequency_parameter), rel=1e-14, abs=0.0)
    assert made.scale * 3.0 == pytest.approx(2.0 * 9.81 * 0.25, rel=1e-14, abs=0.0)
    linear = case(("frequency_ratio", 3.0), ("amplitude_ratio", 2.0), linear=True)
    assert linear.scale * 3.0 == pytest.approx(2.0 * 9.81 * math.atan(0.25), rel=1e-14, abs=0.0)


def test_ratios_follow_the_body():
    """With size or slenderness on the other axis the ratios refer to the changed body."""
    big = case(("semi_diagonal", 5.0), ("frequency_ratio", 3.0))
    assert big.sides["p_right"] == pytest.approx(math.sqrt(0.75 * 9.81 / 5.0), rel=1e-14, abs=0.0)
    assert big.stretch * 0.6 * 3.0 * math.sqrt(0.75 * 9.81 / 5.0) == pytest.approx(2.0 * math.pi, rel=1e-14, abs=0.0)
    slender = case(("amplitude_ratio", 2.0), ("slenderness_ratio", 8.0))
    assert slender.scale * 3.0 == pytest.approx(2.0 * 9.81 / 8.0, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(("motion", "peak"), [(PULSE, 3.0), (RECORD, 4.0)])
def test_pga_against_pgv(motion, peak):
    """PGA scales the motion and PGV stretches its time so that both hold, in either order of the axes."""
    for x, y in ((("pga", 5.0), ("pgv", 0.7)), (("pgv", 0.7), ("pga", 5.0))):
        made = case(x, y, motion=motion)
        assert made.scale * peak == pytest.approx(5.0, rel=1e-14, abs=0.0)
        assert made.scale * made.stretch * peak_velocity(motion) == pytest.approx(0.7, rel=1e-14, abs=0.0)


def test_pgv_alone_scales():
    """With size, or with the period, PGV scales the motion and leaves its time to the other axis."""
    made = case(("pgv", 0.7), ("semi_diagonal", 2.0), motion=RECORD)
    assert (made.scale * peak_velocity(RECORD), made.stretch) == (pytest.approx(0.7), 1.0)
    made = case(("pgv", 0.7), ("period", 1.2))
    assert made.stretch == pytest.approx(2.0)
    assert made.scale * 2.0 * 3.0 * 0.6 / math.pi == pytest.approx(0.7, rel=1e-12, abs=0.0)


def test_measures_of_motions():
    """Velocity of a sine is a_p T / pi, of a rectangle a T; a Ricker wavelet has its period, a rectangle none."""
    assert peak_velocity(PULSE) == pytest.approx(3.0 * 0.6 / math.pi, rel=1e-12, abs=0.0)
    assert peak_velocity(rk.pulses.rectangular(2.0, 0.3)) == pytest.approx(0.6, rel=1e-14, abs=0.0)
    assert peak_velocity(rk.pulses.cosine(3.0, 0.6)) == pytest.approx(3.0 * 0.3 / math.pi, rel=1e-12, abs=0.0)
    assert main_period(rk.pulses.ricker(1.0, 0.7)) == 0.7
    for motion in (rk.pulses.rectangular(2.0, 0.3), RECORD):
        with pytest.raises(InvalidValueError, match="period"):
            case(("period", 1.0), ("scale", 1.0), motion=motion)
        assert case(("duration", 1.2), ("scale", 1.0), motion=motion).stretch == pytest.approx(1.2 / motion.duration)


@pytest.mark.parametrize(
    ("given", "width", "height"),
    [
        ({"slenderness_angle": math.atan(0.5), "semi_diagonal": math.sqrt(5.0)}, 2.0, 4.0),
        ({"slenderness_angle": math.atan(0.5), "height": 3.0}, 1.5, 3.0),
        ({"slenderness_angle": math.atan(0.5), "width": 3.0}, 3.0, 6.0),
        ({"width": 6.0, "semi_diagonal": 5.0}, 6.0, 8.0),
        ({"height": 6.0, "semi_diagonal": 5.0}, 8.0, 6.0),
        ({"width": 1.0}, 1.0, 2.4),
        ({"height": 1.0}, 0.6, 1.0),
        ({"width": 1.0, "height": 7.0}, 1.0, 7.0),
    ],
)
def test_dimensions_of_blocks(given, width, height):
    """Any two dimensions make the block that has them; density and depth stay."""
    made = changed_body(BLOCK, given)
    assert (made.width, made.height) == pytest.approx((width, height), rel=1e-14, abs=0.0)
    assert (made.depth, made.density) == (0.5, 2000.0)


def test_slenderness_alone_keeps_the_semi_diagonal():
    """A slenderness alone turns the diagonal."""
    made = changed_body(BLOCK, {"slenderness_angle": 0.4})
    assert made.semi_diagonal == pytest.approx(BLOCK.semi_diagonal, rel=1e-14, abs=0.0)
    assert made.slenderness_angle == pytest.approx(0.4, rel=1e-14, abs=0.0)


def test_bodies_that_are_no_blocks():
    """Any body can be scaled, about the side that lifts first; only a block can be made more slender."""
    body = BLOCK.with_feet(0.0, 0.5)  # the centre is 0.3 from the left and 0.2 from the right foot
    assert reference_side(body) == "right"
    assert reference_side(body.mirrored()) == "left"
    scaled = changed_body(body, {"semi_diagonal": 3.0})
    assert scaled.side("right").semi_diagonal == pytest.approx(3.0, rel=1e-12, abs=0.0)
    made = case(("frequency_ratio", 3.0), ("amplitude_ratio", 2.0), body=body)
    assert made.scale * 3.0 == pytest.approx(2.0 * 9.81 * 0.2 / 1.2, rel=1e-12, abs=0.0)
    assert made.frequency_parameter == body.side("right", 9.81).frequency_parameter
    for name in ("slenderness_ratio", "slenderness_angle", "width", "height"):
        with pytest.raises(InvalidValueError, match="only for a homogeneous Block on its corners"):
            case((name, 1.0), ("scale", 1.0), body=body)
        with pytest.raises(InvalidValueError, match="only for a Block"):
            case((name, 1.0), ("scale", 1.0), body=body.to_section())


def test_impossible_blocks_fail_alone():
    """A diagonal shorter than the width is no block: that cell is NaN, no other is; none at all is refused."""
    plane = Plane.of(BLOCK, PULSE, ("width", [1.0, 5.0]), ("semi_diagonal", [1.0, 3.0]), "housner", gravity=9.81)
    sides = plane.case(*plane.mesh()).sides["alpha_right"]
    assert np.isnan(sides).tolist() == [False, True, False, False]
    assert plane.answers(*plane.mesh())[0]["mode"][1] == -3
    with pytest.raises(InvalidValueError, match="no block"):
        case(("width", 5.0), ("semi_diagonal", 1.0))


def test_restitution_axis():
    """A coefficient replaces that of the model on both sides; where it would create energy the cell has no result."""
    made = case(("restitution", 0.8), ("scale", 1.0))
    assert (made.sides["r_right"], made.sides["r_left"]) == (0.8, 0.8)
    body = BLOCK.with_feet(0.0, 0.5)
    inertia = [body.side(foot).moment_of_inertia for foot in ("left", "right")]
    most = math.sqrt(min(inertia) / max(inertia))
    assert np.isfinite(case(("restitution", most), ("scale", 1.0), body=body).sides["r_right"])
    assert np.isnan(case(("restitution", most + 1e-6), ("scale", 1.0), body=body).sides["r_right"])


def test_restitution_is_evaluated_for_each_body():
    """Housner's coefficient follows the slenderness: r = 1 - 1.5 sin^2 alpha."""
    made = case(("slenderness_angle", 0.3), ("scale", 1.0))
    assert made.sides["r_left"] == pytest.approx(1.0 - 1.5 * math.sin(0.3) ** 2, rel=1e-12, abs=0.0)


def test_zero_motion_has_no_amplitude():
    """What is zero throughout cannot be scaled to anything."""
    still = rk.GroundMotion([0.0, 0.0, 0.0], 0.1)
    for name in ("scale", "pga", "pgv", "amplitude_ratio"):
        with pytest.raises(InvalidValueError, match="the motion is zero"):
            case((name, 1.0), ("semi_diagonal", 1.0), motion=still)


def test_speed_laws_do_not_stretch():
    """A coefficient that depends on rad/s forbids axes that stretch time, and allows the others."""
    law = SpeedRestitution([0.0, 1.0], [0.9, 0.7])
    for name in ("period", "frequency_ratio", "duration"):
        with pytest.raises(InvalidValueError, match="does not depend on the speed"):
            case((name, 1.0), ("scale", 1.0), restitution=law)
    plane = Plane.of(BLOCK, PULSE, ("pga", [5.0]), ("pgv", [0.5]), law, gravity=9.81)
    with pytest.raises(InvalidValueError, match="does not depend on the speed"):
        plane.answers(*plane.mesh())
    assert case(("scale", 1.0), ("semi_diagonal", 1.0), restitution=law).count == 1


def test_values_cannot_be_changed():
    """The values of an axis are a copy of the user's, and fixed."""
    given = np.array([1.0, 2.0])
    axis = axis_of(("scale", given))
    given[0] = 5.0
    assert axis.values.tolist() == [1.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        axis.values[0] = 3.0


def test_a_law_of_impact_does_not_multiply_an_axis_of_restitution():
    """Coefficients on an axis are what they say: a law, whose factors would multiply them, is refused."""
    axes = ("restitution", [0.8, 0.9]), ("scale", [1.0])
    for law in (SpeedRestitution([0.0, 1.0], [0.9, 0.7]), rk.dynamics.RandomRestitution.normal(0.9, 0.01, seed=1)):
        with pytest.raises(InvalidValueError, match=r"restitution is an axis\. Remove the impact law, got "):
            Plane.of(rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6), *axes, law, gravity=9.81)


def test_a_scale_of_zero_has_no_velocity():
    """A motion scaled to nothing cannot be stretched to a velocity: refused in one sentence, without warnings."""
    axes = ("scale", [-1.0, 0.0, 1.0]), ("pgv", [0.5])
    for x, y in (axes, axes[::-1]):
        with pytest.raises(InvalidValueError, match="pgv cannot be set for scale 0"):
            Plane.of(rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6), x, y, 0.9, gravity=9.81)
    between = Plane.of(BLOCK, PULSE, ("scale", [-1.0, 1.0]), axes[1], 0.9, gravity=9.81)
    with pytest.raises(InvalidValueError, match="pgv cannot be set for scale 0"):
        between.case(np.zeros(1), np.full(1, 0.5))
