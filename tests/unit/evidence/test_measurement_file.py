"""Files of measurements: the published rows through them to all digits, what is refused, and a user's own store."""

import dataclasses
import re
import warnings

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError, MeasurementError, PlausibilityWarning, RockingError
from rocking.evidence import (
    Measurement,
    all_measurements,
    calibrate,
    calibrate_hierarchy,
    league,
    measurement_of,
    read_measurements,
    store,
    write_measurements,
)
from rocking.evidence.calibration import NAMES, calibrate_on
from rocking.identification import ImpactTimes, identify

pytestmark = pytest.mark.verifies(room="evidence")

ROW = {
    "source": "Doe 2026", "licence": "CC0", "interface": "Steel/oak", "method": "sound", "block": "A",
    "slenderness_ratio": 3.0, "r": 0.9, "uncertainty": 0.004,
}  # fmt: skip


def published(path):
    """The published rows as a file."""
    data = all_measurements()
    rows = [
        Measurement(
            source=data.source, licence="CC BY 4.0", method="as compiled", interface=data.interface[i],
            laboratory=data.laboratory[i] or None, group=data.group[i], block=data.labels[i],
            slenderness_ratio=float(data.slenderness[i]), r=float(data.coefficient[i]), low=float(data.low[i]),
            high=float(data.high[i]), mass=None if np.isnan(data.mass[i]) else float(data.mass[i]),
        )
        for i in range(len(data))
    ]  # fmt: skip
    return write_measurements(rows, path)


def leaves(value):
    """Yield what stands at the ends of a nested answer."""
    if isinstance(value, dict):
        value = [part for pair in value.items() for part in pair]
    if not isinstance(value, list | tuple):
        yield value
        return
    for part in value:
        yield from leaves(part)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the published rows, written and read", within="1e-6")
def test_published_rows_through_a_file(tmp_path):
    """The 39 rows through a file are the same to the last digit, and give the same league and calibrations."""
    data, own = all_measurements(), read_measurements(published(tmp_path / "all.csv"))
    for name in ("slenderness", "coefficient", "low", "high", "mass"):
        assert getattr(own, name).tolist() == pytest.approx(getattr(data, name).tolist(), rel=0.0, abs=0.0, nan_ok=True)
    assert (own.group, own.labels, own.interface) == (data.group, data.labels, data.interface)
    assert own.laboratory == data.laboratory
    for one, other in zip(league(measurements=own), league(), strict=True):
        # parameters are fitted to 1e-7: BIC moved by 1e-9 of itself on the least processor, a mean error by 2e-11
        assert list(leaves(one.answer().values)) == [
            pytest.approx(each, rel=1e-6, abs=1e-9) if isinstance(each, float) else each
            for each in leaves(other.answer().values)
        ]
    calibration = calibrate_on(own)
    for name in NAMES:
        assert calibration.summary[name] == pytest.approx(calibrate().summary[name], rel=1e-9)
    # a sample at the end of its cell may move into the next one
    assert np.isclose(calibration.samples, calibrate().samples, rtol=1e-9, atol=0.0).all(axis=1).mean() > 0.995
    one, other = calibrate_hierarchy(own).summary, calibrate_hierarchy().summary
    assert {name: pytest.approx(values, rel=1e-9) for name, values in one.items()} == other
    fewer = own.rows(range(38))
    assert league(measurements=fewer)[0].rmse != league()[0].rmse


TOML = """
source = "Doe 2026"
doi = "10.1234/abc"
licence = "CC BY 4.0"
laboratory = "Doe"
method = "video"
interface = "oak / Steel"

[[measurement]]
block = "A"
width = 0.1
height = 0.35
mass = 2
series = [0.9, 0.92, 0.91]

[[measurement]]
block = "B"
slenderness_ratio = 5
r = 0.95
uncertainty = 0.01
"""


@pytest.mark.verifies("closed form", "mean and standard error of a series", within="1e-12")
def test_what_a_file_says(tmp_path):
    """Keys at the top hold for all; a series counts as its mean with its standard error, of which bounds are made."""
    path = tmp_path / "oak.toml"
    path.write_text(TOML, "utf-8")
    found = read_measurements(path)
    assert found.slenderness == pytest.approx([3.5, 5.0])
    assert found.coefficient == pytest.approx([0.91, 0.95])
    assert (found.high - found.low) / np.sqrt(12.0) == pytest.approx([0.01 / np.sqrt(3.0), 0.01], rel=1e-12)
    assert found.interface == ("oak/steel",) * 2
    assert found.group == found.laboratory == ("Doe",) * 2
    assert found.source == "Doe 2026, doi:10.1234/abc"
    assert found.mass[0] == 2.0
    assert np.isnan(found.mass[1])
    table = tmp_path / "oak.csv"
    table.write_text("block,slenderness_ratio,series,source,licence,interface,method\nA,3.5,.9 .92 .91,D,CC0,x/y,m\n")
    assert read_measurements(path, table).coefficient == pytest.approx([0.91, 0.95, 0.91])


