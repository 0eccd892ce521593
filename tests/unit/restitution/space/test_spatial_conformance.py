"""What every registered model in space must do; a new model is picked up by its registration."""

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Corner, Edge, Part, Solid, box, cylinder, frustum
from rocking.dynamics import SpatialStart
from rocking.dynamics.rolling import SpatialBody
from rocking.dynamics.rolling.impact_laws import ModelLaw, law_of
from rocking.errors import InvalidValueError
from rocking.restitution.space import SpatialImpact, SpatialModel, spatial_model, spatial_models

pytestmark = pytest.mark.verifies(room="restitution in space")

MODELS = sorted(spatial_models())
BODIES = {
    "prism": Solid(box(1.0, 1.3, 4.0)),
    "column": Solid([Part(box(1.0, 1.2, 0.3), 2400.0), Part(frustum(0.8, 0.5, 2.0), 2700.0).moved(0.05, 0.0, 0.3)]),
    "drum": Solid(cylinder(1.1, 2.5)),
}
LANDINGS = {"corner": Corner(np.array([0.5, 0.3, 0.0])), "edge": Edge(np.array([0.5, 0.0, 0.0]), np.eye(3)[1])}
LEAN = np.array([0.1, -0.2, 1.0]) / np.sqrt(1.05)


def leaning(solid, onto, *, up=LEAN, matter=True, speed=1.0):
    def found():
        return solid, np.zeros(3)

    velocity = speed * np.array([0.3, 1.0, 0.1])
    pivot, base = np.array([-0.5, 0.1, 0.0]), solid.local_base
    return SpatialImpact(solid.local_moments, velocity, pivot, onto, up, found if matter else None, base)


class Bouncing(SpatialModel):
    """A wrong model: the body goes on as if nothing had happened, faster."""

    name = "bouncing-3d"

    def angular_velocity(self, impact):
        return 1.5 * impact.velocity


def loses(model, impact):
    """Whether a model leaves no more than the energy before."""
    velocity = model.turned(impact)
    return bool(0.5 * velocity @ impact.inertia @ velocity <= impact.energy * (1.0 + 1e-12))


@pytest.mark.verifies(
    "invariant",
    "energy, another speed and density",
    within="1e-12",
    control="test_a_model_that_creates_energy_is_found_out",
)
@pytest.mark.parametrize("place", LANDINGS)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("name", MODELS)
def test_contract_of_a_model(name, body, place):
    """Finite, along the edge if there is one, loses energy, linear in the speed, and blind to mass and history."""
    model, onto = spatial_model(name), LANDINGS[place]
    impact = leaning(BODIES[body], onto)
    velocity = model.turned(impact)
    assert velocity.shape == (3,)
    assert np.isfinite(velocity).all()
    assert loses(model, impact)
    if place == "edge":
        assert not velocity[[0, 2]].any()
    assert model.turned(leaning(BODIES[body], onto, speed=3.0)) == pytest.approx(3.0 * velocity, rel=1e-12, abs=0.0)
    dense = leaning(BODIES[body].scaled(density=5.0), onto)
    assert model.turned(dense) == pytest.approx(velocity, rel=1e-12, abs=1e-14)
    assert (model.turned(impact) == velocity).all()


@pytest.mark.verifies("negative control", "a model that speeds the body up")
@pytest.mark.parametrize("place", LANDINGS)
def test_a_model_that_creates_energy_is_found_out(place):
    """Negative control: the bound rejects a model that speeds the body up."""
    assert not loses(Bouncing(), leaning(BODIES["prism"], LANDINGS[place]))


@pytest.mark.parametrize("name", MODELS)
def test_needs_solid_says_the_truth(name):
    """A model that says it needs no distribution of mass gives the same numbers without; the others refuse."""
    model, solid = spatial_model(name), BODIES["column"]
    bare = leaning(solid, LANDINGS["corner"], matter=False)
    if model.needs_solid:
        with pytest.raises(InvalidValueError, match="distribution of mass"):
            model.turned(bare)
    else:
        assert (model.turned(bare) == model.turned(leaning(solid, LANDINGS["corner"]))).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_every_model_is_a_law_of_histories(name):
    """By name, short name and object: one law, one label, and a history with impacts."""
    body = SpatialBody.of(BODIES["column"])
    for given in (name, name.removesuffix("-3d"), spatial_model(name)):
        law = law_of(given, body)
        assert isinstance(law, ModelLaw)
        assert law.label == name
    run = rk.free_rocking(body, restitution=name, start=SpatialStart(0.08, 0.5), duration=1.0)
    assert run.impacts.size > 0
    assert run.law.label == name


def test_a_model_of_ones_own_rocks():
    """A subclass with one method serves as restitution without registration."""

    class Dead(SpatialModel):
        name = "dead-3d"

        def angular_velocity(self, impact):
            return np.zeros(3)

    run = rk.free_rocking(SpatialBody.box(1.0, 1.0, 4.0), restitution=Dead(), start=SpatialStart(0.1), duration=3.0)
    assert run.impacts["energy_after"][0] == 0.0
    assert run.law.label == "dead-3d"
