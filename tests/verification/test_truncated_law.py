"""Coefficients drawn for bodies with unequal feet: each side's distribution ends where impacts would create energy."""

import math
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from engines import every_engine
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

import rocking as rk
from rocking.conventions import FEET, Foot, percent
from rocking.dynamics import PlaneSettings, RandomRestitution, RockingParameters, RockingSide
from rocking.dynamics.batch import Batch
from rocking.dynamics.impact_laws import uniform
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.plane.fast_engine import run
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.evidence import Calibration, calibrate, restitution_distribution
from rocking.evidence.likelihood import scatter
from rocking.motions import Segments
from rocking.restitution import ShiftedImpulse, coefficient_of_restitution
from rocking.studies import SampledRestitution, fragility_analysis

pytestmark = pytest.mark.verifies(room="rocking in the plane")

# one false alarm in a million: the draws never change, so a failure is no accident
ALARM = 1e-6
SIGNS: dict[Foot, float] = {"left": -1.0, "right": 1.0}
LAWS = pytest.mark.parametrize("law", [RandomRestitution, SampledRestitution])
quietly = pytest.mark.filterwarnings("ignore::rocking.errors.PlausibilityWarning")


def leaning(tall: float, short: float = 1.0, width: float = 1.0) -> rk.Section:
    """A body whose mass stands over its left foot: the taller there, the more its sides differ."""
    outline = [(0.0, 0.0), (width, 0.0), (width, short), (0.0, tall)]
    return rk.Section([rk.Region(outline, 2400.0)])


def mirrored(body: rk.Section) -> rk.Section:
    regions = [rk.Region([(-x, y) for x, y in reversed(r.outline)], r.density) for r in body.regions]
    return rk.Section(regions)


def bound(body: Any, foot: Foot) -> float:
    """Largest coefficient onto a foot: r^2 I_new = I_old, from moments about the centre by Steiner's theorem."""
    about = {f: body.moment_of_inertia + body.mass * body.side(f).semi_diagonal ** 2 for f in FEET}
    return math.sqrt(about["left" if foot == "right" else "right"] / about[foot])


def coefficients(parameters: RockingParameters, foot: Foot, count: int = 2000) -> Any:
    return np.array([parameters.coefficient(SIGNS[foot], 1.0, key, 3) for key in range(count)])


def cut_normal(mean: float, sd: float, most: float) -> Any:
    return stats.truncnorm((0.0 - mean) / sd, (most - mean) / sd, loc=mean, scale=sd)


BODIES = leaning(3.0), leaning(5.0, 2.0), mirrored(leaning(2.5, 0.8))
CASES = list(zip(BODIES, (0.9, 0.97, 0.9), (0.05, 0.03, 0.05), strict=True))  # 10, 16 and 17 % are cut off


# ---- the distribution -----------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.verifies(
    "repeated sampling",
    "the truncated normal distribution of SciPy",
    within="1e-6 of false alarms; 0.02 of the deviation in quantiles",
    control="within",
)
@quietly
@LAWS
@pytest.mark.parametrize(("body", "mean", "sd"), CASES)
def test_draws_follow_the_truncated_distribution(body: Any, mean: float, sd: float, law: Any) -> None:
    """On either side draws are those of the normal distribution on condition that 0 <= r <= bound; to a bound of 1."""
    parameters = RockingParameters.of_body(body, law.normal(mean, sd, seed=11), 9.81)
    narrow = min(FEET, key=lambda foot: bound(body, foot))
    for foot in FEET:
        drawn, exact = coefficients(parameters, foot), cut_normal(mean, sd, min(1.0, bound(body, foot)))
        assert stats.kstest(drawn, exact.cdf).pvalue > ALARM
        assert drawn.max() <= bound(body, foot)
        # straight lines between 1025 quantiles: the worst is the first step of the tail, cut at a quarter of it
        u = np.linspace(0.01, 0.99, 99)
        found = [parameters.side(SIGNS[foot]).coefficient * quantile(parameters, foot, p) for p in u]
        np.testing.assert_allclose(found, exact.ppf(u), rtol=0.0, atol=0.02 * sd)
    # negative controls: draws that are clipped instead, and those of the other side
    whole = np.array([law.normal(mean, sd, seed=11).factor(1.0, key, 3) for key in range(2000)])
    exact = cut_normal(mean, sd, bound(body, narrow))
    assert stats.kstest(np.minimum(whole, bound(body, narrow)), exact.cdf).pvalue < ALARM
    other: Foot = "left" if narrow == "right" else "right"
    assert stats.kstest(coefficients(parameters, other), exact.cdf).pvalue < ALARM


