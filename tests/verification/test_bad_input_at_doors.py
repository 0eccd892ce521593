"""What no public door lets in: not finite, outside the ranges, of the wrong kind; each refusal in our own words."""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from engines import built

import rocking as rk
from rocking.dynamics import Outcome, SpatialBody, SpatialStart, Status
from rocking.errors import RockingError

pytestmark = pytest.mark.verifies("damage", control="test_good_input_passes", room="doors")

HALF_PI = 0.5 * math.pi
BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
BOX = SpatialBody.box(1.0, 1.2, 4.0)
MOTION = rk.GroundMotion(3.0 * np.sin(0.1 * np.arange(60)), 0.05)

NUMBERS = (math.nan, math.inf, -math.inf, 1.0 + 2.0j, "0.1", None, [0.1, 0.2], np.array([0.1, 0.2]), True, b"1", object)
OPTIONS: dict[str, tuple[Any, ...]] = {
    "scale": (1.1e6, -1.1e6),
    "rotation": (HALF_PI, 15.0, -90.0, 10**400),
    "angular_velocity": (1e4, -720.0),
    "gravity": (0.0, -9.81, 1e7),
    "duration": (0.0, -1.0, 1e12),
    "restitution": (-0.1, 1.01, 85.0, "housnr", {"left": 0.5}, {"left": 0.5, "right": math.nan}),
    "rest_speed": (-1e-9, 0.5),
    "longest_step": (0.0, 2.0, 1e-9),
    "tolerance": (0.0, 1.0),
    "stream": (-1, 0.5, 2**63),
    "order": (3, 8.5, 0),
    "most_events": (0, 10.0, -1),
    "linear": (0, 1, "no"),
    "engine": ("quick", 1),
    "friction": (-0.1,),
    "normal_restitution": (1.0, -0.1),
    "start": (0.1, SpatialStart(0.1, math.nan), SpatialStart(2.0)),
}
DOORS: dict[str, Callable[..., Any]] = {
    "simulate": lambda **options: rk.simulate(BODY, MOTION, **options),
    "free_rocking": lambda **options: rk.free_rocking(BODY, **({"rotation": 0.05} | options)),
    "simulate_many": lambda **options: rk.simulate_many([BODY], [MOTION], **options),
    "sliding": lambda **options: rk.simulate(BODY, MOTION, **({"friction": 0.4} | options)),
    "in space": lambda **options: rk.simulate(BOX, MOTION, **options),
    "let go in space": lambda **options: rk.free_rocking(BOX, **options),
}
LACKING = {
    "free_rocking": {"scale"},
    "simulate_many": {"rotation", "angular_velocity", "duration", "stream"},
    "sliding": {"angular_velocity"},  # as fast as one likes
    "in space": {"order", "duration"},  # any order from 2, and any duration: at rest it ends
    "let go in space": {"order", "scale"},
}
# what has a meaning there: no duration, usual settings, a linear model, rows of scales, restitutions and frictions
MEANT = {
    "duration": ("None",), "linear": ("True",), "rest_speed": ("None",), "longest_step": ("None",), "order": ("None",),
    "tolerance": ("None",), "simulate_many scale": ("[0.1, 0.2]", "array([0.1, 0.2])"),
    "simulate_many restitution": ("[0.1, 0.2]",), "simulate_many friction": ("[0.1, 0.2]", "array([0.1, 0.2])"),
    "friction": ("None",), "start": ("None",), "sliding restitution": ("None",),
    "in space angular_velocity": ("None",), "let go in space angular_velocity": ("None",),
}  # fmt: skip


def bad_options() -> Iterator[Any]:
    for door in DOORS:
        for option in sorted(OPTIONS.keys() - LACKING.get(door, set())):
            meant = MEANT.get(option, ()) + MEANT.get(f"{door} {option}", ())
            for value in (*OPTIONS[option], *NUMBERS):
                if repr(value) not in meant:
                    yield pytest.param(door, option, value, id=f"{door}-{option}-{value!r:.20}")


@pytest.mark.parametrize(("door", "option", "value"), list(bad_options()))
def test_refused_at_the_door(door: str, option: str, value: Any) -> None:
    """A bad option is refused with our own error, which names it or what it was."""
    with pytest.raises(RockingError) as caught:
        DOORS[door](**{option: value})
    words = str(caught.value).lower()
    names = (option.rsplit("_", maxsplit=1)[-1], "coefficient", "samples", "model", "tilt", "azimuth")
    assert any(name in words for name in names), words


@pytest.mark.parametrize("body", [None, "block", 1.0, math.nan, [BODY], np.zeros(3), MOTION])
@pytest.mark.parametrize("door", [rk.simulate, rk.simulate_many])
def test_no_body(door: Callable[..., Any], body: Any) -> None:
    """What is not a body is refused."""
    if door is rk.simulate_many and isinstance(body, list):
        body = []
    with pytest.raises(RockingError, match=r"body|bodies"):
        door(body, MOTION)
    with pytest.raises(RockingError, match="body"):
        rk.free_rocking(None, 0.1)  # type: ignore[arg-type]


