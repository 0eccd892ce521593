"""The three states and the levels between them."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics.parameters import RockingParameters, RockingSide
from rocking.errors import InvalidValueError
from rocking.studies.fragility.subject import Responses, limit_states

SIDES = RockingSide(0.2, 2.0, 1.0, 0.9), RockingSide(0.4, 2.0, 1.0, 0.9)
ROCKER = RockingParameters(*SIDES, None, "")  # type: ignore[arg-type]
ARRAYS = {
    "outcome": np.array([0, 1, 1, 2, 3], dtype=np.int8),  # as the codes of `Outcome` are documented
    "peak_rotation": np.array([0.0, 0.12, -0.12, -0.5 * math.pi, math.nan]),
}


def test_rotation_is_over_the_alpha_of_its_side():
    """A rotation of 0.12 rad is 0.6 of the right side's angle and 0.3 of the left side's."""
    found = Responses.of(ARRAYS, ROCKER, (5,))
    np.testing.assert_allclose(found.rotation, [0.0, 0.6, 0.3, math.inf, math.nan], rtol=1e-15)
    assert found.sides.tolist() == [0, 0, 0, -1, 0]
    other = Responses.of(
        {name: -values if name == "peak_rotation" else values for name, values in ARRAYS.items()}, ROCKER, (5,)
    )
    assert other.sides.tolist() == [0, 0, 0, 1, 0]


def test_states_are_nested():
    """What reaches a state has reached all before it; of a failed one nothing is known."""
    found = Responses.of(ARRAYS, ROCKER, (5,))
    reached = np.array([found.exceed(state) for state in limit_states((0.2, 0.5))])
    assert reached[:, :4].tolist() == [[0, 1, 1, 1], [0, 1, 1, 1], [0, 1, 0, 1], [0, 0, 0, 1]]
    assert np.isnan(reached[:, 4]).all()
    assert found.good.tolist() == [True] * 4 + [False]
    assert found.counts() == {rk.Outcome.NO_UPLIFT: 1, rk.Outcome.ROCKED: 2, rk.Outcome.OVERTURNED: 1}


def test_levels_may_be_absent_or_above_one():
    """No level leaves rocking and overturning; rotations beyond alpha that come back are states as well."""
    assert [s.name for s in limit_states(())] == ["rocking", "overturned"]
    assert limit_states((1.2,))[1].level == 1.2


@pytest.mark.parametrize(
    "bad", [(0.5, 0.2), (0.0,), (-1.0,), (math.nan,), (math.inf,), (0.5, 0.5), "half", [[0.1], [0.2]]]
)
def test_bad_levels_are_refused(bad):
    """Levels must be finite, above zero, increasing."""
    with pytest.raises(InvalidValueError):
        limit_states(bad)


def test_results_of_another_study_are_refused():
    """Arrays that do not fit the shape never become states."""
    with pytest.raises(InvalidValueError, match="another study"):
        Responses.of(ARRAYS, ROCKER, (4,))
    with pytest.raises(InvalidValueError):
        Responses.of({"outcome": np.zeros(5)}, ROCKER, (5,))


def test_states_of_simulated_bodies():
    """Peak rotations of the engine over the body's own alpha, against one simulation each."""
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6)
    one = rk.simulate(block, pulse, restitution=0.9)
    arrays = {"outcome": np.array([one.outcome.code]), "peak_rotation": np.array([-one.peak_rotation])}
    found = Responses.of(arrays, RockingParameters.of_body(block, 0.9, 9.80665), (1,))
    assert found.rotation[0] == pytest.approx(one.peak_rotation / math.atan(0.25), rel=1e-14)
