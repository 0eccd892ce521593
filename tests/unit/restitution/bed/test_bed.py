"""What describes a bed: laws against their formulas, points, friction, starts, and what is refused at its doors."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import trapezoid

from rocking.bodies import Block, Region, Section
from rocking.errors import InvalidValueError, MissingExtraError
from rocking.restitution.bed import (
    ContactBed,
    Coulomb,
    Hertz,
    HuntCrossley,
    KelvinVoigt,
    PlasticUnloading,
    RegularisedCoulomb,
    bed_impact,
    bed_impacts,
    fast,
    laws,
    setup_of,
)
from rocking.restitution.bed.laws import LawKind, LawNumbers, force, stored
from rocking.restitution.bed.reference import Field
from rocking.restitution.bed.setup import RigidRocking, settlement

BLOCK = Block(width=0.2, height=0.4)
LAW = KelvinVoigt(1e8, damping_ratio=0.5)
ZERO = np.zeros(1)
G = 9.80665


def test_plastic_unloading_returns_its_share() -> None:
    """The area under unloading is e^2 times the area under loading, and it is what `stored` says."""
    law = PlasticUnloading(100.0, rebound=0.5).numbers(1.0)
    depth = np.linspace(0.0, 2.0, 200_001)
    back = laws.force(law, depth, -np.ones_like(depth), np.full_like(depth, 2.0))
    assert trapezoid(back, depth) == pytest.approx(0.25 * 200.0, rel=1e-6)
    assert laws.stored(law, np.array([2.0]), np.array([2.0]))[0] == pytest.approx(50.0)


def test_depth_under_a_load() -> None:
    """The static depth carries the load on one foot of two, for every law with stiffness."""
    for law in (LAW, HuntCrossley(1e9), Hertz(1e9, 0.01)):
        numbers, rigid = law.numbers(10.0), RigidRocking.of_body(BLOCK, ContactBed.uniform(BLOCK, 2, law), G)
        depth, _ = settlement(rigid, numbers, 0.3, 250.0)
        assert laws.force(numbers, np.array([depth]), ZERO, ZERO)[0] == pytest.approx(500.0, rel=1e-12, abs=0.0)


def test_layer_stiffness() -> None:
    """k = E_eff A / t."""
    assert KelvinVoigt.from_layer(1e9, 0.04, 0.02, confinement=1.5).stiffness == pytest.approx(3e9)


def test_uniform_points_reach_both_feet() -> None:
    """The law is the whole bed's: shares add up to one, ends count half."""
    bed = ContactBed.uniform(BLOCK, 5, LAW)
    assert bed.positions == pytest.approx([-0.1, -0.05, 0.0, 0.05, 0.1])
    assert bed.shares == pytest.approx([0.125, 0.25, 0.25, 0.25, 0.125])
    assert bed.ends == pytest.approx((-0.1, 0.1))


def test_the_other_foot_sees_the_mirror() -> None:
    """Landing on the left of a body is landing on the right of its mirror image."""
    body = Section([Region([(0, 0), (0.3, 0), (0.1, 0.6), (0.0, 0.6)], 2000.0)])
    for points in (2, 7):
        left = ContactBed.uniform(body, points, LAW, foot="left")
        mirror = ContactBed.uniform(body.mirrored(), points, LAW)
        assert left.positions == pytest.approx(mirror.positions)
        # a rectangle and a triangle of one area: the centre is (.05 + .5 / 3) / 2 from the left foot
        right = ContactBed.uniform(body, points, LAW).positions
        assert right[[0, -1]] == pytest.approx([-0.325 / 3.0, 0.3 - 0.325 / 3.0])