def quantile(parameters: RockingParameters, foot: Foot, p: float) -> float:
    law: Any = parameters.law
    return float(law.quantile(parameters.side(SIGNS[foot]).share * p, foot))


@pytest.mark.verifies("closed form", "the probability beyond the energy bound", within="1e-4")
@quietly
@pytest.mark.parametrize(("body", "mean", "sd"), CASES)
def test_what_is_cut_off_is_stated(body: Any, mean: float, sd: float) -> None:
    """The share that is left, and the words, are the probability within the bound, of the distribution on [0, 1]."""
    parameters = RockingParameters.of_body(body, RandomRestitution.normal(mean, sd, seed=1), 9.81)
    whole = cut_normal(mean, sd, 1.0)
    for foot in FEET:
        share = parameters.side(SIGNS[foot]).share
        assert share == pytest.approx(whole.cdf(bound(body, foot)), abs=1e-4)  # of a step of 1/1024 between quantiles
        assert (share < 1.0) == (f"{percent(1.0 - share)} onto {foot}" in parameters.label)


def one_point(eta: float, k: float, s: float) -> Calibration:
    """A posterior of one point, so that the predictive distribution is one normal distribution."""
    known = calibrate()
    return Calibration(np.array([[eta, k, s, 0.0]]), known.marginals, known.joint, known.summary)


@pytest.mark.slow
@pytest.mark.verifies(
    "closed form",
    "the truncated normal distribution",
    within="1e-9 in quantiles, 1e-12 in what is cut",
    control="within",
)
@quietly
@pytest.mark.parametrize("point", [(1.0, 0.3, 0.05), (0.98, 0.55, 0.2), (1.0, 0.0, 0.02)])
@pytest.mark.parametrize("body", BODIES)
def test_posterior_is_truncated_on_both_sides(body: Any, point: tuple[float, float, float]) -> None:
    """Quantiles onto both feet are those of the truncated normal distribution; the cut is its closed form, and said."""
    eta, k, s = point
    found = restitution_distribution(body, calibration=one_point(*point))
    for foot in FEET:
        most = bound(body, foot)
        mean = min(eta * coefficient_of_restitution(body, ShiftedImpulse(k), foot=foot), most)
        exact = cut_normal(mean, scatter(np.array(mean), s, 0.0), most)
        whole = stats.norm(mean, scatter(np.array(mean), s, 0.0))
        levels = np.linspace(0.0, 1.0, found.tables[foot].size)
        assert found.tables[foot][1:-1] == pytest.approx(exact.ppf(levels[1:-1]), abs=1e-9)
        assert found.cut[foot] == pytest.approx(1.0 - whole.cdf(most) + whole.cdf(0.0), abs=1e-12)
        assert found.bounds[foot] == pytest.approx(most, rel=1e-12, abs=0.0)
        assert f"{foot}={percent(found.cut[foot])}" in repr(found)
        for law in (found.per_history(3), found.per_impact(3)):
            parameters = RockingParameters.of_body(body, law, 9.81)
            assert parameters.side(SIGNS[foot]).share == 1.0
            assert (f"{percent(found.cut[foot])} onto {foot}" in parameters.label) == (found.cut[foot] > 1e-4)
            assert stats.kstest(coefficients(parameters, foot), exact.cdf).pvalue > ALARM
            clipped = np.minimum(whole.ppf([uniform(3, key, 3 * (not law.per_history)) for key in range(2000)]), most)
            if found.cut[foot] > 0.1:
                assert stats.kstest(clipped, exact.cdf).pvalue < ALARM


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_doubted_and_refused() -> None:
    """Nothing is said below 5 %, a warning above it; where next to nothing is left, or cannot be cut, it is refused."""
    body = BODIES[0]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        RockingParameters.of_body(body, RandomRestitution.normal(0.85, 0.05, seed=1), 9.81)
        restitution_distribution(body)
    # (Phi(2) - Phi(1.183)) / Phi(2), of the normal distribution up to 1
    with pytest.warns(PlausibilityWarning, match=r"9\.78 % of the dist.* right foot lies outside \[0, 0\.9592\]"):
        RockingParameters.of_body(body, RandomRestitution.normal(0.9, 0.05, seed=1), 9.81)
    with pytest.warns(PlausibilityWarning, match="right foot lies outside"):
        restitution_distribution(body, calibration=one_point(1.0, 0.0, 0.02))
    with pytest.raises(InvalidValueError, match=r"right foot must be in \[0, 0\.959\d+\], and 100 % of its"):
        RockingParameters.of_body(body, SampledRestitution([0.97, 0.98], seed=1), 9.81)

    class Own(RandomRestitution):
        """Draws otherwise, so that nobody can cut it."""

        def factor(self, speed: float, key: int, impact: int) -> float:
            return 0.9

    with pytest.raises(InvalidValueError, match=r"right foot.*would create energy"):
        RockingParameters.of_body(body, Own([0.5, 0.99], 1), 9.81)

    class Stronger(Own):
        """Its table says less than it gives."""

        largest = 1.2

    with pytest.raises(InvalidValueError, match=r"would create energy"):
        RockingParameters.of_body(rk.Block(width=1.0, height=4.0), Stronger([0.5, 0.9], 1), 9.81)


