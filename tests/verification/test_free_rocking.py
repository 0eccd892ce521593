"""Free rocking against elliptic integrals and closed forms: periods, decay, rest, impulses, identification.

REF numbers (CONTRIBUTING.md; block of 1.0 m by 4.0 m, g = 9.81 m/s2) have 30 digits. The truth for random blocks is
derived here: with y the speed at the ground over p, energy gives sin^2(u / 2) = sin^2(alpha / 2) - y^2 / 4 at the turn,
and the time from ground to turn is an elliptic integral of the first kind, written in Carlson's symmetric form, which
loses no digits for small y. With ROCKING_CAMPAIGN=1 the random blocks are a thousand.
"""

import itertools
import os

import mpmath as mp
import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import elliprf

import rocking as rk
from rocking import conventions
from rocking.dynamics import PlaneSettings, RockingParameters
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.plane.fast_engine import run
from rocking.motions import Segments

pytestmark = pytest.mark.verifies(room="rocking in the plane")

BLOCKS = 1000 if os.environ.get("ROCKING_CAMPAIGN") == "1" else 60
IMPACTS = 20
ENGINES = ("fast", "reference")
G = 9.81
BLOCK = rk.Block(width=1.0, height=4.0)
R_HOUSNER = 0.911764705882353
ALPHA, P = 0.244978663126864154, float(np.sqrt(3.0 * G / (4.0 * np.sqrt(17.0) / 2.0)))

# theta_0 / alpha: period of the linear and of the exact equations [s]
PERIODS = {
    0.1: (0.9891088317844302, 0.9932837337787516),
    0.3: (1.896270996454747, 1.901660685766372),
    0.5: (2.788457176687824, 2.79337281563169),
    0.7: (3.967528130777273, 3.971397062974691),
    0.9: (6.337692151128465, 6.340566423733241),
    0.99: (11.21832475098503, 11.22097847329262),
    0.999: (16.09374936358324, 16.0963990677361),
}
DECAY_LINEAR = (
    0.38639276338162,
    0.30596348864151,
    0.24560062009144,
    0.19887470694759,
    0.16201166305738,
    0.13255849932959,
)
DECAY_EXACT = (
    0.38671446693199,
    0.30639687982828,
    0.24605747438513,
    0.1993140456417,
    0.16241485444787,
    0.13291839645392,
)
REST_LINEAR, REST_EXACT = 11.17271858247621, 11.230909986435


def released(ratio, engine, *, linear=False, rest_speed=1e-9, restitution=R_HOUSNER):
    return rk.free_rocking(
        BLOCK, rotation=ratio * BLOCK.slenderness_angle, restitution=restitution, gravity=G, engine=engine,
        linear=linear, rest_speed=rest_speed,
    )  # fmt: skip


def time_to_turn(alpha, speed, *, linear=False):
    """Time p t from the ground to the turn, for a speed at the ground over p (over p alpha if linear)."""
    if linear:
        return np.arctanh(speed)
    turn = np.sin(0.5 * alpha) ** 2 - 0.25 * speed**2  # sin^2(u / 2)
    q = 0.25 * speed**2 / np.cos(0.5 * alpha) ** 2
    return np.sqrt(q / turn) * elliprf(1.0, 1.0 + q, 1.0 + q / turn)


def truth(alpha, p, r, rotation, count=IMPACTS):
    """Times of the first impacts and speeds before them, after a release at a rotation."""
    first = 2.0 * np.sqrt(np.sin(alpha - 0.5 * rotation) * np.sin(0.5 * rotation))
    speeds = first * r ** np.arange(count)
    quarters = time_to_turn(alpha, speeds)
    times = quarters[0] + np.concatenate([[0.0], np.cumsum(2.0 * quarters[1:])])
    return times / p, p * speeds


