"""calibrated-3d: a landing of the whole base has the coefficient of the plane model, in every direction."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rocking as rk
from rocking.bodies.solid import Corner, Edge, Part, RoundBase, Solid, box, cylinder
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.restitution import position_on_base
from rocking.dynamics.rolling import SpatialBody
from rocking.errors import InvalidValueError
from rocking.restitution.space import SpatialCalibrated, SpatialImpact, edge_coefficient, impact_in_space
from rocking.restitution.space.calibrated import calibrated_position

pytestmark = pytest.mark.verifies(room="restitution in space")

PULSE, OTHER = rk.pulses.sine(amplitude=4.0, period=0.6), rk.pulses.sine(amplitude=2.5, period=0.5)
LEANING = Solid([Part(box(0.5, 0.4, 0.4), 2400.0), Part(box(0.3, 0.3, 1.6), 2700.0).moved(0.08, -0.03, 0.4)])
CORNERED = Solid(
    [Part(box(0.8, 0.8, 1.5)), Part(box(0.3, 0.3, 0.8)).moved(0.2, -0.1, 1.5)],
    base=[(-0.4, -0.3), (0.35, -0.4), (0.1, 0.4), (-0.3, 0.3)],
)


def tower(width, depth, height, offset):
    """Return a box that stands on its base with the centre of mass beside the middle, known by its moments."""
    mass = 1000.0 * width * depth * height
    inertia = mass / 12.0 * np.array([depth**2 + height**2, width**2 + height**2, width**2 + depth**2])
    return Solid(box(width, depth, height), mass=mass, centre=(offset * width, 0.0, 0.5 * height), inertia=inertia)


@pytest.mark.slow
@pytest.mark.verifies("closed form", "the plane model, onto either foot", within="1e-9", control="within")
@given(
    st.floats(0.2, 3.0),
    st.floats(0.2, 3.0),
    st.floats(1.0, 12.0),
    st.floats(-0.2, 0.2),
    st.sampled_from(["left", "right"]),
)
def test_a_landing_on_an_edge_has_the_coefficient_of_the_plane(width, depth, slenderness, offset, foot):
    """Of asymmetric prisms of any size, also where the loss exceeds Housner's; KED has another coefficient."""
    solid = tower(width, depth, slenderness * width, offset)
    section = rk.Block(
        width=width, height=slenderness * width, depth=depth, mass=solid.mass,
        centre=((0.5 + offset) * width, 0.5 * slenderness * width),
        moment_of_inertia=float(solid.local_moments.inertia[1, 1]),
    )  # fmt: skip
    number = [float(edge.direction[1]) > 0.5 for edge in solid.base.edges].index(True)  # the right foot
    onto = solid.base.opposite(number) if foot == "left" else solid.base.edge(number)
    start = solid.base.edge(number) if foot == "left" else solid.base.opposite(number)
    after = impact_in_space(solid, -start.direction, pivot=start, onto=onto, model="calibrated")
    expected = rk.coefficient_of_restitution(section, "calibrated", foot=foot)
    assert after.coefficient == pytest.approx(expected, rel=1e-9, abs=0.0)
    assert abs(rk.coefficient_of_restitution(section, "ked", foot=foot) - expected) > 1e-3


@pytest.mark.verifies("closed form", "a loss above Housner's", within="1e-9", control="within")
def test_a_loss_above_that_of_housner_is_kept():
    """Of a body of h/b 14 the measurements give a larger loss than Housner's model: k lies beyond the new foot."""
    slender = Solid(box(1.0, 0.8, 14.0))
    block = rk.Block(width=1.0, height=14.0)
    r = edge_coefficient(slender, "calibrated", start=1)
    assert r == pytest.approx(rk.coefficient_of_restitution(block, "calibrated"), rel=1e-9, abs=0.0)
    assert r < edge_coefficient(slender, "housner", start=1) - 0.005
    assert calibrated_position(slender.local_moments, slender.local_base).at(np.array([1.0, 0.0, 0.0])) > 1.0


@pytest.mark.verifies("order", "the energy lost in n steps of a landing", within="0.02 of the order")
def test_small_steps_lose_little():
    """The energy lost in a step of a landing falls with the square of its length, so that n steps lose 1/n of one."""
    solid = Solid.from_section(rk.Section.from_rectangle(1.0, 4.0))
    moments, base, along = solid.local_moments, solid.local_base, np.array([0.0, 1.0, 0.0])
    losses = []
    for length in (0.1, 0.05, 0.025):
        old, new = (np.array([x, 0.0, 0.0]) for x in (-0.5 * length, 0.5 * length))
        impact = SpatialImpact(moments, along, old, Edge(new, along), base=base)
        losses.append(1.0 - SpatialCalibrated().turned(impact)[1])
    np.testing.assert_allclose(np.log2(np.array(losses[:-1]) / losses[1:]), 2.0, rtol=0.0, atol=0.02)


