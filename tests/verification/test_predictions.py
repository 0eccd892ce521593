"""Probabilities are right as often as they say: bodies whose base, friction and restitution are hidden.

Here 200 of 32 histories; `make predictions` has 2,000 of 256, and goes on where it stopped.
"""

import json

import pytest
from benchmarks import predictions

pytestmark = pytest.mark.slow

CASES, COUNT, MOTIONS = 200, 32, 40


@pytest.fixture(scope="module")
def scores():
    """Scores of the predictions, of those that take the friction for known, and of the logistic."""
    return predictions.scored([predictions.foreseen(k, COUNT, MOTIONS) for k in range(CASES)])


@pytest.mark.verifies(
    "repeated sampling", "outcomes of bodies whose base, friction and restitution are hidden", room="studies",
    control="test_friction_that_is_taken_for_known_is_noticed",
)  # fmt: skip
def test_probabilities_are_right_as_often_as_they_say(scores):
    """Spiegelhalter's statistic, and every step of the reliability diagram but one."""
    given = scores["predict"]
    assert given.left_out == 0
    assert 0.2 < given.outcome.mean() < 0.8
    assert abs(given.calibration) < 3.0
    outside = [each for each in given.reliability() if not each.low <= each.predicted <= each.high]
    assert len(outside) <= 1, outside


@pytest.mark.verifies("negative control", room="studies")
def test_friction_that_is_taken_for_known_is_noticed(scores):
    """The input that decides most left out: the probabilities are far too sure, and worse."""
    ignorant = scores["friction taken for known"]
    assert abs(ignorant.calibration) > 5.0
    assert scores["predict"].logarithmic.value < ignorant.logarithmic.value


@pytest.mark.verifies("repeated sampling", "a logistic in PGA and PGV that has not seen the motion", room="studies")
def test_not_worse_than_the_plain_logistic(scores):
    """Brier scores in pairs, motions drawn again."""
    skill = scores["predict"].skill(scores["logistic, a motion left out"])
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
