"""What identify() says of a measurement, and what it refuses."""

import json
import subprocess
import sys

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.identification import ImpactTimes, RotationSeries, identify, series
from rocking.identification.posterior import interval_of_nodes
from rocking.identification.state_space import MEAN, SHARED, SPEED, Model, rotation

BLOCK = rk.Block(width=0.1, height=0.4)


def _path(count=11, r=0.9, scatter=0.01, seed=3):
    """A body that rocks, on its left foot first."""
    mean = np.zeros(len(SHARED))
    mean[SPEED], mean[MEAN] = 0.05, np.log(r)
    side = BLOCK.side("left")
    model = Model(
        np.arange(1, count) % 2, (side.slenderness_angle,) * 2, (side.frequency_parameter,) * 2, mean, 0.0 * mean
    )
    u = np.zeros((1, model.size))
    u[0, len(SHARED) :] = np.random.default_rng(seed).normal(size=count - 2)
    return model, model.path(u, np.array([scatter])), np.log(r) + scatter * u[0, len(SHARED) :]


@pytest.fixture(scope="module")
def found():
    """The answer from times of impacts, and what each impact took."""
    _, path, took = _path()
    return identify(ImpactTimes(path.times[0], sigma=1e-5, source="made up"), BLOCK, tilt=0.0, first="left"), took


def test_what_each_impact_took(found):
    """Exact times tell r at each impact, with what is not known of the body beside it."""
    answer, took = found
    assert not answer.refused
    assert [each.foot for each in answer.impacts[:3]] == ["right", "left", "right"]
    for each, true in zip(answer.impacts, np.exp(took), strict=True):
        assert each.coefficient.low < true < each.coefficient.high
        assert each.coefficient.high - each.coefficient.low < 0.02
    assert answer.mean.low < 0.9 < answer.mean.high
    assert answer.scatter.low < 0.01 < answer.scatter.high


def test_a_coefficient_that_does_not_scatter_is_said_to_have_none(found):
    """The verdict bounds the scatter; with a scatter of 1 % it does not say so."""
    answer = identify(ImpactTimes(_path(scatter=0.0)[1].times[0], sigma=1e-4), BLOCK, tilt=0.0, first="left")
    assert answer.scatter.value == answer.scatter.low == 0.0 < answer.scatter.high < 0.005
    assert f"scatters by less than {100.0 * answer.scatter.high:.2g} %" in answer.verdict
    assert answer.no_scatter > 0.9
    assert "less than" not in found[0].verdict
    assert found[0].no_scatter < 1e-6
    assert found[0].scatter.low > 0.0


def test_intervals_of_nodes_have_the_probability_of_zero():
    """Half at zero: median and lower end are zero, and the upper end is that of the rest."""
    values, weights = np.array([0.0, 0.01, 0.02, 0.04]), np.array([0.5, 0.1, 0.3, 0.1])
    median, low, high = interval_of_nodes(values, weights)
    assert (median, low) == (0.0, 0.0)
    assert 0.02 < high <= 0.04 * (1.0 + 1e-12)
    alone = interval_of_nodes(values[1:], weights[1:] / 0.5)
    assert alone[2] == pytest.approx(high)
    assert alone[1] > 0.0


def test_what_is_common_to_all_trials_is_of_the_size():
    """Without it the interval is as much narrower; by the mean over the scatter, which the size moves, to 15 %."""
    times = ImpactTimes(_path(scatter=1e-4)[1].times[0], sigma=1e-4)
    inexact, exact = (identify(times, BLOCK, tilt=0.0, size_error=error) for error in (0.01, 0.0))
    wide, narrow = (np.log(each.mean.high / each.mean.low) / 3.92 for each in (inexact, exact))
    assert inexact._common == pytest.approx(np.sqrt(wide**2 - narrow**2), rel=0.15)
    assert exact._common == 0.0


def _means(laws):
    """Return ln of the median coefficient of each foot, of shape (laws, 2)."""
    return np.log([[law.quantile(0.5, foot) for foot in ("left", "right")] for law in laws])


def test_laws_have_the_distribution_of_the_measurement(found):
    """Over many seeds, a side has its interval and the scatter has its interval."""
    laws = [found[0].law(seed=seed) for seed in range(400)]
    right = np.exp(_means(laws)[:, 1])
    interval = found[0].coefficients["right"]
    assert np.median(right) == pytest.approx(interval.value, rel=1e-3)
    # the quantile of 400 draws has a standard error of 0.04 of the width of the interval
    assert np.quantile(right, [0.025, 0.975]) == pytest.approx([interval.low, interval.high], rel=2e-3)
    scatters = [np.log(law.quantile(0.8413, "left") / law.quantile(0.5, "left")) for law in laws]
    # the grid of scatters has steps of 10 to 30 %
    assert np.median(scatters) == pytest.approx(found[0].scatter.value, rel=0.3)
    assert rk.free_rocking(BLOCK, rotation=0.1, restitution=laws[0]).impacts.size > 3


