"""Studies of bodies with restraints: single histories, closed forms of uplift, states of restraints, refusals."""

import numpy as np
import pytest

import rocking as rk
from rocking.conventions import g
from rocking.dynamics import RandomRestitution
from rocking.dynamics.mechanics import study_settings
from rocking.errors import InvalidValueError
from rocking.studies import MotionList, minimum_overturning_acceleration, minimum_overturning_accelerations
from rocking.studies.fragility import fragility_analysis, model_of, to_csv
from rocking.studies.fragility.limit_states import LimitState
from rocking.studies.fragility.subject import Subject
from rocking.studies.sensitivity import SampledRestitution

pytestmark = pytest.mark.verifies(room="studies")

WALL = rk.Block(width=1.0, height=6.0, mass=4000.0)
PULSES = [rk.pulses.sine(1.0, period) for period in (0.4, 0.6, 0.8, 1.0, 1.4)]
LEVELS = [2.0, 4.0, 6.0, 10.0, 14.0]
SKEW = rk.MassPoints(
    [[0.2, 0.1], [0.9, 0.2], [0.5, 3.0], [0.6, 6.0]], [900.0, 800.0, 1000.0, 700.0], feet=(0.0, 1.2)
)  # fmt: skip
TENDON = {"x": 0.5, "stiffness": 500e3, "prestress": 20e3, "yield_force": 50e3, "rupture_elongation": 0.12}
RESTRAINTS = [
    rk.Tendon(**TENDON), rk.Fuse(x=1.0, length=0.3, stiffness=5e6, yield_force=4e3, hardening=0.02),
    rk.ViscousDamper(x=0.1, length=0.3, coefficient=2e4),
]  # fmt: skip
TIED = rk.Restrained(SKEW, RESTRAINTS)


@pytest.mark.verifies("computed anew", "the same histories, one by one", within="exact counts, 1e-9 of the peak")
def test_states_of_a_fragility_are_those_of_its_single_histories():
    """Counts of rocking, rotation, yield, rupture and overturning, of a body without symmetry."""
    states = (0.3, "yield", "rupture", "yield of fuse 1", "yield of tendon 1")
    analysis = fragility_analysis(TIED, PULSES, LEVELS, "housner", limit_states=states)
    counts = {name: np.zeros(len(LEVELS), int) for name in analysis.counts}
    for i, pulse in enumerate(PULSES):
        for j, level in enumerate(LEVELS):
            response = rk.simulate(TIED, pulse.scaled(level), "housner")
            rows = {row["restraint"]: row for row in response.restraints.records}
            overturned, rotation = response.outcome is rk.Outcome.OVERTURNED, analysis.responses.rotation[i, j]
            if not overturned:
                assert rotation == pytest.approx(response.peak_ratio, rel=1e-9, abs=1e-15)
            counts["rocking"][j] += response.outcome in {rk.Outcome.ROCKED, rk.Outcome.OVERTURNED}
            counts["rotation > 0.3 alpha"][j] += overturned or response.peak_ratio > 0.3
            counts["yield"][j] += overturned or any(row["yield_count"] > 0 for row in rows.values())
            counts["rupture"][j] += overturned or any(row["is_broken"] for row in rows.values())
            for name in ("fuse 1", "tendon 1"):
                counts[f"yield of {name}"][j] += overturned or rows[name]["yield_count"] > 0
            counts["overturned"][j] += overturned
    assert {name: values.tolist() for name, values in analysis.counts.items()} == {
        name: values.tolist() for name, values in counts.items()
    }
    assert len({tuple(values) for values in counts.values()}) >= 4  # the states differ
    assert counts["rupture"].tolist() != counts["overturned"].tolist()
    assert counts["yield of fuse 1"].tolist() != counts["yield of tendon 1"].tolist()


