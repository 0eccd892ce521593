"""Blocks of arrays, dimensions of studies, and motions and bodies as a job names them."""

import hashlib
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rocking as rk
from rocking.campaigns.jobs import Job, forecast
from rocking.campaigns.jobs.study import TYPES, Study
from rocking.dynamics.plane.fast_engine import RESULTS
from rocking.errors import InvalidValueError
from rocking.quantities import QUANTITIES
from rocking.studies import MotionList, Product, SyntheticSet
from rocking.tables.table import blocks


@given(st.lists(st.integers(1, 5), min_size=1, max_size=4), st.data())
def test_blocks_fill_an_array_once(shape, data):
    """Whatever the cut, blocks put every entry where row-major order has it, none twice, and no more than needed."""
    count = int(np.prod(shape))
    cuts = sorted({0, count, *data.draw(st.lists(st.integers(0, count), max_size=4))})
    whole, seen = np.full(shape, -1), np.zeros(shape, dtype=int)
    for first, last in pairwise(cuts):
        found = list(blocks(first, last, tuple(shape)))
        assert len(found) <= 2 * len(shape)
        for place, part in found:
            whole[place] = np.arange(first, last)[part].reshape(whole[place].shape)
            seen[place] += 1
    assert np.array_equal(whole.ravel(), np.arange(count))
    assert (seen == 1).all()


def test_variables_have_units():
    """Every result of the engine, and what follows from it, has a unit and words."""
    assert set(RESULTS) | {"overturned", "lost_contact", "mode", "peak_ratio"} == set(TYPES)
    assert all(QUANTITIES[name].unit in {"1", "rad", "rad/s", "s"} and QUANTITIES[name].meaning for name in TYPES)


def test_dimensions_must_fit():
    """Dimensions of another number of histories are refused."""
    sides = {f"{n}_{side}": np.full((1, 1), 0.3) for n in ("alpha", "p", "r", "q") for side in ("right", "left")}
    histories = Product(MotionList(rk.pulses.sine(1.0, 1.0)), sides, np.ones(3))
    with pytest.raises(InvalidValueError, match="do not fit 3 histories"):
        Study(histories, {"a": 2}, {})


def test_ranges(text):
    """A list, one number, a linear and a logarithmic range are the numbers that they say."""
    scales = {
        "[1.5, 2]": [1.5, 2.0],
        "3": [3.0],
        "{ from = 1, to = 3, count = 3 }": [1.0, 2.0, 3.0],
        '{ from = 1, to = 100, count = 3, spacing = "log" }': [1.0, 10.0, 100.0],
        "{ values = [7] }": [7.0],
    }
    for words, wanted in scales.items():
        job = Job.of_text(text("histories").replace("[2.5, 5.0, 8.0, 11.0]", words))
        assert job.study.coordinates["scale"].values.tolist() == pytest.approx(wanted, rel=1e-15)


def test_records_by_pattern_and_name(text, records):
    """Patterns find files in the order of the alphabet; each is hashed, scaled, and read in its unit."""
    words = '[motions]\nrecords = ["*.txt"]\nunits = "cm/s2"\nscale = 2\n#'
    job = Job.of_text(text("histories").replace("[motions]\n", words), "job", records)
    assert [item["path"] for item in job.inputs] == ["one.txt", "two.txt"]
    data = (records / "one.txt").read_bytes()
    assert job.inputs[0]["sha256"] == hashlib.sha256(data).hexdigest()
    assert job.inputs[0]["bytes"] == len(data)
    # the file says 4 sin at 0.01 s steps through the quarter period 0.125 s: largest sample 4 sin(2 pi 0.12 / 0.5)
    assert job.problem.motions[0].peak == pytest.approx(0.08 * np.sin(2 * np.pi * 0.12 / 0.5), rel=1e-6)


