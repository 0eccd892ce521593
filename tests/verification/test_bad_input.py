"""What no engine may compute: rows and motions that are not finite, or outside the ranges.

Every history that goes in comes out with a status; a good status comes with finite numbers that fit together; what
was refused leaves NaN and its neighbours alone; nothing hangs.
"""

import faulthandler
import math
import os
import subprocess
import sys
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from engines import every_engine
from waiting import HANG

from rocking.dynamics import ConstantRestitution, Outcome, PlaneSettings, Status
from rocking.dynamics import rows as rows_module
from rocking.dynamics.batch import Batch
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.rows import Rows
from rocking.errors import RockingError
from rocking.motions import Segments

pytestmark = pytest.mark.verifies("damage", room="rocking in the plane")

# how the mass is spread may be unknown
ROWS = tuple(name for name in rows_module.ROWS if not name.startswith("q_"))
CAMPAIGN = bool(os.environ.get("ROCKING_CAMPAIGN"))
INJECTIONS = 1_000
PATHOLOGICAL = {"fast": 10_000, "reference": 10_000 if CAMPAIGN else 200}
POISON = (math.nan, math.inf, -math.inf, -math.nan)
REALS = ("peak_rotation", "peak_time", "peak_velocity", "truncation")
HALF_PI = 0.5 * math.pi


@pytest.fixture(autouse=True)
def _no_hang() -> Iterator[None]:
    """Whatever takes ten minutes has hung: the run ends with a trace of where."""
    faulthandler.dump_traceback_later(600.0, exit=True)
    yield
    faulthandler.cancel_dump_traceback_later()


def ordinary(count: int, seed: int) -> dict[str, Any]:
    """Rows that every engine can compute."""
    random = np.random.default_rng([77, seed])
    ranges = {"alpha": (0.08, 0.6), "p": (0.8, 6.0), "r": (0.1, 0.97), "share": (0.3, 1.0)}
    values = {f"{name}_{side}": random.uniform(*ranges[name], count) for name in ranges for side in ("right", "left")}
    motion = {"scale": random.uniform(0.2, 2.0, count), "rotation": random.uniform(-0.05, 0.05, count)}
    return values | motion | {"velocity": random.uniform(-0.1, 0.1, count)}


def run(
    values: dict[str, Any], motions: list[Segments], which: Any, name: str, settings: PlaneSettings | None = None
) -> dict[str, Any]:
    batch = Batch(motions, ConstantRestitution(), settings or PlaneSettings(most_events=2_000), 2, name)

    def rows(first: int, last: int) -> Rows:
        part = slice(first, last)
        return Rows.of(last - first, which[part], **{key: v[part] for key, v in values.items()})

    # an overflow on the way to a refusal is no failure, a wrong number would be
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        return batch.run(which.size, rows)[0]


def false_success(found: dict[str, Any], *, linear: bool = False) -> Any:
    """Rows whose numbers do not fit their status; only the linear model knows no ground beyond a quarter turn."""
    good = found["status"] == Status.GOOD.code
    down, failed = found["outcome"] == Outcome.OVERTURNED.code, found["outcome"] == Outcome.FAILED.code
    still = found["outcome"] == Outcome.NO_UPLIFT.code
    finite = np.all([np.isfinite(found[key]) for key in REALS], axis=0)
    none = np.all([np.isnan(found[key]) for key in REALS], axis=0)
    known = np.isin(found["status"], range(len(Status))) & np.isin(found["outcome"], range(len(Outcome)))
    with np.errstate(invalid="ignore"):
        fits = (np.abs(found["peak_rotation"]) <= (math.inf if linear else HALF_PI)) & (found["peak_time"] >= 0.0)
        fits &= (found["truncation"] >= 0.0) & (found["peak_velocity"] >= 0.0)
    fits &= np.isfinite(found["overturning_time"]) == down
    fits &= (np.abs(found["side"]) == 1) == down
    fits &= ~still | ((found["peak_rotation"] == 0.0) & (found["impacts"] + found["uplifts"] == 0))
    fits &= (found["impacts"] >= 0) & (found["uplifts"] >= 0)
    return ~(known & (good != failed) & np.where(good, finite & fits, none))


_USED = [name for name in ROWS if name not in ("azimuth", "friction")]
"""What the engines of pure rocking are told: they know neither."""

