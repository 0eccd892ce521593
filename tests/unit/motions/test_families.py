"""Families of synthetic motions: what is drawn follows what is stated; a motion is its seed and number; pulses."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, ground_velocity, peak_ground_acceleration, peak_ground_velocity, pulses
from rocking.motions.filters import highpassed
from rocking.motions.synthetic import (
    Envelope,
    KanaiTajimi,
    Lognormal,
    LogUniform,
    NonstationaryFilter,
    PointSource,
    Uniform,
    families,
    family,
    kanai_tajimi_motion,
    modulation_from_intensity,
    nonstationary_motion,
    point_source_motion,
    with_pulse,
)

pytestmark = pytest.mark.verifies(room="motions and records")

DRAWS = 600
STATED = [(name, parameter) for name, one in families().items() for parameter in one.distributions]


def drawn(name, seed=5):
    """Parameters of many motions of a family, without the work of making them."""
    bare = replace(family(name), make=lambda values, noise, step: GroundMotion([0.0, 1.0], step))
    told = [bare.motion(seed, number).metadata for number in range(DRAWS)]
    return {key: np.array([float(each[key]) for each in told]) for key in bare.distributions}


def independent(distribution):
    """The distribution as SciPy has it, written down without this package's formulas."""
    low, high = distribution.low, distribution.high
    if isinstance(distribution, Lognormal):
        ends = [math.log(end / distribution.median) / distribution.deviation for end in (low, high)]
        return lambda x: stats.truncnorm.cdf(np.log(x / distribution.median) / distribution.deviation, *ends)
    if isinstance(distribution, LogUniform):
        return stats.loguniform(low, high).cdf
    assert isinstance(distribution, Uniform)
    return stats.uniform(low, high - low).cdf


@pytest.fixture(scope="module")
def samples():
    """Draws of every family."""
    return {name: drawn(name) for name in families()}


@pytest.mark.parametrize(("name", "parameter"), STATED)
def test_draws_follow_the_stated_distribution(samples, name, parameter):
    """Kolmogorov-Smirnov does not reject 600 draws at 0.1 %; it rejects the same draws stretched by a fifth."""
    values, stated = samples[name][parameter], family(name).distributions[parameter]
    cdf = independent(stated)
    assert stats.kstest(values, cdf).pvalue > 1e-3
    assert stated.low <= values.min()
    assert values.max() <= stated.high
    # negative control: the same shares on a wider range
    wide = stated.low + 1.2 * (values - stated.low)
    assert stats.kstest(wide, cdf).pvalue < 1e-3


@pytest.mark.parametrize("name", list(families()))
def test_parameters_are_drawn_independently(samples, name):
    """No two parameters of a family correlate by ranks beyond five standard errors of chance."""
    ranks = np.array([stats.rankdata(values) for values in samples[name].values()])
    off = np.corrcoef(ranks) - np.eye(len(ranks))
    assert np.abs(off).max() < 5.0 / math.sqrt(DRAWS)


@pytest.mark.parametrize(
    "distribution", [Uniform(-2.0, 3.0), LogUniform(0.1, 7.0), Lognormal(0.5, 6.0, median=2.0, deviation=0.5)]
)
def test_quantiles_and_shares_are_inverse(distribution):
    """The share below the quantile of a share is that share; the ends are the quantiles of 0 and 1."""
    shares = np.linspace(0.0, 1.0, 21)
    values = np.array([distribution.quantile(float(share)) for share in shares])
    assert np.asarray(distribution.cdf(values)) == pytest.approx(shares, abs=1e-12)
    assert (values[0], values[-1]) == (distribution.low, distribution.high)
    assert independent(distribution)(values) == pytest.approx(shares, abs=1e-12)


GENERATORS = {
    "modulation.a2": lambda seed: nonstationary_motion(
        modulation_from_intensity(0.5, 5.0, 4.0), NonstationaryFilter(), seed=seed, duration=10.0
    ),
    "layer.frequency": lambda seed: kanai_tajimi_motion(KanaiTajimi(density=0.02), seed=seed, duration=3.0),
    "source.stress_drop": lambda seed: point_source_motion(PointSource(magnitude=5.0, distance=20e3), seed=seed),
}