@pytest.mark.verifies("closed form", "moments of weight, prestress and slip about both feet", within="1e-12")
def test_uplift_accelerations():
    """a = (m g b + N l) / (m h), with the distances b and l of weight and restraint to the foot."""
    tendon, damper = (
        rk.Tendon(x=0.2, stiffness=1e6, prestress=30e3),
        rk.FrictionDamper(x=0.9, length=1.0, slip_force=8e3),
    )
    weight, height = 4000.0 * g * 0.5, 4000.0 * 3.0
    cases = {
        (tendon,): ((weight + 30e3 * 0.8) / height, (weight + 30e3 * 0.2) / height),
        (tendon, damper): (
            (weight + 30e3 * 0.8 + 8e3 * 0.1) / height,
            (weight + 30e3 * 0.2 + 8e3 * 0.9) / height,
        ),
    }  # fmt: skip
    for restraints, expected in cases.items():
        tied = rk.Restrained(WALL, restraints)
        subject = Subject.of(tied, PULSES, "housner", "pga", {})
        assert subject.uplift_accelerations == pytest.approx(expected, rel=1e-12)
        assert subject.uplift_threshold is None  # its sides differ
        assert subject.lowest_uplift == pytest.approx(min(expected), rel=1e-12)
        outcomes = [rk.simulate(tied, PULSES[1].scaled(f * min(expected))).outcome for f in (0.9999, 1.0001)]
        # the first half of the pulse turns the body to the left, about the left foot
        assert outcomes == [rk.Outcome.NO_UPLIFT, rk.Outcome.ROCKED]
    # a tendon that pulls the top to the side with more than the weight can balance
    pulled = rk.Restrained(WALL, rk.Tendon(ground=(5.0, 6.0), point=(1.0, 6.0), stiffness=1e3, prestress=5e3))
    with pytest.raises(InvalidValueError, match="the restraints lift it"):
        fragility_analysis(pulled, PULSES, LEVELS, "housner")


@pytest.mark.verifies("closed form", "a tendon without stiffness and a damper without coefficient", within="1e-9")
def test_restraints_without_effect():
    """The study of the free body, which an elastic tendon changes."""
    nothing = rk.Restrained(
        WALL, [rk.Tendon(x=0.5, stiffness=0.0), rk.ViscousDamper(x=0.1, length=0.5, coefficient=0.0)]
    )
    tied, free = (fragility_analysis(body, PULSES, LEVELS, "ked") for body in (nothing, WALL))
    assert np.array_equal(tied.responses.outcome, free.responses.outcome)
    np.testing.assert_allclose(tied.responses.rotation, free.responses.rotation, rtol=1e-9, atol=1e-12)
    elastic = fragility_analysis(rk.Restrained(WALL, [rk.Tendon(x=0.5, stiffness=5e4)]), PULSES, LEVELS, "ked")
    assert not np.array_equal(elastic.responses.outcome, free.responses.outcome)


@pytest.mark.verifies("computed anew", "single histories just below and above", within="1e-6")
def test_the_smallest_overturning_acceleration_separates_single_histories():
    """A prestressed wall overturns above the minimum, which exceeds the minimum of the free wall."""
    tied = rk.Restrained(WALL, [rk.Tendon(x=0.5, stiffness=5e4, prestress=5e3)])
    pulse = rk.pulses.sine(1.0, 1.4)
    lowest = minimum_overturning_acceleration(tied, pulse, "housner", samples=40)
    assert lowest.minimum is not None
    below, above = (
        rk.simulate(tied, pulse.scaled(f * lowest.minimum), "housner").outcome for f in (1 - 1e-6, 1 + 1e-6)
    )
    assert (below, above) == (rk.Outcome.ROCKED, rk.Outcome.OVERTURNED)
    free = minimum_overturning_acceleration(WALL, pulse, "housner", samples=40)
    assert lowest.minimum > free.minimum


