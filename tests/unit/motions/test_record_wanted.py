"""Functions of records refuse pulses and everything else that is no record, and say what to do with a pulse."""

from collections.abc import Callable
from typing import Any

import pytest

from rocking import motions
from rocking.errors import InvalidValueError
from rocking.motions import pulses

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
