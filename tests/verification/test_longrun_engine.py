"""The compiled engine of long-run dynamics: the reference engine, derivatives, laws by speed, processors, bad input."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from long_run_systems import ANYTHING, BY_SPEED, LEANING, grid, is_kind, response_by_reference, system_of

import rocking as rk
from rocking import Block, MassPoints
from rocking.dynamics.impact_laws import SpeedRestitution
from rocking.studies.longrun.attractors import diagram, start_states
from rocking.studies.longrun.basins import cells, ends_of
from rocking.studies.longrun.continuation import continue_orbit
from rocking.studies.longrun.exponents import lyapunov_exponents
from rocking.studies.longrun.orbits import find_orbit, symmetric_orbit
from rocking.studies.longrun.system import Harmonic, HarmonicRocking, Numerics, over_impacts, over_periods
from rocking.studies.longrun.thresholds import slender_thresholds

pytest.importorskip("rocking.dynamics._longrun", reason="the compiled engine is missing")
pytestmark = pytest.mark.verifies(room="rocking in the plane")


def by_reference(*start):
    """Return state, tangent and impacts after a start on one foot, by the reference engine in pure Python."""
    response = response_by_reference(*start)
    tangent = response.tangent()
    return tangent.by_start[-1], tangent.by_parameter["amplitude"][-1], response.impacts


@pytest.mark.verifies("second engine", "the reference engine in pure Python and its tangent", within="1e-9")
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("law", [{"left": 0.8, "right": 0.9}, BY_SPEED], ids=["by foot", "by speed"])
def test_reference_engine_gives_the_map_and_its_derivatives(law, linear):
    """Phase, speed, jacobian and derivative by the amplitude over four impacts of a body that is not symmetric."""
    system = HarmonicRocking.of_ratios(LEANING, 1.4, 2.5, restitution=law, linear=linear)
    start, omega, rate = (4.5, 0.7), system.excitation.frequency, system.alpha * system.p
    flight, after = (over_impacts(system, *start, n, parameter="amplitude") for n in (4, 5))
    phase, speed = float(flight.phase[0]), float(flight.speed[0])
    until = 0.5 * (float(after.phase[0]) + phase)  # before the fifth impact
    whole, forced, impacts = by_reference(system, *start, 1.0, (until - start[0]) / omega)
    rest, forced_rest, _ = by_reference(system, phase, speed, 1.0, (until - phase) / omega)
    assert len(impacts) == 4
    assert impacts["time"][3] * omega + start[0] == pytest.approx(phase, rel=1e-11)
    assert abs(impacts["velocity_after"][3]) / rate == pytest.approx(speed, rel=1e-11)

    def states(phase, speed):
        """Return derivatives of rotation and velocity at an impact by phase and speed after the impact."""
        push = system.excitation.amplitude / system.gravity * math.sin(phase)
        alpha, p2 = system.sides[:2]
        pull = alpha + push if linear else math.sin(alpha) + push * math.cos(alpha)
        return np.array([[-speed * rate / omega, 0.0], [p2 * pull / omega, rate]])

    back = np.linalg.inv(rest @ states(phase, speed))
    assert back @ whole @ states(*start) == pytest.approx(flight.jacobian[0], rel=1e-9)
    by_ratio = flight.by_parameter[0] * system.amplitude_ratio
    assert back @ (forced - forced_rest) == pytest.approx(by_ratio, rel=1e-9)
    other = replace(system, restitution=0.9)  # control: another law is another map
    assert abs(over_impacts(other, *start, 4).phase[0] / phase - 1.0) > 1e-3


@pytest.mark.verifies("invariant", "the product of r d(r v)/dv over the impacts", within="1e-10")
@pytest.mark.parametrize("linear", [False, True])
def test_sum_rule_of_all_laws(linear):
    """Both exponents add up to the mean logarithm of the impacts' determinants, by foot and by speed."""
    for law in ({"left": 0.8, "right": 0.9}, BY_SPEED):
        system = HarmonicRocking.of_ratios(LEANING, 1.4, 2.5, restitution=law, linear=linear)
        starts = start_states(system, np.transpose(grid(np.linspace(0.1, 6.2, 6), [0.4, 0.8])))
        result = over_periods(system, starts, settled=60, kept=100, vectors=2, most_impacts=500)
        alive = (result.ending == 0) & (result.rests == 0)
        assert alive.sum() >= 2
        before, is_right = result.hits[alive, :, 2], result.hits[alive, :, 1] > 0.0
        if law is BY_SPEED:
            r = 0.9 * (1.0 - 0.08 * np.abs(before))
            slopes = 0.9 * (1.0 - 0.16 * np.abs(before))
        else:
            r = slopes = np.where(is_right, 0.9, np.where(np.isnan(before), np.nan, 0.8))
        expected = np.nansum(np.log(r * slopes), axis=1)
        assert result.growth[alive].sum(axis=1) == pytest.approx(expected, abs=1e-10 * 100)
        if law is BY_SPEED:  # control: r^2 is wrong
            assert np.abs(expected - 2.0 * np.nansum(np.log(r), axis=1)).min() > 0.01


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the same law in a table with more points; constant laws", within="1e-8")
@pytest.mark.filterwarnings("ignore")
def test_laws_by_speed_in_all_functions():
    """Basins, sections, exponents, diagrams and orbits accept r(v); a flat law is a constant coefficient."""
    flat = SpeedRestitution(at=[0.0, 5.0], factors=[1.0, 1.0], times=0.9)
    fine = SpeedRestitution(at=np.linspace(0.0, 5.0, 21), factors=np.linspace(1.0, 0.6, 21), times=0.9)
    results = []
    for law in (0.9, flat, BY_SPEED, fine):
        system = HarmonicRocking.of_ratios(LEANING, 1.4, 2.5, restitution=law)
        kinds = ends_of(system, *grid(*cells(12, 12, 2.0)))
        starts = start_states(system, [[1.0, 0.7], [4.5, 0.7]])
        systems = [system.changed("amplitude", value) for value in (1.2, 1.4)]
        attractors = diagram(systems, np.stack([starts, starts]), cycles=(100, 130), exponents=True)
        exponents = lyapunov_exponents(system, starts=starts, settled=200, kept=100)
        near = symmetric_orbit(system_of(4, 1.4, 2.5, 0.9))
        orbit = find_orbit(system, near.phase, near.speed, impacts=2)
        fold = continue_orbit(orbit, ANYTHING, increasing=False, stop=is_kind("fold")).first("fold")
        values = (fold.value, orbit.determinant, *exponents.by_orbit.ravel(), *attractors["impacts_per_period"].ravel())
        results.append((kinds.tolist(), values))
    for first, second in ((0, 1), (2, 3)):
        assert results[first][0] == results[second][0]
        assert results[first][1] == pytest.approx(results[second][1], rel=1e-8)
    assert results[0][0] != results[2][0]
    assert abs(results[0][1][0] / results[2][1][0] - 1.0) > 0.01


