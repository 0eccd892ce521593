"""What can be computed with but was hardly meant: doubts that are said aloud and refuse nothing.

Each doubt is a `PlausibilityWarning` whose sentence begins with "check the input"; Python's warnings filter silences
it, for studies without dimensions: ``warnings.simplefilter("ignore", rocking.errors.PlausibilityWarning)``.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from rocking import errors
from rocking.conventions import percent
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.messages import Message

CENTRE_HEIGHTS = 0.025, 50.0
"""Half the heights of the smallest and largest things that are studied [m]: specimens 5 cm high; towers of 100 m."""

SLENDERNESS = 0.05, 200.0  # h/b of a slab of 1 x 0.05 m and of a sheet of glass 2 m high and 1 cm thick [-]
DENSITIES = 10.0, 23000.0  # polystyrene foam; osmium, the densest element, has 22590 [kg/m3]

LARGEST_PGA = 41.0
"""No record has more: 40.2 m/s2, all components, Iwate-Miyagi 2008 (Aoi et al. 2008, Science 322:727) [m/s2]."""

LEAST_PGA = 1e-4
"""Ten millionths of g: accelerometers of strong motion have about as much noise [m/s2]."""

LARGEST_PGV, LARGEST_PGD = 5.0, 15.0
"""Round limits above what stations on faults show, some 4 m/s and 10 m at TCU068, Chi-Chi 1999 [m/s], [m]."""

END_VELOCITY = 0.1, 0.25
"""Ground comes to rest: what is left of a record's velocity at its end [m/s], and as a share of the largest [-]."""

GRAVITIES = 1.6, 25.0  # of the Moon, 1.62, and of Jupiter, 24.8 [m/s2]

FRICTIONS = 10.0, 100.0
"""Feet that should not slide are often given 10, more than any surface has; from 100 on they never slide [-]."""

PERIODS = 0.01, 60.0
"""Of a pulse: shorter than records resolve; longer than the slowest pulses near a fault, of about 14 s [s]."""

LONGEST_STEP = 0.2  # between samples of a record: at 5 Hz nothing of a strong motion is left [s]

LEAST_COEFFICIENT = 0.25
"""Housner's coefficient of a block as wide as it is high; the least that was measured is 0.67, at h/b = 1.5 [-]."""

MOST_CUT = 0.05, 0.999
"""Probability of a distribution beyond the energy bound that is cut off without a word, and that is not refused [-]."""


def of_body(centre_height: float, slenderness: float, densities: Iterable[float]) -> tuple[str, ...]:
    """Return the doubts about a body: height of its centre [m], slenderness, densities of its parts [kg/m3]."""
    low, high = CENTRE_HEIGHTS
    found = []
    if centre_height > high:
        found.append(
            Message(
                "the centre of mass is {height:.4g} m above the ground, more than the {high:g} m of "
                "the tallest towers; were lengths in mm or cm taken for m?",
                {"height": centre_height, "high": high},
            )
        )
    if centre_height < low:
        found.append(
            Message(
                "the centre of mass is {height:.4g} m above the ground, less than the {low:g} m of "
                "the smallest specimens; were lengths in m taken for mm or cm?",
                {"height": centre_height, "low": low},
            )
        )
    if not SLENDERNESS[0] <= slenderness <= SLENDERNESS[1]:
        found.append(
            Message(
                "h/b = {slenderness:.4g} is outside {low:g} to {high:g}; is one length in another "
                "unit, or width taken for height?",
                {"slenderness": slenderness, "low": SLENDERNESS[0], "high": SLENDERNESS[1]},
            )
        )
    if wrong := next((value for value in densities if not DENSITIES[0] <= value <= DENSITIES[1]), None):
        found.append(
            Message(
                "a density of {density:.4g} kg/m3 is outside {low:g} (foam) to {high:g} (osmium); is "
                "it in g/cm3 or t/m3?",
                {"density": wrong, "low": DENSITIES[0], "high": DENSITIES[1]},
            )
        )
    return tuple(found)


def of_acceleration(peak: float) -> tuple[str, ...]:
    """Return the doubt about a peak ground acceleration [m/s2]."""
    if peak <= LARGEST_PGA:
        return ()
    return (
        Message(
            "a ground acceleration of {peak:.4g} m/s2 ({peak_in_g:.3g} g) is more than any "
            "recorded, {most:g} m/s2; is its unit or its scale another?",
            {"peak": peak, "peak_in_g": peak / 9.80665, "most": LARGEST_PGA},
        ),
    )


def of_quiet(peak: float) -> tuple[str, ...]:
    """Return the doubt about a record that hardly moves, by its peak ground acceleration [m/s2]."""
    if peak >= LEAST_PGA:
        return ()
    return (
        f"a ground acceleration of {peak:.4g} m/s2 ({peak / 9.80665:.3g} g) at most is less than the noise of an "
        f"accelerometer, about {LEAST_PGA:g} m/s2; is the channel dead, or its unit another?",
    )