def test_an_unknown_tilt_does_not_scatter_the_impacts():
    """The interval of a side is wide, that of the mean is narrow, and the coefficient does not scatter. In a response
    the impacts of a side have one coefficient; the mean of both sides is that of the measurement."""
    answer = identify(ImpactTimes(_path(scatter=0.0)[1].times[0], sigma=1e-5), BLOCK, first="left")
    side = answer.coefficients["left"]
    assert side.high - side.low > 0.05 > 100.0 * (answer.mean.high - answer.mean.low)
    impacts = rk.free_rocking(BLOCK, rotation=0.1, restitution=answer.law(seed=2)).impacts
    for foot in ("left", "right"):
        coefficients = impacts["coefficient"][impacts["foot"] == foot]
        assert coefficients.size > 10
        assert np.log(coefficients).std() < answer.scatter.high
    drawn = _means([answer.law(seed=seed) for seed in range(100)])
    assert np.exp(drawn[:, 0]).std() == pytest.approx((side.high - side.low) / 3.92, rel=0.25)  # 3.5 / sqrt(2 * 100)
    assert np.exp(drawn.mean(axis=1)) == pytest.approx(
        answer.mean.value, abs=2.0 * (answer.mean.high - answer.mean.low)
    )
    # negative control: sides that are drawn independently have another mean
    independent = np.exp(0.5 * (drawn[:-1, 0] + drawn[1:, 1]))
    assert np.abs(independent - answer.mean.value).max() > 50.0 * (answer.mean.high - answer.mean.low)


def test_a_law_creates_no_energy():
    """Near r = 1 the interval of a side exceeds 1; the drawn coefficients do not."""
    answer = identify(ImpactTimes(_path(r=0.998, scatter=0.0)[1].times[0], sigma=1e-6), BLOCK, first="left")
    assert answer.coefficients["left"].high > 1.0
    assert np.exp(_means([answer.law(seed=seed) for seed in range(50)])).max() <= 1.0


def test_models_impulse_and_designs_stand_beside_it(found):
    answer = found[0]
    assert {"housner", "ked"} <= {each.model for each in answer.models}
    assert answer.impulse["left"].low < answer.impulse["left"].value < answer.impulse["left"].high
    assert answer.designs[0].deviation <= answer.designs[-1].deviation
    again = json.loads(json.dumps(answer.answer().plain()))
    assert again["mean"]["value"] == answer.mean.value
    assert "0.9" in again["verdict"]


@pytest.mark.slow
def test_a_body_that_nobody_knows_has_its_frequency_fitted(found):
    _, path, _ = _path(15, scatter=0.005)
    answer = identify(ImpactTimes(path.times[0], sigma=1e-4), tilt=0.0)
    assert not answer.refused
    assert answer.frequency_parameter.low < BLOCK.frequency_parameter < answer.frequency_parameter.high
    assert answer.models == ()


@pytest.mark.parametrize("kind", ["rotation", "angular_velocity"])
def test_a_series_with_offset_and_drift(kind):
    """The side is read from the sign."""
    model, path, _ = _path(9)
    time = np.arange(0.0, path.times[0, -1] - 0.01, 0.005)
    k = np.searchsorted(path.times[0], time, side="right") - 1
    theta, turning = rotation(path.p[0, k] * (time - path.times[0, k]), path.y[0, k], path.alpha[0, k])
    true = (1.0 - 2.0 * model.sides[k]) * (theta if kind == "rotation" else path.p[0, k] * turning)
    size = np.ptp(true)
    noise = 0.003 * size * np.random.default_rng(1).normal(size=time.size)
    before = np.arange(-20, 0) * 0.005
    values = np.concatenate([np.zeros(20), true + noise]) + 0.01 * size
    answer = identify(RotationSeries(np.concatenate([before, time]), **{kind: values}), BLOCK, tilt=0.0)
    assert not answer.refused
    assert answer.mean.low < 0.9 < answer.mean.high


@pytest.fixture
def drifting():
    """An angular velocity of many impacts, whose offset and drift are half of the last speeds."""
    model, path, _ = _path(26, r=0.92)
    time = np.arange(0.002, path.times[0, -1] - 0.002, 0.005)
    k = np.searchsorted(path.times[0], time, side="right") - 1
    turning = rotation(path.p[0, k] * (time - path.times[0, k]), path.y[0, k], path.alpha[0, k])[1]
    true = (1.0 - 2.0 * model.sides[k]) * path.p[0, k] * turning
    peak = np.abs(true).max()
    noise = 0.005 * peak * np.random.default_rng(4).normal(size=time.size)
    return RotationSeries(time, angular_velocity=true + noise + peak * (0.05 - 0.1 * time / time[-1])), path.times[
        0, 1:-1
    ]


