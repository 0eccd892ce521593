"""`simulate_many`: the table that it gives, and that each entry is what `simulate` gives for it alone."""

import math
from typing import Any

import numpy as np
import pytest
from engines import built, every_engine

import rocking as rk
from rocking.conventions import DEFAULT_RESTITUTION
from rocking.dynamics import Outcome, Status
from rocking.dynamics.plane import fast_engine
from rocking.restitution import model

pytestmark = pytest.mark.verifies(room="rocking in the plane")

pytest.importorskip("xarray")

# these take rows, whatever their type
SPEED: Any = rk.dynamics.SpeedRestitution
RANDOM: Any = rk.dynamics.RandomRestitution
BODIES = [rk.Block(width=0.5, height=2.0), rk.Block(width=0.4, height=2.4), rk.Block(width=1.0, height=2.0)]
T = np.arange(61)
MOTIONS = [
    rk.GroundMotion(4.0 * np.sin(0.3 * T) * np.sin(math.pi * T / 60.0), 0.05, name="one"),
    rk.GroundMotion(
        3.0 * np.cos(0.25 * T) * np.sin(math.pi * T / 60.0), 0.04, vertical=np.sin(0.9 * T), name="two"
    ),
]  # fmt: skip
CHOICES = ["housner", 0.9, {"left": 0.8, "right": 0.7}]
SCALES = [0.4, 1.0, -1.6]


@pytest.fixture(scope="module")
def tables() -> dict[str, Any]:
    made = {"reference": rk.simulate_many(BODIES, MOTIONS, CHOICES, scale=SCALES, engine="reference")}
    if fast_engine.available():
        made["fast"] = rk.simulate_many(BODIES, MOTIONS, CHOICES, scale=SCALES, engine="fast", threads=2)
    return made


@pytest.mark.slow
@every_engine
def test_labels(name: str, tables: dict[str, Any]) -> None:
    """Dimensions in the order of the question, names of motions, scales, words for the restitutions, units."""
    found = tables[name]
    assert dict(found.sizes) == {"body": 3, "motion": 2, "scale": 3, "restitution": 3}
    assert found["motion"].to_numpy().tolist() == ["one", "two"]
    assert found["scale"].to_numpy().tolist() == SCALES
    assert found["restitution"].to_numpy().tolist() == ["housner", "0.9", "{'left': 0.8, 'right': 0.7}"]
    units = {"peak_rotation": "rad", "peak_velocity": "rad/s", "overturning_time": "s", "impacts": "1", "outcome": "1"}
    for key, unit in units.items():
        assert found[key].attrs["units"] == unit
        assert found[key].dims == ("body", "motion", "scale", "restitution")
    assert found["outcome"].attrs["long_name"].startswith("0 no_uplift, 1 rocked, 2 overturned, 3 failed, 4 slid")
    assert found.attrs["software"] == f"rocking {rk.__version__}"
    assert (found.attrs["setting_gravity"], found.attrs["setting_linear"]) == (9.80665, 0)


@every_engine
def test_entries_are_single_histories(name: str, tables: dict[str, Any]) -> None:
    """Every entry is what `simulate` gives over the motion alone, bit for bit."""
    found = tables[name]
    seen = set()
    for place in np.ndindex(3, 2, 3, 3) if name == "fast" else [(0, 0, 1, 1), (1, 1, 2, 2), (2, 0, 0, 0)]:
        body, motion, scale, choice = place
        record = MOTIONS[motion]
        alone = rk.simulate(
            BODIES[body], record, CHOICES[choice], scale=SCALES[scale], duration=record.duration, engine=name
        )
        run = alone.trajectory
        expected = {
            "outcome": run.outcome.code, "status": run.status.code, "side": run.side, "impacts": run.impacts,
            "peak_rotation": run.peak_rotation, "overturning_time": run.overturning_time, "uplifts": run.uplifts,
            "first_uplift": alone.uplifts[0] if alone.uplifts.size else math.nan,
        }  # fmt: skip
        if run.outcome is not Outcome.OVERTURNED:
            expected |= {
                "peak_time": run.peak_time,
                "peak_velocity": run.peak_velocity,
                "truncation": run.truncation,
            }
        for key, value in expected.items():
            np.testing.assert_array_equal(found[key].to_numpy()[place], value, err_msg=f"{key} at {place}")
        seen.add(run.outcome)
    assert seen == {Outcome.NO_UPLIFT, Outcome.ROCKED, Outcome.OVERTURNED}, "all outcomes are met"


