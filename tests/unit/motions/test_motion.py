"""Ground motions: what is refused, what is copied and frozen, and what a changed one remembers."""

import math
import pickle
from typing import Any

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, scaled_to


def motion_of(samples: Any, step: Any = 0.5, **more: Any) -> GroundMotion:
    return GroundMotion(samples, step, **more)


@pytest.mark.parametrize("name", ["acceleration", "vertical"])
@pytest.mark.parametrize(
    ("samples", "message"),
    [
        ([0.0, math.nan, 1.0], "must be finite and within 1e\\+06 m/s2, got nan at index 1; wrong unit or damaged"),
        ([0.0, 1.0, math.inf], "got inf at index 2"),
        ([-math.inf, 1.0, 2.0], "got -inf at index 0"),
        ([0.0, 1.000001e6, 0.0], "within 1e\\+06 m/s2, got 1e\\+06 at index 1"),
        ([1.0], r"must be a row of at least 2 samples \[m/s2\], got shape \(1,\)"),
        ([], r"got shape \(0,\)"),
        (3.0, r"got shape \(\)"),
        ([[0.0, 1.0], [2.0, 3.0]], r"got shape \(2, 2\)"),
        (["0", "1"], "must be numbers"),
        ([None, 1.0], "must be numbers"),
        ([True, False], "must be numbers"),
        ([1j, 2.0], "must be numbers"),
        ([[1.0], [1.0, 2.0]], "must be numbers"),
        ("0 1 2", "must be numbers"),
    ],
)
def test_bad_samples(name: str, samples: Any, message: str) -> None:
    """Samples that are no row of at least two finite numbers within 1e6 m/s2 are refused, with name and index."""
    given: dict[str, Any] = {"acceleration": [0.0, 1.0, 2.0], name: samples}
    with pytest.raises(InvalidValueError, match=f"{name} .*{message}"):
        motion_of(given.pop("acceleration"), **given)


@pytest.mark.parametrize("step", [0.0, -0.01, math.nan, math.inf, None, "0.01", True, [0.1, 0.2], 1e-10, 1001.0])
def test_bad_steps(step: Any) -> None:
    """A step that is no number in [1e-9, 1000] s is refused."""
    with pytest.raises(InvalidValueError, match="time_step must be"):
        motion_of([0.0, 1.0], step)


def test_the_limits_themselves_are_allowed() -> None:
    """1e6 m/s2, steps of 1e-9 s and of 1000 s, and two samples are a motion; parts of two lengths are none."""
    assert motion_of([1e6, -1e6], 1e-9).peak == 1e6
    assert motion_of([0, 1], 1000).duration == 1000.0
    with pytest.raises(InvalidValueError, match="as many samples as acceleration, 3, got 2"):
        motion_of([0.0, 1.0, 2.0], vertical=[0.0, 1.0])


def test_numbers_of_a_motion() -> None:
    """Length, duration, times and peaks of a motion written by hand; whole numbers become float64."""
    motion = motion_of([0, 1, -4, 2], 0.25, vertical=[0, 0, 3, -5], name="by hand")
    assert (len(motion), motion.duration, motion.peak, motion.peak_vertical) == (4, 0.75, 4.0, 5.0)
    assert motion.acceleration.dtype == np.float64
    assert motion.time.tolist() == [0.0, 0.25, 0.5, 0.75]
    assert repr(motion) == "<GroundMotion 'by hand': 4 samples at 0.25 s, peak 4 m/s2, with vertical>"
    assert motion_of([0, 1]).peak_vertical == 0.0
    assert "vertical" not in repr(motion_of([0, 1]))


def test_copied_and_frozen() -> None:
    """Neither the user's array nor anybody else can change a motion afterwards."""
    samples = np.array([0.0, 1.0, 2.0])
    motion = motion_of(samples, vertical=samples, metadata={"station": 1})
    samples[1] = 99.0
    assert motion.acceleration.tolist() == [0.0, 1.0, 2.0]
    for part in (motion.acceleration, motion.vertical):
        assert part is not None
        with pytest.raises(ValueError, match="read-only"):
            part[0] = 1.0
    with pytest.raises(AttributeError):
        motion.time_step = 1.0  # type: ignore[misc]
    with pytest.raises(TypeError):
        motion.metadata["station"] = "2"  # type: ignore[index]
    assert motion.metadata == {"station": "1"}
    # two motions of the same samples are two motions, and each can be a key of a dictionary
    assert len({motion_of([0.0, 1.0]), motion_of([0.0, 1.0])}) == 2


