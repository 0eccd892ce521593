"""The plastic bed against its own equations solved in another way, with kinks found on the dense output."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rocking.restitution.plastic_winkler import land

pytestmark = pytest.mark.verifies(room="contact bed")

BASES = {
    "whole base": (0.06, 1.0, [[-1.0, 1.0]]),
    "stocky": (1.6, 0.4, [[-0.4, 1.0]]),
    "two feet": (0.12, 1.2, [[-1.2, -0.7], [0.5, 1.0]]),
    "three feet": (0.37, 6.2, [[-6.2, -4.1], [-4.0, -1.5], [-1.2, 1.0]]),
    # so squat that the middle is driven up again and the body stops
    "back to the old foot": (1.47, 6.8, [[-6.8, -4.2], [-0.2, 1.0]]),
    "back short of the old foot": (2.3, 6.3, [[-5.2, -3.95], [0.41, 0.47]]),
    "short of the foot": (0.3, 0.8, [[-0.7, 0.1], [0.3, 0.9]]),
}


def landed(kappa, back, stretches):
    """Velocity with the pressures summed at Gauss points, in many small steps, begun anew at every kink."""
    nodes, weights = np.polynomial.legendre.leggauss(2)  # pressure times lever is of second degree
    total = sum(far - near for near, far in stretches)
    end = min(stretches[-1][1], 1.0)
    edges = [edge for stretch in stretches for edge in stretch][:-1]

    def rates(_, state):
        v, omega, y, theta = state
        force = moment = 0.0
        for near, far in stretches:
            half = 0.5 * (far - min(max(near, v / omega), far))
            x = far - half * (1.0 - nodes)
            pressure = half * weights * (theta * x - y)
            force, moment = force + pressure.sum(), moment + (pressure * x).sum()
        return [force / total, -kappa * moment / total, v, omega]

    def event(edge):
        def passed(_, state):
            return state[0] - edge * state[1]

        passed.terminal, passed.direction = True, 1.0
        return passed

    def over(_, state):
        return end * state[1] - state[0] - 1e-13

    def still(_, state):
        return state[1] - 1e-9

    over.terminal = still.terminal = True
    time, state = 0.0, np.array([-back, 1.0, 0.0, 0.0])
    left = [edge for edge in edges if edge > -back]
    while True:
        watched = [over, still, *(event(edge) for edge in left[:1])]
        run = solve_ivp(rates, (time, 1e3), state, "DOP853", rtol=2.3e-14, atol=1e-17, events=watched, max_step=0.02)
        time, state = run.t[-1], run.y[:, -1]
        if len(run.t_events[0]) or len(run.t_events[1]):
            return 0.0 if len(run.t_events[1]) else state[1]
        del left[0]


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew",
    "the equations of the bed solved in another way, by SciPy",
    within="1e-12",
    control="test_gaps_matter",
)
@pytest.mark.parametrize(("kappa", "back", "stretches"), BASES.values(), ids=BASES)
def test_velocity_after_the_bed(kappa, back, stretches):
    """The velocity with which the body leaves the bed agrees to twelve digits, kinks of the base included."""
    end, velocity = land(kappa, back, np.array(stretches))
    assert end == min(stretches[-1][1], 1.0)
    assert velocity == pytest.approx(landed(kappa, back, stretches), rel=0.0, abs=1e-12)


@pytest.mark.verifies("negative control", "a base without its gap")
def test_gaps_matter():
    """Negative control: a base without its gap gives another velocity, so the comparison can fail."""
    gap = land(0.12, 1.2, np.array([[-1.2, -0.7], [0.5, 1.0]]))[1]
    assert abs(gap - land(0.12, 1.2, np.array([[-1.2, 1.0]]))[1]) > 1e-3


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the base in two and in a hundred pieces", within="1e-12")
def test_a_cut_without_gap_changes_nothing():
    """A base cut in two or in a hundred pieces that touch is one base."""
    whole = land(0.2, 0.9, np.array([[-0.9, 1.0]]))[1]
    for pieces in (2, 100):
        edges = np.linspace(-0.9, 1.0, pieces + 1)
        cut = land(0.2, 0.9, np.column_stack([edges[:-1], edges[1:]]))[1]
        assert cut == pytest.approx(whole, rel=0.0, abs=1e-12)


@pytest.mark.slow
def test_heavy_landings_end():
    """From needles to plates the integration ends, with a velocity between standing still and the one before."""
    for kappa in np.geomspace(1e-12, 10.0, 14).tolist():
        velocity = land(kappa, 1.0, np.array([[-1.0, 1.0]]))[1]
        assert math.isfinite(velocity)
        assert 0.0 <= velocity <= 1.0