@every_engine
def test_outcomes_are_those_of_long_histories(name: str, tables: dict[str, Any]) -> None:
    """What energy decides at the end of the motion is what following the body for 15 / p after it gives."""
    found = tables[name]
    for body in range(3):
        alone = rk.simulate(BODIES[body], MOTIONS[0], 0.9, scale=-1.6, engine=name)
        assert int(found["outcome"][body, 0, 2, 1]) == alone.outcome.code
        assert abs(float(found["peak_rotation"][body, 0, 2, 1])) == pytest.approx(alone.peak_rotation, rel=1e-9)


@pytest.mark.verifies("second engine", "the reference engine", within="1e-9")
@built
def test_both_engines(tables: dict[str, Any]) -> None:
    """The engines agree on outcomes and counts, and on peaks to 1e-9."""
    fast, slow = tables["fast"], tables["reference"]
    for key in ("outcome", "status", "side", "impacts", "uplifts"):
        np.testing.assert_array_equal(fast[key], slow[key])
    for key in ("peak_rotation", "first_uplift", "overturning_time", "peak_time"):
        np.testing.assert_allclose(fast[key], slow[key], rtol=1e-9)
    assert fast.attrs["work_steps"] > 0
    assert "work_steps" not in slow.attrs


@every_engine
def test_stopped_histories_are_told(name: str, tables: dict[str, Any]) -> None:
    """With two impacts allowed the others are stopped by status; histories of fewer keep their bits."""
    short = rk.simulate_many(BODIES, MOTIONS, CHOICES, scale=SCALES, engine=name, most_events=2)
    whole = tables[name]
    few = whole["impacts"].to_numpy() < 2
    assert 0 < few.sum() < few.size
    stopped = short["status"].to_numpy() == Status.TOO_MANY_EVENTS.code
    np.testing.assert_array_equal(stopped, ~few)
    assert np.isnan(short["peak_rotation"].to_numpy()[stopped]).all()
    for key in short.data_vars:
        np.testing.assert_array_equal(short[key].to_numpy()[few], whole[key].to_numpy()[few])


@every_engine
def test_one_of_each(name: str) -> None:
    """One body, motion, scale and model need no lists; progress is told."""
    done: list[int] = []
    found = rk.simulate_many(BODIES[0], rk.pulses.sine(4.0, 0.6), engine=name, progress=done.append)
    assert dict(found.sizes) == {"body": 1, "motion": 1, "scale": 1, "restitution": 1}
    assert done == [1]
    assert found["restitution"].item() == DEFAULT_RESTITUTION
    assert found["motion"].item() == "sine pulse, 4 m/s2, 0.6 s"


@pytest.mark.slow
@every_engine
def test_random_restitution(name: str) -> None:
    """The k-th history of the table has the draws of key k: it is `simulate` with that key; the label says so."""
    law = RANDOM([0.6, 0.95], 3)
    found = rk.simulate_many(BODIES[0], MOTIONS[0], law, scale=[1.0, 1.0, 1.0], engine=name)
    peaks = found["peak_rotation"].to_numpy().ravel()
    assert len(set(peaks.tolist())) > 1, "one scale, other draws"
    assert found["restitution"].item() == "at random: 0.6 to 0.95 times 1"
    for key in range(3):
        alone = rk.simulate(BODIES[0], MOTIONS[0], law, stream=key, duration=MOTIONS[0].duration, engine=name)
        assert peaks[key] == alone.trajectory.peak_rotation
    speed = rk.simulate_many(BODIES[0], MOTIONS[0], [SPEED([0.0, 1.0], [0.9, 0.5])], engine=name)
    assert speed["restitution"].item() == "of the speed: 0.5 to 0.9 times 1"