@pytest.mark.parametrize("rotation", [-0.2, -0.01, 0.02, 0.15])
def test_the_force_under_a_rocking_foot_follows_from_energy(rotation: float) -> None:
    """With T + V constant, m (g + y'') is m g - (m g y')^2 / (I g) + m y'' w^2 over the height y of the centre."""
    body = Section([Region([(0, 0), (0.3, 0), (0.1, 0.6), (0.0, 0.6)], 2000.0)])
    rigid = setup_of(body, ContactBed.uniform(body, 2, LAW), angular_velocity=0.5).rigid
    weight, step, spin = rigid.mass * rigid.gravity, 1e-4, 0.7
    below, here, above = (rigid.potential(rotation + k * step) / weight for k in (-1, 0, 1))
    slope, bend = (above - below) / (2.0 * step), (above - 2.0 * here + below) / step**2
    force = weight - (weight * slope) ** 2 / (rigid.gravity * rigid.inertia_about(rigid.pivot(rotation)))
    # by differences, whose last digits are rounding
    assert rigid.support(rotation, 0.0) == pytest.approx(force, rel=1e-6)
    assert rigid.support(rotation, spin) == pytest.approx(force + rigid.mass * bend * spin**2, rel=1e-5)


@pytest.mark.parametrize(
    ("foot", "ends"), [("right", (-13.0 / 120.0, 23.0 / 120.0)), ("left", (-23.0 / 120.0, 13.0 / 120.0))]
)
def test_two_points_are_the_feet(foot: Any, ends: tuple[float, float]) -> None:
    """A leaning body whose centre is 13/120 m from its left foot: two points stand at its feet, towards the new one,
    and so do the outer ones of more."""
    body = Section([Region([(0, 0), (0.3, 0), (0.1, 0.6), (0.0, 0.6)], 2000.0)])
    for count in (2, 4):
        assert ContactBed.uniform(body, count, LAW, foot=foot).ends == pytest.approx(ends, rel=1e-13, abs=0.0)


@pytest.mark.parametrize("kinematics", ["exact", "small"])
@pytest.mark.parametrize("rotation", [-0.25, 0.2])
def test_support_is_the_weight_and_the_acceleration_of_the_centre(kinematics: Any, rotation: float) -> None:
    """N = m (g + z''), with z from the lift of the base and theta'' from the slope of the potential; the small-base
    kinematics leaves the height of the centre over its base line as it is."""
    body = Section([Region([(0, 0), (0.3, 0), (0.1, 0.6), (0.0, 0.6)], 2000.0)])
    rigid = RigidRocking.of_body(body, ContactBed.uniform(body, 4, LAW, kinematics=kinematics), G)
    velocity, h = 0.7, 1e-4

    def centre(at: float) -> float:
        return rigid.lift(at) + (rigid.height * math.cos(at) if kinematics == "exact" else 0.0)

    turning = -(rigid.potential(rotation + h) - rigid.potential(rotation - h)) / (2.0 * h)
    turning /= rigid.inertia_about(rigid.pivot(rotation))
    slope = (centre(rotation + h) - centre(rotation - h)) / (2.0 * h)
    bend = (centre(rotation + h) - 2.0 * centre(rotation) + centre(rotation - h)) / h**2
    expected = body.mass * (G + slope * turning + bend * velocity**2)
    assert rigid.support(rotation, velocity) == pytest.approx(expected, rel=1e-6)


def test_a_hollow_base_has_no_points_in_its_gap() -> None:
    """Points stand where the base touches, and nowhere else."""
    outline = [(0, 0), (0.1, 0), (0.1, 0.05), (0.3, 0.05), (0.3, 0), (0.4, 0), (0.4, 1), (0, 1)]
    body = Section([Region(outline, 2000.0)])
    positions = ContactBed.uniform(body, 10, LAW).positions
    assert (np.abs(positions) >= 0.1 - 1e-12).all()
    assert positions[[0, -1]] == pytest.approx([-0.2, 0.2])


def test_a_history_hangs_together() -> None:
    """Forces of the points add up to the normal force, k(t) stays on the base, contacts are in order."""
    impact = bed_impact(BLOCK, ContactBed.uniform(BLOCK, 5, LAW), angular_velocity=0.8)
    assert impact.forces.sum(axis=1) == pytest.approx(impact.samples["normal"], rel=1e-9, abs=1e-6)
    assert (impact.forces >= -1e-6).all()
    assert np.nanmax(np.abs(impact.impulse_position)) <= 1.0 + 1e-9
    assert (np.diff(impact.samples["time"]) >= 0.0).all()
    assert (impact.intervals[:, 2] >= impact.intervals[:, 1]).all()
    assert 0.0 < impact.duration < 0.1
    assert -1.0 < impact.mean_impulse_position < 1.0