def of_integrals(end: float, velocity: float, displacement: float) -> tuple[str, ...]:
    """Return the doubt about a record by its velocity at the end, its largest [m/s], its largest displacement [m]."""
    if velocity > LARGEST_PGV or displacement > LARGEST_PGD:
        return (
            Message(
                "integrated, it reaches {velocity:.3g} m/s and {displacement:.3g} m, more than "
                "{most_velocity:g} m/s or {most_displacement:g} m; is it no acceleration, in another "
                "unit, or without a corrected baseline?",
                {
                    "velocity": velocity,
                    "displacement": displacement,
                    "most_velocity": LARGEST_PGV,
                    "most_displacement": LARGEST_PGD,
                },
            ),
        )
    if abs(end) > max(END_VELOCITY[0], END_VELOCITY[1] * velocity):
        return (
            Message(
                "integrated, it ends at {end:.3g} m/s, of {velocity:.3g} m/s at most, where the "
                "ground is at rest; is its baseline corrected, or its end cut off?",
                {"end": end, "velocity": velocity},
            ),
        )
    return ()


def of_scaled(motions: Iterable[Any], scales: Any) -> tuple[str, ...]:
    """Return the doubt about the largest of scaled motions; as they are they were doubted when they were made."""
    factors = np.atleast_1d(np.asarray(scales, dtype=np.float64))
    most = np.where(factors == 1.0, 0.0, np.abs(factors)).max(axis=-1)
    if not most.any():
        return ()
    peaks = [max(each.peak, getattr(each, "peak_vertical", 0.0)) for each in motions if each is not None]
    return of_acceleration(float(np.multiply(most, peaks).max())) if peaks else ()


def of_gravity(gravity: float) -> tuple[str, ...]:
    """Return the doubt about an acceleration of gravity [m/s2]."""
    low, high = GRAVITIES
    if low <= gravity <= high:
        return ()
    return (
        Message(
            "a gravity of {gravity:.4g} m/s2 is outside {low:g} (the Moon) to {high:g} "
            "(Jupiter); is it in cm/s2 or in g?",
            {"gravity": gravity, "low": low, "high": high},
        ),
    )


def of_friction(coefficient: float) -> tuple[str, ...]:
    """Return the doubt about a coefficient of friction."""
    low, high = FRICTIONS
    if not low < coefficient < high:
        return ()
    return (
        Message(
            "a coefficient of friction of {friction:.4g} is more than {low:g}, which no surface has; is it in percent, "
            "or an angle in degrees? Feet that never slide have {high:g} or more",
            {"friction": coefficient, "low": low, "high": high},
        ),
    )


def of_period(period: float) -> tuple[str, ...]:
    """Return the doubt about the period of a pulse [s]."""
    low, high = PERIODS
    if low <= period <= high:
        return ()
    return (
        Message(
            ("a pulse with a period of {period:.4g} s is outside {low:g} to {high:g} s; is it in ms, or a frequency?"),
            {"period": period, "low": low, "high": high},
        ),
    )


def of_time_step(step: float) -> tuple[str, ...]:
    """Return the doubt about the step between samples [s]."""
    if step <= LONGEST_STEP:
        return ()
    return (
        Message(
            ("a step of {step:.4g} s between samples is more than {most:g} s; is it in ms, or in samples/s?"),
            {"step": step, "most": LONGEST_STEP},
        ),
    )


def of_coefficient(value: float) -> tuple[str, ...]:
    """Return the doubt about a coefficient of restitution given by hand; zero means that the body stops."""
    if value == 0.0 or value >= LEAST_COEFFICIENT:
        return ()
    return (
        Message(
            "a coefficient of restitution of {coefficient:.4g} is less than {least:g}, that of a "
            "block as wide as high; is it what is lost, or a ratio of energies?",
            {"coefficient": value, "least": LEAST_COEFFICIENT},
        ),
    )


def of_truncation(cut: float, foot: str, most: float) -> tuple[str, ...]:
    """Return the doubt about a distribution of the coefficient of which so much would create energy and is cut off."""
    if not cut <= MOST_CUT[1]:
        raise InvalidValueError(
            "the coefficient of restitution onto the {foot} foot must be in [0, {most:.6g}], and "
            "{share} of the distribution that it is drawn from is outside: the impact would "
            "create energy; is it meant for another body, or given in percent?",
            foot=foot,
            most=most,
            share=percent(cut),
        )
    if cut <= MOST_CUT[0]:
        return ()
    return (
        f"{percent(cut)} of the distribution of the coefficient of restitution onto the {foot} foot lies outside "
        f"[0, {most:.4g}], where an impact would create energy, and is cut off; is it meant for another body?",
    )


def warn(sentences: Iterable[str]) -> None:
    """Say doubts as warnings, at the line outside this package that gave the value."""
    for sentence in sentences:
        errors.warn(f"check the input: {sentence}", PlausibilityWarning)