@pytest.mark.parametrize(
    ("parameter", "value", "others", "words"),
    [
        ("modulation.a2", modulation_from_intensity(0.5, 5.0, 4.0).a2, {"corner", "filter.damping"}, "seed 1"),
        ("layer.frequency", 2.5, {"envelope.rise"}, "seed 1"),
        ("source.stress_drop", 8e6, {"source.kappa"}, "Boore 2003"),
    ],
)
def test_generators_are_their_seeds(parameter, value, others, words):
    """The same seed gives the same bits, another one does not, no seed is refused, every parameter is on record."""
    one, same, other = (GENERATORS[parameter](seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.acceleration, same.acceleration)
    assert (one.acceleration != other.acceleration).any()
    assert float(one.metadata[parameter]) == value
    assert {"seed", "time_step", "duration"} | others <= set(one.metadata)
    assert words in one.provenance[0]
    for seed in (-1, 1.5, True, None):
        with pytest.raises(InvalidValueError, match="seed"):
            GENERATORS[parameter](seed)


@pytest.mark.parametrize("name", list(families()))
def test_motion_is_its_seed_and_number(name):
    """The same seed and number give the same bits; another seed or number another motion."""
    one, again = family(name).motion(3, 7), family(name).motion(3, 7)
    assert np.array_equal(one.acceleration, again.acceleration)
    assert one.metadata == again.metadata
    for other in (family(name).motion(4, 7), family(name).motion(3, 8)):
        assert not np.array_equal(one.acceleration[:100], other.acceleration[:100])
    assert one.name == f"{name}, seed 3, number 7"
    assert "no hazard model" in one.provenance[-1]


@pytest.mark.parametrize("name", list(families()))
def test_motions_are_of_the_size_of_earthquakes_and_end_at_rest(name):
    """PGA from 0.001 to 3 g, PGV below 5 m/s; at the end hardly any velocity is left: a twentieth of the PGV."""
    for number in range(3):
        motion = family(name).motion(11, number)
        velocity = peak_ground_velocity(motion)
        assert 0.01 < peak_ground_acceleration(motion) < 30.0
        assert velocity < 5.0
        assert abs(ground_velocity(motion)[-1]) < 0.05 * velocity


def test_parameters_reach_the_generators_in_their_units():
    """20 km and 100 bar are 20 000 m and 10 MPa; 45 % of the intensity is there at 0.6 of 12 s; the rest by hand."""
    drawn = {"magnitude": 6.5, "distance_km": 20.0, "stress_drop_bar": 100.0, "kappa_s": 0.04}
    source = PointSource(magnitude=6.5, distance=20_000.0, stress_drop=10.0e6, kappa=0.04)
    found, wanted = family("point-source").make(drawn, 5, 0.01), point_source_motion(source, seed=5, time_step=0.01)
    np.testing.assert_allclose(found.acceleration, wanted.acceleration, rtol=0.0, atol=1e-12 * wanted.peak)

    drawn = {"density_m2_s3": 0.02, "frequency_hz": 2.5, "damping": 0.4, "rise_s": 2.0, "plateau_s": 5.0}
    found = family("kanai-tajimi").make(drawn | {"decay_1_s": 0.5, "corner_hz": 0.1}, 5, 0.01)
    layer, envelope = KanaiTajimi(density=0.02, frequency=2.5, damping=0.4), Envelope(2.0, 7.0, 0.5)
    # three times of decay and two periods of the high pass after the plateau
    wanted = kanai_tajimi_motion(layer, envelope, seed=5, time_step=0.01, duration=7.0 + 6.0 + 20.0)
    through = highpassed(wanted.acceleration, 0.01, 0.1)
    np.testing.assert_allclose(found.acceleration, through, rtol=0.0, atol=1e-12 * wanted.peak)

    drawn = {"arias_intensity_m_s": 0.8, "significant_duration_s": 12.0, "middle_over_duration": 0.6, "corner_hz": 0.1}
    found = family("firm-ground").make(drawn | {"frequency_hz": 5.0, "slope_hz_s": -0.1, "damping": 0.3}, 5, 0.01)
    modulation = modulation_from_intensity(0.8, significant_duration=12.0, middle=7.2)
    # 5 Hz at the middle, falling by 0.1 Hz a second, to no less than a fifth of it
    shaper = NonstationaryFilter(5.0, -0.1, 7.2, 0.3, lowest=1.0)
    wanted = nonstationary_motion(modulation, shaper, seed=5, time_step=0.01, duration=found.duration, corner=0.1)
    np.testing.assert_allclose(found.acceleration, wanted.acceleration, rtol=0.0, atol=1e-12 * wanted.peak)
    assert found.duration == pytest.approx(modulation.time_of(0.999) + 20.0, abs=0.01)


def test_soft_ground_is_slower_than_firm_ground():
    """The median ratio of PGV to PGA, a measure of the period, is more than twice as large on soft ground."""
    ratio = {
        name: np.median(
            [peak_ground_velocity(motion) / motion.peak for motion in (family(name).motion(2, k) for k in range(9))]
        )
        for name in ("firm-ground", "soft-ground")
    }
    assert ratio["soft-ground"] > 2.0 * ratio["firm-ground"]


def test_every_family_says_where_it_comes_from():
    """Each names its generator and that its ranges are illustrative; each distribution has words."""
    for one in families().values():
        assert "illustrative" in one.origin
        assert "20" in one.generator or "19" in one.generator
        json.dumps([str(each) for each in one.distributions.values()])


STEP = 0.005
PULSE = pulses.mavroeidis_papageorgiou(velocity=0.7, period=1.2, cycles=2.0, phase=0.0)


def residual(count=2000):
    """Small noise with a vertical part."""
    noise = np.random.default_rng(2).standard_normal((2, count))
    return GroundMotion(0.1 * noise[0], STEP, 0.05 * noise[1], name="noise")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: family("near-fault"), "family must be one of firm-ground"),
        (lambda: family(3), "family must be one of"),
        (lambda: family("firm-ground").motion(-1), "seed must be a whole number"),
        (lambda: family("firm-ground").motion(1.0), "seed must be a whole number"),
        (lambda: family("firm-ground").motion(True), "seed must be a whole number"),
        (lambda: family("firm-ground").motion(1, -2), "number must be a whole number"),
        (lambda: family("firm-ground").motion(1, time_step=0.0), "time_step"),
        (lambda: family("firm-ground").parameters(np.zeros(2)), "shares must be 7 numbers"),
        (lambda: Uniform(1.0, 1.0), "low must be below high"),
        (lambda: Uniform(math.nan, 1.0), "low must be finite"),
        (lambda: LogUniform(0.0, 1.0), "low must be > 0"),
        (lambda: Lognormal(1.0, 2.0, median=3.0, deviation=0.1), "median must be in"),
        (lambda: Lognormal(1.0, 2.0, median=1.5, deviation=0.0), "deviation must be > 0"),
        (lambda: Uniform(0.0, 1.0).quantile(1.5), "share must be in"),
        (lambda: Uniform(0.0, 1.0).quantile(-0.5), "share must be in"),
        (lambda: with_pulse(residual(), PULSE, 0.5), "begin before the motion"),
        (lambda: with_pulse(residual(), PULSE, math.nan), "arrival must be finite"),
        (lambda: with_pulse(residual(), PULSE, 1e9), "arrival must be in"),
        (lambda: with_pulse(residual(), residual(), 3.0), "pulse must be a pulse"),
    ],
)
def test_refusals(call, words):
    """What is no family, seed, number, distribution or pulse, or comes too early or late, is refused by value."""
    with pytest.raises(InvalidValueError, match=words):
        call()


