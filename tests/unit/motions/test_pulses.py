"""Every pulse against its closed forms; its limits, how it is sampled, and how it is written in one word."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from rocking.errors import InvalidValueError, UnknownModelError
from rocking.motions import Pulse, Segments, pulses

pytestmark = pytest.mark.verifies(room="motions and records")

A, T = 3.0, 0.8
W = 2.0 * math.pi / T

PULSES: dict[str, Pulse] = {
    "rectangular": pulses.rectangular(A, T),
    "half-sine": pulses.half_sine(A, T),
    "sine": pulses.sine(A, T),
    "half-cosine": pulses.half_cosine(A, T),
    "cosine": pulses.cosine(A, T),
    "type-a": pulses.type_a(A, T),
    "type-b": pulses.type_b(A, T),
    "type-c": pulses.type_c(A, T, 2),
    "ricker": pulses.ricker(A, T),
    "antisymmetric-ricker": pulses.antisymmetric_ricker(A, T),
    "mavroeidis-papageorgiou": pulses.mavroeidis_papageorgiou(0.9, T, 2.2, 0.7),
    "harmonic": pulses.harmonic(A, T, 3.25, 0.4),
}

# velocity and displacement of the ground at the end of each pulse, integrated by hand
ENDS = {
    "rectangular": (A * T, 0.5 * A * T * T),
    "half-sine": (2.0 * A / W, math.pi * A / W**2),
    "sine": (0.0, 2.0 * math.pi * A / W**2),
    "half-cosine": (0.0, 2.0 * A / W**2),
    "cosine": (0.0, 0.0),
    "type-a": (0.0, 2.0 * math.pi * A / W**2),
    "type-b": (0.0, 0.0),
    "type-c": (0.0, 0.0),
    "ricker": (0.0, 0.0),
    "antisymmetric-ricker": (0.0, 0.0),
}

every = pytest.mark.parametrize("name", sorted(PULSES))


def first_derivative(f: Callable[[Any], Any], t: Any, h: float) -> Any:
    """Central differences of order 8."""
    return sum(c * (f(t + k * h) - f(t - k * h)) for k, c in enumerate((4 / 5, -1 / 5, 4 / 105, -1 / 280), 1)) / h


def second_derivative(f: Callable[[Any], Any], t: Any, h: float) -> Any:
    """Central differences of order 8."""
    sides = sum(c * (f(t + k * h) + f(t - k * h)) for k, c in enumerate((8 / 5, -1 / 5, 8 / 315, -1 / 560), 1))
    return (sides - 205 / 72 * f(t)) / h**2


def value_of(segments: Segments, time: Any) -> Any:
    """Value of the polynomials, by Horner's rule."""
    k = np.minimum((time / segments.step).astype(int), segments.count - 1)
    tau = time / segments.step - k
    total = np.zeros_like(tau)
    for c in segments.horizontal[k].T[::-1]:
        total = total * tau + c
    return total


@every
def test_acceleration_is_the_derivative(name: str) -> None:
    """Acceleration is the first derivative of velocity and the second of displacement, away from the jumps."""
    pulse = PULSES[name]
    h = T / 80.0
    t = np.linspace(5.0 * h, pulse.duration - 5.0 * h, 101)
    expected, unit = pulse.acceleration(t), pulse.peak
    np.testing.assert_allclose(first_derivative(pulse.velocity, t, h), expected, rtol=0.0, atol=1e-9 * unit)
    np.testing.assert_allclose(second_derivative(pulse.displacement, t, h), expected, rtol=0.0, atol=1e-8 * unit)


def test_differences_reject_another_pulse() -> None:
    """Negative control: the velocity of a pulse that is 1e-6 longer in period is not the integral."""
    off = pulses.sine(A, T * (1.0 + 1e-6))
    t = np.linspace(0.1, 0.7, 11)
    assert np.abs(first_derivative(off.velocity, t, 0.01) - PULSES["sine"].acceleration(t)).max() > 1e-6


