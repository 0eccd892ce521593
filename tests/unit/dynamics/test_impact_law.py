"""Laws of impact: what they give, refuse, and are made of."""

import hashlib
import math
from typing import Any

import numpy as np
import pytest
from engines import every_engine
from scipy import stats

import rocking as rk
from rocking.dynamics import ConstantRestitution
from rocking.dynamics.content import hash_of
from rocking.dynamics.impact_laws import interpolated
from rocking.errors import InvalidValueError

# these take rows, whatever their type
SPEED: Any = rk.dynamics.SpeedRestitution
RANDOM: Any = rk.dynamics.RandomRestitution
BLOCK = rk.Block(width=0.5, height=2.0)


def impacts_of(restitution: Any, name: str, key: int = 0) -> Any:
    return rk.free_rocking(BLOCK, 0.12, restitution, engine=name, stream=key, duration=4.0).impacts


def test_speed_law() -> None:
    """Straight lines through the points, constant outside; a row given as list is copied and frozen."""
    law = SPEED([0.1, 0.5, 1.0], [0.9, 0.7, 0.6])
    for speed, expected in ((0.0, 0.9), (0.1, 0.9), (0.3, 0.8), (0.5, 0.7), (0.75, 0.65), (1.0, 0.6), (9.0, 0.6)):
        assert law.factor(speed, 0, 0) == pytest.approx(expected, rel=1e-15, abs=0.0)
    assert law.largest == 0.9
    with pytest.raises(ValueError, match="read-only"):
        law.factors[0] = 1.0
    assert interpolated(np.zeros(1), np.ones(1), math.nan) == 1.0
    assert ConstantRestitution().factor(3.0, 1, 2) == 1.0 == ConstantRestitution().largest


@pytest.mark.slow
@every_engine
def test_coefficients_by_side(name: str) -> None:
    """Landing left takes the left coefficient, landing right the right one, in either engine."""
    found = impacts_of({"left": 0.8, "right": 0.9}, name)
    assert found["foot"][:4].tolist() == ["left", "right", "left", "right"]
    expected = np.where(found["foot"] == "left", 0.8, 0.9)
    np.testing.assert_array_equal(found["coefficient"], expected)
    np.testing.assert_allclose(found["velocity_after"], expected * found["velocity_before"], rtol=1e-15)


@pytest.mark.slow
@every_engine
def test_speed_law_in_a_response(name: str) -> None:
    """Each impact has the coefficient of its own speed, times Housner's 1 - 3/2 sin^2(alpha)."""
    housner = 1.0 - 1.5 * math.sin(math.atan(0.25)) ** 2
    found = impacts_of(SPEED([0.05, 0.3], [1.0, 0.9], times="housner"), name)
    speeds = np.abs(found["velocity_before"])
    assert speeds[0] > 0.3 > speeds[-1], "both sides of a corner are met"
    np.testing.assert_allclose(found["coefficient"], housner * np.interp(speeds, [0.05, 0.3], [1.0, 0.9]), rtol=1e-13)


@pytest.mark.parametrize(
    ("at", "factors", "message"),
    [
        ([0.0, 0.0], [0.5, 0.5], "speeds >= 0 that increase"),
        ([1.0, 0.0], [0.5, 0.5], "speeds >= 0 that increase"),
        ([-0.1, 1.0], [0.5, 0.5], "speeds >= 0 that increase"),
        ([0.0], [0.5], "at must be a row of at least 2 finite numbers"),
        ([0.0, math.nan], [0.5, 0.5], r"at must be finite \[rad/s\], got nan at index 1"),
        ([0.0, math.inf], [0.5, 0.5], r"at must be finite \[rad/s\], got inf at index 1"),
        ([[0.0, 1.0]], [0.5, 0.5], "at must be a row"),
        (None, [0.5, 0.5], "at must be numbers"),
        (["0", "1"], [0.5, 0.5], "at must be numbers"),
        ([0.0, 1.0], [0.5, 0.5, 0.5], "factors must have one value per speed, 2, got 3"),
        ([0.0, 1.0], [0.5, 1.1], r"factors must be in \[0, 1\], got 0.5 to 1.1"),
        ([0.0, 1.0], [-0.1, 1.0], r"factors must be in \[0, 1\], got -0.1 to 1"),
        ([0.0, 1.0], [0.5, math.nan], "factors must be finite"),
        ([0.0, 1.0], None, "factors must be numbers"),
    ],
)
def test_bad_tables(at: Any, factors: Any, message: str) -> None:
    """Speeds that do not increase and coefficients outside [0, 1] are refused."""
    with pytest.raises(InvalidValueError, match=message):
        SPEED(at, factors)


