"""Every pulse against its closed forms; its limits, how it is sampled, and how it is written in one word."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import rocking as rk
from rocking.errors import InvalidValueError, UnknownModelError
from rocking.motions import Pulse, Segments, pulses

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


def test_all_pulses_are_here() -> None:
    """The table above leaves no pulse of the catalogue out."""
    assert set(PULSES) == set(pulses.catalogue())


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


@pytest.mark.parametrize("name", sorted(ENDS))
def test_velocity_and_displacement_at_the_end(name: str) -> None:
    """Where the ground ends, and how fast, is what integration by hand gives; C_n ends at zero in both."""
    pulse = PULSES[name]
    v, d = ENDS[name]
    np.testing.assert_allclose(pulse.velocity(pulse.duration), v, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(pulse.displacement(pulse.duration), d, rtol=1e-13, atol=1e-13)


@every
def test_peak(name: str) -> None:
    """No instant exceeds the stated peak, and one of 200,001 reaches it to 1e-8."""
    pulse = PULSES[name]
    found = np.abs(pulse.acceleration(np.linspace(0.0, pulse.duration, 200_001))).max()
    assert pulse.peak * (1.0 - 1e-8) <= found <= pulse.peak * (1.0 + 1e-12)


@pytest.mark.parametrize("name", sorted(set(PULSES) - {"mavroeidis-papageorgiou"}))
def test_peak_is_the_amplitude(name: str) -> None:
    """A pulse that is given by its peak acceleration has just that peak."""
    assert PULSES[name].peak == A


@pytest.mark.parametrize("name", sorted(set(PULSES) - {"rectangular"}))
def test_durations(name: str) -> None:
    """Durations in periods are those of the definitions."""
    phase = 0.0409759670432386  # phi / pi of C_2
    periods = {
        "half-sine": 0.5, "half-cosine": 0.5, "type-c": 2.5 - phase, "ricker": 4.0, "antisymmetric-ricker": 5.0,
        "mavroeidis-papageorgiou": 2.2, "harmonic": 3.25,
    }  # fmt: skip
    assert PULSES[name].duration == pytest.approx(periods.get(name, 1.0) * T, rel=1e-13)


@pytest.mark.parametrize(("n", "share"), [(1, 0.0697033468757972), (2, 0.0409759670432386), (3, 0.0291102756529802)])
def test_phases_of_type_c(n: int, share: float) -> None:
    """phi / pi of C_1, C_2, C_3 are the roots of the closing equation to all digits; the pulse starts at cos(phi)."""
    pulse = pulses.type_c(A, T, n)
    assert pulse.duration == pytest.approx((n + 0.5 - share) * T, rel=1e-13)
    assert pulse.acceleration(0.0) == pytest.approx(A * math.cos(math.pi * share), rel=1e-13)
    middle = pulse.displacement(np.linspace(0.0, pulse.duration, 1001))
    assert np.abs(middle).max() > 0.1 * A / W**2, "zero at the end, but not all along"


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
    assert segments.duration == pytest.approx(pulse.duration, rel=1e-14)
    t = np.linspace(0.0, pulse.duration, 20_001)
    off = np.abs(value_of(segments, t) - pulse.acceleration_inside(t)).max()
    assert off <= 20.0 * np.finfo(float).eps * pulse.peak * max(1.0, pulse.duration / T)


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


PULSE = pulses.sine(amplitude=3.0, period=0.6)
PEAK = r"peak of a pulse must be in \[0, 1e\+06\] m/s2, got"
quantities = pytest.mark.parametrize("quantity", ["acceleration", "velocity", "displacement"])


@pytest.mark.parametrize("make", [pulses.sine, pulses.ricker, pulses.antisymmetric_ricker, pulses.type_c])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_scaled_stays_within_the_limit(make: Any, sign: float) -> None:
    """A scaled pulse obeys the limit of 1e6 m/s2 too, also where the product overflows; at the limit it is taken."""
    for amplitude, factor, shown in ((1e6, 1e6, "1e\\+12"), (10.0, 1e308, "inf"), (1e6, 1.0001, "1.0001e\\+06")):
        with pytest.raises(InvalidValueError, match=f"{PEAK} {shown}"):
            make(amplitude, 1.0).scaled(sign * factor)
    assert make(10.0, 1.0).scaled(sign * 1e5).peak == 1e6


def test_no_body_meets_an_infinite_pulse() -> None:
    """A pulse scaled to infinity is refused, rather than left out so that the body stands."""
    with pytest.raises(InvalidValueError, match=f"{PEAK} inf"):
        rk.simulate(rk.Block(width=0.5, height=2.0), pulses.ricker(10.0, 1.0).scaled(1e308), 0.9)


def test_mavroeidis_papageorgiou_within_the_limit() -> None:
    """Its velocity is refused where the acceleration would pass 1e6 m/s2, and taken just below."""
    with pytest.raises(InvalidValueError, match=r"velocity must be in \[-.*, .*\] m/s, got 1e\+308; the acceleration"):
        pulses.mavroeidis_papageorgiou(1e308, 1e-6)
    most = 1e6 / pulses.mavroeidis_papageorgiou(1.0, 0.8).peak
    for sign in (1.0, -1.0):
        assert pulses.mavroeidis_papageorgiou(sign * most * (1.0 - 1e-9), 0.8).peak == pytest.approx(1e6, rel=1e-8)
        with pytest.raises(InvalidValueError, match="velocity must be in"):
            pulses.mavroeidis_papageorgiou(sign * most * (1.0 + 1e-9), 0.8)


@quantities
@pytest.mark.parametrize("time", [math.nan, math.inf, -math.inf, [0.1, math.nan]])
def test_times_that_are_not_finite(quantity: str, time: Any) -> None:
    """Times that are not finite are refused by value."""
    with pytest.raises(InvalidValueError, match=r"time must be finite \[s\], got (nan|inf|-inf)"):
        getattr(PULSE, quantity)(time)


@quantities
@pytest.mark.parametrize("make", [pulses.sine, pulses.ricker, pulses.antisymmetric_ricker])
def test_shapes(quantity: str, make: Any) -> None:
    """The answer is an array of the shape of the question: a number, a row, a table, nothing at all."""
    for time in (0.1, [0.1], [[0.1, 0.2, 9.0]], []):
        found = getattr(make(3.0, 0.6), quantity)(time)
        assert isinstance(found, np.ndarray)
        assert found.shape == np.shape(time)


def test_how_finely_it_is_sampled() -> None:
    """Steps beyond the limits of a record, or that leave more than 2,000,000 samples, are refused."""
    bad: Any
    for bad in (1e-300, 0.9e-9, 0.0, -0.1, 1001.0):
        with pytest.raises(InvalidValueError, match=r"time_step must be in \[1e-09, 1000\] s, got"):
            PULSE.sampled(bad)
    for bad in (math.nan, None, "0.1"):
        with pytest.raises(InvalidValueError, match="time_step must be"):
            PULSE.sampled(bad)
    with pytest.raises(InvalidValueError, match=r"at most 2e\+06 samples, got 1e-09 s, which leaves 6e\+08"):
        PULSE.sampled(1e-9)
    most = PULSE.duration / 1_999_998
    assert len(PULSE.sampled(most * (1.0 + 1e-9))) == 2_000_000
    with pytest.raises(InvalidValueError, match="at most"):
        PULSE.sampled(PULSE.duration / 1_999_999)


@pytest.mark.parametrize("words", [None, 5, b"sine:amplitude=3,period=0.8", ["sine"], PULSE])
def test_a_pulse_is_written_as_a_string(words: Any) -> None:
    """What is no string is refused with an example of one."""
    with pytest.raises(InvalidValueError, match="a pulse is written as sine:amplitude=3,period="):
        pulses.pulse(words)


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


@pytest.mark.parametrize("step", [math.inf, 0.51])
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