@every
def test_before_and_after(name: str) -> None:
    """Before the pulse all is zero; after it the ground coasts at the velocity that it has."""
    pulse = PULSES[name]
    early = np.array([-5.0, -1e-9, 0.0])
    assert not np.any(pulse.velocity(early))
    assert not np.any(pulse.displacement(early))
    assert not np.any(pulse.acceleration(np.array([-1e-9, pulse.duration + 1e-9, 1e6])))
    v, d = pulse.velocity(pulse.duration), pulse.displacement(pulse.duration)
    np.testing.assert_allclose(pulse.velocity(pulse.duration + 7.0), v, rtol=0, atol=0)
    np.testing.assert_allclose(pulse.displacement(pulse.duration + 2.0), d + 2.0 * v, rtol=1e-14, atol=1e-14)


@pytest.mark.verifies("closed form", "integrals by hand", within="1e-13", control="test_a_wrong_phase_does_not_close")
@pytest.mark.parametrize("name", sorted(ENDS))
def test_velocity_and_displacement_at_the_end(name: str) -> None:
    """Where the ground ends, and how fast, is what integration by hand gives; C_n ends at zero in both."""
    pulse = PULSES[name]
    v, d = ENDS[name]
    np.testing.assert_allclose(pulse.velocity(pulse.duration), v, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(pulse.displacement(pulse.duration), d, rtol=1e-13, atol=1e-13)


@every
def test_peak_and_duration(name: str) -> None:
    """No instant exceeds the stated peak, A where given; one of 200,001 reaches it to 1e-8. Durations in periods."""
    pulse = PULSES[name]
    found = np.abs(pulse.acceleration(np.linspace(0.0, pulse.duration, 200_001))).max()
    assert pulse.peak * (1.0 - 1e-8) <= found <= pulse.peak * (1.0 + 1e-12)
    assert pulse.peak == A or name == "mavroeidis-papageorgiou"
    phase = 0.0409759670432386  # phi / pi of C_2
    periods = {
        "half-sine": 0.5, "half-cosine": 0.5, "type-c": 2.5 - phase, "ricker": 4.0, "antisymmetric-ricker": 5.0,
        "mavroeidis-papageorgiou": 2.2, "harmonic": 3.25,
    }  # fmt: skip
    assert pulse.duration == pytest.approx(periods.get(name, 1.0) * T, rel=1e-13, abs=0.0)


@pytest.mark.parametrize(("n", "share"), [(1, 0.0697033468757972), (2, 0.0409759670432386), (3, 0.0291102756529802)])
def test_phases_of_type_c(n: int, share: float) -> None:
    """phi / pi of C_1, C_2, C_3 are the roots of the closing equation to all digits; the pulse starts at cos(phi)."""
    pulse = pulses.type_c(A, T, n)
    assert pulse.duration == pytest.approx((n + 0.5 - share) * T, rel=1e-13, abs=0.0)
    assert pulse.acceleration(0.0) == pytest.approx(A * math.cos(math.pi * share), rel=1e-13, abs=0.0)
    middle = pulse.displacement(np.linspace(0.0, pulse.duration, 1001))
    assert np.abs(middle).max() > 0.1 * A / W**2, "zero at the end, but not all along"


@pytest.mark.verifies("negative control", "a phase that is 1e-6 off")
def test_a_wrong_phase_does_not_close() -> None:
    """Negative control: C_1 whose phase is 1e-6 off ends with a velocity that the tolerance above sees."""
    turn = math.pi * (0.0697033468757972 + 1e-6)
    off = pulses.harmonic(A, T, 1.5 - turn / math.pi, 0.5 * math.pi + turn)
    end = float(np.abs(off.velocity(off.duration)).max() + np.abs(off.displacement(off.duration)).max())
    assert end > 1e-7


def test_rickers_by_closed_form() -> None:
    """Both wavelets are the formulas of the literature about their middles; beta makes the peak of the odd one A."""
    s = np.linspace(-1.5, 1.5, 301) * T
    x, z = math.pi * s / T, 2.0 * math.pi * s / (math.sqrt(3.0) * T)
    even = A * (1.0 - 2.0 * x**2) * np.exp(-(x**2))
    beta = 1.3801190461607491117  # sqrt(6 (3 - sqrt(6))) exp((sqrt(6) - 3) / 2)
    odd = A / beta * (z**2 - 3.0) * z * np.exp(-0.5 * z**2)
    np.testing.assert_allclose(PULSES["ricker"].acceleration(s + 2.0 * T), even, rtol=0.0, atol=1e-13)
    found = PULSES["antisymmetric-ricker"].acceleration(s + 2.5 * T)
    np.testing.assert_allclose(found, odd, rtol=0.0, atol=1e-13)
    assert not np.allclose(found, odd * (1.0 + 1e-12), rtol=0.0, atol=1e-13), "negative control: beta, 1e-12 off"
    for name in ("ricker", "antisymmetric-ricker"):
        ends = PULSES[name].acceleration(np.array([0.0, PULSES[name].duration]))
        assert np.abs(ends).max() < 1e-14 * A, "nothing is cut away"


@pytest.mark.verifies(
    "closed form",
    "the formulas of Mavroeidis and Papageorgiou 2003, written anew",
    within="1e-12",
    doi="10.1785/0120020100",
)
@pytest.mark.parametrize(("gamma", "nu"), [(1.0, 0.0), (1.5, 0.5 * math.pi), (2.2, 0.7), (5.0, -2.0)])
def test_mavroeidis_papageorgiou(gamma: float, nu: float) -> None:
    """Velocity and acceleration are the two published formulas, the second the derivative of the first."""
    amplitude, f = 0.9, 1.0 / T
    pulse = pulses.mavroeidis_papageorgiou(amplitude, T, gamma, nu)
    t = np.linspace(-0.5, 0.5, 401) * gamma / f
    slow, main = 2.0 * math.pi * f * t / gamma, 2.0 * math.pi * f * t + nu
    velocity = 0.5 * amplitude * (1.0 + np.cos(slow)) * np.cos(main)
    inner = np.sin(slow) * np.cos(main) + gamma * np.sin(main) * (1.0 + np.cos(slow))
    acceleration = -amplitude * math.pi * f / gamma * inner
    time = np.clip(t + 0.5 * gamma / f, 0.0, pulse.duration)
    np.testing.assert_allclose(pulse.velocity(time), velocity, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(pulse.acceleration(time), acceleration, rtol=0.0, atol=1e-12)


@pytest.mark.verifies("computed anew", "minimisation of the formula by SciPy", within="1e-7")
@pytest.mark.parametrize(("gamma", "nu"), [(1.0, 0.0), (1.5, 0.5 * math.pi), (2.2, 0.7), (5.0, -2.0)])
def test_peak_of_mavroeidis_papageorgiou(gamma: float, nu: float) -> None:
    """The peak is the largest of all extremes of the published formula, each found by minimisation, to 1e-7."""

    def size(x: float) -> float:
        slow, main = 2.0 * math.pi * x / gamma, 2.0 * math.pi * x + nu
        inner = math.sin(slow) * math.cos(main) + gamma * math.sin(main) * (1.0 + math.cos(slow))
        return -abs(0.9 * math.pi / (T * gamma) * inner)

    ends = np.linspace(-0.5 * gamma, 0.5 * gamma, 101)
    best = min(
        minimize_scalar(size, bounds=(a, b), method="bounded", options={"xatol": 1e-10}).fun
        for a, b in pairwise(ends.tolist())
    )
    assert pulses.mavroeidis_papageorgiou(0.9, T, gamma, nu).peak == pytest.approx(-best, rel=1e-7)


@every
def test_segments_agree_to_rounding(name: str) -> None:
    """The polynomials of degree 7 are the pulse itself, within 20 roundings of its peak."""
    pulse = PULSES[name]
    segments = pulse.segments()
    assert segments.degree == 7
    assert segments.duration == pytest.approx(pulse.duration, rel=1e-14, abs=0.0)
    t = np.linspace(0.0, pulse.duration, 20_001)
    off = np.abs(value_of(segments, t) - pulse.acceleration_inside(t)).max()
    assert off <= 20.0 * np.finfo(float).eps * pulse.peak * max(1.0, pulse.duration / T)


@pytest.mark.verifies("negative control", "six stretches a period")
def test_too_few_segments_are_seen() -> None:
    """Negative control: with six stretches a period the polynomials are off by far more than rounding."""
    pulse = PULSES["sine"]
    rough = Segments.of_function(pulse.acceleration_inside, pulse.duration, 6)
    t = np.linspace(0.0, pulse.duration, 2001)
    assert np.abs(value_of(rough, t) - pulse.acceleration_inside(t)).max() > 1e-9 * A


@every
def test_scaled(name: str) -> None:
    """A factor multiplies acceleration, velocity, displacement; the peak takes its size; -1 twice is the pulse."""
    pulse = PULSES[name]
    twice = pulse.scaled(-2.0)
    t = np.linspace(0.0, pulse.duration, 33)
    for quantity in ("acceleration", "velocity", "displacement"):
        np.testing.assert_array_equal(getattr(twice, quantity)(t), -2.0 * getattr(pulse, quantity)(t))
    assert twice.peak == 2.0 * pulse.peak
    assert twice.duration == pulse.duration
    assert pulse.scaled(-1.0).scaled(-1.0) == pulse
    with pytest.raises(InvalidValueError, match="factor must be finite"):
        pulse.scaled(math.nan)


@every
def test_frozen_and_named(name: str) -> None:
    """A pulse cannot be changed, is equal to its like, and its name tells its period."""
    pulse = PULSES[name]
    with pytest.raises(AttributeError):
        pulse.duration = 1.0  # type: ignore[misc]
    assert f"{T:.3g}" in pulse.name
    assert pulse == pulse.scaled(1.0)
    assert hash(pulse) == hash(pulse.scaled(1.0))


PULSE, COSINE = pulses.sine(amplitude=3.0, period=0.6), pulses.cosine(2.0, 0.5)
QUANTITIES = ("acceleration", "velocity", "displacement")


@pytest.mark.parametrize("make", [pulses.sine, pulses.ricker, pulses.antisymmetric_ricker, pulses.type_c])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_scaled_stays_within_the_limit(make: Any, sign: float) -> None:
    """A scaled pulse obeys the limit of 1e6 m/s2 too, also where the product overflows; at the limit it is taken."""
    for amplitude, factor, shown in ((1e6, 1e6, "1e\\+12"), (10.0, 1e308, "inf"), (1e6, 1.0001, "1.0001e\\+06")):
        with pytest.raises(InvalidValueError, match=rf"peak of a pulse must be in \[0, 1e\+06\] m/s2, got {shown}"):
            make(amplitude, 1.0).scaled(sign * factor)
    assert make(10.0, 1.0).scaled(sign * 1e5).peak == 1e6


def test_mavroeidis_papageorgiou_within_the_limit() -> None:
    """Its velocity is refused where the acceleration would pass 1e6 m/s2, and taken just below; one of zero is zero."""
    with pytest.raises(InvalidValueError, match=r"velocity must be in \[-.*, .*\] m/s, got 1e\+308; the acceleration"):
        pulses.mavroeidis_papageorgiou(1e308, 1e-6)
    most = 1e6 / pulses.mavroeidis_papageorgiou(1.0, 0.8).peak
    for sign in (1.0, -1.0):
        assert pulses.mavroeidis_papageorgiou(sign * most * (1.0 - 1e-9), 0.8).peak == pytest.approx(1e6, rel=1e-8)
        with pytest.raises(InvalidValueError, match="velocity must be in"):
            pulses.mavroeidis_papageorgiou(sign * most * (1.0 + 1e-9), 0.8)
    assert pulses.mavroeidis_papageorgiou(0.0, 0.8).peak == 0.0
    assert not pulses.sine(0.0, 0.8).displacement(np.linspace(0.0, 1.0, 9)).any()


@pytest.mark.parametrize("make", [pulses.sine, pulses.ricker, pulses.antisymmetric_ricker])
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_times(quantity: str, make: Any) -> None:
    """The answer is an array of the shape of the times; what is not finite or no number is refused by value."""
    value = getattr(make(3.0, 0.6), quantity)
    for time in (0.1, [0.1], [[0.1, 0.2, 9.0]], []):
        found = value(time)
        assert isinstance(found, np.ndarray)
        assert found.shape == np.shape(time)
    for time in (math.nan, math.inf, -math.inf, [0.1, math.nan]):
        with pytest.raises(InvalidValueError, match=r"time must be finite \[s\], got (nan|inf|-inf)"):
            value(time)
    for times in ("0.1", None, ["a"], [[1.0], [1.0, 2.0]]):
        with pytest.raises(InvalidValueError, match="time must be numbers"):
            value(times)


def test_sampled() -> None:
    """Samples are the pulse's own values, zero from its end on; the provenance tells pulse and step."""
    motion = COSINE.sampled(0.1)
    expected = [2.0 * math.cos(2.0 * math.pi * k / 5.0) for k in range(6)]
    np.testing.assert_allclose(motion.acceleration[:6], expected, rtol=0.0, atol=1e-14)
    assert motion.acceleration[-1] == 0.0
    assert (motion.time_step, motion.name) == (0.1, COSINE.name)
    assert "sampled every 0.1 s" in motion.provenance[0]
    # the longest step leaves both ends of the pulse and the zero after it, the shortest two million samples
    np.testing.assert_allclose(COSINE.sampled(0.5).acceleration, [2.0, 2.0, 0.0], rtol=0.0, atol=1e-14)
    assert len(PULSE.sampled(PULSE.duration / 1_999_998 * (1.0 + 1e-9))) == 2_000_000


USUAL: dict[str, dict[str, float]] = {
    "rectangular": {"amplitude": 3.0, "duration": 0.8},
    "mavroeidis-papageorgiou": {"velocity": 0.5, "period": 0.8},
    "harmonic": {"amplitude": 3.0, "period": 0.8, "cycles": 2.0},
}
BAD: list[Any] = [math.nan, math.inf, -math.inf, None, "3", True, [1.0, 2.0], 1j]


def test_what_is_no_number_is_refused() -> None:
    """NaN, infinity, None, words, truth values, rows and periods outside [1e-6, 1e6] s are refused by all pulses."""
    assert set(PULSES) == set(pulses.catalogue()), "the table above leaves no pulse out"
    for name, make in pulses.catalogue().items():
        usual = USUAL.get(name, {"amplitude": 3.0, "period": 0.8})
        for parameter in usual:
            for value in BAD:
                with pytest.raises(InvalidValueError, match=f"{parameter} must be"):
                    make(**{**usual, parameter: value})
        for value in (0.0, -0.8, 1e-7, 1e7) if "period" in usual else ():
            with pytest.raises(InvalidValueError, match=r"period must be in \[1e-06, 1e\+06\] s, got"):
                make(**{**usual, "period": value})


STEP, WRITTEN = r"time_step must be in \[1e-09, 1000\] s, got", "must be a text such as sine:amplitude=3,period="
REFUSED: dict[str, tuple[Callable[[Any], Any], list[Any]]] = {
    STEP: (PULSE.sampled, [1e-300, 0.9e-9, 0.0, -0.1, 1001.0]),
    "time_step must be": (PULSE.sampled, [math.nan, math.inf, None, "0.1", 0.61]),
    r"at most 2e\+06 samples, got 1e-09 s with 6e\+08": (PULSE.sampled, [1e-9]),
    r"at most 2e\+06 samples": (PULSE.sampled, [PULSE.duration / 1_999_999]),
    r"at most the pulse's duration 0\.5 s": (COSINE.sampled, [0.5 + 1e-12, 0.51]),
    WRITTEN: (pulses.pulse, [None, 5, b"sine:amplitude=3,period=0.8", ["sine"], PULSE]),
    r"(amplitude|period|n) must be": (
        pulses.pulse,
        ["sine:amplitude=three,period=1", "sine:amplitude=,period=1", "type-c:amplitude=1,period=1,n=1.5",
         "sine:amplitude=nan,period=1", "sine:amplitude=3,period=inf", "sine:amplitude=3,period=-1",
         "type-c:amplitude=1,period=1,n=0"],
    ),
    "duration must be > 0 s, got": (lambda x: pulses.rectangular(1.0, x), [0.0, -1.0]),
    r"amplitude must be in \[-1e\+06, 1e\+06\] m/s2, got": (lambda x: pulses.sine(x, 1.0), [1.1e6, -1.1e6]),
    r"cycles must be in \[0.5, 100000\], got 0.4": (lambda x: pulses.harmonic(1.0, 1.0, x), [0.4]),
    "phase must be finite": (lambda x: pulses.harmonic(1.0, 1.0, 2.0, x), [math.inf]),
    r"cycles must be in \[1, 1000\], got": (lambda x: pulses.mavroeidis_papageorgiou(1.0, 1.0, x), [0.99, 1001.0]),
    r"n must be a whole number in \[1, 1000\], got": (
        lambda x: pulses.type_c(1.0, 1.0, x), [0, -1, 1001, 1.0, 1.5, True, None, "1", math.nan],
    ),
}  # fmt: skip


@pytest.mark.parametrize("message", REFUSED)
def test_ranges(message: str) -> None:
    """Steps, words and parameters outside their ranges are refused by their own sentence."""
    function, values = REFUSED[message]
    for value in values:
        with pytest.raises(InvalidValueError, match=message):
            function(value)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("sine:amplitude=3,period=0.8", pulses.sine(3.0, 0.8)),
        ("sine: amplitude = 3 , period = 8e-1 ", pulses.sine(3.0, 0.8)),
        ("rectangular:amplitude=-1,duration=2", pulses.rectangular(-1.0, 2.0)),
        ("half-cosine:period=2,amplitude=1,", pulses.half_cosine(1.0, 2.0)),
        ("type-c:amplitude=1,period=2,n=3", pulses.type_c(1.0, 2.0, 3)),
        ("antisymmetric-ricker:amplitude=1,period=2", pulses.antisymmetric_ricker(1.0, 2.0)),
        ("mavroeidis-papageorgiou:velocity=1,period=2,cycles=3,phase=0.5",
         pulses.mavroeidis_papageorgiou(1.0, 2.0, 3.0, 0.5)),
    ],
)  # fmt: skip
def test_words(words: str, expected: object) -> None:
    """A pulse written in one word is the pulse that the function makes."""
    assert pulses.pulse(words) == expected


