"""The kept numbers on tests of real bodies, recomputed from the tests where they are present."""

import json

import numpy as np
import pytest
from benchmarks import shaking_tests

from rocking.decision.prediction.model_error import KEPT

SAMPLE = 3
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        not (shaking_tests.DATA / "shaking_tests").is_dir(), reason="the shaking-table tests are not beside the project"
    ),
    pytest.mark.filterwarnings("ignore::rocking.errors.PlausibilityWarning"),
]


@pytest.fixture(scope="module")
def motions():
    return shaking_tests.motions_of(shaking_tests.outcomes()[0])


def numbers(motions):
    """Return the numbers to keep, from the stored histories."""
    any_azimuth = shaking_tests.stored(shaking_tests.ANY_AZIMUTH)
    return shaking_tests.kept_numbers(shaking_tests.stored(), any_azimuth, motions)


@pytest.mark.verifies(
    "measured", "490 shaking-table tests of a granite rock", room="studies",
    control="test_outcomes_of_other_tests_have_no_skill",
)  # fmt: skip
def test_kept_numbers_follow_from_the_tests(motions):
    """Posterior, scores and reliability from the outcomes of the tests and the stored histories."""
    table = shaking_tests.rounded(numbers(motions))
    kept = json.loads(KEPT.read_text("utf-8"))
    assert table.keys() == kept.keys()
    for name, scores in table["scores"].items():
        for key in ("brier", "balanced_accuracy"):
            assert scores[key]["value"] == pytest.approx(kept["scores"][name][key]["value"], rel=1e-4)
    np.testing.assert_allclose(table["bodies"][0]["mean"], kept["bodies"][0]["mean"], rtol=1e-3, atol=1e-5)
    assert [row["count"] for row in table["reliability"]] == [row["count"] for row in kept["reliability"]]


@pytest.mark.verifies("same bits", "the stored histories of three tests", room="studies")
def test_stored_histories_are_reproduced(motions):
    """Histories of three tests, computed again, are the stored ones."""
    samples = shaking_tests.stored()
    chosen = np.random.default_rng(11).choice(sorted(samples), SAMPLE, replace=False).tolist()
    for index, off, wide in shaking_tests.sampled(chosen, motions):
        for fresh, old in zip(map(shaking_tests.from_text, (off, wide)), samples[index], strict=True):
            np.testing.assert_array_equal(fresh, old)


@pytest.mark.verifies("negative control", room="studies")
def test_outcomes_of_other_tests_have_no_skill(motions, monkeypatch):
    """With permuted outcomes, no forecast is calibrated, and the Brier score is above that of the base rate."""
    names, earthquakes, observed = shaking_tests.outcomes()
    shuffled = np.random.default_rng(3).permutation(observed)
    monkeypatch.setattr(shaking_tests, "outcomes", lambda: (names, earthquakes, shuffled))
    table = numbers(motions)
    scores = table["scores"]["without model error"]
    assert scores["brier"]["value"] > observed.mean() * (1.0 - observed.mean())
    assert scores["calibration"] > 5.0


@pytest.mark.verifies("measured", "goals for the granite rock", room="studies")
def test_predictions_of_the_granite_rock_are_calibrated():
    """Better than a logistic curve that is fitted to the other earthquakes; not overconfident, not too cautious."""
    scores = json.loads(KEPT.read_text("utf-8"))["scores"]
    off, default = scores["without model error"], scores["model error of other earthquakes of this body"]
    assert off["brier"]["value"] <= 0.085
    assert default["brier"]["value"] <= 0.075
    assert default["balanced_accuracy"]["value"] >= 0.87
    assert abs(off["calibration"]) <= 2.0
    assert abs(default["calibration"]) <= 2.0
    assert default["better_than_logistic"]["low"] > 0.0
    any_azimuth = json.loads(KEPT.read_text("utf-8"))["any_azimuth"]["scores"]
    assert abs(any_azimuth["model error of other earthquakes of this body"]["calibration"]) <= 2.0
