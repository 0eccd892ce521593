"""Sensitivity to the restitution against closed forms: which verdicts flip, how draws are distributed, which way.

REF numbers (CONTRIBUTING.md): full sine, slender linear block, lower boundary of
overturning with one impact (mode I of Zhang & Makris 2001, EESD 30:461), A = a_p / (g alpha).
"""

from itertools import combinations, pairwise

import numpy as np
import pytest
from scipy import optimize, stats

import rocking as rk
from rocking import conventions
from rocking.dynamics import PlaneSettings, RandomRestitution, RockingParameters
from rocking.studies import (
    HistoryTable,
    MotionList,
    SampledRestitution,
    fragility_sensitivity,
    map_sensitivity,
    spectrum_sensitivity,
)
from rocking.studies.sensitivity.changes import curve_change, flips_of
from rocking.studies.sensitivity.restitutions import SampledHistories, uniforms

pytestmark = pytest.mark.verifies(room="studies")

pytest.importorskip("xarray")
# one false alarm in a million: the draws never change, so a failure is no accident
ALARM = 1e-6
LOWER = {  # Omega: r = 0.9, r = 1
    1: (1.13204711059768365, 1.12780479486212521), 2: (1.22517942326831362, 1.21383084814880623),
    3: (1.40356535564278266, 1.36705162931038883), 5: (3.01859986087179637, 2.22056633180111026),
    6: (5.1641589274575678, 3.41721761686939524),
}  # fmt: skip
BLOCK = rk.Block(width=0.3, height=2.0)
OVER = rk.Outcome.OVERTURNED.code


def flips_around(omega, boundaries, margin=1e-9):
    """Flips between r = 0.9 and r = 1 just below and above both boundaries, and half way between."""
    damped, elastic = boundaries
    around = [elastic * (1.0 - margin), elastic * (1.0 + margin), 0.5 * (elastic + damped)]
    levels = [*around, damped * (1.0 - margin), damped * (1.0 + margin)]
    pulse = rk.pulses.sine(amplitude=1.0, period=1.0)
    axes = ("frequency_ratio", [omega]), ("amplitude_ratio", levels)
    found = map_sensitivity(BLOCK, pulse, *axes, [0.9, 1.0], linear=True)
    return found.differences("verdict").values.ravel().tolist()


@pytest.mark.verifies(
    "closed form",
    "lower boundaries of mode I (Zhang and Makris 2001) at r = 0.9 and r = 1",
    within="1e-9",
    control="test_other_boundaries_are_rejected",
)
@pytest.mark.parametrize("omega", LOWER)
def test_verdicts_flip_between_the_closed_forms(omega):
    """Between the boundaries of r = 1 and r = 0.9 the verdict flips, 1e-9 outside them it does not."""
    assert flips_around(omega, LOWER[omega]) == [0, 1, 1, 1, 0]


@pytest.mark.verifies("negative control", "boundaries of the next Omega, or moved by 1e-7")
def test_other_boundaries_are_rejected():
    """The boundaries of the next Omega, and these ones moved by 1e-7, fail the same check."""
    assert flips_around(2, LOWER[3]) != [0, 1, 1, 1, 0]
    assert flips_around(3, tuple(value * (1.0 + 1e-7) for value in LOWER[3])) != [0, 1, 1, 1, 0]


def drawn(count, law, pieces=1):
    """Outcomes of a full sine at Omega = 3 and the amplitude where r = 0.9 is just enough to overturn."""
    parameters = RockingParameters.of_body(BLOCK, 1.0, conventions.g)
    side = parameters.right
    names = {"alpha": side.slenderness_angle, "p": side.frequency_parameter, "r": 1.0}
    values = {f"{name}_{foot}": value for name, value in names.items() for foot in ("right", "left")}
    amplitude = LOWER[3][0] * conventions.g * side.slenderness_angle
    pulse = rk.pulses.sine(amplitude, 2.0 * np.pi / (3.0 * side.frequency_parameter))
    table = HistoryTable(MotionList(pulse), np.zeros(count, np.int64), values, settings=PlaneSettings(linear=True))
    edges = np.linspace(0, count, pieces + 1).astype(int)
    made = SampledHistories.of(table, law)
    return np.concatenate([made.run(int(a), int(b))["outcome"] for a, b in pairwise(edges)])


