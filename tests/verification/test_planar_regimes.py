"""Sliding, hopping and flight: closed forms, Shenton's boundaries, the pure rocking engine, a general-purpose peer."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics.plane_frictional import (
    Regime,
    Start,
    analytic_regime,
    friction_demand,
    regime_at_start,
    regime_map,
)
from rocking.outcome import Outcome, Status

pytestmark = pytest.mark.verifies(room="sliding, hopping and flight")

G = 9.80665
SLENDER = rk.Block(width=1.0, height=4.0)
HAIR = 1e-9
"""Distance from a boundary, over the value, within which a cell of the map is not asked."""


def _noise(count=400, vertical=0.0, seed=3, factor=1.0):
    """Made-up ground motion of 8 s: a burst of 4 rad/s and white noise."""
    rng, time = np.random.default_rng(seed), np.arange(count) * 0.02
    row = 3.2 * np.sin(4.0 * time) * np.exp(-(((time - 4.0) / 2.5) ** 2)) + 0.8 * rng.standard_normal(count)
    up = vertical * np.sin(17.0 * time) * np.exp(-(((time - 4.0) / 2.0) ** 2))
    return rk.GroundMotion(factor * row, 0.02, vertical=up)


def _knock(block, friction, normal_restitution=0.0, restitution=None):
    """The impact of a block that turns onto its right foot."""
    start = Start(rotation=-1e-9, angular_velocity=1e-2)
    response = rk.free_rocking(
        block,
        restitution=restitution,
        friction=friction,
        normal_restitution=normal_restitution,
        start=start,
        duration=1e-3,
    )
    return response, response.impacts[0]


# ---- Shenton's map --------------------------------------------------------------------------------------------------


@pytest.mark.verifies("closed form", "friction that uplift takes, 12 digits", within="1e-11")
@pytest.mark.parametrize(
    ("times_uplift", "demand"), [(1.0, 0.25), (1.5, 0.280575539568), (2.0, 0.30985915493), (5.0, 0.4625)]
)
def test_friction_demand_is_the_reference_value(times_uplift, demand):
    """REF, lambda = 4: what rocking takes at uplift, to its 12 digits."""
    assert friction_demand(SLENDER, 0.25 * times_uplift) == pytest.approx(demand, abs=1e-11)


@pytest.mark.verifies("closed form", "5/3", within="1e-6")
def test_friction_demand_of_very_strong_ground():
    """As A grows the demand tends to 1.6667 at lambda = 4."""
    assert friction_demand(SLENDER, 1e9) == pytest.approx(5.0 / 3.0, rel=1e-6)


def _expected(push, friction, lever=0.25):
    """Boundaries written out for the rectangle of lambda = 4."""
    if push < min(friction, lever):
        return Regime.REST
    if friction < lever:
        return Regime.SLIDE
    sine, cosine = math.sin(math.atan(lever)), math.cos(math.atan(lever))
    turn = 0.75 * (push * cosine - sine)
    return Regime.ROCK if friction > (push - turn * cosine) / (1.0 + turn * sine) else Regime.SLIDE_ROCK


@pytest.mark.slow
@pytest.mark.verifies(
    "closed form", "boundaries of rest, sliding and rocking (Shenton 1996), written out", within="every cell"
)
def test_map_of_complementarity_is_the_map_of_the_closed_forms():
    """Every one of 625 cells, none within a hair of a boundary, has the regime of the closed forms; both signs."""
    pushes, frictions = np.linspace(0.0213, 1.6, 25), np.linspace(0.0107, 1.8, 25)
    expected = np.array([[_expected(a, mu).code for a in pushes] for mu in frictions])
    assert np.array_equal(regime_map(SLENDER, pushes, frictions), expected)
    assert np.array_equal(regime_map(SLENDER, -pushes, frictions), expected)
    assert set(expected.ravel()) == {r.code for r in (Regime.REST, Regime.SLIDE, Regime.ROCK, Regime.SLIDE_ROCK)}


@pytest.mark.verifies("closed form", "the boundary of sliding while rocking", within="1e-9", control="within")
@pytest.mark.parametrize("push", [0.4, 0.5, 1.25])
def test_regimes_change_within_a_hair_of_the_boundaries(push):
    """The slide-rock boundary is met to 1e-9; a map with 1 % less demand would be caught (negative control)."""
    demand = friction_demand(SLENDER, push)
    assert regime_at_start(SLENDER, push, demand * (1.0 + HAIR)) is Regime.ROCK
    assert regime_at_start(SLENDER, push, demand * (1.0 - HAIR)) is Regime.SLIDE_ROCK
    assert regime_at_start(SLENDER, push, 0.99 * demand) is not Regime.ROCK


@pytest.mark.verifies("closed form", "A = mu", within="1e-9")
@pytest.mark.parametrize("mu", [0.1, 0.24])
def test_rest_and_sliding_part_at_the_friction(mu):
    """Below b / h the body slides at A = mu, to 1e-9."""
    assert regime_at_start(SLENDER, mu * (1.0 - HAIR), mu) is Regime.REST
    assert regime_at_start(SLENDER, mu * (1.0 + HAIR), mu) is Regime.SLIDE


@pytest.mark.verifies("closed form", "a_z = -g", within="between 0.999 and 1.001 of it")
def test_ground_that_falls_faster_than_the_body_lets_it_fly():
    """Below a_z = -g no foot carries; above it, without a push, both do."""
    assert regime_at_start(SLENDER, 0.0, 0.5, vertical=-1.001) is Regime.FLIGHT
    assert regime_at_start(SLENDER, 0.0, 0.5, vertical=-0.999) is Regime.REST


@pytest.mark.verifies("closed form", "b / h of each foot")
def test_a_body_that_leans_rocks_sooner_onto_its_near_foot():
    """Feet at 0.1 and 0.7 m under a centre at 0.5 m: b / h is 0.1 to the right and 0.2 to the left."""
    body = rk.Section([rk.Region([(0, 0), (1, 0), (1, 4), (0, 4)], 1.0)], feet=(0.1, 0.7))
    assert regime_at_start(body, -0.15, 1.0) is Regime.ROCK
    assert regime_at_start(body, 0.15, 1.0) is Regime.REST
    assert analytic_regime(body, -0.15, 1.0) is Regime.ROCK


# ---- impacts --------------------------------------------------------------------------------------------------------


@pytest.mark.verifies("closed form", "Housner's coefficient", within="1e-9", doi="10.1785/BSSA0530020403")
@pytest.mark.parametrize("slenderness", [0.75, 1.0, 2.0, 4.0, 8.0])
def test_much_friction_gives_housner(slenderness):
    """Above 1 / sqrt(2), r = (2 lambda^2 - 1) / (2 lambda^2 + 2), one foot takes the blow."""
    _, impact = _knock(rk.Block(width=1.0, height=slenderness), 10.0)
    r = (2.0 * slenderness**2 - 1.0) / (2.0 * slenderness**2 + 2.0)
    assert impact["velocity_after"] / impact["velocity_before"] == pytest.approx(r, rel=1e-9, abs=0.0)
    assert impact["normal_left"] == 0.0
    assert not impact["slips"]


@pytest.mark.verifies("closed form", "h/b = 1 / sqrt 2")
@pytest.mark.parametrize("slenderness", [0.3, 0.6, 0.7])
def test_squat_bodies_stop(slenderness):
    """Below 1 / sqrt(2) both feet take a blow and the body stops."""
    response, impact = _knock(rk.Block(width=1.0, height=slenderness), 10.0)
    assert impact["velocity_after"] == 0.0
    assert impact["normal_left"] > 0.0
    assert impact["normal_right"] > 0.0
    assert response.regimes["regime"][-1] == "REST"


@pytest.mark.verifies("closed form", "0.25 without friction, 0.7 from mu = 6/17 on", within="1e-9")
@pytest.mark.parametrize(("mu", "r"), [(0.0, 0.25), (6.0 / 17.0, 0.7), (0.5, 0.7)])
def test_impact_with_friction_is_the_reference_value(mu, r):
    """Impact with friction, REF, lambda = 2: r(0) = 0.25, r(6/17) = 0.7, and 0.7 beyond."""
    _, impact = _knock(rk.Block(width=1.0, height=2.0), mu)
    assert impact["velocity_after"] / impact["velocity_before"] == pytest.approx(r, rel=1e-9, abs=0.0)


@pytest.mark.verifies("closed form", "r(mu) of one foot that slips", within="1e-9", control="within")
@pytest.mark.parametrize("mu", [0.05, 0.2, 0.34])
def test_impact_that_slips_is_the_closed_form(mu):
    """An impact that slips: r = (I - m b^2 + mu m b h) / (I + m b^2 - mu m b h); the frictionless one is told apart."""
    block = rk.Block(width=1.0, height=2.0)
    inertia, lever, height = 5.0 / 12.0, 0.5, 1.0
    r = (inertia - lever**2 + mu * lever * height) / (inertia + lever**2 - mu * lever * height)
    _, impact = _knock(block, mu)
    assert impact["velocity_after"] / impact["velocity_before"] == pytest.approx(r, rel=1e-9, abs=0.0)
    assert impact["slips"]
    assert abs(impact["velocity_after"] / impact["velocity_before"] - 0.25) > 0.01


@pytest.mark.verifies("closed form", "mu = 0.6 at h/b = 1", within="1e-9")
@pytest.mark.parametrize(("mu", "slips"), [(0.6 * (1.0 + HAIR), False), (0.6 * (1.0 - HAIR), True)])
def test_friction_of_the_impact_without_slip(mu, slips):
    """Impact without slip, REF: lambda = 1 takes mu = 0.6, to 1e-9."""
    assert bool(_knock(rk.Block(width=1.0, height=1.0), mu)[1]["slips"]) is slips


@pytest.mark.verifies("closed form", "1 - 3/2 (1 + e) sin^2 alpha", within="1e-9")
@pytest.mark.parametrize(("slenderness", "bounce"), [(4.0, 0.3), (2.0, 0.5), (2.0, 0.05)])
def test_bouncing_impact_is_the_closed_form(slenderness, bounce):
    """Bouncing: r = 1 - 3/2 (1 + e) sin^2 alpha; the new foot leaves with 2 b e theta'."""
    block = rk.Block(width=1.0, height=slenderness)
    response, impact = _knock(block, 5.0, bounce)
    r = 1.0 - 1.5 * (1.0 + bounce) * math.sin(block.slenderness_angle) ** 2
    assert impact["velocity_after"] / impact["velocity_before"] == pytest.approx(r, rel=1e-9, abs=0.0)
    after = response.trajectory.blows[0].after
    leaving = after.w - block.half_width * after.spin
    assert leaving == pytest.approx(
        block.width * bounce * impact["velocity_before"], rel=1e-6
    )  # dropped 1e-9 rad first
    assert response.regimes["regime"][1] == "FLIGHT"


