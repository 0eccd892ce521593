"""Sobol indices: closed forms, cases, groups, what has no answer, and answers that were mixed up."""

import math

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.statistics.shares import SaltelliDesign, VarianceShare

pytestmark = pytest.mark.verifies(room="statistics")
ISHIGAMI = SaltelliDesign(1024, {"x": 1, "y": 1, "z": 1}, seed=3)


def ishigami(u, a=7.0, b=0.1):
    """The function of Ishigami and Homma, and its indices in closed form."""
    x, y, z = (2.0 * math.pi * u - math.pi).T
    values = np.sin(x) + a * np.sin(y) ** 2 + b * z**4 * np.sin(x)
    of_x, of_y = 0.5 * (1.0 + b * math.pi**4 / 5.0) ** 2, a**2 / 8.0
    together = b**2 * math.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    whole = of_x + of_y + together
    first = {"x": of_x / whole, "y": of_y / whole, "z": 0.0}
    total = {"x": (of_x + together) / whole, "y": of_y / whole, "z": together / whole}
    return values, first, total


@pytest.mark.verifies(
    "closed form", "Ishigami's function", within="0.03", control="test_answers_that_were_mixed_up_have_other_indices"
)
def test_indices_of_ishigami():
    """First-order and total indices, within their intervals."""
    values, first, total = ishigami(ISHIGAMI.points)
    for name, share in ISHIGAMI.shares(values).items():
        assert share.first == pytest.approx(first[name], abs=0.03)
        assert share.total == pytest.approx(total[name], abs=0.03)
        assert share.first_low - 0.01 <= first[name] <= share.first_high + 0.01
        assert share.total_low - 0.01 <= total[name] <= share.total_high + 0.01


@pytest.mark.verifies("negative control")
def test_answers_that_were_mixed_up_have_other_indices():
    """Negative control: the same answers in another order say nothing of their inputs."""
    values, first, _ = ishigami(ISHIGAMI.points)
    mixed = ISHIGAMI.shares(np.random.default_rng(1).permutation(values))
    assert abs(mixed["y"].first - first["y"]) > 0.2
    assert abs(mixed["y"].total - 1.0) < 0.2  # no better known with all the others than without


@pytest.mark.verifies("closed form", "a sum of which one input takes two numbers, over two cases", within="0.02")
def test_inputs_of_two_numbers_and_cases():
    """An input may take several numbers, and the case is one more."""
    design = SaltelliDesign(1024, {"pair": 2, "alone": 1}, seed=5)
    u = design.points
    one = u[:, 0] + 2.0 * u[:, 1] + u[:, 2]
    found = design.shares(np.column_stack([one, one + 1.0]))
    variances = {"pair": 5.0 / 12.0, "alone": 1.0 / 12.0, "case": 0.25}
    for name, variance in variances.items():
        assert found[name].first == pytest.approx(variance / 0.75, abs=0.02)
        assert found[name].total == pytest.approx(variance / 0.75, abs=0.02)


def test_the_points_depend_on_the_seed_alone():
    again, other = (SaltelliDesign(16, {"x": 1, "y": 2}, seed=k).points for k in (3, 4))
    points = SaltelliDesign(16, {"x": 1, "y": 2}, seed=3).points
    assert points.shape == (64, 3)
    assert np.array_equal(points, again)
    assert not np.array_equal(points, other)
    # the third block is the first with x of the second
    assert np.array_equal(points[32:48, 0], points[16:32, 0])
    assert np.array_equal(points[32:48, 1:], points[:16, 1:])


def test_a_point_without_an_answer_is_left_out():
    values, first, _ = ishigami(ISHIGAMI.points)
    values[[5, 3000]] = np.nan
    assert ISHIGAMI.shares(values)["y"].first == pytest.approx(first["y"], abs=0.03)


def test_an_input_that_does_nothing_has_no_share():
    """Exactly, however few points there are."""
    design = SaltelliDesign(8, {"x": 1, "idle": 1}, seed=1)
    assert design.shares(design.points[:, 0] ** 2)["idle"] == VarianceShare(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_what_does_not_vary_has_no_shares():
    found = ISHIGAMI.shares(np.ones((len(ISHIGAMI.points), 3)))
    assert all(abs(share.first) < 1e-9 and share.total == 0.0 for share in found.values())


@pytest.mark.parametrize("count", [0, 1, 3, 100, 1.5])
def test_counts_are_powers_of_two(count):
    with pytest.raises(InvalidValueError, match="count"):
        SaltelliDesign(count, {"x": 1})


@pytest.mark.parametrize(
    ("answers", "why"), [(np.zeros(7), "one value for each of the 5120 points"), (np.full(5120, np.nan), "no point")]
)
def test_answers_that_do_not_fit(answers, why):
    with pytest.raises(InvalidValueError, match=why):
        ISHIGAMI.shares(answers)