UNKNOWN = {
    r"unknown pulse .*; allowed are antisymmetric-ricker, cosine": (
        "", ":", "nope", "sinus:amplitude=3,period=0.8", "type_c:amplitude=1,period=1",
    ),
    r"pulse 'sine' requires (amplitude, period|period, amplitude); got": (
        "sine", "sine:amplitude=3", "sine:amplitude=3,period=1,cycles=2", "sine:amplitude=3,Period=1",
    ),
    "write a pulse as sine:amplitude=3,period=": (
        "sine:3,0.8", "sine:amplitude=3,amplitude=4,period=1", "sine:amplitude:3", "sine:amplitude",
    ),
}  # fmt: skip


@pytest.mark.parametrize("message", UNKNOWN)
def test_unknown_words(message: str) -> None:
    """An unknown name lists the known ones, a wrong parameter what is taken, anything else an example."""
    for words in UNKNOWN[message]:
        with pytest.raises(UnknownModelError, match=message):
            pulses.pulse(words)


def test_a_scaled_pulse_is_called_by_its_own_strength():
    """The name states the strength after scaling, and leaves out what a map varies."""
    for pulse, scaled, bare in (
        (pulses.sine(2.0, 0.8), "sine pulse, 3 m/s2, 0.8 s", "sine pulse"),
        (pulses.rectangular(2.0, 0.5), "rectangular pulse, 3 m/s2, 0.5 s", "rectangular pulse"),
        (pulses.ricker(2.0, 1.0), "symmetric Ricker wavelet, 3 m/s2, 1 s", "symmetric Ricker wavelet"),
    ):
        assert pulse.scaled(-1.5).name == scaled
        assert pulse.scaled(1.5).scaled(2.0 / 3.0).name == pulse.name
        assert pulse.named(strength=False, period=False) == bare
        assert pulse.named(strength=False) == f"{bare}, {scaled.rpartition(', ')[2]}"
