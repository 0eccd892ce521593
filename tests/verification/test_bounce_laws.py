"""Poisson's and Stronge's restitution and the shock of Painleve, and the compiled engine that has them too."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_cases import noise_motion, section
from scipy.integrate import solve_ivp

import rocking as rk
from rocking.dynamics.plane_frictional import GroundContact
from rocking.dynamics.plane_frictional.base import BOTH, RIGHT, ContactState, PlaneBase, along, away, kinetic
from rocking.dynamics.plane_frictional.impact_resolution import Struck, impact_of, shock, strike
from rocking.outcome import Status

pytestmark = pytest.mark.verifies(room="sliding, hopping and flight")
LAWS = ("newton", "poisson", "stronge")
TALL = PlaneBase(1.0, 1.25 / 3.0, 1.0, 0.5, 0.5)


def _falling(base, rotation, u, w, spin):
    return ContactState(0.0, base.rise_on(RIGHT, rotation), rotation, u, w, spin, (RIGHT,))


def _struck(state, mu, e, law, base=TALL):
    found, replaced = impact_of(base, state, GroundContact(mu, e, None, law), dict.fromkeys(state.touching, e))
    assert isinstance(found, Struck)
    return found, replaced


@pytest.mark.verifies("closed form", "where a foot slides on without stopping, the three laws are one", within="1e-12")
def test_laws_agree_where_sliding_does_not_stop():
    """Fast sliding on little friction: the same impulse; where sliding turns they differ, the negative control."""
    fast = _falling(TALL, 0.3, 3.0, -1.0, 0.2)
    states = [_struck(fast, 0.1, 0.5, law)[0].state[3:6] for law in LAWS]
    assert states[1] == pytest.approx(states[0], rel=1e-12)
    assert states[2] == pytest.approx(states[0], rel=1e-12)
    slow = _falling(TALL, 0.9, 0.8, -1.0, 0.0)
    turned = [_struck(slow, 0.3, 0.5, law)[0].state.w for law in LAWS]
    assert abs(turned[2] - turned[1]) > 1e-3
    assert abs(turned[1] - turned[0]) > 1e-3


@pytest.mark.slow
@pytest.mark.verifies(
    "invariant",
    "kinetic energy over an impact",
    within="1e-12",
    control="test_newton_alone_creates_energy_and_stronge_stands_in",
)
@settings(max_examples=300)
@given(
    st.floats(0.0, 1.5), st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.floats(-3.0, 3.0), st.floats(0.0, 3.0),
    st.floats(0.0, 0.99), st.sampled_from(LAWS),
)  # fmt: skip
def test_no_law_creates_energy(rotation, u, w, spin, mu, e, law):
    """Any impact of one foot, with any friction: a result, away from the ground, and no energy gained."""
    state = _falling(TALL, rotation, u, w, spin)
    if away(TALL, state, RIGHT) > -1e-3:
        return
    found, _ = _struck(state, mu, e, law)
    assert away(TALL, found.state, RIGHT) >= -1e-12
    assert e > 0.0 or away(TALL, found.state, RIGHT) < 1e-12
    assert kinetic(TALL, found.state) <= kinetic(TALL, state) * (1.0 + 1e-12)


@pytest.mark.verifies("negative control")
def test_newton_alone_creates_energy_and_stronge_stands_in():
    """The negative control: Newton's law has no answer here; the impact follows Stronge's, and says so."""
    state = _falling(TALL, 1.3334259860891, -0.12833044107477, -0.64140325334667, -1.8520466144989)
    assert strike(TALL, state, 3.0, {RIGHT: 0.9}) is Status.ENERGY_GAIN
    found, replaced = _struck(state, 3.0, 0.9, "newton")
    assert replaced
    assert found == _struck(state, 3.0, 0.9, "stronge")[0]
    assert kinetic(TALL, found.state) < kinetic(TALL, state)


def _compliant(base, state, mu, stiffness):
    """A foot on a stiff spring with Coulomb's friction, to the end of compression: velocities, by scipy."""
    r_x, r_z = base.arm(RIGHT, state.rotation)

    def rates(_, y):
        depth, u, w, spin = y
        force = stiffness * max(depth, 0.0)
        pull = -mu * math.tanh((u + r_z * spin) / 1e-6) * force
        return [-(w - r_x * spin), pull, force, (pull * r_z - force * r_x) / base.inertia]

    def turns(_, y):  # compression ends
        return y[2] - r_x * y[3]

    turns.terminal, turns.direction = True, 1.0
    start = [1e-9, state.u, state.w, state.spin]
    end = solve_ivp(rates, (0.0, 1.0), start, events=turns, method="Radau", rtol=1e-9, atol=1e-13)
    return end.y_events[0][0][1:]


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "a stiff spring under the foot, by scipy", within="1e-3")
@pytest.mark.parametrize("mu", [1.6, 2.0, 3.0])
def test_the_shock_is_the_limit_of_a_stiff_spring(mu):
    """No rigid force where lambda = 2 slides forward with mu > 4/3: the spring's end of compression is the shock's."""
    state = ContactState(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, BOTH)
    struck = shock(TALL, state, GroundContact(mu))
    assert isinstance(struck, Struck)
    expected = _compliant(TALL, state, mu, 1e6)
    assert struck.state[3:6] == pytest.approx(expected.tolist(), abs=1e-3)
    assert abs(along(TALL, struck.state, RIGHT)) < 1e-12
    assert kinetic(TALL, struck.state) < kinetic(TALL, state)
    assert shock(TALL, state, GroundContact(1.2)) is Status.NO_CONTACT_FORCE, "the control: there a force is possible"