WRONG = {
    "energy": ({"r": 1.02}, "must be <= 1"),
    "per cent": ({"r": 91.0}, "<= 2"),
    "no uncertainty": ({"uncertainty": None}, "the uncertainty of r"),
    "both": ({"low": 0.89, "high": 0.91}, "the uncertainty of r"),
    "half an interval": ({"uncertainty": None, "low": 0.89}, "the uncertainty of r"),
    "outside": ({"uncertainty": None, "low": 0.91, "high": 0.92}, "must be in an interval"),
    "r and series": ({"series": [0.9, 0.91]}, "r or series"),
    "one trial": ({"r": None, "uncertainty": None, "series": [0.9]}, "at least 2"),
    "equal trials": ({"r": None, "uncertainty": None, "series": [0.9, 0.9]}, "low < high"),
    "no size": ({"slenderness_ratio": None}, "slenderness_ratio, or width and height"),
    "half a size": ({"width": 0.1}, "slenderness_ratio, or width and height"),
    "unknown": ({"interfase": "x"}, "did you mean interface"),
    "no source": ({"source": None}, "source"),
    "nan": ({"r": float("nan")}, "finite"),
    "doi": ({"doi": "https://doi.org/10.1/x"}, "doi"),
    "text": ({"mass": "heavy"}, "must be a number"),
    "far too slender": ({"slenderness_ratio": 1e300}, "h/b must be in 0.5 to 200, got 1e+300"),
    "width as height": ({"slenderness_ratio": 0.001}, "h/b must be in 0.5 to 200, got 0.001"),
    "sizes of two units": ({"slenderness_ratio": None, "width": 0.1, "height": 400.0}, "got 4000"),
    "unknown r": ({"uncertainty": 5.0}, "must be 1e-06 to 0.29, got 5"),
    "too well known": ({"uncertainty": 1e-12}, "must be 1e-06 to 0.29, got 1e-12"),
    "interval of nothing": ({"uncertainty": None, "low": 0.0, "high": 1.5}, "to 0.29, got 0.433"),
}  # fmt: skip


@pytest.mark.verifies("damage")
@pytest.mark.parametrize("how", WRONG)
def test_rows_that_are_refused(tmp_path, how):
    """A row that is not whole is refused with file, line and cause; the row itself is accepted."""
    change, words = WRONG[how]
    path = tmp_path / "rows.csv"
    row = {**ROW, **change}

    def text(row):
        values = [" ".join(map(str, v)) if isinstance(v, list) else "" if v is None else str(v) for v in row.values()]
        return f"{','.join(row)}\n{','.join(values)}\n"

    path.write_text(text(ROW), "utf-8")
    assert len(read_measurements(path)) == 1
    path.write_text(text(row), "utf-8")
    with pytest.raises(MeasurementError, match=r"rows\.csv, line 2: ") as refusal:
        read_measurements(path)
    assert words in str(refusal.value)


FILES = {
    "nothing.toml": ("", "no tables"),
    "list.toml": ("measurement = [1]", "no tables"),
    "broken.toml": ("[[measurement", "is not readable TOML"),
    "empty.csv": ("source,licence\n", "no measurement"),
    "short.csv": ("source,licence\na\n", "number of fields"),
    "long.csv": ("source,licence\na,b,c\n", "number of fields"),
    "twice.csv": ("source,r,r\na,.9,.8\n", "column 'r' appears twice"),
    "quotes.csv": ('source,licence\n"a"b,c\n', "is not a CSV file"),
    "rows.txt": ("", ".toml or .csv"),
}


DOUBTS = {
    "a tower": ({"slenderness_ratio": None, "width": 100.0, "height": 400.0}, "200 m above the ground"),
    "a grain": ({"slenderness_ratio": None, "width": 1e-3, "height": 4e-3}, "0.002 m above the ground"),
    "b/h": ({"slenderness_ratio": 0.6}, "h/b = 0.6 is outside 1 to 30"),
    "hardly known": ({"uncertainty": 0.2}, "r of 0.2 is outside"),
    "known to the last digit": ({"uncertainty": 1e-5}, "r of 1e-05 is outside"),
    "a loss": ({"r": 0.1}, "0.1 is below 0.25"),
}


@pytest.mark.verifies("damage")
@pytest.mark.parametrize("how", DOUBTS)
def test_rows_that_are_doubted(tmp_path, how):
    """What can hardly be meant is read with a word that names file and row; a row of a laboratory has none."""
    change, words = DOUBTS[how]
    path = write_measurements([Measurement(**ROW)], tmp_path / "rows.csv")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_measurements(path)
    write_measurements([Measurement(**{**ROW, **change})], path)
    with pytest.warns(PlausibilityWarning, match=r"check the input: rows\.csv, line 2: .*") as told:
        assert len(read_measurements(path)) == 1
    assert words in str(told[0].message)
    write_measurements([Measurement(**ROW)] * 2, path)
    with pytest.warns(PlausibilityWarning, match="line 3: duplicate of line 2"):
        read_measurements(path)