@pytest.mark.verifies(
    "published", "ln T = -5.73 + 0.99 M with deviation 0.56 (Shahi and Baker 2011)", within="0.15 of ln T"
)
def test_periods_of_pulses_are_those_of_strong_earthquakes():
    """Shahi & Baker (2011): ln T = -5.73 + 0.99 M with deviation 0.56; the middle is that of M 6.3 to 6.8."""
    periods = family("pulse-like").distributions["pulse_period_s"]
    low, middle, high = (math.log(periods.quantile(share)) for share in (0.158655, 0.5, 0.841345))
    assert -5.73 + 0.99 * 6.3 < middle < -5.73 + 0.99 * 6.8
    # a standard deviation to either side
    assert middle - low == pytest.approx(0.56, abs=0.15)
    assert high - middle == pytest.approx(0.56, abs=0.15)


def test_pulse_is_added_whole_and_in_place():
    """The sum less the residual is the formula's acceleration, v' of Mavroeidis & Papageorgiou, about the arrival."""
    motion, bare = with_pulse(residual(), PULSE, 3.0), residual()
    time = np.arange(len(motion)) * STEP - 3.0
    f, cycles, amplitude = 1.0 / 1.2, 2.0, 0.7
    # (A / 2) (1 + cos(2 pi f t / gamma)) cos(2 pi f t), differentiated by hand
    w = 2.0 * np.pi * f
    slope = -np.sin(w * time / cycles) * np.cos(w * time) / cycles - (1.0 + np.cos(w * time / cycles)) * np.sin(
        w * time
    )
    expected = np.where(np.abs(time) <= 0.5 * cycles / f, 0.5 * amplitude * w * slope, 0.0)
    assert motion.acceleration - bare.acceleration == pytest.approx(expected, abs=1e-9)
    assert np.array_equal(motion.vertical, bare.vertical)
    assert motion.provenance[-1].startswith("Mavroeidis-Papageorgiou pulse")
    # a pulse that ends after the residual lengthens the vertical part with stillness
    longer = with_pulse(residual(100), PULSE, 2.0)
    assert longer.vertical.size == len(longer)
    assert not longer.vertical[100:].any()


