"""How long it will still take: played with costs that are known, and a clock that only they move."""

import heapq
import sys
from pathlib import Path

import numpy as np
import pytest

from rocking.campaigns import Estimate, forecast
from rocking.campaigns.chunks import Chunk, Plan
from rocking.campaigns.forecast import trial
from rocking.campaigns.running import Remaining
from rocking.campaigns.status import Costs, Speed

sys.path.insert(0, str(Path(__file__).parent))
from slow import Motions, costly, product

COUNT = 24_000
SHARE = (np.arange(COUNT) + 0.5) / COUNT
RANDOM = np.random.default_rng(7)
EACH = 12
"""Costs [s] of all histories of a job; in most of them what comes first says little of what comes last."""
JOBS = {
    "all the same": np.full(COUNT, 0.02),
    "a map, from weak to strong": 0.04 * SHARE**2,
    "a map, from strong to weak": 0.04 * (1.0 - SHARE),
    "half of it never lifts": np.where(SHARE < 0.5, 1e-5, 0.03),
    "in motions": np.where(np.arange(COUNT) % EACH == 0, 0.2, 1e-5),
    "in motions of all lengths": np.where(
        np.arange(COUNT) % EACH == 0, np.repeat(RANDOM.lognormal(np.log(0.15), 0.7, COUNT // EACH), EACH), 1e-4
    ),
    "heavy tails": RANDOM.lognormal(np.log(0.01), 1.2, COUNT),
}
DRAWN = {"in motions of all lengths", "heavy tails"}


def played(costs, workers, size):
    """Run a job of known costs: time, estimate and rate after each piece; and when it was over."""
    plan = Plan("a" * 64, COUNT, size, "fast", "1.0")
    known, ends = Costs(COUNT), np.cumsum(costs)
    now, work, done, told, speed = 0.0, 0.0, 0, [], Speed()
    left = Remaining(plan, np.arange(plan.chunks), {}, EACH, known, sharers=lambda: workers)
    busy: list[tuple[float, Chunk, float]] = []
    while True:
        while len(busy) < workers and (asked := next(left, None)) is not None:
            before = ends[asked.first] - costs[asked.first]
            last = min(asked.last, int(np.searchsorted(ends, before + 1.0)) // EACH * EACH + EACH)  # as of a second
            heapq.heappush(
                busy, (now + ends[last - 1] - before, asked.piece(asked.first, last), ends[last - 1] - before)
            )
        if not busy:
            return told, now
        now, piece, seconds = heapq.heappop(busy)
        known.add(piece.first, piece.last, seconds)
        left.back(piece, seconds)
        work, done = work + seconds, done + piece.last - piece.first
        estimate = known.left()
        pace = speed.look(work, now)
        estimate = estimate.at(pace) if estimate and pace else None
        told.append((now, estimate, (COUNT - done) * now / done))


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2, 8])
@pytest.mark.parametrize("size", [COUNT, 3996, 252])
@pytest.mark.parametrize("job", JOBS)
def test_estimates_are_near_and_say_how_near(job, size, workers):
    """Of jobs of up to eight minutes: wrong by less than a minute, within bounds, soon and to the end.

    Where costs are drawn, they are known so well once a tenth is through; before, their bounds say how little is known.
    """
    told, end = played(JOBS[job], workers, size)
    first = next(at for at, estimate, _ in told if estimate is not None)
    assert first < 10.0  # a quarter of a second for each of 16 parts, and some seconds to see how fast work is done
    wrong = [(at, estimate.seconds - (end - at)) for at, estimate, _ in told if estimate is not None]
    assert max(abs(off) for at, off in wrong if at > 0.1 * end or job not in DRAWN) < 60.0
    # two seconds: pieces that are being computed are of that order
    within = [each.low - 2.0 <= end - at <= each.high + 2.0 for at, each, _ in told if each is not None]
    assert np.mean(within) > 0.95  # bounds of two standard deviations
    assert told[-1][1] == Estimate(0.0, 0.0, 0.0)


def test_an_estimate_by_the_rate_alone_would_be_caught():
    """Negative control: histories left over histories a second is wrong by minutes where costs change."""
    told, end = played(JOBS["half of it never lifts"], 1, 3996)
    assert max(abs(rate - (end - at)) for at, _, rate in told) > 120.0


def test_nothing_is_said_before_something_is_known():
    """While a part has not been measured there is no number."""
    told, _ = played(JOBS["all the same"], 1, COUNT)
    assert {estimate for at, estimate, _ in told if at < 4.0} == {None}
    costs = Costs(100)
    assert costs.left() is None
    costs.add(0, 50)  # of an earlier run, which has not noted what it took
    assert costs.left() is None
    costs.add(50, 100, 10.0)
    assert costs.left() == Estimate(0.0, 0.0, 0.0)


class Clock:
    """A time that passes as histories cost, and for nothing else."""

    now = 1000.0

    def perf_counter(self):
        return self.now

    def spend(self, seconds):
        self.now += seconds


@pytest.fixture
def clock(monkeypatch):
    made = Clock()
    monkeypatch.setattr(forecast, "time", made)
    return made


@pytest.mark.slow
@pytest.mark.parametrize("each", [2, 40, 400])
def test_trial_counts_a_motion_once(tmp_path, clock, each):
    """Motions of 20 ms, with however many histories: what a history takes is its share of one motion."""
    found = trial(product(Motions(200, 0.02, tmp_path, clock.spend), each))
    assert found.seconds == pytest.approx(0.02 / each)
    assert found.low < found.seconds < found.high


@pytest.mark.parametrize(
    ("costs", "mean"),
    [(lambda share: 0.002 * share, 0.001), (lambda share: np.where(share < 0.5, 0.0, 0.004), 0.002)],
)
def test_trial_is_spread_over_all(make, clock, costs, mean):
    """Costs that grow, or jump: the mean of all histories is within the bounds."""
    found = trial(costly(make(4000), costs, clock.spend))
    assert found.low < mean < found.high
    assert found.seconds == pytest.approx(mean, rel=0.2)  # 2 s of such runs are a dozen places


def test_trial_of_the_first_histories_would_be_caught(make, clock):
    """Negative control: half of the histories cost nothing, and the first of them say so."""
    work = costly(make(4000), lambda share: np.where(share < 0.5, 0.0, 0.004), clock.spend)
    assert not trial(work).low < forecast._timed(work, 0, 500) < trial(work).high


def test_places_of_a_trial_are_everywhere():
    """However many places there are, no gap is larger than twice the mean one."""
    for number in range(2, 33):
        places = sorted([0.0, 1.0, *(forecast._spread(k) for k in range(1, number + 1))])
        assert max(np.diff(places)) <= 2.0 / number
