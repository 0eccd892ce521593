"""Observed orders of convergence: shorten the longest step and the errors fall as the declared order says.

Errors are those of numbers that a history of several impacts leads up to: the time at which the body passes its top for
good, or else its largest rotation. The oracle is the reference engine at its finest tolerance, which shares neither
series nor zeros with the fast one, and for free rocking by the linear equations the closed form. Steps are long, so
that the errors stay above rounding. Over many random histories the geometric mean of the errors is a
straight line in the step; its slope is the observed order.
"""

import functools

import numpy as np
import pytest
from scipy.optimize import brentq

from rocking import conventions
from rocking.dynamics import ConstantRestitution, PlaneSettings, RockingParameters, RockingSide
from rocking.dynamics.batch import Batch
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.plane.fast_engine import run
from rocking.dynamics.plane.reference import Reference
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError
from rocking.motions import Segments
from rocking.outcome import Outcome

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="rocking in the plane")]

RIGHT, LEFT = RockingSide(0.3, 1.0, 1.0, 0.9), RockingSide(0.24, 0.95, 1.1, 0.92)
# p h where one term of the error rules and rounding does not
STEPS = {4: (1 / 16, 1 / 32, 1 / 64), 6: (1 / 16, 1 / 32, 1 / 64), 8: (1 / 4, 1 / 6, 1 / 8, 1 / 12)}
# For the linear equations rounding comes sooner: of records it is a tenth of the error at p h = 1 / 11, half of it at
# 1 / 14. Longer steps than 1 / 5 show the next term: degree 8 follows exp(h) with the error h^8 / 9! (1 - 0.9 h + ..),
# whose own slope is 7.87 over these steps and 7.76 from 1 / 3 to 1 / 5.
LINEAR_STEPS = (1 / 5, 1 / 6, 1 / 7, 1 / 8, 1 / 9, 1 / 10)
WITHIN = 0.15
# Errors that happen to pass through zero scatter the slopes: of the linear equations, where the next term has taken 0.1
# of what is allowed, the slope of 750 histories is known to 0.03, as resampling them says.
COUNT, COUNT_LINEAR = 150, 750
LENGTH = 10
UNIT = RIGHT.slenderness_angle * conventions.g


def smooth(rng, strength):
    """A growing sine as polynomials of degree 7 on stretches of p h = 1, which are the motion itself here."""
    w, phase, growth = rng.uniform(1.5, 3.0), rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.0, 0.15)
    amplitude = rng.uniform(0.2, 1.0) * strength * UNIT
    return Segments.of_function(lambda t: amplitude * np.exp(growth * t) * np.sin(w * t + phase), float(LENGTH), LENGTH)


def record(rng, strength):
    return Segments.between_samples(1.0, strength * UNIT * rng.uniform(-1.2, 1.2, LENGTH + 1))


def record_with_vertical(rng, strength):
    horizontal = strength * UNIT * rng.uniform(-1.2, 1.2, LENGTH + 1)
    return Segments.between_samples(1.0, horizontal, 0.2 * conventions.g * rng.uniform(-1.0, 1.0, LENGTH + 1))


def strongest(motion):
    """Bound on the acceleration over g; where it passes 2 the engine takes shorter steps than the longest."""
    rows = motion.horizontal
    return max(x[:, 0].max() + np.maximum(x[:, 1:], 0.0).sum(axis=1).max() for x in (rows, -rows)) / conventions.g


class Histories:
    """Random histories whose result comes after a number of impacts, and their results by the oracle."""

    def __init__(self, kind, impacts, count, *, linear=False):
        rng = np.random.default_rng(7)
        self.linear, self.motions, self.velocity, self.true, self.over, self.impacts = linear, [], [], [], [], []
        strength = 1.0 if impacts else 4.0
        while len(self.true) < count:
            motion, velocity = kind(rng, strength), 0.3 * rng.uniform(0.3, 1.0)
            if strongest(motion) > 2.0:
                continue
            parameters = RockingParameters(RIGHT, LEFT, ConstantRestitution(), "")
            settings = PlaneSettings(linear=linear, tolerance=1e-16)
            # shorter stretches, so that the oracle takes steps of at most p h = 1/4
            found = Reference(parameters, motion.refined(4), settings, to_the_ground=False).run(0.0, velocity)
            over = found.outcome is Outcome.OVERTURNED
            at = found.overturning_time if over else found.peak_time
            before = sum(e.kind is EventKind.IMPACT and e.time < at for e in found.events)
            if impacts <= before <= impacts + 3 and found.impacts <= 12 and at < 0.999 * LENGTH:
                self.motions.append(motion)
                self.velocity.append(velocity)
                self.true.append(at if over else found.peak_rotation)
                self.over.append(over)
                self.impacts.append(found.impacts)

    def errors(self, order, step):
        """Errors of the histories; one that ends otherwise counts as an error of one."""
        count = len(self.true)
        rows = Rows.of(
            count, motion=np.arange(count), velocity=np.array(self.velocity),
            alpha_right=RIGHT.slenderness_angle, alpha_left=LEFT.slenderness_angle, p_right=RIGHT.frequency_parameter,
            p_left=LEFT.frequency_parameter, r_right=RIGHT.coefficient, r_left=LEFT.coefficient,
        )  # fmt: skip
        settings = PlaneSettings(order=order, longest_step=step, linear=self.linear)
        batch = Batch(self.motions, settings=settings, threads=1, engine="fast")
        found, _ = batch.run(count, lambda a, b: rows)
        over = found["outcome"] == Outcome.OVERTURNED.code
        same = (over == self.over) & (found["impacts"] == self.impacts)
        errors = np.abs(np.where(over, found["overturning_time"], found["peak_rotation"]) - self.true)
        return np.where(same, errors, 1.0)


