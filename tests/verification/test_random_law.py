"""Coefficients drawn at random: the right distribution, independent draws, the same ones in Python and in C++."""

import math
from typing import Any

import numpy as np
import pytest
from engines import every_engine
from scipy import stats

from rocking.dynamics import PlaneSettings, RandomRestitution, RockingParameters, RockingSide
from rocking.dynamics.impact_laws import uniform
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.plane.fast_engine import run
from rocking.motions import Segments

pytestmark = pytest.mark.verifies(room="rocking in the plane")

# one false alarm in a million: the draws never change, so a failure is no accident
ALARM = 1e-6
SEEDS = (0, 1, 7, 2**32, 2**63, 2**64 - 1)
GOLDEN = 0x9E3779B97F4A7C15


class SplitMix:
    """The generator splitmix64 (Steele, Lea & Flood 2014, OOPSLA 49:453), on unsigned words of 64 bits."""

    def __init__(self, state: int) -> None:
        self.state = np.uint64(state)

    def next(self) -> int:
        with np.errstate(over="ignore"):
            self.state += np.uint64(GOLDEN)
            z = self.state
            z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
            z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
            return int(z ^ (z >> np.uint64(31)))


def draws(seed: int, keys: Any, impacts: Any) -> Any:
    return np.array([[uniform(seed, int(key), int(impact)) for impact in impacts] for key in keys])