@pytest.mark.verifies("damage", "numbers that are no two probabilities")
@pytest.mark.parametrize("cut", [(2.0, -1.0), (0.1,), None, (0.0, 1.0)])
def test_what_is_cut_is_two_probabilities(cut: Any) -> None:
    """What a law says is cut off are two numbers from 0 to 1; anything else is refused."""
    with pytest.raises(InvalidValueError, match="cut must be"):
        RandomRestitution([0.5, 0.9], 1, 1.0, cut)


@pytest.mark.verifies("behaviour")
def test_a_law_by_side_can_be_made_anew() -> None:
    """Tables above 1, which one of two sides may need, stay tables by side where both are equal."""
    law = RandomRestitution({"left": [0.9, 1.15], "right": [0.9, 1.15]}, 4)
    assert replace(law, seed=5).factors.tolist() == SampledRestitution.of_law(law).factors.tolist() == [[0.9, 1.15]] * 2


@pytest.mark.verifies("behaviour")
@LAWS
def test_cells_without_a_body_spoil_no_others(law: Any) -> None:
    """A map over widths that the semi-diagonal cannot have: those cells have no result, the others have theirs."""
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6)
    axes = ("width", [0.4, 3.0]), ("semi_diagonal", [1.0, 2.0])
    drawn, one = (rk.overturning_map(block, pulse, *axes, restitution=r) for r in (law.normal(0.9, 0.02, seed=1), 0.9))
    failed = one["mode"].to_numpy() == -3
    assert failed.sum() == 1
    assert ((drawn["mode"].to_numpy() == -3) == failed).all()


# ---- energy ---------------------------------------------------------------------------------------------------------

bodies = st.builds(leaning, st.floats(1.05, 6.0), st.floats(0.3, 1.0), st.floats(0.3, 1.5))
tables = st.lists(st.floats(0.4, 1.0), min_size=2, max_size=6).map(sorted)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "r^2 I_new <= I_old, by Steiner's theorem", within="2e-9")
@quietly
@settings(max_examples=60, deadline=None)
@given(bodies, tables, tables, st.integers(0, 2**64 - 1), st.booleans())
def test_no_draw_is_beyond_the_bound(body: Any, left: Any, right: Any, seed: int, turned: bool) -> None:
    """Whatever the body and the tables of its sides, no draw and no largest coefficient creates energy."""
    body = mirrored(body) if turned else body
    size = min(len(left), len(right))
    law = RandomRestitution({"left": left[:size], "right": right[:size]}, seed)
    try:
        parameters = RockingParameters.of_body(body, law, 9.81)
    except InvalidValueError:
        assert any(bound(body, foot) < 1.001 * law.table(foot)[0] + 1e-3 for foot in FEET)
        return
    for foot in FEET:
        most = max([parameters.largest(SIGNS[foot]), *coefficients(parameters, foot, 50)])
        assert most <= bound(body, foot) * (1.0 + 2e-9)  # the rounding that r and I are granted


