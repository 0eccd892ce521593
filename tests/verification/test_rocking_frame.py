"""A free-standing frame rocks like a single block of another size and coefficient (Makris and Vassiliou 2013).

A rigid beam of mass m_b lies on N equal columns of mass m_c, semi-diagonal R and slenderness angle alpha, and nothing
slides. Every column turns by theta about a corner of its foot and carries the beam on the corner across the diagonal,
2 R away, so the beam translates along an arc of radius 2 R. With gamma = m_b / (N m_c) and I_O = 4/3 m_c R^2:

    T = (N I_O + m_b (2 R)^2) theta'^2 / 2              V = (N m_c g R + m_b g 2 R) cos(alpha - |theta|)
    (N I_O + 4 m_b R^2) theta'' = -(N m_c + 2 m_b) g R sin(alpha - |theta|) sign(theta)
    p_hat^2 = 3 g / (4 R) (1 + 2 gamma) / (1 + 3 gamma)

At an impact every column swaps the corners at its foot and at its top. The momentum of the beam changes by the impulse
J from the columns, and the angular momentum of the columns about their new corners by the moment of -J at the new
corners of their tops. Before, the beam moves by 2 R theta' (cos alpha, -sin alpha), after by 2 R theta' (cos alpha,
sin alpha), and along the new arc the old momentum counts cos 2 alpha:

    N m_c R^2 (4/3 w - (1/3 + cos 2 alpha) w0) + 4 m_b R^2 (w - cos 2 alpha w0) = 0
    r_frame = w / w0 = (1 - 3/2 sin^2 alpha + 3 gamma cos 2 alpha) / (1 + 3 gamma)

The frame is integrated here from its masses and lengths, its impacts solved as balances of impulses; the engines get
the block of p_hat, alpha and r_frame.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from engines import every_engine
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from rocking.conventions import g
from rocking.dynamics import ConstantRestitution, PlaneSettings, RockingParameters, RockingSide
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.plane.fast_engine import run
from rocking.motions import Segments

pytestmark = pytest.mark.verifies(room="rocking in the plane")

IMPACTS = 3
WITHIN = 1e-8


@dataclass(frozen=True)
class Frame:
    """Columns and the beam on them: number, half width and half height [m] and mass [kg] of a column, mass of it."""

    columns: int
    half_width: float
    half_height: float
    column_mass: float
    beam_mass: float

    @property
    def alpha(self) -> float:
        return math.atan2(self.half_width, self.half_height)

    @property
    def radius(self) -> float:
        return math.hypot(self.half_width, self.half_height)

    @property
    def gamma(self) -> float:
        return self.beam_mass / (self.columns * self.column_mass)

    def acceleration(self, theta: float) -> float:
        """Lagrange's equation for theta > 0."""
        about_foot = 4.0 / 3.0 * self.column_mass * self.radius**2
        inertia = self.columns * about_foot + self.beam_mass * (2.0 * self.radius) ** 2
        weight = (self.columns * self.column_mass + 2.0 * self.beam_mass) * g * self.radius
        return -weight * math.sin(self.alpha - theta) / inertia

    def after(self, before: float) -> float:
        """Angular velocity after an impact: momentum of the beam and angular momentum of the columns, solved."""
        b, h, m = self.half_width, self.half_height, self.columns * self.column_mass
        # from the old and the new corner at the foot to the centre; turning by w moves (x, z) at w (z, -x)
        old, new = np.array([-b, h]), np.array([b, h])
        moved, moves = np.array([old[1], -old[0]]), np.array([new[1], -new[0]])
        about_centre = m * (b * b + h * h) / 3.0
        momentum = about_centre + m * (new[1] * moved[0] - new[0] * moved[1])
        # unknown: angular velocity after, impulse (x, z) on the beam, at twice the way to the centre
        equations = np.array(
            [
                [about_centre + m * (new @ new), 2.0 * new[1], -2.0 * new[0]],
                [2.0 * self.beam_mass * moves[0], -1.0, 0.0],
                [2.0 * self.beam_mass * moves[1], 0.0, -1.0],
            ]
        )
        known = np.array([momentum, *(2.0 * self.beam_mass * moved)]) * before
        return float(np.linalg.solve(equations, known)[0])

    def impacts(self, rotation: float) -> np.ndarray:
        """Times of the first impacts after a release, and velocities before and after, by rows."""
        pace = math.sqrt(0.75 * g / self.radius)
        time, state, sign, rows = 0.0, [rotation, 0.0], 1.0, []

        def down(_: float, y: Any) -> float:
            return float(y[0])

        down.terminal, down.direction = True, -1.0  # type: ignore[attr-defined]
        for _ in range(IMPACTS):
            # short steps, because the event is sought on an interpolant of lower order
            found = solve_ivp(
                lambda _, y: (y[1], self.acceleration(y[0])), (time, time + 40.0 / pace), state, method="DOP853",
                rtol=1e-12, atol=1e-15, max_step=0.05 / pace, events=down,
            )  # fmt: skip
            assert found.t_events is not None
            assert found.y_events is not None
            time, before = float(found.t_events[0][0]), float(found.y_events[0][0][1])
            after = self.after(before)
            rows.append((time, sign * before, sign * after))
            sign, state = -sign, [0.0, -after]
        return np.array(rows)


