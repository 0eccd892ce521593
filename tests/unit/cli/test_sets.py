"""`--set` and options: nothing that was typed is ignored; what is said twice or cannot hold is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from campaign_jobs import BODY, job

import rocking as rk
from rocking import examples

SIZE = "--width 0.5 --height 2"
PULSE = "sine:amplitude=3.2,period=0.8"
FAMILY = "--synthetic firm-ground --count 8"
PRISM = 'units = "m"\n[[solid.part]]\nbox = { width = 0.5, depth = 0.5, height = 2.0 }\n'
PULSES = f'[motions]\npulse = ["{PULSE}", "sine:amplitude=3,period=0.5"]\n'
STRIPES = job("stripes", BODY, PULSES, "[fragility]\nlevels = [1.0, 4.0]\n")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Two records without time step, a prism, and files of questions."""
    monkeypatch.chdir(tmp_path)
    k = np.arange(80)
    for name, rate in (("record.txt", 0.2), ("other.txt", 0.17)):
        Path(name).write_text("\n".join(f"{value:.6f}" for value in 3.2 * np.sin(rate * k)))
    Path("prism.toml").write_text(PRISM)
    Path("stripes.toml").write_text(STRIPES)
    Path("odd.toml").write_text("body = 3\n[response]\ninitial_rotation = 0.5\n[[settings]]\ngravity = 9.81\n")
    Path("free.toml").write_text('[response]\ninitial_rotation = 30\n[body]\nunits = "m"\nwidth = 0.5\nheight = 2\n')
    return tmp_path


ALONG = "simulate prism.toml x=record.txt --motion y=other.txt --units m/s2 --set motion.time_step=0.02"


