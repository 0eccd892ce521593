"""Steady rocking under harmonic motion: periodic orbits in closed form, and how neighbouring histories separate.

With x = theta / alpha and tau = p t the linear equations are x'' = x - sgn x + A sin(W tau + psi). Symmetric orbits
with one impact per half period (Spanos & Koh 1984, J. Eng. Mech. 110:1627; Hogan 1989, Proc. R. Soc. A 425:441) follow
from a quadratic in the velocity v after the impact; REF numbers: see CONTRIBUTING.md.

Areas: the flow of both sets of equations keeps dtheta dtheta', and an impact multiplies it by r^2, so the map of states
over any time has the determinant r^(2 n), n impacts. From impact to impact the same holds for the variables t and
theta'^2 / 2. That is exact, for any motion of the ground, and sees every error of an impact's time or velocity.
"""

import math

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import minimize_scalar

import rocking as rk
from rocking import conventions
from rocking.dynamics import ConstantRestitution, PlaneSettings, RockingParameters, RockingSide
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.plane.fast_engine import run

pytestmark = pytest.mark.verifies(room="rocking in the plane")

ENGINES = ("fast", "reference")
ALPHA, P = 0.22, 2.3
ORBITS = {  # A, W, r: v, psi, and the largest x on a grid of 200 intervals, which is what is known
    (1.2, 3.0, 0.9): (0.790917702767388788, 2.964739583815217, 0.24127183716905),
    (2.0, 4.0, 0.9): (0.795424033581792961, 3.000765317364408, 0.18903728384261),
    (2.0, 5.0, 0.85): (0.624486486704868229, 2.921913011680982, 0.12264095421697),
}
UNSTABLE = (1.2, 3.0, 0.9), 0.114242245622713762, 15.738771


def symmetric_orbits(amplitude, w, r):
    """All (v, psi) of symmetric orbits, from the quadratic."""
    g, c, s = amplitude / (1.0 + w**2), math.cosh(math.pi / w), math.sinh(math.pi / w)
    matrix = np.array([[1.0 + c, s], [s, 1.0 + c]])
    one = np.linalg.solve(matrix, [c - 1.0, s])
    per_v = np.linalg.solve(matrix, [-s, -c - 1.0 / r])
    weight = np.array([1.0, 1.0 / w**2])
    roots = np.roots([weight @ per_v**2, 2.0 * weight @ (one * per_v), weight @ one**2 - g**2])
    found = []
    for v in sorted(roots.real):
        x, y = one + per_v * v
        found.append((v, math.atan2(x, y / w) % (2.0 * math.pi)))
    return found


def shaken(amplitude, w, psi, cycles):
    """Ground whose sine at time zero has the phase psi, in units of the equation above."""
    period = 2.0 * math.pi / (w * P)
    return rk.pulses.harmonic(amplitude * conventions.g * ALPHA, period, cycles, psi + math.pi).segments()


def parameters_of(r, left=None):
    right = RockingSide(ALPHA, P, 1.0, r)
    return RockingParameters(right, left or right, ConstantRestitution(), "")


def history(case, psi, x, v, cycles, engine, *, linear=True, left=None):
    amplitude, w, r = case
    segments = shaken(amplitude, w, psi, cycles)
    settings = PlaneSettings(linear=linear, rest_speed=1e-9)
    state = {"rotation": x * ALPHA, "velocity": v * P * ALPHA}
    return run(parameters_of(r, left), segments, settings, engine=engine, **state)


def impacts_of(found):
    return [e for e in found.events if e.kind is EventKind.IMPACT]


def half_return(case, psi, v, engine, **options):
    """Phase and velocity after the next impact, mirrored."""
    impact = impacts_of(history(case, psi, 0.0, v, 1.5, engine, **options))[0]
    return np.array([psi + case[1] * P * impact.time - math.pi, abs(impact.after) / (P * ALPHA)])


def jacobian(function, at, step):
    """Central differences of fourth order."""
    columns = []
    for k in range(2):
        d = np.zeros(2)
        d[k] = step
        near = function(*(at + d)) - function(*(at - d))
        far = function(*(at + 2.0 * d)) - function(*(at - 2.0 * d))
        columns.append((8.0 * near - far) / (12.0 * step))
    return np.array(columns).T


