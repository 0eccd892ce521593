"""`rocking simulate` refuses bad input in one sentence with exit code 2."""

import pytest

import rocking as rk
from rocking import examples
from rocking.evidence import _coefficient_table
from rocking.restitution import model
from rocking.spec.response import ResponseProblem

COMMAND = "simulate"

SIZE = ("--width", "0.5", "--height", "2")
STATUE = examples.path("statue")
PULSE = "sine:amplitude=3.2,period=0.8"


def test_a_library_that_is_missing_below_is_told(run, tmp_path, monkeypatch):
    """An import that fails while a file is written is one sentence, not a traceback."""

    def broken(self, path):
        raise ImportError("no backend for this")

    monkeypatch.setattr(rk.Response, "to_netcdf", broken)
    code, out, err = run(*SIZE, PULSE, "--out", tmp_path / "a.nc")
    assert (code, out) == (2, "")
    assert err.endswith("no backend for this\n")


def test_a_history_without_a_result_is_refused(run, monkeypatch):
    """Where an engine stops, the sentence says why, and no number is printed."""
    few = rk.free_rocking(rk.Block(width=0.5, height=2.0), 0.1, most_events=3)
    monkeypatch.setattr(ResponseProblem, "answer", lambda self: few)
    code, out, err = run(*SIZE, "--free", "0.5")
    assert (code, out) == (2, "")
    assert err == "rocking: there is no response: stopped: more impacts and changes of contact than allowed\n"


def test_a_rival_that_creates_energy_is_told_and_left_out(run, monkeypatch):
    """A coefficient of 1 on either side of an asymmetric body creates energy on one of them: told, not computed."""
    monkeypatch.setattr(_coefficient_table, "default_models", lambda: [model("fixed:r=1")])
    code, out, err = run(STATUE, "--free", "0.3")
    assert (code, err) == (0, "")
    assert "not for this body" in out
    assert "would create energy" in out
    assert "With every one of these models the body stays standing." in out


REFUSED = {
    "nothing": ([], "what moves the ground?"),
    "no motion": ([*SIZE], "what moves the ground?"),
    "no body": (["--motion", PULSE], "a body is a file, or --width and --height"),
    "free and no body": (["--free", "0.5"], "a body is a file"),
    "half a size": (["--width", "1", PULSE], "a body is a file"),
    "no body file": (["none.toml", PULSE], "none.toml"),
    "body and size": (["none.toml", PULSE, *SIZE], "not both"),
    "two along x": ([*SIZE, "--motion", f"x={PULSE}", "--motion", f"x={PULSE}"], "one motion along x"),
    "two motions let go": ([*SIZE, PULSE, "--motion", PULSE, "--free", "0.5"], "give a motion or --free"),
    "two motions drawn": ([*SIZE, PULSE, "--motion", PULSE, "--out", "a.png"], "--out is of one record"),
    "free and motion": ([*SIZE, PULSE, "--free", "0.5"], "not both"),
    "free and units": ([*SIZE, "--free", "0.5", "--units", "g"], "--free has no motion, so it takes no --units"),
    "free and scale": ([*SIZE, "--free", "0.5", "--scale", "2"], "takes no --scale"),
    "free nan": ([*SIZE, "--free", "nan"], "--free must be a finite number"),
    "free far": ([*SIZE, "--free", "7"], "--free is a share of the slenderness angle"),
    "free word": ([*SIZE, "--free", "half"], "--free must be a number, got 'half'"),
    "no record": ([*SIZE, "none.at2"], "none.at2: no such file"),
    "pulse": ([*SIZE, "sinus:amplitude=1"], "no pulse named"),
    "pulse and units": ([*SIZE, PULSE, "--units", "g"], "a pulse takes no --units"),
    "model": ([*SIZE, PULSE, "--restitution", "best"], "no restitution model named 'best'"),
    "percent": ([*SIZE, PULSE, "--restitution", "90"], "a percentage?"),
    "creates energy": ([*SIZE, PULSE, "--restitution", "1.1"], "would create energy"),
    "r nan": ([*SIZE, PULSE, "--restitution", "nan"], "restitution must be finite"),
    "r empty": ([*SIZE, PULSE, "--restitution", ""], "--restitution must not be empty"),
    "scale nan": ([*SIZE, PULSE, "--scale", "nan"], "--scale must be a finite number"),
    "scale huge": ([*SIZE, PULSE, "--scale", "1e9"], "scale must be in"),
    "engine": ([*SIZE, PULSE, "--set", "settings.engine=steam"], "steam"),
    "gravity": ([*SIZE, PULSE, "--set", "settings.gravity=0"], "settings.gravity must be a number > 0"),
    "gravity huge": ([*SIZE, PULSE, "--set", "settings.gravity=1e9"], "gravity"),
    "friction": ([*SIZE, PULSE, "--friction", "0"], "--friction must be a number > 0"),
    "picture": ([*SIZE, PULSE, "--out", "a.bmp"], ".png, .svg or .pdf"),
    "animation": ([*SIZE, PULSE, "--out", "a.mp4"], "animation (.html, .gif or .glb)"),
    "folder": ([*SIZE, PULSE, "--out", "none/a.csv"], "no folder 'none'"),
    "unknown": ([*SIZE, PULSE, "--speed", "2"], "--speed"),
}


@pytest.mark.parametrize(("words", "sentence"), REFUSED.values(), ids=list(REFUSED))
def test_bad_input_gives_one_sentence_and_exit_code_2(refuses, words, sentence):
    """Bad input: one sentence on standard error, exit code 2, no number on standard output."""
    refuses(words, sentence)
