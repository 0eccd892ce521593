"""Rows and batches: what they take, what they refuse, and that a bad row spoils nothing but itself."""

import math
from typing import Any

import numpy as np
import pytest
from engines import built, every_engine

from rocking.dynamics import Outcome, PlaneSettings, Status
from rocking.dynamics.batch import Batch
from rocking.dynamics.plane.batch import valid_row
from rocking.dynamics.plane.fast_engine import RESULTS, library_of
from rocking.dynamics.rows import ROWS, Rows
from rocking.dynamics.settings import processors
from rocking.errors import InvalidValueError
from rocking.motions import Segments, pulses

GOOD: dict[str, Any] = {
    "alpha_right": 0.25, "alpha_left": 0.2, "p_right": 2.5, "p_left": 2.6, "r_right": 0.9, "r_left": 0.85,
    "q_right": 0.75, "q_left": 0.7, "share_right": 1.0, "share_left": 0.9,
}  # fmt: skip
MOTION = Segments.between_samples(0.05, 4.0 * np.sin(0.3 * np.arange(60)))
SCALES = np.linspace(0.3, 1.4, 9)


def run(name: str, count: int = 9, motion: Any = 0, motions: Any = (MOTION,), **changed: Any) -> dict[str, Any]:
    values = {**GOOD, "scale": SCALES, **changed}

    def rows(first: int, last: int) -> Rows:
        return Rows.of(last - first, motion, **values)

    return Batch(motions, settings=PlaneSettings(most_events=500), threads=2, engine=name).run(count, rows)[0]


def same(one: dict[str, Any], other: dict[str, Any], where: Any = slice(None)) -> bool:
    return all(one[key][where].tobytes() == other[key][where].tobytes() for key in RESULTS)


# ---- rows -----------------------------------------------------------------------------------------------------------


def test_rows_are_repeated() -> None:
    """One number stands for all rows; scale is 1, motion, rotation and velocity are 0, keys count up."""
    rows = Rows.of(3, **{**GOOD, "alpha_left": [0.1, 0.2, 0.3]})
    assert len(rows) == 3
    assert list(rows.values) == list(ROWS)
    assert rows.values["alpha_left"].tolist() == [0.1, 0.2, 0.3]
    assert rows.values["scale"].tolist() == [1.0, 1.0, 1.0]
    assert not any(rows.values[key].any() for key in ("rotation", "velocity"))
    assert (rows.stream.tolist(), rows.motion.tolist()) == ([0, 1, 2], [0, 0, 0])
    assert all(v.dtype == np.float64 and v.flags.c_contiguous for v in rows.values.values())
    assert Rows.of(2, 1, 5, **GOOD).stream.tolist() == [5, 5]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"scale": [1.0, 2.0]}, "rows must be numbers, or arrays of 3"),
        ({"scale": np.ones((3, 3))}, "rows must be numbers, or arrays of 3"),
        ({"scale": "one"}, "rows must be numbers, or arrays of 3"),
        ({"r_left": [0.1, {}, 0.2]}, "rows must be numbers, or arrays of 3"),
        ({"colour": 1.0}, "missing or unknown: colour"),
    ],
)
def test_bad_rows(changed: dict[str, Any], message: str) -> None:
    """Arrays of another length, words, and keys that no row has are refused."""
    with pytest.raises(InvalidValueError, match=message):
        Rows.of(3, **{**GOOD, **changed})


def test_missing_keys() -> None:
    """A row without its coefficients is refused, with the keys that rows have."""
    with pytest.raises(InvalidValueError, match=r"rows have alpha_right, .*; missing or unknown: r_left, r_right"):
        Rows.of(1, **{k: v for k, v in GOOD.items() if not k.startswith("r_")})
    with pytest.raises(InvalidValueError, match="rows must be numbers"):
        Rows.of(2, [0, 1, 2], **GOOD)
    with pytest.raises(InvalidValueError, match="rows must be numbers"):
        Rows.of(2, 0, ["a", "b"], **GOOD)


