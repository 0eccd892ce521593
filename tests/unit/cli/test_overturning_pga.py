"""`rocking overturning-pga`: crossings equal the study, sentences, files, refusals."""

import csv
import json

import numpy as np
import pytest

import rocking as rk
from rocking.cli.overturning_pga import stretches as sentence
from rocking.studies.minimum_acceleration import Transitions

COMMAND = "overturning-pga"

G = 9.80665
SIZE = ("--width", "0.5", "--height", "2")
PULSE = "sine:amplitude=3,period=0.8"


def made(modes, accelerations, *, starts=False):
    """Transitions by hand, between 1 g and 9 g, accelerations in g."""
    a = G * np.array(accelerations)
    return Transitions(a, a, a, np.array(modes).reshape(-1, 2), 0.0 * a, G, 9.0 * G, G, 0.004, starts, 1, 0)


def test_json_is_the_python_call(answered):
    """Every crossing is that of the study, bit by bit, in g and in m/s2."""
    told = answered(*SIZE, PULSE, "--restitution", "0.85", "--max-pga", "5g")
    block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.8)
    found = rk.minimum_overturning_acceleration(block, pulse, 0.85, max_pga=5.0 * G)
    assert [one["peak_ground_acceleration"] for one in told["crossings"]] == found.acceleration.tolist()
    assert [[one["mode_below"], one["mode_above"]] for one in told["crossings"]] == found.modes.tolist()
    assert told["minimum_acceleration"] == found.minimum
    assert told["certain_acceleration"] == found.certain
    assert [tuple(pair) for pair in told["overturning_intervals"]] == list(found.overturning_intervals)
    # g b / h is 0.25 g
    assert told["uplift_acceleration"] == pytest.approx(0.25 * G, rel=1e-14, abs=0.0)


@pytest.mark.slow
def test_page_and_files(printed, tmp_path):
    """The sentence, a line for each crossing with the modes on both sides, and files with all digits."""
    files = ("--output", tmp_path / "a.png", "--output", tmp_path / "a.csv")
    out = printed(*SIZE, PULSE, "--restitution", "0.85", *files)
    with (tmp_path / "a.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [(row["mode_below"], row["mode_above"]) for row in rows] == [("-1", "1"), ("1", "-1"), ("-1", "0")]
    a, b, c = (f"{float(row['peak_ground_acceleration [m/s2]']) / G:.4g}" for row in rows)
    assert f"Overturns from {a} g to {b} g, above {c} g; scanned from 0.25 g" in out
    assert "rocks, does not overturn" in out
    assert "overturns without impact" in out
    assert (tmp_path / "a.png").stat().st_size > 5000


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (made([], []), "does not overturn"),
        (made([], [], starts=True), "overturns at every acceleration"),
        (made([[-1, 0]], [2.0]), "overturns above 2 g"),
        (made([[-1, 1], [1, -1]], [2.0, 3.0]), "overturns from 2 g to 3 g"),
        (
            made([[-1, 1], [1, -1], [-1, 0]], [2.0, 3.0, 4.0]),
            "overturns from 2 g to 3 g, above 4 g",
        ),
        (
            made([[0, -1], [-1, 0]], [2.0, 3.0], starts=True),
            "overturns from 1 g to 2 g, above 3 g",
        ),
        (
            made([[-1, 1], [1, -1]] * 5 + [[-1, 1]], [1.0 + 0.5 * k for k in range(1, 12)]),
            "overturns from 1.5 g to 2 g, from 2.5 g to 3 g, from 3.5 g to 4 g, 2 more intervals, above 6.5 g",
        ),
    ],
)  # fmt: skip
def test_sentences(found, words):
    """Every kind of answer is one sentence, with the range and the resolution of the search."""
    assert sentence(found) == f"{words}; scanned from 1 g to 9 g, resolution 0.4 %"


def test_range_with_units(run):
    """A range in g is the same as in m/s2; a body that survives it all is told so."""
    for low, high in (("0.3g", "0.34g"), (str(0.3 * G), str(0.34 * G))):
        _, out, _ = run(*SIZE, PULSE, "--restitution", "0.85", "--min-pga", low, "--max-pga", high, "--json")
        told = json.loads(out)
        assert (told["min_pga"], told["max_pga"]) == pytest.approx((0.3 * G, 0.34 * G), rel=1e-14, abs=0.0)
        assert told["sentence"].startswith("does not overturn; scanned from 0.3 g to 0.34 g")
        assert (told["minimum_acceleration"], told["crossings"]) == (None, [])