@pytest.mark.verifies("closed form", "a point that is dropped", within="1e-12")
def test_landing_flat_bounces_as_a_point():
    """Dropped from 0.2 m the feet share the blow, m sqrt(2 g H) (1 + e), and the first bounce is e^2 H high."""
    drop, e = 0.2, 0.4
    response = rk.free_rocking(
        SLENDER, restitution=None, friction=0.3, normal_restitution=e, start=Start(height=drop), duration=1.0
    )
    first = response.impacts[0]
    speed = math.sqrt(2.0 * G * drop)
    blow = SLENDER.mass * speed * (1.0 + e)
    assert first["feet"] == "both"
    assert first["normal_left"] == pytest.approx(0.5 * blow, rel=1e-12, abs=0.0)
    assert first["normal_left"] == first["normal_right"]
    top = first["time"] + e * speed / G
    assert response.at(top)[1] == pytest.approx(e**2 * drop, rel=1e-12, abs=0.0)


@pytest.mark.verifies("closed form", "the sum of all bounces", within="1e-6 in time, 1e-12 in energy")
def test_bounces_accumulate_to_rest():
    """A dropped body stands after sqrt(2 H / g) (1 + e) / (1 - e), and all its energy is booked as lost in impacts."""
    drop, e = 0.2, 0.5
    response = rk.free_rocking(
        SLENDER, restitution=None, friction=0.3, normal_restitution=e, start=Start(height=drop), duration=2.0
    )
    stands = response.regimes[response.regimes["regime"] == "REST"]["start"][0]
    assert stands == pytest.approx(math.sqrt(2.0 * drop / G) * (1.0 + e) / (1.0 - e), rel=1e-6)
    assert response.energy.lost_in_impacts[-1] == pytest.approx(SLENDER.mass * G * drop, rel=1e-12, abs=0.0)