@pytest.mark.verifies("closed form", "the coefficient at which it just overturns", within="1e-8", control="within")
def test_each_history_overturns_if_its_draw_exceeds_the_critical_coefficient():
    """At that amplitude each of 20,000 histories overturns if and only if its own r > 0.9; so half of them do."""
    law = SampledRestitution.normal(0.9, 0.02, seed=2)
    draws, outcome = law.draws(np.arange(20_000)), drawn(20_000, law)
    clear = np.abs(draws - 0.9) > 1e-8
    assert clear.sum() > 19_990
    assert ((outcome == OVER) == (draws > 0.9))[clear].all()
    assert stats.binomtest(int((outcome == OVER).sum()), 20_000, 0.5).pvalue > ALARM
    shifted = law.draws(np.arange(1, 20_001))  # negative control: the neighbour's draw
    assert ((outcome == OVER) == (shifted > 0.9)).mean() < 0.6


@pytest.mark.slow
@pytest.mark.verifies("same bits", "1, 7 and 1000 pieces")
def test_pieces_do_not_change_the_draws():
    """In 1, 7 or 1000 pieces the same histories overturn."""
    law = SampledRestitution.normal(0.9, 0.02, seed=2)
    whole = drawn(5000, law)
    assert all(np.array_equal(whole, drawn(5000, law, pieces)) for pieces in (7, 1000))


@pytest.mark.verifies(
    "repeated sampling", "the truncated normal distribution of SciPy", within="1e-6 of false alarms", control="within"
)
def test_draws_have_the_distribution():
    """20,000 draws pass Kolmogorov-Smirnov against the cut normal; draws by the place in pieces of 64 do not."""
    law = SampledRestitution.normal(0.97, 0.03, seed=5)
    expected = stats.truncnorm((0.0 - 0.97) / 0.03, (1.0 - 0.97) / 0.03, 0.97, 0.03)
    numbers = np.arange(20_000)
    assert stats.kstest(law.draws(numbers), expected.cdf).pvalue > ALARM
    assert stats.kstest(law.draws(numbers % 64), expected.cdf).pvalue < ALARM
    assert stats.kstest(law.draws(numbers), stats.norm(0.97, 0.03).cdf).pvalue < ALARM


@pytest.mark.verifies("repeated sampling", "correlation of neighbours, strides and seeds", within="5 standard errors")
def test_draws_are_independent():
    """Draws of neighbours, of strides and of other seeds are uncorrelated to 5 standard errors of 100,000."""
    u = uniforms(3, np.arange(100_000))
    pairs = [(u[:-lag], u[lag:]) for lag in (1, 2, 64, 4096)] + [(u, uniforms(4, np.arange(100_000)))]
    assert all(abs(np.corrcoef(a, b)[0, 1]) < 5.0 / np.sqrt(a.size) for a, b in pairs)


@pytest.mark.verifies("invariant", "the constant coefficient", within="every outcome")
def test_no_width_is_the_constant_in_every_study():
    """Map, spectrum and stripes with a distribution of no width equal those with the constant."""
    motions = synthetic(6, seed=9)
    choices = [0.9, SampledRestitution([0.9, 0.9], 4), RandomRestitution([0.9, 0.9], 4)]
    levels = conventions.g * BLOCK.slenderness_angle * np.array([1.2, 2.0, 3.0])
    axes = ("scale", [0.5, 1.0, 2.0]), ("semi_diagonal", [0.5, 1.0])
    for found in (
        map_sensitivity(BLOCK, motions[0], *axes, choices),
        spectrum_sensitivity(motions[:1], [0.15, 0.3], [1.0, 2.0], choices),
        fragility_sensitivity(BLOCK, motions, levels, choices, repetitions=0),
    ):
        first, once, each = found.datasets.values()
        assert found.flips()["count"].sum() == 0
        assert np.array_equal(first["outcome"], once["outcome"])
        assert all(each[name].values.tobytes() == first[name].values.tobytes() for name in first.data_vars)
    assert len({one.responses.rotation.tobytes() for one in found.results.values()}) == 1


def synthetic(count, seed):
    """Noise through a smoothing window of random length under an envelope, peak 1 m/s2: broad-band motions."""
    rng, time = np.random.default_rng(seed), np.linspace(0.0, 1.0, 1200)
    envelope = np.sqrt(time) * np.exp(-3.0 * time)
    made = []
    for k in range(count):
        window = np.hanning(2 * int(rng.uniform(5.0, 40.0)) + 1)
        a = np.convolve(rng.normal(size=time.size), window, "same") * envelope
        made.append(rk.GroundMotion(a / np.abs(a).max(), 0.01, name=f"synthetic {k}"))
    return made