def test_the_place_of_the_resultant_is_known_where_the_bed_presses() -> None:
    """Through hops too: NaN where the force is not above zero, on the base everywhere else."""
    bed = ContactBed.uniform(BLOCK, 5, KelvinVoigt(BLOCK.mass * (800.0 * math.pi) ** 2, damping_ratio=0.5))
    impact = bed_impact(BLOCK, bed, angular_velocity=1.0)
    assert impact.results["contacts"] > 1
    np.testing.assert_array_equal(np.isnan(impact.impulse_position), impact.samples["normal"] <= 0.0)
    assert np.nanmax(np.abs(impact.impulse_position)) <= 1.0 + 1e-8


def test_depth_of_an_impact_absorbs_its_energy() -> None:
    """Springs take up k d^2 / 2; dashpots alone, at the speed of the new foot 0.2 theta_dot', c v d; of both the less;
    and no impact goes deeper than the base is long."""
    landing, c, k = 0.8, 1e5, 1e7
    energy = 0.5 * BLOCK.mass * (1.0 / 12.0 * 0.2 + 0.05) * landing**2  # (b^2 + h^2) / 12 and R^2 = 0.05 m2

    def start(law: KelvinVoigt) -> Any:
        return setup_of(BLOCK, ContactBed.uniform(BLOCK, 5, law), angular_velocity=landing, impulsive=True)

    found = start(KelvinVoigt(0.0, damping=c))
    assert (found.energy, found.speed) == (
        pytest.approx(energy, rel=1e-12, abs=0.0),
        pytest.approx(0.2 * landing, rel=1e-12, abs=0.0),
    )
    assert found.depth == pytest.approx(energy / (c * 0.2 * landing), rel=1e-12, abs=0.0)
    assert start(KelvinVoigt(k)).depth == pytest.approx(math.sqrt(2.0 * energy / k), rel=1e-12, abs=0.0)
    assert start(KelvinVoigt(k, damping=1e6)).depth == pytest.approx(energy / (1e6 * 0.2 * landing), rel=1e-12, abs=0.0)
    assert start(KelvinVoigt(0.0, damping=1.0)).depth == pytest.approx(0.2, rel=1e-12, abs=0.0)


def test_light_bodies_are_struck_where_heavy_ones_are() -> None:
    """A body of 80 g on a bed as much softer has the impulse at the same place, however small it is."""
    places = []
    for density in (1000.0, 1.0):
        block = Block(width=0.2, height=0.4, density=density)
        law = KelvinVoigt(block.mass * (800.0 * math.pi) ** 2, damping_ratio=1.0)
        places.append(bed_impact(block, ContactBed.uniform(block, 5, law), angular_velocity=0.5).mean_impulse_position)
    assert -1.0 < places[0] < 1.0
    assert places[1] == pytest.approx(places[0], rel=1e-6)


@pytest.mark.parametrize("kinematics", ["exact", "small"])
def test_points_sink_at_the_rate_of_their_depth(kinematics: Any) -> None:
    """Of a rough base that turns, slides and falls: the rate of each depth is its difference in time, with
    y' = w cos theta - u sin theta, or w for a small base."""
    bed = ContactBed.uniform(BLOCK, 5, LAW, kinematics=kinematics).with_profile([0.0, 0.01, 0.03, 0.02, 0.0])
    field = Field(setup_of(BLOCK, bed, angular_velocity=0.5))
    theta, u, w, omega, h = 0.12, 0.3, -0.4, 0.7, 1e-5
    falls = w * math.cos(theta) - u * math.sin(theta) if kinematics == "exact" else w

    def points(after: float) -> tuple[Any, Any, Any]:
        state = [-0.01 + after * falls, theta + after * omega, u, w, omega, *[0.0] * 13]
        return field.points(np.array(state))

    differences = (points(h)[0] - points(-h)[0]) / (2.0 * h)
    np.testing.assert_allclose(points(0.0)[1], differences, rtol=0.0, atol=1e-9)


