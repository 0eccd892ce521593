"""Inventories: what is drawn is what the measurements leave open; what the plan says is saved stands."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rocking import simulate, simulate_many
from rocking.conventions import FEET
from rocking.decision.inventory import InventoryObject, Thresholds, assess
from rocking.decision.inventory.draws import Draws, restitutions, slenderest
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.decision.inventory.lights import Light
from rocking.decision.inventory.ranking import advice, plan_words
from rocking.decision.inventory.retrofits import Planner, _Subject
from rocking.decision.remedies import changed
from rocking.evidence import restitution_distribution
from rocking.language import language
from rocking.outcome import Outcome
from rocking.restitution import ImpactGeometry
from rocking.restitution.calibrated import KEPT, drawn, kept

pytestmark = pytest.mark.verifies(room="studies")

_SAMPLES = len(kept(KEPT)["samples"])
# the base is not in the middle of what it carries, nor the centre at half the height
URN = InventoryObject(
    name="urn", width=0.3, depth=0.26, height=0.9, base_width=0.17, base_depth=0.2, centre_of_mass_height=0.42,
    mass=12.0, count=3,
)  # fmt: skip


@pytest.fixture(scope="module")
def quakes():
    """Synthetic motions at PGA 0.3 g, enough for green."""
    return Hazard.of_family("firm-ground", IntensityLevel.of("PGA", "0.3g"), count=80, seed=3)


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "quantiles of the evidence, by Newton on the mixture", within="0.001")
@pytest.mark.parametrize("ratio", [1.6, 4.0, 9.0])
def test_draws_are_the_distribution_of_the_evidence(ratio):
    """Quantiles of draws, of each sample and its scatter in turn, are those of the mixture solved for."""
    which, at = (
        each.ravel() for each in np.meshgrid((np.arange(_SAMPLES) + 0.5) / _SAMPLES, (np.arange(100) + 0.5) / 100)
    )
    found = np.sort(drawn(ImpactGeometry.of_slenderness(ratio), which, at))
    probabilities = np.linspace(0.02, 0.98, 49)
    wanted = restitution_distribution(ratio).quantile(probabilities)
    np.testing.assert_allclose(np.quantile(found, probabilities), wanted, rtol=0.0, atol=0.001)


@pytest.mark.verifies("negative control")
def test_draws_without_scatter_are_not():
    """At the middle of the scatter alone, the ends are nearer to one another than those of the evidence."""
    which = (np.arange(400) + 0.5) / 400
    found = drawn(ImpactGeometry.of_slenderness(4.0), which, np.full(400, 0.5))
    wanted = restitution_distribution(4.0).quantile([0.02, 0.98])
    assert np.ptp(np.quantile(found, [0.02, 0.98])) < 0.8 * np.ptp(wanted)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the order of rows, other rows, threads", within="nothing: equal")
def test_a_verdict_hangs_on_no_other_row(quakes):
    """Alone, in another order, among others and with other threads an object of approximate sizes fares the same."""
    vague = replace(URN, approximate={"height": 0.05, "base_width": 0.02})
    others = [replace(URN, name="other", row=7), InventoryObject(name="box", width=0.4, depth=1.0, height=1.7, row=8)]
    alone = assess([vague], quakes, threads=1)
    for objects in ([vague, *others], [*others, vague]):
        found = {each.item.name: each.results for each in assess(objects, quakes, threads=2).verdicts}
        assert found["urn"] == alone.verdicts[0].results
    again = Hazard(quakes.motions, quakes.level, quakes.source, {**quakes.description, "seed": 4})
    assert assess([vague], again).verdicts[0].results != alone.verdicts[0].results  # the same motions, other draws


@pytest.mark.verifies("invariant", "sizes within their intervals", within="nothing: none outside")
def test_sizes_are_drawn_evenly_within_their_intervals():
    """Each stratum of each interval once; a round object stays round; it lifts first at the ends that say so."""
    vague = replace(URN, approximate={"height": 0.09, "centre_of_mass_height": 0.03, "base_width": 0.02})
    bodies = Draws(100, 5).bodies(vague)
    for name, half in vague.approximate.items():
        shares = np.sort([(getattr(each, name) - getattr(URN, name)) / half for each in bodies])
        assert np.floor((shares + 1.0) * 2.5).tolist() == list(range(5))
    first = slenderest(vague)
    assert (first.height, first.centre_of_mass_height, first.base_width) == pytest.approx((0.99, 0.45, 0.15))
    round_one = replace(URN, shape="round", depth=0.3, base_depth=0.17, approximate={"width": 0.02, "depth": 0.02})
    assert all(each.width == each.depth for each in Draws(100, 5).bodies(round_one))


def fallen(item, way, quakes, draws, *, out=0.0, down=0.0, weaker=0.0):
    """Motions that overturn an object that is changed, by the one-history engine and the blocks of remedies."""
    body = changed(item.body(way), True, out=out, down=down) if out or down else item.body(way)
    pairs = restitutions(draws, [body])
    count = 0
    for k, motion in enumerate(quakes.motions):
        own = {foot: float(pairs[foot][k]) for foot in FEET}
        scaled = replace(motion, acceleration=(1.0 - weaker) * motion.acceleration)
        count += simulate(body, scaled, restitution=own).outcome is Outcome.OVERTURNED
    return count


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew",
    "one history after another, of the changed block",
    within="no motion",
    control="test_half_a_remedy_does_not_serve",
)
@pytest.mark.parametrize("remedy", ["out", "down", "weaker"])
def test_what_the_plan_saves_stands(quakes, remedy):
    """Changed as the plan says, no motion overturns it in either direction; as it is, as many as the verdict says."""
    found = assess([URN], quakes)
    (entry,), (verdict,) = found.plan, found.verdicts
    steps = {"out": entry.wider, "down": entry.lower, "weaker": 1.0 - entry.weaker}
    draws = Draws(len(quakes.motions), quakes.description["seed"])
    assert entry.directions == ("width", "depth")
    for way in entry.directions:
        assert fallen(URN, way, quakes, draws, **{remedy: steps[remedy]}) == 0
    if remedy == "out":
        worse = verdict.worse
        assert fallen(URN, worse.direction, quakes, draws) == worse.overturned > 8
        assert entry.spared == pytest.approx(3 * worse.overturned / 80)


@pytest.mark.verifies(
    "closed form",
    "a mass point at the floor beside those of the object",
    within="1e-12",
    control="test_ballast_without_its_inertia_is_another_body",
)
@pytest.mark.parametrize("kind", [{"shape": "round", "depth": 0.3, "base_depth": 0.17}, {}])
def test_ballast_counts_with_its_inertia(quakes, kind):
    """Angle, frequency and inertia of the lowered object are those of its mass points and one more below its centre."""
    item = replace(URN, **kind)
    planner = Planner(quakes, Draws(len(quakes.motions), 0), None, 9.80665, 1, lambda *_: True)
    found = _Subject(planner, item, ("width",)).sides("width", down=0.15)
    whole, inertia = with_ballast(item.body("width"), 0.15)
    assert whole == pytest.approx(12.0 * 0.42 / 0.27, rel=1e-12)
    height, half = 0.27, 0.5 * 0.17
    square = height**2 + half**2
    about_foot = inertia + whole * square
    assert found["alpha_right"][0] == pytest.approx(math.atan2(half, height), rel=1e-12)
    assert found["p_right"][0] == pytest.approx(math.sqrt(whole * 9.80665 * math.sqrt(square) / about_foot), rel=1e-12)
    assert found["q_right"][0] == pytest.approx(whole * square / about_foot, rel=1e-12)
    block = changed(item.body("width"), True, down=0.15)
    assert (block.mass, block.moment_of_inertia) == pytest.approx((whole, inertia), rel=1e-12)


def with_ballast(body, down):
    """Mass and central moment of inertia of a body with a point at the floor that brings its centre down so far."""
    height = body.side("right").centre_height
    added = body.mass * down / (height - down)
    lowered = height * body.mass / (body.mass + added)
    assert lowered == pytest.approx(height - down, rel=1e-12)
    inertia = body.moment_of_inertia + body.mass * (height - lowered) ** 2 + added * lowered**2
    return body.mass + added, inertia


@pytest.mark.verifies("negative control")
def test_ballast_without_its_inertia_is_another_body():
    """A third of the way down it takes more than a tenth of the inertia: left out, the object would turn faster."""
    body = URN.body("width")
    whole, inertia = with_ballast(body, 0.15)
    bare = changed(body, down=0.15)
    assert abs(inertia / whole / (bare.moment_of_inertia / bare.mass) - 1.0) > 0.03


@pytest.mark.slow
@pytest.mark.verifies("negative control")
def test_half_a_remedy_does_not_serve(quakes):
    """Half of each change leaves motions that overturn it: what is printed is no more than what it takes."""
    found = assess([URN], quakes)
    (entry,) = found.plan
    draws = Draws(len(quakes.motions), quakes.description["seed"])
    way = found.verdicts[0].worse.direction
    for change in ({"out": 0.5 * entry.wider}, {"down": 0.5 * entry.lower}, {"weaker": 0.5 * (1.0 - entry.weaker)}):
        assert fallen(URN, way, quakes, draws, **change) > 0


@pytest.mark.verifies("closed form", "moments about the edge, m (a h - g b) over the base", within="1e-12")
def test_anchors_hold_what_lifts():
    """The force along an edge balances the moments at the peak; with it on a lever of the whole base nothing lifts."""
    level = 0.4
    hazard = Hazard.of_family("firm-ground", IntensityLevel("PGA", level * 9.80665), count=2, seed=1)
    (entry,) = assess([URN], hazard).plan
    height, bases = 0.42, (0.17, 0.2)
    wanted = max((level * height - 0.5 * base) / base for base in bases)
    assert entry.pull == pytest.approx(wanted, rel=1e-12)
    assert entry.force == pytest.approx(wanted * 12.0 * 9.80665, rel=1e-12)
    assert entry.shear == pytest.approx(level, rel=1e-12)


@pytest.mark.slow
@pytest.mark.verifies("closed form", "pieces times share times weight", within="1e-12")
def test_the_plan_is_sorted_by_weighted_gain(quakes):
    """Four of the same weigh four times, one of high consequence 2.5 times, one of low half: so they are sorted."""
    kinds = {"one": {}, "four": {"count": 4}, "dear": {"consequence": "high"}, "cheap": {"consequence": "low"}}
    objects = [replace(URN, **{"count": 1, **kind}, name=name) for name, kind in kinds.items()]
    found = assess(objects, quakes)
    share = found.verdicts[0].worse.overturned_fraction
    assert [each.item.name for each in found.plan] == ["four", "dear", "one", "cheap"]
    assert [each.gain for each in found.plan] == pytest.approx(
        [4.0 * share, 2.5 * share, share, 0.5 * share], rel=1e-12
    )
    assert found.pieces() == {Light.RED: 6, Light.AMBER: 1, Light.GREEN: 0}


@pytest.mark.verifies("behaviour")
def test_where_nothing_serves_it_is_said():
    """A vertical motion that takes all of the weight: neither a base nor a lower centre serves, and none is made up."""
    hazard = Hazard.of_family("firm-ground", IntensityLevel.of("PGA", "0.3g"), count=2, seed=1)
    motion = hazard.motions[0]
    lifted = replace(motion, vertical=1.2 * 9.80665 * motion.acceleration / np.abs(motion.acceleration).max())
    (entry,) = assess([URN], Hazard.of_records([lifted]), restitution=0.9).plan
    assert (entry.wider, entry.lower) == (None, None)
    assert entry.pull > 0.5


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the seed of the draws", within="nothing: equal")
def test_a_named_restitution_stays_fixed(quakes):
    """Of a coefficient by number, whatever the seed of the draws: the same verdicts, and a plan that holds with it."""
    again = Hazard(quakes.motions, quakes.level, quakes.source, {**quakes.description, "seed": 4})
    one, two = (assess([URN], each, restitution=0.9) for each in (quakes, again))
    assert one.verdicts[0].results == two.verdicts[0].results
    (entry,) = one.plan
    assert (entry.wider, entry.lower) == (two.plan[0].wider, two.plan[0].lower)
    body = changed(URN.body("width"), out=entry.wider)
    outcomes = {simulate(body, each, restitution=0.9).outcome for each in quakes.motions}
    assert Outcome.OVERTURNED not in outcomes


@pytest.mark.verifies("closed form", "shares times the factor of the consequence", within="nothing: equal")
def test_consequences_move_the_shares():
    """10 of 100 is amber, 30 red; of high consequence 10 is red and 0 too few, of low 30 is amber."""
    counted = {"lifted": 100, "count": 100, "high_rotation": 0.1}
    lights = {
        (consequence, fell): Thresholds().of(consequence).light(overturned=fell, **counted)
        for consequence in ("low", "medium", "high") for fell in (0, 10, 30)
    }  # fmt: skip
    green, amber, red = Light.GREEN, Light.AMBER, Light.RED
    assert [lights["medium", fell] for fell in (0, 10, 30)] == [green, amber, red]
    assert [lights["low", fell] for fell in (0, 10, 30)] == [green, amber, amber]
    assert [lights["high", fell] for fell in (0, 10, 30)] == [amber, red, red]
    assert (Thresholds().needed, Thresholds().of("high").needed) == (72, 183)


# slender and on smooth ground, no side in the middle of the other
BOX = InventoryObject(
    name="box", width=0.4, depth=0.26, height=1.2, centre_of_mass_height=0.5, mass=50.0, friction=0.45, count=2
)


@pytest.fixture(scope="module")
def few():
    """Motions of which some overturn the box."""
    return Hazard.of_family("firm-ground", IntensityLevel.of("PGA", "0.4g"), count=8, seed=3)


def spatial(item, hazard, scale=1.0):
    """Outcomes along width and depth by one history after another of the body in space."""
    motions = [replace(each, acceleration=scale * each.acceleration) for each in hazard.motions]
    shaken = [{axis: each} for axis in "xy" for each in motions]
    found = simulate_many(item.as_solid(), shaken, friction=item.friction)
    return found.outcome.values.ravel()


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "one history after another of the body in space", within="no motion")
def test_weaker_shaking_serves_in_three_dimensions(few):
    """Under the share that the plan names none overturns it and few make it slide; as it is some do."""
    loose = Thresholds(overturning_green=0.4, overturning_red=0.5)  # 8 motions are enough for green
    found = assess([BOX], few, thresholds=loose)
    (entry,), (verdict,) = found.plan, found.verdicts
    assert entry.in_space
    assert (entry.wider, entry.lower, entry.ballast) == (None, None, None)
    assert (spatial(BOX, few)[8:] == Outcome.OVERTURNED.code).sum() == verdict.worse.overturned > 0
    assert 0.0 < entry.weaker < 1.0
    assert Outcome.OVERTURNED.code not in spatial(BOX, few, entry.weaker)
    words = plan_words(entry, language("de"))
    assert "werden in drei Dimensionen nicht berechnet" in words
    assert "Anker, die entlang einer Kante" in words


@pytest.mark.slow
@pytest.mark.verifies("closed form", "moments about the edge, m (a h - g b) over the base", within="1e-9")
def test_anchors_in_three_dimensions():
    """The force that holds a box down is that of its rectangle; what slides before it lifts needs none, but a hold."""
    two = Hazard.of_family("firm-ground", IntensityLevel.of("PGA", "0.4g"), count=2, seed=3)
    (entry,) = assess([BOX], two).plan
    wanted = (0.4 * 0.5 - 0.13) / 0.26
    assert entry.pull == pytest.approx(wanted, rel=1e-9)
    assert entry.force == pytest.approx(wanted * 50.0 * 9.80665, rel=1e-9)
    low = replace(BOX, height=0.3, centre_of_mass_height=0.1, friction=0.1)
    (entry,) = assess([low], two).plan
    assert (entry.pull, entry.shear) == pytest.approx((0.0, 0.4), rel=1e-9)
    assert "a fixing for a horizontal force of 0.4 times its weight" in plan_words(entry, language("en"))


@pytest.mark.slow
@pytest.mark.verifies("closed form", "friction times gravity", within="a thousandth on either side")
def test_what_slides_often_is_not_green():
    """Just below friction times gravity a low box stays green, just beyond it slides under each and is amber."""
    low = replace(BOX, height=0.3, centre_of_mass_height=0.1, friction=0.1)
    for factor, light in ((0.999, Light.GREEN), (1.001, Light.AMBER)):
        level = IntensityLevel("PGA", factor * 0.1 * 9.80665)
        hazard = Hazard.of_family("firm-ground", level, count=2, seed=1)
        found = assess([low], hazard)
        (verdict,) = found.verdicts
        assert (verdict.light, verdict.worse.overturned) == (light, 0)
        assert verdict.worse.slid == (2 if light is Light.AMBER else 0)
        assert found.plan == () or found.plan[0].weaker >= 0.99
    assert "Prevent sliding" in advice(verdict, found)
    assert Thresholds().light(lifted=0, overturned=0, count=100, high_rotation=0.0, slid=19) is Light.GREEN
    assert Thresholds().of("high").light(lifted=0, overturned=0, count=100, high_rotation=0.0, slid=8) is Light.AMBER


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "the body that each motion has, by one history each", within="nothing: equal")
def test_sizes_are_drawn_in_three_dimensions(few):
    """Each motion has its own body of the interval; the size as it stands gives other rotations."""
    vague = replace(BOX, approximate={"depth": 0.05, "height": 0.1}, mass=None)
    (found,), (bare,) = (assess([each], few).verdicts for each in (vague, replace(vague, approximate={})))
    bodies = Draws(8, few.description["seed"]).bodies(vague)
    fell = 0
    for k, motion in enumerate(few.motions):
        one = simulate_many(bodies[k % 5].as_solid(), [{"y": motion}], restitution="ked", friction=0.45)
        fell += int(one.outcome.values.item() == Outcome.OVERTURNED.code)
    assert found.results[1].overturned == fell
    assert found.results[1].median_rotation != bare.results[1].median_rotation
    assert found.uplift_acceleration < bare.uplift_acceleration
