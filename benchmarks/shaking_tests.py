"""Predictions of shaking-table tests of real bodies: kept posteriors, scores and reliability.

`make shaking-tests` samples histories of all tests that are present beside the project, stores their outcomes in
shaking_tests.txt, and writes the kept numbers. A random subset is predicted without the axis of the table as well.
Records and outcomes of tests are not kept. Stored histories are used again; remove the files for new ones.
"""

import csv
import json
from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

import rocking as rk
from rocking.conventions import FloatArray
from rocking.decision.prediction._predict import sampled_bodies
from rocking.decision.prediction.mechanics import SampledBodies
from rocking.decision.prediction.model_error import KEPT, hierarchy
from rocking.decision.prediction.recalibration import WIDE, BodyTests, wide_draws, wide_sample
from rocking.motions.integrals import peak_ground_velocity
from rocking.motions.pipeline import processed
from rocking.statistics.counts import share_interval
from rocking.statistics.scores import Forecasts, logistic_left_out
from rocking.statistics.sobol import scrambled_sobol

ROOT = Path(__file__).parents[1]
DATA, SAMPLES = ROOT.parent / "shared" / "data", Path(__file__).with_suffix(".txt")
ANY_AZIMUTH, ANY_COUNT = SAMPLES.with_name("shaking_tests_any_azimuth.txt"), 110
"""Histories without the axis of the table, and number of their tests."""
NAME, KIND, AXIS, UP = "granite rock", "natural", (0.5322, 0.0040, 0.8466), (0.816, 0.263, -0.514)
STEPS = "mean; bandpass:low=0.1,high=25"
OFF_COUNT, WIDE_COUNT, SEED = 16, 16, 1
"""Samples of each test without model error, and with the proposal of factors; random seed."""

DEFAULT, LOGISTIC = "model error of other earthquakes of this body", "logistic curve in PGA and PGV"
Stored = dict[int, tuple[FloatArray, FloatArray]]
"""Outcomes of histories by index of the test: without model error, and with the proposal."""

EDGES = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)


