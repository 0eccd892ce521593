"""Pulse-like motions: the pulse is in the sum, whole and where it was put."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, ground_velocity, peak_ground_velocity
from rocking.motions.pulses import mavroeidis_papageorgiou
from rocking.motions.synthetic import Uniform, family, with_pulse

STEP = 0.005
PULSE = mavroeidis_papageorgiou(velocity=0.7, period=1.2, cycles=2.0, phase=0.0)


def residual(count=2000):
    """Small noise with a vertical part."""
    noise = np.random.default_rng(2).standard_normal((2, count))
    return GroundMotion(0.1 * noise[0], STEP, 0.05 * noise[1], name="noise")


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


def test_vertical_part_is_as_long_as_the_sum():
    """A pulse that ends after the residual lengthens the vertical part with stillness."""
    motion = with_pulse(residual(100), PULSE, 2.0)
    assert motion.vertical.size == len(motion)
    assert not motion.vertical[100:].any()


@pytest.mark.parametrize(
    ("pulse", "arrival", "words"),
    [
        (PULSE, 0.5, "begin before the motion"),
        (PULSE, float("nan"), "arrival must be finite"),
        (PULSE, 1e9, "arrival must be in"),
        (residual(), 3.0, "pulse must be a pulse"),
    ],
)
def test_refusals(pulse, arrival, words):
    """A pulse that would begin too early or never, and what is no pulse."""
    with pytest.raises(InvalidValueError, match=words):
        with_pulse(residual(), pulse, arrival)
