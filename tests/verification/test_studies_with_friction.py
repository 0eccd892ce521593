"""Studies of bodies that may slide, hop and fly: what the reference engine gives one by one, and what is known."""

import numpy as np
import pytest
from random_cases import noise_motion, section

import rocking as rk
from rocking.conventions import g
from rocking.dynamics import ContactSettings, RandomRestitution, RockingParameters
from rocking.dynamics.batch import Batch
from rocking.dynamics.mechanics import study_settings
from rocking.dynamics.parameters import sides_of
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome, Status
from rocking.studies import MotionList, Product, minimum_overturning_acceleration, overturning_map, rocking_spectrum
from rocking.studies.fragility import fragility_analysis
from rocking.studies.histories import results_of
from rocking.studies.sensitivity import SampledRestitution

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="sliding, hopping and flight")]
BODY = section(4)
PULSE = rk.pulses.sine(amplitude=3.0, period=0.6)
BLOCK = rk.Block(width=0.5, height=1.2)
TANGENT = 0.5 / 1.2


@pytest.mark.verifies("second engine", "the reference engine, one history at a time", within="1e-9")
@pytest.mark.parametrize("restitution", [None, "ked", {"left": 0.7, "right": 0.6}])
def test_a_map_is_its_single_histories(restitution):
    """Cell by cell the reference engine, which follows one history, of a body without symmetry; time is stretched."""
    periods, amplitudes = [0.3, 0.6, 1.1], [5.0, 9.0, 14.0]
    found = overturning_map(
        BODY, PULSE, ("period", periods), ("pga", amplitudes), restitution, friction=0.45, normal_restitution=0.1
    )
    for i, amplitude in enumerate(amplitudes):
        for j, period in enumerate(periods):
            pulse = rk.pulses.sine(amplitude=amplitude, period=period)
            one = rk.simulate(BODY, pulse, restitution, friction=0.45, normal_restitution=0.1)
            cell = found.isel(pga=i, period=j)
            assert int(cell.outcome) == one.outcome.code
            assert float(cell.impacts) == len(one.impacts)
            assert abs(float(cell.peak_rotation)) == pytest.approx(one.peak_rotation, rel=1e-9, abs=1e-15)
            if one.outcome is Outcome.OVERTURNED:
                assert float(cell.overturning_time) == pytest.approx(one.overturning_time, rel=1e-9)
    assert len(set(found.outcome.values.ravel().tolist())) > 1


@pytest.mark.verifies("closed form", "a body slides before it rocks where friction is below tan alpha", within="exact")
def test_sliding_before_rocking():
    """Under a motion that starts from nothing a block first slides at mu g, or first lifts at g tan alpha."""
    friction, levels = [0.2, 0.41, 0.42, 0.9], [1.9, 2.0, 4.0, 4.1, 9.0]
    found = overturning_map(BLOCK, PULSE, ("friction", friction), ("pga", levels), restitution="ked")
    for i, level in enumerate(levels):
        for j, mu in enumerate(friction):
            outcome = list(Outcome)[int(found.outcome[i, j])]
            share = level / g
            if share <= min(mu, TANGENT):
                assert outcome is Outcome.NO_UPLIFT
            elif mu < TANGENT:
                assert outcome is Outcome.SLID
                assert int(found["mode"][i, j]) == -2
            else:
                assert outcome in {Outcome.ROCKED, Outcome.OVERTURNED, Outcome.ROCKED_AND_SLID}


@pytest.mark.verifies("second engine", "the engine of pure rocking", within="1e-9")
def test_rough_ground_is_pure_rocking():
    """Imposed coefficients and feet that never slide: the engine of pure rocking, which shares nothing with this one.

    The negative control: with little friction the same cells differ.
    """
    axes = ("frequency_ratio", np.linspace(1.0, 6.0, 9)), ("amplitude_ratio", np.linspace(1.0, 6.0, 9))
    pure = overturning_map(BODY, PULSE, *axes, "ked")
    rough, smooth = (overturning_map(BODY, PULSE, *axes, "ked", friction=mu) for mu in (1e3, 0.3))
    kept = (pure.lost_contact == 0.0) & (pure.still_rocking == 0.0)
    assert int(kept.sum()) > 40
    same = pure["mode"] == rough["mode"]
    assert bool(same.where(kept, True).all())
    change = np.abs(pure.peak_rotation - rough.peak_rotation).where(kept & (pure.outcome != 2), 0.0)
    assert float(change.max()) < 1e-9
    assert int((smooth["mode"] != pure["mode"]).where(kept, False).sum()) > 5


