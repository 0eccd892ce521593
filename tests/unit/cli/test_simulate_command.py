"""`rocking simulate`: the same numbers as Python, every option, and refusals in one sentence."""

import csv
import math
import sys

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from rocking import examples
from rocking.answers import Display
from rocking.cli.page import Page
from rocking.cli.responses import ResponseAnswer
from rocking.evidence import _coefficient_table
from rocking.evidence._coefficient_table import default_models
from rocking.spec.response import ResponseProblem

COMMAND = "simulate"

G = 9.80665
BLOCK = rk.Block(width=0.5, height=2.0)
SIZE = ("--width", "0.5", "--height", "2")
PULSE = "sine:amplitude=3.2,period=0.8"
ALPHA = math.atan(0.25)
MINE = """import rocking as rk


class Mine(rk.restitution.RestitutionModel):
    name = "mine"

    def raw_coefficient(self, body, foot):
        return 0.9
"""
BODY = 'units = "m"\n[block]\nwidth = 0.5\nheight = 2.0\n'
DECIDES = ("sine:amplitude=4.25,period=0.6", rk.pulses.sine(4.25, 0.6))
"""Here Housner's block stays standing and KED's falls."""


def same(answer, response):
    """Whether a JSON holds a response to the last digit."""
    impacts = [tuple(row.values()) for row in answer["impacts"]]
    return (
        answer["peak_rotation"] == response.peak_rotation
        and impacts == response.impacts.tolist()
        and answer["uplift_times"] == response.uplifts.tolist()
        and answer["outcome"] == response.outcome.name.lower()
        and answer["summary"] == response.summary
        and answer["energy_closure"] == response.energy.closure
        and answer["error_estimate"] == response.error_estimate
        and answer["engine"] == response.engine
        and answer["restitution"] == response.parameters.label
    )


@pytest.fixture
def body(file):
    """Body file of the block."""
    return file(BODY, "block.toml")


@pytest.fixture
def record(file):
    """Time and two components in three columns: a sine of 3 m/s2, and one of 1 m/s2."""
    k = np.arange(60)
    rows = np.column_stack([k * 0.02, 3.0 * np.sin(k * 0.2), np.cos(k * 0.3)])
    return file("\n".join(" ".join(f"{x:.6f}" for x in row) for row in rows) + "\n", "record.txt")


def test_json_is_python_to_the_last_digit(answered, capsys, body):
    """Size on the command line, body file with the pulse as word or option: all are rk.simulate, bit by bit."""
    expected = rk.simulate(BLOCK, rk.pulses.sine(3.2, 0.8))
    for words in ((*SIZE, "--motion", PULSE), (*SIZE, PULSE), (body, PULSE), (body, "--motion", PULSE)):
        answer = answered(*words)
        assert same(answer, expected)
        assert answer["body"]["sides"]["left"]["slenderness_angle"] == pytest.approx(ALPHA, rel=1e-15, abs=0.0)
        assert answer["motion"]["peak_ground_acceleration"] == pytest.approx(3.2, rel=1e-12, abs=0.0)
    angle = answered(
        "--set", f"body.slenderness_angle={ALPHA}", "--set", f"body.semi_diagonal={0.5 * math.hypot(0.5, 2.0)}", PULSE
    )
    assert angle["peak_rotation"] == pytest.approx(expected.peak_rotation, rel=1e-9)
    assert same(answered("--width", 50, "--height", 200, "--units", "cm", PULSE), expected)
    # negative control: another pulse is another response
    assert not same(answered(*SIZE, "sine:amplitude=3.3,period=0.8"), expected)


OPTIONS = {
    "model": (["--restitution", "housner"], {"restitution": "housner"}),
    "factor": (["--restitution", "0.98*shifted-impulse:k=0.6"], {"restitution": "0.98*shifted-impulse:k=0.6"}),
    "number": (["--restitution", "0.9"], {"restitution": 0.9}),
    "scale": (["--scale", "-1.25"], {"scale": -1.25}),
    "linear": (["--set", "settings.linear=true"], {"linear": True}),
    "reference": (["--set", "settings.engine=reference"], {"engine": "reference"}),
    "gravity": (["--set", "settings.gravity=9.81"], {"gravity": 9.81}),
}


@pytest.mark.slow
@pytest.mark.parametrize(("words", "options"), OPTIONS.values(), ids=list(OPTIONS))
def test_each_option_reaches_the_engine(answered, words, options):
    """With each option the answer is that of Python with the same argument, and not the one without it."""
    answer = answered(*SIZE, PULSE, *words)
    assert same(answer, rk.simulate(BLOCK, rk.pulses.sine(3.2, 0.8), **options))
    assert not same(answer, rk.simulate(BLOCK, rk.pulses.sine(3.2, 0.8)))


def test_size_in_three_dimensions_changes_the_mass_alone(answered):
    """Depth 2 m and 1000 kg/m3 make 2000 kg of 0.5 x 2 m; it rocks as any other."""
    answer = answered(*SIZE, PULSE, "--depth", 2, "--density", 1000)
    assert answer["body"]["mass"] == pytest.approx(2000.0)
    assert answer["peak_rotation"] == rk.simulate(BLOCK, rk.pulses.sine(3.2, 0.8)).peak_rotation


