"""Contact mechanics of the planar engine: base, impacts, margins, choice of the mode."""

import math

import numpy as np
import pytest

from rocking.bodies import Block, Region, Section
from rocking.dynamics.plane_frictional.base import (
    BOTH,
    FLIGHT,
    LEFT,
    REST,
    RIGHT,
    ContactState,
    Mode,
    PlaneBase,
    along,
    away,
    kept,
    kinetic,
)
from rocking.dynamics.plane_frictional.event_functions import (
    EventFunction,
    ModeEnd,
    NextMode,
    candidates,
    choose,
    consistent,
    event_functions,
    first_end,
    leading,
    weight_of,
)
from rocking.dynamics.plane_frictional.impact_resolution import Struck, strike, strike_with
from rocking.dynamics.plane_frictional.mode_series import (
    GroundSeries,
    derivative,
    integral,
    mode_series,
    pivot_motion,
    value,
)
from rocking.outcome import Regime

pytestmark = pytest.mark.verifies(room="sliding, hopping and flight")

G = 9.80665
TALL = PlaneBase.of_body(Block(width=1.0, height=2.0))
STILL = GroundSeries([0.0], [G], 0.3)


def _tilted(rotation, spin, slip=0.0):
    """A body on its right foot, which slides at a speed."""
    r_x, r_z = TALL.arm(RIGHT, rotation)
    return ContactState(0.0, TALL.rise_on(RIGHT, rotation), rotation, slip - r_z * spin, r_x * spin, spin, (RIGHT,))


def test_footing_of_a_block_is_its_half_sizes():
    """b = 0.5 m, h = 1 m, I_C / m = (b^2 + h^2) / 3; the levers have signs."""
    assert (TALL.left, TALL.right, TALL.height) == (0.5, 0.5, 1.0)
    assert TALL.inertia == pytest.approx(1.25 / 3.0, rel=1e-15, abs=0.0)
    assert (TALL.lever(LEFT), TALL.lever(RIGHT)) == (-0.5, 0.5)