@pytest.mark.slow
@pytest.mark.verifies("invariant", "kinetic energy over an impact", within="1e-9")
@quietly
@every_engine
@pytest.mark.parametrize("body", BODIES)
def test_no_impact_creates_energy(name: str, body: Any) -> None:
    """Kinetic energy I theta'^2 never grows over an impact under a law whose draws reach up to the bounds."""
    law = RandomRestitution({"left": [0.9, 1.15], "right": [0.9, 1.15]}, seed=4)
    inertia = {SIGNS[f]: body.moment_of_inertia + body.mass * body.side(f).semi_diagonal ** 2 for f in FEET}
    ratios, factors = [], []
    for key in range(6):
        response = rk.free_rocking(body, 0.1, law, stream=key, engine=name, duration=20.0)
        for event in response.trajectory.events:
            if event.kind is EventKind.IMPACT:
                ratios.append((event.after / event.before) ** 2 * inertia[event.side] / inertia[-event.side])
                factors.append(event.coefficient)
    assert len(ratios) > 60
    assert max(ratios) <= 1.0 + 1e-9
    assert max(ratios) > 0.98  # draws come near the bound
    assert max(factors) > 1.0  # which is above 1 on one side


# ---- the engines ----------------------------------------------------------------------------------------------------


def rows_of(count: int) -> dict[str, Any]:
    rng = np.random.default_rng(8)
    ranges = {"alpha": (0.15, 0.4), "p": (1.5, 4.0), "r": (0.8, 1.0), "q": (0.5, 0.8), "share": (0.2, 1.0)}
    return {f"{n}_{s}": rng.uniform(*ends, count) for n, ends in ranges.items() for s in ("right", "left")} | {
        "scale": rng.uniform(0.5, 1.5, count)
    }


def results(law: Any, name: str, values: dict[str, Any]) -> Any:
    time = np.arange(200) * 0.02
    ground = Segments.between_samples(0.02, 5.0 * np.sin(5.0 * time) * np.exp(-time))
    count = values["scale"].size

    def rows(first: int, last: int) -> Rows:
        return Rows.of(last - first, 0, np.arange(first, last), **{k: v[first:last] for k, v in values.items()})

    return Batch([ground], law, PlaneSettings(), 1, name).run(count, rows)[0]


TWO = {"left": [0.6, 0.7, 1.0], "right": [0.8, 0.9, 0.95]}


@pytest.mark.slow
@pytest.mark.verifies(
    "second engine", "the reference engine", within="1e-8 rad in peaks; counts equal", control="within"
)
@pytest.mark.skipif(not fast_engine.available(), reason="not built")
@LAWS
def test_engines_agree(law: Any) -> None:
    """Shares and a table for each side act alike in C++ and in Python; with the tables swapped they do not."""
    values = rows_of(60)
    fast, slow = (results(law(TWO, 5), name, values) for name in ("fast", "reference"))
    swapped = results(law({"left": TWO["right"], "right": TWO["left"]}, 5), "fast", values)
    assert (fast["impacts"] > 2).sum() > 20
    assert np.array_equal(fast["outcome"], slow["outcome"])
    assert np.array_equal(fast["impacts"], slow["impacts"])
    np.testing.assert_allclose(fast["peak_rotation"], slow["peak_rotation"], rtol=0.0, atol=1e-8)
    assert (np.abs(fast["peak_rotation"] - swapped["peak_rotation"]) > 1e-3).sum() > 10


@pytest.mark.verifies("computed anew", "the table of the side at its share of the draw, by hand", within="3e-16")
@every_engine
def test_each_impact_draws_from_its_side(name: str) -> None:
    """The n-th impact lands on a side with the quantile of that side at its share of the n-th number, to the bit."""
    law = RandomRestitution(TWO, 9)
    right, left = RockingSide(0.2, 3.0, 1.0, 0.95, share=0.4), RockingSide(0.25, 3.3, 1.0, 0.9, share=0.7)
    parameters, options = RockingParameters(right, left, law, ""), PlaneSettings(rest_speed=1e-7, most_events=10_000)
    found = run(parameters, Segments.still(0.05, 400), options, engine=name, stream=4, rotation=0.1)
    impacts = [(e.coefficient, e.side) for e in found.events if e.kind is EventKind.IMPACT]
    assert len(impacts) > 10
    for n, (r, side) in enumerate(impacts):
        table, one = (TWO["right"], right) if side > 0 else (TWO["left"], left)
        expected = np.interp(one.share * uniform(9, 4, n), np.linspace(0.0, 1.0, 3), table)
        assert r == pytest.approx(one.coefficient * expected, abs=3e-16)
        assert r == parameters.coefficient(side, 1.0, 4, n)


