"""At rest: when the ground lifts a body, by hand, and impacts that die out, by their geometric series."""

import math
from typing import Any

import numpy as np
import pytest
from engines import every_engine

import rocking as rk
from rocking.conventions import g
from rocking.dynamics import ConstantRestitution, PlaneSettings, RockingParameters, RockingSide, SpeedRestitution
from rocking.dynamics.plane.event_functions import Push, RestoringMoments, comes_to_rest
from rocking.dynamics.plane.fast_engine import run
from rocking.dynamics.plane.reference import Reference
from rocking.motions import Segments

pytestmark = pytest.mark.verifies(room="rocking in the plane")

ALPHA, P = 0.25, 2.0


def parameters(r: float = 0.8, left: float = ALPHA) -> RockingParameters:
    return RockingParameters(RockingSide(ALPHA, P, 1.8, r), RockingSide(left, P, 1.8, r), ConstantRestitution(), "")


def ground(horizontal: Any, vertical: Any = None, left: float = ALPHA) -> RestoringMoments:
    x = np.array(horizontal, dtype=float)
    z = np.zeros_like(x) if vertical is None else np.array(vertical)
    return RestoringMoments(parameters(left=left), Push(0.1, x, z), linear=True)


def uplift(where: RestoringMoments, stretch: int = 0, tau: float = 0.0) -> Any:
    return where.next_uplift(stretch, tau)


def test_uplift_by_lines() -> None:
    """A push of alpha lifts: onto the left foot where it is positive, onto the right where negative; where by rule
    of three."""
    assert uplift(ground([[0.0, 0.5], [0.5, 0.0]])) == (0, pytest.approx(0.5), -1)
    assert uplift(ground([[0.0, 0.1], [0.1, -0.5]])) == (1, pytest.approx(0.7), 1)
    assert uplift(ground([[0.0, 0.5]], left=0.3)) == (0, pytest.approx(0.6), -1)
    assert uplift(ground([[0.0, 0.2499], [0.2499, -0.49]])) is None
    assert uplift(ground([[0.0, 0.25], [0.25, -0.25]])) is None  # what holds it vanishes for an instant


def test_uplift_from_within_a_stretch() -> None:
    """Asked from within a stretch only what comes after counts; where the body is pushed already it is at once."""
    rising_and_back = ground([[0.0, 0.5], [0.5, -0.5], [0.0, -0.4]])
    assert uplift(rising_and_back, 0, 0.75) == (0, 0.75, -1)
    assert uplift(rising_and_back, 1, 0.75) == (2, pytest.approx(0.625), 1)
    assert uplift(rising_and_back, 3, 0.0) is None
    assert rising_and_back.held(1, 2, 0.5) == pytest.approx(ALPHA - 0.2)


def test_uplift_of_smooth_motions() -> None:
    """On parabolas the first of two crossings counts, and one that only touches does not."""
    bow = [[0.0, 2.0, -2.0] + 5 * [0.0]]
    expected = 0.5 - math.sqrt(0.25 - 0.125)
    assert uplift(ground(bow)) == (0, pytest.approx(expected, rel=1e-12, abs=0.0), -1)
    assert uplift(ground([[0.0, 0.996, -0.996] + 5 * [0.0]])) is None


def test_ground_that_falls_away() -> None:
    """Under ground that falls faster than g both feet are free: the push decides, and without one nothing turns."""
    falling = [[-1.5, 0.0]]
    assert uplift(ground([[0.01, 0.0]], falling)) == (0, 0.0, -1)
    assert uplift(ground([[-0.01, 0.0]], falling)) == (0, 0.0, 1)
    assert uplift(ground([[0.0, 0.0]], falling)) is None


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize("push", [0.5, -0.5])
def test_ground_that_falls_away_in_a_history(name: str, push: float) -> None:
    """Both engines lift the body to the side away from the push, at once."""
    record = rk.GroundMotion(np.array([push, push, 0.0]), 0.05, vertical=np.array([-1.5 * g, -1.5 * g, 0.0]))
    with pytest.warns(rk.errors.PureRockingWarning, match="up to 0.47 of the weight"):
        response = rk.simulate(rk.Block(width=0.5, height=2.0), record, 0.5, engine=name, duration=1.0)
    assert response.uplifts[0] == 0.0
    assert math.copysign(1.0, float(response.rotation[1])) == -math.copysign(1.0, push)