def test_velocity_of_the_pulse_appears():
    """On still ground the PGV is the pulse's amplitude, at the arrival, to the straight lines between samples."""
    motion = with_pulse(GroundMotion([0.0, 0.0], STEP), PULSE, 2.0)
    assert peak_ground_velocity(motion) == pytest.approx(0.7, rel=1e-4)
    assert np.abs(ground_velocity(motion)).argmax() * STEP == pytest.approx(2.0, abs=STEP)
    # longer than the two samples: the pulse is not cut off
    assert motion.duration >= 2.0 + 0.5 * PULSE.duration


def test_velocity_of_the_family_is_that_of_its_pulse():
    """With next to no residual and phase zero, the PGV of a motion of the family is the velocity it says it drew."""
    whole = family("pulse-like")
    quiet = {"arias_intensity_m_s": Uniform(1e-9, 2e-9), "pulse_phase_rad": Uniform(0.0, 1e-9)}
    bare = replace(whole, distributions={**whole.distributions, **quiet})
    for number in range(3):
        motion = bare.motion(1, number)
        # 2e-3: sampling, and what is left of the residual
        assert peak_ground_velocity(motion) == pytest.approx(float(motion.metadata["pulse_velocity_m_s"]), rel=2e-3)


LAYER = KanaiTajimi(density=0.02, frequency=2.5, damping=0.6)
FLAT = Envelope(rise=0.0, plateau=0.0, decay=0.0)


def _statistics(step, statistic):
    """Mean and standard error over 24 independent motions of 200 s."""
    values = [
        statistic(kanai_tajimi_motion(LAYER, FLAT, seed=s, time_step=step, duration=200.0).acceleration)
        for s in range(24)
    ]
    return np.mean(values), np.std(values, ddof=1) / math.sqrt(len(values))


@pytest.mark.verifies(
    "repeated sampling", "pi S0 w (1 + 4 z^2) / (2 z)", within="4.0 standard errors", control="within"
)
@pytest.mark.parametrize("step", [0.02, 0.15])
def test_ensemble_variance_is_the_closed_form(step):
    """At fine and coarse steps the variance is pi S0 w (1 + 4 z^2) / (2 z); without the 4 z^2 it is not."""
    w = 5.0 * math.pi
    expected = math.pi * 0.02 * w * (1.0 + 4.0 * 0.36) / 1.2
    assert pytest.approx(expected, rel=1e-14, abs=0.0) == LAYER.variance
    mean, error = _statistics(step, lambda a: np.mean(a * a))
    assert error < 0.02 * expected
    assert abs(mean - expected) < 4.0 * error
    assert abs(mean - expected / (1.0 + 4.0 * 0.36)) > 20.0 * error


