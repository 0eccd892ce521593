"""`rocking simulate`: the same numbers as Python, closed forms, every option, and refusals in one sentence."""

import csv
import json
import math

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from rocking.cli import main
from rocking.cli.simulate_output import Answer
from rocking.cli.simulate_question import Question
from rocking.dynamics.export import provenance
from rocking.evidence.coefficient_table import default_models

G = 9.80665
BLOCK = rk.Block(width=0.5, height=2.0)
SIZE = ("--width", "0.5", "--height", "2")
PULSE = "sine:amplitude=3.2,period=0.8"
ALPHA = math.atan(0.25)
BODY = 'units = "m"\n[block]\nwidth = 0.5\nheight = 2.0\n'
COLUMNS = "0.0 0.0 0.0 0.1\n0.1 3.0 -4.0 0.3\n0.4 3.0 -4.0 0.3\n0.5 0.0 0.0 -0.2\n"


def run(capsys, *words):
    """Exit code, standard output and standard error of `rocking simulate WORDS`."""
    with pytest.raises(SystemExit) as stop:
        main(["simulate", *(str(word) for word in words)])
    printed = capsys.readouterr()
    return stop.value.code or 0, printed.out, printed.err


def answered(capsys, *words):
    """The JSON of `rocking simulate WORDS`."""
    code, out, err = run(capsys, *words, "--json")
    assert (code, err) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def same(answer, response):
    """Whether a JSON holds a response to the last digit."""
    impacts = [tuple(row.values()) for row in answer["impacts"]]
    return (
        answer["peak_rotation_rad"] == response.peak_rotation
        and impacts == response.impacts.tolist()
        and answer["uplifts_s"] == response.uplifts.tolist()
        and answer["outcome"] == response.outcome.name.lower()
        and answer["summary"] == response.summary
        and answer["energy_closure"] == response.energy.closure
        and answer["error_estimate_rad"] == response.error_estimate
        and answer["engine"] == response.engine
        and answer["restitution"] == response.rocker.label
    )


@pytest.fixture
def body(tmp_path):
    """Body file of the block."""
    path = tmp_path / "block.toml"
    path.write_text(BODY, encoding="utf-8")
    return path


@pytest.fixture
def record(tmp_path):
    """Four samples of 0.1 s in three columns, in m/s2."""
    rows = np.column_stack([np.arange(60) * 0.02, 3.0 * np.sin(np.arange(60) * 0.2), np.linspace(0, -5, 60)])
    path = tmp_path / "record.txt"
    path.write_text("\n".join(" ".join(f"{x:.6f}" for x in row) for row in rows) + "\n", encoding="utf-8")
    return path
