"""Several restitutions of one campaign, compared as the Python calls compare them."""

import csv
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from rocking import conventions
from rocking.campaigns.jobs import Job, JobFolder, comparison, export, exports_of
from rocking.campaigns.jobs.exporting import comparison_table
from rocking.errors import InvalidValueError
from rocking.studies import map_sensitivity

X, Y = np.linspace(2.0, 8.0, 9), np.linspace(1.0, 9.0, 7)
MAP = """
[campaign]
name = "two models"
kind = "overturning-map"
[body]
units = "m"
width = 0.5
height = 2.0
[motions]
pulse = "sine:amplitude=3,period=0.6"
[restitution]
models = {models}
[map]
x = {{ axis = "frequency_ratio", from = 2, to = 8, count = 9 }}
y = {{ axis = "amplitude_ratio", from = 1, to = 9, count = 7 }}
"""


def finished(folder: Path, text: str) -> JobFolder:
    """Return a campaign that has been computed."""
    made = JobFolder.create(folder, Job.of_text(text))
    made.run()
    return made


@pytest.fixture
def campaign(tmp_path: Path) -> JobFolder:
    return finished(tmp_path / "campaign", MAP.format(models='["housner", "ked"]'))


def rows_of(path: Path) -> list[dict[str, str]]:
    """Return the rows of a CSV file."""
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def asked(models: list[str]):
    """Return the same comparison from Python."""
    body, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6)
    return map_sensitivity(body, pulse, ("frequency_ratio", X), ("amplitude_ratio", Y), models)


def test_the_same_comparison_as_from_python(campaign):
    """Flips and differences of the campaign are those of `map_sensitivity`; those of the reverse order are not."""
    found, wanted = comparison(campaign), asked(["housner", "ked"])
    assert found.summary() == wanted.summary()
    assert found.summary()[1]["flips"] > 0
    for name in ("verdict", "peak_ratio"):
        np.testing.assert_array_equal(found.differences(name).values, wanted.differences(name).values)
    assert comparison(campaign).summary() != asked(["ked", "housner"]).summary()


def test_tables(campaign, tmp_path):
    """The files have a row for each choice and each cell, and add up to the flips."""
    export(campaign, tmp_path / "flips.csv", "flips")
    export(campaign, tmp_path / "differences.csv", "differences")
    flips, cells = rows_of(tmp_path / "flips.csv"), rows_of(tmp_path / "differences.csv")
    assert [row["choice"] for row in flips] == ["housner", "ked"]
    assert len(cells) == X.size * Y.size
    assert {row["restitution"] for row in cells} == {"ked"}
    changed = [row for row in cells if float(row["verdict"]) in {-1.0, 1.0}]
    assert len(changed) == float(flips[1]["flips"])
    gained = [row for row in changed if float(row["verdict"]) == 1.0]
    assert len(gained) == float(flips[1]["gained"])
    row = gained[0]
    block = rk.Block(width=0.5, height=2.0)
    period = 2.0 * np.pi / (float(row["frequency_ratio"]) * block.frequency_parameter)
    amplitude = float(row["amplitude_ratio"]) * conventions.g * np.tan(block.slenderness_angle)
    outcomes = [rk.simulate(block, rk.pulses.sine(amplitude, period), r).outcome for r in ("housner", "ked")]
    assert outcomes == [rk.Outcome.ROCKED, rk.Outcome.OVERTURNED]


def test_other_kinds(tmp_path):
    """Histories and stripes with several restitutions are compared too; stripes tell how their curves move."""
    text = MAP.format(models='["housner", "ked"]')
    head, _, _ = text.partition("[map]")
    histories = head.replace("overturning-map", "histories") + "[histories]\nscales = [1, 2, 3]"
    plain = finished(tmp_path / "plain", histories)
    assert comparison(plain).summary()[1]["computed"] == 3
    stripes = head.replace("overturning-map", "stripes").replace(
        'pulse = "sine:amplitude=3,period=0.6"', 'synthetic = "pulse-like"\ncount = 30\nseed = 1'
    )
    levels = "[fragility]\nmeasure = 'pga'\nlevels = { from = 2, to = 12, count = 6 }\nstates = [0.5]"
    found = finished(tmp_path / "stripes", stripes + levels)
    sheet = comparison_table(comparison(found), "flips")
    assert "overturned: median ratio" in sheet.columns
    # KED loses less than Housner, so that its median is lower
    assert sheet.columns["overturned: median ratio"].values[1] < 1.0


def test_refusals(campaign, tmp_path):
    """One restitution has nothing to compare, and a format that does not fit is refused."""
    alone = finished(tmp_path / "alone", MAP.format(models='["ked"]'))
    assert exports_of(alone) == ["histories"]
    assert exports_of(campaign) == ["histories", "flips", "differences"]
    with pytest.raises(InvalidValueError, match="several restitutions"):
        comparison(alone)
    with pytest.raises(InvalidValueError, match="has no flips"):
        export(alone, tmp_path / "x.csv", "flips")
    with pytest.raises(InvalidValueError, match=r"flips can be written as \.nc, \.csv, .*got '\.pdf'"):
        export(campaign, tmp_path / "x.pdf", "flips")
