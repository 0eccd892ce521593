"""Filtered noise against the double sum of its definition."""

import math

import numpy as np
import pytest

from rocking.motions import filters
from rocking.motions.synthetic import NonstationaryFilter
from rocking.motions.synthetic.stochastic import _unit_process


def by_definition(noise, omega, damping, step):
    """Every impulse through the oscillator of its own instant (Rezaeian & Der Kiureghian 2008, Eqs. 3 and 8)."""
    root = math.sqrt(1.0 - damping**2)
    later = step * np.arange(noise.size)
    lag = later[:, np.newaxis] - later[np.newaxis, :]
    past = np.where(lag > 0.0, lag, 0.0)
    response = omega / root * np.exp(-damping * omega * past) * np.sin(omega * root * past)
    total, variance = response @ noise, (response**2).sum(axis=1)
    return np.concatenate([[0.0], total[1:] / np.sqrt(variance[1:])])


@pytest.mark.parametrize("count", [2, 3, 24, 25, 26, 700])
@pytest.mark.parametrize("damping", [0.05, 0.3, 0.9])
def test_filtered_noise_is_the_sum_of_its_impulses(count, damping):
    """Filtered noise is the double sum of the definition: to rounding where each impulse has its own oscillator."""
    rng = np.random.default_rng(count)
    noise, omega = rng.standard_normal(count), np.linspace(30.0, 8.0, count)
    found = _unit_process(noise, omega, damping, 0.01)
    assert np.abs(found - by_definition(noise, omega, damping, 0.01)).max() < (1e-13 if count < 100 else 1e-10)


DRIFTS = [(6.0, -0.1, 0.3, 0.01), (6.0, 0.2, 0.15, 0.01), (1.4, -0.03, 0.2, 0.02), (3.0, 0.0, 0.9, 0.005)]


@pytest.mark.parametrize(("frequency", "slope", "damping", "step"), DRIFTS)
def test_shared_oscillators_are_as_good_as_own_ones(frequency, slope, damping, step, monkeypatch):
    """Long drifts share oscillators: within 1e-10 of the definition; the same bits without the compiled module."""
    noise = np.random.default_rng(7).standard_normal(1600)
    omega = NonstationaryFilter(frequency, slope, 8.0, damping).omega(step * np.arange(noise.size))
    found = _unit_process(noise, omega, damping, step)
    assert np.abs(found - by_definition(noise, omega, damping, step)).max() < 1e-10
    monkeypatch.setattr(filters, "compiled", lambda: None)
    np.testing.assert_array_equal(_unit_process(noise, omega, damping, step), found)


def test_oscillators_too_far_apart_are_seen(monkeypatch):
    """Negative control: with eight times the distance between oscillators the sum is off by a thousandth of a unit."""
    monkeypatch.setattr("rocking.motions.synthetic.stochastic.SPACING", 0.4)
    noise = np.random.default_rng(7).standard_normal(1600)
    omega = NonstationaryFilter().omega(0.01 * np.arange(noise.size))
    found = _unit_process(noise, omega, 0.3, 0.01)
    assert np.abs(found - by_definition(noise, omega, 0.3, 0.01)).max() > 1e-6


def test_a_filter_of_another_instant_is_seen():
    """A filter whose frequency is that of the next instant differs far beyond rounding."""
    rng = np.random.default_rng(3)
    noise, omega = rng.standard_normal(100), np.linspace(30.0, 8.0, 100)
    found = _unit_process(noise, omega, 0.3, 0.01)
    assert np.abs(found - by_definition(noise, np.append(omega[1:], omega[-1]), 0.3, 0.01)).max() > 1e-4