def orbit(case, tau):
    """Rotation over alpha of a symmetric orbit, tau after an impact, in closed form."""
    (amplitude, w, _), (v, psi, _) = case, ORBITS[case]
    g = amplitude / (1.0 + w**2)
    x = 1.0 - g * np.sin(w * tau + psi) + (g * math.sin(psi) - 1.0) * np.cosh(tau)
    return x + (v + g * w * math.cos(psi)) * np.sinh(tau)


def turn(case, psi, v, engine):
    """Largest rotation before the next impact, between fine samples."""
    segments = shaken(case[0], case[1], psi, 0.5).refined(16)
    found = run(parameters_of(case[2]), segments, PlaneSettings(linear=True), engine=engine, velocity=v * P * ALPHA)
    time = np.arange(found.rotation.size) * segments.step
    curve = CubicHermiteSpline(time, found.rotation / ALPHA, found.angular_velocity / ALPHA)
    turns = curve.derivative().roots(extrapolate=False)
    return curve(turns[np.isfinite(turns)]).max()


@pytest.mark.verifies(
    "closed form",
    "the quadratic of symmetric orbits (Spanos and Koh 1984, Hogan 1989), solved here, and its roots to 15 digits",
    within="1e-13",
)
@pytest.mark.parametrize("case", ORBITS)
def test_the_quadratic_gives_the_known_orbits(case):
    """REF: velocity and phase of the three orbits, and of the unstable partner of the first."""
    v, psi, _ = ORBITS[case]
    slow, quick = symmetric_orbits(*case)
    assert quick == (pytest.approx(v, rel=1e-13, abs=0.0), pytest.approx(psi, rel=1e-13, abs=0.0))
    if case == UNSTABLE[0]:
        assert slow[0] == pytest.approx(UNSTABLE[1], rel=1e-13, abs=0.0)


@pytest.mark.slow
@pytest.mark.verifies("closed form", "symmetric orbits in closed form", within="1e-9", control="within")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("case", ORBITS)
def test_long_harmonic_motion_ends_in_the_orbit(case, engine):
    """REF: from a disturbed start, velocity, phase and largest rotation converge to those of the orbit."""
    v, psi, published = ORBITS[case]
    grid = orbit(case, np.linspace(0.0, math.pi / case[1], 201)).max()
    assert grid == pytest.approx(published, rel=1e-13, abs=0.0)
    largest = -minimize_scalar(
        lambda tau: -orbit(case, tau), bounds=(0.0, math.pi / case[1]), options={"xatol": 1e-9}
    ).fun
    half_cycles = 170  # r^170 = 2e-8, times the disturbance
    found = impacts_of(history(case, psi, 0.0, v * 1.002, 0.5 * half_cycles, engine))
    assert len(found) >= half_cycles - 1
    last = found[-8:]
    phases = np.array([psi + case[1] * P * e.time for e in last])
    velocities = np.array([e.after for e in last]) / (P * ALPHA)
    folded = (phases - psi + 0.5 * math.pi) % math.pi - 0.5 * math.pi
    np.testing.assert_allclose(np.abs(velocities), v, rtol=1e-9)
    np.testing.assert_allclose(folded, 0.0, rtol=0.0, atol=1e-9)
    assert (np.diff(np.sign(velocities)) != 0.0).all()
    assert turn(case, psi + folded[-1], abs(velocities[-1]), engine) == pytest.approx(largest, rel=1e-9, abs=0.0)
    assert abs(found[0].after) / (P * ALPHA) != pytest.approx(v, rel=1e-5)  # negative control: it was disturbed


@pytest.mark.verifies("closed form", "eigenvalues of modulus r", within="1e-8")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("case", ORBITS)
def test_stable_orbits_are_foci(case, engine):
    """Both eigenvalues of the half return have the absolute value r, since their product is r^2."""
    v, psi, _ = ORBITS[case]
    matrix = jacobian(lambda a, b: half_return(case, a, b, engine), np.array([psi, v]), 1e-3)
    assert np.linalg.det(matrix) == pytest.approx(case[2] ** 2, rel=1e-8)
    values = np.linalg.eigvals(matrix)
    assert (values.imag != 0.0).all()
    np.testing.assert_allclose(np.abs(values), case[2], rtol=1e-8)