@pytest.fixture(scope="module")
def comparison():
    """Block with b = 0.2 m, h = 0.6 m, linear, 2000 synthetic motions at six levels of PGA / (g alpha)."""
    block = rk.Block(width=0.4, height=1.2)
    levels = conventions.g * block.slenderness_angle * np.array([1.1, 1.25, 1.4, 1.6, 1.86, 2.49])
    models = ["housner", "horizontal-momentum", "ked"]
    return fragility_sensitivity(block, synthetic(2000, seed=1), levels, models, repetitions=400, linear=True)


def mcnemar(first, second):
    """Flips at one level, where motions are independent: by chance so one-sided if neither overturned more often?"""
    flips = flips_of(first, second)
    assert flips.only_first > 0  # single motions go both ways
    return stats.binomtest(flips.only_second, flips.count, 0.5, "greater").pvalue


@pytest.mark.slow
@pytest.mark.verifies(
    "repeated sampling",
    "order of dissipation; McNemar's test",
    within="1e-6 of false alarms",
    control="test_the_order_is_not_found_where_there_is_none",
)
def test_less_dissipation_overturns_more_in_distribution(comparison):
    """Housner dissipates most, KED least: medians fall in that order, each pair's 95 % interval of the ratio below one.

    Single histories go both ways, so the claim
    is on distributions. At PGA / (g alpha) = 1.6 flips from Housner towards overturning outnumber the others beyond
    chance (McNemar's exact test).
    """
    order = ["housner", "horizontal-momentum", "ked"]
    r = [rk.coefficient_of_restitution(rk.Block(width=0.4, height=1.2), name) for name in order]
    assert r == sorted(r)
    for first, second in combinations(order, 2):
        assert comparison.curve_change(second, baseline=first).median.interval[1] < 1.0
    outcome = [comparison.datasets[name]["outcome"].values[:, 3] for name in order]
    assert max(mcnemar(outcome[0], other) for other in outcome[1:]) < ALARM


@pytest.mark.verifies("negative control", "models exchanged for a random half of the motions")
def test_the_order_is_not_found_where_there_is_none(comparison):
    """Negative control: with the two models exchanged for a random half of the motions the same tests find nothing."""
    swap = np.random.default_rng(0).random(2000) < 0.5
    first, second = (comparison.results[name].responses.overturned for name in ("housner", "ked"))
    mixed = [np.where(swap[:, None], b, a) for a, b in ((first, second), (second, first))]
    assert mcnemar(*(np.where(values[:, 3], OVER, 1) for values in mixed)) > 0.01
    found = curve_change(((1.0, 0.3), (1.0, 0.3)), comparison.results["ked"].levels, *mixed, repetitions=400)
    assert found.median.interval[0] < 1.0 < found.median.interval[1]


@pytest.mark.verifies("computed anew", "likelihoods maximised by SciPy", within="1e-6")
def test_the_size_of_the_change_is_that_of_two_analyses_apart(comparison):
    """Ratio of medians and difference of dispersions are those of curves fitted to the counts of each by hand."""

    def fitted(name):
        result = comparison.results[name]
        z, n, x = result.responses.overturned.sum(axis=0), 2000, np.log(result.levels)

        def loss(q):
            eta = (x - q[0]) / np.exp(q[1])
            return -(z * stats.norm.logcdf(eta) + (n - z) * stats.norm.logcdf(-eta)).sum()

        best = optimize.minimize(loss, [1.5, -1.5], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-10})
        return np.exp(best.x)

    (median, beta), (other_median, other_beta) = fitted("housner"), fitted("ked")
    found = comparison.curve_change("ked")
    assert found.median.value == pytest.approx(other_median / median, rel=1e-6)
    assert found.dispersion.value == pytest.approx(other_beta - beta, abs=1e-6)
    assert f"{100.0 * (other_median / median - 1.0):+.3g} %" in comparison.verdict
    row = next(row for row in comparison.summary() if row["choice"] == "ked")
    names = [f"overturned: median ratio{end}" for end in ("", " low", " high")]
    assert [row[name] for name in names] == [found.median.value, *found.median.interval]
