"""Lyapunov exponents, rests and hysteresis against independent programs and closed forms."""

import math

import numpy as np
import pytest
from long_run_systems import ANYTHING, MODELS, is_kind, system_of

import rocking as rk
from rocking.studies.longrun.attractors import KINDS, diagram
from rocking.studies.longrun.continuation import branch_off, continue_orbit
from rocking.studies.longrun.exponents import lyapunov_exponents
from rocking.studies.longrun.orbits import find_orbit, symmetric_orbit
from rocking.studies.longrun.system import over_periods

pytest.importorskip("rocking.dynamics._longrun", reason="the compiled engine is missing")
pytestmark = pytest.mark.verifies(room="rocking in the plane")

EXPONENTS = {
    # slenderness, model, frequency, amplitude: largest exponent over p, standard error; 64 orbits
    (2, "H", 2, 3.007): (0.07301, 0.00024),
    (2, "H", 2, 3.0166): (0.11552, 0.00040),
    (2, "H", 3, 8.0189): (0.17498, 0.00053),
    (1, "H", 2, 2.54): (0.11888, 0.00040),
    (1, "H", 2, 2.60): (0.25176, 0.00027),
    (1, "K", 2, 3.36): (0.1078, 0.0006),
}


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853")
@pytest.mark.parametrize("case", EXPONENTS)
def test_exponents_of_chaos(case):
    """Within three standard errors of both programs; the sum rule to 1e-10 in each run."""
    slenderness, model, frequency, amplitude = case
    system = system_of(slenderness, amplitude, frequency, MODELS[model])
    orbit = symmetric_orbit(
        system_of(slenderness, 1.6 if slenderness == 1 else 2.0 if frequency == 2 else 5.0, frequency, MODELS[model])
    )
    near = continue_orbit(orbit, (0.0, amplitude), step=0.05).orbits[-2]
    draws = np.random.default_rng(1).normal(scale=0.01, size=(64, 2))
    states = [
        ((near.phase + a) / system.excitation.frequency, near.speed * (1 + b) * system.alpha * system.p)
        for a, b in draws
    ]
    starts = np.array([(time, 1e-12, velocity) for time, velocity in states])
    result = lyapunov_exponents(system, starts=starts, settled=1500, kept=2000)
    value, error = EXPONENTS[case]
    assert len(result.finite) > 4
    assert result.sticking == 0
    own = result.standard_errors[0] / system.p
    assert abs(result.values[0] / system.p - value) < 3.0 * math.hypot(own, error)
    assert np.abs(result.sum_rule[np.isfinite(result.sum_rule)]).max() < 1e-10 * system.p