@pytest.mark.verifies("invariant", "the complementarity problem", within="1e-12")
def test_imposed_housner_is_complementarity_with_any_friction():
    """With Housner's r imposed, impacts that stick and that slip are those of the complementarity problem."""
    block = rk.Block(width=1.0, height=2.0)
    for mu in (0.0, 0.2, 0.6):
        given, free = (_knock(block, mu, restitution=r)[1] for r in ("housner", None))
        assert given["velocity_after"] == pytest.approx(free["velocity_after"], rel=1e-12, abs=0.0)
        assert given["slips"] == free["slips"]


@pytest.mark.verifies("closed form", "(h / b) (1 - r) / (1 + r)", within="1e-9", control="within")
def test_imposed_coefficient_is_kept_while_the_foot_sticks():
    """r = 0.85 takes mu = (h / b) (1 - r) / (1 + r): above it r comes out, below it the body loses more."""
    block, r = rk.Block(width=1.0, height=2.0), 0.85
    need = 2.0 * (1.0 - r) / (1.0 + r)
    # with less than 0.353 the foot slides before the impact already
    kept, lost = (_knock(block, mu, restitution=r)[1] for mu in (0.5, 0.5 * need))
    assert kept["velocity_after"] / kept["velocity_before"] == pytest.approx(r, rel=1e-9, abs=0.0)
    assert not kept["slips"]
    assert lost["slips"]
    assert lost["velocity_after"] < 0.99 * r * lost["velocity_before"]