@pytest.mark.verifies("computed anew", "the same histories, one by one", within="exact damage, 1e-9 rad")
def test_a_map_with_restraints_contains_residual_rotation_and_damage():
    """Residual rotation and the restraints that yielded or broke, of a body without symmetry."""
    levels, coefficients = [2.0, 6.0, 14.0], [0.5, 0.8]
    cells = rk.overturning_map(TIED, PULSES[2], ("pga", levels), ("restitution", coefficients))
    for i, coefficient in enumerate(coefficients):
        for j, level in enumerate(levels):
            response = rk.simulate(TIED, PULSES[2].scaled(level), coefficient)
            cell, rows = cells.isel(restitution=i, pga=j), response.restraints.records
            if response.outcome is rk.Outcome.OVERTURNED:
                continue
            assert float(cell["residual_rotation"]) == pytest.approx(response.residual_rotation, abs=1e-9)
            assert int(cell["yielded_restraints"]) == sum((row["yield_count"] > 0) << k for k, row in enumerate(rows))
            assert int(cell["broken_restraints"]) == sum(bool(row["is_broken"]) << k for k, row in enumerate(rows))
    assert len(np.unique(cells["yielded_restraints"])) > 1  # damage differs between the cells
    assert cells["residual_rotation"].attrs["units"] == "rad"
    free = rk.overturning_map(WALL, PULSES[2], ("pga", levels), ("restitution", coefficients))
    assert not {"residual_rotation", "yielded_restraints", "broken_restraints"} & set(free)


@pytest.mark.verifies("damage")
def test_what_a_study_with_restraints_refuses():
    """Other bodies, dimensions, stretched time and unknown states are refused in one sentence."""
    tied = rk.Restrained(WALL, [rk.Tendon(x=0.5, stiffness=5e4)])
    other = rk.Restrained(WALL, [rk.Tendon(x=0.5, stiffness=6e4)])
    pulse = PULSES[0]
    equal = rk.Restrained(WALL, [rk.Tendon(x=0.5, stiffness=5e4)])
    minimum_overturning_accelerations([tied, equal], pulse, "housner", samples=4, bisections=0)
    with pytest.raises(InvalidValueError, match="one body with restraints"):
        minimum_overturning_accelerations([tied, other], pulse, "housner", samples=4)
    for axis in ("period", "duration", "semi_diagonal", "width", "slenderness_ratio", "frequency_ratio"):
        with pytest.raises(InvalidValueError, match="cannot vary for a body with restraints"):
            rk.overturning_map(tied, pulse, ("pga", [2.0, 4.0]), (axis, [0.5, 0.6]))
    with pytest.raises(InvalidValueError, match="cannot vary for a body with restraints"):
        rk.overturning_map(tied, pulse, ("pga", [2.0, 4.0]), ("pgv", [0.5, 0.6]))
    for body, state in (
        (tied, "yield of fuse 1"), (tied, "yield"), (TIED, "yield of viscous damper 1"), (TIED, "rupture of fuse 1"),
        (WALL, "rupture"),
    ):  # fmt: skip
        with pytest.raises(InvalidValueError, match="no restraint of the body can reach"):
            rk.fragility(body, PULSES, LEVELS, limit_states=[state])
    with pytest.raises(InvalidValueError, match="must be rotations / alpha"):
        rk.fragility(TIED, PULSES, LEVELS, limit_states=["yield of "])
    with pytest.raises(InvalidValueError, match="without commas"):
        rk.Fuse(x=0.5, stiffness=1e6, name="left, lower")
    with pytest.raises(InvalidValueError, match="must be rotations / alpha"):
        rk.fragility(tied, PULSES, LEVELS, limit_states=["yielding"])


@pytest.mark.verifies("behaviour")
def test_curves_of_restraints_stay_as_fitted_and_files_with_an_order_refuse_them(tmp_path):
    """States of restraints have no order with states of the rotation."""
    analysis = fragility_analysis(TIED, PULSES, np.geomspace(3.0, 20.0, 12), "housner", limit_states=[0.2, "rupture"])
    model = model_of(analysis, "wall")
    curve = next(curve for curve in model.curves if curve.state == "rupture")
    assert curve.median == analysis.fits["rupture"].median
    with pytest.raises(InvalidValueError, match="limit states in an order, without states of restraints, got rupture"):
        to_csv(model, tmp_path / "wall.csv", "fema-p58")
    to_csv(model_of(analysis, "wall", limit_states=["overturned"]), tmp_path / "wall.csv", "fema-p58")