REGULAR = {
    # slenderness, model, frequency, amplitude: exact largest exponent over p, doublings
    (2, "H", 2, 1.2): (-0.2270663216, 0), (2, "H", 2, 2.383): (-0.0028727025, 0),
    (2, "H", 2, 2.923): (-0.0095412630, 1), (2, "H", 2, 2.986): (-0.0034538155, 2),
    (4, "H", 3, 5.868): (-0.0035272186, 0), (4, "K", 5, 24.109): (-0.0601666878, 1),
    (8, "K", 3, 7.37): (-0.0138778503, 2),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853", within="2e-10")
@pytest.mark.parametrize("case", REGULAR)
def test_exponents_of_periodic_orbits(case):
    """From the multipliers of the symmetric orbit, the 2-cycle and the 4-cycle: ten digits."""
    slenderness, model, frequency, amplitude = case
    value, doublings = REGULAR[case]
    orbit = symmetric_orbit(system_of(slenderness, 1.2 if frequency < 3 else 3.0, frequency, MODELS[model]))
    if doublings:
        kinds = ["pitchfork", "period doubling"][:doublings]
        branch = continue_orbit(orbit, ANYTHING, step=0.05, stop=is_kind("pitchfork"))
        for kind, step in zip(kinds, (0.03, 0.01)[:doublings], strict=True):
            branch = branch_off(branch.first(kind), ANYTHING, step=step, stop=is_kind("period doubling"))
        orbit = min(branch.orbits, key=lambda item: abs(item.system.amplitude_ratio - amplitude))
        exact = find_orbit(orbit.system.changed("amplitude", amplitude), orbit.phase, orbit.speed, impacts=2**doublings)
    else:
        branch = continue_orbit(orbit, (0.0, amplitude + 0.01), step=0.02)
        orbit = min(branch.orbits, key=lambda item: abs(item.system.amplitude_ratio - amplitude))
        exact = find_orbit(orbit.system.changed("amplitude", amplitude), orbit.phase, orbit.speed)
    assert exact.exponents[0] / exact.system.p == pytest.approx(value, abs=2e-10)


SMALL_BASINS = {
    (2, "K", 2, 3.091): (0.06412, 0.00021),
    (2, "K", 3, 8.4457): (0.05920, 0.00034),
    (4, "H", 2, 2.8355): (0.02573, 0.00013),
}


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "an independent program in 80-bit Taylor series and DOP853")
@pytest.mark.parametrize("case", SMALL_BASINS)
def test_exponents_of_a_small_basin(case):
    """Random states reach chaos also if 99 % of them overturn; within three standard errors of both programs."""
    slenderness, model, frequency, amplitude = case
    system = system_of(slenderness, amplitude, frequency, MODELS[model])
    result = lyapunov_exponents(system)
    finite = result.finite[:, 0] / system.p
    assert len(finite) + result.overturned == 64
    assert len(finite) >= 32
    assert finite.min() > 0.5 * SMALL_BASINS[case][0]  # all orbits are on the chaotic attractor
    own = result.standard_errors[0] / system.p
    equal = [
        key for key, (value, error) in SMALL_BASINS.items()
        if abs(finite.mean() - value) < 3.0 * math.hypot(own, error)
    ]  # fmt: skip
    assert equal == [case]  # control: the exponents of the other attractors are rejected


@pytest.mark.verifies("damage")
@pytest.mark.filterwarnings("error")
def test_the_number_of_orbits_is_a_number_of_any_type():
    """Small integers of numpy, which overflow beyond 255, give the orbits of equal Python integers."""
    system = system_of(2, 3.007, 2, "housner")
    one, other = (lyapunov_exponents(system, orbits=n, settled=60, kept=5) for n in (20, np.uint8(20)))
    assert len(one.by_orbit) == 20
    assert np.array_equal(one.by_orbit, other.by_orbit, equal_nan=True)


@pytest.mark.verifies("behaviour")
def test_a_rest_erases_memory():
    """An orbit that comes to rest in each period has exponents of minus infinity: it is never called chaotic."""
    system = system_of(2, 1.1, 2.0, "housner")
    result = lyapunov_exponents(system, starts=np.zeros((1, 3)), settled=100, kept=200)
    assert result.sticking == 1
    assert np.isneginf(result.by_orbit).all()
    attractors = diagram([system], np.zeros((1, 1, 3)), cycles=(100, 200), exponents=True)
    assert KINDS[attractors["attractor"].item()] == "sticking"
    assert np.isneginf(attractors["exponent"].item())


@pytest.mark.verifies("closed form", "the fold of the branch")
def test_sweeps_with_memory_show_hysteresis():
    """Below uplift a body at rest stays at rest, while a sweep down keeps the large orbit to its fold."""
    system = system_of(4, 1.0, 3.0, "ked")
    values = np.linspace(0.04, 1.2, 30)
    orbit = symmetric_orbit(system.changed("amplitude", 1.2))
    subject = (system.body, system.excitation, "amplitude")
    options = {"restitution": "ked", "exponents": False, "cycles": (200, 130)}
    down = rk.bifurcation(*subject, values, starts=[[orbit.phase, orbit.speed]], sweeps=("down",), **options)
    rocking = values[down["impacts_per_period"].values[0, :, 0, 0] > 1.9]
    assert rocking.min() == pytest.approx(0.0622597, abs=values[1] - values[0])
    rest = rk.bifurcation(*subject, values[values < 1.0], starts=1, **options)
    assert set(rest["attractor"].values.ravel()) == {KINDS.index("rest")}
    assert over_periods(system, np.zeros((1, 3))).peak[0] == 0.0
