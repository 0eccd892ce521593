"""A coefficient that is drawn from what the measurements say of the body: the bits of the Python call."""

import numpy as np
import pytest

import rocking as rk
from rocking.campaigns.jobs import Job
from rocking.conventions import percent
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.evidence import restitution_distribution
from rocking.spec.response import ResponseJob
from rocking.studies import overturning_map

BLOCK = rk.Block(width=0.5, height=2.0)
AXES = ("frequency_ratio", np.linspace(2.0, 8.0, 9)), ("amplitude_ratio", np.linspace(1.0, 9.0, 8))
BODY = '[body]\nunits = "m"\nwidth = 0.5\nheight = 2.0\n'
PULSE = '[motions]\npulse = "sine:amplitude=3,period=0.6"\n'
MAP = """[map]
x = { axis = "frequency_ratio", from = 2, to = 8, count = 9 }
y = { axis = "amplitude_ratio", from = 1, to = 9, count = 8 }
"""


def job_of(told, kind="overturning-map", seed=8, body=BODY, rest=MAP):
    """Return a job with a distribution."""
    head = f'[campaign]\nname = "drawn"\nkind = "{kind}"\nseed = {seed}\n'
    return Job.of_text(f"{head}{body}{PULSE}[restitution.distribution]\n{told}\n{rest}")


def peaks_of(told, seed=8):
    """Return the peak rotations of a map."""
    study = job_of(told, seed=seed).study
    return study.histories.run(0, study.histories.count)["peak_rotation"]


@pytest.mark.parametrize("each", ["history", "impact"])
def test_same_as_from_python(each):
    """The map of the job is that of the posterior's law in Python, bit by bit; another seed and body are not."""
    found = restitution_distribution(BLOCK)
    law = found.per_history(8) if each == "history" else found.per_impact(8)
    wanted = overturning_map(BLOCK, rk.pulses.sine(3.0, 0.6), *AXES, restitution=law)["peak_rotation"].values.ravel()
    told = f'posterior = true\neach = "{each}"'
    np.testing.assert_array_equal(peaks_of(f"{told}\nseed = 8", seed=0), wanted)
    np.testing.assert_array_equal(peaks_of(told), wanted)  # the seed of the campaign, where the table has none
    assert not np.array_equal(peaks_of(f"{told}\nseed = 9"), wanted, equal_nan=True)
    slender = restitution_distribution(8.0)
    other = slender.per_history(8) if each == "history" else slender.per_impact(8)
    assert not np.array_equal(law.factors, other.factors)


@pytest.mark.parametrize("each", ["history", "impact"])
def test_so_many_values(each):
    """With count, the law is that of a sample of the posterior: the values that `values` would take."""
    sample = restitution_distribution(BLOCK).sample(40, 5)
    listed = f'values = {sample.tolist()}\neach = "{each}"\nseed = 5'
    named = f'posterior = true\ncount = 40\neach = "{each}"\nseed = 5'
    np.testing.assert_array_equal(peaks_of(named), peaks_of(listed))
    assert not np.array_equal(peaks_of(named), peaks_of(named.replace("40", "41")), equal_nan=True)


def test_label():
    """The label says what is drawn, and whether the body is more slender than what was measured."""
    (label,) = job_of("posterior = true\ncount = 30").problem.restitutions
    assert label == "drawn per impact: 30 values of the posterior of the measurements, seed 8"
    (label,) = job_of("posterior = true", body=BODY.replace("2.0", "40.0")).problem.restitutions
    cut = restitution_distribution(80.0).cut["left"]
    assert label == "drawn per impact: posterior of the measurements (extrapolated in slenderness), seed 8" + (
        f" (of the distribution {percent(cut)} cut off, where impacts would create energy)"
    )


def test_one_response():
    """The document of one response takes it too, drawn per impact."""
    text = f"[response]\nfree = 0.5\n{BODY}[restitution.distribution]\nposterior = true\nseed = 3"
    (law,) = ResponseJob.of_text(text, ".").problem.restitutions.values()
    wanted = restitution_distribution(BLOCK).per_impact(3)
    assert type(law) is type(wanted)
    assert np.array_equal(law.factors, wanted.factors)
    assert law.seed == 3