@pytest.mark.verifies("second engine", "the reference engine with each drawn coefficient", within="1e-9")
def test_a_draw_for_each_history():
    """Coefficients drawn once for a history are the same as given one by one."""
    law = SampledRestitution.normal(0.8, 0.05, seed=3)
    found = overturning_map(BLOCK, PULSE, ("scale", [1.4, 1.6, 1.8]), ("friction", [0.5, 0.6]), law)
    single = overturning_map(BLOCK, PULSE, ("scale", [1.4, 1.6, 1.8]), ("friction", [0.5, 0.6]), 1.0, friction=None)
    draws = law.draws(np.arange(6)).reshape(2, 3)
    for i, mu in enumerate((0.5, 0.6)):
        for j, scale in enumerate((1.4, 1.6, 1.8)):
            one = rk.simulate(BLOCK, PULSE, float(draws[i, j]), scale=scale, friction=mu)
            assert abs(float(found.peak_rotation[i, j])) == pytest.approx(one.peak_rotation, rel=1e-9)
    assert float(abs(single.peak_rotation - found.peak_rotation).max()) > 0.0


@pytest.mark.verifies("second engine", "the reference engine", within="1e-9")
def test_rows_that_start_turned():
    """A row with a rotation and a velocity starts on the foot that it leans on, as `simulate` does."""
    parameters = RockingParameters.of_body(BODY, "ked", g)
    motion = noise_motion(2, 400, 0.01, 2.0)
    rotation, velocity = [0.05, -0.04, 0.0], [0.1, 0.2, -0.3]
    rows = Rows.of(3, rotation=rotation, velocity=velocity, **{k: v[0] for k, v in sides_of([parameters]).items()})
    found, _ = Batch([motion.segments()], settings=ContactSettings(friction=0.35)).run(3, rows.part)
    for k in range(3):
        one = rk.simulate(BODY, motion, "ked", rotation=rotation[k], angular_velocity=velocity[k], friction=0.35)
        assert found["outcome"][k] == one.outcome.code
        assert abs(found["peak_rotation"][k]) == pytest.approx(one.peak_rotation, rel=1e-9)


@pytest.mark.verifies("second engine", "the reference engine, and a map", within="1e-9")
def test_one_word_and_one_range_at_every_door():
    """The word of files and options is Python's too, and a smooth ground is one: nothing holds the body back."""
    for how in ({}, {"restitution": "complementarity"}):
        one = rk.simulate(BODY, PULSE, **({"restitution": None} | how), scale=2.0, friction=0.4)
        many = rk.simulate_many(BODY, PULSE, **({"restitution": None} | how), scale=[2.0], friction=[0.4])
        drawn = overturning_map(
            BODY, PULSE, ("scale", [2.0]), ("friction", [0.0, 0.4]), **({"restitution": None} | how)
        )
        peaks = [one.peak_rotation, abs(many.peak_rotation.item()), abs(float(drawn.peak_rotation[1, 0]))]
        assert peaks == pytest.approx([peaks[0]] * 3, rel=1e-9)
        assert int(drawn.outcome[0, 0]) == rk.simulate(BODY, PULSE, None, scale=2.0, friction=0.0).outcome.code
    with pytest.raises(InvalidValueError, match="needs friction"):
        rk.simulate(BODY, PULSE, None)
    hops = noise_motion(5, 400, 0.01, 0.5, vertical=14.0)
    flat = fragility_analysis(BLOCK, MotionList([hops] * 2), [0.5], friction=5.0, restitution="ked")
    assert not flat.responses.rocked.any() or (flat.responses.rotation[flat.responses.rocked] > 0.0).all()


@pytest.mark.verifies("second engine", "the engine of pure rocking on rough ground", within="1e-6")
def test_every_study():
    """Spectra, minima and stripes; a body that slides first has no level above which rocking is certain."""
    spectrum = rocking_spectrum(PULSE, [0.2, 0.4], [2.0, 3.0], 0.8, scale=1.5, friction=0.3)
    assert spectrum["mode"].sel(slenderness_angle=0.4).values.tolist() == [[-2, -2]]
    free, held = (minimum_overturning_acceleration(BLOCK, PULSE, "ked", friction=mu).minimum for mu in (0.44, 1e3))
    pure = minimum_overturning_acceleration(BLOCK, PULSE, "ked").minimum
    assert held == pytest.approx(pure, rel=1e-6)
    assert free is None or free > held
    motions = MotionList([noise_motion(k, 600, 0.01, 3.0) for k in range(6)])
    rough, smooth = (
        fragility_analysis(BLOCK, motions, [3.0, 5.0, 7.0], friction=mu, restitution="ked") for mu in (0.6, 0.3)
    )
    assert rough.uplift.contradictions == 0
    assert rough.uplift.checked == 18
    assert smooth.uplift.threshold is None
    assert not (smooth.responses.rotation > 0.0).any()


@pytest.mark.verifies("behaviour")
def test_the_name_of_histories_knows_the_friction():
    """Two studies that differ in friction, bounce or its law have different names, and results."""
    sides = {
        f"{name}_{foot}": np.array([[value]])
        for foot in ("left", "right")
        for name, value in (("alpha", 0.35), ("p", 3.0), ("r", 0.8), ("q", 0.75), ("share", 1.0))
    }
    ways = [{}, {"friction": 0.5}, {"friction": 0.6}, {"friction": 0.5, "normal_restitution": 0.3},
            {"friction": 0.5, "normal_restitution": 0.3, "normal_restitution_law": "stronge"}]  # fmt: skip
    several = [Product(MotionList([PULSE]), sides, np.array([1.6]), settings=study_settings(None, way)) for way in ways]
    assert len({each.key() for each in several}) == len(ways)
    peaks = [abs(results_of(each)["peak_rotation"][0]) for each in several[:4]]
    assert len(set(peaks)) > 1