def test_own_model_from_a_file(answered, tmp_path):
    """A class in the user's file is a model like the others."""
    path = tmp_path / "mine.py"
    path.write_text(MINE, encoding="utf-8")
    answer = answered(*SIZE, PULSE, "--restitution", f"{path}:Mine")
    assert answer["peak_rotation"] == rk.simulate(BLOCK, rk.pulses.sine(3.2, 0.8), 0.9).peak_rotation


def test_free_rocking(answered):
    """Let go at a share of alpha it is Python's, to either side; there is no motion."""
    for share in (0.6, -0.6):
        answer = answered(*SIZE, "--initial-rotation", share, "--restitution", "0.9")
        assert same(answer, rk.free_rocking(BLOCK, share * BLOCK.slenderness_angle, 0.9))
        assert answer["initial_rotation"] == pytest.approx(share * ALPHA, rel=1e-15, abs=0.0)
        assert answer["motion"] is None
        assert answer["peak_ratio"] == pytest.approx(0.6, rel=1e-12, abs=0.0)


def test_record_options(run, answered, capsys, body, record):
    """Units, format, component, vertical component of a record are those of read_motion; a step at odds is refused."""
    words, part = ["--units", "m/s2"], f"{record}#column 2"
    motion = rk.read_motion(record, "columns", "m/s2", component="column 2", vertical="column 3")
    both = answered(body, f"x={part}", *words, "--motion", f"z={record}#column 3", "--set", "motion.format=columns")
    assert same(both, rk.simulate(BLOCK, motion))
    assert (both["motion"]["kind"], both["motion"]["name"]) == ("record", motion.name)
    assert not same(answered(body, part, *words), rk.simulate(BLOCK, motion))
    assert run(body, part, *words, "--set", "motion.time_step=0.5")[0] == 2
    in_g = answered(body, part, "--units", "g", "--scale", "0.1")
    peak = max(abs(3.0 * math.sin(0.2 * k)) for k in range(60))
    assert in_g["motion"]["peak_ground_acceleration"] == pytest.approx(0.1 * G * peak, rel=1e-6)
    page = run(body, part, *words, "--scale", "2", "--set", "settings.linear=true")[1]
    assert f"2 times {motion.name}, 1.18 s, PGA {2.0 * peak:.4g} m/s2" in page
    assert "slender-linear equations" in page
    assert f"2 times sine pulse, 0.8 s, PGA {6.4 / G:.4g} g" in run(body, PULSE, "--scale", "2")[1]


def test_other_models_are_asked_too(run, answered):
    """Every model without parameters has its outcome and peak, those of Python; the page says who decides."""
    word, pulse = DECIDES
    ked = ("--restitution", "ked")
    answer = answered(*SIZE, word, *ked)
    others = {model.label: model for model in default_models()}
    del others["ked"]
    assert list(answer["other_models"]) == list(others)
    for label, model in others.items():
        response, found = rk.simulate(BLOCK, pulse, model), answer["other_models"][label]
        assert found["outcome"] == response.outcome.name.lower()
        assert found["peak_rotation"] == response.peak_rotation
        assert found["coefficient"]["left"] == model.coefficient(BLOCK, "left")
    assert (answer["outcome"], answer["other_models"]["housner"]["outcome"]) == ("overturned", "rocked")
    assert "overturning with 7 of 8 models." in run(*SIZE, word, *ked)[1]
    out = run(*SIZE, word, *ked, "--details")[1]
    assert "the body overturns with ked" in out
    assert "does not overturn with housner" in out
    assert "The body does not overturn with any of these models." in run(*SIZE, PULSE)[1]
    assert "The body has no uplift" in run(*SIZE, "sine:amplitude=1,period=1")[1]


def test_warnings_are_in_plain_words(run, answered):
    """A body of slope 1/4 takes friction of about 1/4: with 0.2 it slides, with 0.5 not; a squat one would fly."""
    words = (*SIZE, PULSE)
    assert answered(*words)["warnings"] == []
    slip = ("--set", "response.assumed_friction=0.2")
    slippery = answered(*words, *slip)
    assert slippery["friction"] == 0.2
    assert "With 0.2 the body slides" in slippery["warnings"][0]
    assert "With 0.2 the body slides" in run(*words, *slip)[1]
    hard = ("--width", 3, "--height", 1, "sine:amplitude=40,period=1", "--restitution", "0.5")
    flying = answered(*hard)
    assert flying["friction_of_motion"] is None
    assert flying["least_force"] < 0.0
    assert "Friction demand       infinite (assumed 0.5)" in run(*hard)[1]


def test_a_model_that_does_not_fit_says_why(capsys):
    """Where a model has no coefficient for a body, the row and the JSON say so, and the verdict leaves it out."""
    problem = ResponseProblem(BLOCK, None, initial_rotation=0.4)
    answer = ResponseAnswer(problem, problem.answer(), Display(), {"odd": "the impact would create energy"})
    answer.show(Page())
    out = capsys.readouterr().out
    assert "not for this body" in out
    assert "! odd: the impact would create energy" in out
    assert answer.answer().plain()["other_models"]["odd"] == {"error": "the impact would create energy"}


