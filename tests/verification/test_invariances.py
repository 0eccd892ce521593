"""What must not change when sizes, units, sides or the direction of time do (both engines, drawn examples).

Histories are short, p T < 15: rocking multiplies differences by up to exp(p T).
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from engines import every_engine
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking.conventions import g
from rocking.dynamics import ConstantRestitution, PlaneSettings, RockingParameters, RockingSide
from rocking.dynamics.plane import equations
from rocking.dynamics.plane.equations import Trajectory
from rocking.dynamics.plane.fast_engine import run
from rocking.motions import Segments

FEW = settings(max_examples=25)

# the laws are those of the equations of rocking, which hold also where the ground would have to pull
pytestmark = [
    pytest.mark.slow,
    pytest.mark.verifies("invariant", room="rocking in the plane"),
    pytest.mark.filterwarnings("ignore:the contact force becomes tensile"),
]

seeds = st.integers(0, 10**6)
slenderness = st.floats(0.08, 0.5)
coefficients = st.floats(0.5, 0.98)
factors = st.floats(0.02, 50.0)
strengths = st.floats(1.1, 3.0)


def noise(seed: int, strength: float, count: int = 60, number: int = 0) -> Any:
    """Smooth random samples with a peak of `strength`."""
    x = np.random.default_rng([seed, number]).normal(size=count + 4)
    x = np.convolve(x, np.ones(5) / 5.0, mode="valid")
    return x / np.abs(x).max() * strength


def record(seed: int, strength: float, body: rk.Block, *, vertical: bool = False) -> rk.GroundMotion:
    """60 steps of 0.15 / p, the peak so many times what lifts the body."""
    x = noise(seed, strength * g * math.tan(body.slenderness_angle))
    z = noise(seed, 0.5 * g, number=1) if vertical else None
    return rk.GroundMotion(x, 0.15 / body.frequency_parameter, z)


def respond(body: Any, motion: Any, r: Any, name: str, **options: Any) -> rk.Response:
    # impacts are resolved down to 1e-6 p alpha: the speed at which the sums begin does not scale with a vertical motion
    # short steps, because the default ones of the fast engine are good to 1e-7 only
    given = {"duration": motion.duration, "rest_speed": 1e-6, "longest_step": 0.03} | options
    return rk.simulate(body, motion, r, engine=name, **given)


def clear_impacts(response: rk.Response) -> Any:
    """Times of impacts over 1 / p, but for those too slow to be told from rest, which may be counted differently."""
    side = response.parameters.right
    p = side.frequency_parameter
    return response.impacts["time"][np.abs(response.impacts["velocity_after"]) > 1e-3 * p * side.slenderness_angle] * p


def same_course(one: rk.Response, other: rk.Response, bound: float = 1e-8) -> bool:
    """Whether two responses agree in theta, sample by sample, in outcome, and in p times the times of impacts."""
    if one.outcome is not other.outcome or abs(one.peak_rotation - other.peak_rotation) > bound:
        return False
    # a fall ends at the ground: a sample more or less
    n = min(one.rotation.size, other.rotation.size)
    if abs(one.rotation.size - other.rotation.size) > 1 or np.abs(one.rotation[:n] - other.rotation[:n]).max() > bound:
        return False
    t1, t2 = clear_impacts(one), clear_impacts(other)
    return t1.size == t2.size and bool(np.allclose(t1, t2, rtol=0.0, atol=1e-6))


def block(alpha: float, size: float = 1.0) -> rk.Block:
    return rk.Block(width=2.0 * size * math.sin(alpha), height=2.0 * size * math.cos(alpha))


@pytest.mark.verifies(
    against="a body s times as large under sqrt(s) times as slow a motion", within="1e-8 rad", control="within"
)
@every_engine
@FEW
@given(alpha=slenderness, s=factors, r=coefficients, strength=strengths, seed=seeds)
def test_size(name: str, alpha: float, s: float, r: float, strength: float, seed: int) -> None:
    """A body s times as large turns by the same angles in sqrt(s) times the time; with the old clock it does not."""
    small, large = block(alpha), block(alpha).scaled(size=s)
    motion = record(seed, strength, small, vertical=True)
    one = respond(small, motion, r, name)
    slowed = replace(motion, time_step=motion.time_step * math.sqrt(s))
    assert same_course(one, respond(large, slowed, r, name))
    if abs(math.log(s)) > 0.5 and one.peak_rotation > 0.01 * alpha:
        assert not same_course(one, respond(large, motion, r, name))


@pytest.mark.verifies(against="gravity and ground c times as strong, sqrt(c) times as fast", within="1e-8 rad")
@every_engine
@FEW
@given(alpha=slenderness, c=factors, r=coefficients, strength=strengths, seed=seeds)
def test_gravity(name: str, alpha: float, c: float, r: float, strength: float, seed: int) -> None:
    """Gravity and ground c times as strong: the same angles, sqrt(c) times as fast."""
    body = block(alpha)
    motion = record(seed, strength, body, vertical=True)
    assert motion.vertical is not None
    z = motion.vertical * c
    quick = rk.GroundMotion(motion.acceleration * c, motion.time_step / math.sqrt(c), z)
    one, other = respond(body, motion, r, name), respond(body, quick, r, name, gravity=c * g)
    assert same_course(one, other)


@pytest.mark.verifies(against="other density and depth", within="1e-8 rad")
@every_engine
@FEW
@given(alpha=slenderness, density=st.floats(1e-3, 1e6), depth=st.floats(0.01, 100.0), strength=strengths, seed=seeds)
def test_mass(name: str, alpha: float, density: float, depth: float, strength: float, seed: int) -> None:
    """Density and depth make no difference to the motion of a body."""
    body = block(alpha)
    heavy = rk.Block(width=body.width, height=body.height, density=density, depth=depth)
    motion = record(seed, strength, body)
    assert same_course(respond(body, motion, "housner", name), respond(heavy, motion, "housner", name))


@pytest.mark.verifies(against="gravity c g on ground at rest", within="1e-8 rad", control="within")
@every_engine
@FEW
@given(alpha=slenderness, c=st.floats(0.3, 3.0), r=coefficients, strength=strengths, seed=seeds, linear=st.booleans())
def test_constant_vertical(
    name: str, alpha: float, c: float, r: float, strength: float, seed: int, linear: bool
) -> None:
    """A ground that rises with (c - 1) g under gravity g is a ground at rest under gravity c g."""
    body = block(alpha)
    still = record(seed, strength * c, body)
    rising = rk.GroundMotion(still.acceleration, still.time_step, np.full(len(still), (c - 1.0) * g))
    one = respond(body, rising, r, name, linear=linear)
    other = respond(body, still, r, name, gravity=c * g, linear=linear)
    # after the record gravity is g again, so the verdict and peaks after it may differ
    n = min(one.rotation.size, other.rotation.size)
    assert np.abs(one.rotation[:n] - other.rotation[:n]).max() < 1e-8
    if abs(c - 1.0) > 0.1 and np.abs(one.rotation).max() > 0.01 * alpha:
        wrong = respond(body, still, r, name, linear=linear)
        n = min(n, wrong.rotation.size)
        assert np.abs(one.rotation[:n] - wrong.rotation[:n]).max() > 1e-8


@pytest.mark.verifies(against="two point masses with alpha and p of the block", within="1e-8 rad")
@every_engine
@FEW
@given(alpha=slenderness, k=st.floats(0.75, 1.3), r=coefficients, strength=strengths, seed=seeds)
def test_equal_parameters(name: str, alpha: float, k: float, r: float, strength: float, seed: int) -> None:
    """Two masses on a semi-diagonal k R, spread so that p is that of a block of R, move as the block."""
    body = block(alpha)
    # I_O / (m R') = 4 R / 3 with I_O = m (R'^2 + x^2), R' = k R, R = 1
    x, b, h = math.sqrt(4.0 * k / 3.0 - k * k), k * math.sin(alpha), k * math.cos(alpha)
    pair = rk.MassPoints([(-x, h), (x, h)], [1.0, 1.0], feet=(-b, b))
    motion = record(seed, strength, body)
    assert same_course(respond(body, motion, r, name), respond(pair, motion, r, name))


@pytest.mark.verifies(against="pulses of equal dimensionless groups", within="1e-9 rad in peaks, 1e-6 in p t")
@every_engine
@FEW
@given(alpha=slenderness, s=factors, c=factors, strength=st.floats(1.2, 6.0), omega=st.floats(0.5, 8.0), r=coefficients)
def test_dimensionless_groups(
    name: str, alpha: float, s: float, c: float, strength: float, omega: float, r: float
) -> None:
    """theta depends on omega_p / p, a_p / (g tan alpha), alpha and r only: pulses on bodies of other size and g."""
    found = []
    for size, gravity in ((1.0, g), (s, c * g)):
        body = block(alpha, size)
        p = body.side("right", gravity).frequency_parameter
        pulse = rk.pulses.sine(strength * gravity * math.tan(alpha), 2.0 * math.pi / (omega * p))
        response = rk.simulate(body, pulse, r, gravity=gravity, engine=name, duration=pulse.duration + 1.0 / p)
        found.append((response, response.impacts["time"] * p))
    (one, t1), (other, t2) = found
    assert one.outcome is other.outcome
    assert one.peak_rotation == pytest.approx(other.peak_rotation, abs=1e-9)
    assert t1.size == t2.size
    assert np.allclose(t1, t2, rtol=0.0, atol=1e-6)


def histories(
    name: str, sides: tuple[RockingSide, RockingSide], motion: Segments, *, linear: bool = False, **state: Any
) -> Trajectory:
    parameters = RockingParameters(*sides, ConstantRestitution(), "")
    return run(parameters, motion, PlaneSettings(linear=linear, rest_speed=1e-6), engine=name, **state)


@pytest.mark.verifies(against="another slenderness angle", within="1e-8 of theta / alpha", control="within")
@every_engine
@FEW
@given(alpha=slenderness, other=slenderness, r=coefficients, strength=strengths, seed=seeds)
def test_linear_model(name: str, alpha: float, other: float, r: float, strength: float, seed: int) -> None:
    """In the slender-linear model theta / alpha does not depend on alpha if r does not; in the full one it does."""
    for linear in (True, False):
        curves = []
        for angle in (alpha, other):
            motion = Segments.between_samples(0.05, noise(seed, strength * g * angle))
            side = RockingSide(angle, 3.0, 1.0, r)
            curves.append(histories(name, (side, side), motion, linear=linear).rotation / angle)
        both = np.isfinite(curves[0]) & np.isfinite(curves[1]) & (np.abs(curves[0]) < 2.0)
        gap = float(np.abs(curves[0] - curves[1])[both].max())
        if linear:
            assert gap < 1e-8
        elif abs(alpha - other) > 0.05 and np.abs(curves[0][both]).max() > 0.05:
            assert gap > 1e-8


@pytest.mark.verifies(against="the mirrored body under the mirrored motion", within="every bit", control="within")
@every_engine
@settings(max_examples=50)
@given(
    alphas=st.tuples(slenderness, slenderness), ps=st.tuples(st.floats(1.0, 5.0), st.floats(1.0, 5.0)),
    rs=st.tuples(coefficients, coefficients), strength=strengths, seed=seeds, vertical=st.booleans(),
    linear=st.booleans(), start=st.floats(-0.5, 0.5),
)  # fmt: skip
def test_mirror_is_bitwise(
    name: str, alphas: Any, ps: Any, rs: Any, strength: float, seed: int, vertical: bool, linear: bool, start: float
) -> None:
    """a -> -a with the sides exchanged: theta -> -theta to the last bit, also with the same vertical motion."""
    right, left = (RockingSide(a, p, 1.0, r) for a, p, r in zip(alphas, ps, rs, strict=True))
    x, z = noise(seed, strength * g * max(alphas)), noise(seed, 0.6 * g, number=1) if vertical else None
    rotation = start * min(alphas)
    one = histories(name, (right, left), Segments.between_samples(0.03, x, z), linear=linear, rotation=rotation)
    other = histories(name, (left, right), Segments.between_samples(0.03, -x, z), linear=linear, rotation=-rotation)
    assert np.array_equal(one.rotation, -other.rotation, equal_nan=True)
    assert np.array_equal(one.angular_velocity, -other.angular_velocity, equal_nan=True)
    turned = [(e.time, e.kind, -e.side, -e.before, -e.after, e.coefficient) for e in other.events]
    assert [(e.time, e.kind, e.side, e.before, e.after, e.coefficient) for e in one.events] == turned
    assert (one.outcome, one.side, one.peak_rotation) == (other.outcome, -other.side, -other.peak_rotation)
    if alphas[0] != alphas[1] and one.impacts:
        same = histories(name, (right, left), Segments.between_samples(0.03, -x, z), linear=linear, rotation=-rotation)
        assert not np.array_equal(one.rotation, -same.rotation, equal_nan=True)


@pytest.mark.verifies(against="the mirror image, through the public door", within="1e-8 rad")
@every_engine
@FEW
@given(lean=st.floats(-0.3, 0.3), strength=strengths, seed=seeds)
def test_mirrored_body(name: str, lean: float, strength: float, seed: int) -> None:
    """A leaning trapezoid and its mirror image, through the public door."""
    body = rk.Section.from_trapezoid(1.0, 0.6, 3.0, lean)
    p, least = body.side("left").frequency_parameter, body.side("left").uplift_acceleration
    motion = rk.GroundMotion(noise(seed, strength * least), 0.15 / p, noise(seed, 0.5 * g, number=1))
    assert motion.vertical is not None
    turned = rk.GroundMotion(-motion.acceleration, motion.time_step, motion.vertical)
    one = respond(body, motion, {"left": 0.8, "right": 0.7}, name)
    other = respond(body.mirrored(), turned, {"left": 0.7, "right": 0.8}, name)
    n = min(one.rotation.size, other.rotation.size)
    assert one.outcome is other.outcome
    assert np.abs(one.rotation[:n] + other.rotation[:n]).max() < 1e-8


@pytest.mark.verifies(against="energy between impacts, and r^2 at each", within="1e-7", control="within")
@every_engine
@FEW
@given(alpha=slenderness, p=st.floats(0.5, 6.0), r=st.sampled_from([1.0, 0.95, 0.8, 0.5]), start=st.floats(0.1, 0.95))
def test_energy(name: str, alpha: float, p: float, r: float, start: float) -> None:
    """Between impacts energy stays, at each it drops by r^2 exactly: after n of them r^(2 n) is left."""
    side = RockingSide(alpha, p, 1.0, r)
    # twelve units of time: quiet ground multiplies nothing, impacts are few enough to stay above rest
    found = histories(name, (side, side), Segments.still(0.02 / p, 600), rotation=start * alpha)
    e = equations.energy(found.rotation, found.angular_velocity, alpha, p) / equations.energy(
        start * alpha, 0.0, alpha, p
    )
    times = np.array([event.time for event in found.events if event.kind == 1])
    assert times.size >= 2
    before = np.searchsorted(times, np.arange(601) * 0.02 / p)
    fresh = np.abs(np.arange(601) * 0.02 / p - times[:, None]).min(axis=0) > 1e-9 / p
    kept = fresh & (r ** (2.0 * before) > 1e-4)
    assert np.abs(e / r ** (2.0 * before) - 1.0)[kept].max() < 1e-7
    if r < 1.0:
        assert np.abs(e / r**before - 1.0)[kept].max() > 0.01


@pytest.mark.verifies(against="the motion run backwards with r = 1", within="1e-8 rad", control="within")
@every_engine
@FEW
@given(alpha=slenderness, seed=seeds, strength=strengths, start=st.floats(0.1, 0.8), vertical=st.booleans())
def test_time_reversal(name: str, alpha: float, seed: int, strength: float, start: float, vertical: bool) -> None:
    """With r = 1 the way back under the reversed motion ends where the way forth began; with r < 1 it does not."""
    x = noise(seed, strength * g * math.tan(alpha), 40)
    z = noise(seed, 0.5 * g, 40, number=1) if vertical else None
    forth = Segments.between_samples(0.05, x, z)
    back = Segments.between_samples(0.05, x[::-1], None if z is None else z[::-1])
    ends = []
    for r in (1.0, 0.9):
        side = RockingSide(alpha, 3.0, 1.0, r)
        there = histories(name, (side, side), forth, rotation=start * alpha)
        assume(np.abs(np.nan_to_num(there.rotation, nan=9.0)).max() < 1.4 and there.impacts > 0)
        velocity = -float(there.angular_velocity[-1])
        again = histories(name, (side, side), back, rotation=float(there.rotation[-1]), velocity=velocity)
        ends.append(np.abs(again.rotation[::-1] - there.rotation).max())
    assert ends[0] < 1e-8
    assert not ends[1] < 1e-5


@pytest.mark.verifies("closed form", "(g + a_z) b / h, about the foot away from the push", within="1e-13")
@every_engine
@pytest.mark.parametrize("lift", [0.0, 0.4, -0.6])
@FEW
@given(left=st.floats(0.2, 1.5), right=st.floats(0.2, 1.5), h=st.floats(0.5, 5.0))
def test_static_threshold(name: str, lift: float, left: float, right: float, h: float) -> None:
    """A body rests under |a_x| < (g + a_z) b / h and rises above, about the foot away from the push, to 1e-13."""
    body = rk.MassPoints([(-0.1, h), (0.1, h)], [1.0, 1.0], feet=(-left, right))
    for sign, lever in ((1.0, left), (-1.0, right)):
        limit = sign * (1.0 + lift) * g * lever / h
        for factor, rises in ((1.0 - 1e-13, False), (1.0 + 1e-13, True), (0.5, False), (1.5, True)):
            motion = rk.GroundMotion(np.full(9, factor * limit), 0.1, np.full(9, lift * g))
            found = respond(body, motion, 0.1, name)
            assert (found.outcome is not rk.Outcome.NO_UPLIFT) == rises
            assert found.uplifts.size == rises
            if factor == 1.5:
                assert found.rotation[1] * sign < 0.0
