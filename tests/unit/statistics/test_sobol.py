"""Scrambled Sobol points: those of scipy, which takes long to be imported."""

import numpy as np
import pytest
from scipy.stats.qmc import Sobol

from rocking.errors import InvalidValueError
from rocking.statistics.shares import SaltelliDesign
from rocking.statistics.sobol import MOST, scrambled_sobol


@pytest.mark.parametrize("count", [1, 2, 1024])
@pytest.mark.parametrize("dimensions", [1, 2, 9, MOST])
def test_the_points_are_those_of_scipy(dimensions, count):
    for seed in (0, 7, 2**40):
        expected = Sobol(dimensions, scramble=True, seed=seed).random(count)
        assert np.array_equal(scrambled_sobol(dimensions, count, seed), expected)
    # negative control: another seed has other points
    assert not np.array_equal(scrambled_sobol(dimensions, count, 1), expected)


def test_more_inputs_than_tabulated_are_refused():
    assert SaltelliDesign(4, {"x": MOST // 2}).points.shape == (12, MOST // 2)
    with pytest.raises(InvalidValueError, match="inputs"):
        SaltelliDesign(4, {"x": MOST // 2 + 1})
