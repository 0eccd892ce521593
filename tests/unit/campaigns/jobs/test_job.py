"""What a job says becomes bodies, motions and dimensions; what is wrong with it is one sentence."""

import hashlib
import re
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rocking as rk
from rocking.campaigns.jobs import Job, forecast
from rocking.dynamics.plane.fast_engine import RESULTS
from rocking.errors import InvalidValueError, RockingError
from rocking.quantities import QUANTITIES
from rocking.studies import MotionList, Product, SyntheticSet
from rocking.studies.study_plan import TYPES, Study
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
        assert job.study.coordinates["scale"].values.tolist() == pytest.approx(wanted, rel=1e-15, abs=0.0)


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
        assert side.slenderness_angle == pytest.approx(np.arctan(0.25), rel=1e-12, abs=0.0)


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


REFUSED = {
    "unknown table": ("[campain]\n", "[campaign]\n", r"unknown key 'campain'; did you mean campaign\?"),
    "unknown key": ("hight = 2.0", "height = 2.0", r"body: .*unknown key 'hight'; did you mean height\?"),
    "unknown key of motions": ("pulze =", "pulse =", r"motions\[0\]: unknown key 'pulze'; did you mean pulse\?"),
    "unknown kind": ('"overturning-maps"', '"overturning-map"',
        r"campaign\.kind must be one of .*'overturning-maps'; did"),
    "missing name": ("", 'name = "a small overturning-map"\n', r"campaign\.name is missing"),
    "empty name": ('name = ""', 'name = "a small overturning-map"', r"campaign\.name must not be empty, got ''"),
    "units left out": ("", 'units = "m"\n', r"body: .*units is missing"),
    "unknown unit": ('units = "yards"', 'units = "m"', r"body: .*units must be one of .*got 'yards'"),
    "negative width": ("width = -0.5", "width = 0.5", r"body: block\.width must be a number > 0 m, got -0\.5"),
    "width as words": ('width = "wide"', "width = 0.5", r"body: .*width must be a number \[m\], got 'wide'"),
    "infinite width": ("width = inf", "width = 0.5", r"body: .*width must be a finite number"),
    "date as width": ("width = 2026-01-01", "width = 0.5", r"body: "),
    "unknown pulse": ("cosin:", "sine:", r"motions\[0\]: .*cosin"),
    "pulse parameter": ("amplitude=3,frequency=1", "amplitude=3,period=0.6", r"motions\[0\]: .*frequency"),
    "pulse number": ("amplitude=big", "amplitude=3", r"motions\[0\]: .*amplitude.*'big'"),
    "two sources": ('pulse = "sine:amplitude=3,period=0.6"\nsynthetic = "x"', 'pulse = "sine:amplitude=3,period=0.6"',
                    r"motions\[0\]: Use exactly one of records, pulse, synthetic, got pulse and synthetic"),
    "key of another source": ('seed = 3\npulse =', 'pulse =',
        r"motions\[0\]: seed is not allowed with pulse. Allowed: scale"),
    "no file": ('records = "a.AT2"', 'pulse = "sine:amplitude=3,period=0.6"', r"motions\[0\]: a\.AT2: no such file"),
    "no match": ('records = "*.AT2"', 'pulse = "sine:amplitude=3,period=0.6"',
        r"motions\[0\]: No file in .* matches '\*\.AT2'"),
    "no family": ('synthetic = "hard-ground"\ncount = 3', 'pulse = "sine:amplitude=3,period=0.6"',
                  r"motions\[0\]: family must be one of firm-ground, .*got 'hard-ground'"),
    "no count": ('synthetic = "firm-ground"', 'pulse = "sine:amplitude=3,period=0.6"',
        r"motions\[0\]: count is missing"),
    "several motions": ('pulse = ["sine:amplitude=3,period=0.6", "sine:amplitude=4,period=0.6"]',
                        'pulse = "sine:amplitude=3,period=0.6"', "A map accepts one motion, got 2"),
    "zero scale": ('scale = 0\npulse =', 'pulse =', r"motions\[0\]: scale must not be 0"),
    "unknown axis": ('axis = "frequency"', 'axis = "frequency_ratio"', r"map\.x: Unknown axis 'frequency'\. Axes are"),
    "same axis": ('axis = "amplitude_ratio"', 'axis = "frequency_ratio"', r"map: x and y must set different"),
    "negative axis": ("from = -1, to = 9", "from = 1, to = 9", r"map\.y: amplitude_ratio must be in .*got -1"),
    "falling axis": ("from = 9, to = 1", "from = 1, to = 9", r"map\.y: amplitude_ratio must increase"),
    "no end": ("from = 1, count = 7", "from = 1, to = 9, count = 7", r"map\.y: Use values = .*Got from, count"),
    "count of one": ("to = 9, count = 1", "to = 9, count = 7", r"map\.y: count must be >= 2 if from and to differ"),
    "count of none": ("to = 9, count = 0", "to = 9, count = 7", r"map\.y\.count must be a number >= 1, got 0"),
    "half a count": ("to = 9, count = 2.5", "to = 9, count = 7", r"map\.y\.count must be a whole number, got 2\.5"),
    "spacing": ('count = 7, spacing = "logs"', "count = 7", r"map\.y\.spacing must be one of .*did you mean log\?"),
    "log of zero": ('from = 0, to = 9, count = 7, spacing = "log"', "from = 1, to = 9, count = 7",
        r"map\.y: from and to .*> 0"),
    "values and range": ("values = [1, 2], from = 1", "from = 1", r"map\.[xy]: Use values or "),
    "wrong table": ("[spectrum]\nslenderness_angles = 0.1\nperiods = 1\n[map]", "[map]",
        r'does not accept \[spectrum\]'),
    "missing table": ("[other]", "[map]", r"unknown key 'other'"),
    "chunk of none": ("chunk = 0\n[body]", "[body]", r"campaign\.chunk must be a number >= 1, got 0"),
    "chunk too large": ("chunk = 99999999\n[body]", "[body]", r"campaign\.chunk must be a number <= .*got 99999999"),
    "negative seed": ("seed = -1\n[body]", "[body]", r"campaign\.seed must be a number >= 0, got -1"),
    "seed as words": ('seed = "1"\n[body]', "[body]", r"campaign\.seed must be a whole number, got '1'"),
    "unknown model": ('[restitution]\nmodel = "kedd"\n[map]', "[map]",
        r"restitution: unknown restitution model 'kedd'"),
    "model twice": ('[restitution]\nmodels = ["ked", "ked"]\n[map]', "[map]", "restitution: ked appears twice"),
    "two restitutions": ('[restitution]\nmodel = "ked"\nvalue = 0.9\n[map]', "[map]",
        "restitution: Use exactly one of .*model and value"),
    "a percentage": ("[restitution]\nvalue = 90.0\n[map]", "[map]",
        r"restitution\.value must be a number <= 10, got 90"),
    "energy from nothing": ("[restitution]\nvalue = 1.5\n[map]", "[map]", r"map: .*the impact would create energy"),
    "one foot": ("[restitution]\nleft = 0.9\n[map]", "[map]", "restitution: Use left and right together"),
    "deviation": ("[restitution.distribution]\nmean = 0.9\ndeviation = 0\n[map]", "[map]",
                  r"restitution\.distribution\.deviation must be a number > 0, got 0"),
    "gravity": ("[settings]\ngravity = 0\n[map]", "[map]", r"settings\.gravity must be a number > 0, got 0"),
    "order": ("[settings]\norder = 5\n[map]", "[map]", r"settings: order must be one of \(4, 6, 8\), got 5"),
    "engine": ('[settings]\nengine = "quick"\n[map]', "[map]", r"settings\.engine must be one of 'auto'.*got 'quick'"),
    "linear as a number": ("[settings]\nlinear = 1\n[map]", "[map]", r"settings\.linear must be true or false, got 1"),
    "no body": ("", '[body]\nunits = "m"\nwidth = 0.5\nheight = 2.0\n', r"\[body\] is missing"),
    "two bodies": ('[[body]]\nunits = "m"\nwidth = 1\nheight = 2\n[[body]]', "[body]",
        r"accepts one \[\[body\]\], got 2"),
    "body file and size": ('file = "b.toml"\nunits = "m"', 'units = "m"',
        r"body: Key 'height' is not allowed with file; allowed: units"),
    "no body file": ('file = "b.toml"', 'units = "m"\nwidth = 0.5\nheight = 2.0', r"body: b\.toml: no such file"),
    "not TOML": ("[campaign", "[campaign]", "Invalid TOML: .*line 1"),
    "twice in TOML": ("width = 1\nwidth = 2", "width = 0.5", "Invalid TOML: .*"),
}  # fmt: skip