@pytest.mark.verifies("invariant", "energy does not grow, any landing on a corner", within="1e-12")
@given(st.integers(0, 2**32 - 1))
def test_no_landing_gains_energy(seed):
    """Random rotations about a corner onto another one, of a body whose centre lies beside the middle of its base."""
    rng = np.random.default_rng(seed)
    first, last = rng.choice(len(CORNERED.base.vertices), 2, replace=False)
    pivot, onto = (Corner(CORNERED.base.corners[k].point) for k in (first, last))
    velocity = rng.normal(size=3)
    middle = np.append(CORNERED.base.vertices.mean(axis=0), 0.0) - pivot.point
    velocity *= -np.sign(np.cross(velocity, middle)[2])
    result = impact_in_space(CORNERED, velocity, pivot=pivot, onto=onto, model="calibrated")
    assert result.energy_after <= result.energy_before * (1.0 + 1e-12)


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine without friction", within="1e-6", control="within")
@pytest.mark.parametrize(
    ("body", "scale"),
    [(LEANING, 1.0), (CORNERED, 1.1), (Solid(cylinder(0.6, 2.0)), 1.0), (tower(0.6, 0.5, 2.0, 0.05), 1.0)],
    ids=["column", "four corners", "cylinder", "known moments"],
)  # fmt: skip
def test_both_engines_agree(body, scale):
    """Impacts, peak and energy lost in 1.5 s are those of the reference engine; Housner loses more."""
    motion = {"x": PULSE} if isinstance(body.base, RoundBase) else {"x": PULSE, "y": OTHER}
    fast, slow = (
        rk.simulate_many(
            [body], [motion], scale=[scale], restitution=["calibrated", "housner"], duration=1.5, engine=engine
        )
        for engine in ("fast", "reference")
    )
    assert (fast["impacts"].values == slow["impacts"].values).all()
    for name in ("peak_tilt", "energy_lost"):
        np.testing.assert_allclose(fast[name].values, slow[name].values, rtol=1e-6)
    calibrated, housner = fast["energy_lost"].values.ravel()
    assert 0.0 < calibrated < 0.9 * housner


@pytest.mark.slow
@pytest.mark.verifies("invariant", "each model has its own table in a batch", within="bits")
def test_models_of_one_batch_are_those_of_batches_of_their_own():
    """Two bodies under KED and the calibrated model, with and without friction: no row takes the table of another."""
    motion, models, bodies = {"x": PULSE, "y": OTHER}, ["ked", "calibrated"], [LEANING, Solid(box(0.6, 0.5, 2.0))]
    for friction in (None, 0.6):
        options = {} if friction is None else {"friction": friction}
        both = rk.simulate_many(bodies, [motion], restitution=models, **options)["peak_tilt"].values
        alone = [
            rk.simulate_many([body], [motion], restitution=[model], **options)["peak_tilt"].values.item()
            for body in bodies
            for model in models
        ]
        assert both.ravel().tolist() == alone
        assert len(set(alone)) == 4


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine with friction", within="1e-6")
def test_both_engines_with_friction_agree():
    """A prism of known moments with friction 0.6, on its hull."""
    body, motion = tower(0.6, 0.5, 2.0, 0.05), {"x": PULSE, "y": OTHER}
    fast, slow = (
        rk.simulate_many([body], [motion], restitution=["calibrated"], friction=0.6, engine=engine)
        for engine in ("fast", "reference")
    )
    assert fast["impacts"].values.item() > 3
    assert fast["peak_tilt"].values.item() == pytest.approx(slow["peak_tilt"].values.item(), rel=1e-6, abs=0.0)


@pytest.mark.verifies("invariant", "the position on the base of the solid", within="1e-9")
def test_the_base_of_a_hull_is_that_of_its_solid():
    """A hull of vertices alone has the same position in every direction as the solid; a leaning one is refused."""
    of_solid = HullBody.of(LEANING)
    bare = HullBody(of_solid.vertices, of_solid.mass, of_solid.centre, of_solid.inertia)
    for angle in np.linspace(-3.0, 3.0, 7):
        step = np.array([math.cos(angle), math.sin(angle), 0.0])
        assert position_on_base(bare).at(step) == pytest.approx(position_on_base(of_solid).at(step), rel=1e-9)
    turn = np.array([[math.cos(0.1), 0.0, math.sin(0.1)], [0.0, 1.0, 0.0], [-math.sin(0.1), 0.0, math.cos(0.1)]])
    leaning = HullBody(bare.vertices @ turn.T, bare.mass, turn @ bare.centre, turn @ bare.inertia @ turn.T)
    with pytest.raises(InvalidValueError, match="level base"):
        position_on_base(leaning)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the response of the solid", within="1e-9")
def test_a_body_of_known_moments_needs_no_distribution_of_mass():
    """Where KED is refused the calibrated model gives a response, also of a body described by its base alone."""
    body = tower(0.6, 0.5, 2.0, 0.05)
    bare = SpatialBody(body.mass, body.local_moments.centre, body.local_moments.inertia, body.local_base.vertices)
    with pytest.raises(InvalidValueError, match="distribution of mass"):
        rk.simulate(bare, {"x": PULSE}, restitution="ked")
    peaks = [rk.simulate(each, {"x": PULSE}, restitution="calibrated").peak_tilt for each in (bare, body)]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-9)
