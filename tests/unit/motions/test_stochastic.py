"""Nonstationary motions: variance, intensity, frequency and high pass against closed forms; noise by double sums."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.signal import lsim

from rocking.conventions import g
from rocking.errors import InvalidValueError
from rocking.motions import arias_intensity, filters, ground_displacement
from rocking.motions.filters import highpassed
from rocking.motions.synthetic import (
    GammaModulation,
    NonstationaryFilter,
    modulation_from_intensity,
    nonstationary_motion,
)
from rocking.motions.synthetic.stochastic import _unit_process

pytestmark = pytest.mark.verifies(room="motions and records")

MODULATION = modulation_from_intensity(0.5, significant_duration=5.0, middle=4.0)
SHAPER = NonstationaryFilter(frequency=4.0, slope=-0.2, middle=4.0, damping=0.3)


@pytest.mark.verifies("computed anew", "SciPy's quadrature", within="1e-6")
@given(st.floats(1e-4, 50.0), st.floats(0.5, 60.0), st.floats(0.3, 4.5))
def test_modulation_has_the_intensity_that_was_asked_for(intensity, middle, ratio):
    """Integrals of the squared modulation up to 5, 45 and 95 % are found again by quadrature."""
    q = modulation_from_intensity(intensity, ratio * middle, middle)
    whole = 2.0 * g * intensity / math.pi

    def share(end):
        return quad(lambda t: float(q(np.array(t))) ** 2 / whole, 0.0, end, limit=200)[0]

    assert share(middle) == pytest.approx(0.45, rel=1e-6)
    assert q.time_of(0.95) - q.time_of(0.05) == pytest.approx(ratio * middle, rel=1e-9)
    assert share(q.time_of(0.95)) == pytest.approx(0.95, rel=1e-6)
    assert q.arias_intensity() == pytest.approx(intensity, rel=1e-10)


@pytest.mark.verifies("closed form", "variance one", within="1e-10")
def test_unit_process_has_unit_variance_exactly():
    """The noise goes through linearly; the squares of its weights sum to 1 at every sample but the first."""
    count = 120
    omega = SHAPER.omega(np.arange(count) * 0.02)
    weights = np.array([_unit_process(row, omega, 0.3, 0.02) for row in np.eye(count)])
    np.testing.assert_allclose((weights**2).sum(axis=0)[1:], 1.0, rtol=1e-10)
    assert (weights[:, 0] == 0.0).all()


def _ensemble(**options):
    return [
        nonstationary_motion(MODULATION, SHAPER, seed=s, time_step=0.04, duration=16.0, **options) for s in range(250)
    ]


@pytest.mark.verifies("repeated sampling", "the modulation", within="4.0 standard errors", control="within")
def test_ensemble_follows_the_modulation():
    """Mean of x^2 over q^2 is 1 within 4 standard errors in each quarter; with a wrong shape it is not."""
    motions = _ensemble(corner=None)
    time = motions[0].time
    squares = np.array([m.acceleration**2 for m in motions])
    for part in np.array_split(np.arange(1, time.size), 4):
        each = (squares[:, part] / MODULATION(time[part]) ** 2).mean(axis=1)
        error = each.std(ddof=1) / math.sqrt(each.size)
        assert error < 0.05
        assert abs(each.mean() - 1.0) < 4.0 * error
    wrong = GammaModulation(MODULATION.a1, MODULATION.a2 + 0.2, MODULATION.a3)
    each = (squares[:, 100:200] / wrong(time[100:200]) ** 2).mean(axis=1)
    assert abs(each.mean() - 1.0) > 6.0 * each.std(ddof=1) / math.sqrt(each.size)


@pytest.mark.verifies("repeated sampling", "its mean in closed form", within="4.0 standard errors")
def test_ensemble_has_the_expected_arias_intensity():
    """The Arias intensity has the closed-form mean within 4 standard errors."""
    values = np.array([arias_intensity(m) for m in _ensemble(corner=None)])
    error = values.std(ddof=1) / math.sqrt(values.size)
    assert error < 0.02 * 0.5
    # 16 s hold all but 1e-5 of the energy
    assert abs(values.mean() - 0.5) < 4.0 * error


def test_frequency_drifts_as_prescribed():
    """A narrow filter crosses zero upwards at its own frequency, early and late."""
    shaper = NonstationaryFilter(frequency=5.0, slope=-0.1, middle=20.0, damping=0.02)
    flat = GammaModulation(1.0, 1.0, 1e-6)
    a = nonstationary_motion(flat, shaper, seed=4, time_step=0.01, duration=40.0, corner=None).acceleration
    for start, expected in [(500, 6.0), (2500, 4.0)]:
        part = a[start : start + 1000]
        rate = ((part[:-1] < 0.0) & (part[1:] >= 0.0)).sum() / 10.0
        # 10 s hold 40 to 60 crossings, and the bandwidth of 4 % moves a few: 10 % is about 3 deviations
        assert rate == pytest.approx(expected, rel=0.1)


@pytest.mark.verifies("computed anew", "SciPy's lsim", within="1e-10")
def test_highpass_agrees_with_a_state_space_solver():
    """The recurrence is the response of s^2 / (s + w)^2 to straight lines, as SciPy's solver gives it."""
    a = np.random.default_rng(2).standard_normal(300)
    w = 2.0 * math.pi * 0.7
    expected = lsim(([1.0, 0.0, 0.0], [1.0, 2.0 * w, w * w]), a, np.arange(300) * 0.02)[1]
    np.testing.assert_allclose(highpassed(a, 0.02, 0.7), expected, rtol=0.0, atol=1e-10)