@pytest.mark.verifies("computed anew", "single histories with the sampled coefficients", within="1e-9")
def test_one_coefficient_is_sampled_for_a_history():
    """Each history has its own coefficient; a coefficient for each impact is refused."""
    law = SampledRestitution.normal(0.85, 0.03, seed=3)
    rotations = fragility_analysis(TIED, PULSES[:2], LEVELS[2:4], law).responses.rotation
    fixed = fragility_analysis(TIED, PULSES[:2], LEVELS[2:4], 0.85).responses.rotation
    assert not np.allclose(rotations, fixed, rtol=1e-6)
    draws = law.draws(np.arange(4)).reshape(2, 2)
    for i, pulse in enumerate(PULSES[:2]):
        for j, level in enumerate(LEVELS[2:4]):
            response = rk.simulate(TIED, pulse.scaled(level), float(draws[i, j]))
            assert rotations[i, j] == pytest.approx(response.peak_ratio, rel=1e-9)
    with pytest.raises(InvalidValueError, match="constant within a history"):
        fragility_analysis(TIED, PULSES, LEVELS, RandomRestitution.normal(0.8, 0.02, seed=1))


@pytest.mark.verifies("behaviour")
def test_an_assumed_density_affects_the_rotations_of_a_body_with_restraints():
    """In the assumptions and in the answer; of the free body it does not."""
    free = rk.Block(width=1.0, height=6.0)
    tied = rk.Restrained(free, rk.Tendon(x=0.5, stiffness=5e5))
    for texts in (tied.assumed, tied.answer()["assumed"]):
        assert any("with restraints or a base it affects rotations" in text for text in texts)
        assert not any("not rotations" in text for text in texts)
    assert any("not rotations" in text for text in free.assumed)


@pytest.mark.verifies("behaviour")
def test_the_identity_of_histories_contains_the_restraints():
    """Another stiffness gives another key of the histories, and the same stiffness the same key."""
    keys = set()
    for stiffness in (5e4, 6e4, 5e4):
        tied = rk.Restrained(WALL, [rk.Tendon(x=0.5, stiffness=stiffness)])
        keys.add(Subject.of(tied, MotionList(PULSES), "housner", "pga", {}).product(np.ones(1)).key())
    assert len(keys) == 2
    assert "body" not in study_settings(TIED, {}).stated  # which are the options of a study


@pytest.mark.verifies("behaviour")
def test_a_body_that_friction_holds_has_rocked():
    """Stuck dampers hold the wall tilted: each lesser state has at least the counts of a worse one."""
    dampers = [rk.FrictionDamper(x=x, length=0.5, slip_force=12e3) for x in (0.0, 1.0)]
    analysis = fragility_analysis(
        rk.Restrained(WALL, dampers), PULSES[1:4], [4.0, 6.0, 8.0, 10.0], "housner", limit_states=[0.1]
    )
    assert np.any(analysis.responses.outcome == rk.Outcome.HELD.code)
    assert np.all(analysis.counts["rocking"] >= analysis.counts["rotation > 0.1 alpha"])
    assert analysis.uplift.contradictions == 0
    assert "not computed" in analysis.responses.contact


@pytest.mark.verifies("behaviour")
def test_a_curve_of_overturning_above_the_curve_of_yield_is_noted():
    """An overturned body has reached yield, but separately fitted curves may cross; overturning stays the last."""
    tied = rk.Restrained(WALL, [rk.Tendon(**TENDON | {"yield_force": 32e3})])
    pulses = [rk.pulses.sine(1.0, period) for period in np.linspace(0.5, 3.0, 12)]
    levels = np.geomspace(2.8, 14.0, 8)
    model = model_of(fragility_analysis(tied, pulses, levels, "housner", limit_states=["yield"]), "wall")
    yielded, overturned = (next(c for c in model.curves if c.state == name) for name in ("yield", "overturned"))
    assert np.any(overturned.probability(levels) > yielded.probability(levels) + 0.01)
    assert "The curves of restraints stay as fitted: at " in model.adjusted
    assert [curve.state for curve in model.curves][-2:] == ["yield", "overturned"]


@pytest.mark.verifies("behaviour")
def test_an_overturned_body_has_reached_every_state():
    """Also the yield of a restraint without a yield force."""
    analysis = fragility_analysis(TIED, PULSES[-1:], [40.0], "housner", limit_states=["rupture of tendon 1"])
    assert analysis.responses.overturned.all()
    assert analysis.responses.exceed(LimitState("", damage="yield", restraint="viscous damper 1")).all()
