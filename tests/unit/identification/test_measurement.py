"""What is refused of a measurement, and what is kept."""

import dataclasses

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.identification import ImpactTimes, RotationSeries


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"times": [0.0, 1.0, 2.0]}, "4 to 2000, got 3"),
        ({"times": [0.0, 1.0, 1.0, 2.0]}, "must increase .* at index 2"),
        ({"times": [0.0, 1.0, np.nan, 2.0]}, "finite .* at index 2"),
        ({"times": [[0.0, 1.0], [2.0, 3.0]]}, "a row"),
        ({"times": [0.0, 1.0, 2.0, 3.0], "sigma": 0.0}, "sigma must be > 0"),
        ({"times": [0.0, 1.0, 2.0, 3.0], "probabilities": [1.0, 1.0, 0.0, 1.0]}, "probabilities must be in"),
        ({"times": [0.0, 1.0, 2.0, 3.0], "probabilities": [1.0, 1.0]}, "row of 4"),
    ],
)
def test_times_that_are_none_are_refused(given, words):
    with pytest.raises(InvalidValueError, match=words):
        ImpactTimes(**given)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "rotation= .* or both"),
        ({"rotation": [0.0, 1.0]}, "row of 4"),
        ({"angular_velocity": [0.0, 1.0, np.inf, 0.0]}, "finite .* at index 2"),
    ],
)
def test_a_series_that_is_none_is_refused(given, words):
    with pytest.raises(InvalidValueError, match=words):
        RotationSeries([0.0, 1.0, 2.0, 3.0], **given)


def test_what_was_measured_does_not_change():
    given = np.arange(4.0)
    kept = ImpactTimes(given)
    given[0] = -1.0
    assert kept.times[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        kept.times[0] = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        kept.sigma = 1.0
