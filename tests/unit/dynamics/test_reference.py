"""The reference engine and its trajectories."""

import math
from typing import Any

import numpy as np
import pytest
from engines import built, every_engine
from numpy.polynomial import Polynomial

import rocking as rk
from rocking.conventions import g
from rocking.dynamics import ConstantRestitution, Outcome, PlaneSettings, RockingParameters, RockingSide
from rocking.dynamics.batch import Batch
from rocking.dynamics.plane.equations import EventKind, Trajectory
from rocking.dynamics.plane.reference import Reference
from rocking.dynamics.rows import Rows
from rocking.dynamics.taylor import first_fall, last_fall, turning_points
from rocking.errors import InvalidValueError
from rocking.motions import Segments
from rocking.outcome import Status

pytestmark = pytest.mark.verifies(room="rocking in the plane")

ALPHA = 0.2
BLOCK = rk.Block(width=0.5, height=2.0)


def run(segments: Segments, rotation: float = 0.0, velocity: float = 0.0, **settings: Any) -> Trajectory:
    side = RockingSide(ALPHA, 1.0, 1.0, 0.3)
    body = RockingParameters(side, side, ConstantRestitution(), "")
    return Reference(body, segments, PlaneSettings(linear=True, **settings)).run(rotation, velocity)


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
    assert found.peak_rotation / ALPHA == pytest.approx(highest, rel=1e-12, abs=0.0)
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
    assert first_fall(falls.tolist()) == pytest.approx(0.2, rel=1e-14, abs=0.0)
    assert last_fall(falls.tolist()) == pytest.approx(0.8, rel=1e-14, abs=0.0)
    assert first_fall([0.1, -1.0, 2.0]) == pytest.approx((1.0 - math.sqrt(0.2)) / 4.0, rel=1e-14, abs=0.0)
    assert first_fall([0.25, -1.0, 1.0]) is None
    assert first_fall([1.0, -0.5, -0.5 + 1e-9]) is None
    assert last_fall([-0.25, 1.0, -1.0]) is None
    assert last_fall([-1.0, 0.5, 0.4]) is None
    slope = Polynomial.fromroots([0.3, 0.6, 0.7]).integ().coef.tolist()
    assert turning_points(slope, 1.0) == pytest.approx([0.3, 0.6, 0.7], rel=1e-12, abs=0.0)
    assert turning_points(slope, 0.65) == pytest.approx([0.3, 0.6], rel=1e-12, abs=0.0)
    assert turning_points([0.0, 1.0, -0.4], 1.0) == turning_points([0.0, -1.0, 0.4], 1.0) == []
    # let go at rest: the slope is zero at the start, which is no turning point after it
    assert turning_points([1e-12, 0.0, -0.5], 1.0) == []
    assert turning_points([1.0, 0.0, -1.0, 1.0], 1.0) == pytest.approx([2.0 / 3.0], rel=1e-12, abs=0.0)


def time_to_fall(start: float) -> float:
    return math.acosh(1.0 / (1.0 - start))


@pytest.mark.slow
def test_a_fall_that_ends_with_the_record() -> None:
    """Falls of acosh(1 / (1 - x)) / p that take all of it, to the last bits, end in an impact or in the ground."""
    for start in np.linspace(0.05, 0.95, 40):
        for units in range(-2, 3):
            found = run(Segments.still(time_to_fall(start) / 2.0 * (1.0 + units * 2.0**-52), 2), ALPHA * start)
            assert np.abs(found.rotation).max() <= ALPHA * start
            assert found.outcome is Outcome.ROCKED


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
    assert math.isnan(found.peak_velocity)
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


BURSTS = rk.GroundMotion(
    np.concatenate([np.zeros(9), 3.5 * np.sin(np.linspace(0.0, 2.0 * np.pi, 13)), np.zeros(150)] * 2), 0.05
)


@pytest.mark.slow
@every_engine
def test_events_in_order(name: str) -> None:
    """Two bursts with a calm between: each an uplift, impacts and a rest, in order of time, on alternating sides."""
    response = rk.simulate(BLOCK, BURSTS, 0.6, engine=name)
    run = response.trajectory
    times = [e.time for e in run.events]
    assert times == sorted(times)
    kinds = [e.kind for e in run.events]
    assert kinds.count(EventKind.UPLIFT) == kinds.count(EventKind.REST) == run.uplifts == 2
    assert (kinds[0], kinds[-1]) == (EventKind.UPLIFT, EventKind.REST)
    assert kinds.count(EventKind.IMPACT) == run.impacts == response.impacts.size
    np.testing.assert_array_equal(response.uplifts, [t for t, k in zip(times, kinds, strict=True) if k == 0])
    for before, event in zip(run.events[:-1], run.events[1:], strict=True):
        if event.kind is EventKind.IMPACT:
            assert event.side == -before.side, "an impact is a change of foot"
            assert event.after == event.coefficient * event.before == 0.6 * event.before
            assert event.before * before.side < 0.0, "the body comes down"
    calm = response.time[(response.time > times[kinds.index(EventKind.REST)]) & (response.time < response.uplifts[1])]
    assert calm.size > 20
    assert not response.at(calm).any()