def refusal(words, folder):
    """What is said of a job, in one line that begins with its name."""
    with pytest.raises(RockingError) as found:
        Job.of_text(words, "my job.toml", folder)
    said = str(found.value)
    assert said.startswith("my job.toml: ")
    assert "\n" not in said
    assert len(said) < 600
    return said


ELSEWHERE = {
    "levels": ("stripes", "levels = { from = 2, to = 10, count = 5 }", "", r"fragility\.levels is missing"),
    "falling": ("stripes", "from = 2, to = 10", "from = 10, to = 2",
        r"fragility: levels must increase \[m/s2\] from value to value; reverse the order"),
    "measure": ("stripes", '"pga"', '"pgaa"', r"fragility: im must be one of pga, .*got 'pgaa'"),
    "ratio": ("stripes", '"pga"', '"pgv/pga"', r"fragility: im must grow with the scale factor"),
    "states": ("stripes", "limit_states = [0.3]", "limit_states = [0.3, -1]",
        r"fragility\.limit_states\[1\] must be a number > 0, got -1"),
    "factor": ("stripes", "limit_states", "scale = 2\nlimit_states",
        r'fragility\.scale is allowed with kind = "cloud" only'),
    "tolerance": ("stripes", "limit_states", "tolerance = 0.1\nlimit_states",
        r'fragility\.tolerance is allowed with kind = "incremental"'),
    "cloud": ("cloud", "scale = 2.0", "levels = [1]", r"fragility\.levels is not allowed: a cloud"),
    "drawn": ("incremental", "value = 0.9", "[restitution.distribution]\nmean = 0.9\ndeviation = 0.1",
        r"fragility: restitution"),
    "search": ("incremental", "[fragility]", "[settings]\ntolerance = 1e-12\n[fragility]",
        r"settings\.tolerance is not allowed"),
    "restitution twice": ("overturning-map", '[map]\nx = { axis = "frequency_ratio", from = 1, to = 7, count = 9 }',
        '[restitution]\nmodels = ["housner", "ked"]\n[map]\nx = { axis = "restitution", values = [0.8, 0.9] }',
        r"map: restitution cannot be an axis in a comparison of restitutions"),
    "spectrum": ("rocking-spectrum", "[spectrum]", '[body]\nunits = "m"\n[spectrum]', r"\[body\] is not allowed"),
    "angle": ("rocking-spectrum", "[0.15, 0.3]", "[0.15, 2.0]", r"spectrum: .*2"),
    "angles": ("rocking-spectrum", "[0.15, 0.3]", "[0.3, 0.15]", r"spectrum\.slenderness_angles must be strictly"),
    "scale": ("histories", "[2.5, 5.0, 8.0, 11.0]", "[2.5, 1e9]",
        r"histories\.scales must be from -1e6 to 1e6, got 1e\+09 at index 1"),
    "nan": ("histories", "[2.5, 5.0, 8.0, 11.0]", "[2.5, nan]",
        r"histories\.scales\.values\[1\] must be a finite number"),
    "second body": ("histories", "width = 0.3", "width = 0", r"body\[1\]: .*width must be a number > 0"),
}  # fmt: skip


