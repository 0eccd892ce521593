"""What the engines hand back: events in order, NaN where a body lies, and the same whichever engine it was."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import Outcome
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.plane.batch import Batch, Rows
from rocking.dynamics.plane.trajectory import EventKind
from rocking.errors import InvalidValueError
from rocking.motions import Segments

ENGINES = [
    pytest.param("fast", marks=pytest.mark.skipif(not fast_engine.available(), reason="the fast engine was not built")),
    "reference",
]
every_engine = pytest.mark.parametrize("name", ENGINES)
BLOCK = rk.Block(width=0.5, height=2.0)
BURSTS = rk.GroundMotion(
    np.concatenate([np.zeros(9), 3.5 * np.sin(np.linspace(0.0, 2.0 * np.pi, 13)), np.zeros(150)] * 2), 0.05
)


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


@pytest.mark.skipif(not fast_engine.available(), reason="the fast engine was not built")
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
    assert math.isfinite(run.peak_angular_velocity)
    assert run.peak_angular_velocity >= np.abs(run.angular_velocity).max() * (1.0 - 1e-12)
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


@pytest.mark.skipif(not fast_engine.available(), reason="the fast engine was not built")
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