@every_engine
def test_after_overturning_there_is_nothing(name: str) -> None:
    """Arrays keep the length of the motion; where the body lies they hold NaN, and the response leaves that out."""
    response = rk.simulate(BLOCK, rk.pulses.rectangular(6.0, 1.0), 0.6, engine=name, duration=10.0)
    run = response.trajectory
    assert run.outcome is Outcome.OVERTURNED
    assert run.rotation.shape == run.angular_velocity.shape == (response.segments.count + 1,)
    lies = np.isnan(run.rotation)
    assert lies[-1]
    np.testing.assert_array_equal(lies, np.isnan(run.angular_velocity))
    assert np.all(np.diff(lies.astype(int)) >= 0), "once down, down"
    assert response.time.size == (~lies).sum()
    assert run.overturning_time == run.peak_time < response.time[-1]


@pytest.mark.verifies("second engine", "the reference engine", within="1e-9 s, 1e-10 rad")
@built
def test_engines_hand_back_the_same() -> None:
    """Events of both engines agree in kind and side, in time to 1e-9 s, and rotations to 1e-10 rad."""
    fast, slow = (rk.simulate(BLOCK, BURSTS, 0.6, engine=name).trajectory for name in ("fast", "reference"))
    assert [(e.kind, e.side) for e in fast.events] == [(e.kind, e.side) for e in slow.events]
    np.testing.assert_allclose([e.time for e in fast.events], [e.time for e in slow.events], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(fast.rotation, slow.rotation, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(fast.angular_velocity, slow.angular_velocity, rtol=0.0, atol=1e-9)
    assert fast.peak_rotation == pytest.approx(slow.peak_rotation, rel=1e-10)
    assert fast.engine != slow.engine


@every_engine
def test_error_and_peaks_are_finite(name: str) -> None:
    """A good history has finite peaks, an error estimate from zero, and no overturning time."""
    run = rk.simulate(BLOCK, BURSTS, 0.6, engine=name).trajectory
    assert 0.0 <= run.truncation < 1e-8
    assert math.isfinite(run.peak_velocity)
    assert run.peak_velocity >= np.abs(run.angular_velocity).max() * (1.0 - 1e-12)
    assert abs(run.peak_rotation) >= np.abs(run.rotation).max() * (1.0 - 1e-12)
    assert math.isnan(run.overturning_time)
    assert run.side == 0
    with pytest.raises(AttributeError):
        run.side = 1  # type: ignore[misc]


def peaks(name: str, motions: list[Segments]) -> np.ndarray:
    """Peaks of one body under some motions laid out in one library."""
    body = {f"{key}_{side}": x for key, x in (("alpha", 0.25), ("p", 2.0), ("r", 0.6)) for side in ("right", "left")}
    rows = Rows.of(len(motions), motion=np.arange(len(motions)), **body)
    found, _ = Batch(motions, engine=name).run(len(motions), lambda a, b: rows)
    return np.asarray(found["peak_rotation"])


@every_engine
@pytest.mark.parametrize("poison", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("degree", [1, 7])
def test_motions_that_are_not_finite_are_refused(name: str, degree: int, poison: float) -> None:
    """NaN and infinity in any coefficient of any motion are refused before anything is computed."""
    for at in [(0, 0), (3, 1), (8, 0), (8, 1)]:
        lines = np.zeros((9, degree + 1))
        lines[at] = poison
        with pytest.raises(InvalidValueError, match="must be finite"):
            peaks(
                name, [Segments.still(0.1, 4) if degree == 1 else Segments(0.1, np.zeros((4, 8))), Segments(0.1, lines)]
            )


@pytest.mark.slow
@built
def test_records_of_all_kinds_in_one_library() -> None:
    """Records with and without a vertical part, cut off in mid-motion and not, of different lengths: each has the peak
    that it has by the reference engine, and the one it has alone."""
    wave, lift = 4.0 * np.sin(0.3 * np.arange(40)), 2.0 * np.cos(0.4 * np.arange(40))
    cut = [Segments.between_samples(0.05, wave[:n], v) for n, v in ((8, None), (8, lift[:8]), (17, lift[:17]))]
    motions = [Segments.between_samples(0.05, wave), *(c.extended(3.0) for c in cut), cut[0], Segments.still(0.1, 1)]
    together = peaks("fast", motions)
    np.testing.assert_allclose(together, peaks("reference", motions), rtol=1e-8, atol=1e-12)
    np.testing.assert_array_equal(together, np.concatenate([peaks("fast", [motion]) for motion in motions]))
    assert np.unique(together).size > 4, "the motions are told apart"
