"""Energy and forces of the ground: closed balances, of records too, and friction that rocking takes."""

import math
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from engines import ENGINES, every_engine

import rocking as rk
from rocking.conventions import g
from rocking.dynamics.plane import dense_output, equations
from rocking.errors import InvalidValueError

pytestmark = pytest.mark.verifies(room="rocking in the plane")

BLOCK = rk.Block(width=1.0, height=3.0, depth=2.0, density=1000.0)
MASS, RADIUS, ALPHA = 6000.0, math.hypot(0.5, 1.5), math.atan(1.0 / 3.0)
START, R = 0.15, 0.85
PSI = ALPHA - START
WHOLE = MASS * g * RADIUS * (math.cos(PSI) - math.cos(ALPHA))


@pytest.mark.slow
@pytest.mark.verifies("closed form", "m g R (cos(alpha - theta_0) - cos(alpha)), and r^2n of it", within="1e-11")
@every_engine
def test_free_rocking_ledger(name: str) -> None:
    """All energy is m g R (cos(alpha - theta_0) - cos(alpha)); n impacts take 1 - r^(2n) of it; no work is done."""
    response = rk.free_rocking(BLOCK, START, R, engine=name)
    energy = response.energy
    assert (energy.kinetic[0], energy.work[0], energy.lost[0]) == (0.0, 0.0, 0.0)
    assert energy.potential[0] == pytest.approx(WHOLE, rel=1e-13, abs=0.0)
    assert not energy.work.any()
    happened = np.searchsorted(response.impacts["time"], response.time, side="right")
    early = happened < 12  # later impacts are summed up in the rest
    np.testing.assert_allclose(
        energy.lost[early], WHOLE * (1.0 - R ** (2.0 * happened[early])), rtol=0.0, atol=1e-11 * WHOLE
    )
    assert energy.lost[-1] == pytest.approx(WHOLE, rel=1e-13, abs=0.0)
    assert energy.closure < 1e-11
    assert energy.gap.shape == energy.time.shape == response.time.shape


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_forces_when_let_go(name: str, sign: float) -> None:
    """Let go from theta_0: f_x = -s m 3/4 g sin cos, f_z = m (g - 3/4 g sin^2), of alpha - theta_0."""
    contact = rk.free_rocking(BLOCK, sign * START, R, engine=name).contact
    expected_x = -sign * MASS * 0.75 * g * math.sin(PSI) * math.cos(PSI)
    expected_z = MASS * (g - 0.75 * g * math.sin(PSI) ** 2)
    assert contact.horizontal[0] == pytest.approx(expected_x, rel=1e-12, abs=0.0)
    assert contact.vertical[0] == pytest.approx(expected_z, rel=1e-12, abs=0.0)
    assert contact.horizontal[-1] == pytest.approx(0.0, abs=1e-9 * MASS)
    assert contact.vertical[-1] == pytest.approx(MASS * g, rel=1e-12, abs=0.0)
    assert contact.friction_of_motion >= abs(expected_x / expected_z)


def test_friction_of_impacts() -> None:
    """Impacts of a block take (h / b) (1 - r) / (1 + r), of both the larger; the demand is the largest of all."""
    contact = rk.free_rocking(BLOCK, START, {"left": 0.8, "right": 0.9}).contact
    assert contact.friction_of_impacts == pytest.approx(3.0 * 0.2 / 1.8, rel=1e-13, abs=0.0)
    assert contact.friction_demand == max(contact.friction_of_motion, contact.friction_of_impacts)


def test_at_rest_on_moving_ground() -> None:
    """A body that the ground does not lift is carried: f_x = m a_x, f_z = m (g + a_z), friction their ratio."""
    record = rk.GroundMotion(np.array([0.0, 1.0, -2.0, 0.0]), 0.2, vertical=np.array([0.0, 3.0, -1.0, 0.0]))
    response = rk.simulate(BLOCK, record, R, duration=0.6)
    contact = response.contact
    np.testing.assert_allclose(contact.horizontal, MASS * record.acceleration, rtol=0.0, atol=1e-9)
    assert record.vertical is not None
    np.testing.assert_allclose(contact.vertical, MASS * (g + record.vertical), rtol=1e-13)
    assert contact.friction_demand == pytest.approx(2.0 / (g - 1.0), rel=1e-12, abs=0.0)
    assert contact.least_vertical == pytest.approx(MASS * (g - 1.0), rel=1e-12, abs=0.0)


