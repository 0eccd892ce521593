"""The front door: what it takes, refuses and hands on."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from engines import built

import rocking as rk
from rocking import conventions
from rocking.dynamics import ImpactLaw
from rocking.dynamics.batch import Batch
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError
from rocking.motions import Segments

# these take rows, whatever their type
SPEED: Any = rk.dynamics.SpeedRestitution
RANDOM: Any = rk.dynamics.RandomRestitution
BLOCK = rk.Block(width=0.5, height=2.0)
PULSE = rk.pulses.sine(amplitude=3.0, period=0.6)
RECORD = rk.GroundMotion(np.sin(np.arange(30.0)), 0.05)


def shaken(**more: Any) -> Any:
    given: dict[str, Any] = {"body": BLOCK, "motion": RECORD, "restitution": 0.9} | more
    return rk.simulate(**given)


def let_go(**more: Any) -> Any:
    given: dict[str, Any] = {"body": BLOCK, "rotation": 0.1, "restitution": 0.9} | more
    return rk.free_rocking(**given)


def many(**more: Any) -> Any:
    given: dict[str, Any] = {"bodies": BLOCK, "motions": RECORD, "restitution": 0.9} | more
    return rk.simulate_many(**given)


DOORS = (shaken, let_go, many)


@pytest.mark.parametrize("door", [shaken, let_go])
@pytest.mark.parametrize("share", [100.0001, -100.0001, 1e4])
@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
def test_speeds(door: Callable[..., Any], share: float) -> None:
    """Beyond 100 p an angular velocity is refused, with the range; up to there it is not."""
    p = math.sqrt(0.75 * conventions.g / math.hypot(0.25, 1.0))
    with pytest.raises(InvalidValueError, match=r"angular_velocity must be in \[-.*\] rad/s, got .*; in radians"):
        door(angular_velocity=share * p)
    thrown = door(angular_velocity=math.copysign(99.9999, share) * p)
    assert thrown.outcome is rk.Outcome.OVERTURNED


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize(
    ("restitution", "message"),
    [
        (None, "needs friction"),
        (1.001, r"onto the left foot must be in \[0, 1\], got 1.001: the impact would create energy"),
        ({"left": 0.9, "right": 0.9, "both": 0.9}, "restitution by side is"),
        ({"left": 0.9, "right": None}, r"restitution\['right'\] must be a number"),
        ({"left": 0.9, "right": 1.5}, r"onto the right foot must be in"),
        (SPEED([0.0, 1.0], [0.5, 1.0], times=1.2), "would create energy"),
        (SPEED([0.0, 1.0], [0.5, 1.0], times=math.nan), "restitution must be finite"),
        (RANDOM([0.5, 0.6], 1, times=-1.0), "restitution must be in"),
    ],
)
def test_restitutions(door: Callable[..., Any], restitution: Any, message: str) -> None:
    """Coefficients that are no number, out of range, or would create energy are refused."""
    with pytest.raises(InvalidValueError, match=message):
        door(restitution=restitution)


@pytest.mark.slow
@pytest.mark.parametrize("value", [1, -1, 0.5, "1", None, [0], np.array([0, 0]), {}])
def test_what_other_mechanics_do_not_know(value: Any) -> None:
    """Numbers of histories with friction and in space, bounces and starts without, are refused whatever they are."""
    solid = rk.Solid(rk.bodies.solid.box(0.5, 0.5, 2.0))
    for more in ({"friction": 0.4, "stream": value}, {"body": solid, "stream": value}, {"normal_restitution": value}):
        with pytest.raises(InvalidValueError, match=r"(stream|normal_restitution) does not apply to a "):
            shaken(**more)
    for more in ({"friction": 0.4, "stream": 0}, {"normal_restitution": 0.0, "start": None}):
        assert shaken(**more).outcome is not rk.Outcome.FAILED  # what changes nothing is taken


def test_kinds_cannot_be_mixed() -> None:
    """Records and pulses in one call of the fast engine, several laws in one, or none, are refused with the way out."""
    law = RANDOM([0.5, 0.6], 1)
    with pytest.raises(InvalidValueError, match="restitution must be at least one model, got none"):
        many(restitution=[])
    with pytest.raises(InvalidValueError, match="must be the only restitution of a call"):
        many(restitution=[law, 0.9])
    if rk.dynamics.plane.fast_engine.available():
        with pytest.raises(InvalidValueError, match="all records or all pulses; sample the pulses"):
            many(motions=[RECORD, PULSE])


RESPONSE = rk.simulate(BLOCK, PULSE, "housner")
END = float(RESPONSE.time[-1])
SLIDING = rk.simulate(BLOCK, PULSE, friction=0.2, duration=END)
VERTICAL = rk.GroundMotion(np.array([0.0, 3.0, 0.0]), 0.1, vertical=np.array([0.0, 1.0, 0.0]))


# ---- what is asked of a response ------------------------------------------------------------------------------------


@pytest.mark.parametrize("time", [math.nan, math.inf, [0.1, -math.inf], -1.0, 1e9, -1e-6, END * (1.0 + 1e-6)])
def test_times_outside_the_response(time: Any) -> None:
    """Times that are not finite or outside the response are refused with its range; the ends may be off by rounding."""
    for response in (RESPONSE, SLIDING):
        with pytest.raises(
            InvalidValueError, match=r"time must be in \[0, [0-9.]*\] s, the duration of the response, got"
        ):
            response.at(time)
    assert RESPONSE.at([-1e-15, END * (1.0 + 1e-15)]).tolist() == [RESPONSE.rotation[0], RESPONSE.rotation[-1]]


@pytest.mark.parametrize(
    ("ask", "words", "values"),
    [
        (lambda threads: many(threads=threads), r"threads must be a whole number in \[1, 4096\], got",
         [0, -1, 1.0, True, "2", math.nan]),
        (RESPONSE.at, r"time must be numbers \[s\], got", [None, "a", [True], 1j, [[0.1], [0.1, 0.2]]]),
        (RESPONSE.contact.warnings, "friction must be", [math.nan, math.inf, -1.0, 0.0, None, "0.5", True]),
    ],
)  # fmt: skip
def test_what_is_no_number(ask: Callable[..., Any], words: str, values: list[Any]) -> None:
    """Threads are a whole number from 1, times are numbers, a coefficient of friction is above zero and finite."""
    for value in values:
        with pytest.raises(InvalidValueError, match=words):
            ask(value)


def test_the_last_sample_of_a_record() -> None:
    """Where a record ends its last sample is shown, and rest after it; a record that fills the time ends likewise."""
    record = rk.GroundMotion(np.array([0.0, 0.0, 0.5]), 0.5)
    found = rk.simulate(BLOCK, record, scale=-2.0).ground_acceleration
    assert found[:3].tolist() == [0.0, 0.0, -1.0]
    assert not found[3:].any()
    assert rk.simulate(BLOCK, record, duration=1.0).ground_acceleration.tolist() == [0.0, 0.0, 0.5]
    assert rk.simulate(BLOCK, record, duration=0.5).ground_acceleration.tolist() == [0.0, 0.0]
    flat = rk.pulses.rectangular(amplitude=1.0, duration=0.5)
    shown = rk.simulate(BLOCK, flat)
    np.testing.assert_allclose(shown.ground_acceleration, flat.acceleration(shown.time), rtol=0.0, atol=1e-14)


@pytest.mark.slow
@built
def test_error_estimate_at_the_shortest_step() -> None:
    """Where steps cannot be halved the reference engine stands in; a step near the limit is no exception."""
    for step in (1e-6, 1.9e-6):
        response = rk.simulate(BLOCK, PULSE, "housner", longest_step=step, duration=0.2, rotation=0.05)
        assert 0.0 < response.error_estimate < 1e-12
    reference = rk.simulate(BLOCK, PULSE, "housner", longest_step=1e-6, duration=0.2, rotation=0.05, engine="reference")
    assert 0.0 <= reference.error_estimate < 1e-12


# ---- orders of the fast engine --------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("order", [4, 6])
@pytest.mark.parametrize("name", ["auto", pytest.param("fast", marks=built)])
@pytest.mark.filterwarnings("ignore::rocking.errors.SlowEngineWarning")
def test_one_history_has_order_8(order: int, name: str) -> None:
    """Orders 4 and 6 are refused for one history, not passed over; the reference engine has an order of its own."""
    message = f"order must be 8 for one history, got {order}: orders 4 and 6 apply only to batches"
    with pytest.raises(InvalidValueError, match=message):
        rk.simulate(BLOCK, PULSE, order=order, engine=name)
    with pytest.raises(InvalidValueError, match=message):
        rk.free_rocking(BLOCK, 0.1, order=order, engine=name)
    assert rk.free_rocking(BLOCK, 0.1, order=order, engine="reference").engine.startswith("reference")


@built
@pytest.mark.parametrize("order", [4, 6])
def test_orders_of_batches(order: int) -> None:
    """Batches have orders 4 and 6 except for linear equations and vertical motions, where the message says so."""
    pytest.importorskip("xarray")
    with pytest.raises(InvalidValueError, match=f"order must be 8 for the linear equations, got {order}: orders 4 and"):
        rk.simulate_many(BLOCK, PULSE, order=order, linear=True)
    with pytest.raises(InvalidValueError, match=f"order must be 8 for motions with a vertical component, got {order}"):
        rk.simulate_many(BLOCK, VERTICAL, order=order)
    good = rk.simulate_many(BLOCK, PULSE, order=order)["peak_rotation"].item()
    # order 4 errs by about 1e-6 at the default step
    assert good == pytest.approx(rk.simulate_many(BLOCK, PULSE)["peak_rotation"].item(), rel=1e-4)
    for more in ({"linear": True, "order": order}, {"linear": True, "order": 8, "engine": "fast"}):
        engines: Any = {"engine": "reference", **more}
        assert rk.simulate_many(BLOCK, VERTICAL, **engines)["status"].item() == 0


# ---- laws of impact -------------------------------------------------------------------------------------------------


def test_the_base_of_the_laws() -> None:
    """The base class is no law: it says which classes are."""
    with pytest.raises(InvalidValueError, match=r"is a base class; use ConstantRestitution, SpeedRestitution"):
        rk.simulate(BLOCK, PULSE, ImpactLaw())


@pytest.mark.parametrize("points", [None, -1, 0, 1, 2.5, True, "9", math.nan, 100_001, 10**400])
def test_points_of_a_distribution(points: Any) -> None:
    """A distribution is stood for by a whole number of quantiles from 2 to 100,000; both ends are taken."""
    with pytest.raises(InvalidValueError, match=r"points must be a whole number in \[2, 100000\], got"):
        rk.dynamics.RandomRestitution.normal(0.5, 0.1, seed=1, points=points)
    for count in (2, 100_000):
        assert rk.dynamics.RandomRestitution.normal(0.5, 0.1, seed=1, points=count).factors.size == count


# ---- many histories -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bad", "shown"),
    [(None, "None"), (5, "5"), ("abc", "'abc'"), ([], "none"), ([None], "None at index 0"), (math.nan, "nan")],
)
def test_bodies_and_motions(bad: Any, shown: str) -> None:
    """Bodies and motions of another kind are refused; the message names what was given, and where."""
    pytest.importorskip("xarray")
    with pytest.raises(InvalidValueError, match=f"bodies must be one or more of Body, got {shown}"):
        rk.simulate_many(bad, PULSE)
    with pytest.raises(
        InvalidValueError, match=f"motions must be one or more of GroundMotion, Pulse, Mapping, got {shown}"
    ):
        rk.simulate_many(BLOCK, bad)
    with pytest.raises(InvalidValueError, match=r"bodies must be one or more of Body, got Sinusoids.* at index 1"):
        rk.simulate_many([BLOCK, PULSE], PULSE)  # type: ignore[list-item]


@pytest.mark.parametrize("progress", [5, "print", [print]])
def test_progress(progress: Any) -> None:
    """Progress is told to a function; anything else is refused before anything is computed."""
    row = {"alpha_right": 0.2, "alpha_left": 0.2, "p_right": 2.0, "p_left": 2.0, "r_right": 0.9, "r_left": 0.9}
    batch = Batch([Segments.still(0.1, 3)], engine="reference")
    with pytest.raises(InvalidValueError, match="progress must be a function of the number of computed histories"):
        batch.run(1, lambda first, last: Rows.of(last - first, **row), progress)
    pytest.importorskip("xarray")
    with pytest.raises(InvalidValueError, match="progress must be a function"):
        rk.simulate_many(BLOCK, PULSE, progress=progress)


@pytest.mark.parametrize(
    ("scale", "message"),
    [
        (2e6, r"scale must be finite and within 1e6, got 2e\+06 at index 0"),
        ([-1e6, -1000001.0], r"within 1e6, got -1e\+06 at index 1"),
        ([1.0, math.nan], "got nan at index 1"),
        ([1.0, 2.0, -math.inf], "got -inf at index 2"),
        ([], r"scale must be one number or a row of numbers, got shape \(0,\)"),
        ([[1.0, 2.0]], r"got shape \(1, 2\)"),
        (None, r"scale must be numbers"),
        ([None], r"scale must be numbers"),
        ([True], r"scale must be numbers"),
    ],
)
def test_scales_by_value_and_place(scale: Any, message: str) -> None:
    """Scales that are no row of finite numbers within 1e6 are refused by value and place."""
    pytest.importorskip("xarray")
    with pytest.raises(InvalidValueError, match=message):
        rk.simulate_many(BLOCK, PULSE, scale=scale)
