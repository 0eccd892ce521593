"""`rocking record show`: numbers against closed forms, files against what was typed, and refusals in one sentence."""

import csv
import math

import pytest

from rocking.cli.application import application
from rocking.errors import InvalidValueError, RecordError, UnknownModelError

COMMAND = "record show"

G = 9.80665
# 0, 1, 0 m/s2 at 0.5 s: a triangle, whose integrals are 0.5 m/s, 0.25 m and 1/3 m2/s3
TRIANGLE = "0.0 0.0\n0.5 1.0\n1.0 0.0\n"
FOUR = "0.0 0.0 0.0 0.1\n0.5 1.0 -2.0 0.3\n1.0 0.0 0.0 -0.2\n"
PEER = "A DATABASE\nSOMEWHERE 01/17/94, CELLAR, 360\nACCELERATION IN UNITS OF G\nNPTS= 3, DT= .5 SEC\n 0.0 0.1 -0.2\n"


@pytest.fixture
def triangle(file):
    """File of the triangle."""
    return file(TRIANGLE, "triangle.txt")


def test_record_by_closed_form(answered, triangle):
    """The triangle: PGA 1, PGV 1/2, PGD 1/4, CAV 1/2, Arias pi/(4 g) by its samples; and what the file is."""
    answer = answered(triangle, "--units", "m/s2")
    found = answer["intensity"]
    expected = {"pga": 1.0, "pgv": 0.5, "pgd": 0.25, "cav": 0.5, "arias": math.pi / (4.0 * G)}
    assert {key: found[key] for key in expected} == pytest.approx(expected, rel=1e-12, abs=0.0)
    assert (answer["kind"], answer["format"], answer["file_unit"]) == ("record", "columns", "m/s2")
    assert (answer["samples"], answer["time_step"], answer["duration"]) == (3, 0.5, 1.0)
    assert "SHA-256" in answer["provenance"][0]
    # negative control: the same file in g is not the same motion
    assert answered(triangle, "--units", "g")["intensity"]["pga"] == pytest.approx(G)


def test_pulse_by_closed_form(answered):
    """One sine of 3 m/s2 and 0.8 s: PGV 2a/w, PGD aT/w to rounding; CAV 4a/w, Arias pi a2 T/(4 g) to 1e-5."""
    answer = answered("sine:amplitude=3,period=0.8")
    found, w = answer["intensity"], 2.0 * math.pi / 0.8
    assert found["pga"] == pytest.approx(3.0, rel=1e-12, abs=0.0)
    assert found["pgv"] == pytest.approx(6.0 / w, rel=1e-12, abs=0.0)
    assert found["pgd"] == pytest.approx(3.0 * 0.8 / w, rel=1e-12, abs=0.0)
    assert found["cav"] == pytest.approx(12.0 / w, rel=1e-5)
    assert found["arias"] == pytest.approx(math.pi / (2.0 * G) * 9.0 * 0.4, rel=1e-5)
    assert (answer["kind"], answer["duration"], answer["format"]) == ("pulse", 0.8, None)


def test_jumps_at_the_ends_of_a_pulse_are_kept(answered):
    """A constant a for 0.5 s: CAV a t and Arias exact, not one step longer; undamped PSA 2 a, with 5 % 1.8545 a."""
    found = answered("rectangular:amplitude=2,duration=0.5", "--periods", "0.2", "--damping", 0)
    assert found["intensity"]["cav"] == pytest.approx(1.0, rel=1e-12, abs=0.0)
    assert found["intensity"]["arias"] == pytest.approx(math.pi / (2.0 * G) * 4.0 * 0.5, rel=1e-12, abs=0.0)
    # the solver misses peaks by up to 1e-4
    assert found["spectrum"]["pseudo_acceleration"] == pytest.approx([4.0], rel=1e-4)
    damped = answered("rectangular:amplitude=2,duration=0.5", "--periods", "0.2")["spectrum"]
    overshoot = 1.0 + math.exp(-0.05 * math.pi / math.sqrt(1.0 - 0.05**2))
    assert damped["pseudo_acceleration"] == pytest.approx([2.0 * overshoot], rel=1e-4)
    assert damped["damping_ratio"] == 0.05


def test_periods_are_those_asked_for(answered, triangle):
    """--periods gives these periods and no others; a very slow oscillator feels a blow of PGV."""
    spectrum = answered(triangle, "--units", "m/s2", "--periods", "0.5, 1000", "--damping", "0.02")["spectrum"]
    assert (spectrum["period"], spectrum["damping_ratio"]) == ([0.5, 1000.0], 0.02)
    # to so slow an oscillator the record is a blow of 0.5 m/s, and its first swing loses exp(-z acos(z) / sqrt(1 - z2))
    kept = math.exp(-0.02 * math.acos(0.02) / math.sqrt(1.0 - 0.02**2))
    assert spectrum["pseudo_velocity"][1] == pytest.approx(0.5 * kept, rel=1e-3)


def test_scale_multiplies(answered, triangle):
    """--scale -2 doubles all peaks and makes Arias four times as large, for files and for pulses."""
    for words in ([triangle, "--units", "m/s2"], ["ricker:amplitude=1,period=0.5"]):
        one, two = (answered(*words, *more)["intensity"] for more in ([], ["--scale", "-2"]))
        assert two["pgd"] == pytest.approx(2.0 * one["pgd"], rel=1e-9)
        assert two["arias"] == pytest.approx(4.0 * one["arias"], rel=1e-9)


