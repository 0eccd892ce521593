"""The reference engine where a step holds more than one turn, and at the edges of its numbers.

Motions are made from their responses: for linear equations x = |theta| / alpha, any polynomial x(t) of degree 7, is the
response to a / (g alpha) = x - 1 - x'' / p^2, a polynomial too. So peaks and passages are known beforehand.
"""

import math
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import rocking as rk
from rocking.conventions import g
from rocking.dynamics import Outcome, RockingParameters, RockingSide
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.dynamics.plane.reference import Reference
from rocking.dynamics.plane.trajectory import EventKind, Trajectory
from rocking.dynamics.settings import Settings
from rocking.dynamics.taylor import first_fall, last_fall, turning_points
from rocking.errors import InvalidValueError
from rocking.motions import Segments
from rocking.outcome import Status

ALPHA = 0.2
BLOCK = rk.Block(width=0.5, height=2.0)


def run(segments: Segments, rotation: float = 0.0, velocity: float = 0.0, **settings: Any) -> Trajectory:
    side = RockingSide(ALPHA, 1.0, 1.0, 0.3)
    body = RockingParameters(side, side, ConstantRestitution(), "")
    return Reference(body, segments, Settings(linear=True, **settings)).run(rotation, velocity)


def followed(x: Polynomial, rest: int = 9) -> Trajectory:
    """History of a body that is made to follow x(t) for one stretch of 1 / p, on ground that is still afterwards."""
    push = (x - 1.0 - x.deriv(2)).coef
    rows = np.zeros((1 + rest, 8))
    rows[0, : push.size] = ALPHA * g * push
    return run(Segments(1.0, rows), ALPHA * x(0.0), ALPHA * x.deriv()(0.0))


@pytest.mark.parametrize(
    ("steepness", "turns"),
    [(8.0, (0.2, 0.3, 0.7)), (8.0, (0.2, 0.6, 0.7)), (8.0, (0.1, 0.5, 1.0)), (50.0, (0.1, 0.25, 0.4, 0.6, 0.9))],
)
def test_the_highest_of_several_peaks_in_a_step(steepness: float, turns: tuple[float, ...]) -> None:
    """Of two or three peaks within one step the highest is found, first or last, also where the step ends."""
    x = 0.3 + (-steepness * Polynomial.fromroots(turns)).integ()
    peaks = {x(t): t for t in turns[::2]}
    lower, highest = sorted(peaks)[-2:]
    assert highest > max(lower, x(0.0)) + 1e-3, "the case tells peaks apart"
    found = followed(x)
    assert found.peak_rotation / ALPHA == pytest.approx(highest, rel=1e-12)
    assert found.peak_time == pytest.approx(peaks[highest], abs=1e-7)
    assert found.outcome is Outcome.ROCKED


@pytest.mark.parametrize(
    "top", [(0.8,), (0.2, 0.5, 0.8), (0.3, 0.6), (0.0, 0.4), (0.1, 0.2, 0.5, 0.6, 0.7), (0.0,), (-0.1, -0.05)]
)
def test_the_last_passage_of_the_top_counts(top: tuple[float, ...]) -> None:
    """A body that passes its top, comes back and passes it again within one step overturns at the last passage; one
    let go beyond the top that never comes back at time zero."""
    u = -1.0 * Polynomial.fromroots(top)
    found = followed(1.0 - u)
    assert u(1.0) < 0.0
    assert u.deriv()(1.0) < 0.0
    assert found.outcome is Outcome.OVERTURNED
    assert found.overturning_time == pytest.approx(max(top[-1], 0.0), abs=1e-12)


def test_zeros_of_polynomials() -> None:
    """First and last falls and turning points, by roots that were put there; touching is no fall."""
    falls = -Polynomial.fromroots([0.2, 0.5, 0.8]).coef
    assert first_fall(falls.tolist()) == pytest.approx(0.2, rel=1e-14)
    assert last_fall(falls.tolist()) == pytest.approx(0.8, rel=1e-14)
    assert first_fall([0.1, -1.0, 2.0]) == pytest.approx((1.0 - math.sqrt(0.2)) / 4.0, rel=1e-14)
    assert first_fall([0.25, -1.0, 1.0]) is None
    assert first_fall([1.0, -0.5, -0.5 + 1e-9]) is None
    assert last_fall([-0.25, 1.0, -1.0]) is None
    assert last_fall([-1.0, 0.5, 0.4]) is None
    slope = Polynomial.fromroots([0.3, 0.6, 0.7]).integ().coef.tolist()
    assert turning_points(slope, 1.0) == pytest.approx([0.3, 0.6, 0.7], rel=1e-12)
    assert turning_points(slope, 0.65) == pytest.approx([0.3, 0.6], rel=1e-12)
    assert turning_points([0.0, 1.0, -0.4], 1.0) == turning_points([0.0, -1.0, 0.4], 1.0) == []
    # let go at rest: the slope is zero at the start, which is no turning point after it
    assert turning_points([1e-12, 0.0, -0.5], 1.0) == []
    assert turning_points([1.0, 0.0, -1.0, 1.0], 1.0) == pytest.approx([2.0 / 3.0], rel=1e-12)