def test_time_allowed_goes_with_the_time_of_the_body() -> None:
    """Four times the gravity halves it, four times the size doubles it."""
    large = Block(width=0.8, height=1.6)
    usual, heavy, grown = (
        setup_of(block, ContactBed.uniform(block, 3, LAW), rotation=0.1, gravity=gravity).longest
        for block, gravity in ((BLOCK, G), (BLOCK, 4.0 * G), (large, G))
    )
    assert heavy == pytest.approx(0.5 * usual, rel=1e-12, abs=0.0)
    assert grown == pytest.approx(2.0 * usual, rel=1e-12, abs=0.0)


def test_rotation_and_velocity_are_the_same_start() -> None:
    """A body let go at a rotation lands with the velocity that energy gives, and the other way round."""
    alpha = math.atan(0.5)
    by_rotation = setup_of(BLOCK, ContactBed.uniform(BLOCK, 2, LAW), rotation=0.3 * alpha)
    height = math.hypot(0.1, 0.2)
    fall = height * (math.cos(0.7 * alpha) - math.cos(alpha))
    inertia = 4.0 / 3.0 * BLOCK.mass * height**2
    landing = math.sqrt(2.0 * BLOCK.mass * by_rotation.gravity * fall / inertia)
    assert by_rotation.landing_velocity == pytest.approx(landing, rel=1e-12, abs=0.0)
    by_velocity = setup_of(BLOCK, ContactBed.uniform(BLOCK, 2, LAW), angular_velocity=landing)
    assert by_velocity.state == pytest.approx(by_rotation.state, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(
    "make",
    [
        lambda: KelvinVoigt(-1.0),
        lambda: KelvinVoigt(0.0),
        lambda: KelvinVoigt(math.nan),
        lambda: KelvinVoigt(1e6, damping=1.0, damping_ratio=0.1),
        lambda: HuntCrossley(1e6, exponent=0.5),
        lambda: Hertz(0.0, 0.1),
        lambda: PlasticUnloading(1e6, rebound=1.5),
        lambda: Coulomb(-0.1),
        lambda: RegularisedCoulomb(0.5, creep=0.0),
        lambda: ContactBed([0.1, -0.1], LAW),
        lambda: ContactBed([-0.1, math.inf], LAW),
        lambda: ContactBed([-0.1, 0.1], LAW, shares=[1.0]),
        lambda: ContactBed([-0.1, 0.1], LAW, shares=[1.0, 0.0]),
        lambda: ContactBed([-0.1, 0.1], "steel"),
        lambda: ContactBed([-0.1, 0.1], LAW, kinematics="large"),
        lambda: ContactBed.uniform(BLOCK, 1, LAW),
        lambda: ContactBed.uniform(BLOCK, 3, LAW, rule="simpson"),
        lambda: bed_impacts([]),
        lambda: bed_impacts([setup_of(BLOCK, ContactBed.uniform(BLOCK, 2, LAW), angular_velocity=1.0)], threads=0),
    ],
)
def test_refusals(make: Any) -> None:
    """What cannot be a bed is refused with one class of error."""
    with pytest.raises(InvalidValueError):
        make()


def test_a_law_that_creeps_is_not_the_one_that_sticks() -> None:
    """Neither friction is a case of the other."""
    assert not isinstance(RegularisedCoulomb(0.3), Coulomb)
    assert not isinstance(Coulomb(0.3), RegularisedCoulomb)


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"rotation": 0.1, "angular_velocity": 1.0},
        {"rotation": 0.5},
        {"angular_velocity": math.nan},
        {"angular_velocity": -1.0},
        {"angular_velocity": 1.0, "tolerance": 0.1},
        {"angular_velocity": 1.0, "tolerance": 0.0},
        {"angular_velocity": 1.0, "tolerance": 9e-14},
        {"angular_velocity": 1.0, "ground_acceleration": (0.0, -20.0)},
    ],
)
def test_impossible_impacts(options: dict[str, Any]) -> None:
    """An impact that cannot be is refused before anything is computed."""
    with pytest.raises(InvalidValueError):
        bed_impact(BLOCK, ContactBed.uniform(BLOCK, 2, LAW), **options)


