"""What `simulate`, `free_rocking` and `simulate_many` refuse, and what the message says."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking import conventions
from rocking.errors import InvalidValueError, RockingError, UnknownModelError

# these take rows, whatever their type
SPEED: Any = rk.dynamics.SpeedRestitution
RANDOM: Any = rk.dynamics.RandomRestitution
BLOCK = rk.Block(width=0.5, height=2.0)
PULSE = rk.pulses.sine(amplitude=3.0, period=0.6)
RECORD = rk.GroundMotion(np.sin(np.arange(30.0)), 0.05)
NO_NUMBERS: list[Any] = [math.nan, math.inf, -math.inf, None, "1", True, [1.0, 2.0], 1j, {}]


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


@pytest.mark.parametrize(
    ("door", "name"),
    [
        (shaken, "scale"), (shaken, "rotation"), (shaken, "angular_velocity"), (shaken, "gravity"),
        (let_go, "rotation"), (let_go, "angular_velocity"), (let_go, "gravity"), (many, "gravity"),
        (shaken, "tolerance"), (let_go, "longest_step"), (many, "rest_speed"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("value", NO_NUMBERS)
def test_no_numbers(door: Callable[..., Any], name: str, value: Any) -> None:
    """Whatever is not one finite number is refused under its name; no setting is the usual one."""
    if value is None and name in {"tolerance", "longest_step", "rest_speed"}:
        assert repr(door(**{name: None})) == repr(door())
        return
    with pytest.raises(InvalidValueError, match=f"{name} must be"):
        door(**{name: value})


@pytest.mark.parametrize("door", [shaken, let_go])
@pytest.mark.parametrize("value", [v for v in NO_NUMBERS if v is not None] + [0.0, -1.0])
def test_durations(door: Callable[..., Any], value: Any) -> None:
    """A duration is one finite number above zero."""
    with pytest.raises(InvalidValueError, match="duration must be"):
        door(duration=value)


@pytest.mark.parametrize("door", [shaken, let_go])
@pytest.mark.parametrize("degrees", [5.0, -10.0, 90.0, 0.5 * math.pi, -0.5 * math.pi])
def test_degrees_instead_of_radians(door: Callable[..., Any], degrees: float) -> None:
    """A rotation of a quarter turn or more is refused, and the message asks whether it was degrees."""
    with pytest.raises(InvalidValueError, match=r"rotation must be in \(-1.5708, pi/2\) rad, got .*; degrees\?"):
        door(rotation=degrees)


@pytest.mark.parametrize("door", [shaken, let_go])
@pytest.mark.parametrize("share", [100.0001, -100.0001, 1e4])
@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
def test_speeds(door: Callable[..., Any], share: float) -> None:
    """Beyond 100 p an angular velocity is refused, with the range; up to there it is not."""
    p = math.sqrt(0.75 * conventions.g / math.hypot(0.25, 1.0))
    with pytest.raises(InvalidValueError, match=r"angular_velocity must be in \[-.*\] rad/s, got .*; degrees\?"):
        door(angular_velocity=share * p)
    thrown = door(angular_velocity=math.copysign(99.9999, share) * p)
    assert thrown.outcome is rk.Outcome.OVERTURNED


def test_scales() -> None:
    """Scales beyond 1e6 are refused; a negative one is the motion turned round: the mirrored response."""
    for value in (1.1e6, -1.1e6):
        with pytest.raises(InvalidValueError, match=r"scale must be in \[-1e\+06, 1e\+06\], got"):
            shaken(scale=value)
    there, back = shaken(scale=4.0), shaken(scale=-4.0)
    assert np.abs(there.rotation).max() > 1e-3
    np.testing.assert_array_equal(there.rotation, -back.rotation)


@pytest.mark.parametrize(
    "value", [math.nan, math.inf, 2e6, [1.0, math.nan], [], [[1.0, 2.0]], None, "1", [None], [True]]
)
def test_scales_of_many(value: Any) -> None:
    """Scales that are no row of finite numbers are refused by `simulate_many`."""
    with pytest.raises(InvalidValueError, match="scale must be"):
        many(scale=value)


@pytest.mark.parametrize("body", [None, 1.0, "block", (0.5, 2.0), np.ones(3), rk.Block, PULSE])
def test_no_bodies(body: Any) -> None:
    """What is no body is refused by every door."""
    for door in (shaken, let_go):
        with pytest.raises(InvalidValueError, match=r"must be a Block, (a )?Section(, | or )MassPoints"):
            door(body=body)
    with pytest.raises(InvalidValueError, match="bodies must be one or more of Body"):
        many(bodies=[BLOCK, body])


@pytest.mark.parametrize("motion", [None, 1.0, "sine", [0.0, 1.0], np.ones(30), RECORD.segments(), BLOCK])
def test_no_motions(motion: Any) -> None:
    """What is no motion is refused, arrays too: their step would be a guess."""
    with pytest.raises(InvalidValueError, match=r"motion must be a GroundMotion, a pulse, or .*, got"):
        shaken(motion=motion)
    with pytest.raises(InvalidValueError, match="motions must be one or more of GroundMotion, Pulse, Mapping"):
        many(motions=[RECORD, motion])


def test_nothing_to_do() -> None:
    """`simulate_many` refuses empty lists."""
    more: dict[str, Any]
    for more, message in (
        ({"bodies": []}, "bodies must be one or more"),
        ({"motions": []}, "motions must be one or more"),
        ({"restitution": []}, "restitution must be at least one model, got none"),
    ):
        with pytest.raises(InvalidValueError, match=message):
            many(**more)


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize(
    ("restitution", "message"),
    [
        (math.nan, "restitution must be finite"),
        (math.inf, "restitution must be finite"),
        (None, r"restitution must be a number \[-\], got None"),
        (True, "restitution must be a number"),
        (-0.1, r"restitution must be in \[0, 10\], got -0.1"),
        (85.0, r"restitution must be in \[0, 10\], got 85; a ratio of velocities; a percentage\?"),
        (1.001, r"onto the left foot must be in \[0, 1\], got 1.001: the impact would create energy"),
        ({"left": 0.9}, "restitution by side is"),
        ({"left": 0.9, "right": 0.9, "both": 0.9}, "restitution by side is"),
        ({"left": math.nan, "right": 0.9}, r"restitution\['left'\] must be finite"),
        ({"left": 0.9, "right": None}, r"restitution\['right'\] must be a number"),
        ({"left": 0.9, "right": 1.5}, r"onto the right foot must be in"),
        (SPEED([0.0, 1.0], [0.5, 1.0], times=1.2), "would create energy"),
        (SPEED([0.0, 1.0], [0.5, 1.0], times=math.nan), "restitution must be finite"),
        (RANDOM([0.5, 0.6], 1, times=-1.0), "restitution must be in"),
        (np.array([0.8, 0.9]), "restitution must be one number"),
    ],
)
def test_restitutions(door: Callable[..., Any], restitution: Any, message: str) -> None:
    """Coefficients that are no number, out of range, or would create energy are refused."""
    with pytest.raises(InvalidValueError, match=message):
        door(restitution=restitution)


@pytest.mark.parametrize("door", DOORS)
def test_names(door: Callable[..., Any]) -> None:
    """Unknown models, engines and options are refused, each with the list of known ones."""
    with pytest.raises(UnknownModelError, match="no restitution model named 'hausner'; there are housner, ked"):
        door(restitution="hausner")
    engine: Any
    for engine in ("quick", "", "Fa st", None, 1, ["fast"]):
        with pytest.raises(InvalidValueError, match="engine must be one of auto, fast, reference, got"):
            door(engine=engine)
    with pytest.raises(TypeError, match="unexpected keyword argument 'dt'"):
        door(dt=0.01)


@pytest.mark.parametrize("door", [shaken, let_go])
@pytest.mark.parametrize("key", [-1, 2**63, 1.0, None, True, "1", math.nan])
def test_keys(door: Callable[..., Any], key: Any) -> None:
    """The number of a history is a whole one from 0 to 2^63 - 1."""
    with pytest.raises(InvalidValueError, match=r"stream must be a whole number in \[0, 2\^63\), got"):
        door(stream=key)
    assert door(stream=2**63 - 1).stream == 2**63 - 1


@pytest.mark.parametrize("value", [1, -1, 0.5, "1", None, [0], np.array([0, 0]), {}])
def test_what_other_mechanics_do_not_know(value: Any) -> None:
    """Numbers of histories with friction and in space, bounces and starts without, are refused whatever they are."""
    solid = rk.Solid(rk.bodies.solid.box(0.5, 0.5, 2.0))
    for more in ({"friction": 0.4, "stream": value}, {"body": solid, "stream": value}, {"bounce": value}):
        with pytest.raises(InvalidValueError, match=r"(stream|bounce) is nothing for a body"):
            shaken(**more)
    for more in ({"friction": 0.4, "stream": 0}, {"bounce": 0.0, "start": None}):
        assert shaken(**more).outcome is not rk.Outcome.FAILED  # what changes nothing is taken


@pytest.mark.parametrize("threads", [0, -1, 1.0, True, "2", math.nan])
def test_threads(threads: Any) -> None:
    """Threads are a whole number from 1."""
    with pytest.raises(InvalidValueError, match="threads must be a whole number >= 1, got"):
        many(threads=threads)


def test_far_too_long() -> None:
    """A response of more samples than memory should hold is refused before any is made."""
    for door in (shaken, let_go):
        with pytest.raises(InvalidValueError, match=r"the response would have .* samples, more than 2e"):
            door(duration=1e9)


def test_kinds_cannot_be_mixed() -> None:
    """Records and pulses in one call of the fast engine, or several laws in one, are refused with the way out."""
    law = RANDOM([0.5, 0.6], 1)
    with pytest.raises(InvalidValueError, match="must be the only restitution of a call"):
        many(restitution=[law, 0.9])
    if rk.dynamics.plane.fast_engine.available():
        with pytest.raises(InvalidValueError, match="all records or all pulses; sample the pulses"):
            many(motions=[RECORD, PULSE])


def test_the_doors_are_open() -> None:
    """Negative control: the very same calls with good values give responses, and no error is a bare Exception."""
    assert shaken().status.name == let_go().status.name == "GOOD"
    assert int(many().status.max()) == 0
    assert issubclass(InvalidValueError, RockingError)
    assert issubclass(InvalidValueError, ValueError)