def test_printed_page(run, tmp_path):
    """The page names format, station, component, samples, step, duration, every measure with its unit, and PSA in g."""
    path = tmp_path / "cellar.at2"
    path.write_text(PEER, encoding="utf-8")
    code, out, err = run(path)
    assert (code, err) == (0, "")
    for words in ("peer", "CELLAR", "360", "0.5 s", "1 s", "m/s2", "PSA [g]", "damping ratio 0.05", "0.2 g"):
        assert words in out
    # peak 0.2 g = 1.96133 m/s2
    assert "1.961" in out
    code, out, _ = run("half-sine:amplitude=1,period=1")
    assert "  Kind                  pulse\n" in out


def test_csv(printed, tmp_path, triangle):
    """The CSV holds time, acceleration, velocity, displacement at the samples: those of the triangle, by hand."""
    path = tmp_path / "out.csv"
    out = printed(triangle, "--units", "m/s2", "--output", path)
    assert f"wrote {path}" in out
    with path.open(encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head == ["time [s]", "acceleration [m/s2]", "velocity [m/s]", "displacement [m]"]
    expected = [[0.0, 0.0, 0.0, 0.0], [0.5, 1.0, 0.25, 1.0 / 24.0], [1.0, 0.0, 0.5, 0.25]]
    assert [[float(word) for word in row] for row in rows] == [pytest.approx(row, abs=1e-15) for row in expected]


def test_csv_of_a_pulse_is_exact(run, tmp_path):
    """The CSV of a sine holds a sin(wt), its integrals, and ends with the pulse."""
    path = tmp_path / "out.csv"
    assert run("sine:amplitude=3,period=0.8", "--output", path)[0] == 0
    with path.open(encoding="utf-8") as file:
        rows = [[float(word) for word in row] for row in list(csv.reader(file))[1:]]
    w = 2.0 * math.pi / 0.8
    for t, a, v, u in rows[:: len(rows) // 7]:
        exact = [3.0 * math.sin(w * t), 3.0 / w * (1.0 - math.cos(w * t)), 3.0 / w * (t - math.sin(w * t) / w)]
        assert [a, v, u] == pytest.approx(exact, abs=1e-12)
    assert rows[-1][0] == pytest.approx(0.8, rel=1e-12, abs=0.0)


def test_picture(run, tmp_path, triangle):
    """--picture writes an SVG with the axes' units in it."""
    path = tmp_path / "motion.svg"
    assert run(triangle, "--units", "g", "--output", path)[0] == 0
    text = path.read_text(encoding="utf-8")
    assert "time [s]" in text
    assert "PSA [g]" in text


def test_components(run, answered, tmp_path):
    """Several components: the refusal says what to type, and typed so it works, vertical part included."""
    path = tmp_path / "four.txt"
    path.write_text(FOUR, encoding="utf-8")
    code, out, err = run(path, "--units", "m/s2")
    assert (code, out) == (2, "")
    assert f"use {' or '.join(repr(f'{path}#column {k}') for k in (2, 3, 4))}" in err
    assert "component=" not in err
    assert err.count("\n") == 1
    left = run(path, f"z={path}#column 4", "--units", "m/s2")[2]
    assert f"{path}#column 3" in left
    assert f"{path}#column 4" not in left
    words = [f"{path}#column 3", f"z={path}#column 4", "--units", "m/s2"]
    answer = answered(*words, "--output", tmp_path / "out.csv")
    assert (answer["component"], answer["vertical_component"]) == ("column 3", "column 4")
    assert answer["intensity"]["pga"] == 2.0
    assert answer["peak_vertical_acceleration"] == 0.3
    assert "vertical_acceleration [m/s2]" in (tmp_path / "out.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "Peak vertical acceleration" in run(*words)[1]


def test_a_file_wins_over_a_pulse(answered, tmp_path, monkeypatch):
    """A file that is called like a pulse is read as a file; without it the word is the pulse."""
    monkeypatch.chdir(tmp_path)
    word = "sine:amplitude=3,period=0.8"
    assert answered(word)["intensity"]["pga"] == pytest.approx(3.0, rel=1e-12, abs=0.0)
    (tmp_path / word).write_text(TRIANGLE, encoding="utf-8")
    assert answered(word, "--units", "m/s2")["intensity"]["pga"] == 1.0


def test_errors_keep_their_kind(tmp_path):
    """Files raise RecordError, values InvalidValueError, pulses UnknownModelError: callers can tell them apart."""
    path = tmp_path / "triangle.txt"
    path.write_text(TRIANGLE, encoding="utf-8")
    for words, kind in (
        ([str(path)], RecordError),
        ([str(path), "--units", "x"], InvalidValueError),
        (["nothing"], RecordError),
        (["nothing:a=1"], UnknownModelError),
        (["sine:amplitude=1,period=1", "--set", "motion.component=x"], InvalidValueError),
    ):
        with pytest.raises(kind):
            application(["record", "show"])(args=["record", "show", *words], standalone_mode=False)