@pytest.mark.verifies("closed form", "the slower orbit, and its eigenvalue to 8 digits", within="1e-7")
@pytest.mark.parametrize("engine", ENGINES)
def test_the_unstable_partner(engine):
    """REF: the slower orbit is a saddle whose larger eigenvalue has the size 15.738771."""
    case, v, published = UNSTABLE
    psi = symmetric_orbits(*case)[0][1]
    np.testing.assert_allclose(half_return(case, psi, v, engine), [psi, v], rtol=1e-9)
    matrix = jacobian(lambda a, b: half_return(case, a, b, engine), np.array([psi, v]), 4e-5)
    sizes = np.sort(np.abs(np.linalg.eigvals(matrix)))
    assert sizes[1] == pytest.approx(published, rel=1e-7)
    assert sizes[0] * sizes[1] == pytest.approx(case[2] ** 2, rel=1e-6)


def energies(case, psi, v, engine, count, **options):
    """Phase and half the square of the velocity after some impacts."""
    impact = impacts_of(history(case, psi, 0.0, v, 3.0, engine, **options))[count - 1]
    return np.array([psi + case[1] * P * impact.time, 0.5 * (impact.after / (P * ALPHA)) ** 2])


@pytest.mark.slow
@pytest.mark.verifies(
    "invariant", "area in time and energy, shrunk by r^2 at each impact", within="1e-7", control="within"
)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("linear", [True, False])
def test_area_from_impact_to_impact(linear, engine):
    """In t and theta'^2 / 2 an impact shrinks areas by r^2, anywhere, with either side's r, p and alpha."""
    left = RockingSide(0.6 * ALPHA, 1.2 * P, 1.1, 0.8)
    for case, psi, v in (((1.2, 3.0, 0.9), 2.7, 0.7), ((2.0, 4.0, 0.9), 3.1, 0.6), ((1.5, 3.5, 0.95), 2.5, 0.5)):
        for count, expected in ((1, 0.8**2), (2, (0.8 * case[2]) ** 2)):

            def after(a, e, case=case, count=count):
                return energies(case, a, math.sqrt(2.0 * e), engine, count, linear=linear, left=left)

            matrix = jacobian(after, np.array([psi, 0.5 * v * v]), 5e-4)
            assert np.linalg.det(matrix) == pytest.approx(expected, rel=1e-7)
            assert np.linalg.det(matrix) != pytest.approx(math.sqrt(expected), rel=1e-2)  # negative control


def over_time(case, psi, x, v, cycles, engine, linear):
    found = history(case, psi, x, v, cycles, engine, linear=linear)
    return np.array([found.rotation[-1] / ALPHA, found.angular_velocity[-1] / (P * ALPHA)])


@pytest.mark.verifies("invariant", "area of states, shrunk by r^2 at each impact", within="1e-7")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("linear", [True, False])
@pytest.mark.parametrize("case", ORBITS)
def test_area_over_a_period(case, linear, engine):
    """The map of states over a period and a half, three impacts, has the determinant r^6; exact equations too."""
    at = np.array([0.04, 0.7])  # in flight, off the orbit
    psi = ORBITS[case][1] + 0.2
    count = len(impacts_of(history(case, psi, *at, 1.5, engine, linear=linear)))
    assert count == 3
    matrix = jacobian(lambda x, v: over_time(case, psi, x, v, 1.5, engine, linear), at, 2e-4)
    assert np.linalg.det(matrix) == pytest.approx(case[2] ** (2 * count), rel=1e-7)


@pytest.mark.verifies("invariant", "the motion run backwards", within="1e-8")
@pytest.mark.parametrize("engine", ENGINES)
def test_time_runs_back(engine):
    """With r = 1 the ground motion run backwards brings a block back to where it was, over several impacts."""
    case, psi, cycles = (1.2, 3.0, 1.0), 2.9, 2.0
    for linear in (True, False):
        there = history(case, psi, 0.05, 0.6, cycles, engine, linear=linear)
        assert len(impacts_of(there)) >= 3
        x, v = there.rotation[-1] / ALPHA, there.angular_velocity[-1] / (P * ALPHA)
        # sin(psi + W (T - t)) = sin(pi - psi - W T + W t)
        back = history(case, math.pi - psi - 2.0 * math.pi * cycles, x, -v, cycles, engine, linear=linear)
        assert back.rotation[-1] / ALPHA == pytest.approx(0.05, abs=1e-8)
        assert -back.angular_velocity[-1] / (P * ALPHA) == pytest.approx(0.6, rel=1e-8)
