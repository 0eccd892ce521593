"""Spectra over all directions against an integration of high order of both components at once."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rocking.motions import GroundMotion, response_spectrum, rotated, rotd_spectrum, spectrum
from rocking.motions.spectrum import directional_spectra

pytestmark = pytest.mark.verifies(room="motions and records")

DRAWN = np.random.default_rng(8).standard_normal((2, 40))
FIRST, SECOND = GroundMotion(DRAWN[0], 0.01), GroundMotion(0.6 * DRAWN[1] + 0.3 * DRAWN[0], 0.01)


def _path(period, damping, points):
    """Displacement along both components, by DOP853 from sample to sample and a period beyond."""
    w, state, rows = 2.0 * math.pi / period, np.zeros(4), []
    ground = np.stack([FIRST.acceleration, SECOND.acceleration])
    for i in range(len(FIRST)):
        last = i == len(FIRST) - 1
        h = period if last else FIRST.time_step
        a, b = (np.zeros(2), np.zeros(2)) if last else (ground[:, i], ground[:, i + 1])

        def rate(t, y, a=a, b=b, h=h):
            push = a + (b - a) * t / h
            return np.concatenate([y[2:], -push - 2.0 * damping * w * y[2:] - w * w * y[:2]])

        times = np.linspace(0.0, h, 20 * points if last else points)
        answer = solve_ivp(rate, (0.0, h), state, method="DOP853", rtol=1e-9, atol=1e-14, t_eval=times)
        rows.append(answer.y[:2])
        state = answer.y[:, -1]
    return np.hstack(rows)


def _percentiles(path, period):
    angles = np.radians(np.arange(180.0))
    peaks = np.abs(np.cos(angles)[:, None] * path[0] + np.sin(angles)[:, None] * path[1]).max(axis=1)
    return np.percentile(peaks, [0.0, 50.0, 100.0]) * (2.0 * math.pi / period) ** 2


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew", "an integration of high order", within="5e-4", control="test_paths_at_samples_only_are_rejected"
)
@pytest.mark.parametrize(("period", "damping"), [(0.02, 0.05), (0.033, 0.0), (0.15, 0.05), (0.6, 0.2)])
def test_rotd_agrees_with_an_independent_integration(period, damping):
    """RotD00, RotD50 and RotD100 are within 0.05 % of those of a fine integration, down to two steps a period."""
    found = rotd_spectrum(FIRST, SECOND, [period], damping, [0.0, 50.0, 100.0])[:, 0]
    assert found == pytest.approx(_percentiles(_path(period, damping, 200), period), rel=5e-4)


@pytest.mark.verifies("negative control", "paths at samples only")
def test_paths_at_samples_only_are_rejected():
    """Negative control: at two samples a period the path misses RotD50 by more than 1 %."""
    fine = _path(0.02, 0.05, 101)
    coarse = fine[:, : 101 * (len(FIRST) - 1) : 101]
    found = rotd_spectrum(FIRST, SECOND, [0.02])[0, 0]
    assert _percentiles(coarse, 0.02)[1] < 0.99 * found


@pytest.mark.verifies("invariant", "the spectrum of the turned motion", within="3e-4", control="within")
def test_every_direction_is_that_of_the_turned_motion():
    """The peak in a direction is the spectrum of the motion turned there, to 0.03 %; 20 degrees beside it is not."""
    periods = [0.03, 0.1, 0.4, 2.0]
    every = directional_spectra(FIRST, SECOND, periods)
    for degrees in (0, 37, 90, 151):
        turned = rotated(FIRST, SECOND, math.radians(degrees))[0]
        expected = response_spectrum(turned, periods).pseudo_acceleration
        assert every[:, degrees] == pytest.approx(expected, rel=3e-4)
        assert every[:, (degrees + 20) % 180] != pytest.approx(expected, rel=3e-4)


@pytest.mark.verifies("computed anew", "every part of every step, none passed over", within="1e-9", control="within")
@pytest.mark.parametrize("narrow", [1.0, 1e-3, 0.0])
def test_no_place_that_is_passed_over_matters(narrow, monkeypatch):
    """The compiled module passes over what lies within the outline: no direction notices, save one a degree beside."""
    if spectrum.compiled() is None:
        pytest.skip("without the compiled module nothing is passed over")
    across = GroundMotion(narrow * SECOND.acceleration + 0.7 * FIRST.acceleration, 0.01)
    periods = np.geomspace(0.015, 4.0, 9)
    quick = directional_spectra(FIRST, across, periods)
    monkeypatch.setattr(spectrum, "compiled", lambda: None)
    plain = directional_spectra(FIRST, across, periods)
    # across a path that is a line nearly nothing is left: rounding of the whole
    room = 1e-9 * plain.max(axis=1, keepdims=True)
    assert np.all(np.abs(quick - plain) <= room)
    assert np.any(np.abs(np.roll(quick, 1, axis=1) - plain) > room)


@pytest.mark.verifies("closed form", "a motion along one line", within="1e-3", control="within")
def test_a_motion_along_one_line():
    """Of a motion along one line RotD50 is cos 45 degrees of RotD100: half of all directions are closer to it."""
    nothing = GroundMotion(np.zeros(40), 0.01)
    half, full = rotd_spectrum(FIRST, nothing, [0.1, 1.0])
    assert full == pytest.approx(response_spectrum(FIRST, [0.1, 1.0]).pseudo_acceleration, rel=1e-3)
    # between two directions of a degree the median of the cosine is off by up to 1 %
    assert half == pytest.approx(math.cos(math.pi / 4.0) * full, rel=1e-2)