@pytest.mark.verifies("closed form", "the sum of all flights", within="1e-4")
@every_engine
def test_time_of_rest_is_the_geometric_series(name: str) -> None:
    """Slow rocking of r = 0.5 dies out at the sum of its flights, 2 v / (p^2 alpha) / (1 - r), to 1e-4."""
    block = rk.Block(width=0.5, height=2.0)
    alpha, p = block.slenderness_angle, block.frequency_parameter
    speed = 5e-3 * p * alpha
    response = rk.free_rocking(block, 0.0, 0.5, angular_velocity=speed, engine=name, linear=True, rest_speed=1e-8)
    flights = 2.0 * speed / (p**2 * alpha) / (1.0 - 0.5)
    early = rk.free_rocking(block, 0.0, 0.5, angular_velocity=speed, engine=name, linear=True)
    assert early.impacts.size < response.impacts.size
    # flights differ from 2 v / (p^2 alpha) by (v / p alpha)^2, far below 1e-4
    assert response.impacts["time"][-1] == pytest.approx(flights, rel=1e-4)
    assert early.outcome is response.outcome is rk.Outcome.ROCKED
    assert not early.rotation[1:].any()


@pytest.mark.parametrize(
    ("after", "horizontal", "r", "expected"),
    [
        (1e-3, [[0.0, 0.0]] * 50, 0.8, True),
        (1e-3, [[0.0, 0.0]] * 50, 1.0, False),
        (1e-1, [[0.0, 0.0]] * 50, 0.8, False),
        (1e-3, [[0.2499, 0.0]] * 50, 0.8, False),
        (1e-3, [[0.26, 0.0]] * 50, 0.8, False),
        (1e-11, [[0.24, 0.0]] * 50, 1.0, True),
        (3e-3, [[0.0, 0.0]], 0.97, False),
        (3e-3, [[0.0, 0.0]] * 2 + [[0.0, 0.5]] * 3, 0.97, False),
        (3e-3, [[0.0, 0.0]] * 50, 0.97, True),
        (3e-3, [[0.0] * 8] * 50, 0.97, True),
        (3e-3, [[0.0] * 8] + [[0.24] + [0.0] * 7] * 49, 0.97, False),
        (1e-3, [[0.0] * 8] * 50, 0.8, True),
        (3e-3, [[0.0, 0.0]] * 5000, 0.99999, False),
        (5e-3, [[0.2475, 0.0]] * 50, 0.8, False),
    ],
)
def test_impacts_that_end(after: float, horizontal: Any, r: float, expected: bool) -> None:
    """Summed up: slow impacts with r < 1 that end within the motion known to hold the body. Not summed up: fast ones,
    r = 1, near uplift, beyond the end of the record, over a jump of a smooth pulse, for far too long, or where
    one flight turns the body so far that it could be lifted."""
    x = np.array(horizontal)
    body = parameters(r)
    where = RestoringMoments(body, Push(0.1, x, np.zeros_like(x)), linear=True)
    # v / p alpha times 2 alpha / p is a flight: 2.5e-3 s, and 1 / (1 - r) of them follow
    assert comes_to_rest(body, where, 1, after, 0, 0.2, 0.01) is expected


@pytest.mark.parametrize("speed", [float, np.float64])
def test_nothing_is_rest_whatever_the_rest_speed(speed: Any) -> None:
    """At most 1e-9 p alpha is rest on ground that holds, also for a rest speed of zero; twice that is not, and
    nothing is where the ground lifts."""
    body, none = parameters(1.0), 1e-9 * P * ALPHA
    holds, lifts = (
        RestoringMoments(body, Push(0.1, x, np.zeros_like(x)), linear=True)
        for x in np.array([[[0.2, 0.0]], [[-0.3, 0.0]]])
    )
    assert comes_to_rest(body, holds, 1, speed(none), 0, 0.0, 0.0) is True
    assert comes_to_rest(body, holds, 1, speed(2.0 * none), 0, 0.0, 0.0) is False
    assert comes_to_rest(body, lifts, 1, speed(none), 0, 0.0, 0.0) is False


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize("linear", [False, True])
def test_let_go_beyond_the_top(name: str, linear: bool) -> None:
    """A body let go past its balance falls from the start; just before it comes back and rocks."""
    block = rk.Block(width=0.5, height=2.0)
    alpha = block.slenderness_angle
    over = rk.free_rocking(block, -1.01 * alpha, 0.8, engine=name, linear=linear)
    assert (over.outcome, over.overturning_time, over.trajectory.side) == (rk.Outcome.OVERTURNED, 0.0, -1)
    assert rk.free_rocking(block, -0.99 * alpha, 0.8, engine=name, linear=linear).outcome is rk.Outcome.ROCKED


