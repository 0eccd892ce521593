"""Intensity measures against closed forms and an independent piecewise polynomial."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PPoly

from rocking.conventions import g
from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion
from rocking.motions.intensity import (
    arias_intensity,
    cumulative_absolute_velocity,
    housner_intensity,
    intensity_measures,
    normalised_acceleration,
    normalised_velocity,
    peak_ground_acceleration,
    peak_ground_displacement,
    peak_ground_velocity,
    significant_duration,
    significant_times,
    spectral_acceleration,
)

ZIGZAG = GroundMotion([0.0, 1.0, -1.0, 0.0], 1.0)
RECORDS = st.lists(st.floats(-10.0, 10.0).map(lambda x: round(x, 3)), min_size=2, max_size=30)


def _lines(motion):
    a = motion.acceleration
    return PPoly(np.array([np.diff(a) / motion.time_step, a[:-1]]), motion.time)


def _peak(curve, slope):
    turns = np.concatenate([slope.roots(extrapolate=False), curve.x])
    return np.abs(curve(turns[np.isfinite(turns)])).max()


def test_hand_made_zigzag():
    """All integrals of a zigzag of three steps are those worked out on paper."""
    assert peak_ground_acceleration(ZIGZAG) == 1.0
    assert peak_ground_velocity(ZIGZAG) == pytest.approx(0.75, rel=1e-15)
    assert peak_ground_displacement(ZIGZAG) == pytest.approx(1.0, rel=1e-15)
    assert arias_intensity(ZIGZAG) == pytest.approx(math.pi / (2.0 * g), rel=1e-15)
    assert cumulative_absolute_velocity(ZIGZAG) == pytest.approx(1.5, rel=1e-15)


def test_sampled_integrals_are_rejected():
    """Negative control: sums over samples miss peak, energy and area of the zigzag by a third and more."""
    a = ZIGZAG.acceleration
    assert np.abs(np.cumsum(0.5 * (a[:-1] + a[1:]))).max() == pytest.approx(0.5)
    assert np.trapezoid(a * a) == pytest.approx(2.0)
    assert np.trapezoid(np.abs(a)) == pytest.approx(2.0)


def test_displacement_peaks_inside_a_step():
    """The cubic of the line from 1 to -2 peaks at 2/27, where no sample is; at its samples it is zero."""
    assert peak_ground_displacement(GroundMotion([1.0, -2.0], 1.0)) == pytest.approx(2.0 / 27.0, rel=1e-14)


@given(RECORDS, st.sampled_from([0.005, 0.37, 20.0]))
def test_peaks_agree_with_piecewise_polynomials(samples, step):
    """PGV and PGD are the extremes that the roots of SciPy's piecewise polynomials give."""
    motion = GroundMotion(samples, step)
    line = _lines(motion)
    velocity = line.antiderivative()
    displacement = velocity.antiderivative()
    scale = motion.peak * motion.duration
    assert peak_ground_velocity(motion) == pytest.approx(_peak(velocity, line), rel=1e-9, abs=1e-12 * scale)
    expected = _peak(displacement, velocity)
    assert peak_ground_displacement(motion) == pytest.approx(expected, rel=1e-9, abs=1e-12 * scale * motion.duration)


@given(RECORDS)
def test_energy_and_area_agree_with_fine_sums(samples):
    """Arias intensity and CAV are the limits of sums over 2000 points a step."""
    motion = GroundMotion(samples, 0.1)
    t = (np.arange(2000 * (len(motion) - 1)) + 0.5) * 0.1 / 2000
    fine = np.interp(t, motion.time, motion.acceleration)
    assert arias_intensity(motion) == pytest.approx(0.5 * math.pi / g * (fine**2).sum() * 0.1 / 2000, rel=1e-5)
    assert cumulative_absolute_velocity(motion) == pytest.approx(np.abs(fine).sum() * 0.1 / 2000, rel=1e-5)


