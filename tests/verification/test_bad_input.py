"""What no engine may compute, and no door may let in: not finite, outside the ranges, of the wrong kind.

Every history that goes in comes out with a status; a good status comes with finite numbers that fit together; what
was refused leaves NaN and its neighbours alone; nothing hangs.
"""

import faulthandler
import math
import os
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import Outcome, Status, engine
from rocking.dynamics.batch import ROWS, Batch, Rows
from rocking.dynamics.impact_law import ConstantRestitution
from rocking.dynamics.settings import Settings
from rocking.errors import RockingError
from rocking.motions.segments import Segments

CAMPAIGN = bool(os.environ.get("ROCKING_CAMPAIGN"))
INJECTIONS = 1_000
PATHOLOGICAL = {"fast": 10_000, "reference": 10_000 if CAMPAIGN else 500}
ENGINES = pytest.mark.parametrize(
    "name",
    [pytest.param("fast", marks=pytest.mark.skipif(not engine.available(), reason="not built")), "reference"],
)
POISON = (math.nan, math.inf, -math.inf, -math.nan)
REALS = ("peak_rotation", "peak_time", "peak_velocity", "error")
HALF_PI = 0.5 * math.pi
BLOCK = rk.Block(width=0.5, height=2.0)
MOTION = rk.GroundMotion(3.0 * np.sin(0.1 * np.arange(60)), 0.05)


@pytest.fixture(autouse=True)
def _no_hang() -> Iterator[None]:
    """Whatever takes ten minutes has hung: the run ends with a trace of where."""
    faulthandler.dump_traceback_later(20.0, exit=True)
    yield
    faulthandler.cancel_dump_traceback_later()


def ordinary(count: int, seed: int) -> dict[str, Any]:
    """Rows that every engine can compute."""
    random = np.random.default_rng([77, seed])
    ranges = {"alpha": (0.08, 0.6), "p": (0.8, 6.0), "r": (0.1, 0.97)}
    values = {f"{name}_{side}": random.uniform(*ranges[name], count) for name in ranges for side in ("right", "left")}
    motion = {"scale": random.uniform(0.2, 2.0, count), "rotation": random.uniform(-0.05, 0.05, count)}
    return values | motion | {"velocity": random.uniform(-0.1, 0.1, count)}


def run(
    values: dict[str, Any], motions: list[Segments], which: Any, name: str, settings: Settings | None = None
) -> dict[str, Any]:
    batch = Batch(motions, ConstantRestitution(), settings or Settings(most_impacts=2_000), 2, name)

    def rows(first: int, last: int) -> Rows:
        part = slice(first, last)
        return Rows.of(last - first, which[part], **{key: v[part] for key, v in values.items()})

    # an overflow on the way to a refusal is no failure, a wrong number would be
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        return batch.run(which.size, rows)[0]


def false_success(found: dict[str, Any]) -> Any:
    """Rows whose numbers do not fit their status."""
    good = found["status"] == Status.GOOD.code
    down, failed = found["outcome"] == Outcome.OVERTURNED.code, found["outcome"] == Outcome.FAILED.code
    still = found["outcome"] == Outcome.NO_UPLIFT.code
    finite = np.all([np.isfinite(found[key]) for key in REALS], axis=0)
    none = np.all([np.isnan(found[key]) for key in REALS], axis=0)
    known = np.isin(found["status"], range(len(Status))) & np.isin(found["outcome"], range(len(Outcome)))
    with np.errstate(invalid="ignore"):
        fits = (np.abs(found["peak_rotation"]) <= HALF_PI * (1.0 + 1e-15)) & (found["peak_time"] >= 0.0)
        fits &= (found["error"] >= 0.0) & (found["peak_velocity"] >= 0.0)
    fits &= np.isfinite(found["overturning_time"]) == down
    fits &= (np.abs(found["side"]) == 1) == down
    fits &= ~still | ((found["peak_rotation"] == 0.0) & (found["impacts"] + found["uplifts"] == 0))
    fits &= (found["impacts"] >= 0) & (found["uplifts"] >= 0)
    return ~(known & (good != failed) & np.where(good, finite & fits, none))