def test_warnings_of_friction() -> None:
    """Motion and impacts that take more friction than there is are named with what they take; enough keeps quiet."""
    contact = rk.free_rocking(BLOCK, START, 0.5).contact
    assert contact.friction_of_impacts == pytest.approx(1.0, rel=1e-13, abs=0.0)
    low = contact.warnings(0.1)
    assert len(low) == 2
    assert f"Rocking without slip needs a coefficient of friction of {contact.friction_of_motion:.2f}" in low[0]
    assert "With 0.1 the body slides" in low[0]
    assert "Impacts without slip need a coefficient of friction of 1.00. With 0.1 the foot slips" in low[1]
    assert contact.warnings(1.0) == []
    assert len(contact.warnings()) == 1
    assert not contact.loses_contact


@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
@pytest.mark.parametrize(("drop", "flies"), [(-1.02 * g, True), (-0.9 * g, False)])
def test_loss_of_contact(drop: float, flies: bool) -> None:
    """Ground that falls faster than g leaves the body: the force vanishes and a warning says so; slower does not."""
    vertical = np.array([0.0, 0.0, drop, 0.0, 0.0])
    record = rk.GroundMotion(np.array([0.0, 0.0, 0.1, 0.0, 0.0]), 0.02, vertical=vertical)
    contact = rk.simulate(BLOCK, record, R, duration=0.5).contact
    assert contact.loses_contact is flies
    assert (contact.least_vertical <= 0.0) is flies
    said = [w for w in contact.warnings(1e9) if "the body would leave the ground" in w]
    assert len(said) == int(flies)