def slope(steps, errors, floor=1e-15):
    """Order from errors of shape (steps, histories); the smallest are kept above rounding."""
    means = np.log(np.maximum(errors, floor)).mean(axis=1)
    return float(np.polyfit(np.log(steps), means, 1)[0])


@functools.cache
def histories_of(kind, impacts, *, linear=False, count=COUNT):
    return Histories(kind, impacts, count, linear=linear)


@pytest.mark.verifies(
    "order",
    "the reference engine at its finest tolerance",
    within="0.15 of the order",
    control="test_the_orders_are_told_apart",
)
@pytest.mark.parametrize("impacts", [0, 2])
@pytest.mark.parametrize("order", STEPS)
@pytest.mark.parametrize("kind", [smooth, record])
def test_declared_orders(kind, order, impacts, agreement):
    """Orders 4, 6 and 8 are what they say, for pulses and records, in flight and across two to five impacts."""
    histories = histories_of(kind, impacts)
    errors = np.array([histories.errors(order, step) for step in STEPS[order]])
    observed = slope(STEPS[order], errors)
    print(f"\n{kind.__name__}, {impacts} impacts: order {order} is {observed:.3f}, errors {np.median(errors, axis=1)}")
    agreement(abs(observed - order), WITHIN)


@pytest.mark.verifies(
    "order",
    "the reference engine at its finest tolerance",
    within="0.15 of the order",
    control="test_steps_that_rounding_rules_show_no_order",
)
@pytest.mark.parametrize(
    ("kind", "linear"), [(smooth, True), (record_with_vertical, False), (record_with_vertical, True)]
)
def test_order_eight_of_the_other_equations(kind, linear, agreement):
    """Linear equations and vertical motion have the order 8 too, across two to five impacts."""
    histories = histories_of(kind, 2, linear=linear, count=COUNT_LINEAR if linear else COUNT)
    steps = LINEAR_STEPS if linear else STEPS[8]
    observed = slope(steps, np.array([histories.errors(8, step) for step in steps]))
    agreement(abs(observed - 8.0), WITHIN)


@pytest.mark.verifies("negative control", "steps at which rounding rules")
def test_steps_that_rounding_rules_show_no_order():
    """Negative control: with linear equations and shorter steps than those taken here, the slope is not 8."""
    histories, steps = histories_of(record, 2, linear=True), (1 / 13, 1 / 14, 1 / 15, 1 / 16)
    observed = slope(steps, np.array([histories.errors(8, step) for step in steps]))
    assert abs(observed - 8.0) > 1.0


@pytest.mark.verifies("negative control", "the other orders, and a step that is not shortened")
def test_the_orders_are_told_apart():
    """Negative control: no order passes for another, and the step that is shortened is the one that counts."""
    histories = histories_of(smooth, 2)
    for order, steps in STEPS.items():
        observed = slope(steps, np.array([histories.errors(order, step) for step in steps]))
        assert [other for other in STEPS if abs(observed - other) < 0.5] == [order]
    same = np.array([histories.errors(8, 0.25) for _ in STEPS[8]])
    assert abs(slope(STEPS[8], same)) < 1e-9


def true_impacts(speed, count):
    """Times p t of impacts of a block that leaves the ground with speed / (p alpha), linear equations, r = 0.9."""
    return np.cumsum(2.0 * np.arctanh(speed * 0.9 ** np.arange(count)))


SPEEDS = np.linspace(0.7, 0.99, 200)


