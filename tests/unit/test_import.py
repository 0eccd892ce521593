"""`import rocking` is quick, and pulls in nothing heavy."""

import subprocess
import sys

import pytest
from benchmarks import start

import rocking as rk
from rocking import conventions

HEAVY = ("scipy", "shapely", "matplotlib", "pydantic", "pandas", "sympy", "typer", "rich")


def loaded_by(statement):
    """Top-level modules that a statement loads in a fresh interpreter."""
    code = f"import sys; {statement}; print(' '.join({{name.partition('.')[0] for name in sys.modules}}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_import_loads_nothing_heavy():
    """`import rocking` loads none of the heavy packages; the same question does see a package that is
    loaded."""
    assert not loaded_by("import rocking").intersection(HEAVY)
    assert "shapely" in loaded_by("import shapely")


def test_blocks_and_closed_forms_load_nothing_heavy():
    """A block's coefficient needs neither scipy nor shapely nor matplotlib."""
    statement = "import rocking; rocking.coefficient_of_restitution(rocking.Block(width=1, height=4), 'ked')"
    assert not loaded_by(statement).intersection(HEAVY)


@pytest.mark.speed
def test_import_is_quick():
    """`import rocking` takes less CPU time than half of `import numpy`; with scipy more."""
    assert start.scaled("-c", "import rocking") < 0.5 * start.NUMPY
    assert start.scaled("-c", "import rocking, scipy.signal") > 0.5 * start.NUMPY


@pytest.mark.speed
def test_the_list_of_commands_is_quick():
    """`rocking --help` takes less CPU time than the goal; a command's own help takes more than that."""
    assert start.scaled("-m", "rocking", "--help") < start.COMMANDS["--help"][1]
    assert start.scaled("-m", "rocking", "restitution", "--help") > start.COMMANDS["--help"][1]


def test_the_list_of_commands_loads_nothing_heavy():
    """The list of commands needs no numpy; the help of a command does."""
    told = "import atexit; atexit.register(lambda: print(*{name.partition('.')[0] for name in sys.modules})); "
    listed, own = (
        loaded_by(f"{told}from rocking.cli import main; main({words})") for words in (["--help"], ["restitution", "-h"])
    )
    assert not listed & {*HEAVY, "numpy"} - {"typer"}
    assert own >= {"numpy", "pydantic"}
    assert "rich" not in own


def test_every_public_name_is_there():
    """Each name in `__all__` and `dir()` can be had, and one that is not there is refused."""
    for name in ("Block", "MassPoints", "Region", "Section", "Solid"):
        assert isinstance(getattr(rk, name), type)
    assert set(rk.__all__) <= set(dir(rk))
    assert callable(rk.coefficient_of_restitution)
    assert rk.restitution.models()
    assert conventions.g == 9.80665  # exact, 3rd CGPM 1901
    with pytest.raises(AttributeError, match="attribute nothing"):
        rk.nothing  # noqa: B018
