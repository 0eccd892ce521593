"""Models of a file that the owner of the machine names are known by name; those that break their word are refused."""

import hashlib
import os

import pytest

import rocking as rk
from rocking.errors import RockingError
from rocking.restitution import from_file, registry
from rocking.restitution.from_file import register_own

MODEL = """
import rocking as rk

class Mine(rk.restitution.RestitutionModel):
    name = "{name}"
    title = "a model of my own"
    reference = "my notes"
    colour = "#7a5195"

    def raw_coefficient(self, body, foot):
        side = body.side(foot)
        return {value}
"""
HOUSNER = "rk.coefficient_of_restitution(body, 'housner', foot=foot)"


@pytest.fixture
def own(tmp_path, monkeypatch):
    """Write a file, name it, and forget its models afterwards."""
    monkeypatch.setattr(registry, "_MODELS", dict(registry._MODELS))

    def write(value, name="mine"):
        path = tmp_path / f"{name}.py"
        path.write_text(MODEL.format(name=name, value=value))
        monkeypatch.setenv("ROCKING_MODELS", str(path))
        return path

    return write


def test_a_model_is_known_by_its_name(own, answered):
    """0.9 of Housner's 15.5/17 by name, at the command line and on the page, with the file's hash; twice is once."""
    path = own(f"0.9 * {HOUSNER}")
    register_own()
    register_own()
    block = rk.Block(width=1.0, height=4.0)
    # Housner: 1 - 3/2 sin^2(alpha), tan(alpha) = 1/4
    assert rk.coefficient_of_restitution(block, "mine") == pytest.approx(0.9 * 15.5 / 17.0, rel=1e-14, abs=0.0)
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    assert rk.restitution.models()["mine"].reference == f"own model, mine.py, SHA-256 {digest}: my notes"
    assert digest in answered("models", "mine")["mine"]["reference"]
    response = rk.simulate(block, rk.pulses.sine(4.0, 0.8), "0.98*mine")
    assert response._facts["restitution_file"] == f"mine.py, SHA-256 {digest}"
    assert "restitution_file" not in rk.simulate(block, rk.pulses.sine(4.0, 0.8), "ked")._facts


def test_a_relative_file_is_found_from_other_folders(own, tmp_path, monkeypatch):
    """Processes of studies start elsewhere: what was said of the folder of the server is said in full."""
    path = own(HOUSNER, "near")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROCKING_MODELS", "near.py")
    register_own()
    assert os.environ["ROCKING_MODELS"] == str(path)
    register_own()  # twice is once


def test_the_file_is_the_last_of_two_of_one_name(own):
    """Negative control of provenance: an older model of that name was computed with before, not now."""
    for value in (HOUSNER, f"0.9 * {HOUSNER}"):
        path = own(value, "twice")
        registry._MODELS.pop("twice", None)
        from_file._REGISTERED.pop(str(path), None)
        register_own()
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    assert from_file.origin_of("twice") == {"restitution_file": f"twice.py, SHA-256 {digest}"}


def test_an_edited_file_takes_the_place_of_what_it_was(own):
    """Changed, broken, mended, and as it was first: each time what the file says now, or nothing; twice is once."""
    block = rk.Block(width=1.0, height=4.0)

    def r():
        return rk.coefficient_of_restitution(block, "edited")

    own(f"0.9 * {HOUSNER}", "edited")
    register_own()
    first, source = r(), rk.restitution.models()["edited"].reference
    path = own(f"0.8 * {HOUSNER}", "edited")
    assert r() == first  # control: nobody has looked at the file since
    register_own()
    assert r() == pytest.approx(first * 8 / 9, rel=1e-14)
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    assert from_file.origin_of("edited") == {"restitution_file": f"edited.py, SHA-256 {digest}"}
    for broken in ("1.2", None):
        own(broken, "edited") if broken else path.unlink()
        for _ in range(2):
            with pytest.raises(RockingError):
                register_own()
            with pytest.raises(RockingError, match="unknown restitution model 'edited'"):
                r()
    own(f"0.9 * {HOUSNER}", "edited")
    register_own()
    register_own()
    assert (r(), rk.restitution.models()["edited"].reference) == (first, source)
    assert source.count("own model") == 1


@pytest.mark.parametrize(
    ("value", "name", "reason"),
    [
        ("1 / 0", "raises", "model 'raises': .*line 12: ZeroDivisionError"),
        ("1.2", "above", r"above.py: model 'above': r must be in \[0, 1\], got 1.2"),
        ("1.0", "gains", "model 'gains': an impact must not create energy"),
        ("1.0 / (2.0 + side.half_width)", "metres", "model 'metres': r must not depend on size"),
        ("0.5 if foot == 'left' else 0.4", "sided", "model 'sided': r must not depend on side"),
        ("float('nan')", "nan", "model 'nan': .*finite"),
        (HOUSNER, "ked", "model 'ked': a restitution model named 'ked' exists already"),
    ],
)
def test_negative_controls(own, value, name, reason):
    """Each breach is refused, twice over, with file, model and reason, and nothing is registered."""
    path = own(value, name)
    before = set(registry._MODELS)
    for _ in range(2):
        with pytest.raises(RockingError, match=reason) as refused:
            register_own()
        assert str(path) in str(refused.value)
    assert set(registry._MODELS) == before


def test_a_command_refuses_the_file(own, run):
    """A file that is missing, or is no code, stops every command, with a sentence and no traceback."""
    path = own("(")
    words = ["restitution", "--width", "1", "--height", "4"]
    code, _, err = run(*words)
    assert (code, f"rocking: {path}" in err) == (2, True)
    path.unlink()
    assert "cannot be read" in run(*words)[2]