def test_significant_times_inside_one_step():
    """A ramp reaches the share p of its energy at the cube root of p; a line through zero at (1 - cbrt(1 - 2p)) / 2."""
    ramp = GroundMotion([0.0, 1.0], 1.0)
    assert significant_duration(ramp) == pytest.approx(np.cbrt(0.95) - np.cbrt(0.05), rel=1e-14)
    assert significant_duration(ramp, 5, 75) == pytest.approx(np.cbrt(0.75) - np.cbrt(0.05), rel=1e-14)
    first, last = significant_times(GroundMotion([1.0, -1.0], 1.0), 10.0, 80.0)
    assert first == pytest.approx(0.5 * (1.0 - np.cbrt(0.8)), rel=1e-14)
    assert last == pytest.approx(0.5 * (1.0 + np.cbrt(0.6)), rel=1e-14)


def test_significant_times_of_all_and_of_nothing_around():
    """Zeros around a motion do not change its duration, and 0 to 100 % is where it moves."""
    motion = GroundMotion([0.0, 0.0, 0.0, 2.0, -1.0, 0.0, 0.0, 0.0], 0.5)
    bare = GroundMotion([0.0, 2.0, -1.0, 0.0], 0.5)
    assert significant_duration(motion) == pytest.approx(significant_duration(bare), rel=1e-14)
    assert significant_times(motion, 1e-9, 100.0)[1] == pytest.approx(2.5, abs=1e-9)


def test_housner_intensity_of_a_blow():
    """A blow of velocity V has PSV = V exp(-z phi / sqrt(1 - z^2)) at all long periods: 2.4 s times that."""
    blow = GroundMotion([0.0, 1e4, 0.0], 1e-4)
    z = 0.05
    root = math.sqrt(1.0 - z * z)
    expected = 2.4 * math.exp(-z / root * math.atan2(root, z))
    # the blow lasts 2e-4 s, so that oscillators of 0.1 s see it as one within 2e-5
    assert housner_intensity(blow) == pytest.approx(expected, rel=1e-3)
    assert housner_intensity(blow, damping=0.0) == pytest.approx(2.4, rel=1e-3)


def test_normalised_measures_know_angle_and_size():
    """The ratios are PGA and p PGV over g tan(alpha)."""
    alpha = math.atan(0.25)
    assert normalised_acceleration(ZIGZAG, alpha) == pytest.approx(4.0 / g, rel=1e-14)
    assert normalised_velocity(ZIGZAG, alpha, 2.0) == pytest.approx(2.0 * 0.75 * 4.0 / g, rel=1e-14)


def test_table_has_names_values_and_units():
    """The table repeats the functions, with units of the SI."""
    table = intensity_measures(ZIGZAG)
    assert list(table) == ["pga", "pgv", "pgd", "arias", "cav", "d5_95", "d5_75", "housner"]
    assert [m.unit for m in table.values()] == ["m/s2", "m/s", "m", "m/s", "m/s", "s", "s", "m"]
    assert table["pgv"].value == peak_ground_velocity(ZIGZAG)
    assert table["d5_75"].value < table["d5_95"].value


def test_bad_values_are_refused():
    """Zero motions have no duration; percentages, angles and periods have ranges."""
    with pytest.raises(InvalidValueError, match="zero throughout"):
        significant_duration(GroundMotion([0.0, 0.0], 0.1))
    with pytest.raises(InvalidValueError, match="end must be"):
        significant_duration(ZIGZAG, 95.0, 5.0)
    with pytest.raises(InvalidValueError, match="slenderness_angle"):
        normalised_acceleration(ZIGZAG, 0.5 * math.pi)
    with pytest.raises(InvalidValueError, match="frequency_parameter"):
        normalised_velocity(ZIGZAG, 0.2, math.nan)
    with pytest.raises(InvalidValueError, match="period"):
        spectral_acceleration(ZIGZAG, 0.0)
    with pytest.raises(InvalidValueError, match="gravity"):
        arias_intensity(ZIGZAG, gravity=-9.8)
