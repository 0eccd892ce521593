"""A coefficient that is drawn from values in the job, such as a posterior: the bits of the Python call."""

import numpy as np
import pytest

import rocking as rk
from rocking.campaigns.jobs import Job
from rocking.dynamics.impact_laws import RandomRestitution
from rocking.errors import InvalidValueError
from rocking.studies import SampledRestitution, overturning_map

VALUES = np.round(np.random.default_rng(4).normal(0.88, 0.04, 40).clip(0.0, 1.0), 6).tolist()
MAP = """
[campaign]
name = "drawn"
kind = "overturning-map"
[body]
units = "m"
width = 0.5
height = 2.0
[motions]
pulse = "sine:amplitude=3,period=0.6"
[restitution.distribution]
{told}
[map]
x = {{ axis = "frequency_ratio", from = 2, to = 8, count = 12 }}
y = {{ axis = "amplitude_ratio", from = 1, to = 9, count = 10 }}
"""
AXES = ("frequency_ratio", np.linspace(2.0, 8.0, 12)), ("amplitude_ratio", np.linspace(1.0, 9.0, 10))


def peaks_of(told: str) -> np.ndarray:
    """Return the peak rotations of a job."""
    study = Job.of_text(MAP.format(told=told)).study
    return study.histories.run(0, study.histories.count)["peak_rotation"]


@pytest.mark.parametrize(("each", "kind"), [("impact", RandomRestitution), ("history", SampledRestitution)])
def test_same_as_from_python(each, kind):
    """A map with values in its job is that of the law made of them; other values, and another seed, are other maps."""
    told = f'values = {VALUES}\neach = "{each}"\nseed = 8'
    found = peaks_of(told)
    law = kind.of_sample(VALUES, seed=8)
    wanted = overturning_map(rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6), *AXES, restitution=law)
    np.testing.assert_array_equal(found, wanted["peak_rotation"].values.ravel())
    assert not np.array_equal(found, peaks_of(told.replace("seed = 8", "seed = 9")), equal_nan=True)
    assert not np.array_equal(found, peaks_of(told.replace(str(VALUES), "[0.8, 0.81]")), equal_nan=True)


def test_label_and_base():
    """The label says what is drawn; draws may multiply a model."""
    told = 'values = [0.95, 1.0, 0.9]\ntimes = "housner"\nseed = 1'
    (label,) = Job.of_text(MAP.format(told=told)).problem.restitutions
    assert label == "drawn per impact: 3 values from 0.9 to 1, seed 1"


@pytest.mark.parametrize(
    "told",
    ["values = [0.9, 0.8]\nmean = 0.9\ndeviation = 0.1", "mean = 0.9", "deviation = 0.1", "seed = 3"],
)
def test_one_distribution(told):
    """Values stand alone, mean and deviation go together, and one of both is needed."""
    with pytest.raises(InvalidValueError, match="give mean and deviation, or values alone"):
        Job.of_text(MAP.format(told=told))


@pytest.mark.parametrize("values", ["[0.9]", "[]", "[0.9, -0.1]", "[0.9, nan]", "[0.9, 1.1]"])
def test_values_are_checked(values):
    """One value is no distribution; what is no coefficient is refused."""
    with pytest.raises(InvalidValueError, match=r"restitution\.distribution\.values"):
        Job.of_text(MAP.format(told=f"values = {values}"))
