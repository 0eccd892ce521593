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
    ("missing", "command", "wanted"),
    [
        ("xarray", f"{MAP} --out map.nc", "xarray"),
        ("matplotlib", f"{MAP} --out map.png", "matplotlib"),
        ("h5netcdf", f"{MAP} --out map.nc", '"rocking[netcdf]"'),
        ("uvicorn", "serve --no-browser", '"rocking[web]"'),
    ],
)
def test_the_missing_package_is_named(missing, command, wanted, tmp_path):
    """In a process that cannot import a package, the command names that one, and what to type."""
    words = [sys.executable, "-c", BLOCKED, missing, *command.split()]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 2
    assert f" needs {missing}: pip install {wanted}\n" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_map_prints_without_the_packages_of_files(tmp_path):
    """Labelled arrays are made only when they are written or returned."""
    words = [sys.executable, "-c", BLOCKED, "xarray", *MAP.split()]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=True)
    assert "Overturning begins at" in done.stdout


def extras():
    """Extras of the project, with what each installs."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]


def test_extras_exist():
    """Every extra that a hint names is one of the project's and has the package."""
    for package, extra in _EXTRAS.items():
        name = {"cv2": "opencv-python-headless"}.get(package, package)
        assert any(re.match(rf"{name}\b", line) for line in extras()[extra]), package


def bare_extras(text):
    """Extras that a text tells to install without quotes, which some shells take for a pattern of file names."""
    return re.findall(r"pip install (?:-\S+ )*(?![\"'])[\w.]+\[\w+\]", text)


def test_every_hint_quotes_its_extra():
    """Sentences and pages with an extra to install have it in quotes, and only one function makes such sentences."""
    assert bare_extras("pip install rocking[web]") == ["pip install rocking[web]"]
    assert bare_extras('pip install "rocking[web]"') == []
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")]
    for path in [*pages, *(ROOT / "src").rglob("*.py"), *(ROOT / "src").rglob("*.js")]:
        text = path.read_text(encoding="utf-8")
        assert not bare_extras(text), path
        for named in re.findall(r"pip install \S*\brocking\[(\w+)\]", text):
            assert named in extras(), (path, named)
        assert "src" not in path.parts or "pip install" not in text or path.name == "errors.py", path
