"""The one default restitution model: the same in Python, files and the page, and named in every answer."""

import inspect

import pytest

import rocking as rk
from rocking import decision, studies
from rocking.conventions import DEFAULT_RESTITUTION
from rocking.dynamics import SpatialBody
from rocking.restitution.space import edge_coefficient, impact_in_space, spatial_model
from rocking.spec.questions import questions

BLOCK, PULSE = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.2, 0.8)
FUNCTIONS = (
    rk.simulate, rk.free_rocking, rk.simulate_many, rk.overturning_map, rk.minimum_overturning_acceleration,
    rk.coefficient_of_restitution, rk.rocking_spectrum, rk.fragility, studies.fragility_analysis, studies.boundary,
    studies.refined_map, decision.compare_code_methods, edge_coefficient, impact_in_space,
)  # fmt: skip


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda one: one.__name__)
def test_functions_have_one_default(function):
    """Every function with a default restitution has this one."""
    parameters = inspect.signature(function).parameters
    name = "restitution" if "restitution" in parameters else "model"
    assert parameters[name].default == DEFAULT_RESTITUTION


def test_files_have_the_default():
    """Job files and input files have the default restitution."""
    for question in questions().values():
        table = question.model_fields["restitution"].get_default(call_default_factory=True)
        assert table.model == DEFAULT_RESTITUTION


def test_every_mechanics_has_the_default_and_names_it():
    """The plane, contact, space and hull engines take the default, and their answers name it."""
    box = SpatialBody.box(0.5, 0.5, 2.0)
    assert spatial_model(DEFAULT_RESTITUTION).name == "calibrated-3d"
    for body, motion in ((BLOCK, PULSE), (box, {"x": PULSE, "y": PULSE})):
        for friction in (None, 0.5):
            answer = rk.simulate(body, motion, friction=friction, duration=0.5).answer()
            assert answer["restitution"].removesuffix("-3d") == DEFAULT_RESTITUTION
