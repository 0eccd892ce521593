"""`rocking bifurcation`, `orbits`, `lyapunov` and `basins`: tables, JSON, files, and what they refuse."""

import json

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.verifies("behaviour", room="doors")]
BLOCK = ("--width", 1, "--height", 2)
WORDS = {
    "bifurcation": ("--values", "0.9,1.2", "--starts", 2, "--settled", 20, "--kept", 4, "--sweeps", "up,down"),
    "orbits": ("--frequency", 2, "--amplitude", 1.2, "--highest", 3, "--doublings", 1, "--set", "orbits.points=20"),
    "lyapunov": ("--orbits", 3, "--settled", 60, "--kept", 20),
    "basins": ("--phases", 4, "--speeds", 4, "--amplitudes", "0.5,1.5"),
}
ROWS = {"bifurcation": 1, "orbits": 4, "lyapunov": 1, "basins": 2}


@pytest.mark.parametrize("command", WORDS)
def test_each_command_has_a_summary_and_files(command, run, tmp_path):
    """The summary has the rows of each model; the default model is compared with others."""
    files = [word for name in ("a.png", "a.csv", "a.nc") for word in ("--output", tmp_path / name)]
    words = (command, *BLOCK, *WORDS[command], "--restitution", "ked", "--restitution", "housner")
    code, out, err = run(*words, "--json", *files)
    assert (code, err) == (0, "")
    answer = json.loads(out)
    models = [row["restitution"] for row in answer["findings"]]
    assert models == ["ked"] * ROWS[command] + ["housner"] * ROWS[command]
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert len((tmp_path / "a.csv").read_text().splitlines()) > 3
    compared = json.loads(run(command, *BLOCK, *WORDS[command], "--json")[1])["findings"]
    assert list(dict.fromkeys(row["restitution"] for row in compared)) == ["calibrated", "ked", "housner"]


def test_the_orbits_of_a_job_file_are_those_of_the_command(run, file):
    """Bifurcations are printed with their values; a file says the same as options."""
    path = file('[body]\nunits = "m"\nwidth = 1\nheight = 2\n[restitution]\nmodel = "housner"\n[orbits]\n'
                "frequency = 2\namplitude = 1.2\nhighest = 3\ndoublings = 1\npoints = 20\n", "job.toml")  # fmt: skip
    found = json.loads(run("orbits", path, "--json")[1])["findings"]
    assert [row["branch_point"] for row in found] == ["grazing", "fold", "pitchfork", "period doubling"]
    assert found[1]["amplitude_ratio"] == pytest.approx(0.365698905, abs=1e-9)
    assert (
        run("orbits", path, "--json")[1]
        == run("orbits", *BLOCK, *WORDS["orbits"], "--restitution", "housner", "--json")[1]
    )
    assert "pitchfork" in run("orbits", path)[1]


def test_what_the_commands_refuse(refuses):
    """Friction, values that do not increase, a frequency of zero, and an asymmetric coefficient."""
    refuses(("basins", *BLOCK, "--friction", 0.4), "without friction")
    refuses(("bifurcation", *BLOCK, "--values", "2,1"), "must increase")
    refuses(("lyapunov", *BLOCK, "--frequency", 0), "--frequency")
    refuses(("lyapunov", *BLOCK, "--restitution", 1.2), "restitution")
    refuses(("orbits", *BLOCK, "--amplitude", 0.01), "smallest amplitude")
