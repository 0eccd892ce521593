"""Overturning by pulses: boundaries found by bisection on the amplitude against closed forms and published numbers."""

import math

import mpmath as mp
import numpy as np
import pytest
from pulse_boundaries import (
    COSINE,
    HALF_SINE,
    LOWER_AT_ONE,
    RECTANGLE,
    SINE_NO_IMPACT,
    SINE_ONE_IMPACT,
    SINE_ONE_IMPACT_ELASTIC,
    mode_two,
)  # fmt: skip
from scipy.optimize import brentq

import rocking as rk
from rocking import conventions
from rocking.dynamics import PlaneSettings
from rocking.dynamics.batch import Batch
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.rows import Rows

pytestmark = pytest.mark.verifies(room="rocking in the plane")

ENGINES = ("fast", "reference")
ALPHA, P = 0.15, 1.7
LINEAR = {
    **{f"rectangle {k}": (("rectangle", k), 0.9, v, 0) for k, v in RECTANGLE.items()},
    **{f"half sine {k}": (("half_sine", k), 0.9, v, 0) for k, v in HALF_SINE.items()},
    **{f"sine, no impact {k}": (("sine", k), 0.9, v, 0) for k, v in SINE_NO_IMPACT.items() if k != 1},
    "sine, no impact 1": (("sine", 1), 0.0, SINE_NO_IMPACT[1], 0),  # with r = 0.9 mode I covers it
    **{f"sine, lower {k}": (("sine", k), 0.9, v[0], 1) for k, v in SINE_ONE_IMPACT.items()},
    "sine, lower 1": (("sine", 1), 0.9, LOWER_AT_ONE, 1),
    **{f"sine, upper {k}": (("sine", k), 0.9, v[1], 1) for k, v in SINE_ONE_IMPACT.items()},
    **{f"sine, elastic {k}": (("sine", k), 1.0, v, 1) for k, v in SINE_ONE_IMPACT_ELASTIC.items()},
    **{f"cosine {k}": (("cosine", k), 0.9, v, 0) for k, v in COSINE.items()},
}


def unit_pulse(shape, number):
    """Pulse of one g; `number` is Omega, or p times the duration of a rectangle."""
    if shape == "rectangle":
        return rk.pulses.rectangular(conventions.g, number / P)
    made = {"half_sine": rk.pulses.half_sine, "sine": rk.pulses.sine, "cosine": rk.pulses.cosine}[shape]
    return made(conventions.g, 2.0 * math.pi / (number * P))


def outcomes(pulse, scales, r, engine, *, alpha=ALPHA, linear=True, after=0.0):
    """Results at several factors on a pulse; the energy at its end decides, or that some time after it."""
    segments = pulse.segments()
    segments = segments.extended(segments.duration + after / P)
    count = len(scales)
    rows = Rows.of(
        count, alpha_right=alpha, alpha_left=alpha, p_right=P, p_left=P, r_right=r, r_left=r, scale=np.asarray(scales)
    )
    found, _ = Batch([segments], settings=PlaneSettings(linear=linear), threads=1, engine=engine).run(
        count, lambda a, b: rows
    )
    return found


def boundary(pulse, unit, guess, r, engine, *, width=0.01, **body):
    """Amplitude at which the outcome changes, within 1 % of a guess, and the impacts of those that overturn there."""
    low, high = guess * (1.0 - width), guess * (1.0 + width)
    parts = 64 if engine == "fast" else 2  # cut the bracket again and again
    while high - low > 4.0 * math.ulp(high):
        grid = np.linspace(low, high, parts + 1)
        found = outcomes(pulse, grid * unit, r, engine, **body)
        over = found["outcome"] == rk.Outcome.OVERTURNED.code
        assert (found["status"] == 0).all()
        assert over[0] != over[-1]
        k = int(np.flatnonzero(over != over[0])[0])
        low, high = grid[k - 1], grid[k]
    near = outcomes(pulse, np.array([low * (1.0 - 1e-9), high * (1.0 + 1e-9)]) * unit, r, engine, **body)
    over = near["outcome"] == rk.Outcome.OVERTURNED.code
    return 0.5 * (low + high), near["impacts"][over].tolist()


@pytest.mark.slow
@pytest.mark.verifies(
    "closed form",
    "the roots of the boundary's equation to 17 digits (modes of Zhang and Makris 2001 for sines)",
    within="1e-10",
    control="test_the_reported_formula_is_unconservative",
)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("case", LINEAR)
def test_linear_boundaries(case, engine, agreement):
    """REF: every boundary of the linear equations, and by how many impacts the block overturns there."""
    pulse, r, expected, impacts = LINEAR[case]
    found, seen = boundary(unit_pulse(*pulse), ALPHA, expected, r, engine)
    agreement(abs(found / expected - 1.0), 1e-10)
    assert seen == [impacts]


