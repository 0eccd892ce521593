"""A coefficient drawn from values in the job, or from what the measurements say of the body: as the Python call."""

from pathlib import Path

import numpy as np
import pytest
from campaign_jobs import BODY, PULSE, axes, job

import rocking as rk
from rocking.campaigns.jobs import Job
from rocking.conventions import percent
from rocking.dynamics import RandomRestitution
from rocking.errors import InvalidValueError, PlausibilityWarning
from rocking.evidence import restitution_distribution
from rocking.spec.documents.response import ResponseDocument
from rocking.spec.reading import InputFiles, checked, tables_of
from rocking.spec.response import response_problem
from rocking.studies import SampledRestitution, overturning_map

BLOCK = rk.Block(width=0.5, height=2.0)
AXES = ("frequency_ratio", np.linspace(2.0, 8.0, 9)), ("amplitude_ratio", np.linspace(1.0, 9.0, 8))
MAP = axes((2, 8, 9), (1, 9, 8))
VALUES = np.round(np.random.default_rng(4).normal(0.88, 0.04, 40).clip(0.0, 1.0), 6).tolist()
EACH = pytest.mark.parametrize("each", ["history", "impact"])


def job_of(distribution, kind="overturning-map", seed=8, body=BODY, rest=MAP):
    """A job with a distribution."""
    return Job.of_text(job(kind, body, PULSE, f"[restitution.distribution]\n{distribution}\n", rest, seed=seed))


def peaks_of(distribution, seed=8):
    """Peak rotations of a map."""
    study = job_of(distribution, seed=seed).study
    return study.histories.run(0, study.histories.count)["peak_rotation"]


def label_of(distribution, *how, **changes):
    """What the restitution of a job is called."""
    (label,) = job_of(distribution, *how, **changes).problem.restitutions
    return label


def from_python(law):
    """Peak rotations of the map of one call."""
    return overturning_map(BLOCK, rk.pulses.sine(3.0, 0.6), *AXES, restitution=law)["peak_rotation"].values.ravel()


@EACH
def test_values_are_the_law_of_python(each):
    """A map with values in its job is that of the law made of them; other values, and another seed, are other maps."""
    text = f'values = {VALUES}\neach = "{each}"\nseed = 8'
    found = peaks_of(text)
    kind = RandomRestitution if each == "impact" else SampledRestitution
    np.testing.assert_array_equal(found, from_python(kind.of_sample(VALUES, seed=8)))
    for other in (text.replace("seed = 8", "seed = 9"), text.replace(str(VALUES), "[0.8, 0.81]")):
        assert not np.array_equal(found, peaks_of(other), equal_nan=True)


@pytest.mark.slow
@EACH
def test_posterior_is_the_law_of_python(each):
    """The map of the job is that of the posterior's law in Python, bit by bit; another seed and body are not."""
    found = restitution_distribution(BLOCK)
    law = found.per_history(8) if each == "history" else found.per_impact(8)
    wanted, text = from_python(law), f'posterior = true\neach = "{each}"'
    np.testing.assert_array_equal(peaks_of(f"{text}\nseed = 8", seed=0), wanted)
    np.testing.assert_array_equal(peaks_of(text), wanted)  # the seed of the campaign, where the table has none
    assert not np.array_equal(peaks_of(f"{text}\nseed = 9"), wanted, equal_nan=True)
    slender = restitution_distribution(8.0)
    other = slender.per_history(8) if each == "history" else slender.per_impact(8)
    assert not np.array_equal(law.factors, other.factors)


@EACH
def test_so_many_values_of_the_posterior(each):
    """With count, the law is that of a sample of the posterior: the values that `values` would take."""
    sample = restitution_distribution(BLOCK).sample(40, 5)
    named = f'posterior = true\ncount = 40\neach = "{each}"\nseed = 5'
    np.testing.assert_array_equal(peaks_of(named), peaks_of(f'values = {sample.tolist()}\neach = "{each}"\nseed = 5'))
    assert not np.array_equal(peaks_of(named), peaks_of(named.replace("40", "41")), equal_nan=True)


@pytest.mark.slow
def test_labels():
    """The label says what is drawn, and whether the body is more slender than what was measured."""
    values = 'values = [0.95, 1.0, 0.9]\ntimes = "housner"\nseed = 1'  # draws may multiply a model
    assert label_of(values) == "drawn per impact: 3 values from 0.9 to 1, seed 1"
    wanted = "drawn per impact: 30 values of the posterior of the measurements, seed 8"
    cut = percent(restitution_distribution(4.0).cut["left"])
    beyond = f" (of the distribution {cut} cut off, where impacts would create energy)"
    assert label_of("posterior = true\ncount = 30") == wanted + beyond
    cut = percent(restitution_distribution(80.0).cut["left"])
    assert label_of("posterior = true", body=BODY.replace("2.0", "40.0")) == (
        "drawn per impact: posterior of the measurements (extrapolated in slenderness), seed 8"
        f" (of the distribution {cut} cut off, where impacts would create energy)"
    )