SAME = {
    "a pulse is scaled": (f"simulate {SIZE} {PULSE} --set motion.scale=2", f"simulate {SIZE} {PULSE} --scale 2"),
    "a pulse that is shown": (f"record show {PULSE} --set motion.scale=2", f"record show {PULSE} --scale 2"),
    "a solid": (f"simulate prism.toml {PULSE} --set motion.scale=2", f"simulate prism.toml {PULSE} --scale 2"),
    "a value for the usual model": (
        f"simulate {SIZE} {PULSE} --set restitution.value=0.9", f"simulate {SIZE} {PULSE} --restitution 0.9",
    ),
    "sizes": ("restitution --set body.width=0.5 --set body.height=2", f"restitution {SIZE}"),
    "let go": (f"simulate {SIZE} --set response.initial_rotation=0.5", f"simulate {SIZE} --initial-rotation 0.5"),
    "seed of a family": (
        f"fragility {SIZE} {FAMILY} --levels 1,4 --set motion.seed=3",
        f"fragility {SIZE} {FAMILY} --levels 1,4 --seed 3",
    ),
    "gravity of a body in a file": (
        f"restitution {SIZE} --density 1000", "restitution free.toml --set body.density=1000",
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("one", "other"), SAME.values(), ids=SAME)
def test_two_ways_to_say_it(run, one, other):
    """A key that is set is the option, digit by digit."""
    (code, first, _), (_, second, _) = (run(*f"{words} --json".split()) for words in (one, other))
    assert code == 0
    assert json.loads(first) == json.loads(second)


@pytest.mark.slow
def test_step_and_scale_hold_along_every_axis(run):
    """What is set of files holds for both components, and a scale for the motion as a whole."""
    code, out, _ = run(*f"{ALONG} --set motion.scale=1.5 --json".split())
    x, y = (rk.read_motion(name, units="m/s2", time_step=0.02) for name in ("record.txt", "other.txt"))
    expected = rk.simulate(rk.read_body("prism.toml"), {"x": x, "y": y}, scale=1.5)
    answer = json.loads(out)
    assert (code, answer["peak_tilt"], answer["summary"]) == (0, expected.peak_tilt, expected.summary)


@pytest.mark.slow
def test_a_file_says_how_curves_that_cross_are_written(refuses, run, monkeypatch):
    """`[export] crossing_curves` of a file holds unless the option says otherwise; a campaign alone takes the rest."""
    from rocking.cli.fragility_answer import FragilityAnswer

    seen = []
    monkeypatch.setattr(FragilityAnswer, "check_crossing", lambda self: seen.append((self.crossing_curves, self.name)))
    export = '[export]\ncrossing_curves = "common-dispersion"\n'
    Path("stripes.toml").write_text(STRIPES + export)
    for more in ("", " --crossing-curves refuse --name vase"):
        run(*f"fragility stripes.toml --output p58=curves.csv{more}".split())
    assert seen == [("common-dispersion", None), ("refuse", "vase")]
    Path("stripes.toml").write_text(f"{STRIPES}{export}bootstrap = 99\n")
    refuses(("fragility", "stripes.toml"), "export.bootstrap is for rocking campaign")


def test_numbers_are_whole_in_a_narrow_terminal(run, monkeypatch):
    """`rocking record show` folds words, never a value."""
    monkeypatch.setenv("COLUMNS", "46")
    rows = run(*f"record show {PULSE}".split())[1].splitlines()
    assert next(row for row in rows if row.startswith("  Peak ground velocity")).split()[-2:] == ["0.81487", "m/s"]
    assert [len(row.split()) for row in rows[-6:]] == [5] * 6


JOBS = examples.path("overturning-map").parent
KINDS = {
    "map": ["overturning-map", "refined-map"],
    "overturning-pga": ["minimum-acceleration"],
    "spectrum": ["rocking-spectrum"],
    "fragility": ["stripes", "cloud", "incremental"],
    "inventory": ["inventory"],
}
FILES = sorted(file.stem for file in JOBS.glob("*.toml"))
OTHERS = [(command, file) for command, own in KINDS.items() for file in FILES if file not in own]


@pytest.mark.parametrize(("command", "file"), OTHERS)
def test_a_study_of_another_kind_is_refused_before_it_is_computed(refuses, command, file):
    refuses((command, JOBS / f"{file}.toml"), "needs rocking campaign run")


def test_an_inventory_file_runs(run, monkeypatch):
    monkeypatch.chdir(JOBS)
    code, out, err = run("inventory", "inventory.toml")
    assert (code, err) == (0, "")
    assert out


def test_what_is_set_beside_a_file(run, printed, tmp_path):
    """A key of the one [[body]] of a list is changed; of several it is refused."""
    one = 'units = "m"\nheight = 2.0\nwidth = 0.5\n'
    rest = (
        '[[motions]]\npulse = "sine:amplitude=3,period=0.6"\n[map]\n'
        'x = {axis = "frequency_ratio", values = [2.0, 3.0]}\ny = {axis = "amplitude_ratio", values = [1.0, 6.0]}\n'
    )
    file = tmp_path / "map.toml"
    file.write_text(f"[[body]]\n{one}{rest}")
    out = printed("map", file, "--set", "body.width=0.8")
    assert "slenderness angle 21.8 deg" in out
    file.write_text(f"[[body]]\n{one}[[body]]\n{one}{rest}")
    code, _, err = run("map", file, "--set", "body.width=0.8")
    assert (code, "--set body.width: it has several [[body]]" in err) == (2, True)


def test_a_scale_that_is_set_is_that_of_the_option(run, tmp_path, monkeypatch):
    """`--set motion.scale` and `--scale` of a motion are one."""
    monkeypatch.chdir(tmp_path)
    Path("record.txt").write_text("".join(f"{0.01 * k:.2f} {(-1) ** k * 0.5}\n" for k in range(200)))
    ways = (["--set", "motion.scale=2"], ["--scale", "2"])
    first, second = (run("record", "show", "record.txt", "--units", "m/s2", *way) for way in ways)
    assert first == second
    assert first[0] == 0