@pytest.mark.slow
@pytest.mark.verifies("same bits", "two equal tables kept as two")
@every_engine
def test_equal_sides_are_one_table(name: str) -> None:
    """Two equal tables are one; run as two all the same, they give the same bits."""
    one, values = RandomRestitution(TWO["left"], 5), rows_of(40)
    two = RandomRestitution({"left": TWO["left"], "right": TWO["left"]}, 5)
    assert two.factors.shape == one.factors.shape
    object.__setattr__(two, "factors", np.stack([one.factors, one.factors]))
    first, second = results(one, name, values), results(two, name, values)
    assert all(first[key].tobytes() == second[key].tobytes() for key in fast_engine.RESULTS)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "body, motion and tables mirrored", within="1e-9 rad", control="within")
@quietly
@every_engine
@LAWS
def test_a_mirrored_body_gives_the_mirrored_response(name: str, law: Any) -> None:
    """Body, motion and tables mirrored: the same rotations with the other sign, and the same coefficients."""
    if law is SampledRestitution and name == "fast":
        pytest.skip("a single response that draws once runs on the reference engine")
    body, pulse = BODIES[1], rk.pulses.sine(amplitude=4.0, period=0.7)
    made = law({"left": [0.9, 1.0], "right": [0.7, 0.98]}, 2)
    turned = law({"left": [0.7, 0.98], "right": [0.9, 1.0]}, 2)
    one = rk.simulate(body, pulse, made, engine=name, duration=6.0)
    other = rk.simulate(mirrored(body), pulse, turned, scale=-1.0, engine=name, duration=6.0)
    assert len(one.impacts) > 5
    np.testing.assert_allclose(other.rotation, -one.rotation, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(other.impacts["coefficient"], one.impacts["coefficient"], rtol=1e-12)
    wrong = rk.simulate(mirrored(body), pulse, made, scale=-1.0, engine=name, duration=6.0)
    assert np.abs(wrong.rotation + one.rotation).max() > 1e-3


# ---- who draws ------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.verifies("invariant", "single responses of the same numbers", within="1e-8 rad")
@quietly
@LAWS
def test_studies_take_asymmetric_bodies(law: Any) -> None:
    """Batches, maps and stripes draw for every side as a single response of the same number does."""
    body, pulse = BODIES[1], rk.pulses.sine(amplitude=3.0, period=0.6)
    made, scales = law.normal(0.95, 0.04, seed=3), np.array([1.0, 1.5, 2.0, 2.5])
    single = [rk.simulate(body, pulse, made, scale=scale, stream=key) for key, scale in enumerate(scales)]
    wanted = [response.peak_rotation for response in single]
    assert all(len(response.impacts) > 1 for response in single[:3])
    found = rk.simulate_many(body, pulse, made, scale=scales)
    both = rk.simulate_many([rk.Block(width=0.5, height=2.0), body], pulse, made)
    np.testing.assert_allclose(
        np.abs(found["peak_rotation"].values.ravel())[:3], np.abs(wanted)[:3], rtol=0.0, atol=1e-8
    )
    axes = ("scale", scales), ("period", [0.6, 1.2])
    plane = rk.overturning_map(body, pulse, *axes, restitution=made)
    np.testing.assert_allclose(
        np.abs(plane["peak_rotation"].values.ravel())[:3], np.abs(wanted)[:3], rtol=0.0, atol=1e-8
    )
    labels = [str(each["restitution"].values[0]) for each in (found, both)]
    for told in (*labels, plane.attrs["restitution"]):
        assert "onto right cut off, where impacts would create energy" in told
    stripes = fragility_analysis(body, [pulse], [1.0, 2.0], restitution=made)
    assert stripes.failed == 0


@pytest.mark.verifies("computed anew", "the draw of the history, read back from the tables", within="1e-9")
@quietly
def test_sides_share_the_draw_of_a_history() -> None:
    """All impacts of a history meet the quantiles of their sides at one number, another for the next history."""
    body = BODIES[0]
    law = restitution_distribution(body, calibration=one_point(0.98, 0.55, 0.2)).per_history(6)
    for key in (0, 7):
        response = rk.free_rocking(body, 0.15, law, stream=key)
        events = [event for event in response.trajectory.events if event.kind is EventKind.IMPACT]
        assert {event.side for event in events} == {-1, 1}
        for event in events:
            table = law.table("right" if event.side > 0 else "left")
            u = np.interp(event.coefficient, table, np.linspace(0.0, 1.0, table.size))
            assert u == pytest.approx(uniform(6, key, 0), abs=1e-9)
    assert replace(law, seed=7).draws([5], "left") != law.draws([5], "left")