@pytest.mark.parametrize(
    ("field", "values", "message"),
    [
        ("name", [None, 5, b"x", ["x"]], "name must be a string, got"),
        ("metadata", [None, "a=b", ["a"], [("a", "b")]], "metadata must be a mapping of strings to strings, got"),
        ("provenance", [None, "abc", b"abc", 5, {"abc"}, [None], ["made", 5]], "provenance must be a sequence of str"),
    ],
)
def test_words_of_a_record(field: str, values: list[Any], message: str) -> None:
    """Name, metadata and provenance of another kind are refused: no string taken for a row of letters."""
    for value in values:
        more: Any = {field: value}
        with pytest.raises(InvalidValueError, match=message):
            motion_of([0.0, 1.0], **more)
    made = motion_of([0.0, 1.0], name="x", metadata={"a": "b"}, provenance=["made"])
    assert (made.name, made.metadata, made.provenance) == ("x", {"a": "b"}, ("made",))


def test_changed_adds_a_line_and_nothing_else() -> None:
    """A changed copy keeps what was not named; the original keeps its provenance; checks run again."""
    motion = motion_of([0.0, 1.0], vertical=[0.0, 2.0], name="old", metadata={"a": "b"}, provenance=("made",))
    new = motion.changed("renamed", name="new")
    assert new.name == "new"
    assert new.provenance == ("made", "renamed")
    assert new.metadata == {"a": "b"}
    assert new.vertical is not None
    assert new.vertical.tolist() == [0.0, 2.0]
    assert motion.name == "old"
    assert motion.provenance == ("made",)
    with pytest.raises(InvalidValueError, match="index 1"):
        motion.changed("broken", acceleration=[0.0, math.nan])


def test_scaled() -> None:
    """A factor multiplies both parts and is written down; one that is no number, or too large, is refused."""
    motion = motion_of([0.0, 1.0, -3.0], vertical=[1.0, 0.0, 2.0])
    new = motion.scaled(-2)
    assert new.acceleration.tolist() == [0.0, -2.0, 6.0]
    assert new.vertical is not None
    assert new.vertical.tolist() == [-2.0, 0.0, -4.0]
    assert new.provenance == ("multiplied by -2.0",)
    assert motion_of([0.0, 1.0]).scaled(2.0).vertical is None
    bad: Any
    for bad in (math.nan, math.inf, None, "2", True, [1.0, 2.0]):
        with pytest.raises(InvalidValueError, match="factor must be"):
            motion.scaled(bad)
    with pytest.raises(InvalidValueError, match="wrong unit"):
        motion.scaled(1e6)
    assert scaled_to(motion, "pga", 6.0).acceleration.tolist() == [0.0, 2.0, -6.0]


@pytest.mark.parametrize("vertical", [None, [0.0, 1.0, 5.0]])
def test_pickled(vertical: Any) -> None:
    """A motion survives pickling with everything it knows, and is as frozen as before."""
    motion = motion_of([0.0, 1.0, 2.0], vertical=vertical, metadata={"a": "b"}, provenance=("made",), name="x")
    back = pickle.loads(pickle.dumps(motion))
    assert back.acceleration.tolist() == [0.0, 1.0, 2.0]
    assert (back.vertical is None) if vertical is None else (back.vertical.tolist() == vertical)
    assert (back.name, back.time_step, back.provenance, dict(back.metadata)) == ("x", 0.5, ("made",), {"a": "b"})
    for part in filter(lambda p: p is not None, (back.acceleration, back.vertical)):
        assert not part.flags.writeable
    with pytest.raises(TypeError):
        back.metadata["a"] = "c"
