"""Baselines, filters, resampling, cutting and scaling against closed forms; what is refused."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_cases import accelerations

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
    scaled_to,
    significant_times,
    spectral_measure,
    tapered,
    trimmed,
    trimmed_to_significant,
)

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
    for frequency, gain in ((0.5, 0.5), (10.0, 0.5), (2.2, 1.0), (0.02, 0.0), (45.0, 0.0)):
        motion = _sine(frequency)
        filtered, expected = bandpassed(motion, 0.5, 10.0, order), gain * motion.acceleration
        # the gain in the pass band is not quite 1 for order 2, hence the 2 %
        slack = 2e-2 if gain == 1.0 else 2e-3
        np.testing.assert_allclose(filtered.acceleration[middle], expected[middle], atol=slack, rtol=0.0)


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


@given(accelerations(2, 12), st.integers(2, 7))
def test_refining_by_whole_ratios_is_the_same_motion(row, ratio):
    """Velocity and displacement are those of the coarse motion, and its samples are kept."""
    motion = GroundMotion(row, 0.2)
    fine = resampled(motion, 0.2 / ratio)
    np.testing.assert_allclose(fine.acceleration[::ratio], motion.acceleration, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(ground_displacement(fine)[::ratio], ground_displacement(motion), rtol=0.0, atol=1e-12)


def test_trimming_and_padding_undo_each_other():
    """Zeros added are cut off again, sample by sample, with both components."""
    longer = padded(BOTH, 0.5, 1.0)
    assert len(longer) == 1001 + 150
    again = trimmed(longer, 0.5, 0.5 + BOTH.duration)
    np.testing.assert_array_equal(again.acceleration, BOTH.acceleration)
    np.testing.assert_array_equal(again.vertical, BOTH.vertical)


def test_trimming_to_the_significant_part():
    """The part between 5 and 95 % begins and ends within a step of these times, and padding widens it."""
    first, last = significant_times(BOTH)
    part = trimmed_to_significant(BOTH)
    assert last - first <= part.duration <= last - first + 2.0 * BOTH.time_step
    assert trimmed_to_significant(BOTH, padding=0.1).duration == pytest.approx(part.duration + 0.2, abs=0.0201)
    assert len(trimmed_to_significant(BOTH, padding=100.0)) == len(BOTH)


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


MOTION = GroundMotion(np.array([0.0, 1.0, -2.0, 4.0]), 0.1, vertical=np.array([1.0, 0.0, 0.0, 2.0]), name="m")


def test_finer_is_on_the_lines() -> None:
    """Half the step keeps every sample and puts means between; both parts, name and a line of provenance."""
    fine = resampled(MOTION, 0.05)
    np.testing.assert_allclose(fine.acceleration, [0.0, 0.5, 1.0, -0.5, -2.0, 1.0, 4.0], rtol=0.0, atol=1e-14)
    assert fine.vertical is not None
    np.testing.assert_allclose(fine.vertical, [1.0, 0.5, 0.0, 0.0, 0.0, 1.0, 2.0], rtol=0.0, atol=1e-14)
    assert (fine.time_step, fine.name) == (0.05, "m")
    assert fine.provenance[-1] == "interpolated linearly from 0.1 s to 0.05 s"


def test_any_ratio() -> None:
    """Steps of 0.08 s are on the lines, with a zero after the record; whole ratios keep the last; the same step all."""
    other = resampled(MOTION, 0.08)
    np.testing.assert_allclose(other.acceleration, [0.0, 0.8, -0.8, 0.4, 0.0], rtol=0.0, atol=1e-14)
    for parts in (3, 7, 10, 49, 1000):
        fine = resampled(MOTION, 0.1 / parts)
        assert len(fine) == 3 * parts + 1
        assert fine.acceleration[-1] == 4.0
    assert resampled(MOTION, 0.1) is MOTION


def test_coarser_is_filtered() -> None:
    """Sines come out at once and as large as the windowed sinc says: slow ones whole, those beyond the new step not."""
    step, factor, name = 0.005, 4, "low-passed (linear phase) and coarsened from 0.005 s to 0.02 s"
    t, reach = np.arange(4001) * step, 10 * factor
    place = np.arange(-reach, reach + 1)
    taps = np.sinc(place / factor) * (0.54 + 0.46 * np.cos(math.pi * place / reach))
    taps /= taps.sum()
    # the new step carries 25 Hz; the ripple of a Hamming window is 0.0022 before and behind
    for frequency, least, most in ((1.0, 0.998, 1.002), (20.0, 0.996, 1.004), (30.0, 0.0, 0.003), (45.0, 0.0, 0.003)):
        gain = taps @ np.cos(2.0 * math.pi * frequency * step * place)
        assert least <= abs(gain) <= most
        wave = np.sin(2.0 * math.pi * frequency * t)
        coarse = resampled(GroundMotion(wave, step), factor * step)
        # away from the ends, where the taps reach beyond the samples: rounding of 81 products alone
        np.testing.assert_allclose(coarse.acceleration[10:-10], gain * wave[::factor][10:-10], rtol=0.0, atol=2e-12)
        assert np.abs(wave[::factor][10:-10]).max() > 0.9, "control: without the filter it is there"
        assert name in coarse.provenance


def test_steps_typed_to_a_few_digits() -> None:
    """A step is an integer multiple to a part in a million: 2 and 5 times a thirtieth in seven decimals."""
    motion = GroundMotion(np.sin(0.1 * np.arange(200)), 1.0 / 30.0)
    for step, samples in ((0.0666667, 100), (0.1666667, 40)):
        assert len(resampled(motion, step)) == samples
    for step in (0.066667, 0.1667):
        with pytest.raises(InvalidValueError, match="integer multiple"):
            resampled(motion, step)


def test_trimmed_goes_outwards() -> None:
    """Times between samples go to the next one outwards; the whole is the whole; two samples are the least."""
    assert trimmed(MOTION, 0.12, 0.28).acceleration.tolist() == [1.0, -2.0, 4.0]
    assert trimmed(MOTION, 0.0, 0.3).acceleration.tolist() == [0.0, 1.0, -2.0, 4.0]
    assert trimmed(MOTION, 0.21, 0.22).acceleration.tolist() == [-2.0, 4.0]
    part = trimmed(MOTION, 0.1, 0.2)
    assert part.acceleration.tolist() == [1.0, -2.0]
    assert part.vertical is not None
    assert part.vertical.tolist() == [0.0, 0.0]
    assert part.provenance == ("trimmed to 0.1 to 0.2 s",)


def test_trimmed_to_significant() -> None:
    """Of a burst between rests what is left is the burst, with the padding asked for."""
    burst = np.zeros(101)
    burst[40:61] = 1.0
    motion = GroundMotion(burst, 1.0)
    short = trimmed_to_significant(motion)
    # energy is 20 + 2/3; 5 % of it are reached 0.7 s after the burst is whole, at 40.7 s, and 95 % at 59.3 s
    assert len(short) == 21
    assert short.acceleration.tolist() == [1.0] * 21
    assert len(trimmed_to_significant(motion, padding=10.0)) == 41
    assert len(trimmed_to_significant(motion, 0.0, 100.0, padding=1e9)) == 101


def test_padded() -> None:
    """Zeros before and after, rounded up to whole steps, as many after as before unless said."""
    assert padded(MOTION, 0.15).acceleration.tolist() == [0.0, 0.0, 0.0, 1.0, -2.0, 4.0, 0.0, 0.0]
    one = padded(MOTION, 0.0, 0.1)
    assert one.acceleration.tolist() == [0.0, 1.0, -2.0, 4.0, 0.0]
    assert one.vertical is not None
    assert one.vertical.tolist() == [1.0, 0.0, 0.0, 2.0, 0.0]
    assert one.provenance[-1] == "padded with zeros, 0 samples before and 1 after"


ZIGZAG = GroundMotion([0.0, 1.0, -1.0, 0.0], 1.0, vertical=[0.0, 0.5, 0.25, 0.0])


def test_targets_are_met_by_closed_forms():
    """The zigzag has PGA 1 and PGV 3/4; a step has PSA 2: the factors follow, for the vertical part too."""
    np.testing.assert_allclose(scaled_to(ZIGZAG, "pga", 2.5).vertical, 2.5 * ZIGZAG.vertical, rtol=1e-15)
    np.testing.assert_allclose(scaled_to(ZIGZAG, "pgv", 1.5).acceleration, 2.0 * ZIGZAG.acceleration, rtol=1e-15)
    step = GroundMotion(np.ones(200), 0.01)
    assert scaled_to(step, spectral_measure(0.5, 0.0), 5.0).peak == pytest.approx(2.5, rel=1e-4)


def test_provenance_tells_the_target():
    """The line of provenance names measure, target and factor."""
    assert "PGV is 1.5 m/s" in scaled_to(ZIGZAG, "pgv", 1.5).provenance[-1]
    assert "PSA(1 s, 0.05)" in scaled_to(ZIGZAG, "sa(1)", 1.0).provenance[-1]


REST = GroundMotion([0.0, 0.0], 0.1)
REFUSED: list[tuple[str, Any]] = [
    *((r"order must be a whole number in \[1, 3\]", lambda x=x: detrended(BOTH, x)) for x in (4, True)),
    ("fit must be", lambda: detrended(BOTH, 1, "displacement")),  # type: ignore[arg-type]
    ("needs at least 5 samples, got 3", lambda: detrended(trimmed(BOTH, 0.0, 0.02), 3)),
    *(("fraction must be", lambda x=x: tapered(BOTH, x)) for x in (0.6, 0.5 + 1e-9, 0.0, -0.1)),
    *(("high must be", lambda x=x: bandpassed(BOTH, *x)) for x in ((5.0, 5.0), (1.0, 50.0))),
    ("low must be", lambda: bandpassed(BOTH, 0.0, 10.0)),
    *(("order must be a whole number", lambda x=x: bandpassed(BOTH, 1.0, 10.0, x)) for x in (0, 2.5)),
    ("above 0.1 s must be an integer multiple of 0.1 s, got 0.15 s, 1.5 times 0.1 s", lambda: resampled(MOTION, 0.15)),
    ("must be at most 0.3 s, so that 2 samples remain, got 0.4 s", lambda: resampled(MOTION, 0.4)),
    ("at most 1e\\+08 samples, got 2.72727e\\+08; check the unit", lambda: resampled(MOTION, 1.1e-9)),
    *(("in seconds", lambda x=x: resampled(MOTION, x)) for x in (1e-10, 2000.0)),
    *(("time_step must be in", lambda x=x: resampled(MOTION, x)) for x in (0.0, -0.1)),
    ("time_step must be finite", lambda: resampled(MOTION, math.nan)),
    *(("time_step must be a number", lambda x=x: resampled(MOTION, x)) for x in (None, "0.1")),
    *(("start must be in", lambda x=x: trimmed(MOTION, *x)) for x in ((-0.1, 0.2), (0.4, 0.5))),
    ("end must be after start", lambda: trimmed(MOTION, 0.2, 0.2)),
    *(("end must be in", lambda x=x: trimmed(MOTION, *x)) for x in ((0.2, 0.1), (0.1, 0.31))),
    ("start must be finite", lambda: trimmed(MOTION, math.nan, 0.2)),
    ("end must be a number", lambda: trimmed(MOTION, 0.1, None)),  # type: ignore[arg-type]
    *(("padding must be", lambda x=x: trimmed_to_significant(BOTH, padding=x)) for x in (-1.0, math.nan, None)),
    ("record of zeros", lambda: trimmed_to_significant(GroundMotion(np.zeros(5), 1.0))),
    *(("before must be", lambda x=x: padded(MOTION, x)) for x in (-0.1, math.nan, math.inf, True, "1", None)),
    *(("after must be", lambda x=x: padded(MOTION, 0.0, x)) for x in (-0.1, math.nan, math.inf, True, "1")),
    ("at most 1e\\+08 samples, got 2e\\+07 s; check the unit", lambda: padded(MOTION, 1e7)),
    *(("record of zeros", lambda x=x: scaled_to(REST, x, 1.0)) for x in ("pga", "pgv", "sa(1)")),
    *(("target must be", lambda x=x: scaled_to(ZIGZAG, "pga", x)) for x in (0.0, -1.0, np.nan)),
    *(("target must be", lambda x=x: scaled_to(ZIGZAG, "pgv", x)) for x in (0.0, -1.0, np.nan)),
    ("check the unit", lambda: scaled_to(ZIGZAG, "pga", 1e9)),
]


def test_what_is_refused() -> None:
    """Orders, corners, steps, times and targets out of range or no numbers are refused, each by its own sentence."""
    for message, change in REFUSED:
        with pytest.raises(InvalidValueError, match=message):
            change()