# ---- poison ---------------------------------------------------------------------------------------------------------


@ENGINES
def test_poisoned_rows(name: str) -> None:
    """1,000 rows with NaN or infinity in one of their numbers are refused; the rows between them keep their bits."""
    values = ordinary(2 * INJECTIONS if name == "fast" or CAMPAIGN else 1_100, 1)
    count, motions = values["scale"].size, [MOTION.segments()]
    which, random = np.zeros(count, np.int64), np.random.default_rng(5)
    ill = random.permutation(count)[:INJECTIONS]
    clean = run({key: np.delete(v, ill) for key, v in values.items()}, motions, np.delete(which, ill), name)
    for k, row in enumerate(ill):
        values[ROWS[k % len(ROWS)]][row] = POISON[k % len(POISON)]
    found = run(values, motions, which, name)
    assert not false_success(found).any()
    assert (found["status"][ill] == Status.INVALID.code).all()
    assert (found["impacts"][ill] == 0).all()
    assert (clean["status"] == Status.GOOD.code).all()
    assert all(np.delete(found[key], ill).tobytes() == clean[key].tobytes() for key in engine.RESULTS)


@ENGINES
@pytest.mark.parametrize("vertical", [False, True])
def test_poisoned_motions(name: str, vertical: bool) -> None:
    """NaN or infinity within a motion: no success that went through it, and other motions keep their bits."""
    count = 250
    values, random, motions = ordinary(2 * count, 2), np.random.default_rng(6), []
    values["rotation"][:], values["velocity"][:] = 0.0, 0.0
    bad = np.arange(2 * count) % 2 == 1
    at = random.integers(0, 40, 2 * count)
    for k in range(2 * count):
        x, z = 6.0 * random.normal(size=(2, 40))
        if bad[k]:
            (z if vertical and k % 4 == 1 else x)[at[k]] = POISON[k // 2 % len(POISON)]
        with np.errstate(invalid="ignore"):
            motions.append(Segments.between_samples(0.05, x, z if vertical else None))
    found = run(values, motions, np.arange(2 * count), name)
    assert not false_success(found).any()
    # what fell before the poison was met is a true result
    fell_before = found["overturning_time"] <= 0.05 * at
    assert (found["status"][bad & ~fell_before] != Status.GOOD.code).all()
    healthy = np.flatnonzero(~bad)
    clean = run({key: v[healthy] for key, v in values.items()}, [motions[k] for k in healthy], np.arange(count), name)
    assert all(found[key][healthy].tobytes() == clean[key].tobytes() for key in engine.RESULTS)


def extreme(random: np.random.Generator, count: int) -> dict[str, Any]:
    """Numbers from all over the floating-point line, most of them outside what is allowed or at its ends."""

    def pick(*special: float, low: float, high: float) -> Any:
        wide = 10.0 ** random.uniform(low, high, count) * random.choice([1.0, 1.0, 1.0, -1.0], count)
        return np.where(random.uniform(size=count) < 0.4, random.choice(special, count), wide)

    sane = ordinary(count, 3)
    angle = (1e-300, 1e-12, 1e-6, HALF_PI, np.nextafter(HALF_PI, 0.0), HALF_PI - 1e-9, 1.5, math.pi, 0.0, -0.1, 5e-324)
    speed = (1e-9, 1.0000001e-9, 1e9, 9.99e8, 0.0, -1.0, 1e300, 1e-300)
    ratio = (0.0, 1.0, 1.0 + 1e-15, 100.0, 100.1, -0.0, -1e-300, 2.0, 1e-300)
    odd = {
        f"{key}_{side}": pick(*special, low=low, high=high)
        for key, special, low, high in (
            ("alpha", angle, -20.0, 0.3),
            ("p", speed, -10.0, 10.0),
            ("r", ratio, -9.0, 2.5),
        )
        for side in ("right", "left")
    }
    odd["scale"] = pick(0.0, -0.0, 1e9, -1e9, 1.1e9, 1e-300, 5e-324, 1e300, low=-12.0, high=10.0)
    odd["rotation"] = pick(0.0, HALF_PI, -np.nextafter(HALF_PI, 0.0), 5e-324, 1.0, low=-20.0, high=0.3)
    odd["velocity"] = pick(0.0, 1e9, -9.99e8, 5e-324, 1e300, low=-20.0, high=10.0)
    # one to nine odd numbers a row: with all of them odd nearly every row would be refused at once
    share = random.uniform(0.1, 1.0, count)
    return {key: np.where(random.uniform(size=count) < share, odd[key], sane[key]) for key in ROWS}


@ENGINES
@pytest.mark.parametrize("linear", [False, True])
def test_pathological_parameters(name: str, linear: bool) -> None:
    """10,000 rows of extremes on motions of extremes: a status each, no false success, and many of either."""
    count = PATHOLOGICAL[name] // 2
    random = np.random.default_rng([9, linear])
    values, motions = extreme(random, count), []
    for step in (1e-9, 1e-3, 0.05, 1.0, 1e3):
        x, z = random.normal(size=(2, 12)) * 10.0 ** random.uniform(-3.0, 6.0, (2, 1))
        motions += [Segments.between_samples(step, x, z), Segments.between_samples(step, np.zeros(12), None)]
    which = random.integers(-1, len(motions) + 1, count)
    settings = Settings(linear=linear, most_impacts=300, rest_speed=0.0 if linear else 0.01)
    found = run(values, motions, which, name, settings)
    wrong = np.flatnonzero(false_success(found))
    assert not wrong.size, [{key: v[k] for key, v in {**values, **found}.items()} for k in wrong[:3]]
    # the ranges, written once more
    valid = (which >= 0) & (which < len(motions)) & (np.abs(values["scale"]) <= 1e9)
    valid &= (np.abs(values["rotation"]) < HALF_PI) & (np.abs(values["velocity"]) < 1e9)
    for side in ("right", "left"):
        alpha, p, r = (values[f"{key}_{side}"] for key in ("alpha", "p", "r"))
        valid &= (alpha > 0.0) & (alpha < HALF_PI) & (p > 1e-9) & (p < 1e9) & (r >= 0.0) & (r <= 100.0)
    assert np.array_equal(found["status"] == Status.INVALID.code, ~valid)
    assert 0.15 < valid.mean() < 0.85
    assert (found["status"] == Status.GOOD.code).mean() > 0.1


# ---- the public doors -----------------------------------------------------------------------------------------------

NUMBERS = (math.nan, math.inf, -math.inf, 1.0 + 2.0j, "0.1", None, [0.1, 0.2], np.array([0.1, 0.2]), True, b"1", object)
OPTIONS: dict[str, tuple[Any, ...]] = {
    "scale": (1e7, -1e7),
    "rotation": (HALF_PI, 15.0, -90.0, 10**400),
    "angular_velocity": (1e4, -720.0),
    "gravity": (0.0, -9.81, 1e7),
    "duration": (0.0, -1.0, 1e12),
    "restitution": (-0.1, 1.01, 85.0, "housnr", {"left": 0.5}, {"left": 0.5, "right": math.nan}),
    "rest_speed": (-1e-9, 0.5),
    "longest_step": (0.0, 2.0, 1e-9),
    "tolerance": (0.0, 1.0),
    "key": (-1, 0.5, 2**63),
    "order": (3, 8.5, 0),
    "most_impacts": (0, 10.0, -1),
    "linear": (0, 1, "no"),
    "engine": ("quick", 1),
}
DOORS: dict[str, Callable[..., Any]] = {
    "simulate": lambda **options: rk.simulate(BLOCK, MOTION, **options),
    "free_rocking": lambda **options: rk.free_rocking(BLOCK, **({"rotation": 0.05} | options)),
    "simulate_many": lambda **options: rk.simulate_many([BLOCK], [MOTION], **options),
}
LACKING = {
    "free_rocking": {"scale"},
    "simulate_many": {"rotation", "angular_velocity", "duration", "key"},
}
# what has a meaning there: no duration, a linear model, a row of scales, several restitutions
MEANT = {
    "duration": ("None",), "linear": ("True",), "simulate_many scale": ("[0.1, 0.2]", "array([0.1, 0.2])"),
    "simulate_many restitution": ("[0.1, 0.2]",),
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
    named = (
        option.rsplit("_", maxsplit=1)[-1] in words or "coefficient" in words or "samples" in words or "model" in words
    )
    assert named, words


@pytest.mark.parametrize("body", [None, "block", 1.0, math.nan, [BLOCK], np.zeros(3), MOTION])
@pytest.mark.parametrize("door", [rk.simulate, rk.simulate_many])
def test_no_body(door: Callable[..., Any], body: Any) -> None:
    """What is not a body is refused."""
    if door is rk.simulate_many and isinstance(body, list):
        body = []
    with pytest.raises(RockingError, match=r"body|bodies"):
        door(body, MOTION)
    with pytest.raises(RockingError, match="body"):
        rk.free_rocking(None, 0.1)  # type: ignore[arg-type]


@pytest.mark.parametrize("motion", [None, "record.at2", 1.0, np.zeros(30), [0.0, 1.0], BLOCK, MOTION.segments()])
@pytest.mark.parametrize("door", [rk.simulate, rk.simulate_many])
def test_no_motion(door: Callable[..., Any], motion: Any) -> None:
    """What is not a motion is refused, bare arrays too: their step and unit would be guesses."""
    with pytest.raises(RockingError, match="motion"):
        door(BLOCK, motion)


@pytest.mark.parametrize("poison", [math.nan, math.inf, 1e7, 1.0 + 1.0j, "1.0", None])
@pytest.mark.parametrize("part", ["acceleration", "vertical", "time_step"])
def test_no_poisoned_record(part: str, poison: Any) -> None:
    """NaN, infinity, wrong units and wrong kinds do not become a ground motion."""
    given: dict[str, Any] = {"acceleration": [0.0, 1.0, 0.0], "vertical": [0.0, 1.0, 0.0], "time_step": 0.1}
    given[part] = poison if part == "time_step" else [0.0, poison, 0.0]
    with pytest.raises(RockingError, match=part):
        rk.GroundMotion(**given)


def test_the_value_is_named() -> None:
    """The message shows the number that was given and says what it may have been."""
    with pytest.raises(RockingError, match=r"rotation.*got 15.*degrees"):
        rk.free_rocking(BLOCK, 15.0)
    with pytest.raises(RockingError, match=r"angular_velocity.*got 720.*degrees"):
        rk.simulate(BLOCK, MOTION, angular_velocity=720.0)
    with pytest.raises(RockingError, match=r"restitution.*got 85.*percent"):
        rk.simulate(BLOCK, MOTION, 85.0)
    with pytest.raises(RockingError, match=r"got 1\.01.*create energy"):
        rk.simulate(BLOCK, MOTION, 1.01)
    with pytest.raises(RockingError, match="no option named 'rest_sped'"):
        rk.simulate(BLOCK, MOTION, rest_sped=0.1)


def test_good_input_passes() -> None:
    """Negative control: what was refused for its values is taken with others."""
    good: dict[str, Any] = {
        "gravity": 9.81,
        "rest_speed": 1e-3,
        "longest_step": 0.1,
        "order": 6,
        "linear": True,
        "most_impacts": 500,
    }
    assert rk.simulate(BLOCK, MOTION, 0.9, scale=1.5, rotation=0.1, duration=2.0, key=3, **good).status is Status.GOOD
    assert rk.free_rocking(BLOCK, 0.1, "ked", angular_velocity=-0.1).outcome is Outcome.ROCKED
    assert rk.simulate_many([BLOCK], [MOTION], 0.9, scale=[1.0, 2.0], **good)["status"].values.tolist() == [
        [[[0], [0]]]
    ]
