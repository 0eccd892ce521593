"""`simulate_many(friction=)`: each entry is what `simulate` gives for it alone, whatever stands beside it."""

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError

pytest.importorskip("xarray")

STATUE = rk.Section([rk.Region([(-0.45, 0.0), (0.55, 0.0), (0.4, 2.5), (-0.15, 2.2)], density=2400.0)])
BODIES = [STATUE, rk.Block(width=0.8, height=1.0)]
MOTIONS = [rk.pulses.sine(amplitude=6.0, period=0.6), rk.pulses.rectangular(5.0, 0.4)]
SCALES, FRICTION = [0.7, 1.0], [0.15, 0.6]
TO_ORIGIN = {
    "peak_rotation": lambda one: one.peak_rotation * np.sign(one.rotation[np.abs(one.rotation).argmax()]),
    "sliding_distance": lambda one: one.sliding_distance,
    "residual_displacement": lambda one: one.displacement[-1],
    "friction_usage": lambda one: one.friction_usage,
    "impacts": lambda one: len(one.impacts),
    "outcome": lambda one: one.outcome.code,
    "still_rocking": lambda one: one.still_rocking,
}


@pytest.fixture(scope="module")
def table():
    return rk.simulate_many(BODIES, MOTIONS, ["ked", None], scale=SCALES, friction=FRICTION, duration=4.0)


def test_labels(table):
    """Friction is the last dimension; every column has a unit and a meaning; impacts without a law are named."""
    assert dict(table.sizes) == {"body": 2, "motion": 2, "scale": 2, "restitution": 2, "friction": 2}
    assert table["restitution"].values.tolist() == ["ked", "complementarity alone"]
    assert all(each.attrs["units"] and each.attrs["long_name"] for each in table.values())
    assert table.attrs["engine"].startswith("fast")


@pytest.mark.slow
@pytest.mark.parametrize("body", range(2))
@pytest.mark.parametrize("mu", range(2))
def test_each_is_what_simulate_gives(table, body, mu):
    one = rk.simulate(BODIES[body], MOTIONS[0], "ked", scale=1.0, friction=FRICTION[mu], duration=4.0)
    row = table.isel(body=body, motion=0, scale=1, restitution=0, friction=mu)
    expected = {name: float(of(one)) for name, of in TO_ORIGIN.items() if name != "residual_displacement"}
    assert {name: float(row[name]) for name in expected} == pytest.approx(expected, rel=1e-9)
    if one.outcome is not rk.Outcome.OVERTURNED:  # the samples of one that falls end before it lies
        assert float(row["residual_displacement"]) == pytest.approx(one.displacement[-1], rel=1e-9)


@pytest.mark.parametrize("scale", [-0.9, 0.9, -2.0, 2.0])
def test_peaks_have_the_sign_that_they_have_without_friction(scale):
    """Where feet hold, rocking alone and with contact agree, side of the fall and sign of the peak too."""
    subject = (rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=4.0, period=0.6), 0.9)
    alone, held = (rk.simulate_many(*subject, scale=scale, friction=mu).squeeze() for mu in (None, 5.0))
    assert float(held["peak_rotation"]) == pytest.approx(float(alone["peak_rotation"]), rel=1e-6)
    assert int(held["side"]) == int(alone["side"])


def test_files_say_what_was_computed():
    """Bounce and duration are attributes; the starts are coordinates, with what they have beside rotation."""
    start = rk.dynamics.Start(rotation=0.05, height=0.02)
    found = rk.simulate_many(STATUE, MOTIONS[0], friction=0.5, normal_restitution=0.3, start=start, duration=1.0)
    assert (found.attrs["normal_restitution"], found.attrs["duration"]) == (0.3, 1.0)
    assert {name: found[f"initial_{name}"].item() for name in ("rotation", "angular_velocity", "height")} == {
        "rotation": 0.05, "angular_velocity": 0.0, "height": 0.02
    }  # fmt: skip
    assert "initial_vertical_velocity" not in found.coords


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["fast", "reference"])
def test_each_start_is_what_simulate_gives(engine):
    """A row of starts is the last dimension; leaning either way, thrown and dropped."""
    starts = [
        rk.dynamics.Start(rotation=-0.08), rk.dynamics.Start(rotation=0.05, angular_velocity=0.2),
        rk.dynamics.Start(height=0.01), rk.dynamics.Start(horizontal_velocity=0.4),
    ]  # fmt: skip
    found = rk.simulate_many(STATUE, MOTIONS[0], friction=[0.3, 0.6], start=starts, duration=1.5, engine=engine)
    assert found["outcome"].dims[-2:] == ("friction", "start")
    for k, start in enumerate(starts):
        one = rk.simulate(STATUE, MOTIONS[0], friction=0.6, start=start, duration=1.5)
        row = found.isel(body=0, motion=0, scale=0, restitution=0, friction=1, start=k)
        for name in ("peak_rotation", "sliding_distance", "impacts"):
            assert float(row[name]) == pytest.approx(float(TO_ORIGIN[name](one)), rel=1e-8, abs=1e-12)