def test_models_as_objects() -> None:
    """A model object is labelled by its own label, and gives what its name gives."""
    made = model("housner")
    found = rk.simulate_many(BODIES[0], MOTIONS[0], [made, "housner"], engine="auto")
    assert found["restitution"].to_numpy().tolist() == [made.label, "housner"]
    assert found["peak_rotation"].to_numpy()[0, 0, 0, 0] == found["peak_rotation"].to_numpy()[0, 0, 0, 1]


@built
def test_a_dataset_says_what_it_is() -> None:
    """Engine, seed, bodies and motions can be read off a dataset."""
    law = rk.dynamics.RandomRestitution.normal(0.9, 0.01, seed=7)
    result = rk.simulate_many([rk.Block(width=0.5, height=2.0)], rk.pulses.sine(3.0, 0.6), law)
    assert result.attrs["engine"].startswith("fast (")
    assert result.attrs["seed"] == 7
    assert float(result.slenderness_angle[0]) == rk.Block(width=0.5, height=2.0).slenderness_angle
    assert result.slenderness_angle.attrs["units"] == "rad"
    assert "sine" in str(result.motion_provenance.values[0]).lower()


@built
def test_company_does_not_matter() -> None:
    """A record beside one that has a vertical part, on which the whole batch runs with one, keeps its bits."""
    random = np.random.default_rng(5)
    plain = rk.GroundMotion(random.normal(size=800) * 2.0, 0.02)
    upright = rk.GroundMotion(random.normal(size=800), 0.02, vertical=random.normal(size=800))
    body = rk.Block(width=0.5, height=2.0)
    alone = rk.simulate_many(body, plain, "ked", scale=[0.5, 1.0, 1.5])
    beside = rk.simulate_many(body, [plain, upright], "ked", scale=[0.5, 1.0, 1.5]).isel(motion=[0])
    for name in alone.data_vars:
        np.testing.assert_array_equal(alone[name].values, beside[name].values)


@pytest.mark.slow
@built
def test_a_twin_tells_what_the_integration_leaves_open() -> None:
    """Half a long step changes a peak by the error that it has against steps without error, of order 6 or more.

    Negative controls: a twin with the same steps would say 0, and what the series leave out is no measure of it.
    """
    body = rk.Section([rk.Region([(0.0, 0.0), (0.5, 0.0), (0.3, 2.0), (0.1, 2.0)], 2400.0)])
    record = rk.GroundMotion(4.0 * np.sin(0.9 * np.arange(12) + 0.3), 0.2)
    how: Any = {"scale": np.linspace(0.6, 1.4, 12), "twin": True, "longest_step": 1.0}
    found, true = (rk.simulate_many(body, record, 0.8, engine=name, **how) for name in ("fast", "reference"))
    error = np.abs(np.abs(found["peak_rotation"]) - np.abs(true["peak_rotation"])).to_numpy()
    seen = error > 1e-8
    assert seen.sum() >= 4
    assert not found["twin_flips"].any()

    def tells(change: Any) -> bool:
        return bool(np.all(np.abs(np.asarray(change)[seen] / error[seen] - 1.0) < 0.1))  # a step to the sixth: 1/64

    assert tells(found["twin_change"])
    assert np.all(true["twin_change"] < 1e-12)
    one = rk.simulate_many(body, record, 0.8, engine="fast", **(how | {"twin": False}))
    assert not tells(np.abs(one["peak_rotation"] - found["peak_rotation"]))
    assert not tells(found["truncation"])
    assert not {"twin_change", "twin_flips", "error"} & set(one.data_vars)
    assert found["twin_change"].attrs["units"] == "rad"