@pytest.mark.slow
def test_simulate_warns_where_sliding_would_follow() -> None:
    """`doubts` of a friction too small names what slides; with enough there are none."""
    pulse = rk.pulses.sine(amplitude=4.5, period=0.4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        response = rk.simulate(BLOCK, pulse, R)
    doubts = response.doubts(0.2)
    assert doubts
    assert all("simulate(body, motion, friction=...)" in each for each in doubts)
    assert not response.doubts(5.0)
    assert rk.simulate(BLOCK, pulse, R, friction=0.2).sliding_distance > 0.0
    assert any("Impacts without slip" in each for each in rk.free_rocking(BLOCK, START, R).doubts(0.1))
    with pytest.raises(InvalidValueError, match="friction"):
        rk.simulate(BLOCK, pulse, R, friction=-0.3)


SECTION = rk.Section([rk.Region([(0.0, 0.0), (1.0, 0.0), (0.6, 3.0), (0.1, 3.0)], 1000.0)], feet=(0.05, 0.9))


@pytest.mark.parametrize("foot", ["left", "right"])
def test_friction_of_an_impact_of_an_asymmetric_body(foot: Any) -> None:
    """The impulse is the change of momentum: |Jx / Jz| by the centre's velocities about the old and the new foot."""
    r = {"left": 0.83, "right": 0.71}
    x, h = SECTION.centre
    at = dict(zip(("left", "right"), SECTION.feet, strict=True))
    before, after = (np.array([h, at[each] - x]) for each in ({"left": "right", "right": "left"}[foot], foot))
    jump = r[foot] * after - before  # velocities of the centre at theta' = 1 before: omega times (y, -x) from the foot
    new, old = (SECTION.side(each) for each in (foot, {"left": "right", "right": "left"}[foot]))
    found = equations.friction_of_impact(new.centre_height, old.half_width, new.half_width, r[foot])
    assert float(found) == pytest.approx(abs(jump[0] / jump[1]), rel=1e-12, abs=0.0)


def test_largest_friction_of_impacts_of_an_asymmetric_body() -> None:
    """A response takes the larger of both feet's, each with its own levers."""
    r = {"left": 0.5, "right": 0.4}
    contact = rk.free_rocking(SECTION, 0.1, r).contact
    x, h = SECTION.centre
    left, right = x - SECTION.feet[0], SECTION.feet[1] - x
    expected = max(
        h * (1.0 - r["left"]) / (right + r["left"] * left), h * (1.0 - r["right"]) / (left + r["right"] * right)
    )
    swapped = max(
        h * (1.0 - r["left"]) / (left + r["left"] * right), h * (1.0 - r["right"]) / (right + r["right"] * left)
    )
    assert contact.friction_of_impacts == pytest.approx(expected, rel=1e-12, abs=0.0)
    assert abs(swapped / expected - 1.0) > 0.05, "levers that differ"


@pytest.mark.parametrize("foot", ["left", "right"])
def test_energy_bound_of_an_asymmetric_body(foot: Any) -> None:
    """r^2 I_new may not exceed I_old, with moments about the feet by Steiner from the centre's: above it is refused,
    below it is taken, also where that is r > 1."""
    x, h = SECTION.centre
    about = {"left": (x - SECTION.feet[0]) ** 2, "right": (SECTION.feet[1] - x) ** 2}
    inertia = {each: SECTION.moment_of_inertia + SECTION.mass * (h**2 + arm) for each, arm in about.items()}
    other = {"left": "right", "right": "left"}[foot]
    most = math.sqrt(inertia[other] / inertia[foot])
    assert abs(most - 1.0) > 0.01
    r = {foot: 0.9999 * most, other: 0.5}
    assert rk.free_rocking(SECTION, 0.05, r).impacts.size
    with pytest.raises(InvalidValueError, match=f"onto the {foot} foot must be in .0, {most:.6g}.*create energy"):
        rk.free_rocking(SECTION, 0.05, {**r, foot: 1.0001 * most})


@pytest.mark.parametrize("share", [2.0, -2.0, 4.0])
def test_energy_of_a_body_that_only_falls_closes(share):
    """Let go at twice alpha it has no energy over standing, so that what does not add up is compared with its fall."""
    assert rk.free_rocking(BLOCK, share * BLOCK.slenderness_angle, 0.9).energy.closure < 1e-10


# What limits the closure is the ledger, not the engines: the work integrates the quintic through both ends of every
# interval, whose error grows with the sixth power of its length and with the slope of the record. Intervals up to
# p h = 0.1 are one quintic; at 0.02 s and the 1.5 g spike of Cape Mendocino that leaves 5e-9. Kinks of the record
# are ends of intervals, so that no quadrature runs across one.
CLOSURE = 2e-8
SHORT = 1e-10
"""Closure if intervals are cut to p h <= 0.02, so that quintics do not limit it [-]."""

STRONGEST: dict[str, dict[str, Any]] = {
    "peer/CPM000.AT2": {},
    "plain_values/tabasFN.txt": {"units": "g", "time_step": 0.02},
    "two_column/CHV1-20140203E.txt": {"units": "cm/s2"},
    "two_column/Kobe.dat": {"units": "m/s2"},
}
"""Those of largest peak, as their description lists them: 1.50, 0.90, 0.76 and 0.69 g."""

SLENDER = rk.Block(width=0.5, height=2.0)


def rocked(folder: Path, name: str, engine: str) -> rk.Response:
    """Return the response of the block to a record."""
    return rk.simulate(SLENDER, rk.read_motion(folder / name, **STRONGEST[name]), "ked", engine=engine)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", STRONGEST)
def test_closes(shared_records: Path, name: str, engine: str) -> None:
    """Nothing is left over beyond 2e-8 of the largest energy, over ten impacts and more."""
    response = rocked(shared_records, name, engine)
    assert response.impacts.size > 10
    assert response.energy.closure < CLOSURE


@pytest.mark.slow
@pytest.mark.parametrize("name", STRONGEST)
def test_long_intervals_limit_it(shared_records: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut to a fifth, the intervals close to 1e-10: the same history, so the engine is not what was open."""
    monkeypatch.setattr(dense_output, "LONG", 0.02)
    assert rocked(shared_records, name, "auto").energy.closure < SHORT


@pytest.mark.slow
@pytest.mark.parametrize("name", STRONGEST)
def test_sees_a_wrong_loss(shared_records: Path, name: str) -> None:
    """Negative control: one part in 100 000 more lost at the impacts, or work done, does not close."""
    energy = rocked(shared_records, name, "auto").energy
    for part in ("lost", "work"):
        wrong = replace(energy, **{part: (1.0 + 1e-5) * getattr(energy, part)})
        assert wrong.closure > 10.0 * CLOSURE