PARAMETERS = ("amplitude", "frequency", "restitution", "slenderness")
CASES = st.tuples(
    st.floats(0.2, 1.5), st.floats(-0.3, 0.3), st.floats(0.5, 2.0), st.floats(1.5, 5.0), st.floats(0.0, 6.2),
    st.floats(0.3, 1.2), st.booleans(),
)  # fmt: skip


@pytest.mark.verifies("computed anew", "central differences", within="1e-5")
@settings(max_examples=40, deadline=None)
@given(CASES)
def test_derivatives_are_those_of_differences(case):
    """Jacobian and derivatives by all parameters, over three impacts of a body that is not symmetric."""
    height, shift, amplitude, frequency, phase, speed, linear = case
    body = MassPoints(
        [[-0.4, 0.0], [0.6, 0.0], [0.1 + shift, 1.0 + height], [shift, 2.0]], [1.0, 1.0, 2.0, 1.0], feet=(-0.4, 0.6)
    )
    system = HarmonicRocking.of_ratios(
        body, amplitude, frequency, restitution={"left": 0.8, "right": 0.9}, linear=linear
    )
    flight = over_impacts(system, phase, speed, 3)
    if flight.event[0] != 1 or np.abs(flight.jacobian).max() > 100.0:
        return  # overturns or at rest, or nearly grazes: differences say little
    step = 1e-6
    columns = [
        [over_impacts(system, phase + sign * step * a, speed + sign * step * b, 3) for sign in (1, -1)]
        for a, b in ((1, 0), (0, 1))
    ]
    for k, (above, below) in enumerate(columns):
        difference = np.array([above.phase[0] - below.phase[0], above.speed[0] - below.speed[0]]) / (2.0 * step)
        assert flight.jacobian[0][:, k] == pytest.approx(difference, rel=1e-5, abs=1e-6)
    for name in ("amplitude", "frequency"):
        value = system.value(name)
        ends = [
            over_impacts(system.changed(name, value * (1.0 + sign * step)), phase, speed, 3) for sign in (1.0, -1.0)
        ]
        difference = np.array([ends[0].phase[0] - ends[1].phase[0], ends[0].speed[0] - ends[1].speed[0]]) / (
            2.0 * step * value
        )
        assert over_impacts(system, phase, speed, 3, parameter=name).by_parameter[0] == pytest.approx(
            difference, rel=1e-5, abs=1e-6
        )


@pytest.mark.verifies("computed anew", "central differences", within="1e-6")
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("name", PARAMETERS)
def test_derivatives_by_parameters_of_a_rectangle(name, linear):
    """Also by the coefficient of both feet, and by the slenderness angle with constant p."""
    system = system_of(3, 1.4, 2.7, 0.9, linear=linear)
    value, step = system.value(name), 1e-6
    ends = [over_impacts(system.changed(name, value + sign * step), 5.7, 0.8, 4) for sign in (1.0, -1.0)]
    difference = np.array([ends[0].phase[0] - ends[1].phase[0], ends[0].speed[0] - ends[1].speed[0]]) / (2.0 * step)
    assert over_impacts(system, 5.7, 0.8, 4, parameter=name).by_parameter[0] == pytest.approx(difference, rel=1e-6)


