"""Ground motions: what is refused, what is copied and frozen, and what a changed one remembers."""

import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from rocking import motions
from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, Segments, pulses, scaled_to


def motion_of(samples: Any, step: Any = 0.5, **more: Any) -> GroundMotion:
    return GroundMotion(samples, step, **more)


@pytest.mark.parametrize("name", ["acceleration", "vertical"])
@pytest.mark.parametrize(
    ("samples", "message"),
    [
        ([0.0, math.nan, 1.0], "must be finite and within 1e\\+06 m/s2, got nan at index 1"),
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
    with pytest.raises(InvalidValueError, match="check the unit"):
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


RECORD = pulses.sine(3.0, 0.8).sampled(0.01)
FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    "arias_intensity": motions.arias_intensity,
    "bandpassed": lambda m: motions.bandpassed(m, 0.5, 10.0),
    "cumulative_absolute_velocity": motions.cumulative_absolute_velocity,
    "demeaned": motions.demeaned,
    "detrended": motions.detrended,
    "fourier_amplitudes": motions.fourier_amplitudes,
    "ground_displacement": motions.ground_displacement,
    "ground_velocity": motions.ground_velocity,
    "housner_intensity": motions.housner_intensity,
    "intensity_measures": motions.intensity_measures,
    "normalised_acceleration": lambda m: motions.normalised_acceleration(m, 0.2),
    "normalised_velocity": lambda m: motions.normalised_velocity(m, 0.2, 2.0),
    "padded": lambda m: motions.padded(m, 0.1),
    "peak_ground_acceleration": motions.peak_ground_acceleration,
    "peak_ground_displacement": motions.peak_ground_displacement,
    "peak_ground_velocity": motions.peak_ground_velocity,
    "processed": lambda m: motions.processed(m, "mean"),
    "resampled": lambda m: motions.resampled(m, 0.005),
    "response_spectrum": lambda m: motions.response_spectrum(m, [0.5]),
    "rotated": lambda m: motions.rotated(m, RECORD, 0.1),
    "rotd_pga": lambda m: motions.rotd_pga(m, RECORD, 50.0),
    "rotd_spectrum": lambda m: motions.rotd_spectrum(m, RECORD, [0.5]),
    "scaled_to": lambda m: motions.scaled_to(m, "arias", 1.0),
    "significant_duration": motions.significant_duration,
    "significant_times": motions.significant_times,
    "spectral_acceleration": lambda m: motions.spectral_acceleration(m, 0.5),
    "tapered": motions.tapered,
    "trimmed": lambda m: motions.trimmed(m, 0.1, 0.2),
    "trimmed_to_significant": motions.trimmed_to_significant,
    "with_vertical": lambda m: motions.with_vertical(m, RECORD),
}
OTHERS = [pulses.sine(3.0, 0.8), None, "record.txt", [0.0, 1.0], RECORD.acceleration, 3.0, motions.GroundMotion]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_only_records(name: str) -> None:
    """Every function takes a record; a pulse, a row of numbers and the like are refused, naming the way out."""
    for other in OTHERS:
        with pytest.raises(InvalidValueError, match=r"(motion|first|horizontal) must be a GroundMotion, got .*sampled"):
            FUNCTIONS[name](other)
    assert FUNCTIONS[name](RECORD) is not None


def test_both_components_are_checked() -> None:
    """The second component of a pair is named."""
    with pytest.raises(InvalidValueError, match="second must be a GroundMotion, got Sinusoids"):
        motions.rotated(RECORD, pulses.sine(3.0, 0.8), 0.1)  # type: ignore[arg-type]


def test_every_function_of_a_record_is_here() -> None:
    """What the package offers for records is in the table above, so that no new function is forgotten."""
    offered = {n for n in motions.__all__ if callable(getattr(motions, n)) and n[0].islower()}
    of_none_or_many = {"measure", "measures", "spectral_measure", "flatfile", "selected", "target_spectrum"}
    assert offered - of_none_or_many <= set(FUNCTIONS)


MOTION = GroundMotion(np.array([0.0, 1.0, -2.0, 0.5]), 0.2, vertical=np.array([1.0, 1.0, 0.0, 4.0]))


def test_lines_between_samples() -> None:
    """A record is one straight line a step: value at its start, and rise over it; the vertical part too."""
    segments = MOTION.segments()
    assert segments.horizontal.tolist() == [[0.0, 1.0], [1.0, -3.0], [-2.0, 2.5]]
    assert segments.vertical is not None
    assert segments.vertical.tolist() == [[1.0, 0.0], [1.0, -1.0], [0.0, 4.0]]
    assert (segments.count, segments.degree, segments.step) == (3, 1, 0.2)
    assert segments.duration == pytest.approx(0.6, rel=1e-15, abs=0.0)
    assert GroundMotion(np.array([0.0, 1.0]), 0.2).segments().vertical is None


def test_refined_is_the_same_motion() -> None:
    """Each line cut into four is four lines with the values in between; one part is the motion itself."""
    segments = MOTION.segments()
    cut = segments.refined(4)
    assert cut.count == 12
    assert cut.step == pytest.approx(0.05, rel=1e-15, abs=0.0)
    np.testing.assert_allclose(cut.horizontal[4:8, 0], [1.0, 0.25, -0.5, -1.25], rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(cut.horizontal[4:8, 1], np.full(4, -0.75), rtol=0.0, atol=1e-15)
    assert cut.vertical is not None
    np.testing.assert_allclose(cut.vertical[8:, 0], [0.0, 1.0, 2.0, 3.0], rtol=0.0, atol=1e-15)
    assert segments.refined(1) is segments
    assert segments.refined(0) is segments


def test_refined_powers() -> None:
    """tau^7 cut in two is (tau / 2)^7 and, by the binomial series, ((1 + tau) / 2)^7."""
    one = Segments(1.0, np.eye(8)[7:])
    half = one.refined(2).horizontal * 2.0**7
    np.testing.assert_allclose(half[0], np.eye(8)[7], rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(half[1], [1.0, 7.0, 21.0, 35.0, 35.0, 21.0, 7.0, 1.0], rtol=1e-14)


def test_polynomials_of_degree_seven_are_exact() -> None:
    """Interpolation gives back 1 + (1 + t) + ... + (1 + t)^7 to rounding, and misses t^8 (the control)."""
    tau = np.linspace(0.0, 1.0, 101)
    powers = tau[:, None] ** np.arange(8)
    expected = ((1.0 + tau[:, None]) ** np.arange(8)).sum(axis=1)
    made = Segments.of_function(lambda t: ((1.0 + t[:, None]) ** np.arange(8)).sum(axis=1), 1.0, 1)
    np.testing.assert_allclose(powers @ made.horizontal[0], expected, rtol=1e-13)
    off = Segments.of_function(lambda t: t**8, 1.0, 1)
    assert np.abs(powers @ off.horizontal[0] - tau**8).max() > 1e-6


def test_extended_with_rest() -> None:
    """The ground rests after the motion, up to a whole number of steps; a motion long enough stays itself."""
    segments = MOTION.segments()
    longer = segments.extended(0.95)
    assert longer.count == 5
    assert not longer.horizontal[3:].any()
    assert longer.vertical is not None
    assert not longer.vertical[3:].any()
    assert longer.vertical.shape == (5, 2)
    np.testing.assert_array_equal(longer.horizontal[:3], segments.horizontal)
    assert segments.extended(0.6) is segments
    assert segments.extended(0.1) is segments
    assert Segments.still(0.1, 2).extended(0.3).vertical is None


def test_still() -> None:
    """Ground at rest is zeros."""
    still = Segments.still(0.5, 4)
    assert still.duration == 2.0
    assert still.horizontal.shape == (4, 2)
    assert not still.horizontal.any()