@pytest.mark.slow
def test_files(run, printed, tmp_path):
    """Picture, page, GIF, CSV and MATLAB files are written and named; the CSV holds Python's rotation."""
    paths = {ending: tmp_path / f"a.{ending}" for ending in ("svg", "html", "csv", "mat")}
    out = printed(*SIZE, PULSE, *(word for path in paths.values() for word in ("--output", path)))
    assert out.splitlines()[-4:] == [f"wrote {path}" for path in paths.values()]
    expected = rk.simulate(BLOCK, rk.pulses.sine(3.2, 0.8))
    with paths["csv"].open(encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if not row[0].startswith("#")]
    column = next(k for k, word in enumerate(rows[0]) if word.startswith("rotation"))
    np.testing.assert_array_equal([float(row[column]) for row in rows[1:]], expected.rotation)
    assert expected.summary[1:] in paths["html"].read_text(encoding="utf-8")
    assert "angular" in paths["svg"].read_text(encoding="utf-8")
    assert paths["mat"].stat().st_size > 1000
    gif = tmp_path / "a.GIF"
    assert run(*SIZE, "--initial-rotation", "0.1", "--restitution", "0.1", "--output", gif)[0] == 0
    with Image.open(gif) as film:
        assert film.format == "GIF"


def test_netcdf(run, tmp_path):
    """--netcdf writes what xarray reads, to the last digit."""
    pytest.importorskip("h5py")
    import xarray

    path = tmp_path / "a.nc"
    assert run(*SIZE, PULSE, "--output", path)[0] == 0
    with xarray.open_dataset(path, engine="h5netcdf") as found:
        np.testing.assert_array_equal(found["rotation"], rk.simulate(BLOCK, rk.pulses.sine(3.2, 0.8)).rotation)


@pytest.mark.slow
def test_a_missing_engine_is_said_once(monkeypatch, run):
    """One plain sentence on standard error, no Python warning, however many histories run."""
    monkeypatch.setitem(sys.modules, "rocking.dynamics._engine", None)
    code, _, err = run(*SIZE, PULSE)
    assert (code, err.count("\n")) == (0, 1)
    assert err.startswith("rocking: note: the fast engine was not built")


STATUE = examples.path("statue")


def test_a_library_that_is_missing_below_is_told(run, tmp_path, monkeypatch):
    """An import that fails while a file is written is one sentence, not a traceback."""

    def broken(self, path):
        raise ImportError("no backend for this")

    monkeypatch.setattr(rk.Response, "to_netcdf", broken)
    code, out, err = run(*SIZE, PULSE, "--output", tmp_path / "a.nc")
    assert (code, out) == (2, "")
    assert err.endswith("no backend for this\n")


def test_a_history_without_a_result_is_refused(run, monkeypatch):
    """Where an engine stops, the sentence says why, and no number is printed."""
    few = rk.free_rocking(rk.Block(width=0.5, height=2.0), 0.1, most_events=3)
    monkeypatch.setattr(ResponseProblem, "answer", lambda self: few)
    code, out, err = run(*SIZE, "--initial-rotation", "0.5")
    assert (code, out) == (2, "")
    assert err == "rocking: there is no response: stopped: more impacts and changes of contact than allowed\n"


def test_a_rival_that_creates_energy_is_told_and_left_out(run, monkeypatch):
    """A coefficient of 1 on either side of an asymmetric body creates energy on one of them: told, not computed."""
    monkeypatch.setattr(_coefficient_table, "default_models", lambda: [rk.restitution.model("fixed:r=1")])
    code, out, err = run(STATUE, "--initial-rotation", "0.3")
    assert (code, err) == (0, "")
    assert "not for this body" in out
    assert "would create energy" in out
    assert "The body does not overturn with any of these models." in out


def test_details_of_a_question_file(printed):
    """A question file takes --details, which the page without it names; the impacts are printed with it alone."""
    file = str(rk.examples.path("block-under-a-pulse"))
    page, details = printed(file), printed(file, "--details")
    assert "--details" in page
    assert "velocity before [rad/s]" in details
    assert "velocity before [rad/s]" not in page


def test_details_contain_the_growth_of_small_differences(answered):
    """Of the tangent, with --details only; none with sliding."""
    released = (*SIZE, "--initial-rotation", "0.5")
    names = ("growth_rate", "growth_time", "relative_change")
    tangent = rk.free_rocking(BLOCK, 0.5 * BLOCK.slenderness_angle).tangent()
    details = answered(*released, "--details")
    assert np.exp(details["growth_rate"] * details["growth_time"]) == pytest.approx(tangent.growth[1:].max(), rel=1e-9)
    assert (details["units"]["growth_rate"], details["units"]["growth_time"]) == ("1/s", "s")
    assert not set(answered(*released)) & set(names)
    assert not set(answered(*SIZE, PULSE, "--friction", "0.4", "--details")) & set(names)
    assert set(answered(*SIZE, PULSE, "--details")) & set(names) == {"relative_change"}  # starts at rest