# ---- poison ---------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.verifies(against="NaN and infinities in 1,000 rows; rows between them keep their bits")
@every_engine
def test_poisoned_rows(name: str) -> None:
    """1,000 rows with NaN or infinity in one of their numbers are refused; the rows between them keep their bits."""
    values = ordinary(2 * INJECTIONS if name == "fast" or CAMPAIGN else 1_100, 1)
    count, motions = values["scale"].size, [Segments.between_samples(0.05, 3.0 * np.sin(0.1 * np.arange(60)))]
    which, random = np.zeros(count, np.int64), np.random.default_rng(5)
    ill = random.permutation(count)[:INJECTIONS]
    clean = run({key: np.delete(v, ill) for key, v in values.items()}, motions, np.delete(which, ill), name)
    for k, row in enumerate(ill):
        values[_USED[k % len(_USED)]][row] = POISON[k % len(POISON)]
    found = run(values, motions, which, name)
    assert not false_success(found).any()
    assert (found["status"][ill] == Status.INVALID.code).all()
    assert (found["impacts"][ill] == 0).all()
    assert (clean["status"] == Status.GOOD.code).all()
    assert all(np.delete(found[key], ill).tobytes() == clean[key].tobytes() for key in fast_engine.RESULTS)


@pytest.mark.verifies(against="NaN and infinities in samples; other motions keep their bits")
@every_engine
@pytest.mark.parametrize("vertical", [False, True])
def test_poisoned_motions(name: str, vertical: bool) -> None:
    """NaN or infinity within a motion: refused, or no success that went through it and no effect on other motions."""
    count = 125
    values, random, motions = ordinary(2 * count, 2), np.random.default_rng(6), []
    bad, at = np.arange(2 * count) % 2 == 1, random.integers(0, 40, 2 * count)
    with np.errstate(invalid="ignore"):
        for k in range(2 * count):
            x, z = 6.0 * random.normal(size=(2, 40))
            if bad[k]:
                (z if vertical and k % 4 == 1 else x)[at[k]] = POISON[k // 2 % len(POISON)]
            try:
                motions.append(Segments.between_samples(0.05, x, z if vertical else None))
            except RockingError:
                assert bad[k]
                motions.append(Segments.still(0.05, 1))
        try:
            found = run(values, motions, np.arange(2 * count), name)
        except RockingError:
            return
    assert not false_success(found).any()
    # what fell before the poison was met is a true result
    through = bad & ~(found["overturning_time"] <= 0.05 * (at - 1)) & [m.count > 1 for m in motions]
    assert (found["status"][through] != Status.GOOD.code).all()
    healthy = np.flatnonzero(~bad)
    clean = run({key: v[healthy] for key, v in values.items()}, [motions[k] for k in healthy], np.arange(count), name)
    assert all(found[key][healthy].tobytes() == clean[key].tobytes() for key in fast_engine.RESULTS)


def extreme(random: np.random.Generator, count: int) -> dict[str, Any]:
    """Numbers from all over the floating-point line, most of them outside what is allowed or at its ends."""

    def pick(*special: float, low: float, high: float) -> Any:
        wide = 10.0 ** random.uniform(low, high, count) * random.choice([1.0, 1.0, 1.0, -1.0], count)
        return np.where(random.uniform(size=count) < 0.4, random.choice(special, count), wide)

    sane = ordinary(count, 3)
    angle = (1e-300, 1e-12, 1e-6, HALF_PI, np.nextafter(HALF_PI, 0.0), HALF_PI - 1e-9, 1.5, math.pi, 0.0, -0.1, 5e-324)
    speed = (1e-9, 1.0000001e-9, 1e9, 9.99e8, 0.0, -1.0, 1e300, 1e-300)
    ratio = (0.0, 1.0, 1.0 + 1e-15, 100.0, 100.1, -0.0, -1e-300, 2.0, 1e-300)
    share = (0.0, 1.0, 1.0 + 1e-15, 5e-324, -0.0, -1.0)
    odd = {
        f"{key}_{side}": pick(*special, low=low, high=high)
        for key, special, low, high in (
            ("alpha", angle, -20.0, 0.3),
            ("p", speed, -10.0, 10.0),
            ("r", ratio, -9.0, 2.5),
            ("share", share, -9.0, 0.3),
        )
        for side in ("right", "left")
    }
    odd["scale"] = pick(0.0, -0.0, 1e9, -1e9, 1.1e9, 1e-300, 5e-324, 1e300, low=-12.0, high=10.0)
    odd["rotation"] = pick(0.0, HALF_PI, -np.nextafter(HALF_PI, 0.0), 5e-324, 1.0, low=-20.0, high=0.3)
    odd["velocity"] = pick(0.0, 1e9, -9.99e8, 5e-324, 1e300, low=-20.0, high=10.0)
    # one to nine odd numbers a row: with all of them odd nearly every row would be refused at once
    share = random.uniform(0.1, 1.0, count)
    return {key: np.where(random.uniform(size=count) < share, odd[key], sane[key]) for key in _USED}


def monsters(random: np.random.Generator) -> list[Segments]:
    """Motions on steps from 1e-9 to 1e3 s with peaks from 1e-3 to 1e6 m/s2, and rest of the ground on the same."""
    motions = []
    for step in (1e-9, 1e-3, 0.05, 1.0, 1e3):
        x, z = random.normal(size=(2, 12)) * 10.0 ** random.uniform(-3.0, 6.0, (2, 1))
        motions += [Segments.between_samples(step, x, z), Segments.between_samples(step, np.zeros(12), None)]
    return motions


@pytest.mark.slow
@pytest.mark.verifies(against="numbers from all over the floating-point line, and the allowed ranges written once more")
@every_engine
@pytest.mark.parametrize("linear", [False, True])
def test_pathological_parameters(name: str, linear: bool) -> None:
    """10,000 rows of extremes on motions of extremes: a status each, no false success, and many of either."""
    count = PATHOLOGICAL[name] // 2
    random = np.random.default_rng([9, linear])
    values, motions = extreme(random, count), monsters(random)
    which = random.integers(-1, len(motions) + 1, count)
    # p times the step above 1e5 has a test of its own, below
    long = np.fmax(values["p_right"], values["p_left"]) * [motions[k % 10].step for k in which] > 1e5
    which[long] = random.integers(0, 2, int(long.sum()))
    settings = PlaneSettings(linear=linear, most_events=300, rest_speed=0.0 if linear else 0.01)
    found = run(values, motions, which, name, settings)
    # the ranges, written once more
    valid = (which >= 0) & (which < len(motions)) & (np.abs(values["scale"]) <= 1e9)
    valid &= (np.abs(values["rotation"]) < HALF_PI) & (np.abs(values["velocity"]) < 1e9)
    for side in ("right", "left"):
        alpha, p, r, share = (values[f"{key}_{side}"] for key in ("alpha", "p", "r", "share"))
        valid &= (share > 0.0) & (share <= 1.0)
        valid &= (alpha > 0.0) & (alpha < HALF_PI) & (p > 1e-9) & (p < 1e9) & (r >= 0.0) & (r <= 100.0)
    assert np.array_equal(found["status"] == Status.INVALID.code, ~valid)
    assert 0.15 < valid.mean() < 0.85
    assert (found["status"] == Status.GOOD.code).mean() > 0.1
    wrong = np.flatnonzero(false_success(found, linear=linear))
    # what no row may be (the message shows up to three in full)
    assert not wrong.size, (wrong.size, [{key: v[k] for key, v in {**values, **found}.items()} for k in wrong[:3]])


WAVE = "np.cos(np.arange(13.0))"
HANGS = {
    "long steps": ("[Segments.still(1e3, 2)]", "False", {"p_right": 9e8}),
    "sharp edge": (f"[Segments.between_samples(0.05, 0.0 * {WAVE}, 1e3 * {WAVE})]", "True", {"alpha_left": 1e-300}),
    "far away": (f"[Segments.between_samples(1.0, 1e6 * {WAVE}, 1e5 * {WAVE})]", "True", {"p_left": 2.0}),
}


@pytest.mark.slow
@pytest.mark.verifies(against="cases that hung once", within="20 minutes")
@every_engine
@pytest.mark.parametrize("case", HANGS)
def test_no_hang(case: str, name: str) -> None:
    """Steps of 1e12 / p, a slenderness of 1e-300, falls of exp(100): done or refused; none hangs."""
    motions, linear, odd = HANGS[case]
    row = {f"{key}_{side}": x for key, x in (("alpha", 0.2), ("p", 2.0), ("r", 0.5)) for side in ("right", "left")}
    code = (
        "import numpy as np; from rocking.dynamics.batch import Batch; from rocking.dynamics.rows import Rows\n"
        "from rocking.dynamics import PlaneSettings; from rocking.motions.segments import Segments\n"
        f"batch = Batch({motions}, settings=PlaneSettings(linear={linear}), engine={name!r})\n"
        f"batch.run(1, lambda a, b: Rows.of(1, **{row | odd | {'rotation': -0.05}}))"
    )
    subprocess.run([sys.executable, "-W", "ignore", "-c", code], check=True, timeout=HANG)
