"""Rocking frames: the equivalent body against independent values, and against all columns and the beam.

The second route has no equivalent body. It turns every column about its foot, moves the beam with the carried points,
forms energies from these positions with complex steps, integrates Lagrange's equation with scipy, and solves each
impact as balances of momentum of every column and of the beam, with unknown impulses at both ends of each column.
"""

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking as rk
from rocking.errors import GeometryError, InvalidValueError

pytestmark = pytest.mark.verifies(room="rocking in the plane")

G = 9.81
COLUMN = rk.Block(width=1.0, height=4.0, mass=1000.0)
TABLE = [  # support, gamma, r, (p_hat / p)^2, tan alpha_hat (structures.md 5, two routes)
    ("corner", 0.5, Fraction(76, 85), 0.8, 0.25),
    ("corner", 1.0, Fraction(121, 136), 0.75, 0.25),
    ("corner", 3.0, Fraction(301, 340), 0.7, 0.25),
    ("hinge", 0.5, Fraction(313, 331), 0.8111093266248, 0.1875),
    ("hinge", 1.0, Fraction(251, 263), 0.7628858527139, 1.0 / 6.0),
    ("hinge", 3.0, Fraction(629, 653), 0.7143585782353, 1.0 / 7.0),
]


@pytest.mark.parametrize(("support", "gamma", "r", "ratio", "slope"), TABLE)
@pytest.mark.verifies("closed form", "Makris & Vassiliou 2013, and exact fractions", within="1e-12",
                      control="test_the_other_support_is_seen")  # fmt: skip
def test_table(support, gamma, r, ratio, slope):
    """Coefficient, frequency parameter and slenderness of the equivalent body, for any number of columns."""
    for count in (1, 2, 5):
        frame = rk.Frame([COLUMN] * count, gamma * count * COLUMN.mass, beam_on=support)
        assert rk.coefficient_of_restitution(frame) == pytest.approx(float(r), rel=1e-14)
        assert (frame.frequency_parameter / COLUMN.frequency_parameter) ** 2 == pytest.approx(ratio, rel=1e-12)
        assert math.tan(frame.slenderness_angle) == pytest.approx(slope, rel=1e-13)
        assert frame.is_symmetric


@pytest.mark.verifies("negative control")
def test_the_other_support_is_seen():
    """Negative control: the values of one support miss those of the other by more than 5 %."""
    corner, hinge = (rk.Frame([COLUMN] * 2, 2000.0, beam_on=support) for support in ("corner", "hinge"))
    assert abs(rk.coefficient_of_restitution(corner) - 251 / 263) > 0.05
    assert abs(math.tan(hinge.slenderness_angle) - 0.25) > 0.05


@pytest.mark.verifies("computed anew", "two independent programs", within="2e-10",
                      control="test_the_history_depends_on_the_beam")  # fmt: skip
def test_independent_history():
    """Uplift, peaks and impacts of the row "lam 4 gam 3 h 1.5 pulse 5 0.8"."""
    response = history(6000.0)
    assert response.parameters.label == "projection of the frame"
    assert response.uplifts[0] == pytest.approx(0.06527433427, abs=2e-11)
    times, before = response.impacts["time"][:2], response.impacts["velocity_before"][:2]
    assert np.allclose(times, [0.68590477172, 3.44128806583], rtol=0.0, atol=2e-10)
    assert np.allclose(before, [0.413963647315, -0.440071322757], rtol=0.0, atol=2e-10)
    tied = rk.Restrained(response.body, rk.Spring(x=0.5, length=1.0, stiffness=0.0))  # its engine keeps the peaks
    peaks = rk.simulate(tied, response.motion, gravity=G, duration=5.0, engine="reference").trajectory.peaks
    expected = [(0.50099620182, -3.76253325373e-02), (2.06709442286, 2.05287308405e-01),
                (4.18223851212, -1.25962306578e-01)]  # fmt: skip
    assert np.allclose(peaks[:3], expected, rtol=0.0, atol=2e-10)


def history(beam_mass, **options):
    column = rk.Block(width=0.75, height=3.0, mass=1000.0)
    frame = rk.Frame([column] * 2, beam_mass)
    return rk.simulate(frame, rk.pulses.sine(5.0, 0.8), gravity=G, duration=5.0, **options)