@pytest.mark.slow
@every_engine
def test_scales_go_up_to_a_million(name: str) -> None:
    """The ends of the range are in it: a motion of a millionth, scaled by either, is itself or its mirror image."""
    small = rk.GroundMotion(1e-6 * MOTIONS[0].acceleration, 0.05)
    made = rk.simulate_many(BODIES[0], small, 0.9, scale=[1e6, -1e6], engine=name)
    own = rk.simulate_many(BODIES[0], MOTIONS[0], 0.9, scale=[1.0, -1.0], engine=name)
    for key in ("outcome", "peak_rotation"):
        np.testing.assert_allclose(made[key].to_numpy(), own[key].to_numpy(), rtol=1e-9)


STATUE = rk.Section([rk.Region([(-0.35, 0.0), (0.25, 0.0), (0.3, 2.5), (-0.15, 2.2)], density=2400.0)])
ALPHA = {foot: STATUE.side(foot).slenderness_angle for foot in ("right", "left")}
ROTATIONS = [
    0.0, 0.0, 0.0, 0.5 * ALPHA["right"], -0.5 * ALPHA["left"], ALPHA["right"], 1.05 * ALPHA["right"],
    -1.2 * ALPHA["left"], -1.3 * ALPHA["left"], 1.5, 1e-20,
]  # fmt: skip
VELOCITIES = [0.0, 0.3, -0.3, 0.0, 0.2, 0.0, -0.6, 0.0, 2.5, 0.0, -0.2]
COMPARED = ("outcome", "status", "side", "impacts", "uplifts", "peak_rotation", "overturning_time", "least_force")


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize("motion", [*MOTIONS, rk.pulses.sine(2.0, 0.8)], ids=lambda motion: motion.name)
def test_starts_are_those_of_single_histories(name: str, motion: Any) -> None:
    """Every start is what `simulate` gives for it: beyond the slenderness angle, upright with a velocity, either side.

    Negative control: with the signs of the starts reversed the asymmetric body has other results.
    """
    how: Any = {"scale": [0.0, 0.5], "engine": name}
    found = rk.simulate_many(STATUE, motion, [0.9], rotation=ROTATIONS, angular_velocity=VELOCITIES, **how)
    assert found["outcome"].dims == ("body", "motion", "scale", "restitution", "start")
    assert found["initial_rotation"].values.tolist() == ROTATIONS
    assert found["initial_angular_velocity"].attrs["units"] == "rad/s"
    outcomes = set()
    for scale, start in np.ndindex(2, len(ROTATIONS)):
        alone = rk.simulate(
            STATUE, motion, 0.9, scale=how["scale"][scale], rotation=ROTATIONS[start], engine=name,
            angular_velocity=VELOCITIES[start], duration=motion.duration,
        )  # fmt: skip
        one = found.isel(body=0, motion=0, scale=scale, restitution=0, start=start)
        for key in COMPARED:
            value = getattr(alone.trajectory, key)
            np.testing.assert_allclose(one[key], getattr(value, "code", value), rtol=1e-12, err_msg=f"{key} {start}")
        outcomes.add(alone.outcome)
    assert outcomes == {Outcome.NO_UPLIFT, Outcome.ROCKED, Outcome.OVERTURNED}
    listed = [rk.dynamics.Start(-a, -w) for a, w in zip(ROTATIONS, VELOCITIES, strict=True)]
    mirrored = rk.simulate_many(STATUE, motion, [0.9], start=listed, **how)
    assert not np.array_equal(np.abs(mirrored["peak_rotation"]), np.abs(found["peak_rotation"]))


