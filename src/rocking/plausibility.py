"""Warnings about allowed but implausible input values.

All warnings are a `PlausibilityWarning` and begin with "check the input". A warnings filter of Python suppresses them,
for example in dimensionless studies: ``warnings.simplefilter("ignore", rocking.errors.PlausibilityWarning)``.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

import numpy as np

from rocking import errors
from rocking.conventions import percent
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.messages import Message

CENTRE_HEIGHTS = 0.025, 50.0
"""Half the heights of the smallest and largest usual bodies, 5 cm (specimens) and 100 m (towers) [m]."""

SLENDERNESS = 0.05, 200.0  # h/b of a slab of 1 x 0.05 m, and of a glass sheet of 2 m height and 1 cm thickness [-]
DENSITIES = 10.0, 23000.0  # limits [kg/m3]: polystyrene foam, and osmium, the densest element (22590)

LARGEST_PGA = 41.0
"""Largest plausible PGA [m/s2].

Largest record: 40.2, Iwate-Miyagi 2008, all components (Aoi et al. 2008, Science 322:727).
"""

MIN_PGA = 1e-4
"""Smallest plausible PGA [m/s2]: about 1e-5 g, the noise of strong-motion accelerometers."""

LARGEST_PGV, LARGEST_PGD = 5.0, 15.0
"""Limits of PGV [m/s] and PGD [m]. Near-fault records reach about 4 m/s and 10 m (TCU068, Chi-Chi 1999)."""

END_VELOCITY = 0.1, 0.25
"""Limits of the ground velocity at the end of a record [m/s], and as a fraction of the largest velocity [-]."""

GRAVITIES = 1.6, 25.0  # limits [m/s2]; the Moon has 1.62 m/s2, Jupiter 24.8 m/s2

FRICTIONS = 10.0, 100.0
"""Limits of an implausible coefficient of friction [-]: no surface reaches 10; from 100, feet never slide."""

PERIODS = 0.01, 60.0
"""Limits of pulse periods [s]: the resolution of records, and a value above near-fault pulses of about 14 s."""

LONGEST_STEP = 0.2  # largest plausible time step [s]: 5 Hz does not resolve strong motion

MIN_COEFFICIENT = 0.25
"""Housner coefficient of a block of equal width and height [-]; the smallest measured value is 0.67 (h/b = 1.5)."""

MOST_CUT = 0.05, 0.999
"""Limits of the truncated probability beyond the energy bound [-], for a warning and for an error."""


def of_body(centre_height: float, slenderness: float, densities: Iterable[float]) -> tuple[str, ...]:
    """Return warnings about a body: height of the centre of mass [m], slenderness, densities of the parts [kg/m3]."""
    low, high = CENTRE_HEIGHTS
    doubts = []
    if centre_height > high:
        doubts.append(
            Message(
                "the centre of mass is {height:.4g} m above the ground, more than the {high:g} m of "
                "the tallest towers; check that lengths are in m, not mm or cm",
                {"height": centre_height, "high": high},
            )
        )
    if centre_height < low:
        doubts.append(
            Message(
                "the centre of mass is {height:.4g} m above the ground, less than the {low:g} m of "
                "the smallest specimens; check that lengths are in m",
                {"height": centre_height, "low": low},
            )
        )
    if not SLENDERNESS[0] <= slenderness <= SLENDERNESS[1]:
        doubts.append(
            Message(
                "h/b = {slenderness:.4g} is outside {low:g} to {high:g}; check the units, "
                "and that width and height are not swapped",
                {"slenderness": slenderness, "low": SLENDERNESS[0], "high": SLENDERNESS[1]},
            )
        )
    if wrong := next((value for value in densities if not DENSITIES[0] <= value <= DENSITIES[1]), None):
        doubts.append(
            Message(
                "a density of {density:.4g} kg/m3 is outside {low:g} (foam) to {high:g} (osmium); "
                "check that the unit is kg/m3",
                {"density": wrong, "low": DENSITIES[0], "high": DENSITIES[1]},
            )
        )
    return tuple(doubts)


def of_acceleration(peak: float) -> tuple[str, ...]:
    """Return a warning if a peak ground acceleration is implausibly large [m/s2]."""
    if peak <= LARGEST_PGA:
        return ()
    return (
        Message(
            "a ground acceleration of {peak:.4g} m/s2 ({peak_in_g:.3g} g) exceeds all "
            "records, {most:g} m/s2; check the unit and the scale factor",
            {"peak": peak, "peak_in_g": peak / 9.80665, "most": LARGEST_PGA},
        ),
    )


def of_quiet(peak: float) -> tuple[str, ...]:
    """Return a warning if the peak ground acceleration is very small [m/s2]."""
    if peak >= MIN_PGA:
        return ()
    return (
        f"a ground acceleration of {peak:.4g} m/s2 ({peak / 9.80665:.3g} g) at most is below the noise of an "
        f"accelerometer, about {MIN_PGA:g} m/s2; check the channel and the unit",
    )


def of_integrals(end: float, velocity: float, displacement: float) -> tuple[str, ...]:
    """Return a warning about an implausible final velocity [m/s], peak velocity [m/s] or peak displacement [m]."""
    if velocity > LARGEST_PGV or displacement > LARGEST_PGD:
        return (
            Message(
                "the integrals reach {velocity:.3g} m/s and {displacement:.3g} m, more than "
                "{most_velocity:g} m/s or {most_displacement:g} m; check that the values are accelerations. Check "
                "the unit and the baseline correction",
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
                "the integrated velocity ends at {end:.3g} m/s, with a peak of {velocity:.3g} m/s, but the "
                "ground ends at rest; check the baseline correction and the end of the record",
                {"end": end, "velocity": velocity},
            ),
        )
    return ()


def of_scaled(motions: Iterable[Any], scales: Any) -> tuple[str, ...]:
    """Return a warning if the largest scaled motion is implausible. Unscaled motions were checked before."""
    factors = np.atleast_1d(np.asarray(scales, dtype=np.float64))
    most = np.where(factors == 1.0, 0.0, np.abs(factors)).max(axis=-1)
    if not most.any():
        return ()
    peaks = [max(motion.peak, getattr(motion, "peak_vertical", 0.0)) for motion in motions if motion is not None]
    return of_acceleration(float(np.multiply(most, peaks).max())) if peaks else ()


def of_gravity(gravity: float) -> tuple[str, ...]:
    """Return a warning if an acceleration of gravity is implausible [m/s2]."""
    low, high = GRAVITIES
    if low <= gravity <= high:
        return ()
    return (
        Message(
            "a gravity of {gravity:.4g} m/s2 is outside {low:g} (the Moon) to {high:g} "
            "(Jupiter); check that the unit is m/s2",
            {"gravity": gravity, "low": low, "high": high},
        ),
    )


def of_friction(coefficient: float) -> tuple[str, ...]:
    """Return a warning if a coefficient of friction is implausible."""
    low, high = FRICTIONS
    if not low < coefficient < high:
        return ()
    return (
        Message(
            "a coefficient of friction of {friction:.4g} exceeds {low:g}, the largest value of real surfaces; "
            "check that the value is a ratio, not percent or degrees. Use {high:g} or more for feet that never slide",
            {"friction": coefficient, "low": low, "high": high},
        ),
    )


def of_period(period: float) -> tuple[str, ...]:
    """Return a warning if the period of a pulse is implausible [s]."""
    low, high = PERIODS
    if low <= period <= high:
        return ()
    return (
        Message(
            "a pulse with a period of {period:.4g} s is outside {low:g} to {high:g} s; check that it is a period "
            "in seconds",
            {"period": period, "low": low, "high": high},
        ),
    )


def of_time_step(step: float) -> tuple[str, ...]:
    """Return a warning if the time step is implausible [s]."""
    if step <= LONGEST_STEP:
        return ()
    return (
        Message(
            ("a step of {step:.4g} s between samples exceeds {most:g} s; check that the time step is in seconds"),
            {"step": step, "most": LONGEST_STEP},
        ),
    )


def of_coefficient(value: float) -> tuple[str, ...]:
    """Return a warning if a stated coefficient of restitution is implausible. Zero is allowed: the body stops."""
    if value == 0.0 or value >= MIN_COEFFICIENT:
        return ()
    return (
        Message(
            "a coefficient of restitution of {coefficient:.4g} is below {least:g}, the value of a "
            "block of equal width and height; check that the value is a velocity ratio, not a loss or energy ratio",
            {"coefficient": value, "least": MIN_COEFFICIENT},
        ),
    )


def of_truncation(cut: float, foot: str, most: float) -> tuple[str, ...]:
    """Return a warning if much of a distribution is truncated, because an impact would gain energy."""
    if not cut <= MOST_CUT[1]:
        raise InvalidValueError(
            "the coefficient of restitution onto the {foot} foot must be in [0, {most:.6g}], and "
            "{share} of its distribution is outside: the impact would "
            "gain energy; check the body of this distribution and that its values are no percentages",
            foot=foot,
            most=most,
            share=percent(cut),
        )
    if cut <= MOST_CUT[0]:
        return ()
    return (
        f"{percent(cut)} of the distribution of the coefficient of restitution onto the {foot} foot lies outside "
        f"[0, {most:.4g}], where an impact would gain energy, and is truncated; check the body of this distribution",
    )


_RAW: ContextVar[bool] = ContextVar("raw", default=False)


@contextmanager
def before_processing() -> Iterator[None]:
    """Suppress warnings about values of unprocessed records in this context."""
    token = _RAW.set(True)
    try:
        yield
    finally:
        _RAW.reset(token)


def warn_of_values(sentences: Iterable[str]) -> None:
    """Issue warnings about the values of a motion, unless processing steps follow."""
    if not _RAW.get():
        warn(sentences)


def warn(sentences: Iterable[str]) -> None:
    """Issue warnings at the calling line outside this package."""
    for sentence in sentences:
        errors.warn(f"check the input: {sentence}", PlausibilityWarning)