def time_to_fall(start: float) -> float:
    return math.acosh(1.0 / (1.0 - start))


@pytest.mark.parametrize("rest", [0, 4])
def test_a_fall_that_ends_on_a_sample(rest: int) -> None:
    """Falls of acosh(1 / (1 - x)) / p that take whole steps, to the last bits, end in an impact, or in the ground only
    where the record ends there."""
    for start in np.linspace(0.05, 0.95, 40):
        for units in range(-2, 3):
            whole = time_to_fall(start) / 2.0 * (1.0 + units * 2.0**-52)
            found = run(Segments.still(whole, 2 + rest), ALPHA * start)
            assert np.abs(found.rotation).max() <= ALPHA * start
            assert found.outcome is Outcome.ROCKED
            if rest:
                assert [event.kind for event in found.events[:2]] == [EventKind.UPLIFT, EventKind.IMPACT]
                assert found.events[1].time == pytest.approx(2.0 * whole, rel=1e-14)
            assert found.impacts >= min(rest, 1)


@pytest.mark.parametrize("linear", [False, True])
def test_rocking_that_dies_out_ends(linear: bool) -> None:
    """With a rest speed of zero each impact is followed down to 1e-9 p alpha: with r = 0.5 and 1e-5 p alpha that takes
    14 halvings, and then the body stands."""
    speed = 1e-5 * BLOCK.slenderness_angle * BLOCK.frequency_parameter
    found = rk.free_rocking(
        BLOCK, 0.0, 0.5, angular_velocity=speed, engine="reference", linear=linear, rest_speed=0.0
    )  # fmt: skip
    assert found.outcome is Outcome.ROCKED
    assert found.impacts.size == math.ceil(math.log2(1e-5 / 1e-9))
    assert not found.rotation[-1]


@pytest.mark.parametrize("rotation", [0.0, 5e-324, -1e-300])
@pytest.mark.parametrize("share", [1e-322, 1e-300, 1e-9, -1e-9])
def test_thrown_by_nothing(share: float, rotation: float) -> None:
    """A body that is upright and thrown with at most 1e-9 p alpha stands; thrown twice as fast it leaves the ground."""
    still = run(Segments.still(0.1, 20), rotation, share * ALPHA)
    assert (still.outcome, still.uplifts, still.impacts, still.peak_rotation) == (Outcome.NO_UPLIFT, 0, 0, 0.0)
    assert not still.rotation[1:].any()
    thrown = run(Segments.still(0.1, 20), 0.0, math.copysign(2e-9, share) * ALPHA)
    assert (thrown.outcome, thrown.uplifts) == (Outcome.ROCKED, 1)


def test_lifted_at_the_last_instant() -> None:
    """A push that passes g alpha by rounding at the very end lifts nothing; one that passes it by a tenth does."""
    for share, expected in ((1.0 + 4e-16, Outcome.NO_UPLIFT), (1.1, Outcome.ROCKED)):
        found = run(Segments.between_samples(0.1, np.array([0.0, share * ALPHA * g])))
        assert found.outcome is expected


def test_numbers_that_run_out() -> None:
    """Where the series is no longer finite the history has failed and has no peak; NaN and infinity do not enter."""
    found = run(Segments.between_samples(1e80, np.array([0.0, 1e200, 1e200])))
    assert (found.outcome, found.status) == (Outcome.FAILED, Status.NOT_FINITE)
    assert math.isnan(found.peak_rotation)
    assert math.isnan(found.peak_angular_velocity)
    for poison in (math.nan, math.inf):
        lines = np.zeros((5, 2))
        lines[3, 1] = poison
        for segments in (Segments(0.1, lines), Segments(0.1, 0.0 * np.ones((5, 2)), lines)):
            with pytest.raises(InvalidValueError, match="must be finite"):
                run(segments)


def test_a_body_that_never_moves_has_its_peak_at_the_start() -> None:
    """Nothing moves: the largest rotation is 0, at 0 s."""
    still = run(Segments(1.0, np.zeros((3, 8))))
    assert (still.peak_rotation, still.peak_time) == (0.0, 0.0)
