"""The equations of motion, the forces of the ground and the energy ledger against mechanics written down afresh.

The body of these tests is lumped into three masses, so that its centre, its moments of inertia and its feet follow from
sums written here; the equations follow from its Lagrangian by computer algebra, the forces from Newton's law. REF
numbers: see CONTRIBUTING.md.
"""

import math
from dataclasses import replace
from functools import cache

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from scipy.integrate import cumulative_trapezoid, solve_ivp

import rocking as rk
from rocking import conventions
from rocking.dynamics.plane import equations

pytestmark = pytest.mark.verifies(room="rocking in the plane")

ENGINES = ("fast", "reference")
G = conventions.g
POINTS = ((0.0, 0.3), (0.5, 1.1), (0.1, 2.2))
MASSES = (300.0, 120.0, 160.0)
FEET = (-0.2, 0.65)
LEANING = rk.MassPoints(POINTS, MASSES, feet=FEET)
BODY = rk.Block(width=0.6, height=2.4).with_feet(0.06, 0.6)
DEMAND = {1.0: 0.25, 1.5: 0.280575539568, 2.0: 0.30985915493, 5.0: 0.4625}  # A / tan(alpha), slenderness 4


def foot_of(sign):
    return FEET[1] if sign > 0 else FEET[0]


def leaning(sign):
    """Angle alpha, p and R of the leaning body about its right (+1) or left foot."""
    mass = sum(MASSES)
    x, z = (sum(m * at[k] for m, at in zip(MASSES, POINTS, strict=True)) / mass for k in (0, 1))
    foot = foot_of(sign)
    inertia = sum(m * ((px - foot) ** 2 + pz**2) for m, (px, pz) in zip(MASSES, POINTS, strict=True))
    radius = math.hypot(x - foot, z)
    return math.atan2(abs(x - foot), z), math.sqrt(mass * G * radius / inertia), radius


def turned(arm, height, theta, cos, sin):
    """Point of a body relative to its foot, after a clockwise turn by theta."""
    return arm * cos(theta) + height * sin(theta), height * cos(theta) - arm * sin(theta)


ANGLE, PUSH, LIFT = sp.symbols("angle push lift")


def lagrangian(masses, points):
    """theta'' from the Lagrangian of masses that turn about a moving foot, as an expression of ANGLE, PUSH, LIFT."""
    t = sp.Symbol("t")
    theta, x, z = (sp.Function(name)(t) for name in ("theta", "x", "z"))
    total = 0
    for mass, (arm, height) in zip(masses, points, strict=True):
        dx, dz = turned(arm, height, theta, sp.cos, sp.sin)
        total += mass * ((x + dx).diff(t) ** 2 + (z + dz).diff(t) ** 2) / 2 - mass * sp.Float(G, 20) * (z + dz)
    equation = total.diff(theta.diff(t)).diff(t) - total.diff(theta)
    bend = sp.Symbol("bend")
    for derivative, symbol in ((x.diff(t, 2), PUSH), (z.diff(t, 2), LIFT), (theta.diff(t, 2), bend)):
        equation = equation.subs(derivative, symbol)
    equation = sp.expand(equation.doit()).subs(theta, ANGLE)
    return -equation.coeff(bend, 0) / sp.simplify(equation.coeff(bend, 1))


@cache
def exact(sign):
    relative = [(px - foot_of(sign), pz) for px, pz in POINTS]
    found = sp.simplify(lagrangian(MASSES, relative))
    assert found.free_symbols == {ANGLE, PUSH, LIFT}  # the speed drops out
    return sp.lambdify((ANGLE, PUSH, LIFT), found)


