"""Many searches at once: each ends where that of scipy ends."""

import numpy as np
import pytest
from scipy.optimize import minimize, minimize_scalar

from rocking.evidence.searches import minimise_between, minimise_many

SHIFTS = np.array([0.0, 0.3, -0.7, 1.1, 2.0])


def rosenbrock(x, search):
    """Values at points of (n, 3), each of its search; the third variable of the first two searches has no effect."""
    x = x - SHIFTS[search, None] * (np.arange(3) < np.where(search < 2, 2, 3)[:, None])
    third = np.where(search < 2, 0.0, (x[:, 2] - x[:, 1] ** 2) ** 2)
    return 30.0 * (x[:, 1] - x[:, 0] ** 2) ** 2 + (1.0 - x[:, 0]) ** 2 + third


def steps(x, search):
    """A staircase, on which simplices shrink."""
    return np.floor(4.0 * np.abs(rosenbrock(x, search)))


@pytest.mark.slow
@pytest.mark.parametrize("function", [rosenbrock, steps])
@pytest.mark.parametrize("evaluations", [7, 31, 40, 1000])
def test_each_search_takes_the_steps_of_scipy(function, evaluations):
    starts, sizes = np.array([[-1.0, 0.5, 0.0]] * 2 + [[-1.0, 0.0, 2.0]] * 3), np.array([2, 2, 3, 3, 3])
    found = minimise_many(function, starts, sizes, tolerance=1e-5, evaluations=evaluations)
    for number, size in enumerate(sizes.tolist()):

        def alone(x, number=number, size=size):
            return float(function(np.pad(x, (0, 3 - size))[None], np.array([number]))[0])

        options = {"xatol": 1e-5, "fatol": 1e-5, "maxfev": evaluations, "adaptive": True}
        expected = minimize(alone, starts[number, :size], method="Nelder-Mead", options=options).x
        assert found[number, :size] == pytest.approx(expected, rel=1e-12, abs=1e-12)
        assert (found[number, size:] == 0.0).all()
    # negative control: searches that are given more evaluations end elsewhere
    if evaluations < 1000:
        assert (found != minimise_many(function, starts, sizes, tolerance=1e-5, evaluations=1000)).any()


def waves(x, search):
    """Functions of one variable, with a kink and several minima, the last one with its minimum at an end."""
    return np.where(search < 30, (x - 0.1 * search) ** 4 + np.sin(0.2 * search * x) + 0.3 * np.abs(x - 0.5), -x)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-3, 1e-7])
def test_each_search_between_bounds_takes_the_steps_of_scipy(tolerance):
    found = minimise_between(waves, (-0.5, 2.0), 31, tolerance=tolerance)
    for number in range(31):

        def alone(x, number=number):
            return float(waves(np.array([x]), np.array([number]))[0])

        expected = minimize_scalar(alone, bounds=(-0.5, 2.0), method="bounded", options={"xatol": tolerance}).x
        assert found[number] == pytest.approx(expected, rel=1e-12, abs=1e-12)
    # negative control: other bounds, other minima
    assert (found != minimise_between(waves, (-0.4, 2.0), 31, tolerance=tolerance)).all()