@pytest.mark.verifies("negative control")
def test_the_history_depends_on_the_beam():
    """Negative control: 0.1 % more mass of the beam moves the second impact by more than the tolerance."""
    assert abs(history(6006.0).impacts["time"][1] - 3.44128806583) > 1e-6


@pytest.mark.parametrize("engine", ["reference", "fast"])
@pytest.mark.parametrize("support", ["corner", "hinge"])
@pytest.mark.verifies("invariant", "the column alone", within="1e-12")
def test_without_a_beam_each_column_rocks_alone(support, engine):
    """A beam without mass gives the response of a single column."""
    frame, pulse = rk.Frame([COLUMN] * 3, 0.0, beam_on=support), rk.pulses.sine(4.0, 1.0)
    options = {"gravity": G, "duration": 6.0, "engine": engine, "restitution": "housner"}
    together, alone = rk.simulate(frame, pulse, **options), rk.simulate(COLUMN, pulse, **options)
    assert np.abs(together.rotation - alone.rotation).max() < 1e-12
    assert alone.peak_rotation > 0.05


# ---- all columns and the beam ------------------------------------------------------------------------------------

SKEW = rk.Section.from_points([(0.0, 0.0), (1.0, 0.0), (1.1, 3.5), (0.3, 3.5)], 2000.0, depth=0.7)
HEAVY = rk.Section.from_points([(0.0, 0.0), (1.0, 0.0), (1.1, 3.5), (0.3, 3.5)], 3000.0, depth=0.9, feet=(0.0, 1.0))
FRAMES = {
    "equal, corner": ([COLUMN, COLUMN], 3000.0, "corner"),
    "equal, hinge": ([COLUMN, COLUMN], 3000.0, "hinge"),
    "asymmetric, corner": ([SKEW, SKEW, SKEW], 9000.0, "corner"),
    "asymmetric, hinge": ([SKEW, SKEW], 9000.0, "hinge"),
    "other masses": ([SKEW, HEAVY], 9000.0, "corner"),
    "block and lighter block": (
        [COLUMN, rk.Block(width=1.0, height=4.0, mass=400.0, centre=(0.45, 1.5), moment_of_inertia=500.0)],
        2000.0, "corner",
    ),
}  # fmt: skip


class Mechanism:
    """Columns and a beam, by the positions of their points."""

    def __init__(self, columns, beam_mass, support, spring=None):
        self.columns, self.beam, self.support, self.spring = columns, beam_mass, support, spring

    def carried(self, column, side):
        """Return the point of a column that carries the beam, of the upright column."""
        section = column.to_section() if isinstance(column, rk.Block) else column
        vertices = np.vstack([r.outline for r in section.regions]) + np.array([section.origin_x, section.ground])
        height = vertices[:, 1].max()
        top = vertices[np.isclose(vertices[:, 1], height), 0]
        ends = {1: top.min(), -1: top.max()}
        x = ends[side] if self.support == "corner" else 0.5 * (top.min() + top.max())
        return np.array([x, height])

    def at(self, column, point, side, theta):
        """Return the position of a point of a column after a rotation about its foot; positive is clockwise."""
        foot = np.array([column.feet[side > 0], 0.0])
        x, z = np.asarray(point) - foot
        return foot + np.array([x * np.cos(theta) + z * np.sin(theta), z * np.cos(theta) - x * np.sin(theta)])

    def masses(self, side, theta):
        """Yield mass, moment of inertia and position of every column, and of the beam."""
        for column in self.columns:
            yield column.mass, column.moment_of_inertia, self.at(column, column.centre, side, theta)
        yield self.beam, 0.0, self.at(self.columns[0], self.carried(self.columns[0], side), side, theta)

    def rates(self, side, theta):
        """Return velocities for a unit rate."""
        return [np.imag(x) / 1e-30 for _, _, x in self.masses(side, theta + 1e-30j)]

    def inertia(self, side, theta):
        pairs = zip(self.masses(side, theta), self.rates(side, theta), strict=True)
        return sum(m * (v @ v) + i for (m, i, _), v in pairs)

    def stored(self, side, theta):
        """Return the energy of gravity and of the spring between the ground and column 1."""
        energy = sum(m * G * x[1] for m, _, x in self.masses(side, theta))
        if self.spring:
            ground, point, k = self.spring
            gap = self.at(self.columns[0], point, side, theta) - ground
            energy += 0.5 * k * (np.sqrt(gap @ gap) - math.dist(ground, point)) ** 2
        return energy

    def acceleration(self, side, theta, velocity, push):
        step = 1e-6
        slope = (self.inertia(side, theta + step) - self.inertia(side, theta - step)) / (2.0 * step)
        force = -np.imag(self.stored(side, theta + 1e-30j)) / 1e-30
        drive = sum(m * v[0] for (m, _, _), v in zip(self.masses(side, theta), self.rates(side, theta), strict=True))
        return (force - push * drive - 0.5 * slope * velocity**2) / self.inertia(side, theta)

    def impact(self, side, before):
        """Return the rate about the feet of the new side; unknowns are the rate and all impulses."""
        after, count = -side, len(self.columns)
        matrix, right = np.zeros((3 * count + 2, 1 + 4 * count)), np.zeros(3 * count + 2)
        old, new = self.rates(side, 0.0), self.rates(after, 0.0)
        for k, column in enumerate(self.columns):
            row, foot, head = 3 * k, 1 + 4 * k, 3 + 4 * k
            matrix[row : row + 2, 0], right[row : row + 2] = column.mass * new[k], column.mass * old[k] * before
            matrix[row : row + 2, foot : foot + 2] = -np.eye(2)
            matrix[row : row + 2, head : head + 2] = -np.eye(2)
            inertia = column.moment_of_inertia
            matrix[row + 2, 0], right[row + 2] = inertia, inertia * before
            for start, point in ((foot, (column.feet[after > 0], 0.0)), (head, self.carried(column, after))):
                x, z = np.asarray(point) - column.centre
                matrix[row + 2, start : start + 2] = -z, x  # clockwise moment of (Jx, Jz): z Jx - x Jz
            matrix[-2:, head : head + 2] = np.eye(2)
        matrix[-2:, 0], right[-2:] = self.beam * new[-1], self.beam * old[-1] * before
        solution = np.linalg.lstsq(matrix, right, rcond=None)[0]
        assert np.abs(matrix @ solution - right).max() < 1e-9 * np.abs(right).max()
        return solution[0]


