"""`rocking simulate`: with friction: the same numbers as Python, modes on the page, refusals."""

import math

import numpy as np
import pytest
from PIL import Image
from scipy.io import loadmat

import rocking as rk

COMMAND = "simulate"

SQUAT = ("--width", "1", "--height", "1")
SLENDER = ("--width", "0.5", "--height", "2")
SINE = "sine:amplitude=3.2,period=0.8"


def test_json_is_python_to_the_last_digit(answered):
    """Body, friction, bounce, restitution, scale and gravity reach the engine: the same numbers as in Python."""
    contact = ("--friction", "0.3", "--normal-restitution", "0.1", "--restitution", "housner")
    words = (*contact, "--scale", "-2", "--set", "settings.gravity=9.81")
    answer = answered(*SQUAT, SINE, *words)
    block, pulse = rk.Block(width=1.0, height=1.0), rk.pulses.sine(3.2, 0.8)
    response = rk.simulate(block, pulse, "housner", friction=0.3, normal_restitution=0.1, scale=-2.0, gravity=9.81)
    assert answer["outcome"] == response.outcome.name.lower()
    assert answer["summary"] == response.summary
    regimes = [(a, b, regime.lower(), *rest) for a, b, regime, *rest in response.regimes.tolist()]
    assert [tuple(row.values()) for row in answer["intervals"]] == regimes
    assert [tuple(row.values()) for row in answer["impacts"]] == response.impacts.tolist()
    assert answer["peak_rotation"] == response.peak_rotation
    assert answer["sliding_distance"] == response.sliding_distance
    assert answer["energy_closure"] == response.energy.closure < 1e-10


def test_complementarity_is_housner(answered):
    """Impacts by complementarity alone: let go at half of alpha, on rough ground they keep 1 - 3/2 sin^2 alpha."""
    words = ("--initial-rotation", "0.5", "--friction", "10", "--restitution", "complementarity")
    answer = answered(*SLENDER, *words)
    assert answer["coefficient"] is None
    assert answer["initial_rotation"] == pytest.approx(0.5 * math.atan(0.25), rel=1e-12, abs=0.0)
    first = answer["impacts"][0]
    ratio = first["velocity_after"] / first["velocity_before"]
    assert ratio == pytest.approx(1.0 - 1.5 / 17.0, rel=1e-10)


def test_page_and_files(run, tmp_path):
    """Modes in words, impacts, what slid and what was lost are on the page; every file is written and opens."""
    files = {name: tmp_path / f"a.{name}" for name in ("png", "csv", "mat", "nc")}
    words = ("--output", files["png"], "--output", files["csv"], "--output", files["mat"], "--output", files["nc"])
    slides = ("--width", "1.2", "--height", "2", "sine:amplitude=9,period=0.9", "--friction", "0.62", "--details")
    code, out, err = run(*slides, *words)
    assert (code, err) == (0, "")
    for said in (
        "Contact: friction 0.62",
        "rocking about one foot that slides",
        "Energy lost in friction",
        "Friction usage",
    ):
        assert said in out
    for path in files.values():
        assert f"wrote {path}" in out
    assert np.asarray(Image.open(files["png"])).std() > 1.0
    found = loadmat(files["mat"], simplify_cells=True)["rocking"]
    assert 3 in found["intervals"]["regime"]  # rocking about one foot that slides
    assert files["csv"].read_text(encoding="utf-8").startswith("time [s],displacement [m],")
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(files["nc"], engine="h5netcdf", decode_timedelta=False) as data:
        assert data.attrs["friction"] == 0.62


def test_the_warning_names_the_option(run):
    """Where pure rocking takes more friction than there is, the page says what to type."""
    page = run(*SLENDER, SINE, "--set", "response.assumed_friction=0.2")[1]
    assert "Use --friction" in page
    assert "friction=..." not in page