def test_one_response():
    """The document of one response takes it too, drawn per impact."""
    text = f"[response]\ninitial_rotation = 0.5\n{BODY}[restitution.distribution]\nposterior = true\nseed = 3"
    problem = response_problem(checked(ResponseDocument, tables_of(text)), InputFiles(Path()))
    (law,) = problem.restitutions.values()
    wanted = restitution_distribution(BLOCK).per_impact(3)
    assert (type(law), law.seed) == (type(wanted), 3)
    assert np.array_equal(law.factors, wanted.factors)


ONE = "Use mean and deviation, or values, or posterior"


@pytest.mark.parametrize(
    ("distribution", "words"),
    [
        ("values = [0.9, 0.8]\nmean = 0.9\ndeviation = 0.1", ONE),
        *((each, ONE) for each in ("mean = 0.9", "deviation = 0.1", "seed = 3")),
        *(
            (f"values = {each}", r"restitution\.distribution\.values")
            for each in ("[0.9]", "[]", "[0.9, -0.1]", "[0.9, nan]", "[0.9, 1.1]")
        ),
        ("posterior = true\nvalues = [0.8, 0.9]", "or posterior. Got values and posterior"),
        ("posterior = true\nmean = 0.9", "or posterior. Got mean and posterior"),
        ("posterior = false", r"restitution\.distribution\.posterior"),
        ("posterior = true\ncount = 1", r"restitution\.distribution\.count"),
        ("values = [0.8, 0.9]\ncount = 5", "count is allowed with posterior only"),
        ('posterior = true\ntimes = "ked"', "Use times or posterior, not both"),
    ],
)
def test_refused_tables(distribution, words):
    """One distribution, whole; values are several coefficients; a posterior stands alone, with a count of its own."""
    with pytest.raises(InvalidValueError, match=words):
        job_of(distribution)


def test_one_body_is_needed():
    """Several bodies have several posteriors, and a spectrum has no body: both are refused by name."""
    two = BODY.replace("[body]", "[[body]]")
    with pytest.raises(InvalidValueError, match=r"needs one body, and the job has 2 bodies: use one job per body"):
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


@pytest.mark.slow
@EACH
@pytest.mark.parametrize("count", ["", "count = 30"])
def test_a_body_with_unequal_sides(each, count):
    """Each side draws from a table of its own: the laws of the evidence, or samples of both at the same numbers."""
    outline = [(0.0, 0.0), (0.4, 0.0), (0.4, 1.5), (0.0, 1.2)]
    body = rk.Section([rk.Region(outline, 2000.0)], feet=(0.0, 0.4))
    found = restitution_distribution(body)
    law = found.per_history(8) if each == "history" else found.per_impact(8)
    if count:
        law = type(law).of_sample({foot: found.sample(30, 8, foot) for foot in ("left", "right")}, seed=8)
    made = job_of(f'posterior = true\neach = "{each}"\n{count}', "histories", body=SECTION, rest="")
    (own,) = made.problem.restitutions.values()
    assert type(own) is type(law)
    assert np.array_equal(own.factors, law.factors)
    assert not np.array_equal(own.table("left"), own.table("right"))
    peak = made.study.histories.run(0, 1)["peak_rotation"][0]
    assert peak == pytest.approx(rk.simulate(body, rk.pulses.sine(3.0, 0.6), law).peak_rotation, abs=1e-9)


def test_the_label_says_what_is_cut_off():
    """A distribution of which a part would create energy says so in the label of the job, as `simulate` does."""
    body = rk.Section([rk.Region([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 3.0)], 2400.0)])
    text = SECTION.replace("0.4, 1.5], [0.0, 1.2", "1.0, 1.0], [0.0, 3.0").replace("0.4", "1.0")
    with pytest.warns(PlausibilityWarning, match=r"9\.78 % of the distribution"):
        label = label_of("mean = 0.9\ndeviation = 0.05", "histories", body=text, rest="")
    with pytest.warns(PlausibilityWarning, match=r"9\.78 % of the distribution"):
        many = rk.simulate_many(body, rk.pulses.sine(3.0, 0.6), RandomRestitution.normal(0.9, 0.05, seed=8))
    words = " (of the distribution 9.78 % onto right cut off, where impacts would create energy)"
    assert label == f"drawn per impact: 0.9 +- 0.05, seed 8{words}"
    assert str(many["restitution"].values[0]).endswith(words)
    refused = r"restitution: the coefficient .* right foot .* 100 % of its distribution"
    with pytest.raises(InvalidValueError, match=refused):
        job_of("mean = 0.99\ndeviation = 0.001", "histories", body=text, rest="")