# ---- results --------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@every_engine
def test_all_outcomes_and_types(name: str) -> None:
    """Weak, middling and strong motions end in the three ways; results have the types that they promise."""
    found = run(name)
    assert set(found) == set(RESULTS)
    assert all(found[key].dtype == dtype and found[key].shape == (9,) for key, dtype in RESULTS.items())
    assert set(found["outcome"].tolist()) == {Outcome.NO_UPLIFT.code, Outcome.ROCKED.code, Outcome.OVERTURNED.code}
    still, down = found["outcome"] == Outcome.NO_UPLIFT.code, found["outcome"] == Outcome.OVERTURNED.code
    assert not found["peak_rotation"][still].any()
    np.testing.assert_array_equal(np.abs(found["peak_rotation"][down]), 0.5 * math.pi)
    np.testing.assert_array_equal(np.isnan(found["overturning_time"]), ~down)
    np.testing.assert_array_equal(np.isnan(found["first_uplift"]), still)
    np.testing.assert_array_equal(found["side"] != 0, down)


OF_ROCKING = [key for key in ROWS if key not in {"friction", "azimuth"}]
BAD = [(key, value) for key in OF_ROCKING if not key.startswith("q_") for value in (math.nan, math.inf, -math.inf)] + [
    ("alpha_right", 0.0), ("alpha_left", 0.5 * math.pi), ("alpha_left", -0.1), ("p_right", 0.0), ("p_left", 1e9),
    ("r_right", -0.1), ("r_left", 101.0), ("scale", 1.1e9), ("rotation", 1.6), ("rotation", -1.6), ("velocity", 1e9),
]  # fmt: skip


@pytest.mark.slow
@every_engine
def test_bad_rows_spoil_nothing(name: str) -> None:
    """Rows with a value out of range are refused by their status, all numbers NaN; those between keep their bits."""
    ordinary, count = run(name), 9 + len(BAD)
    good = np.sort(np.random.default_rng(1).choice(count, 9, replace=False))
    bad = np.delete(np.arange(count), good)
    values: dict[str, Any] = {
        key: np.full(count, GOOD.get(key, float(key == "scale"))) for key in ROWS if key not in {"friction", "azimuth"}
    }
    values["scale"][good] = SCALES
    for row, (key, value) in zip(bad, BAD, strict=True):
        values[key][row] = value
    found = run(name, count, **values)
    assert set(found["status"][bad]) == {Status.INVALID.code}
    assert set(found["outcome"][bad]) == {Outcome.FAILED.code}
    assert all(np.isnan(found[key][bad]).all() for key, dtype in RESULTS.items() if dtype is np.float64)
    assert same({key: each[good] for key, each in found.items()}, ordinary)


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize("number", [-1, 1, 2**40, -(2**62)])
def test_a_motion_that_is_not_there(name: str, number: int) -> None:
    """A row that asks for a motion beyond the list is refused, and reads no memory but its own."""
    which = np.zeros(9, dtype=np.int64)
    which[2] = number
    found = run(name, motion=which)
    assert found["status"][2] == Status.INVALID.code
    assert same(found, run(name), np.arange(9) != 2)


@every_engine
def test_too_many_impacts(name: str) -> None:
    """A history of more impacts than allowed is stopped with its own status, and has no outcome."""
    still = Segments.still(0.05, 400)
    rotation = np.where(np.arange(3) == 1, 0.1, 0.0)
    batch = Batch([still], settings=PlaneSettings(most_events=4), engine=name)
    found, _ = batch.run(3, lambda first, last: Rows.of(last - first, **{**GOOD, "rotation": rotation}))
    assert found["status"].tolist() == [Status.GOOD.code, Status.TOO_MANY_EVENTS.code, Status.GOOD.code]
    assert (found["outcome"][1], found["impacts"][1]) == (Outcome.FAILED.code, 4)
    assert math.isnan(found["peak_rotation"][1])