@every_engine
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize(("share", "expected"), [(0.999, rk.Outcome.ROCKED), (1.001, rk.Outcome.OVERTURNED)])
def test_energy_decides_at_the_end(name: str, linear: bool, share: float, expected: rk.Outcome) -> None:
    """Pushed up from rest by a share of the speed that reaches the top, a history cut at once knows how it ends; so
    does one that is pushed down from 0.1 and, after an impact of r = 1, climbs the other side."""
    block = rk.Block(width=0.5, height=2.0)
    alpha, p = block.slenderness_angle, block.frequency_parameter
    top = 0.5 * alpha**2 if linear else 1.0 - math.cos(alpha)
    start = 0.1 * (alpha - 0.05) if linear else math.cos(alpha - 0.1) - math.cos(alpha)
    options: Any = {"engine": name, "linear": linear, "duration": 1e-3}
    up = rk.free_rocking(block, 0.0, 1.0, angular_velocity=share * p * math.sqrt(2.0 * top), **options)
    down = rk.free_rocking(block, 0.1, 1.0, angular_velocity=-share * p * math.sqrt(2.0 * (top - start)), **options)
    assert up.outcome is down.outcome is expected
    assert up.time[-1] < 0.05 / p * 1.01
    if expected is rk.Outcome.ROCKED:
        size = 1.0 - math.sqrt(1.0 - share**2) if linear else 1.0 - math.acos(1.0 - top * (1.0 - share**2)) / alpha
        assert up.peak_rotation == pytest.approx(alpha * size, rel=1e-9)


@pytest.mark.verifies("computed anew", "central differences of the energy", within="1e-8")
def test_angular_acceleration_is_the_slope_of_the_energy() -> None:
    """For linear and exact equations dE/dt = 0 makes theta'' = -p^2 dV/dtheta: by central differences to 1e-8."""
    from rocking.dynamics.plane import equations

    for linear in (False, True):
        at, h = 0.1, 1e-5
        potential = [float(equations.energy(x, 0.0, ALPHA, P, linear=linear)) for x in (at - h, at + h)]
        slope = (potential[1] - potential[0]) / (2.0 * h)
        found = float(equations.angular_acceleration(at, 1, ALPHA, P, 0.0, linear=linear))
        assert found == pytest.approx(-(P**2) * slope, rel=1e-8)


UNEVEN = RockingParameters(
    RockingSide(0.25, 2.0, 1.8, 0.97), RockingSide(0.40, 2.5, 1.8, 0.96), ConstantRestitution(), ""
)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("share", "expected"), [(0.95, True), (1.02, False)])
def test_the_proof_of_rest_is_as_sharp_as_the_series(sign: int, share: float, expected: bool) -> None:
    """On ground that holds an uneven body for 0.12 s and then lifts it, impacts whose exact series of flights,
    2 v / (p^2 alpha) each, ends at 95 % of that are rest, and those that end at 102 % are not."""
    sides = UNEVEN.side(sign), UNEVEN.side(-sign)
    first, second = (2.0 / (side.frequency_parameter**2 * side.slenderness_angle) for side in sides)
    series = (first + sides[1].coefficient * second) / (1.0 - sides[0].coefficient * sides[1].coefficient)
    x = np.array([[0.0, 0.0]] * 12 + [[0.6, 0.0]])
    where = RestoringMoments(UNEVEN, Push(0.01, x, np.zeros_like(x)), linear=True)
    assert comes_to_rest(UNEVEN, where, sign, share * 0.12 / series, 0, 0.0, 0.02) is expected