def test_footing_of_a_section_with_other_feet():
    """Feet at 0.1 and 0.7 m under a centre at 0.5 m."""
    body = Section([Region([(0, 0), (1, 0), (1, 4), (0, 4)], 1.0)], feet=(0.1, 0.7))
    base = PlaneBase.of_body(body)
    assert base.left == pytest.approx(0.4, rel=1e-14, abs=0.0)
    assert base.right == pytest.approx(0.2, rel=1e-14, abs=0.0)
    assert base.width == pytest.approx(0.6, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("rotation", [-0.4, 1e-9, 0.7])
def test_rise_is_the_height_of_the_centre_over_a_foot(rotation):
    """-r_z - h, without its cancellation."""
    for foot in BOTH:
        assert TALL.rise_on(foot, rotation) == pytest.approx(-TALL.arm(foot, rotation)[1] - TALL.height, abs=2e-16)


def test_modes_have_names():
    """Ten modes, five regimes."""
    modes = [Mode(BOTH), Mode(BOTH, 1), Mode((LEFT,)), Mode((RIGHT,), -1), Mode(())]
    assert [mode.regime for mode in modes] == list(Regime)
    assert [mode.carrier for mode in modes] == ["both", "both", "left", "right", "none"]


@pytest.mark.parametrize("mode", [Mode((RIGHT,)), Mode((RIGHT,), 1), Mode((RIGHT,), -1)])
def test_series_satisfy_newton_and_euler(mode):
    """Forces from the series move the centre and turn the body: m x'' = F_t - m a_x, ..., at three instants."""
    mu, state = 0.3, _tilted(0.2, -0.5, mode.slip * 0.4)
    ground = GroundSeries([1.0, -0.5], [G + 0.4, 0.3], 0.05)
    found = mode_series(TALL, state, mode, ground, mu, 30)
    for at in (0.0, 0.4, 1.0):
        second = [value(derivative(derivative(c)), at) / 0.05**2 for c in (found.x, found.rise, found.rotation)]
        push, lift = 1.0 - 0.5 * at, G + 0.4 + 0.3 * at
        normal, tangential = value(found.normals[RIGHT], at), value(found.tangential, at)
        r_x, r_z = TALL.arm(RIGHT, value(found.rotation, at))
        assert second[0] == pytest.approx(tangential - push, rel=1e-11, abs=1e-11)
        assert second[1] == pytest.approx(normal - lift, rel=1e-11, abs=1e-11)
        assert TALL.inertia * second[2] == pytest.approx(tangential * r_z - normal * r_x, rel=1e-11, abs=0.0)
        assert value(found.rise, at) == pytest.approx(-r_z - TALL.height, abs=1e-14)
        if mode.slip:
            assert tangential == pytest.approx(-mode.slip * mu * normal, rel=1e-14, abs=0.0)


def test_shorter_course_is_the_same_course():
    """Half a course at 1 is the course at 1/2."""
    found = mode_series(TALL, _tilted(0.2, -0.5), Mode((RIGHT,)), STILL, 0.3, 30)
    assert found.shortened(0.5).state(1.0, (RIGHT,))[:6] == pytest.approx(
        found.state(0.5, (RIGHT,))[:6], rel=1e-13, abs=0.0
    )


def test_integral_of_a_product():
    """The integral of (1 + x) (x^2) from 0 to 2 is 8/3 + 4."""
    assert integral(np.array([1.0, 1.0]), np.array([0.0, 0.0, 1.0]), 2.0) == pytest.approx(8.0 / 3.0 + 4.0)


def test_impulses_change_the_momenta():
    """Impulses at the feet account for all three momenta; signs of the laws hold; a wrong sign is caught."""
    state = ContactState(0.0, 0.0, 0.0, 0.7, -1.0, 0.4, BOTH)
    for mu, e in ((0.1, 0.0), (0.5, 0.3), (2.0, 0.6)):
        found = strike(TALL, state, mu, dict.fromkeys(BOTH, e))
        assert isinstance(found, Struck)
        normal, after = found.normal, found.state
        total = sum(normal.values())
        moment = -found.tangential * TALL.height - sum(p * TALL.lever(foot) for foot, p in normal.items())
        assert after.u - state.u == pytest.approx(found.tangential, rel=1e-12, abs=0.0)
        assert after.w - state.w == pytest.approx(total, rel=1e-12, abs=0.0)
        assert TALL.inertia * (after.spin - state.spin) == pytest.approx(moment, rel=1e-12, abs=0.0)
        assert TALL.inertia * (after.spin - state.spin) != pytest.approx(-moment, rel=1e-3)
        assert min(normal.values()) >= 0.0
        assert abs(found.tangential) <= mu * total * (1.0 + 1e-12)
        assert kinetic(TALL, after) < kinetic(TALL, state)


def test_imposed_coefficient_that_presses_the_old_foot_down_is_left_to_complementarity():
    """r = 0 for a slender body with no friction would turn it back: None."""
    height, lever = 1.0, 0.5
    state = ContactState(0.0, 0.0, 0.0, height, -lever, 1.0, BOTH)
    assert isinstance(strike_with(TALL, state, RIGHT, 1e6, 0.0), Struck)
    assert strike_with(TALL, state, RIGHT, 0.0, 0.0) is None


def test_imposed_coefficient_sets_the_place_of_the_impulse():
    """r = 1 - 3 k / (2 (1 + lambda^2) ...): the shares of the feet say where the resultant is, by moments."""
    state = ContactState(0.0, 0.0, 0.0, 1.0, -0.5, 1.0, BOTH)
    found = strike_with(TALL, state, RIGHT, 1e6, 0.85)
    place = 0.5 * (found.normal[RIGHT] - found.normal[LEFT]) / sum(found.normal.values())
    # moments about the centre: j (r - 1) = -h P_t - s P_n with P_t = h (r - 1), P_n = b (r + 1)
    expected = 0.15 * (TALL.inertia + 1.0) / (0.5 * 1.85)
    assert place == pytest.approx(expected, rel=1e-12, abs=0.0)


def test_candidates_are_what_velocities_allow():
    """At rest all nine modes; sliding to the right only those that slide there, and flight."""
    assert len(candidates(TALL, ContactState())) == 10
    assert candidates(TALL, ContactState(u=1.0)) == [Mode(BOTH, 1), Mode((LEFT,), 1), Mode((RIGHT,), 1), FLIGHT]
    assert candidates(TALL, ContactState(rise=1.0, touching=())) == [FLIGHT]


@pytest.mark.parametrize(("rate", "expected"), [(1e-3, Mode((LEFT,))), (-1e-3, REST)])
def test_next_derivative_decides_at_the_threshold(rate, expected):
    """At a_x = g b / h exactly, the push that grows lifts the body and the one that falls lets it rest."""
    found = choose(TALL, ContactState(), GroundSeries([0.5 * G, rate], [G], 0.3), 1.0)
    assert isinstance(found, NextMode)
    assert found.mode == expected


def test_a_slide_that_stops_does_not_turn_round_without_a_push():
    """At v_t = 0 on ground at rest the body rests; under a_x = 0.4 g with mu = 0.3 it slides to the left."""
    assert choose(TALL, ContactState(), STILL, 0.3).mode == REST
    assert choose(TALL, ContactState(), GroundSeries([0.4 * G], [G], 0.3), 0.3).mode == Mode(BOTH, -1)


def test_margins_start_with_their_first_coefficient_that_is_not_rounding():
    """1e-15 counts as zero where rounding is possible, and as above zero where it is not."""
    series = np.array([1e-15, -1.0, 0.0])
    rounded, exact = (EventFunction(ModeEnd.LOSS_OF_CONTACT, series, n, 1.0) for n in (0, 1))
    assert leading(rounded, 1.0, 1e-12) == 1
    assert not consistent([rounded], 1.0, 1e-12)
    assert leading(exact, 1.0, 1e-12) == 0
    assert consistent([exact], 1.0, 1e-12)
    assert first_end([exact], 1.0, 1e-12)[0] == pytest.approx(1e-15)


def test_first_end_is_the_earliest_zero():
    """Of 1 - 2 x and 1 - 4 x^2 ... the one that falls first, with its kind; none where nothing falls."""
    early, late = (
        EventFunction(ModeEnd.LANDING, np.array([1.0, -4.0]), 0, 1.0),
        EventFunction(ModeEnd.LOSS_OF_CONTACT, np.array([1.0, -2.0]), 0, 1.0),
    )
    assert first_end([late, early], 1.0, 1e-12) == (0.25, ModeEnd.LANDING)
    assert first_end([EventFunction(ModeEnd.LOSS_OF_CONTACT, np.array([1.0, 2.0]), 0, 1.0)], 1.0, 1e-12) is None


def test_kept_takes_out_rounding_exactly():
    """After `kept` a foot that sticks has v_n = v_t = 0 to the last bit, and a flat body no turn."""
    state = _tilted(0.3, 0.4)._replace(u=0.4001, w=0.2)
    made = kept(TALL, state, (RIGHT,), stick=True)
    assert away(TALL, made, RIGHT) == 0.0
    assert along(TALL, made, RIGHT) == 0.0
    flat = kept(TALL, ContactState(rotation=1e-17, spin=1e-17), BOTH, stick=True)
    assert (flat.rotation, flat.spin, flat.w) == (0.0, 0.0, 0.0)
    assert math.copysign(1.0, kept(TALL, state, (), stick=True).u) == 1.0


AWAY = GroundSeries([-13.9], [-3.25], 0.3)
UNEVEN = PlaneBase(1.0, 0.42, 1.0, 0.65, 1.2)


def test_of_two_motions_that_both_obey_coulomb_the_contact_lasts():
    """On ground that falls faster than g a tilted body at rest may fly; pushed so that its foot sticks instead with
    N > 0 and |T| <= mu N, by the two equations of a foot that does not move, it may do either: it sticks."""
    friction, rotation = 2.3, 0.1
    state = ContactState(0.0, UNEVEN.rise_on(RIGHT, rotation), rotation, touching=(RIGHT,))
    r_x, r_z = UNEVEN.arm(RIGHT, rotation)
    j = UNEVEN.inertia
    # v_t' = T - a_x + r_z theta'', v_n' = N - (g + a_z) - r_x theta'', j theta'' = T r_z - N r_x
    sides = np.array([[1.0 + r_z**2 / j, -r_x * r_z / j], [-r_x * r_z / j, 1.0 + r_x**2 / j]])
    tangential, normal = np.linalg.solve(sides, [AWAY.push[0], AWAY.lift[0]])
    assert 0.0 < abs(tangential) < friction * normal, "it may stick"
    assert -AWAY.lift[0] > 0.0, "and it may fly"
    both = choose(UNEVEN, state, AWAY, friction)
    assert isinstance(both, NextMode)
    assert both.mode == Mode((RIGHT,))
    frictionless = choose(UNEVEN, state, AWAY, 0.0)
    assert isinstance(frictionless, NextMode)
    assert frictionless.mode == FLIGHT


@pytest.mark.parametrize(("size", "unit"), [(1.0, 0.03), (4.0, 0.3), (4.0, 0.6)])
@pytest.mark.parametrize("mode", [Mode((RIGHT,)), Mode((RIGHT,), 1), FLIGHT])
def test_what_counts_as_rounding_is_the_same_for_similar_bodies_and_steps(mode, size, unit):
    """Of bodies alike in shape, with speeds as the root of their size, the first coefficient of each margin that may
    carry rounding has the same part of its scale, over any unit of time."""

    def measured(size, unit):
        base = PlaneBase(1.0, 0.42 * size**2, size, 0.65 * size, 1.2 * size)
        r_x, r_z = base.arm(RIGHT, 0.2)
        spin, slip = -0.5 / math.sqrt(size), mode.slip * 0.4 * math.sqrt(size)
        rise = base.rise_on(RIGHT, 0.2) + (0.1 * size if mode == FLIGHT else 0.0)
        state = ContactState(0.0, rise, 0.2, slip - r_z * spin, r_x * spin, spin, mode.feet)
        found = mode_series(base, state, mode, GroundSeries([1.0], [G + 0.4], unit), 0.3, 12)
        made = event_functions(base, mode, found, 0.3, 12.0)
        return [(margin.kind, margin.series[margin.exact] / margin.scale) for margin in made]

    kinds, parts = zip(*measured(size, unit), strict=True)
    expected_kinds, expected = zip(*measured(1.0, 0.3), strict=True)
    assert kinds == expected_kinds
    assert parts == pytest.approx(expected, rel=1e-12, abs=0.0)
    assert all(part != 0.0 for kind, part in zip(kinds, parts, strict=True) if kind is not ModeEnd.LYING)


@pytest.mark.parametrize(("foot", "spin"), [(RIGHT, 0.8), (LEFT, -0.8)])
@pytest.mark.parametrize("friction", [0.05, 0.15, 10.0])
def test_impulses_of_an_imposed_coefficient_change_the_momenta(foot, spin, friction):
    """Of a body whose feet differ: all three momenta, friction within its cone, the new foot neither leaves nor sinks;
    with enough friction theta' keeps the coefficient, and where it slides it slides against the friction."""
    old = UNEVEN.lever(-foot)
    state = ContactState(0.0, 0.0, 0.0, UNEVEN.height * spin, old * spin, spin, BOTH)
    found = strike_with(UNEVEN, state, foot, friction, 0.6)
    assert isinstance(found, Struck)
    normal, after = found.normal, found.state
    total = sum(normal.values())
    moment = -found.tangential * UNEVEN.height - sum(p * UNEVEN.lever(each) for each, p in normal.items())
    assert after.u - state.u == pytest.approx(found.tangential, rel=1e-12, abs=0.0)
    assert after.w - state.w == pytest.approx(total, rel=1e-12, abs=0.0)
    assert UNEVEN.inertia * (after.spin - state.spin) == pytest.approx(moment, rel=1e-12, abs=0.0)
    assert away(UNEVEN, after, foot) == pytest.approx(0.0, abs=1e-14)
    assert kinetic(UNEVEN, after) < kinetic(UNEVEN, state)
    if friction == 10.0:
        assert found.slip == 0
        assert after.spin / spin == pytest.approx(0.6, rel=1e-12, abs=0.0)
        assert along(UNEVEN, after, foot) == pytest.approx(0.0, abs=1e-14)
    else:
        assert found.slip != 0
        assert found.tangential == pytest.approx(-found.slip * friction * total, rel=1e-12, abs=0.0)
        assert along(UNEVEN, after, foot) * found.slip > 0.0


def test_forces_are_measured_by_the_motion_of_the_moment():
    """|g + a_z| + |a_x| now, whatever the ground does afterwards, and something where it falls freely."""
    assert weight_of(GroundSeries([2.0, -30.0], [G - 1.0, 50.0], 0.3)) == pytest.approx(G + 1.0, rel=1e-15, abs=0.0)
    assert weight_of(GroundSeries([-2.0, 30.0], [-3.0, 50.0], 0.3)) == pytest.approx(5.0, rel=1e-15, abs=0.0)
    assert 0.0 < weight_of(GroundSeries([0.0, 1.0], [0.0, 1.0], 0.3)) < 0.01


def test_a_push_that_sets_in_late_turns_a_body():
    """theta'' = -a_x h / (j + h^2) without weight: under a_x = t^5 theta is -t^7 / 84, all terms before it zero."""
    ground = GroundSeries([0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0], 1.0)
    found = pivot_motion(1.0, (0.0, -1.0), (0.0, 0.0), ground, None, 9)
    assert found.rotation == pytest.approx([0.0] * 7 + [-1.0 / 84.0, 0.0, 0.0], abs=1e-16)