def outcomes(data: Path = DATA) -> tuple[list[str], Any, FloatArray]:
    """Return the names, the earthquakes and the outcomes of the tests."""
    with (data / "shaking_tests" / "granite_rock_outcomes.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    observed = np.array([float(row["overturned"]) for row in rows])
    return [row["shake"] for row in rows], np.array([row["earthquake"] for row in rows]), observed


def motions_of(names: list[str], data: Path = DATA) -> list[Any]:
    """Return the motions of the table."""
    with np.load(data / "shaking_tests" / "granite_rock_motions.npz") as arrays:
        samples = {name: arrays[name] * float(arrays[f"{name}_unit"]) for name in names}
    return [processed(rk.GroundMotion(values, 0.005, name=name), STEPS) for name, values in samples.items()]


def rock(data: Path = DATA) -> tuple[rk.Solid, float]:
    """Return the rock as it stood on the table, and the azimuth of its x axis from the axis of the table [rad]."""
    solid = rk.read_body(data / "scans" / "granite_rock.obj", units="m", up=UP)
    assert isinstance(solid, rk.Solid)
    x, y, _ = (solid.turn @ np.array(AXIS)).tolist()
    return solid, -float(np.arctan2(y, x))


def mechanics(motions: list[Any], error: Any, *, axis: bool = True) -> SampledBodies:
    """Return the sampled bodies of the rock under motions; axis: True with the axis of the table."""
    solid, azimuth = rock()
    return sampled_bodies(solid, motions, {"azimuth": azimuth if axis else None, "model_error": error})


def sampled(indices: Iterable[int], motions: list[Any], *, axis: bool = True) -> Iterator[tuple[int, str, str]]:
    """Yield the index of a test, and its sampled outcomes without model error and with the proposal as text."""
    off, wide = mechanics(motions, "off", axis=axis), mechanics(motions, WIDE, axis=axis)
    draws = scrambled_sobol(sum(off.widths.values()), OFF_COUNT, SEED)
    for index in indices:
        fell = off.run(draws, index, np.ones(OFF_COUNT), 1).overturning
        yield index, as_text(fell), as_text(wide_sample(wide, index, WIDE_COUNT, SEED, 1)[1])


def as_text(overturned: FloatArray) -> str:
    """Return outcomes as text: 1, 0, or - without a result."""
    return "".join("-" if np.isnan(value) else f"{value:.0f}" for value in overturned)


def from_text(text: str) -> FloatArray:
    """Return the outcomes of a text."""
    return np.array([np.nan if mark == "-" else float(mark) for mark in text])


def stored(path: Path = SAMPLES) -> Stored:
    """Return the stored outcomes of histories by index of the test: without model error, and with the proposal."""
    lines = path.read_text("utf-8").splitlines() if path.is_file() else []
    rows = [line.split() for line in lines if not line.startswith("#")]
    return {int(index): (from_text(off), from_text(wide)) for index, off, wide in rows}


def tests_of(samples: Stored, motions: list[Any], *, axis: bool) -> tuple[BodyTests, dict[str, Forecasts]]:
    """Return the tests with stored histories, and their forecasts by name."""
    indices = sorted(samples)
    earthquakes, observed = (values[indices] for values in outcomes()[1:])
    off, overturned = (np.array([samples[k][kind] for k in indices]) for kind in (0, 1))
    wide = mechanics(motions[:1], WIDE, axis=axis)
    points = [wide_draws(wide.widths, k, WIDE_COUNT, SEED) for k in indices]
    logarithms = np.log([wide.values(draws)["model_error"] for draws in points])
    tests, prior = BodyTests(logarithms, overturned, observed, earthquakes), hierarchy([], KIND)
    peaks = np.log([(motions[k].peak, peak_ground_velocity(motions[k])) for k in indices])
    probabilities = {
        "without model error": (np.nansum(off, axis=1) + 0.5) / (np.isfinite(off).sum(axis=1) + 1.0),
        DEFAULT: tests.left_out(prior),
        "model error without tests": tests.without(prior),
        LOGISTIC: logistic_left_out(peaks, observed, earthquakes),
    }
    return tests, {name: Forecasts(values, observed, earthquakes) for name, values in probabilities.items()}


def kept_numbers(samples: Stored, any_azimuth: Stored, motions: list[Any]) -> dict[str, Any]:
    """Return the numbers to keep, from the tests with stored histories: posterior, scores, and reliability."""
    tests, forecasts = tests_of(samples, motions, axis=True)
    body, observed = tests.tested(NAME, KIND), tests.observed
    return {
        "data": "shaking-table tests by Zhiang Chen (virtual_shake_robot_pybullet, VSR_Pro); these numbers are fitted "
                "to their outcomes",
        "bodies": [{
            "name": body.name, "kind": body.kind, "tests": body.tests, "earthquakes": body.earthquakes,
            "overturned": int(observed.sum()), "mean": body.mean.tolist(), "covariance": body.covariance.tolist(),
            "scatter": body.scatter,
        }],
        "samples": {"without model error": OFF_COUNT, "with the proposal": WIDE_COUNT},
        "scores": _scores(forecasts),
        "any_azimuth": {
            "tests": len(any_azimuth), "scores": _scores(tests_of(any_azimuth, motions, axis=False)[1]),
        },
        "reliability": _reliability(forecasts[DEFAULT].probability, observed),
    }  # fmt: skip


def _scores(forecasts: dict[str, Forecasts]) -> dict[str, dict[str, Any]]:
    return {
        name: {
            "brier": vars(forecast.brier), "balanced_accuracy": vars(forecast.balanced_accuracy),
            "calibration": forecast.calibration, "better_than_logistic": vars(forecast.skill(forecasts[LOGISTIC])),
        }
        for name, forecast in forecasts.items()
    }  # fmt: skip


def _reliability(probability: FloatArray, observed: FloatArray) -> list[dict[str, float]]:
    """Return the observed fractions of tests with similar probabilities."""
    rows = []
    for low, high in pairwise(EDGES):
        inside = (probability >= low) & ((probability < high) | (high == 1.0))
        count, happened = int(inside.sum()), float(observed[inside].sum())
        ends = share_interval(happened, count) if count else (0.0, 1.0)
        rows.append({"low": low, "high": high, "count": count, "observed": happened / max(count, 1),
                     "observed_low": ends[0], "observed_high": ends[1]})  # fmt: skip
    return rows


def rounded(value: Any) -> Any:
    """Return a table with six significant digits."""
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(item) for item in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


def main() -> None:
    """Sample the histories, or take the stored ones, and write the kept numbers."""
    if not (DATA / "shaking_tests").is_dir():
        print(f"no shaking-table tests in {DATA / 'shaking_tests'}; the kept numbers do not change")
        return
    names = outcomes()[0]
    motions = motions_of(names)
    subset = np.random.default_rng(4).permutation(len(names))[:ANY_COUNT].tolist()
    for path, indices, axis in ((SAMPLES, range(len(names)), True), (ANY_AZIMUTH, subset, False)):
        missing = [index for index in indices if index not in stored(path)]
        with path.open("a", encoding="utf-8") as file:
            for index, off, wide in sampled(missing, motions, axis=axis):
                print(index, off, wide, file=file, flush=True)
    table = rounded(kept_numbers(stored(), stored(ANY_AZIMUTH), motions))
    KEPT.write_text(json.dumps(table, indent=1) + "\n", "utf-8")
    for name, scores in table["scores"].items():
        brier, accuracy = scores["brier"], scores["balanced_accuracy"]["value"]
        print(f"{name}: Brier {brier['value']:.4f} ({brier['low']:.4f} to {brier['high']:.4f}), balanced accuracy "
              f"{accuracy:.3f}, Spiegelhalter {scores['calibration']:.2f}")  # fmt: skip


if __name__ == "__main__":
    main()