@pytest.mark.verifies("order", "times of impacts of free rocking in closed form", within="0.15 of the order")
def test_order_against_the_closed_form(agreement):
    """Times of the first five impacts of free rocking converge to the closed form with order 8."""
    side = RockingSide(0.3, 1.0, 1.0, 0.9)
    parameters = RockingParameters(side, side, ConstantRestitution(), "")
    errors = []
    for step in LINEAR_STEPS:
        settings = PlaneSettings(linear=True, longest_step=step)
        found = []
        for speed in SPEEDS:
            still = Segments.still(1.0, 30)
            events = run(parameters, still, settings, engine="fast", velocity=0.3 * speed).events
            times = [e.time for e in events if e.kind is EventKind.IMPACT][:5]
            found.append(np.abs(times - true_impacts(speed, 5)))
        errors.append(np.ravel(found))
    observed = slope(LINEAR_STEPS, np.array(errors))
    print(f"\nfree rocking: order 8 is {observed:.3f}, median errors {np.median(errors, axis=1)}")
    agreement(abs(observed - 8.0), WITHIN)


def classical_step(y, v, h):
    """Step of the classical Runge-Kutta method, order 4, for |x|'' = |x| - 1."""
    k1, l1 = v, y - 1.0
    k2, l2 = v + 0.5 * h * l1, y + 0.5 * h * k1 - 1.0
    k3, l3 = v + 0.5 * h * l2, y + 0.5 * h * k2 - 1.0
    k4, l4 = v + h * l3, y + h * k3 - 1.0
    return y + h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0, v + h * (l1 + 2.0 * l2 + 2.0 * l3 + l4) / 6.0


def third_impact(speed, h, *, polished):
    """Time of the third impact by steps of a method of order 4, the zero by straight lines or to rounding."""
    y, v, t = 0.0, speed, 0.0
    for _ in range(3):
        while True:
            y1, v1 = classical_step(y, v, h)
            if y1 < 0.0:
                break
            y, v, t = y1, v1, t + h
        part = h * y / (y - y1)
        landing = v + (v1 - v) * part / h
        for _ in range(8 if polished else 0):
            below, landing = classical_step(y, v, part)
            part -= below / landing
        y, v, t = 0.0, -0.9 * landing, t + part
    return t


@pytest.mark.verifies("negative control", "a Runge-Kutta method of order 4 whose impacts are found by straight lines")
@pytest.mark.parametrize(("polished", "low", "high"), [(True, 4.0 - WITHIN, 4.0 + WITHIN), (False, 1.0, 2.1)])
def test_events_by_straight_lines_lose_the_order(polished, low, high):
    """Negative control: a method of order 4 keeps it with zeros to rounding and has order 2 with interpolated ones."""
    steps = (0.04, 0.02, 0.01, 0.005)
    errors = [[abs(third_impact(s, h, polished=polished) - true_impacts(s, 3)[-1]) for s in SPEEDS] for h in steps]
    observed = slope(steps, np.array(errors))
    print(f"\nclassical Runge-Kutta, zeros to rounding {polished}: order {observed:.3f}")
    assert low < observed < high


@pytest.mark.verifies("behaviour")
@pytest.mark.parametrize("order", [4, 6])
def test_orders_that_were_not_compiled_are_refused(order):
    """Orders 4 and 6 know neither the linear equations nor vertical motion: one of our errors says so."""
    histories = Histories(record, 0, 1, linear=True)
    with pytest.raises(InvalidValueError):
        histories.errors(order, 0.1)


@pytest.mark.verifies("closed form", "the linear equations under a straight line", within="1e-9")
@pytest.mark.parametrize("engine", ["fast", "reference"])
@pytest.mark.parametrize(("length", "low", "high"), [(1.0, -1.9, 1.7), (0.15, -10.7, 11.3)])
def test_a_peak_between_two_turns_in_a_step_is_seen(length, low, high, engine):
    """A block that comes down, is thrown up and comes down again within a sample has the peak of the closed form."""
    start, down, steep = 0.3, -0.05, (high - low) / length

    def speed(t):  # of x'' = x - 1 - (low + steep t)
        return steep + (start - 1.0 - low) * np.sinh(t) + (down - steep) * np.cosh(t)

    at = brentq(speed, 0.1 * length, length, xtol=1e-15)
    assert speed(0.0) < 0.0 < speed(0.1 * length)
    peak = 1.0 + low + steep * at + (start - 1.0 - low) * np.cosh(at) + (down - steep) * np.sinh(at)
    side = RockingSide(0.2, 1.0, 1.0, 0.3)
    ground = Segments.between_samples(length, 0.2 * conventions.g * np.array([low, high]))
    found = run(
        RockingParameters(side, side, ConstantRestitution(), ""), ground, PlaneSettings(linear=True), engine=engine,
        rotation=0.2 * start, velocity=0.2 * down,
    )  # fmt: skip
    assert peak > start
    assert found.peak_rotation / 0.2 == pytest.approx(peak, rel=1e-9, abs=0.0)
