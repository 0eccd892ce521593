"""Floor motions: a closed form, the equations of motion of the whole building, limits, and the step of the chain."""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.signal import lsim

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.motions import processed
from rocking.motions.components import Components
from rocking.motions.floors import on_floor

pytestmark = pytest.mark.verifies(room="motions and records")

TIME = np.arange(0.0, 6.0, 0.01)
RECORD = rk.GroundMotion(3.0 * np.sin(7.0 * TIME) * np.exp(-0.3 * TIME) + 0.5 * np.sin(31.0 * TIME), 0.01)


def building(storeys, period, damping):
    """Absolute accelerations of all floors from matrices of mass, stiffness and damping, by SciPy."""
    stiffness = 2.0 * np.eye(storeys) - np.eye(storeys, k=1) - np.eye(storeys, k=-1)
    stiffness[-1, -1] = 1.0
    stiffness *= (2.0 * np.pi / period) ** 2 / eigh(stiffness, eigvals_only=True)[0]
    squares, shapes = eigh(stiffness)
    friction = shapes @ np.diag(2.0 * damping * np.sqrt(squares)) @ shapes.T
    zero, one = np.zeros((storeys, storeys)), np.eye(storeys)
    system = np.block([[zero, one], [-stiffness, -friction]])
    force = np.concatenate([np.zeros(storeys), -np.ones(storeys)])[:, None]
    seen = np.hstack([-stiffness, -friction])
    _, found, _ = lsim((system, force, seen, np.zeros((storeys, 1))), RECORD.acceleration, TIME)
    return found.reshape(TIME.size, storeys).T


@pytest.mark.verifies("closed form", "an oscillator pushed at once, 1 - cos(omega t)", within="1e-11", control="within")
def test_a_building_of_one_storey_is_an_oscillator():
    """Pushed at once and without damping its floor accelerates by 1 - cos(omega t)."""
    push = rk.GroundMotion(np.ones(301), 0.01)
    found = on_floor(push, 1, storeys=1, period=0.7, damping=0.0).acceleration
    expected = 1.0 - np.cos(2.0 * np.pi / 0.7 * 0.01 * np.arange(301))
    assert found == pytest.approx(expected, abs=1e-11)


@pytest.mark.verifies("computed anew", "matrices of the whole building and SciPy's linear systems", within="1e-8",
                      control="test_another_floor_moves_otherwise")  # fmt: skip
@pytest.mark.parametrize("storeys", [1, 3, 8])
def test_floors_move_as_the_equations_of_the_building_say(storeys):
    """Every floor moves as the matrices of mass, stiffness and modal damping make it move."""
    expected = building(storeys, 0.6, 0.05)
    for number in range(1, storeys + 1):
        found = on_floor(RECORD, number, storeys, 0.6).acceleration
        assert np.abs(found - expected[number - 1]).max() < 1e-8


@pytest.mark.verifies("behaviour")
def test_buildings_have_1_to_100_storeys():
    """A building of 100 storeys has a roof; one of 101 or none, and a floor outside of it, are refused."""
    assert np.isfinite(on_floor(RECORD, 100, 100, 5.0).acceleration).all()
    for number, storeys, name in ((1, 101, "storeys"), (1, 0, "storeys"), (0, 3, "number"), (4, 3, "number")):
        with pytest.raises(InvalidValueError, match=name):
            on_floor(RECORD, number, storeys, 5.0)


@pytest.mark.verifies("negative control")
def test_another_floor_moves_otherwise():
    """Negative control: the floor below, and another damping, are further off than a hundredth of the record's peak."""
    expected = building(3, 0.6, 0.05)
    for number, damping in ((2, 0.05), (3, 0.06)):
        assert np.abs(on_floor(RECORD, number, 3, 0.6, damping).acceleration - expected[2]).max() > 0.03


@pytest.mark.verifies("closed form", "a stiff building moves with the ground", within="0.02", control="within")
def test_a_stiff_building_moves_with_the_ground():
    """All floors of a building much quicker than the motion move as the ground does, the shares of modes adding up."""
    slow = rk.GroundMotion(np.sin(2.0 * TIME), 0.01)
    for number in (1, 5):
        assert np.abs(on_floor(slow, number, 5, 0.05).acceleration - slow.acceleration)[200:].max() < 0.02
        assert np.abs(on_floor(slow, number, 5, 2.0).acceleration - slow.acceleration)[200:].max() > 0.1


@pytest.mark.verifies("behaviour")
def test_a_step_of_the_chain():
    """As a step of a chain it moves both horizontal components and leaves the vertical one; what no building has is
    refused."""
    up = rk.GroundMotion(RECORD.acceleration[::-1], 0.01)
    found = processed(Components(RECORD, up, up), "floor:number=2,storeys=3,period=0.6")
    assert found.x.acceleration.tolist() == on_floor(RECORD, 2, 3, 0.6).acceleration.tolist()
    assert found.y.acceleration.tolist() == on_floor(up, 2, 3, 0.6).acceleration.tolist()
    assert found.z is up
    assert "floor 2 of 3 of an elastic shear building" in found.x.provenance[-1]
    assert "fundamental period 0.6 s, 5 % damping of every mode (assumed)" in found.x.provenance[-1]
    assert "(given)" in on_floor(RECORD, 2, 3, 0.6, damping=0.05).provenance[-1]
    for chain in ("floor:number=4,storeys=3,period=0.6", "floor:number=0,storeys=3,period=0.6",
                  "floor:number=1,storeys=3,period=0", "floor:number=1,storeys=3"):  # fmt: skip
        with pytest.raises(InvalidValueError, match="step floor"):
            processed(RECORD, chain)