def test_less_friction_slides_and_more_rocks(table):
    """Below the slenderness ratio b/h = .8 a block slides and does not rock; the statue on .6 rocks."""
    slid = table["outcome"].isel(body=1, friction=0)
    assert (slid == rk.Outcome.SLID.code).all()
    assert float(table["peak_rotation"].isel(body=0, motion=0, scale=1, restitution=0, friction=1)) > 0.0


def test_a_sliding_block_stops_where_coulomb_says():
    """Under a = const for T on friction mu: v = (a - mu g) T, s = v T / 2 + v^2 / (2 mu g), relative to the ground."""
    mu, a, last, g = 0.2, 5.0, 0.4, 9.81
    found = rk.simulate_many(
        rk.Block(width=1.0, height=1.0), rk.pulses.rectangular(a, last), friction=mu, gravity=g, scale=[1.0, -1.0]
    )
    v = (a - mu * g) * last
    s = 0.5 * v * last + v * v / (2.0 * mu * g)
    assert found["sliding_distance"].values.ravel() == pytest.approx([s, s], rel=1e-9)
    assert found["residual_displacement"].values.ravel() == pytest.approx([-s, s], rel=1e-9)


def test_a_history_without_a_result_is_neither():
    """One that is stopped has NaN and its status; the one beside it keeps its bits."""
    both = rk.simulate_many(STATUE, MOTIONS[0], scale=[0.01, 1.0], friction=0.6, most_events=3, duration=3.0)
    alone = rk.simulate_many(STATUE, MOTIONS[0], scale=0.01, friction=0.6, most_events=3, duration=3.0)
    assert np.isnan(both["overturned"].values.ravel()[1])
    assert np.isnan(both["peak_rotation"].values.ravel()[1])
    assert both["status"].values.ravel()[1] != 0
    assert both.isel(scale=[0]).equals(alone)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"friction": 0.3, "twin": True}, "twin does not apply to a plane body with friction"),
        ({"friction": 0.3, "threads": 0}, "threads must be a whole number"),
        ({"friction": 0.3, "engine": "quick"}, "engine must be one of"),
        ({"friction": 0.3, "normal_restitution_law": "hertz"}, "normal_restitution_law must be one of"),
        ({"friction": 0.3, "linear": True}, "linear"),
        ({"friction": -0.3}, "friction must be"),
        ({"friction": [0.3, float("nan")]}, "friction must be"),
        ({"friction": []}, "friction must be"),
        ({"friction": 0.3, "start": 0.1}, r"start must be a Start\(...\)"),
        ({"friction": 0.3, "progress": 3}, "progress must be a function"),
        ({"normal_restitution": 0.5}, "normal_restitution does not apply to a plane body without friction,"),
        ({"duration": 3.0}, "duration does not apply to a plane body without friction,"),
    ],
)
def test_what_is_refused(options, says):
    with pytest.raises(InvalidValueError, match=says):
        rk.simulate_many(STATUE, MOTIONS[0], **options)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["fast", "reference"])
def test_a_continuation_that_fails_leaves_the_result_before(engine):
    """With 20 events the first 15 sqrt(R / g) after the motion can be computed, and no more: that result is given.

    Negative control: with 10 events not even that can be computed.
    """
    slender = rk.Section([rk.Region([(-0.35, 0.0), (0.25, 0.0), (0.3, 2.5), (-0.15, 2.2)], density=2400.0)])
    pulse, how = rk.pulses.sine(3.5, 0.9), {"restitution": 0.97, "friction": 0.6, "most_events": 20}
    one = rk.simulate(slender, pulse, **how)
    assert one.outcome is rk.Outcome.ROCKED
    assert one.still_rocking
    many = rk.simulate_many(slender, pulse, engine=engine, **how)
    assert many["outcome"].item() == rk.Outcome.ROCKED.code
    assert many["still_rocking"].item() == 1.0
    assert many["impacts"].item() == len(one.impacts)
    limited = how | {"most_events": 10}
    assert rk.simulate(slender, pulse, **limited).outcome is rk.Outcome.FAILED
    assert rk.simulate_many(slender, pulse, engine=engine, **limited)["outcome"].item() == rk.Outcome.FAILED.code