@cache
def slender(sign):
    """First order in theta, alpha and a_x of the Lagrangian equation of a single mass at height one, p^2 = g."""
    eps, alpha = sp.symbols("epsilon alpha")
    found = lagrangian([1], [(-sign * sp.tan(eps * alpha), 1)])
    found = found.subs({ANGLE: eps * ANGLE, PUSH: eps * PUSH})
    return sp.lambdify((ANGLE, PUSH, LIFT, alpha), sp.simplify(found.diff(eps).subs(eps, 0)))


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew", "Lagrange's equations of three masses, by SymPy", within="1e-12", control="within"
)
@pytest.mark.parametrize("sign", [1, -1])
def test_angular_acceleration_of_an_asymmetric_body(sign):
    """The exact equations are those of Lagrange for a leaning body on ground that moves both ways."""
    alpha, p, radius = leaning(sign)
    side = LEANING.side("right" if sign > 0 else "left", G)
    assert (side.slenderness_angle, side.frequency_parameter, side.semi_diagonal) == (
        pytest.approx(alpha, rel=1e-14, abs=0.0),
        pytest.approx(p, rel=1e-14, abs=0.0),
        pytest.approx(radius, rel=1e-14, abs=0.0),
    )
    rng = np.random.default_rng(3)
    theta, push, lift = sign * rng.uniform(0.0, 1.4, 200), rng.uniform(-20, 20, 200), rng.uniform(-15, 15, 200)
    found = equations.angular_acceleration(theta, sign, alpha, p, push / G, 1.0 + lift / G)
    np.testing.assert_allclose(found, exact(sign)(theta, push, lift), rtol=1e-12, atol=1e-12 * p**2)
    wrong = equations.angular_acceleration(theta, -sign, alpha, p, push / G, 1.0 + lift / G)
    assert not np.allclose(wrong, exact(sign)(theta, push, lift), rtol=1e-3)  # negative control


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "the first order of Lagrange's equations, by SymPy", within="1e-12")
@pytest.mark.parametrize("sign", [1, -1])
def test_angular_acceleration_of_a_slender_body(sign):
    """The linear equations are the first order of those of Lagrange in theta, alpha and a_x."""
    rng = np.random.default_rng(4)
    theta, push, lift = rng.uniform(-1, 1, 200), rng.uniform(-20, 20, 200), rng.uniform(-15, 15, 200)
    found = equations.angular_acceleration(theta, sign, 0.2, 1.7, push / G, 1.0 + lift / G, linear=True)
    expected = slender(sign)(theta, push, lift, 0.2) * 1.7**2 / G
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


@pytest.mark.verifies("computed anew", "central differences with 50 digits of the path of the centre", within="1e-13")
@pytest.mark.parametrize("sign", [1, -1])
def test_reactions_obey_newton(sign):
    """Forces per mass are acceleration of the centre, by 50-digit central differences, less gravity."""
    alpha, _, radius = leaning(sign)
    rng = np.random.default_rng(5)
    with mp.workdps(50):
        h = mp.mpf("1e-15")
        for _ in range(20):
            c = [mp.mpf(float(v)) for v in rng.uniform(-1.0, 1.0, 8)]

            def theta(t, c=c):
                return sign * (mp.mpf("0.5") + c[0] * t + c[1] * t**2) + c[2] * t**3

            def centre(t, c=c, theta=theta):
                arm, height = -sign * radius * mp.sin(alpha), radius * mp.cos(alpha)
                x, z = turned(arm, height, theta(t), mp.cos, mp.sin)
                return mp.matrix([x + c[3] * t + 9 * c[4] * t**2, z + c[5] * t + 9 * c[6] * t**2])

            force = (centre(h) - 2 * centre(mp.mpf(0)) + centre(-h)) / h**2 + mp.matrix([0, G])
            rate, bend = sign * c[0], 2 * sign * c[1]
            found = equations.reactions(
                float(theta(mp.mpf(0))), float(rate), float(bend), sign, alpha, radius, float(18 * c[4]),
                G + float(18 * c[6]),
            )  # fmt: skip
            np.testing.assert_allclose(found, [float(f) for f in force], rtol=1e-13, atol=1e-13 * G)


@pytest.mark.verifies("closed form", "friction that uplift takes, 12 digits", within="1e-11")
@pytest.mark.parametrize("ratio", DEMAND)
def test_friction_demand_at_uplift(ratio):
    """REF: friction that a block of slenderness 4 takes when it is lifted, by the equations."""
    alpha = math.atan(0.25)
    bend = equations.angular_acceleration(0.0, -1, alpha, math.sqrt(0.75 * G), ratio / 4.0)  # R = 1
    f_x, f_z = equations.reactions(0.0, 0.0, bend, -1, alpha, 1.0, ratio / 4.0 * G, G)
    assert f_x / f_z == pytest.approx(DEMAND[ratio], rel=1e-11, abs=0.0)


