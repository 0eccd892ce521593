"""Measures compared: efficiency, proficiency and sufficiency against independent regressions."""

import json
import math

import numpy as np
import pytest
from scipy import stats

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.studies import compare_measures, fragility_analysis
from rocking.studies.fragility.measure_comparison import replace_measure
from rocking.studies.fragility.question import FragilityQuestion
from rocking.studies.fragility.subject import Subject

pytestmark = pytest.mark.verifies(room="studies")

BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
RANDOM = np.random.default_rng(11)
PEAKS, PERIODS = RANDOM.uniform(2.6, 6.0, 120), RANDOM.uniform(0.1, 0.6, 120)
MOTIONS = [rk.pulses.half_sine(a, t) for a, t in zip(PEAKS, PERIODS, strict=True)]
NOISE = RANDOM.normal(size=120)


@pytest.fixture(scope="module")
def analysis():
    return fragility_analysis(BODY, MOTIONS, restitution=0.9, analysis="cloud")


@pytest.fixture(scope="module")
def ranking(analysis):
    columns = {"ln period": np.log(PERIODS), "noise": NOISE}
    return compare_measures(analysis, ["pga", "pgv", "pgv/pga", "arias", "sa(0.5)"], columns)


@pytest.mark.verifies(
    "computed anew", "SciPy's linregress on closed forms of half sines", within="1e-5; 1e-3 of p-values"
)
def test_every_number_against_independent_regressions(analysis, ranking):
    """Efficiency, slope, R squared and p-values, recomputed by scipy from the closed forms of half sines."""
    rocked = analysis.responses.rocked & (analysis.responses.rotation >= 0.01)
    response = np.log(analysis.responses.rotation[rocked])
    # PGV of a half sine that lasts half its period: a T / pi
    closed = {"pga": PEAKS, "pgv": PEAKS * PERIODS / math.pi, "pgv/pga": PERIODS / math.pi}
    for score in ranking.scores:
        if score.im not in closed:
            continue
        x = np.log(closed[score.im])[rocked]
        line = stats.linregress(x, response)
        residuals = response - line.intercept - line.slope * x
        # the measures of pulses are sampled, right to 1e-6
        assert score.efficiency == pytest.approx(math.sqrt(residuals @ residuals / (rocked.sum() - 2)), rel=1e-5)
        assert score.slope == pytest.approx(line.slope, rel=1e-5)
        assert score.proficiency == pytest.approx(score.efficiency / abs(score.slope), rel=1e-12, abs=0.0)
        assert score.determination == pytest.approx(line.rvalue**2, rel=1e-5)
        for name, column in {"ln period": np.log(PERIODS), "noise": NOISE}.items():
            wanted = stats.linregress(column[rocked], residuals).pvalue
            assert score.sufficiency[name] == pytest.approx(wanted, rel=1e-3, abs=1e-12)  # p reacts to the tails


def test_velocity_beats_acceleration_for_short_pulses(ranking):
    """Short pulses act by their impulse: PGV ranks above PGA, and PGA leaves out what the period knows."""
    places = {score.im: place for place, score in enumerate(ranking.scores)}
    assert places["pgv"] < places["pga"]
    by_name = {score.im: score for score in ranking.scores}
    assert by_name["pga"].sufficiency["ln period"] < 1e-6
    assert by_name["pga"].sufficiency["noise"] > 0.01  # the control: noise has nothing to say
    assert [s.efficiency for s in ranking.scores] == sorted(s.efficiency for s in ranking.scores)


def test_barely_lifted_histories_do_not_rank_measures():
    """A cloud with rotations of 1e-7 alpha ranks as the one without those histories; with them it does not."""
    question = FragilityQuestion.of(Subject.of(BODY, MOTIONS, 0.9, "pga", {}), "cloud")
    arrays = question.histories.run(0, 120)
    chosen = np.flatnonzero(arrays["outcome"] == rk.Outcome.ROCKED.code)[:20]
    arrays["peak_rotation"][chosen] *= 1e-7 / np.abs(arrays["peak_rotation"][chosen]) * math.atan(0.25)
    hurt = question.answer(arrays)
    kept = hurt.responses.rocked & (hurt.responses.rotation >= 0.01)
    found = compare_measures(hurt, ["pga", "pgv"])
    assert found.min_rotation == 0.01
    for score in found.scores:
        values = {"pga": PEAKS, "pgv": PEAKS * PERIODS / math.pi}[score.im]
        line = stats.linregress(np.log(values[kept]), np.log(hurt.responses.rotation[kept]))
        assert score.slope == pytest.approx(line.slope, rel=1e-5)  # sampled pulses are right to 1e-6
        assert score.rocked == kept.sum()
        assert score.barely_lifted == hurt.responses.rocked.sum() - kept.sum() >= 20
    everything = compare_measures(hurt, ["pga", "pgv"], min_rotation=0.0)
    assert everything.scores[0].efficiency > 3.0 * found.scores[0].efficiency
    assert found.rows()[0]["barely_lifted"] >= 20