@pytest.mark.verifies("invariant", "25 / p of integration after the pulse", within="1e-10 off the boundary")
@pytest.mark.parametrize("engine", ENGINES)
def test_following_the_body_afterwards_changes_nothing(engine):
    """What energy says at the end of the pulse is what 25 / p of integration after it say, 1e-10 off the boundary."""
    for case in ("sine, lower 3", "sine, upper 3", "sine, no impact 3"):
        pulse, r, expected, _ = LINEAR[case]
        scales = ALPHA * expected * np.array([1.0 - 1e-10, 1.0 + 1e-10])
        found = outcomes(unit_pulse(*pulse), scales, r, engine, after=25.0)
        over = (found["outcome"] == rk.Outcome.OVERTURNED.code).tolist()
        assert over == ([True, False] if "upper" in case else [False, True])


@pytest.mark.verifies(
    "closed form",
    "the root of the boundary's equation, by brentq",
    within="1e-10",
    control="test_the_reported_formula_is_unconservative",
)
@pytest.mark.parametrize("omega", np.geomspace(0.4, 15.0, 12).tolist())
def test_half_sines_of_any_length(omega, agreement):
    """The transcendental equation of the half sine, solved here, for frequencies between and beyond the REF ones."""

    def open_terms(psi):
        return math.cos(psi) + math.exp(-(math.pi - psi) / omega) - omega * math.sin(psi)

    expected = 1.0 / math.sin(brentq(open_terms, 1e-9, 0.5 * math.pi, xtol=1e-16))
    found, _ = boundary(unit_pulse("half_sine", omega), ALPHA, expected, 0.9, "fast")
    agreement(abs(found / expected - 1.0), 1e-10)


@pytest.mark.verifies("negative control", "Housner's sqrt(1 + Omega^2) for half sines", doi="10.1785/BSSA0530020403")
def test_the_reported_formula_is_unconservative():
    """Negative control: below Housner's sqrt(1 + Omega^2) for half sines the block has long overturned."""
    for omega, exact in HALF_SINE.items():
        reported = math.sqrt(1.0 + omega**2)
        assert reported > 1.06 * exact
        for engine in ENGINES:
            found = outcomes(unit_pulse("half_sine", omega), [0.99 * reported * ALPHA] * 2, 0.9, engine)
            assert (found["outcome"] == rk.Outcome.OVERTURNED.code).all()


def critical_duration(tangent, ratio):
    """Time p t of a constant acceleration after which the energy suffices, by 30-digit quadrature."""
    with mp.workdps(30):
        alpha, push = mp.atan(tangent), mp.mpf(ratio) * tangent
        last = alpha - mp.asin(mp.sin(alpha) - (1 - mp.cos(alpha)) / push)

        def integrand(x):  # theta = last x^2 takes away the root at uplift
            half = last * x * x / 2
            lift = push * mp.cos(alpha - half) - mp.sin(alpha - half)
            shape = mp.sqrt(2 * last / 2) if not x else x * last / mp.sqrt(mp.sin(half))
            return shape / mp.sqrt(lift)

        return float(mp.quad(integrand, [0, 0.5, 1]))


@pytest.mark.verifies("computed anew", "30-digit quadrature of the energy integral", within="1e-10", control="within")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("tangent", "ratio", "p_time"),
    [(0.25, 2.0, 0.694657418494709748), (0.25, 1.5, 1.098716268683918183), (0.5, 2.0, 0.698078662751420487)],
)
def test_nonlinear_rectangles(tangent, ratio, p_time, engine, agreement):
    """REF: a rectangle of this duration overturns at a / (g tan alpha) = ratio, by the exact equations."""
    assert critical_duration(tangent, ratio) == pytest.approx(p_time, rel=1e-15, abs=0.0)
    alpha, pulse = math.atan(tangent), unit_pulse("rectangle", p_time)
    found, impacts = boundary(pulse, tangent, ratio, 0.9, engine, alpha=alpha, linear=False)
    agreement(abs(found / ratio - 1.0), 1e-10)
    assert impacts == [0]
    linear, _ = boundary(pulse, tangent, ratio, 0.9, engine, alpha=alpha, linear=True, width=0.2)
    assert abs(linear / ratio - 1.0) > 1e-3  # negative control


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew", "boundaries to 17 and 8 digits", within="1e-10, and 3e-8 where fewer digits are known"
)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("expected", "impacts", "digits"),
    [(1.43078991141167367, 1, 1e-10), (3.4697991, 1, 3e-8), (3.6856831, 0, 3e-8)],  # as many as are known
)
def test_nonlinear_sine(expected, impacts, digits, engine):
    """REF: the three boundaries of a full sine, Omega = 3, tan alpha = 1/3, r = 0.85."""
    tangent = 1.0 / 3.0
    found, seen = boundary(
        unit_pulse("sine", 3), tangent, expected, 0.85, engine, alpha=math.atan(tangent), linear=False
    )
    print(f"\nsine, {engine}: {found:.14f} {found / expected - 1.0:.1e}")
    assert abs(found / expected - 1.0) < digits
    assert seen == [impacts]


