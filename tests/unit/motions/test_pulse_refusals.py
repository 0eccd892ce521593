"""What pulses refuse, how they are sampled, and how they are written in one word."""

import math
from typing import Any

import numpy as np
import pytest

from rocking.errors import InvalidValueError, UnknownModelError
from rocking.motions import pulses

USUAL: dict[str, dict[str, float]] = {
    "rectangular": {"amplitude": 3.0, "duration": 0.8},
    "mavroeidis-papageorgiou": {"velocity": 0.5, "period": 0.8},
    "harmonic": {"amplitude": 3.0, "period": 0.8, "cycles": 2.0},
}
ORDINARY = {"amplitude": 3.0, "period": 0.8}
BAD: list[Any] = [math.nan, math.inf, -math.inf, None, "3", True, [1.0, 2.0], 1j]

CASES = [
    (name, parameter, value)
    for name in sorted(pulses.catalogue())
    for parameter in USUAL.get(name, ORDINARY)
    for value in BAD
]


@pytest.mark.parametrize(("name", "parameter", "value"), CASES)
def test_what_is_no_number_is_refused(name: str, parameter: str, value: Any) -> None:
    """NaN, infinity, None, words, truth values and rows are refused by every pulse, naming the parameter."""
    with pytest.raises(InvalidValueError, match=f"{parameter} must be"):
        pulses.catalogue()[name](**{**USUAL.get(name, ORDINARY), parameter: value})


@pytest.mark.parametrize("name", sorted(set(pulses.catalogue()) - {"rectangular"}))
@pytest.mark.parametrize("value", [0.0, -0.8, 1e-7, 1e7])
def test_periods(name: str, value: float) -> None:
    """A period is refused outside [1e-6, 1e6] s, and the message says so."""
    with pytest.raises(InvalidValueError, match=r"period must be in \[1e-06, 1e\+06\] s, got"):
        pulses.catalogue()[name](**{**USUAL.get(name, ORDINARY), "period": value})


def test_other_ranges() -> None:
    """Duration above zero, amplitude within 1e6 m/s2, cycles from 1/2 or 1, n a whole number up to 1000."""
    for duration in (0.0, -1.0):
        with pytest.raises(InvalidValueError, match="duration must be > 0 s, got"):
            pulses.rectangular(1.0, duration)
    for amplitude in (1.1e6, -1.1e6):
        with pytest.raises(InvalidValueError, match=r"amplitude must be in \[-1e\+06, 1e\+06\] m/s2, got"):
            pulses.sine(amplitude, 1.0)
    with pytest.raises(InvalidValueError, match=r"cycles must be in \[0.5, 100000\], got 0.4"):
        pulses.harmonic(1.0, 1.0, 0.4)
    with pytest.raises(InvalidValueError, match="phase must be finite"):
        pulses.harmonic(1.0, 1.0, 2.0, math.inf)
    for cycles in (0.99, 1001.0):
        with pytest.raises(InvalidValueError, match=r"cycles must be in \[1, 1000\], got"):
            pulses.mavroeidis_papageorgiou(1.0, 1.0, cycles)
    n: Any
    for n in (0, -1, 1001, 1.0, 1.5, True, None, "1", math.nan):
        with pytest.raises(InvalidValueError, match=r"n must be a whole number in \[1, 1000\], got"):
            pulses.type_c(1.0, 1.0, n)


def test_a_pulse_of_nothing() -> None:
    """Amplitude zero is allowed: no motion, peak zero."""
    assert pulses.mavroeidis_papageorgiou(0.0, 0.8).peak == 0.0
    assert not pulses.sine(0.0, 0.8).displacement(np.linspace(0.0, 1.0, 9)).any()


def test_words_for_times_are_refused() -> None:
    """Times that are no numbers are refused by acceleration, velocity and displacement."""
    pulse = pulses.sine(3.0, 0.8)
    for quantity in (pulse.acceleration, pulse.velocity, pulse.displacement):
        for times in ("0.1", None, ["a"], [[1.0], [1.0, 2.0]]):
            with pytest.raises(InvalidValueError, match="time must be numbers"):
                quantity(times)