@pytest.mark.verifies("computed anew", "SciPy's quadrature of the spectrum", within="1e-6")
def test_spectrum_and_variance_belong_together():
    """The power spectral density integrates to the variance, over all circular frequencies of either sign."""
    total = quad(lambda f: 4.0 * math.pi * float(LAYER.power(np.array(f))), 0.0, math.inf, limit=500)[0]
    assert total == pytest.approx(LAYER.variance, rel=1e-6)


@pytest.mark.verifies(
    "repeated sampling", "the cosine transform of the spectrum, by SciPy", within="4.0 standard errors"
)
@pytest.mark.parametrize("lag", [1, 3, 8])
def test_correlation_in_time_is_that_of_the_spectrum(lag):
    """Products of samples a lag apart have the mean that the spectrum gives, by cosine transform, within 4 errors."""
    step = 0.02
    tau = lag * step
    tail = {"weight": "cos", "wvar": 2.0 * math.pi * tau}
    expected = quad(lambda f: 4.0 * math.pi * float(LAYER.power(np.array(f))), 0.0, math.inf, limlst=500, **tail)[0]
    mean, error = _statistics(step, lambda a: np.mean(a[:-lag] * a[lag:]))
    assert error < 0.03 * LAYER.variance
    assert abs(mean - expected) < 4.0 * error


def test_envelope_has_its_three_parts():
    """Parabola to the rise, 1 to the plateau's end, exponential beyond."""
    found = Envelope(2.0, 4.0, 0.5)(np.array([0.0, 1.0, 2.0, 4.0, 6.0]))
    np.testing.assert_allclose(found, [0.0, 0.25, 1.0, 1.0, math.exp(-1.0)], rtol=1e-15)


def test_envelope_multiplies_the_stationary_motion():
    """With the same seed, motions with and without an envelope differ by that factor alone."""
    envelope = Envelope(1.0, 3.0, 0.7)
    with_it = kanai_tajimi_motion(LAYER, envelope, seed=9, duration=8.0)
    without = kanai_tajimi_motion(LAYER, FLAT, seed=9, duration=8.0)
    np.testing.assert_allclose(
        with_it.acceleration, envelope(without.time) * without.acceleration, rtol=1e-14, atol=1e-300
    )


def test_bad_values_are_refused():
    """Density, damping, envelope and step have ranges."""
    with pytest.raises(InvalidValueError, match="density"):
        KanaiTajimi(density=0.0)
    with pytest.raises(InvalidValueError, match="damping"):
        KanaiTajimi(density=1.0, damping=1.0)
    with pytest.raises(InvalidValueError, match="plateau"):
        Envelope(rise=5.0, plateau=4.0)


def test_limits_of_the_step_are_as_stated():
    """The refusal names the range, up to half a period of 0.4 s; steps just inside are taken, just outside not."""
    with pytest.raises(
        InvalidValueError, match=r"time_step must be in \[6\.3662e-05, 0\.2\) s for this layer, got 0\.5"
    ):
        kanai_tajimi_motion(LAYER, seed=1, time_step=0.5, duration=2.0)
    # a thousandth of a radian at 2.5 Hz
    least = 1e-3 / (5.0 * math.pi)
    for inside in (least * (1.0 + 1e-9), 0.2 * (1.0 - 1e-9)):
        assert kanai_tajimi_motion(LAYER, seed=1, time_step=inside, duration=3.0 * inside).time_step == inside
    for outside in (least * (1.0 - 1e-9), 0.2 * (1.0 + 1e-9)):
        with pytest.raises(InvalidValueError, match="for this layer"):
            kanai_tajimi_motion(LAYER, seed=1, time_step=outside, duration=3.0 * outside)