# ---- histories ------------------------------------------------------------------------------------------------------


@pytest.mark.verifies(
    "closed form", "a sliding block under a rectangle (Newmark 1965)", within="1e-12", control="within"
)
def test_block_on_a_rectangular_pulse_slides_as_newmark_says():
    """A pulse A for T: slid (A - mu g) A T^2 / (2 mu g), back to the left; 1 % more friction is told apart."""
    push, duration, mu = 4.0, 0.5, 0.3
    response = rk.simulate(rk.Block(width=1.0, height=1.0), rk.pulses.rectangular(push, duration), None, friction=mu)
    grip = mu * G
    expected = (push - grip) * push * duration**2 / (2.0 * grip)
    assert response.sliding_distance == pytest.approx(expected, rel=1e-12, abs=0.0)
    assert response.displacement[-1] == pytest.approx(-expected, rel=1e-12, abs=0.0)
    wrong = 1.01 * grip
    assert response.sliding_distance != pytest.approx((push - wrong) * push * duration**2 / (2.0 * wrong), rel=1e-3)
    assert response.outcome is Outcome.SLID


@pytest.mark.verifies("closed form", "v^2 / (2 mu g)", within="1e-12")
def test_block_that_is_pushed_stops_where_friction_stops_it():
    """Let go at v on ground at rest it slides v^2 / (2 mu g), and friction takes m v^2 / 2."""
    body, mu, v = rk.Block(width=1.0, height=1.0), 0.25, 1.7
    response = rk.free_rocking(body, restitution=None, friction=mu, start=Start(horizontal_velocity=v), duration=3.0)
    assert response.displacement[-1] == pytest.approx(v**2 / (2.0 * mu * G), rel=1e-12, abs=0.0)
    assert response.energy.lost_in_friction[-1] == pytest.approx(0.5 * body.mass * v**2, rel=1e-12, abs=0.0)
    assert response.friction_usage == pytest.approx(1.0, rel=1e-12, abs=0.0)