@every_engine
def test_a_basin_ends_where_energy_says(name: str) -> None:
    """On ground at rest theta0 on a side overturns from theta' = p sqrt(2 (1 - cos(alpha - theta0))) outwards on.

    Beyond the slenderness angle the body comes back only if that velocity points inwards; the velocity after the
    impact is r times p sqrt(2 (E / (m g R))), which on the other side must not pass either.
    """
    still, sides = rk.GroundMotion(np.zeros(5), 0.01), [STATUE.side("right"), STATUE.side("left")]
    rotations, velocities, expected = [], [], []
    for sign, side in zip((1.0, -1.0), sides, strict=True):
        alpha, p = side.slenderness_angle, side.frequency_parameter
        for share in (0.0, 0.4, 0.9):
            limit = p * math.sqrt(2.0 * (1.0 - math.cos(alpha * (1.0 - share))))
            rotations += [sign * share * alpha] * 2
            velocities += [sign * 0.999 * limit, sign * 1.001 * limit]
            expected += [0.0, 1.0]
        limit = p * math.sqrt(2.0 * (1.0 - math.cos(0.1 * alpha)))
        rotations += [sign * 1.1 * alpha] * 2
        velocities += [-sign * 0.999 * limit, -sign * 1.001 * limit]
        expected += [1.0, 0.0]
    how: Any = {"rotation": rotations, "angular_velocity": velocities, "engine": name}
    found = rk.simulate_many(STATUE, still, 0.5, **how)
    np.testing.assert_array_equal(found["overturned"].squeeze(), expected)
    symmetric = rk.simulate_many(rk.Block(width=0.5, height=2.0), still, 0.5, **how)
    assert not np.array_equal(symmetric["overturned"].squeeze(), expected), "a negative control: another body"


def test_starts_of_one_history_and_of_many_have_the_same_words() -> None:
    """`start` of `simulate` serves without friction; what rocking alone has not is refused by name."""
    start = rk.dynamics.Start(rotation=0.05, angular_velocity=-0.1)
    one = rk.simulate(STATUE, MOTIONS[0], 0.9, start=start)
    assert one.peak_rotation == rk.simulate(STATUE, MOTIONS[0], 0.9, rotation=0.05, angular_velocity=-0.1).peak_rotation
    assert rk.free_rocking(STATUE, restitution=0.9, start=start).rotation[0] == 0.05
    many = rk.simulate_many(STATUE, MOTIONS[0], 0.9, start=start)
    assert many.sizes["start"] == 1
    assert "start" not in rk.simulate_many(STATUE, MOTIONS[0], 0.9).sizes
    for how, says in (
        ({"start": rk.dynamics.Start(height=0.1)}, "without friction= start has rotation and angular_velocity only"),
        ({"start": [start, 0.1]}, r"start\[1\] must be a Start\(...\) or a list of these, got 0.1"),
        ({"start": []}, "start must be at least one"),
        ({"start": start, "rotation": 0.1}, "use start, or rotation and angular_velocity"),
        ({"rotation": [0.1, 2.0]}, "rotation must be in"),
        ({"rotation": [0.1, math.nan]}, "rotation must be finite"),
        ({"rotation": [0.1, 0.2], "angular_velocity": [0.1, 0.2, 0.3]}, "rows of equal length"),
        ({"angular_velocity": 1e4}, "angular_velocity must be in"),
    ):
        with pytest.raises(rk.errors.InvalidValueError, match=says):
            rk.simulate_many(STATUE, MOTIONS[0], 0.9, **how)
    with pytest.raises(rk.errors.InvalidValueError, match="without friction= start has"):
        rk.simulate(STATUE, MOTIONS[0], 0.9, start=rk.dynamics.Start(horizontal_velocity=0.1))
    box = rk.dynamics.SpatialBody.box(0.5, 0.5, 2.0)
    with pytest.raises(
        rk.errors.InvalidValueError,
        match=r"rotation does not apply to a body in space without friction, got .*; options: duration, engine",
    ):
        rk.simulate_many(box, MOTIONS[0], "housner", rotation=[0.1, 0.2])
