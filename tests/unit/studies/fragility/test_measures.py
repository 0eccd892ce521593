"""Intensity measures of sets of motions: values, how they scale, names, refusals."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.motions import RockingScale, intensity, measure, measures, spectral_measure
from rocking.motions.intensity import sampled, spectral_period
from rocking.studies import MotionList

BODY = RockingScale(threshold=2.5, frequency_parameter=1.6, gravity=9.80665)
RECORD = rk.GroundMotion(np.sin(np.linspace(0.0, 12.0, 400)) * np.linspace(0.0, 3.0, 400), 0.01)
NAMES = [*measures(), "sa(0.4)", "sa(1.0,0.02)"]


@given(factor=st.floats(0.01, 100.0), name=st.sampled_from(NAMES))
def test_scaling_law_of_every_measure(factor, name):
    """The measure of the scaled motion, computed afresh, is what the power law of the measure says."""
    one = measure(name)
    before = one.values(MotionList(RECORD), BODY)
    after = one.values(MotionList(RECORD.scaled(factor)), BODY)
    np.testing.assert_allclose(after, one.scaled(before, factor), rtol=1e-11)


@pytest.mark.parametrize("name", [name for name in NAMES if measure(name).power])
def test_factors_reach_the_targets(name):
    """A motion multiplied by its factor has the wanted measure, computed afresh."""
    one = measure(name)
    motions = MotionList([RECORD, RECORD.scaled(0.3)])
    factors = one.factors(one.values(motions, BODY), np.array([0.7, 5.0]))
    assert factors.shape == (2, 2)
    for k in range(2):
        for level, target in enumerate((0.7, 5.0)):
            reached = one.values(MotionList(motions[k].scaled(float(factors[k, level]))), BODY)
            assert reached[0] == pytest.approx(target, rel=1e-11, abs=0.0)


def test_normalised_measures_by_their_definition():
    """The measures that know the body are the plain ones over g tan(alpha), times p."""
    motions = MotionList(RECORD)
    pga, pgv = (measure(name).values(motions, BODY)[0] for name in ("pga", "pgv"))
    wanted = {
        "pga/(g tan alpha)": pga / 2.5,
        "p pgv/(g tan alpha)": 1.6 * pgv / 2.5,
        "pgv/pga": pgv / pga,
        "p pgv/pga": 1.6 * pgv / pga,
    }
    for name, value in wanted.items():
        assert measure(name).values(motions, BODY)[0] == pytest.approx(value, rel=1e-14, abs=0.0)


def test_pulses_against_their_closed_forms():
    """Full sine of one second: PGA a, PGV a T / pi, Arias pi a^2 T / (4 g), CAV 2 a T / pi."""
    motions, a = MotionList(rk.pulses.sine(3.0, 1.0)), 3.0
    wanted = {
        "pga": (a, 1e-15),
        "pgv": (a / math.pi, 1e-6),
        "pgd": (a / (2.0 * math.pi), 1e-6),
        "arias": (math.pi * a * a / (4.0 * 9.80665), 1e-6),
        "cav": (2.0 * a / math.pi, 1e-6),
    }
    for name, (value, tolerance) in wanted.items():
        assert measure(name).values(motions, BODY)[0] == pytest.approx(value, rel=tolerance)


def test_peak_of_sampled_pulses_is_exact():
    """The largest sample of a pulse is its peak, also where no sample falls on it."""
    for make in (rk.pulses.cosine, rk.pulses.ricker, rk.pulses.type_c):
        pulse = make(2.0, 0.77)
        assert sampled(pulse).peak == pulse.peak


def test_spectral_measure_is_the_pseudo_acceleration():
    """The name carries period and damping to the spectrum and back."""
    one = measure("sa(0.7,0.1)")
    assert one.values(MotionList(RECORD), BODY)[0] == intensity.spectral_acceleration(RECORD, 0.7, 0.1)
    assert spectral_period(spectral_measure(0.7, 0.1).name) == (0.7, 0.1)
    assert spectral_period("pga") is None
    assert measure(one) is one
    assert measure(" PGA").name == measure("pga").name == "pga"


def test_motions_without_intensity_are_refused_by_number():
    """A record of zeros has no measure above zero, and the error says which record it is."""
    still = rk.GroundMotion([0.0, 0.0, 0.0], 0.1, name="still ground")
    for name in NAMES:
        with pytest.raises(InvalidValueError, match=r"motion 1, 'still ground'"):
            measure(name).values(MotionList([RECORD, still]), BODY)