@pytest.mark.parametrize(
    ("told", "words"),
    [
        ("posterior = true\nvalues = [0.8, 0.9]", "posterior alone; got values and posterior"),
        ("posterior = true\nmean = 0.9", "posterior alone; got mean and posterior"),
        ("posterior = false", r"restitution\.distribution\.posterior"),
        ("posterior = true\ncount = 1", r"restitution\.distribution\.count"),
        ("values = [0.8, 0.9]\ncount = 5", "count goes with posterior"),
        ('posterior = true\ntimes = "ked"', "times does not go with posterior"),
    ],
)
def test_refused_tables(told, words):
    """It stands alone, and with a count of its own."""
    with pytest.raises(InvalidValueError, match=words):
        job_of(told)


def test_one_body_is_needed():
    """Several bodies have several posteriors, and a spectrum has no body: both are refused by name."""
    two = BODY.replace("[body]", "[[body]]")
    with pytest.raises(InvalidValueError, match=r"of one body, and the job has 2 bodies: make a job of each"):
        job_of("posterior = true", "histories", body=two + two.replace("0.5", "0.4"), rest="")
    spectrum = "[spectrum]\nslenderness_angles = [0.2]\nperiods = [2.0]\n"
    with pytest.raises(InvalidValueError, match=r"the job has no \[body\]"):
        job_of("posterior = true", "rocking-spectrum", body="", rest=spectrum)


SECTION = """[body]
units = "m"
[body.section]
feet = [0.0, 0.4]
depth = 1.0
[[body.section.region]]
density = 2000.0
outline = [[0.0, 0.0], [0.4, 0.0], [0.4, 1.5], [0.0, 1.2]]
"""


@pytest.mark.parametrize("each", ["history", "impact"])
@pytest.mark.parametrize("count", ["", "count = 30"])
def test_a_body_with_unequal_sides(each, count):
    """Each side draws from a table of its own: the laws of the evidence, or samples of both at the same numbers."""
    outline = [(0.0, 0.0), (0.4, 0.0), (0.4, 1.5), (0.0, 1.2)]
    body = rk.Section([rk.Region(outline, 2000.0)], feet=(0.0, 0.4))
    found = restitution_distribution(body)
    law = found.per_history(8) if each == "history" else found.per_impact(8)
    if count:
        law = type(law).of_sample({foot: found.sample(30, 8, foot) for foot in ("left", "right")}, seed=8)
    job = job_of(f'posterior = true\neach = "{each}"\n{count}', "histories", body=SECTION, rest="")
    (told,) = job.problem.restitutions.values()
    assert type(told) is type(law)
    assert np.array_equal(told.factors, law.factors)
    assert not np.array_equal(told.table("left"), told.table("right"))
    peak = job.study.histories.run(0, 1)["peak_rotation"][0]
    assert peak == pytest.approx(rk.simulate(body, rk.pulses.sine(3.0, 0.6), law).peak_rotation, abs=1e-9)


def test_the_label_says_what_is_cut_off():
    """A distribution of which a part would create energy says so in the label of the job, as `simulate` does."""
    body = rk.Section([rk.Region([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 3.0)], 2400.0)])
    text = SECTION.replace("0.4, 1.5], [0.0, 1.2", "1.0, 1.0], [0.0, 3.0").replace("0.4", "1.0")
    with pytest.warns(PlausibilityWarning, match=r"9\.78 % of the distribution"):
        (label,) = job_of("mean = 0.9\ndeviation = 0.05", "histories", body=text, rest="").problem.restitutions
    with pytest.warns(PlausibilityWarning, match=r"9\.78 % of the distribution"):
        told = rk.simulate_many(body, rk.pulses.sine(3.0, 0.6), rk.dynamics.RandomRestitution.normal(0.9, 0.05, seed=8))
    words = " (of the distribution 9.78 % onto right cut off, where impacts would create energy)"
    assert label == f"drawn per impact: 0.9 +- 0.05, seed 8{words}"
    assert str(told["restitution"].values[0]).endswith(words)
    with pytest.raises(
        InvalidValueError, match=r"restitution: the coefficient .* right foot .* 100 % of the distribution"
    ):
        job_of("mean = 0.99\ndeviation = 0.001", "histories", body=text, rest="")