def random_blocks(count, seed=20240607):
    """Blocks of all slenderness ratios, sizes, coefficients, releases and sides that the claim is about."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        height = np.exp(rng.uniform(np.log(0.1), np.log(10.0)))
        body = rk.Block(width=height / rng.uniform(1.5, 10.0), height=height)
        yield body, rng.uniform(0.75, 1.0), rng.choice([-1.0, 1.0]) * rng.uniform(0.05, 0.98) * body.slenderness_angle


def impacts_of(body, r, rotation, engine):
    parameters = RockingParameters.of_body(body, r, conventions.g)
    p = parameters.right.frequency_parameter
    times, _ = truth(parameters.right.slenderness_angle, p, r, abs(rotation))
    step = 0.15 / p if engine == "fast" else 0.8 / p  # the longest default step of the fast engine
    still = Segments.still(step, int(np.ceil(1.02 * times[-1] / step)) + 1)
    found = run(parameters, still, PlaneSettings(rest_speed=1e-6), engine=engine, rotation=rotation)
    events = [e for e in found.events if e.kind is EventKind.IMPACT][:IMPACTS]
    return np.array([e.time for e in events]), np.array([e.before for e in events])


def worst_errors(engine, count, wrong_r=0.0):
    worst = np.zeros(2)
    for body, r, rotation in random_blocks(count):
        times, speeds = impacts_of(body, r, rotation, engine)
        side = body.side("right", conventions.g)
        true_times, true_speeds = truth(side.slenderness_angle, side.frequency_parameter, r + wrong_r, abs(rotation))
        sides = -np.sign(rotation)  # a body that leans right comes down turning left, and goes on turning left
        signs = sides * (-1.0) ** np.arange(IMPACTS)
        assert times.size == IMPACTS
        errors = [np.abs(times / true_times - 1.0).max(), np.abs(signs * speeds / true_speeds - 1.0).max()]
        worst = np.maximum(worst, errors)
    return worst


@pytest.mark.verifies("computed anew", "30-digit quadrature by mpmath", within="1e-11")
@pytest.mark.parametrize("speed_ratio", [1e-6, 0.3, 0.9, 0.9999])
@pytest.mark.parametrize("alpha", [0.1, 0.25, 0.58])
def test_the_oracle_against_quadrature(alpha, speed_ratio):
    """The symmetric form of the truth equals 30-digit quadrature of the time between ground and turn."""
    with mp.workdps(30):
        speed = mp.mpf(speed_ratio * 2.0 * np.sin(0.5 * alpha))
        u0 = 2 * mp.asin(mp.sqrt(mp.sin(mp.mpf(alpha) / 2) ** 2 - speed**2 / 4))
        # u = u0 + (alpha - u0) x^2 takes away the root at the turn
        width = mp.mpf(alpha) - u0

        def integrand(x):
            drop = 2 * mp.sin(u0 + width * x * x / 2) * mp.sin(width * x * x / 2)
            return 2 * width * x / mp.sqrt(2 * drop) if x else mp.sqrt(2 * width / mp.sin(u0))

        # near the top the integrand is peaked at the turn
        expected = mp.quad(integrand, [0, mp.mpf("1e-3"), mp.mpf("0.01"), mp.mpf("0.1"), mp.mpf("0.3"), 1])
    assert time_to_turn(alpha, float(speed)) == pytest.approx(float(expected), rel=1e-11, abs=0.0)


@pytest.mark.verifies(
    "closed form",
    "elliptic integrals, 16 digits; atanh for linear equations",
    within="1e-12 times 1 / (1 - share of alpha)",
    control="test_a_linear_period_is_rejected",
)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("ratio", PERIODS)
def test_periods(ratio, engine):
    """REF: a released block comes down after a quarter of the period, by linear and by exact equations."""
    linear, exact = PERIODS[ratio]
    # the closer to the top, the more digits the unstable equilibrium takes: 1 / (1 - ratio)
    tolerance = 1e-12 / (1.0 - ratio)
    assert 4.0 * released(ratio, engine, linear=True).impacts["time"][0] == pytest.approx(
        linear, rel=tolerance, abs=0.0
    )
    assert 4.0 * released(ratio, engine).impacts["time"][0] == pytest.approx(exact, rel=tolerance, abs=0.0)


@pytest.mark.verifies("closed form", "amplitudes after each impact, 14 digits", within="1e-12 linear, 1e-11 exact")
@pytest.mark.parametrize("engine", ENGINES)
def test_decay(engine):
    """REF: amplitudes after each of six impacts, from the velocities after them and from the samples."""
    response = released(0.5, engine, linear=True)
    y = np.abs(response.impacts["velocity_after"][:6]) / (P * ALPHA)
    np.testing.assert_allclose(1.0 - np.sqrt(1.0 - y**2), DECAY_LINEAR, rtol=1e-12)
    response = released(0.5, engine)
    y = np.abs(response.impacts["velocity_after"][:6]) / P
    np.testing.assert_allclose((ALPHA - np.arccos(np.cos(ALPHA) + 0.5 * y**2)) / ALPHA, DECAY_EXACT, rtol=1e-11)
    cuts = np.searchsorted(response.time, response.impacts["time"][:7])
    peaks = [np.abs(response.rotation[a:b]).max() / ALPHA for a, b in itertools.pairwise(cuts)]
    # samples every 0.05 / p miss the top by at most (0.025)^2 / 2 alpha
    np.testing.assert_allclose(peaks, DECAY_EXACT, rtol=0.0, atol=0.5 * 0.025**2)


@pytest.mark.verifies("closed form", "the sum of infinitely many flights, 13 digits", within="1e-11")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("linear", "expected"), [(True, REST_LINEAR), (False, REST_EXACT)])
def test_time_of_rest(engine, linear, expected):
    """REF: infinitely many impacts end in finite time, and the engine ends with them; the rest it skips is known."""
    unit = P * (ALPHA if linear else np.sin(ALPHA))
    for rest_speed, most in ((1e-8, 250), (0.01, 60)):
        response = released(0.5, engine, linear=linear, rest_speed=rest_speed)
        last = response.trajectory.events[-1]
        assert response.outcome is rk.Outcome.ROCKED
        assert last.kind is EventKind.REST
        assert response.impacts.size < most
        # flights of a low speed last 2 y / p, y over p sin(alpha), and the next ones r, r^2, ... times as long
        y = abs(response.impacts["velocity_after"][-1]) / unit
        remaining = 2.0 * y / P / (1.0 - R_HOUSNER)
        # (2 / p) atanh(y) = (2 y / p)(1 + y^2 / 3 + ...), and y <= 0.01
        assert last.time + remaining == pytest.approx(expected, rel=1e-11 if rest_speed < 1e-6 else 1e-6, abs=0.0)
        assert not response.rotation[response.time > last.time].any()


@pytest.mark.slow
@pytest.mark.verifies(
    "closed form",
    "Carlson's elliptic integrals",
    within="1e-9 (fast), 1e-10 (reference)",
    control="test_a_wrong_coefficient_is_rejected",
)
@pytest.mark.parametrize(("engine", "bound"), [("fast", 1e-9), ("reference", 1e-10)])
def test_random_blocks(engine, bound, agreement):
    """Times of 20 impacts and velocities before them agree with elliptic integrals, for blocks of all kinds."""
    times, speeds = worst_errors(engine, BLOCKS)
    print(f"\n{engine}: {BLOCKS} blocks, worst relative error of times {times:.1e}, of velocities {speeds:.1e}")
    agreement(times, bound)
    agreement(speeds, bound)


@pytest.mark.verifies("negative control", "a coefficient off by 1e-7")
@pytest.mark.parametrize("engine", ENGINES)
def test_a_wrong_coefficient_is_rejected(engine):
    """Negative control: a coefficient that is off by 1e-7 is seen in the times of impacts."""
    times, speeds = worst_errors(engine, 5, wrong_r=-1e-7)
    assert times > 1e-8
    assert speeds > 1e-6


@pytest.mark.slow
@pytest.mark.verifies("negative control", "the period of the linear equations")
def test_a_linear_period_is_rejected():
    """Negative control: the period of the linear equations is not that of the exact ones, nor the other way round."""
    for ratio, (linear, exact) in PERIODS.items():
        quarter = released(ratio, "reference").impacts["time"][0]
        assert 4.0 * quarter != pytest.approx(linear, rel=1e-4)
        assert 4.0 * quarter == pytest.approx(exact, rel=1e-9, abs=0.0)


@pytest.mark.verifies("closed form", "the r and p that were put in", within="1e-8 linear, 1e-9 exact")
@pytest.mark.parametrize("engine", ENGINES)
def test_identification(engine):
    """Times of impacts alone give r and p of the linear equations; amplitudes give r of the exact ones."""
    response = released(0.6, engine, linear=True, restitution=0.87)
    t = np.diff(response.impacts["time"][:5])
    np.testing.assert_allclose(np.tanh(0.5 * P * t[1:]) / np.tanh(0.5 * P * t[:-1]), 0.87, rtol=1e-11)

    def odd(p):
        z = np.log(np.tanh(0.5 * p * t[:3]))
        return z[0] - 2.0 * z[1] + z[2]

    p = brentq(odd, 0.2 * P, 3.0 * P, xtol=1e-15)
    assert p == pytest.approx(P, rel=1e-8)
    assert np.tanh(0.5 * p * t[1]) / np.tanh(0.5 * p * t[0]) == pytest.approx(0.87, rel=1e-8)
    response = released(0.6, engine, restitution=0.87)
    middle = 0.5 * (response.impacts["time"][:5] + response.impacts["time"][1:6])
    height = np.cos(ALPHA - np.abs(response.at(middle))) - np.cos(ALPHA)
    np.testing.assert_allclose(np.sqrt(height[1:] / height[:-1]), 0.87, rtol=1e-9)


def threshold(overturns, low, high):
    """Bisection to neighbouring numbers."""
    assert overturns(high)
    assert not overturns(low)
    while high - low > 4.0 * np.spacing(high):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if overturns(middle) else (middle, high)
    return high


def pushed(speed, engine, *, linear, stretches, r=0.9):
    parameters = RockingParameters.of_body(BLOCK, r, G)
    still = Segments.still(0.15 / P, stretches)
    return run(parameters, still, PlaneSettings(gravity=G, linear=linear), engine=engine, velocity=P * speed)


@pytest.mark.slow
@pytest.mark.verifies(
    "closed form", "p dU cos(alpha) / g = 2 sin(alpha / 2)", within="3e-11 (fast), 3e-15 (reference)", control="within"
)
@pytest.mark.parametrize(("engine", "bound"), [("fast", 3e-11), ("reference", 3e-15)])
@pytest.mark.parametrize("stretches", [1, 150])
def test_overturning_by_an_impulse(engine, stretches, bound, agreement):
    """REF: an impulse overturns from p dU cos(alpha) / g = 2 sin(alpha / 2) on; linear p dU / g = alpha."""
    exact = threshold(
        lambda y: pushed(y, engine, linear=False, stretches=stretches).outcome is rk.Outcome.OVERTURNED, 0.1, 0.4
    )
    agreement(abs(exact / 0.244366527391408932 - 1.0), bound)
    linear = threshold(
        lambda y: pushed(-y, engine, linear=True, stretches=stretches).outcome is rk.Outcome.OVERTURNED, 0.1, 0.4
    )
    agreement(abs(linear / ALPHA - 1.0), bound)
    assert exact != pytest.approx(linear, rel=1e-3)  # negative control


@pytest.mark.slow
@pytest.mark.verifies("closed form", "p V / (g alpha) = 1 / (1 + r)", within="3e-11")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("r", [0.7, 0.9, 1.0])
def test_overturning_by_a_double_impulse(engine, r):
    """A second impulse right after the first impact overturns from p V / (g alpha) = 1 / (1 + r) on (linear)."""

    def overturns(y):
        first = pushed(y * ALPHA, engine, linear=True, stretches=150, r=r)
        impact = next(e for e in first.events if e.kind is EventKind.IMPACT)
        second = pushed(impact.after / P - y * ALPHA, engine, linear=True, stretches=150, r=r)
        return second.outcome is rk.Outcome.OVERTURNED

    assert threshold(overturns, 0.3, 0.9) == pytest.approx(1.0 / (1.0 + r), rel=3e-11, abs=0.0)
