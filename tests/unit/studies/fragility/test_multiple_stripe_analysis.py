"""Multiple stripes: limit states, counts against single simulations, plans, the check of uplift, failures."""

import json
import math

import numpy as np
import pytest
from random_cases import smooth_noises

import rocking as rk
from rocking import conventions
from rocking.dynamics import RockingParameters, RockingSide
from rocking.errors import InvalidValueError
from rocking.studies import MotionSet, fragility_analysis
from rocking.studies.fragility.limit_states import limit_states_of
from rocking.studies.fragility.question import FragilityQuestion
from rocking.studies.fragility.subject import Responses, Subject, uplift_check

BLOCK = rk.Block(width=0.5, height=2.0)


def records(count, seed=7, samples=600):
    """Noise in a window, smoothed: long enough to rock a block of 2 m."""
    noises = enumerate(smooth_noises(count, seed, samples))
    return [rk.GroundMotion(noise, 0.02, name=f"noise {k}") for k, noise in noises]


MOTIONS, LEVELS = records(12), np.array([1.5, 3.0, 4.5, 6.0, 8.0, 10.0])


@pytest.fixture(scope="module")
def stripes():
    return fragility_analysis(BLOCK, MOTIONS, LEVELS, restitution=0.9, limit_states=(0.2, 0.5))


def test_counts_against_single_simulations(stripes):
    """The states of each history are those of a simulation of the record scaled by its own peak."""
    expected = {name: np.zeros(LEVELS.size, int) for name in stripes.counts}
    alpha = math.atan(0.25)
    for level, target in enumerate(LEVELS):
        for record in MOTIONS:
            one = rk.simulate(BLOCK, record.scaled(target / float(np.abs(record.acceleration).max())), restitution=0.9)
            over = one.outcome is rk.Outcome.OVERTURNED
            reached = (
                one.outcome is not rk.Outcome.NO_UPLIFT,
                over or one.peak_rotation > 0.2 * alpha,
                over or one.peak_rotation > 0.5 * alpha,
                over,
            )
            for name, yes in zip(expected, reached, strict=True):
                expected[name][level] += yes
    assert list(expected) == ["rocking", "rotation > 0.2 alpha", "rotation > 0.5 alpha", "overturned"]
    for name, counts in expected.items():
        assert stripes.counts[name].tolist() == counts.tolist()
    assert 0 < stripes.counts["overturned"].sum() < 12 * LEVELS.size
    assert stripes.trials.tolist() == [12] * LEVELS.size
    assert stripes.failed == 0


def test_rocking_is_no_matter_of_probability(stripes):
    """Under horizontal motions PGA alone decides: no history contradicts g tan(alpha), and no curve is fitted."""
    assert stripes.uplift.threshold == pytest.approx(conventions.g * 0.25, rel=1e-14, abs=0.0)
    assert (stripes.uplift.checked, stripes.uplift.contradictions) == (12 * LEVELS.size, 0)
    assert "rocking" not in stripes.fits
    assert stripes.counts["rocking"].tolist() == [0, 12, 12, 12, 12, 12]


def test_the_check_of_uplift_can_fail(stripes):
    """Negative control: against levels shifted by a factor of two the same histories contradict the threshold."""
    shifted = np.broadcast_to(LEVELS * 0.5, (12, LEVELS.size))
    assert uplift_check(stripes.subject, shifted, stripes.responses).contradictions == 24


def test_no_threshold_with_a_vertical_part_or_another_measure():
    """With a vertical part, or against PGV, no level decides: rocking gets a curve, and the check says so."""
    shaken = [rk.GroundMotion(m.acceleration, 0.02, vertical=0.5 * m.acceleration[::-1]) for m in MOTIONS]
    found = fragility_analysis(BLOCK, shaken, LEVELS, restitution=0.9)
    assert found.uplift.threshold is None
    assert "no level" in found.uplift.verdict
    by_velocity = FragilityQuestion.of(Subject.of(BLOCK, MOTIONS, "ked", "pgv", {}), levels=[0.1, 0.2]).histories
    assert by_velocity.count == 24


def test_a_plan_computed_elsewhere_gives_the_same_analysis(stripes):
    """Histories run in two pieces and joined finish as the analysis that was computed at once."""
    question = FragilityQuestion.of(Subject.of(BLOCK, MOTIONS, 0.9, "pga", {}), levels=LEVELS, limit_states=(0.2, 0.5))
    assert question.histories.key() == stripes.histories.key()
    halves = question.histories.run(0, 31), question.histories.run(31, question.histories.count)
    found = question.answer({name: np.concatenate([half[name] for half in halves]) for name in halves[0]})
    np.testing.assert_array_equal(found.responses.rotation, stripes.responses.rotation)
    for name, fit in stripes.fits.items():
        assert found.fits[name].median == fit.median


def test_failed_histories_are_left_out_and_counted(stripes):
    """One failed history lowers the trials of its level by one and touches nothing else."""
    question = FragilityQuestion.of(Subject.of(BLOCK, MOTIONS, 0.9, "pga", {}), levels=LEVELS, limit_states=(0.2, 0.5))
    arrays = question.histories.run(0, question.histories.count)
    arrays["outcome"][4] = rk.Outcome.FAILED.code
    arrays["peak_rotation"][4] = math.nan
    found = question.answer(arrays)
    assert found.failed == 1
    assert found.trials.tolist() == [12, 12, 12, 12, 11, 12]
    lost = {name: int(stripes.counts[name][4] - counts[4]) for name, counts in found.counts.items()}
    assert lost == {s.name: int(stripes.responses.exceed(s)[0, 4]) for s in stripes.limit_states}
    assert np.isnan(found.responses.rotation[0, 4])