@pytest.mark.verifies("published", "the first five outputs of splitmix64 (Steele, Lea and Flood 2014)")
def test_the_generator_is_splitmix() -> None:
    """Our copy gives the published numbers from the seed 1234567; seed, history and impact go through it in turn."""
    generator = SplitMix(1234567)
    published = [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]
    assert [generator.next() for _ in published] == published
    for seed in SEEDS:
        for key, impact in ((0, 0), (0, 1), (1, 0), (12345, 678), (2**63 - 1, 99_999)):
            word = SplitMix(seed).next()
            for more in (key, impact):
                word = SplitMix((word + more) % 2**64).next()
            assert uniform(seed, key, impact) == (word // 2**11) / 2.0**53


@pytest.mark.slow
@pytest.mark.verifies(
    "repeated sampling",
    "test of Kolmogorov and Smirnov",
    within="1e-6 of false alarms",
    control="test_a_wrong_distribution_is_caught",
)
@pytest.mark.parametrize("seed", SEEDS)
def test_uniform(seed: int) -> None:
    """Draws are uniform over all histories, and within one, whatever the seed."""
    for sample in (
        draws(seed, range(400), range(50)),
        draws(seed, [3], range(10_000)),
        draws(seed, range(10_000), [3]),
    ):
        flat = sample.ravel()
        assert stats.kstest(flat, "uniform").pvalue > ALARM
        # the last bits too
        low = np.mod(flat * 2.0**40, 1.0)
        assert stats.kstest(low, "uniform").pvalue > ALARM
        assert flat.min() >= 0.0
        assert flat.max() < 1.0


@pytest.mark.verifies("negative control", "draws squeezed by 3 %, or with another mean")
def test_a_wrong_distribution_is_caught() -> None:
    """Negative control: the test of Kolmogorov and Smirnov sees draws squeezed by 3 %, or their mean off by 0.03."""
    sample = draws(1, range(400), range(50)).ravel()
    assert stats.kstest(0.97 * sample, "uniform").pvalue < ALARM
    assert stats.kstest(sample ** (1.0 / 1.13), "uniform").pvalue < ALARM


@pytest.mark.slow
@pytest.mark.verifies(
    "repeated sampling",
    "chi-square in 8 x 8 cells, and correlation",
    within="1e-6 of false alarms",
    control="test_dependence_is_caught",
)
@pytest.mark.parametrize("seed", SEEDS)
def test_independence(seed: int) -> None:
    """Neighbouring impacts, neighbouring histories, neighbouring seeds and equal sums say nothing about each other."""
    grid, other = draws(seed, range(300), range(60)), draws(seed ^ 1, range(300), range(60))
    pairs = {
        "impacts": (grid[:, :-1], grid[:, 1:]),
        "histories": (grid[:-1], grid[1:]),
        "seeds": (grid, other),
        # key + impact is what a careless generator would draw from
        "sums": (grid[:-1, 1:], grid[1:, :-1]),
    }
    for name, (one, two) in pairs.items():
        table, _, _ = np.histogram2d(one.ravel(), two.ravel(), bins=8, range=[[0.0, 1.0], [0.0, 1.0]])
        assert stats.chi2_contingency(table).pvalue > ALARM, name
        assert abs(np.corrcoef(one.ravel(), two.ravel())[0, 1]) < 5.0 / math.sqrt(one.size), name
        assert not (one == two).any(), name


@pytest.mark.verifies("negative control", "a generator of key + impact")
def test_dependence_is_caught() -> None:
    """Negative control: a generator of key + impact alone repeats itself along the diagonals."""
    careless = np.array([[uniform(1, 0, key + impact) for impact in range(60)] for key in range(300)])
    assert (careless[:-1, 1:] == careless[1:, :-1]).all()
    table, _, _ = np.histogram2d(careless[:-1, 1:].ravel(), careless[1:, :-1].ravel(), bins=8)
    assert stats.chi2_contingency(table).pvalue < ALARM


@pytest.mark.slow
@pytest.mark.verifies(
    "repeated sampling", "the truncated normal distribution of SciPy", within="1e-6 of false alarms", control="within"
)
@pytest.mark.parametrize(("mean", "deviation"), [(0.9, 0.02), (0.85, 0.1), (0.5, 1.0), (1.0, 0.05), (0.0, 0.3)])
def test_normal(mean: float, deviation: float) -> None:
    """Draws follow the normal distribution cut to [0, 1], ends and moments included."""
    law = RandomRestitution.normal(mean, deviation, seed=11)
    sample = np.array([law.factor(1.0, key, impact) for key in range(400) for impact in range(50)])
    cut = stats.truncnorm((0.0 - mean) / deviation, (1.0 - mean) / deviation, loc=mean, scale=deviation)
    assert stats.kstest(sample, cut.cdf).pvalue > ALARM
    assert abs(sample.mean() - cut.mean()) < 5.0 * cut.std() / math.sqrt(sample.size)
    # the spread of 20,000 draws has a deviation of 0.5 %; 1025 quantiles lose less than 0.1 % of it
    assert sample.std() == pytest.approx(cut.std(), rel=0.025)
    assert sample.min() >= 0.0
    assert sample.max() <= 1.0
    wrong = stats.truncnorm((0.0 - mean) / deviation, (1.0 - mean) / deviation, loc=mean, scale=1.05 * deviation)
    if mean + 3.0 * deviation < 1.0:
        assert stats.kstest(sample, wrong.cdf).statistic > stats.kstest(sample, cut.cdf).statistic


@pytest.mark.verifies("repeated sampling", "the sample", within="1e-6 of false alarms")
def test_of_a_sample() -> None:
    """Draws from measured values are spread as these values are; from two values they lie between the two."""
    values = np.random.default_rng(2).beta(8.0, 2.0, 3000)
    law = RandomRestitution.of_sample(values, seed=3)
    sample = np.array([law.factor(1.0, key, 0) for key in range(20_000)])
    assert stats.ks_2samp(sample, values).pvalue > ALARM
    narrow = RandomRestitution.of_sample([0.7, 0.8], seed=3)
    pair = np.array([narrow.factor(1.0, key, 0) for key in range(20_000)])
    assert stats.kstest(pair, stats.uniform(0.7, 0.1).cdf).pvalue > ALARM


def coefficients(law: RandomRestitution, key: int, name: str, sides: tuple[float, float] = (1.0, 1.0)) -> Any:
    """Coefficients that an engine used, impact by impact, on a body let go on ground at rest."""
    right, left = (RockingSide(0.2, 3.0, 1.0, r) for r in sides)
    settings = PlaneSettings(rest_speed=1e-7, most_events=10_000)
    found = run(
        RockingParameters(right, left, law, ""),
        Segments.still(0.05, 400),
        settings,
        engine=name,
        stream=key,
        rotation=0.1,
    )
    return [(e.coefficient, e.side) for e in found.events if e.kind is EventKind.IMPACT]


@pytest.mark.slow
@pytest.mark.verifies("same bits", "draws made in Python", within="3e-16 of a straight line written anew")
@every_engine
def test_engines_draw_alike(name: str) -> None:
    """The n-th impact of history `key` meets the draw of (seed, key, n), to the bit, in C++ as in Python."""
    quantiles = np.linspace(0.75, 1.0, 5)
    keys = [*range(25), 2**31, 2**40 + 3, 2**63 - 1] if name == "fast" else [0, 5, 2**63 - 1]
    total = 0
    for seed in SEEDS:
        law = RandomRestitution(quantiles, seed)
        for key in keys:
            found = coefficients(law, key, name)
            total += len(found)
            # the quantile function is one straight line, written here in its own way: equal to its last bit but one
            expected = [0.75 + 0.25 * uniform(seed, key, n) for n in range(len(found))]
            assert np.array_equal([r for r, _ in found], [law.factor(0.0, key, n) for n in range(len(found))])
            np.testing.assert_allclose([r for r, _ in found], expected, rtol=0.0, atol=3e-16)
    assert total > 25 * len(keys) * len(SEEDS)


@pytest.mark.verifies("computed anew", "the product, by hand", within="3e-16")
@every_engine
def test_draws_multiply_the_coefficient_of_the_side(name: str) -> None:
    """A draw is a factor on the coefficient of the side that the body lands on."""
    law = RandomRestitution(np.array([0.9, 1.0]), 5)
    sides = (0.95, 0.8)
    found = coefficients(law, 4, name, sides)
    assert len(found) > 10
    for n, (r, side) in enumerate(found):
        assert r == pytest.approx(sides[side < 0] * (0.9 + 0.1 * uniform(5, 4, n)), abs=3e-16)