def test_sampled() -> None:
    """Samples are the pulse's own values, zero from its end on; the provenance tells pulse and step."""
    pulse = pulses.cosine(2.0, 0.5)
    motion = pulse.sampled(0.1)
    expected = [2.0 * math.cos(2.0 * math.pi * k / 5.0) for k in range(6)]
    np.testing.assert_allclose(motion.acceleration[:6], expected, rtol=0.0, atol=1e-14)
    assert motion.acceleration[-1] == 0.0
    assert motion.time_step == 0.1
    assert motion.name == pulse.name
    assert "sampled every 0.1 s" in motion.provenance[0]


def test_a_step_as_long_as_the_pulse() -> None:
    """The longest step leaves both ends of the pulse and the zero after it; a little more is refused."""
    pulse = pulses.cosine(2.0, 0.5)
    np.testing.assert_allclose(pulse.sampled(0.5).acceleration, [2.0, 2.0, 0.0], rtol=0.0, atol=1e-14)
    with pytest.raises(InvalidValueError, match=r"at most the pulse's duration 0\.5 s"):
        pulse.sampled(0.5 + 1e-12)


@pytest.mark.parametrize("step", [0.0, -0.1, math.nan, math.inf, None, "0.1", 0.51])
def test_bad_sampling_steps(step: Any) -> None:
    """A step that is no number above zero, or longer than the pulse, is refused."""
    with pytest.raises(InvalidValueError, match="time_step must be"):
        pulses.cosine(2.0, 0.5).sampled(step)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("sine:amplitude=3,period=0.8", pulses.sine(3.0, 0.8)),
        ("sine: amplitude = 3 , period = 8e-1 ", pulses.sine(3.0, 0.8)),
        ("rectangular:amplitude=-1,duration=2", pulses.rectangular(-1.0, 2.0)),
        ("half-cosine:period=2,amplitude=1,", pulses.half_cosine(1.0, 2.0)),
        ("type-c:amplitude=1,period=2,n=3", pulses.type_c(1.0, 2.0, 3)),
        ("antisymmetric-ricker:amplitude=1,period=2", pulses.antisymmetric_ricker(1.0, 2.0)),
        (
            "mavroeidis-papageorgiou:velocity=1,period=2,cycles=3,phase=0.5",
            pulses.mavroeidis_papageorgiou(1.0, 2.0, 3.0, 0.5),
        ),
    ],
)
def test_words(words: str, expected: object) -> None:
    """A pulse written in one word is the pulse that the function makes."""
    assert pulses.pulse(words) == expected


@pytest.mark.parametrize("words", ["", ":", "nope", "sinus:amplitude=3,period=0.8", "type_c:amplitude=1,period=1"])
def test_unknown_names(words: str) -> None:
    """An unknown name is refused with the list of known ones."""
    with pytest.raises(UnknownModelError, match=r"no pulse named .*; there are antisymmetric-ricker, cosine"):
        pulses.pulse(words)


@pytest.mark.parametrize(
    "words", ["sine", "sine:amplitude=3", "sine:amplitude=3,period=1,cycles=2", "sine:amplitude=3,Period=1"]
)
def test_missing_and_unknown_parameters(words: str) -> None:
    """A parameter missing or unknown is refused, and the message lists what the pulse takes."""
    with pytest.raises(UnknownModelError, match=r"pulse 'sine' takes (amplitude, period|period, amplitude); got"):
        pulses.pulse(words)


@pytest.mark.parametrize(
    "words", ["sine:3,0.8", "sine:amplitude=3,amplitude=4,period=1", "sine:amplitude:3", "sine:amplitude"]
)
def test_malformed_words(words: str) -> None:
    """What is not a list of name=value is refused with an example of how to write it."""
    with pytest.raises(UnknownModelError, match="write a pulse as sine:amplitude=3,period="):
        pulses.pulse(words)


@pytest.mark.parametrize(
    "words",
    ["sine:amplitude=three,period=1", "sine:amplitude=,period=1", "type-c:amplitude=1,period=1,n=1.5",
     "sine:amplitude=nan,period=1", "sine:amplitude=3,period=inf", "sine:amplitude=3,period=-1",
     "type-c:amplitude=1,period=1,n=0"],
)  # fmt: skip
def test_bad_numbers_in_words(words: str) -> None:
    """What is no number, or one out of range, is refused, naming the parameter."""
    with pytest.raises(InvalidValueError, match=r"(amplitude|period|n) must be"):
        pulses.pulse(words)