@pytest.mark.verifies("closed form", "a parabola and an even spin", within="1e-14", control="within")
def test_flight_is_a_parabola():
    """Thrown with a spin the centre flies on a parabola and the body turns evenly until a foot lands."""
    start = Start(rotation=0.1, height=0.5, angular_velocity=0.7, horizontal_velocity=0.3, vertical_velocity=1.0)
    response = rk.free_rocking(SLENDER, restitution=None, friction=0.4, start=start, duration=0.25)
    state = response.trajectory.samples[0]
    t = response.time
    assert response.regimes["regime"][0] == "FLIGHT"
    assert response.regimes["end"][0] > t[-1]
    assert np.allclose(response.displacement, state[0] + state[3] * t, rtol=0.0, atol=1e-14)
    assert np.allclose(response.rise, state[1] + state[4] * t - 0.5 * G * t**2, rtol=0.0, atol=1e-14)
    assert np.allclose(response.rotation, 0.1 + 0.7 * t, rtol=0.0, atol=1e-14)
    assert not np.allclose(response.rise, state[1] + state[4] * t - 0.5 * 9.81 * t**2, rtol=0.0, atol=1e-8)
    assert response.energy.closure < 1e-13


@pytest.mark.verifies("closed form", "g t^2 / 2", within="1e-12")
def test_ground_that_drops_away_is_seen_from_the_ground():
    """Under a_z = -2 g for 0.1 s the body flies: it rises g t^2 / 2 above the ground in that time."""
    samples = np.zeros(60)
    vertical = np.where(np.arange(60) <= 10, -2.0 * G, 0.0)
    motion = rk.GroundMotion(samples, 0.01, vertical=vertical)
    response = rk.simulate(SLENDER, motion, None, friction=0.4, duration=0.5)
    assert response.rise[10] == pytest.approx(0.5 * G * 0.1**2, rel=1e-12, abs=0.0)
    assert response.outcome is Outcome.FLEW


@pytest.mark.slow
@pytest.mark.verifies(
    "second engine",
    "the reference engine of pure rocking",
    within="1e-9 rad",
    control="test_another_coefficient_is_told_apart_from_the_pure_rocking_engine",
)
@pytest.mark.parametrize("restitution", ["housner", "ked", None])
def test_much_friction_is_the_pure_rocking_engine(restitution, agreement):
    """mu = 1e6 and no bounce: rotations equal the reference engine's to 1e-9 rad over 30 impacts, lifted ground too."""
    body, motion = rk.Block(width=0.9, height=2.0), _noise(vertical=2.0, factor=1.4)
    planar = rk.simulate(body, motion, restitution, friction=1e6, duration=8.0)
    pure = rk.simulate(body, motion, restitution or "housner", engine="reference", duration=8.0, rest_speed=1e-7)
    assert pure.impacts.size > 30
    assert pure.peak_rotation > 0.01
    agreement(np.max(np.abs(planar.rotation - pure.rotation)), 1e-9)
    assert planar.outcome is Outcome.ROCKED
    assert planar.peak_rotation == pytest.approx(pure.peak_rotation, rel=1e-9, abs=0.0)


@pytest.mark.slow
@pytest.mark.verifies("negative control", "0.9 of the coefficient")
def test_another_coefficient_is_told_apart_from_the_pure_rocking_engine():
    """Negative control: with r = 0.9 times Housner's the same comparison fails by more than 1e-6 rad."""
    body, motion = rk.Block(width=0.9, height=2.0), _noise(vertical=2.0, factor=1.4)
    r = 0.9 * (1.0 - 1.5 * math.sin(body.slenderness_angle) ** 2)
    planar = rk.simulate(body, motion, r, friction=1e6, duration=8.0)
    pure = rk.simulate(body, motion, "housner", engine="reference", duration=8.0)
    assert np.max(np.abs(planar.rotation - pure.rotation)) > 1e-6