CASES = {name: ("overturning-map", old, new, wanted) for name, (new, old, wanted) in REFUSED.items()} | ELSEWHERE


@pytest.mark.parametrize("case", CASES)
def test_refusal(case, text, tmp_path):
    """A mistake is refused in one sentence that shows where and what; without it the job is taken."""
    kind, old, new, wanted = CASES[case]
    whole = text(kind)
    assert old in whole
    said = refusal(whole.replace(old, new, 1), tmp_path)
    assert re.search(wanted, said), said


def test_records_and_pulses_do_not_mix(text, records):
    """A study takes records or pulses."""
    more = '[[motions]]\npulse = "sine:amplitude=1,period=1"\n[[motions]]\nrecords = "one.txt"\nunits = "m/s2"\n'
    whole = text("histories").replace(
        '[motions]\npulse = ["sine:amplitude=1,period=0.5", "sine:amplitude=1,period=0.7"', "#"
    )
    said = refusal(re.sub(r"#.*\n", more, whole), records)
    assert "all records or all pulses" in said


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ('records = "one.txt"\n', "units"),
        ('records = ["one.txt", "one.txt"]\nunits = "m/s2"\n', "one.txt appears twice"),
        ('records = "broken.txt"\nunits = "m/s2"\n', "broken.txt"),
        ('records = "one.txt"\nunits = "furlong"\n', "furlong"),
    ],
)
def test_records_that_are_refused(text, records, words, wanted):
    """A record without a unit is not guessed; one that cannot be read is named."""
    (records / "broken.txt").write_text("0.0 zero\n", encoding="utf-8")
    whole = re.sub(r"\[motions\]\n.*\n", f"[motions]\n{words}", text("histories"))
    said = refusal(whole, records)
    assert "motions[0]" in said
    assert wanted in said


@pytest.mark.parametrize(
    ("data", "wanted"),
    [(None, "no such file"), (b"\xff\xfe\x00", "is not UTF-8 text"), (b"", "campaign is missing")],
)
def test_files_that_are_no_jobs(tmp_path, data, wanted):
    """No file, no text, nothing in it."""
    path = tmp_path / "job.toml"
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(InvalidValueError, match=wanted):
        Job.read(path)


def test_folder_is_no_job(tmp_path):
    """A folder in place of the file: the sentence names the commands for folders."""
    with pytest.raises(InvalidValueError, match="is a folder"):
        Job.read(tmp_path)