@pytest.mark.slow
@every_engine
def test_pieces_and_progress(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows are asked for piece after piece, progress counts them all, and pieces leave no trace."""
    whole = run(name)
    asked: list[tuple[int, int]] = []
    done: list[int] = []
    monkeypatch.setattr("rocking.dynamics.rows.PIECE", 4)

    def rows(first: int, last: int) -> Rows:
        asked.append((first, last))
        return Rows.of(last - first, **{**GOOD, "scale": SCALES[first:last]})

    found, work = Batch([MOTION], settings=PlaneSettings(most_events=500), engine=name).run(9, rows, done.append)
    assert asked == [(0, 4), (4, 8), (8, 9)]
    assert done == [4, 4, 1]
    assert same(found, whole)
    assert (work == {}) is (name == "reference")
    assert all(value > 0 for value in work.values())


@every_engine
def test_no_rows(name: str) -> None:
    """No histories are no results, and no error."""
    found, _ = Batch([MOTION], engine=name).run(0, lambda *_: Rows.of(0, **GOOD))
    assert all(values.size == 0 for values in found.values())


def test_valid_row() -> None:
    """The check of the reference engine takes a good row and refuses every bad one."""
    row = {**GOOD, "scale": 1.0, "rotation": 0.0, "velocity": 0.0}
    assert valid_row(row)
    assert not any(valid_row({**row, key: value}) for key, value in BAD)


@pytest.mark.slow
@built
def test_a_record_that_ends_in_mid_motion() -> None:
    """The jump to rest after a last sample that is not zero is the same jump for both engines; two are refused."""
    cut = Segments.between_samples(0.05, 4.0 * np.sin(0.3 * np.arange(27))).extended(3.0)
    fast, slow = run("fast", motions=(cut,)), run("reference", motions=(cut,))
    np.testing.assert_array_equal(fast["outcome"], slow["outcome"])
    np.testing.assert_allclose(fast["peak_rotation"], slow["peak_rotation"], rtol=1e-9)
    assert not same(fast, run("fast", motions=(Segments(0.05, cut.horizontal[:25]).extended(3.0),))), "control"
    lines = cut.horizontal.copy()
    lines[5] = 0.0
    with pytest.raises(InvalidValueError, match="records without jumps between samples, got 3"):
        library_of([Segments(0.05, lines)])


def test_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the system does not tell which processors may be used, all are counted, and at least one."""
    monkeypatch.delattr("os.sched_getaffinity", raising=False)
    for told, expected in ((6, 6), (None, 1)):
        monkeypatch.setattr("os.cpu_count", lambda told=told: told)
        assert processors() == expected


@built
def test_libraries() -> None:
    """Motions of one batch are of one kind; none at all, a pulse with a vertical part, or other degrees are refused."""
    pulse = pulses.sine(1.0, 0.5).segments()
    for motions, message in (
        ([], "motions must contain at least one motion, got none"),
        ([MOTION, pulse], "all records or all pulses; sample the pulses"),
        ([Segments(0.1, np.zeros((3, 4)))], "all records or all pulses"),
        ([Segments(0.1, np.zeros((3, 8)), np.zeros((3, 8)))], "a pulse cannot have a vertical component; sample it"),
    ):
        with pytest.raises(InvalidValueError, match=message):
            library_of(motions)
    with_vertical = Segments.between_samples(0.05, np.zeros(60), np.zeros(60))
    assert same(run("fast", motions=(MOTION, with_vertical)), run("fast")), "zeros stand for no vertical part"


@every_engine
def test_speed_of_the_first_impact_after_the_motion(name: str) -> None:
    """A body that still falls when the motion ends lands with p sqrt(2 (cos(alpha - theta) - cos alpha))."""
    alpha, p, start = 0.25, 2.0, 0.1
    values = {f"{key}_{side}": x for key, x in (("alpha", alpha), ("p", p), ("r", 0.9)) for side in ("right", "left")}
    batch = Batch([Segments.still(0.01, 2)], threads=1, engine=name)
    found, _ = batch.run(1, lambda first, last: Rows.of(last - first, rotation=start, **values))
    landing = p * math.sqrt(2.0 * (math.cos(alpha - start) - math.cos(alpha)))
    assert found["peak_velocity"][0] == pytest.approx(landing, rel=1e-12, abs=0.0)
    assert found["impacts"][0] == 0


@pytest.mark.slow
@every_engine
def test_what_still_rocks_when_the_motion_ends(name: str) -> None:
    """A pulse that ends abruptly leaves the body rocking; with a minute of rest after it nothing rocks."""
    push = 4.0 * np.sin(0.3 * np.arange(60))
    long = Segments.between_samples(0.05, np.concatenate([push, np.zeros(1200)]))
    short, rested = (run(name, motion=k, motions=(MOTION, long)) for k in (0, 1))
    rocked = short["outcome"] == Outcome.ROCKED.code
    assert rocked.any()
    assert (short["outcome"] == Outcome.OVERTURNED.code).any()
    assert (short["outcome"] == Outcome.NO_UPLIFT.code).any()
    np.testing.assert_array_equal(short["still_rocking"], rocked)
    assert not rested["still_rocking"].any()
    assert (rested["outcome"] == Outcome.ROCKED.code).any()