CASES = [(0.8, 0.5, 0.0), (1.5, 0.8, 0.3), (1.5, 1.4, 0.0), (0.5, 0.2, 0.6), (0.5, 0.5, 0.3)]


def _strong():
    motion = _noise(vertical=12.0)
    return rk.GroundMotion(2.2 * motion.acceleration, 0.02, vertical=motion.vertical)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "balance of energy", within="1e-10", control="within")
@pytest.mark.parametrize(("width", "mu", "bounce"), CASES)
def test_energy_adds_up(width, mu, bounce, agreement):
    """Kinetic + potential + lost = work + initial to 1e-10, through every regime; losses only grow."""
    response = rk.simulate(rk.Block(width=width, height=2.0), _strong(), None, friction=mu, normal_restitution=bounce)
    assert response.status is Status.GOOD
    agreement(response.energy.closure, 1e-10)
    for lost in (response.energy.lost_in_impacts, response.energy.lost_in_friction):
        assert np.all(np.diff(lost) >= -1e-9 * lost[-1])
    kinetic = response.energy.kinetic
    assert np.max(np.abs(response.energy.gap + 1e-6 * kinetic)) > 1e-8 * kinetic.max()  # the check sees 1e-6


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the mirrored body under the mirrored motion", within="every bit")
@pytest.mark.parametrize(("width", "mu", "bounce"), CASES)
def test_mirror_is_exact(width, mu, bounce):
    """The body in a mirror under the motion in a mirror moves as the mirror shows, to the last bit."""
    body, motion = rk.Block(width=width, height=2.0), _strong()
    turned = rk.GroundMotion(-motion.acceleration, 0.02, vertical=motion.vertical)
    one = rk.simulate(body, motion, None, friction=mu, normal_restitution=bounce)
    other = rk.simulate(body.mirrored(), turned, None, friction=mu, normal_restitution=bounce)
    assert np.array_equal(one.rotation, -other.rotation)
    assert np.array_equal(one.displacement, -other.displacement)
    assert np.array_equal(one.rise, other.rise)
    assert np.array_equal(one.impacts["normal_left"], other.impacts["normal_right"])
    assert one.regimes["regime"].tolist() == other.regimes["regime"].tolist()


@pytest.mark.slow
@pytest.mark.verifies(
    "invariant", "forces that press, Coulomb's law, no foot in the ground", within="1e-9 of the weight; 1e-12 m"
)
def test_contact_forces_obey_their_laws_at_every_sample():
    """Feet press, never pull, |F_t| <= mu F_n, no foot is below the ground, and friction acts against sliding."""
    body, mu = rk.Block(width=1.5, height=2.0), 0.8
    response = rk.simulate(body, _strong(), None, friction=mu)
    forces, scale = response.forces, body.mass * G
    assert forces.left.min() >= -1e-9 * scale
    assert forces.right.min() >= -1e-9 * scale
    assert np.all(np.abs(forces.horizontal) <= mu * forces.vertical + 1e-9 * scale)
    sine, cosine = np.sin(response.rotation), np.cos(response.rotation)
    for lever in (-0.75, 0.75):
        assert np.min(response.rise + 1.0 - lever * sine - cosine) > -1e-12
    assert {"REST", "ROCK", "SLIDE_ROCK", "FLIGHT"} <= set(response.regimes["regime"])


@pytest.mark.verifies("invariant", "tolerances of 1e-12 and 1e-15", within="1e-8 rad")
def test_tolerance_does_not_change_a_history():
    """A tolerance of 1e-12 instead of 1e-15 moves rotations by less than 1e-8 rad through sliding and rocking."""
    body = rk.Block(width=1.2, height=2.0)
    pulse = rk.pulses.sine(amplitude=9.0, period=0.9)
    fine, coarse = (rk.simulate(body, pulse, None, friction=0.65, tolerance=t, duration=2.5) for t in (1e-15, 1e-12))
    assert fine.regimes["regime"].tolist() == coarse.regimes["regime"].tolist()
    assert "SLIDE_ROCK" in fine.regimes["regime"]
    assert np.max(np.abs(fine.rotation - coarse.rotation)) < 1e-8