def test_highpass_brings_the_ground_back():
    """With the high pass the displacement ends near zero; without it, the negative control, the ground drifts away."""
    seeds = range(8)
    ends = {
        corner: np.mean(
            [
                abs(ground_displacement(m)[-1])
                for m in (nonstationary_motion(MODULATION, SHAPER, seed=s, corner=corner) for s in seeds)
            ]
        )
        for corner in (None, 0.1)
    }
    assert ends[0.1] < 1e-3 * ends[None]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: nonstationary_motion(MODULATION, NonstationaryFilter(slope=5.0), seed=1), "filter frequency"),
        (lambda: nonstationary_motion(MODULATION, SHAPER, seed=1, corner=0.0), "corner"),
        (lambda: nonstationary_motion(MODULATION, SHAPER, seed=1, duration=0.005), "duration"),
        (lambda: modulation_from_intensity(1.0, 10.0, 1.0), "middle"),
        (lambda: modulation_from_intensity(0.0, 10.0, 8.0), "arias_intensity"),
        (lambda: GammaModulation(1.0, 0.9, 1.0), "a2"),
        (lambda: NonstationaryFilter(damping=1.0), "damping"),
    ],
)
def test_bad_values_are_refused(call, words):
    """Parameters have ranges; a filter faster than the steps is refused, as is a duration without a modulation."""
    with pytest.raises(InvalidValueError, match=words):
        call()


def by_definition(noise, omega, damping, step):
    """Every impulse through the oscillator of its own instant (Rezaeian & Der Kiureghian 2008, Eqs. 3 and 8)."""
    root = math.sqrt(1.0 - damping**2)
    later = step * np.arange(noise.size)
    lag = later[:, np.newaxis] - later[np.newaxis, :]
    past = np.where(lag > 0.0, lag, 0.0)
    response = omega / root * np.exp(-damping * omega * past) * np.sin(omega * root * past)
    total, variance = response @ noise, (response**2).sum(axis=1)
    return np.concatenate([[0.0], total[1:] / np.sqrt(variance[1:])])


@pytest.mark.verifies(
    "computed anew",
    "the double sum of the definition",
    within="1e-13 of short ones, 1e-10 of long ones",
    control="test_a_filter_of_another_instant_is_seen",
)
@pytest.mark.parametrize("count", [2, 3, 24, 25, 26, 700])
@pytest.mark.parametrize("damping", [0.05, 0.3, 0.9])
def test_filtered_noise_is_the_sum_of_its_impulses(count, damping):
    """Filtered noise is the double sum of the definition: to rounding where each impulse has its own oscillator."""
    rng = np.random.default_rng(count)
    noise, omega = rng.standard_normal(count), np.linspace(30.0, 8.0, count)
    found = _unit_process(noise, omega, damping, 0.01)
    assert np.abs(found - by_definition(noise, omega, damping, 0.01)).max() < (1e-13 if count < 100 else 1e-10)


DRIFTS = [(6.0, -0.1, 0.3, 0.01), (6.0, 0.2, 0.15, 0.01), (1.4, -0.03, 0.2, 0.02), (3.0, 0.0, 0.9, 0.005)]


@pytest.mark.verifies(
    "computed anew",
    "the double sum of the definition",
    within="1e-10",
    control="test_oscillators_too_far_apart_are_seen",
)
@pytest.mark.parametrize(("frequency", "slope", "damping", "step"), DRIFTS)
def test_shared_oscillators_are_as_good_as_own_ones(frequency, slope, damping, step, monkeypatch):
    """Long drifts share oscillators: within 1e-10 of the definition; the same bits without the compiled module."""
    noise = np.random.default_rng(7).standard_normal(1600)
    omega = NonstationaryFilter(frequency, slope, 8.0, damping).omega(step * np.arange(noise.size))
    found = _unit_process(noise, omega, damping, step)
    assert np.abs(found - by_definition(noise, omega, damping, step)).max() < 1e-10
    monkeypatch.setattr(filters, "compiled", lambda: None)
    np.testing.assert_array_equal(_unit_process(noise, omega, damping, step), found)


@pytest.mark.verifies("negative control", "eight times the distance between oscillators")
def test_oscillators_too_far_apart_are_seen(monkeypatch):
    """Negative control: with eight times the distance between oscillators the sum is off by a thousandth of a unit."""
    monkeypatch.setattr("rocking.motions.synthetic.stochastic.SPACING", 0.4)
    noise = np.random.default_rng(7).standard_normal(1600)
    omega = NonstationaryFilter().omega(0.01 * np.arange(noise.size))
    found = _unit_process(noise, omega, 0.3, 0.01)
    assert np.abs(found - by_definition(noise, omega, 0.3, 0.01)).max() > 1e-6


@pytest.mark.verifies("negative control", "the frequency of the next instant")
def test_a_filter_of_another_instant_is_seen():
    """A filter whose frequency is that of the next instant differs far beyond rounding."""
    rng = np.random.default_rng(3)
    noise, omega = rng.standard_normal(100), np.linspace(30.0, 8.0, 100)
    found = _unit_process(noise, omega, 0.3, 0.01)
    assert np.abs(found - by_definition(noise, np.append(omega[1:], omega[-1]), 0.3, 0.01)).max() > 1e-4