def test_a_law_that_cannot_carry_the_weight() -> None:
    """Dashpots alone, or points without rebound, need an impulsive impact."""
    for law in (KelvinVoigt(0.0, damping=1e6), PlasticUnloading(1e8, rebound=0.0)):
        with pytest.raises(InvalidValueError, match="impulsive"):
            bed_impact(BLOCK, ContactBed.uniform(BLOCK, 2, law), angular_velocity=1.0)


@pytest.mark.slow
def test_without_the_fast_engine(monkeypatch: pytest.MonkeyPatch) -> None:
    """The reference serves where the extension was not built; asking for the fast one says what is missing."""
    monkeypatch.setattr(fast, "available", lambda: False)
    bed = ContactBed.uniform(BLOCK, 2, KelvinVoigt(2e9, damping_ratio=1.0))
    assert bed_impact(BLOCK, bed, angular_velocity=0.5, tolerance=1e-6).coefficient == pytest.approx(0.7, abs=5e-3)
    assert bed_impacts([setup_of(BLOCK, bed, angular_velocity=0.5, tolerance=1e-6)]).coefficient.shape == (1,)
    with pytest.raises(MissingExtraError):
        bed_impact(BLOCK, bed, angular_velocity=0.5, engine="fast")


def test_many_points_share_the_weight_at_the_start() -> None:
    """With hundreds of points the old foot leans on its neighbours: r settles instead of running away."""
    law = KelvinVoigt(BLOCK.mass * (800.0 * math.pi) ** 2, damping_ratio=1.0)
    setups = [setup_of(BLOCK, ContactBed.uniform(BLOCK, n, law), angular_velocity=1.0) for n in (81, 161, 641)]
    assert np.ptp(bed_impacts(setups).coefficient) < 0.01


K, C, CHI, N = 3.0e5, 700.0, 1.7, 1.5
LAWS = {
    "kelvin-voigt": LawNumbers(LawKind.KELVIN_VOIGT, K, C, 1.0, 0.0, 0.0),
    "hunt-crossley": LawNumbers(LawKind.HUNT_CROSSLEY, K, 0.0, N, CHI, 0.0),
    "plastic": LawNumbers(LawKind.PLASTIC, K, 0.0, 1.0, 0.0, 0.6),
    "without rebound": LawNumbers(LawKind.PLASTIC, K, 0.0, 1.0, 0.0, 0.0),
}


def by_branches(name: str, d: float, v: float, deepest: float) -> float:
    """Return the force of one point (docs/theory/contact_bed.md; plastic unloading after Walton & Braun 1986)."""
    if d <= 0.0:
        return 0.0
    if name == "kelvin-voigt":
        return max(0.0, K * d + C * v)
    if name == "hunt-crossley":
        return K * d**N * max(0.0, 1.0 + CHI * v)
    if name == "without rebound":
        # only new ground resists
        return K * d if d >= deepest and v > 0.0 else 0.0
    if d >= deepest:
        return K * d
    return max(0.0, min(K * d, K / 0.36 * (d - 0.64 * deepest)))


@pytest.mark.parametrize("name", LAWS)
def test_force_of_every_branch(name: str) -> None:
    """Above and in the ground, sinking and rising, on new ground, at its edge and on ground already pressed."""
    depth, speed, deepest = (
        part.ravel()
        for part in np.meshgrid([-1e-3, 0.0, 2e-3, 5e-3, 7e-3], [-9.0, -0.3, 0.0, 0.3], [2e-3, 5e-3, 6.5e-3])
    )
    found = force(LAWS[name], depth, speed, deepest)
    wanted = [by_branches(name, *each) for each in zip(depth, speed, deepest, strict=True)]
    assert found == pytest.approx(np.array(wanted), rel=1e-14, abs=0.0)
    assert np.count_nonzero(wanted) >= 6