def free_motion(mechanism, theta, impacts):
    """Return the impacts (time, rate before, rate after) of a motion from rest at a rotation to the right."""
    side, time, state, result = 1, 0.0, [theta, 0.0], []
    while len(result) < impacts:

        def crossing(_, y):
            return y[0]

        crossing.terminal, crossing.direction = True, -side
        solved = solve_ivp(
            lambda _, y, s=side: [y[1], mechanism.acceleration(s, y[0], y[1], 0.0)], (0.0, 5.0), state,
            events=crossing, method="DOP853", rtol=1e-9, atol=1e-12,
        )  # fmt: skip
        time += solved.t_events[0][0]
        before = solved.y_events[0][0][1]
        after = mechanism.impact(side, before)
        result.append((time, before, after))
        side, state = -side, [0.0, after]
    return result


@pytest.mark.parametrize("name", FRAMES)
@pytest.mark.verifies("computed anew", "Lagrange's equation of all columns and the beam", within="1e-7",
                      room="rocking in the plane")  # fmt: skip
def test_equivalent_body_is_the_mechanism(name):
    """Impacts of a free motion from 0.1 rad; scipy and the finite difference of the inertia limit the agreement."""
    columns, beam, support = FRAMES[name]
    expected = free_motion(Mechanism(columns, beam, support), 0.1, 3)
    frame = rk.Frame(columns, beam, beam_on=support)
    response = rk.free_rocking(frame, 0.1, gravity=G, duration=expected[-1][0] + 0.1)
    for impact, (time, before, after) in zip(response.impacts, expected, strict=False):
        assert impact["time"] == pytest.approx(time, rel=1e-7)
        assert impact["velocity_before"] == pytest.approx(before, rel=1e-7)
        assert impact["velocity_after"] == pytest.approx(after, rel=1e-7)
    assert response.impacts.size >= 3


@pytest.mark.parametrize("name", FRAMES)
@pytest.mark.verifies("computed anew", "balances of momentum", within="1e-12", control="test_the_formula_of_one_body")
def test_projection_is_the_balance_of_impulses(name):
    """The coefficient of each side satisfies the balances of momentum of every column and of the beam."""
    columns, beam, support = FRAMES[name]
    mechanism, frame = Mechanism(columns, beam, support), rk.Frame(columns, beam, beam_on=support)
    for foot, side in (("left", 1), ("right", -1)):
        assert rk.coefficient_of_restitution(frame, foot=foot) == pytest.approx(mechanism.impact(side, 1.0), rel=1e-12)