@every_engine
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize(("push", "returns"), [(0.08, True), (0.04, False)])
def test_beyond_balance_it_returns_where_a_push_to_come_is_strong_enough(
    name: str, sign: int, linear: bool, push: float, returns: bool
) -> None:
    """A body 0.05 rad beyond balance that still moves outwards is brought back onto the other foot by a later push of
    0.08 g, since tan(0.05) < 0.08; 0.04 g never does: the reference engine, not asked to follow
    the fall, ends there."""
    acceleration = g * push * sign * np.array([0.0, 0.0, *[1.0] * 100, 0.0])
    segments = Segments.between_samples(0.02, acceleration, None)
    start = {"rotation": sign * (UNEVEN.side(sign).slenderness_angle + 0.05), "velocity": sign * 1e-3}
    settings = PlaneSettings(linear=linear)
    history = (
        run(UNEVEN, segments, settings, **start)
        if name == "fast"
        else Reference(UNEVEN, segments, settings, to_the_ground=False).run(*start.values())
    )
    assert (history.impacts > 0) is returns
    assert returns or history.outcome is rk.Outcome.OVERTURNED
    if not returns and name == "reference":
        assert np.nanmax(np.abs(history.rotation)) < UNEVEN.side(sign).slenderness_angle + 0.06


def end_of_flights(speed: float, moments: dict[int, np.ndarray], step: float) -> float:
    """When all flights of the slender body have ended under moments that hold it: cubics from sample to sample."""
    height, side, bounce = 0.0, 1, speed
    for number in range(len(moments[1]) - 1):
        left = step
        while True:
            unit = -(UNEVEN.side(side).frequency_parameter ** 2)
            first, last = moments[side][number : number + 2]
            slope = (last - first) / step
            path = np.array([unit * slope / 6.0, 0.5 * unit * (last - left * slope), speed, height])
            ends = [x.real for x in np.roots(path) if abs(x.imag) < 1e-9 * left and 1e-9 * bounce < x.real < left]
            ends = [0.0] if height <= 0.0 and speed < 0.0 else ends
            spent = min(ends, default=left)
            speed, height, left = np.polyval(np.polyder(path), spent), np.polyval(path, spent), left - spent
            if not ends:
                break
            side, height = -side, 0.0
            speed = bounce = -UNEVEN.side(side).coefficient * speed
            if bounce <= 1e-6:
                return (number + 1) * step - left
    return math.inf


@pytest.mark.slow
def test_the_proof_of_rest_under_changing_moments() -> None:
    """The fastest body that is put to rest ends its flights while the ground still holds it, on random ground; how
    little is left of that time says that a bound of half the size would not hold."""
    random, used = np.random.default_rng(5), []
    for _ in range(25):
        step, size = 0.004, random.uniform(0.0005, 0.008)
        x, z = size * 0.25 * random.uniform(-1.0, 1.0, 36), size * random.uniform(-1.0, 1.0, 36)
        lines = [np.stack([each[:-1], np.diff(each)], axis=1) for each in (x, z)]
        push = Push(step, np.vstack([lines[0], [[0.6, 0.0]]]), np.vstack([lines[1], [[z[-1], 0.0]]]))
        where = RestoringMoments(UNEVEN, push, linear=True)
        low, high = 0.0, 0.02
        for _ in range(40):
            speed = 0.5 * (low + high)
            low, high = (speed, high) if comes_to_rest(UNEVEN, where, 1, speed, 0, 0.0, 0.1) else (low, speed)
        assert low > 1e-4, "the ground holds the body for a while"
        moments = {s: UNEVEN.side(s).slenderness_angle * (1.0 + z) + s * x for s in (1, -1)}
        used.append(end_of_flights(low, moments, step) / (35 * step))
    assert max(used) <= 1.0
    assert min(used) > 0.7


