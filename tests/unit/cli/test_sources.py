"""The floor, its building and the file with its SHA-256 stand on every page, in every JSON and every report."""

import hashlib
import json

import numpy as np
import pytest

pytestmark = pytest.mark.verifies("behaviour", room="doors")
FLOOR = 'motion.process="mean; floor:number=3,storeys=5,period=0.5"'
SIZE = ("--width", "0.5", "--height", "2")
SAID = ("floor 3 of 5 of an elastic shear building", "fundamental period 0.5 s", "5 % damping of every mode (assumed)",
        "mean acceleration removed", "stated by the user: unit m/s2")  # fmt: skip
COMMANDS = {
    "simulate": SIZE,
    "predict": (*SIZE, "--set", "predict.count=4", "--set", "predict.contributions=false"),
    "assess": (*SIZE, "--restitution", "0.9", "--set", "predict.count=4", "--set", "predict.contributions=false"),
    "code-checks": SIZE,
    "map": (*SIZE, "--x", "pga=1,2", "--y", "width=0.4,0.5"),
    "overturning-pga": (*SIZE, "--samples", "8"),
    "fragility": (*SIZE, "--levels", "1,2"),
    "inventory": (),
}


@pytest.fixture
def record(tmp_path):
    """Return a record of a file that states no unit."""
    path = tmp_path / "ground.txt"
    times = 0.02 * np.arange(120)
    path.write_text("\n".join(f"{t:.2f} {2.0 * np.sin(9.0 * t):.6f}" for t in times), "utf-8")
    return path


def words_of(command, record, tmp_path):
    own = COMMANDS[command]
    if command == "inventory":
        (tmp_path / "list.csv").write_text("name;width_cm;depth_cm;height_cm\nVase;20;20;60\n", "utf-8")
        return (command, tmp_path / "list.csv", f"--motion={record}", "--units", "m/s2", "--set", FLOOR)
    return (command, *own, record, "--units", "m/s2", "--set", FLOOR)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_floor_is_in_the_answer(run, record, tmp_path, command):
    """Screen and `--json` of each command contain the floor, its building, its damping, all steps and stated units."""
    words, sha = words_of(command, record, tmp_path), hashlib.sha256(record.read_bytes()).hexdigest()
    details = ["--details"] if command not in {"histories", "spectrum"} else []
    code, page, err = run(*words, *details)
    assert code == 0, err
    assert all(each in page for each in (*SAID, sha)), page
    _, text, _ = run(*words, "--json")
    assert json.loads(text)
    assert all(each in text for each in (*SAID, sha))


@pytest.mark.slow
@pytest.mark.parametrize("command", ["predict", "assess", "inventory"])
def test_the_floor_is_in_the_report(run, record, tmp_path, command):
    """Reports contain the floor and all steps; the report of the ground motion does not contain the floor."""
    pytest.importorskip("jinja2")
    page, sha = tmp_path / "report.html", hashlib.sha256(record.read_bytes()).hexdigest()
    code, _, err = run(*words_of(command, record, tmp_path), "--output", page)
    assert code == 0, err
    text = page.read_text("utf-8")
    assert all(each in text for each in (*SAID, sha))
    assert "project's specification" not in text  # references name sources
    if command != "inventory":
        assert "PFA" in text
        assert "motion of the ground" not in text
        # negative control: of the record itself nothing speaks of a floor
        code, _, _ = run(*words_of(command, record, tmp_path)[:-2], "--output", page)
        assert "PFA" not in page.read_text("utf-8")


def test_a_level_is_an_option(run, record):
    """`--pga` scales the motions to a level with its unit; other words, and motions of floors, are refused."""
    few = ("--units", "m/s2", "--set", "predict.count=4", "--set", "predict.contributions=false", "--json")
    _, text, _ = run("predict", *SIZE, record, "--pga", "0.3g", *few)
    motion = json.loads(text)["motions"][0]
    assert motion["peak_ground_acceleration"] == pytest.approx(0.3 * 9.80665, rel=1e-12)
    assert "so that PGA is 2.94199 m/s2 (0.3 g)" in motion["provenance"][-1]
    for level, why in (("0.3", "must be a number with its unit"), ("-1g", "PGA"), ("0.3gal2", "unit")):
        code, _, err = run("predict", *SIZE, record, "--pga", level, *few)
        assert code == 2
        assert why in err
    code, _, err = run("predict", *SIZE, record, "--pga", "0.3g", "--set", FLOOR, *few)
    assert code == 2
    assert "floor 3 of 5" in err


@pytest.mark.slow
def test_curves_of_a_floor_are_not_of_the_ground(run, tmp_path):
    """PELICUN reads peak floor acceleration; OpenQuake, whose PGA is that of the ground, gets no file."""
    rng, times, names = np.random.default_rng(4), 0.02 * np.arange(200), []
    for k in range(6):
        wave = sum(np.sin(f * times + rng.uniform(0.0, 6.0)) for f in (4.0, 7.0, 11.0)) * np.exp(
            -(((times - 2) / 1.2) ** 2)
        )
        names.append(tmp_path / f"r{k}.txt")
        names[-1].write_text("\n".join(f"{t:.2f} {a:.6f}" for t, a in zip(times, wave, strict=True)), "utf-8")
    words = ("fragility", "--width", 0.25, "--height", 1.25, "--centre", "0.11,0.6", *names, "--units", "m/s2",
             "--levels", "0.15g:1.2g:9", "--limit-states", "overturning")  # fmt: skip
    table, nrml = tmp_path / "pelicun.csv", tmp_path / "nrml.xml"
    for process, demand in (((), "Peak Ground Acceleration"), (("--set", FLOOR), "Peak Floor Acceleration")):
        code, page, err = run(*words, *process, "--output", f"pelicun={table}")
        assert code == 0, err
        assert f",{demand},g,0,1," in table.read_text("utf-8")
        assert ("peak floor acceleration, floor 3 of 5" in page) == bool(process)
        code, _, err = run(*words, *process, "--output", nrml)
        assert (code == 0) == nrml.exists() == (not process), err
        nrml.unlink(missing_ok=True)
    assert "these motions are of floor 3 of 5" in err


def test_the_head_of_peaks_names_the_floor(run, record, tmp_path):
    """On a floor the table has PFA, of the record itself PGA."""
    assert "PFA [g]" in run(*words_of("predict", record, tmp_path), "--details")[1]
    ground = ("predict", *COMMANDS["predict"], record, "--units", "m/s2")
    assert "PGA [g]" in run(*ground, "--details")[1]
    assert "PFA" not in run(*ground, "--details")[1]