@pytest.mark.verifies("negative control")
def test_the_formula_of_one_body():
    """Negative control: Housner's formula for one body of equal mass, centre and inertia is another coefficient."""
    frame = rk.Frame([COLUMN] * 2, 6000.0)
    side = frame.side("right")
    single = 1.0 - 2.0 * side.mass * side.half_width**2 / side.moment_of_inertia
    assert abs(single - rk.coefficient_of_restitution(frame)) > 0.005


@pytest.mark.parametrize("support", ["corner", "hinge"])
@pytest.mark.parametrize("engine", ["reference", "fast"])
@pytest.mark.verifies("computed anew", "Lagrange's equation of all columns and the beam", within="1e-7")
def test_a_spring_at_one_column(support, engine):
    """The elongation of a restraint is that of the column; its moment acts on the frame. Energy closes."""
    ground, point, stiffness = (1.4, 0.0), (1.0, 3.0), 4e4
    columns, beam = [SKEW, SKEW], 9000.0
    mechanism = Mechanism(columns, beam, support, (np.array(ground), np.array(point), stiffness))
    expected = free_motion(mechanism, 0.1, 3)
    tied = rk.Restrained(
        rk.Frame(columns, beam, beam_on=support), rk.Spring(ground=ground, point=point, stiffness=stiffness)
    )
    response = rk.free_rocking(tied, 0.1, gravity=G, duration=expected[-1][0] + 0.1, engine=engine)
    impacts = [[i["time"], i["velocity_before"], i["velocity_after"]] for i in response.impacts[:3]]
    assert np.allclose(impacts, expected, rtol=1e-7, atol=0.0)
    assert response.energy_closure < 1e-12
    alone = rk.free_rocking(tied.body, 0.1, gravity=G)
    assert abs(alone.impacts["time"][0] - expected[0][0]) > 1e-3  # the spring matters


@pytest.mark.verifies("invariant", "energy", within="1e-10")
def test_energy_closes_under_a_pulse():
    """Work of the ground = kinetic and potential energy and losses, without and with a restraint of no force."""
    frame = rk.Frame([SKEW, HEAVY], 9000.0)
    tied = rk.Restrained(frame, rk.Spring(ground=(-2.0, 2.0), point=(0.2, 2.0), stiffness=0.0))
    pulse, options = rk.pulses.sine(5.0, 0.9), {"gravity": G, "duration": 4.0}
    with_restraint, alone = rk.simulate(tied, pulse, **options), rk.simulate(frame, pulse, **options)
    assert with_restraint.energy_closure < 1e-10
    count = min(with_restraint.rotation.size, alone.rotation.size)
    assert np.abs(with_restraint.rotation[:count] - alone.rotation[:count]).max() < 1e-12
    assert alone.peak_rotation > 0.02


@pytest.mark.verifies("behaviour")
def test_columns_that_would_tilt_the_beam_are_refused():
    """Columns of another height, width or shape are refused."""
    for other in (
        rk.Block(width=1.0, height=4.01, mass=1.0), rk.Block(width=1.2, height=4.0, mass=1.0),
        rk.Section.from_points([(0, 0), (1, 0), (1.1, 4.0), (0.1, 4.0)], 2000.0),
    ):  # fmt: skip
        with pytest.raises(GeometryError, match="column 2 must have the height, the base and the top of column 1"):
            rk.Frame([COLUMN, other], 100.0)


@pytest.mark.parametrize("model", ["ked", "contact-bed", "plastic-winkler", "shifted-impulse:k=0.5"])
@pytest.mark.verifies("behaviour")
def test_models_of_single_bodies_are_refused(model):
    """A restitution model of single bodies is refused for a frame."""
    frame = rk.Frame([COLUMN] * 2, 1000.0)
    with pytest.raises(InvalidValueError, match="applies to single bodies; for a frame use housner"):
        rk.simulate(frame, rk.pulses.sine(4.0, 1.0), restitution=model)
    assert rk.simulate(frame, rk.pulses.sine(4.0, 1.0), restitution=0.9).parameters.right.coefficient == 0.9
