"""Baselines, filters, resampling, cutting and turning against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.errors import InvalidValueError
from rocking.motions import (
    GroundMotion,
    bandpassed,
    demeaned,
    detrended,
    ground_displacement,
    ground_velocity,
    padded,
    resampled,
    rotated,
    rotd_pga,
    tapered,
    trimmed,
    trimmed_to_significant,
)
from rocking.motions.integrals import significant_times

T = np.arange(1001) * 0.01
NOISE = np.random.default_rng(11).standard_normal(1001)
BOTH = GroundMotion(NOISE, 0.01, vertical=NOISE[::-1])


def _sine(frequency, step=0.01, count=6001):
    return GroundMotion(np.sin(2.0 * np.pi * frequency * np.arange(count) * step), step)


def test_mean_is_removed_from_each_component():
    """Both components end with no mean, each with its own one taken off."""
    motion = demeaned(GroundMotion(NOISE + 3.0, 0.01, vertical=NOISE - 2.0))
    np.testing.assert_allclose(motion.acceleration, NOISE - NOISE.mean(), rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(motion.vertical, NOISE - NOISE.mean(), rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("fit", ["velocity", "acceleration"])
def test_polynomials_are_removed_and_higher_ones_are_not(order, fit):
    """A trend of the order fitted goes away entirely; one of the next order does not: negative control."""
    power = order - 1 if fit == "velocity" else order
    assert detrended(GroundMotion(2.0 * T**power, 0.01), order, fit).peak < 2e-4 * 2.0 * T[-1] ** power
    assert detrended(GroundMotion(2.0 * T ** (power + 1), 0.01), order, fit).peak > 0.01 * T[-1] ** (power + 1)


def test_velocity_fit_leaves_no_trend_in_the_velocity():
    """The corrected velocity is orthogonal to every power that was fitted, which is what least squares means."""
    motion = detrended(GroundMotion(NOISE + 0.3 + 0.1 * T, 0.01), 2)
    velocity = ground_velocity(motion)
    for power in (1, 2):
        assert abs(velocity @ T**power) < 1e-9 * np.abs(velocity).max() * (T**power).sum()


def test_taper_is_half_a_cosine():
    """A constant turns into the taper itself: 0, 1/2 in the middle of the edge, 1 inside."""
    motion = tapered(GroundMotion(np.ones(1001), 0.01, vertical=np.ones(1001)), 0.1)
    assert motion.acceleration[[0, 50, 100, 500, 900, 950, 1000]] == pytest.approx([0, 0.5, 1, 1, 1, 0.5, 0])
    np.testing.assert_array_equal(motion.acceleration, motion.vertical)


@pytest.mark.parametrize("order", [2, 4])
def test_bandpass_halves_at_its_corners_without_a_shift(order):
    """In the middle of long sines the two passes give 1/2 at both corners, 1 inside, nothing far outside."""
    middle = slice(2500, 3501)
    for frequency, gain, slack in [
        (0.5, 0.5, 2e-3),
        (10.0, 0.5, 2e-3),
        (2.2, 1.0, 2e-2),
        (0.02, 0.0, 2e-3),
        (45.0, 0.0, 2e-3),
    ]:
        motion = _sine(frequency)
        filtered = bandpassed(motion, 0.5, 10.0, order)
        # the gain in the pass band is not quite 1 for order 2, hence the 2 %
        np.testing.assert_allclose(
            filtered.acceleration[middle], gain * motion.acceleration[middle], atol=slack, rtol=0.0
        )


def test_one_pass_only_is_rejected():
    """Negative control: a single pass has 0.707 at the corner and shifts the phase by far more than the test allows."""
    from scipy.signal import butter, sosfilt

    motion = _sine(10.0)
    once = sosfilt(butter(4, [0.5, 10.0], btype="bandpass", fs=100.0, output="sos"), motion.acceleration)
    middle = slice(2500, 3501)
    assert np.abs(once[middle] - 0.5 * motion.acceleration[middle]).max() > 0.1


def test_zeros_that_the_filter_runs_into():
    """A narrow band rings on into 1.5 order / low seconds of zeros at both ends, and is cut off there; not later."""
    from scipy.signal import butter, sosfiltfilt

    low, high, order, step = 0.5, 0.54, 3, 0.02
    sections = butter(order, [low, high], btype="bandpass", fs=1.0 / step, output="sos")
    record = NOISE[:300]
    filtered = bandpassed(GroundMotion(record, step), low, high, order).acceleration

    def within(zeros):
        return sosfiltfilt(sections, np.pad(record, zeros), padtype=None)[zeros : zeros + record.size]

    # 1.5 * 3 / 0.5 Hz are 9 s
    np.testing.assert_allclose(filtered, within(450), rtol=0.0, atol=1e-12)
    for zeros in (300, 600):
        assert np.abs(filtered - within(zeros)).max() > 1e-3 * np.abs(filtered).max()


def test_time_reversal_commutes_with_the_filter():
    """Zero phase means that a motion run backwards is filtered backwards."""
    forward = bandpassed(BOTH, 0.5, 20.0)
    np.testing.assert_allclose(forward.vertical, forward.acceleration[::-1], rtol=0.0, atol=1e-10)


@given(st.lists(st.floats(-9.0, 9.0), min_size=2, max_size=12), st.integers(2, 7))
def test_refining_by_whole_ratios_is_the_same_motion(samples, ratio):
    """Velocity and displacement are those of the coarse motion, and its samples are kept."""
    motion = GroundMotion(samples, 0.2)
    fine = resampled(motion, 0.2 / ratio)
    np.testing.assert_allclose(fine.acceleration[::ratio], motion.acceleration, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(ground_displacement(fine)[::ratio], ground_displacement(motion), rtol=0.0, atol=1e-12)


def test_refining_by_any_ratio_lies_on_the_lines():
    """At 0.3 of a step the samples of a ramp are on the ramp; beyond the record there is one zero."""
    fine = resampled(GroundMotion([0.0, 1.0, 2.0], 1.0), 0.3)
    np.testing.assert_allclose(fine.acceleration, [0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 0.0], rtol=0.0, atol=1e-14)


def test_coarsening_keeps_slow_waves_and_drops_fast_ones():
    """With 4 times the step (25 Hz), 1 Hz passes and 24 Hz, which would turn into a wave of 1 Hz, does not."""
    middle = slice(300, 1200)
    slow, fast = resampled(_sine(1.0), 0.04), resampled(_sine(24.0), 0.04)
    # ripple of the Hamming design is 0.2 %
    np.testing.assert_allclose(slow.acceleration[middle], _sine(1.0).acceleration[::4][middle], rtol=0.0, atol=3e-3)
    assert np.abs(fast.acceleration[middle]).max() < 3e-3
    assert np.abs(_sine(24.0).acceleration[::4][middle]).max() > 0.99  # negative control: no low pass


def test_trimming_and_padding_undo_each_other():
    """Zeros added are cut off again, sample by sample, with both components."""
    longer = padded(BOTH, 0.5, 1.0)
    assert len(longer) == 1001 + 150
    again = trimmed(longer, 0.5, 0.5 + BOTH.duration)
    np.testing.assert_array_equal(again.acceleration, BOTH.acceleration)
    np.testing.assert_array_equal(again.vertical, BOTH.vertical)


def test_trimming_goes_outwards():
    """Times between samples keep the samples on both sides."""
    motion = GroundMotion([0.0, 1.0, 2.0, 3.0, 4.0], 0.1)
    assert trimmed(motion, 0.15, 0.25).acceleration.tolist() == [1.0, 2.0, 3.0]
    assert trimmed(motion, 0.0, 0.4).acceleration.tolist() == motion.acceleration.tolist()


def test_trimming_to_the_significant_part():
    """The part between 5 and 95 % begins and ends within a step of these times, and padding widens it."""
    first, last = significant_times(BOTH)
    part = trimmed_to_significant(BOTH)
    assert last - first <= part.duration <= last - first + 2.0 * BOTH.time_step
    assert trimmed_to_significant(BOTH, padding=0.1).duration == pytest.approx(part.duration + 0.2, abs=0.0201)
    assert len(trimmed_to_significant(BOTH, padding=100.0)) == len(BOTH)


def test_turning_keeps_the_length_of_the_vector():
    """Turned components have the same resultant, a turn back restores them, and a motion along 30 degrees is found."""
    x, y = BOTH, GroundMotion(np.roll(NOISE, 7), 0.01)
    a, b = rotated(x, y, 0.7)
    np.testing.assert_allclose(
        np.hypot(a.acceleration, b.acceleration), np.hypot(x.acceleration, y.acceleration), rtol=1e-12
    )
    np.testing.assert_allclose(rotated(a, b, -0.7)[0].acceleration, x.acceleration, rtol=0.0, atol=1e-14)
    along = GroundMotion(math.cos(math.pi / 6) * NOISE, 0.01), GroundMotion(math.sin(math.pi / 6) * NOISE, 0.01)
    turned = rotated(*along, math.pi / 6)
    np.testing.assert_allclose(turned[0].acceleration, NOISE, rtol=0.0, atol=1e-14)
    assert turned[1].peak < 1e-14


def test_rotd_of_a_straight_and_a_circular_motion():
    """On a line the peaks are P |cos|: median P / sqrt(2), largest P; on a circle all are the radius."""
    still = GroundMotion(np.zeros(1001), 0.01)
    peak = BOTH.peak
    # every degree: the median of |cos| is within one degree of 45
    assert rotd_pga(BOTH, still, 50) == pytest.approx(peak / math.sqrt(2.0), rel=0.01)
    assert rotd_pga(BOTH, still, 100) == peak
    assert rotd_pga(BOTH, still, 0) < 1e-12
    phase = np.linspace(0.0, 2.0 * np.pi, 1001)
    circle = GroundMotion(2.0 * np.cos(phase), 0.01), GroundMotion(2.0 * np.sin(phase), 0.01)
    for percentile in (0, 50, 100):
        assert rotd_pga(*circle, percentile) == pytest.approx(2.0, rel=1e-5)


def test_every_change_leaves_a_line():
    """Each function adds exactly one sentence of provenance and keeps the name."""
    changed = [
        demeaned(BOTH), detrended(BOTH), tapered(BOTH), bandpassed(BOTH, 1.0, 20.0), resampled(BOTH, 0.005),
        resampled(BOTH, 0.02), trimmed(BOTH, 1.0, 2.0), trimmed_to_significant(BOTH), padded(BOTH, 1.0),
        *rotated(BOTH, BOTH, 0.1),
    ]  # fmt: skip
    for motion in changed:
        assert len(motion.provenance) == 1
        assert motion.vertical is not None
        assert motion.name == BOTH.name
    assert resampled(BOTH, 0.01) is BOTH


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda m: detrended(m, 4), "order"),
        (lambda m: detrended(m, True), "order"),
        (lambda m: detrended(m, 1, "displacement"), "fit"),
        (lambda m: detrended(trimmed(m, 0.0, 0.02), 3), "samples"),
        (lambda m: tapered(m, 0.6), "fraction"),
        (lambda m: tapered(m, 0.5 + 1e-9), "fraction"),
        (lambda m: tapered(m, 0.0), "fraction"),
        (lambda m: tapered(m, -0.1), "fraction"),
        (lambda m: bandpassed(m, 5.0, 5.0), "high"),
        (lambda m: bandpassed(m, 1.0, 50.0), "high"),
        (lambda m: bandpassed(m, 0.0, 10.0), "low"),
        (lambda m: bandpassed(m, 1.0, 10.0, 0), "order"),
        (lambda m: bandpassed(m, 1.0, 10.0, 2.5), "order"),
        (lambda m: resampled(m, 0.015), "whole multiple"),
        (lambda m: resampled(m, 20.0), "2 samples"),
        (lambda m: resampled(m, 1e-9), "wrong unit"),
        (lambda m: resampled(m, math.nan), "time_step"),
        (lambda m: trimmed(m, -1.0, 2.0), "start"),
        (lambda m: trimmed(m, 2.0, 2.0), "end"),
        (lambda m: trimmed(m, 1.0, 11.0), "end"),
        (lambda m: trimmed_to_significant(m, padding=-1.0), "padding"),
        (lambda m: padded(m, -1.0), "before"),
        (lambda m: padded(m, 1e9), "wrong unit"),
        (lambda m: rotated(m, trimmed(m, 0.0, 1.0), 0.1), "second"),
        (lambda m: rotd_pga(m, m, 101), "percentile"),
    ],
)
def test_bad_values_are_refused(change, match):
    """No value outside its range gives a motion, and the error names the value."""
    with pytest.raises(InvalidValueError, match=match):
        change(BOTH)