@pytest.mark.parametrize("motion", [None, "record.at2", 1.0, np.zeros(30), [0.0, 1.0], BODY, MOTION.segments()])
@pytest.mark.parametrize("door", [rk.simulate, rk.simulate_many])
def test_no_motion(door: Callable[..., Any], motion: Any) -> None:
    """What is not a motion is refused, bare arrays too: their step and unit would be guesses."""
    with pytest.raises(RockingError, match="motion"):
        door(BODY, motion)


@pytest.mark.parametrize("poison", [math.nan, math.inf, 1e7, 1.0 + 1.0j, "1.0", None])
@pytest.mark.parametrize("part", ["acceleration", "vertical", "time_step"])
def test_no_poisoned_record(part: str, poison: Any) -> None:
    """NaN, infinity, wrong units and wrong kinds do not become a ground motion."""
    given: dict[str, Any] = {"acceleration": [0.0, 1.0, 0.0], "vertical": [0.0, 1.0, 0.0], "time_step": 0.1}
    given[part] = poison if part == "time_step" else [0.0, poison, 0.0]
    with pytest.raises(RockingError, match=part):
        rk.GroundMotion(**given)


@pytest.mark.verifies("behaviour")
def test_the_value_is_named() -> None:
    """The message shows the number that was given and says what it may have been."""
    with pytest.raises(RockingError, match=r"rotation.*got 15.*radians"):
        rk.free_rocking(BODY, 15.0)
    with pytest.raises(RockingError, match=r"angular_velocity.*got 720.*radians"):
        rk.simulate(BODY, MOTION, angular_velocity=720.0)
    with pytest.raises(RockingError, match=r"restitution.*got 85.*percent"):
        rk.simulate(BODY, MOTION, 85.0)
    with pytest.raises(RockingError, match=r"got 1\.01.*create energy"):
        rk.simulate(BODY, MOTION, 1.01)
    with pytest.raises(RockingError, match=r"rest_sped does not apply to .*; options: .*rest_speed"):
        rk.simulate(BODY, MOTION, rest_sped=0.1)  # type: ignore[call-overload]


@pytest.mark.verifies("negative control", "good values")
def test_good_input_passes() -> None:
    """Negative control: what was refused for its values is taken with others."""
    good: dict[str, Any] = {"gravity": 9.81, "rest_speed": 1e-3, "longest_step": 0.1, "most_events": 500}
    one = rk.simulate(BODY, MOTION, 0.9, scale=1.5, rotation=0.1, duration=2.0, stream=3, tolerance=1e-12, **good)
    assert one.status is Status.GOOD
    assert rk.free_rocking(BODY, 0.1, "ked", angular_velocity=-0.1).outcome is Outcome.ROCKED
    many = rk.simulate_many([BODY], [MOTION], 0.9, scale=[1.0, 2.0], **good)
    assert many["status"].values.ravel().tolist() == [0, 0]


@pytest.mark.verifies("behaviour")
@pytest.mark.parametrize("name", ["auto", "reference"])
@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("order", [4, 6, 8])
@pytest.mark.parametrize("motion", [MOTION, rk.pulses.sine(3.0, 0.6)], ids=["record", "pulse"])
def test_every_combination(motion: Any, order: int, linear: bool, name: str) -> None:
    """Orders, models and motions that are each allowed are computed together, or refused with our own error."""
    try:
        many = rk.simulate_many(BODY, motion, 0.9, order=order, linear=linear, engine=name)
    except RockingError as error:
        assert "order" in str(error)  # noqa: PT017 - either way out is right
    else:
        assert many["status"].values.ravel().tolist() == [0]


@pytest.mark.slow
@pytest.mark.verifies(
    "second engine", "the reference engine", within="equal outcomes, sides and counts, or said to have failed"
)
@built
@pytest.mark.filterwarnings("ignore:the contact force becomes tensile")  # 10 g and more throw a block, in both engines
@pytest.mark.parametrize("peak", [10.0**k for k in range(2, 7)])
def test_monstrous_records(peak: float) -> None:
    """Up to the strongest records that are let in the fast engine agrees with the reference, or says that it failed."""
    motion = rk.GroundMotion(peak * np.array([0.0, 1.0, 0.0, -1.0, 0.0, 0.0]), 0.02)
    fast, slow = (rk.simulate(BODY, motion, 0.9, engine=name).trajectory for name in ("fast", "reference"))
    assert slow.status is Status.GOOD
    if fast.status is Status.GOOD:
        assert (fast.outcome, fast.side, fast.impacts) == (slow.outcome, slow.side, slow.impacts)