@pytest.mark.verifies(
    "closed form", "friction that uplift takes, 12 digits, and its limit 5/3", within="1e-10; 4e-4 of the limit"
)
@pytest.mark.filterwarnings("ignore:the contact force becomes tensile")  # only the start counts here
@pytest.mark.parametrize("engine", ENGINES)
def test_friction_demand_of_a_response(engine):
    """REF: friction at the first instant of a rectangular pulse; 5 / 3 is the limit of strong ones."""
    block = rk.Block(width=1.0, height=4.0)
    cases = [(0.25 * G * ratio, 0.1, demand) for ratio, demand in DEMAND.items() if ratio > 1.0]
    for push, length, expected in [*cases, (2e5, 1e-3, 5.0 / 3.0)]:
        pulse = rk.pulses.rectangular(push, length)
        contact = rk.simulate(block, pulse, 0.9, engine=engine).contact
        # at 2e5 m/s2 the limit is reached to 1 / 20 000
        assert contact.horizontal[0] / contact.vertical[0] == pytest.approx(
            expected, rel=1e-10 if push < 1e5 else 4e-4, abs=0.0
        )


def record(seed, step=0.01, count=1500, *, vertical=False):
    """Noise through a resonance of 1 Hz with a gentle start and end, of 1 m/s2."""
    rng = np.random.default_rng(seed)
    rows = []
    for _ in range(2 if vertical else 1):
        x, v, row = 0.0, 0.0, np.zeros(count)
        w = 2.0 * np.pi * 1.0
        for k, kick in enumerate(rng.standard_normal(count)):
            row[k] = -0.6 * w * v - w**2 * x
            v += step * (row[k] + 40.0 * kick)
            x += step * v
        row *= np.sin(np.linspace(0.0, np.pi, count))
        rows.append(row / np.abs(row).max())
    return rk.GroundMotion(rows[0], step, vertical=rows[1] if vertical else None)


MOTIONS = {
    "pulse": (rk.pulses.sine(1.0, 0.8), 1.35),
    "long pulse": (rk.pulses.ricker(-1.0, 1.0), 1.5),
    "record": (record(1), 1.35),
    "record with vertical": (record(2, vertical=True), 1.35),
}
"""Motions of 1 m/s2, and how many times the acceleration that lifts a body."""


@pytest.mark.verifies("invariant", "balance of energy", within="1e-10 of the largest energy", control="within")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("body", [BODY, LEANING], ids=["block", "leaning"])
@pytest.mark.parametrize("motion", MOTIONS)
def test_the_ledger_closes(motion, body, linear, engine, agreement):
    """Work of the ground is what the body has and what impacts took, to 1e-10 of the largest energy."""
    ground, strength = MOTIONS[motion]
    scale = strength * body.side("right").uplift_acceleration
    response = rk.simulate(body, ground, 0.85, scale=scale, engine=engine, linear=linear)
    energy = response.energy
    print(f"\n{motion}, {engine}: closure {energy.closure:.1e}, {response.impacts.size} impacts, {response.summary}")
    assert response.impacts.size >= 2
    agreement(energy.closure, 1e-10)
    assert energy.lost[-1] > 0.01 * (energy.kinetic + energy.potential).max()
    assert np.all(np.diff(energy.lost) >= -1e-9 * energy.lost[-1])
    # negative control: work by the rule of trapezoids from sample to sample does not close
    alpha = np.where(response.rotation < 0.0, response.parameters.left.slenderness_angle, 0.0)
    alpha = np.where(response.rotation > 0.0, response.parameters.right.slenderness_angle, alpha)
    cosine = np.ones_like(alpha) if linear else np.cos(alpha - np.abs(response.rotation))
    radius = body.side("right").semi_diagonal
    power = -body.mass * radius * response.ground_acceleration * cosine * response.angular_velocity
    wrong = cumulative_trapezoid(power, response.time, initial=0.0)
    assert replace(energy, work=wrong).closure > 1e-6
    assert replace(energy, work=0.999 * energy.work).closure > 1e-5