@pytest.mark.parametrize("sign", [1, -1])
def test_heights_of_flights_bound_what_is_put_to_rest(sign: int) -> None:
    """On ground that stays still the fastest body put to rest is one whose flights, with d = v^2 e^0.1 / (p alpha)^2,
    add 2.2 d (1 + r_2^2) / (1 - r_1^2 r_2^2) = 0.1 to the logarithm of its gain: docs/theory/rest.md."""
    body = RockingParameters(
        RockingSide(0.25, 2.0, 1.8, 0.9), RockingSide(0.40, 2.5, 1.8, 0.7), ConstantRestitution(), ""
    )
    still = Push(0.1, np.zeros((500, 2)), np.zeros((500, 2)))
    where = RestoringMoments(body, still, linear=True)
    low, high = 0.0, 1.0
    for _ in range(40):
        speed = 0.5 * (low + high)
        low, high = (speed, high) if comes_to_rest(body, where, sign, speed, 0, 0.0, 1.0) else (low, speed)
    slowest = min(side.frequency_parameter * side.slenderness_angle for side in (body.right, body.left))
    second = body.side(-sign).coefficient
    heights = 0.1 * (1.0 - (0.9 * 0.7) ** 2) / (2.2 * (1.0 + second**2))
    assert low == pytest.approx(slowest * math.sqrt(heights * math.exp(-0.1)), rel=5e-3)


def test_largest_coefficient_is_the_largest_that_impacts_meet() -> None:
    """Of a law of the speed, by side: the coefficient of the side times the largest factor, met at some speed."""
    law = SpeedRestitution((0.0, 1.0, 2.0), (0.6, 0.9, 0.8))
    body = RockingParameters(RockingSide(0.25, 2.0, 1.8, 0.8), RockingSide(0.40, 2.5, 1.8, 0.7), law, "")
    for sign, largest in ((1, 0.72), (-1, 0.63)):
        met = max(body.coefficient(sign, speed, 0, 0) for speed in np.linspace(0.0, 3.0, 31).tolist())
        assert (
            body.largest(sign) == pytest.approx(largest, rel=1e-14, abs=0.0) == pytest.approx(met, rel=1e-14, abs=0.0)
        )


@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("sign", [1, -1])
def test_what_holds_over_stretches_of_a_smooth_motion(sign: int, linear: bool) -> None:
    """Where a push rises from 0.02 to 0.06 and from 0.08 to 0.10, and the lift from -0.10 to -0.03 and from -0.05 to
    -0.04, least moments, sums of rises and jumps, and steepness are those of these numbers."""
    x = sign * np.array([[0.02, 0.03, 0.01], [0.08, 0.02, 0.0]])
    z = np.array([[-0.10, 0.05, 0.02], [-0.05, 0.01, 0.0]])
    where = RestoringMoments(parameters(left=0.4), Push(0.1, x, z), linear=linear)
    held = where.window(0, 0.0, 2)
    assert held is not None
    lows, variation, steepness = held
    sine, cosine = (
        {s: float(f(alpha)) for s, alpha in ((1, ALPHA), (-1, 0.4))}
        for f in ((float, lambda _: 1.0) if linear else (math.sin, math.cos))
    )
    low = {s: 0.9 * sine[s] + (0.02 if s == sign else -0.10) * cosine[s] for s in (1, -1)}
    assert lows == pytest.approx(low, rel=1e-13, abs=0.0)
    across, up = (max(part[s] / low[s] for s in (1, -1)) for part in (cosine, sine))
    assert variation == pytest.approx((0.04 + 0.02 + 0.02) * across + (0.07 + 0.02 + 0.01) * up, rel=1e-13, abs=0.0)
    assert steepness == pytest.approx(0.97 + 0.10, rel=1e-13, abs=0.0)


@every_engine
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize(("share", "expected"), [(0.999, rk.Outcome.OVERTURNED), (1.001, rk.Outcome.ROCKED)])
def test_energy_decides_far_beyond_balance(
    name: str, sign: int, linear: bool, share: float, expected: rk.Outcome
) -> None:
    """Let go at 2.6 alpha and thrown back by a share of the speed that reaches the top, a history cut at once knows
    whether it comes back."""
    block = rk.Block(width=0.5, height=2.0)
    alpha, p = block.slenderness_angle, block.frequency_parameter
    climb = 0.5 * (1.6 * alpha) ** 2 if linear else 1.0 - math.cos(1.6 * alpha)
    back = -sign * share * p * math.sqrt(2.0 * climb)
    found = rk.free_rocking(
        block, sign * 2.6 * alpha, 0.3, angular_velocity=back, engine=name, linear=linear, duration=1e-3
    )
    assert found.outcome is expected