@pytest.mark.parametrize("name", LAWS)
def test_stored_energy_is_what_unloading_at_rest_gives_back(name: str) -> None:
    """The integral of the force over the way out, without damping; nothing where there is no rebound."""
    law, deepest = LAWS[name], 5e-3
    depth = np.linspace(0.0, 4e-3, 400_001)
    out = force(
        LawNumbers(law.kind, K, 0.0, law.exponent, 0.0, law.rebound), depth, 0.0 * depth, np.full(depth.size, deepest)
    )
    given = trapezoid(out, depth)
    assert stored(law, np.array([4e-3]), np.array([deepest])) == pytest.approx([given], rel=1e-8, abs=1e-12)
    assert (given == 0.0) == (name == "without rebound")


@pytest.mark.parametrize(("kinematics", "along"), [("exact", True), ("small", False)])
def test_a_body_that_starts_on_a_raised_foot_turns_about_it(kinematics: Any, along: bool) -> None:
    """The old foot, 40 mm above the base line, is at rest: v_B + omega x (s, zeta) = 0; small angles leave zeta out."""
    body = Block(width=1.0, height=4.0)
    rows = ContactBed.uniform(body, 3, KelvinVoigt(1e7, 1e4)).with_profile([0.04, 0.0, 0.02])
    bed = replace(rows, kinematics=kinematics)
    start = setup_of(body, bed, angular_velocity=9.0)
    _, _, u, w, omega = start.state
    s, zeta = float(bed.positions[start.old_foot]), float(bed.heights[start.old_foot])
    assert omega > 1.0
    assert zeta != 0.0
    assert w - s * omega == pytest.approx(0.0, abs=1e-12)
    assert u + zeta * omega * along == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    "numbers", [{"damping": -0.5}, {"damping_ratio": -0.5}, {"damping": 1.0, "damping_ratio": 1.0}]
)
def test_dashpots_that_push_are_refused(numbers):
    """Damping is positive, and stated once."""
    with pytest.raises(InvalidValueError, match="damping"):
        KelvinVoigt(1e6, **numbers).numbers(1000.0)


NARROW = Block(width=0.2, height=0.4).with_feet(0.02, 0.2)
STUCK = ContactBed.uniform(NARROW, 2, KelvinVoigt(1e9, damping_ratio=1.0))


@pytest.mark.parametrize("engine", ["cuda", "", None, "fastest", 1])
def test_engines_that_do_not_exist(engine):
    """Only the three engines are taken, and the sentence names them."""
    with pytest.raises(InvalidValueError, match="engine must be one of auto, fast, reference, got"):
        bed_impact(NARROW, STUCK, angular_velocity=1.0, engine=engine)


@pytest.mark.parametrize(
    "given", [3.0, None, "ab", (1.0,), (1.0, 2.0, 3.0), [[1.0, 2.0]], (1.0, math.nan), (math.inf, 0.0), ("1", 0.0)]
)
def test_accelerations_that_are_not_two_numbers(given):
    """One number, three, words, infinities: each is refused by its name."""
    for make in (bed_impact, setup_of):
        with pytest.raises(InvalidValueError, match=r"ground[_ ]acceleration must be"):
            make(NARROW, STUCK, angular_velocity=1.0, ground_acceleration=given)


@pytest.mark.parametrize("given", [(0.5, -0.25), [0.5, -0.25], np.array([0.5, -0.25])])
def test_two_numbers_in_any_row(given):
    """A tuple, a list and an array mean the same: the push is the first, gravity changes by the second."""
    setup = setup_of(NARROW, STUCK, angular_velocity=1.0, ground_acceleration=given, gravity=9.75)
    assert (setup.push, setup.rigid.gravity) == (0.5, 9.5)
