"""Probabilities are right as often as they say: bodies whose base, friction and restitution are hidden.

With ROCKING_CAMPAIGN=1 2,000 bodies of 256 histories each, otherwise 200 of 64.
"""

import os

import numpy as np
import pytest

import rocking as rk
from rocking.motions.intensity import peak_ground_velocity
from rocking.prediction import predict
from rocking.statistics.scores import Forecasts, logistic_left_out

LARGE = "ROCKING_CAMPAIGN" in os.environ
CASES, COUNT, MOTIONS = (2000, 256, 100) if LARGE else (200, 64, 40)
RESTITUTION = {"mean": 0.88, "deviation": 0.04}
BASE, FRICTION = 0.1, (0.1, 0.8)
"""Of the half width at most; and from below to above what keeps these bodies from sliding, so that it decides most."""


def cases():
    """Bodies, motions, and what is hidden: where the feet stand, the friction, the coefficient, which way round."""
    random = np.random.default_rng(17)
    shapes = (rk.pulses.sine, rk.pulses.cosine, rk.pulses.ricker, rk.pulses.antisymmetric_ricker)
    motions = [shapes[k % 4](random.uniform(2.0, 9.0), random.uniform(0.4, 1.2)) for k in range(MOTIONS)]
    for k in range(CASES):
        height = random.uniform(0.8, 2.5)
        body = rk.Block(width=height * random.uniform(0.2, 0.35), height=height)
        left, right = random.uniform(0.0, BASE * body.half_width, 2)
        restitution = float(np.clip(random.normal(RESTITUTION["mean"], RESTITUTION["deviation"]), 0.0, 1.0))
        yield (
            body,
            k % MOTIONS,
            motions[k % MOTIONS],
            (left, right),
            random.uniform(*FRICTION),
            restitution,
            (1.0 if random.random() < 0.5 else -1.0),
        )


@pytest.fixture(scope="module")
def outcomes():
    """Probabilities, those that take the friction for known, what happened, which motion it was, its PGA and PGV."""
    rows = []
    for body, number, motion, (left, right), friction, restitution, sign in cases():
        truly = body.with_feet(body.feet[0] + left, body.feet[1] - right)
        bound = min(
            (truly.side(a).moment_of_inertia / truly.side(b).moment_of_inertia) ** 0.5
            for a, b in (("left", "right"), ("right", "left"))
        )
        r = {"left": min(restitution, bound), "right": min(restitution, bound)}
        fell = rk.simulate_many(truly, motion, r, friction=friction, scale=sign, threads=1).overturned.item()
        known = {"restitution": RESTITUTION, "base": (0.0, BASE * body.half_width), "centre": 1.0}
        how = {**known, "shares": False, "seed": len(rows), "threads": 1}
        found = [
            predict(body, motion, friction=mu, count=n, **how) for mu, n in ((FRICTION, COUNT), (0.45, COUNT // 2))
        ]
        # a share of a finite sample is never quite certain
        said = [(each.chances["overturning"].value * each.count + 0.5) / (each.count + 1.0) for each in found]
        sampled = motion.sampled(0.005)
        rows.append((*said, fell, number, sampled.peak, peak_ground_velocity(sampled)))
    return np.array(rows).T


@pytest.mark.verifies(
    "repeated sampling", "outcomes of bodies whose base, friction and restitution are hidden", room="studies",
    control="test_friction_that_is_taken_for_known_is_noticed",
)  # fmt: skip
def test_probabilities_are_right_as_often_as_they_say(outcomes):
    """Spiegelhalter's statistic, and every step of the reliability diagram but one."""
    said, _, fell, number, *_ = outcomes
    given = Forecasts(said, fell, number)
    assert given.left_out == 0
    assert 0.2 < fell.mean() < 0.8
    assert abs(given.calibration) < 3.0
    outside = [each for each in given.reliability() if not each.low <= each.predicted <= each.high]
    assert len(outside) <= 1, outside


@pytest.mark.verifies("negative control", room="studies")
def test_friction_that_is_taken_for_known_is_noticed(outcomes):
    """The input that decides most left out: the probabilities are far too sure, and worse."""
    said, blind, fell, number, *_ = outcomes
    ignorant = Forecasts(blind, fell, number)
    assert abs(ignorant.calibration) > 5.0
    assert Forecasts(said, fell, number).skill(ignorant).low > 0.0


@pytest.mark.verifies("repeated sampling", "a logistic in PGA and PGV that has not seen the motion", room="studies")
def test_not_worse_than_the_plain_logistic(outcomes):
    """Brier scores in pairs, motions drawn again."""
    said, _, fell, number, pga, pgv = outcomes
    plain = logistic_left_out(np.log(np.column_stack([pga, pgv])), fell, number)
    skill = Forecasts(said, fell, number).skill(Forecasts(plain, fell, number))
    assert skill.low > 0.0, skill
