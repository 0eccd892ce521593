"""Probabilities are right as often as they state, for plane bodies with the errors of real tests.

These are 200 bodies with 32 histories each; `make predictions` has 2,000 bodies with 256.
"""

import json

import pytest
from benchmarks import predictions

pytestmark = pytest.mark.slow

CASES, COUNT, MOTIONS = 200, 32, 40


@pytest.fixture(scope="module")
def scores():
    """Scores of the predictions by their inputs, and of the logistic curve."""
    return predictions.scored([predictions.predicted_and_observed(k, COUNT, MOTIONS) for k in range(CASES)])


@pytest.mark.verifies(
    "repeated sampling", "outcomes of bodies with unknown base, centre, level, friction, restitution and model error",
    room="studies", control="test_an_assumed_friction_is_detected",
)  # fmt: skip
def test_probabilities_are_right_as_often_as_they_state(scores):
    """Spiegelhalter's statistic, and all bins of the reliability diagram except one."""
    prediction = scores["predict"]
    assert prediction.left_out == 0
    assert 0.2 < prediction.outcome.mean() < 0.8
    assert abs(prediction.calibration) < 2.0
    outside = [step for step in prediction.reliability() if not step.low <= step.predicted <= step.high]
    assert len(outside) <= 1, outside


@pytest.mark.verifies("negative control", room="studies")
def test_an_assumed_friction_is_detected(scores):
    """Without the most important input the probabilities are overconfident, and worse."""
    assumed = scores["assumed friction"]
    assert assumed.calibration > 3.0
    assert scores["predict"].logarithmic.value < assumed.logarithmic.value


@pytest.mark.verifies("repeated sampling", "a logistic curve in PGA and PGV from other motions", room="studies")
def test_not_worse_than_the_plain_logistic(scores):
    """Brier scores in pairs, with resampled motions."""
    skill = scores["predict"].skill(scores["logistic curve of the other motions"])
    assert skill.low > 0.0, skill


@pytest.mark.verifies("damage", room="studies")
def test_what_was_stopped_goes_on(tmp_path):
    """A line that was half written is computed again, whole ones are kept; other settings begin anew."""
    path, asked = tmp_path / "rows.jsonl", []

    def rows(cases, count):
        def made(number, count):
            asked.append(number)
            return {"number": number}

        return list(predictions.resumed(path, cases, made, predictions.__file__, count=count))

    assert len(rows(3, 8)) == 3
    path.write_text(path.read_text("utf-8")[:-6], "utf-8")
    assert [row["number"] for row in rows(4, 8)] == [0, 1, 2, 3]
    assert asked == [0, 1, 2, 2, 3]
    assert len(rows(2, 16)) == 2
    assert asked[5:] == [0, 1]
    assert json.loads(path.read_text("utf-8").splitlines()[0])["count"] == 16
