"""`--set` and options: nothing that was typed is ignored; what is said twice or cannot hold is refused."""

import json
from pathlib import Path

import numpy as np
import pytest

import rocking as rk

SIZE = "--width 0.5 --height 2"
PULSE = "sine:amplitude=3.2,period=0.8"
FAMILY = "--synthetic firm-ground --count 8"
PRISM = 'units = "m"\n[[solid.part]]\nbox = { width = 0.5, depth = 0.5, height = 2.0 }\n'
STRIPES = f"""[campaign]
name = "a"
kind = "stripes"
[body]
units = "m"
width = 0.5
height = 2
[motions]
pulse = ["{PULSE}", "sine:amplitude=3,period=0.5"]
[fragility]
levels = [1.0, 4.0]
"""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Two records without time step, a prism, and files of questions."""
    monkeypatch.chdir(tmp_path)
    k = np.arange(80)
    for name, rate in (("record.txt", 0.2), ("other.txt", 0.17)):
        Path(name).write_text("\n".join(f"{value:.6f}" for value in 3.2 * np.sin(rate * k)))
    Path("prism.toml").write_text(PRISM)
    Path("stripes.toml").write_text(STRIPES)
    Path("odd.toml").write_text("body = 3\n[response]\nfree = 0.5\n[[settings]]\ngravity = 9.81\n")
    Path("free.toml").write_text('[response]\nfree = 30\n[body]\nunits = "m"\nwidth = 0.5\nheight = 2\n')
    return tmp_path


ALONG = "simulate prism.toml x=record.txt --motion y=other.txt --units m/s2 --set motion.time_step=0.02"
REFUSED = {
    # what a file says is no table
    "simulate odd.toml --set body.width=1": "odd.toml: --set body.width: its body is no table; change the file",
    "cor odd.toml --set body.width=1": "--set body.width: its body is no table; change the file",
    "simulate odd.toml --set settings.gravity=3": "--set settings.gravity: it has several [[settings]]",
    f"fragility {SIZE} --motion {PULSE} --set fragility.measure=3": "fragility.measure must be text, got 3",
    # the same key, typed twice
    f"simulate {SIZE} {PULSE} --set body.width=1": "--width and --set body.width say the same: leave one out",
    f"simulate {SIZE} {PULSE} --units cm --set body.units=mm": "--units and --set body.units say the same",
    f"simulate {SIZE} record.txt --units g --set motion.units=gal": "--units and --set motion.units say the same",
    f"simulate {SIZE} {PULSE} --scale 2 --set motion.scale=3": "--scale and --set motion.scale say the same",
    f"motion {PULSE} --scale 2 --set motion.scale=3": "--scale and --set motion.scale say the same",
    f"simulate {SIZE} {PULSE} --friction 0.4 --set response.friction=0.5": "--friction and --set response.friction say",
    f"simulate {SIZE} {PULSE} --restitution ked --set restitution.value=0.9": "--restitution and --set restitution",
    f"simulate {SIZE} {PULSE} --set motion.pulse=ricker": f"{PULSE} and --set motion.pulse say the same",
    "motion record.txt#north --set motion.component=east": "record.txt#north and --set motion.component say the same",
    "simulate prism.toml record.txt --set body.file=other.toml": "prism.toml and --set body.file say the same",
    f"map {SIZE} {PULSE} --refine 2 --set map.refine=3": "--refine and --set map.refine say the same",
    f"minimum {SIZE} {PULSE} --points 9 --set minimum.points=20": "--points and --set minimum.points say the same",
    f"spectrum {PULSE} --slenderness 4 --set spectrum.slenderness_angles=[0.2]": "--slenderness and --set spectrum.sl",
    f"fragility {SIZE} {FAMILY} --measure pga --set fragility.measure=pgv": "--measure and --set fragility.measure say",
    f"fragility {SIZE} {FAMILY} --set motion.count=9": "--count and --set motion.count say the same",
    "inventory list.csv --pga 0.3g --set inventory.pga=0.2g": "--pga and --set inventory.pga say the same",
    # what does not go with the motion
    f"simulate prism.toml {PULSE} --set motion.format=peer": "a pulse takes no motion.format",
    f"simulate prism.toml --motion y={PULSE} --set motion.component=EW": "a pulse takes no motion.component",
    f"simulate prism.toml --motion y={PULSE} --set motion.steps=3": "unknown key 'steps'",
    f"simulate {SIZE} {PULSE} --set motion.steps=3": "unknown key 'steps'",
    f"{ALONG} --set motion.component=EW": "motion.component is of one file",
    f"simulate {SIZE} record.txt --motion z=record.txt --set motion.vertical=up": "--set motion.vertical say the same",
    f"fragility {SIZE} {FAMILY} --set motion.component=EW": "motion.component is for record files",
    f"fragility {SIZE} {FAMILY} --set motion.scale=2": "synthetic takes no scale; allowed beside it",
    # shapes
    f"cor {SIZE} --set body.slenderness_angle=0.2": "got --width --height --set body.slenderness_angle",
    f"cor {SIZE} --set body.repair=all": "unknown key 'repair'",
    "cor prism.toml --set body.width=2": "give a body file or dimensions, not both",
    # what only a campaign computes
    f"map {SIZE} {PULSE} --refine 1 --set map.boundary=mode": "map.boundary is for files of rocking campaign",
    f"map {SIZE} {PULSE} --refine 1 --set map.tolerance=1e-3": "map.tolerance is for files of rocking campaign",
    # shares of the slenderness angle, however they are said
    f"simulate {SIZE} --set response.free=30": "--free is a share of the slenderness angle",
    "simulate free.toml": "response.free is a share of the slenderness angle",
    # beside a file
    f"map stripes.toml {PULSE}": "so it takes no second word; --set changes a key",
    f"simulate free.toml {PULSE}": "so it takes no second word; --set changes a key",
}


@pytest.mark.parametrize(("words", "sentence"), REFUSED.items(), ids=REFUSED)
def test_refusals(refuses, words, sentence):
    """What is said twice, or would be ignored, is refused in one sentence that says what to do."""
    refuses(words.split(), sentence)


SAME = {
    "a pulse is scaled": (f"simulate {SIZE} {PULSE} --set motion.scale=2", f"simulate {SIZE} {PULSE} --scale 2"),
    "a pulse that is shown": (f"motion {PULSE} --set motion.scale=2", f"motion {PULSE} --scale 2"),
    "a solid": (f"simulate prism.toml {PULSE} --set motion.scale=2", f"simulate prism.toml {PULSE} --scale 2"),
    "a value for the usual model": (
        f"simulate {SIZE} {PULSE} --set restitution.value=0.9", f"simulate {SIZE} {PULSE} --restitution 0.9",
    ),
    "sizes": ("cor --set body.width=0.5 --set body.height=2", f"cor {SIZE}"),
    "let go": (f"simulate {SIZE} --set response.free=0.5", f"simulate {SIZE} --free 0.5"),
    "seed of a family": (
        f"fragility {SIZE} {FAMILY} --levels 1,4 --set motion.seed=3",
        f"fragility {SIZE} {FAMILY} --levels 1,4 --seed 3",
    ),
    "gravity of a body in a file": (
        f"cor {SIZE} --density 1000", "cor free.toml --set body.density=1000",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("one", "other"), SAME.values(), ids=SAME)
def test_two_ways_to_say_it(run, one, other):
    """A key that is set is the option, digit by digit."""
    (code, first, _), (_, second, _) = (run(*f"{words} --json".split()) for words in (one, other))
    assert code == 0
    assert json.loads(first) == json.loads(second)


def test_step_and_scale_hold_along_every_axis(run):
    """What is set of files holds for both components, and a scale for the motion as a whole."""
    code, out, _ = run(*f"{ALONG} --set motion.scale=1.5 --json".split())
    x, y = (rk.read_motion(name, units="m/s2", time_step=0.02) for name in ("record.txt", "other.txt"))
    expected = rk.simulate(rk.read_body("prism.toml"), {"x": x, "y": y}, scale=1.5)
    answer = json.loads(out)
    assert (code, answer["peak_tilt"], answer["summary"]) == (0, expected.peak_tilt, expected.summary)


def test_a_file_says_how_curves_that_cross_are_written(refuses, run, monkeypatch):
    """`[export] crossing` of a file holds unless `--crossing` says otherwise; what needs a campaign is refused."""
    from rocking.cli.fragility_answer import FragilityAnswer

    seen = []
    monkeypatch.setattr(FragilityAnswer, "check_crossing", lambda self: seen.append((self.crossing, self.name)))
    export = '[export]\ncrossing = "common-dispersion"\n'
    Path("stripes.toml").write_text(STRIPES + export)
    for more in ("", " --crossing refuse --name vase"):
        run(*f"fragility stripes.toml --out p58=curves.csv{more}".split())
    assert seen == [("common-dispersion", None), ("refuse", "vase")]
    Path("stripes.toml").write_text(f"{STRIPES}{export}bootstrap = 99\n")
    refuses(("fragility", "stripes.toml"), "export.bootstrap is for files of rocking campaign")


def test_numbers_are_whole_in_a_narrow_terminal(run, monkeypatch):
    """`rocking motion` folds words, never a value."""
    monkeypatch.setenv("COLUMNS", "46")
    rows = run(*f"motion {PULSE}".split())[1].splitlines()
    assert next(row for row in rows if row.startswith("peak ground velocity")).split()[-2:] == ["0.8149", "m/s"]