def test_bad_distributions() -> None:
    """Decreasing quantiles, seeds that are no whole numbers, means and deviations out of range are refused."""
    with pytest.raises(InvalidValueError, match="quantiles, and must not decrease"):
        RANDOM([0.6, 0.5], 1)
    seed: Any
    for seed in (-1, 2**64, 1.0, None, True, "1"):
        with pytest.raises(InvalidValueError, match=r"seed must be a whole number in \[0, 2\^64\), got"):
            RANDOM([0.5, 0.6], seed)
    bad: Any
    for bad in (-0.1, 1.1, math.nan, None, "1"):
        with pytest.raises(InvalidValueError, match="mean must be"):
            rk.dynamics.RandomRestitution.normal(bad, 0.1, seed=1)
        with pytest.raises(InvalidValueError, match="deviation must be"):
            rk.dynamics.RandomRestitution.normal(0.5, bad, seed=1)
    with pytest.raises(InvalidValueError, match=r"deviation must be in \(0, 1\], got 0"):
        rk.dynamics.RandomRestitution.normal(0.5, 0.0, seed=1)
    for values, message in (([0.5], "values must be a row"), ([0.5, math.nan], "values"), ([0.5, 1.2], r"\[0, 1\]")):
        with pytest.raises(InvalidValueError, match=message):
            rk.dynamics.RandomRestitution.of_sample(values, seed=1)


class Worn(rk.dynamics.ImpactLaw):
    """A law of one's own: every impact takes more than the one before."""

    def factor(self, speed: float, key: int, impact: int) -> float:
        return 0.99**impact


@pytest.mark.slow
def test_a_law_of_ones_own() -> None:
    """It runs on the reference engine, by itself or asked for, and the fast engine refuses it."""
    block = rk.Block(width=0.5, height=2.0)
    for name in ("auto", "reference"):
        response = rk.free_rocking(block, 0.1, Worn(), engine=name)
        assert response.engine.startswith("reference")
        expected = 0.99 ** np.arange(response.impacts.size)
        np.testing.assert_allclose(response.impacts["coefficient"], expected, rtol=1e-15)
    with pytest.raises(InvalidValueError, match="fast engine does not support Worn"):
        rk.free_rocking(block, 0.1, Worn(), engine="fast")


class Wild(rk.dynamics.ImpactLaw):
    """A law that creates energy."""

    def factor(self, speed: float, key: int, impact: int) -> float:
        return 2.0


def test_a_law_beyond_its_largest_factor() -> None:
    """What a law returns is checked at every impact."""
    with pytest.raises(InvalidValueError, match=r"Wild.factor\(\) must return a number in \[0, 1\]"):
        rk.free_rocking(rk.Block(width=0.5, height=2.0), 0.1, Wild())


class Capped(rk.dynamics.SpeedRestitution):
    """A table with a cap that the table does not know."""

    def factor(self, speed: float, key: int, impact: int) -> float:
        return min(0.5, super().factor(speed, key, impact))


def test_a_law_derived_from_a_table() -> None:
    """What a subclass overrides is not ignored: it runs on the reference engine."""
    response = rk.free_rocking(rk.Block(width=0.5, height=2.0), 0.1, Capped([0.0, 1.0], [0.9, 0.8]))
    assert response.engine.startswith("reference")
    assert set(response.impacts["coefficient"]) == {0.5}


def test_ends_of_a_cut_normal_stand_a_quarter_of_a_step_inside() -> None:
    """N(.9, .05) cut to [0, 1], as 5 quantiles: at 1/20, 1/4, 1/2, 3/4 and 19/20 of what is left."""
    law = rk.dynamics.RandomRestitution.normal(0.9, 0.05, seed=1, points=5)
    wanted = stats.truncnorm((0.0 - 0.9) / 0.05, (1.0 - 0.9) / 0.05, 0.9, 0.05).ppf([0.05, 0.25, 0.5, 0.75, 0.95])
    np.testing.assert_allclose(law.factors, wanted, rtol=1e-12)


@pytest.mark.parametrize(
    "values",
    [
        np.arange(7.0), np.arange(12.0).reshape(3, 4).T, np.arange(9)[::2], np.empty(0), np.empty((0, 3)),
        np.array(2.5), np.array([True, False]), np.arange(5, dtype=">i4"), np.broadcast_to(2.0, (4,)),
    ],
)  # fmt: skip
def test_hash_is_of_kind_shape_and_bytes(values: np.ndarray) -> None:
    """SHA-256 of the words of type and shape, then of the numbers, little-endian in the order of C."""
    little = np.atleast_1d(values).astype(values.dtype.newbyteorder("<"))
    said = f"('{little.dtype.str}', {little.shape})".encode()
    assert hash_of(values) == hashlib.sha256(said + little.tobytes(order="C")).hexdigest()