@pytest.mark.verifies("damage")
@pytest.mark.parametrize("name", FILES)
def test_files_that_are_refused(tmp_path, name):
    """Files that hold no measurements are refused by name and cause."""
    text, words = FILES[name]
    (tmp_path / name).write_text(text, "utf-8")
    with pytest.raises(MeasurementError, match=f"{name}.*{words}"):
        read_measurements(tmp_path / name)
    (tmp_path / name).write_bytes(b"\xff\xfe\xfa")
    with pytest.raises(MeasurementError, match="UTF-8"):
        read_measurements(tmp_path / name)
    with pytest.raises(MeasurementError, match="cannot be read"):
        read_measurements(tmp_path / f"no_{name}")


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_what_was_identified_is_a_measurement(tmp_path):
    """The mean of an identification, with its interval as standard deviation, goes into a file and comes back."""
    times = [0.0, 1.2158, 2.2432, 3.1403, 3.9387, 4.6583, 5.3126, 5.9119, 6.4634]
    block = rk.Block(width=1.0, height=4.0, density=700.0)
    found = identify(ImpactTimes(times, sigma=1e-3), block, tilt=0.0)
    known = {name: ROW[name] for name in ("source", "licence", "interface", "method", "block")}
    row = measurement_of(found, block, **known)
    data = read_measurements(write_measurements([row], tmp_path / "mine.csv"))
    assert data.coefficient[0] == found.mean.value
    deviation = (data.high[0] - data.low[0]) / np.sqrt(12.0)
    assert deviation == pytest.approx((found.mean.high - found.mean.low) / 3.919928, rel=1e-6)
    assert (data.slenderness[0], data.mass[0]) == (4.0, block.mass)
    with pytest.raises(InvalidValueError, match="licence is missing"):
        measurement_of(found, block, **{name: word for name, word in known.items() if name != "licence"})
    with pytest.raises(InvalidValueError, match="must be a Block"):
        measurement_of(found, rk.MassPoints([(0, 2)], [1.0], (-1, 1)), **known)
    with pytest.raises(InvalidValueError, match="refused"):
        measurement_of(dataclasses.replace(found, refused=("it is a bell",)), block, **known)
    with pytest.raises(InvalidValueError, match="one or more"):
        write_measurements([], tmp_path / "none.csv")


@pytest.fixture
def own(monkeypatch, tmp_path):
    monkeypatch.setattr(store, "data_folder", lambda: tmp_path / "data")
    path = tmp_path / "oak.toml"
    path.write_text(TOML, "utf-8")
    return path


def test_the_store(own):
    """A file is copied once; what is selected is the published rows and it; nothing is counted twice."""
    target, data, new = store.add(own)
    assert (len(data), new, target.parent.parent.name) == (2, True, "data")
    assert store.add(own) == (target, store.add(own)[1], False) or store.add(own)[2] is False
    assert store.own_files() == [target]
    assert len(store.selected()) == 41
    assert len(store.selected(["own"])) == 2
    assert len(store.selected(["S", str(own)])) == 11
    with pytest.raises(InvalidValueError, match="in both"):
        store.selected(["own", str(own)])
    with pytest.raises(InvalidValueError, match="unknown measurements 'T'"):
        store.selected(["T"])
    with pytest.raises(InvalidValueError, match="at least 5 blocks are required, got 2"):
        league(measurements=store.selected(["own"]))


@pytest.mark.verifies("damage")
def test_what_spoils_the_store_is_named(own):
    """A row that is there in another file is no news, however the file is written; a file that spoils all is named."""
    target = store.add(own)[0]
    again = own.with_name("again.toml")
    again.write_text(TOML.replace("width = 0.1\nheight = 0.35", "slenderness_ratio = 3.5"), "utf-8")
    with pytest.raises(InvalidValueError, match=f"A, 3.5, 0.91 .*is in both {re.escape(str(target))} and"):
        store.add(again)
    assert store.own_files() == [target]
    (twin := target.with_name("twin.toml")).write_bytes(again.read_bytes())  # from before this was looked at
    with pytest.raises(InvalidValueError, match=f"{re.escape(str(twin))}; .*delete"):
        store.selected()
    twin.write_text(TOML.replace("ratio = 5", "ratio = 1e300"), "utf-8")
    for word in ((), ("own",)):
        with pytest.raises(MeasurementError, match=rf"{re.escape(str(twin))}, measurement 2: h/b .*delete it"):
            store.selected(word)
    twin.unlink()
    assert len(store.selected()) == 41


def test_an_empty_store(monkeypatch, tmp_path):
    """Without a store the published rows alone are selected; own ones are asked for; a file in its place is told."""
    monkeypatch.setattr(store, "data_folder", lambda: tmp_path / "data")
    assert store.selected() is all_measurements()
    with pytest.raises(InvalidValueError, match="rocking measurements add"):
        store.selected(["own"])
    (tmp_path / "data").write_text("a file")
    (tmp_path / "oak.toml").write_text(TOML, "utf-8")
    with pytest.raises(RockingError, match="cannot write"):
        store.add(tmp_path / "oak.toml")