@pytest.mark.verifies("second engine", "the same engine for other instruction sets", within="1e-9")
def test_engines_of_all_processors_agree():
    """Every instruction set gives the same verdicts, and the same bits on two that fuse multiplications."""
    from rocking.dynamics import _longrun

    system = system_of(3, 1.7, 2.5, "housner")
    starts = start_states(system, np.transpose(grid(np.linspace(0.1, 6.0, 6), [0.2, 0.7])))
    tables = {}
    for isa in ("plain", "avx2", "avx512"):
        results = np.full((len(starts), 9), np.nan)
        states, hits = np.full((len(starts), 20, 2), np.nan), np.empty((len(starts), 0, 3))
        sides, sines = np.tile(system.sides, (len(starts), 1)), np.tile(system.sine, (len(starts), 1, 1))
        try:
            _longrun.many(
                sides, sines, starts, results, states, hits, np.empty((2, 0)), 30, 2, False, 1.5, 1e-7, 1e-16, 2, isa
            )
        except ValueError:
            continue  # this processor has none
        tables[isa] = (results, states)
    for results, states in tables.values():
        assert results[:, 0].tolist() == tables["plain"][0][:, 0].tolist()
        assert states == pytest.approx(tables["plain"][1], abs=1e-9, nan_ok=True)
    if "avx512" in tables:
        assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(tables["avx2"], tables["avx512"], strict=True))


@pytest.mark.verifies("closed form", "modulus r of the multipliers of a focus", within="0.002")
def test_impacts_at_the_ends_of_periods():
    """A stable orbit that starts at its impact has an impact at the end of each period, up to rounding: no history
    fails, and both exponents are (omega / pi) ln r."""
    system = system_of(2.0, 1.2, 2.0, "housner")
    orbit = symmetric_orbit(system)
    speeds = orbit.speed * (1.0 + 0.0005 * np.arange(64))
    starts = start_states(system, np.column_stack([np.full(64, orbit.phase), speeds]))
    result = lyapunov_exponents(system, starts=starts, settled=100, kept=2900)
    assert len(result.finite) == 64
    exact = system.excitation.frequency / math.pi * math.log(0.7)
    # the first and last directions of the rotating tangent vectors change ln of the growth by up to 2, of 2000
    assert result.finite == pytest.approx(exact, rel=2e-3)


@pytest.mark.verifies("damage")
def test_bad_input_is_refused():
    """Values out of range name their parameter; orbits of asymmetric bodies have an even number of impacts."""
    with pytest.raises(ValueError, match="period"):
        Harmonic(amplitude=1.0, period=0.0)
    with pytest.raises(ValueError, match="amplitude"):
        Harmonic(amplitude=math.nan, period=1.0)
    lean = MassPoints([[-0.4, 0.0], [0.6, 0.0], [0.3, 2.0]], [1.0, 1.0, 2.0], feet=(-0.4, 0.6))
    system = HarmonicRocking.of_ratios(lean, 1.5, 2.0, restitution="ked")
    with pytest.raises(ValueError, match="both"):
        find_orbit(system, 1.0, 1.0)
    block = system_of(4, 1.5, 2.0, "ked")
    for name, call in {
        "kept": lambda: over_periods(block, np.zeros((1, 3)), kept=0),
        "vectors": lambda: over_periods(block, np.zeros((1, 3)), vectors=3),
        "starts": lambda: over_periods(block, np.full((1, 3), math.nan)),
        "one row per system": lambda: over_periods([block], np.zeros((2, 3))),
        "impacts": lambda: over_impacts(block, 1.0, 1.0, 0),
        "parameter": lambda: block.changed("mass", 1.0),
        "restitution": lambda: block.changed("restitution", 1.2),
        "coefficient of restitution": lambda: system_of(4, 1.5, 2.0, 1.2).sides,
        "slenderness": lambda: block.changed("slenderness", 2.0),
        "frequency": lambda: system_of(4, 1.5, 0.0, "ked"),
        "amplitude": lambda: over_impacts(block.changed("amplitude", 0.0), 1.0, 1.0, parameter="amplitude"),
        "step_error": lambda: Numerics(step_error=math.nan),
        "excitation": lambda: HarmonicRocking(Block(width=1.0, height=4.0), 3.0),
        "symmetric": lambda: symmetric_orbit(system),
        "seed": lambda: lyapunov_exponents(block, seed=-1),
    }.items():
        with pytest.raises(ValueError, match=name):
            call()
    with pytest.raises(ValueError, match="restitution"):
        slender_thresholds(2.0, 0.0)
    with pytest.raises(ValueError, match="settled"):
        lyapunov_exponents(system, settled=5)
    with pytest.raises(ValueError, match="starts"):
        rk.bifurcation(system.body, system.excitation, "amplitude", [1.0, 2.0], starts=np.zeros((2, 3)))