def test_records_elsewhere(text, records, tmp_path):
    """Files may be named by their whole path, also by pattern."""
    words = f'[motions]\nrecords = "{records.as_posix()}/t*.txt"\nunits = "m/s2"\n#'
    job = Job.of_text(text("histories").replace("[motions]\n", words), "job", tmp_path / "elsewhere")
    assert [item["path"] for item in job.inputs] == [(records / "two.txt").as_posix()]
    assert forecast(job).memory > 150e6


def test_families(text):
    """One family is a set that is made when needed; with others it is a list of the same motions."""
    alone = Job.of_text(text("stripes")).problem.motions
    assert isinstance(alone, SyntheticSet)
    more = text("stripes").replace(
        "[motions]", '[[motions]]\nsynthetic = "firm-ground"\ncount = 2\npga = 2.0\n[[motions]]'
    )
    both = Job.of_text(more).problem.motions
    assert len(both) == 14
    assert both[0].peak == pytest.approx(2.0)
    assert np.array_equal(both[2].acceleration, alone[0].acceleration)


BODY = 'units = "cm"\n[block]\nwidth = 50\nheight = 200\n'
OUTLINE = '{"type": "Polygon", "coordinates": [[[0, 0], [0.5, 0], [0.5, 2], [0, 2], [0, 0]]]}'


def test_bodies_in_every_way(text, tmp_path):
    """A size, a table, a body file and an outline beside it are the same block; files are among the inputs."""
    (tmp_path / "b.toml").write_text(BODY, encoding="utf-8")
    (tmp_path / "o.geojson").write_text(OUTLINE, encoding="utf-8")
    short = '[body]\nunits = "m"\nwidth = 0.5\nheight = 2.0\n'
    ways = {
        short: [],
        '[body]\nunits = "m"\n[body.block]\nwidth = 0.5\nheight = 2.0\n': [],
        '[body]\nfile = "b.toml"\n': ["b.toml"],
        '[body]\nunits = "m"\n[body.section]\n[[body.section.region]]\ngeojson = "o.geojson"\n': ["o.geojson"],
    }
    for words, files in ways.items():
        job = Job.of_text(text("overturning-map").replace(short, words), "job", tmp_path)
        assert [item["path"] for item in job.inputs] == files
        side = job.problem.bodies[0].side("right", 9.80665)
        assert side.slenderness_angle == pytest.approx(np.arctan(0.25), rel=1e-12)


def test_restitution_by_side(text):
    """Coefficients by foot arrive at their sides."""
    sides = text("cloud") + "[restitution]\nleft = 0.8\nright = 0.9\n"
    rows = Job.of_text(sides).study.histories.rows(0, 1).values
    assert (rows["r_left"][0], rows["r_right"][0]) == (0.8, 0.9)


def test_seed_of_the_campaign(text):
    """Draws without a seed of their own take that of the campaign."""
    drawn = text("histories").replace('models = ["housner", "ked"]', "distribution = { mean = 0.9, deviation = 0.05 }")
    for seed in (0, 7):
        job = Job.of_text(drawn.replace("[campaign]", f"[campaign]\nseed = {seed}"))
        assert job.study.histories.law.seed == seed
        assert job.provenance["seeds"] == {"campaign": seed, "motions": [], "restitution": [seed]}


def test_provenance_says_everything(text, records):
    """Version, job, inputs, models, tolerances, seeds and platform are there, and neither time nor folder."""
    words = '[motions]\nrecords = "one.txt"\nunits = "m/s2"\n#'
    job = Job.of_text(text("histories").replace("[motions]\n", words), "job", records)
    told = job.provenance
    assert told["software"] == f"rocking {rk.__version__}"
    assert told["inputs"] == job.inputs
    assert [item["label"] for item in told["restitution"]] == ["housner", "ked"]
    assert "10.3390" in told["restitution"][1]["reference"]
    assert told["settings"]["tolerance"] == 1e-15
    assert told["histories_key"] == job.study.histories.key()
    assert told["platform"]["numpy"] == np.__version__
    assert told["job"] == job.text
    assert str(records) not in str(told)