def test_progress_and_threads_change_nothing(stripes):
    """The numbers of done histories add up, and one thread gives the same states."""
    done = []
    found = fragility_analysis(
        BLOCK, MOTIONS, LEVELS, restitution=0.9, limit_states=(0.2, 0.5), threads=1, progress=done.append
    )
    assert sum(done) == found.histories.count == 72
    np.testing.assert_array_equal(found.responses.outcome, stripes.responses.outcome)


@pytest.mark.slow
def test_dataset_and_summary(stripes):
    """All outcomes with units, and a summary of plain values that names its definition."""
    data = stripes.dataset
    assert dict(data.sizes) == {"motion": 12, "level": 6, "state": 4}
    assert data.level.attrs["units"] == "m/s2"
    assert data.exceeded.sel(state="overturned").values.tolist() == stripes.counts["overturned"].tolist()
    assert "stripes" in data.attrs["definition"]
    assert "0 of 72" in json.dumps(stripes.summary(), default=str)


class Lazy(MotionSet):
    """Motions that count how often they are made."""

    def __init__(self):
        self.made = 0

    def __len__(self):
        return 12

    def __getitem__(self, index):
        self.made += 1
        return MOTIONS[index]

    def description(self):
        return {"kind": "lazy"}


def test_names_and_threshold_make_each_motion_once():
    """However often names and threshold of uplift are asked for, a lazy set makes each motion once for both."""
    lazy = Lazy()
    subject = Subject.of(BLOCK, lazy, 0.9, "pga", {})
    for _ in range(3):
        assert subject.names == [f"noise {k}" for k in range(12)]
        assert subject.uplift_threshold == pytest.approx(conventions.g * 0.25)
    assert lazy.made == 12


def test_the_same_motion_under_six_names_is_one_cluster():
    """Copies of one record are one observation: no bootstrap of a certainty, and the verdict says why."""
    copies = [rk.GroundMotion(MOTIONS[0].acceleration, 0.02, name=f"copy {k}") for k in range(6)]
    one = fragility_analysis(BLOCK, copies, np.linspace(3.0, 12.0, 9), restitution=0.9).fits["overturned"]
    assert (one.counts.clusters, one.interval_method) == (1, "profile")
    assert "1 distinct cluster, where 5 are needed" in one.verdict
    with pytest.raises(InvalidValueError, match="far too narrow"):
        one.bootstrap("clusters")
    mixed = fragility_analysis(BLOCK, [*MOTIONS, MOTIONS[3], MOTIONS[3]], LEVELS, restitution=0.9).fits["overturned"]
    assert mixed.counts.clusters == 12


SIDES = RockingSide(0.2, 2.0, 1.0, 0.9), RockingSide(0.4, 2.0, 1.0, 0.9)
ROCKER = RockingParameters(*SIDES, None, "")  # type: ignore[arg-type]
ARRAYS = {
    "outcome": np.array([0, 1, 1, 2, 3], dtype=np.int8),  # as the codes of `Outcome` are documented
    "peak_rotation": np.array([0.0, 0.12, -0.12, -0.5 * math.pi, math.nan]),
}


def test_rotation_is_over_the_alpha_of_its_side():
    """A rotation of 0.12 rad is 0.6 of the right side's angle and 0.3 of the left side's."""
    found = Responses.of(ARRAYS, ROCKER, (5,))
    np.testing.assert_allclose(found.rotation, [0.0, 0.6, 0.3, math.inf, math.nan], rtol=1e-15)
    assert found.sides.tolist() == [0, 0, 0, -1, 0]
    other = Responses.of(
        {name: -values if name == "peak_rotation" else values for name, values in ARRAYS.items()}, ROCKER, (5,)
    )
    assert other.sides.tolist() == [0, 0, 0, 1, 0]


def test_states_are_nested():
    """What reaches a state has reached all before it; of a failed one nothing is known."""
    found = Responses.of(ARRAYS, ROCKER, (5,))
    reached = np.array([found.exceed(state) for state in limit_states_of((0.2, 0.5))])
    assert reached[:, :4].tolist() == [[0, 1, 1, 1], [0, 1, 1, 1], [0, 1, 0, 1], [0, 0, 0, 1]]
    assert np.isnan(reached[:, 4]).all()
    assert found.good.tolist() == [True] * 4 + [False]
    assert found.counts() == {rk.Outcome.NO_UPLIFT: 1, rk.Outcome.ROCKED: 2, rk.Outcome.OVERTURNED: 1}


def test_levels_may_be_absent_or_above_one():
    """No level leaves rocking and overturning; rotations beyond alpha that come back are states as well."""
    assert [s.name for s in limit_states_of(())] == ["rocking", "overturned"]
    assert limit_states_of((1.2,))[1].level == 1.2


def test_results_of_another_study_are_refused():
    """Arrays that do not fit the shape never become states."""
    with pytest.raises(InvalidValueError, match="belong to this study"):
        Responses.of(ARRAYS, ROCKER, (4,))
    with pytest.raises(InvalidValueError):
        Responses.of({"outcome": np.zeros(5)}, ROCKER, (5,))


def test_states_of_simulated_bodies():
    """Peak rotations of the engine over the body's own alpha, against one simulation each."""
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6)
    one = rk.simulate(block, pulse, restitution=0.9)
    arrays = {"outcome": np.array([one.outcome.code]), "peak_rotation": np.array([-one.peak_rotation])}
    found = Responses.of(arrays, RockingParameters.of_body(block, 0.9, 9.80665), (1,))
    assert found.rotation[0] == pytest.approx(one.peak_rotation / math.atan(0.25), rel=1e-14, abs=0.0)
