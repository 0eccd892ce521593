"""`rocking simulate` refuses bad input in one sentence with exit code 2."""

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