def independent(push, length, duration, r):
    """State, work and losses of the leaning body after a rectangular pulse, by a general-purpose integrator."""
    mass, state, time, lost, sign = sum(MASSES), np.zeros(3), 0.0, 0.0, -1

    def slopes(_, y, sign, a):
        alpha, _, radius = leaning(sign)
        return [y[1], exact(sign)(y[0], a, 0.0), -mass * radius * a * math.cos(alpha - sign * y[0]) * y[1]]

    def landed(_, y, sign, a):
        return sign * y[0]

    landed.terminal, landed.direction = True, -1
    while time < duration:
        span, a = ((time, length), push) if time < length else ((time, duration), 0.0)
        found = solve_ivp(
            slopes, span, state, "DOP853", events=landed, args=(sign, a), rtol=3e-14, atol=1e-15, max_step=0.05
        )
        time, state = float(found.t[-1]), found.y[:, -1].copy()
        if found.status == 1:
            old, new = (mass * G * leaning(k)[2] / leaning(k)[1] ** 2 for k in (sign, -sign))
            lost += 0.5 * (old - new * r**2) * state[1] ** 2
            sign, state[0], state[1] = -sign, 0.0, r * state[1]
    return state, lost


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew", "SciPy's DOP853 on Lagrange's equations", within="1e-10 rad; 1e-9 of the energies"
)
@pytest.mark.parametrize("engine", ENGINES)
def test_energies_by_a_general_purpose_integrator(engine):
    """State, work and losses of a leaning body under a rectangle are those of equations and integrator from outside."""
    response = rk.simulate(LEANING, rk.pulses.rectangular(4.0, 0.45), 0.85, engine=engine, duration=3.0)
    state, lost = independent(4.0, 0.45, response.time[-1], 0.85)
    energy = response.energy
    assert response.impacts.size >= 2
    assert response.outcome is rk.Outcome.ROCKED
    assert response.rotation[-1] == pytest.approx(state[0], abs=1e-10)
    assert response.angular_velocity[-1] == pytest.approx(state[1], abs=1e-9)
    assert energy.work[-1] == pytest.approx(state[2], rel=1e-10, abs=0.0)
    assert energy.lost[-1] == pytest.approx(lost, rel=1e-9, abs=0.0)


@pytest.mark.verifies(
    "computed anew", "differences of the velocity of the centre", within="1e-3 m/s2", control="within"
)
@pytest.mark.parametrize("engine", ENGINES)
def test_forces_of_a_response_obey_newton(engine):
    """Forces at the samples are mass times acceleration of the centre, from differences of its velocity."""
    t = np.arange(0.0, 6.0, 0.005)
    fade = np.cos(t * math.pi / 12.0) ** 2  # no jump at the end
    ground = rk.GroundMotion(5.0 * np.sin(6.0 * t) * fade, 0.005, vertical=3.0 * np.sin(8.0 * t) * fade)
    response = rk.simulate(LEANING, ground, 0.85, engine=engine)
    mass, h = sum(MASSES), response.time[1]
    theta, rate, sign = response.rotation, response.angular_velocity, np.sign(response.rotation)
    alpha, _, radius = np.array([leaning(s if s else 1) for s in sign]).T
    psi = alpha - np.abs(theta)
    velocity = np.array([radius * np.cos(psi), sign * radius * np.sin(psi)]) * rate
    bend = (8.0 * (velocity[:, 3:-1] - velocity[:, 1:-3]) - (velocity[:, 4:] - velocity[:, :-4])) / (12.0 * h)
    vertical = response.scale * response.segments.vertical[:, 0]
    ground = np.array([response.ground_acceleration[2:-2], G + vertical[2 : theta.size - 2]])
    flight = (np.lib.stride_tricks.sliding_window_view(sign, 5) == sign[2:-2, None]).all(axis=1) & (sign[2:-2] != 0.0)
    found = np.array([response.contact.horizontal, response.contact.vertical])[:, 2:-2]
    # straight lines between samples bend the ground's acceleration by h^2 a'', which differences see as a twelfth
    assert flight.sum() > 200
    np.testing.assert_allclose(found[:, flight] / mass, (ground + bend)[:, flight], rtol=0.0, atol=1e-3)
    assert not np.allclose(found[:, flight] / mass, (ground - bend)[:, flight], rtol=0.0, atol=1.0)  # negative control
