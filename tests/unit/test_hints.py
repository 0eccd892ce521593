"""Hints of what is missing name the package that is missing, and an installation that exists."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from rocking.errors import _EXTRAS

ROOT = Path(__file__).parents[2]
MAP = "map --width 1 --height 4 sine:amplitude=3,period=0.8 --x pga=0.1g:1g:3 --y width=1,2"
BLOCKED = "import sys; sys.modules[sys.argv[1]] = None; from rocking.cli import main; main(sys.argv[2:])"


@pytest.mark.parametrize(
    ("missing", "command", "extra"),
    [
        ("xarray", f"{MAP} --out map.nc", "data"),
        ("pandas", f"{MAP} --out map.nc", "data"),
        ("matplotlib", f"{MAP} --out map.png", "plots"),
        ("uvicorn", "serve --no-browser", "web"),
    ],
)
def test_the_missing_package_is_named(missing, command, extra, tmp_path):
    """In a process that cannot import a package, the command names that one, and how to install it from the source."""
    words = [sys.executable, "-c", BLOCKED, missing, *command.split()]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 2
    assert f" needs {missing}: pip install '.[{extra}]' in the folder of rocking's source" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_map_prints_without_the_packages_of_files(tmp_path):
    """Labelled arrays are made only when they are written or returned."""
    words = [sys.executable, "-c", BLOCKED, "xarray", *MAP.split()]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=True)
    assert "Overturning begins at" in done.stdout


def test_extras_exist():
    """Every extra that a hint names is one of the project's and has the package."""
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    for package, extra in _EXTRAS.items():
        assert any(re.match(rf"{package}\b", line) for line in extras[extra]), package


def test_no_hint_names_a_distribution():
    """Nothing is published: no sentence says to install `rocking` by its name."""
    for path in (ROOT / "src").rglob("*.py"):
        assert not re.search(r"pip install '?rocking", path.read_text(encoding="utf-8")), path
