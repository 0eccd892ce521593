"""Limits of pulses: how hard they may shake, at which times they may be asked, and how finely they are sampled."""

import math
from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.motions import pulses

PULSE = pulses.sine(amplitude=3.0, period=0.6)
PEAK = r"peak of a pulse must be in \[0, 1e\+06\] m/s2, got"
quantities = pytest.mark.parametrize("quantity", ["acceleration", "velocity", "displacement"])


@pytest.mark.parametrize("make", [pulses.sine, pulses.ricker, pulses.antisymmetric_ricker, pulses.type_c])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_scaled_stays_within_the_limit(make: Any, sign: float) -> None:
    """A scaled pulse obeys the limit of 1e6 m/s2 too, also where the product overflows; at the limit it is taken."""
    for amplitude, factor, shown in ((1e6, 1e6, "1e\\+12"), (10.0, 1e308, "inf"), (1e6, 1.0001, "1.0001e\\+06")):
        with pytest.raises(InvalidValueError, match=f"{PEAK} {shown}"):
            make(amplitude, 1.0).scaled(sign * factor)
    assert make(10.0, 1.0).scaled(sign * 1e5).peak == 1e6


def test_no_body_meets_an_infinite_pulse() -> None:
    """A pulse scaled to infinity is refused, rather than left out so that the body stands."""
    with pytest.raises(InvalidValueError, match=f"{PEAK} inf"):
        rk.simulate(rk.Block(width=0.5, height=2.0), pulses.ricker(10.0, 1.0).scaled(1e308), 0.9)


def test_mavroeidis_papageorgiou_within_the_limit() -> None:
    """Its velocity is refused where the acceleration would pass 1e6 m/s2, and taken just below."""
    with pytest.raises(InvalidValueError, match=r"velocity must be in \[-.*, .*\] m/s, got 1e\+308; the acceleration"):
        pulses.mavroeidis_papageorgiou(1e308, 1e-6)
    most = 1e6 / pulses.mavroeidis_papageorgiou(1.0, 0.8).peak
    for sign in (1.0, -1.0):
        assert pulses.mavroeidis_papageorgiou(sign * most * (1.0 - 1e-9), 0.8).peak == pytest.approx(1e6, rel=1e-8)
        with pytest.raises(InvalidValueError, match="velocity must be in"):
            pulses.mavroeidis_papageorgiou(sign * most * (1.0 + 1e-9), 0.8)


@quantities
@pytest.mark.parametrize("time", [math.nan, math.inf, -math.inf, [0.1, math.nan]])
def test_times_that_are_not_finite(quantity: str, time: Any) -> None:
    """Times that are not finite are refused by value."""
    with pytest.raises(InvalidValueError, match=r"time must be finite \[s\], got (nan|inf|-inf)"):
        getattr(PULSE, quantity)(time)


@quantities
@pytest.mark.parametrize("make", [pulses.sine, pulses.ricker, pulses.antisymmetric_ricker])
def test_shapes(quantity: str, make: Any) -> None:
    """The answer is an array of the shape of the question: a number, a row, a table, nothing at all."""
    for time in (0.1, [0.1], [[0.1, 0.2, 9.0]], []):
        found = getattr(make(3.0, 0.6), quantity)(time)
        assert isinstance(found, np.ndarray)
        assert found.shape == np.shape(time)


def test_how_finely_it_is_sampled() -> None:
    """Steps beyond the limits of a record, or that leave more than 2,000,000 samples, are refused."""
    bad: Any
    for bad in (1e-300, 0.9e-9, 0.0, -0.1, 1001.0):
        with pytest.raises(InvalidValueError, match=r"time_step must be in \[1e-09, 1000\] s, got"):
            PULSE.sampled(bad)
    for bad in (math.nan, None, "0.1"):
        with pytest.raises(InvalidValueError, match="time_step must be"):
            PULSE.sampled(bad)
    with pytest.raises(InvalidValueError, match=r"at most 2e\+06 samples, got 1e-09 s, which leaves 6e\+08"):
        PULSE.sampled(1e-9)
    most = PULSE.duration / 1_999_998
    assert len(PULSE.sampled(most * (1.0 + 1e-9))) == 2_000_000
    with pytest.raises(InvalidValueError, match="at most"):
        PULSE.sampled(PULSE.duration / 1_999_999)


@pytest.mark.parametrize("words", [None, 5, b"sine:amplitude=3,period=0.8", ["sine"], PULSE])
def test_a_pulse_is_written_as_a_string(words: Any) -> None:
    """What is no string is refused with an example of one."""
    with pytest.raises(InvalidValueError, match="a pulse is written as sine:amplitude=3,period="):
        pulses.pulse(words)