@pytest.mark.parametrize(
    ("how", "says"),
    [
        ({"friction": -0.3}, "friction must be in"),
        ({"friction": 2e6}, "friction must be in"),
        ({"friction": 0.3, "normal_restitution": 1.0}, "normal_restitution must be"),
        ({"friction": 0.3, "normal_restitution_law": "hertz"}, "normal_restitution_law must be one of"),
        ({"normal_restitution": 0.3}, "normal_restitution does not apply to a plane body without friction,"),
        ({"friction": 0.3, "linear": True}, "linear does not apply to a plane body with friction"),
        ({"friction": 0.3, "order": 6}, "order does not apply to a plane body with friction"),
        ({"friction": 0.3, "engine": "reference"}, "studies with friction need the compiled engine"),
        ({"friction": 0.3, "restitution": RandomRestitution.normal(0.8, 0.02, seed=1)}, "must be constant within"),
    ],
)
@pytest.mark.verifies("damage")
def test_refusals(how, says):
    """What cannot be meant is refused in one sentence."""
    with pytest.raises(InvalidValueError, match=says):
        overturning_map(BLOCK, PULSE, ("scale", [1.0]), ("period", [0.6]), **how)


@pytest.mark.verifies("damage")
def test_friction_is_said_once():
    """As an axis or as a number."""
    with pytest.raises(InvalidValueError, match="Remove friction"):
        overturning_map(BLOCK, PULSE, ("friction", [0.3]), ("scale", [1.0]), friction=0.3, restitution="ked")
    with pytest.raises(InvalidValueError, match="restitution"):
        overturning_map(BLOCK, PULSE, ("period", [0.6]), ("scale", [1.0]), None)


@pytest.mark.verifies("damage")
def test_a_coefficient_that_creates_energy_is_no_result():
    """Beyond the bound of an uneven body a cell fails, with friction as without; none imposed is another answer."""
    axes = ("restitution", [0.5, 0.95, 1.0]), ("scale", [1.2])
    inertia = [BODY.side(foot).moment_of_inertia for foot in ("left", "right")]
    most = np.sqrt(min(inertia) / max(inertia))
    for how in ({}, {"friction": 1e3}):
        found = overturning_map(BODY, PULSE, *axes, **how)
        within = found["restitution"].values <= most
        assert ((found["mode"].values[0] == -3) == ~within).all()
        assert set(within.tolist()) == {True, False}
    plastic = overturning_map(BODY, PULSE, ("period", [0.6]), ("scale", [1.2]), None, friction=1e3)
    assert int(plastic["mode"][0, 0]) != -3


@pytest.mark.verifies("damage")
def test_poisoned_rows():
    """A row with NaN or infinity in one number is refused by itself; its neighbours keep their bits."""
    parameters = RockingParameters.of_body(BODY, "ked", g)
    sides = {name: float(values[0]) for name, values in sides_of([parameters]).items()}
    names = [*(name for name in sides if name[0] in "apqr"), "scale", "rotation", "velocity"]
    values = {name: np.full(60, sides.get(name, 0.0)) for name in [*sides, "rotation", "velocity"]}
    values |= {"scale": np.linspace(0.5, 2.0, 60), "friction": np.full(60, 0.4)}
    batch = Batch([PULSE.segments()], settings=ContactSettings(friction=0.3))
    clean, _ = batch.run(60, Rows.of(60, **values).part)
    ill = np.arange(1, 60, 3)
    for k, row in enumerate(ill):
        values[[*names, "friction"][k % (len(names) + 1)]][row] = (np.inf, -np.inf)[k % 2]
    values["alpha_left"][3], ill = np.nan, np.append(ill, 3)
    found, _ = batch.run(60, Rows.of(60, **values).part)
    fine = np.setdiff1d(np.arange(60), ill)
    assert (found["status"][ill] == Status.INVALID.code).all()
    assert (found["outcome"][ill] == Outcome.FAILED.code).all()
    for name in ("peak_rotation", "impacts", "outcome"):
        assert found[name][fine].tolist() == clean[name][fine].tolist()


@pytest.mark.verifies("behaviour")
def test_commands(run, answered):
    """The option and the key give one map; both at once are refused."""
    words = ["map", "--width", "0.5", "--height", "1.2", "sine:amplitude=3,period=0.6"]
    axes = ["--x", "scale=1:3:5", "--y", "period=0.4:0.8:3"]
    ways = ["--friction", "0.5"], ["--set", "settings.friction=0.5"], ["--friction", "0.3"]
    modes = [answered(*words, *axes, *how)["mode"] for how in ways]
    assert modes[0] == modes[1]
    assert modes[0] != modes[2]
    code, _, err = run(*words, *axes, *ways[0], *ways[1])
    assert code == 2
    assert "set the same key" in err
    assert answered(*words, *axes, *ways[0], "--restitution", "complementarity")["mode"] != modes[0]