@pytest.mark.slow
def test_small_impacts_are_found_in_spite_of_a_drift(drifting, monkeypatch):
    """To the last but three; about a level that does not follow it a third of them is lost (negative control)."""
    measured, times = drifting
    found = series.find_impacts(measured)[0]
    assert found.size >= times.size - 3
    np.testing.assert_allclose(found, times[: found.size], rtol=0, atol=0.03)
    answer = identify(measured, BLOCK, tilt=0.0)
    assert not answer.refused
    assert answer.mean.low < 0.92 < answer.mean.high
    assert answer.mean.high - answer.mean.low < 0.015
    monkeypatch.setattr(series, "_about_middle", lambda time, values, *_: values - np.median(values))
    assert series.find_impacts(measured)[0].size < times.size * 2 / 3


@pytest.mark.parametrize("kind", ["rotation", "angular_velocity"])
def test_slopes_of_a_series_are_those_of_its_differences(drifting, kind):
    """By each of the unknowns, sides of unlike slenderness; a wrong equation of disturbances would be seen."""
    measured, _ = drifting
    mean = np.zeros(len(SHARED))
    mean[SPEED], mean[MEAN] = -0.8, np.log(0.9)
    deviation = np.full(len(SHARED), 0.1)
    model = Model(np.arange(12) % 2, (0.25, 0.2), (4.0, 4.1), mean, deviation)
    u, scatter = 0.3 * np.random.default_rng(5).normal(size=(1, model.size)), np.array([0.02])
    times = model.path(u, scatter).times[0]
    inside = (measured.time > times[0]) & (measured.time < times[-1])
    row = series.Row(kind, measured.time[inside], measured.angular_velocity[inside])
    observer = series.SampledSeries((series._without_impact_samples(row, times, 1.0),), model.sides)
    slopes = observer.residuals(model.path(u, scatter))[1]
    for d in range(model.size):
        step = 1e-5 * np.eye(model.size)[d]
        below, above = (observer.residuals(model.path(u + sign * step, scatter))[0] for sign in (-1.0, 1.0))
        np.testing.assert_allclose(slopes[..., d], (below - above) / 2e-5, rtol=0, atol=1e-6 * np.abs(slopes).max())


@pytest.mark.slow
def test_noise_is_no_rocking():
    """Negative control: a series that crosses its middle for no reason."""
    time = np.arange(0.0, 5.0, 0.01)
    noise = np.convolve(np.random.default_rng(2).normal(size=time.size + 20), np.ones(21) / 21.0, "valid")
    assert identify(RotationSeries(time, rotation=0.1 * noise), BLOCK).refused


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"body": 3}, "body must be"),
        ({"size_error": 0.5}, "size_error must be in"),
        ({"tilt": 1.0}, "tilt must be in"),
        ({"first": "front"}, "first must be"),
    ],
)
def test_what_is_refused(given, words):
    with pytest.raises(InvalidValueError, match=words):
        identify(ImpactTimes([0.0, 1.0, 1.9, 2.7]), **given)
    with pytest.raises(InvalidValueError, match="measurement must be"):
        identify([0.0, 1.0, 1.9, 2.7])


def test_there_is_no_law_of_what_was_refused():
    with pytest.raises(InvalidValueError, match="no restitution law"):
        identify(ImpactTimes(np.arange(12.0)), BLOCK).law()


@pytest.mark.slow
def test_free_rocking_needs_no_compiled_engine():
    """A machine without the compiled modules identifies what was let go."""
    program = (
        "import sys\n"
        "for name in ('contact', 'engine', 'hull', 'spatial'): sys.modules['rocking.dynamics._' + name] = None\n"
        "import rocking as rk\n"
        "from rocking.identification import ImpactTimes\n"
        "times = ImpactTimes([0.0, 0.9, 1.7, 2.41, 3.04, 3.6, 4.1, 4.54])\n"
        "print(rk.identify(times, rk.Block(width=0.3, height=1.2)).verdict)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.startswith("The coefficient of restitution is")


def test_an_uncertain_maximum_without_a_body_names_the_remedy():
    """Times without noise determine p and the slenderness angle only with the size of the body."""
    free = rk.free_rocking(BLOCK, rotation=0.5 * BLOCK.slenderness_angle, restitution=0.91)
    times = ImpactTimes(free.impacts["time"][:11])
    without, with_body = identify(times), identify(times, BLOCK)
    assert not without.converged
    assert without.doubts[-1] == (
        "State the size of the body: without the size, p and the slenderness angle are unknown."
    )
    assert with_body.converged
    assert not any("State the size" in doubt for doubt in with_body.doubts)
