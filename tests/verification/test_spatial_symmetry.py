"""Histories in space turn and mirror with body and motion.

REF numbers: see CONTRIBUTING.md. With ROCKING_CAMPAIGN=1 the property tests draw ten
times as many examples.
"""

import math
import os

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking.dynamics import SpatialStart
from rocking.dynamics.rolling import (
    ContactMode,
    SpatialBody,
    attitude,
)

pytestmark = pytest.mark.verifies(room="rocking in space")

TIMES = 10 if os.environ.get("ROCKING_CAMPAIGN") == "1" else 1
TOWER = SpatialBody.box(1.0, 1.3, 4.0)
SQUARE = SpatialBody.box(1.0, 1.0, 4.0)
ANGLE = st.floats(-math.pi, math.pi)
SPIN = st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3), st.floats(-0.4, 0.4))
LAW = st.sampled_from(["housner", "ked"])


def _records(seed):
    rng, time = np.random.default_rng(seed), np.arange(150) * 0.02
    return [2.4 * np.sin(rng.uniform(3.0, 7.0) * time + rng.uniform(0.0, 6.0)) for _ in range(3)]


@pytest.mark.slow
@pytest.mark.verifies("invariant", "body and motion turned about the vertical", within="1e-9")
@settings(max_examples=4 * TIMES)
@given(ANGLE, st.integers(0, 50), LAW)
def test_turning_body_and_motion_turns_the_response(angle, seed, law):
    """Rotated about the vertical together, body and motion give the rotated response until the fifth impact, 1e-9."""
    x, y, z = _records(seed)
    turned = math.cos(angle) * x - math.sin(angle) * y, math.sin(angle) * x + math.cos(angle) * y
    first, second = (
        rk.simulate(
            TOWER, tuple(rk.GroundMotion(a, 0.02) for a in (*pair, 0.3 * z)), law,
            start=SpatialStart(0.02, 0.4 + yaw, yaw), duration=3.0,
        )
        for pair, yaw in (((x, y), 0.0), (turned, angle))
    )  # fmt: skip
    until = first.impacts["time"][5] if first.impacts.size > 5 else 3.0
    keep = min(int((first.time < until).sum()), len(second.time))
    rotation = attitude.matrix(attitude.turn([0.0, 0.0, 1.0], angle))
    np.testing.assert_allclose(second.centre[:keep], first.centre[:keep] @ rotation.T, rtol=0.0, atol=1e-9)
    assert first.energy.closure < 1e-9


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the mirror image", within="1e-9")
@settings(max_examples=4 * TIMES)
@given(ANGLE, SPIN, LAW)
def test_a_mirrored_start_gives_the_mirrored_response(azimuth, spin, law):
    """Mirrored in the x-z plane: the same tilt, the opposite direction, to 1e-9 until the fourth impact."""
    assume(abs(math.sin(2.0 * azimuth)) > 0.05)  # on an edge with a spin it is left open which end stays
    turned = (-spin[0], spin[1], -spin[2])
    first, other = (
        rk.free_rocking(TOWER, restitution=law, start=SpatialStart(0.1, a, angular_velocity=w), duration=2.0)
        for a, w in ((azimuth, spin), (-azimuth, turned))
    )
    until = first.impacts["time"][4] if first.impacts.size > 4 else 2.0
    keep = min(int((first.time < until).sum()), len(other.time))
    np.testing.assert_allclose(other.centre[:keep], first.centre[:keep] * [1.0, -1.0, 1.0], rtol=0.0, atol=1e-9)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the diagonal", within="1e-11")
def test_equal_components_move_a_square_body_along_its_diagonal():
    """The same pulse along x and y: the centre stays on the diagonal to 1e-11, over vertices only."""
    pulse = rk.pulses.sine(amplitude=3.5, period=0.8)
    run = rk.simulate(SQUARE, {"x": pulse, "y": pulse}, "housner")
    assert run.impacts.size > 10
    np.testing.assert_allclose(run.centre[:, 0], run.centre[:, 1], rtol=0.0, atol=1e-11)
    assert {contact for _, _, contact, _ in run.intervals} == {ContactMode.REST, ContactMode.VERTEX}


@pytest.mark.slow
@pytest.mark.verifies("invariant", "bodies 256 times as large and as small", within="1e-9")
@pytest.mark.parametrize("size", [1.0 / 256.0, 256.0])
@pytest.mark.parametrize("azimuth", [0.0, 0.4])
def test_similar_bodies_rock_alike(size, azimuth):
    """Of another size, with times as its root: the same contacts in the same order until both rest, impacts at
    corresponding times to 1e-9."""
    first, other = (
        rk.free_rocking(
            SpatialBody.box(0.5 * s, 0.6 * s, 2.0 * s),
            restitution=0.6,
            start=SpatialStart(0.1, azimuth),
            rest_speed=1e-3,
        )
        for s in (1.0, size)
    )
    assert [interval[2:] for interval in other.intervals] == [interval[2:] for interval in first.intervals]
    assert first.contact[-1] == ContactMode.REST.code
    assert first.impacts.size > 6
    np.testing.assert_allclose(other.impacts["time"] / math.sqrt(size), first.impacts["time"], rtol=1e-9)