@pytest.mark.verifies("closed form", "the classical rod, 1 < 3 mu sin cos - 3 cos^2", within="to 1e-3 in mu")
def test_the_rod_is_struck_where_painleve_says():
    """A slender rod (j = l^2 / 3 of the half length) at 45 degrees: paradox from mu = (1/3 + s^2) / (s c) = 5/3."""
    rod = PlaneBase(1.0, 1.0 / 3.0, 1.0, 1e-9, 1e-9)
    state = ContactState(0.0, 0.0, -math.pi / 4.0, 1.0, 0.0, 0.0, (RIGHT,))
    assert shock(rod, state, GroundContact(5.0 / 3.0 - 1e-3)) is Status.NO_CONTACT_FORCE
    assert isinstance(shock(rod, state, GroundContact(5.0 / 3.0 + 1e-3)), Struck)


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine", within="verdicts; 1e-8 of the peaks")
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("seed", range(6))
def test_compiled_engine_is_the_reference_engine(law, seed):
    """Random asymmetric bodies, noise with and without a vertical part, friction to 2.2, bounces: the same."""
    rng = np.random.default_rng([17, seed])
    body, motion = section(rng), noise_motion(rng, vertical=bool(seed % 2))
    friction, e = rng.uniform(0.05, 2.2, 2).tolist(), float(rng.uniform(0.0, 0.6)) * (seed % 3 > 0)
    options = {"friction": friction, "normal_restitution": e, "normal_restitution_law": law, "duration": 5.0}
    fast, slow = (
        rk.simulate_many(body, motion, ["housner", None], engine=engine, **options) for engine in ("fast", "reference")
    )
    assert fast["outcome"].values.tolist() == slow["outcome"].values.tolist()
    for name in ("peak_rotation", "sliding_distance", "friction_usage", "impacts", "shocks", "residual_displacement"):
        assert fast[name].values == pytest.approx(slow[name].values, rel=1e-8, abs=1e-8), name


@pytest.mark.slow
@pytest.mark.verifies("same bits", "other threads, other histories beside it")
def test_compiled_engine_does_not_depend_on_threads_or_company():
    """400 histories by one thread, by three, and one of them alone: the same bits."""
    body, motion = section(3), noise_motion(4)
    scales = np.linspace(-2.0, 2.0, 100)
    one, three = (
        rk.simulate_many(body, motion, [0.9, None], friction=[0.2, 0.8], scale=scales, threads=n) for n in (1, 3)
    )
    assert one.identical(three)
    alone = rk.simulate_many(body, motion, [0.9, None], friction=[0.2, 0.8], scale=scales[77])
    assert alone.drop_attrs().identical(one.isel(scale=[77]).drop_attrs())


@pytest.mark.verifies("closed form", "free flight and the sum of bounces", within="1e-9")
@pytest.mark.parametrize("law", LAWS)
def test_dropped_flat_it_bounces_as_a_point(law):
    """Dropped from H with e it rests after sqrt(2 H / g) (1 + e) / (1 - e), having slid nowhere."""
    e, drop = 0.5, 0.2
    still = rk.GroundMotion(np.zeros(3), 0.01)
    start = rk.dynamics.Start(height=drop)
    time = math.sqrt(2.0 * drop / 9.81) * (1.0 + e) / (1.0 - e)
    for duration, flying in ((0.99 * time, 1.0), (1.01 * time, 0.0)):
        found = rk.simulate_many(
            rk.Block(width=1.0, height=4.0), still, [None], friction=0.5, normal_restitution=e,
            normal_restitution_law=law, start=start,
            duration=duration, gravity=9.81,
        ).squeeze()  # fmt: skip
        assert float(found["still_rocking"]) == flying
        assert float(found["peak_rotation"]) == 0.0
