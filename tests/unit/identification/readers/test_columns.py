"""Tables of measurements: columns and units are named, and what a sensor felt becomes the rotation."""

import math

import numpy as np
import pytest

from rocking.errors import InvalidValueError, MeasurementError
from rocking.identification.readers import read_measurement
from rocking.identification.readers.columns import clock_doubts, rotation_of_acceleration


def written(tmp_path, text, name="trial.csv"):
    path = tmp_path / name
    path.write_text(text, "utf-8")
    return path


@pytest.mark.parametrize(
    ("unit", "height", "field", "factor"),
    [
        ("rad", None, "rotation", 1.0),
        ("deg", None, "rotation", math.pi / 180.0),
        ("mrad", None, "rotation", 1e-3),
        ("\N{DEGREE SIGN}", None, "rotation", math.pi / 180.0),
        ("deg/s", None, "angular_velocity", math.pi / 180.0),
        ("\N{DEGREE SIGN}/s", None, "angular_velocity", math.pi / 180.0),
        ("dps", None, "angular_velocity", math.pi / 180.0),
    ],
)
def test_the_unit_says_which_sensor(tmp_path, unit, height, field, factor):
    path = written(tmp_path, f"time [ms],gyro y [{unit}],other [m]\n0,0.1,9\n10,0.2,9\n20,0.3,9\n30,0.2,9\n")
    series = read_measurement(path, column="gyro y", height=height)
    np.testing.assert_allclose(getattr(series, field), np.array([0.1, 0.2, 0.3, 0.2]) * factor, rtol=1e-15)
    np.testing.assert_allclose(series.time, [0.0, 0.01, 0.02, 0.03], rtol=1e-15)


def test_displacement_at_a_height(tmp_path):
    """A point 2 m up that is 1 m to the right: arcsin(1/2) is pi/6; semicolons and decimal commas."""
    path = written(tmp_path, "t [s];top [cm]\n0,0;100\n0,1;50\n0,2;0\n0,3;-50\n")
    assert read_measurement(path, height=2.0).rotation[0] == pytest.approx(math.pi / 6.0, rel=1e-15)


def test_workbook(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (["time [s]", "angle"], [0.0, 1.0], [0.1, 2.0], [0.2, 3.0], [0.3, 4.0]):
        book.active.append(row)
    book.save(tmp_path / "trial.xlsx")
    series = read_measurement(tmp_path / "trial.xlsx", unit="mrad")
    np.testing.assert_allclose(series.rotation, [1e-3, 2e-3, 3e-3, 4e-3], rtol=1e-15)


def test_list_of_times(tmp_path):
    path = written(tmp_path, "impact [ms]\n0\n1130\n2090\n2920\n", "times.txt")
    np.testing.assert_allclose(read_measurement(path, kind="times").times, [0.0, 1.13, 2.09, 2.92], rtol=1e-15)


def test_acceleration_is_inverted_with_gravity():
    """A smooth rotation goes in as h theta'' - g theta, analytically, and comes out; without gravity it would not."""
    time = np.linspace(0.0, 6.0, 6001)
    hump = np.exp(-(((time - 3.0) / 0.3) ** 2))
    rotation = 0.1 * hump
    second = rotation * ((2.0 * (time - 3.0) / 0.09) ** 2 - 2.0 / 0.09)
    found, _ = rotation_of_acceleration(time, 0.8 * second - 9.80665 * rotation, 0.8)
    np.testing.assert_allclose(found, rotation, rtol=0.0, atol=1e-9)
    wrong, _ = rotation_of_acceleration(time, 0.8 * second, 0.8)
    assert np.abs(wrong - rotation).max() > 0.01


def test_the_clock_is_doubted():
    """A gap of three samples and a scatter of a tenth of a step; an even clock has neither."""
    even = 0.01 * np.arange(100)
    assert clock_doubts(even) == ()
    (gap,) = clock_doubts(np.delete(even, [40, 41, 42]))
    assert "about 3 samples are missing in 1 gap" in gap
    (jitter,) = clock_doubts(even + 0.001 * np.random.default_rng(1).normal(size=100))
    assert "scatter by 1." in jitter


GOOD = "time [s],angle [rad]\n0,0.1\n0.1,0.2\n0.2,0.1\n0.3,0.0\n"


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (GOOD.replace(" [rad]", ""), {}, "states no unit"),
        (GOOD.replace(" [s]", ""), {}, "states no unit"),
        (GOOD, {"unit": "deg"}, "is in rad, but unit='deg'"),
        (GOOD, {"height": 1.0}, "height= of the sensor does not apply"),
        (GOOD.replace("rad", "mm"), {}, "height= of the sensor"),
        (GOOD.replace("rad", "furlong"), {}, "unknown unit"),
        (GOOD, {"kind": "displacement"}, "is a unit of rotation"),
        (GOOD, {"column": "tilt"}, "names 0 of"),
        (GOOD.replace("0.2,0.1", "0.05,0.1"), {}, "must increase"),
        (GOOD.replace("0.1,0.2", "0.1,nan"), {}, "line 3"),
        (GOOD.replace("0.1,0.2", "0.1"), {}, "line 3"),
        ("0,0.1\n0.1,0.2\n", {}, "names of the columns are missing"),
        ("", {}, "empty"),
    ],
)
def test_refusals(tmp_path, text, options, words):
    with pytest.raises(MeasurementError, match=words):
        read_measurement(written(tmp_path, text), **options)


def test_kinds_and_endings(tmp_path):
    path = written(tmp_path, GOOD)
    with pytest.raises(InvalidValueError, match="kind must be one of"):
        read_measurement(path, kind="smell")
    with pytest.raises(MeasurementError, match="does not have the extension of a sound"):
        read_measurement(path, kind="sound")
    with pytest.raises(MeasurementError, match="no such file"):
        read_measurement(tmp_path / "none.csv")
    for name, words in (("voice.m4a", "Save the sound as WAV or FLAC"), ("a.pdf", "the extension of the file must be")):
        with pytest.raises(MeasurementError, match=words):
            read_measurement(written(tmp_path, GOOD, name))