def frequency(frame: Frame) -> float:
    """p_hat of the equivalent block."""
    alone = math.sqrt(0.75 * g / frame.radius)
    return alone * math.sqrt((1.0 + 2.0 * frame.gamma) / (1.0 + 3.0 * frame.gamma))


def coefficient(frame: Frame) -> float:
    """r of the frame."""
    alone, beam = 1.0 - 1.5 * math.sin(frame.alpha) ** 2, 3.0 * frame.gamma
    return (alone + beam * math.cos(2.0 * frame.alpha)) / (1.0 + beam)


def block_impacts(name: str, alpha: float, p: float, r: float, rotation: float) -> np.ndarray:
    """The same numbers of a block, by an engine."""
    side = RockingSide(alpha, p, 0.75 * g / p**2, r)
    still = Segments.still(0.5 / p, 80)
    # the default steps of the fast engine are good to 1e-7 only
    options = PlaneSettings(longest_step=0.03, rest_speed=1e-9)
    found = run(
        RockingParameters(side, side, ConstantRestitution(), ""), still, options, engine=name, rotation=rotation
    )
    events = [e for e in found.events if e.kind is EventKind.IMPACT][:IMPACTS]
    return np.array([(e.time, e.before, e.after) for e in events])


def apart(one: np.ndarray, other: np.ndarray) -> float:
    """Largest relative difference of times and velocities."""
    assert one.shape == other.shape == (IMPACTS, 3)
    return float(np.abs(other / one - 1.0).max())


def frame_of(columns: int, gamma: float, size: float, alpha: float, mass: float) -> Frame:
    return Frame(columns, size * math.sin(alpha), size * math.cos(alpha), mass, gamma * columns * mass)


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew",
    "a frame of columns and a beam, integrated from its masses by SciPy (Makris and Vassiliou 2013)",
    within="1e-8",
    control="test_other_blocks_are_told_apart",
    doi="10.1002/eqe.2222",
)
@every_engine
@settings(max_examples=15, deadline=None)
@given(
    columns=st.integers(1, 40), gamma=st.floats(0.0, 20.0), size=st.floats(0.1, 20.0), alpha=st.floats(0.05, 0.5),
    ratio=st.floats(0.05, 0.95), mass=st.floats(1e-2, 1e6),
)  # fmt: skip
@example(columns=2, gamma=0.0, size=1.0, alpha=0.25, ratio=0.5, mass=1.0)
@example(columns=2, gamma=4.0, size=5.0, alpha=0.17, ratio=0.8, mass=1e5)
def test_a_frame_is_a_block(
    name: str, columns: int, gamma: float, size: float, alpha: float, ratio: float, mass: float
) -> None:
    """Times and velocities of the first three impacts are those of the block with p_hat, alpha and r_frame."""
    frame = frame_of(columns, gamma, size, alpha, mass)
    block = block_impacts(name, frame.alpha, frequency(frame), coefficient(frame), ratio * alpha)
    assert apart(frame.impacts(ratio * alpha), block) < WITHIN


@pytest.mark.slow
@pytest.mark.verifies("negative control", "p or r of a column alone")
@every_engine
@pytest.mark.parametrize("gamma", [0.1, 1.0, 10.0])
def test_other_blocks_are_told_apart(name: str, gamma: float) -> None:
    """Negative control: neither p nor r of a column alone will do, and without a beam both do."""
    frame, bare = frame_of(4, gamma, 2.0, 0.2, 1e3), frame_of(4, 0.0, 2.0, 0.2, 1e3)
    p, r = math.sqrt(0.75 * g / 2.0), 1.0 - 1.5 * math.sin(0.2) ** 2
    true = frame.impacts(0.1)
    assert apart(true, block_impacts(name, 0.2, p, coefficient(frame), 0.1)) > 0.02
    assert apart(true, block_impacts(name, 0.2, frequency(frame), r, 0.1)) > 0.002
    assert apart(bare.impacts(0.1), block_impacts(name, 0.2, p, r, 0.1)) < WITHIN


@pytest.mark.verifies("closed form", "limits of a heavy beam", within="1e-8")
def test_the_frame_is_larger_and_loses_more_than_its_columns() -> None:
    """A heavy beam makes p^2 two thirds and r cos 2 alpha, the limits of large gamma."""
    heavy = frame_of(3, 1e9, 1.5, 0.3, 10.0)
    assert frequency(heavy) ** 2 / (0.75 * g / 1.5) == pytest.approx(2.0 / 3.0, rel=1e-8)
    assert heavy.acceleration(0.1) == pytest.approx(-(g / 3.0) * math.sin(0.2), rel=1e-8)
    assert heavy.after(1.0) == pytest.approx(math.cos(0.6), rel=1e-8)