@pytest.mark.verifies("computed anew", "time and velocity to 17 digits", within="1e-11 and 1e-10")
@pytest.mark.parametrize("engine", ENGINES)
def test_first_impact_of_the_nonlinear_sine(engine):
    """Exact equations, REF: time of the first impact of a full sine and velocity before it at A = 1.35."""
    alpha = math.atan(1.0 / 3.0)
    block = rk.Block.from_angle(alpha, 2.0)
    p = block.frequency_parameter
    pulse = rk.pulses.sine(-1.35 * conventions.g / 3.0, 2.0 * math.pi / (3.0 * p))  # lifts to the right
    impacts = rk.simulate(block, pulse, 0.85, engine=engine).impacts
    assert impacts["time"][0] * p == pytest.approx(1.32474339259259755, rel=1e-11, abs=0.0)
    assert impacts["velocity_before"][0] / p == pytest.approx(-0.131689306803626549, rel=1e-10, abs=0.0)


@pytest.mark.verifies("closed form", "modes I and II of Zhang and Makris 2001", within="1e-9 off each boundary")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("omega", [2, 3, 5, 6])
def test_survival_between_the_modes(omega, engine):
    """Stronger is not worse: overturned by mode I, standing above its upper boundary, overturned again by mode II."""
    upper = SINE_ONE_IMPACT[omega][1]
    second = SINE_NO_IMPACT.get(omega) or mode_two(omega)
    lower = SINE_ONE_IMPACT[omega][0]
    scales = ALPHA * np.concatenate(
        [
            np.linspace(1.01, lower * (1.0 - 1e-9), 9),
            np.linspace(lower * (1.0 + 1e-9), upper * (1.0 - 1e-9), 9),
            np.linspace(upper * (1.0 + 1e-9), second * (1.0 - 1e-9), 9),
            np.linspace(second * (1.0 + 1e-9), 2.0 * second, 9),
        ]
    )
    found = outcomes(unit_pulse("sine", omega), scales, 0.9, engine)
    over = (found["outcome"] == rk.Outcome.OVERTURNED.code).reshape(4, 9)
    assert over.all(axis=1).tolist() == [False, True, False, True]
    assert over.any(axis=1).tolist() == [False, True, False, True]
    assert set(found["impacts"].reshape(4, 9)[3].tolist()) == {0}


@pytest.mark.verifies("closed form", "modes I and II of Zhang and Makris 2001", within="1e-9 off the boundary")
def test_modes_without_a_gap():
    """With r = 1 there is no survival between the modes; with r = 0.9 and Omega = 8, 10 there is no mode I."""
    for omega, lower in SINE_ONE_IMPACT_ELASTIC.items():
        second = mode_two(omega)
        scales = ALPHA * np.linspace(lower * (1.0 + 1e-9), 1.5 * second, 2001)
        found = outcomes(unit_pulse("sine", omega), scales, 1.0, "fast")
        assert (found["outcome"] == rk.Outcome.OVERTURNED.code).all()
    for omega in (8, 10):
        scales = ALPHA * np.linspace(1.0, SINE_NO_IMPACT[omega] * (1.0 - 1e-9), 2001)
        found = outcomes(unit_pulse("sine", omega), scales, 0.9, "fast")
        assert (found["outcome"] != rk.Outcome.OVERTURNED.code).all()


def largest_below_mode_two(omega):
    """Largest theta / alpha on the boundary of mode II, from the closed form of the linear equations."""
    amplitude = mode_two(omega)
    psi, gain = math.asin(1.0 / amplitude), 1.0 / (1.0 + omega**2)
    tau = np.linspace(0.0, (2.0 * math.pi - psi) / omega, 200_001)
    x = 1.0 - amplitude * gain * np.sin(omega * tau + psi)
    x += (gain - 1.0) * np.cosh(tau) + amplitude * omega * math.cos(psi) * gain * np.sinh(tau)
    return x.max()


@pytest.mark.verifies("closed form", "the linear equations on the boundary of mode II", within="1e-7")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("omega", "published"), [(2, 1.61), (3, 1.51), (5, 1.39), (10, 1.24)])
def test_beyond_the_top_and_back(omega, published, engine):
    """Just below mode II a block leans past its balance, up to 1.6 alpha, and the reversal of the pulse saves it."""
    scale = ALPHA * mode_two(omega) * (1.0 - 1e-9)
    found = outcomes(unit_pulse("sine", omega), [scale], 0.9, engine)
    reached = abs(found["peak_rotation"][0]) / ALPHA
    assert found["outcome"][0] == rk.Outcome.ROCKED.code
    assert reached == pytest.approx(published, abs=0.006)  # known to three digits
    assert reached == pytest.approx(largest_below_mode_two(omega), abs=1e-7)


@pytest.mark.verifies("closed form", "West's a = g b / h", within="1e-12 below, 1e-9 above")
def test_a_pulse_below_uplift_moves_nothing():
    """At a_p = g tan(alpha) and below, West's condition, nothing happens; just above it the block lifts."""
    block = rk.Block.from_angle(0.3, 1.0)
    for factor, lifted in ((1.0 - 1e-12, 0), (1.0 + 1e-9, 1)):
        pulse = rk.pulses.sine(factor * conventions.g * math.tan(0.3), 1.0)
        for engine in ENGINES:
            events = rk.simulate(block, pulse, 0.9, engine=engine).trajectory.events
            assert bool([e for e in events if e.kind is EventKind.UPLIFT]) == bool(lifted)
