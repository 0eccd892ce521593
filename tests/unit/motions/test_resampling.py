"""Resampled, cut and padded records: exact where straight lines are, clean where a filter is needed."""

import math
from typing import Any

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, padded, resampled, trimmed, trimmed_to_significant

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
    """Steps of 0.08 s: on the lines by hand, and a zero where the record is over."""
    other = resampled(MOTION, 0.08)
    np.testing.assert_allclose(other.acceleration, [0.0, 0.8, -0.8, 0.4, 0.0], rtol=0.0, atol=1e-14)


def test_the_last_sample_stays() -> None:
    """Rounding does not drop the last sample, whatever the whole ratio."""
    for parts in (3, 7, 10, 49, 1000):
        fine = resampled(MOTION, 0.1 / parts)
        assert len(fine) == 3 * parts + 1
        assert fine.acceleration[-1] == 4.0


def test_the_same_step() -> None:
    """The step that it has changes nothing."""
    assert resampled(MOTION, 0.1) is MOTION


def test_coarser_is_filtered() -> None:
    """A slow sine passes with its amplitude and phase; one beyond the new step's reach does not become another."""
    t = np.arange(4001) * 0.005
    slow, quick = np.sin(2.0 * math.pi * 1.0 * t), np.sin(2.0 * math.pi * 45.0 * t)
    inside = slice(50, -50)
    kept = resampled(GroundMotion(slow, 0.005), 0.02)
    np.testing.assert_allclose(kept.acceleration[inside], slow[::4][inside], rtol=0.0, atol=5e-3)
    assert np.abs(resampled(GroundMotion(quick, 0.005), 0.02).acceleration[inside]).max() < 0.01
    assert np.abs(quick[::4][inside]).max() > 0.9, "control: without the filter it is there"
    assert "low-passed (linear phase) and coarsened from 0.005 s to 0.02 s" in kept.provenance


def test_steps_typed_to_a_few_digits() -> None:
    """A step is a whole multiple if it is one to a part in a million: 2 and 5 times a thirtieth in seven decimals."""
    motion = GroundMotion(np.sin(0.1 * np.arange(200)), 1.0 / 30.0)
    for step, samples in ((0.0666667, 100), (0.1666667, 40)):
        assert len(resampled(motion, step)) == samples
    for step in (0.066667, 0.1667):
        with pytest.raises(InvalidValueError, match="whole multiple"):
            resampled(motion, step)


@pytest.mark.parametrize(
    ("step", "message"),
    [
        (0.15, "whole multiple of 0.1 s if above, got 0.15 s, 1.5 times"),
        (0.4, "must leave 2 samples, at most 0.3 s, got 0.4 s"),
        (1.1e-9, "at most 1e\\+08 samples, got 2.72727e\\+08; wrong unit"),
        (1e-10, "in seconds"),
        (2000.0, "in seconds"),
        (0.0, "time_step must be in"),
        (-0.1, "time_step must be in"),
        (math.nan, "time_step must be finite"),
        (None, "time_step must be a number"),
        ("0.1", "time_step must be a number"),
    ],
)
def test_bad_steps(step: Any, message: str) -> None:
    """Steps that are no multiple, leave too few or too many samples, or are no number are refused."""
    with pytest.raises(InvalidValueError, match=message):
        resampled(MOTION, step)


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


@pytest.mark.parametrize(
    ("start", "end", "message"),
    [
        (-0.1, 0.2, "start must be in"),
        (0.4, 0.5, "start must be in"),
        (0.2, 0.2, "end must be after start"),
        (0.2, 0.1, "end must be in"),
        (0.1, 0.31, "end must be in"),
        (math.nan, 0.2, "start must be finite"),
        (0.1, None, "end must be a number"),
    ],
)
def test_bad_cuts(start: Any, end: Any, message: str) -> None:
    """Times outside the record, out of order, or no numbers are refused."""
    with pytest.raises(InvalidValueError, match=message):
        trimmed(MOTION, start, end)


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
    bad: Any
    for bad in (-1.0, math.nan, None):
        with pytest.raises(InvalidValueError, match="padding must be"):
            trimmed_to_significant(motion, padding=bad)
    with pytest.raises(InvalidValueError, match="zero throughout"):
        trimmed_to_significant(GroundMotion(np.zeros(5), 1.0))


def test_padded() -> None:
    """Zeros before and after, rounded up to whole steps, as many after as before unless said."""
    assert padded(MOTION, 0.15).acceleration.tolist() == [0.0, 0.0, 0.0, 1.0, -2.0, 4.0, 0.0, 0.0]
    one = padded(MOTION, 0.0, 0.1)
    assert one.acceleration.tolist() == [0.0, 1.0, -2.0, 4.0, 0.0]
    assert one.vertical is not None
    assert one.vertical.tolist() == [1.0, 0.0, 0.0, 2.0, 0.0]
    assert one.provenance[-1] == "padded with zeros, 0 samples before and 1 after"
    bad: Any
    for bad in (-0.1, math.nan, math.inf, True, "1"):
        with pytest.raises(InvalidValueError, match="before must be"):
            padded(MOTION, bad)
        with pytest.raises(InvalidValueError, match="after must be"):
            padded(MOTION, 0.0, bad)
    nothing: Any = None
    with pytest.raises(InvalidValueError, match="before must be a number"):
        padded(MOTION, nothing)
    with pytest.raises(InvalidValueError, match="at most 1e\\+08 samples, got 2e\\+07 s; wrong unit"):
        padded(MOTION, 1e7)
