"""The page's scripts hold for as much data as the server sends."""

import re
from importlib.resources import files
from pathlib import Path

STATIC = Path(str(files("rocking.app"))) / "static"
# a browser's stack ends at about 120,000 arguments of one call
SPREAD = re.compile(r"(Math\.(?:max|min)|\.push)\((?:[^()]*,\s*)?\.\.\.\w")


def test_no_call_takes_data_as_its_arguments() -> None:
    """Extremes of data are taken in loops: no call whose arguments are as many as the data."""
    assert SPREAD.search("Math.max(1, ...impacts.flat().filter(Number.isFinite))")
    found = {
        path.relative_to(STATIC).as_posix()
        for path in STATIC.rglob("*.js")
        if "vendor" not in path.parts and SPREAD.search(path.read_text(encoding="utf-8"))
    }
    assert not found
