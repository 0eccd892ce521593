"""Assessments: what lifts, what anchors hold, how wide is wide enough, against the engines and closed forms."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking as rk
from rocking.bodies.solid import Solid, box
from rocking.conventions import g
from rocking.decision.assessment._assess import choices
from rocking.decision.remedies import (
    BISECTIONS,
    DAMPING,
    PERIODS,
    STEPS,
    changed,
    isolation,
    lengths_without_uplift,
    lifting_factor,
    remedies,
    tension,
)  # fmt: skip

pytestmark = pytest.mark.verifies(room="studies")

CABINET = rk.Block(width=0.8, height=2.2, depth=1.2, mass=650.0, centre=(0.52, 0.9))
TIME = np.arange(0.0, 2.0, 0.005)
PUSH = rk.GroundMotion(
    8.0 * np.sin(2.0 * np.pi * TIME / 0.8) * (TIME < 0.8), 0.005, 1.5 * np.cos(2.0 * np.pi * TIME / 0.5) * (TIME < 1.0)
)
LEVEL = rk.GroundMotion(PUSH.acceleration, 0.005)


def lifted(body, motion, factor, gravity=g):
    """Whether it leaves the ground either way round, by the reference engine."""
    ways = (body, body.mirrored())
    ends = [rk.simulate(one, motion, 0.85, scale=factor, gravity=gravity, engine="reference").outcome for one in ways]
    return any(end is not rk.Outcome.NO_UPLIFT for end in ends)


def overturned(body, motion, coefficient):
    """Whether it overturns either way round, by the reference engine."""
    ends = [
        rk.simulate(one, motion, coefficient, engine="reference").outcome for one in (body, body.mirrored())
    ]  # fmt: skip
    return any(end is rk.Outcome.OVERTURNED for end in ends)


@pytest.mark.verifies("second engine", "our reference engine at factors beside it", within="1e-3", control="within")
def test_it_lifts_from_the_factor_that_is_said():
    """Just below the factor that lifts a body on no foot the reference engine sees it lift, just above it does, with
    a vertical component too."""
    for motion in (PUSH, LEVEL):
        factor = lifting_factor(CABINET, motion, g)
        assert not lifted(CABINET, motion, factor * (1.0 - 1e-3))
        assert lifted(CABINET, motion, factor * (1.0 + 1e-3))


@pytest.mark.verifies("closed form", "moments about the foot, m (a h - g b) / B", within="1e-12",
                      control="test_less_than_the_anchor_force_lets_it_lift")  # fmt: skip
def test_anchors_hold_the_moments_about_the_feet():
    """Under 5 m/s2 the anchors of each edge hold m (a h - (g + v) b) / B, whichever side the centre is nearer to."""
    flat = rk.GroundMotion([0.0, 5.0, 5.0, 0.0], 0.1, [0.0, -1.0, -1.0, 0.0])
    held = tension(CABINET, flat, 2.0, g)
    for edge, lever in (("left", 0.28), ("right", 0.52)):
        assert held[edge] == pytest.approx(650.0 * (10.0 * 0.9 - (g - 2.0) * lever) / 0.8, rel=1e-12)


@pytest.mark.verifies("negative control")
def test_less_than_the_anchor_force_lets_it_lift():
    """Negative control: a gravity that pulls as hard as the anchors just holds it, 1e-3 less does not."""
    force = tension(CABINET, LEVEL, 1.0, g)["left"]
    assert not lifted(CABINET, LEVEL, 1.0, g + (1.0 + 1e-3) * force * 0.8 / (650.0 * 0.28))
    assert lifted(CABINET, LEVEL, 1.0, g + (1.0 - 1e-3) * force * 0.8 / (650.0 * 0.28))


@pytest.mark.slow
@pytest.mark.verifies("second engine", "our reference engine with each body", control="within")
@pytest.mark.parametrize("name", ["out", "down"])
def test_the_changed_body_just_stands(name):
    """With the base so wide, or the centre so low, a body stands in the reference engine that overturns with two of
    the last steps and the millimetre that it is rounded up to less, and one that is changed as far as the closed form
    says does not even lift."""
    found = remedies(CABINET, [LEVEL], 1.0, g, choices(CABINET, [0.85]), falls=True)
    change = {"out": found.wider, "down": found.lower}[name]
    step = change.length_no_uplift / STEPS / 2.0**BISECTIONS
    assert overturned(CABINET, LEVEL, 0.85)
    assert 0.0 < change.length_no_overturning < change.length_no_uplift
    assert not overturned(changed(CABINET, **{name: change.length_no_overturning}), LEVEL, 0.85)
    assert overturned(changed(CABINET, **{name: change.length_no_overturning - 1e-3 - 2.0 * step}), LEVEL, 0.85)
    assert not lifted(changed(CABINET, **{name: change.length_no_uplift * (1.0 + 1e-6)}), LEVEL, 1.0)
    assert lifted(changed(CABINET, **{name: change.length_no_uplift * 0.98}), LEVEL, 1.0)


@pytest.mark.verifies("invariant", "mirror images, and moments about the feet", within="1e-12", control="within")
def test_a_mirrored_body_needs_the_same():
    """Lengths, forces and factors of a body in a mirror are the same, those of the edges exchanged."""
    twin = CABINET.mirrored()
    assert lifting_factor(twin, PUSH, g) == pytest.approx(lifting_factor(CABINET, PUSH, g), rel=1e-12)
    assert lengths_without_uplift(twin, [PUSH], 1.0, g) == pytest.approx(
        lengths_without_uplift(CABINET, [PUSH], 1.0, g), rel=1e-12
    )
    one, other = tension(CABINET, PUSH, 1.0, g), tension(twin, PUSH, 1.0, g)
    assert (one["left"], one["right"]) == pytest.approx((other["right"], other["left"]), rel=1e-12)
    assert one["left"] > 1.5 * one["right"]


@pytest.mark.verifies("computed anew", "scipy's integrator for the oscillator", within="1e-3", control="within")
def test_isolators_keep_it_from_lifting():
    """At the period of the isolators the floor on them accelerates less than lifts, at the period before it more, and
    moves as far as is said."""
    period, far = isolation(CABINET, [LEVEL], 1.0, g)
    capacity = g * 0.28 / 0.9
    before = PERIODS[np.flatnonzero(period == PERIODS)[0] - 1]

    def answered(natural):
        omega = 2.0 * np.pi / natural

        def rates(t, state):
            ground = np.interp(t, TIME, LEVEL.acceleration)
            return [state[1], -ground - 2.0 * DAMPING * omega * state[1] - omega**2 * state[0]]

        found = solve_ivp(rates, (0.0, 6.0), [0.0, 0.0], max_step=0.005, rtol=1e-8)
        x, v = found.y
        return np.abs(x).max(), np.abs(omega**2 * x + 2.0 * DAMPING * omega * v).max()

    assert answered(period)[0] == pytest.approx(far, rel=1e-3)
    assert answered(period)[1] <= capacity < answered(before)[1]


DEEP = rk.Block(width=0.5, height=1.8, depth=4.0, density=600.0)
SHAKEN = rk.GroundMotion(4.0 * np.sin(2.0 * np.pi * TIME / 0.9) * (TIME < 0.9), 0.005)
UPRIGHT = rk.GroundMotion(np.cos(2.0 * np.pi * TIME / 0.4) * (TIME < 0.8), 0.005)
ALONE = {"friction": 10.0, "count": 4, "contributions": False}


def least_factors(body, **known):
    """The least factor by restitution of a body that hardly slides, under one horizontal component and a vertical."""
    found = rk.assess(body, {"x": SHAKEN, "z": UPRIGHT}, ["housner", "ked", 0.9], **ALONE, **known)
    return {name: each.min_factor for name, each in found.models.items()}, found


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the plane engine's margins of the plane body", within="3e-3",
                      control="test_a_deep_prism_shaken_along_its_depth_has_other_margins")  # fmt: skip
def test_a_deep_prism_has_the_margins_of_the_plane_body():
    """A box as deep as eight widths, shaken across its depth, overturns in space from the factor of the plane body
    on, to the width of the last brackets of both searches (2e-3 and 1e-3), and lifts from the same."""
    solid, in_space = least_factors(Solid.from_section(DEEP), azimuth=0.0)
    plane, alone = least_factors(DEEP)
    assert solid == pytest.approx(plane, rel=3e-3)
    assert in_space.uplift_factors == pytest.approx(alone.uplift_factors, rel=1e-12)
    assert in_space.capacities["static"] == pytest.approx(alone.capacities["static"], rel=1e-12)
    assert in_space.remedies.tension == pytest.approx(alone.remedies.tension, rel=1e-9)


@pytest.mark.slow
@pytest.mark.verifies("negative control")
def test_a_deep_prism_shaken_along_its_depth_has_other_margins():
    """Negative control: the same box turned a quarter round stands up to several times that, and says so."""
    solid, found = least_factors(Solid.from_section(DEEP), azimuth=0.5 * np.pi)
    plane, _ = least_factors(DEEP)
    assert all(solid[name] > 5.0 * plane[name] for name in plane)
    assert not found.standing.is_weakest


@pytest.mark.slow
@pytest.mark.verifies("closed form", "moments about the edge, g d / (h a |cos|)", within="1e-12", control="within")
def test_a_turned_solid_lifts_over_its_edge():
    """A box at an azimuth to one component lifts over the edge whose moment is first, an edge and not a corner; the
    reference engine sees it stand just below."""
    solid, turn = Solid(box(0.5, 0.8, 1.5)), 0.7
    found = rk.assess(solid, SHAKEN, 0.9, azimuth=turn, **ALONE)
    over = [g * half / (0.75 * SHAKEN.peak * abs(part)) for half, part in ((0.25, np.cos(turn)), (0.4, np.sin(turn)))]
    assert found.uplift_factors == pytest.approx([min(over)], rel=1e-12)
    half_width = solid.in_plane(-turn).side("right").half_width
    assert abs(found.uplift_factors[0] - g * half_width / (0.75 * SHAKEN.peak)) > 0.1
    moving = [
        rk.simulate(solid.turned(turn), SHAKEN, 0.9, friction=10.0, scale=k * min(over)).outcome for k in (0.999, 1.01)
    ]
    assert [each is rk.Outcome.NO_UPLIFT for each in moving] == [True, False]
