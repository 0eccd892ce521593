"""Files of studies at the commands: each computes its own kind, what is set beside it holds, the rest is refused."""

from pathlib import Path

import pytest

from rocking import examples

JOBS = examples.path("overturning-map").parent
KINDS = {
    "map": ["overturning-map", "refined-map"],
    "minimum": ["minimum-acceleration"],
    "spectrum": ["rocking-spectrum"],
    "fragility": ["stripes", "cloud", "incremental"],
    "inventory": ["inventory"],
}
FILES = sorted(file.stem for file in JOBS.glob("*.toml"))
OTHERS = [(command, file) for command, own in KINDS.items() for file in FILES if file not in own]


@pytest.mark.parametrize(("command", "file"), OTHERS)
def test_a_study_of_another_kind_is_refused_before_it_is_computed(refuses, command, file):
    refuses((command, JOBS / f"{file}.toml"), "rocking campaign run computes it")


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
    assert "alpha = 0.3805 rad" in out
    file.write_text(f"[[body]]\n{one}[[body]]\n{one}{rest}")
    code, _, err = run("map", file, "--set", "body.width=0.8")
    assert (code, "--set body.width: it has several [[body]]" in err) == (2, True)


def test_a_scale_that_is_set_is_that_of_the_option(run, tmp_path, monkeypatch):
    """`--set motion.scale` and `--scale` of a motion are one."""
    monkeypatch.chdir(tmp_path)
    Path("record.txt").write_text("".join(f"{0.01 * k:.2f} {(-1) ** k * 0.5}\n" for k in range(200)))
    ways = (["--set", "motion.scale=2"], ["--scale", "2"])
    first, second = (run("motion", "record.txt", "--units", "m/s2", *way) for way in ways)
    assert first == second
    assert first[0] == 0