@pytest.mark.verifies("closed form", "Painleve's limit, mu = 4/3 at h/b = 2", within="0.1")
def test_a_foot_dragged_behind_the_paradox_is_struck():
    """Painleve: lambda = 2 sliding forward with mu > 4 / 3 has no force, and sticks in a shock; below not."""
    block = rk.Block(width=1.0, height=2.0)
    start = Start(rotation=1e-6, horizontal_velocity=1.0)
    stuck, fine = (
        rk.free_rocking(block, restitution=None, friction=4.0 / 3.0 + d, start=start, duration=0.01)
        for d in (0.1, -0.1)
    )
    assert (stuck.trajectory.shocks, fine.trajectory.shocks) == (1, 0)
    assert (stuck.status, fine.status) == (Status.GOOD, Status.GOOD)
    assert stuck.impacts["time"].tolist() == [0.0]
    assert abs(stuck.horizontal_velocity[0] - stuck.angular_velocity[0]) < 1e-5, "the foot, 1 m below, sticks"


# ---- a general-purpose peer -----------------------------------------------------------------------------------------

PEER_CASES = [
    (1.0, 1.0, 0.30, 4.0, 0.5, 1.5, "SLIDE"),
    (1.0, 1.0, 0.30, 6.0, 0.3, 1.5, "SLIDE"),
    (1.0, 2.0, 0.55, 7.0, 0.2, 0.4, "SLIDE_ROCK"),
    (1.0, 4.0, 0.28, 5.0, 0.2, 0.35, "SLIDE_ROCK"),
]


def _peer(width, height, mu, push, duration, total):
    """MuJoCo: three joints in the plane, elliptic cone, stiff contacts; the ground's push as a tilt of gravity."""
    mujoco = pytest.importorskip("mujoco")
    step = 1e-4
    contact = f'friction="{mu} 0 0" condim="3" solref="0.002 1" solimp=".999 .9999 1e-5"'
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{step}" gravity="0 0 -{G}" cone="elliptic" impratio="100"/><worldbody>'
        f'<geom type="plane" size="50 50 .1" {contact}/><body pos="0 0 {height / 2}"><joint type="slide" axis="1 0 0"/>'
        f'<joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 1 0"/>'
        f'<geom type="box" size="{width / 2} .5 {height / 2}" mass="1000" {contact}/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    for k in range(round(total / step)):
        model.opt.gravity[0] = -push if (k + 0.5) * step < duration else 0.0
        mujoco.mj_step(model, data)
    return float(data.qpos[0]), float(data.qpos[2])


@pytest.mark.slow
@pytest.mark.verifies(
    "other program", "MuJoCo, steps of 0.1 ms", within="2e-5 of the way slid; 2e-3 where it rocks too", control="within"
)
@pytest.mark.parametrize(("width", "height", "mu", "push", "duration", "total", "regime"), PEER_CASES)
def test_a_general_purpose_engine_agrees(width, height, mu, push, duration, total, regime):
    """MuJoCo (0.1 ms, soft contacts) agrees to 2e-5 of the distance slid, to 2e-3 in sliding and rocking."""
    response = rk.simulate(
        rk.Block(width=width, height=height), rk.pulses.rectangular(push, duration), None, friction=mu, duration=total
    )
    assert regime in response.regimes["regime"]
    x, _, rotation = response.at(total)
    x_peer, rotation_peer = _peer(width, height, mu, push, duration, total)
    tolerance = 2e-5 if regime == "SLIDE" else 2e-3
    assert x_peer == pytest.approx(x, rel=tolerance, abs=0.0)
    assert rotation_peer == pytest.approx(rotation, rel=tolerance, abs=1e-12)
    assert x_peer != pytest.approx(1.01 * x, rel=tolerance, abs=0.0)