def test_progress_counts_every_motion_for_every_measure(analysis):
    """The numbers told add up to motions times measures; what is no function is refused."""
    done = []
    compare_measures(analysis, ["pga", "pgv"], progress=done.append)
    assert sum(done) == 240
    with pytest.raises(InvalidValueError, match="progress"):
        compare_measures(analysis, ["pga"], progress=3)


def test_the_table(ranking):
    """Rows by rank, with one p-value a column of metadata, as plain values and as a data frame."""
    frame = ranking.to_dataframe()
    assert frame.index.tolist() == [1, 2, 3, 4, 5]
    assert frame.im.iloc[0] == ranking.best
    assert {"p(ln period)", "p(noise)", "overturning_dispersion"} <= set(frame.columns)
    json.dumps(ranking.rows())


def test_overturning_dispersion_is_that_of_the_curve():
    """The dispersion of overturning is the one that a cloud analysis against that measure fits."""
    pulses = [rk.pulses.sine(a, t) for a in np.linspace(2.6, 9.0, 12) for t in (0.4, 0.55, 0.7, 0.85)]
    over = fragility_analysis(BODY, pulses, restitution=0.9, analysis="cloud")
    scores = {s.im: s for s in compare_measures(over, ["pga", "pgv"]).scores}
    for name in ("pga", "pgv"):
        fit = fragility_analysis(BODY, pulses, restitution=0.9, im=name, analysis="cloud").fits["overturned"]
        assert scores[name].overturning_dispersion == pytest.approx(fit.dispersion, rel=1e-12, abs=0.0)
        assert scores[name].overturned == over.responses.overturned.sum() > 0


def test_the_same_histories_serve_all_measures(analysis):
    """Another measure changes levels, never outcomes; a factor counts with the power of the measure."""
    other = replace_measure(analysis, "arias")
    assert other.responses is analysis.responses
    doubled = replace_measure(fragility_analysis(BODY, MOTIONS, restitution=0.9, scale=2.0, analysis="cloud"), "arias")
    np.testing.assert_allclose(doubled.motion_levels, 4.0 * other.motion_levels, rtol=1e-13)


def test_measures_of_nothing_overturned_say_so(ranking):
    """Where nothing overturned there is no dispersion, and the verdict says why."""
    for score in ranking.scores:
        if score.overturned == 0:
            assert math.isnan(score.overturning_dispersion)
            assert score.overturning_verdict


def test_a_measure_that_does_not_vary_is_left_out():
    """Pulses of one amplitude: PGA says nothing about them and is named, the others are ranked."""
    same = fragility_analysis(
        BODY, [rk.pulses.half_sine(4.0, t) for t in (0.2, 0.3, 0.4, 0.5, 0.6)], restitution=0.9, analysis="cloud"
    )
    found = compare_measures(same, ["pga", "pgv"])
    assert [s.im for s in found.scores] == ["pgv"]
    assert list(found.left_out) == ["pga"]
    with pytest.raises(InvalidValueError, match="no measure can be ranked"):
        compare_measures(same, ["pga"])


@pytest.mark.parametrize(
    ("measures", "metadata"),
    [
        ([], None), (["pga", "pga"], None), (["pga"], {"magnitude": [6.0, 7.0]}), (["nonsense"], None),
        (["pga"], {"magnitude": np.full(120, math.nan)}), (["pga"], {"magnitude": ["six"] * 120}),
        (["pga"], {"magnitude": np.full(120, 6.0)}),
    ],
)  # fmt: skip
def test_bad_questions_are_refused(analysis, measures, metadata):
    """No measure, one twice, or a column that does not fit or does not vary."""
    with pytest.raises(InvalidValueError):
        compare_measures(analysis, measures, metadata)
